"""The S7-200 SMART program of the method `cosine` beside the SCL block: the same commands, every output bit by bit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from random import Random

import numpy as np
import pytest

from plcgen import pipeline
from plcgen.check.cosine_smart_rig import OUTPUTS, SmartAxis
from plcgen.job import Job, parse_job
from plcgen.lint_smart import smart_findings
from plcgen.loading import load
from plcgen.plan_cosine import CosinePlan
from plcgen.plc.core import Program
from plcgen.plc.cpu.smart import MAIN, Smart
from plcgen.plc.machine import Machine
from plcgen.plc.source import SourceText, decode_source
from plcgen.plc.stl import lowering, parser
from plcgen.plc.types import BOOL, REAL
from plcgen.profile.constants import ConstantGroup
from plcgen.profile.cosine_move import Moves
from plcgen.render.cosine_memory import layout, memory_map
from plcgen.render.cosine_smart import output_files

JOB = """
name = "Axis"
method = "cosine"
targets = ["s7-300-scl", "tia-scl", "s7-200-smart"]
length_unit = "m"
sample_period = 0.010

[cosine]
max_velocity = 2.0
max_acceleration = 1.5
jerk = {jerk}
filter_length = {length}
shape = "{shape}"
fit = "{fit}"
v_memory = {v_memory}
first_subroutine = 3
interrupt_routine = 2

