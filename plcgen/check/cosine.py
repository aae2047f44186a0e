"""Verification of a block of the method `cosine`: it is executed through every order the job can bring."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from random import Random

import numpy as np

from plcgen.check.cosine_commands import commands
from plcgen.check.cosine_model import Axis, Command, CosineModel, MoveModel, Ramp, RampModel
from plcgen.check.cosine_run import Run, likeliest, run_checks
from plcgen.check.verdict import Check, TargetVerdict, nearer
from plcgen.plc.script import Step
from plcgen.trajectory import Trajectory

RANDOM_ORDERS = 10_000
MOST_RANDOM_SAMPLES = 300_000
"""Random moves, which wait for each other, end here if the moving average is long."""
REST_EVERY = 1_000
"""Random orders between two stops, after each of which the setpoint must be zero to the last bit."""
TRACE_COLUMNS = ("velocitySetpoint", "acceleration", "busy", "done", "steady", "standstill", "status")
COARSE = 5.0
"""Orders in mid-ramp are run at a longer cycle than the job's: the same law in fewer samples."""
SHORT = 0.2
"""At a shorter cycle a wrong duration shows in the number of samples."""


@dataclass(frozen=True)
class Subject:
    """What is verified: how to make a fresh block with its memory, and the model to hold it against."""

    make: Callable[[], Axis]
    model: RampModel | MoveModel


def verify_cosine(
    subject: Subject, progress: Callable[[str], None] | None = None, fail_fast: bool = False
) -> TargetVerdict:
    """All checks, each with the figure that comes nearest to its bound and the names of the runs that miss it.

    With `fail_fast` it ends after the first run in which a check fails.
    """
    worst: dict[str, Check] = {}
    # A faulty block may hand over infinity; a NaN fails its check.
    with np.errstate(invalid="ignore", over="ignore"):
        for name, checks in _situations(subject, progress or (lambda _text: None)):
            for check in checks:
                told = check if check.ok else replace(check, detail=check.detail or name)
                worst[check.name] = nearer(worst[check.name], told) if check.name in worst else told
            if fail_fast and not all(check.ok for check in worst.values()):
                break
    return TargetVerdict(tuple(worst.values()))


def nominal_trace(subject: Subject) -> Trajectory:
    """The moves of the job one after another."""
    parts = []
    for number, run in enumerate(_nominal(subject), start=1):
        count = len(run.trace)
        columns = {"move": np.full(count, number), "sample": np.arange(count)}
        parts.append(columns | {name: run.trace[name] for name in TRACE_COLUMNS})
    return Trajectory({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})


def _situations(subject: Subject, progress: Callable[[str], None]) -> Iterator[tuple[str, Iterable[Check]]]:
    for run in _nominal(subject):
        progress(run.name)
        yield run.name, run_checks(run)
    progress("commands")
    told = [answer for answer in commands(subject.make, subject.model) if answer]
    yield "commands", [Check("wrong_answers", float(len(told)), 0.0, "1", detail="; ".join(told))]
    runs = _ramp_runs(subject) if isinstance(subject.model, RampModel) else _move_runs(subject)
    for run in runs:
        progress(run.name)
        yield run.name, run_checks(run)
    progress(f"{RANDOM_ORDERS} random orders")
    yield "random orders", [_standstill(subject)]


def _nominal(subject: Subject) -> Iterator[Run]:
    model = subject.model
    if isinstance(model, RampModel):
        for number, ramp in enumerate(model.ramps, start=1):
            yield replace(_job_ramp(subject, model, ramp, f"move {number}"), is_single=ramp.then is None)
    else:
        for number, distance in enumerate(model.distances, start=1):
            yield replace(_move(subject, model, f"move {number}", distance), is_single=True)


# ----------------------------------------------------------------------------------------------------------- ramps


def _job_ramp(subject: Subject, model: RampModel, ramp: Ramp, name: str) -> Run:
    orders = [Command(0, ramp.end)]
    if ramp.then is not None:
        orders.append(Command(max(2, round(ramp.after / model.sample_period)), ramp.then))
    return ramp_run(subject, model, name, ramp.start, orders)


