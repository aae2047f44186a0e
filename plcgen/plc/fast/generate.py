"""Writes `vm.py`, the virtual machine, from the bodies of operators: python -m plcgen.plc.fast.generate"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from hashlib import sha256
from itertools import count
from pathlib import Path

from plcgen.plc import operators
from plcgen.plc.fast.bodies import Body, body_of, lines
from plcgen.plc.operators import Operator
from plcgen.plc.stl import s7_operators, smart_boxes, smart_costs, smart_operators
from plcgen.plc.types import BYTE, DINT, INT, REAL, WORD

FILE = Path(__file__).with_name("vm.py")
HELPERS = FILE.with_name("helpers.py")
CALLERS = tuple(FILE.with_name(name) for name in ("call_loop.py", "closed_loop.py", "event_loop.py"))
"""What has to change with the virtual machine that it calls."""
COMMON = frozenset({"BOOL", "BYTE", "WORD", "DWORD", "CHAR", "INT", "DINT", "REAL", "TIME"})
"""Types whose rows have bodies; the others are rare."""
FIRST_BODY = 32
HEAD = '''"""The virtual machine. Written by `generate.py`: change that, not this.

`code` holds an instruction a row: number, target, four operands, six numbers and the site. All but memory, M, lies in
one piece, `room`: the state, counters, the stack of calls, events, and behind them the slots, seen as integers in I and
as floats in F. It ends with what it needs: nothing, an operator that Python has to evaluate, room for events; or
because the budget is spent.
"""

from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.helpers import *

HELPERS = "{helpers}"
"""Beginning of the SHA-256 of helpers.py. Numba compiles anew when a file has changed, not when what it calls has."""
DONE, REQUEST, EXHAUSTED, FULL, HANDED_OVER = range(5)
"""The last is of native code: the virtual machine goes on from the row that it has noted."""
QUIET = -1
"""Of `enter`: ended, and there is nothing to tell."""
START, BUDGET, CALLS, NATIVE = range(4)
"""Fields of the state; the last is the address of native code, if there is any."""
BASE = 1
"""Slot of the instance's first byte."""
FACTOR = 3
KIND0, KIND1, KIND2, KIND3 = range(4)
ROUNDING0, ROUNDING1, ROUNDING2, ROUNDING3 = range(4)
COUNTS, STACK, EVENTS, SLOTS = 16, 80, 8208, 8208 + 131072
MOST_EVENTS = 30000
"""Noted before Python is told: the others fit between two jumps backwards."""
'''
TAIL = '''
@njit(cache=True, error_model="numpy", nogil=True)
def enter(code: Any, room: Any, memory: Any, start: int, base: int, budget: int) -> int:
    """Run from row `start` on the instance at `base`. Returns QUIET, or what `run` ended with."""
    room[START], room[BUDGET], room[CALLS] = start, budget, 0
    room[SLOTS + BASE] = base
    ended = HANDED_OVER
    if room[NATIVE]:
        ended = called(room[NATIVE], room.ctypes.data, memory.ctypes.data, start)
    if ended == HANDED_OVER:
        ended = run(code, room, memory)
    return QUIET if ended == DONE and not room[EVENTS] else ended
