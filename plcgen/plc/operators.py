"""The one table of operators for all languages and engines.

A row gives operand types, result type and the Python expression an engine inlines: {0}, {1} ... stand for operands,
{r} for the result, {site} for the number an engine gives the instruction to find its place in the source again.
Names that a text uses beyond Python's operators are in `arithmetic.library`. A missing row is a type error.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from plcgen.plc.types import (
    BIT_STRINGS,
    BOOL,
    BYTE,
    CHAR,
    DATE,
    DATE_AND_TIME,
    DINT,
    DWORD,
    ELEMENTARY,
    FLOATS,
    INT,
    INTEGERS,
    LREAL,
    LWORD,
    REAL,
    S5TIME,
    SINT,
    TIME,
    TIME_OF_DAY,
    TIMES,
    UDINT,
    UINT,
    USINT,
    WORD,
    Elementary,
    String,
    Type,
    elementary,
)


@dataclass(frozen=True)
class Operator:
    """One row. With `rounds` the result goes through a 32-bit float cell; where `check` holds, `repair` replaces it."""

    name: str
    operands: tuple[Type, ...]
    result: Type
    text: str
    rounds: bool = False
    check: str = ""
    repair: str = ""

    def python(self, target: str, operands: Sequence[str], site: int) -> list[str]:
        """Python lines that compute the operator into `target`; `f` is a 32-bit float array of one element."""
        expression = self.text.format(*operands, site=site)
        lines = [f"f[0] = {expression}", f"{target} = f[0]"] if self.rounds else [f"{target} = {expression}"]
        if self.check:
            repair = self.repair.format(r=target, site=site)
            lines.append(f"if {self.check.format(r=target)}: {target} = {repair}")
        return lines

    def __str__(self) -> str:
        return f"{self.name}({', '.join(map(str, self.operands))}) : {self.result}"


# ------------------------------------------------------------------------------------------------ kinds of rows

# Squares of the smallest and largest normal numbers: one comparison finds denormals, infinities and NaN alike.
_REAL_RANGE = f"{{r}} and not {2.0**-252!r} <= {{r}} * {{r}} <= {((2.0 - 2.0**-23) * 2.0**127) ** 2!r}"
_LREAL_RANGE = f"{{r}} and not {2.0**-1022!r} <= abs({{r}}) <= {1.7976931348623157e308!r}"


def _float(name: str, count: int, kind: Elementary, text: str) -> Operator:
    """A floating point result: rounded, denormals flushed, infinite and NaN reported."""
    check = _REAL_RANGE if kind is REAL else _LREAL_RANGE
    return Operator(name, (kind,) * count, kind, text, kind is REAL, check, "special({r}, {site})")


def _wrapped(name: str, operands: tuple[Type, ...], result: Elementary, text: str) -> Operator:
    """An integer result: beyond the range it is reported and keeps its low bits."""
    return Operator(name, operands, result, text, False, _outside(result), _repair("wrap", result))


def _outside(result: Elementary) -> str:
    return f"not {result.minimum} <= {{r}} <= {result.maximum}"


def _repair(helper: str, result: Elementary) -> str:
    return f"{helper}({{r}}, {result.minimum}, {result.bits}, {{site}})"


def move(kind: Type) -> Operator:
    """Copy a value of any type, whole structures too."""
    return Operator("MOVE", (kind,), kind, "{0}")


def text_copy(source: String, target: String) -> Operator:
    """Copy a STRING into one of another length."""
    return Operator("STRING_TO_STRING", (source,), target, f"resized({{0}}, {target.length}, {target.bits // 8})")


def text_comparison(symbol: str, types: Sequence[Type]) -> Operator | None:
    """Compare two STRINGs by their characters."""
    python = {"=": "==", "<>": "!=", "<": "<", "<=": "<=", ">": ">", ">=": ">="}.get(symbol)
    if python is None or not all(isinstance(kind, String) for kind in types):
        return None
    return Operator(symbol, tuple(types), BOOL, f"characters({{0}}) {python} characters({{1}})")


INDEX = Operator(
    "INDEX",
    (DINT, DINT, DINT, DINT),
    DINT,
    "({0} - {1}) * {3} if {1} <= {0} <= {2} else out_of_bounds({0}, {1}, {2}, {site})",
)
"""(index, low, high, stride): bits from the start of an array; an index outside stops the CPU."""


# ---------------------------------------------------------------------------------------------------- the rows


def _integer_rows() -> Iterator[Operator]:
    for kind in INTEGERS:
        pair = (kind, kind)
        for symbol in ("+", "-", "*"):
            yield _wrapped(symbol, pair, kind, f"{{0}} {symbol} {{1}}")
        for symbol in ("/", "DIV"):
            yield _wrapped(symbol, pair, kind, "quotient({0}, {1}, {site})")
        yield Operator("MOD", pair, kind, "remainder({0}, {1}, {site})")
        yield _wrapped("NEG", (kind,), kind, "-{0}")
        yield _wrapped("ABS", (kind,), kind, "abs({0})")


FLOAT_FUNCTIONS = ["SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "EXP", "EXPD", "LN", "LOG", "SQRT"]


def _float_rows() -> Iterator[Operator]:
    for kind in FLOATS:
        for symbol in ("+", "-", "*"):
            yield _float(symbol, 2, kind, f"{{0}} {symbol} {{1}}")
        yield _float("/", 2, kind, "{0} / {1} if {1} else over_zero({0}, {1})")
        yield _float("**", 2, kind, "power({0}, {1})")
        yield _float("SQR", 1, kind, "{0} * {0}")
        for name in FLOAT_FUNCTIONS:
            yield _float(name, 1, kind, f"{name.lower()}({{0}})")
        yield Operator("NEG", (kind,), kind, "-{0}")
        yield Operator("ABS", (kind,), kind, "abs({0})")
        for name, helper in (("ROUND", "half_even"), ("TRUNC", "trunc"), ("CEIL", "ceil"), ("FLOOR", "floor")):
            yield Operator(name, (kind,), DINT, _to_integer(helper, DINT))


def _to_integer(rounding: str, result: Elementary) -> str:
    return f"to_integer({rounding}, {{0}}, {result.minimum}, {result.bits}, {{site}})"


def _bit_rows() -> Iterator[Operator]:
    yield Operator("NOT", (BOOL,), BOOL, "not {0}")
    for kind in (BOOL, *BIT_STRINGS):
        for name, symbol in (("AND", "&"), ("OR", "|"), ("XOR", "^")):
            yield Operator(name, (kind, kind), kind, f"{{0}} {symbol} {{1}}")
    for kind in BIT_STRINGS:
        yield Operator("NOT", (kind,), kind, f"{{0}} ^ {kind.maximum}")
        yield from _shift_rows(kind.bits, kind.maximum, (kind, INT), kind)


def _shift_rows(bits: int, mask: int, operands: tuple[Type, ...], kind: Type) -> Iterator[Operator]:
    count = f"min({{1}} & 65535, {bits})"
    turn = f"({{1}} % {bits})"
    yield Operator("SHL", operands, kind, f"{{0}} << {count} & {mask}")
    yield Operator("SHR", operands, kind, f"{{0}} >> {count}")
    yield Operator("ROL", operands, kind, f"({{0}} << {turn} | {{0}} >> {bits} - {turn}) & {mask}")
    yield Operator("ROR", operands, kind, f"({{0}} >> {turn} | {{0}} << {bits} - {turn}) & {mask}")


def _comparison_rows() -> Iterator[Operator]:
    for kind in ELEMENTARY.values():
        unequal = "{0} < {1} or {0} > {1}" if kind in FLOATS else "{0} != {1}"  # NaN is not even unequal to itself
        yield Operator("=", (kind, kind), BOOL, "{0} == {1}")
        yield Operator("<>", (kind, kind), BOOL, unequal)
        for symbol in ("<", "<=", ">", ">=") if kind is not BOOL else ():
            yield Operator(symbol, (kind, kind), BOOL, f"{{0}} {symbol} {{1}}")


def _time_rows() -> Iterator[Operator]:
    for symbol in ("+", "-"):
        yield _wrapped(symbol, (TIME, TIME), TIME, f"{{0}} {symbol} {{1}}")
        yield _wrapped(symbol, (TIME_OF_DAY, TIME), TIME_OF_DAY, f"{{0}} {symbol} {{1}}")
    yield _wrapped("-", (TIME_OF_DAY, TIME_OF_DAY), TIME, "{0} - {1}")
    yield _wrapped("NEG", (TIME,), TIME, "-{0}")
    for kind in (INT, DINT):
        yield _wrapped("*", (TIME, kind), TIME, "{0} * {1}")
        for symbol in ("/", "DIV"):
            yield _wrapped(symbol, (TIME, kind), TIME, "quotient({0}, {1}, {site})")


def _choice_rows() -> Iterator[Operator]:
    for kind in (INT, DINT, *(row for row in ELEMENTARY.values() if row not in (INT, DINT))):
        yield Operator("SEL", (BOOL, kind, kind), kind, "{2} if {0} else {1}")
    for kind in (*BIT_STRINGS, CHAR, *INTEGERS, *FLOATS, *TIMES):
        yield Operator("MIN", (kind, kind), kind, "{0} if {0} <= {1} else {1}")
        yield Operator("MAX", (kind, kind), kind, "{0} if {0} >= {1} else {1}")
        yield Operator("LIMIT", (kind, kind, kind), kind, "{0} if {1} < {0} else {2} if {1} > {2} else {1}")


# --------------------------------------------------------------------------------------------------- conversions

_COUNTING = (*INTEGERS, CHAR)


def _conversion(source: Elementary, target: Elementary) -> Operator | None:
    """The row source_TO_target, if there is one."""
    for rule in (_special_conversion, _bit_conversion, _float_conversion, _integer_conversion):
        row = rule(source, target)
        if row is not None:
            return row
    return None


def _row(source: Elementary, target: Elementary, text: str, rounds: bool = False, checked: bool = False) -> Operator:
    check, repair = (_outside(target), _repair("narrow", target)) if checked else ("", "")
    return Operator(f"{source}_TO_{target}", (source,), target, text, rounds, check, repair)


_SPECIAL_TEXTS = {
    (REAL, DWORD): "real_to_bits({0})",
    (DWORD, REAL): "bits_to_real({0})",
    (LREAL, LWORD): "lreal_to_bits({0})",
    (LWORD, LREAL): "bits_to_lreal({0})",
    (TIME, DINT): "{0}",
    (DINT, TIME): "{0}",
    (S5TIME, WORD): "{0}",
    (WORD, S5TIME): "{0}",
    (S5TIME, TIME): "s5time_to_ms({0})",
    (TIME, S5TIME): "ms_to_s5time({0})",
    (DATE_AND_TIME, DATE): "dt_to_days({0})",
    (DATE_AND_TIME, TIME_OF_DAY): "dt_to_ms({0})",
}
_CHECKED_TIMES = {
    (TIME_OF_DAY, TIME),
    (TIME_OF_DAY, DINT),
    (DINT, TIME_OF_DAY),
    (DATE, INT),
    (DATE, DINT),
    (INT, DATE),
    (DINT, DATE),
}


def _special_conversion(source: Elementary, target: Elementary) -> Operator | None:
    if (source, target) in _CHECKED_TIMES:
        return _row(source, target, "{0}", checked=True)
    text = _SPECIAL_TEXTS.get((source, target))
    return _row(source, target, text) if text else None


def _bit_conversion(source: Elementary, target: Elementary) -> Operator | None:
    """To or from BOOL, BYTE, WORD, DWORD, LWORD: bits move, missing ones are zero, a sign goes on to the left."""
    bitwise = (BOOL, *BIT_STRINGS)
    if not (source in bitwise or target in bitwise) or not {source, target} <= {*bitwise, *_COUNTING}:
        return None
    if source is BOOL:
        return _row(source, target, "int({0})")
    if target is BOOL:
        return _row(source, target, "{0} & 1 == 1")
    if target.minimum < 0 and source.bits >= target.bits:
        half = -target.minimum
        return _row(source, target, f"({{0}} & {2 * half - 1} ^ {half}) - {half}")
    return _row(source, target, f"{{0}} & {(1 << target.bits) - 1}")


def _float_conversion(source: Elementary, target: Elementary) -> Operator | None:
    if source in INTEGERS and target in FLOATS:
        return _row(source, target, "{0} + 0.0", rounds=target is REAL and source.bits > 16)
    if source in FLOATS and target in INTEGERS:
        return _row(source, target, _to_integer("half_even", target))
    if (source, target) == (REAL, LREAL):
        return _row(source, target, "{0}")
    if (source, target) == (LREAL, REAL):
        return Operator("LREAL_TO_REAL", (LREAL,), REAL, "{0}", True, _REAL_RANGE, "special({r}, {site})")
    return None


def _integer_conversion(source: Elementary, target: Elementary) -> Operator | None:
    if source not in _COUNTING or target not in _COUNTING:
        return None
    fits = target.minimum <= source.minimum and source.maximum <= target.maximum
    return _row(source, target, "{0}", checked=not fits)


def _conversion_rows() -> Iterator[Operator]:
    pairs = ((source, target) for source in ELEMENTARY.values() for target in ELEMENTARY.values())
    rows = (_conversion(source, target) for source, target in pairs if source is not target)
    return (row for row in rows if row is not None)


# ----------------------------------------------------------------------------------------------------- the table

_SOURCES: tuple[Callable[[], Iterator[Operator]], ...] = (
    _integer_rows,
    _float_rows,
    _bit_rows,
    _comparison_rows,
    _time_rows,
    _choice_rows,
    _conversion_rows,
)


@lru_cache(maxsize=1)
def _table() -> dict[str, tuple[Operator, ...]]:
    rows: defaultdict[str, list[Operator]] = defaultdict(list)
    for source in _SOURCES:
        for row in source():
            rows[row.name].append(row)
    return {name: tuple(alternatives) for name, alternatives in rows.items()}


def alternatives(symbol: str) -> tuple[Operator, ...]:
    """All rows of a symbol, narrow types before wide ones; empty when there are none."""
    return _table().get(symbol, ())


def resolve(symbol: str, types: Sequence[Type]) -> Operator | None:
    """The row of a symbol for exactly these operand types."""
    wanted = tuple(types)
    return next((row for row in alternatives(symbol) if row.operands == wanted), None)


def conversion(source: Type, target: Type) -> Operator | None:
    """The row that converts, explicit ones too."""
    return resolve(f"{source}_TO_{target}", (source,))


def conversion_named(name: str) -> Operator | None:
    """The row of a conversion function such as `DINT_TO_REAL` or `TIME_TO_DINT`, aliases of types allowed."""
    names = name.upper().partition("_TO_")
    source, target = elementary(names[0]), elementary(names[2])
    return conversion(source, target) if source and target else None


IMPLICIT = frozenset(
    {(INT, DINT), (INT, REAL), (BYTE, WORD), (BYTE, DWORD), (WORD, DWORD)}
    | {(SINT, wide) for wide in (INT, DINT, REAL, LREAL)}
    | {(USINT, wide) for wide in (INT, UINT, DINT, UDINT, REAL, LREAL)}
    | {(UINT, wide) for wide in (DINT, UDINT, REAL, LREAL)}
    | {(INT, LREAL), (DINT, LREAL), (UDINT, LREAL), (REAL, LREAL)}
)
"""Pairs converted without being asked, safe on S7-300, S7-1200 and S7-1500 alike. DINT to REAL is not one of them."""
