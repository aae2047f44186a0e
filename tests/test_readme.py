"""The two READMEs say the same: commands, keys, options, numbers of tables, and what is doubted."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ENGLISH, CHINESE = ((ROOT / name).read_text("utf-8") for name in ("README.md", "README.zh.md"))
CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
FENCED = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)
FIGURE = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")


def rows(text: str) -> list[str]:
    return [line for line in text.split("\n") if line.startswith("|")]


def tables(text: str) -> list[list[str]]:
    """The rows of each table."""
    return [block.split("\n") for block in re.findall(r"(?:^\|.*\n?)+", text, re.MULTILINE)]


def bullets(text: str) -> list[int]:
    """How many points each section lists."""
    return [len(re.findall(r"^\* ", section, re.MULTILINE)) for section in re.split(r"^## ", text, flags=re.MULTILINE)]


def test_each_leads_to_the_other() -> None:
    assert "[中文](README.zh.md)" in ENGLISH[:200]
    assert "[English](README.md)" in CHINESE[:200]


def test_commands_to_copy_are_the_same() -> None:
    assert FENCED.findall(ENGLISH) == FENCED.findall(CHINESE)
    assert FENCED.findall(ENGLISH)


def test_pictures_are_the_same() -> None:
    pictures = [re.findall(r"!\[[^\]]+\]\((.*?)\)", text) for text in (ENGLISH, CHINESE)]
    assert pictures[0] == pictures[1]
    assert all((ROOT / picture).is_file() for picture in pictures[0])


def test_tables_name_the_same_commands_keys_and_values() -> None:
    assert [len(table) for table in tables(ENGLISH)] == [len(table) for table in tables(CHINESE)]
    for english, chinese in zip(rows(ENGLISH), rows(CHINESE), strict=True):
        assert sorted(CODE.findall(english)) == sorted(CODE.findall(chinese)), english


def test_tables_have_the_same_numbers() -> None:
    for english, chinese in zip(rows(ENGLISH), rows(CHINESE), strict=True):
        assert sorted(FIGURE.findall(english)) == sorted(FIGURE.findall(chinese)), english


@pytest.mark.parametrize("text", [ENGLISH, CHINESE])
def test_there_are_tables(text: str) -> None:
    assert len(tables(text)) == 7
    assert any("`language`" in row for row in rows(text))


def test_options_files_and_identifiers_are_the_same() -> None:
    assert sorted(set(CODE.findall(ENGLISH))) == sorted(set(CODE.findall(CHINESE)))


def test_sections_list_as_many_points() -> None:
    assert bullets(ENGLISH) == bullets(CHINESE)
    assert re.findall(r"^#+", ENGLISH, re.MULTILINE) == re.findall(r"^#+", CHINESE, re.MULTILINE)
