"""What the two-axis templates see: addresses in V memory, constants, block numbers; and the files they make."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from plcgen import __version__
from plcgen.job import Job
from plcgen.profile.two_axis import LONGEST_TABLE, SLOWEST_TABLE, TRAIN_SHARE, two_axis_constants
from plcgen.render.comments import Words
from plcgen.render.files import OutputFile, described
from plcgen.render.language import words_of
from plcgen.render.smart_source import Named, ParameterLine, Routine, calls, heads, parameter_lines
from plcgen.render.two_axis_memory import FINEST, LEAST_JERK, SHARE, SHORTEST, STEPS, layout, memory_map

BLOCK_VERSION = "0.1"

ROUTINES = {
    "interrupt": (
        ("init", "Init", "parameters, check, pulse outputs"),
        ("start", "Start", "start a move of DistanceX, DistanceY"),
        ("plan", "Plan", "times, samples and speeds of the move"),
        ("evaluate", "Eval", "pulses, speed and acceleration at a sample"),
        ("train", "Train", "frequencies of the pulses of a sample"),
        ("stop_plan", "StopPlan", "a stop from where the move is"),
        ("stop_evaluate", "StopEval", "pulses and speed at a sample of a stop"),
        ("kill", "Kill", "emergency stop: no further pulse"),
    ),
    "table": (
        ("init", "Init", "parameters, check, pulse outputs"),
        ("start", "Start", "start a move of DistanceX, DistanceY"),
        ("plan", "Plan", "times, segments and speeds of the move"),
        ("evaluate", "Eval", "pulses, speed and acceleration at an instant"),
        ("step", "Step", "one segment of both tables"),
        ("run", "Run", "builds the tables, starts them, tells their end"),
        ("kill", "Kill", "emergency stop: no further pulse"),
    ),
}
FILES = {  # template by block, in the order of import: MAIN replaces the program, callees come before callers
    "interrupt": ("main", "train", "evaluate", "plan", "stop_plan", "stop_evaluate", "kill", "tick", "init", "start"),
    "table": ("main_table", "evaluate", "plan_table", "step", "run", "kill", "init", "start_table"),
}
PORTS = {
    "Q0.0": (0, 66, 67, 168),
    "Q0.1": (1, 76, 77, 178),
    "Q0.3": (2, 566, 567, 578),
}


@dataclass(frozen=True)
class Port:
    """One pulse output: its number for PLS, its special memory, its table and its direction output."""

    axis: str
    output: str
    direction: str
    number: int
    idle: str
    control: str
    table_pointer: str
    table_offset: int
    start: str
    end: str
    count: str
    segments: str
    first_entry: str


def ports(job: Job, addresses: dict[str, str]) -> tuple[Port, Port]:
    """Of x and of y."""
    x, y = (_port(job, axis, int(addresses[f"table_{axis}"][2:])) for axis in "xy")
    return x, y


def _port(job: Job, axis: str, table: int) -> Port:
    index = "xy".index(axis)
    output = job.two_axis.outputs[index]
    number, status, control, pointer = PORTS[output]
    return Port(
        axis=axis,
        output=output,
        direction=job.two_axis.direction_outputs[index],
        number=number,
        idle=f"SM{status}.7",
        control=f"SMB{control}",
        table_pointer=f"SMW{pointer}",
        table_offset=table,
        segments=f"VB{table}",
        first_entry=f"VB{table + 1}",
        start=f"VD{table + 1}",
        end=f"VD{table + 5}",
        count=f"VD{table + 9}",
    )


def routines(job: Job) -> dict[str, Routine]:
    keys = job.two_axis
    found = {
        key: Routine(f"{job.name}_{suffix}:SBR{keys.first_subroutine + number}", purpose)
        for number, (key, suffix, purpose) in enumerate(ROUTINES[keys.mode])
    }
    return found | {"tick": Routine(f"{job.name}_Tick:INT{keys.interrupt_routine}", "one sample")}


_LOADED = {
    "V_MAX": "v_max",
    "A_MAX": "a_max",
    "BETA": "beta",
    "T_SAMPLE": "t_sample",
    "PPU_X": "ppu_x",
    "PPU_Y": "ppu_y",
    "T1": "t1_full",
    "T2": "t2_full",
    "S_JERK": "s_jerk",
    "S_FULL": "s_full",
    "A_T": "a_t",
    "BETA_T2": "beta_t2",
    "TRAIN_RATE": "train_rate",
}
TABLE_CONSTANTS = (
    (SHARE, "share", "1, segments that the time of a move is divided by"),
    (FINEST, "finest", "s, segments are planned no shorter than this"),
    (SHORTEST, "shortest", "s, shortest segment that is sent; the hardware stops below 500 us"),
    (SLOWEST_TABLE, "slowest", "Hz, lowest mean rate of an axis: an output cannot go below 1 Hz"),
    (LONGEST_TABLE, "longest", "s, longest move: a fraction of a Hz must not make the axes part"),
)


def _parameters(job: Job, addresses: dict[str, str], words: Words) -> Iterator[ParameterLine]:
    yield from parameter_lines(two_axis_constants(job), _LOADED, addresses, words)
    if job.two_axis.mode == "table":
        yield from (ParameterLine(value, addresses[name], words(note)) for value, name, note in TABLE_CONSTANTS)


def output_files(job: Job) -> tuple[OutputFile, ...]:
    """Files in the order of import."""
    mode = job.two_axis.mode
    purposes = {key: purpose for key, _, purpose in ROUTINES[mode]} | {"main": "example of calls", "tick": "one sample"}
    parts = [(template, template.removesuffix("_table")) for template in FILES[mode]]
    single = tuple(OutputFile(f"{file}.awl", f"{job.name}_{part}.awl", purposes[part]) for file, part in parts)
    joined = "joined_table.awl" if mode == "table" else "joined.awl"
    return (
        *single,
        OutputFile(joined, f"{job.name}.awl", "all blocks in one file"),
        OutputFile("symbols.txt", f"{job.name}_symbols.txt", "symbol table to paste"),
        OutputFile("import.md", "IMPORT.md", "this note"),
    )


@dataclass(frozen=True)
class TableAxis:
    """Names of one axis while a table is built."""

    title: str
    follows: bool
    addresses: dict[str, str]

    def __getattr__(self, name: str) -> str:
        key = f"{_STATE.get(name, name)}_{'follow' if self.follows else 'lead'}"
        if key not in self.addresses:
            raise AttributeError(name)
        return self.addresses[key]


_STATE = {"pointer": "ptr"}


def two_axis_context(job: Job, verified: bool) -> dict[str, object]:
    """Everything the templates may name."""
    addresses = memory_map(job)
    blocks = routines(job)
    x, y = ports(job, addresses)
    keys, words = job.two_axis, words_of(job.language)
    return {
        "name": job.name,
        "version": __version__,
        "block_version": BLOCK_VERSION,
        "job_file": job.file,
        "job_sha256": job.sha256,
        "unverified": not verified,
        "unit": job.length_unit,
        "v": Named(addresses),
        "block": heads(blocks),
        "call": calls(blocks),
        "ports": (x, y),
        "x": x,
        "y": y,
        "parameters": tuple(_parameters(job, addresses, words)),
        "ignore_below": keys.ignore_below,
        "least_jerk": LEAST_JERK,
        "fixed_jerk_time": keys.short_moves == "fixed-jerk-time",
        "milliseconds": round(job.sample_period * 1000),
        "train_share": f"{100 * TRAIN_SHARE:g}",
        "symbols": layout(job).symbols(job),
        "files": described(output_files(job), words),
        "tab": "\t",
        "axes": (
            TableAxis(words("leading axis"), False, addresses),
            TableAxis(words("other axis"), True, addresses),
        ),
        "steps": STEPS,
        "is_table": keys.mode == "table",
        "is_sampled": keys.mode != "table",
        "first_byte": keys.v_memory,
        "last_byte": layout(job).end - 1,
    }