'''
STAMP = re.compile(r'(?<=^VM = ")\w+(?="$)', re.MULTILINE)
"""In the callers."""
PIECES = "I = room[SLOTS:]", "F = I.view(np.float64)"


def written() -> str:
    """The text of the module."""
    bodies = all_bodies()
    text = [HEAD.format(helpers=stamp(HELPERS.read_text("ascii"))), "BODIES = {"]
    text += [f"    {body.key!r}: {number}," for body, number in zip(bodies, count(FIRST_BODY), strict=False)]
    text += ["}", "", "", '@njit(cache=True, error_model="numpy", nogil=True)']
    text += ["def run(code: Any, room: Any, M: Any) -> int:"]
    text += ["    " + row for row in (*PIECES, *_loop(bodies))]
    return "\n".join(text) + "\n\n" + TAIL


def stamp(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:16]


def stamped(caller: Path, machine: str) -> str:
    """The text of a caller for a text of the virtual machine."""
    return STAMP.sub(stamp(machine), caller.read_text("ascii"))


def all_bodies() -> list[Body]:
    found = [body_of(row) for row in rows()]
    return sorted({body for entry in found if entry for body in entry[:1]}, key=lambda body: body.key)


def rows() -> Iterator[Operator]:
    """Rows of the common table, and what STL of both CPUs adds to it."""
    for name in operators._table():
        for row in operators.alternatives(name):
            if {str(kind) for kind in (*row.operands, row.result)} <= COMMON:
                yield row
    for module in (s7_operators, smart_operators, smart_boxes, smart_costs):
        yield from _of_module(vars(module).values())
    yield from _parametrised()


def _of_module(values: Iterable[object]) -> Iterator[Operator]:
    for value in values:
        if isinstance(value, Operator):
            yield value
        elif isinstance(value, dict):
            yield from (entry for entry in value.values() if isinstance(entry, Operator))


def _parametrised() -> Iterator[Operator]:
    """One of each family of rows that are made when they are needed."""
    for symbol in ("+", "-", "*", "/", "SQR", "EXP", "SQRT"):
        yield s7_operators.real_overflow(symbol)
    for symbol in "+-*":
        for kind in (INT, DINT):
            yield s7_operators.whole_overflow(symbol, kind)
    for kind in (INT, DINT):
        yield s7_operators.negation_overflow(kind)
    yield from (s7_operators.pointed(800, bits, offset, "x") for bits in (1, 32) for offset in (0, 640))
    yield from (smart_operators.pointed(size) for size in (1, 2, 4))
    yield from (smart_operators.status(kind, divides) for kind in (BYTE, INT, DINT, REAL) for divides in (False, True))
    yield from (smart_operators.outcome(kind, divides) for kind in (BYTE, INT, DINT, REAL) for divides in (False, True))
    yield from (smart_operators.illegal(kind) for kind in (INT, DINT, BYTE, WORD))
    yield from (smart_operators.arithmetic(symbol, kind) for symbol in "+-*/" for kind in (BYTE, INT, DINT, REAL))
    yield smart_operators.widened(DINT, INT)
    yield operators.INDEX


# ----------------------------------------------------------------------------------------------------- the loop

TELL = ("if room[EVENTS] > MOST_EVENTS:", "    room[START] = pc - 1", "    return FULL")
SPEND = ("room[BUDGET] -= 1", "if room[BUDGET] < 0:", "    room[START] = pc", "    return EXHAUSTED")
FIXED: tuple[tuple[str, ...], ...] = (
    # 0 .. : control
    (*TELL, *SPEND, "pc = t - 1"),  # jump backwards
    ("pc = t - 1",),
    ("if I[a] != 0:", "    pc = t - 1"),
    ("if I[a] == 0:", "    pc = t - 1"),
    (*TELL, *SPEND, "room[STACK + room[CALLS]] = pc", "room[STACK + room[CALLS] + 1] = I[1]", "room[CALLS] += 2",
     "I[1] = I[a] + b", "pc = t - 1"),  # call
    ("if room[CALLS] == 0:", "    return DONE", "room[CALLS] -= 2", "pc = room[STACK + room[CALLS]]",
     "I[1] = room[STACK + room[CALLS] + 1]"),  # return
    ("room[START] = pc", "return REQUEST"),
    ("I[t] = I[a]",),
    ("for place in range(b):", "    M[t + place] = I[c] & 255"),  # fill
    ("p, bit = t + I[a] + (I[b] >> 3), c + I[d] + (I[code[pc, 7]] >> 3)", "for place in range(code[pc, 6]):",
     "    M[p + place] = M[bit + place]"),  # copy
    # 10 .. : load t from a + bytes I[b] + bits I[c]
    ("bit = a + (I[b] << 3) + I[c]", "I[t] = (M[bit >> 3] >> (bit & 7)) & 1"),
    ("I[t] = M[a + I[b] + (I[c] >> 3)]",),
    ("x = M[a + I[b] + (I[c] >> 3)]", "I[t] = np.int64(x) - 256 if x > 127 else np.int64(x)"),
    ("p = a + I[b] + (I[c] >> 3)", "I[t] = np.int64(M[p]) << 8 | np.int64(M[p + 1])"),
    ("p = a + I[b] + (I[c] >> 3)", "x = np.int64(M[p]) << 8 | np.int64(M[p + 1])",
     "I[t] = x - 65536 if x > 32767 else x"),
    ("p = a + I[b] + (I[c] >> 3)", "I[t] = WORD32"),
    ("p = a + I[b] + (I[c] >> 3)", "x = WORD32", "I[t] = x - 4294967296 if x > 2147483647 else x"),
    ("p = a + I[b] + (I[c] >> 3)", "F[t] = bits_to_real(WORD32)"),
    ("p = a + I[b] + (I[c] >> 3)", "x = np.int64(M[p])", "for place in range(1, 8):",
     "    x = x << 8 | np.int64(M[p + place])", "I[t] = x"),
    # 19 .. : store I[d] to t + bytes I[b] + bits I[c]
    ("bit = t + (I[b] << 3) + I[c]", "if I[d] != 0:", "    M[bit >> 3] |= 1 << (bit & 7)", "else:",
     "    M[bit >> 3] &= 255 - (1 << (bit & 7))"),
    ("M[t + I[b] + (I[c] >> 3)] = I[d] & 255",),
    ("p = t + I[b] + (I[c] >> 3)", "x = I[d]", "M[p] = x >> 8 & 255", "M[p + 1] = x & 255"),
    ("p = t + I[b] + (I[c] >> 3)", "x = I[d]", "STORE32"),
    ("p = t + I[b] + (I[c] >> 3)", "x = real_to_bits(F[d])", "STORE32"),
    ("p = t + I[b] + (I[c] >> 3)", "x = I[d]", "for place in range(8):", "    M[p + 7 - place] = x & 255",
     "    x = x >> 8"),
    # 25: INDEX, (index, low, high, stride)
    ("if I[a] < I[b] or I[a] > I[c]:", "    room[START] = pc", "    return REQUEST", "I[t] = (I[a] - I[b]) * I[d]"),
    ("for place in range(b):", "    I[t + place] = I[a + place]"),  # spread
)  # fmt: skip
WORD32 = "np.int64(M[p]) << 24 | np.int64(M[p + 1]) << 16 | np.int64(M[p + 2]) << 8 | np.int64(M[p + 3])"
STORE32 = ("M[p] = x >> 24 & 255", "M[p + 1] = x >> 16 & 255", "M[p + 2] = x >> 8 & 255", "M[p + 3] = x & 255")


def _loop(bodies: list[Body]) -> Iterator[str]:
    yield "pc = room[START]"
    yield "while True:"
    yield "    op = code[pc, 0]"
    yield "    t, a, b, c, d = code[pc, 1], code[pc, 2], code[pc, 3], code[pc, 4], code[pc, 5]"
    yield "    site = code[pc, 12]"
    for number, block in enumerate(_blocks(bodies)):
        yield f"    {'el' if number else ''}if op == {block[0]}:"
        yield from (f"        {row}" for row in block[1])
    yield "    pc += 1"


def _blocks(bodies: list[Body]) -> Iterator[tuple[int, list[str]]]:
    for number, fixed in enumerate(FIXED):
        yield number, [line for row in fixed for line in _expanded(row)]
    for body, number in zip(bodies, count(FIRST_BODY), strict=False):
        yield number, list(lines(body))


def _expanded(row: str) -> Iterable[str]:
    return STORE32 if row == "STORE32" else (row.replace("WORD32", WORD32),)


if __name__ == "__main__":
    FILE.write_text(written(), "ascii")
    for caller in CALLERS:
        caller.write_text(stamped(caller, written()), "ascii")
