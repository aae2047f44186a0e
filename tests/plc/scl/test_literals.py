"""Values of literals, and what their spellings are refused for."""

from __future__ import annotations

import pytest

from plcgen.errors import SourceError
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import Assignment, Literal
from plcgen.plc.source import SourceText


def literal(text: str, dialect: Dialect = CLASSIC) -> Literal:
    (block,) = parse(SourceText("f.scl", f"FUNCTION FC1 : VOID\nBEGIN\nx := {text};\nEND_FUNCTION"), dialect)
    (statement,) = block.body
    assert isinstance(statement, Assignment)
    assert isinstance(statement.value, Literal)
    return statement.value


@pytest.mark.parametrize(
    ("text", "value", "type_name"),
    [
        ("12", 12, None),
        ("1_000", 1000, None),
        ("-2147483648", -2147483648, None),
        ("3.0E10", 3.0e10, None),
        ("3E10", 3.0e10, None),
        ("-1_0.2_5", -10.25, None),
        ("16#FF", 255, None),
        ("2#1111_0000", 240, None),
        ("8#17", 15, None),
        ("16#FFFF_FFFF", 2**32 - 1, None),
        ("TRUE", True, "BOOL"),
        ("false", False, "BOOL"),
        ("BOOL#1", True, "BOOL"),
        ("BOOL#FALSE", False, "BOOL"),
        ("INT#5", 5, "INT"),
        ("INT#-5", -5, "INT"),
        ("INT#16#7F", 127, "INT"),
        ("INT#16#FFFF", -1, "INT"),
        ("DINT#16#8000_0000", -(2**31), "DINT"),
        ("L#5", 5, "DINT"),
        ("DINT#-2147483648", -2147483648, "DINT"),
        ("REAL#1.5", 1.5, "REAL"),
        ("real#-3", -3.0, "REAL"),
        ("B#16#F", 15, "BYTE"),
        ("BYTE#255", 255, "BYTE"),
        ("W#16#00FF", 255, "WORD"),
        ("WORD#2#11", 3, "WORD"),
        ("DW#16#7F80_0000", 0x7F800000, "DWORD"),
        ("dword#32768", 32768, "DWORD"),
        ("T#1d2h3m4s5ms", 93784005, "TIME"),
        ("TIME#1d_2h", 93600000, "TIME"),
        ("T#-1.5s", -1500, "TIME"),
        ("t#250ms", 250, "TIME"),
        ("D#1990-1-1", 0, "DATE"),
        ("DATE#1991-01-01", 365, "DATE"),
        ("TOD#0:0:1", 1000, "TIME_OF_DAY"),
        ("TIME_OF_DAY#23:59:59.999", 86399999, "TIME_OF_DAY"),
        ("TOD#1:2:3.5", 3723500, "TIME_OF_DAY"),
        ("S5T#10ms", 0x0001, "S5TIME"),
        ("S5T#9s990ms", 0x0999, "S5TIME"),
        ("S5T#12s345ms", 0x1123, "S5TIME"),
        ("S5TIME#2h46m30s", 0x3999, "S5TIME"),
        ("DT#1990-1-2-3:4:5.678", 0x9001020304056783, "DATE_AND_TIME"),
        ("DATE_AND_TIME#95-01-01-12:12:12.2", 0x9501011212122001, "DATE_AND_TIME"),
        ("'a'", "a", None),
        ("'It$'s $$5$L$41'", "It's $5\nA", None),
        ("CHAR#'x'", "x", "CHAR"),
        ("CHAR#49", "1", "CHAR"),
        ("STRING#'ab'", "ab", "STRING"),
    ],
)
def test_values(text: str, value: object, type_name: str | None) -> None:
    found = literal(text)
    assert (found.value, type(found.value), found.type_name) == (value, type(value), type_name)


def test_spelling_in_another_base_is_marked() -> None:
    assert [literal(text).based for text in ("5", "16#5", "INT#5", "INT#2#1")] == [False, True, False, True]


def test_tia_holds_the_wide_types() -> None:
    assert literal("ULINT#18446744073709551615", TIA).value == 2**64 - 1
    assert literal("LREAL#1.0E300", TIA).value == 1e300


def test_the_sign_belongs_to_the_number_unless_a_power_follows() -> None:
    assert literal("-5").span == (len("FUNCTION FC1 : VOID\nBEGIN\nx := "), len("FUNCTION FC1 : VOID\nBEGIN\nx := -5"))


