"""One lexer for every PLC language here: a lexicon is a table of patterns, tokens are read on demand.

On demand, because some header lines are free text: a parser that has just read `TITLE =` takes the rest of the line
as it stands instead of asking for a token.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

from plcgen.plc.source import SourceText, Span


class TokenKind(Enum):
    NAME = "name"  # x, IF, FB100
    LOCAL = "local name"  # #x, #"two words"
    GLOBAL = "global name"  # "Motor"
    NUMBER = "number"  # 12, 1_000, 3.0E10, 16#FF
    TYPED = "typed literal"  # INT#5, T#1s, DW#16#FF
    STRING = "string"  # 'text'
    ADDRESS = "address"  # M0.0, %MW10, DB100.DBD4
    SLICE = "slice"  # %X3, %DBW4: part of what stands before the point
    OPERATOR = "operator"
    END = "end of file"


class Token(NamedTuple):
    """`word` is what a parser compares with: a name in upper case, an operator as it is, else empty."""

    kind: TokenKind
    text: str
    span: Span
    word: str = ""

    @property
    def name(self) -> str:
        """The bare name: without `#` and quotes."""
        return self.text.removeprefix("#").strip('"')

    def __str__(self) -> str:
        if self.kind is TokenKind.END:
            return "end of file"
        return self.text if len(self.text) <= 40 else f"{self.text[:37]}..."


@dataclass(frozen=True)
class Lexicon:
    """The patterns of one language, tried in their order.

    `skipped` are blanks and comments; `refused` pairs a pattern with the message it deserves, `{text}` being the
    text found.
    """

    skipped: tuple[str, ...]
    patterns: tuple[tuple[TokenKind, str], ...]
    refused: tuple[tuple[str, str], ...] = ()

    @cached_property
    def blanks(self) -> re.Pattern[str]:
        return re.compile(f"(?:{'|'.join(self.skipped)})*+")

    @cached_property
    def scanner(self) -> re.Pattern[str]:
        """One pattern; its groups are first those of `refused`, then those of `patterns`."""
        sources = [pattern for pattern, _ in self.refused] + [pattern for _, pattern in self.patterns]
        return re.compile("|".join(f"({source})" for source in sources))


class Lexer:
    """Reads tokens of one source from any offset; keeps no position itself."""

    def __init__(self, source: SourceText, lexicon: Lexicon) -> None:
        self.source = source
        self.lexicon = lexicon

    def token(self, offset: int) -> Token:
        """The first token at or after the offset."""
        start = self._skip_blanks(offset)
        text = self.source.text
        if start >= len(text):
            return Token(TokenKind.END, "", Span(len(text), len(text)))
        match = self.lexicon.scanner.match(text, start)
        if match is None:
            raise self.source.error(_unknown_character(text[start]), Span(start, start + 1))
        return self._token_of(match)

    def line_end(self, offset: int) -> int:
        """Where the line ends that holds the offset, line break left out."""
        end = self.source.text.find("\n", offset)
        end = len(self.source.text) if end < 0 else end
        return end - 1 if self.source.text[offset:end].endswith("\r") else end

    def _skip_blanks(self, offset: int) -> int:
        match = self.lexicon.blanks.match(self.source.text, offset)
        return match.end() if match else offset

    def _token_of(self, match: re.Match[str]) -> Token:
        span, text = Span(*match.span()), match.group()
        group = (match.lastindex or 0) - 1
        refused = len(self.lexicon.refused)
        if group < refused:
            raise self.source.error(self.lexicon.refused[group][1].format(text=text), span)
        kind = self.lexicon.patterns[group - refused][0]
        return Token(kind, text, span, _word(kind, text))


def tokens(source: SourceText, lexicon: Lexicon) -> Iterator[Token]:
    """Every token of a source without free-text lines, END left out."""
    lexer = Lexer(source, lexicon)
    token = lexer.token(0)
    while token.kind is not TokenKind.END:
        yield token
        token = lexer.token(token.span.end)


def _word(kind: TokenKind, text: str) -> str:
    if kind is TokenKind.NAME:
        return text.upper()
    return text if kind is TokenKind.OPERATOR else ""


def _unknown_character(character: str) -> str:
    shown = f"{character} " if character.isascii() and character.isprintable() else ""
    return f"unknown character {shown}(U+{ord(character):04X}) outside comments and strings; remove it"


# ------------------------------------------------------------------------------------------------------------ SCL

DIGITS = r"[0-9]+(?:_[0-9]+)*"
NUMBER = rf"(?>{DIGITS}(?:\.{DIGITS})?(?:[eE][+-]?[0-9]+)?)"
BASED = r"(?>[0-9]+#[0-9A-Za-z_]*)"
STRING = r"'(?:[^$'\r\n]|\$[^\r\n])*+'"
ASCII_NAME = r"[A-Za-z_][0-9A-Za-z_]*"
WIDE_NAME = r"[^\W\d]\w*"
CONTROL = r"\x00-\x1f\x7f"
QUOTED_NAME = rf'"[^"{CONTROL}]+"'

# E, A, PE, PA are the German names of I, Q, PI, PQ.
BIT_ADDRESS = r"(?i:[MIQEA]X?[0-9]+\.[0-9]+)"
WIDE_ADDRESS = r"(?i:(?:P[IQEA]|[MIQEA])[BWD][0-9]+)"
DB_ADDRESS = r"(?i:DB[0-9]+\.D(?:(?:B?X)?[0-9]+\.[0-9]+|B?[BWD][0-9]+))"
PERIPHERAL = r"(?::[Pp](?![0-9A-Za-z_]))?"
ADDRESS_END = r"(?![0-9A-Za-z_])"

COMMENTS = (r"//[^\n]*", r"\(\*(?s:.*?)\*\)")
MULTILINGUAL_COMMENT = r"\(/\*(?s:.*?)\*/\)"
BLANKS = r"[ \t\r\n\f\v]+"
OPERATORS = r":=|=>|<=|>=|<>|\*\*|\.\.|\+=|-=|\*=|/=|[-+*/=<>&()\[\]{},;:.]"

TYPED_PATTERNS = (
    r"(?i:T|TIME|LT|LTIME|S5T|S5TIME)#[+-]?[0-9][0-9A-Za-z_.]*",
    r"(?i:D|DATE)#[0-9]+-[0-9]+-[0-9]+",
    r"(?i:TOD|TIME_OF_DAY|LTOD)#[0-9:.]+",
    r"(?i:DT|DATE_AND_TIME|LDT|DTL)#[0-9][-0-9:.]*",
    rf"(?i:CHAR|STRING|WCHAR|WSTRING)#{STRING}",
    rf"[A-Za-z][0-9A-Za-z_]*#[+-]?(?:{BASED}|{NUMBER}|(?i:TRUE|FALSE){ADDRESS_END})",
    r"(?i:P)#[A-Za-z0-9][0-9A-Za-z.]*",
)

REFUSED = (
    (r"\(\*", "comment is not closed; add *)"),
    (r"\*\)", "*) without (*: comments do not nest; remove the inner (*"),
    (r"==", "== is not an SCL operator; write = to compare"),
    (r"!=", "!= is not an SCL operator; write <>"),
    (r"&&", "&& is not an SCL operator; write AND"),
    (r"\|\|", "|| is not an SCL operator; write OR"),
    (r"\^", "^ is not an SCL operator; write ** for a power"),
    (r"\.[0-9]+", "{text} needs a digit before the point; write 0{text}"),
    (r"[A-Za-z][0-9A-Za-z_]*#(?![-+'\"0-9A-Za-z_])", "{text} has no value; write one behind the #"),
    (rf"{DIGITS}\.(?![0-9.])", "{text} needs a digit after the point; write {text}0"),
    (
        rf"(?!{BASED}|{NUMBER}{ADDRESS_END})[0-9][0-9_]*(?:\.[0-9]+)?[0-9A-Za-z_]*",
        "{text} is neither a number nor a name; names start with a letter",
    ),
)
UNCLOSED = (
    (rf'#?"[^"\r\n]*(?=[{CONTROL}])[^\r\n"][^"\r\n]*"', "control character in a name; remove it"),
    (r"'", "string is not closed on this line; add '"),
    (r'#?"', 'name is not closed on this line; add "'),
)


def _scl_lexicon(name: str, addresses: tuple[str, ...], comments: tuple[str, ...]) -> Lexicon:
    patterns = (
        *((TokenKind.TYPED, pattern) for pattern in TYPED_PATTERNS),
        (TokenKind.ADDRESS, "|".join(addresses)),
        (TokenKind.NUMBER, f"{BASED}|{NUMBER}"),
        (TokenKind.NAME, name),
        (TokenKind.LOCAL, f"#(?:{name}|{QUOTED_NAME})"),
        (TokenKind.GLOBAL, QUOTED_NAME),
        (TokenKind.STRING, STRING),
        (TokenKind.SLICE, r"%(?i:DBX[0-9]+\.[0-9]+|(?:DB)?[XBWD][0-9]+)"),
        (TokenKind.OPERATOR, OPERATORS),
    )
    # A quote that opens nothing is refused, so it stands behind a pattern for the closed one.
    closed = f"(?!{STRING}|#?{QUOTED_NAME})"
    unclosed = tuple((closed + pattern, message) for pattern, message in UNCLOSED)
    return Lexicon((BLANKS, *comments), patterns, REFUSED + unclosed)


_MARKED = rf"%(?:{DB_ADDRESS}|{BIT_ADDRESS}|{WIDE_ADDRESS}){PERIPHERAL}{ADDRESS_END}"
_POINTED = rf"(?:{DB_ADDRESS}|{BIT_ADDRESS}){ADDRESS_END}"

# STEP 7 V5 reads MW10 as an address. TIA writes %MW10, and MW10 without % may name a variable.
SCL_CLASSIC = _scl_lexicon(ASCII_NAME, (_MARKED, _POINTED, WIDE_ADDRESS + ADDRESS_END), COMMENTS)
SCL_TIA = _scl_lexicon(WIDE_NAME, (_MARKED, _POINTED), (*COMMENTS, MULTILINGUAL_COMMENT))
