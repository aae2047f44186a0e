"""Each import rule: what it rejects, word for word, and what it lets pass."""

from __future__ import annotations

import pytest

from plcgen.plc.importrules.finding import Finding
from plcgen.plc.importrules.s7_scl import RULES, findings
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import decode_source

MARK = b"\xef\xbb\xbf"
CLASSIC_CLEAN = """FUNCTION_BLOCK FB100
TITLE = 'hoist'
VERSION : '1.0'
AUTHOR : plcgen
CONST
  LIMIT_V := 1.0;
END_CONST
VAR_INPUT
  x : REAL;
END_VAR
BEGIN
  IF x > LIMIT_V THEN x := 1E3; END_IF; // done
END_FUNCTION_BLOCK
DATA_BLOCK DB100 FB100
BEGIN
END_DATA_BLOCK
ORGANIZATION_BLOCK OB35
BEGIN
  FB100.DB100(x := 1.0);
END_ORGANIZATION_BLOCK
"""
TIA_CLEAN = """FUNCTION_BLOCK "Hoist"
TITLE = hoist
{ S7_Optimized_Access := 'TRUE' }
VERSION : 1.0
VAR_INPUT
  x : Real;
END_VAR
BEGIN
  IF #x > 1.0 THEN #x := 1.0E3; END_IF;
END_FUNCTION_BLOCK
DATA_BLOCK "HoistData"
VERSION : 1.0
"Hoist"
BEGIN
  x := 1.0;
END_DATA_BLOCK
"""


def lint(raw: bytes, dialect: Dialect, parsed_as: Dialect | None = None) -> list[Finding]:
    source = decode_source("f.scl", raw)
    return findings(source, parse(source, parsed_as or dialect), dialect)


def crlf(text: str) -> bytes:
    return text.replace("\n", "\r\n").encode()


def fc(body: str, declarations: str = "") -> str:
    return f"FUNCTION FC1 : VOID\n{declarations}\nBEGIN\n{body}\nEND_FUNCTION\n"


def messages(found: list[Finding], rule: str) -> list[str]:
    return [f"{item.location.line}:{item.location.column} {item.message}" for item in found if item.rule == rule]


def test_clean_sources_have_no_findings() -> None:
    assert lint(crlf(CLASSIC_CLEAN), CLASSIC) == []
    assert lint(MARK + crlf(TIA_CLEAN), TIA) == []


def test_a_finding_as_text() -> None:
    (finding,) = lint(crlf(fc("x := 1; // " + "-" * 120)), CLASSIC)
    assert str(finding) == "f.scl:4:127: error: line of 131 characters; 126 are the most, break it [line-length]"


BYTES = [
    (CLASSIC, "byte-order-mark", "error", MARK + b";",
     "STEP 7 V5 reads the byte order mark as text; save as ANSI or ASCII"),
    (TIA, "byte-order-mark", "warning", b";",
     "no byte order mark, TIA may read another code page; save as UTF-8 with BOM"),
    (CLASSIC, "encoding", "error", ";// \u00e9".encode(),
     "UTF-8 character of several bytes, which STEP 7 V5 reads as several characters; write ASCII"),
    (CLASSIC, "code-page", "warning", b";// \xe9",
     "this character depends on the code page of the PC; ASCII is safe everywhere"),
    (TIA, "encoding", "error", b";// \xe9",
     "not UTF-8: this character depends on the code page of the PC; save as UTF-8 with BOM"),
]  # fmt: skip


@pytest.mark.parametrize(("dialect", "rule", "severity", "raw", "message"), BYTES)
def test_bytes(dialect: Dialect, rule: str, severity: str, raw: bytes, message: str) -> None:
    mark, code = (MARK, raw.removeprefix(MARK)) if raw.startswith(MARK) else (b"", raw)
    text = mark + b"FUNCTION FC1 : VOID BEGIN " + code + b"\r\nEND_FUNCTION"
    (finding,) = [item for item in lint(text, dialect) if item.rule == rule]
    assert (finding.severity, finding.message) == (severity, message)


@pytest.mark.parametrize(
    ("dialect", "raw"),
    [
        (CLASSIC, b"FUNCTION FC1 : VOID\r\nEND_FUNCTION // plain"),
        (TIA, MARK + "FUNCTION FC1 : VOID BEGIN\r\nEND_FUNCTION // \u00e9".encode()),
    ],
)
def test_bytes_that_pass(dialect: Dialect, raw: bytes) -> None:
    assert lint(raw, dialect) == []


@pytest.mark.parametrize(("dialect", "severity"), [(CLASSIC, "error"), (TIA, "warning")])
def test_line_ends(dialect: Dialect, severity: str) -> None:
    raw = b"FUNCTION FC1 : VOID\r\nBEGIN\n\nEND_FUNCTION\r\n"
    (finding,) = [item for item in lint(raw, dialect) if item.rule == "line-end"]
    assert finding.severity == severity
    assert messages([finding], "line-end") == ["2:6 2 lines end with LF alone, this is the first; save with CRLF"]


