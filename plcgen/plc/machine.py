"""A machine: memory, the linked functions of a program, and the faults of a run."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from plcgen.errors import Fault, Location, PlcgenError
from plcgen.plc import engines
from plcgen.plc.addresses import AREA_BYTES, parse_address
from plcgen.plc.core import GLOBAL_AREAS, Area, Cell, DataBlock, Function, Program
from plcgen.plc.engine import Bytes, Site
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import (
    BOOL,
    BYTE_BITS,
    CHAR,
    Array,
    Elementary,
    String,
    Structure,
    Type,
)

BUDGET = 1_000_000
"""Backward jumps and calls in one scan before the watchdog stops it."""

PythonValue = bool | int | float | str


@dataclass(frozen=True)
class FaultRecord:
    """An arithmetic event: a real CPU notes it in its status word and goes on."""

    kind: str
    block: str
    location: Location
    scan: int

    def __str__(self) -> str:
        return f"{self.location}: {self.kind} in {self.block} at scan {self.scan}"


@dataclass(frozen=True)
class Variable:
    """A variable of a machine; `get` and `set` are quick enough to be called every scan."""

    path: str
    type: Elementary | String
    get: Callable[[], Any]
    set: Callable[[Any], None]


class _Link(NamedTuple):
    """What a call needs, found once."""

    function: Function
    run: Callable[..., Any]


class Machine:
    """Fresh memory and a program linked to it. `temp_fill` is the byte that fills temporaries at each call.

    `function_error` is the relative error of SIN, EXP, LN and the like. `areas` are the global areas of memory, with
    their bytes.
    """

    areas: ClassVar[Mapping[Area | str, int]] = dict.fromkeys(GLOBAL_AREAS, AREA_BYTES)

    def __init__(self, program: Program, temp_fill: int = 0, budget: int = BUDGET, function_error: float = 0.0) -> None:
        self.program = program
        self.scan = 0
        self.faults: list[FaultRecord] = []
        self.memory: dict[Area | str, Bytes] = self.global_memory()
        self.memory |= {name: bytearray(block.initial) for name, block in program.data_blocks.items()}
        self._blocks: dict[str, DataBlock] = dict(program.data_blocks)
        self._budget = budget
        self._fill = temp_fill
        self._links: dict[tuple[str, str | None], _Link] = {}
        self.engine, self.memory = engines.start(
            program, self.memory, self._note, temp_fill, function_error, self.services()
        )
        self.engine.budget[0] = budget

    def global_memory(self) -> dict[Area | str, Bytes]:
        """Fresh memory outside data blocks."""
        return {area: bytearray(size) for area, size in self.areas.items()}

    def services(self) -> Mapping[str, Callable[..., Any]]:
        """What the CPU does besides computing, by the names that operator texts use."""
        return {}

    def _note(self, kind: str, site: Site) -> None:
        self.record(kind, site.function.name, site.location)

    def record(self, kind: str, block: str, location: Location) -> None:
        """Append to `faults`."""
        self.faults.append(FaultRecord(kind, block, location, self.scan))

    # ------------------------------------------------------------------------------------------------- running

    def call(
        self, name: str, instance: str | None = None, arguments: Sequence[Any] = (), frame: bytes | None = None
    ) -> Any:
        """Run a block once. An FB needs an instance DB (made when missing); an OB may be given the head of its frame.

        Returns what an FC hands back. Raises Fault where a CPU would stop.
        """
        link = self._links.get((name, instance)) or self._link(name, instance)
        self.engine.budget[0] = self._budget
        try:
            return link.run(*self._frame(link.function, frame), *arguments)
        except RecursionError:
            message = f"{name}: blocks call each other too deep (scan {self.scan}); is there a call without end?"
            raise Fault(message, link.function.source.location(link.function.span)) from None
        except Fault as fault:
            raise self._at_scan(fault) from None

    def call_loop(self, name: str, instance: str) -> engines.CallLoop | None:
        """Calls of an FB, where the engine has a quick way: see `fast.call_loop`. The instance is recorded."""
        memory = self.memory[instance]
        return self.engine.call_loop(name, memory, memory)

    def closed_loop(self, name: str, instance: str, variables: Sequence[str]) -> engines.ClosedLoop | None:
        """Scans of an FB with an ideal drive, where the engine has a quick way: see `fast.closed_loop`.

        `variables` of the block are travel, velocity and setpoint, REAL, and phase, INT.
        """
        structure = self.program.functions[name].instance
        members = [structure.member(variable) for variable in variables] if structure else []
        bytes_of = [member.bit // BYTE_BITS for member in members if member is not None]
        if [str(member.type) for member in members if member] != ["REAL", "REAL", "REAL", "INT"]:
            return None
        return self.engine.closed_loop(name, self.memory[instance], bytes_of)

    def settle(self, loop: engines.Loop) -> None:
        """End the last scan of a loop. Raises Fault where a CPU would stop."""
        try:
            loop.settle()
        except Fault as fault:
            raise self._at_scan(fault) from None

    def _at_scan(self, fault: Fault) -> Fault:
        return Fault(f"{fault.message} (scan {self.scan})", fault.location)

    def _link(self, name: str, instance: str | None) -> _Link:
        block = self._known(self.program.functions, name, "block")
        function = self.program.functions[block]
        data = None if function.instance is None else self._instance(block, instance)
        link = self._links[name, instance] = _Link(function, self.engine.bound(block, data))
        return link

    def _frame(self, function: Function, head: bytes | None) -> tuple[bytearray, ...]:
        if not function.frame_given:
            return ()
        size = max(function.frame_bytes, len(head or b""))
        return (bytearray((head or b"").ljust(size, bytes([self._fill]))),)

    def _instance(self, name: str, instance: str | None) -> Bytes:
        structure = self.program.functions[name].instance
        assert structure is not None
        if instance is None:
            raise Fault(f"{name} is an FB; name its instance data block")
        key = self._resolve(instance)
        if key not in self._blocks:
            self._blocks[key] = DataBlock(key, structure, structure.initial, name)
            self.memory[key] = self.engine.adopt(structure.initial)
        if self._blocks[key].type != structure:
            raise Fault(f"{key} is no instance of {name} but of {self._blocks[key].type}")
        return self.memory[key]

    # ----------------------------------------------------------------------------------------------- variables

    def variable(self, path: str) -> Variable:
        """The variable at `DB100.member[3].x`, `"Drive".speed`, `M0.0` or `MW10`."""
        cell = self._address(path) or self._member(path)
        if not isinstance(cell.type, Elementary | String):
            raise PlcgenError(f"{path} is a {cell.type}; name one of its members")
        memory = self.memory[cell.area]
        return Variable(path, cell.type, *accessors(path, memory, cell.bit, cell.type))

    def _address(self, path: str) -> Cell | None:
        try:
            return parse_address(path)
        except ValueError as error:
            raise PlcgenError(f"{path}: {error}") from None

    def _member(self, path: str) -> Cell:
        steps = re.findall(r'"([^"]+)"|([^.\[\]",\s]+)|\[([^\]]*)\]', path)
        first = next(iter(steps), ("", "", ""))
        area = self._known(self._blocks, first[0] or first[1], "data block")
        cell = Cell(area, 0, self._blocks[area].type)
        for quoted, plain, indices in steps[1:]:
            cell = _element(path, cell, indices) if indices else _field(path, cell, quoted or plain)
        return cell

    def _resolve(self, name: str) -> str:
        """The absolute name of a block, spelt as it was declared."""
        plain = name.strip('"')
        absolute = self.program.symbols.get(plain.casefold(), plain)
        known = {block.casefold(): block for block in (*self.program.functions, *self._blocks)}
        return known.get(absolute.casefold(), absolute)

    def _known(self, table: Mapping[str, object], name: str, what: str) -> str:
        key = self._resolve(name)
        if key not in table:
            raise Fault(f"no {what} {name}{did_you_mean(key, table)}")
        return key


def _field(path: str, cell: Cell, name: str) -> Cell:
    member = cell.type.member(name) if isinstance(cell.type, Structure) else None
    if member is None:
        names = [field.name for field in cell.type.fields] if isinstance(cell.type, Structure) else []
        raise PlcgenError(f"{path}: {cell.type} has no member {name}{did_you_mean(name, names)}")
    return Cell(cell.area, cell.bit + member.bit, member.type)


def _element(path: str, cell: Cell, text: str) -> Cell:
    if not isinstance(cell.type, Array):
        raise PlcgenError(f"{path}: {cell.type} takes no index")
    bounds = cell.type.bounds
    indices = tuple(int(part) for part in text.split(",")) if re.fullmatch(r"[-\d,\s]+", text) else ()
    inside = len(indices) == len(bounds) and all(
        low <= index <= high for index, (low, high) in zip(indices, bounds, strict=True)
    )
    if not inside:
        raise PlcgenError(f"{path}: [{text}] is outside {cell.type}")
    return Cell(cell.area, cell.bit + cell.type.offset(indices), cell.type.element)


# ------------------------------------------------------------------------------------------------------ accessors

_Accessors = tuple[Callable[[], Any], Callable[[Any], None]]


def accessors(path: str, memory: Bytes, bit: int, kind: Type) -> _Accessors:
    start = bit // BYTE_BITS
    if isinstance(kind, String):
        return _string_accessors(path, memory, start, kind)
    assert isinstance(kind, Elementary)
    if kind is BOOL:
        return _bit_accessors(memory, start, 1 << bit % BYTE_BITS)
    if kind is CHAR:
        return _character_accessors(path, memory, start)
    return _number_accessors(path, memory, start, kind)


def _bit_accessors(memory: Bytes, start: int, mask: int) -> _Accessors:
    def put(value: object) -> None:
        memory[start] = memory[start] | mask if value else memory[start] & ~mask

    return lambda: memory[start] & mask != 0, put


def _character_accessors(path: str, memory: Bytes, start: int) -> _Accessors:
    def put(character: str) -> None:
        try:
            memory[start] = ord(character)
        except (TypeError, ValueError):
            raise PlcgenError(f"{path}: {character!r} is no CHAR") from None

    return lambda: chr(memory[start]), put


def _string_accessors(path: str, memory: Bytes, start: int, kind: String) -> _Accessors:
    end = start + kind.bits // BYTE_BITS

    def put(text: str) -> None:
        try:
            memory[start:end] = kind.encode(text)
        except ValueError:
            raise PlcgenError(f"{path}: {text!r} has a character that does not fit 8 bits") from None

    return lambda: kind.decode(bytes(memory[start:end])), put


def _number_accessors(path: str, memory: Bytes, start: int, kind: Elementary) -> _Accessors:
    load, store, nearest = kind.codec.unpack_from, kind.codec.pack_into, kind.nearest

    def put(value: int | float) -> None:
        try:
            store(memory, start, nearest(value))
        except (struct.error, TypeError, ValueError):
            raise PlcgenError(f"{path}: {value!r} is no {kind}") from None

    return lambda: load(memory, start)[0], put
