"""Two synchronous axes on a straight line, in pulses: seed 004, sections 1.2 to 1.5, corrected and completed.

The axis that goes farther leads; the other follows with gamma times its travel. A move takes a whole number of samples
N: the profile is stretched by l = N T/T_opt, so that v, a and beta shrink by 1/l, 1/l^2 and 1/l^3 and keep within their
limits.

| letter | word                         | letter | word                                |
|--------|------------------------------|--------|-------------------------------------|
| T      | sample period                | N      | samples of a move                   |
| k1, k2 | t1/T, t2/T                   | s1..s3 | travel of phases 1 to 3             |
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import copysign, floor

from plcgen.job import Job, Move, TwoAxisLimits
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.profile.reference import Reference
from plcgen.profile.seven_phase import Limits, SevenPhases, fixed_jerk_time, time_optimal

# A sample count that comes out this little above a whole number is that number: REAL knows no better.
SAMPLE_TOLERANCE = 1e-3
# Share of a sample in which its pulses are sent; the rest is for interrupts that come late.
TRAIN_SHARE = 15 / 16
HIGHEST_PULSE_RATE = 100_000.0  # Hz
# Acceleration travel beyond this is no longer known to a quarter of a pulse in REAL.
LONGEST_ACCELERATION = 2.0**22  # pulses
MOST_SAMPLES = 2**23
# Table mode: whole Hz put a segment of 1 s off by a quarter of a pulse, so that 200 segments of 3.2 s keep the path.
LONGEST_TABLE = 640.0  # s
# An output cannot go below 1 Hz: what is slower at the ends of a move runs ahead, and must be caught up with.
SLOWEST_TABLE = 8.0  # Hz
# The output stops at a segment shorter than 500 us.
SHORTEST_JERK_TIME = 0.002  # s


@dataclass(frozen=True)
class AxisMove:
    """A move as the PLC sees it: signed pulses of x and y, and which of them leads."""

    x: int
    y: int
    x_leads: bool

    @property
    def lead(self) -> int:
        return abs(self.x if self.x_leads else self.y)

    @property
    def follow(self) -> int:
        return abs(self.y if self.x_leads else self.x)


@dataclass(frozen=True)
class TwoAxisMove:
    """A planned move: its pulses, the fastest profile, and the one that is run in whole samples."""

    pulses: AxisMove
    fastest: SevenPhases
    samples: int
    sample_period: float

    @cached_property
    def profile(self) -> SevenPhases:
        return self.fastest.stretched(self.samples * self.sample_period)

    @cached_property
    def reference(self) -> Reference:
        """Of the leading axis, in length units."""
        return Reference(list(self.profile.phases()))


def limits_of(keys: TwoAxisLimits) -> Limits:
    return Limits(keys.max_velocity, keys.max_acceleration, keys.jerk)


def ordered(keys: TwoAxisLimits, move: Move) -> tuple[int, int]:
    """Pulses of x and y that are asked for, rounded half away from zero."""
    return _rounded(move.x * keys.pulses_per_unit[0]), _rounded(move.y * keys.pulses_per_unit[1])


def pulses_of(keys: TwoAxisLimits, move: Move) -> AxisMove:
    """What is below the threshold counts as zero. The longer one in length units leads."""
    x, y = (0 if abs(count) < keys.ignore_below else count for count in ordered(keys, move))
    return AxisMove(x, y, abs(x) / keys.pulses_per_unit[0] >= abs(y) / keys.pulses_per_unit[1])


def _rounded(value: float) -> int:
    return int(copysign(floor(abs(value) + 0.5), value))


def plan_move(job: Job, pulses: AxisMove) -> TwoAxisMove:
    """Raises ValueError for a move without pulses."""
    keys = job.two_axis
    ppu = keys.pulses_per_unit[0 if pulses.x_leads else 1]
    if pulses.lead == 0:
        raise ValueError("a move without pulses")
    plan = time_optimal if keys.short_moves == "time-optimal" else fixed_jerk_time
    fastest = plan(pulses.lead / ppu, limits_of(keys))
    samples = floor(fastest.duration / job.sample_period - SAMPLE_TOLERANCE) + 1
    return TwoAxisMove(pulses, fastest, samples, job.sample_period)


def two_axis_constants(job: Job) -> tuple[ConstantGroup, ...]:
    """Named as in the paper; what the PLC program holds."""
    keys, unit = job.two_axis, job.length_unit
    limits, period = limits_of(keys), job.sample_period
    full = _full_speed_phases(limits)
    speed, rate, snap = f"{unit}/s", f"{unit}/s2", f"{unit}/s3"
    ppu_x, ppu_y = keys.pulses_per_unit
    return (
        ConstantGroup(
            "Limits",
            (
                Constant("V_MAX", limits.velocity, speed, "speed of the leading axis"),
                Constant("A_MAX", limits.acceleration, rate, "acceleration of the leading axis"),
                Constant("BETA", limits.jerk, snap, "jerk of the leading axis"),
                Constant("T_SAMPLE", period, "s", "sample period"),
                Constant("PPU_X", ppu_x, f"1/{unit}", "pulses for a unit of x"),
                Constant("PPU_Y", ppu_y, f"1/{unit}", "pulses for a unit of y"),
            ),
        ),
        ConstantGroup(
            "Phases at full speed",
            (
                Constant("T1", full.t1, "s", "t_1, time of a phase of jerk", "(3)"),
                Constant("K1", full.t1 / period, "1", "k_1 = t_1/T"),
                Constant("T2", full.t2, "s", "t_2, time of constant acceleration", "(7)"),
                Constant("K2", full.t2 / period, "1", "k_2 = t_2/T"),
                *(
                    Constant(f"S{number}", travel, unit, f"s_{number}, travel of phase {number}", equation)
                    for number, travel, equation in zip(
                        (1, 2, 3), _phase_travels(full), ("(3)", "(5)", "(7)"), strict=True
                    )
                ),
                Constant("S_JERK", jerk_distance(limits), unit, "shortest distance that reaches A_MAX"),
                Constant("S_FULL", full_distance(limits), unit, "shortest distance that reaches V_MAX", "(17)"),
            ),
        ),
        ConstantGroup(
            "For each sample",
            (
                Constant("A_T", limits.acceleration * period, speed, "a_max T", "(22)"),
                Constant("BETA_T2", limits.jerk * period**2 / 2, speed, "beta T^2/2", "(21)"),
                Constant("TRAIN_RATE", 1 / (TRAIN_SHARE * period), "1/s", "samples for a second of pulses sent"),
            ),
        ),
    )


def _full_speed_phases(limits: Limits) -> SevenPhases:
    return time_optimal(full_distance(limits) * (1 + 1e-12), limits)


def _phase_travels(full: SevenPhases) -> tuple[float, float, float]:
    """s_1, s_2, s_3 of (3), (5) and (7)."""
    a, t1, t2 = full.acceleration, full.t1, full.t2
    return a * t1**2 / 6, a * (t1 * t2 + t2**2) / 2, 5 * a * t1**2 / 6 + a * t1 * t2


def full_distance(limits: Limits) -> float:
    """V T(V): from here on full speed is reached, (17) with t4 = 0."""
    h = limits.acceleration**2 / limits.jerk
    if h <= limits.velocity:
        return limits.velocity * (limits.velocity / limits.acceleration + limits.acceleration / limits.jerk)
    return float(2 * limits.velocity * (limits.velocity / limits.jerk) ** 0.5)


def jerk_distance(limits: Limits) -> float:
    """2 A^3/beta^2: up to here a move is jerk alone."""
    return 2 * limits.acceleration**3 / limits.jerk**2
