"""What the parser says about bad sources, word for word, and that it never answers in any other way."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plcgen.errors import SourceError
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect, detect_dialect
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText, decode_source


def message(text: str, dialect: Dialect) -> str:
    with pytest.raises(SourceError) as caught:
        parse(SourceText("f.scl", text), dialect)
    return str(caught.value).split("\n")[0]


STATEMENTS = [
    (
        CLASSIC,
        "IF x > 1.0 THEN\n  y := 1.0;",
        "f.scl:5:1: END_IF expected before END_FUNCTION_BLOCK; it closes IF of line 3",
    ),
    (CLASSIC, "FOR i := 1 TO 2 DO\nEND_IF;", "f.scl:4:1: END_FOR expected before END_IF; it closes FOR of line 3"),
    (CLASSIC, "CASE n OF 1: ;", "f.scl:4:1: END_CASE expected before END_FUNCTION_BLOCK; it closes CASE of line 3"),
    (CLASSIC, "x := -16#8000;", "f.scl:3:7: -16#8000 is outside the range of an integer: 0 to 4294967295"),
    (CLASSIC, "REPEAT ; END_REPEAT;", "f.scl:3:10: UNTIL expected before END_REPEAT; it closes REPEAT of line 3"),
    (CLASSIC, "IF a THEN ; ELSE ; ELSE ; END_IF;", "f.scl:3:20: END_IF expected before ELSE; it closes IF of line 3"),
    (CLASSIC, "x := 1.0;\nEND_IF;", "f.scl:4:1: END_IF closes nothing here; remove it"),
    (CLASSIC, "VAR z : INT; END_VAR", "f.scl:3:1: VAR belongs before BEGIN; move it up"),
    (
        CLASSIC,
        "END_FUNCTION",
        "f.scl:3:1: END_FUNCTION_BLOCK expected before END_FUNCTION; it closes FUNCTION_BLOCK of line 1",
    ),
    (CLASSIC, "x := 1.0\ny := 2.0;", "f.scl:3:9: ; expected before y"),
    (CLASSIC, "IF a THEN ; END_IF\nx := 1;", "f.scl:3:19: ; expected before x"),
    (CLASSIC, "x = 1.0;", "f.scl:3:3: = compares; write := to assign"),
    (CLASSIC, "IF x := 1 THEN ; END_IF;", "f.scl:3:6: := assigns; write = to compare"),
    (CLASSIC, "y := (x := 1);", "f.scl:3:9: := assigns; write = to compare"),
    (CLASSIC, "x := y := 1;", "f.scl:3:8: := assigns only once, at the start of a statement; write = to compare"),
    (CLASSIC, "x;", "f.scl:3:1: neither an assignment nor a call; write := or ( ) behind it"),
    (CLASSIC, "5 := x;", "f.scl:3:1: a statement expected, found 5"),
    (CLASSIC, "x := 1 + ;", "f.scl:3:10: a value expected, found ;"),
    (CLASSIC, "x := IF;", "f.scl:3:6: a value expected, found IF"),
    (CLASSIC, "x := (1 + 2;", "f.scl:3:12: ) expected, found ;"),
    (CLASSIC, "x := a[1;", "f.scl:3:9: ] expected, found ;"),
    (CLASSIC, "x := a.;", "f.scl:3:8: the name of a member expected, found ;"),
    (CLASSIC, "f(a := 1 b := 2);", "f.scl:3:10: ) expected, found b; arguments are parted by commas"),
    (CLASSIC, "IF x > 1 y := 1; END_IF;", "f.scl:3:10: THEN expected, found y"),
    (CLASSIC, "FOR i := 1 DO ; END_FOR;", "f.scl:3:12: TO expected, found DO"),
    (CLASSIC, "FOR i = 1 TO 2 DO ; END_FOR;", "f.scl:3:7: := expected, found ="),
    (CLASSIC, "GOTO m1;", "f.scl:3:1: GOTO is not supported; use IF, EXIT, CONTINUE or RETURN"),
    (CLASSIC, "m1: x := 1;", "f.scl:3:1: jump label m1 is not supported; use IF, EXIT, CONTINUE or RETURN"),
    (CLASSIC, "x += 1;", "f.scl:3:3: += does not exist in STEP 7 V5; write x := x + ..."),
    (CLASSIC, "REGION a\nEND_REGION", "f.scl:3:1: REGION does not exist in STEP 7 V5; write a comment line"),
    (CLASSIC, "x := MW[i];", "f.scl:3:6: indexed address MW[...] is not supported; use an ARRAY"),
    (CLASSIC, "x := M0.9;", "f.scl:3:6: M0.9: bit 9 does not exist; a byte has bits 0 to 7"),
    (CLASSIC, "x := MW99999;", "f.scl:3:6: MW99999: 65535 is the largest number here"),
    (CLASSIC, "x := %MW2:P;", "f.scl:3:6: %MW2:P is not an address; only inputs and outputs have :P"),
    (
        CLASSIC,
        'x := "Db".%DBX0.0;',
        "f.scl:3:11: absolute access %DBX0.0 inside a block is not supported; name the variable",
    ),
    (TIA, "#x := 1e-07;", "f.scl:3:7: REAL literal 1e-07 needs a point in TIA; write 1.0E-07"),
    (TIA, "REGION a\n#x := 1;", "f.scl:5:1: END_REGION expected before END_FUNCTION_BLOCK; it closes REGION of line 3"),
]


@pytest.mark.parametrize(("dialect", "text", "expected"), STATEMENTS)
def test_statements(dialect: Dialect, text: str, expected: str) -> None:
    assert message(f"FUNCTION_BLOCK FB1\nBEGIN\n{text}\nEND_FUNCTION_BLOCK\n", dialect) == expected


DECLARATIONS = [
    (CLASSIC, "VAR x : REAL;\nBEGIN", "f.scl:3:1: END_VAR expected before BEGIN; it closes VAR of line 2"),
    (CLASSIC, "VAR x : INT; END_VAR;\nVAR_TEMP y : INT; END_VAR",
     "f.scl:2:21: no ; belongs behind END_VAR; remove it"),
    (TIA, "VAR x : Int; END_VAR;\nBEGIN", "f.scl:2:21: no ; belongs behind END_VAR; remove it"),
    (CLASSIC, "VAR x : STRUCT a : INT; END_VAR",
     "f.scl:2:25: END_STRUCT expected before END_VAR; it closes STRUCT of line 2"),
    (CLASSIC, "VAR x REAL; END_VAR", "f.scl:2:7: : expected, found REAL"),
    (CLASSIC, "VAR x : REAL\ny : INT; END_VAR", "f.scl:2:13: ; expected before y"),
    (CLASSIC, "VAR if : REAL; END_VAR", "f.scl:2:5: if is a reserved word; choose another name"),
    (CLASSIC, "VAR Time : TIME; END_VAR", "f.scl:2:5: Time is a reserved word; choose another name"),
    (CLASSIC, "VAR MW1 : INT; END_VAR", "f.scl:2:5: MW1 is an absolute address; choose another name"),
    (TIA, "VAR #x : Int; END_VAR", "f.scl:2:5: #x is declared without #; write x"),
    (CLASSIC, "VAR x : LREAL; END_VAR", "f.scl:2:9: type LREAL does not exist on S7-300 and S7-400"),
    (TIA, "VAR x : Variant; END_VAR", "f.scl:2:9: type Variant is not supported"),
    (CLASSIC, "VAR x : IF; END_VAR", "f.scl:2:9: a type expected, found IF"),
    (CLASSIC, "VAR x : ARRAY OF INT; END_VAR", "f.scl:2:15: [ expected, found OF; write ARRAY[0..9] OF REAL"),
    (CLASSIC, "VAR x : ARRAY[3] OF INT; END_VAR", "f.scl:2:16: .. expected, found ]; write both bounds, like 0..9"),
    (TIA, "VAR x : Array[*] of Int; END_VAR",
     "f.scl:2:15: arrays of open length are not supported; write the bounds, like 0..9"),
    (CLASSIC, "VAR x AT %MW1 : INT; END_VAR",
     "f.scl:2:10: AT %MW1 is not supported; a view lies on a variable of the same block"),
    (TIA, 'VAR x : "P" := (a := 1); END_VAR',
     "f.scl:2:16: initial values of a STRUCT by name are not supported; assign them after BEGIN of the DB"),
    (CLASSIC, "CONST N = 1; END_CONST", "f.scl:2:9: := expected, found =; a constant needs a value"),
    (CLASSIC, "VAR CONSTANT N : INT := 1; END_VAR",
     "f.scl:2:1: VAR CONSTANT does not exist in STEP 7 V5; write CONST ... END_CONST"),
    (TIA, "CONST N := 1; END_CONST", "f.scl:2:1: CONST does not exist in TIA; write VAR CONSTANT with a type"),
    (CLASSIC, "LABEL m1; END_LABEL", "f.scl:2:1: jump labels are not supported; use IF, EXIT, CONTINUE or RETURN"),
    (TIA, "VAR x { S7_v := 1 } : Int; END_VAR", "f.scl:2:17: a quoted value expected, found 1"),
    (TIA, "VAR x : Int; END_VAR", "f.scl:3:1: BEGIN expected, found END_FUNCTION_BLOCK; "
     "it stands between the declarations and the statements"),
]  # fmt: skip


@pytest.mark.parametrize(("dialect", "text", "expected"), DECLARATIONS)
def test_declarations(dialect: Dialect, text: str, expected: str) -> None:
    assert message(f"FUNCTION_BLOCK FB1\n{text}\nEND_FUNCTION_BLOCK\n", dialect) == expected


BLOCKS = [
    ("x := 1;", "f.scl:1:1: a block expected, found x; blocks begin with FUNCTION_BLOCK or the like"),
    ("FUNCTION_BLOCK\nVAR END_VAR", "f.scl:2:1: the name of the block expected, found VAR"),
    ("FUNCTION_BLOCK 5", "f.scl:1:16: the name of the block expected, found 5"),
    ("FUNCTION FC1\nBEGIN END_FUNCTION", "f.scl:2:1: : expected, found BEGIN; write the type of the result, or : VOID"),
    (
        "FUNCTION_BLOCK FB1",
        "f.scl:1:19: END_FUNCTION_BLOCK expected before end of file; it closes FUNCTION_BLOCK of line 1",
    ),
    ("FUNCTION_BLOCK FB1\nTITLE 'x'", "f.scl:2:7: = expected, found 'x'; write TITLE = 'text'"),
    ("FUNCTION_BLOCK FB1\nVERSION = '1'", "f.scl:2:9: : expected, found =; write VERSION : value"),
    ("FUNCTION_BLOCK FB1\nVERSION :\nBEGIN", "f.scl:2:10: VERSION has no value; write it behind the colon"),
    (
        "DATA_BLOCK DB1\nBEGIN END_DATA_BLOCK",
        "f.scl:2:1: STRUCT, VAR or the name of an FB or UDT expected, found BEGIN",
    ),
    (
        "DATA_BLOCK DB1 FB1\nx := 1;",
        "f.scl:2:1: BEGIN expected, found x; it stands between the declarations and the initial values",
    ),
    ("DATA_BLOCK DB1 FB1\nBEGIN f(); END_DATA_BLOCK", "f.scl:2:7: a DATA_BLOCK holds only assignments, like x := 1.0;"),
    ("TYPE UDT1\nx : INT; END_TYPE", "f.scl:2:1: STRUCT expected, found x"),
]


@pytest.mark.parametrize(("text", "expected"), BLOCKS)
def test_blocks(text: str, expected: str) -> None:
    assert message(text, CLASSIC) == expected


def test_the_caret_stands_where_the_semicolon_belongs() -> None:
    with pytest.raises(SourceError) as caught:
        parse(SourceText("f.scl", "FUNCTION FC1 : VOID\nBEGIN\n  x := 1.0\n  y := 2.0;\nEND_FUNCTION"), CLASSIC)
    assert str(caught.value) == "f.scl:3:11: ; expected before y\n    x := 1.0\n            ^"


@pytest.mark.parametrize(
    "text",
    [
        "x := " + "(" * 9999,
        "x := " + "a[" * 9999,
        "x := " + "f(" * 9999,
        "x := " + "NOT " * 9999 + "a",
        "x := " + "- " * 9999 + "a",
        "x := a" + " ** -a" * 9999,
        "x := " + "a OR a + (" * 9999,
        "IF a THEN " * 9999,
        "CASE a OF 1: " * 9999,
    ],
)
def test_nesting_is_bounded(text: str) -> None:
    assert message(f"FUNCTION FC1 : VOID BEGIN {text}", CLASSIC).endswith("nested deeper than 64 levels; split it up")


@pytest.mark.parametrize(
    "text", ["VAR x : " + "ARRAY[0..1] OF " * 9999, "VAR x : " + "STRUCT x : " * 9999, "VAR x : INT := " + "2(" * 9999]
)
def test_nesting_of_declarations_is_bounded(text: str) -> None:
    assert message(f"FUNCTION FC1 : VOID {text}", CLASSIC).endswith("nested deeper than 64 levels; split it up")


@pytest.mark.parametrize("text", ["1" + " + 1" * 9999, "a" + " ** a" * 9999])
def test_operators_are_bounded(text: str) -> None:
    assert message(f"FUNCTION FC1 : VOID BEGIN x := {text};", CLASSIC).endswith(
        "more than 200 operators in one expression; split it with a temporary variable"
    )


def test_the_bound_is_for_one_expression_only() -> None:
    text = "x := a + b * (c - d);\n" * 300
    assert len(parse(SourceText("f.scl", f"FUNCTION FC1 : VOID BEGIN {text} END_FUNCTION"), CLASSIC)[0].body) == 300


# ------------------------------------------------------------------------------------------------------- mutations

VALID = {
    CLASSIC.name: """
