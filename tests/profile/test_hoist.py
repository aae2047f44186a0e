"""Trips and stops: integrated to prove limits and end state, against Ruckig, golden numbers, refusals."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.errors import JobError
from plcgen.job import HoistLimits, parse_job
from plcgen.profile.constants import ConstantGroup
from plcgen.profile.hoist import (
    ACCELERATE,
    CREEP_IN,
    CREEP_OUT,
    DECELERATE,
    START_RAMP,
    STOP_RAMP,
    Trip,
    creeping_travel,
    plan_stop,
    plan_trip,
    stop_deceleration,
)
from plcgen.profile.hoist_constants import hoist_constants, transition_table
from plcgen.profile.hoist_rules import ENVELOPE_CLEARANCE, derive
from plcgen.profile.integrator import integrate
from plcgen.profile.reference import Phase

EXAMPLE = (Path(__file__).parents[2] / "templates" / "jobs" / "hoist.toml").read_text(encoding="utf-8")


def job_text(**values: float) -> str:
    """The example job with other values."""
    text = EXAMPLE
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key} = [-+.\w]+", f"{key} = {value!r}", text)
        assert count == 1, key
    return text


def derived(**values: float) -> Trip:
    return derive(parse_job(job_text(**values), "job.toml"))


def refusal(**values: float) -> str:
    """The error's first line."""
    with pytest.raises(JobError) as caught:
        derived(**values)
    return str(caught.value).split("\n")[0]


