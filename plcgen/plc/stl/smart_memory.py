"""Memory of an S7-200 SMART: its areas, where each lies, and the cells behind addresses.

All areas lie in one piece behind V memory, so that a pointer is an index into it whatever area it points to. The names
of areas that only the CPU uses hold a blank: no source can spell one.
"""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.core import FRAME, Area, Cell
from plcgen.plc.stl.syntax import Address
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DINT, INT, WORD_BITS, Elementary

V, SM, AC, TIMERS, COUNTERS = "V", "SM", "AC", "T", "C"
TIMER_BITS, TIMER_RUNS, TIMER_CLOCKS, TIMER_RESTS = "T bits", "T runs", "T clocks", "T rests"
COUNTER_BITS, COUNTER_EDGES = "C bits", "C edges"
EDGES = "EU ED"
PHYSICAL_OUTPUTS = "Q physical"

LOCAL_BYTES = 64
COUNT = 256
"""Timers, and counters."""
MOST_EDGES = 1024
"""EU and ED in a program."""

AREAS: Mapping[Area | str, int] = {
    V: 8192,
    Area.INPUTS: 32,
    Area.OUTPUTS: 32,
    Area.MEMORY: 32,
    SM: 2048,
    "S": 32,
    "AI": 112,
    "AQ": 112,
    TIMERS: 2 * COUNT,
    COUNTERS: 2 * COUNT,
    AC: 16,
    TIMER_BITS: COUNT // BYTE_BITS,
    TIMER_RUNS: COUNT // BYTE_BITS,
    TIMER_CLOCKS: 4 * COUNT,
    TIMER_RESTS: 4 * COUNT,
    COUNTER_BITS: COUNT // BYTE_BITS,
    COUNTER_EDGES: 2 * COUNT // BYTE_BITS,
    EDGES: MOST_EDGES // BYTE_BITS,
    PHYSICAL_OUTPUTS: 32,
}
"""Bytes of each area."""

STARTS: Mapping[Area | str, int] = {area: sum(list(AREAS.values())[:place]) for place, area in enumerate(AREAS)}
"""Where each area lies in the one piece of memory."""

POINTER_TO_V = 0x08
POINTER_AREAS: Mapping[int, Area | str] = {
    POINTER_TO_V: V,
    0x00: Area.INPUTS,
    0x01: Area.OUTPUTS,
    0x02: Area.MEMORY,
    0x03: SM,
    0x04: "S",
    0x05: "AI",
    0x06: "AQ",
    0x09: TIMERS,
    0x0A: COUNTERS,
}
"""What the first byte of a pointer stands for. 16#08 for V is known, the others are ours."""

_CELL_AREAS: Mapping[str, Area | str] = {"I": Area.INPUTS, "Q": Area.OUTPUTS, "M": Area.MEMORY, "L": FRAME}
_SIZES: Mapping[str, int] = {"X": 1, "B": 8, "W": 16, "D": 32}
_SPELT: Mapping[int, str] = {1: "a bit", 8: "a byte", 16: "a word", 32: "a double word"}
DEFAULTS: Mapping[str, Elementary] = {"X": BOOL, "B": BYTE, "W": INT, "D": DINT}
"""How an address alone is read."""


def default_type(address: Address) -> Elementary:
    return DEFAULTS[address.size] if address.size else DINT if address.area == AC else INT


def cell_at(address: Address, kind: Elementary) -> Cell:
    """The cell of an address read as `kind`. Raises ValueError in words for a user."""
    if address.size and _SIZES[address.size] != kind.bits:
        raise ValueError(f"{address} is {_SPELT[_SIZES[address.size]]}, {_SPELT[kind.bits]} is wanted here")
    if address.area == AC:
        return _accumulator(address, kind)
    if address.area in (TIMERS, COUNTERS):
        return _counting(address, kind)
    area = _CELL_AREAS.get(address.area, address.area)
    _check_place(address, area, kind)
    return Cell(area, address.byte * BYTE_BITS + address.bit, kind)


def _check_place(address: Address, area: Area | str, kind: Elementary) -> None:
    if address.bit > 7:
        raise ValueError(f"{address}: bit {address.bit} does not exist; a byte has bits 0 to 7")
    room = LOCAL_BYTES if area is FRAME else AREAS[area]
    if address.byte * BYTE_BITS + kind.bits > room * BYTE_BITS:
        raise ValueError(f"{address} lies outside the {room} bytes of {address.area}")
    if address.area in ("AI", "AQ") and address.byte % 2:
        raise ValueError(f"{address}: analog words have even numbers")


def _accumulator(address: Address, kind: Elementary) -> Cell:
    """A byte or word of an accumulator is its low end."""
    if address.byte > 3:
        raise ValueError(f"{address} does not exist; there are AC0 to AC3")
    if kind is BOOL:
        raise ValueError(f"{address} is an accumulator, a bit is wanted here")
    return Cell(AC, (address.byte + 1) * 32 - kind.bits, kind)


def _counting(address: Address, kind: Elementary) -> Cell:
    """The bit or the current value of a timer or counter."""
    if address.byte >= COUNT:
        raise ValueError(f"{address} does not exist; {address.area}{COUNT - 1} is the last")
    if kind is BOOL:
        return Cell(TIMER_BITS if address.area == TIMERS else COUNTER_BITS, address.byte, BOOL)
    if kind.bits != WORD_BITS:
        raise ValueError(f"{address} is a word or a bit, {_SPELT[kind.bits]} is wanted here")
    return Cell(address.area, address.byte * WORD_BITS, kind)


def pointer_to(address: Address) -> int:
    """The value of &address. Raises ValueError where no pointer may point."""
    if address.area in (TIMERS, COUNTERS):
        cell = cell_at(address, INT)
    elif address.size in ("", "X", "D") and address.area == AC:
        raise ValueError(f"&{address}: a pointer cannot point to an accumulator; point to V memory")
    elif address.size == "X":
        raise ValueError(f"&{address}: a pointer points to a byte; write &{address.area}B{address.byte}")
    else:
        cell = cell_at(address, DEFAULTS[address.size])
    area = next((number for number, area in POINTER_AREAS.items() if area == cell.area), None)
    if area is None:
        raise ValueError(f"&{address}: a pointer cannot point to {address.area}; point to V memory")
    return area << 24 | cell.bit // BYTE_BITS


def pointed(pointer: int, size: int) -> int:
    """Bits from the start of all memory to what a pointer means; negative (~pointer) when that is nowhere."""
    area = POINTER_AREAS.get(pointer >> 24)
    offset = pointer & 0xFFFFFF
    if area is None or offset + size > AREAS[area]:
        return ~pointer
    return (STARTS[area] + offset) * BYTE_BITS
