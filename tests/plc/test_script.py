"""Inputs as the bytes that are written before calls."""

from __future__ import annotations

import struct

import pytest

from plcgen.plc.script import Place, Script, scripted
from plcgen.plc.types import BOOL, INT, REAL

PLACES = {"go": Place(0, 2, BOOL), "speed": Place(2, 0, REAL), "count": Place(6, 0, INT)}
STEPS = [({"go": 1.0, "speed": 0.1}, 3), ({"go": 0.0}, 1), ({}, 2), ({"speed": -7.5, "count": -2.0}, 4)]


@pytest.fixture(autouse=True)
def engine() -> None:
    """No program runs."""


def memories(script: Script, first: int) -> list[bytes]:
    """What every call finds in memory that was all ones."""
    memory, found = bytearray(b"\xff" * 12), []
    while script.calls:
        script.write(memory, first)
        found.append(bytes(memory[first:]))
        script = script.after(1)
    return found


@pytest.mark.parametrize("first", [0, 3])
def test_before_each_call_the_inputs_of_its_step_are_written(first: int) -> None:
    found = memories(scripted(STEPS, PLACES.__getitem__), first)
    assert len(found) == 10
    assert [memory[0] for memory in found] == [0xFF] * 3 + [0xFB] * 7
    assert {memory[1] for memory in found} == {0xFF}
    speeds = [struct.unpack(">f", memory[2:6])[0] for memory in found]
    assert speeds == [struct.unpack(">f", struct.pack(">f", 0.1))[0]] * 6 + [-7.5] * 4
    assert [struct.unpack(">h", memory[6:8])[0] for memory in found] == [-1] * 6 + [-2] * 4


@pytest.mark.parametrize("calls", range(11))
def test_what_is_left_goes_on_where_it_was_left(calls: int) -> None:
    script = scripted(STEPS, PLACES.__getitem__)
    left = script.after(calls)
    assert left.calls == 10 - calls
    rows = [row for row in script.rows.tolist() if row[0] >= calls]
    assert left.rows.tolist() == [[call - calls, *write] for call, *write in rows]


def test_no_inputs() -> None:
    script = scripted([({}, 5)], PLACES.__getitem__)
    assert (script.calls, len(script.rows), script.after(2).calls) == (5, 0, 3)
