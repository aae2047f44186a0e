"""Stops from any state that a move can be in: integrated to prove limits and rest, and against Ruckig."""

from __future__ import annotations

from math import sqrt
from random import Random

import numpy as np
import pytest

from plcgen.profile.reference import Phase, Reference
from plcgen.profile.stop import stop_phases

LEG = 5


def random_states(count: int, seed: int) -> list[tuple[float, float, float, float]]:
    """Speed, acceleration, limit and jerk; what brakes can still be brought to rest before it turns back."""
    random = Random(seed)
    states = []
    for _ in range(count):
        velocity, limit, jerk = (10.0 ** random.uniform(-2, 2) for _ in range(3))
        states.append((velocity, random.uniform(-min(limit, sqrt(2 * jerk * velocity)), limit), limit, jerk))
    return states


def course(velocity: float, acceleration: float, phases: tuple[Phase, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Speed and acceleration at every step of an integration; its steps end where phases do."""
    steps = np.repeat([phase.duration / 64 for phase in phases], 64)
    accelerations = acceleration + np.concatenate(([0.0], np.cumsum(np.repeat([p.jerk for p in phases], 64) * steps)))
    means = (accelerations[:-1] + accelerations[1:]) / 2
    return velocity + np.concatenate(([0.0], np.cumsum(means * steps))), accelerations


def test_a_stop_ends_at_rest_within_the_limits() -> None:
    for state in random_states(2000, seed=1):
        velocity, acceleration, limit, jerk = state
        phases = stop_phases(velocity, acceleration, limit, jerk, LEG)
        speeds, accelerations = course(velocity, acceleration, phases)
        scale = velocity + limit * limit / jerk
        assert speeds[-1] == pytest.approx(0.0, abs=1e-9 * scale), state
        assert accelerations[-1] == pytest.approx(0.0, abs=1e-9 * limit), state
        assert speeds.min() >= -1e-9 * scale, state
        assert accelerations.max() <= max(0.0, acceleration) + 1e-9 * limit, state
        assert accelerations.min() >= -limit * (1 + 1e-9), state
        assert [phase.jerk for phase in phases] == [-jerk, 0.0, jerk]
        assert all(phase.duration >= 0 and phase.leg == LEG for phase in phases), state


def test_no_stop_is_faster() -> None:
    ruckig = pytest.importorskip("ruckig", reason="Ruckig is the oracle of this test: pip install ruckig")
    generator = ruckig.Ruckig(1)
    for state in random_states(1000, seed=2):
        velocity, acceleration, limit, jerk = state
        wanted = ruckig.InputParameter(1)
        wanted.control_interface = ruckig.ControlInterface.Velocity
        wanted.current_velocity, wanted.current_acceleration = [velocity], [acceleration]
        wanted.max_velocity, wanted.max_acceleration, wanted.max_jerk = [1e3], [limit], [jerk]
        trajectory = ruckig.Trajectory(1)
        assert generator.calculate(wanted, trajectory) in (ruckig.Result.Working, ruckig.Result.Finished)
        ours = sum(phase.duration for phase in stop_phases(velocity, acceleration, limit, jerk, LEG))
        assert ours == pytest.approx(trajectory.duration, rel=1e-6), state


@pytest.mark.parametrize(
    ("velocity", "acceleration", "durations", "travel"),
    [
        (1.5, 0.0, (1.0, 0.5, 1.0), 1.875),  # the limit is held: v (v/a + a/m)/2
        (0.25, 0.0, (0.5, 0.0, 0.5), 0.125),  # it is not reached: v sqrt(v/m)
        (0.5, 1.0, (2.0, 0.0, 1.0), 11 / 6),  # speed goes up to 1 at first
        (0.5, -1.0, (0.0, 0.0, 1.0), 1 / 6),  # nothing is left but to let go
    ],
)
def test_stops_by_hand(
    velocity: float, acceleration: float, durations: tuple[float, float, float], travel: float
) -> None:
    """A limit and a jerk of 1."""
    phases = stop_phases(velocity, acceleration, 1.0, 1.0, LEG)
    assert [phase.duration for phase in phases] == pytest.approx(durations, abs=1e-12)
    assert Reference(phases, velocity, acceleration).travel == pytest.approx(travel, rel=1e-12)


def test_at_rest_there_is_nothing_to_stop() -> None:
    assert sum(phase.duration for phase in stop_phases(0.0, 0.0, 1.0, 1.0, LEG)) == 0.0