def magnitude(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers spread evenly over their orders of magnitude."""
    return st.floats(float(np.log10(low)), float(np.log10(high))).map(lambda exponent: float(10.0**exponent))


@st.composite
def hoist_limits(draw: st.DrawFn) -> HoistLimits:
    velocity, acceleration = draw(magnitude(0.1, 20.0)), draw(magnitude(0.05, 5.0))
    return HoistLimits(
        travel=1.0,
        max_velocity=velocity,
        acceleration=acceleration,
        deceleration=draw(st.just(acceleration) | magnitude(0.05, 5.0)),
        jerk=draw(magnitude(0.02, 50.0)),
        creep_velocity=min(10.0, velocity * draw(st.floats(0.05, 0.5))),
        creep_acceleration=acceleration * draw(st.just(1.0) | st.floats(0.2, 1.0)),
        creep_out=draw(st.just(0.0) | magnitude(0.001, 10.0)),
        creep_in=draw(magnitude(0.001, 10.0)),
    )


@st.composite
def trips(draw: st.DrawFn) -> Trip:
    """Distances on both sides of what the creep travels need, down to a millionth of it."""
    limits = draw(hoist_limits())
    needed = creeping_travel(limits)
    exactly, below, above = st.just(1.0), magnitude(1e-6, 1.0), magnitude(1.0, 1e3)
    return plan_trip(limits, needed * draw(exactly | below | above))


@settings(max_examples=120, deadline=None, print_blob=True)
@given(trips())
def test_trips_keep_their_limits_and_end_at_rest_at_the_stop(trip: Trip) -> None:
    limits = trip.limits
    proof = integrate(trip.reference.phases)
    # The integrator's acceleration is off zero by its rounding, and that runs on through a long constant leg.
    drift = 1e-15 * limits.acceleration * trip.duration
    assert proof.travel == pytest.approx(trip.distance, rel=1e-12, abs=drift * trip.duration)
    assert proof.duration == pytest.approx(trip.duration, rel=1e-12)
    assert proof.end_velocity == pytest.approx(0.0, abs=1e-12 * limits.max_velocity + drift)
    assert proof.end_acceleration == pytest.approx(0.0, abs=1e-12 * limits.acceleration)
    assert proof.lowest_velocity >= -1e-12 * limits.max_velocity - drift
    assert proof.highest_velocity <= limits.max_velocity * (1 + 1e-12) + drift
    assert proof.highest_acceleration <= limits.acceleration * (1 + 1e-12)
    assert proof.lowest_acceleration >= -limits.deceleration * (1 + 1e-12)
    assert proof.highest_jerk == limits.jerk
    assert all(phase.duration >= 0 for phase in trip.reference.phases)


@settings(max_examples=50, deadline=None, print_blob=True)
@given(trips())
def test_ramps_keep_the_limits_of_the_creep_speed(trip: Trip) -> None:
    limits, phases = trip.limits, list(trip.reference.phases)
    start = integrate([phase for phase in phases if phase.leg == START_RAMP])
    assert start.end_velocity == pytest.approx(trip.creep_velocity, rel=1e-12)
    assert start.highest_acceleration <= limits.creep_acceleration * (1 + 1e-12)
    # The stop ramp runs backwards in time: the same jerks, the same acceleration with its sign changed.
    stop = integrate([phase for phase in phases if phase.leg == STOP_RAMP][::-1])
    assert stop.highest_acceleration <= stop_deceleration(limits) * (1 + 1e-12)
    assert trip.creep_velocity <= limits.creep_velocity


@settings(max_examples=50, deadline=None, print_blob=True)
@given(trips())
def test_legs_are_what_the_reference_runs(trip: Trip) -> None:
    phases = list(trip.reference.phases)
    taken: list[Phase] = []
    for leg in trip.legs:
        before = integrate(taken).travel if taken else 0.0
        own = [phase for phase in phases if phase.leg == leg.number]
        taken += own
        proof = integrate(taken)
        assert sum(phase.duration for phase in own) == pytest.approx(leg.duration, rel=1e-12, abs=1e-15)
        drift = 1e-15 * trip.limits.acceleration * trip.duration
        off = 1e-12 * trip.distance + drift * trip.duration
        assert proof.travel - before == pytest.approx(leg.travel, rel=1e-9, abs=off)
        assert proof.end_velocity == pytest.approx(leg.end_velocity, abs=1e-12 * trip.limits.max_velocity + drift)
    assert taken == phases


@settings(max_examples=50, deadline=None, print_blob=True)
@given(hoist_limits(), magnitude(1e-6, 0.999999))
def test_short_trips_only_creep(limits: HoistLimits, share: float) -> None:
    trip = plan_trip(limits, creeping_travel(limits) * share)
    assert [leg.number for leg in trip.legs] == [START_RAMP, CREEP_OUT, STOP_RAMP]
    assert trip.cruise_velocity == trip.creep_velocity <= limits.creep_velocity
    rest = trip.legs[1].travel
    assert trip.creep_velocity == limits.creep_velocity or rest <= 1e-12 * trip.distance


def test_trip_at_the_very_edge_of_creeping() -> None:
    """One float more or less of distance changes the legs, but not the motion."""
    limits = parse_job(EXAMPLE, "job.toml").hoist
    needed = creeping_travel(limits)
    short, full = plan_trip(limits, float(np.nextafter(needed, 0.0))), plan_trip(limits, needed)
    assert (len(short.legs), len(full.legs)) == (3, 7)
    assert short.duration == pytest.approx(full.duration, rel=1e-12)
    assert full.cruise_velocity == pytest.approx(0.5)


def state(velocity: float, acceleration: float = 0.0, travel: float = 0.0) -> dict[str, list[float]]:
    return {"position": [travel], "velocity": [velocity], "acceleration": [acceleration]}


def ruckig_duration(start: dict[str, Any], target: dict[str, Any], **limits: float) -> float:
    """Duration of Ruckig's time-optimal trajectory of one axis."""
    ruckig = pytest.importorskip("ruckig", reason="Ruckig is the oracle of this test: pip install ruckig")
    asked = ruckig.InputParameter(1)
    for prefix, values in (("current", start), ("target", target)):
        for key, value in values.items():
            setattr(asked, f"{prefix}_{key}", value)
    for key, value in limits.items():
        setattr(asked, key, [value])
    if "max_velocity" not in limits:
        asked.max_velocity, asked.control_interface = [1e3], ruckig.ControlInterface.Velocity
    trajectory = ruckig.Trajectory(1)
    assert ruckig.Ruckig(1).calculate(asked, trajectory) in (ruckig.Result.Working, ruckig.Result.Finished)
    return float(trajectory.duration)


def bounds(rising: float, falling: float, limits: HoistLimits) -> dict[str, float]:
    return {"max_acceleration": rising, "min_acceleration": -falling, "max_jerk": limits.jerk}


@settings(max_examples=80, deadline=None, print_blob=True)
@given(hoist_limits(), magnitude(1e-2, 1e3))
def test_between_the_creep_speeds_nothing_is_faster(limits: HoistLimits, room: float) -> None:
    trip = plan_trip(limits, creeping_travel(limits) + room)
    ours = sum(leg.duration for leg in trip.legs if ACCELERATE <= leg.number <= DECELERATE)
    creep = limits.creep_velocity
    theirs = ruckig_duration(
        state(creep),
        state(creep, travel=room),
        max_velocity=limits.max_velocity,
        **bounds(limits.acceleration, limits.deceleration, limits),
    )
    assert ours == pytest.approx(theirs, rel=1e-9)


@settings(max_examples=50, deadline=None, print_blob=True)
@given(hoist_limits(), st.floats(0.001, 0.999))
def test_below_creep_speed_nothing_is_faster(limits: HoistLimits, share: float) -> None:
    distance = creeping_travel(limits) * share
    theirs = ruckig_duration(
        state(0.0),
        state(0.0, travel=distance),
        max_velocity=limits.creep_velocity,
        **bounds(limits.creep_acceleration, stop_deceleration(limits), limits),
    )
    assert plan_trip(limits, distance).duration == pytest.approx(theirs, rel=1e-9)


@settings(max_examples=80, deadline=None, print_blob=True)
@given(trips(), st.floats(0.0, 1.0))
def test_stop_from_anywhere_in_a_trip(trip: Trip, share: float) -> None:
    limits = trip.limits
    motion = trip.reference.at_time(np.array([share * trip.duration]))
    velocity, acceleration = max(0.0, float(motion.velocity[0])), float(motion.acceleration[0])
    stop = plan_stop(limits, velocity, acceleration)
    scale = limits.max_velocity
    # sqrt(m v + a^2/2) - abs(a) next to rest turns a rounding of v into one of a: da = sqrt(m dv)
    blur = np.sqrt(limits.jerk * 1e-14 * scale)
    assert stop.end[3] == pytest.approx(0.0, abs=blur)
    assert stop.end[2] == pytest.approx(0.0, abs=1e-12 * scale + blur**2 / limits.jerk)
    course = stop.at_time(np.linspace(0.0, stop.duration, 200))
    assert course.velocity.min() >= -1e-12 * scale - blur**2 / limits.jerk
    assert course.velocity.max() <= limits.max_velocity * (1 + 1e-12)
    assert course.acceleration.max() <= max(acceleration, blur)
    assert course.acceleration.min() >= -limits.deceleration * (1 + 1e-12)
    assert {abs(phase.jerk) for phase in stop.phases} <= {0.0, limits.jerk}
    assert all(phase.duration >= 0 for phase in stop.phases)


@settings(max_examples=50, deadline=None, print_blob=True)
@given(hoist_limits(), st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_no_stop_is_faster_and_its_peak_is_reached(limits: HoistLimits, speed: float, share: float) -> None:
    """From any speed and acceleration that a limit on jerk can still bring to rest without reversing."""
    velocity = speed * limits.max_velocity
    highest = limits.acceleration if share > 0 else min(limits.deceleration, np.sqrt(2 * limits.jerk * velocity))
    acceleration = share * float(highest)
    stop = plan_stop(limits, velocity, acceleration)
    peak = min(limits.deceleration, np.sqrt(limits.jerk * velocity + acceleration**2 / 2))
    lowest = stop.at_time(stop.corner_times).acceleration.min() if velocity > 0 else -peak
    assert lowest == pytest.approx(-peak, rel=1e-6, abs=1e-9)
    theirs = ruckig_duration(
        state(velocity, acceleration), state(0.0), **bounds(limits.acceleration, limits.deceleration, limits)
    )
    assert stop.duration == pytest.approx(theirs, rel=1e-6, abs=1e-6)


def test_stop_at_rest_takes_no_time() -> None:
    stop = plan_stop(parse_job(EXAMPLE, "job.toml").hoist, 0.0, 0.0)
    assert (stop.duration, stop.travel) == (0.0, 0.0)


def test_golden_trip_of_six_hundred_metres() -> None:
    """The worked example, to the digits printed; creep out is 1.433 m there."""
    trip = derived()
    assert [(leg.name, f"{leg.duration:.3f}", f"{leg.travel:.3f}") for leg in trip.legs] == [
        ("start ramp", "2.267", "0.567"),
        ("creep out", "2.866", "1.433"),
        ("accelerate", "16.833", "105.208"),
        ("full speed", "32.043", "384.517"),
        ("decelerate", "16.833", "105.208"),
        ("creep in", "5.000", "2.500"),
        ("stop ramp", "2.267", "0.567"),
    ]
    assert f"{trip.duration:.3f}" == "78.109"
    assert integrate(trip.reference.phases).travel == pytest.approx(600.0, rel=1e-14)


def test_golden_trip_with_two_metres_to_the_end_of_creep_out() -> None:
    """Start ramp and creep out of 2 m together: the last digit of the worked example."""
    trip = derived(creep_out=1.4333333333)
    assert trip.acceleration_begin == pytest.approx(2.0)
    assert f"{trip.legs[1].duration:.3f} {trip.duration:.3f}" == "2.867 78.110"


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"travel": 5.0},
            "16:10: travel = 5 m is too short: start ramp, creep_out, creep_in and stop ramp need 5.067 m; "
            "shorten creep_out or creep_in, or lower creep_velocity",
        ),
        (
            {"jerk": 5.0, "creep_acceleration": 0.3},
            "13:17: sample_period = 0.01 s is too long: the shortest phase lasts 0.06 s and needs ten samples; "
            "write at most 0.006, or lower jerk",
        ),
        (
            {"jerk": 500.0},
            "13:17: sample_period = 0.01 s is too long: the shortest phase lasts 0.0006 s and needs ten samples; "
            "lower jerk",
        ),
        (
            {
                "sample_period": 0.15,
                "jerk": 1.0,
                "acceleration": 3.0,
                "creep_acceleration": 3.0,
                "deceleration": 3.0,
                "creep_velocity": 3.0,
            },
            "13:17: sample_period = 0.15 s is too long to stop within 1 mm at jerk = 1 m/s3; "
            "write at most 0.114, or lower jerk",
        ),
        (
            {"creep_in": 0.1},
            "24:12: creep_in = 0.1 m is shorter than what the hoist travels in one sample period at full speed; "
            "write at least 0.12, or shorten sample_period",
        ),
        (
            {"creep_velocity": 0.01, "travel": 6000.0},
            "21:18: creep_velocity = 0.01 m/s is too slow: at travel = 6000 a REAL does not resolve a sample period "
            "of it; write at least 0.2862",
        ),
        (
            {"overwind": 0.01},
            "33:12: overwind = 0.01 m is too near to the 0.011 that count as arrived; write at least 0.01679, "
            "or lower creep_velocity",
        ),
        (
            {"travel": 5.1},
            "13:17: sample_period = 0.01 s is too long: the shortest phase lasts 0.01683 s and needs ten samples; "
            "write at most 0.001, or lengthen travel",
        ),
        (
            {"overspeed_factor": 1.0},
            "26:2: the envelope is 0.00012 m/s too low 492.8 m before the end, where it must lie above the setpoint; "
            "raise overspeed_factor, the tracking values, brake_deceleration or end_velocity, or shorten reaction_time",
        ),
        (
            {"brake_deceleration": 0.3},
            "26:2: the envelope is 4.04 m/s too low 97.62 m before the end, where it must lie above the setpoint; "
            "raise overspeed_factor, the tracking values, brake_deceleration or end_velocity, or shorten reaction_time",
        ),
    ],
)
def test_refusals(values: dict[str, float], message: str) -> None:
    assert refusal(**values) == f"job.toml:{message}"


