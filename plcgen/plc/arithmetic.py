"""What operator texts call beyond Python's own operators, and evaluation of one operator outside an engine."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Sequence
from typing import Any, Literal, NoReturn

from plcgen.plc.operators import Operator
from plcgen.plc.types import Value, round_real

OVERFLOW = "overflow"
INVALID_OPERAND = "invalid operand"
DIVISION_BY_ZERO = "division by zero"
OUT_OF_RANGE = "conversion out of range"

Report = Callable[[str, int], None]
"""report(kind, site): an arithmetic event that a CPU notes in its status word while it goes on."""


class EvaluationError(ValueError):
    """An operator on constants that has no good value."""


# ------------------------------------------------------------------------------------- functions without events


def _total(function: Callable[[float], float]) -> Callable[[float], float]:
    """A function of math with IEEE results instead of exceptions."""

    def extended(x: float) -> float:
        try:
            return function(x)
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    return extended


def _logarithm(function: Callable[[float], float]) -> Callable[[float], float]:
    return lambda x: function(x) if x > 0.0 else -math.inf if x == 0.0 else math.nan


def _square_root(x: float) -> float:
    return math.sqrt(x) if x >= 0.0 else math.nan


def _exponential_of_ten(x: float) -> float:
    return math.pow(10.0, x)


def _power(base: float, exponent: float) -> float:
    try:
        return math.pow(base, exponent)
    except OverflowError:
        return -math.inf if base < 0.0 and exponent % 2.0 == 1.0 else math.inf
    except ValueError:
        return math.inf if base == 0.0 else math.nan


_S5TIME_UNITS = (10, 100, 1000, 10000)  # ms


def _s5time_to_ms(word: int) -> int:
    digits = (word >> 8 & 15) * 100 + (word >> 4 & 15) * 10 + (word & 15)
    return digits * _S5TIME_UNITS[word >> 12 & 3]


def _ms_to_s5time(milliseconds: int) -> int:
    base = next((base for base, unit in enumerate(_S5TIME_UNITS) if milliseconds < 1000 * unit), 3)
    digits = min(999, max(0, milliseconds) // _S5TIME_UNITS[base])
    return base << 12 | digits // 100 << 8 | digits // 10 % 10 << 4 | digits % 10


def _bcd(packed: int, byte: int) -> int:
    pair = packed >> (7 - byte) * 8 & 255
    return (pair >> 4) * 10 + (pair & 15)


def _dt_to_days(packed: int) -> int:
    from datetime import date  # rarely needed, slow to import

    year, month, day = (_bcd(packed, byte) for byte in range(3))
    return (date(year + (1900 if year >= 90 else 2000), month, day) - date(1990, 1, 1)).days


def _dt_to_ms(packed: int) -> int:
    hour, minute, second, hundredths = (_bcd(packed, byte) for byte in range(3, 7))
    return ((hour * 60 + minute) * 60 + second) * 1000 + hundredths * 10 + (packed >> 4 & 15)


Code = Literal["f", "I", "d", "Q"]


def _recode(source: Code, target: Code, size: int) -> Callable[[Any], Any]:
    """The same bits read as another type, both by their codes in a memory view."""
    cell = memoryview(bytearray(size))
    written, read = cell.cast(source), cell.cast(target)

    def recoded(value: Any) -> Any:
        written[0] = value
        return read[0]

    return recoded


def _characters(text: bytes) -> bytes:
    return text[2 : 2 + text[1]]


def _resized(text: bytes, length: int, size: int) -> bytes:
    kept = _characters(text)[:length]
    return (bytes([length, len(kept)]) + kept).ljust(size, b"\0")


_PURE: dict[str, Any] = {
    "characters": _characters,
    "resized": _resized,
    "inf": math.inf,
    "nan": math.nan,
    "sin": _total(math.sin),
    "cos": _total(math.cos),
    "tan": _total(math.tan),
    "asin": _total(math.asin),
    "acos": _total(math.acos),
    "atan": math.atan,
    "exp": _total(math.exp),
    "expd": _total(_exponential_of_ten),
    "ln": _logarithm(math.log),
    "log": _logarithm(math.log10),
    "sqrt": _square_root,
    "power": _power,
    "half_even": round,
    "trunc": math.trunc,
    "ceil": math.ceil,
    "floor": math.floor,
    "real_to_bits": _recode("f", "I", 4),
    "bits_to_real": _recode("I", "f", 4),
    "lreal_to_bits": _recode("d", "Q", 8),
    "bits_to_lreal": _recode("Q", "d", 8),
    "s5time_to_ms": _s5time_to_ms,
    "ms_to_s5time": _ms_to_s5time,
    "dt_to_days": _dt_to_days,
    "dt_to_ms": _dt_to_ms,
}


# ---------------------------------------------------------------------------------------- functions with events


def _signed(value: int, minimum: int, bits: int) -> int:
    """The low bits of value as a number that starts at minimum."""
    return (value - minimum & (1 << bits) - 1) + minimum


class _Events:
    """Functions that report. Each takes the site of its instruction last."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.divided_by_zero = False

    def special(self, value: float, site: int) -> float:
        """A float result that is denormal, infinite or NaN."""
        divided, self.divided_by_zero = self.divided_by_zero, False
        if math.isfinite(value):
            return 0.0
        infinite = DIVISION_BY_ZERO if divided else OVERFLOW
        self.report(infinite if math.isinf(value) else INVALID_OPERAND, site)
        return value

    def over_zero(self, dividend: float, zero: float) -> float:
        """dividend / zero, which may be -0.0; `special` sees the result next and reports it."""
        if dividend == 0.0 or math.isnan(dividend):
            return math.nan
        self.divided_by_zero = True
        return math.copysign(math.inf, dividend) * math.copysign(1.0, zero)

    def wrap(self, value: int, minimum: int, bits: int, site: int) -> int:
        self.report(OVERFLOW, site)
        return _signed(value, minimum, bits)

    def noted(self, value: Any, kind: str, site: int) -> Any:
        """The value as it is; what becomes of it is the next instruction's business."""
        self.report(kind, site)
        return value

    def narrow(self, value: int, minimum: int, bits: int, site: int) -> int:
        self.report(OUT_OF_RANGE, site)
        return _signed(value, minimum, bits)

    def quotient(self, dividend: int, divisor: int, site: int) -> int:
        if divisor == 0:
            self.report(DIVISION_BY_ZERO, site)
            return 0
        magnitude = abs(dividend) // abs(divisor)
        return magnitude if (dividend < 0) == (divisor < 0) else -magnitude

    def remainder(self, dividend: int, divisor: int, site: int) -> int:
        if divisor == 0:
            self.report(DIVISION_BY_ZERO, site)
            return 0
        return dividend - divisor * self.quotient(dividend, divisor, site)

    def to_integer(self, rounding: Callable[[float], int], x: float, minimum: int, bits: int, site: int) -> int:
        """Round to an integer. What does not fit stays as it is in the accumulator: the bits of the float.

        A CPU rounds to 32 bits at least; a narrower target takes the low bits of that.
        """
        number = rounding(x) if math.isfinite(x) else None
        if number is not None and minimum <= number < minimum + (1 << bits):
            return number
        self.report(OUT_OF_RANGE, site)
        if number is not None and bits < 32 and -(1 << 31) <= number < 1 << 31:
            return _signed(number, minimum, bits)
        pattern = _PURE["real_to_bits"](round_real(x)) if bits <= 32 else _PURE["lreal_to_bits"](x)
        return _signed(pattern, minimum, bits)


