"""Estimates of S7-200 SMART sources."""

from __future__ import annotations

from collections.abc import Sequence

from plcgen.estimates import Estimate, Files, run_time
from plcgen.loading import smart_sources
from plcgen.plc.effort.smart import code_bytes, smart_routines
from plcgen.plc.stl.smart_costs import COSTS
from plcgen.plc.stl.syntax import Block

MICROSECOND = 1e-6
SMART_ORIGIN = (
    "execution times as they are often quoted (0.15 us a contact, 3.6 us a REAL operation), all boxes executed"
)


def smart_estimate(files: Files, data_bytes: int) -> Estimate:
    blocks = _separate(files)
    routines = smart_routines(blocks)
    watched = [name for name in routines if not name.startswith("SBR")]
    times = (run_time("S7-200 SMART", routines, name, COSTS, MICROSECOND) for name in watched)
    return Estimate(tuple(times), code_bytes(blocks), data_bytes, SMART_ORIGIN)


def _separate(files: Files) -> Sequence[Block]:
    """Each block once: a file that joins them repeats the others."""
    parsed = [blocks for _, blocks in smart_sources(files)]
    joined = [blocks for blocks in parsed if len(blocks) > 1]
    return [block for blocks in joined or parsed for block in blocks]
