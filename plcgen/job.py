"""A job: what the user asks for, validated, frozen, and able to point at the line that asked."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from plcgen.errors import JobError
from plcgen.jobfile import METHODS, Blocks, Envelope, HoistFile, HoistLimits, TwoAxisFile, json_schema
from plcgen.jobfile_two_axis import HIGHEST_V_BYTE, LONGEST_MOVE, Move, TwoAxisLimits
from plcgen.jobproblems import Problem, problems_of
from plcgen.jobrules import UNITS_PER_METRE, Context
from plcgen.names import one_of
from plcgen.targets import TARGETS, Target
from plcgen.tomlfile import KeyPath, TomlFile, parse_toml, read_toml

__all__ = [
    "HIGHEST_V_BYTE",
    "Blocks",
    "Envelope",
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
    length_unit: str
    sample_period: float
    keys: HoistFile | TwoAxisFile
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
    def mnemonics(self) -> str:
        """Language of STL instructions, of the method `hoist`."""
        assert isinstance(self.keys, HoistFile)
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
        length_unit=keys.length_unit,
        sample_period=keys.sample_period,
        keys=keys,
        file=re.sub(r"[^A-Za-z0-9._ -]", "_", Path(text.name).name),
        sha256=text.sha256,
        text=text,
    )
    conflicts = [Problem.at_value(text, _path(key), words) for key, words in _conflicts(job)]
    if conflicts:
        raise _first(conflicts)
    return job


def _model(data: dict[str, Any]) -> type[HoistFile] | type[TwoAxisFile]:
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


def _conflicts(job: Job) -> Iterator[tuple[str, str]]:
    """Keys that are right alone and wrong together, each with the end of the sentence."""
    yield from _target_conflicts(job)
    if isinstance(job.keys, HoistFile):
        yield from _hoist_conflicts(job.hoist)
        yield from _mnemonic_conflicts(job)
        yield from _symbol_conflicts(job)
    else:
        yield from _two_axis_conflicts(job)


def _hoist_conflicts(hoist: HoistLimits) -> Iterator[tuple[str, str]]:
    if hoist.creep_velocity > hoist.max_velocity / 2:
        limit = f"{hoist.max_velocity:g}"
        yield (
            "hoist.creep_velocity",
            f"is above half of max_velocity = {limit}; write at most {hoist.max_velocity / 2:g}",
        )
    if hoist.creep_acceleration > hoist.acceleration:
        limit = f"{hoist.acceleration:g}"
        yield "hoist.creep_acceleration", f"is above acceleration = {limit}; write at most {limit}"


def _mnemonic_conflicts(job: Job) -> Iterator[tuple[str, str]]:
    stl = "s7-300-stl"
    if job.text.spelling(("mnemonics",)) and stl not in job.targets:
        yield "mnemonics", f'concerns the target "{stl}" alone; add it to targets, or remove the key'


def _two_axis_conflicts(job: Job) -> Iterator[tuple[str, str]]:
    """Also what no choice of other keys could mend."""
    limits = job.two_axis
    for index, output in enumerate(limits.direction_outputs):
        if output in limits.outputs:
            yield f"two-axis.direction_outputs[{index}]", "is a pulse output; write another output"
    if not limits.moves:
        yield "two-axis.moves", "holds no move for verification; write [[two-axis.moves]] with x and y below"
    for index, move in enumerate(limits.moves):
        pulses = [abs(d) * ppu for d, ppu in zip((move.x, move.y), limits.pulses_per_unit, strict=True)]
        if max(pulses) < max(1, limits.ignore_below):
            yield f"two-axis.moves[{index}]", "is no move: both components count as zero; write a longer one"
        for axis, count in zip("xy", pulses, strict=True):
            if count > LONGEST_MOVE:
                most = f"{LONGEST_MOVE} are the most"
                yield f"two-axis.moves[{index}].{axis}", f"is {count:.0f} pulses; {most}; divide the move"


def _target_conflicts(job: Job) -> Iterator[tuple[str, str]]:
    serving = [name for name, target in TARGETS.items() if job.method in target.methods]
    way_out = "remove it" if set(serving) & set(job.targets) else f"write {one_of(serving)}"
    if not job.targets:
        yield "targets", f'names no target; write one or more, such as ["{serving[0]}"]'
    for index, name in enumerate(job.targets):
        if name in job.targets[:index]:
            yield f"targets[{index}]", "is listed twice; keep one"
        if job.method not in TARGETS[name].methods:
            yield f"targets[{index}]", f'does not serve the method "{job.method}"; {way_out}'


def _symbol_conflicts(job: Job) -> Iterator[tuple[str, str]]:
    """Names of blocks that are too long for a target, or equal to a compiler, which ignores case."""
    blocks = job.blocks
    base = "blocks.fb_name" if job.text.spelling(("blocks", "fb_name")) else "name"
    data = "blocks.db_name" if job.text.spelling(("blocks", "db_name")) else base
    tightest = min((TARGETS[name] for name in job.targets), key=lambda target: target.max_identifier, default=None)
    if tightest:
        yield from _too_long(base, blocks.fb_name, blocks.velocity_name, tightest)
        if base != "name":
            yield from _too_long("name", job.name, job.name, tightest)
        if data != base:
            yield from _too_long(data, blocks.db_name, blocks.db_name, tightest)
    same = [name for name in blocks.code_names if name.upper() == blocks.db_name.upper()]
    if same:
        yield data, f"names another block too, {same[0]}; write another name"


def _too_long(key: str, name: str, longest: str, target: Target) -> Iterator[tuple[str, str]]:
    excess = len(longest) - target.max_identifier
    if excess > 0:
        derived = f", for {longest} comes of it" if longest != name else ""
        yield key, f"has {len(name)} characters; {target.name} takes {len(name) - excess}{derived}"


def _path(key: str) -> KeyPath:
    return tuple(int(part) if part.isdigit() else part for part in re.findall(r"[^.\[\]]+", key))
