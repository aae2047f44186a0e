"""Trajectory: sampled columns of equal length, and their CSV form."""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

Column = NDArray[Any]


class LateColumns(Mapping[str, Column]):
    """Columns of one length, each made when somebody asks for it: a record has many that nobody reads."""

    def __init__(self, makers: Mapping[str, Callable[[], Column]]) -> None:
        self._makers = makers
        self._made: dict[str, Column] = {}

    def __getitem__(self, name: str) -> Column:
        if name not in self._made:
            self._made[name] = self._makers[name]()
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


@dataclass(frozen=True)
class Trajectory:
    """Named columns, one row a sample; float64, float32, int or bool arrays of one length."""

    columns: Mapping[str, Column]

    def __post_init__(self) -> None:
        if isinstance(self.columns, LateColumns):
            return
        lengths = {name: len(column) for name, column in self.columns.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"columns of different length: {lengths}")

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def rows(self, selection: Column) -> Trajectory:
        """The rows that an index or boolean array selects."""
        return Trajectory(LateColumns({name: partial(self._selected, name, selection) for name in self.columns}))

    def _selected(self, name: str, selection: Column) -> Column:
        column: Column = self.columns[name][selection]
        return column

    def to_csv(self) -> str:
        """CSV with a header line and LF. Numbers are the shortest text that reads back to the same value."""
        output = io.StringIO()
        writer = csv.writer(output, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(zip(*(_spell(column) for column in self.columns.values()), strict=True))
        return output.getvalue()

    @classmethod
    def from_csv(cls, text: str) -> Trajectory:
        """Read what `to_csv` wrote; every column comes back as float64. Raises ValueError on anything else."""
        rows = list(csv.reader(io.StringIO(text)))
        if not rows or not rows[0]:
            raise ValueError("a trajectory needs a header line")
        header, body = rows[0], rows[1:]
        if len(set(header)) < len(header):
            raise ValueError(f"columns of the same name: {header}")
        for number, row in enumerate(body, start=2):
            if len(row) != len(header):
                raise ValueError(f"row {number} has {len(row)} cells; the header has {len(header)}")
        values = np.array([[float(cell) for cell in row] for row in body], dtype=np.float64).reshape(-1, len(header))
        return cls({name: values[:, index] for index, name in enumerate(header)})

    def is_same(self, other: Trajectory) -> bool:
        """In every bit."""
        return self._layout() == other._layout() and all(
            column.tobytes() == other[name].tobytes() for name, column in self.columns.items()
        )

    def _layout(self) -> list[tuple[str, np.dtype[Any]]]:
        return [(name, column.dtype) for name, column in self.columns.items()]

    def sha256(self) -> str:
        """Digest of the CSV text: equal exactly when every value of every row is equal."""
        return hashlib.sha256(self.to_csv().encode("ascii")).hexdigest()


def _spell(column: Column) -> list[str]:
    """What comes again, bit for bit, is spelled once."""
    bits, places = np.unique(column.view(f"u{column.itemsize}"), return_inverse=True)
    words = _words(bits.view(column.dtype))
    return [words[place] for place in places.tolist()]


def _words(values: Column) -> list[str]:
    if values.dtype == np.float64:
        return [_positional(value) for value in values.tolist()]
    if values.dtype.kind == "f":
        return [np.format_float_positional(value, unique=True, trim="-") for value in values]
    return [str(int(value)) for value in values]


def _positional(value: float) -> str:
    """As NumPy spells it. Python is quicker, but goes over to exponents."""
    text = repr(value)
    return np.format_float_positional(value, unique=True, trim="-") if "e" in text else text.removesuffix(".0")


def disagreements(traces: Mapping[str, Trajectory]) -> Iterator[str]:
    """Where trajectories part from the first, in any bit."""
    (first, reference), *others = traces.items()
    for target, trace in others:
        if len(trace) != len(reference):
            yield f"{target} and {first} disagree: {len(trace)} rows and {len(reference)}"
            continue
        for name, column in reference.columns.items():
            rows = np.flatnonzero(column != trace[name])
            if len(rows):
                row = rows[0]
                yield f"{target} and {first} disagree: {name} is {trace[name][row]} and {column[row]} in row {row}"
