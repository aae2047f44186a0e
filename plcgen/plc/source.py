"""PLC source files: their text, and the place of every span in it."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from plcgen.errors import Location, SourceError

BYTE_ORDER_MARK = b"\xef\xbb\xbf"
UTF_16_MARKS = (b"\xff\xfe", b"\xfe\xff")
UTF_8, GBK, EIGHT_BIT = "utf-8", "gbk", "8-bit"
"""What a file is taken for."""


class Span(NamedTuple):
    """Half-open range of character offsets in a SourceText."""

    start: int
    end: int

    def to(self, other: Span) -> Span:
        return Span(self.start, other.end)


@dataclass(frozen=True)
class SourceText:
    """Decoded text of one source file. `raw` keeps the bytes for rules about encoding and line ends.

    All but UTF-8 has a character for each byte, as engineering tools count them.
    """

    name: str
    text: str
    raw: bytes = field(default=b"", repr=False)
    encoding: str = UTF_8

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        starts.extend(offset + 1 for offset, character in enumerate(self.text) if character == "\n")
        return starts

    def location(self, span: Span) -> Location:
        row = bisect_right(self._line_starts, span.start) - 1
        start = self._line_starts[row]
        line = self.text[start:].split("\n", 1)[0].rstrip("\r")
        return Location(self.name, row + 1, span.start - start + 1, self.shown(line), max(1, span.end - span.start))

    def shown(self, text: str) -> str:
        """A piece of the text for people. A Chinese character is two columns wide, as it is two bytes long."""
        return text.encode("latin-1").decode(GBK, "replace") if self.encoding == GBK else text

    def error(self, message: str, span: Span) -> SourceError:
        return SourceError(message, self.location(span))


def read_source(path: Path) -> SourceText:
    """Read a source file: UTF-8 with or without a byte order mark, else GBK or 8-bit with one character a byte.

    Latin-1 keeps any code page (1251, 1252, GBK) intact byte by byte; only comments and strings hold such bytes.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise SourceError(f"{path}: cannot be read: {error.strerror}") from error
    return decode_source(str(path), raw)


def decode_source(name: str, raw: bytes) -> SourceText:
    """See `read_source`. Raises SourceError for UTF-16, which no engineering tool imports."""
    if raw.startswith(UTF_16_MARKS):
        raise SourceError(f"{name}: is UTF-16; save it as UTF-8 with BOM (TIA) or as ANSI (STEP 7 V5)")
    try:
        return SourceText(name, raw.decode("utf-8-sig"), raw, UTF_8)
    except UnicodeDecodeError:
        return SourceText(name, raw.decode("latin-1"), raw, GBK if _is_chinese(raw) else EIGHT_BIT)


def _is_chinese(raw: bytes) -> bool:
    """Whether bytes are GBK, and most characters of two bytes are punctuation or of the 3755 that are common.

    Letters of other code pages, such as those of German or Russian, pair up to rare characters if to any.
    """
    try:
        pairs = [character.encode(GBK) for character in raw.decode(GBK) if not character.isascii()]
    except UnicodeDecodeError:
        return False
    return 2 * sum(0xA1 <= first <= 0xD7 and second >= 0xA1 for first, second in pairs) > len(pairs)
