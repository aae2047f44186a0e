"""Tokens of both SCL dialects."""

from __future__ import annotations

import pytest

from plcgen.errors import SourceError
from plcgen.plc.lexer import SCL_CLASSIC, SCL_TIA, Lexer, Lexicon, TokenKind, tokens
from plcgen.plc.source import SourceText


def kinds(text: str, lexicon: Lexicon = SCL_CLASSIC) -> list[tuple[str, str]]:
    return [(token.kind.name, token.text) for token in tokens(SourceText("f.scl", text), lexicon)]


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("x_1", "NAME"),
        ("_x", "NAME"),
        ("#x", "LOCAL"),
        ('#"two words"', "LOCAL"),
        ('"Motor 1"', "GLOBAL"),
        ("12", "NUMBER"),
        ("1_000", "NUMBER"),
        ("3.0E10", "NUMBER"),
        ("3E10", "NUMBER"),
        ("1.5e-07", "NUMBER"),
        ("16#FF_FF", "NUMBER"),
        ("2#1010", "NUMBER"),
        ("DW#16#FF", "TYPED"),
        ("INT#-5", "TYPED"),
        ("REAL#1.5E-3", "TYPED"),
        ("BOOL#TRUE", "TYPED"),
        ("T#1d_2h3m4.5s", "TYPED"),
        ("D#1990-1-1", "TYPED"),
        ("TOD#12:30:10.5", "TYPED"),
        ("DT#1990-1-1-12:30:10", "TYPED"),
        ("CHAR#'a'", "TYPED"),
        ("'It$'s'", "STRING"),
        ("''", "STRING"),
        ("M0.0", "ADDRESS"),
        ("%MW10", "ADDRESS"),
        ("%IW4:P", "ADDRESS"),
        ("PEW256", "ADDRESS"),
        ("DB100.DBD4", "ADDRESS"),
        ("DB100.DX0.1", "ADDRESS"),
        ("%DB1.DBX0.0", "ADDRESS"),
        ("%X3", "SLICE"),
        ("**", "OPERATOR"),
        ("..", "OPERATOR"),
        ("=>", "OPERATOR"),
    ],
)
def test_one_token(text: str, kind: str) -> None:
    assert kinds(text) == [(kind, text)]


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("1..5", ["1", "..", "5"]),
        ("x:=-1", ["x", ":=", "-", "1"]),
        ("a<=b", ["a", "<=", "b"]),
        ("NOT#x", ["NOT", "#x"]),
        ("INT#5-3", ["INT#5", "-", "3"]),
        ("DB100.out", ["DB100", ".", "out"]),
        ("FB100.DB100(", ["FB100", ".", "DB100", "("]),
        ("a (* b\n* c *) d // e\nf", ["a", "d", "f"]),
        ("(**)a", ["a"]),
        ("'a//b' c", ["'a//b'", "c"]),
        ("x.%X3", ["x", ".", "%X3"]),
    ],
)
def test_token_borders(text: str, parts: list[str]) -> None:
    assert [part for _, part in kinds(text)] == parts


def test_words_are_upper_case_and_names_bare() -> None:
    first, second = tokens(SourceText("f.scl", 'begin #"two words"'), SCL_TIA)
    assert (first.word, first.name) == ("BEGIN", "begin")
    assert (second.word, second.name) == ("", "two words")


def test_tia_reads_a_bare_word_address_as_a_name() -> None:
    assert kinds("MW10", SCL_CLASSIC) == [("ADDRESS", "MW10")]
    assert kinds("MW10", SCL_TIA) == [("NAME", "MW10")]


def test_tia_names_may_hold_letters_of_any_language() -> None:
    assert kinds("#gr\u00f6\u00dfe", SCL_TIA) == [("LOCAL", "#gr\u00f6\u00dfe")]


def test_multilingual_comments_of_tia() -> None:
    assert kinds("a (/* x *) y */) b", SCL_TIA) == [("NAME", "a"), ("NAME", "b")]


def test_the_line_end_leaves_the_line_break_out() -> None:
    lexer = Lexer(SourceText("f.scl", "TITLE = don't\r\nnext"), SCL_TIA)
    assert lexer.line_end(7) == 13
    assert lexer.token(13).text == "next"
    assert lexer.token(19).kind is TokenKind.END


BAD = [
    ("x := @;", "f.scl:1:6: unknown character @ (U+0040) outside comments and strings; remove it"),
    ("\u00e9", "f.scl:1:1: unknown character (U+00E9) outside comments and strings; remove it"),
    ("x\n (* a", "f.scl:2:2: comment is not closed; add *)"),
    ("(* a (* b *) c *)", "f.scl:1:16: *) without (*: comments do not nest; remove the inner (*"),
    ("'abc\n'", "f.scl:1:1: string is not closed on this line; add '"),
    ('"abc\n', 'f.scl:1:1: name is not closed on this line; add "'),
    ('"a\0c"', "f.scl:1:1: control character in a name; remove it"),
    ('#"a\tc"', "f.scl:1:1: control character in a name; remove it"),
    ("1abc", "f.scl:1:1: 1abc is neither a number nor a name; names start with a letter"),
    ("1.5x", "f.scl:1:1: 1.5x is neither a number nor a name; names start with a letter"),
    ("3E", "f.scl:1:1: 3E is neither a number nor a name; names start with a letter"),
    ("1.", "f.scl:1:1: 1. needs a digit after the point; write 1.0"),
    (".5", "f.scl:1:1: .5 needs a digit before the point; write 0.5"),
    ("T#", "f.scl:1:1: T# has no value; write one behind the #"),
    ("a == b", "f.scl:1:3: == is not an SCL operator; write = to compare"),
    ("a != b", "f.scl:1:3: != is not an SCL operator; write <>"),
    ("a && b", "f.scl:1:3: && is not an SCL operator; write AND"),
    ("a || b", "f.scl:1:3: || is not an SCL operator; write OR"),
    ("a ^ b", "f.scl:1:3: ^ is not an SCL operator; write ** for a power"),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_bad_characters(text: str, message: str) -> None:
    with pytest.raises(SourceError) as caught:
        kinds(text)
    assert str(caught.value).split("\n")[0] == message
