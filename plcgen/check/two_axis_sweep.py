"""Many moves one after another on one CPU, looked at for nothing but their pulses."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from plcgen.check.two_axis_rig import SCAN_US, SECOND, SETTLED, Subject, Table
from plcgen.plc.cpu.pto import Channel

MANY = 1_000_000
"""Scans, more than any move takes."""


@dataclass(frozen=True)
class Order:
    """What is ordered, and what has to be sent: components too short to count are left out. Pulses of x and y."""

    ordered: tuple[int, int]
    due: tuple[int, int]

    def __str__(self) -> str:
        return f"({self.ordered[0]}, {self.ordered[1]})"


@dataclass(frozen=True)
class Sweep:
    """Moves, those refused among them, pulses sent, pulses lost or too many, events, and the first that went wrong."""

    moves: int = 0
    refused: int = 0
    pulses: int = 0
    lost: int = 0
    events: int = 0
    finding: str = ""

    def __add__(self, other: Sweep) -> Sweep:
        return Sweep(
            self.moves + other.moves,
            self.refused + other.refused,
            self.pulses + other.pulses,
            self.lost + other.lost,
            self.events + other.events,
            self.finding or other.finding,
        )

    @property
    def ok(self) -> bool:
        return not self.lost and not self.events and not self.finding


def sweep(subject: Subject, orders: Iterable[Order]) -> Sweep:
    """Run the orders on a fresh CPU; the next one comes when the last has ended."""
    table = Table(subject, scan_us=max(SCAN_US, round(subject.model.sample_period * SECOND)))
    return sum((_sent(table, order) for order in orders), Sweep())


def _sent(table: Table, order: Order) -> Sweep:
    channels = [table.cpu.channels[output] for output in table.model.outputs]
    before = len(table.cpu.violations) + len(table.cpu.faults)
    for channel in channels:
        channel.forget()
    table.order(*order.ordered)
    table.press(0)
    while table.get("busy"):
        table.scans(MANY)
    for _ in range(SETTLED):
        table.cpu.scan()
    refused = bool(table.get("refused"))
    due = (0, 0) if refused else order.due
    sent = tuple(map(_pulses, channels))
    lost = sum(abs(wanted - counted) for wanted, counted in zip(due, sent, strict=True))
    events = [*map(str, table.cpu.violations), *map(str, table.cpu.faults)][before:]
    return Sweep(1, int(refused), sum(map(abs, sent)), lost, len(events), _finding(order, sent, lost, events))


def _pulses(channel: Channel) -> int:
    return sum(-segment.sent if segment.direction else segment.sent for segment in channel.segments)


def _finding(order: Order, sent: tuple[int, ...], lost: int, events: list[str]) -> str:
    said = [f"{order} sent {sent[0]}, {sent[1]}"] if lost else []
    return "; ".join([*said, *(f"{order}: {event}" for event in events[:1])])
