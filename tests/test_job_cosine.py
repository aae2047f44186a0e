"""Jobs of the method cosine: read as written, defaulted, described, and refused word for word."""

# ruff: noqa: E501 - a message stands in one piece, as the user reads it

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from plcgen.errors import JobError
from plcgen.job import CosineLimits, CosineMove, Job, job_schema, parse_job, read_job
from plcgen.jobfile_cosine import FITS, LONGEST_FILTER, SHAPES
from plcgen.profile import cosine_fit
from plcgen.targets import TARGETS

EXAMPLE = Path(__file__).parents[1] / "templates" / "jobs" / "cosine.toml"

JOB = """\
name = "Spindle"
method = "cosine"
targets = ["s7-300-scl", "tia-scl"]
length_unit = "m"
sample_period = 0.010

[cosine]
max_velocity = 12.0
max_acceleration = 0.75
jerk = 0.5

[[cosine.moves]]
from = 0.0
to = 12.0

[[cosine.moves]]
from = 12.0
to = -3.0
then = 5.0
after = 8.0

[blocks]
fb = 100
"""
RAMPS = JOB[JOB.index("\n[[cosine.moves]]") : JOB.index("\n[blocks]")]
MOVES = """\
shape = "half-sine"

[[cosine.moves]]
distance = 5.0

[[cosine.moves]]
distance = -2.5
"""


def moves_with(right: str, wrong: str) -> str:
    assert right in MOVES
    return MOVES.replace(right, wrong, 1)


# What is written in the job above, what a user writes instead, and the place and words of the error.
CONFLICTS = [
    (
        RAMPS,
        "filter_length = 1\n" + MOVES,
        '11:17: cosine.filter_length = 1 keeps no jerk limit: the acceleration of a half-sine jumps at both ends, and only the average spreads it; write 2 or more, or shape = "centred"',
    ),
    (
        RAMPS,
        "moves = []\n",
        "11:9: cosine.moves = [] holds no move for verification; write [[cosine.moves]] with from and to below",
    ),
    (
        RAMPS,
        'shape = "half-sine"\nmoves = []\n',
        "12:9: cosine.moves = [] holds no move for verification; write [[cosine.moves]] with distance below",
    ),
    (
        RAMPS,
        "",
        "7:2: [cosine] lacks [[cosine.moves]]; write one or more; `plcgen new cosine` writes an example",
    ),
    ("from = 0.0\n", "", '12:3: cosine.moves[0] lacks from; shape = "centred" wants from and to'),
    ("to = -3.0\n", "", '16:3: cosine.moves[1] lacks to; shape = "centred" wants from and to'),
    ("from = 0.0\nto = 12.0\n", "", '12:3: cosine.moves[0] lacks from and to; shape = "centred" wants from and to'),
    (
        "from = 0.0\nto = 12.0\n",
        "distance = 5.0\n",
        '12:3: cosine.moves[0] lacks from and to; shape = "centred" wants from and to (the first of 2 problems)',
    ),
    (
        "to = 12.0\n",
        "to = 12.0\ndistance = 5.0\n",
        '15:12: cosine.moves[0].distance = 5.0 does not belong to shape = "centred", which wants from and to',
    ),
    (
        RAMPS,
        moves_with("distance = 5.0", "distance = 5.0\nto = 1.0"),
        '15:6: cosine.moves[0].to = 1.0 does not belong to shape = "half-sine", which wants distance',
    ),
    (
        RAMPS,
        moves_with("distance = 5.0", "distance = 5.0\nfrom = 1.0"),
        '15:8: cosine.moves[0].from = 1.0 does not belong to shape = "half-sine", which wants distance',
    ),
    (
        RAMPS,
        moves_with("distance = 5.0", "distance = 5.0\nafter = 1.0"),
        '15:9: cosine.moves[0].after = 1.0 does not belong to shape = "half-sine", which wants distance',
    ),
    (
        RAMPS,
        moves_with("distance = 5.0", "distance = 5.0\nthen = 1.0\nafter = 1.0"),
        '15:8: cosine.moves[0].then = 1.0 does not belong to shape = "half-sine", which wants distance (the first of 2 problems)',
    ),
    (
        RAMPS,
        moves_with("distance = 5.0", "from = 0.0\nto = 1.0"),
        '13:3: cosine.moves[0] lacks distance; shape = "half-sine" wants distance (the first of 3 problems)',
    ),
    (
        RAMPS,
        moves_with("distance = -2.5\n", ""),
        '16:3: cosine.moves[1] lacks distance; shape = "half-sine" wants distance',
    ),
    (
        RAMPS,
        moves_with("distance = -2.5", "distance = -0.0"),
        "17:12: cosine.moves[1].distance = -0.0 is no move; write how far to go",
    ),
    (
        RAMPS,
        "\n" + MOVES[MOVES.index("[[") :],
        '12:3: cosine.moves[0] lacks from and to; shape = "centred" wants from and to (the first of 4 problems)',
    ),
    (
        "then = 5.0\n",
        "",
        "16:3: cosine.moves[1] gives only one of then and after; write both, the other speed and when it is ordered, or none",
    ),
    (
        "after = 8.0\n",
        "",
        "16:3: cosine.moves[1] gives only one of then and after; write both, the other speed and when it is ordered, or none",
    ),
    ("to = 12.0", "to = 12.1", "14:6: cosine.moves[0].to = 12.1 is above max_velocity = 12; write at most that"),
    ("from = 12.0", "from = -13", "17:8: cosine.moves[1].from = -13 is above max_velocity = 12; write at most that"),
    ("then = 5.0", "then = 12.5", "19:8: cosine.moves[1].then = 12.5 is above max_velocity = 12; write at most that"),
]

