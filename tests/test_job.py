"""The job file: what a right one gives, where its errors point, and that no input gets past both."""

from __future__ import annotations

import hashlib
import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plcgen.errors import JobError
from plcgen.job import Job, job_schema, parse_job, read_job
from plcgen.jobfile import METHODS, JobFile

TWO_AXIS_EXAMPLE = Path(__file__).parents[1] / "templates" / "jobs" / "two-axis.toml"
EXAMPLE = Path(__file__).parents[1] / "templates" / "jobs" / "hoist.toml"
SHORT = """\
name = "Shaft2"
method = "hoist"
targets = ["tia-scl"]
length_unit = "mm"
sample_period = 1
hoist.travel = 600_000
hoist.max_velocity = 12e3
hoist.acceleration = 750
hoist.jerk = 500
hoist.creep_velocity = 500
hoist.creep_out = 0
hoist.creep_in = 2500
"""


def refused(text: str) -> str:
    with pytest.raises(JobError) as caught:
        parse_job(text, "job.toml")
    return str(caught.value)


def test_example_job() -> None:
    job = read_job(EXAMPLE)
    hoist = job.hoist
    assert (job.name, job.method, job.targets) == ("MainShaft", "hoist", ("s7-300-scl", "tia-scl"))
    assert (job.length_unit, job.sample_period, job.file) == ("m", 0.010, "hoist.toml")
    assert (hoist.travel, hoist.max_velocity, hoist.jerk, hoist.creep_out) == (600.0, 12.0, 0.5, 1.433)
    assert (hoist.acceleration, hoist.deceleration, hoist.creep_acceleration) == (0.75, 0.75, 0.3)
    assert (job.blocks.fb_name, job.blocks.db_name) == ("MainShaft", "MainShaft_DB")
    assert (job.blocks.velocity_name, job.blocks.travel_name) == ("MainShaft_Velocity", "MainShaft_Travel")
    assert job.blocks.fc == 100


def test_two_axis_example_job() -> None:
    job = read_job(TWO_AXIS_EXAMPLE)
    keys = job.two_axis
    assert (job.name, job.method, job.targets) == ("Table", "two-axis", ("s7-200-smart",))
    assert (job.length_unit, job.sample_period, job.file) == ("cm", 0.050, "two-axis.toml")
    assert (keys.max_velocity, keys.max_acceleration, keys.jerk) == (1.5, 1.0, 1.0)
    assert (keys.pulses_per_unit, keys.ignore_below) == ((60000.0, 60000.0), 1000)
    assert [(move.x, move.y) for move in keys.moves] == [(1.5, 1.0), (-3.0, 2.5)]
    shown = TWO_AXIS_EXAMPLE.read_text(encoding="utf-8")
    assert all(f"{key} = " in shown for key in type(keys).model_fields if key != "moves")


def test_two_axis_example_shows_the_defaults() -> None:
    lines = TWO_AXIS_EXAMPLE.read_text(encoding="utf-8").splitlines()
    optional = [line for line in lines if "# optional: " in line]
    bare = parse_job("\n".join(line for line in lines if line not in optional), "bare.toml")
    assert len(optional) == 8
    assert bare.two_axis == read_job(TWO_AXIS_EXAMPLE).two_axis


def test_example_shows_every_key_and_the_defaults() -> None:
    job = read_job(EXAMPLE)
    shown = EXAMPLE.read_text(encoding="utf-8")
    assert all(
        f"{key} = " in shown
        for table in (job.hoist, job.hoist.envelope, job.blocks)
        for key in type(table).model_fields
        if key != "envelope"
    )
    bare = parse_job(shown.split("[hoist.envelope]")[0], "bare.toml")
    assert bare.hoist == job.hoist
    assert bare.blocks == job.blocks


