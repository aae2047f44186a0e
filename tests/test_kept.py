"""What is kept for other runs."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from plcgen import kept
from plcgen.loading import load, load_smart, smart_sources
from plcgen.plc.types import ELEMENTARY

FOLDER = kept.folder
GOLDEN = Path(__file__).parents[1] / "golden"


@pytest.fixture(autouse=True)
def place(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    monkeypatch.setattr(kept, "folder", lambda: tmp_path)
    yield tmp_path


@pytest.fixture
def doubled() -> tuple[Callable[[int], list[int]], list[int]]:
    """A function that is kept, and what it was really called with."""
    calls: list[int] = []

    @kept.kept
    def _twice(number: int) -> list[int]:
        calls.append(number)
        return [number, number]

    return _twice, calls


def files(place: Path) -> set[Path]:
    return {path for path in place.rglob("*") if path.is_file()}


def test_a_result_is_computed_once(doubled: tuple[Callable[[int], list[int]], list[int]]) -> None:
    twice, calls = doubled
    assert [twice(3), twice(4), twice(3)] == [[3, 3], [4, 4], [3, 3]]
    assert calls == [3, 4]


@pytest.mark.parametrize("damage", [lambda d: d[:-1], lambda d: d[:0], lambda d: d[:-9] + b"x" + d[-8:]])
def test_a_file_that_is_damaged_is_written_again(
    damage: Callable[[bytes], bytes], place: Path, doubled: tuple[Callable[[int], list[int]], list[int]]
) -> None:
    twice, calls = doubled
    twice(3)
    (path,) = files(place)
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert twice(3) == [3, 3]
    assert calls == [3, 3]
    assert path.read_bytes() == whole


def test_another_plcgen_computes_again(
    monkeypatch: pytest.MonkeyPatch, doubled: tuple[Callable[[int], list[int]], list[int]]
) -> None:
    twice, calls = doubled
    twice(3)
    monkeypatch.setattr(kept, "code_digest", lambda: b"of another one")
    twice(3)
    assert calls == [3, 3]


def test_what_is_raised_is_not_kept(place: Path) -> None:
    @kept.kept
    def _half(number: float) -> float:
        return 1.0 / number

    for _ in range(2):
        with pytest.raises(ZeroDivisionError):
            _half(0.0)
    assert not files(place)


@pytest.mark.parametrize("folder", [None, Path(__file__) / "a file is no folder"])
def test_without_a_folder_nothing_is_kept(
    folder: Path | None, monkeypatch: pytest.MonkeyPatch, doubled: tuple[Callable[[int], list[int]], list[int]]
) -> None:
    monkeypatch.setattr(kept, "folder", lambda: folder)
    twice, calls = doubled
    assert [twice(3), twice(3)] == [[3, 3], [3, 3]]
    assert calls == [3, 3]


def test_what_was_not_used_for_longest_makes_room(
    monkeypatch: pytest.MonkeyPatch, place: Path, doubled: tuple[Callable[[int], list[int]], list[int]]
) -> None:
    monkeypatch.setattr(kept, "MOST_KEPT", 2)
    monkeypatch.setattr(kept, "CLEARING", "")
    twice, calls = doubled
    for age, number in ((300, 1), (200, 2)):
        before = files(place)
        twice(number)
        (path,) = files(place) - before
        os.utime(path, (path.stat().st_atime - age, path.stat().st_mtime - age))
    twice(1)
    twice(3)
    assert len(files(place)) == 2
    assert [twice(1), twice(3), twice(2)] == [[1, 1], [3, 3], [2, 2]]
    assert calls == [1, 2, 3, 2]


def test_one_file_in_sixteen_makes_room(monkeypatch: pytest.MonkeyPatch, place: Path) -> None:
    """400 files, so some 25 clearings."""
    monkeypatch.setattr(kept, "MOST_KEPT", 20)
    monkeypatch.setattr(kept, "code_digest", lambda: b"always the same")
    clearings: list[int] = []
    really = kept._make_room

    def noted(folder: Path) -> None:
        really(folder)
        clearings.append(len(files(place)))

    monkeypatch.setattr(kept, "_make_room", noted)
    for number in range(400):
        kept.keep("numbers", bytes([number // 256, number % 256]), b"")
    assert 10 < len(clearings) < 50
    assert max(clearings) == 20
    assert len(files(place)) < 100


def test_the_folder_is_the_users_own() -> None:
    found = FOLDER()
    assert found is not None and found.is_dir()


# --------------------------------------------------------------------------------------------------------- programs


@pytest.mark.parametrize("target", ["s7-300-scl", "s7-300-stl", "tia-scl"])
def test_a_kept_program_is_the_program(target: str, monkeypatch: pytest.MonkeyPatch) -> None:
    files = {path.name: path.read_bytes() for path in (GOLDEN / "ramps" / target).iterdir()}
    first, again = (_fresh(load, target, files) for _ in range(2))
    assert again is not first
    assert again == first
    assert repr(again) == repr(first)
    monkeypatch.setattr(kept, "recalled", lambda *_: pytest.fail("asked for"))
    assert load(target, files) is again


@pytest.mark.parametrize("timed", [False, True])
def test_a_kept_program_for_the_smart(timed: bool) -> None:
    files = {path.name: path.read_bytes() for path in (GOLDEN / "table-1" / "s7-200-smart").iterdir()}
    first, again = (_fresh(load_smart, "Table", files, timed) for _ in range(2))
    assert (again is first, again == first, repr(again) == repr(first)) == (False, True, True)
    one, other = (_fresh(smart_sources, files) for _ in range(2))
    assert repr(one) == repr(other)


def test_types_stay_the_same_ones() -> None:
    """`is` tells them apart everywhere."""

    @kept.kept
    def _types() -> list[object]:
        return list(ELEMENTARY.values())

    assert all(one is other for _ in range(2) for one, other in zip(_types(), ELEMENTARY.values(), strict=True))


def _fresh(function: Callable[..., object], *arguments: object) -> object:
    """As another run would load it."""
    from plcgen import loading

    for name in ("_load", "_load_smart", "read_smart", "_parsed_stl", "_parsed_scl"):
        getattr(loading, name).cache_clear()
    return function(*arguments)
