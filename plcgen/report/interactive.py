"""Figures as Plotly draws them: zoom and hover, without a network."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import plotly.graph_objects as go
from plotly.offline import get_plotlyjs
from plotly.subplots import make_subplots

from plcgen.report.figures import BOUND, OTHER, REFERENCE, TRACE, Figure, Line, Panel

# Told apart by the colour-blind, and on grey paper: the trace is a thin line inside the broad one of the reference.
STYLES: Mapping[str, Mapping[str, Any]] = {
    REFERENCE: {"color": "#7CC0EE", "width": 5},
    TRACE: {"color": "#B33F00", "width": 1.5},
    OTHER: {"color": "#00795A", "width": 1.5, "dash": "dashdot"},
    BOUND: {"color": "#555555", "width": 1.5, "dash": "dash"},
}
LIMIT = {"color": "#999999", "width": 1, "dash": "longdash"}
SHADES = ("rgba(0,0,0,0.045)", "rgba(0,0,0,0)")
PANEL_HEIGHT, HEAD_AND_FOOT = 230, 120  # px
EQUAL_HEIGHT = 520  # px
CONFIG = {"displaylogo": False, "responsive": True, "modeBarButtonsToRemove": ["lasso2d", "select2d"]}


def library() -> str:
    """The script of Plotly."""
    return str(get_plotlyjs())


def drawn(figure: Figure) -> str:
    """A division with the figure and the script that draws it; `library` has to stand before it."""
    count = len(figure.panels)
    canvas = make_subplots(rows=count, cols=1, shared_xaxes=True, vertical_spacing=0.06)
    known: set[str] = set()
    for row, panel in enumerate(figure.panels, start=1):
        for curve in panel.lines:
            canvas.add_trace(_scatter(curve, curve.name not in known), row=row, col=1)
            known.add(curve.name)
        canvas.update_yaxes(title_text=panel.label, automargin=True, row=row, col=1)
        for shape in _limits(panel, row):
            canvas.add_shape(shape)
    canvas.update_xaxes(title_text=figure.label, row=count, col=1)
    canvas.update_xaxes(automargin=True, showline=True, linecolor="#bbb", gridcolor="#e6e6e6")
    canvas.update_yaxes(showline=True, linecolor="#bbb", gridcolor="#e6e6e6", zerolinecolor="#bbb", exponentformat="e")
    if figure.equal:
        canvas.update_yaxes(scaleanchor="x", scaleratio=1)
    canvas.update_layout(
        shapes=[*canvas.layout.shapes, *_bands(figure)],
        annotations=list(_names(figure)),
        height=EQUAL_HEIGHT if figure.equal else HEAD_AND_FOOT + count * PANEL_HEIGHT,
        margin={"l": 10, "r": 10, "t": 28, "b": 10},
        legend={"orientation": "h", "yref": "container", "y": 0.0, "yanchor": "bottom", "xanchor": "left", "x": 0.0},
        hovermode="closest" if figure.equal else "x unified",
        template="plotly_white",
        font={"family": "sans-serif", "size": 13, "color": "#222"},
    )
    return str(canvas.to_html(full_html=False, include_plotlyjs=False, div_id=figure.key, config=CONFIG))


def _scatter(curve: Line, listed: bool) -> go.Scatter:
    return go.Scatter(
        x=curve.x.tolist(),
        y=curve.y.tolist(),
        name=curve.name,
        legendgroup=curve.name,
        showlegend=listed,
        mode="lines",
        line={**STYLES[curve.role], "shape": "hv" if curve.stepped else "linear"},
        hovertemplate="%{y:.6g}",
    )


def _limits(panel: Panel, row: int) -> Iterator[dict[str, Any]]:
    axis = "" if row == 1 else str(row)
    for limit in panel.limits:
        yield {
            "type": "line", "xref": f"x{axis} domain", "yref": f"y{axis}", "x0": 0, "x1": 1,
            "y0": limit.value, "y1": limit.value, "line": LIMIT, "layer": "below",
        }  # fmt: skip


def _bands(figure: Figure) -> Iterator[dict[str, Any]]:
    for number, band in enumerate(figure.bands):
        yield {
            "type": "rect", "xref": "x", "yref": "paper", "x0": band.start, "x1": band.end, "y0": 0, "y1": 1,
            "fillcolor": SHADES[number % 2], "line": {"width": 0}, "layer": "below",
        }  # fmt: skip


def _names(figure: Figure) -> Iterator[dict[str, Any]]:
    """The number of each band; the page lists their names."""
    for number, band in enumerate(figure.bands, start=1):
        yield {
            "x": (band.start + band.end) / 2, "y": 1, "xref": "x", "yref": "paper", "yanchor": "bottom",
            "text": str(number), "showarrow": False, "font": {"size": 11, "color": "#666"},
        }  # fmt: skip
