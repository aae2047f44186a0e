"""Simplified code does what it did before: examples, and random STL programs against the code as it was lowered."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import pytest

from plcgen.plc.core import (
    FRAME,
    INSTANCE,
    Area,
    Branch,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Register,
    Return,
    print_instruction,
)
from plcgen.plc.machine import Machine
from plcgen.plc.operators import Operator, move, resolve
from plcgen.plc.simplify import simplified
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl import s7_lowering
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.types import BOOL, DINT, REAL, Elementary
from tests.plc.stl.s7_programs import TABLES, calls, program

HERE = Span(0, 0)
A, B, C = (Register(number, REAL) for number in (1, 2, 3))
N = Register(4, DINT)
P, Q = Register(5, BOOL), Register(6, BOOL)
X, Y = Cell(INSTANCE, 0, REAL), Cell(INSTANCE, 32, REAL)


def row(symbol: str, *kinds: Elementary) -> Operator:
    found = resolve(symbol, kinds)
    assert found is not None
    return found


def put(target: Place, source: Operand) -> Compute:
    return Compute(HERE, target, move(target.type), (source,))


def compute(target: Place, symbol: str, *operands: Operand) -> Compute:
    kinds = [operand.type for operand in operands]
    return Compute(HERE, target, row(symbol, *kinds), operands)  # type: ignore[arg-type]


def shown(*body: Instruction) -> list[str]:
    function = Function("f", SourceText("f", ""), (*body, Return(HERE)), HERE)
    return [print_instruction(item).strip() for item in simplified(function, {}).body][:-1]


def test_copies_and_literals_go_where_they_are_read() -> None:
    two = Literal(2.0, REAL)
    assert shown(put(A, X), put(B, two), compute(C, "*", A, B), put(Y, C)) == [
        "%1:REAL := D[0.0]",
        "%3:REAL := %1 * 2.0",
        "D[4.0]:REAL := %3",
    ]
    assert shown(put(A, two), compute(B, "*", A, A), put(Y, B)) == ["D[4.0]:REAL := 4.0"]


def test_what_may_be_noted_stays() -> None:
    huge = Literal(2.0**127, REAL)
    assert shown(compute(A, "*", huge, huge)) == ["%1:REAL := 1.7014118346046923e+38 * 1.7014118346046923e+38"]


def test_a_cell_is_read_once_until_something_writes_over_it() -> None:
    other = Cell("DB1", 0, REAL)
    assert shown(put(A, X), put(B, X), put(Y, B)) == ["%1:REAL := D[0.0]", "D[4.0]:REAL := %1"]
    assert shown(put(A, X), put(other, A), put(B, X), put(Y, B))[2] == "%2:REAL := D[0.0]"
    indexed = Cell(INSTANCE, 0, REAL, N)
    assert (
        shown(put(N, Cell(FRAME, 0, DINT)), put(A, X), put(indexed, A), put(B, X), put(Y, B))[3] == "%2:REAL := D[0.0]"
    )
    port = Cell(Area.PERIPHERAL_INPUTS, 0, BOOL)
    mark = Cell(Area.MEMORY, 0, BOOL)
    assert shown(put(P, port), put(Q, port), put(mark, Q)) == ["%6:BOOL := PI[0.0]", "M[0.0]:BOOL := %6"]


def test_zeros_of_either_sign_are_not_the_same() -> None:
    body: list[Instruction] = [
        put(P, Cell(Area.MEMORY, 0, BOOL)),
        put(A, Literal(0.0, REAL)),
        Branch(HERE, P, "L1"),
        put(A, Literal(-0.0, REAL)),
        Label(HERE, "L1"),
        put(Y, A),
    ]
    assert shown(*body)[-1] == "D[4.0]:REAL := %1"


def test_branches_that_are_known() -> None:
    body: list[Instruction] = [
        put(P, Literal(True, BOOL)),
        compute(Q, "NOT", P),
        Branch(HERE, Q, "L1"),
        Jump(HERE, "L2"),
        Label(HERE, "L1"),
        put(Y, X),
        Label(HERE, "L2"),
    ]
    assert shown(*body) == ["jump L2", "L2:"]
    opposite: list[Instruction] = [
        put(P, Cell(Area.MEMORY, 0, BOOL)),
        compute(Q, "NOT", P),
        Branch(HERE, Q, "L1"),
        Label(HERE, "L1"),
    ]
    assert shown(*opposite)[1] == "if not %5 jump L1"


def test_a_loop_forgets_what_it_changes() -> None:
    one = Literal(1, DINT)
    counter = Cell(INSTANCE, 64, DINT)
    body: list[Instruction] = [
        put(N, Literal(0, DINT)),
        Label(HERE, "L1"),
        compute(N, "+", N, one),
        put(counter, N),
        compute(P, "<", N, Literal(5, DINT)),
        Branch(HERE, P, "L1"),
    ]
    assert shown(*body)[:3] == ["%4:DINT := 0", "L1:", "%4:DINT := %4 + 1"]


@pytest.mark.parametrize("seed", range(5))
def test_random_programs_before_and_after(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    random = Random(f"simplify {seed}")
    numbers = range(1, 31)
    source = SourceText("f.awl", "".join(program(random, number) for number in numbers) + calls(numbers))
    blocks = parse(source)
    short = Machine(s7_lowering.lower(blocks))
    monkeypatch.setattr(s7_lowering, "simplified", lambda function, _inverses: replace(function))
    plain = Machine(s7_lowering.lower(blocks))
    for machine in (short, plain):
        machine.call("OB1")
    for number in numbers:
        for name in (f"DB{number}", f"DB{number + TABLES}"):
            assert short.memory[name] == plain.memory[name]
    assert [fault.kind for fault in short.faults] == [fault.kind for fault in plain.faults]
    assert 2 * len(short.program.functions["FB1"].body) < len(plain.program.functions["FB1"].body)