def ramp_run(
    subject: Subject,
    model: RampModel,
    name: str,
    start: float,
    orders: Sequence[Command],
    cycle: float | None = None,
    worn: bool = True,
) -> Run:
    """From a steady speed, which the block takes over, through the orders to rest or to a steady speed.

    A `worn` block has had other orders before. One that is not, and begins at rest, gets no restart either.
    """
    cycle = cycle or model.sample_period
    speeds = [start, *(order.velocity or 0.0 for order in orders)]
    changes = [abs(b - a) for a, b in pairwise(speeds)] + [2 * max(map(abs, speeds))]
    # A ramp that is let to its end, a law that dies out, and a ramp for each order, at the most.
    longest = model.samples(max(changes), cycle)
    count = orders[-1].sample + 2 * longest + model.filter_length + 10
    axis = subject.make()
    if worn:
        _wear(axis, model, targetVelocity=-0.7 * model.max_velocity)
        _wear(axis, model, targetVelocity=0.3 * model.max_velocity)
    if worn or start:
        _restart(axis, actualVelocity=start)
    trace = _drive(axis, model, orders, count, cycle)
    motion = likeliest(trace, model.possible(start, tuple(orders), count, cycle))
    ordered = frozenset(order.sample for order in orders if order.velocity is not None)
    return Run(name, model, start, trace, motion, ordered, cycle, len(axis.faults))


def _drive(axis: Axis, model: RampModel, orders: Sequence[Command], count: int, cycle: float) -> Trajectory:
    """A sample without an order, and then the orders."""
    if cycle != model.sample_period:  # else the block knows it
        axis.set(cycleTime=cycle)
    axis.scan()
    by_sample: dict[int, list[Command]] = {}
    for order in orders:
        by_sample.setdefault(order.sample, []).append(order)
    changes = {0, *by_sample, *(sample + 1 for sample in by_sample)}
    for sample, following in pairwise(sorted(change for change in changes | {count} if change <= count)):
        if sample - 1 in by_sample or sample == 0:
            axis.set(execute=False, stop=False)
        for order in by_sample.get(sample, ()):
            _command(axis, order)
        axis.samples(following - sample)
    trace = axis.trace()
    return trace.rows(np.arange(len(trace) - count, len(trace)))


def _wear(axis: Axis, model: CosineModel, **order: float) -> None:
    """Samples of an order, more than the average remembers."""
    axis.set(execute=False, **order)
    axis.scan()
    axis.set(execute=True)
    axis.samples(model.filter_length + 2)


def _restart(axis: Axis, **inputs: float) -> None:
    axis.set(restart=True, execute=False, **inputs)
    axis.scan()
    axis.set(restart=False)


def _command(axis: Axis, order: Command) -> None:
    if order.velocity is not None:
        axis.set(execute=True, targetVelocity=order.velocity)
    if order.hold is not None:
        axis.set(hold=order.hold)
    if order.rest:
        axis.set(stop=True)


def _ramp_runs(subject: Subject) -> Iterator[Run]:
    """Orders in mid-ramp of the longest ramp of the job, and ramps that the job may not have."""
    model = subject.model
    assert isinstance(model, RampModel)
    top = model.max_velocity
    longest = max(model.ramps, key=lambda ramp: abs(ramp.end - ramp.start))
    start, end = (longest.start, longest.end) if longest.start != longest.end else (0.0, top)
    cycle = COARSE * model.sample_period
    for name, first, last in (
        ("up and down over the whole range", -top, top),
        ("to the same speed", end, end),
        ("a count", 0.0, 1.5 * model.count),
        ("two counts down to zero", 2 * model.count, 0.0),
        ("a hundredth", 0.5 * top, 0.51 * top),
    ):
        yield ramp_run(subject, model, name, _real(first), [Command(0, _real(last))], cycle)
    short = SHORT * model.sample_period
    yield ramp_run(subject, model, "shorter cycle", start, [Command(0, end)], short)
    at = max(2, round(0.4 * model.samples(abs(end - start), short)))
    yield ramp_run(subject, model, "order at a shorter cycle", start, [Command(0, end), Command(at, start)], short)
    yield ramp_run(subject, model, "stop before any order", _real(0.9 * top), [Command(0, rest=True)], worn=False)
    yield ramp_run(subject, model, "cold start", 0.0, [Command(0, _real(0.4 * top))], worn=False)
    for name, orders in _interruptions(model, start, end, cycle):
        yield ramp_run(subject, model, name, start, orders, cycle)
    # With all signs turned: what a block forgets of one way, such as an absolute value, shows near the end.
    late = max(2, round(0.83 * model.samples(abs(end - start), cycle)))
    for name, order in (("back", Command(late, -start)), ("stop", Command(late, rest=True))):
        yield ramp_run(subject, model, f"the other way, {name}", -start, [Command(0, -end), order], cycle)


