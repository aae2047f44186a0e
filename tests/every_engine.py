"""The engines that a program can run on, and how tests choose among them."""

from __future__ import annotations

from pathlib import Path

import pytest

from plcgen import kept
from plcgen.plc import engines
from plcgen.plc.machine import Machine

NATIVE = "native"
"""The fast engine where all is compiled before it runs, which a user only gets for what runs for long."""
QUICK = (engines.FAST, NATIVE)
CHOICES = (*engines.ENGINES, NATIVE)
NEVER = 10**12


def choose(engine: str, monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let machines run on an engine; the fast one stays with its virtual machine unless it is called native."""
    monkeypatch.setenv(engines.VARIABLE, engines.FAST if engine == NATIVE else engine)
    if engine == engines.PLAIN:
        return
    pytest.importorskip("numba", reason="the fast engine needs Numba: pip install plcgen[fast]")
    from plcgen.plc.fast import engine as fast
    from plcgen.plc.fast import native

    monkeypatch.setattr(fast, "_IMAGES", {})
    monkeypatch.setattr(native, "SCANS_A_ROW", 0 if engine == NATIVE else NEVER)
    place = folder / engine
    place.mkdir(exist_ok=True)
    monkeypatch.setattr(kept, "folder", lambda: place)


def is_native(machine: Machine) -> bool:
    """Whether it has code for the processor."""
    from plcgen.plc.fast import vm
    from plcgen.plc.fast.memory import FastRunner

    assert isinstance(machine.engine, FastRunner)
    return bool(machine.engine.engine._state[vm.NATIVE])
