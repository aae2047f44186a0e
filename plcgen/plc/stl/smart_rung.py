"""One block while it is lowered: the logic stack of the running network, guards, and operands of instructions.

The logic stack is known while a network is compiled, so its levels are core operands and cost nothing at run time.
Instructions that run only when the top of the stack is 1 stand behind a branch; neighbours under the same top share it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from plcgen.errors import SourceError
from plcgen.plc.builder import Builder
from plcgen.plc.core import Cell, Literal, Operand, Place, Register
from plcgen.plc.operators import Operator, move, resolve
from plcgen.plc.stl import syntax
from plcgen.plc.stl.lowering_interface import Local
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.smart_memory import EDGES, MOST_EDGES, SM, V, cell_at, pointer_to
from plcgen.plc.stl.smart_operators import pointed
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DWORD, REAL, Elementary

STACK_LEVELS = 32
TRUE, FALSE = Literal(True, BOOL), Literal(False, BOOL)
SM1 = Cell(SM, BYTE_BITS, BYTE)
ALWAYS_ON = Cell(SM, 0, BOOL)


@dataclass
class Edges:
    """Memory of EU and ED, counted over all blocks."""

    used: int = 0


@dataclass
class Loop:
    """A FOR that waits for its NEXT."""

    statement: syntax.Statement
    index: Place
    repeat: str
    leave: str


@dataclass
class Step:
    """A step between LSCR and SCRE."""

    statement: syntax.Statement
    bit: Cell
    leave: str


@dataclass
class Rung:
    """The block being lowered. `failures` are the bits of SM1 that tell AENO whether the last box failed."""

    block: syntax.Block
    names: Names
    locals: tuple[Local, ...]
    edges: Edges
    builder: Builder
    stack: list[Operand] = field(default_factory=list)
    failures: tuple[Cell, ...] = ()
    statement: syntax.Statement = field(init=False)
    loops: list[Loop] = field(default_factory=list)
    step: Step | None = None
    labels: set[int] = field(default_factory=set)
    _guard: tuple[Operand, str] | None = None

    def error(self, message: str, operand: syntax.Operand | None = None) -> SourceError:
        """At the operand, else at the statement."""
        return self.block.source.error(message, (operand or self.statement).span)

    # ------------------------------------------------------------------------------------------------- logic stack

    def start_network(self) -> None:
        self.stack.clear()

    def push(self, value: Operand) -> None:
        if len(self.stack) == STACK_LEVELS:
            raise self.error(f"the logic stack has {STACK_LEVELS} levels; split the network")
        self.stack.append(value)

    def pop(self) -> Operand:
        self.need(1)
        return self.stack.pop()

    def need(self, levels: int) -> None:
        if len(self.stack) >= levels:
            return
        word = self.statement.mnemonic
        if not self.stack:
            raise self.error(f"{word} needs a condition before it in its network; begin with LD")
        raise self.error(f"{word} needs {levels} levels of the logic stack, there is {len(self.stack)}; add an LD")

    @property
    def top(self) -> Operand:
        self.need(1)
        return self.stack[-1]

    @top.setter
    def top(self, value: Operand) -> None:
        self.stack[-1] = value

    def both(self, left: Operand, right: Operand) -> Operand:
        """AND of two bits."""
        return self._joined("AND", left, right, TRUE, FALSE)

    def either(self, left: Operand, right: Operand) -> Operand:
        """OR of two bits."""
        return self._joined("OR", left, right, FALSE, TRUE)

    def _joined(self, symbol: str, left: Operand, right: Operand, neutral: Literal, final: Literal) -> Operand:
        if final in (left, right):
            return final
        if neutral in (left, right):
            return self.captured(left if right == neutral else right)
        return self.compute(symbol, left, right)

    def captured(self, bit: Operand) -> Operand:
        """The bit as it is now."""
        return self.builder.compute(move(BOOL), bit) if isinstance(bit, Cell) else bit

    # ----------------------------------------------------------------------------------------------------- guards

    def open_guard(self) -> None:
        """What follows runs when the top of the stack is 1."""
        top = self.top
        if self._guard is not None and self._guard[0] is top:
            return
        self.close_guard()
        if top is TRUE:
            return
        self._guard = (top, self.builder.label())
        self.builder.branch(top, self._guard[1], when=False)

    def close_guard(self) -> None:
        if self._guard is not None:
            self.builder.place(self._guard[1])
            self._guard = None

    # -------------------------------------------------------------------------------------------------- core code

    def compute(self, symbol: str, *operands: Operand) -> Operand:
        """The result of a row of the common table."""
        row = resolve(symbol, [operand.type for operand in operands])
        assert row is not None, f"{symbol} of lowered operands"
        return self.builder.compute(row, *operands)

    def assign(self, target: Place, operator: Operator, *operands: Operand) -> None:
        self.builder.assign(target, operator, *operands)

    def result(self, operator: Operator, *operands: Operand) -> Register:
        """The operator's result, computed at run time even if the operands are constants."""
        assert isinstance(operator.result, Elementary)
        register = self.builder.register(operator.result)
        self.builder.assign(register, operator, *operands)
        return register

    def edge(self) -> Cell:
        """Fresh memory for the last state of a bit."""
        if self.edges.used == MOST_EDGES:
            raise self.error(f"more than {MOST_EDGES} EU and ED in the program; use fewer")
        self.edges.used += 1
        return Cell(EDGES, self.edges.used - 1, BOOL)

    # --------------------------------------------------------------------------------------------------- operands

    def read(self, operand: syntax.Operand, kind: Elementary, elements: int = 1) -> Operand:
        """The value of an operand as `kind`; behind a pointer there must be so many."""
        if isinstance(operand, syntax.Constant):
            return self._constant(operand, kind)
        if isinstance(operand, syntax.AddressOf):
            return self._pointer(operand, kind)
        cell = self._cell(operand, kind, elements)
        return TRUE if cell == ALWAYS_ON else cell

    def write(self, operand: syntax.Operand, kind: Elementary, elements: int = 1) -> Cell:
        """The place of an operand that an instruction writes."""
        if isinstance(operand, syntax.Constant | syntax.AddressOf):
            raise self.error(f"{self.text(operand)} cannot be written; name an address", operand)
        cell = self._cell(operand, kind, elements)
        if cell.area == SM and cell.bit < BYTE_BITS:
            raise self.error(f"{self.text(operand)}: SMB0 belongs to the CPU and cannot be written", operand)
        return cell

    def text(self, operand: syntax.Operand) -> str:
        """As written."""
        return self.block.source.text[operand.span.start : operand.span.end]

    def _cell(self, operand: syntax.Operand, kind: Elementary, elements: int) -> Cell:
        if isinstance(operand, syntax.Indirect):
            return self._indirect(operand, kind, elements)
        if isinstance(operand, syntax.Name):
            return self._named(operand, kind)
        assert isinstance(operand, syntax.Address)
        return self._placed(operand, operand, kind)

    def _placed(self, address: syntax.Address, operand: syntax.Operand, kind: Elementary) -> Cell:
        try:
            return cell_at(address, kind)
        except ValueError as error:
            raise self.error(str(error), operand) from None

    def _named(self, operand: syntax.Name, kind: Elementary) -> Cell:
        name = operand.text.casefold()
        local = next((item for item in self.locals if item.declaration.name.casefold() == name), None)
        if local is not None:
            if local.type.bits != kind.bits:
                raise self.error(f"{operand.text} is {local.type}, {self.statement.mnemonic} takes {kind}", operand)
            return Cell(local.cell.area, local.cell.bit, kind)
        address = self.names.address(operand.text, operand.span)
        if address is None:
            near = self.names.near(operand.text, [item.declaration.name for item in self.locals])
            raise self.error(f"unknown symbol {operand.text}{near or '; write its address'}", operand)
        return self._placed(address, operand, kind)

    def _indirect(self, operand: syntax.Indirect, kind: Elementary, elements: int) -> Cell:
        if kind is BOOL:
            raise self.error(f"{self.text(operand)}: a bit cannot be reached by a pointer; move its byte", operand)
        pointer = operand.pointer
        if pointer.area not in ("V", "L", "AC") or (pointer.area == "AC" and pointer.byte == 0):
            raise self.error(f"{pointer} cannot hold a pointer; use VD, LD, AC1, AC2 or AC3", operand)
        cell = self._placed(pointer, operand, DWORD)
        return Cell(V, 0, kind, self.result(pointed(elements * kind.bits // BYTE_BITS), cell))

    def _pointer(self, operand: syntax.AddressOf, kind: Elementary) -> Operand:
        if kind.bits != 32:
            raise self.error(f"{self.text(operand)} is a double word; MOVD takes it", operand)
        try:
            return Literal(pointer_to(operand.target), kind)
        except ValueError as error:
            raise self.error(str(error), operand) from None

    def _constant(self, operand: syntax.Constant, kind: Elementary) -> Operand:
        text = self.text(operand)
        if kind is REAL:
            return self._real(operand, text)
        if isinstance(operand.value, float):
            raise self.error(f"{text} is a REAL, {self.statement.mnemonic} takes {kind}; write a whole number", operand)
        lowest = 0 if operand.pattern or kind in (BOOL, BYTE) else -(1 << kind.bits - 1)
        highest = kind.maximum if not operand.pattern else (1 << kind.bits) - 1
        if kind is BOOL or not lowest <= operand.value <= highest:
            raise self.error(f"{text} is no {kind}; {self.statement.mnemonic} takes {lowest} to {highest}", operand)
        return Literal((operand.value - kind.minimum & (1 << kind.bits) - 1) + kind.minimum, kind)

    def _real(self, operand: syntax.Constant, text: str) -> Operand:
        if operand.pattern or isinstance(operand.value, int):
            raise self.error(f"{text} is no REAL; write it with a point, like {float(operand.value)!r}", operand)
        return Literal(REAL.nearest(operand.value), REAL)


Slot = Callable[[Rung, syntax.Operand], object]
"""Turns one operand into what an instruction needs."""
