"""A block that is driven sample by sample, many at once where the engine has a way."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

from plcgen.plc.script import NO_SCRIPT, Place, Script, Step, scripted
from plcgen.plc.types import BOOL

WORTH_A_SCRIPT = 8
"""Fewer steps are made sooner than written."""


class Played(ABC):
    """What axes of S7 and SMART share: see `cosine_model.Axis`."""

    @abstractmethod
    def set(self, **inputs: float) -> None: ...
    @abstractmethod
    def get(self, name: str) -> float: ...
    @abstractmethod
    def _place(self, name: str) -> Place:
        """Where an input or output lies, from the first byte on that is recorded."""

    @abstractmethod
    def _begin(self, script: Script, byte: int, mask: int) -> int:
        """Calls with the inputs of a script, one at least, up to one that leaves a bit of a byte set: how many."""

    def samples(self, most: int, until: str = "") -> None:
        """Calls of the cyclic interrupt, up to one behind which the output `until` is TRUE."""
        self._play(Script(NO_SCRIPT, most), until)

    def play(self, steps: Sequence[Step]) -> None:
        """Steps of inputs and the calls that follow."""
        if len(steps) >= WORTH_A_SCRIPT:
            self._play(scripted(steps, self._place))
            return
        for inputs, count in steps:
            self.set(**inputs)
            self.samples(count)

    def _play(self, script: Script, until: str = "") -> None:
        byte, bit, _ = self._place(until) if until else (0, 0, BOOL)
        while script.calls:
            calls = self._begin(script, byte, 1 << bit if until else 0)
            if until and self.get(until):
                return
            script = script.after(calls)
