"""Statements: assignments, branches and loops."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import singledispatchmethod

from plcgen.plc.core import Literal, Operand, Place
from plcgen.plc.operators import resolve
from plcgen.plc.scl import syntax
from plcgen.plc.scl.lowering_calls import Calls
from plcgen.plc.scl.lowering_values import expect, type_of
from plcgen.plc.source import Span
from plcgen.plc.types import INTEGERS, Elementary, Type


@dataclass
class Loop:
    """Where CONTINUE and EXIT of the innermost loop go."""

    repeat: str
    leave: str


@dataclass
class Ranges:
    """Labels of one CASE, in ascending order."""

    starts: list[int] = field(default_factory=list)
    labels: list[range] = field(default_factory=list)

    def add(self, new: range) -> range | None:
        """Take in a label; one that it overlaps, if any."""
        position = bisect_left(self.starts, new.stop)
        if position and self.labels[position - 1].stop > new.start:
            return self.labels[position - 1]
        self.starts.insert(position, new.start)
        self.labels.insert(position, new)
        return None


def _spelt(label: range) -> str:
    return f"{label.start}" if len(label) == 1 else f"{label.start} .. {label.stop - 1}"


def _passes(first: Operand, end: Operand, step: Operand) -> int | None:
    """How often a FOR runs, where all its bounds are constants."""
    numbers = [int(bound.value) for bound in (first, end, step) if isinstance(bound, Literal)]
    if len(numbers) < 3 or not numbers[2]:
        return None
    start, last, stride = numbers
    return len(range(start, last + (1 if stride > 0 else -1), stride))


class Statements(Calls):
    """Lowers the body of a block."""

    _loops: list[Loop]

    def body(self) -> None:
        """The whole body, with the return at its end."""
        self._loops = []
        self.statements(self.block.body)
        self.builder.span = Span(max(self.block.span.start, self.block.span.end - 1), self.block.span.end)
        self.builder.leave()

    def statements(self, nodes: Sequence[syntax.Statement]) -> None:
        for node in nodes:
            self.builder.span = node.span
            self.statement(node)

    @singledispatchmethod
    def statement(self, node: syntax.Statement) -> None:
        """One statement."""
        raise self.source.error(f"{type(node).__name__} is not supported", node.span)

    # ------------------------------------------------------------------------------------------------ single lines

    @statement.register
    def _(self, node: syntax.Assignment) -> None:
        value = self.value(node.value)
        target = self.place(node.target)
        if node.operator is not None:
            value = self._combine(node.operator, [target, value], node.span)
        self._refuse_instance(target, node)
        operand = expect(self.source, self.builder, value, target.type, node.value.span)
        self.builder.span = node.span
        self.builder.move(target, operand)

    def _refuse_instance(self, target: Place, node: syntax.Assignment) -> None:
        owner = self.catalogue.owner(target.type)
        if owner is not None:
            message = f"an instance of {owner.name} cannot be assigned; assign its members one by one"
            raise self.source.error(message, node.target.span)

    @statement.register
    def _(self, node: syntax.CallStatement) -> None:
        if self.standard_call(node.call) is None:
            self.block_call(node.call)

    @statement.register
    def _(self, node: syntax.Region) -> None:
        self.statements(node.body)

    @statement.register
    def _(self, _node: syntax.Return) -> None:
        self.builder.leave()

    @statement.register
    def _(self, node: syntax.Exit) -> None:
        self.builder.jump(self._loop("EXIT", node.span).leave)

    @statement.register
    def _(self, node: syntax.Continue) -> None:
        self.builder.jump(self._loop("CONTINUE", node.span).repeat)

    def _loop(self, word: str, span: Span) -> Loop:
        if not self._loops:
            raise self.source.error(f"{word} outside a loop", span)
        return self._loops[-1]

    # ---------------------------------------------------------------------------------------------------- branches

    @statement.register
    def _(self, node: syntax.If) -> None:
        end = self.builder.label()
        for branch in node.branches:
            otherwise = self.builder.label()
            condition = self.condition(branch.condition)
            self.builder.span = branch.condition.span
            self.builder.branch(condition, otherwise, when=False)
            self.statements(branch.body)
            if branch is not node.branches[-1] or node.otherwise:
                self.builder.jump(end)
            self.builder.place(otherwise)
        self.statements(node.otherwise)
        self.builder.place(end)

    @statement.register
    def _(self, node: syntax.Case) -> None:
        selector = self.value(node.selector)
        kind = type_of(selector)
        if kind not in INTEGERS:
            raise self.source.error(f"CASE needs an INT, not {kind}", node.selector.span)
        selector = self._kept(expect(self.source, self.builder, selector, kind, node.selector.span))
        end = self.builder.label()
        bodies = [(self.builder.label(), branch) for branch in node.branches]
        taken = Ranges()
        for label, branch in bodies:
            for case in branch.labels:
                self._test_case(selector, case, label, taken)
        self.statements(node.otherwise)
        self.builder.jump(end)
        for label, branch in bodies:
            self.builder.place(label)
            self.statements(branch.body)
            self.builder.jump(end)
        self.builder.place(end)

    def _kept(self, operand: Operand) -> Operand:
        """The value in a register of its own, evaluated once."""
        assert isinstance(operand.type, Elementary)
        register = self.builder.register(operand.type)
        self.builder.move(register, operand)
        return register

    def _test_case(self, selector: Operand, case: syntax.CaseLabel, label: str, taken: Ranges) -> None:
        low = self._case_constant(case.low, selector.type)
        self.builder.span = case.low.span
        self._take(taken, low, case)
        if case.high is None:
            self.builder.branch(self._row("=", selector, low), label, when=True)
            return
        high = self._case_constant(case.high, selector.type)
        inside = self._row("AND", self._row(">=", selector, low), self._row("<=", selector, high))
        self.builder.branch(inside, label, when=True)

    def _take(self, taken: Ranges, low: Literal, case: syntax.CaseLabel) -> None:
        high = self._case_constant(case.high, low.type) if case.high else low
        new = range(int(low.value), int(high.value) + 1)
        span = case.low.span.to(case.high.span) if case.high else case.low.span
        if not new:
            raise self.source.error(f"CASE label {low} .. {high} runs backwards", span)
        old = taken.add(new)
        if old is not None:
            raise self.source.error(f"CASE label {_spelt(new)} overlaps {_spelt(old)} above; remove one", span)

    def _case_constant(self, node: syntax.Expression, kind: Type) -> Literal:
        operand = self.operand(node, kind)
        if not isinstance(operand, Literal):
            raise self.source.error("a CASE label must be a constant", node.span)
        return operand

    def _row(self, symbol: str, *operands: Operand) -> Operand:
        row = resolve(symbol, [operand.type for operand in operands])
        assert row is not None, f"{symbol} of lowered operands"
        return self.builder.compute(row, *operands)

    # ------------------------------------------------------------------------------------------------------- loops

    @statement.register
    def _(self, node: syntax.While) -> None:
        loop = self._enter()
        self.builder.place(loop.repeat)
        condition = self.condition(node.condition)
        self.builder.branch(condition, loop.leave, when=False)
        self.statements(node.body)
        self.builder.span = node.span
        self.builder.jump(loop.repeat)
        self._leave(loop)

    @statement.register
    def _(self, node: syntax.Repeat) -> None:
        loop, start = self._enter(), self.builder.label()
        self.builder.place(start)
        self.statements(node.body)
        self.builder.place(loop.repeat)
        condition = self.condition(node.until)
        self.builder.span = node.until.span
        self.builder.branch(condition, start, when=False)
        self._leave(loop)

    @statement.register
    def _(self, node: syntax.For) -> None:
        """End and step are evaluated once; the sign of the step says which way the comparison goes."""
        variable = self.place(node.variable)
        if variable.type not in INTEGERS:
            raise self.source.error(f"FOR needs an INT or DINT variable, not {variable.type}", node.variable.span)
        first = self.operand(node.start, variable.type)
        self.builder.move(variable, first)
        end = self._constant_or_kept(node.end, variable.type)
        step = self._constant_or_kept(node.step, variable.type) if node.step else Literal(1, variable.type)
        loop, start = self._enter(), self.builder.label()
        self.builder.span = node.span
        self.builder.place(start)
        self.builder.branch(self._is_past(variable, end, step), loop.leave, when=True)
        self.statements(node.body)
        self.builder.span = node.span
        self.builder.place(loop.repeat)
        self.builder.move(variable, self._row("+", variable, step))
        self.builder.jump(start, _passes(first, end, step))
        self._leave(loop)

    def _constant_or_kept(self, node: syntax.Expression, kind: Type) -> Operand:
        operand = self.operand(node, kind)
        return operand if isinstance(operand, Literal) else self._kept(operand)

    def _is_past(self, variable: Operand, end: Operand, step: Operand) -> Operand:
        above = self._row(">", variable, end)
        if isinstance(step, Literal) and step.value >= 0:  # type: ignore[operator]
            return above
        below = self._row("<", variable, end)
        if isinstance(step, Literal):
            return below
        downwards = self._row("<", step, Literal(0, step.type))
        return self._row("SEL", downwards, above, below)

    def _enter(self) -> Loop:
        loop = Loop(self.builder.label(), self.builder.label())
        self._loops.append(loop)
        return loop

    def _leave(self, loop: Loop) -> None:
        self._loops.remove(loop)
        self.builder.place(loop.leave)
