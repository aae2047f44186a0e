"""Timers and counters of the S7-200 SMART.

A timer advances when its instruction runs, by the whole steps of its resolution that passed since it last ran; a CPU
advances those of 1 ms and 10 ms between. What they remember lies in areas that no source can spell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from plcgen.plc.builder import Builder
from plcgen.plc.core import Cell, Literal, Operand
from plcgen.plc.operators import Operator, move
from plcgen.plc.stl.smart_memory import (
    COUNTER_BITS,
    COUNTER_EDGES,
    COUNTERS,
    TIMER_BITS,
    TIMER_CLOCKS,
    TIMER_RESTS,
    TIMER_RUNS,
    TIMERS,
)
from plcgen.plc.stl.smart_operators import CLOCK
from plcgen.plc.stl.smart_rung import FALSE, TRUE, Rung
from plcgen.plc.types import BOOL, DINT, INT

ZERO = Literal(0, INT)
NO_REST = Literal(0, DINT)
RESOLUTIONS = {  # ms: retentive TONR, then TON and TOF
    1: ((0, 64), (32, 96)),
    10: ((*range(1, 5), *range(65, 69)), (*range(33, 37), *range(97, 101))),
    100: ((*range(5, 32), *range(69, 96)), (*range(37, 64), *range(101, 256))),
}


@dataclass(frozen=True)
class _Timer:
    """Cells of one timer."""

    number: int

    @property
    def bit(self) -> Cell:
        return Cell(TIMER_BITS, self.number, BOOL)

    @property
    def runs(self) -> Cell:
        return Cell(TIMER_RUNS, self.number, BOOL)

    @property
    def current(self) -> Cell:
        return Cell(TIMERS, 16 * self.number, INT)

    @property
    def last(self) -> Cell:
        """ms of the clock when the instruction last ran."""
        return Cell(TIMER_CLOCKS, 32 * self.number, DINT)

    @property
    def rest(self) -> Cell:
        """ms that did not fill a step yet."""
        return Cell(TIMER_RESTS, 32 * self.number, DINT)


def _resolution(rung: Rung, number: int, retentive: bool) -> int:
    for resolution, (kept, plain) in RESOLUTIONS.items():
        if number in (kept if retentive else plain):
            return resolution
    right = "TON or TOF" if retentive else "TONR"
    raise rung.error(f"T{number} is a timer for {right}; {_ranges(retentive)}")


def _ranges(retentive: bool) -> str:
    return "TONR has T0 to T31 and T64 to T95" if retentive else "TON and TOF have T32 to T63 and T96 to T255"


def _advance(rung: Rung, timer: _Timer, resolution: int, passed: Operand) -> None:
    step = Literal(resolution, DINT)
    total = rung.compute("+", timer.rest, passed)
    rung.builder.move(timer.rest, rung.compute("MOD", total, step))
    rung.assign(timer.current, _COUNTED, timer.current, rung.compute("/", total, step))


_COUNTED = Operator("COUNTED", (INT, DINT), INT, f"min({{0}} + {{1}}, {INT.maximum})")


def _start_or_advance(rung: Rung, timer: _Timer, resolution: int, passed: Operand) -> None:
    """The first pass begins to measure, further ones count."""
    builder = rung.builder
    begin, done = builder.label(), builder.label()
    builder.branch(timer.runs, begin, when=False)
    _advance(rung, timer, resolution, passed)
    builder.jump(done)
    builder.place(begin)
    builder.move(timer.runs, TRUE)
    builder.move(timer.rest, NO_REST)
    builder.place(done)


def _passed(rung: Rung, timer: _Timer) -> Operand:
    now = rung.result(CLOCK)
    passed = rung.compute("-", now, timer.last)
    rung.assign(timer.last, move(DINT), now)
    return passed


def on_delay(retentive: bool) -> Callable[[Rung, int, Operand], None]:
    """TON Txxx, PT and TONR: counts while the input is 1; TON clears at 0, TONR keeps."""

    def emit(rung: Rung, number: int, preset: Operand) -> None:
        resolution, timer, builder = _resolution(rung, number, retentive), _Timer(number), rung.builder
        passed, off, done = _passed(rung, timer), builder.label(), builder.label()
        builder.branch(rung.top, off, when=False)
        _start_or_advance(rung, timer, resolution, passed)
        builder.move(timer.bit, rung.compute(">=", timer.current, preset))
        builder.jump(done)
        builder.place(off)
        builder.move(timer.runs, FALSE)
        if not retentive:
            builder.move(timer.current, ZERO)
            builder.move(timer.bit, FALSE)
        builder.place(done)

    return emit


def off_delay(rung: Rung, number: int, preset: Operand) -> None:
    """TOF Txxx, PT: the bit stays 1 for PT after the input went to 0."""
    resolution, timer, builder = _resolution(rung, number, False), _Timer(number), rung.builder
    passed, off, done = _passed(rung, timer), builder.label(), builder.label()
    builder.branch(rung.top, off, when=False)
    builder.move(timer.bit, TRUE)
    builder.move(timer.runs, FALSE)
    builder.move(timer.current, ZERO)
    builder.jump(done)
    builder.place(off)
    builder.branch(timer.bit, done, when=False)
    _start_or_advance(rung, timer, resolution, passed)
    builder.move(timer.bit, rung.compute("<", timer.current, preset))
    builder.place(done)


# ------------------------------------------------------------------------------------------------------- counters


def _rising(rung: Rung, number: int, lane: int, level: Operand) -> Operand:
    """Whether a counting input goes from 0 to 1."""
    old = Cell(COUNTER_EDGES, 2 * number + lane, BOOL)
    found = rung.result(_AND_NOT, level, old)
    rung.assign(old, move(BOOL), level)
    return found


_AND_NOT = Operator("AND_NOT", (BOOL, BOOL), BOOL, "{0} and not {1}")
_COUNT = Operator("COUNT", (INT, BOOL, BOOL), INT, "{0} + ({1} and {0} < 32767) - ({2} and {0} > -32768)")
_DOWN_TO_ZERO = Operator("COUNT_DOWN", (INT, BOOL), INT, "{0} - 1 if {1} and {0} > 0 else {0}")


def count_up(rung: Rung, number: int, preset: Operand) -> None:
    """CTU Cxxx, PV: CU is the second level of the stack, R the top."""
    rung.need(2)
    _count(rung, number, preset, _rising(rung, number, 0, rung.stack[-2]), FALSE)


def count_both(rung: Rung, number: int, preset: Operand) -> None:
    """CTUD Cxxx, PV: CU is the third level of the stack, CD the second, R the top."""
    rung.need(3)
    up, down = _rising(rung, number, 0, rung.stack[-3]), _rising(rung, number, 1, rung.stack[-2])
    _count(rung, number, preset, up, down)


def _count(rung: Rung, number: int, preset: Operand, up: Operand, down: Operand) -> None:
    current, builder = _current(number), rung.builder
    counting, done = builder.label(), builder.label()
    builder.branch(rung.top, counting, when=False)
    _cleared(builder, number, ZERO)
    builder.jump(done)
    builder.place(counting)
    builder.assign(current, _COUNT, current, up, down)
    builder.move(_bit(number), rung.compute(">=", current, preset))
    builder.place(done)


def count_down(rung: Rung, number: int, preset: Operand) -> None:
    """CTD Cxxx, PV: CD is the second level of the stack, LD the top; the bit comes at zero."""
    rung.need(2)
    current, builder = _current(number), rung.builder
    down = _rising(rung, number, 1, rung.stack[-2])
    counting, done = builder.label(), builder.label()
    builder.branch(rung.top, counting, when=False)
    _cleared(builder, number, preset)
    builder.jump(done)
    builder.place(counting)
    builder.assign(current, _DOWN_TO_ZERO, current, down)
    builder.move(_bit(number), rung.compute("=", current, ZERO))
    builder.place(done)


def _cleared(builder: Builder, number: int, value: Operand) -> None:
    builder.move(_current(number), value)
    builder.move(_bit(number), FALSE)


def _bit(number: int) -> Cell:
    return Cell(COUNTER_BITS, number, BOOL)


def _current(number: int) -> Cell:
    return Cell(COUNTERS, 16 * number, INT)
