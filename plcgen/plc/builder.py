"""Collects the instructions of one function while a language is lowered: fresh registers, labels, folded constants."""

from __future__ import annotations

from dataclasses import dataclass, field

from plcgen.plc.arithmetic import EvaluationError, evaluate
from plcgen.plc.core import (
    FRAME,
    Branch,
    Call,
    Cell,
    Compute,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Register,
    Return,
)
from plcgen.plc.operators import Operator, move
from plcgen.plc.source import Span
from plcgen.plc.types import BYTE_BITS, WORD_BITS, Elementary, Type, align


@dataclass
class Builder:
    """The function being written; `span` is the source of what is emitted next."""

    span: Span
    body: list[Instruction] = field(default_factory=list)
    temporaries: list[Register] = field(default_factory=list)
    frame_bits: int = 0
    _registers: int = 0
    _labels: int = 0

    def register(self, kind: Elementary, name: str = "") -> Register:
        """A fresh register; whoever asks sets it before use."""
        self._registers += 1
        return Register(self._registers, kind, name)

    def temporary(self, kind: Elementary, name: str) -> Register:
        """A register that the source can read before it writes it; filled at entry."""
        self.temporaries.append(self.register(kind, name))
        return self.temporaries[-1]

    def frame(self, kind: Type) -> Cell:
        """Fresh memory in the frame."""
        start = align(self.frame_bits, kind.alignment)
        self.frame_bits = start + kind.bits
        return Cell(FRAME, start, kind)

    @property
    def frame_bytes(self) -> int:
        return align(self.frame_bits, WORD_BITS) // BYTE_BITS

    def label(self) -> str:
        self._labels += 1
        return f"L{self._labels}"

    def emit(self, instruction: Instruction) -> None:
        self.body.append(instruction)

    def compute(self, operator: Operator, *operands: Operand) -> Operand:
        """The operator's result: a literal when all operands are, else a fresh register (frame for a structure)."""
        literals = [operand.value for operand in operands if isinstance(operand, Literal)]
        if len(literals) == len(operands):
            try:
                return Literal(evaluate(operator, literals), operator.result)
            except EvaluationError:
                pass  # let it happen at run time, where a CPU would see it too
        kind = operator.result
        target = self.register(kind) if isinstance(kind, Elementary) else self.frame(kind)
        self.emit(Compute(self.span, target, operator, operands))
        return target

    def assign(self, target: Place, operator: Operator, *operands: Operand) -> None:
        self.emit(Compute(self.span, target, operator, operands))

    def move(self, target: Place, source: Operand) -> None:
        """target := source; a result just computed goes straight into the target."""
        last = self.body[-1] if self.body else None
        if self._is_fresh(source) and isinstance(last, Compute) and last.target == source:
            self.body[-1] = Compute(last.span, target, last.operator, last.operands)
        else:
            self.assign(target, move(target.type), source)

    @staticmethod
    def _is_fresh(source: Operand) -> bool:
        """An expression's register: read once, by whoever computed it."""
        return isinstance(source, Register) and not source.name

    def place(self, label: str) -> None:
        self.emit(Label(self.span, label))

    def jump(self, label: str, passes: int | None = None) -> None:
        self.emit(Jump(self.span, label, passes))

    def branch(self, condition: Operand, label: str, when: bool) -> None:
        self.emit(Branch(self.span, condition, label, when))

    def call(
        self,
        function: str,
        instance: Cell | None = None,
        arguments: tuple[Operand, ...] = (),
        results: tuple[Place, ...] = (),
    ) -> None:
        self.emit(Call(self.span, function, instance, arguments, results))

    def leave(self) -> None:
        self.emit(Return(self.span))
