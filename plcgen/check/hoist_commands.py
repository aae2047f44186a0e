"""Commands and restarts: what starts a trip, what ends it, what must not start one, and what a restart takes over."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, nan

import numpy as np

from plcgen.check.hoist_answers import (
    AT_REST,
    AT_THE_STOP,
    COMING_TO_REST,
    ERROR_TRAVEL,
    FIRST_SCAN,
    IN_PROGRESS,
    PROBE,
    REST_SHARE,
    TRIPPED,
    differs,
    press_enable,
    press_reset,
    standing,
)
from plcgen.check.hoist_bench import RESTING, Bench, reached
from plcgen.check.hoist_expectation import LAW_ERROR, Segment, peak_acceleration, stop_from, travel_resolution
from plcgen.check.hoist_model import (
    ACCELERATE,
    CREEP_IN,
    CREEP_OUT,
    DECELERATE,
    STANDSTILL,
    START_RAMP,
    STOP_RAMP,
    STOPPING,
    HoistModel,
)
from plcgen.check.rig import Goal, Rig

SAFE = {"velocitySetpoint": 0.0, "limitedSetpoint": 0.0, "acceleration": 0.0, "phase": STANDSTILL, "busy": 0}


def commands(bench: Bench) -> Iterator[str]:
    """Each answer is empty, or says what is wrong."""
    yield from _before_the_first_trip(bench)
    yield from _overspeed(bench)
    yield from _stop_in_the_stop_ramp(bench)
    yield from _late_stop_ramp(bench)
    yield from _clamp(bench)


def _before_the_first_trip(bench: Bench) -> Iterator[str]:
    rig = bench.rig(0.0)
    flags = {"overspeedTrip": 0, "error": 0, "inPosition": 0}
    yield differs(rig, "before the first call", envelopeVelocity=0.0, distanceToGo=0.0, status=AT_REST, **flags, **SAFE)
    rig.scan()
    yield differs(rig, "no command, at the lower stop", inPosition=1, status=AT_THE_STOP, **SAFE)
    rig = bench.rig(0.0)
    rig.set(enable=True, directionUp=True)
    rig.run(3)
    yield differs(rig, "enable at a cold start", status=AT_REST, **SAFE)
    rig.set(enable=False)
    rig.scan()
    rig.set(enable=True, stop=True)
    rig.scan()
    yield differs(rig, "enable with stop", status=AT_REST, **SAFE)
    rig.set(stop=False)
    rig.run(3)
    yield differs(rig, "stop released", status=AT_REST, **SAFE)
    rig.set(enable=False, directionUp=False)
    rig.scan()
    yield differs(rig, "at the lower stop", inPosition=1, status=AT_THE_STOP, distanceToGo=0.0)
    rig.set(directionUp=True)
    rig.scan()
    yield differs(rig, "facing up", inPosition=0, status=AT_REST)
    rig.set(enable=True)
    rig.scan()
    yield differs(rig, "start", phase=START_RAMP, status=FIRST_SCAN, busy=1)
    rig.scan()
    yield differs(rig, "after the start", phase=START_RAMP, status=IN_PROGRESS, busy=1)


def _overspeed(bench: Bench) -> Iterator[str]:
    """The trip is latched, brings the hoist to rest, and goes with a fresh reset at rest only."""
    rig = _started(bench)
    rig.run(20)
    rig.set(reset=True)
    rig.force(actualVelocity=1.01 * rig.get("envelopeVelocity"))
    rig.scan()
    yield differs(rig, "overspeed on the way", status=TRIPPED, overspeedTrip=1, phase=STOPPING, error=0)
    rig.release()
    rig.set(reset=False)
    rig.scan()
    press_reset(rig)
    yield differs(rig, "reset on the way", overspeedTrip=1, phase=STOPPING)
    rig.run(bench.longest_stop, RESTING)
    yield differs(rig, "at rest after overspeed", overspeedTrip=1, status=TRIPPED, phase=STANDSTILL)
    press_enable(rig)
    yield differs(rig, "start in spite of the trip", phase=STANDSTILL, status=TRIPPED)
    press_reset(rig)
    rig.run(3)
    yield differs(rig, "acknowledged", overspeedTrip=0, status=AT_REST, phase=STANDSTILL)
    press_enable(rig)
    yield differs(rig, "fresh start", phase=START_RAMP, status=FIRST_SCAN)


def _stop_in_the_stop_ramp(bench: Bench) -> Iterator[str]:
    """The hoist is being brought to rest at the stop already: it goes on to it."""
    rig = _started(bench, bench.model.min_travel)
    _run_to(bench, rig, STOP_RAMP)
    rig.set(stop=True)
    rig.scan()
    yield differs(rig, "stop in the stop ramp", phase=STOP_RAMP, status=IN_PROGRESS)
    rig.run(bench.longest_stop, RESTING)
    yield differs(rig, "stop in the stop ramp, at rest", inPosition=1, status=AT_THE_STOP)


def _late_stop_ramp(bench: Bench) -> Iterator[str]:
    """Travel that leaps as far as is plausible, from a tenth of a scan before the stop ramp: the ramp begins in
    arrears, by two cycles at most.
    """
    model = bench.model
    distance = min(1.2 * model.min_travel, model.limits.travel)
    trip, creep, period = model.trip(distance), model.limits.creep_velocity, model.sample_period
    gap = 0.1 * creep * period
    brink = model.limits.travel - trip.stop_travel - gap
    rig = _started(bench, distance)
    rig.run(
        bench.longest_trip, Goal(phases_outside=reached(STANDSTILL).phases, between=(-inf, brink - 2 * creep * period))
    )
    rig.force(actualTravel=brink)
    rig.scan()
    creeping = rig.get("phase") in (CREEP_OUT, CREEP_IN)
    yield "" if creeping else f"before the stop ramp: phase = {rig.get('phase'):g}, not at creep speed"
    leap = 1.98 * rig.get("envelopeVelocity") * period
    rig.force(actualTravel=brink + leap)
    rig.scan()
    yield differs(rig, "leap into the stop ramp", phase=STOP_RAMP, error=0)
    # How late the ramp begins is known to the resolution of the travel.
    resolution = travel_resolution(model, Segment(rig.trace(), 0, rig.scans, up=True))
    time = min((leap - gap) / creep, 2 * period) + period / 2
    ramp_begin = trip.reference.duration - trip.stop_time
    expected = float(trip.reference.at_time(np.array([ramp_begin + time])).velocity[0])
    bound = 2 * LAW_ERROR * creep + peak_acceleration(model) * resolution / creep
    excess = abs(rig.get("velocitySetpoint") - expected) - bound
    yield f"leap into the stop ramp: setpoint {excess:.3g} beyond its bound" if excess > 0 else ""


def _clamp(bench: Bench) -> Iterator[str]:
    """A hoist that is brought to rest while its travel runs ahead: the setpoint is held under the envelope."""
    rig = _started(bench)
    _run_to(bench, rig, DECELERATE)
    rig.set(stop=True)
    place, end = rig.plant.travel, bench.model.limits.travel
    for _ in range(bench.longest_stop):
        if RESTING.is_met(rig):
            return
        place = min(end, place + 1.9 * rig.get("envelopeVelocity") * bench.model.sample_period)
        rig.force(actualTravel=place)
        rig.scan()
        envelope, setpoint = rig.get("envelopeVelocity"), rig.get("velocitySetpoint")
        yield differs(rig, "travel runs ahead", limitedSetpoint=min(setpoint, envelope), error=0)
    yield "travel runs ahead: the hoist never comes to rest"


def _started(bench: Bench, distance: float | None = None) -> Rig:
    """In the first scan of a trip up over a distance, by default from stop to stop."""
    travel = bench.model.limits.travel
    rig, _ = standing(bench, travel - (distance or travel))
    rig.set(enable=True)
    rig.scan()
    return rig


def _run_to(bench: Bench, rig: Rig, phase: int) -> None:
    rig.run(bench.longest_trip, reached(phase))


# -------------------------------------------------------------------------------------------------------- restarts


def restarts(bench: Bench) -> Iterator[str]:
    """A restart takes the speed of the hoist over, clears errors, keeps the trip, and wants a fresh start."""
    yield from _take_over(bench)
    yield from _crawl(bench)
    yield from _in_mid_trip(bench)
    yield from _held_commands(bench)
    yield from _latches(bench)
    rig = bench.rig(bench.model.limits.travel / 2)
    rig.force(actualTravel=nan)
    rig.scan()
    yield differs(rig, "first call without a travel", status=ERROR_TRAVEL, envelopeVelocity=0.0, **SAFE)


def _take_over(bench: Bench) -> Iterator[str]:
    """A moving hoist comes to rest from its speed, after OB100 and at the very first call alike."""
    model = bench.model
    creep, travel = model.limits.creep_velocity, model.limits.travel
    for sign in (1, -1):
        for speed in (0.02 * creep, creep, _stoppable(model)):
            for first_call in (False, True):
                rig = bench.rig(travel / 2) if first_call else standing(bench, travel / 2)[0]
                rig.set(restart=not first_call, enable=True, directionUp=sign < 0)
                rig.plant.velocity = sign * speed
                rig.scan()
                rig.set(restart=False)
                first = rig.scans - 1
                yield differs(rig, "restart on the way", phase=STOPPING, status=COMING_TO_REST)
                rig.run(bench.longest_stop, RESTING)
                rig.run(2)
                yield differs(rig, "rest after a restart", status=AT_REST, **SAFE)
                yield _bumpless(model, Segment(rig.trace(), first, rig.scans, sign > 0), speed)


def _stoppable(model: HoistModel) -> float:
    """Half of full speed, or what the hoist can be stopped from in the half of the shaft that is left."""
    travel = model.limits.travel
    speed = model.trip(travel).cruise_velocity / 2
    while model.stop(speed, 0.0).travel > 0.4 * travel:
        speed /= 2
    return speed


def _bumpless(model: HoistModel, segment: Segment, speed: float) -> str:
    expected = stop_from(model, segment, speed, 0.0)
    deviation = np.abs(segment.sign * segment.column("velocitySetpoint") - expected.velocity)
    worst = float(np.max(deviation - expected.velocity_bound))
    return f"restart at {speed:g}: setpoint {worst:.3g} beyond its bound" if worst > 0 else ""


def _crawl(bench: Bench) -> Iterator[str]:
    """Up to and including a hundredth of the creep speed a hoist counts as at rest."""
    limit = REST_SHARE * bench.model.limits.creep_velocity
    for sign in (1, -1):
        rig, _ = standing(bench, bench.model.limits.travel / 2)
        rig.set(restart=True)
        rig.force(actualVelocity=sign * limit)
        rig.scan()
        yield differs(rig, "restart at rest", status=AT_REST, **SAFE)
        rig.force(actualVelocity=sign * limit * (1 + PROBE))
        rig.scan()
        yield differs(rig, "restart at a crawl", phase=STOPPING)


def _in_mid_trip(bench: Bench) -> Iterator[str]:
    """A restart while the block accelerates: on from the speed of the hoist, or from rest if it was stopped."""
    model = bench.model
    rig = _started(bench)
    _run_to(bench, rig, ACCELERATE)
    rig.run(5)
    moment = rig.snapshot()
    first, speed = rig.scans, rig.get("velocitySetpoint")
    rig.set(restart=True)
    rig.scan()
    rig.set(restart=False)
    yield differs(rig, "restart while it accelerates", phase=STOPPING, status=COMING_TO_REST)
    rig.run(bench.longest_stop, RESTING)
    rig.run(2)
    yield _bumpless(model, Segment(rig.trace(), first, rig.scans, True), speed)
    rig.restore(moment)
    rig.plant.velocity = 0.0
    rig.plant.travel = 0.75 * model.limits.travel
    rig.set(restart=True)
    rig.scan()
    yield differs(rig, "restart of a hoist that was moved", status=AT_REST, error=0, **SAFE)
    rig.set(restart=False)
    rig.run(3)
    yield differs(rig, "after the restart of a hoist that was moved", status=AT_REST, error=0, **SAFE)


def _held_commands(bench: Bench) -> Iterator[str]:
    """A start command or a reset that is held through a restart is no edge, whatever the call in OB100 was given."""
    for in_ob100 in (True, False):
        rig, _ = standing(bench, bench.model.limits.travel / 2)
        rig.set(restart=True, enable=in_ob100)
        rig.scan()
        rig.set(restart=False, enable=True)
        rig.run(3)
        yield differs(rig, "enable held through a restart", status=AT_REST, **SAFE)
        press_enable(rig)
        yield differs(rig, "fresh start after a restart", phase=START_RAMP, status=FIRST_SCAN)
        rig = _tripped(bench)
        rig.set(restart=True, reset=in_ob100)
        rig.scan()
        rig.set(restart=False, reset=True)
        rig.run(3)
        yield differs(rig, "reset held through a restart", overspeedTrip=1, status=TRIPPED)


def _latches(bench: Bench) -> Iterator[str]:
    rig, _ = standing(bench, bench.model.limits.travel / 2)
    rig.force(actualTravel=nan)
    rig.scan()
    rig.release()
    rig.set(restart=True)
    rig.scan()
    yield differs(rig, "restart clears errors", status=AT_REST, error=0)
    rig = _tripped(bench)
    rig.set(restart=True)
    rig.run(2)
    yield differs(rig, "restart keeps the trip", status=TRIPPED, overspeedTrip=1)


def _tripped(bench: Bench) -> Rig:
    """At rest in mid-shaft with the overspeed trip latched."""
    rig, _ = standing(bench, bench.model.limits.travel / 2)
    rig.force(actualVelocity=(1 + PROBE) * rig.get("envelopeVelocity"))
    rig.scan()
    rig.release()
    return rig
