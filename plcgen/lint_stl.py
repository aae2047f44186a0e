"""Lint of STL sources of STEP 7 V5."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from plcgen.errors import Location, SourceError
from plcgen.plc.importrules.finding import Finding
from plcgen.plc.importrules.s7_stl import findings as import_findings
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.s7_lowering import emptied, lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.stl.s7_syntax import Block


def stl_findings(sources: Sequence[SourceText]) -> list[Finding]:
    """All findings; the files are one program. With a file that cannot be read its types are not judged."""
    found: list[Finding] = []
    blocks: list[Block] = []
    unread = False
    for source in sources:
        try:
            own = parse(source)
        except SourceError as error:
            unread = True
            found.append(_finding(error, source, "syntax"))
        else:
            blocks.extend(own)
            found.extend(import_findings(source, own))
    return found if unread or not blocks else [*found, *_type_errors(blocks)]


def _type_errors(blocks: Sequence[Block]) -> Iterator[Finding]:
    """Errors of lowering, one a block: a block with an error is emptied, so that the others can be checked."""
    while (error := _lowering_error(blocks)) is not None:
        yield _finding(error, blocks[0].source, "types")
        rest = [emptied(block) if _holds(block, error) else block for block in blocks]
        if rest == blocks:
            return
        blocks = rest


def _lowering_error(blocks: Sequence[Block]) -> SourceError | None:
    try:
        lower(blocks)
    except SourceError as error:
        return error
    return None


def _holds(block: Block, error: SourceError) -> bool:
    if error.location is None or error.location.file != block.source.name:
        return False
    extent = block.declaration.extent
    first, last = (block.source.location(Span(place, place)).line for place in extent)
    return first <= error.location.line <= last


def _finding(error: SourceError, source: SourceText, rule: str) -> Finding:
    return Finding(error.location or Location(source.name, 1, 1), "error", rule, error.message)
