"""An independent proof of a chain of phases: integrate the jerk numerically and look at what comes out.

Nothing here is shared with the derivation or with the reference: only durations and jerks go in. Acceleration is
summed by the rectangle rule, velocity by the trapezoidal rule, travel by Simpson's rule; for jerk that is constant
over each step the three are free of truncation error, so what is left is rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from plcgen.profile.reference import Phase


@dataclass(frozen=True)
class Proof:
    """Extremes over all steps and the state at the end."""

    duration: float
    travel: float
    end_velocity: float
    end_acceleration: float
    lowest_velocity: float
    highest_velocity: float
    highest_acceleration: float
    lowest_acceleration: float
    highest_jerk: float


def integrate(phases: Sequence[Phase], steps_per_phase: int = 64) -> Proof:
    """Integrate from rest. Every phase is cut into the same number of steps, so corners are always sampled."""
    steps = np.repeat([phase.duration / steps_per_phase for phase in phases], steps_per_phase)
    jerks = np.repeat([phase.jerk for phase in phases], steps_per_phase)
    acceleration = np.concatenate(([0.0], np.cumsum(jerks * steps)))
    before, after = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate(([0.0], np.cumsum((before + after) / 2 * steps)))
    halfway = velocity[:-1] + (before + (before + after) / 2) / 2 * steps / 2
    travel = np.sum((velocity[:-1] + 4 * halfway + velocity[1:]) / 6 * steps)
    return Proof(
        duration=float(np.sum(steps)),
        travel=float(travel),
        end_velocity=float(velocity[-1]),
        end_acceleration=float(acceleration[-1]),
        lowest_velocity=float(velocity.min()),
        highest_velocity=float(velocity.max()),
        highest_acceleration=float(acceleration.max()),
        lowest_acceleration=float(acceleration.min()),
        highest_jerk=float(np.abs(jerks).max()),
    )
