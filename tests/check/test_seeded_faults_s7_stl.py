"""Negative control: slips of the finger in the STL of the hoist, and whether verification catches them.

Run seeded_faults_s7_stl.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

from tests.check.seeded_faults_s7_stl import all_faults, survivors

TRIED, SAMPLE = 160, 28
"""Of this many faults the survivors are known; a test tries some of them."""
HARMLESS = {
    "Both sides of an equality give the same, or no trip stands on it.": (
        "Before the slow end: its speed | <=R ; -> <R ;",
        "Beyond the fast end: its speed | L 0.000000e+000; -> L 1.000000e-003;",
        "1.3 Stops: both plausible, and far enough from each other | >=R ; -> >R ;",
        "3.2 Did the travel jump since the last scan? | <R ; -> <=R ;",
        "7.2 Bisection: try the full speed, then halve | <=R ; -> <R ;",
        "9.2 Stop ramp: begin in arrears, amid the cycle to come | <R ; -> <=R ;",
        "9.3 a_p^2 = m v + a^2/2 brings speed and acceleration to zero | >R ; -> >=R ;",
        "10.7 a = sqrt(2 m dv) from the nearer corner, within the peak | >R ; -> >=R ;",
    ),
}
KNOWN = {row for rows in HARMLESS.values() for row in rows}
