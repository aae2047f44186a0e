"""Draws the pictures of README from what generated sources do: python docs/pictures.py

Needs matplotlib, which plcgen itself does not.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

from plcgen import pipeline
from plcgen.check.cosine import Run, Subject, ramp_run
from plcgen.check.cosine_model import Command, RampModel
from plcgen.job import read_job
from plcgen.plan_cosine import CosinePlan

mpl.use("svg")
mpl.rcParams["svg.hashsalt"] = "plcgen"

import matplotlib.pyplot as plt  # noqa: E402 - after the choice of backend

FOLDER = Path(__file__).parent
GOLDEN = FOLDER.parent / "golden"
TARGET = "s7-300-scl"


def executed_ramp() -> Run:
    """The first ramp of the golden case `ramps`, as its SCL block runs it."""
    plan = pipeline.prepare(read_job(GOLDEN / "ramps" / "job.toml"))
    assert isinstance(plan, CosinePlan)
    subject: Subject = plan.subject(TARGET, pipeline.sources(plan, TARGET))
    assert isinstance(subject.model, RampModel)
    ramp = subject.model.ramps[0]
    return ramp_run(subject, subject.model, "ramp", ramp.start, [Command(0, ramp.end)])


def draw_jerk(run: Run) -> None:
    """Speed and jerk before and after the moving average."""
    lead, count = 10, 120
    figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(8, 5), constrained_layout=True)
    for column, colour, width, label in (
        ("statVelocity", "#c0504d", 1.0, "before the average"),
        ("velocitySetpoint", "#1f497d", 1.8, "setpoint: mean of 16 samples"),
    ):
        speed = np.concatenate([np.full(lead, run.before), run.trace[column].astype(np.float64)])[:count]
        time = (np.arange(count) - lead) * run.cycle
        jerk = np.diff(speed, 2, prepend=[run.before] * 2) / run.cycle**2
        upper.plot(time, speed, color=colour, linewidth=width, label=label)
        lower.step(time, jerk, where="pre", color=colour, linewidth=width)
    limit = run.model.jerk
    for sign in (-1, 1):
        lower.axhline(sign * limit, color="#888888", linewidth=0.8, linestyle="--")
    lower.text(0.01, limit * 0.97, "limit", va="top", ha="left", color="#666666", transform=lower.get_yaxis_transform())
    upper.set_ylabel("speed, m/s")
    lower.set_ylabel("jerk, m/s$^3$")
    lower.set_xlabel("time, s")
    upper.legend(loc="lower right", frameon=False)
    for axes in (upper, lower):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.25)
    figure.savefig(FOLDER / "jerk.svg", metadata={"Date": None})


if __name__ == "__main__":
    draw_jerk(executed_ramp())
