"""Declarations: sections, constants, types, initial values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.dialects import S71500_TYPES, STANDARD_FUNCTIONS, STRUCTURE_WORDS, TYPE_ALIASES, UNSUPPORTED_TYPES
from plcgen.plc.scl.expressions import expression
from plcgen.plc.scl.syntax import (
    ArraySpec,
    BlockKind,
    Call,
    Constant,
    Declaration,
    Expression,
    InitialList,
    InitialValue,
    Literal,
    NamedType,
    Repetition,
    Section,
    SectionKind,
    StringSpec,
    StructSpec,
    TypeSpec,
)

SECTION_WORDS = tuple(kind.value for kind in SectionKind)
CLOSERS = frozenset(word for word in STRUCTURE_WORDS if word.startswith("END_")) | {
    *(kind.value for kind in BlockKind),
    *SECTION_WORDS,
    *("BEGIN", "CONST", "ELSE", "ELSIF", "END_REGION", "UNTIL"),
}
_NUMBERED = ("FB", "UDT")
_RETENTION = {"RETAIN": True, "NON_RETAIN": False, "DB_SPECIFIC": False}

# ------------------------------------------------------------------------------------------------------- sections


@dataclass(frozen=True)
class Interface:
    """All declarations of one block, in their order."""

    constants: tuple[Constant, ...]
    sections: tuple[Section, ...]


def interface(tokens: Cursor) -> Interface:
    constants: list[Constant] = []
    sections: list[Section] = []
    while tokens.at("CONST", "LABEL", *SECTION_WORDS):
        part = _part(tokens)
        if isinstance(part, Section):
            sections.append(part)
        else:
            constants.extend(part)
        if tokens.at(";") and tokens.peek(1).word in ("CONST", "LABEL", "BEGIN", *SECTION_WORDS):
            raise tokens.error(f"no ; belongs behind {tokens.previous}; remove it")
    return Interface(tuple(constants), tuple(sections))


def _part(tokens: Cursor) -> Section | tuple[Constant, ...]:
    if tokens.at("LABEL"):
        raise tokens.error("jump labels are not supported; use IF, EXIT, CONTINUE or RETURN")
    if tokens.at("CONST"):
        return _untyped_constants(tokens)
    if tokens.at("VAR") and tokens.peek(1).word == "CONSTANT":
        return _typed_constants(tokens)
    return _section(tokens)


def _section(tokens: Cursor) -> Section:
    start = tokens.advance()
    retention = tokens.accept(*_RETENTION)
    declarations = tuple(_declarations_until(tokens, start, "END_VAR"))
    kind = SectionKind(start.word)
    return Section(tokens.span_from(start), kind, declarations, bool(retention and _RETENTION[retention.word]))


def _declarations_until(tokens: Cursor, start: Token, end: str) -> Iterator[Declaration]:
    while not tokens.at(end):
        refuse_unclosed(tokens, start, end)
        yield from _declaration(tokens)
    tokens.advance()


def refuse_unclosed(tokens: Cursor, start: Token, end: str) -> None:
    """A word that closes or opens something greater says that what `start` opened was never closed."""
    current = tokens.current
    if current.kind is TokenKind.END or current.word in CLOSERS:
        line = tokens.line_of(start)
        raise tokens.error(f"{end} expected before {current}; it closes {start.word} of line {line}")


def _untyped_constants(tokens: Cursor) -> tuple[Constant, ...]:
    start = tokens.current
    if tokens.dialect.typed_constants:
        raise tokens.error(f"CONST does not exist in {tokens.dialect.title}; write VAR CONSTANT with a type")
    tokens.advance()
    return tuple(_constants_until(tokens, start, "END_CONST"))


def _typed_constants(tokens: Cursor) -> tuple[Constant, ...]:
    start = tokens.current
    if not tokens.dialect.typed_constants:
        raise tokens.error(f"VAR CONSTANT does not exist in {tokens.dialect.title}; write CONST ... END_CONST")
    tokens.advance()
    tokens.advance()
    return tuple(_constants_until(tokens, start, "END_VAR"))


def _constants_until(tokens: Cursor, start: Token, end: str) -> Iterator[Constant]:
    while not tokens.at(end):
        refuse_unclosed(tokens, start, end)
        yield _constant(tokens)
    tokens.advance()


def _constant(tokens: Cursor) -> Constant:
    name = declared_name(tokens)
    attributes(tokens)
    spec = type_spec(tokens) if tokens.dialect.typed_constants and tokens.expect(":") else None
    tokens.expect(":=", "a constant needs a value")
    value = expression(tokens)
    tokens.end_statement()
    return Constant(name.span, name.name, value, spec)


# --------------------------------------------------------------------------------------------------- declarations


def declared_name(tokens: Cursor) -> Token:
    token = tokens.current
    if token.kind is TokenKind.ADDRESS:
        raise tokens.error(f"{token} is an absolute address; choose another name")
    if token.word in tokens.dialect.reserved and token.kind is TokenKind.NAME:
        raise tokens.error(f"{token} is a reserved word; choose another name")
    if token.kind is TokenKind.LOCAL:
        raise tokens.error(f"{token} is declared without #; write {token.name}")
    return tokens.expect_kind("a name", TokenKind.NAME, TokenKind.GLOBAL)


def _declaration(tokens: Cursor) -> tuple[Declaration, ...]:
    names = [_named(tokens)]
    while tokens.accept(","):
        names.append(_named(tokens))
    view_of = _view(tokens)
    tokens.expect(":")
    spec = type_spec(tokens)
    initial = initial_value(tokens) if tokens.accept(":=") else None
    _end_declaration(tokens, spec)
    return tuple(Declaration(name.span, name.name, spec, initial, view_of, pairs) for name, pairs in names)


def _named(tokens: Cursor) -> tuple[Token, tuple[tuple[str, str], ...]]:
    name = declared_name(tokens)
    return name, attributes(tokens)


def _view(tokens: Cursor) -> str | None:
    if not tokens.accept("AT"):
        return None
    if tokens.at_kind(TokenKind.ADDRESS):
        raise tokens.error(f"AT {tokens.current} is not supported; a view lies on a variable of the same block")
    return tokens.expect_kind("the variable to view", TokenKind.NAME, TokenKind.GLOBAL, TokenKind.LOCAL).name


def _end_declaration(tokens: Cursor, spec: TypeSpec) -> None:
    """END_STRUCT closes a declaration well enough: many sources leave its semicolon out."""
    if isinstance(spec, StructSpec) and not tokens.at(";"):
        return
    tokens.end_statement()


def attributes(tokens: Cursor) -> tuple[tuple[str, str], ...]:
    """`{ S7_x := 'v'; S7_y := 'w' }`, or nothing."""
    if not tokens.accept("{"):
        return ()
    pairs: list[tuple[str, str]] = []
    while not tokens.accept("}"):
        name = tokens.expect_kind("an attribute or }", TokenKind.NAME)
        tokens.expect(":=")
        value = tokens.expect_kind("a quoted value", TokenKind.STRING)
        pairs.append((name.text, value.text[1:-1]))
        tokens.accept(";", ",")
    return tuple(pairs)


# ---------------------------------------------------------------------------------------------------------- types


def type_spec(tokens: Cursor) -> TypeSpec:
    with tokens.nested():
        if tokens.at("ARRAY"):
            return _array(tokens)
        if tokens.at("STRUCT"):
            return struct(tokens)
        return _named_type(tokens)


def _array(tokens: Cursor) -> ArraySpec:
    start = tokens.advance()
    tokens.expect("[", "write ARRAY[0..9] OF REAL")
    bounds = [_bound(tokens)]
    while tokens.accept(","):
        bounds.append(_bound(tokens))
    tokens.expect("]")
    tokens.expect("OF")
    element = type_spec(tokens)
    return ArraySpec(tokens.span_from(start), tuple(bounds), element)


def _bound(tokens: Cursor) -> tuple[Expression, Expression]:
    if tokens.at("*"):
        raise tokens.error("arrays of open length are not supported; write the bounds, like 0..9")
    low = expression(tokens)
    tokens.expect("..", "write both bounds, like 0..9")
    return low, expression(tokens)


def struct(tokens: Cursor) -> StructSpec:
    start = tokens.expect("STRUCT")
    fields = tuple(_declarations_until(tokens, start, "END_STRUCT"))
    return StructSpec(tokens.span_from(start), fields)


def _named_type(tokens: Cursor) -> TypeSpec:
    token = tokens.expect_kind("a type", TokenKind.NAME, TokenKind.GLOBAL)
    if token.kind is TokenKind.GLOBAL:
        return NamedType(token.span, token.name)
    if token.word in _NUMBERED and tokens.current.text.isdigit():
        number = tokens.advance()
        return NamedType(tokens.span_from(token), token.text + number.text)
    _refuse_type(tokens, token)
    if token.word == "STRING":
        return _string(tokens, token)
    name = TYPE_ALIASES.get(token.word, token.word)
    return NamedType(token.span, name if name in tokens.dialect.types else token.text)


def _refuse_type(tokens: Cursor, token: Token) -> None:
    if token.word in STRUCTURE_WORDS:
        raise tokens.error(f"a type expected, found {token}", token.span)
    if token.word in UNSUPPORTED_TYPES:
        raise tokens.error(f"type {token} is not supported", token.span)
    if token.word in S71500_TYPES - tokens.dialect.types:
        raise tokens.error(f"type {token} does not exist on S7-300 and S7-400", token.span)


def _string(tokens: Cursor, token: Token) -> StringSpec:
    length = None
    if tokens.accept("["):
        length = expression(tokens)
        tokens.expect("]")
    return StringSpec(tokens.span_from(token), length)


# ------------------------------------------------------------------------------------------------- initial values


def initial_value(tokens: Cursor) -> InitialValue:
    """One value; or a list for an ARRAY, in brackets or bare: `[1, 2]`, `1, 2`, `3(0.0)`."""
    if tokens.at("["):
        return _bracketed(tokens)
    start = tokens.current
    values = _initial_items(tokens)
    if len(values) == 1 and not isinstance(values[0], Repetition):
        return values[0]
    return InitialList(tokens.span_from(start), values)


def _bracketed(tokens: Cursor) -> InitialList:
    start = tokens.expect("[")
    values = _initial_items(tokens)
    tokens.expect("]")
    return InitialList(tokens.span_from(start), values)


def _initial_items(tokens: Cursor) -> tuple[InitialValue, ...]:
    with tokens.nested():
        values = [_initial_item(tokens)]
        while tokens.accept(","):
            values.append(_initial_item(tokens))
        return tuple(values)


def _initial_item(tokens: Cursor) -> InitialValue:
    if tokens.at("["):
        return _bracketed(tokens)
    if tokens.at("(") and tokens.peek(2).word == ":=":
        raise tokens.error("initial values of a STRUCT by name are not supported; assign them after BEGIN of the DB")
    value = expression(tokens)
    if isinstance(value, Literal) and tokens.accept("("):
        repeated = _initial_items(tokens)
        tokens.expect(")")
        return Repetition(tokens.span_from(value.span), value, repeated)
    return _named_repetition(value) if isinstance(value, Call) else value


def _named_repetition(call: Call) -> InitialValue:
    """`COUNT(0.0)` looks like a call; in an initial value the constant COUNT repeats what follows."""
    if call.callee.name.upper() in STANDARD_FUNCTIONS or any(argument.name for argument in call.arguments):
        return call
    return Repetition(call.span, call.callee, tuple(argument.value for argument in call.arguments))
