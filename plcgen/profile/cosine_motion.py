"""What the block of ramps should do, in float64: orders at samples of their own, ramp by ramp in closed form.

The speed of a sample is the polynomial of its law at that sample, and the average is a mean over a window of them: no
ring, no counts, no running sum.

N and M are rounded up, and an order in mid-ramp is weighed against a speed: where REAL may come out on either side,
the decision is open. `open_decisions` names those, `flipped` turns them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from math import ceil

import numpy as np
from numpy.typing import NDArray

from plcgen.profile.cosine import Ramps

Samples = NDArray[np.float64]

STEADY, RAMP, SETTLE = range(3)
# Relative error that REAL arithmetic may make of a duration or a change of speed: some twenty roundings of 2^-24.
OPEN = 2e-6
MOST_POSSIBLE = 64


@dataclass(frozen=True)
class Order:
    """What is asked for in a sample: another speed, to hold or to go on, to come to rest."""

    sample: int
    velocity: float | None = None
    hold: bool | None = None
    rest: bool = False


@dataclass(frozen=True)
class Motion:
    """Speed in each sample before and after the average, whether an order is in progress and held, whether the average
    has caught up, and which decisions were open. `start` is the steady speed until then, `done` marks the sample in
    which an order is.

    `changes` has |base| + |change| of the laws so far, what their rounding is proportional to.
    """

    start: float
    raw: Samples
    average: Samples
    law: NDArray[np.int64]
    active: NDArray[np.bool_]
    held: NDArray[np.bool_]
    steady: NDArray[np.bool_]
    done: NDArray[np.bool_]
    changes: Samples
    open_decisions: frozenset[int]


@dataclass
class _State:
    ramps: Ramps
    cycle: float
    velocity: float
    flipped: Collection[int]
    target: float = 0.0
    pending: bool = False
    active: bool = False
    held: bool = False
    done: bool = False
    behind: int = 0
    law: int = STEADY
    step: int = 0
    steps: int = 1
    base: float = 0.0
    change: float = 0.0
    end: float = 0.0
    decisions: int = 0
    rounding: float = 0.0
    open: set[int] = field(default_factory=set)

    def decide(self, value: float, bound: float) -> bool:
        """value <= bound, or the other way where that was open and is to be flipped."""
        number, self.decisions = self.decisions, self.decisions + 1
        if abs(value - bound) <= OPEN * max(abs(value), abs(bound)):
            self.open.add(number)
        return (value <= bound) != (number in self.flipped)

    def samples(self, ratio: float) -> int:
        """The next whole number, at least 1."""
        whole = max(1, round(ratio))
        if abs(ratio - whole) <= OPEN * whole:
            return whole if self.decide(ratio, whole) else whole + 1
        return max(1, ceil(ratio))

    def order(self, order: Order) -> None:
        if order.velocity is not None:
            self.target, self.pending, self.active = order.velocity, True, True
        if order.hold is not None:
            self.held = order.hold
        if order.rest:
            self.active = False
            self.pending = self.pending or self.target != 0.0
            self.target = 0.0

    @property
    def holds(self) -> bool:
        """Only an order in progress can be held."""
        return self.held and self.active

    def begin_law(self) -> None:
        """A new law where one is due."""
        if self.law == RAMP and self.pending and not self.holds and abs(self.target - self.end) < 1 / self.ramps.counts:
            self.end, self.pending = self.target, False
        if self.law == RAMP and (self.pending or self.holds):
            self._settle()
        elif self.law == STEADY and self.pending and not self.holds:
            self._ramp()

    def _ramp(self) -> None:
        change = self.target - self.velocity
        self.base, self.change = (self.target + self.velocity) / 2, change / 2
        self._begin(RAMP, self.samples(self.ramps.ramp_time(change) / self.cycle), self.target)
        self.pending = False

    def _settle(self) -> None:
        """The change of speed is weighed with a sample more than it takes, so that rounding M up is covered."""
        first = self.ramps.fit.coefficients[0]
        rate = 2 * self.change / self.steps * float(self.ramps.fit.repaired.deriv()(2 * self.step / self.steps - 1))
        ratio = abs(rate) * self.ramps.settle_time / self.cycle**2
        if not self.decide(abs(rate) / first * (ratio + 1), abs(self.end - self.velocity)):
            return
        samples = self.samples(ratio)
        self.base, self.change, self.pending = self.velocity, rate / first * samples, True
        self._begin(SETTLE, samples, self.base + self.change)

    def _begin(self, law: int, steps: int, end: float) -> None:
        self.law, self.step, self.steps, self.end = law, 0, steps, end
        self.rounding += abs(self.base) + abs(self.change)

    def advance(self) -> None:
        """One sample further."""
        if self.law == STEADY:
            self.behind = max(0, self.behind - 1)
        else:
            self._step()
        self.done = self.active and self.steady and not self.pending
        self.active = self.active and not self.done

    @property
    def steady(self) -> bool:
        """The average has caught up, and no ramp is about to begin."""
        return self.law == STEADY and self.behind == 0 and (self.holds or not self.pending)

    def _step(self) -> None:
        self.behind = self.ramps.filter_length - 1
        self.step += 1
        if self.step >= self.steps:
            self.velocity, self.law = self.end, STEADY
            return
        share = self.step / self.steps
        y = 2 * share - 1 if self.law == RAMP else share
        self.velocity = self.base + self.change * float(self.ramps.fit.repaired(y))


def follow(
    ramps: Ramps, velocity: float, orders: Sequence[Order], samples: int, flipped: Collection[int] = (),
    cycle: float | None = None,
) -> Motion:  # fmt: skip
    """From a steady speed through orders, for some samples."""
    state = _State(ramps, cycle or ramps.sample_period, velocity, flipped, target=velocity)
    by_sample: dict[int, list[Order]] = {}
    for order in orders:
        by_sample.setdefault(order.sample, []).append(order)
    rows = []
    for sample in range(samples):
        for order in by_sample.get(sample, ()):
            state.order(order)
        state.begin_law()
        held = state.holds
        state.advance()
        rows.append((state.velocity, state.law, state.active, held, state.steady, state.done, state.rounding))
    raw, law, active, held_rows, steady, done, changes = (np.array(column) for column in zip(*rows, strict=True))
    average = averaged(raw, velocity, ramps.filter_length)
    return Motion(velocity, raw, average, law, active, held_rows, steady, done, changes, frozenset(state.open))


def possible(
    ramps: Ramps, velocity: float, orders: Sequence[Order], samples: int, cycle: float | None = None
) -> Iterator[Motion]:
    """The motion, and those that come of open decisions taken the other way; the likely one first."""
    waiting: list[tuple[int, ...]] = [()]
    for flipped in islice(_growing(waiting), MOST_POSSIBLE):
        motion = follow(ramps, velocity, orders, samples, flipped, cycle)
        waiting += [(*flipped, number) for number in sorted(motion.open_decisions) if number > max(flipped, default=-1)]
        yield motion


def _growing(waiting: list[tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
    while waiting:
        yield waiting.pop(0)


def averaged(raw: Samples, before: float, length: int) -> Samples:
    """Mean of each sample and those before it; before the first one the speed was steady."""
    padded = np.concatenate([np.full(length - 1, before), raw])
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, length).mean(axis=1))
