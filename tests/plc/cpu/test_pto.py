"""Pulse outputs of the S7-200 SMART: tables, single segments, pipeline, stops, and where every pulse is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plcgen.errors import Fault
from plcgen.plc.cpu.pto import Channel, Segment
from plcgen.plc.cpu.smart import Smart

Make = Callable[..., Smart]


def table(segments: list[tuple[int, int, int]], channel: int = 0) -> str:
    """STL that writes a profile table at VB500 and starts it."""
    lines = [
        f"MOVB {len(segments)}, VB500",
        f"MOVW +500, SMW{168 + 10 * channel}",
        f"MOVB 16#E0, SMB{67 + 10 * channel}",
    ]
    for number, entry in enumerate(segments):
        lines += [f"MOVD +{value}, VD{501 + 12 * number + 4 * place}" for place, value in enumerate(entry)]
    return "\n".join([*lines, f"PLS {channel}", ""])


def once(body: str) -> str:
    return f"LD SM0.1\n{body}"


SINGLE = """
    MOVB   16#C5, SMB67
    MOVW   +{hz}, SMW68
    MOVD   +{pulses}, SMD72
    PLS    0
    """


def single(hz: int, pulses: int) -> str:
    return SINGLE.format(hz=hz, pulses=pulses)


def messages(machine: Smart) -> list[str]:
    return [str(violation) for violation in machine.violations]


def test_table_of_three_segments(smart: Make) -> None:
    machine = smart(OB1=once(table([(1000, 3000, 100), (3000, 3000, 300), (3000, 1000, 100)])))
    channel = machine.channels["Q0.0"]
    machine.run_until(49_999)
    assert channel.busy
    assert [machine.variable(path).get() for path in ("PLS0_Idle", "PTO0_Seg_Num")] == [False, 1]
    machine.run_until(60_000)
    assert machine.variable("PTO0_Seg_Num").get() == 2
    machine.run_until(205_000)
    assert not channel.busy
    assert [machine.variable(path).get() for path in ("PLS0_Idle", "PTO0_Seg_Num")] == [True, 0]
    assert channel.segments == [
        Segment(0, 0.0, 50_000.0, 100, 1000, 3000),
        Segment(0, 50_000.0, 150_000.0, 300, 3000, 3000),
        Segment(0, 150_000.0, 200_000.0, 100, 3000, 1000),
    ]
    # 1000 Hz, rising by 40000 Hz/s: 1000 t + 20000 t^2
    times = np.array([-5, 0, 25_000, 49_999, 50_000, 100_000, 200_000, 10**9])
    assert channel.position_at(times).tolist() == [0, 0, 37, 99, 100, 250, 500, 500]
    assert (machine.violations, channel.lost) == ([], 0)


def test_status_is_ready_before_any_program_text(smart: Make) -> None:
    machine = smart(OB1="LD SM66.7\nA SM76.7\nA SM566.7\n= V0.0")
    machine.scan()
    assert machine.variable("V0.0").get() is True


def test_clamped_values(smart: Make) -> None:
    machine = smart(OB1=once(table([(0, 0, 0), (2_000_000, 100_001, 1000)])))
    machine.scan()
    first, second = machine.channels["Q0.0"].segments
    assert (first.first_hz, first.last_hz, first.pulses, first.duration) == (1, 1, 1, 1_000_000.0)
    assert (second.first_hz, second.last_hz, second.pulses) == (100_000, 100_000, 1000)


def test_short_segment_stops_the_output(smart: Make) -> None:
    machine = smart(OB1=once(table([(1000, 1000, 10), (10_000, 10_000, 4), (1000, 1000, 5)])))
    channel = machine.channels["Q0.0"]
    machine.run_until(9_999)
    assert channel.busy
    machine.run_until(10_000)
    machine.run_until(15_000)
    assert not channel.busy
    assert [machine.variable(path).get() for path in ("PLS0_Ovr", "PLS0_Idle")] == [True, True]
    assert channel.position_at(np.array([20_000])).tolist() == [10]
    assert channel.lost == 9
    assert messages(machine) == [
        "Q0.0 at 0 us: segment 2 lasts 400.0 us, less than 500: the output stops (9 pulses lost)"
    ]


def test_segment_of_exactly_500_us_is_good(smart: Make) -> None:
    machine = smart(OB1=once(table([(10_000, 10_000, 5)])))
    machine.scan()
    assert (machine.violations, machine.channels["Q0.0"].lost) == ([], 0)


def test_table_started_while_one_runs_loses_the_rest(smart: Make) -> None:
    machine = smart({"scan_us": 10_000}, OB1="LD SM0.0\n" + table([(1000, 1000, 15)]))
    machine.run_until(19_999)
    channel = machine.channels["Q0.0"]
    assert channel.segments[0].truncated_at == 10_000.0
    assert channel.position_at(np.array([5_000, 10_000, 12_000, 19_999])).tolist() == [5, 10, 12, 19]
    assert channel.lost == 5
    assert machine.variable("PLS0_Ovr").get() is True
    assert messages(machine) == ["Q0.0 at 10000 us: PLS while a train runs: the rest of it is lost (5 pulses)"]


def test_empty_table(smart: Make) -> None:
    machine = smart(OB1=once(table([])))
    machine.scan()
    assert machine.channels["Q0.0"].segments == []
    assert messages(machine) == ["Q0.0 at 0 us: profile table with 0 segments: no pulses"]


def test_table_beyond_memory(smart: Make) -> None:
    machine = smart(OB1=once("MOVW +8190, SMW168\nMOVB 1, VB8190\nMOVB 16#E0, SMB67\nPLS 0\n"))
    with pytest.raises(Fault, match=r"Q0\.0: profile table at VB8190 reaches beyond V memory; mend SMW168"):
        machine.scan()


def test_pulse_width_modulation_is_refused(smart: Make) -> None:
    machine = smart(OB1=once("MOVB 16#83, SMB77\nPLS 1\n"))
    with pytest.raises(Fault) as caught:
        machine.scan()
    assert str(caught.value) == (
        "f.awl:6:1: OB1: Q0.1: PWM is not modelled; set bit .6 of SMB77 for a pulse train (scan 0)"
        "\n    PLS 1\n    ^^^^^"
    )


def test_single_segments_join_without_a_gap(smart: Make) -> None:
    machine = smart({"scan_us": 10_000}, OB1="LDB< VB0, 2\nINCB VB0\n" + single(1000, 15))
    channel = machine.channels["Q0.0"]
    machine.run_until(30_000)
    assert [(s.start, s.end, s.train) for s in channel.segments] == [(0.0, 15_000.0, 0), (15_000.0, 30_000.0, 1)]
    assert channel.position_at(np.array([14_000, 16_000, 40_000])).tolist() == [14, 16, 30]
    assert machine.violations == []


def test_one_load_waits_and_no_more(smart: Make) -> None:
    machine = smart({"scan_us": 1_000}, OB1="LDB< VB0, 3\nINCB VB0\n" + single(1000, 15))
    machine.run_until(40_000)
    channel = machine.channels["Q0.0"]
    assert (len(channel.segments), channel.lost) == (2, 15)
    assert machine.variable("PLS0_Ovr").get() is True
    assert messages(machine) == ["Q0.0 at 2000 us: pipeline full: a load of 15 pulses is lost"]


def test_only_updated_values_are_loaded(smart: Make) -> None:
    body = once(single(1000, 15) + "MOVB 16#C4, SMB67\nMOVW +9, SMW68\nMOVD +5, SMD72\nPLS 0\n")
    machine = smart({"scan_us": 10_000}, OB1=body)
    machine.run_until(40_000)
    assert [(s.first_hz, s.pulses) for s in machine.channels["Q0.0"].segments] == [(1000, 15), (1000, 5)]


def test_stop_by_clearing_enable(smart: Make) -> None:
    body = once(table([(1000, 1000, 15), (1000, 1000, 5)])) + "\nLDN SM0.1\nMOVB 16#60, SMB67\nPLS 0\n"
    machine = smart({"scan_us": 10_500}, OB1=body.replace("\nLDN", "\n----\nLDN"))
    machine.run_until(10_500)
    channel = machine.channels["Q0.0"]
    assert not channel.busy
    assert [machine.variable(path).get() for path in ("SM66.5", "PLS0_Idle")] == [True, True]
    assert (channel.lost, channel.segments[-1].sent, channel.segments[-1].truncated_at) == (10, 10, 10_500.0)
    assert channel.instants().tolist() == [1000.0 * k for k in range(1, 11)]
    assert machine.violations == []


def test_complete_events(smart: Make) -> None:
    """Each train raises its event when it is over; the status is idle then."""
    machine = smart(
        OB1=once("ATCH INT0, 19\nATCH INT1, 20\nENI\n" + single(1000, 7) + table([(3000, 3000, 30)], channel=1)),
        INT0="LD SM66.7\nINCB VB0\n",
        INT1="LD PLS1_Idle\nINCB VB1\n",
    )
    machine.run_until(6_999)
    assert machine.variable("VW0").get() == 0
    machine.run_until(7_000)
    assert machine.variable("VW0").get() == 0x0100
    machine.run_until(10_000)
    assert machine.variable("VW0").get() == 0x0101


def test_third_output(smart: Make) -> None:
    machine = smart(OB1=once("MOVB 16#C5, SMB567\nMOVW +100, SMW568\nMOVD +2, SMD572\nPLS 2\n"))
    machine.run_until(30_000)
    assert machine.channels["Q0.3"].position_at(np.array([30_000])).tolist() == [2]


DIRECTION = {"directions": {"Q0.0": "Q0.4"}, "scan_us": 10_000}


def test_direction_is_that_of_the_output_when_the_train_begins(smart: Make) -> None:
    """`=` reaches the output at the end of the scan only: the first train still runs forwards."""
    machine = smart(DIRECTION, OB1="LD SM0.0\n= Q0.4\n----\nLDB< VB0, 2\nINCB VB0\n" + table([(1000, 1000, 5)]))
    machine.run_until(30_000)
    channel = machine.channels["Q0.0"]
    assert [segment.direction for segment in channel.segments] == [False, True]
    assert channel.position_at(np.array([5_000, 9_999, 12_000, 30_000])).tolist() == [5, 5, 3, 0]
    assert machine.violations == []


def test_direction_changed_at_once(smart: Make) -> None:
    machine = smart(DIRECTION, OB1="LD SM0.0\n=I Q0.4\n----\nLD SM0.1\n" + table([(1000, 1000, 5)]))
    machine.run_until(30_000)
    assert machine.channels["Q0.0"].position_at(np.array([30_000])).tolist() == [-5]


def test_direction_changed_under_a_running_train(smart: Make) -> None:
    body = once(table([(1000, 1000, 15)])) + "----\nLDN SM0.1\n=I Q0.4\n"
    machine = smart(DIRECTION, OB1=body)
    machine.run_until(30_000)
    assert messages(machine) == ["Q0.0 at 10000 us: direction output changed while a train runs"]


def test_idle_exactly_at_the_tick(smart: Make) -> None:
    """N pulses at N / T Hz end with the sample: the next tick finds the output idle."""
    machine = smart(
        OB1=once("MOVB 20, SMB34\nATCH INT0, 10\nENI\n"),
        INT0="LDN SM66.7\nINCB VB0\nLD SM0.0\n" + table([(3000, 5000, 80)]),
    )
    machine.run_until(2_000_000)
    assert (machine.violations, machine.variable("VB0").get(), len(machine.channels["Q0.0"].segments)) == ([], 0, 100)


@settings(max_examples=200, deadline=None)
@given(first=st.integers(1, 100_000), last=st.integers(1, 100_000), pulses=st.integers(1, 3000))
def test_instants_and_positions_agree(first: int, last: int, pulses: int) -> None:
    duration = 2_000_000 * pulses / (first + last)
    segment = Segment(0, 1000.0, 1000.0 + duration, pulses, first, last)
    instants = segment.instants()
    assert len(instants) == pulses
    assert np.all(np.diff(instants) > 0)
    assert instants[-1] == pytest.approx(segment.end, rel=1e-9)
    channel = Channel("Q0.0", bytearray(2048), bytearray(8192), lambda _violation: None)
    channel.segments.append(segment)
    half = np.diff(np.concatenate([[1000.0], instants])) / 2
    assert channel.position_at(instants - half).tolist() == list(range(pulses))
    assert channel.position_at(np.append(instants[:-1] + half[1:], 1e12)).tolist() == list(range(1, pulses + 1))
    assert [segment.sent_by(time) for time in (instants - half)[:50]] == list(range(min(pulses, 50)))
