"""Every wrong two-axis job ends with one sentence at one place, held here word for word."""

# ruff: noqa: E501 - a message stands in one piece, as the user reads it

from __future__ import annotations

import pytest

from plcgen import pipeline
from plcgen.errors import JobError
from plcgen.job import parse_job

JOB = """\
name = "Table"
method = "two-axis"
targets = ["s7-200-smart"]
length_unit = "cm"
sample_period = 0.050

[two-axis]
max_velocity = 1.5
max_acceleration = 1.0
jerk = 1.0
pulses_per_unit = 60000
mode = "interrupt"
v_memory = 1000
outputs = ["Q0.0", "Q0.1"]
direction_outputs = ["Q0.4", "Q0.5"]

[[two-axis.moves]]
x = 1.5
y = 1.0

[[two-axis.moves]]
x = -3.0
y = 2.5
"""
MOVES = JOB[JOB.index("[[two-axis.moves]]") :]
TABLE = JOB[JOB.index("[two-axis]") :]
IN_ONE_TABLE = TABLE.replace('"interrupt"', '"table"')

# What is written in the job above, what a user writes instead, and the place and words of the error.
CASES = [
    (
        '"Q0.0", "Q0.1"]',
        '"Q0.0", "Q0.2"]',
        '14:11: two-axis.outputs = ["Q0.0", "Q0.2"] names no output for this; write two of "Q0.0", "Q0.1" or "Q0.3"',
    ),
    (
        '["Q0.0", "Q0.1"]',
        '"Q0.0"',
        '14:11: two-axis.outputs = "Q0.0" is no pair of outputs; write two of "Q0.0", "Q0.1" or "Q0.3"',
    ),
    (
        '["Q0.0", "Q0.1"]',
        '["Q0.0"]',
        '14:11: two-axis.outputs = ["Q0.0"] is no pair of outputs; write two of "Q0.0", "Q0.1" or "Q0.3"',
    ),
    (
        '["Q0.0", "Q0.1"]',
        '["Q0.0", 1]',
        '14:11: two-axis.outputs = ["Q0.0", 1] is no pair of outputs; write two of "Q0.0", "Q0.1" or "Q0.3"',
    ),
    (
        '"Q0.0", "Q0.1"]',
        '"Q0.0", "Q0.0"]',
        '14:11: two-axis.outputs = ["Q0.0", "Q0.0"] names one output twice; write two different ones',
    ),
    (
        '["Q0.4", "Q0.5"]',
        '["Q0.4", "Q0.8"]',
        '15:21: two-axis.direction_outputs = ["Q0.4", "Q0.8"] names no output for this; write two of "Q0.0" to "Q31.7"',
    ),
    (
        '["Q0.4", "Q0.5"]',
        '["Q0.4", "Q32.0"]',
        '15:21: two-axis.direction_outputs = ["Q0.4", "Q32.0"] names no output for this; write two of "Q0.0" to "Q31.7"',
    ),
    (
        '["Q0.4", "Q0.5"]',
        '["Q0.4", "Q0.4"]',
        '15:21: two-axis.direction_outputs = ["Q0.4", "Q0.4"] names one output twice; write two different ones',
    ),
    (
        '["Q0.4", "Q0.5"]',
        '["Q0.4", "Q0.1"]',
        '15:30: two-axis.direction_outputs[1] = "Q0.1" is a pulse output; write another output',
    ),
    (
        '["Q0.4", "Q0.5"]',
        "[]",
        '15:21: two-axis.direction_outputs = [] is no pair of outputs; write two of "Q0.0" to "Q31.7"',
    ),
    (
        '["Q0.4", "Q0.5"]',
        '["q0.4", "Q0.5"]',
        '15:21: two-axis.direction_outputs = ["q0.4", "Q0.5"] names no output for this; write two of "Q0.0" to "Q31.7"',
    ),
    (
        "= 60000",
        "= [60000]",
        "11:19: two-axis.pulses_per_unit = [60000] is no pair of numbers; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= [60000, 1, 2]",
        "11:19: two-axis.pulses_per_unit = [60000, 1, 2] is no pair of numbers; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        '= [60000, "1"]',
        '11:19: two-axis.pulses_per_unit = [60000, "1"] is no pair of numbers; write a number, 0.001 to 10000000, or [x, y]',
    ),
    (
        "= 60000",
        "= []",
        "11:19: two-axis.pulses_per_unit = [] is no pair of numbers; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        '= "60000"',
        '11:19: two-axis.pulses_per_unit = "60000" is a text; write a number, 0.001 to 10000000, or [x, y]',
    ),
    (
        "= 60000",
        "= true",
        "11:19: two-axis.pulses_per_unit = true is a boolean; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= 0",
        "11:19: two-axis.pulses_per_unit = 0 is out of range; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= [60000, -1]",
        "11:19: two-axis.pulses_per_unit = [60000, -1] is out of range; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= [60000, nan]",
        "11:19: two-axis.pulses_per_unit = [60000, nan] is out of range; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= 2e7",
        "11:19: two-axis.pulses_per_unit = 2e7 is out of range; write a number, 0.001 to 10000000, or [x, y]",
    ),
    (
        "= 60000",
        "= { x = 1 }",
        "11:19: two-axis.pulses_per_unit = { x = 1 } is a table; write a number, 0.001 to 10000000, or [x, y]",
    ),
    ("0.050", "0.0505", "5:17: sample_period = 0.0505 is no whole number of milliseconds; write 0.050 or 0.051"),
    ("0.050", "0.256", "5:17: sample_period = 0.256 is out of range; write 0.001 to 0.255 s"),
    ("0.050", "1.5", "5:17: sample_period = 1.5 is out of range; write 0.001 to 0.255 s"),
    ("0.050", "0.0005", "5:17: sample_period = 0.0005 is out of range; write 0.001 to 0.255 s"),
    ("0.050", "0", "5:17: sample_period = 0 is not positive; write 0.001 to 0.255 s"),
    ("0.050", "1", "5:17: sample_period = 1 is out of range; write 0.001 to 0.255 s"),
    ("0.050", "50", "5:17: sample_period = 50 is out of range; write 0.001 to 0.255 s"),
    ("0.050", "0.2555", "5:17: sample_period = 0.2555 is out of range; write 0.001 to 0.255 s"),
    (MOVES, "", "7:2: [two-axis] lacks [[two-axis.moves]]; write one or more, and x and y below each"),
    (
        MOVES,
        "moves = []",
        "17:9: two-axis.moves = [] holds no move for verification; write [[two-axis.moves]] with x and y below",
    ),
    (
        MOVES,
        "moves = 5",
        "17:9: two-axis.moves = 5 is an integer; write [[two-axis.moves]] for each, and x and y below",
    ),
    (
        MOVES,
        "[two-axis.moves]\nx = 1\ny = 1\n",
        "17:2: two-axis.moves is a table; write [[two-axis.moves]] for each, and x and y below",
    ),
    (
        MOVES,
        "moves = [1]",
        "17:10: two-axis.moves[0] = 1 is an integer; write [[two-axis.moves]] for each, and x and y below",
    ),
    (
        MOVES,
        "moves = [[1.0, 2.0]]\n",
        "17:10: two-axis.moves[0] = [1.0, 2.0] is a list; write [[two-axis.moves]] for each, and x and y below",
    ),
    ("\ny = 1.0", "\n", "17:3: [two-axis.moves[0]] lacks y; add a line such as y = 100.0"),
    ("\nx = 1.5", "\n", "17:3: [two-axis.moves[0]] lacks x; add a line such as x = 150.0"),
    ("\ny = 1.0", "\ny = 1.0\nz = 5", "20:1: unknown key two-axis.moves[0].z; known here: x, y"),
    ("\ny = 1.0", "\ny = 1.0\nspeed = 5", "20:1: unknown key two-axis.moves[0].speed; known here: x, y"),
    ("\ny = 1.0", "\nY = 1.0", "19:1: unknown key two-axis.moves[0].Y; did you mean y?"),
    ("\ny = 1.0", '\ny = 1.0\nmode = "table"', "20:1: unknown key two-axis.moves[0].mode; mode belongs in [two-axis]"),
    (
        "\ny = 1.0",
        '\ny = "1.0"',
        '19:5: two-axis.moves[0].y = "1.0" is a text; write a number without quotes, -10000000 to 10000000 cm',
    ),
    ("\ny = 1.0", "\ny = nan", "19:5: two-axis.moves[0].y = nan is no finite number; write -10000000 to 10000000 cm"),
    ("y = 2.5", "y = 1e8", "23:5: two-axis.moves[1].y = 1e8 is out of range; write -10000000 to 10000000 cm"),
    (
        "y = 2.5",
        "y = 40000",
        "23:5: two-axis.moves[1].y = 40000 is 2400000000 pulses; 2147483647 are the most; divide the move",
    ),
    ("y = 2.5", "y = 2.5\ny = 3", "24:1: key two-axis.moves[1].y is written twice, first in line 23; keep one of them"),
    (
        "x = -3.0\ny = 2.5",
        "x = 0\ny = 0.0",
        "21:3: two-axis.moves[1] is no move: both components count as zero; write a longer one",
    ),
    (
        "x = -3.0\ny = 2.5",
        "x = 0.000009\ny = 0.0",
        "21:3: two-axis.moves[1] is no move: both components count as zero; write a longer one",
    ),
    ('"interrupt"', '"interupt"', '12:8: two-axis.mode = "interupt" is unknown; write "interrupt"'),
    ('"interrupt"', '"fast"', '12:8: two-axis.mode = "fast" is unknown; write "interrupt" or "table"'),
    ('"interrupt"', "5", '12:8: two-axis.mode = 5 is an integer; write "interrupt" or "table"'),
    (
        '"interrupt"',
        '"fast"\nshort_moves = "short"',
        '12:8: two-axis.mode = "fast" is unknown; write "interrupt" or "table" (the first of 2 problems)',
    ),
    (
        "max_velocity = 1.5",
        "max_velocity = 0",
        "8:16: two-axis.max_velocity = 0 is not positive; write 0.001 to 5000 cm/s",
    ),
    (
        "max_velocity = 1.5",
        "max_velocity = 5001",
        "8:16: two-axis.max_velocity = 5001 is out of range; write 0.001 to 5000 cm/s",
    ),
    ("= 1000", "= 8192", "13:12: two-axis.v_memory = 8192 is out of range; write 0 to 8191"),
    ("= 1000", "= -1", "13:12: two-axis.v_memory = -1 is out of range; write 0 to 8191"),
    ("= 1000", "= 1000.0", "13:12: two-axis.v_memory = 1000.0 is a decimal number; write a whole number, 0 to 8191"),
    (
        '["s7-200-smart"]',
        '["s7-300-scl"]',
        '3:12: targets[0] = "s7-300-scl" does not serve the method "two-axis"; write "s7-200-smart"',
    ),
    (
        '["s7-200-smart"]',
        '["s7-200-smart", "tia-scl"]',
        '3:28: targets[1] = "tia-scl" does not serve the method "two-axis"; remove it',
    ),
    (
        '["s7-200-smart"]',
        '"s7-200-smart"',
        '3:11: targets = "s7-200-smart" is a text; write a list, such as ["s7-200-smart"]',
    ),
    (
        '"two-axis"',
        '"hoist"',
        "7:2: unknown table [two-axis]; known here: name, method, targets, language, length_unit, sample_period, mnemonics, hoist, blocks (the first of 2 problems)",
    ),
    ('"two-axis"', '"twoaxis"', '2:10: method = "twoaxis" is unknown; write "two-axis"'),
    ('"two-axis"', '"two_axis"', '2:10: method = "two_axis" is unknown; write "two-axis"'),
    ("[two-axis]", "[two_axis]", "7:2: unknown table [two_axis]; did you mean [two-axis]?"),
    (
        "[two-axis]\n",
        "[hoist]\n",
        "7:2: unknown table [hoist]; known here: name, method, targets, language, length_unit, sample_period, two-axis (the first of 5 problems)",
    ),
    (TABLE, "", "1:1: the job lacks the table [two-axis]; `plcgen new two-axis` writes an example"),
    ("max_acceleration", "acceleration", "9:1: unknown key two-axis.acceleration; did you mean max_acceleration?"),
    ("jerk = 1.0", "", "7:2: [two-axis] lacks jerk; add a line such as jerk = 1.0"),
    ("jerk = 1.0", "jerk = 0.00001", "10:8: two-axis.jerk = 0.00001 is out of range; write 0.001 to 1000000 cm/s3"),
    (
        "jerk = 1.0",
        "jerk = 1.0\nfirst_subroutine = 121",
        "11:20: two-axis.first_subroutine = 121 is out of range; write 0 to 120",
    ),
    (
        "jerk = 1.0",
        "jerk = 1.0\ninterrupt_routine = 128",
        "11:21: two-axis.interrupt_routine = 128 is out of range; write 0 to 127",
    ),
    (
        "jerk = 1.0",
        "jerk = 1.0\nignore_below = 1000000",
        "18:3: two-axis.moves[0] is no move: both components count as zero; write a longer one (the first of 2 problems)",
    ),
    (
        "jerk = 1.0",
        "jerk = 1.0\nignore_below = 0.5",
        "11:16: two-axis.ignore_below = 0.5 is a decimal number; write a whole number, 0 to 1000000",
    ),
    (
        "y = 2.5",
        "y = 2.5\n[blocks]\nfb = 1",
        "24:2: unknown table [blocks]; known here: name, method, targets, language, length_unit, sample_period, two-axis",
    ),
    (
        "pulses_per_unit = 60000",
        "pulses_per_unit = 60000\ntravel = 5",
        "12:1: unknown key two-axis.travel; known here: max_velocity, max_acceleration, jerk, pulses_per_unit, ignore_below, mode, short_moves, v_memory, first_subroutine, interrupt_routine, outputs, direction_outputs, moves",
    ),
    (
        "pulses_per_unit = 60000",
        "",
        "7:2: [two-axis] lacks pulses_per_unit; add a line such as pulses_per_unit = 60000",
    ),
    ('["s7-200-smart"]', "[]", '3:11: targets = [] names no target; write one or more, such as ["s7-200-smart"]'),
    ('targets = ["s7-200-smart"]', "", '1:1: the job lacks targets; add a line such as targets = ["s7-200-smart"]'),
    ('method = "two-axis"', "", '1:1: the job lacks method; add a line such as method = "two-axis"'),
    ("max_velocity = 1.5", "velocity = 1.5", "8:1: unknown key two-axis.velocity; did you mean max_velocity?"),
    ("sample_period = 0.050", "", "1:1: the job lacks sample_period; add a line such as sample_period = 0.05"),
    (
        '"interrupt"\n',
        '"table"\nignore_below = 0\nshort_moves = "short"\n',
        '14:15: two-axis.short_moves = "short" is unknown; write "time-optimal" or "fixed-jerk-time"',
    ),
]

