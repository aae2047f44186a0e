"""Text for people: tables, messages and progress that every console can show."""

from __future__ import annotations

import io
import os
import sys
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

OK, FAILED = "ok", "FAILED"
STYLES = {OK: "green", FAILED: "bold red"}
# Control characters, marks that turn the direction of writing, halves of surrogate pairs, line and paragraph ends.
_UNPRINTABLE = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})
_GAP = "  "

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Table:
    """Cells as text. Columns whose heading begins with `>` are set to the right."""

    title: str
    headings: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(heading.removeprefix(">") for heading in self.headings)

    @property
    def to_the_right(self) -> tuple[bool, ...]:
        return tuple(heading.startswith(">") for heading in self.headings)


def prepare_streams() -> None:
    """From here on a console of any code page gets a `?` for what it cannot show, and a closed stream takes all."""
    sys.stdout, sys.stderr = map(_open, (sys.stdout, sys.stderr))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _open(stream: TextIO | None) -> TextIO:
    return stream or Path(os.devnull).open("w", encoding="utf-8")


def printable(text: str) -> str:
    """The text with one replacement character for each that would control a terminal; line ends and tabs stay."""
    return "".join("\ufffd" if _controls(character) else character for character in text)


def _controls(character: str) -> bool:
    return character not in "\n\t" and unicodedata.category(character) in _UNPRINTABLE


def say(text: str) -> None:
    """A result: one or more lines on stdout."""
    print(printable(text), file=sys.stdout)


def tell(text: str) -> None:
    """A message: one or more lines on stderr."""
    print(printable(text), file=sys.stderr)


# --------------------------------------------------------------------------------------------------------- tables


def show(table: Table) -> None:
    """A drawn table on a terminal, aligned text anywhere else."""
    if sys.stdout.isatty():
        _draw(table, sys.stdout)
    else:
        say(aligned(table))


def aligned(table: Table) -> str:
    """Plain text: the title, the headings, one line a row, and an empty line at the end."""
    lines = (table.names, *table.rows)
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join([table.title, *(_line(line, widths, table.to_the_right) for line in lines), ""])


def _line(cells: tuple[str, ...], widths: list[int], to_the_right: tuple[bool, ...]) -> str:
    padded = (
        cell.rjust(width) if right else cell.ljust(width)
        for cell, width, right in zip(cells, widths, to_the_right, strict=True)
    )
    return (_GAP + _GAP.join(padded)).rstrip()


def _draw(table: Table, file: TextIO) -> None:
    from rich.console import Console
    from rich.table import Table as Drawing
    from rich.text import Text

    drawing = Drawing(title=Text(printable(table.title)), title_justify="left", title_style="bold")
    for name, right in zip(table.names, table.to_the_right, strict=True):
        drawing.add_column(name, justify="right" if right else "left")
    for row in table.rows:
        drawing.add_row(*(Text(printable(cell), STYLES.get(cell, "")) for cell in row))
    Console(file=file).print(drawing)


# ------------------------------------------------------------------------------------------------------- progress


@contextmanager
def progress() -> Iterator[Progress]:
    """A function that shows what is being done: on a terminal a line that goes away again, elsewhere nothing."""
    if not sys.stderr.isatty():
        yield lambda _text: None
        return
    from rich.console import Console
    from rich.text import Text

    with Console(file=sys.stderr).status("", spinner="line") as status:
        yield lambda text: status.update(Text(printable(text)))


@contextmanager
def progress_bar(total: int) -> Iterator[Callable[[int], None]]:
    """A function that shows how many of `total` are done, and how long the rest takes: on a terminal, else nothing."""
    if not sys.stderr.isatty():
        yield lambda _done: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (BarColumn(bar_width=None), MofNCompleteColumn(), TimeRemainingColumn())
    with Bar(*columns, console=Console(file=sys.stderr), transient=True) as bar:
        task = bar.add_task("", total=total)
        yield lambda done: bar.update(task, completed=done)
