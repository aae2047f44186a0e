"""What Micro/WIN makes of a source when it is imported."""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.check.verdict import Check
from plcgen.plc.importrules.s7_smart import findings
from plcgen.plc.source import decode_source
from plcgen.plc.stl.parser import parse


def import_check(files: Mapping[str, bytes]) -> Check:
    """What Micro/WIN would leave out of the blocks without a word: the interpreter runs what is written."""
    sources = [decode_source(name, data) for name, data in files.items() if name.endswith(".awl")]
    parsed = [(source, parse(source)) for source in sources]
    # What the block of a file by itself calls stands in other such files.
    alone = [block for _, blocks in parsed if len(blocks) == 1 for block in blocks]
    found = [
        finding
        for source, blocks in parsed
        for finding in findings(source, blocks, alone if len(blocks) == 1 else blocks)
        if finding.severity == "error"
    ]
    return Check("import_errors", float(len(found)), 0.0, "1", detail="; ".join(map(str, found)))
