"""The statements of a block: labels, mnemonics, operands, parameter lists, networks."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from plcgen.plc.lexer import ASCII_NAME, BLANKS
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.s7_language import COMMENT, GERMAN, Language, english
from plcgen.plc.stl.s7_operands import LABEL, read_label, read_operand, read_variable
from plcgen.plc.stl.s7_syntax import Argument, BlockName, LabelName, Operand, Statement

JUMPS = frozenset(
    {"JU", "JC", "JCN", "JCB", "JNB", "JBI", "JNBI", "JO", "JOS", "JZ", "JN", "JP", "JM", "JPZ", "JMZ", "JUO", "JL"}
    | {"LOOP"}
)
"""Mnemonics whose operand is a label."""

_BLANKS = re.compile(rf"(?:{BLANKS}|{COMMENT})*+")
_NETWORK = re.compile(r"NETWORK\b[ \t]*(?P<rest>[^\r\n]*)", re.IGNORECASE)
_TITLE = re.compile(r"TITLE\b[ \t]*=?[^\r\n]*", re.IGNORECASE)
_LABEL = re.compile(rf"({LABEL.pattern})[ \t]*:(?!=)")
_MNEMONIC = re.compile(
    r"[=<>]{1,2}[IDR]\b|[-+*/][IDR]\b|\+AR[12]\b|=|\+|\)(?:MCR\b)?|RND[+-](?![0-9])"
    r"|(?:[AOXU]N?|MCR)\(|[A-Za-z][0-9A-Za-z]*",
    re.IGNORECASE,
)
_PIECE = re.compile(r"'(?:[^$'\r\n]|\$[^\r\n])*'|\"[^\"\r\n]*\"|//[^\n]*|[^;'\"/]|/")
_CALL = re.compile(r'(?P<callee>(?:"[^"]*"|[^,("])+)(?:,\s*(?P<instance>(?:"[^"]*"|[^("])+))?(?P<open>\()?')
_ARGUMENT = re.compile(rf"({ASCII_NAME}|\"[^\"\r\n]+\")\s*:=\s*")
_STRUCTURE = re.compile(r"[ \t]*(?:NETWORK|END_\w+)\b", re.IGNORECASE)
_END = re.compile(r"END_(?:FUNCTION_BLOCK|FUNCTION|ORGANIZATION_BLOCK)\b", re.IGNORECASE)


@dataclass
class Reader:
    """Reads statements from `position` on, up to the word that ends the block."""

    source: SourceText
    language: Language
    position: int
    networks: list[Span] = field(default_factory=list)
    end_labels: tuple[LabelName, ...] = ()

    def statements(self, opened: str) -> Iterator[Statement]:
        """Statements of a block; `opened` says what END_ word closes."""
        while not self._at_end(opened):
            if not self._structure():
                yield from self._statement()

    # -------------------------------------------------------------------------------------------------- structure

    def _skip(self) -> None:
        match = _BLANKS.match(self.source.text, self.position)
        self.position = match.end() if match else self.position

    def _at_end(self, opened: str) -> bool:
        self._skip()
        if self.position >= len(self.source.text):
            message = f"END_{opened} expected before end of file; it closes {opened}"
            raise self.source.error(message, Span(self.position, self.position))
        return _END.match(self.source.text, self.position) is not None

    def _structure(self) -> bool:
        """NETWORK, and the TITLE lines behind it."""
        network = _NETWORK.match(self.source.text, self.position)
        if network is not None:
            self.networks.append(Span(network.start(), network.start() + len("NETWORK")))
            self.position = network.start("rest")
            return True
        title = _TITLE.match(self.source.text, self.position)
        if title is not None:
            self.position = title.end()
        return title is not None

    # -------------------------------------------------------------------------------------------------- statements

    def _statement(self) -> Iterator[Statement]:
        label = self._label()
        self._skip()
        text, start = self.source.text, self.position
        if text.startswith(";", start):
            self.position += 1
            if label is not None:
                yield Statement("NOP", "NOP", (), label.span, label)
            return
        if _END.match(text, start) and label is not None:
            raise self.source.error(f"label {label.name} names no instruction; write NOP 0; behind it", label.span)
        match = _MNEMONIC.match(text, start)
        if text.startswith("(*", start):
            raise self.source.error("(* *) is no comment in STL; write //", Span(start, start + 2))
        if match is None:
            found = text[start : start + 1]
            message = f"an instruction expected, found {found or 'the end of the file'}"
            raise self.source.error(message, Span(start, start + len(found)))
        self.position = match.end()
        mnemonic = self._english(match.group().upper(), Span(*match.span()))
        end = self._end_of_statement(start)
        yield replace(self._instruction(mnemonic, match, end), label=label)

    def _label(self) -> LabelName | None:
        match = _LABEL.match(self.source.text, self.position)
        if match is None:
            return None
        self.position = match.end()
        return LabelName(match[1], Span(*match.span(1)))

    def _english(self, word: str, span: Span) -> str:
        if self.language is Language.GERMAN and word in GERMAN.values() and word not in GERMAN and word != "SE":
            german = next(own for own, foreign in GERMAN.items() if foreign == word)
            raise self.source.error(f"{word} is English, other mnemonics here are German; write {german}", span)
        if self.language is Language.ENGLISH and word in GERMAN and word not in GERMAN.values():
            message = f"{word} is German, other mnemonics here are English; write {GERMAN[word]}"
            raise self.source.error(message, span)
        return english(word, self.language)

    def _end_of_statement(self, start: int) -> int:
        """Where the semicolon stands. One that is missing belongs at the end of the line."""
        text = self.source.text
        while self.position < len(text):
            if text[self.position] == ";":
                self.position += 1
                return self.position - 1
            if text[self.position - 1] == "\n" and _STRUCTURE.match(text, self.position):
                break
            piece = _PIECE.match(text, self.position)
            if piece is None:
                quote = Span(self.position, self.position + 1)
                raise self.source.error(f"{text[self.position]} is not closed on this line; add one", quote)
            self.position = piece.end()
        line_end = text.find("\n", start)
        end = start + len(text[start : line_end if line_end > 0 else len(text)].split("//")[0].rstrip())
        raise self.source.error("; expected at the end of the instruction", Span(end, end))

    def _instruction(self, mnemonic: str, match: re.Match[str], end: int) -> Statement:
        span = Span(match.start(), match.start() + len(self.source.text[match.start() : end].rstrip()))
        word = match.group()
        operand = self._trimmed(match.end(), end)
        if operand.start == operand.end:
            return Statement(mnemonic, word, (), span)
        if mnemonic == "CALL":
            return self._call(word, operand, span)
        if mnemonic in JUMPS:
            return Statement(mnemonic, word, (read_label(self.source, operand),), span)
        return Statement(mnemonic, word, (read_operand(self.source, operand, self.language),), span)

    def _trimmed(self, start: int, end: int) -> Span:
        """Without blanks and comments at both ends."""
        blanks = _BLANKS.match(self.source.text, start, end)
        start = blanks.end() if blanks else start
        text = self._without_comments(start, end)
        return Span(start, start + len(text.rstrip()))

    def _without_comments(self, start: int, end: int) -> str:
        """The text with comments blanked out, so that places stay."""
        pieces = (piece.group() for piece in _PIECE.finditer(self.source.text, start, end))
        return "".join(" " * len(piece) if piece.startswith("//") else piece for piece in pieces)

    # ------------------------------------------------------------------------------------------------------- calls

    def _call(self, word: str, operand: Span, span: Span) -> Statement:
        text = self._without_comments(operand.start, operand.end)
        match = _CALL.match(text)
        if match is None or (match.end() < len(text) and not match["open"]):
            raise self.source.error("CALL of what? write CALL FB 1, DB 1 ( x := #y ); or CALL FC 1", operand)
        operands = [self._callee(match, "callee", operand.start)]
        if match["instance"]:
            operands.append(self._callee(match, "instance", operand.start))
        arguments = tuple(self._arguments(operand, match, text)) if match["open"] else ()
        return Statement("CALL", word, tuple(operands), span, None, arguments)

    def _callee(self, match: re.Match[str], group: str, start: int) -> Operand:
        place = Span(start + match.start(group), start + match.start(group) + len(match[group].rstrip()))
        found = read_operand(self.source, place, self.language)
        return found if isinstance(found, BlockName) else read_variable(self.source, place)

    def _arguments(self, operand: Span, match: re.Match[str], text: str) -> Iterator[Argument]:
        if not text.endswith(")"):
            raise self.source.error(") expected at the end of the parameters", Span(operand.end, operand.end))
        for start, end in _parted(text, match.end(), len(text) - 1):
            found = _ARGUMENT.match(text, start, end)
            place = Span(operand.start + start, operand.start + end)
            if found is None or found.end() == end:
                raise self.source.error("name := value expected", place)
            value = read_operand(self.source, Span(operand.start + found.end(), place.end), self.language)
            yield Argument(found[1].strip('"'), value, place)


def _parted(text: str, start: int, end: int) -> Iterator[tuple[int, int]]:
    """Pieces between commas outside quotes and brackets, without blanks around them."""
    depth, first = 0, start
    for piece in re.finditer(r"'[^'\r\n]*'|\"[^\"\r\n]*\"|.", text[:end], re.DOTALL):
        if piece.start() < start:
            continue
        depth += piece.group() in ("[", "(")
        depth -= piece.group() in ("]", ")")
        if piece.group() == "," and not depth:
            yield _stripped(text, first, piece.start())
            first = piece.end()
    last = _stripped(text, first, end)
    if last[0] < last[1] or first > start:
        yield last


def _stripped(text: str, start: int, end: int) -> tuple[int, int]:
    piece = text[start:end]
    lead = len(piece) - len(piece.lstrip())
    return (start + lead, max(start + lead, start + len(piece.rstrip())))
