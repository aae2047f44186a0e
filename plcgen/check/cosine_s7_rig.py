"""An FB of a cosine program for S7-300 or TIA, to drive sample by sample."""

from __future__ import annotations

from collections.abc import Sequence

from plcgen.check.rig import Instance
from plcgen.plc.core import Program
from plcgen.plc.engines import CallLoop
from plcgen.plc.script import NO_SCRIPT, WORTH_A_SCRIPT, Place, Script, Step, scripted
from plcgen.plc.types import BOOL, BYTE_BITS, Elementary


class S7Axis(Instance):
    """The FB on its instance DB. Inputs keep their value until they are set again."""

    def __init__(self, program: Program, block: str, instance: str, temp_fill: int = 0) -> None:
        super().__init__(program, block, instance, temp_fill)
        self._loop = self.machine.call_loop(block, instance)

    def samples(self, most: int, until: str = "") -> None:
        """Calls of the cyclic interrupt, up to one behind which the output `until` is TRUE."""
        self._play(Script(NO_SCRIPT, most), until)

    def play(self, steps: Sequence[Step]) -> None:
        """Steps of inputs and the calls that follow."""
        if len(steps) >= WORTH_A_SCRIPT:
            self._play(scripted(steps, self._place))
            return
        for inputs, count in steps:
            self.set(**inputs)
            self.samples(count)

    def _play(self, script: Script, until: str = "") -> None:
        byte, bit, _ = self._place(until) if until else (0, 0, BOOL)
        while script.calls:
            first = self.scans
            if self._loop is None:
                script.write(self._memory)
                self.scan()
            else:
                self._repeat(self._loop, script, byte, 1 << bit if until else 0)
            if until and self.get(until):
                return
            script = script.after(self.scans - first)

    def _place(self, name: str) -> Place:
        """In the instance."""
        structure = self.machine.program.functions[self.block].instance
        member = structure.member(name) if structure else None
        assert member is not None and isinstance(member.type, Elementary), name
        return Place(*divmod(member.bit, BYTE_BITS), member.type)

    def _repeat(self, loop: CallLoop, script: Script, byte: int, mask: int) -> None:
        """Some calls at once, just as `scan` makes them."""
        rows = loop.run(script.calls, byte, mask, script.rows)
        self.machine.scan = self.scans + rows - 1
        self.machine.settle(loop)
        self._images.append(loop.images[:rows].tobytes())
        self.scans += rows