def library(
    report: Report, out_of_bounds: Callable[[int, int, int, int], NoReturn], function_error: float = 0.0
) -> dict[str, Any]:
    """All names that operator texts use. `out_of_bounds(index, low, high, site)` ends the run.

    `function_error` is the relative error of SIN, EXP, LN and the like, for CPUs that compute them less exactly.
    """
    events = _Events(report)
    names = ("special", "over_zero", "wrap", "noted", "narrow", "quotient", "remainder", "to_integer")
    reporting = {name: getattr(events, name) for name in names}
    blurred = {name: _blurred(_PURE[name], 1.0 + function_error) for name in _APPROXIMATE if function_error}
    return {**_PURE, **blurred, **reporting, "out_of_bounds": out_of_bounds, "f": array("f", [0.0])}


# What a CPU approximates; its square root is exact.
_APPROXIMATE = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "expd", "ln", "log")


def _blurred(function: Callable[[float], float], factor: float) -> Callable[[float], float]:
    return lambda x: function(x) * factor


def evaluate(operator: Operator, values: Sequence[Value]) -> Value:
    """One operator on constants, by the same text as in an engine. Raises EvaluationError with the kind of event."""

    def refuse(kind: str, _site: int) -> None:
        raise EvaluationError(kind)

    def refuse_index(index: int, low: int, high: int, _site: int) -> NoReturn:
        raise EvaluationError(f"index {index} outside {low} .. {high}")

    names = library(refuse, refuse_index)
    exec("\n".join(operator.python("result", [f"({value!r})" for value in values], 0)), names)
    result: Value = names["result"]
    return result
