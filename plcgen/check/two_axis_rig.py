"""A CPU with the two-axis program and its pulse outputs, to order moves from and to look at every pulse."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from plcgen.check.two_axis_model import MoveModel, Samples, TwoAxisModel
from plcgen.plc.core import Program
from plcgen.plc.cpu.pto import Segment
from plcgen.plc.cpu.smart import Smart
from plcgen.plc.machine import Variable

SECOND = 1_000_000  # us
SCAN_US = 5000
RETAINED = ("command", "status", "error", "flags", "done_x", "done_y")
"""Order and status, which V memory may keep over a loss of power."""
SETTLED = 3
"""Scans after which a move that has ended is looked at."""


@dataclass(frozen=True)
class Subject:
    """What is verified: a program and the model to hold it against. `timed` makes one that counts its run time."""

    program: Program
    model: TwoAxisModel
    timed: Callable[[], Program]


@dataclass(frozen=True)
class Ride:
    """One move that was run: from the first tick, in us, to rest. `told_early` that it had ended while it had not."""

    name: str
    move: MoveModel
    first_tick: int
    before: tuple[int, int]
    told_early: bool


class Table:
    """A CPU with the program, after its first scan."""

    def __init__(
        self,
        subject: Subject,
        lateness: Callable[[int], int] | None = None,
        blocked: Sequence[tuple[int, int]] = (),
        temp_fill: int = 0,
        retained: int = 0,
        scan_us: int = SCAN_US,
        timed: bool = False,
    ) -> None:
        """`retained` is what every byte of order and status holds when the power comes."""
        program = subject.timed() if timed else subject.program
        self.model = subject.model
        self._variables: dict[str, Variable] = {}
        directions = dict(zip(self.model.outputs, self.model.directions, strict=True))
        self.cpu = Smart(program, scan_us, lateness, blocked, temp_fill, directions)
        self._status_byte = int(self.model.addresses["status"].removeprefix("VB"))
        for name in RETAINED if retained else ():
            self.variable(name).set(retained)
        self.cpu.scan()

    def variable(self, name: str) -> Variable:
        """By its name in the memory map, or an address; looked up once."""
        if name not in self._variables:
            self._variables[name] = self.cpu.variable(self.model.addresses.get(name, name))
        return self._variables[name]

    def get(self, name: str) -> int:
        return int(self.variable(name).get())

    def order(self, x: int, y: int) -> None:
        self.variable("distance_x").set(x)
        self.variable("distance_y").set(y)

    def press(self, number: int) -> None:
        """An input of the example in MAIN: 0 start, 1 stop, 2 emergency stop."""
        button = self.variable(f"I0.{number}")
        button.set(True)
        self.cpu.scan()
        button.set(False)

    def scans(self, most: int) -> None:
        """Up to `most` scans, until something happens or the status changes."""
        self.cpu.scans(most, self._status_byte)

    def positions(self, times: Samples) -> tuple[Samples, Samples]:
        x, y = (self.cpu.channels[output].position_at(times) for output in self.model.outputs)
        return x, y

    def now(self) -> tuple[int, int]:
        x, y = self.positions(np.array([self.cpu.time_us]))
        return int(x[0]), int(y[0])

    def run(self, move: MoveModel, name: str, until: float | None = None) -> Ride:
        """Start a move and run it to rest, or for some seconds from its first tick."""
        before = self.now()
        self.order(*move.ordered)
        ordered = self.cpu.time_us
        first_tick = ordered + round(self.model.sample_period * SECOND)
        self.press(0)
        longest = (2 * move.samples + 20) * self.model.sample_period
        end = first_tick + round((longest if until is None else until) * SECOND)
        told_early = False
        busy, done, stopped = (self.variable(flag).get for flag in ("busy", "done", "stopped"))
        while self.cpu.time_us < end and (busy() or until is not None):
            told_early |= bool(busy() and (done() or stopped()))
            self.scans(-(-(end - self.cpu.time_us) // self.cpu.scan_us))
        for _ in range(SETTLED):
            self.cpu.scan()
        if self.model.is_table:
            # The tables are built first; the move begins when they are started.
            first_tick = round(min((s.start for s in self.segments(ordered)), default=first_tick))
        return Ride(name, move, first_tick, before, told_early)

    def segments(self, since: int) -> list[Segment]:
        """What both outputs have sent since a time."""
        return [s for output in self.model.outputs for s in self.cpu.channels[output].segments if s.start >= since]
