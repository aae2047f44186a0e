"""The memory map of the cosine programs of the S7-200 SMART: no overlap, even addresses, and what does not fit."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from plcgen.errors import JobError
from plcgen.job import HIGHEST_V_BYTE, Job, parse_job
from plcgen.render.cosine_memory import layout, memory_map, refuse_what_does_not_fit
from plcgen.render.smart_memory import AREAS, Variable

JOB = """
name = "{name}"
method = "cosine"
targets = ["s7-200-smart"]
length_unit = "mm"
sample_period = 0.010

[cosine]
max_velocity = 2000.0
max_acceleration = 1500.0
jerk = 5000.0
filter_length = {length}
shape = "{shape}"
v_memory = {v_memory}

[[cosine.moves]]
{move}
"""
SHAPES = {"centred": "from = 0.0\nto = 1000.0", "half-sine": "distance = 1000.0"}
NEEDED = {"centred": 164, "half-sine": 182}  # bytes before the ring


def job_of(shape: str, v_memory: int = 1000, length: int = 16, name: str = "Axis") -> Job:
    return parse_job(
        JOB.format(name=name, length=length, shape=shape, v_memory=v_memory, move=SHAPES[shape]), "job.toml"
    )


def bytes_of(job: Job, row: Variable) -> range:
    start = int(re.sub(r"\D", "", memory_map(job)[row.name]))
    return range(start, start + layout(job).size(row))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("length", [2, 16, 512])
def test_variables_follow_one_another_and_the_ring_comes_last(shape: str, length: int) -> None:
    job = job_of(shape, 1000, length)
    rows = layout(job).rows
    places = [bytes_of(job, row) for row in rows]
    assert places[0].start == 1000
    assert all(before.stop == after.start for before, after in pairwise(places))
    assert rows[-1].name == "ring" and len(places[-1]) == 4 * length
    assert places[-1].start == 1000 + NEEDED[shape]
    assert places[-1].stop == layout(job).end


@pytest.mark.parametrize("shape", SHAPES)
def test_words_have_even_addresses_and_areas_of_their_width(shape: str) -> None:
    job = job_of(shape)
    assert not [row.name for row in layout(job).rows if row.type != "BYTE" and bytes_of(job, row).start % 2]
    assert all(memory_map(job)[row.name].startswith(AREAS.get(row.type, "VB")) for row in layout(job).rows)


@pytest.mark.parametrize("shape", SHAPES)
def test_names_and_places_are_unique(shape: str) -> None:
    job = job_of(shape)
    names = [entry.name for entry in layout(job).named]
    assert len(set(names)) == len(names)
    lines = layout(job).symbols(job)
    assert len({line.symbol.casefold() for line in lines}) == len({line.address for line in lines}) == len(names)
    assert all(line.symbol.startswith("Axis_") and line.comment and "{" not in line.comment for line in lines)
    assert all(0 <= bit.number < 8 for bit in layout(job).bits)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_last_byte_may_be_used_and_no_further(shape: str) -> None:
    needed = NEEDED[shape] + 4 * 512
    highest = HIGHEST_V_BYTE + 1 - needed
    refuse_what_does_not_fit(job_of(shape, highest, 512))
    with pytest.raises(JobError) as caught:
        refuse_what_does_not_fit(job_of(shape, highest + 1, 512))
    assert str(caught.value).split("\n")[0] == (
        f"job.toml:14:12: v_memory = {highest + 1} leaves too little: {needed} bytes are needed up to VB8191; "
        f"write at most {highest}"
    )


@pytest.mark.parametrize("shape", SHAPES)
def test_a_name_may_be_so_long_that_every_symbol_is_taken(shape: str) -> None:
    job = job_of(shape, name="TwelveLetter")
    refuse_what_does_not_fit(job)
    assert max(len(line.symbol) for line in layout(job).symbols(job)) == 23
    with pytest.raises(JobError, match="s7-200-smart takes 12, for the symbol"):
        refuse_what_does_not_fit(job_of(shape, name="ThirteenChars"))
