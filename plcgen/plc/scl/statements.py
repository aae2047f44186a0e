"""Statements. Each keyword has one function; a table leads from the word to it."""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.scl.cursor import Cursor
from plcgen.plc.scl.declarations import CLOSERS, SECTION_WORDS, refuse_unclosed
from plcgen.plc.scl.expressions import NAMES, expression, reference, variable
from plcgen.plc.scl.syntax import (
    Address,
    Assignment,
    BlockKind,
    Branch,
    Call,
    CallStatement,
    Case,
    CaseBranch,
    CaseLabel,
    Continue,
    Exit,
    Expression,
    For,
    If,
    Region,
    Repeat,
    Return,
    Statement,
    Variable,
    While,
)

COMPOUND = ("+=", "-=", "*=", "/=")
BLOCK_WORDS = frozenset(kind.value for kind in BlockKind)
INNER_CLOSERS = CLOSERS - {f"END_{word}" for word in BLOCK_WORDS} - BLOCK_WORDS


def statements(tokens: Cursor, start: Token, *ends: str) -> tuple[Statement, ...]:
    """Statements up to one of the end words, which is left unread; `start` is what the first of them closes."""
    body: list[Statement] = []
    with tokens.nested():
        while not tokens.at(*ends):
            if tokens.accept(";"):
                continue
            _refuse_end(tokens, start, ends)
            body.append(statement(tokens))
    return tuple(body)


def _refuse_end(tokens: Cursor, start: Token, ends: tuple[str, ...]) -> None:
    current = tokens.current
    if start.word in BLOCK_WORDS and current.word in INNER_CLOSERS:
        misplaced = (
            "belongs before BEGIN; move it up" if current.word in SECTION_WORDS else "closes nothing here; remove it"
        )
        raise tokens.error(f"{current} {misplaced}")
    refuse_unclosed(tokens, start, ends[-1])


def statement(tokens: Cursor) -> Statement:
    parse = _STATEMENTS.get(tokens.current.word)
    if parse and (tokens.current.word != "REGION" or _is_region(tokens)):
        return parse(tokens)
    _refuse_label(tokens)
    return _assignment_or_call(tokens)


def _close(tokens: Cursor, word: str) -> None:
    tokens.expect(word)
    tokens.end_statement()


# ------------------------------------------------------------------------------------------- assignments and calls


def _assignment_or_call(tokens: Cursor) -> Statement:
    if not tokens.at_kind(*NAMES, TokenKind.ADDRESS):
        raise tokens.unexpected("a statement")
    target = reference(tokens)
    if isinstance(target, Call):
        tokens.end_statement()
        return CallStatement(tokens.span_from(target.span), target)
    return _assignment(tokens, target)


def _assignment(tokens: Cursor, target: Variable | Address) -> Assignment:
    operator = _assignment_operator(tokens, target)
    value = expression(tokens)
    span = tokens.span_from(target.span)
    tokens.end_statement()
    return Assignment(span, target, value, operator)


def _assignment_operator(tokens: Cursor, target: Variable | Address) -> str | None:
    if tokens.accept(":="):
        return None
    if tokens.at("="):
        raise tokens.error("= compares; write := to assign")
    if not tokens.at(*COMPOUND):
        raise tokens.error("neither an assignment nor a call; write := or ( ) behind it", target.span)
    sign = tokens.current.text[0]
    if not tokens.dialect.compound_assignment:
        raise tokens.error(f"{sign}= does not exist in {tokens.dialect.title}; write x := x {sign} ...")
    tokens.advance()
    return sign


def _refuse_label(tokens: Cursor) -> None:
    if tokens.at_kind(TokenKind.NAME) and tokens.peek(1).word == ":":
        raise tokens.error(f"jump label {tokens.current} is not supported; use IF, EXIT, CONTINUE or RETURN")


# ------------------------------------------------------------------------------------------------------- branches


def _if(tokens: Cursor) -> If:
    start = tokens.current
    branches = [_branch(tokens, start)]
    while tokens.at("ELSIF"):
        branches.append(_branch(tokens, start))
    otherwise = statements(tokens, start, "END_IF") if tokens.accept("ELSE") else ()
    _close(tokens, "END_IF")
    return If(tokens.span_from(start), tuple(branches), otherwise)


def _branch(tokens: Cursor, start: Token) -> Branch:
    tokens.advance()
    condition = _condition(tokens)
    tokens.expect("THEN")
    return Branch(condition, statements(tokens, start, "ELSIF", "ELSE", "END_IF"))


def _condition(tokens: Cursor) -> Expression:
    condition = expression(tokens)
    if tokens.at(":="):
        raise tokens.error(":= assigns; write = to compare")
    return condition


