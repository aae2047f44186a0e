"""Work in processes: in order, and told when one of them dies."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time

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


@pytest.mark.skipif(os.name == "nt", reason="a process cannot be asked to end there")
def test_workers_end_with_what_began_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """A CI ends what takes too long; the worker would sleep for a minute."""
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    shares = in_processes(time.sleep, [0.0, 60.0])
    next(shares)
    with pytest.raises(SystemExit, match="143"):
        os.kill(os.getpid(), signal.SIGTERM)
    with pytest.raises(PlcgenError, match="has died"):
        list(shares)
    assert multiprocessing.active_children() == []
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
