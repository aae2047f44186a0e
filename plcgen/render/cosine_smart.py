"""What the cosine templates of the S7-200 SMART see, and the files they make."""

from __future__ import annotations

from collections.abc import Sequence

from plcgen import __version__
from plcgen.job import Job
from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.render.cosine_memory import BYTES_OF_A_COUNT, is_ramp, layout
from plcgen.render.files import OutputFile, described
from plcgen.render.language import words_of
from plcgen.render.smart_source import Named, ParameterLine, Routine, calls, heads, parameter_lines, parameter_note

# An analog output of this is full speed.
FULL_SCALE = 27648
# Samples of a law, as long as there has been none; no divisor is zero.
LEAST_SAMPLES = {True: 1, False: 2}

_LOADED = {
    name: name.lower()
    for name in (
        "MAX_VELOCITY",
        "MIN_DISTANCE",
        "MAX_DISTANCE",
        *(f"LAW_{number}" for number in range(1, 5)),
        *(f"SUM_{number}" for number in range(1, 4)),
        "TIME_BY_ACC",
        "SQUARE_BY_JERK",
        "SETTLE_TIME",
        "TIME_BY_VELOCITY",
        "SQUARE_BY_ACC",
        "CUBE_BY_JUMP",
        "CUBE_BY_JERK",
        "LEVEL_SAMPLES",
        "COUNTS",
        "COUNT_VALUE",
        "COUNT_SPEED",
    )
} | {"MIN_CYCLE_TIME": "min_cycle", "MAX_CYCLE_TIME": "max_cycle"}
_PERIOD = ("SAMPLE_PERIOD", "s", "T: period of the timed interrupt")


def routines(job: Job) -> dict[str, Routine]:
    """Blocks with their numbers."""
    number = job.cosine.first_subroutine
    sample = "one sample of the speed ramps" if is_ramp(job) else "one sample of the moves"
    return {
        "init": Routine(f"{job.name}_Init:SBR{number}", "parameters, cold start, timed interrupt"),
        "sample": Routine(f"{job.name}_Sample:SBR{number + 1}", sample),
        "tick": Routine(f"{job.name}_Tick:INT{job.cosine.interrupt_routine}", "timed interrupt"),
    }


def output_files(job: Job) -> tuple[OutputFile, ...]:
    """Files in the order of import: MAIN replaces the program, callees come before callers."""
    law = "ramp" if is_ramp(job) else "move"
    templates = {"main": "main", "sample": law, "tick": "tick", "init": "init"}
    purposes = {key: routine.purpose for key, routine in routines(job).items()} | {"main": "example of calls"}
    single = tuple(
        OutputFile(f"{template}.awl", f"{job.name}_{part}.awl", purposes[part]) for part, template in templates.items()
    )
    return (
        *single,
        OutputFile(f"joined_{law}.awl", f"{job.name}.awl", "all blocks in one file"),
        OutputFile("symbols.txt", f"{job.name}_symbols.txt", "symbol table to paste"),
        OutputFile("import.md", "IMPORT.md", "this note"),
    )


def _parameters(job: Job, groups: Sequence[ConstantGroup], addresses: dict[str, str]) -> tuple[ParameterLine, ...]:
    words = words_of(job.language)
    name, unit, comment = _PERIOD
    period = Constant(name, job.sample_period, unit, comment)
    first = ParameterLine(period.value, addresses["cycle_time"], parameter_note(period, words))
    return (first, *parameter_lines(groups, _LOADED, addresses, words))


def cosine_smart_context(job: Job, groups: tuple[ConstantGroup, ...], verified: bool) -> dict[str, object]:
    """Everything the templates may name."""
    keys, memory, blocks, words = job.cosine, layout(job), routines(job), words_of(job.language)
    addresses = memory.addresses()
    return {
        "name": job.name,
        "version": __version__,
        "job_file": job.file,
        "job_sha256": job.sha256,
        "unverified": not verified,
        "unit": job.length_unit,
        "v": Named(addresses),
        "block": heads(blocks),
        "call": calls(blocks),
        "parameters": _parameters(job, groups, addresses),
        "milliseconds": round(job.sample_period * 1000),
        "least_samples": LEAST_SAMPLES[is_ramp(job)],
        "filter_length": keys.filter_length,
        "averages": keys.filter_length > 1,
        "last_index": keys.filter_length - 1,
        "ring_bytes": BYTES_OF_A_COUNT * keys.filter_length,
        "full_scale": FULL_SCALE,
        "max_velocity": f"{keys.max_velocity:g}",
        "analog_gain": FULL_SCALE / keys.max_velocity,
        "is_ramp": is_ramp(job),
        "symbols": memory.symbols(job),
        "files": described(output_files(job), words),
        "tab": "\t",
        "first_byte": memory.first_byte,
        "last_byte": memory.end - 1,
    }
