"""Expressions: one table of precedence, variables with their selectors, calls, addresses."""

from __future__ import annotations

import re

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.dialects import STRUCTURE_WORDS
from plcgen.plc.scl.literals import LiteralError, read_literal
from plcgen.plc.scl.syntax import (
    Address,
    Argument,
    Binary,
    Call,
    Expression,
    Index,
    Literal,
    Member,
    Scope,
    Slice,
    Unary,
    Variable,
)

# Left-associative operators, loose to tight. Unary + - NOT bind tighter, ** tighter still: -x ** 2 is -(x ** 2).
LEVELS: tuple[tuple[str, ...], ...] = (
    ("OR",),
    ("XOR",),
    ("AND", "&"),
    ("=", "<>"),
    ("<", "<=", ">", ">="),
    ("+", "-"),
    ("*", "/", "MOD", "DIV"),
)
PRECEDENCE = {operator: level for level, operators in enumerate(LEVELS) for operator in operators}
CANONICAL = {"&": "AND"}
UNARY = ("+", "-", "NOT")
SCOPES = {TokenKind.NAME: Scope.PLAIN, TokenKind.LOCAL: Scope.LOCAL, TokenKind.GLOBAL: Scope.GLOBAL}
NAMES = tuple(SCOPES)
LITERALS = (TokenKind.NUMBER, TokenKind.TYPED, TokenKind.STRING)


def expression(tokens: Cursor) -> Expression:
    with tokens.nested_expression():
        return _operators(tokens, 0)


def _operators(tokens: Cursor, loosest: int) -> Expression:
    left = _unary(tokens)
    while PRECEDENCE.get(tokens.current.word, -1) >= loosest:
        operator = _operator(tokens)
        with tokens.nested():
            right = _operators(tokens, PRECEDENCE[operator.word] + 1)
        left = _binary(left, operator, right)
    return left


def _operator(tokens: Cursor) -> Token:
    operator = tokens.advance()
    tokens.count_operator(operator)
    return operator


def _binary(left: Expression, operator: Token, right: Expression) -> Binary:
    word = CANONICAL.get(operator.word, operator.word)
    return Binary(left.span.to(right.span), word, left, right, operator.span)


def _unary(tokens: Cursor) -> Expression:
    if not tokens.at(*UNARY):
        return _power(tokens)
    operator = _operator(tokens)
    if operator.word == "-" and tokens.at_kind(TokenKind.NUMBER) and tokens.peek(1).word != "**":
        # The sign belongs to the number: 2147483648 alone does not fit, -2147483648 does.
        negative = literal(tokens, negative=True)
        return Literal(operator.span.to(negative.span), negative.value, negative.type_name, negative.based)
    with tokens.nested():
        operand = _unary(tokens)
    return Unary(operator.span.to(operand.span), operator.word, operand)


def _power(tokens: Cursor) -> Expression:
    base = _primary(tokens)
    while tokens.at("**"):
        operator = _operator(tokens)
        with tokens.nested():
            exponent = _unary(tokens) if tokens.at(*UNARY) else _primary(tokens)
        base = _binary(base, operator, exponent)
    return base


def _primary(tokens: Cursor) -> Expression:
    token = tokens.current
    if token.kind in LITERALS or token.word in ("TRUE", "FALSE"):
        return literal(tokens)
    if token.kind in (*NAMES, TokenKind.ADDRESS) and not _is_keyword(token):
        return reference(tokens)
    if tokens.accept("("):
        return _parenthesised(tokens)
    raise tokens.unexpected("a value")


def _parenthesised(tokens: Cursor) -> Expression:
    inner = expression(tokens)
    if tokens.at(":="):
        raise tokens.error(":= assigns; write = to compare")
    tokens.expect(")")
    return inner


def _is_keyword(token: Token) -> bool:
    """A word that cannot stand for a value. Names of types and flags can: OK and ENO are read like variables."""
    return token.kind is TokenKind.NAME and token.word in STRUCTURE_WORDS


# ------------------------------------------------------------------------------------------------------- literals


def literal(tokens: Cursor, negative: bool = False) -> Literal:
    token = tokens.current
    if token.word in ("TRUE", "FALSE"):
        tokens.advance()
        return Literal(token.span, token.word == "TRUE", "BOOL")
    try:
        result = read_literal(token, tokens.dialect, negative)
    except LiteralError as error:
        raise tokens.error(str(error)) from None
    tokens.advance()
    return result


# ------------------------------------------------------------------------------------- variables, calls, addresses


def reference(tokens: Cursor) -> Variable | Address | Call:
    """A variable with its selectors, a call, or an absolute address."""
    if tokens.at_kind(TokenKind.ADDRESS):
        return address(tokens)
    callee = variable(tokens)
    return _call(tokens, callee) if tokens.at("(") else callee