# The same of jobs that are right key by key and could not be kept.
PLAN_CASES = [
    (
        "max_velocity = 1.5",
        "max_velocity = 1.6",
        "8:16: max_velocity = 1.6 cm/s takes up to 96025 pulses/s; 93670 can be sent; write at most 1.56, or lower pulses_per_unit",
    ),
    (
        "= 60000",
        "= [60000, 70000]",
        "8:16: max_velocity = 1.5 cm/s takes up to 105029 pulses/s; 93670 can be sent; write at most 1.337, or lower pulses_per_unit",
    ),
    (
        "= 60000",
        "= [60000, 1e6]",
        "8:16: max_velocity = 1.5 cm/s takes up to 1500417 pulses/s; 93670 can be sent; write at most 0.09325, or lower pulses_per_unit",
    ),
    (
        "0.050",
        "0.001",
        "8:16: max_velocity = 1.5 cm/s takes up to 90000 pulses/s; 89750 can be sent; write at most 1.495, or lower pulses_per_unit",
    ),
    (
        "= 1000",
        "= 8000",
        "13:12: v_memory = 8000 leaves too little: 328 bytes are needed up to VB8191; write at most 7864",
    ),
    (
        '"interrupt"\nv_memory = 1000',
        '"table"\nv_memory = 3000',
        "13:12: v_memory = 3000 leaves too little: 6472 bytes are needed up to VB8191; write at most 1720",
    ),
    (
        '"interrupt"\nv_memory = 1000',
        '"table"\nv_memory = 2000',
        "13:12: v_memory = 2000 leaves too little: 6472 bytes are needed up to VB8191; write at most 1720",
    ),
    (
        "jerk = 1.0",
        'jerk = 0.6\nshort_moves = "fixed-jerk-time"',
        '11:15: short_moves = "fixed-jerk-time" needs max_velocity >= max_acceleration^2/jerk = 1.66667; raise jerk, or write "time-optimal"',
    ),
    (
        "max_acceleration = 1.0",
        "max_acceleration = 0.01",
        "9:20: max_acceleration = 0.01 takes 6750450 pulses to full speed; 4194304 are the most; raise it or jerk, or lower max_velocity",
    ),
    (
        '"Table"',
        '"MainShaftNumber7"',
        '1:8: name = "MainShaftNumber7" has 16 characters; s7-200-smart takes 11, for the symbol MainShaftNumber7_SpeedBefore comes of it',
    ),
    (
        TABLE,
        IN_ONE_TABLE.replace("y = 1.0", "y = 0.0001"),
        '17:3: an axis sends 1.65 pulses/s in the mean; a table needs 8, for an output cannot go below 1 Hz; raise ignore_below, or write mode = "interrupt"',
    ),
    (
        TABLE,
        IN_ONE_TABLE.replace("x = 1.5", "x = 1000"),
        '17:3: the move takes 669 s; a table holds 640 s; divide it, or write mode = "interrupt"',
    ),
    (
        TABLE,
        IN_ONE_TABLE.replace("jerk = 1.0", "jerk = 1e6"),
        '17:3: a phase of jerk takes 0.001 ms; a table needs 2 ms; lower jerk, or write mode = "interrupt"',
    ),
    (
        TABLE,
        TABLE.replace("velocity = 1.5", "velocity = 0.001").replace("x = -3.0", "x = -500"),
        "21:3: the move takes 10000002 samples; 8388608 are the most; lengthen sample_period",
    ),
]


