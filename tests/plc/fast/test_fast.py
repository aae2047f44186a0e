"""The compiled engine, virtual machine and native code, against the plain one: every operator, and golden blocks;
bit for bit.

Random programs: see tests/plc/stl/test_awlsim.py and tests/plc/cpu/test_smart.py.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any

import pytest

from plcgen.errors import Fault, PlcgenError
from plcgen.job import read_job
from plcgen.loading import load
from plcgen.plc import engines, operators
from plcgen.plc.core import Compute, Function, Program, Register, Return
from plcgen.plc.machine import Machine
from plcgen.plc.operators import Operator
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower as lower_scl
from plcgen.plc.scl.parser import parse as parse_scl
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl import s7_operators, smart_operators
from plcgen.plc.types import BOOL, Elementary, Type
from tests.every_engine import CHOICES, NATIVE, choose, is_native

pytest.importorskip("numba", reason="numba is the compiled engine: pip install plcgen[fast]")

from plcgen.plc.fast import generate
from plcgen.plc.fast.bodies import body_of

GOLDEN = Path(__file__).parents[3] / "golden"
SOURCE, HERE = SourceText("fast.scl", "x := 1;"), Span(0, 6)
FLOATS = (0.0, -0.0, 1.0, -1.5, 0.5, 2.5, -3.5, 1e-38, 1e-45, 3.4e38, -3.4e38, 65536.0, 2147483648.0, -2147483649.0)
NOT_FINITE = (math.inf, -math.inf, math.nan)


@pytest.fixture(autouse=True)
def engine() -> None:
    """These tests choose their engine."""


@pytest.fixture
def each(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., dict[str, Machine]]:
    """A machine on each engine."""

    def made(*arguments: Any) -> dict[str, Machine]:
        machines = {}
        for name in CHOICES:
            choose(name, monkeypatch, tmp_path)
            machines[name] = Machine(*arguments)
        assert type(machines["plain"].engine) is not type(machines["fast"].engine)
        assert [is_native(machines[name]) for name in (engines.FAST, NATIVE)] == [False, True]
        return machines

    return made


# ------------------------------------------------------------------------------------------------------ operators


def rows() -> Iterator[Operator]:
    """All rows on numbers: of the common table, and what both kinds of STL add."""
    for name in operators._table():
        yield from operators.alternatives(name)
    yield from generate.rows()
    yield from s7_operators.BCD.values()
    yield from (smart_operators.ROUND, smart_operators.TRUNC)


def is_number(kind: Type) -> bool:
    return isinstance(kind, Elementary)


def table() -> tuple[Program, list[Operator]]:
    """A function for each row."""
    found = [row for row in dict.fromkeys(rows()) if all(map(is_number, (*row.operands, row.result)))]
    functions = {}
    for number, row in enumerate(found):
        assert isinstance(row.result, Elementary)
        parameters = tuple(Register(n, kind) for n, kind in enumerate(row.operands, 1) if isinstance(kind, Elementary))
        result = Register(99, row.result)
        body = (Compute(HERE, result, row, parameters), Return(HERE))
        functions[f"FC{number}"] = Function(f"FC{number}", SOURCE, body, HERE, None, parameters, (result,))
    return Program(functions), found


def value(random: Random, kind: Type) -> Any:
    assert isinstance(kind, Elementary)
    if kind is BOOL:
        return random.random() < 0.5
    if not kind.is_integral:
        shape = random.random()
        if shape < 0.4:
            return kind.nearest(random.choice(FLOATS))
        if shape < 0.5:
            return random.choice(NOT_FINITE)
        return kind.nearest(random.uniform(-1, 1) * 10.0 ** random.randint(-40, 38))
    near = random.choice((0, 1, 2, 5, 31, 32, 33, kind.minimum, kind.maximum, kind.maximum - 1, -1))
    return min(
        max(near if random.random() < 0.6 else random.randint(kind.minimum, kind.maximum), kind.minimum), kind.maximum
    )


def values(random: Random, kinds: Sequence[Type]) -> list[Any]:
    """Often the same one for all that are alike: where comparisons turn."""
    found = [value(random, kind) for kind in kinds]
    return [found[0]] * len(found) if random.random() < 0.2 and len(set(kinds)) == 1 else found


def outcome(machine: Machine, name: str, operands: list[Any]) -> tuple[Any, ...]:
    """Bits of the result, events, or how it stopped."""
    machine.faults.clear()
    try:
        result = machine.call(name, arguments=operands)
    except (Fault, ValueError, NameError) as error:
        return ("stopped", str(error).splitlines()[0])
    bits = struct.pack(">d", result) if isinstance(result, float) else result
    return (type(result).__name__, bits, [fault.kind for fault in machine.faults])


def test_every_row_gives_the_same_bits(each: Callable[..., dict[str, Machine]]) -> None:
    linked, found = table()
    machines = each(linked)
    random = Random(2026)
    for number, row in enumerate(found):
        for _ in range(24):
            operands = values(random, row.operands)
            plain, *others = (outcome(machine, f"FC{number}", operands) for machine in machines.values())
            assert others == [plain, plain], (row, row.text, operands)


def test_most_rows_of_the_usual_types_have_a_body() -> None:
    usual = [row for row in generate.rows() if all(map(is_number, row.operands))]
    assert sum(body_of(row) is not None for row in usual) > 0.9 * len(usual)


def test_the_machine_is_what_its_generator_writes() -> None:
    again = "run python -m plcgen.plc.fast.generate"
    assert generate.FILE.read_text("ascii") == generate.written(), again
    for caller in generate.CALLERS:
        assert caller.read_text("ascii") == generate.stamped(caller, generate.written()), again


# ------------------------------------------------------------------------------------------------------- programs


@pytest.mark.parametrize(("case", "target"), [("short-shaft", "s7-300-scl"), ("ramps", "s7-300-stl")])
def test_golden_blocks_keep_the_same_memory(each: Callable[..., dict[str, Machine]], case: str, target: str) -> None:
    files = {path.name: path.read_bytes() for path in (GOLDEN / case / target).iterdir()}
    keys = read_job(GOLDEN / case / "job.toml").function_block
    machines = each(load(target, files), 0x7F)
    random, block, data = Random(1), f"FB{keys.fb}", f"DB{keys.db}"
    inputs = [
        name for name in ("enable", "execute", "stop", "restart", "directionUp") if _has(machines["plain"], data, name)
    ]
    for scan in range(2000):
        for name in inputs:
            if random.random() < 0.05:
                flag = random.random() < 0.6
                for machine in machines.values():
                    machine.variable(f'"{data}".{name}').set(flag)
        images = []
        for machine in machines.values():
            machine.scan = scan
            machine.call(block, data)
            images.append(bytes(machine.memory[data]))
        assert images == [images[0]] * len(CHOICES), scan
    assert machines["plain"].faults == machines["fast"].faults == machines[NATIVE].faults


def _has(machine: Machine, data: str, name: str) -> bool:
    try:
        machine.variable(f'"{data}".{name}')
    except PlcgenError:
        return False
    return True


# --------------------------------------------------------------------------------------------------------- choice


def test_an_engine_that_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(engines.VARIABLE, "quick")
    with pytest.raises(PlcgenError, match='PLCGEN_ENGINE is "quick"; there are the engines "plain" and "fast"'):
        engines.chosen()


def test_without_numba(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "find_spec", lambda _name: None)
    monkeypatch.delenv(engines.VARIABLE, raising=False)
    assert engines.chosen() == "plain"
    monkeypatch.setenv(engines.VARIABLE, "fast")
    with pytest.raises(PlcgenError, match='the fast engine needs numba; install plcgen with the extra "fast"'):
        engines.chosen()


# ---------------------------------------------------------------------------------------------------------- room

MANY_EVENTS = """FUNCTION FC1 : INT
VAR_INPUT
    a : INT;
