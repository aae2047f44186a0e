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
FUNCTION_BLOCK FB7
VAR_OUTPUT y : INT; END_VAR
BEGIN
  y := 1;
END_FUNCTION_BLOCK
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
VAR a : ARRAY[1 .. 10] OF INT; unit, other : FB2; units : ARRAY[0 .. 1] OF FB2;
p : STRUCT x : INT; y : REAL; END_STRUCT; q : STRUCT x : INT; y : INT; END_STRUCT; s : STRING[5]; END_VAR
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
        ("IF i THEN i := 1; END_IF;", "4: INT is no BOOL; compare it, as in i <> 0"),
        ("b := a[1];", "6: INT is no BOOL; compare it, as in x <> 0"),
        ("b := r < 1 AND i;", "12: no operator AND for BOOL and INT; compare the INT, as in x <> 0"),
        # constants
        ("i := 70000;", "6: constant 70000 is no INT (-32768 .. 32767)"),
        ("i := 1.5;", "6: constant 1.5 is no INT (-32768 .. 32767)"),
        ("s := 'abcdefgh';", "6: 'abcdefgh' has 8 characters, STRING[5] holds 5"),
        ("c := 'xy';", "6: constant 'xy' is no CHAR"),
        ("K := 4;", "1: K is a constant; it cannot be assigned"),
        # names
        ("sped := 1.0;", "1: unknown name sped; did you mean speed?"),
        ("DB9.x := 1;", "1: unknown name DB9"),
        ("OK := TRUE;", "1: OK is not supported; test the operands before, or the range of the result"),
        ("b := ENO;", "6: ENO is not supported; give the block an output for its errors"),
        ("FC6(EN := b, q := i);", "5: EN is not supported; put the call into IF ... END_IF"),
        ("i := FC5;", "6: FC5 is a FUNCTION; call it as FC5( )"),
        ("i := FB2;", "6: FB2 is a FUNCTION_BLOCK; name an instance of it"),
        ('b := "Start";', '6: "Start" is no block here, and PLC tags are not read; write the address, such as %M0.0'),
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
        ("CASE i OF 1: i := 2; 1: i := 3; END_CASE;", "22: CASE label 1 overlaps 1 above; remove one"),
        (
            "CASE i OF 5 .. 9: i := 2; 1, 3 .. 5: i := 3; END_CASE;",
            "30: CASE label 3 .. 5 overlaps 5 .. 9 above; remove one",
        ),
        ("CASE i OF 5 .. 1: i := 2; END_CASE;", "11: CASE label 5 .. 1 runs backwards"),
        ("p := q;", "6: STRUCT is no STRUCT: they differ in y : INT and y : REAL"),
        ("units := units;", "1: an instance of FB2 cannot be assigned; assign its members one by one"),
        ("unit := other;", "1: an instance of FB2 cannot be assigned; assign its members one by one"),
        ("FB7.DB7(i);", "9: name the parameter of FB7, as in `x := ...`"),
        ("CASE i OF i: i := 2; END_CASE;", "11: a CASE label must be a constant"),
        ("FOR r := 1 TO 2 DO i := 1; END_FOR;", "5: FOR needs an INT or DINT variable, not REAL"),
        # calls
        ("foo(x := 1);", "1: unknown block or function foo; did you mean FLOOR?"),
        ("i := LEN('ab');", "6: LEN is not supported yet; a block LEN in your source can stand in for it"),
        (
            "i := BCD_TO_INT(w);",
            "6: BCD_TO_INT is not supported yet; a block BCD_TO_INT in your source can stand in for it",
        ),
        (
            "s := INT_TO_STRING(i);",
            "6: INT_TO_STRING is not supported yet; a block INT_TO_STRING in your source can stand in for it",
        ),
        ("i := SFC64();", "6: SFC64 is not supported yet; a block SFC64 in your source can stand in for it"),
        ("r := DINT_TO_RAEL(d);", "6: unknown block or function DINT_TO_RAEL"),
        ("FC7();", "1: unknown block or function FC7; did you mean FC6?"),
        ("i := FC5(x := 1, y := 2);", "6: FC5 needs parameter z"),
        ("i := FC5(x := 1, yy := 2, z := i);", "18: FC5 has no parameter yy; did you mean y?"),
        ("i := FC5(1, 2.0, i);", "10: name the parameter of FC5, as in `x := ...`"),
        ("i := FC6(q := i);", "6: FC6 gives no value"),
        ("i := FC5(x := 1, y := 2.0, z := 5);", "33: z is an output; give it a variable to write to"),
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
        ("IF #count THEN ; END_IF;", "4: DINT is no BOOL; compare it, as in #count <> 0"),
        ('#w := "Start";', '7: "Start" is no block here, and PLC tags are not read; write the address, such as %M0.0'),
        ("#acceleration := 5 DIV 2;", "20: no DIV in TIA; write /"),
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
        ("x : TON;", "5: TON is not supported yet; a FUNCTION_BLOCK TON in your source can stand in for it"),
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
        ("x : STRUCT a : INT; A : REAL; END_STRUCT;", "21: A is declared twice"),
        ("x : STRUCT END_STRUCT;", "5: STRUCT has no members; declare one or remove it"),
        (
            "x : ARRAY[0 .. 1] OF ARRAY[2 .. 3] OF INT;",
            "5: ARRAY OF ARRAY does not exist; write ARRAY[0..1, 2..3] OF INT",
        ),
        ("x : INT := [1];", "12: INT takes one initial value; a list is for an ARRAY"),
        ("x : ARRAY[1 .. 9] OF INT := 2000000000(0);", "29: 2000000000 initial values for 9 elements"),
        ("x : ARRAY[1 .. 9] OF INT := 30000(30000(0));", "29: 900000000 initial values for 9 elements"),
        ("x : ARRAY[1 .. 9] OF INT := -3(1);", "29: repetition factor -3 is below 1"),
        ("y AT x : WORD; x : WORD;", "1: x is not declared before its view in this section"),
        ("x : WORD; y AT x : WORD := 5;", "28: y is a view; give the initial value to x"),
        ("x : WORD; y AT x : DWORD;", "11: y has 32 bits, x beneath it only 16"),
    ],
)
def test_declaration(declaration: str, message: str) -> None:
    text = f"FUNCTION_BLOCK FB1\nCONST K := 3; END_CONST\nVAR\n{declaration}\nEND_VAR\nBEGIN\n;\nEND_FUNCTION_BLOCK\n"
    assert error_of(text) == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "FUNCTION_BLOCK FB1\nVAR_TEMP x : INT := 5; END_VAR BEGIN END_FUNCTION_BLOCK",
            "21: x takes no initial value: only VAR of an FB keeps one; assign it at the start of the body",
        ),
        (
            "FUNCTION FC1 : VOID\nVAR x : STRUCT a : INT := 5; END_STRUCT END_VAR BEGIN END_FUNCTION",
            "27: a takes no initial value: only VAR of an FB keeps one; assign it at the start of the body",
        ),
        (
            "FUNCTION FC1 : VOID\nVAR_INPUT x : INT := 5; END_VAR BEGIN END_FUNCTION",
            "22: x takes no initial value: every call of an FC gives it a value; remove it here",
        ),
        (
            "FUNCTION FC1 : VOID\nVAR_OUTPUT x : INT := 5; END_VAR BEGIN END_FUNCTION",
            "23: x takes no initial value: an output of an FC begins without one; assign it at the start of the body",
        ),
        (
            "ORGANIZATION_BLOCK OB1\nVAR_INPUT x : BOOL; END_VAR BEGIN END_ORGANIZATION_BLOCK",
            "1: an OB has no VAR_INPUT here; its start information lies in the first 20 bytes of VAR_TEMP",
        ),
        (
            "FUNCTION_BLOCK FB2 BEGIN END_FUNCTION_BLOCK\nFUNCTION FC1 : VOID\n"
            "VAR x : ARRAY[0 .. 1] OF FB2; END_VAR BEGIN END_FUNCTION",
            "5: x is an instance of FB2, which must outlast a call; declare it in VAR of an FB",
        ),
        ("FUNCTION_BLOCK FB1 CONST A := 1; a := 2; END_CONST BEGIN END_FUNCTION_BLOCK", "34: a is declared twice"),
        ("DATA_BLOCK DB1 STRUCT a : INT; a : INT; END_STRUCT BEGIN END_DATA_BLOCK", "32: a is declared twice"),
        ("TYPE UDT1 STRUCT END_STRUCT END_TYPE", "1: UDT1 has no members; declare one or remove it"),
    ],
)
def test_block(text: str, message: str) -> None:
    assert error_of(text) == message


