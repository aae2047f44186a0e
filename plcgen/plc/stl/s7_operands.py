"""Operands of STL, each told by its form."""

from __future__ import annotations

import re

from plcgen.plc.lexer import ASCII_NAME, QUOTED_NAME
from plcgen.plc.scl.syntax import Index, Literal, Member, Scope
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.s7_constants import pointer_bits, read_constant
from plcgen.plc.stl.s7_language import AREAS, Language
from plcgen.plc.stl.s7_syntax import (
    Absolute,
    BlockName,
    Indirect,
    LabelName,
    Operand,
    PointerTo,
    RegisterIndirect,
    RegisterName,
    Status,
    Variable,
)

MAX_BYTE = 65535

_STATUS = re.compile(r"OV|OS|BR|BIE|UO|STW|(?:==|<>|>=|<=|>|<)\s*0", re.IGNORECASE)
_STATUS_NAMES = {"BIE": "BR"}
_BLOCK = re.compile(r"(?P<kind>FB|FC|DB|DI|SFB|SFC|OB)\s*(?P<number>[0-9]+)", re.IGNORECASE)
_REGISTER = re.compile(r"AR[12]|D[BI](?:LG|NO)", re.IGNORECASE)
_COUNTING = re.compile(r"[TCZ]\s*[0-9]+", re.IGNORECASE)
_ABSOLUTE = re.compile(
    rf"(?:(?P<db>DB\s*[0-9]+|{QUOTED_NAME})\s*\.\s*)?(?P<letters>[A-Z]+?)(?P<size>[XBWD]?)\s*"
    r"(?P<byte>[0-9]+)(?:\.(?P<bit>[0-9]+))?",
    re.IGNORECASE,
)
_BRACKETED = re.compile(r"(?P<letters>[A-Z]*?)(?P<size>[XBWD]?)\s*\[\s*(?P<inner>[^\[\]]+?)\s*\]", re.IGNORECASE)
_BY_REGISTER = re.compile(r"(AR[12])\s*,\s*P#\s*([0-9]+)\.([0-7])", re.IGNORECASE)
_HEAD = re.compile(rf'(?P<local>#)?(?:(?P<name>{ASCII_NAME})|"(?P<quoted>[^"\r\n]+)")')
_STEP = re.compile(rf'\s*(?:\.\s*(?:(?P<name>{ASCII_NAME})|"(?P<quoted>[^"\r\n]+)")|\[\s*(?P<indices>[^\[\]]*?)\s*\])')
_INDEX = re.compile(r"[+-]?[0-9]+")
LABEL = re.compile(r"[A-Za-z_][0-9A-Za-z_]*")


def read_operand(source: SourceText, span: Span, language: Language) -> Operand:
    """The operand at the span. Raises SourceError for what is none or not supported."""
    text = source.text[span.start : span.end]
    if text.startswith("#"):
        return read_variable(source, span)
    if text[:3].upper() == "P##":
        return PointerTo(read_variable(source, Span(span.start + 2, span.end)), span)
    found = _named(text, span) or _memory(source, text, span, language) or read_constant(source, text, span)
    if found is not None:
        return found
    if _COUNTING.fullmatch(text):
        raise source.error(f"{text}: timers and counters are not supported; count scans in a variable", span)
    if text[:2].upper() == "P#":
        raise source.error(f"{text}: such pointers are not supported; name the variable itself", span)
    if _HEAD.match(text):
        return read_variable(source, span)
    raise source.error(f"{text} is no operand; write a variable, an address such as MW 10, or a constant", span)


def read_label(source: SourceText, span: Span) -> LabelName:
    """The label that a jump names."""
    text = source.text[span.start : span.end]
    if not LABEL.fullmatch(text):
        raise source.error(f"{text} is no label; write up to four letters and digits, such as M001", span)
    return LabelName(text, span)


def _named(text: str, span: Span) -> Operand | None:
    """What has a name of its own: status bits, blocks, registers."""
    if _STATUS.fullmatch(text):
        name = "".join(text.upper().split())
        return Status(_STATUS_NAMES.get(name, name), span)
    block = _BLOCK.fullmatch(text)
    if block is not None:
        kind = block["kind"].upper()
        return BlockName(kind, f"{'DB' if kind == 'DI' else kind}{block['number']}", span)
    return RegisterName(text.upper(), span) if _REGISTER.fullmatch(text) else None