# The same of keys that are wrong alone.
CASES = [
    ("[cosine]", "[cosin]", "7:2: unknown table [cosin]; did you mean [cosine]?"),
    ("jerk = 0.5", "jerks = 0.5", "10:1: unknown key cosine.jerks; did you mean jerk?"),
    (
        "jerk = 0.5",
        "jerk = 0.5\nfilter_lenght = 16",
        "11:1: unknown key cosine.filter_lenght; did you mean filter_length?",
    ),
    (
        "jerk = 0.5",
        "jerk = 0.5\nacceleration = 1",
        "11:1: unknown key cosine.acceleration; did you mean max_acceleration?",
    ),
    ("to = 12.0", "too = 12.0", "14:1: unknown key cosine.moves[0].too; did you mean to?"),
    (
        "to = 12.0",
        "torque = 12.0",
        "14:1: unknown key cosine.moves[0].torque; known here: from, to, then, after, distance",
    ),
    ("jerk = 0.5\n", "", "7:2: [cosine] lacks jerk; add a line such as jerk = 0.5"),
    ("max_velocity = 12.0\n", "", "7:2: [cosine] lacks max_velocity; add a line such as max_velocity = 12.0"),
    (
        "max_velocity = 12.0",
        "max_velocity = 51",
        "8:16: cosine.max_velocity = 51 is out of range; write 0.0001 to 50 m/s",
    ),
    (
        "max_velocity = 12.0",
        'max_velocity = "12"',
        '8:16: cosine.max_velocity = "12" is a text; write a number without quotes, 0.0001 to 50 m/s',
    ),
    (
        "max_acceleration = 0.75",
        "max_acceleration = 1001",
        "9:20: cosine.max_acceleration = 1001 is out of range; write 0.0001 to 1000 m/s2",
    ),
    ("jerk = 0.5", "jerk = 0", "10:8: cosine.jerk = 0 is not positive; write 0.0001 to 100000 m/s3"),
    ("to = 12.0", "to = 51", "14:6: cosine.moves[0].to = 51 is out of range; write -50 to 50 m/s"),
    ("to = 12.0", "to = nan", "14:6: cosine.moves[0].to = nan is no finite number; write -50 to 50 m/s"),
    ("after = 8.0", "after = 0", "20:9: cosine.moves[1].after = 0 is not positive; write 0.001 to 10000 s"),
    ("after = 8.0", "after = 20000", "20:9: cosine.moves[1].after = 20000 is out of range; write 0.001 to 10000 s"),
    ("jerk = 0.5", "jerk = 0.5\nfilter_length = 0", "11:17: cosine.filter_length = 0 is out of range; write 1 to 512"),
    (
        "jerk = 0.5",
        "jerk = 0.5\nfilter_length = 513",
        "11:17: cosine.filter_length = 513 is out of range; write 1 to 512",
    ),
    (
        "jerk = 0.5",
        "jerk = 0.5\nfilter_length = 16.0",
        "11:17: cosine.filter_length = 16.0 is a decimal number; write a whole number, 1 to 512",
    ),
    ("jerk = 0.5", 'jerk = 0.5\nfit = "mini-max"', '11:7: cosine.fit = "mini-max" is unknown; write "minimax"'),
    (
        "jerk = 0.5",
        'jerk = 0.5\nfit = "spline"',
        '11:7: cosine.fit = "spline" is unknown; write "minimax", "least-squares", "genetic" or "taylor"',
    ),
    (
        "jerk = 0.5",
        "jerk = 0.5\nfit = 3",
        '11:7: cosine.fit = 3 is an integer; write "minimax", "least-squares", "genetic" or "taylor"',
    ),
    ("jerk = 0.5", 'jerk = 0.5\nshape = "half_sine"', '11:9: cosine.shape = "half_sine" is unknown; write "half-sine"'),
    ("jerk = 0.5", "jerk = 0.5\nseed = -1", "11:8: cosine.seed = -1 is out of range; write 0 to 2147483647"),
    (
        "jerk = 0.5",
        "jerk = 0.5\nseed = 1.5",
        "11:8: cosine.seed = 1.5 is a decimal number; write a whole number, 0 to 2147483647",
    ),
    ("jerk = 0.5", "jerk = 0.5\nv_memory = 8192", "11:12: cosine.v_memory = 8192 is out of range; write 0 to 8191"),
    (
        "jerk = 0.5",
        "jerk = 0.5\nfirst_subroutine = 127",
        "11:20: cosine.first_subroutine = 127 is out of range; write 0 to 126",
    ),
    (
        "jerk = 0.5",
        "jerk = 0.5\ninterrupt_routine = 128",
        "11:21: cosine.interrupt_routine = 128 is out of range; write 0 to 127",
    ),
    ("fb = 100", "fc = 100", "23:1: unknown key blocks.fc; known here: fb, db, fb_name, db_name"),
    (
        '"Spindle"',
        '"Spindle_1234567890123456"',
        '1:8: name = "Spindle_1234567890123456" has 24 characters; s7-300-scl takes 21, for Spindle_1234567890123456_DB comes of it',
    ),
    (
        "fb = 100",
        'db_name = "spindle"',
        '23:11: blocks.db_name = "spindle" names another block too, Spindle; write another name',
    ),
]


