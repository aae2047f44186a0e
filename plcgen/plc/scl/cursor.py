"""Where the parser stands in its source: the next tokens, what is expected of them, and how deep it has gone."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from plcgen.errors import SourceError
from plcgen.plc.lexer import Lexer, Token, TokenKind
from plcgen.plc.scl.dialects import Dialect
from plcgen.plc.source import SourceText, Span

MAX_NESTING = 64
"""Bound of the depth of a tree, for every pass over it: statements, types, brackets, right operands all count."""
MAX_OPERATORS = 200
"""Bound of one expression. A chain of left operands is as long, but no pass descends it by recursion."""


class Cursor:
    """Reads tokens one ahead, on demand."""

    def __init__(self, source: SourceText, dialect: Dialect) -> None:
        self.source = source
        self.dialect = dialect
        self.previous = Token(TokenKind.OPERATOR, "", Span(0, 0))
        self._lexer = Lexer(source, dialect.lexicon)
        self._ahead: list[Token] = []
        self._offset = 0
        self._nesting = 0
        self._expressions = 0
        self._operators = 0

    # ---------------------------------------------------------------------------------------------------- reading

    def peek(self, distance: int = 0) -> Token:
        while len(self._ahead) <= distance:
            token = self._lexer.token(self._offset)
            self._offset = token.span.end
            self._ahead.append(token)
        return self._ahead[distance]

    @property
    def current(self) -> Token:
        return self._ahead[0] if self._ahead else self.peek()

    def advance(self) -> Token:
        self.previous = self.peek()
        del self._ahead[0]
        return self.previous

    def at(self, *words: str) -> bool:
        return self.current.word in words

    def at_kind(self, *kinds: TokenKind) -> bool:
        return self.current.kind in kinds

    def accept(self, *words: str) -> Token | None:
        return self.advance() if self.at(*words) else None

    def accept_kind(self, *kinds: TokenKind) -> Token | None:
        return self.advance() if self.at_kind(*kinds) else None

    def go_on_at(self, offset: int) -> None:
        """What lies before the offset was read by other rules."""
        self._ahead.clear()
        self._offset = offset

    def rest_of_line(self) -> Token:
        """What follows on this line as one piece of free text, blanks around it removed."""
        self._ahead.clear()
        start = self.previous.span.end
        end = self._lexer.line_end(start)
        line = self.source.text[start:end]
        start += len(line) - len(line.lstrip())
        self._offset = end
        text = line.strip()
        self.previous = Token(TokenKind.STRING, text, Span(start, start + len(text)))
        return self.previous

    def accept_text(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Free text behind the last token, on its line, if it begins so."""
        start = self.previous.span.end
        end = self._lexer.line_end(start)
        start = end - len(self.source.text[start:end].lstrip())
        match = pattern.match(self.source.text, start, end)
        if match is not None:
            self._ahead.clear()
            self._offset = match.end()
            self.previous = Token(TokenKind.STRING, match.group(), Span(*match.span()))
        return match

    # ------------------------------------------------------------------------------------------------ expectations

    def expect(self, word: str, hint: str = "") -> Token:
        if not self.at(word):
            raise self.unexpected(word, hint)
        return self.advance()

    def expect_kind(self, what: str, *kinds: TokenKind) -> Token:
        if not self.at_kind(*kinds):
            raise self.unexpected(what)
        return self.advance()

    def unexpected(self, expected: str, hint: str = "") -> SourceError:
        return self.error(f"{expected} expected, found {self.current}" + (f"; {hint}" if hint else ""))

    def end_statement(self) -> None:
        """A missing semicolon belongs behind what was read last, not where the next line begins."""
        if self.accept(";"):
            return
        if self.at(":="):
            raise self.error(":= assigns only once, at the start of a statement; write = to compare")
        end = self.previous.span.end
        raise self.error(f"; expected before {self.current}", Span(end, end))

    def error(self, message: str, span: Span | None = None) -> SourceError:
        return self.source.error(message, self.current.span if span is None else span)

    def span_from(self, start: Token | Span) -> Span:
        """From a first token to the one read last."""
        first = start.span if isinstance(start, Token) else start
        return first.to(self.previous.span)

    def line_of(self, token: Token) -> int:
        return self.source.location(token.span).line

    # ------------------------------------------------------------------------------------------------------ bounds

    @contextmanager
    def nested(self) -> Iterator[None]:
        self._nesting += 1
        if self._nesting > MAX_NESTING:
            raise self.error(f"nested deeper than {MAX_NESTING} levels; split it up")
        yield
        self._nesting -= 1

    @contextmanager
    def nested_expression(self) -> Iterator[None]:
        self._operators = self._operators if self._expressions else 0
        self._expressions += 1
        with self.nested():
            yield
        self._expressions -= 1

    def count_operator(self, operator: Token) -> None:
        self._operators += 1
        if self._operators > MAX_OPERATORS:
            message = f"more than {MAX_OPERATORS} operators in one expression; split it with a temporary variable"
            raise self.error(message, operator.span)
