"""Inputs of a block over many calls, as the bytes that are written before each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from plcgen.plc.engine import Bytes
from plcgen.plc.types import BOOL, BYTE_BITS, Elementary

Step = tuple[Mapping[str, float], int]
"""Inputs that are set, and the calls from then on to the next step."""
CALL, BYTE, STAY, ON = range(4)
"""Columns of a script: the byte becomes its bits that stay, and those that are set."""


class Place(NamedTuple):
    """Where an input or output lies: its first byte, and the bit in it of a BOOL."""

    byte: int
    bit: int
    type: Elementary

    @property
    def end(self) -> int:
        return self.byte + max(1, self.type.bits // BYTE_BITS)


@dataclass(frozen=True)
class Script:
    """So many calls, and what is written before them: rows in the order of calls."""

    rows: np.ndarray
    calls: int

    def after(self, calls: int) -> Script:
        """What is left of it."""
        if not len(self.rows):
            return Script(self.rows, self.calls - calls)
        at = np.searchsorted(self.rows[:, CALL], calls)
        return Script(self.rows[at:] - [calls, 0, 0, 0], self.calls - calls)

    def write(self, memory: Bytes, first: int = 0) -> None:
        """What comes before the next call; bytes count from `first` on."""
        end = np.searchsorted(self.rows[:, CALL], 1)
        for _, byte, stay, on in self.rows[:end].tolist():
            memory[first + byte] = memory[first + byte] & stay | on


NO_SCRIPT = np.empty((0, 4), np.int64)


def scripted(steps: Sequence[Step], place: Callable[[str], Place]) -> Script:
    """The script of steps. Values are rounded as the type of the input wants."""
    calls, values = 0, dict[str, tuple[list[int], list[float]]]()
    for inputs, count in steps:
        for name, value in inputs.items():
            when, what = values.setdefault(name, ([], []))
            when.append(calls)
            what.append(value)
        calls += count
    parts = [rows for name, (when, what) in values.items() for rows in _written(place(name), when, what)]
    rows = np.concatenate(parts) if parts else NO_SCRIPT
    return Script(rows[np.argsort(rows[:, CALL], kind="stable")], calls)


def _written(place: Place, calls: Sequence[int], values: Sequence[float]) -> Iterator[np.ndarray]:
    """Rows for each byte of an input."""
    if place.type is BOOL:
        mask = 1 << place.bit
        yield _rows(calls, place.byte, 0xFF & ~mask, np.where(np.array(values) != 0, mask, 0))
        return
    data = np.array(values, ">" + place.type.code).view(np.uint8).reshape(len(values), -1)
    for number, column in enumerate(data.T):
        yield _rows(calls, place.byte + number, 0, column)


def _rows(calls: Sequence[int], byte: int, stay: int, on: np.ndarray) -> np.ndarray:
    rows = np.empty((len(on), 4), np.int64)
    rows[:, CALL], rows[:, BYTE], rows[:, STAY], rows[:, ON] = np.array(calls), byte, stay, on
    return rows
