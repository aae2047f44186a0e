"""Every golden STL source in awlsim, in lockstep with our machine: after each call the whole instance DB is equal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random

import pytest

from plcgen.job import Job, read_job
from plcgen.loading import load
from plcgen.plc.machine import Machine
from tests.check.awlsim_rig import AwlsimBlock

pytest.importorskip("awlsim", reason="awlsim is the oracle of this test: pip install awlsim")

GOLDEN = Path(__file__).parents[2] / "golden"
STL = "s7-300-stl"
CASES = sorted(path.parent.name for path in GOLDEN.glob(f"*/{STL}"))
CALLS = 500
GARBAGE = 0x7F
Inputs = Mapping[str, float]


def sources(case: str) -> dict[str, bytes]:
    """Of the blocks; the example calls them only."""
    files = (GOLDEN / case / STL).glob("*.awl")
    return {path.name: path.read_bytes() for path in files if "_example" not in path.name}


def hoist_inputs(job: Job, machine: Machine, call: int) -> Inputs:
    """Up, with a stop and a second start on the way; the hoist follows the setpoint."""
    instance = f'"DB{job.blocks.db}"'
    travel, speed = (machine.variable(f"{instance}.{name}").get() for name in ("actualTravel", "limitedSetpoint"))
    going = 3 <= call < 300 or call >= 400
    moved = travel + speed * job.sample_period
    return {"enable": going, "directionUp": True, "actualTravel": moved, "actualVelocity": speed}


def cosine_inputs(job: Job, random: Random) -> Inputs:
    """Any order at any time, and now and then one that is refused."""
    top = job.cosine.max_velocity
    wild = random.choice([math.inf, 1e30, 0.0]) if random.random() < 0.02 else 1.0
    common = {
        "execute": random.random() < 0.3,
        "stop": random.random() < 0.05,
        "restart": random.random() < 0.01,
        "cycleTime": job.sample_period * random.choice([1.0, 1.0, 1.0, 5.0, 11.0]),
    }
    if job.cosine.shape == "half-sine":
        return common | {"distance": wild * top * random.uniform(-0.3, 0.3)}
    return common | {
        "hold": random.random() < 0.1,
        "targetVelocity": wild * top * random.uniform(-1, 1),
        "actualVelocity": top * random.uniform(-1.1, 1.1),
    }


def inputs(job: Job, machine: Machine) -> Iterator[Inputs]:
    random = Random(2026)
    for call in range(CALLS):
        if job.method == "hoist":
            yield hoist_inputs(job, machine, call)
        elif call % 4 == 0:
            yield cosine_inputs(job, random)
        else:
            yield {}


@pytest.mark.parametrize("case", CASES)
def test_both_engines_keep_the_same_instance(case: str) -> None:
    job, files = read_job(GOLDEN / case / "job.toml"), sources(case)
    block, data = job.function_block.fb, job.function_block.db
    machine = Machine(load(STL, files), GARBAGE)
    other = AwlsimBlock([text.decode("gbk") for text in files.values()], block, data)
    memory = machine.memory[f"DB{data}"]
    assert other.image == bytes(memory)
    for call, given in enumerate(inputs(job, machine)):
        for name, value in given.items():
            machine.variable(f'"DB{data}".{name}').set(value)
        other.image = bytes(memory)
        machine.call(f"FB{block}", f"DB{data}")
        other.cycle()
        assert other.image == bytes(memory), f"call {call}"


def test_there_are_cases_of_both_methods() -> None:
    assert {read_job(GOLDEN / case / "job.toml").method for case in CASES} == {"hoist", "cosine"}
