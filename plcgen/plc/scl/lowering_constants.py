"""Constants of a block: their values, whole numbers, indices of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from plcgen.plc.builder import Builder
from plcgen.plc.core import Literal
from plcgen.plc.scl import syntax
from plcgen.plc.scl.lowering_values import Untyped, Value, combine, expect, literal
from plcgen.plc.scl.walk import left_chain
from plcgen.plc.source import SourceText, Span
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import DINT, Array


@dataclass
class Constants:
    """Constants as one block sees them, by name in lower case."""

    source: SourceText
    constants: dict[str, Value] = field(default_factory=dict, kw_only=True)

    def constant(self, node: syntax.InitialValue) -> Value:
        """The value of a constant expression."""
        match node:
            case syntax.Literal():
                return literal(self.source, node)
            case syntax.Variable(name=name, selectors=()):
                if name.casefold() in self.constants:
                    return self.constants[name.casefold()]
                hint = did_you_mean(name, self.constants)
                raise self.source.error(f"{name} is no constant{hint}", node.span)
            case syntax.Unary(operator="+", operand=operand):
                return self.constant(operand)
            case syntax.Unary(operator=symbol, operand=operand):
                return self._folded("NEG" if symbol == "-" else symbol, [self.constant(operand)], node.span)
            case syntax.Binary():
                first, chain = left_chain(node)
                value = self.constant(first)
                for link in chain:
                    value = self._folded(link.operator, [value, self.constant(link.right)], link.operator_span)
                return value
        raise self.source.error("not a constant expression", node.span)

    def _folded(self, symbol: str, values: Sequence[Value], span: Span) -> Value:
        value = combine(self.source, Builder(span), symbol, values, span)
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
