"""Constants of STL: numbers with their prefix, characters, pointers."""

from __future__ import annotations

import re
from collections.abc import Callable

from plcgen.plc.lexer import BASED, NUMBER, TYPED_PATTERNS, Token, TokenKind
from plcgen.plc.scl.literals import LiteralError, read_literal, unescape
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.s7_language import STL
from plcgen.plc.stl.s7_syntax import Constant, Text
from plcgen.plc.types import BOOL, BYTE, DWORD, INT, REAL, WORD, elementary, round_real

POINTER_AREAS = {"P": 0x80, "I": 0x81, "Q": 0x82, "M": 0x83, "DB": 0x84, "DI": 0x85, "L": 0x86, "PI": 0x80, "PQ": 0x80}
"""The first byte of a pointer that says its area."""
MAX_POINTER_BYTE = 65535
REAL_DIGITS = re.compile(r"[+-]?[0-9]+\.[0-9]+(?:[eE][+-]?[0-9]+)?")

_SIGNED = re.compile(rf"([+-]?)\s*({NUMBER})")
_BINARY = re.compile(r"2#([01_]+)")
_TYPED = re.compile("|".join(TYPED_PATTERNS))
_BASED = re.compile(BASED)
_BYTES = re.compile(r"(?i:B)#\s*\(([0-9\s,]+)\)")
_COUNT = re.compile(r"(?i:C|Z)#([0-9]{1,3})")
_TEXT = re.compile(r"'((?:[^$'\r\n]|\$[^\r\n])*)'")
_POINTER = re.compile(r"(?i:P)#\s*(?:([A-Za-z]{1,2}?)X?\s*)??([0-9]+)\.([0-9]+)")
_GERMAN_POINTERS = {"E": "I", "A": "Q"}
_PATTERN_TYPES = {1: BYTE, 2: WORD, 4: DWORD}


def read_constant(source: SourceText, text: str, span: Span) -> Constant | Text | None:
    """The constant that the whole text spells, None when it begins like none. Raises SourceError."""
    try:
        for reader in _READERS:
            found = reader(text, span)
            if found is not None:
                return found
    except (LiteralError, ValueError) as error:
        raise source.error(str(error), span) from None
    return None


def _boolean(text: str, span: Span) -> Constant | None:
    return Constant(text.upper() == "TRUE", BOOL, span) if text.upper() in ("TRUE", "FALSE") else None


def _number(text: str, span: Span) -> Constant | None:
    match = _SIGNED.fullmatch(text)
    if match is None:
        return None
    value = read_literal(Token(TokenKind.NUMBER, match[2], span), STL, match[1] == "-").value
    if isinstance(value, float):
        return Constant(round_real(value), REAL, span)
    assert isinstance(value, int)
    if not INT.minimum <= value <= INT.maximum:
        raise LiteralError(f"{text} is no INT ({INT.minimum} .. {INT.maximum}); write L#{text.lstrip('+')}")
    return Constant(value, INT, span)


def _binary(text: str, span: Span) -> Constant | None:
    match = _BINARY.fullmatch(text)
    if match is None:
        return None
    digits = match[1].replace("_", "")
    if len(digits) > DWORD.bits:
        raise LiteralError(f"{text} has {len(digits)} digits; {DWORD.bits} are the most")
    return Constant(int(digits, 2), WORD if len(digits) <= WORD.bits else DWORD, span)


def _typed(text: str, span: Span) -> Constant | None:
    if not _TYPED.fullmatch(text) or _TEXT.search(text) or _POINTER.fullmatch(text):
        return None
    literal = read_literal(Token(TokenKind.TYPED, text, span), STL)
    kind = elementary(literal.type_name or "")
    if kind is None or isinstance(literal.value, str):
        return None
    value = literal.value
    return Constant(round_real(value) if isinstance(value, float) else value, kind, span)


def _unprefixed(text: str, _span: Span) -> Constant | None:
    if _BASED.fullmatch(text) is None:
        return None
    raise LiteralError(f"{text} does not say its width; write B#{text}, W#{text} or DW#{text}")


def _bytes(text: str, span: Span) -> Constant | None:
    match = _BYTES.fullmatch(text)
    if match is None:
        return None
    parts = [int(part) for part in match[1].split(",") if part.strip()]
    if len(parts) not in (2, 4) or max(parts) > BYTE.maximum:
        raise LiteralError(f"{text} is no constant; write two or four bytes, like B#(1, 255)")
    return Constant(int.from_bytes(bytes(parts)), _PATTERN_TYPES[len(parts)], span)


def _count(text: str, span: Span) -> Constant | None:
    match = _COUNT.fullmatch(text)
    return Constant(int(match[1], 16), WORD, span) if match else None


def _characters(text: str, span: Span) -> Constant | Text | None:
    match = _TEXT.fullmatch(text)
    if match is None:
        return None
    plain = unescape(match[1])
    kind = _PATTERN_TYPES.get(len(plain))
    if kind is None or any(ord(character) > BYTE.maximum for character in plain):
        return Text(plain, span)
    return Constant(int.from_bytes(plain.encode("latin-1")), kind, span)


def _pointer(text: str, span: Span) -> Constant | None:
    match = _POINTER.fullmatch(text)
    if match is None:
        return None
    area = _GERMAN_POINTERS.get((match[1] or "").upper(), (match[1] or "").upper())
    if area and area not in POINTER_AREAS:
        raise LiteralError(f"{text}: no area {match[1]}; write P#M 0.0, P#DBX 0.0 or the like")
    return Constant((POINTER_AREAS[area] if area else 0) << 24 | pointer_bits(match[2], match[3]), DWORD, span)


def pointer_bits(byte: str, bit: str) -> int:
    """Bits of `byte.bit`. Raises ValueError for what no pointer holds."""
    if int(byte) > MAX_POINTER_BYTE or int(bit) > 7:
        raise ValueError(f"P#{byte}.{bit} does not exist; bytes go to {MAX_POINTER_BYTE}, bits to 7")
    return int(byte) * 8 + int(bit)


_READERS: tuple[Callable[[str, Span], Constant | Text | None], ...] = (
    _boolean,
    _number,
    _binary,
    _pointer,
    _bytes,
    _count,
    _characters,
    _typed,
    _unprefixed,
)
