"""The keys of the method `two-axis`: a table that moves along straight lines, in pulses of an S7-200 SMART."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from plcgen.jobrules import Choice, Quantity, Table, Whole, kind_of, refuse
from plcgen.names import one_of

PULSE_OUTPUTS = ("Q0.0", "Q0.1", "Q0.3")
HIGHEST_V_BYTE = 8191  # of the smallest CPU with pulse outputs
LAST_FIRST_SUBROUTINE = 120  # the program takes eight
LONGEST_MOVE = 2**31 - 1  # pulses
LONGEST_TIMED_INTERRUPT = 0.255  # s, SMB34
_OUTPUT = re.compile(r"Q([0-9]|[12][0-9]|3[01])\.[0-7]")


@dataclass(frozen=True)
class PulsesPerUnit:
    """Pulses per length unit: one number for both axes, or one for x and one for y."""

    low: float = 0.001
    high: float = 1e7

    def validate(self, value: Any) -> tuple[float, float]:
        asked = f"a number, {self.low:g} to {self.high:.0f}, or [x, y]"
        numbers = value if isinstance(value, list) else [value, value]
        if len(numbers) != 2 or any(isinstance(n, bool) or not isinstance(n, (int, float)) for n in numbers):
            refuse(
                f"is no pair of numbers; write {asked}"
                if isinstance(value, list)
                else f"is {kind_of(value)}; write {asked}"
            )
        if not all(self.low <= number <= self.high for number in numbers):
            refuse(f"is out of range; write {asked}")
        return float(numbers[0]), float(numbers[1])

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        number = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {"anyOf": [number, {"type": "array", "items": number, "minItems": 2, "maxItems": 2}]}


@dataclass(frozen=True)
class OutputPair:
    """Two different outputs, of x and of y."""

    known: tuple[str, ...] = ()

    def validate(self, value: Any) -> tuple[str, str]:
        asked = one_of(self.known) if self.known else '"Q0.0" to "Q31.7"'
        if not isinstance(value, list) or len(value) != 2 or not all(isinstance(item, str) for item in value):
            refuse(f"is no pair of outputs; write two of {asked}")
        if any(not self._allowed(item) for item in value):
            refuse(f"names no output for this; write two of {asked}")
        if value[0] == value[1]:
            refuse("names one output twice; write two different ones")
        return value[0], value[1]

    def _allowed(self, output: str) -> bool:
        return output in self.known if self.known else bool(_OUTPUT.fullmatch(output))

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        item: dict[str, Any] = (
            {"enum": list(self.known)} if self.known else {"type": "string", "pattern": f"^{_OUTPUT.pattern}$"}
        )
        return {"type": "array", "items": item, "minItems": 2, "maxItems": 2}


class Move(Table):
    """One move from rest to rest, relative to where the table stands."""

    x: Annotated[float, Quantity("m", -1e5, 1e5)] = Field(description="along x, with its sign", examples=[1.5])
    y: Annotated[float, Quantity("m", -1e5, 1e5)] = Field(description="along y, with its sign", examples=[1.0])


class TwoAxisLimits(Table):
    """Limits of a two-axis table, of the axis that goes farther."""

    max_velocity: Annotated[float, Quantity("m/s", 1e-5, 50.0)] = Field(description="highest speed", examples=[0.015])
    max_acceleration: Annotated[float, Quantity("m/s2", 1e-5, 100.0)] = Field(
        description="highest acceleration", examples=[0.01]
    )
    jerk: Annotated[float, Quantity("m/s3", 1e-5, 1e4)] = Field(description="highest jerk", examples=[0.01])
    pulses_per_unit: Annotated[tuple[float, float], PulsesPerUnit()] = Field(
        description="pulses per length unit, for both axes or [x, y]", examples=[60000]
    )
    ignore_below: Annotated[int, Whole(0, 1_000_000)] = Field(
        0, description="pulses; a component that is shorter counts as zero"
    )
    mode: Annotated[str, Choice(("interrupt", "table"))] = Field(
        "interrupt", description="a segment for each sample from a timed interrupt, or one table for the whole move"
    )
    short_moves: Annotated[str, Choice(("time-optimal", "fixed-jerk-time"))] = Field(
        "time-optimal", description="moves that do not reach every limit: in the shortest time, or as the paper has it"
    )
    v_memory: Annotated[int, Whole(0, HIGHEST_V_BYTE)] = Field(1000, description="first V byte that may be used")
    first_subroutine: Annotated[int, Whole(0, LAST_FIRST_SUBROUTINE)] = Field(
        0, description="number of the first subroutine; the others take the next numbers"
    )
    interrupt_routine: Annotated[int, Whole(0, 127)] = Field(0, description="number of the interrupt routine")
    outputs: Annotated[tuple[str, str], OutputPair(PULSE_OUTPUTS)] = Field(
        ("Q0.0", "Q0.1"), description="pulse outputs of x and y"
    )
    direction_outputs: Annotated[tuple[str, str], OutputPair()] = Field(
        ("Q0.4", "Q0.5"), description="outputs that are 1 while x and y go backwards"
    )
    moves: tuple[Move, ...] = Field(
        description="what verification runs; the PLC program takes any distance at run time"
    )
