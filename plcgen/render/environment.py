"""The Jinja environment: strict, and poor on purpose. All arithmetic happens before a template sees a number."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from plcgen.render.literals import real_literal, stl_real_literal


def template_folder() -> Path:
    """`templates/` beside the package in a checkout, inside the package in a wheel."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "templates"
    return installed if installed.is_dir() else package.parent / "templates"


def column(value: object, width: int) -> str:
    """Text padded with blanks to a column; longer text keeps its length."""
    return str(value).ljust(width)


@cache
def environment() -> Environment:
    templates = Environment(
        loader=FileSystemLoader(template_folder()),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    templates.filters["real"] = real_literal
    templates.filters["stl_real"] = stl_real_literal
    templates.filters["column"] = column
    return templates


def render(template: str, context: dict[str, object]) -> str:
    """Text of a template with LF line ends."""
    return environment().get_template(template).render(context)
