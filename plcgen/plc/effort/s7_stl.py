"""Steps of S7-300 STL: one for each statement."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from plcgen.plc.effort.steps import Routine, Routines, Step
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_statements import JUMPS
from plcgen.plc.types import DINT, DWORD, REAL, TIME

CODE = (BlockKind.FB, BlockKind.FC, BlockKind.OB)

_COMPARED = ("==", "<>", ">=", "<=", ">", "<")
KINDS: Mapping[str, str] = {
    **{relation + kind: "integer compare" for relation in _COMPARED for kind in "ID"},
    **{f"{relation}R": "real compare" for relation in _COMPARED},
    **dict.fromkeys(("+R", "-R", "*R", "SQR"), "real"),
    "/R": "real quotient",
    **dict.fromkeys(("*I", "*D"), "integer product"),
    **dict.fromkeys(("/I", "/D", "MOD"), "integer quotient"),
    **dict.fromkeys(("+I", "-I", "+D", "-D", "NEGI", "NEGD", "INVI", "INVD", "INC", "DEC", "NEGR", "ABS"), "integer"),
    "SQRT": "root",
    "SIN": "sine",
    **dict.fromkeys(("EXP", "LN", "COS", "TAN", "ASIN", "ACOS", "ATAN"), "function"),
    **dict.fromkeys(("ITD", "DTR", "RND", "TRUNC", "RND+", "RND-", "BTI", "BTD", "ITB", "DTB"), "conversion"),
    **dict.fromkeys(("A(", "AN(", "O(", "ON(", "X(", "XN(", ")", "SET", "CLR", "NOT", "SAVE"), "bit"),
    **dict.fromkeys(("A", "AN", "O", "ON", "X", "XN", "=", "S", "R", "FP", "FN"), "bit"),
    "T": "transfer",
    "+": "constant",
    **dict.fromkeys(("OPN", "LAR1", "LAR2", "TAR1", "TAR2", "+AR1", "+AR2", "L"), "load"),
    **dict.fromkeys(("BE", "BEU", "BEC"), "return"),
    **dict.fromkeys(("CALL", "UC", "CC"), "call"),
    **dict.fromkeys(JUMPS, "jump"),
}
"""The class of each instruction; the others work on the accumulators alone."""
_WIDE = (DINT, DWORD, REAL, TIME)
_ENDS = ("JU", "JL", "BE", "BEU")
"""What never goes on to the next statement; behind JL its list follows."""


def stl_routines(blocks: Sequence[syntax.Block]) -> Routines:
    """The code blocks of a program, by their names."""
    code = [block for block in blocks if block.declaration.kind in CODE]
    return {block.name: Routine(block.source, tuple(_steps(block.statements))) for block in code}


def _steps(statements: Sequence[syntax.Statement]) -> Iterator[Step]:
    for place, statement in enumerate(statements):
        yield Step(
            statement.span,
            tuple(_work(statement)),
            statement.label.name if statement.label else None,
            _target(statement),
            statement.mnemonic not in _ENDS or statement.mnemonic == "JL",
            _callee(statement),
            _passes(statements, place) if statement.mnemonic == "LOOP" else None,
        )


def _work(statement: syntax.Statement) -> Iterator[str]:
    kind = KINDS.get(statement.mnemonic, "accumulator")
    wide = any(isinstance(item, syntax.Constant) and item.kind in _WIDE for item in statement.operands)
    yield "constant" if kind == "load" and wide else kind
    for _argument in statement.arguments:
        yield from ("load", "transfer")


def _target(statement: syntax.Statement) -> str | None:
    first = statement.operands[0] if statement.mnemonic in JUMPS and statement.operands else None
    return first.name if isinstance(first, syntax.LabelName) else None


def _callee(statement: syntax.Statement) -> str | None:
    called = statement.operands[0] if statement.mnemonic in ("CALL", "UC", "CC") and statement.operands else None
    return called.name if isinstance(called, syntax.BlockName | syntax.Variable) else None


def _passes(statements: Sequence[syntax.Statement], place: int) -> int | None:
    """Of LOOP, when a constant is loaded right before its label."""
    label = _target(statements[place])
    start = next((n for n, item in enumerate(statements) if item.label and item.label.name == label), 0)
    before = statements[start - 1] if start else None
    counted = before.operands[0] if before and before.mnemonic == "L" and before.operands else None
    return int(counted.value) - 1 if isinstance(counted, syntax.Constant) else None
