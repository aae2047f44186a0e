"""The Jinja environment: strict, and poor on purpose. All arithmetic happens before a template sees a number."""

from __future__ import annotations

from functools import cache

from jinja2 import BaseLoader, Environment, FileSystemLoader, StrictUndefined

from plcgen.render.comments import padded
from plcgen.render.files import template_folder
from plcgen.render.language import TranslatedLoader
from plcgen.render.literals import real_literal, stl_real_literal
from plcgen.targets import ENGLISH


def column(value: object, width: int) -> str:
    """Text padded with blanks to a column; longer text keeps its length."""
    return padded(str(value), width)


@cache
def environment(language: str = ENGLISH) -> Environment:
    templates = Environment(
        loader=_loader(language),
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


def _loader(language: str) -> BaseLoader:
    return FileSystemLoader(template_folder()) if language == ENGLISH else TranslatedLoader(language)


def render(template: str, context: dict[str, object], language: str = ENGLISH) -> str:
    """Text of a template with LF line ends, its comments in a language."""
    return environment(language).get_template(template).render(context)
