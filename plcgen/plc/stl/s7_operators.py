"""Operators of S7-300 STL on top of the common table: views of an accumulator, condition codes, shifts, BCD.

The condition codes are one number, 2 * CC1 + CC0: 0 is zero, 1 negative, 2 positive, 3 unordered or by zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from plcgen.plc.operators import Operator, resolve
from plcgen.plc.simplify import Inverses
from plcgen.plc.types import (
    BOOL,
    BYTE,
    CHAR,
    DATE,
    DINT,
    DWORD,
    INT,
    REAL,
    S5TIME,
    TIME,
    TIME_OF_DAY,
    WORD,
    Elementary,
)

ZERO, NEGATIVE, POSITIVE, UNORDERED = 0, 1, 2, 3

# ---------------------------------------------------------------------------------------- views of an accumulator

LOADABLE = (BYTE, CHAR, WORD, INT, DATE, S5TIME, DWORD, DINT, REAL, TIME, TIME_OF_DAY)
"""Types of what L loads and T writes."""


def _signed(text: str, bits: int) -> str:
    half = 1 << bits - 1
    return f"({text} & {2 * half - 1} ^ {half}) - {half}"


def _masked(text: str, bits: int) -> str:
    return f"{text} & {(1 << bits) - 1}"


def _view(kind: Elementary) -> Operator:
    if kind is REAL:
        return Operator("VIEW", (DWORD,), REAL, "bits_to_real({0})")
    text = _signed("{0}", kind.bits) if kind.minimum < 0 else _masked("{0}", kind.bits)
    return Operator("VIEW", (DWORD,), kind, text)


def _bits(kind: Elementary) -> Operator:
    text = "real_to_bits({0})" if kind is REAL else _masked("{0}", kind.bits)
    return Operator("BITS", (kind,), DWORD, text)


VIEWS: Mapping[Elementary, Operator] = {kind: _view(kind) for kind in LOADABLE}
"""The low end of 32 bits as a type."""
BITS: Mapping[Elementary, Operator] = {kind: _bits(kind) for kind in LOADABLE}
"""A value as 32 bits; what is narrower comes with zeros before it."""
LOW_WORDS: Mapping[Elementary, Operator] = {
    kind: Operator("LOW_WORD", (DWORD, kind), DWORD, "{0} & 4294901760 | {1} & 65535") for kind in (INT, WORD)
}
"""32 bits with another low word."""
LOW_BYTE = Operator("LOW_BYTE", (DWORD, BYTE), DWORD, "{0} & 4294967040 | {1}")

INVERSES: Inverses = {
    **{(VIEWS[kind], BITS[kind]): 0 for kind in LOADABLE},
    **{(BITS[kind], VIEWS[kind]): 0 for kind in LOADABLE if kind.bits == DWORD.bits},
    **{(VIEWS[kind], LOW_WORDS[kind]): 1 for kind in LOW_WORDS},
    (VIEWS[BYTE], LOW_BYTE): 1,
}


def row(symbol: str, *kinds: Elementary) -> Operator:
    """The row of the common table."""
    found = resolve(symbol, kinds)
    assert found is not None, (symbol, kinds)
    return found


# ------------------------------------------------------------------------------------------------ condition codes

SIGN: Mapping[Elementary, Operator] = {
    **{kind: Operator("SIGN", (kind,), BYTE, "2 if {0} > 0 else 1 if {0} < 0 else 0") for kind in (INT, DINT)},
    REAL: Operator("SIGN", (REAL,), BYTE, "2 if {0} > 0.0 else 1 if {0} < 0.0 else 0 if {0} == 0.0 else 3"),
}
"""(result) : condition codes"""
ORDER: Mapping[Elementary, Operator] = {
    **{
        kind: Operator("ORDER", (kind, kind), BYTE, "2 if {0} > {1} else 1 if {0} < {1} else 0") for kind in (INT, DINT)
    },
    REAL: Operator("ORDER", (REAL, REAL), BYTE, "2 if {0} > {1} else 1 if {0} < {1} else 0 if {0} == {1} else 3"),
}
"""(ACCU2, ACCU1) : condition codes of a comparison"""
IS_UNORDERED = Operator("IS_UNORDERED", (REAL, REAL), BOOL, "{0} != {0} or {1} != {1}")
NOT_ZERO: Mapping[Elementary, Operator] = {
    kind: Operator("NOT_ZERO", (kind,), BYTE, "2 if {0} else 0") for kind in (WORD, DWORD)
}
"""(result of word logic) : condition codes"""
CODES: Mapping[str, tuple[int, ...]] = {
    "==0": (ZERO,),
    "<>0": (NEGATIVE, POSITIVE),
    ">0": (POSITIVE,),
    "<0": (NEGATIVE,),
    ">=0": (ZERO, POSITIVE),
    "<=0": (ZERO, NEGATIVE),
    "UO": (UNORDERED,),
}
"""Which condition codes fulfil a condition."""
CONDITIONS: Mapping[str, Operator] = {
    name: Operator("IS_" + name, (BYTE,), BOOL, " or ".join(f"{{0}} == {code}" for code in codes))
    for name, codes in CODES.items()
}

# ------------------------------------------------------------------------------------------------------ arithmetic

# What a REAL result is computed from; a result of 0.0 from another number is an underflow.
_EXACT = {"+": "{0} + {1}", "-": "{0} - {1}", "*": "{0} * {1}", "/": "{0}", "SQR": "{0}", "EXP": "1.0"}


@cache
def real_overflow(symbol: str) -> Operator:
    """(operands, result) : OV"""
    operands = (REAL,) * len(row_of_real(symbol).operands)
    result = f"{{{len(operands)}}}"
    underflow = f" or {result} == 0.0 != {_EXACT[symbol]}" if symbol in _EXACT else ""
    return Operator("OV", (*operands, REAL), BOOL, f"{result} - {result} != 0.0{underflow}")


def row_of_real(symbol: str) -> Operator:
    """The row of an operator or function on REAL."""
    return resolve(symbol, (REAL, REAL)) or row(symbol, REAL)


@cache
def whole_overflow(symbol: str, kind: Elementary) -> Operator:
    """(ACCU2, ACCU1) : OV"""
    return Operator("OV", (kind, kind), BOOL, f"not {kind.minimum} <= {{0}} {symbol} {{1}} <= {kind.maximum}")


@cache
def negation_overflow(kind: Elementary) -> Operator:
    """(ACCU1) : OV"""
    return Operator("OV", (kind,), BOOL, f"{{0}} == {kind.minimum}")


PRODUCT = Operator("*", (INT, INT), DINT, "{0} * {1}")
"""*I: the product fills the accumulator."""
PRODUCT_SIGN: Mapping[Elementary, Operator] = {
    kind: Operator("SIGN", (kind, kind), BYTE, "0 if not {0} or not {1} else 2 if ({0} < 0) == ({1} < 0) else 1")
    for kind in (INT, DINT)
}
QUOTIENT_AND_REST = Operator(
    "/I",
    (INT, INT, DWORD),
    DWORD,
    "(remainder({0}, {1}, {site}) & 65535) << 16 | quotient({0}, {1}, {site}) & 65535 if {1}"
    " else noted({2}, 'division by zero', {site})",
)
"""(ACCU2-L, ACCU1-L, ACCU1) : ACCU1. The rest is the high word; a division by zero leaves the accumulator alone."""
QUOTIENT_SIGN: Mapping[Elementary, Operator] = {
    kind: Operator(
        "SIGN",
        (kind, kind),
        BYTE,
        "3 if not {1} else 0 if abs({0}) < abs({1}) else 2 if ({0} < 0) == ({1} < 0) else 1",
    )
    for kind in (INT, DINT)
}
QUOTIENT_OVERFLOW: Mapping[Elementary, Operator] = {
    kind: Operator("OV", (kind, kind), BOOL, f"{{1}} == 0 or {{0}} == {kind.minimum} and {{1}} == -1")
    for kind in (INT, DINT)
}
REST_SIGN = Operator("SIGN", (DINT, DINT, DINT), BYTE, "3 if not {1} else 2 if {2} > 0 else 1 if {2} < 0 else 0")
"""(ACCU2, ACCU1, rest) : condition codes of MOD"""
BY_ZERO = Operator("OV", (DINT,), BOOL, "{0} == 0")
QUIET_SUM: Mapping[Elementary, Operator] = {
    kind: Operator("QUIET_SUM", (kind, kind), kind, _signed("({0} + {1})", kind.bits)) for kind in (INT, DINT)
}
"""+ constant, LOOP: wraps, and no status bit tells."""
QUIET_BYTES: Mapping[str, Operator] = {
    symbol: Operator(symbol, (BYTE, BYTE), BYTE, f"{{0}} {symbol} {{1}} & 255") for symbol in ("+", "-")
}
"""INC and DEC."""
OUTSIDE_DINT = Operator("OV", (REAL,), BOOL, "not -2147483648.0 <= {0} < 2147483648.0")

# ---------------------------------------------------------------------------------------------------------- shifts

SHIFTS: Mapping[str, Operator] = {
    "SLW": Operator("SLW", (WORD, BYTE), WORD, "{0} << {1} & 65535"),
    "SRW": Operator("SRW", (WORD, BYTE), WORD, "{0} >> {1}"),
    "SLD": Operator("SLD", (DWORD, BYTE), DWORD, "{0} << {1} & 4294967295"),
    "SRD": Operator("SRD", (DWORD, BYTE), DWORD, "{0} >> {1}"),
    "SSI": Operator("SSI", (INT, BYTE), INT, "{0} >> {1}"),
    "SSD": Operator("SSD", (DINT, BYTE), DINT, "{0} >> {1}"),
    "RLD": Operator("RLD", (DWORD, BYTE), DWORD, "({0} << {1} % 32 | {0} >> 32 - {1} % 32) & 4294967295"),
    "RRD": Operator("RRD", (DWORD, BYTE), DWORD, "({0} >> {1} % 32 | {0} << 32 - {1} % 32) & 4294967295"),
}
"""(value, count) : value"""
_LAST_BITS = {
    "SLW": "{0} << {1} >> 16",
    "SLD": "{0} << {1} >> 32",
    "RLD": "{0} >> (32 - {1}) % 32",
    "RRD": "{0} >> ({1} - 1) % 32",
}
SHIFTED_OUT: Mapping[str, Operator] = {
    name: Operator(
        "SHIFTED_OUT",
        (*shift.operands, BYTE),
        BYTE,
        f"({_LAST_BITS.get(name, '{0} >> {1} - 1')} & 1) << 1 if {{1}} else {{2}}",
    )
    for name, shift in SHIFTS.items()
}
"""(value, count, condition codes) : condition codes; the bit that left last is CC1. A count of 0 changes nothing."""
KEEPS = Operator("KEEPS", (BYTE, BOOL), BOOL, "{1} if {0} == 0 else False")
"""(count, OV) : OV"""
ROTATE_LEFT = Operator("RLDA", (DWORD, BYTE), DWORD, "({0} << 1 | {1} >> 1) & 4294967295")
ROTATE_RIGHT = Operator("RRDA", (DWORD, BYTE), DWORD, "{0} >> 1 | {1} >> 1 << 31")
"""(value, condition codes) : value. CC1 comes in."""
HIGHEST = Operator("HIGHEST", (DWORD,), BYTE, "{0} >> 31 << 1")
LOWEST = Operator("LOWEST", (DWORD,), BYTE, "({0} & 1) << 1")
"""(value) : condition codes, whose CC1 is the bit that goes out."""
SWAP_WORD = Operator("CAW", (WORD,), WORD, "{0} >> 8 | ({0} & 255) << 8")
SWAP_DOUBLE = Operator("CAD", (DWORD,), DWORD, "{0} >> 24 | {0} >> 8 & 65280 | ({0} & 65280) << 8 | ({0} & 255) << 24")

# ------------------------------------------------------------------------------------------------------------- BCD

_NO_BCD = 1 << 40


def _from_bcd(name: str, kind: Elementary, digits: int) -> Operator:
    """A digit above 9 stops the CPU."""
    part, sign = f"hex({{0}} & {16**digits - 1})[2:]", kind.bits - 1
    text = f"(-1 if {{0}} >> {sign} & 1 else 1) * int({part}) if {part}.isdecimal() else {_NO_BCD}"
    stop = "stop('%s: a digit of the number is above 9; real CPUs call OB121 or stop' % '" + name + "', {site})"
    return Operator(name, (DWORD,), kind, text, False, f"{{r}} == {_NO_BCD}", stop)


def _to_bcd(name: str, kind: Elementary, digits: int) -> Operator:
    """A number of more digits stays as it is."""
    sign = 15 << kind.bits - 4
    text = f"(int(str(abs({{0}})), 16) | ({sign} if {{0}} < 0 else 0)) if abs({{0}}) < {10**digits} else {{0}} & "
    return Operator(name, (kind,), WORD if kind is INT else DWORD, text + str((1 << kind.bits) - 1))


BCD: Mapping[str, Operator] = {
    "BTI": _from_bcd("BTI", INT, 3),
    "BTD": _from_bcd("BTD", DINT, 7),
    "ITB": _to_bcd("ITB", INT, 3),
    "DTB": _to_bcd("DTB", DINT, 7),
}
NO_BCD: Mapping[Elementary, Operator] = {
    INT: Operator("OV", (INT,), BOOL, "abs({0}) > 999"),
    DINT: Operator("OV", (DINT,), BOOL, "abs({0}) > 9999999"),
}

# -------------------------------------------------------------------------------------------------------- pointers

MOVE_POINTER = Operator("+AR", (DWORD, DINT), DWORD, "{0} & 4278190080 | {0} + {1} & 16777215")
"""Area stays, bits go on."""


@cache
def pointed(room: int, bits: int, offset: int, what: str) -> Operator:
    """(pointer) : bits from the start of an area of `room` bits to what lies there; outside it stops the CPU."""
    aligned = "" if bits == 1 else " or {r} & 7"
    stop = f"stop('pointer P#%d.%d: {what} there' % ({{r}} >> 3, {{r}} & 7), {{site}})"
    text = f"({{0}} & 16777215) + {offset}"
    return Operator("POINTED", (DWORD,), DINT, text, False, f"{{r}} > {room - bits}{aligned}", stop)


# ----------------------------------------------------------------------------------------------------- status word

STATUS_WORD = Operator(
    "STW", (BOOL, BOOL, BOOL, BYTE, BOOL), WORD, "{0} << 1 | {1} << 4 | {2} << 5 | {3} << 6 | {4} << 8"
)
"""(RLO, OS, OV, condition codes, BR) : status word. An S7-300 loads /FC, STA and OR as 0."""
STATUS_BITS: Mapping[str, Operator] = {
    name: Operator(name, (WORD,), BOOL, f"{{0}} >> {place} & 1 == 1")
    for name, place in {"FC": 0, "RLO": 1, "OR": 3, "OS": 4, "OV": 5, "BR": 8}.items()
}
STATUS_CODES = Operator("CC", (WORD,), BYTE, "{0} >> 6 & 3")
