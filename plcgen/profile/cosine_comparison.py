"""The fits of claim 3 side by side: errors, monotony, and what each does to the end of a ramp."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from numpy.polynomial import Polynomial

from plcgen.profile.cosine_fit import CENTRED, DERIVATIVES, FITS, HALF_SINE, Law, error, fit, is_monotone

Cell = str | float
Rows = tuple[tuple[Cell, ...], ...]
NOTHING = 1e-12


def comparisons(seed: int) -> Iterator[tuple[str, tuple[str, ...], Rows]]:
    """Title, headings and rows of a table for each law: a row for each fit, as it is and as it is emitted."""
    for law, title in (
        (HALF_SINE, "Fits of f about cos t on 0..pi: v = -f'"),
        (CENTRED, "Fits of s about sin(pi y/2) on -1..1: v = v0 + dv/2 (1 + s)"),
    ):
        letter, end = law.letter, law.argument
        errors = tuple(f"max |g{chr(39) * order}|" for order in range(DERIVATIVES))
        letters = tuple(f"{'b' if law is HALF_SINE else 'd'}{index}" for index in range(1, 5))
        headings = ("fit", *letters, *errors, "ends short by", f"{letter}'({_end(law)})/max", "monotone")
        yield f"{title}; g = error by {end}", headings, tuple(_rows(law, seed))


def _end(law: Law) -> str:
    return "pi" if law is HALF_SINE else "1"


def _rows(law: Law, seed: int) -> Iterator[tuple[Cell, ...]]:
    for name in FITS:
        found = fit(name, law, seed)
        yield (name, *_figures(law, found.raw, found.raw_coefficients))
        if name != "minimax":  # which ends on its mark
            yield (f"{name}, repaired", *_figures(law, found.repaired, found.coefficients))


def _figures(law: Law, polynomial: Polynomial, coefficients: tuple[float, ...]) -> tuple[Cell, ...]:
    """Short of the whole change of speed (s) or distance (f), and the slope at the end against the largest."""
    start, end, wanted = float(polynomial(0.0)), float(polynomial(1.0)), -1.0 if law is HALF_SINE else 1.0
    short = (1.0 - (start - end) / (1.0 - wanted)) if law is HALF_SINE else 1.0 - end
    largest = pi if law is HALF_SINE else pi / 2
    slope = float(polynomial.deriv()(1.0)) / largest * (-1.0 if law is HALF_SINE else 1.0)
    return (
        *(float(f"{value:.9g}") for value in coefficients),
        *(_short(error(law, polynomial, order)) for order in range(DERIVATIVES)),
        _short(short),
        _short(slope),
        "yes" if is_monotone(law, polynomial) else "no",
    )


def _short(value: float) -> float:
    """Three digits; what rounding leaves of 0 is 0."""
    return float(f"{value:.3g}") if abs(value) > NOTHING else 0.0
