"""Completion in shells: what Click does for bash, zsh and fish, and the same for PowerShell."""

from __future__ import annotations

import os
from collections.abc import Iterable

import click
from click.shell_completion import CompletionItem, ShellComplete, add_completion_class, get_completion_class

from plcgen.errors import PlcgenError
from plcgen.names import nearest, one_of

PROGRAM, VARIABLE = "plcgen", "_PLCGEN_COMPLETE"
SHELLS = ("bash", "zsh", "fish", "powershell")


@add_completion_class
class PowerShell(ShellComplete):
    """The words before the cursor come in two environment variables; each answer is a line of its own."""

    name = "powershell"
    source_template = """\
Register-ArgumentCompleter -Native -CommandName %(prog_name)s -ScriptBlock {
    param($word, $line, $cursor)
    $env:PLCGEN_WORDS = $line.ToString(); $env:PLCGEN_WORD = $word; $env:%(complete_var)s = "powershell_complete"
    & %(prog_name)s | ForEach-Object { [System.Management.Automation.CompletionResult]::new($_) }
    Remove-Item Env:PLCGEN_WORDS, Env:PLCGEN_WORD, Env:%(complete_var)s
}
"""

    def get_completion_args(self) -> tuple[list[str], str]:
        """Complete words after the name of the program, and the one that is being written."""
        words, word = os.environ["PLCGEN_WORDS"].split()[1:], os.environ.get("PLCGEN_WORD", "")
        return (words[:-1] if word and words and words[-1] == word else words), word

    def format_completion(self, item: CompletionItem) -> str:
        return str(item.value)


def script(command: click.Command, shell: str) -> str:
    """What to add to the start-up file of a shell. Raises PlcgenError for an unknown one."""
    if shell not in SHELLS:
        near = nearest(shell, SHELLS)
        raise PlcgenError(f'unknown shell "{shell}"; write {one_of([near] if near else SHELLS)}')
    found = get_completion_class(shell)
    assert found is not None
    text = found.source_template % found(command, {}, PROGRAM, VARIABLE).source_vars()
    return text if text.endswith("\n") else text + "\n"


def methods(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    from plcgen.jobfile import METHODS

    return _beginning(METHODS, begun)


def targets(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    from plcgen.targets import TARGETS

    return _beginning(TARGETS, begun)


def shells(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    return _beginning(SHELLS, begun)


def _beginning(words: Iterable[str], begun: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(begun)]
