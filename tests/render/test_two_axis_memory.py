"""The memory map of both modes: no byte twice, nothing outside, and tables at even addresses."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest

from plcgen.errors import JobError
from plcgen.job import HIGHEST_V_BYTE, Job, parse_job
from plcgen.render.smart_memory import AREAS, SIZES, Variable
from plcgen.render.two_axis_memory import (
    BITS,
    BLOCKS,
    MOST_SEGMENTS,
    layout,
    memory_map,
    refuse_what_does_not_fit,
    variables,
)

EXAMPLE = (Path(__file__).parents[2] / "templates" / "jobs" / "two-axis.toml").read_text(encoding="utf-8")
NEEDED = {"interrupt": 328, "table": 6472}  # bytes


def job_of(mode: str, v_memory: int = 1000, name: str = "Table") -> Job:
    text = EXAMPLE.replace('mode = "interrupt"', f'mode = "{mode}"').replace('"Table"', f'"{name}"')
    return parse_job(text.replace("v_memory = 1000", f"v_memory = {v_memory}"), "job.toml")


def bytes_of(job: Job, row: Variable) -> range:
    start = int(re.sub(r"\D", "", memory_map(job)[row.name]))
    return range(start, start + layout(job).size(row))


@pytest.mark.parametrize("mode", NEEDED)
@pytest.mark.parametrize("v_memory", [0, 1000, 1234])
def test_variables_follow_one_another_from_v_memory_on(mode: str, v_memory: int) -> None:
    job = job_of(mode, v_memory)
    places = [bytes_of(job, row) for row in variables(job)]
    assert places[0].start == v_memory
    assert all(before.stop == after.start for before, after in pairwise(places))
    assert places[-1].stop == layout(job).end == v_memory + NEEDED[mode]


@pytest.mark.parametrize("mode", NEEDED)
def test_words_and_tables_have_even_addresses(mode: str) -> None:
    job = job_of(mode)
    odd = [row.name for row in variables(job) if layout(job).size(row) > 1 and bytes_of(job, row).start % 2]
    assert not odd


@pytest.mark.parametrize("mode", NEEDED)
def test_addresses_are_as_wide_as_what_they_hold(mode: str) -> None:
    job = job_of(mode)
    widths = {"VB": 1, "VW": 2, "VD": 4}
    for row in variables(job):
        area = memory_map(job)[row.name][:2]
        assert (row.type in BLOCKS and area == "VB") or (area == AREAS[row.type] and widths[area] == SIZES[row.type])


def test_a_profile_table_holds_the_most_segments() -> None:
    """A count, 12 bytes for each segment, and one byte that makes it even."""
    assert BLOCKS["PROFILE"] == 1 + 12 * MOST_SEGMENTS + 1


@pytest.mark.parametrize("mode", NEEDED)
def test_every_bit_has_a_place_of_its_own_in_its_byte(mode: str) -> None:
    job = job_of(mode)
    addresses = memory_map(job)
    assert len({addresses[bit.name] for bit in BITS}) == len(BITS)
    for bit in BITS:
        byte = next(row for row in variables(job) if row.name == bit.byte)
        assert byte.type == "BYTE"
        assert addresses[bit.name] == f"V{bytes_of(job, byte).start}.{bit.number}"
        assert 0 <= bit.number < 8


@pytest.mark.parametrize("mode", NEEDED)
def test_names_are_unique(mode: str) -> None:
    job = job_of(mode)
    names = [row.name for row in variables(job)] + [bit.name for bit in BITS]
    assert len(set(names)) == len(names)
    lines = layout(job).symbols(job)
    assert len({line.symbol.casefold() for line in lines}) == len({line.address for line in lines}) == len(names)
    assert all(line.symbol.startswith("Table_") and line.comment for line in lines)
    assert not any("{" in line.comment for line in lines)


@pytest.mark.parametrize("mode", NEEDED)
def test_the_last_byte_may_be_used_and_no_further(mode: str) -> None:
    highest = HIGHEST_V_BYTE + 1 - NEEDED[mode]
    refuse_what_does_not_fit(job_of(mode, highest))
    with pytest.raises(JobError) as caught:
        refuse_what_does_not_fit(job_of(mode, highest + 1))
    assert str(caught.value).split("\n")[0] == (
        f"job.toml:22:12: v_memory = {highest + 1} leaves too little: {NEEDED[mode]} bytes are needed up to VB8191; "
        f"write at most {highest}"
    )


@pytest.mark.parametrize("mode", NEEDED)
def test_a_name_may_be_so_long_that_every_symbol_is_taken(mode: str) -> None:
    job = job_of(mode, name="TableOfTen")
    refuse_what_does_not_fit(job)
    assert max(len(line.symbol) for line in layout(job).symbols(job)) <= 23
