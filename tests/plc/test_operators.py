"""The operator table: REAL against numpy.float32, integers against whole numbers, every conversion."""

from __future__ import annotations

import math
import random
import struct

import numpy as np
import pytest

from plcgen.plc.arithmetic import EvaluationError, evaluate, library
from plcgen.plc.operators import IMPLICIT, Operator, alternatives, conversion, conversion_named, resolve
from plcgen.plc.types import (
    BIT_STRINGS,
    BOOL,
    BYTE,
    DINT,
    DWORD,
    ELEMENTARY,
    FLOATS,
    INT,
    INTEGERS,
    REAL,
    TIME,
    WORD,
    Elementary,
    Type,
    Value,
    round_real,
)

EDGES = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    math.inf,
    -math.inf,
    math.nan,
    3.4028234663852886e38,
    2.0**-126,
    -(2.0**-126),
    round_real(0.1),
]
SMALLEST_NORMAL = 2.0**-126


def row(symbol: str, *types: Type) -> Operator:
    found = resolve(symbol, types)
    assert found is not None, (symbol, types)
    return found


def run(operator: Operator, *values: Value) -> tuple[Value, list[str]]:
    """Result and events of one operator."""
    events: list[str] = []

    def stop(*_arguments: int) -> None:
        raise AssertionError("no index here")

    names = library(lambda kind, _site: events.append(kind), stop)  # type: ignore[arg-type]
    exec("\n".join(operator.python("result", [f"({value!r})" for value in values], 0)), names)
    return names["result"], events


def random_reals(count: int) -> list[float]:
    generator = random.Random(4711)
    raw = (struct.unpack(">f", generator.randbytes(4))[0] for _ in range(count))
    return [0.0 if value and abs(value) < SMALLEST_NORMAL else value for value in raw] + EDGES


def flushed(value: np.float32) -> float:
    return 0.0 if abs(value) < SMALLEST_NORMAL else float(value)


def same(left: Value, right: float) -> bool:
    return left == right or (left != left and right != right)


@pytest.mark.parametrize("symbol", ["+", "-", "*", "/"])
@np.errstate(all="ignore")
def test_real_arithmetic_is_float32(symbol: str) -> None:
    wanted = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}[symbol]
    left, right = random_reals(3000), list(reversed(random_reals(3000)))
    near = [round_real(value * 1.0000001) for value in left]
    operator = row(symbol, REAL, REAL)
    code = compile("\n".join(operator.python("result", ["a", "b"], 0)), symbol, "exec")
    events: list[str] = []
    names = library(lambda kind, _site: events.append(kind), lambda *_: pytest.fail("no index here"))
    for a, b in [
        *zip(left, right, strict=True),
        *zip(left, near, strict=True),
        *((a, b) for a in EDGES for b in EDGES),
    ]:
        names |= {"a": a, "b": b}
        events.clear()
        exec(code, names)
        value = flushed(wanted(np.float32(a), np.float32(b)))
        assert same(names["result"], value), (a, symbol, b)
        assert len(events) == (not math.isfinite(value)), (a, symbol, b)


@np.errstate(all="ignore")
def test_square_root_is_float32() -> None:
    for value in random_reals(2000):
        assert same(run(row("SQRT", REAL), value)[0], flushed(np.sqrt(np.float32(value)))), value


@pytest.mark.parametrize(
    ("symbol", "values", "event"),
    [
        ("*", (1e30, 1e30), "overflow"),
        ("/", (1.0, 0.0), "division by zero"),
        ("/", (0.0, 0.0), "invalid operand"),
        ("-", (math.inf, math.inf), "invalid operand"),
        ("+", (math.inf, 1.0), "overflow"),
        ("SQRT", (-1.0,), "invalid operand"),
        ("LN", (0.0,), "overflow"),
        ("LN", (-1.0,), "invalid operand"),
        ("EXP", (1000.0,), "overflow"),
        ("ASIN", (1.5,), "invalid operand"),
        ("SIN", (math.inf,), "invalid operand"),
        ("**", (-8.0, 0.5), "invalid operand"),
        ("**", (-10.0, 101.0), "overflow"),
        ("**", (0.0, -1.0), "overflow"),
    ],
)
def test_special_results_are_reported(symbol: str, values: tuple[float, ...], event: str) -> None:
    assert run(row(symbol, *[REAL] * len(values)), *values)[1] == [event]


def test_denormal_results_are_zero_without_an_event() -> None:
    assert run(row("*", REAL, REAL), 2.0**-100, 2.0**-40) == (0.0, [])
    assert run(row("/", REAL, REAL), SMALLEST_NORMAL, 2.0) == (0.0, [])


@pytest.mark.parametrize("symbol", ["=", "<>", "<", "<=", ">", ">="])
def test_every_comparison_with_nan_is_false(symbol: str) -> None:
    for pair in ((math.nan, 1.0), (1.0, math.nan), (math.nan, math.nan)):
        assert run(row(symbol, REAL, REAL), *pair) == (False, [])


@pytest.mark.parametrize("kind", INTEGERS, ids=str)
def test_integers_wrap(kind: Elementary) -> None:
    generator = random.Random(1)
    for _ in range(200):
        a, b = (generator.randint(kind.minimum, kind.maximum) for _ in range(2))
        for symbol, exact in (("+", a + b), ("-", a - b), ("*", a * b)):
            value, events = run(row(symbol, kind, kind), a, b)
            fits = kind.minimum <= exact <= kind.maximum
            assert isinstance(value, int)
            assert kind.minimum <= value <= kind.maximum
            assert (value - exact) % (1 << kind.bits) == 0
            assert events == ([] if fits else ["overflow"])


