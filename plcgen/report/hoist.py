"""Pictures of a trip: over time, over travel with the envelope, and what the block did differently."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plcgen.plan_hoist import HoistPlan
from plcgen.report.figures import BOUND, OTHER, REFERENCE, TRACE, Band, Figure, Limit, Line, Panel, both_ways, line
from plcgen.trajectory import Trajectory

TIME = "time, s"
BY_TRAVEL = (2, 3, 4, 5, 6)
"""Phases from creep out to creep in."""


def hoist_figures(plan: HoistPlan, traces: dict[str, Trajectory]) -> tuple[Figure, ...]:
    reference = plan.reference()
    bands = tuple(_legs(plan))
    return (
        _over_travel(plan, reference, traces),
        _over_time(plan, reference, traces, bands),
        _errors(plan, reference, traces),
    )


def _legs(plan: HoistPlan) -> Iterator[Band]:
    start = 0.0
    for leg in plan.trip.legs:
        if leg.duration:
            yield Band(leg.name, start, start + leg.duration)
        start += leg.duration


def _over_travel(plan: HoistPlan, reference: Trajectory, traces: dict[str, Trajectory]) -> Figure:
    """The likeness of the paper's figure 5, with the envelope."""
    unit, limits = plan.job.length_unit, plan.job.hoist
    first = next(iter(traces.values()))
    order = np.argsort(first["plantTravel"], kind="stable")
    lines = (
        line("reference", REFERENCE, reference["travel"], reference["velocity"]),
        *(line(name, TRACE, trace["plantTravel"], trace["limitedSetpoint"]) for name, trace in traces.items()),
        line("protection envelope", BOUND, first["plantTravel"][order], first["envelopeVelocity"][order]),
    )
    panel = Panel(f"speed, {unit}/s", lines, (Limit("max_velocity", limits.max_velocity),))
    return Figure("over-travel", "Speed over travel", f"travel, {unit}", (panel,))


def _over_time(
    plan: HoistPlan, reference: Trajectory, traces: dict[str, Trajectory], bands: tuple[Band, ...]
) -> Figure:
    unit, limits, time = plan.job.length_unit, plan.job.hoist, reference["time"]
    speed = [line("reference", REFERENCE, time, reference["velocity"])]
    acceleration = [line("reference", REFERENCE, time, reference["acceleration"])]
    for name, trace in traces.items():
        speed.append(line(name, TRACE, trace["time"], trace["limitedSetpoint"]))
        acceleration.append(line(name, TRACE, trace["time"], trace["acceleration"]))
    accelerations = (Limit("acceleration", limits.acceleration), Limit("deceleration", -limits.deceleration))
    jerk = (line("reference", REFERENCE, time, reference["jerk"], stepped=True),)
    panels = (
        Panel(f"speed, {unit}/s", tuple(speed), (Limit("max_velocity", limits.max_velocity),)),
        Panel(f"acceleration, {unit}/s2", tuple(acceleration), accelerations),
        Panel(f"jerk, {unit}/s3", jerk, both_ways("jerk", limits.jerk)),
    )
    return Figure("over-time", "The trip over time", TIME, panels, bands)


def _errors(plan: HoistPlan, reference: Trajectory, traces: dict[str, Trajectory]) -> Figure:
    """Over travel, as the law is: times of a law over travel drift apart by themselves."""
    unit = plan.job.length_unit
    panel = Panel(f"speed, {unit}/s", tuple(_error(name, trace, reference) for name, trace in traces.items()))
    note = "While the law over travel is in force: start and stop ramps go by time."
    return Figure("errors", "Setpoint less reference speed at the same travel", f"travel, {unit}", (panel,), note=note)


def _error(name: str, trace: Trajectory, reference: Trajectory) -> Line:
    by_law = np.isin(trace["phase"], BY_TRAVEL)
    travel, setpoint = trace["plantTravel"][by_law], trace["limitedSetpoint"][by_law]
    return line(name, OTHER, travel, setpoint - np.interp(travel, reference["travel"], reference["velocity"]))
