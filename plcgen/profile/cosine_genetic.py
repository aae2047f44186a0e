"""The genetic search of claims 4 and 5, the same to the last bit on every machine.

Individuals are four real genes, each the factor on a coefficient of Taylor. The fitness is the sum over g and its
first three derivatives (claim 5: g = f - cos "and its derivatives") of the largest absolute value on 65 points; the
paper gives neither weights nor a grid. Children blend two parents, each the better of two (BLX-alpha), and mutate
within a box that shrinks; the best individual of a generation lives on.

Only + - * and comparisons of float64 touch the genes, random numbers come from Python's Mersenne Twister, and cos is
summed in decimals: no library function that a machine rounds in its own way has a say.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction
from functools import cache
from math import factorial
from random import Random

import numpy as np
from numpy.typing import NDArray

from plcgen.profile.exactly import DIGITS, PI, cosine

Samples = NDArray[np.float64]

POPULATION, GENERATIONS = 80, 250
INTERVALS = 64
BOX = 0.5  # genes begin in 1 - BOX .. 1 + BOX
BLEND = 0.5  # alpha: how far beyond its parents a child may lie, in their distance
MUTATION, SHRINKING = 0.25, 0.97  # probability for each gene; factor on the box of mutations in each generation
# By law: the first power, the sign of its term, and the constant before it. cos t on 0 .. pi, sin(pi y/2) on 0 .. 1.
_POWERS = {"f": (2, 4, 6, 8), "s": (1, 3, 5, 7)}


@cache
def genetic_factors(letter: str, seed: int) -> tuple[float, ...]:
    """Factors on the Taylor coefficients of the law `f` or `s`, after POPULATION x GENERATIONS evaluations."""
    random = Random(seed)
    problem = _problem(letter)
    people = np.array([[1.0 + BOX * (2.0 * random.random() - 1.0) for _ in range(4)] for _ in range(POPULATION)])
    reach = BOX
    for _ in range(GENERATIONS):
        costs = fitness(people, problem)
        best = people[int(np.argmin(costs))]
        people = _children(people, costs, reach, random)
        people[0] = best
        reach = reach * SHRINKING
    return tuple(map(float, people[int(np.argmin(fitness(people, problem)))]))


def fitness(people: Samples, problem: tuple[tuple[Samples, Samples], ...]) -> Samples:
    """Sum of the largest |g|, |g'|, |g''|, |g'''| of each individual; shape (individuals,)."""
    total = np.zeros(len(people))
    for terms, wanted in problem:
        value = np.zeros((len(people), INTERVALS + 1))
        for gene, term in zip(people.T, terms, strict=True):
            value = value + gene[:, None] * term[None, :]
        total = total + np.abs(value - wanted[None, :]).max(axis=1)
    return total


def _children(people: Samples, costs: Samples, reach: float, random: Random) -> Samples:
    children = np.empty_like(people)
    for child in children:
        mother, father = people[_better(costs, random)], people[_better(costs, random)]
        for gene in range(4):
            low, high = min(mother[gene], father[gene]), max(mother[gene], father[gene])
            width = high - low
            value = low - BLEND * width + (1.0 + 2.0 * BLEND) * width * random.random()
            if random.random() < MUTATION:
                value = value + reach * (2.0 * random.random() - 1.0)
            child[gene] = value
    return children


def _better(costs: Samples, random: Random) -> int:
    """The better of two that meet by chance."""
    first, second = int(random.random() * POPULATION), int(random.random() * POPULATION)
    return first if costs[first] <= costs[second] else second


@cache
def _problem(letter: str) -> tuple[tuple[Samples, Samples], ...]:
    """For g and each derivative by t or y: the four Taylor terms on the grid, and what their sum should be."""
    return tuple(_derivative(letter, order) for order in range(4))


def _derivative(letter: str, order: int) -> tuple[Samples, Samples]:
    grid = [Fraction(i, INTERVALS) for i in range(INTERVALS + 1)]
    terms = [[_term(letter, power, order, x) for x in grid] for power in _POWERS[letter]]
    fixed = 1.0 if letter == "f" and order == 0 else 0.0
    return np.array(terms), np.array([_wanted(letter, order, x) - fixed for x in grid])


def _term(letter: str, power: int, order: int, x: Fraction) -> float:
    """The Taylor term with this power, derived, at a share x of the interval; rounded once."""
    if order > power:
        return 0.0
    left = power - order
    with localcontext() as context:
        context.prec = DIGITS
        # (angle)^power/power!, where the angle is pi x or pi x/2, derived by t = pi x or by y = x
        at = Decimal(x.numerator) / x.denominator * PI
        scale = Decimal(1)
        if letter == "s":
            at, scale = at / 2, (PI / 2) ** order
        value = scale / factorial(left)
        for _ in range(left):
            value *= at
        return float(value if _sign(power) > 0 else -value)


def _sign(power: int) -> int:
    """Of the Taylor terms of cos (even) and sin (odd)."""
    return 1 if power // 2 % 2 == 0 else -1


def _wanted(letter: str, order: int, x: Fraction) -> float:
    """Derivative of cos(pi x) by pi x, or of sin(pi x/2) by x; each quarter turn more is one order."""
    turns = x + Fraction(order, 2) if letter == "f" else (x + order - 1) / 2
    with localcontext() as context:
        context.prec = DIGITS
        scale = (PI / 2) ** order if letter == "s" else Decimal(1)
        return float(scale * cosine(turns))
