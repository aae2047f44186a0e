"""The Jinja environment: strict, and poor on purpose. All arithmetic happens before a template sees a number."""

from __future__ import annotations

from contextlib import suppress
from functools import cache

from jinja2 import BaseLoader, Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined
from jinja2.bccache import Bucket

from plcgen.render.comments import padded
from plcgen.render.files import template_folder
from plcgen.render.language import TranslatedLoader
from plcgen.render.literals import real_literal, stl_real_literal
from plcgen.targets import ENGLISH


def column(value: object, width: int) -> str:
    """Text padded with blanks to a column; longer text keeps its length."""
    return padded(str(value), width)


class CompiledTemplates(FileSystemBytecodeCache):
    """Templates compiled by earlier runs, by the digest of their text: compiling is a quarter of a quick command.

    What cannot be kept, or read again, is compiled again.
    """

    def load_bytecode(self, bucket: Bucket) -> None:
        try:
            super().load_bytecode(bucket)
        except Exception:  # a file that was cut off fails in many ways
            bucket.reset()

    def dump_bytecode(self, bucket: Bucket) -> None:
        with suppress(OSError):
            super().dump_bytecode(bucket)


def _compiled(language: str) -> CompiledTemplates | None:
    """In the user's folder for temporary files, if that is safe: a language has its own, as it has its own texts."""
    try:
        return CompiledTemplates(pattern=f"plcgen_{language}_%s.cache")
    except (OSError, RuntimeError):
        return None


@cache
def environment(language: str = ENGLISH) -> Environment:
    templates = Environment(
        loader=_loader(language),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        bytecode_cache=_compiled(language),
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
