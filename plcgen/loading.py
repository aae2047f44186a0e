"""From the source files of a target to the program that is executed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from plcgen.plc.core import Program
from plcgen.plc.scl import lowering as scl
from plcgen.plc.scl import parser as scl_parser
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect
from plcgen.plc.scl.syntax import Block as SclBlock
from plcgen.plc.source import SourceText, decode_source
from plcgen.plc.stl import s7_lowering as stl
from plcgen.plc.stl import s7_parser as stl_parser
from plcgen.plc.stl.s7_syntax import Block as StlBlock
from plcgen.targets import TARGETS

DIALECTS = {dialect.name: dialect for dialect in (CLASSIC, TIA)}


def load(target: str, files: Mapping[str, bytes]) -> Program:
    """Parse and lower every source file of a target for S7-300 or TIA; the latest ones are at hand."""
    return _load(target, tuple(files.items()))


@lru_cache(maxsize=8)
def _load(target: str, entries: tuple[tuple[str, bytes], ...]) -> Program:
    files = dict(entries)
    if TARGETS[target].dialect == "stl":
        return stl.lower(read_stl(files))
    return scl.lower(*read_scl(target, files))


def read_stl(files: Mapping[str, bytes]) -> list[StlBlock]:
    """The blocks of all STL sources; those of the example that calls the others come last."""
    return [block for source in _sources("s7-300-stl", files) for block in stl_parser.parse(source)]


def read_scl(target: str, files: Mapping[str, bytes]) -> tuple[list[SclBlock], Dialect]:
    """The blocks of all SCL sources of a target, in the same order, and their dialect."""
    dialect = DIALECTS[TARGETS[target].dialect]
    return [block for source in _sources(target, files) for block in scl_parser.parse(source, dialect)], dialect


def _sources(target: str, files: Mapping[str, bytes]) -> list[SourceText]:
    names = sorted(
        (name for name in files if name.endswith(TARGETS[target].suffix)), key=lambda name: ("_example" in name, name)
    )
    return [decode_source(name, files[name]) for name in names]
