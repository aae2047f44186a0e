"""A move of one axis from rest to rest in seven phases of jerk, corrected and completed.

Equations (1)-(18) of "Two-dimensional synchronous interpolation and its application on the S7-200 Smart PLC".

| letter | word                                   | letter | word                                      |
|--------|----------------------------------------|--------|-------------------------------------------|
| s      | distance                               | V      | limit of speed, v the speed reached       |
| A      | limit of acceleration, a the reached   | beta   | jerk                                      |
| t1     | time of each of the four jerk phases   | t2     | time of each phase of constant acceleration |
| t4     | time at constant speed                 | h      | A^2/beta                                  |

Phases: 1 jerk up, 2 constant acceleration, 3 jerk down, 4 constant speed, and 5 to 7 the mirror image of 3 to 1.
(16) needs a term v_max t1 more on its way to the result (17), which is right; the condition that the paper warns of,
t_l <= 4 t1, must read 4 t1 + 2 t2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

from plcgen.profile.exactly import cube_root
from plcgen.profile.reference import Phase


@dataclass(frozen=True)
class Limits:
    """Of the leading axis; all finite and above zero."""

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True)
class SevenPhases:
    """Times of the phases, the jerk, and what is reached. `distance` is above zero."""

    distance: float
    t1: float
    t2: float
    t4: float

    @property
    def duration(self) -> float:
        return 4 * self.t1 + 2 * self.t2 + self.t4

    @property
    def velocity(self) -> float:
        """From (17): s = v (2 t1 + t2 + t4)."""
        return self.distance / (2 * self.t1 + self.t2 + self.t4)

    @property
    def acceleration(self) -> float:
        """From (7): v = a (t1 + t2)."""
        return self.velocity / (self.t1 + self.t2)

    @property
    def jerk(self) -> float:
        """From (3): a = beta t1."""
        return self.acceleration / self.t1

    @property
    def acceleration_travel(self) -> float:
        """s1 + s2 + s3 of (3), (5) and (7): v (2 t1 + t2)/2, the speed being point-symmetric about its mean."""
        return self.velocity * (2 * self.t1 + self.t2) / 2

    def stretched(self, duration: float) -> SevenPhases:
        """The same path more slowly: by l, and v, a and beta shrink by 1/l, 1/l^2 and 1/l^3."""
        factor = duration / self.duration
        return SevenPhases(self.distance, self.t1 * factor, self.t2 * factor, self.t4 * factor)

    def phases(self) -> Iterator[Phase]:
        """Phases of constant jerk, numbered as in the paper's figure 2."""
        rows = ((self.t1, 1), (self.t2, 0), (self.t1, -1), (self.t4, 0), (self.t1, -1), (self.t2, 0), (self.t1, 1))
        for number, (duration, sign) in enumerate(rows, start=1):
            yield Phase(duration, sign * self.jerk, number)


def time_optimal(distance: float, limits: Limits) -> SevenPhases:
    """The shortest move within the limits; `distance` > 0.

    With T(V) = V/A + A/beta, or 2 sqrt(V/beta) where A is not reached: full speed is reached from V T(V) on, the
    limit of acceleration from 2 A^3/beta^2 on.
    """
    V, A, beta = limits.velocity, limits.acceleration, limits.jerk  # noqa: N806 - the letters of the paper
    h = A * A / beta
    t1, t2 = (A / beta, V / A - A / beta) if h <= V else (sqrt(V / beta), 0.0)
    if distance >= V * (2 * t1 + t2):
        return SevenPhases(distance, t1, t2, distance / V - 2 * t1 - t2)  # (18)
    if distance >= 2 * A * h / beta:
        reached = (-h + sqrt(h * h + 4 * A * distance)) / 2
        return SevenPhases(distance, A / beta, max(0.0, reached / A - A / beta), 0.0)
    return SevenPhases(distance, cube_root(distance / (2 * beta)), 0.0, 0.0)


def fixed_jerk_time(distance: float, limits: Limits) -> SevenPhases:
    """The paper's way: t1 = A/beta for every distance, and for short moves a smaller beta instead of a shorter t1.

    Three ways of moving between the critical values s_1 = 2 A t1^2 and s_2 = V (2 t1 + t2); needs V >= A^2/beta.
    """
    V, A, beta = limits.velocity, limits.acceleration, limits.jerk  # noqa: N806
    t1 = A / beta
    t2 = max(0.0, V / A - t1)
    if distance >= V * (2 * t1 + t2):
        return SevenPhases(distance, t1, t2, distance / V - 2 * t1 - t2)  # (18)
    if distance >= 2 * A * t1 * t1:
        return SevenPhases(distance, t1, (-3 * t1 + sqrt(t1 * t1 + 4 * distance / A)) / 2, 0.0)
    return SevenPhases(distance, t1, 0.0, 0.0)
