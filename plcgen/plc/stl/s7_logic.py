"""Bit logic of the S7-300: how instructions combine with the RLO.

`O` alone puts the AND before it aside in OR; each A behind it takes that in, so that the RLO is right at any time.
"""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.core import Operand, Place
from plcgen.plc.operators import resolve
from plcgen.plc.stl.s7_code import Bracket, Code
from plcgen.plc.stl.s7_operators import row
from plcgen.plc.stl.s7_registers import BR, FALSE, FC, OR, RLO, TRUE
from plcgen.plc.types import BOOL

MOST_BRACKETS = 7

AND, OR_, XOR, NOT = row("AND", BOOL, BOOL), row("OR", BOOL, BOOL), row("XOR", BOOL, BOOL), row("NOT", BOOL)
SELECT = resolve("SEL", (BOOL, BOOL, BOOL))
assert SELECT is not None

Combine = Callable[[Code, Operand], None]


def select(code: Code, condition: Operand, otherwise: Operand, chosen: Operand) -> Operand:
    assert SELECT is not None
    return code.compute(SELECT, condition, otherwise, chosen)


def and_(code: Code, bit: Operand) -> None:
    """A: RLO := RLO AND bit, the first one alone; an AND before O is taken in."""
    value = code.taken(bit)
    joined = select(code, FC, value, code.compute(AND, RLO, value))
    code.put(RLO, code.compute(OR_, OR, joined))
    code.put(FC, TRUE)


def or_(code: Code, bit: Operand) -> None:
    """O: RLO := RLO OR bit, the first one alone."""
    value = code.taken(bit)
    first = code.compute(OR_, OR, value)
    code.put(RLO, select(code, FC, first, code.compute(OR_, RLO, value)))
    code.put(FC, TRUE)
    code.put(OR, FALSE)


def xor_(code: Code, bit: Operand) -> None:
    """X: RLO := RLO XOR bit, the first one alone."""
    value = code.taken(bit)
    first = code.compute(OR_, OR, value)
    code.put(RLO, select(code, FC, first, code.compute(XOR, RLO, value)))
    code.put(FC, TRUE)
    code.put(OR, FALSE)


def inverted(combine: Combine) -> Combine:
    """AN, ON, XN"""
    return lambda code, bit: combine(code, code.negated(bit))


def and_before_or(code: Code) -> None:
    """O: the RLO goes into OR, another AND begins."""
    code.put(OR, select(code, FC, OR, RLO))
    code.put(FC, FALSE)


# -------------------------------------------------------------------------------------------------------- brackets


def open_bracket(code: Code) -> None:
    """A( and the like"""
    if len(code.brackets) == MOST_BRACKETS:
        raise code.error(f"more than {MOST_BRACKETS} brackets inside one another; use a variable for the inner ones")
    code.brackets.append(Bracket(code.statement, code.taken(RLO), code.taken(OR), code.taken(FC)))
    code.end_of_logic()


def close_bracket(code: Code) -> None:
    """): the RLO of the inside combines with that of before."""
    if not code.brackets:
        raise code.error(") without an open bracket; write A( or the like above it")
    bracket = code.brackets.pop()
    inside = code.taken(RLO)
    code.put(RLO, bracket.rlo)
    code.put(OR, bracket.disjunction)
    code.put(FC, bracket.first)
    COMBINATIONS[bracket.statement.mnemonic.rstrip("(")](code, inside)


COMBINATIONS: dict[str, Combine] = {
    "A": and_,
    "AN": inverted(and_),
    "O": or_,
    "ON": inverted(or_),
    "X": xor_,
    "XN": inverted(xor_),
}

# ----------------------------------------------------------------------------------------------------- what ends it


def assign(code: Code, target: Place) -> None:
    """=: bit := RLO"""
    code.put(target, RLO)
    code.end_of_logic()


def set_(code: Code, target: Place) -> None:
    """S: bit := 1 when the RLO is 1"""
    code.put(target, code.compute(OR_, target, RLO))
    code.end_of_logic()


def reset(code: Code, target: Place) -> None:
    """R: bit := 0 when the RLO is 1"""
    code.put(target, code.compute(AND, target, code.negated(RLO)))
    code.end_of_logic()


def constant(value: Operand) -> Callable[[Code], None]:
    """SET, CLR"""

    def emit(code: Code) -> None:
        code.put(RLO, value)
        code.end_of_logic()

    return emit


def negate(code: Code) -> None:
    """NOT"""
    code.put(RLO, code.negated(RLO))


def edge(rising: bool) -> Callable[[Code, Place], None]:
    """FP, FN: the bit keeps the RLO of the last time."""

    def emit(code: Code, memory: Place) -> None:
        before, now = code.taken(memory), code.taken(RLO)
        code.put(memory, now)
        changed = (now, code.negated(before)) if rising else (code.negated(now), before)
        code.put(RLO, code.compute(AND, *changed))
        code.put(FC, TRUE)
        code.put(OR, FALSE)

    return emit


def save(code: Code) -> None:
    """SAVE: BR := RLO"""
    code.put(BR, RLO)
