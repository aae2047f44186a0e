"""Seeded faults in STL for the S7-300: every change of one word that could be somebody's slip of the finger.

Used by test_seeded_faults_s7_stl.py; run as a program it tries all of them, or some, and lists the survivors:
    python -m tests.check.seeded_faults_s7_stl [--case hoist] [--some 100]
"""

from __future__ import annotations

import argparse
import random
import re
from collections.abc import Iterator
from functools import cache, partial

from plcgen import pipeline
from plcgen.errors import PlcgenError
from plcgen.job import parse_job
from plcgen.plan import Plan
from tests.check import seeded_faults
from tests.check.seeded_faults_stl import SeededFault

STL = "s7-300-stl"
CASES = {name: text.replace('"tia-scl"', f'"{STL}"') for name, text in seeded_faults.CASES.items()}

SWAPS = {
    "A": "AN", "AN": "A", "O": "ON", "ON": "O", "A(": "AN(", "O(": "ON(", "S": "R", "R": "S", "JC": "JCN", "JCN": "JC",
    "+R": "-R", "-R": "+R", "*R": "/R", "/R": "*R", "+D": "-D", "-D": "+D", "+I": "-I", "-I": "+I",
    "CLR": "SET", "SET": "CLR", "TRUNC": "RND", "RND": "TRUNC", "NOT": None, "NEGR": None, "ABS": None, "TAK": None,
}  # fmt: skip
COMPARISONS = {"<": (">", "<="), ">": ("<", ">="), "<=": (">=", "<"), ">=": ("<=", ">"), "==": ("<>",), "<>": ("==",)}
STATEMENT = re.compile(r"(?P<label>\w{1,4}:)?(?P<indent> +)(?P<word>[A-Z+*/<>=(]+) +(?P<operand>[^;]*);")
VALUE = re.compile(r"(?P<head>  [A-Z]\w+ +:= )(?P<operand>[^;]*);")
REAL = re.compile(r"-?\d\.\d+e[+-]\d{3}")


@cache
def plan(case: str) -> Plan:
    return pipeline.prepare(parse_job(CASES[case], "small.toml"))


@cache
def files(case: str) -> dict[str, bytes]:
    return pipeline.sources(plan(case), STL)


def source_text(case: str) -> str:
    return files(case)["Small.awl"].decode("ascii")


def all_faults(case: str) -> list[SeededFault]:
    """Every fault in the statements, and in the constants of the instance DB, in the order of the text."""
    found: list[SeededFault] = []
    place, is_code, is_data = "", False, False
    for row, line in enumerate(source_text(case).split("\r\n")):
        bare = line.split("//")[0].rstrip()
        if line.startswith("TITLE ="):
            place = line.removeprefix("TITLE =")
        is_data = line.startswith("DATA_BLOCK") or (is_data and not line.startswith("END_DATA_BLOCK"))
        is_code = not is_data and (bare == "BEGIN" or (is_code and not bare.startswith("END_")))
        changes = changed(bare) if is_code else changed_value(bare) if is_data else ()
        found += [SeededFault(row, new, f"{place} | {_plain(bare)} -> {_plain(new) or 'nothing'}") for new in changes]
    return found


def _plain(line: str) -> str:
    return " ".join(line.split())


def changed(line: str) -> Iterator[str]:
    """Ways to get a statement wrong."""
    match = STATEMENT.fullmatch(line)
    if not match:
        return
    label, word, operand = match["label"] or "", match["word"], match["operand"]
    head = f"{label}{match['indent']}"
    nothing = f"{head}NOP 0;" if label else ""
    if word in SWAPS:
        swapped = SWAPS[word]
        yield f"{head}{swapped} {operand};" if swapped else nothing
    comparison = re.fullmatch(r"([<>=]+)([IDR])", word)
    if comparison and comparison[1] in COMPARISONS:
        yield from (f"{head}{other}{comparison[2]} ;" for other in COMPARISONS[comparison[1]])
    if word == "L":
        yield from (f"{head}L {other};" for other in other_values(operand.strip()))
    if word in ("T", "=", "S", "R"):
        yield nothing


def changed_value(line: str) -> Iterator[str]:
    """Ways to get a constant of the instance DB wrong."""
    match = VALUE.fullmatch(line)
    if match:
        yield from (f"{match['head']}{other};" for other in other_values(match["operand"]))


def other_values(text: str) -> Iterator[str]:
    """A hundredth more and less; the next whole number."""
    if REAL.fullmatch(text):
        value = float(text)
        yield from (f"{other:.6e}".replace("e+", "e+0").replace("e-", "e-0") for other in
                    ((1.01 * value, 0.99 * value) if value else (0.001,)))  # fmt: skip
    elif re.fullmatch(r"(L#)?\d+", text):
        yield f"{text[:2] if text.startswith('L') else ''}{int(text.removeprefix('L#')) + 1}"
    elif text.startswith("W#16#"):
        yield f"W#16#{(int(text[5:], 16) + 1) % 65536:X}"


def survives(case: str, fault: SeededFault) -> bool:
    """True when verification finds nothing wrong with the faulty source."""
    faulty = {**files(case), "Small.awl": fault.apply(source_text(case)).encode()}
    try:
        return pipeline.verify(plan(case), STL, faulty, fail_fast=True).ok
    except PlcgenError:
        return False


def survivors(case: str, faults: list[SeededFault]) -> Iterator[SeededFault]:
    """Those that nothing caught, as they turn up; in a pool of processes."""
    return seeded_faults.alive(partial(survives, case), faults)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--case", default="hoist", choices=CASES)
    parser.add_argument("--some", type=int, default=0)
    arguments = parser.parse_args()
    faults = all_faults(arguments.case)
    print(len(faults), "faults")
    chosen = random.Random(1).sample(faults, arguments.some) if arguments.some else faults
    for fault in survivors(arguments.case, chosen):
        print(f"{fault.row + 1}: {fault.note}", flush=True)
