"""Golden cases: diff, update only after verification, thinning of traces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest

from plcgen import golden, pipeline
from plcgen.check.verdict import Check, TargetVerdict
from plcgen.errors import PlcgenError
from plcgen.golden import CaseReport, check_case, check_golden, stored_text, thinned, unified
from plcgen.job import Job
from plcgen.processes import in_processes
from plcgen.trajectory import Trajectory, disagreements

ROOT = Path(__file__).parents[1]
EXAMPLE = (ROOT / "templates" / "jobs" / "hoist.toml").read_bytes()
GOOD = Check("stop_error", 0.0002, 0.001, "m")
TOLD = (
    "law_error",
    "lost_pulses_x",
    "lost_pulses_y",
    "extra_samples",
    "standstill_not_exact",
    "speed_deviation",
    "agrees_with_scl",
)
BAD = Check("stop_error", 0.002, 0.001, "m", detail="up, encoder late")


def trip(rows: int = 3) -> Trajectory:
    return Trajectory({"time": np.arange(rows) * 0.01, "phase": np.zeros(rows, dtype=np.int16)})


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> dict[str, bytes]:
    """A pipeline that takes no time: the sources of every target, which a test may change, and a good verdict."""
    sources = {"a.scl": b"x := 1;\r\ny := 2;\r\n"}
    monkeypatch.setattr(pipeline, "prepare", lambda job: job)
    monkeypatch.setattr(pipeline, "sources", lambda _plan, _target: dict(sources))
    monkeypatch.setattr(pipeline, "reference", lambda _plan: trip())
    monkeypatch.setattr(pipeline, "golden_trace", lambda _plan, _target, files: trip(len(files["a.scl"])))
    verdict(monkeypatch, GOOD)
    return sources


def verdict(monkeypatch: pytest.MonkeyPatch, check: Check) -> None:
    def verify(_plan: Job, target: str, _files: Mapping[str, bytes]) -> TargetVerdict:
        return TargetVerdict((check if target == "tia-scl" else GOOD,))

    monkeypatch.setattr(pipeline, "verify", verify)


@pytest.fixture
def case(tmp_path: Path, fake: dict[str, bytes]) -> Path:
    """A stored case that is as it should be."""
    assert fake
    folder = tmp_path / "golden" / "main shaft \xe9"
    folder.mkdir(parents=True)
    (folder / "job.toml").write_bytes(EXAMPLE)
    assert check_case(folder, update=True).ok
    return folder


STORED = ["reference.csv", "s7-300-scl/a.scl", "tia-scl/a.scl", "trace-s7-300-scl.csv", "trace-tia-scl.csv"]


@pytest.mark.usefixtures("fake")
def test_update_writes_what_is_missing_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_bytes(EXAMPLE)
    missing = check_case(tmp_path)
    assert sorted(missing.findings) == [
        f"{tmp_path / name}: is missing; plcgen check --update writes it" for name in STORED
    ]
    assert sorted(check_case(tmp_path, update=True).updated) == [str(tmp_path / name) for name in STORED]
    verdicts = dict.fromkeys(("s7-300-scl", "tia-scl"), TargetVerdict((GOOD,)))
    assert check_case(tmp_path) == golden.CaseReport(tmp_path.name, verdicts=verdicts)
    assert check_case(tmp_path, update=True).updated == ()


def test_difference_of_a_source(case: Path, fake: dict[str, bytes]) -> None:
    fake["a.scl"] = b"x := 1;\r\ny := 3;\r\n"
    (case / "s7-300-scl" / "a.scl").write_bytes(fake["a.scl"])
    path = case / "tia-scl" / "a.scl"
    assert check_case(case).findings == (
        f"--- {path} (stored)\n+++ {path} (generated)\n@@ -1,2 +1,2 @@\n x := 1;\n-y := 2;\n+y := 3;",
    )


@pytest.mark.parametrize(("stored", "generated"), [(b"\n", b"\r\n"), (b"\r\n", b"\n")])
def test_difference_of_line_ends(case: Path, fake: dict[str, bytes], stored: bytes, generated: bytes) -> None:
    fake["a.scl"] = b"x := 1;" + generated
    assert check_case(case, update=True).ok
    path = case / "tia-scl" / "a.scl"
    path.write_bytes(b"x := 1;" + stored)
    assert check_case(case).findings == (
        f"{path}: differs in line ends alone; git leaves them if .gitattributes says: golden/** -text",
    )


def test_difference_of_a_trace(case: Path) -> None:
    path = case / "trace-tia-scl.csv"
    stored = path.read_text().replace("0.02,0", "0.02,1")
    path.write_text(stored)
    (finding,) = check_case(case).findings
    assert f"--- {path} (stored)" in finding
    assert "-0.02,1\n+0.02,0" in finding


def test_long_difference_of_a_trace_is_cut(case: Path) -> None:
    (case / "trace-tia-scl.csv").write_text("x\n" * 100)
    (finding,) = check_case(case).findings
    assert finding.count("\n") == golden.MAX_TRACE_DIFF
    # Three lines of heading, 100 stored lines, and 20 that are generated: digest, header, a row for each byte.
    assert finding.endswith(f"... {3 + 100 + 20 - golden.MAX_TRACE_DIFF} more lines")


def test_line_ends_of_a_csv_do_not_count(case: Path) -> None:
    path = case / "reference.csv"
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert check_case(case).ok


def test_files_that_are_not_generated(case: Path) -> None:
    extra = case / "tia-scl" / "old.scl"
    extra.write_bytes(b"")
    (case / ".gitattributes").write_bytes(b"")
    for report in (check_case(case), check_case(case, update=True)):
        assert report.findings == (f"{extra}: is not generated; remove it",)
    assert extra.exists()


def test_no_update_without_verification(case: Path, fake: dict[str, bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    fake["a.scl"] = b"broken\r\n"
    verdict(monkeypatch, BAD)
    before = {path: path.read_bytes() for path in case.rglob("*") if path.is_file()}
    report = check_case(case, update=True)
    assert report.updated == ()
    assert report.findings[0] == (
        f"{case / 'tia-scl'}: stop_error: 0.002 m is above the bound 0.001 m (up, encoder late)"
    )
    assert {path: path.read_bytes() for path in case.rglob("*") if path.is_file()} == before


def test_targets_must_agree_in_every_bit() -> None:
    other = Trajectory({"time": np.arange(3) * 0.01, "phase": np.array([0, 0, 1], dtype=np.int16)})
    assert list(disagreements({"a": trip(), "b": trip()})) == []
    assert list(disagreements({"a": trip(), "b": other})) == ["b and a disagree: phase is 1 and 0 in row 2"]
    assert list(disagreements({"a": trip(), "b": trip(2)})) == ["b and a disagree: 2 rows and 3"]


@pytest.mark.usefixtures("fake")
def test_no_update_while_targets_disagree(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline, "golden_trace", lambda _plan, target, _files: trip(len(target)))
    report = check_case(case, update=True)
    assert report.updated == ()
    assert report.findings[0] == "tia-scl and s7-300-scl disagree: 7 rows and 10"


def test_deviation_from_below() -> None:
    check = Check("envelope_margin", -0.1, 0.0, "m/s", at_least=True)
    assert golden.deviation(check) == "envelope_margin: -0.1 m/s is below the bound 0 m/s"


def test_bad_job_is_the_error_of_its_case(case: Path) -> None:
    (case / "job.toml").write_text("name = 1")
    report = check_case(case)
    assert not report.ok
    assert report.error.startswith(f"{case / 'job.toml'}:1:")


def test_cases_of_a_folder(case: Path) -> None:
    done: list[str] = []
    assert [report.case for report in check_golden(case.parent, False, done.append)] == ["main shaft \xe9"]
    assert done == ["1 of 1 cases checked"]


def test_cases_in_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The longest begins first; they are told in the order of their names."""
    for name in ("b", "a"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "job.toml").write_text("name = 1")
    (tmp_path / "b" / "trace-tia-scl.csv").write_text("# 7816 rows, sha256 00\n")
    begun: list[str] = []

    def noted(function: Callable[..., CaseReport], cases: list[Path], update: list[bool]) -> Iterator[CaseReport]:
        begun.extend(case.name for case in cases)
        return in_processes(function, cases, update)

    monkeypatch.setattr(golden, "in_processes", noted)
    reports = check_golden(tmp_path, False, lambda _line: None)
    assert [(report.case, bool(report.error)) for report in reports] == [("a", True), ("b", True)]
    assert begun == ["b", "a"]


