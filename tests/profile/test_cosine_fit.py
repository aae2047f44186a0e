"""Fits of the cosine against figures published for them, linear programming, dense least squares and dense sampling."""

from __future__ import annotations

import dataclasses
from math import factorial, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from plcgen.profile.cosine_fit import (
    CENTRED,
    DERIVATIVES,
    FITS,
    HALF_SINE,
    Law,
    error,
    extremes,
    fit,
    is_monotone,
    peak,
    repaired,
)

Samples = NDArray[np.float64]

LAWS = pytest.mark.parametrize("law", [HALF_SINE, CENTRED], ids=["half-sine", "centred"])
NAMES = pytest.mark.parametrize("name", FITS)
DENSE = np.linspace(0.0, 1.0, 20_001)

# Coefficients and the largest error of each fit as it comes out, computed outside this package.
MINIMAX_B = (0.499743401935, 0.0414450340335, 0.00132874090664, 1.81886674015e-5)
MINIMAX_D = (1.5707858048830252, 0.6458464114185626, 0.0793354081880501, 0.004274801652512575)
SAMPLED_B = (0.49988044327, 0.0415391924395, 0.00134654503307, 1.918157314e-5)  # least squares over 4001 samples
FREE_MINIMAX_B = (0.49985158209, 0.041518035226, 0.00134229470343, 1.8929864852e-5)

# To the last bit, on every machine: golden files hang on them. Who changes a fit on purpose writes these anew.
BITS = {
    ("f", "minimax"): (
        "0x1.ffbcbbfe77f34p-2",
        "0x1.538489360d5edp-5",
        "0x1.5c524ae97bdb0p-10",
        "0x1.3127bb2bf4acap-16",
    ),
    ("f", "least-squares"): (
        "0x1.ffc415bda8661p-2",
        "0x1.53a45f3c5f644p-5",
        "0x1.5ce6c7fe427e4p-10",
        "0x1.32ca89c613e53p-16",
    ),
    ("f", "genetic"): (
        "0x1.0020913bed6f3p-1",
        "0x1.52c7b41f63bb4p-5",
        "0x1.5375eb18260c0p-10",
        "0x1.1004d91f2d6d2p-16",
    ),
    ("f", "taylor"): ("0x1.0120b25e0db64p-1", "0x1.5f7be8f7ab1ccp-5", "0x1.96103e2c98601p-10", "0x1.d6e9c76e09bc2p-16"),
    ("s", "minimax"): ("0x1.921f04bd01a58p+0", "0x1.4aac617e9c7fap-1", "0x1.44f5347978f3ap-4", "0x1.1827454af4e0cp-8"),
    ("s", "least-squares"): (
        "0x1.921f206017bfdp+0",
        "0x1.4aadcc7ca20ccp-1",
        "0x1.4506b5c5acd69p-4",
        "0x1.18a57e2186d01p-8",
    ),
    ("s", "genetic"): ("0x1.921a60201a7dep+0", "0x1.4a94d503af735p-1", "0x1.445b4a35ff9aap-4", "0x1.15aa41a2bde32p-8"),
    ("s", "taylor"): ("0x1.92225250f07d8p+0", "0x1.4adf568a0940ap-1", "0x1.4785f9737c829p-4", "0x1.2b06a323a555ep-8"),
}


def end_of(law: Law) -> float:
    return -1.0 if law is HALF_SINE else 1.0


def start_of(law: Law) -> float:
    return 1.0 if law is HALF_SINE else 0.0


def wanted(law: Law, x: Samples) -> Samples:
    return np.asarray(np.cos(pi * x) if law is HALF_SINE else np.sin(pi / 2 * x))


def largest_error(law: Law, polynomial: Polynomial) -> float:
    return float(np.abs(polynomial(DENSE) - wanted(law, DENSE)).max())


