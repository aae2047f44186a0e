"""A stop from any speed and acceleration: jerk to the peak, hold it, jerk back to rest."""

from __future__ import annotations

from math import sqrt

from plcgen.profile.reference import Phase


def stop_phases(velocity: float, acceleration: float, limit: float, jerk: float, leg: int) -> tuple[Phase, ...]:
    """Phases of constant jerk to rest, `acceleration` with its sign, `velocity` >= 0.

    The peak is the limit, or what brings speed and acceleration to zero together: a_p^2 = m v + a^2/2.
    """
    m = jerk
    peak = min(limit, sqrt(m * velocity + acceleration**2 / 2))
    t1 = max(0.0, (acceleration + peak) / m)
    corner = velocity + (acceleration**2 - peak**2) / (2 * m)
    t2 = max(0.0, (corner - peak**2 / (2 * m)) / peak) if peak > 0 else 0.0
    return Phase(t1, -m, leg), Phase(t2, 0.0, leg), Phase(peak / m, m, leg)
