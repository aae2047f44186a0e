"""Text that every console survives, tables with and without a terminal."""

from __future__ import annotations

import io
import os
import sys
from subprocess import run

import pytest

from plcgen import terminal
from plcgen.terminal import Table

TABLE = Table("Limits", ("name", ">value", "result"), [("speed", "12.5", "ok"), ("a", "3", "FAILED")])


class Stream(io.TextIOWrapper):
    """A console of one code page."""

    def __init__(self, encoding: str, terminal: bool) -> None:
        super().__init__(io.BytesIO(), encoding, newline="\n")
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal

    def shown(self) -> str:
        self.seek(0)
        return self.read()


@pytest.fixture
def plain(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing in the environment that would make rich believe in another terminal."""
    for name in ("FORCE_COLOR", "NO_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE", "COLUMNS"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")


def console(monkeypatch: pytest.MonkeyPatch, encoding: str, terminal: bool = False) -> Stream:
    stream = Stream(encoding, terminal)
    monkeypatch.setattr(sys, "stdout", stream)
    monkeypatch.setattr(sys, "stderr", stream)
    return stream


def test_aligned_table() -> None:
    assert terminal.aligned(TABLE) == ("Limits\n  name   value  result\n  speed   12.5  ok\n  a          3  FAILED\n")


def test_empty_table_has_its_headings() -> None:
    assert terminal.aligned(Table("T", ("a", ">b"), [])) == "T\n  a  b\n"


def test_table_in_a_pipe_is_plain(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = console(monkeypatch, "utf-8")
    terminal.show(TABLE)
    assert stream.shown() == terminal.aligned(TABLE) + "\n"


HEAVY = "\u250f\u250c" if os.name == "nt" else "\u250f"
"""An old console of Windows has thinner lines."""


@pytest.mark.usefixtures("plain")
@pytest.mark.parametrize(("encoding", "corners"), [("utf-8", HEAVY), ("gbk", "+"), ("cp1252", "+")])
def test_table_on_a_terminal_is_drawn(monkeypatch: pytest.MonkeyPatch, encoding: str, corners: str) -> None:
    stream = console(monkeypatch, encoding, terminal=True)
    terminal.prepare_streams()
    terminal.show(TABLE)
    assert any(corner in stream.shown() for corner in corners)
    assert "\x1b[1;31mFAILED" in stream.shown()


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [("gbk", "?\u77ff\u4e95 ?"), ("cp1252", "\xf8?? ?"), ("ascii", "??? ?"), ("utf-8", "\xf8\u77ff\u4e95 \U0001f600")],
)
def test_console_that_lacks_a_character(monkeypatch: pytest.MonkeyPatch, encoding: str, shown: str) -> None:
    stream = console(monkeypatch, encoding)
    terminal.prepare_streams()
    terminal.say("\xf8\u77ff\u4e95 \U0001f600")
    assert stream.shown() == shown + "\n"


def test_half_of_a_surrogate_pair_from_a_file_name(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = console(monkeypatch, "utf-8")
    terminal.prepare_streams()
    terminal.tell("a\udce9b")
    assert stream.shown() == "a\ufffdb\n"


def test_control_characters_are_replaced_one_for_one() -> None:
    assert terminal.printable("a\x1b[2Jb\tc\nd\r\x07\x85\u202ee\u2028\ufeff") == (
        "a\ufffd[2Jb\tc\nd\ufffd\ufffd\ufffd\ufffde\ufffd\ufffd"
    )


@pytest.mark.usefixtures("plain")
def test_markup_of_rich_is_text(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = console(monkeypatch, "utf-8", terminal=True)
    terminal.show(Table("[red]T", ("a",), [("[bold]x",)]))
    assert "[red]T" in stream.shown()
    assert "[bold]x" in stream.shown()


def test_no_progress_in_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = console(monkeypatch, "utf-8")
    with terminal.progress() as progress:
        progress("scan 1")
    assert stream.shown() == ""


@pytest.mark.usefixtures("plain")
def test_progress_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = console(monkeypatch, "gbk", terminal=True)
    terminal.prepare_streams()
    with terminal.progress() as progress:
        progress("scan [1]")
    assert "scan [1]" in stream.shown()


@pytest.mark.parametrize("closed", ["stdout", "stderr"])
def test_a_stream_that_is_closed_takes_all(closed: str) -> None:
    """As in `plcgen schema >&-`."""
    code = f"import sys; sys.{closed} = None; from plcgen.cli import main; main(['schema'])"
    ended = run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr, bool(ended.stdout)) == (0, "", closed == "stderr")
