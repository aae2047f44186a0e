"""Moves in pulses and whole samples: constants by hand, what every move keeps, and the rules that refuse a job."""

from __future__ import annotations

import json
import re
from math import sqrt
from pathlib import Path
from random import Random

import pytest

from plcgen.errors import JobError
from plcgen.job import Job, parse_job
from plcgen.profile.integrator import integrate
from plcgen.profile.two_axis import SAMPLE_TOLERANCE, AxisMove, TwoAxisMove, plan_move, pulses_of, two_axis_constants
from plcgen.profile.two_axis_rules import derive

EXAMPLE = (Path(__file__).parents[2] / "templates" / "jobs" / "two-axis.toml").read_text(encoding="utf-8")
Moves = tuple[tuple[float, float], ...]


def job_of(moves: Moves = (), **values: float | str | list[float]) -> Job:
    """The example job with other values, and with other moves where some are given."""
    text = EXAMPLE
    for key, value in values.items():
        pattern = rf"""(?m)^{key} = ("[^"]*"|\[[^]]*\]|[-+.\w]+)"""
        text, count = re.subn(pattern, f"{key} = {json.dumps(value)}", text)
        assert count == 1, key
    if moves:
        text = text[: text.index("[[two-axis.moves]]")]
        text += "\n".join(f"[[two-axis.moves]]\nx = {x}\ny = {y}\n" for x, y in moves)
    return parse_job(text, "job.toml")


def constants_of(job: Job) -> dict[str, float]:
    return {constant.name: constant.value for group in two_axis_constants(job) for constant in group.constants}


def random_jobs(count: int, seed: int) -> list[Job]:
    """Accepted by every rule: pulses are few."""
    random = Random(seed)
    jobs = []
    for _ in range(count):
        velocity, acceleration, jerk = (round(10.0 ** random.uniform(-1, 1), 6) for _ in range(3))
        fits = velocity >= acceleration**2 / jerk
        jobs.append(
            job_of(
                tuple((random.uniform(-9, 9), random.uniform(-9, 9)) for _ in range(4)),
                max_velocity=velocity,
                max_acceleration=acceleration,
                jerk=jerk,
                pulses_per_unit=[random.uniform(500, 2000), random.uniform(500, 2000)],
                sample_period=random.choice([0.005, 0.05, 0.255]),
                ignore_below=random.choice([0, 300]),
                short_moves=random.choice(["time-optimal", "fixed-jerk-time"] if fits else ["time-optimal"]),
            )
        )
    return jobs


def random_moves(count: int, seed: int) -> list[tuple[Job, TwoAxisMove]]:
    return [(job, move) for job in random_jobs(count, seed) for move in derive(job)]


def test_constants_of_the_example_by_hand() -> None:
    assert constants_of(job_of()) == pytest.approx(
        {
            "V_MAX": 1.5,
            "A_MAX": 1.0,
            "BETA": 1.0,
            "T_SAMPLE": 0.05,
            "PPU_X": 60000.0,
            "PPU_Y": 60000.0,
            "T1": 1.0,  # 1/1
            "K1": 20.0,
            "T2": 0.5,  # 1.5/1 - 1
            "K2": 10.0,
            "S1": 1 / 6,  # 1 1^3/6
            "S2": 3 / 8,  # 1/2 1/2 + 1 (1/2)^2/2
            "S3": 4 / 3,  # 1 1 + 1 1^2/2 - 1 1^3/6
            "S_JERK": 2.0,  # 2 1^3/1^2
            "S_FULL": 3.75,  # 1.5 (1.5/1 + 1/1)
            "A_T": 0.05,
            "BETA_T2": 0.00125,  # 1 0.05^2/2
            "TRAIN_RATE": 64 / 3,  # 16/(15 0.05)
        },
        rel=1e-9,
    )


