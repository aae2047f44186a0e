"""A change between two corner speeds over travel: seed 000, equations (4)-(15), corrected and completed.

| letter | word                                   | letter | word                                      |
|--------|----------------------------------------|--------|-------------------------------------------|
| lo, hi | smaller, larger corner speed           | m      | jerk                                      |
| a      | limit of acceleration                  | a_p    | acceleration that is reached              |
| t1     | time of each of the two jerk phases    | t2     | time at constant acceleration             |
| x      | travel from the slow end               | y      | travel before the fast end, y = L - x     |
| L      | travel of the whole transition         | v      | speed                                     |

Acceleration runs through it from the slow end, deceleration is its mirror image.
Units follow the job: length unit, s, and their quotients.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, sqrt

import numpy as np
from numpy.typing import NDArray

from plcgen.profile.cubic import depressed_cubic_roots, middle_roots, only_roots

Samples = NDArray[np.float64]


@dataclass(frozen=True)
class Transition:
    """`slow_velocity` to `fast_velocity` within `acceleration` and `jerk`; all finite, jerk and acceleration > 0."""

    slow_velocity: float
    fast_velocity: float
    acceleration: float
    jerk: float

    @property
    def velocity_change(self) -> float:
        return self.fast_velocity - self.slow_velocity

    @property
    def is_short(self) -> bool:
        """True when the acceleration limit is not reached: dv < a^2/m, no middle part."""
        return self.velocity_change < self.acceleration**2 / self.jerk

    @cached_property
    def jerk_time(self) -> float:
        """t1 = a/m, or sqrt(dv/m) when short."""
        return sqrt(self.velocity_change / self.jerk) if self.is_short else self.acceleration / self.jerk

    @cached_property
    def peak_acceleration(self) -> float:
        """a_p = m t1."""
        return self.jerk * self.jerk_time if self.is_short else self.acceleration

    @cached_property
    def middle_time(self) -> float:
        """t2 = dv/a - a/m; zero when short."""
        # At the edge of short the difference is rounding alone, and may be negative.
        return 0.0 if self.is_short else max(0.0, self.velocity_change / self.acceleration - self.jerk_time)

    @cached_property
    def duration(self) -> float:
        return 2 * self.jerk_time + self.middle_time

    @cached_property
    def travel(self) -> float:
        """L = (lo + hi)/2 (2 t1 + t2): the speed is point-symmetric about its mean."""
        return (self.slow_velocity + self.fast_velocity) / 2 * self.duration

    @cached_property
    def slow_corner_travel(self) -> float:
        """Delta S_1 = lo t1 + m t1^3/6, end of the slow part, from (5)."""
        return (self.slow_velocity + self.jerk * self.jerk_time**2 / 6) * self.jerk_time

    @cached_property
    def slow_corner_velocity(self) -> float:
        """v_1 = lo + m t1^2/2, from (4)."""
        return self.slow_velocity + self.jerk * self.jerk_time**2 / 2

    @cached_property
    def fast_corner_travel(self) -> float:
        """x where the fast part begins: L - (hi t1 - m t1^3/6), from (12)."""
        return self.travel - self.fast_part_travel

    @cached_property
    def fast_part_travel(self) -> float:
        """Delta S_3 = hi t1 - m t1^3/6."""
        return (self.fast_velocity - self.jerk * self.jerk_time**2 / 6) * self.jerk_time

    @cached_property
    def fast_corner_velocity(self) -> float:
        """v_2 = hi - m t1^2/2, from (11)."""
        return self.fast_velocity - self.jerk * self.jerk_time**2 / 2

    @property
    def middle_travel(self) -> float:
        return max(0.0, self.fast_corner_travel - self.slow_corner_travel)

    def velocity(self, travel: float) -> float:
        """v(x), (7), (9) and (15); lo before the slow end, hi behind the fast end."""
        if travel <= 0:
            return self.slow_velocity
        if travel >= self.travel:
            return self.fast_velocity
        if travel < self.slow_corner_travel:
            return self._slow_part(travel)
        if travel > self.fast_corner_travel:
            return self._fast_part(self.travel - travel)
        return sqrt(self.slow_corner_velocity**2 + 2 * self.peak_acceleration * (travel - self.slow_corner_travel))

    def velocities(self, travel: Samples) -> Samples:
        """v(x) of an array, to a few units in the last place."""
        result = np.where(travel <= 0, self.slow_velocity, self.fast_velocity)
        inside = (travel > 0) & (travel < self.travel)
        slow, fast = inside & (travel < self.slow_corner_travel), inside & (travel > self.fast_corner_travel)
        middle = inside & ~slow & ~fast
        way = travel[middle] - self.slow_corner_travel
        result[middle] = np.sqrt(self.slow_corner_velocity**2 + 2 * self.peak_acceleration * way)
        t = only_roots(6 * self.slow_velocity / self.jerk, -6 * travel[slow] / self.jerk)
        result[slow] = self.slow_velocity + self.jerk * t * t / 2
        t = middle_roots(-6 * self.fast_velocity / self.jerk, 6 * (self.travel - travel[fast & ~slow]) / self.jerk)
        result[fast & ~slow] = self.fast_velocity - self.jerk * t * t / 2
        return result

    def acceleration_at(self, velocity: float) -> float:
        """a(v): sqrt(2 m (v - lo)) in the slow part, sqrt(2 m (hi - v)) in the fast part, a_p between."""
        corner_distance = max(0.0, min(velocity - self.slow_velocity, self.fast_velocity - velocity))
        return min(self.peak_acceleration, sqrt(2 * self.jerk * corner_distance))

    def _slow_part(self, x: float) -> float:
        """(6): t^3 + 6 lo/m t - 6 x/m = 0 has one real root; (4): v = lo + m t^2/2.

        From rest, where 6 x/m is less than any float, 0 is a triple root.
        """
        *_, t = depressed_cubic_roots(6 * self.slow_velocity / self.jerk, -6 * x / self.jerk)
        return self.slow_velocity + self.jerk * t * t / 2

    def _fast_part(self, y: float) -> float:
        """(13): t^3 - 6 hi/m t + 6 y/m = 0, its smallest positive root (14); (11): v = hi - m t^2/2."""
        _, t, _ = depressed_cubic_roots(-6 * self.fast_velocity / self.jerk, 6 * y / self.jerk)
        return self.fast_velocity - self.jerk * t * t / 2

    @property
    def steepest_gain(self) -> float:
        """Largest a/v of the transition in 1/s: the gain dv/dx of a loop that commands v(x).

        m t/(lo + m t^2/2) peaks at v = 2 lo, or at the slow corner where the slow part ends before that. From lo = 0
        it is 2/t, without limit.
        """
        if self.slow_velocity <= 0:
            return inf
        peak_velocity = min(2 * self.slow_velocity, self.slow_corner_velocity)
        return sqrt(2 * self.jerk * (peak_velocity - self.slow_velocity)) / peak_velocity


def reached_velocity(slow: float, limit: float, rising: float, falling: float, jerk: float, room: float) -> float:
    """Largest speed up to `limit` whose two transitions from and to `slow` fit into `room` of travel.

    `rising` and `falling` limit acceleration and deceleration. The travel grows strictly with the speed, so bisection
    down to neighbouring floats finds it in every mixture of full and short transitions; `room` must not be negative.
    """

    def travel(velocity: float) -> float:
        return sum(Transition(slow, velocity, limit_of_side, jerk).travel for limit_of_side in (rising, falling))

    if travel(limit) <= room:
        return limit
    low, high = slow, limit
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if travel(middle) <= room else (low, middle)
    return low
