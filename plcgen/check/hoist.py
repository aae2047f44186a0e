"""Verification of a hoist block: it is executed in every situation the job can bring, and each output is compared."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import product

import numpy as np

from plcgen.check.hoist_bench import GARBAGE, Bench, Run, full_trip, interrupted_trip, stop_places, turning_trip
from plcgen.check.hoist_cases import case_checks, envelope_bound
from plcgen.check.hoist_expectation import (
    LAW_ERROR,
    UNIT_ROUNDOFF,
    Expected,
    Segment,
    expect_stop,
    expect_trip,
    peak_acceleration,
    travel_resolution,
)
from plcgen.check.hoist_model import CREEP_IN, CREEP_OUT, FULL_SPEED, STANDSTILL, STOPPING, HoistModel, Samples
from plcgen.check.rig import PERFECT, Clock, Encoder
from plcgen.check.verdict import Check, TargetVerdict, nearer, strain
from plcgen.plc.core import Program
from plcgen.trajectory import Trajectory

JITTER = 0.1
# Of the shortest travel with room for both ramps and both creep travels.
SHORT_TRIPS = (0.05, 0.5, 0.95, 1.2, 2.0, 4.0, 8.0)
FUNCTION_ERROR = 2.0**-20
"""Sixteen half spacings of REAL: far more than a CPU's EXP and LN are off."""
TRACE_COLUMNS = (
    "time",
    "plantTravel",
    "actualTravel",
    "velocitySetpoint",
    "limitedSetpoint",
    "acceleration",
    "envelopeVelocity",
    "distanceToGo",
    "phase",
    "inPosition",
    "status",
)


@dataclass(frozen=True)
class Subject:
    """What is verified: a program, its FB and instance DB by name, and the model to hold it against."""

    program: Program
    block: str
    instance: str
    model: HoistModel

    @property
    def bench(self) -> Bench:
        return Bench(self.program, self.block, self.instance, self.model)


def verify_hoist(
    subject: Subject, progress: Callable[[str], None] | None = None, fail_fast: bool = False
) -> TargetVerdict:
    """All checks, each with the figure that comes nearest to its bound and the names of the runs that miss it.

    With `fail_fast` it ends after the first situation or run in which a check fails.
    """
    worst: dict[str, Check] = {}
    for checks in _situations(subject.bench, progress or (lambda _text: None)):
        for check in checks:
            worst[check.name] = nearer(worst[check.name], check) if check.name in worst else check
        if fail_fast and not all(check.ok for check in worst.values()):
            break
    return TargetVerdict(tuple(worst.values()))


def nominal_trace(subject: Subject) -> Trajectory:
    """The trip upwards with a perfect encoder."""
    trace = full_trip(subject.bench, "up", up=True).trace
    return Trajectory({name: trace[name] for name in TRACE_COLUMNS})


def _situations(bench: Bench, progress: Callable[[str], None]) -> Iterator[Iterable[Check]]:
    """Checks by and by, in the order of cost and of how much they tell."""
    progress("inputs, commands, envelope")
    for check in case_checks(bench):
        yield (check,)
    for make in _runs(bench):
        run = make()
        progress(run.name)
        yield [check if check.ok else replace(check, detail=run.name) for check in _run_checks(bench.model, run)]
    yield (_coarse_functions(bench),)
    yield (_isolation(bench),)


def _runs(bench: Bench) -> Iterator[Callable[[], Run]]:
    """Every closed loop, the most telling first."""
    model = bench.model
    travel, period = model.limits.travel, model.sample_period
    slow = Clock(min(1.5 * period, model.shortest_jerk_time / 10))
    places = stop_places(model)
    yield partial(full_trip, bench, "up, perfect encoder", up=True)
    yield partial(full_trip, bench, "down, perfect encoder", up=False)
    yield partial(turning_trip, bench, "up and back")
    yield partial(interrupted_trip, bench, "up, stop and resume", up=True, places=places)
    yield partial(interrupted_trip, bench, "down, stop and resume", up=False, places=places)
    yield partial(full_trip, bench, "up, longer cycle", up=True, clock=slow)
    ways = {"up": True, "down": False}
    for way, up in ways.items():
        yield partial(full_trip, bench, f"{way}, other stops", up, stops=(-0.05 * travel, 1.1 * travel))
    for share in SHORT_TRIPS:
        distance = min(share * model.min_travel, travel)
        yield partial(full_trip, bench, f"the last {distance:.4g} {model.unit} up", up=True, distance=distance)
    encoders = {"perfect encoder": PERFECT, "1 mm steps": Encoder(model.millimetre), "one scan late": Encoder(delay=1)}
    clocks = {"on time": Clock(period), "10 % jitter": Clock(period, JITTER)}
    # A perfect encoder on time was run above.
    for (way, up), (measured, encoder), (timed, clock) in product(ways.items(), encoders.items(), clocks.items()):
        if encoder != PERFECT or clock.jitter:
            yield partial(full_trip, bench, f"{way}, {measured}, {timed}", up, encoder, clock)


