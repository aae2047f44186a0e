"""An FB of a cosine program for S7-300 or TIA, to drive sample by sample."""

from __future__ import annotations

from plcgen.check.played import Played
from plcgen.check.rig import Instance
from plcgen.plc.core import Program
from plcgen.plc.engines import CallLoop
from plcgen.plc.script import Place, Script
from plcgen.plc.types import BYTE_BITS, Elementary


class S7Axis(Instance, Played):
    """The FB on its instance DB. Inputs keep their value until they are set again."""

    def __init__(self, program: Program, block: str, instance: str, temp_fill: int = 0) -> None:
        super().__init__(program, block, instance, temp_fill)
        self._loop = self.machine.call_loop(block, instance)

    def _begin(self, script: Script, byte: int, mask: int) -> int:
        if self._loop is None:
            script.write(self._memory)
            self.scan()
            return 1
        return self._repeat(self._loop, script, byte, mask)

    def _place(self, name: str) -> Place:
        structure = self.machine.program.functions[self.block].instance
        member = structure.member(name) if structure else None
        assert member is not None and isinstance(member.type, Elementary), name
        return Place(*divmod(member.bit, BYTE_BITS), member.type)

    def _repeat(self, loop: CallLoop, script: Script, byte: int, mask: int) -> int:
        """Some calls at once, just as `scan` makes them."""
        rows = loop.run(script.calls, byte, mask, script.rows)
        self.machine.scan = self.scans + rows - 1
        self.machine.settle(loop)
        self._images.append(loop.images[:rows].tobytes())
        self.scans += rows
        return rows