END_VAR
BEGIN
    FC1 := a + 32767;
END_FUNCTION
FUNCTION FC2 : INT
VAR_TEMP
    n : DINT;
    x : INT;
END_VAR
BEGIN
    FOR n := 1 TO 40000 DO
        x := FC1(a := 1);
    END_FOR;
    FC2 := x;
END_FUNCTION
"""


def test_more_events_than_there_is_room_for(each: Callable[..., dict[str, Machine]]) -> None:
    """They are told in between, in their order, and nothing of the budget is spent on it."""
    linked = lower_scl(list(parse_scl(SourceText("many.scl", MANY_EVENTS), CLASSIC)), CLASSIC)
    machines = each(linked, 0, 80_001)
    results = [machine.call("FC2", arguments=[]) for machine in machines.values()]
    assert results == [-32768] * len(CHOICES)
    assert machines["plain"].faults == machines["fast"].faults == machines[NATIVE].faults
    assert len(machines["fast"].faults) == 40_000


def test_a_budget_that_is_spent_stops_all_at_the_same_place(each: Callable[..., dict[str, Machine]]) -> None:
    linked = lower_scl(list(parse_scl(SourceText("many.scl", MANY_EVENTS), CLASSIC)), CLASSIC)
    told = []
    for machine in each(linked, 0, 79_999).values():
        with pytest.raises(Fault) as raised:
            machine.call("FC2", arguments=[])
        told.append((str(raised.value), len(machine.faults)))
    assert told == [told[0]] * len(CHOICES)
