"""All memory of a machine in one piece, as the compiled engine wants it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from mmap import mmap
from typing import Any

import numpy as np

from plcgen.errors import PlcgenError
from plcgen.plc.core import Area, Program
from plcgen.plc.engine import Bytes, Site
from plcgen.plc.fast.call_loop import CallLoop
from plcgen.plc.fast.closed_loop import PHASE_AT, SETPOINT_AT, TRAVEL_AT, VELOCITY_AT, ClosedLoop
from plcgen.plc.fast.engine import FastEngine
from plcgen.plc.fast.event_loop import EventLoop

ROOM = 1 << 17
"""Bytes behind the areas: frames, constants, instances that come later."""
SPACING = 8


class FastRunner:
    """The compiled engine and the views of its memory. Raises UnsuitableError, and then nothing was changed."""

    def __init__(
        self,
        program: Program,
        memory: Mapping[Area | str, Bytes],
        note: Callable[[str, Site], None],
        temp_fill: int,
        function_error: float,
        services: Mapping[str, Callable[..., Any]],
    ) -> None:
        roots = {id(_root(data)): _root(data) for data in memory.values()}
        starts, end = {}, SPACING
        for key, root in roots.items():
            starts[key] = end
            end += (len(root) + SPACING - 1) // SPACING * SPACING
        # Pages of zeros from the system cost nothing until they are written.
        self._flat = np.frombuffer(mmap(-1, end + ROOM), np.uint8)
        whole = self._flat.data
        for key, root in roots.items():
            given = np.frombuffer(root, np.uint8)
            if given.any():
                self._flat[starts[key] : starts[key] + len(root)] = given
        areas = {area: starts[id(_root(data))] + _offset(data) for area, data in memory.items()}
        self.views: dict[Area | str, Bytes] = {a: whole[areas[a] : areas[a] + len(data)] for a, data in memory.items()}
        self.engine = FastEngine(program, self._flat, areas, end, note, temp_fill, function_error, services)
        self.budget = self.engine.budget
        self._whole, self._end = whole, self.engine.end

    def bound(self, name: str, instance: Bytes | None) -> Callable[..., Any]:
        """See `Engine.bound`."""
        return self.engine.bound(name, 0 if instance is None else self._first_byte(instance))

    def take_counts(self) -> list[int]:
        """See `Engine.take_counts`."""
        return self.engine.take_counts()

    def call_loop(
        self,
        name: str,
        instance: Bytes | None,
        image: Bytes,
        told: Sequence[tuple[Bytes, int, int]] = (),
        kept: Sequence[Bytes] = (),
    ) -> CallLoop | None:
        """Calls of a block without Python. `image` is recorded after each. Before each the first byte of a view gets
        bits, of `told` with those that stay and those that are set; after each the views `kept` are as they were.
        """
        entry = self.engine.entry(name)
        if entry is None:
            return None
        base = 0 if instance is None else self._first_byte(instance)
        bits = [(self._first_byte(view), stay, on) for view, stay, on in told]
        places = [self._first_byte(view) + byte for view in kept for byte in range(len(view))]
        return CallLoop(self.engine, entry, base, (self._first_byte(image), len(image)), bits, places)

    def closed_loop(self, name: str, instance: Bytes, places: Sequence[int]) -> ClosedLoop | None:
        """Scans of a block on its instance without Python; `places` are bytes of travel, velocity, setpoint, phase."""
        entry = self.engine.entry(name)
        fields = dict(zip((TRAVEL_AT, VELOCITY_AT, SETPOINT_AT, PHASE_AT), places, strict=True))
        if entry is None:
            return None
        return ClosedLoop(self.engine, entry, self._first_byte(instance), len(instance), fields)

    def event_loop(
        self,
        main: str,
        views: Sequence[Bytes],
        watched: int,
        costs: Sequence[float],
        ports: Sequence[tuple[int, ...]],
    ) -> EventLoop | None:
        """Scans of a SMART: views of special memory, of the image of the outputs, of the outputs, of V memory and of
        the accumulators; the byte of V memory that is watched; the prices of what the program counts; for each pulse
        output the bytes of special memory for status, control, table and segment, and the bit of its direction or -1.
        """
        entry = self.engine.entry(main)
        if entry is None:
            return None
        special, image, outputs, tables, accumulators = map(self._first_byte, views)
        ends = tables + len(views[3])
        places = (special, image, outputs, len(views[2]), tables + watched, tables, ends, accumulators)
        return EventLoop(self.engine, entry, places, costs, ports)

    def _first_byte(self, view: Bytes) -> int:
        address: int = np.frombuffer(view, np.uint8).__array_interface__["data"][0]
        return address - int(self._flat.__array_interface__["data"][0])

    def adopt(self, data: bytes) -> Bytes:
        """Memory for another instance."""
        start = self._end
        self._end += (len(data) + SPACING - 1) // SPACING * SPACING
        if self._end > len(self._flat):
            raise PlcgenError('more instance data than the fast engine has room for; choose the engine "plain"')
        view = self._whole[start : start + len(data)]
        view[:] = data
        return view


def _root(data: Bytes) -> bytearray:
    found = data.obj if isinstance(data, memoryview) else data
    assert isinstance(found, bytearray)
    return found


def _offset(data: Bytes) -> int:
    """Where a view begins in what it is a view of."""
    if not isinstance(data, memoryview) or not len(data):
        return 0
    first = np.frombuffer(data, np.uint8).__array_interface__["data"][0]
    return int(first - np.frombuffer(_root(data), np.uint8).__array_interface__["data"][0])