CASES: list[tuple[Dialect, Dialect, str, str, list[str]]] = [
    (CLASSIC, CLASSIC, "line-length", fc("// " + "-" * 123), []),
    (CLASSIC, CLASSIC, "nested-comment", fc("(* a (* b *)"),
     ["4:6 (* inside a comment; comments do not nest, remove it"]),
    (CLASSIC, CLASSIC, "nested-comment", fc("(* a *) // (* (*\ns := '(* (*'; (* c *)"), []),
    (CLASSIC, CLASSIC, "header-quotes", "FUNCTION_BLOCK FB1\nTITLE = hoist\nVERSION : 1.0 // v\nEND_FUNCTION_BLOCK",
     ["2:9 STEP 7 V5 wants TITLE in quotes; write TITLE = 'hoist'",
      "3:11 STEP 7 V5 wants VERSION in quotes; write VERSION : '1.0'"]),
    (CLASSIC, CLASSIC, "header-quotes",
     "FUNCTION_BLOCK FB1\nTITLE = 'a'\nVERSION : '1.0'\nVAR\nVersion : INT;\nEND_VAR\nEND_FUNCTION_BLOCK", []),
    (TIA, TIA, "header-quotes", "FUNCTION_BLOCK FB1\nVERSION : '1.0'\nBEGIN\nEND_FUNCTION_BLOCK",
     ["2:11 TIA wants VERSION without quotes; write VERSION : 1.0"]),
    (TIA, TIA, "header-quotes", "FUNCTION_BLOCK FB1\nVERSION : 1.0\nBEGIN\nEND_FUNCTION_BLOCK", []),
    (TIA, TIA, "title-quotes", "FUNCTION_BLOCK FB1\nTITLE = 'hoist'\nBEGIN\nEND_FUNCTION_BLOCK",
     ["2:9 TIA takes the quotes as part of the title; write TITLE = hoist"]),
    (TIA, TIA, "title-quotes", "FUNCTION_BLOCK FB1\nTITLE = it's\nBEGIN\nEND_FUNCTION_BLOCK", []),
    (CLASSIC, CLASSIC, "header-word",
     "FUNCTION_BLOCK FB1\nAUTHOR : somebody\nFAMILY : 'motioncontrol'\nEND_FUNCTION_BLOCK",
     ["3:10 FAMILY motioncontrol has 13 characters; 8 are the most"]),
    (CLASSIC, CLASSIC, "identifier-length", fc("", f"VAR_TEMP {'a' * 24}, {'b' * 25} : INT; END_VAR"),
     [f"2:36 {'b' * 25} has 25 characters; STEP 7 V5 allows 24, shorten it"]),
    (CLASSIC, CLASSIC, "identifier-length", fc("", f"CONST {'c' * 25} := 1; END_CONST"),
     [f"2:7 {'c' * 25} has 25 characters; STEP 7 V5 allows 24, shorten it"]),
    (CLASSIC, CLASSIC, "identifier-length", f"TYPE UDT1 STRUCT {'d' * 25} : INT; END_STRUCT END_TYPE",
     [f"1:18 {'d' * 25} has 25 characters; STEP 7 V5 allows 24, shorten it"]),
    (TIA, TIA, "identifier-length", fc("", f"VAR_TEMP {'a' * 128} : Int; END_VAR"), []),
    (TIA, TIA, "identifier-length", fc("", f"VAR_TEMP {'a' * 129} : Int; END_VAR"),
     [f"2:10 {'a' * 129} has 129 characters; TIA allows 128, shorten it"]),
    (CLASSIC, CLASSIC, "quoted-name", 'FUNCTION "F" : VOID\nBEGIN\n"Db".x := "Db".y + "f"();\nEND_FUNCTION',
     ['1:1 "F" must stand in the symbol table before this source is compiled',
      '3:1 "Db" must stand in the symbol table before this source is compiled']),
    (CLASSIC, CLASSIC, "quoted-name", CLASSIC_CLEAN, []),
    (CLASSIC, TIA, "local-prefix", fc("#x.y := 1;", "VAR_TEMP x : UDT1; END_VAR"),
     ["4:1 # before a name is TIA spelling; write x"]),
    (TIA, TIA, "local-prefix",
     fc("#x := N + y;\nx := 1;", "VAR_TEMP x : Int; END_VAR VAR CONSTANT N : Int := 1; END_VAR"),
     ["4:7 local N without #; write #N", "5:1 local x without #; write #x"]),
    (TIA, TIA, "local-prefix", 'DATA_BLOCK "D" STRUCT x : Int; END_STRUCT; BEGIN x := 1; END_DATA_BLOCK', []),
    (CLASSIC, CLASSIC, "block-order",
     "FUNCTION FC1 : VOID\nFC2(); FB1.DB1();\nEND_FUNCTION\nFUNCTION FC2 : VOID\nEND_FUNCTION\n"
     "DATA_BLOCK DB1 FB1\nBEGIN END_DATA_BLOCK\nFUNCTION_BLOCK FB1\nVAR a : UDT1; END_VAR END_FUNCTION_BLOCK\n"
     "TYPE UDT1 STRUCT x : INT; END_STRUCT END_TYPE",
     ["2:1 FC2 is used above its own place in line 4; move it before FC1",
      "2:8 FB1 is used above its own place in line 8; move it before FC1",
      "2:11 DB1 is used above its own place in line 6; move it before FC1",
      "6:1 FB1 is used above its own place in line 8; move it before DB1",
      "9:9 UDT1 is used above its own place in line 10; move it before FB1"]),
    (CLASSIC, CLASSIC, "block-order",
     "FUNCTION FC1 : INT\nVAR_TEMP FC2 : INT; END_VAR\nFC1 := FC2 + FC3();\nEND_FUNCTION\n"
     "FUNCTION FC2 : VOID\nDB9.x := DB8.DBW0;\nEND_FUNCTION\n", []),
    (CLASSIC, CLASSIC, "block-order",
     "FUNCTION FC1 : VOID\nx := DB8.DBW0;\nEND_FUNCTION\nDATA_BLOCK DB8 UDT1\nEND_DATA_BLOCK",
     ["2:6 DB8 is used above its own place in line 4; move it before FC1"]),
    (CLASSIC, TIA, "region", fc("REGION a\nEND_REGION"), ["4:1 REGION needs S7-1200 or S7-1500; write a comment line"]),
    (TIA, TIA, "region", fc("REGION a\nEND_REGION"), ["4:1 REGION needs S7-1200 or S7-1500; write a comment line"]),
    (TIA, TIA, "region", fc("// REGION a"), []),
    (CLASSIC, TIA, "compound-assignment", fc("x -= 1;"), ["4:1 -= needs S7-1200 or S7-1500; write x := x - ..."]),
    (TIA, TIA, "compound-assignment", fc("x *= 1;"), ["4:1 *= needs S7-1200 or S7-1500; write x := x * ..."]),
    (TIA, TIA, "compound-assignment", fc("x := x + 1;"), []),
    (CLASSIC, CLASSIC, "output-arrow", fc("FB1.DB1(a := 1, b => c);"),
     ["4:17 => does not exist in STEP 7 V5; read b from the instance behind the call"]),
    (TIA, TIA, "absent-function", fc('x := EXPD(1.0) + LOG(2.0) + "LOG"() + 5 DIV 2;'),
     ["4:6 EXPD does not exist in TIA; write EXP(x * 2.302585)",
      "4:18 LOG does not exist in TIA; write LN(x) * 0.4342945",
      "4:41 DIV does not exist in TIA; write /"]),
    (TIA, TIA, "absent-function", fc("x := EXP(1.0) + LN(2.0) + 5 / 2;"), []),
    (TIA, CLASSIC, "real-point", fc("x := 3E10 + REAL#1e5 + 1.5 + REAL#5;"),
     ["4:6 REAL literal 3E10 needs a point in TIA; write 3.0E10",
      "4:13 REAL literal REAL#1e5 needs a point in TIA; write REAL#1.0E5"]),
    (TIA, CLASSIC, "real-point", fc("x := 3.0E10 + 16#1E5 + 5;"), []),
    (CLASSIC, CLASSIC, "real-equality",
     fc("a := x = y;\na := r[1] <> y;\na := i + 1.0 = j;\na := -N = i;",
        "VAR_TEMP x : REAL; r : ARRAY[0..1] OF REAL; i : INT; END_VAR CONST N := 1.0; END_CONST"),
     ["4:8 REAL compared with =, which rounding decides; compare a range",
      "5:11 REAL compared with <>, which rounding decides; compare a range",
      "6:14 REAL compared with =, which rounding decides; compare a range",
      "7:9 REAL compared with =, which rounding decides; compare a range"]),
    (CLASSIC, CLASSIC, "real-equality",
     fc("a := x >= y;\na := i = 1;\na := TRUNC(x) = 1;", "VAR_TEMP x : REAL; i : INT; END_VAR"), []),
    (TIA, TIA, "real-equality", fc("#a := #x = 0.5;"),
     ["4:10 REAL compared with =, which rounding decides; compare a range"]),
]  # fmt: skip


@pytest.mark.parametrize(("dialect", "parsed_as", "rule", "text", "expected"), CASES)
def test_rules(dialect: Dialect, parsed_as: Dialect, rule: str, text: str, expected: list[str]) -> None:
    assert messages(lint(crlf(text), dialect, parsed_as), rule) == expected


@pytest.mark.parametrize("dialect", [CLASSIC, TIA])
def test_every_rule_is_shown_by_a_case(dialect: Dialect) -> None:
    shown = {rule for of, _, rule, _, _ in CASES if of is dialect}
    shown |= {rule for of, rule, _, _, _ in BYTES if of is dialect} | {"line-end"}
    assert shown == {rule.name for rule in RULES[dialect.name]}


def test_findings_stand_in_the_order_of_the_text() -> None:
    found = lint(crlf(fc('"b".x := 1;\n"a".x := 1; // ' + "-" * 130)), CLASSIC)
    assert [item.location.line for item in found] == [4, 5, 5]