def test_constants_where_the_limit_of_acceleration_is_not_reached() -> None:
    """1.5 cm/s, 2 cm/s2, 1.5 cm/s3: two phases of 1 s."""
    constants = constants_of(job_of(max_acceleration=2.0, jerk=1.5))
    assert constants["T1"] == pytest.approx(1.0)
    assert constants["T2"] == pytest.approx(0.0, abs=1e-9)
    assert constants["S_FULL"] == pytest.approx(3.0)


def test_travels_of_the_phases_make_half_the_shortest_distance_to_full_speed() -> None:
    for job in random_jobs(50, seed=1):
        constants = constants_of(job)
        assert constants["S1"] + constants["S2"] + constants["S3"] == pytest.approx(constants["S_FULL"] / 2, rel=1e-9)


def test_every_constant_has_a_unit_and_a_meaning() -> None:
    assert all(c.unit and c.comment for group in two_axis_constants(job_of()) for c in group.constants)


@pytest.mark.parametrize(
    ("move", "wanted"),
    [
        ((1.5, 1.0), AxisMove(1500, 2000, x_leads=True)),  # longer in cm, though not in pulses
        ((-1.0, 1.5), AxisMove(-1000, 3000, x_leads=False)),
        ((2.0, -1.0), AxisMove(2000, -2000, x_leads=True)),
        ((1.0, 1.0), AxisMove(1000, 2000, x_leads=True)),  # of equals x leads
        ((1.0005, -1.00025), AxisMove(1001, -2001, x_leads=True)),  # a half goes away from zero
        ((0.0993, 1.0), AxisMove(0, 2000, x_leads=False)),  # 99 pulses are ignored
        ((0.1, 1.0), AxisMove(100, 2000, x_leads=False)),  # 100 are not
    ],
)
def test_pulses_of_a_move(move: tuple[float, float], wanted: AxisMove) -> None:
    job = job_of((move,), pulses_per_unit=[1000, 2000], ignore_below=100)
    assert pulses_of(job.two_axis, job.two_axis.moves[0]) == wanted


def test_a_move_takes_the_fewest_whole_samples() -> None:
    for job, move in random_moves(100, seed=2):
        needed = move.fastest.duration / job.sample_period
        assert needed - SAMPLE_TOLERANCE <= move.samples < needed - SAMPLE_TOLERANCE + 1
        assert move.profile.duration == pytest.approx(move.samples * job.sample_period, rel=1e-12)


def test_a_move_arrives_at_rest_within_the_limits() -> None:
    """What the sample count is rounded down by speeds the move up."""
    for job, move in random_moves(100, seed=3):
        keys, haste = job.two_axis, 1 + 2 * SAMPLE_TOLERANCE / move.samples
        proof = integrate(list(move.profile.phases()))
        ppu = keys.pulses_per_unit[0 if move.pulses.x_leads else 1]
        assert proof.travel * ppu == pytest.approx(move.pulses.lead, rel=1e-9)
        assert proof.end_velocity == pytest.approx(0.0, abs=1e-9 * keys.max_velocity)
        assert proof.end_acceleration == pytest.approx(0.0, abs=1e-9 * keys.max_acceleration)
        assert proof.highest_velocity <= keys.max_velocity * haste
        assert proof.highest_acceleration <= keys.max_acceleration * haste**2
        assert proof.lowest_acceleration >= -keys.max_acceleration * haste**2
        assert proof.highest_jerk <= keys.jerk * haste**3
        assert move.reference.duration == pytest.approx(move.profile.duration, rel=1e-12)


def test_moves_of_the_example() -> None:
    """1.5 cm is jerk alone, 4 cbrt(1.5/2) s; 3 cm reach the speed sqrt(3.25) - 0.5 = 1.303 cm/s with 1 cm/s2."""
    short, longer = derive(job_of())
    assert (short.pulses, short.samples) == (AxisMove(90_000, 60_000, x_leads=True), 73)
    assert (longer.pulses, longer.samples) == (AxisMove(-180_000, 150_000, x_leads=True), 93)
    assert short.fastest.duration == pytest.approx(3.634241, abs=1e-6)
    assert longer.fastest.velocity == pytest.approx(sqrt(3.25) - 0.5)


