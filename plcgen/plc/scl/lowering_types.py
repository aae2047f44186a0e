"""Types that declarations mean, and the bytes of their initial values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from plcgen.plc.builder import Builder
from plcgen.plc.core import Literal
from plcgen.plc.layout import Member, arrange, write
from plcgen.plc.scl import syntax
from plcgen.plc.scl.lowering_constants import Constants
from plcgen.plc.scl.lowering_values import expect
from plcgen.plc.source import Span
from plcgen.plc.types import BYTE_BITS, Array, Elementary, String, Structure, Type, elementary

if TYPE_CHECKING:
    from plcgen.plc.scl.lowering_declarations import Catalogue

LONGEST_STRING = 254
LARGEST_TYPE = 1 << 24  # bytes
MAX_TYPE_NESTING = 64
"""STEP 7 allows eight levels; this bounds the depth of every pass over a type."""


@dataclass
class Declarations(Constants):
    """Types and constants as one block sees them."""

    catalogue: Catalogue

    def define(self, constants: Sequence[syntax.Constant]) -> None:
        """Take in CONST or VAR CONSTANT, each able to use those before it."""
        self._refuse_twice(constants)
        for constant in constants:
            value = self.constant(constant.value)
            if constant.type is not None:
                kind = self.type_of(constant.type)
                value = expect(self.source, Builder(constant.span), value, kind, constant.value.span)
            self.constants[constant.name.casefold()] = value

    def _refuse_twice(self, declared: Sequence[syntax.Declaration | syntax.Constant]) -> None:
        seen: set[str] = set()
        for item in declared:
            if item.name.casefold() in seen:
                raise self.source.error(f"{item.name} is declared twice", item.span)
            seen.add(item.name.casefold())

    # ------------------------------------------------------------------------------------------------------- types

    def type_of(self, spec: syntax.TypeSpec) -> Type:
        """The type that a declaration means."""
        with self.catalogue.nested() as depth:
            kind = self._type_of(spec) if depth <= MAX_TYPE_NESTING else None
        if kind is None or kind.nesting > MAX_TYPE_NESTING:
            raise self.source.error(f"types nested deeper than {MAX_TYPE_NESTING} levels; flatten them", spec.span)
        return kind

    def _type_of(self, spec: syntax.TypeSpec) -> Type:
        match spec:
            case syntax.StringSpec(length=length):
                return String(LONGEST_STRING) if length is None else self._string(length)
            case syntax.ArraySpec(bounds=bounds, element=element):
                return self._array(spec, tuple(self._bounds(low, high) for low, high in bounds), self.type_of(element))
            case syntax.StructSpec(fields=fields):
                return self._struct(fields, spec.span)
            case syntax.NamedType(name=name):
                return elementary(name) or self.catalogue.structure(self.source, spec)

    def _struct(self, fields: Sequence[syntax.Declaration], span: Span) -> Structure:
        if not fields:
            raise self.source.error("STRUCT has no members; declare one or remove it", span)
        return self.arranged("", [self.members(fields)], span)

    def _string(self, node: syntax.Expression) -> String:
        length = self.integer(node)
        if not 1 <= length <= LONGEST_STRING:
            raise self.source.error(f"STRING length {length} outside 1 .. {LONGEST_STRING}", node.span)
        return String(length)

    def _array(self, spec: syntax.ArraySpec, bounds: tuple[tuple[int, int], ...], element: Type) -> Array:
        kind = Array(bounds, element)
        if isinstance(element, Array):
            inner = str(element).removeprefix("ARRAY[")
            raise self.source.error(
                f"ARRAY OF ARRAY does not exist; write {str(kind).split(']')[0]}, {inner}", spec.span
            )
        self._refuse_large(str(kind), kind.bits, spec.span)
        return kind

    def arranged(self, name: str, sections: Sequence[Sequence[Member]], span: Span) -> Structure:
        """A structure with these members."""
        bits = sum(member.type.bits for section in sections for member in section)
        self._refuse_large(name or "STRUCT", bits, span)
        return arrange(name, sections)

    def _refuse_large(self, name: str, bits: int, span: Span) -> None:
        if bits > LARGEST_TYPE * BYTE_BITS:
            raise self.source.error(f"{name} takes {bits // BYTE_BITS} bytes, more than any CPU has", span)

    def _bounds(self, low: syntax.Expression, high: syntax.Expression) -> tuple[int, int]:
        first, last = self.integer(low), self.integer(high)
        if last < first:
            raise self.source.error(f"array bounds {first} .. {last} run backwards", high.span)
        return first, last

    def members(self, declarations: Sequence[syntax.Declaration]) -> list[Member]:
        """Declarations as members of a structure, with their initial values."""
        self._refuse_twice(declarations)
        return [self._member(declaration, declarations[:number]) for number, declaration in enumerate(declarations)]

    def _member(self, declaration: syntax.Declaration, above: Sequence[syntax.Declaration]) -> Member:
        kind = self.type_of(declaration.type)
        view = self._viewed(declaration, above)
        initial = None if declaration.initial is None else self.image(declaration.initial, kind)
        return Member(declaration.name, kind, initial, view)

    def _viewed(self, declaration: syntax.Declaration, above: Sequence[syntax.Declaration]) -> str | None:
        if declaration.view_of is None:
            return None
        viewed = next((d for d in above if d.name.casefold() == declaration.view_of.casefold()), None)
        if viewed is None:
            message = f"{declaration.view_of} is not declared before its view in this section"
            raise self.source.error(message, declaration.span)
        if declaration.initial is not None:
            message = f"{declaration.name} is a view; give the initial value to {viewed.name}"
            raise self.source.error(message, declaration.initial.span)
        wide, room = self.type_of(declaration.type), self.type_of(viewed.type)
        if wide.bits > room.bits:
            message = f"{declaration.name} has {wide.bits} bits, {viewed.name} beneath it only {room.bits}"
            raise self.source.error(message, declaration.span)
        return viewed.name

    # ---------------------------------------------------------------------------------------------- initial values

    def image(self, node: syntax.InitialValue, kind: Type) -> bytes:
        """The bytes of an initial value."""
        if isinstance(kind, Array):
            return self._array_image(node, kind)
        if isinstance(kind, Structure):
            raise self.source.error(f"an initial value for {kind} is not supported; give its members theirs", node.span)
        if isinstance(node, syntax.InitialList | syntax.Repetition):
            raise self.source.error(f"{kind} takes one initial value; a list is for an ARRAY", node.span)
        operand = expect(self.source, Builder(node.span), self.constant(node), kind, node.span)
        assert isinstance(operand, Literal)
        if isinstance(operand.value, bytes):
            return operand.value
        assert isinstance(kind, Elementary)
        return kind.encode(operand.value)

    def _array_image(self, node: syntax.InitialValue, kind: Array) -> bytes:
        count = self._count(node)
        if count > kind.count:
            raise self.source.error(f"{count} initial values for {kind.count} elements", node.span)
        image = bytearray(kind.initial)
        for offset, value in zip(kind.offsets(), self._spread(node), strict=False):
            write(image, offset, kind.element, self.image(value, kind.element))
        return bytes(image)

    def _count(self, node: syntax.InitialValue) -> int:
        """How many values a list stands for, worked out without spreading it: a factor may be huge."""
        match node:
            case syntax.InitialList(values=values):
                return sum(map(self._count, values))
            case syntax.Repetition(count=count, values=values):
                return self._factor(count) * sum(map(self._count, values))
        return 1

    def _factor(self, node: syntax.Expression) -> int:
        factor = self.integer(node)
        if factor < 1:
            raise self.source.error(f"repetition factor {factor} is below 1", node.span)
        return factor

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
