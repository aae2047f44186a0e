"""From operands of STL to places of the core."""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.addresses import AREA_BYTES, SIZES, parse_address
from plcgen.plc.core import FRAME, INSTANCE, Area, Cell, DataBlock, Literal, Operand, Place, Register
from plcgen.plc.scl.lowering_declarations import member_at
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.scl.syntax import Scope as Spelling
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_constants import POINTER_AREAS
from plcgen.plc.stl.s7_operators import CONDITIONS, STATUS_WORD, pointed
from plcgen.plc.stl.s7_registers import AR1, AR2, BR, CC, OS, OV, RLO
from plcgen.plc.stl.s7_selection import OWN
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BOOL, BYTE_BITS, DWORD, Elementary

ADDRESS_REGISTERS = {"AR1": AR1, "AR2": AR2}
_AREAS: Mapping[str, Area] = {
    "I": Area.INPUTS,
    "Q": Area.OUTPUTS,
    "M": Area.MEMORY,
    "PI": Area.PERIPHERAL_INPUTS,
    "PQ": Area.PERIPHERAL_OUTPUTS,
    "L": FRAME,
}

_WIDTHS = {1: "bit", 8: "byte", 16: "word", 32: "double word"}

# ------------------------------------------------------------------------------------------------------------ places


def place_of(code: Code, operand: syntax.Operand) -> Place:
    """The place of an operand that can be read and written."""
    match operand:
        case syntax.Variable():
            return _variable(code, operand)
        case syntax.Absolute():
            return _absolute(code, operand)
        case syntax.Indirect():
            pointer = code.taken(place_of(code, operand.pointer))
            if pointer.type.bits != DWORD.bits:
                message = f"{code.text(operand.pointer)} is {pointer.type}; a pointer is a DWORD"
                raise code.error(message, operand.pointer)
            return _pointed(code, operand, operand.area, code.bits(pointer), 0, operand.size)
        case syntax.RegisterIndirect():
            return _by_register(code, operand)
    raise code.error(f"{code.text(operand)} is no variable and no address", operand)


def _variable(code: Code, operand: syntax.Variable) -> Place:
    local = None if operand.scope is Spelling.GLOBAL else code.scope.place(operand)
    if local is not None:
        return local
    if operand.scope is Spelling.LOCAL:
        raise code.error(code.scope.unknown(operand), operand)
    data = code.catalogue.data_block(operand.name)
    if data is not None:
        return _member(code, operand, data)
    absolute = code.catalogue.absolute(operand.name)
    cell = _parsed(code, operand, absolute) if not operand.path else None
    if cell is None:
        raise code.error(_unknown(code, operand), operand)
    return cell


def _parsed(code: Code, operand: syntax.Variable, absolute: str) -> Cell | None:
    try:
        return parse_address(absolute)
    except ValueError as error:
        raise code.error(f"{operand.name} = {absolute}: {error}", operand) from None


def _unknown(code: Code, operand: syntax.Variable) -> str:
    if operand.scope is Spelling.PLAIN:
        return code.scope.unknown(operand)
    known = [name for name in code.catalogue.names() if code.catalogue.find(name, BlockKind.DB)]
    return f'"{operand.name}" is no data block of this source and no symbol{did_you_mean(operand.name, known)}'


def _member(code: Code, operand: syntax.Variable, data: DataBlock) -> Cell:
    if not operand.path:
        raise code.error(f"{operand.name} is a data block; name one of its members", operand)
    kind, bit = member_at(code.scope.declarations, data.type, operand.path)
    return Cell(data.name, bit, kind)


# ---------------------------------------------------------------------------------------------------------- absolute


def _absolute(code: Code, operand: syntax.Absolute) -> Cell:
    area, room = area_of(code, operand, operand.area, operand.data_block)
    bit = operand.byte * BYTE_BITS + operand.bit
    kind = SIZES[operand.size]
    if bit + kind.bits > room:
        message = f"{code.text(operand)} lies outside the {room // BYTE_BITS} bytes of {_shown(code, area)}"
        raise code.error(message, operand)
    return Cell(area, bit, kind)


def _shown(code: Code, area: Area | str) -> str:
    return f"VAR_TEMP of {code.block.name}" if area == FRAME else "the instance" if area == INSTANCE else str(area)


def area_of(code: Code, operand: syntax.Operand, letters: str, data_block: str = "") -> tuple[Area | str, int]:
    """An area of memory and its bits. Raises SourceError when the data block is not known."""
    if letters == "L":
        return FRAME, code.scope.local_bits
    if letters not in ("DB", "DI"):
        return _AREAS[letters], AREA_BYTES * BYTE_BITS
    name = data_block or (code.selected.db if letters == "DB" else code.selected.di)
    if name == OWN:
        return _own_instance(code, operand)
    if name is None:
        message = f"{code.text(operand)}: which data block is open here is not known; write OPN {letters} above it"
        raise code.error(message, operand)
    data = code.catalogue.data_block(name)
    if data is None:
        known = [block for block in code.catalogue.names() if code.catalogue.find(block, BlockKind.DB)]
        raise code.error(f"{name} is no data block of this source{did_you_mean(name, known)}", operand)
    return data.name, data.type.bits


