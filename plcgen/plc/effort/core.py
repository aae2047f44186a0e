"""Steps of the core, as a compiler of SCL would spell it for an S7-300: loads, operation, transfer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from plcgen.plc.core import (
    Branch,
    Call,
    Cell,
    Compute,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Program,
    Return,
)
from plcgen.plc.effort.steps import Routine, Routines, Step
from plcgen.plc.types import BOOL, FLOATS, Type

_RELATIONS = ("=", "<>", "<", "<=", ">", ">=")
_CHOICES = ("SEL", "MIN", "MAX", "LIMIT")
KINDS: Mapping[str, str] = {"SQRT": "root", "SIN": "sine", "MOD": "integer quotient"} | dict.fromkeys(
    ("COS", "TAN", "ASIN", "ACOS", "ATAN", "EXP", "EXPD", "LN", "LOG", "**"), "function"
)
"""Operators that have the same class for all types."""
REAL_KINDS: Mapping[str, str] = {"/": "real quotient", "NEG": "integer", "ABS": "integer"} | dict.fromkeys(
    ("ROUND", "TRUNC", "CEIL", "FLOOR"), "conversion"
)
INTEGER_KINDS: Mapping[str, str] = {"*": "integer product", "/": "integer quotient", "DIV": "integer quotient"}


def core_routines(program: Program) -> Routines:
    """The functions of a program, by their names."""
    return {
        name: Routine(function.source, tuple(map(_step, function.body))) for name, function in program.functions.items()
    }


def _step(instruction: Instruction) -> Step:
    span = instruction.span
    match instruction:
        case Label(name=name):
            return Step(span, label=name)
        case Jump(label=label, passes=passes):
            return Step(span, ("jump",), jump=label, goes_on=False, passes=passes)
        case Branch(condition=condition, label=label):
            return Step(span, (*_read(condition), "jump"), jump=label)
        case Call(function=function):
            return Step(span, tuple(_call(instruction)), call=function)
        case Return():
            return Step(span, ("return",), goes_on=False)
        case Compute():
            return Step(span, tuple(_compute(instruction)))


def _call(call: Call) -> Iterator[str]:
    yield "call"
    for operand in call.arguments:
        yield from (*_read(operand), "transfer")
    for place in call.results:
        yield from ("load", *_written(place))


def _compute(instruction: Compute) -> Iterator[str]:
    for operand in instruction.operands:
        yield from _read(operand)
    yield from _kinds(instruction.operator.name, instruction.operator.operands[0])
    yield from _written(instruction.target)


def _kinds(name: str, kind: Type) -> Iterator[str]:
    """Machine instructions between loads and transfer."""
    is_real = kind in FLOATS
    if name == "INDEX":
        yield from ("integer compare", "integer compare", "integer", "integer product", "load")
    elif name in _CHOICES:
        yield from ("real compare" if is_real else "integer compare", "jump", "jump")
    elif name in _RELATIONS:
        yield "bit" if kind is BOOL else "real compare" if is_real else "integer compare"
    elif "_TO_" in name:
        yield "conversion"
    elif kind is BOOL and name != "MOVE":
        yield "bit"
    elif name != "MOVE":
        yield KINDS.get(name) or (REAL_KINDS.get(name, "real") if is_real else INTEGER_KINDS.get(name, "integer"))


def _read(operand: Operand) -> Iterator[str]:
    if operand.type is BOOL:
        yield "bit"
    elif isinstance(operand, Literal) and operand.type.bits > 16:
        yield "constant"
    else:
        yield "load"
    if isinstance(operand, Cell) and operand.index is not None:
        yield "load"


def _written(place: Place) -> Iterator[str]:
    yield "bit" if place.type is BOOL else "transfer"
    if isinstance(place, Cell) and place.index is not None:
        yield "load"