def test_period_that_is_named_as_the_way_out_is_one() -> None:
    assert derived(jerk=5.0, sample_period=0.006).shortest_jerk_time == pytest.approx(0.06)


@pytest.mark.parametrize("unit", ["m", "mm"])
def test_travel_that_is_named_as_the_way_out_is_one(unit: str) -> None:
    """Rounded up, and never with an exponent."""
    scale = {"m": 1, "mm": 1000}[unit]
    limits = parse_job(EXAMPLE, "job.toml").hoist.model_dump(exclude={"envelope"})
    values = {key: value * scale for key, value in limits.items() if key != "creep_out"}
    text = job_text(**values, creep_out=20.0 * scale).replace('length_unit = "m"', f'length_unit = "{unit}"')
    text = text.replace(f"travel = {values['travel']!r}", f"travel = {20 * scale}").split("[hoist.envelope]")[0]
    with pytest.raises(JobError, match=rf" need {23.64 * scale:g} {unit};"):
        derive(parse_job(text, "job.toml"))
    with pytest.raises(JobError, match="lengthen travel"):
        derive(parse_job(text.replace(f"travel = {20 * scale}", f"travel = {23.64 * scale:g}"), "job.toml"))


@settings(max_examples=50, deadline=None, print_blob=True)
@given(trips())
def test_ten_samples_in_the_shortest_phase_keep_the_loop_over_travel_calm(trip: Trip) -> None:
    """g = T a/v stays below 0.071, far from the 1/4 where the loop begins to swing."""
    gain = max(trip.acceleration.steepest_gain, trip.deceleration.steepest_gain)
    assert trip.shortest_jerk_time / 10 * gain <= 0.1 / np.sqrt(2) * (1 + 1e-12)


