"""Short situations: wrong inputs, commands, restarts, and the trip curve, each with what the block must answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from math import inf, nan

import numpy as np

from plcgen.check.hoist_bench import Bench, at_rest
from plcgen.check.hoist_expectation import LAW_ERROR, Segment, stop_from, travel_resolution
from plcgen.check.hoist_model import CREEP_OUT, FULL_SPEED, STANDSTILL, STOPPING, HoistModel
from plcgen.check.rig import Rig, Snapshot
from plcgen.check.verdict import Check

AT_THE_STOP, AT_REST, FIRST_SCAN, STATUS_STOPPING = 0x0000, 0x7000, 0x7001, 0x7003
ERROR_TRAVEL, ERROR_VELOCITY, ERROR_CYCLE_TIME, ERROR_STOPS, ERROR_JUMP = range(0x8201, 0x8206)
TRIPPED = 0x8401
# Limits are probed half a percent to either side.
PROBE = 0.005


@dataclass(frozen=True)
class Case:
    """Inputs that are replaced while the hoist stands or moves, and the status that must follow (None: no error)."""

    name: str
    inputs: dict[str, float]
    status: int | None


def input_cases(model: HoistModel) -> tuple[Case, ...]:
    """Every input that may be wrong, and the limits of what is not, from either side."""
    limits = model.limits
    travel, overwind = limits.travel, limits.envelope.overwind
    longest = model.shortest_jerk_time / 10
    no_numbers = (("not a number", nan), ("infinite", inf), ("minus infinite", -inf))
    return (
        *(Case(f"travel {word}", {"actualTravel": value}, ERROR_TRAVEL) for word, value in no_numbers),
        Case("travel above", {"actualTravel": travel + overwind * (1 + PROBE)}, ERROR_TRAVEL),
        Case("travel below", {"actualTravel": -overwind * (1 + PROBE)}, ERROR_TRAVEL),
        *(Case(f"velocity {word}", {"actualVelocity": value}, ERROR_VELOCITY) for word, value in no_numbers),
        Case("velocity above", {"actualVelocity": 10 * limits.max_velocity * (1 + PROBE)}, ERROR_VELOCITY),
        Case("velocity below", {"actualVelocity": -10 * limits.max_velocity * (1 + PROBE)}, ERROR_VELOCITY),
        Case("velocity plausible", {"actualVelocity": 10 * limits.max_velocity * (1 - PROBE)}, TRIPPED),
        Case("velocity plausible, down", {"actualVelocity": -10 * limits.max_velocity * (1 - PROBE)}, TRIPPED),
        *(Case(f"cycle time {word}", {"cycleTime": value}, ERROR_CYCLE_TIME) for word, value in no_numbers),
        Case("cycle time zero", {"cycleTime": 0.0}, ERROR_CYCLE_TIME),
        Case("cycle time negative", {"cycleTime": -model.sample_period}, ERROR_CYCLE_TIME),
        Case("cycle time too long", {"cycleTime": longest * (1 + PROBE)}, ERROR_CYCLE_TIME),
        Case("cycle time long", {"cycleTime": longest * (1 - PROBE)}, None),
        *(Case(f"lower stop {word}", {"lowerStop": value}, ERROR_STOPS) for word, value in no_numbers),
        *(Case(f"upper stop {word}", {"upperStop": value}, ERROR_STOPS) for word, value in no_numbers),
        Case("stops reversed", {"lowerStop": travel, "upperStop": 0.0}, ERROR_STOPS),
        Case("lower stop far", {"lowerStop": -4 * travel * (1 + PROBE)}, ERROR_STOPS),
        Case("lower stop less far", {"lowerStop": -4 * travel * (1 - PROBE)}, None),
        Case("upper stop far", {"upperStop": 4 * travel * (1 + PROBE)}, ERROR_STOPS),
        Case("upper stop less far", {"upperStop": 4 * travel * (1 - PROBE)}, None),
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
    standing = _standing(bench, bench.model.limits.travel / 2)
    yield _wrong("wrong_answers_at_rest", [_at_rest(standing, case) for case in input_cases(bench.model)])
    yield _wrong("wrong_jump_answers", [*_jumps(standing), *_overwind(bench)])
    yield _wrong("wrong_commands", list(_commands(bench)))
    yield _wrong("wrong_restarts", list(_restarts(bench)))
    yield from _trip_curve(bench)
    yield from _moving(bench)


def _wrong(name: str, answers: list[str]) -> Check:
    wrong = [answer for answer in answers if answer]
    return Check(name, float(len(wrong)), 0.0, "1", detail="; ".join(wrong))


def _standing(bench: Bench, travel: float) -> tuple[Rig, Snapshot]:
    rig = bench.rig(travel)
    rig.set(directionUp=True)
    rig.run(2)
    return rig, rig.snapshot()


def _differs(rig: Rig, situation: str, **wanted: float) -> str:
    """Empty, or what came out instead."""
    for name, value in wanted.items():
        if rig.get(name) != value:
            return f"{situation}: {name} = {rig.get(name):g}, not {value:g}"
    return ""


def _apply(rig: Rig, inputs: dict[str, float]) -> None:
    for name, value in inputs.items():
        if name in (rig.TRAVEL, rig.VELOCITY):
            rig.force(**{name: value})
        else:
            rig.set(**{name: value})


def _press_reset(rig: Rig) -> None:
    rig.set(reset=True)
    rig.scan()
    rig.set(reset=False)


def _at_rest(standing: tuple[Rig, Snapshot], case: Case) -> str:
    """The error shows at once, stays after its cause has gone, refuses a start, and goes with a fresh reset."""
    rig, moment = standing
    rig.restore(moment)
    inputs = {name: rig.variable(name).get() for name in case.inputs}
    _apply(rig, case.inputs)
    rig.scan()
    error, tripped = case.status not in (None, TRIPPED), case.status == TRIPPED
    status = AT_REST if case.status is None else case.status
    answers = [_differs(rig, case.name, status=status, error=error, overspeedTrip=tripped, velocitySetpoint=0.0)]
    if case.status is None:
        return answers[0]
    _press_reset(rig)
    rig.scan()
    answers.append(_differs(rig, f"{case.name}, reset while it lasts", status=status))
    _apply(rig, {name: value for name, value in inputs.items() if name not in (rig.TRAVEL, rig.VELOCITY)})
    rig.release()
    rig.set(enable=True)
    rig.scan()
    answers.append(_differs(rig, f"{case.name}, start in spite of it", status=status, phase=STANDSTILL))
    _press_reset(rig)
    answers.append(_differs(rig, f"{case.name}, reset", status=AT_REST, error=0, overspeedTrip=0, phase=STANDSTILL))
    return next((answer for answer in answers if answer), "")


def _jumps(standing: tuple[Rig, Snapshot]) -> Iterator[str]:
    rig, moment = standing
    for sign in (1, -1):
        for share, status in ((1 - PROBE, AT_REST), (1 + PROBE, ERROR_JUMP)):
            rig.restore(moment)
            step = 2 * rig.get("envelopeVelocity") * rig.get("cycleTime")
            rig.force(actualTravel=rig.plant.travel + sign * share * step)
            rig.scan()
            yield _differs(rig, f"jump of {sign * share:g} steps", status=status)


def _overwind(bench: Bench) -> Iterator[str]:
    """Just within the overwind there is no error, but no start beyond the stop either."""
    limits = bench.model.limits
    inside = limits.envelope.overwind * (1 - PROBE)
    for up, place in ((True, limits.travel + inside), (False, -inside)):
        rig, _ = _standing(bench, place)
        rig.set(directionUp=up)
        rig.scan()
        rig.set(enable=True)
        rig.scan()
        yield _differs(rig, "start beyond the stop", status=AT_REST, phase=STANDSTILL, inPosition=0, error=0)
    yield from _window(bench)


def _window(bench: Bench) -> Iterator[str]:
    """Around the lower stop, where REAL resolves half a percent of the window."""
    window = bench.model.position_window
    for share, arrived in ((1 - PROBE, 1), (1 + PROBE, 0)):
        for side in (1, -1):
            rig, _ = _standing(bench, side * share * window)
            rig.set(directionUp=False)
            rig.scan()
            yield _differs(rig, "position window", inPosition=arrived, status=AT_THE_STOP if arrived else AT_REST)
        rig, _ = _standing(bench, share * window)
        rig.set(directionUp=False)
        rig.scan()
        rig.set(enable=True)
        rig.scan()
        yield _differs(rig, "start within the window", busy=1 - arrived)


def _commands(bench: Bench) -> Iterator[str]:
    rig = bench.rig(0.0)
    rig.set(enable=True, directionUp=True)
    rig.run(3)
    yield _differs(rig, "enable at a cold start", phase=STANDSTILL, status=AT_REST)
    rig.set(enable=False)
    rig.scan()
    rig.set(enable=True, stop=True)
    rig.scan()
    yield _differs(rig, "enable with stop", phase=STANDSTILL, status=AT_REST)
    rig.set(stop=False)
    rig.run(3)
    yield _differs(rig, "stop released", phase=STANDSTILL, status=AT_REST)
    rig.set(enable=False, directionUp=False)
    rig.scan()
    yield _differs(rig, "at the lower stop", inPosition=1, status=AT_THE_STOP, distanceToGo=0.0)
    rig.set(directionUp=True)
    rig.scan()
    yield _differs(rig, "facing up", inPosition=0, status=AT_REST)
    rig.set(enable=True)
    rig.scan()
    yield _differs(rig, "start", phase=1, status=FIRST_SCAN, busy=1)
    rig.run(20)
    rig.set(reset=True)
    rig.force(actualVelocity=1.01 * rig.get("envelopeVelocity"))
    rig.scan()
    yield _differs(rig, "overspeed on the way", status=TRIPPED, overspeedTrip=1, phase=STOPPING, error=0)
    rig.release()
    rig.set(reset=False)
    rig.scan()
    _press_reset(rig)
    yield _differs(rig, "reset on the way", overspeedTrip=1, phase=STOPPING)
    rig.run(bench.longest_stop, at_rest)
    yield _differs(rig, "at rest after overspeed", overspeedTrip=1, status=TRIPPED, phase=STANDSTILL)
    rig.set(enable=False)
    rig.scan()
    rig.set(enable=True)
    rig.scan()
    yield _differs(rig, "start in spite of the trip", phase=STANDSTILL, status=TRIPPED)
    _press_reset(rig)
    rig.run(3)
    yield _differs(rig, "acknowledged", overspeedTrip=0, status=AT_REST, phase=STANDSTILL)
    rig.set(enable=False)
    rig.scan()
    rig.set(enable=True)
    rig.scan()
    yield _differs(rig, "fresh start", phase=1, status=FIRST_SCAN)


def _restarts(bench: Bench) -> Iterator[str]:
    """A restart takes the speed of the hoist over, keeps the overspeed trip, and wants a fresh start."""
    model = bench.model
    creep, travel = model.limits.creep_velocity, model.limits.travel
    for sign in (1, -1):
        for speed in (0.02 * creep, creep, 0.5 * model.trip(travel).cruise_velocity):
            rig, _ = _standing(bench, travel / 2)
            rig.set(restart=True, enable=True, directionUp=sign < 0)
            rig.plant.velocity = sign * speed
            rig.scan()
            rig.set(restart=False)
            first = rig.scans - 1
            yield _differs(rig, "restart on the way", phase=STOPPING, status=STATUS_STOPPING)
            rig.run(bench.longest_stop, at_rest)
            rig.run(2)
            yield _differs(rig, "rest after a restart", phase=STANDSTILL, status=AT_REST)
            yield _bumpless(model, Segment(rig.trace(), first, rig.scans, sign > 0), speed)
        rig, _ = _standing(bench, travel / 2)
        rig.set(restart=True)
        rig.force(actualVelocity=sign * 0.01 * creep * (1 - PROBE))
        rig.scan()
        yield _differs(rig, "restart at rest", phase=STANDSTILL, status=AT_REST)
        rig.force(actualVelocity=sign * 0.01 * creep * (1 + PROBE))
        rig.scan()
        yield _differs(rig, "restart at a crawl", phase=STOPPING)
    rig, _ = _standing(bench, travel / 2)
    rig.force(actualTravel=nan)
    rig.scan()
    rig.release()
    rig.set(restart=True, reset=True)
    rig.scan()
    yield _differs(rig, "restart clears errors", status=AT_REST, error=0)
    rig.force(actualVelocity=2 * model.limits.max_velocity)
    rig.set(restart=False)
    rig.scan()
    rig.release()
    rig.set(restart=True)
    rig.run(2)
    yield _differs(rig, "restart keeps the trip", status=TRIPPED, overspeedTrip=1)


def _bumpless(model: HoistModel, segment: Segment, speed: float) -> str:
    expected = stop_from(model, segment, speed, 0.0)
    worst = float(
        np.max(np.abs(segment.sign * segment.column("velocitySetpoint") - expected.velocity) - expected.velocity_bound)
    )
    return f"restart at {speed:g}: setpoint {worst:.3g} beyond its bound" if worst > 0 else ""


def _trip_curve(bench: Bench) -> Iterator[Check]:
    """The envelope at 200 places in both directions, and the trip a little below and above it, moving either way."""
    model, worst, answers = bench.model, (0.0, 1.0), []
    travel = model.limits.travel
    rig, moment = _standing(bench, 0.0)
    for up in (True, False):
        for number, place in enumerate(np.linspace(0.0, travel, 200, dtype=np.float32).astype(float)):
            rig.restore(moment)
            rig.set(directionUp=up, restart=True)
            rig.force(actualTravel=place)
            rig.scan()
            rig.set(restart=False)
            behind, ahead = (place, travel - place) if up else (travel - place, place)
            expected = float(model.envelope(np.array([behind]), np.array([ahead]))[0])
            segment = Segment(rig.trace(), 0, 1, up)
            bound = float(envelope_bound(model, segment, np.array([expected]))[0])
            deviation = abs(rig.get("envelopeVelocity") - expected)
            worst = max(worst, (deviation, bound), key=lambda pair: pair[0] / pair[1])
            for share, tripped in ((1 - PROBE / 10, 0), (1 + PROBE / 10, 1)):
                rig.force(actualVelocity=(-1) ** number * share * expected)
                rig.scan()
                answers.append(_differs(rig, f"{share:g} of the envelope at {place:g}", overspeedTrip=tripped))
    yield Check("trip_curve_deviation", *worst, f"{model.unit}/s")
    yield _wrong("wrong_trips", answers)


def envelope_bound(model: HoistModel, segment: Segment, expected: np.ndarray) -> np.ndarray:
    """The error of the law, scaled like it; of the root, with the reaction speed that is taken off again; of travel."""
    guard = model.limits.envelope
    reaction = guard.brake_deceleration * guard.reaction_time
    scale = max(1.0, guard.tracking_factor)
    return LAW_ERROR * (scale * expected + 2 * reaction) + scale * model.steepest_gain * travel_resolution(
        model, segment
    )


def _reached(phase: int, rig: Rig) -> bool:
    return rig.get("phase") >= phase


def _moving(bench: Bench) -> Iterator[Check]:
    """Each wrong input while the hoist creeps, and one at full speed: the stop law from the first scan on."""
    answers, worst = [], (0.0, 1.0)
    for phase, cases in ((CREEP_OUT, input_cases(bench.model)), (FULL_SPEED, input_cases(bench.model)[:1])):
        rig = bench.rig(0.0)
        rig.set(directionUp=True)
        rig.scan()
        rig.set(enable=True)
        if not rig.run(bench.longest_trip, partial(_reached, phase)):
            answers.append(f"phase {phase} is never reached")
            continue
        rig.run(5)
        moment = rig.snapshot()
        for case in cases:
            if case.status is None:
                continue
            rig.restore(moment)
            answer, figure = _emergency_stop(bench, rig, case)
            answers.append(answer)
            worst = max(worst, figure, key=lambda pair: pair[0] / pair[1])
    yield _wrong("wrong_emergency_stops", answers)
    yield Check("emergency_stop_deviation", *worst, f"{bench.model.unit}/s")


def _emergency_stop(bench: Bench, rig: Rig, case: Case) -> tuple[str, tuple[float, float]]:
    velocity, acceleration = rig.get("velocitySetpoint"), rig.get("acceleration")
    kept = rig.get("envelopeVelocity")
    _apply(rig, case.inputs)
    rig.scan()
    moving = {"phase": STOPPING, "error": case.status != TRIPPED}
    answer = _differs(rig, f"{case.name} on the way", status=case.status or 0, **moving)
    if case.status in (ERROR_TRAVEL, ERROR_STOPS):
        answer = answer or _differs(rig, f"{case.name} on the way", envelopeVelocity=kept, distanceToGo=0.0)
    stopped = rig.run(bench.longest_stop, at_rest)
    rig.run(2)
    answer = answer or ("" if stopped else f"{case.name} on the way: never comes to rest")
    segment = Segment(rig.trace(), 0, len(rig.trace()), True)
    expected = stop_from(bench.model, segment, velocity, acceleration)
    deviation = np.abs(segment.column("velocitySetpoint") - expected.velocity)
    bounds = np.broadcast_to(expected.velocity_bound, deviation.shape)
    row = int(np.argmax(deviation / bounds))
    return answer, (float(deviation[row]), float(bounds[row]))
