"""Scans, ticks and pulse trains of an S7-200 SMART without Python in between, as long as all goes its usual way.

`cpu.smart` and `cpu.pto` say what a CPU does; here is the part of it that a program does thousands of times: MAIN, the
routine of one timed interrupt, and PLS that starts the profile table of an idle output. At whatever else the loop ends,
in the middle of a block if need be, and Python goes on from there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.engine import FastEngine
from plcgen.plc.fast.vm import COUNTS, DONE, EVENTS, QUIET, REQUEST, SLOTS, START, enter, run

VM = "1aa064b2122f2c56"
"""Beginning of the SHA-256 of vm.py, written by generate.py."""

SPECIAL, IMAGE, OUTPUTS, SIZE, WATCHED, TABLES, TABLES_END, ACCUMULATORS = range(8)
"""Places: first bytes of areas, bytes of the outputs, the byte that is watched, the end of V memory."""
SAVED = 16
"""Bytes of the accumulators."""
SCAN, NEXT_SCAN, SCAN_US, NOW, ENABLED, MOST = range(6)
ROUTINE, PERIOD, NOMINAL, TICKS, DUE = range(5)
"""Of the timed interrupt; a routine of -1 is none."""
STATUS, CONTROL, TABLE, SEGMENT, DIRECTION, MASK, HAS_EVENT, BUSY, COUNT, CURRENT, CHANNEL = range(11)
"""Of a channel: its bytes of special memory, the byte and bit of its direction (or -1), whether its end is an event,
whether it runs, the segments of its train and which one runs.
"""
ROWS, ENDED, PLACE, RECORDED, OUT = range(5)
WHOLE, IN_MAIN, IN_INTERRUPT, BETWEEN = range(4)
"""Where it ended: behind a scan, in MAIN, in the interrupt, or behind MAIN while the time of its scan goes on."""
OF, IS_FIRST, PULSES, FIRST_HZ, LAST_HZ, BIT, SENT = range(7)
"""A segment that was started: by which channel, whether as the first of its table, and what it sends."""
MOST_SEGMENTS, LONGEST_TABLE = 8192, 255
ENTRY_BYTES = 12
STARTS, IDLE, MOST_HZ, MOST_PULSES, SHORTEST_US = 0xE0, 0x80, 100_000, 2**31 - 1, 500
"""As in `cpu.pto`: ENABLE, PULSES and TABLE, and so on. Numba would keep old ones if they came from there."""

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
def _advance(channels: Any, ends: Any, now: int) -> None:
    """Trains that are over by now."""
    for number in range(len(channels)):
        channel = channels[number]
        if channel[BUSY] and ends[number, channel[COUNT] - 1] <= now:
            channel[BUSY] = 0


@compiled
def _refresh(memory: Any, special: int, enabled: int, channels: Any, ends: Any, now: int) -> None:
    """What special memory says before any program text runs."""
    memory[special] |= 1
    memory[special + 4] = memory[special + 4] & 239 | enabled
    _advance(channels, ends, now)
    for number in range(len(channels)):
        channel = channels[number]
        if not channel[BUSY]:
            memory[channel[STATUS]] = memory[channel[STATUS]] & 112 | IDLE
            memory[channel[SEGMENT]] = 0
            continue
        while channel[CURRENT] < channel[COUNT] - 1 and ends[number, channel[CURRENT]] <= now:
            channel[CURRENT] += 1
        memory[channel[STATUS]] &= 112
        memory[channel[SEGMENT]] = channel[CURRENT] + 1


@compiled
def _word(memory: Any, at: int, size: int) -> int:
    value = np.int64(0)
    for place in range(size):
        value = value << 8 | memory[at + place]
    return int(value)


@compiled
def _clamped(value: int, most: int) -> int:
    return min(max(value, 1), most)


@compiled
def _starts(
    memory: Any, places: Any, channels: Any, ends: Any, number: int, now: int, record: Any, times: Any, out: Any
) -> bool:
    """PLS: whether it starts the profile table of an idle output, as it should. Nothing is touched otherwise."""
    if not 0 <= number < len(channels):
        return False
    channel = channels[number]
    _advance(channels, ends, now)
    if memory[channel[CONTROL]] & STARTS != STARTS or channel[BUSY]:
        return False
    table = places[TABLES] + _word(memory, channel[TABLE], 2)
    if table >= places[TABLES_END]:
        return False
    count, recorded = np.int64(memory[table]), out[RECORDED]
    if count == 0 or table + 1 + count * ENTRY_BYTES > places[TABLES_END] or recorded + count > MOST_SEGMENTS:
        return False
    bit = np.int64(-1)
    if channel[DIRECTION] >= 0:
        bit = np.int64(memory[channel[DIRECTION]] & channel[MASK] != 0)
    start = float(now)
    for index in range(count):
        entry = table + 1 + index * ENTRY_BYTES
        first = _clamped(_word(memory, entry, 4), MOST_HZ)
        last = _clamped(_word(memory, entry + 4, 4), MOST_HZ)
        pulses = _clamped(_word(memory, entry + 8, 4), MOST_PULSES)
        duration = 2_000_000 * pulses / (first + last)
        if duration < SHORTEST_US:
            return False
        row = record[recorded + index]
        row[OF], row[IS_FIRST], row[PULSES], row[FIRST_HZ], row[LAST_HZ], row[BIT] = (
            number, index == 0, pulses, first, last, bit
        )  # fmt: skip
        times[recorded + index, 0] = start
        start += duration
        times[recorded + index, 1] = start
    for index in range(count):
        ends[number, index] = times[recorded + index, 1]
    out[RECORDED] += count
    channel[BUSY], channel[COUNT], channel[CURRENT] = 1, count, 0
    memory[channel[STATUS]] &= 64
    memory[channel[SEGMENT]] = 1
    return True


@compiled
def _differ(memory: Any, at: int, other: Any) -> bool:
    for place in range(len(other)):  # noqa: SIM110 - Numba has no generators in any()
        if memory[at + place] != other[place]:
            return True
    return False


@compiled
def _has_end(channels: Any, ends: Any, until: int) -> bool:
    """Whether a train ends by then for which a routine waits."""
    for number in range(len(channels)):
        channel = channels[number]
        if channel[BUSY] and channel[HAS_EVENT] and np.ceil(ends[number, channel[COUNT] - 1]) <= until:
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
def _block(
    code: Any, room: Any, memory: Any, entry: int, budget: int, pls: Any, places: Any, channels: Any, ends: Any,
    now: int, record: Any, times: Any, out: Any,
) -> int:  # fmt: skip
    """A block with the trains that it starts; returns as `enter`."""
    ended = enter(code, room, memory, entry, 0, budget)
    while ended == REQUEST and not room[EVENTS]:
        row = room[START]
        if pls[row, 0] < 0:
            return ended
        if not _starts(memory, places, channels, ends, room[SLOTS + pls[row, 0]], now, record, times, out):
            return ended
        room[SLOTS + pls[row, 1]] = 0
        room[START] = row + 1
        ended = run(code, room, memory)
    return QUIET if ended == DONE and not room[EVENTS] else ended


@compiled
def scans(
    code: Any, room: Any, memory: Any, main: int, budget: int, places: Any, clock: Any, tick: Any, late: Any,
    channels: Any, ends: Any, pls: Any, costs: Any, saved: Any, record: Any, times: Any, out: Any, longest: Any,
) -> None:  # fmt: skip
    """Up to clock[MOST] scans; `out`, `clock`, `tick` and `channels` say how far they came.

    It ends before a scan that would change the outputs, and behind a block that has changed them at once; behind a
    scan that changed the byte that is watched; before an event; in a block that needs Python. `late` has how late the
    next ticks come; `longest` the most that MAIN and the routine cost.
    """
    special, physical, routine = places[SPECIAL], places[OUTPUTS], tick[ROUTINE]
    outputs = memory[physical : physical + places[SIZE]].copy()
    seen = memory[places[WATCHED]]
    first_tick = tick[TICKS]
    out[ROWS], out[ENDED], out[PLACE], out[RECORDED] = 0, QUIET, WHOLE, 0
    longest[:] = 0.0
    while out[ROWS] < clock[MOST]:
        now = clock[NEXT_SCAN]
        end = now + clock[SCAN_US]
        if _differ(memory, places[IMAGE], outputs) or _has_end(channels, ends, end):
            return
        clock[NOW] = now
        memory[special] = _clock_bits(clock[SCAN], now // 1000)
        _refresh(memory, special, clock[ENABLED], channels, ends, now)
        out[ROWS] += 1
        out[PLACE] = IN_MAIN
        out[ENDED] = _block(
            code, room, memory, main, budget, pls, places, channels, ends, now, record, times, out
        )  # fmt: skip
        if out[ENDED] != QUIET:
            return
        longest[0] = max(longest[0], _taken(room, costs))
        if _differ(memory, physical, outputs):
            return
        clock[SCAN] += 1
        clock[NEXT_SCAN] = end
        while routine >= 0 and tick[DUE] <= end:
            out[PLACE] = BETWEEN
            if _has_end(channels, ends, tick[DUE]) or tick[TICKS] + 1 - first_tick >= len(late):
                return
            now = max(clock[NOW], tick[DUE])
            clock[NOW] = now
            _advance(channels, ends, now)
            tick[TICKS] += 1
            tick[NOMINAL] += tick[PERIOD]
            tick[DUE] = max(tick[NOMINAL] + late[tick[TICKS] - first_tick], now)
            saved[:SAVED] = memory[places[ACCUMULATORS] : places[ACCUMULATORS] + SAVED]
            saved[SAVED] = memory[special + 1]
            _refresh(memory, special, clock[ENABLED], channels, ends, now)
            out[PLACE] = IN_INTERRUPT
            out[ENDED] = _block(
                code, room, memory, routine, budget, pls, places, channels, ends, now, record, times, out
            )  # fmt: skip
            if out[ENDED] != QUIET:
                return
            longest[1] = max(longest[1], _taken(room, costs))
            if _differ(memory, physical, outputs):
                return
            memory[places[ACCUMULATORS] : places[ACCUMULATORS] + SAVED] = saved[:SAVED]
            memory[special + 1] = saved[SAVED]
        out[PLACE] = BETWEEN
        if _has_end(channels, ends, end):
            return
        clock[NOW] = end
        _refresh(memory, special, clock[ENABLED], channels, ends, end)
        out[PLACE] = WHOLE
        if memory[places[WATCHED]] != seen:
            return


def _channel(places: Sequence[int], status: int, control: int, table: int, segment: int, direction: int) -> list[int]:
    """A row of an idle channel."""
    special, outputs = places[SPECIAL], places[OUTPUTS]
    byte, bit = divmod(direction, 8)
    way = [outputs + byte, 1 << bit] if direction >= 0 else [-1, 0]
    return [*(special + place for place in (status, control, table, segment)), *way, 0, 0, 0, 0]


class EventLoop:
    """The arrays of `scans` for one program. `places` as the constants above say; `costs` are the prices of what the
    program counts.
    """

    def __init__(
        self,
        engine: FastEngine,
        main: int,
        places: Sequence[int],
        costs: Sequence[float],
        ports: Sequence[tuple[int, ...]],
    ) -> None:
        self._engine, self._main = engine, main
        self._places, self._costs = np.array(places), np.array(costs, dtype=np.float64)
        self._pls = np.full((len(engine.parts[0]), 2), -1, np.int64)
        for row, slot, result in engine.requests_of("PLS"):
            self._pls[row] = slot, result
        self.clock, self.tick = np.zeros(MOST + 1, np.int64), np.zeros(DUE + 1, np.int64)
        self._channels = np.array([_channel(places, *port) for port in ports])
        self._ends = np.zeros((len(ports), LONGEST_TABLE))
        self.record, self.times = np.zeros((MOST_SEGMENTS, SENT), np.int64), np.zeros((MOST_SEGMENTS, 2))
        self.out, self.longest, self.saved = np.zeros(OUT, np.int64), np.zeros(2), np.zeros(SAVED + 1, np.uint8)

    def entry(self, block: str) -> int:
        """Where a block without parameters begins."""
        found = self._engine.entry(block)
        assert found is not None, block
        return found

    def put_channel(self, number: int, has_event: bool, ends: Sequence[float], current: int) -> None:
        """The state of a pulse output: when the segments of its train end, which of them runs."""
        self._channels[number, HAS_EVENT:] = has_event, bool(ends), len(ends), current
        self._ends[number, : len(ends)] = ends

    def progress(self, number: int) -> tuple[bool, int]:
        """Whether an output is busy now, and the segment of its train that it has come to."""
        return bool(self._channels[number, BUSY]), int(self._channels[number, CURRENT])

    def run(self, late: np.ndarray) -> None:
        """See `scans`."""
        engine = self._engine
        scans(
            *engine.parts, self._main, engine.budget[0], self._places, self.clock, self.tick, late,
            self._channels, self._ends, self._pls, self._costs, self.saved, self.record, self.times, self.out,
            self.longest,
        )  # fmt: skip
        engine.have_run(int(self.out[ROWS]))

    def settle(self) -> None:
        """See `engines.Loop`."""
        self._engine.go_on(int(self.out[ENDED]))
