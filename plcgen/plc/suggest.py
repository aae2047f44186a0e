"""The nearest right name for a wrong one."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def did_you_mean(name: str, names: Iterable[str]) -> str:
    """`; did you mean speed?`, or nothing when no other name is near."""
    spelling = {candidate.casefold(): candidate for candidate in names}
    spelling.pop(name.casefold(), None)
    near = get_close_matches(name.casefold(), spelling, 1)
    return f"; did you mean {spelling[near[0]]}?" if near else ""
