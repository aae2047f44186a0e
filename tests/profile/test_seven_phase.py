"""Moves of seven phases against Ruckig, an integrator and the paper's table."""

from __future__ import annotations

import numpy as np
import pytest

from plcgen.profile.integrator import integrate
from plcgen.profile.seven_phase import Limits, SevenPhases, fixed_jerk_time, time_optimal

PAPER = Limits(velocity=1.5, acceleration=1.0, jerk=1.0)


def random_moves(count: int, seed: int) -> list[tuple[float, Limits]]:
    random = np.random.default_rng(seed)
    numbers = 10.0 ** random.uniform(-3, 3, (count, 4))
    return [(float(s), Limits(float(v), float(a), float(j))) for s, v, a, j in numbers]


def test_time_optimal_moves_are_as_short_as_ruckigs() -> None:
    ruckig = pytest.importorskip("ruckig")
    generator = ruckig.Ruckig(1)
    for distance, limits in random_moves(2000, seed=7):
        wanted = ruckig.InputParameter(1)
        wanted.target_position = [distance]
        wanted.max_velocity, wanted.max_acceleration = [limits.velocity], [limits.acceleration]
        wanted.max_jerk = [limits.jerk]
        trajectory = ruckig.Trajectory(1)
        generator.calculate(wanted, trajectory)
        assert time_optimal(distance, limits).duration == pytest.approx(trajectory.duration, rel=1e-9), (
            distance,
            limits,
        )


@pytest.mark.parametrize("plan", [time_optimal, fixed_jerk_time])
def test_limits_hold_and_the_end_is_reached_at_rest(plan: object) -> None:
    assert callable(plan)
    for distance, limits in random_moves(500, seed=8):
        if plan is fixed_jerk_time and limits.velocity < limits.acceleration**2 / limits.jerk:
            continue
        move: SevenPhases = plan(distance, limits)
        proof = integrate(list(move.phases()))
        assert proof.travel == pytest.approx(distance, rel=1e-9)
        assert proof.end_velocity == pytest.approx(0.0, abs=1e-9 * limits.velocity)
        assert proof.end_acceleration == pytest.approx(0.0, abs=1e-9 * limits.acceleration)
        assert proof.highest_velocity <= limits.velocity * (1 + 1e-9)
        assert proof.highest_acceleration <= limits.acceleration * (1 + 1e-9)
        assert proof.lowest_acceleration >= -limits.acceleration * (1 + 1e-9)
        assert proof.highest_jerk <= limits.jerk * (1 + 1e-9)


@pytest.mark.parametrize(
    ("distance", "paper", "optimum"),
    [(1.5, 4.0, 3.634241), (3.0, 4.605551, 4.605551), (7.5, 7.5, 7.5), (6.0, 6.5, 6.5)],
)
def test_times_of_table_1(distance: float, paper: float, optimum: float) -> None:
    assert fixed_jerk_time(distance, PAPER).duration == pytest.approx(paper, abs=1e-6)
    assert time_optimal(distance, PAPER).duration == pytest.approx(optimum, abs=1e-6)


def test_a_stretched_move_is_slower_in_every_way() -> None:
    move = time_optimal(3.0, PAPER)
    slow = move.stretched(2 * move.duration)
    assert slow.duration == pytest.approx(2 * move.duration)
    assert slow.velocity == pytest.approx(move.velocity / 2)
    assert slow.acceleration == pytest.approx(move.acceleration / 4)
    assert slow.jerk == pytest.approx(move.jerk / 8)
    assert slow.acceleration_travel == pytest.approx(move.acceleration_travel)
