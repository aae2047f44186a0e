"""Syntax tree of SCL: one frozen class for each construct, no behaviour.

Both dialects share this tree; what differs in spelling is settled by the parser and its dialect table. Names keep
the case of the source, SCL compares them without case.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from plcgen.plc.source import SourceText, Span

# ---------------------------------------------------------------------------------------------------- expressions


@dataclass(frozen=True)
class Literal:
    """A constant. `type_name` is the upper-case type where spelling fixes it (`T#1s` TIME, `16#FF` is None).

    value: int, float, bool or str; TIME in ms, TIME_OF_DAY in ms, DATE in days since 1990-01-01, S5TIME as its BCD
    word, DATE_AND_TIME as its eight BCD bytes in one big-endian int. `based` marks 2#, 8#, 16# spelling.
    """

    span: Span
    value: int | float | bool | str
    type_name: str | None = None
    based: bool = False


class Scope(Enum):
    """How a name was spelt: `x`, `#x` or `"x"`."""

    PLAIN = "plain"
    LOCAL = "local"
    GLOBAL = "global"


@dataclass(frozen=True)
class Member:
    """`.name` after a variable."""

    span: Span
    name: str


@dataclass(frozen=True)
class Index:
    """`[i, j]` after a variable."""

    span: Span
    indices: tuple[Expression, ...]


@dataclass(frozen=True)
class Slice:
    """`.%X3`, `.%B1` ... after a variable (TIA): `unit` is X, B, W or D."""

    span: Span
    unit: str
    number: int


@dataclass(frozen=True)
class Variable:
    """A named variable with selectors: `x`, `#x.y[3]`, `"Db".z`, `DB100.out`."""

    span: Span
    name: str
    scope: Scope = Scope.PLAIN
    selectors: tuple[Member | Index | Slice, ...] = ()


@dataclass(frozen=True)
class Address:
    """An absolute operand: `M0.0`, `%MW10`, `DB100.DBD4`. `area` is I, Q, M, PI, PQ or DBn; `size` is X, B, W or D."""

    span: Span
    area: str
    size: str
    byte: int
    bit: int = 0


@dataclass(frozen=True)
class Argument:
    """`name := value`, `name => value` (`is_output`), or a bare value (`name` is None)."""

    span: Span
    name: str | None
    value: Expression
    is_output: bool = False


@dataclass(frozen=True)
class Call:
    """A call of a standard function, FC, FB instance or multi-instance.

    `callee` keeps all selectors: `ABS`, `FC100`, `"Db"`, `#inst`, and the classic `FB100.DB100` as name FB100 with
    Member DB100.
    """

    span: Span
    callee: Variable
    arguments: tuple[Argument, ...]


@dataclass(frozen=True)
class Unary:
    """`-x`, `+x`, `NOT x`."""

    span: Span
    operator: str
    operand: Expression


@dataclass(frozen=True)
class Binary:
    """`left operator right`; the operator in upper case, `&` already as AND. `operator_span` is for carets."""

    span: Span
    operator: str
    left: Expression
    right: Expression
    operator_span: Span


Expression = Literal | Variable | Address | Call | Unary | Binary

# ----------------------------------------------------------------------------------------------------- statements


@dataclass(frozen=True)
class Assignment:
    """`target := value;` or, in TIA, `+= -= *= /=` with `operator` set to + - * /."""

    span: Span
    target: Variable | Address
    value: Expression
    operator: str | None = None


@dataclass(frozen=True)
class CallStatement:
    span: Span
    call: Call


@dataclass(frozen=True)
class Branch:
    """One IF or ELSIF."""

    condition: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class If:
    span: Span
    branches: tuple[Branch, ...]
    otherwise: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class CaseLabel:
    """`low` or `low .. high`."""

    low: Expression
    high: Expression | None = None


@dataclass(frozen=True)
class CaseBranch:
    labels: tuple[CaseLabel, ...]
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class Case:
    span: Span
    selector: Expression
    branches: tuple[CaseBranch, ...]
    otherwise: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class For:
    span: Span
    variable: Variable
    start: Expression
    end: Expression
    step: Expression | None
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class While:
    span: Span
    condition: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class Repeat:
    span: Span
    body: tuple[Statement, ...]
    until: Expression


@dataclass(frozen=True)
class Exit:
    span: Span


@dataclass(frozen=True)
class Continue:
    span: Span


@dataclass(frozen=True)
class Return:
    span: Span


@dataclass(frozen=True)
class Region:
    """`REGION name ... END_REGION` (TIA on 1200 and 1500)."""

    span: Span
    name: str
    body: tuple[Statement, ...]


Statement = Assignment | CallStatement | If | Case | For | While | Repeat | Exit | Continue | Return | Region

# --------------------------------------------------------------------------------------------------- declarations


@dataclass(frozen=True)
class NamedType:
    """An elementary type, a UDT or an FB (multi-instance) by name."""

    span: Span
    name: str


@dataclass(frozen=True)
class StringSpec:
    """`STRING[length]`; 254 when the length is left out."""

    span: Span
    length: Expression | None = None


@dataclass(frozen=True)
class ArraySpec:
    span: Span
    bounds: tuple[tuple[Expression, Expression], ...]
    element: TypeSpec


@dataclass(frozen=True)
class StructSpec:
    span: Span
    fields: tuple[Declaration, ...]


TypeSpec = NamedType | StringSpec | ArraySpec | StructSpec


@dataclass(frozen=True)
class Repetition:
    """`count(value)` in an initial value list."""

    span: Span
    count: Expression
    values: tuple[InitialValue, ...]


@dataclass(frozen=True)
class InitialList:
    """Several initial values of an ARRAY."""

    span: Span
    values: tuple[InitialValue, ...]


InitialValue = Literal | Variable | Call | Unary | Binary | Address | Repetition | InitialList


@dataclass(frozen=True)
class Declaration:
    """One declared name; `a, b : INT` gives two. `view_of` is the AT variable; `attributes` follow in `{ }`."""

    span: Span
    name: str
    type: TypeSpec
    initial: InitialValue | None = None
    view_of: str | None = None
    attributes: tuple[tuple[str, str], ...] = ()


class SectionKind(Enum):
    INPUT = "VAR_INPUT"
    OUTPUT = "VAR_OUTPUT"
    IN_OUT = "VAR_IN_OUT"
    STATIC = "VAR"
    TEMP = "VAR_TEMP"


@dataclass(frozen=True)
class Section:
    """A declaration section; constants stand apart as `Constant`."""

    span: Span
    kind: SectionKind
    declarations: tuple[Declaration, ...]
    retain: bool = False


@dataclass(frozen=True)
class Constant:
    """`name := expression;` in CONST (type is None), or `name : Type := expression;` in VAR CONSTANT."""

    span: Span
    name: str
    value: Expression
    type: TypeSpec | None = None


class BlockKind(Enum):
    FB = "FUNCTION_BLOCK"
    FC = "FUNCTION"
    OB = "ORGANIZATION_BLOCK"
    DB = "DATA_BLOCK"
    UDT = "TYPE"


@dataclass(frozen=True)
class Header:
    """What stands between the block name and its sections, as written (quotes of values removed)."""

    title: str | None = None
    version: str | None = None
    author: str | None = None
    family: str | None = None
    name: str | None = None
    know_how_protect: bool = False
    attributes: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Block:
    """One block. `name` without quotes; `quoted` tells how it was spelt.

    `span` is the keyword and the name, `extent` the whole block to its last word. `return_type` of an FC (None =
    VOID); `instance_of` of an instance DB (FB or UDT name); `sections` of code blocks, `structure` of a shared DB or
    UDT; `body` statements (for a DB the assignments after BEGIN).
    """

    span: Span
    extent: Span
    kind: BlockKind
    name: str
    quoted: bool
    source: SourceText = field(repr=False)
    header: Header = Header()
    constants: tuple[Constant, ...] = ()
    sections: tuple[Section, ...] = ()
    body: tuple[Statement, ...] = ()
    return_type: TypeSpec | None = None
    instance_of: str | None = None
    structure: StructSpec | None = None
