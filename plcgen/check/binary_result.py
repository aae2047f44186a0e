"""The binary result of STL blocks: 1 behind a call, or LAD and FBD take the call as failed (ENO = 0)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from plcgen.check.verdict import Check
from plcgen.plc.machine import Machine
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_lowering import lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.stl.s7_syntax import Block
from plcgen.plc.types import BOOL

PROBE = """FUNCTION FC {number} : BOOL
VERSION : 0.1
BEGIN
NETWORK
TITLE =
      CLR   ;
      SAVE  ;
      CALL  {fb} , {db} ;
      A     BR;
      =     #RET_VAL;
      BE    ;
END_FUNCTION
"""


def binary_result(blocks: Sequence[Block]) -> Check:
    """Calls of an FB on its instance DB that end with BR = 0: a cold start, and one with each of its BOOL set."""
    owners = [(block.declaration.instance_of, block.name) for block in blocks]
    wrong = [f"{fb}, {when}" for fb, db in owners if fb is not None for when in _failing(blocks, fb, db)]
    return Check("binary_result_zero", float(len(wrong)), 0.0, "1", detail="; ".join(wrong))


def _failing(blocks: Sequence[Block], fb: str, db: str) -> Iterator[str]:
    taken = {block.name for block in blocks}
    name = next(name for number in range(1, len(blocks) + 2) if (name := f"FC{number}") not in taken)
    probe = parse(SourceText("probe.awl", PROBE.format(number=name[2:], fb=fb, db=db)))
    machine = Machine(lower([*blocks, *probe]))
    if not machine.call(name, arguments=[False]):
        yield "cold start"
    instance = machine.program.functions[fb].instance
    for member in instance.fields if instance else ():
        if member.type is BOOL:
            machine.variable(f'"{db}".{member.name}').set(True)
            if not machine.call(name, arguments=[False]):
                yield member.name