def first_line(error: JobError) -> str:
    return str(error).split("\n")[0]


def job_with(right: str, wrong: str) -> Job:
    assert right in JOB
    return parse_job(JOB.replace(right, wrong, 1), "job.toml")


@pytest.mark.parametrize(("right", "wrong", "message"), [*CONFLICTS, *CASES])
def test_error(right: str, wrong: str, message: str) -> None:
    with pytest.raises(JobError) as caught:
        job_with(right, wrong)
    assert first_line(caught.value) == f"job.toml:{message}"


def test_the_caret_stands_under_what_is_wrong() -> None:
    with pytest.raises(JobError) as caught:
        job_with("then = 5.0", "then = -12.5")
    assert str(caught.value).split("\n")[1:] == ["    then = -12.5", "           ^^^^^"]


def test_limits_follow_the_length_unit() -> None:
    with pytest.raises(JobError) as caught:
        job_with('"m"\nsample_period = 0.010', '"mm"\nsample_period = 0.010\ncosine.jerk = 1e9')
    assert "cosine.jerk" in first_line(caught.value)
    wrong = JOB.replace('"m"', '"mm"').replace("max_velocity = 12.0", "max_velocity = 50001")
    with pytest.raises(JobError) as caught:
        parse_job(wrong, "job.toml")
    assert (
        first_line(caught.value)
        == "job.toml:8:16: cosine.max_velocity = 50001 is out of range; write 0.1 to 50000 mm/s"
    )


