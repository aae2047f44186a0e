"""Checks of one move: where every pulse is, against the profile, the straight line, the limits and the outputs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from plcgen.check.two_axis_model import MoveModel, Samples, TwoAxisModel
from plcgen.check.two_axis_rig import SECOND, Ride, Table
from plcgen.check.verdict import Check
from plcgen.plc.cpu.pto import Segment

SHORTEST_SEGMENT = 500e-6  # s
HIGHEST_RATE = 100_000.0  # Hz
BOUNDARY, BOUNDARY_PULSES = 1e-3, 1000
"""Segments of both axes end within so many s of each other, where the shorter axis has so many pulses."""


def move_checks(table: Table, ride: Ride) -> Iterator[Check]:
    """All that is asked of a move which has ended undisturbed."""
    yield from pulses(table, ride)
    if not table.segments(ride.first_tick):
        return
    motion = _motion_by_table if table.model.is_table else _motion_by_samples
    yield from motion(table.model, table, ride)


def pulses(table: Table, ride: Ride) -> Iterator[Check]:
    """Every pulse of a move has left when it is done, in its direction."""
    x, y = table.now()
    move = ride.move
    yield Check("lost_pulses_x", float(abs(ride.before[0] + move.x - x)), 0.0, "1")
    yield Check("lost_pulses_y", float(abs(ride.before[1] + move.y - y)), 0.0, "1")
    if not table.model.is_table:
        counted = abs(move.x) - table.get("done_x"), abs(move.y) - table.get("done_y")
        yield Check("uncounted_pulses", float(max(map(abs, counted))), 0.0, "1")
    amiss = any(table.get(name) for name in ("busy", "stopped", "refused", "killed"))
    yield Check("moves_not_done", float(amiss or not table.get("done")), 0.0, "1")
    wrong = move.is_short is not None and bool(table.get("short")) != move.is_short
    yield Check("wrong_flags", float(wrong or ride.told_early), 0.0, "1")


def ticks(model: TwoAxisModel, ride: Ride) -> Samples:
    """Instants in us at which each nominal sample of a move has been sent."""
    period = round(model.sample_period * SECOND)
    return ride.first_tick + period * np.arange(ride.move.samples + 1)


def lead_and_follow(table: Table, ride: Ride, times: Samples) -> tuple[Samples, Samples]:
    """Pulses of both axes since the start, without sign."""
    x, y = table.positions(times)
    x, y = np.abs(x - ride.before[0]), np.abs(y - ride.before[1])
    return (x, y) if ride.move.x_leads else (y, x)


def _motion_by_samples(model: TwoAxisModel, table: Table, ride: Ride) -> Iterator[Check]:
    move, period = ride.move, model.sample_period
    times = ticks(model, ride)
    lead, follow = lead_and_follow(table, ride, times)
    exact, _, _ = move.motion(np.arange(move.samples + 1) * period)
    gamma = move.follow_pulses / move.lead_pulses
    deviation = max(np.abs(lead - exact).max(), np.abs(follow - gamma * exact).max())
    yield Check("deviation_pulses", float(deviation), position_bound(move), "1")
    yield Check("wrong_samples", float(table.get("samples") != move.samples), 0.0, "1")
    # At a sample both axes are within 1/2 of rounding and 1 of the shared out rest. Inside a sample both trains begin
    # together; frequencies in whole Hz make them run apart by less than 1 Hz T, and one pulse is under way.
    yield Check("path_deviation", _path(model, table, ride), 3.0 + 2 * period, "1")
    yield _duration(model, table, ride)
    yield from limits(move, period, lead, orders=3)
    yield Check("overruns", float(table.get("overrun")), 0.0, "1")
    longest = max(s.duration for s in table.segments(ride.first_tick)) / SECOND
    # Frequencies are rounded up, so that no train is longer than its share.
    yield Check("longest_train", float(longest), model.train_share * period * (1 + 1e-6), "s")
    yield Check("frequency_deviation", _frequencies(model, table, ride), 0.51, "Hz")
    yield Check("rate_excess", _excess(model, table, ride), 1.001, "Hz")
    yield from _segments(table, ride)


def position_bound(move: MoveModel) -> float:
    """Pulses: 1/2 of rounding, 1/2 of the shared out rest, and 16 half spacings of REAL of the acceleration travel."""
    acceleration = move.velocity * (move.velocity / move.acceleration + move.acceleration / move.jerk) / 2
    return 1.0 + 2.0**-20 * min(acceleration, move.lead_pulses / 2)


def _motion_by_table(model: TwoAxisModel, table: Table, ride: Ride) -> Iterator[Check]:
    """Inside a segment the frequency is linear in time: chords of the profile, which keep speed and acceleration."""
    yield Check("path_deviation", _path(model, table, ride), 2.0, "1")
    yield _duration(model, table, ride)
    lead, _ = lead_and_follow(table, ride, ticks(model, ride))
    yield from limits(ride.move, model.sample_period, lead, orders=2)
    yield Check("frequency_deviation", _frequencies(model, table, ride), 0.51, "Hz")
    if ride.move.follow_pulses >= BOUNDARY_PULSES:
        yield Check("boundary_deviation", _boundaries(model, table, ride), BOUNDARY, "s")
    yield from _segments(table, ride)


def _frequencies(model: TwoAxisModel, table: Table, ride: Ride) -> float:
    """How far start frequencies are from the speed of the profile, in Hz, beyond what rounding makes of it. A constant
    frequency is right where the pulses, give or take the one of rounding, are too few for that start; in a sample the
    leading axis decides it for both, so that they stay on the line.
    """
    outputs = model.outputs if ride.move.x_leads else model.outputs[::-1]
    steady: set[float] = set()
    worst = 0.0
    for output, share in zip(outputs, (1.0, ride.move.follow_pulses / ride.move.lead_pulses), strict=True):
        segments = [s for s in table.cpu.channels[output].segments if s.start >= ride.first_tick]
        due = _due(model, ride, segments, share)
        for before, segment, (speed, acceleration) in zip([*segments[:1], *segments], segments, due, strict=False):
            constant = segment.first_hz == segment.last_hz
            if constant and (segment.start in steady or _too_few(model, segment, speed)):
                steady |= {segment.start} if not model.is_table else set()
                continue
            # The segment begins as late as whole Hz have made the one before it.
            late = BOUNDARY + 2 * _blur(before) if model.is_table else 0.0
            blur = late * (acceleration + ride.move.jerk * late * share) + 2e-6 * speed
            worst = max(worst, abs(segment.first_hz - speed) - blur)
    return worst


def _too_few(model: TwoAxisModel, segment: Segment, speed: float) -> bool:
    pulse = 0.0 if model.is_table else _pulse_rate(model)
    return 2 * _rate(segment) < speed + 4 + 2 * pulse


def _due(model: TwoAxisModel, ride: Ride, segments: Sequence[Segment], share: float) -> Iterator[tuple[float, float]]:
    """Speed and acceleration, without sign, that an axis should begin each segment with, in Hz and Hz/s."""
    scale = share if model.is_table else share / model.train_share
    times = np.array([(segment.start - ride.first_tick) / SECOND for segment in segments])
    _, speed, acceleration = ride.move.motion(times)
    return zip(np.maximum(1.0, speed * scale).tolist(), (np.abs(acceleration) * scale).tolist(), strict=True)


def stop_frequencies(table: Table, ride: Ride, lead: Samples) -> Check:
    """How far start frequencies of the leading axis are from the speed that its samples show, in Hz.

    Both samples beside it are within `position_bound` of the way, and 1/2 where the stop began, so that their
    difference over 2 T is within that over T; that the speed is no straight line makes beta T^2/6, and frequencies are
    whole Hz.
    """
    model, period, share = table.model, table.model.sample_period, table.model.train_share
    speed = np.gradient(lead.astype(np.float64), period) / share
    worst = 0.0
    for segment in table.cpu.channels[model.outputs[0 if ride.move.x_leads else 1]].segments:
        sample = round((segment.start - ride.first_tick) / SECOND / period)
        if segment.start < ride.first_tick or segment.first_hz == segment.last_hz or not 0 < sample < len(lead) - 1:
            continue
        worst = max(worst, abs(segment.first_hz - float(speed[sample])))
    off = (position_bound(ride.move) + 0.5) / period
    return Check("stop_frequency", worst, (off + ride.move.jerk * period**2 / 6) / share + 0.51, "Hz")


def _rate(segment: Segment) -> float:
    """Mean frequency in Hz."""
    return segment.pulses / segment.duration * SECOND


def _excess(model: TwoAxisModel, table: Table, ride: Ride) -> float:
    """How much faster than it need be a train of the leading axis is in the mean: whole Hz, rounded up."""
    lead = table.cpu.channels[model.outputs[0 if ride.move.x_leads else 1]]
    rate = _pulse_rate(model)
    return max((_rate(s) - s.pulses * rate for s in lead.segments if s.start >= ride.first_tick), default=0.0)


def _pulse_rate(model: TwoAxisModel) -> float:
    """Hz that a pulse more in a sample makes."""
    return 1 / (model.train_share * model.sample_period)


def _boundaries(model: TwoAxisModel, table: Table, ride: Ride) -> float:
    """How far the ends of segments of the axis that has fewer of them are from ends of the other's, in s, beyond what
    whole Hz make of both segments. Where a segment has a single pulse, near rest, neighbours may be joined.
    """
    both = [[s for s in table.cpu.channels[o].segments if s.start >= ride.first_tick] for o in model.outputs]
    few, many = sorted(both, key=len)
    ends, blurs = np.array([s.end / SECOND for s in many]), np.array([_blur(s) for s in many])
    apart = ((np.abs(ends - s.end / SECOND) - blurs).min() - _blur(s) for s in few if s.pulses > 1)
    return float(max(apart, default=0.0))


def _blur(segment: Segment) -> float:
    """s: start and end frequency are whole Hz, so their mean is up to 1/4 Hz off what the duration asks for."""
    return segment.duration / SECOND / 4 / max(1.0, (segment.first_hz + segment.last_hz) / 2 - 0.25)


def _path(model: TwoAxisModel, table: Table, ride: Ride) -> float:
    """How far both axes are from a straight line, at any time, in pulses of the one that has fewer."""
    move = ride.move
    times = np.linspace(ride.first_tick, ride.first_tick + (move.samples + 1) * model.sample_period * SECOND, 20_000)
    x, y = (table.cpu.channels[output].progress_at(times) for output in model.outputs)
    x, y = np.abs(x - ride.before[0]), np.abs(y - ride.before[1])
    return off_the_line(move, *((x, y) if move.x_leads else (y, x)))


def off_the_line(move: MoveModel, lead: Samples, follow: Samples) -> float:
    if move.lead_pulses >= move.follow_pulses:
        return float(np.abs(follow - move.follow_pulses / move.lead_pulses * lead).max())
    return float(np.abs(lead - move.lead_pulses / move.follow_pulses * follow).max())


def _duration(model: TwoAxisModel, table: Table, ride: Ride) -> Check:
    """Samples beyond the time optimum, from the first tick to the last pulse, and what whole Hz make of it."""
    last = max(table.segments(ride.first_tick), key=lambda segment: segment.end)
    blur = _blur(last) if model.is_table else 0.0
    extra = ((last.end - ride.first_tick) / SECOND - ride.move.fastest - blur) / model.sample_period
    return Check("extra_samples", float(extra), 1.0, "1")


def limits(move: MoveModel, period: float, lead: Samples, orders: int) -> Iterator[Check]:
    """Speed, acceleration and jerk of the leading axis between samples. Each position is within a pulse of the profile
    (1/2 of rounding, and 1/2 of the shared out rest), so the n-th difference is within 2^n pulses of it; a sample count
    that comes out a thousandth high is rounded down, which speeds the profile up by less than that of a sample.
    """
    haste = 1 + 2e-3 / move.samples
    still = np.concatenate(([0, 0, 0], lead, [lead[-1]] * 3)).astype(np.float64)
    rows = (
        ("velocity_limit", move.velocity, "1/s"),
        ("acceleration_limit", move.acceleration, "1/s2"),
        ("jerk_limit", move.jerk, "1/s3"),
    )
    for order, (name, limit, unit) in enumerate(rows[:orders], start=1):
        reached = float(np.abs(np.diff(still, order)).max()) / period**order
        yield Check(name, reached, limit * haste**order + 2**order / period**order, unit)


def _segments(table: Table, ride: Ride) -> Iterator[Check]:
    segments = table.segments(ride.first_tick)
    shortest = min(s.duration for s in segments) / SECOND
    yield Check("shortest_segment", float(shortest), SHORTEST_SEGMENT, "s", at_least=True)
    yield Check("highest_frequency", float(max(max(s.first_hz, s.last_hz) for s in segments)), HIGHEST_RATE, "Hz")
