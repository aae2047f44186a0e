"""Completion: the words of PowerShell, and scripts for every shell."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from plcgen.completion import SHELLS, VARIABLE
from tests.test_cli import plcgen


@pytest.mark.parametrize("shell", SHELLS)
def test_script_of_each_shell_names_program_and_variable(shell: str) -> None:
    result = plcgen("completion", shell)
    assert result.exit_code == 0
    assert "plcgen" in result.output
    assert VARIABLE in result.output


def test_an_unknown_shell_is_told_the_nearest() -> None:
    result = plcgen("completion", "bahs")
    assert result.exit_code == 2
    assert result.output == 'error: unknown shell "bahs"; write "bash"\n'
    assert 'write "bash", "zsh", "fish" or "powershell"' in plcgen("completion", "cmd.exe").output


def completed(words: str, word: str) -> list[str]:
    """What PowerShell is offered behind these words."""
    environment = {**os.environ, VARIABLE: "powershell_complete", "PLCGEN_WORDS": words, "PLCGEN_WORD": word}
    command = "from plcgen.cli import main; main(prog_name='plcgen')"
    run = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=False)
    return run.stdout.split()


def test_commands_methods_targets_and_options() -> None:
    assert completed("plcgen ver", "ver") == ["verify"]
    assert completed("plcgen new ", "") == ["hoist", "cosine", "two-axis"]
    assert completed("plcgen verify job.toml --target s7", "s7") == ["s7-300-scl", "s7-300-stl", "s7-200-smart"]
    assert completed("plcgen sweep --mo", "--mo") == ["--moves"]
