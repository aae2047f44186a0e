"""Where the parameters and local variables of a block lie in its 64 bytes of local memory."""

from __future__ import annotations

from dataclasses import dataclass

from plcgen.plc.core import FRAME, Cell
from plcgen.plc.stl.smart_memory import LOCAL_BYTES
from plcgen.plc.stl.syntax import Block, Declaration, SectionKind
from plcgen.plc.types import BOOL, BYTE, BYTE_BITS, DINT, DWORD, INT, REAL, WORD, Elementary, align

TYPES = {row.name: row for row in (BOOL, BYTE, WORD, INT, DWORD, DINT, REAL)}


@dataclass(frozen=True)
class Local:
    """A parameter or temporary variable and its cell."""

    declaration: Declaration
    cell: Cell

    @property
    def type(self) -> Elementary:
        assert isinstance(self.cell.type, Elementary)
        return self.cell.type

    @property
    def is_given(self) -> bool:
        return self.declaration.section in (SectionKind.INPUT, SectionKind.IN_OUT)

    @property
    def is_returned(self) -> bool:
        return self.declaration.section in (SectionKind.IN_OUT, SectionKind.OUTPUT)

    @property
    def is_parameter(self) -> bool:
        return self.declaration.section is not SectionKind.TEMPORARY


def locals_of(block: Block) -> tuple[Local, ...]:
    """In their order: bits share bytes, all else starts at the next byte. Raises SourceError for a bad declaration."""
    found: list[Local] = []
    end = 0
    for declaration in block.declarations:
        if _is_power_flow(declaration):
            continue
        kind = _type(block, declaration)
        start = end if kind is BOOL else align(end, BYTE_BITS)
        end = start + kind.bits
        if end > LOCAL_BYTES * BYTE_BITS:
            message = f"local variables take more than the {LOCAL_BYTES} bytes of L; use V memory"
            raise block.source.error(message, declaration.span)
        if any(local.declaration.name.casefold() == declaration.name.casefold() for local in found):
            raise block.source.error(f"{declaration.name} is declared twice; rename one", declaration.span)
        found.append(Local(declaration, Cell(FRAME, start, kind)))
    return tuple(found)


def _is_power_flow(declaration: Declaration) -> bool:
    """EN, which editors list among the inputs: it is the condition of the CALL, and takes no memory."""
    return declaration.section is SectionKind.INPUT and declaration.name.upper() == "EN"


def _type(block: Block, declaration: Declaration) -> Elementary:
    if declaration.type_name not in TYPES:
        known = ", ".join(TYPES)
        message = f"type {declaration.type_name} is not supported; local variables are {known}"
        raise block.source.error(message, declaration.span)
    return TYPES[declaration.type_name]
