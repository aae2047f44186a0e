"""Whether a source is STL, of Micro/WIN SMART or of STEP 7 V5, by what it looks like."""

from __future__ import annotations

import re

from plcgen.plc.source import SourceText

_SUFFIX = ".awl"
_LINE = r"(?im)^[\ufeff \t]*"
_SMART_WORDS = re.compile(
    rf"{_LINE}(?:SUBROUTINE_BLOCK|INTERRUPT_BLOCK|PROGRAM_BLOCK|ORGANIZATION_BLOCK[ \t]+\S*:[ \t]*OB1\b"
    r"|NETWORK[ \t]+[0-9]+)"
)
_S7_NETWORK = re.compile(rf"{_LINE}NETWORK[ \t]*(?://[^\n]*)?\r?$")
_S7_BLOCK = re.compile(
    rf"{_LINE}(?:(?:FUNCTION|FUNCTION_BLOCK|DATA_BLOCK|TYPE)\b|ORGANIZATION_BLOCK[ \t]+(?:OB[ \t]*[0-9]+|\"[^\"\n]+\")"
    r"[ \t]*\r?$)"
)


def is_smart(source: SourceText) -> bool:
    """Block heads and numbered networks tell; without either, the suffix of the file does."""
    if _SMART_WORDS.search(source.text):
        return True
    return source.name.lower().endswith(_SUFFIX) and not is_s7_stl(source)


def is_s7_stl(source: SourceText) -> bool:
    """Networks without number tell; without any, blocks in a file with the suffix of STL do."""
    if _SMART_WORDS.search(source.text):
        return False
    if _S7_NETWORK.search(source.text):
        return True
    return source.name.lower().endswith(_SUFFIX) and _S7_BLOCK.search(source.text) is not None
