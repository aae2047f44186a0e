"""What the SCL templates of every method see alike: the head of a file, constants with notes, rows of symbols."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from plcgen import __version__
from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.render.comments import Words
from plcgen.render.language import words_of

# STEP 7 takes two numbers of 0..15; it is the version of the blocks, not of plcgen.
BLOCK_VERSION = "0.1"
# What stands between the kind and the number of a block, in the sources that name blocks by number.
NUMBERED = {"s7-300-scl": "", "s7-300-stl": " "}


@dataclass(frozen=True)
class ConstantLine:
    """One constant of a source with the text behind it."""

    name: str
    value: float
    note: str


@dataclass(frozen=True)
class ConstantLines:
    """A group of them."""

    title: str
    constants: tuple[ConstantLine, ...]


@dataclass(frozen=True)
class SymbolLine:
    """One row of a STEP 7 symbol table."""

    name: str
    address: str
    type: str
    comment: str


def source_context(job: Job, verified: bool) -> dict[str, object]:
    """Where a source comes from, and what its comments need."""
    return {
        "name": job.name,
        "version": __version__,
        "block_version": BLOCK_VERSION,
        "job_file": job.file,
        "job_sha256": job.sha256,
        "unverified": not verified,
        "mnemonics": words_of(job.language)(job.mnemonics.capitalize()),
        "unit": job.length_unit,
        "sample_period": job.sample_period,
        "period_ms": f"{job.sample_period * 1000:g}",
        "source_stem": job.name,
    }


def constant_lines(groups: Iterable[ConstantGroup], words: Words) -> tuple[ConstantLines, ...]:
    """Groups of constants as templates list them."""
    return tuple(
        ConstantLines(words(g.title), tuple(ConstantLine(c.name, c.value, note(c, words)) for c in g.constants))
        for g in groups
    )


def note(constant: Constant, words: Words) -> str:
    """What stands behind a constant: unit, meaning and origin."""
    origin = f" {words(constant.origin)}" if constant.origin else ""
    return words("{unit}, {comment}").format(unit=_unit(constant.unit, words), comment=words(constant.comment)) + origin


def _unit(unit: str, words: Words) -> str:
    above, per, below = unit.partition(" per ")
    return words("{above} per {below}").format(above=above, below=below) if per else unit


def address(kind: str, number: int) -> str:
    """`FB    100`: the kind to the left, the number to the right of nine columns."""
    return f"{kind}{number:>7}"
