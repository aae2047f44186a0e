"""Operators as bodies: the same text with its numbers taken out, so that few bodies serve all rows.

A body is Python over slots: `A`, `B`, `C`, `D` stand for operands, `K0`, `K1` ... for the numbers, `R` for the result.
What the virtual machine cannot do has no body; Python evaluates the text of the operator itself then.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from plcgen.plc.operators import Operator
from plcgen.plc.types import BOOL, LINT, REAL, Elementary, Type

MOST_OPERANDS, MOST_NUMBERS = 4, 6
FOREIGN = re.compile(
    r"'%|hex\(|str\(|service_|pointed\(|characters|resized|s5time|_dt_|dt_to|power|expd|lreal|out_of_bounds"
)
"""Python that no body can hold: text, services, whatever is rare."""
SHIFTS = re.compile(r"(?:<<|>>)[^|]*\{1\}")
"""Python shifts by any number, a machine by less than its width: such a body serves constants alone."""
SMALL = ("STATUS", "ILLEGAL", "OUTCOME")
"""Operators on LINT that only compare it, or meet products of 32 bits at the most."""
LARGEST = (1 << 63) - 1
"""Rows whose bounds are beyond it compute in more than 64 bits."""
WIDE = ("LWORD", "ULINT", "DATE_AND_TIME")
"""Types that do not fit 64 bits with a sign."""
NUMBER = re.compile(r"(?<![\w.{])(\d+\.\d+(?:[eE][-+]?\d+)?|\d+(?:[eE][-+]?\d+)?|inf\b)(?![\w}.])")
KINDS = ("overflow", "invalid operand", "division by zero", "conversion out of range")
"""Arithmetic events by their numbers."""
HELPERS = ("special", "over_zero", "wrap", "noted", "narrow", "quotient", "remainder", "to_integer")
APPROXIMATE = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "ln", "log")
ROUNDINGS: Mapping[str, int] = {"half_even": 0, "trunc": 1, "ceil": 2, "floor": 3}


@dataclass(frozen=True)
class Body:
    """Lines of Python; `stops`: where the check holds, Python has to have its say."""

    expression: str
    kinds: str
    """Of the operands and then the result: b, i or f."""
    rounds: bool = False
    check: str = ""
    repair: str = ""

    @property
    def key(self) -> str:
        """What the machine knows it by."""
        return "|".join((self.expression, self.kinds, str(int(self.rounds)), self.check, self.repair))

    @property
    def stops(self) -> bool:
        return "stop(" in self.repair


def kind_of(kind: Type) -> str | None:
    """b for BOOL, f for floats, i for whatever else fits an integer of 64 bits; None for what does not."""
    if not isinstance(kind, Elementary) or kind.name in WIDE:
        return None
    if kind is BOOL:
        return "b"
    return "i" if kind.is_integral else "f"


@lru_cache(maxsize=4096)
def body_of(operator: Operator) -> tuple[Body, tuple[float, ...]] | None:
    """The body of an operator and the numbers it needs; None when it has none."""
    kinds = [kind_of(kind) for kind in (*operator.operands, operator.result)]
    texts = [operator.text, operator.check, operator.repair if "stop(" not in operator.repair else ""]
    if None in kinds or len(kinds) > MOST_OPERANDS + 1 or any(FOREIGN.search(text) for text in texts):
        return None
    if operator.rounds and operator.result is not REAL:
        return None
    if any(kind is LINT for kind in operator.operands) and operator.name not in SMALL:
        return None
    numbers: list[float] = []
    expression, check, repair = (_without_numbers(_named(text), numbers) for text in texts)
    if len(numbers) > MOST_NUMBERS or any(isinstance(number, int) and number > LARGEST for number in numbers):
        return None
    stop = "stop()" if "stop(" in operator.repair else repair
    return Body(expression, "".join(map(str, kinds)), operator.rounds, check, stop), tuple(numbers)


def _named(text: str) -> str:
    """Operands by letters, helpers with the list of events, and everything that is a word by its number."""
    for number, kind in enumerate(KINDS):
        text = text.replace(f"'{kind}'", f"KIND{number}")
    text = text.replace("{site}", "site").replace("{r}", "R")
    for position, letter in enumerate("ABCD"):
        text = text.replace(f"{{{position}}}", letter)
    text = re.sub(rf"\b({'|'.join(HELPERS)})\(", r"\1(E, ", text)
    text = re.sub(rf"\b({'|'.join(APPROXIMATE)})\(", r"approximate_\1(F[FACTOR], ", text)
    text = re.sub(rf"\b({'|'.join(ROUNDINGS)})\b,", lambda match: f"ROUNDING{ROUNDINGS[match[1]]},", text)
    text = re.sub(r"\bcount\(", "count(T, ", text)
    text = re.sub(r"\btrunc\(", "truncated(", text).replace("sqrt(", "square_root(")
    return re.sub(r"\bint\(", "whole(", text)


def _without_numbers(text: str, numbers: list[float]) -> str:
    def taken(match: re.Match[str]) -> str:
        value: float = float(match[1]) if set(match[1]) & set(".einf") else int(match[1])
        if match[1] in ("0", "1", "2", "0.0"):
            return match[1]
        if value not in numbers or type(numbers[numbers.index(value)]) is not type(value):
            numbers.append(value)
        place = next(n for n, known in enumerate(numbers) if known == value and type(known) is type(value))
        return f"{'G' if isinstance(value, float) else 'K'}{place}"

    return NUMBER.sub(taken, text)


_VIEW = {"b": "I", "i": "I", "f": "F"}


def lines(body: Body) -> Sequence[str]:
    """The body as statements of the virtual machine; `a` to `d` are the slots of its operands, `t` of its result."""
    result = body.kinds[-1]
    slots = {letter: f"{_VIEW[kind]}[{letter.lower()}]" for letter, kind in zip("ABCD", body.kinds[:-1], strict=False)}
    slots |= {f"K{n}": f"I[code[pc, {6 + n}]]" for n in range(MOST_NUMBERS)}
    slots |= {f"G{n}": f"F[code[pc, {6 + n}]]" for n in range(MOST_NUMBERS)}
    # Views of the room, made where they are needed, which is rare: each costs time.
    slots |= {"E": "room[EVENTS:SLOTS]", "T": "room[COUNTS:STACK]"}

    # Numba gives a name one type: R is an integer, Q a float.
    slots["R"] = found = "Q" if result == "f" else "R"

    def filled(text: str) -> str:
        return re.sub(r"\b(?:[ABCDERT]|[KG]\d)\b", lambda match: slots[match[0]], text)

    target = f"{'F' if result == 'f' else 'I'}[t]"
    expression = filled(body.expression)
    if body.rounds:
        expression = f"np.float64(np.float32({expression}))"
    if not body.check:
        return [f"{target} = 1 if ({expression}) else 0" if result == "b" else f"{target} = {expression}"]
    repair = ["room[START] = pc", "return REQUEST"] if body.stops else [f"{found} = {filled(body.repair)}"]
    checked = [f"if {filled(body.check)}:", *(f"    {line}" for line in repair)]
    return [f"{found} = {expression}", *checked, f"{target} = {found}"]