def by_linear_programming(law: Law, *, ended: bool) -> tuple[Polynomial, float]:
    """The best polynomial on a dense grid, and its largest error; `ended` puts it on its mark, at rest.

    Unknown is the difference to the Taylor polynomial, enlarged: the solver's own tolerance is 1e-7.
    """
    optimize = pytest.importorskip("scipy.optimize", reason="SciPy is the oracle of this test: pip install scipy")
    enlarged = 1e4
    base, x = fit("taylor", law).raw, np.linspace(0.0, 1.0, 2001)
    columns = np.stack([x**power for power in law.powers], axis=1)
    miss = enlarged * (wanted(law, x) - base(x))
    bounds = -np.ones((len(x), 1))
    conditions = {
        "A_eq": [[1.0] * 4 + [0.0], [*map(float, law.powers), 0.0]],
        "b_eq": [enlarged * (end_of(law) - base(1.0)), -enlarged * base.deriv()(1.0)],
    }
    found = optimize.linprog(
        c=[0.0] * 4 + [1.0],
        A_ub=np.block([[columns, bounds], [-columns, bounds]]),
        b_ub=np.concatenate([miss, -miss]),
        bounds=[(None, None)] * 5,
        **(conditions if ended else {}),
    )
    assert found.success, found.message
    terms = np.zeros(law.powers[-1] + 1)
    terms[list(law.powers)] = found.x[:4] / enlarged
    return base + Polynomial(terms), float(found.fun) / enlarged


@LAWS
@NAMES
def test_a_fit_is_the_same_to_the_last_bit_on_every_machine(law: Law, name: str) -> None:
    assert tuple(value.hex() for value in fit(name, law).coefficients) == BITS[law.letter, name]


@LAWS
@NAMES
def test_a_cosine_that_rounds_in_another_way_changes_no_bit(law: Law, name: str) -> None:
    """The library's cosine has no say but where the error is largest, and there a few last bits decide nothing."""
    rough = dataclasses.replace(law, exact=lambda x, order: law.exact(x, order) * (1 + 4e-16 * np.sin(1e6 * x)))
    assert fit(name, rough).coefficients == fit(name, law).coefficients


def test_minimax_has_the_published_coefficients() -> None:
    assert fit("minimax", HALF_SINE).coefficients == pytest.approx(MINIMAX_B, rel=1e-8)
    assert fit("minimax", CENTRED).coefficients == pytest.approx(MINIMAX_D, rel=2e-10)


def test_minimax_has_the_published_errors() -> None:
    half_sine, centred = fit("minimax", HALF_SINE).raw, fit("minimax", CENTRED).raw
    assert error(HALF_SINE, half_sine, 0) == pytest.approx(9.2e-5, rel=0.01)
    assert error(CENTRED, centred, 0) == pytest.approx(1.3e-6, rel=0.03)


@LAWS
def test_minimax_is_what_linear_programming_finds(law: Law) -> None:
    polynomial, least = by_linear_programming(law, ended=True)
    found = fit("minimax", law)
    assert error(law, found.raw, 0) == pytest.approx(least, rel=1e-4)
    assert found.raw_coefficients == pytest.approx(law.coefficients(polynomial), rel=2e-5)


@LAWS
def test_minimax_errs_equally_three_times_with_changing_sign(law: Law) -> None:
    """Two coefficients are left by the end: three errors of one size prove the best of its kind."""
    g = fit("minimax", law).raw(DENSE) - wanted(law, DENSE)
    turns = np.flatnonzero((g[1:-1] - g[:-2]) * (g[2:] - g[1:-1]) <= 0) + 1
    largest = [float(g[turn]) for turn in turns if abs(g[turn]) > 0.9 * np.abs(g).max()]
    assert len(largest) == 3
    assert largest == pytest.approx([sign * largest[0] for sign in (1, -1, 1)], rel=1e-4)


def test_without_its_end_the_best_polynomial_would_run_backwards() -> None:
    """Why the default keeps the end: half the error is not worth a speed of the wrong sign."""
    polynomial, least = by_linear_programming(HALF_SINE, ended=False)
    assert HALF_SINE.coefficients(polynomial) == pytest.approx(FREE_MINIMAX_B, rel=1e-4)
    assert least == pytest.approx(4.6e-5, rel=0.01)
    assert error(HALF_SINE, polynomial, 1) == pytest.approx(1.4e-3, rel=0.05)
    assert not is_monotone(HALF_SINE, polynomial)


def test_least_squares_shares_the_digits_of_a_sampled_problem() -> None:
    """A sum over samples weighs the ends more than the integral does; more samples change it less."""
    found = fit("least-squares", HALF_SINE).raw_coefficients
    for value, sampled, relative in zip(found, SAMPLED_B, (3e-7, 3e-6, 2e-5, 8e-5), strict=True):
        assert value == pytest.approx(sampled, rel=relative)


