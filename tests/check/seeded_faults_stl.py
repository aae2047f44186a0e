"""Seeded faults in STL for the S7-200 SMART: every change of one word that could be somebody's slip of the finger.

Used by test_seeded_faults_stl.py; run as a program it tries all of them and lists the survivors:
    python -m tests.check.seeded_faults_stl [--case table]
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, partial

from plcgen import pipeline
from plcgen.errors import PlcgenError
from plcgen.job import parse_job
from plcgen.plan import Plan
from plcgen.render import cosine_memory, two_axis_memory
from tests.check import seeded_faults

TWO_AXIS = """
name = "Small"
method = "two-axis"
targets = ["s7-200-smart"]
length_unit = "cm"
sample_period = 0.05

[two-axis]
max_velocity = 1.3
max_acceleration = 0.9
jerk = 1.4
pulses_per_unit = [60000, 50000]
ignore_below = 1000
mode = "{mode}"

[[two-axis.moves]]
x = -3.9
y = 2.5

[[two-axis.moves]]
x = 0.8
y = -2.005

[[two-axis.moves]]
x = 0.3013
y = 0.018

[[two-axis.moves]]
x = 0.012
y = 0.3497
"""

JOBS = {
    "interrupt": TWO_AXIS.format(mode="interrupt"),
    "table": TWO_AXIS.format(mode="table"),
    "ramp": seeded_faults.RAMP.replace('"tia-scl"', '"s7-200-smart"'),
    "move": seeded_faults.MOVE.replace('"tia-scl"', '"s7-200-smart"'),
}
MEMORY_MAPS = {"two-axis": two_axis_memory.memory_map, "cosine": cosine_memory.memory_map}

SWAPS = {
    "LD": "LDN", "LDN": "LD", "A": "AN", "AN": "A", "ON": "O", "S": "R", "R": "S", "INCD": "DECD", "INCB": "DECB",
    "+R": "-R", "-R": "+R", "*R": "/R", "/R": "*R", "+D": "-D", "-D": "+D", "*D": "/D", "/D": "*D",
    "ROUND": "TRUNC", "TRUNC": "ROUND",
}  # fmt: skip
COMPARISONS = {"<": (">", "<="), ">": ("<", ">="), "<=": (">=", "<"), ">=": ("<=", ">"), "=": ("<>",), "<>": ("=",)}


@dataclass(frozen=True)
class SeededFault:
    """Line `row` of the text becomes `line`; None when it is left out."""

    row: int
    line: str | None
    note: str

    def __str__(self) -> str:
        return self.note

    def apply(self, text: str) -> str:
        lines = text.split("\r\n")
        lines[self.row] = self.line or ""
        return "\r\n".join(lines)


@cache
def plan(case: str) -> Plan:
    return pipeline.prepare(parse_job(JOBS[case], "small.toml"))


@cache
def joined(case: str) -> str:
    return pipeline.sources(plan(case), "s7-200-smart")["Small.awl"].decode("ascii")


def all_faults(case: str) -> list[SeededFault]:
    """Every fault, in the order of the text; MAIN is an example and left alone."""
    lines = joined(case).split("\r\n")
    block = network = ""
    found: list[SeededFault] = []
    for row in range(lines.index("END_ORGANIZATION_BLOCK"), len(lines)):
        bare = lines[row].split("//")[0].rstrip()
        if heading := re.match(r"(?:SUBROUTINE|INTERRUPT)_BLOCK Small_(\w+)|Network (\d+)", bare):
            block, network = heading[1] or block, heading[2] or ""
        was = spoken(bare, case)
        found += [
            SeededFault(row, line, f"{block} {network} | {was} -> {spoken(line, case) if line else 'nothing'}")
            for line in changed(bare)
        ]
    return found


def spoken(line: str, case: str) -> str:
    """A line with the names of its variables, single blanks between words."""
    return " ".join(names(case).get(word, word) for word in line.replace(",", "").split())


@cache
def names(case: str) -> dict[str, str]:
    """The names of addresses."""
    job = plan(case).job
    return {address: name for name, address in MEMORY_MAPS[job.method](job).items()}


def changed(line: str) -> Iterator[str | None]:
    """Ways to get a line wrong."""
    match = re.fullmatch(r"([A-Z+*/=<>-]+) +(.*)", line)
    if not match or line.startswith(("Network", "TITLE", "SUBROUTINE", "INTERRUPT", "END_", "BEGIN")):
        return
    word, operands = match.groups()
    if word in SWAPS:
        yield f"{SWAPS[word]:<6} {operands}"
    comparison = re.fullmatch(r"(LD|A|O)([BDR])([<>=]+)", word)
    if comparison:
        head, kind, symbol = comparison.groups()
        yield from (f"{head}{kind}{other:<4} {operands}" for other in COMPARISONS[symbol])
    first, *others = operands.split(", ")
    if re.fullmatch(r"-?\d+\.\d+(E[+-]\d+)?", first):
        yield from (f"{word:<6} {', '.join([f'{float(first) * share + (not float(first)):.7g}', *others])}"
                    for share in (1.01, 0.99) if "." in f"{float(first) * share + (not float(first)):.7g}")  # fmt: skip
    if re.fullmatch(r"\+\d+", first):
        yield f"{word:<6} {', '.join([f'+{int(first) + 1}', *others])}"
    if not re.match(r"LD|LDN|A|AN|ON|O|FOR|=", word) or word == "=":
        yield None


def survives(case: str, fault: SeededFault) -> bool:
    """True when verification finds nothing wrong with the faulty program."""
    try:
        return pipeline.verify(
            plan(case), "s7-200-smart", {"Small.awl": fault.apply(joined(case)).encode()}, None, True
        ).ok
    except PlcgenError:
        return False


def survivors(case: str, faults: list[SeededFault]) -> Iterator[SeededFault]:
    """Those that nothing caught, as they turn up; in a pool of processes."""
    return seeded_faults.alive(partial(survives, case), faults)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--case", default="interrupt", choices=JOBS)
    chosen = parser.parse_args().case
    faults = all_faults(chosen)
    print(len(faults), "faults")
    for fault in survivors(chosen, faults):
        print(fault, flush=True)
