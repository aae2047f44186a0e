"""The bench of a hoist: makes rigs, runs trips, and remembers which rows of each trace are which."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf

import numpy as np

from plcgen.check.hoist_expectation import Segment
from plcgen.check.hoist_model import (
    ACCELERATE,
    CREEP_IN,
    DECELERATE,
    STANDSTILL,
    START_RAMP,
    STOP_RAMP,
    STOPPING,
    HoistModel,
)
from plcgen.check.rig import PERFECT, Clock, Encoder, Goal, Rig
from plcgen.plc.core import Program
from plcgen.trajectory import Trajectory

GARBAGE = 0x7F
"""Byte that fills temporaries before each call: REAL 3.39E38, INT 32639, BOOL TRUE."""


@dataclass(frozen=True)
class Bench:
    """The program under test, the names of its FB and instance DB, and the model it is held against.

    `temp_fill` fills what the block has not written, `function_error` is the relative error of EXP, LN and the like.
    """

    program: Program
    block: str
    instance: str
    model: HoistModel

    temp_fill: int = GARBAGE
    function_error: float = 0.0

    def rig(self, travel: float, clock: Clock | None = None, encoder: Encoder = PERFECT) -> Rig:
        """A cold CPU with the hoist at rest at a place. Only a period that differs from the job's is handed over."""
        clock = clock or Clock(self.model.sample_period)
        parts = (self.program, self.block, self.instance, travel, clock, encoder)
        rig = Rig(*parts, self.temp_fill, self.function_error)
        if clock.period != self.model.sample_period:
            rig.set(cycleTime=clock.period)
        return rig

    def scans(self, seconds: float) -> int:
        return int(seconds / self.model.sample_period) + 1

    @property
    def longest_trip(self) -> int:
        """Scans that no trip exceeds: a quarter more than the planned time, and the time of a stop."""
        return self.scans(1.25 * self.model.trip(self.model.limits.travel).reference.duration + 10)

    @property
    def longest_stop(self) -> int:
        """Scans that no stop exceeds, nor the stop ramp."""
        limits = self.model.limits
        stop = self.model.stop(limits.max_velocity, limits.acceleration).duration
        return self.scans(max(stop, self.model.trip(limits.travel).stop_time)) + 10


@dataclass
class Run:
    """One recorded run; `nominal` ones see the travel as it is, counted from the lower stop.

    `trips` and `stops` hold the first row of each, the row behind its last, and whether it goes up.
    """

    name: str
    encoder: Encoder
    clock: Clock
    travel_at_end: float = 0.0
    stop_place: float = 0.0
    trace: Trajectory = field(default_factory=lambda: Trajectory({}))
    trips: list[tuple[int, int, bool]] = field(default_factory=list)
    stops: list[tuple[int, int, bool]] = field(default_factory=list)
    faults: Sequence[object] = ()
    complete: bool = True
    nominal: bool = False

    @property
    def is_exact(self) -> bool:
        """A perfect encoder, an interrupt on time, one trip from stop to stop."""
        return self.encoder == PERFECT and not self.clock.jitter and len(self.trips) == 1

    @property
    def is_sound(self) -> bool:
        """Every part ended as it should, and every trip began with some way to go."""
        return self.complete and all(trip.to_go[0] > 0 for trip in self.segments(self.trips))

    def segments(self, spans: list[tuple[int, int, bool]]) -> list[Segment]:
        return [Segment(self.trace, *span) for span in spans]

    def finish(self, rig: Rig, stop_place: float) -> Run:
        self.trace, self.faults = rig.trace(), tuple(rig.machine.faults)
        self.travel_at_end, self.stop_place = rig.plant.travel, stop_place
        return self


RESTING = Goal(frozenset({STANDSTILL}))


def reached(phase: int) -> Goal:
    """A phase or a later one."""
    return Goal(frozenset(range(phase, STOPPING + 1)))


