"""From core functions to code of the virtual machine: slots, addresses, rows of numbers.

Slot 0 is zero, 1 the first byte of the running instance, 2 the byte that fills temporaries, 3 the factor of functions
that a CPU approximates. Each register, constant and parameter has a slot of its own: blocks that call themselves have
no code here.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from plcgen.plc.core import (
    FRAME,
    INSTANCE,
    Area,
    Branch,
    Call,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Program,
    Register,
    Return,
)
from plcgen.plc.fast.bodies import MOST_NUMBERS, SHIFTS, Body, body_of, kind_of
from plcgen.plc.operators import INDEX, Operator
from plcgen.plc.source import Span
from plcgen.plc.types import BOOL, BYTE_BITS, Elementary, Type

ZERO, BASE, FILLED, FACTOR, FIRST_SLOT = range(5)
BACK, GO, IF, UNLESS, CALL, RETURN, ASK, MOVE, FILL, COPY = range(10)
LOADS: Mapping[str, int] = {"B": 11, "b": 12, "H": 13, "h": 14, "I": 15, "i": 16, "f": 17, "Q": 18, "q": 18, "d": 18}
STORES: Mapping[str, int] = {"B": 20, "b": 20, "H": 21, "h": 21, "I": 22, "i": 22, "f": 23, "Q": 24, "q": 24, "d": 24}
LOAD_BIT, STORE_BIT, FIND, SPREAD = 10, 19, 25, 26
WIDTH, NUMBERS, SITE = 13, 6, 12
ROUNDED_UP = 8
"""Frames and values begin at such bytes."""


class UnsuitableError(Exception):
    """The program needs an engine that can do more."""


@dataclass(frozen=True)
class Request:
    """What Python evaluates: an operator, its operands by slot or address, its target."""

    operator: Operator
    operands: tuple[Operand, ...]
    target: Place
    site: int
    slots: tuple[int, ...]
    result: int


@dataclass(frozen=True)
class Entry:
    """Where a function begins, and where its arguments and results lie. Structures lie in memory, values in slots."""

    start: int
    parameters: tuple[Operand, ...]
    arrivals: tuple[int, ...]
    results: tuple[int, ...]
    frame: int


@dataclass
class Code:
    """Rows of a program, its constants, and the memory that frames need."""

    first_byte: int
    """Of frames, behind the areas."""
    rows: list[list[int]] = field(default_factory=list)
    constants: dict[int, int | float] = field(default_factory=dict)
    temporaries: dict[int, Elementary] = field(default_factory=dict)
    """Slots of what temporaries hold before a call: the byte that fills them, as a value of their type."""
    data: dict[int, bytes] = field(default_factory=dict)
    requests: dict[int, Request] = field(default_factory=dict)
    entries: dict[str, Entry] = field(default_factory=dict)
    bodies: dict[int, Body] = field(default_factory=dict)
    slots: int = FIRST_SLOT
    _known: dict[bytes, int] = field(default_factory=dict)

    def slot(self) -> int:
        self.slots += 1
        return self.slots - 1

    def memory(self, size: int) -> int:
        """The first of some bytes of one's own."""
        start = self.first_byte
        self.first_byte += (size + ROUNDED_UP - 1) // ROUNDED_UP * ROUNDED_UP
        return start

    def constant(self, value: int | float) -> int:
        """The slot of a number; floats are told apart by their bits."""
        key = struct.pack("d", value) if isinstance(value, float) else b"i" + str(int(value)).encode()
        if key not in self._known:
            self._known[key] = self.slot()
            self.constants[self._known[key]] = value
        return self._known[key]

    def bytes_of(self, value: bytes) -> int:
        """The address of constant bytes."""
        start = self.memory(len(value))
        self.data[start] = value
        return start

    def row(self, number: int, *fields: int, site: int = 0, numbers: Sequence[int] = ()) -> None:
        row = [number, *fields, *([0] * (NUMBERS - 1 - len(fields))), *numbers]
        self.rows.append([*row, *([0] * (SITE - len(row))), site])