TYPE UDT5 STRUCT x : REAL := 1.0; y, z { S7_v := 'f' } : ARRAY[1..3, 0..1] OF INT; END_STRUCT END_TYPE
FUNCTION FC1 : REAL
TITLE = 'a'
VERSION : '1.0'
CONST N := 3; M := 2 * N + 1; END_CONST
VAR_TEMP t : DWORD; v AT t : ARRAY[0..31] OF BOOL; a : ARRAY[1..4] OF REAL := N(0.0), 1.0;
  s : STRING[9] := 'It$'s'; END_VAR
  IF v[0] AND NOT M0.0 OR t = DW#16#FF THEN ; ELSIF a[1] <> 3E10 THEN RETURN; ELSE FC1 := -a[2] ** 2; END_IF;
  CASE i OF 1, 3..5: f(x := 1); N, -2: x := T#1d2h; ELSE: ; END_CASE;
  FOR i := 1 TO 9 BY 2 DO EXIT; END_FOR; WHILE b DO CONTINUE; END_WHILE; REPEAT ; UNTIL D#1990-1-1 = d END_REPEAT;
  FB1.DB1(in := DB1.DBD4, t := TOD#1:2:3.4); (* c *) x := DT#1990-1-2-3:4:5.6; // d
END_FUNCTION
DATA_BLOCK DB1 FB1 BEGIN x := S5T#1s; END_DATA_BLOCK
""",
    TIA.name: """
FUNCTION_BLOCK "Fb"
TITLE = don't
{ S7_Optimized_Access := 'FALSE' }
VERSION : 1.0
VAR RETAIN x { A := 'b'; C := 'd' } : Real := 3.0E10; END_VAR
VAR CONSTANT N : Int := 5; END_VAR
BEGIN
REGION it's
  #x += 1.0; #"t w"(IN := #x > 3.0, Q => #y.%X3); %MW10 := %IW4:P;
END_REGION
CASE #n OF #N: ; "C": REGION a
END_REGION END_CASE;
END_FUNCTION_BLOCK
DATA_BLOCK "Db"
NON_RETAIN
"Fb"
BEGIN x := 1; END_DATA_BLOCK
""",
}
SNIPPETS = [
    "(",
    ")",
    "[",
    "]",
    "'",
    '"',
    "(*",
    "*)",
    "//",
    ";",
    ":=",
    "..",
    ".",
    "#",
    "%",
    "16#",
    "T#",
    "1E",
    "9" * 99,
    "-",
]
SNIPPETS += [
    "IF ",
    "END_IF ",
    "BEGIN ",
    "VAR ",
    "REGION ",
    "CASE ",
    "\x00",
    "\ufeff",
    "\r",
    "\n",
    "\u00b2",
    "\u0663",
    "$",
    "{",
    "}",
]


@st.composite
def mutated(draw: st.DrawFn) -> tuple[str, Dialect]:
    dialect = draw(st.sampled_from([CLASSIC, TIA]))
    text = VALID[dialect.name]
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        end = start + draw(st.integers(0, 12))
        text = text[:start] + draw(st.sampled_from(["", *SNIPPETS]) | st.text(max_size=3)) + text[end:]
    return text, draw(st.sampled_from([dialect, CLASSIC, TIA]))


def parse_or_refuse(text: str, dialect: Dialect) -> None:
    try:
        parse(SourceText("f.scl", text), dialect)
    except SourceError as error:
        assert error.location is not None
        assert str(error).startswith("f.scl:")


@pytest.mark.parametrize("dialect", [CLASSIC, TIA])
def test_the_sources_to_mutate_are_valid(dialect: Dialect) -> None:
    assert len(parse(SourceText("f.scl", VALID[dialect.name]), dialect)) >= 2


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(mutated())
def test_a_mutated_source_is_parsed_or_refused(case: tuple[str, Dialect]) -> None:
    parse_or_refuse(*case)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-be"])
def test_utf_16_is_named(encoding: str) -> None:
    with pytest.raises(SourceError) as caught:
        decode_source("f.scl", "\ufeffFUNCTION_BLOCK".encode(encoding))
    assert str(caught.value) == "f.scl: is UTF-16; save it as UTF-8 with BOM (TIA) or as ANSI (STEP 7 V5)"


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=60))
def test_any_bytes_are_parsed_or_refused(raw: bytes) -> None:
    try:
        source = decode_source("f.scl", raw)
    except SourceError:
        return
    parse_or_refuse(source.text, detect_dialect(source))
