"""Work shared out to the cores, and what an interrupt from the keyboard does to it."""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from plcgen.errors import PlcgenError

T = TypeVar("T")

TERMINATED = 143
"""Exit code, as a shell reports it."""
SELDOM = 50_000
"""New objects between two searches for garbage that holds itself."""


def search_seldom() -> None:
    """Trees of sources are many objects, and none of them holds itself. At the end all memory goes back at once."""
    gc.set_threshold(SELDOM)
    atexit.register(gc.freeze)


def in_processes(function: Callable[..., T], *columns: Sequence[Any]) -> Iterator[T]:
    """function(*row) for each row of the columns, in their order; on one core, or for one row, right here.

    Raises PlcgenError when a process has died.
    """
    workers = min(len(columns[0]), os.cpu_count() or 1)
    if workers <= 1:
        yield from map(function, *columns)
        return
    yield from _shared_out(function, columns, workers)


def _shared_out(function: Callable[..., T], columns: Sequence[Sequence[Any]], workers: int) -> Iterator[T]:
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor
    from concurrent.futures.process import BrokenProcessPool

    context = multiprocessing.get_context("spawn")
    threading.excepthook = _unless_interrupted
    with _workers_end_too(), ProcessPoolExecutor(workers, context, _begin) as pool:
        try:
            yield from pool.map(function, *columns)
        except BrokenProcessPool:
            raise PlcgenError("a process that did a share of the work has died; is there enough memory?") from None


@contextmanager
def _workers_end_too() -> Iterator[None]:
    """When somebody ends this process, as a CI does that has waited long enough."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _end(*_: object) -> None:
    import multiprocessing

    for worker in multiprocessing.active_children():
        worker.terminate()
    sys.exit(TERMINATED)


def _unless_interrupted(event: threading.ExceptHookArgs) -> None:
    """After an interrupt the pool's thread stumbles over results that were called off; that is nobody's concern."""
    from concurrent.futures import InvalidStateError

    if event.exc_type is not InvalidStateError:
        threading.__excepthook__(event)


def _begin() -> None:
    """An interrupt from the keyboard reaches the workers too; the parent alone speaks of it."""
    search_seldom()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
