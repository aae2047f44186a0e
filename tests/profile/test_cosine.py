"""Ramps of cosine shape and orders in mid-ramp: what every motion keeps, before and behind the moving average."""

from __future__ import annotations

from math import ceil, log2, pi, sqrt
from random import Random

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from plcgen.profile.cosine import Ramps, counts_per_unit
from plcgen.profile.cosine_fit import CENTRED, FITS, fit
from plcgen.profile.cosine_motion import (
    MOST_POSSIBLE,
    OPEN,
    RAMP,
    SETTLE,
    STEADY,
    Motion,
    Order,
    averaged,
    follow,
    possible,
)

Samples = NDArray[np.float64]

ROUNDING = 1e-11
IDEAL = {"max_velocity": 12.0, "max_acceleration": 0.75, "jerk": 0.5, "sample_period": 0.01, "filter_length": 16}


def ramps_of(name: str = "minimax", /, **values: float) -> Ramps:
    """Limits of the example job with other values."""
    v, a, j, period, length = (IDEAL | values).values()
    return Ramps(v, a, j, period, int(length), fit(name, CENTRED))


@st.composite
def limits(draw: st.DrawFn) -> Ramps:
    """Limits whose longest ramp takes few samples."""
    velocity, acceleration, time = (10.0 ** draw(st.floats(-1.0, 1.0)) for _ in range(3))
    jerk = acceleration / time
    longest = max(pi * velocity / acceleration, pi * sqrt(velocity / jerk))
    period = longest / draw(st.floats(3.0, 300.0))
    return Ramps(
        velocity, acceleration, jerk, period, draw(st.integers(1, 40)), fit(draw(st.sampled_from(FITS)), CENTRED)
    )


SHARES = st.floats(-1.0, 1.0)


def samples_of(ramps: Ramps, change: float) -> int:
    """N, where no rounding is near."""
    return max(1, ceil(ramps.ramp_time(change) / ramps.sample_period))


def is_open(ratio: float) -> bool:
    return abs(ratio - max(1, round(ratio))) <= 2 * OPEN * ratio


def ramp(ramps: Ramps, before: float, after: float) -> Motion:
    """A ramp ordered in sample 0, and ten samples more than it takes."""
    count = samples_of(ramps, after - before) + ramps.filter_length + 10
    return follow(ramps, before, [Order(0, after)], count)


def with_past(before: float, speeds: Samples) -> Samples:
    return np.concatenate([np.full(3, before), speeds])


def assert_limits(ramps: Ramps, before: float, speeds: Samples) -> None:
    """Speed, acceleration and jerk as differences of samples; neither speed nor acceleration jumps."""
    v = with_past(before, speeds)
    period, slack = ramps.sample_period, ROUNDING * ramps.max_velocity
    assert np.abs(v).max() <= ramps.max_velocity + slack
    assert np.abs(np.diff(v)).max() <= ramps.max_acceleration * period + slack
    assert np.abs(np.diff(v, 2)).max() <= ramps.jerk * period**2 + slack


# ------------------------------------------------------------------------------------------------------------ ramps


@settings(max_examples=150, deadline=None, print_blob=True)
@given(limits(), SHARES, SHARES)
@example(ramps_of(), 0.0, 1.0)
@example(ramps_of(filter_length=1), -1.0, 1.0)
def test_a_ramp_keeps_the_limits_and_ends_where_asked(ramps: Ramps, from_share: float, to_share: float) -> None:
    before, after = from_share * ramps.max_velocity, to_share * ramps.max_velocity
    motion = ramp(ramps, before, after)
    assert_limits(ramps, before, motion.raw)
    assert_limits(ramps, before, motion.average)
    assert motion.raw[-1] == after
    assert motion.average[-1] == pytest.approx(after, abs=ROUNDING * ramps.max_velocity)


