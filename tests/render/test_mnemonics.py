"""German mnemonics: instructions and addresses are translated, and nothing else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from plcgen.render.files import template_folder
from plcgen.render.mnemonics import ADDRESSES, INSTRUCTIONS, to_german

FRAME = "FUNCTION FC 1 : VOID\nVAR_TEMP\n  A : BOOL;  // JU\nEND_VAR\nBEGIN\nNETWORK\n{}\nEND_FUNCTION\n"


def german(line: str) -> str:
    return to_german(FRAME.format(line)).split("\n")[6]


@pytest.mark.parametrize(
    ("english", "expected"),
    [
        ("      A     #a;", "      U     #a;"),
        ("      AN    I 0.0;", "      UN    E 0.0;"),
        ("      A(    ;", "      U(    ;"),
        ("      ON    #stop;", "      ON    #stop;"),
        ("      =     Q 4.0;                   // to Q 4.0", "      =     A 4.0;                   // to Q 4.0"),
        ("      JC    M001;                    // JC here", "      SPB   M001;                    // JC here"),
        ("M001: JCN   M002;", "M001: SPBN  M002;"),
        ("A:    JU    JU;", "A:    SPA   JU;"),
        ("      JNBI  M001;", "      SPBIN M001;"),
        ("      JCN M001; // one blank", "      SPBN M001; // one blank"),
        ("      L     PIW 256;", "      L     PEW 256;"),
        ("      L     ID [AR1,P#0.0];", "      L     ED [AR1,P#0.0];"),
        ("      L     MD 20;", "      L     MD 20;"),
        ("      L     DB10.DBW 2;", "      L     DB10.DBW 2;"),
        ("      L     W#16#C000;", "      L     W#16#C000;"),
        ("      L     C 5;", "      L     Z 5;"),
        ("      L     #I;", "      L     #I;"),
        ('      L     "Q 1";', '      L     "Q 1";'),
        ("      A     BR;", "      U     BIE;"),
        ("      SE    T 1;", "      SV    T 1;"),
        ("      SD    T 1;", "      SE    T 1;"),
        ("      CU    C 1;", "      ZV    Z 1;"),
        ("      OPN   DB 5;", "      AUF   DB 5;"),
        ("      BEC   ;", "      BEB   ;"),
        ("      +R    ;", "      +R    ;"),
        ("      /R    ;", "      /R    ;"),
        ("      LOOP  M001;", "      LOOP  M001;"),
        ("      CALL FB 100 , DB 100 (", "      CALL FB 100 , DB 100 ("),
        ("           start            := I 0.0,", "           start            := E 0.0,"),
        ("           I                := #Q);", "           I                := #Q);"),
        ("// A     I 0.0", "// A     I 0.0"),
        ("TITLE =A JU B", "TITLE =A JU B"),
        ("NETWORK", "NETWORK"),
        ("", ""),
    ],
)
def test_line(english: str, expected: str) -> None:
    assert german(english) == expected


def test_what_is_no_code_stays() -> None:
    text = FRAME.format("      A     #a;")
    changed = [(a, b) for a, b in zip(text.split("\n"), to_german(text).split("\n"), strict=True) if a != b]
    assert changed == [("      A     #a;", "      U     #a;")]


def test_data_block_stays() -> None:
    values = "  I := TRUE;\n  A := W#16#C0;\n  C := -1.500000e+000;\n"
    text = f"DATA_BLOCK DB 1\nTITLE =A\n FB 1\nBEGIN\n{values}END_DATA_BLOCK\n"
    assert to_german(text) == text


def test_no_two_words_become_one() -> None:
    for table in (INSTRUCTIONS, ADDRESSES):
        assert len(set(table.values())) == len(table)


@pytest.mark.parametrize("path", sorted(template_folder().glob("s7-300-stl/*/*.awl")), ids=lambda path: path.name)
def test_templates_hold_one_instruction_a_line(path: Path) -> None:
    """What the translation relies on."""
    for line in path.read_text("utf-8").split("\n"):
        code = re.sub(r"//.*|TITLE.*|\{[{%].*?[%}]\}", "", line)
        assert code.count(";") <= 1, line
