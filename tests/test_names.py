"""A name that plcgen accepts is one that no target reads as something else."""

from __future__ import annotations

import pytest

from plcgen.names import name_fault, nearest, one_of
from plcgen.plc.scl import dialects


@pytest.mark.parametrize("word", sorted(dialects.RESERVED_WORDS | dialects.CLASSIC.reserved | dialects.TIA.reserved))
def test_words_of_the_parsers_are_reserved(word: str) -> None:
    assert name_fault(word)
    assert name_fault(word.lower())


@pytest.mark.parametrize("name", ["MainShaft", "A1_b", "x", "Shaft2"])
def test_good_names(name: str) -> None:
    assert name_fault(name) is None


@pytest.mark.parametrize(
    "name", ["FB100", "db1", "MW10", "T5", "EB0", "DBX1", "Real_To_Int", "Main", "OB", "1a", "a__b", "NUL", "com1"]
)
def test_names_that_mean_something_else(name: str) -> None:
    assert name_fault(name)


@pytest.mark.parametrize(
    ("word", "near"),
    [("max_velocty", "max_velocity"), ("TRAVEL", "travel"), ("xyz", None), ("velocity", "max_velocity")],
)
def test_nearest(word: str, near: str | None) -> None:
    assert nearest(word, ["travel", "max_velocity", "jerk"]) == near


def test_one_of() -> None:
    assert one_of(["m"]) == '"m"'
    assert one_of(["m", "cm", "mm"]) == '"m", "cm" or "mm"'
