"""Variables by path, calls by name, faults with their place."""

from __future__ import annotations

import math

import pytest

from plcgen.errors import Fault, PlcgenError
from plcgen.plc.machine import Machine
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

TEXT = """FUNCTION FC1 : REAL
VAR_INPUT x : REAL; n : INT; END_VAR
BEGIN
  FC1 := x * n;
END_FUNCTION
FUNCTION_BLOCK FB100
VAR_INPUT
  setpoint : REAL := 1.5;
  index : INT := 1;
  limit : TIME := T#2s;
  letter : CHAR := 'a';
  place : STRING[6] := 'hoist';
  enable : BOOL;
END_VAR
VAR_OUTPUT
  ratio : REAL;
  list : ARRAY[1 .. 3] OF INT := 1, 2, 3;
  part : STRUCT level : REAL; raised : BOOL; END_STRUCT;
  leftover : REAL;
END_VAR
VAR_TEMP unwritten : REAL; END_VAR
BEGIN
  ratio := 1.0 / setpoint;
  list[index] := 7;
  leftover := unwritten;
END_FUNCTION_BLOCK
DATA_BLOCK DB100 FB100
BEGIN
  setpoint := 4.0;
END_DATA_BLOCK
"""


def machine(temp_fill: int = 0) -> Machine:
    source = SourceText("drive.scl", TEXT)
    return Machine(lower(parse(source, CLASSIC), CLASSIC), temp_fill)


def test_block_runs_on_its_instance() -> None:
    drive = machine()
    drive.call("FB100", instance="DB100")
    drive.call("fb100", instance="DB101")
    assert drive.variable("DB100.ratio").get() == 0.25
    assert drive.variable("DB101.ratio").get() == pytest.approx(1 / 1.5)
    assert drive.variable("DB100.list[1]").get() == 7


def test_function_takes_arguments() -> None:
    assert machine().call("FC1", arguments=(1.5, 4)) == 6.0


@pytest.mark.parametrize(
    ("path", "value", "type_name"),
    [
        ("DB100.setpoint", 2.5, "REAL"),
        ("db100.ENABLE", True, "BOOL"),
        ("DB100.part.level", -1.0, "REAL"),
        ("DB100.part.raised", True, "BOOL"),
        ("DB100.list[3]", -5, "INT"),
        ("DB100.limit", 1500, "TIME"),
        ("DB100.letter", "z", "CHAR"),
        ("DB100.place", "crane", "STRING[6]"),
        ("M10.3", True, "BOOL"),
        ("%MW20", 65535, "WORD"),
        ("QD4", 1, "DWORD"),
        ("IB0", 200, "BYTE"),
    ],
)
def test_variable_is_written_and_read(path: str, value: object, type_name: str) -> None:
    variable = machine().variable(path)
    variable.set(value)
    assert variable.get() == value
    assert type(variable.get()) is type(value)
    assert str(variable.type) == type_name


def test_real_variable_holds_32_bits() -> None:
    setpoint = machine().variable("DB100.setpoint")
    setpoint.set(0.1)
    assert setpoint.get() == 0.10000000149011612
    setpoint.set(1e300)
    assert setpoint.get() == math.inf


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("DB100.setpiont", "DB100.setpiont: FB100 has no member setpiont; did you mean setpoint?"),
        ("DB200.x", "no data block DB200.x; did you mean DB100?"),
        ("DB100.part", "DB100.part is a STRUCT; name one of its members"),
        ("DB100.list[4]", "DB100.list[4]: [4] is outside ARRAY[1..3] OF INT"),
        ("DB100.list[x]", "DB100.list[x]: [x] is outside ARRAY[1..3] OF INT"),
        ("DB100.enable[1]", "DB100.enable[1]: BOOL takes no index"),
        ("M10", "M10: a bit needs .0 to .7, B, W and D have none"),
    ],
)
def test_wrong_path_says_what_is_right(path: str, message: str) -> None:
    with pytest.raises(PlcgenError) as error:
        machine().variable(path)
    assert str(error.value) == message.replace("DB200.x;", "DB200;")


def test_value_must_fit() -> None:
    with pytest.raises(PlcgenError, match=r"^DB100\.index: 40000 is no INT$"):
        machine().variable("DB100.index").set(40000)


def test_character_must_fit_eight_bits() -> None:
    with pytest.raises(PlcgenError, match=r"^DB100\.letter: 'ж' is no CHAR$"):
        machine().variable("DB100.letter").set("ж")
    with pytest.raises(PlcgenError, match=r"^DB100\.place: 'ж' has a character that does not fit 8 bits$"):
        machine().variable("DB100.place").set("ж")


def test_arithmetic_event_is_recorded_and_the_run_goes_on() -> None:
    drive = machine()
    drive.variable("DB100.setpoint").set(0.0)
    drive.scan = 17
    drive.call("FB100", instance="DB100")
    assert [str(fault) for fault in drive.faults] == ["drive.scl:23:16: division by zero in FB100 at scan 17"]
    assert drive.variable("DB100.ratio").get() == math.inf
    assert drive.variable("DB100.list[1]").get() == 7


def test_index_outside_stops_with_its_place() -> None:
    drive = machine()
    drive.variable("DB100.index").set(11)
    drive.scan = 3
    with pytest.raises(Fault) as fault:
        drive.call("FB100", instance="DB100")
    assert str(fault.value) == (
        "drive.scl:24:8: FB100: array index 11 outside 1 .. 3 (scan 3)\n    list[index] := 7;\n         ^^^^^"
    )


@pytest.mark.parametrize(
    ("name", "instance", "message"),
    [
        ("FB10", "DB100", "no block FB10; did you mean FB100?"),
        ("FB100", None, "FB100 is an FB; name its instance data block"),
    ],
)
def test_wrong_call_says_what_is_right(name: str, instance: str | None, message: str) -> None:
    with pytest.raises(Fault) as fault:
        machine().call(name, instance)
    assert str(fault.value) == message


def test_unwritten_temporary_shows_the_fill() -> None:
    drive = machine(temp_fill=0x7F)
    drive.call("FB100", instance="DB100")
    assert drive.variable("DB100.leftover").get() == pytest.approx(3.3961514e38)


def test_machines_do_not_share_memory() -> None:
    first, second = machine(), machine()
    first.variable("DB100.setpoint").set(9.0)
    assert second.variable("DB100.setpoint").get() == 4.0
