"""Negative control: slips of the finger in the STL for the S7-300, and whether verification catches them.

Run seeded_faults_s7_stl.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

import pytest

from tests.check.harmless_faults_cosine_stl import S7_MOVE, S7_RAMP
from tests.check.harmless_faults_s7_stl import HARMLESS
from tests.check.seeded_faults_s7_stl import all_faults, survivors

SAMPLE = {"hoist": 20, "ramp": 20, "move": 20}
LISTS = {"hoist": HARMLESS, "ramp": S7_RAMP, "move": S7_MOVE}
KNOWN = {case: {row for rows in harmless.values() for row in rows} for case, harmless in LISTS.items()}


@pytest.mark.parametrize("case", LISTS)
def test_every_fault_that_changes_behaviour_is_caught(case: str) -> None:
    faults = random.Random(2026).sample(all_faults(case), SAMPLE[case])
    harmful = [fault for fault in faults if fault.note not in KNOWN[case]]
    assert len(harmful) >= 0.75 * len(faults)
    assert [fault.note for fault in survivors(case, harmful)] == []


@pytest.mark.parametrize("case", LISTS)
def test_harmless_faults_are_faults(case: str) -> None:
    """The list holds nothing that is no longer in the source."""
    assert sorted(KNOWN[case] - {fault.note for fault in all_faults(case)}) == []


@pytest.mark.parametrize("case", LISTS)
def test_harmless_faults_do_survive(case: str) -> None:
    """A sample of the list: what is caught today does not belong there. A row may stand in a network twice."""
    notes = random.Random(2026).sample(sorted(KNOWN[case]), 4)
    some = [fault for fault in all_faults(case) if fault.note in notes]
    assert {fault.note for fault in survivors(case, some)} == set(notes)
