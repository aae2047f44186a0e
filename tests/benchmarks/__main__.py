"""How fast: engines side by side in one run, as ratios. Not a test: python -m tests.benchmarks

Needs the extras `fast` and `oracle`. A figure is the median of several runs; the first run of a compiled engine, which
may compile, does not count.
"""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from statistics import median
from subprocess import run
from tempfile import TemporaryDirectory
from time import perf_counter

from plcgen.check.two_axis_sweep import sweep
from plcgen.golden import check_golden
from plcgen.job import read_job
from plcgen.loading import load
from plcgen.plan_two_axis import TwoAxisPlan
from plcgen.plc import engines
from plcgen.plc.machine import Machine
from plcgen.plc.source import decode_source
from plcgen.plc.stl.s7_parser import parse
from plcgen.sweeps import TARGET, random_orders
from tests.check.awlsim_rig import AwlsimBlock

GOLDEN = Path(__file__).parents[2] / "golden"
RUNS = 5
HOIST, STL = GOLDEN / "main-shaft", "s7-300-stl"
MOVING = {"enable": 1.0, "directionUp": 1.0, "actualTravel": 50.0, "actualVelocity": 8.0}
"""Inputs on the way up, where the law over travel is computed."""


def seconds(work: Callable[[], object]) -> float:
    """Median of several runs."""
    work()
    times = []
    for _ in range(RUNS):
        begin = perf_counter()
        work()
        times.append(perf_counter() - begin)
    return median(times)


def hoist_sources() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (HOIST / STL).glob("*.awl") if "_example" not in path.name}


def machine_on(engine: str) -> Machine:
    """The hoist in mid-shaft."""
    os.environ[engines.VARIABLE] = engine
    machine = Machine(load(STL, hoist_sources()))
    for scan in range(400):
        for name, value in MOVING.items():
            machine.variable(f'"DB100".{name}').set(min(value, 0.02 * scan) if scan > 1 else 0.0)
        machine.call("FB100", "DB100")
    return machine


REAL_CHAIN = """FUNCTION_BLOCK FB 1
VAR
 x : REAL;
 k : REAL;
END_VAR
BEGIN
NETWORK
TITLE =
{chain}END_FUNCTION_BLOCK
DATA_BLOCK DB 1
FB 1
BEGIN
 x := 1.0;
 k := 0.999;
END_DATA_BLOCK
"""
"""Its figure in awlsim tells how one machine stands to another."""


def cycles_of_real_chain() -> float:
    """Cycles a second of a block of 68 instructions in awlsim."""
    chain = "".join(f" L #x;\n L #k;\n {'+*'[number % 2]}R;\n T #x;\n" for number in range(17))
    block = AwlsimBlock([REAL_CHAIN.format(chain=chain)], 1, 1)
    return 500 / seconds(lambda: _repeated(block.cycle, 500))


def scans_per_second() -> Iterator[tuple[str, float]]:
    """Of the golden hoist FB in STL."""
    keys = read_job(HOIST / "job.toml").function_block
    other = AwlsimBlock([text.decode("ascii") for text in hoist_sources().values()], keys.fb, keys.db)
    plain = machine_on(engines.PLAIN)
    other.image = bytes(plain.memory["DB100"])
    yield "awlsim", 200 / seconds(lambda: _repeated(other.cycle, 200))
    yield "plain", 2000 / seconds(lambda: _repeated(partial(plain.call, "FB100", "DB100"), 2000))
    fast = machine_on(engines.FAST)
    yield "fast", 20000 / seconds(lambda: _repeated(partial(fast.call, "FB100", "DB100"), 20000))


def _repeated(work: Callable[[], object], times: int) -> None:
    for _ in range(times):
        work()


def generating() -> float:
    """Seconds for the sources of three targets without verification, as a process of its own."""
    with TemporaryDirectory() as folder:
        job = str(HOIST / "job.toml")
        command = [sys.executable, "-m", "plcgen", "generate", job, "--no-verify", "-o", folder]
        return seconds(lambda: run(command, check=True, capture_output=True, cwd=GOLDEN.parent))


def golden(engine: str) -> float:
    """Seconds for `plcgen check` of all cases on all cores."""
    os.environ[engines.VARIABLE] = engine
    begin = perf_counter()
    reports = check_golden(GOLDEN, False, lambda _text: None)
    assert all(report.ok for report in reports)
    return perf_counter() - begin


def growth_with_scans() -> Iterator[tuple[int, float]]:
    machine = machine_on(engines.FAST)
    for count in (10_000, 20_000, 40_000):
        yield count, seconds(partial(_repeated, partial(machine.call, "FB100", "DB100"), count))


def growth_with_moves() -> Iterator[tuple[int, float]]:
    plan = TwoAxisPlan.of(read_job(GOLDEN / "table-1" / "job.toml"))
    subject = plan.subject(plan.sources(TARGET))
    for count in (50, 100, 200):
        orders = list(random_orders(plan.job, "1", 50)) * (count // 50)
        yield count, seconds(partial(sweep, subject, orders))


def growth_with_length() -> Iterator[tuple[int, float]]:
    """Lines of STL, parsed: the golden blocks once, twice and four times."""
    files = hoist_sources()
    for times in (1, 2, 4):
        copies = {f"{number}{name}": text for number in range(times) for name, text in files.items()}
        lines = sum(text.count(b"\n") for text in copies.values())
        yield lines, seconds(partial(_parsed, copies))


def _parsed(files: Mapping[str, bytes]) -> None:
    for name, data in files.items():
        parse(decode_source(name, data))


def main() -> None:
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    print(f"68 instructions on REAL, awlsim: {cycles_of_real_chain():.0f} cycles/s")
    rates = dict(scans_per_second())
    for name, rate in rates.items():
        print(f"hoist FB in STL, {name}: {rate:.0f} scans/s, {rate / rates['awlsim']:.1f} times awlsim")
    for title, figures in (
        ("scans", growth_with_scans()),
        ("two-axis moves", growth_with_moves()),
        ("lines of STL parsed", growth_with_length()),
    ):
        for count, time in figures:
            print(f"{count} {title}: {time:.3f} s, {1e6 * time / count:.1f} us each")
    print(f"generate --no-verify, three targets: {generating():.2f} s")
    golden(engines.FAST)
    times = {engine: golden(engine) for engine in (engines.PLAIN, engines.FAST)}
    for engine, time in times.items():
        print(f"check of all golden cases, {engine}: {time:.0f} s, {times[engines.PLAIN] / time:.1f} times plain")


if __name__ == "__main__":
    main()
