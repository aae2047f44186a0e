"""The languages of comments. Templates are written in English; a catalogue has their comments in another language."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import polib
from jinja2 import Environment, FileSystemLoader

from plcgen.render.comments import Words, reworded
from plcgen.render.files import localised, template_folder
from plcgen.targets import ENGLISH

SOURCES = (".scl", ".awl")
NOTE = ".md"
# In a formula these are functions and variables.
NOTATION = frozenset({"lo", "hi", "dv", "sqrt", "max", "peak", "base", "change", "beta"})
_HOLE = re.compile(r"\{\{.*?\}\}|\{\w*\}")
# No part of an identifier, a unit or a number: those have capitals, digits, underscores or a single letter.
_WORD = re.compile(r"(?<![\w.])[A-Za-z]?[a-z]{2,}(?!\w)")


def words_of(language: str) -> Words:
    """What puts English texts in the words of a language. It raises KeyError for one that its catalogue lacks."""
    return str if language == ENGLISH else _translator(catalogue(language))


@cache
def catalogue(language: str) -> dict[str, str]:
    """The texts of a language by the English ones, from templates/<language>/*.po."""
    files = sorted((template_folder() / language).glob("*.po"))
    return {entry.msgid: entry.msgstr for file in files for entry in polib.pofile(str(file), encoding="utf-8")}


def _translator(texts: dict[str, str]) -> Callable[[str], str]:
    return lambda text: texts[text] if english_words(text) else texts.get(text, text)


def english_words(text: str) -> list[str]:
    """The words of a comment that are to be translated; formulas, names and units have none."""
    return [word for word in _WORD.findall(_HOLE.sub("", text)) if word not in NOTATION]


class TranslatedLoader(FileSystemLoader):
    """Reads sources with their comments in a language, and of a note `name.md` the file `name.<language>.md`."""

    def __init__(self, language: str) -> None:
        super().__init__(template_folder())
        self.language = language

    def get_source(self, environment: Environment, template: str) -> tuple[str, str, Callable[[], bool]]:
        if template.endswith(NOTE):
            return super().get_source(environment, localised(template, self.language))
        source, file, is_fresh = super().get_source(environment, template)
        return (reworded(source, words_of(self.language)) if template.endswith(SOURCES) else source), file, is_fresh
