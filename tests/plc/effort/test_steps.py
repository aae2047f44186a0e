"""The longest way through steps, against hand counts and against every way of small random graphs."""

from __future__ import annotations

from random import Random

import pytest

from plcgen.errors import SourceError
from plcgen.plc.effort.steps import Routine, Step, code_size, longest
from plcgen.plc.source import SourceText, Span

HERE = Span(0, 1)
PRICES = {"cheap": 1.0, "dear": 10.0, "call": 2.0}


def routine(*steps: Step) -> Routine:
    return Routine(SourceText("a.scl", "x"), steps)


def step(*work: str, label: str | None = None, jump: str | None = None, **more: object) -> Step:
    return Step(HERE, work, label, jump, **more)  # type: ignore[arg-type]


def test_the_dearer_side_of_a_branch_counts() -> None:
    branch = routine(
        step("cheap", jump="ELSE"),
        step("cheap", jump="END", goes_on=False),
        step("dear", label="ELSE"),
        step("cheap", label="END"),
    )
    assert longest({"FB1": branch}, "FB1", PRICES) == 12.0


def test_a_way_that_ends_early_may_be_the_longest() -> None:
    early = routine(step("cheap", jump="NEXT"), step("dear", goes_on=False), step("cheap", label="NEXT"))
    assert longest({"FB1": early}, "FB1", PRICES) == 11.0


def test_what_no_way_leads_to_costs_nothing() -> None:
    assert longest({"FB1": routine(step("cheap", goes_on=False), step("dear"))}, "FB1", PRICES) == 1.0


def test_loops_in_loops_are_run_to_their_ends() -> None:
    # outer: 1 + 3 times; inner: 1 + 4 times in each: 4 * (1 + 5 * 10 + 1)
    nested = routine(
        step("cheap", label="OUT"),
        step("dear", label="IN"),
        step(jump="IN", passes=4),
        step("cheap", jump="OUT", passes=3),
    )
    assert longest({"FB1": nested}, "FB1", PRICES) == 4 * (1 + 5 * 10 + 1)


def test_calls_count_with_all_that_they_call() -> None:
    blocks = {
        "FB1": routine(step("call", call="FC1"), step("call", call="FC2")),
        "FC1": routine(step("dear"), step("call", call="FC2")),
        "FC2": routine(step("cheap")),
    }
    assert longest(blocks, "FB1", PRICES) == 2 + (10 + 2 + 1) + (2 + 1)


def test_a_label_at_the_end_has_no_step() -> None:
    assert longest({"FC1": routine(step("cheap", jump="END"), step("dear"))}, "FC1", PRICES) == 11.0


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        ([step("cheap", label="A", jump="A")], "a.scl:1:1: how often this loop runs does not stand in the text"),
        ([step("call", call="FC1")], "a.scl:1:1: FC1 calls itself: its run time has no bound"),
    ],
)
def test_what_has_no_bound_is_said(steps: list[Step], message: str) -> None:
    with pytest.raises(SourceError) as raised:
        longest({"FC1": routine(*steps)}, "FC1", PRICES)
    assert str(raised.value).splitlines()[0] == message


def test_size_counts_every_step_once() -> None:
    looped = routine(step("cheap", "dear", label="A"), step("cheap", jump="A", passes=9))
    assert code_size(looped, {"cheap": 2, "dear": 6}) == 10


@pytest.mark.parametrize("seed", range(200))
def test_no_way_through_random_branches_is_longer(seed: int) -> None:
    random = Random(seed)
    count = random.randint(2, 9)
    steps = [
        step(
            random.choice(["cheap", "dear"]),
            label=f"L{place}",
            jump=f"L{random.randint(place + 1, count)}" if random.random() < 0.5 and place < count else None,
            goes_on=random.random() < 0.8,
        )
        for place in range(count)
    ]
    assert longest({"FC1": routine(*steps)}, "FC1", PRICES) == max(_ways(steps, 0)), steps


def _ways(steps: list[Step], place: int) -> list[float]:
    """The price of every way from a step to an end."""
    if place >= len(steps):
        return [0.0]
    here = steps[place]
    following = ([place + 1] if here.goes_on else []) + ([int(here.jump[1:])] if here.jump else [])
    price = sum(PRICES[part] for part in here.work)
    return [price + way for then in following for way in _ways(steps, then)] or [price]
