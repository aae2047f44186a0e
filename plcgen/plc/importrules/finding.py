"""What an import rule reports, and what it looks at."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, Literal, Protocol, TypeVar

from plcgen.errors import Location
from plcgen.plc.scl.dialects import Dialect
from plcgen.plc.scl.syntax import Block
from plcgen.plc.source import SourceText, Span

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Finding:
    """One breach of an import rule. An error stops the import or changes its meaning; a warning may."""

    location: Location
    severity: Severity
    rule: str
    message: str

    def __str__(self) -> str:
        return f"{self.location}: {self.severity}: {self.message} [{self.rule}]"


@dataclass(frozen=True)
class Subject:
    """A parsed source and the dialect it is meant for, which need not be the one it was parsed with."""

    source: SourceText
    blocks: tuple[Block, ...]
    dialect: Dialect

    @property
    def raw(self) -> bytes:
        return self.source.raw or self.source.text.encode(errors="replace")

    def text(self, span: Span) -> str:
        return self.source.text[span.start : span.end]


Hit = tuple[Span, str]


class Sourced(Protocol):
    """What has a source; rules of one language look at a subject of their own."""

    @property
    def source(self) -> SourceText: ...


Looked = TypeVar("Looked", bound=Sourced)


@dataclass(frozen=True)
class Rule(Generic[Looked]):
    name: str
    severity: Severity
    check: Callable[[Looked], Iterator[Hit]]

    def findings(self, subject: Looked) -> Iterator[Finding]:
        for span, message in self.check(subject):
            yield Finding(subject.source.location(span), self.severity, self.name, message)
