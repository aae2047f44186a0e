"""What every method offers: a job with what was derived from it, and the way from there to verified sources."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from plcgen.check.verdict import TargetVerdict
from plcgen.estimates import Estimate, estimate, estimate_context
from plcgen.job import Job
from plcgen.profile.constants import ConstantGroup
from plcgen.render.environment import render
from plcgen.render.files import OutputFile
from plcgen.render.language import words_of
from plcgen.render.mnemonics import to_german
from plcgen.render.smart_source import number_networks
from plcgen.targets import TARGETS, Target
from plcgen.trajectory import Trajectory

Progress = Callable[[str], None]
Files = Mapping[str, bytes]


@dataclass(frozen=True)
class Stretch:
    """One part of a motion: its name, duration in s, travel, and speed at its end, in the units of the job."""

    name: str
    duration: float
    travel: float
    end_velocity: float


@dataclass(frozen=True)
class Comparison:
    """Choices side by side: the first cell of a row is its name."""

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str | float, ...], ...]


@dataclass(frozen=True)
class Derivation:
    """What `plcgen derive` shows."""

    stretches: tuple[Stretch, ...]
    tables: tuple[ConstantGroup, ...]
    comparisons: tuple[Comparison, ...] = ()
    title: str = "Moves"


@dataclass(frozen=True)
class Plan(ABC):
    """A job that can be kept. Each method has its own."""

    job: Job

    @abstractmethod
    def derivation(self) -> Derivation: ...

    @abstractmethod
    def outputs(self, target: str) -> tuple[OutputFile, ...]:
        """Files of a target in the order of import."""

    @abstractmethod
    def context(self, target: str, verified: bool) -> dict[str, object]:
        """What the templates of a target may name."""

    @abstractmethod
    def verify(
        self, target: str, files: Files, progress: Progress | None = None, fail_fast: bool = False
    ) -> TargetVerdict:
        """Execute sources and hold them against the reference. Raises SourceError."""

    @abstractmethod
    def reference(self) -> Trajectory:
        """The nominal motion in float64, sampled with the period of the job."""

    @abstractmethod
    def golden_trace(self, target: str, files: Files) -> Trajectory:
        """What sources do on the nominal motion."""

    def sources(self, target: str, verified: bool = True) -> dict[str, bytes]:
        """Files of a target by name, encoded as its engineering tool reads them."""
        context = self.context(target, verified)
        code = {file.name: self._file(target, file, context) for file in self.outputs(target) if not file.is_note}
        told = estimate_context(self.estimate(target, code), self.job.sample_period, words_of(self.job.language))
        notes = {file.name: self._file(target, file, context | told) for file in self.outputs(target) if file.is_note}
        return code | notes

    def _file(self, target: str, file: OutputFile, context: dict[str, object]) -> bytes:
        row = TARGETS[target]
        language = self.job.language
        text = render(f"{row.folder}/{self.job.method}/{file.template}", context, language)
        codec = "utf-8" if file.is_note else row.codec(language)
        return finished(self.job, row, file, text).replace("\n", row.newline).encode(codec)

    def estimate(self, target: str, files: Files) -> Estimate:
        """Run time and memory of the sources of a target."""
        return estimate(target, files, self.reserved_bytes(target))

    def reserved_bytes(self, _target: str) -> int:
        """V memory that the program takes; other targets keep their data in blocks of their own."""
        return 0


def finished(job: Job, target: Target, file: OutputFile, text: str) -> str:
    """A rendered text as it goes to disk: STL with its networks numbered, or in German mnemonics, where that is due."""
    if not file.name.endswith(".awl"):
        return text
    if target.dialect == "smart":
        return number_networks(text)
    return to_german(text) if job.mnemonics == "german" else text
