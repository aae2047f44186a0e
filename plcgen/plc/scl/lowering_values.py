"""Values while SCL is lowered: constants without a type yet, implicit conversions, the choice of an operator row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from math import isfinite
from operator import and_, or_, xor

from plcgen.plc.builder import Builder
from plcgen.plc.core import Literal, Operand
from plcgen.plc.operators import IMPLICIT, Operator, alternatives, conversion, text_comparison, text_copy
from plcgen.plc.scl import syntax
from plcgen.plc.source import SourceText, Span
from plcgen.plc.types import (
    BIT_STRINGS,
    BOOL,
    CHAR,
    DINT,
    DWORD,
    ELEMENTARY,
    FLOATS,
    INT,
    INTEGERS,
    LINT,
    LREAL,
    LWORD,
    REAL,
    ULINT,
    WORD,
    Elementary,
    Field,
    String,
    Structure,
    Type,
    elementary,
)


@dataclass(frozen=True)
class Untyped:
    """A constant that takes the type of its context; `based` when spelt 16#, 8# or 2#, so that it means bits."""

    value: int | float | str
    based: bool = False


Value = Operand | Untyped


def literal(source: SourceText, node: syntax.Literal) -> Value:
    """The value of a literal as written."""
    if isinstance(node.value, bool):
        return Literal(node.value, BOOL)
    untyped = Untyped(node.value, node.based)
    kind = elementary(node.type_name) if node.type_name else None
    if kind is None:
        return untyped
    if kind not in (BOOL, CHAR, *FLOATS, *INTEGERS, *BIT_STRINGS):
        return Literal(node.value, kind) if not isinstance(node.value, str) else untyped
    adapted = adapt(untyped, kind)
    if adapted is None:
        raise source.error(_misfit(untyped, kind, source.text[node.span.start : node.span.end]), node.span)
    return adapted


def type_of(value: Value) -> Type:
    """The type, for an untyped constant the one it takes without a context."""
    return default(value).type if isinstance(value, Untyped) else value.type


def default(constant: Untyped) -> Literal:
    """An untyped constant that nothing around gives a type."""
    if isinstance(constant.value, str):
        kinds: Sequence[Type] = (CHAR, String(len(constant.value)))
    elif isinstance(constant.value, float):
        kinds = FLOATS
    else:
        kinds = (WORD, DWORD, LWORD) if constant.based else (INT, DINT, LINT, ULINT)
    return next(adapted for kind in kinds if (adapted := adapt(constant, kind)) is not None)


def adapt(constant: Untyped, kind: Type) -> Literal | None:
    """The constant as a literal of this type, None when it does not fit."""
    value = constant.value
    if isinstance(value, str):
        return _adapt_text(value, kind)
    if kind in FLOATS and not constant.based:
        return _adapt_float(float(value), kind)
    if isinstance(value, float) or not isinstance(kind, Elementary):
        return None
    if kind is BOOL:
        return Literal(bool(value), BOOL) if value in (0, 1) else None
    if kind not in (*INTEGERS, *BIT_STRINGS):
        return None
    if constant.based and kind.maximum < value < 1 << kind.bits:
        value -= 1 << kind.bits
    return Literal(value, kind) if kind.minimum <= value <= kind.maximum else None


def _adapt_text(text: str, kind: Type) -> Literal | None:
    if kind is CHAR and len(text) == 1:
        return Literal(ord(text), CHAR)
    if isinstance(kind, String) and len(text) <= kind.length:
        return Literal(kind.encode(text), kind)
    return None


def _adapt_float(number: float, kind: Type) -> Literal | None:
    assert isinstance(kind, Elementary)
    nearest = float(kind.nearest(number))
    return Literal(nearest, kind) if isfinite(nearest) else None


def coerce(builder: Builder, value: Value, kind: Type) -> Operand | None:
    """The value as this type if that needs no explicit conversion, else None."""
    if isinstance(value, Untyped):
        return adapt(value, kind)
    if value.type == kind:
        return value
    row = implicit(value.type, kind)
    return builder.compute(row, value) if row else None


def implicit(source: Type, target: Type) -> Operator | None:
    """The row that converts without being asked; a STRING is cut to the length of its target."""
    if isinstance(source, String) and isinstance(target, String):
        return text_copy(source, target)
    return conversion(source, target) if (source, target) in IMPLICIT else None


def expect(source: SourceText, builder: Builder, value: Value, kind: Type, span: Span) -> Operand:
    """The value as this type. Raises SourceError with the way out."""
    operand = coerce(builder, value, kind)
    if operand is None:
        raise source.error(_misfit(value, kind, source.text[span.start : span.end]), span)
    return operand


