"""What takes long and comes out the same is kept for other runs, in the user's own folder for temporary files.

A file begins with the digest of what follows: one that was cut off, or that cannot be read, is made again.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache, wraps
from hashlib import sha256
from pathlib import Path
from typing import ParamSpec, TypeVar
from uuid import uuid4

from jinja2 import FileSystemBytecodeCache

P = ParamSpec("P")
T = TypeVar("T")
MOST_KEPT = 256
"""Files of a kind, after a clearing."""
CLEARING = ("0",)
"""First digits of the names that make room, one in sixteen: to look at all files takes time."""
DIGEST = 32


@cache
def folder() -> Path | None:
    """Jinja looks after it that nobody else can write there; None where it cannot."""
    try:
        return Path(FileSystemBytecodeCache().directory)
    except (OSError, RuntimeError):
        return None


@cache
def code_digest() -> bytes:
    """Of every module of plcgen, and of Python: what it makes of anything."""
    package = Path(__file__).parent
    digest = sha256(sys.version.encode())
    for path in sorted(package.rglob("*.py")):
        digest.update(path.relative_to(package).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.digest()


def recalled(kind: str, key: bytes) -> bytes | None:
    """What `keep` was given for a key, by this very code."""
    path = _path(kind, key)
    try:
        data = path.read_bytes() if path else b""
    except OSError:
        return None
    if path is None or sha256(data[DIGEST:]).digest() != data[:DIGEST]:
        return None
    with suppress(OSError):
        path.touch()
    return data[DIGEST:]


def keep(kind: str, key: bytes, data: bytes) -> None:
    """Whole or not at all."""
    path = _path(kind, key)
    if path is None:
        return
    draft = path.with_suffix(f".{uuid4().hex}")
    with suppress(OSError):
        path.parent.mkdir(exist_ok=True)
        try:
            draft.write_bytes(sha256(data).digest() + data)
            draft.replace(path)
        finally:
            draft.unlink(missing_ok=True)
        if path.name.startswith(CLEARING):
            _make_room(path.parent)


def _make_room(place: Path) -> None:
    """What was not used for the longest time goes."""
    with os.scandir(place) as entries:  # on Windows it knows all times at once
        by_age = sorted(entries, key=lambda entry: entry.stat().st_mtime)
    for old in by_age[:-MOST_KEPT]:
        Path(old).unlink(missing_ok=True)


def _path(kind: str, key: bytes) -> Path | None:
    place, digest = folder(), sha256(code_digest() + key).hexdigest()
    return place / f"plcgen_{kind}" / f"{digest}.kept" if place else None


def kept(function: Callable[P, T]) -> Callable[P, T]:
    """A function of text and numbers, whose results are kept. What it raises is not."""

    @wraps(function)
    def asked(*args: P.args, **kwargs: P.kwargs) -> T:
        kind, key = function.__name__.strip("_"), repr((args, kwargs)).encode()
        data = recalled(kind, key)
        if data is not None:
            found: T = pickle.loads(data)
            return found
        result = function(*args, **kwargs)
        keep(kind, key, pickle.dumps(result))
        return result

    return asked