def _case(tokens: Cursor) -> Case:
    start = tokens.advance()
    selector = expression(tokens)
    tokens.expect("OF")
    branches: list[CaseBranch] = []
    while not tokens.at("ELSE", "END_CASE"):
        refuse_unclosed(tokens, start, "END_CASE")
        branches.append(_case_branch(tokens, start))
    otherwise = _case_else(tokens, start)
    _close(tokens, "END_CASE")
    return Case(tokens.span_from(start), selector, tuple(branches), otherwise)


def _case_branch(tokens: Cursor, start: Token) -> CaseBranch:
    labels = [_case_label(tokens)]
    while tokens.accept(","):
        labels.append(_case_label(tokens))
    tokens.expect(":")
    body: list[Statement] = []
    with tokens.nested():
        while not (tokens.at("ELSE", "END_CASE") or _at_case_label(tokens)):
            if tokens.accept(";"):
                continue
            _refuse_end(tokens, start, ("END_CASE",))
            body.append(statement(tokens))
    return CaseBranch(tuple(labels), tuple(body))


def _at_case_label(tokens: Cursor) -> bool:
    """A number opens a label; a name does when no statement could go on that way."""
    if tokens.at_kind(TokenKind.NUMBER, TokenKind.TYPED, TokenKind.STRING) or tokens.at("-", "+"):
        return True
    if not tokens.at_kind(*NAMES) or tokens.current.word in _STATEMENTS:
        return False
    return tokens.peek(1).word in (":", ",", "..")


def _case_label(tokens: Cursor) -> CaseLabel:
    low = expression(tokens)
    return CaseLabel(low, expression(tokens) if tokens.accept("..") else None)


def _case_else(tokens: Cursor, start: Token) -> tuple[Statement, ...]:
    """STEP 7 V5 also writes ELSE with a colon."""
    if not tokens.accept("ELSE"):
        return ()
    tokens.accept(":")
    return statements(tokens, start, "END_CASE")


# ---------------------------------------------------------------------------------------------------------- loops


def _for(tokens: Cursor) -> For:
    start = tokens.advance()
    control = variable(tokens)
    tokens.expect(":=")
    first = expression(tokens)
    tokens.expect("TO")
    last = expression(tokens)
    step = expression(tokens) if tokens.accept("BY") else None
    tokens.expect("DO")
    body = statements(tokens, start, "END_FOR")
    _close(tokens, "END_FOR")
    return For(tokens.span_from(start), control, first, last, step, body)


def _while(tokens: Cursor) -> While:
    start = tokens.advance()
    condition = _condition(tokens)
    tokens.expect("DO")
    body = statements(tokens, start, "END_WHILE")
    _close(tokens, "END_WHILE")
    return While(tokens.span_from(start), condition, body)


def _repeat(tokens: Cursor) -> Repeat:
    start = tokens.advance()
    body = statements(tokens, start, "UNTIL")
    tokens.expect("UNTIL")
    until = _condition(tokens)
    tokens.accept(";")
    _close(tokens, "END_REPEAT")
    return Repeat(tokens.span_from(start), body, until)


# --------------------------------------------------------------------------------------------------------- others


def _single(build: type[Exit] | type[Continue] | type[Return]) -> Callable[[Cursor], Statement]:
    def parse(tokens: Cursor) -> Statement:
        word = tokens.advance()
        tokens.end_statement()
        return build(word.span)

    return parse


def _goto(tokens: Cursor) -> Statement:
    raise tokens.error("GOTO is not supported; use IF, EXIT, CONTINUE or RETURN")


def _is_region(tokens: Cursor) -> bool:
    """REGION is no keyword in STEP 7 V5, so there it may be a variable."""
    return tokens.dialect.regions or tokens.peek(1).word not in (":=", "(", ".", "[", ":")


def _region(tokens: Cursor) -> Region:
    if not tokens.dialect.regions:
        raise tokens.error(f"REGION does not exist in {tokens.dialect.title}; write a comment line")
    start = tokens.advance()
    name = tokens.rest_of_line()
    body = statements(tokens, start, "END_REGION")
    tokens.expect("END_REGION")
    tokens.accept(";")
    return Region(tokens.span_from(start), name.text, body)


_STATEMENTS: dict[str, Callable[[Cursor], Statement]] = {
    "IF": _if,
    "CASE": _case,
    "FOR": _for,
    "WHILE": _while,
    "REPEAT": _repeat,
    "EXIT": _single(Exit),
    "CONTINUE": _single(Continue),
    "RETURN": _single(Return),
    "GOTO": _goto,
    "REGION": _region,
}