def variable(tokens: Cursor) -> Variable:
    start = tokens.expect_kind("a variable", *NAMES)
    _refuse_indexed_address(tokens, start)
    selectors: list[Member | Index | Slice] = []
    while tokens.at(".", "["):
        selectors.append(_index(tokens) if tokens.at("[") else _member(tokens))
    return Variable(tokens.span_from(start), start.name, SCOPES[start.kind], tuple(selectors))


def _member(tokens: Cursor) -> Member | Slice:
    dot = tokens.expect(".")
    token = tokens.current
    if token.kind is TokenKind.SLICE and len(token.text.rstrip("0123456789")) == 2:
        tokens.advance()
        return Slice(tokens.span_from(dot), token.text[1].upper(), bounded(tokens, token.text[2:]))
    if token.kind is TokenKind.ADDRESS and token.text.isalnum():
        # Behind a point MW10 is a member's name, whatever the dialect reads it as elsewhere.
        tokens.advance()
        return Member(tokens.span_from(dot), token.text)
    if token.kind in (TokenKind.ADDRESS, TokenKind.SLICE):
        raise tokens.error(f"absolute access {token} inside a block is not supported; name the variable")
    name = tokens.expect_kind("the name of a member", TokenKind.NAME, TokenKind.GLOBAL)
    return Member(tokens.span_from(dot), name.name)


def _index(tokens: Cursor) -> Index:
    bracket = tokens.expect("[")
    indices = [expression(tokens)]
    while tokens.accept(","):
        indices.append(expression(tokens))
    tokens.expect("]")
    return Index(tokens.span_from(bracket), tuple(indices))


_INDEXED = re.compile(r"(?:P[IQEA]|[MIQEA])[XBWD]?", re.IGNORECASE)


def _refuse_indexed_address(tokens: Cursor, name: Token) -> None:
    if name.kind is TokenKind.NAME and tokens.at("[") and len(name.text) > 1 and _INDEXED.fullmatch(name.text):
        raise tokens.error(f"indexed address {name}[...] is not supported; use an ARRAY", name.span)


def _call(tokens: Cursor, callee: Variable) -> Call:
    tokens.expect("(")
    arguments = [] if tokens.at(")") else [_argument(tokens)]
    while tokens.accept(","):
        arguments.append(_argument(tokens))
    tokens.expect(")", "arguments are parted by commas")
    return Call(tokens.span_from(callee.span), callee, tuple(arguments))


def _argument(tokens: Cursor) -> Argument:
    start = tokens.current
    if tokens.peek(1).word not in (":=", "=>") or start.kind not in (TokenKind.NAME, TokenKind.GLOBAL):
        value = expression(tokens)
        return Argument(value.span, None, value)
    tokens.advance()
    is_output = tokens.advance().word == "=>"
    value = expression(tokens)
    return Argument(tokens.span_from(start), start.name, value, is_output)


# ------------------------------------------------------------------------------------------------------- addresses

_GERMAN = {"E": "I", "A": "Q", "PE": "PI", "PA": "PQ"}
_ADDRESS = re.compile(
    r"%?(?:(?P<db>DB[0-9]+)\.D(?P<db_size>B?[XBWD]?)|(?P<area>P?[IQEA]|M)(?P<size>[XBWD]?))"
    r"(?P<byte>[0-9]+)(?:\.(?P<bit>[0-9]+))?(?P<peripheral>:P)?"
)
MAX_BYTE = 65535


def address(tokens: Cursor) -> Address:
    token = tokens.advance()
    match = _ADDRESS.fullmatch(token.text.upper())
    if match is None or (match["peripheral"] and _area(match) not in ("PI", "PQ")):
        raise tokens.error(f"{token} is not an address; only inputs and outputs have :P", token.span)
    byte, bit = bounded(tokens, match["byte"]), bounded(tokens, match["bit"] or "0")
    if bit > 7:
        raise tokens.error(f"{token}: bit {bit} does not exist; a byte has bits 0 to 7", token.span)
    return Address(token.span, _area(match), _size(match), byte, bit)


def _area(match: re.Match[str]) -> str:
    area = match["db"] or _GERMAN.get(match["area"], match["area"])
    return f"P{area}" if match["peripheral"] and area in ("I", "Q") else area


def _size(match: re.Match[str]) -> str:
    """D0.1, DX0.1, DBX0.1 are bits, DB4 and DBB4 bytes: the last letter tells, unless it is the B of `DB`."""
    if match["bit"]:
        return "X"
    return (match["db_size"] or match["size"])[-1]


def bounded(tokens: Cursor, digits: str) -> int:
    """The number behind a letter of an address or slice, just read."""
    if len(digits) > 5 or int(digits) > MAX_BYTE:
        raise tokens.error(f"{tokens.previous}: {MAX_BYTE} is the largest number here", tokens.previous.span)
    return int(digits)
