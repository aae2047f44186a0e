"""The trip of a hoist: creep out, accelerate, full speed, decelerate, creep in, stop (seed 000, section 4).

A trip is planned for a distance and read in three ways: as legs with times and travels, as a reference over time,
and as speed over travel. A trip of full length is the same plan as a resumed one that has less distance left.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from plcgen.job import HoistLimits
from plcgen.profile.envelope import Envelope
from plcgen.profile.reference import Phase, Reference
from plcgen.profile.stop import stop_phases
from plcgen.profile.transition import Transition, reached_velocity

LEG_NAMES = (
    "standstill",
    "start ramp",
    "creep out",
    "accelerate",
    "full speed",
    "decelerate",
    "creep in",
    "stop ramp",
    "stopping",
)
START_RAMP, CREEP_OUT, ACCELERATE, FULL_SPEED, DECELERATE, CREEP_IN, STOP_RAMP, STOPPING = range(1, 9)


@dataclass(frozen=True)
class Leg:
    """One part of the trip: number and name as in the block's `phase` output, duration, travel, speed at its end."""

    number: int
    duration: float
    travel: float
    end_velocity: float
    transition: Transition | None = None
    rising: bool = True

    @property
    def name(self) -> str:
        return LEG_NAMES[self.number]

    def phases(self) -> Iterator[Phase]:
        """Phases of constant jerk; a leg without a transition runs at constant speed."""
        if self.transition is None:
            yield Phase(self.duration, 0.0, self.number)
            return
        jerk = self.transition.jerk if self.rising else -self.transition.jerk
        yield Phase(self.transition.jerk_time, jerk, self.number)
        yield Phase(self.transition.middle_time, 0.0, self.number)
        yield Phase(self.transition.jerk_time, -jerk, self.number)


@dataclass(frozen=True)
class Trip:
    """A planned trip over `distance` from rest to rest. The four transitions in the order of the trip."""

    limits: HoistLimits
    distance: float
    start: Transition
    acceleration: Transition
    deceleration: Transition
    stop: Transition

    @property
    def creep_velocity(self) -> float:
        return self.start.fast_velocity

    @property
    def cruise_velocity(self) -> float:
        return self.acceleration.fast_velocity

    @property
    def acceleration_begin(self) -> float:
        """S_A of (5): travel from the start where acceleration begins."""
        return self.start.travel + self.limits.creep_out

    @property
    def deceleration_end(self) -> float:
        """Distance to go where deceleration ends and creep in begins."""
        return self.stop.travel + self.limits.creep_in

    @property
    def full_speed_travel(self) -> float:
        """What is left between the transitions at the reached speed."""
        taken = self.acceleration_begin + self.acceleration.travel + self.deceleration.travel + self.deceleration_end
        return max(0.0, self.distance - taken)

    @property
    def _creeps_all_the_way(self) -> bool:
        return self.distance < creeping_travel(self.limits)

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """The legs of the trip in order; a trip too short for its creep travels is start ramp, creep, stop ramp."""
        creep = self.creep_velocity
        start = _ramp_leg(START_RAMP, self.start, rising=True)
        stop = _ramp_leg(STOP_RAMP, self.stop, rising=False)
        if self._creeps_all_the_way:
            rest = max(0.0, self.distance - self.start.travel - self.stop.travel)
            return start, _constant_leg(CREEP_OUT, rest, creep), stop
        return (
            start,
            _constant_leg(CREEP_OUT, self.limits.creep_out, creep),
            _ramp_leg(ACCELERATE, self.acceleration, rising=True),
            _constant_leg(FULL_SPEED, self.full_speed_travel, self.cruise_velocity),
            _ramp_leg(DECELERATE, self.deceleration, rising=False),
            _constant_leg(CREEP_IN, self.limits.creep_in, creep),
            stop,
        )

    @property
    def transitions(self) -> tuple[Transition, ...]:
        """In the order of the trip."""
        return self.start, self.acceleration, self.deceleration, self.stop

    @property
    def shortest_jerk_time(self) -> float:
        """Duration of the shortest phase of jerk."""
        return min(transition.jerk_time for transition in self.transitions if transition.velocity_change > 0)

    @property
    def duration(self) -> float:
        return sum(leg.duration for leg in self.legs)

    @cached_property
    def reference(self) -> Reference:
        return Reference([phase for leg in self.legs for phase in leg.phases()])

    @cached_property
    def envelope(self) -> Envelope:
        return Envelope(
            self.limits, self.acceleration, self.deceleration, self.acceleration_begin, self.deceleration_end
        )


def _ramp_leg(number: int, transition: Transition, rising: bool) -> Leg:
    end = transition.fast_velocity if rising else transition.slow_velocity
    return Leg(number, transition.duration, transition.travel, end, transition, rising)


def _constant_leg(number: int, travel: float, velocity: float) -> Leg:
    return Leg(number, travel / velocity, travel, velocity)


def stop_deceleration(limits: HoistLimits) -> float:
    """The stop ramp keeps within both the limit of the ramps and the deceleration of the hoist."""
    return min(limits.creep_acceleration, limits.deceleration)


def creeping_travel(limits: HoistLimits) -> float:
    """Shortest distance that has room for both ramps and both creep travels."""
    start = Transition(0.0, limits.creep_velocity, limits.creep_acceleration, limits.jerk)
    stop = Transition(0.0, limits.creep_velocity, stop_deceleration(limits), limits.jerk)
    return start.travel + limits.creep_out + limits.creep_in + stop.travel


def plan_trip(limits: HoistLimits, distance: float) -> Trip:
    """Plan from rest to rest over `distance` > 0: full speed if there is room, else the highest speed that fits."""
    room = distance - creeping_travel(limits)
    creep = limits.creep_velocity
    ramp_limits = limits.creep_acceleration, stop_deceleration(limits)
    if room < 0:
        creep = reached_velocity(0.0, creep, *ramp_limits, limits.jerk, distance)
        cruise = creep
    else:
        sides = limits.acceleration, limits.deceleration
        cruise = reached_velocity(creep, limits.max_velocity, *sides, limits.jerk, room)
    return Trip(
        limits,
        distance,
        start=Transition(0.0, creep, ramp_limits[0], limits.jerk),
        acceleration=Transition(creep, cruise, limits.acceleration, limits.jerk),
        deceleration=Transition(creep, cruise, limits.deceleration, limits.jerk),
        stop=Transition(0.0, creep, ramp_limits[1], limits.jerk),
    )


def plan_stop(limits: HoistLimits, velocity: float, acceleration: float) -> Reference:
    """A stop request at a speed and a signed acceleration."""
    return Reference(
        stop_phases(velocity, acceleration, limits.deceleration, limits.jerk, STOPPING), velocity, acceleration
    )
