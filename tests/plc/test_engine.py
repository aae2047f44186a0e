"""The plain engine against a second, naive interpreter of the core, and what stops it."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.errors import Fault
from plcgen.plc.arithmetic import library
from plcgen.plc.core import (
    INSTANCE,
    Branch,
    Call,
    Cell,
    Compute,
    DataBlock,
    Function,
    Instruction,
    Jump,
    Label,
    Literal,
    Operand,
    Place,
    Program,
    Register,
    Return,
)
from plcgen.plc.engine import Engine
from plcgen.plc.engines import PLAIN
from plcgen.plc.layout import Member, arrange, read, write
from plcgen.plc.machine import Machine
from plcgen.plc.operators import Operator, move, resolve
from plcgen.plc.source import SourceText, Span
from plcgen.plc.types import BOOL, INT, REAL, Elementary, Type, Value
from plcgen.plc.verifier import verify

HERE = Span(0, 5)
SOURCE = SourceText("engine.scl", "x := 1;")
NAMES = [f"v{number}" for number in range(6)]
DATA = arrange("FB1", [[*(Member(name, INT) for name in NAMES), Member("flag", BOOL), Member("real", REAL)]])
REGISTERS = tuple(Register(number, INT) for number in range(1, 4))


def row(symbol: str, *types: Type) -> Operator:
    operator = resolve(symbol, types)
    assert operator is not None
    return operator


def cell(name: str) -> Cell:
    member = DATA.member(name)
    assert member is not None
    return Cell(INSTANCE, member.bit, member.type)


PLACES: list[Place] = [*REGISTERS, *(cell(name) for name in NAMES)]
OPERANDS: list[Operand] = [*PLACES, *(Literal(value, INT) for value in (-32768, -1, 0, 1, 7, 32767))]


def random_body(seed: int) -> tuple[Instruction, ...]:
    """Arbitrary jumps forwards and backwards between labels, as in STL."""
    choose = random.Random(seed)
    labels = [f"L{number}" for number in range(choose.randint(1, 5))]
    body: list[Instruction] = [Label(HERE, label) for label in labels]
    for _ in range(choose.randint(1, 14)):
        body.insert(choose.randint(0, len(body)), random_compute(choose))
    for _ in range(choose.randint(1, 5)):
        body.insert(choose.randint(0, len(body)), Jump(HERE, choose.choice(labels)))
    for _ in range(choose.randint(1, 6)):
        at, label, when = choose.randint(0, len(body)), choose.choice(labels), choose.random() < 0.5
        test = Compute(HERE, cell("flag"), row("<", INT, INT), tuple(choose.choices(OPERANDS, k=2)))
        body[at:at] = [test, Branch(HERE, cell("flag"), label, when)]
    return (*body, Return(HERE))


def random_compute(choose: random.Random) -> Compute:
    operator = row(choose.choice(["+", "-", "*", "/", "MOD", "MAX"]), INT, INT)
    return Compute(HERE, choose.choice(PLACES), operator, tuple(choose.choices(OPERANDS, k=2)))


def interpret(body: tuple[Instruction, ...], image: bytearray, budget: int) -> list[str] | None:
    """Walk the instructions one by one; the events, or None when the budget of backward jumps is spent."""
    labels = {item.name: at for at, item in enumerate(body) if isinstance(item, Label)}
    registers: dict[int, Value] = {register.number: 0 for register in REGISTERS}
    events: list[str] = []
    names = library(lambda kind, _site: events.append(kind), lambda *_: pytest.fail("no index here"))

    def load(operand: Operand) -> Value:
        if isinstance(operand, Literal):
            return operand.value
        return registers[operand.number] if isinstance(operand, Register) else read(image, operand.bit, operand.type)

    at = 0
    while not isinstance(item := body[at], Return):
        target = at + 1
        if isinstance(item, Compute):
            names |= {f"o{number}": load(operand) for number, operand in enumerate(item.operands)}
            exec("\n".join(item.operator.python("result", ["o0", "o1"], 0)), names)
            if isinstance(item.target, Register):
                registers[item.target.number] = names["result"]
            else:
                assert isinstance(item.target.type, Elementary)
                write(image, item.target.bit, item.target.type, item.target.type.encode(names["result"]))
        elif isinstance(item, Jump) or (isinstance(item, Branch) and load(item.condition) == item.when):
            target = labels[item.label]
            budget -= target <= at
        if budget < 0:
            return None
        at = target
    return events


def machine_of(*body: Instruction, budget: int = 1000) -> Machine:
    function = Function("FB1", SOURCE, body, HERE, DATA, temporaries=REGISTERS)
    data = DataBlock("DB1", DATA, DATA.initial, "FB1")
    return Machine(verify(Program({"FB1": function}, {"DB1": data})), budget=budget)


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**32), values=st.lists(st.integers(-32768, 32767), min_size=6, max_size=6))
def test_arbitrary_jumps_run_as_written(seed: int, values: list[int]) -> None:
    body = random_body(seed)
    machine = machine_of(*body, budget=40)
    image = bytearray(DATA.initial)
    for name, value in zip(NAMES, values, strict=True):
        machine.variable(f"DB1.{name}").set(value)
    image[:] = machine.memory["DB1"]
    events = interpret(body, image, 40)
    if events is None:
        with pytest.raises(Fault, match="watchdog"):
            machine.call("FB1", "DB1")
    else:
        machine.call("FB1", "DB1")
        assert [fault.kind for fault in machine.faults] == events
    assert machine.memory["DB1"] == image


def test_endless_loop_stops_with_its_place() -> None:
    machine = machine_of(Label(HERE, "L1"), Jump(HERE, "L1"), Return(HERE))
    machine.scan = 17
    with pytest.raises(Fault) as fault:
        machine.call("FB1", "DB1")
    assert str(fault.value) == (
        "engine.scl:1:1: FB1: watchdog: too many loops and calls in one scan; is there a loop without end? (scan 17)\n"
        "    x := 1;\n"
        "    ^^^^^"
    )


def test_blocks_that_call_each_other_too_deep_stop_with_their_place() -> None:
    function = Function("FC1", SOURCE, (Call(HERE, "FC1"), Return(HERE)), HERE)
    with pytest.raises(Fault) as fault:
        Machine(verify(Program({"FC1": function}))).call("FC1")
    assert str(fault.value).startswith(
        "engine.scl:1:1: FC1: blocks call each other too deep (scan 0); is there a call without end?\n    x := 1;"
    )


def test_python_text_can_be_read(engine: str) -> None:
    if engine != PLAIN:
        pytest.skip("the other engine has no text")
    half = Compute(HERE, cell("real"), row("*", REAL, REAL), (cell("real"), Literal(0.5, REAL)))
    machine = machine_of(half, Branch(HERE, cell("flag"), "L1"), half, Label(HERE, "L1"), Return(HERE))
    check = "t and not 1.3817869688151111e-76 <= t * t <= 1.1579207543382391e+77"
    assert isinstance(machine.engine, Engine)
    assert machine.engine.source_of("FB1") == (
        "def b_FB1(D, B):\n"
        "    r1 = 0\n"
        "    r2 = 0\n"
        "    r3 = 0\n"
        "    pc = 0\n"
        "    f[0] = load_REAL(D, B + 14)[0] * 0.5\n"
        "    t = f[0]\n"
        f"    if {check}: t = special(t, 0)\n"
        "    store_REAL(D, B + 14, t)\n"
        "    if (D[B + 12] & 1 != 0):\n"
        "        pc = 2\n"
        "    if pc <= 1:\n"
        "        f[0] = load_REAL(D, B + 14)[0] * 0.5\n"
        "        t = f[0]\n"
        f"        if {check}: t = special(t, 1)\n"
        "        store_REAL(D, B + 14, t)\n"
        "    return\n"
    )


def test_temporaries_show_the_fill_pattern() -> None:
    body = (Compute(HERE, cell("v0"), move(INT), (REGISTERS[0],)), Return(HERE))
    function = Function("FB1", SOURCE, body, HERE, DATA, temporaries=REGISTERS)
    machine = Machine(Program({"FB1": function}), temp_fill=0xCC)
    machine.call("FB1", "DB1")
    assert machine.variable("DB1.v0").get() == -13108


class Counting(Machine):
    """A machine with a service, which is asked for a number and refuses above 2."""

    def services(self) -> dict[str, Callable[..., object]]:
        return {"next_number": iter([1, 2, 3]).__next__}


ASK = Operator("ASK", (), INT, "next_number()", False, "{r} > 2", "stop('%d is too much' % {r}, {site})")
NOTE = Operator("TWICE", (INT,), INT, "{0} + {0}", False, "{r} > 2", "noted({r}, 'large', {site})")


def test_operators_call_services_of_the_machine_and_may_stop_it() -> None:
    function = Function(
        "FC1", SOURCE, (Compute(HERE, REGISTERS[0], ASK, ()), Return(HERE)), HERE, results=REGISTERS[:1]
    )
    machine = Counting(verify(Program({"FC1": function})))
    assert [machine.call("FC1"), machine.call("FC1")] == [1, 2]
    with pytest.raises(Fault) as caught:
        machine.call("FC1")
    assert str(caught.value) == "engine.scl:1:1: FC1: 3 is too much (scan 0)\n    x := 1;\n    ^^^^^"


def test_a_noted_value_stays_as_it_is() -> None:
    body = (Compute(HERE, cell("v0"), NOTE, (Literal(7, INT),)), Return(HERE))
    machine = machine_of(*body)
    machine.call("FB1", "DB1")
    assert machine.variable("DB1.v0").get() == 14
    assert [fault.kind for fault in machine.faults] == ["large"]
