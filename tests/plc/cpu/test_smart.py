"""The S7-200 SMART in time: scans, timed interrupts, queues, outputs, variables."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from plcgen.errors import Fault, PlcgenError
from plcgen.plc.cpu import pto, smart_loop
from plcgen.plc.cpu.smart import Smart
from plcgen.plc.script import NO_SCRIPT, Script
from plcgen.plc.source import SourceText
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from plcgen.plc.stl.smart_costs import CLASSES, COSTS
from plcgen.plc.stl.smart_memory import PHYSICAL_OUTPUTS, V
from plcgen.plc.types import DWORD, REAL, WORD
from tests.every_engine import QUICK
from tests.plc.conftest import smart_text

Make = Callable[..., Smart]

START = """
    LD     SM0.1
    MOVB   {period}, SMB34
    ATCH   INT0, 10
    ENI
    """
COUNT = """
    LD     SM0.0
    INCW   VW0
    """


def count(machine: Smart, path: str = "VW0") -> object:
    return machine.variable(path).get()


def test_scans_take_their_time(smart: Make) -> None:
    machine = smart({"scan_us": 7000}, OB1=COUNT)
    machine.scan()
    assert (machine.time_us, count(machine)) == (7000, 1)
    machine.run_until(20_999)
    assert (machine.time_us, count(machine)) == (20_999, 3)
    machine.run_until(21_000)
    assert count(machine) == 4
    machine.scan()
    assert (machine.time_us, count(machine)) == (35_000, 5)


def test_system_bits(smart: Make) -> None:
    machine = smart(
        {"scan_us": 250_000},
        OB1="""
        LD     First_Scan_On
        S      V0.0, 1
        ----
        LDN    First_Scan_On
        A      Clock_1s
        EU
        INCB   VB1
        ----
        LD     Clock_Scan
        EU
        INCB   VB2
        """,
    )
    machine.run_until(4_000_000)
    assert [count(machine, path) for path in ("VB0", "VB1", "VB2")] == [1, 4, 9]


def test_timed_interrupt(smart: Make) -> None:
    machine = smart(OB1=START.format(period=50), INT0=COUNT)
    machine.run_until(49_999)
    assert count(machine) == 0
    machine.run_until(50_000)
    assert count(machine) == 1
    machine.run_until(1_000_000)
    assert count(machine) == 20


def test_period_is_taken_when_the_routine_is_attached(smart: Make) -> None:
    machine = smart(OB1=START.format(period=50) + "MOVB 1, SMB34\n", INT0=COUNT)
    machine.run_until(100_000)
    assert count(machine) == 2


def test_attaching_without_a_period_is_a_fault(smart: Make) -> None:
    machine = smart(OB1="LD SM0.1\nATCH INT0, 10", INT0=COUNT)
    with pytest.raises(Fault, match="ATCH of event 10 with 0 ms in SMB34; write 1 to 255 before it"):
        machine.scan()


def test_second_timer_and_detaching(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.1
        MOVB   10, SMB35
        ATCH   INT1, 11
        ENI
        ----
        LDW=   VW0, +3
        DTCH   11
        """,
        INT1=COUNT,
    )
    machine.run_until(200_000)
    assert count(machine) == 3


def test_late_ticks_stay_on_the_grid(smart: Make) -> None:
    times = []
    machine = smart({"lateness": lambda n: 900 * (n % 3), "scan_us": 100}, OB1=START.format(period=10), INT0=COUNT)
    last = 0
    for time in range(0, 60_001, 100):
        machine.run_until(time)
        if count(machine) != last:
            last = count(machine)  # type: ignore[assignment]
            times.append(time)
    assert times == [10_000, 20_900, 31_800, 40_000, 50_900]


def test_blocked_intervals_delay_a_tick(smart: Make) -> None:
    options = {"blocked": [(9_000, 11_000), (11_000, 12_000), (30_000, 55_000)]}
    machine = smart(options, OB1=START.format(period=10), INT0=COUNT)
    machine.run_until(11_999)
    assert count(machine) == 0
    machine.run_until(12_000)
    assert count(machine) == 1
    machine.run_until(54_999)
    assert count(machine) == 2
    machine.run_until(55_000)
    assert count(machine) == 5


