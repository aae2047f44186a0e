"""The reference of a job of the method `cosine`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plcgen import pipeline
from plcgen.job import read_job

GOLDEN = Path(__file__).parents[1] / "golden"


@pytest.mark.parametrize("case", ["ramps", "half-sine"])
def test_jerk_adds_up_to_acceleration_and_that_to_speed(case: str) -> None:
    """From the first sample of each move on: before it the speed is steady."""
    job = read_job(GOLDEN / case / "job.toml")
    reference = pipeline.reference(pipeline.prepare(job))
    for number, move in enumerate(job.cosine.moves, start=1):
        rows = reference.rows(reference["move"] == number)
        start = np.float32(move.from_velocity or 0.0)
        assert start + np.cumsum(rows["acceleration"]) * job.sample_period == pytest.approx(rows["velocity"], abs=1e-9)
        assert np.cumsum(rows["jerk"]) * job.sample_period == pytest.approx(rows["acceleration"], abs=1e-9)
        assert rows["acceleration"][0] == (rows["velocity"][0] - start) / job.sample_period != 0