def test_a_case_is_its_only_one(tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text("name = 1")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "job.toml").write_text("name = 1")
    assert golden.find_cases(tmp_path) == [tmp_path]


def test_a_case_that_has_lost_its_job(case: Path) -> None:
    (case / "job.toml").unlink()
    (report,) = golden.check_golden(case.parent, False, lambda _: None)
    assert report.error == f"{case / 'job.toml'}: cannot be read: No such file or directory"


def test_folder_without_cases(tmp_path: Path) -> None:
    with pytest.raises(PlcgenError) as caught:
        golden.find_cases(tmp_path)
    assert str(caught.value) == f"{tmp_path}: no case in it; a case is a folder with a job.toml"
    with pytest.raises(PlcgenError) as caught:
        golden.find_cases(tmp_path / "x")
    assert str(caught.value) == f"{tmp_path / 'x'}: no such folder; plcgen check takes the folder of the golden cases"


@pytest.mark.parametrize("folder", golden.find_cases(ROOT / "golden"), ids=lambda folder: folder.name)
def test_stored_case_is_what_comes_out_today(folder: Path, record_property: Callable[[str, object], None]) -> None:
    """The golden cases themselves. `-rP` shows the worst relative error of v(S) in 32 bits, which stays below 1e-6, and
    the pulses that were lost, which are none, like the stops after which an axis did not stand exactly still.
    """
    report = check_case(folder)
    assert report.findings == ()
    assert report.error == ""
    for target, verdict in report.verdicts.items():
        figures = {check.name: check.value for check in verdict.checks if check.name in TOLD}
        record_property(target, figures)
        print(f"{folder.name}, {target}: {figures}")
        assert figures
        assert figures.get("law_error", 0.0) < 1e-6
        assert figures.get("standstill_not_exact", 0.0) == figures.get("agrees_with_scl", 0.0) == 0.0
        assert figures.get("lost_pulses_x", 0.0) == figures.get("lost_pulses_y", 0.0) == 0.0