def _interruptions(model: RampModel, start: float, end: float, cycle: float) -> Iterator[tuple[str, list[Command]]]:
    samples = model.samples(abs(end - start), cycle)
    others = {"back": start, "on": end + 0.3 * (end - start), "rest": 0.0, "reverse": -end}
    top = model.max_velocity
    within = {name: _real(min(max(speed, -top), top)) for name, speed in others.items()}
    go = Command(0, end)
    for share in (0.07, 0.28, 0.46, 0.61, 0.83, 0.96):
        at = max(2, round(share * samples))
        for name, speed in within.items():
            yield f"{name} at {share:.0%}", [go, Command(at, speed)]
        yield f"the same at {share:.0%}", [go, Command(at, end)]
        yield f"nearly the same at {share:.0%}", [go, Command(at, _real(end - np.copysign(0.4 * model.count, end)))]
        yield f"stop at {share:.0%}", [go, Command(at, rest=True)]
        yield f"hold at {share:.0%}", [go, Command(at, hold=True), Command(at + samples, hold=False)]
        yield f"two orders at {share:.0%}", [go, Command(at, within["back"]), Command(at + 3, within["on"])]
    half = max(2, samples // 2 + 1)
    yield "stop while held", [go, Command(half, hold=True), Command(half + 2, rest=True)]
    yield "order while held", [go, Command(half, hold=True), Command(half + 2, start), Command(half + 9, hold=False)]
    yield "hold before the order", [Command(0, hold=True), Command(1, end), Command(7, hold=False)]
    yield "hold and go on at once", [go, Command(half, hold=True), Command(half + 2, hold=False)]
    yield "order after a stop", [go, Command(half, rest=True), Command(half + 2, end)]


def _real(value: float) -> float:
    """What a REAL holds of it."""
    return float(np.float32(value))


# ----------------------------------------------------------------------------------------------------------- moves


def _move(
    subject: Subject,
    model: MoveModel,
    name: str,
    distance: float,
    stop_at: int | None = None,
    cycle: float | None = None,
) -> Run:
    cycle = cycle or model.sample_period
    count = 2 * model.samples(distance, cycle) + 2 * model.filter_length + 10
    axis = subject.make()
    _wear(axis, model, distance=-max(map(abs, model.distances)))
    _restart(axis)
    if cycle != model.sample_period:  # else the block knows it
        axis.set(cycleTime=cycle)
    axis.scan()
    stops = set() if stop_at is None else {stop_at, stop_at + 1}
    for sample, following in pairwise(sorted({0, 1, *stops, count})):
        if sample < 2:
            axis.set(execute=sample == 0, distance=distance)
        if sample in stops:
            axis.set(stop=sample == stop_at)
        axis.samples(following - sample)
    trace = axis.trace()
    trace = trace.rows(np.arange(len(trace) - count, len(trace)))
    motion = likeliest(trace, model.possible(distance, count, stop_at, cycle))
    return Run(name, model, 0.0, trace, motion, frozenset({0}), cycle, len(axis.faults))


def _move_runs(subject: Subject) -> Iterator[Run]:
    """Short and long moves both ways, and stops in both halves."""
    model = subject.model
    assert isinstance(model, MoveModel)
    longest = max(map(abs, model.distances))
    cycle = COARSE * model.sample_period
    for share in (-1.0, 0.3, -0.03, 0.001):
        distance = _real(share * longest)
        if abs(distance) > model.min_distance:
            yield _move(subject, model, f"distance {distance:.4g} {model.unit}", distance, cycle=cycle)
    for distance, cycle_time in model.telling:
        name = f"{distance:.4g} {model.unit} at {cycle_time:g} s"
        yield _move(subject, model, name, distance, cycle=cycle_time)
        turn = model.turn(distance, cycle_time)
        for at in (at for at in (turn, turn + 1) if at):
            yield _move(subject, model, f"{name}, stop after {at}", distance, at, cycle_time)
    if distance := _in_few_samples(model, 10 * model.sample_period):
        yield _move(subject, model, "a few samples", distance, cycle=10 * model.sample_period * (1 - 1e-6))
    for way in (longest, -_real(0.2 * longest)):
        samples = model.samples(way, cycle)
        for at in sorted({1, 2, samples // 5, samples // 3, samples // 2, (samples + 1) // 2, samples - 2}):
            if 0 < at < samples:
                yield _move(subject, model, f"{way:.4g} {model.unit}, stop after {at} of {samples}", way, at, cycle)


def _in_few_samples(model: MoveModel, cycle: float) -> float:
    """A distance that takes four samples or less; 0 where there is none."""
    distance = max(map(abs, model.distances))
    while model.samples(distance, cycle) > 4:
        distance *= 0.7
    return _real(distance) if distance > model.min_distance else 0.0


# ---------------------------------------------------------------------------------------------------------- random


def _standstill(subject: Subject) -> Check:
    """Counts of samples at which the setpoint, after a stop that follows a thousand random orders, is not exactly zero.

    Nothing may add up: an order comes before the one before it is done, or waits until it is.
    """
    model, axis = subject.model, subject.make()
    axis.set(cycleTime=10 * model.sample_period)
    axis.scan()
    wrong = 0
    for steps in _random_orders(model):
        axis.play(steps)
        wrong += not _comes_to_rest(axis, model)
    return Check("standstill_not_exact", float(wrong), 0.0, "1")


@lru_cache(maxsize=1)
def _random_orders(model: CosineModel) -> list[list[Step]]:
    """Orders from one stop to the next: the same for every target."""
    random, count, size = Random(1), RANDOM_ORDERS, REST_EVERY
    if isinstance(model, MoveModel):
        count, size = min(count, MOST_RANDOM_SAMPLES // (2 * model.filter_length + 20)), 1
    return [[step for _ in range(size) for step in _random_order(model, random)] for _ in range(count // size)]


def _random_order(model: CosineModel, random: Random) -> Iterator[Step]:
    """Given in one sample, and followed by some more."""
    if isinstance(model, MoveModel):
        # Most are so short that they end by themselves.
        size = model.min_distance * (max(map(abs, model.distances)) / model.min_distance) ** (0.6 * random.random())
        order = {"distance": _real(random.choice((-1, 1)) * size)}
    else:
        share = random.uniform(-1, 1) * 10.0 ** random.uniform(-5, 0)
        order = {"targetVelocity": _real(model.max_velocity * share)}
    yield {"execute": True, **order}, 1
    yield {"execute": False}, random.randrange(1, 20)


def _comes_to_rest(axis: Axis, model: CosineModel) -> bool:
    """A stop, and no longer; `samples` of the largest change, twice, are enough."""
    axis.set(stop=True)
    cycle = 10 * model.sample_period
    if isinstance(model, RampModel):
        enough = 3 * model.samples(2 * model.max_velocity, cycle)
    else:
        assert isinstance(model, MoveModel)
        enough = 2 * model.samples(max(map(abs, model.distances)), cycle)
    axis.samples(enough + 2 * model.filter_length, until="standstill")
    axis.set(stop=False)
    return bool(axis.get("standstill")) and axis.get("velocitySetpoint") == 0.0
