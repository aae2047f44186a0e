"""Which data block is open, and which area an address register points to, at each statement.

Memory that an instruction means must be known when it is lowered. Both follow from the statements before it, along
every path; where two paths differ, nothing is known.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile

from plcgen.plc.scl.syntax import Scope as Spelling
from plcgen.plc.stl.s7_constants import POINTER_AREAS
from plcgen.plc.stl.s7_statements import JUMPS
from plcgen.plc.stl.s7_syntax import (
    Absolute,
    BlockName,
    Constant,
    LabelName,
    Operand,
    PointerTo,
    RegisterName,
    Statement,
    Variable,
)

Effect = Callable[["Statement", "Selection", "Surroundings"], "Selection"]

OWN = "own instance"
"""What stands for the instance of the running FB."""

_AREA_NAMES = {code: area for area, code in POINTER_AREAS.items() if area not in ("P", "PI", "PQ")}


@dataclass(frozen=True)
class Selection:
    """Data blocks in the registers DB and DI, areas in AR1 and AR2; None where that is not known."""

    db: str | None = None
    di: str | None = None
    ar1: str | None = None
    ar2: str | None = None

    def meet(self, other: Selection) -> Selection:
        pairs = zip(self._fields(), other._fields(), strict=True)
        return Selection(*(one if one == two else None for one, two in pairs))

    def _fields(self) -> tuple[str | None, ...]:
        return self.db, self.di, self.ar1, self.ar2


@dataclass(frozen=True)
class Surroundings:
    """What a block says beside its statements: names of its own variables that are temporary, and of others."""

    temporaries: frozenset[str]
    own: frozenset[str]
    symbols: Mapping[str, str]

    def data_block(self, variable: Variable) -> str | None:
        """The data block whose member a variable is."""
        if variable.scope is Spelling.LOCAL or not variable.path:
            return None
        name = variable.name.casefold()
        if variable.scope is Spelling.PLAIN and name in self.own | self.temporaries:
            return None
        return self.symbols.get(name, variable.name)


def selections(statements: Sequence[Statement], start: Selection, surroundings: Surroundings) -> list[Selection]:
    """What is selected before each statement."""
    labels = {item.label.name: number for number, item in enumerate(statements) if item.label}
    known: dict[int, Selection] = {0: start}
    pending = [0]
    while pending:
        number = pending.pop()
        if number >= len(statements):
            continue
        after = _after(statements[number], known[number], surroundings)
        for successor in _successors(statements, number, labels):
            before = known.get(successor)
            merged = after if before is None else before.meet(after)
            if merged != before:
                known[successor] = merged
                pending.append(successor)
    for number in range(1, len(statements)):
        if number not in known:  # no path comes here
            known[number] = _after(statements[number - 1], known[number - 1], surroundings)
    return [known[number] for number in range(len(statements))]


def _successors(statements: Sequence[Statement], number: int, labels: Mapping[str, int]) -> list[int]:
    statement = statements[number]
    targets = [
        labels[operand.name]
        for operand in statement.operands
        if isinstance(operand, LabelName) and operand.name in labels
    ]
    if statement.mnemonic in ("BE", "BEU"):
        return []
    if statement.mnemonic == "JU":
        return targets
    listed = len(jump_list(statements, number)) if statement.mnemonic == "JL" else 1
    return [*range(number + 1, number + 1 + listed), *targets]


def jump_list(statements: Sequence[Statement], number: int) -> list[Statement]:
    """The JU that stand behind a JL: where it goes for 0, 1, 2 ..."""
    behind = statements[number + 1 :]
    return list(takewhile(lambda statement: statement.mnemonic == "JU", behind))


def _after(statement: Statement, before: Selection, surroundings: Surroundings) -> Selection:
    selected = before
    for operand in statement.operands if statement.mnemonic not in JUMPS else ():
        name = _named_block(operand, surroundings)
        selected = replace(selected, db=name) if name else selected
    effect = _EFFECTS.get(statement.mnemonic)
    return effect(statement, selected, surroundings) if effect else selected


def _named_block(operand: Operand, surroundings: Surroundings) -> str | None:
    if isinstance(operand, Absolute) and operand.data_block:
        return surroundings.symbols.get(operand.data_block.casefold(), operand.data_block)
    return surroundings.data_block(operand) if isinstance(operand, Variable) else None


def _open(statement: Statement, before: Selection, surroundings: Surroundings) -> Selection:
    operand = statement.operands[0] if statement.operands else None
    if isinstance(operand, BlockName):
        register = "di" if operand.kind == "DI" else "db"
        return replace(before, **{register: operand.name})
    if isinstance(operand, Variable):
        return replace(before, db=surroundings.symbols.get(operand.name.casefold(), operand.name))
    return before


def _call(_statement: Statement, before: Selection, _surroundings: Surroundings) -> Selection:
    """What CALL is compiled to opens data blocks of its parameters and uses AR1."""
    return replace(before, db=None, ar1=None)


def _load_pointer(register: str, other: str) -> Effect:
    def effect(statement: Statement, before: Selection, surroundings: Surroundings) -> Selection:
        operand = statement.operands[0] if statement.operands else None
        area = getattr(before, other) if isinstance(operand, RegisterName) else _area(operand, surroundings)
        return replace(before, **{register: area})

    return effect


def _area(operand: Operand | None, surroundings: Surroundings) -> str | None:
    if isinstance(operand, Constant):
        return _AREA_NAMES.get(int(operand.value) >> 24)
    if isinstance(operand, PointerTo):
        return "L" if operand.variable.name.casefold() in surroundings.temporaries else "DI"
    return None


_EFFECTS: Mapping[str, Effect] = {
    "OPN": _open,
    "CDB": lambda _statement, before, _surroundings: replace(before, db=before.di, di=before.db),
    "CALL": _call,
    "LAR1": _load_pointer("ar1", "ar2"),
    "LAR2": _load_pointer("ar2", "ar1"),
    "CAR": lambda _statement, before, _surroundings: replace(before, ar1=before.ar2, ar2=before.ar1),
}
