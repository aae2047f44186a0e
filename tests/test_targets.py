"""The table of targets, and the names they take."""

from __future__ import annotations

import pytest

from plcgen.errors import PlcgenError
from plcgen.names import RESERVED_WORDS, STANDARD_BLOCKS, name_fault, nearest, one_of
from plcgen.plc.importrules import smart_text
from plcgen.plc.scl import dialects
from plcgen.targets import TARGETS, target


def test_each_row_is_found_by_its_name() -> None:
    assert {name: target(name).name for name in TARGETS} == {name: name for name in TARGETS}


def test_spelling_on_disk() -> None:
    classic, tia, smart = target("s7-300-scl"), target("tia-scl"), target("s7-200-smart")
    assert (classic.own_codec, classic.newline, classic.suffix, classic.max_identifier) == (None, "\r\n", ".scl", 24)
    stl = target("s7-300-stl")
    assert (stl.own_codec, stl.newline, stl.suffix, stl.max_identifier) == (None, "\r\n", ".awl", 24)
    assert (tia.own_codec, tia.newline, tia.suffix, tia.max_identifier) == ("utf-8-sig", "\r\n", ".scl", 128)
    assert (smart.own_codec, smart.newline, smart.suffix, smart.max_identifier) == (None, "\r\n", ".awl", 23)
    assert (classic.codec("en"), classic.codec("zh"), smart.codec("zh")) == ("ascii", "gbk", "gbk")
    assert (tia.codec("en"), tia.codec("zh")) == ("utf-8-sig", "utf-8-sig")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("s7-300-sc", 'unknown target "s7-300-sc"; write "s7-300-scl"'),
        ("TIA-SCL", 'unknown target "TIA-SCL"; write "tia-scl"'),
        ("s7-200", 'unknown target "s7-200"; write "s7-200-smart"'),
        ("tia", 'unknown target "tia"; write "tia-scl"'),
        ("codesys", 'unknown target "codesys"; write "s7-300-scl", "s7-300-stl", "tia-scl" or "s7-200-smart"'),
    ],
)
def test_unknown_target(name: str, message: str) -> None:
    with pytest.raises(PlcgenError) as caught:
        target(name)
    assert str(caught.value) == message


def test_dialects_of_the_table_exist() -> None:
    known = {dialect.name: dialect.identifier_length for dialect in (dialects.CLASSIC, dialects.TIA)}
    known["stl"] = dialects.CLASSIC.identifier_length  # STEP 7 V5 takes the names of SCL and STL alike
    known["smart"] = smart_text.IDENTIFIER_LENGTH
    assert {row.dialect: row.max_identifier for row in TARGETS.values()} == known


@pytest.mark.parametrize("word", sorted(dialects.RESERVED_WORDS | RESERVED_WORDS | STANDARD_BLOCKS))
def test_reserved_word_is_no_name(word: str) -> None:
    assert name_fault(word)
    assert name_fault(word.lower())


@pytest.mark.parametrize(
    "name", ["DB1", "fb7", "OB35", "M0", "I0", "QB2", "MW10", "PIW256", "DBX0", "E5", "AW2", "T1", "Z3", "C9"]
)
def test_address_is_no_name(name: str) -> None:
    assert name_fault(name) == "reads as an address; write a name that is not an area and a number"


@pytest.mark.parametrize("name", ["MainShaft", "a", "Axis1", "Shaft_2", "Level_To_Level", "M0_1", "Main_2", "Hoist_DB"])
def test_ordinary_name(name: str) -> None:
    assert name_fault(name) is None


def test_nearest_word() -> None:
    assert nearest("Travel", ["travel", "jerk"]) == "travel"
    assert nearest("jerk_limit", ["travel", "jerk"]) == "jerk"
    assert nearest("colour", ["travel", "jerk"]) is None


def test_words_in_a_row() -> None:
    assert one_of(["a"]) == '"a"'
    assert one_of(["a", "b", "c"]) == '"a", "b" or "c"'
