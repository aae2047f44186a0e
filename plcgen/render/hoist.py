"""What the hoist templates see, and the files they make for each target."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plcgen import __version__
from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.profile.hoist import Trip
from plcgen.profile.hoist_constants import hoist_constants
from plcgen.render.files import OutputFile
from plcgen.targets import TARGETS

# STEP 7 takes two numbers of 0..15; it is the version of the blocks, not of plcgen.
BLOCK_VERSION = "0.1"
# What stands between the kind and the number of a block, in the sources that name blocks by number.
NUMBERED = {"s7-300-scl": "", "s7-300-stl": " "}


@dataclass(frozen=True)
class BlockNames:
    """Names as the target's source spells them."""

    fb: str
    db: str
    velocity_fc: str
    travel_fc: str
    restart_fc: str
    cyclic_fc: str


@dataclass(frozen=True)
class ConstantLine:
    """One constant of a source with the text behind it."""

    name: str
    value: float
    note: str


@dataclass(frozen=True)
class SymbolLine:
    """One row of a STEP 7 symbol table."""

    name: str
    address: str
    type: str
    comment: str


def output_files(job: Job, target: str) -> tuple[OutputFile, ...]:
    """Files of a target in the order of import."""
    stem, suffix = job.name, TARGETS[target].suffix
    files = (
        OutputFile("symbols.asc", f"{stem}.asc", "symbol table, fixed columns"),
        OutputFile("symbols.sdf", f"{stem}.sdf", "symbol table, comma-separated: the same symbols"),
        OutputFile(f"source{suffix}", f"{stem}{suffix}", "the blocks"),
        OutputFile(f"example{suffix}", f"{stem}_example{suffix}", "example calls"),
        OutputFile("import.md", "IMPORT.md", "this note"),
    )
    has_symbols = target in NUMBERED
    return tuple(file for file in files if has_symbols or not file.template.startswith("symbols"))


def block_names(job: Job, target: str) -> BlockNames:
    """Classic sources name blocks by number, so that they compile without a symbol table; TIA sources by name."""
    blocks = job.blocks
    if target in NUMBERED:
        numbers = (("FB", blocks.fb), ("DB", blocks.db), ("FC", blocks.fc), ("FC", blocks.fc + 1))
        return BlockNames(
            *(f"{kind}{NUMBERED[target]}{number}" for kind, number in (*numbers, ("OB", 100), ("OB", 35)))
        )
    fb, *others = blocks.code_names
    return BlockNames(*(f'"{symbol}"' for symbol in (fb, blocks.db_name, *others)))


def hoist_context(job: Job, trip: Trip, target: str, verified: bool) -> dict[str, object]:
    """Everything the templates of one target may name."""
    names = block_names(job, target)
    return {
        **vars(names),
        "name": job.name,
        "version": __version__,
        "block_version": BLOCK_VERSION,
        "job_file": job.file,
        "job_sha256": job.sha256,
        "unverified": not verified,
        "mnemonics": job.mnemonics.capitalize(),
        "unit": job.length_unit,
        "travel": job.hoist.travel,
        "sample_period": job.sample_period,
        "period_ms": f"{job.sample_period * 1000:g}",
        "constant_groups": [_lines(group) for group in hoist_constants(job, trip)],
        "symbols": _symbols(job),
        "files": output_files(job, target),
        "source_stem": job.name,
        "blocks_in_order": ", ".join((names.velocity_fc, names.travel_fc, names.fb, names.db)),
    }


def _lines(group: ConstantGroup) -> Mapping[str, object]:
    return {"title": group.title, "constants": [ConstantLine(c.name, c.value, _note(c)) for c in group.constants]}


def _note(constant: Constant) -> str:
    origin = f" {constant.origin}" if constant.origin else ""
    return f"{constant.unit}, {constant.comment}{origin}"


def _symbols(job: Job) -> tuple[SymbolLine, ...]:
    blocks = job.blocks
    fb = _address("FB", blocks.fb)
    rows = (
        (blocks.fb_name, fb, fb, "speed of the hoist as a function of travel"),
        (blocks.db_name, _address("DB", blocks.db), fb, "instance data of the hoist"),
        (blocks.velocity_name, *[_address("FC", blocks.fc)] * 2, "velocity of a transition"),
        (blocks.travel_name, *[_address("FC", blocks.fc + 1)] * 2, "travel of a transition"),
    )
    return tuple(SymbolLine(*row) for row in rows)


def _address(kind: str, number: int) -> str:
    """`FB    100`: the kind to the left, the number to the right of nine columns."""
    return f"{kind}{number:>7}"
