"""What machine instructions take on CPUs of the S7-300, by class: estimates.

Times are said to be from Siemens' instruction list A5E00261439; they were seen second-hand. What that table does not
list is taken as the dearest thing like it: EXP, LN and the other functions as COS, multiplication of integers as of
REAL, their division as that of REAL; address registers, data blocks, shifts and word logic as a load.
Sizes follow from the shape of instructions: a word for what has no operand, two with an address, three with a constant
of 32 bits; no manual was at hand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

CLASSES: Mapping[str, tuple[int, tuple[float, float, float]]] = {
    # bytes, ns on CPU 314, 315-2DP, 317
    "bit": (4, (60, 50, 30)),
    "load": (4, (160, 120, 40)),
    "constant": (6, (160, 120, 40)),
    "transfer": (4, (140, 110, 40)),
    "accumulator": (2, (160, 120, 40)),
    "integer": (2, (120, 90, 30)),
    "integer compare": (2, (230, 180, 60)),
    "integer product": (2, (580, 440, 160)),
    "integer quotient": (2, (2520, 1890, 250)),
    "real": (2, (580, 440, 160)),
    "real quotient": (2, (2520, 1890, 250)),
    "real compare": (2, (870, 670, 270)),
    "root": (2, (4220, 3240, 1260)),
    "sine": (2, (3900, 3000, 1200)),
    "function": (2, (4750, 3650, 1500)),
    "conversion": (2, (370, 290, 110)),
    "jump": (4, (210, 160, 100)),
    "call": (8, (2600, 2000, 780)),
    "return": (2, (880, 680, 260)),
}
SIZES: Mapping[str, int] = {name: size for name, (size, _times) in CLASSES.items()}
BLOCK_HEAD = 36
"""Bytes that a block takes beside its code or data."""


@dataclass(frozen=True)
class Cpu:
    """Its prices in ns, and what the operating system adds as a factor."""

    name: str
    prices: Mapping[str, float]
    system: float


CPUS: tuple[Cpu, ...] = tuple(
    Cpu(name, {kind: times[column] for kind, (_size, times) in CLASSES.items()}, system)
    for column, (name, system) in enumerate([("CPU 314", 1.10), ("CPU 315-2DP", 1.10), ("CPU 317", 1.07)])
)
