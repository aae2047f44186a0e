"""What sources cost a CPU, by their text alone: estimates, none of them measured on a machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from plcgen.errors import SourceError
from plcgen.loading import read_scl, read_stl
from plcgen.plc.core import DataBlock
from plcgen.plc.effort.core import core_routines
from plcgen.plc.effort.s7_300 import BLOCK_HEAD, CPUS, SIZES
from plcgen.plc.effort.s7_stl import stl_routines
from plcgen.plc.effort.smart import code_bytes, smart_routines
from plcgen.plc.effort.steps import Prices, Routines, code_size, longest
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.lowering_declarations import Catalogue
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.source import decode_source
from plcgen.plc.stl.parser import parse as parse_smart
from plcgen.plc.stl.smart_costs import COSTS
from plcgen.plc.stl.syntax import Block as SmartBlock
from plcgen.plc.types import BYTE_BITS
from plcgen.render.comments import Words
from plcgen.targets import SMART, TARGETS

Files = Mapping[str, bytes]
NANOSECOND, MICROSECOND = 1e-9, 1e-6
S7_ORIGIN = (
    "instruction times said to be from A5E00261439, along the longest way through the block, every loop to its end, "
    "times 1.10 (CPU 317: 1.07) for the operating system"
)
SMART_ORIGIN = (
    "execution times as they are often quoted (0.15 us a contact, 3.6 us a REAL operation), all boxes executed"
)


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
    own = {name: data for name, data in files.items() if "_example" not in name}
    if target == SMART.name:
        return _smart(own, data_bytes)
    return _stl(own) if TARGETS[target].dialect == "stl" else _scl(target, own)


def _scl(target: str, files: Files) -> Estimate:
    blocks, dialect = read_scl(target, files)
    program = lower(blocks, dialect)
    watched = [name for name, function in program.functions.items() if function.instance is not None]
    return _s7(core_routines(program), watched, list(program.data_blocks.values()))


def _stl(files: Files) -> Estimate:
    blocks = read_stl(files)
    watched = [block.name for block in blocks if block.declaration.kind is BlockKind.FB]
    catalogue = Catalogue([block.declaration for block in blocks], {})
    data = [catalogue.data_block(block.name) for block in blocks if block.declaration.kind is BlockKind.DB]
    return _s7(stl_routines(blocks), watched, [block for block in data if block])


def _s7(routines: Routines, watched: Sequence[str], data: Sequence[DataBlock]) -> Estimate:
    times = (_time(cpu.name, routines, name, cpu.prices, NANOSECOND * cpu.system) for name in watched for cpu in CPUS)
    code = sum(BLOCK_HEAD + code_size(routine, SIZES) for routine in routines.values())
    return Estimate(tuple(times), code, sum(BLOCK_HEAD + block.type.bits // BYTE_BITS for block in data), S7_ORIGIN)


def _smart(files: Files, data_bytes: int) -> Estimate:
    blocks = _separate(files)
    routines = smart_routines(blocks)
    watched = [name for name in routines if not name.startswith("SBR")]
    times = (_time("S7-200 SMART", routines, name, COSTS, MICROSECOND) for name in watched)
    return Estimate(tuple(times), code_bytes(blocks), data_bytes, SMART_ORIGIN)


def _separate(files: Files) -> Sequence[SmartBlock]:
    """Each block once: a file that joins them repeats the others."""
    parsed = [parse_smart(decode_source(name, data)) for name, data in files.items() if name.endswith(SMART.suffix)]
    joined = [blocks for blocks in parsed if len(blocks) > 1]
    return [block for blocks in joined or parsed for block in blocks]


def _time(cpu: str, routines: Routines, name: str, prices: Prices, unit: float) -> RunTime:
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
