"""Rules about the text of an SCL source: bytes, lines, comments, header lines."""

from __future__ import annotations

import re
from collections.abc import Iterator

from plcgen.plc.importrules.finding import Hit, Subject
from plcgen.plc.scl.syntax import Block
from plcgen.plc.source import BYTE_ORDER_MARK, EIGHT_BIT, UTF_8, Span

MAX_LINE = 126
MAX_HEADER_WORD = 8
START = Span(0, 1)

# ---------------------------------------------------------------------------------------------------------- bytes


def no_byte_order_mark(subject: Subject) -> Iterator[Hit]:
    if subject.raw.startswith(BYTE_ORDER_MARK):
        yield START, "STEP 7 V5 reads the byte order mark as text; save as ANSI or ASCII"


def byte_order_mark(subject: Subject) -> Iterator[Hit]:
    if not subject.raw.startswith(BYTE_ORDER_MARK):
        yield START, "no byte order mark, TIA may read another code page; save as UTF-8 with BOM"


def utf8(subject: Subject) -> Iterator[Hit]:
    place = _first_wide(subject)
    if subject.source.encoding != UTF_8 and place:
        yield place, "not UTF-8: this character depends on the code page of the PC; save as UTF-8 with BOM"


def one_byte_characters(subject: Subject) -> Iterator[Hit]:
    place = _first_wide(subject)
    if subject.source.encoding == UTF_8 and place:
        yield place, "UTF-8 character of several bytes, which STEP 7 V5 reads as several characters; write ASCII"


def plain_ascii(subject: Subject) -> Iterator[Hit]:
    """Chinese is left alone: who writes it has a Chinese Windows."""
    place = _first_wide(subject)
    if subject.source.encoding == EIGHT_BIT and place:
        yield place, "this character depends on the code page of the PC; ASCII is safe everywhere"


def _first_wide(subject: Subject) -> Span | None:
    match = re.search(r"[^\x00-\x7f]", subject.source.text)
    return Span(*match.span()) if match else None


# ---------------------------------------------------------------------------------------------------------- lines


def crlf(subject: Subject) -> Iterator[Hit]:
    bare = [match.start() for match in re.finditer(r"(?<!\r)\n", subject.source.text)]
    if bare:
        yield Span(bare[0], bare[0]), f"{len(bare)} lines end with LF alone, this is the first; save with CRLF"


def line_length(subject: Subject) -> Iterator[Hit]:
    for match in re.finditer(rf"[^\r\n]{{{MAX_LINE + 1},}}", subject.source.text):
        start = match.start() + MAX_LINE
        yield Span(start, match.end()), f"line of {len(match.group())} characters; {MAX_LINE} are the most, break it"


_TEXTS = re.compile(r"//[^\n]*|'(?:[^$'\r\n]|\$[^\r\n])*+'|\(\*.*?\*\)", re.DOTALL)


def nested_comment(subject: Subject) -> Iterator[Hit]:
    for match in _TEXTS.finditer(subject.source.text):
        inner = match.group().find("(*", 2)
        if match.group().startswith("(*") and inner > 0:
            place = match.start() + inner
            yield Span(place, place + 2), "(* inside a comment; comments do not nest, remove it"


# --------------------------------------------------------------------------------------------------------- header

_HEADER_END = re.compile(r"(?im)^\s*(?:VAR\w*|CONST|LABEL|BEGIN|STRUCT|END_\w+)\b|\Z")
_HEADER_LINE = re.compile(
    r"(?im)^[ \t]*(?P<word>TITLE|VERSION|AUTHOR|FAMILY|NAME)[ \t]*[=:][ \t]*(?P<value>'[^'\r\n]*'|(?:(?!//)[^\r\n])*)"
)


def header_quotes(subject: Subject) -> Iterator[Hit]:
    for word, value, span in _header_lines(subject):
        if word in ("TITLE", "VERSION") and not value.startswith("'"):
            sign = "=" if word == "TITLE" else ":"
            yield span, f"{subject.dialect.title} wants {word} in quotes; write {word} {sign} '{value}'"


def bare_version(subject: Subject) -> Iterator[Hit]:
    for word, value, span in _header_lines(subject):
        if word == "VERSION" and value.startswith("'"):
            bare = value.strip("'")
            yield span, f"{subject.dialect.title} wants VERSION without quotes; write VERSION : {bare}"


def bare_title(subject: Subject) -> Iterator[Hit]:
    for word, value, span in _header_lines(subject):
        if word == "TITLE" and value.startswith("'"):
            bare = value.strip("'")
            yield span, f"{subject.dialect.title} takes the quotes as part of the title; write TITLE = {bare}"


def header_words(subject: Subject) -> Iterator[Hit]:
    for word, value, span in _header_lines(subject):
        bare = value.strip("'")
        if word in ("AUTHOR", "FAMILY", "NAME") and len(bare) > MAX_HEADER_WORD:
            yield span, f"{word} {bare} has {len(bare)} characters; {MAX_HEADER_WORD} are the most"


def _header_lines(subject: Subject) -> Iterator[tuple[str, str, Span]]:
    """Keyword, value as written, and place of each header line."""
    text = subject.source.text.replace("\r", " ")
    for block in subject.blocks:
        for match in _HEADER_LINE.finditer(text, block.span.end, _header_end(text, block)):
            value = match["value"].rstrip()
            yield match["word"].upper(), value, Span(match.start("value"), match.start("value") + len(value))


def _header_end(text: str, block: Block) -> int:
    match = _HEADER_END.search(text, block.span.end)
    return match.start() if match else len(text)
