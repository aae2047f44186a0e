"""Moves of half-sine speed: exact distance, limits kept behind the average, stops at every sample."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, pi
from random import Random

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from plcgen.profile.cosine_fit import FITS, HALF_SINE, fit
from plcgen.profile.cosine_motion import OPEN, RAMP, Motion, averaged
from plcgen.profile.cosine_move import MOST_SAMPLES, Moves

Samples = NDArray[np.float64]
NAMES = pytest.mark.parametrize("name", FITS)

IDEAL = {"max_velocity": 2.0, "max_acceleration": 1.0, "jerk": 2.0, "sample_period": 0.01, "filter_length": 20}
ROUNDING = 1e-10


def moves_of(name: str = "minimax", /, **values: float) -> Moves:
    v, a, j, period, length = (IDEAL | values).values()
    return Moves(v, a, j, period, int(length), fit(name, HALF_SINE))


def random_move(random: Random, most: int, least: int = 2) -> tuple[Moves, float]:
    """Limits of any proportion, and a distance of so many samples: of either sign, short and long."""
    while True:
        v, a, time = (10.0 ** random.uniform(-1, 1) for _ in range(3))
        law = fit(random.choice(FITS), HALF_SINE)
        distance = v * 10.0 ** random.uniform(-3, 2) * random.choice([-1, 1])
        period = 10.0 ** random.uniform(-3, 0)
        moves = Moves(v, a, a / time, period, random.randint(2, 40), law)
        if least <= max(moves.samples(distance)) <= most:
            return moves, distance


def run(moves: Moves, distance: float, stop_at: int | None = None) -> list[Motion]:
    """Each possible motion, to standstill and some samples more."""
    count = 2 * max(moves.samples(distance)) + 3 * moves.filter_length
    return list(moves.possible(distance, count, stop_at))


def assert_limits(moves: Moves, motion: Motion, failing: object) -> None:
    """As differences of samples behind the average, from standstill to standstill."""
    v, period = np.concatenate([np.zeros(3), motion.average]), moves.sample_period
    assert np.abs(v).max() <= moves.max_velocity * (1 + ROUNDING), failing
    assert np.abs(np.diff(v)).max() <= moves.max_acceleration * period * (1 + ROUNDING), failing
    slack = 1e-13 * np.abs(v).max()
    assert np.abs(np.diff(v, 2)).max() <= moves.jerk * period**2 * (1 + ROUNDING) + slack, failing
    assert np.abs(v[-3:]).max() <= slack, failing


# --------------------------------------------------------------------------------------------------------- distance


@settings(max_examples=200, deadline=None, print_blob=True)
@given(st.floats(1e-3, 1e3), st.integers(2, 500), st.sampled_from(FITS), st.sampled_from([-1, 1]))
@example(1.0, 2, "taylor", 1)
def test_sum_of_the_samples_is_the_distance(distance: float, samples: int, name: str, sign: int) -> None:
    moves = moves_of(name)
    speeds = moves.speeds(sign * distance, samples)
    assert len(speeds) == samples
    assert speeds[-1] == 0.0
    assert speeds.sum() * moves.sample_period == pytest.approx(sign * distance, rel=1e-14)
    assert (speeds[:-1] * sign > 0.0).all()


@pytest.mark.parametrize("seed", range(50))
def test_the_average_keeps_the_distance(seed: int) -> None:
    moves, distance = random_move(Random(seed), 300)
    for motion in run(moves, distance):
        assert motion.average.sum() * moves.sample_period == pytest.approx(distance, rel=1e-12)
        assert motion.raw.sum() * moves.sample_period == pytest.approx(distance, rel=1e-12)


@NAMES
@pytest.mark.parametrize("samples", range(2, 51))
def test_terms_of_euler_and_maclaurin_are_exact(name: str, samples: int) -> None:
    """Against the sum in fractions: nothing of it is lost to rounding."""
    moves = moves_of(name)
    c = [Fraction(value) for value in moves.coefficients]
    wanted = Fraction(0)
    for k in range(1, samples):
        x = Fraction(k, samples)
        wanted += x * (c[0] - x**2 * (c[1] - x**2 * (c[2] - x**2 * c[3])))
    e1, e2, e3 = moves.sum_terms
    assert samples + e1 / samples + e2 / samples**3 + e3 / samples**5 == pytest.approx(float(wanted), rel=1e-13)


@NAMES
def test_terms_of_euler_and_maclaurin_are_near_those_of_the_sine(name: str) -> None:
    """Sum of pi/2 sin(pi k/N) = pi/2 cot(pi/2/N) = N - pi^2/12/N - pi^4/720/N^3 - pi^6/30240/N^5 - ..."""
    first, second, _third = moves_of(name).sum_terms
    assert first == pytest.approx(-(pi**2) / 12, rel=0.05)
    assert second == pytest.approx(-(pi**4) / 720, rel=0.6 if name == "taylor" else 0.15)


@NAMES
def test_law_of_speed_is_about_the_half_sine(name: str) -> None:
    moves = moves_of(name)
    x = np.linspace(0.0, 1.0, 1001)
    c1, c2, c3, c4 = moves.coefficients
    written = x * (c1 - x**2 * (c2 - x**2 * (c3 - x**2 * c4)))
    assert np.abs(moves.speed(x) - written).max() < 1e-13
    assert np.abs(written - pi / 2 * np.sin(pi * x)).max() < 0.02
    assert moves.speed.integ()(1.0) == pytest.approx(1.0, abs=1e-14)
    assert moves.speed(1.0) == pytest.approx(0.0, abs=2e-14)


# ----------------------------------------------------------------------------------------------------------- limits


@pytest.mark.parametrize("seed", range(300))
def test_a_move_keeps_the_limits(seed: int) -> None:
    moves, distance = random_move(Random(seed), 500)
    motions = run(moves, distance)
    assert 1 <= len(motions) <= 2
    for motion in motions:
        assert_limits(moves, motion, (moves, distance))


@pytest.mark.parametrize("seed", range(60))
def test_a_stop_at_any_sample_keeps_the_limits(seed: int) -> None:
    moves, distance = random_move(Random(seed), 60)
    for stop_at in range(1, max(moves.samples(distance)) + 1):
        for motion in run(moves, distance, stop_at):
            assert_limits(moves, motion, (moves, distance, stop_at))


@pytest.mark.parametrize("seed", range(100))
def test_a_move_takes_no_more_samples_than_the_limits_want(seed: int) -> None:
    """Three samples fewer, and a limit is passed: one is paid for the sum, two are what samples blur."""
    moves, distance = random_move(Random(seed), 2000, least=400)
    samples = min(moves.samples(distance))
    fewer = int(samples * (0.97 if moves.fit.name != "taylor" else 0.9)) - 3
    v = averaged(np.concatenate([np.zeros(3), moves.speeds(distance, fewer), np.zeros(60)]), 0.0, moves.filter_length)
    period = moves.sample_period
    shares = (
        np.abs(v).max() / moves.max_velocity,
        np.abs(np.diff(v)).max() / moves.max_acceleration / period,
        np.abs(np.diff(v, 2)).max() / moves.jerk / period**2,
    )
    assert max(shares) > 1.0, (moves, distance, shares)


def test_duration_by_each_limit_by_hand() -> None:
    """Speed pi/2 D/Tm, acceleration pi^2/2 D/Tm^2, jerk pi^3/2 D/Tm^3, and pi^2/2 D/(Tm^2 W) at the ends."""
    free = {"max_velocity": 1e6, "max_acceleration": 1e6, "jerk": 1e9}
    assert moves_of(**free | {"max_velocity": 2.0}).duration(10.0) == pytest.approx(pi / 2 * 10 / 2, rel=0.005)
    assert moves_of(**free | {"max_acceleration": 2.0}).duration(10.0) == pytest.approx(pi * 5**0.5 / 2**0.5, rel=0.01)
    assert moves_of(**free | {"jerk": 2.0}).duration(10.0) == pytest.approx(
        (pi**2 / 2 * 10 / (20 * 0.01) / 2) ** 0.5, rel=0.01
    )
    smooth = moves_of(**free | {"jerk": 2.0, "filter_length": 512, "sample_period": 1.0})
    assert smooth.duration(10.0) == pytest.approx((pi**3 / 2 * 10 / 2) ** (1 / 3), rel=0.02)
    assert moves_of().duration(-10.0) == moves_of().duration(10.0)


@pytest.mark.parametrize(("window", "samples"), [(4, 400), (20, 400), (20, 2000), (100, 1000)])
def test_jerk_of_the_pure_half_sine_behind_the_average(window: int, samples: int) -> None:
    """About 4.93 D/(Tm^2 W), and this is what the law reckons with."""
    distance, period = 3.0, 0.01
    duration, spread = samples * period, window * period
    v = distance * pi / 2 / duration * np.sin(pi * np.arange(samples + 1) / samples)
    v = averaged(np.concatenate([np.zeros(3), v, np.zeros(window + 3)]), 0.0, window)
    jerk = np.abs(np.diff(v, 2)).max() / period**2
    assert jerk == pytest.approx(4.93 * distance / (duration**2 * spread), rel=0.01)
    moves = moves_of(max_velocity=1e6, max_acceleration=1e6, jerk=jerk, filter_length=window)
    assert moves.duration(distance) == pytest.approx(duration, rel=0.01)


@NAMES
def test_factors_of_the_duration_by_dense_sampling(name: str) -> None:
    """Also the slope where a stop runs down the second half, as fast as the first half was at its mirror image."""
    moves = moves_of(name)
    x = np.linspace(0.0, 1.0, 20_001)
    u, slope, bend = (np.abs(polynomial(x)) for polynomial in (moves.speed, moves.speed.deriv(), moves.speed.deriv(2)))
    first, second = u[1:10_001], u[-2:-10_002:-1]
    down = (first / second * np.maximum.accumulate(slope[::-1])[1:10_001]).max()
    assert moves.time_by_velocity * moves.max_velocity == pytest.approx(u.max(), rel=1e-7)
    assert moves.cube_by_jerk * moves.jerk == pytest.approx(bend.max(), rel=1e-6)
    assert moves.slope >= max(slope.max(), down) * (1 - 1e-8)
    assert moves.slope <= slope.max() * max(1.0, float((first / second).max())) * (1 + 1e-8)
    assert moves.square_by_acceleration * moves.max_acceleration == moves.slope
    assert moves.cube_by_jump * moves.filter_length * moves.jerk == pytest.approx(moves.slope, rel=1e-15)


def test_without_an_average_the_acceleration_of_the_half_sine_jumps() -> None:
    moves = moves_of()
    v = np.concatenate([np.zeros(3), moves.speeds(5.0, 1000)])
    jerk = np.diff(v, 2) / moves.sample_period**2
    # half of the jump in the first sample, which lies in the middle of the two differences
    assert jerk[1] == pytest.approx(pi**2 / 2 * 5.0 / 10.0**2 / moves.sample_period, rel=0.02)
    assert np.abs(jerk[2:-1]).max() < jerk[1] / 50


# ------------------------------------------------------------------------------------------------------------ stops


@pytest.mark.parametrize("stop_at", [1, 10, 150, 225])
def test_a_stop_in_the_first_half_goes_level_and_then_down_the_other_half(stop_at: int) -> None:
    moves, samples = moves_of(), 500
    speeds = moves.speeds(5.0, samples)
    (stopped,) = moves.stopped(speeds, stop_at)
    level = slice(stop_at, stop_at + moves.filter_length)
    assert stopped[:stop_at].tolist() == speeds[:stop_at].tolist()
    assert stopped[level].tolist() == [speeds[stop_at - 1]] * moves.filter_length
    down = stopped[level.stop :]
    assert len(down) == stop_at
    assert down[-1] == 0.0
    assert (np.diff(np.concatenate([[speeds[stop_at - 1]], down])) < 0.0).all()
    assert down[:-1] == pytest.approx(speeds[: stop_at - 1][::-1], rel=0.03)


@pytest.mark.parametrize("stop_at", [249, 250, 251, 499, 500])
def test_a_stop_near_the_middle_or_in_the_second_half_lets_the_move_end(stop_at: int) -> None:
    """Level for the samples of the average and down would take it farther."""
    moves = moves_of()
    speeds = moves.speeds(5.0, 500)
    (stopped,) = moves.stopped(speeds, stop_at)
    assert stopped is speeds


def test_a_stop_never_takes_a_move_beyond_its_distance() -> None:
    moves = moves_of()
    speeds = moves.speeds(5.0, 500)
    travels = [outcome.sum() for at in range(1, 501) for outcome in moves.stopped(speeds, at)]
    assert max(travels) <= speeds.sum() * (1 + 1e-3)
    turn = moves.turn(5.0)
    samples = max(moves.samples(5.0))
    own = moves.speeds(5.0, samples)
    assert len(moves.stopped(own, turn)[0]) > turn + moves.filter_length
    assert moves.stopped(own, turn + 1)[0] is own


def test_a_stopped_move_is_not_done() -> None:
    moves = moves_of()
    samples = max(moves.samples(5.0))
    whole, stopped = run(moves, 5.0)[0], run(moves, 5.0, samples // 4)[0]
    last = samples + moves.filter_length - 2
    assert np.flatnonzero(whole.done).tolist() == [last]
    assert np.flatnonzero(whole.active).tolist() == list(range(last))
    assert not stopped.done.any()
    assert np.flatnonzero(stopped.active).tolist() == list(range(samples // 4))


def test_columns_of_a_motion() -> None:
    moves = moves_of()
    samples, motion = max(moves.samples(5.0)), run(moves, 5.0)[0]
    assert np.flatnonzero(motion.law == RAMP).tolist() == list(range(samples - 1))
    assert np.flatnonzero(motion.steady)[0] == samples + moves.filter_length - 2
    assert not motion.held.any()
    assert motion.average[motion.steady] == pytest.approx(0.0, abs=1e-15)


# ------------------------------------------------------------------------------------------- numbers of samples


@settings(max_examples=200, deadline=None, print_blob=True)
@given(st.floats(1e-3, 100.0), st.sampled_from(FITS), st.floats(1e-3, 0.1))
def test_samples_are_the_next_whole_number_and_one_more(distance: float, name: str, period: float) -> None:
    moves = moves_of(name, sample_period=period)
    ratio = moves.duration(distance) / period
    assume(abs(ratio - round(ratio)) > 2 * OPEN * ratio)
    assert moves.samples(distance) == (max(2, ceil(ratio) + 1),)


@pytest.mark.parametrize("seed", range(50))
def test_longest_distance_takes_the_duration_it_was_asked_for(seed: int) -> None:
    moves, distance = random_move(Random(seed), 2000)
    duration = moves.duration(distance)
    assert moves.longest(duration) == pytest.approx(abs(distance), rel=1e-12)
    assert moves.duration(moves.longest(7 * duration)) == pytest.approx(7 * duration, rel=1e-12)


def test_samples_near_a_whole_number_are_open() -> None:
    """Where the speed decides, the duration is proportional: a distance of exactly 400 samples."""
    moves = moves_of(max_acceleration=1e6, jerk=1e9)
    distance = 400 * moves.sample_period / moves.time_by_velocity
    for beside in (-OPEN / 2, 0.0, OPEN / 2):
        assert moves.samples(distance * (1 + beside)) == (401, 402)
    assert moves.samples(distance * (1 - 3 * OPEN)) == (401,)
    assert moves.samples(distance * (1 + 3 * OPEN)) == (402,)
    first, second = moves.possible(distance, 500)
    assert [int((motion.law == RAMP).sum()) + 1 for motion in (first, second)] == [401, 402]


def test_another_period_changes_the_samples_and_keeps_the_limits() -> None:
    moves = moves_of()
    for period in (0.001, 0.005, 0.1):
        slower = moves_of(sample_period=period)
        assert moves.samples(5.0, period) == slower.samples(5.0)
        for motion in moves.possible(5.0, 30_000, period=period):
            assert motion.raw.sum() * period == pytest.approx(5.0, rel=1e-12)
            assert_limits(slower, motion, period)


def test_longest_move_is_of_most_samples_at_full_speed() -> None:
    moves = moves_of(max_acceleration=1e6, jerk=1e9)
    assert MOST_SAMPLES == 65536
    assert moves.max_distance == pytest.approx(65536 * 0.01 * 2.0 * 2 / pi, rel=0.005)
    assert moves.samples(moves.max_distance * (1 - 0.5 / MOST_SAMPLES)) == (MOST_SAMPLES,)


def test_shortest_move_is_a_count_in_a_sample() -> None:
    moves = moves_of()
    assert moves.min_distance == 0.01 / 2.0**20
    assert max(moves.samples(moves.min_distance)) < 100
