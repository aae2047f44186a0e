"""Blocks as steps, each with the classes of machine instructions it is made of, and the longest way through them."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from plcgen.plc.source import SourceText, Span

Prices = Mapping[str, float]
"""Of each class of machine instructions."""


@dataclass(frozen=True)
class Step:
    """One instruction: what it is made of, and where it leads.

    A jump backwards is taken at most `passes` times before its loop ends; None where the text does not say.
    """

    span: Span
    work: tuple[str, ...] = ()
    label: str | None = None
    jump: str | None = None
    goes_on: bool = True
    call: str | None = None
    passes: int | None = None


@dataclass(frozen=True)
class Routine:
    """The steps of one block, in the order of its text."""

    source: SourceText
    steps: Sequence[Step]


Routines = Mapping[str, Routine]


def code_size(routine: Routine, sizes: Mapping[str, int]) -> int:
    """Bytes of the code of a block."""
    return sum(sizes[part] for step in routine.steps for part in step.work)


def longest(routines: Routines, name: str, prices: Prices, callers: tuple[str, ...] = ()) -> float:
    """The price of the most expensive way through a block and all that it calls, in the unit of `prices`.

    Raises SourceError for a loop of which the text does not say how often it runs, and for calls in a circle.
    """
    routine, costs = routines[name], []
    for step in routine.steps:
        if step.call in (*callers, name):
            raise routine.source.error(f"{step.call} calls itself: its run time has no bound", step.span)
        inner = longest(routines, step.call, prices, (*callers, name)) if step.call in routines else 0.0  # type: ignore[arg-type]
        costs.append(sum(prices[part] for part in step.work) + inner)
    return _through(routine, costs)


def _through(routine: Routine, costs: list[float]) -> float:
    """Further passes of a loop are counted at its first step, those of inner loops before those of outer ones."""
    steps = routine.steps
    places = _Places({step.label: place for place, step in enumerate(steps) if step.label is not None})
    loops = [(places[step.jump], last) for last, step in enumerate(steps) if step.jump and places[step.jump] <= last]
    for first, last in sorted(loops, key=lambda loop: loop[1] - loop[0]):
        once = _ways(steps, costs, places, first, last).get(last, 0.0)
        if once:
            costs[first] += once * _passes(routine, steps[last])
    return max(_ways(steps, costs, places, 0, len(steps) - 1).values(), default=0.0)


class _Places(dict[str, int]):
    """The step of each label; one that stands behind all steps is the end."""

    def __missing__(self, _label: str) -> int:
        return sys.maxsize


def _passes(routine: Routine, step: Step) -> int:
    if step.passes is None:
        raise routine.source.error("how often this loop runs does not stand in the text", step.span)
    return step.passes


def _ways(
    steps: Sequence[Step], costs: Sequence[float], places: Mapping[str, int], first: int, last: int
) -> dict[int, float]:
    """What it costs at the most to get through each step from `first` to `last` that can be reached, forwards only."""
    arrived = {first: 0.0} if steps else {}
    for place in range(first, last + 1):
        if place not in arrived:
            continue
        arrived[place] += costs[place]
        for following in _following(steps[place], place, places):
            if place < following <= last:
                arrived[following] = max(arrived.get(following, 0.0), arrived[place])
    return arrived


def _following(step: Step, place: int, places: Mapping[str, int]) -> Iterator[int]:
    if step.goes_on:
        yield place + 1
    if step.jump is not None:
        yield places[step.jump]