def test_the_longest_timed_interrupt_of_the_smart(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of that target only: the others take any period that a job may have."""
    smart = TARGETS["s7-200-smart"]
    monkeypatch.setitem(TARGETS, smart.name, replace(smart, methods=smart.methods | {"cosine"}))
    for period in (0.255, 1.0):
        job_with("0.010", str(period))
    wider = JOB.replace('"tia-scl"]', '"s7-200-smart"]')
    parse_job(wider.replace("0.010", "0.255"), "job.toml")
    with pytest.raises(JobError) as caught:
        parse_job(wider.replace("0.010", "0.256"), "job.toml")
    assert first_line(caught.value) == (
        "job.toml:5:17: sample_period = 0.256 is too long for the timed interrupt of s7-200-smart; write at most 0.255"
    )


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        (RAMPS, MOVES),
        (RAMPS, "filter_length = 2\n" + MOVES),
        (RAMPS, 'filter_length = 1\nshape = "centred"\n' + RAMPS),
        (RAMPS, "filter_length = 512\n" + RAMPS),
        (RAMPS, "moves = [{ from = 1, to = 2 }]\n"),
        (RAMPS, 'shape = "half-sine"\nmoves = [{ distance = 1 }]\n'),
        ("then = 5.0\nafter = 8.0\n", ""),
        ("from = 0.0", "from = -12.0"),
        ("then = 5.0", "then = -12"),
        ("to = 12.0", "to = 0"),
        ("[blocks]\nfb = 100\n", ""),
    ],
)
def test_the_way_out_leads_out(right: str, wrong: str) -> None:
    job_with(right, wrong)


def test_the_example_is_read_as_written() -> None:
    job = read_job(EXAMPLE)
    assert (job.name, job.method, job.length_unit, job.sample_period) == ("Spindle", "cosine", "m", 0.01)
    keys = job.cosine
    assert (keys.max_velocity, keys.max_acceleration, keys.jerk) == (12.0, 0.75, 0.5)
    assert (keys.filter_length, keys.fit, keys.shape, keys.seed) == (16, "minimax", "centred", 1)
    assert (keys.v_memory, keys.first_subroutine, keys.interrupt_routine) == (1000, 0, 0)
    assert [(m.from_velocity, m.to_velocity, m.then_velocity, m.after, m.distance) for m in keys.moves] == [
        (0.0, 12.0, None, None, None),
        (12.0, 0.0, None, None, None),
        (0.0, 10.0, -2.0, 8.0, None),
    ]
    blocks = job.function_block
    assert (blocks.fb, blocks.db, blocks.fb_name, blocks.db_name) == (100, 100, "Spindle", "Spindle_DB")


def test_the_example_names_every_key() -> None:
    """A user finds in it all there is, as a line or as a comment."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for key in CosineLimits.model_fields:
        assert f"\n{key} = " in text or f"[[cosine.{key}]]" in text, key
    for key in ("from", "to", "then", "after"):
        assert f"\n{key} = " in text, key


def test_what_the_example_calls_a_default_is_one() -> None:
    optional = [line for line in EXAMPLE.read_text(encoding="utf-8").split("\n") if "# optional" in line]
    assert [line.split(" ")[0] for line in optional] == [
        "language",
        "filter_length",
        "fit",
        "shape",
        "seed",
        "v_memory",
        "first_subroutine",
        "interrupt_routine",
        "then",
        "[blocks]",
    ]
    keys, written = parse_job(JOB, "job.toml").cosine, read_job(EXAMPLE).cosine
    assert keys.model_copy(update={"moves": ()}) == written.model_copy(update={"moves": ()})


def test_defaults() -> None:
    keys = parse_job(JOB, "job.toml").cosine
    assert (keys.filter_length, keys.fit, keys.shape, keys.seed) == (16, "minimax", "centred", 1)
    assert (keys.v_memory, keys.first_subroutine, keys.interrupt_routine) == (1000, 0, 0)
    assert keys.moves[0].then_velocity is keys.moves[0].after is keys.moves[0].distance is None


def test_moves_of_a_half_sine() -> None:
    keys = job_with(RAMPS, MOVES).cosine
    assert keys.shape == "half-sine"
    assert [move.distance for move in keys.moves] == [5.0, -2.5]
    assert all(move.from_velocity is None and move.to_velocity is None for move in keys.moves)


def test_a_job_of_ramps_has_no_hoist() -> None:
    job = parse_job(JOB, "job.toml")
    with pytest.raises(AssertionError):
        _ = job.hoist


def test_fits_of_the_job_and_of_the_profile_are_the_same() -> None:
    assert cosine_fit.FITS == FITS


def schema_of(model: type[CosineLimits] | type[CosineMove]) -> dict[str, Any]:
    table: dict[str, Any] = job_schema()["$defs"][model.__name__]
    return table


def test_schema_has_every_key_with_its_description() -> None:
    limits, move = schema_of(CosineLimits)["properties"], schema_of(CosineMove)["properties"]
    assert list(limits) == list(CosineLimits.model_fields)
    assert list(move) == ["from", "to", "then", "after", "distance"]
    assert all(key["description"] for key in (*limits.values(), *move.values()))
    assert limits["jerk"]["description"].startswith("highest jerk (m/s3;")
    assert move["after"]["description"] == "from the begin of the ramp to the order of `then` (s)"


def test_schema_knows_ranges_choices_and_defaults() -> None:
    table = schema_of(CosineLimits)
    keys = table["properties"]
    assert table["required"] == ["max_velocity", "max_acceleration", "jerk", "moves"]
    assert "required" not in schema_of(CosineMove)
    assert keys["fit"]["enum"] == list(FITS)
    assert keys["shape"]["enum"] == list(SHAPES)
    assert (keys["filter_length"]["minimum"], keys["filter_length"]["maximum"]) == (1, LONGEST_FILTER)
    assert [keys[key]["default"] for key in ("fit", "shape", "seed", "filter_length")] == ["minimax", "centred", 1, 16]


def test_schema_allows_what_any_length_unit_allows() -> None:
    """An editor that goes by it must not refuse a reverse speed in mm/s."""
    keys = schema_of(CosineMove)["properties"]
    assert (keys["from"]["minimum"], keys["from"]["maximum"]) == (-50_000.0, 50_000.0)
    assert (keys["distance"]["minimum"], keys["distance"]["maximum"]) == (-1e7, 1e7)
    assert (keys["after"]["minimum"], keys["after"]["maximum"]) == (0.001, 1e4)
    assert schema_of(CosineLimits)["properties"]["max_velocity"]["minimum"] == 1e-4
