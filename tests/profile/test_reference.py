"""The reference: its polynomials against the integrator, its inverse, its samples."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from plcgen.jobfile import HoistLimits
from plcgen.profile.hoist import plan_trip
from plcgen.profile.integrator import integrate
from plcgen.profile.reference import Phase, Reference

LIMITS = HoistLimits(
    travel=600.0,
    max_velocity=12.0,
    acceleration=0.75,
    deceleration=0.6,
    jerk=0.5,
    creep_velocity=0.5,
    creep_acceleration=0.3,
    creep_out=1.5,
    creep_in=2.5,
)
DISTANCES = (0.001, 0.5, 3.0, 6.0, 20.0, 150.0, 600.0)
FOUR_SECONDS = Reference([Phase(1.0, 2.0, 1), Phase(0.0, 9.0, 2), Phase(1.0, -2.0, 3), Phase(2.0, 0.0, 4)])


def cut(phases: list[Phase], time: float) -> list[Phase]:
    """The phases up to an instant."""
    kept = []
    for phase in phases:
        if time <= 0:
            break
        kept.append(Phase(min(phase.duration, time), phase.jerk, phase.leg))
        time -= phase.duration
    return kept


def test_phases_by_hand() -> None:
    reference = FOUR_SECONDS
    motion = reference.at_time(np.array([0.0, 0.5, 1.0, 2.0, 3.0, 4.0]))
    assert motion.velocity.tolist() == [0.0, 0.25, 1.0, 2.0, 2.0, 2.0]
    assert motion.acceleration.tolist() == [0.0, 1.0, 2.0, 0.0, 0.0, 0.0]
    assert motion.travel == pytest.approx([0.0, 1 / 24, 1 / 3, 2.0, 4.0, 6.0], rel=1e-15)
    assert (motion.jerk.tolist(), motion.leg.tolist()) == ([2, 2, -2, 0, 0, 0], [1, 1, 3, 4, 4, 4])
    assert (reference.duration, reference.travel) == pytest.approx((4.0, 6.0))
    assert reference.corner_times.tolist() == [0.0, 1.0, 1.0, 2.0, 4.0]


def test_initial_velocity_and_acceleration() -> None:
    reference = Reference([Phase(2.0, -1.0, 8)], initial_velocity=1.0, initial_acceleration=2.0)
    assert reference.end.tolist() == pytest.approx([2.0, 2.0 + 4.0 - 8 / 6, 3.0, 0.0])


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("seed", [1, 2])
def test_polynomials_against_the_integrator(distance: float, seed: int) -> None:
    trip = plan_trip(LIMITS, distance)
    phases = list(trip.reference.phases)
    for time in np.random.default_rng(seed).uniform(0.0, trip.duration, 20):
        motion = trip.reference.at_time(np.array([time]))
        proof = integrate(cut(phases, float(time)))
        assert motion.travel[0] == pytest.approx(proof.travel, rel=1e-12, abs=1e-15)
        assert motion.velocity[0] == pytest.approx(proof.end_velocity, rel=1e-10, abs=1e-12)
        assert motion.acceleration[0] == pytest.approx(proof.end_acceleration, abs=1e-12)


@pytest.mark.parametrize("distance", DISTANCES)
def test_nothing_jumps_but_the_jerk(distance: float) -> None:
    reference = plan_trip(LIMITS, distance).reference
    corners = reference.corner_times
    before = reference.at_time(np.nextafter(corners, -1.0))
    after = reference.at_time(np.nextafter(corners, 1e9))
    assert np.abs(after.travel - before.travel).max() <= 1e-14 * max(1.0, distance) * LIMITS.max_velocity
    assert np.abs(after.velocity - before.velocity).max() <= 1e-12
    assert np.abs(after.acceleration - before.acceleration).max() <= 1e-12


@pytest.mark.parametrize("distance", DISTANCES)
def test_before_the_start_and_after_the_end(distance: float) -> None:
    reference = plan_trip(LIMITS, distance).reference
    motion = reference.at_time(np.array([-1.0, 0.0, reference.duration, reference.duration + 1.0]))
    assert motion.travel == pytest.approx([0.0, 0.0, distance, distance], rel=1e-12)
    assert motion.velocity == pytest.approx([0.0] * 4, abs=1e-12)
    assert reference.time_at(np.array([-1.0, distance + 1.0])) == pytest.approx([0.0, reference.duration], abs=1e-12)


@pytest.mark.parametrize("distance", DISTANCES)
def test_time_of_a_travel(distance: float) -> None:
    """The inverse, as sharp as the travel allows: dt = dx/v."""
    reference = plan_trip(LIMITS, distance).reference
    time = np.random.default_rng(3).uniform(0.0, reference.duration, 200)
    motion = reference.at_time(time)
    found = reference.time_at(motion.travel)
    resolution = 4 * np.finfo(float).eps * (distance / motion.velocity + reference.duration)
    assert np.all(np.abs(found - time) <= resolution)
    again = reference.at_travel(motion.travel)
    assert again.travel == pytest.approx(motion.travel, rel=1e-12)


@pytest.mark.parametrize("period", [0.5, 0.3, 1.0, 4.0, 5.0, 0.1])
def test_samples_end_once_at_the_end(period: float) -> None:
    samples = FOUR_SECONDS.sample(period)
    time = samples["time"]
    assert tuple(samples.columns) == ("time", "travel", "velocity", "acceleration", "jerk", "phase")
    assert all(before < after for before, after in pairwise(time))
    assert (time[0], time[-1]) == (0.0, 4.0)
    assert time[:-1].tolist() == (np.arange(len(time) - 1) * period).tolist()
    assert period * len(time[:-1]) == pytest.approx(4.0, abs=period) and period * len(time[:-1]) >= 4.0 - 1e-12
    assert samples["travel"][-1] == pytest.approx(6.0)
    assert samples["phase"].tolist() == FOUR_SECONDS.at_time(time).leg.tolist()


@pytest.mark.parametrize("seed", [5])
def test_samples_of_any_period_never_repeat_the_end(seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(500):
        period, count = float(random.uniform(0.001, 0.1)), int(random.integers(1, 300))
        time = Reference([Phase(period * count, 0.0, 1)]).sample(period)["time"]
        assert len(time) == count + 1, (period, count)
        assert np.all(np.diff(time) > 0)
