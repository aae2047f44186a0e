"""The method `cosine` on random jobs: whatever the limits, the generated blocks do what they should, and all alike."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import pytest

from plcgen import pipeline
from plcgen.check.cosine_model import RampModel
from plcgen.errors import JobError
from plcgen.golden import deviation
from plcgen.job import Job, parse_job
from plcgen.jobfile_cosine import FITS, SHAPES
from plcgen.plan_cosine import CosinePlan
from plcgen.trajectory import disagreements

TARGETS = ("s7-300-scl", "tia-scl", "s7-200-smart")
MOST_SAMPLES = 1500
"""Of the longest ramp or move: longer ones take their time and show nothing else."""


def random_job(random: Random, shape: str) -> Job:
    """Limits over decades; the speeds and distances of its move fit to them."""
    velocity = round(10 ** random.uniform(-2, 1.6), 4)
    acceleration = round(velocity * 10 ** random.uniform(-1.5, 1.5), 4)
    jerk = round(acceleration * 10 ** random.uniform(-1, 2), 4)
    if shape == "centred":
        ends = [round(random.uniform(-velocity, velocity), 4) for _ in range(2)]
        move = f"from = {ends[0]}\nto = {ends[1]}"
    else:
        move = f"distance = {round(velocity**2 / acceleration * 10 ** random.uniform(-2, 2), 6)}"
    return parse_job(
        f"""
name = "Axis"
method = "cosine"
targets = ["{'", "'.join(TARGETS)}"]
length_unit = "m"
sample_period = {random.choice((0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1))}

[cosine]
max_velocity = {velocity}
max_acceleration = {acceleration}
jerk = {jerk}
filter_length = {random.choice((2, 3, 16, 50))}
shape = "{shape}"
fit = "{random.choice(FITS)}"
seed = {random.randrange(3)}

[[cosine.moves]]
{move}
""",
        "job.toml",
    )


def longest(plan: CosinePlan) -> int:
    """Samples of the longest ramp or move."""
    model = plan.model
    change = 2 * model.max_velocity if isinstance(model, RampModel) else model.distances[0]
    return model.samples(change, model.sample_period)


def random_plans(shape: str) -> Iterator[CosinePlan]:
    """Those that can be kept and are short."""
    random = Random(2026)
    while True:
        try:
            plan = pipeline.prepare(random_job(random, shape))
        except JobError:
            continue
        assert isinstance(plan, CosinePlan)
        if longest(plan) <= MOST_SAMPLES:
            yield plan


@pytest.mark.parametrize("shape", SHAPES)
def test_random_jobs_verify(shape: str) -> None:
    for _, plan in zip(range(5), random_plans(shape), strict=False):
        verdict = pipeline.verify(plan, "s7-300-scl", pipeline.sources(plan, "s7-300-scl"))
        assert [deviation(check) for check in verdict.failed] == [], plan.job.cosine


@pytest.mark.parametrize("shape", SHAPES)
def test_targets_agree_to_the_last_bit_on_random_jobs(shape: str) -> None:
    for _, plan in zip(range(5), random_plans(shape), strict=False):
        traces = {name: pipeline.golden_trace(plan, name, pipeline.sources(plan, name)) for name in TARGETS}
        assert list(disagreements(traces)) == [], plan.job.cosine


def test_a_sum_of_real_would_creep_where_counts_stand_still() -> None:
    """The negative control of `standstill_not_exact`: the same block with a running sum of REAL never stands still."""
    plan = next(random_plans("centred"))
    files = pipeline.sources(plan, "s7-300-scl")
    text = files["Axis.scl"].decode()
    drifting = (
        text.replace("OF DINT;", "OF REAL;")
        .replace("statSum          : DINT := 0;", "statSum          : REAL := 0.0;")
        .replace("tempDelta        : DINT;", "tempDelta        : REAL;")
        .replace("statRing[tempIndex] := tempCount;", "statRing[tempIndex] := statVelocity;")
        .replace("statSum := statSum + tempCount;", "statSum := statSum + statVelocity;")
        .replace("tempDelta := tempCount - statRing", "tempDelta := statVelocity - statRing")
        .replace("statRing[statIndex] := tempCount;", "statRing[statIndex] := statVelocity;")
        .replace("statSum := 0;", "statSum := 0.0;")
        .replace("DINT_TO_REAL(tempDelta) * COUNT_VALUE", "tempDelta * COUNT_VALUE * COUNTS")
        .replace("velocitySetpoint := statVelocity;", "velocitySetpoint := statSum * COUNT_VALUE * COUNTS;")
        .replace("DINT_TO_REAL(statSum) * COUNT_VALUE;", "statSum * COUNT_VALUE * COUNTS;")
    )  # fmt: skip
    assert drifting != text
    verdict = pipeline.verify(plan, "s7-300-scl", {**files, "Axis.scl": drifting.encode()})
    failed = {check.name: check.value for check in verdict.failed}
    assert failed["standstill_not_exact"] > 0
