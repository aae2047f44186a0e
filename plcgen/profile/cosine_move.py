"""Moves of half-sine speed behind a moving average: claim 3 as written, v = -f' on 0 .. pi, rest to rest.

| letter | word                          | letter | word                                                        |
|--------|-------------------------------|--------|-------------------------------------------------------------|
| D      | distance                      | u(x)   | speed over its mean at the share x of the move: -f'(pi x) pi/2 |
| Tm     | duration, N samples of T      | W      | window of the average, n T                                  |

    v = D/Tm u(x)        a = D/Tm^2 u'(x)        j = D/Tm^3 u''(x)        u(x) = x (C1 - x^2 (C2 - x^2 (C3 - x^2 C4)))

The acceleration jumps by D/Tm^2 u'(0) at the begin, and by as much at the end: after the average its slope there is
that over W, 4.93 D/(Tm^2 W) for the cosine itself, and this is what must keep the jerk.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, sqrt

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.profile.cosine import CYCLE_RANGE, Limited, average_constants
from plcgen.profile.cosine_fit import HALF_SINE, peak
from plcgen.profile.cosine_motion import OPEN, RAMP, STEADY, Motion, averaged

Samples = NDArray[np.float64]

# At the shortest plausible cycle u((N - 1)/N) is still tens of times what REAL makes of its four terms.
MOST_SAMPLES = 2**16
# Of a move that tells whether a limit decides as it should: a hundredth of its duration is many samples.
TELLING_SAMPLES = 4000


@dataclass(frozen=True, eq=False)
class Moves(Limited):
    """Moves of a job, whatever the distance."""

    LAW = HALF_SINE

    @cached_property
    def speed(self) -> Polynomial:
        """u(x); its integral over the move is (f(0) - f(pi))/2 = 1."""
        return -self.fit.repaired.deriv() / 2

    @cached_property
    def coefficients(self) -> tuple[float, ...]:
        """C1..C4, whose signs alternate."""
        return tuple(float((-1.0) ** index * self.speed.coef[power]) for index, power in enumerate((1, 3, 5, 7)))

    @cached_property
    def slope(self) -> float:
        """Largest u', also where a stop in the first half runs down the other half, made as fast as the first was."""
        x = np.linspace(0.0, 0.5, 2001)[1:]
        unlike = float((self.speed(x) / self.speed(1 - x)).max())
        return peak(self.speed.deriv()) * max(1.0, unlike)

    @cached_property
    def time_by_velocity(self) -> float:
        """Tm/D that keeps the speed."""
        return peak(self.speed) / self.max_velocity

    @cached_property
    def square_by_acceleration(self) -> float:
        """Tm^2/D that keeps the acceleration."""
        return self.slope / self.max_acceleration

    @cached_property
    def cube_by_jump(self) -> float:
        """Tm^2 T/D that keeps the jerk at both ends, where the average spreads the jump over n T."""
        return self.slope / (self.filter_length * self.jerk)

    @cached_property
    def cube_by_jerk(self) -> float:
        """Tm^3/D that keeps the jerk in between."""
        return peak(self.speed.deriv(2)) / self.jerk

    @cached_property
    def sum_terms(self) -> tuple[float, ...]:
        """E1..E3: u summed over k/N is N + E1/N + E2/N^3 + E3/N^5, by Euler and Maclaurin; u'''''' is linear."""
        ends = [float(self.speed.deriv(order)(1.0) - self.speed.deriv(order)(0.0)) for order in (1, 3, 5)]
        return ends[0] / 12, -ends[1] / 720, ends[2] / 30240

    @property
    def min_distance(self) -> float:
        """A count of speed for a sample: what is shorter would vanish."""
        return self.sample_period / self.counts

    @property
    def max_distance(self) -> float:
        """What MOST_SAMPLES reach."""
        return self.longest((MOST_SAMPLES - 1) * self.sample_period)

    def durations(self, distance: float, period: float | None = None) -> tuple[float, ...]:
        """Shortest Tm by speed, by acceleration, by the jerk at the ends and by the jerk in between."""
        d = abs(distance)
        jump = sqrt(self.cube_by_jump * d / (period or self.sample_period))
        smooth = float((self.cube_by_jerk * d) ** (1 / 3))
        return self.time_by_velocity * d, sqrt(self.square_by_acceleration * d), jump, smooth

    def duration(self, distance: float, period: float | None = None) -> float:
        """Shortest Tm."""
        return max(self.durations(distance, period))

    def telling(self, longest: float, periods: Sequence[float]) -> Iterator[tuple[float, float]]:
        """For each limit that decides anywhere up to a distance: one with many samples, and the cycle time."""
        shortest = min(1e3 * self.min_distance, longest)
        pairs = [(float(d), period) for period in periods for d in np.geomspace(shortest, longest, 60)]
        for limit in range(4):
            decided = [pair for pair in pairs if int(np.argmax(self.durations(*pair))) == limit]
            fitting = [pair for pair in decided if max(self.samples(*pair)) <= TELLING_SAMPLES]
            if fitting:
                yield max(fitting, key=lambda pair: self.samples(*pair))

    def longest(self, duration: float) -> float:
        """Longest distance in a duration: the inverse of the shortest Tm."""
        return min(
            duration / self.time_by_velocity,
            duration**2 / self.square_by_acceleration,
            duration**2 * self.sample_period / self.cube_by_jump,
            duration**3 / self.cube_by_jerk,
        )

    def samples(self, distance: float, period: float | None = None) -> tuple[int, ...]:
        """N: whole samples and one more, which pays for the sum being less than the integral. REAL may come out on
        either side of a whole number: then both are named.
        """
        period = period or self.sample_period
        ratio = self.duration(distance, period) / period
        both = {ceil(ratio * (1 - OPEN)), ceil(ratio * (1 + OPEN))}
        return tuple(max(2, whole + 1) for whole in sorted(both))

    def speeds(self, distance: float, samples: int, period: float | None = None) -> Samples:
        """Of samples 1 .. N before the average. The sum over them is the distance itself."""
        u = self.speed(np.arange(1, samples + 1) / samples)
        u[-1] = 0.0
        return np.asarray(distance / (period or self.sample_period) * u / u.sum())

    def stopped(self, speeds: Samples, at: int) -> tuple[Samples, ...]:
        """The same where a stop is asked for after `at` samples: in the first half level for n samples, then down the
        other half, if that ends nearer than the move itself; both where REAL may come out on either side.
        """
        samples, x = len(speeds), at / len(speeds)
        share = float(self._share(np.array([x]), samples)[0])
        if 2 * at >= samples or share > 1 + OPEN:
            return (speeds,)
        rest = self.speed(np.arange(samples - at + 1, samples + 1) / samples)
        rest[-1] = 0.0
        down = speeds[at - 1] * rest / float(self.speed(1 - x))
        levelled = np.concatenate([speeds[:at], np.full(self.filter_length, speeds[at - 1]), down])
        return (levelled, speeds) if share > 1 - OPEN else (levelled,)

    def _share(self, x: Samples, samples: int) -> Samples:
        """Of the distance, until rest after a stop: there and back, and level for n samples."""
        return np.asarray(2 * self.speed.integ()(x) + self.speed(x) * self.filter_length / samples)

    def turn(self, distance: float, period: float | None = None) -> int:
        """The last sample in which a stop does not let the move go on to its end; 0 for none."""
        samples = self.samples(distance, period)[0]
        first_half = np.arange(1, (samples + 1) // 2)
        return int(np.sum(self._share(first_half / samples, samples) < 1))

    def possible(
        self, distance: float, count: int, stop_at: int | None = None, period: float | None = None
    ) -> Iterator[Motion]:
        """The move in `count` samples from its order on; two where N is open. `stop_at` is the sample of a stop."""
        for samples in self.samples(distance, period):
            speeds = self.speeds(distance, samples, period)
            rounding = abs(distance) / (samples * (period or self.sample_period))
            for outcome in (speeds,) if stop_at is None else self.stopped(speeds, stop_at):
                yield self._motion(outcome, count, stop_at, rounding)

    def _motion(self, speeds: Samples, count: int, stop_at: int | None, rounding: float) -> Motion:
        last = len(speeds) + self.filter_length - 2
        raw = np.zeros(count)
        raw[: len(speeds)] = speeds[:count]
        place = np.arange(count)
        ends = last if stop_at is None else min(stop_at, last)
        return Motion(
            start=0.0,
            raw=raw,
            average=averaged(raw, 0.0, self.filter_length),
            law=np.where(place < len(speeds) - 1, RAMP, STEADY),
            active=place < ends,
            held=np.zeros(count, dtype=bool),
            steady=place >= last,
            done=place == (last if ends == last else -1),
            changes=np.full(count, rounding),
            open_decisions=frozenset(),
        )


def move_constants(job: Job, moves: Moves) -> tuple[ConstantGroup, ...]:
    """Constants of the block in the order of its source."""
    unit = job.length_unit
    limits = (
        Constant("MIN_DISTANCE", moves.min_distance, unit, "shortest move"),
        Constant("MAX_DISTANCE", moves.max_distance, unit, "longest move"),
        Constant("MIN_CYCLE_TIME", job.sample_period / CYCLE_RANGE, "s", "shortest plausible cycle"),
        Constant("MAX_CYCLE_TIME", job.sample_period * CYCLE_RANGE, "s", "longest plausible cycle"),
    )
    law = (
        *(
            Constant(f"LAW_{index}", value, "1", "coefficient of the law,", "claim 3")
            for index, value in enumerate(moves.coefficients, start=1)
        ),
        *(
            Constant(f"SUM_{index}", value, "1", "of the sum over the samples")
            for index, value in enumerate(moves.sum_terms, start=1)
        ),
        Constant("TIME_BY_VELOCITY", moves.time_by_velocity, f"s/{unit}", "Tm/D that keeps the speed"),
        Constant("SQUARE_BY_ACC", moves.square_by_acceleration, f"s2/{unit}", "Tm^2/D that keeps the acceleration"),
        Constant("CUBE_BY_JUMP", moves.cube_by_jump, f"s3/{unit}", "Tm^2 T/D that keeps the jerk at the ends"),
        Constant("LEVEL_SAMPLES", float(moves.filter_length), "1", "n: samples for which a stop holds the speed"),
        Constant("CUBE_BY_JERK", moves.cube_by_jerk, f"s3/{unit}", "Tm^3/D that keeps the jerk in between"),
    )
    average = average_constants(job, moves.counts)
    return (
        ConstantGroup("Limits of the job", limits),
        ConstantGroup(
            "Law of a move: u(x) = x (LAW_1 - x^2 (LAW_2 - x^2 (LAW_3 - x^2 LAW_4))), about pi/2 sin(pi x)", law
        ),
        ConstantGroup(average.title, average.constants[:2]),
    )