def sampled_least_squares(law: Law, x: Samples) -> tuple[float, ...]:
    scipy_linalg = pytest.importorskip("scipy.linalg", reason="SciPy is the oracle of this test: pip install scipy")
    columns = np.stack([x**power for power in law.powers], axis=1)
    solution = scipy_linalg.lstsq(columns, wanted(law, x) - start_of(law))[0]
    terms = np.zeros(law.powers[-1] + 1)
    terms[list(law.powers)] = solution
    return law.coefficients(Polynomial(terms))


def test_sampled_least_squares_reproduces_the_published_coefficients() -> None:
    assert sampled_least_squares(HALF_SINE, np.linspace(0.0, 1.0, 4001)) == pytest.approx(SAMPLED_B, rel=1e-9)


@LAWS
def test_least_squares_is_the_limit_of_dense_sampling(law: Law) -> None:
    """Samples in the middle of equal intervals: their mean nears the integral with the square of the interval."""
    middles = (np.arange(40_000) + 0.5) / 40_000
    assert fit("least-squares", law).raw_coefficients == pytest.approx(sampled_least_squares(law, middles), rel=1e-7)


def test_least_squares_has_the_published_errors() -> None:
    raw = fit("least-squares", HALF_SINE).raw
    assert error(HALF_SINE, raw, 0) == pytest.approx(1.24e-4, rel=0.01)
    assert error(HALF_SINE, raw, 1) == pytest.approx(2.1e-3, rel=0.02)


def test_taylor_is_exact() -> None:
    assert fit("taylor", HALF_SINE).raw_coefficients == pytest.approx((1 / 2, 1 / 24, 1 / 720, 1 / 40320), rel=4e-16)
    quarter = tuple((pi / 2) ** power / factorial(power) for power in (1, 3, 5, 7))
    assert fit("taylor", CENTRED).raw_coefficients == pytest.approx(quarter, rel=4e-16)


def test_taylor_ends_short_and_still_in_motion() -> None:
    raw = fit("taylor", HALF_SINE).raw
    assert error(HALF_SINE, raw, 0) == pytest.approx(2.4e-2, rel=0.01)
    assert error(HALF_SINE, raw, 1) == pytest.approx(7.5e-2, rel=0.01)
    assert (1.0 - (raw(0.0) - raw(1.0)) / 2) == pytest.approx(0.012, rel=0.01)  # of the distance
    assert raw.deriv()(1.0) / pi == pytest.approx(0.075, rel=0.01)  # where the speed is -f'
    assert not is_monotone(HALF_SINE, raw)


@LAWS
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_genetic_fit_lies_between_the_best_and_taylor(law: Law, seed: int) -> None:
    genetic, taylor = fit("genetic", law, seed).raw, fit("taylor", law).raw
    assert error(law, fit("minimax", law).raw, 0) < error(law, genetic, 0) < error(law, taylor, 0)
    assert error(law, genetic, 1) < error(law, taylor, 1) / 3


@LAWS
def test_only_minimax_needs_no_repair(law: Law) -> None:
    assert {name: is_monotone(law, fit(name, law).raw) for name in FITS} == {
        "minimax": True,
        "least-squares": False,
        "genetic": False,
        "taylor": False,
    }


@LAWS
@NAMES
def test_what_is_emitted_ends_on_its_mark_and_never_turns(law: Law, name: str) -> None:
    found = fit(name, law).repaired
    assert found(0.0) == start_of(law)
    assert found(1.0) == pytest.approx(end_of(law), abs=2e-15)
    assert found.deriv()(1.0) == pytest.approx(0.0, abs=2e-14)
    assert is_monotone(law, found)
    values = found(DENSE) * end_of(law)
    assert (np.diff(values) >= -1e-15).all()


@LAWS
@NAMES
def test_repairing_twice_changes_nothing(law: Law, name: str) -> None:
    once = fit(name, law).repaired
    twice = repaired(law, once)
    assert law.coefficients(twice) == pytest.approx(law.coefficients(once), rel=1e-11)
    assert np.abs(twice(DENSE) - once(DENSE)).max() < 2e-14


@LAWS
@NAMES
def test_repaired_is_the_nearest_that_ends_on_its_mark(law: Law, name: str) -> None:
    """Whatever is added without moving the end is at right angles to what was repaired away."""
    found = fit(name, law)
    away = found.raw - found.repaired
    for free in law.free:
        product, squares = (away * free).integ(), (free * free).integ()
        assert product(1.0) / squares(1.0) == pytest.approx(0.0, abs=1e-11)


