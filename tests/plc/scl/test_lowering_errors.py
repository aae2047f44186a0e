"""What a user reads when SCL cannot be lowered, word for word."""

from __future__ import annotations

import pytest

from plcgen.errors import SourceError
from plcgen.plc.scl.dialects import CLASSIC, TIA
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

CLASSIC_TEXT = """FUNCTION FC5 : INT
VAR_INPUT x : INT; y : REAL; END_VAR
VAR_OUTPUT z : INT; END_VAR
BEGIN
  FC5 := x;
  z := 1;
END_FUNCTION
FUNCTION FC6 : VOID
VAR_IN_OUT q : INT; END_VAR
BEGIN
  q := q + 1;
END_FUNCTION
FUNCTION_BLOCK FB2
VAR_INPUT x : INT; END_VAR
VAR_OUTPUT y : INT; END_VAR
BEGIN
  y := x;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB1
CONST K := 3; END_CONST
VAR_INPUT i : INT; d : DINT; r : REAL; w : WORD; b : BOOL; t : TIME; c : CHAR; END_VAR
VAR_OUTPUT speed : REAL; END_VAR
VAR a : ARRAY[1 .. 10] OF INT; unit : FB2; s : STRING[5]; END_VAR
BEGIN
@
END_FUNCTION_BLOCK
"""

TIA_TEXT = """FUNCTION_BLOCK "Ramp"
VERSION : 0.1
VAR_INPUT step : Real; END_VAR
VAR_OUTPUT out : Real; END_VAR
BEGIN
  #out := #step;
END_FUNCTION_BLOCK
FUNCTION_BLOCK "Drive"
VERSION : 0.1
VAR_INPUT acceleration : Real; count : DInt; w : Word; END_VAR
VAR ramp : "Ramp"; END_VAR
VAR CONSTANT LIMIT_HIGH : Real := 2.0; END_VAR
BEGIN
@
END_FUNCTION_BLOCK
"""


def error_of(text: str, dialect: object = CLASSIC) -> str:
    """The message for this text, with the column it points to."""
    source = SourceText("t.scl", text)
    chosen = TIA if dialect is TIA else CLASSIC
    with pytest.raises(SourceError) as error:
        lower(parse(source, chosen), chosen)
    assert error.value.location is not None
    return f"{error.value.location.column}: {error.value.message}"


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        # types
        ("r := r + d;", "8: no operator + for REAL and DINT; convert with DINT_TO_REAL"),
        ("r := d;", "6: DINT is no REAL; convert with DINT_TO_REAL"),
        ("d := r;", "6: REAL is no DINT; convert with REAL_TO_DINT"),
        ("i := d;", "6: DINT is no INT; convert with DINT_TO_INT"),
        ("w := i;", "6: INT is no WORD; convert with INT_TO_WORD"),
        ("i := t;", "6: TIME is no INT"),
        ("t := t + d;", "8: no operator + for TIME and DINT; convert with DINT_TO_TIME"),
        ("i := i + w;", "8: no operator + for INT and WORD; convert with WORD_TO_INT"),
        ("i := b + 1;", "8: no operator + for BOOL and INT; convert with BOOL_TO_INT"),
        ("r := d ** 2;", "8: no operator ** for DINT and INT; convert with DINT_TO_REAL"),
        ("r := ABS(w);", "6: no function ABS for WORD; convert with WORD_TO_INT"),
        ("r := -w;", "6: no operator - for WORD; convert with WORD_TO_INT"),
        ("IF i THEN i := 1; END_IF;", "4: INT is no BOOL; convert with INT_TO_BOOL"),
        ("b := r < 1 AND i;", "12: no operator AND for BOOL and INT; convert with INT_TO_BOOL"),
        # constants
        ("i := 70000;", "6: constant 70000 is no INT (-32768 .. 32767)"),
        ("i := 1.5;", "6: constant 1.5 is no INT (-32768 .. 32767)"),
        ("s := 'abcdefgh';", "6: 'abcdefgh' has 8 characters, STRING[5] holds 5"),
        ("c := 'xy';", "6: constant 'xy' is no CHAR"),
        ("K := 4;", "1: K is a constant; it cannot be assigned"),
        # names
        ("sped := 1.0;", "1: unknown name sped; did you mean speed?"),
        ("DB9.x := 1;", "1: unknown name DB9"),
        ("OK := TRUE;", "1: OK is not supported"),
        ("r.x := 1.0;", "2: REAL has no member x"),
        ("unit.yy := 1;", "5: FB2 has no member yy; did you mean y?"),
        # arrays
        ("i := a[11];", "8: index 11 outside 1 .. 10"),
        ("i := a[1, 2];", "7: 2 indices for the 1 of ARRAY[1..10] OF INT"),
        ("i := a[r];", "8: REAL is no DINT; convert with REAL_TO_DINT"),
        ("i := a;", "6: ARRAY[1..10] OF INT is no INT"),
        # statements
        ("EXIT;", "1: EXIT outside a loop"),
        ("CASE r OF 1: i := 1; END_CASE;", "6: CASE needs an INT, not REAL"),
        ("CASE i OF i: i := 2; END_CASE;", "11: a CASE label must be a constant"),
        ("FOR r := 1 TO 2 DO i := 1; END_FOR;", "5: FOR needs an INT or DINT variable, not REAL"),
        # calls
        ("foo(x := 1);", "1: unknown block or function foo; did you mean FLOOR?"),
        ("FC7();", "1: unknown block or function FC7; did you mean FC6?"),
        ("i := FC5(x := 1, y := 2);", "6: FC5 needs parameter z"),
        ("i := FC5(x := 1, yy := 2, z := i);", "18: FC5 has no parameter yy; did you mean y?"),
        ("i := FC5(1, 2.0, i);", "10: name the parameter of FC5, as in `x := ...`"),
        ("i := FC6(q := i);", "6: FC6 gives no value"),
        ("FC6(q := 5);", "10: q is read and written; give it a variable of type INT"),
        ("FB2(x := 5);", "1: FB2 is an FB; call it with an instance, as FB2.DB1( )"),
        ("FB2.DB8(x := 5, y := i);", "17: y is an output of FB2; read it from the instance after the call"),
        ("unit(x := 1, x := 2);", "14: x is given twice"),
        ("unit(x := 1.5);", "11: constant 1.5 is no INT (-32768 .. 32767)"),
        ("i(x := 1);", "1: i is INT; it cannot be called"),
        ("r := SIN(r, r);", "6: SIN takes one argument"),
        ("r := LIMIT(MN := r, IN := r);", "6: LIMIT takes MN, IN, MX"),
    ],
)
def test_classic_statement(statement: str, message: str) -> None:
    assert error_of(CLASSIC_TEXT.replace("@", statement)) == message


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        (
            "#acceleration := #acceleration + #count;",
            "32: no operator + for REAL and DINT; convert with DINT_TO_REAL",
        ),
        ("#ramp(out := #acceleration);", "7: out is an output of Ramp; write out => ..."),
        ("#ramp(step => #acceleration);", "7: step is no output of Ramp; write step := ..."),
        ("#acceleration := LOG(#acceleration);", "18: no LOG in TIA; write LN(x) * 0.4342945"),
        ("#LIMIT_HIGH := 1.0;", "1: LIMIT_HIGH is a constant; it cannot be assigned"),
        ("#w.%X16 := TRUE;", "3: slice %X16 outside 0 .. 15"),
        ("#acceleration.%X1 := TRUE;", "14: REAL has no slice %X"),
        ('"Dirve"();', "1: unknown block or function Dirve; did you mean Drive?"),
    ],
)
def test_tia_statement(statement: str, message: str) -> None:
    assert error_of(TIA_TEXT.replace("@", statement), TIA) == message


