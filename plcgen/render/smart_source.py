"""What the templates of every S7-200 SMART program see, and how their networks get their numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from plcgen.profile.constants import Constant, ConstantGroup
from plcgen.render.comments import Words
from plcgen.render.scl_source import note


@dataclass(frozen=True)
class Named:
    """Attribute access for templates: `{{ v.gamma }}` is an address, `{{ block.start }}` a block in its head and
    `{{ call.start }}` in a CALL.
    """

    by_name: Mapping[str, str]

    def __getattr__(self, name: str) -> str:
        try:
            return self.by_name[name]
        except KeyError:
            raise AttributeError(name) from None


@dataclass(frozen=True)
class Routine:
    """A block: its name in the file and its number."""

    name: str
    purpose: str


def heads(blocks: Mapping[str, Routine]) -> Named:
    """The names of blocks as their heads spell them."""
    return Named({key: routine.name for key, routine in blocks.items()})


def calls(blocks: Mapping[str, Routine]) -> Named:
    """The same as a CALL or ATCH spells them."""
    return Named({key: routine.name.split(":")[1] for key, routine in blocks.items()})


@dataclass(frozen=True)
class ParameterLine:
    """One constant that Init loads."""

    value: float
    address: str
    note: str


def parameter_lines(
    groups: Iterable[ConstantGroup], loaded: Mapping[str, str], addresses: Mapping[str, str], words: Words
) -> Iterator[ParameterLine]:
    """The constants that `loaded` gives a variable to."""
    for group in groups:
        for constant in group.constants:
            if constant.name in loaded:
                yield ParameterLine(constant.value, addresses[loaded[constant.name]], parameter_note(constant, words))


def parameter_note(constant: Constant, words: Words) -> str:
    """What stands behind a constant in Init."""
    return words("{name}: {note}").format(name=constant.name, note=note(constant, words))


def number_networks(text: str) -> str:
    """The networks of each block counted from 1: templates share parts, so that only the whole knows the numbers."""
    lines, number = [], 0
    for line in text.split("\n"):
        if "_BLOCK " in line:
            number = 0
        if line.startswith("Network"):
            number += 1
            line = f"Network {number}{line.removeprefix('Network')}"
        lines.append(line)
    return "\n".join(lines)
