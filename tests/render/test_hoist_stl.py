"""The text of the hoist in STL: what STEP 7 would refuse, and what the SCL of the same job says too."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from plcgen.job import parse_job
from plcgen.plan_hoist import HoistPlan
from plcgen.render.mnemonics import INSTRUCTIONS

GOLDEN = sorted(
    path
    for path in Path(__file__).parents[2].glob("golden/*/job.toml")
    if 'method = "hoist"' in path.read_text("utf-8")
)
EXAMPLE = Path(__file__).parents[2] / "templates" / "jobs" / "hoist.toml"
TARGETS = 'targets = ["s7-300-scl", "s7-300-stl"]'
LONGEST_TITLE = 64
LONGEST_NAME = 24
LABEL = re.compile(r"^(\w+): ", re.MULTILINE)
JUMP = re.compile(r"^(?:\w+:)? +(?:J\w+|LOOP) +(\w+)", re.MULTILINE)
DECLARATION = re.compile(r"^  (\w+) +: (\w+)(?: := (\S+))?;", re.MULTILINE)
VALUE = re.compile(r"^  (\w+) +:= (\S+);", re.MULTILINE)
CONSTANT = re.compile(r"^    ([A-Z]\w*) +:= (\d+\.\S+);", re.MULTILINE)


@cache
def files(path: Path, name: str = "") -> dict[str, str]:
    """The sources of both targets by the end of their names."""
    text = re.sub(r"targets = \[.*\]", TARGETS, path.read_text("utf-8"))
    if name:
        text = re.sub(r'^name = ".*"', f'name = "{name}"', text, flags=re.MULTILINE)
    plan = HoistPlan.of(parse_job(text, "job.toml"))
    sources = {**plan.sources("s7-300-scl"), **plan.sources("s7-300-stl")}
    return {file.removeprefix(plan.job.name): data.decode("ascii").replace("\r", "") for file, data in sources.items()}


def blocks(text: str) -> list[str]:
    kinds = "FUNCTION|FUNCTION_BLOCK|ORGANIZATION_BLOCK"
    return re.findall(rf"^(?:{kinds}) .*?^END_(?:{kinds})", text, re.MULTILINE | re.DOTALL)


def stl_files() -> list[str]:
    longest = files(EXAMPLE, "A" * 15)
    return [longest[".awl"], longest["_example.awl"]]


@pytest.mark.parametrize("text", stl_files(), ids=["source", "example"])
def test_limits_of_the_editor(text: str) -> None:
    assert max(map(len, re.findall(r"^TITLE =(.*)", text, re.MULTILINE))) <= LONGEST_TITLE
    assert max(map(len, text.split("\n"))) <= 126
    for _, name in re.findall(r"(#|^  (?=\w+ +:))(\w+)", text, re.MULTILINE):
        assert len(name) <= LONGEST_NAME
    for name in re.findall(r"^(?:AUTHOR|FAMILY|NAME) : (.*)", text, re.MULTILINE):
        assert re.fullmatch(r"\w{1,8}", name)


def test_labels() -> None:
    """Up to four characters, each once in its block, each used, and none that could be read as an instruction."""
    found = blocks(files(EXAMPLE)[".awl"])
    assert len(found) == 3
    for block in found:
        labels = LABEL.findall(block)
        assert len(set(labels)) == len(labels)
        assert set(labels) == set(JUMP.findall(block))
        assert all(re.fullmatch(r"[A-Z][A-Z0-9]{0,3}", label) for label in labels)
        assert not set(labels) & (set(INSTRUCTIONS) | set(INSTRUCTIONS.values()))


def test_every_local_name_is_declared_and_used() -> None:
    for block in blocks(files(EXAMPLE)[".awl"]):
        head, body = block.split("\nBEGIN\n")
        declared = {name for name, _, _ in DECLARATION.findall(head)}
        used = set(re.findall(r"\s#(\w+)", body))
        assert used == declared | ({"RET_VAL"} if block.startswith("FUNCTION ") else set())


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.parent.name)
def test_data_block_repeats_the_declaration(path: Path) -> None:
    text = files(path)[".awl"]
    head = blocks(text)[-1].split("VAR_TEMP")[0]
    values = VALUE.findall(text.split("DATA_BLOCK")[1])
    assert values == [(name, value) for name, _, value in DECLARATION.findall(head)]


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.parent.name)
def test_constants_are_those_of_the_scl(path: Path) -> None:
    both = files(path)
    constants = {name: float(value) for name, value in CONSTANT.findall(both[".scl"])}
    values = {name: float(value) for name, value in VALUE.findall(both[".awl"]) if name.isupper()}
    assert values == constants
    assert len(values) > 30


def test_jump_list_has_a_row_for_each_phase() -> None:
    rows = re.findall(r"^      JU    \w+; +// (\d) (\w+)", files(EXAMPLE)[".awl"], re.MULTILINE)
    phases = re.findall(r"^    (\w+) +:= (\d);", files(EXAMPLE)[".scl"].split("// Phases of a trip")[1], re.MULTILINE)
    assert [(number, name) for name, number in phases] == rows


def test_numbers_in_the_body_are_named() -> None:
    """A phase, a status or a count of steps stands beside its name; REAL numbers are those of the formulas."""
    names = dict(re.findall(r"^    (\w+) +:= (?:W#16#)?(\w+);", files(EXAMPLE)[".scl"], re.MULTILINE))
    loads = re.findall(r"^(?:\w+:)? +L +([\dW][^;]*);(?: +// (.*))?$", files(EXAMPLE)[".awl"], re.MULTILINE)
    for number, comment in loads:
        if "e+" in number:
            assert float(number) in {0.0, 2.0, 3.0, 6.0}
        elif comment != "steps":
            assert int(names[comment.split(": ")[-1]], 16) == int(number.removeprefix("W#16#"), 16)


@pytest.mark.parametrize("language", ["english", "german"])
def test_import_note_names_the_mnemonics(language: str) -> None:
    text = re.sub(r"targets = \[.*\]", TARGETS, EXAMPLE.read_text("utf-8"))
    job = parse_job(text.replace("[hoist]", f'mnemonics = "{language}"\n[hoist]', 1), "job.toml")
    note = HoistPlan.of(job).sources("s7-300-stl")["IMPORT.md"].decode()
    assert f"are {language.capitalize()}:" in note