@pytest.mark.parametrize(
    ("declaration", "message"),
    [
        ("x : FB9;", "5: unknown type FB9; did you mean FB1?"),
        ("x : ARRAY[1 .. 0] OF INT;", "16: array bounds 1 .. 0 run backwards"),
        ("x : INT := 1.5;", "12: constant 1.5 is no INT (-32768 .. 32767)"),
        ("x : ARRAY[1 .. 2] OF INT := 1, 2, 3;", "29: 3 initial values for 2 elements"),
        ("x : INT; X : REAL;", "10: X is declared twice"),
        ("K : INT;", "1: K is a constant already"),
        ("x : STRING[255];", "12: STRING length 255 outside 1 .. 254"),
        (
            "x : ARRAY[0 .. 99999999] OF REAL;",
            "5: ARRAY[0..99999999] OF REAL takes 400000000 bytes, more than any CPU has",
        ),
        ("x : STRING[5] := 'abcdefgh';", "18: 'abcdefgh' has 8 characters, STRING[5] holds 5"),
        ("x : ANY;", "5: type ANY is not supported"),
        ("x : FB1;", "5: FB1 contains itself"),
        ("x : WORD; y AT x : DWORD;", "11: y has 32 bits, x beneath it only 16"),
    ],
)
def test_declaration(declaration: str, message: str) -> None:
    text = f"FUNCTION_BLOCK FB1\nCONST K := 3; END_CONST\nVAR\n{declaration}\nEND_VAR\nBEGIN\n;\nEND_FUNCTION_BLOCK\n"
    assert error_of(text) == message


def test_constant_without_a_value() -> None:
    text = "FUNCTION_BLOCK FB1\nCONST A := 1.0 / 0.0; END_CONST\nBEGIN\n;\nEND_FUNCTION_BLOCK\n"
    assert error_of(text) == "16: constant expression has no value: / of these operands is a fault"


def test_block_that_stands_twice() -> None:
    text = "FUNCTION FC1 : VOID\nBEGIN\n;\nEND_FUNCTION\n"
    assert error_of(text + text).endswith("FUNCTION FC1 stands twice")


def test_message_shows_the_line() -> None:
    with pytest.raises(SourceError) as error:
        source = SourceText("profile.scl", CLASSIC_TEXT.replace("@", "  speed := speed + d;"))
        lower(parse(source, CLASSIC), CLASSIC)
    assert str(error.value) == (
        "profile.scl:25:18: no operator + for REAL and DINT; convert with DINT_TO_REAL\n"
        "    speed := speed + d;\n"
        "                   ^"
    )
