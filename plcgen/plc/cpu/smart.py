"""An S7-200 SMART in time: MAIN scan by scan, interrupts, and the pulse outputs.

Time is whole microseconds since RUN. A block takes no time of its own: MAIN runs at the start of its scan, what it
wrote to outputs reaches them at the end of the scan (=I, SI and RI at once), an interrupt routine runs at one instant.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import mul
from typing import Any, ClassVar

from plcgen.errors import PlcgenError
from plcgen.plc.core import Area, Cell, Compute, Program
from plcgen.plc.cpu.pto import PORTS, Channel, Violation
from plcgen.plc.cpu.smart_loop import ALWAYS_ON, INTERRUPTS_ENABLED, LoopedScans, punctual
from plcgen.plc.engine import Bytes
from plcgen.plc.machine import FaultRecord, Machine, Variable, accessors
from plcgen.plc.stl.operands import read_address
from plcgen.plc.stl.smart_costs import COSTS, SPEND
from plcgen.plc.stl.smart_memory import AC, AREAS, PHYSICAL_OUTPUTS, SM, STARTS, V, cell_at, default_type, pointed
from plcgen.plc.stl.smart_symbols import SYSTEM_SYMBOLS
from plcgen.plc.stl.syntax import BlockKind
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BOOL, Elementary

MAIN = "OB1"
MILLISECOND = 1000  # us
TIMED = {10: 34, 11: 35}
"""Events of the timed interrupts, and the special memory bytes of their periods in ms."""
PULSE_EVENTS = frozenset(port.event for port in PORTS.values())
COMMUNICATION, INPUT_OUTPUT, TIMERS = 0, 1, 2
"""Groups of interrupts, the most urgent first; their overflow bits are SM4.0 to SM4.2."""
_COMMUNICATION_EVENTS = frozenset({8, 9, 23, 24, 25, 26})
_TIMER_EVENTS = frozenset({10, 11, 21, 22})
QUEUE_LENGTHS = {COMMUNICATION: 8, INPUT_OUTPUT: 16, TIMERS: 8}

_NEVER = 1 << 62  # us

FIRST_SCAN, CLOCK_60S, CLOCK_1S, CLOCK_SCAN = 2, 16, 32, 64
"""Bits of SMB0."""


class _StopMode(Exception):  # noqa: N818 - no error: the program asked for it
    """STOP was executed."""


@dataclass
class _Ticks:
    """A timed interrupt: ticks stay on the grid of the period, however late one comes."""

    period: int
    nominal: int
    count: int
    due: int


@dataclass(frozen=True, order=True)
class _Request:
    """An interrupt that waits: most urgent group first, then in the order of arrival."""

    group: int
    number: int
    event: int


def group_of(event: int) -> int:
    if event in _COMMUNICATION_EVENTS:
        return COMMUNICATION
    return TIMERS if event in _TIMER_EVENTS else INPUT_OUTPUT


def _merged(intervals: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """In order, those that touch as one."""
    merged: list[tuple[int, int]] = []
    for start, end in sorted(intervals):
        if merged and start <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((start, end))
    return merged


class _Processor(Machine):
    """Memory and program; what the instructions ask of the CPU goes to its owner."""

    areas: ClassVar[Mapping[Area | str, int]] = AREAS

    def __init__(self, program: Program, temp_fill: int, given: Mapping[str, Callable[..., Any]]) -> None:
        self._given = given
        super().__init__(program, temp_fill)

    def global_memory(self) -> dict[Area | str, Bytes]:
        """One piece; V is all of it, so that an index from V reaches every area a pointer may point to."""
        whole = bytearray(sum(self.areas.values()))
        parts = memoryview(whole)
        views: dict[Area | str, Bytes] = {area: parts[STARTS[area] :][:size] for area, size in self.areas.items()}
        return {**views, V: whole}

    def services(self) -> Mapping[str, Callable[..., Any]]:
        return {"pointed": pointed, **{f"service_{name}": given for name, given in self._given.items()}}


class Smart(LoopedScans):
    """A CPU in RUN.

    `lateness(n)` are the us that tick n (from 0) of a timed interrupt comes late. In `blocked` intervals [start, end)
    of us no interrupt can start, as while a communication interrupt runs. `directions` names the direction output of
    a pulse output, such as {"Q0.0": "Q0.4"}: pulses sent while it is 1 count backwards.

    Instead of MAIN, `cycle` may name a block that a scan runs, with `arguments`; `results` are what it handed back.
    Of a program lowered with `timed`, `run_times` holds what MAIN and each INT took at the most, with all they called,
    in us: an estimate from `costs`, on which no time here depends.
    """

    def __init__(
        self,
        program: Program,
        scan_us: int = 5000,
        lateness: Callable[[int], int] | None = None,
        blocked: Sequence[tuple[int, int]] = (),
        temp_fill: int = 0,
        directions: Mapping[str, str] | None = None,
        cycle: str = MAIN,
        costs: Mapping[str, float] = COSTS,
    ) -> None:
        self.program = program
        self.arguments: Sequence[Any] = ()
        self.results: Any = None
        self.run_times: dict[str, float] = {}
        self._costs = [costs[name] for name in COSTS]
        self._is_timed = any(
            isinstance(item, Compute) and item.operator == SPEND
            for function in program.functions.values()
            for item in function.body
        )
        self._cycle = cycle
        self.scan_us = scan_us
        self.time_us = 0
        self.running = True
        self.violations: list[Violation] = []
        self._lateness = lateness or punctual
        self._blocked = _merged(blocked)
        self._processor = _Processor(program, temp_fill, self._services())
        self.memory = self._processor.memory
        self._special = self.memory[SM]
        self._attached: dict[int, str] = {}
        self._ticks: dict[int, _Ticks] = {}
        self._queue: list[_Request] = []
        self._loops = {}
        self._call_loops = {}
        self._arrivals = 0
        self._enabled = False
        self._scans = 0
        self._next_scan = 0
        given = directions or {}
        self.channels: Mapping[str, Channel] = {name: self._channel(name, given.get(name)) for name in PORTS}
        self._channels = tuple(self.channels.values())
        self._direction_bits = {name: self._cell(output, BOOL).bit for name, output in given.items()}
        self._directed = tuple(channel for channel in self._channels if channel.has_direction)
        self._events = tuple((PORTS[name].event, channel) for name, channel in self.channels.items())
        self._refresh()

    def _services(self) -> Mapping[str, Callable[..., Any]]:
        return {
            "pls": self._pls,
            "atch": self._attach,
            "dtch": self._detach,
            "cevnt": self._clear_events,
            "eni": lambda: self._enable(True),
            "disi": lambda: self._enable(False),
            "stop": self._stop,
            "wdr": lambda: None,
            "clock": lambda: self.time_us // MILLISECOND,
        }

    def _channel(self, output: str, direction: str | None) -> Channel:
        bit = self._cell(direction, BOOL).bit if direction else None
        read = accessors(output, self.memory[PHYSICAL_OUTPUTS], bit, BOOL)[0] if bit is not None else None
        view = memoryview(self.memory[V])[: AREAS[V]]
        return Channel(output, self._special, view, self.violations.append, read)

    # ------------------------------------------------------------------------------------------------------- running

    @property
    def faults(self) -> list[FaultRecord]:
        """Arithmetic events, such as an overflow; a CPU sets SM1 and goes on."""
        return self._processor.faults

    def scan(self) -> None:
        """One scan: MAIN, then time goes on to its end, with the interrupts that fall due."""
        if self.time_us < self._next_scan or self._queue:
            self._advance(self._next_scan)
        self._main()
        self._advance(self._next_scan)
        self._refresh()

    def run_until(self, time_us: int) -> None:
        """Scans and interrupts up to and with a time; the last scan may be on the way then."""
        while self._next_scan <= time_us:
            self._advance(self._next_scan)
            self._main()
        self._advance(time_us)
        self._refresh()

    def run_interrupt(self, event: int) -> None:
        """Run the routine that is attached to an event, here and now: one sample after another, without time."""
        if event not in self._attached:
            raise PlcgenError(f"no interrupt routine is attached to event {event}; ATCH it in the first scan")
        self._interrupt(self._attached[event])

    def _main(self) -> None:
        self._outputs()
        milliseconds = self.time_us // MILLISECOND
        self._special[0] = (
            ALWAYS_ON
            | (0 if self._scans else FIRST_SCAN)
            | (CLOCK_60S if milliseconds % 60_000 >= 30_000 else 0)
            | (CLOCK_1S if milliseconds % 1000 >= 500 else 0)
            | (0 if self._scans % 2 else CLOCK_SCAN)
        )
        self._processor.scan = self._scans
        if self._cycle in self.program.functions:
            self.results = self._run(self._cycle, self.arguments)
        self._main_is_over()

    def _main_is_over(self) -> None:
        self._scans += 1
        self._next_scan += self.scan_us
        self._serve()

    def _outputs(self) -> None:
        """The end of a scan: the image goes to the outputs."""
        self.memory[PHYSICAL_OUTPUTS][:] = self.memory[Area.OUTPUTS]
        self._watch_directions()

    def _run(self, name: str, arguments: Sequence[Any] = ()) -> Any:
        if not self.running:
            return None
        self._refresh()
        return self._guarded(name, self._processor.call, name, None, arguments)

    def _guarded(self, name: str, call: Callable[..., Any], *arguments: Any) -> Any:
        """What a block does may stop the CPU, and turn a direction."""
        try:
            return call(*arguments)
        except _StopMode:
            self.running = False
            return None
        finally:
            if self._is_timed:
                self._note_run_time(name, sum(map(mul, self._processor.engine.take_counts(), self._costs)))
            self._watch_directions()

    def _note_run_time(self, name: str, microseconds: float) -> None:
        if self._is_timed and microseconds:
            self.run_times[name] = max(microseconds, self.run_times.get(name, 0.0))

    def _refresh(self) -> None:
        self._special[0] |= ALWAYS_ON
        self._special[4] = self._special[4] & ~INTERRUPTS_ENABLED | (INTERRUPTS_ENABLED if self._enabled else 0)
        for channel in self._channels:
            channel.refresh(self.time_us)

    def _watch_directions(self) -> None:
        for channel in self._directed:
            if channel.busy:
                channel.watch_direction(self.time_us)

    def _stop(self) -> None:
        raise _StopMode

    # ----------------------------------------------------------------------------------------------------- interrupts

    def _advance(self, until: int) -> None:
        """Everything that happens up to and at a time."""
        while (moment := self._next_moment()) <= until:
            self.time_us = max(self.time_us, moment)
            self._notice()
            self._serve()
        self.time_us = max(self.time_us, until)

    def _next_moment(self) -> int:
        """When something next happens, far off when nothing will.

        The end of a train that nobody waits for is no event: it is seen when the output is looked at next.
        """
        moment = _NEVER
        for ticks in self._ticks.values():
            moment = min(moment, ticks.due)
        for event, channel in self._events:
            if channel.busy and (channel.has_load_waiting or event in self._attached):
                moment = min(moment, math.ceil(channel.next_change))
        if self._queue and self._enabled and self.running:
            moment = min(moment, self._free_from(self.time_us))
        return moment

    def _free_from(self, time: int) -> int:
        """The first moment from a time on when an interrupt can start."""
        place = bisect_right(self._blocked, (time, _NEVER)) - 1
        return max(time, self._blocked[place][1]) if place >= 0 else time

    def _notice(self) -> None:
        """Requests of the hardware at this moment."""
        for event, channel in self._events:
            if channel.busy and channel.advance(self.time_us):
                self.raise_event(event)
        for event, ticks in self._ticks.items():
            if ticks.due <= self.time_us:
                self.raise_event(event)
                self._plan(ticks, ticks.count + 1)

    def _plan(self, ticks: _Ticks, count: int) -> None:
        ticks.count = count
        ticks.nominal += ticks.period
        ticks.due = max(ticks.nominal + self._lateness(count), self.time_us)

    def raise_event(self, event: int) -> None:
        """Let an event happen now; a routine that is attached to it waits for its turn."""
        if event not in self._attached:
            return
        group = group_of(event)
        if sum(request.group == group for request in self._queue) == QUEUE_LENGTHS[group]:
            self._special[4] |= 1 << group
            self.violations.append(Violation(self.time_us, f"event {event}", "interrupt queue full: one is lost"))
            return
        self._arrivals += 1
        self._queue.append(_Request(group, self._arrivals, event))

    def _serve(self) -> None:
        """Waiting interrupts one after another, none inside another."""
        while self._queue and self._enabled and self.running and self._free_from(self.time_us) == self.time_us:
            request = min(self._queue)
            self._queue.remove(request)
            self._interrupt(self._attached[request.event])

    def _interrupt(self, routine: str) -> None:
        """The CPU saves accumulators and SM1; the logic stack is each network's own."""
        accumulators, status = bytes(self.memory[AC]), self._special[1]
        self._run(routine)
        self.memory[AC][:] = accumulators
        self._special[1] = status

    # ------------------------------------------------------------------------------------------------- instructions
    # Each returns why the CPU must stop, or nothing.

    def _pls(self, number: int) -> str | None:
        return self.channels[list(PORTS)[number]].command(self.time_us)

    def _attach(self, number: int, event: int) -> str | None:
        self._attached[event] = f"{BlockKind.INTERRUPT.value}{number}"
        if event in TIMED:
            period = self._special[TIMED[event]] * MILLISECOND
            if not period:
                return f"ATCH of event {event} with 0 ms in SMB{TIMED[event]}; write 1 to 255 before it"
            self._ticks[event] = _Ticks(period, self.time_us, -1, 0)
            self._plan(self._ticks[event], 0)
        return None

    def _detach(self, event: int) -> None:
        self._attached.pop(event, None)
        self._ticks.pop(event, None)
        self._clear_events(event)

    def _clear_events(self, event: int) -> None:
        self._queue = [request for request in self._queue if request.event != event]

    def _enable(self, enabled: bool) -> None:
        self._enabled = enabled

    # ----------------------------------------------------------------------------------------------------- variables

    def variable(self, path: str, kind: Elementary | None = None) -> Variable:
        """A symbol or address such as V10.0, VB100, VW100, VD100, T37, AC0.

        VB is BYTE, VW INT, VD DINT unless `kind` says how to read it.
        """
        cell = self._cell(path, kind)
        assert isinstance(cell.type, Elementary)
        return Variable(path, cell.type, *accessors(path, self.memory[cell.area], cell.bit, cell.type))

    def _cell(self, path: str, kind: Elementary | None) -> Cell:
        text = self.program.symbols.get(path.strip('"').casefold(), path)
        address = read_address(text)
        if address is None:
            near = did_you_mean(path, [*self.program.symbols, *SYSTEM_SYMBOLS])
            raise PlcgenError(f"no variable {path}{near or '; write an address such as VD100'}")
        try:
            cell = cell_at(address, kind or default_type(address))
        except ValueError as error:
            raise PlcgenError(f"{path}: {error}") from None
        if cell.area not in self.memory:
            raise PlcgenError(f"{path}: local memory lives only while its block runs")
        return cell
