"""The printer, and the verifier on core that is broken in one place."""

from __future__ import annotations

from time import perf_counter

import pytest

from plcgen.plc.core import (
    FRAME,
    INSTANCE,
    Branch,
    Call,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Program,
    Register,
    Return,
    print_program,
)
from plcgen.plc.layout import Member, arrange
from plcgen.plc.operators import Operator, move, resolve
from plcgen.plc.source import SourceText, Span
from plcgen.plc.types import BOOL, DINT, INT, REAL, Type
from plcgen.plc.verifier import CoreError, verify

HERE = Span(0, 1)
SOURCE = SourceText("core.scl", "x")
DATA = arrange("FB1", [[Member("a", REAL), Member("b", BOOL)]])
A, B = Cell(INSTANCE, 0, REAL), Cell(INSTANCE, 32, BOOL)
X, Y, N = Register(1, REAL, "x"), Register(2, REAL), Register(3, INT, "n")
STEP = Function("FC1", SOURCE, (Compute(HERE, Y, move(REAL), (X,)), Return(HERE)), HERE, None, (X,), (Y,))


def row(symbol: str, *types: Type) -> Operator:
    operator = resolve(symbol, types)
    assert operator is not None
    return operator


def program(*body: Instruction) -> Program:
    function = Function("FB1", SOURCE, body, HERE, DATA, frame_bytes=4)
    return Program({"FB1": function, "FC1": STEP})


def add(target: Register | Cell, *operands: Register | Cell | Literal) -> Compute:
    return Compute(HERE, target, row("+", REAL, REAL), operands)


def test_core_prints_as_text() -> None:
    body = (
        add(Y, A, Literal(1.5, REAL)),
        Call(HERE, "FC1", None, (Y,), (X,)),
        Branch(HERE, B, "L1", when=False),
        Compute(HERE, A, row("SEL", BOOL, REAL, REAL), (B, X, Y)),
        Label(HERE, "L1"),
        Return(HERE),
    )
    assert print_program(verify(program(*body))) == (
        "FB1:\n"
        "    %2:REAL := D[0.0] + 1.5\n"
        "    #x := call FC1(%2)\n"
        "    if not D[4.0] jump L1\n"
        "    D[0.0]:REAL := SEL(D[4.0], #x, %2)\n"
        "L1:\n"
        "    return\n"
        "\n"
        "FC1(#x:REAL) -> (%2:REAL):\n"
        "    %2:REAL := #x\n"
        "    return"
    )


END = Return(HERE)


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        (
            (add(Y, A, Literal(1, INT)), END),
            "%2:REAL := D[0.0] + 1: operands are REAL, INT, the operator takes REAL, REAL",
        ),
        ((add(N, A, A), END), "#n:INT := D[0.0] + D[0.0]: target is INT, the operator gives REAL"),
        ((add(Y, X, A), END), "%2:REAL := #x + D[0.0]: #x is read before it is set"),
        ((Jump(HERE, "L9"), END), "jump L9: no label L9"),
        ((Label(HERE, "L1"), Label(HERE, "L1"), END), "L1:: label stands twice"),
        ((Branch(HERE, A, "L1"), Label(HERE, "L1"), END), "if D[0.0] jump L1: condition is REAL, not BOOL"),
        ((Call(HERE, "FC9"), END), "call FC9(): no function FC9"),
        (
            (Call(HERE, "FC1", None, (B,), (Y,)), END),
            "%2 := call FC1(D[4.0]): arguments are BOOL, the function has REAL",
        ),
        ((Call(HERE, "FC1", None, (A,)), END), "call FC1(D[0.0]): results are none, the function has REAL"),
        ((Call(HERE, "FB1"), END), "call FB1(): instance is None, the function has FB1"),
        (
            (add(Cell(INSTANCE, 32, REAL), A, A), END),
            "D[4.0]:REAL := D[0.0] + D[0.0]: D[4.0] lies outside the 6 bytes of D",
        ),
        (
            (add(Cell(FRAME, 8, REAL), A, A), END),
            "L[1.0]:REAL := D[0.0] + D[0.0]: L[1.0] lies outside the 4 bytes of L",
        ),
        ((add(Cell(FRAME, 1, REAL), A, A), END), "L[0.1]:REAL := D[0.0] + D[0.0]: REAL does not start at a byte"),
        ((Compute(HERE, N, move(INT), (Literal(40000, INT),)), END), "#n:INT := 40000: 40000 is no INT"),
        ((add(Cell(FRAME, 0, REAL, N), A, A), END), "L[0.0 + #n]:REAL := D[0.0] + D[0.0]: index is INT, not DINT"),
        (
            (
                Branch(HERE, B, "L1"),
                Compute(HERE, X, move(REAL), (A,)),
                Label(HERE, "L1"),
                Compute(HERE, A, move(REAL), (X,)),
                END,
            ),
            "D[0.0]:REAL := #x: #x is read before it is set",
        ),
    ],
)
def test_broken_core_is_refused(body: tuple[Instruction, ...], problem: str) -> None:
    with pytest.raises(CoreError) as broken:
        verify(program(*body))
    assert str(broken.value) == f"FB1: {problem}"


def test_end_without_return_is_refused() -> None:
    with pytest.raises(CoreError, match=r"^FB1: the end is reached without a return$"):
        verify(program(Compute(HERE, A, move(REAL), (A,))))


def test_index_must_be_set_too() -> None:
    index = Register(9, DINT)
    with pytest.raises(CoreError, match="%9 is read before it is set"):
        verify(program(Compute(HERE, Cell(FRAME, 0, REAL, index), move(REAL), (A,)), END))


def test_result_must_be_set_on_every_path() -> None:
    function = Function("FC2", SOURCE, (END,), HERE, results=(Y,))
    with pytest.raises(CoreError, match="FC2: return: %2 is read before it is set"):
        verify(Program({"FC2": function}))


def test_long_bodies_are_checked_in_time_that_grows_with_their_length() -> None:
    """A long IF-ELSIF chain: every branch joins the others at the end."""
    chain: list[Instruction] = []
    for number in range(3000):
        value = Register(100 + number, REAL)
        chain += [Compute(HERE, value, move(REAL), (A,)), Branch(HERE, B, f"L{number}")]
        chain += [Compute(HERE, A, move(REAL), (value,)), Jump(HERE, "end"), Label(HERE, f"L{number}")]
    start = perf_counter()
    verify(program(*chain, Label(HERE, "end"), END))
    assert perf_counter() - start < 5.0


def test_loop_that_sets_before_it_reads_is_sound() -> None:
    body = (
        Label(HERE, "L1"),
        Compute(HERE, X, move(REAL), (A,)),
        Branch(HERE, B, "L1"),
        Compute(HERE, A, move(REAL), (X,)),
        END,
    )
    verify(program(*body))
