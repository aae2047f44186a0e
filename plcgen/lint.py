"""Lint of source files: syntax, types, and what the engineering tools refuse at import."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from plcgen.errors import Location, PlcgenError, SourceError
from plcgen.lint_smart import smart_findings
from plcgen.plc.importrules.finding import Finding
from plcgen.plc.importrules.s7_scl import findings as import_findings
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect, detect_dialect
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import Block
from plcgen.plc.source import SourceText, Span, read_source
from plcgen.plc.stl.detection import is_smart
from plcgen.targets import SMART, TARGETS

DIALECTS = {dialect.name: dialect for dialect in (CLASSIC, TIA)}


@dataclass(frozen=True)
class _File:
    """One file as far as it could be read; without `blocks` the error says why."""

    source: SourceText
    dialect: Dialect
    blocks: tuple[Block, ...] | None
    findings: tuple[Finding, ...]


def lint_files(paths: Sequence[Path], target: str | None = None) -> list[Finding]:
    """All findings, file by file. Files of one dialect are one program, whatever their order.

    Raises SourceError only for a file that cannot be opened, PlcgenError for a target whose language is not known.
    """
    if target and target != SMART.name and TARGETS[target].dialect not in DIALECTS:
        raise PlcgenError(f"{target}: its language cannot be linted yet")
    sources = [read_source(path) for path in paths]
    smart = [source for source in sources if target == SMART.name or (target is None and is_smart(source))]
    files = [_read(source, target) for source in sources if source not in smart]
    found = [finding for file in files for finding in file.findings]
    found += [finding for dialect in DIALECTS.values() for finding in _type_errors(files, dialect)]
    found += smart_findings(smart)
    order = {source.name: number for number, source in enumerate(sources)}
    return sorted(found, key=lambda finding: (order[finding.location.file], *_position(finding.location)))


def _position(location: Location) -> tuple[int, int]:
    return location.line, location.column


def _read(source: SourceText, target: str | None) -> _File:
    dialect = DIALECTS[TARGETS[target].dialect] if target else detect_dialect(source)
    try:
        blocks = parse(source, dialect)
    except SourceError as error:
        return _File(source, dialect, None, _foreign(source, dialect) or (_finding(error, source, "syntax"),))
    return _File(source, dialect, blocks, tuple(import_findings(source, blocks, dialect)))


def _foreign(source: SourceText, dialect: Dialect) -> tuple[Finding, ...]:
    """What stands in the way of a source written for the other dialect; empty when that is not what is wrong."""
    own = detect_dialect(source)
    if own == dialect:
        return ()
    try:
        found = import_findings(source, parse(source, own), dialect)
    except SourceError:
        return ()
    return tuple(found) if any(finding.severity == "error" for finding in found) else ()


def _type_errors(files: Sequence[_File], dialect: Dialect) -> Iterator[Finding]:
    """Errors of lowering, at most one a block. With a file that cannot be read too much would be unknown.

    An error in an interface ends the search: what leans on it could not be judged.
    """
    program = [file for file in files if file.dialect == dialect]
    blocks = [block for file in program for block in file.blocks or ()]
    if any(file.blocks is None for file in program):
        return
    last: Finding | None = None
    while error := _lowering_error(blocks, dialect):
        found = _finding(error, program[0].source, "types")
        emptied = [_emptied(block) if _holds(block, error) else block for block in blocks]
        if found != last:
            yield found
        if emptied == blocks:
            return
        blocks, last = emptied, found


def _lowering_error(blocks: Sequence[Block], dialect: Dialect) -> SourceError | None:
    try:
        lower(blocks, dialect)
    except SourceError as error:
        return error
    return None


def _emptied(block: Block) -> Block:
    """The block with its interface alone: others can still be checked against it."""
    return replace(block, body=())


def _holds(block: Block, error: SourceError) -> bool:
    if error.location is None or error.location.file != block.source.name:
        return False
    first, last = (block.source.location(Span(place, place)).line for place in block.extent)
    return first <= error.location.line <= last


def _finding(error: SourceError, source: SourceText, rule: str) -> Finding:
    return Finding(error.location or Location(source.name, 1, 1), "error", rule, error.message)
