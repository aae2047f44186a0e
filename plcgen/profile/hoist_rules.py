"""Jobs that could not be kept: each rule refuses with the numbers and the way out, before anything is generated."""

from __future__ import annotations

from math import ceil, floor, log10

import numpy as np

from plcgen.job import Job
from plcgen.profile.hoist import Trip, creeping_travel, plan_trip
from plcgen.profile.reference import Reference, Samples

# Share of full speed that the envelope keeps above the setpoint: a hundred times the resolution of REAL.
ENVELOPE_CLEARANCE = 1e-5
# Ten samples in the shortest phase of jerk.
PHASE_SAMPLES = 10
# Of 1 mm, the promised accuracy of the stop, what the begin of the stop ramp may use up.
STOP_SHARE = 0.25
# Two scans at creep speed: one that the stop ramp may begin late, one for a measurement that is a scan old.
WINDOW_SCANS = 2.0
REAL_SPACING = 2.0**-23
METRES_PER_UNIT = {"m": 1.0, "cm": 0.01, "mm": 0.001}


def derive(job: Job) -> Trip:
    """The trip of a job. Raises JobError where the limits cannot be met, sampled, or guarded."""
    limits = job.hoist
    _refuse_short_travel(job)
    trip = plan_trip(limits, limits.travel)
    _refuse_coarse_sampling(job, trip)
    _refuse_late_stop(job)
    _refuse_short_creep_in(job, trip)
    _refuse_unresolved_creep(job)
    _refuse_narrow_overwind(job)
    _refuse_low_envelope(job, trip)
    return trip


def encoder_step(job: Job) -> float:
    """1 mm: no encoder of a hoist is coarser."""
    return 0.001 / METRES_PER_UNIT[job.length_unit]


def position_window(job: Job) -> float:
    """Distance from the stop within which the hoist counts as arrived."""
    return WINDOW_SCANS * job.hoist.creep_velocity * job.sample_period + encoder_step(job)


def _refuse_short_travel(job: Job) -> None:
    limits, unit = job.hoist, job.length_unit
    needed = creeping_travel(limits)
    if limits.travel < needed:
        raise job.error(
            "hoist.travel",
            f"travel = {limits.travel:.10g} {unit} is too short: start ramp, creep_out, creep_in and stop ramp "
            f"need {_rounded_up(needed)} {unit}; shorten creep_out or creep_in, or lower creep_velocity",
        )


def _refuse_coarse_sampling(job: Job, trip: Trip) -> None:
    """Ten samples in the shortest phase of jerk. With them the loop over travel cannot swing either.

    The setpoint v(S) is held for one scan and S may be a scan old, so near a point of the law the error of travel e
    obeys e(k+1) = e(k) - g e(k-1) with g = T dv/dS = T a/v; its roots are real, the error dies out without swinging,
    while g <= 1/4. No a/v of the law is above sqrt(m/(2 lo)), and the start ramp to lo has t1 <= sqrt(lo/m), so
    T <= t1/10 keeps g below 0.071.
    """
    shortest = trip.shortest_jerk_time
    if job.sample_period > shortest / PHASE_SAMPLES:
        raise job.error(
            "sample_period",
            f"sample_period = {job.sample_period:g} s is too long: the shortest phase lasts {shortest:.4g} s "
            f"and needs ten samples; {_way_out(trip)}",
        )


def _refuse_late_stop(job: Job) -> None:
    """The stop ramp begins up to a scan late and makes up for it: tau = e/v for v tau - m tau^3/6 = e. What is left,
    m T^3/6, adds to the error of the stop.
    """
    jerk = job.hoist.jerk * METRES_PER_UNIT[job.length_unit]
    longest = (6 * STOP_SHARE * 1e-3 / jerk) ** (1 / 3)
    if job.sample_period > longest:
        raise job.error(
            "sample_period",
            f"sample_period = {job.sample_period:g} s is too long to stop within 1 mm at jerk = {job.hoist.jerk:g} "
            f"{job.length_unit}/s3; {_shorter(longest, 'lower jerk')}",
        )


