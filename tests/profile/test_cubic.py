"""The cubic equation: exact products of known roots, exact residuals, scales, both signs of the discriminant."""

from __future__ import annotations

import sys
from fractions import Fraction
from itertools import pairwise
from math import cbrt, isclose, ldexp, sqrt

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from plcgen.profile.cubic import cubic_roots, depressed_cubic_roots, middle_roots, only_roots

EPS = sys.float_info.epsilon
# Roots whose sums and products of two and three are exact in float64.
WHOLE = st.integers(-(2**16), 2**16)
COEFFICIENT = st.floats(-1e6, 1e6).filter(lambda number: number == 0 or abs(number) > 1e-30)


def relative_residual(root: float, p: float, q: float) -> float:
    """abs(y^3 + p y + q) against the sum of its terms, computed without rounding."""
    y, exact_p, exact_q = Fraction(root), Fraction(p), Fraction(q)
    terms = abs(y**3) + abs(exact_p * y) + abs(exact_q)
    return float(abs(y**3 + exact_p * y + exact_q) / terms) if terms else 0.0


def depressed(first: int, second: int) -> tuple[tuple[int, ...], float, float]:
    """Three roots of sum zero, with exact p and q."""
    roots = tuple(sorted((first, second, -first - second)))
    low, middle, high = roots
    return roots, float(low * middle + low * high + middle * high), float(-low * middle * high)


@settings(max_examples=500, deadline=None)
@given(COEFFICIENT, COEFFICIENT)
@example(-3.0, 2.0)
@example(-3.0, 2.0000000000000004)
@example(-3.0, 1.9999999999999998)
@example(-1.0, 1e-25)
@example(1.0, 1e-25)
def test_roots_are_backward_stable(p: float, q: float) -> None:
    roots = depressed_cubic_roots(p, q)
    assert len(roots) in (1, 3)
    assert all(below <= above for below, above in pairwise(roots))
    assert max(relative_residual(root, p, q) for root in roots) <= 16 * EPS


@settings(max_examples=200, deadline=None)
@given(WHOLE, WHOLE)
@example(1, 1)
@example(1, -1)
@example(2**16, 1)
def test_simple_roots_are_found_to_a_few_eps(first: int, second: int) -> None:
    """First order of the residual's bound: the error is at most 16 eps (terms) / abs(derivative)."""
    exact, p, q = depressed(first, second)
    assume(len(set(exact)) == 3)
    for root, truth in zip(depressed_cubic_roots(p, q), exact, strict=True):
        terms = abs(truth) ** 3 + abs(p * truth) + abs(q)
        assert abs(root - truth) <= 16 * EPS * terms / abs(3 * truth * truth + p)


@settings(max_examples=200, deadline=None)
@given(st.integers(1, 2**16), st.sampled_from([-1, 1]))
def test_double_roots(size: int, sign: int) -> None:
    """The simple root is exact to some eps; the double one, if rounding leaves it, to the square root of that."""
    _, p, q = depressed(sign * size, sign * size)
    roots = depressed_cubic_roots(p, q)
    outer = roots[0] if sign > 0 else roots[-1]
    assert isclose(outer, -2 * sign * size, rel_tol=4 * EPS)
    pair = [root for root in roots if root != outer]
    assert all(isclose(root, sign * size, rel_tol=8 * sqrt(EPS)) for root in pair)


