"""Work in processes: in order, and told when one of them dies."""

from __future__ import annotations

import os

import pytest

from plcgen.errors import PlcgenError
from plcgen.processes import in_processes


@pytest.mark.parametrize("cores", [1, 3])
def test_results_come_in_order(monkeypatch: pytest.MonkeyPatch, cores: int) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    assert list(in_processes(pow, [2, 3, 4], [3, 2, 1])) == [8, 9, 4]


def test_a_process_that_dies_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    with pytest.raises(PlcgenError, match=r"a process that did a share of the work has died; is there enough memory\?"):
        list(in_processes(os._exit, [1, 1]))
