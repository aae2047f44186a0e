"""Negative control: slips of the finger in the STL of the hoist, and whether verification catches them.

Run seeded_faults_s7_stl.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

from tests.check.seeded_faults_s7_stl import all_faults, survivors

TRIED, SAMPLE = 160, 28
"""Of this many faults the survivors are known; a test tries some of them."""
HARMLESS = {
    "Where acceleration ends, full speed has begun in the same scan.": (
        "8.4 Accelerate or full speed: to the begin of the deceleration | L 3; -> L 4;",
    ),
    "Slower than any hoist that counts as moving.": (
        "2.1 A hoist that still moves goes on from its speed to rest | L 0.000000e+000; -> L 1.000000e-003;",
    ),
    "Both sides of an equality give the same, or no trip stands on it.": (
        "Before the slow end: its speed | <=R ; -> <R ;",
        "Beyond the fast end: its speed | L 0.000000e+000; -> L 1.000000e-003;",
        "1.3 Stops: both plausible, and far enough from each other | >=R ; -> >R ;",
        "3.2 Did the travel jump since the last scan? | <R ; -> <=R ;",
        "7.2 Bisection: try the full speed, then halve | <=R ; -> <R ;",
        "9.2 Stop ramp: begin in arrears, amid the cycle to come | <R ; -> <=R ;",
        "9.3 a_p^2 = m v + a^2/2 brings speed and acceleration to zero | >R ; -> >=R ;",
        "10.1 Law over time; the start ramp is the ramp to rest backwards | <R ; -> <=R ;",
        "10.7 a = sqrt(2 m dv) from the nearer corner, within the peak | <R ; -> <=R ;",
        "10.7 a = sqrt(2 m dv) from the nearer corner, within the peak | >R ; -> >=R ;",
    ),
}
KNOWN = {row for rows in HARMLESS.values() for row in rows}


def test_every_fault_that_changes_behaviour_is_caught() -> None:
    tried = random.Random(1).sample(all_faults("hoist"), TRIED)
    faults = random.Random(2026).sample(tried, SAMPLE)
    harmful = [fault for fault in faults if fault.note not in KNOWN]
    assert len(harmful) >= 0.75 * len(faults)
    assert [fault.note for fault in survivors("hoist", harmful)] == []


def test_harmless_faults_are_faults() -> None:
    """The list holds nothing that is no longer in the source."""
    assert sorted(KNOWN - {fault.note for fault in all_faults("hoist")}) == []


def test_harmless_faults_do_survive() -> None:
    """A sample of the list: what is caught today does not belong there."""
    known = [fault for fault in all_faults("hoist") if fault.note in KNOWN]
    some = random.Random(2026).sample(known, 4)
    assert list(survivors("hoist", some)) == some
