"""Which engine runs a program: the compiled one where Numba is installed, else the plain one."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Protocol

from plcgen.errors import PlcgenError

if TYPE_CHECKING:
    import numpy as np

    from plcgen.plc.core import Area, Program
    from plcgen.plc.engine import Bytes, Site

VARIABLE, PLAIN, FAST = "PLCGEN_ENGINE", "plain", "fast"
ENGINES = (PLAIN, FAST)
Run = Callable[..., Any]


class Loop(Protocol):
    """Scans at once."""

    def settle(self) -> None:
        """Let Python do what the last scan needs, run it to its end, and tell its events. Raises Fault."""


class CallLoop(Loop, Protocol):
    """See `fast.call_loop`."""

    images: np.ndarray

    def run(self, most: int, byte: int = 0, mask: int = 0, script: np.ndarray = ...) -> int: ...


class ClosedLoop(Loop, Protocol):
    """See `fast.closed_loop`."""

    LONGEST: int
    places: np.ndarray
    images: np.ndarray

    def run(self, times: np.ndarray, drive: np.ndarray, late: np.ndarray, phases: int, passing: int) -> int: ...


class EventLoop(Loop, Protocol):
    """See `fast.event_loop`."""

    clock: np.ndarray
    tick: np.ndarray
    record: np.ndarray
    times: np.ndarray
    out: np.ndarray
    longest: np.ndarray
    saved: np.ndarray

    def entry(self, block: str) -> int: ...

    def put_channel(self, number: int, has_event: bool, ends: Sequence[float], current: int) -> None: ...

    def progress(self, number: int) -> tuple[bool, int]: ...

    def run(self, late: np.ndarray) -> None: ...


class Runner(Protocol):
    """What a machine needs of an engine."""

    budget: list[int]

    def bound(self, name: str, instance: Bytes | None) -> Run: ...

    def adopt(self, data: bytes) -> Bytes:
        """Memory for another instance."""

    def event_loop(
        self,
        main: str,
        views: Sequence[Bytes],
        watched: int,
        costs: Sequence[float],
        ports: Sequence[tuple[int, ...]],
    ) -> EventLoop | None:
        """Scans of a SMART; None where there is no quicker way than one by one. See `fast.memory`."""

    def take_counts(self) -> list[int]:
        """See `Engine.take_counts`."""

    def call_loop(
        self,
        name: str,
        instance: Bytes | None,
        image: Bytes,
        told: Sequence[tuple[Bytes, int, int]] = (),
        kept: Sequence[Bytes] = (),
    ) -> CallLoop | None:
        """Calls of a block; None where there is no quicker way than one by one. See `fast.memory`."""

    def closed_loop(self, name: str, instance: Bytes, places: Sequence[int]) -> ClosedLoop | None:
        """A block with its drive; None where there is no quicker way than scan by scan."""


def chosen() -> str:
    """Raises PlcgenError for a name that is none, and for the fast engine without Numba."""
    name = os.environ.get(VARIABLE, "")
    if name not in ("", *ENGINES):
        raise PlcgenError(f'{VARIABLE} is "{name}"; there are the engines "plain" and "fast"')
    has_numba = find_spec("numba") is not None
    if name == FAST and not has_numba:
        raise PlcgenError('the fast engine needs numba; install plcgen with the extra "fast"')
    return name or (FAST if has_numba else PLAIN)


def start(
    program: Program,
    memory: dict[Area | str, Bytes],
    note: Callable[[str, Site], None],
    temp_fill: int,
    function_error: float,
    services: Mapping[str, Callable[..., Any]],
) -> tuple[Runner, dict[Area | str, Bytes]]:
    """An engine, and the memory that it works on: the compiled one moves it into one piece."""
    if chosen() == FAST:
        from plcgen.plc.fast.encode import UnsuitableError
        from plcgen.plc.fast.memory import FastRunner

        try:
            runner = FastRunner(program, memory, note, temp_fill, function_error, services)
        except UnsuitableError:
            pass
        else:
            return runner, runner.views
    from plcgen.plc.engine import Engine

    return Engine(program, memory, note, temp_fill, function_error, services), memory
