"""Syntax tree of an STL source of STEP 7 V5 for S7-300: statements. What blocks declare has the syntax tree of SCL."""

from __future__ import annotations

from dataclasses import dataclass, field

from plcgen.plc.scl import syntax as declared
from plcgen.plc.source import SourceText, Span
from plcgen.plc.types import Elementary

# ------------------------------------------------------------------------------------------------------- operands


@dataclass(frozen=True)
class Constant:
    """`+5`, `L#5`, `1.5`, `W#16#FF`, `T#1s`, `'AB'`, `P#M 10.0`: a value and the type that its spelling says."""

    value: int | float | bool
    kind: Elementary
    span: Span


@dataclass(frozen=True)
class Text:
    """`'text'` of other than one, two or four characters; only a parameter takes it."""

    value: str
    span: Span


@dataclass(frozen=True)
class Variable:
    """`#x`, `x` or `"x"` with members and indices behind it."""

    name: str
    scope: declared.Scope
    path: tuple[declared.Member | declared.Index, ...]
    span: Span


@dataclass(frozen=True)
class Absolute:
    """`M 0.0`, `DBW 4`, `DB5.DBD 0`: `area` is I, Q, M, PI, PQ, L, DB or DI, `size` X, B, W or D."""

    area: str
    size: str
    byte: int
    bit: int
    span: Span
    data_block: str = ""


@dataclass(frozen=True)
class Indirect:
    """`DBW [MD 10]`: the pointer is a double word in memory."""

    area: str
    size: str
    pointer: Absolute | Variable
    span: Span


@dataclass(frozen=True)
class RegisterIndirect:
    """`DBW [AR1,P#2.0]`; without `area` the pointer in the register names it. `offset` is in bits."""

    area: str
    size: str
    register: str
    offset: int
    span: Span


@dataclass(frozen=True)
class PointerTo:
    """`P##x`: where a variable lies."""

    variable: Variable
    span: Span


@dataclass(frozen=True)
class Status:
    """`OV`, `OS`, `BR`, `UO`, `==0`, `<>0`, `>0`, `<0`, `>=0`, `<=0` or `STW`."""

    name: str
    span: Span


@dataclass(frozen=True)
class BlockName:
    """`FB 100`, `DB 5`, `DI 5`: `name` without blanks."""

    kind: str
    name: str
    span: Span


@dataclass(frozen=True)
class RegisterName:
    """`AR1`, `AR2`, and what only L reads: `DBLG`, `DBNO`, `DILG`, `DINO`."""

    name: str
    span: Span


@dataclass(frozen=True)
class LabelName:
    """Where a jump goes."""

    name: str
    span: Span


Operand = (
    Constant
    | Text
    | Variable
    | Absolute
    | Indirect
    | RegisterIndirect
    | PointerTo
    | Status
    | BlockName
    | RegisterName
    | LabelName
)

# ------------------------------------------------------------------------------------------------------ statements


@dataclass(frozen=True)
class Argument:
    """`name := operand` of a CALL."""

    name: str
    operand: Operand
    span: Span


@dataclass(frozen=True)
class Statement:
    """One instruction. `mnemonic` is the English one, `word` what was written; `arguments` only for CALL."""

    mnemonic: str
    word: str
    operands: tuple[Operand, ...]
    span: Span
    label: LabelName | None = None
    arguments: tuple[Argument, ...] = ()

    @property
    def word_span(self) -> Span:
        return Span(self.span.start, self.span.start + len(self.word))


@dataclass(frozen=True)
class Block:
    """One block. `declaration` has its header, interface and, for a DB, its values; `networks` are their places."""

    declaration: declared.Block
    statements: tuple[Statement, ...] = ()
    networks: tuple[Span, ...] = ()
    end_labels: tuple[LabelName, ...] = field(default=(), repr=False)

    @property
    def source(self) -> SourceText:
        return self.declaration.source

    @property
    def name(self) -> str:
        return self.declaration.name
