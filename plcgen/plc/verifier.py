"""Checks that core code is sound: types match rows and signatures, labels exist, registers are set before use.

Lowering ends with it. What it finds is a defect of a lowering, never of a user's source.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import reduce
from heapq import heappop, heappush
from operator import or_

from plcgen.plc.core import (
    FRAME,
    INSTANCE,
    Area,
    Branch,
    Call,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Program,
    Register,
    Return,
    print_instruction,
)
from plcgen.plc.types import BOOL, BYTE_BITS, DINT, Elementary, Type


class CoreError(Exception):
    """Core code that no engine could run."""


def verify(program: Program) -> Program:
    """The same program; raises CoreError with the function, the instruction and what is wrong."""
    for function in program.functions.values():
        labels = _labels(function)
        for instruction in function.body:
            for problem in _problems(program, function, labels, instruction):
                raise _broken(function, instruction, problem)
        _check_assigned(function, labels)
    return program


def _broken(function: Function, instruction: Instruction, problem: str) -> CoreError:
    return CoreError(f"{function.name}: {print_instruction(instruction).strip()}: {problem}")


def _labels(function: Function) -> dict[str, int]:
    labels: dict[str, int] = {}
    for position, instruction in enumerate(function.body):
        if isinstance(instruction, Label):
            if instruction.name in labels:
                raise _broken(function, instruction, "label stands twice")
            labels[instruction.name] = position
    return labels


# --------------------------------------------------------------------------------------- one instruction by itself


def _problems(program: Program, function: Function, labels: dict[str, int], instruction: Instruction) -> Iterator[str]:
    for operand in (*_reads(function, instruction), *_writes(instruction)):
        yield from _operand_problems(program, function, operand)
    match instruction:
        case Compute():
            yield from _compute_problems(instruction)
        case Jump(label=label) | Branch(label=label) if label not in labels:
            yield f"no label {label}"
        case Branch(condition=condition) if condition.type is not BOOL:
            yield f"condition is {condition.type}, not BOOL"
        case Call():
            yield from _call_problems(program, instruction)


def _compute_problems(instruction: Compute) -> Iterator[str]:
    operator = instruction.operator
    types = tuple(operand.type for operand in instruction.operands)
    if types != operator.operands:
        yield f"operands are {_names(types)}, the operator takes {_names(operator.operands)}"
    if instruction.target.type != operator.result:
        yield f"target is {instruction.target.type}, the operator gives {operator.result}"


def _call_problems(program: Program, call: Call) -> Iterator[str]:
    callee = program.functions.get(call.function)
    if callee is None:
        yield f"no function {call.function}"
        return
    if (call.instance.type if call.instance else None) != callee.instance:
        yield f"instance is {call.instance and call.instance.type}, the function has {callee.instance}"
    for what, given, wanted in (
        ("arguments", call.arguments, callee.parameters),
        ("results", call.results, callee.results),
    ):
        if [operand.type for operand in given] != [place.type for place in wanted]:
            yield f"{what} are {_names(o.type for o in given)}, the function has {_names(p.type for p in wanted)}"


def _operand_problems(program: Program, function: Function, operand: Operand) -> Iterator[str]:
    if isinstance(operand, Literal) and isinstance(operand.type, Elementary):
        try:
            operand.type.encode(operand.value)
        except Exception:
            yield f"{operand.value!r} is no {operand.type}"
    if not isinstance(operand, Cell):
        return
    if operand.index is not None and operand.index.type is not DINT:
        yield f"index is {operand.index.type}, not DINT"
    if operand.bit % operand.type.alignment % BYTE_BITS:
        yield f"{operand.type} does not start at a byte"
    room = _room(program, function, operand.area)
    if room is not None and not 0 <= operand.bit <= room * BYTE_BITS - operand.type.bits:
        yield f"{operand} lies outside the {room} bytes of {operand.area}"


def _room(program: Program, function: Function, area: Area | str) -> int | None:
    """Bytes of an area, None when its size belongs to the machine."""
    if area == FRAME:
        return function.frame_bytes
    if area == INSTANCE:
        return function.instance.bits // BYTE_BITS if function.instance else 0
    block = None if isinstance(area, Area) else program.data_blocks.get(area)
    return len(block.initial) if block else None


def _names(types: Iterable[Type]) -> str:
    return ", ".join(map(str, types)) or "none"


# ------------------------------------------------------------------------------------- registers along every path


def _reads(function: Function, instruction: Instruction) -> tuple[Operand, ...]:
    match instruction:
        case Compute(operands=operands):
            return operands
        case Branch(condition=condition):
            return (condition,)
        case Call(instance=instance, arguments=arguments):
            return (*arguments, instance) if instance else arguments
        case Return():
            return function.results
    return ()


def _writes(instruction: Instruction) -> tuple[Place, ...]:
    match instruction:
        case Compute(target=target):
            return (target,)
        case Call(results=results):
            return results
    return ()


def _registers_read(function: Function, instruction: Instruction) -> Iterator[Register]:
    for operand in _reads(function, instruction):
        if isinstance(operand, Register):
            yield operand
    for operand in (*_reads(function, instruction), *_writes(instruction)):
        if isinstance(operand, Cell) and operand.index is not None:
            yield operand.index


def _check_assigned(function: Function, labels: dict[str, int]) -> None:
    for position, assigned in _assigned(function, labels).items():
        for register in _registers_read(function, function.body[position]):
            if not assigned >> register.number & 1:
                raise _broken(function, function.body[position], f"{register} is read before it is set")


def _assigned(function: Function, labels: dict[str, int]) -> dict[int, int]:
    """For each instruction that is reached, the registers that are set on every way to it, a bit for each.

    Walks until nothing is lost any more; in the order of the text, so that without loops each instruction is met once,
    after all that jump to it.
    """
    body = function.body
    known = {0: _mask((*function.parameters, *function.temporaries))}
    pending, waiting = [0], {0}
    while pending:
        position = heappop(pending)
        waiting.remove(position)
        if position == len(body):
            raise CoreError(f"{function.name}: the end is reached without a return")
        after = known[position] | _mask(_writes(body[position]))
        for successor in _successors(body, position, labels):
            before = known.get(successor)
            known[successor] = after if before is None else after & before
            if known[successor] != before and successor not in waiting:
                heappush(pending, successor)
                waiting.add(successor)
    return known


def _mask(places: Iterable[Place]) -> int:
    return reduce(or_, (1 << place.number for place in places if isinstance(place, Register)), 0)


def _successors(body: tuple[Instruction, ...], position: int, labels: dict[str, int]) -> tuple[int, ...]:
    match body[position]:
        case Return():
            return ()
        case Jump(label=label):
            return (labels[label],)
        case Branch(label=label):
            return (labels[label], position + 1)
    return (position + 1,)
