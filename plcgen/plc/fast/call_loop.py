"""Calls of one block, over and over, without Python in between."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.engine import FastEngine
from plcgen.plc.fast.helpers import moved
from plcgen.plc.fast.vm import DONE, QUIET, enter
from plcgen.plc.script import NO_SCRIPT

VM = "1aa064b2122f2c56"
"""Beginning of the SHA-256 of vm.py, written by generate.py."""

ENTRY, BASE, FIRST_BYTE, ENDED, FIELDS = range(5)

compiled: Callable[[Any], Any] = njit(cache=True, error_model="numpy", nogil=True)


@compiled
def after(memory: Any, first: int, kept: Any, values: Any, image: Any) -> None:
    """What the CPU puts back, and the record of the call."""
    for place in range(len(kept)):
        memory[kept[place]] = values[place]
    moved(image.ctypes.data, memory.ctypes.data + first, len(image))


@compiled
def calls(
    code: Any, room: Any, memory: Any, fields: Any, told: Any, kept: Any, values: Any, images: Any, budget: int,
    most: int, byte: int, mask: int, script: Any,
) -> int:  # fmt: skip
    """Calls that were made, the last of which needs Python, or has set the bit of the image that is watched.

    Rows of `told` are what the CPU writes before each: a byte, the bits that stay, those that are set. `kept` are bytes
    that are put back after each. Rows of `script` begin with the call before which they are written; their bytes count
    from the image on. `fields[ENDED]` is what `enter` returned for the last one.
    """
    line = 0
    for row in range(most):
        while line < len(script) and script[line, 0] <= row:
            at = fields[FIRST_BYTE] + script[line, 1]
            memory[at] = memory[at] & script[line, 2] | script[line, 3]
            line += 1
        for place in range(len(told)):
            at = told[place, 0]
            memory[at] = memory[at] & told[place, 1] | told[place, 2]
        for place in range(len(kept)):
            values[place] = memory[kept[place]]
        ended = enter(code, room, memory, fields[ENTRY], fields[BASE], budget)
        fields[ENDED] = ended
        if ended in (QUIET, DONE):
            after(memory, fields[FIRST_BYTE], kept, values, images[row])
        if ended != QUIET or images[row, byte] & mask:
            return row + 1
    return most


class CallLoop:
    """Calls of a block that takes and returns nothing but its instance, which begins at `base`.

    `images` are the bytes from `first_byte` on after each call of the last `run`; `told` and `kept` as in `calls`.
    """

    LONGEST = 4096

    def __init__(
        self,
        engine: FastEngine,
        entry: int,
        base: int,
        image: tuple[int, int],
        told: Sequence[tuple[int, int, int]],
        kept: Sequence[int],
    ) -> None:
        self._engine = engine
        self._first, size = image
        self._fields = np.zeros(FIELDS, np.int64)
        self._fields[[ENTRY, BASE, FIRST_BYTE]] = entry, base, self._first
        before, self._kept = np.array(told, np.int64).reshape(-1, 3), np.array(kept, np.int64)
        self._values = np.zeros(len(kept), np.uint8)
        self._arrays = self._fields, before, self._kept, self._values
        self.images = np.empty((self.LONGEST, size), np.uint8)

    def run(self, most: int, byte: int = 0, mask: int = 0, script: np.ndarray = NO_SCRIPT) -> int:
        """Up to so many calls, until one leaves a bit of a byte of the image set; the last is over after `settle`."""
        parts, budget, most = self._engine.parts, self._engine.budget[0], min(most, self.LONGEST)
        self._rows = rows = int(calls(*parts, *self._arrays, self.images, budget, most, byte, mask, script))
        self._engine.have_run(rows)
        return rows

    def settle(self) -> None:
        """See `engines.Loop`."""
        engine, ended = self._engine, int(self._fields[ENDED])
        if ended == QUIET:
            return
        try:
            engine.go_on(ended)
        finally:
            if ended != DONE:
                after(engine.parts[2], self._first, self._kept, self._values, self.images[self._rows - 1])
