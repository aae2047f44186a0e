"""A TOML file whose every key and value knows its place, so that an error can point at it."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from plcgen.errors import JobError, Location
from plcgen.names import spelled_character

if TYPE_CHECKING:
    from tree_sitter import Node

KeyPath = tuple[str | int, ...]  # ("hoist", "travel"); the index of a list's item is an int


class Place(NamedTuple):
    """Where a key and its value stand, in bytes of the UTF-8 text. A table's value is its header."""

    path: KeyPath
    key: tuple[int, int]
    value: tuple[int, int]
    is_table: bool = False


@dataclass(frozen=True)
class TomlFile:
    """Text of a TOML file (line ends as LF, no byte order mark), its values, and the places of its keys."""

    name: str
    text: str
    data: dict[str, Any]

    @cached_property
    def sha256(self) -> str:
        """Of the text in UTF-8 with LF line ends: what a version control system does to line ends changes nothing."""
        return hashlib.sha256(self._bytes).hexdigest()

    def key_location(self, path: KeyPath) -> Location:
        """Where a key is written; the nearest table header above it when it is not."""
        place = self._nearest(path)
        return self.at(*place.key) if place else Location(self.name, 1, 1)

    def value_location(self, path: KeyPath) -> Location:
        """Where the value of a key is written; the nearest table header above it when the key is not."""
        place = self._exact.get(path)
        return self.at(*place.value) if place else self.key_location(path)

    def spelling(self, path: KeyPath) -> str | None:
        """A value as the file writes it, on one line and not too long; None for a table and an absent key."""
        place = self._exact.get(path)
        if place is None or place.is_table:
            return None
        start, end = place.value
        first, *more = self._bytes[start:end].decode().split("\n")
        short = first if len(first) <= 60 and not more else f"{first[:56].rstrip()} ..."
        return "".join(character if character.isprintable() else "?" for character in short)

    def duplicate(self) -> tuple[Place, Place] | None:
        """The first key that is written twice: its two places in file order."""
        seen: dict[KeyPath, Place] = {}
        for place in self._places:
            first = seen.setdefault(place.path, place)
            if first is not place:
                return first, place
        return None

    def at(self, start: int, end: int) -> Location:
        """The place of a range of bytes."""
        begin = self._bytes.rfind(b"\n", 0, start) + 1
        line = self._bytes[begin:].split(b"\n", 1)[0].decode()
        column = len(self._bytes[begin:start].decode()) + 1
        length = len(self._bytes[start:end].decode())
        return Location(self.name, self._bytes.count(b"\n", 0, begin) + 1, column, line, max(1, length))

    def _nearest(self, path: KeyPath) -> Place | None:
        """The key itself, else the first key inside it (`hoist.travel` for `hoist`), else the table it belongs to."""
        for depth in range(len(path), 0, -1):
            above = path[:depth]
            inside = (place for place in self._places if place.path[:depth] == above)
            place = self._exact.get(above) or next(inside, None)
            if place:
                return place
        return None

    @cached_property
    def _bytes(self) -> bytes:
        return self.text.encode()

    @cached_property
    def _exact(self) -> dict[KeyPath, Place]:
        return {place.path: place for place in reversed(self._places)}

    @cached_property
    def _places(self) -> tuple[Place, ...]:
        # Here and not above: printing help must not pay for the parser.
        import tree_sitter
        import tree_sitter_toml

        parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_toml.language()))
        return tuple(_places(parser.parse(self._bytes).root_node))


def read_toml(path: Path) -> TomlFile:
    """Read a TOML file. Raises JobError when it cannot be read, is not UTF-8, or is not TOML."""
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise JobError(f"{path}: cannot be read: {error.strerror}") from error
    return parse_toml(_decoded(str(path), raw), str(path))


def parse_toml(text: str, name: str) -> TomlFile:
    """See `read_toml`; `name` is what errors call the file."""
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
    try:
        return TomlFile(name, text, tomllib.loads(text))
    except (ValueError, RecursionError) as error:
        raise _syntax_error(TomlFile(name, text, {}), error) from error


def _decoded(name: str, raw: bytes) -> str:
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in raw[:4]:
        raise JobError("the file is UTF-16; save it as UTF-8", Location(name, 1, 1))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raw = error.object  # without the byte order mark, as the offsets are
        begin = raw.rfind(b"\n", 0, error.start) + 1
        column = len(raw[begin : error.start].decode()) + 1
        line = raw[begin:].split(b"\n", 1)[0].rstrip(b"\r").decode(errors="replace")
        message = f"byte 16#{raw[error.start]:02X} is not UTF-8 (GBK or a Windows code page?); save the file as UTF-8"
        raise JobError(message, Location(name, raw.count(b"\n", 0, begin) + 1, column, line)) from error


