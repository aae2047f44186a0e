"""The law over travel as the generated function computes it, in 32 bits, against bisection in 64 bits."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from plcgen import pipeline
from plcgen.job import read_job
from plcgen.loading import load
from plcgen.plc.machine import Machine
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

JOB = Path(__file__).parents[2] / "golden" / "main-shaft" / "job.toml"
TARGETS = {"s7-300-scl": "FC100", "tia-scl": "MainShaft_Velocity"}
SLOW = (0.0, 0.01, 0.5, 2.0, 5.0, 12.0)
CHANGE = (0.02, 0.5, 11.5)
ACCELERATION = (0.3, 0.75)
JERK = (0.1, 0.5, 2.0)
PLACES = 60

# Equation (7) as the paper prints it. Its second cube root is taken of the absolute value: what stands there is
# rounding noise of either sign, and LN of it would be a fault.
PRINTED = """
FUNCTION FC7 : REAL
VAR_INPUT x, lo, m : REAL; END_VAR
VAR_TEMP root, first, second, t : REAL; END_VAR
BEGIN
  root := SQRT(9.0 * x * x / (m * m) + 8.0 * lo * lo * lo / (m * m * m));
  first := 3.0 * x / m + root;
  second := ABS(root - 3.0 * x / m);
  t := EXP(LN(first) / 3.0);
  IF second > 0.0 THEN
    t := t - EXP(LN(second) / 3.0);
  END_IF;
  FC7 := lo + m * t * t / 2.0;
END_FUNCTION
"""


def single(value: float) -> float:
    return float(np.float32(value))


@cache
def machine(target: str) -> Machine:
    plan = pipeline.prepare(read_job(JOB))
    return Machine(load(target, pipeline.sources(plan, target)))


def bisected(travel: Callable[[float], float], wanted: float, high: float) -> float:
    """The time at which a travel that grows with time is reached."""
    low = 0.0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if travel(middle) < wanted else (low, middle)
    return (low + high) / 2


def law(x: float, lo: float, hi: float, peak: float, m: float, t1: float, length: float) -> float:
    """v(x) of the three parts, from the travel over time of each; no cubic equation is solved."""
    slow_part = lo * t1 + m * t1**3 / 6
    fast_part = hi * t1 - m * t1**3 / 6
    if x < slow_part:
        t = bisected(lambda t: lo * t + m * t**3 / 6, x, t1)
        return lo + m * t * t / 2
    if length - x < fast_part:
        t = bisected(lambda t: hi * t - m * t**3 / 6, length - x, t1)
        return hi - m * t * t / 2
    corner = lo + m * t1 * t1 / 2
    return float(np.sqrt(corner**2 + 2 * peak * (x - slow_part)))


def transitions() -> list[tuple[float, ...]]:
    """lo, hi, a_p, m, t1, L of full and short transitions, as 32-bit numbers."""
    found = []
    for lo, change, a, m in product(SLOW, CHANGE, ACCELERATION, JERK):
        short = change < a * a / m
        t1 = np.sqrt(change / m) if short else a / m
        peak = m * t1
        length = (2 * lo + change) / 2 * (change / peak + t1)
        found.append(tuple(map(single, (lo, lo + change, peak, m, t1, length))))
    return found


def worst_error(velocity: Callable[..., float], cases: list[tuple[float, ...]], share: float = 1.0) -> float:
    """Largest relative error wherever v > 1e-3 m/s, over places that crowd both ends."""
    worst = 0.0
    for lo, hi, peak, m, t1, length in cases:
        ends = np.geomspace(1e-6, length * share, PLACES)
        for x in map(single, (*ends, *(length - ends) * (share == 1.0))):
            wanted = law(x, lo, hi, peak, m, t1, length) if 0.0 < x < length else 0.0
            if wanted > 1e-3:
                worst = max(worst, abs(velocity(x, lo, hi, peak, m, t1, length) / wanted - 1))
    return worst


@pytest.mark.parametrize("target", TARGETS)
def test_velocity_over_travel_is_exact_to_a_millionth(target: str) -> None:
    """The figure promised in README, Accuracy, and on full trips named `law_error` by the verification."""
    tested = machine(target)
    worst = worst_error(lambda *arguments: float(tested.call(TARGETS[target], arguments=arguments)), transitions())
    assert worst < 1e-6
    assert not tested.faults


def test_printed_equation_is_four_orders_worse() -> None:
    """The seed's (7), where the slow part is all there is: 9e-3 of its value is lost to cancellation."""
    tested = Machine(lower(parse(SourceText("printed.scl", PRINTED), CLASSIC), CLASSIC))
    slow_parts: list[tuple[float, ...]] = [
        (lo, hi, peak, m, t1, lo * t1 + m * t1**3 / 6) for lo, hi, peak, m, t1, _ in transitions()
    ]
    worst = worst_error(
        lambda x, lo, _hi, _peak, m, *_rest: float(tested.call("FC7", arguments=(x, lo, m))), slow_parts, share=0.99
    )
    assert 1e-3 < worst < 1e-1