@settings(max_examples=150, deadline=None, print_blob=True)
@given(limits(), SHARES, SHARES)
def test_a_ramp_follows_its_closed_form_which_keeps_the_limits_between_samples(
    ramps: Ramps, from_share: float, to_share: float
) -> None:
    before, after = from_share * ramps.max_velocity, to_share * ramps.max_velocity
    change = after - before
    if is_open(ramps.ramp_time(change) / ramps.sample_period):
        return
    n = samples_of(ramps, change)
    d1, d2, d3, d4 = ramps.fit.coefficients
    y = 2 * np.arange(1, n + 1) / n - 1
    closed = before + change / 2 * (1 + (d1 * y - d2 * y**3 + d3 * y**5 - d4 * y**7))
    assert np.abs(ramp(ramps, before, after).raw[:n] - closed).max() <= ROUNDING * ramps.max_velocity
    y, duration = np.linspace(-1, 1, 4001), n * ramps.sample_period
    acceleration = change / duration * (d1 - 3 * d2 * y**2 + 5 * d3 * y**4 - 7 * d4 * y**6)
    jerk = 2 * change / duration**2 * (-6 * d2 * y + 20 * d3 * y**3 - 42 * d4 * y**5)
    assert np.abs(acceleration).max() <= ramps.max_acceleration * (1 + 1e-9)
    assert np.abs(jerk).max() <= ramps.jerk * (1 + 1e-9)


@settings(max_examples=150, deadline=None, print_blob=True)
@given(limits(), SHARES, SHARES)
def test_a_ramp_is_monotone_and_stays_between_its_speeds(ramps: Ramps, from_share: float, to_share: float) -> None:
    before, after = from_share * ramps.max_velocity, to_share * ramps.max_velocity
    motion, slack = ramp(ramps, before, after), ROUNDING * ramps.max_velocity
    for speeds in (motion.raw, motion.average):
        assert (np.diff(with_past(before, speeds)) * np.sign(after - before) >= -slack).all()
        assert min(before, after) - slack <= speeds.min()
        assert speeds.max() <= max(before, after) + slack


@settings(max_examples=150, deadline=None, print_blob=True)
@given(limits(), SHARES, SHARES)
def test_duration_and_distance_of_a_ramp(ramps: Ramps, from_share: float, to_share: float) -> None:
    """Done N + n - 1 samples after the begin; the distance is the mean speed times that, by trapezoids."""
    before, after = from_share * ramps.max_velocity, to_share * ramps.max_velocity
    if is_open(ramps.ramp_time(after - before) / ramps.sample_period):
        return
    n = samples_of(ramps, after - before)
    last = n + ramps.filter_length - 1
    motion = ramp(ramps, before, after)
    assert np.flatnonzero(motion.done).tolist() == [last - 1]
    assert np.flatnonzero(motion.active).tolist() == list(range(last - 1))
    assert np.flatnonzero(motion.law == RAMP).tolist() == list(range(n - 1))
    v = np.concatenate([[before], motion.average[:last]])
    assert np.trapezoid(v) == pytest.approx((before + after) / 2 * last, abs=ROUNDING * ramps.max_velocity * last)


@settings(max_examples=150, deadline=None, print_blob=True)
@given(limits(), SHARES, SHARES)
def test_the_average_raises_no_peak_and_softens_the_jerk(ramps: Ramps, from_share: float, to_share: float) -> None:
    """From sample to sample the jerk behind the average changes by 2 J/n at the most."""
    before, after = from_share * ramps.max_velocity, to_share * ramps.max_velocity
    motion, slack = ramp(ramps, before, after), ROUNDING * ramps.max_velocity
    raw, average = with_past(before, motion.raw), with_past(before, motion.average)
    for order in range(4):
        assert np.abs(np.diff(average, order)).max() <= np.abs(np.diff(raw, order)).max() + slack
    bound = 2 * ramps.jerk * ramps.sample_period**2 / ramps.filter_length
    assert np.abs(np.diff(average, 3)).max() <= bound + slack


def test_the_raw_jerk_jumps_at_the_begin_and_the_average_spreads_it() -> None:
    """A ramp that the jerk decides begins with the whole of it; 16 samples make steps of a sixteenth."""
    ramps = ramps_of(max_acceleration=100.0)
    motion = ramp(ramps, 0.0, 12.0)
    raw, average = (np.diff(with_past(0.0, v), 2) / ramps.sample_period**2 for v in (motion.raw, motion.average))
    jumps = [0.0, ramps.jerk / 2, *[ramps.jerk] * 15]
    assert raw[:17] == pytest.approx(jumps, rel=0.01)
    assert average[:17] == pytest.approx(np.cumsum(jumps) / 16, rel=0.01)
    assert np.abs(np.diff(average)).max() <= 2 * ramps.jerk / 16


