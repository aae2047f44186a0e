"""How a command ends: one message and an exit code, whatever went wrong."""

from __future__ import annotations

import errno
import os
import sys
from typing import Any

import click

from plcgen import terminal
from plcgen.errors import Fault, PlcgenError
from plcgen.processes import search_seldom

FAILED, BAD_INPUT = 1, 2
# As a shell reports a program that the keyboard or a closed pipe has ended.
INTERRUPTED, PIPE_CLOSED = 130, 141
DEBUG = "PLCGEN_DEBUG"
"""Environment variable: set to anything, an error inside plcgen itself shows its traceback."""


class Commands(click.Group):
    """Turns whatever goes wrong into one message and an exit code."""

    def main(self, *args: Any, **extra: Any) -> Any:
        search_seldom()
        terminal.prepare_streams()
        return super().main(*args, **extra)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            result = super().invoke(ctx)
            sys.stdout.flush()
        except (click.ClickException, click.exceptions.Exit, click.Abort):
            raise
        except KeyboardInterrupt:
            raise click.exceptions.Exit(INTERRUPTED) from None
        except Exception as error:
            raise click.exceptions.Exit(_exit_code(error)) from error
        return result

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args[0] not in self.commands and not args[0].startswith("-"):
            from plcgen.names import nearest

            near = nearest(args[0], self.commands)
            known = f'write "{near}"' if near else f"there is {', '.join(self.list_commands(ctx))}"
            raise click.UsageError(f'unknown command "{terminal.printable(args[0])}"; {known}', ctx)
        return super().resolve_command(ctx, args)

    def list_commands(self, _ctx: click.Context) -> list[str]:
        return list(self.commands)


def _exit_code(error: Exception) -> int:
    """Say what went wrong."""
    if isinstance(error, PlcgenError):
        terminal.tell(f"error: {error}")
        return FAILED if isinstance(error, Fault) else BAD_INPUT
    if isinstance(error, OSError):
        return _system_error(error)
    if os.environ.get(DEBUG):
        raise error
    terminal.tell(f"error: {type(error).__name__} inside plcgen: {error}; set {DEBUG}=1 to see where, and report it")
    return BAD_INPUT


def _system_error(error: OSError) -> int:
    if error.errno == errno.EPIPE:
        # Python flushes stdout once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    place = f"{error.filename}: " if error.filename else ""
    terminal.tell(f"error: {place}{error.strerror or error}")
    return BAD_INPUT