@dataclass(frozen=True)
class Target:
    """What is written for: first bytes of areas, numbers of sites and of bodies."""

    areas: Mapping[Area | str, int]
    site: Callable[[Function, Span], int]
    bodies: Mapping[str, int]


def encoded(program: Program, first_byte: int, target: Target) -> Code:
    """Code of a whole program; `first_byte` is behind all areas. Raises UnsuitableError."""
    _refuse_circles(program)
    code = Code(first_byte)
    writers = [_Writer(code, function, target) for function in program.functions.values()]
    for writer in writers:
        writer.declare()
    for writer in writers:
        writer.write()
    starts = [code.entries[name].start for name in program.functions]
    for row in code.rows:
        if row[0] == CALL:
            row[1] = starts[row[1]]
    return code


def _refuse_circles(program: Program) -> None:
    calls = {
        name: {item.function for item in function.body if isinstance(item, Call)}
        for name, function in program.functions.items()
    }
    left = dict(calls)
    while left:
        leaves = [name for name, called in left.items() if not called & left.keys()]
        if not leaves:
            raise UnsuitableError
        for name in leaves:
            del left[name]


class _Writer:
    """Writes the rows of one function."""

    def __init__(self, code: Code, function: Function, target: Target) -> None:
        self.code, self.function, self.target = code, function, target
        self.registers: dict[int, int] = {}
        self.labels: dict[str, int] = {}
        self.jumps: list[tuple[int, str, Span]] = []
        self.frame = code.memory(function.frame_bytes + 64)

    def declare(self) -> None:
        """Places of arguments and results, which callers have to know."""
        function = self.function
        arrivals = tuple(self._home(place) for place in function.parameters)
        results = tuple(self._home(place, own=True) for place in function.results)
        self.code.entries[function.name] = Entry(0, function.parameters, arrivals, results, self.frame)

    def _home(self, place: Place, own: bool = False) -> int:
        """A slot, or an address for what fits none."""
        if kind_of(place.type) is None and not isinstance(place.type, Elementary):
            return self.code.memory(place.type.bits // BYTE_BITS)
        return self._register(place) if isinstance(place, Register) and not own else self.code.slot()

    def write(self) -> None:
        code, function = self.code, self.function
        entry = code.entries[function.name]
        code.entries[function.name] = Entry(len(code.rows), entry.parameters, entry.arrivals, entry.results, self.frame)
        if function.frame_bytes and not function.frame_given:
            code.row(FILL, self.frame, 0, function.frame_bytes, FILLED)
        self._fill_temporaries()
        for place, arrival in zip(function.parameters, entry.arrivals, strict=True):
            if isinstance(place, Cell):
                self._put(place, arrival)
        for instruction in function.body:
            self._instruction(instruction)
        self._join()

    def _fill_temporaries(self) -> None:
        """One row for all of them: they lie side by side, and so do their values."""
        temporaries = self.function.temporaries
        assert not any(register.number in self.registers for register in temporaries)
        slots = [self._register(register) for register in temporaries]
        for register in temporaries:
            self.code.temporaries[self.code.slot()] = register.type
        if slots:
            self.code.row(SPREAD, slots[0], slots[-1] + 1, len(slots))

    def _join(self) -> None:
        for row, label, span in self.jumps:
            target = self.labels[label]
            self.code.rows[row][1] = target
            if target > row:
                continue
            number, condition = self.code.rows[row][0], self.code.rows[row][2]
            self.code.rows[row][0] = BACK
            self.code.rows[row][SITE] = self.target.site(self.function, span)
            assert number == GO, condition

    def _register(self, register: Register) -> int:
        if register.number not in self.registers:
            self.registers[register.number] = self.code.slot()
        return self.registers[register.number]

    # ------------------------------------------------------------------------------------------------- instructions

    def _instruction(self, instruction: Instruction) -> None:
        code, span = self.code, instruction.span
        match instruction:
            case Label(name=name):
                self.labels[name] = len(code.rows)
            case Jump(label=label):
                self.jumps.append((len(code.rows), label, span))
                code.row(GO, 0)
            case Branch(condition=condition, label=label, when=when):
                self._branch(self._get(condition), label, when, span)
            case Compute():
                self._compute(instruction)
            case Call():
                self._call(instruction)
            case Return():
                for place, result in zip(self.function.results, code.entries[self.function.name].results, strict=True):
                    self._fetch(place, result)
                code.row(RETURN)

    def _branch(self, condition: int, label: str, when: bool, span: Span) -> None:
        """A branch backwards is a branch around a jump backwards, which spends a unit of the budget."""
        if label not in self.labels:
            self.jumps.append((len(self.code.rows), label, span))
            self.code.row(IF if when else UNLESS, 0, condition)
            return
        self.code.row(UNLESS if when else IF, len(self.code.rows) + 2, condition)
        self.jumps.append((len(self.code.rows), label, span))
        self.code.row(GO, 0)

    def _compute(self, item: Compute) -> None:
        operator, target = item.operator, item.target
        if operator.name == "MOVE" and not isinstance(target.type, Elementary):
            self._copy(target, item.operands[0])
            return
        site = self.target.site(self.function, item.span)
        if operator == INDEX:
            self._request_in(item, site, FIND)
            return
        found = body_of(operator) if _shifts_little(item) else None
        number = self.target.bodies.get(found[0].key) if found else None
        if operator.name == "MOVE":
            self._assign(target, self._get(item.operands[0]))
        elif found is None or number is None:
            self._request_in(item, site, ASK)
        else:
            self.code.bodies[number] = found[0]
            numbers = [self.code.constant(value) for value in found[1]]
            self._row_with_result(item, number, site, numbers, found[0].stops)

    def _row_with_result(self, item: Compute, number: int, site: int, numbers: Sequence[int], stops: bool) -> None:
        slots = tuple(self._get(operand) for operand in item.operands)
        result = self._register(item.target) if isinstance(item.target, Register) else self.code.slot()
        if stops:
            self.code.requests[len(self.code.rows)] = Request(
                item.operator, item.operands, item.target, site, slots, result
            )
        self.code.row(number, result, *slots, site=site, numbers=numbers)
        if isinstance(item.target, Cell):
            self._put(item.target, result)

    def _request_in(self, item: Compute, site: int, number: int) -> None:
        """Python may have to evaluate the operator. Values go through slots; structures are not supported."""
        kinds = [*(operand.type for operand in item.operands), item.target.type]
        if not all(isinstance(kind, Elementary) for kind in kinds) or (len(item.operands) > 4 and number != ASK):
            raise UnsuitableError
        slots = tuple(self._get(operand) for operand in item.operands)
        result = self._register(item.target) if isinstance(item.target, Register) else self.code.slot()
        self.code.requests[len(self.code.rows)] = Request(
            item.operator, item.operands, item.target, site, slots, result
        )
        self.code.row(number, result, *slots[:4], site=site)
        if isinstance(item.target, Cell):
            self._put(item.target, result)

    def _call(self, call: Call) -> None:
        code, entry = self.code, self.code.entries[call.function]
        values = [self._get(a) if isinstance(a.type, Elementary) else None for a in call.arguments]
        for argument, value, arrival in zip(call.arguments, values, entry.arrivals, strict=True):
            if value is None:
                self._copy_to(arrival, argument)
            else:
                code.row(MOVE, arrival, value)
        offset, base = 0, ZERO
        if call.instance is not None:
            offset, base, _ = self._address(call.instance)
            if call.instance.index is not None:
                raise UnsuitableError
        order = list(self.code.entries).index(call.function)
        code.row(CALL, order, base, offset, site=self.target.site(self.function, call.span))
        for place, result in zip(call.results, entry.results, strict=True):
            if isinstance(place.type, Elementary):
                self._assign(place, result)
            else:
                self._copy_from(place, result)

    # ------------------------------------------------------------------------------------------------------- places

    def _get(self, operand: Operand) -> int:
        """The slot that holds a value; a cell is loaded into a fresh one."""
        if isinstance(operand, Register):
            return self._register(operand)
        if isinstance(operand, Literal):
            assert isinstance(operand.value, int | float)
            return self.code.constant(operand.value)
        slot = self.code.slot()
        self._load(operand, slot)
        return slot

    def _load(self, cell: Cell, slot: int) -> None:
        offset, base, index = self._address(cell)
        assert isinstance(cell.type, Elementary)
        if cell.type is BOOL:
            self.code.row(LOAD_BIT, slot, offset * BYTE_BITS + cell.bit % BYTE_BITS, base, index)
        else:
            self.code.row(LOADS[cell.type.code], slot, offset, base, index)

    def _put(self, cell: Cell, slot: int) -> None:
        if not isinstance(cell.type, Elementary):
            self._copy_from(cell, slot)
            return
        offset, base, index = self._address(cell)
        if cell.type is BOOL:
            self.code.row(STORE_BIT, offset * BYTE_BITS + cell.bit % BYTE_BITS, 0, base, index, slot)
        else:
            self.code.row(STORES[cell.type.code], offset, 0, base, index, slot)

    def _assign(self, place: Place, slot: int) -> None:
        if isinstance(place, Register):
            self.code.row(MOVE, self._register(place), slot)
        else:
            self._put(place, slot)

    def _fetch(self, place: Place, result: int) -> None:
        if not isinstance(place.type, Elementary):
            self._copy_to(result, place)
        else:
            self.code.row(MOVE, result, self._get(place))

    def _address(self, cell: Cell) -> tuple[int, int, int]:
        """Byte, slot of further bytes, slot of further bits."""
        index = self._register(cell.index) if cell.index is not None else ZERO
        byte = cell.bit // BYTE_BITS
        if cell.area == INSTANCE:
            return byte, BASE, index
        if cell.area == FRAME:
            return self.frame + byte, ZERO, index
        return self.target.areas[cell.area] + byte, ZERO, index

    def _copy(self, target: Place, source: Operand) -> None:
        assert isinstance(target, Cell)
        if isinstance(source, Literal):
            assert isinstance(source.value, bytes)
            self._copy_from(target, self.code.bytes_of(source.value))
            return
        assert isinstance(source, Cell)
        there, here = self._address(target), self._address(source)
        # through bytes of one's own: both may overlap
        own = self.code.memory(target.type.bits // BYTE_BITS)
        self._rows_of_copy((own, ZERO, ZERO), here, target.type)
        self._rows_of_copy(there, (own, ZERO, ZERO), target.type)

    def _copy_to(self, address: int, source: Operand) -> None:
        if isinstance(source, Literal):
            assert isinstance(source.value, bytes)
            self._rows_of_copy((address, ZERO, ZERO), (self.code.bytes_of(source.value), ZERO, ZERO), source.type)
            return
        assert isinstance(source, Cell)
        self._rows_of_copy((address, ZERO, ZERO), self._address(source), source.type)

    def _copy_from(self, target: Place, address: int) -> None:
        assert isinstance(target, Cell)
        self._rows_of_copy(self._address(target), (address, ZERO, ZERO), target.type)

    def _rows_of_copy(self, there: tuple[int, int, int], here: tuple[int, int, int], kind: Type) -> None:
        size = kind.bits // BYTE_BITS
        self.code.row(COPY, there[0], there[1], there[2], here[0], here[1], numbers=(size, here[2]))


def _shifts_little(item: Compute) -> bool:
    """True where nothing is shifted by a number that is known at run time only."""
    if not SHIFTS.search(item.operator.text):
        return True
    count = item.operands[1]
    return isinstance(count, Literal) and isinstance(count.value, int) and 0 <= count.value < 32


assert MOST_NUMBERS == SITE - NUMBERS
