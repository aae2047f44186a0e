"""The controllers and languages that source is written for: one row of facts for each."""

from __future__ import annotations

from dataclasses import dataclass

from plcgen.errors import PlcgenError
from plcgen.names import nearest, one_of

ENGLISH, CHINESE = "en", "zh"
CODE_PAGES = {ENGLISH: "ascii", CHINESE: "gbk"}
"""Code page by the language of comments: ASCII is part of each, 936 is that of a Windows in China."""
LANGUAGES = tuple(CODE_PAGES)


@dataclass(frozen=True)
class Target:
    """One controller and language: where its templates are, and how its files are spelled on disk."""

    name: str
    title: str
    folder: str  # below templates/
    dialect: str  # name of the language's dialect
    suffix: str  # of a source file
    own_codec: str | None  # Python's name; None where the tool reads the code page of Windows
    newline: str
    max_identifier: int  # characters in the name of a block or variable
    methods: frozenset[str]

    def codec(self, language: str) -> str:
        """Python's name of the codec of files whose comments are in a language."""
        return self.own_codec or CODE_PAGES[language]


TARGETS = {
    row.name: row
    for row in (
        Target(
            name="s7-300-scl",
            title="STEP 7 V5.x, SCL source for S7-300 and S7-400",
            folder="s7-300-scl",
            dialect="classic",
            suffix=".scl",
            own_codec=None,
            newline="\r\n",
            max_identifier=24,
            methods=frozenset({"hoist", "cosine"}),
        ),
        Target(
            name="s7-300-stl",
            title="STEP 7 V5.x, STL source (AWL) for S7-300 and S7-400",
            folder="s7-300-stl",
            dialect="stl",
            suffix=".awl",
            own_codec=None,
            newline="\r\n",
            max_identifier=24,
            methods=frozenset({"hoist", "cosine"}),
        ),
        Target(
            name="tia-scl",
            title="TIA Portal, external SCL source for S7-300, S7-1200 and S7-1500",
            folder="tia-scl",
            dialect="tia",
            suffix=".scl",
            own_codec="utf-8-sig",
            newline="\r\n",
            max_identifier=128,
            methods=frozenset({"hoist", "cosine"}),
        ),
        Target(
            name="s7-200-smart",
            title="STEP 7-Micro/WIN SMART, STL (.awl) for S7-200 SMART",
            folder="s7-200-smart",
            dialect="smart",
            suffix=".awl",
            own_codec=None,
            newline="\r\n",
            max_identifier=23,
            methods=frozenset({"cosine", "two-axis"}),
        ),
    )
}

SMART = TARGETS["s7-200-smart"]


def target(name: str) -> Target:
    """The row of that name. Raises PlcgenError with the nearest known name."""
    if name in TARGETS:
        return TARGETS[name]
    raise PlcgenError(f'unknown target "{name}"; write {one_of(choices_near(name, TARGETS))}')


def choices_near(word: str, known: dict[str, Target]) -> tuple[str, ...]:
    """The one known name that `word` resembles, else all of them."""
    near = nearest(word, known)
    return (near,) if near else tuple(known)
