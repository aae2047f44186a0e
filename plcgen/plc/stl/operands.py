"""Operands of STL: constants, addresses, pointers and names, each told by its form."""

from __future__ import annotations

import re
from collections.abc import Callable

from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.syntax import Address, AddressOf, Constant, Indirect, Name, Operand

_DIRECT = re.compile(
    r"(?P<bit_area>V|M|SM|I|Q|L|S)(?P<bit_byte>[0-9]+)\.(?P<bit>[0-9]+)"
    r"|(?P<sized_area>V|M|SM|I|Q|L|S)(?P<size>[BWD])(?P<sized_byte>[0-9]+)"
    r"|(?P<analog_area>AI|AQ)W(?P<analog_byte>[0-9]+)"
    r"|(?P<plain_area>AC|T|C)(?P<plain_byte>[0-9]+)",
    re.IGNORECASE,
)
_INTEGER = re.compile(r"[+-]?[0-9]+")
_REAL = re.compile(r"[+-]?(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?[0-9]+[eE][+-]?[0-9]+")
_BASED = re.compile(r"(16|2|8)#([0-9A-Fa-f_]+)")
_TEXT = re.compile(r"'([^'\r\n]{1,4})'")
# A letter of a code page is one byte above 127 or two, the second of which may be any from @ to ~.
_WIDE = r"[\x81-\xfe][@-~]|[\x80-\uffff]"
_NAME = re.compile(rf"(?:[A-Za-z_]|{_WIDE})(?:[0-9A-Za-z_]|{_WIDE})*")
_QUOTED = re.compile(r'"([^"]+)"')


def read_operand(source: SourceText, span: Span) -> Operand:
    """The operand that stands at the span. Raises SourceError for what is none."""
    text = source.text[span.start : span.end]
    for reader in _READERS:
        operand = reader(text, span)
        if operand is not None:
            return operand
    raise source.error(
        f"{text} is no operand; write an address such as VD100, a constant such as +5, 16#0F or 7.5, or a symbol", span
    )


def read_address(text: str, span: Span = Span(0, 0)) -> Address | None:  # noqa: B008 - a NamedTuple
    """The address that the whole text spells."""
    match = _DIRECT.fullmatch(text)
    if match is None:
        return None
    if match["bit_area"]:
        return Address(match["bit_area"].upper(), "X", int(match["bit_byte"]), int(match["bit"]), span)
    if match["sized_area"]:
        return Address(match["sized_area"].upper(), match["size"].upper(), int(match["sized_byte"]), 0, span)
    if match["analog_area"]:
        return Address(match["analog_area"].upper(), "W", int(match["analog_byte"]), 0, span)
    return Address(match["plain_area"].upper(), "", int(match["plain_byte"]), 0, span)


def _constant(text: str, span: Span) -> Operand | None:
    if _INTEGER.fullmatch(text):
        return Constant(int(text), False, span)
    if _REAL.fullmatch(text):
        return Constant(float(text), False, span)
    if (match := _TEXT.fullmatch(text)) is not None:
        return Constant(int.from_bytes(match[1].encode("latin-1", "replace")), True, span)
    match = _BASED.fullmatch(text)
    try:
        return Constant(int(match[2], int(match[1])), True, span) if match else None
    except ValueError:
        return None


def _pointer(text: str, span: Span) -> Operand | None:
    address = read_address(text[1:], Span(span.start + 1, span.end))
    if address is None or text[0] not in "*&":
        return None
    return Indirect(address, span) if text[0] == "*" else AddressOf(address, span)


def _name(text: str, span: Span) -> Operand | None:
    """A symbol; behind a colon stands its address, which says the same."""
    symbol, colon, absolute = text.partition(":")
    match = _QUOTED.fullmatch(symbol)
    if match is None and not _NAME.fullmatch(symbol):
        return None
    place = Span(span.start + len(symbol) + 1, span.end)
    if colon:
        return read_address(absolute, place) or (Name(absolute, place) if _NAME.fullmatch(absolute) else None)
    return Name(match[1] if match else symbol, span)


_READERS: tuple[Callable[[str, Span], Operand | None], ...] = (read_address, _constant, _pointer, _name)
