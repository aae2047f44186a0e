"""The hoist in STL, executed by awlsim, does bit for bit what the SCL does in our machine: outputs and statics."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable, Mapping
from functools import cache
from types import MappingProxyType

import numpy as np
import pytest

from plcgen.check.hoist_bench import RESTING, full_trip, interrupted_trip, reached, stop_places, turning_trip
from plcgen.check.hoist_model import ACCELERATE, CREEP_IN, DECELERATE, FULL_SPEED, START_RAMP, STOP_RAMP
from plcgen.check.rig import Clock, Encoder, Rig, Snapshot
from plcgen.job import parse_job
from plcgen.plan import Files
from plcgen.plan_hoist import HoistPlan
from plcgen.profile.hoist_constants import hoist_constants
from plcgen.targets import TARGETS
from tests.check.awlsim_rig import COMMANDS, INPUTS, AwlsimBlock, TwinBench, TwinError

pytest.importorskip("awlsim", reason="awlsim is the oracle of this test: pip install awlsim")

SCL, STL = "s7-300-scl", "s7-300-stl"
# Six seconds from stop to stop, through every phase.
QUICK = """
name = "Quick"
method = "hoist"
targets = ["s7-300-scl", "s7-300-stl"]
mnemonics = "english"
length_unit = "m"
sample_period = 0.010