def _own_instance(code: Code, operand: syntax.Operand) -> tuple[Area | str, int]:
    """Only where the instance begins with its data block do addresses count from there."""
    instance = code.scope.interface.instance
    assert instance is not None
    if code.catalogue.is_part(code.scope.interface):
        name = code.scope.interface.name
        message = f"{code.text(operand)}: {name} is a multi-instance in another block; name the variable itself"
        raise code.error(message, operand)
    return INSTANCE, instance.bits


# ---------------------------------------------------------------------------------------------------------- pointers


def _by_register(code: Code, operand: syntax.RegisterIndirect) -> Cell:
    area = operand.area or (code.selected.ar1 if operand.register == "AR1" else code.selected.ar2)
    if area is None:
        message = (
            f"{code.text(operand)}: to which area {operand.register} points is not known; "
            f"write the area, such as DB{operand.size if operand.size != 'X' else 'X'} [{operand.register},P#0.0]"
        )
        raise code.error(message, operand)
    return _pointed(code, operand, area, ADDRESS_REGISTERS[operand.register], operand.offset, operand.size)


def _pointed(code: Code, operand: syntax.Operand, letters: str, pointer: Operand, offset: int, size: str) -> Cell:
    area, room = area_of(code, operand, letters)
    kind = SIZES[size]
    what = f"{_shown(code, area)} has no {_WIDTHS[kind.bits]}"
    index = code.compute(pointed(room, kind.bits, offset, what), pointer)
    return Cell(area, 0, kind, index)


def pointer_to(code: Code, operand: syntax.PointerTo) -> Literal:
    """P##x: area and place of a variable of this block."""
    place = place_of(code, operand.variable)
    if not isinstance(place, Cell) or place.area not in (FRAME, INSTANCE):
        raise code.error(f"{code.text(operand)}: the place of a parameter of an FC is not known here", operand)
    area = POINTER_AREAS["L" if place.area == FRAME else "DI"]
    return Literal(area << 24 | place.bit, DWORD)


# ------------------------------------------------------------------------------------------------------------ values


def bit_of(code: Code, operand: syntax.Operand) -> Operand:
    """What A, O and X combine: a bit of memory or of the status word."""
    if isinstance(operand, syntax.Status):
        plain: Mapping[str, Register] = {"OV": OV, "OS": OS, "BR": BR}
        if operand.name in plain:
            return plain[operand.name]
        if operand.name in CONDITIONS:
            return code.compute(CONDITIONS[operand.name], CC)
    return bit_place(code, operand)


def bit_place(code: Code, operand: syntax.Operand) -> Place:
    """A bit that can be written."""
    place = place_of(code, operand)
    if place.type is not BOOL:
        raise code.error(f"{code.text(operand)} is {place.type}, {code.statement.word} takes a bit", operand)
    return place


def value_of(code: Code, operand: syntax.Operand) -> Operand:
    """What L loads."""
    match operand:
        case syntax.Constant(value=value, kind=kind):
            if kind is BOOL:
                raise code.error(f"{code.text(operand)} is a bit; write SET or CLR", operand)
            return Literal(value, kind)
        case syntax.PointerTo():
            return pointer_to(code, operand)
        case syntax.Status(name="STW"):
            return code.compute(STATUS_WORD, RLO, OS, OV, CC, BR)
        case syntax.RegisterName(name=name):
            return _data_block_fact(code, operand, name)
        case syntax.Text():
            raise code.error(f"{code.text(operand)}: L takes one, two or four characters", operand)
    return word_place(code, operand)


def _data_block_fact(code: Code, operand: syntax.Operand, name: str) -> Operand:
    """DBLG, DILG: length in bytes; DBNO, DINO: number."""
    if name in ADDRESS_REGISTERS:
        raise code.error(f"L does not read {name}; write T{name}", operand)
    area, room = area_of(code, operand, name[:2])
    if name.endswith("LG"):
        return Literal(room // BYTE_BITS, SIZES["W"])
    number = str(area).removeprefix("DB")
    if not number.isdigit():
        raise code.error(f"{name}: the number of {area} is not known here", operand)
    return Literal(int(number), SIZES["W"])


def word_place(code: Code, operand: syntax.Operand) -> Place:
    """A byte, word or double word of memory."""
    place = place_of(code, operand)
    if place.type is BOOL:
        raise code.error(f"{code.text(operand)} is a bit; {code.statement.word} takes 8, 16 or 32 of them", operand)
    if not isinstance(place.type, Elementary) or place.type.bits > DWORD.bits:
        message = f"{code.text(operand)} is {place.type}; {code.statement.word} takes up to 32 bits, name a part of it"
        raise code.error(message, operand)
    return place
