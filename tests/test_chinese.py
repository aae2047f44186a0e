"""Jobs with Chinese comments by the command line: written, verified, read back from disk, linted and run."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from plcgen import pipeline
from plcgen.cli import main
from plcgen.golden import unified
from plcgen.job import Job, parse_job, read_job
from plcgen.lint import lint_files
from plcgen.plc.source import EIGHT_BIT, GBK, UTF_8, Span, decode_source

GOLDEN = Path(__file__).parents[1] / "golden"
RAMPS, TABLE = GOLDEN / "chinese-ramps", GOLDEN / "chinese-table"


def plcgen(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


def chinese(name: str) -> Job:
    return parse_job(f'language = "zh"\n{(GOLDEN / name / "job.toml").read_text("utf-8")}', "job.toml")


# ----------------------------------------------------------------------------------------------------------- jobs


@pytest.mark.parametrize("method", ["hoist", "cosine", "two-axis"])
def test_new_writes_a_job_with_chinese_comments(tmp_path: Path, method: str) -> None:
    job = tmp_path / "任务.toml"
    assert plcgen("new", method, "--language", "zh", "-o", str(job)).exit_code == 0
    assert read_job(job).language == "zh"
    assert "加加速度" in job.read_text("utf-8")


def test_a_language_that_there_is_not() -> None:
    result = plcgen("new", "hoist", "--language", "de")
    assert result.exit_code == 2
    assert "'de' is not one of 'en', 'zh'" in result.output


def test_schema_and_default() -> None:
    schema = json.loads(plcgen("schema").output)
    keys = [table["properties"]["language"] for table in schema["$defs"].values() if "method" in table["properties"]]
    assert [(key["enum"], key["default"]) for key in keys] == [(["en", "zh"], "en")] * 3
    assert read_job(GOLDEN / "ramps" / "job.toml").language == "en"


# ---------------------------------------------------------------------------------------------------- verification


@pytest.mark.parametrize("target", ["s7-300-scl", "s7-300-stl", "tia-scl"])
def test_a_hoist_with_chinese_comments_verifies(target: str) -> None:
    """The golden cases do the same for the other methods."""
    plan = pipeline.prepare(chinese("short-shaft"))
    assert pipeline.verify(plan, target, pipeline.sources(plan, target)).ok


def test_verify_takes_files_from_disk(tmp_path: Path) -> None:
    shutil.copytree(TABLE / "s7-200-smart", tmp_path / "s7-200-smart")
    result = plcgen("verify", str(TABLE / "job.toml"), "--source", str(tmp_path))
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize(
    "files",
    ["s7-300-scl/*.scl", "s7-300-stl/*.awl", "tia-scl/*.scl", "s7-200-smart/*_*.awl"],
)
def test_chinese_sources_lint_clean(files: str) -> None:
    paths = sorted(RAMPS.glob(files))
    assert paths
    assert lint_files(paths) == []


@pytest.mark.parametrize(
    ("file", "block"),
    [("s7-300-scl/Spindle.scl", "FB100"), ("s7-300-stl/Spindle.awl", "FB100"), ("tia-scl/Spindle.scl", "Spindle")],
)
def test_chinese_sources_run(file: str, block: str) -> None:
    watched = "velocitySetpoint"
    result = plcgen("run", str(RAMPS / file), "--block", block, "--scans", "3", "--period", "10ms", "--watch", watched)
    assert result.exit_code == 0, result.output
    assert watched in result.output


# ------------------------------------------------------------------------------------------------------- encodings


@pytest.mark.parametrize(
    ("text", "codec", "encoding"),
    [
        ("x := 1; // 设定值", "gbk", GBK),
        ("x := 1; // 阈值的最大面积为 300 ㎡", "gbk", GBK),
        ("x := 1; // 设定值", "utf-8", UTF_8),
        ("x := 1; // 设定值", "utf-8-sig", UTF_8),
        ("x := 1; // plain", "ascii", UTF_8),
        ("x := 1; // größe", "cp1252", EIGHT_BIT),
        ("x := 1; // für die Größe, Öl über Ärger", "cp1252", EIGHT_BIT),
        ("x := 1; // Скорость подъёма, заданная", "cp1251", EIGHT_BIT),
        ("x := 1; // скорость", "cp1251", EIGHT_BIT),
    ],
)
def test_what_a_file_is_taken_for(text: str, codec: str, encoding: str) -> None:
    source = decode_source("a.scl", text.encode(codec))
    assert source.encoding == encoding
    if encoding != UTF_8:
        assert len(source.text) == len(text.encode(codec))  # a character for each byte, as STEP 7 counts


def test_errors_show_chinese_lines_and_point_at_their_place() -> None:
    line = "y := '设定值' + 1; // 设定值"
    source = decode_source("a.scl", f"x := 1;\r\n{line}\r\n".encode("gbk"))
    place = source.location(Span(source.text.index("+"), source.text.index("+") + 1))
    assert (place.text, place.column) == (line, len("y := '设定值' ".encode("gbk")) + 1)


def test_difference_of_gbk_files_is_readable() -> None:
    old, new = ("x := 1; // 设定值\r\n".encode("gbk"), "x := 1; // 速度\r\n".encode("gbk"))
    assert list(unified(old, new, "a.scl"))[-2:] == ["-x := 1; // 设定值", "+x := 1; // 速度"]
    mixed = list(unified(old, "x := 1; // 设定值\r\n".encode(), "a.scl"))
    assert mixed[-2] != mixed[-1].replace("+", "-", 1), "the same text in another encoding is a difference"
