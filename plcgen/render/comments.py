"""The comments and titles of a template: each is found in the text, holes and all, and may be put in other words."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import groupby
from unicodedata import east_asian_width

Words = Callable[[str], str]
"""Puts an English text in the words of a language. Raises KeyError for one that it does not know."""

_WHOLE_LINE = re.compile(r"(?P<before> *//) (?P<text>.*\S)")
_RULER = re.compile(r"(?P<before> *// ---- )(?P<text>.*?)(?P<dashes> -+)")
_TITLE = re.compile(r"(?P<before>TITLE *= *(?P<quote>'?))(?P<text>\S.*?)(?P<after>(?P=quote))")
# A hole or a text in quotes may hold two slashes that begin no comment.
_BEHIND_CODE = re.compile(r"""(?P<before>(?:\{\{.*?\}\}|"[^"]*"|'[^']*'|[^/"']|/(?!/))*// )(?P<text>.*\S)""")


def reworded(template: str, words: Words) -> str:
    """The template with every comment and title in other words; not a character of its code is touched.

    Lines of comment that follow one another at the same depth are one text: a sentence may go on in the next line.
    """
    lines = template.split("\n")
    return "\n".join(line for key, group in groupby(lines, _paragraph) for line in _group(key, list(group), words))


def messages(template: str) -> list[str]:
    """The texts that `reworded` would ask for, in their order."""
    found: list[str] = []

    def note(text: str) -> str:
        found.append(text)
        return text

    reworded(template, note)
    return found


def columns(text: str) -> int:
    """Columns of a fixed pitch: a Chinese character takes two, as it takes two bytes of GBK."""
    return sum(2 if east_asian_width(character) in "WF" else 1 for character in text)


def padded(text: str, width: int, fill: str = " ") -> str:
    """Text filled up to a number of columns; longer text keeps its length."""
    return text + fill * (width - columns(text))


def _paragraph(line: str) -> str:
    """What the lines of one paragraph begin with alike; nothing for a line that stands for itself."""
    whole = _WHOLE_LINE.fullmatch(line)
    return whole["before"] if whole and not _RULER.fullmatch(line) else ""


def _group(before: str, lines: list[str], words: Words) -> Iterator[str]:
    if not before:
        yield from (_single(line, words) for line in lines)
        return
    text = "\n".join(line.removeprefix(f"{before} ") for line in lines)
    yield from (f"{before} {line}" for line in words(text).split("\n"))


def _single(line: str, words: Words) -> str:
    """A ruler, a title, a comment behind code, or none of these."""
    if ruler := _RULER.fullmatch(line):
        return padded(f"{ruler['before']}{words(ruler['text'])} ", len(line), "-")
    if title := _TITLE.fullmatch(line):
        return f"{title['before']}{words(title['text'])}{title['after']}"
    if behind := _BEHIND_CODE.fullmatch(line):
        return behind["before"] + words(behind["text"])
    return line
