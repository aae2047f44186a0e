"""Where the parameters and variables of a block lie."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from plcgen.plc.addresses import SIZES
from plcgen.plc.builder import Builder
from plcgen.plc.core import FRAME, INSTANCE, Cell, Place
from plcgen.plc.scl import syntax
from plcgen.plc.scl.lowering_declarations import PARAMETERS, Catalogue, Interface, declared, member_at
from plcgen.plc.scl.lowering_types import Declarations
from plcgen.plc.scl.syntax import BlockKind, SectionKind
from plcgen.plc.scl.walk import find
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_syntax import (
    Absolute,
    Argument,
    Block,
    Indirect,
    Operand,
    PointerTo,
    RegisterIndirect,
    Statement,
    Variable,
)
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BYTE_BITS, WORD_BITS, Elementary, Structure, Type, align

MOST_LOCAL_BYTES = 256
"""Of one block."""
RESULT = "RET_VAL"
"""The name of what a FUNCTION returns."""


@dataclass
class Scope:
    """Places by name in lower case; `parameters` and `results` of an FC in the order of a call.

    `local_bits` of L are there: VAR_TEMP, and what a compiler of LAD or FBD has put behind it.
    """

    source: SourceText
    declarations: Declarations
    interface: Interface
    temporaries: Structure
    local_bits: int = 0
    places: dict[str, Place] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)
    parameters: list[Place] = field(default_factory=list)
    results: list[Place] = field(default_factory=list)

    def declare(self, item: syntax.Declaration, place: Place) -> None:
        if item.name.casefold() in self.places:
            raise self.source.error(f"{item.name} is declared twice", item.span)
        self.places[item.name.casefold()] = place
        self.names.append(item.name)

    def place(self, variable: Variable) -> Place | None:
        """The place of a local variable with its members and indices, None when it is not declared."""
        place = self.places.get(variable.name.casefold())
        if place is None or not variable.path:
            return place
        if not isinstance(place, Cell):
            raise self.source.error(f"{variable.name} is {place.type}; it has no parts", variable.path[0].span)
        kind, bit = member_at(self.declarations, place.type, variable.path)
        return Cell(place.area, place.bit + bit, kind)

    def unknown(self, variable: Variable) -> str:
        return f"{variable.name} is not declared{did_you_mean(variable.name, self.names)}"


def scope_of(block: Block, catalogue: Catalogue, builder: Builder) -> Scope:
    """The scope of an FB, FC or OB. Raises SourceError for declarations that STL does not have."""
    declaration = block.declaration
    declarations = catalogue.declarations(declaration)
    temps = declared(declaration, SectionKind.TEMP)
    _refuse(block, declaration)
    for item in (*temps, *_own_parameters(declaration)):
        owner = catalogue.owner(declarations.type_of(item.type))
        if owner is not None:
            message = (
                f"{item.name} is an instance of {owner.name}, which must outlast a call; declare it in VAR of an FB"
            )
            raise block.source.error(message, item.span)
    structure = declarations.arranged(f"L of {block.name}", [declarations.members(temps)], declaration.span)
    scope = Scope(block.source, declarations, catalogue.interface(declaration), structure)
    in_frame = declaration.kind is BlockKind.OB or _needs_addresses(block.statements)
    if in_frame or not all(isinstance(member.type, Elementary) for member in structure.fields):
        builder.frame_bits = scope.local_bits = max(structure.bits, _last_bit(block.statements))
    for item, member in zip(temps, structure.fields, strict=True):
        place = Cell(FRAME, member.bit, member.type)
        scope.declare(item, place if in_frame else _home(builder, place, item.name))
    if scope.interface.instance is not None:
        _declare_instance(scope, declaration)
    else:
        _declare_parameters(scope, declaration, builder)
    return scope


def _own_parameters(declaration: syntax.Block) -> list[syntax.Declaration]:
    """Of an FC; those of an FB lie in its instance."""
    return [] if declaration.kind is BlockKind.FB else declared(declaration, *PARAMETERS)


def _home(builder: Builder, place: Cell, name: str) -> Place:
    return builder.temporary(place.type, name) if isinstance(place.type, Elementary) else place


def _refuse(block: Block, declaration: syntax.Block) -> None:
    for item in declared(declaration, SectionKind.TEMP):
        for inner in (item, *find(item.type, syntax.Declaration)):
            if inner.initial is not None:
                message = f"{inner.name} is temporary and takes no initial value; load it at the start of the block"
                raise block.source.error(message, inner.initial.span)
    for section in declaration.sections:
        if section.kind is SectionKind.STATIC and declaration.kind is not BlockKind.FB and section.declarations:
            raise block.source.error("VAR belongs to a FUNCTION_BLOCK; write VAR_TEMP", section.span)


def _declare_instance(scope: Scope, declaration: syntax.Block) -> None:
    instance = scope.interface.instance
    assert instance is not None
    for item in declared(declaration, *PARAMETERS, SectionKind.STATIC):
        member = instance.member(item.name)
        assert member is not None
        scope.declare(item, Cell(INSTANCE, member.bit, member.type))


def _declare_parameters(scope: Scope, declaration: syntax.Block, builder: Builder) -> None:
    """An output comes in too: it stands for the variable of the call, which keeps its value until it is written."""
    for item, kind, type_ in _parameters(scope, declaration):
        if item.initial is not None:
            message = f"{item.name} takes no initial value: every call of an FC gives it one; remove it here"
            raise scope.source.error(message, item.initial.span)
        place = _fresh(builder, type_, item.name)
        scope.declare(item, place)
        scope.parameters.append(place)
        if kind is not SectionKind.INPUT:
            scope.results.append(place)


def _parameters(scope: Scope, declaration: syntax.Block) -> Iterator[tuple[syntax.Declaration, SectionKind, Type]]:
    if declaration.return_type is not None:
        result = syntax.Declaration(declaration.span, RESULT, declaration.return_type)
        yield result, SectionKind.OUTPUT, scope.declarations.type_of(declaration.return_type)
    for kind in PARAMETERS:
        for item in declared(declaration, kind):
            yield item, kind, scope.declarations.type_of(item.type)


def _fresh(builder: Builder, kind: Type, name: str) -> Place:
    return builder.register(kind, name) if isinstance(kind, Elementary) else builder.frame(kind)


def _needs_addresses(statements: tuple[Statement, ...]) -> bool:
    """Whether something may look at temporaries by their address."""
    return any(map(_is_address, _operands(statements)))


def _last_bit(statements: tuple[Statement, ...]) -> int:
    """The end of the last word of L that is named by its address."""
    named = [item for item in _operands(statements) if isinstance(item, Absolute) and item.area == "L"]
    ends = [item.byte * BYTE_BITS + item.bit + SIZES[item.size].bits for item in named if item.byte < MOST_LOCAL_BYTES]
    return align(max(ends, default=0), WORD_BITS)


def _operands(statements: tuple[Statement, ...]) -> Iterator[Operand | Argument]:
    for statement in statements:
        yield from statement.operands
        yield from (argument.operand for argument in statement.arguments)


def _is_address(operand: Operand | Argument) -> bool:
    match operand:
        case Absolute(area=area):
            return area == "L"
        case Indirect(area=area, pointer=pointer):
            return area == "L" or _is_address(pointer)
        case RegisterIndirect(area=area):
            return area in ("L", "")
    return isinstance(operand, PointerTo)
