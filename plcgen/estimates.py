"""What sources cost a CPU, by their text alone: estimates, none of them measured on a machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from plcgen.errors import SourceError
from plcgen.kept import kept
from plcgen.plc.effort.steps import Prices, Routines, longest
from plcgen.render.comments import Words
from plcgen.targets import SMART, TARGETS

Files = Mapping[str, bytes]


@dataclass(frozen=True)
class RunTime:
    """Of a block with all that it calls: `seconds` at the most, or None and the `reason` why there is no bound."""

    cpu: str
    block: str
    seconds: float | None
    reason: str = ""


@dataclass(frozen=True)
class Estimate:
    """Of one target: run times, bytes of code and data in work memory, and where the figures come from."""

    run_times: tuple[RunTime, ...]
    code_bytes: int
    data_bytes: int
    origin: str

    def as_json(self) -> dict[str, object]:
        times = [{"cpu": time.cpu, "block": time.block, "seconds": _rounded(time.seconds)} for time in self.run_times]
        return {"run_times": times, "code_bytes": self.code_bytes, "data_bytes": self.data_bytes, "origin": self.origin}


def _rounded(seconds: float | None) -> float | None:
    """An estimate has no more digits than that."""
    return None if seconds is None else float(f"{seconds:.3g}")


def estimate(target: str, files: Files, data_bytes: int = 0) -> Estimate:
    """Of the sources of a target without their examples. `data_bytes` is V memory, which no text of a SMART tells.

    Raises SourceError for what cannot be parsed.
    """
    own = tuple((name, data) for name, data in files.items() if "_example" not in name)
    return _estimate(target, own, data_bytes)


@kept
def _estimate(target: str, entries: tuple[tuple[str, bytes], ...], data_bytes: int) -> Estimate:
    own = dict(entries)
    if target == SMART.name:
        from plcgen.estimates_smart import smart_estimate

        return smart_estimate(own, data_bytes)
    from plcgen.estimates_s7 import scl_estimate, stl_estimate

    return stl_estimate(own) if TARGETS[target].dialect == "stl" else scl_estimate(target, own)


def run_time(cpu: str, routines: Routines, name: str, prices: Prices, unit: float) -> RunTime:
    try:
        return RunTime(cpu, name, unit * longest(routines, name, prices))
    except SourceError as error:
        return RunTime(cpu, name, None, str(error))


# ------------------------------------------------------------------------------------------------- as they are told

NO_BOUND = "no bound"
MAIN = "OB1"
"""What runs once a scan and not once a sample."""


@dataclass(frozen=True)
class EstimateRow:
    """One run time: in ms, and as a share of the sample period in %."""

    cpu: str
    block: str
    milliseconds: str
    share: str


def estimate_rows(estimate: Estimate, sample_period: float) -> tuple[EstimateRow, ...]:
    return tuple(_row(time, sample_period) for time in estimate.run_times)


def _row(time: RunTime, sample_period: float) -> EstimateRow:
    if time.seconds is None:
        return EstimateRow(time.cpu, time.block, NO_BOUND, "")
    share = "" if time.block == MAIN else f"{100.0 * time.seconds / sample_period:.2g}"
    return EstimateRow(time.cpu, time.block, f"{1000.0 * time.seconds:.2g}", share)


def estimate_context(estimate: Estimate, sample_period: float, words: Words = str) -> dict[str, object]:
    """What import notes may name, in the words of a language."""
    rows = estimate_rows(estimate, sample_period)
    return {
        "run_times": tuple(replace(row, milliseconds=words(row.milliseconds)) for row in rows),
        "code_bytes": estimate.code_bytes,
        "data_bytes": estimate.data_bytes,
    }
