"""Scans of an S7-200 SMART in which nothing happens but MAIN, without Python in between.

`cpu.smart` says what a scan is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.engine import FastEngine
from plcgen.plc.fast.vm import COUNTS, QUIET, enter

VM = "8ce035cbc34b816f"
"""Beginning of the SHA-256 of vm.py, written by generate.py."""

compiled: Callable[[Any], Any] = njit(cache=True, error_model="numpy", nogil=True)


@compiled
def _clock_bits(scan: int, milliseconds: int) -> int:
    """SMB0."""
    bits = 1 if scan else 3
    if milliseconds % 60_000 >= 30_000:
        bits |= 16
    if milliseconds % 1000 >= 500:
        bits |= 32
    return bits if scan % 2 else bits | 64


@compiled
def _refresh(memory: Any, special: int, enabled: int, ports: Any) -> None:
    memory[special] |= 1
    memory[special + 4] = memory[special + 4] & 239 | enabled
    for status, segment, idle, number in ports:
        memory[special + status] = memory[special + status] & 112 | idle
        memory[special + segment] = number


@compiled
def _differ(memory: Any, at: int, other: Any) -> bool:
    for place in range(len(other)):  # noqa: SIM110 - Numba has no generators in any()
        if memory[at + place] != other[place]:
            return True
    return False


@compiled
def _taken(room: Any, costs: Any) -> float:
    """What was counted, priced; the counters begin anew."""
    total = 0.0
    for number in range(len(costs)):
        total += room[COUNTS + number] * costs[number]
        room[COUNTS + number] = 0
    return total


@compiled
def scans(
    code: Any, room: Any, memory: Any, entry: int, budget: int, places: Any, ports: Any, enabled: int, clock: Any,
    costs: Any, most: int,
) -> tuple[int, int, float]:  # fmt: skip
    """Scans that were run, and what `enter` returned for the last one, which is not at its end unless that is QUIET;
    and the most that one cost.

    It ends before a scan that would change the outputs, and behind one that has changed them at once, or the byte that
    is watched.
    """
    special, image, physical, size, watched = places
    first, time, period = clock
    outputs = memory[physical : physical + size].copy()
    seen = memory[watched]
    longest = 0.0
    for row in range(most):
        if _differ(memory, image, outputs):
            return row, QUIET, longest
        memory[special] = _clock_bits(first + row, (time + row * period) // 1000)
        _refresh(memory, special, enabled, ports)
        ended = enter(code, room, memory, entry, 0, budget)
        if ended != QUIET:
            return row + 1, ended, longest
        longest = max(longest, _taken(room, costs))
        _refresh(memory, special, enabled, ports)
        if memory[watched] != seen or _differ(memory, physical, outputs):
            return row + 1, QUIET, longest
    return most, QUIET, longest


class ScanLoop:
    """Scans of a block without parameters. `places` are the first bytes of special memory, of the image of the outputs
    and of the outputs themselves, how many bytes they are, and the byte that is watched.

    `is_whole`: the last scan is over; else `settle` runs its block to the end. `costs` are the prices of what the
    program counts, `longest` what the dearest of the last scans cost that are over.
    """

    def __init__(self, engine: FastEngine, entry: int, places: Sequence[int], costs: Sequence[float]) -> None:
        self._engine, self._entry = engine, entry
        self._places = np.array(places)
        self._costs = np.array(costs, dtype=np.float64)
        self._ended, self.longest = QUIET, 0.0

    def run(
        self, ports: Sequence[tuple[int, int, int, int]], enabled: int, clock: tuple[int, int, int], most: int
    ) -> int:
        """See `scans`: `ports` are status and segment bytes of special memory, and what they say; `clock` the number
        of the first scan, its time and the period in us.
        """
        engine = self._engine
        whole = (self._places, np.array(ports), enabled, np.array(clock), self._costs, most)
        rows, self._ended, self.longest = scans(*engine.parts, self._entry, engine.budget[0], *whole)
        return int(rows)

    @property
    def is_whole(self) -> bool:
        return bool(self._ended == QUIET)

    def settle(self) -> None:
        """See `engines.Loop`."""
        self._engine.go_on(self._ended)
