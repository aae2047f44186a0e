"""Files are written whole or not at all, and errors name the path and the reason."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from plcgen.errors import PlcgenError
from plcgen.files import check_folder, read_sources, write_file, write_files


def tree(folder: Path) -> dict[str, bytes]:
    """Every file below a folder; empty folders end with a slash."""
    found = {path.relative_to(folder): path for path in folder.rglob("*")}
    return {
        name.as_posix() + "/" * path.is_dir(): b"" if path.is_dir() else path.read_bytes()
        for name, path in found.items()
    }


def refusal(folder: Path, files: dict[str, bytes]) -> str:
    with pytest.raises(PlcgenError) as caught:
        write_files(folder, files)
    return str(caught.value)


def test_files_are_written_and_others_stay(tmp_path: Path) -> None:
    folder = tmp_path / "Förder anlage" / "out"
    write_files(folder, {"a.scl": b"1\r\n", "tia/b.scl": b"2"})
    (folder / "mine.txt").write_bytes(b"mine")
    write_files(folder, {"a.scl": b"3"})
    assert tree(folder) == {"a.scl": b"3", "mine.txt": b"mine", "tia/": b"", "tia/b.scl": b"2"}
    assert [path.name for path in folder.parent.iterdir()] == ["out"]


def test_mode_of_a_replaced_file_stays(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "a").chmod(0o640)
    write_files(tmp_path, {"a": b"new"})
    assert os.name == "nt" or (tmp_path / "a").stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
def test_link_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    write_files(tmp_path, {"link": b"new"})
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"


def test_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "f").write_bytes(b"")
    path = tmp_path / "f"
    assert refusal(path, {"a": b""}) == f"{path}: cannot be written: {path} is a file, not a folder"
    assert refusal(path / "x", {"a": b""}) == f"{path / 'x'}: cannot be written: {path} is a file, not a folder"


def test_file_that_is_a_folder(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    assert refusal(tmp_path, {"a": b""}) == f"{tmp_path / 'a'}: cannot be written: it is a folder, not a file"


def test_no_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_bytes(b"old")
    monkeypatch.setattr(os, "access", lambda path, _mode: Path(path).is_dir())
    assert refusal(tmp_path, {"a": b""}) == f"{tmp_path / 'a'}: cannot be written: the file is read-only"
    monkeypatch.setattr(os, "access", lambda _path, _mode: False)
    with pytest.raises(PlcgenError) as caught:
        check_folder(tmp_path / "new")
    assert str(caught.value) == f"{tmp_path / 'new'}: cannot be written: no permission to write in {tmp_path}"


@pytest.mark.parametrize("failing", ["a", "new/b", "new/c"])
def test_failure_on_the_way_leaves_all_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: str) -> None:
    (tmp_path / "a").write_bytes(b"old")
    replace = Path.replace

    def fail(self: Path, destination: Path) -> Path:
        if destination == tmp_path / failing and self.name.startswith("new"):
            raise PermissionError(13, "used by another program", str(self), None, str(destination))
        return replace(self, destination)

    monkeypatch.setattr(Path, "replace", fail)
    message = refusal(tmp_path, {"a": b"1", "new/b": b"2", "new/c": b"3"})
    assert message == f"{tmp_path / failing}: cannot be written: used by another program; nothing was changed"
    assert tree(tmp_path) == {"a": b"old"}


def test_interruption_leaves_all_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_self: Path, _data: bytes) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path / "out", {"a": b"1"})
    assert tree(tmp_path) == {}


def test_device_is_not_replaced() -> None:
    write_file(Path(os.devnull), b"gone")
    assert not Path(os.devnull).is_file()


# -------------------------------------------------------------------------------------------------------- sources


def unreadable(folder: Path, targets: list[str]) -> str:
    with pytest.raises(PlcgenError) as caught:
        read_sources(folder, targets)
    return str(caught.value)


def test_sources_of_each_target(tmp_path: Path) -> None:
    write_files(tmp_path, {"s7-300-scl/a.scl": b"1", "s7-300-scl/a.asc": b"x", "tia-scl/B.SCL": b"2"})
    both = read_sources(tmp_path, ["s7-300-scl", "tia-scl"])
    assert both == {"s7-300-scl": {"a.scl": b"1"}, "tia-scl": {"B.scl": b"2"}}
    assert read_sources(tmp_path / "tia-scl", ["tia-scl"]) == {"tia-scl": {"B.scl": b"2"}}
    assert read_sources(tmp_path, ["tia-scl"]) == {"tia-scl": {"B.scl": b"2"}}


def test_sources_that_are_not_there(tmp_path: Path) -> None:
    write_files(tmp_path, {"a.scl": b"", "tia-scl/readme.md": b""})
    assert unreadable(tmp_path / "x", ["tia-scl"]) == f"{tmp_path / 'x'}: no such folder"
    file = tmp_path / "a.scl"
    assert unreadable(file, ["tia-scl"]) == f"{file}: is a file; name the folder it is in"
    folder = tmp_path / "tia-scl"
    words = 'holds no .scl file; name the folder with the sources for "tia-scl"'
    assert unreadable(tmp_path, ["tia-scl"]) == f"{folder}: {words}"
    missing = tmp_path / "s7-300-scl"
    words = "no such folder; put the sources for s7-300-scl there, or choose with --target"
    assert unreadable(tmp_path, ["s7-300-scl", "tia-scl"]) == f"{missing}: {words}"
