"""A run of any block of a source file: inputs set once, scans counted, variables recorded."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from plcgen.errors import Fault, PlcgenError
from plcgen.names import nearest
from plcgen.plc.addresses import parse_address
from plcgen.plc.core import DataBlock, Program
from plcgen.plc.cpu.s7300 import CYCLE_PRIORITY, FIRST_CYCLE, FURTHER_CYCLE, S7300, header
from plcgen.plc.lexer import Token, TokenKind
from plcgen.plc.machine import FaultRecord, Machine, PythonValue, Variable
from plcgen.plc.scl.dialects import TIA, detect_dialect
from plcgen.plc.scl.literals import read_literal
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.lowering_declarations import CALLABLE, Catalogue, Interface, Parameter
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import Block, BlockKind, SectionKind
from plcgen.plc.source import SourceText, Span, read_source
from plcgen.plc.stl import s7_lowering, s7_parser
from plcgen.plc.stl.detection import is_s7_stl, is_smart
from plcgen.plc.stl.s7_registers import SHARED
from plcgen.plc.types import CHAR, Elementary, Family, String, Type
from plcgen.run_smart import smart_run
from plcgen.trajectory import Trajectory

INSTANCE = "plcgen\tinstance"
"""Of an FB that the file declares no instance for; with a tab, so that no block of a source has the name."""


@dataclass(frozen=True)
class Order:
    """What to run. `period` is in seconds; without `watch` the outputs of the block are recorded."""

    file: Path
    block: str
    scans: int
    period: Fraction
    inputs: Sequence[tuple[str, str]] = ()
    watch: Sequence[str] = ()


@dataclass(frozen=True)
class Outcome:
    """Rows up to the end or the stop of the CPU, and every fault in words."""

    trace: Trajectory
    faults: tuple[str, ...]


@dataclass(frozen=True)
class _Subject:
    """A block that can be scanned, how its variables are found, and what the CPU noted."""

    scan: Callable[[int], object]
    variable: Callable[[str], Variable]
    outputs: tuple[str, ...]
    faults: Sequence[FaultRecord]
    violations: Sequence[object] = ()


def run_file(order: Order, progress: Callable[[str], None]) -> Outcome:
    """Raises SourceError for a file that cannot be run, PlcgenError for names and values that do not fit."""
    source = read_source(order.file)
    subject = _subject_of(source, order)
    for name, text in order.inputs:
        variable = subject.variable(name)
        variable.set(parse_value(text, variable, name))
    return _scan(subject, order, progress)


def _scan(subject: _Subject, order: Order, progress: Callable[[str], None]) -> Outcome:
    watched = {name: _watchable(subject.variable(name)) for name in order.watch or subject.outputs}
    columns: dict[str, list[Any]] = {name: [] for name in watched}
    done, stops = 0, []
    for number in range(order.scans):
        if number % 1000 == 0:
            progress(f"scan {number} of {order.scans}")
        try:
            subject.scan(number)
        except Fault as fault:
            stops.append(str(fault))
            break
        for name, variable in watched.items():
            columns[name].append(variable.get())
        done += 1
    times = [float(number * order.period) for number in range(done)]
    trace = {"scan": np.arange(done), "time": np.array(times, dtype=np.float64)}
    trace |= {name: _column(columns[name], variable) for name, variable in watched.items()}
    violations = tuple(str(violation) for violation in subject.violations)
    return Outcome(Trajectory(trace), (*_in_words(subject.faults), *violations, *stops))


def _in_words(faults: Sequence[FaultRecord]) -> list[str]:
    """Each fault where it came first, and how often it came again."""
    first: dict[tuple[object, ...], FaultRecord] = {}
    counts: dict[tuple[object, ...], int] = {}
    for fault in faults:
        key = (fault.kind, fault.block, fault.location)
        first.setdefault(key, fault)
        counts[key] = counts.get(key, 0) + 1
    return [f"{fault}{_repeated(counts[key] - 1)}{_excerpt(fault)}" for key, fault in first.items()]


def _repeated(times: int) -> str:
    return f", and {times} more times" if times > 1 else ", and once more" if times else ""


def _excerpt(fault: FaultRecord) -> str:
    excerpt = fault.location.excerpt()
    return f"\n{excerpt}" if excerpt else ""


# --------------------------------------------------------------------------------------------------------- subject


def _subject_of(source: SourceText, order: Order) -> _Subject:
    make = _smart if is_smart(source) else _stl if is_s7_stl(source) else _scl
    return make(source, order)


def _smart(source: SourceText, order: Order) -> _Subject:
    """A block of an S7-200 SMART: one call a period, interrupts and pulses between."""
    run = smart_run(source, order.block, order.period)
    return _Subject(lambda _number: run.scan(), run.variable, run.outputs, run.machine.faults, run.machine.violations)


def _scl(source: SourceText, order: Order) -> _Subject:
    dialect = detect_dialect(source)
    blocks = parse(source, dialect)
    return _subject(lower(blocks, dialect), blocks, order)


def _stl(source: SourceText, order: Order) -> _Subject:
    blocks = s7_parser.parse(source)
    return _subject(s7_lowering.lower(blocks), [block.declaration for block in blocks], order, outputs_given=True)


def _timed(machine: S7300, order: Order, scan: Callable[[int], object]) -> Callable[[int], object]:
    """The scan, with number and clock of the machine set before it."""

    def timed(number: int) -> object:
        machine.scan = number
        machine.clock = float(number * order.period * 1000)
        return scan(number)

    return timed


def _subject(program: Program, blocks: Sequence[Block], order: Order, outputs_given: bool = False) -> _Subject:
    """`outputs_given`: outputs of an FC are arguments too, as in STL, where they keep what they held."""
    name = _function_name(program, order)
    catalogue = Catalogue(blocks, {})
    interface = catalogue.interface(next(b for b in blocks if catalogue.name_of(b) == name and b.kind in CALLABLE))
    if interface.kind is BlockKind.FC:
        return _function(program, interface, order, outputs_given)
    return {BlockKind.FB: _instance, BlockKind.OB: _organization}[interface.kind](program, interface, order)


def _function_name(program: Program, order: Order) -> str:
    wanted = order.block.strip('"')
    known = {name.casefold(): name for name in program.functions}
    if not known:
        raise PlcgenError(f"{order.file}: holds no FB, FC or OB to run")
    if wanted.casefold() not in known:
        raise PlcgenError(f"{order.file}: no block {wanted} to run; {_choice(wanted, program.functions)}")
    return known[wanted.casefold()]


def _choice(word: str, known: Mapping[str, object] | Sequence[str]) -> str:
    near = nearest(word, known)
    return f"did you mean {near}?" if near else f"there is {', '.join(known)}" if known else "there is none"


def _instance(program: Program, interface: Interface, order: Order) -> _Subject:
    """An FB on the instance that the file declares for it, else on a fresh one."""
    structure = interface.instance
    assert structure is not None
    declared = (block.name for block in program.data_blocks.values() if block.function == interface.name)
    data = next(declared, INSTANCE)
    fresh = DataBlock(data, structure, structure.initial, interface.name)
    machine = S7300(replace(program, data_blocks={data: fresh, **program.data_blocks}))

    def variable(name: str) -> Variable:
        if structure.member(_head(name)):
            return machine.variable(f'"{data}".{name.removeprefix("#")}')
        return _global(machine, name, interface, [field.name for field in structure.fields])

    def scan(_number: int) -> object:
        return machine.call(interface.name, data)

    return _Subject(_timed(machine, order, scan), variable, _outputs(interface), machine.faults)


def _function(program: Program, interface: Interface, order: Order, outputs_given: bool) -> _Subject:
    """An FC: arguments wait in a table between scans, what it hands back goes into the same table."""
    machine = S7300(program)
    result = [Parameter(interface.name, SectionKind.OUTPUT, interface.result)] if interface.result else []
    parameters = {p.name.casefold(): p for p in (*result, *interface.parameters)}
    values = {key: _initial(parameter) for key, parameter in parameters.items()}
    inputs, both = interface.of_kinds(SectionKind.INPUT), interface.of_kinds(SectionKind.IN_OUT)
    outputs_of = interface.of_kinds(SectionKind.OUTPUT)
    arguments = [*result, *inputs, *outputs_of, *both] if outputs_given else [*inputs, *both]
    taken = [p.name.casefold() for p in arguments]
    given = [*result, *outputs_of, *both]

    def scan(_number: int) -> None:
        handed = machine.call(interface.name, arguments=[values[key] for key in taken])
        results = handed if len(given) > 1 else (handed,) * len(given)
        values.update(zip((p.name.casefold() for p in given), results, strict=True))

    def variable(name: str) -> Variable:
        parameter = parameters.get(name.removeprefix("#").strip('"').casefold())
        if parameter is None:
            return _global(machine, name, interface, [p.name for p in parameters.values()])
        return _parameter_variable(parameter, values)

    outputs = (*(p.name for p in result), *_outputs(interface))
    return _Subject(_timed(machine, order, scan), variable, outputs, machine.faults)


def _parameter_variable(parameter: Parameter, values: dict[str, Any]) -> Variable:
    key, kind = parameter.name.casefold(), parameter.type
    if not isinstance(kind, Elementary | String):
        raise PlcgenError(f"{parameter.name} is a {kind}; only elementary parameters of an FC can be set and watched")

    def put(value: Any) -> None:
        if isinstance(kind, String):
            values[key] = kind.encode(value)
        else:
            values[key] = ord(value) if kind is CHAR else kind.nearest(value)

    def get() -> Any:
        return chr(values[key]) if kind is CHAR else values[key]

    return Variable(parameter.name, kind, get, put)


def _initial(parameter: Parameter) -> Any:
    kind = parameter.type
    return kind.decode(kind.initial) if isinstance(kind, Elementary) else kind.initial


def _organization(program: Program, interface: Interface, order: Order) -> _Subject:
    """An OB gets the head of its temporaries from the operating system."""
    machine = S7300(program)
    number = int(re.sub(r"\D", "", interface.name)[:3] or 1) % 256
    milliseconds = min(int(order.period * 1000), 32767)

    def scan(count: int) -> object:
        start = FURTHER_CYCLE if count else FIRST_CYCLE
        frame = header(start, CYCLE_PRIORITY, number, milliseconds, milliseconds, milliseconds)
        return machine.call(interface.name, frame=frame)

    timed = _timed(machine, order, scan)
    return _Subject(timed, lambda name: _global(machine, name, interface, []), (), machine.faults)


def _outputs(interface: Interface) -> tuple[str, ...]:
    """What one column each can hold."""
    outputs = interface.of_kinds(SectionKind.OUTPUT, SectionKind.IN_OUT)
    return tuple(output.name for output in outputs if isinstance(output.type, Elementary))


def _head(name: str) -> str:
    return re.split(r"[.\[]", name.removeprefix("#").replace('"', ""))[0]


def _global(machine: Machine, name: str, interface: Interface, own: Sequence[str]) -> Variable:
    """A variable outside the block: an address such as M0.0, or a member of a data block."""
    blocks = [block for block in machine.program.data_blocks if block not in (INSTANCE, SHARED)]
    if _is_address(name) or _head(name).casefold() in {block.casefold() for block in blocks}:
        return machine.variable(name)
    raise PlcgenError(f"{interface.name} has no variable {name}; {_choice(name, [*own, *blocks])}")


def _is_address(name: str) -> bool:
    try:
        return parse_address(name) is not None
    except ValueError:
        return True


# --------------------------------------------------------------------------------------------------------- values

_PERIOD = re.compile(r"(?:T#|TIME#)?([0-9]+(?:\.[0-9]+)?)\s*(us|ms|s|min)", re.IGNORECASE)
_SECONDS = {"us": Fraction(1, 1_000_000), "ms": Fraction(1, 1000), "s": Fraction(1), "min": Fraction(60)}
_WORDS = {"true": True, "1": True, "false": False, "0": False}
_HINTS = {
    Family.BIT: "true or false",
    Family.FLOAT: "a number such as 1.5",
    Family.CHARACTER: "one character in quotes",
    Family.TIME: "a literal such as T#1s500ms, D#2024-12-31 or TOD#12:30:00",
}
_WHOLE = "a whole number such as 12 or 16#FF"


def parse_period(text: str) -> Fraction:
    """Seconds of `10ms`, `0.01s`, `500us` or `1min`, exactly."""
    match = _PERIOD.fullmatch(text.strip())
    seconds = Fraction(match.group(1)) * _SECONDS[match.group(2).lower()] if match else Fraction(0)
    if seconds <= 0:
        raise PlcgenError(f"--period {text}: no period; write a number above 0 with ms or s, such as 10ms")
    return seconds


def parse_value(text: str, variable: Variable, name: str) -> PythonValue:
    """A value as `--set` spells it, fit for the variable."""
    kind = variable.type
    if isinstance(kind, String):
        return _string(text, kind, name)
    if kind is CHAR:
        _refuse_wide(text, kind, name, text)
    try:
        value = _value(text, kind)
    except ValueError:
        hint = _HINTS.get(kind.family, _WHOLE)
        raise PlcgenError(f"--set {name}={text}: no value of type {kind}; write {hint}") from None
    if isinstance(value, int) and not isinstance(value, bool) and not kind.minimum <= value <= kind.maximum:
        raise PlcgenError(f"--set {name}={text}: {kind} holds {kind.minimum} to {kind.maximum}")
    return value


def _string(text: str, kind: String, name: str) -> str:
    value = text[1:-1] if len(text) > 1 and text[0] == text[-1] == "'" else text
    if len(value) > kind.length:
        raise PlcgenError(f"--set {name}={text}: {len(value)} characters, {kind} holds {kind.length}")
    _refuse_wide(value, kind, name, text)
    return value


def _refuse_wide(value: str, kind: Type, name: str, text: str) -> None:
    wide = next((character for character in value if ord(character) > 255), None)
    if wide is not None:
        raise PlcgenError(f"--set {name}={text}: '{wide}' does not fit {kind} (8 bits a character)")


def _value(text: str, kind: Elementary) -> PythonValue:
    """Raises ValueError when it is none of the kind."""
    if kind.family is Family.BIT and text.lower() in _WORDS:
        return _WORDS[text.lower()]
    if kind.family is Family.CHARACTER and len(text) == 1:
        return text
    if kind.family is Family.FLOAT and "#" not in text:
        return float(text)
    value, type_name = _literal(text)
    if type_name != kind.name and not _fits(value, type_name, kind):
        raise ValueError
    return float(value) if kind.family is Family.FLOAT else value


def _literal(text: str) -> tuple[PythonValue, str | None]:
    body = text.lstrip("+-")
    if body.startswith("'"):
        token_kind = TokenKind.STRING
    else:
        token_kind = TokenKind.NUMBER if body[:1].isdigit() else TokenKind.TYPED
    if token_kind is TokenKind.TYPED and "#" not in body:
        raise ValueError
    literal = read_literal(Token(token_kind, body, Span(0, len(body))), TIA, text.startswith("-"))
    return literal.value, literal.type_name


def _fits(value: PythonValue, type_name: str | None, kind: Elementary) -> bool:
    """Whether a literal of another type, or of none, may stand for the kind."""
    if isinstance(value, str):
        return kind.family is Family.CHARACTER and len(value) == 1
    if kind.family is Family.FLOAT:
        return type_name is None
    wholes = (Family.BITS, Family.INTEGER, Family.UNSIGNED)
    return kind.family in wholes and isinstance(value, int) and type_name not in ("TIME", "S5TIME", "DATE")


# -------------------------------------------------------------------------------------------------------- columns


def _watchable(variable: Variable) -> Variable:
    if isinstance(variable.type, String):
        raise PlcgenError(f"{variable.path} is a {variable.type}; only numbers and BOOL can be watched")
    return variable


def _column(values: list[Any], variable: Variable) -> np.ndarray[Any, Any]:
    kind = variable.type
    assert isinstance(kind, Elementary)
    if kind is CHAR:
        return np.array([ord(value) for value in values], dtype=np.int64)
    if kind.family is Family.BIT:
        return np.array(values, dtype=bool)
    return np.array(values, dtype=np.dtype(kind.code))
