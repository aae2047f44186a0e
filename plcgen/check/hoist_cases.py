"""Short situations: wrong inputs at rest and on the way, and the trip curve, each with what the block must answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, nan

import numpy as np

from plcgen.check.hoist_answers import (
    AT_REST,
    AT_THE_STOP,
    ERROR_CYCLE_TIME,
    ERROR_JUMP,
    ERROR_STOPS,
    ERROR_TRAVEL,
    ERROR_VELOCITY,
    PROBE,
    TRIPPED,
    differs,
    press_reset,
    standing,
    wrong,
)
from plcgen.check.hoist_bench import RESTING, Bench, reached
from plcgen.check.hoist_commands import commands, restarts
from plcgen.check.hoist_expectation import LAW_ERROR, Segment, stop_from, travel_resolution
from plcgen.check.hoist_model import CREEP_IN, CREEP_OUT, FULL_SPEED, STANDSTILL, STOPPING, HoistModel
from plcgen.check.rig import Rig, Snapshot
from plcgen.check.verdict import Check


@dataclass(frozen=True)
class Case:
    """Inputs that are replaced while the hoist stands or moves, and the status that must follow (None: no error)."""

    name: str
    inputs: dict[str, float]
    status: int | None


def input_cases(model: HoistModel) -> tuple[Case, ...]:
    """Every input that may be wrong, and the limits of what is not: the limit itself, and a value beyond it."""
    limits = model.limits
    travel, overwind = limits.travel, limits.envelope.overwind
    beyond = overwind * (1 + PROBE) + 2.0**-22 * travel  # by more than two spacings of REAL
    longest = model.shortest_jerk_time / 10
    no_numbers = (("not a number", nan), ("infinite", inf), ("minus infinite", -inf))
    return (
        *(Case(f"travel {word}", {"actualTravel": value}, ERROR_TRAVEL) for word, value in no_numbers),
        Case("travel above", {"actualTravel": travel + beyond}, ERROR_TRAVEL),
        Case("travel below", {"actualTravel": -beyond}, ERROR_TRAVEL),
        *(Case(f"velocity {word}", {"actualVelocity": value}, ERROR_VELOCITY) for word, value in no_numbers),
        Case("velocity above", {"actualVelocity": 10 * limits.max_velocity * (1 + PROBE)}, ERROR_VELOCITY),
        Case("velocity below", {"actualVelocity": -10 * limits.max_velocity * (1 + PROBE)}, ERROR_VELOCITY),
        Case("velocity plausible", {"actualVelocity": 10 * limits.max_velocity}, TRIPPED),
        Case("velocity plausible, down", {"actualVelocity": -10 * limits.max_velocity}, TRIPPED),
        *(Case(f"cycle time {word}", {"cycleTime": value}, ERROR_CYCLE_TIME) for word, value in no_numbers),
        Case("cycle time zero", {"cycleTime": 0.0}, ERROR_CYCLE_TIME),
        Case("cycle time negative", {"cycleTime": -model.sample_period}, ERROR_CYCLE_TIME),
        Case("cycle time too long", {"cycleTime": longest * (1 + PROBE)}, ERROR_CYCLE_TIME),
        Case("cycle time long", {"cycleTime": longest}, None),
        Case("cycle time short", {"cycleTime": 1e-6}, None),
        *(Case(f"lower stop {word}", {"lowerStop": value}, ERROR_STOPS) for word, value in no_numbers),
        *(Case(f"upper stop {word}", {"upperStop": value}, ERROR_STOPS) for word, value in no_numbers),
        Case("stops reversed", {"lowerStop": travel, "upperStop": 0.0}, ERROR_STOPS),
        Case("lower stop far", {"lowerStop": -4 * travel * (1 + PROBE)}, ERROR_STOPS),
        Case("lower stop less far", {"lowerStop": -4 * travel}, None),
        Case("upper stop far", {"upperStop": 4 * travel * (1 + PROBE)}, ERROR_STOPS),
        Case("upper stop less far", {"upperStop": 4 * travel}, None),
        Case("lower stop high", {"lowerStop": 5 * travel, "upperStop": 6 * travel}, ERROR_STOPS),
        Case("upper stop low", {"lowerStop": -6 * travel, "upperStop": -5 * travel}, ERROR_STOPS),
        Case("stops too close", _stops_around(model, 1 - PROBE), ERROR_STOPS),
        Case("stops close", _stops_around(model, 1 + PROBE), None),
    )


def _stops_around(model: HoistModel, share: float) -> dict[str, float]:
    """Stops that leave a share of the shortest travel, around the middle of the shaft."""
    middle, half = model.limits.travel / 2, share * model.min_travel / 2
    return {"lowerStop": middle - half, "upperStop": middle + half}


def case_checks(bench: Bench) -> Iterator[Check]:
    """Figures that count answers which are not the documented ones, and the deviation of emergency stops."""
    rest = standing(bench, bench.model.limits.travel / 2)
    yield wrong("wrong_answers_at_rest", [_at_rest(rest, case) for case in input_cases(bench.model)])
    yield wrong("wrong_jump_answers", [*_jumps(bench), *_overwind(bench), *_window(bench)])
    yield wrong("wrong_commands", list(commands(bench)))
    yield wrong("wrong_restarts", list(restarts(bench)))
    yield from _trip_curve(bench)
    yield from _moving(bench)


def _apply(rig: Rig, inputs: dict[str, float]) -> None:
    for name, value in inputs.items():
        if name in (rig.TRAVEL, rig.VELOCITY):
            rig.force(**{name: value})
        else:
            rig.set(**{name: value})


def _at_rest(rest: tuple[Rig, Snapshot], case: Case) -> str:
    """The error shows at once, stays after its cause has gone, refuses a start, and goes with a fresh reset."""
    rig, moment = rest
    rig.restore(moment)
    inputs = {name: rig.variable(name).get() for name in case.inputs}
    _apply(rig, case.inputs)
    rig.scan()
    error, tripped = case.status not in (None, TRIPPED), case.status == TRIPPED
    status = AT_REST if case.status is None else case.status
    answers = [differs(rig, case.name, status=status, error=error, overspeedTrip=tripped, velocitySetpoint=0.0)]
    if case.status is None:
        return answers[0]
    press_reset(rig)
    rig.scan()
    answers.append(differs(rig, f"{case.name}, reset while it lasts", status=status))
    _apply(rig, {name: value for name, value in inputs.items() if name not in (rig.TRAVEL, rig.VELOCITY)})
    rig.release()
    rig.set(enable=True)
    rig.scan()
    answers.append(differs(rig, f"{case.name}, start in spite of it", status=status, phase=STANDSTILL))
    press_reset(rig)
    answers.append(differs(rig, f"{case.name}, reset", status=AT_REST, error=0, overspeedTrip=0, phase=STANDSTILL))
    return next((answer for answer in answers if answer), "")


def _jumps(bench: Bench) -> Iterator[str]:
    """Near the lower stop, where REAL resolves the travel best."""
    envelope = standing(bench, 0.0)[0].get("envelopeVelocity")
    step = 2 * envelope * bench.model.sample_period + bench.model.millimetre
    rig, moment = standing(bench, 2 * step)
    for sign in (1, -1):
        for share, status in ((1 - PROBE / 50, AT_REST), (1 + PROBE / 50, ERROR_JUMP)):
            rig.restore(moment)
            rig.force(actualTravel=2 * step + sign * share * step)
            rig.scan()
            yield differs(rig, f"jump of {sign * share:g} steps", status=status)


def _overwind(bench: Bench) -> Iterator[str]:
    """Up to the end of the overwind there is no error, but no start beyond the stop either."""
    limits = bench.model.limits
    overwind = np.float32(limits.envelope.overwind)
    for up, place in ((True, float(np.float32(limits.travel) + overwind)), (False, -float(overwind))):
        rig, _ = standing(bench, place)
        rig.set(directionUp=up)
        rig.scan()
        rig.set(enable=True)
        rig.scan()
        yield differs(rig, "start beyond the stop", status=AT_REST, phase=STANDSTILL, inPosition=0, error=0)


def _window(bench: Bench) -> Iterator[str]:
    """The end of the window around the lower stop, where REAL resolves it best."""
    window = bench.model.position_window
    for share, arrived in ((1.0, 1), (1 + PROBE, 0)):
        for side in (1, -1):
            rig, _ = standing(bench, side * share * window)
            rig.set(directionUp=False)
            rig.scan()
            yield differs(rig, "position window", inPosition=arrived, status=AT_THE_STOP if arrived else AT_REST)
        rig, _ = standing(bench, share * window)
        rig.set(directionUp=False)
        rig.scan()
        rig.set(enable=True)
        rig.scan()
        yield differs(rig, "start within the window", busy=1 - arrived)


def _trip_curve(bench: Bench) -> Iterator[Check]:
    """The envelope all along the shaft in both directions, and the trip on it, below and above, moving either way."""
    model, worst, answers = bench.model, (0.0, 1.0), []
    travel = model.limits.travel
    rig, moment = standing(bench, 0.0)
    places = _places(travel)
    for up in (True, False):
        behind, ahead = (places, travel - places) if up else (travel - places, places)
        curve = model.envelope(behind, ahead).tolist()
        for number, (place, expected) in enumerate(zip(places.tolist(), curve, strict=True)):
            rig.restore(moment)
            rig.set(directionUp=up, restart=True)
            rig.force(actualTravel=place)
            rig.scan()
            rig.set(restart=False)
            segment = Segment(rig.trace(), 0, 1, up)
            bound = float(envelope_bound(model, segment, np.array([expected]))[0])
            deviation = abs(rig.get("envelopeVelocity") - expected)
            worst = max(worst, (deviation, bound), key=lambda pair: pair[0] / pair[1])
            shown = rig.get("envelopeVelocity")
            for velocity, tripped in ((shown, 0), (expected * (1 - PROBE / 10), 0), (expected * (1 + PROBE / 10), 1)):
                rig.force(actualVelocity=(-1) ** number * velocity)
                rig.scan()
                answers.append(differs(rig, f"{velocity:g} of {expected:g} at {place:g}", overspeedTrip=tripped))
    yield Check("trip_curve_deviation", *worst, f"{model.unit}/s")
    yield wrong("wrong_trips", answers)


def _places(travel: float) -> np.ndarray:
    """200 places as REAL holds them, and 20 that crowd each stop."""
    crowd = np.geomspace(1e-5, 0.02, 20) * travel
    places = np.concatenate([np.linspace(0.0, travel, 200), crowd, travel - crowd])
    return places.astype(np.float32).astype(np.float64)


def envelope_bound(model: HoistModel, segment: Segment, expected: np.ndarray) -> np.ndarray:
    """The error of the law, scaled like it; of the root, with the reaction speed that is taken off again; of travel,
    by the gain of the law, and of the root, a_b/(v + a_b t_r).
    """
    guard = model.limits.envelope
    reaction = guard.brake_deceleration * guard.reaction_time
    scale = max(1.0, guard.tracking_factor)
    gain = scale * model.steepest_gain + guard.brake_deceleration / (expected + reaction)
    bound: np.ndarray = LAW_ERROR * (scale * expected + 2 * reaction) + gain * travel_resolution(model, segment)
    return bound


def _moving(bench: Bench) -> Iterator[Check]:
    """Each wrong input while the hoist creeps, and one at full speed: the stop law from the first scan on."""
    answers, worst = [], (0.0, 1.0)
    for phase, cases in ((CREEP_OUT, input_cases(bench.model)), (FULL_SPEED, input_cases(bench.model)[:1])):
        rig = bench.rig(0.0)
        rig.set(directionUp=True)
        rig.scan()
        rig.set(enable=True)
        if not rig.run(bench.longest_trip, reached(phase)):
            answers.append(f"phase {phase} is never reached")
            continue
        moment = rig.snapshot()
        rig.run(5)
        if rig.get("phase") <= CREEP_IN:
            moment = rig.snapshot()
        for case in cases:
            if case.status is None:
                continue
            rig.restore(moment)
            answer, figure = _emergency_stop(bench, rig, case)
            answers.append(answer)
            worst = max(worst, figure, key=lambda pair: pair[0] / pair[1])
    yield wrong("wrong_emergency_stops", answers)
    yield Check("emergency_stop_deviation", *worst, f"{bench.model.unit}/s")


def _emergency_stop(bench: Bench, rig: Rig, case: Case) -> tuple[str, tuple[float, float]]:
    velocity, acceleration = rig.get("velocitySetpoint"), rig.get("acceleration")
    kept = rig.get("envelopeVelocity")
    _apply(rig, case.inputs)
    rig.scan()
    moving = {"phase": STOPPING, "error": case.status != TRIPPED}
    answer = differs(rig, f"{case.name} on the way", status=case.status or 0, **moving)
    if case.status in (ERROR_TRAVEL, ERROR_STOPS):
        answer = answer or differs(rig, f"{case.name} on the way", envelopeVelocity=kept, distanceToGo=0.0)
    stopped = rig.run(bench.longest_stop, RESTING)
    rig.run(2)
    answer = answer or ("" if stopped else f"{case.name} on the way: never comes to rest")
    segment = Segment(rig.trace(), 0, len(rig.trace()), True)
    expected = stop_from(bench.model, segment, velocity, acceleration)
    deviation = np.abs(segment.column("velocitySetpoint") - expected.velocity)
    bounds = np.broadcast_to(expected.velocity_bound, deviation.shape)
    row = int(np.argmax(deviation / bounds))
    return answer, (float(deviation[row]), float(bounds[row]))
