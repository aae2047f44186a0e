"""Syntax tree of an STL source as Micro/WIN SMART exports it (.awl): blocks of networks of statements."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from plcgen.plc.source import SourceText, Span


class BlockKind(Enum):
    """The value is the prefix of a block's absolute name: OB1, SBR0, INT0."""

    ORGANIZATION = "OB"
    SUBROUTINE = "SBR"
    INTERRUPT = "INT"


# ------------------------------------------------------------------------------------------------------- operands


@dataclass(frozen=True)
class Constant:
    """A number. One with a base (16#FF, 2#1) or of characters ('AB') is a bit pattern, not signed."""

    value: int | float
    pattern: bool
    span: Span


@dataclass(frozen=True)
class Address:
    """`size` is X, B, W or D; empty for T, C and AC, whose size the instruction says."""

    area: str
    size: str
    byte: int
    bit: int
    span: Span

    def __str__(self) -> str:
        return f"{self.area}{self.byte}.{self.bit}" if self.size == "X" else f"{self.area}{self.size}{self.byte}"


@dataclass(frozen=True)
class Indirect:
    """`*AC1`: what the pointer points to."""

    pointer: Address
    span: Span


@dataclass(frozen=True)
class AddressOf:
    """`&VB200`: a pointer."""

    target: Address
    span: Span


@dataclass(frozen=True)
class Name:
    """A symbol, a local variable, or the name of a block."""

    text: str
    span: Span


Operand = Constant | Address | Indirect | AddressOf | Name

# --------------------------------------------------------------------------------------------------------- blocks


@dataclass(frozen=True)
class Statement:
    """One line: `mnemonic` in upper case."""

    mnemonic: str
    operands: tuple[Operand, ...]
    span: Span


@dataclass(frozen=True)
class Network:
    """`titles` are lines that begin with TITLE, which do not belong here but are met."""

    number: int
    statements: tuple[Statement, ...]
    span: Span
    titles: tuple[Span, ...] = ()


class SectionKind(Enum):
    INPUT = "VAR_INPUT"
    IN_OUT = "VAR_IN_OUT"
    OUTPUT = "VAR_OUTPUT"
    TEMPORARY = "VAR"


@dataclass(frozen=True)
class Declaration:
    section: SectionKind
    name: str
    type_name: str
    span: Span


@dataclass(frozen=True)
class Block:
    """`head` is the word it begins with; name and number are as written, empty or None where they are not."""

    kind: BlockKind
    head: str
    name: str
    number: int | None
    declarations: tuple[Declaration, ...]
    networks: tuple[Network, ...]
    source: SourceText = field(repr=False)
    span: Span
    extent: Span

    @property
    def shown(self) -> str:
        """What to call the block in a message."""
        return self.name or f"{self.kind.value}{'' if self.number is None else self.number}"
