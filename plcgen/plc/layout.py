"""Where members of a structure lie, by the rule of S7 data blocks without optimisation.

BOOLs share bytes; BYTE and CHAR take the next byte; everything else starts at an even byte, and ARRAY and STRUCT end
at one too.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from plcgen.plc.types import BOOL, BYTE_BITS, WORD_BITS, Elementary, Field, Structure, Type, Value, align


@dataclass(frozen=True)
class Member:
    """A declared member: `initial` bytes when they differ from its type's; `view_of` the member it lies upon (AT)."""

    name: str
    type: Type
    initial: bytes | None = None
    view_of: str | None = None


def arrange(name: str, sections: Iterable[Iterable[Member]]) -> Structure:
    """A structure with the members of all sections one after another; each section starts at an even byte."""
    fields: list[Field] = []
    image = bytearray()
    end = 0
    for section in sections:
        end = align(end, WORD_BITS)
        for member in section:
            start = _start(member, fields, end)
            fields.append(Field(member.name, member.type, start))
            end = max(end, start + member.type.bits)
            image.extend(bytes(align(end, WORD_BITS) // BYTE_BITS - len(image)))
            if member.view_of is None:
                write(image, start, member.type, member.initial or member.type.initial)
    return Structure(name, tuple(fields), align(end, WORD_BITS), bytes(image))


def _start(member: Member, fields: list[Field], end: int) -> int:
    if member.view_of is None:
        return align(end, member.type.alignment)
    return next(field.bit for field in fields if field.name.casefold() == member.view_of.casefold())


def write(image: bytearray, bit: int, target: Type, data: bytes) -> None:
    """Put the encoded value of one member into an image."""
    start = bit // BYTE_BITS
    if target is BOOL:
        mask = 1 << bit % BYTE_BITS
        image[start] = image[start] & ~mask | (mask if data[0] else 0)
    else:
        image[start : start + len(data)] = data


def read(image: bytes | bytearray, bit: int, source: Type) -> Value:
    """The value of one member in an image."""
    start = bit // BYTE_BITS
    if source is BOOL:
        return bool(image[start] >> bit % BYTE_BITS & 1)
    data = bytes(image[start : start + source.bits // BYTE_BITS])
    return source.decode(data) if isinstance(source, Elementary) else data
