"""Sweeps: the same for a seed, and a program that loses pulses is found."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import pytest

from plcgen import sweeps
from plcgen.check.two_axis_sweep import Order, Sweep, sweep
from plcgen.errors import PlcgenError
from plcgen.job import read_job
from plcgen.plan_two_axis import TwoAxisPlan
from plcgen.sweeps import TARGET, random_orders, run_sweep
from tests.test_cli import plcgen

GOLDEN = Path(__file__).parents[1] / "golden"
INTERRUPT, TABLE = (GOLDEN / case / "job.toml" for case in ("quadrants", "quadrants-profile"))


def plan_of(path: Path) -> TwoAxisPlan:
    return TwoAxisPlan.of(read_job(path))


@pytest.mark.parametrize("path", [INTERRUPT, TABLE], ids=["interrupt", "table"])
def test_nothing_is_lost(path: Path) -> None:
    plan = plan_of(path)
    orders = list(random_orders(plan.job, "1", 12))
    found = sweep(plan.subject(plan.sources(TARGET)), orders)
    assert found.ok
    assert (found.moves, found.refused, found.lost, found.events) == (12, 0, 0, 0)
    assert found.pulses == sum(abs(pulses) for order in orders for pulses in order.due)


def test_orders_go_everywhere_and_are_the_same_again() -> None:
    job = plan_of(INTERRUPT).job
    orders = list(random_orders(job, "7", 300))
    assert orders == list(random_orders(job, "7", 300))
    assert orders != list(random_orders(job, "8", 300))
    signs = {(x > 0) - (x < 0) for order in orders for x in order.due}
    assert signs == {-1, 0, 1}
    longest = [max(map(abs, order.due)) for order in orders]
    assert max(longest) > 100 * min(longest)


def test_a_pulse_lost_is_found() -> None:
    """A program that sends a pulse too few in each sample."""
    plan = plan_of(INTERRUPT)
    files = dict(plan.sources(TARGET))
    joined = f"{plan.job.name}.awl"
    text = files[joined].decode("ascii")
    spoilt = text.replace("SMB67\r\nPLS", "SMB67\r\nDECD   VD1309\r\nPLS")  # the count of the first segment
    assert spoilt != text
    found = sweep(plan.subject({**files, joined: spoilt.encode("ascii")}), random_orders(plan.job, "1", 3))
    assert not found.ok
    assert found.lost > 0
    assert " sent " in found.finding


def test_sums_keep_the_first_finding() -> None:
    first, second = Sweep(2, 1, 30, 1, 0, "(1, 2) sent 1, 1"), Sweep(3, 0, 40, 2, 1, "(5, 5) sent 4, 4")
    assert first + second == Sweep(5, 1, 70, 3, 1, "(1, 2) sent 1, 1")
    assert Sweep(events=1).ok is False


def test_shares_add_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeps, "SHARE", 4)
    totals = list(run_sweep(read_job(TABLE), 10, 3))
    assert [total.moves for total in totals] == [4, 8, 10]
    assert totals[-1].ok


def test_only_a_two_axis_job_can_be_swept() -> None:
    with pytest.raises(PlcgenError, match='sweep runs moves of method "two-axis"; the job has "hoist"'):
        next(iter(run_sweep(read_job(GOLDEN / "main-shaft" / "job.toml"), 10, 1)))


def test_command() -> None:
    result = plcgen("sweep", str(TABLE), "--moves", "5")
    assert result.exit_code == 0
    assert result.output.splitlines()[0] == "Sweep"
    assert result.output.split()[-6::5] == ["5", "ok"]


def test_order_is_named_by_its_pulses() -> None:
    assert str(Order((3, -4), (0, -4))) == "(3, -4)"
    assert list(islice(random_orders(plan_of(INTERRUPT).job, "1", 0), 1)) == []
