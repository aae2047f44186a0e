"""The integrator: exact for constant jerk, and able to find what is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from plcgen.profile.integrator import integrate
from plcgen.profile.reference import Phase

UP_AND_DOWN = [Phase(1.0, jerk, 1) for jerk in (2.0, -2.0, -2.0, 2.0)]


def random_phases(random: np.random.Generator, count: int, longest: float) -> list[Phase]:
    return [Phase(float(random.uniform(0.0, longest)), float(random.uniform(-5.0, 5.0)), 1) for _ in range(count)]


def test_seven_numbers_by_hand() -> None:
    proof = integrate(UP_AND_DOWN)
    assert (proof.duration, proof.highest_jerk) == (4.0, 2.0)
    assert proof.travel == pytest.approx(4.0, rel=1e-14)
    assert (proof.end_velocity, proof.end_acceleration) == pytest.approx((0.0, 0.0), abs=1e-14)
    assert (proof.lowest_velocity, proof.highest_velocity) == pytest.approx((0.0, 2.0), abs=1e-14)
    assert (proof.lowest_acceleration, proof.highest_acceleration) == pytest.approx((-2.0, 2.0))


@pytest.mark.parametrize("seed", range(5))
def test_steps_do_not_matter(seed: int) -> None:
    """The rules are exact for constant jerk: one step a phase gives what a thousand give."""
    random = np.random.default_rng(seed)
    phases = random_phases(random, 20, 10.0)
    coarse, fine = integrate(phases, 1), integrate(phases, 1000)
    assert coarse.travel == pytest.approx(fine.travel, rel=1e-10)
    assert coarse.end_velocity == pytest.approx(fine.end_velocity, rel=1e-9)
    assert coarse.end_acceleration == pytest.approx(fine.end_acceleration, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_end_state_is_the_exact_polynomial(seed: int) -> None:
    """Against repeated antiderivatives of one phase after another."""
    random = np.random.default_rng(seed)
    phases = random_phases(random, 10, 3.0)
    x = v = a = 0.0
    for phase in phases:
        state = np.polynomial.Polynomial([x, v, a / 2, phase.jerk / 6])
        x, v, a = (float(state.deriv(order)(phase.duration)) for order in range(3))
    proof = integrate(phases)
    assert (proof.travel, proof.end_velocity, proof.end_acceleration) == pytest.approx((x, v, a), rel=1e-11)


@pytest.mark.parametrize(
    ("place", "change", "field", "wrong"),
    [
        (0, Phase(1.1, 2.0, 1), "end_acceleration", 0.2),
        (1, Phase(1.0, -2.5, 1), "end_acceleration", -0.5),
        (2, Phase(1.0, -3.0, 1), "highest_jerk", 3.0),
        (3, Phase(1.1, 2.0, 1), "highest_velocity", 2.0),
        (3, Phase(3.0, 2.0, 1), "end_velocity", 4.0),
    ],
)
def test_a_wrong_phase_shows(place: int, change: Phase, field: str, wrong: float) -> None:
    phases = [*UP_AND_DOWN[:place], change, *UP_AND_DOWN[place + 1 :]]
    assert getattr(integrate(phases), field) == pytest.approx(wrong)
