"""Speed over travel against the time domain: integrated phases of constant jerk, written down once more here."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isclose, nextafter, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from plcgen.profile.transition import Transition, reached_velocity

Samples = NDArray[np.float64]
KINDS = ("ordinary", "from rest", "tiny change", "edge of short")


@dataclass(frozen=True)
class TimeDomain:
    """The same change of speed as a function of time: jerk up, constant acceleration, jerk down."""

    lo: float
    hi: float
    jerk: float
    peak: float

    @property
    def t1(self) -> float:
        return self.peak / self.jerk

    @property
    def t2(self) -> float:
        return max(0.0, (self.hi - self.lo) / self.peak - self.t1)

    def at(self, share: float) -> tuple[float, float, float]:
        """Travel, speed and acceleration after a share of the duration."""
        m, t1, t2, a = self.jerk, self.t1, self.t2, self.peak
        t = share * (2 * t1 + t2)
        v1, x1 = self.lo + m * t1**2 / 2, self.lo * t1 + m * t1**3 / 6
        if t <= t1:
            return self.lo * t + m * t**3 / 6, self.lo + m * t**2 / 2, m * t
        if t <= t1 + t2:
            s = t - t1
            return x1 + v1 * s + a * s**2 / 2, v1 + a * s, a
        s = t - t1 - t2
        v2, x2 = v1 + a * t2, x1 + v1 * t2 + a * t2**2 / 2
        return x2 + v2 * s + a * s**2 / 2 - m * s**3 / 6, v2 + a * s - m * s**2 / 2, a - m * s


def random_transition(random: np.random.Generator, kind: str) -> Transition:
    acceleration, jerk, lo = np.exp(random.uniform(np.log([0.01, 0.01, 0.001]), np.log([10.0, 50.0, 5.0])))
    change = np.exp(random.uniform(np.log(0.001), np.log(20.0)))
    if kind == "from rest":
        lo = 0.0
    if kind == "tiny change":
        change = lo * 10 ** random.uniform(-12, -3)
    if kind == "edge of short":
        change = acceleration**2 / jerk * (1 + random.choice([-1e-15, 0.0, 1e-15]))
    return Transition(float(lo), float(lo + change), float(acceleration), float(jerk))


def time_domain(transition: Transition) -> TimeDomain:
    change = transition.fast_velocity - transition.slow_velocity
    peak = min(transition.acceleration, sqrt(change * transition.jerk))
    return TimeDomain(transition.slow_velocity, transition.fast_velocity, transition.jerk, peak)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_velocity_over_travel_is_velocity_over_time(kind: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(500):
        transition = random_transition(random, kind)
        domain = time_domain(transition)
        for share in (*random.uniform(0.0, 1.0, 6), 1e-9, 1 - 1e-9):
            x, v, a = domain.at(float(share))
            tolerance = 1e-13 * transition.fast_velocity
            assert abs(transition.velocity(x) - v) <= tolerance, (transition, share)
            # a = sqrt(2 m dv) feels the rounding of dv: da = m/a dv.
            blur = sqrt(2 * transition.jerk * 4e-15 * transition.fast_velocity)
            assert abs(transition.acceleration_at(v) - a) <= blur + 1e-13 * a, (transition, share)


@pytest.mark.parametrize("kind", KINDS)
def test_identities(kind: str) -> None:
    random = np.random.default_rng(7)
    for _ in range(1000):
        transition = random_transition(random, kind)
        lo, hi = transition.slow_velocity, transition.fast_velocity
        domain = time_domain(transition)
        assert transition.middle_time >= 0
        assert transition.middle_travel >= 0
        assert transition.peak_acceleration <= transition.acceleration
        assert isclose(transition.peak_acceleration, domain.peak, rel_tol=1e-15)
        assert isclose(transition.duration, 2 * domain.t1 + domain.t2, rel_tol=1e-14)
        assert isclose(transition.travel, domain.at(1.0)[0], rel_tol=1e-14)
        closed = (lo + hi) / 2 * ((hi - lo) / transition.peak_acceleration + transition.jerk_time)
        assert isclose(transition.travel, closed, rel_tol=1e-14)
        parts = transition.slow_corner_travel + transition.middle_travel + transition.fast_part_travel
        assert isclose(parts, transition.travel, rel_tol=1e-14)
        assert isclose(
            transition.fast_corner_velocity - transition.slow_corner_velocity,
            transition.peak_acceleration * transition.middle_time,
            rel_tol=1e-12,
            abs_tol=1e-14 * hi,
        )


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_jumps_at_the_corners(kind: str) -> None:
    random = np.random.default_rng(11)
    for _ in range(1000):
        transition = random_transition(random, kind)
        corners = (
            (transition.slow_corner_travel, transition.slow_corner_velocity),
            (transition.fast_corner_travel, transition.fast_corner_velocity),
            (transition.travel, transition.fast_velocity),
        )
        for travel, velocity in corners:
            for place in (nextafter(travel, 0.0), travel, nextafter(travel, inf)):
                assert isclose(transition.velocity(place), velocity, rel_tol=1e-13), transition


def test_velocity_rises_with_travel_and_stays_between_the_corner_speeds() -> None:
    random = np.random.default_rng(13)
    for number in range(200):
        transition = random_transition(random, KINDS[number % len(KINDS)])
        speeds = np.array([transition.velocity(float(x)) for x in np.linspace(-0.1, 1.1, 200) * transition.travel])
        assert np.diff(speeds).min() >= -1e-14 * transition.fast_velocity
        assert speeds[0] == speeds.min() == transition.slow_velocity
        assert speeds[-1] == transition.fast_velocity


def test_last_bits_before_the_fast_end() -> None:
    """The cubic root is then smaller than the rounding of the other two."""
    random = np.random.default_rng(17)
    for _ in range(1000):
        transition = random_transition(random, "ordinary")
        place = transition.travel
        for _ in range(3):
            place = nextafter(place, 0.0)
            assert isclose(transition.velocity(place), transition.fast_velocity, rel_tol=1e-14)


@pytest.mark.parametrize("jerk", [0.1, 0.5, 2.0])
def test_from_rest_speed_grows_with_the_two_thirds_power_of_travel(jerk: float) -> None:
    transition = Transition(0.0, 12.0, 0.75, jerk)
    for x in (1e-12, 1e-6, 0.9 * transition.slow_corner_travel):
        assert isclose(transition.velocity(x), jerk / 2 * (6 * x / jerk) ** (2 / 3), rel_tol=1e-14)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_array_of_velocities_is_one_by_one(kind: str, seed: int) -> None:
    transition = random_transition(np.random.default_rng(seed), kind)
    corners = [transition.slow_corner_travel, transition.fast_corner_travel, transition.travel, 0.0, -0.0]
    x = np.concatenate([np.linspace(-0.1, 1.1, 401) * transition.travel, corners, np.nextafter(corners, 1e9)])
    singly = [transition.velocity(travel) for travel in x.tolist()]
    assert transition.velocities(x).tolist() == pytest.approx(singly, rel=4e-15, abs=1e-200), transition


def test_known_values() -> None:
    transition = Transition(0.5, 12.0, 0.75, 0.5)
    assert (transition.jerk_time, transition.is_short) == (1.5, False)
    assert transition.duration == pytest.approx(16.833333333333332)
    assert transition.travel == pytest.approx(105.20833333333333)
    # One metre before the fast end of 10 m/s with a jerk of 1 m/s3.
    before = Transition(1.0, 10.0, 1.0, 1.0)
    assert before.velocity(before.travel - 1.0) == pytest.approx(9.995, abs=1e-5)


def test_no_change_of_speed() -> None:
    transition = Transition(3.0, 3.0, 0.75, 0.5)
    assert (transition.duration, transition.travel, transition.peak_acceleration) == (0.0, 0.0, 0.0)
    assert (transition.steepest_gain, transition.acceleration_at(3.0), transition.middle_travel) == (0.0, 0.0, 0.0)
    assert [transition.velocity(x) for x in (-1.0, 0.0, 1.0)] == [3.0] * 3


@pytest.mark.parametrize("kind", ["ordinary", "tiny change", "edge of short"])
def test_steepest_gain_against_brute_force(kind: str) -> None:
    random = np.random.default_rng(19)
    for _ in range(100):
        transition = random_transition(random, kind)
        lo, hi = transition.slow_velocity, transition.fast_velocity
        speeds = lo + (hi - lo) * np.geomspace(1e-10, 1.0, 4001)
        gains = [transition.acceleration_at(float(v)) / float(v) for v in speeds]
        assert max(gains) <= transition.steepest_gain * (1 + 1e-6), transition
        assert max(gains) >= transition.steepest_gain * (1 - 5e-3), transition


def test_steepest_gain_from_rest_has_no_limit() -> None:
    assert Transition(0.0, 1.0, 1.0, 1.0).steepest_gain == inf


LIMIT = st.floats(0.01, 10.0)


@settings(max_examples=300, deadline=None)
@given(st.floats(0.0, 5.0), st.floats(0.001, 20.0), LIMIT, LIMIT, LIMIT, st.floats(0.0, 500.0))
def test_reached_velocity_is_the_last_float_that_fits(
    slow: float, change: float, rising: float, falling: float, jerk: float, room: float
) -> None:
    def travel(velocity: float) -> float:
        return Transition(slow, velocity, rising, jerk).travel + Transition(slow, velocity, falling, jerk).travel

    limit = slow + change
    reached = reached_velocity(slow, limit, rising, falling, jerk, room)
    assert slow <= reached <= limit
    assert travel(reached) <= room
    assert reached == limit or travel(nextafter(reached, inf)) > room
