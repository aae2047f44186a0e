"""Negative control: slips of the finger in the generated text, and whether verification catches them.

Run seeded_faults.py as a program to try every fault there is and to list the survivors.
"""

from __future__ import annotations

import random

import pytest

from tests.check.harmless_faults import HARMLESS
from tests.check.seeded_faults import SeededFault, all_faults, source_text, survivors

SAMPLE = {"s7-300-scl": 130, "tia-scl": 30}
KNOWN = {row for rows in HARMLESS.values() for row in rows}


def faults_of_the_body(target: str) -> list[SeededFault]:
    """Those in rows that both dialects spell alike but for `#`, so that one list serves both."""
    text = source_text(target)
    classic = {fault.within(source_text("s7-300-scl")) for fault in all_faults("s7-300-scl")}
    return [fault for fault in all_faults(target) if fault.within(text) in classic]


@pytest.mark.parametrize("target", SAMPLE)
def test_every_fault_that_changes_behaviour_is_caught(target: str) -> None:
    faults = random.Random(2026).sample(faults_of_the_body(target), SAMPLE[target])
    text = source_text(target)
    harmful = [fault for fault in faults if fault.within(text) not in KNOWN]
    assert len(harmful) >= 0.75 * len(faults)
    assert [fault.within(text) for fault in survivors(target, harmful)] == []


def test_harmless_faults_are_faults() -> None:
    """The list holds nothing that is no longer in the source."""
    text = source_text("s7-300-scl")
    assert sorted(KNOWN - {fault.within(text) for fault in all_faults("s7-300-scl")}) == []


def test_harmless_faults_do_survive() -> None:
    """A sample of the list: what is caught today does not belong there."""
    text = source_text("s7-300-scl")
    known = [fault for fault in all_faults("s7-300-scl") if fault.within(text) in KNOWN]
    some = random.Random(2026).sample(known, 10)
    assert list(survivors("s7-300-scl", some)) == some
