"""The instructions of an S7-300 by their English mnemonics, one row each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from plcgen.plc.core import Literal
from plcgen.plc.stl import s7_arithmetic as arithmetic
from plcgen.plc.stl import s7_flow as flow
from plcgen.plc.stl import s7_logic as logic
from plcgen.plc.stl import s7_syntax as syntax
from plcgen.plc.stl.s7_arithmetic import (
    compare,
    convert,
    count_up,
    from_bcd,
    function,
    invert,
    negative,
    quiet_real,
    real,
    rotate,
    rounding,
    shift,
    to_bcd,
    whole,
    word_logic,
)
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_flow import load_pointer, move_pointer, on_br, on_codes, on_rlo, store_pointer
from plcgen.plc.stl.s7_logic import and_, inverted, or_, xor_
from plcgen.plc.stl.s7_places import bit_of, bit_place
from plcgen.plc.stl.s7_registers import AR1, AR2, FALSE, TRUE
from plcgen.plc.types import DINT, DWORD, INT, REAL, WORD, Elementary

Slot = Callable[[Code, syntax.Operand], object]
"""What an instruction takes as its operand."""


@dataclass(frozen=True)
class Row:
    """One mnemonic; `emit(code[, operand])` writes its core. With `optional` it stands without operand too."""

    emit: Callable[..., None]
    slot: Slot | None = None
    optional: bool = False


def written(_code: Code, operand: syntax.Operand) -> syntax.Operand:
    """The operand as it stands there."""
    return operand


def number(lowest: int, highest: int) -> Slot:
    """A plain number."""

    def read(code: Code, operand: syntax.Operand) -> int:
        value = operand.value if isinstance(operand, syntax.Constant) and operand.kind is INT else None
        if not isinstance(value, int) or not lowest <= value <= highest:
            word, text = code.statement.word, code.text(operand)
            raise code.error(f"{word} {text}: write a number from {lowest} to {highest}", operand)
        return value

    return read


def constant(*kinds: Elementary) -> Slot:
    """A constant of one of these types."""

    def read(code: Code, operand: syntax.Operand) -> Literal:
        if not isinstance(operand, syntax.Constant) or operand.kind not in kinds:
            wanted = " or ".join(_EXAMPLES[kind] for kind in kinds)
            raise code.error(f"{code.statement.word} {code.text(operand)}: write a constant such as {wanted}", operand)
        return Literal(operand.value, operand.kind)

    return read


_EXAMPLES: Mapping[Elementary, str] = {INT: "5", DINT: "L#5", WORD: "W#16#FF", DWORD: "DW#16#FF"}


def bit(emit: Callable[..., None]) -> Row:
    return Row(emit, bit_of)


def place(emit: Callable[..., None]) -> Row:
    return Row(emit, bit_place)


def jump(emit: Callable[..., None]) -> Row:
    return Row(emit, flow.label_of)


def operand(emit: Callable[..., None]) -> Row:
    return Row(emit, written)


def optional(emit: Callable[..., None], slot: Slot = written) -> Row:
    return Row(emit, slot, optional=True)


def either(alone: Callable[[Code], None], combine: Callable[..., None]) -> Row:
    """O: by itself another instruction than with a bit."""
    return optional(lambda code, *bits: combine(code, *bits) if bits else alone(code), bit_of)


MNEMONICS: Mapping[str, Row] = {
    # bit logic
    "A": bit(and_),
    "AN": bit(inverted(and_)),
    "O": either(logic.and_before_or, or_),
    "ON": bit(inverted(or_)),
    "X": bit(xor_),
    "XN": bit(inverted(xor_)),
    "A(": Row(logic.open_bracket),
    "AN(": Row(logic.open_bracket),
    "O(": Row(logic.open_bracket),
    "ON(": Row(logic.open_bracket),
    "X(": Row(logic.open_bracket),
    "XN(": Row(logic.open_bracket),
    ")": Row(logic.close_bracket),
    "=": place(logic.assign),
    "S": place(logic.set_),
    "R": place(logic.reset),
    "FP": place(logic.edge(rising=True)),
    "FN": place(logic.edge(rising=False)),
    "SET": Row(logic.constant(TRUE)),
    "CLR": Row(logic.constant(FALSE)),
    "NOT": Row(logic.negate),
    "SAVE": Row(logic.save),
    # load and transfer
    "L": operand(flow.load),
    "T": operand(flow.transfer),
    "TAK": Row(arithmetic.swap_accumulators),
    "PUSH": Row(arithmetic.push),
    "POP": Row(arithmetic.pop),
    "CAW": Row(arithmetic.swap_bytes),
    "CAD": Row(arithmetic.reverse_bytes),
    "INC": Row(count_up("+"), number(0, 255)),
    "DEC": Row(count_up("-"), number(0, 255)),
    "LAR1": optional(load_pointer(AR1)),
    "LAR2": optional(load_pointer(AR2)),
    "TAR1": optional(store_pointer(AR1)),
    "TAR2": optional(store_pointer(AR2)),
    "+AR1": optional(move_pointer(AR1)),
    "+AR2": optional(move_pointer(AR2)),
    "CAR": Row(flow.swap_pointers),
    "OPN": operand(flow.open_block),
    "CDB": Row(flow.swap_blocks),
    # integers of 16 bits
    "+I": Row(whole("+", INT)),  # ACCU1-L := ACCU2-L + ACCU1-L
    "-I": Row(whole("-", INT)),  # ACCU1-L := ACCU2-L - ACCU1-L
    "*I": Row(arithmetic.product),  # ACCU1 := ACCU2-L * ACCU1-L
    "/I": Row(arithmetic.quotient),  # ACCU1-L := ACCU2-L / ACCU1-L, ACCU1-H := rest
    "==I": Row(compare("=", INT)),  # RLO := ACCU2-L == ACCU1-L
    "<>I": Row(compare("<>", INT)),
    ">I": Row(compare(">", INT)),
    "<I": Row(compare("<", INT)),
    ">=I": Row(compare(">=", INT)),
    "<=I": Row(compare("<=", INT)),
    "NEGI": Row(negative(INT)),
    "INVI": Row(invert(WORD)),
    # integers of 32 bits
    "+D": Row(whole("+", DINT)),  # ACCU1 := ACCU2 + ACCU1
    "-D": Row(whole("-", DINT)),
    "*D": Row(whole("*", DINT)),
    "/D": Row(arithmetic.double_quotient),
    "MOD": Row(arithmetic.rest),
    "==D": Row(compare("=", DINT)),
    "<>D": Row(compare("<>", DINT)),
    ">D": Row(compare(">", DINT)),
    "<D": Row(compare("<", DINT)),
    ">=D": Row(compare(">=", DINT)),
    "<=D": Row(compare("<=", DINT)),
    "NEGD": Row(negative(DINT)),
    "INVD": Row(invert(DWORD)),
    "+": Row(arithmetic.add_constant, constant(INT, DINT)),  # ACCU1 := ACCU1 + constant
    # REAL
    "+R": Row(real("+")),  # ACCU1 := ACCU2 + ACCU1
    "-R": Row(real("-")),
    "*R": Row(real("*")),
    "/R": Row(real("/")),
    "==R": Row(compare("=", REAL)),  # RLO := ACCU2 == ACCU1
    "<>R": Row(compare("<>", REAL)),
    ">R": Row(compare(">", REAL)),
    "<R": Row(compare("<", REAL)),
    ">=R": Row(compare(">=", REAL)),
    "<=R": Row(compare("<=", REAL)),
    "NEGR": Row(quiet_real("NEG")),
    "ABS": Row(quiet_real("ABS")),
    **{name: Row(function(name)) for name in ["SQR", "SQRT", "EXP", "LN", "SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN"]},
    # conversions
    "ITD": Row(convert(INT, DINT)),
    "DTR": Row(convert(DINT, REAL)),
    "RND": Row(rounding("ROUND")),  # half to even
    "TRUNC": Row(rounding("TRUNC")),
    "RND+": Row(rounding("CEIL")),
    "RND-": Row(rounding("FLOOR")),
    "BTI": Row(from_bcd("BTI")),
    "BTD": Row(from_bcd("BTD")),
    "ITB": Row(to_bcd("ITB", INT)),
    "DTB": Row(to_bcd("DTB", DINT)),
    # word logic
    "AW": optional(word_logic("AND", WORD), constant(WORD)),
    "OW": optional(word_logic("OR", WORD), constant(WORD)),
    "XOW": optional(word_logic("XOR", WORD), constant(WORD)),
    "AD": optional(word_logic("AND", DWORD), constant(DWORD)),
    "OD": optional(word_logic("OR", DWORD), constant(DWORD)),
    "XOD": optional(word_logic("XOR", DWORD), constant(DWORD)),
    # shifts
    "SLW": optional(shift("SLW"), number(0, 15)),
    "SRW": optional(shift("SRW"), number(0, 15)),
    "SSI": optional(shift("SSI"), number(0, 15)),
    "SLD": optional(shift("SLD"), number(0, 32)),
    "SRD": optional(shift("SRD"), number(0, 32)),
    "SSD": optional(shift("SSD"), number(0, 32)),
    "RLD": optional(shift("RLD"), number(0, 32)),
    "RRD": optional(shift("RRD"), number(0, 32)),
    "RLDA": Row(rotate(left=True)),
    "RRDA": Row(rotate(left=False)),
    # jumps
    "JU": jump(flow.jump),
    "JC": jump(on_rlo(True)),
    "JCN": jump(on_rlo(False)),
    "JCB": jump(on_rlo(True, saves=True)),
    "JNB": jump(on_rlo(False, saves=True)),
    "JBI": jump(on_br(True)),
    "JNBI": jump(on_br(False)),
    "JO": jump(flow.on_overflow),
    "JOS": jump(flow.on_stored_overflow),
    "JZ": jump(on_codes("==0")),
    "JN": jump(on_codes("<>0")),
    "JP": jump(on_codes(">0")),
    "JM": jump(on_codes("<0")),
    "JPZ": jump(on_codes(">=0")),
    "JMZ": jump(on_codes("<=0")),
    "JUO": jump(on_codes("UO")),
    "JL": jump(flow.distribute),
    "LOOP": jump(flow.loop),
    "BE": Row(flow.leave),
    "BEU": Row(flow.leave),
    "BEC": Row(flow.leave_if),
    "NOP": operand(flow.nothing),
    "BLD": operand(flow.nothing),
}
CALLS = ("CALL", "UC", "CC")
"""Rows of their own: see `s7_calls`."""
UNSUPPORTED: Mapping[str, str] = {
    **dict.fromkeys(["SP", "SE", "SD", "SS", "SF", "FR", "LC"], "timers are not supported; count scans in a variable"),
    **dict.fromkeys(["CU", "CD"], "counters are not supported; count in a variable"),
    **dict.fromkeys(["MCR(", ")MCR", "MCRA", "MCRD"], "the master control relay is not supported; use jumps"),
    **dict.fromkeys(["ENT", "LEAVE"], "an S7-300 has two accumulators; this is for an S7-400"),
}