def test_a_sample_count_a_hair_above_a_whole_number_is_that_number() -> None:
    """7.5 s are 150 samples of 0.05 s; 0.00004 s more are still 150, 0.0001 s more are not."""
    for distance, samples in ((7.5, 150), (7.50006, 150), (7.50015, 151)):
        assert derive(job_of(((distance, 0.0),)))[0].samples == samples


def test_no_pulses_are_no_move() -> None:
    with pytest.raises(ValueError, match="a move without pulses"):
        plan_move(job_of(), AxisMove(0, 0, x_leads=True))


@pytest.mark.parametrize(
    ("values", "moves", "message"),
    [
        (
            {"max_velocity": 1.6},
            (),
            "15:16: max_velocity = 1.6 cm/s takes up to 96025 pulses/s; 93670 can be sent; write at most 1.56, "
            "or lower pulses_per_unit",
        ),
        (
            {"max_velocity": 0.5, "pulses_per_unit": [1000, 200_000], "sample_period": 0.005},
            (),
            "15:16: max_velocity = 0.5 cm/s takes up to 100001 pulses/s; 92950 can be sent; write at most 0.4647, "
            "or lower pulses_per_unit",
        ),
        (
            {"max_acceleration": 0.01},
            (),
            "16:20: max_acceleration = 0.01 takes 6750450 pulses to full speed; 4194304 are the most; "
            "raise it or jerk, or lower max_velocity",
        ),
        (
            {"short_moves": "fixed-jerk-time", "jerk": 0.5},
            (),
            '21:15: short_moves = "fixed-jerk-time" needs max_velocity >= max_acceleration^2/jerk = 2; '
            'raise jerk, or write "time-optimal"',
        ),
        (
            {"max_velocity": 0.001},
            ((1.0, 0.0), (1000.0, 0.0)),
            "32:3: the move takes 20000002 samples; 8388608 are the most; lengthen sample_period",
        ),
        (
            {"max_velocity": 0.001, "mode": "table"},
            ((0.1, 0.0), (1.0, 0.0)),
            '32:3: the move takes 1000 s; a table holds 640 s; divide it, or write mode = "interrupt"',
        ),
        (
            {"mode": "table", "ignore_below": 0},
            ((1.5, 0.0001), (1.5, 0.0)),
            "28:3: an axis sends 1.65 pulses/s in the mean; a table needs 8, for an output cannot go below 1 Hz; "
            'raise ignore_below, or write mode = "interrupt"',
        ),
        (
            {"mode": "table", "jerk": 1000},
            ((1.5, 0.0),),
            '28:3: a phase of jerk takes 1 ms; a table needs 2 ms; lower jerk, or write mode = "interrupt"',
        ),
    ],
)
def test_refusals(values: dict[str, float | str | list[float]], moves: Moves, message: str) -> None:
    with pytest.raises(JobError) as caught:
        derive(job_of(moves, **values))
    assert str(caught.value).split("\n")[0] == f"job.toml:{message}"


@pytest.mark.parametrize(
    ("values", "moves"),
    [
        ({"max_velocity": 1.56}, ()),
        ({"short_moves": "time-optimal", "jerk": 0.5}, ()),
        ({"short_moves": "fixed-jerk-time", "jerk": 1 / 1.5}, ()),
        ({"max_velocity": 0.001, "sample_period": 0.255}, ((1000.0, 0.0),)),
        ({"max_velocity": 0.001, "mode": "interrupt"}, ((1.0, 0.0),)),
        ({"mode": "interrupt", "ignore_below": 0}, ((1.5, 0.0001),)),
        ({"mode": "table", "ignore_below": 7}, ((1.5, 0.0001),)),
        ({"mode": "table", "jerk": 500}, ((1.5, 0.0),)),
    ],
)
def test_what_is_named_as_the_way_out_is_one(values: dict[str, float | str | list[float]], moves: Moves) -> None:
    assert derive(job_of(moves, **values))
