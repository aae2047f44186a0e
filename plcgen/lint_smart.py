"""Lint of sources for the S7-200 SMART."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from plcgen.errors import Location, SourceError
from plcgen.plc.importrules.finding import Finding
from plcgen.plc.importrules.s7_smart import findings as import_findings
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from plcgen.plc.stl.syntax import Block


def smart_findings(sources: Sequence[SourceText]) -> list[Finding]:
    """All findings; the files are one program. A line has its import rules or its error of types, not both."""
    found: list[Finding] = []
    files: list[tuple[SourceText, tuple[Block, ...]]] = []
    for source in sources:
        try:
            files.append((source, parse(source)))
        except SourceError as error:
            found.append(_finding(error, source, "syntax"))
    programs = [_program(blocks, [other for _, other in files]) for _, blocks in files]
    if not any(programs):
        return found
    try:
        imports = [
            finding
            for (source, blocks), program in zip(files, programs, strict=True)
            for finding in import_findings(source, blocks, program)
        ]
    except SourceError as error:  # two blocks of one number: which one is meant cannot be told
        return [*found, _finding(error, files[0][0], "types")]
    told = {(finding.location.file, finding.location.line) for finding in imports if finding.severity == "error"}
    # A joined file and its parts are the same program twice.
    different = {frozenset(map(_text, program)): program for program in programs if len(files) == len(sources)}
    errors = [error for program in different.values() for error in _type_errors(program, files[0][0])]
    return [*found, *imports, *(error for error in errors if (error.location.file, error.location.line) not in told)]


def _program(blocks: tuple[Block, ...], files: Sequence[tuple[Block, ...]]) -> list[Block]:
    """What a file is read with: all files but those that it joins, and those that join it with others."""
    own = set(map(_text, blocks))
    others = [set(map(_text, other)) for other in files]
    read = [other for other, texts in zip(files, others, strict=True) if not (texts < own or texts > own)]
    return [block for other in read for block in other]


def _text(block: Block) -> str:
    return block.source.text[block.extent.start : block.extent.end].rstrip()


def _type_errors(program: Sequence[Block], source: SourceText) -> Iterator[Finding]:
    """Errors of lowering, one a block: a block with an error is emptied, so that the others can be checked."""
    while (error := _lowering_error(program)) is not None:
        yield _finding(error, source, "types")
        emptied = [replace(block, networks=()) if _holds(block, error) else block for block in program]
        if emptied == program:
            return
        program = emptied


def _lowering_error(program: Sequence[Block]) -> SourceError | None:
    try:
        lower(program)
    except SourceError as error:
        return error
    return None


def _holds(block: Block, error: SourceError) -> bool:
    if error.location is None or error.location.file != block.source.name:
        return False
    first, last = (block.source.location(Span(place, place)).line for place in block.extent)
    return first <= error.location.line <= last


def _finding(error: SourceError, source: SourceText, rule: str) -> Finding:
    return Finding(error.location or Location(source.name, 1, 1), "error", rule, error.message)
