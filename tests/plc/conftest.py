"""What tests of the S7-200 SMART share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

from plcgen.plc.cpu.smart import Smart
from plcgen.plc.source import SourceText
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from tests.every_engine import CHOICES, choose

HEADS = {"OB": "ORGANIZATION_BLOCK", "SB": "SUBROUTINE_BLOCK", "IN": "INTERRUPT_BLOCK"}


def smart_text(**bodies: str) -> str:
    """A file of blocks named OB1, SBR0, INT0 ...: a body is networks parted by a line of dashes, after declarations."""
    return "".join(_block(name, dedent(body).strip("\n")) for name, body in bodies.items())


def _block(name: str, body: str) -> str:
    word = HEADS[name[:2]]
    declarations, _, networks = body.rpartition("BEGIN\n")
    numbered = "".join(f"Network {n}\n{text.strip()}\n" for n, text in enumerate(networks.split("----"), 1))
    return f"{word} {name}:{name}\n{declarations}BEGIN\n{numbered}END_{word}\n"


@pytest.fixture(autouse=True, params=CHOICES)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> str:
    """Every program of these tests runs on every engine. Tests that compare them choose for themselves."""
    choose(request.param, monkeypatch, tmp_path)
    return str(request.param)


@pytest.fixture
def smart() -> Callable[..., Smart]:
    """smart({keywords of Smart}, OB1=..., SBR0=...): a machine with these blocks."""

    def make(options: dict[str, Any] | None = None, **bodies: str) -> Smart:
        return Smart(lower(parse(SourceText("f.awl", smart_text(**bodies)))), **(options or {}))

    return make
