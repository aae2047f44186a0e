"""What the pictures show: limits of the job, phases, errors computed right; and no peak is thinned away."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from plcgen import pipeline
from plcgen.job import read_job
from plcgen.plan import Plan
from plcgen.report.figures import MOST_POINTS, OTHER, Figure, differing, line, thinned
from plcgen.report.page import figures_of
from plcgen.trajectory import Trajectory

GOLDEN = Path(__file__).parents[2] / "golden"
CASES = ("short-shaft", "ramps", "half-sine", "quadrants", "quadrants-profile")


@cache
def drawn(case: str) -> tuple[Plan, dict[str, Figure]]:
    plan = pipeline.prepare(read_job(GOLDEN / case / "job.toml"))
    sources = {target: pipeline.sources(plan, target) for target in plan.job.targets}
    return plan, {figure.key: figure for figure in figures_of(plan, sources)}


@pytest.mark.parametrize("case", CASES)
def test_every_curve_has_points_and_every_axis_a_unit(case: str) -> None:
    for figure in drawn(case)[1].values():
        assert ", " in figure.label
        for panel in figure.panels:
            assert panel.lines
            assert ", " in panel.label or "pulses" in panel.label
            for curve in panel.lines:
                assert len(curve.x) == len(curve.y) > 1
                assert np.isfinite(curve.x).all()
                assert np.isfinite(curve.y).all()


def test_a_trip_shows_its_limits_and_legs() -> None:
    plan, figures = drawn("short-shaft")
    limits = [{limit.name: limit.value for limit in panel.limits} for panel in figures["over-time"].panels]
    assert limits == [{"max_velocity": 12.0}, {"acceleration": 0.75, "deceleration": -0.75}, {"jerk": -0.5}]
    names = [band.name for band in figures["over-time"].bands]
    assert names == ["start ramp", "creep out", "accelerate", "decelerate", "creep in", "stop ramp"]
    assert figures["over-time"].bands[-1].end == pytest.approx(sum(leg.duration for leg in plan.derivation().stretches))
    assert [curve.name for curve in figures["over-travel"].panels[0].lines] == [
        "reference",
        "s7-300-scl, s7-300-stl, tia-scl",
        "protection envelope",
    ]


def test_errors_are_those_of_the_checks() -> None:
    """The largest error of speed that is drawn is within the bound of the check."""
    _, figures = drawn("ramps")
    speed = figures["errors"].panels[0].lines
    assert 0.0 < max(np.abs(curve.y).max() for curve in speed) < 4.8e-7


def test_pulses_stay_within_one_of_the_profile() -> None:
    _, figures = drawn("quadrants")
    worst = max(np.abs(curve.y).max() for curve in figures["errors"].panels[0].lines)
    assert 0.0 < worst <= 1.05


def test_the_path_ends_where_the_moves_end() -> None:
    plan, figures = drawn("quadrants")
    exact, sent = figures["path"].panels[0].lines
    assert (exact.x[-1], exact.y[-1]) == pytest.approx((sent.x[-1], sent.y[-1]), abs=1e-9)
    assert figures["path"].equal
    assert plan.job.length_unit in figures["path"].label


def test_the_average_takes_the_jump_out_of_the_jerk() -> None:
    """Each has a panel then; a ramp, whose jerk keeps the limit by itself, shows both in one."""
    plan, figures = drawn("half-sine")
    averaged, raw = (max(np.abs(curve.y).max() for curve in panel.lines) for panel in figures["motion"].panels[2:])
    assert raw > 5 * averaged
    assert averaged <= 1.01 * plan.job.cosine.jerk
    _, figures = drawn("ramps")
    (jerk,) = figures["motion"].panels[2:]
    assert {curve.name for curve in jerk.lines} == {"before the average", "reference"}


def test_thinning_keeps_every_peak() -> None:
    x = np.arange(50_000.0)
    y = np.sin(x / 900.0)
    y[31_234], y[4_321] = 7.0, -8.0
    kept = thinned(line("a", OTHER, x, y))
    assert len(kept.x) <= MOST_POINTS + 2
    assert (kept.y.max(), kept.y.min()) == (7.0, -8.0)
    assert (kept.x[0], kept.x[-1]) == (0.0, 49_999.0)
    assert (np.diff(kept.x) > 0).all()
    short = replace(kept, x=x[:10], y=y[:10])
    assert thinned(short) is short


def test_targets_with_equal_traces_share_a_curve() -> None:
    same, other = Trajectory({"x": np.array([1.0, 2.0])}), Trajectory({"x": np.array([1.0, 2.5])})
    assert list(differing({"a": same, "b": other, "c": same})) == ["a, c", "b"]
