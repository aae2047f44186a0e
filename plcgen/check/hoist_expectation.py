"""What every output of the hoist block must be, scan by scan, and how near it must come.

Nothing here looks at the state of the block: the inputs of each scan, the start of the trip and the moment of a stop
decide, and the references come from the model.

Letters: u is half the spacing of REAL at 1, T the cycle time, g the steepest gain dv/dS of the law over travel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plcgen.check.hoist_model import (
    CREEP_OUT,
    STANDSTILL,
    START_RAMP,
    STOP_RAMP,
    STOPPING,
    HoistModel,
    Samples,
    TripModel,
)
from plcgen.trajectory import Trajectory

UNIT_ROUNDOFF = 2.0**-24
# Each part of the law is a chain of at most 16 rounded operations on its way to v; see the README, Accuracy.
LAW_ERROR = 1e-6


@dataclass(frozen=True)
class Expected:
    """Outputs in the direction of the trip, one row a scan, and the bounds of velocity and acceleration."""

    velocity: Samples
    acceleration: Samples
    phases: tuple[Samples, ...]
    velocity_bound: Samples | float
    acceleration_bound: Samples | float
    is_travel_law: Samples


@dataclass(frozen=True)
class Segment:
    """Rows `first` .. `last` - 1 of a trace in which one trip, or one stop, is under way."""

    trace: Trajectory
    first: int
    last: int
    up: bool

    @property
    def rows(self) -> slice:
        return slice(self.first, self.last)

    def column(self, name: str) -> NDArray[np.float64]:
        return np.asarray(self.trace[name][self.rows], dtype=np.float64)

    @property
    def sign(self) -> float:
        return 1.0 if self.up else -1.0

    @cached_property
    def travelled(self) -> NDArray[np.float64]:
        """From the start of the segment, as the block measured it: exact, since REAL differences fit float64."""
        travel = self.column("actualTravel")
        return self.sign * (travel - travel[:1])

    @cached_property
    def to_go(self) -> Samples:
        end = self.column("upperStop" if self.up else "lowerStop")
        return self.sign * (end - self.column("actualTravel"))


def travel_resolution(model: HoistModel, segment: Segment) -> float:
    """Four roundings of a travel as long as the shaft or as far from zero: start, room, length and place."""
    farthest = max(np.abs(segment.column(name)).max() for name in ("lowerStop", "upperStop", "actualTravel"))
    return 4 * UNIT_ROUNDOFF * float(max(farthest, model.limits.travel))


def peak_acceleration(model: HoistModel) -> float:
    limits = model.limits
    return max(limits.acceleration, limits.deceleration, limits.creep_acceleration)


def clock_error(scans: int, duration: float) -> float:
    """The block sums T over the scans of a ramp: each of n sums is rounded, n u t in all."""
    return scans * UNIT_ROUNDOFF * (duration + 1.0)


def expect_trip(model: HoistModel, segment: Segment) -> Expected:
    """A trip from its first scan on, without interruption."""
    trip = model.trip(float(segment.to_go[0]))
    period = float(segment.column("cycleTime")[0])
    resolution = travel_resolution(model, segment)
    # The start ramp ends by the clock; what little travel is then left of it belongs to creep out.
    law = trip.reference.at_travel(np.maximum(segment.travelled, trip.start_travel))
    # The setpoint of a ramp is held for a cycle: it is the speed in the middle of the cycle.
    middle = (np.arange(segment.last - segment.first) + 0.5) * period
    starting = middle < trip.start_time
    stopping = np.maximum.accumulate(_ramp_is_due(trip, segment, resolution) & ~starting)
    time = np.where(starting, middle, _time_of_stop(trip, segment, stopping, period))
    ramp = trip.reference.at_time(time)
    by_time = starting | stopping
    shift = _time_error(model, trip, period, resolution)
    velocity = np.where(by_time, ramp.velocity, law.velocity)
    acceleration = np.where(by_time, ramp.acceleration, law.acceleration)
    bound = LAW_ERROR * velocity + _plan_error(model, trip, resolution)
    bound += np.where(by_time, peak_acceleration(model) * shift, model.steepest_gain * resolution)
    law_acceleration_bound = _root_error(2 * model.limits.jerk * 2 * bound, acceleration)
    time_acceleration_bound = model.limits.jerk * shift + bound / period * UNIT_ROUNDOFF
    return Expected(
        velocity,
        acceleration,
        tuple(
            _trip_phases(trip, segment, middle + sign * shift, time + sign * shift, stopping, sign * resolution)
            for sign in (-1, 1)
        ),
        bound,
        np.where(by_time, time_acceleration_bound, law_acceleration_bound) + LAW_ERROR * peak_acceleration(model),
        ~by_time,
    )


def _ramp_is_due(trip: TripModel, segment: Segment, resolution: float) -> Samples:
    """Where the stop ramp has begun. What lies within the resolution of its begin is for the block to say."""
    tie = np.abs(segment.to_go - trip.stop_travel) <= resolution
    return np.asarray(np.where(tie, segment.column("phase") == STOP_RAMP, segment.to_go <= trip.stop_travel))


def _time_of_stop(trip: TripModel, segment: Segment, stopping: Samples, period: float) -> Samples:
    """Instants of the reference for the rows of the stop ramp: from the travel of its first row, then by the clock.

    An encoder's step may be longer than two cycles at creep speed; the ramp makes up for no more.
    """
    first = int(np.argmax(stopping))
    begin = trip.reference.duration - trip.stop_time
    reached = float(trip.reference.time_at(np.array([segment.travelled[first]]))[0])
    due = min(reached, begin + 2 * period)
    rows = np.arange(len(stopping)) - first
    return np.where(stopping, due + (rows + 0.5) * period, 0.0)


def _trip_phases(
    trip: TripModel, segment: Segment, start: Samples, time: Samples, stopping: Samples, offset: float
) -> Samples:
    """The legs at instants and places that are moved by what rounding may move them."""
    by_travel = np.clip(trip.reference.legs_at(segment.travelled + offset), CREEP_OUT, STOP_RAMP)
    ramp = np.where(time >= trip.reference.duration, STANDSTILL, STOP_RAMP)
    return np.select([start < trip.start_time, stopping], [np.full(len(time), START_RAMP), ramp], by_travel)


def _time_error(model: HoistModel, trip: TripModel, period: float, resolution: float) -> float:
    """The summed clock of a ramp, and of the stop ramp its begin: a place known to the resolution, and tau = e/v for
    v tau - m tau^3/6 = e, which is short by m tau^3/(6 v), tau at most two cycles.
    """
    scans = int(max(trip.start_time, trip.stop_time) / period) + 2
    begin = resolution / trip.creep_velocity + model.limits.jerk * (2 * period) ** 3 / (6 * trip.creep_velocity)
    return clock_error(scans, scans * period) + begin


def _plan_error(model: HoistModel, trip: TripModel, resolution: float) -> float:
    """Bisection ends within 2^-24 V of the speed that fits, and the room it fits into is known to the resolution."""
    low, high = (model.trip(trip.distance + offset) for offset in (-resolution, resolution))
    known = max(high.cruise_velocity - low.cruise_velocity, high.creep_velocity - low.creep_velocity)
    return known + 2 * UNIT_ROUNDOFF * model.limits.max_velocity


def _root_error(error: Samples, root: Samples) -> Samples:
    """How far sqrt(x + error) is from root = sqrt(x): at most sqrt(error), and error/root where that is less."""
    return np.minimum(np.sqrt(error), error / np.maximum(root, 1e-30))


def expect_stop(model: HoistModel, segment: Segment) -> Expected:
    """A stop that goes on from the setpoint of the scan before its first row."""
    before = segment.first - 1
    velocity = segment.sign * float(segment.trace["velocitySetpoint"][before])
    acceleration = segment.sign * float(segment.trace["acceleration"][before])
    return stop_from(model, segment, velocity, acceleration)


def stop_from(model: HoistModel, segment: Segment, velocity: float, acceleration: float) -> Expected:
    """A stop that goes on from a given motion; its first row is one cycle later."""
    reference = model.stop(velocity, acceleration)
    period = float(segment.column("cycleTime")[0])
    if not 0.0 < period <= model.shortest_jerk_time / 10:
        period = model.sample_period
    time = (np.arange(segment.last - segment.first) + 1.0) * period
    motion = reference.at_time(time)
    shift = clock_error(len(time), float(time[-1]))
    rounding = LAW_ERROR * (velocity + peak_acceleration(model))
    return Expected(
        motion.velocity,
        motion.acceleration,
        tuple(np.where(time + sign * shift >= reference.duration, STANDSTILL, STOPPING) for sign in (-1, 1)),
        rounding + peak_acceleration(model) * shift,
        rounding + model.limits.jerk * shift,
        np.zeros(len(time), dtype=bool),
    )
