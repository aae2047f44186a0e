"""The method `hoist`: derive, render, parse, run, compare."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np

from plcgen.check.hoist_model import HoistModel, TripModel
from plcgen.check.verdict import TargetVerdict
from plcgen.job import Job
from plcgen.loading import load
from plcgen.plan import Derivation, Files, Plan, Progress, Stretch
from plcgen.profile.constants import ConstantGroup
from plcgen.profile.hoist import Trip, creeping_travel, plan_stop, plan_trip
from plcgen.profile.hoist_constants import hoist_constants, transition_table
from plcgen.profile.hoist_rules import derive, encoder_step, position_window
from plcgen.render.files import OutputFile
from plcgen.render.hoist import block_names, hoist_context, output_files
from plcgen.trajectory import Trajectory

if TYPE_CHECKING:
    from plcgen.check.hoist import Subject


@dataclass(frozen=True)
class HoistPlan(Plan):
    """A hoist job and its trip from stop to stop."""

    trip: Trip

    @classmethod
    def of(cls, job: Job) -> HoistPlan:
        """Raises JobError where the limits of the job cannot be met."""
        return cls(job, derive(job))

    def derivation(self) -> Derivation:
        """Legs of the trip, every quantity of the transitions, and the constants of the source."""
        names = ("Start ramp", "Acceleration", "Deceleration", "Stop ramp")
        transitions = tuple(
            ConstantGroup(name, transition_table(transition, self.job.length_unit))
            for name, transition in zip(names, self.trip.transitions, strict=True)
        )
        legs = tuple(Stretch(leg.name, leg.duration, leg.travel, leg.end_velocity) for leg in self.trip.legs)
        return Derivation(legs, transitions + hoist_constants(self.job, self.trip), title="Trip")

    def outputs(self, target: str) -> tuple[OutputFile, ...]:
        return output_files(self.job, target)

    def context(self, target: str, verified: bool) -> dict[str, object]:
        return hoist_context(self.job, self.trip, target, verified)

    def verify(
        self, target: str, files: Files, progress: Progress | None = None, fail_fast: bool = False
    ) -> TargetVerdict:
        from plcgen.check.hoist import verify_hoist

        return verify_hoist(self.subject(target, files), progress, fail_fast)

    def reference(self) -> Trajectory:
        return self.trip.reference.sample(self.job.sample_period)

    def golden_trace(self, target: str, files: Files) -> Trajectory:
        """The trip upwards."""
        from plcgen.check.hoist import nominal_trace

        return nominal_trace(self.subject(target, files))

    def subject(self, target: str, files: Files) -> Subject:
        """The program and the names under which verification finds its block and instance."""
        from plcgen.check.hoist import Subject

        names = block_names(self.job, target)
        block, instance = (name.strip('"').replace(" ", "") for name in (names.fb, names.db))
        return Subject(load(target, files), block, instance, self.model)

    @cached_property
    def model(self) -> HoistModel:
        """The references that the checks ask for, the same for all targets."""
        return hoist_model(self)


def prepare(job: Job) -> HoistPlan:
    """Raises JobError where the limits of the job cannot be met."""
    return HoistPlan.of(job)


def hoist_model(plan: HoistPlan) -> HoistModel:
    """The references that the checks ask for."""
    limits, trip = plan.job.hoist, plan.trip
    # The block knows the speed that the job reaches, also where its stops are set farther apart.
    reached = limits.model_copy(update={"max_velocity": trip.cruise_velocity})

    def envelope(from_stop: np.ndarray, to_go: np.ndarray) -> np.ndarray:
        return trip.envelope.velocity(from_stop, to_go)

    return HoistModel(
        limits=limits,
        sample_period=plan.job.sample_period,
        unit=plan.job.length_unit,
        millimetre=encoder_step(plan.job),
        steepest_gain=max(trip.acceleration.steepest_gain, trip.deceleration.steepest_gain),
        shortest_jerk_time=trip.shortest_jerk_time,
        position_window=position_window(plan.job),
        min_travel=creeping_travel(limits),
        trip=cache(lambda distance: _trip_model(plan_trip(reached, distance))),
        stop=lambda velocity, acceleration: plan_stop(limits, velocity, acceleration),
        envelope=envelope,
    )


def _trip_model(trip: Trip) -> TripModel:
    return TripModel(
        reference=trip.reference,
        start_time=trip.start.duration,
        start_travel=trip.start.travel,
        stop_time=trip.stop.duration,
        stop_travel=trip.stop.travel,
        creep_velocity=trip.creep_velocity,
        cruise_velocity=trip.cruise_velocity,
        distance=trip.distance,
    )
