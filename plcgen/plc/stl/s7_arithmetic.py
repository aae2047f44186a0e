"""Numbers of the S7-300: what each kind of instruction does with accumulators and status bits."""

from __future__ import annotations

from collections.abc import Callable

from plcgen.plc.core import Literal, Operand
from plcgen.plc.stl.s7_code import Code
from plcgen.plc.stl.s7_operators import (
    BCD,
    BY_ZERO,
    HIGHEST,
    IS_UNORDERED,
    KEEPS,
    LOW_BYTE,
    LOW_WORDS,
    LOWEST,
    NO_BCD,
    NOT_ZERO,
    ORDER,
    OUTSIDE_DINT,
    PRODUCT,
    PRODUCT_SIGN,
    QUIET_BYTES,
    QUIET_SUM,
    QUOTIENT_AND_REST,
    QUOTIENT_OVERFLOW,
    QUOTIENT_SIGN,
    REST_SIGN,
    ROTATE_LEFT,
    ROTATE_RIGHT,
    SHIFTED_OUT,
    SHIFTS,
    SIGN,
    SWAP_DOUBLE,
    SWAP_WORD,
    negation_overflow,
    real_overflow,
    row,
    row_of_real,
    whole_overflow,
)
from plcgen.plc.stl.s7_registers import ACCU1, ACCU2, CC, FALSE, FC, OR, OS, OV, RLO, TRUE
from plcgen.plc.types import BOOL, BYTE, DINT, DWORD, INT, REAL, WORD, Elementary

Emit = Callable[..., None]


def put_low(code: Code, value: Operand) -> None:
    """A word into the low end of ACCU1, a whole double word into all of it."""
    kind = value.type
    if kind in LOW_WORDS:
        code.put(ACCU1, code.compute(LOW_WORDS[kind], ACCU1, value))  # type: ignore[index]
    else:
        code.result(value)


# ------------------------------------------------------------------------------------------------------------ REAL


def real(symbol: str) -> Emit:
    """+R -R *R /R: ACCU1 := ACCU2 op ACCU1"""

    def emit(code: Code) -> None:
        operands = code.view(REAL, ACCU2), code.view(REAL)
        _real_result(code, symbol, *operands)

    return emit


def function(symbol: str) -> Emit:
    """SQRT, SIN and the like: ACCU1 := function(ACCU1)"""
    return lambda code: _real_result(code, symbol, code.view(REAL))


def _real_result(code: Code, symbol: str, *operands: Operand) -> None:
    result = code.compute(row_of_real(symbol), *operands)
    code.result(result)
    code.status(code.compute(SIGN[REAL], result), code.compute(real_overflow(symbol), *operands, result))


def quiet_real(symbol: str) -> Emit:
    """NEGR, ABS: no status bit changes."""
    return lambda code: code.result(code.compute(row(symbol, REAL), code.view(REAL)))


# ----------------------------------------------------------------------------------------------------- INT and DINT


def whole(symbol: str, kind: Elementary) -> Emit:
    """+I -I +D -D *D: ACCU1 := ACCU2 op ACCU1, wrapped. A sum has the sign of what is left of it, a product its own."""

    def emit(code: Code) -> None:
        operands = code.view(kind, ACCU2), code.view(kind)
        result = code.compute(row(symbol, kind, kind), *operands)
        put_low(code, result)
        sign = code.compute(PRODUCT_SIGN[kind], *operands) if symbol == "*" else code.compute(SIGN[kind], result)
        code.status(sign, code.compute(whole_overflow(symbol, kind), *operands))

    return emit


def product(code: Code) -> None:
    """*I: ACCU1 := ACCU2-L * ACCU1-L"""
    operands = code.view(INT, ACCU2), code.view(INT)
    code.result(code.compute(PRODUCT, *operands))
    code.status(code.compute(PRODUCT_SIGN[INT], *operands), code.compute(whole_overflow("*", INT), *operands))


def quotient(code: Code) -> None:
    """/I: ACCU1-L := ACCU2-L / ACCU1-L, ACCU1-H := the rest"""
    operands = code.view(INT, ACCU2), code.view(INT)
    code.put(ACCU1, code.compute(QUOTIENT_AND_REST, *operands, ACCU1))
    code.status(code.compute(QUOTIENT_SIGN[INT], *operands), code.compute(QUOTIENT_OVERFLOW[INT], *operands))


def double_quotient(code: Code) -> None:
    """/D: ACCU1 := ACCU2 / ACCU1"""
    operands = code.view(DINT, ACCU2), code.view(DINT)
    code.result(code.compute(row("DIV", DINT, DINT), *operands))
    code.status(code.compute(QUOTIENT_SIGN[DINT], *operands), code.compute(QUOTIENT_OVERFLOW[DINT], *operands))


def rest(code: Code) -> None:
    """MOD: ACCU1 := rest of ACCU2 / ACCU1"""
    operands = code.view(DINT, ACCU2), code.view(DINT)
    result = code.compute(row("MOD", DINT, DINT), *operands)
    code.result(result)
    code.status(code.compute(REST_SIGN, *operands, result), code.compute(BY_ZERO, operands[1]))


def negative(kind: Elementary) -> Emit:
    """NEGI, NEGD"""

    def emit(code: Code) -> None:
        operand = code.view(kind)
        result = code.compute(row("NEG", kind), operand)
        put_low(code, result)
        code.status(code.compute(SIGN[kind], result), code.compute(negation_overflow(kind), operand))

    return emit


