"""Types as codecs on big-endian memory: how many bits, how aligned, and how bits become values.

Registers and cells hold plain Python values: bool for BOOL, float for REAL and LREAL, bytes for STRING, ARRAY and
STRUCT, and int for everything else (CHAR its code, TIME in ms, DATE in days since 1990-01-01, S5TIME and
DATE_AND_TIME their BCD digits).
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from itertools import product
from math import prod
from struct import Struct

Value = bool | int | float | bytes

BYTE_BITS = 8
WORD_BITS = 16


class Family(Enum):
    """What operators make of the bits."""

    BIT = "bit"
    BITS = "bits"
    INTEGER = "integer"
    UNSIGNED = "unsigned"
    FLOAT = "float"
    CHARACTER = "character"
    TIME = "time"


@dataclass(frozen=True)
class Elementary:
    """One row of the type table: `code` is the struct letter of the big-endian codec."""

    name: str
    bits: int
    code: str
    family: Family
    default: int | float = 0
    nesting = 0

    def __str__(self) -> str:
        return self.name

    def __hash__(self) -> int:
        return hash(self.name)

    def __reduce__(self) -> tuple[Callable[[str], object], tuple[str]]:
        """There is one of each, also in another process."""
        return _row_of, (self.name,)

    @cached_property
    def codec(self) -> Struct:
        return Struct(">" + self.code)

    @property
    def alignment(self) -> int:
        return min(self.bits, WORD_BITS)

    @property
    def is_integral(self) -> bool:
        return self.family is not Family.FLOAT

    @property
    def minimum(self) -> int:
        return -(1 << self.bits - 1) if self.code.islower() else 0

    @property
    def maximum(self) -> int:
        return self.minimum + (1 << self.bits) - 1

    @property
    def initial(self) -> bytes:
        return self.encode(self.default)

    def encode(self, value: Value) -> bytes:
        return self.codec.pack(self.nearest(value))

    def decode(self, data: bytes | bytearray) -> Value:
        value: Value = self.codec.unpack(data)[0]
        return bool(value & 1) if isinstance(value, int) and self.family is Family.BIT else value

    def nearest(self, value: Value) -> Value:
        """The value this type holds instead: REAL rounded to 32 bits (infinite beyond its range)."""
        return round_real(float(value)) if self.code == "f" else value

    def filled(self, pattern: int) -> Value:
        """The value when every byte is `pattern`."""
        return self.decode(bytes([pattern]) * self.codec.size)


def _row_of(name: str) -> Elementary:
    return ELEMENTARY[name]


def round_real(value: float) -> float:
    """The 32-bit float nearest to value, infinite when beyond the range."""
    return array("f", [value])[0]


BOOL = Elementary("BOOL", 1, "B", Family.BIT)
BYTE = Elementary("BYTE", 8, "B", Family.BITS)
WORD = Elementary("WORD", 16, "H", Family.BITS)
DWORD = Elementary("DWORD", 32, "I", Family.BITS)
LWORD = Elementary("LWORD", 64, "Q", Family.BITS)
CHAR = Elementary("CHAR", 8, "B", Family.CHARACTER, ord(" "))
SINT = Elementary("SINT", 8, "b", Family.INTEGER)
INT = Elementary("INT", 16, "h", Family.INTEGER)
DINT = Elementary("DINT", 32, "i", Family.INTEGER)
LINT = Elementary("LINT", 64, "q", Family.INTEGER)
USINT = Elementary("USINT", 8, "B", Family.UNSIGNED)
UINT = Elementary("UINT", 16, "H", Family.UNSIGNED)
UDINT = Elementary("UDINT", 32, "I", Family.UNSIGNED)
ULINT = Elementary("ULINT", 64, "Q", Family.UNSIGNED)
REAL = Elementary("REAL", 32, "f", Family.FLOAT, 0.0)
LREAL = Elementary("LREAL", 64, "d", Family.FLOAT, 0.0)
TIME = Elementary("TIME", 32, "i", Family.TIME)
DATE = Elementary("DATE", 16, "H", Family.TIME)
TIME_OF_DAY = Elementary("TIME_OF_DAY", 32, "I", Family.TIME)
S5TIME = Elementary("S5TIME", 16, "H", Family.TIME)
DATE_AND_TIME = Elementary("DATE_AND_TIME", 64, "Q", Family.TIME, 0x9001_0100_0000_0002)

BIT_STRINGS = (BYTE, WORD, DWORD, LWORD)
INTEGERS = (SINT, USINT, INT, UINT, DINT, UDINT, LINT, ULINT)
FLOATS = (REAL, LREAL)
TIMES = (TIME, DATE, TIME_OF_DAY, S5TIME, DATE_AND_TIME)
ELEMENTARY = {row.name: row for row in (BOOL, *BIT_STRINGS, CHAR, *INTEGERS, *FLOATS, *TIMES)}
ALIASES = {"TOD": TIME_OF_DAY, "DT": DATE_AND_TIME}


def elementary(name: str) -> Elementary | None:
    """The elementary type of this name in any case, or None."""
    return ELEMENTARY.get(name.upper()) or ALIASES.get(name.upper())


@dataclass(frozen=True)
class String:
    """STRING[length]: a byte with the length, a byte with the used length, then the characters."""

    length: int = 254
    alignment = WORD_BITS
    nesting = 0

    def __str__(self) -> str:
        return f"STRING[{self.length}]"

    @property
    def bits(self) -> int:
        return align((self.length + 2) * BYTE_BITS, WORD_BITS)

    @property
    def initial(self) -> bytes:
        return self.encode("")

    def encode(self, text: str) -> bytes:
        """Cut to the length. Raises ValueError for characters of more than 8 bits."""
        characters = text.encode("latin-1")[: self.length]
        return (bytes([self.length, len(characters)]) + characters).ljust(self.bits // BYTE_BITS, b"\0")

    @staticmethod
    def decode(data: bytes) -> str:
        return data[2 : 2 + data[1]].decode("latin-1")


@dataclass(frozen=True)
class Array:
    """ARRAY with one (low, high) pair for each dimension; the last index runs fastest."""

    bounds: tuple[tuple[int, int], ...]
    element: Type
    alignment = WORD_BITS

    def __str__(self) -> str:
        return f"ARRAY[{', '.join(f'{low}..{high}' for low, high in self.bounds)}] OF {self.element}"

    @property
    def count(self) -> int:
        return prod(high - low + 1 for low, high in self.bounds)

    @property
    def nesting(self) -> int:
        """How many types lie within each other here."""
        return 1 + self.element.nesting

    @property
    def stride(self) -> int:
        """Bits from one element to the next."""
        return align(self.element.bits, self.element.alignment)

    @property
    def strides(self) -> tuple[int, ...]:
        """Bits from one index to the next, for each dimension."""
        sizes = [high - low + 1 for low, high in self.bounds]
        return tuple(self.stride * prod(sizes[axis + 1 :]) for axis in range(len(sizes)))

    @property
    def bits(self) -> int:
        return align(self.count * self.stride, WORD_BITS)

    @cached_property
    def initial(self) -> bytes:
        if self.element.alignment < BYTE_BITS:
            return bytes(self.bits // BYTE_BITS)
        return (self.element.initial * self.count).ljust(self.bits // BYTE_BITS, b"\0")

    def offset(self, indices: tuple[int, ...]) -> int:
        """Bits from the start to one element."""
        pairs = zip(indices, self.bounds, self.strides, strict=True)
        return sum((index - low) * stride for index, (low, _), stride in pairs)

    def offsets(self) -> Iterator[int]:
        """Bits from the start to each element, in the order of an initial value list."""
        return map(self.offset, product(*(range(low, high + 1) for low, high in self.bounds)))


@dataclass(frozen=True)
class Field:
    """One member of a structure, `bit` bits behind its start."""

    name: str
    type: Type
    bit: int


@dataclass(frozen=True)
class Structure:
    """A STRUCT, a UDT, or the instance data of an FB.

    `initial` is its memory before the first scan; another makes no other type.
    """

    name: str
    fields: tuple[Field, ...]
    bits: int
    initial: bytes = field(repr=False, compare=False)
    alignment = WORD_BITS

    def __str__(self) -> str:
        return self.name or "STRUCT"

    @cached_property
    def nesting(self) -> int:
        """How many types lie within each other here."""
        return 1 + max((member.type.nesting for member in self.fields), default=0)

    @cached_property
    def _by_name(self) -> dict[str, Field]:
        return {member.name.casefold(): member for member in self.fields}

    def member(self, name: str) -> Field | None:
        """The member of this name in any case."""
        return self._by_name.get(name.casefold())


Type = Elementary | String | Array | Structure


def align(bits: int, alignment: int) -> int:
    """The next multiple of alignment."""
    return -(-bits // alignment) * alignment
