"""STL source text of STEP 7 V5 to its syntax tree. Declarations are read as those of SCL, statements by own rules."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.declarations import type_spec
from plcgen.plc.scl.headers import block_name, header
from plcgen.plc.scl.parser import data_block, user_type, with_interface
from plcgen.plc.scl.syntax import Block as Declared
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_language import STL, Language, detect_language
from plcgen.plc.stl.s7_statements import Reader
from plcgen.plc.stl.s7_syntax import Block
from plcgen.plc.suggest import did_you_mean


def parse(source: SourceText, language: Language | None = None) -> tuple[Block, ...]:
    """All blocks of one file in their order; `language` of the mnemonics is what the text looks like when not given.

    Raises SourceError at the first place that is wrong; mnemonics are judged by the lowering.
    """
    tokens = Cursor(source, STL)
    return tuple(_blocks(tokens, language or detect_language(source)))


def _blocks(tokens: Cursor, language: Language) -> Iterator[Block]:
    while not tokens.at_kind(TokenKind.END):
        yield _block(tokens, language)
        tokens.accept(";")


def _block(tokens: Cursor, language: Language) -> Block:
    current = tokens.current
    if current.word not in _KINDS:
        hint = did_you_mean(current.text, _KINDS) or "; blocks begin with FUNCTION_BLOCK or the like"
        raise tokens.error(f"a block expected, found {current}{hint}")
    keyword = tokens.advance()
    name = block_name(tokens)
    span = tokens.span_from(keyword)
    quoted = name.kind is TokenKind.GLOBAL
    started = Declared(span, span, BlockKind(keyword.word), name.name, quoted, tokens.source)
    block = _KINDS[keyword.word](tokens, keyword, started, language)
    return replace(block, declaration=replace(block.declaration, extent=tokens.span_from(keyword)))


def _code_block(tokens: Cursor, keyword: Token, declaration: Declared, language: Language) -> Block:
    declaration = with_interface(tokens, replace(declaration, header=header(tokens)))
    _refuse_views(tokens, declaration)
    tokens.expect("BEGIN", "it stands between the declarations and the first NETWORK")
    reader = Reader(tokens.source, language, tokens.previous.span.end)
    statements = tuple(reader.statements(keyword.word))
    tokens.go_on_at(reader.position)
    tokens.expect(f"END_{keyword.word}")
    return Block(declaration, statements, tuple(reader.networks))


def _refuse_views(tokens: Cursor, declaration: Declared) -> None:
    for section in declaration.sections:
        for item in section.declarations:
            if item.view_of is not None:
                raise tokens.error("AT does not exist in STL; read the bytes by their address", item.span)
    if declaration.constants:
        raise tokens.error("CONST does not exist in STL; use an input with a value", declaration.constants[0].span)


def _function(tokens: Cursor, keyword: Token, declaration: Declared, language: Language) -> Block:
    tokens.expect(":", "write the type of the result, or : VOID")
    return_type = None if tokens.accept("VOID") else type_spec(tokens)
    return _code_block(tokens, keyword, replace(declaration, return_type=return_type), language)


def _data_block(tokens: Cursor, keyword: Token, declaration: Declared, _language: Language) -> Block:
    return Block(data_block(tokens, keyword, declaration))


def _type(tokens: Cursor, keyword: Token, declaration: Declared, _language: Language) -> Block:
    return Block(user_type(tokens, keyword, declaration))


_KINDS: dict[str, Callable[[Cursor, Token, Declared, Language], Block]] = {
    "FUNCTION_BLOCK": _code_block,
    "FUNCTION": _function,
    "ORGANIZATION_BLOCK": _code_block,
    "DATA_BLOCK": _data_block,
    "TYPE": _type,
}
