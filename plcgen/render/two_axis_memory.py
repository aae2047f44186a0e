"""The memory map of the two-axis program: its variables and bits in V memory, in the order of their addresses."""

from __future__ import annotations

from plcgen.job import Job
from plcgen.profile.two_axis import SHORTEST_JERK_TIME
from plcgen.render.smart_memory import Bit, MemoryMap, Variable

MOST_SEGMENTS = 255
# Table mode: the time of a move over SHARE is the longest segment, so that 7 phases have SHARE + 7 of them; what is
# left of the table is for phases of jerk that would have fewer than LEAST_JERK.
SHARE, LEAST_JERK = 200, 12
FINEST, SHORTEST = 0.01, SHORTEST_JERK_TIME  # s
STEPS = 4  # segments of each axis in one scan


# Order, parameters, plan and state in the order of their addresses. {u} is the length unit.
COMMON = (
    Variable("distance_x", "DistanceX", "DINT", "pulses to go in x, with sign: set before Start"),
    Variable("distance_y", "DistanceY", "DINT", "pulses to go in y, with sign: set before Start"),
    Variable("command", "Command", "BYTE", "commands, see the bits"),
    Variable("status", "Status", "BYTE", "status, see the bits"),
    Variable("error", "ErrorCode", "BYTE", "why the last start was refused, 0 = none"),
    Variable("flags", "Flags", "BYTE", "how the move runs, see the bits"),
    Variable("done_x", "DoneX", "DINT", "pulses sent in x since the start, without sign"),
    Variable("done_y", "DoneY", "DINT", "pulses sent in y since the start, without sign"),
    Variable("ignore", "Ignore", "DINT", "pulses; a shorter component counts as zero"),
    Variable("v_max", "VMax", "REAL", "{u}/s, speed of the leading axis"),
    Variable("a_max", "AMax", "REAL", "{u}/s2, acceleration of the leading axis"),
    Variable("beta", "Beta", "REAL", "{u}/s3, jerk of the leading axis"),
    Variable("t_sample", "TSample", "REAL", "s, sample period"),
    Variable("ppu_x", "PpuX", "REAL", "1/{u}"),
    Variable("ppu_y", "PpuY", "REAL", "1/{u}"),
    Variable("t1_full", "T1Full", "REAL", "s, t1 at full speed (3)"),
    Variable("t2_full", "T2Full", "REAL", "s, t2 at full speed (7)"),
    Variable("s_jerk", "SJerk", "REAL", "{u}, shortest distance that reaches AMax"),
    Variable("s_full", "SFull", "REAL", "{u}, shortest distance that reaches VMax (17)"),
    Variable("a_t", "AT", "REAL", "{u}/s, a_max T (22)"),
    Variable("beta_t2", "BetaT2", "REAL", "{u}/s, beta T^2/2 (21)"),
    Variable("train_rate", "TrainRate", "REAL", "1/s, samples for a second of pulses sent"),
    Variable("lead", "Lead", "DINT", "pulses of the leading axis"),
    Variable("follow", "Follow", "DINT", "pulses of the other axis"),
    Variable("ppu_lead", "PpuLead", "REAL", "1/{u}, of the leading axis"),
    Variable("gamma", "Gamma", "REAL", "pulses of the other axis for one of the leading axis"),
    Variable("way", "Way", "REAL", "{u}, distance of the leading axis"),
    Variable("t1", "T1", "REAL", "s, time of each phase of jerk"),
    Variable("t2", "T2", "REAL", "s, time of each phase of constant acceleration"),
    Variable("t4", "T4", "REAL", "s, time at constant speed (18)"),
    Variable("total", "TotalTime", "REAL", "s, 4 t1 + 2 t2 + t4"),
    Variable("n1", "N1", "REAL", "samples, t1 stretched to N whole samples"),
    Variable("n12", "N12", "REAL", "samples, t1 + t2 stretched"),
    Variable("n3", "N3", "REAL", "samples, 2 t1 + t2 stretched: end of the acceleration"),
    Variable("v", "V", "REAL", "pulses/sample, speed reached"),
    Variable("a_half", "AHalf", "REAL", "pulses/sample2, half the acceleration reached"),
    Variable("j_sixth", "JSixth", "REAL", "pulses/sample3, a sixth of the jerk"),
    Variable("p1", "P1", "REAL", "pulses at the end of phase 1"),
    Variable("v1", "V1", "REAL", "pulses/sample at the end of phase 1"),
    Variable("p3", "P3", "REAL", "pulses at the end of phase 3"),
    Variable("n_cruise", "NCruise", "DINT", "samples between the two ends of constant speed, 0 = none"),
    Variable("q_lead", "QLead", "DINT", "whole pulses a sample at constant speed, leading axis"),
    Variable("r_lead", "RLead", "DINT", "pulses that are left over in NCruise samples"),
    Variable("e_lead", "ELead", "DINT", "sum of what is left over"),
    Variable("q_follow", "QFollow", "DINT", "the same three of the other axis"),
    Variable("r_follow", "RFollow", "DINT", "see RLead"),
    Variable("e_follow", "EFollow", "DINT", "see ELead"),
    Variable("done_lead", "DoneLead", "DINT", "pulses sent by the leading axis"),
    Variable("done_follow", "DoneFollow", "DINT", "pulses sent by the other axis"),
    Variable("to_lead", "ToLead", "DINT", "pulses that the leading axis must have sent by now"),
    Variable("to_follow", "ToFollow", "DINT", "pulses that the other axis must have sent by now"),
    Variable("speed", "Speed", "REAL", "pulses/sample at the end of the sample"),
    Variable("accel", "Accel", "REAL", "pulses/sample2 at the end of the sample"),
    Variable("x", "Arg", "REAL", "samples from the near end: argument of Evaluate"),
    Variable("p", "Pos", "REAL", "pulses from the near end: result of Evaluate"),
    Variable("pulses", "TrainCount", "DINT", "pulses of a train: argument of Train"),
    Variable("f_start", "TrainStart", "DINT", "Hz, its start frequency: argument and result"),
    Variable("f_end", "TrainEnd", "DINT", "Hz, its end frequency: result of Train"),
    Variable("f_begin_lead", "StartLead", "REAL", "Hz, start frequency of the leading axis"),
    Variable("h1", "Help1", "REAL", "intermediate result"),
    Variable("h2", "Help2", "REAL", "intermediate result"),
    Variable("h3", "Help3", "DINT", "intermediate result"),
)
INTERRUPT = (
    Variable("samples", "Samples", "DINT", "N, samples of the move"),
    Variable("k_cruise", "KCruise", "DINT", "first sample at constant speed"),
    Variable("k", "K", "DINT", "samples run"),
    Variable("base_lead", "BaseLead", "DINT", "DoneLead where a stop began"),
    Variable("base_follow", "BaseFollow", "DINT", "DoneFollow where a stop began"),
    Variable("speed_before", "SpeedBefore", "REAL", "pulses/sample at its begin"),
    Variable("peak", "StopPeak", "REAL", "pulses/sample2, deceleration of a stop"),
    Variable("m_stop", "StopJerk", "REAL", "pulses/sample3, jerk of a stop"),
    Variable("v_stop", "StopV", "REAL", "pulses/sample where a stop begins"),
    Variable("a_stop", "StopA", "REAL", "pulses/sample2 where a stop begins"),
    Variable("s1_stop", "StopN1", "REAL", "samples, end of the first phase of a stop"),
    Variable("s2_stop", "StopN2", "REAL", "samples, end of the second"),
    Variable("s3_stop", "StopN3", "REAL", "samples, end of the stop"),
    Variable("vc_stop", "StopVc", "REAL", "pulses/sample at the end of the first phase"),
    Variable("x1_stop", "StopX1", "REAL", "pulses at the end of the first phase"),
    Variable("x3_stop", "StopX3", "REAL", "pulses of the whole stop"),
    Variable("table_x", "TableX", "TABLE", "profile table of x: one segment"),
    Variable("table_y", "TableY", "TABLE", "profile table of y: one segment"),
)
TABLE = (
    Variable("stage", "Stage", "BYTE", "phase that is being built, 8 = all"),
    Variable("spare", "Spare", "BYTE", "keeps what follows at an even address"),
    Variable("loop", "Loop", "WORD", "counts the segments of a call"),
    Variable("q", "Q", "DINT", "segments of the stage"),
    Variable("m_now", "MNow", "DINT", "segments the stage has"),
    Variable("h_now", "HNow", "REAL", "s, duration of each"),
    Variable("m_jerk", "MJerk", "DINT", "segments of a phase of jerk"),
    Variable("m_acc", "MAcc", "DINT", "segments of a phase of constant acceleration"),
    Variable("h_jerk", "HJerk", "REAL", "s, duration of a segment of jerk"),
    Variable("h_acc", "HAcc", "REAL", "s, duration of a segment of constant acceleration"),
    Variable("h_cruise", "HCruise", "REAL", "s, duration of a segment of constant speed"),
    Variable("least_jerk", "LeastJerk", "DINT", "segments that a phase of jerk has even in a long move"),
    Variable("share", "Share", "REAL", "segments that the time of a move is divided by"),
    Variable("grain", "Grain", "REAL", "s, longest segment of the move"),
    Variable("finest", "Finest", "REAL", "s, segments are planned no shorter than this"),
    Variable("shortest", "Shortest", "REAL", "s, shortest segment that is sent"),
    Variable("longest", "Longest", "REAL", "s, longest move"),
    Variable("slowest", "Slowest", "REAL", "Hz, lowest mean rate of an axis"),
    Variable("pending_lead", "WaitLead", "REAL", "s since the last segment, leading axis"),
    Variable("pending_follow", "WaitFollow", "REAL", "s since the last segment, other axis"),
    Variable("lag_lead", "LagLead", "REAL", "s that whole Hz have cost, leading axis"),
    Variable("lag_follow", "LagFollow", "REAL", "s that whole Hz have cost, other axis"),
    Variable("begin_lead", "BeginLead", "REAL", "Hz at the last boundary, leading axis"),
    Variable("begin_follow", "BeginFollow", "REAL", "Hz at the last boundary, other axis"),
    Variable("segments_lead", "CountLead", "DINT", "segments built, leading axis"),
    Variable("segments_follow", "CountFollow", "DINT", "segments built, other axis"),
    Variable("ptr_lead", "NextLead", "DINT", "next entry of the table, leading axis"),
    Variable("ptr_follow", "NextFollow", "DINT", "next entry of the table, other axis"),
    Variable("pace_follow", "SpeedFollow", "REAL", "pulses/s at the end of the segment, other axis"),
    Variable("h4", "Help4", "REAL", "intermediate result"),
    Variable("table_x", "TableX", "PROFILE", "profile table of x"),
    Variable("table_y", "TableY", "PROFILE", "profile table of y"),
)
BLOCKS = {"TABLE": 14, "PROFILE": 2 + 12 * MOST_SEGMENTS}  # bytes