def _misfit(value: Value, kind: Type, text: str) -> str:
    if isinstance(value, Untyped) and isinstance(value.value, str) and isinstance(kind, String):
        return f"{value.value!r} has {len(value.value)} characters, {kind} holds {kind.length}"
    if isinstance(value, Untyped):
        limits = f" ({kind.minimum} .. {kind.maximum})" if kind in (*INTEGERS, *BIT_STRINGS) else ""
        return f"constant {value.value!r} is no {kind}{limits}"
    if isinstance(value.type, Structure) and isinstance(kind, Structure):
        return f"{value.type} is no {kind}{_difference(value.type, kind)}"
    if kind is BOOL and value.type in (*INTEGERS, *BIT_STRINGS):
        return f"{value.type} is no BOOL; compare it, as in {text if text.lstrip('#').isidentifier() else 'x'} <> 0"
    row = conversion(value.type, kind)
    return f"{value.type} is no {kind}" + (f"; convert with {row.name}" if row else "")


def _difference(source: Structure, target: Structure) -> str:
    for own, other in zip_longest(source.fields, target.fields):
        if own != other:
            return f": they differ in {_spelt(own)} and {_spelt(other)}"
    return "; assign its members one by one"


def _spelt(member: Field | None) -> str:
    return f"{member.name} : {member.type}" if member else "nothing"


# ------------------------------------------------------------------------------------------------------ operators


def combine(source: SourceText, builder: Builder, symbol: str, values: Sequence[Value], span: Span) -> Value:
    """Apply an operator or function of the table. Raises SourceError when it has no row for these types."""
    folded = _fold_exactly(symbol, values)
    if folded is not None:
        return folded
    if all(isinstance(value, Untyped) for value in values):
        values = [default(value) for value in values if isinstance(value, Untyped)]
    row = select(symbol, values)
    if row is None:
        raise source.error(_no_row(symbol, values), span)
    operands = [coerce(builder, value, kind) for value, kind in zip(values, row.operands, strict=True)]
    return builder.compute(row, *(operand for operand in operands if operand is not None))


WORD_OPERATORS = frozenset(("AND", "OR", "XOR", "NOT", "MOD", "DIV"))

_EXACT: dict[str, Callable[..., int]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
}
_BITWISE: dict[str, Callable[[int, int], int]] = {"AND": and_, "OR": or_, "XOR": xor}


def _fold_exactly(symbol: str, values: Sequence[Value]) -> Value | None:
    """Whole numbers stay untyped, so that 30000 + 10000 is a DINT; a sign before a number keeps it as written.

    So do bits: 16#F0 OR 16#0F fits a BYTE.
    """
    numbers = [v.value for v in values if isinstance(v, Untyped) and not isinstance(v.value, str)]
    if len(numbers) < len(values):
        return None
    if symbol == "NEG":
        return Untyped(-numbers[0])
    if symbol in _BITWISE and all(isinstance(value, Untyped) and value.based for value in values):
        return Untyped(_BITWISE[symbol](*map(int, numbers)), based=True)
    if symbol not in _EXACT or any(isinstance(number, float) for number in numbers):
        return None
    result = _EXACT[symbol](*numbers)
    return Untyped(result) if LINT.minimum <= result <= ULINT.maximum else None


def select(symbol: str, values: Sequence[Value]) -> Operator | None:
    """The first row that takes these values, narrow types first."""
    if any(isinstance(type_of(value), String) for value in values):
        return text_comparison(symbol, [type_of(value) for value in values])
    doubles = any(type_of(value) is LREAL for value in values)  # nothing becomes LREAL by itself
    rows = (row for row in alternatives(symbol) if len(row.operands) == len(values))
    fitting = (row for row in rows if all(map(_fits, values, row.operands)))
    return next((row for row in fitting if doubles or LREAL not in row.operands), None)


def _fits(value: Value, kind: Type) -> bool:
    if isinstance(value, Untyped):
        return kind is not BOOL and adapt(value, kind) is not None
    return value.type == kind or (value.type, kind) in IMPLICIT


def _no_row(symbol: str, values: Sequence[Value]) -> str:
    types = [type_of(value) for value in values]
    name = "-" if symbol == "NEG" else symbol
    what = "function" if name.isalpha() and name not in WORD_OPERATORS else "operator"
    way_out = _way_out(symbol, values, types)
    return f"no {what} {name} for {' and '.join(map(str, types))}" + (f"; {way_out}" if way_out else "")


def _way_out(symbol: str, values: Sequence[Value], types: Sequence[Type]) -> str | None:
    """A conversion of one operand that leads to a row, widest target first; a number becomes BOOL by a comparison."""
    own = {kind for kind in types if isinstance(kind, Elementary)}
    targets = [kind for kind in reversed(ELEMENTARY.values()) if kind in own | {REAL, INT}]
    for target in targets:
        for position, kind in enumerate(types):
            row = conversion(kind, target)
            if row and select(symbol, [*values[:position], Literal(0, target), *values[position + 1 :]]):
                return f"compare the {kind}, as in x <> 0" if target is BOOL else f"convert with {row.name}"
    return None
