"""What bodies call: the functions of `arithmetic`, compiled. Events are noted in E: their count, a flag, then pairs."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

OVERFLOW, INVALID, BY_ZERO, OUT_OF_RANGE = range(4)
COUNT, DIVIDED, FIRST = 0, 1, 2
WHOLE = ir.IntType(64)

compiled: Callable[[Any], Any] = njit(cache=True, error_model="numpy", inline="never")


def _called(_typing: Any, address: Any, room: Any, memory: Any, start: Any) -> Any:
    """What native code at an address returns for the addresses of room and memory and the first row."""
    function = ir.FunctionType(WHOLE, [WHOLE] * 3).as_pointer()

    def generated(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        at, *rest = _whole_numbers(context, builder, signature, values)
        return builder.call(builder.inttoptr(at, function), rest)

    return types.int64(address, room, memory, start), generated


def _moved(_typing: Any, target: Any, source: Any, size: Any) -> Any:
    """Bytes from an address to another, at once."""
    byte = ir.IntType(8).as_pointer()

    def generated(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        to, at, count = _whole_numbers(context, builder, signature, values)
        cgutils.raw_memmove(builder, builder.inttoptr(to, byte), builder.inttoptr(at, byte), count, 1)
        return context.get_dummy_value()

    return types.void(target, source, size), generated


def _whole_numbers(context: Any, builder: Any, signature: Any, values: Any) -> list[Any]:
    return [context.cast(builder, value, kind, types.int64) for value, kind in zip(values, signature.args, strict=True)]


called: Any = intrinsic(_called)
moved: Any = intrinsic(_moved)


@compiled
def report(E: Any, kind: int, site: int) -> None:  # noqa: N803 - a name of the virtual machine
    place = FIRST + 2 * E[COUNT]
    E[place] = kind
    E[place + 1] = site
    E[COUNT] += 1


@compiled
def count(T: Any, number: int) -> int:  # noqa: N803
    T[number % len(T)] += 1
    return 0


@compiled
def signed(value: int, minimum: int, bits: int) -> int:
    return ((value - minimum) & ((1 << bits) - 1)) + minimum


@compiled
def special(E: Any, value: float, site: int) -> float:  # noqa: N803
    divided = E[DIVIDED]
    E[DIVIDED] = 0
    if math.isfinite(value):
        return 0.0
    if math.isinf(value):
        report(E, BY_ZERO if divided else OVERFLOW, site)
    else:
        report(E, INVALID, site)
    return value


@compiled
def over_zero(E: Any, dividend: float, zero: float) -> float:  # noqa: N803
    if dividend == 0.0 or math.isnan(dividend):
        return math.nan
    E[DIVIDED] = 1
    return math.copysign(math.inf, dividend) * math.copysign(1.0, zero)


@compiled
def wrap(E: Any, value: int, minimum: int, bits: int, site: int) -> int:  # noqa: N803
    report(E, OVERFLOW, site)
    return signed(value, minimum, bits)


@compiled
def narrow(E: Any, value: int, minimum: int, bits: int, site: int) -> int:  # noqa: N803
    report(E, OUT_OF_RANGE, site)
    return signed(value, minimum, bits)


@compiled
def noted(E: Any, value: Any, kind: int, site: int) -> Any:  # noqa: N803
    report(E, kind, site)
    return value


@compiled
def quotient(E: Any, dividend: int, divisor: int, site: int) -> int:  # noqa: N803
    if divisor == 0:
        report(E, BY_ZERO, site)
        return 0
    magnitude = abs(dividend) // abs(divisor)
    return magnitude if (dividend < 0) == (divisor < 0) else -magnitude


@compiled
def remainder(E: Any, dividend: int, divisor: int, site: int) -> int:  # noqa: N803
    if divisor == 0:
        report(E, BY_ZERO, site)
        return 0
    return dividend - divisor * quotient(E, dividend, divisor, site)


@compiled
def rounded(rounding: int, x: float) -> float:
    if rounding == 0:
        return np.rint(x)
    if rounding == 1:
        return np.trunc(x)
    return np.ceil(x) if rounding == 2 else np.floor(x)


@compiled
def to_integer(E: Any, rounding: int, x: float, minimum: int, bits: int, site: int) -> int:  # noqa: N803
    if math.isfinite(x):
        number = rounded(rounding, x)
        if minimum <= number < minimum + 2.0**bits:
            return int(number)
        report(E, OUT_OF_RANGE, site)
        if bits < 32 and -2147483648.0 <= number < 2147483648.0:
            return signed(int(number), minimum, bits)
    else:
        report(E, OUT_OF_RANGE, site)
    return signed(real_to_bits(x), minimum, bits)


@compiled
def real_to_bits(x: float) -> int:
    bits: Any = np.int64(np.float32(x).view(np.uint32))
    return bits


@compiled
def bits_to_real(bits: int) -> float:
    return np.float64(np.uint32(bits).view(np.float32))


@compiled
def truncated(x: float) -> int:
    return int(x)


@compiled
def whole(x: Any) -> int:
    return int(x)


@compiled
def no_number(x: float, result: float) -> float:
    """Python's functions give its own NaN, without a sign, where C's give any; a NaN goes through."""
    return math.nan if math.isnan(result) and not math.isnan(x) else result


@compiled
def square_root(x: float) -> float:
    return no_number(x, math.sqrt(x))


@compiled
def approximate_sin(factor: float, x: float) -> float:
    return no_number(x, math.sin(x)) * factor


@compiled
def approximate_cos(factor: float, x: float) -> float:
    return no_number(x, math.cos(x)) * factor


@compiled
def approximate_tan(factor: float, x: float) -> float:
    return no_number(x, math.tan(x)) * factor


@compiled
def approximate_asin(factor: float, x: float) -> float:
    return no_number(x, math.asin(x)) * factor


@compiled
def approximate_acos(factor: float, x: float) -> float:
    return no_number(x, math.acos(x)) * factor


@compiled
def approximate_atan(factor: float, x: float) -> float:
    return no_number(x, math.atan(x)) * factor


@compiled
def approximate_exp(factor: float, x: float) -> float:
    return no_number(x, math.exp(x)) * factor


@compiled
def approximate_ln(factor: float, x: float) -> float:
    return no_number(x, math.log(x)) * factor


@compiled
def approximate_log(factor: float, x: float) -> float:
    return no_number(x, math.log10(x)) * factor
