"""The rig against a block that does next to nothing."""

from __future__ import annotations

from math import inf
from pathlib import Path
from random import Random

import numpy as np
import pytest

from plcgen.check.rig import PERFECT, Clock, Encoder, Goal, Rig
from plcgen.errors import Fault
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText
from tests.every_engine import CHOICES, QUICK, choose

FOLLOWER = """
FUNCTION_BLOCK FB1
VAR_INPUT
    enable : BOOL;
    actualTravel : REAL;
    actualVelocity : REAL;
    cycleTime : REAL;
END_VAR
VAR_OUTPUT
    limitedSetpoint : REAL;
    moving : BOOL;
    scans : INT;
    phase : INT;
END_VAR
BEGIN
    moving := enable;
    scans := scans + 1;
    phase := scans / 5;
    limitedSetpoint := 0.0;
    IF enable THEN
        limitedSetpoint := 2.0;
    END_IF;
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""


def follower(clock: Clock, encoder: Encoder = PERFECT, text: str = FOLLOWER) -> Rig:
    program = lower(parse(SourceText("follower.scl", text), CLASSIC), CLASSIC)
    return Rig(program, "FB1", "DB1", 10.0, clock, encoder)


def test_hoist_moves_at_the_setpoint_of_the_last_scan() -> None:
    rig = follower(Clock(0.5))
    rig.set(enable=True)
    rig.run(4)
    trace = rig.trace()
    assert list(trace["time"]) == [0.0, 0.5, 1.0, 1.5]
    assert list(trace["actualTravel"]) == [10.0, 11.0, 12.0, 13.0]
    assert list(trace["actualVelocity"]) == [0.0, 2.0, 2.0, 2.0]
    assert list(trace["moving"]) == [True] * 4
    assert list(trace["scans"]) == [1, 2, 3, 4]


def test_encoder_steps_and_delay() -> None:
    rig = follower(Clock(0.5), Encoder(quantum=0.75, delay=1))
    rig.set(enable=True)
    rig.run(4)
    assert list(rig.trace()["actualTravel"]) == [9.75, 9.75, 10.5, 12.0]


def test_jitter_does_not_drift_and_is_repeatable() -> None:
    times = []
    for _ in range(2):
        rig = follower(Clock(0.5, jitter=0.1))
        rig.run(200)
        times.append(rig.trace()["time"])
    assert np.array_equal(times[0], times[1])
    deviation = np.abs(times[0] - np.arange(200) * 0.5)
    assert 0.03 < deviation.max() <= 0.05


def test_snapshot_brings_everything_back() -> None:
    rig = follower(Clock(0.5))
    rig.set(enable=True)
    rig.run(3)
    moment = rig.snapshot()
    rig.run(3)
    rig.force(actualTravel=99.0)
    rig.restore(moment)
    rig.scan()
    trace = rig.trace()
    assert len(trace) == 1
    assert trace["actualTravel"][0] == 13.0
    assert trace["scans"][0] == 4


def test_forced_measurement_and_release() -> None:
    rig = follower(Clock(0.5))
    rig.force(actualTravel=-3.0)
    rig.scan()
    rig.release()
    rig.scan()
    assert list(rig.trace()["actualTravel"]) == [-3.0, 10.0]


def test_run_tells_whether_the_goal_was_met() -> None:
    rig = follower(Clock(0.5))
    assert rig.run(20, Goal(frozenset({2})))
    assert rig.scans == 10
    assert not rig.run(7, Goal(frozenset({1, 4})))
    assert rig.scans == 17
    rig.set(enable=True)
    assert rig.run(20, Goal(phases_outside=frozenset({3, 4}), between=(-inf, 12.5)))
    assert list(rig.trace()["plantTravel"])[-4:] == [10.0, 11.0, 12.0, 13.0]


# Overflows in scans 8 and 9 (INT), divides by 0 in scan 11, and its index is outside from scan 14 on.
TROUBLED = FOLLOWER.replace(
    "    moving := enable;",
    """
    IF scans = 7 OR scans = 8 THEN
        limitedSetpoint := 3.0E38 * (scans + 1.0E10);
    END_IF;
    IF scans = 10 THEN
        limitedSetpoint := 1.0 / (limitedSetpoint - limitedSetpoint);
    END_IF;
    table[scans] := 1.0;
    moving := enable;
""",
).replace("    phase : INT;\n", "    phase : INT;\n    table : ARRAY[0..12] OF REAL;\n")


@pytest.mark.parametrize("engine", CHOICES)
def test_events_and_faults_on_the_way_have_their_scan(
    engine: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    choose(engine, monkeypatch, tmp_path)
    rig = follower(Clock(0.5), text=TROUBLED)
    with pytest.raises(Fault) as caught:
        rig.run(40)
    assert str(caught.value).splitlines()[0].endswith("array index 13 outside 0 .. 12 (scan 13)")
    assert [(event.kind, event.scan) for event in rig.machine.faults] == [
        ("overflow", 7),
        ("overflow", 8),
        ("division by zero", 10),
    ]


@pytest.mark.parametrize("engine", QUICK)
@pytest.mark.parametrize("seed", range(40))
def test_many_scans_at_once_are_what_single_ones_are(
    seed: int, engine: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Whatever the clock, the encoder, the goal, and the order of single scans and runs, on the compiled engine."""
    choose(engine, monkeypatch, tmp_path)
    random = Random(seed)
    clock = Clock(random.choice([0.5, 0.013]), random.choice([0.0, 0.2]), seed)
    encoder = Encoder(random.choice([0.0, 0.001, 0.75]), random.randrange(4))
    rigs = [follower(clock, encoder) for _ in range(2)]
    rigs[1]._loop = None
    assert rigs[0]._loop is not None
    for _ in range(random.randrange(2, 12)):
        enable, scans = random.random() < 0.7, random.randrange(1, 40)
        phases = frozenset(random.sample(range(60), random.randrange(3)))
        outside = frozenset(random.sample(range(60), 30)), (random.uniform(0.0, 10.0), random.uniform(10.0, 40.0))
        goal = random.choice([None, Goal(phases), Goal(phases, *outside)])
        measured, forced, single = random.uniform(0.0, 20.0), random.random() < 0.2, random.random() < 0.3
        answers = []
        for rig in rigs:
            rig.set(enable=enable)
            if forced:
                rig.force(actualTravel=measured)
            if single:
                rig.scan()
            answers.append((rig.run(scans, goal), rig.scans, rig.plant))
            rig.release()
        assert answers[0] == answers[1], seed
    one, other = (rig.trace() for rig in rigs)
    assert one.columns.keys() == other.columns.keys()
    assert all(one[name].tobytes() == other[name].tobytes() for name in one.columns), seed


def test_unknown_input_is_named() -> None:
    with pytest.raises(Exception, match="enabled"):
        follower(Clock(0.5)).set(enabled=True)
