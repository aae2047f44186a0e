"""One recorded run of a block of the method `cosine`, and the figures of it, each with its bound.

Bounds of a speed, with u = 2^-24, half the spacing of REAL at 1:

* The law of a ramp, base + change s(y), is off by at most 16 u (|base| + |change|): y by u; s(y), four terms by Horner
  whose coefficients are D1 = 1.57 and less, by 10 u; two roundings of base and change each, the product, the sum.
* Where an acceleration dies out, its change of speed is computed from s'(y) of the ramp before, which is off by 40 u:
  33 u more of that ramp's change, since such a law is at most 0.41 as long. Sums over the laws so far: 50 u of each.
* The law of a move, D/(N T) u(k/N), has coefficients up to 8.1: 90 u for the four terms, 20 u for the factor; once
  stopped, the factor comes of a division of two such values: 300 u of D/(N T).
* A speed is rounded to a count, half of one. The average of n does not add to that.
* The setpoint is the sum times a constant: two roundings, and the constant's own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from plcgen.check.cosine_model import CosineModel, Motion, RampModel, Samples
from plcgen.check.verdict import Check
from plcgen.trajectory import Trajectory

UNIT_ROUNDOFF = 2.0**-24
RAMP_ROUNDING, MOVE_ROUNDING = 50 * UNIT_ROUNDOFF, 300 * UNIT_ROUNDOFF
NOISE_SHARE = 0.01
"""Of a limit: what the noise of the setpoint may take of the window over which a derivative is measured."""
NO_ORDER, FIRST_CALL, IN_PROGRESS, COMING_TO_REST, HELD, ABORTED = 0x7000, 0x7001, 0x7002, 0x7003, 0x7004, 0x7005
REACHED = 0x0000


@dataclass(frozen=True)
class Run:
    """Rows from the first order on, the likeliest reference, and the rows in which an order or a stop came."""

    name: str
    model: CosineModel
    before: float
    trace: Trajectory
    motion: Motion
    ordered: frozenset[int]
    cycle: float
    faults: int = 0
    is_single: bool = False

    @property
    def setpoint(self) -> Samples:
        return self.trace["velocitySetpoint"].astype(np.float64)


def likeliest(trace: Trajectory, motions: Iterable[Motion]) -> Motion:
    """The reference that comes nearest to the setpoints."""
    setpoint = trace["velocitySetpoint"].astype(np.float64)
    return min(motions, key=lambda motion: float(np.nan_to_num(np.abs(setpoint - motion.average), nan=np.inf).max()))


def run_checks(run: Run) -> Iterator[Check]:
    """Every figure of a run."""
    unit = run.model.unit
    speed, rate, snap = f"{unit}/s", f"{unit}/s2", f"{unit}/s3"
    yield Check("arithmetic_faults", float(run.faults), 0.0, "1")
    yield _worst("speed_deviation", speed, np.abs(run.setpoint - run.motion.average), speed_bound(run))
    yield _worst("acceleration_deviation", rate, *_acceleration(run))
    if "statVelocity" in run.trace.columns:
        deviation = np.abs(run.trace["statVelocity"] - run.motion.raw)
        yield _worst("law_deviation", speed, deviation, _rounding(run) + UNIT_ROUNDOFF * np.abs(run.motion.raw))
        yield _worst("average_deviation", speed, *_average(run))
    yield Check("end_speed_deviation", *_end_speed(run), speed)
    yield Check("wrong_flags", float(_wrong_flags(run)), 0.0, "1")
    yield Check("wrong_status", float(np.sum(run.trace["status"] != expected_status(run))), 0.0, "1")
    yield Check("velocity_limit", float(np.abs(run.setpoint).max()), _velocity_limit(run), speed)
    yield Check("acceleration_limit", *_acceleration_limit(run), rate)
    yield Check("jerk_limit", *_jerk_limit(run), snap)
    yield Check("distance_deviation", *_distance(run), unit)
    if run.is_single and "statVelocity" in run.trace.columns:
        yield Check("jerk_jump_before_average", *_jerk_jump(run, run.trace["statVelocity"], 1), snap)
        yield Check("jerk_jump", *_jerk_jump(run, run.trace["velocitySetpoint"], run.model.filter_length), snap)


def speed_bound(run: Run) -> Samples:
    """See above; an array."""
    noise = run.model.count / 2 + 4 * UNIT_ROUNDOFF * np.abs(run.motion.average)
    return np.asarray(_rounding(run) + noise)


def _rounding(run: Run) -> Samples:
    """What the arithmetic of the law makes of a speed."""
    factor = RAMP_ROUNDING if isinstance(run.model, RampModel) else MOVE_ROUNDING
    return np.asarray(factor * run.motion.changes)


def _worst(name: str, unit: str, deviation: Samples, bound: Samples) -> Check:
    """The row that comes nearest to its bound; NaN counts as the worst."""
    row = int(np.argmax(np.where(np.isnan(deviation), np.inf, deviation / np.maximum(bound, 1e-300))))
    return Check(name, float(deviation[row]), float(bound[row]), unit)


def _average(run: Run) -> tuple[Samples, Samples]:
    """The setpoint against the mean of the last n speeds of the block itself: rounded to counts, nothing else."""
    length = run.model.filter_length
    raw = np.concatenate([np.full(length - 1, run.before), run.trace["statVelocity"].astype(np.float64)])
    mean = np.convolve(raw, np.full(length, 1 / length), "valid")
    return np.abs(run.setpoint - mean), run.model.count / 2 + 4 * UNIT_ROUNDOFF * np.abs(mean)


def _acceleration(run: Run) -> tuple[Samples, Samples]:
    """Difference of two sums in counts: the speeds that come and go, each off by its bound, over n T."""
    expected = np.diff(run.motion.average, prepend=run.before) / run.cycle
    bound = 2 * speed_bound(run) / (run.model.filter_length * run.cycle) + 4 * UNIT_ROUNDOFF * np.abs(expected)
    return np.abs(run.trace["acceleration"] - expected), bound


def _end_speed(run: Run) -> tuple[float, float]:
    """At rest or at constant speed the setpoint is what was ordered, to the last bit; after a hold to the bound."""
    last = run.motion.average[-1]
    is_ordered = bool(run.motion.steady[-1]) and not run.motion.held[-1]
    return float(abs(run.setpoint[-1] - last)), 0.0 if is_ordered else float(speed_bound(run)[-1])


def _wrong_flags(run: Run) -> int:
    """Samples in which a flag is not what it should be; aborted and done show for a sample, as execute is a pulse."""
    motion, trace = run.motion, run.trace
    still = motion.steady & (motion.raw == 0.0)
    wanted = {
        "busy": motion.active,
        "done": motion.done,
        "commandAborted": aborted(motion),
        "error": np.zeros(len(trace), dtype=bool),
        "steady": motion.steady,
        "standstill": still,
    }
    return int(sum(np.sum(trace[name] != column) for name, column in wanted.items())) + int(
        np.sum(trace["velocitySetpoint"][still] != 0.0)
    )


def aborted(motion: Motion) -> Samples:
    """Samples in which an order ends without being done."""
    ends = np.append(motion.active[:1], motion.active[:-1]) & ~motion.active
    return np.asarray(ends & ~motion.done)


def expected_status(run: Run) -> Samples:
    motion = run.motion
    first = np.zeros(len(run.trace), dtype=bool)
    first[sorted(run.ordered)] = True
    in_progress = np.select([first, motion.held], [FIRST_CALL, HELD], IN_PROGRESS)
    ended = np.select([motion.done, aborted(motion)], [REACHED, ABORTED], NO_ORDER)
    return np.where(motion.active, in_progress, np.where(motion.steady, ended, COMING_TO_REST))


# ---------------------------------------------------------------------------------------------------------- limits


def _velocity_limit(run: Run) -> float:
    return run.model.max_velocity + float(speed_bound(run).max())


def _noise(run: Run) -> float:
    """Of one setpoint against its neighbours: a count in n comes and goes, and the setpoint itself is rounded.

    The law's own rounding changes from sample to sample, too.
    """
    largest = float(np.abs(run.motion.average).max())
    return run.model.count / 2 + 4 * UNIT_ROUNDOFF * largest + float(_rounding(run).max())


def _extended(run: Run) -> Samples:
    """Setpoints with some of the constant speed before and after them."""
    return np.concatenate([np.full(2, run.before), run.setpoint])


def _acceleration_limit(run: Run) -> tuple[float, float]:
    """Mean acceleration over a window in which the noise is below 1 % of the limit."""
    limit, speeds = run.model.max_acceleration, _extended(run)
    window = int(np.ceil(2 * _noise(run) / (NOISE_SHARE * limit * run.cycle)))
    if len(speeds) <= window:
        return 0.0, limit
    return float(np.abs(speeds[window:] - speeds[:-window]).max()) / (window * run.cycle), limit * (1 + NOISE_SHARE)


def _jerk_limit(run: Run) -> tuple[float, float]:
    """Second difference over windows in which the noise is below 1 % of the limit."""
    limit, speeds = run.model.jerk, _extended(run)
    window = int(np.ceil(np.sqrt(4 * _noise(run) / (NOISE_SHARE * limit)) / run.cycle))
    return _second_difference(speeds, window, run.cycle), limit * (1 + NOISE_SHARE)


def _second_difference(speeds: Samples, window: int, cycle: float) -> float:
    if len(speeds) <= 2 * window:
        return 0.0
    second = speeds[2 * window :] - 2 * speeds[window:-window] + speeds[: -2 * window]
    return float(np.abs(second).max()) / (window * cycle) ** 2


def _jerk_jump(run: Run, column: Samples, length: int) -> tuple[float, float]:
    """Largest change of jerk from sample to sample. Averaged over n, one sample of jerk comes, another goes, each
    within the limit (of a half-sine: within the jump of its acceleration, which n spreads): 2 J/n; before the average
    2 J, or for a half-sine 2 n J. A third difference carries eight times the noise of a speed.
    """
    speeds = np.concatenate([np.full(3, run.before), column.astype(np.float64)])
    spread = 1 if isinstance(run.model, RampModel) else run.model.filter_length
    noise = 8 * _noise(run) / run.cycle**2
    return float(np.abs(np.diff(speeds, 3)).max()) / run.cycle**2, 2 * run.model.jerk * spread / length + noise


def _distance(run: Run) -> tuple[float, float]:
    """What the setpoints add up to. Every setpoint is off by its bound at most."""
    return float(abs(np.sum(run.setpoint - run.motion.average))) * run.cycle, float(
        np.sum(speed_bound(run))
    ) * run.cycle
