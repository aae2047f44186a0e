"""From the syntax tree of S7-300 STL to the core.

Each instruction is written with all registers and status bits that it sets; what nobody reads is then taken out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from plcgen.plc.builder import Builder
from plcgen.plc.core import Call, Cell, Compute, Function, Label, Program, Register
from plcgen.plc.scl.lowering_declarations import CALLABLE, Catalogue
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.simplify import simplified
from plcgen.plc.source import Span
from plcgen.plc.stl.s7_calls import Calls, Handovers
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_flow import core_label
from plcgen.plc.stl.s7_operators import INVERSES
from plcgen.plc.stl.s7_registers import CELLS, COUNT, FALSE, FC, KEPT, OR, OS, SHARED, SHARED_BLOCK
from plcgen.plc.stl.s7_scope import scope_of
from plcgen.plc.stl.s7_selection import OWN, Selection, Surroundings, selections
from plcgen.plc.stl.s7_statements import JUMPS
from plcgen.plc.stl.s7_syntax import Block, Statement
from plcgen.plc.stl.s7_table import CALLS, MNEMONICS, UNSUPPORTED
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.verifier import verify

NO_SYMBOLS: Mapping[str, str] = MappingProxyType({})
END = "END"


def lower(
    blocks: Sequence[Block], symbols: Mapping[str, str] = NO_SYMBOLS, told: frozenset[Register] = frozenset()
) -> Program:
    """A verified program. `symbols` maps quoted names to absolute ones such as FB100 or M0.0.

    At its end an FB leaves the registers `told` in the memory of registers, whether a block reads them or not.
    Raises SourceError for whatever cannot be understood or is not supported.
    """
    catalogue = Catalogue([block.declaration for block in blocks], symbols)
    for block in blocks:
        if block.declaration.kind is BlockKind.DB:
            catalogue.data_block(block.name)
        elif block.declaration.kind is BlockKind.UDT:
            catalogue.structure_of(block.declaration)
    functions = _functions([block for block in blocks if block.declaration.kind in CALLABLE], catalogue, told)
    data_blocks = {block.name: block for block in catalogue.created.values()}
    if told or any(_reads_shared(function) for function in functions.values()):
        data_blocks[SHARED] = SHARED_BLOCK
    return verify(Program(functions, data_blocks, catalogue.symbols))


def _functions(blocks: Sequence[Block], catalogue: Catalogue, told: frozenset[Register]) -> dict[str, Function]:
    """Again and again, until no block is found to read another register of its callers or callees."""
    handovers = Handovers()
    for block in blocks:
        if block.declaration.kind is BlockKind.FB:
            handovers.exit[catalogue.absolute(block.name)] |= told
    functions = [_function(block, catalogue, handovers) for block in blocks]
    written = [_needed(function, handovers) for function in functions]
    while True:
        news = [_found(function, handovers) for function in functions]
        if not any(news):
            return {function.name: function for function in functions}
        for number, block in enumerate(blocks):
            needed = _needed(functions[number], handovers)
            if needed != written[number]:
                functions[number] = _function(block, catalogue, handovers)
                written[number] = needed


Needed = tuple[frozenset[Register], tuple[frozenset[Register], ...]]


def _needed(function: Function, handovers: Handovers) -> Needed:
    """What a function must hand on: at its end, and to each of those it calls."""
    callees = sorted({item.function for item in function.body if isinstance(item, Call)})
    entries = tuple(frozenset(handovers.entry[callee]) for callee in callees)
    return frozenset(handovers.exit[function.name]), entries


def _reads_shared(function: Function) -> bool:
    return any(isinstance(item, Compute) and _loaded(item) for item in function.body)


# ----------------------------------------------------------------------------------------------------- one function


def _function(block: Block, catalogue: Catalogue, handovers: Handovers) -> Function:
    declaration = block.declaration
    builder = Builder(declaration.span, _registers=COUNT)
    code = Code(block, catalogue, scope_of(block, catalogue, builder), builder, END)
    name = code.scope.interface.name
    _enter(code)
    _statements(code, Calls(code, handovers))
    _leave(code, handovers.exit[name])
    written = Function(
        name=name,
        source=block.source,
        body=tuple(builder.body),
        span=declaration.span,
        instance=code.scope.interface.instance,
        parameters=tuple(code.scope.parameters),
        results=tuple(code.scope.results),
        temporaries=tuple(builder.temporaries),
        frame_bytes=builder.frame_bytes,
        frame_given=declaration.kind is BlockKind.OB,
    )
    return simplified(written, INVERSES)


def _enter(code: Code) -> None:
    for register in KEPT:
        code.put(register, CELLS[register])
    for register in (OS, FC, OR):
        code.put(register, FALSE)


def _leave(code: Code, read: set[Register]) -> None:
    extent = code.block.declaration.extent
    code.builder.span = Span(max(extent.start, extent.end - 1), extent.end)
    code.builder.place(END)
    for register in sorted(read, key=KEPT.index):
        code.put(CELLS[register], register)
    code.builder.leave()


def _found(function: Function, handovers: Handovers) -> bool:
    """Note the registers that a block reads of its caller and of those it calls; whether one is new."""
    loads = [_loaded(item) if isinstance(item, Compute) else None for item in function.body]
    first = next((place for place, register in enumerate(loads) if register is None), len(loads))
    at_start = {register for register in loads[:first] if register}
    behind_calls = {register for register in loads[first:] if register}
    new = not at_start <= handovers.entry[function.name]
    handovers.entry[function.name] |= at_start
    for callee in {item.function for item in function.body if isinstance(item, Call)}:
        new = new or not behind_calls <= handovers.exit[callee]
        handovers.exit[callee] |= behind_calls
    return new


def _loaded(item: Compute) -> Register | None:
    """The register that is loaded from the memory of registers."""
    shared = next((operand for operand in item.operands if isinstance(operand, Cell) and operand.area == SHARED), None)
    return next((register for register, cell in CELLS.items() if cell == shared), None) if shared else None


# ------------------------------------------------------------------------------------------------------- statements


def _statements(code: Code, calls: Calls) -> None:
    _check_labels(code)
    known = selections(code.block.statements, _start(code), _surroundings(code))
    for statement, selected in zip(code.block.statements, known, strict=True):
        code.statement, code.builder.span, code.selected = statement, statement.span, selected
        if code.brackets and (statement.label or statement.mnemonic in (*JUMPS, *CALLS, "BE", "BEU", "BEC")):
            raise code.error(f"{code.brackets[-1].statement.word} is still open here; close it with )")
        if statement.label is not None:
            code.builder.emit(Label(statement.span, core_label(statement.label.name)))
        _statement(code, calls, statement)
    if code.brackets:
        opening = code.brackets[-1].statement
        raise code.error(f"{opening.word} is not closed; write ) below it", opening.span)


def _start(code: Code) -> Selection:
    return Selection(di=OWN if code.scope.interface.kind is BlockKind.FB else None)


def _surroundings(code: Code) -> Surroundings:
    temporaries = frozenset(field.name.casefold() for field in code.scope.temporaries.fields)
    return Surroundings(temporaries, frozenset(code.scope.places), code.catalogue.symbols)


def _check_labels(code: Code) -> None:
    seen: set[str] = set()
    for statement in code.block.statements:
        if statement.label is not None and statement.label.name in seen:
            message = f"label {statement.label.name} stands twice in {code.block.name}; rename one"
            raise code.block.source.error(message, statement.label.span)
        seen |= {statement.label.name} if statement.label else set()


def _statement(code: Code, calls: Calls, statement: Statement) -> None:
    word, operands = statement.mnemonic, statement.operands
    if word == "CALL":
        calls.call()
        return
    if word in CALLS:
        if not operands:
            raise code.error(f"{statement.word} of what? write {statement.word} FC 1")
        {"UC": calls.plain, "CC": calls.conditional}[word](operands[0])
        return
    row = MNEMONICS.get(word)
    if row is None:
        raise code.error(_unknown(statement), statement.word_span)
    if operands and row.slot is None:
        raise code.error(f"{statement.word} takes no operand; remove {code.text(operands[0])}", operands[0])
    if not operands and row.slot is not None and not row.optional and word not in ("NOP", "BLD"):
        raise code.error(f"{statement.word} needs an operand", statement.word_span)
    if row.slot is None or not operands:
        row.emit(code, *([None] if word in ("NOP", "BLD") else []))
    else:
        row.emit(code, row.slot(code, operands[0]))


def _unknown(statement: Statement) -> str:
    if statement.mnemonic in UNSUPPORTED:
        return f"{statement.word}: {UNSUPPORTED[statement.mnemonic]}"
    hint = did_you_mean(statement.mnemonic, [*MNEMONICS, *CALLS]) or "; write an instruction of the S7-300"
    return f"unknown instruction {statement.word}{hint}"


def emptied(block: Block) -> Block:
    """The block with its interface alone: others can still be checked against it."""
    return replace(block, statements=(), declaration=replace(block.declaration, body=()))