# ---------------------------------------------------------------------------------------------------------- traces


def test_thinned_trace_keeps_changes_of_phase_and_the_last_row() -> None:
    phase = np.zeros(7812, dtype=np.int16)
    phase[1234:] = 1
    phase[5005:] = 2
    full = Trajectory({"time": np.arange(7812.0), "phase": phase})
    times = thinned(full)["time"].tolist()
    assert set(times) == {*map(float, range(0, 7812, 8)), 1233.0, 1234.0, 5004.0, 5005.0, 7811.0}
    assert len(times) <= golden.MAX_ROWS + 5


@pytest.mark.parametrize("rows", [0, 1, 2, 999, 1000])
def test_short_trace_is_stored_whole(rows: int) -> None:
    assert len(thinned(trip(rows))) == rows


def test_first_line_stands_for_all_rows() -> None:
    full = trip(3)
    assert stored_text(full) == f"# 3 rows, sha256 {full.sha256()}\ntime,phase\n0,0\n0.01,0\n0.02,0\n"


# ----------------------------------------------------------------------------------------------------- differences


@pytest.mark.parametrize(
    ("old", "new", "body"),
    [
        (b"a\r\nb\r\n", b"a\r\nc\r\n", [" a", "-b", "+c"]),
        (b"a\n", b"a\r\n", ["-a", "+a\\r"]),
        (b"a\r\nb\n", b"a\r\nb\r\n", [" a\\r", "-b", "+b\\r"]),
        (b"a\r\n", b"\xef\xbb\xbfa\r\n", ["-a", "+\\ufeffa"]),
        (b"a\r\nb", b"a\r\nb\r\n", [" a", " b", "-\\ No newline at end of file"]),
        (b"\xe9\n", b"\xc3\xa9\n", ["-\xe9", "+\xc3\xa9"]),
    ],
)
def test_unified(old: bytes, new: bytes, body: list[str]) -> None:
    assert list(unified(old, new, "f"))[3:] == body