[hoist]
travel = 6.0
max_velocity = 2.0
acceleration = 1.5
deceleration = 1.2
jerk = 5.0
creep_velocity = 0.3
creep_acceleration = 0.9
creep_out = 0.1
creep_in = 0.15
"""
# An envelope that clamps: nothing above the planned speed, and a brake that hardly brakes. No job may ask for that.
TIGHT = {
    "OVERSPEED_VELOCITY": 1.5,
    "TRACKING_FACTOR": 1.0,
    "TRACKING_MARGIN": 0.0,
    "BRAKE_DECELERATION": 0.3,
    "SAFE_SQUARE": 0.25,
    "REACTION_VELOCITY": 0.0,
}
NAN, INFINITY = math.nan, math.inf


@cache
def plan(mnemonics: str = "english") -> HoistPlan:
    return HoistPlan.of(parse_job(QUICK.replace("english", mnemonics), "quick.toml"))


def sources(target: str, constants: Mapping[str, float] = MappingProxyType({}), mnemonics: str = "english") -> Files:
    """Sources by name, with other constants than those of the job."""
    files = dict(plan(mnemonics).sources(target))
    main = f"Quick{TARGETS[target].suffix}"
    text = files[main].decode("ascii")
    for name, value in constants.items():
        text, count = re.subn(rf"({name} +(?:: REAL )?:= )[^;]+;", rf"\g<1>{value};", text)
        assert count == (2 if target == STL else 1)
    return files | {main: text.encode("ascii")}


def stl(constants: Mapping[str, float] = MappingProxyType({}), mnemonics: str = "english") -> str:
    return sources(STL, constants, mnemonics)["Quick.awl"].decode("ascii")


def real(value: float) -> bytes:
    return struct.pack(">f", value)


def bench(text: str = "", constants: Mapping[str, float] = MappingProxyType({}), german: bool = False) -> TwinBench:
    """The SCL of the job, beside its STL or another text."""
    subject = plan().subject(SCL, sources(SCL, constants))
    parts = (subject.program, subject.block, subject.instance, subject.model)
    text = text or stl(constants)
    return TwinBench(*parts, twin=lambda: AwlsimBlock([text], 100, 100, german))


def started() -> Rig:
    """The first scan of a trip upwards."""
    rig = bench().rig(0.0)
    rig.set(directionUp=True)
    rig.scan()
    rig.set(enable=True)
    rig.scan()
    return rig


@cache
def moments() -> tuple[Rig, dict[int, Snapshot]]:
    """A rig, and the scan after the first of each phase of its trip."""
    rig = started()
    found = {}
    for phase in range(START_RAMP, STOP_RAMP + 1):
        assert rig.run(600, reached(phase))
        rig.scan()
        found[phase] = rig.snapshot()
    return rig, found


def at(phase: int) -> Rig:
    rig, found = moments()
    rig.restore(found[phase])
    return rig


@cache
def resting() -> tuple[Rig, Snapshot]:
    rig = bench().rig(3.0)
    return rig, rig.snapshot()


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
def test_full_trip(up: bool) -> None:
    run = full_trip(bench(), "full trip", up)
    assert run.complete
    assert set(run.trace["phase"]) == set(range(STOP_RAMP + 1))


def test_setpoint_above_the_envelope() -> None:
    rig = bench(constants=TIGHT).rig(0.0)
    rig.set(directionUp=True)
    rig.scan()
    rig.set(enable=True)
    rig.run(400)
    trace = rig.trace()
    assert np.count_nonzero(trace["velocitySetpoint"] > trace["limitedSetpoint"]) > 10


def test_stop_and_resume_in_every_phase() -> None:
    assert interrupted_trip(bench(), "stops", up=True, places=stop_places(bench().model)).complete


def test_turn_in_mid_shaft() -> None:
    assert turning_trip(bench(), "turn").complete


@pytest.mark.parametrize("distance", [0.005, 0.02, 0.2, 0.5, 2.0])
def test_short_trip(distance: float) -> None:
    full_trip(bench(), "short", up=False, distance=distance)


def test_encoder_and_clock_of_the_plant() -> None:
    assert full_trip(bench(), "steps", True, Encoder(0.001, 1), Clock(0.012, 0.1), (-1.0, 5.0)).complete


def test_german_mnemonics() -> None:
    german = bench(stl(mnemonics="german"), german=True)
    assert full_trip(german, "german", up=True, distance=1.0).complete


FAULTY = [
    *({"actualTravel": value} for value in (NAN, INFINITY, -1.0, 7.0, 3.0)),
    *({"actualVelocity": value} for value in (NAN, INFINITY, -1e6, 2.5)),
    *({"cycleTime": value} for value in (NAN, 0.0, -0.01, 1.0)),
    *({"lowerStop": value} for value in (NAN, -INFINITY, 5.9)),
    *({"upperStop": value} for value in (NAN, INFINITY, -1.0)),
]


@pytest.mark.parametrize("faulty", FAULTY, ids=str)
def test_faulty_input_at_full_speed(faulty: dict[str, float]) -> None:
    """The stop, the acknowledgement on the way, which comes too early, and the one at rest; then a fresh start."""
    rig = at(FULL_SPEED)
    before = {name: rig.get(name) for name in faulty}
    rig.force(**{name: value for name, value in faulty.items() if name.startswith("actual")})
    rig.set(**faulty)
    rig.run(2)
    assert rig.get("error") or rig.get("overspeedTrip")
    rig.release()
    rig.set(**before, reset=True)
    rig.run(2)
    rig.set(enable=False, reset=False)
    assert rig.run(400, RESTING)
    assert rig.get("error") or rig.get("overspeedTrip")
    rig.set(reset=True)
    rig.run(2)
    assert not rig.get("error")
    rig.set(enable=True)
    rig.run(20)
    assert rig.get("busy")


@pytest.mark.parametrize("faulty", FAULTY, ids=str)
def test_faulty_input_at_rest(faulty: dict[str, float]) -> None:
    rig, moment = resting()
    rig.restore(moment)
    rig.force(**{name: value for name, value in faulty.items() if name.startswith("actual")})
    rig.set(**faulty, enable=True)
    rig.run(2)
    rig.set(restart=True)
    rig.run(2)


@pytest.mark.parametrize("velocity", [0.0, 1e-4, 0.4, -1.7, NAN])
def test_restart(velocity: float) -> None:
    """With what is held through it, then without, and a fresh start."""
    rig = at(FULL_SPEED)
    rig.force(actualVelocity=velocity)
    rig.set(restart=True, reset=True)
    rig.run(2)
    rig.release()
    rig.set(restart=False)
    rig.run(30)
    rig.set(enable=False, reset=False)
    rig.run(300, RESTING)
    rig.set(enable=True, directionUp=False)
    rig.run(20)


@pytest.mark.parametrize("phase", range(1, STOP_RAMP + 1))
def test_restart_of_a_moving_hoist(phase: int) -> None:
    rig = at(phase)
    rig.set(restart=True)
    rig.scan()
    rig.set(restart=False)
    rig.run(20)


def scan_until(rig: Rig, condition: Callable[[], bool]) -> None:
    for _ in range(600):
        rig.scan()
        if condition():
            return
    pytest.fail("600 scans were not enough")


def test_stop_while_braking_hard() -> None:
    """A stop request at the highest deceleration: the first phase of the ramp is over before it begins."""
    rig = at(DECELERATE)
    scan_until(rig, lambda: rig.get("acceleration") <= -1.19)
    rig.set(stop=True)
    assert rig.run(300, RESTING)


def test_late_stop_ramp() -> None:
    """The travel leaps towards the stop, by less than a jump: the arrears of the stop ramp are limited."""
    rig = at(CREEP_IN)
    scan_until(rig, lambda: rig.get("distanceToGo") < rig.get("statStopTravel") + 0.004)
    rig.plant.travel += 0.008
    rig.run(60)
    assert not rig.get("error")


@pytest.mark.parametrize(
    ("phase", "statics"),
    [
        (DECELERATE, {"statAcceleration": -3.0}),  # steeper than a ramp may be
        (ACCELERATE, {"statCruise": 0.1}),  # below creep speed
        (FULL_SPEED, {"statPhase": 9}),
        (FULL_SPEED, {"statCruise": NAN}),
        (STOP_RAMP, {"statRampTime1": NAN}),
        (ACCELERATE, {"statAccTravel": NAN}),
    ],
)
def test_statics_that_no_trip_brings(phase: int, statics: dict[str, float]) -> None:
    """Branches that need luck in rounding, or somebody who writes into the data block."""
    for stop in (False, True):
        rig = at(phase)
        rig.set(**statics, stop=stop)
        rig.restore(rig.snapshot())  # hands the statics to the STL
        rig.run(20)


def test_commands_in_any_order() -> None:
    random = np.random.default_rng(1)
    for constants in ({}, TIGHT):
        rig = bench(constants=constants).rig(2.0)
        for _ in range(60):
            name = str(random.choice(COMMANDS))
            rig.set(**{name: bool(random.integers(2))})
            rig.set(enable=bool(random.integers(4)), restart=bool(random.integers(8) == 0))
            rig.run(int(random.integers(1, 25)))


def test_data_block_gives_every_value() -> None:
    """awlsim leaves zero what BEGIN does not give; the rig has compared the variables that SCL knows as well."""
    block = AwlsimBlock([stl()], 100, 100)
    constants = [constant for group in hoist_constants(plan().job, plan().trip) for constant in group.constants]
    assert {name for name in block.names if name.isupper()} == {constant.name for constant in constants}
    for constant in constants:
        assert block.read(constant.name) == real(constant.value), constant.name


def test_no_instruction_writes_a_constant() -> None:
    written = set(re.findall(r"^(?:\w+:)? +(?:T|=|S|R) +#(\w+)", stl(), re.MULTILINE))
    written |= set(re.findall(r"RET_VAL +:= #(\w+)", stl()))
    assert {name for name in written if name.isupper()} == {"RET_VAL"}
    assert written & INPUTS == set()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("      L     #tempDecNominal;\r\n", "      L     #tempNominal;\r\n"),
        ("SQRT  ;                       // result", "ABS   ;                       // result"),
        ("L     6.000000e+000;", "L     6.000001e+000;"),
        ("L     3;                      // steps", "L     1;                      // steps"),
        ("L     25;                     // steps", "L     20;                     // steps"),
    ],
)
def test_slip_of_the_finger_is_seen(right: str, wrong: str) -> None:
    assert right in stl()
    with pytest.raises(TwinError, match="in SCL and"):
        full_trip(bench(stl().replace(right, wrong)), "slip", up=True, distance=3.0)


def test_example_calls_the_block() -> None:
    """awlsim runs OB 100 at the start."""
    example = sources(STL)["Quick_example.awl"].decode("ascii")
    block = AwlsimBlock([stl(), example], 100, 100)
    assert (block.read("statReady"), block.read("restart")) == (b"\1", b"\1")
    block.interrupt(35)
    assert (block.read("statReady"), block.read("restart")) == (b"\1", b"\0")
    assert block.read("cycleTime") == real(0.01)
