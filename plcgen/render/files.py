"""The files that templates make."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class OutputFile:
    """One file of a target: its template below the target's folder, its name, and what it is for."""

    template: str
    name: str
    purpose: str

    @property
    def is_note(self) -> bool:
        """Text for people, beside the sources."""
        return self.name.endswith(".md")
