"""Runs of FB, FC and OB from a file; values and periods as the command line spells them."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

import pytest

from plcgen.errors import PlcgenError
from plcgen.run import Order, Outcome, parse_period, run_file

SOURCE = """
FUNCTION FC1 : REAL
VAR_INPUT x : REAL; n : INT; END_VAR
VAR_OUTPUT half : REAL; END_VAR
VAR_IN_OUT sum : DINT; END_VAR
BEGIN
  half := x / 2.0;
  sum := sum + n;
  FC1 := x * x;
END_FUNCTION

FUNCTION_BLOCK FB1
VAR_INPUT
  on : BOOL; b : BYTE; w : WORD; i : INT; d : DINT; r : REAL; t : TIME; c : CHAR; s : STRING[5];
  list : ARRAY[1 .. 2] OF INT;
END_VAR
VAR_OUTPUT
  count : INT; sum : REAL;
END_VAR
BEGIN
  count := count + 1;
  sum := r + list[2];
END_FUNCTION_BLOCK

DATA_BLOCK DB7 FB1
BEGIN
  count := 40;
END_DATA_BLOCK

FUNCTION_BLOCK FB2
VAR_OUTPUT n : INT; END_VAR
BEGIN
  n := n + 1;
  WHILE n > 2 DO
    n := n + 0;
  END_WHILE;
END_FUNCTION_BLOCK

ORGANIZATION_BLOCK OB35
VAR_TEMP
  start : ARRAY[1 .. 20] OF BYTE;
END_VAR
BEGIN
  MW10 := MW10 + 1;
END_ORGANIZATION_BLOCK
"""


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "blocks.scl"
    path.write_text(SOURCE.replace("MW10 := MW10 + 1", "DB7.count := DB7.count + 1; M0.1 := NOT M0.1"))
    return path


def run(
    source: Path, block: str, scans: int, inputs: Sequence[tuple[str, str]] = (), watch: Sequence[str] = ()
) -> Outcome:
    return run_file(Order(source, block, scans, Fraction(1, 100), inputs, watch), lambda _text: None)


def rows(outcome: Outcome) -> list[str]:
    return outcome.trace.to_csv().split()


def test_fb_runs_on_the_instance_of_the_file(source: Path) -> None:
    assert rows(run(source, "fb1", 2, [("r", "1.5"), ("list[2]", "3")])) == [
        "scan,time,count,sum",
        "0,0,41,4.5",
        "1,0.01,42,4.5",
    ]


def test_fc_hands_its_results_on_to_the_next_scan(source: Path) -> None:
    assert rows(run(source, "FC1", 2, [("x", "3"), ("n", "5"), ("sum", "100")])) == [
        "scan,time,FC1,half,sum",
        "0,0,9,1.5,105",
        "1,0.01,9,1.5,110",
    ]


def test_ob_with_global_memory(source: Path) -> None:
    assert rows(run(source, "OB35", 2, [("DB7.count", "-2")], ["DB7.count", "M0.1"])) == [
        "scan,time,DB7.count,M0.1",
        "0,0,-1,1",
        "1,0.01,0,0",
    ]


def test_endless_loop_ends_the_run_and_keeps_the_rows_before(source: Path) -> None:
    outcome = run(source, "FB2", 5)
    assert rows(outcome) == ["scan,time,n", "0,0,1", "1,0.01,2"]
    (fault,) = outcome.faults
    assert "watchdog: too many loops and calls in one scan; is there a loop without end? (scan 2)" in fault
    assert "blocks.scl:34:3:" in fault


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("on", "TRUE", "1"),
        ("on", "0", "0"),
        ("b", "16#FF", "255"),
        ("w", "W#16#8201", "33281"),
        ("i", "-32768", "-32768"),
        ("d", "L#70000", "70000"),
        ("r", "1e-3", "0.001"),
        ("r", "nan", "nan"),
        ("t", "T#1s500ms", "1500"),
        ("c", "'A'", "65"),
    ],
)
def test_values_as_the_command_line_spells_them(source: Path, name: str, text: str, value: str) -> None:
    assert rows(run(source, "FB1", 1, [(name, text)], [name]))[1] == f"0,0,{value}"


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("on", "2", "--set on=2: no value of type BOOL; write true or false"),
        ("i", "32768", "--set i=32768: INT holds -32768 to 32767"),
        ("i", "1.5", "--set i=1.5: no value of type INT; write a whole number such as 12 or 16#FF"),
        ("r", "fast", "--set r=fast: no value of type REAL; write a number such as 1.5"),
        ("spd", "1", "FB1 has no variable spd; there is on, b, w, i, d, r, t, c, s, list, count, sum, DB7"),
        ("cuont", "1", "FB1 has no variable cuont; did you mean count?"),
        ("c", "ж", "--set c=ж: 'ж' does not fit CHAR (8 bits a character)"),
        ("s", "'ж'", "--set s='ж': 'ж' does not fit STRING[5] (8 bits a character)"),
        ("s", "hoists", "--set s=hoists: 6 characters, STRING[5] holds 5"),
        ("list[3]", "1", '"DB7".list[3]: [3] is outside ARRAY[1..2] OF INT'),
    ],
)
def test_wrong_inputs(source: Path, name: str, text: str, message: str) -> None:
    with pytest.raises(PlcgenError) as caught:
        run(source, "FB1", 1, [(name, text)])
    assert str(caught.value) == message


def test_unknown_block(source: Path) -> None:
    with pytest.raises(PlcgenError) as caught:
        run(source, "FB11", 1)
    assert str(caught.value) == f"{source}: no block FB11 to run; did you mean FB1?"


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("10ms", Fraction(1, 100)), ("0.01s", Fraction(1, 100)), ("T#500us", Fraction(1, 2000)), ("1min", Fraction(60))],
)
def test_periods(text: str, seconds: Fraction) -> None:
    assert parse_period(text) == seconds


@pytest.mark.parametrize("text", ["10", "0ms", "-1ms", "ms", "1h", ""])
def test_no_periods(text: str) -> None:
    with pytest.raises(PlcgenError) as caught:
        parse_period(text)
    assert str(caught.value) == f"--period {text}: no period; write a number above 0 with ms or s, such as 10ms"
