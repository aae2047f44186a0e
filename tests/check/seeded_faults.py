"""Seeded faults: every single-token change of a source that could be somebody's slip of the finger.

Used by test_seeded_faults.py; run as a program it tries all of them and lists the survivors:
    python tests/check/seeded_faults.py [--case hoist] [--target s7-300-scl]
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from itertools import pairwise
from typing import TypeVar

from plcgen import pipeline
from plcgen.errors import PlcgenError
from plcgen.job import parse_job
from plcgen.plan import Plan
from plcgen.plc.lexer import SCL_CLASSIC, Token, TokenKind, tokens
from plcgen.plc.source import decode_source
from plcgen.processes import in_processes

# Small jobs, in which few lines are without effect.
# Hoist: a jerk that is not 1, a^2/m and a^2 m on either side of the change of speed, and an envelope in which each of
# its four curves counts somewhere.
HOIST = """
name = "Small"
method = "hoist"
targets = ["s7-300-scl", "tia-scl"]
length_unit = "m"
sample_period = 0.02

[hoist]
travel = 24.0
max_velocity = 4.0
acceleration = 1.9
deceleration = 0.7
jerk = 1.25
creep_velocity = 0.4
creep_acceleration = 0.5
creep_out = 0.1
creep_in = 0.15

[hoist.envelope]
overspeed_factor = 1.08
tracking_factor = 1.1
tracking_margin = 0.2
brake_deceleration = 1.1
reaction_time = 0.1
end_velocity = 0.55
"""

RAMP = """
name = "Small"
method = "cosine"
targets = ["s7-300-scl", "tia-scl"]
length_unit = "m"
sample_period = 0.01

[cosine]
max_velocity = 1.3
max_acceleration = 3.1
jerk = 21.0
filter_length = 9

[[cosine.moves]]
from = -0.2
to = 1.1

[[cosine.moves]]
from = 0.1
to = 0.15
"""

MOVE = """
name = "Small"
method = "cosine"
targets = ["s7-300-scl", "tia-scl"]
length_unit = "m"
sample_period = 0.01

[cosine]
max_velocity = 1.3
max_acceleration = 3.1
jerk = 60.0
filter_length = 9
shape = "half-sine"

[[cosine.moves]]
distance = 3.0

[[cosine.moves]]
distance = -0.7

[[cosine.moves]]
distance = 0.2

