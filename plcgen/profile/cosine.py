"""Speed ramps of cosine shape behind a moving average (seed 003), centred: claim 3's speed polynomial about y = 0.

| letter | word                          | letter | word                                            |
|--------|-------------------------------|--------|-------------------------------------------------|
| v0, v1 | speed before and after a ramp | dv     | v1 - v0                                         |
| Ta     | duration of a ramp            | N      | its samples                                     |
| T      | sample period                 | n      | samples of the moving average                   |
| s(y)   | law from -1 to 1, see cosine_fit | y   | 2 k/N - 1 in sample k                           |
| c      | change of speed while the acceleration dies out | M | samples of that                    |

    v_k = (v0 + v1)/2 + dv/2 s(y)            a = dv s'(y)/Ta           j = 2 dv s''(y)/Ta^2
    V_k = (v_k + ... + v_(k-n+1))/n          done at k = N + n - 1

An order in mid-ramp lets the acceleration a die out first, by the second half of a ramp of its own, v + c s(k/M), with
a = c s'(0)/(M T) at its begin and M as small as the jerk allows; then a new ramp begins. Neither speed nor acceleration
jumps. Where that would pass the speed the ramp ends at, the ramp is let to its end.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import floor, log2, sqrt
from typing import ClassVar, Self

from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.profile.cosine_fit import CENTRED, Fit, Law, fit, peak

# A count is at least this share of full speed: twice what REAL makes of v_k, so that standstill is count 0.
FINEST_COUNT = 2.0**-21
# The sum of the moving average stays below half of what DINT holds.
LARGEST_SUM = 2.0**30
# Cycle times this many times shorter or longer than the job's are plausible.
CYCLE_RANGE = 10.0


def counts_per_unit(max_velocity: float, filter_length: int) -> float:
    """Power of two, so that scaling rounds nothing: speeds become DINT counts, and their sum is exact."""
    most = min(1.0 / FINEST_COUNT, LARGEST_SUM / filter_length)
    return 2.0 ** floor(log2(most / max_velocity))


@dataclass(frozen=True, eq=False)
class Limited:
    """A law, and the limits that its durations keep. Speeds and so on in the unit of the job."""

    LAW: ClassVar[Law]

    max_velocity: float
    max_acceleration: float
    jerk: float
    sample_period: float
    filter_length: int
    fit: Fit

    @classmethod
    def of(cls, job: Job) -> Self:
        keys = job.cosine
        law = fit(keys.fit, cls.LAW, keys.seed)
        return cls(keys.max_velocity, keys.max_acceleration, keys.jerk, job.sample_period, keys.filter_length, law)

    @property
    def counts(self) -> float:
        return counts_per_unit(self.max_velocity, self.filter_length)


@dataclass(frozen=True, eq=False)
class Ramps(Limited):
    """Ramps of a job, whatever the speeds."""

    LAW = CENTRED

    @cached_property
    def slope(self) -> float:
        """Largest s'(y): pi/2 for the cosine itself."""
        return peak(self.fit.repaired.deriv())

    @cached_property
    def curvature(self) -> float:
        """Largest s''(y): pi^2/4 for the cosine itself."""
        return peak(self.fit.repaired.deriv(2))

    @property
    def time_by_acceleration(self) -> float:
        """Ta/dv, s per unit of speed, that keeps the acceleration: a = dv s'/Ta."""
        return self.slope / self.max_acceleration

    @property
    def square_by_jerk(self) -> float:
        """Ta^2/dv that keeps the jerk: j = 2 dv s''/Ta^2."""
        return 2 * self.curvature / self.jerk

    @property
    def settle_time(self) -> float:
        """M T/a that keeps the jerk while the acceleration a dies out: j = c s''/(M T)^2, a = c s'(0)/(M T)."""
        return self.curvature / (self.fit.coefficients[0] * self.jerk)

    def ramp_time(self, change: float) -> float:
        """Shortest Ta for a change of speed."""
        return max(self.time_by_acceleration * abs(change), sqrt(self.square_by_jerk * abs(change)))


def cosine_constants(job: Job, ramps: Ramps) -> tuple[ConstantGroup, ...]:
    """Constants of the block in the order of its source."""
    speed = f"{job.length_unit}/s"
    d = ramps.fit.coefficients
    return (
        ConstantGroup(
            "Limits of the job",
            (
                Constant("MAX_VELOCITY", ramps.max_velocity, speed, "highest speed, either way"),
                Constant("MIN_CYCLE_TIME", job.sample_period / CYCLE_RANGE, "s", "shortest plausible cycle"),
                Constant("MAX_CYCLE_TIME", job.sample_period * CYCLE_RANGE, "s", "longest plausible cycle"),
            ),
        ),
        ConstantGroup(
            "Law of a ramp: s(y) = y (LAW_1 - y^2 (LAW_2 - y^2 (LAW_3 - y^2 LAW_4))), about sin(pi y/2)",
            (
                *(
                    Constant(f"LAW_{index}", value, "1", "coefficient of the law,", "claim 3")
                    for index, value in enumerate(d, start=1)
                ),
                Constant(
                    "TIME_BY_ACC", ramps.time_by_acceleration, f"s per {speed}", "Ta/dv that keeps the acceleration"
                ),
                Constant("SQUARE_BY_JERK", ramps.square_by_jerk, f"s2 per {speed}", "Ta^2/dv that keeps the jerk"),
                Constant("SETTLE_TIME", ramps.settle_time, f"s per {speed}2", "to end an acceleration, by the jerk"),
            ),
        ),
        average_constants(job, ramps.counts),
    )


def average_constants(job: Job, counts: float) -> ConstantGroup:
    """Of the moving average, whatever the shape."""
    speed, length = f"{job.length_unit}/s", job.cosine.filter_length
    return ConstantGroup(
        "Moving average",
        (
            Constant("COUNTS", counts, f"1/({speed})", "counts for a unit of speed, a power of two"),
            Constant("COUNT_VALUE", 1 / (length * counts), speed, "what a count adds to the average"),
            Constant("COUNT_SPEED", 1 / counts, speed, "speeds nearer than this are one"),
        ),
    )
