"""Bodies of operators as LLVM: the same text that the virtual machine runs, for processors.

What notes an event, or has no words here, is `Beyond`: such a row is left to the virtual machine.
"""

from __future__ import annotations

import ast
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

INT, REAL, BOOL = "i64", "double", "i1"


@dataclass(frozen=True)
class Value:
    """A number of LLVM: `kind` is its type."""

    name: str
    kind: str


class BeyondError(Exception):
    """The virtual machine has to do it."""


@dataclass
class Text:
    """Lines of a function. `leave` is a block that hands a row over, from wherever the condition holds."""

    lines: list[str] = field(default_factory=list)
    block: str = "entry"
    names: int = 0
    row: int = 0
    exits: list[tuple[int, str]] = field(default_factory=list)
    """Rows that are handed over, and the blocks from which."""

    def value(self, kind: str, text: str) -> Value:
        self.names += 1
        self.lines.append(f"  %v{self.names} = {text}")
        return Value(f"%v{self.names}", kind)

    def leave_if(self, condition: Value) -> None:
        self.names += 1
        self.exits.append((self.row, self.block))
        self.block = f"n{self.names}"
        self.lines.append(f"  br i1 {condition.name}, label %leave, label %{self.block}")
        self.lines.append(f"{self.block}:")

    def leave(self) -> None:
        """Always; what follows is never come to but by a jump."""
        self.names += 1
        self.exits.append((self.row, self.block))
        self.block = f"n{self.names}"
        self.lines += ["  br label %leave", f"{self.block}:"]


def whole_number(value: int) -> Value:
    return Value(str(value), INT)


def real_number(value: float) -> Value:
    return Value(f"0x{struct.unpack('>Q', struct.pack('>d', value))[0]:016X}", REAL)


@lru_cache(maxsize=1024)
def parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


BEYOND = ("special", "wrap", "narrow", "noted", "over_zero")
"""They note events; whatever meets one is left to the virtual machine."""
WHOLE: Mapping[type[ast.operator], str] = {
    ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.BitAnd: "and", ast.BitOr: "or", ast.BitXor: "xor",
    ast.LShift: "shl", ast.RShift: "ashr",
}  # fmt: skip
FLOATING: Mapping[type[ast.operator], str] = {
    ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv",
}  # fmt: skip
COMPARED: Mapping[type[ast.cmpop], tuple[str, str]] = {
    ast.Lt: ("slt", "olt"), ast.LtE: ("sle", "ole"), ast.Gt: ("sgt", "ogt"), ast.GtE: ("sge", "oge"),
    ast.Eq: ("eq", "oeq"), ast.NotEq: ("ne", "une"),
}  # fmt: skip
ROUNDINGS = ("llvm.rint.f64", "llvm.trunc.f64", "llvm.ceil.f64", "llvm.floor.f64")