@LAWS
@NAMES
def test_powers_and_signs_are_of_the_claim(law: Law, name: str) -> None:
    """f = 1 - b1 t^2 + b2 t^4 - b3 t^6 + b4 t^8 and s = d1 y - d2 y^3 + d3 y^5 - d4 y^7, written out."""
    found = fit(name, law)
    for polynomial, coefficients in ((found.raw, found.raw_coefficients), (found.repaired, found.coefficients)):
        c1, c2, c3, c4 = coefficients
        if law is HALF_SINE:
            t = pi * DENSE
            written = 1 - c1 * t**2 + c2 * t**4 - c3 * t**6 + c4 * t**8
        else:
            y = DENSE
            written = c1 * y - c2 * y**3 + c3 * y**5 - c4 * y**7
        assert np.abs(polynomial(DENSE) - written).max() < 1e-13
        assert min(coefficients) > 0.0


@LAWS
@NAMES
@pytest.mark.parametrize("order", range(DERIVATIVES))
def test_errors_of_derivatives_by_differences(law: Law, name: str, order: int) -> None:
    """Derivatives of the exact law by its addition theorem, of the polynomial by differences of its values."""
    polynomial = fit(name, law).repaired
    quarter_turn, factor = (0.5, 1.0) if law is HALF_SINE else (1.0, pi / 2)
    x, step = DENSE, 1e-3
    exact = factor**order * wanted(law, x + order * quarter_turn)
    offsets = np.arange(order + 1) - order / 2
    weights = [(-1.0) ** (order - k) * factorial(order) / factorial(k) / factorial(order - k) for k in range(order + 1)]
    differences = sum(w * polynomial(x + o * step) for w, o in zip(weights, offsets, strict=True)) / step**order
    wrong = np.abs(differences / law.span**order - exact).max()
    assert error(law, polynomial, order) == pytest.approx(wrong, rel=0.02, abs=2e-5)


def test_smoothness_of_the_default_law() -> None:
    """Largest s' and s'' are those of the cosine itself within a few thousandths."""
    found = fit("minimax", CENTRED).repaired
    assert peak(found.deriv()) == pytest.approx(pi / 2, rel=1e-5)
    assert peak(found.deriv(2)) == pytest.approx(pi**2 / 4, rel=1e-3)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.floats(-10, 10, allow_subnormal=False).map(lambda c: round(c, 6)), min_size=1, max_size=9))
def test_peak_and_extremes_against_dense_sampling(coefficients: list[float]) -> None:
    polynomial = Polynomial(coefficients)
    values = polynomial(DENSE)
    low, high = extremes(polynomial)
    size = sum(map(abs, coefficients))
    assert low == pytest.approx(values.min(), abs=1e-6 * size)
    assert high == pytest.approx(values.max(), abs=1e-6 * size)
    assert low <= values.min() + 1e-9 * size
    assert high >= values.max() - 1e-9 * size
    assert peak(polynomial) == max(-low, high)


@LAWS
@NAMES
def test_extremes_of_the_derivatives_of_the_laws(law: Law, name: str) -> None:
    for order in range(4):
        polynomial = fit(name, law).repaired.deriv(order) if order else fit(name, law).repaired
        values = polynomial(DENSE)
        assert extremes(polynomial) == pytest.approx((values.min(), values.max()), rel=1e-6, abs=1e-6)


def test_a_law_that_turns_is_not_monotone() -> None:
    overshooting = Polynomial([0.0, 3.0, 0.0, -2.0])  # s(1) = 1, turns at 0.71
    assert not is_monotone(CENTRED, overshooting)
    assert is_monotone(CENTRED, CENTRED.plain)
    assert is_monotone(HALF_SINE, HALF_SINE.plain)
    assert not is_monotone(HALF_SINE, 2 * HALF_SINE.plain - 1 + Polynomial([0.0, 0.0, 3.0]))


@LAWS
def test_free_polynomials_leave_the_end_alone(law: Law) -> None:
    assert law.plain(1.0) == end_of(law)
    assert law.plain(0.0) == start_of(law)
    assert law.plain.deriv()(1.0) == 0.0
    for free in law.free:
        assert (free(0.0), free(1.0), free.deriv()(1.0)) == (0.0, 0.0, 0.0)


@LAWS
def test_coefficients_and_polynomial_are_one_another_backwards(law: Law) -> None:
    written = (0.7, 0.5, 0.3, 0.1)
    assert law.coefficients(law.polynomial(np.array(written))) == pytest.approx(written, rel=1e-14)
