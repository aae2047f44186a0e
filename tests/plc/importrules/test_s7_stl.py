"""Each import rule of STL for STEP 7 V5: what it rejects, word for word, and what it lets pass."""

from __future__ import annotations

import pytest

from plcgen.plc.importrules.finding import Finding
from plcgen.plc.importrules.s7_stl import RULES, findings
from plcgen.plc.source import decode_source
from plcgen.plc.stl.s7_parser import parse

MARK = b"\xef\xbb\xbf"
CLEAN = """FUNCTION_BLOCK FB 100
TITLE =hoist
AUTHOR : plcgen
VERSION : 0.1
VAR_INPUT
  x : REAL := 1.000000e+000;
  n : DINT := L#5;
END_VAR
BEGIN
NETWORK
TITLE =
      L     #x;  // done
      L     -1.000000e+000;
      >R    ;
      JC    M001;
M001: NOP   0;
END_FUNCTION_BLOCK
DATA_BLOCK DB 100
TITLE =
VERSION : 0.1
FB 100
BEGIN
  x := 2.000000e+000;
  n := L#7;
END_DATA_BLOCK
ORGANIZATION_BLOCK OB 35
TITLE =
VERSION : 0.1
BEGIN
NETWORK
TITLE =
      CALL FB 100 , DB 100 (
           x := 1.000000e+000);
END_ORGANIZATION_BLOCK
"""


def lint(text: str, raw: bytes | None = None) -> list[Finding]:
    source = decode_source("f.awl", text.replace("\n", "\r\n").encode("ascii") if raw is None else raw)
    return findings(source, parse(source))


def test_a_clean_source() -> None:
    assert lint(CLEAN) == []


CASES = [
    ("version", ("VERSION : 0.1\nVAR", "VERSION : 1\nVAR"), "1:1: VERSION 1 of FB100 is none; write VERSION : 0.1"),
    ("header-quotes", ("VERSION : 0.1\nVAR", "VERSION : '0.1'\nVAR"),
     "4:11: STL of STEP 7 V5 wants VERSION without quotes; write VERSION : 0.1"),
    ("title-quotes", ("TITLE =hoist", "TITLE ='hoist'"),
     "2:8: STL of STEP 7 V5 takes the quotes as part of the title; write TITLE = hoist"),
    ("header-word", (": plcgen", ": generator"), "3:10: AUTHOR generator has 9 characters; 8 are the most"),
    ("identifier-length", ("  n : DINT", "  aNameOfTwentyFiveLetters_ : BOOL;\n  n : DINT"),
     "7:3: aNameOfTwentyFiveLetters_ has 25 characters; STL of STEP 7 V5 allows 24, shorten it"),
    ("label-length", ("M001: ", "M0001:"), "16:1: label M0001 has 5 characters; 4 are the most, shorten it"),
    ("network", ("NETWORK\nTITLE =\n      L ", "      L "),
     "10:7: instruction above the first NETWORK; write NETWORK behind BEGIN"),
    ("begin", ("BEGIN\n  x := 2.000000e+000;\n  n := L#7;\n", ""),
     "18:1: DB100 has no BEGIN; write it above END_DATA_BLOCK"),
    ("real-point", ("L     -1.000000e+000", "L     -1e3"),
     "13:13: REAL -1e3 needs a point with digits on both sides; write -1.0e3"),
    ("real-point", ("x := 2.000000e+000", "x := 2E1"),
     "23:8: REAL 2E1 needs a point with digits on both sides; write 2.0E1"),
    ("double-prefix", (":= L#5", ":= 5"), "7:15: 5 is an INT here; write L#5"),
    ("double-prefix", (":= L#7", ":= 7"), "24:8: 7 is an INT here; write L#7"),
    ("quoted-name", ("FB 100 , DB 100 (", 'FB 100 , "Data" ('),
     '32:21: "Data" must stand in the symbol table before this source is compiled'),
    ("real-equality", (">R", "==R"), "14:7: REAL compared with ==R, which rounding decides; compare a range"),
    ("line-length", ("// done", "// " + "x" * 110), "12:127: line of 130 characters; 126 are the most, break it"),
]  # fmt: skip


@pytest.mark.parametrize(("rule", "change", "expected"), CASES)
def test_rule(rule: str, change: tuple[str, str], expected: str) -> None:
    assert change[0] in CLEAN
    found = lint(CLEAN.replace(*change))
    assert [(f"{f.location.line}:{f.location.column}: {f.message}", f.rule) for f in found] == [(expected, rule)]


def test_order_of_blocks() -> None:
    start = CLEAN.index("ORGANIZATION_BLOCK")
    (found, *others) = lint(CLEAN[start:] + CLEAN[:start])
    assert found.message == "FB100 is used above its own place in line 10; move it before OB35"
    assert [finding.message[:5] for finding in others] == ["DB100"]


def test_bytes() -> None:
    crlf = CLEAN.replace("\n", "\r\n").encode()
    assert [f.rule for f in lint("", MARK + crlf)] == ["byte-order-mark"]
    assert [f.rule for f in lint("", crlf.replace(b"done", "fährt".encode()))] == ["encoding"]
    assert [f.rule for f in lint("", crlf.replace(b"done", b"f\xe4hrt"))] == ["code-page"]
    assert [f.rule for f in lint("", CLEAN.encode())] == ["line-end"]


def test_each_rule_has_a_test() -> None:
    elsewhere = {"block-order", "byte-order-mark", "encoding", "code-page", "line-end"}
    assert {rule.name for rule in RULES} == {rule for rule, _, _ in CASES} | elsewhere
