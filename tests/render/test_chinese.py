"""Chinese comments: complete, none left over, and the code beside them the same as with English ones."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import polib
import pytest

from plcgen import pipeline
from plcgen.estimates import NO_BOUND
from plcgen.job import Job, parse_job, read_job
from plcgen.plc.source import GBK, UTF_8, decode_source
from plcgen.render import environment, language
from plcgen.render.files import example_job, template_folder
from plcgen.render.language import catalogue, english_words, words_of
from plcgen.targets import CHINESE, TARGETS

GOLDEN = Path(__file__).parents[2] / "golden"
CATALOGUES = sorted((template_folder() / CHINESE).glob("*.po"))
HOLES = re.compile(r"\{\{.*?\}\}|\{\w*\}")
NOTES = sorted(path for path in template_folder().rglob("*.md") if ".zh." not in path.name)
METHODS = ("hoist", "cosine", "two-axis")
LONGEST_TITLE, LONGEST_LINE, LONGEST_SYMBOL_COMMENT = 64, 126, 80  # bytes
COMMENT = re.compile(r" *//.*|(?<=TITLE =).*|(?<=TITLE=).*")
# What stands in comments and nowhere in the code: names, units and letters of formulas.
NAMES = {
    *("plcgen", "job", "toml", "verify", "no", "Newton", "Train", "Init"),
    *("Siemens", "Manager", "Micro", "Portal", "Windows", "Unicode"),
}
KNOWN = NAMES | {"cm", "mm", "ms", "us", "Delta", "sin", "pi", "gamma"} | language.NOTATION


def case(name: str, job_language: str, **changes: str) -> Job:
    """A golden job with its comments in a language."""
    lines = (GOLDEN / name / "job.toml").read_text("utf-8").split("\n")
    kept = [line for line in lines if line.split(" ")[0] not in ("language", *changes)]
    keys = [f'{key} = "{value}"' for key, value in ({"language": job_language} | changes).items()]
    return parse_job("\n".join(keys + kept), "job.toml")


@cache
def rendered(name: str, job_language: str, verified: bool = True) -> dict[str, bytes]:
    """Every file of every target by `target/name`."""
    plan = pipeline.prepare(case(name, job_language))
    return {
        f"{target}/{file}": data
        for target in plan.job.targets
        for file, data in pipeline.sources(plan, target, verified).items()
    }


CASES = sorted(path.parent.name for path in GOLDEN.glob("*/job.toml"))
# One of each set of templates; the others differ in numbers.
TEMPLATES_OF_ALL = (
    "main-shaft", "short-shaft", "ramps", "ramps-unfiltered", "half-sine", "table-1", "table-1-profile",
    "table-1-fixed", "table-1-fixed-profile",
)  # fmt: skip


def text_of(name: str, data: bytes) -> str:
    """Decoded strictly, as the tool of the target reads it."""
    codec = "utf-8" if name.endswith(".md") else TARGETS[name.split("/")[0]].codec(CHINESE)
    return data.decode(codec).replace("\r\n", "\n")


def code(text: str) -> list[str]:
    """The lines of a source without comments and titles."""
    lines = (re.sub(r"//.*|(?<=TITLE =).*|(?<=TITLE=).*", "", line) for line in text.split("\n"))
    return [line.rstrip() for line in lines if line.strip()]


def is_source(name: str) -> bool:
    return name.endswith((".scl", ".awl"))


# ------------------------------------------------------------------------------------------------------ catalogue


@pytest.mark.parametrize("path", CATALOGUES, ids=lambda path: path.name)
def test_entries_are_complete(path: Path) -> None:
    for entry in polib.pofile(str(path), encoding="utf-8"):
        assert entry.msgstr, entry.msgid
        assert not entry.fuzzy, entry.msgid
        assert sorted(HOLES.findall(entry.msgid)) == sorted(HOLES.findall(entry.msgstr)), entry.msgid
        assert entry.msgstr.encode("gb2312"), "a character that not every Chinese font has"


def test_no_text_is_translated_twice() -> None:
    texts = [entry.msgid for path in CATALOGUES for entry in polib.pofile(str(path), encoding="utf-8")]
    assert sorted({text for text in texts if texts.count(text) > 1}) == []


class Asked(dict[str, str]):
    """A catalogue that remembers what was asked of it."""

    def __init__(self, texts: dict[str, str]) -> None:
        super().__init__(texts)
        self.texts: set[str] = set()

    def __getitem__(self, text: str) -> str:
        self.texts.add(text)
        return super().__getitem__(text)

    def get(self, text: str, other: object = None) -> str:
        self.texts.add(text)
        return str(super().get(text, other))


def test_catalogue_has_no_text_that_nothing_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked(catalogue(CHINESE))
    monkeypatch.setattr(language, "catalogue", lambda _language: asked)
    environment.environment.cache_clear()
    try:
        render_all()
    finally:
        environment.environment.cache_clear()
    assert sorted(set(catalogue_texts()) - asked.texts - {NO_BOUND}) == []


def catalogue_texts() -> Iterator[str]:
    for path in CATALOGUES:
        yield from (entry.msgid for entry in polib.pofile(str(path), encoding="utf-8"))


def render_all() -> None:
    jobs = [case(name, CHINESE) for name in TEMPLATES_OF_ALL]
    for job in (*jobs, case("short-shaft", CHINESE, mnemonics="german")):
        plan = pipeline.prepare(job)
        for target in job.targets:
            pipeline.sources(plan, target, verified=False)


def test_a_text_without_translation_is_an_error() -> None:
    words = words_of(CHINESE)
    with pytest.raises(KeyError, match="speed of the drive in a new way"):
        words("speed of the drive in a new way")
    assert words("a_p = m t1") == "a_p = m t1"
    assert words(NO_BOUND) == "无上限"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("s, time at constant speed (18)", ["time", "at", "constant", "speed"]),
        ("Level", ["Level"]),
        ("L = (lo + hi)/2 (dv/a_p + t1)", []),
        ("tempQ, STOP_RAMP, 16#7002, m/s2, {{ unit }}, {u}/s", []),
        ("s'(y) = LAW_1 - y^2 (3 LAW_2 - y^2 5 LAW_3)", []),
    ],
)
def test_words_that_want_a_translation(text: str, words: list[str]) -> None:
    assert english_words(text) == words


# ------------------------------------------------------------------------------------------------------- sources


@pytest.mark.parametrize("name", CASES)
def test_code_is_the_same_in_both_languages(name: str) -> None:
    english, chinese = rendered(name, "en"), rendered(name, CHINESE)
    assert list(english) == list(chinese)
    for file in filter(is_source, english):
        ours, theirs = (text_of(file, data) for data in (chinese[file], english[file]))
        # The job is another one, and so is its checksum; it stands in comments alone.
        assert code(ours) == code(theirs), file
        assert "".join(code(ours)).isascii()


@pytest.mark.parametrize("name", CASES)
def test_no_english_is_left(name: str) -> None:
    files = rendered(name, CHINESE)
    known = KNOWN | identifiers(name, files)
    for file, data in files.items():
        text = text_of(file, data)
        left = {word for comment in comments(file, text) for word in english_words(comment) if word not in known}
        assert left == set(), file


def identifiers(name: str, files: dict[str, bytes]) -> set[str]:
    """Words of the code of a case, and of its symbols and files."""
    job = read_job(GOLDEN / name / "job.toml")
    code_text = "\n".join(line for file in filter(is_source, files) for line in code(text_of(file, files[file])))
    symbols = "\n".join(line.split("\t")[0] for file in files if file.endswith("symbols.txt")
                        for line in text_of(file, files[file]).split("\n"))  # fmt: skip
    symbols = symbols.replace(f"{job.name}_", " ")
    return set(re.findall(r"[A-Za-z]+", code_text)) | set(re.findall(r"[A-Za-z]+", symbols))


def comments(file: str, text: str) -> Iterator[str]:
    """What people read: comments and titles, comments of symbols, a note without its code and English menu names."""
    if is_source(file):
        yield from (match.group() for match in COMMENT.finditer(text))
    elif file.endswith("symbols.txt"):
        yield from (line.split("\t")[2] for line in text.splitlines())
    elif file.endswith(".asc"):
        yield from (line[50:] for line in text.splitlines())
    elif file.endswith(".sdf"):
        yield from (line.split(",")[-1] for line in text.splitlines())
    else:
        yield re.sub(r"`[^`]*`|（[A-Z][A-Za-z >.]+）", "", text)


@pytest.mark.parametrize("name", CASES)
def test_titles_lines_and_comments_fit(name: str) -> None:
    for file, data in rendered(name, CHINESE).items():
        lines = [line.encode("gbk") for line in text_of(file, data).split("\n")] if not file.endswith(".md") else []
        titles = [line.split(b"=", 1)[1].strip(b" '") for line in lines if line.startswith(b"TITLE")]
        assert max(map(len, titles), default=0) <= LONGEST_TITLE, file
        if is_source(file):
            assert max(map(len, lines)) <= LONGEST_LINE, file
        if file.endswith(".asc"):
            assert {len(line) for line in lines if line} == {4 + 24 + 12 + 10 + LONGEST_SYMBOL_COMMENT}


@pytest.mark.parametrize("name", ["short-shaft", "half-sine", "two-scales"])
def test_files_are_read_back(name: str) -> None:
    for file, data in rendered(name, CHINESE).items():
        if not is_source(file):
            continue
        source = decode_source(file, data)
        assert source.encoding == (UTF_8 if file.startswith("tia") else GBK)
        assert source.shown(source.text).replace("\r\n", "\n") == text_of(file, data).removeprefix("\ufeff")
        assert "由 plcgen" in source.shown(source.text)[:300]


def test_rendering_is_deterministic() -> None:
    plan = pipeline.prepare(case("short-shaft", CHINESE))
    assert pipeline.sources(plan, "tia-scl") == pipeline.sources(plan, "tia-scl")
    digest = plan.job.sha256.encode()
    assert all(digest in data for name, data in pipeline.sources(plan, "tia-scl").items() if is_source(name))


def test_unverified_sources_say_so_in_chinese() -> None:
    for name in ("short-shaft", "ramps", "table-1"):
        for file, data in rendered(name, CHINESE, verified=False).items():
            if "_example" not in file and (is_source(file) or file.endswith(".md")):
                assert "未经验证" in text_of(file, data), file


def test_german_mnemonics_pass_over_chinese_comments() -> None:
    english, chinese = (
        pipeline.sources(pipeline.prepare(case("short-shaft", spoken, mnemonics="german")), "s7-300-stl")
        for spoken in ("en", CHINESE)
    )
    source = "ShortShaft.awl"
    assert code(english[source].decode("ascii")) == code(chinese[source].decode("gbk"))
    assert "助记符为德语" in chinese["IMPORT.md"].decode()


# --------------------------------------------------------------------------------------------------- notes and jobs


@pytest.mark.parametrize("path", NOTES, ids=lambda path: "/".join(path.parts[-3:]))
def test_each_note_has_the_same_holes_in_chinese(path: Path) -> None:
    chinese = path.with_suffix(".zh.md").read_text("utf-8")
    english = path.read_text("utf-8")
    statements = re.compile(r"\{%.*?%\}|\{\{.*?\}\}|`[^`]*`")
    assert sorted(set(statements.findall(chinese))) == sorted(set(statements.findall(english)))
    assert chinese.count("\n| ") == english.count("\n| ")


@pytest.mark.parametrize("method", METHODS)
def test_example_jobs_say_the_same(method: str) -> None:
    english, chinese = (read_job(example_job(method, job_language)) for job_language in ("en", CHINESE))
    assert english.keys.model_copy(update={"language": CHINESE}) == chinese.keys
    lines = example_job(method, CHINESE).read_text("utf-8").split("\n")
    assert [line.split("#")[0].replace('"zh"', '"en"') for line in lines if not line.startswith("#")] == [
        line.split("#")[0] for line in example_job(method, "en").read_text("utf-8").split("\n") if line[:1] != "#"
    ]
