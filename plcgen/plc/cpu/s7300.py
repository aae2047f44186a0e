"""An S7-300: restart with OB100, the cycle with OB1, the cyclic interrupt OB35, and a clock.

Time here is the clock of the program, in ms; what a block takes to run is only as long as the caller says.
"""

from __future__ import annotations

import struct

from plcgen.errors import Location
from plcgen.plc.core import Program
from plcgen.plc.machine import Machine

OVERRUN = "overrun"
RESTART_OB, CYCLE_OB, INTERRUPT_OB = "OB100", "OB1", "OB35"

EVENT_INCOMING = 0x11
COLD_RESTART = 0x83
FIRST_CYCLE, FURTHER_CYCLE = 0x01, 0x03
INTERRUPT_5 = 0x36
CYCLE_PRIORITY, INTERRUPT_PRIORITY, RESTART_PRIORITY = 1, 12, 27
START_OF_TIME = bytes.fromhex("9001010000000002")
"""DATE_AND_TIME#1990-01-01-00:00:00, where a CPU's clock starts; it stands still so that runs repeat exactly."""


class S7300(Machine):
    """A machine with organization blocks; those that the program lacks are skipped, as in a real CPU.

    ob35_period is in ms, 1 .. 60000.
    """

    def __init__(self, program: Program, ob35_period: int = 100, temp_fill: int = 0) -> None:
        super().__init__(program, temp_fill)
        self.ob35_period = ob35_period
        self.clock = 0.0
        self.ticks = 0
        self._cycles = 0
        self._cycle_time = 0

    def startup(self) -> None:
        """Restart: OB100 once, and the clock of OB35 begins anew."""
        self.clock, self.ticks, self._cycles = 0.0, 0, 0
        self._run(RESTART_OB, header(COLD_RESTART, RESTART_PRIORITY, 100, 0, 0))

    def tick(self, duration: float = 0.0) -> None:
        """The next OB35: the clock goes on to the time it is due. `duration` is the ms its run takes.

        A run longer than the period is recorded as an overrun and swallows the ticks that fall due meanwhile.
        """
        self.ticks += 1
        self.clock = max(self.clock, float(self.ticks * self.ob35_period))
        self._run(INTERRUPT_OB, header(INTERRUPT_5, INTERRUPT_PRIORITY, 35, 0, 0, self.ob35_period))
        self.scan += 1
        lost = int(duration // self.ob35_period)
        if lost:
            self.record(OVERRUN, INTERRUPT_OB, self._location(INTERRUPT_OB))
            self.ticks += lost

    def cycle(self, duration: float, tick_duration: float = 0.0) -> None:
        """One cycle of `duration` ms: OB1 once, then every OB35 that falls due until its end."""
        start = FURTHER_CYCLE if self._cycles else FIRST_CYCLE
        last = self._cycle_time
        self._run(CYCLE_OB, header(start, CYCLE_PRIORITY, 1, last, last, last))
        end = self.clock + duration
        while (self.ticks + 1) * self.ob35_period <= end:
            self.tick(tick_duration)
        self.clock = max(self.clock, end)
        self._cycles += 1
        self._cycle_time = min(int(duration), 32767)

    def _run(self, name: str, frame: bytes) -> None:
        if name in self.program.functions:
            self.call(name, frame=frame)

    def _location(self, name: str) -> Location:
        function = self.program.functions.get(name)
        return function.source.location(function.span) if function else Location(name, 1, 1)


def header(start: int, priority: int, number: int, first: int, second: int, third: int = 0) -> bytes:
    """The 20 bytes an operating system puts in front of an OB's temporaries.

    EV_CLASS, STRT_INF, PRIORITY, OB_NUMBR, two reserved bytes, three INT that differ from OB to OB (OB1: previous,
    shortest and longest cycle; OB35: phase offset, reserved, period, all in ms), DATE_TIME.
    """
    return struct.pack(">6B3h", EVENT_INCOMING, start, priority, number, 0, 0, first, second, third) + START_OF_TIME
