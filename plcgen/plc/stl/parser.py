"""Parser of .awl files of Micro/WIN SMART: line by line, as the tool writes them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.operands import read_operand
from plcgen.plc.stl.syntax import Block, BlockKind, Declaration, Network, Operand, SectionKind, Statement
from plcgen.plc.suggest import did_you_mean

HEADS = {
    "ORGANIZATION_BLOCK": BlockKind.ORGANIZATION,
    "SUBROUTINE_BLOCK": BlockKind.SUBROUTINE,
    "INTERRUPT_BLOCK": BlockKind.INTERRUPT,
    "PROGRAM_BLOCK": BlockKind.ORGANIZATION,  # Micro/WIN imports nothing from it; an import rule says so
}
SECTIONS = {kind.value: kind for kind in SectionKind}

BLANKS = " \t\f\v\0\ufeff"
"""Not what Python strips: in the text of a code page letters hold bytes that Unicode counts as blanks."""

_WORD = re.compile(f"[^{BLANKS}]*")
_LINE = re.compile(r"[^\n]*\n?")
_CODE = re.compile(r"(?:'[^'\r\n]*'|\"[^\"\r\n]*\"|(?!//)[^\r\n])*")
_HEAD_NAME = re.compile(r"(?P<name>[^\s:]*?)\s*(?::\s*(?P<absolute>\S*))?")
_ABSOLUTE = re.compile(r"(OB|SBR|INT)_?([0-9]+)", re.IGNORECASE)
_NETWORK = re.compile(r"NETWORK\b\s*([0-9]*)", re.IGNORECASE)
_TITLE = re.compile(r"TITLE\s*=?", re.IGNORECASE)
_DECLARATION = re.compile(r"(?P<name>[^\s:;]+)\s*:\s*(?P<type>\w+)\s*;?")
_OPERAND = re.compile(r"[ \t\f\v]*((?:'[^'\r\n]*'|\"[^\"\r\n]*\"|[^,'\"])*)")


class _Line(NamedTuple):
    """One line without comment and blanks around it; `word` is its first word in upper case."""

    text: str
    span: Span
    word: str

    @property
    def word_span(self) -> Span:
        """Of the first word, which may be shorter than in upper case."""
        return Span(self.span.start, self.span.start + len(_first_word(self.text)))


def parse(source: SourceText) -> tuple[Block, ...]:
    """The blocks of a file. Raises SourceError at what is no STL; mnemonics are judged by the lowering."""
    return tuple(_Parser(source).blocks())


class _Parser:
    def __init__(self, source: SourceText) -> None:
        self.source = source
        self.lines = list(_lines(source.text))
        self.position = 0

    @property
    def line(self) -> _Line:
        """The line to read next; behind the last one an empty line."""
        end = len(self.source.text)
        return self.lines[self.position] if self.position < len(self.lines) else _Line("", Span(end, end), "")

    def take(self) -> _Line:
        line = self.line
        self.position += 1
        return line

    @property
    def at_end(self) -> bool:
        return self.position >= len(self.lines)

    # ---------------------------------------------------------------------------------------------------- blocks

    def blocks(self) -> Iterator[Block]:
        while not self.at_end:
            yield self._block()

    def _block(self) -> Block:
        head = self.take()
        if head.word not in HEADS:
            raise self.source.error(
                f"a block expected, found {head.word}{did_you_mean(head.word, HEADS)}; blocks begin with "
                "ORGANIZATION_BLOCK, SUBROUTINE_BLOCK or INTERRUPT_BLOCK",
                head.word_span,
            )
        name, number = self._name(head)
        self._titles()
        declarations = tuple(self._declarations())
        self._titles()
        self._expect("BEGIN", "it stands between the declarations and the networks")
        networks = tuple(self._networks())
        end = self._expect(f"END_{head.word}", f"it closes {head.word} of line {self._row(head)}")
        extent = head.span.to(end.span)
        return Block(HEADS[head.word], head.word, name, number, declarations, networks, self.source, head.span, extent)

    def _row(self, line: _Line) -> int:
        return self.source.location(line.span).line

    def _expect(self, word: str, why: str) -> _Line:
        if self.line.word != word:
            found = self.line.word or "end of file"
            raise self.source.error(f"{word} expected, found {found}; {why}", self.line.word_span)
        return self.take()

    def _name(self, head: _Line) -> tuple[str, int | None]:
        """Name and number; an export may lack either."""
        match = _HEAD_NAME.fullmatch(head.text[len(head.word) :].strip())
        if match is None:
            raise self.source.error("the name of a block has no blanks; write it like MAIN:OB1", head.span)
        name, absolute = match["name"], match["absolute"]
        number = _ABSOLUTE.fullmatch(absolute if absolute else name)
        if absolute and (number is None or number[1].upper() != HEADS[head.word].value):
            prefix = HEADS[head.word].value
            raise self.source.error(f"{absolute} is no {prefix}; write {head.word} {name}:{prefix}0", head.span)
        own = number is not None and number[1].upper() == HEADS[head.word].value
        return name, int(number[2]) if number is not None and own else None

    def _titles(self) -> None:
        while _TITLE.match(self.line.text) and self.line.word.startswith("TITLE"):
            self.take()

    # ---------------------------------------------------------------------------------------------- declarations

    def _declarations(self) -> Iterator[Declaration]:
        while self.line.word in SECTIONS:
            opening = self.take()
            while self.line.word != "END_VAR":
                yield self._declaration(opening)
            self.take()

    def _declaration(self, opening: _Line) -> Declaration:
        line = self.line
        match = _DECLARATION.fullmatch(line.text)
        if match is None:
            found = line.text or "end of file"
            raise self.source.error(
                f"a declaration such as speed : REAL; expected, found {found}; END_VAR closes {opening.word} of line "
                f"{self._row(opening)}",
                line.span,
            )
        self.take()
        return Declaration(SECTIONS[opening.word], match["name"], match["type"].upper(), line.span)

    # -------------------------------------------------------------------------------------------------- networks

    def _networks(self) -> Iterator[Network]:
        while (match := _NETWORK.match(self.line.text)) is not None:
            yield self._network(self.take(), int(match[1] or 0))
        if not self.at_end and not self.line.word.startswith("END_"):
            raise self.source.error(
                f"Network expected, found {self.line.word}; write Network 1 above it", self.line.span
            )

    def _network(self, head: _Line, number: int) -> Network:
        statements: list[Statement] = []
        titles: list[Span] = []
        while not self.at_end and not _NETWORK.match(self.line.text) and self.line.word not in _CLOSING:
            line = self.take()
            if _TITLE.match(line.text):
                titles.append(line.span)
            else:
                statements.append(self._statement(line))
        return Network(number, tuple(statements), head.span, tuple(titles))

    def _statement(self, line: _Line) -> Statement:
        rest = line.word_span.end
        operands = tuple(self._operands(rest, line.span.end)) if rest < line.span.end else ()
        return Statement(line.word, operands, line.span)

    def _operands(self, start: int, end: int) -> Iterator[Operand]:
        while True:
            match = _OPERAND.match(self.source.text, start, end)
            assert match is not None
            text = match[1].rstrip(BLANKS)
            span = Span(match.start(1), match.start(1) + len(text))
            if match.end() < end and self.source.text[match.end()] != ",":
                raise self.source.error("quote is not closed on this line; add one", Span(match.end(), end))
            if not text:
                raise self.source.error("an operand is missing here; remove the comma or write one", span)
            yield read_operand(self.source, span)
            if match.end() == end:
                return
            start = match.end() + 1


_CLOSING = frozenset(f"END_{head}" for head in HEADS)


def _first_word(text: str) -> str:
    match = _WORD.match(text)
    return match.group() if match else ""


def _lines(text: str) -> Iterator[_Line]:
    """Lines that say something."""
    for match in _LINE.finditer(text):
        code = _CODE.match(text, match.start(), match.end())
        assert code is not None
        stripped = code.group().strip(BLANKS)
        if stripped:
            start = match.start() + code.group().index(stripped)
            yield _Line(stripped, Span(start, start + len(stripped)), _first_word(stripped).upper())
