"""The constants that the hoist block needs, and the table that `plcgen derive` prints."""

from __future__ import annotations

from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.profile.hoist import Trip, creeping_travel, stop_deceleration
from plcgen.profile.hoist_rules import PHASE_SAMPLES, encoder_step, position_window
from plcgen.profile.transition import Transition

# One scan may be lost before a change of the travel counts as a jump.
JUMP_SCANS = 2.0
# Stops may lie this many travels from the zero of the encoder; farther out REAL would lose resolution.
TRAVEL_RANGE_FACTOR = 4.0
# A speed beyond this multiple of full speed is no measurement.
VELOCITY_RANGE_FACTOR = 10.0
# Below this share of creep speed a restart takes the hoist as standing.
REST_SHARE = 0.01


def hoist_constants(job: Job, trip: Trip) -> tuple[ConstantGroup, ...]:
    """Constants of the block in the order of its source."""
    limits, unit = job.hoist, job.length_unit
    speed, rate, snap = f"{unit}/s", f"{unit}/s2", f"{unit}/s3"
    return (
        ConstantGroup(
            "Limits of the job",
            (
                Constant("CREEP_VELOCITY", limits.creep_velocity, speed, "creep speed"),
                Constant("CRUISE_VELOCITY", trip.cruise_velocity, speed, _cruise_comment(trip)),
                Constant("JERK", limits.jerk, snap, "m: jerk everywhere"),
                Constant("ACCELERATION_LIMIT", limits.acceleration, rate, "a: accelerate"),
                Constant("DECELERATION_LIMIT", limits.deceleration, rate, "a: decelerate, stop request"),
                Constant("START_LIMIT", limits.creep_acceleration, rate, "a: start ramp"),
                Constant("STOP_LIMIT", stop_deceleration(limits), rate, "a: stop ramp"),
                Constant("SAMPLE_PERIOD", job.sample_period, "s", "period of the cyclic interrupt"),
            ),
        ),
        ConstantGroup(
            "Trip from stop to stop",
            (
                Constant("MIN_TRAVEL", creeping_travel(limits), unit, "both ramps and both creep travels"),
                Constant("STOP_TRAVEL", trip.stop.travel, unit, "L of the stop ramp"),
                Constant("ACC_BEGIN", trip.acceleration_begin, unit, "S_A: start ramp and creep out"),
                Constant("DEC_END", trip.deceleration_end, unit, "creep in and stop ramp"),
                *_transition_constants("ACC", trip.acceleration, unit),
                *_transition_constants("DEC", trip.deceleration, unit),
            ),
        ),
        ConstantGroup(
            "Protection envelope",
            (
                Constant("OVERSPEED_VELOCITY", trip.envelope.overspeed_velocity, speed, "overspeed_factor V"),
                Constant("TRACKING_FACTOR", limits.envelope.tracking_factor, "1", "above the nominal speed"),
                Constant("TRACKING_MARGIN", limits.envelope.tracking_margin, speed, "above the nominal speed"),
                Constant("BRAKE_DECELERATION", limits.envelope.brake_deceleration, rate, "a_b"),
                Constant("REACTION_VELOCITY", trip.envelope.reaction_velocity, speed, "a_b t_r"),
                Constant("SAFE_SQUARE", trip.envelope.velocity_squared_at_end, f"({speed})^2", "(a_b t_r)^2 + v_e^2"),
            ),
        ),
        ConstantGroup(
            "Supervision",
            (
                Constant("OVERWIND", limits.envelope.overwind, unit, "travel beyond a stop that is an error"),
                Constant(
                    "POSITION_WINDOW", position_window(job), unit, "at the stop: two scans at creep speed and 1 mm"
                ),
                Constant("JUMP_SCANS", JUMP_SCANS, "1", "scans at envelope speed that are no jump"),
                Constant("ENCODER_STEP", encoder_step(job), unit, "a step of the encoder, on top of these"),
                Constant(
                    "MAX_CYCLE_TIME",
                    trip.shortest_jerk_time / PHASE_SAMPLES,
                    "s",
                    "a tenth of the shortest phase of jerk",
                ),
                Constant("TRAVEL_RANGE", TRAVEL_RANGE_FACTOR * limits.travel, unit, "stops within this are plausible"),
                Constant("VELOCITY_RANGE", VELOCITY_RANGE_FACTOR * limits.max_velocity, speed, "plausible speeds"),
                Constant("REST_VELOCITY", REST_SHARE * limits.creep_velocity, speed, "at rest after a restart"),
            ),
        ),
    )


def _cruise_comment(trip: Trip) -> str:
    reaches_limit = trip.cruise_velocity == trip.limits.max_velocity
    return "V: full speed" if reaches_limit else "V: full speed that fits into the travel"


def _transition_constants(prefix: str, transition: Transition, unit: str) -> tuple[Constant, ...]:
    return (
        Constant(f"{prefix}_PEAK", transition.peak_acceleration, f"{unit}/s2", "a_p = m t1", "(4)"),
        Constant(f"{prefix}_JERK_TIME", transition.jerk_time, "s", "t1 = a/m, or sqrt(dv/m) if short", "(4)"),
        Constant(f"{prefix}_TRAVEL", transition.travel, unit, "L = (lo + hi)/2 (dv/a_p + t1)", "(5)+(9)+(12)"),
    )


def transition_table(transition: Transition, unit: str) -> tuple[Constant, ...]:
    """Every derived quantity of one transition, for `plcgen derive`."""
    speed = f"{unit}/s"
    return (
        Constant("slow_velocity", transition.slow_velocity, speed, "speed at the slow end"),
        Constant("fast_velocity", transition.fast_velocity, speed, "speed at the fast end"),
        Constant("peak_acceleration", transition.peak_acceleration, f"{unit}/s2", "acceleration that is reached"),
        Constant("jerk_time", transition.jerk_time, "s", "Delta t_1 = t_3", "(4)"),
        Constant("middle_time", transition.middle_time, "s", "Delta t_2", "(8)"),
        Constant("duration", transition.duration, "s", "t_1 + t_2 + t_3"),
        Constant("slow_part_travel", transition.slow_corner_travel, unit, "Delta S_1", "(5)"),
        Constant("slow_corner_velocity", transition.slow_corner_velocity, speed, "v_1", "(4)"),
        Constant("middle_travel", transition.middle_travel, unit, "Delta S_2", "(9)"),
        Constant("fast_corner_travel", transition.fast_corner_travel, unit, "corner of the fast part", "(12)"),
        Constant("fast_corner_velocity", transition.fast_corner_velocity, speed, "v_2", "(11)"),
        Constant("fast_part_travel", transition.fast_part_travel, unit, "Delta S_3", "(12)"),
        Constant("travel", transition.travel, unit, "L = S_B - S_A", "(5)+(9)+(12)"),
    )