def test_ramp_of_the_example_by_hand() -> None:
    """12 m/s with 0.75 m/s2: pi 12/(2 0.75) = 25.13 s; the jerk would allow pi sqrt(12/1) = 10.88 s."""
    ramps = ramps_of()
    assert ramps.ramp_time(12.0) == pytest.approx(25.1327, abs=2e-3)
    assert ramps.ramp_time(-12.0) == ramps.ramp_time(12.0)
    assert ramps.time_by_acceleration == pytest.approx(pi / 2 / 0.75, rel=1e-4)
    assert ramps.square_by_jerk == pytest.approx(pi**2 / 2 / 0.5, rel=1e-3)
    assert ramps.settle_time == pytest.approx(pi / 2 / 0.5, rel=1e-3)
    motion = ramp(ramps, 0.0, 12.0)
    assert motion.raw[2513] == 12.0
    assert motion.raw[1256] == pytest.approx(6.0, abs=0.01)


def test_a_small_change_is_left_to_the_jerk() -> None:
    """0.1 m/s: pi sqrt(0.1/1) = 0.993 s, where the acceleration would allow 0.209 s."""
    assert ramps_of().ramp_time(0.1) == pytest.approx(0.9935, abs=1e-3)


def test_no_change_is_a_ramp_of_one_sample() -> None:
    motion = follow(ramps_of(), 5.0, [Order(3, 5.0)], 30)
    assert motion.raw.tolist() == [5.0] * 30
    assert np.flatnonzero(motion.done).tolist() == [3 + 15]
    assert not motion.law.any()


# ----------------------------------------------------------------------------------------------- orders in mid-ramp


def random_orders(random: Random, ramps: Ramps, span: int) -> list[Order]:
    """Speeds, hold and go on, rest; some in one sample, some after the motion has ended."""
    orders: list[Order] = []
    for sample in sorted(random.randrange(span) for _ in range(random.randint(1, 7))):
        kind = random.choice(["velocity", "velocity", "velocity", "zero", "hold", "go on", "rest", "same"])
        speed = random.uniform(-1, 1) * ramps.max_velocity
        if kind == "same":
            speed = next((o.velocity for o in reversed(orders) if o.velocity is not None), speed)
        values: dict[str, Order] = {
            "hold": Order(sample, hold=True),
            "go on": Order(sample, hold=False),
            "rest": Order(sample, rest=True),
            "zero": Order(sample, 0.0),
        }
        orders.append(values.get(kind, Order(sample, speed)))
    return orders


def random_ramps(random: Random) -> Ramps:
    velocity, acceleration, time = (10.0 ** random.uniform(-1, 1) for _ in range(3))
    jerk = acceleration / time
    longest = max(pi * velocity / acceleration, pi * sqrt(velocity / jerk))
    law = fit(random.choice(FITS), CENTRED)
    return Ramps(velocity, acceleration, jerk, longest / random.uniform(5, 150), random.randint(1, 30), law)


def final_speed(start: float, orders: list[Order]) -> float:
    """What the last order asks for; a rest is standstill."""
    speed = start
    for order in orders:
        speed = 0.0 if order.rest else speed if order.velocity is None else order.velocity
    return speed


@pytest.mark.parametrize("seed", range(400))
def test_orders_in_mid_ramp_keep_the_limits_and_end_where_asked(seed: int) -> None:
    random = Random(seed)
    ramps = random_ramps(random)
    start = random.choice([0.0, random.uniform(-1, 1) * ramps.max_velocity])
    longest = samples_of(ramps, 2 * ramps.max_velocity)
    orders = random_orders(random, ramps, 3 * longest)
    orders.append(Order(3 * longest, hold=False))
    count = 9 * longest + ramps.filter_length + 10
    motion = follow(ramps, start, orders, count)
    failing = f"{ramps} from {start} by {orders}"
    for speeds in (motion.raw, motion.average):
        v = with_past(start, speeds)
        period, slack = ramps.sample_period, ROUNDING * ramps.max_velocity + 1e-14
        assert np.abs(v).max() <= ramps.max_velocity + slack, failing
        assert np.abs(np.diff(v)).max() <= ramps.max_acceleration * period + slack, failing
        assert np.abs(np.diff(v, 2)).max() <= ramps.jerk * period**2 + slack, failing
        bend = 2 * ramps.jerk * period**2 / ramps.filter_length + slack
        assert speeds is motion.raw or np.abs(np.diff(v, 3)).max() <= bend, failing
    assert motion.raw[-1] == final_speed(start, orders), failing
    assert motion.steady[-1], failing
    assert not motion.active[-1], failing
    assert motion.average[-1] == pytest.approx(motion.raw[-1], abs=ROUNDING * ramps.max_velocity), failing


