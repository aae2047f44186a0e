"""One block while it is lowered: its registers, its operands, and the core that is written."""

from __future__ import annotations

from dataclasses import dataclass, field

from plcgen.errors import SourceError
from plcgen.plc.builder import Builder
from plcgen.plc.core import Compute, Literal, Operand, Place, Register
from plcgen.plc.operators import Operator, move
from plcgen.plc.scl.lowering_declarations import Catalogue
from plcgen.plc.source import Span
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_operators import BITS, VIEWS, row
from plcgen.plc.stl.s7_registers import ACCU1, ACCU2, CC, FALSE, FC, OR, OS, OV
from plcgen.plc.stl.s7_scope import Scope
from plcgen.plc.stl.s7_selection import Selection
from plcgen.plc.types import BOOL, DWORD, Elementary


@dataclass(frozen=True)
class Bracket:
    """What `A(` and the like put aside: their name, and the RLO, OR and /FC of before."""

    statement: syntax.Statement
    rlo: Operand
    disjunction: Operand
    first: Operand


@dataclass
class Code:
    """The block being lowered; `selected` are the open data blocks before the running statement."""

    block: syntax.Block
    catalogue: Catalogue
    scope: Scope
    builder: Builder
    end: str
    statement: syntax.Statement = field(init=False)
    selected: Selection = field(default_factory=Selection)
    brackets: list[Bracket] = field(default_factory=list)

    # ------------------------------------------------------------------------------------------------------ errors

    def error(self, message: str, operand: syntax.Operand | Span | None = None) -> SourceError:
        span = operand if isinstance(operand, Span) else operand.span if operand else self.statement.span
        return self.block.source.error(message, span)

    def text(self, operand: syntax.Operand) -> str:
        return self.block.source.text[operand.span.start : operand.span.end]

    # -------------------------------------------------------------------------------------------------- computations

    def compute(self, operator: Operator, *operands: Operand) -> Register:
        """The result in a fresh register, which nothing changes any more."""
        kind = operator.result
        assert isinstance(kind, Elementary)
        target = self.builder.register(kind)
        self.builder.emit(Compute(self.builder.span, target, operator, operands))
        return target

    def taken(self, source: Operand) -> Operand:
        """What a place holds now; reading it once is reading it all the time."""
        if isinstance(source, Literal) or not isinstance(source.type, Elementary):
            return source
        return self.compute(move(source.type), source)

    def put(self, target: Place, source: Operand) -> None:
        self.builder.assign(target, move(target.type), source)

    def negated(self, source: Operand) -> Operand:
        return self.compute(row("NOT", BOOL), source)

    # ------------------------------------------------------------------------------------------------- accumulators

    def view(self, kind: Elementary, register: Register = ACCU1) -> Register:
        """The low end of an accumulator as a type."""
        if kind is DWORD:
            return self.compute(move(DWORD), register)
        return self.compute(VIEWS[kind], register)

    def bits(self, value: Operand) -> Operand:
        """A value as it stands in an accumulator."""
        assert isinstance(value.type, Elementary)
        return value if value.type is DWORD else self.compute(BITS[value.type], value)

    def result(self, value: Operand, register: Register = ACCU1) -> None:
        """A value replaces what is in the register."""
        self.put(register, self.bits(value))

    def load(self, value: Operand) -> None:
        """A value goes into ACCU1, what was there into ACCU2."""
        bits = self.bits(self.taken(value))
        self.put(ACCU2, ACCU1)
        self.put(ACCU1, bits)

    # -------------------------------------------------------------------------------------------------- status bits

    def status(self, codes: Operand, overflow: Operand = FALSE) -> None:
        """Condition codes and OV of an instruction; OS remembers an OV."""
        self.put(CC, codes)
        self.put(OV, overflow)
        if overflow is not FALSE:
            self.put(OS, self.compute(row("OR", BOOL, BOOL), OS, overflow))

    def end_of_logic(self) -> None:
        """The next logic instruction begins anew."""
        self.put(FC, FALSE)
        self.put(OR, FALSE)
