"""What verification says: named figures, each with the bound it must keep."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, isfinite, isnan


@dataclass(frozen=True)
class Check:
    """One figure against its bound: at most the bound, or at least it where `at_least`. NaN never passes."""

    name: str
    value: float
    bound: float
    unit: str
    at_least: bool = False
    detail: str = ""

    @property
    def ok(self) -> bool:
        return self.value >= self.bound if self.at_least else self.value <= self.bound

    def as_json(self) -> dict[str, object]:
        """NaN and infinity, which JSON does not know, become null."""
        value = self.value if isfinite(self.value) else None
        return {"name": self.name, "value": value, "bound": self.bound, "unit": self.unit, "ok": self.ok}


def nearer(first: Check, second: Check) -> Check:
    """The one of two figures of a name that comes nearer to its bound, or misses it by more."""
    nearer = max(second, first, key=lambda check: strain(check.value, check.bound, check.at_least))
    return replace(nearer, detail="; ".join(check.detail for check in (first, second) if check.detail))


def strain(value: float, bound: float, at_least: bool = False) -> float:
    """Above 1 when the bound is missed; NaN counts as infinite."""
    if isnan(value):
        return inf
    return -value if at_least else value / max(bound, 1e-300)


@dataclass(frozen=True)
class TargetVerdict:
    """All checks of one target."""

    checks: tuple[Check, ...]

    @property
    def ok(self) -> bool:
        return bool(self.checks) and all(check.ok for check in self.checks)

    @property
    def failed(self) -> tuple[Check, ...]:
        return tuple(check for check in self.checks if not check.ok)

    def as_json(self) -> dict[str, object]:
        return {"ok": self.ok, "checks": [check.as_json() for check in self.checks]}


@dataclass(frozen=True)
class Verdict:
    """A job and the verdict on each of its targets."""

    job: str
    targets: Mapping[str, TargetVerdict]

    @property
    def ok(self) -> bool:
        return bool(self.targets) and all(verdict.ok for verdict in self.targets.values())

    def as_json(self) -> dict[str, object]:
        targets = {name: verdict.as_json() for name, verdict in self.targets.items()}
        return {"ok": self.ok, "job": self.job, "targets": targets}