BAD = [
    (CLASSIC, "INT#40000", "INT#40000 is outside the range of INT: -32768 to 32767"),
    (CLASSIC, "INT#16#1_0000", "INT#16#1_0000 is outside the range of INT: -32768 to 32767"),
    (CLASSIC, "INT#-16#8001", "INT#-16#8001 is outside the range of INT: -32768 to 32767"),
    (CLASSIC, "BYTE#-1", "BYTE#-1 is outside the range of BYTE: 0 to 255"),
    (CLASSIC, "2147483648", "2147483648 is outside the range of an integer: -2147483648 to 2147483647"),
    (CLASSIC, "9" * 50, f"{'9' * 20}... has 50 digits; 20 are the most an integer can have"),
    (CLASSIC, "INT#1.5", "INT#1.5 has a fraction; write REAL#1.5 or drop it"),
    (CLASSIC, "INT#TRUE", "TRUE is not a number"),
    (CLASSIC, "BOOL#2", "BOOL#2 is outside the range of BOOL: 0 to 1"),
    (CLASSIC, "1.0E39", "1.0E39 is outside the range of REAL: 1.175495E-38 to 3.402823E+38"),
    (CLASSIC, "REAL#1.0E-40", "1.0E-40 is outside the range of REAL: 1.175495E-38 to 3.402823E+38"),
    (CLASSIC, "1.0E-400", "1.0E-400 is too small for a REAL; write 0.0"),
    (TIA, "1e-07", "REAL literal 1e-07 needs a point in TIA; write 1.0E-07"),
    (TIA, "REAL#3E10", "REAL literal 3E10 needs a point in TIA; write 3.0E10"),
    (CLASSIC, "LREAL#1.0", "LREAL# is not a literal type of STEP 7 V5"),
    (CLASSIC, "FOO#5", "FOO# is not a literal type of STEP 7 V5"),
    (CLASSIC, "P#M0.0", "pointers (P#) are not supported; name the variable itself"),
    (CLASSIC, "16#", "16# has no digits; write 16#0"),
    (CLASSIC, "16#FG", "16#FG has a digit that base 16 lacks"),
    (CLASSIC, "8#8", "8#8 has a digit that base 8 lacks"),
    (CLASSIC, "10#5", "10#5: base 10 does not exist; write 2#, 8# or 16#"),
    (CLASSIC, "2#" + "1" * 90, f"2#{'1' * 20}... has 90 digits; 64 bits are the most"),
    (CLASSIC, "T#5x", "T#5x is not a duration; write T#1d2h3m4s5ms"),
    (CLASSIC, "T#3s2m", "T#3s2m is not a duration; write T#1d2h3m4s5ms"),
    (CLASSIC, "T#30d", "T#30d (in ms) is outside the range of TIME: -2147483648 to 2147483647"),
    (CLASSIC, "S5T#3h", "S5T#3h (in ms) is outside the range of S5TIME: 0 to 9990000"),
    (CLASSIC, "D#1990-13-1", "D#1990-13-1 is not a date; write D#1990-1-31"),
    (CLASSIC, "D#1989-1-1", "D#1989-1-1 is outside the range of DATE: 1990-01-01 to 2168-12-31"),
    (CLASSIC, "TOD#25:00:00", "TOD#25:00:00 is not a time of day; write TOD#23:59:59.999"),
    (CLASSIC, "DT#1990-1-1", "DT#1990-1-1 is not a date and time; write DT#1990-1-31-23:59:59.999"),
    (CLASSIC, "DT#2100-1-1-0:0:0", "DT#2100-1-1-0:0:0 is outside the range of DATE_AND_TIME: 1990 to 2089"),
    (CLASSIC, "CHAR#'ab'", "CHAR#'ab' has 2 characters; CHAR holds exactly one"),
    (CLASSIC, "'ж'", "'ж' does not fit CHAR and STRING (8 bits a character); write ASCII"),
    (CLASSIC, "CHAR#'ж'", "'ж' does not fit CHAR and STRING (8 bits a character); write ASCII"),
    (CLASSIC, f"'{'x' * 255}'", "text of 255 characters; a STRING holds at most 254, split it"),
    (CLASSIC, "STRING#5", "STRING#5 needs quotes; write '5'"),
    (CLASSIC, "'a$q'", "$q is not an escape in a string; write $$ for a dollar sign"),
]


@pytest.mark.parametrize(("dialect", "text", "message"), BAD)
def test_bad_literals(dialect: Dialect, text: str, message: str) -> None:
    with pytest.raises(SourceError) as caught:
        literal(text, dialect)
    assert str(caught.value).split("\n")[0] == f"f.scl:3:6: {message}"