[[cosine.moves]]
distance = 0.01
"""

T = TypeVar("T")
CASES = {"hoist": HOIST, "ramp": RAMP, "move": MOVE}

SWAPS = {
    "+": ["-"],
    "-": ["+"],
    "*": ["/"],
    "/": ["*"],
    "<": [">", "<="],
    ">": ["<", ">="],
    "<=": [">=", "<"],
    ">=": ["<=", ">"],
    "=": ["<>"],
    "<>": ["="],
    "AND": ["OR"],
    "OR": ["AND"],
    "NOT": [""],
    "TRUE": ["FALSE"],
    "FALSE": ["TRUE"],
}


@dataclass(frozen=True)
class SeededFault:
    """Replace text[start:end] by `replacement`."""

    start: int
    end: int
    replacement: str
    line: int
    was: str

    def within(self, text: str) -> str:
        """The row it stands under and its own row with the fault in brackets, in the spelling of STEP 7:
        `IF reset AND NOT statResetBefore THEN | statError := [NO_ERROR -> TRIPPED];`.
        """
        start, end = text.rfind("\n", 0, self.start) + 1, text.find("\n", self.end)
        marked = f"{text[start : self.start]}[{self.was.strip()} -> {self.replacement}]{text[self.end : end]}"
        return f"{_plain(_owner(text, start))} | {_plain(marked)}"

    def apply(self, text: str) -> str:
        return text[: self.start] + self.replacement + text[self.end :]


def _plain(row: str) -> str:
    return " ".join(row.split("//")[0].replace("#", "").split())


def _owner(text: str, start: int) -> str:
    """The nearest row above that is indented less."""
    row = text[start : text.find("\n", start)]
    depth = len(row) - len(row.lstrip())
    above = (line for line in reversed(text[:start].splitlines()) if _plain(line))
    return next((line for line in above if len(line) - len(line.lstrip()) < depth), "")


@cache
def plan(case: str) -> Plan:
    return pipeline.prepare(parse_job(CASES[case], "small.toml"))


@cache
def sound_files(case: str, target: str) -> dict[str, bytes]:
    return pipeline.sources(plan(case), target)


def source_text(case: str, target: str) -> str:
    return decode_source("Small.scl", sound_files(case, target)["Small.scl"]).text


def all_faults(case: str, target: str) -> list[SeededFault]:
    """Every fault, in the order of the text."""
    source = decode_source("Small.scl", sound_files(case, target)["Small.scl"])
    found = [token for token in tokens(source, SCL_CLASSIC) if token.kind is not TokenKind.END]
    faults = [*_swapped(source.text, found), *_dropped(source.text)]
    return sorted(faults, key=lambda fault: (fault.start, fault.replacement))


def _swapped(text: str, found: list[Token]) -> Iterator[SeededFault]:
    for before, token in pairwise(found):
        line = text.count("\n", 0, token.span.start) + 1
        if before.text.upper() in ("TITLE", "VERSION"):
            continue
        for replacement in _replacements(text, token):
            yield SeededFault(token.span.start, token.span.end, replacement, line, token.text)


def _replacements(text: str, token: Token) -> list[str]:
    row = text[text.rfind("\n", 0, token.span.start) + 1 : text.find("\n", token.span.end)]
    if re.match(r"\s*(TITLE|VERSION|AUTHOR|FAMILY|NAME)\b", row):
        return []
    if re.fullmatch(r"\d+\.\d+(E[+-]?\d+)?", token.text):
        value = float(token.text)
        return [f"{value * 1.01:.9f}", f"{value * 0.99:.9f}"] if value else ["0.001"]
    if re.fullmatch(r"\d+", token.text):
        return [str(int(token.text) + 1)]
    if token.text.upper().startswith("W#16#"):
        return [f"W#16#{(int(token.text[5:], 16) + 1) % 65536:04X}"]
    return SWAPS.get(token.text.upper(), [])


def _dropped(text: str) -> Iterator[SeededFault]:
    """Single-line assignments, left out."""
    for match in re.finditer(r"^ +#?\w+ := [^;\n]*;", text, re.MULTILINE):
        line = text.count("\n", 0, match.start()) + 1
        yield SeededFault(match.start(), match.end(), "", line, match.group())


def survives(case: str, target: str, fault: SeededFault) -> bool:
    """True when verification finds nothing wrong with the faulty source."""
    text = fault.apply(source_text(case, target))
    files = {**sound_files(case, target), "Small.scl": text.encode("utf-8")}
    try:
        return pipeline.verify(plan(case), target, files, fail_fast=True).ok
    except PlcgenError:
        return False


def survivors(case: str, target: str, faults: list[SeededFault]) -> Iterator[SeededFault]:
    """Those that nothing caught, as they turn up; in a pool of processes."""
    return alive(partial(survives, case, target), faults)


def alive(survives: Callable[[T], bool], faults: list[T]) -> Iterator[T]:
    """The faults that survive, as they turn up; in a pool of processes."""
    verdicts = in_processes(survives, faults)
    yield from (fault for fault, lives in zip(faults, verdicts, strict=True) if lives)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--case", default="hoist", choices=CASES)
    parser.add_argument("--target", default="s7-300-scl")
    arguments = parser.parse_args()
    faults = all_faults(arguments.case, arguments.target)
    print(len(faults), "faults")
    for fault in survivors(arguments.case, arguments.target, faults):
        print(f"{fault.line}: {fault.within(source_text(arguments.case, arguments.target))}", flush=True)