def _run_checks(model: HoistModel, run: Run) -> Iterator[Check]:
    """Figures of one run, each with its bound."""
    speed, rate, snap = f"{model.unit}/s", f"{model.unit}/s2", f"{model.unit}/s3"
    yield _count("runs_not_completed", [not run.is_sound])
    if not run.is_sound:
        return  # there is nothing to hold it against
    trips = [(segment, expect_trip(model, segment)) for segment in run.segments(run.trips)]
    stops = [(segment, expect_stop(model, segment)) for segment in run.segments(run.stops)]
    parts = trips + stops
    yield _count("arithmetic_faults", [len(run.faults)])
    yield _count("wrong_phases", [_wrong_phases(segment, expected) for segment, expected in parts])
    yield _count("wrong_status", [_wrong_status(s, 0x7001, 0x7002) for s, _ in trips])
    yield _count("wrong_stop_status", [_wrong_status(s, 0x7003, 0x7003) for s, _ in stops])
    yield _count("wrong_flags", [_wrong_flags(run)])
    if run.nominal:
        yield _law_error(model, trips)
    yield _nearest(
        "velocity_deviation", speed, [_deviation(s, "velocitySetpoint", e.velocity, e.velocity_bound) for s, e in parts]
    )
    yield _nearest(
        "acceleration_deviation",
        rate,
        [_deviation(s, "acceleration", e.acceleration, e.acceleration_bound) for s, e in parts],
    )
    yield _nearest("distance_deviation", model.unit, [_distance(model, s) for s, _ in parts])
    yield _nearest("envelope_deviation", speed, [_envelope(model, s) for s, _ in parts])
    yield _nearest("limited_setpoint_deviation", speed, [_limited(run)])
    yield _nearest("velocity_limit", speed, [_velocity_limit(model, run)])
    yield _nearest("acceleration_limit", rate, [_acceleration_limit(model, run)])
    yield _nearest("jerk_limit", snap, [_jerk_limit(model, run)])
    yield _nearest("setpoint_step", speed, [_setpoint_step(model, run)])
    yield _envelope_margin(speed, run)
    if len(run.trips) == 1:
        yield _nearest("duration_deviation", "s", [_duration(model, run)])
    yield _nearest("stop_error" if run.is_exact else "stop_error_real_encoder", model.unit, [_stop_error(model, run)])


def _count(name: str, values: list[int] | list[bool]) -> Check:
    return Check(name, float(sum(values)), 0.0, "1")


def _nearest(name: str, unit: str, figures: list[tuple[float, float]]) -> Check:
    """Of pairs of value and bound, the one with the largest ratio; NaN counts as the largest."""
    if not figures:
        return Check(name, 0.0, 0.0, unit)
    value, bound = max(figures, key=lambda pair: strain(*pair))
    return Check(name, value, bound, unit)


def _worst(deviation: Samples, bound: Samples | float) -> tuple[float, float]:
    """The row of an array that comes nearest to its bound."""
    bounds = np.broadcast_to(bound, deviation.shape)
    row = int(np.argmax(np.where(np.isnan(deviation), np.inf, deviation / np.maximum(bounds, 1e-300))))
    return float(deviation[row]), float(bounds[row])


def _deviation(segment: Segment, column: str, expected: Samples, bound: Samples | float) -> tuple[float, float]:
    return _worst(np.abs(segment.sign * segment.column(column) - expected), bound)


