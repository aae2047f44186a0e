"""What the hoist templates see, and the files they make for each target."""

from __future__ import annotations

from dataclasses import dataclass

from plcgen.job import Job
from plcgen.profile.hoist import Trip
from plcgen.profile.hoist_constants import hoist_constants
from plcgen.render.comments import Words
from plcgen.render.files import OutputFile, described
from plcgen.render.language import words_of
from plcgen.render.scl_source import NUMBERED, SymbolLine, address, constant_lines, source_context
from plcgen.targets import TARGETS


@dataclass(frozen=True)
class BlockNames:
    """Names as the target's source spells them."""

    fb: str
    db: str
    velocity_fc: str
    travel_fc: str
    restart_fc: str
    cyclic_fc: str


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
    names, words = block_names(job, target), words_of(job.language)
    return {
        **vars(names),
        **source_context(job, verified),
        "travel": job.hoist.travel,
        "constant_groups": constant_lines(hoist_constants(job, trip), words),
        "symbols": _symbols(job, words),
        "files": described(output_files(job, target), words),
        "blocks_in_order": ", ".join((names.velocity_fc, names.travel_fc, names.fb, names.db)),
    }


def _symbols(job: Job, words: Words) -> tuple[SymbolLine, ...]:
    blocks = job.blocks
    fb = address("FB", blocks.fb)
    rows = (
        (blocks.fb_name, fb, fb, "speed of the hoist as a function of travel"),
        (blocks.db_name, address("DB", blocks.db), fb, "instance data of the hoist"),
        (blocks.velocity_name, *[address("FC", blocks.fc)] * 2, "velocity of a transition"),
        (blocks.travel_name, *[address("FC", blocks.fc + 1)] * 2, "travel of a transition"),
    )
    return tuple(SymbolLine(name, place, kind, words(comment)) for name, place, kind, comment in rows)
