"""Where a variable lives: scopes, members, indices, slices and absolute addresses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import reduce

from plcgen.plc.addresses import AREA_BYTES, SIZES, parse_address
from plcgen.plc.addresses import cell as cell_at
from plcgen.plc.builder import Builder
from plcgen.plc.core import FRAME, INSTANCE, Area, Cell, Literal, Operand, Place, Register
from plcgen.plc.operators import INDEX, resolve
from plcgen.plc.scl import syntax
from plcgen.plc.scl.dialects import FLAG_WORDS, Dialect
from plcgen.plc.scl.lowering_declarations import (
    PARAMETERS,
    Catalogue,
    Interface,
    declared,
    find_member,
)
from plcgen.plc.scl.lowering_types import Declarations
from plcgen.plc.scl.lowering_values import Untyped, Value, expect
from plcgen.plc.scl.syntax import BlockKind, SectionKind
from plcgen.plc.scl.walk import find
from plcgen.plc.source import SourceText, Span
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import (
    BIT_STRINGS,
    BOOL,
    BYTE_BITS,
    DINT,
    Array,
    Elementary,
    Structure,
    Type,
)

FLAG_HINTS = {
    "EN": "put the call into IF ... END_IF",
    "ENO": "give the block an output for its errors",
    "OK": "test the operands before, or the range of the result",
}

_NOT_A_VALUE = {
    BlockKind.FC: "call it as {name}( )",
    BlockKind.FB: "name an instance of it",
    BlockKind.UDT: "declare a variable of it",
    BlockKind.OB: "only the operating system calls it",
}


def flag_refusal(name: str) -> str:
    """What to say about OK, ENO and the like."""
    word = name.upper()
    return f"{word} is not supported" + (f"; {FLAG_HINTS[word]}" if word in FLAG_HINTS else "")


@dataclass
class Scope:
    """Names that a block sees without naming another block, all in lower case."""

    places: dict[str, Place] = field(default_factory=dict)
    parameters: list[Place] = field(default_factory=list)
    results: list[Place] = field(default_factory=list)

    def declare(self, source: SourceText, declaration: syntax.Declaration, place: Place) -> None:
        key = declaration.name.casefold()
        if key in self.places:
            raise source.error(f"{declaration.name} is declared twice", declaration.span)
        self.places[key] = place


class Places(ABC):
    """Lowers variables to places. The classes that follow add expressions, calls and statements."""

    def __init__(self, block: syntax.Block, catalogue: Catalogue, dialect: Dialect) -> None:
        self.block = block
        self.source = block.source
        self.catalogue = catalogue
        self.dialect = dialect
        self.declarations = catalogue.declarations(block)
        self.interface = catalogue.interface(block)
        self.builder = Builder(block.span)
        self.scope = _ScopeBuilder(block, self.declarations, self.interface, self.builder).build()

    @abstractmethod
    def value(self, node: syntax.Expression) -> Value:
        """The value of an expression."""

    # ------------------------------------------------------------------------------------------------------ access

    def place(self, node: syntax.Variable | syntax.Address) -> Place:
        """Where an assignment goes. Raises SourceError for constants."""
        target = self.read(node)
        if isinstance(target, Literal | Untyped):
            assert isinstance(node, syntax.Variable)
            raise self.source.error(f"{node.name} is a constant; it cannot be assigned", node.span)
        return target

    def read(self, node: syntax.Variable | syntax.Address) -> Place | Literal | Untyped:
        """The place or constant that a name stands for."""
        if isinstance(node, syntax.Address):
            return self._addressed(node)
        start = self._start(node)
        if node.selectors and not isinstance(start, Cell):
            raise self.source.error(f"{node.name} is {_type_name(start)}; it has no members", node.selectors[0].span)
        return reduce(self._select, node.selectors, start) if isinstance(start, Cell) else start

    def _start(self, node: syntax.Variable) -> Place | Literal | Untyped:
        local = self.local(node)
        if local is not None:
            return local
        if node.scope is not syntax.Scope.LOCAL:
            shared = self._shared(node)
            if shared is not None:
                return shared
        raise self.source.error(self._unknown(node), node.span)

    def _unknown(self, node: syntax.Variable) -> str:
        if node.name.upper() in FLAG_WORDS:
            return flag_refusal(node.name)
        block = self.catalogue.find(node.name, *_NOT_A_VALUE)
        if block is not None and node.scope is not syntax.Scope.LOCAL:
            return f"{node.name} is a {block.kind.value}; {_NOT_A_VALUE[block.kind].format(name=node.name)}"
        hint = did_you_mean(node.name, self._known(node))
        if not hint and node.scope is syntax.Scope.GLOBAL:
            return f'"{node.name}" is no block here, and PLC tags are not read; write the address, such as %M0.0'
        return f"unknown name {node.name}{hint}"

    def local(self, node: syntax.Variable) -> Place | Literal | Untyped | None:
        """What a name stands for inside the block."""
        key = node.name.casefold()
        if node.scope is syntax.Scope.GLOBAL and key != self.block.name.casefold():
            return None
        constant = self.declarations.constants.get(key)
        if constant is None:
            return self.scope.places.get(key)
        assert isinstance(constant, Literal | Untyped)
        return constant

    def _shared(self, node: syntax.Variable) -> Place | None:
        block = self.catalogue.data_block(node.name)
        if block is not None:
            return Cell(block.name, 0, block.type)
        if node.scope is not syntax.Scope.GLOBAL:
            return None
        try:
            return parse_address(self.catalogue.absolute(node.name))
        except ValueError as error:
            raise self.source.error(str(error), node.span) from None

    def _known(self, node: syntax.Variable) -> Iterator[str]:
        if node.scope is not syntax.Scope.GLOBAL:
            declarations = declared(self.block, *SectionKind)
            yield from (declaration.name for declaration in declarations)
            yield from (constant.name for constant in self.block.constants)
        if node.scope is not syntax.Scope.LOCAL:
            yield from self.catalogue.names()

    def _addressed(self, node: syntax.Address) -> Cell:
        area, room = self._area(node)
        try:
            return cell_at(area, node.size, node.byte, node.bit, room)
        except ValueError as error:
            raise self.source.error(str(error), node.span) from None

    def _area(self, node: syntax.Address) -> tuple[Area | str, int]:
        """The area of an absolute operand, and its bytes."""
        if not node.area.startswith("DB"):
            return Area(node.area), AREA_BYTES
        block = self.catalogue.data_block(node.area)
        if block is None:
            raise self.source.error(f"unknown data block {node.area}", node.span)
        return block.name, len(block.initial)

    # --------------------------------------------------------------------------------------------------- selectors

    def _select(self, cell: Cell, step: syntax.Member | syntax.Index | syntax.Slice) -> Cell:
        match step:
            case syntax.Member():
                kind, offset = find_member(self.source, cell.type, step)
                return replace(cell, bit=cell.bit + offset, type=kind)
            case syntax.Index():
                return self._element(cell, step)
            case syntax.Slice():
                return self._slice(cell, step)

    def _element(self, cell: Cell, step: syntax.Index) -> Cell:
        kind = cell.type
        if not isinstance(kind, Array):
            raise self.source.error(f"{kind} takes no index", step.span)
        if len(step.indices) != len(kind.bounds):
            raise self.source.error(f"{len(step.indices)} indices for the {len(kind.bounds)} of {kind}", step.span)
        cell = replace(cell, type=kind.element)
        for node, (low, high), stride in zip(step.indices, kind.bounds, kind.strides, strict=True):
            index = expect(self.source, self.builder, self.value(node), DINT, node.span)
            self.builder.span = node.span
            cell = self._step_to(cell, index, low, high, stride, node.span)
        return cell

    def _step_to(self, cell: Cell, index: Operand, low: int, high: int, stride: int, span: Span) -> Cell:
        limits = [Literal(number, DINT) for number in (low, high, stride)]
        if isinstance(index, Literal):
            if not low <= index.value <= high:  # type: ignore[operator]
                raise self.source.error(f"index {index.value!r} outside {low} .. {high}", span)
            return replace(cell, bit=cell.bit + (int(index.value) - low) * stride)
        offset = self.builder.compute(INDEX, index, *limits)
        if cell.index is not None:
            plus = resolve("+", (DINT, DINT))
            assert plus is not None
            offset = self.builder.compute(plus, cell.index, offset)
        assert isinstance(offset, Register)
        return replace(cell, index=offset)

    def _slice(self, cell: Cell, step: syntax.Slice) -> Cell:
        part = SIZES[step.unit]
        if cell.type not in BIT_STRINGS or part.bits >= cell.type.bits:
            raise self.source.error(f"{cell.type} has no slice %{step.unit}", step.span)
        count = cell.type.bits // part.bits
        if step.number >= count:
            raise self.source.error(f"slice %{step.unit}{step.number} outside 0 .. {count - 1}", step.span)
        return replace(cell, bit=cell.bit + _slice_offset(cell.type.bits, part, step.number), type=part)


def _slice_offset(bits: int, part: Elementary, number: int) -> int:
    """Big-endian memory: slice 0 lies in the last byte."""
    if part is BOOL:
        return bits - BYTE_BITS - number // BYTE_BITS * BYTE_BITS + number % BYTE_BITS
    return bits - (number + 1) * part.bits


def _type_name(value: Place | Literal | Untyped) -> str:
    return "a constant" if isinstance(value, Literal | Untyped) else str(value.type)


# ---------------------------------------------------------------------------------------------------------- scopes


_NO_DEFAULT = {
    SectionKind.INPUT: "every call of an FC gives it a value; remove it here",
    SectionKind.IN_OUT: "every call of an FC gives it a value; remove it here",
    SectionKind.OUTPUT: "an output of an FC begins without one; assign it at the start of the body",
}


@dataclass
class _ScopeBuilder:
    """Gives every declared name of a block its place."""

    block: syntax.Block
    declarations: Declarations
    interface: Interface
    builder: Builder
    scope: Scope = field(default_factory=Scope)

    def build(self) -> Scope:
        addressed = self._addressed_names()
        if self.interface.instance is not None:
            self._declare_instance(self.interface.instance)
        else:
            self._declare_parameters(addressed)
        for declaration in declared(self.block, SectionKind.TEMP, *self._locals()):
            self._refuse_initial(declaration, "only VAR of an FB keeps one; assign it at the start of the body")
            self._declare(declaration, self._home(declaration, addressed, parameter=False))
        return self.scope

    def _locals(self) -> tuple[SectionKind, ...]:
        """VAR of an FC or OB is temporary too."""
        return () if self.interface.instance is not None else (SectionKind.STATIC,)

    def _refuse_initial(self, declaration: syntax.Declaration, way_out: str) -> None:
        """Nothing here outlives a call, so nobody would write the value."""
        for item in (declaration, *find(declaration.type, syntax.Declaration)):
            if item.initial is not None:
                message = f"{item.name} takes no initial value: {way_out}"
                raise self.block.source.error(message, item.initial.span)

    def _declare(self, declaration: syntax.Declaration, place: Place) -> None:
        self.scope.declare(self.block.source, declaration, place)
        if declaration.name.casefold() in self.declarations.constants:
            raise self.block.source.error(f"{declaration.name} is a constant already", declaration.span)

    def _declare_instance(self, instance: Structure) -> None:
        kinds = (*PARAMETERS, SectionKind.STATIC)
        for declaration in (d for kind in kinds for d in declared(self.block, kind)):
            member = instance.member(declaration.name)
            assert member is not None
            self._declare(declaration, Cell(INSTANCE, member.bit, member.type))

    def _declare_parameters(self, addressed: set[str]) -> None:
        if self.interface.result is not None:
            result = self._fresh(self.block.name, self.interface.result, in_memory=False, parameter=False)
            self.scope.places |= {self.block.name.casefold(): result, self.interface.name.casefold(): result}
            self.scope.results.append(result)
        for kind in PARAMETERS:
            for declaration in declared(self.block, kind):
                self._refuse_initial(declaration, _NO_DEFAULT[kind])
                place = self._home(declaration, addressed, parameter=kind is not SectionKind.OUTPUT)
                self._declare(declaration, place)
                if declaration.view_of is None and kind is not SectionKind.OUTPUT:
                    self.scope.parameters.append(place)
                if declaration.view_of is None and kind is not SectionKind.INPUT:
                    self.scope.results.append(place)

    def _home(self, declaration: syntax.Declaration, addressed: set[str], parameter: bool) -> Place:
        """A register when nobody looks at the address, else the frame."""
        kind = self.declarations.type_of(declaration.type)
        if declaration.view_of is not None:
            return self._view(declaration, kind)
        if not parameter:
            self._refuse_instance(declaration, kind)
        in_memory = self.block.kind is BlockKind.OB or declaration.name.casefold() in addressed
        return self._fresh(declaration.name, kind, in_memory, parameter)

    def _refuse_instance(self, declaration: syntax.Declaration, kind: Type) -> None:
        owner = self.declarations.catalogue.owner(kind)
        if owner is not None:
            way_out = "which must outlast a call; declare it in VAR of an FB"
            message = f"{declaration.name} is an instance of {owner.name}, {way_out}"
            raise self.block.source.error(message, declaration.span)

    def _fresh(self, name: str, kind: Type, in_memory: bool, parameter: bool) -> Place:
        if in_memory or not isinstance(kind, Elementary):
            return self.builder.frame(kind)
        return self.builder.register(kind, name) if parameter else self.builder.temporary(kind, name)

    def _view(self, declaration: syntax.Declaration, kind: Type) -> Cell:
        viewed = self.scope.places.get((declaration.view_of or "").casefold())
        if not isinstance(viewed, Cell) or viewed.area != FRAME:
            raise self.block.source.error(f"{declaration.view_of} is not declared before its view", declaration.span)
        if kind.bits > viewed.type.bits:
            message = f"{declaration.name} has {kind.bits} bits, {declaration.view_of} beneath it {viewed.type.bits}"
            raise self.block.source.error(message, declaration.span)
        return replace(viewed, type=kind)

    def _addressed_names(self) -> set[str]:
        """Names that something views by address: AT, or a slice in the text."""
        declarations = declared(self.block, *SectionKind)
        views = {declaration.view_of.casefold() for declaration in declarations if declaration.view_of}
        sliced = (node for node in find(self.block.body, syntax.Variable) if _has_slice(node))
        return views | {node.name.casefold() for node in sliced}


def _has_slice(node: syntax.Variable) -> bool:
    return any(isinstance(step, syntax.Slice) for step in node.selectors)
