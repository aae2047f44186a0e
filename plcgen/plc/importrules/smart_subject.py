"""What import rules of Micro/WIN SMART look at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.syntax import Block, BlockKind, Name, Network, Statement


@dataclass(frozen=True)
class SmartSubject:
    """A parsed file, and the blocks of all files that make the program with it."""

    source: SourceText
    blocks: tuple[Block, ...]
    names: Names

    @property
    def raw(self) -> bytes:
        return self.source.raw or self.source.text.encode(errors="replace")

    def text(self, span: Span) -> str:
        return self.source.text[span.start : span.end]

    def networks(self) -> Iterator[tuple[Block, Network]]:
        return ((block, network) for block in self.blocks for network in block.networks)

    def statements(self) -> Iterator[tuple[Block, Statement]]:
        return ((block, statement) for block, network in self.networks() for statement in network.statements)

    @cached_property
    def callees(self) -> dict[str, list[str]]:
        """Absolute names of the subroutines that each block calls."""
        return {name: list(_callees(block, self.names)) for name, block in self.names.blocks.items()}


def _callees(block: Block, names: Names) -> Iterator[str]:
    for network in block.networks:
        for statement in network.statements:
            callee = callee_of(statement, names)
            if callee is not None:
                yield callee


def callee_of(statement: Statement, names: Names) -> str | None:
    """The absolute name of the subroutine that a CALL names."""
    if statement.mnemonic != "CALL" or not statement.operands:
        return None
    first = statement.operands[0]
    return names.block(first.text, BlockKind.SUBROUTINE) if isinstance(first, Name) else None


def word_span(statement: Statement) -> Span:
    return Span(statement.span.start, statement.span.start + len(statement.mnemonic))
