"""Native code: what is compiled, when, and what is kept of it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from plcgen.plc import engines
from plcgen.plc.core import Program
from plcgen.plc.machine import Machine
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_lowering import lower as lower_stl
from plcgen.plc.stl.s7_parser import parse as parse_stl
from tests.every_engine import NATIVE, choose, is_native

pytest.importorskip("numba", reason="the fast engine needs Numba: pip install plcgen[fast]")

from plcgen.plc.fast import bodies, generate, native, native_rows, vm
from plcgen.plc.fast.bodies import Body
from plcgen.plc.fast.encode import Code, Entry
from plcgen.plc.fast.memory import FastRunner

COUNTER = """FUNCTION_BLOCK FB1
VAR_OUTPUT
    calls : INT;
    sum : REAL;
END_VAR
BEGIN
    calls := calls + {step};
    sum := sum + {weight} * INT_TO_REAL(calls);
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""
RARE = ("approximate_", "%", "count(T, A)")
"""Functions of a library, rotations by any number, and what is counted by a number that is not in the program."""


@pytest.fixture(autouse=True)
def engine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    choose(NATIVE, monkeypatch, tmp_path)


@pytest.fixture
def objects(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Sizes of the objects that were compiled."""
    sizes: list[int] = []
    really = native._object

    def noted(text: str) -> bytes:
        data = really(text)
        sizes.append(len(data))
        return data

    monkeypatch.setattr(native, "_object", noted)
    yield sizes


def counter(step: int = 1, weight: str = "0.5") -> Program:
    text = COUNTER.format(step=step, weight=weight)
    return lower(list(parse(SourceText("counter.scl", text), CLASSIC)), CLASSIC)


def result(machine: Machine) -> tuple[int, float]:
    """Of three calls: calls 3, sum 0.5 * (1 + 2 + 3)."""
    for _ in range(3):
        machine.call("FB1", "DB1")
    return machine.variable('"DB1".calls').get(), machine.variable('"DB1".sum').get()


# ---------------------------------------------------------------------------------------------------------- bodies


def translated(body: Body) -> native_rows._Function:
    """A function of one row, with four operands and six numbers, of the kinds that the body wants."""
    code = Code(0)
    slots = [code.slot() for _ in body.kinds]
    floats = [re.search(rf"\bG{n}\b", body.key) is not None for n in range(bodies.MOST_NUMBERS)]
    numbers = [code.constant(0.5 + n if is_float else 3 + n) for n, is_float in enumerate(floats)]
    number = vm.BODIES[body.key]
    code.bodies[number] = body
    code.row(number, slots[-1], *slots[:-1], numbers=numbers)
    code.entries["FC1"] = Entry(0, (), (), (), 0)
    return native_rows._Function(code, 0, 1)


def test_almost_every_body_has_words_for_the_processor() -> None:
    left = set()
    for body in generate.all_bodies():
        function = translated(body)
        function.written()
        if f"store {'double' if body.kinds[-1] == 'f' else 'i64'}" not in "\n".join(function.text.lines):
            left.add(body.expression)
    assert not [expression for expression in left if not any(word in expression for word in RARE)]
    assert len(left) < 0.15 * len(generate.all_bodies())


SHIFTS = """FUNCTION_BLOCK FB 1
VAR
 i : INT;
 d : DINT;
 right : INT;
 far : DINT;
 left : INT;
END_VAR
BEGIN
NETWORK
TITLE =
 L #i; SSI 3; T #right;
 L #d; SSD 31; T #far;
 L #i; SLW 2; T #left;
END_FUNCTION_BLOCK
DATA_BLOCK DB 1
FB 1
BEGIN
END_DATA_BLOCK
"""


@pytest.mark.parametrize(
    ("i", "d", "right", "far", "left"),
    [(-100, -7, -13, -1, -400), (100, 7, 12, 0, 400), (-32768, -(2**31), -4096, -1, 0)],
)
def test_shifts_by_a_constant_keep_the_sign(i: int, d: int, right: int, far: int, left: int) -> None:
    """Shifts have native code where the text says by how much."""
    machine = Machine(lower_stl(parse_stl(SourceText("shifts.awl", SHIFTS))))
    assert is_native(machine)
    machine.variable("DB1.i").set(i)
    machine.variable("DB1.d").set(d)
    machine.call("FB1", "DB1")
    assert [machine.variable(f"DB1.{name}").get() for name in ("right", "far", "left")] == [right, far, left]


TRUTHS = """FUNCTION_BLOCK FB1
VAR
    a : INT := 3;
    b : INT;
    c : BOOL;
    same : BOOL;
    other : BOOL;
END_VAR
BEGIN
    same := (a > b) = c;
    other := (a > b) XOR c;
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""


@pytest.mark.parametrize("b", [2, 3])
@pytest.mark.parametrize("c", [False, True])
def test_a_truth_that_was_computed_is_one_from_memory(b: int, c: bool) -> None:
    machine = Machine(lower(list(parse(SourceText("truths.scl", TRUTHS), CLASSIC)), CLASSIC))
    assert is_native(machine)
    machine.variable('"DB1".b').set(b)
    machine.variable('"DB1".c').set(c)
    machine.call("FB1", "DB1")
    found = [machine.variable(f'"DB1".{name}').get() for name in ("same", "other")]
    assert found == [(b < 3) == c, (b < 3) != c]


# ------------------------------------------------------------------------------------------------------- hand-over

NESTED = """FUNCTION_BLOCK FB2
VAR_OUTPUT
    small : INT := 32767;
END_VAR
BEGIN
    small := small + 1;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB1
VAR
    before : INT;
    inner : FB2;
    after : INT;
END_VAR
BEGIN
    before := before + 1;
    inner();
    after := after + inner.small;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB3
VAR
    none : DINT;
    one : FB1;
    two : FB1;
END_VAR
BEGIN
    one();
    two();
    none := none + 1;
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB3
BEGIN
END_DATA_BLOCK
"""


def test_callers_of_what_was_handed_over_go_on_in_their_instance() -> None:
    """The innermost block overflows, -32768 the first time, -32767 the next."""
    machine = Machine(lower(list(parse(SourceText("nested.scl", NESTED), CLASSIC)), CLASSIC))
    assert is_native(machine)
    for _ in range(2):
        machine.call("FB3", "DB1")
    names = ("none", "one.before", "one.after", "two.before", "two.after")
    assert [machine.variable(f'"DB1".{name}').get() for name in names] == [2, 2, 1, 2, 1]


# ------------------------------------------------------------------------------------------------------------ when


def test_it_begins_when_so_many_scans_have_been_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native, "SCANS_A_ROW", 100)
    machine = Machine(counter())
    assert isinstance(machine.engine, FastRunner)
    rows = len(machine.engine.engine._code)
    machine.engine.engine.have_run(100 * rows - 1)
    assert not is_native(machine)
    machine.engine.engine.have_run(1)
    assert is_native(machine)


def test_machines_of_a_program_share_it(objects: list[int]) -> None:
    program = counter()
    machines = [Machine(program) for _ in range(3)]
    assert all(map(is_native, machines))
    assert len(objects) == 1
    assert [result(machine) for machine in machines] == [(3, 3.0)] * 3


# ------------------------------------------------------------------------------------------------------------ kept


def test_what_was_compiled_is_kept_for_other_runs(objects: list[int]) -> None:
    Machine(counter())
    machine = Machine(counter())
    assert len(objects) == 1
    assert is_native(machine)
    assert result(machine) == (3, 3.0)


def test_real_numbers_are_data_and_whole_ones_are_not(objects: list[int]) -> None:
    results = [result(Machine(counter(step, weight))) for step, weight in [(1, "0.5"), (1, "0.25"), (2, "0.5")]]
    assert results == [(3, 3.0), (3, 1.5), (6, 6.0)]
    assert len(objects) == 2


def test_the_plain_engine_compiles_nothing(monkeypatch: pytest.MonkeyPatch, objects: list[int], tmp_path: Path) -> None:
    choose(engines.PLAIN, monkeypatch, tmp_path)
    assert result(Machine(counter())) == (3, 3.0)
    assert not objects
