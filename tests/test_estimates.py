"""Estimates of whole targets: what a run takes stays below them, and what has no bound says so."""

from __future__ import annotations

from pathlib import Path

import pytest

from plcgen import pipeline
from plcgen.check.two_axis_rig import Table
from plcgen.estimates import estimate, estimate_rows
from plcgen.job import read_job
from plcgen.plan import Plan
from plcgen.plan_two_axis import TwoAxisPlan

GOLDEN = Path(__file__).parents[1] / "golden"
CASES = ("main-shaft", "short-shaft", "ramps", "ramps-long-filter", "half-sine", "table-1", "table-1-profile")


def plan_of(case: str) -> Plan:
    return pipeline.prepare(read_job(GOLDEN / case / "job.toml"))


@pytest.mark.parametrize("case", CASES)
def test_every_loop_of_our_sources_has_a_bound(case: str) -> None:
    plan = plan_of(case)
    for target in plan.job.targets:
        found = plan.estimate(target, plan.sources(target))
        assert found.run_times
        assert all(time.seconds for time in found.run_times), [time.reason for time in found.run_times]
        assert found.code_bytes > 500
        assert found.data_bytes > 100


@pytest.mark.parametrize("case", ["table-1", "table-1-profile"])
def test_no_run_takes_longer_than_the_longest_way(case: str) -> None:
    plan = plan_of(case)
    assert isinstance(plan, TwoAxisPlan)
    files = plan.sources("s7-200-smart")
    subject = plan.subject(files)
    table = Table(subject, timed=True)
    for move in subject.model.moves:
        table.run(move, "")
    bounds = {time.block: time.seconds for time in plan.estimate("s7-200-smart", files).run_times}
    taken = {name: 1e-6 * time for name, time in table.cpu.run_times.items()}
    assert taken.keys() == bounds.keys()
    for name, bound in bounds.items():
        assert bound is not None
        # nearly everything is executed at some time, but never all of it at once
        assert 0.3 * bound < taken[name] <= bound


def test_targets_of_s7_agree_roughly_and_stl_by_hand_is_shorter() -> None:
    plan = plan_of("ramps")
    scl, stl, tia = (plan.estimate(t, plan.sources(t)) for t in ("s7-300-scl", "s7-300-stl", "tia-scl"))
    assert [time.seconds for time in scl.run_times] == [time.seconds for time in tia.run_times]
    for compiled, written in zip(scl.run_times, stl.run_times, strict=True):
        assert compiled.seconds is not None
        assert written.seconds is not None
        assert 0.3 * compiled.seconds < written.seconds < compiled.seconds


def test_rows_are_told_in_ms_and_percent_of_a_sample() -> None:
    plan = plan_of("ramps")
    rows = estimate_rows(plan.estimate("s7-200-smart", plan.sources("s7-200-smart")), plan.job.sample_period)
    assert [(row.block, bool(row.share)) for row in rows] == [("OB1", False), ("INT0", True)]
    assert float(rows[1].share) == pytest.approx(100 * float(rows[1].milliseconds) / 10.0, rel=0.02)


def test_a_loop_without_bound_has_no_run_time() -> None:
    lines = ["FUNCTION_BLOCK FB1", "VAR", "    n : INT;", "END_VAR", "BEGIN"]
    lines += ["    WHILE n > 0 DO", "        n := n - 1;", "    END_WHILE;", "END_FUNCTION_BLOCK", ""]
    found = estimate("s7-300-scl", {"a.scl": "\r\n".join(lines).encode()})
    assert [time.seconds for time in found.run_times] == [None, None, None]
    assert found.run_times[0].reason.startswith("a.scl:6:5: how often this loop runs does not stand in the text")
    assert [row.milliseconds for row in estimate_rows(found, 0.01)] == ["no bound"] * 3
    assert found.as_json()["run_times"] == [
        {"cpu": cpu, "block": "FB1", "seconds": None} for cpu in ("CPU 314", "CPU 315-2DP", "CPU 317")
    ]
