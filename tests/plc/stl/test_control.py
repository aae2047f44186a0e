"""Program control, edges, timers, counters and calls: what one scan after another leaves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from plcgen.errors import Fault
from plcgen.plc.cpu.smart import Smart

Make = Callable[..., Smart]


def watched(machine: Smart, path: str, scans: int, inputs: dict[int, bool] | None = None) -> list[Any]:
    """The variable after each scan; `inputs` sets I0.0 before the scan of that number."""
    variable, bit = machine.variable(path), machine.variable("I0.0")
    seen = []
    for number in range(scans):
        if inputs and number in inputs:
            bit.set(inputs[number])
        machine.scan()
        seen.append(variable.get())
    return seen


def test_edges_last_one_scan(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        EU
        =      V0.0
        ----
        LD     I0.0
        ED
        =      V0.1
        """
    )
    assert watched(machine, "VB0", 6, {1: True, 3: False, 5: True}) == [0, 1, 0, 2, 0, 1]


def test_jump_skips_networks(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        JMP    3
        ----
        LD     SM0.0
        INCB   VB0
        ----
        LBL    3
        ----
        LD     SM0.0
        INCB   VB1
        """
    )
    assert watched(machine, "VW0", 3, {1: True}) == [0x0101, 0x0102, 0x0103]


LOOPS = """
    LD     SM0.0
    MOVW   +0, VW100
    ----
    LD     SM0.0
    FOR    VW0, {first}, {last}
    ----
    LD     SM0.0
    FOR    VW2, +1, +3
    ----
    LD     SM0.0
    +I     VW0, VW100
    ----
    NEXT
    ----
    NEXT
    """


@pytest.mark.parametrize(
    ("first", "last", "total", "index"), [("+1", "+4", 30, 5), ("+4", "+4", 12, 5), ("+5", "+4", 0, 5)]
)
def test_loops_inside_one_another(smart: Make, first: str, last: str, total: int, index: int) -> None:
    machine = smart(OB1=LOOPS.format(first=first, last=last))
    machine.scan()
    assert (machine.variable("VW100").get(), machine.variable("VW0").get()) == (total, index)


def test_loop_without_condition_is_skipped(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        FOR    VW0, +1, +3
        ----
        LD     SM0.0
        INCW   VW2
        ----
        NEXT
        """
    )
    assert watched(machine, "VW2", 3, {1: True, 2: False}) == [0, 3, 3]


def test_endless_loop_is_a_fault(smart: Make) -> None:
    machine = smart(
        OB1="""
        LBL    1
        ----
        LD     SM0.0
        JMP    1
        """
    )
    with pytest.raises(Fault, match="watchdog"):
        machine.scan()


def test_call_with_parameters(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        MOVW   +10, VW20
        CALL   SBR0, SM0.0, 7, +100, 1.5, VW20, V30.3, VD40
        """,
        SBR0="""
        VAR_INPUT
        on : BOOL;
        small : BYTE;   // a byte
        wide : DINT;
        factor : REAL;
        END_VAR
        VAR_IN_OUT
        total : INT;
        END_VAR
        VAR_OUTPUT
        done : BOOL;
        product : REAL;
        END_VAR
        VAR
        number : INT;
        END_VAR
        BEGIN
        LD     on
        =      done
        BTI    small, number
        +I     number, total
        DTR    wide, product
        *R     factor, product
        """,
    )
    machine.scan()
    assert machine.variable("VW20").get() == 17
    assert machine.variable("V30.3").get() is True
    assert machine.variable("VD40").get() == 0x43160000  # 150.0


def test_parameters_lie_in_local_memory_in_their_order(smart: Make) -> None:
    """Bits share a byte, all else starts at the next byte; a parameter is its address too."""
    machine = smart(
        OB1="""
        LD     SM0.0
        CALL   SBR0, SM0.0, SM0.0, 5, +7, VD0
        """,
        SBR0="""
        VAR_INPUT
        a : BOOL;
        b : BOOL;
        c : BYTE;
        d : INT;
        END_VAR
        VAR_OUTPUT
        e : DINT;
        END_VAR
        BEGIN
        LD     SM0.0
        MOVB   LB0, LB4
        MOVB   LB1, LB5
        MOVW   LW2, LW6
        """,
    )
    machine.scan()
    assert machine.variable("VD0").get() == 0x03050007


def test_call_runs_only_with_a_condition_and_keeps_the_stack(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        CALL   SBR0
        =      V9.0
        """,
        SBR0="""
        LDN    SM0.0
        =      V9.1
        LD     SM0.0
        INCB   VB0
        """,
    )
    assert watched(machine, "VB0", 3, {1: True}) == [0, 1, 2]
    assert machine.variable("VB9").get() == 1


def test_conditional_returns(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        CALL   SBR0
        ----
        LD     I0.0
        END
        ----
        LD     SM0.0
        INCB   VB1
        """,
        SBR0="""
        LD     I0.0
        CRET
        ----
        LD     SM0.0
        INCB   VB0
        """,
    )
    assert watched(machine, "VW0", 3, {1: True}) == [0x0101, 0x0101, 0x0101]


def test_stop_ends_the_run(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        WDR
        INCB   VB0
        ----
        LDB=   VB0, 2
        STOP
        INCB   VB1
        """
    )
    assert watched(machine, "VW0", 4) == [0x0100, 0x0200, 0x0200, 0x0200]
    assert not machine.running