@pytest.mark.parametrize(
    "values",
    [
        {"overspeed_factor": 1.0},
        {"tracking_factor": 1.0, "tracking_margin": 0.0},
        {"overspeed_factor": 1.000009},
        {"end_velocity": 0.3, "reaction_time": 2.0},
        {"brake_deceleration": 0.7},
        # The deceleration lasts a thousandth of the trip.
        {"travel": 10000.0, "max_velocity": 2.0, "brake_deceleration": 0.01, "end_velocity": 1.0},
    ],
)
def test_no_job_whose_envelope_is_not_above_the_setpoint(values: dict[str, float]) -> None:
    assert "too low" in refusal(**values)


@settings(max_examples=25, deadline=None, print_blob=True)
@given(
    st.floats(1.0, 1.3),
    st.floats(1.0, 1.3),
    st.floats(0.0, 0.5),
    magnitude(0.2, 3.0),
    st.floats(0.0, 2.0),
    magnitude(0.3, 3.0),
    magnitude(0.5, 20.0),
    magnitude(10.0, 1e5),
)
def test_an_accepted_envelope_clears_the_setpoint_everywhere(
    overspeed: float, factor: float, margin: float, brake: float, reaction: float, end: float, speed: float, way: float
) -> None:
    """On a grid of another kind than the derivation's: even in travel, and dense before the end."""
    try:
        trip = derived(
            overspeed_factor=overspeed,
            tracking_factor=factor,
            tracking_margin=margin,
            brake_deceleration=brake,
            reaction_time=reaction,
            end_velocity=end,
            max_velocity=speed,
            travel=way,
        )
    except JobError:
        return
    travelled = np.concatenate((np.linspace(0.0, way, 1000), way - np.geomspace(1e-6, way, 1000)))
    clear = trip.envelope.velocity(travelled, way - travelled) - trip.reference.at_travel(travelled).velocity
    assert clear.min() > 0.9 * ENVELOPE_CLEARANCE * speed


