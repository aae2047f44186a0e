"""The engine that is always there: each core function becomes one Python function.

Registers are Python locals, memory is bytearrays, and operators are inlined by their text. Control flow is blocks in
source order, each under `if pc <= n`: a forward jump raises pc and falls through what lies between, a backward jump
sets pc and starts the pass again, at the cost of one unit of the watchdog's budget.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from itertools import accumulate
from types import CodeType, MappingProxyType
from typing import Any, NamedTuple, NoReturn

from plcgen.errors import Fault, Location
from plcgen.plc.arithmetic import library
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
from plcgen.plc.source import Span
from plcgen.plc.types import BOOL, BYTE_BITS, ELEMENTARY, Elementary

INDENT = "    "

Bytes = bytearray | memoryview
"""Memory of an area: its own, or a part of a larger piece."""
NO_SERVICES: Mapping[str, Callable[..., Any]] = MappingProxyType({})


class Site(NamedTuple):
    """An instruction that may meet a fault."""

    function: Function
    span: Span

    @property
    def location(self) -> Location:
        return self.function.source.location(self.span)


COUNTERS = 64
"""Of what programs are counted by, see `Engine.take_counts`."""


class Engine:
    """Functions of a program over the given memory. `note(kind, site)` is told of arithmetic events.

    See `arithmetic.library` for `function_error`. `services` are further names for operator texts: what a CPU does
    besides computing.
    """

    def __init__(
        self,
        program: Program,
        memory: Mapping[Area | str, Bytes],
        note: Callable[[str, Site], None],
        temp_fill: int = 0,
        function_error: float = 0.0,
        services: Mapping[str, Callable[..., Any]] = NO_SERVICES,
    ) -> None:
        self.budget = [0]
        self._counts = [0] * COUNTERS
        self._note = note
        self._sites: list[Site] = []
        self._sources: dict[str, str] = {}
        self._functions: dict[str, Callable[..., Any]] = {}
        names = _Names()
        areas = {area: names.of(str(area)) for area in memory}
        functions = {name: names.of(name) for name in program.functions}
        namespace = self._namespace(memory, areas, function_error) | dict(services)
        for name, function in program.functions.items():
            translator = _Translator(function, functions, areas, self._sites, temp_fill)
            self._sources[name] = text = translator.text()
            exec(_compiled(text, name), namespace)
            self._functions[name] = namespace[functions[name]]

    def _namespace(
        self, memory: Mapping[Area | str, Bytes], areas: Mapping[Area | str, str], function_error: float
    ) -> dict[str, Any]:
        namespace = library(lambda kind, site: self._note(kind, self._sites[site]), self._out_of_bounds, function_error)
        namespace.update(load_bit=_load_bit, store_bit=_store_bit, budget=self.budget, exhausted=self._exhausted)
        namespace["stop"], namespace["count"] = self._stop, self._count
        for row in ELEMENTARY.values():
            namespace.update({f"load_{row}": row.codec.unpack_from, f"store_{row}": row.codec.pack_into})
        namespace.update({areas[area]: data for area, data in memory.items()})
        return namespace

    def function(self, name: str) -> Callable[..., Any]:
        """The Python function of a block: (instance bytes, base byte) for an FB, (frame) for an OB, then arguments."""
        return self._functions[name]

    def bound(self, name: str, instance: Bytes | None) -> Callable[..., Any]:
        """The function of a block on its instance: (frame) for an OB, then arguments."""
        function = self._functions[name]
        return function if instance is None else partial(function, instance, 0)

    def adopt(self, data: bytes) -> Bytes:
        """Memory for another instance."""
        return bytearray(data)

    def take_counts(self) -> list[int]:
        """How often operators said `count(number)` since the last time."""
        taken, self._counts[:] = list(self._counts), [0] * COUNTERS
        return taken

    def _count(self, number: int) -> bool:
        self._counts[number % COUNTERS] += 1
        return False

    def call_loop(self, *_ignored: object) -> None:
        """Here Python is in between anyway."""

    def closed_loop(self, _name: str, _instance: Bytes, _places: Sequence[int]) -> None:
        """Here Python is in between anyway."""

    def event_loop(self, *_ignored: object) -> None:
        """Here Python is in between anyway."""

    def source_of(self, name: str) -> str:
        """The Python text of a block."""
        return self._sources[name]

    def _out_of_bounds(self, index: int, low: int, high: int, site: int) -> NoReturn:
        self._stop(f"array index {index} outside {low} .. {high}", site)

    def _exhausted(self, site: int) -> NoReturn:
        self._stop("watchdog: too many loops and calls in one scan; is there a loop without end?", site)

    def _stop(self, message: str, site: int) -> NoReturn:
        place = self._sites[site]
        raise Fault(f"{place.function.name}: {message}", place.location)


@lru_cache(maxsize=256)
def _compiled(text: str, name: str) -> CodeType:
    """Machines of one program share what is compiled."""
    return compile(text, f"<{name}>", "exec")


class _Names:
    """A Python identifier for each name of the program."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def of(self, name: str) -> str:
        stem = "b_" + re.sub(r"[^0-9A-Za-z_]", "_", name)
        while stem in self._taken:
            stem += "_"
        self._taken.add(stem)
        return stem