BITS = (
    Bit("command", 0, "stop", "Stop", "1: come to rest within the limits"),
    Bit("status", 0, "busy", "Busy", "a move is under way"),
    Bit("status", 1, "done", "Done", "the last move has arrived"),
    Bit("status", 2, "refused", "Refused", "the last start was refused, see ErrorCode"),
    Bit("status", 3, "stopped", "Stopped", "the last move ended by a stop: see DoneX and DoneY"),
    Bit(
        "status",
        4,
        "overrun",
        "Overrun",
        "a train was still running at a tick: the sample came late, no pulse was lost",
    ),
    Bit("status", 5, "short", "ShortMove", "the move does not reach full speed: t_l <= 4 t1 + 2 t2"),
    Bit("status", 6, "ready", "Ready", "the parameters have been checked"),
    Bit("status", 7, "killed", "Killed", "emergency stop: how many pulses were sent is unknown"),
    Bit("flags", 0, "x_leads", "XLeads", "x goes farther than y"),
    Bit("flags", 1, "stopping", "Stopping", "a stop is under way"),
    Bit("flags", 2, "back", "BackHalf", "the sample is counted from the end"),
    Bit("flags", 3, "steady", "Steady", "the sample lies between the ends of constant speed"),
    Bit("flags", 4, "running", "Running", "a train has not ended yet"),
    Bit("flags", 6, "follows", "Follows", "Train works for the axis that follows"),
    Bit("flags", 7, "constant", "OneRate", "the pulses of this sample have one frequency"),
    Bit("flags", 5, "launched", "Launched", "the tables have been started"),
)


def variables(job: Job) -> tuple[Variable, ...]:
    """The memory map of the mode."""
    return COMMON + (TABLE if job.two_axis.mode == "table" else INTERRUPT)


def layout(job: Job) -> MemoryMap:
    """Where everything lies."""
    return MemoryMap(job.two_axis.v_memory, variables(job), BITS, BLOCKS)


def memory_map(job: Job) -> dict[str, str]:
    """Address of every variable and bit by its name in the templates."""
    addresses = layout(job).addresses()
    addresses["pace_lead"] = addresses["speed"]
    for axis in ("lead", "follow"):
        if f"segments_{axis}" in addresses:
            addresses[f"segments_{axis}_low"] = f"VB{int(addresses[f'segments_{axis}'][2:]) + 3}"
    return addresses


def refuse_what_does_not_fit(job: Job) -> None:
    """V memory and the length of symbols. Raises JobError."""
    layout(job).refuse_what_does_not_fit(job, "two-axis.v_memory")
