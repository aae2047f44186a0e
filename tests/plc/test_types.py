"""Codecs and the layout of data blocks."""

from __future__ import annotations

import math

import pytest

from plcgen.plc.layout import Member, arrange, read, write
from plcgen.plc.types import (
    BOOL,
    BYTE,
    CHAR,
    DATE_AND_TIME,
    DINT,
    ELEMENTARY,
    INT,
    LREAL,
    REAL,
    WORD,
    Array,
    String,
    Type,
    elementary,
    round_real,
)


def offsets(*members: tuple[str, Type]) -> dict[str, tuple[int, int]]:
    structure = arrange("", [[Member(name, kind) for name, kind in members]])
    return {field.name: divmod(field.bit, 8) for field in structure.fields} | {"end": divmod(structure.bits, 8)}


def test_bits_share_bytes_and_words_start_even() -> None:
    assert offsets(("a", BOOL), ("b", BOOL), ("c", BYTE), ("d", BOOL), ("e", REAL), ("f", CHAR)) == {
        "a": (0, 0),
        "b": (0, 1),
        "c": (1, 0),
        "d": (2, 0),
        "e": (4, 0),
        "f": (8, 0),
        "end": (10, 0),
    }


def test_arrays_and_structures_start_and_end_even() -> None:
    inner = arrange("inner", [[Member("x", INT), Member("y", BYTE)]])
    members = (("a", BOOL), ("b", Array(((1, 3),), BYTE)), ("c", BYTE), ("d", inner), ("e", Array(((0, 8),), BOOL)))
    assert offsets(*members) == {"a": (0, 0), "b": (2, 0), "c": (6, 0), "d": (8, 0), "e": (12, 0), "end": (14, 0)}


def test_sections_start_even() -> None:
    structure = arrange("FB1", [[Member("input", BOOL)], [Member("output", BOOL)]])
    assert [field.bit for field in structure.fields] == [0, 16]


def test_view_lies_upon_the_viewed_member() -> None:
    structure = arrange("", [[Member("raw", WORD), Member("high", BYTE, view_of="RAW"), Member("next", INT)]])
    assert [field.bit for field in structure.fields] == [0, 0, 16]


def test_initial_values_of_members() -> None:
    initial = (5).to_bytes(2, "big")
    structure = arrange("", [[Member("b", BOOL, b"\1"), Member("n", INT, initial), Member("t", DATE_AND_TIME)]])
    assert structure.initial.hex() == "0100" + "0005" + "9001010000000002"


def test_last_index_runs_fastest() -> None:
    grid = Array(((1, 2), (-1, 1)), DINT)
    assert [grid.offset((row, column)) // 32 for row in (1, 2) for column in (-1, 0, 1)] == [0, 1, 2, 3, 4, 5]
    assert str(grid) == "ARRAY[1..2, -1..1] OF DINT"


@pytest.mark.parametrize("kind", ELEMENTARY.values(), ids=str)
def test_every_type_survives_memory(kind: Type) -> None:
    image = bytearray(b"\xff" * 16)
    values = (0, 1) if kind is BOOL else (getattr(kind, "minimum", 0), 0, 1, getattr(kind, "maximum", 0))
    for value in (0.5, -1.0, math.inf) if kind in (REAL, LREAL) else values:
        write(image, 16, kind, elementary(str(kind)).encode(value))  # type: ignore[union-attr]
        assert read(image, 16, kind) == value


def test_memory_is_big_endian() -> None:
    assert DINT.encode(1).hex() == "00000001"
    assert REAL.encode(1.0).hex() == "3f800000"
    assert String(4).encode("ab").hex() == "040261620000"
    assert String.decode(String(3).encode("longer")) == "lon"


def test_real_is_the_nearest_32_bit_float() -> None:
    assert round_real(16777217.0) == 16777216.0
    assert round_real(1e39) == math.inf


def test_fill_pattern_shows_in_every_type() -> None:
    assert INT.filled(0xCC) == -13108
    assert BOOL.filled(0xFF) is True
    assert REAL.filled(0xFF) != REAL.filled(0xFF)