def test_random_orders_reach_every_law() -> None:
    """The random motions above settle in mid-ramp, are held and come to rest: none of it is idle."""
    seen: set[tuple[int, bool]] = set()
    for seed in range(60):
        random = Random(seed)
        ramps = random_ramps(random)
        orders = random_orders(random, ramps, 3 * samples_of(ramps, 2 * ramps.max_velocity))
        motion = follow(ramps, 0.0, orders, orders[-1].sample + 20)
        seen |= set(zip(motion.law.tolist(), motion.held.tolist(), strict=True))
    assert seen == {(law, held) for law in (STEADY, RAMP, SETTLE) for held in (False, True)}


def test_acceleration_is_the_same_before_and_after_an_order() -> None:
    """At 1 ms from sample to sample: the first step of the new law is as long as the last of the old one."""
    ramps = ramps_of(sample_period=0.001)
    for at in (500, 5000, 12_500, 20_000, 24_000):
        v = follow(ramps, 0.0, [Order(0, 12.0), Order(at, -3.0)], at + 2000).raw
        before, after = v[at - 1] - v[at - 2], v[at] - v[at - 1]
        assert after == pytest.approx(before, abs=1.01 * ramps.jerk * ramps.sample_period**2)


def test_an_order_near_the_end_lets_the_ramp_end() -> None:
    """Where the acceleration cannot die out before the end of the ramp, the next one begins there."""
    ramps = ramps_of(max_acceleration=100.0)
    end = samples_of(ramps, 12.0)
    for orders in ([Order(end - 50, 3.0)], [Order(end - 50, hold=True), Order(end + 50, 3.0, hold=False)]):
        motion = follow(ramps, 0.0, [Order(0, 12.0), *orders], 3 * end)
        assert not (motion.law == SETTLE).any()
        assert motion.raw[end - 1] == 12.0
        assert motion.raw[-1] == 3.0


@pytest.mark.parametrize("values", [{}, {"max_acceleration": 100.0}, {"jerk": 0.1}], ids=["both", "jerk", "long"])
@pytest.mark.parametrize("period", [0.5, 0.2])
def test_settling_never_passes_the_speed_that_the_ramp_ends_at(values: dict[str, float], period: float) -> None:
    """Wherever the order comes, and though so long a period rounds M up by much."""
    ramps = ramps_of(**values, sample_period=period)
    end = samples_of(ramps, 6.0)
    for at in range(1, end):
        motion = follow(ramps, 0.0, [Order(0, 6.0), Order(at, hold=True)], 2 * end + 20)
        assert motion.raw.max() <= 6.0 * (1 + 1e-12), at
        assert_limits(ramps, 0.0, motion.raw)
        assert motion.steady[-1], at


def test_settling_in_mid_ramp_by_hand() -> None:
    """In the middle of 0 to 12 m/s the acceleration is 0.75 m/s2; 0.5 m/s3 end it in pi/2 0.75/0.5 = 2.356 s,
    in which the speed grows by 2/pi 0.75 2.356 = 1.125 m/s."""
    ramps = ramps_of()
    middle = samples_of(ramps, 12.0) // 2
    motion = follow(ramps, 0.0, [Order(0, 12.0), Order(middle, hold=True)], 4000)
    settling = np.flatnonzero(motion.law == SETTLE)
    assert len(settling) + 1 == pytest.approx(235.6, abs=2)
    assert motion.raw[-1] == pytest.approx(6.0 + 1.125, abs=0.01)
    assert motion.held[middle:].all()
    caught_up = middle + len(settling) + ramps.filter_length
    assert motion.steady[caught_up:].all()
    assert not motion.steady[: caught_up - 1].any()
    assert motion.active[-1]  # an order that is held is still in progress
    assert not motion.done.any()