@pytest.mark.parametrize("callee_first", [False, True])
def test_nesting_of_types_is_bounded(callee_first: bool) -> None:
    blocks = ["TYPE UDT0 STRUCT y : INT; END_STRUCT END_TYPE"]
    blocks += [f"TYPE UDT{n} STRUCT y : UDT{n - 1}; END_STRUCT END_TYPE" for n in range(1, 200)]
    text = " ".join(blocks if callee_first else blocks[::-1])
    assert error_of(text).endswith(": types nested deeper than 64 levels; flatten them")


def test_size_of_structures_is_bounded() -> None:
    blocks = ["TYPE UDT0 STRUCT y : INT; END_STRUCT END_TYPE"]
    blocks += [f"TYPE UDT{n} STRUCT y, z : UDT{n - 1}; END_STRUCT END_TYPE" for n in range(1, 40)]
    assert error_of(" ".join(blocks)).endswith("UDT24 takes 33554432 bytes, more than any CPU has")


@pytest.mark.parametrize("opened", ["ABS(", "FC1(", "t[", "(", "a OR a XOR a AND a = a < a + a * ("])
def test_deepest_expressions_are_lowered_or_refused(opened: str) -> None:
    """Whatever the parser lets through, no later pass runs out of stack."""
    closed = "]" if opened == "t[" else ")"
    head = (
        "FUNCTION FC1 : INT VAR_INPUT x : INT; END_VAR BEGIN FC1 := x; END_FUNCTION "
        "FUNCTION_BLOCK FB1 VAR a : INT; t : ARRAY[0 .. 1] OF INT; END_VAR BEGIN "
    )
    for depth in range(1, 80):
        nested = opened * depth + " + ".join("a" * 150) + closed * depth
        text = f"{head} a := {nested}; END_FUNCTION_BLOCK"
        try:
            lower(parse(SourceText("t.scl", text), CLASSIC), CLASSIC)
        except SourceError as error:
            assert error.location is not None


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
        "profile.scl:31:18: no operator + for REAL and DINT; convert with DINT_TO_REAL\n"
        "    speed := speed + d;\n"
        "                   ^"
    )
