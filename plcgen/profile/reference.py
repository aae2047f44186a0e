"""The reference: motion over time as a chain of phases of constant jerk, in float64.

It knows nothing of cubic equations. Travel, speed and acceleration are the polynomials of each phase; where a
travel is given, its time is found by bisection.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plcgen.trajectory import Trajectory

Samples = NDArray[np.float64]


@dataclass(frozen=True)
class Phase:
    """One interval of constant jerk: duration in s, jerk, and the number of the leg of the trip it belongs to."""

    duration: float
    jerk: float
    leg: int


class Motion(NamedTuple):
    """Travel, velocity, acceleration, jerk and leg at some instants, arrays of one shape."""

    travel: Samples
    velocity: Samples
    acceleration: Samples
    jerk: Samples
    leg: NDArray[np.int64]


@dataclass(frozen=True)
class Reference:
    """Phases in order, from travel 0 at an initial velocity and acceleration; nothing jumps but the jerk."""

    phases: Sequence[Phase]
    initial_velocity: float = 0.0
    initial_acceleration: float = 0.0

    @cached_property
    def _starts(self) -> Samples:
        """Rows of time, travel, velocity and acceleration at the start of each phase and at the end of the last."""
        states = [(0.0, 0.0, self.initial_velocity, self.initial_acceleration)]
        for phase in self.phases:
            time, travel, velocity, acceleration = states[-1]
            d, j = phase.duration, phase.jerk
            states.append(
                (
                    time + d,
                    travel + d * (velocity + d * (acceleration / 2 + d * j / 6)),
                    velocity + d * (acceleration + d * j / 2),
                    acceleration + d * j,
                )
            )
        return np.array(states)

    @cached_property
    def _jerks(self) -> Samples:
        return np.array([phase.jerk for phase in self.phases])

    @cached_property
    def _legs(self) -> NDArray[np.int64]:
        return np.array([phase.leg for phase in self.phases])

    def _phase_of(self, starts: Samples, values: Samples) -> NDArray[np.int64]:
        """Indices of the phases in which values lie, given where each phase starts."""
        return np.clip(np.searchsorted(starts, values, side="right") - 1, 0, len(self.phases) - 1)

    @property
    def corner_times(self) -> Samples:
        """Instants at which a phase begins, and the end."""
        return np.asarray(self._starts[:, 0])

    @property
    def duration(self) -> float:
        return float(self._starts[-1, 0])

    @property
    def travel(self) -> float:
        return float(self._starts[-1, 1])

    @property
    def end(self) -> Samples:
        """Time, travel, velocity, acceleration at the end."""
        return np.asarray(self._starts[-1])

    def at_time(self, time: Samples) -> Motion:
        """Motion at instants in s; at rest before the start and after the end."""
        clipped = np.clip(time, 0.0, self.duration)
        index = self._phase_of(self._starts[:, 0], clipped)
        start_time, travel, velocity, acceleration = self._starts[index].T
        jerk = self._jerks[index]
        leg = self._legs[index]
        t = clipped - start_time
        return Motion(
            travel + t * (velocity + t * (acceleration / 2 + t * jerk / 6)),
            velocity + t * (acceleration + t * jerk / 2),
            acceleration + t * jerk,
            jerk,
            leg,
        )

    def time_at(self, travel: Samples) -> Samples:
        """Instants at which the travel is reached; travel outside 0 .. end gives the start or the end."""
        index = self._phase_of(self._starts[:, 1], travel)
        start_time, start_travel, velocity, acceleration = self._starts[index].T
        jerk = self._jerks[index]
        to_go = travel - start_travel
        low = np.zeros_like(travel, dtype=np.float64)
        step = self._starts[index + 1, 0] - start_time
        half, sixth = acceleration / 2, jerk / 6
        # So many halvings of a phase reach the spacing of float64 at its duration.
        for _ in range(54):
            step /= 2
            t = low + step
            way = t * sixth
            way += half
            way *= t
            way += velocity
            way *= t
            np.copyto(low, t, where=way < to_go)
        return np.asarray(start_time + low)

    def at_travel(self, travel: Samples) -> Motion:
        """Motion at places of the trip."""
        return self.at_time(self.time_at(travel))

    def legs_at(self, travel: Samples) -> NDArray[np.int64]:
        """Numbers of the legs at places of the trip."""
        return np.asarray(self._legs[self._phase_of(self._starts[:, 1], travel)])

    def sample(self, period: float) -> Trajectory:
        """Columns time, travel, velocity, acceleration, jerk, phase at 0, period, ... up to and including the end."""
        grid = np.arange(np.ceil(self.duration / period)) * period
        time = np.append(grid[grid < self.duration], self.duration)
        motion = self.at_time(time)
        return Trajectory(
            {
                "time": time,
                "travel": motion.travel,
                "velocity": motion.velocity,
                "acceleration": motion.acceleration,
                "jerk": motion.jerk,
                "phase": motion.leg,
            }
        )
