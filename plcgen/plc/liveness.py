"""Drops what is computed for nobody: a walk backward, which knows at each place what registers are read later."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from plcgen.plc.core import (
    Branch,
    Call,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Operand,
    Register,
    Return,
)
from plcgen.plc.operators import Operator


def has_event(operator: Operator) -> bool:
    """Whether computing it may be noted or stop the run, so that it stays even when nobody reads the result."""
    return "{site}" in operator.text + operator.repair


def without_dead(function: Function) -> Function:
    """Without computations whose register nobody reads."""
    body = function.body
    labels = {item.name: position for position, item in enumerate(body) if isinstance(item, Label)}
    alive = [0] * (len(body) + 1)
    results = _mask(function.results)
    changed = True
    while changed:
        changed = False
        for position in range(len(body) - 1, -1, -1):
            before = _before(body[position], alive, position, labels, results)
            changed = changed or before != alive[position]
            alive[position] = before
    kept = (item for position, item in enumerate(body) if not _is_dead(item, alive[position + 1]))
    return replace(function, body=tuple(kept))


def _before(item: Instruction, alive: Sequence[int], position: int, labels: Mapping[str, int], results: int) -> int:
    """The registers that are read before they are set, from here on; a bit for each."""
    after = alive[position + 1]
    match item:
        case Jump(label=label):
            return alive[labels[label]]
        case Branch(label=label, condition=condition):
            return after | alive[labels[label]] | _mask((condition,))
        case Return():
            return results
        case Call(arguments=arguments, results=received, instance=instance):
            read = _mask(arguments) | _mask((instance,) if instance else ())
            return after & ~_written(received) | read | _indices(received)
        case Compute(target=target, operands=operands):
            if _is_dead(item, after):
                return after
            return after & ~_written((target,)) | _mask(operands) | _indices((target,))
    return after


def _is_dead(item: Instruction, after: int) -> bool:
    if not isinstance(item, Compute) or not isinstance(item.target, Register) or has_event(item.operator):
        return False
    return not after >> item.target.number & 1


def _mask(operands: Sequence[Operand]) -> int:
    return _written(operands) | _indices(operands)


def _written(operands: Sequence[Operand]) -> int:
    mask = 0
    for operand in operands:
        if isinstance(operand, Register):
            mask |= 1 << operand.number
    return mask


def _indices(operands: Sequence[Operand]) -> int:
    mask = 0
    for operand in operands:
        if isinstance(operand, Cell) and operand.index is not None:
            mask |= 1 << operand.index.number
    return mask