# The parser's words, in the words of a user. Its places are good, and are kept.
_ADVICE = (
    (r"Invalid value", 'no value here; write a number such as 12.0, a "text" in quotes, true, or a [list]'),
    (
        r"Expected newline or end of document after a statement",
        "nothing but a # comment may follow here; decimals take a point, text takes quotes",
    ),
    (r"Expected '=' after a key in a key/value pair", "= is missing after the key"),
    (
        r"Illegal character '\\n'|Unterminated string|Expected \"'\"|Expected '\"'",
        "the text is not closed; end it with a quote",
    ),
    (r"Expected '\]' at the end of a table declaration", "the table header is not closed; end it with ]"),
    (r"Expected '\]\]' at the end of an array declaration", "the table header is not closed; end it with ]]"),
    (r"Illegal character", "a control character has no place here; remove it"),
    (r"Cannot |Duplicate ", "the key is written before, as a value or as a table; keep one of them"),
    (r"Unclosed array", "the list is not closed; separate its items by commas and end it with ]"),
    (r"Unclosed inline table", "the table is not closed; separate its keys by commas and end it with }"),
    (
        r"Unescaped '\\' in a string|Invalid hex value",
        "a backslash starts an escape; write two of them, or the text in 'single' quotes",
    ),
    (r"Invalid initial character for a key part", "no key here; write key = value, with the key's plain letters"),
    (r"Invalid statement", "no key here; write key = value, or a table header in [ ]"),
)
_WHERE = re.compile(r"^(.*) \(at (?:line (\d+), column (\d+)|end of document)\)$", re.DOTALL)


def _syntax_error(file: TomlFile, error: Exception) -> JobError:
    found = _WHERE.match(str(error))
    if found is None:  # nesting without end, a number of thousands of digits
        return JobError("not a job file: nested too deep or a number too long", Location(file.name, 1, 1))
    words, row, column = found.groups()
    twice = file.duplicate() if words.startswith(("Cannot", "Duplicate")) else None
    if twice:
        return _duplicate_error(file, *twice)
    location = _line_location(file, int(row), int(column)) if row else _end_location(file)
    if words == "Illegal character '\\n'":
        location = replace(location, column=_open_quote(location.text) + 1)
    character = location.text[location.column - 1 : location.column]
    if not character.isascii():
        return JobError(
            f"{spelled_character(character)} has no meaning here; write plain ASCII quotes, signs and digits", location
        )
    advice = (text for pattern, text in _ADVICE if re.match(pattern, words))
    return JobError(next(advice, f"not valid TOML: {words[:1].lower()}{words[1:]}"), location)


def _open_quote(line: str) -> int:
    """Where the text begins that the end of the line cuts off."""
    closed = list(re.finditer(r'"(?:[^"\\]|\\.)*"|\'[^\']*\'', line))
    rest = closed[-1].end() if closed else 0
    found = re.search("[\"']", line[rest:])
    return rest + found.start() if found else len(line)


def _duplicate_error(file: TomlFile, first: Place, second: Place) -> JobError:
    key = spelled_path(second.path)
    what = f"table [{key}]" if second.is_table else f"key {key}"
    line = file.at(*first.key).line
    return JobError(f"{what} is written twice, first in line {line}; keep one of them", file.at(*second.key))


def spelled_path(path: KeyPath) -> str:
    """`hoist.travel`, `targets[0]`."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path).removeprefix(".")
    return text if text.isprintable() else ascii(text)[1:-1]


def _line_location(file: TomlFile, row: int, column: int) -> Location:
    return Location(file.name, row, column, file.text.split("\n")[row - 1])


def _end_location(file: TomlFile) -> Location:
    lines = file.text.rstrip("\n").split("\n")
    return _line_location(file, len(lines), len(lines[-1]) + 1)


def _places(document: Node) -> Iterator[Place]:
    """Every key of a document in file order, with the items of lists."""
    counts: dict[KeyPath, int] = {}
    for node in document.named_children:
        if node.type == "pair":
            yield from _pair(node, ())
        elif node.type in ("table", "table_array_element"):
            yield from _table(node, counts)


def _table(node: Node, counts: dict[KeyPath, int]) -> Iterator[Place]:
    header, *pairs = _children(node)
    *above, last = _parts(header)
    path: KeyPath = ()
    for part in above:
        path = _latest((*path, part), counts)
    path = (*path, last)
    if node.type == "table_array_element":
        counts[path] = counts.get(path, -1) + 1
        path = _latest(path, counts)
    span = (header.start_byte, header.end_byte)
    yield Place(path, span, span, is_table=True)
    for pair in pairs:
        yield from _pair(pair, path)


def _latest(path: KeyPath, counts: dict[KeyPath, int]) -> KeyPath:
    return (*path, counts[path]) if path in counts else path


def _pair(node: Node, above: KeyPath) -> Iterator[Place]:
    key, *value = _children(node)
    path = (*above, *_parts(key))
    yield from _value(value[-1] if value else key, path, (key.start_byte, key.end_byte))


def _value(node: Node, path: KeyPath, key: tuple[int, int]) -> Iterator[Place]:
    span = (node.start_byte, node.end_byte)
    yield Place(path, key, span)
    items = _children(node)
    if node.type == "array":
        for index, item in enumerate(items):
            yield from _value(item, (*path, index), (item.start_byte, item.end_byte))
    elif node.type == "inline_table":
        for item in items:
            yield from _pair(item, path)


def _children(node: Node) -> list[Node]:
    return [child for child in node.named_children if child.type not in ("comment", "ERROR")]


def _parts(key: Node) -> tuple[str, ...]:
    """The words of a key; dotted keys nest to the left, perhaps thousands deep."""
    parts = []
    while key.type == "dotted_key":
        key, last = key.named_children[0], key.named_children[-1]
        parts.append(_word(last))
    return (_word(key), *reversed(parts))


def _word(key: Node) -> str:
    text = (key.text or b"").decode()
    if key.type != "quoted_key":
        return text
    try:
        return str(tomllib.loads(f"key = {text}")["key"])
    except ValueError:
        return text
