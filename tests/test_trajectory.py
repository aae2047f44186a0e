"""Sampled columns and their CSV form."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.trajectory import LateColumns, Trajectory

EXAMPLE = Trajectory(
    {
        "time": np.array([0.0, 0.01, 1e-7]),
        "speed": np.array([0.1, 12.0, -1.5e-7], dtype=np.float32),
        "phase": np.array([1, -2, 3]),
        "busy": np.array([True, False, True]),
    }
)
CSV = "time,speed,phase,busy\n0,0.1,1,1\n0.01,12,-2,0\n0.0000001,-0.00000015,3,1\n"


def test_csv_as_written() -> None:
    assert EXAMPLE.to_csv() == CSV


def test_csv_reads_back() -> None:
    again = Trajectory.from_csv(CSV)
    assert tuple(again.columns) == ("time", "speed", "phase", "busy")
    assert all(column.dtype == np.float64 for column in again.columns.values())
    assert again["time"].tolist() == EXAMPLE["time"].tolist()
    assert again["speed"].astype(np.float32).tolist() == EXAMPLE["speed"].tolist()
    assert again["busy"].tolist() == [1.0, 0.0, 1.0]
    assert again.to_csv() == CSV


@settings(max_examples=300, deadline=None)
@given(st.lists(st.floats(allow_nan=False), max_size=20), st.lists(st.floats(width=32), max_size=20))
def test_every_value_survives(doubles: list[float], singles: list[float]) -> None:
    double = Trajectory({"value": np.array(doubles, dtype=np.float64)})
    assert Trajectory.from_csv(double.to_csv())["value"].tobytes() == double["value"].tobytes()
    single = np.array(singles, dtype=np.float32)
    again = Trajectory.from_csv(Trajectory({"value": single}).to_csv())["value"].astype(np.float32)
    assert np.array_equal(again, single, equal_nan=True)


@given(st.floats())
@settings(max_examples=500)
def test_numbers_are_spelt_without_exponents(value: float) -> None:
    spelt = Trajectory({"x": np.array([value])}).to_csv().splitlines()[1]
    assert spelt == np.format_float_positional(value, unique=True, trim="-")


def test_length_and_rows() -> None:
    assert (len(EXAMPLE), len(Trajectory({}))) == (3, 0)
    assert EXAMPLE.rows(np.array([2, 0]))["phase"].tolist() == [3, 1]
    assert EXAMPLE.rows(EXAMPLE["busy"])["phase"].tolist() == [1, 3]


def test_no_rows() -> None:
    empty = Trajectory({"a": np.array([]), "b": np.array([])})
    assert empty.to_csv() == "a,b\n"
    again = Trajectory.from_csv("a,b\n")
    assert (tuple(again.columns), len(again)) == (("a", "b"), 0)


def test_columns_of_different_length_are_refused() -> None:
    with pytest.raises(ValueError, match=r"columns of different length: \{'a': 1, 'b': 2\}"):
        Trajectory({"a": np.zeros(1), "b": np.zeros(2)})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "a trajectory needs a header line"),
        ("\n", "a trajectory needs a header line"),
        ("a,b\n1,2\n3\n", "row 3 has 1 cells; the header has 2"),
        ("a,b\n1,2,3,4\n", "row 2 has 4 cells; the header has 2"),
        ("a,b\n1,2\n\n", "row 3 has 0 cells; the header has 2"),
        ("a,a\n1,2\n", r"columns of the same name: \['a', 'a'\]"),
        ("a\nx\n", "could not convert string to float: 'x'"),
    ],
)
def test_other_text_is_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Trajectory.from_csv(text)


def test_digest_follows_every_value() -> None:
    changed = dict(EXAMPLE.columns)
    changed["speed"] = np.nextafter(EXAMPLE["speed"], np.float32(100.0))
    assert EXAMPLE.sha256() == Trajectory(dict(EXAMPLE.columns)).sha256()
    assert EXAMPLE.sha256() != Trajectory(changed).sha256()
    assert EXAMPLE.sha256() == "fec5d8e5352f819237a95d38da2bea76dc25ae3fc5d478764a9051023dc59140"


def test_the_same_is_the_same_in_every_bit() -> None:
    zeros = Trajectory({"a": np.array([0.0, 1.0]), "b": np.array([1, 2])})
    assert zeros.is_same(Trajectory({"a": np.array([0.0, 1.0]), "b": np.array([1, 2])}))
    for other in (
        {"a": np.array([-0.0, 1.0]), "b": np.array([1, 2])},
        {"a": np.array([0.0, 1.0], np.float32), "b": np.array([1, 2])},
        {"b": np.array([1, 2]), "a": np.array([0.0, 1.0])},
        {"a": np.array([0.0, 1.0])},
        {"a": np.array([0.0, 1.0, 1.0]), "b": np.array([1, 2, 2])},
    ):
        assert not zeros.is_same(Trajectory(other))


def test_values_that_come_again_keep_their_sign_and_their_place() -> None:
    columns = {"x": np.array([0.1, -0.0, 0.0, 0.1, 1e-7, 0.1], np.float32), "y": np.array([1e22, 2.5, -0.0, 2.5, 0, 3])}
    rows = ["x,y", "0.1,10000000000000000000000", "-0,2.5", "0,-0", "0.1,2.5", "0.0000001,0", "0.1,3"]
    assert Trajectory(columns).to_csv().splitlines() == rows


def test_columns_are_made_when_they_are_read() -> None:
    made = []

    def column(name: str) -> np.ndarray:
        made.append(name)
        return np.arange(4.0)

    late = Trajectory(LateColumns({name: partial(column, name) for name in ("a", "b", "c")}))
    chosen = late.rows(np.array([True, False, True, False]))
    assert (list(chosen.columns), made) == (["a", "b", "c"], [])
    assert [chosen["b"].tolist(), chosen["b"].tolist(), late["b"].tolist()] == [[0.0, 2.0], [0.0, 2.0], [0, 1, 2, 3]]
    assert made == ["b"]
