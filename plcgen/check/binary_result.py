"""The binary result of STL blocks: 1 behind a call, or LAD and FBD take the call as failed (ENO = 0)."""

from __future__ import annotations

from collections.abc import Iterator

from plcgen.check.verdict import Check
from plcgen.plc.core import DataBlock, Program
from plcgen.plc.machine import Machine
from plcgen.plc.stl.s7_registers import BR, CELLS, SHARED
from plcgen.plc.types import BOOL, BYTE_BITS


def binary_result(program: Program) -> Check:
    """Calls of an FB on its instance DB that end with BR = 0: a cold start, and one with each of its BOOL set.

    The FBs must tell BR, see `s7_lowering.lower`.
    """
    wrong = [f"{block.function}, {when}" for block in program.data_blocks.values() for when in _failing(program, block)]
    return Check("binary_result_zero", float(len(wrong)), 0.0, "1", detail="; ".join(wrong))


def _failing(program: Program, block: DataBlock) -> Iterator[str]:
    if block.function is None:
        return
    machine = Machine(program)
    if not _result(machine, block.function, block.name):
        yield "cold start"
    for member in block.type.fields:
        if member.type is BOOL:
            machine.variable(f'"{block.name}".{member.name}').set(True)
            if not _result(machine, block.function, block.name):
                yield member.name


def _result(machine: Machine, fb: str, db: str) -> bool:
    """BR behind a call of a block that found 0 in it."""
    byte, bit = divmod(CELLS[BR].bit, BYTE_BITS)
    machine.memory[SHARED][byte] = 0
    machine.call(fb, db)
    return bool(machine.memory[SHARED][byte] >> bit & 1)
