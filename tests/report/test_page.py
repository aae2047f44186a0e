"""The report as a file: whole, alone, the same again; and what stands in its way."""

from __future__ import annotations

import hashlib
import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import pytest

from plcgen import pipeline
from plcgen.check.verdict import Check, TargetVerdict, Verdict
from plcgen.job import read_job
from plcgen.report import page as pages
from plcgen.report.highlighting import highlighted
from plcgen.report.pictures import svg
from tests.test_cli import plcgen

GOLDEN = Path(__file__).parents[2] / "golden"
JOB = GOLDEN / "ramps-unfiltered" / "job.toml"
GOOD = Check("speed_deviation", 1e-7, 2e-7, "m/s")
BAD = Check("jerk_limit", 21.0, 20.2, "m/s3", detail="move 1")
VOID = {"meta", "img", "br", "link", "input", "hr"}


@cache
def written(ok: bool = True) -> str:
    plan = pipeline.prepare(read_job(JOB))
    sources = {target: pipeline.sources(plan, target) for target in plan.job.targets}
    checks = TargetVerdict((GOOD,) if ok else (GOOD, BAD))
    verdict = Verdict(plan.job.name, dict.fromkeys(sources, checks))
    return pages.page(plan, sources, verdict, pages.figures_of(plan, sources))


class Balance(HTMLParser):
    """Every element that is opened is closed, in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.loads: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.loads += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_chinese_comments_are_shown_in_every_encoding() -> None:
    files = {target: GOLDEN / "chinese-ramps" / target for target in ("s7-300-scl", "s7-200-smart", "tia-scl")}
    sources = {
        target: {path.name: path.read_bytes() for path in sorted(folder.iterdir())} for target, folder in files.items()
    }
    shown = [source.html for source in pages._sources(sources, lambda text, _suffix: text)]
    assert shown
    assert all("// 由 plcgen" in text for text in shown)


def test_nothing_is_loaded_and_every_element_closed() -> None:
    parser = Balance()
    parser.feed(written())
    assert parser.open == []
    assert parser.loads
    assert all(load.startswith("data:image/svg+xml;base64,") for load in parser.loads)


def test_the_verdict_comes_first_and_sources_with_their_hashes_last() -> None:
    body = written()[written().index("<body>") :]
    places = [body.index(f"<h2>{title}</h2>") for title in ("Job", "Motion", "Checks", "Derived constants", "Sources")]
    assert body.index("<strong>Verified</strong>") < places[0]
    assert places == sorted(places)
    plan = pipeline.prepare(read_job(JOB))
    assert plan.job.sha256 in body
    for target in plan.job.targets:
        for name, data in pipeline.sources(plan, target).items():
            assert (hashlib.sha256(data).hexdigest() in body) == name.endswith((".scl", ".awl"))


def test_equation_numbers_and_estimates_are_there() -> None:
    assert "claim 3" in written()
    assert "CPU 315-2DP" in written()
    assert "said to be from A5E00261439" in written()


def test_a_failed_check_is_told() -> None:
    body = written(ok=False)
    assert "<strong>FAILED</strong>" in body
    assert "s7-300-scl: 1 of 2 checks hold" in body
    assert 'class="text failed">FAILED</td>' in body


def test_the_same_job_gives_the_same_bytes() -> None:
    first = written()
    written.cache_clear()
    assert written() == first


def test_pictures_are_the_same_again() -> None:
    plan = pipeline.prepare(read_job(JOB))
    figures = pages.figures_of(plan, {"s7-300-scl": pipeline.sources(plan, "s7-300-scl")})
    assert [svg(figure) for figure in figures] == [svg(figure) for figure in figures]


@pytest.mark.parametrize(
    ("suffix", "text", "marked"),
    [
        (".scl", "IF #a < 1.5 THEN // far", {"k": "IF", "m": "1.5", "c1": "// far"}),
        (".awl", "M001: L     #speed;   // m/s", {"nl": "M001:", "k": "L", "c1": "// m/s"}),
        (".awl", "MOVR   VD100, VD104", {"k": "MOVR"}),
        (".toml", 'name = "A"', {"s2": '"A"'}),
    ],
)
def test_sources_are_coloured(suffix: str, text: str, marked: dict[str, str]) -> None:
    html = highlighted(text, suffix).replace("&quot;", '"')
    for kind, word in marked.items():
        assert f'<span class="{kind}">{word}</span>' in html
    assert re.sub(r"<[^>]*>", "", html).replace("&lt;", "<").strip() == text


def test_a_library_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(pages, "LIBRARIES", ("numpy", "no_such_library"))
    result = plcgen("report", str(JOB), "-o", str(tmp_path / "a.html"))
    assert result.exit_code == 2
    assert result.output == 'error: the report needs no_such_library; install plcgen with the extra "report"\n'


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    result = plcgen("report", str(JOB), "-o", str(tmp_path / "out" / "a.html"))
    assert result.exit_code == 2
    assert "cannot be written" in result.output


def test_commands_write_report_and_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline, "verify", lambda *_arguments: TargetVerdict((BAD,)))
    file = tmp_path / "a b.html"
    result = plcgen("report", str(JOB), "-o", str(file), "--png", str(tmp_path / "png"), "--target", "s7-300-scl")
    assert result.exit_code == 1
    assert "error: 1 of 1 checks failed for s7-300-scl" in result.output
    assert "<strong>FAILED</strong>" in file.read_text("utf-8")
    names = sorted(path.name for path in (tmp_path / "png").iterdir())
    assert names == ["Spindle_errors.png", "Spindle_motion.png"]
    again = plcgen("verify", str(JOB), "--target", "s7-300-scl", "--report", str(tmp_path / "b.html"))
    assert again.exit_code == 1
    assert (tmp_path / "b.html").read_bytes() == file.read_bytes()
