"""Commands of a block of the method `cosine`: what it takes, what it refuses, and what a restart does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, nan

from plcgen.check.cosine_model import Axis, MoveModel, RampModel
from plcgen.check.cosine_run import ABORTED, COMING_TO_REST, FIRST_CALL, IN_PROGRESS, NO_ORDER, REACHED

ERROR_TARGET, ERROR_CYCLE_TIME, ERROR_STOP, ERROR_MOVING = 0x8201, 0x8202, 0x8203, 0x8204
PROBE = 1e-5
"""Relative distance from a limit at which REAL tells both sides apart."""
REST = {"velocitySetpoint": 0.0, "acceleration": 0.0, "steady": 1, "standstill": 1, "busy": 0}
FLAGS = ("busy", "done", "commandAborted", "error")


def commands(make: Callable[[], Axis], model: RampModel | MoveModel) -> Iterator[str]:
    """Each answer is empty, or says what is wrong."""
    yield from _cold_start(make, model)
    yield from _ends(make, model)
    yield from _refusals(make, model)
    if isinstance(model, RampModel):
        yield from _take_over(make, model)
        yield from _wrong_order_on_the_way(make, model)
        if model.filter_length == 1:
            yield _stop_while_held_at_rest(make)
    else:
        yield from _order_on_the_way(make, model)


def _told(axis: Axis, when: str, **wanted: float) -> str:
    found = {name: axis.get(name) for name in wanted}
    wrong = [f"{name} = {value:g}, not {wanted[name]:g}" for name, value in found.items() if value != wanted[name]]
    many = sum(bool(axis.get(flag)) for flag in FLAGS) > 1
    return f"{when}: {', '.join(wrong)}" if wrong else f"{when}: two of {', '.join(FLAGS)}" if many else ""


def _order(model: RampModel | MoveModel) -> dict[str, float]:
    """Some order within the limits."""
    return (
        {"targetVelocity": model.max_velocity / 2} if isinstance(model, RampModel) else {"distance": _distance(model)}
    )


def _distance(model: MoveModel) -> float:
    return max(map(abs, model.distances))


def _cold_start(make: Callable[[], Axis], model: RampModel | MoveModel) -> Iterator[str]:
    """Without a restart call too the block is at rest, and an execute that is TRUE at once is no edge."""
    axis = make()
    still = {"velocitySetpoint": 0.0, "acceleration": 0.0}
    yield _told(axis, "before the first call", status=NO_ORDER, **still, **dict.fromkeys(FLAGS, 0))
    axis.set(execute=True, **_order(model))
    axis.scan()
    yield _told(axis, "execute TRUE at the first call", status=NO_ORDER, **REST)
    axis.set(execute=False)
    axis.scan()
    axis.set(execute=True)
    axis.scan()
    yield _told(axis, "order", status=FIRST_CALL, busy=1, steady=0)
    axis.scan()
    yield _told(axis, "after the order", status=IN_PROGRESS, busy=1)
    axis.set(restart=True)
    axis.scan()
    if isinstance(model, MoveModel):
        yield _told(axis, "restart on the way", status=NO_ORDER, **REST)
    axis.set(restart=False)
    axis.scan()
    yield _told(axis, "execute held through a restart", status=NO_ORDER, busy=0)


def _ends(make: Callable[[], Axis], model: RampModel | MoveModel) -> Iterator[str]:
    """How an order ended is told as long as execute is TRUE."""
    axis = _ordered(make, **_order(model))
    _until_steady(axis, model)
    yield _told(axis, "done", done=1, busy=0, status=REACHED, steady=1)
    axis.scan()
    yield _told(axis, "still done", done=1, status=REACHED, acceleration=0.0)
    axis.set(restart=True)
    axis.scan()
    yield _told(axis, "restart after an order that is done", done=0, status=NO_ORDER)
    axis.set(restart=False, execute=False)
    axis.scan()
    axis = _ordered(make, **_order(model))
    _until_steady(axis, model)
    axis.set(execute=False)
    axis.scan()
    yield _told(axis, "execute taken back", done=0, status=NO_ORDER)
    axis = _under_way(make, model)
    axis.set(stop=True)
    axis.scan()
    axis.scan()
    yield _told(axis, "stopped", commandAborted=1, busy=0, status=COMING_TO_REST)
    axis.set(execute=False)
    axis.scan()
    yield _told(axis, "stopped, execute taken back", commandAborted=0, status=COMING_TO_REST)
    _until_steady(axis, model)
    axis.scan()
    yield _told(axis, "at rest after a stop", status=NO_ORDER, **REST)


def _refusals(make: Callable[[], Axis], model: RampModel | MoveModel) -> Iterator[str]:
    period = model.sample_period
    for value in (nan, inf, -inf, 1e38):
        target = {"targetVelocity": value} if isinstance(model, RampModel) else {"distance": value}
        yield _refused(make, f"order {value}", ERROR_TARGET, **target)
    for cycle in (0.0, -period, nan, inf, period * 1000, period / 10 * (1 - PROBE), period * 10 * (1 + PROBE)):
        yield _refused(make, f"cycle time {cycle:g}", ERROR_CYCLE_TIME, cycleTime=cycle, **_order(model))
    yield _refused(make, "order with stop", ERROR_STOP, stop=True, **_order(model))
    for cycle in (period / 10, period / 10 * (1 + PROBE), period * 10 * (1 - PROBE), period * 10):
        axis = _ordered(make, cycleTime=cycle, **_order(model))
        yield _told(axis, f"cycle time {cycle:g}", status=FIRST_CALL, busy=1)
    for sign in (1, -1):
        if isinstance(model, RampModel):
            at, outside = ({"targetVelocity": sign * model.max_velocity * (1 + p)} for p in (0.0, PROBE))
        else:
            at, outside = ({"distance": sign * model.max_distance * (1 + p)} for p in (0.0, PROBE))
            yield _refused(make, "next to no distance", ERROR_TARGET, distance=sign * model.min_distance * (1 - PROBE))
            least = _ordered(make, distance=sign * model.min_distance)
            yield _told(least, "shortest distance", status=FIRST_CALL, busy=1)
        yield _refused(make, "order beyond the limit", ERROR_TARGET, **outside)
        yield _told(_ordered(make, **at), "order at the limit", status=FIRST_CALL, busy=1)
    if isinstance(model, MoveModel):
        yield _refused(make, "no distance", ERROR_TARGET, distance=0.0)


def _refused(make: Callable[[], Axis], when: str, status: int, **inputs: float) -> str:
    axis = _ordered(make, **inputs)
    first = _told(axis, when, status=status, error=1, **REST)
    axis.scan()
    still = _told(axis, f"{when}, execute TRUE", status=status, error=1, **REST)
    axis.set(execute=False)
    axis.scan()
    return first or still or _told(axis, f"{when}, taken back", status=NO_ORDER, error=0, **REST)


def _take_over(make: Callable[[], Axis], model: RampModel) -> Iterator[str]:
    """A restart takes over a plausible speed at once and to the last bit, whatever went on before."""
    top = model.max_velocity
    for speed in (0.37 * top, top, -top, nan, inf, -top * (1 + PROBE), top * (1 + PROBE)):
        for order in (False, True):
            axis = _ordered(make, **_order(model)) if order else make()
            axis.set(restart=True, actualVelocity=speed)
            axis.scan()
            taken = speed if abs(speed) <= top else 0.0
            axis.set(actualVelocity=taken)  # what a REAL holds of it
            flags = {"steady": 1, "standstill": int(taken == 0.0), "busy": 0, "acceleration": 0.0}
            wanted = axis.get("actualVelocity")
            yield _told(axis, f"restart at {speed:g}", velocitySetpoint=wanted, status=NO_ORDER, **flags)
            axis.set(restart=False)
            axis.scan()
            yield _told(axis, f"after a restart at {speed:g}", velocitySetpoint=wanted, status=NO_ORDER, **flags)


def _wrong_order_on_the_way(make: Callable[[], Axis], model: RampModel) -> Iterator[str]:
    """An order that is no number, and one with a wrong cycle time, bring the axis to rest."""
    for wrong, status in (({"targetVelocity": nan}, ERROR_TARGET), ({"cycleTime": 0.0}, ERROR_CYCLE_TIME)):
        axis = _under_way(make, model)
        axis.set(execute=False)
        axis.scan()
        axis.set(execute=True, **wrong)
        axis.scan()
        yield _told(axis, "wrong order on the way", status=status, error=1, busy=0)
        axis.set(execute=False)
        axis.scan()
        yield _told(axis, "after a wrong order", status=COMING_TO_REST, error=0, busy=0)
        _until_steady(axis, model)
        axis.scan()
        yield _told(axis, "at rest after a wrong order", status=NO_ORDER, **REST)


def _stop_while_held_at_rest(make: Callable[[], Axis]) -> str:
    """Without an average a ramp from 0 to 0 ends in the sample of the stop."""
    axis = _ordered(make, targetVelocity=0.0, hold=True)
    held = _told(axis, "held at rest", status=FIRST_CALL, busy=1)
    axis.set(stop=True)
    axis.scan()
    return held or _told(axis, "stop while held at rest", status=ABORTED, commandAborted=1, **REST)


def _order_on_the_way(make: Callable[[], Axis], model: MoveModel) -> Iterator[str]:
    axis = _under_way(make, model)
    axis.set(execute=False)
    axis.scan()
    axis.set(execute=True)
    axis.scan()
    yield _told(axis, "order on the way", status=ERROR_MOVING, error=1, busy=0)
    axis.set(execute=False)
    _until_steady(axis, model)
    axis.scan()
    yield _told(axis, "at rest after an order on the way", status=NO_ORDER, **REST)
    if model.filter_length < 8:
        return
    axis = _ordered(make, distance=model.distances[0])
    axis.set(execute=False)
    for _ in range(model.samples(model.distances[0], model.sample_period) + model.filter_length // 2):
        axis.scan()
    axis.set(execute=True)
    axis.scan()
    yield _told(axis, "order before the average has caught up", status=ERROR_MOVING, error=1, busy=0)


def _ordered(make: Callable[[], Axis], **inputs: float) -> Axis:
    """In the first sample of an order."""
    axis = make()
    axis.scan()
    axis.set(execute=True, **inputs)
    axis.scan()
    return axis


def _under_way(make: Callable[[], Axis], model: RampModel | MoveModel) -> Axis:
    """Some samples after an order, far from its end."""
    axis = _ordered(make, **_order(model))
    change = model.samples(
        model.max_velocity / 2 if isinstance(model, RampModel) else _distance(model), model.sample_period
    )
    for _ in range(change // 4):
        axis.scan()
    return axis


def _until_steady(axis: Axis, model: RampModel | MoveModel) -> None:
    period = model.sample_period
    if isinstance(model, RampModel):
        enough = 2 * model.samples(2 * model.max_velocity, period)
    else:
        enough = 2 * model.samples(_distance(model), period)
    for _ in range(enough + 2 * model.filter_length):
        axis.scan()
        if axis.get("steady"):
            return
