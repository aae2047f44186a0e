"""What a job file may say: every key with its unit, range, default and meaning."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import AfterValidator, Field, TypeAdapter, ValidationInfo, model_validator

from plcgen.jobfile_cosine import CosineLimits
from plcgen.jobfile_two_axis import LONGEST_TIMED_INTERRUPT, TwoAxisLimits
from plcgen.jobrules import UNITS_PER_METRE, Choice, NameRule, Quantity, Table, Whole, whole_milliseconds
from plcgen.targets import ENGLISH, LANGUAGES, TARGETS

HIGHEST_CODE_BLOCK = 7999  # FB and FC of the S7-300 CPUs in use; the first generation ends earlier
HIGHEST_DATA_BLOCK = 16000
DATA_SUFFIX = "_DB"
MNEMONICS = ("english", "german")

Name = Annotated[str, NameRule()]
Factor = Annotated[float, Quantity("", 1.0, 3.0)]
Acceleration = Annotated[float, Quantity("m/s2", 0.01, 100.0)]
Method = Annotated[str, Choice(("hoist", "cosine", "two-axis"))]
Targets = tuple[Annotated[str, Choice(tuple(TARGETS))], ...]


class Envelope(Table):
    """Limits of the protection envelope, which trips and clamps the setpoint, and what it assumes of the brake."""

    overspeed_factor: Factor = Field(1.15, description="nowhere does the envelope exceed this multiple of max_velocity")
    tracking_factor: Factor = Field(1.10, description="the envelope as a multiple of the planned speed of the place")
    tracking_margin: Annotated[float, Quantity("m/s", 0.0, 10.0)] = Field(
        0.3, description="the envelope lies at least this much above the planned speed"
    )
    brake_deceleration: Acceleration = Field(1.5, description="deceleration of the safety brake")
    reaction_time: Annotated[float, Quantity("s", 0.0, 10.0)] = Field(
        0.5, description="from the trip to the brake's grip"
    )
    end_velocity: Annotated[float, Quantity("m/s", 0.01, 50.0)] = Field(
        2.0, description="highest speed at which the end of the shaft may be reached"
    )
    overwind: Annotated[float, Quantity("m", 0.001, 100.0)] = Field(
        0.5, description="travel beyond a stop at which the position is an error"
    )


class HoistLimits(Table):
    """Limits of a hoist between two stops: creep out, accelerate, run, decelerate, creep in, stop."""

    travel: Annotated[float, Quantity("m", 0.1, 1e4)] = Field(description="from stop to stop", examples=[600.0])
    max_velocity: Annotated[float, Quantity("m/s", 0.01, 50.0)] = Field(description="highest speed", examples=[12.0])
    acceleration: Acceleration = Field(description="highest acceleration", examples=[0.75])
    deceleration: Acceleration = Field(
        default_factory=lambda given: given["acceleration"], description="highest deceleration; default acceleration"
    )
    jerk: Annotated[float, Quantity("m/s3", 0.01, 1e3)] = Field(description="highest jerk", examples=[0.5])
    creep_velocity: Annotated[float, Quantity("m/s", 0.005, 10.0)] = Field(
        description="speed near the stops, at most half of max_velocity", examples=[0.5]
    )
    creep_acceleration: Acceleration = Field(
        default_factory=lambda given: given["acceleration"],
        description="of the ramps between standstill and creep speed; default and at most acceleration",
    )
    creep_out: Annotated[float, Quantity("m", 0.0, 1e3)] = Field(
        description="travel at creep speed before accelerating; may be 0", examples=[1.5]
    )
    creep_in: Annotated[float, Quantity("m", 0.001, 1e3)] = Field(
        description="travel at creep speed before the stop ramp; takes up what the drive lags behind", examples=[2.5]
    )
    envelope: Envelope = Field(default={}, validate_default=True, description="protection; optional")


class FunctionBlock(Table):
    """Number and name of a function block and of its instance data block."""

    fb: Annotated[int, Whole(1, HIGHEST_CODE_BLOCK)] = Field(100, description="number of the function block")
    db: Annotated[int, Whole(1, HIGHEST_DATA_BLOCK)] = Field(100, description="number of its instance data block")
    fb_name: Name = Field(default_factory=str, description="name of the function block; default the job's name")
    db_name: Name = Field(
        default_factory=lambda given: given["fb_name"] + DATA_SUFFIX,
        description=f"name of the instance data block; default fb_name{DATA_SUFFIX}",
    )

    @model_validator(mode="before")
    @classmethod
    def _named_after_the_job(cls, given: Any, info: ValidationInfo) -> Any:
        name = info.context and info.context.name
        return {"fb_name": name, **given} if name and isinstance(given, dict) else given

    @property
    def restart_name(self) -> str:
        """Of the example call in TIA, where the OB stays the user's."""
        return f"{self.fb_name}_Restart"

    @property
    def cyclic_name(self) -> str:
        return f"{self.fb_name}_Cyclic"

    @property
    def code_names(self) -> tuple[str, ...]:
        """Symbols of everything that is written but the instance data block."""
        return self.fb_name, self.restart_name, self.cyclic_name

    @property
    def longest_name(self) -> str:
        """The longest symbol that comes of fb_name in STEP 7 V5."""
        return self.fb_name + DATA_SUFFIX


