"""Random programs of arithmetic: STL text through parser, lowering and engine against NumPy, operand by operand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.plc.cpu.smart import Smart
from plcgen.plc.source import SourceText
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from plcgen.plc.types import DINT, INT, REAL, Elementary

SMALLEST = np.float32(2.0**-126)
PLACES = 4

MAIN = "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\n{}\nEND_ORGANIZATION_BLOCK\n"

Step = tuple[str, int, int]
"""Mnemonic, place of IN, place of OUT."""


def machine_of(body: str) -> Smart:
    return Smart(lower(parse(SourceText("f.awl", MAIN.format(body)))))


@dataclass
class Model:
    """What the manual says: operands stay when a result does not fit, and SM1 tells why."""

    places: list[float]
    sm1: int = 0

    def settle(self, place: int, result: float, fits: bool) -> None:
        self.sm1 = self.sm1 & ~7 | (2 if not fits else 1 if result == 0 else 4 if result < 0 else 0)
        if fits:
            self.places[place] = result


def real_step(model: Model, step: Step) -> None:
    word, source, target = step
    x, y = (np.float32(model.places[place]) for place in (source, target))
    if word == "/R":
        if x == 0:
            model.sm1 |= 8
            return
        model.sm1 &= ~8
    with np.errstate(all="ignore"):
        results: dict[str, Callable[[], np.float32]] = {
            "+R": lambda: y + x,
            "-R": lambda: y - x,
            "*R": lambda: x * y,
            "/R": lambda: y / x,
            "SQRT": lambda: np.sqrt(x),
        }
        result = results[word]()
    result = np.float32(0.0) if abs(result) < SMALLEST else result
    model.settle(target, float(result), bool(np.isfinite(result)))


def whole_step(kind: Elementary) -> Callable[[Model, Step], None]:
    def step_of(model: Model, step: Step) -> None:
        word, source, target = step
        x, y = int(model.places[source]), int(model.places[target])
        if word[0] == "/":
            if x == 0:
                model.sm1 |= 8
                return
            model.sm1 &= ~8
        result = {
            "+": lambda: y + x,
            "-": lambda: y - x,
            "*": lambda: x * y,
            "/": lambda: abs(y) // abs(x) * (1 if (x < 0) == (y < 0) else -1),
        }[word[0]]()
        model.settle(target, result, kind.minimum <= result <= kind.maximum)

    return step_of


def run(steps: list[Step], values: list[float], kind: Elementary, letter: str) -> Smart:
    body = "\n".join(f"{word} V{letter}{4 * source}, V{letter}{4 * target}" for word, source, target in steps)
    machine = machine_of(body)
    for place, value in enumerate(values):
        machine.variable(f"V{letter}{4 * place}", kind).set(value)
    machine.scan()
    return machine


def check(steps: list[Step], values: list[float], kind: Elementary, reference: Callable[[Model, Step], None]) -> None:
    letter = "W" if kind is INT else "D"
    machine = run(steps, values, kind, letter)
    model = Model(list(values))
    for step in steps:
        reference(model, step)
    assert [machine.variable(f"V{letter}{4 * place}", kind).get() for place in range(PLACES)] == model.places
    assert machine.variable("SMB1").get() == model.sm1


def steps_of(words: str) -> st.SearchStrategy[list[Step]]:
    place = st.integers(0, PLACES - 1)
    return st.lists(st.tuples(st.sampled_from(words.split()), place, place), min_size=1, max_size=12)


def values_of(value: st.SearchStrategy[float]) -> st.SearchStrategy[list[float]]:
    return st.lists(value, min_size=PLACES, max_size=PLACES)


REALS = st.floats(width=32, allow_nan=False, allow_infinity=False, allow_subnormal=False)
NEAR_ONE = st.floats(0.125, 8.0, width=32)


@settings(max_examples=200, deadline=None)
@given(steps=steps_of("+R -R *R /R SQRT"), values=values_of(REALS | NEAR_ONE | st.just(0.0)))
def test_reals_round_after_each_instruction(steps: list[Step], values: list[float]) -> None:
    check(steps, values, REAL, real_step)


@settings(max_examples=150, deadline=None)
@given(steps=steps_of("+I -I *I /I"), values=values_of(st.integers(-32768, 32767) | st.integers(-3, 3)))
def test_words(steps: list[Step], values: list[float]) -> None:
    check(steps, values, INT, whole_step(INT))


@settings(max_examples=150, deadline=None)
@given(steps=steps_of("+D -D *D /D"), values=values_of(st.integers(-(2**31), 2**31 - 1) | st.integers(-3, 3)))
def test_double_words(steps: list[Step], values: list[float]) -> None:
    check(steps, values, DINT, whole_step(DINT))


@settings(max_examples=100, deadline=None)
@given(st.floats(-3e9, 3e9, width=32) | st.integers(-(2**22), 2**22).map(lambda n: n + 0.5))
def test_round_and_trunc(value: float) -> None:
    machine = machine_of("ROUND VD0, VD4\nMOVB SMB1, VB12\nTRUNC VD0, VD8")
    machine.variable("VD0", REAL).set(value)
    machine.scan()
    rounded, cut = int(np.trunc(value + np.copysign(0.5, value))), int(value)
    assert machine.variable("VD4").get() == (rounded if -(2**31) <= rounded < 2**31 else 0)
    assert machine.variable("VD8").get() == (cut if -(2**31) <= cut < 2**31 else 0)
    assert bool(int(machine.variable("VB12").get()) & 2) == (not -(2**31) <= rounded < 2**31)


@settings(max_examples=100, deadline=None)
@given(
    word=st.sampled_from(["SR", "SL", "RR", "RL"]), size=st.sampled_from("BWD"), value=st.integers(0, 2**32 - 1),
    count=st.integers(0, 40),
)  # fmt: skip
def test_shifts_one_bit_at_a_time(word: str, size: str, value: int, count: int) -> None:
    bits = {"B": 8, "W": 16, "D": 32}[size]
    value &= (1 << bits) - 1
    machine = machine_of(f"{word}{size} V{size}0, {count}")
    memory = machine.memory["V"]
    memory[: bits // 8] = value.to_bytes(bits // 8, "big")
    machine.scan()
    out = 0
    for _ in range(count):
        out = value & 1 if word[1] == "R" else value >> bits - 1
        carried = out if word[0] == "R" else 0
        value = value >> 1 | carried << bits - 1 if word[1] == "R" else (value << 1 | carried) & (1 << bits) - 1
    assert int.from_bytes(memory[: bits // 8], "big") == value
    if 0 < count < bits:  # a whole turn is none, and after more shifts than bits the last one is what left at the end
        assert machine.variable("SM1.1").get() == bool(out)
    assert machine.variable("SM1.0").get() == (value == 0)
