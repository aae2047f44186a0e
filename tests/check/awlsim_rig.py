"""A function block in STL, executed by awlsim, beside the same block in SCL on our machine: both see the same inputs.

awlsim (PyPI, GPL-2+) is an interpreter of S7-300 STL that shares nothing with ours. It is used from outside only. It
ignores initial values in the declaration of an FB, which is why the instance DB has to give every value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Set
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import pytest

from plcgen.check.hoist_bench import Bench
from plcgen.check.rig import PERFECT, Clock, Encoder, Rig, Snapshot
from plcgen.plc.types import BYTE_BITS, REAL, Elementary, Field

CALLER = """
ORGANIZATION_BLOCK OB 1
BEGIN
NETWORK
TITLE =
      CALL FB {block} , DB {instance} ();
END_ORGANIZATION_BLOCK
"""


COMMANDS = ("enable", "directionUp", "stop", "reset", "restart")
INPUTS = frozenset((*COMMANDS, "actualTravel", "actualVelocity", "cycleTime", "lowerStop", "upperStop"))
Place = tuple[int, int, int]
"""Byte, bit and width in bits of a variable in a DB."""


class AwlsimBlock:
    """An FB and its instance DB in awlsim, by their numbers. Each cycle calls it once."""

    def __init__(self, sources: Iterable[str], block: int, instance: int, german: bool = False) -> None:
        self.instance = instance
        self._simulation = import_module("awlsim.core.main").AwlSim()
        self._simulation.reset()
        cpu = self._cpu = self._simulation.getCPU()
        languages = import_module("awlsim.common.cpuconfig").S7CPUConfig
        cpu.getSpecs().setNrAccus(2)
        cpu.getConf().setConfiguredMnemonics(languages.MNEMONICS_DE if german else languages.MNEMONICS_EN)
        for text in (*sources, CALLER.format(block=block, instance=instance)):
            parser = import_module("awlsim.awlcompiler").AwlParser()
            parser.parseText(text)
            self._simulation.load(parser.getParseTree())
        self._simulation.build()
        self._simulation.startup()
        self._data = next(data for data in cpu.allDBs() if data.index == instance)

    @property
    def image(self) -> bytes:
        """The instance DB."""
        return bytes(self._data.structInstance.memory.getDataBytes())

    @image.setter
    def image(self, data: bytes) -> None:
        area = import_module("awlsim.coreserver.memarea").MemoryArea
        for byte, (before, after) in enumerate(zip(self.image, data, strict=True)):
            if before != after:
                area(area.TYPE_DB, 0, self.instance, byte, 1, bytearray((after,))).writeToCpu(self._cpu)

    def place(self, name: str) -> Place:
        field = self._data.struct.getField(name)
        return field.offset.byteOffset, field.offset.bitOffset, field.bitSize

    @property
    def names(self) -> list[str]:
        """Variables of the DB."""
        return [field.name for field in self._data.struct.fields if field.name]

    def read(self, name: str) -> bytes:
        """The bytes of a variable, big-endian; one byte, 0 or 1, for a BOOL."""
        return _bits(self.image, self.place(name))

    def cycle(self) -> None:
        self._simulation.runCycle()

    def interrupt(self, number: int) -> None:
        """Run an OB: interrupts do not come by themselves here."""
        self._cpu._S7CPU__runOB(self._cpu.getOB(number))


class TwinError(AssertionError):
    """The two blocks part: the scan, and each variable with the bits of both."""


class TwinRig(Rig):
    """A rig that runs the SCL, with the STL at its side; after each scan every common variable must have equal bits.

    What is not a number has other bits in awlsim: it is equal to what is not a number.
    Equal setpoints move the plant alike, so the STL is in the same closed loop.
    """

    def __init__(self, twin: AwlsimBlock, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.twin = twin
        structure = self.machine.program.functions[self.block].instance
        assert structure is not None
        members = [(field.name, _place(field)) for field in structure.fields if isinstance(field.type, Elementary)]
        self._pairs = [(name, place, twin.place(name)) for name, place in members]
        self.compare()

    def scan(self) -> None:
        """One scan of both. The inputs are those that the rig has given to the SCL: the block does not write them."""
        super().scan()
        self._hand_over(INPUTS)
        self.twin.cycle()
        self.compare()

    def _closed_loop(self) -> None:
        """Every scan is compared."""

    def restore(self, moment: Snapshot) -> None:
        super().restore(moment)
        self._hand_over({name for name, _, _ in self._pairs})

    def _hand_over(self, names: Set[str]) -> None:
        """Set variables of the STL to what they are in the SCL."""
        ours, theirs = self.image, bytearray(self.twin.image)
        for name, own, other in self._pairs:
            if name in names:
                _copy(ours, own, theirs, other)
        self.twin.image = bytes(theirs)

    @property
    def image(self) -> bytes:
        return bytes(self.machine.memory[self.instance])

    def compare(self) -> None:
        """Raises TwinError."""
        if differences := list(self._differences()):
            raise TwinError(f"scan {self.scans}: " + "; ".join(differences))

    def _differences(self) -> Iterator[str]:
        ours, theirs = self.image, self.twin.image
        for name, own, other in self._pairs:
            left, right = _bits(ours, own), _bits(theirs, other)
            if left != right and not (_is_nan(left) and _is_nan(right)):
                yield f"{name} is {left.hex()} in SCL and {right.hex()} in STL"


@dataclass(frozen=True)
class TwinBench(Bench):
    """A bench whose rigs have twins: the trips of verification run on both."""

    twin: Callable[[], AwlsimBlock] = lambda: pytest.fail("no twin")

    def rig(self, travel: float, clock: Clock | None = None, encoder: Encoder = PERFECT) -> Rig:
        clock = clock or Clock(self.model.sample_period)
        parts = (self.program, self.block, self.instance, travel, clock, encoder, self.temp_fill)
        rig = TwinRig(self.twin(), *parts)
        if clock.period != self.model.sample_period:
            rig.set(cycleTime=clock.period)
        return rig


def _place(field: Field) -> Place:
    byte, bit = divmod(field.bit, BYTE_BITS)
    return byte, bit, field.type.bits


def _bits(image: bytes, place: Place) -> bytes:
    byte, bit, width = place
    return bytes([image[byte] >> bit & 1]) if width == 1 else image[byte : byte + width // BYTE_BITS]


def _is_nan(data: bytes) -> bool:
    """REAL is the only type of 32 bits in the block."""
    return len(data) == REAL.bits // BYTE_BITS and math.isnan(REAL.codec.unpack(data)[0])


def _copy(source: bytes, own: Place, target: bytearray, other: Place) -> None:
    value = _bits(source, own)
    byte, bit, width = other
    if width == 1:
        target[byte] = target[byte] & ~(1 << bit) | value[0] << bit
    else:
        target[byte : byte + len(value)] = value
