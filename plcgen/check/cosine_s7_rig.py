"""An FB of a cosine program for S7-300 or TIA, to drive sample by sample."""

from __future__ import annotations

from plcgen.check.rig import Instance
from plcgen.plc.core import Program
from plcgen.plc.engines import CallLoop
from plcgen.plc.types import BYTE_BITS


class S7Axis(Instance):
    """The FB on its instance DB. Inputs keep their value until they are set again."""

    def __init__(self, program: Program, block: str, instance: str, temp_fill: int = 0) -> None:
        super().__init__(program, block, instance, temp_fill)
        self._loop = self.machine.call_loop(block, instance)

    def samples(self, most: int, until: str = "") -> None:
        """Calls of the cyclic interrupt, up to one behind which the output `until` is TRUE."""
        end = self.scans + most
        byte, mask = self._bit(until) if until else (0, 0)
        while self.scans < end:
            if self._loop is None:
                self.scan()
            else:
                self._repeat(self._loop, end - self.scans, byte, mask)
            if until and self.get(until):
                return

    def _bit(self, output: str) -> tuple[int, int]:
        """Byte of the instance and mask."""
        structure = self.machine.program.functions[self.block].instance
        member = structure.member(output) if structure else None
        assert member is not None, output
        return member.bit // BYTE_BITS, 1 << member.bit % BYTE_BITS

    def _repeat(self, loop: CallLoop, most: int, byte: int, mask: int) -> None:
        """Some calls at once, just as `scan` makes them."""
        rows = loop.run(most, byte, mask)
        self.machine.scan = self.scans + rows - 1
        self.machine.settle(loop)
        self._images.append(loop.images[:rows].tobytes())
        self.scans += rows