def _law_error(model: HoistModel, trips: list[tuple[Segment, Expected]]) -> Check:
    """Worst relative error of v(S) in 32 bits against 64 bits on trips from stop to stop, wherever v > 1e-3.

    The corner travels are REAL constants, half a spacing off: an error of S, not of v(S), which is taken off by its
    gain dv/dS = a/v.
    """
    limits, worst = model.limits, 0.0
    for segment, expected in trips:
        rows = expected.is_travel_law & (expected.velocity > 1e-3)
        velocity, acceleration = expected.velocity[rows], np.abs(expected.acceleration[rows])
        trip = model.trip(float(segment.to_go[0]))
        corner = UNIT_ROUNDOFF * max(trip.start_travel + limits.creep_out, trip.stop_travel + limits.creep_in)
        error = np.abs(segment.sign * segment.column("velocitySetpoint")[rows] / velocity - 1.0)
        worst = max([worst, *(error - corner * acceleration / velocity**2)])
    return Check("law_error", float(worst), LAW_ERROR, "1")


def _distance(model: HoistModel, segment: Segment) -> tuple[float, float]:
    return _worst(np.abs(segment.column("distanceToGo") - segment.to_go), travel_resolution(model, segment))


def _envelope(model: HoistModel, segment: Segment) -> tuple[float, float]:
    behind = segment.column("lowerStop" if segment.up else "upperStop")
    expected = model.envelope(segment.sign * (segment.column("actualTravel") - behind), segment.to_go)
    return _worst(np.abs(segment.column("envelopeVelocity") - expected), envelope_bound(model, segment, expected))


def _wrong_phases(segment: Segment, expected: Expected) -> int:
    """Phases that lie outside what rounding of time and travel leaves open; standstill comes after all others."""
    phase, *bounds = (np.where(p == STANDSTILL, STOPPING + 1, p) for p in (segment.column("phase"), *expected.phases))
    return int(np.sum((phase < np.min(bounds, axis=0)) | (phase > np.max(bounds, axis=0))))


def _wrong_status(segment: Segment, first: int, following: int) -> int:
    """One status in the first scan, another in those that follow; at rest the position decides."""
    status = segment.column("status")
    wanted = np.where(np.arange(len(status)) == 0, first, following)
    rest = np.where(segment.column("inPosition") != 0, 0x0000, 0x7000)
    return int(np.sum(status != np.where(segment.column("phase") != STANDSTILL, wanted, rest)))


def _wrong_flags(run: Run) -> int:
    """busy, inPosition, error and overspeedTrip over a whole run without errors; the hoist ends in position.

    At rest the setpoint, and at rest or constant speed the acceleration, is zero to the last bit.
    """
    trace = run.trace
    steady = np.isin(trace["phase"], (STANDSTILL, CREEP_OUT, FULL_SPEED, CREEP_IN))
    wrong = np.sum(trace["busy"] != (trace["phase"] != STANDSTILL))
    wrong += np.sum(trace["acceleration"][steady] != 0) + np.sum(trace["velocitySetpoint"][~trace["busy"]] != 0)
    wrong += np.sum(trace["error"]) + np.sum(trace["overspeedTrip"]) + np.sum(trace["inPosition"] & trace["busy"])
    return int(wrong) + int(not trace["inPosition"][-1]) + int(trace["status"][-1] != 0)


def _limited(run: Run) -> tuple[float, float]:
    setpoint = run.trace["velocitySetpoint"].astype(np.float64)
    clamped = np.sign(setpoint) * np.minimum(np.abs(setpoint), run.trace["envelopeVelocity"])
    return _worst(np.abs(run.trace["limitedSetpoint"] - clamped), 0.0)


def _velocity_limit(model: HoistModel, run: Run) -> tuple[float, float]:
    limit = model.limits.max_velocity
    return float(np.abs(run.trace["velocitySetpoint"]).max()), limit * (1 + LAW_ERROR)


def _noise(model: HoistModel, run: Run) -> float:
    """How far the measurement moves the setpoint: gain times the step of the travel, the acceleration in the time that
    a call comes early or late, and the error of the law.
    """
    step = max(run.encoder.quantum, 2 * UNIT_ROUNDOFF * float(np.abs(run.trace["actualTravel"]).max()))
    early = peak_acceleration(model) * run.clock.jitter * run.clock.period
    return model.steepest_gain * step + early + 2 * LAW_ERROR * model.limits.max_velocity


def _stretch(model: HoistModel, run: Run) -> float:
    """A scan at a held setpoint covers T (1 +- g T) of the reference: travel is v T, while v changes by a T.
    A late measurement adds a scan to that.
    """
    return 1 + model.steepest_gain * run.clock.period * (1 + run.encoder.delay)


