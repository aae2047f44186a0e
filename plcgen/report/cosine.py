"""Pictures of ramps and half-sine moves: before and after the moving average, and what the block did differently."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from plcgen.plan_cosine import CosinePlan
from plcgen.report.figures import (
    OTHER,
    REFERENCE,
    TRACE,
    Band,
    Figure,
    Line,
    Panel,
    both_ways,
    by_move,
    cut,
    moves_of,
    one_after_another,
)
from plcgen.trajectory import Trajectory

TIME = "time, s"
MOST_LIMITS = 3.0
Traces = dict[str, Trajectory]


def cosine_figures(plan: CosinePlan, traces: Traces) -> tuple[Figure, ...]:
    reference = plan.reference()
    bands = one_after_another(list(map(len, moves_of(reference, "velocity"))), plan.job.sample_period)
    return _motion(plan, reference, traces, bands), _errors(plan, reference, traces, bands)


def _motion(plan: CosinePlan, reference: Trajectory, traces: Traces, bands: tuple[Band, ...]) -> Figure:
    unit, limits, period = plan.job.length_unit, plan.job.cosine, plan.job.sample_period
    raw = moves_of(reference, "raw_velocity")
    before = by_move("before the average", OTHER, raw, bands, period)
    jerks = [np.diff(move.raw, 2, prepend=[move.start] * 2) / period**2 for move in plan.nominal()]
    jerk = by_move("before the average", OTHER, jerks, bands, period, stepped=True)
    after = by_move("reference", REFERENCE, moves_of(reference, "jerk"), bands, period, stepped=True)
    speed = _both(plan, reference, "velocity", traces, "velocitySetpoint", bands)
    acceleration = _both(plan, reference, "acceleration", traces, "acceleration", bands)
    panels = (
        Panel(f"speed, {unit}/s", (*before, *speed), both_ways("max_velocity", limits.max_velocity)),
        Panel(f"acceleration, {unit}/s2", acceleration, both_ways("max_acceleration", limits.max_acceleration)),
        *_jerk_panels(f"jerk, {unit}/s3", jerk, after, limits.jerk, largest=max(np.abs(j).max() for j in jerks)),
    )
    return Figure("motion", "Before and after the moving average", TIME, panels, bands)


def _jerk_panels(
    title: str, before: Sequence[Line], after: Sequence[Line], limit: float, largest: float
) -> tuple[Panel, ...]:
    """Both in one panel, unless what comes before the average would leave nothing to see of what comes behind it."""
    if largest <= MOST_LIMITS * limit:
        return (Panel(title, (*before, *after), both_ways("jerk", limit)),)
    return Panel(title, tuple(after), both_ways("jerk", limit)), Panel(title, tuple(before))


def _both(
    plan: CosinePlan, reference: Trajectory, exact: str, traces: Traces, column: str, bands: tuple[Band, ...]
) -> tuple[Line, ...]:
    """Reference and traces of one quantity."""
    period, right = plan.job.sample_period, moves_of(reference, exact)
    lines = [*by_move("reference", REFERENCE, right, bands, period)]
    for name, trace in traces.items():
        lines += by_move(name, TRACE, cut(moves_of(trace, column), right), bands, period)
    return tuple(lines)


def _errors(plan: CosinePlan, reference: Trajectory, traces: Traces, bands: tuple[Band, ...]) -> Figure:
    unit = plan.job.length_unit
    speed = tuple(_error(plan, reference, "velocity", traces, "velocitySetpoint", bands))
    acceleration = tuple(_error(plan, reference, "acceleration", traces, "acceleration", bands))
    panels = Panel(f"speed, {unit}/s", speed), Panel(f"acceleration, {unit}/s2", acceleration)
    return Figure("errors", "Trace less reference", TIME, panels, bands)


def _error(
    plan: CosinePlan, reference: Trajectory, exact: str, traces: Traces, column: str, bands: tuple[Band, ...]
) -> Iterator[Line]:
    right = moves_of(reference, exact)
    for name, trace in traces.items():
        found = cut(moves_of(trace, column), right)
        off = [own - wanted for own, wanted in zip(found, right, strict=True)]
        yield from by_move(name, OTHER, off, bands, plan.job.sample_period)
