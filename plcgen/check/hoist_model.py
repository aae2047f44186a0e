"""What the checks of a hoist must be told: limits, stops, and references that somebody else computed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

from plcgen.job import HoistLimits

Samples = NDArray[Any]

STANDSTILL, START_RAMP, CREEP_OUT, ACCELERATE, FULL_SPEED, DECELERATE, CREEP_IN, STOP_RAMP, STOPPING = range(9)


class Motion(Protocol):
    """Arrays of one shape."""

    @property
    def velocity(self) -> Samples: ...
    @property
    def acceleration(self) -> Samples: ...
    @property
    def travel(self) -> Samples: ...
    @property
    def leg(self) -> Samples: ...


class Reference(Protocol):
    """A motion in float64 over time in s and over travel."""

    @property
    def duration(self) -> float: ...
    @property
    def travel(self) -> float: ...
    def at_time(self, time: Samples) -> Motion: ...
    def at_travel(self, travel: Samples) -> Motion: ...
    def time_at(self, travel: Samples) -> Samples: ...
    def legs_at(self, travel: Samples) -> Samples: ...


@dataclass(frozen=True)
class TripModel:
    """A trip over some distance."""

    reference: Reference
    start_time: float
    start_travel: float
    stop_time: float
    stop_travel: float
    creep_velocity: float
    cruise_velocity: float
    distance: float


@dataclass(frozen=True)
class HoistModel:
    """The hoist of a job. `trip(distance)`, `stop(velocity, acceleration)` and `envelope(from_stop, to_go)` compute
    references; lengths in the unit of the job.
    """

    limits: HoistLimits
    sample_period: float
    unit: str
    millimetre: float
    steepest_gain: float
    shortest_jerk_time: float
    position_window: float
    min_travel: float
    trip: Callable[[float], TripModel]
    stop: Callable[[float, float], Reference]
    envelope: Callable[[Samples, Samples], Samples]