@pytest.mark.parametrize("share", [1e-3, 1e-8, 1e-14, 1e-100])
def test_a_root_near_zero_keeps_its_digits(share: float) -> None:
    """y = -q/p (1 + O(share^2)) for a middle root that is `share` of the outer ones."""
    for p in (-1.0, 1.0):
        roots = depressed_cubic_roots(p, share)
        middle = roots[len(roots) // 2]
        assert relative_residual(middle, p, share) <= 4 * EPS
        assert isclose(middle, -share / p, rel_tol=2 * share**2 + 4 * EPS)


def test_special_cases() -> None:
    assert depressed_cubic_roots(0.0, 0.0) == (0.0, 0.0, 0.0)
    assert depressed_cubic_roots(0.0, -27.0) == pytest.approx((3.0,), rel=2 * EPS)
    assert depressed_cubic_roots(0.0, 27.0) == pytest.approx((-3.0,), rel=2 * EPS)
    assert depressed_cubic_roots(4.0, 0.0) == (0.0,)
    low, middle, high = depressed_cubic_roots(-4.0, 0.0)
    assert middle == 0.0
    assert (low, high) == pytest.approx((-2.0, 2.0), rel=EPS)


@settings(max_examples=200, deadline=None)
@given(COEFFICIENT, COEFFICIENT, st.integers(-250, 250))
@example(0.0, 0.125, 1)
def test_scale_changes_no_bit(p: float, q: float, exponent: int) -> None:
    """y -> 2^k y is exact, so nothing overflows or vanishes on the way."""
    scaled = depressed_cubic_roots(ldexp(p, 2 * exponent), ldexp(q, 3 * exponent))
    assert scaled == tuple(ldexp(root, exponent) for root in depressed_cubic_roots(p, q))


@pytest.mark.parametrize(("p", "q"), [(-1e308, 1e308), (1e308, -1e308), (-1e-300, 1e-300), (1e200, 1.0), (-1e300, 0.0)])
def test_ends_of_the_range(p: float, q: float) -> None:
    assert max(relative_residual(root, p, q) for root in depressed_cubic_roots(p, q)) <= 16 * EPS


@settings(max_examples=200, deadline=None)
@given(COEFFICIENT, COEFFICIENT, COEFFICIENT)
def test_general_cubic_against_its_residual(a: float, b: float, c: float) -> None:
    """Normwise stable: with S the size of the largest root, abs(f(x)) stays within 64 eps S^3."""
    size = max(abs(a), sqrt(abs(b)), cbrt(abs(c)))
    for root in cubic_roots(a, b, c):
        x = Fraction(root)
        residual = x**3 + Fraction(a) * x**2 + Fraction(b) * x + Fraction(c)
        assert abs(residual) <= 64 * EPS * size**3


@settings(max_examples=200, deadline=None)
@given(st.lists(st.integers(-1000, 1000), min_size=3, max_size=3, unique=True))
def test_general_cubic_of_known_roots(chosen: list[int]) -> None:
    """Against the roots themselves, and no farther off than NumPy's eigenvalues are allowed to be."""
    first, second, third = sorted(chosen)
    a = -(first + second + third)
    b = first * second + first * third + second * third
    c = -first * second * third
    found = cubic_roots(float(a), float(b), float(c))
    assert found == pytest.approx(sorted(chosen), rel=1e-8, abs=1e-6)
    assert found == pytest.approx(np.sort(np.roots([1, a, b, c]).real).tolist(), rel=1e-6, abs=1e-6)


@settings(max_examples=200, deadline=None)
@given(st.integers(-100, 100), st.integers(-100, 100), st.integers(1, 100))
def test_general_cubic_with_one_real_root(real: int, centre: int, imaginary: int) -> None:
    """(x - r)((x - c)^2 + i^2)."""
    b, c = centre**2 + imaginary**2 + 2 * real * centre, -real * (centre**2 + imaginary**2)
    (root,) = cubic_roots(float(-real - 2 * centre), float(b), float(c))
    assert root == pytest.approx(real, abs=1e-7)


@settings(max_examples=200, deadline=None)
@given(
    st.floats(-1e3, -1e-3) | st.floats(0.0, 1e3),
    st.lists(st.floats(1e-3, 1e3), min_size=1, max_size=20),
    st.sampled_from([-1, 1]),
)
def test_arrays_of_roots_are_what_single_ones_are(p: float, sizes: list[float], sign: int) -> None:
    q = sign * np.array(sizes)
    if p >= 0:
        single = [depressed_cubic_roots(p, value)[0] for value in q.tolist()]
        assert only_roots(p, q).tolist() == pytest.approx(single, rel=8e-15)
        return
    three = np.abs(q) < 2 * (-p / 3) ** 1.5 * (1 - 1e-6)
    single = [depressed_cubic_roots(p, value)[1] for value in q[three].tolist()]
    assert middle_roots(p, q[three]).tolist() == pytest.approx(single, rel=1e-11)
