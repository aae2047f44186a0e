"""Figures as Matplotlib draws them: for paper, and as files of their own."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from plcgen.report.figures import BOUND, OTHER, REFERENCE, TRACE, Figure, Panel
from plcgen.report.interactive import LIMIT, STYLES

DASHES: Mapping[str, str] = {REFERENCE: "-", TRACE: "-", OTHER: "-.", BOUND: "--"}
WIDTH, PANEL_HEIGHT, HEAD_AND_FOOT = 8.0, 1.9, 0.9  # inch
DOTS_PER_INCH = 110


def png(figure: Figure) -> bytes:
    """A picture in dots. The same figure gives the same bytes."""
    return _saved(figure, "png", dpi=DOTS_PER_INCH, metadata={"Software": None})


def svg(figure: Figure) -> bytes:
    """A picture in lines. The same figure gives the same bytes."""
    return _saved(figure, "svg", metadata={"Date": None})


def _saved(figure: Figure, kind: str, **options: Any) -> bytes:
    file = io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "plcgen", "svg.fonttype": "path", "font.size": 9}):
        _canvas(figure).savefig(file, format=kind, **options)
    return file.getvalue()


def _canvas(figure: Figure) -> Canvas:
    count = len(figure.panels)
    height = WIDTH * 0.62 if figure.equal else HEAD_AND_FOOT + count * PANEL_HEIGHT
    canvas = Canvas(figsize=(WIDTH, height), layout="constrained")
    grid = canvas.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    for axes, panel in zip(grid, figure.panels, strict=True):
        _panel(axes, panel, figure)
    grid[-1].set_xlabel(figure.label)
    canvas.suptitle(figure.title, fontsize=10)
    handles = {name: handle for axes in grid for handle, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    canvas.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=3, frameon=False)
    return canvas


def _panel(axes: Axes, panel: Panel, figure: Figure) -> None:
    for curve in panel.lines:
        style = STYLES[curve.role]
        look = {"color": style["color"], "linewidth": 0.7 * style["width"], "linestyle": DASHES[curve.role]}
        drawing = "steps-post" if curve.stepped else "default"
        axes.plot(curve.x, curve.y, label=curve.name, drawstyle=drawing, **look)
    for limit in panel.limits:
        axes.axhline(limit.value, color=LIMIT["color"], linewidth=0.8, linestyle=(0, (8, 4)), zorder=0)
    for number, band in enumerate(figure.bands):
        axes.axvspan(band.start, band.end, color="#000000", alpha=0.045 * ((number + 1) % 2), linewidth=0, zorder=0)
    axes.set_ylabel(panel.label)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25)
    axes.margins(x=0.01)
    if figure.equal:
        axes.set_aspect("equal", adjustable="datalim")
