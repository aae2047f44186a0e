"""Steps of each language: counts by hand on small sources."""

from __future__ import annotations

from collections import Counter

import pytest

from plcgen.plc.effort.core import core_routines
from plcgen.plc.effort.s7_300 import CLASSES, CPUS
from plcgen.plc.effort.s7_stl import KINDS, stl_routines
from plcgen.plc.effort.smart import code_bytes, smart_routines
from plcgen.plc.effort.steps import Routine, longest
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse as parse_scl
from plcgen.plc.source import SourceText
from plcgen.plc.stl.parser import parse as parse_smart
from plcgen.plc.stl.s7_parser import parse as parse_stl
from plcgen.plc.stl.s7_table import CALLS, MNEMONICS
from plcgen.plc.stl.smart_costs import COSTS

SCL = """FUNCTION FC1 : REAL
VAR_INPUT
    a : REAL;
END_VAR
VAR_TEMP
    sum : REAL;
    n : INT;
END_VAR
BEGIN
    sum := 0.0;
    FOR n := 1 TO {last} DO
        sum := sum + a;
    END_FOR;
    FC1 := sum;
END_FUNCTION
"""

STL = """FUNCTION FC 1 : VOID
VERSION : 0.1
VAR_TEMP
  n : INT ;
  sum : REAL ;
END_VAR
BEGIN
NETWORK
TITLE =
      L     {count};
MORE: T     #n;
      L     #sum;
      L     2.000000e+000;
      +R    ;
      T     #sum;
      L     #n;
      LOOP  MORE;
      BE    ;
END_FUNCTION
"""

SMART = """ORGANIZATION_BLOCK MAIN:OB1
BEGIN
Network 1
LD     SM0.0
FOR    VW0, +1, {last}
Network 2
LD     SM0.0
MOVR   VD100, VD104
+R     VD108, VD104
Network 3
NEXT
Network 4
LD     SM0.0
CALL   SBR0
END_ORGANIZATION_BLOCK
SUBROUTINE_BLOCK Part:SBR0
BEGIN
Network 1
LD     SM0.0
MOVW   VW0, VW2
END_SUBROUTINE_BLOCK
"""


def scl(last: str) -> dict[str, Routine]:
    blocks = parse_scl(SourceText("a.scl", SCL.format(last=last)), CLASSIC)
    return dict(core_routines(lower(list(blocks), CLASSIC)))


def ns(routines: dict[str, Routine], name: str) -> float:
    return longest(routines, name, CPUS[0].prices)


def test_a_pass_of_for_in_scl() -> None:
    # n > last: 2 loads, compare, bit; branch: bit, jump; sum: 2 loads, +R, transfer; n + 1: 2 loads, +I, transfer; jump
    once = (160 + 160 + 230 + 60) + (60 + 210) + (160 + 160 + 580 + 140) + (160 + 160 + 120 + 140) + 210
    assert ns(scl("8"), "FC1") - ns(scl("5"), "FC1") == pytest.approx(3 * once)


def test_a_pass_of_loop_in_stl() -> None:
    few, many = (dict(stl_routines(parse_stl(SourceText("a.awl", STL.format(count=n))))) for n in (2, 12))
    once = 140 + 160 + 160 + 580 + 140 + 160 + 210
    assert ns(few, "FC1") == 160 + 2 * once + 880
    assert ns(many, "FC1") - ns(few, "FC1") == pytest.approx(10 * once)


def test_a_pass_of_for_on_a_smart() -> None:
    few, many = (parse_smart(SourceText("a.awl", SMART.format(last=n))) for n in ("+2", "+12"))
    routines = [dict(smart_routines(blocks)) for blocks in (few, many)]
    # FOR, LD, MOVR, +R, NEXT; a FOR is tested once more than it runs, and so counts once more
    once = COSTS["control"] + COSTS["bit"] + COSTS["word"] + COSTS["real"] + COSTS["control"]
    short, long = (longest(found, "OB1", COSTS) for found in routines)
    assert long - short == pytest.approx(10 * once)
    inside = COSTS["bit"] + COSTS["word"]
    assert short == pytest.approx(COSTS["bit"] + 3 * once + COSTS["bit"] + COSTS["control"] + inside)
    assert code_bytes(few) == code_bytes(many) == 10 * 2 + 14 * 3  # statements, operands


def test_every_instruction_of_stl_has_a_class() -> None:
    assert set(KINDS) <= {*MNEMONICS, *CALLS}
    assert set(KINDS.values()) <= set(CLASSES)
    left = {*MNEMONICS, *CALLS} - set(KINDS)
    # what works on the accumulators alone
    words = {"AW", "OW", "XOW", "AD", "OD", "XOD", "SLW", "SRW", "SSI", "SLD", "SRD", "SSD", "RLD", "RRD"}
    assert left == words | {"RLDA", "RRDA", "TAK", "PUSH", "POP", "CAW", "CAD", "CAR", "CDB", "NOP", "BLD"}


def test_calls_of_stl_pay_for_their_parameters() -> None:
    text = (
        "FUNCTION FC 2 : VOID\nVERSION : 0.1\nVAR_INPUT\n  a : INT ;\nEND_VAR\nBEGIN\nNETWORK\nTITLE =\n"
        "      BE    ;\nEND_FUNCTION\n"
        "FUNCTION FC 1 : VOID\nVERSION : 0.1\nBEGIN\nNETWORK\nTITLE =\n"
        "      CALL FC     2 (\n       a := 1);\n      BE    ;\nEND_FUNCTION\n"
    )
    (step, _end) = stl_routines(parse_stl(SourceText("a.awl", text)))["FC1"].steps
    assert (Counter(step.work), step.call) == (Counter(["call", "load", "transfer"]), "FC2")
