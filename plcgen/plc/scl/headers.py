"""Block headers: the name of a block, and the lines between it and its sections, in both spellings."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from plcgen.plc.lexer import STRING, Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.declarations import attributes
from plcgen.plc.scl.dialects import STRUCTURE_WORDS
from plcgen.plc.scl.syntax import Header

ABSOLUTE_NAMES = ("FB", "FC", "OB", "DB", "UDT")
_QUOTED = re.compile(rf"({STRING})(?=$|\s|[;{{]|//|\(\*)\s*;?")
_QUOTED_LINE = re.compile(rf"({STRING})\s*(?://.*|\(\*.*\*\)\s*|;\s*)?$")
_COMMENT = re.compile(r"\s*(?://|\(\*|;).*")


def block_name(tokens: Cursor) -> Token:
    """`FB100`, `FB 100`, `"Name"` or `Name`; the token's name is without quotes and blanks."""
    token = tokens.current
    if token.word in STRUCTURE_WORDS:
        raise tokens.unexpected("the name of the block")
    tokens.expect_kind("the name of the block", TokenKind.NAME, TokenKind.GLOBAL)
    if token.word in ABSOLUTE_NAMES and tokens.current.text.isdigit():
        number = tokens.advance()
        return token._replace(text=token.text + number.text, span=token.span.to(number.span))
    return token


def header(tokens: Cursor) -> Header:
    """Header lines in any order."""
    result = Header()
    while (read := _LINES.get(tokens.current.word)) is not None:
        result = read(tokens, result)
    return result


def _title(tokens: Cursor, result: Header) -> Header:
    """Free text: without quotes, or where a title needs none, everything up to the end of the line belongs to it."""
    quotes = tokens.dialect.header_quotes
    tokens.advance()
    tokens.expect("=", "write TITLE = 'text'" if quotes else "write TITLE = text")
    quoted = tokens.accept_text(_QUOTED if quotes else _QUOTED_LINE)
    return replace(result, title=quoted.group(1)[1:-1] if quoted else tokens.rest_of_line().text)


def _word(field: str) -> Callable[[Cursor, Header], Header]:
    def read(tokens: Cursor, result: Header) -> Header:
        changes: dict[str, Any] = {field: _value(tokens)}
        return replace(result, **changes)

    return read


def _value(tokens: Cursor) -> str:
    keyword = tokens.advance()
    tokens.expect(":", f"write {keyword.word} : value")
    quoted = tokens.accept_text(_QUOTED)
    value = quoted.group(1)[1:-1] if quoted else _COMMENT.sub("", tokens.rest_of_line().text)
    if not value:
        raise tokens.error(f"{keyword.word} has no value; write it behind the colon", tokens.previous.span)
    return value


def _protect(tokens: Cursor, result: Header) -> Header:
    tokens.advance()
    return replace(result, know_how_protect=True)


def _flag(tokens: Cursor, result: Header) -> Header:
    """Words that only concern loading: kept as attributes, they change nothing here."""
    word = tokens.advance().word
    return replace(result, attributes=(*result.attributes, (word, "TRUE")))


def _attributes(tokens: Cursor, result: Header) -> Header:
    return replace(result, attributes=(*result.attributes, *attributes(tokens)))


_LINES: dict[str, Callable[[Cursor, Header], Header]] = {
    "TITLE": _title,
    "VERSION": _word("version"),
    "AUTHOR": _word("author"),
    "FAMILY": _word("family"),
    "NAME": _word("name"),
    "KNOW_HOW_PROTECT": _protect,
    "NON_RETAIN": _flag,
    "RETAIN": _flag,
    "READ_ONLY": _flag,
    "UNLINKED": _flag,
    "{": _attributes,
}
