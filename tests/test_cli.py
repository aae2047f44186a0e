"""The command line as its users and other tools meet it: output, exit codes, and nothing half written."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from plcgen import pipeline
from plcgen.check.verdict import Check, TargetVerdict
from plcgen.cli import main
from plcgen.job import read_job

ROOT = Path(__file__).parents[1]
MAIN_SHAFT = ROOT / "golden" / "main-shaft"
JOB = str(MAIN_SHAFT / "job.toml")
COMMANDS = ("new", "schema", "derive", "generate", "verify", "check", "lint", "run")
TARGETS = ("s7-300-scl", "s7-300-stl", "tia-scl")
GOOD = TargetVerdict((Check("stop_error", 0.0002, 0.001, "m"),))
BAD = TargetVerdict((Check("stop_error", 0.002, 0.001, "m", detail="up, perfect encoder"),))
COUNTER = """
FUNCTION_BLOCK FB1
VAR_INPUT step : INT := 1; END_VAR
VAR_OUTPUT count : INT; END_VAR
BEGIN
  count := count + step;
END_FUNCTION_BLOCK
"""


def plcgen(*arguments: str) -> Result:
    """Run in this process; `output` holds both streams."""
    return CliRunner().invoke(main, list(arguments))


@pytest.fixture
def verdict(monkeypatch: pytest.MonkeyPatch) -> dict[str, TargetVerdict]:
    """Verification that takes no time; a test may change what it says of a target."""
    said = dict.fromkeys(TARGETS, GOOD)
    monkeypatch.setattr(pipeline, "verify", lambda _plan, target, _files, _progress: said[target])
    return said


def test_help_names_every_command() -> None:
    text = plcgen("--help").output
    assert [name for name in COMMANDS if f"\n  {name} " not in text] == []


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_shows_an_example(command: str) -> None:
    result = plcgen(command, "--help")
    assert result.exit_code == 0
    assert f"plcgen {command}" in result.output.split("Example:")[1]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["verfy", JOB], 'unknown command "verfy"; write "verify"'),
        (["xyzzy"], 'unknown command "xyzzy"; there is new, schema, completion'),
        (["new", "host"], 'unknown method "host"; write "hoist"'),
        (["new", "two_axis"], 'unknown method "two_axis"; write "two-axis"'),
        (["new", "planetary"], 'unknown method "planetary"; write "hoist", "cosine" or "two-axis"'),
        (["derive", "absent.toml"], "absent.toml"),
        (["verify", JOB, "--target", "tia"], 'unknown target "tia"; write "tia-scl"'),
        (["run", "absent.scl", "--block", "FB1", "--scans", "0", "--period", "10ms"], "--scans"),
        (["check", "absent"], "absent: no such folder; plcgen check takes the folder of the golden cases"),
    ],
)
def test_bad_usage_ends_with_2_and_the_way_out(arguments: list[str], words: str) -> None:
    result = plcgen(*arguments)
    assert result.exit_code == 2
    assert words in result.output
    assert "Traceback" not in result.output


# ------------------------------------------------------------------------------------------------------------ jobs


def test_new_writes_a_job_that_verifies_as_it_stands(tmp_path: Path) -> None:
    job = tmp_path / "Schacht 1" / "é.toml"
    job.parent.mkdir()
    schema = job.with_name("plcgen.schema.json")
    assert plcgen("new", "hoist", "-o", str(job)).output == f"wrote {job}\nwrote {schema}\n"
    assert job.read_text("utf-8").splitlines()[0] == f"#:schema {schema.name}"
    assert schema.read_text("ascii") == plcgen("schema").output
    assert plcgen("derive", str(job)).exit_code == 0
    again = plcgen("new", "hoist", "-o", str(job))
    assert again.exit_code == 2
    assert again.output == f"error: {job}: exists already; name another file with -o\n"


def test_new_writes_a_two_axis_job_that_derives(tmp_path: Path) -> None:
    job = tmp_path / "table.toml"
    assert plcgen("new", "two-axis", "-o", str(job)).output.startswith(f"wrote {job}\n")
    assert read_job(job).method == "two-axis"
    result = plcgen("derive", str(job), "--json")
    assert result.exit_code == 0
    derived = json.loads(result.output)
    assert (derived["method"], derived["length_unit"]) == ("two-axis", "cm")
    legs = {leg["name"]: (round(leg["duration"], 6), round(leg["travel"], 6)) for leg in derived["legs"]}
    # 4 cbrt(1.5/2/jerk) = 3.634 s and 2 (1.3028 + 1) = 4.606 s, in whole samples of 0.05 s.
    assert legs == {"move 1 (90000, 60000)": (3.65, 1.5), "move 2 (-180000, 150000)": (4.65, 3.0)}
    constants = {row["name"]: row["value"] for table in derived["tables"] for row in table["constants"]}
    # t1 = a/jerk, t2 = v/a - a/jerk; full speed from v (v/a + a/jerk) on, full acceleration from 2 a^3/jerk^2 on.
    assert (constants["T1"], constants["T2"]) == pytest.approx((1.0, 0.5))
    assert (constants["S_FULL"], constants["S_JERK"]) == pytest.approx((3.75, 2.0))
    assert "Moves of Table" in plcgen("derive", str(job)).output


def test_derive_shows_the_phases_of_the_main_shaft() -> None:
    derived = json.loads(plcgen("derive", JOB, "--json").output)
    legs = {leg["name"]: (round(leg["duration"], 3), round(leg["travel"], 3)) for leg in derived["legs"]}
    assert legs == {
        "start ramp": (2.267, 0.567),
        "creep out": (2.866, 1.433),
        "accelerate": (16.833, 105.208),
        "full speed": (32.043, 384.517),
        "decelerate": (16.833, 105.208),
        "creep in": (5.0, 2.5),
        "stop ramp": (2.267, 0.567),
    }
    assert sum(leg["travel"] for leg in derived["legs"]) == pytest.approx(600.0, abs=1e-9)
    assert "(5)+(9)+(12)" in plcgen("derive", JOB).output


def test_wrong_job_points_at_its_place(tmp_path: Path) -> None:
    job = tmp_path / "job.toml"
    job.write_text((MAIN_SHAFT / "job.toml").read_text("utf-8").replace("max_velocity", "max_speed"), "utf-8")
    result = plcgen("generate", str(job), "-o", str(tmp_path / "out"))
    assert result.exit_code == 2
    place, line, caret = result.output.splitlines()[:3]
    assert place.startswith(f"error: {job}:")
    assert "hoist.max_speed" in place
    assert "max_velocity" in place
    assert line.strip().startswith("max_speed")
    assert caret.strip() == "^" * len("max_speed")
    assert not (tmp_path / "out").exists()


def test_schema_is_json_schema() -> None:
    schema = json.loads(plcgen("schema").output)
    assert "hoist" in json.dumps(schema)
    assert "two-axis" in json.dumps(schema)
    assert "max_velocity" in json.dumps(schema)


# ---------------------------------------------------------------------------------------------------- verification


@pytest.mark.usefixtures("verdict")
def test_generate_writes_each_target_into_its_folder(tmp_path: Path) -> None:
    result = plcgen("generate", JOB, "-o", str(tmp_path / "out"))
    assert result.exit_code == 0
    written = sorted(path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*.*"))
    stored = (path for folder in TARGETS for path in (MAIN_SHAFT / folder).iterdir())
    assert written == sorted(path.relative_to(MAIN_SHAFT).as_posix() for path in stored)
    for name in written:
        assert (tmp_path / "out" / name).read_bytes() == (MAIN_SHAFT / name).read_bytes()


def test_generate_writes_nothing_when_one_target_fails(tmp_path: Path, verdict: dict[str, TargetVerdict]) -> None:
    verdict["tia-scl"] = BAD
    result = plcgen("generate", JOB, "-o", str(tmp_path / "out"))
    assert result.exit_code == 1
    assert "error: 1 of 1 checks failed for tia-scl\n" in result.output
    assert "    tia-scl: stop_error: up, perfect encoder" in result.output
    assert result.output.endswith("nothing was written\n")
    assert not (tmp_path / "out").exists()


def test_unverified_sources_say_so(tmp_path: Path) -> None:
    result = plcgen("generate", JOB, "-o", str(tmp_path), "--no-verify", "--target", "s7-300-scl")
    assert result.exit_code == 0
    assert "warning: the sources are not verified; their headers say so" in result.output
    assert b"NOT VERIFIED" in (tmp_path / "s7-300-scl" / "MainShaft.scl").read_bytes()[:600]
    assert b"Not verified" in (tmp_path / "s7-300-scl" / "IMPORT.md").read_bytes()
    assert not (tmp_path / "tia-scl").exists()


def test_json_of_a_verification(verdict: dict[str, TargetVerdict]) -> None:
    verdict["tia-scl"] = BAD
    result = plcgen("verify", JOB, "--json")
    assert result.exit_code == 1
    said = json.loads(result.output[: result.output.rindex("}") + 1])
    estimates = said.pop("estimates")
    assert list(estimates) == list(verdict)
    assert [time["cpu"] for time in estimates["s7-300-stl"]["run_times"]] == ["CPU 314", "CPU 315-2DP", "CPU 317"]
    check = {"name": "stop_error", "value": 0.0002, "bound": 0.001, "unit": "m", "ok": True}
    assert said == {
        "ok": False,
        "job": "MainShaft",
        "targets": {
            "s7-300-scl": {"ok": True, "checks": [check]},
            "s7-300-stl": {"ok": True, "checks": [check]},
            "tia-scl": {"ok": False, "checks": [check | {"value": 0.002, "ok": False}]},
        },
    }


def test_verify_executes_files_from_disk(tmp_path: Path) -> None:
    source = (MAIN_SHAFT / "s7-300-scl" / "MainShaft.scl").read_bytes()
    edited = source.replace(b"statVelocity := 0.0;", b"statVelocity := 0.1;")
    assert edited != source
    (tmp_path / "MainShaft.scl").write_bytes(edited)
    result = plcgen("verify", JOB, "--source", str(tmp_path), "--target", "s7-300-scl")
    assert result.exit_code == 1
    assert "FAILED" in result.output
    assert "checks failed for s7-300-scl" in result.output


def test_verify_of_a_source_that_does_not_parse(tmp_path: Path) -> None:
    (tmp_path / "MainShaft.scl").write_text("FUNCTION_BLOCK FB100\nBEGIN\n  x := ;\nEND_FUNCTION_BLOCK\n")
    result = plcgen("verify", JOB, "--source", str(tmp_path), "--target", "s7-300-scl")
    assert result.exit_code == 2
    assert "MainShaft.scl:3:8: " in result.output


# ---------------------------------------------------------------------------------------------------------- sources


def test_lint_of_generated_sources_finds_nothing() -> None:
    files = [str(path) for folder in TARGETS for path in (MAIN_SHAFT / folder).glob("*.scl")]
    result = plcgen("lint", *files)
    assert (result.exit_code, result.output) == (0, "4 files, 0 errors, 0 warnings\n")


def test_lint_of_a_type_error(tmp_path: Path) -> None:
    path = tmp_path / "a.scl"
    path.write_bytes(COUNTER.replace("count + step", "count + 1.5").replace("\n", "\r\n").encode())
    result = plcgen("lint", str(path))
    assert result.exit_code == 1
    assert f"{path.name}:6:" in result.output
    assert "[types]" in result.output


def test_run_prints_a_row_each_scan(tmp_path: Path) -> None:
    path = tmp_path / "counter.scl"
    path.write_text(COUNTER)
    result = plcgen("run", str(path), "--block", "FB1", "--scans", "3", "--period", "10ms", "--set", "step=5")
    assert (result.exit_code, result.output) == (0, "scan,time,count\n0,0,5\n1,0.01,10\n2,0.02,15\n")


def test_run_with_a_fault_ends_with_1(tmp_path: Path) -> None:
    path = tmp_path / "counter.scl"
    path.write_text(COUNTER)
    result = plcgen("run", str(path), "--block", "FB1", "--scans", "2", "--period", "10ms", "--set", "step=30000")
    assert result.exit_code == 1
    assert "scan,time,count\n0,0,30000\n1,0.01,-5536\n" in result.output
    assert "counter.scl:6:18: overflow in FB1 at scan 1" in result.output


@pytest.mark.parametrize("encoding", ["gbk", "cp1252", "ascii"])
def test_a_console_of_another_code_page_shows_every_error(tmp_path: Path, encoding: str) -> None:
    folder = tmp_path / "Förderanlage 主井"
    folder.mkdir()
    job = folder / "job.toml"
    job.write_text('name = "主井"\n', "utf-8")
    run = subprocess.run(
        [sys.executable, "-m", "plcgen", "derive", str(job)],
        capture_output=True,
        check=False,
        env=os.environ | {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"},
    )
    assert run.returncode == 2
    assert b"Traceback" not in run.stderr
    assert b"job.toml:1:8: name = " in run.stderr
