"""The protection envelope: its four pieces, what the brake makes of it, and that it clears every trip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plcgen.job import read_job
from plcgen.profile.hoist import plan_trip
from plcgen.profile.hoist_rules import derive

JOB = read_job(Path(__file__).parents[2] / "templates" / "jobs" / "hoist.toml")
TRIP = derive(JOB)
ENVELOPE = TRIP.envelope
HEIGHT = 600.0


def envelope_at(travelled: float) -> float:
    return float(ENVELOPE.velocity(np.array([travelled]), np.array([HEIGHT - travelled]))[0])


def test_pieces_by_hand() -> None:
    assert ENVELOPE.overspeed_velocity == pytest.approx(13.8)
    assert ENVELOPE.reaction_velocity == 0.75
    assert ENVELOPE.velocity_squared_at_end == 4.5625
    assert envelope_at(300.0) == pytest.approx(1.10 * 12.0)
    assert envelope_at(0.0) == pytest.approx(0.5 + 0.3)
    assert envelope_at(HEIGHT) == pytest.approx(0.5 + 0.3)
    assert envelope_at(1.0) == pytest.approx(0.8)


def test_factor_above_and_margin_below_three_metres_a_second() -> None:
    """1.10 v and v + 0.3 meet at 3 m/s."""
    begin = TRIP.acceleration_begin
    for x in np.linspace(0.0, TRIP.acceleration.travel, 50):
        nominal = TRIP.acceleration.velocity(float(x))
        tracking = nominal + 0.3 if nominal < 3.0 else 1.1 * nominal
        assert envelope_at(begin + float(x)) == pytest.approx(tracking, rel=1e-12)


def test_overspeed_bounds_a_slow_hoist() -> None:
    """1.15 V is the lowest piece where the margin is more than 15 % of full speed."""
    slow = plan_trip(JOB.hoist.model_copy(update={"max_velocity": 1.0}), HEIGHT)
    half = np.array([HEIGHT / 2])
    assert slow.envelope.velocity(half, half)[0] == pytest.approx(1.15)


@pytest.mark.parametrize("to_go", [0.0, 0.5, 5.0, 50.0, 120.0])
def test_brake_after_its_reaction_time_reaches_the_end_at_end_velocity(to_go: float) -> None:
    """v t_r + (v^2 - v_e^2)/(2 a_b) = d, for the piece v_safe alone; overwind counts as the end itself."""
    guard = JOB.hoist.envelope
    raised = guard.model_copy(update={"tracking_margin": 1000.0, "overspeed_factor": 1000.0})
    envelope = derive(JOB).envelope
    alone = type(envelope)(
        JOB.hoist.model_copy(update={"envelope": raised}),
        envelope.acceleration,
        envelope.deceleration,
        envelope.acceleration_begin,
        envelope.deceleration_end,
    )
    (safe,), (beyond,) = (alone.velocity(np.array([0.0]), np.array([d])) for d in (to_go, -1.0))
    reaction = safe * guard.reaction_time
    braking = (safe**2 - guard.end_velocity**2) / (2 * guard.brake_deceleration)
    assert reaction + braking == pytest.approx(to_go, abs=1e-12)
    assert beyond == alone.velocity(np.array([0.0]), np.array([0.0]))[0]


def test_curve_is_symmetric_where_brake_and_limits_allow() -> None:
    """The example starts and stops alike but for the creep travels."""
    place = np.linspace(0.0, 100.0, 101)
    up = ENVELOPE.velocity(TRIP.acceleration_begin + place, np.full_like(place, 400.0))
    down = ENVELOPE.velocity(np.full_like(place, 400.0), TRIP.deceleration_end + place)
    assert np.all(down <= up + 1e-12)


@pytest.mark.parametrize("seed", [1])
def test_every_resumed_trip_stays_below(seed: int) -> None:
    """A trip that starts anywhere in the shaft plans less distance, but is guarded by the same curve."""
    random = np.random.default_rng(seed)
    for start in (0.0, HEIGHT - 1e-3, *random.uniform(0.0, HEIGHT, 40), *random.uniform(HEIGHT - 10, HEIGHT, 20)):
        trip = plan_trip(JOB.hoist, HEIGHT - float(start))
        motion = trip.reference.at_time(np.linspace(0.0, trip.duration, 500))
        travelled = start + motion.travel
        margin = ENVELOPE.velocity(travelled, HEIGHT - travelled) - motion.velocity
        assert margin.min() > 0.29, start
