"""Estimates of S7-300 and TIA sources."""

from __future__ import annotations

from collections.abc import Sequence

from plcgen.estimates import Estimate, Files, run_time
from plcgen.loading import load, read_stl
from plcgen.plc.core import DataBlock
from plcgen.plc.effort.core import core_routines
from plcgen.plc.effort.s7_300 import BLOCK_HEAD, CPUS, SIZES
from plcgen.plc.effort.s7_stl import stl_routines
from plcgen.plc.effort.steps import Routines, code_size
from plcgen.plc.scl.lowering_declarations import Catalogue
from plcgen.plc.scl.syntax import BlockKind
from plcgen.plc.types import BYTE_BITS

NANOSECOND = 1e-9
S7_ORIGIN = (
    "instruction times said to be from A5E00261439, along the longest way through the block, every loop to its end, "
    "times 1.10 (CPU 317: 1.07) for the operating system"
)


def scl_estimate(target: str, files: Files) -> Estimate:
    program = load(target, files)
    watched = [name for name, function in program.functions.items() if function.instance is not None]
    return _s7(core_routines(program), watched, list(program.data_blocks.values()))


def stl_estimate(files: Files) -> Estimate:
    blocks = read_stl(files)
    watched = [block.name for block in blocks if block.declaration.kind is BlockKind.FB]
    catalogue = Catalogue([block.declaration for block in blocks], {})
    data = [catalogue.data_block(block.name) for block in blocks if block.declaration.kind is BlockKind.DB]
    return _s7(stl_routines(blocks), watched, [block for block in data if block])


def _s7(routines: Routines, watched: Sequence[str], data: Sequence[DataBlock]) -> Estimate:
    times = (
        run_time(cpu.name, routines, name, cpu.prices, NANOSECOND * cpu.system) for name in watched for cpu in CPUS
    )
    code = sum(BLOCK_HEAD + code_size(routine, SIZES) for routine in routines.values())
    data_bytes = sum(BLOCK_HEAD + block.type.bits // BYTE_BITS for block in data)
    return Estimate(tuple(times), code, data_bytes, S7_ORIGIN)
