"""Jobs of the method `cosine` that could not be kept: each rule refuses with the numbers and the way out."""

from __future__ import annotations

from math import floor, log10

from numpy.polynomial import Polynomial

from plcgen.job import Job
from plcgen.profile.cosine import CYCLE_RANGE, Ramps
from plcgen.profile.cosine_fit import CENTRED, Fit, extremes, is_monotone
from plcgen.profile.cosine_move import MOST_SAMPLES, Moves

MOST_RAMP_SAMPLES = 2**23
"""REAL holds 2 k - N exactly up to 2^24."""
MARK = 1e-9
"""Of the end of a law, beside it by rounding only."""


def derive_ramps(job: Job) -> Ramps:
    """The law of a job of ramps. Raises JobError."""
    ramps = Ramps.of(job)
    _refuse_wrong_fit(job, ramps.fit)
    _refuse_many_samples(job, ramps)
    return ramps


def derive_moves(job: Job) -> Moves:
    """The law of a job of moves. Raises JobError."""
    moves = Moves.of(job)
    _refuse_wrong_fit(job, moves.fit)
    for index, move in enumerate(job.cosine.moves):
        _refuse_distance(job, moves, index, move.distance or 0.0)
    return moves


def fit_fault(fit: Fit) -> str | None:
    """What is wrong with the polynomial that would be emitted, as the end of a sentence; None when it is right."""
    law, polynomial = fit.law, fit.repaired
    short = abs(float(polynomial(1.0)) - (1.0 if law is CENTRED else -1.0))
    if short > MARK:
        return f"ends {short:.2g} beside its mark"
    if abs(float(polynomial.deriv()(1.0))) > MARK:
        return "does not end at rest"
    if not is_monotone(law, polynomial):
        return "turns back on its way: the speed would overshoot"
    if law is CENTRED and _highest(polynomial.deriv(2)) > MARK:
        return "has its largest acceleration beside the middle of a ramp"
    return None


def _highest(polynomial: Polynomial) -> float:
    return extremes(polynomial)[1]


def _refuse_wrong_fit(job: Job, fit: Fit) -> None:
    fault = fit_fault(fit)
    if fault:
        way_out = "write another seed" if fit.name == "genetic" else 'write "minimax"'
        raise job.error("cosine.fit", f'fit = "{fit.name}" {fault}; {way_out}')


def _refuse_many_samples(job: Job, ramps: Ramps) -> None:
    """Of a ramp over the whole range at the shortest plausible cycle."""
    longest = ramps.ramp_time(2 * ramps.max_velocity)
    most = floor(MOST_RAMP_SAMPLES / CYCLE_RANGE)
    if longest / job.sample_period > most:
        raise job.error(
            "sample_period",
            f"sample_period = {job.sample_period:g} s is too short: a ramp over the whole range takes {longest:.4g} s, "
            f"{longest / job.sample_period:.0f} samples of {most} at the most; raise max_acceleration and jerk, or "
            "lengthen sample_period",
        )


def _refuse_distance(job: Job, moves: Moves, index: int, written: float) -> None:
    key, unit, distance = f"cosine.moves[{index}].distance", job.length_unit, abs(written)
    samples = max(moves.samples(distance)) if distance else 0
    if distance > moves.max_distance:
        raise job.error(
            key,
            f"distance = {written:g} {unit} takes {samples} samples; {MOST_SAMPLES} are the most, enough for "
            f"{_rounded_down(moves.max_distance):g} {unit}; divide it, or lengthen sample_period",
        )
    if distance < moves.min_distance:
        raise job.error(
            key,
            f"distance = {written:g} {unit} is shorter than a count of speed in a sample, {moves.min_distance:.3g} "
            f"{unit}; write more, or lower max_velocity",
        )


def _rounded_down(value: float) -> float:
    """Three digits that are not above the value."""
    step = 10.0 ** (floor(log10(value)) - 2)
    return floor(value / step) * step
