"""Pictures of the moves of a table: profile, path, pulses of both axes, and how far each is from where it should be."""

from __future__ import annotations

import numpy as np

from plcgen.plan_two_axis import TwoAxisPlan
from plcgen.report.figures import (
    OTHER,
    REFERENCE,
    TRACE,
    Band,
    Figure,
    Limit,
    Line,
    Panel,
    Values,
    both_ways,
    by_move,
    line,
    moves_of,
    one_after_another,
)
from plcgen.trajectory import Trajectory

TIME = "time, s"
ROLES = {"x": TRACE, "y": OTHER}


def two_axis_figures(plan: TwoAxisPlan, traces: dict[str, Trajectory]) -> tuple[Figure, ...]:
    reference, (trace,) = plan.reference(), traces.values()
    bands = one_after_another(list(map(len, moves_of(reference, "velocity"))), plan.job.sample_period)
    return (
        _path(plan, trace),
        _profile(plan, reference, bands),
        _pulses(plan, trace, bands),
        _deviation(plan, reference, trace, bands),
    )


def _path(plan: TwoAxisPlan, trace: Trajectory) -> Figure:
    unit, scales = plan.job.length_unit, plan.job.two_axis.pulses_per_unit
    corners = np.concatenate([[(0, 0)], np.cumsum([(m.pulses.x, m.pulses.y) for m in plan.moves], axis=0)])
    lines = (
        line("straight lines", REFERENCE, corners[:, 0] / scales[0], corners[:, 1] / scales[1]),
        line("pulses sent", TRACE, trace["x"] / scales[0], trace["y"] / scales[1]),
    )
    return Figure("path", "Path", f"x, {unit}", (Panel(f"y, {unit}", lines),), equal=True)


def _profile(plan: TwoAxisPlan, reference: Trajectory, bands: tuple[Band, ...]) -> Figure:
    unit, limits, period = plan.job.length_unit, plan.job.two_axis, plan.job.sample_period
    speed, acceleration, jerk = (
        by_move("reference", REFERENCE, moves_of(reference, name), bands, period, stepped=name == "jerk")
        for name in ("velocity", "acceleration", "jerk")
    )
    panels = (
        Panel(f"speed, {unit}/s", speed, (Limit("max_velocity", limits.max_velocity),)),
        Panel(f"acceleration, {unit}/s2", acceleration, both_ways("max_acceleration", limits.max_acceleration)),
        Panel(f"jerk, {unit}/s3", jerk, both_ways("jerk", limits.jerk)),
    )
    return Figure("profile", "The axis that goes farther, over time", TIME, panels, bands)


def _pulses(plan: TwoAxisPlan, trace: Trajectory, bands: tuple[Band, ...]) -> Figure:
    period = plan.job.sample_period
    counts: list[Line] = []
    rates: list[Line] = []
    for axis, role in ROLES.items():
        sent = moves_of(trace, axis)
        counts += by_move(axis, role, sent, bands, period)
        rates += by_move(axis, role, [np.append(np.diff(move), 0.0) / period for move in sent], bands, period, True)
    panels = Panel("pulses sent", tuple(counts)), Panel("pulses/s", tuple(rates))
    return Figure("pulses", "Pulses of both axes", TIME, panels, bands, "Mean rate of the sample that begins.")


def _deviation(plan: TwoAxisPlan, reference: Trajectory, trace: Trajectory, bands: tuple[Band, ...]) -> Figure:
    lines: list[Line] = []
    for axis, role in ROLES.items():
        lines += by_move(axis, role, _ahead(plan, reference, trace, axis), bands, plan.job.sample_period)
    note = "At the end of each sample. Between the corners of a table the hardware runs along chords of the profile."
    panel = Panel("pulses", tuple(lines))
    return Figure("errors", "Pulses sent less the profile", TIME, (panel,), bands, note)


def _ahead(plan: TwoAxisPlan, reference: Trajectory, trace: Trajectory, axis: str) -> list[Values]:
    """Pulses of an axis beyond its share of the way, move by move."""
    travels, found, begin = moves_of(reference, "travel"), [], 0
    for move, sent, travel in zip(plan.moves, moves_of(trace, axis), travels, strict=True):
        way = getattr(move.pulses, axis)
        count = min(len(sent), len(travel))
        found.append(sent[:count] - begin - way * travel[:count] / move.profile.distance)
        begin += way
    return found
