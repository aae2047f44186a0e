"""Boxes of the S7-200 SMART that compute: moves, arithmetic, conversions, logic, shifts."""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.core import Cell, Literal, Operand
from plcgen.plc.operators import Operator, move, resolve
from plcgen.plc.stl.smart_operators import CLOCK, ZERO_STATUS, arithmetic, illegal, outcome, status, widened
from plcgen.plc.stl.smart_rung import SM1, Rung
from plcgen.plc.stl.smart_slots import Row, box, reads, writes
from plcgen.plc.types import BOOL, BYTE, DINT, INT, LINT, REAL, WORD, Elementary

OVERFLOW, DIVISION_BY_ZERO = Cell(SM1.area, SM1.bit + 1, BOOL), Cell(SM1.area, SM1.bit + 3, BOOL)


def settle(rung: Rung, target: Cell, result: Operand, divisor: Operand | None = None) -> None:
    """SM1 and the output, after the result is known."""
    assert isinstance(target.type, Elementary)
    kind, divides = target.type, divisor is not None
    extra = () if divisor is None else (divisor,)
    rung.assign(SM1, status(kind, divides), SM1, result, *extra)
    rung.assign(target, outcome(kind, divides), target, result, *extra)
    rung.failures = (OVERFLOW, DIVISION_BY_ZERO) if divides else (OVERFLOW,)


def convert(rung: Rung, target: Cell, result: Operand) -> None:
    """The same for a conversion, which tells no more than whether the result fits."""
    assert isinstance(target.type, Elementary)
    rung.assign(SM1, illegal(target.type), SM1, result)
    rung.assign(target, outcome(target.type), target, result)
    rung.failures = (OVERFLOW,)


# ---------------------------------------------------------------------------------------------------------- moves


def moved(kind: Elementary) -> Row:
    """IN, OUT"""
    return box(lambda rung, source, target: rung.assign(target, move(kind), source), reads(kind), writes(kind))


def swap() -> Row:
    """IN: the bytes of a word change places."""
    swapped = Operator("SWAP", (WORD,), WORD, "({0} & 255) << 8 | {0} >> 8")
    return box(lambda rung, place: rung.assign(place, swapped, place), writes(WORD))


# ----------------------------------------------------------------------------------------------------- arithmetic


def two_operands(symbol: str, kind: Elementary) -> Row:
    """IN, OUT: OUT := OUT symbol IN"""

    def emit(rung: Rung, source: Operand, target: Cell) -> None:
        result = rung.result(arithmetic(symbol, kind), target, source)
        settle(rung, target, result, source if symbol == "/" else None)

    return box(emit, reads(kind), writes(kind))


def function(name: str) -> Row:
    """IN, OUT: OUT := name(IN), REAL"""

    def emit(rung: Rung, source: Operand, target: Cell) -> None:
        settle(rung, target, rung.result(arithmetic(name, REAL), source))

    return box(emit, reads(REAL), writes(REAL))


def stepped(symbol: str, kind: Elementary) -> Row:
    """IN: one more or less"""

    def emit(rung: Rung, target: Cell) -> None:
        settle(rung, target, rung.result(arithmetic(symbol, kind), target, Literal(1, kind)))

    return box(emit, writes(kind))


def multiply_wide(rung: Rung, source: Operand, target: Cell) -> None:
    """MUL IN, OUT: the low word of OUT times IN fills OUT."""
    settle(rung, target, rung.result(arithmetic("*", INT, DINT), _low_word(target), source))


_QUOTIENT, _REMAINDER = "quotient({0}, {1}, {site})", "remainder({0}, {1}, {site})"
_DIVIDED = Operator("DIV", (INT, INT), LINT, f"{_REMAINDER} << 16 | {_QUOTIENT} & 65535 if {{1}} else 0")


def divide_wide(rung: Rung, source: Operand, target: Cell) -> None:
    """DIV IN, OUT: the low word of OUT by IN; quotient into the low, remainder into the high word of OUT."""
    result = rung.result(arithmetic("/", INT), _low_word(target), source)
    both = rung.result(_DIVIDED, _low_word(target), source)
    rung.assign(SM1, status(INT, True), SM1, result, source)
    rung.assign(target, _if_divided(), target, both, result, source)


def _if_divided() -> Operator:
    kinds = (DINT, LINT, LINT, INT)
    return Operator("OUTCOME", kinds, DINT, f"{{1}} if {{3}} and {INT.minimum} <= {{2}} <= {INT.maximum} else {{0}}")


def _low_word(target: Cell) -> Cell:
    return Cell(target.area, target.bit + 16, INT, target.index)


# ---------------------------------------------------------------------------------------------------- conversions


def converted(source: Elementary, target: Elementary) -> Row:
    """IN, OUT between integers; what does not fit sets SM1.1 and changes nothing."""

    def emit(rung: Rung, taken: Operand, given: Cell) -> None:
        convert(rung, given, rung.result(widened(source, target), taken))

    return box(emit, reads(source), writes(target))


