"""Operators of the S7-200 SMART on top of the common table: results that may fail, SM1, pointers, system services.

Arithmetic runs in three steps. The result is computed in a type that holds it even if it does not fit; SM1 notes what
it is; then it replaces the output, or, where a CPU leaves the operands unchanged, does not.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from plcgen.plc.operators import Operator, resolve
from plcgen.plc.stl.smart_memory import AREAS, POINTER_TO_V, STARTS, V
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DINT, DWORD, INT, LINT, REAL, WORD, Elementary

ZERO, ILLEGAL, NEGATIVE, DIVIDED_BY_ZERO = 1, 2, 4, 8
"""Bits of SM1."""
KEPT_BY_ALL = 255 - (ZERO | ILLEGAL | NEGATIVE)


# ------------------------------------------------------------------------------------------------------ arithmetic


@cache
def arithmetic(symbol: str, kind: Elementary, result: Elementary | None = None) -> Operator:
    """The first step: exact for integers, rounded to 32 bits for REAL. A result that does not fit is an event."""
    if kind is REAL:
        row = resolve(symbol, (REAL,) * (1 if symbol.isalpha() else 2))
        assert row is not None
        return row
    text = "quotient({0}, {1}, {site})" if symbol == "/" else f"{{0}} {symbol} {{1}}"
    return _reporting(symbol, (kind, kind), result or kind, text)


def _reporting(name: str, operands: tuple[Elementary, ...], result: Elementary, text: str) -> Operator:
    outside = f"not {result.minimum} <= {{r}} <= {result.maximum}"
    return Operator(name, operands, LINT, text, False, outside, "noted({r}, 'overflow', {site})")


def _sound(value: str, result: Elementary) -> str:
    """Python: whether a result fits."""
    return f"{value} - {value} == 0.0" if result is REAL else f"{result.minimum} <= {value} <= {result.maximum}"


@cache
def status(result: Elementary, divides: bool = False) -> Operator:
    """The second step, (SM1, result[, divisor]) : SM1. A division by zero touches no other bit."""
    value = REAL if result is REAL else LINT
    bits = f"({ILLEGAL} if not {_sound('{1}', result)} else {ZERO} if {{1}} == 0 else {NEGATIVE} if {{1}} < 0 else 0)"
    if not divides:
        return Operator("STATUS", (BYTE, value), BYTE, f"{{0}} & {KEPT_BY_ALL} | {bits}")
    keep = KEPT_BY_ALL - DIVIDED_BY_ZERO
    text = f"{{0}} & {keep} | {bits} if {{2}} else {{0}} | {DIVIDED_BY_ZERO}"
    return Operator("STATUS", (BYTE, value, result), BYTE, text)


@cache
def illegal(result: Elementary) -> Operator:
    """The second step of a conversion, (SM1, result) : SM1. It touches SM1.1 alone."""
    sound = _sound("{1}", result)
    return Operator("ILLEGAL", (BYTE, LINT), BYTE, f"{{0}} & {255 - ILLEGAL} | (0 if {sound} else {ILLEGAL})")


@cache
def outcome(result: Elementary, divides: bool = False) -> Operator:
    """The third step, (old output, result[, divisor]) : new output."""
    value = REAL if result is REAL else LINT
    sound = _sound("{1}", result)
    if divides:
        return Operator("OUTCOME", (result, value, result), result, f"{{1}} if {{2}} and {sound} else {{0}}")
    return Operator("OUTCOME", (result, value), result, f"{{1}} if {sound} else {{0}}")


ZERO_STATUS: Mapping[Elementary, Operator] = {
    kind: Operator("ZERO_STATUS", (BYTE, kind), BYTE, f"{{0}} & {255 - ZERO} | ({ZERO} if {{1}} == 0 else 0)")
    for kind in (BYTE, WORD, DWORD)
}
"""Logic and shifts: SM1.0 alone. (SM1, result) : SM1"""


# ----------------------------------------------------------------------------------------------------- conversions

_BEYOND = 1 << 31
"""What stands for a number that no DINT holds."""

HALF_AWAY = "int({0} + (0.5 if {0} > 0.0 else -0.5))"
"""ROUND: halves go away from zero. The manual names no rule; to change it, change this text alone."""


def _to_dint(name: str, text: str) -> Operator:
    inside = f"{text} if -2147483649.0 < {{0}} < 2147483648.0 else {_BEYOND}"
    return _reporting(name, (REAL,), DINT, inside)


ROUND = _to_dint("ROUND", HALF_AWAY)
TRUNC = _to_dint("TRUNC", "trunc({0})")


@cache
def widened(source: Elementary, result: Elementary) -> Operator:
    """An integer conversion whose result may not fit."""
    return _reporting(f"{source}_TO_{result}", (source,), result, "{0}")


# ------------------------------------------------------------------------------------------------- pointers, system


_NO_TARGET = (
    "stop('pointer 16#%08X points nowhere; set it with MOVD &VB..., AC1 and keep it in its area' % ~{r}, {site})"
)


@cache
def pointed(size: int) -> Operator:
    """(pointer) : bits from the start of memory to `size` bytes there; a pointer to nowhere stops the CPU.

    V memory, where nearly all pointers point, is found without a call.
    """
    offset = "({0} & 16777215)"
    inside = f"{{0}} >> 24 == {POINTER_TO_V} and {offset} <= {AREAS[V] - size}"
    place = f"({offset} << 3) + {STARTS[V] * BYTE_BITS} if {inside} else -1 - {{0}}"
    nowhere = (
        "stop('pointer 16#%08X points nowhere; set it with MOVD &VB..., AC1 and keep it in its area' % ~{r}, {site})"
    )
    elsewhere = f"(place if (place := pointed(~{{r}}, {size})) >= 0 else {nowhere})"
    return Operator("POINTED", (DWORD,), DINT, place, False, "{r} < 0", elsewhere)


def service(name: str, *operands: Elementary) -> Operator:
    """Something the CPU does besides computing; see `cpu.smart`. It returns why the CPU must stop, or nothing."""
    arguments = ", ".join(f"{{{position}}}" for position in range(len(operands)))
    return Operator(name.upper(), operands, BOOL, f"service_{name}({arguments})", False, "{r}", "stop({r}, {site})")


PLS = service("pls", INT)
ATCH = service("atch", INT, INT)
DTCH = service("dtch", INT)
CEVNT = service("cevnt", INT)
ENI, DISI, STOP, WDR = service("eni"), service("disi"), service("stop"), service("wdr")
CLOCK = Operator("CLOCK", (), DINT, "service_clock()")
"""Milliseconds since the CPU went to RUN."""
