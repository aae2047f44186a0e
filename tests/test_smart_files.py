"""Lint and run of .awl files of the S7-200 SMART by the command line."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from click.testing import CliRunner

from plcgen.cli import main
from plcgen.lint import lint_files

MAIN = """\
ORGANIZATION_BLOCK MAIN:OB1
BEGIN
Network 1
LD     First_Scan_On
MOVB   10, SMB34
ATCH   INT_0, 10
ENI
Network 2
LD     SM0.0
CALL   Double, VW0, VD4
=      Q0.0
END_ORGANIZATION_BLOCK
"""
DOUBLE = """\
SUBROUTINE_BLOCK Double:SBR0
VAR_INPUT
n : INT;
END_VAR
VAR_OUTPUT
twice : REAL;
END_VAR
BEGIN
Network 1
LD     SM0.0
ITD    n, AC0
DTR    AC0, twice
+R     twice, twice
END_SUBROUTINE_BLOCK
"""
TICK = """\
INTERRUPT_BLOCK INT_0:INT0
BEGIN
Network 1
LD     SM0.0
INCW   VW0
END_INTERRUPT_BLOCK
"""


def files(folder: Path, **texts: str) -> list[Path]:
    paths = [folder / f"{name}.awl" for name in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        path.write_bytes(text.replace("\n", "\r\n").encode())
    return paths


def found(paths: list[Path], target: str | None = None) -> list[str]:
    return [str(finding).replace(f"{paths[0].parent}{os.sep}", "") for finding in lint_files(paths, target)]


def run(path: Path, *arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(main, ["run", str(path), "--period", "10ms", *arguments])
    return result.exit_code, result.stdout, result.stderr.replace(str(path), path.name)


@pytest.fixture
def joined(tmp_path: Path) -> Path:
    return files(tmp_path, axis=MAIN + DOUBLE + TICK)[0]


LEFT_OUT = "in these files: Micro/WIN leaves the network out without an error"
LOCAL = "double.awl:3:1: warning: no export with local variables was seen, an import may drop them; use V memory"


def test_files_are_one_program(tmp_path: Path) -> None:
    paths = files(tmp_path, main=MAIN, double=DOUBLE, tick=TICK)
    assert found(paths) == [f"{LOCAL} [local-variable]"]
    assert found(paths, "s7-200-smart") == found(paths)
    assert found(paths[:1]) == [
        f"main.awl:6:8: error: no block INT_0 {LEFT_OUT}; name its file too [symbol]",
        f"main.awl:10:8: error: no block Double {LEFT_OUT}; name its file too [symbol]",
    ]


def test_errors_of_types_and_syntax(tmp_path: Path) -> None:
    paths = files(tmp_path, main=MAIN.replace("VW0, VD4", "VW0, VW4"), double=DOUBLE, tick=TICK.replace("VW0", "VB0"))
    assert [text.split(": ", 1)[1] for text in found(paths) if "[types]" in text] == [
        "error: VW4 is a word, a double word is wanted here [types]",
        "error: VB0 is a byte, a word is wanted here [types]",
    ]
    paths = files(tmp_path, main=MAIN.replace("BEGIN\n", ""))
    assert found(paths) == [
        "main.awl:2:1: error: BEGIN expected, found NETWORK; it stands between the declarations and the networks"
        " [syntax]"
    ]


def test_two_blocks_of_one_number(tmp_path: Path) -> None:
    paths = files(tmp_path, a=TICK, b=TICK)
    (finding,) = found(paths)
    assert finding.startswith("b.awl:1:1: error: INT0 stands in ")


def test_scl_beside_stl(tmp_path: Path) -> None:
    """Files of both languages in one call are told apart by what they look like."""
    scl = tmp_path / "fc.scl"
    scl.write_bytes(b"FUNCTION FC1 : VOID\r\nBEGIN\r\nEND_FUNCTION\r\n")
    assert found([scl, *files(tmp_path, tick=TICK)]) == []


def test_run_of_the_main_program(joined: Path) -> None:
    code, text, _ = run(joined, "--block", "MAIN", "--scans", "3", "--set", "VW0=5", "--watch", "VD4:REAL,VW0,Q0.0")
    assert (code, text.splitlines()) == (
        0,
        ["scan,time,VD4:REAL,VW0,Q0.0", "0,0,10,6,1", "1,0.01,12,7,1", "2,0.02,14,8,1"],
    )


def test_run_of_a_subroutine(joined: Path) -> None:
    code, text, _ = run(joined, "--block", "double", "--scans", "1", "--set", "n=21")
    assert (code, text.splitlines()) == (0, ["scan,time,twice", "0,0,42"])


def test_run_of_an_interrupt(joined: Path) -> None:
    code, text, _ = run(joined, "--block", "INT0", "--scans", "2", "--watch", "VW0")
    assert (code, text.splitlines()) == (0, ["scan,time,VW0", "0,0,1", "1,0.01,2"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--block", "SBR1", "--scans", "1"], "axis.awl: no block SBR1 to run; did you mean SBR0?"),
        (["--block", "x", "--scans", "1"], "axis.awl: no block x to run; there is OB1, SBR0, INT0"),
        (["--block", "MAIN", "--scans", "1", "--watch", "VX"], "no variable VX; write an address such as VD100"),
        (["--block", "MAIN", "--scans", "1", "--watch", "VD0:F"], "VD0:F: no type F; write one such as VD100:REAL"),
        (["--block", "MAIN", "--scans", "1", "--watch", "VD0:INT"], "VD0: VD0 is a double word, a word is wanted here"),
        (["--block", "MAIN", "--scans", "1", "--set", "VW0=70000"], "--set VW0=70000: INT holds -32768 to 32767"),
    ],
)  # fmt: skip
def test_bad_runs(joined: Path, arguments: list[str], message: str) -> None:
    assert run(joined, *arguments)[::2] == (2, f"error: {message}\n")


def test_faults_of_a_run(tmp_path: Path) -> None:
    body = "MOVD +100000, VD0\nINCW VW10\n+I +32767, VW10\nMOVB 16#E0, SMB67\nMOVW +100, SMW168\nPLS 0"
    (path,) = files(tmp_path, bad=MAIN.split("MOVB")[0] + body + "\nEND_ORGANIZATION_BLOCK\n")
    code, text, errors = run(path, "--block", "OB1", "--scans", "2", "--watch", "VW10")
    assert (code, text.splitlines()[-1]) == (1, "1,0.01,1")
    assert errors.splitlines() == [
        "fault: bad.awl:7:1: overflow in OB1 at scan 0",
        "    +I +32767, VW10",
        "    ^^^^^^^^^^^^^^^",
        "fault: Q0.0 at 0 us: profile table with 0 segments: no pulses",
    ]
