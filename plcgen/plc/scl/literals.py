"""Literals: from their spelling to a value, with the ranges of their types."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import date, datetime, timedelta
from fractions import Fraction

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.dialects import Dialect
from plcgen.plc.scl.syntax import Literal

Value = int | float | bool | str


class LiteralError(ValueError):
    """What is wrong with the spelling of a literal; the parser adds the place."""


# From the second number on, rounding gives infinity; below the first a value is denormal and no legal literal.
REAL_RANGES = {
    "REAL": (1.175494e-38, 3.4028235677973362e38, "1.175495E-38 to 3.402823E+38"),
    "LREAL": (2.2250738585072014e-308, float("inf"), "2.2250738585072014E-308 to 1.7976931348623157E+308"),
}

INTEGER_RANGES = {
    "BOOL": (0, 1),
    "SINT": (-(2**7), 2**7 - 1),
    "INT": (-(2**15), 2**15 - 1),
    "DINT": (-(2**31), 2**31 - 1),
    "LINT": (-(2**63), 2**63 - 1),
    "USINT": (0, 2**8 - 1),
    "UINT": (0, 2**16 - 1),
    "UDINT": (0, 2**32 - 1),
    "ULINT": (0, 2**64 - 1),
    "BYTE": (0, 2**8 - 1),
    "WORD": (0, 2**16 - 1),
    "DWORD": (0, 2**32 - 1),
    "LWORD": (0, 2**64 - 1),
}
PREFIXES = {
    **{name: name for name in (*INTEGER_RANGES, "REAL", "LREAL", "TIME", "S5TIME", "DATE", "CHAR", "STRING")},
    "TIME_OF_DAY": "TIME_OF_DAY",
    "DATE_AND_TIME": "DATE_AND_TIME",
    "B": "BYTE",
    "W": "WORD",
    "DW": "DWORD",
    "LW": "LWORD",
    "L": "DINT",
    "T": "TIME",
    "S5T": "S5TIME",
    "D": "DATE",
    "TOD": "TIME_OF_DAY",
    "DT": "DATE_AND_TIME",
}


def read_literal(token: Token, dialect: Dialect, negative: bool = False) -> Literal:
    """The literal a NUMBER, TYPED or STRING token spells; `negative` when a minus stands before a number."""
    if token.kind is TokenKind.STRING:
        return Literal(token.span, _characters(token.text))
    if token.kind is TokenKind.TYPED:
        return _typed(token, dialect)
    value = _number(token.text, dialect) * (-1 if negative else 1)
    based = "#" in token.text
    if isinstance(value, int):
        lowest, highest = (0, 2**dialect.bits - 1) if based else dialect.integers
        _check_range(("-" if negative else "") + token.text, value, lowest, highest)
    return Literal(token.span, value, None, based)


def _typed(token: Token, dialect: Dialect) -> Literal:
    prefix, body = token.text.split("#", 1)
    type_name = PREFIXES.get(prefix.upper())
    if type_name is None or type_name not in dialect.types:
        raise LiteralError(_unknown_prefix(prefix, dialect))
    value = _reader(type_name)(body, token.text, type_name, dialect)
    return Literal(token.span, value, type_name, "#" in body)


def _unknown_prefix(prefix: str, dialect: Dialect) -> str:
    if prefix.upper() == "P":
        return "pointers (P#) are not supported; name the variable itself"
    return f"{prefix}# is not a literal type of {dialect.title}"


# -------------------------------------------------------------------------------------------------------- numbers


def _number(text: str, dialect: Dialect) -> int | float:
    digits = text.replace("_", "")
    if not digits[:1].isdigit():
        raise LiteralError(f"{text} is not a number")
    if "#" in digits:
        return _based(text, digits)
    if "." in digits or "e" in digits.lower():
        return _real(text, digits, dialect)
    return _decimal(digits)


def _decimal(digits: str) -> int:
    if len(digits) > 40:
        raise LiteralError(f"{digits[:20]}... has {len(digits)} digits; 20 are the most an integer can have")
    return int(digits)


def _based(text: str, digits: str) -> int:
    base, body = digits.split("#", 1)
    if base not in ("2", "8", "16"):
        raise LiteralError(f"{text}: base {base} does not exist; write 2#, 8# or 16#")
    if not body:
        raise LiteralError(f"{text} has no digits; write {base}#0")
    if len(body) > 70:
        raise LiteralError(f"{base}#{body[:20]}... has {len(body)} digits; 64 bits are the most")
    try:
        return int(body, int(base))
    except ValueError:
        raise LiteralError(f"{text} has a digit that base {base} lacks") from None


def _real(text: str, digits: str, dialect: Dialect) -> float:
    if "." not in digits and dialect.real_needs_point:
        mantissa, exponent = re.split("[eE]", text)
        raise LiteralError(f"REAL literal {text} needs a point in {dialect.title}; write {mantissa}.0E{exponent}")
    value = float(digits)
    if value == 0.0 and re.search("[1-9]", re.split("[eE]", digits)[0]):
        raise LiteralError(f"{text} is too small for a REAL; write 0.0")
    return _check_real(text, value, "LREAL" if "LREAL" in dialect.types else "REAL")


def _check_real(text: str, value: float, type_name: str) -> float:
    smallest, infinity, shown = REAL_RANGES[type_name]
    if abs(value) >= infinity or 0.0 < abs(value) < smallest:
        raise LiteralError(f"{text} is outside the range of {type_name}: {shown}")
    return value


def _check_range(text: str, value: int, lowest: int, highest: int, type_name: str = "an integer") -> int:
    if not lowest <= value <= highest:
        raise LiteralError(f"{text} is outside the range of {type_name}: {lowest} to {highest}")
    return value


def _signed(body: str, dialect: Dialect) -> int | float:
    sign = -1 if body.startswith("-") else 1
    return sign * _number(body.lstrip("+-"), dialect)


def _integer_value(body: str, text: str, type_name: str, dialect: Dialect) -> Value:
    value = _signed(body, dialect)
    if isinstance(value, float):
        raise LiteralError(f"{text} has a fraction; write REAL#{body} or drop it")
    lowest, highest = INTEGER_RANGES[type_name]
    if lowest < 0 and "#" in body and highest < value <= highest - lowest:
        value -= highest - lowest + 1  # bits, the first of which is the sign
    return _check_range(text, value, lowest, highest, type_name)


def _bool_value(body: str, text: str, type_name: str, dialect: Dialect) -> Value:
    if body.upper() in ("TRUE", "FALSE"):
        return body.upper() == "TRUE"
    return bool(_integer_value(body, text, type_name, dialect))


def _real_value(body: str, text: str, type_name: str, dialect: Dialect) -> Value:
    return _check_real(text, float(_signed(body, dialect)), type_name)


# ----------------------------------------------------------------------------------------------------------- text

_ESCAPES = {"$": "$", "'": "'", "L": "\n", "N": "\r\n", "P": "\f", "R": "\r", "T": "\t"}
_ESCAPE = re.compile(r"\$([0-9A-Fa-f]{2}|.)")


MAX_CHARACTERS = 254


def unescape(text: str) -> str:
    """`$$ $' $L $N $P $R $T $hh` of a string literal resolved."""
    return _ESCAPE.sub(_unescape_one, text)


def _characters(quoted: str) -> str:
    """What a quoted text holds, fit for a STRING."""
    text = unescape(quoted[1:-1])
    wide = next((character for character in text if ord(character) > 255), None)
    if wide is not None:
        raise LiteralError(f"'{wide}' does not fit CHAR and STRING (8 bits a character); write ASCII")
    if len(text) > MAX_CHARACTERS:
        raise LiteralError(f"text of {len(text)} characters; a STRING holds at most {MAX_CHARACTERS}, split it")
    return text


def _unescape_one(match: re.Match[str]) -> str:
    code = match.group(1)
    if len(code) == 2:
        return chr(int(code, 16))
    if code.upper() not in _ESCAPES:
        raise LiteralError(f"${code} is not an escape in a string; write $$ for a dollar sign")
    return _ESCAPES[code.upper()]


def _char_value(body: str, text: str, _type_name: str, dialect: Dialect) -> Value:
    if not body.startswith("'"):
        return chr(int(_integer_value(body, text, "BYTE", dialect)))
    value = _characters(body)
    if len(value) != 1:
        raise LiteralError(f"{text} has {len(value)} characters; CHAR holds exactly one")
    return value


def _string_value(body: str, text: str, _type_name: str, _dialect: Dialect) -> Value:
    if not body.startswith("'"):
        raise LiteralError(f"{text} needs quotes; write '{body}'")
    return _characters(body)


# ----------------------------------------------------------------------------------------------------------- time

_UNITS = {"d": 86_400_000, "h": 3_600_000, "m": 60_000, "s": 1000, "ms": 1}
_DURATION = re.compile(
    r"([+-])?" + "".join(rf"(?:(?P<{unit}>[0-9]+(?:\.[0-9]+)?){unit})?" for unit in _UNITS),
    re.IGNORECASE,
)
_MAX_DIGITS = 12


def _milliseconds(body: str, text: str) -> int:
    """Whole ms of `1d_2h_3m_4s_5ms`; parts may be left out, a fraction of a ms is dropped."""
    match = _DURATION.fullmatch(body.replace("_", ""))
    parts = {unit: value for unit, value in match.groupdict().items() if value} if match else {}
    if not parts or any(len(value) > _MAX_DIGITS for value in parts.values()):
        raise LiteralError(f"{text} is not a duration; write {text.split('#')[0]}#1d2h3m4s5ms")
    total = int(sum(Fraction(value) * _UNITS[unit] for unit, value in parts.items()))
    return -total if body.startswith("-") else total


def _time_value(body: str, text: str, type_name: str, _dialect: Dialect) -> Value:
    return _check_range(f"{text} (in ms)", _milliseconds(body, text), -(2**31), 2**31 - 1, type_name)


def _s5time_value(body: str, text: str, type_name: str, _dialect: Dialect) -> Value:
    """BCD word: two bits of base (10 ms, 100 ms, 1 s, 10 s), three digits; the finest base that holds the value."""
    total = _check_range(f"{text} (in ms)", _milliseconds(body, text), 0, 9_990_000, type_name)
    code = next(code for code in range(4) if total // (10 * 10**code) <= 999)
    return code << 12 | bcd(total // (10 * 10**code), 3)


def bcd(number: int, digits: int) -> int:
    """Binary coded decimal, four bits a digit."""
    return int(f"{number:0{digits}d}", 16)


_EPOCH = date(1990, 1, 1)
_LAST_DAY = date(2168, 12, 31)
_LAST_STAMP_YEAR = 2089
_DATE = re.compile(r"([0-9]{1,4})-([0-9]{1,2})-([0-9]{1,2})")
_CLOCK = re.compile(r"([0-9]{1,2}):([0-9]{1,2})(?::([0-9]{1,2})(?:\.([0-9]{1,9}))?)?")
_STAMP = re.compile(rf"({_DATE.pattern})-({_CLOCK.pattern})")


def _date(body: str, text: str) -> date:
    match = _DATE.fullmatch(body)
    try:
        year, month, day = (int(part) for part in match.groups()) if match else (0, 0, 0)
        return date(year + _century(year), month, day)
    except ValueError:
        raise LiteralError(f"{text} is not a date; write {text.split('#')[0]}#1990-1-31") from None


def _century(year: int) -> int:
    """A year of two digits lies between 1990 and 2089."""
    if year > 99:
        return 0
    return 1900 if year >= 90 else 2000


def _clock(body: str, text: str) -> int:
    """Milliseconds since midnight."""
    match = _CLOCK.fullmatch(body)
    hour, minute, second = (int(match.group(part) or 0) for part in (1, 2, 3)) if match else (24, 0, 0)
    if hour > 23 or minute > 59 or second > 59:
        raise LiteralError(f"{text} is not a time of day; write TOD#23:59:59.999")
    fraction = (match.group(4) or "") if match else ""
    return ((hour * 60 + minute) * 60 + second) * 1000 + int(f"{fraction}000"[:3])


def _date_value(body: str, text: str, _type_name: str, _dialect: Dialect) -> Value:
    day = _date(body, text)
    if not _EPOCH <= day <= _LAST_DAY:
        raise LiteralError(f"{text} is outside the range of DATE: {_EPOCH} to {_LAST_DAY}")
    return (day - _EPOCH).days


def _clock_value(body: str, text: str, _type_name: str, _dialect: Dialect) -> Value:
    return _clock(body, text)


def _stamp_value(body: str, text: str, _type_name: str, _dialect: Dialect) -> Value:
    match = _STAMP.fullmatch(body)
    if match is None:
        raise LiteralError(f"{text} is not a date and time; write DT#1990-1-31-23:59:59.999")
    day = _date(match.group(1), text)
    if not _EPOCH.year <= day.year <= _LAST_STAMP_YEAR:
        raise LiteralError(f"{text} is outside the range of DATE_AND_TIME: 1990 to {_LAST_STAMP_YEAR}")
    moment = datetime(day.year, day.month, day.day) + timedelta(milliseconds=_clock(match.group(5), text))
    return stamp_bytes(moment)


def stamp_bytes(moment: datetime) -> int:
    """DATE_AND_TIME: BCD year, month, day, hour, minute, second, then three digits of ms and the weekday (1 Sunday)."""
    weekday = moment.isoweekday() % 7 + 1
    fields = (moment.year % 100, moment.month, moment.day, moment.hour, moment.minute, moment.second)
    digits = "".join(f"{field:02d}" for field in fields) + f"{moment.microsecond // 1000:03d}{weekday}"
    return int(digits, 16)


Reader = Callable[[str, str, str, Dialect], Value]
_READERS: dict[str, Reader] = {
    "BOOL": _bool_value,
    "REAL": _real_value,
    "LREAL": _real_value,
    "CHAR": _char_value,
    "STRING": _string_value,
    "TIME": _time_value,
    "S5TIME": _s5time_value,
    "DATE": _date_value,
    "TIME_OF_DAY": _clock_value,
    "DATE_AND_TIME": _stamp_value,
}


def _reader(type_name: str) -> Reader:
    return _READERS.get(type_name, _integer_value)
