"""Steps of S7-200 SMART STL: one for each statement. A box that gets no power costs nothing; here all do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from plcgen.plc.effort.steps import Routine, Routines, Step
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.smart_costs import CLASSES
from plcgen.plc.stl.syntax import Block, BlockKind, Constant, Name, Statement

OPCODE, OPERAND = 2, 3
"""Bytes of code: no manual says; taken as in the S7-200."""


def smart_routines(blocks: Sequence[Block]) -> Routines:
    """The blocks of a program by absolute name: OB1, SBR0, INT0."""
    names = Names(blocks, {})
    return {name: Routine(block.source, tuple(_steps(block, names))) for name, block in names.blocks.items()}


def code_bytes(blocks: Sequence[Block]) -> int:
    """Of all blocks together."""
    return sum(OPCODE + OPERAND * len(statement.operands) for block in blocks for statement in _statements(block))


def _statements(block: Block) -> Iterator[Statement]:
    return (statement for network in block.networks for statement in network.statements)


def _steps(block: Block, names: Names) -> Iterator[Step]:
    loops: list[Statement] = []
    for statement in _statements(block):
        word, work = statement.mnemonic, (CLASSES[statement.mnemonic],)
        if word == "FOR":
            loops.append(statement)
            yield Step(statement.span, work, label=_label(statement))
        elif word == "NEXT":
            begin = loops.pop()
            yield Step(statement.span, work, jump=_label(begin), passes=_passes(begin))
        elif word == "LBL":
            yield Step(statement.span, work, label=_number(statement))
        elif word == "JMP":
            yield Step(statement.span, work, jump=_number(statement))
        else:
            yield Step(statement.span, work, call=_callee(statement, names))


def _label(begin: Statement) -> str:
    return f"FOR at {begin.span.start}"


def _passes(begin: Statement) -> int | None:
    first, last = begin.operands[1:3]
    if isinstance(first, Constant) and isinstance(last, Constant):
        return max(0, int(last.value) - int(first.value) + 1)
    return None


def _number(statement: Statement) -> str | None:
    number = statement.operands[0]
    return str(int(number.value)) if isinstance(number, Constant) else None


def _callee(statement: Statement, names: Names) -> str | None:
    called = statement.operands[0] if statement.mnemonic == "CALL" and statement.operands else None
    return names.block(called.text, BlockKind.SUBROUTINE) if isinstance(called, Name) else None
