"""Lint of files: one program over all of them, the target's rules, and an error a block."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from plcgen.errors import PlcgenError
from plcgen.lint import lint_files

FC = """
FUNCTION FC1 : REAL
VAR_INPUT x : REAL; END_VAR
BEGIN
  FC1 := x * 2.0;
END_FUNCTION
"""
CALLER = """
FUNCTION_BLOCK FB1
VAR_OUTPUT y : REAL; n : INT; END_VAR
BEGIN
  y := FC1(x := 1.0);
END_FUNCTION_BLOCK
"""


def found(folder: Path, target: str | None = None, **texts: str) -> list[str]:
    """Findings as `file:line:column: severity: message [rule]` without the folder."""
    paths = []
    for name, text in texts.items():
        path = folder / f"{name}.scl"
        path.write_bytes(text.replace("\n", "\r\n").encode())
        paths.append(path)
    return [str(finding).replace(f"{folder}{os.sep}", "") for finding in lint_files(paths, target)]


def test_files_of_one_dialect_are_one_program_whatever_their_order(tmp_path: Path) -> None:
    assert found(tmp_path, caller=CALLER, callee=FC) == []
    assert found(tmp_path, caller=CALLER) == [
        "caller.scl:5:8: error: unknown block or function FC1; did you mean FB1? [types]"
    ]


def test_one_type_error_for_each_block(tmp_path: Path) -> None:
    bad = CALLER.replace("FC1(x := 1.0)", "n AND y")
    assert [text.split(": ", 1)[0] for text in found(tmp_path, a=bad + bad.replace("FB1", "FB2"))] == [
        "a.scl:5:10",
        "a.scl:11:10",
    ]


def test_an_error_in_an_interface_is_told_once(tmp_path: Path) -> None:
    bad = FC.replace("x : REAL;", "x : REAL; X : REAL;")
    assert found(tmp_path, a=bad) == ["a.scl:3:21: error: X is declared twice [types]"]


def test_a_file_that_does_not_parse_hides_the_types_of_the_others(tmp_path: Path) -> None:
    findings = found(tmp_path, caller=CALLER, callee=FC.replace("2.0;", "2.0"))
    assert len(findings) == 1
    assert findings[0].startswith("callee.scl:5:17: error: ; expected before END_FUNCTION")
    assert findings[0].endswith("[syntax]")


def test_rules_of_a_target(tmp_path: Path) -> None:
    tia = FC.replace("FC1", '"Twice"').replace('"Twice" := x', "#Twice := #x").replace("REAL", "Real")
    assert found(tmp_path, "tia-scl", a=tia) == [
        "a.scl:1:1: warning: no byte order mark, TIA may read another code page; save as UTF-8 with BOM"
        " [byte-order-mark]"
    ]
    rules = {text.rsplit("[")[-1] for text in found(tmp_path, "s7-300-scl", a=tia)}
    assert rules == {"local-prefix]", "quoted-name]"}


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(PlcgenError, match=r"absent\.scl"):
        lint_files([tmp_path / "absent.scl"])
