"""Draws the pictures of README from what generated sources do: python docs/pictures.py

Needs the extra `report`.
"""

from __future__ import annotations

from pathlib import Path

from plcgen import pipeline
from plcgen.job import parse_job
from plcgen.report.page import figures_of
from plcgen.report.pictures import svg

FOLDER = Path(__file__).parent
GOLDEN = FOLDER.parent / "golden"
PICTURES = (
    # golden case, figure, file
    ("main-shaft", "over-travel", "hoist_travel.svg"),
    ("main-shaft", "over-time", "hoist_time.svg"),
    ("ramps", "motion", "jerk.svg"),
    ("quadrants", "path", "table_path.svg"),
    ("quadrants", "pulses", "table_pulses.svg"),
)
ONE_MOVE = {"ramps"}
"""Cases of which the first move says it all."""


def draw(case: str, key: str, file: str) -> None:
    """One figure of a golden case, as the sources of its first target run it."""
    text = (GOLDEN / case / "job.toml").read_text("utf-8")
    if case in ONE_MOVE:
        head, first, *_others = text.split("[[cosine.moves]]")
        text = f"{head}[[cosine.moves]]{first}"
    plan = pipeline.prepare(parse_job(text, "job.toml"))
    target = plan.job.targets[0]
    figures = {figure.key: figure for figure in figures_of(plan, {target: pipeline.sources(plan, target)})}
    (FOLDER / file).write_bytes(svg(figures[key]))


if __name__ == "__main__":
    for row in PICTURES:
        draw(*row)
