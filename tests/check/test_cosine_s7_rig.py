"""Many samples at once against single ones."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from random import Random

import numpy as np
import pytest

from plcgen.check.cosine_s7_rig import S7Axis
from plcgen.check.played import WORTH_A_SCRIPT
from plcgen.errors import Fault
from plcgen.plc import engines
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.script import Step
from plcgen.plc.source import SourceText
from tests.every_engine import CHOICES, choose

# Overflows where the sum passes the range; `even` and `tenth` are bits of one byte; the index is outside from 60 on.
COUNTER = """
FUNCTION_BLOCK FB1
VAR_INPUT
    growth : REAL;
END_VAR
VAR_OUTPUT
    calls : INT;
    total : REAL;
    even : BOOL;
    tenth : BOOL;
END_VAR
VAR
    seen : ARRAY[0..59] OF BOOL;
END_VAR
BEGIN
    seen[calls] := TRUE;
    calls := calls + 1;
    total := total + growth;
    even := calls MOD 2 = 0;
    tenth := calls MOD 10 = 0;
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""


def axis() -> S7Axis:
    return S7Axis(lower(parse(SourceText("counter.scl", COUNTER), CLASSIC), CLASSIC), "FB1", "DB1")


@pytest.fixture(params=CHOICES, autouse=True)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> str:
    choose(request.param, monkeypatch, tmp_path)
    return str(request.param)


def test_samples_up_to_an_output() -> None:
    found = axis()
    found.samples(30, until="tenth")
    assert found.scans == found.get("calls") == 10
    found.samples(5, until="tenth")
    assert found.scans == 15
    found.samples(3)
    assert list(found.trace()["calls"]) == list(range(1, 19))
    assert list(found.trace()["even"]) == [False, True] * 9


def test_events_and_faults_have_their_scan() -> None:
    found = axis()
    found.set(growth=1.0e38)
    with pytest.raises(Fault) as caught:
        found.samples(70)
    assert "array index 60 outside 0 .. 59 (scan 60)" in str(caught.value)
    # Infinite from the fourth on; each further sum is an overflow too.
    assert [(event.kind, event.scan) for event in found.machine.faults] == [("overflow", n) for n in range(3, 60)]


@pytest.mark.parametrize("seed", range(20))
def test_many_samples_at_once_are_what_single_ones_are(seed: int, engine: str) -> None:
    random = Random(seed)
    quick, single = axis(), axis()
    assert (quick._loop is None) == (engine == engines.PLAIN)
    while quick.scans < 45:
        growth, most, until = random.uniform(0.0, 2e38), random.randrange(1, 15), random.choice(["", "even", "tenth"])
        for one in (quick, single):
            one.set(growth=growth)
        quick.samples(most, until)
        for _ in range(most):
            single.scan()
            if until and single.get(until):
                break
        assert quick.scans == single.scans, seed
    traces = quick.trace(), single.trace()
    assert all(np.array_equal(traces[0][name], traces[1][name]) for name in traces[0].columns), seed
    assert quick.machine.faults == single.machine.faults, seed


@pytest.mark.parametrize("seed", range(20))
def test_steps_are_what_single_samples_are(seed: int) -> None:
    """Few of them or a script, with faults and events on the way."""
    random = Random(seed)
    played, single = axis(), axis()
    while played.scans < 45:
        steps: list[Step] = []
        for _ in range(random.choice([1, 3, WORTH_A_SCRIPT, 12])):
            inputs = {"growth": random.uniform(0.0, 2e38)} if random.random() < 0.7 else {}
            steps.append((inputs, random.randrange(1, 4)))
        for one in (played, single):
            with suppress(Fault):
                one.play(steps) if one is played else singly(one, steps)
        assert played.scans == single.scans, seed
    traces = played.trace(), single.trace()
    assert all(np.array_equal(traces[0][name], traces[1][name]) for name in traces[0].columns), seed
    assert played.machine.faults == single.machine.faults, seed


def singly(one: S7Axis, steps: list[Step]) -> None:
    for inputs, count in steps:
        one.set(**inputs)
        for _ in range(count):
            one.scan()
