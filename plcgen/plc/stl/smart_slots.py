"""What instructions take as operands, in the words of the manual: IN, OUT, bits, timers, labels, blocks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from plcgen.plc.stl import syntax
from plcgen.plc.stl.smart_memory import COUNT, COUNTERS, TIMERS
from plcgen.plc.stl.smart_rung import Rung, Slot
from plcgen.plc.types import BOOL, Elementary


@dataclass(frozen=True)
class Row:
    """One mnemonic. `emit(rung, *operands)` writes its core; a box runs only when the top of the stack is 1.

    Without `slots` the operands come as written, however many.
    """

    emit: Callable[..., None]
    slots: tuple[Slot, ...] | None = ()
    is_box: bool = False


def box(emit: Callable[..., None], *slots: Slot) -> Row:
    return Row(emit, slots, is_box=True)


def logic(emit: Callable[..., None], *slots: Slot) -> Row:
    return Row(emit, slots)


@dataclass(frozen=True)
class Typed:
    """An operand of one type; `take` says what becomes of it."""

    kind: Elementary
    take: Callable[[Rung, syntax.Operand, Elementary], object]

    def __call__(self, rung: Rung, operand: syntax.Operand) -> object:
        return self.take(rung, operand, self.kind)


def reads(kind: Elementary) -> Slot:
    """IN"""
    return Typed(kind, Rung.read)


def writes(kind: Elementary) -> Slot:
    """OUT"""
    return Typed(kind, Rung.write)


def written(kind: Elementary) -> Slot:
    """An operand that the instruction reads or writes itself."""
    return Typed(kind, lambda _rung, operand, _kind: operand)


IN_BIT, OUT_BIT = reads(BOOL), writes(BOOL)


def number(lowest: int, highest: int, what: str) -> Slot:
    """A constant that is known when the program is compiled."""

    def read(rung: Rung, operand: syntax.Operand) -> int:
        value = operand.value if isinstance(operand, syntax.Constant) else None
        if not isinstance(value, int) or not lowest <= value <= highest:
            text = rung.text(operand)
            raise rung.error(f"{text} is no {what}; write a constant from {lowest} to {highest}", operand)
        return value

    return read


def _numbered(area: str, what: str) -> Slot:
    def read(rung: Rung, operand: syntax.Operand) -> int:
        address = operand
        if isinstance(operand, syntax.Name):
            address = rung.names.address(operand.text, operand.span) or operand
        if not isinstance(address, syntax.Address) or address.area != area or address.byte >= COUNT:
            raise rung.error(f"{rung.text(operand)} is no {what}; write {area}0 to {area}{COUNT - 1}", operand)
        return address.byte

    return read


TIMER, COUNTER = _numbered(TIMERS, "timer"), _numbered(COUNTERS, "counter")


def block(kind: syntax.BlockKind) -> Slot:
    """The absolute name of a block."""
    word = "subroutine" if kind is syntax.BlockKind.SUBROUTINE else "interrupt routine"

    def read(rung: Rung, operand: syntax.Operand) -> str:
        text = rung.text(operand)
        name = operand.text if isinstance(operand, syntax.Name) else text
        found = rung.names.block(name, kind)
        if found is None:
            raise rung.error(f"no {word} {name}{rung.names.blocks_near(name, kind)}", operand)
        return found

    return read
