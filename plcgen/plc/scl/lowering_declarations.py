"""What is declared, before any statement runs: constants, types, interfaces of blocks, memory of data blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from plcgen.plc.builder import Builder
from plcgen.plc.core import DataBlock, Literal
from plcgen.plc.layout import Member, arrange, write
from plcgen.plc.scl import syntax
from plcgen.plc.scl.dialects import PARAMETER_TYPES, UNSUPPORTED_TYPES
from plcgen.plc.scl.lowering_values import Untyped, Value, combine, expect, literal
from plcgen.plc.scl.syntax import BlockKind, SectionKind
from plcgen.plc.source import SourceText
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BYTE_BITS, DINT, Array, Elementary, String, Structure, Type, elementary

LONGEST_STRING = 254
LARGEST_ARRAY = 1 << 24  # bytes

STORED = (SectionKind.INPUT, SectionKind.OUTPUT, SectionKind.IN_OUT, SectionKind.STATIC)
PARAMETERS = STORED[:3]
CALLABLE = (BlockKind.FB, BlockKind.FC, BlockKind.OB)


@dataclass(frozen=True)
class Parameter:
    """One parameter of a block."""

    name: str
    kind: SectionKind
    type: Type


@dataclass(frozen=True)
class Interface:
    """What a caller sees of a block; `instance` is the memory of an FB, `result` what an FC returns."""

    name: str
    kind: BlockKind
    parameters: tuple[Parameter, ...]
    instance: Structure | None = None
    result: Type | None = None

    def parameter(self, name: str) -> Parameter | None:
        """The parameter of this name in any case."""
        return next((p for p in self.parameters if p.name.casefold() == name.casefold()), None)

    def of_kinds(self, *kinds: SectionKind) -> tuple[Parameter, ...]:
        return tuple(parameter for parameter in self.parameters if parameter.kind in kinds)


@dataclass
class Declarations:
    """Types and constants as one block sees them."""

    source: SourceText
    catalogue: Catalogue
    constants: dict[str, Value] = field(default_factory=dict)

    def define(self, constants: Sequence[syntax.Constant]) -> None:
        """Take in CONST or VAR CONSTANT, each able to use those before it."""
        for constant in constants:
            value = self.constant(constant.value)
            if constant.type is not None:
                kind = self.type_of(constant.type)
                value = expect(self.source, Builder(constant.span), value, kind, constant.value.span)
            self.constants[constant.name.casefold()] = value

    def constant(self, node: syntax.InitialValue) -> Value:
        """The value of a constant expression."""
        builder = Builder(node.span)
        match node:
            case syntax.Literal():
                return literal(self.source, node)
            case syntax.Variable(name=name, selectors=()):
                if name.casefold() in self.constants:
                    return self.constants[name.casefold()]
                hint = did_you_mean(name, self.constants)
                raise self.source.error(f"{name} is no constant{hint}", node.span)
            case syntax.Unary(operator=symbol, operand=operand):
                return self._folded(builder, "NEG" if symbol == "-" else symbol, [operand], node)
            case syntax.Binary(operator=symbol, left=left, right=right):
                return self._folded(builder, symbol, [left, right], node)
        raise self.source.error("not a constant expression", node.span)

    def _folded(
        self, builder: Builder, symbol: str, nodes: Sequence[syntax.Expression], whole: syntax.Unary | syntax.Binary
    ) -> Value:
        values = [self.constant(node) for node in nodes]
        if symbol == "+" and len(values) == 1:
            return values[0]
        span = whole.operator_span if isinstance(whole, syntax.Binary) else whole.span
        value = combine(self.source, builder, symbol, values, span)
        if isinstance(value, Literal | Untyped):
            return value
        raise self.source.error(f"constant expression has no value: {symbol} of these operands is a fault", span)

    def integer(self, node: syntax.Expression) -> int:
        """A constant whole number, as in array bounds."""
        operand = expect(self.source, Builder(node.span), self.constant(node), DINT, node.span)
        assert isinstance(operand, Literal)
        return int(operand.value)

    def indices(self, step: syntax.Index, kind: Array) -> tuple[int, ...]:
        """Constant indices within the bounds of an array."""
        indices = tuple(self.integer(index) for index in step.indices)
        if len(indices) != len(kind.bounds):
            raise self.source.error(f"{len(indices)} indices for the {len(kind.bounds)} of {kind}", step.span)
        for index, (low, high) in zip(indices, kind.bounds, strict=True):
            if not low <= index <= high:
                raise self.source.error(f"index {index} outside {low} .. {high}", step.span)
        return indices

    # ------------------------------------------------------------------------------------------------------- types

    def type_of(self, spec: syntax.TypeSpec) -> Type:
        """The type that a declaration means."""
        match spec:
            case syntax.StringSpec(length=length):
                return String(LONGEST_STRING) if length is None else self._string(length)
            case syntax.ArraySpec(bounds=bounds, element=element):
                return self._array(spec, tuple(self._bounds(low, high) for low, high in bounds), self.type_of(element))
            case syntax.StructSpec(fields=fields):
                return arrange("", [self.members(fields)])
            case syntax.NamedType(name=name):
                return elementary(name) or self.catalogue.structure(self.source, spec)

    def _string(self, node: syntax.Expression) -> String:
        length = self.integer(node)
        if not 1 <= length <= LONGEST_STRING:
            raise self.source.error(f"STRING length {length} outside 1 .. {LONGEST_STRING}", node.span)
        return String(length)

    def _array(self, spec: syntax.ArraySpec, bounds: tuple[tuple[int, int], ...], element: Type) -> Array:
        kind = Array(bounds, element)
        if kind.bits > LARGEST_ARRAY * BYTE_BITS:
            raise self.source.error(f"{kind} takes {kind.bits // BYTE_BITS} bytes, more than any CPU has", spec.span)
        return kind

    def _bounds(self, low: syntax.Expression, high: syntax.Expression) -> tuple[int, int]:
        first, last = self.integer(low), self.integer(high)
        if last < first:
            raise self.source.error(f"array bounds {first} .. {last} run backwards", high.span)
        return first, last

    def members(self, declarations: Sequence[syntax.Declaration]) -> list[Member]:
        """Declarations as members of a structure, with their initial values."""
        return [
            Member(declaration.name, kind := self.type_of(declaration.type), self._initial(declaration, kind), view)
            for declaration in declarations
            for view in [self._viewed(declaration, declarations)]
        ]

    def _viewed(self, declaration: syntax.Declaration, others: Sequence[syntax.Declaration]) -> str | None:
        if declaration.view_of is None:
            return None
        viewed = next((d for d in others if d.name.casefold() == declaration.view_of.casefold()), None)
        if viewed is None:
            raise self.source.error(f"{declaration.view_of} is not declared in this section", declaration.span)
        wide, room = self.type_of(declaration.type), self.type_of(viewed.type)
        if wide.bits > room.bits:
            message = f"{declaration.name} has {wide.bits} bits, {viewed.name} beneath it only {room.bits}"
            raise self.source.error(message, declaration.span)
        return viewed.name

    # ---------------------------------------------------------------------------------------------- initial values

    def _initial(self, declaration: syntax.Declaration, kind: Type) -> bytes | None:
        return None if declaration.initial is None else self.image(declaration.initial, kind)

    def image(self, node: syntax.InitialValue, kind: Type) -> bytes:
        """The bytes of an initial value."""
        if isinstance(kind, Array):
            return self._array_image(node, kind)
        if isinstance(kind, Structure) or isinstance(node, syntax.InitialList | syntax.Repetition):
            raise self.source.error(f"an initial value for {kind} is not supported; give its members theirs", node.span)
        operand = expect(self.source, Builder(node.span), self.constant(node), kind, node.span)
        assert isinstance(operand, Literal)
        if isinstance(operand.value, bytes):
            return operand.value
        assert isinstance(kind, Elementary)
        return kind.encode(operand.value)

    def _array_image(self, node: syntax.InitialValue, kind: Array) -> bytes:
        values = list(self._spread(node))
        if len(values) > kind.count:
            raise self.source.error(f"{len(values)} initial values for {kind.count} elements", node.span)
        image = bytearray(kind.initial)
        for offset, value in zip(kind.offsets(), values, strict=False):
            write(image, offset, kind.element, self.image(value, kind.element))
        return bytes(image)

    def _spread(self, node: syntax.InitialValue) -> Iterator[syntax.InitialValue]:
        if isinstance(node, syntax.InitialList):
            for value in node.values:
                yield from self._spread(value)
        elif isinstance(node, syntax.Repetition):
            for _ in range(self.integer(node.count)):
                for value in node.values:
                    yield from self._spread(value)
        else:
            yield node


class Catalogue:
    """All blocks of a program by absolute name, and what they declare; each worked out once, when first asked for."""

    def __init__(self, blocks: Sequence[syntax.Block], symbols: Mapping[str, str]) -> None:
        self.symbols = {name.casefold(): "".join(absolute.split()) for name, absolute in symbols.items()}
        self.blocks: dict[str, syntax.Block] = {}
        self._interfaces: dict[str, Interface] = {}
        self._structures: dict[str, Structure] = {}
        self._pending: set[str] = set()
        self.created: dict[str, DataBlock] = {}
        for block in blocks:
            self._add(block)

    def _add(self, block: syntax.Block) -> None:
        key = self.absolute(block.name).casefold()
        if key in self.blocks:
            raise block.source.error(f"{block.kind.value} {block.name} stands twice", block.span)
        self.blocks[key] = block

    def absolute(self, name: str) -> str:
        """The absolute name or address behind a symbol, else the name itself."""
        return self.symbols.get(name.casefold(), name)

    def find(self, name: str, *kinds: BlockKind) -> syntax.Block | None:
        """The block of this name or symbol, if it is of one of these kinds."""
        block = self.blocks.get(self.absolute(name).casefold())
        return block if block and block.kind in kinds else None

    def name_of(self, block: syntax.Block) -> str:
        return self.absolute(block.name)

    def names(self) -> list[str]:
        return [block.name for block in self.blocks.values()]

    def declarations(self, block: syntax.Block) -> Declarations:
        """Types and constants as seen inside a block."""
        declarations = Declarations(block.source, self)
        declarations.define(block.constants)
        return declarations

    # -------------------------------------------------------------------------------------------------- structures

    def structure(self, source: SourceText, spec: syntax.NamedType) -> Structure:
        """The structure of a UDT, or the instance data of an FB."""
        block = self.find(spec.name, BlockKind.UDT, BlockKind.FB)
        if spec.name.upper() in PARAMETER_TYPES | UNSUPPORTED_TYPES:
            raise source.error(f"type {spec.name} is not supported", spec.span)
        if block is None:
            raise source.error(f"unknown type {spec.name}{did_you_mean(spec.name, self.names())}", spec.span)
        if block.name in self._pending:
            raise source.error(f"{spec.name} contains itself", spec.span)
        return self.structure_of(block)

    def structure_of(self, block: syntax.Block) -> Structure:
        """The members of a UDT, a shared DB or the instance of an FB."""
        if block.name not in self._structures:
            self._pending.add(block.name)
            self._structures[block.name] = self._arranged(block)
            self._pending.remove(block.name)
        return self._structures[block.name]

    def _arranged(self, block: syntax.Block) -> Structure:
        declarations = self.declarations(block)
        if block.structure is not None:
            return arrange(self.name_of(block), [declarations.members(block.structure.fields)])
        sections = [declarations.members(declared(block, kind)) for kind in STORED]
        return arrange(self.name_of(block), sections)

    # -------------------------------------------------------------------------------------------------- interfaces

    def interface(self, block: syntax.Block) -> Interface:
        """What callers see of an FB, FC or OB."""
        if block.name not in self._interfaces:
            declarations = self.declarations(block)
            parameters = tuple(
                Parameter(declaration.name, kind, declarations.type_of(declaration.type))
                for kind in PARAMETERS
                for declaration in declared(block, kind)
                if declaration.view_of is None
            )
            instance = self.structure_of(block) if block.kind is BlockKind.FB else None
            result = declarations.type_of(block.return_type) if block.return_type else None
            name = self.name_of(block)
            self._interfaces[block.name] = Interface(name, block.kind, parameters, instance, result)
        return self._interfaces[block.name]

    def instance_interface(self, kind: Type) -> Interface | None:
        """The FB whose instance data this type is."""
        block = self.find(kind.name, BlockKind.FB) if isinstance(kind, Structure) and kind.name else None
        return self.interface(block) if block else None

    # ------------------------------------------------------------------------------------------------- data blocks

    def data_block(self, name: str) -> DataBlock | None:
        """The memory of a declared data block, or of an instance made by a call."""
        block = self.find(name, BlockKind.DB)
        if block is None:
            return self.created.get(self.absolute(name).casefold())
        key = self.name_of(block).casefold()
        if key not in self.created:
            self.created[key] = self._data_block(block)
        return self.created[key]

    def create_instance(self, name: str, interface: Interface) -> DataBlock:
        """The instance data block of a call, made when nobody declared it."""
        existing = self.data_block(name)
        if existing is not None:
            return existing
        assert interface.instance is not None
        made = DataBlock(self.absolute(name), interface.instance, interface.instance.initial, interface.name)
        self.created[made.name.casefold()] = made
        return made

    def _data_block(self, block: syntax.Block) -> DataBlock:
        declarations = self.declarations(block)
        owner = self.find(block.instance_of, BlockKind.FB) if block.instance_of else None
        if block.instance_of is not None:
            kind = self.structure(block.source, syntax.NamedType(block.span, block.instance_of))
        else:
            kind = self.structure_of(block)
        image = bytearray(kind.initial)
        for statement in block.body:
            self._override(declarations, image, kind, statement)
        return DataBlock(self.name_of(block), kind, bytes(image), self.name_of(owner) if owner else None)

    def _override(
        self, declarations: Declarations, image: bytearray, kind: Structure, statement: syntax.Statement
    ) -> None:
        """One assignment after BEGIN."""
        if not isinstance(statement, syntax.Assignment) or isinstance(statement.target, syntax.Address):
            raise declarations.source.error("only `member := constant;` stands in a data block", statement.span)
        target = statement.target
        path = (syntax.Member(target.span, target.name), *target.selectors)
        member, bit = member_at(declarations, kind, path)
        write(image, bit, member, declarations.image(statement.value, member))


def member_at(
    declarations: Declarations,
    kind: Type,
    path: Sequence[syntax.Member | syntax.Index | syntax.Slice],
) -> tuple[Type, int]:
    """Type and bit offset at the end of a path with constant indices."""
    bit = 0
    for step in path:
        if isinstance(step, syntax.Member):
            kind, offset = find_member(declarations.source, kind, step)
        elif isinstance(step, syntax.Index) and isinstance(kind, Array):
            offset = kind.offset(declarations.indices(step, kind))
            kind = kind.element
        else:
            raise declarations.source.error(f"{kind} takes no index or slice here", step.span)
        bit += offset
    return kind, bit


def find_member(source: SourceText, kind: Type, step: syntax.Member) -> tuple[Type, int]:
    """Type and offset of one member. Raises SourceError with the nearest name."""
    if not isinstance(kind, Structure):
        raise source.error(f"{kind} has no member {step.name}", step.span)
    member = kind.member(step.name)
    if member is None:
        hint = did_you_mean(step.name, [member.name for member in kind.fields])
        raise source.error(f"{kind} has no member {step.name}{hint}", step.span)
    return member.type, member.bit


def declared(block: syntax.Block, *kinds: SectionKind) -> list[syntax.Declaration]:
    """All declarations of these kinds, in order."""
    return [d for section in block.sections if section.kind in kinds for d in section.declarations]