def test_hold_and_go_on_arrives_where_the_order_wanted() -> None:
    ramps = ramps_of()
    motion = follow(ramps, 0.0, [Order(0, 12.0), Order(800, hold=True), Order(3000, hold=False)], 8000)
    assert motion.raw[2900] == motion.raw[2999]
    assert motion.raw[2999] < 12.0
    assert motion.raw[-1] == 12.0
    assert np.flatnonzero(motion.done).size == 1


def test_hold_without_an_order_in_progress_holds_nothing() -> None:
    motion = follow(ramps_of(), 4.0, [Order(0, hold=True)], 20)
    assert not motion.held.any()
    assert motion.raw.tolist() == [4.0] * 20


def test_rest_comes_to_standstill_and_is_no_order_that_is_done() -> None:
    ramps = ramps_of()
    motion = follow(ramps, 0.0, [Order(0, 12.0), Order(900, rest=True)], 6000)
    assert motion.raw[-1] == motion.average[-1] == 0.0
    assert not motion.active[900:].any()
    assert not motion.done.any()


def test_rest_at_standstill_begins_nothing() -> None:
    motion = follow(ramps_of(), 0.0, [Order(5, rest=True)], 30)
    assert motion.steady.all()
    assert not motion.raw.any()
    assert not motion.active.any()


def test_rest_overrides_a_hold() -> None:
    motion = follow(ramps_of(), 0.0, [Order(0, 12.0), Order(900, hold=True), Order(1500, rest=True)], 6000)
    assert not motion.held[1500:].any()
    assert motion.raw[-1] == 0.0


def test_the_same_speed_once_more_leaves_the_ramp_as_it_is() -> None:
    ramps = ramps_of()
    once = follow(ramps, 0.0, [Order(0, 12.0)], 3000)
    twice = follow(ramps, 0.0, [Order(0, 12.0), Order(700, 12.0)], 3000)
    assert twice.raw.tolist() == once.raw.tolist()
    near = follow(ramps, 0.0, [Order(0, 12.0), Order(700, 12.0 - 0.9 / ramps.counts)], 3000)
    assert not (near.law == SETTLE).any()
    assert near.raw[-1] == 12.0 - 0.9 / ramps.counts
    beyond = follow(ramps, 0.0, [Order(0, 12.0), Order(700, 12.0 - 1.1 / ramps.counts)], 3000)
    assert (beyond.law == SETTLE).any()


def test_another_cycle_keeps_the_limits_in_its_own_time() -> None:
    for cycle in (0.001, 0.004, 0.1):
        ramps = ramps_of()
        motion = follow(ramps, 0.0, [Order(0, 12.0), Order(int(9 / cycle), -12.0)], int(80 / cycle), cycle=cycle)
        v = with_past(0.0, motion.raw)
        assert np.abs(np.diff(v)).max() <= ramps.max_acceleration * cycle + 1e-10
        assert np.abs(np.diff(v, 2)).max() <= ramps.jerk * cycle**2 + 1e-10
        assert motion.raw[-1] == -12.0


# --------------------------------------------------------------------------------------------------- open decisions


def lengths(ramps: Ramps, change: float) -> list[int]:
    """N of each possible motion: samples of the ramp and its last one."""
    motions = possible(ramps, 0.0, [Order(0, change)], 3000)
    return [int((motion.law == RAMP).sum()) + 1 for motion in motions]


@pytest.mark.parametrize(
    ("beside", "wanted"),
    [
        (-3 * OPEN, [1000]),
        (-OPEN / 2, [1000, 1001]),
        (0.0, None),
        (OPEN / 2, [1001, 1000]),
        (3 * OPEN, [1001]),
    ],
)
def test_a_duration_near_a_whole_number_of_samples_is_open(beside: float, wanted: list[int] | None) -> None:
    """REAL may come out on either side of 1000 samples; what float64 says comes first."""
    ramps = ramps_of()
    change = 1000 * (1 + beside) * ramps.sample_period / ramps.time_by_acceleration
    assert ramps.ramp_time(change) == ramps.time_by_acceleration * change
    found = lengths(ramps, change)
    assert found == wanted or (wanted is None and sorted(found) == [1000, 1001])


