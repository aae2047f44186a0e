"""The table of fits: a row for each, a column for each figure, and the figures of a reader's own calculation."""

from __future__ import annotations

from math import cos, pi, sin

import pytest

from plcgen.profile.cosine_comparison import comparisons

Table = dict[str, dict[str, str | float]]

TITLES = (
    "Fits of f about cos t on 0..pi: v = -f'; g = error by t",
    "Fits of s about sin(pi y/2) on -1..1: v = v0 + dv/2 (1 + s); g = error by y",
)
ROWS = [
    "minimax",
    "least-squares",
    "least-squares, repaired",
    "genetic",
    "genetic, repaired",
    "taylor",
    "taylor, repaired",
]
ERRORS = ["max |g|", "max |g'|", "max |g''|", "max |g'''|"]


def tables(seed: int = 1) -> tuple[Table, Table]:
    """Of f and of s: figures by row and heading."""
    half_sine, centred = (
        {str(row[0]): dict(zip(headings, row, strict=True)) for row in rows}
        for _title, headings, rows in comparisons(seed)
    )
    return half_sine, centred


def test_titles_headings_and_rows() -> None:
    found = list(comparisons(1))
    assert tuple(title for title, _headings, _rows in found) == TITLES
    assert [list(headings) for _title, headings, _rows in found] == [
        ["fit", "b1", "b2", "b3", "b4", *ERRORS, "ends short by", "f'(pi)/max", "monotone"],
        ["fit", "d1", "d2", "d3", "d4", *ERRORS, "ends short by", "s'(1)/max", "monotone"],
    ]
    assert [[row[0] for row in rows] for _title, _headings, rows in found] == [ROWS, ROWS]


@pytest.mark.parametrize(
    ("row", "figures"),
    [
        ("taylor", {"b1": 0.5, "b2": 0.0416666667, "b3": 0.00138888889, "b4": 2.48015873e-05}),
        ("taylor", {"max |g|": 0.024, "max |g'|": 0.0752, "ends short by": 0.012, "monotone": "no"}),
        ("least-squares", {"max |g|": 0.000125, "max |g'|": 0.00212, "monotone": "no"}),
        ("minimax", {"b1": 0.499743402, "max |g|": 9.17e-05, "monotone": "yes"}),
    ],
)
def test_figures_of_the_half_sine(row: str, figures: dict[str, str | float]) -> None:
    half_sine, _centred = tables()
    assert {heading: half_sine[row][heading] for heading in figures} == figures


@pytest.mark.parametrize(
    ("row", "figures"),
    [
        ("taylor", {"d1": 1.57079633, "max |g|": 0.000157, "ends short by": 0.000157, "monotone": "no"}),
        ("minimax", {"d1": 1.5707858, "max |g|": 1.28e-06, "max |g'|": 1.35e-05, "monotone": "yes"}),
    ],
)
def test_figures_of_the_centred_law(row: str, figures: dict[str, str | float]) -> None:
    _half_sine, centred = tables()
    assert {heading: centred[row][heading] for heading in figures} == figures


def test_end_of_taylor_from_its_series() -> None:
    """Ends where the series ends: short of 2 for f, of 1 for s, and not at rest."""
    half_sine, centred = (table["taylor"] for table in tables())
    f = 1 - pi**2 / 2 + pi**4 / 24 - pi**6 / 720 + pi**8 / 40320
    slope = -pi + pi**3 / 6 - pi**5 / 120 + pi**7 / 5040
    assert f - cos(pi) == pytest.approx(0.024, abs=1e-4)
    assert float(half_sine["ends short by"]) == pytest.approx((f + 1) / 2, rel=0.01)
    assert float(half_sine["f'(pi)/max"]) * pi == pytest.approx(-slope * pi, rel=0.01)
    h = pi / 2
    s = h - h**3 / 6 + h**5 / 120 - h**7 / 5040
    assert float(centred["ends short by"]) == pytest.approx(sin(h) - s, rel=0.01)
    assert float(centred["s'(1)/max"]) == pytest.approx(1 - h**2 / 2 + h**4 / 24 - h**6 / 720, rel=0.01)


def test_what_is_emitted_ends_on_its_mark_at_rest() -> None:
    """Zero, and no rounding that another machine would print otherwise."""
    for table, slope in zip(tables(), ("f'(pi)/max", "s'(1)/max"), strict=True):
        for row in ("minimax", "least-squares, repaired", "genetic, repaired", "taylor, repaired"):
            ends = [table[row][heading] for heading in ("ends short by", slope, "monotone")]
            assert ends == [0.0, 0.0, "yes"], row


def test_minimax_errs_least_and_the_seed_moves_the_genetic_rows_only() -> None:
    for one, two in zip(tables(1), tables(2), strict=True):
        least = min(ROWS, key=lambda row: float(one[row]["max |g|"]))
        assert least == "minimax"
        moved = [row for row in ROWS if one[row] != two[row]]
        assert moved == ["genetic", "genetic, repaired"]
