"""A run of one block of a source for the S7-200 SMART."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from plcgen.errors import PlcgenError
from plcgen.plc.core import Program
from plcgen.plc.cpu.smart import Smart
from plcgen.plc.machine import Variable
from plcgen.plc.source import SourceText
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.lowering_interface import Local, locals_of
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.parser import parse
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import Elementary, elementary

MICROSECONDS = 1_000_000


@dataclass
class SmartRun:
    """The machine, and the parameters of the block between scans."""

    machine: Smart
    parameters: tuple[Local, ...]
    values: dict[str, Any]

    @property
    def outputs(self) -> tuple[str, ...]:
        return tuple(local.declaration.name for local in self.parameters if local.is_returned)

    def scan(self) -> None:
        """One call, and what falls due until the next."""
        given = [local for local in self.parameters if local.is_given]
        taken = [local for local in self.parameters if local.is_returned]
        self.machine.arguments = [self.values[_key(local)] for local in given]
        self.machine.scan()
        results = self.machine.results if len(taken) > 1 else (self.machine.results,)
        if self.machine.running and taken:
            self.values.update(zip(map(_key, taken), results, strict=True))

    def variable(self, name: str) -> Variable:
        """A parameter, a symbol, or an address; `VD100:REAL` says how to read it."""
        local = next((item for item in self.parameters if _key(item) == name.casefold()), None)
        if local is not None:
            return self._parameter(local)
        path, _, type_name = name.partition(":")
        return self.machine.variable(path, _type(name, type_name))

    def _parameter(self, local: Local) -> Variable:
        key, kind = _key(local), local.type

        def put(value: Any) -> None:
            self.values[key] = kind.nearest(value)

        return Variable(local.declaration.name, kind, lambda: self.values[key], put)


def smart_run(source: SourceText, block: str, period: Fraction) -> SmartRun:
    """`block` is MAIN, OB1, SBR0, INT0 or a name. Raises PlcgenError for a block that is not there."""
    microseconds = period * MICROSECONDS
    if microseconds.denominator != 1:
        raise PlcgenError("--period of an S7-200 SMART: write whole microseconds, such as 5ms or 500us")
    blocks = parse(source)
    program = lower(blocks)
    name = _block_name(source, program, block)
    chosen = Names(blocks, {}).blocks[name]
    parameters = tuple(local for local in locals_of(chosen) if local.is_parameter)
    values = {_key(local): local.type.decode(local.type.initial) for local in parameters}
    return SmartRun(Smart(program, int(microseconds), cycle=name), parameters, values)


def _block_name(source: SourceText, program: Program, block: str) -> str:
    name = program.symbols.get(block.casefold(), block)
    if name in program.functions:
        return name
    if not program.functions:
        raise PlcgenError(f"{source.name}: holds no OB1, SBR or INT to run")
    near = did_you_mean(block, [*program.functions, "MAIN"]) or f"; there is {', '.join(program.functions)}"
    raise PlcgenError(f"{source.name}: no block {block} to run{near}")


def _key(local: Local) -> str:
    return local.declaration.name.casefold()


def _type(name: str, type_name: str) -> Elementary | None:
    if not type_name:
        return None
    kind = elementary(type_name)
    if kind is None:
        raise PlcgenError(f"{name}: no type {type_name}; write one such as VD100:REAL")
    return kind
