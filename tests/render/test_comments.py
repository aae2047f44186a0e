"""Comments of templates: found with their holes, put in other words, and no character of the code touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from plcgen.render.comments import columns, messages, padded, reworded
from plcgen.render.environment import column
from plcgen.render.files import template_folder

SOURCES = sorted(path for path in template_folder().glob("*/*/*") if path.suffix in (".scl", ".awl"))


@pytest.mark.parametrize(
    ("template", "found"),
    [
        ("x := 1;  // one", ["one"]),
        ("    // one\n    // two\nx := 1;", ["one\ntwo"]),
        ("// one\n    // deeper", ["one", "deeper"]),
        ("// one\n//\n// two", ["one", "two"]),
        ("// one\n{% if a %}\n// two\n{% endif %}", ["one", "two"]),
        ("// ---- 1. Inputs ----------\n// one", ["1. Inputs", "one"]),
        ("x := {{ a | real }};  // {{ unit }}, of {{ name }}", ["{{ unit }}, of {{ name }}"]),
        ("x := 'http://a';", []),
        ("""{{ "//" | column(4) }} // one""", ["one"]),
        ("x := a / b; // one", ["one"]),
        ("Network // once", ["once"]),
        ("TITLE = 'one'", ["one"]),
        ("TITLE =Newton's method", ["Newton's method"]),
        ("TITLE={{ name }}: one", ["{{ name }}: one"]),
        ("TITLE =", []),
        ("//", []),
    ],
)
def test_texts_of_a_template(template: str, found: list[str]) -> None:
    assert messages(template) == found


def test_other_words_stand_where_the_old_ones_stood() -> None:
    template = "TITLE = 'one'\n// ---- 1. two ------\n    // three\n    // four\nx := 1;  // five\n"
    words = {"one": "一", "1. two": "1. 二", "three\nfour": "三\n四\n五", "five": "六"}
    assert reworded(template, words.__getitem__) == (
        "TITLE = '一'\n// ---- 1. 二 -------\n    // 三\n    // 四\n    // 五\nx := 1;  // 六\n"
    )


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: "/".join(path.parts[-3:]))
def test_same_words_leave_a_template_as_it_is(path: Path) -> None:
    text = path.read_text("utf-8")
    assert reworded(text, str) == text
    assert bool(messages(text)) == ("//" in text)
    assert "(*" not in text, "a comment of this kind would stay English"


def test_a_chinese_character_takes_two_columns() -> None:
    assert (columns("ab"), columns("行程"), columns("，")) == (2, 4, 2)
    assert padded("行程", 6, "-") == "行程--"
    assert len(column("行程 m", 10).encode("gbk")) == 10