def test_the_end_of_an_acceleration_near_a_whole_number_of_samples_is_open() -> None:
    """The jerk that makes M exactly 200 where the order comes; the ramp itself is of the acceleration."""
    first = ramps_of(jerk=5.0)
    n = samples_of(first, 12.0)
    rate = 12.0 / (n * first.sample_period) * float(first.fit.repaired.deriv()(2 * 700 / n - 1))
    jerk = rate * first.settle_time * first.jerk / (200 * first.sample_period)
    ramps = ramps_of(jerk=jerk)
    assert samples_of(ramps, 12.0) == n
    motions = list(possible(ramps, 0.0, [Order(0, 12.0), Order(700, 0.0)], 8000))
    assert sorted({int((motion.law == SETTLE).sum()) + 1 for motion in motions}) == [200, 201]
    for motion in motions:
        assert motion.raw[-1] == 0.0


def test_whether_an_acceleration_ends_before_the_ramp_is_open_at_a_tie() -> None:
    """A jerk, found by bisection, with which the last sample for settling is just late enough."""
    at, low, high = 1900, 0.1, 1.0
    for _ in range(40):
        middle = sqrt(low * high)
        settles = (tie(middle, at).law == SETTLE).any()
        low, high = (low, middle) if settles else (middle, high)
    motions = list(possible(ramps_of(jerk=high), 0.0, [Order(0, 12.0), Order(at, 0.0)], 6000))
    assert {bool((motion.law == SETTLE).any()) for motion in motions} == {False, True}


def tie(jerk: float, at: int) -> Motion:
    return follow(ramps_of(jerk=jerk), 0.0, [Order(0, 12.0), Order(at, 0.0)], at + 2)


def test_an_open_decision_is_turned_alone() -> None:
    """Two open ramps: four motions, the likely one first; those they have in common are told apart by none."""
    ramps = ramps_of()
    change = 500 * ramps.sample_period / ramps.time_by_acceleration
    orders = [Order(0, change), Order(1000, 0.0)]
    motions = list(possible(ramps, 0.0, orders, 2000))
    found = {tuple(np.flatnonzero(motion.done).tolist()) for motion in motions}
    assert found == {(a + 14, b + 14) for a in (500, 501) for b in (1500, 1501)}
    assert motions[0].raw.tolist() == follow(ramps, 0.0, orders, 2000).raw.tolist()
    assert len(motions) == 4


def test_possible_motions_are_not_without_end() -> None:
    ramps = ramps_of(filter_length=1, jerk=100.0)
    change = 50 * ramps.sample_period / ramps.time_by_acceleration
    orders = [Order(60 * index, change * ((index + 1) % 2)) for index in range(8)]
    assert len(list(possible(ramps, 0.0, orders, 500))) == MOST_POSSIBLE


# ------------------------------------------------------------------------------------------- the moving average


@pytest.mark.parametrize("length", [1, 2, 3, 16, 100])
def test_average_sample_by_sample(length: int) -> None:
    random = Random(length)
    raw = [random.uniform(-1, 1) for _ in range(60)]
    window = [0.25] * length
    for value, average in zip(raw, averaged(np.array(raw), 0.25, length), strict=True):
        window = [*window[1:], value]
        assert average == pytest.approx(sum(window) / length, abs=1e-15)


@settings(max_examples=300, deadline=None)
@given(st.floats(1e-4, 5e4), st.integers(1, 512))
def test_counts_are_a_power_of_two_whose_sum_a_dint_holds(velocity: float, length: int) -> None:
    counts = counts_per_unit(velocity, length)
    assert log2(counts) == round(log2(counts))
    assert length * velocity * counts < 2**31
    assert length * (velocity * counts + 1) * 2 < 2**32
    assert velocity / 2**21 <= (1 + 1e-15) / counts <= velocity / 2**20 * (1 + 1e-15)


def test_count_is_twice_what_real_makes_of_a_speed() -> None:
    """Half a unit in the last place of REAL is 2^-24 of a speed, and a few roundings come together."""
    for velocity in (0.1, 1.0, 12.0, 5000.0):
        assert 1.0 / counts_per_unit(velocity, 16) > 4 * velocity * 2.0**-24


@pytest.mark.parametrize(("velocity", "counts"), [(1.0, 2.0**21), (2.0, 2.0**20), (12.0, 2.0**17), (0.75, 2.0**21)])
def test_counts_by_hand(velocity: float, counts: float) -> None:
    assert counts_per_unit(velocity, 16) == counts


def test_fits_make_little_difference_to_the_duration() -> None:
    times = [ramps_of(name).ramp_time(12.0) for name in FITS]
    assert max(times) / min(times) < 1.001
