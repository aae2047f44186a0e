"""Wrong and unsupported S7-300 STL: each text, and the message word for word. Never anything but a SourceError."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from plcgen.errors import Fault, SourceError
from plcgen.plc.machine import Machine
from plcgen.plc.source import SourceText, decode_source
from plcgen.plc.stl.s7_lowering import lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.stl.s7_table import CALLS, MNEMONICS, UNSUPPORTED

HEAD = """FUNCTION_BLOCK FB 1
VAR
  x : REAL ;
  i : INT ;
  p : BOOL ;
  s : STRUCT
    a : INT ;
  END_STRUCT ;
  arr : ARRAY [0 .. 3] OF INT ;
  m : FB 2 ;
END_VAR
VAR_TEMP
  t : INT ;
END_VAR
BEGIN
NETWORK
"""
TAIL = """
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB 2
VAR_INPUT
  a : DINT ;
  b : REAL ;
  w : WORD ;
  g : BOOL ;
END_VAR
VAR_OUTPUT
  o : INT ;
END_VAR
BEGIN
NETWORK
END_FUNCTION_BLOCK
FUNCTION FC 1 : INT
VAR_INPUT
  a : INT ;
END_VAR
BEGIN
NETWORK
END_FUNCTION
FUNCTION FC 2 : VOID
BEGIN
NETWORK
END_FUNCTION
DATA_BLOCK DB 5
STRUCT
  speed : REAL ;
