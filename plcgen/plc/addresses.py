"""Absolute operands such as M0.0, %MW10 and QD4."""

from __future__ import annotations

import re

from plcgen.plc.core import Area, Cell
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DWORD, LWORD, WORD

AREA_BYTES = 65536
SIZES = {"X": BOOL, "B": BYTE, "W": WORD, "D": DWORD, "L": LWORD}
_ADDRESS = re.compile(r"%?(P?[IQ]|M)([XBWD]?)(\d+)(?:\.([0-7]))?", re.IGNORECASE)


def parse_address(text: str) -> Cell | None:
    """The cell of an absolute operand outside data blocks; None for anything else. Raises ValueError beyond an area."""
    match = _ADDRESS.fullmatch(text)
    if match is None:
        return None
    area, size, byte, bit = match.groups(default="")
    size = size.upper() or "X"
    if (size == "X") != bool(bit):
        raise ValueError("a bit needs .0 to .7, B, W and D have none")
    return cell(Area(area.upper()), size, int(byte), int(bit or 0))


def cell(area: Area | str, size: str, byte: int, bit: int, room: int = AREA_BYTES) -> Cell:
    """The cell at a byte and bit of an area with `room` bytes. Raises ValueError beyond it."""
    kind = SIZES[size]
    start = byte * BYTE_BITS + bit
    if start + kind.bits > room * BYTE_BITS:
        raise ValueError(f"address outside the {room} bytes of {area}")
    return Cell(area, start, kind)
