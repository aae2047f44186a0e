"""What the checks of the method `cosine` must be told: limits, and references that somebody else computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

from plcgen.plc.script import Step
from plcgen.trajectory import Trajectory

Samples = NDArray[Any]


class Axis(Protocol):
    """A block with its memory, called sample by sample; names are those of the SCL block.

    `samples` are many calls with the same inputs, up to one behind which the output `until` is TRUE; `play` are steps,
    one after the other.
    """

    def set(self, **inputs: float) -> None: ...
    def get(self, name: str) -> float: ...
    def scan(self) -> None: ...
    def samples(self, most: int, until: str = "") -> None: ...
    def play(self, steps: Sequence[Step]) -> None: ...
    def trace(self) -> Trajectory: ...
    @property
    def faults(self) -> Sequence[object]: ...


@dataclass(frozen=True)
class Command:
    """What is asked for in a sample: another speed, to hold or to go on, to come to rest."""

    sample: int
    velocity: float | None = None
    hold: bool | None = None
    rest: bool = False


class Motion(Protocol):
    """Speed in each sample before and after the average, and what the outputs should tell; arrays of one length.

    `changes` is what the rounding of a speed is proportional to, in the unit of speed.
    """

    @property
    def raw(self) -> Samples: ...
    @property
    def average(self) -> Samples: ...
    @property
    def active(self) -> Samples: ...
    @property
    def held(self) -> Samples: ...
    @property
    def steady(self) -> Samples: ...
    @property
    def done(self) -> Samples: ...
    @property
    def changes(self) -> Samples: ...


@dataclass(frozen=True)
class Ramp:
    """A ramp of the job, and another order in the middle of it."""

    start: float
    end: float
    then: float | None = None
    after: float = 0.0


@dataclass(frozen=True)
class CosineModel:
    """The limits of a job. `count` is the speed of one count of the moving average."""

    unit: str
    sample_period: float
    filter_length: int
    max_velocity: float
    max_acceleration: float
    jerk: float
    count: float


@dataclass(frozen=True)
class RampModel(CosineModel):
    """Shape "centred". `possible` computes motions from a steady speed through commands, in so many samples of a cycle
    time: one, or more where rounding decides. `samples` is N of a change of speed.
    """

    ramps: tuple[Ramp, ...]
    samples: Callable[[float, float], int]
    possible: Callable[[float, tuple[Command, ...], int, float], Iterable[Motion]]


@dataclass(frozen=True)
class MoveModel(CosineModel):
    """Shape "half-sine". `possible` takes distance, number of samples, the sample of a stop if any, and cycle time.

    `telling` has a distance and cycle time for each limit that decides on the duration of some move; `turn` is the last
    sample in which a stop does not let a move go on to its end.
    """

    distances: tuple[float, ...]
    telling: tuple[tuple[float, float], ...]
    min_distance: float
    max_distance: float
    samples: Callable[[float, float], int]
    turn: Callable[[float, float], int]
    possible: Callable[[float, int, int | None, float], Iterable[Motion]]