def test_queue_of_timed_interrupts_is_eight_long(smart: Make) -> None:
    machine = smart({"blocked": [(0, 200_000)]}, OB1=START.format(period=10), INT0=COUNT)
    machine.run_until(200_000)
    assert count(machine) == 8
    assert machine.variable("Timed_Int_Ovr").get() is True
    assert str(machine.violations[0]) == "event 10 at 90000 us: interrupt queue full: one is lost"


def test_disabled_interrupts_wait(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.1
        MOVB   10, SMB34
        ATCH   INT0, 10
        ----
        LD     I0.0
        EU
        ENI
        ----
        LD     I0.1
        DISI
        """,
        INT0=COUNT,
    )
    machine.run_until(25_000)
    assert (count(machine), machine.variable("Int_Enable").get()) == (0, False)
    machine.variable("I0.0").set(True)
    machine.scan()
    assert count(machine) == 3
    machine.variable("I0.1").set(True)
    machine.run_until(100_000)
    assert count(machine) == 3


def test_events_can_be_cleared_while_they_wait(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.1
        MOVB   10, SMB34
        ATCH   INT0, 10
        ----
        LD     I0.0
        CEVNT  10
        ENI
        """,
        INT0=COUNT,
    )
    machine.run_until(25_000)
    machine.variable("I0.0").set(True)
    machine.scan()
    assert count(machine) == 0


def test_an_attached_routine_runs_without_time(smart: Make) -> None:
    machine = smart({"scan_us": 500}, OB1=START.format(period=10), INT0=COUNT)
    with pytest.raises(PlcgenError, match="no interrupt routine is attached to event 10"):
        machine.run_interrupt(10)
    machine.scan()
    for _ in range(5):
        machine.run_interrupt(10)
    assert (machine.time_us, count(machine)) == (500, 5)


def test_urgent_interrupts_come_first(smart: Make) -> None:
    """Communication, then inputs, then timers; within a group in the order of arrival."""
    body = "LD SM0.0\n*I +10, VW0\n+I +{}, VW0"
    machine = smart(
        {"blocked": [(5_000, 19_000)]},
        OB1="""
        LD     SM0.1
        MOVB   10, SMB34
        ATCH   INT1, 10
        ATCH   INT2, 0
        ATCH   INT3, 2
        ATCH   INT4, 8
        ENI
        """,
        INT1=body.format(1),
        INT2=body.format(2),
        INT3=body.format(3),
        INT4=body.format(4),
    )
    machine.run_until(15_000)
    for event in (2, 0, 8):
        machine.raise_event(event)
    machine.run_until(18_999)
    assert count(machine) == 0
    machine.run_until(19_000)
    assert count(machine) == 4321


def test_interrupt_gives_back_accumulators_and_sm1(smart: Make) -> None:
    machine = smart(
        OB1=START.format(period=5) + "MOVD +7, AC1\n-I VW10, VW10\n",
        INT0="""
        LD     SM0.0
        MOVD   +9, AC1
        MOVD   AC1, VD20
        +I     -1, VW24
        CRETI
        """,
    )
    machine.run_until(6_000)
    assert [machine.variable(path).get() for path in ("VD20", "AC1", "SM1.0", "SM1.2")] == [9, 7, True, False]


def test_an_interrupt_that_waits_when_the_program_stops_the_cpu(smart: Make) -> None:
    """Time goes on without it."""
    machine = smart(
        {"blocked": [(9000, 16_000)]},
        OB1=START.format(period=10) + "LD SM0.0\nINCW VW0\n----\nLDW= VW0, 3\nSTOP",
        INT0="LD SM0.0\nINCW VW2",
    )
    machine.run_until(100_000)
    assert (machine.running, count(machine), count(machine, "VW2")) == (False, 3, 0)


