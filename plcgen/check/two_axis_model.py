"""What the checks of a two-axis table must be told: addresses, limits, moves, and references somebody else computed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import NDArray

Samples = NDArray[Any]


class StopLaw(Protocol):
    """A motion to rest, at rest behind its end: time in s, way in all, and by each time."""

    @property
    def duration(self) -> float: ...
    @property
    def travel(self) -> float: ...
    def at_time(self, time: Samples) -> StopMotion: ...


class StopMotion(Protocol):
    @property
    def travel(self) -> Samples: ...


@dataclass(frozen=True)
class MoveModel:
    """One move in pulses, with sign; `ordered` still has what is too short to count.

    `motion(t)` of the profile that is run are pulses, pulses/s and pulses/s2 of the leading axis, without sign, at
    instants in s; in `samples` whole sample periods, or as fast as can be in a table. `fastest` is the duration of the
    shortest profile in s; `stop(v, a)` is the law of a stop from that speed, in pulses.
    """

    ordered: tuple[int, int]
    x: int
    y: int
    samples: int
    fastest: float
    motion: Callable[[Samples], tuple[Samples, Samples, Samples]]
    stop: Callable[[float, float], StopLaw]
    velocity: float  # limits of the leading axis, in pulses and s
    acceleration: float
    jerk: float
    x_leads: bool
    is_short: bool | None  # full speed is not reached; None: so near to it that rounding decides
    corners: tuple[float, ...]  # of the phases of jerk, as shares of the duration, from 0 to 1

    @property
    def lead_pulses(self) -> int:
        return abs(self.x if self.x_leads else self.y)

    @property
    def follow_pulses(self) -> int:
        return abs(self.y if self.x_leads else self.x)


@dataclass(frozen=True)
class TwoAxisModel:
    """The table of a job. `addresses` names variables as in the memory map; `outputs` and `directions` of x and y.
    `is_table`: the hardware runs a profile table, else an interrupt sends each sample. `refused` are further orders
    that must be refused: what is wrong, the pulses of x and y, the code.
    """

    sample_period: float
    addresses: Mapping[str, str]
    outputs: tuple[str, str]
    directions: tuple[str, str]
    moves: tuple[MoveModel, ...]
    train_share: float
    is_table: bool
    refused: tuple[tuple[str, tuple[int, int], int], ...]
