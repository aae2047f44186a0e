"""Bit logic of the S7-200 SMART: contacts, edges, the logic stack, compares, coils."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from plcgen.plc.core import Area, Cell, Operand
from plcgen.plc.operators import move
from plcgen.plc.stl.smart_loops import Lane
from plcgen.plc.stl.smart_memory import (
    AREAS,
    COUNTER_BITS,
    COUNTERS,
    LOCAL_BYTES,
    PHYSICAL_OUTPUTS,
    SM,
    TIMER_BITS,
    TIMERS,
)
from plcgen.plc.stl.smart_rung import Rung
from plcgen.plc.types import BOOL, BYTE, INT, WORD_BITS

SHIFTED_OUT = Cell(SM, 9, BOOL)

Meeting = Callable[[Rung, Operand], None]
"""How a new bit meets the stack: LD pushes it, A and O join it to the top."""


def load(rung: Rung, bit: Operand) -> None:
    rung.push(rung.captured(bit))


def conjoin(rung: Rung, bit: Operand) -> None:
    rung.top = rung.both(rung.top, bit)


def disjoin(rung: Rung, bit: Operand) -> None:
    rung.top = rung.either(rung.top, bit)


def negated(meet: Meeting) -> Callable[[Rung, Operand], None]:
    return lambda rung, bit: meet(rung, rung.compute("NOT", bit))


def compare(meet: Meeting, symbol: str) -> Callable[[Rung, Operand, Operand], None]:
    return lambda rung, left, right: meet(rung, rung.compute(symbol, left, right))


# ---------------------------------------------------------------------------------------------------------- stack


def invert(rung: Rung) -> None:
    """NOT"""
    rung.top = rung.compute("NOT", rung.top)


def rising(rung: Rung) -> None:
    """EU: 1 for one pass when the top goes from 0 to 1."""
    old = rung.edge()
    _edge(rung, old, rung.both(rung.top, rung.compute("NOT", old)))


def falling(rung: Rung) -> None:
    """ED: 1 for one pass when the top goes from 1 to 0."""
    old = rung.edge()
    _edge(rung, old, rung.both(rung.compute("NOT", rung.top), old))


def _edge(rung: Rung, old: Cell, found: Operand) -> None:
    rung.assign(old, move(BOOL), rung.top)
    rung.top = found


def and_load(rung: Rung) -> None:
    """ALD: both top levels become one."""
    rung.need(2)
    rung.push(rung.both(rung.pop(), rung.pop()))


def or_load(rung: Rung) -> None:
    """OLD: both top levels become one."""
    rung.need(2)
    rung.push(rung.either(rung.pop(), rung.pop()))


def logic_push(rung: Rung) -> None:
    """LPS: the top once more."""
    rung.push(rung.top)


def logic_read(rung: Rung) -> None:
    """LRD: the second level replaces the top."""
    rung.need(2)
    rung.top = rung.stack[-2]


def logic_pop(rung: Rung) -> None:
    """LPP: the second level becomes the top."""
    rung.need(2)
    rung.pop()


def load_stack(rung: Rung, level: int) -> None:
    """LDS n: level n once more, on top."""
    rung.need(level + 1)
    rung.push(rung.stack[-1 - level])


def and_eno(rung: Rung) -> None:
    """AENO: whether the box before went well."""
    for failure in rung.failures:
        rung.top = rung.both(rung.top, rung.compute("NOT", failure))


# ---------------------------------------------------------------------------------------------------------- coils


def coil(rung: Rung, target: Cell) -> None:
    """= bit"""
    rung.assign(target, move(BOOL), rung.top)


def coil_now(rung: Rung, target: Cell) -> None:
    """=I: the output itself too, not only its image."""
    coil(rung, target)
    rung.assign(_physical(rung, target), move(BOOL), rung.top)


def current(_rung: Rung, bit: Cell) -> Sequence[Lane]:
    """R of a timer or counter clears its value too."""
    area = {TIMER_BITS: TIMERS, COUNTER_BITS: COUNTERS}.get(str(bit.area))
    return (Lane(Cell(area, bit.bit * WORD_BITS, INT), WORD_BITS),) if area else ()


def at_once(rung: Rung, bit: Cell) -> Sequence[Lane]:
    """SI and RI: the outputs themselves too."""
    return (Lane(_physical(rung, bit), 1),)


def alone(_rung: Rung, _bit: Cell) -> Sequence[Lane]:
    return ()


def write_now(rung: Rung, source: Operand, target: Cell) -> None:
    """BIW IN, OUT: a byte of outputs at once."""
    rung.assign(target, move(BYTE), source)
    rung.assign(_physical(rung, target), move(BYTE), source)


def shift_register(rung: Rung, data: Operand, first: Cell, count: int) -> None:
    """SHRB DATA, S_BIT, N: |N| bits from S_BIT on move up (N > 0) or down, DATA comes in, SM1.1 goes out."""
    if not count:
        return
    length = abs(count)
    cells = [Cell(first.area, first.bit + place, BOOL) for place in range(length)]
    if first.bit + length > 8 * AREAS.get(first.area, LOCAL_BYTES):
        raise rung.error(f"N = {count} reaches beyond the end of {first.area}; write fewer")
    order = cells[::-1] if count > 0 else cells
    value = rung.result(move(BOOL), data)
    rung.assign(SHIFTED_OUT, move(BOOL), order[0])
    for target, source in pairwise(order):
        rung.assign(target, move(BOOL), source)
    rung.assign(order[-1], move(BOOL), value)


def _physical(rung: Rung, target: Cell) -> Cell:
    if target.area is not Area.OUTPUTS:
        word = rung.statement.mnemonic
        raise rung.error(f"{word} takes outputs only; write {word.rstrip('I')}, or an address of Q")
    return Cell(PHYSICAL_OUTPUTS, target.bit, target.type)