def test_defaults_follow_the_length_unit() -> None:
    hoist = parse_job(SHORT, "short.toml").hoist
    assert (hoist.deceleration, hoist.creep_acceleration) == (750.0, 750.0)
    envelope = hoist.envelope
    assert (envelope.tracking_margin, envelope.brake_deceleration, envelope.end_velocity, envelope.overwind) == (
        300.0,
        1500.0,
        2000.0,
        500.0,
    )
    assert (envelope.overspeed_factor, envelope.tracking_factor, envelope.reaction_time) == (1.15, 1.10, 0.5)


def test_integers_become_numbers() -> None:
    job = parse_job(SHORT, "short.toml")
    assert isinstance(job.hoist.travel, float)
    assert isinstance(job.sample_period, float)


def test_ranges_follow_the_length_unit() -> None:
    assert "hoist.travel = 0.5 is out of range; write 100 to 10000000 mm" in refused(SHORT.replace("600_000", "0.5"))
    assert "[hoist] lacks jerk; add a line such as jerk = 500.0" in refused(SHORT.replace("hoist.jerk = 500", ""))


def test_job_is_frozen() -> None:
    job = parse_job(SHORT, "short.toml")
    with pytest.raises(AttributeError):
        job.name = "Other"  # type: ignore[misc]
    with pytest.raises(ValueError, match="frozen"):
        job.hoist.travel = 1.0
    assert hash(job) == hash(parse_job(SHORT, "short.toml"))


@pytest.mark.parametrize(
    "raw", [SHORT.encode(), SHORT.replace("\n", "\r\n").encode(), b"\xef\xbb\xbf" + SHORT.encode()]
)
def test_line_ends_and_byte_order_mark_do_not_change_a_job(tmp_path: Path, raw: bytes) -> None:
    path = tmp_path / "short.toml"
    path.write_bytes(raw)
    job = read_job(path)
    assert job == parse_job(SHORT, "short.toml")
    assert job.sha256 == hashlib.sha256(SHORT.encode()).hexdigest()


def test_place_in_a_file_with_byte_order_mark_and_wide_letters() -> None:
    text = "\ufeff" + SHORT.replace('"Shaft2"', '"主井"', 1)
    assert refused(text).startswith("job.toml:1:8: ")
    assert refused(SHORT.replace("[", '["井", ', 1)).startswith("job.toml:3:12: ")


@pytest.mark.parametrize(
    ("file", "header"),
    [
        ("jobs/a.toml", "a.toml"),
        ("a*).toml", "a__.toml"),
        ("主井.toml", "__.toml"),
        ("my job.toml", "my job.toml"),
        ("x\ny", "x_y"),
    ],
)
def test_file_name_may_stand_in_a_comment(file: str, header: str) -> None:
    assert parse_job(SHORT, file).file == header


def test_error_points_at_the_value_of_a_key() -> None:
    job = parse_job(SHORT, "short.toml")
    assert str(job.error("hoist.travel", "the travel is too short")) == (
        "short.toml:6:16: the travel is too short\n    hoist.travel = 600_000\n                   ^^^^^^^"
    )
    assert str(job.error("sample_period", "too long")).startswith("short.toml:5:17: too long")
    assert str(job.error("targets[0]", "no")).endswith('    targets = ["tia-scl"]\n               ^^^^^^^^^')


def test_error_points_at_the_table_of_a_defaulted_key() -> None:
    example = read_job(EXAMPLE)
    header = str(example.error("blocks.fb_name", "odd")).split("\n")[1]
    assert header.startswith("    [blocks]")
    job = parse_job(SHORT, "short.toml")
    assert str(job.error("hoist.envelope.overwind", "odd")).startswith("short.toml:6:1: odd")
    assert str(job.error("blocks.fb", "odd")) == "short.toml:1:1: odd"


def test_caret_spans_the_value() -> None:
    assert refused(SHORT.replace("600_000", "-1")).split("\n")[1:] == ["    hoist.travel = -1", "                   ^^"]


def test_first_problem_of_the_file_comes_first() -> None:
    text = SHORT.replace("= 500\n", "= nan\n").replace('"tia-scl"', '"tia"')
    assert refused(text).startswith(
        'job.toml:3:12: targets[0] = "tia" is unknown; write "tia-scl" (the first of 3 problems)\n'
    )


