"""The genetic search: the same bits from the same seed anywhere, against plain Python and the platform's cosine."""

from __future__ import annotations

from math import cos, factorial, pi, sin
from random import Random

import numpy as np
import pytest

from plcgen.profile import cosine_genetic
from plcgen.profile.cosine_genetic import BOX, GENERATIONS, INTERVALS, POPULATION, fitness, genetic_factors

LETTERS = pytest.mark.parametrize("letter", ["f", "s"])
POWERS = {"f": (2, 4, 6, 8), "s": (1, 3, 5, 7)}

# To the last bit, on every machine: who changes the search on purpose writes these anew.
FACTORS = {
    ("f", 1): ("0x1.003c970342b4fp+0", "0x1.fdee826cfe477p-1", "0x1.e6ca64340f0fdp-1", "0x1.690e5072d0415p-1"),
    ("f", 2): ("0x1.02df8a3a731ecp+0", "0x1.073de346f3b04p+0", "0x1.099056ab597c5p+0", "0x1.b37179460d4c0p-1"),
    ("s", 1): ("0x1.fff8133e691bap-1", "0x1.ffab26aa14749p-1", "0x1.fb39b82e4660cp-1", "0x1.c2847ffd9945fp-1"),
    ("s", 2): ("0x1.fffabc5f4ff58p-1", "0x1.ffabd51375e87p-1", "0x1.fb244b6a37916p-1", "0x1.c2182ac1d516dp-1"),
}


def cost_in_plain_python(letter: str, factors: tuple[float, ...]) -> float:
    """Sum of the largest |g|, |g'|, |g''|, |g'''| on the grid, term by term."""
    return sum(
        max(abs(value_of(letter, factors, order, i / INTERVALS) - exact(letter, order, i / INTERVALS)) for i in GRID)
        for order in range(4)
    )


GRID = range(INTERVALS + 1)


def value_of(letter: str, factors: tuple[float, ...], order: int, x: float) -> float:
    """Of the polynomial with Taylor's coefficients times the factors, derived by t = pi x or by y = x."""
    argument = pi * x if letter == "f" else x
    total = 1.0 if letter == "f" and order == 0 else 0.0
    for index, (power, factor) in enumerate(zip(POWERS[letter], factors, strict=True)):
        if power < order:
            continue
        quarter = 1.0 if letter == "f" else pi / 2
        sign = -((-1.0) ** index) if letter == "f" else (-1.0) ** index
        total += sign * factor * quarter**power * argument ** (power - order) / factorial(power - order)
    return total


def exact(letter: str, order: int, x: float) -> float:
    if letter == "f":
        return (cos, lambda t: -sin(t), lambda t: -cos(t), sin)[order](pi * x)
    quarter = pi / 2
    return (sin, cos, lambda y: -sin(y), lambda y: -cos(y))[order](quarter * x) * quarter**order


@pytest.mark.parametrize(("letter", "seed"), FACTORS)
def test_the_same_seed_gives_the_same_bits(letter: str, seed: int) -> None:
    assert tuple(factor.hex() for factor in genetic_factors(letter, seed)) == FACTORS[letter, seed]


@LETTERS
def test_a_search_of_its_own_gives_the_same_bits(letter: str) -> None:
    """Not from the cache, and whatever the state of the shared random numbers."""
    assert genetic_factors.__wrapped__(letter, 1) == genetic_factors(letter, 1)


@LETTERS
def test_another_seed_gives_another_result(letter: str) -> None:
    assert len({genetic_factors(letter, seed) for seed in range(1, 6)}) == 5


@LETTERS
@pytest.mark.parametrize("seed", range(1, 7))
def test_the_result_is_better_than_taylor_and_than_chance(letter: str, seed: int) -> None:
    problem = cosine_genetic._problem(letter)
    found = genetic_factors(letter, seed)
    random = Random(seed)
    chance = np.array([[1.0 + BOX * random.uniform(-1.0, 1.0) for _ in range(4)] for _ in range(2000)])
    cost, taylor = fitness(np.array([found, (1.0,) * 4]), problem)
    assert cost < taylor / 4, found
    assert cost < fitness(chance, problem).min(), found


@LETTERS
def test_fitness_is_what_plain_python_makes_of_it(letter: str) -> None:
    random = Random(7)
    people = [tuple(random.uniform(0.5, 1.5) for _ in range(4)) for _ in range(50)]
    people += [(1.0,) * 4, genetic_factors(letter, 1)]
    costs = fitness(np.array(people), cosine_genetic._problem(letter))
    for person, cost in zip(people, costs, strict=True):
        assert cost == pytest.approx(cost_in_plain_python(letter, person), rel=1e-11), person


@LETTERS
def test_fitness_of_one_does_not_depend_on_the_others(letter: str) -> None:
    """What is summed of an individual is summed in one order, however many there are."""
    random = Random(8)
    people = np.array([[random.uniform(0.5, 1.5) for _ in range(4)] for _ in range(POPULATION)])
    problem = cosine_genetic._problem(letter)
    alone = [float(fitness(person[None, :], problem)[0]) for person in people]
    assert alone == fitness(people, problem).tolist()


@LETTERS
@pytest.mark.parametrize("order", range(4))
def test_table_of_the_law_is_that_of_the_platform(letter: str, order: int) -> None:
    terms, wanted = cosine_genetic._derivative(letter, order)
    assert terms.shape == (4, INTERVALS + 1)
    fixed = 1.0 if letter == "f" and order == 0 else 0.0
    for i in GRID:
        assert wanted[i] + fixed == pytest.approx(exact(letter, order, i / INTERVALS), rel=4e-15, abs=2e-15), i
        for index in range(4):
            unit = tuple(1.0 if other == index else 0.0 for other in range(4))
            term = value_of(letter, unit, order, i / INTERVALS) - fixed
            assert terms[index][i] == pytest.approx(term, rel=1e-14, abs=4e-16), (i, index)


def test_as_many_evaluations_as_the_comment_says() -> None:
    """Bits above hang on these too."""
    assert (POPULATION, GENERATIONS, INTERVALS) == (80, 250, 64)
