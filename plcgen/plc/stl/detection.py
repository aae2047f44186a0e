"""Whether a source is STL of Micro/WIN SMART, by what it looks like."""

from __future__ import annotations

import re

from plcgen.plc.source import SourceText

_SUFFIX = ".awl"
_OWN_WORDS = re.compile(
    r"(?im)^[\ufeff \t]*(?:SUBROUTINE_BLOCK|INTERRUPT_BLOCK|PROGRAM_BLOCK|ORGANIZATION_BLOCK[ \t]+\S*:[ \t]*OB1\b"
    r"|NETWORK[ \t]+[0-9]+)"
)
_FOREIGN_WORDS = re.compile(r"(?im)^[\ufeff \t]*(?:FUNCTION|FUNCTION_BLOCK|DATA_BLOCK|TYPE)\b")


def is_smart(source: SourceText) -> bool:
    """Block heads and numbered networks tell; without either, the suffix of the file does."""
    if _OWN_WORDS.search(source.text):
        return True
    return source.name.lower().endswith(_SUFFIX) and not _FOREIGN_WORDS.search(source.text)
