"""REAL literals: the nearest 32-bit value, the shortest spelling, and a point in every one of them."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.render.literals import real_literal, stl_real_literal

# What both dialects take: digits on both sides of the point, an exponent with a sign.
REAL = re.compile(r"-?[0-9]+\.[0-9]+(E[+-][0-9]{2})?")
STL_REAL = re.compile(r"-?[0-9]\.[0-9]{6,8}e[+-][0-9]{3}")
SMALLEST, LARGEST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.0"),
        (-0.0, "-0.0"),
        (1.0, "1.0"),
        (12, "12.0"),
        (-0.5, "-0.5"),
        (0.1, "0.1"),
        (1 / 3, "0.33333334"),
        (105.20833333333333, "105.208336"),
        (600000.0, "600000.0"),
        (0.0001, "0.0001"),
        (0.000099, "9.9E-05"),
        (1.5e-7, "1.5E-07"),
        (1e-10, "1.0E-10"),
        (9999999.0, "9999999.0"),
        (1e7, "1.0E+07"),
        (16777217.0, "1.6777216E+07"),
        (3e10, "3.0E+10"),
        (LARGEST, "3.4028235E+38"),
        (SMALLEST, "1.1754944E-38"),
    ],
)
def test_spelling(value: float, text: str) -> None:
    assert real_literal(value) == text


@pytest.mark.parametrize(
    "value", [float("nan"), float("inf"), float("-inf"), 3.5e38, -1e300, 1e-39, -1e-40, 1e-50, 5e-324]
)
@pytest.mark.parametrize("spell", [real_literal, stl_real_literal])
def test_values_that_real_cannot_hold(spell: Callable[[float], str], value: float) -> None:
    with pytest.raises(ValueError, match=re.escape(f"{value!r} is out of the range of REAL")):
        spell(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0.000000e+000"),
        (-0.0, "-0.000000e+000"),
        (10.0, "1.000000e+001"),
        (-0.5, "-5.000000e-001"),
        (0.1, "1.000000e-001"),
        (1 / 3, "3.3333334e-001"),
        (105.20833333333333, "1.05208336e+002"),
        (600000.0, "6.000000e+005"),
        (1e-10, "1.000000e-010"),
        (16777217.0, "1.6777216e+007"),
        (LARGEST, "3.4028235e+038"),
        (SMALLEST, "1.1754944e-038"),
    ],
)
def test_spelling_in_stl(value: float, text: str) -> None:
    assert stl_real_literal(value) == text


def check(value: float) -> None:
    """Both spellings name the nearest single, whether they are read exactly or by way of a double.

    From 2^25 on the shortest text may lie midway between two singles: the even one is meant, as IEEE 754 rounds.
    """
    names_the_single(real_literal(value), REAL, value)
    names_the_single(stl_real_literal(value), STL_REAL, value)


def names_the_single(text: str, form: re.Pattern[str], value: float) -> None:
    single = np.float32(value)
    assert form.fullmatch(text), text
    assert struct.pack("f", np.float32(float(text))) == struct.pack("f", single), text
    with np.errstate(over="ignore"):
        neighbours = [float(np.nextafter(single, np.float32(side))) for side in (-np.inf, np.inf)]
    exact = Fraction(text)
    away = [abs(exact - Fraction(neighbour)) for neighbour in neighbours if np.isfinite(neighbour)]
    assert abs(exact - Fraction(float(single))) <= min(away), text


@settings(max_examples=1000, deadline=None)
@given(st.floats(SMALLEST, LARGEST) | st.floats(1e-6, 1e6), st.booleans())
def test_round_trip(value: float, negative: bool) -> None:
    check(-value if negative else value)


@pytest.mark.parametrize("seed", [1, 2])
def test_round_trip_of_any_bits(seed: int) -> None:
    """Singles with random bits reach every exponent alike."""
    bits = np.random.default_rng(seed).integers(0, 2**32, 2000, dtype=np.uint32)
    singles = bits.view(np.float32)
    for single in singles[np.isfinite(singles) & (np.abs(singles) >= SMALLEST)]:
        check(float(single))


@pytest.mark.parametrize("power", range(-126, 128))
def test_powers_of_two_and_their_neighbours(power: int) -> None:
    single = np.float32(2.0**power)
    for value in (single, np.nextafter(single, np.float32(np.inf)), -single):
        check(float(value))


@settings(max_examples=300, deadline=None)
@given(st.floats(SMALLEST, LARGEST))
def test_no_shorter_spelling_names_the_same_single(value: float) -> None:
    digits = real_literal(value).split("E")[0].replace(".", "").strip("0")
    if len(digits) > 1:
        shorter = f"{float(np.float32(value)):.{len(digits) - 2}e}"
        assert np.float32(float(shorter)) != np.float32(value)
