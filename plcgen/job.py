"""A job: what the user asks for, validated, frozen, and able to point at the line that asked."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from plcgen.errors import JobError
from plcgen.jobconflicts import conflicts
from plcgen.jobfile import (
    METHODS,
    AnyFile,
    Blocks,
    CosineFile,
    Envelope,
    FunctionBlock,
    HoistFile,
    HoistLimits,
    TwoAxisFile,
    json_schema,
)
from plcgen.jobfile_cosine import CosineLimits, CosineMove
from plcgen.jobfile_two_axis import HIGHEST_V_BYTE, Move, TwoAxisLimits
from plcgen.jobproblems import Problem, problems_of
from plcgen.jobrules import UNITS_PER_METRE, Context
from plcgen.tomlfile import KeyPath, TomlFile, parse_toml, read_toml

__all__ = [
    "HIGHEST_V_BYTE",
    "Blocks",
    "CosineLimits",
    "CosineMove",
    "Envelope",
    "FunctionBlock",
    "HoistLimits",
    "Job",
    "Move",
    "TwoAxisLimits",
    "job_schema",
    "parse_job",
    "read_job",
]


@dataclass(frozen=True)
class Job:
    """A valid job. Lengths, speeds and so on are in `length_unit`, `sample_period` is in seconds.

    `file` is the base name of the job file with all but plain ASCII characters replaced: it may stand in a comment.
    `sha256` is of the file's UTF-8 text with LF line ends.
    """

    name: str
    method: str
    targets: tuple[str, ...]
    language: str
    length_unit: str
    sample_period: float
    keys: AnyFile
    file: str
    sha256: str
    text: TomlFile = field(repr=False, compare=False)

    @property
    def hoist(self) -> HoistLimits:
        """Limits of the method `hoist`."""
        assert isinstance(self.keys, HoistFile)
        return self.keys.hoist

    @property
    def blocks(self) -> Blocks:
        """Numbers and names of blocks, of the method `hoist`."""
        assert isinstance(self.keys, HoistFile)
        return self.keys.blocks

    @property
    def cosine(self) -> CosineLimits:
        """Limits of the method `cosine`."""
        assert isinstance(self.keys, CosineFile)
        return self.keys.cosine

    @property
    def function_block(self) -> FunctionBlock:
        """Number and name of the block, of the methods `hoist` and `cosine`."""
        assert isinstance(self.keys, HoistFile | CosineFile)
        return self.keys.blocks

    @property
    def mnemonics(self) -> str:
        """Language of STL instructions, of the methods `hoist` and `cosine`."""
        assert isinstance(self.keys, HoistFile | CosineFile)
        return self.keys.mnemonics

    @property
    def two_axis(self) -> TwoAxisLimits:
        """Limits of the method `two-axis`."""
        assert isinstance(self.keys, TwoAxisFile)
        return self.keys.two_axis

    def error(self, key: str, message: str) -> JobError:
        """An error that points at the value of a key such as `hoist.travel`; at its table when the key is defaulted."""
        return JobError(message, self.text.value_location(_path(key)))


def read_job(path: Path) -> Job:
    """Read a job file. Raises JobError with the place of what is wrong."""
    return _job(read_toml(path))


def parse_job(text: str, name: str) -> Job:
    """See `read_job`; `name` is what errors call the file."""
    return _job(parse_toml(text, name))


def job_schema() -> dict[str, Any]:
    """JSON Schema of the job file, for editors: `#:schema job.schema.json` in its first line."""
    return json_schema(METHODS.values())


def _job(text: TomlFile) -> Job:
    model = _model(text.data)
    try:
        keys = model.model_validate(text.data, context=_context(text.data))
    except ValidationError as error:
        raise _first(problems_of(error, model, text)) from error
    job = Job(
        name=keys.name,
        method=keys.method,
        targets=keys.targets,
        language=keys.language,
        length_unit=keys.length_unit,
        sample_period=keys.sample_period,
        keys=keys,
        file=re.sub(r"[^A-Za-z0-9._ -]", "_", Path(text.name).name),
        sha256=text.sha256,
        text=text,
    )
    found = [Problem.at_value(text, _path(key), words) for key, words in conflicts(keys, text)]
    if found:
        raise _first(found)
    return job


def _model(data: dict[str, Any]) -> type[HoistFile] | type[CosineFile] | type[TwoAxisFile]:
    """The model of the job's method. Without a usable one, of the first method whose table is there."""
    named = [name for name in METHODS if data.get("method") == name]
    present = [name for name in METHODS if name in data]
    return METHODS[[*named, *present, *METHODS][0]]


def _context(data: dict[str, Any]) -> Context:
    unit, name = data.get("length_unit"), data.get("name")
    known = isinstance(unit, str) and unit in UNITS_PER_METRE
    return Context(unit if known else None, name if isinstance(name, str) else None)


def _first(problems: list[Problem]) -> JobError:
    """The first problem of the file as an error that says how many there are."""
    first, *others = sorted(problems, key=lambda problem: problem.order)
    more = f" (the first of {1 + len(others)} problems)" if others else ""
    return JobError(first.message + more, first.location)


def _path(key: str) -> KeyPath:
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", key))
