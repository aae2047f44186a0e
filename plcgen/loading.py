"""From the source files of a target to the program that is executed."""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.core import Program
from plcgen.plc.scl import lowering as scl
from plcgen.plc.scl import parser as scl_parser
from plcgen.plc.scl.dialects import CLASSIC, TIA
from plcgen.plc.source import decode_source
from plcgen.plc.stl import s7_lowering as stl
from plcgen.plc.stl import s7_parser as stl_parser
from plcgen.targets import TARGETS

DIALECTS = {dialect.name: dialect for dialect in (CLASSIC, TIA)}


def load(target: str, files: Mapping[str, bytes]) -> Program:
    """Parse and lower every source file of a target for S7-300 or TIA; the example that calls the blocks comes last."""
    row = TARGETS[target]
    names = sorted((name for name in files if name.endswith(row.suffix)), key=lambda name: ("_example" in name, name))
    sources = [decode_source(name, files[name]) for name in names]
    if row.dialect == "stl":
        return stl.lower([block for source in sources for block in stl_parser.parse(source)])
    dialect = DIALECTS[row.dialect]
    return scl.lower([block for source in sources for block in scl_parser.parse(source, dialect)], dialect)
