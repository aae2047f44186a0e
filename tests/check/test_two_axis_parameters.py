"""Parameters that somebody has edited to nonsense: no move starts with them."""

from __future__ import annotations

import re

import pytest

from plcgen.check.two_axis_rig import Table
from plcgen.plan_two_axis import TwoAxisPlan
from tests.check.seeded_faults_stl import joined, names, plan

CHECKED = (
    "v_max", "a_max", "beta", "t_sample", "ppu_x", "ppu_y",
    "t1_full", "s_jerk", "s_full", "a_t", "beta_t2", "train_rate",
)  # fmt: skip


def edited(mode: str, name: str, value: str) -> str:
    address = next(address for address, known in names(mode).items() if known == name)
    text, count = re.subn(rf"MOVR   \S+, {address}  //", f"MOVR   {value}, {address}  //", joined(mode))
    assert count == 1
    return text


def error_of(mode: str, text: str) -> tuple[int, int, int]:
    """What the program answers to a start: error, refused, busy."""
    found = plan(mode)
    assert isinstance(found, TwoAxisPlan)
    table = Table(found.subject({"Small.awl": text.encode()}))
    move = table.model.moves[0]
    table.order(move.x, move.y)
    table.press(0)
    return table.get("error"), table.get("refused"), table.get("busy")


@pytest.mark.parametrize("mode", ["interrupt", "table"])
def test_parameters_of_the_job_are_accepted(mode: str) -> None:
    assert error_of(mode, joined(mode)) == (0, 0, 1)


@pytest.mark.parametrize("mode", ["interrupt", "table"])
@pytest.mark.parametrize("name", CHECKED)
@pytest.mark.parametrize("value", ["0.0", "-1.0"])
def test_zero_and_negative_parameters_are_refused(mode: str, name: str, value: str) -> None:
    assert error_of(mode, edited(mode, name, value)) == (1, 1, 0)


@pytest.mark.parametrize("mode", ["interrupt", "table"])
def test_no_time_at_constant_acceleration_is_a_plausible_parameter(mode: str) -> None:
    """t2 is zero where the jerk is too low for the limit of acceleration; below zero it is nonsense."""
    assert error_of(mode, edited(mode, "t2_full", "0.0"))[0] == 0
    assert error_of(mode, edited(mode, "t2_full", "-1.0")) == (1, 1, 0)