def flat(groups: tuple[ConstantGroup, ...]) -> dict[str, float]:
    return {constant.name: constant.value for group in groups for constant in group.constants}


def test_constants_of_the_example() -> None:
    job = parse_job(EXAMPLE, "job.toml")
    constants = flat(hoist_constants(job, derive(job)))
    assert len(constants) == sum(len(group.constants) for group in hoist_constants(job, derive(job)))
    assert constants["ACC_TRAVEL"] == constants["DEC_TRAVEL"] == pytest.approx(105.2083333)
    assert constants["ACC_BEGIN"] == pytest.approx(1.9996667)
    assert constants["DEC_END"] == pytest.approx(3.0666667)
    assert constants["MAX_CYCLE_TIME"] == pytest.approx(0.06)
    assert constants["POSITION_WINDOW"] == pytest.approx(0.011)
    assert constants["SAFE_SQUARE"] == 4.5625


def test_every_constant_has_a_unit_and_a_meaning() -> None:
    job = parse_job(EXAMPLE, "job.toml")
    trip = derive(job)
    rows = [constant for group in hoist_constants(job, trip) for constant in group.constants]
    for constant in (*rows, *transition_table(trip.acceleration, "m")):
        assert constant.unit
        assert constant.comment
        assert np.isfinite(constant.value)


def test_legs_that_are_there_to_be_named() -> None:
    names = [leg.name for leg in derived().legs]
    assert (names[CREEP_OUT - 1], names[CREEP_IN - 1]) == ("creep out", "creep in")
