"""The report: one page that needs nothing else."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path, PurePath
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from plcgen import __version__, pipeline, tables
from plcgen.check.verdict import Verdict
from plcgen.errors import PlcgenError
from plcgen.plan import Files, Plan
from plcgen.plc.source import decode_source
from plcgen.report.cosine import cosine_figures
from plcgen.report.figures import Figure, differing
from plcgen.report.hoist import hoist_figures
from plcgen.report.two_axis import two_axis_figures
from plcgen.terminal import Table

FIGURES: Mapping[str, Callable[..., tuple[Figure, ...]]] = {
    "hoist": hoist_figures,
    "cosine": cosine_figures,
    "two-axis": two_axis_figures,
}
"""By method: the pictures of its plan and the traces of its targets."""
LIBRARIES = ("plotly", "matplotlib", "pygments")
SHOWN = (".scl", ".awl")


@dataclass(frozen=True)
class Source:
    """A generated file as it is shown."""

    target: str
    name: str
    sha256: str
    html: str


def figures_of(plan: Plan, sources: Mapping[str, Files]) -> tuple[Figure, ...]:
    """The pictures of a job, from what its sources do on the nominal motion. Raises SourceError."""
    traces = {target: pipeline.golden_trace(plan, target, files) for target, files in sources.items()}
    return FIGURES[plan.job.method](plan, differing(traces))


def require_libraries() -> None:
    """Raises PlcgenError where a library of the extra `report` is missing."""
    for name in LIBRARIES:
        if find_spec(name) is None:
            raise PlcgenError(f'the report needs {name}; install plcgen with the extra "report"')


def pictures_of(name: str, figures: Sequence[Figure]) -> dict[str, bytes]:
    """PNG files of the figures, by their names."""
    from plcgen.report import pictures

    return {f"{name}_{figure.key}.png": pictures.png(figure) for figure in figures}


def page(plan: Plan, sources: Mapping[str, Files], verdict: Verdict, figures: Sequence[Figure]) -> str:
    """HTML of everything there is to know about a job; equal for equal input."""
    from plcgen.report import highlighting, interactive, pictures

    estimates = pipeline.estimates(plan, sources)
    context = {
        "job": plan.job,
        "version": __version__,
        "verdict": verdict,
        "job_html": highlighting.highlighted(plan.job.text.text, ".toml"),
        "figures": [(figure, interactive.drawn(figure), _inline(pictures.svg(figure))) for figure in figures],
        "derived": [_cells(table) for table in tables.derivation_tables(plan.job, pipeline.derivation(plan))],
        "checks": _cells(tables.verdict_table(verdict)),
        "estimates": _cells(tables.estimates_table(plan.job, estimates)),
        "origins": {target: estimate.origin for target, estimate in estimates.items()},
        "sources": list(_sources(sources, highlighting.highlighted)),
        "style": highlighting.stylesheet(),
        "plotly": interactive.library(),
    }
    return _environment().get_template("page.html").render(context)


def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=True,
    )


def _inline(picture: bytes) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(picture).decode('ascii')}"


def _cells(table: Table) -> dict[str, Any]:
    """A table with the class of each column: figures to the right."""
    kinds = ["figure" if right else "text" for right in table.to_the_right]
    rows = [list(zip(kinds, row, strict=True)) for row in table.rows]
    return {"title": table.title, "headings": list(zip(kinds, table.names, strict=True)), "rows": rows}


def _sources(sources: Mapping[str, Files], highlighted: Callable[[str, str], str]) -> Iterator[Source]:
    for target, files in sources.items():
        for name, data in files.items():
            suffix = PurePath(name).suffix
            if suffix in SHOWN:
                source = decode_source(name, data)
                text = source.shown(source.text).replace("\r\n", "\n")
                yield Source(target, name, hashlib.sha256(data).hexdigest(), highlighted(text, suffix))
