"""What a value of a job file may be: numbers with a unit and a range, words, names, tables.

Validators end their sentence only ("is out of range; write ..."): the reader of the file puts key, value and place
in front of it. Ranges and defaults that carry a length are given in metres and follow the job's `length_unit`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NoReturn

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, ValidationInfo, model_validator
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from plcgen.names import name_fault, nearest, one_of
from plcgen.targets import TARGETS

UNITS_PER_METRE = {"m": 1, "cm": 100, "mm": 1000}
# A length, speed or time that is neither zero nor at least this is a slip of the finger.
NEXT_TO_NOTHING = 1e-6


@dataclass(frozen=True)
class Context:
    """What the keys of the file depend on: None where the file gives no usable value."""

    length_unit: str | None
    name: str | None


@dataclass(frozen=True)
class Quantity:
    """A finite number within limits. A unit that begins with m is a length in it, and scales."""

    unit: str
    low: float
    high: float

    def scale(self, length_unit: str | None) -> int:
        return UNITS_PER_METRE[length_unit] if length_unit and self.unit.startswith("m") else 1

    def unit_in(self, length_unit: str | None) -> str:
        return self.unit.replace("m", length_unit or "m", 1) if self.unit.startswith("m") else self.unit

    def validate(self, value: Any, info: ValidationInfo) -> float:
        unit = info.context.length_unit if info.context else "m"
        scale = self.scale(unit)
        low, high = self.low * scale, self.high * scale
        asked = f"{plain(low)} to {plain(high)} {self.unit_in(unit)}".rstrip()
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            quotes = " without quotes" if isinstance(value, str) else ""
            refuse(f"is {kind_of(value)}; write a number{quotes}, {asked}")
        if isinstance(value, float) and not math.isfinite(value):
            refuse(f"is no finite number; write {asked}")
        if low == 0 < value < NEXT_TO_NOTHING:
            refuse(f"is next to nothing; write {asked}, and if not 0 at least {plain(NEXT_TO_NOTHING)}")
        if value <= 0 < low:
            refuse(f"is not positive; write {asked}")
        if not low <= value <= high:
            refuse(f"is out of range; write {asked}")
        return float(value)

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        largest = max(UNITS_PER_METRE, key=lambda unit: self.scale(unit))
        scale = self.scale(largest)
        minimum, maximum = min(self.low, self.low * scale), self.high * scale
        return {"type": "number", "minimum": minimum, "maximum": maximum, "unit": self.unit}


@dataclass(frozen=True)
class Whole:
    """A whole number within limits."""

    low: int
    high: int

    def validate(self, value: Any) -> int:
        if not isinstance(value, int) or isinstance(value, bool):
            refuse(f"is {kind_of(value)}; write a whole number, {self.low} to {self.high}")
        if not self.low <= value <= self.high:
            refuse(f"is out of range; write {self.low} to {self.high}")
        return value

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.low, "maximum": self.high}


@dataclass(frozen=True)
class Choice:
    """One of a few words."""

    words: tuple[str, ...]

    def validate(self, value: Any) -> str:
        if not isinstance(value, str):
            refuse(f"is {kind_of(value)}; write {one_of(self.words)}")
        if value not in self.words:
            near = nearest(value, self.words)
            refuse(f"is unknown; write {one_of((near,) if near else self.words)}")
        return value

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "enum": list(self.words)}


class NameRule:
    """A name that any of the targets takes; its length is judged later, when the targets are known."""

    @staticmethod
    def validate(value: Any) -> str:
        if not isinstance(value, str):
            refuse(f"is {kind_of(value)}; write a name in quotes")
        fault = name_fault(value)
        if fault:
            refuse(fault)
        return str(value)

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        longest = max(target.max_identifier for target in TARGETS.values())
        return {"type": "string", "pattern": "^[A-Za-z](_?[A-Za-z0-9])*$", "maxLength": longest}


def whole_milliseconds(seconds: float) -> float:
    """A cyclic interrupt is set in whole milliseconds."""
    count = seconds * 1000
    if abs(count - round(count)) > 1e-6:
        below = math.floor(count)
        refuse(f"is no whole number of milliseconds; write {below / 1000:.3f} or {(below + 1) / 1000:.3f}")
    return round(count) / 1000


class Table(BaseModel):
    """One table of the file. Unknown keys are refused; defaults of lengths are scaled to the length unit."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _scale_defaults(cls, given: Any, info: ValidationInfo) -> Any:
        if not isinstance(given, dict) or not info.context:
            return given
        return {**cls._scaled_defaults(info.context.length_unit), **given}

    @classmethod
    def _scaled_defaults(cls, length_unit: str | None) -> dict[str, float]:
        return {
            key: field.default * rule.scale(length_unit)
            for key, field in cls.model_fields.items()
            for rule in field.metadata
            if isinstance(rule, Quantity) and isinstance(field.default, float)
        }


def kind_of(value: Any) -> str:
    """What a TOML value is, in words."""
    kinds: tuple[tuple[type, str], ...] = (
        (bool, "a boolean"),
        (int, "an integer"),
        (float, "a decimal number"),
        (str, "a text"),
        (list, "a list"),
        (dict, "a table"),
    )
    return next((words for kind, words in kinds if isinstance(value, kind)), "a date or time")


def plain(number: float) -> str:
    """A limit as a user would write it: 0.001, 100000, without an exponent."""
    return f"{number:.9f}".rstrip("0").rstrip(".")


def refuse(message: str) -> NoReturn:
    raise PydanticCustomError("job", "{message}", {"message": message})
