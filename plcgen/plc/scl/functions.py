"""Standard functions of SCL: their formal parameters and the operator row behind each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class StandardFunction:
    """`repeated` parameters are numbered (IN1, IN2 ...) from `first`; the operator is applied from left to right."""

    operator: str
    parameters: tuple[str, ...] = ("IN",)
    repeated: str | None = None
    first: int = 1

    def names(self, count: int) -> tuple[str, ...]:
        """The formal names of a call with this many arguments."""
        if self.repeated is None:
            return self.parameters
        extra = max(2, count - len(self.parameters))
        return (*self.parameters, *(f"{self.repeated}{self.first + number}" for number in range(extra)))


_ONE_OPERAND = [
    "ABS",
    "SQR",
    "SQRT",
    "EXP",
    "EXPD",
    "LN",
    "LOG",
    "SIN",
    "COS",
    "TAN",
    "ASIN",
    "ACOS",
    "ATAN",
    "ROUND",
    "TRUNC",
    "CEIL",
    "FLOOR",
]

FUNCTIONS = {
    **{name: StandardFunction(name) for name in _ONE_OPERAND},
    **{name: StandardFunction(name, ("IN", "N")) for name in ("SHL", "SHR", "ROL", "ROR")},
    "MIN": StandardFunction("MIN", (), "IN"),
    "MAX": StandardFunction("MAX", (), "IN"),
    "LIMIT": StandardFunction("LIMIT", ("MN", "IN", "MX")),
    "SEL": StandardFunction("SEL", ("G", "IN0", "IN1")),
    "MUX": StandardFunction("SEL", ("K",), "IN", 0),
}
