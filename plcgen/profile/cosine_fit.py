"""Polynomials for the cosine (claim 3) and their coefficients: four ways to fit them, and what is made of each.

| letter | word                                    | letter | word                                          |
|--------|-----------------------------------------|--------|-----------------------------------------------|
| f      | displacement of claim 3, about cos t    | s      | the same law centred, about sin(pi y/2)       |
| b1..b4 | its coefficients                        | d1..d4 | its coefficients                              |
| t      | 0 .. pi                                 | y      | -1 .. 1; as s is odd, 0 .. 1 tells all        |
| g      | error of f or s (claim 5)               | x      | share of the interval, 0 .. 1                 |

    f(t) = 1 - b1 t^2 + b2 t^4 - b3 t^6 + b4 t^8            s(y) = d1 y - d2 y^3 + d3 y^5 - d4 y^7

Inside, both are polynomials of x. A fit as such may end beside its mark: f(pi) = -1 and f'(pi) = 0, s(1) = 1 and
s'(1) = 0. `repaired` is the nearest polynomial that ends on it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import pi

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from plcgen.profile.cosine_genetic import genetic_factors
from plcgen.profile.exactly import Exact, nearest, series, solve, value

Samples = NDArray[np.float64]

FITS = ("minimax", "least-squares", "genetic", "taylor")
DERIVATIVES = 4
GRID = 4000  # intervals
_X2 = Polynomial([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Law:
    """A function that is fitted by x^n with n in `powers`, and `fixed` before them; signs alternate.

    `exact(x, order)` is the function or its derivative by x, as the library rounds it; `series` tells it to 40 digits.
    `plain` is a polynomial with the right end, `free` are two that do not move it.
    """

    letter: str
    argument: str
    span: float
    fixed: float
    first_sign: float
    powers: tuple[int, ...]
    exact: Callable[[Samples, int], Samples]
    series: Exact
    plain: Polynomial
    free: tuple[Polynomial, Polynomial]

    def polynomial(self, coefficients: Samples) -> Polynomial:
        """In x, from coefficients as the claim writes them."""
        terms = np.zeros(self.powers[-1] + 1)
        terms[0] = self.fixed
        for index, (power, coefficient) in enumerate(zip(self.powers, coefficients, strict=True)):
            terms[power] = self.first_sign * (-1.0) ** index * coefficient * self._scale(power)
        return Polynomial(terms)

    def coefficients(self, polynomial: Polynomial) -> tuple[float, ...]:
        """As the claim writes them, of a polynomial in x."""
        return tuple(
            float(self.first_sign * (-1.0) ** index * polynomial.coef[power] / self._scale(power))
            for index, power in enumerate(self.powers)
        )

    def _scale(self, power: int) -> float:
        return float(Fraction(self.span) ** power)


def _cosine(x: Samples, order: int) -> Samples:
    """Derivative of cos(pi x)."""
    return np.asarray(pi**order * np.cos(pi * x + order * pi / 2))


def _sine(x: Samples, order: int) -> Samples:
    """Derivative of sin(pi x/2)."""
    return np.asarray((pi / 2) ** order * np.sin(pi / 2 * x + order * pi / 2))


_ENDS = (1 - _X2) ** 2
HALF_SINE = Law(
    "f",
    "t",
    pi,
    1.0,
    -1.0,
    (2, 4, 6, 8),
    _cosine,
    series(0, 1),
    1 - 4 * _X2 + 2 * _X2**2,
    (_X2 * _ENDS, _X2**2 * _ENDS),
)
CENTRED = Law(
    "s",
    "y",
    1.0,
    0.0,
    1.0,
    (1, 3, 5, 7),
    _sine,
    series(1, Fraction(1, 2)),
    Polynomial([0.0, 1.5, 0.0, -0.5]),
    (Polynomial([0.0, 1.0]) * _ENDS, Polynomial([0.0, 0.0, 0.0, 1.0]) * _ENDS),
)


@dataclass(frozen=True, eq=False)
class Fit:
    """One fit of a law: as it comes out, and as it is emitted."""

    name: str
    law: Law
    raw: Polynomial
    repaired: Polynomial

    @property
    def coefficients(self) -> tuple[float, ...]:
        """b1..b4 or d1..d4 of the repaired polynomial."""
        return self.law.coefficients(self.repaired)

    @property
    def raw_coefficients(self) -> tuple[float, ...]:
        return self.law.coefficients(self.raw)


@cache
def fit(name: str, law: Law, seed: int = 1) -> Fit:
    """`name` is one of FITS; `seed` is of the genetic fit."""
    raw = _RAW[name](law, seed)
    return Fit(name, law, raw, repaired(law, raw))


def repaired(law: Law, raw: Polynomial) -> Polynomial:
    """The polynomial that ends on its mark and is nearest in the mean of the squares."""
    u, v = nearest([_exact(free) for free in law.free], _exact(raw - law.plain))
    return _ended(law, float(u), float(v))


def error(law: Law, polynomial: Polynomial, order: int) -> float:
    """Largest error of the law or of a derivative by t or y, over the whole interval."""
    x = np.linspace(0.0, 1.0, GRID + 1)
    derivative = polynomial.deriv(order) if order else polynomial
    return float(np.abs(derivative(x) - law.exact(x, order)).max()) / law.span**order


def extremes(polynomial: Polynomial) -> tuple[float, float]:
    """Lowest and highest value for x in 0 .. 1."""
    # To 12 digits: the last ones are of the solver on the machine at hand, and move no value.
    roots = np.round(polynomial.deriv().roots(), 12)
    inner = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0.0) & (roots.real < 1.0)]
    values = polynomial(np.array([0.0, 1.0, *inner]))
    return float(values.min()), float(values.max())


def peak(polynomial: Polynomial) -> float:
    """Largest absolute value for x in 0 .. 1."""
    return max(map(abs, extremes(polynomial)))


def is_monotone(law: Law, polynomial: Polynomial) -> bool:
    """Whether the law never turns: a turn would be a speed that overshoots (s), or runs backwards (f).

    An end at standstill is a zero of the derivative itself, hence the allowance for its rounding.
    """
    lowest, highest = extremes(polynomial.deriv())
    return highest <= 1e-9 if law is HALF_SINE else lowest >= -1e-9


# ------------------------------------------------------------------------------------------------------------ fits


def _taylor(law: Law, _seed: int) -> Polynomial:
    """Claim 2: of cos t, and of sin(pi y/2)."""
    return Polynomial([float(term) for term in law.series[: law.powers[-1] + 1]])


def _genetic(law: Law, seed: int) -> Polynomial:
    """Claims 4 and 5. The search scales the coefficients of Taylor."""
    factors = np.array(genetic_factors(law.letter, seed))
    return law.polynomial(factors * law.coefficients(_taylor(law, seed)))


def _least_squares(law: Law, _seed: int) -> Polynomial:
    """All four coefficients free: the mean of the squares of g is least."""
    monomials = [[Fraction(power == wanted) for power in range(law.powers[-1] + 1)] for wanted in law.powers]
    polynomial = np.zeros(law.powers[-1] + 1)
    polynomial[0] = law.fixed
    polynomial[list(law.powers)] = [float(factor) for factor in nearest(monomials, [Fraction(0), *law.series[1:]])]
    return Polynomial(polynomial)


def _minimax(law: Law, _seed: int) -> Polynomial:
    """The largest error is least among those that end on their mark: Remez's exchange with three points."""
    x = np.linspace(0.0, 1.0, GRID + 1)[1:-1]
    base, first, second = law.plain(x) - law.exact(x, 0), law.free[0](x), law.free[1](x)
    points = np.array([len(x) // 5, len(x) // 2, 4 * len(x) // 5])
    for _ in range(50):
        u, v = _level(law, [Fraction(int(point) + 1, GRID) for point in points])
        found = _alternation(base + u * first + v * second)
        if len(found) != 3 or np.array_equal(found, points):
            break
        points = found
    return _ended(law, u, v)


def _level(law: Law, points: list[Fraction]) -> tuple[float, float]:
    """Factors on the free polynomials with which the law errs equally at three points, with changing sign."""
    plain, first, second = map(_exact, (law.plain, *law.free))
    rows = [[value(first, x), value(second, x), Fraction((-1) ** index)] for index, x in enumerate(points)]
    u, v, _error = solve(rows, [value(law.series, x) - value(plain, x) for x in points])
    return float(u), float(v)


def _alternation(g: Samples) -> NDArray[np.int64]:
    """Where the error is largest between its changes of sign."""
    changes = np.flatnonzero(np.signbit(g[1:]) != np.signbit(g[:-1])) + 1
    edges = pairwise([0, *changes, len(g)])
    return np.array([low + int(np.argmax(np.abs(g[low:high]))) for low, high in edges])


def _exact(polynomial: Polynomial) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, polynomial.coef.tolist()))


def _ended(law: Law, first: float, second: float) -> Polynomial:
    """The polynomials that end on their mark."""
    total: Polynomial = law.plain + first * law.free[0] + second * law.free[1]
    return total


_RAW: dict[str, Callable[[Law, int], Polynomial]] = {
    "taylor": _taylor,
    "genetic": _genetic,
    "least-squares": _least_squares,
    "minimax": _minimax,
}
