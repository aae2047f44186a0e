"""Programs with their expectation beside each line, run on a fresh machine for one scan."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from plcgen.plc.cpu.smart import Smart
from plcgen.plc.source import read_source
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from plcgen.plc.stl.smart_table import MNEMONICS
from plcgen.plc.stl.syntax import Block
from plcgen.plc.types import REAL

FOLDER = Path(__file__).parent
EXPECTATION = re.compile(r"// expect (.+)$")


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
    for network in block.networks:
        for number, statement in enumerate(network.statements, 1):
            row = source.location(statement.span).line
            found = EXPECTATION.search(lines[row - 1])
            if found is not None:
                pairs = tuple(map(_sides, found[1].strip().split(", ")))
                cut = replace(network, statements=network.statements[:number])
                code = lines[row - 1].split("//")[0].strip()
                yield Case(replace(block, networks=(cut,)), f"{path.stem} {row} {code}", pairs)


def _sides(equation: str) -> tuple[str, str]:
    left, right = equation.split(" = ")
    return left, right


ALL = [case for path in sorted((FOLDER / "cases").glob("*.awl")) for case in cases(path)]


@pytest.mark.parametrize("case", ALL, ids=lambda case: case.line)
def test_line_leaves_what_stands_beside_it(case: Case) -> None:
    machine = Smart(lower([case.block]))
    machine.scan()
    for path, text in case.expected:
        kind = REAL if "." in text else None
        wanted = REAL.nearest(float(text)) if kind else int(text)
        assert machine.variable(path, kind).get() == wanted, path


def test_each_mnemonic_has_a_test() -> None:
    files = (*FOLDER.glob("cases/*.awl"), *FOLDER.glob("test_*.py"), *FOLDER.parent.glob("cpu/test_*.py"))
    texts = [path.read_text("utf-8") for path in files]
    met = {word for text in texts for line in text.splitlines() for word in line.split()[:1]}
    assert set(MNEMONICS) - met == set()
