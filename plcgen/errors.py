"""The one family of errors that a user may meet: each says what, where, the numbers, and the way out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Location:
    """A place in a text file: 1-based line and column, the line's text, and how many columns are meant."""

    file: str
    line: int
    column: int
    text: str = ""
    length: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"

    def excerpt(self) -> str:
        """The line of text with a caret under the place; empty when the text is not known."""
        if not self.text.strip():
            return ""
        indent = len(self.text) - len(self.text.lstrip())
        start = max(self.column - 1, indent)
        width = max(1, min(self.length, len(self.text) - start))
        # A tab before the caret stays a tab, so that the caret stands under the same column on any terminal.
        margin = "".join(character if character == "\t" else " " for character in self.text[indent:start])
        return f"    {self.text[indent:].rstrip()}\n    {margin}{'^' * width}"


class PlcgenError(Exception):
    """Bad usage or bad input. The command line prints it without a traceback and exits with 2."""

    def __init__(self, message: str, location: Location | None = None) -> None:
        super().__init__(message, location)
        self.message = message
        self.location = location

    def __str__(self) -> str:
        if self.location is None:
            return self.message
        excerpt = self.location.excerpt()
        return f"{self.location}: {self.message}" + (f"\n{excerpt}" if excerpt else "")


class JobError(PlcgenError):
    """A job file that cannot be used."""


class SourceError(PlcgenError):
    """PLC source text that cannot be parsed, typed, lowered or imported."""


class Fault(PlcgenError):  # noqa: N818 - the field's own word
    """An event in a run that stops a real CPU: array bound, watchdog, missing block, nesting too deep."""
