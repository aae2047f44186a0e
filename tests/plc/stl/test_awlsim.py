"""Random programs on the engines of this interpreter and on awlsim, an independent simulator of S7-300 and S7-400 STL.

awlsim is free software under the GPL and serves as an oracle here; nothing of it is part of the package.

Where it is known to differ from an S7-300 the programs do not go:
* REAL results beyond the range: the largest number instead of infinity, no OV; denormal results are kept.
* x / -0.0 has the sign of x / 0.0, and 0.0 / 0.0 is no NaN. Divisors here are numbers other than zero.
* SIN, COS, TAN snap to 0 and 1 close to the axes. Angles here stay away from them.
* A shift or a rotation by more than the width counts as one by the width, which leaves another CC1 (SLW, SRW, SLD,
  SRD) or another result (RLD, RRD).
* A <>0 holds after a division by zero too, when both CC1 and CC0 are 1; JN does not jump then.
* STA, OR and /FC come with L STW, which an S7-300 loads as 0.
* A CALL out of an FB with a variable of its instance as parameter writes into the wrong data block; defaults of an FB
  do not reach its instances.
"""

from __future__ import annotations

import struct
from importlib.util import find_spec
from pathlib import Path
from random import Random
from typing import Any

import pytest

from plcgen.plc import engines
from plcgen.plc.core import Program
from plcgen.plc.machine import Machine
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_lowering import lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.types import BYTE_BITS
from tests.every_engine import QUICK, choose
from tests.plc.stl.s7_programs import TABLES, calls, program

BATCHES, PROGRAMS = 25, 80

STATUS_WORD = "stw"
STATUS_MASK = 0b1_1111_0010
"""An S7-300 loads /FC, STA and OR as 0; awlsim loads them as they are."""


def load(source: str) -> Any:
    core = pytest.importorskip("awlsim_loader.core", reason="awlsim is the oracle of this test: pip install awlsim")
    compiler = pytest.importorskip("awlsim_loader.awlcompiler")
    settings = pytest.importorskip("awlsim.common.cpuconfig")
    simulator = core.AwlSim()
    simulator.reset()
    cpu = simulator.getCPU()
    cpu.getSpecs().setNrAccus(2)
    cpu.getConf().setConfiguredMnemonics(settings.S7CPUConfig.MNEMONICS_EN)
    parser = compiler.AwlParser()
    parser.parseText(source)
    simulator.load(parser.getParseTree())
    simulator.build()
    simulator.startup()
    return simulator


def memory_of(simulator: Any) -> dict[str, bytes]:
    """Every data block after the run, instances and tables alike."""
    return {
        f"DB{db.index}": bytes(db.structInstance.memory.getDataBytes())
        for db in simulator.getCPU().allDBs()
        if db.structInstance
    }


def differences(machine: Machine, foreign: dict[str, bytes], number: int) -> list[str]:
    """Members of the two data blocks of a program that differ."""
    found = []
    for name in (f"DB{number}", f"DB{number + TABLES}"):
        ours, theirs = bytes(machine.memory[name]), foreign[name]
        for field in machine.program.data_blocks[name].type.fields:
            start, size = field.bit // BYTE_BITS, max(1, field.type.bits // BYTE_BITS)
            one, two = (data[start : start + size] for data in (ours, theirs))
            if field.name == STATUS_WORD:
                one, two = (struct.pack(">H", struct.unpack(">H", word)[0] & STATUS_MASK) for word in (one, two))
            if field.type.bits == 1:
                one, two = (bytes([data[0] >> field.bit % BYTE_BITS & 1]) for data in (one, two))
            if one != two:
                found.append(f"{name}.{field.name}: {one.hex()} here, {two.hex()} in awlsim")
    return found


@pytest.fixture
def engine() -> None:
    """These programs run on every engine that there is, in one test: to lower them takes longest."""


def contents(machine: Machine) -> dict[object, bytes]:
    return {area: bytes(data) for area, data in machine.memory.items()}


def ran(lowered: Program, engine: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> Machine:
    choose(engine, monkeypatch, folder)
    machine = Machine(lowered)
    machine.call("OB1")
    return machine


@pytest.mark.parametrize("batch", range(BATCHES))
def test_random_programs_leave_the_same_memory(batch: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """On both engines, with the same events; and in awlsim, where it is installed."""
    random = Random(batch)
    numbers = range(1, PROGRAMS + 1)
    texts = {number: program(random, number) for number in numbers}
    source = "".join(texts.values()) + calls(numbers)
    lowered = lower(parse(SourceText("random.awl", source)))
    plain = ran(lowered, engines.PLAIN, monkeypatch, tmp_path)
    for engine in QUICK if find_spec("numba") else ():
        other = ran(lowered, engine, monkeypatch, tmp_path)
        assert contents(plain) == contents(other)
        assert plain.faults == other.faults
    simulator = load(source)
    simulator.runCycle()
    foreign = memory_of(simulator)
    for number in numbers:
        assert not differences(plain, foreign, number), texts[number]
