"""From the source files of a target to the program that is executed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from plcgen.kept import kept
from plcgen.plc.source import SourceText, decode_source
from plcgen.targets import SMART, TARGETS

# Each language is imported when a source of it is read: a command that only generates is quick.
if TYPE_CHECKING:
    from plcgen.plc.core import Program
    from plcgen.plc.scl.dialects import Dialect
    from plcgen.plc.scl.syntax import Block as SclBlock
    from plcgen.plc.stl.s7_syntax import Block as StlBlock
    from plcgen.plc.stl.syntax import Block as SmartBlock


def load(target: str, files: Mapping[str, bytes]) -> Program:
    """Parse and lower every source file of a target for S7-300 or TIA; the latest ones are at hand.

    FBs in STL tell their binary result.
    """
    return _load(target, tuple(files.items()))


@lru_cache(maxsize=8)
@kept
def _load(target: str, entries: tuple[tuple[str, bytes], ...]) -> Program:
    if TARGETS[target].dialect == "stl":
        from plcgen.plc.stl import s7_lowering as stl
        from plcgen.plc.stl.s7_registers import BR

        return stl.lower(read_stl(dict(entries)), told=frozenset({BR}))
    from plcgen.plc.scl import lowering as scl

    return scl.lower(*read_scl(target, dict(entries)))


def load_smart(name: str, files: Mapping[str, bytes], timed: bool = False) -> Program:
    """The joined file `name`.awl when it is there, else every block by itself; the latest ones are at hand.

    `timed`: with what counts its run time.
    """
    joined = f"{name}.awl"
    names = [joined] if joined in files else sorted(filter(_is_smart, files))
    return _load_smart(tuple((name, files[name]) for name in names), timed)


@lru_cache(maxsize=8)
@kept
def _load_smart(entries: tuple[tuple[str, bytes], ...], timed: bool) -> Program:
    from plcgen.plc.stl.lowering import lower

    return lower([block for name, data in entries for block in read_smart(name, data)], timed=timed)


@lru_cache(maxsize=32)
@kept
def read_smart(name: str, data: bytes) -> tuple[SmartBlock, ...]:
    """The blocks of one file for the SMART."""
    from plcgen.plc.stl.parser import parse

    return tuple(parse(decode_source(name, data)))


def smart_sources(files: Mapping[str, bytes]) -> list[tuple[SourceText, tuple[SmartBlock, ...]]]:
    """Every file for the SMART, with its blocks."""
    return [(decode_source(name, files[name]), read_smart(name, files[name])) for name in files if _is_smart(name)]


def _is_smart(name: str) -> bool:
    return name.endswith(SMART.suffix)


def read_stl(files: Mapping[str, bytes]) -> list[StlBlock]:
    """The blocks of all STL sources; those of the example that calls the others come last."""
    return [block for entry in _entries("s7-300-stl", files) for block in _parsed_stl(*entry)]


def read_scl(target: str, files: Mapping[str, bytes]) -> tuple[list[SclBlock], Dialect]:
    """The blocks of all SCL sources of a target, in the same order, and their dialect."""
    blocks = [block for entry in _entries(target, files) for block in _parsed_scl(target, *entry)]
    return blocks, _dialect(target)


def _dialect(target: str) -> Dialect:
    from plcgen.plc.scl.dialects import CLASSIC, TIA

    return next(dialect for dialect in (CLASSIC, TIA) if dialect.name == TARGETS[target].dialect)


def _entries(target: str, files: Mapping[str, bytes]) -> list[tuple[str, bytes]]:
    names = sorted(
        (name for name in files if name.endswith(TARGETS[target].suffix)), key=lambda name: ("_example" in name, name)
    )
    return [(name, files[name]) for name in names]


@lru_cache(maxsize=16)
def _parsed_stl(name: str, data: bytes) -> tuple[StlBlock, ...]:
    from plcgen.plc.stl.s7_parser import parse

    return tuple(parse(decode_source(name, data)))


@lru_cache(maxsize=16)
def _parsed_scl(target: str, name: str, data: bytes) -> tuple[SclBlock, ...]:
    from plcgen.plc.scl.parser import parse

    return tuple(parse(decode_source(name, data), _dialect(target)))
