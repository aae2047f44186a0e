"""Lint and run of STL sources of STEP 7 V5 by the command line."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from click.testing import CliRunner

from plcgen.cli import main
from plcgen.lint import lint_files
from plcgen.plc.source import SourceText
from plcgen.plc.stl.detection import is_s7_stl, is_smart

FUNCTION = """\
FUNCTION FC 1 : INT
TITLE =twice
VERSION : 0.1
VAR_INPUT
  a : INT ;
END_VAR
VAR_OUTPUT
  peak : INT ;
END_VAR
BEGIN
NETWORK
TITLE =
      L     #a;
      L     #a;
      +I    ;
      T     #RET_VAL;
      L     #peak;
      >I    ;
      JC    M001;
      L     #a;
      T     #peak;
M001: NOP   0;
END_FUNCTION
"""
BLOCK = """\
FUNCTION_BLOCK FB 1
TITLE =counter
VERSION : 0.1
VAR_INPUT
  step : INT ;
END_VAR
VAR_OUTPUT
  sum : REAL ;
END_VAR
BEGIN
NETWORK
TITLE =
      L     #step;
      ITD   ;
      DTR   ;
      L     #sum;
      +R    ;
      T     #sum;
END_FUNCTION_BLOCK
DATA_BLOCK DB 1
TITLE =
VERSION : 0.1
FB 1
BEGIN
  step := 2;
  sum := 1.000000e+001;
END_DATA_BLOCK
"""


def files(folder: Path, **texts: str) -> list[Path]:
    paths = [folder / f"{name}.awl" for name in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        path.write_bytes(text.replace("\n", "\r\n").encode())
    return paths


def found(paths: list[Path]) -> list[str]:
    return [str(finding).replace(f"{paths[0].parent}{os.sep}", "") for finding in lint_files(paths)]


def run(path: Path, *arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["run", str(path), "--period", "10ms", *arguments])
    return result.exit_code, result.stdout, result.stderr.replace(str(path), path.name)


def test_clean_files(tmp_path: Path) -> None:
    assert found(files(tmp_path, function=FUNCTION, block=BLOCK)) == []


def test_one_type_error_for_each_block(tmp_path: Path) -> None:
    bad = BLOCK.replace("#step;", "#stp;").replace("DTR", "DTX")
    assert found(files(tmp_path, function=FUNCTION.replace("M001;", "M002;"), block=bad)) == [
        "function.awl:19:13: error: no label M002 in FC1; did you mean M001? [types]",
        "block.awl:13:13: error: stp is not declared; did you mean step? [types]",
    ]


def test_syntax_hides_types(tmp_path: Path) -> None:
    assert found(
        files(tmp_path, function=FUNCTION.replace("NOP   0;", "NOP   0"), block=BLOCK.replace("#step", "#s"))
    ) == ["function.awl:22:14: error: ; expected at the end of the instruction [syntax]"]


def test_fb_runs_on_the_instance_of_the_file(tmp_path: Path) -> None:
    (path,) = files(tmp_path, block=BLOCK)
    assert run(path, "--block", "FB1", "--scans", "2", "--set", "step=3") == (
        0,
        "scan,time,sum\n0,0,13\n1,0.01,16\n",
        "",
    )


def test_fc_keeps_an_output_that_it_does_not_write(tmp_path: Path) -> None:
    (path,) = files(tmp_path, function=FUNCTION)
    arguments = ("--block", "FC1", "--scans", "1", "--set", "a=5")
    assert run(path, *arguments, "--set", "peak=7")[1] == "scan,time,FC1,peak\n0,0,10,7\n"
    assert run(path, *arguments, "--set", "peak=12")[1] == "scan,time,FC1,peak\n0,0,10,5\n"


def test_a_name_that_is_not_there(tmp_path: Path) -> None:
    (path,) = files(tmp_path, block=BLOCK)
    code, _, errors = run(path, "--block", "FB1", "--scans", "1", "--watch", "smu")
    assert code == 2
    assert "FB1 has no variable smu; did you mean sum?" in errors


@pytest.mark.parametrize(
    ("name", "text", "s7", "smart"),
    [
        ("a.awl", BLOCK, True, False),
        ("a.txt", BLOCK, True, False),
        ("a.awl", "DATA_BLOCK DB 1\nSTRUCT\na : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n", True, False),
        ("a.awl", "ORGANIZATION_BLOCK OB 1\nBEGIN\nEND_ORGANIZATION_BLOCK\n", True, False),
        ("a.awl", 'ORGANIZATION_BLOCK "Cycle"\nBEGIN\nNETWORK\nEND_ORGANIZATION_BLOCK\n', True, False),
        ("a.awl", "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nEND_ORGANIZATION_BLOCK\n", False, True),
        ("a.awl", "SUBROUTINE_BLOCK x:SBR0\nBEGIN\nEND_SUBROUTINE_BLOCK\n", False, True),
        ("a.awl", "nothing of either", False, True),
        ("a.scl", "FUNCTION_BLOCK FB1\nBEGIN\nEND_FUNCTION_BLOCK\n", False, False),
    ],
)
def test_detection(name: str, text: str, s7: bool, smart: bool) -> None:
    source = SourceText(name, text)
    assert (is_s7_stl(source), is_smart(source)) == (s7, smart)