def _shorter(longest: float, remedy: str) -> str:
    """The longest sample period in whole milliseconds, or else another remedy."""
    milliseconds = floor(longest * 1000)
    return f"write at most {milliseconds / 1000:g}, or {remedy}" if milliseconds else remedy


def _refuse_short_creep_in(job: Job, trip: Trip) -> None:
    """A stop request is answered over time, a scan late: what the hoist travels in a scan must lie before the stop."""
    limits, unit = job.hoist, job.length_unit
    scan = trip.cruise_velocity * job.sample_period
    if limits.creep_in < scan:
        raise job.error(
            "hoist.creep_in",
            f"creep_in = {limits.creep_in:g} {unit} is shorter than what the hoist travels in one sample period at "
            f"full speed; write at least {_rounded_up(scan)}, or shorten sample_period",
        )


def _refuse_unresolved_creep(job: Job) -> None:
    """REAL must resolve what the hoist travels in a scan at creep speed."""
    limits = job.hoist
    slowest = 4 * REAL_SPACING * limits.travel / job.sample_period
    if limits.creep_velocity < slowest:
        raise job.error(
            "hoist.creep_velocity",
            f"creep_velocity = {limits.creep_velocity:g} {job.length_unit}/s is too slow: at travel = "
            f"{limits.travel:g} a REAL does not resolve a sample period of it; write at least {_rounded_up(slowest)}",
        )


def _refuse_narrow_overwind(job: Job) -> None:
    """Beyond the position window, and the resolution of the travel, there must be overwind left."""
    overwind = job.hoist.envelope.overwind
    narrowest = 1.5 * position_window(job) + 4 * REAL_SPACING * job.hoist.travel
    if overwind < narrowest:
        raise job.error(
            "hoist.envelope.overwind",
            f"overwind = {overwind:g} {job.length_unit} is too near to the {position_window(job):.4g} that count "
            f"as arrived; write at least {_rounded_up(narrowest)}, or lower creep_velocity",
        )


def _rounded_up(value: float) -> str:
    """Four digits that are not below the value."""
    step = 10.0 ** (floor(log10(value)) - 3)
    return f"{ceil(value / step) * step:.10g}"


def _way_out(trip: Trip) -> str:
    """Of a sample period that is too long: a shorter one in whole milliseconds, or longer phases."""
    # Where the travel leaves room for hardly more than creep speed, the change to full speed is what is short.
    barely_faster = trip.cruise_velocity < trip.limits.max_velocity and trip.shortest_jerk_time < trip.stop.jerk_time
    return _shorter(trip.shortest_jerk_time / PHASE_SAMPLES, "lengthen travel" if barely_faster else "lower jerk")


def _refuse_low_envelope(job: Job, trip: Trip) -> None:
    """The protection envelope must lie above the setpoint wherever the trip goes, by more than REAL may blur.

    A stop request is answered over time: held setpoints carry the hoist v T/2 beyond the law over travel. A full scan
    at full speed is granted, which serves a measurement that is a scan old too.
    """
    motion = trip.reference.at_time(_dense_times(trip.reference))
    place = np.minimum(motion.travel + trip.cruise_velocity * job.sample_period, trip.distance)
    margin: Samples = trip.envelope.velocity(place, trip.distance - place) - motion.velocity
    worst = int(np.argmin(margin))
    shortage = ENVELOPE_CLEARANCE * job.hoist.max_velocity - margin[worst]
    if shortage > 0:
        unit = job.length_unit
        raise job.error(
            "hoist.envelope",
            f"the envelope is {shortage:.3g} {unit}/s too low {trip.distance - motion.travel[worst]:.4g} {unit} before "
            "the end, where it must lie above the setpoint; raise overspeed_factor, the tracking values, "
            "brake_deceleration or end_velocity, or shorten reaction_time",
        )


def _dense_times(reference: Reference) -> Samples:
    """Two hundred instants in every phase, however short it is beside the others, and every corner."""
    corners = reference.corner_times
    phases = len(corners) - 1
    return np.interp(np.linspace(0.0, phases, 200 * phases + 1), np.arange(phases + 1), corners)
