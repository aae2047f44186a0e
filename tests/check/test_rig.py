"""The rig against a block that does next to nothing."""

from __future__ import annotations

import numpy as np
import pytest

from plcgen.check.rig import PERFECT, Clock, Encoder, Rig
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

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
END_VAR
BEGIN
    moving := enable;
    scans := scans + 1;
    limitedSetpoint := 0.0;
    IF enable THEN
        limitedSetpoint := 2.0;
    END_IF;
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""


def follower(clock: Clock, encoder: Encoder = PERFECT) -> Rig:
    program = lower(parse(SourceText("follower.scl", FOLLOWER), CLASSIC), CLASSIC)
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


def test_run_tells_whether_the_condition_came() -> None:
    rig = follower(Clock(0.5))
    assert rig.run(5, lambda rig: rig.get("scans") == 3)
    assert rig.scans == 3
    assert not rig.run(2, lambda rig: rig.get("scans") == 99)


def test_unknown_input_is_named() -> None:
    with pytest.raises(Exception, match="enabled"):
        follower(Clock(0.5)).set(enabled=True)
