"""The way of a job through the house: derive, render, parse, run, compare."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from plcgen import targets
from plcgen.check.hoist import Subject, nominal_trace, verify_hoist
from plcgen.check.hoist_model import HoistModel, TripModel
from plcgen.check.verdict import TargetVerdict
from plcgen.job import Job
from plcgen.plc.core import Program
from plcgen.plc.scl.dialects import CLASSIC, TIA
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import Block
from plcgen.plc.source import decode_source
from plcgen.profile.constants import ConstantGroup
from plcgen.profile.hoist import Leg, Trip, creeping_travel, plan_stop, plan_trip
from plcgen.profile.hoist_constants import hoist_constants, transition_table
from plcgen.profile.hoist_rules import derive, position_window
from plcgen.render.environment import render
from plcgen.render.hoist import block_names, hoist_context, output_files
from plcgen.trajectory import Trajectory

DIALECTS = {dialect.name: dialect for dialect in (CLASSIC, TIA)}
MILLIMETRES = {"m": 0.001, "cm": 0.1, "mm": 1.0}


@dataclass(frozen=True)
class Plan:
    """A job with what was derived from it."""

    job: Job
    trip: Trip


@dataclass(frozen=True)
class Derivation:
    """What `plcgen derive` shows."""

    legs: tuple[Leg, ...]
    tables: tuple[ConstantGroup, ...]


def prepare(job: Job) -> Plan:
    """Raises JobError where the limits of the job cannot be met."""
    return Plan(job, derive(job))


def derivation(plan: Plan) -> Derivation:
    """Legs of the trip, every quantity of the transitions, and the constants of the source."""
    names = ("Start ramp", "Acceleration", "Deceleration", "Stop ramp")
    transitions = tuple(
        ConstantGroup(name, transition_table(transition, plan.job.length_unit))
        for name, transition in zip(names, plan.trip.transitions, strict=True)
    )
    return Derivation(plan.trip.legs, transitions + hoist_constants(plan.job, plan.trip))


def sources(plan: Plan, target: str, verified: bool = True) -> dict[str, bytes]:
    """Files of a target by name, encoded as its engineering tool reads them."""
    row = targets.target(target)
    context = hoist_context(plan.job, plan.trip, target, verified)
    files = {}
    for file in output_files(plan.job, target):
        text = render(f"{row.folder}/{plan.job.method}/{file.template}", context)
        encoding = "utf-8" if file.name.endswith(".md") else row.encoding
        files[file.name] = text.replace("\n", row.newline).encode(encoding)
    return files


def load(target: str, files: Mapping[str, bytes]) -> Program:
    """Parse and lower every source file of a target. Raises SourceError."""
    row = targets.target(target)
    dialect = DIALECTS[row.dialect]
    blocks: list[Block] = []
    # The blocks come before the example that calls them.
    for name in sorted(
        (name for name in files if name.endswith(row.suffix)), key=lambda name: ("_example" in name, name)
    ):
        blocks.extend(parse(decode_source(name, files[name]), dialect))
    return lower(blocks, dialect)


def subject(plan: Plan, target: str, files: Mapping[str, bytes]) -> Subject:
    """The program and the names under which verification finds its block and instance."""
    names = block_names(plan.job, target)
    return Subject(load(target, files), names.fb.strip('"'), names.db.strip('"'), hoist_model(plan))


def verify(
    plan: Plan,
    target: str,
    files: Mapping[str, bytes],
    progress: Callable[[str], None] | None = None,
    fail_fast: bool = False,
) -> TargetVerdict:
    """Execute the sources and hold them against the reference."""
    return verify_hoist(subject(plan, target, files), progress, fail_fast)


def reference(plan: Plan) -> Trajectory:
    """The nominal trip in float64, sampled with the period of the job."""
    return plan.trip.reference.sample(plan.job.sample_period)


def golden_trace(plan: Plan, target: str, files: Mapping[str, bytes]) -> Trajectory:
    """What the sources do on the nominal trip upwards."""
    return nominal_trace(subject(plan, target, files))


def hoist_model(plan: Plan) -> HoistModel:
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
        millimetre=MILLIMETRES[plan.job.length_unit],
        steepest_gain=max(trip.acceleration.steepest_gain, trip.deceleration.steepest_gain),
        shortest_jerk_time=trip.shortest_jerk_time,
        position_window=position_window(plan.job),
        min_travel=creeping_travel(limits),
        trip=lambda distance: _trip_model(plan_trip(reached, distance)),
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