def _load_bit(memory: bytearray, bit: int) -> bool:
    return memory[bit >> 3] >> (bit & 7) & 1 == 1


def _store_bit(memory: bytearray, bit: int, value: bool) -> None:
    mask = 1 << (bit & 7)
    memory[bit >> 3] = memory[bit >> 3] & ~mask | (mask if value else 0)


# ------------------------------------------------------------------------------------------------ control flow


@dataclass(frozen=True)
class _Flow:
    """Numbers of the blocks that a body falls into."""

    first: Mapping[int, int]
    labels: Mapping[str, int]
    guarded: frozenset[int]
    loops: bool

    @staticmethod
    def of(body: Sequence[Instruction]) -> _Flow:
        used = {instruction.label for instruction in body if isinstance(instruction, Jump | Branch)}
        starts = [p for p in range(1, len(body)) if _starts_block(body, p, used)]
        first = {position: number for number, position in enumerate([0, *starts])}
        block_of = _fill(first, len(body))
        labels = {i.name: block_of[p] for p, i in enumerate(body) if isinstance(i, Label)}
        jumps = [(block_of[p], labels[i.label]) for p, i in enumerate(body) if isinstance(i, Jump | Branch)]
        skipped = [range(source + 1 if source < target else 0, target) for source, target in jumps]
        return _Flow(first, labels, _covered(skipped), any(target <= source for source, target in jumps))


def _covered(ranges: Sequence[range]) -> frozenset[int]:
    """Every number in one of the ranges."""
    edges = Counter(run.start for run in ranges)
    edges.subtract(run.stop for run in ranges)
    depths = accumulate(edges[number] for number in range(max(edges, default=0) + 1))
    return frozenset(number for number, depth in enumerate(depths) if depth)


def _starts_block(body: Sequence[Instruction], position: int, used: set[str]) -> bool:
    here = body[position]
    return isinstance(body[position - 1], Jump | Branch) or (isinstance(here, Label) and here.name in used)


def _fill(first: Mapping[int, int], length: int) -> list[int]:
    """The block number of each position."""
    numbers: list[int] = []
    for position in range(length):
        numbers.append(first[position] if position in first else numbers[-1])
    return numbers


# -------------------------------------------------------------------------------------------------- translation


