"""Memory maps of S7-200 SMART programs: rows of V memory, their addresses, and the symbols that name them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from plcgen.job import HIGHEST_V_BYTE, Job
from plcgen.render.language import words_of
from plcgen.targets import SMART

SIZES = {"REAL": 4, "DINT": 4, "WORD": 2, "BYTE": 1}
AREAS = {"REAL": "VD", "DINT": "VD", "WORD": "VW", "BYTE": "VB"}


@dataclass(frozen=True)
class Variable:
    """One row of the memory map: the name templates use, its symbol, type, and meaning."""

    name: str
    symbol: str
    type: str  # of SIZES, or a block of bytes of the program's own
    comment: str


@dataclass(frozen=True)
class Bit:
    """One bit of a byte of the memory map."""

    byte: str
    number: int
    name: str
    symbol: str
    comment: str


@dataclass(frozen=True)
class SymbolLine:
    """One row of the symbol table."""

    symbol: str
    address: str
    comment: str


@dataclass(frozen=True)
class MemoryMap:
    """Rows that follow one another from a V byte on. `blocks` are the sizes of types that are no elementary ones."""

    first_byte: int
    rows: tuple[Variable, ...]
    bits: tuple[Bit, ...]
    blocks: Mapping[str, int] = field(default_factory=dict)

    def size(self, row: Variable) -> int:
        return (SIZES | dict(self.blocks))[row.type]

    @property
    def named(self) -> tuple[Variable | Bit, ...]:
        """Everything that has a symbol."""
        return (*self.rows, *self.bits)

    @property
    def end(self) -> int:
        """The first V byte behind the map."""
        return self.first_byte + sum(map(self.size, self.rows))

    @property
    def bytes(self) -> int:
        """V memory that it takes."""
        return self.end - self.first_byte

    def addresses(self) -> dict[str, str]:
        """Address of every variable and bit by its name in the templates."""
        found: dict[str, str] = {}
        byte = self.first_byte
        for row in self.rows:
            found[row.name] = f"{AREAS.get(row.type, 'VB')}{byte}"
            byte += self.size(row)
        for bit in self.bits:
            found[bit.name] = f"V{found[bit.byte][2:]}.{bit.number}"
        return found

    def symbols(self, job: Job) -> tuple[SymbolLine, ...]:
        """Rows to paste into the symbol table. Each symbol begins with the name of the job."""
        addresses, words = self.addresses(), words_of(job.language)
        return tuple(
            SymbolLine(f"{job.name}_{row.symbol}", addresses[row.name], words(row.comment).format(u=job.length_unit))
            for row in self.named
        )

    def refuse_what_does_not_fit(self, job: Job, key: str) -> None:
        """V memory, whose first byte the job gives at `key`, and the length of symbols. Raises JobError."""
        taken = self.bytes
        if self.end > HIGHEST_V_BYTE + 1:
            raise job.error(
                key,
                f"v_memory = {self.first_byte} leaves too little: {taken} bytes are needed up to "
                f"VB{HIGHEST_V_BYTE}; write at most {HIGHEST_V_BYTE + 1 - taken}",
            )
        longest = max((row.symbol for row in self.named), key=len)
        excess = len(f"{job.name}_{longest}") - SMART.max_identifier
        if excess > 0:
            raise job.error(
                "name",
                f'name = "{job.name}" has {len(job.name)} characters; {SMART.name} takes {len(job.name) - excess}, '
                f"for the symbol {job.name}_{longest} comes of it",
            )