def full_trip(
    bench: Bench,
    name: str,
    up: bool,
    encoder: Encoder = PERFECT,
    clock: Clock | None = None,
    stops: tuple[float, float] | None = None,
    distance: float | None = None,
) -> Run:
    """From stop to stop, or over the last `distance`; the direction input is turned on the way, to no effect."""
    lower, upper = stops or (0.0, bench.model.limits.travel)
    distance = distance or upper - lower
    clock = clock or Clock(bench.model.sample_period)
    rig = bench.rig(upper - distance if up else lower + distance, clock, encoder)
    if stops:
        rig.set(lowerStop=lower, upperStop=upper)
    rig.set(directionUp=up)
    rig.scan()
    rig.set(enable=True)
    rig.scan()
    rig.set(directionUp=not up)
    run = Run(name, encoder, clock, nominal=stops is None and encoder == PERFECT and distance == upper - lower)
    run.complete = rig.run(bench.longest_trip, RESTING)
    run.trips.append((1, rig.scans, up))
    rig.set(directionUp=up)
    rig.run(3)
    return run.finish(rig, upper if up else lower)


def interrupted_trip(bench: Bench, name: str, up: bool, places: Sequence[float]) -> Run:
    """A trip with a stop request at each place, by `stop` and by `enable` in turn, each with a fresh start."""
    travel = bench.model.limits.travel
    clock = Clock(bench.model.sample_period)
    rig = bench.rig(0.0 if up else travel, clock)
    rig.set(directionUp=up)
    rig.scan()
    run = Run(name, rig.encoder, clock)
    for number, place in enumerate(places):
        _leg_of(bench, run, rig, up, place)
        run.complete &= not RESTING.is_met(rig)
        _interrupt(bench, run, rig, up, by_stop=number % 2 == 0)
        if _arrived(bench, rig):
            return run.finish(rig, rig.plant.travel)
    _leg_of(bench, run, rig, up, 2 * travel)
    run.complete &= RESTING.is_met(rig)
    rig.run(3)
    return run.finish(rig, travel if up else 0.0)


def _arrived(bench: Bench, rig: Rig) -> bool:
    """A stop request shortly before the stop may end at it: no further trip is possible, and none is due."""
    return abs(rig.get("distanceToGo")) <= bench.model.position_window


def _leg_of(bench: Bench, run: Run, rig: Rig, up: bool, place: float) -> None:
    """Start, and run until the place is passed or the hoist rests."""
    travel = bench.model.limits.travel
    rig.set(enable=True)
    first = rig.scans
    not_yet = (-inf, place) if up else (travel - place, inf)
    passed = Goal(RESTING.phases, frozenset(range(CREEP_IN + 1)), not_yet)
    run.complete &= rig.run(bench.longest_trip, passed)
    run.trips.append((first, rig.scans, up))


def _interrupt(bench: Bench, run: Run, rig: Rig, up: bool, by_stop: bool) -> None:
    first = rig.scans
    rig.set(**({"stop": True} if by_stop else {"enable": False}))
    run.complete &= rig.run(bench.longest_stop, RESTING)
    run.stops.append((first, rig.scans, up))
    # Releasing the stop must not start anything: that takes a fresh edge of enable.
    rig.set(stop=False)
    rig.run(3)
    run.complete &= RESTING.is_met(rig)
    rig.set(enable=False)
    rig.scan()


def turning_trip(bench: Bench, name: str) -> Run:
    """Up, stop on the way, and back down to where it came from."""
    clock = Clock(bench.model.sample_period)
    rig = bench.rig(0.0, clock)
    rig.set(directionUp=True)
    rig.scan()
    run = Run(name, rig.encoder, clock)
    _leg_of(bench, run, rig, True, 0.45 * bench.model.limits.travel)
    _interrupt(bench, run, rig, True, by_stop=True)
    rig.set(directionUp=False)
    rig.set(enable=True)
    first = rig.scans
    run.complete &= rig.run(bench.longest_trip, RESTING)
    run.trips.append((first, rig.scans, False))
    rig.run(3)
    return run.finish(rig, 0.0)


def stop_places(model: HoistModel) -> list[float]:
    """Places of travel for stop requests: in each leg, and three in both transitions."""
    reference = model.trip(model.limits.travel).reference
    motion = reference.at_time(np.linspace(0.0, reference.duration, 4001))
    places = []
    for leg in range(START_RAMP, STOP_RAMP):
        rows = np.flatnonzero(motion.leg == leg)
        shares = (0.2, 0.5, 0.8) if leg in (ACCELERATE, DECELERATE) else (0.5,)
        places += [float(motion.travel[rows[int(share * len(rows))]]) for share in shares if len(rows)]
    return places
