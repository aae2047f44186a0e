"""Cosines, cube roots, mean squares and linear equations, the same to the last bit on every machine.

Sine, cosine and cube root of a C library, and the solvers behind NumPy, round as the library or the processor at hand
likes. What comes from here is computed in rational numbers or in 40 decimals, and rounded once. A polynomial is the
sequence of its coefficients, lowest power first.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal, localcontext
from fractions import Fraction
from math import cbrt, factorial

Exact = Sequence[Fraction]

PI = Decimal("3.14159265358979323846264338327950288419716939937511")
DIGITS = 40
TERMS = 26  # pi^52/52! is below 1e-41


def cosine(half_turns: Fraction) -> Decimal:
    """cos(pi half_turns), by its series after folding into the first quarter."""
    folded = abs(half_turns) % 2
    folded = min(folded, 2 - folded)
    if folded > Fraction(1, 2):
        return cosine(1 - folded).copy_negate()  # a minus would round to the digits of the caller
    with localcontext() as context:
        context.prec = DIGITS
        square = (Decimal(folded.numerator) / folded.denominator * PI) ** 2
        term = total = Decimal(1)
        for n in range(1, TERMS):
            term = -term * square / ((2 * n - 1) * (2 * n))
            total += term
        return total


def series(first_power: int, half_turns: int | Fraction) -> Exact:
    """Of cos(pi half_turns x), first power 0, or sin of the same, first power 1; `half_turns` up to 1, x up to 1."""
    terms = [Fraction(0)] * (2 * TERMS)
    with localcontext() as context:
        context.prec = DIGITS
        angle = PI * half_turns.numerator / half_turns.denominator
        for index, power in enumerate(range(first_power, 2 * TERMS, 2)):
            terms[power] = Fraction((-1) ** index * angle**power / factorial(power))
    return terms


def cube_root(x: float) -> float:
    """The float64 nearest to it, of x > 0. C libraries miss it by up to two units in the last place.

    A step of Newton's method from there squares the error, if the difference of the cubes is taken exactly.
    """
    near = cbrt(x)
    return near - float(Fraction(near) ** 3 - Fraction(x)) / (3 * near * near)


def value(polynomial: Exact, x: Fraction) -> Fraction:
    total = Fraction(0)
    for coefficient in reversed(polynomial):
        total = total * x + coefficient
    return total


def nearest(basis: Sequence[Exact], wanted: Exact) -> list[Fraction]:
    """Factors on `basis` whose sum is `wanted` with the least mean square of the error over 0 .. 1."""
    rows = [[_mean_product(one, other) for other in basis] for one in basis]
    return solve(rows, [_mean_product(one, wanted) for one in basis])


def _mean_product(one: Exact, other: Exact) -> Fraction:
    """Integral over 0 .. 1."""
    return sum(
        (a * b / (i + j + 1) for i, a in enumerate(one) if a for j, b in enumerate(other) if b), start=Fraction(0)
    )


def solve(rows: Sequence[Sequence[Fraction]], right: Sequence[Fraction]) -> list[Fraction]:
    """Solution of linear equations that have one.

    Raises:
        ZeroDivisionError: where they have none or many.
    """
    left = [[*row, known] for row, known in zip(rows, right, strict=True)]
    done: list[list[Fraction]] = []
    for column in range(len(left)):
        pivot = max(left, key=lambda row: abs(row[column]))
        left.remove(pivot)
        pivot = [part / pivot[column] for part in pivot]
        left, done = [_without(row, pivot, column) for row in left], [_without(row, pivot, column) for row in done]
        done.append(pivot)
    return [row[-1] for row in done]


def _without(row: list[Fraction], pivot: list[Fraction], column: int) -> list[Fraction]:
    return [known - row[column] * part for known, part in zip(row, pivot, strict=True)]