class Blocks(FunctionBlock):
    """Numbers and names of the blocks of a hoist."""

    fc: Annotated[int, Whole(1, HIGHEST_CODE_BLOCK - 1)] = Field(
        100, description="number of the first of two functions; the second takes the next number"
    )

    @property
    def velocity_name(self) -> str:
        return f"{self.fb_name}_Velocity"

    @property
    def travel_name(self) -> str:
        return f"{self.fb_name}_Travel"

    @property
    def code_names(self) -> tuple[str, ...]:
        return self.fb_name, self.velocity_name, self.travel_name, self.restart_name, self.cyclic_name

    @property
    def longest_name(self) -> str:
        return self.velocity_name


class JobFile(Table):
    """The keys that every job has. Each method adds its own table."""

    name: Name = Field(description="names the function block and the files", examples=["MainShaft"])
    method: Method = Field(description="how the motion is planned", examples=["hoist"])
    targets: Targets = Field(
        description="controllers and languages to write source for", examples=[["s7-300-scl", "tia-scl"]]
    )
    language: Annotated[str, Choice(LANGUAGES)] = Field(
        ENGLISH, description="of the comments in the sources and of the import notes; names stay English"
    )
    length_unit: Annotated[str, Choice(tuple(UNITS_PER_METRE))] = Field(
        description="length unit of all other keys, and of the encoder", examples=["m"]
    )
    sample_period: Annotated[float, Quantity("s", 0.001, 1.0), AfterValidator(whole_milliseconds)] = Field(
        description="period of the cyclic interrupt that calls the block, in whole milliseconds", examples=[0.010]
    )


class BlockFile(JobFile):
    """A job whose sources are blocks of an S7-300."""

    mnemonics: Annotated[str, Choice(MNEMONICS)] = Field(
        "english", description="language of the instructions in STL for the S7-300, as set in the SIMATIC Manager"
    )


class HoistFile(BlockFile):
    """A job of the method `hoist`."""

    hoist: HoistLimits = Field(description="limits of the motion")
    blocks: Blocks = Field(default={}, validate_default=True, description="numbers and names of blocks; optional")


class CosineFile(BlockFile):
    """A job of the method `cosine`."""

    method: Method = Field(description="how the motion is planned", examples=["cosine"])
    targets: Targets = Field(
        description="controllers and languages to write source for",
        examples=[["s7-300-scl", "tia-scl", "s7-200-smart"]],
    )
    cosine: CosineLimits = Field(description="limits of the motion, shape and moving average")
    blocks: FunctionBlock = Field(
        default={}, validate_default=True, description="number and name of the block; optional"
    )


class TwoAxisFile(JobFile):
    """A job of the method `two-axis`."""

    method: Method = Field(description="how the motion is planned", examples=["two-axis"])
    targets: Targets = Field(description="controllers and languages to write source for", examples=[["s7-200-smart"]])
    sample_period: Annotated[
        float, Quantity("s", 0.001, LONGEST_TIMED_INTERRUPT), AfterValidator(whole_milliseconds)
    ] = Field(description="period of the timed interrupt, in whole milliseconds", examples=[0.050])
    two_axis: TwoAxisLimits = Field(alias="two-axis", description="limits of the motion, outputs and memory")


AnyFile = HoistFile | CosineFile | TwoAxisFile

METHODS: dict[str, type[HoistFile] | type[CosineFile] | type[TwoAxisFile]] = {
    "hoist": HoistFile,
    "cosine": CosineFile,
    "two-axis": TwoAxisFile,
}


def json_schema(methods: Iterable[type[JobFile]]) -> dict[str, Any]:
    """JSON Schema of the job file; a method each. Descriptions name the unit."""
    union: Any = None
    for model in methods:
        union = model if union is None else union | model
    schema = TypeAdapter(union).json_schema()
    for table in (schema, *schema.get("$defs", {}).values()):
        for key in table.get("properties", {}).values():
            _name_unit(key)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "plcgen job"}


def _name_unit(key: dict[str, Any]) -> None:
    unit = key.pop("unit", "")
    key.pop("title", None)
    if unit:
        note = "; here and in the default m stands for length_unit" if unit.startswith("m") else ""
        key["description"] = f"{key['description']} ({unit}{note})"
