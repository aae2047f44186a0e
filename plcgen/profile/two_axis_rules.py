"""Two-axis jobs that could not be kept: each rule refuses with the numbers and the way out."""

from __future__ import annotations

from math import floor, log10

from plcgen.job import Job
from plcgen.profile.two_axis import (
    HIGHEST_PULSE_RATE,
    LONGEST_ACCELERATION,
    LONGEST_TABLE,
    MOST_SAMPLES,
    SHORTEST_JERK_TIME,
    SLOWEST_TABLE,
    TRAIN_SHARE,
    TwoAxisMove,
    full_distance,
    limits_of,
    plan_move,
    pulses_of,
)


def derive(job: Job) -> tuple[TwoAxisMove, ...]:
    """The moves of a job. Raises JobError where the limits cannot be met."""
    _refuse_high_rate(job)
    _refuse_long_acceleration(job)
    _refuse_unreached_acceleration(job)
    moves = tuple(plan_move(job, pulses_of(job.two_axis, move)) for move in job.two_axis.moves)
    for index, move in enumerate(moves):
        _refuse_many_samples(job, index, move)
        if job.two_axis.mode == "table":
            _refuse_what_no_table_holds(job, index, move)
    return moves


def _refuse_high_rate(job: Job) -> None:
    """Full speed in the share of a sample that pulses are sent in, and two pulses of rounding in each train.

    A train ends at twice its mean less its start. By the error of the trapezoidal rule that is at most
    beta T^2/6 or A T/2 beyond the speed of the profile, and never beyond twice the mean.
    """
    keys, unit, period = job.two_axis, job.length_unit, job.sample_period
    ppu = max(keys.pulses_per_unit)
    room = TRAIN_SHARE * HIGHEST_PULSE_RATE - 4 / period
    beyond = min(keys.jerk * period**2 / 6, keys.max_acceleration * period / 2) if keys.mode == "interrupt" else 0.0
    if keys.max_velocity > max(room / ppu - beyond, room / ppu / 2):
        reached = min(keys.max_velocity + beyond, 2 * keys.max_velocity)
        highest = _rounded_down(max(room / ppu - beyond, room / ppu / 2))
        raise job.error(
            "two-axis.max_velocity",
            f"max_velocity = {keys.max_velocity:g} {unit}/s takes up to {reached * ppu:.0f} pulses/s; "
            f"{room:.0f} can be sent; write at most {highest:g}, or lower pulses_per_unit",
        )


def _rounded_down(number: float) -> float:
    """To four digits, so that what a message advises is not refused again."""
    step = 10.0 ** (floor(log10(number)) - 3)
    return floor(number / step) * step


def _refuse_long_acceleration(job: Job) -> None:
    """REAL must know the pulses of the acceleration to a quarter of one."""
    keys = job.two_axis
    pulses = full_distance(limits_of(keys)) / 2 * max(keys.pulses_per_unit)
    if pulses > LONGEST_ACCELERATION:
        raise job.error(
            "two-axis.max_acceleration",
            f"max_acceleration = {keys.max_acceleration:g} takes {pulses:.0f} pulses to full speed; "
            f"{LONGEST_ACCELERATION:.0f} are the most; raise it or jerk, or lower max_velocity",
        )


def _refuse_unreached_acceleration(job: Job) -> None:
    """The paper's way holds t1 = A/beta for every move, so that A must be reached below V."""
    keys = job.two_axis
    lowest = keys.max_acceleration**2 / keys.jerk
    if keys.short_moves == "fixed-jerk-time" and keys.max_velocity < lowest:
        raise job.error(
            "two-axis.short_moves",
            f'short_moves = "fixed-jerk-time" needs max_velocity >= max_acceleration^2/jerk = {lowest:g}; '
            'raise jerk, or write "time-optimal"',
        )


def _refuse_many_samples(job: Job, index: int, move: TwoAxisMove) -> None:
    if move.samples > MOST_SAMPLES:
        raise job.error(
            f"two-axis.moves[{index}]",
            f"the move takes {move.samples} samples; {MOST_SAMPLES} are the most; lengthen sample_period",
        )


def _refuse_what_no_table_holds(job: Job, index: int, move: TwoAxisMove) -> None:
    key = f"two-axis.moves[{index}]"
    if move.fastest.duration > LONGEST_TABLE:
        raise job.error(
            key,
            f"the move takes {move.fastest.duration:.0f} s; a table holds {LONGEST_TABLE:.0f} s; divide it, or write "
            'mode = "interrupt"',
        )
    slowest = min(count for count in (move.pulses.lead, move.pulses.follow) if count) / move.fastest.duration
    if slowest < SLOWEST_TABLE:
        raise job.error(
            key,
            f"an axis sends {slowest:.3g} pulses/s in the mean; a table needs {SLOWEST_TABLE:g}, for an output cannot "
            'go below 1 Hz; raise ignore_below, or write mode = "interrupt"',
        )
    if move.fastest.t1 < SHORTEST_JERK_TIME:
        raise job.error(
            key,
            f"a phase of jerk takes {move.fastest.t1 * 1000:.3g} ms; a table needs {SHORTEST_JERK_TIME * 1000:g} ms; "
            'lower jerk, or write mode = "interrupt"',
        )
