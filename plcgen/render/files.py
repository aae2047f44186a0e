"""Where templates are, and the files that they make."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from plcgen.render.comments import Words
from plcgen.targets import ENGLISH


def template_folder() -> Path:
    """`templates/` beside the package in a checkout, inside the package in a wheel."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "templates"
    return installed if installed.is_dir() else package.parent / "templates"


def localised(name: str, language: str) -> str:
    """The name of the text `name` in a language: `import.zh.md` of `import.md`."""
    stem, _, suffix = name.rpartition(".")
    return name if language == ENGLISH else f"{stem}.{language}.{suffix}"


def example_job(method: str, language: str) -> Path:
    """The example job of a method with comments in a language."""
    return template_folder() / "jobs" / localised(f"{method}.toml", language)


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


def described(files: Iterable[OutputFile], words: Words) -> tuple[OutputFile, ...]:
    """The files with their purposes in the words of a language."""
    return tuple(replace(file, purpose=words(file.purpose)) for file in files)
