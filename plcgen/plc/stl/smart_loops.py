"""Instructions that do something N times: block moves, FILL, S and R with a count."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from plcgen.plc.core import FRAME, Cell, Literal, Operand
from plcgen.plc.operators import Operator, move
from plcgen.plc.stl import syntax
from plcgen.plc.stl.smart_memory import AREAS, LOCAL_BYTES
from plcgen.plc.stl.smart_rung import Rung
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DINT, Elementary

UNROLLED = 8
"""Up to so many times the core is written out."""
MOST = 255
"""The most that N can say."""
ONE, NONE = Literal(1, DINT), Literal(0, DINT)


class Lane(NamedTuple):
    """A cell that moves on by `stride` bits each time."""

    cell: Cell
    stride: int

    def at(self, step: int) -> Cell:
        return Cell(self.cell.area, self.cell.bit + step * self.stride, self.cell.type, self.cell.index)

    @property
    def room(self) -> int:
        """How often it fits into its area; a pointer was checked when it was followed."""
        if self.cell.index is not None or not self.stride:
            return MOST
        size = LOCAL_BYTES if self.cell.area is FRAME else AREAS[self.cell.area]
        return min(MOST, (size * BYTE_BITS - self.cell.bit) // self.stride)


def each(rung: Rung, count: syntax.Operand, lanes: Sequence[Lane], body: Callable[..., None]) -> None:
    """body(cell, ...) N times, N being a constant 1 .. 255 or a byte."""
    times = rung.read(count, BYTE)
    room = min(lane.room for lane in lanes)
    if not isinstance(times, Literal):
        _loop(rung, rung.result(_limited(room), times), lanes, body)
        return
    if not 1 <= int(times.value) <= room:
        text = rung.text(count)
        raise rung.error(f"N = {text} does not fit here; write a constant from 1 to {room}", count)
    if int(times.value) > UNROLLED:
        _loop(rung, rung.result(_limited(room), times), lanes, body)
        return
    for step in range(int(times.value)):
        body(*(lane.at(step) for lane in lanes))


def _limited(room: int) -> Operator:
    stop = f"stop('N = %d reaches beyond the end of an area; {room} is the most' % {{r}}, {{site}})"
    return Operator("TIMES", (BYTE,), DINT, "{0}", False, f"{{r}} > {room}", stop)


def _loop(rung: Rung, times: Operand, lanes: Sequence[Lane], body: Callable[..., None]) -> None:
    builder = rung.builder
    left, indices = builder.register(DINT, "left"), [builder.register(DINT, "index") for _ in lanes]
    repeat, leave = builder.label(), builder.label()
    builder.assign(left, move(DINT), times)
    for lane, index in zip(lanes, indices, strict=True):
        builder.assign(index, move(DINT), lane.cell.index or NONE)
    builder.place(repeat)
    builder.branch(rung.compute("<=", left, NONE), leave, when=True)
    body(*(Cell(lane.cell.area, lane.cell.bit, lane.cell.type, i) for lane, i in zip(lanes, indices, strict=True)))
    for lane, index in zip(lanes, indices, strict=True):
        builder.move(index, rung.compute("+", index, Literal(lane.stride, DINT)))
    builder.move(left, rung.compute("-", left, ONE))
    builder.jump(repeat)
    builder.place(leave)


def reach(count: syntax.Operand) -> int:
    """How many elements a pointer must leave room for, as far as the text says."""
    return count.value if isinstance(count, syntax.Constant) and isinstance(count.value, int) else 1


def block_move(kind: Elementary) -> Callable[[Rung, syntax.Operand, syntax.Operand, syntax.Operand], None]:
    """BMB, BMW, BMD: IN, OUT, N"""

    def emit(rung: Rung, source: syntax.Operand, target: syntax.Operand, count: syntax.Operand) -> None:
        start = rung.read(source, kind, reach(count))
        if not isinstance(start, Cell):
            raise rung.error(f"{rung.text(source)} is no block of memory; name its first address", source)
        lanes = (Lane(start, kind.bits), Lane(rung.write(target, kind, reach(count)), kind.bits))
        each(rung, count, lanes, lambda taken, given: rung.assign(given, move(kind), taken))

    return emit


def fill(kind: Elementary) -> Callable[[Rung, syntax.Operand, syntax.Operand, syntax.Operand], None]:
    """FILL: IN, OUT, N"""

    def emit(rung: Rung, source: syntax.Operand, target: syntax.Operand, count: syntax.Operand) -> None:
        value = rung.result(move(kind), rung.read(source, kind))
        lanes = (Lane(rung.write(target, kind, reach(count)), kind.bits),)
        each(rung, count, lanes, lambda given: rung.assign(given, move(kind), value))

    return emit


def put(value: Literal, companions: Callable[[Rung, Cell], Sequence[Lane]]) -> Callable[..., None]:
    """S and R: N bits from the first one on, and what goes to zero with them."""

    def emit(rung: Rung, first: syntax.Operand, count: syntax.Operand) -> None:
        target = rung.write(first, BOOL)

        def one(*cells: Cell) -> None:
            for cell in cells:
                assert isinstance(cell.type, Elementary)
                rung.assign(cell, move(cell.type), value if cell.type is BOOL else Literal(0, cell.type))

        each(rung, count, (Lane(target, 1), *companions(rung, target)), one)

    return emit
