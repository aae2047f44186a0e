"""A function block and an ideal drive, scan by scan without Python in between.

The drive moves at the setpoint of the last scan; the block is told the travel, in steps of a quantum and some scans
late, and the velocity. `check.rig` does the same in Python, and says what a goal is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.engine import FastEngine
from plcgen.plc.fast.helpers import bits_to_real, moved, real_to_bits
from plcgen.plc.fast.vm import DONE, QUIET, enter

VM = "1aa064b2122f2c56"
"""Beginning of the SHA-256 of vm.py, written by generate.py."""

ENTRY, MOST_JUMPS, FIRST_BYTE, TRAVEL_AT, VELOCITY_AT, SETPOINT_AT, PHASE_AT, ENDED, FIELDS = range(9)
TRAVEL, VELOCITY, TIME, QUANTUM, LOWEST, HIGHEST = range(6)


compiled: Callable[[Any], Any] = njit(cache=True, error_model="numpy", nogil=True)


@compiled
def _store(memory: Any, at: int, value: float) -> None:
    bits = real_to_bits(value)
    for place in range(4):
        memory[at + place] = bits >> (24 - 8 * place) & 255


@compiled
def _load(memory: Any, at: int) -> float:
    value: float = bits_to_real(memory[at] << 24 | memory[at + 1] << 16 | memory[at + 2] << 8 | memory[at + 3])
    return value


@compiled
def _before(memory: Any, fields: Any, drive: Any, late: Any, time: float) -> None:
    """The drive has moved; what the block reads."""
    drive[TRAVEL] += drive[VELOCITY] * (time - drive[TIME])
    drive[TIME] = time
    reading = drive[TRAVEL]
    if drive[QUANTUM] != 0.0:
        reading = np.floor(reading / drive[QUANTUM]) * drive[QUANTUM]
    if len(late):
        newest, reading = reading, late[0]
        late[:-1] = late[1:]
        late[-1] = newest
    _store(memory, fields[TRAVEL_AT], reading)
    _store(memory, fields[VELOCITY_AT], drive[VELOCITY])


@compiled
def after(memory: Any, fields: Any, drive: Any, place: Any, image: Any) -> None:
    """What the block has written, and the record of the scan."""
    drive[VELOCITY] = _load(memory, fields[SETPOINT_AT])
    place[0], place[1] = drive[TIME], drive[TRAVEL]
    moved(image.ctypes.data, memory.ctypes.data + fields[FIRST_BYTE], len(image))


@compiled
def _is_met(memory: Any, fields: Any, drive: Any, phases: int, passing: int) -> bool:
    at = fields[PHASE_AT]
    phase = np.int64(1) << (memory[at] << 8 | memory[at + 1])
    if phase & phases:
        return True
    return phase & passing != 0 and not drive[LOWEST] < drive[TRAVEL] < drive[HIGHEST]


@compiled
def scans(
    code: Any, room: Any, memory: Any, fields: Any, drive: Any, late: Any, times: Any, places: Any, images: Any,
    phases: int, passing: int,
) -> int:  # fmt: skip
    """Scans that were run, the last of which needs Python, or has met the goal, or is that of the last time.

    `fields[ENDED]` is what `enter` returned for the last one.
    """
    for row in range(len(times)):
        _before(memory, fields, drive, late, times[row])
        ended = enter(code, room, memory, fields[ENTRY], fields[FIRST_BYTE], fields[MOST_JUMPS])
        fields[ENDED] = ended
        if ended in (QUIET, DONE):
            after(memory, fields, drive, places[row], images[row])
        if ended != QUIET or _is_met(memory, fields, drive, phases, passing):
            return row + 1
    return len(times)


class ClosedLoop:
    """Scans of a block that takes and returns nothing but its instance, which begins at `first_byte`.

    `places` are the bytes of travel, velocity, setpoint and phase in it. `times`, `travels` and `images` are the
    record of the scans that `run` was for.
    """

    LONGEST = 4096

    def __init__(self, engine: FastEngine, entry: int, first_byte: int, size: int, places: Mapping[int, int]) -> None:
        self._engine = engine
        self._fields = np.zeros(FIELDS, np.int64)
        self._fields[[ENTRY, FIRST_BYTE]] = entry, first_byte
        for field, byte in places.items():
            self._fields[field] = first_byte + byte
        self.places = np.empty((self.LONGEST, 2))
        self.images = np.empty((self.LONGEST, size), np.uint8)

    def run(self, times: np.ndarray, drive: np.ndarray, late: np.ndarray, phases: int, passing: int) -> int:
        """See `scans`. The last one is complete after `settle`."""
        engine, self._drive = self._engine, drive
        self._fields[MOST_JUMPS] = engine.budget[0]
        self._rows = int(
            scans(*engine.parts, self._fields, drive, late, times, self.places, self.images, phases, passing)
        )
        engine.have_run(self._rows)
        return self._rows

    def settle(self) -> None:
        """See `engines.Loop`."""
        engine, row, ended = self._engine, self._rows - 1, int(self._fields[ENDED])
        if ended == QUIET:
            return
        engine.go_on(ended)
        if ended != DONE:
            after(engine.parts[2], self._fields, self._drive, self.places[row], self.images[row])
