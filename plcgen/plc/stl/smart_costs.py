"""What instructions are estimated to take on an S7-200 SMART. No manual says; the numbers are parameters.

Often quoted are 0.15 us a contact, 1.2 us a word move and 3.6 us a REAL operation. The others are those of the classic
S7-200 scaled by the same ratio, but PLS, which is taken as it was.
"""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.operators import Operator
from plcgen.plc.stl.smart_table import (
    ARITHMETIC,
    BITS_AND_SHIFTS,
    COILS,
    COMPARES,
    CONTACTS,
    CONTROL,
    CONVERSIONS,
    COUNTING,
    IMMEDIATE_CONTACTS,
    INTERRUPTS_AND_PULSES,
    MNEMONICS,
    MOVES,
    STACK,
)
from plcgen.plc.types import BOOL, INT

COSTS: Mapping[str, float] = {
    "bit": 0.15,
    "word": 1.2,
    "real": 3.6,
    "conversion": 6.0,
    "function": 60.0,
    "block": 20.0,
    "control": 2.0,
    "pulse": 92.0,
}
"""us for each class of instructions."""

_BLOCKS = frozenset({"BMB", "BMW", "BMD", "FILL"})
_FUNCTIONS = frozenset({"SQRT", "SIN", "COS", "TAN", "LN", "EXP"})
_REALS = frozenset({"+R", "-R", "*R", "/R"}) | {word for word in COMPARES if word.lstrip("LDAO")[:1] == "R"}
_SPECIAL: Mapping[str, str] = {
    **dict.fromkeys(_BLOCKS, "block"),
    **dict.fromkeys(_FUNCTIONS, "function"),
    **dict.fromkeys(_REALS, "real"),
    "PLS": "pulse",
}
_GENERAL = (
    ("bit", (CONTACTS, IMMEDIATE_CONTACTS, STACK, COILS)),
    ("word", (COMPARES, MOVES, ARITHMETIC, BITS_AND_SHIFTS, COUNTING)),
    ("conversion", (CONVERSIONS,)),
    ("control", (CONTROL, INTERRUPTS_AND_PULSES)),
)


def _class_of(word: str) -> str:
    general = (name for name, groups in _GENERAL if any(word in group for group in groups))
    return _SPECIAL.get(word) or next(general)


CLASSES: Mapping[str, str] = {word: _class_of(word) for word in MNEMONICS}
"""The class of each mnemonic."""
NUMBERS: Mapping[str, int] = {name: number for number, name in enumerate(COSTS)}

SPEND = Operator("SPEND", (INT,), BOOL, "count({0})")
"""(number of the class) : an instruction of it is executed, see `Engine.take_counts`."""
