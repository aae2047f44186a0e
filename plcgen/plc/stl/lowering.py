"""From the syntax tree of STL for the S7-200 SMART to the core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from plcgen.plc.builder import Builder
from plcgen.plc.core import Function, Literal, Program
from plcgen.plc.source import Span
from plcgen.plc.stl.lowering_interface import locals_of
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.smart_costs import CLASSES, NUMBERS, SPEND
from plcgen.plc.stl.smart_memory import LOCAL_BYTES
from plcgen.plc.stl.smart_rung import Edges, Rung
from plcgen.plc.stl.smart_slots import Row
from plcgen.plc.stl.smart_table import MNEMONICS, UNSUPPORTED
from plcgen.plc.stl.syntax import Block, Statement
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import INT
from plcgen.plc.verifier import verify

NO_SYMBOLS: Mapping[str, str] = MappingProxyType({})


def lower(blocks: Sequence[Block], symbols: Mapping[str, str] = NO_SYMBOLS, timed: bool = False) -> Program:
    """A verified program of the blocks OB1, SBR0, INT0 ... `symbols` maps names to addresses such as VD100.

    With `timed` it tells the machine of each instruction that it executes, for an estimate of run times.
    Raises SourceError for whatever cannot be understood or is not supported.
    """
    names, edges = Names(blocks, symbols), Edges()
    functions = {name: _function(name, block, names, edges, timed) for name, block in names.blocks.items()}
    return verify(Program(functions, {}, names.symbols))


def _function(name: str, block: Block, names: Names, edges: Edges, timed: bool) -> Function:
    local = locals_of(block)
    rung = Rung(block, names, local, edges, Builder(block.span))
    for network in block.networks:
        rung.start_network()
        for statement in network.statements:
            _statement(rung, statement, timed)
        rung.close_guard()
    _finish(rung)
    return Function(
        name=name,
        source=block.source,
        body=tuple(rung.builder.body),
        span=block.span,
        parameters=tuple(item.cell for item in local if item.is_given),
        results=tuple(item.cell for item in local if item.is_returned),
        frame_bytes=LOCAL_BYTES,
    )


def _statement(rung: Rung, statement: Statement, timed: bool) -> None:
    rung.statement, rung.builder.span = statement, statement.span
    row = _row(rung, statement)
    if row.is_box:
        rung.open_guard()
        rung.failures = ()
    else:
        rung.close_guard()
    if timed:
        rung.result(SPEND, Literal(NUMBERS[CLASSES[statement.mnemonic]], INT))
    row.emit(rung, *_operands(rung, statement, row))


def _row(rung: Rung, statement: Statement) -> Row:
    word = statement.mnemonic
    place = Span(statement.span.start, statement.span.start + len(word))
    if word in MNEMONICS:
        return MNEMONICS[word]
    if word in UNSUPPORTED:
        raise rung.block.source.error(f"{word} is not supported here; no program with it can be executed", place)
    near = did_you_mean(word, MNEMONICS) or "; write an instruction of the S7-200 SMART"
    raise rung.block.source.error(f"unknown mnemonic {word}{near}", place)


def _operands(rung: Rung, statement: Statement, row: Row) -> list[object]:
    operands = statement.operands
    if row.slots is None:
        return list(operands)
    if len(operands) != len(row.slots):
        wanted = len(row.slots) or "no"
        operand = "operand" if wanted == 1 else "operands"
        raise rung.error(f"{statement.mnemonic} takes {wanted} {operand}, {len(operands)} are given")
    return [slot(rung, operand) for slot, operand in zip(row.slots, operands, strict=True)]


def _finish(rung: Rung) -> None:
    if rung.loops:
        rung.statement = rung.loops[-1].statement
        raise rung.error("FOR without NEXT; write NEXT in a network of its own")
    if rung.step is not None:
        rung.statement = rung.step.statement
        raise rung.error("LSCR without SCRE; write SCRE in a network of its own")
    end = max(rung.block.extent.start, rung.block.extent.end - 1)
    rung.builder.span = Span(end, rung.block.extent.end)
    rung.builder.leave()
