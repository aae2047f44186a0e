"""Short situations: wrong inputs, commands, restarts, and the trip curve, each with what the block must answer."""

from __future__ import annotations

from collections.abc import Iterator

from plcgen.check.hoist_bench import Bench
from plcgen.check.verdict import Check


def case_checks(bench: Bench) -> Iterator[Check]:
    return iter(())
