"""The engine that runs core code compiled: the same results, events and faults as the plain one, bit for bit."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from types import CodeType
from typing import Any, NoReturn

import numpy as np

from plcgen.errors import Fault
from plcgen.plc.arithmetic import library
from plcgen.plc.core import Area, Function, Program
from plcgen.plc.engine import COUNTERS, NO_SERVICES, Site
from plcgen.plc.fast import vm
from plcgen.plc.fast.bodies import KINDS
from plcgen.plc.fast.encode import FACTOR, FILLED, SITE, WIDTH, Code, Entry, Request, Target, UnsuitableError, encoded
from plcgen.plc.fast.helpers import FIRST
from plcgen.plc.fast.native import Compiler
from plcgen.plc.fast.vm import NATIVE, QUIET, START, enter
from plcgen.plc.operators import Operator
from plcgen.plc.source import Span
from plcgen.plc.types import BOOL, BYTE_BITS, Elementary, Type, Value


@dataclass(frozen=True)
class _Image:
    """What machines of one program share."""

    program: Program
    code: Code
    rows: np.ndarray
    slots: np.ndarray
    sites: list[Site]
    compiler: Compiler
    _filled: dict[int, np.ndarray] = field(default_factory=dict)

    def slots_with(self, temp_fill: int) -> np.ndarray:
        """Slots before the first call, with the byte that fills temporaries."""
        if temp_fill not in self._filled:
            self._filled[temp_fill] = self.slots.copy()
            values = {slot: kind.filled(temp_fill) for slot, kind in self.code.temporaries.items()}
            _put(self._filled[temp_fill], {FILLED: temp_fill, **values})
        return self._filled[temp_fill]


def _put(slots: np.ndarray, values: Mapping[int, Value]) -> None:
    for slot, value in values.items():
        (slots.view(np.float64) if isinstance(value, float) else slots)[slot] = value


_IMAGES: dict[tuple[int, int], _Image] = {}
MOST_IMAGES = 16


def _image(program: Program, areas: Mapping[Area | str, int], first_byte: int) -> _Image:
    """Machines of a program have their areas in the same places, since they have the same ones."""
    key = id(program), first_byte
    found = _IMAGES.get(key)
    if found is None or found.program is not program:
        while len(_IMAGES) >= MOST_IMAGES:
            del _IMAGES[next(iter(_IMAGES))]
        found = _IMAGES[key] = _drawn(program, areas, first_byte)
    return found


def _drawn(program: Program, areas: Mapping[Area | str, int], first_byte: int) -> _Image:
    sites: list[Site] = []

    def site(function: Function, span: Span) -> int:
        sites.append(Site(function, span))
        return len(sites) - 1

    code = encoded(program, first_byte, Target(areas, site, vm.BODIES))
    slots = np.zeros(code.slots, np.int64)
    _put(slots, code.constants)
    rows = np.array(code.rows or [[0] * WIDTH], dtype=np.int64)
    return _Image(program, code, rows, slots, sites, Compiler(code, rows))


@lru_cache(maxsize=1024)
def _python(text: str) -> CodeType:
    """Compiled once for all machines."""
    return compile(text, "<operator>", "exec")


def _furnished(slots: np.ndarray) -> np.ndarray:
    """A room with these slots. The stack and the list of events, a megabyte, are written before they are read."""
    room = np.empty(vm.SLOTS + len(slots), np.int64)
    room[: vm.STACK] = 0
    room[vm.EVENTS : vm.EVENTS + FIRST] = 0
    room[vm.SLOTS :] = slots
    return room


class FastEngine:
    """See `engine.Engine`. `flat` holds all areas, each from the byte that `areas` says on, and room behind them.

    Raises UnsuitableError for programs that it cannot run.
    """

    def __init__(
        self,
        program: Program,
        flat: np.ndarray,
        areas: Mapping[Area | str, int],
        first_byte: int,
        note: Callable[[str, Site], None],
        temp_fill: int = 0,
        function_error: float = 0.0,
        services: Mapping[str, Callable[..., Any]] = NO_SERVICES,
    ) -> None:
        self.budget = [0]
        self._note, self._program = note, program
        image = _image(program, areas, first_byte)
        if image.code.first_byte > len(flat):
            raise UnsuitableError
        self._sites, self._code, self._memory = image.sites, image.rows, flat
        self._compiler = image.compiler
        self._entries, self._requests, self.end = image.code.entries, image.code.requests, image.code.first_byte
        for start, data in image.code.data.items():
            flat[start : start + len(data)] = np.frombuffer(data, np.uint8)
        self._room = _furnished(image.slots_with(temp_fill))
        self._integers = self._room[vm.SLOTS :]
        self._floats = self._integers.view(np.float64)
        self._floats[FACTOR] = 1.0 + function_error
        self._events, self._state = self._room[vm.EVENTS : vm.SLOTS], self._room[: vm.COUNTS]
        self._counts = self._room[vm.COUNTS : vm.COUNTS + COUNTERS]
        self.parts = self._code, self._room, self._memory
        self._names = library(lambda kind, site: note(kind, self._sites[site]), self._out_of_bounds, function_error) | {
            "stop": self._stop,
            **services,
        }
        self._evaluators: dict[int, Callable[..., Any]] = {}
        self.have_run(0)

    def have_run(self, scans: int) -> None:
        """What runs for long gets native code; what was compiled by an earlier run has it at once."""
        native = self._compiler.after(scans) if not self._state[NATIVE] else None
        if native:
            self._state[NATIVE] = native.address

    def bound(self, name: str, base: int) -> Callable[..., Any]:
        """See `Engine.bound`; `base` is the first byte of the instance."""
        function, entry = self._program.functions[name], self._entries[name]
        start, parts, budget, go_on = entry.start, self.parts, self.budget, self.go_on

        def run() -> None:
            ended = enter(*parts, start, base, budget[0])
            if ended != QUIET:
                go_on(ended)

        if self.entry(name) is not None:
            return run

        def handed_over(*arguments: Any) -> Any:
            given = list(arguments)
            if function.frame_given:
                self._give_frame(entry, given.pop(0))
            for value, place, arrival in zip(given, entry.parameters, entry.arrivals, strict=True):
                self._write(arrival, place.type, value)
            run()
            results = tuple(self._read(s, p.type) for s, p in zip(entry.results, function.results, strict=True))
            return results[0] if len(results) == 1 else results or None

        return handed_over

    def take_counts(self) -> list[int]:
        """See `engine.Engine.take_counts`."""
        taken: list[int] = self._counts.tolist()
        self._counts.fill(0)
        return taken

    def entry(self, name: str) -> int | None:
        """Where a block begins that takes and returns nothing but its instance; None for another."""
        function, entry = self._program.functions[name], self._entries[name]
        return None if function.frame_given or entry.parameters or entry.results else entry.start

    def requests_of(self, operator: str) -> Iterator[tuple[int, int, int]]:
        """Rows in which Python evaluates an operator on one operand, and the slots of operand and result."""
        for row, request in self._requests.items():
            if request.operator.name == operator:
                yield row, request.slots[0], request.result

    def _give_frame(self, entry: Entry, frame: bytes) -> None:
        self._memory[entry.frame : entry.frame + len(frame)] = np.frombuffer(frame, np.uint8)

    def go_on(self, ended: int) -> None:
        """Do what the virtual machine `ended` for, and let it run on, until it is done."""
        state, events = self._state, self._events
        while ended != vm.DONE:
            if events[0]:
                self._tell()
            if ended == vm.EXHAUSTED:
                self._exhausted(int(self._code[state[START], SITE]))
            if ended == vm.REQUEST:
                self._serve(int(state[START]))
            state[START] += 1
            ended = vm.run(self._code, self._room, self._memory)
        if events[0]:
            self._tell()

    def _tell(self) -> None:
        events = self._events
        count = int(events[0])
        events[0] = 0
        for kind, site in events[2 : 2 + 2 * count].reshape(-1, 2).tolist():
            self._note(KINDS[kind], self._sites[site])

    def _serve(self, row: int) -> None:
        """An operator that the machine cannot evaluate: Python does, by the text that the plain engine runs."""
        request = self._requests[row]
        evaluate = self._evaluators.get(row) or self._evaluator(row, request)
        operands = [self._value(slot, place.type) for slot, place in zip(request.slots, request.operands, strict=True)]
        result = evaluate(*operands)
        self._write(request.result, request.target.type, result)

    def _evaluator(self, row: int, request: Request) -> Callable[..., Any]:
        operator: Operator = request.operator
        names = [f"o{number}" for number in range(len(request.operands))]
        body = operator.python("result", names, request.site)
        text = "\n".join([f"def evaluate({', '.join(names)}):", *(f"    {line}" for line in body), "    return result"])
        space = dict(self._names)
        exec(_python(text), space)
        found: Callable[..., Any] = space["evaluate"]
        self._evaluators[row] = found
        return found

    # ------------------------------------------------------------------------------------------------------- values

    def _value(self, slot: int, kind: Type) -> Any:
        if isinstance(kind, Elementary) and not kind.is_integral:
            return float(self._floats[slot])
        value = int(self._integers[slot])
        if kind is BOOL:
            return value != 0
        return value & (1 << 64) - 1 if kind.bits == 64 and isinstance(kind, Elementary) and not kind.minimum else value

    def _read(self, place: int, kind: Type) -> Any:
        if isinstance(kind, Elementary):
            return self._value(place, kind)
        return self._memory[place : place + kind.bits // BYTE_BITS].tobytes()

    def _write(self, place: int, kind: Type, value: Any) -> None:
        if not isinstance(kind, Elementary):
            self._memory[place : place + len(value)] = np.frombuffer(value, np.uint8)
        elif kind.is_integral:
            number = int(value or 0)
            self._integers[place] = number - (1 << 64) if number >> 63 > 0 else number
        else:
            self._floats[place] = value

    # ------------------------------------------------------------------------------------------------------- faults

    def _out_of_bounds(self, index: int, low: int, high: int, site: int) -> NoReturn:
        self._stop(f"array index {index} outside {low} .. {high}", site)

    def _exhausted(self, site: int) -> NoReturn:
        self._stop("watchdog: too many loops and calls in one scan; is there a loop without end?", site)

    def _stop(self, message: str, site: int) -> NoReturn:
        place = self._sites[site]
        raise Fault(f"{place.function.name}: {message}", place.location)
