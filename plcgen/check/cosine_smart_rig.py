"""A CPU with the cosine program of the S7-200 SMART, to drive sample by sample under the names of the SCL block."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from plcgen.check.played import Played
from plcgen.plc.core import Program
from plcgen.plc.cpu.smart import Smart
from plcgen.plc.machine import FaultRecord, Variable
from plcgen.plc.script import Place, Script
from plcgen.plc.stl.smart_memory import V
from plcgen.plc.types import BOOL, REAL, WORD, Elementary
from plcgen.trajectory import Trajectory

TICK = 10
"""Event of timed interrupt 0."""
FIRST_SCAN_US = 500
"""Shorter than any sample: MAIN runs once, and no tick with it."""


class Signal(NamedTuple):
    """Name in the memory map, and type."""

    name: str
    type: Elementary


COMMON = {
    "execute": Signal("execute", BOOL),
    "stop": Signal("stop", BOOL),
    "restart": Signal("restart", BOOL),
    "cycleTime": Signal("cycle_time", REAL),
}
INPUTS = {
    "centred": COMMON
    | {
        "hold": Signal("hold", BOOL),
        "targetVelocity": Signal("target_velocity", REAL),
        "actualVelocity": Signal("actual_velocity", REAL),
    },
    "half-sine": COMMON | {"distance": Signal("distance", REAL)},
}
OUTPUTS = {
    "velocitySetpoint": Signal("setpoint", REAL),
    "acceleration": Signal("acceleration", REAL),
    "busy": Signal("busy", BOOL),
    "done": Signal("done", BOOL),
    "commandAborted": Signal("aborted", BOOL),
    "error": Signal("error", BOOL),
    "steady": Signal("steady", BOOL),
    "standstill": Signal("standstill", BOOL),
    "status": Signal("status_word", WORD),
    "statVelocity": Signal("velocity", REAL),
}


def _place(address: str, kind: Elementary) -> Place:
    match = re.fullmatch(r"V[BWD]?(\d+)(?:\.([0-7]))?", address)
    assert match, address
    return Place(int(match[1]), int(match[2] or 0), kind)


class SmartAxis(Played):
    """The program after its first scan, in which MAIN calls Init. Inputs keep their value until they are set again.

    `addresses` is the memory map of the program, `kind` its shape, "centred" or "half-sine". `retained` is what every
    byte of its memory holds when the power comes.
    """

    def __init__(
        self,
        program: Program,
        addresses: Mapping[str, str],
        sample_period: float,
        kind: str,
        temp_fill: int = 0,
        retained: int = 0,
    ) -> None:
        self.sample_period = sample_period
        self.scans = 0
        self.cpu = Smart(program, FIRST_SCAN_US, temp_fill=temp_fill)
        signals = INPUTS[kind] | OUTPUTS
        self._places = {name: _place(addresses[signal.name], signal.type) for name, signal in signals.items()}
        outputs = [self._places[name] for name in OUTPUTS]
        self._recorded = range(min(place.byte for place in outputs), max(place.end for place in outputs))
        self._variables = {
            name: self.cpu.variable(addresses[signal.name], signal.type) for name, signal in signals.items()
        }
        self._records: list[bytes] = []
        self._retain(addresses, retained)
        self.cpu.scan()

    def _retain(self, addresses: Mapping[str, str], value: int) -> None:
        """From the first variable up to the ring, which is left to Init."""
        places = [int(re.sub(r"\D", "", address)) for address in addresses.values() if "." not in address]
        for byte in range(min(places), max(places)) if value else ():
            self.cpu.memory[V][byte] = value

    def variable(self, name: str) -> Variable:
        """An input or output by the name that the SCL block gives it."""
        return self._variables[name]

    def set(self, **inputs: float) -> None:
        """Set inputs."""
        for name, value in inputs.items():
            self._variables[name].set(value)

    def get(self, name: str) -> float:
        """An output after the last sample."""
        return float(self._variables[name].get())

    @property
    def faults(self) -> list[FaultRecord]:
        """Arithmetic events, after which a CPU leaves the operand as it was."""
        return self.cpu.faults

    def scan(self) -> None:
        """One tick of the timed interrupt."""
        self.samples(1)

    def _begin(self, script: Script, byte: int, mask: int) -> int:
        images = self.cpu.run_interrupts(TICK, script, self._recorded, byte, mask)
        self._records.append(images)
        ticks = len(images) // len(self._recorded)
        self.scans += ticks
        return ticks

    def _place(self, name: str) -> Place:
        byte, bit, kind = self._places[name]
        return Place(byte - self._recorded.start, bit, kind)

    def trace(self) -> Trajectory:
        """Every output and the speed before the average, in each sample; `time` is that of its tick."""
        size, data = len(self._recorded), b"".join(self._records)
        rows = len(data) // size
        columns = {"time": np.arange(self.scans - rows, self.scans) * self.sample_period}
        for name in OUTPUTS:
            place = self._places[name]
            dtype = np.dtype(">" + place.type.code)
            column = np.ndarray((rows,), dtype, data, place.byte - self._recorded.start, (size,))
            flag = place.type is BOOL
            columns[name] = (column >> place.bit & 1).astype(bool) if flag else column.astype(dtype.newbyteorder("="))
        return Trajectory(columns)
