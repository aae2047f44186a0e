"""Pictures as data: what is drawn, for those who draw. Nothing here knows a plotting library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plcgen.trajectory import Column, Trajectory

Values = NDArray[np.float64]

REFERENCE, TRACE, OTHER, BOUND = "reference", "trace", "other", "bound"
"""Roles of lines: each has one colour and one dash everywhere."""
MOST_POINTS = 2000
"""Of a line: more than a screen has columns."""


@dataclass(frozen=True)
class Line:
    """One curve. `stepped`: the value holds up to the next point."""

    name: str
    role: str
    x: Values
    y: Values
    stepped: bool = False


@dataclass(frozen=True)
class Limit:
    """A horizontal line that no curve may cross."""

    name: str
    value: float


@dataclass(frozen=True)
class Band:
    """A phase or a move: from where to where on the horizontal axis. One without a name is known by its number."""

    name: str
    start: float
    end: float


@dataclass(frozen=True)
class Panel:
    """One pair of axes; `label` of the vertical one, with its unit."""

    label: str
    lines: tuple[Line, ...]
    limits: tuple[Limit, ...] = ()


@dataclass(frozen=True)
class Figure:
    """Panels above each other that share the horizontal axis. `equal`: both axes have one scale, as a map has."""

    key: str
    title: str
    label: str
    panels: tuple[Panel, ...]
    bands: tuple[Band, ...] = ()
    note: str = ""
    equal: bool = False


def line(name: str, role: str, x: Column, y: Column, stepped: bool = False) -> Line:
    """A curve of as many points as a screen can show."""
    return thinned(Line(name, role, np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64), stepped))


def thinned(curve: Line) -> Line:
    """The least and the largest value of each of equal shares of the points, so that no peak is lost."""
    count = len(curve.x)
    if count <= MOST_POINTS:
        return curve
    shares = np.array_split(np.arange(count), MOST_POINTS // 2)
    kept = {0, count - 1}
    for share in shares:
        kept |= {int(share[np.argmin(curve.y[share])]), int(share[np.argmax(curve.y[share])])}
    chosen = np.array(sorted(kept))
    return replace(curve, x=curve.x[chosen], y=curve.y[chosen])


def both_ways(name: str, value: float) -> tuple[Limit, Limit]:
    return Limit(name, value), Limit(name, -value)


def one_after_another(counts: Sequence[int], period: float) -> tuple[Band, ...]:
    """A band for each of the moves in a row, each of so many samples."""
    ends = np.concatenate([[0], np.cumsum(counts)]) * period
    return tuple(Band("", float(start), float(end)) for start, end in pairwise(ends))


def by_move(
    name: str, role: str, columns: Sequence[Values], bands: Sequence[Band], period: float, stepped: bool = False
) -> tuple[Line, ...]:
    """A curve for each move, sample by sample from its begin on."""
    return tuple(
        line(name, role, band.start + np.arange(len(column)) * period, column, stepped)
        for band, column in zip(bands, columns, strict=True)
    )


def moves_of(trajectory: Trajectory, column: str) -> list[Values]:
    """The values of a column, each move by itself."""
    moves = trajectory["move"]
    return [trajectory[column][moves == number].astype(np.float64) for number in np.unique(moves)]


def cut(columns: Sequence[Values], others: Sequence[Values]) -> list[Values]:
    """Each move only as long as it is in `others`."""
    return [column[: len(other)] for column, other in zip(columns, others, strict=True)]


def differing(traces: dict[str, Trajectory]) -> dict[str, Trajectory]:
    """One trace for all targets whose traces are equal in every bit, named after them."""
    groups: dict[str, list[str]] = {}
    for target, trace in traces.items():
        groups.setdefault(trace.sha256(), []).append(target)
    return {", ".join(targets): traces[targets[0]] for targets in groups.values()}
