"""Options that several commands have."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import click

from plcgen import completion

Command = TypeVar("Command", bound=Callable[..., None])
PATH = click.Path(path_type=Path)


def target_option(text: str) -> Callable[[Command], Command]:
    """--target with its own help."""
    return click.option("--target", metavar="T", help=text, shell_complete=completion.targets)


def _engine(_context: click.Context, _parameter: click.Parameter, name: str | None) -> None:
    """By the environment, so that processes that share the work use it, too."""
    from plcgen.plc import engines

    if name:
        os.environ[engines.VARIABLE] = name
        engines.chosen()


ENGINE = click.option(
    "--engine",
    type=click.Choice(["plain", "fast"]),
    expose_value=False,
    callback=_engine,
    help="What executes the sources; default fast where Numba is installed.",
)
TARGET = target_option("One target of the job only.")
