"""Verification of a two-axis table: the program runs with its pulse outputs, and every pulse is accounted for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import pairwise
from random import Random

import numpy as np

from plcgen.check.two_axis_model import MoveModel, Samples, TwoAxisModel
from plcgen.check.two_axis_motion import (
    lead_and_follow,
    limits,
    move_checks,
    off_the_line,
    position_bound,
    pulses,
    stop_frequencies,
    ticks,
)
from plcgen.check.two_axis_rig import RETAINED, SCAN_US, SECOND, Subject, Table
from plcgen.check.verdict import Check, TargetVerdict, nearer
from plcgen.trajectory import Trajectory

JITTER_US, COMMUNICATION_US = 1000, 2000
LARGEST_SHARE, LONGEST_SCAN = 0.5, 0.010


def verify_two_axis(
    subject: Subject, progress: Callable[[str], None] | None = None, fail_fast: bool = False
) -> TargetVerdict:
    """All checks, each with the figure that comes nearest to its bound and the names of the moves that miss it.

    With `fail_fast` it ends after the first situation in which a check fails.
    """
    worst: dict[str, Check] = {}
    for checks in _situations(subject, progress or (lambda _text: None)):
        for check in checks:
            worst[check.name] = nearer(worst[check.name], check) if check.name in worst else check
        if fail_fast and not all(check.ok for check in worst.values()):
            break
    return TargetVerdict(tuple(worst.values()))


def nominal_trace(subject: Subject) -> Trajectory:
    """The moves of the job one after another: pulses sent at each sample, and the frequencies of the next train."""
    table = Table(subject)
    rows: list[tuple[float, ...]] = []
    for number, move in enumerate(subject.model.moves):
        ride = table.run(move, "")
        times = ticks(subject.model, ride)
        x, y = table.positions(times)
        rows += [(number, k, int(px), int(py)) for k, (px, py) in enumerate(zip(x, y, strict=True))]
    columns = np.array(rows, dtype=np.int64)
    return Trajectory({name: columns[:, index] for index, name in enumerate(("move", "sample", "x", "y"))})


def _situations(subject: Subject, progress: Callable[[str], None]) -> Iterator[Iterable[Check]]:
    model = subject.model
    table = Table(subject, timed=True)
    for number, move in enumerate(model.moves, start=1):
        name = f"move {number} ({move.x}, {move.y})"
        progress(name)
        ride = table.run(move, name)
        yield _named(name, move_checks(table, ride))
    yield _named(
        "all moves",
        [
            Check("violations", float(len(table.cpu.violations)), 0.0, "1"),
            Check("arithmetic_events", float(len(table.cpu.faults)), 0.0, "1"),
        ],
    )
    move = max(model.moves, key=lambda move: move.samples)
    if not model.is_table:
        progress("late interrupts")
        yield from _late(subject)
        yield _named("an interrupt that comes far too late", _overrun(subject, move))
        progress("stops")
        yield from _stops(subject, move)
    yield _named("emergency stop", _killed(subject, move))
    yield [_run_time(model, table)]
    yield [Check("wrong_answers", *_answers(subject))]


def _run_time(model: TwoAxisModel, table: Table) -> Check:
    """Estimated worst run time: of the interrupt as a share of a sample, or of a scan that builds a table, in s.

    Half of each is left to the rest of the program.
    """
    times = table.cpu.run_times
    if model.is_table:
        return Check("scan_time", times["OB1"] / SECOND, LONGEST_SCAN, "s")
    interrupt = max(time for name, time in times.items() if name.startswith("INT"))
    return Check("interrupt_share", interrupt / SECOND / model.sample_period, LARGEST_SHARE, "1")


def _named(name: str, checks: Iterable[Check]) -> list[Check]:
    return [check if check.ok else replace(check, detail=check.detail or name) for check in checks]


# ------------------------------------------------------------------------------------------------------------ late


def _late(subject: Subject) -> Iterator[Iterable[Check]]:
    """Interrupts up to 1 ms late, and 2 ms of communication at every tenth tick on top: no pulse may be lost."""
    model = subject.model
    random = Random(1)
    period = round(model.sample_period * SECOND)
    for number, move in enumerate(model.moves, start=1):
        start = 3 * SCAN_US
        blocked = [
            (start + k * period - 1, start + k * period + COMMUNICATION_US) for k in range(0, move.samples + 9, 10)
        ]
        table = Table(subject, lambda _tick: random.randrange(JITTER_US), blocked)
        ride = table.run(move, f"move {number}, late interrupts")
        checks = list(pulses(table, ride))
        checks.append(Check("violations", float(len(table.cpu.violations)), 0.0, "1"))
        # What the trains leave of a sample may be less than a communication interrupt takes.
        if (1 - model.train_share) * period > JITTER_US + COMMUNICATION_US:
            checks.append(Check("overruns", float(table.get("overrun")), 0.0, "1"))
        yield _named(ride.name, checks)


def _overrun(subject: Subject, move: MoveModel) -> Iterator[Check]:
    """One interrupt so late that its train still runs at the next: that is told, and the train left alone."""
    model = subject.model
    if move.samples < 8:
        return
    period = model.sample_period * SECOND
    late = iter([0] * (move.samples // 2) + [round((1.5 - model.train_share) * period)])
    table = Table(subject, lambda _tick: next(late, 0))
    ride = table.run(move, "an interrupt that comes far too late")
    yield from pulses(table, ride)
    yield Check("overruns_not_told", float(not table.get("overrun")), 0.0, "1")
    yield from pulses(table, table.run(move, ""))
    yield Check("overruns", float(table.get("overrun")), 0.0, "1")
    yield Check("violations", float(len(table.cpu.violations)), 0.0, "1")


# ----------------------------------------------------------------------------------------------------------- stops


def _stops(subject: Subject, move: MoveModel) -> Iterator[Iterable[Check]]:
    """A stop in each phase of the longest move and near its ends: within the limits, on the path, every pulse told."""
    table = Table(subject)
    table.press(1)
    yield _named("start after a stop at rest", pulses(table, table.run(move, "")))
    middles = [(begin + end) / 2 for begin, end in pairwise(move.corners) if end > begin]
    for share in sorted({0.02, *middles, 0.98}):
        yield _named(f"stop at {share:.0%}", _stopped(subject, move, share))
    others = [other for other in subject.model.moves if other.x_leads != move.x_leads]
    for other in sorted(others, key=lambda other: other.samples)[-1:]:
        yield _named(f"stop in ({other.x}, {other.y})", _stopped(subject, other, 0.4))


def _stopped(subject: Subject, move: MoveModel, share: float) -> Iterator[Check]:
    model, table = subject.model, Table(subject)
    ride = table.run(move, "", until=share * move.samples * model.sample_period)
    pressed = table.cpu.time_us
    table.press(1)
    early = False
    scans = round(2 * move.samples * model.sample_period * SECOND / SCAN_US) + 100
    for _ in range(scans):
        if not table.get("busy"):
            break
        early |= bool(table.get("stopped") or table.get("done"))
        table.cpu.scan()
    x, y = table.now()
    counted = abs(x - ride.before[0]) - table.get("done_x"), abs(y - ride.before[1]) - table.get("done_y")
    yield Check("uncounted_pulses", float(max(map(abs, counted))), 0.0, "1")
    yield Check("wrong_flags", float(early), 0.0, "1")
    lasts, comes_to_rest = _expected_stop(model, move, (pressed - ride.first_tick) / SECOND)
    ended = not table.get("busy") and (table.get("stopped") or (table.get("done") and not comes_to_rest))
    yield Check("stops_not_ended", float(not ended), 0.0, "1")
    # It begins at the next tick, ends in a whole sample, is over at the tick behind, and MAIN sees it a scan later.
    yield Check("stop_time", (table.cpu.time_us - pressed) / SECOND - lasts, 3 * model.sample_period + 0.01, "s")
    period = round(model.sample_period * SECOND)
    times = np.arange(ride.first_tick, table.cpu.time_us + period, period)
    lead, follow = lead_and_follow(table, ride, times)
    yield Check("path_deviation", off_the_line(move, lead, follow), 3.0, "1")
    if table.get("stopped"):
        yield Check("stop_deviation", _off_the_stop(model, move, lead), position_bound(move) + 0.5, "1")
    yield stop_frequencies(table, ride, lead)
    yield from limits(move, model.sample_period, lead, orders=3)
    if share < 0.5:
        yield from pulses(table, table.run(move, ""))
    yield Check("violations", float(len(table.cpu.violations)), 0.0, "1")


def _expected_stop(model: TwoAxisModel, move: MoveModel, at: float) -> tuple[float, bool]:
    """How long a stop takes at most that is asked for at this time, in s; whether it comes to rest before the end of
    the move, whichever of the next two samples it begins at.
    """
    begins = np.minimum(at + np.arange(3) * model.sample_period, move.samples * model.sample_period)
    exact, speed, acceleration = move.motion(begins)
    states = [(max(0.0, float(v)), float(a)) for v, a in zip(speed, acceleration, strict=True)]
    laws = [move.stop(*state) for state in states]
    rests = [place + law.travel < move.lead_pulses - 1 for place, law in zip(exact, laws, strict=True)]
    return max(law.duration for law in laws), all(rests)


def _off_the_stop(model: TwoAxisModel, move: MoveModel, lead: Samples) -> float:
    """Pulses that the samples of a stop are off the law from the state in which it began; the sample it began at is the
    one that fits best, and the stop begins at a rounded position.
    """
    period, worst = model.sample_period, np.inf
    exact, speed, acceleration = move.motion(np.arange(move.samples + 1) * period)
    last = min(len(lead), move.samples)
    parted = np.flatnonzero(np.abs(lead[1:last] - exact[1:last]) > position_bound(move))
    for begin in range(int(parted[0]) if len(parted) else last - 1, 0, -1):
        law = move.stop(float(speed[begin]), float(acceleration[begin]))
        times = np.arange(len(lead) - begin) * period
        # An earlier stop ends no farther off, give or take where it begins: none of those left fits better than this.
        rest = min(lead[begin] + law.travel, move.lead_pulses)
        if times[-1] >= law.duration and lead[-1] - rest >= worst + 2 * position_bound(move):
            break
        stop = np.minimum(lead[begin] + law.at_time(times).travel, move.lead_pulses)
        worst = min(worst, float(np.abs(lead[begin:] - stop).max()))
    return float(worst)


def _killed(subject: Subject, move: MoveModel) -> Iterator[Check]:
    model, table = subject.model, Table(subject)
    table.run(move, "", until=0.4 * move.samples * model.sample_period)
    if not table.get("busy"):
        return  # shorter than what it takes to press the button
    table.press(2)
    at_once = table.now()
    for _ in range(round(3 * model.sample_period * SECOND / SCAN_US)):
        table.cpu.scan()
    moved = max(abs(a - b) for a, b in zip(table.now(), at_once, strict=True))
    yield Check("pulses_after_emergency", float(moved), 0.0, "1")
    wrong = table.get("busy") or not table.get("killed") or table.get("done")
    yield Check("stops_not_ended", float(bool(wrong)), 0.0, "1")
    yield from pulses(table, table.run(move, ""))


# --------------------------------------------------------------------------------------------------------- answers


def _answers(subject: Subject) -> tuple[float, float, str, bool, str]:
    """Starts that must be refused, each with its code and without a pulse."""
    model = subject.model
    told = [answer for answer in _refusals(subject, model) if answer]
    return float(len(told)), 0.0, "1", False, "; ".join(told)


def _refusals(subject: Subject, model: TwoAxisModel) -> Iterator[str]:
    table, fresh = Table(subject, retained=85), Table(subject)
    if any(table.get(name) != fresh.get(name) for name in RETAINED):
        yield "order or status is kept over a loss of power"
    for name, order, code in (
        ("no distance", (0, 0), 4),
        ("lowest DINT", (-(2**31), 5), 3),
        ("lowest DINT in y", (5, -(2**31)), 3),
        *model.refused,
    ):
        table = Table(subject)
        table.order(*order)
        table.press(0)
        yield _refused(table, name, code)
        again = table.run(model.moves[0], "")
        yield "" if all(check.ok for check in pulses(table, again)) else f"{name}: no move can be started after it"
    move = max(model.moves, key=lambda move: move.samples)
    table = Table(subject)
    table.order(move.x, move.y)
    table.press(0)
    table.cpu.scan()
    table.press(0)
    yield "" if table.get("error") == 2 and table.get("refused") else "start while busy is not refused with 2"
    table = Table(subject)
    table.cpu.variable(model.addresses["ready"]).set(False)
    table.order(move.x, move.y)
    table.press(0)
    yield _refused(table, "parameters that were found wrong", 1)


def _refused(table: Table, name: str, code: int) -> str:
    for _ in range(50):
        table.cpu.scan()
    if table.get("error") != code or not table.get("refused") or table.get("busy"):
        return f"{name}: ErrorCode = {table.get('error')}, not {code}"
    return f"{name}: pulses were sent" if any(table.now()) else ""