def test_unknown_key_comes_before_what_it_leaves_missing() -> None:
    unknown = refused(SHORT.replace("hoist.jerk", "hoist.ruck"))
    assert unknown.startswith("job.toml:9:1: unknown key hoist.ruck; known here: travel, max_velocity")


def test_empty_job() -> None:
    assert (
        refused("")
        == 'job.toml:1:1: the job lacks name; add a line such as name = "MainShaft" (the first of 6 problems)'
    )
    tables = refused(SHORT.split("hoist.")[0])
    assert tables == "job.toml:1:1: the job lacks the table [hoist]; `plcgen new hoist` writes an example"


def test_nesting_without_end() -> None:
    message = "job.toml:1:1: not a job file: nested too deep or a number too long"
    assert refused("x = " + "[" * 5000) == message
    assert refused("x = " + "9" * 5000) == message


def test_very_long_dotted_key_is_just_unknown() -> None:
    key = ".".join("x" * 2000)
    assert "unknown table [x]; known here: name, method" in refused(f"{key} = 1")


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        (SHORT.encode("utf-16"), "1:1: the file is UTF-16; save it as UTF-8"),
        (SHORT.encode("utf-16-le"), "1:1: the file is UTF-16; save it as UTF-8"),
        (
            b"# a\r\n" + "name = '主井'".encode("gbk"),
            "2:9: byte 16#D6 is not UTF-8 (GBK or a Windows code page?); save the file as UTF-8",
        ),
        (
            b"\xef\xbb\xbf# Aufz\xfcge",
            "1:7: byte 16#FC is not UTF-8 (GBK or a Windows code page?); save the file as UTF-8",
        ),
    ],
)
def test_other_encodings(tmp_path: Path, raw: bytes, message: str) -> None:
    path = tmp_path / "job.toml"
    path.write_bytes(raw)
    with pytest.raises(JobError) as caught:
        read_job(path)
    assert str(caught.value).split("\n")[0] == f"{path}:{message}"


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(JobError, match=r"none\.toml: cannot be read: No such file or directory"):
        read_job(tmp_path / "none.toml")