def _acceleration_limit(model: HoistModel, run: Run) -> tuple[float, float]:
    """Mean acceleration over a window so long that the noise is below 1 % of the limit."""
    limit, period = peak_acceleration(model), run.clock.period
    scans = int(np.ceil(2 * _noise(model, run) / (0.01 * limit * period)))
    velocity = run.trace["velocitySetpoint"].astype(np.float64)
    if len(velocity) <= scans:
        return 0.0, limit
    mean = np.abs(velocity[scans:] - velocity[:-scans]) / (scans * period)
    return float(mean.max()), limit * (_stretch(model, run) + 0.01)


def _jerk_limit(model: HoistModel, run: Run) -> tuple[float, float]:
    """Second difference over windows so long that the noise is below 1 % of the limit.

    Where time is stretched by 1 + gT, jerk grows by its square, and by the change of the stretch: g/2 T (m + a g).
    """
    limit, period = model.limits.jerk, run.clock.period
    scans = int(np.ceil(np.sqrt(4 * _noise(model, run) / (0.01 * limit)) / period))
    velocity = run.trace["velocitySetpoint"].astype(np.float64)
    if len(velocity) <= 2 * scans:
        return 0.0, limit
    second = velocity[2 * scans :] - 2 * velocity[scans:-scans] + velocity[: -2 * scans]
    change = model.steepest_gain * period * (1 + peak_acceleration(model) * model.steepest_gain / limit)
    bound = limit * (_stretch(model, run) ** 2 + change + 0.01)
    return float(np.abs(second).max()) / (scans * period) ** 2, bound


def _setpoint_step(model: HoistModel, run: Run) -> tuple[float, float]:
    """One scan changes the setpoint by a T at most, stretched, and by the noise of the measurement."""
    limit = peak_acceleration(model) * run.clock.period * _stretch(model, run)
    return float(np.abs(np.diff(run.trace["velocitySetpoint"].astype(np.float64))).max()), limit + 2 * _noise(
        model, run
    )


def _envelope_margin(unit: str, run: Run) -> Check:
    margin = np.min(run.trace["envelopeVelocity"] - np.abs(run.trace["velocitySetpoint"]))
    return Check("envelope_margin", float(margin), UNIT_ROUNDOFF, unit, at_least=True)


def _duration(model: HoistModel, run: Run) -> tuple[float, float]:
    """Held setpoints lag by half a scan for each e-fold of speed; each leg over travel is left up to a scan late,
    and a step of the encoder is waited for at creep speed.
    """
    first, last, _ = run.trips[0]
    trip = model.trip(abs(float(run.stop_place) - float(run.trace["actualTravel"][first])))
    folds = np.log(max(trip.cruise_velocity / trip.creep_velocity, 1.0))
    late = 1 + run.encoder.delay + 2 * run.clock.jitter
    bound = run.clock.period * ((folds + 6) * late) + run.encoder.quantum / trip.creep_velocity
    return abs((last - first) * run.clock.period - trip.reference.duration), float(bound)


def _stop_error(model: HoistModel, run: Run) -> tuple[float, float]:
    """1 mm with a perfect encoder; a step of the encoder, a late scan and jitter at creep speed come on top."""
    per_scan = model.limits.creep_velocity * run.clock.period
    bound = model.millimetre + run.encoder.quantum + (run.encoder.delay + 2 * run.clock.jitter) * per_scan
    return abs(run.travel_at_end - run.stop_place), bound


def _coarse_functions(bench: Bench) -> Check:
    """`law_error` where EXP and LN are coarse: the last bits of a CPU's are unknown, so nothing may hang on them."""
    run = full_trip(replace(bench, function_error=FUNCTION_ERROR), "coarse functions", up=True)
    trips = [(segment, expect_trip(bench.model, segment)) for segment in run.segments(run.trips)]
    return replace(_law_error(bench.model, trips), name="law_error_coarse_functions")


def _isolation(bench: Bench) -> Check:
    """A run whose temporaries start as garbage must agree bit by bit with one that starts with zeros."""
    dirty, clean = (full_trip(replace(bench, temp_fill=fill), "isolation", up=True) for fill in (GARBAGE, 0))
    different = sum(
        int(np.sum(clean.trace[name] != dirty.trace[name]))
        for name in clean.trace.columns
        if len(clean.trace) == len(dirty.trace)
    )
    return Check("unwritten_temporaries", float(different + abs(len(clean.trace) - len(dirty.trace))), 0.0, "1")
