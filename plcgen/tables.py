"""Results as tables for a terminal and as data for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from plcgen import terminal
from plcgen.check.two_axis_sweep import Sweep
from plcgen.check.verdict import Check, Verdict
from plcgen.estimates import Estimate, estimate_rows
from plcgen.job import Job
from plcgen.plan import Comparison, Derivation
from plcgen.profile.constants import ConstantGroup


def derivation_json(job: Job, derivation: Derivation) -> dict[str, object]:
    legs = [vars(stretch) for stretch in derivation.stretches]
    tables = [
        {"title": group.title, "constants": [vars(constant) for constant in group.constants]}
        for group in derivation.tables
    ]
    comparisons = [
        {
            "title": comparison.title,
            "rows": [dict(zip(comparison.headings, row, strict=True)) for row in comparison.rows],
        }
        for comparison in derivation.comparisons
    ]
    head = {"job": job.name, "method": job.method, "length_unit": job.length_unit}
    return {**head, "legs": legs, "tables": tables, "comparisons": comparisons}


def derivation_tables(job: Job, derivation: Derivation) -> Iterator[terminal.Table]:
    """Legs of the motion, constants, and choices side by side."""
    yield _legs_table(job, derivation)
    yield from map(_constants_table, derivation.tables)
    yield from map(_comparison_table, derivation.comparisons)


def _legs_table(job: Job, derivation: Derivation) -> terminal.Table:
    unit, legs = job.length_unit, derivation.stretches
    rows = [(leg.name, *map(_number, (leg.duration, leg.travel, leg.end_velocity))) for leg in legs]
    total = ("total", _number(sum(leg.duration for leg in legs)), _number(sum(leg.travel for leg in legs)), "")
    headings = ("leg", ">duration s", f">travel {unit}", f">end velocity {unit}/s")
    return terminal.Table(f"{derivation.title} of {job.name}", headings, [*rows, total])


def _constants_table(group: ConstantGroup) -> terminal.Table:
    rows = [(c.name, _number(c.value), c.unit, c.comment, c.origin) for c in group.constants]
    return terminal.Table(group.title, ("constant", ">value", "unit", "meaning", "equation"), rows)


def _comparison_table(comparison: Comparison) -> terminal.Table:
    name, *figures = comparison.headings
    rows = [tuple(cell if isinstance(cell, str) else _number(cell) for cell in row) for row in comparison.rows]
    return terminal.Table(comparison.title, (name, *(f">{figure}" for figure in figures)), rows)


def estimates_json(estimates: Mapping[str, Estimate]) -> dict[str, object]:
    return {"estimates": {name: estimate.as_json() for name, estimate in estimates.items()}}


def estimates_table(job: Job, estimates: Mapping[str, Estimate]) -> terminal.Table:
    rows = [
        (name, row.cpu, row.block, row.milliseconds, row.share, str(estimate.code_bytes), str(estimate.data_bytes))
        for name, estimate in estimates.items()
        for row in estimate_rows(estimate, job.sample_period)
    ]
    headings = ("target", "CPU", "block", ">longest way ms", ">of a sample %", ">code bytes", ">data bytes")
    return terminal.Table("Estimates of run time and work memory", headings, rows)


def _number(value: float) -> str:
    return f"{value:.9g}"


def sweep_table(found: Sweep) -> terminal.Table:
    headings = (">moves", ">refused", ">pulses sent", ">pulses lost", ">events", "result")
    counts = map(str, (found.moves, found.refused, found.pulses, found.lost, found.events))
    return terminal.Table("Sweep", headings, [(*counts, terminal.OK if found.ok else terminal.FAILED)])


def verdict_table(verdict: Verdict) -> terminal.Table:
    rows = [_check_row(name, check) for name, target in verdict.targets.items() for check in target.checks]
    headings = ("target", "check", ">value", ">bound", "unit", "result")
    return terminal.Table(f"Verification of {verdict.job}", headings, rows)


def _check_row(target: str, check: Check) -> tuple[str, ...]:
    # + 0.0 turns -0.0 into 0.0
    bound = f"{'>=' if check.at_least else '<='} {check.bound + 0.0:.4g}"
    result = terminal.OK if check.ok else terminal.FAILED
    return (target, check.name, f"{check.value + 0.0:.4g}", bound, check.unit, result)


def failures(verdict: Verdict) -> str:
    counts = {name: f"{len(target.failed)} of {len(target.checks)}" for name, target in verdict.targets.items()}
    bad = [f"{counts[name]} checks failed for {name}" for name, target in verdict.targets.items() if not target.ok]
    details = [f"    {name}: {check.name}: {check.detail}" for name, check in _failed(verdict) if check.detail]
    return "\n".join([", ".join(bad), *details])


def _failed(verdict: Verdict) -> Iterable[tuple[str, Check]]:
    return ((name, check) for name, target in verdict.targets.items() for check in target.failed)
