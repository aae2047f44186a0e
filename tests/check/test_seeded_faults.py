"""Negative control: slips of the finger in the generated text, and whether verification catches them.

Run seeded_faults.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

import pytest

from tests.check.harmless_faults import HARMLESS
from tests.check.harmless_faults_cosine import HARMLESS_MOVE, HARMLESS_RAMP
from tests.check.seeded_faults import SeededFault, all_faults, source_text, survivors

SAMPLE = {
    ("hoist", "s7-300-scl"): 90,
    ("hoist", "tia-scl"): 20,
    ("ramp", "s7-300-scl"): 60,
    ("ramp", "tia-scl"): 16,
    ("move", "s7-300-scl"): 48,
    ("move", "tia-scl"): 14,
}
LISTS = {"hoist": HARMLESS, "ramp": HARMLESS_RAMP, "move": HARMLESS_MOVE}
KNOWN = {case: {row for rows in harmless.values() for row in rows} for case, harmless in LISTS.items()}
CLASSIC = "s7-300-scl"


def faults_of_the_body(case: str, target: str) -> list[SeededFault]:
    """Those in rows that both dialects spell alike but for `#`, so that one list serves both."""
    text = source_text(case, target)
    classic = {fault.within(source_text(case, CLASSIC)) for fault in all_faults(case, CLASSIC)}
    return [fault for fault in all_faults(case, target) if fault.within(text) in classic]


@pytest.mark.parametrize(("case", "target"), SAMPLE)
def test_every_fault_that_changes_behaviour_is_caught(case: str, target: str) -> None:
    faults = random.Random(2026).sample(faults_of_the_body(case, target), SAMPLE[case, target])
    text = source_text(case, target)
    harmful = [fault for fault in faults if fault.within(text) not in KNOWN[case]]
    assert len(harmful) >= 0.75 * len(faults)
    assert [fault.within(text) for fault in survivors(case, target, harmful)] == []


@pytest.mark.parametrize("case", LISTS)
def test_harmless_faults_are_faults(case: str) -> None:
    """The list holds nothing that is no longer in the source."""
    text = source_text(case, CLASSIC)
    assert sorted(KNOWN[case] - {fault.within(text) for fault in all_faults(case, CLASSIC)}) == []


@pytest.mark.parametrize("case", LISTS)
def test_harmless_faults_do_survive(case: str) -> None:
    """A sample of the list: what is caught today does not belong there."""
    text = source_text(case, CLASSIC)
    known = [fault for fault in all_faults(case, CLASSIC) if fault.within(text) in KNOWN[case]]
    some = random.Random(2026).sample(known, 10)
    assert list(survivors(case, CLASSIC, some)) == some