def add_constant(code: Code, constant: Literal) -> None:
    """+ n: no status bit changes."""
    kind = constant.type
    assert kind in (INT, DINT)
    put_low(code, code.compute(QUIET_SUM[kind], code.view(kind), constant))


def count_up(symbol: str) -> Callable[[Code, int], None]:
    """INC n, DEC n: the lowest byte alone"""

    def emit(code: Code, amount: int) -> None:
        byte = code.compute(QUIET_BYTES[symbol], code.view(BYTE), Literal(amount, BYTE))
        code.put(ACCU1, code.compute(LOW_BYTE, ACCU1, byte))

    return emit


# ------------------------------------------------------------------------------------------------------- comparison


def compare(symbol: str, kind: Elementary) -> Emit:
    """==I and the like: RLO := ACCU2 op ACCU1. With a NaN nothing holds."""

    def emit(code: Code) -> None:
        operands = code.view(kind, ACCU2), code.view(kind)
        code.put(RLO, code.compute(row(symbol, kind, kind), *operands))
        overflow = code.compute(IS_UNORDERED, *operands) if kind is REAL else FALSE
        code.status(code.compute(ORDER[kind], *operands), overflow)
        code.put(FC, TRUE)
        code.put(OR, FALSE)

    return emit


# ------------------------------------------------------------------------------------------------------ conversions


def convert(source: Elementary, target: Elementary) -> Emit:
    """ITD, DTR: no status bit changes."""
    return lambda code: code.result(code.compute(row(f"{source}_TO_{target}", source), code.view(source)))


def rounding(symbol: str) -> Emit:
    """RND and the like: what no DINT holds stays as it is."""

    def emit(code: Code) -> None:
        operand = code.view(REAL)
        code.result(code.compute(row(symbol, REAL), operand))
        overflow = code.compute(OUTSIDE_DINT, operand)
        for register in (OV, OS):  # neither is reset when all goes well
            code.put(register, code.compute(row("OR", BOOL, BOOL), register, overflow))

    return emit


def from_bcd(name: str) -> Emit:
    """BTI, BTD: ACCU1 := number of its digits"""
    return lambda code: put_low(code, code.compute(BCD[name], code.view(DWORD)))


def to_bcd(name: str, kind: Elementary) -> Emit:
    """ITB, DTB: ACCU1 := digits of its number; OV and OS when there are too many"""

    def emit(code: Code) -> None:
        operand = code.view(kind)
        put_low(code, code.compute(BCD[name], operand))
        overflow = code.compute(NO_BCD[kind], operand)
        code.put(OV, overflow)
        code.put(OS, code.compute(row("OR", BOOL, BOOL), OS, overflow))

    return emit


def invert(kind: Elementary) -> Emit:
    """INVI, INVD"""
    return lambda code: put_low(code, code.compute(row("NOT", kind), code.view(kind)))


# ------------------------------------------------------------------------------------------------ word logic, shifts


def word_logic(symbol: str, kind: Elementary) -> Emit:
    """AW and the like: ACCU1 := ACCU1 op (ACCU2 or a constant)"""

    def emit(code: Code, constant: Literal | None = None) -> None:
        other = constant or code.view(kind, ACCU2)
        result = code.compute(row(symbol, kind, kind), code.view(kind), other)
        put_low(code, result)
        code.status(code.compute(NOT_ZERO[kind], result))

    return emit


def shift(name: str) -> Emit:
    """SLW and the like: by a constant, or by ACCU2-LL"""
    operator = SHIFTS[name]
    kind = operator.operands[0]

    def emit(code: Code, count: int | None = None) -> None:
        assert isinstance(kind, Elementary)
        by = code.view(BYTE, ACCU2) if count is None else Literal(count, BYTE)
        value = code.view(kind)
        put_low(code, code.compute(operator, value, by))
        code.put(CC, code.compute(SHIFTED_OUT[name], value, by, CC))
        code.put(OV, code.compute(KEEPS, by, OV))

    return emit


def rotate(left: bool) -> Emit:
    """RLDA, RRDA: by one bit, through CC1"""

    def emit(code: Code) -> None:
        value = code.view(DWORD)
        code.put(ACCU1, code.compute(ROTATE_LEFT if left else ROTATE_RIGHT, value, CC))
        code.status(code.compute(HIGHEST if left else LOWEST, value))

    return emit


# ----------------------------------------------------------------------------------------------------- accumulators


def swap_accumulators(code: Code) -> None:
    """TAK"""
    first = code.taken(ACCU1)
    code.put(ACCU1, ACCU2)
    code.put(ACCU2, first)


def push(code: Code) -> None:
    """PUSH: ACCU2 := ACCU1"""
    code.put(ACCU2, ACCU1)


def pop(code: Code) -> None:
    """POP: ACCU1 := ACCU2"""
    code.put(ACCU1, ACCU2)


def swap_bytes(code: Code) -> None:
    """CAW: the bytes of ACCU1-L"""
    put_low(code, code.compute(SWAP_WORD, code.view(WORD)))


def reverse_bytes(code: Code) -> None:
    """CAD: the bytes of ACCU1"""
    code.result(code.compute(SWAP_DOUBLE, code.view(DWORD)))
