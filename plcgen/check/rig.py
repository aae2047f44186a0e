"""The rig: drives a function block scan by scan, alone or bound to a plant, and records what it reads and writes."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import floor, inf
from random import Random
from struct import Struct

import numpy as np

from plcgen.plc.core import Program
from plcgen.plc.engines import ClosedLoop
from plcgen.plc.machine import Machine, Variable
from plcgen.plc.types import BYTE_BITS, Elementary, Family, Field
from plcgen.trajectory import Column, LateColumns, Trajectory


@dataclass(frozen=True)
class Encoder:
    """How travel is measured: in steps of `quantum` (0 = REAL resolution), `delay` scans late."""

    quantum: float = 0.0
    delay: int = 0

    def read(self, travel: float) -> float:
        return floor(travel / self.quantum) * self.quantum if self.quantum else travel


PERFECT = Encoder()
_MOMENT = Struct("=dd")
"""Time and plant travel of a scan, as they are recorded."""


@dataclass(frozen=True)
class Clock:
    """When the cyclic interrupt comes: each call up to `jitter` periods early or late, without drift."""

    period: float
    jitter: float = 0.0
    seed: int = 1


@dataclass
class Plant:
    """An ideal drive: the hoist moves at the setpoint of the last scan. `history` holds what a late encoder reads."""

    travel: float
    velocity: float = 0.0
    time: float = 0.0
    history: deque[float] = field(default_factory=deque)

    def copy(self) -> Plant:
        return replace(self, history=self.history.copy())

    def move_to(self, time: float) -> None:
        self.travel += self.velocity * (time - self.time)
        self.time = time


@dataclass(frozen=True)
class Goal:
    """What a run is for: any of the first phases; any of the others, with the plant outside `between`."""

    phases: frozenset[int] = frozenset()
    phases_outside: frozenset[int] = frozenset()
    between: tuple[float, float] = (-inf, inf)

    def is_met(self, rig: Rig) -> bool:
        low, high = self.between
        phase = rig.phase
        return phase in self.phases or (phase in self.phases_outside and not low < rig.plant.travel < high)

    @property
    def masks(self) -> tuple[int, int]:
        """Phases as bits."""
        return sum(1 << phase for phase in self.phases), sum(1 << phase for phase in self.phases_outside)


NEVER = Goal()


@dataclass(frozen=True)
class Snapshot:
    """A moment of a rig to come back to."""

    memory: bytes
    plant: Plant
    scans: int


class Instance:
    """An FB on its instance DB, called scan by scan. Inputs keep their value until they are set again."""

    def __init__(
        self, program: Program, block: str, instance: str, temp_fill: int = 0, function_error: float = 0.0
    ) -> None:
        self.machine = Machine(program, temp_fill, function_error=function_error)
        self.block, self.instance = block, instance
        self.scans = 0
        self._variables: dict[str, Variable] = {}
        self._memory = self.machine.memory[instance]
        self._images: list[bytes] = []
        self._call = self.machine.call

    def variable(self, name: str) -> Variable:
        """A variable of the instance, looked up once."""
        if name not in self._variables:
            self._variables[name] = self.machine.variable(f'"{self.instance}".{name}')
        return self._variables[name]

    def set(self, **inputs: float) -> None:
        """Set inputs of the block."""
        for name, value in inputs.items():
            self.variable(name).set(value)

    def get(self, name: str) -> float:
        """An output of the block after the last scan."""
        return float(self.variable(name).get())

    def scan(self) -> None:
        """One call of the cyclic interrupt."""
        self.machine.scan = self.scans
        self._call(self.block, self.instance)
        self._images.append(bytes(self._memory))
        self.scans += 1

    @property
    def faults(self) -> Sequence[object]:
        """Arithmetic events so far."""
        return self.machine.faults

    def trace(self) -> Trajectory:
        """Every elementary variable of the interface after each scan."""
        return Trajectory(LateColumns(self._makers()))

    def _makers(self) -> dict[str, Callable[[], Column]]:
        """Of a column for each variable."""
        structure = self.machine.program.functions[self.block].instance
        assert structure is not None
        data, size = b"".join(self._images), len(self._memory)
        return {m.name: partial(_decoded, data, size, m) for m in structure.fields if isinstance(m.type, Elementary)}


class Rig(Instance):
    """An instance with its plant."""

    TRAVEL, VELOCITY, SETPOINT, PHASE = "actualTravel", "actualVelocity", "limitedSetpoint", "phase"

    def __init__(
        self,
        program: Program,
        block: str,
        instance: str,
        travel: float,
        clock: Clock,
        encoder: Encoder = PERFECT,
        temp_fill: int = 0,
        function_error: float = 0.0,
    ) -> None:
        super().__init__(program, block, instance, temp_fill, function_error)
        self.clock, self.encoder = clock, encoder
        self.plant = Plant(travel)
        self.forced: dict[str, float] = {}
        self._random = Random(clock.seed)
        self._moments: list[bytes] = []
        self._travel, self._velocity, self._setpoint = (
            self.variable(name) for name in (self.TRAVEL, self.VELOCITY, self.SETPOINT)
        )
        self._late: list[float] = []
        """How late the next calls come, in periods, as far as that was drawn."""
        self._loop = self._closed_loop()

    def force(self, **measurements: float) -> None:
        """Replace what encoder or drive report until `release`."""
        self.forced.update(measurements)

    def release(self) -> None:
        self.forced.clear()

    @property
    def phase(self) -> int:
        return int(self.get(self.PHASE))

    def scan(self) -> None:
        """One call of the cyclic interrupt."""
        late = self._lateness(1)[0] if self.clock.jitter else 0.0
        del self._late[:1]
        self.plant.move_to((self.scans + late) * self.clock.period)
        self._travel.set(self.forced.get(self.TRAVEL, self._measured()))
        self._velocity.set(self.forced.get(self.VELOCITY, self.plant.velocity))
        super().scan()
        self.plant.velocity = self._setpoint.get()
        self._moments.append(_MOMENT.pack(self.plant.time, self.plant.travel))

    def _times(self, scans: int) -> np.ndarray:
        """When the next calls come."""
        due = np.arange(self.scans, self.scans + scans, dtype=np.float64)
        return (due + self._lateness(scans)[:scans] if self.clock.jitter else due) * self.clock.period

    def _lateness(self, scans: int) -> list[float]:
        """How late so many calls come, and perhaps further ones, in periods."""
        jitter, late = self.clock.jitter, self._late
        while len(late) < scans:
            late.append(self._random.uniform(-jitter, jitter))
        return late

    def _measured(self) -> float:
        reading = self.encoder.read(self.plant.travel)
        if not self.encoder.delay:
            return reading
        history = self.plant.history
        history.extend([reading] * (self.encoder.delay - len(history)))
        history.append(reading)
        return history.popleft()

    def run(self, scans: int, until: Goal | None = None) -> bool:
        """Scan until the goal is met after a scan; False when `scans` were not enough."""
        end = self.scans + scans
        while self.scans < end:
            if self._loop is None or self.forced or len(self.plant.history) < self.encoder.delay:
                self.scan()
            else:
                self._ride(self._loop, end - self.scans, until or NEVER)
            if until is not None and until.is_met(self):
                return True
        return False

    def _closed_loop(self) -> ClosedLoop | None:
        return self.machine.closed_loop(
            self.block, self.instance, (self.TRAVEL, self.VELOCITY, self.SETPOINT, self.PHASE)
        )

    def _ride(self, loop: ClosedLoop, most: int, until: Goal) -> None:
        """Some scans at once, just as `scan` makes them: up to the goal at the most."""
        plant = self.plant
        times = self._times(min(most, loop.LONGEST))
        drive = np.array([plant.travel, plant.velocity, plant.time, self.encoder.quantum, *until.between])
        late = np.array(plant.history, dtype=np.float64)
        rows = loop.run(times, drive, late, *until.masks)
        self.machine.scan = self.scans + rows - 1
        self.machine.settle(loop)
        plant.travel, plant.velocity, plant.time = drive[:3].tolist()
        plant.history = deque(late.tolist())
        self._moments.append(loop.places[:rows].tobytes())
        self._images.append(loop.images[:rows].tobytes())
        del self._late[:rows]
        self.scans += rows

    def snapshot(self) -> Snapshot:
        return Snapshot(bytes(self._memory), self.plant.copy(), self.scans)

    def restore(self, moment: Snapshot) -> None:
        """Go back to a moment; the record begins anew there."""
        self._memory[:] = moment.memory
        self.plant = moment.plant.copy()
        self.scans = moment.scans
        self.release()
        self._images.clear()
        self._moments.clear()

    def trace(self) -> Trajectory:
        """Everything recorded: time, plant travel, and every elementary variable of the interface."""
        times, travels = np.frombuffer(b"".join(self._moments)).reshape(-1, 2).T
        return Trajectory(LateColumns({"time": lambda: times, "plantTravel": lambda: travels, **self._makers()}))


def _decoded(data: bytes, size: int, member: Field) -> Column:
    """An elementary member in memory images of one size that follow each other."""
    assert isinstance(member.type, Elementary)
    byte, bit = divmod(member.bit, BYTE_BITS)
    dtype = np.dtype(">" + member.type.code)
    column: Column = np.ndarray((len(data) // size,), dtype, data, byte, (size,))
    if member.type.family is Family.BIT:
        return (column >> bit & 1).astype(bool)
    return column.astype(dtype.newbyteorder("="))
