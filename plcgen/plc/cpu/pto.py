"""Pulse train outputs of the S7-200 SMART: what PLS starts, and every pulse that leaves.

Times are microseconds since the CPU went to RUN; frequencies are whole Hz. Inside a segment the frequency is linear in
time, so N pulses from f0 to f1 last 2 N / (f0 + f1). Pulse k counts when its period is complete.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from struct import unpack_from
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

SECOND = 1_000_000  # us
SHORTEST_US = 500
"""A segment of a table shorter than this leaves the CPU no time to work out the next one: the output stops."""
MOST_HZ, MOST_HZ_SINGLE = 100_000, 65_535
ENTRY_BYTES = 12

UPDATE_FREQUENCY, UPDATE_COUNT, TABLE, PULSES, ENABLE = 0x01, 0x04, 0x20, 0x40, 0x80
"""Bits of the control byte."""
STOPPED, OVERRUN, IDLE = 0x20, 0x40, 0x80
"""Bits of the status byte."""
LEFT = 0x70
"""Those that only a program takes away."""


@dataclass(frozen=True)
class Port:
    """Special memory bytes of one pulse output, and its event."""

    status: int
    control: int
    frequency: int
    count: int
    segment: int
    table: int
    event: int


PORTS = {
    "Q0.0": Port(66, 67, 68, 72, 166, 168, event=19),
    "Q0.1": Port(76, 77, 78, 82, 176, 178, event=20),
    "Q0.3": Port(566, 567, 568, 572, 576, 578, event=34),
}


class Segment(NamedTuple):
    """Pulses that were sent. Segments of one table or of one load have the same number `train`.

    `direction` is the bit of the direction output when the train began, None without such an output. `truncated_at` is
    when a stop cut the segment short.
    """

    train: int
    start: float
    end: float
    pulses: int
    first_hz: int
    last_hz: int
    direction: bool | None = None
    truncated_at: float | None = None

    @property
    def duration(self) -> float:
        """us, as planned"""
        return self.end - self.start

    def sent_by(self, time: float) -> int:
        """Whole pulses by a time."""
        seconds = min(max(time, self.start), self.end) - self.start
        if seconds >= self.duration:
            return self.pulses
        seconds /= SECOND
        return math.floor(seconds * (self.first_hz + self._slope * seconds / 2))

    @property
    def sent(self) -> int:
        return self.pulses if self.truncated_at is None else self.sent_by(self.truncated_at)

    @property
    def _slope(self) -> float:
        """Hz per s"""
        return (self.last_hz - self.first_hz) * SECOND / self.duration

    def instants(self) -> NDArray[np.float64]:
        """When each of its pulses is complete."""
        k = np.arange(1, self.sent + 1, dtype=np.float64)
        root = np.sqrt(np.maximum(self.first_hz**2 + 2 * self._slope * k, 0.0))
        times: NDArray[np.float64] = self.start + 2 * SECOND * k / (self.first_hz + root)
        return times


@dataclass(frozen=True)
class Violation:
    """What a program must not do with a pulse output, or what it lost."""

    time_us: int
    output: str
    message: str

    def __str__(self) -> str:
        return f"{self.output} at {self.time_us} us: {self.message}"


class Channel:
    """One pulse output. `special` and `table` are SM and V memory, `direction` reads the direction output."""

    def __init__(
        self,
        output: str,
        special: Any,
        table: Any,
        report: Callable[[Violation], None],
        direction: Callable[[], bool] | None = None,
    ) -> None:
        self.output = output
        self.port = PORTS[output]
        self._status, self._segment = self.port.status, self.port.segment
        self.segments: list[Segment] = []
        self._drawn: tuple[object, tuple[NDArray[Any], ...]] = (None, ())
        self.lost = 0
        self._special, self._table, self._report = special, table, report
        self._direction = direction
        self._seen_direction: bool | None = None
        self._now = 0
        self._trains = 0
        self._first = self._current = 0
        """Places of the running train's first segment, and of the one that was last seen to run."""
        self.busy = False
        """Whether pulses leave."""
        self._multi = False
        self._stop_at: float | None = None
        """When a segment that is too short ends the train."""
        self._waiting: tuple[int, int] | None = None
        """Frequency and count of the load that waits behind the running one."""
        self._flags = 0
        self._loaded = (1, 1)
        self._look()

    # ---------------------------------------------------------------------------------------------------- the clock

    @property
    def has_direction(self) -> bool:
        """Whether an output says which way its pulses count."""
        return self._direction is not None

    @property
    def has_load_waiting(self) -> bool:
        """Whether another train begins when the running one ends."""
        return self._waiting is not None

    @property
    def is_at_rest(self) -> bool:
        """Whether no train runs, and there is nothing to tell of the last one."""
        return not (self.busy or self._flags)

    @property
    def running(self) -> tuple[Sequence[Segment], int] | None:
        """Segments of the running table and which of them runs; none when idle, None when there is more to it."""
        if self._waiting is not None or self._stop_at is not None or self._flags:
            return None
        return (self.segments[self._first :], self._current - self._first) if self.busy else ((), 0)

    def take_over(
        self, now: int, started: NDArray[np.int64], times: NDArray[np.float64], busy: bool, current: int
    ) -> None:
        """Time has gone on to `now`, and tables were started since. A row is a segment: whether it is the first of its
        table, pulses, first and last frequency, the bit of the direction or -1; and when it starts and ends. `busy` is
        whether the last train still runs, `current` which of its segments.
        """
        if len(started):
            firsts = np.flatnonzero(started[:, 0])
            trains = self._trains - 1 + np.cumsum(started[:, 0])
            ways = [None if bit < 0 else bool(bit) for bit in started[:, 4].tolist()]
            columns = (trains, *times.T, *started[:, 1:4].T)
            self._first, self._multi = len(self.segments) + int(firsts[-1]), True
            self.segments.extend(map(Segment, *(column.tolist() for column in columns), ways))
            self._trains += len(firsts)
            self._seen_direction = ways[-1]
        self.busy, self._current, self._now = busy, self._first + current, now
        self._look()

    @property
    def next_change(self) -> float:
        """When the running train ends by itself."""
        return self._end if self.busy else math.inf

    @property
    def _end(self) -> float:
        return self.segments[-1].end if self._stop_at is None else self._stop_at

    def advance(self, now: int) -> bool:
        """The time is `now`; whether a train is over since."""
        self._now = now
        if now < self._boundary:
            return False
        is_over = self._end <= now
        if is_over:
            self._finish()
        self._look()
        return is_over

    def _finish(self) -> None:
        """The train is over."""
        end = self._end
        self.busy = False
        if self._stop_at is not None:
            self._flags |= OVERRUN
            self._stop_at = None
        if self._waiting is not None:
            load, self._waiting = self._waiting, None
            self._begin(end, [(load[0], load[0], load[1])], multi=False)

    def _look(self) -> None:
        """What special memory says from now up to the next boundary between segments."""
        if not self.busy:
            self._boundary, self._number, self._idle = math.inf, 0, IDLE
            return
        last = len(self.segments) - 1
        while self._current < last and self.segments[self._current].end <= self._now:
            self._current += 1
        current = min(self._current, last)
        self._number, self._idle = current - self._first + 1, 0
        self._boundary = self._end if current == last else min(self._end, self.segments[current].end)

    def refresh(self, now: int) -> None:
        """Status and segment number in special memory, before any program text runs."""
        self.advance(now)
        special, status = self._special, self._status
        special[status] = special[status] & LEFT | self._flags | self._idle
        special[self._segment] = self._number
        self._flags = 0

    def watch_direction(self, now: int) -> None:
        """Note a direction output that changed under a running train."""
        self.advance(now)
        if self.busy and self._direction is not None:
            bit = self._direction()
            if bit != self._seen_direction:
                self._complain("direction output changed while a train runs")
            self._seen_direction = bit

    # ----------------------------------------------------------------------------------------------------- commands

    def command(self, now: int) -> str | None:
        """PLS. Returns why it cannot be executed, or nothing."""
        self.advance(now)
        control = self._special[self.port.control]
        refusal = self._refusal(control)
        if refusal is not None:
            return refusal
        if not control & ENABLE:
            self._stop(STOPPED)
        elif control & TABLE:
            self._start_table()
        else:
            self._load(control)
        self._look()
        self.refresh(now)
        return None

    def _refusal(self, control: int) -> str | None:
        port, start = self.port, self._table_start
        if control & ENABLE and not control & PULSES:
            return f"{self.output}: PWM is not modelled; set bit .6 of SMB{port.control} for a pulse train"
        if control & ENABLE and control & TABLE and self._table_count is None:
            return f"{self.output}: profile table at VB{start} reaches beyond V memory; mend SMW{port.table}"
        return None

    @property
    def _table_start(self) -> int:
        """Offset of the profile table from VB0."""
        start: int = unpack_from(">H", self._special, self.port.table)[0]
        return start

    @property
    def _table_count(self) -> int | None:
        """Segments of the profile table; None when it does not lie in V memory."""
        start, size = self._table_start, len(self._table)
        count: int = self._table[start] if start < size else size
        return count if start + 1 + count * ENTRY_BYTES <= size else None

    def _stop(self, flag: int) -> None:
        """What is left of the running train is lost."""
        if not self.busy:
            return
        left = sum(segment.pulses for segment in self.segments[self._first :])
        left += self._waiting[1] if self._waiting else 0
        kept = [segment for segment in self.segments[self._first :] if segment.start < self._now]
        kept = [s._replace(truncated_at=float(self._now)) if s.end > self._now else s for s in kept]
        self.segments[self._first :] = kept
        self.lost += left - sum(segment.sent for segment in kept)
        self.busy, self._waiting, self._stop_at = False, None, None
        self._flags |= flag

    def _start_table(self) -> None:
        entries = list(self._entries())
        if self.busy:
            self._overrun("PLS while a train runs: the rest of it is lost")
        if not entries:
            self._complain("profile table with 0 segments: no pulses")
            return
        self._clear()
        self._begin(float(self._now), entries, multi=True)

    def _entries(self) -> Iterator[tuple[int, int, int]]:
        """First frequency, last frequency and count of each segment in V memory."""
        start = self._table_start + 1
        for place in range(start, start + (self._table_count or 0) * ENTRY_BYTES, ENTRY_BYTES):
            first, last, pulses = unpack_from(">3I", self._table, place)
            yield _clamped(first, MOST_HZ), _clamped(last, MOST_HZ), _clamped(pulses, 2**31 - 1)

    def _load(self, control: int) -> None:
        """A single segment: it starts, or waits behind the running one."""
        frequency, count = self._loaded
        if control & UPDATE_FREQUENCY:
            frequency = _clamped(unpack_from(">H", self._special, self.port.frequency)[0], MOST_HZ_SINGLE)
        if control & UPDATE_COUNT:
            count = _clamped(unpack_from(">I", self._special, self.port.count)[0], 2**31 - 1)
        self._loaded = frequency, count
        if self.busy and self._multi:
            self._overrun("PLS of a single segment while a table runs: the rest of it is lost")
        if not self.busy:
            self._clear()
            self._begin(float(self._now), [(frequency, frequency, count)], multi=False)
        elif self._waiting is None:
            self._waiting = frequency, count
        else:
            self._flags |= OVERRUN
            self.lost += count
            self._complain(f"pipeline full: a load of {count} pulses is lost")

    def _overrun(self, message: str) -> None:
        before = self.lost
        self._stop(OVERRUN)
        self._complain(f"{message} ({self.lost - before} pulses)")

    def _clear(self) -> None:
        """A new train takes back what the last one left in the status byte."""
        self._special[self.port.status] &= 0x40

    def _begin(self, start: float, entries: list[tuple[int, int, int]], multi: bool) -> None:
        self._first = self._current = len(self.segments)
        self._multi, self.busy = multi, True
        bit = self._seen_direction = self._direction() if self._direction is not None else None
        for first, last, pulses in entries:
            duration = 2 * SECOND * pulses / (first + last)
            if multi and duration < SHORTEST_US:
                self._cut_short(start, duration, entries)
                break
            self.segments.append(Segment(self._trains, start, start + duration, pulses, first, last, bit))
            start += duration
        self._trains += 1

    def _cut_short(self, start: float, duration: float, entries: list[tuple[int, int, int]]) -> None:
        done = len(self.segments) - self._first
        lost = sum(pulses for _, _, pulses in entries[done:])
        self._stop_at = start
        self.lost += lost
        self._complain(
            f"segment {done + 1} lasts {duration:.1f} us, less than {SHORTEST_US}: the output stops "
            f"({lost} pulses lost)"
        )

    def _complain(self, message: str) -> None:
        self._report(Violation(self._now, self.output, message))

    # ------------------------------------------------------------------------------------------------------ results

    def forget(self) -> None:
        """Forget the segments that were sent. Only while no train runs."""
        assert not self.busy
        self.segments.clear()

    def position_at(self, times_us: NDArray[Any]) -> NDArray[np.int64]:
        """Pulses by each time; with a direction output those sent under a 1 count backwards."""
        before, signs, own = self._progress(times_us)
        return before + signs * np.floor(own).astype(np.int64)

    def progress_at(self, times_us: NDArray[Any]) -> NDArray[np.float64]:
        """As `position_at`, with the part of the pulse that is under way."""
        before, signs, own = self._progress(times_us)
        return before + signs * own

    def _progress(self, times_us: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """At each time: pulses of the segments before, sign of the present one, and what it has sent."""
        times = np.asarray(times_us, dtype=np.float64)
        if not self.segments:
            none = np.zeros(times.shape, dtype=np.int64)
            return none, none, np.zeros(times.shape)
        starts, durations, first, slope, sent, signs, before = self._columns()
        place = np.searchsorted(starts, times, side="right") - 1
        inside = np.maximum(place, 0)
        seconds = np.clip(times - starts[inside], 0.0, durations[inside]) / SECOND
        phase = seconds * (first[inside] + slope[inside] * seconds / 2)
        over = times - starts[inside] >= durations[inside]
        own = np.where(over, sent[inside], np.minimum(phase, sent[inside]))
        return before[inside], signs[inside], np.where(place < 0, 0.0, own)

    def _columns(self) -> tuple[NDArray[Any], ...]:
        """Of the segments: starts, durations in us, first frequencies, slopes, pulses, signs, and pulses before each.

        They are the same until the number of segments or the last one changes.
        """
        state = len(self.segments), self.segments[-1]
        if self._drawn[0] != state:
            rows = np.array([(s.start, s.end, s.first_hz, s.last_hz, s.sent, s.direction or 0) for s in self.segments])
            starts, ends, first, last = rows[:, :4].T.copy()
            sent, turned = rows[:, 4:].T.astype(np.int64)
            signs = 1 - 2 * turned
            slopes = (last - first) * SECOND / (ends - starts)
            before = np.concatenate([[0], np.cumsum(signs * sent)])
            self._drawn = state, (starts, ends - starts, first, slopes, sent, signs, before)
        return self._drawn[1]

    def instants(self) -> NDArray[np.float64]:
        """When each pulse is complete, in order."""
        return np.concatenate([segment.instants() for segment in self.segments] or [np.empty(0)])


def _clamped(value: int, most: int) -> int:
    return min(max(value, 1), most)
