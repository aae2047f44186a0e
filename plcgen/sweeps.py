"""Random moves of a two-axis job by the thousand, shared out to the cores: does any of them lose a pulse?"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import exp, log
from random import Random

from plcgen.check.two_axis_rig import Subject
from plcgen.check.two_axis_sweep import Order, Sweep, sweep
from plcgen.errors import PlcgenError
from plcgen.job import Job, parse_job
from plcgen.jobfile_two_axis import Move
from plcgen.plan_two_axis import TwoAxisPlan
from plcgen.processes import in_processes
from plcgen.profile.two_axis import full_distance, limits_of, ordered, pulses_of

TARGET = "s7-200-smart"
SHARE = 250
"""Moves that a process runs on one CPU."""
REACH = 2.0
"""The longest move, in distances that reach full speed."""


def random_orders(job: Job, seed: str, count: int) -> Iterator[Order]:
    """Distances from the shortest that counts, spread evenly over their orders of magnitude, in all directions.

    The other axis goes as far, not at all, or anything between.
    """
    random, keys = Random(seed), job.two_axis
    longest = REACH * full_distance(limits_of(keys))
    shortest = max(1, keys.ignore_below) / max(keys.pulses_per_unit)
    for _ in range(count):
        way = _magnitude(random, shortest, longest)
        pair = [way, way * random.choice([0.0, 1.0, _magnitude(random, 1e-3, 1.0), random.random()])]
        random.shuffle(pair)
        x, y = (distance * random.choice([1, -1]) for distance in pair)
        yield _order(job, Move.model_construct(x=x, y=y))


def _magnitude(random: Random, low: float, high: float) -> float:
    return exp(random.uniform(log(low), log(high)))


def _order(job: Job, move: Move) -> Order:
    due = pulses_of(job.two_axis, move)
    return Order(ordered(job.two_axis, move), (due.x, due.y))


def run_sweep(job: Job, moves: int, seed: int) -> Iterator[Sweep]:
    """The sum so far, each time a share is done. The same for a seed, however many processes there are.

    Raises PlcgenError for another method.
    """
    if job.method != "two-axis":
        raise PlcgenError(f'sweep runs moves of method "two-axis"; the job has "{job.method}"')
    shares = [min(SHARE, moves - first) for first in range(0, moves, SHARE)]
    names = [f"{seed}:{number}" for number in range(len(shares))]
    total = Sweep()
    for found in in_processes(_share, [job.text.text] * len(shares), [job.text.name] * len(shares), names, shares):
        total += found
        yield total


def _share(text: str, file: str, seed: str, count: int) -> Sweep:
    job, subject = _subject(text, file)
    return sweep(subject, random_orders(job, seed, count))


@lru_cache(maxsize=1)
def _subject(text: str, file: str) -> tuple[Job, Subject]:
    """Once in a process."""
    plan = TwoAxisPlan.of(parse_job(text, file))
    return plan.job, plan.subject(plan.sources(TARGET))
