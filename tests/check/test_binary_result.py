"""The binary result behind a call, as a caller in LAD sees it."""

from __future__ import annotations

from plcgen.check.binary_result import binary_result
from plcgen.check.verdict import Check
from plcgen.loading import load

SOURCE = """FUNCTION_BLOCK FB 1
VERSION : 0.1
VAR_INPUT
  early : BOOL ;
  late : BOOL ;
END_VAR
BEGIN
NETWORK
TITLE =
      A     #early;
      JC    DONE;
      {end}
      SAVE  ;
DONE: NOP 0;
      BE    ;
END_FUNCTION_BLOCK
FUNCTION FC 1 : VOID
VERSION : 0.1
BEGIN
NETWORK
TITLE =
      BE    ;
END_FUNCTION
DATA_BLOCK DB 1
TITLE =
VERSION : 0.1
 FB 1
BEGIN
END_DATA_BLOCK
"""


def found_in(source: str) -> Check:
    return binary_result(load("s7-300-stl", {"a.awl": source.encode()}))


def test_a_block_that_ends_with_1() -> None:
    found = found_in(SOURCE.replace("JC    DONE", "NOP   0").format(end="SET   ;"))
    assert (found.ok, found.value, found.detail) == (True, 0.0, "")


def test_a_way_past_save() -> None:
    found = found_in(SOURCE.format(end="SET   ;"))
    assert (found.ok, found.detail) == (False, "FB1, early; FB1, late")


def test_a_block_that_ends_with_0() -> None:
    found = found_in(SOURCE.format(end="CLR   ;"))
    assert (found.ok, found.detail) == (False, "FB1, cold start; FB1, early; FB1, late")
