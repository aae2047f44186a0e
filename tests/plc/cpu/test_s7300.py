"""Restart, cycle and cyclic interrupt of an S7-300."""

from __future__ import annotations

from plcgen.plc.cpu.s7300 import S7300
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

TEXT = """DATA_BLOCK DB1
STRUCT
  restarts, cycles, ticks, period, first : INT;
  priority, number : BYTE;
END_STRUCT
BEGIN
END_DATA_BLOCK
ORGANIZATION_BLOCK OB1
VAR_TEMP class : BYTE; start : BYTE; rest : ARRAY[2 .. 19] OF BYTE; END_VAR
BEGIN
  DB1.cycles := DB1.cycles + 1;
  IF start = B#16#1 THEN DB1.first := DB1.first + 1; END_IF;
END_ORGANIZATION_BLOCK
ORGANIZATION_BLOCK OB35
VAR_TEMP
  OB35_EV_CLASS, OB35_STRT_INF, OB35_PRIORITY, OB35_OB_NUMBR, OB35_RESERVED_1, OB35_RESERVED_2 : BYTE;
  OB35_PHASE_OFFSET : WORD;
  OB35_RESERVED_3, OB35_EXC_FREQ : INT;
  OB35_DATE_TIME : DATE_AND_TIME;
END_VAR
BEGIN
  DB1.ticks := DB1.ticks + 1;
  DB1.period := OB35_EXC_FREQ;
  DB1.priority := OB35_PRIORITY;
  DB1.number := OB35_OB_NUMBR;
END_ORGANIZATION_BLOCK
ORGANIZATION_BLOCK OB100
VAR_TEMP info : ARRAY[0 .. 19] OF BYTE; END_VAR
BEGIN
  DB1.restarts := DB1.restarts + 1;
END_ORGANIZATION_BLOCK
"""


def cpu(text: str = TEXT) -> S7300:
    return S7300(lower(parse(SourceText("main.scl", text), CLASSIC), CLASSIC), ob35_period=10)


def counts(machine: S7300) -> list[int]:
    return [machine.variable(f"DB1.{name}").get() for name in ("restarts", "cycles", "ticks")]


def test_restart_runs_ob100_alone() -> None:
    machine = cpu()
    machine.startup()
    assert counts(machine) == [1, 0, 0]


def test_interrupt_comes_when_its_period_has_passed() -> None:
    machine = cpu()
    machine.startup()
    for _ in range(10):
        machine.cycle(4.0)
    assert counts(machine) == [1, 10, 4]
    assert machine.clock == 40.0
    assert machine.variable("DB1.first").get() == 1


def test_long_cycle_is_interrupted_more_than_once() -> None:
    machine = cpu()
    machine.cycle(35.0)
    assert counts(machine) == [0, 1, 3]


def test_interrupt_finds_its_header() -> None:
    machine = cpu()
    machine.tick()
    values = [machine.variable(f"DB1.{name}").get() for name in ("period", "priority", "number")]
    assert values == [10, 12, 35]
    assert machine.clock == 10.0


def test_each_tick_is_a_scan() -> None:
    machine = cpu()
    for _ in range(3):
        machine.tick()
    assert (machine.scan, machine.clock) == (3, 30.0)


def test_overrun_is_recorded_and_swallows_ticks() -> None:
    machine = cpu()
    machine.tick(duration=25.0)
    machine.tick()
    assert [fault.kind for fault in machine.faults] == ["overrun"]
    assert (counts(machine)[2], machine.clock) == (2, 40.0)


def test_missing_blocks_are_skipped() -> None:
    machine = cpu("FUNCTION FC1 : VOID\nBEGIN\n;\nEND_FUNCTION\n")
    machine.startup()
    machine.cycle(50.0)
    assert machine.faults == []