class Expression:
    """Python expressions over named values, written into a text."""

    def __init__(self, text: Text, names: Mapping[str, Value], counted: Callable[[Value], None]) -> None:
        self.text, self.names, self.counted = text, dict(names), counted

    def of(self, node: ast.expr) -> Value:
        """Raises BeyondError."""
        match node:
            case ast.Name(id=name) if name in self.names:
                return self.names[name]
            case ast.Constant(value=bool(value)):
                return Value(str(value).lower(), BOOL)
            case ast.Constant(value=int(value)):
                return whole_number(value)
            case ast.Constant(value=float(value)):
                return real_number(value)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return self._not(self.truth(self.of(operand)))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return self._negative(self.of(operand))
            case ast.BinOp(left=left, op=operator, right=right):
                return self._binary(self.of(left), operator, self.of(right))
            case ast.Compare(left=left, ops=operators, comparators=others):
                return self._compared([left, *others], operators)
            case ast.BoolOp(op=operator, values=values):
                return self._joined(operator, values)
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._chosen(self.truth(self.of(test)), body, other)
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return self._called(name, arguments)
        raise BeyondError

    def truth(self, value: Value) -> Value:
        if value.kind == BOOL:
            return value
        compare, zero = ("icmp ne", "0") if value.kind == INT else ("fcmp une", "0.0")
        return self.text.value(BOOL, f"{compare} {value.kind} {value.name}, {zero}")

    def as_kind(self, value: Value, kind: str) -> Value:
        if value.kind == kind:
            return value
        if kind == BOOL:
            return self.truth(value)
        if value.kind == BOOL:
            value = self.text.value(INT, f"zext i1 {value.name} to i64")
        if kind == INT and value.kind == REAL:
            raise BeyondError
        return value if kind == INT else self.text.value(REAL, f"sitofp i64 {value.name} to double")

    def _not(self, value: Value) -> Value:
        return self.text.value(BOOL, f"xor i1 {value.name}, true")

    def _negative(self, value: Value) -> Value:
        if value.kind == REAL:
            return self.text.value(REAL, f"fneg double {value.name}")
        return self.text.value(INT, f"sub i64 0, {self.as_kind(value, INT).name}")

    def _alike(self, values: Sequence[Value], least: str = INT) -> list[Value]:
        """In one type: floats where one is a float, else whole numbers."""
        kind = REAL if any(value.kind == REAL for value in values) else least
        return [self.as_kind(value, kind) for value in values]

    def _binary(self, left: Value, operator: ast.operator, right: Value) -> Value:
        left, right = self._alike([left, right], REAL if isinstance(operator, ast.Div) else INT)
        found = (FLOATING if left.kind == REAL else WHOLE).get(type(operator))
        if found is None:
            raise BeyondError
        return self.text.value(left.kind, f"{found} {left.kind} {left.name}, {right.name}")

    def _compared(self, nodes: Sequence[ast.expr], operators: Sequence[ast.cmpop]) -> Value:
        values = [self.of(node) for node in nodes]
        found = [self._pair(*pair) for pair in zip(values, operators, values[1:], strict=False)]
        return self._all("and", found)

    def _pair(self, left: Value, operator: ast.cmpop, right: Value) -> Value:
        if type(operator) not in COMPARED:
            raise BeyondError
        whole, floating = COMPARED[type(operator)]
        left, right = self._alike([left, right])
        compare = f"fcmp {floating}" if left.kind == REAL else f"icmp {whole}"
        return self.text.value(BOOL, f"{compare} {left.kind} {left.name}, {right.name}")

    def _joined(self, operator: ast.boolop, nodes: Sequence[ast.expr]) -> Value:
        """As truth, which is all that is asked of it: no body has `and` or `or` where a number is wanted."""
        return self._all("and" if isinstance(operator, ast.And) else "or", [self.truth(self.of(n)) for n in nodes])

    def _all(self, join: str, values: Sequence[Value]) -> Value:
        found = values[0]
        for value in values[1:]:
            found = self.text.value(BOOL, f"{join} i1 {found.name}, {value.name}")
        return found

    def _chosen(self, test: Value, body: ast.expr, other: ast.expr) -> Value:
        if _is_beyond(other):
            self.text.leave_if(self._not(test))
            return self.of(body)
        values = [self.of(body), self.of(other)]
        same = values if values[0].kind == values[1].kind else self._alike(values)
        return self._select(test, *same)

    def _select(self, test: Value, left: Value, right: Value) -> Value:
        pair = f"{left.kind} {left.name}, {right.kind} {right.name}"
        return self.text.value(left.kind, f"select i1 {test.name}, {pair}")

    # ------------------------------------------------------------------------------------------------------- calls

    def _called(self, name: str, arguments: Sequence[ast.expr]) -> Value:
        match name, arguments:
            case "count", [_, kind]:
                self.counted(self.of(kind))
                return Value("false", BOOL)
            case (("min" | "max"), [_, _]):
                left, right = self._alike([self.of(argument) for argument in arguments])
                if left.kind != INT:
                    raise BeyondError
                takes_right = self._pair(right, ast.Lt() if name == "min" else ast.Gt(), left)
                return self._select(takes_right, right, left)
            case (("quotient" | "remainder"), [_, dividend, divisor, _]):
                return self._divided("sdiv" if name == "quotient" else "srem", self.of(dividend), self.of(divisor))
            case "to_integer", [_, rounding, number, minimum, bits, _]:
                return self._rounded(rounding, self.of(number), minimum, bits)
            case _, [argument]:
                return self._simple(name, self.of(argument))
        raise BeyondError

    def _simple(self, name: str, value: Value) -> Value:
        text = self.text
        match name, value.kind:
            case "abs", "i64":
                negative = self._pair(value, ast.Lt(), whole_number(0))
                return self._select(negative, self._negative(value), value)
            case "abs", "double":
                return text.value(REAL, f"call double @llvm.fabs.f64(double {value.name})")
            case "square_root", "double":
                return text.value(REAL, f"call double @llvm.sqrt.f64(double {value.name})")
            case (("whole" | "truncated"), "double"):
                return text.value(INT, f"fptosi double {value.name} to i64")
            case "whole", _:
                return self.as_kind(value, INT)
            case "bits_to_real", "i64":
                return real_of(text, value)
            case "real_to_bits", "double":
                return bits_of(text, value)
        raise BeyondError

    def _divided(self, how: str, dividend: Value, divisor: Value) -> Value:
        """Division by zero is an event, and that of the least number by -1 a trap of the processor."""
        next_to = self.text.value(INT, f"add i64 {divisor.name}, 1")
        self.text.leave_if(self.text.value(BOOL, f"icmp ult i64 {next_to.name}, 2"))
        return self.text.value(INT, f"{how} i64 {dividend.name}, {divisor.name}")

    def _rounded(self, rounding: ast.expr, number: Value, minimum: ast.expr, bits: ast.expr) -> Value:
        """Out of range is an event; NaN is out of every range."""
        if not isinstance(rounding, ast.Name) or number.kind != REAL:
            raise BeyondError
        function = ROUNDINGS[int(rounding.id.removeprefix("ROUNDING"))]
        whole = self.text.value(REAL, f"call double @{function}(double {number.name})")
        least = self.as_kind(self.of(minimum), REAL)
        range_ = self.as_kind(self.text.value(INT, f"shl i64 1, {self.of(bits).name}"), REAL)
        end = self.text.value(REAL, f"fadd double {least.name}, {range_.name}")
        inside = self._all("and", [self._pair(least, ast.LtE(), whole), self._pair(whole, ast.Lt(), end)])
        self.text.leave_if(self._not(inside))
        return self.text.value(INT, f"fptosi double {whole.name} to i64")


def _is_beyond(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in BEYOND


def real_of(text: Text, bits: Value) -> Value:
    word = text.value("i32", f"trunc i64 {bits.name} to i32")
    short = text.value("float", f"bitcast i32 {word.name} to float")
    return text.value(REAL, f"fpext float {short.name} to double")


def bits_of(text: Text, real: Value) -> Value:
    short = text.value("float", f"fptrunc double {real.name} to float")
    word = text.value("i32", f"bitcast float {short.name} to i32")
    return text.value(INT, f"zext i32 {word.name} to i64")


def rounded(text: Text, real: Value) -> Value:
    short = text.value("float", f"fptrunc double {real.name} to float")
    return text.value(REAL, f"fpext float {short.name} to double")