def test_method_that_a_target_does_not_serve(monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from plcgen.targets import TARGETS

    monkeypatch.setitem(TARGETS, "tia-scl", replace(TARGETS["tia-scl"], methods=frozenset()))
    message = (
        'job.toml:3:12: targets[0] = "tia-scl" does not serve the method "hoist"; write "s7-300-scl" or "s7-300-stl"'
    )
    assert refused(SHORT).split("\n")[0] == message


def test_methods_of_the_schema_and_of_the_reader_are_the_same() -> None:
    schema = job_schema()
    assert schema["anyOf"] == [{"$ref": f"#/$defs/{model.__name__}"} for model in METHODS.values()]
    for method, model in METHODS.items():
        keys = schema["$defs"][model.__name__]["properties"]
        assert issubclass(model, JobFile)
        assert keys["method"]["enum"] == list(METHODS)
        assert keys["method"]["examples"] == [method]
        assert method in keys


def test_schema_describes_every_key() -> None:
    schema = job_schema()
    tables = schema["$defs"].values()
    assert schema["title"] == "plcgen job"
    assert {table["title"] for table in tables} == {
        "HoistFile",
        "HoistLimits",
        "Envelope",
        "Blocks",
        "CosineFile",
        "CosineLimits",
        "CosineMove",
        "FunctionBlock",
        "TwoAxisFile",
        "TwoAxisLimits",
        "Move",
    }
    assert all(table["additionalProperties"] is False for table in tables)
    assert all(key["description"] for table in tables for key in table["properties"].values())
    jerk = schema["$defs"]["HoistLimits"]["properties"]["jerk"]
    assert jerk["description"] == "highest jerk (m/s3; here and in the default m stands for length_unit)"
    assert schema["$defs"]["HoistLimits"]["required"] == [
        "travel",
        "max_velocity",
        "acceleration",
        "jerk",
        "creep_velocity",
        "creep_out",
        "creep_in",
    ]
    assert schema["$defs"]["Envelope"]["properties"]["end_velocity"]["default"] == 2.0
    assert schema["$defs"]["TwoAxisFile"]["properties"]["sample_period"]["maximum"] == 0.255
    assert schema["$defs"]["TwoAxisLimits"]["required"] == [
        "max_velocity",
        "max_acceleration",
        "jerk",
        "pulses_per_unit",
        "moves",
    ]
    outputs = schema["$defs"]["TwoAxisLimits"]["properties"]["outputs"]
    assert outputs["items"] == {"enum": ["Q0.0", "Q0.1", "Q0.3"]}
    assert list(outputs["default"]) == ["Q0.0", "Q0.1"]
    assert schema["$defs"]["Move"]["required"] == ["x", "y"]


def test_pointing_at_places_costs_nothing_before_it_is_used() -> None:
    code = "import sys, plcgen.job; sys.exit('tree_sitter' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=EXAMPLE.parents[2], check=False).returncode == 0


def outcome(text: str) -> Job | JobError:
    try:
        return parse_job(text, "job.toml")
    except JobError as error:
        assert error.message
        assert "\n" not in error.message
        return error


def check_two_axis_job(job: Job) -> None:
    keys = job.two_axis
    lengths = [length for move in keys.moves for length in (move.x, move.y)]
    positive = (keys.max_velocity, keys.max_acceleration, keys.jerk, *keys.pulses_per_unit, job.sample_period)
    assert keys.moves
    assert all(isinstance(number, float) and math.isfinite(number) for number in (*lengths, *positive))
    assert all(number > 0 for number in positive)
    assert len({*keys.outputs, *keys.direction_outputs}) == 4


def check_job(job: Job | JobError) -> None:
    """What every job that gets through must promise."""
    if isinstance(job, JobError):
        return
    if job.method == "two-axis":
        check_two_axis_job(job)
        return
    names = (job.blocks.fb_name, job.blocks.db_name, job.blocks.velocity_name, job.blocks.travel_name)
    assert all(name.isascii() and name.replace("_", "").isalnum() for name in (job.name, *names))
    numbers = (*job.hoist.model_dump(exclude={"envelope"}).values(), *job.hoist.envelope.model_dump().values())
    assert all(isinstance(number, float) and math.isfinite(number) and number >= 0 for number in numbers)
    assert job.hoist.creep_velocity < job.hoist.max_velocity


WORDS = ("nan", "-inf", "0", "-1", "1e999", "true", "2024-01-01", "*)", "fb_name", "hoist.", "travel", '"""', "'''")
HEADERS = (
    "[two-axis]",
    "[[two-axis.moves]]",
    "[hoist]",
    "[[hoist]]",
    "[hoist.envelope]",
    "[blocks]",
    "\n[a.b]\n",
    "x = 1\n",
)
PIECES = st.sampled_from([*WORDS, *HEADERS, *"\"'[]{}=.,#_-\\\n\r\t \ufeff主é\0"])


@settings(max_examples=150, deadline=None)
@given(st.text() | st.lists(PIECES, max_size=25).map("".join))
def test_any_text_gives_a_job_or_an_error(text: str) -> None:
    check_job(outcome(text))


@settings(max_examples=300, deadline=None)
@given(st.sampled_from([SHORT, *(path.read_text(encoding="utf-8") for path in (EXAMPLE, TWO_AXIS_EXAMPLE))]), st.data())
def test_any_mutation_of_a_job_gives_a_job_or_an_error(text: str, data: st.DataObject) -> None:
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(start, min(len(text), start + 12)))
        text = text[:start] + data.draw(PIECES | st.text(max_size=3)) + text[end:]
    check_job(outcome(text))


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary() | st.binary().map(lambda tail: SHORT.encode() + tail))
def test_any_bytes_give_a_job_or_an_error(tmp_path: Path, raw: bytes) -> None:
    path = tmp_path / "job.toml"
    path.write_bytes(raw)
    try:
        check_job(read_job(path))
    except JobError as error:
        assert error.message