[[cosine.moves]]
{move}
"""
CENTRED, HALF_SINE = "centred", "half-sine"
MOVES = {CENTRED: "from = 0.0\nto = 1.0", HALF_SINE: "distance = 1.0"}
NAN, INFINITE = float("nan"), float("inf")
Inputs = Mapping[str, float]
Timeline = Mapping[int, Inputs]


def job_of(shape: str, length: int, jerk: float = 5.0, fit: str = "minimax", v_memory: int = 1000) -> Job:
    text = JOB.format(shape=shape, length=length, jerk=jerk, fit=fit, v_memory=v_memory, move=MOVES[shape])
    return parse_job(text, "job.toml")


def groups(job: Job) -> tuple[ConstantGroup, ...]:
    plan = pipeline.prepare(job)
    assert isinstance(plan, CosinePlan)
    return plan.constants


# ------------------------------------------------------------------------------------------------------------ programs


def scl_program(job: Job, target: str = "s7-300-scl") -> Program:
    return load(target, pipeline.sources(pipeline.prepare(job), target))


def smart_files(job: Job) -> dict[str, bytes]:
    return pipeline.sources(pipeline.prepare(job), "s7-200-smart")


def sources(files: Mapping[str, bytes], names: Iterable[str]) -> list[SourceText]:
    return [decode_source(name, files[name]) for name in names]


def smart_program(job: Job) -> Program:
    files = smart_files(job)
    return lowering.lower(parser.parse(*sources(files, [f"{job.name}.awl"])), timed=True)


class SclAxis:
    """The SCL block with its instance, under the same names."""

    def __init__(self, program: Program, fb: str = "FB100", db: str = "DB100") -> None:
        self.machine = Machine(program)
        self.fb, self.db = fb, db
        self.columns: dict[str, list[float]] = {name: [] for name in OUTPUTS}
        self.outputs = {name: self.machine.variable(f'"{db}".{name}') for name in OUTPUTS}

    def set(self, **inputs: float) -> None:
        for name, value in inputs.items():
            self.machine.variable(f'"{self.db}".{name}').set(value)

    def scan(self) -> None:
        self.machine.call(self.fb, self.db)
        for name, variable in self.outputs.items():
            self.columns[name].append(variable.get())


@dataclass(frozen=True)
class Pair:
    """Both programs of a job."""

    scl: Program
    smart: Program
    job: Job

    @classmethod
    @cache
    def of(cls, shape: str, length: int, fit: str = "minimax", jerk: float = 5.0) -> Pair:
        job = job_of(shape, length, jerk, fit)
        return cls(scl_program(job), smart_program(job), job)

    def axis(self, retained: int = 0) -> SmartAxis:
        return SmartAxis(
            self.smart, memory_map(self.job), self.job.sample_period, self.job.cosine.shape, retained=retained
        )

    def compare(self, commands: Iterable[Inputs]) -> dict[str, np.ndarray]:
        """Run both; every output must be the same in every sample. Returns what they did."""
        scl, smart = SclAxis(self.scl), self.axis()
        for inputs in commands:
            scl.set(**inputs)
            smart.set(**inputs)
            scl.scan()
            smart.scan()
        trace = smart.trace()
        for name, values in scl.columns.items():
            wanted = np.array(values, dtype=trace[name].dtype)
            different = np.flatnonzero(wanted.view(np.uint8).reshape(len(wanted), -1)
                                       != trace[name].copy().view(np.uint8).reshape(len(wanted), -1))  # fmt: skip
            at = int(different[0]) // wanted.itemsize if len(different) else 0
            assert not len(different), f"{name} in sample {at}: {wanted[at]!r} in SCL, {trace[name][at]!r}"
        assert not smart.faults and not scl.machine.faults
        return dict(trace.columns)


# ------------------------------------------------------------------------------------------------------------ commands


SPEEDS = (0.0, -0.0, 2.0, -2.0, 0.3, -1.0)
NO_SPEEDS = (NAN, INFINITE, -INFINITE, 2.0000002, -3.0)
CYCLES = (0.01, 0.01, 0.02, 0.001, 0.1)
NO_CYCLES = (0.1001, 0.000999, 0.0, -1.0, NAN, INFINITE)


def ramp_episode(random: Random, last: float) -> Inputs:
    """One command of any kind, now and then nonsense. `last` is the speed that was ordered before."""
    pick = random.random()
    if pick < 0.40:
        near = last + random.choice((0.0, 3e-7, -5e-7, 1e-5))
        speed = random.choice((*SPEEDS, near, near, random.uniform(-2, 2), random.uniform(-0.01, 0.01)))
        return {"execute": True, "targetVelocity": speed, "cycleTime": random.choice(CYCLES)}
    if pick < 0.46:
        return {"execute": True, "targetVelocity": random.choice(NO_SPEEDS), "cycleTime": 0.01}
    if pick < 0.52:
        return {"execute": True, "targetVelocity": random.uniform(-2, 2), "cycleTime": random.choice(NO_CYCLES)}
    if pick < 0.58:
        return {"execute": False}
    if pick < 0.80:
        return {"hold": True}
    if pick < 0.90:
        return {"stop": True}
    speed = random.choice((*SPEEDS, *NO_SPEEDS, 1.3))
    return {"restart": True, "actualVelocity": speed, "execute": random.random() < 0.5}


def ramp_commands(random: Random, samples: int) -> Iterator[Inputs]:
    """Orders of every kind at any time."""
    sample, last = 0, 0.0
    while sample < samples:
        inputs = ramp_episode(random, last)
        last = inputs.get("targetVelocity", last)
        if "targetVelocity" in inputs and random.random() < 0.9:
            yield {"execute": False}
        wait = 900 if "stop" in inputs and random.random() < 0.2 else random.choice((1, 1, 2, 5, 20, 60, 90, 200))
        for _ in range(wait):
            yield inputs
            inputs = {"restart": False} if random.random() < 0.7 else {}
        yield {name: False for name in ("hold", "stop", "restart") if random.random() < 0.6}
        sample += wait


def move_commands(random: Random, samples: int) -> Iterator[Inputs]:
    """The same for moves; waits mostly until one is over, else stops it in either half."""
    sample = 0
    while sample < samples:
        length = random.choice((1e-7, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0)) * random.choice((-1, 1))
        if random.random() < 0.1:
            length = random.choice((0.0, -0.0, 1e-9, NAN, INFINITE, -1e9))
        cycle = random.choice(CYCLES if random.random() < 0.8 else NO_CYCLES)
        yield {"execute": True, "distance": length, "cycleTime": cycle, "stop": random.random() < 0.1}
        wait = random.choice((1, 3, 10, 40, 90, 150, 300, 600))
        for _ in range(wait):
            yield {}
        yield random.choice(({"stop": True}, {}, {"execute": False}, {"stop": True, "execute": False}))
        rest = random.choice((0, 0, 1, 30, 200, 500))
        for _ in range(rest):
            yield {}
        yield {"execute": random.random() < 0.3, "stop": False, "restart": random.random() < 0.2}
        yield {"restart": random.random() < 0.02, "execute": random.random() < 0.1}
        yield {"restart": False, "execute": False}
        pause = random.choice((0, 0, 100, 400))
        for _ in range(pause):
            yield {}
        sample += wait + rest + pause


def played(timeline: Timeline, samples: int) -> Iterator[Inputs]:
    return (timeline.get(sample, {}) for sample in range(samples))


# --------------------------------------------------------------------------------------------------------------- tests


@pytest.mark.parametrize("length", [1, 2, 16, 256])
def test_random_orders_of_speeds_are_bit_identical(length: int) -> None:
    pair, seen = Pair.of(CENTRED, length), set[int]()
    for seed in range(10):
        seen |= set(pair.compare(ramp_commands(Random(1000 * length + seed), 3000))["status"].tolist())
    assert seen == {0x0000, 0x7000, 0x7001, 0x7002, 0x7003, 0x7004, 0x7005, 0x8201, 0x8202, 0x8203}


@pytest.mark.parametrize("length", [2, 16, 256])
def test_random_moves_are_bit_identical(length: int) -> None:
    pair, seen = Pair.of(HALF_SINE, length), set[int]()
    for seed in range(10):
        seen |= set(pair.compare(move_commands(Random(1000 * length + seed), 3000))["status"].tolist())
    assert seen == {0x0000, 0x7000, 0x7001, 0x7002, 0x7003, 0x7005, 0x8201, 0x8202, 0x8203, 0x8204}


@pytest.mark.parametrize("fit", ["least-squares", "taylor"])
def test_other_fits_are_bit_identical(fit: str) -> None:
    Pair.of(CENTRED, 16, fit).compare(ramp_commands(Random(7), 1000))
    Pair.of(HALF_SINE, 16, fit).compare(move_commands(Random(7), 1000))


def test_hold_lets_the_acceleration_die_out_and_goes_on() -> None:
    timeline: Timeline = {5: {"execute": True, "targetVelocity": 2.0}, 80: {"hold": True}, 300: {"hold": False}}
    trace = Pair.of(CENTRED, 16).compare(played(timeline, 700))
    assert {0x7001, 0x7002, 0x7004, 0x0000} <= set(trace["status"].tolist())
    held = trace["velocitySetpoint"][290]
    assert 0 < held < 2 and trace["velocitySetpoint"][250] == held
    assert trace["velocitySetpoint"][-1] == 2.0 and trace["done"][-1]


def test_restart_hides_an_edge_of_execute() -> None:
    timeline: Timeline = {
        3: {"restart": True}, 4: {"restart": False, "execute": True, "targetVelocity": 1.0}, 10: {"execute": False},
        12: {"execute": True}, 60: {"restart": True}, 61: {"restart": False},
    }  # fmt: skip
    trace = Pair.of(CENTRED, 16).compare(played(timeline, 100))
    assert not trace["busy"][:12].any() and trace["busy"][12:60].all() and not trace["busy"][60:].any()


def test_another_order_in_every_sample_of_a_ramp() -> None:
    """Late ones do not find room any more: the ramp goes on to its end."""
    pair, settled = Pair.of(CENTRED, 2), set[bool]()
    for at in range(1, 70):
        other: Inputs = {"execute": True, "targetVelocity": -0.2}
        timeline: Timeline = {5: {"execute": True, "targetVelocity": 0.3}, 6: {"execute": False}, 6 + at: other}
        trace = pair.compare(played(timeline, 160))
        settled.add(bool(np.isclose(trace["statVelocity"].max(), 0.3)))
    assert settled == {True, False}


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_restart_forgets_how_an_order_ended(shape: str) -> None:
    order = {"targetVelocity": 0.1} if shape == CENTRED else {"distance": 0.01}
    timeline: Timeline = {5: {"execute": True, **order}, 150: {"restart": True}, 152: {"restart": False}}
    trace = Pair.of(shape, 16).compare(played(timeline, 160))
    assert trace["done"][149] and not trace["done"][150:].any()
    assert (trace["status"][150:] == 0x7000).all()


def test_restart_takes_over_the_speed_of_the_drive_in_mid_ramp() -> None:
    timeline: Timeline = {
        0: {"restart": True, "actualVelocity": 1.25}, 1: {"restart": False},
        5: {"execute": True, "targetVelocity": -1.0},
        60: {"restart": True, "actualVelocity": 0.5}, 63: {"restart": False}, 70: {"execute": False},
    }  # fmt: skip
    trace = Pair.of(CENTRED, 16).compare(played(timeline, 100))
    assert trace["velocitySetpoint"][0] == 1.25 and trace["steady"][0]
    assert (trace["velocitySetpoint"][60:] == 0.5).all() and not trace["acceleration"][61:].any()


def test_stop_in_both_halves_of_a_move() -> None:
    for at in (30, 200):
        timeline: Timeline = {5: {"execute": True, "distance": 1.0}, at: {"stop": True}}
        trace = Pair.of(HALF_SINE, 16).compare(played(timeline, 600))
        assert trace["standstill"][-1] and trace["commandAborted"][-1]
        assert (np.sum(trace["velocitySetpoint"].astype(float)) * 0.01 < 0.9) == (at == 30)


def constants(job: Job) -> dict[str, np.float32]:
    return {constant.name: np.float32(constant.value) for group in groups(job) for constant in group.constants}


def stepping(start: float) -> Iterator[np.float32]:
    """The REAL numbers from one on."""
    value = np.float32(start)
    while True:
        yield value
        value = np.nextafter(value, np.float32(1e9))


def test_a_whole_number_of_samples_is_not_rounded_up() -> None:
    pair, cycle = Pair.of(CENTRED, 16), np.float32(0.01)
    k = constants(pair.job)
    ratios = ((v, max(np.sqrt(k["SQUARE_BY_JERK"] * v), k["TIME_BY_ACC"] * v) / cycle) for v in stepping(1.8))
    speed, ratio = next((float(v), int(r)) for v, r in ratios if r == np.floor(r))
    trace = pair.compare(played({5: {"execute": True, "targetVelocity": speed}}, 300))
    assert int(np.argmax(trace["statVelocity"] == np.float32(speed))) == 5 + ratio - 1


def test_a_whole_number_of_samples_of_a_move_gets_just_one_more() -> None:
    pair, cycle = Pair.of(HALF_SINE, 16), np.float32(0.01)
    k = constants(pair.job)
    ratios = ((d, np.sqrt(k["CUBE_BY_JUMP"] * d / cycle) / cycle) for d in stepping(0.5))
    distance, ratio = next((float(d), int(r)) for d, r in ratios if r == np.floor(r))
    trace = pair.compare(played({5: {"execute": True, "distance": distance}}, 300))
    assert int(np.flatnonzero(trace["statVelocity"])[-1]) == 5 + ratio + 1 - 2


def test_limits_of_a_distance_belong_to_what_is_taken() -> None:
    pair = Pair.of(HALF_SINE, 2)
    k = constants(pair.job)
    for name, beyond in (("MIN_DISTANCE", 0.0), ("MAX_DISTANCE", np.inf)):
        for distance, status in ((k[name], 0x7001), (np.nextafter(k[name], np.float32(beyond)), 0x8201)):
            for sign in (1, -1):
                timeline: Timeline = {5: {"execute": True, "distance": sign * float(distance)}, 6: {"execute": False}}
                assert pair.compare(played(timeline, 40))["status"][5] == status


def test_stop_in_every_sample_about_the_middle_of_a_move() -> None:
    pair = Pair.of(HALF_SINE, 16)
    numbers = {d: Moves.of(pair.job).samples(d) for d in (0.010, 0.011, 0.012, 0.013)}
    distance, samples = next((d, n[0]) for d, n in numbers.items() if len(n) == 1 and n[0] % 2 == 0)
    for at in range(samples // 2 - 3, samples // 2 + 4):
        pair.compare(played({5: {"execute": True, "distance": distance}, 5 + at: {"stop": True}}, 120))


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_the_program_begins_anew_whatever_v_memory_has_kept(shape: str) -> None:
    pair = Pair.of(shape, 16)
    order = {"targetVelocity": 1.0} if shape == CENTRED else {"distance": 0.5}
    traces = []
    for retained in (0, 0xFF, 0x5A):
        axis = pair.axis(retained)
        axis.set(execute=False, stop=False, restart=False)
        for sample in range(300):
            if sample == 3:
                axis.set(execute=True, **order)
            axis.scan()
        assert not axis.faults
        traces.append(axis.trace())
    assert len({trace.sha256() for trace in traces}) == 1
    assert traces[0]["done"][-1]


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_the_whole_cpu_makes_the_same_samples(shape: str) -> None:
    """MAIN with its inputs, Init in the first scan, and the timed interrupt itself."""
    pair = Pair.of(shape, 16)
    addresses = memory_map(pair.job)
    cpu = Smart(pair.smart, scan_us=3300)
    order = {"target_velocity": -1.5} if shape == CENTRED else {"distance": -0.7}
    cpu.run_until(4000)
    for name, value in order.items():
        cpu.variable(addresses[name], REAL).set(value)
    setpoint, execute = cpu.variable(addresses["setpoint"], REAL), cpu.variable(addresses["execute"], BOOL)
    axis = pair.axis()
    axis.set(**{"targetVelocity" if name == "target_velocity" else name: value for name, value in order.items()})
    taken = []
    for sample in range(1, 301):
        cpu.variable("I0.0").set(sample > 20)
        cpu.run_until(sample * 10_000 - 1)
        axis.set(execute=execute.get())
        cpu.run_until(sample * 10_000)
        axis.scan()
        taken.append(setpoint.get())
    assert np.array_equal(np.array(taken, dtype=np.float32), axis.trace()["velocitySetpoint"])
    assert axis.get("done") and cpu.variable(addresses["done"], BOOL).get()
    assert min(taken) < -0.3 and not cpu.violations and not cpu.faults
    assert cpu.variable("AQW16").get() == round(27648 / 2.0 * taken[-1])


def test_a_turning_drive_is_taken_over_in_the_first_scan() -> None:
    """What stands in ActualVel when MAIN calls Init is the setpoint before the first sample."""
    job = job_of(CENTRED, 16)
    text = smart_files(job)["Axis.awl"].decode().replace("MOVR   0.0, VD1008", "MOVR   0.75, VD1008")
    assert "0.75" in text
    program = lowering.lower(parser.parse(decode_source("a.awl", text.encode())))
    cpu = Smart(program, scan_us=3000)
    setpoint = cpu.variable(memory_map(job)["setpoint"], REAL)
    for time in range(0, 60_000, 3000):
        cpu.run_until(time)
        assert setpoint.get() == 0.75


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_nothing_outside_the_map_is_written(shape: str) -> None:
    pair = Pair.of(shape, 16)
    cpu = Smart(pair.smart, scan_us=3000)
    memory, lay = cpu.memory["V"], layout(pair.job)
    outside = [*range(lay.first_byte), *range(lay.end, 8192)]
    for byte in outside:
        memory[byte] = 0xA5
    cpu.variable("I0.0").set(False)
    cpu.run_until(30_000)
    cpu.variable("I0.0").set(True)
    cpu.run_until(800_000)
    assert all(memory[byte] == 0xA5 for byte in outside)


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
@pytest.mark.parametrize("length", [2, 512])
def test_micro_win_takes_every_file(shape: str, length: int) -> None:
    files = smart_files(job_of(shape, length))
    single = [name for name in files if name.endswith(".awl") and name != "Axis.awl"]
    assert single == ["Axis_main.awl", "Axis_sample.awl", "Axis_tick.awl", "Axis_init.awl"]
    assert [str(finding) for finding in smart_findings(sources(files, single))] == []
    joined = smart_findings(sources(files, ["Axis.awl"]))
    assert all(finding.rule == "one-block" for finding in joined)
    assert max(len(line) for name in files if name.endswith(".awl") for line in files[name].split(b"\r\n")) <= 135


def test_the_parts_and_the_joined_file_are_one_program() -> None:
    files = smart_files(job_of(CENTRED, 16))
    single = [files[file.name] for file in output_files(job_of(CENTRED, 16))[:4]]
    assert b"".join(single) == files["Axis.awl"]


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_blocks_have_the_numbers_of_the_job(shape: str) -> None:
    assert set(Pair.of(shape, 16).smart.functions) == {MAIN, "SBR3", "SBR4", "INT2"}


@pytest.mark.parametrize("shape", [CENTRED, HALF_SINE])
def test_tia_and_classic_blocks_are_bit_identical(shape: str) -> None:
    pair = Pair.of(shape, 16)
    classic, tia = SclAxis(pair.scl), SclAxis(scl_program(pair.job, "tia-scl"), "Axis", "Axis_DB")
    commands = ramp_commands if shape == CENTRED else move_commands
    for inputs in commands(Random(3), 2000):
        for axis in (classic, tia):
            axis.set(**inputs)
            axis.scan()
    assert repr(classic.columns) == repr(tia.columns)
