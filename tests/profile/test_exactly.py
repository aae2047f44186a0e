"""What must not hang on a machine, against figures by hand, closed forms, and NumPy within its own rounding."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from math import cbrt, cos, inf, nextafter, pi, sin, ulp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plcgen.profile import exactly
from plcgen.profile.exactly import PI, cosine, cube_root, nearest, series, solve, value

fractions = st.fractions(min_value=-9, max_value=9, max_denominator=20)


def test_decimal_cosine_is_that_of_the_platform() -> None:
    """Within a unit in the last place of the larger of cos and the angle's own rounding."""
    for i in range(-4 * 64, 4 * 64 + 1):
        decimal = float(cosine(Fraction(i, 64)))
        angle = pi * i / 64
        assert abs(decimal - cos(angle)) <= ulp(decimal) + abs(sin(angle)) * ulp(angle), i


@pytest.mark.parametrize(
    ("turns", "digits"),
    [
        (Fraction(0), "1"),
        (Fraction(1, 6), "0.8660254037844386467637231707529"),  # sqrt(3)/2
        (Fraction(1, 4), "0.7071067811865475244008443621048"),  # sqrt(1/2)
        (Fraction(1, 3), "0.5"),
        (Fraction(2, 5), "0.3090169943749474241022934171828"),  # (sqrt(5) - 1)/4
        (Fraction(1, 2), "0"),
        (Fraction(2, 3), "-0.5"),
        (Fraction(1), "-1"),
        (Fraction(-1, 4), "0.7071067811865475244008443621048"),
        (Fraction(7, 4), "0.7071067811865475244008443621048"),
    ],
)
def test_decimal_cosine_by_roots(turns: Fraction, digits: str) -> None:
    assert abs(cosine(turns) - Decimal(digits)) < Decimal("1e-30")


def test_pi() -> None:
    assert float(PI) == pi
    assert str(PI).startswith("3.14159265358979323846264338327950288419716939937")


@pytest.mark.parametrize("x", [Fraction(0), Fraction(1, 7), Fraction(1, 2), Fraction(3, 4), Fraction(1)])
def test_series_is_the_decimal_cosine(x: Fraction) -> None:
    for found, wanted in (
        (value(series(0, 1), x), cosine(x)),
        (value(series(1, Fraction(1, 2)), x), cosine((x - 1) / 2)),
    ):
        assert abs(found - Fraction(wanted)) < Fraction(1, 10**37)


def test_value_of_a_polynomial() -> None:
    assert value([Fraction(1), Fraction(-3), Fraction(2)], Fraction(1, 2)) == 0
    assert value([], Fraction(5)) == 0


def test_equations_by_hand() -> None:
    """2x + y = 5 and x - 3y = -1; and one whose first pivot is 0."""
    assert solve([[Fraction(2), Fraction(1)], [Fraction(1), Fraction(-3)]], [Fraction(5), Fraction(-1)]) == [2, 1]
    assert solve([[Fraction(0), Fraction(1)], [Fraction(3), Fraction(0)]], [Fraction(5), Fraction(6)]) == [2, 5]


def test_equations_without_a_solution() -> None:
    with pytest.raises(ZeroDivisionError):
        solve([[Fraction(1), Fraction(2)], [Fraction(2), Fraction(4)]], [Fraction(1), Fraction(1)])


@given(st.lists(st.lists(fractions, min_size=4, max_size=4), min_size=3, max_size=3))
def test_a_solution_solves(table: list[list[Fraction]]) -> None:
    rows, right = [row[:3] for row in table], [row[3] for row in table]
    if abs(np.linalg.det(np.array(rows, dtype=float))) < 1e-6:
        return
    found = solve(rows, right)
    assert [sum(a * x for a, x in zip(row, found, strict=True)) for row in rows] == right


def test_nearest_line_to_a_parabola() -> None:
    """x^2 is nearest to x - 1/6 over 0 .. 1, a classic."""
    one, x, square = [Fraction(1)], [Fraction(0), Fraction(1)], [Fraction(0), Fraction(0), Fraction(1)]
    assert nearest([one, x], square) == [Fraction(-1, 6), 1]


def test_nearest_line_to_a_sine() -> None:
    """By the integrals of sin(pi x/2), 2/pi, and of x sin(pi x/2), 4/pi^2."""
    constant, slope = nearest([[Fraction(1)], [Fraction(0), Fraction(1)]], series(1, Fraction(1, 2)))
    mean, moment = 2 / pi, 4 / pi**2
    assert float(constant) == pytest.approx(4 * mean - 6 * moment, rel=1e-13)
    assert float(slope) == pytest.approx(12 * moment - 6 * mean, rel=1e-13)


@given(st.floats(min_value=1e-60, max_value=1e60))
def test_cube_root_is_the_nearest_float(x: float) -> None:
    root = Fraction(cube_root(x))
    below, above = (Fraction(nextafter(float(root), end)) for end in (0.0, inf))
    assert ((below + root) / 2) ** 3 <= Fraction(x) <= ((root + above) / 2) ** 3


@pytest.mark.parametrize("units", [-3, -1, 1, 3])
@pytest.mark.parametrize("x", [0.75, 2.0, 1e-9, 8.0, 3e7])
def test_cube_root_does_not_hang_on_the_library(x: float, units: int, monkeypatch: pytest.MonkeyPatch) -> None:
    here = cube_root(x)
    monkeypatch.setattr(exactly, "cbrt", lambda value: cbrt(value) + units * ulp(cbrt(value)))
    assert cube_root(x) == here
