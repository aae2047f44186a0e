"""Random expressions: SCL text through parser, lowering and engine against numpy, one rounding for each operator."""

from __future__ import annotations

import operator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.errors import Fault
from plcgen.plc.machine import Machine
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.scl.lowering import lower
from plcgen.plc.scl.parser import parse
from plcgen.plc.source import SourceText

Tree = str | tuple[str, "Tree", "Tree"]
OPERATORS = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}
SMALLEST_NORMAL = np.float32(2.0**-126)

leaves = st.sampled_from(["x", "y", "z"])
trees: st.SearchStrategy[Tree] = st.recursive(
    leaves, lambda below: st.tuples(st.sampled_from("+-*/"), below, below), max_leaves=8
)
reals = st.floats(width=32, allow_subnormal=False)


def spelt(tree: Tree) -> str:
    if isinstance(tree, str):
        return tree
    symbol, left, right = tree
    return f"({spelt(left)} {symbol} {spelt(right)})"


def wanted(tree: Tree, values: dict[str, np.float32]) -> np.float32:
    if isinstance(tree, str):
        return values[tree]
    symbol, left, right = tree
    result = np.float32(OPERATORS[symbol](wanted(left, values), wanted(right, values)))
    return np.float32(0.0) if result and abs(result) < SMALLEST_NORMAL else result


def machine(body: str) -> Machine:
    text = f"""
FUNCTION_BLOCK FB1
VAR_INPUT x, y, z : REAL; n : INT; low, b : BOOL; a : ARRAY[1 .. 3] OF BOOL; END_VAR
VAR_OUTPUT r : REAL; END_VAR
BEGIN
  {body}
END_FUNCTION_BLOCK
DATA_BLOCK DB1 FB1
BEGIN
END_DATA_BLOCK
"""
    return Machine(lower(parse(SourceText("random.scl", text), CLASSIC), CLASSIC))


@settings(max_examples=200, deadline=None)
@given(tree=trees, x=reals, y=reals, z=reals)
@np.errstate(all="ignore")
def test_real_expressions_round_after_every_operator(tree: Tree, x: float, y: float, z: float) -> None:
    values = {"x": np.float32(x), "y": np.float32(y), "z": np.float32(z)}
    tested = machine(f"r := {spelt(tree)};")
    for name, value in values.items():
        tested.variable(f"DB1.{name}").set(float(value))
    tested.call("FB1", "DB1")
    result = tested.variable("DB1.r").get()
    expected = float(wanted(tree, values))
    assert result == expected or (result != result and expected != expected)


@pytest.mark.parametrize("condition", ["low AND a[n]", "NOT low OR a[n]"])
def test_both_operands_are_evaluated(condition: str) -> None:
    tested = machine(f"b := {condition};")
    tested.variable("DB1.n").set(4)
    with pytest.raises(Fault, match=r"array index 4 outside 1 \.\. 3"):
        tested.call("FB1", "DB1")