@pytest.mark.parametrize(
    ("number", "resolution", "scans"),
    [("T32", 1, 6), ("T33", 10, 6), ("T37", 100, 60)],
)
def test_on_delay(smart: Make, number: str, resolution: int, scans: int) -> None:
    """With scans of 5 ms; the first one starts the timer."""
    machine = smart(
        OB1=f"""
        LD     I0.0
        TON    {number}, +2
        ----
        LD     {number}
        =      V0.0
        """
    )
    on = watched(machine, "V0.0", scans, {0: True})
    first = -(-2 * resolution // 5)
    assert on == [False] * first + [True] * (scans - first)
    assert watched(machine, number, 1, {0: False}) == [0]
    assert machine.variable("V0.0").get() is False


def test_off_delay(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        TOF    T97, +2
        ----
        LD     T97
        =      V0.0
        """
    )
    on = watched(machine, "V0.0", 9, {1: True, 3: False})
    assert on == [False, True, True, True, True, True, True, False, False]


def test_retentive_timer_keeps_its_value_until_reset(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        TONR   T1, +3
        ----
        LD     T1
        =      V0.0
        ----
        LD     I0.1
        R      T1, 1
        """
    )
    values = watched(machine, "T1", 12, {0: True, 3: False, 6: True})
    assert values == [0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 3, 3]
    assert machine.variable("V0.0").get() is True
    machine.variable("I0.1").set(True)
    machine.scan()
    machine.scan()
    assert machine.variable("T1").get() == 0


def test_timer_stops_at_the_end(smart: Make) -> None:
    machine = smart({"scan_us": 1_000_000}, OB1="LD SM0.0\nTON T96, +5\n")
    assert watched(machine, "T96", 40)[-1] == 32767


def test_time_between_two_places(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     First_Scan_On
        BITIM  VD0
        ----
        LD     SM0.0
        CITIM  VD0, VD4
        """
    )
    assert watched(machine, "VD4", 3) == [0, 5, 10]


def test_steps_of_a_sequence(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     First_Scan_On
        S      S0.0, 1
        ----
        LSCR   S0.0
        ----
        LD     SM0.0
        INCB   VB0
        SCRT   S0.1
        ----
        SCRE
        ----
        LSCR   S0.1
        ----
        LDN    I0.0
        CSCRE
        ----
        LD     SM0.0
        INCB   VB1
        SCRT   S0.0
        ----
        SCRE
        """
    )
    assert watched(machine, "VW0", 5, {1: True}) == [0x0100, 0x0101, 0x0202, 0x0303, 0x0404]


COUNTED = {1: True, 2: False, 3: True, 4: False, 5: True, 6: False, 7: True}


def test_count_up(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        LD     I0.1
        CTU    C1, +2
        ----
        LD     C1
        =      V0.0
        """
    )
    assert watched(machine, "C1", 8, COUNTED) == [0, 1, 1, 2, 2, 3, 3, 4]
    assert machine.variable("V0.0").get() is True
    machine.variable("I0.1").set(True)
    assert watched(machine, "C1", 1) == [0]
    assert machine.variable("V0.0").get() is False


def test_count_down(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        LD     First_Scan_On
        CTD    C2, +3
        ----
        LD     C2
        =      V0.0
        """
    )
    assert watched(machine, "C2", 9, COUNTED) == [3, 2, 2, 1, 1, 0, 0, 0, 0]
    assert machine.variable("V0.0").get() is True


def test_count_both_ways(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     I0.0
        LDN    I0.0
        LD     I0.1
        CTUD   C3, +1
        """
    )
    assert watched(machine, "C3", 5, COUNTED) == [-1, 0, -1, 0, -1]


def test_pointer_to_nowhere_stops_the_run(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        MOVD   &VB8190, AC1
        MOVB   1, *AC1
        +D     +2, AC1
        MOVB   1, *AC1
        """
    )
    with pytest.raises(Fault) as caught:
        machine.scan()
    assert str(caught.value) == (
        "f.awl:8:1: OB1: pointer 16#08002000 points nowhere; set it with MOVD &VB..., AC1 and keep it in its area "
        "(scan 0)\n    MOVB   1, *AC1\n    ^^^^^^^^^^^^^^"
    )


def test_count_beyond_the_end_of_an_area_stops_the_run(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        MOVB   9, VB0
        BMB    VB0, MB24, VB0
        """
    )
    with pytest.raises(Fault, match=r"N = 9 reaches beyond the end of an area; 8 is the most"):
        machine.scan()


def test_arithmetic_events_are_recorded(smart: Make) -> None:
    machine = smart(
        OB1="""
        LD     SM0.0
        /R     0.0, VD0
        MOVR   1.0, VD0
        /R     0.0, VD0
        MOVW   +32767, VW4
        INCW   VW4
        /I     +0, VW4
        SQRT   -1.0, VD8
        """
    )
    machine.scan()
    assert [(fault.kind, fault.location.line) for fault in machine.faults] == [
        ("invalid operand", 5),
        ("division by zero", 7),
        ("overflow", 9),
        ("division by zero", 10),
        ("invalid operand", 11),
    ]