def extended(source: Elementary, target: Elementary) -> Row:
    """IN, OUT where everything fits: BTI, ITD, DTR."""
    row = resolve(f"{source}_TO_{target}", (source,))
    assert row is not None
    return box(lambda rung, taken, given: rung.assign(given, row, taken), reads(source), writes(target))


def rounded(operator: Operator) -> Row:
    """ROUND and TRUNC: IN REAL, OUT DINT"""

    def emit(rung: Rung, taken: Operand, given: Cell) -> None:
        convert(rung, given, rung.result(operator, taken))

    return box(emit, reads(REAL), writes(DINT))


# -------------------------------------------------------------------------------------------------- codes, BCD


def coded(name: str, source: Elementary, target: Elementary, text: str) -> Row:
    """IN, OUT by a Python text, whatever the value."""
    operator = Operator(name, (source,), target, text)
    return box(lambda rung, taken, given: rung.assign(given, operator, taken), reads(source), writes(target))


SEGMENTS = bytes.fromhex("3F065B4F666D7D077F67777C395E7971")
"""What a seven-segment display lights for 0 to F."""
DECODE = "1 << ({0} & 15)"
ENCODE = "({0} & -{0} | ({0} == 0)).bit_length() - 1"
SEVEN_SEGMENTS = f"{tuple(SEGMENTS)}[{{0}} & 15]"

NO_BCD = Cell(SM1.area, SM1.bit + 6, BOOL)
_TO_BCD = Operator("TO_BCD", (WORD,), WORD, "int(str({0}), 16) if {0} <= 9999 else {0}")
_FROM_BCD = Operator("FROM_BCD", (WORD,), WORD, "int('%X' % {0}) if ('%X' % {0}).isdecimal() else {0}")
_ABOVE_BCD = Operator("ABOVE_BCD", (WORD,), BOOL, "{0} > 9999")
_NOT_DECIMAL = Operator("NOT_DECIMAL", (WORD,), BOOL, "not ('%X' % {0}).isdecimal()")


def binary_coded(to_bcd: bool) -> Row:
    """OUT: IBCD and BCDI; what has no such code sets SM1.6 and stays."""

    def emit(rung: Rung, place: Cell) -> None:
        rung.assign(NO_BCD, _ABOVE_BCD if to_bcd else _NOT_DECIMAL, place)
        rung.assign(place, _TO_BCD if to_bcd else _FROM_BCD, place)

    return box(emit, writes(WORD))


def milliseconds(rung: Rung, target: Cell) -> None:
    """BITIM OUT: the clock"""
    rung.assign(target, CLOCK)


def milliseconds_since(rung: Rung, start: Operand, target: Cell) -> None:
    """CITIM IN, OUT: what the clock went on since IN"""
    builder = rung.builder
    builder.move(target, rung.compute("-", rung.result(CLOCK), start))


# ---------------------------------------------------------------------------------------------- logic and shifts


def bitwise(symbol: str, kind: Elementary) -> Row:
    """IN, OUT: OUT := OUT symbol IN, bit by bit"""
    row = resolve(symbol, (kind, kind))
    assert row is not None

    def emit(rung: Rung, source: Operand, target: Cell) -> None:
        rung.assign(target, row, target, source)
        rung.assign(SM1, ZERO_STATUS[kind], SM1, target)

    return box(emit, reads(kind), writes(kind))


def inverted(kind: Elementary) -> Row:
    """OUT: every bit changes"""
    row = resolve("NOT", (kind,))
    assert row is not None

    def emit(rung: Rung, target: Cell) -> None:
        rung.assign(target, row, target)
        rung.assign(SM1, ZERO_STATUS[kind], SM1, target)

    return box(emit, writes(kind))


def shifted(symbol: str, kind: Elementary) -> Row:
    """OUT, N: shift or rotate N bits; SM1.1 is the last bit that went out. N = 0 changes nothing."""
    row = resolve(symbol, (kind, INT))
    assert row is not None
    last = _last_bit(symbol, kind)

    def emit(rung: Rung, target: Cell, count: Operand) -> None:
        number = rung.compute("BYTE_TO_INT", count)
        rung.assign(OVERFLOW, last, target, number, OVERFLOW)
        rung.assign(target, row, target, number)
        rung.assign(SM1, ZERO_STATUS[kind], SM1, target)

    return box(emit, writes(kind), reads(BYTE))


_LAST_BITS: dict[str, Callable[[int], str]] = {
    "SHR": lambda bits: f"min({{1}}, {bits}) - 1",
    "SHL": lambda bits: f"{bits} - min({{1}}, {bits})",
    "ROR": lambda bits: f"({{1}} - 1) % {bits}",
    "ROL": lambda bits: f"-{{1}} % {bits}",
}
"""Which bit leaves last."""


def _last_bit(symbol: str, kind: Elementary) -> Operator:
    turns = f"{{1}} % {kind.bits}" if symbol.startswith("RO") else "{1}"
    text = f"({{0}} >> {_LAST_BITS[symbol](kind.bits)} & 1 == 1) if {turns} else {{2}}"
    return Operator("LAST_BIT", (kind, INT, BOOL), BOOL, text)