@dataclass
class _Translator:
    """Writes the Python text of one function."""

    function: Function
    functions: Mapping[str, str]
    areas: Mapping[Area | str, str]
    sites: list[Site]
    temp_fill: int
    block: int = 0
    flow: _Flow = field(init=False)

    def __post_init__(self) -> None:
        self.flow = _Flow.of(self.function.body)

    def text(self) -> str:
        lines = [*self._entry(), *self._body()]
        head = f"def {self.functions[self.function.name]}({', '.join(self._parameters())}):"
        return "\n".join([head, *(INDENT + line for line in lines)]) + "\n"

    def _parameters(self) -> Iterator[str]:
        if self.function.instance is not None:
            yield from (str(INSTANCE), "B")
        if self.function.frame_given:
            yield str(FRAME)
        yield from (_parameter(position, place) for position, place in enumerate(self.function.parameters))

    def _entry(self) -> Iterator[str]:
        fill = self.temp_fill
        if self.function.frame_bytes and not self.function.frame_given:
            yield f"{FRAME} = bytearray({bytes([fill]) * self.function.frame_bytes!r})"
        for register in self.function.temporaries:
            yield f"{_local(register)} = {register.type.filled(fill)!r}"
        for position, place in enumerate(self.function.parameters):
            if isinstance(place, Cell):
                yield from self._store(place, _parameter(position, place))

    # blocks

    def _body(self) -> Iterator[str]:
        margin = INDENT if self.flow.loops else ""
        if self.flow.labels:
            yield "pc = 0"
        if self.flow.loops:
            yield "while True:"
        for block, lines in self._blocks():
            guard = block in self.flow.guarded and bool(lines)
            if guard:
                yield f"{margin}if pc <= {block}:"
            yield from (margin + (INDENT if guard else "") + line for line in lines)

    def _blocks(self) -> Iterator[tuple[int, list[str]]]:
        lines: list[str] = []
        for position, instruction in enumerate(self.function.body):
            if self.flow.first.get(position, 0) > self.block:
                yield self.block, lines
                self.block, lines = self.flow.first[position], []
            lines.extend(self._instruction(instruction))
        yield self.block, lines

    def _instruction(self, instruction: Instruction) -> Iterable[str]:
        match instruction:
            case Compute():
                return self._compute(instruction)
            case Jump():
                return self._jump(instruction.label, instruction.span)
            case Branch():
                return self._branch(instruction)
            case Call():
                return self._call(instruction)
            case Return():
                return [f"return {', '.join(self._load(place) for place in self.function.results)}".rstrip()]
        return ()

    def _jump(self, label: str, span: Span) -> list[str]:
        target = self.flow.labels[label]
        if target > self.block:
            return [f"pc = {target}"]
        return [*self._spend(span), f"pc = {target}", "continue"]

    def _branch(self, branch: Branch) -> Iterator[str]:
        yield f"if {'' if branch.when else 'not '}{self._load(branch.condition)}:"
        yield from (INDENT + line for line in self._jump(branch.label, branch.span))

    def _spend(self, span: Span) -> list[str]:
        return ["budget[0] -= 1", f"if budget[0] < 0: exhausted({self._site(span)})"]

    # instructions

    def _compute(self, instruction: Compute) -> Iterator[str]:
        operator, target = instruction.operator, instruction.target
        operands = []
        for position, operand in enumerate(instruction.operands):
            text = self._load(operand)
            if isinstance(operand, Cell) and operator.text.count(f"{{{position}}}") > 1:
                yield f"a{position} = {text}"
                text = f"a{position}"
            operands.append(text)
        site = self._site(instruction.span) if "{site}" in operator.text + operator.repair else 0
        plain = not operator.rounds and not operator.check
        if isinstance(target, Cell) and plain and target.type is not BOOL:
            yield from self._store(target, operator.text.format(*operands, site=site))
            return
        result = _local(target) if isinstance(target, Register) else "t"
        yield from operator.python(result, operands, site)
        if isinstance(target, Cell):
            yield from self._store(target, result)

    def _call(self, call: Call) -> Iterator[str]:
        yield from self._spend(call.span)
        arguments = [*self._instance(call.instance), *map(self._load, call.arguments)]
        results = [f"t{position}" for position in range(len(call.results))]
        received = f"{', '.join(results)} = " if results else ""
        yield f"{received}{self.functions[call.function]}({', '.join(arguments)})"
        for place, result in zip(call.results, results, strict=True):
            yield from self._store(place, result)

    def _instance(self, instance: Cell | None) -> tuple[str, ...]:
        return (self._area(instance), self._byte(instance)) if instance else ()

    def _site(self, span: Span) -> int:
        self.sites.append(Site(self.function, span))
        return len(self.sites) - 1

    # places

    def _load(self, operand: Operand) -> str:
        if isinstance(operand, Literal):
            return repr(operand.value)
        if isinstance(operand, Register):
            return _local(operand)
        memory, kind = self._area(operand), operand.type
        if kind is BOOL:
            return self._load_bit(memory, operand)
        start = self._byte(operand)
        if not isinstance(kind, Elementary):
            return f"{memory}[{start}:{start} + {kind.bits // BYTE_BITS}]"
        return f"{memory}[{start}]" if kind.code == "B" else f"load_{kind}({memory}, {start})[0]"

    def _load_bit(self, memory: str, cell: Cell) -> str:
        if cell.index is not None:
            return f"load_bit({memory}, {self._bit(cell)})"
        return f"({memory}[{self._byte(cell)}] & {1 << cell.bit % BYTE_BITS} != 0)"

    def _store(self, place: Place, value: str) -> list[str]:
        if isinstance(place, Register):
            return [f"{_local(place)} = {value}"]
        memory, kind = self._area(place), place.type
        if kind is BOOL:
            return self._store_bit(memory, place, value)
        start = self._byte(place)
        if not isinstance(kind, Elementary):
            return [f"{memory}[{start}:{start} + {kind.bits // BYTE_BITS}] = {value}"]
        if kind.code == "B":
            return [f"{memory}[{start}] = {value}"]
        return [f"store_{kind}({memory}, {start}, {value})"]

    def _store_bit(self, memory: str, cell: Cell, value: str) -> list[str]:
        if cell.index is not None:
            return [f"store_bit({memory}, {self._bit(cell)}, {value})"]
        start, mask = self._byte(cell), 1 << cell.bit % BYTE_BITS
        return [f"if {value}: {memory}[{start}] |= {mask}", f"else: {memory}[{start}] &= {255 - mask}"]

    def _area(self, cell: Cell) -> str:
        return str(cell.area) if cell.area in (INSTANCE, FRAME) else self.areas[cell.area]

    def _byte(self, cell: Cell) -> str:
        terms = ["B"] if cell.area == INSTANCE else []
        terms.append(str(cell.bit // BYTE_BITS))
        if cell.index is not None:
            terms.append(f"({_local(cell.index)} >> 3)")
        return " + ".join(terms)

    def _bit(self, cell: Cell) -> str:
        assert cell.index is not None
        base = "B * 8 + " if cell.area == INSTANCE else ""
        return f"{base}{cell.bit} + {_local(cell.index)}"


def _local(register: Register) -> str:
    return f"r{register.number}"


def _parameter(position: int, place: Place) -> str:
    return _local(place) if isinstance(place, Register) else f"p{position}"
