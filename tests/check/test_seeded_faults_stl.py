"""Negative control: slips of the finger in the program for the S7-200 SMART, and whether verification catches them.

Run seeded_faults_stl.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

import pytest

from tests.check.harmless_faults_stl import HARMLESS
from tests.check.seeded_faults_stl import all_faults, survivors

MODES = ("interrupt", "table")
KNOWN = {mode: {row for rows in HARMLESS[mode].values() for row in rows} for mode in MODES}
SAMPLE = 80


@pytest.mark.parametrize("mode", MODES)
def test_every_fault_that_changes_behaviour_is_caught(mode: str) -> None:
    faults = random.Random(2026).sample(all_faults(mode), SAMPLE)
    harmful = [fault for fault in faults if fault.note not in KNOWN[mode]]
    assert len(harmful) >= 0.75 * len(faults)
    assert [fault.note for fault in survivors(mode, harmful)] == []


@pytest.mark.parametrize("mode", MODES)
def test_harmless_faults_are_faults(mode: str) -> None:
    """The list holds nothing that is no longer in the program."""
    assert sorted(KNOWN[mode] - {fault.note for fault in all_faults(mode)}) == []


@pytest.mark.parametrize("mode", MODES)
def test_harmless_faults_do_survive(mode: str) -> None:
    """A sample of the list: what is caught today does not belong there."""
    known = [fault for fault in all_faults(mode) if fault.note in KNOWN[mode]]
    some = random.Random(2026).sample(known, 6)
    assert list(survivors(mode, some)) == some
