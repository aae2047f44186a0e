"""Makes the core code of one function shorter without changing what it does.

A language of registers lowers instruction by instruction, each with all that it sets: accumulators, status bits. Two
passes remove what nobody sees. The first goes forward and knows at each place what registers and cells hold: a literal,
or the same as another register. The second goes backward and drops what is computed for nobody.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from plcgen.plc.arithmetic import EvaluationError, evaluate
from plcgen.plc.core import (
    FRAME,
    INSTANCE,
    Area,
    Branch,
    Call,
    Cell,
    Compute,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Register,
    Return,
)
from plcgen.plc.liveness import without_dead
from plcgen.plc.operators import Operator, move
from plcgen.plc.types import BOOL, Elementary, Value

Inverses = Mapping[tuple[Operator, Operator], int]
"""(outer, inner): outer(inner(operands)) is the operand of this number."""

Reindexed = TypeVar("Reindexed", bound=Operand)
VOLATILE = (Area.PERIPHERAL_INPUTS, Area.PERIPHERAL_OUTPUTS)


def simplified(function: Function, inverses: Inverses) -> Function:
    """The same function with a shorter body."""
    return without_dead(replace(function, body=_Forward(function, inverses).body()))


def stops(operator: Operator) -> bool:
    return "stop(" in operator.text + operator.repair


# --------------------------------------------------------------------------------------------------- what is known


Origin = tuple[Operator, tuple[Operand, ...]]


@dataclass
class _Facts:
    """What holds at one place: values of registers (by number) and cells, and how registers were computed.

    `mentioned` has every register that some fact names as a value or operand, and perhaps others.
    """

    values: dict[int, Register | Literal] = field(default_factory=dict)
    cells: dict[Cell, Register | Literal] = field(default_factory=dict)
    origins: dict[int, Origin] = field(default_factory=dict)
    mentioned: set[int] = field(default_factory=set)

    def copy(self) -> _Facts:
        return _Facts(dict(self.values), dict(self.cells), dict(self.origins), set(self.mentioned))

    def meet(self, other: _Facts) -> bool:
        """Keep what holds in both; whether anything was lost."""
        before = len(self.values) + len(self.cells) + len(self.origins)
        self.values = {k: v for k, v in self.values.items() if _same(v, other.values.get(k))}
        self.cells = {k: v for k, v in self.cells.items() if _same(v, other.cells.get(k))}
        self.origins = {k: v for k, v in self.origins.items() if other.origins.get(k) == v}
        return len(self.values) + len(self.cells) + len(self.origins) < before

    def of(self, operand: Operand) -> Operand:
        """What an operand is known to hold, else itself."""
        if isinstance(operand, Register):
            return self.values.get(operand.number, operand)
        return self.cells.get(operand, operand) if isinstance(operand, Cell) and self.cells else operand

    def learn_value(self, target: Place, value: Register | Literal) -> None:
        self._mention((value,))
        if isinstance(target, Register):
            self.values[target.number] = value
        else:
            self.cells[target] = value

    def learn_origin(self, target: Register, origin: Origin) -> None:
        self._mention(origin[1])
        self.origins[target.number] = origin

    def _mention(self, operands: Sequence[Operand]) -> None:
        for operand in operands:
            if isinstance(operand, Register):
                self.mentioned.add(operand.number)

    def forget(self, target: Place) -> None:
        """The target is about to change."""
        if isinstance(target, Cell):
            self.cells = {k: v for k, v in self.cells.items() if not _overlap(k, target)}
            return
        self.values.pop(target.number, None)
        self.origins.pop(target.number, None)
        if target.number in self.mentioned:
            self.mentioned.discard(target.number)
            self.values = {k: v for k, v in self.values.items() if v != target}
            self.cells = {k: v for k, v in self.cells.items() if v != target}
            self.origins = {k: v for k, v in self.origins.items() if target not in v[1]}

    def forget_shared(self) -> None:
        """Another function ran: it may have changed all memory but this frame."""
        self.cells = {k: v for k, v in self.cells.items() if k.area == FRAME}


def _same(one: Operand, other: Operand | None) -> bool:
    """Equal literals differ where 0.0 and -0.0 do."""
    if one is other:
        return True
    if one != other:
        return False
    return not isinstance(one, Literal) or repr(one.value) == repr(other.value)  # type: ignore[union-attr]


def _overlap(one: Cell, other: Cell) -> bool:
    if one.area != other.area:
        return _in_blocks(one.area) and _in_blocks(other.area) and INSTANCE in (one.area, other.area)
    if one.index or other.index:
        return True
    return one.bit < other.bit + other.type.bits and other.bit < one.bit + one.type.bits


def _in_blocks(area: Area | str) -> bool:
    """Instance data lies in some data block."""
    return area == INSTANCE or not isinstance(area, Area)


# ----------------------------------------------------------------------------------------------------- forward pass


@dataclass
class _Forward:
    function: Function
    inverses: Inverses
    _arriving: dict[str, _Facts] = field(default_factory=dict)
    _passed: set[str] = field(default_factory=set)
    _lost: bool = False

    def body(self) -> tuple[Instruction, ...]:
        """Walk until what arrives at the labels stays the same; the last walk writes."""
        while True:
            self._lost, self._passed = False, set()
            body = tuple(self._walk())
            if not self._lost:
                return body

    def _walk(self) -> Iterator[Instruction]:
        facts: _Facts | None = _Facts()
        for instruction in self.function.body:
            if isinstance(instruction, Label):
                facts = self._at_label(instruction.name, facts)
                if facts is not None:
                    yield instruction
            elif facts is not None:
                for written in self._step(instruction, facts):
                    yield written
                    if isinstance(written, Jump | Return):
                        facts = None

    def _at_label(self, label: str, falling: _Facts | None) -> _Facts | None:
        if falling is not None:
            self._arrive(label, falling)
        self._passed.add(label)
        arriving = self._arriving.get(label)
        return arriving.copy() if arriving else None

    def _arrive(self, label: str, facts: _Facts) -> None:
        known = self._arriving.get(label)
        if known is None:
            self._arriving[label] = facts.copy()
            self._lost = self._lost or label in self._passed
        elif known.meet(facts):
            self._lost = self._lost or label in self._passed

    def _step(self, instruction: Instruction, facts: _Facts) -> Iterator[Instruction]:
        match instruction:
            case Compute():
                yield from self._compute(instruction, facts)
            case Jump():
                self._arrive(instruction.label, facts)
                yield instruction
            case Branch():
                yield from self._branch(instruction, facts)
            case Call():
                arguments = tuple(map(facts.of, instruction.arguments))
                facts.forget_shared()
                for place in instruction.results:
                    facts.forget(place)
                yield replace(instruction, arguments=arguments)
            case _:
                yield instruction

    def _branch(self, branch: Branch, facts: _Facts) -> Iterator[Instruction]:
        condition, when = facts.of(branch.condition), branch.when
        while isinstance(condition, Register) and condition.number in facts.origins:
            operator, operands = facts.origins[condition.number]
            if operator.name != "NOT" or operator.result is not BOOL:
                break
            condition, when = operands[0], not when
        if isinstance(condition, Literal):
            if bool(condition.value) == when:
                self._arrive(branch.label, facts)
                yield Jump(branch.span, branch.label)
            return
        self._arrive(branch.label, facts)
        yield Branch(branch.span, condition, branch.label, when)

    def _compute(self, compute: Compute, facts: _Facts) -> Iterator[Instruction]:
        operands = tuple(_reindexed(facts.of(operand), facts) for operand in compute.operands)
        operator, operands = self._reduced(compute.operator, operands, facts)
        target = _reindexed(compute.target, facts)
        if operator.name == "MOVE" and operands[0] == target and isinstance(target, Register):
            return
        facts.forget(target)
        self._learn(target, operator, operands, facts)
        yield Compute(compute.span, target, operator, operands)

    def _reduced(
        self, operator: Operator, operands: tuple[Operand, ...], facts: _Facts
    ) -> tuple[Operator, tuple[Operand, ...]]:
        """The operator on known operands: a literal, one of the operands, or as it was."""
        folded: Operand | None = _folded(operator, operands)
        if folded is None:
            folded = _identity(operator, operands)
        if folded is None:
            folded = self._inverted(operator, operands, facts)
        if folded is None:
            return operator, operands
        return move(operator.result), (folded,)

    def _inverted(self, operator: Operator, operands: tuple[Operand, ...], facts: _Facts) -> Operand | None:
        if len(operands) != 1 or not isinstance(operands[0], Register):
            return None
        origin = facts.origins.get(operands[0].number)
        number = self.inverses.get((operator, origin[0])) if origin else None
        return origin[1][number] if origin and number is not None else None

    @staticmethod
    def _learn(target: Place, operator: Operator, operands: tuple[Operand, ...], facts: _Facts) -> None:
        cells = [operand for operand in operands if isinstance(operand, Cell)]
        if operator.name == "MOVE":
            (source,) = operands
            if isinstance(source, Literal | Register) and _is_plain(target):
                facts.learn_value(target, source)
            elif isinstance(source, Cell) and isinstance(target, Register) and _is_plain(source):
                facts.learn_value(source, target)
        elif isinstance(target, Register) and not cells and target not in operands:
            facts.learn_origin(target, (operator, operands))


def _is_plain(place: Place) -> bool:
    """Whether what is written there can be read again."""
    if isinstance(place, Register):
        return True
    return place.index is None and place.area not in VOLATILE and isinstance(place.type, Elementary)


def _reindexed(operand: Reindexed, facts: _Facts) -> Reindexed:
    if not isinstance(operand, Cell) or operand.index is None:
        return operand
    known = facts.of(operand.index)
    return replace(operand, index=known) if isinstance(known, Register) else operand


def _folded(operator: Operator, operands: Sequence[Operand]) -> Literal | None:
    """The result when all operands are literals and computing it is no event."""
    literals = [operand for operand in operands if isinstance(operand, Literal)]
    if len(literals) < len(operands) or not operands or stops(operator) or not isinstance(operator.result, Elementary):
        return None
    if operator.name == "MOVE":
        return literals[0]
    value = _evaluated(operator, [literal.value for literal in literals])
    return None if value is None else Literal(value, operator.result)


_KNOWN: dict[tuple[Operator, str], Value | None] = {}
"""Results of operators on literals; by their spelling, since 1, 1.0 and True are equal."""


def _evaluated(operator: Operator, values: list[Value]) -> Value | None:
    key = (operator, repr(values))
    if key not in _KNOWN:
        try:
            _KNOWN[key] = evaluate(operator, values)
        except EvaluationError:
            _KNOWN[key] = None  # let it happen at run time, where a CPU would see it too
    return _KNOWN[key]


def _identity(operator: Operator, operands: tuple[Operand, ...]) -> Operand | None:
    rule = _IDENTITIES.get(operator.name) if operator.result is BOOL or operator.name == "SEL" else None
    return rule(*operands) if rule and len(operands) == rule.__code__.co_argcount else None


def _and(left: Operand, right: Operand) -> Operand | None:
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Literal):
            return other if one.value else one
    return left if left == right and isinstance(left, Register) else None


def _or(left: Operand, right: Operand) -> Operand | None:
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Literal):
            return one if one.value else other
    return left if left == right and isinstance(left, Register) else None


def _select(condition: Operand, otherwise: Operand, chosen: Operand) -> Operand | None:
    if isinstance(condition, Literal):
        return chosen if condition.value else otherwise
    return chosen if _same(chosen, otherwise) else None


_IDENTITIES: Mapping[str, Callable[..., Operand | None]] = {"AND": _and, "OR": _or, "SEL": _select}
