"""Files on disk: a set of them is written whole or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from plcgen.errors import PlcgenError
from plcgen.names import one_of
from plcgen.targets import TARGETS


def check_folder(folder: Path) -> None:
    """Raises PlcgenError when files cannot go below `folder`, which need not exist yet."""
    existing = _nearest_existing(folder)
    if not existing.is_dir():
        raise PlcgenError(f"{folder}: cannot be written: {existing} is a file, not a folder")
    if not os.access(existing, os.W_OK):
        raise PlcgenError(f"{folder}: cannot be written: no permission to write in {existing}")


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write files below a folder by relative name; other files there stay.

    Raises PlcgenError, and then everything is as it was before.
    """
    check_folder(folder)
    destinations = {name: (folder / name).resolve() for name in files}
    for destination in destinations.values():
        _check_file(destination)
    try:
        _Exchange(folder).run({destinations[name]: data for name, data in files.items()})
    except OSError as error:
        place = error.filename2 or error.filename or folder
        raise PlcgenError(f"{place}: cannot be written: {error.strerror}; nothing was changed") from error


def write_file(path: Path, data: bytes) -> None:
    """Write one file whole or not at all; a device such as NUL or /dev/stdout takes it as it comes."""
    if path.exists() and not path.is_file() and not path.is_dir():
        path.write_bytes(data)
        return
    write_files(path.parent, {path.name: data})


def _check_file(destination: Path) -> None:
    check_folder(destination.parent)
    if destination.is_dir():
        raise PlcgenError(f"{destination}: cannot be written: it is a folder, not a file")
    if destination.exists() and not os.access(destination, os.W_OK):
        raise PlcgenError(f"{destination}: cannot be written: the file is read-only")


def _nearest_existing(path: Path) -> Path:
    return next(ancestor for ancestor in (path, *path.absolute().parents) if ancestor.exists())


@dataclass
class _Exchange:
    """Puts new files in the place of old ones, and remembers how to go back."""

    folder: Path
    replaced: list[tuple[Path, Path | None]] = field(default_factory=list)
    created: list[Path] = field(default_factory=list)

    def run(self, files: Mapping[Path, bytes]) -> None:
        # Beside the destination, for replacing does not cross the border of a file system.
        staging = Path(tempfile.mkdtemp(prefix=".plcgen-", dir=_nearest_existing(self.folder)))
        try:
            staged = [self._stage(staging / f"new{number}", data) for number, data in enumerate(files.values())]
            for number, (new, destination) in enumerate(zip(staged, files, strict=True)):
                self._exchange(new, destination, staging / f"old{number}")
        except BaseException:
            self._undo()
            raise
        finally:
            shutil.rmtree(staging, ignore_errors=True)

    @staticmethod
    def _stage(path: Path, data: bytes) -> Path:
        path.write_bytes(data)
        return path

    def _exchange(self, new: Path, destination: Path, backup: Path) -> None:
        self._make_folder(destination.parent)
        previous = None
        if destination.exists():
            shutil.copymode(destination, new)
            previous = Path(shutil.copy2(destination, backup))
        new.replace(destination)
        self.replaced.append((destination, previous))

    def _make_folder(self, folder: Path) -> None:
        if not folder.is_dir():
            self._make_folder(folder.parent)
            folder.mkdir()
            self.created.append(folder)

    def _undo(self) -> None:
        for destination, backup in reversed(self.replaced):
            with suppress(OSError):
                if backup is None:
                    destination.unlink(missing_ok=True)
                else:
                    backup.replace(destination)
        for folder in reversed(self.created):
            with suppress(OSError):
                folder.rmdir()


# -------------------------------------------------------------------------------------------------------- sources


def read_sources(folder: Path, targets: Sequence[str]) -> dict[str, dict[str, bytes]]:
    """Source files of each target by name, from `folder/<target>`; with one target also from the folder itself."""
    if not folder.is_dir():
        raise PlcgenError(f"{folder}: {'is a file; name the folder it is in' if folder.exists() else 'no such folder'}")
    return {target: _sources(_source_folder(folder, target, alone=len(targets) == 1), target) for target in targets}


def _source_folder(folder: Path, target: str, alone: bool) -> Path:
    own = folder / target
    if own.is_dir() or not alone:
        return own
    return folder


def _sources(folder: Path, target: str) -> dict[str, bytes]:
    suffix = TARGETS[target].suffix
    if not folder.is_dir():
        raise PlcgenError(f"{folder}: no such folder; put the sources for {target} there, or choose with --target")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() == suffix and path.is_file())
    if not found:
        raise PlcgenError(f"{folder}: holds no {suffix} file; name the folder with the sources for {one_of([target])}")
    return {path.with_suffix(suffix).name: path.read_bytes() for path in found}
