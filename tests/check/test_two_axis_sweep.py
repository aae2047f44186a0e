"""More than a thousand random moves of random tables, run as generated: no pulse is lost, and every move is as planned.

Moves are short, so that many of them fit; the golden jobs have the long ones. Interrupts that come late, stops and
refused starts are left to the verification of a whole job.
"""

from __future__ import annotations

import json
from math import exp, log
from random import Random

import pytest

from plcgen import pipeline
from plcgen.check.two_axis_motion import move_checks
from plcgen.check.two_axis_rig import Table
from plcgen.check.verdict import Check
from plcgen.errors import JobError
from plcgen.job import parse_job
from plcgen.jobfile_two_axis import PULSE_OUTPUTS
from plcgen.plan_two_axis import TwoAxisPlan

TARGET = "s7-200-smart"
SEEDS, JOBS, MOVES = range(16), 16, 6
MODES, SHORT_MOVES = ("interrupt", "table"), ("time-optimal", "fixed-jerk-time")
USUAL, LONGEST = 4.0, 40.0  # s


def magnitude(random: Random, low: float, high: float) -> float:
    """Numbers spread evenly over their orders of magnitude."""
    return exp(random.uniform(log(low), log(high)))


def random_move(random: Random, reach: float) -> str:
    """From both axes alike to one of them alone, in all directions."""
    way = reach * magnitude(random, 0.01, 1.0)
    pair = [way, way * random.choice([0.0, 1.0, magnitude(random, 1e-3, 1.0), magnitude(random, 0.1, 1.0)])]
    random.shuffle(pair)
    x, y = (distance * random.choice([1, -1]) for distance in pair)
    return f"[[two-axis.moves]]\nx = {x!r}\ny = {y!r}\n"


def random_job(random: Random, mode: str, short_moves: str) -> str:
    """Pulse rates, scales, sample periods and limits over their orders of magnitude; many of these jobs are refused."""
    scales = [magnitude(random, 10, 1e5) for _ in "xy"]
    if random.random() < 0.5:
        scales[1] = scales[0]
    velocity = magnitude(random, 200, 93_000) / max(scales)
    acceleration = velocity / magnitude(random, 0.03, 3.0)
    jerk = acceleration / magnitude(random, 0.02, 1.0)
    reach = velocity * magnitude(random, 1e-3, LONGEST)
    return f"""\
name = "Table"
method = "two-axis"
targets = ["{TARGET}"]
length_unit = "{random.choice(["m", "cm", "mm"])}"
sample_period = {random.choice([5, 8, 10, 20, 50, 100, 255]) / 1000}

[two-axis]
max_velocity = {velocity!r}
max_acceleration = {acceleration!r}
jerk = {jerk!r}
pulses_per_unit = {scales!r}
ignore_below = {random.choice([0, 0, 1, 100])}
mode = "{mode}"
short_moves = "{short_moves}"
v_memory = {random.randrange(1000)}
outputs = {json.dumps(random.sample(PULSE_OUTPUTS, 2))}

""" + "".join(random_move(random, reach) for _ in range(MOVES))


def accepted_job(random: Random, mode: str, short_moves: str) -> tuple[str, TwoAxisPlan]:
    """A job that is not refused, and takes no longer than a test has time for."""
    longest = LONGEST if random.random() < 0.02 else USUAL
    while True:
        text = random_job(random, mode, short_moves)
        try:
            plan = TwoAxisPlan.of(parse_job(text, "job.toml"))
        except JobError:
            continue
        if max(move.samples for move in plan.moves) * plan.job.sample_period <= longest:
            return text, plan


def missed(plan: TwoAxisPlan) -> list[tuple[str, Check]]:
    """One move after another on one CPU: what verification finds wrong with them."""
    table = Table(plan.subject(pipeline.sources(plan, TARGET)))
    found = []
    for move in table.model.moves:
        name = f"({move.x}, {move.y})"
        checks = list(move_checks(table, table.run(move, name)))
        assert {"lost_pulses_x", "lost_pulses_y"} <= {check.name for check in checks}
        found += [(name, check) for check in checks if not check.ok]
    events = [str(event) for event in (*table.cpu.violations, *table.cpu.faults)]
    return [*found, *(("all moves", Check("events", len(events), 0.0, "1", detail=event)) for event in events[:1])]


@pytest.mark.parametrize("seed", SEEDS)
def test_no_pulse_is_lost(seed: int) -> None:
    random = Random(seed)
    for number in range(JOBS):
        text, plan = accepted_job(random, MODES[number % 2], SHORT_MOVES[number // 2 % 2])
        found = missed(plan)
        assert not found, f"seed {seed}, job {number}: {found}\n{text}"


def test_directions_are_out_before_the_first_pulse() -> None:
    """Backwards, with a sample as short as a scan and a pulse in the first one."""
    text = """\
name = "Table"
method = "two-axis"
targets = ["s7-200-smart"]
length_unit = "cm"
sample_period = 0.005

[two-axis]
max_velocity = 1.5
max_acceleration = 20
jerk = 1000
pulses_per_unit = 60000

[[two-axis.moves]]
x = -0.1
y = -0.1
"""
    assert not missed(TwoAxisPlan.of(parse_job(text, "job.toml")))


def test_boundary_that_rounding_puts_behind_the_peak() -> None:
    """REAL takes the end of phase 3, counted in segments, for a little more than twice t1."""
    text = """\
name = "Table"
method = "two-axis"
targets = ["s7-200-smart"]
length_unit = "cm"
sample_period = 0.255

[two-axis]
max_velocity = 6.317193155094491
max_acceleration = 110.6294855235601
jerk = 4172.636355892535
pulses_per_unit = [103.88349796691911, 156.1763643678755]
mode = "table"
short_moves = "fixed-jerk-time"

[[two-axis.moves]]
x = -0.07422555762361165
y = -0.07422555762361165
"""
    assert not missed(TwoAxisPlan.of(parse_job(text, "job.toml")))
