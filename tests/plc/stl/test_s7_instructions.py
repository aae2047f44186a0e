"""Programs for S7-300 with their expectation beside each line, run on a fresh machine."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from plcgen.plc.machine import Machine
from plcgen.plc.source import read_source
from plcgen.plc.stl.s7_lowering import lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.stl.s7_syntax import Block
from plcgen.plc.stl.s7_table import CALLS, MNEMONICS
from plcgen.plc.types import REAL

FOLDER = Path(__file__).parent
EXPECTATION = re.compile(r"// expect (.+)$")
SYMBOLS = {"Plain": "DB 5"}
# What the OB of reader.inc puts into memory behind the call.
REGISTERS: Mapping[str, Callable[[Machine], int]] = {
    "ACCU1": lambda machine: int(machine.variable("MD100").get()),
    "ACCU2": lambda machine: int(machine.variable("MD104").get()),
    "RLO": lambda machine: int(machine.variable("MW108").get()) >> 1 & 1,
    "OV": lambda machine: int(machine.variable("MW108").get()) >> 5 & 1,
    "CC": lambda machine: int(machine.variable("MW108").get()) >> 6 & 3,
    "BR": lambda machine: int(machine.variable("MW108").get()) >> 8 & 1,
}


@dataclass(frozen=True)
class Case:
    block: Block
    line: str
    expected: tuple[tuple[str, str], ...]


def cases(path: Path) -> Iterator[Case]:
    """Each network up to each line with an expectation."""
    source = read_source(path)
    (block,) = parse(source)
    lines = source.text.splitlines()
    starts = [network.start for network in block.networks]
    for start, end in zip(starts, [*starts[1:], block.declaration.extent.end], strict=True):
        statements = tuple(s for s in block.statements if start < s.span.start < end)
        rows = [source.location(s.span).line for s in statements]
        for row in sorted(set(rows)):
            found = EXPECTATION.search(lines[row - 1])
            if found is not None:
                cut = tuple(s for s, own in zip(statements, rows, strict=True) if own <= row)
                pairs = tuple(map(_sides, found[1].strip().split(", ")))
                code = lines[row - 1].split("//")[0].strip()
                yield Case(replace(block, statements=cut), f"{path.stem} {row} {code}", pairs)


def _sides(equation: str) -> tuple[str, str]:
    left, right = equation.split(" = ")
    return left, right


def value_of(text: str) -> float:
    if text.startswith("16#"):
        return int(text[3:], 16)
    return REAL.nearest(float(text)) if "." in text or text == "nan" else int(text)  # type: ignore[return-value]


def others() -> list[Block]:
    return [block for name in ("blocks", "reader") for block in parse(read_source(FOLDER / "s7_cases" / f"{name}.inc"))]


ALL = [case for path in sorted((FOLDER / "s7_cases").glob("*.awl")) for case in cases(path)]


@pytest.mark.parametrize("case", ALL, ids=lambda case: case.line)
def test_line_leaves_what_stands_beside_it(case: Case) -> None:
    machine = Machine(lower([case.block, *others()], SYMBOLS))
    machine.call("OB1")
    for name, text in case.expected:
        read = REGISTERS.get(name)
        found = read(machine) if read else machine.variable(f"DB1.{name}").get()
        wanted = value_of(text)
        assert found == wanted or (math.isnan(wanted) and math.isnan(found)), name


def test_each_mnemonic_has_a_test() -> None:
    met = {statement.mnemonic for case in ALL for statement in case.block.statements}
    elsewhere = {"LAR2", "TAR2", "+AR2", "CAR", "CDB", *CALLS}  # not in an FB: see test_s7_blocks
    assert set(MNEMONICS) - met <= elsewhere
