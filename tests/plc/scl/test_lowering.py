"""Programs with their expectation beside each statement, run in the plain engine."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from plcgen.plc.core import print_function
from plcgen.plc.machine import Machine
from plcgen.plc.scl.dialects import CLASSIC, Dialect, detect_dialect
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import Assignment, Block, Statement
from plcgen.plc.source import SourceText, read_source

CASES = Path(__file__).parent / "cases"
EXPECTATION = re.compile(r"//\s*expect\s*(?P<name>#?[\w.]+)?:\s*(?P<value>[^,]+?)(?:,\s*(?P<fault>.+))?\s*$")
NAMES = {"TRUE": True, "FALSE": False, "inf": math.inf, "-inf": -math.inf, "nan": math.nan}


@dataclass(frozen=True)
class Case:
    blocks: tuple[Block, ...]
    dialect: Dialect
    line: str
    variable: str
    value: object
    fault: str | None


def cases(path: Path) -> Iterator[Case]:
    """Each run of statements up to a line with an expectation."""
    source = read_source(path)
    dialect = detect_dialect(source)
    *others, tested = parse(source, dialect)
    lines = source.text.splitlines()
    waiting: list[Statement] = []
    for number, statement in enumerate(tested.body):
        waiting.append(statement)
        row = end_row(source, statement)
        last = number + 1 == len(tested.body) or end_row(source, tested.body[number + 1]) != row
        found = EXPECTATION.search(lines[row]) if last else None
        if found is None:
            continue
        blocks = (*others, replace(tested, body=tuple(waiting)))
        code = lines[row].split("//")[0].strip()
        variable = (found["name"] or target(source, statement)).lstrip("#")
        yield Case(blocks, dialect, f"{row + 1} {code}", variable, value(found["value"]), found["fault"])
        waiting = []


def target(source: SourceText, statement: Statement) -> str:
    assert isinstance(statement, Assignment), "name the variable that is expected"
    return source.text[statement.target.span.start : statement.target.span.end]


def end_row(source: SourceText, statement: Statement) -> int:
    return source.text.count("\n", 0, statement.span.end - 1)


def value(text: str) -> object:
    return NAMES[text] if text in NAMES else ast.literal_eval(text)


ALL = [case for path in sorted(CASES.glob("*.scl")) for case in cases(path)]


@pytest.mark.parametrize("case", ALL, ids=lambda case: case.line)
def test_statement_gives_what_stands_beside_it(case: Case) -> None:
    machine = Machine(lower(case.blocks, case.dialect))
    machine.call(case.blocks[-1].name, instance="DB1")
    result = machine.variable(f"DB1.{case.variable}").get()
    assert result == case.value or (result != result and case.value != case.value)
    assert type(result) is type(case.value)
    assert [fault.kind for fault in machine.faults] == ([case.fault] if case.fault else [])


def test_every_expectation_is_found() -> None:
    written = sum(len(re.findall("// expect", path.read_text())) for path in CASES.glob("*.scl"))
    assert len(ALL) == written > 100


def test_lowered_text_reads_like_the_source() -> None:
    source = SourceText(
        "ramp.scl",
        """
FUNCTION_BLOCK FB1
VAR_INPUT enable : BOOL; step : REAL; END_VAR
VAR_OUTPUT speed : REAL; END_VAR
VAR_TEMP rest : REAL; n : INT; END_VAR
BEGIN
  rest := 10.0 - speed;
  IF enable AND rest > 2.0 * 0.25 THEN
    speed := speed + step * n;
  ELSE
    speed := 0.0;
  END_IF;
END_FUNCTION_BLOCK
""",
    )
    program = lower(parse(source, CLASSIC), CLASSIC)
    assert print_function(program.functions["FB1"]) == (
        "FB1:\n"
        "    #rest:REAL := 10.0 - D[6.0]\n"
        "    %4:BOOL := #rest > 0.5\n"
        "    %5:BOOL := D[0.0] AND %4\n"
        "    if not %5 jump L2\n"
        "    %6:REAL := INT_TO_REAL(#n)\n"
        "    %7:REAL := D[2.0] * %6\n"
        "    D[6.0]:REAL := D[6.0] + %7\n"
        "    jump L1\n"
        "L2:\n"
        "    D[6.0]:REAL := 0.0\n"
        "L1:\n"
        "    return"
    )


def test_symbols_name_blocks_and_addresses() -> None:
    source = SourceText(
        "symbols.scl",
        """
FUNCTION_BLOCK "Drive"
VAR_INPUT speed : REAL; END_VAR
VAR_OUTPUT fast : BOOL; END_VAR
BEGIN
  fast := speed > 1.0;
  "Lamp" := fast;
END_FUNCTION_BLOCK
ORGANIZATION_BLOCK OB1
BEGIN
  "Drive"."DriveData"(speed := 2.0);
END_ORGANIZATION_BLOCK
""",
    )
    symbols = {"Drive": "FB 100", "DriveData": "DB 100", "Lamp": "Q 4.1"}
    machine = Machine(lower(parse(source, CLASSIC), CLASSIC, symbols))
    machine.call("OB1")
    assert machine.variable("DB100.fast").get() is True
    assert machine.variable('"DriveData".speed').get() == 2.0
    assert machine.variable("Q4.1").get() is True