# ---------------------------------------------------------------------------------------------------------- memory


def _memory(source: SourceText, text: str, span: Span, language: Language) -> Operand | None:
    match = _ABSOLUTE.fullmatch(text)
    if match is not None:
        return _absolute(source, match, span, language)
    bracketed = _BRACKETED.fullmatch(text)
    return _indirect(source, bracketed, span, language) if bracketed else None


def _area(letters: str, size: str, language: Language) -> tuple[str, str] | None:
    """Area and size; None when the letters mean no memory. The lone D of `DBD` is no size of area DB without it."""
    area = AREAS[language].get(letters.upper())
    if area in ("DB", "DI") and not size:
        return None
    if area in ("PI", "PQ") and size.upper() not in ("B", "W", "D"):
        return None
    return (area, size.upper() or "X") if area else None


def _absolute(source: SourceText, match: re.Match[str], span: Span, language: Language) -> Absolute | None:
    found = _area(match["letters"], match["size"], language)
    if found is None or (match["size"].upper() == "X" and found[0] not in ("DB", "DI")):
        return None
    area, size = found
    text = source.text[span.start : span.end]
    if (size == "X") != (match["bit"] is not None):
        raise source.error(f"{text}: a bit needs .0 to .7, a byte, word or double word has none", span)
    byte, bit = int(match["byte"]), int(match["bit"] or 0)
    if byte > MAX_BYTE or bit > 7:
        raise source.error(f"{text} does not exist; bytes go to {MAX_BYTE}, bits to 7", span)
    data_block = match["db"] or ""
    if data_block and area != "DB":
        return None
    name = data_block.strip('"') if data_block.startswith('"') else "".join(data_block.split()).upper()
    return Absolute(area, size, byte, bit, span, name)


def _indirect(
    source: SourceText, match: re.Match[str], span: Span, language: Language
) -> Indirect | RegisterIndirect | None:
    letters, size, inner = match["letters"], match["size"].upper(), match["inner"]
    found = _area(letters, size, language) if letters else ("", size or "X")
    if found is None:
        if _COUNTING.fullmatch(f"{letters}0"):
            raise source.error("timers and counters are not supported; count scans in a variable", span)
        return None
    by_register = _BY_REGISTER.fullmatch(inner)
    if by_register is not None:
        offset = pointer_bits(by_register[2], by_register[3])
        return RegisterIndirect(*found, by_register[1].upper(), offset, span)
    start = span.start + match.start("inner")
    pointer = read_operand(source, Span(start, start + len(inner)), language)
    if not letters or not isinstance(pointer, Absolute | Variable):
        raise source.error(f"[{inner}] is no pointer; write [AR1,P#0.0] or a double word such as [MD 10]", span)
    return Indirect(*found, pointer, span)


# -------------------------------------------------------------------------------------------------------- variables


def read_variable(source: SourceText, span: Span) -> Variable:
    """`#x.y[3]`, `"Db".x` or `x`."""
    text = source.text
    head = _HEAD.match(text, span.start, span.end)
    if head is None:
        raise source.error(f'{text[span.start : span.end]} is no name; write #x or "x"', span)
    scope = Scope.LOCAL if head["local"] else Scope.GLOBAL if head["quoted"] else Scope.PLAIN
    path: list[Member | Index] = []
    position = head.end()
    while position < span.end:
        step = _STEP.match(text, position, span.end)
        if step is None:
            rest = Span(position, span.end)
            raise source.error(f"{text[position : span.end].strip()} does not belong behind a variable", rest)
        path.append(_step(source, step))
        position = step.end()
    return Variable(head["name"] or head["quoted"], scope, tuple(path), span)


def _step(source: SourceText, step: re.Match[str]) -> Member | Index:
    place = Span(*step.span())
    if step["indices"] is None:
        return Member(place, step["name"] or step["quoted"])
    indices = [part.strip() for part in step["indices"].split(",")]
    if not all(map(_INDEX.fullmatch, indices)):
        message = f"[{step['indices']}]: an index is a constant in STL; use a pointer, such as DBD [AR1,P#0.0]"
        raise source.error(message, place)
    return Index(place, tuple(Literal(place, int(index)) for index in indices))
