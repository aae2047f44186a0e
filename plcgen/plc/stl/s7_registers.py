"""The registers of an S7-300 as places of the core, and the memory through which blocks hand them on.

Inside a block each is a register. Where one block reads what another left, as an accumulator behind UC, it lies in
`SHARED` between them. An S7-300 has two accumulators.
"""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.core import Cell, DataBlock, Literal, Register
from plcgen.plc.layout import Member, arrange
from plcgen.plc.types import BOOL, BYTE, DWORD

SHARED = "CPU registers"
"""With a blank, so that no block of a source has the name."""

TRUE, FALSE = Literal(True, BOOL), Literal(False, BOOL)

ACCU1 = Register(1, DWORD, "ACCU1")
ACCU2 = Register(2, DWORD, "ACCU2")
AR1 = Register(3, DWORD, "AR1")
AR2 = Register(4, DWORD, "AR2")
RLO = Register(5, BOOL, "RLO")
BR = Register(6, BOOL, "BR")
OV = Register(7, BOOL, "OV")
CC = Register(8, BYTE, "CC")
"""2 * CC1 + CC0"""
OS = Register(9, BOOL, "OS")
OR = Register(10, BOOL, "OR")
FC = Register(11, BOOL, "FC")
"""Not first check: the next logic instruction combines with RLO."""
COUNT = 11

KEPT = (ACCU1, ACCU2, AR1, AR2, RLO, BR, OV, CC)
"""What a call and the end of a block leave as it is; OS, OR and FC begin anew in each block."""

_STRUCTURE = arrange(SHARED, [[Member(register.name, register.type) for register in KEPT]])
CELLS: Mapping[Register, Cell] = {
    register: Cell(SHARED, field.bit, field.type) for register, field in zip(KEPT, _STRUCTURE.fields, strict=True)
}
SHARED_BLOCK = DataBlock(SHARED, _STRUCTURE, _STRUCTURE.initial)
