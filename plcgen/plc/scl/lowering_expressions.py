"""Expressions: constants, variables, operators and standard functions."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from functools import reduce
from typing import TypeVar

from plcgen.plc.core import Literal, Operand
from plcgen.plc.operators import conversion_named, move
from plcgen.plc.scl import syntax
from plcgen.plc.scl.functions import FUNCTIONS, StandardFunction
from plcgen.plc.scl.lowering_places import Places
from plcgen.plc.scl.lowering_values import Untyped, Value, combine, expect, literal
from plcgen.plc.scl.walk import find, left_chain
from plcgen.plc.source import Span
from plcgen.plc.types import BOOL, Elementary, Type

AnyValue = TypeVar("AnyValue", bound=Value)


class Expressions(Places):
    """Lowers expressions. Every operand is evaluated, those of AND and OR too."""

    @abstractmethod
    def block_call(self, node: syntax.Call) -> Value | None:
        """Call a block; the value of an FC."""

    def value(self, node: syntax.Expression) -> Value:
        match node:
            case syntax.Literal():
                return literal(self.source, node)
            case syntax.Variable() | syntax.Address():
                return self.read(node)
            case syntax.Unary(operator="+", operand=operand):
                return self.value(operand)
            case syntax.Unary(operator=symbol, operand=operand):
                return self._combine("NEG" if symbol == "-" else symbol, [self.value(operand)], node.span)
            case syntax.Binary():
                return self._chained(node)
            case syntax.Call():
                return self._called(node)

    def operand(self, node: syntax.Expression, kind: Type) -> Operand:
        """The value of an expression as this type."""
        return expect(self.source, self.builder, self.value(node), kind, node.span)

    def condition(self, node: syntax.Expression) -> Operand:
        return self.operand(node, BOOL)

    def _chained(self, node: syntax.Binary) -> Value:
        first, chain = left_chain(node)
        left = self.value(first)
        for link in chain:
            self._refuse_absent(link.operator, link.operator_span)
            left = self.taken(left) if calls_block([link.right]) else left
            left = self._combine(link.operator, [left, self.value(link.right)], link.operator_span)
        return left

    def values(self, nodes: Sequence[syntax.Expression]) -> list[Value]:
        """Values from left to right; one that a later call could change is taken before that call."""
        return [
            self.taken(self.value(node)) if calls_block(nodes[number + 1 :]) else self.value(node)
            for number, node in enumerate(nodes)
        ]

    def taken(self, value: AnyValue) -> AnyValue | Operand:
        """A copy of the value as it is now."""
        if isinstance(value, Literal | Untyped) or not isinstance(value.type, Elementary):
            return value
        return self.builder.compute(move(value.type), value)

    def _refuse_absent(self, name: str, span: Span) -> None:
        if name in self.dialect.absent:
            raise self.source.error(f"no {name} in {self.dialect.title}; write {self.dialect.absent[name]}", span)

    def _combine(self, symbol: str, values: Sequence[Value], span: Span) -> Value:
        self.builder.span = span
        return combine(self.source, self.builder, symbol, values, span)

    # -------------------------------------------------------------------------------------------------- functions

    def _called(self, node: syntax.Call) -> Value:
        value = self.standard_call(node)
        if value is None:
            value = self.block_call(node)
        if value is None:
            raise self.source.error(f"{node.callee.name} gives no value", node.span)
        return value

    def standard_call(self, node: syntax.Call) -> Value | None:
        """The value of a standard or conversion function; None when the name is none."""
        name = node.callee.name.upper()
        if node.callee.scope is not syntax.Scope.PLAIN or node.callee.selectors or self.local(node.callee):
            return None
        self._refuse_absent(name, node.span)
        if name in FUNCTIONS:
            return self._standard(name, FUNCTIONS[name], node)
        row = conversion_named(name)
        if row is None:
            return None
        (argument,) = self.arguments(node, ("IN",))
        return self._combine(row.name, [argument], node.callee.span)

    def _standard(self, name: str, function: StandardFunction, node: syntax.Call) -> Value:
        names = function.names(len(node.arguments))
        if name == "MUX" and any((argument.name or "").upper() == "INELSE" for argument in node.arguments):
            names = (*names[:-1], "INELSE")
        values = self.arguments(node, names)
        span = node.callee.span
        if name == "MUX":
            return self._choose(values[0], values[1:], span)
        if function.repeated:
            return reduce(lambda left, right: self._combine(function.operator, [left, right], span), values)
        return self._combine(function.operator, values, span)

    def _choose(self, selector: Value, choices: Sequence[Value], span: Span) -> Value:
        """MUX: choice K, the last one (INELSE, if there is one) when K is beyond."""
        chosen = choices[-1]
        for number, choice in reversed(list(enumerate(choices[:-1]))):
            hit = self._combine("=", [selector, Untyped(number)], span)
            chosen = self._combine("SEL", [hit, chosen, choice], span)
        return chosen

    def arguments(self, node: syntax.Call, names: tuple[str, ...]) -> list[Value]:
        """Argument values of a standard function in the order of its formal names."""
        positional = [argument for argument in node.arguments if argument.name is None]
        if len(node.arguments) != len(names) or (positional and len(positional) < len(node.arguments)):
            wanted = f"{', '.join(names)}" if len(names) > 1 else "one argument"
            raise self.source.error(f"{node.callee.name} takes {wanted}", node.span)
        if positional:
            return self.values([argument.value for argument in positional])
        given = {(argument.name or "").upper(): argument for argument in node.arguments}
        missing = [name for name in names if name not in given]
        if missing:
            raise self.source.error(f"{node.callee.name} needs {missing[0]}", node.span)
        return self.values([given[name].value for name in names])


def calls_block(nodes: Sequence[syntax.Expression]) -> bool:
    """Whether code that may write to memory runs below these nodes."""
    names = (call.callee.name.upper() for call in find(tuple(nodes), syntax.Call))
    return any(name not in FUNCTIONS and conversion_named(name) is None for name in names)
