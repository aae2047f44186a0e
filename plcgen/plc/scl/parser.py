"""SCL source text to its syntax tree: blocks. Recursive descent; what is not supported is an error with its place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.declarations import interface, struct, type_spec
from plcgen.plc.scl.dialects import HEADER_WORDS, STRUCTURE_WORDS, Dialect
from plcgen.plc.scl.headers import block_name, header
from plcgen.plc.scl.statements import statements
from plcgen.plc.scl.syntax import (
    Assignment,
    Block,
    BlockKind,
    Declaration,
    Statement,
    StructSpec,
)
from plcgen.plc.source import SourceText


def parse(source: SourceText, dialect: Dialect) -> tuple[Block, ...]:
    """All blocks of one source file in their order.

    Raises SourceError at the first place that is wrong or not supported; no text makes it raise anything else.
    """
    tokens = Cursor(source, dialect)
    blocks: list[Block] = []
    while not tokens.at_kind(TokenKind.END):
        blocks.append(_block(tokens))
    return tuple(blocks)


def _block(tokens: Cursor) -> Block:
    parse_kind = _KINDS.get(tokens.current.word)
    if parse_kind is None:
        raise tokens.error(f"a block expected, found {tokens.current}; blocks begin with FUNCTION_BLOCK or the like")
    keyword = tokens.advance()
    name = block_name(tokens)
    span = tokens.span_from(keyword)
    kind, quoted = BlockKind(keyword.word), name.kind is TokenKind.GLOBAL
    block = parse_kind(tokens, keyword, Block(span, span, kind, name.name, quoted, tokens.source))
    return replace(block, extent=tokens.span_from(keyword))


def _code_block(tokens: Cursor, keyword: Token, block: Block) -> Block:
    """FB, FC and OB: header, sections, statements."""
    block = with_interface(tokens, replace(block, header=header(tokens)))
    return replace(block, body=_body(tokens, keyword))


def with_interface(tokens: Cursor, block: Block) -> Block:
    """Adds the sections that stand next."""
    declared = interface(tokens)
    return replace(block, constants=declared.constants, sections=declared.sections)


def _body(tokens: Cursor, keyword: Token) -> tuple[Statement, ...]:
    if not tokens.accept("BEGIN") and tokens.dialect.begin_required:
        raise tokens.unexpected("BEGIN", "it stands between the declarations and the statements")
    end = f"END_{keyword.word}"
    body = statements(tokens, keyword, end)
    tokens.expect(end)
    return body


def _function(tokens: Cursor, keyword: Token, block: Block) -> Block:
    tokens.expect(":", "write the type of the result, or : VOID")
    return_type = None if tokens.accept("VOID") else type_spec(tokens)
    return replace(_code_block(tokens, keyword, block), return_type=return_type)


# ----------------------------------------------------------------------------------------------------- data blocks


def data_block(tokens: Cursor, keyword: Token, block: Block) -> Block:
    """Shared (a structure) or instance (the name of its FB or UDT, before or behind the header lines)."""
    instance_of = _instance_of(tokens)
    block = replace(block, header=header(tokens))
    structure = None
    if instance_of is None and tokens.at("STRUCT"):
        structure = struct(tokens)
        tokens.accept(";")
    elif instance_of is None and tokens.at("VAR"):
        structure = _variables(tokens, block)
    instance_of = instance_of or (_instance_of(tokens) if structure is None else None)
    if structure is None and instance_of is None:
        raise tokens.unexpected("STRUCT, VAR or the name of an FB or UDT")
    return replace(block, instance_of=instance_of, structure=structure, body=_values(tokens, keyword))


def _instance_of(tokens: Cursor) -> str | None:
    if not _at_type_name(tokens):
        return None
    name = block_name(tokens)
    tokens.accept(";")
    return name.name


def _at_type_name(tokens: Cursor) -> bool:
    current = tokens.current
    if current.kind is TokenKind.GLOBAL:
        return True
    return current.kind is TokenKind.NAME and current.word not in HEADER_WORDS | STRUCTURE_WORDS


def _variables(tokens: Cursor, block: Block) -> StructSpec:
    """TIA may declare a DB with VAR sections: the same as one STRUCT."""
    start = tokens.current
    declared = interface(tokens)
    fields: tuple[Declaration, ...] = ()
    for section in declared.sections:
        fields += section.declarations
    if declared.constants:
        raise tokens.error(f"DATA_BLOCK {block.name} cannot declare constants", declared.constants[0].span)
    return StructSpec(tokens.span_from(start), fields)


def _values(tokens: Cursor, keyword: Token) -> tuple[Statement, ...]:
    """Initial values behind BEGIN."""
    if not tokens.at("BEGIN", "END_DATA_BLOCK"):
        raise tokens.unexpected("BEGIN", "it stands between the declarations and the initial values")
    tokens.accept("BEGIN")
    values = statements(tokens, keyword, "END_DATA_BLOCK")
    tokens.expect("END_DATA_BLOCK")
    for value in values:
        if not isinstance(value, Assignment) or value.operator:
            raise tokens.error("a DATA_BLOCK holds only assignments, like x := 1.0;", value.span)
    return values


# ----------------------------------------------------------------------------------------------------------- types


def user_type(tokens: Cursor, _keyword: Token, block: Block) -> Block:
    """A UDT: header, one STRUCT."""
    block = replace(block, header=header(tokens))
    tokens.accept(":")
    structure = struct(tokens)
    tokens.accept(";")
    tokens.expect("END_TYPE")
    tokens.accept(";")
    return replace(block, structure=structure)


_KINDS: dict[str, Callable[[Cursor, Token, Block], Block]] = {
    "FUNCTION_BLOCK": _code_block,
    "FUNCTION": _function,
    "ORGANIZATION_BLOCK": _code_block,
    "DATA_BLOCK": data_block,
    "TYPE": user_type,
}
