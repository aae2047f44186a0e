"""The report in a real browser: it draws every figure, loads nothing, and fits a telephone."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from plcgen import pipeline
from plcgen.check.verdict import Check, TargetVerdict, Verdict
from plcgen.job import read_job
from plcgen.report.page import figures_of, page

GOLDEN = Path(__file__).parents[2] / "golden"
CASES = ("short-shaft", "half-sine", "two-scales")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
QUIET = ("quic", "background-networking", "component-update", "sync", "gpu")
FLAGS = ["--no-sandbox", "--no-first-run", *(f"--disable-{service}" for service in QUIET)]
OVERLAPS = """() => {
  const shown = element => { const box = element.getBoundingClientRect(); return box.width > 0 && box.height > 0; };
  const hits = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
  const found = [];
  for (const plot of document.querySelectorAll('.plotly-graph-div')) {
    const words = [...plot.querySelectorAll('.xtick text, .ytick text, .xtitle, .ytitle, .legendtext')].filter(shown);
    const boxes = words.map(word => [word.textContent, word.getBoundingClientRect()]);
    const edge = plot.getBoundingClientRect();
    boxes.forEach(([text, box], place) => {
      if (box.left < edge.left - 1 || box.right > edge.right + 1 || box.bottom > edge.bottom + 1)
        found.push(plot.id + ': ' + text + ' is cut');
      for (const [other, next] of boxes.slice(place + 1))
        if (hits(box, next)) found.push(plot.id + ': ' + text + ' over ' + other);
    });
  }
  const parts = [...document.body.children].filter(shown);
  for (let place = 1; place < parts.length; place++)
    if (hits(parts[place - 1].getBoundingClientRect(), parts[place].getBoundingClientRect()))
      found.push(parts[place].tagName + ' over ' + parts[place - 1].tagName);
  return found;
}"""

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium on this machine")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as player:
        started = player.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield started
        started.close()


@pytest.fixture(scope="module", params=CASES)
def report(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    """A file with the report of a golden case, and how many figures it has."""
    plan = pipeline.prepare(read_job(GOLDEN / request.param / "job.toml"))
    sources = {target: pipeline.sources(plan, target) for target in plan.job.targets}
    verdict = Verdict(plan.job.name, dict.fromkeys(sources, TargetVerdict((Check("a_check", 0.0, 0.0, "1"),))))
    figures = figures_of(plan, sources)
    file = tmp_path_factory.mktemp("report") / "report.html"
    file.write_text(page(plan, sources, verdict, figures), "utf-8")
    return file, len(figures)


def opened(browser: Any, file: Path, width: int) -> tuple[Any, list[str]]:
    """The page without a network, and what it complained of or asked for."""
    told: list[str] = []
    context = browser.new_context(viewport={"width": width, "height": 900}, offline=True)
    shown = context.new_page()
    shown.on("console", lambda message: told.append(message.text))
    shown.on("pageerror", lambda error: told.append(str(error)))
    shown.on("request", lambda asked: told.append(asked.url) if not asked.url.startswith(("file:", "data:")) else None)
    shown.goto(file.as_uri())
    shown.wait_for_function("document.querySelectorAll('.plotly-graph-div .main-svg').length > 0")
    shown.wait_for_timeout(500)
    return shown, told


@pytest.mark.parametrize("width", [1280, 400])
def test_every_plot_is_there_overlaps_nothing_and_zooms(browser: Any, report: tuple[Path, int], width: int) -> None:
    file, count = report
    shown, told = opened(browser, file, width)
    assert shown.evaluate("document.querySelectorAll('.plotly-graph-div').length") == count
    drawn = "[...document.querySelectorAll('.plotly-graph-div')].every(p => p.querySelector('.scatterlayer .js-line'))"
    assert shown.evaluate(drawn)
    assert shown.evaluate(OVERLAPS) == []
    assert shown.evaluate("document.documentElement.scrollWidth") <= width
    assert_a_drag_zooms_in(shown)
    assert told == []
    shown.context.close()


def assert_a_drag_zooms_in(shown: Any) -> None:
    span = "(r => r[1] - r[0])(document.querySelector('.plotly-graph-div')._fullLayout.xaxis.range)"
    before = shown.evaluate(span)
    shown.locator(".plotly-graph-div").first.scroll_into_view_if_needed()
    box = shown.locator(".plotly-graph-div .nsewdrag").first.bounding_box()
    middle = box["y"] + box["height"] / 2
    shown.mouse.move(box["x"] + 0.3 * box["width"], middle - 40)
    shown.mouse.down()
    shown.mouse.move(box["x"] + 0.6 * box["width"], middle + 40, steps=5)
    shown.mouse.up()
    shown.wait_for_timeout(300)
    assert shown.evaluate(span) < 0.9 * before


def test_on_paper_the_drawn_pictures_stand_in_for_the_plots(browser: Any, report: tuple[Path, int]) -> None:
    file, count = report
    shown, _ = opened(browser, file, 800)
    shown.emulate_media(media="print")
    visible = "[...document.querySelectorAll('{}')].filter(e => e.getBoundingClientRect().width > 300).length"
    assert shown.evaluate(visible.format("img.paper")) == count
    assert shown.evaluate(visible.format(".plot")) == 0
    shown.context.close()
