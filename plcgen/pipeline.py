"""The way of a job through the house, whatever its method: derive, render, parse, run, compare."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module

from plcgen.check.verdict import Check, TargetVerdict
from plcgen.estimates import Estimate
from plcgen.job import Job
from plcgen.plan import Derivation, Files, Plan, Progress
from plcgen.trajectory import Trajectory, disagreements

SCL, STL = "s7-300-scl", "s7-300-stl"

METHODS = {"hoist": "plan_hoist", "cosine": "plan_cosine", "two-axis": "plan_two_axis"}
"""The module of each method, which is imported when a job asks for it."""


def prepare(job: Job) -> Plan:
    """Raises JobError where the limits of the job cannot be met."""
    plan: Plan = import_module(f"plcgen.{METHODS[job.method]}").prepare(job)
    return plan


def derivation(plan: Plan) -> Derivation:
    """What `plcgen derive` shows."""
    return plan.derivation()


def sources(plan: Plan, target: str, verified: bool = True) -> dict[str, bytes]:
    """Files of a target by name, encoded as its engineering tool reads them."""
    return plan.sources(target, verified)


def estimates(plan: Plan, sources: Mapping[str, Files]) -> dict[str, Estimate]:
    """Run time and memory of sources by target. Raises SourceError."""
    return {target: plan.estimate(target, files) for target, files in sources.items()}


def verify(
    plan: Plan, target: str, files: Files, progress: Progress | None = None, fail_fast: bool = False
) -> TargetVerdict:
    """Execute the sources and hold them against the reference; STL also against SCL. Raises SourceError."""
    verdict = plan.verify(target, files, progress, fail_fast)
    if target != STL or (fail_fast and not verdict.ok):
        return verdict
    from plcgen.check.binary_result import binary_result
    from plcgen.loading import load

    return TargetVerdict((*verdict.checks, binary_result(load(target, files)), agreement(plan, files)))


def agreement(plan: Plan, files: Files) -> Check:
    """Values in which the nominal motion of STL sources differs from that of the SCL sources of the same job.

    Both compute in the same order, so that every bit must agree.
    """
    traces = {SCL: plan.golden_trace(SCL, plan.sources(SCL)), STL: plan.golden_trace(STL, files)}
    told = list(disagreements(traces))
    return Check("agrees_with_scl", float(len(told)), 0.0, "1", detail="; ".join(told))


def reference(plan: Plan) -> Trajectory:
    """The nominal motion in float64, sampled with the period of the job."""
    return plan.reference()


def golden_trace(plan: Plan, target: str, files: Files) -> Trajectory:
    """What the sources do on the nominal motion."""
    return plan.golden_trace(target, files)
