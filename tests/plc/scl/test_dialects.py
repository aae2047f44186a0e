"""Which dialect a source speaks."""

from __future__ import annotations

import pytest

from plcgen.plc.scl.dialects import CLASSIC, RESERVED_WORDS, TIA, Dialect, detect_dialect
from plcgen.plc.source import decode_source


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        ("", CLASSIC),
        ("FUNCTION_BLOCK FB100\nVERSION : '1.0'\n", CLASSIC),
        ("TITLE = 'x'\nCONST N := 1; END_CONST", CLASSIC),
        ("FB100.DB100(in := 16#FF);", CLASSIC),
        ('FUNCTION_BLOCK "Fb"\nVERSION : 1.0\n', TIA),
        ("{ S7_Optimized_Access := 'TRUE' }", TIA),
        ("VAR CONSTANT N : Int := 1; END_VAR", TIA),
        ("x := #y;", TIA),
        ('"x" := #"two words";', TIA),
        ("REGION a\nx += 1;\nEND_REGION", TIA),
        ("// #x := 1\n(* VAR CONSTANT *) s := '#x';", CLASSIC),
        ("FUNCTION FC1 : VOID\nx := W#16#AB;", CLASSIC),
    ],
)
def test_detection(text: str, dialect: Dialect) -> None:
    assert detect_dialect(decode_source("f.scl", text.encode())) is dialect


def test_a_byte_order_mark_speaks_for_tia() -> None:
    assert detect_dialect(decode_source("f.scl", b"\xef\xbb\xbf" + b"x := 1;")) is TIA


@pytest.mark.parametrize(
    "word", ["IF", "END_FUNCTION_BLOCK", "REAL", "TOD", "LREAL", "REGION", "OK", "SQRT", "TON", "NAME"]
)
def test_reserved_words_span_both_dialects(word: str) -> None:
    assert word in RESERVED_WORDS


def test_reserved_words_are_upper_case() -> None:
    assert all(word == word.upper() for word in RESERVED_WORDS)
    assert CLASSIC.reserved <= RESERVED_WORDS
    assert TIA.reserved <= RESERVED_WORDS