@pytest.mark.parametrize(
    ("a", "b", "quotient", "rest"), [(7, 2, 3, 1), (-7, 2, -3, -1), (7, -2, -3, 1), (-7, -2, 3, -1)]
)
def test_integer_division_truncates(a: int, b: int, quotient: int, rest: int) -> None:
    assert run(row("/", INT, INT), a, b) == run(row("DIV", INT, INT), a, b) == (quotient, [])
    assert run(row("MOD", INT, INT), a, b) == (rest, [])


def test_integer_division_by_zero_gives_zero() -> None:
    assert run(row("/", INT, INT), 5, 0) == (0, ["division by zero"])
    assert run(row("MOD", DINT, DINT), 5, 0) == (0, ["division by zero"])
    assert run(row("/", INT, INT), -32768, -1) == (-32768, ["overflow"])


@pytest.mark.parametrize("kind", BIT_STRINGS, ids=str)
def test_shifts_stay_inside_their_type(kind: Elementary) -> None:
    for count in (0, 1, kind.bits - 1, kind.bits, 100, -1):
        for symbol in ("SHL", "SHR", "ROL", "ROR"):
            value, events = run(row(symbol, kind, INT), kind.maximum - 1, count)
            assert isinstance(value, int)
            assert 0 <= value <= kind.maximum
            assert events == []


ALL_CONVERSIONS = [
    (source, target, found)
    for source in ELEMENTARY.values()
    for target in ELEMENTARY.values()
    if (found := conversion(source, target)) is not None
]


@pytest.mark.parametrize("case", ALL_CONVERSIONS, ids=lambda case: case[2].name)
def test_conversions_give_a_value_of_their_type(case: tuple[Elementary, Elementary, Operator]) -> None:
    source, target, operator = case
    for value in samples(source):
        result, _ = run(operator, value)
        assert target.decode(target.encode(result)) == result or result != result, value


def samples(kind: Elementary) -> list[Value]:
    if kind is BOOL:
        return [False, True]
    if kind in FLOATS:
        return [0.0, 0.5, -1.5, 1e10, -1e30, math.inf, math.nan]
    if kind.name == "DATE_AND_TIME":
        return [0x9312251359590012, 0x2502281200000000]
    return [0, 1, kind.maximum // 2, kind.maximum, max(kind.minimum, -1), kind.minimum]


@pytest.mark.parametrize(
    ("name", "value", "result", "events"),
    [
        ("REAL_TO_INT", 2.5, 2, []),
        ("REAL_TO_INT", 3.5, 4, []),
        ("REAL_TO_INT", -0.5, 0, []),
        ("REAL_TO_DINT", 2147483520.0, 2147483520, []),
        ("REAL_TO_DINT", 2147483648.0, 0x4F000000, ["conversion out of range"]),
        ("REAL_TO_DINT", math.nan, 0x7FC00000, ["conversion out of range"]),
        ("DINT_TO_REAL", 16777217, 16777216.0, []),
        ("DINT_TO_INT", 32768, -32768, ["conversion out of range"]),
        ("DWORD_TO_INT", 0x18000, -32768, []),
        ("INT_TO_DWORD", -1, 0xFFFFFFFF, []),
        ("BYTE_TO_INT", 255, 255, []),
        ("WORD_TO_DINT", 0xFFFF, 0xFFFF, []),
        ("DWORD_TO_REAL", 0x40490FDB, 3.1415927410125732, []),
        ("REAL_TO_DWORD", -0.0, 0x80000000, []),
        ("S5TIME_TO_TIME", 0x2127, 127000, []),
        ("TIME_TO_S5TIME", 127000, 0x2127, []),
        ("DT_TO_DATE", 0x9001020000000003, 1, []),
        ("DT_TO_TOD", 0x9001020102034567, 3723456, []),
        ("BOOL_TO_INT", True, 1, []),
        ("WORD_TO_BOOL", 3, True, []),
    ],
)
def test_conversion(name: str, value: Value, result: Value, events: list[str]) -> None:
    operator = conversion_named(name)
    assert operator is not None
    assert run(operator, value) == (result, events)


def test_what_converts_by_itself() -> None:
    classic = {(a.name, b.name) for a, b in IMPLICIT if {a, b} <= {BOOL, BYTE, WORD, DWORD, INT, DINT, REAL, TIME}}
    assert classic == {("INT", "DINT"), ("INT", "REAL"), ("BYTE", "WORD"), ("BYTE", "DWORD"), ("WORD", "DWORD")}


def test_table_has_no_row_twice() -> None:
    for symbol in ("+", "-", "*", "/", "=", "AND", "NEG", "ABS", "SEL", "MIN", "SHL"):
        operands = [operator.operands for operator in alternatives(symbol)]
        assert len(operands) == len(set(operands))


def test_missing_row_is_none() -> None:
    assert resolve("+", (REAL, DINT)) is None
    assert resolve("AND", (INT, INT)) is None
    assert conversion(REAL, BOOL) is None


def test_constants_are_evaluated_by_the_same_text() -> None:
    assert evaluate(row("+", REAL, REAL), (16777216.0, 1.0)) == 16777216.0
    with pytest.raises(EvaluationError, match="division by zero"):
        evaluate(row("/", INT, INT), (1, 0))
