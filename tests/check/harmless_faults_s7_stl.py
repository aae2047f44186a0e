"""Faults of the STL of the hoist that change nothing, or nothing that a run could show, each with the reason."""

from __future__ import annotations

HARMLESS: dict[str, tuple[str, ...]] = {
    "Where acceleration ends, full speed has begun in the same scan.": (
        "8.4 Accelerate or full speed: to the begin of the deceleration | L 3; -> L 4;",
    ),
    "Slower than any hoist that counts as moving.": (
        "2.1 A hoist that still moves goes on from its speed to rest | L 0.000000e+000; -> L 1.000000e-003;",
        "2.1 A hoist that still moves goes on from its speed to rest | >R ; -> >=R ;",
    ),
    "Newton's method with a derivative that is 1 % off ends at the same root.": (
        "One step of Newton's method takes away the error of EXP and LN | L 2.000000e+000; -> L 2.020000e+000;",
        "One step of Newton's method takes away the error of EXP and LN | L 2.000000e+000; -> L 1.980000e+000;",
    ),
    "The time comes out with its sign turned, and is squared.": (
        "One step of Newton's method takes away the error of EXP and LN | TAK ; -> nothing",
    ),
    "Bisection stands still before.": ("7.2 Bisection: try the full speed, then halve | L 25; -> L 26;",),
    "The binary result of a function is read by nobody: the block sets its own.": (
        "Result from ACCU1 | SET ; -> CLR ;",
        "L = (lo + hi)/2 times the duration in ACCU1 | SET ; -> CLR ;",
    ),
    "Holds the same already, or is read only in phases that a travel that is not valid has ended.": (
        "3.1 Where the hoist stands in the direction of the trip | T #tempFromStart; -> nothing",
        "10.6 Law over travel: decelerate | T #tempTravel; -> nothing",
    ),
    "The other stop is beyond its range then, and the stops are refused all the same.": (
        "1.3 Stops: both plausible, and far enough from each other | <=R ; -> <R ;",
    ),
    "A corner is moved by less than 1 mm; both laws touch there, and speed and acceleration agree.": (
        "Before the slow end: its speed | L 0.000000e+000; -> L 1.000000e-003;",
        "Beyond the fast end: its speed | L 0.000000e+000; -> L 1.000000e-003;",
        "7.1 Between creep speed and full speed, or below creep speed | L 0.000000e+000; -> L 1.000000e-003;",
    ),
    "A part of the ramp that takes less than 1 mm/s, which no run meets.": (
        "9.4 First phase to a_p: its duration and the speed at its end | L 0.000000e+000; -> L 1.000000e-003;",
        "9.5 Second phase at a_p, if speed is left for it; third phase | L 0.000000e+000; -> L 1.000000e-003;",
    ),
    "Both sides of an equality give the same, or no run stands on it.": (
        "Before the slow end: its speed | <=R ; -> <R ;",
        "Beyond the fast end: its speed | <=R ; -> <R ;",
        "Slow part up to Delta S_1 = lo t1 + m t1^3/6 | >R ; -> >=R ;",
        "Fast part, the last Delta S_3 = hi t1 - m t1^3/6 | >R ; -> >=R ;",
        "Short transitions do not reach the limit of acceleration | >R ; -> >=R ;",
        "1.3 Stops: both plausible, and far enough from each other | >=R ; -> >R ;",
        "3.2 Did the travel jump since the last scan? | <R ; -> <=R ;",
        "4. Envelope over travel; without a valid travel the last one | <R ; -> <=R ;",
        "4.1 max(factor v, v + margin), at most the overspeed | <R ; -> <=R ;",
        "4.1 max(factor v, v + margin), at most the overspeed | >R ; -> >=R ;",
        "4.2 v_safe = -a_b t_r + sqrt((a_b t_r)^2 + v_e^2 + 2 a_b d) | >R ; -> >=R ;",
        "4.2 v_safe = -a_b t_r + sqrt((a_b t_r)^2 + v_e^2 + 2 a_b d) | <R ; -> <=R ;",
        "7.1 Between creep speed and full speed, or below creep speed | <R ; -> <=R ;",
        "7.2 Bisection: try the full speed, then halve | <=R ; -> <R ;",
        "7.4 Acceleration: t1 = a/m, or sqrt(dv/m) if short; a_p = m t1 | >R ; -> >=R ;",
        "7.5 Deceleration, likewise | >R ; -> >=R ;",
        "8.1 Start ramp: to its end | >=R ; -> >R ;",
        "8.2 Creep out: to the begin of the acceleration | >=R ; -> >R ;",
        "8.3 Accelerate: to full speed | <=R ; -> <R ;",
        "8.4 Accelerate or full speed: to the begin of the deceleration | >=R ; -> >R ;",
        "8.5 Decelerate: to creep speed | <=R ; -> <R ;",
        "8.6 From creep out to creep in: to the begin of the stop ramp | <=R ; -> <R ;",
        "9.2 Stop ramp: begin in arrears, amid the cycle to come | <R ; -> <=R ;",
        "9.3 a_p^2 = m v + a^2/2 brings speed and acceleration to zero | >R ; -> >=R ;",
        "9.4 First phase to a_p: its duration and the speed at its end | <R ; -> <=R ;",
        "9.5 Second phase at a_p, if speed is left for it; third phase | >R ; -> >=R ;",
        "10.1 Law over time; the start ramp is the ramp to rest backwards | <R ; -> <=R ;",
        "10.7 a = sqrt(2 m dv) from the nearer corner, within the peak | >R ; -> >=R ;",
        "10.7 a = sqrt(2 m dv) from the nearer corner, within the peak | <R ; -> <=R ;",
        "11. Setpoints, positive upwards, one of them clamped | >R ; -> >=R ;",
    ),
}
"""All 758 faults were tried; whatever survived stands here."""
