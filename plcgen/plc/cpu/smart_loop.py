"""Many scans of a SMART at once, by the loop that an engine may have for it: what goes in, and what comes out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from plcgen.plc.core import Area, Program
from plcgen.plc.cpu.pto import IDLE, LEFT, PORTS, Channel
from plcgen.plc.engine import Bytes
from plcgen.plc.machine import Machine
from plcgen.plc.script import Script
from plcgen.plc.stl.smart_memory import AC, AREAS, PHYSICAL_OUTPUTS, V

if TYPE_CHECKING:
    from plcgen.plc.engines import CallLoop, EventLoop

TICKS_AHEAD = 1000
ON_TIME = np.zeros(TICKS_AHEAD, np.int64)
QUIET = -1
"""Nothing is left to do in a block."""
WHOLE, IN_MAIN, IN_INTERRUPT, _BETWEEN = range(4)
"""Where a loop ended, see `fast.event_loop`."""
ALWAYS_ON, INTERRUPTS_ENABLED = 1, 16
"""Bits of SMB0 and SMB4."""


def punctual(_tick: int) -> int:
    """No tick comes late."""
    return 0


class LoopedScans(ABC):
    """The part of a CPU that hands scans to a loop."""

    program: Program
    arguments: Sequence[Any]
    running: bool
    time_us: int
    scan_us: int
    memory: Mapping[Area | str, Bytes]
    _cycle: str
    _costs: Sequence[float]
    _is_timed: bool
    _enabled: bool
    _scans: int
    _next_scan: int
    _special: Bytes
    _blocked: Sequence[tuple[int, int]]
    _queue: Sequence[Any]
    _attached: Mapping[int, str]
    _ticks: Mapping[int, Any]
    _lateness: Callable[[int], int]
    _processor: Machine
    _channels: Sequence[Channel]
    _events: Sequence[tuple[int, Channel]]
    _direction_bits: Mapping[str, int]
    _loops: dict[int, EventLoop | None]
    _call_loops: dict[tuple[str, range, bool], CallLoop | None]

    @abstractmethod
    def scan(self) -> None: ...
    @abstractmethod
    def run_interrupt(self, event: int) -> None: ...
    @abstractmethod
    def _guarded(self, name: str, call: Callable[..., Any], *arguments: Any) -> Any: ...
    @abstractmethod
    def _main_is_over(self) -> None: ...
    @abstractmethod
    def _advance(self, until: int) -> None: ...
    @abstractmethod
    def _refresh(self) -> None: ...
    @abstractmethod
    def _serve(self) -> None: ...
    @abstractmethod
    def _watch_directions(self) -> None: ...
    @abstractmethod
    def _note_run_time(self, name: str, microseconds: float) -> None: ...

    def scans(self, most: int, watched: int) -> int:
        """Up to `most` scans, until a byte of V memory has another value or something unusual. Returns how many."""
        loop = self._loop_watching(watched)
        rows = 0 if loop is None else self._looped(loop, most)
        if not rows:
            self.scan()
        return rows or 1

    def run_interrupts(self, event: int, script: Script, recorded: range, byte: int = 0, mask: int = 0) -> bytes:
        """Run the routine of an event as often as the script says, here and now, up to a run that leaves a bit of V
        memory set.

        `recorded` are bytes of V memory; `byte`, and those of the script, count from the first of them. A `mask` of 0
        is for no bit. Returned is what they hold after each run.
        """
        loop = self._calls(event, recorded)
        if loop is None:
            script.write(self.memory[V], recorded.start)
            self.run_interrupt(event)
            return bytes(self.memory[V][recorded.start : recorded.stop])
        rows = loop.run(script.calls, byte, mask, script.rows)
        self._guarded(self._attached[event], self._processor.settle, loop)
        return loop.images[:rows].tobytes()

    def _calls(self, event: int, recorded: range) -> CallLoop | None:
        """None where something else may happen than the routine does."""
        routine = self._attached.get(event)
        at_rest = all(channel.is_at_rest for channel in self._channels)
        if routine is None or not self.running or self._is_timed or not at_rest:
            return None
        key = routine, recorded, self._enabled
        if key not in self._call_loops:
            image = memoryview(self.memory[V])[recorded.start : recorded.stop]
            kept = self.memory[AC], memoryview(self._special)[1:2]
            engine = self._processor.engine
            self._call_loops[key] = engine.call_loop(routine, None, image, list(self._told()), kept)
        return self._call_loops[key]

    def _told(self) -> Iterator[tuple[Bytes, int, int]]:
        """What special memory says before a routine runs while no pulse output does: byte, bits that stay, bits set."""
        special = memoryview(self._special)
        yield special, 0xFF, ALWAYS_ON
        yield special[4:], ~INTERRUPTS_ENABLED, INTERRUPTS_ENABLED if self._enabled else 0
        for port in PORTS.values():
            yield special[port.status :], LEFT, IDLE
            yield special[port.segment :], 0, 0

    def _loop_watching(self, byte: int) -> EventLoop | None:
        if self.arguments or self._cycle not in self.program.functions:
            return None
        if byte not in self._loops:
            whole = memoryview(self.memory[V])[: AREAS[V]]
            outputs = (self.memory[Area.OUTPUTS], self.memory[PHYSICAL_OUTPUTS])
            views = (self._special, *outputs, whole, self.memory[AC])
            costs = self._costs if self._is_timed else ()
            self._loops[byte] = self._processor.engine.event_loop(self._cycle, views, byte, costs, self._port_places())
        return self._loops[byte]

    def _port_places(self) -> list[tuple[int, ...]]:
        """Of each pulse output: bytes of special memory, and the bit of its direction output or -1."""
        return [
            (port.status, port.control, port.table, port.segment, self._direction_bits.get(name, -1))
            for name, port in PORTS.items()
        ]

    def _looped(self, loop: EventLoop, most: int) -> int:
        """Scans at once; 0 when the next one is not for a loop."""
        ticks = next(iter(self._ticks.items()), None)
        waits = bool(self._queue) or self.time_us != self._next_scan
        has_more = len(self._ticks) > 1 or (ticks is not None and not self._enabled)
        most = min(most, self._free_scans(most))
        if not self.running or waits or has_more or not most or not self._hand_over(loop):
            return 0
        enabled = INTERRUPTS_ENABLED if self._enabled else 0
        loop.clock[:] = self._scans, self._next_scan, self.scan_us, self.time_us, enabled, most
        loop.tick[:] = -1, 0, 0, 0, 0
        late = ON_TIME
        if ticks is not None:
            event, tick = ticks
            loop.tick[:] = loop.entry(self._attached[event]), tick.period, tick.nominal, tick.count, tick.due
            late = self._next_lateness(tick.count, most * self.scan_us // tick.period + 2)
        loop.run(late)
        rows, ended, place, recorded = loop.out.tolist()
        if rows:
            self._take_over(loop, recorded)
            self._go_on(loop, ended, place)
        return int(rows)

    def _free_scans(self, most: int) -> int:
        """Scans from now on, all over before interrupts are blocked the next time."""
        place = bisect_right(self._blocked, self.time_us, key=itemgetter(1))
        if place == len(self._blocked):
            return most
        return max(0, (self._blocked[place][0] - self.time_us - 1) // self.scan_us)

    def _next_lateness(self, tick: int, most: int) -> np.ndarray:
        """Of a tick and those behind it."""
        if self._lateness is punctual:
            return ON_TIME
        return np.array([self._lateness(number) for number in range(tick, tick + min(TICKS_AHEAD, most))])

    def _hand_over(self, loop: EventLoop) -> bool:
        """The state of the pulse outputs; whether a loop knows how to go on from it."""
        for number, (event, channel) in enumerate(self._events):
            running = channel.running
            if running is None:
                return False
            segments, current = running
            loop.put_channel(number, event in self._attached, [segment.end for segment in segments], current)
        return True

    def _take_over(self, loop: EventLoop, recorded: int) -> None:
        """Where the loop has come to."""
        self._scans, self._next_scan, _, self.time_us = loop.clock.tolist()[:4]
        for event, tick in self._ticks.items():
            _, _, tick.nominal, tick.count, tick.due = loop.tick.tolist()
            self._note_run_time(self._attached[event], float(loop.longest[1]))
        self._note_run_time(self._cycle, float(loop.longest[0]))
        record, times = loop.record[:recorded], loop.times[:recorded]
        for number, channel in enumerate(self._channels):
            own = record[:, 0] == number
            channel.take_over(self.time_us, record[own, 1:], times[own], *loop.progress(number))

    def _go_on(self, loop: EventLoop, ended: int, place: int) -> None:
        """What is left of the last scan."""
        if place == WHOLE:
            return
        if place == IN_MAIN:
            self._processor.scan = self._scans
            self._end_block(loop, ended, self._cycle)
            self._main_is_over()
        if place == IN_INTERRUPT:
            self._processor.scan = self._scans - 1
            (event,) = self._ticks
            self._end_block(loop, ended, self._attached[event])
            self.memory[AC][:] = loop.saved[:-1].tobytes()
            self._special[1] = int(loop.saved[-1])
            self._serve()
        self._advance(self._next_scan)
        self._refresh()

    def _end_block(self, loop: EventLoop, ended: int, block: str) -> None:
        if ended == QUIET:
            self._watch_directions()
        else:
            self._guarded(block, self._processor.settle, loop)