def test_outputs_follow_their_image_at_the_end_of_the_scan(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        =      Q0.4
        =I     Q0.5
        """
    )
    physical = machine.memory["Q physical"]
    machine.run_until(0)
    assert physical[0] == 0x20
    machine.run_until(5_000)
    assert physical[0] == 0x30


# Everything that ends a loop: the byte that is watched (VB9), outputs by the image and at once, single trains, ends
# that are events, an overflow now and then, DISI and STOP. Profile tables go their usual way, mostly: every {every}
# ticks Q0.1 gets one, which may come too early, or have a segment that is too short, or none.
BUSY = {
    "OB1": """
        LD     SM0.1
        MOVB   {period}, SMB34
        ATCH   INT0, 10
        ATCH   INT1, {event}
        ENI
        MOVW   100, SMW68
        MOVD   {pulses}, SMD72
        MOVW   600, SMW178
        MOVB   {segments}, VB600
        MOVD   {hertz}, VD601
        MOVD   90000, VD605
        MOVD   {short}, VD609
        MOVD   90000, VD613
        MOVD   {hertz}, VD617
        MOVD   {long}, VD621
        ----
        LD     SM0.0
        INCW   VW0
        MOVW   VW0, VW2
        MOVD   +2147483000, VD20
        ----
        LDW=   VW0, {overflow}
        +D     VD20, VD20
        ----
        LD     SM0.0
        MOVW   VW0, VW4
        /I     {slow}, VW4
        MOVB   VB5, VB9
        ----
        LDW=   VW0, {train}
        MOVB   16#C5, SMB67
        PLS    0
        ----
        LDW>=  VW0, {image}
        =      Q0.4
        ----
        LDW>=  VW0, {at_once}
        =I     Q0.5
        ----
        LDW=   VW0, {disabled}
        DISI
        ----
        LDW=   VW0, {stop}
        STOP
        """,
    "INT0": """
        LD     SM0.0
        INCW   VW30
        MOVD   VD30, AC0
        INCW   VW34
        ----
        LDW=   VW34, {every}
        MOVW   0, VW34
        MOVB   16#E0, SMB77
        PLS    1
        ----
        LDW>=  VW30, {turned}
        =I     Q0.5
        ----
        LDW=   VW30, {detached}
        DTCH   10
        """,
    "INT1": """
        LD     SM0.0
        INCW   VW32
        """,
}


@pytest.mark.parametrize("engine", QUICK, indirect=True)
@pytest.mark.parametrize("seed", range(60))
def test_many_scans_at_once_are_what_single_ones_are(seed: int) -> None:
    random = Random(seed)
    numbers = {name: random.randrange(2, 400) for name in ("overflow", "train", "image", "at_once", "disabled", "stop")}
    numbers |= {"period": random.choice([1, 5, 10, 200]), "event": random.choice([19, 20])}
    numbers |= {"pulses": random.randrange(1, 3000), "slow": random.choice([3, 10, 50])}
    numbers |= {"segments": random.choice([0, 1, 2, 2, 2, 2]), "hertz": random.choice([0, 30_000, 99_000])}
    numbers |= {"short": random.choice([30, 60, 100, 1000]), "long": random.choice([40, 100, 20_000])}
    numbers |= {
        "every": random.randrange(1, 9),
        "turned": random.randrange(400),
        "detached": random.choice([5, 50, 10_000]),
    }
    text = smart_text(**{name: body.format(**numbers) for name, body in BUSY.items()})
    program = lower(parse(SourceText("busy.awl", text)), timed=True)
    scan_us, ways = random.choice([900, 5000]), random.choice([("Q0.4", "Q0.5"), ("Q0.5", "Q0.4")])
    directions = dict(zip(("Q0.0", "Q0.1"), ways, strict=True))
    lateness = random.choice([None, lambda tick: tick * 7919 % 2300])
    begins = random.sample(range(300_000), random.choice([0, 0, 3, 40]))
    blocked = [(begin, begin + random.randrange(1, 9000)) for begin in begins]
    single, quick = (Smart(program, scan_us, lateness, blocked, directions=directions) for _ in range(2))
    done = 0
    while done < 260:
        batch = random.randrange(1, 60)
        left = batch
        while left:
            left -= quick.scans(left, watched=9)
        for _ in range(batch):
            single.scan()
        done += batch
        assert observed(quick) == observed(single), (seed, done, numbers)
    assert len(quick._loops) == 1


@pytest.mark.parametrize("engine", QUICK, indirect=True)
@pytest.mark.parametrize("seed", range(40))
def test_many_interrupts_at_once_are_what_single_ones_are(seed: int) -> None:
    """Up to a bit of what is recorded, or to the tick that detaches the routine; scans let trains come to their end."""
    random = Random(seed)
    numbers = {name: random.randrange(2, 60) for name in ("overflow", "train", "image", "at_once", "disabled", "stop")}
    numbers |= {"period": 200, "event": 19, "pulses": 100, "slow": 10, "segments": 2, "hertz": 99_000, "short": 100}
    numbers |= {"long": 100, "every": random.choice([3, 5, 10_000]), "turned": random.choice([70, 10_000])}
    numbers |= {"detached": random.choice([5, 50, 10_000]), "stop": random.choice([20, 10_000])}
    text = smart_text(**{name: body.format(**numbers) for name, body in BUSY.items()})
    program = lower(parse(SourceText("busy.awl", text)))
    single, quick = (Smart(program, 900, directions={"Q0.1": "Q0.5"}) for _ in range(2))
    recorded, byte = range(1, 40), 31  # low byte of VW30
    while single._scans < 30:
        for machine in (single, quick):
            machine.scan()
        batch, mask = random.randrange(1, 40), random.choice([0, 0, 4, 128])
        images = [[], []]  # type: list[list[bytes]]
        while 10 in single._attached and len(images[0]) < batch:
            single.run_interrupt(10)
            images[0].append(bytes(single.memory["V"][recorded.start : recorded.stop]))
            if single.memory["V"][byte] & mask:
                break
        while 10 in quick._attached and len(images[1]) < batch:
            data = quick.run_interrupts(10, Script(NO_SCRIPT, batch - len(images[1])), recorded, byte - 1, mask)
            images[1] += [data[at : at + len(recorded)] for at in range(0, len(data), len(recorded))]
            if quick.memory["V"][byte] & mask:
                break
        assert images[0] == images[1], (seed, numbers)
        assert observed(quick) == observed(single), (seed, numbers)
        assert bytes(quick._special) == bytes(single._special), (seed, numbers)
    assert any(quick._call_loops.values())


@pytest.mark.parametrize("engine", QUICK, indirect=True)
def test_ticks_that_start_tables_need_no_python() -> None:
    """50 scans with 25 ticks, each of which starts 1000 pulses at 100 kHz, in one go."""
    prepare = """
        LD     SM0.1
        MOVB   10, SMB34
        ATCH   INT0, 10
        ENI
        MOVW   600, SMW168
        MOVB   1, VB600
        MOVD   100000, VD601
        MOVD   100000, VD605
        MOVD   900, VD609
        MOVB   16#E0, SMB67
        """
    program = lower(parse(SourceText("a.awl", smart_text(OB1=prepare, INT0="LD SM0.0\nPLS 0"))))
    machine = Smart(program)
    machine.scan()
    machine._processor.engine.engine._serve = None  # type: ignore[attr-defined]
    assert machine.scans(50, watched=0) == 50
    segments = machine.channels["Q0.0"].segments
    assert [(s.start, s.end, s.pulses) for s in segments] == [
        (10_000.0 * n, 10_000.0 * n + 9000, 900) for n in range(1, 26)
    ]
    assert [s.train for s in segments] == list(range(25))


def test_the_loop_has_the_numbers_of_the_pulse_outputs() -> None:
    pytest.importorskip("numba", reason="the fast engine needs Numba")
    from plcgen.plc.fast import event_loop, vm

    assert event_loop.STARTS == pto.ENABLE | pto.PULSES | pto.TABLE
    for name in ("IDLE", "MOST_HZ", "SHORTEST_US", "ENTRY_BYTES"):
        assert getattr(event_loop, name) == getattr(pto, name), name
    assert (vm.QUIET, event_loop.WHOLE, event_loop.IN_MAIN, event_loop.IN_INTERRUPT) == (
        smart_loop.QUIET,
        smart_loop.WHOLE,
        smart_loop.IN_MAIN,
        smart_loop.IN_INTERRUPT,
    )


def test_scans_stop_where_the_watched_byte_changes(smart: Make) -> None:
    machine = smart({}, OB1=COUNT)
    scans = [machine.scans(1000, watched=0) for _ in range(2)]
    assert scans in ([256, 256], [1, 1])  # VB0 is the high byte of VW0; the plain engine goes scan by scan


def observed(machine: Smart) -> tuple[object, ...]:
    return (
        bytes(machine.memory[V]),
        bytes(machine.memory[PHYSICAL_OUTPUTS]),
        machine.time_us,
        machine.running,
        machine.faults,
        machine.violations,
        machine.run_times,
        [(channel.segments, channel.lost, channel.busy) for channel in machine.channels.values()],
    )


def test_estimated_run_times() -> None:
    """A contact 0.15 us, a word move 1.2 us, a REAL operation 3.6 us; a box without power costs nothing."""
    text = (
        "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD SM0.0\nMOVW +1, VW0\nCALL SBR0\nNetwork 2\nLD I0.0\n"
        "SIN 1.0, VD4\nEND_ORGANIZATION_BLOCK\n"
        "SUBROUTINE_BLOCK SBR0\nBEGIN\nNetwork 1\nLD SM0.0\n+R 1.0, VD8\nEND_SUBROUTINE_BLOCK\n"
    )
    blocks = parse(SourceText("f.awl", text))
    machine = Smart(lower(blocks, timed=True))
    machine.scan()
    assert machine.run_times["OB1"] == pytest.approx(3 * 0.15 + 1.2 + 2.0 + 3.6)
    machine = Smart(lower(blocks, timed=True), costs={**COSTS, "function": 100.0})
    machine.variable("I0.0").set(True)
    machine.scan()
    machine.variable("I0.0").set(False)
    machine.scan()
    assert machine.run_times["OB1"] == pytest.approx(3 * 0.15 + 1.2 + 2.0 + 3.6 + 100.0)


def test_each_mnemonic_has_a_cost() -> None:
    assert set(CLASSES.values()) == set(COSTS)
    assert [CLASSES[word] for word in ("LDR>=", "AR=", "ORD", "OR<", "ROUND", "INCB", "RRW", "JMP")] == [
        "real",
        "real",
        "word",
        "real",
        "conversion",
        "word",
        "word",
        "control",
    ]


def test_garbage_in_local_memory(smart: Make) -> None:
    machine = smart({"temp_fill": 0xA5}, OB1="LD SM0.0\nMOVB LB7, VB0\n")
    machine.scan()
    assert count(machine, "VB0") == 0xA5


def test_variables(smart: Make) -> None:
    machine = smart(OB1="NOP 0")
    machine.variable("VD100", REAL).set(1.5)
    assert machine.variable("vd100").get() == 0x3FC00000
    assert machine.variable("VD100", DWORD).type is DWORD
    machine.variable("VW0").set(-2)
    assert [machine.variable(path).get() for path in ("VB0", "VB1", "V1.0")] == [255, 254, False]
    assert machine.variable("VW0", WORD).get() == 65534
    machine.variable("Time_0_Intrvl").set(50)
    assert machine.variable("SMB34").get() == 50
    machine.variable("T37").set(3)
    machine.variable("AC2").set(-1)
    assert machine.variable("T37").get() == 3


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("VX1", "no variable VX1; write an address such as VD100"),
        ("Always_Onn", "no variable Always_Onn; did you mean Always_On?"),
        ("VD8190", "VD8190: VD8190 lies outside the 8192 bytes of V"),
        ("V1.9", "V1.9: V1.9: bit 9 does not exist; a byte has bits 0 to 7"),
        ("LB3", "LB3: local memory lives only while its block runs"),
        ("AC4", "AC4: AC4 does not exist; there are AC0 to AC3"),
    ],
)
def test_no_variables(smart: Make, path: str, message: str) -> None:
    with pytest.raises(PlcgenError) as caught:
        smart(OB1="NOP 0").variable(path)
    assert str(caught.value) == message
