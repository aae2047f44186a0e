"""What the block must answer, in words: documented codes, and how an answer that differs is told."""

from __future__ import annotations

from plcgen.check.hoist_bench import Bench
from plcgen.check.rig import Rig, Snapshot
from plcgen.check.verdict import Check

AT_THE_STOP, AT_REST, FIRST_SCAN, IN_PROGRESS, COMING_TO_REST = 0x0000, 0x7000, 0x7001, 0x7002, 0x7003
ERROR_TRAVEL, ERROR_VELOCITY, ERROR_CYCLE_TIME, ERROR_STOPS, ERROR_JUMP = range(0x8201, 0x8206)
TRIPPED = 0x8401
# Limits are probed on themselves and half a percent to the side where the answer changes.
PROBE = 0.005
# Of the creep speed: below it the hoist counts as at rest when the CPU restarts.
REST_SHARE = 0.01


def differs(rig: Rig, situation: str, **wanted: float) -> str:
    """Empty, or what came out instead."""
    for name, value in wanted.items():
        if rig.get(name) != value:
            return f"{situation}: {name} = {rig.get(name):g}, not {value:g}"
    return ""


def wrong(name: str, answers: list[str]) -> Check:
    """The number of wrong answers, and their words."""
    told = [answer for answer in answers if answer]
    return Check(name, float(len(told)), 0.0, "1", detail="; ".join(told))


def standing(bench: Bench, travel: float) -> tuple[Rig, Snapshot]:
    """A hoist that has stood at a place for two scans, facing up."""
    rig = bench.rig(travel)
    rig.set(directionUp=True)
    rig.run(2)
    return rig, rig.snapshot()


def press_reset(rig: Rig) -> None:
    rig.set(reset=True)
    rig.scan()
    rig.set(reset=False)


def press_enable(rig: Rig) -> None:
    """A fresh rising edge; enable stays."""
    rig.set(enable=False)
    rig.scan()
    rig.set(enable=True)
    rig.scan()
