"""What is declared, before any statement runs: constants, types, interfaces of blocks, memory of data blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from plcgen.plc.core import DataBlock
from plcgen.plc.layout import write
from plcgen.plc.scl import syntax
from plcgen.plc.scl.dialects import PARAMETER_TYPES, UNSUPPORTED_TYPES
from plcgen.plc.scl.functions import is_absent
from plcgen.plc.scl.lowering_types import Declarations
from plcgen.plc.scl.syntax import BlockKind, NamedType, SectionKind
from plcgen.plc.scl.walk import find
from plcgen.plc.source import SourceText
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import Array, Structure, Type

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


class Catalogue:
    """All blocks of a program by absolute name, and what they declare; each worked out once, when first asked for."""

    def __init__(self, blocks: Sequence[syntax.Block], symbols: Mapping[str, str]) -> None:
        self.symbols = {name.casefold(): "".join(absolute.split()) for name, absolute in symbols.items()}
        self.blocks: dict[str, syntax.Block] = {}
        self._interfaces: dict[str, Interface] = {}
        self._structures: dict[str, Structure] = {}
        self._pending: set[str] = set()
        self._depth = 0
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

    @contextmanager
    def nested(self) -> Iterator[int]:
        """Enter a type within the one being worked out; gives the depth."""
        self._depth += 1
        yield self._depth
        self._depth -= 1

    def structure(self, source: SourceText, spec: syntax.NamedType) -> Structure:
        """The structure of a UDT, or the instance data of an FB."""
        block = self.find(spec.name, BlockKind.UDT, BlockKind.FB)
        if spec.name.upper() in PARAMETER_TYPES | UNSUPPORTED_TYPES:
            raise source.error(f"type {spec.name} is not supported", spec.span)
        if block is None and is_absent(spec.name):
            message = (
                f"{spec.name} is not supported yet; a FUNCTION_BLOCK {spec.name} in your source can stand in for it"
            )
            raise source.error(message, spec.span)
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
        if block.kind is BlockKind.UDT and block.structure and not block.structure.fields:
            raise block.source.error(f"{block.name} has no members; declare one or remove it", block.span)
        if block.structure is not None:
            sections = [declarations.members(block.structure.fields)]
        else:
            sections = [declarations.members(declared(block, kind)) for kind in STORED]
        return declarations.arranged(self.name_of(block), sections, block.span)

    # -------------------------------------------------------------------------------------------------- interfaces

    def interface(self, block: syntax.Block) -> Interface:
        """What callers see of an FB, FC or OB."""
        if block.name not in self._interfaces:
            _refuse_parameters_of_ob(block)
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

    def is_part(self, interface: Interface) -> bool:
        """Whether some block declares a multi-instance of an FB."""
        specs = (spec for block in self.blocks.values() for spec in find((block.sections, block.structure), NamedType))
        return any(self.absolute(spec.name).casefold() == interface.name.casefold() for spec in specs)

    def owner(self, kind: Type) -> Interface | None:
        """The FB of an instance or of an ARRAY of instances."""
        return self.instance_interface(kind.element if isinstance(kind, Array) else kind)

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


def _refuse_parameters_of_ob(block: syntax.Block) -> None:
    """Nobody calls an OB. TIA hands some of them inputs, which no machine here can do."""
    section = next((s for s in block.sections if s.kind in PARAMETERS and s.declarations), None)
    if block.kind is BlockKind.OB and section:
        word = section.kind.value
        message = f"an OB has no {word} here; its start information lies in the first 20 bytes of VAR_TEMP"
        raise block.source.error(message, section.span)


def declared(block: syntax.Block, *kinds: SectionKind) -> list[syntax.Declaration]:
    """All declarations of these kinds, in order."""
    return [d for section in block.sections if section.kind in kinds for d in section.declarations]
