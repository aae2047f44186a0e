"""The general cubic equation in closed form: seed 000, equations (1)-(3), corrected.

Printed (3) takes a cube root where the factor is `2 sqrt(-p/3)`, and an arctangent that holds only for q > 0.
"""

from __future__ import annotations

from math import acos, cbrt, cos, frexp, hypot, ldexp, pi, sqrt

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float64]


def cubic_roots(a: float, b: float, c: float) -> tuple[float, ...]:
    """Real roots of x^3 + a x^2 + b x + c = 0 in ascending order, equation (1): x = y - a/3.

    Three values when all roots are real (a double root is repeated, or left out where rounding parts it), else one.
    """
    p = b - a * a / 3
    q = (2 * a * a / 27 - b / 3) * a + c
    return tuple(sorted(root - a / 3 for root in depressed_cubic_roots(p, q)))


def depressed_cubic_roots(p: float, q: float) -> tuple[float, ...]:
    """Real roots of y^3 + p y + q = 0 in ascending order, as many as `cubic_roots` gives.

    Each is backward stable: abs(y^3 + p y + q) <= 16 eps (abs(y^3) + abs(p y) + abs(q)), so a simple root has a
    relative error of a few eps however small it is beside the others, and a double one of its square root.
    """
    if p == 0 == q:
        return 0.0, 0.0, 0.0
    # Measured in units of its own size, a power of two, the equation neither overflows nor loses a bit.
    exponent = max(frexp(number)[1] // power for number, power in ((p, 2), (q, 3)) if number)
    roots = _scaled_roots(ldexp(p, -2 * exponent), ldexp(q, -3 * exponent))
    return tuple(ldexp(root, exponent) for root in roots)


def _scaled_roots(p: float, q: float) -> tuple[float, ...]:
    discriminant = (q / 2) ** 2 + (p / 3) ** 3
    if p < 0 and discriminant <= 0:
        return _three_real_roots(p, q)
    return (_one_real_root(p, q, discriminant),)


def _one_real_root(p: float, q: float, discriminant: float) -> float:
    """Equation (2), x_1. The two cube roots have the product -p/3, so only the larger one is extracted."""
    if p == 0:
        return cbrt(-q)
    root = hypot(q / 2, (p / 3) * sqrt(p / 3)) if p > 0 else sqrt(discriminant)
    u = cbrt(abs(q) / 2 + root)
    # u - p/(3u) cancels for p > 0; the identity u^3 - v^3 = |q| turns the difference into a sum of positive terms.
    v = p / (3 * u)
    magnitude = abs(q) / (u * u + u * v + v * v) if p > 0 else u - v
    return -magnitude if q > 0 else magnitude


def _three_real_roots(p: float, q: float) -> tuple[float, ...]:
    """Equation (3), corrected: 2 sqrt(-p/3) cos((theta + 2 pi k)/3) with cos(theta) = -q/2 / sqrt((-p/3)^3).

    The cosine of the outer two is at least 1/2. The middle one, that may be near zero, follows from the product -q.
    """
    scale = sqrt(-p / 3)
    cosine = -q / (2 * scale**3)
    theta = acos(max(-1.0, min(1.0, cosine)))
    largest, lowest = 2 * scale * cos(theta / 3), 2 * scale * cos((theta + 2 * pi) / 3)
    return tuple(sorted((lowest, -q / (lowest * largest), largest)))


# ---------------------------------------------------------------------------------------------------------- arrays


def only_roots(p: float, q: Samples) -> Samples:
    """The real root of y^3 + p y + q = 0, p >= 0, for each q of moderate size: as `_one_real_root` finds it."""
    half = np.abs(q) / 2
    u = np.cbrt(half + np.hypot(half, (p / 3) * sqrt(p / 3)))
    u = np.where(u == 0, 1.0, u)
    v = p / (3 * u)
    return np.asarray(-q / (u * u + u * v + v * v))


def middle_roots(p: float, q: Samples) -> Samples:
    """The middle one of three real roots of y^3 + p y + q = 0 for each q of moderate size: as `_three_real_roots`."""
    scale = sqrt(-p / 3)
    theta = np.arccos(np.clip(-q / (2 * scale**3), -1.0, 1.0))
    largest, lowest = 2 * scale * np.cos(theta / 3), 2 * scale * np.cos((theta + 2 * pi) / 3)
    return np.asarray(-q / (lowest * largest))
