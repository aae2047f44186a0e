"""Named constants: what a derivation hands to a template, with unit, meaning and origin."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Constant:
    """One number of the generated source. `origin` is the equation or rule it comes from."""

    name: str
    value: float
    unit: str
    comment: str
    origin: str = ""


@dataclass(frozen=True)
class ConstantGroup:
    """Constants that belong together, in the order of the source."""

    title: str
    constants: tuple[Constant, ...]
