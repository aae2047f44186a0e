"""What the SCL templates of the method `cosine` see, and the files they make for each target."""

from __future__ import annotations

from dataclasses import dataclass

from plcgen.job import Job
from plcgen.profile.constants import ConstantGroup
from plcgen.render.comments import Words
from plcgen.render.files import OutputFile, described
from plcgen.render.language import words_of
from plcgen.render.scl_source import NUMBERED, SymbolLine, address, constant_lines, source_context
from plcgen.targets import TARGETS

BODIES = {"centred": "ramp", "half-sine": "move"}
"""Stem of the templates by shape."""
PURPOSES = {
    "centred": "speed ramps behind a moving average",
    "half-sine": "moves of half-sine speed behind a moving average",
}
"""Of the function block, by shape."""


@dataclass(frozen=True)
class BlockNames:
    """Names as the target's source spells them."""

    fb: str
    db: str
    restart_fc: str
    cyclic_fc: str


def block_names(job: Job, target: str) -> BlockNames:
    """Classic sources name blocks by number, so that they compile without a symbol table; TIA sources by name."""
    blocks = job.function_block
    if target in NUMBERED:
        blank = NUMBERED[target]
        numbered = ("FB", blocks.fb), ("DB", blocks.db), ("OB", 100), ("OB", 35)
        return BlockNames(*(f"{kind}{blank}{number}" for kind, number in numbered))
    fb, restart, cyclic = (f'"{name}"' for name in (blocks.fb_name, blocks.restart_name, blocks.cyclic_name))
    return BlockNames(fb, f'"{blocks.db_name}"', restart, cyclic)


def output_files(job: Job, target: str) -> tuple[OutputFile, ...]:
    """Files of a target in the order of import."""
    stem, body, suffix = job.name, BODIES[job.cosine.shape], TARGETS[target].suffix
    files = (
        OutputFile("symbols.asc", f"{stem}.asc", "symbol table, fixed columns"),
        OutputFile("symbols.sdf", f"{stem}.sdf", "symbol table, comma-separated: the same symbols"),
        OutputFile(f"{body}{suffix}", f"{stem}{suffix}", "the blocks"),
        OutputFile(f"{body}_example{suffix}", f"{stem}_example{suffix}", "example calls"),
        OutputFile(f"{body}_import.md", "IMPORT.md", "this note"),
    )
    has_symbols = target in NUMBERED
    return tuple(file for file in files if has_symbols or not file.template.startswith("symbols"))


def cosine_context(job: Job, groups: tuple[ConstantGroup, ...], target: str, verified: bool) -> dict[str, object]:
    """Everything the templates of one target may name."""
    names, words = block_names(job, target), words_of(job.language)
    length = job.cosine.filter_length
    return {
        **vars(names),
        **source_context(job, verified),
        "constant_groups": constant_lines(groups, words),
        "filter_length": length,
        "averages": length > 1,
        "last_index": length - 1,
        "ring": range(length),
        "max_velocity": job.cosine.max_velocity,
        "symbols": _symbols(job, words),
        "files": described(output_files(job, target), words),
        "blocks_in_order": f"{names.fb}, {names.db}",
    }


def _symbols(job: Job, words: Words) -> tuple[SymbolLine, ...]:
    blocks = job.function_block
    fb = address("FB", blocks.fb)
    return (
        SymbolLine(blocks.fb_name, fb, fb, words(PURPOSES[job.cosine.shape])),
        SymbolLine(blocks.db_name, address("DB", blocks.db), fb, words("its instance data")),
    )
