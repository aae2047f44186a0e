"""The method `cosine`: derive, render, parse, run, compare."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from plcgen.check.cosine_model import Axis, Command, CosineModel, Motion, MoveModel, Ramp, RampModel
from plcgen.check.verdict import Check, TargetVerdict
from plcgen.job import Job
from plcgen.jobfile_cosine import CENTRED
from plcgen.loading import load, load_smart, smart_sources
from plcgen.plan import Comparison, Derivation, Files, Plan, Progress, Stretch
from plcgen.profile.constants import ConstantGroup
from plcgen.profile.cosine import Ramps, cosine_constants
from plcgen.profile.cosine_comparison import comparisons
from plcgen.profile.cosine_motion import Motion as PlannedMotion
from plcgen.profile.cosine_motion import Order, follow, possible
from plcgen.profile.cosine_move import Moves, move_constants
from plcgen.profile.cosine_rules import derive_moves, derive_ramps
from plcgen.render import cosine, cosine_smart
from plcgen.render.cosine_memory import layout, memory_map, refuse_what_does_not_fit
from plcgen.render.files import OutputFile
from plcgen.targets import SMART
from plcgen.trajectory import Trajectory

if TYPE_CHECKING:
    from plcgen.check.cosine import Subject


TELLING_CYCLES = (1.0, 0.2, 5.0)
"""Of the sample period: at some of them each limit decides on the duration of a move."""
MOST_KEPT = 256
"""References of runs."""
GARBAGE = (0x7F, 0x00)
"""Bytes that fill temporaries before each call: a large REAL or nothing, one after the other with each fresh block."""


def prepare(job: Job) -> CosinePlan:
    """Raises JobError where the limits of the job cannot be met or its memory does not fit."""
    if SMART.name in job.targets:
        refuse_what_does_not_fit(job)
    if job.cosine.shape == CENTRED:
        return RampPlan(job, derive_ramps(job))
    return MovePlan(job, derive_moves(job))


@dataclass(frozen=True)
class CosinePlan(Plan):
    """What both shapes share."""

    @property
    @abstractmethod
    def constants(self) -> tuple[ConstantGroup, ...]: ...

    @cached_property
    def model(self) -> RampModel | MoveModel:
        """The references that the checks ask for: the same for all targets, which mostly ask for the same ones."""
        return self._model()

    @abstractmethod
    def _model(self) -> RampModel | MoveModel: ...

    @abstractmethod
    def stretches(self) -> Iterator[Stretch]: ...

    @abstractmethod
    def nominal(self) -> Iterator[PlannedMotion]:
        """The moves of the job in float64."""

    def derivation(self) -> Derivation:
        """The moves of the job, the constants of the source, and the fits side by side."""
        return Derivation(tuple(self.stretches()), self.constants, tuple(_comparisons(self.job)))

    def outputs(self, target: str) -> tuple[OutputFile, ...]:
        return cosine_smart.output_files(self.job) if target == SMART.name else cosine.output_files(self.job, target)

    def context(self, target: str, verified: bool) -> dict[str, object]:
        if target == SMART.name:
            return cosine_smart.cosine_smart_context(self.job, self.constants, verified)
        return cosine.cosine_context(self.job, self.constants, target, verified)

    def verify(
        self, target: str, files: Files, progress: Progress | None = None, fail_fast: bool = False
    ) -> TargetVerdict:
        from plcgen.check.cosine import verify_cosine

        found = verify_cosine(self.subject(target, files), progress, fail_fast)
        return TargetVerdict((*self._imported(target, files), *found.checks))

    def _imported(self, target: str, files: Files) -> tuple[Check, ...]:
        from plcgen.check.imported import import_check

        return (import_check(smart_sources(files)),) if target == SMART.name else ()

    def golden_trace(self, target: str, files: Files) -> Trajectory:
        from plcgen.check.cosine import nominal_trace

        return nominal_trace(self.subject(target, files))

    def subject(self, target: str, files: Files) -> Subject:
        from plcgen.check.cosine import Subject

        return Subject(self._smart(files) if target == SMART.name else self._s7(target, files), self.model)

    def _smart(self, files: Files) -> Callable[[], Axis]:
        """V memory may be retained over a loss of power, and is as worn as the temporaries."""
        from plcgen.check.cosine_smart_rig import SmartAxis

        program, addresses, job = load_smart(self.job.name, files), memory_map(self.job), self.job
        fills = cycle(GARBAGE)

        def fresh() -> SmartAxis:
            fill = next(fills)
            return SmartAxis(program, addresses, job.sample_period, job.cosine.shape, fill, retained=fill)

        return fresh

    def _s7(self, target: str, files: Files) -> Callable[[], Axis]:
        from plcgen.check.cosine_s7_rig import S7Axis

        program, names = load(target, files), cosine.block_names(self.job, target)
        fb, db = (name.strip('"').replace(" ", "") for name in (names.fb, names.db))
        fills = cycle(GARBAGE)
        return lambda: S7Axis(program, fb, db, next(fills))

    def reserved_bytes(self, target: str) -> int:
        return layout(self.job).bytes if target == SMART.name else 0

    def reference(self) -> Trajectory:
        """The moves one after another: speed before and after the average, and its acceleration and jerk."""
        period = self.job.sample_period
        parts = [_columns(number, motion, period) for number, motion in enumerate(self.nominal(), start=1)]
        return Trajectory({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def _columns(number: int, motion: PlannedMotion, period: float) -> dict[str, np.ndarray]:
    acceleration = np.diff(motion.average, prepend=motion.start) / period
    count = len(motion.average)
    return {
        "move": np.full(count, number),
        "sample": np.arange(count),
        "raw_velocity": motion.raw,
        "velocity": motion.average,
        "acceleration": acceleration,
        "jerk": np.diff(acceleration, prepend=0.0) / period,
    }


def _real(value: float) -> float:
    """What a REAL holds of an input."""
    return float(np.float32(value))


def _comparisons(job: Job) -> Iterator[Comparison]:
    for title, headings, rows in comparisons(job.cosine.seed):
        yield Comparison(title, headings, rows)


@dataclass(frozen=True)
class RampPlan(CosinePlan):
    """A job of ramps between any speeds."""

    ramps: Ramps

    @property
    def constants(self) -> tuple[ConstantGroup, ...]:
        return cosine_constants(self.job, self.ramps)

    def stretches(self) -> Iterator[Stretch]:
        period = self.job.sample_period
        for number, motion in enumerate(self.nominal(), start=1):
            count = int(np.argmax(motion.done)) + 1
            travel = float(np.sum(motion.average[:count])) * period
            yield Stretch(f"move {number}", count * period, travel, float(motion.raw[-1]))

    def nominal(self) -> Iterator[PlannedMotion]:
        for ramp in _ramps(self.job):
            orders = [Order(0, ramp.end)]
            if ramp.then is not None:
                orders.append(Order(max(2, round(ramp.after / self.job.sample_period)), ramp.then))
            count = orders[-1].sample + 3 * self._samples(2 * self.ramps.max_velocity, self.job.sample_period)
            motion = follow(self.ramps, ramp.start, orders, count + self.ramps.filter_length)
            end = int(np.flatnonzero(motion.done)[-1]) + 1
            yield follow(self.ramps, ramp.start, orders, end)

    def _samples(self, change: float, cycle: float) -> int:
        return int(self.ramps.ramp_time(change) / cycle) + 2

    def _model(self) -> RampModel:
        @lru_cache(maxsize=MOST_KEPT)
        def motions(start: float, commands: tuple[Command, ...], count: int, cycle: float) -> tuple[Motion, ...]:
            orders = [Order(c.sample, c.velocity, c.hold, c.rest) for c in commands]
            return tuple(possible(self.ramps, start, orders, count, cycle))

        return RampModel(
            **vars(_limits(self.job, self.ramps.counts)),
            ramps=tuple(_ramps(self.job)),
            samples=self._samples,
            possible=motions,
        )


def _ramps(job: Job) -> Iterator[Ramp]:
    for move in job.cosine.moves:
        assert move.from_velocity is not None and move.to_velocity is not None
        then = None if move.then_velocity is None else _real(move.then_velocity)
        yield Ramp(_real(move.from_velocity), _real(move.to_velocity), then, move.after or 0.0)


@dataclass(frozen=True)
class MovePlan(CosinePlan):
    """A job of moves over distances."""

    moves: Moves

    @property
    def constants(self) -> tuple[ConstantGroup, ...]:
        return move_constants(self.job, self.moves)

    def stretches(self) -> Iterator[Stretch]:
        for number, (distance, motion) in enumerate(zip(_distances(self.job), self.nominal(), strict=True), start=1):
            yield Stretch(f"move {number}", len(motion.raw) * self.job.sample_period, distance, 0.0)

    def nominal(self) -> Iterator[PlannedMotion]:
        for distance in _distances(self.job):
            samples = self.moves.samples(distance)[0]
            yield next(self.moves.possible(distance, samples + self.moves.filter_length - 1))

    def _model(self) -> MoveModel:
        distances = tuple(_distances(self.job))
        cycles = [share * self.job.sample_period for share in TELLING_CYCLES]
        telling = self.moves.telling(max(map(abs, distances)), cycles)
        return MoveModel(
            **vars(_limits(self.job, self.moves.counts)),
            distances=distances,
            telling=tuple((_real(distance), cycle) for distance, cycle in telling),
            min_distance=self.moves.min_distance,
            max_distance=self.moves.max_distance,
            samples=lambda distance, cycle: max(self.moves.samples(distance, cycle)),
            turn=self.moves.turn,
            possible=lru_cache(maxsize=MOST_KEPT)(lambda *move: tuple(self.moves.possible(*move))),
        )


def _distances(job: Job) -> Iterator[float]:
    for move in job.cosine.moves:
        assert move.distance is not None
        yield _real(move.distance)


def _limits(job: Job, counts: float) -> CosineModel:
    keys = job.cosine
    return CosineModel(
        unit=job.length_unit,
        sample_period=job.sample_period,
        filter_length=keys.filter_length,
        max_velocity=keys.max_velocity,
        max_acceleration=keys.max_acceleration,
        jerk=keys.jerk,
        count=1 / counts,
    )