def first_line(error: JobError) -> str:
    return str(error).split("\n")[0]


@pytest.mark.parametrize(("right", "wrong", "message"), CASES)
def test_error(right: str, wrong: str, message: str) -> None:
    assert right in JOB
    with pytest.raises(JobError) as caught:
        parse_job(JOB.replace(right, wrong, 1), "job.toml")
    assert first_line(caught.value) == f"job.toml:{message}"


@pytest.mark.parametrize(("right", "wrong", "message"), PLAN_CASES)
def test_error_of_the_plan(right: str, wrong: str, message: str) -> None:
    assert right in JOB
    job = parse_job(JOB.replace(right, wrong, 1), "job.toml")
    with pytest.raises(JobError) as caught:
        pipeline.prepare(job)
    assert first_line(caught.value) == f"job.toml:{message}"


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("0.050", "0.255"),
        ("0.050", "0.002"),
        ("1.5\nmax_acc", "1.56\nmax_acc"),
        ("v_memory = 1000", "v_memory = 7864"),
        ('"interrupt"\nv_memory = 1000', '"table"\nv_memory = 1720'),
        ("= 60000", "= [60000, 30000]"),
        ('["Q0.0", "Q0.1"]', '["Q0.3", "Q0.0"]'),
        ('["Q0.4", "Q0.5"]', '["Q31.7", "Q0.3"]'),
        ("x = 1.5", "x = 0"),
    ],
)
def test_the_way_out_leads_out(right: str, wrong: str) -> None:
    assert right in JOB
    pipeline.prepare(parse_job(JOB.replace(right, wrong, 1), "job.toml"))


