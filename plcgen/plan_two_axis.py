"""The method `two-axis`: derive, render, parse, run with the pulse outputs, compare."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from plcgen.check.two_axis_model import MoveModel, TwoAxisModel
from plcgen.check.verdict import TargetVerdict
from plcgen.job import Job
from plcgen.jobfile_two_axis import LONGEST_MOVE, Move
from plcgen.loading import load_smart, smart_sources
from plcgen.plan import Derivation, Files, Plan, Progress, Stretch
from plcgen.profile.reference import Reference
from plcgen.profile.seven_phase import time_optimal
from plcgen.profile.stop import stop_phases
from plcgen.profile.two_axis import (
    LONGEST_TABLE,
    SLOWEST_TABLE,
    TRAIN_SHARE,
    TwoAxisMove,
    full_distance,
    limits_of,
    ordered,
    two_axis_constants,
)
from plcgen.profile.two_axis_rules import derive
from plcgen.render.files import OutputFile
from plcgen.render.two_axis import output_files, two_axis_context
from plcgen.render.two_axis_memory import layout, memory_map, refuse_what_does_not_fit
from plcgen.trajectory import Trajectory

if TYPE_CHECKING:
    from plcgen.check.two_axis_rig import Subject


@dataclass(frozen=True)
class TwoAxisPlan(Plan):
    """A two-axis job and the moves that verification runs."""

    moves: tuple[TwoAxisMove, ...]

    @classmethod
    def of(cls, job: Job) -> TwoAxisPlan:
        """Raises JobError where the limits of the job cannot be met or its memory does not fit."""
        refuse_what_does_not_fit(job)
        return cls(job, derive(job))

    def derivation(self) -> Derivation:
        """The moves of the job as they are run, and the constants of the program."""
        stretches = tuple(
            Stretch(f"move {number} ({move.pulses.x}, {move.pulses.y})", move.profile.duration,
                    move.profile.distance, 0.0)
            for number, move in enumerate(self.moves, start=1)
        )  # fmt: skip
        return Derivation(stretches, two_axis_constants(self.job))

    def outputs(self, _target: str) -> tuple[OutputFile, ...]:
        return output_files(self.job)

    def context(self, _target: str, verified: bool) -> dict[str, object]:
        return two_axis_context(self.job, verified)

    def verify(
        self, _target: str, files: Files, progress: Progress | None = None, fail_fast: bool = False
    ) -> TargetVerdict:
        from plcgen.check.imported import import_check
        from plcgen.check.two_axis import verify_two_axis

        checks = (import_check(smart_sources(files)), *verify_two_axis(self.subject(files), progress, fail_fast).checks)
        return TargetVerdict(checks)

    def reserved_bytes(self, _target: str) -> int:
        return layout(self.job).bytes

    def reference(self) -> Trajectory:
        """The moves one after another: travel, speed and acceleration of the leading axis."""
        parts = [move.reference.sample(self.job.sample_period) for move in self.moves]
        names = list(parts[0].columns)
        columns = {name: np.concatenate([part[name] for part in parts]) for name in names}
        numbers = np.concatenate([np.full(len(part), number) for number, part in enumerate(parts)])
        return Trajectory({"move": numbers, **columns})

    def golden_trace(self, _target: str, files: Files) -> Trajectory:
        from plcgen.check.two_axis import nominal_trace

        return nominal_trace(self.subject(files))

    def subject(self, files: Files) -> Subject:
        from plcgen.check.two_axis_rig import Subject

        name = self.job.name
        return Subject(load_smart(name, files), two_axis_model(self), lambda: load_smart(name, files, timed=True))


def prepare(job: Job) -> TwoAxisPlan:
    """Raises JobError where the limits of the job cannot be met."""
    return TwoAxisPlan.of(job)


def two_axis_model(plan: TwoAxisPlan) -> TwoAxisModel:
    """The references that the checks ask for."""
    job, keys = plan.job, plan.job.two_axis

    return TwoAxisModel(
        sample_period=job.sample_period,
        addresses=memory_map(job),
        outputs=keys.outputs,
        directions=keys.direction_outputs,
        moves=tuple(_move_model(job, *pair) for pair in zip(keys.moves, plan.moves, strict=True)),
        train_share=TRAIN_SHARE,
        is_table=keys.mode == "table",
        refused=tuple(_impossible_in_a_table(job)) if keys.mode == "table" else (),
    )


def _impossible_in_a_table(job: Job) -> Iterator[tuple[str, tuple[int, int], int]]:
    """Orders at run time beyond what a table can hold: too long, or an axis that is too slow for whole Hz."""
    keys = job.two_axis
    fastest = keys.max_velocity * keys.pulses_per_unit[0]  # pulses/s
    too_long, long = round(1.01 * LONGEST_TABLE * fastest), round(LONGEST_TABLE / 2 * fastest)
    if too_long <= LONGEST_MOVE:
        yield "a move that takes too long", (too_long, 0), 5
    time = time_optimal(long / keys.pulses_per_unit[0], limits_of(keys)).duration
    few = max(1, keys.ignore_below)
    if few < 0.99 * SLOWEST_TABLE * time and time < LONGEST_TABLE and long <= LONGEST_MOVE:
        yield "y too slow", (-long, few), 6


def _move_model(job: Job, wanted: Move, move: TwoAxisMove) -> MoveModel:
    keys, pulses = job.two_axis, move.pulses
    ppu = keys.pulses_per_unit[0 if pulses.x_leads else 1]

    reach = move.profile.distance / full_distance(limits_of(keys))
    run = Reference(list(move.fastest.phases())) if keys.mode == "table" else move.reference

    def motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        at = run.at_time(np.clip(times, 0.0, run.duration))
        return at.travel * ppu, at.velocity * ppu, at.acceleration * ppu

    def stop(velocity: float, acceleration: float) -> Reference:
        phases = stop_phases(velocity, acceleration, keys.max_acceleration * ppu, keys.jerk * ppu, 0)
        return Reference(phases, velocity, acceleration)

    return MoveModel(
        ordered=ordered(keys, wanted),
        x=pulses.x,
        y=pulses.y,
        samples=move.samples,
        fastest=move.fastest.duration,
        motion=motion,
        stop=stop,
        velocity=keys.max_velocity * ppu,
        acceleration=keys.max_acceleration * ppu,
        jerk=keys.jerk * ppu,
        x_leads=pulses.x_leads,
        is_short=reach < 1 if abs(reach - 1) > 1e-6 else None,
        corners=tuple(np.cumsum([0.0, *(phase.duration for phase in move.profile.phases())]) / move.profile.duration),
    )
