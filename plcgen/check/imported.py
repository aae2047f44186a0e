"""What Micro/WIN makes of a source when it is imported."""

from __future__ import annotations

from collections.abc import Sequence

from plcgen.check.verdict import Check
from plcgen.plc.importrules.s7_smart import findings
from plcgen.plc.source import SourceText
from plcgen.plc.stl.syntax import Block


def import_check(parsed: Sequence[tuple[SourceText, tuple[Block, ...]]]) -> Check:
    """What Micro/WIN would leave out of the blocks without a word: the interpreter runs what is written."""
    # What the block of a file by itself calls stands in other such files.
    alone = [block for _, blocks in parsed if len(blocks) == 1 for block in blocks]
    found = [
        finding
        for source, blocks in parsed
        for finding in findings(source, blocks, alone if len(blocks) == 1 else blocks)
        if finding.severity == "error"
    ]
    return Check("import_errors", float(len(found)), 0.0, "1", detail="; ".join(map(str, found)))