def test_longest_move_is_the_range_of_a_pulse_counter() -> None:
    long = JOB.replace("= 60000", "= 1").replace("y = 2.5", "y = 2147483647")
    with pytest.raises(JobError, match=r"y = 2147483647 is out of range; write -10000000 to 10000000 cm"):
        parse_job(long, "job.toml")
    whole = JOB.replace("= 60000", "= 1000").replace("y = 2.5", "y = {}")
    parse_job(whole.format("2147483.647"), "job.toml")
    with pytest.raises(JobError) as caught:
        parse_job(whole.format("-2147483.648"), "job.toml")
    assert "y = -2147483.648 is 2147483648 pulses; 2147483647 are the most; divide the move" in str(caught.value)


def test_one_number_of_pulses_is_meant_for_both_axes() -> None:
    assert parse_job(JOB, "job.toml").two_axis.pulses_per_unit == (60000.0, 60000.0)
    pair = parse_job(JOB.replace("= 60000", "= [60000, 1.5]"), "job.toml").two_axis
    assert pair.pulses_per_unit == (60000.0, 1.5)


def test_defaults() -> None:
    optional = ("mode", "v_memory", "outputs", "direction_outputs")
    bare = "\n".join(line for line in JOB.split("\n") if not line.startswith(optional))
    keys = parse_job(bare, "job.toml").two_axis
    assert keys == parse_job(JOB, "job.toml").two_axis
    assert (keys.ignore_below, keys.short_moves) == (0, "time-optimal")
    assert (keys.first_subroutine, keys.interrupt_routine) == (0, 0)