END_STRUCT ;
BEGIN
END_DATA_BLOCK
"""


def message(text: str) -> str:
    """Line, column and words of the error in a text."""
    with pytest.raises(SourceError) as caught:
        lower(parse(SourceText("f.awl", text)))
    location = caught.value.location
    assert location is not None
    return f"{location.line}:{location.column}: {caught.value.message}"


STATEMENTS = [
    ("L #y;", "1:3: y is not declared"),
    ("L #X1;", "1:3: X1 is not declared; did you mean x?"),
    ("L y;", "1:3: y is not declared"),
    ("LL #x;", "1:1: unknown instruction LL; did you mean L?"),
    ("L;", "1:1: L needs an operand"),
    ("SET 5;", "1:5: SET takes no operand; remove 5"),
    ("L #p;", "1:3: #p is a bit; L takes 8, 16 or 32 of them"),
    ("A #i;", "1:3: #i is INT, A takes a bit"),
    ("L #s;", "1:3: #s is STRUCT; L takes up to 32 bits, name a part of it"),
    ("L #arr;", "1:3: #arr is ARRAY[0..3] OF INT; L takes up to 32 bits, name a part of it"),
    ("L #arr[4];", "1:7: index 4 outside 0 .. 3"),
    ("L #arr[#i];", "1:7: [#i]: an index is a constant in STL; use a pointer, such as DBD [AR1,P#0.0]"),
    ("L #i.a;", "1:5: INT has no member a"),
    ("L #s.b;", "1:5: STRUCT has no member b"),
    ("L 40000;", "1:3: 40000 is no INT (-32768 .. 32767); write L#40000"),
    ("L 16#FF;", "1:3: 16#FF does not say its width; write B#16#FF, W#16#FF or DW#16#FF"),
    ("L DW#16#1FFFFFFFF;", "1:3: DW#16#1FFFFFFFF is outside the range of DWORD: 0 to 4294967295"),
    ("L INT;", "1:3: INT is not declared"),
    ("L 'abc';", "1:3: 'abc': L takes one, two or four characters"),
    ("L TRUE;", "1:3: TRUE is a bit; write SET or CLR"),
    ("T 5;", "1:3: 5 is a constant; T writes to a variable or an address"),
    ("L T 5;", "1:3: T 5: timers and counters are not supported; count scans in a variable"),
    ("L C 5;", "1:3: C 5: timers and counters are not supported; count scans in a variable"),
    ("SE T 5;", "1:4: T 5: timers and counters are not supported; count scans in a variable"),
    ("CU C 1;", "1:4: C 1: timers and counters are not supported; count scans in a variable"),
    ("MCRA;", "1:1: MCRA: the master control relay is not supported; use jumps"),
    ("ENT;", "1:1: ENT: an S7-300 has two accumulators; this is for an S7-400"),
    ('L "Nix".x;', '1:3: "Nix" is no data block of this source and no symbol'),
    ('L "DB5".sped;', "1:8: DB5 has no member sped; did you mean speed?"),
    ("L DB5.DBD 2;", "1:3: DB5.DBD 2 lies outside the 4 bytes of DB5"),
    ("L DB6.DBW 0;", "1:3: DB6 is no data block of this source; did you mean DB5?"),
    ("L DBW 0;", "1:3: DBW 0: which data block is open here is not known; write OPN DB above it"),
    ("L M 0.0;", "1:3: M 0.0 is a bit; L takes 8, 16 or 32 of them"),
    ("L M 0;", "1:3: M 0: a bit needs .0 to .7, a byte, word or double word has none"),
    ("L MW 1.0;", "1:3: MW 1.0: a bit needs .0 to .7, a byte, word or double word has none"),
    ("L M 0.8;", "1:3: M 0.8 does not exist; bytes go to 65535, bits to 7"),
    ("A MW 0;", "1:3: MW 0 is WORD, A takes a bit"),
    ("L LW 256;", "1:3: LW 256 lies outside the 2 bytes of VAR_TEMP of FB1"),
    ("L DIW 100;", "1:3: DIW 100 lies outside the 32 bytes of the instance"),
    ("LAR2 P#M 0.0;", "1:1: AR2 holds the place of the instance in a FUNCTION_BLOCK; use AR1"),
    ("OPN DI 5;", "1:1: the register DI holds the instance in a FUNCTION_BLOCK; use OPN DB"),
    ("OPN DB 7;", "1:5: DB7 is no data block of this source; did you mean DB5?"),
    ("OPN #i;", "1:5: #i: which block is opened must be known here; write OPN DB 1 or OPN DI 1"),
    ("CDB;", "1:1: the register DI holds the instance in a FUNCTION_BLOCK; use OPN DB"),
    ("JU M009;", "1:4: no label M009 in FB1; write M009: before an instruction"),
    ("M001: NOP 0; M001: NOP 0;", "1:14: label M001 stands twice in FB1; rename one"),
    ("A(; A #p;", "1:1: A( is not closed; write ) below it"),
    ("A(; JC M001; M001: NOP 0; );", "1:5: A( is still open here; close it with )"),
    (");", "1:1: ) without an open bracket; write A( or the like above it"),
    ("SLW 16;", "1:5: SLW 16: write a number from 0 to 15"),
    ("SLD 33;", "1:5: SLD 33: write a number from 0 to 32"),
    ("INC 256;", "1:5: INC 256: write a number from 0 to 255"),
    ("AW 5;", "1:4: AW 5: write a constant such as W#16#FF"),
    ("+ 5.0;", "1:3: + 5.0: write a constant such as 5 or L#5"),
    ("+AR1 5;", "1:6: 5: +AR1 takes P#byte.bit, such as P#2.0"),
    (
        "L W [AR1,P#0.0];",
        "1:3: W [AR1,P#0.0]: to which area AR1 points is not known; write the area, such as DBW [AR1,P#0.0]",
    ),
    ("L DBW [#i];", "1:8: #i is INT; a pointer is a DWORD"),
    ("L DBW [AR3,P#0.0];", "1:11: ,P#0.0 does not belong behind a variable"),
    ("LAR1 #i;", "1:6: #i is INT; a pointer is a DWORD, such as P#M 0.0"),
    ("CALL FB 2;", "1:1: FB2 is an FB; call it with an instance, as CALL FB2, DB 1"),
    ("CALL FB 2, DB 5;", "1:12: DB5 is no instance of FB2"),
    ("CALL FB 3, DB 3;", "1:6: no FB or FC FB3; did you mean FB2?"),
    ("CALL FC 1;", "1:1: FC1 needs parameter RET_VAL"),
    ("CALL FC 2, DB 5;", "1:12: only an FB takes a data block; remove it"),
    ("CALL SFC 20;", "1:6: SFC 20 is not supported; a block of your own in the source can stand in for it"),
    ("CALL #m (a := 5);", "1:15: 5 is no DINT, which a takes; write L#5"),
    ("CALL #m (b := 5);", "1:15: 5 is no REAL, which b takes; write 5.0"),
    ("CALL #m (w := 5);", "1:15: 5 is no WORD, which w takes; write it like W#16#0"),
    ("CALL #m (g := 1);", "1:15: 1 is no BOOL, which g takes; write TRUE or FALSE"),
    ("CALL #m (c := 5);", "1:10: FB2 has no parameter c"),
    ("CALL #m (a := L#1, a := L#2);", "1:20: a is given twice"),
    ("CALL #m (o := 5);", "1:15: o is written; give it a variable"),
    ("CALL #m (a := #i);", "1:15: #i is INT, a takes DINT"),
    ("CALL #m (a 5);", "1:10: name := value expected"),
    ("CALL #m (a := L#5;", "1:18: ) expected at the end of the parameters"),
    ("CALL #x;", "1:6: #x is REAL; it cannot be called"),
    ("CALL;", "1:1: CALL of what? write CALL FB 1, DB 1 or CALL FC 1"),
    ("CALL #y;", "1:6: y is not declared"),
    ("UC FC 1;", "1:4: UC takes an FC without parameters, FC1 is none; write CALL FC1"),
    ("UC;", "1:1: UC of what? write UC FC 1"),
    ("U #p;", "1:1: U is German, other mnemonics here are English; write A"),
    ("L #x", "1:5: ; expected at the end of the instruction"),
    ("L #x T #i;", "1:5: T #i does not belong behind a variable"),
    ('L "abc;', '1:3: " is not closed on this line; add one'),
    ("L P#DB5.DBX0.0 BYTE 4;", "1:3: P#DB5.DBX0.0 BYTE 4: such pointers are not supported; name the variable itself"),
    ("L P##nix;", "1:5: nix is not declared"),
    ("L DBD [AR1,P#0.0;", "1:6: [AR1,P#0.0 does not belong behind a variable"),
    ("JU 5;", "1:4: 5 is no label; write up to four letters and digits, such as M001"),
    ("L 1.5e50;", "1:3: 1.5e50 is outside the range of REAL: 1.175495E-38 to 3.402823E+38"),
    ("L #x; (* c *)", "1:7: (* *) is no comment in STL; write //"),
    ("L DIW [AR1, P#0.0]; O(; O #p; ); ) ;", "1:34: ) without an open bracket; write A( or the like above it"),
    ("LABEL:", "1:1: label LABEL names no instruction; write NOP 0; behind it"),
    ("? ;", "1:1: an instruction expected, found ?"),
    ("L AR1;", "1:3: L does not read AR1; write TAR1"),
    ("L S5T#999H;", "1:3: S5T#999H (in ms) is outside the range of S5TIME: 0 to 9990000"),
    ("L 1.;", "1:3: 1. is no operand; write a variable, an address such as MW 10, or a constant"),
    ("TAR1 #i;", "1:6: #i is INT; a pointer is a DWORD"),
    ("L STW; A STW;", "1:10: STW is no variable and no address"),
    ("T OV;", "1:3: OV is no variable and no address"),
    ("JL M001; M001: NOP 0; JL;", "1:23: JL needs an operand"),
]


@pytest.mark.parametrize(("text", "expected"), STATEMENTS)
def test_statements(text: str, expected: str) -> None:
    row, rest = expected.split(":", 1)
    assert message(f"{HEAD}{text}{TAIL}") == f"{int(row) + HEAD.count(chr(10))}:{rest}"


BLOCKS = [
    (
        "FUNCTION_BLOCK FB 1\nBEGIN\nEND_FUNCTION_BLOCK\nFUNCTION FC 1 : VOID\nVAR_TEMP\n m : FB 1;\nEND_VAR\nBEGIN\n"
        "END_FUNCTION",
        "6:2: m is an instance of FB1, which must outlast a call; declare it in VAR of an FB",
    ),
    ("FUNCTION FC 1\nBEGIN\nEND_FUNCTION", "2:1: : expected, found BEGIN; write the type of the result, or : VOID"),
    ("FUNCTION_BLOCK FB 1\nVAR\n x : REAL\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK", "3:10: ; expected before END_VAR"),
    (
        "FUNCTION_BLOCK FB 1\nNETWORK\nEND_FUNCTION_BLOCK",
        "2:1: BEGIN expected, found NETWORK; it stands between the declarations and the first NETWORK",
    ),
    (
        "FUNCTION_BLOCK FB 1\nBEGIN\nL 5;",
        "3:5: END_FUNCTION_BLOCK expected before end of file; it closes FUNCTION_BLOCK",
    ),
    ("FUNKTION_BLOCK FB 1", "1:1: a block expected, found FUNKTION_BLOCK; did you mean FUNCTION_BLOCK?"),
    (
        "FUNCTION FC 1 : VOID\nVAR\n x : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION",
        "2:1: VAR belongs to a FUNCTION_BLOCK; write VAR_TEMP",
    ),
    (
        "FUNCTION FC 1 : VOID\nVAR_INPUT\n x : INT := 5;\nEND_VAR\nBEGIN\nEND_FUNCTION",
        "3:13: x takes no initial value: every call of an FC gives it one; remove it here",
    ),
    (
        "FUNCTION FC 1 : VOID\nVAR_TEMP\n x : INT := 5;\nEND_VAR\nBEGIN\nEND_FUNCTION",
        "3:13: x is temporary and takes no initial value; load it at the start of the block",
    ),
    (
        "FUNCTION_BLOCK FB 1\nVAR\n x : INT;\n y AT x : WORD;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK",
        "4:2: AT does not exist in STL; read the bytes by their address",
    ),
    ("FUNCTION_BLOCK FB 1\nVAR\n x : TIMER;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK", "3:6: type TIMER is not supported"),
    ("DATA_BLOCK DB 1\nFB 1\nBEGIN\nEND_DATA_BLOCK", "1:1: unknown type FB1; did you mean DB1?"),
    (
        "DATA_BLOCK DB 1\nSTRUCT\n a : INT;\nEND_STRUCT;\nBEGIN\n a := 1.5;\nEND_DATA_BLOCK",
        "6:7: constant 1.5 is no INT (-32768 .. 32767)",
    ),
    (
        "FUNCTION FC 1 : VOID\nCONST\n A := 5;\nEND_CONST\nBEGIN\nEND_FUNCTION",
        "3:2: CONST does not exist in STL; use an input with a value",
    ),
    ("FUNCTION FC 1 : VOID\nBEGIN\nM1: \nEND_FUNCTION", "3:1: label M1 names no instruction; write NOP 0; behind it"),
    (
        "FUNCTION_BLOCK FB 1\nVAR\n x : INT; (* c *)\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK",
        "3:11: (* *) is no comment in STL; write //",
    ),
    (
        "ORGANIZATION_BLOCK OB 1\nVAR_INPUT\n x : INT;\nEND_VAR\nBEGIN\nEND_ORGANIZATION_BLOCK",
        "2:1: an OB has no VAR_INPUT here; its start information lies in the first 20 bytes of VAR_TEMP",
    ),
]


@pytest.mark.parametrize(("text", "expected"), BLOCKS)
def test_blocks(text: str, expected: str) -> None:
    assert message(text) == expected


def test_mnemonics_of_the_other_language() -> None:
    german = "FUNCTION FC 1 : VOID\nBEGIN\nU M 0.0; SPB M001; JU M001;\nM001: BEA;\nEND_FUNCTION"
    assert message(german) == "3:20: JU is English, other mnemonics here are German; write SPA"


def test_the_caret_stands_under_the_operand() -> None:
    with pytest.raises(SourceError) as caught:
        lower(parse(SourceText("f.awl", f"{HEAD}      L     #nix;  // why{TAIL}")))
    assert str(caught.value) == "f.awl:17:13: nix is not declared\n    L     #nix;  // why\n          ^^^^"


OPERANDS = [
    *["", "#x", "#i", "#p", "#s.a", "#arr[1]", "#t", "5", "L#5", "1.5", "W#16#F", "DW#16#5", "M 0.0", "MW 2", "MD 4"],
    *["DBW 0", "DIW 2", "DBD [AR1,P#0.0]", "D [AR1,P#2.0]", "P#2.0", "P#M 4.0", "P##arr", "M001", "FC 2", "FB 2, DB 2"],
    *["DB 5", "OV", "STW", "==0", "AR2", "T 5", "'AB'", "#m ( a := L#5, o := #i )", "LW 0", "DB5.DBD 0", "PIW 0"],
]
LINES = st.tuples(
    st.sampled_from(["", "M001: ", "M002: "]),
    st.sampled_from(sorted({*MNEMONICS, *CALLS, *UNSUPPORTED})),
    st.sampled_from(OPERANDS),
).map(lambda parts: f"{parts[0]}{parts[1]} {parts[2]};")


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(LINES, max_size=12))
def test_any_lines_are_executed_or_refused(lines: list[str]) -> None:
    text = HEAD + "\n".join(lines) + TAIL
    try:
        machine = Machine(lower(parse(SourceText("f.awl", text))), budget=1000)
    except SourceError as error:
        assert error.location is not None
        return
    try:
        machine.call("FB1", "DB100")
    except Fault as fault:
        assert fault.location is not None


def test_a_file_that_ends_behind_a_label() -> None:
    with pytest.raises(SourceError) as raised:
        parse(SourceText("f.awl", HEAD + "A:"))
    assert "an instruction expected, found the end of the file" in str(raised.value)


@settings(deadline=None)
@given(st.binary(max_size=200))
@example(b"A:")
def test_any_bytes_are_parsed_or_refused(data: bytes) -> None:
    try:
        parse(decode_source("f.awl", HEAD.encode() + data))
    except SourceError as error:
        assert error.location is not None or "UTF-16" in error.message
