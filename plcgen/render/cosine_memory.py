"""The memory map of the cosine programs: their variables and bits in V memory, in the order of their addresses."""

from __future__ import annotations

from plcgen.job import Job
from plcgen.render.smart_memory import Bit, MemoryMap, Variable

# {u} is the length unit. What the user writes and reads comes first.
ORDER = (
    Variable("command", "Command", "BYTE", "commands, see the bits"),
    Variable("status", "Status", "BYTE", "status, see the bits"),
    Variable("status_word", "StatusWord", "WORD", "status, see the head of the sample"),
)
RAMP_ORDER = (
    Variable("target_velocity", "TargetVel", "REAL", "{u}/s, read at the rising edge of Execute"),
    Variable("actual_velocity", "ActualVel", "REAL", "{u}/s, from the drive, taken over while Restart is 1"),
)
MOVE_ORDER = (Variable("distance", "Distance", "REAL", "{u}, with its sign, read at the rising edge of Execute"),)
OUTPUTS = (
    Variable("cycle_time", "CycleTime", "REAL", "s between two samples, read at the rising edge of Execute"),
    Variable("setpoint", "Setpoint", "REAL", "{u}/s, setpoint of the speed"),
    Variable("acceleration", "Accel", "REAL", "{u}/s2, feed-forward"),
    Variable("velocity", "Velocity", "REAL", "{u}/s, speed before the average"),
    Variable("state", "State", "BYTE", "what is under way, see the bits"),
    Variable("flags", "Flags", "BYTE", "flags of a sample, see the bits"),
    Variable("result", "Result", "WORD", "how the last order ended"),
)
RAMP_PARAMETERS = (
    Variable("max_velocity", "MaxVel", "REAL", "{u}/s, highest speed, either way"),
    Variable("min_cycle", "MinCycle", "REAL", "s, shortest plausible cycle"),
    Variable("max_cycle", "MaxCycle", "REAL", "s, longest plausible cycle"),
    Variable("law_1", "Law1", "REAL", "s(y) = y (Law1 - y^2 (Law2 - y^2 (Law3 - y^2 Law4)))"),
    Variable("law_2", "Law2", "REAL", "see Law1"),
    Variable("law_3", "Law3", "REAL", "see Law1"),
    Variable("law_4", "Law4", "REAL", "see Law1"),
    Variable("time_by_acc", "TimeByAcc", "REAL", "s per {u}/s, Ta/dv that keeps the acceleration"),
    Variable("square_by_jerk", "SqByJerk", "REAL", "s2 per {u}/s, Ta^2/dv that keeps the jerk"),
    Variable("settle_time", "SettleTime", "REAL", "s per {u}/s2, to end an acceleration, by the jerk"),
    Variable("counts", "Counts", "REAL", "1/({u}/s), counts for a unit of speed"),
    Variable("count_value", "CountValue", "REAL", "{u}/s, what a count adds to the average"),
    Variable("count_speed", "CountSpeed", "REAL", "{u}/s, speeds nearer than this are one"),
)
MOVE_PARAMETERS = (
    Variable("min_distance", "MinDist", "REAL", "{u}, shortest move"),
    Variable("max_distance", "MaxDist", "REAL", "{u}, longest move"),
    Variable("min_cycle", "MinCycle", "REAL", "s, shortest plausible cycle"),
    Variable("max_cycle", "MaxCycle", "REAL", "s, longest plausible cycle"),
    Variable("law_1", "Law1", "REAL", "u(x) = x (Law1 - x^2 (Law2 - x^2 (Law3 - x^2 Law4)))"),
    Variable("law_2", "Law2", "REAL", "see Law1"),
    Variable("law_3", "Law3", "REAL", "see Law1"),
    Variable("law_4", "Law4", "REAL", "see Law1"),
    Variable("sum_1", "Sum1", "REAL", "sum of the samples over N: 1 + Sum1/N^2 + Sum2/N^4 + Sum3/N^6"),
    Variable("sum_2", "Sum2", "REAL", "see Sum1"),
    Variable("sum_3", "Sum3", "REAL", "see Sum1"),
    Variable("time_by_velocity", "TimeByVel", "REAL", "s/{u}, Tm/D that keeps the speed"),
    Variable("square_by_acc", "SqByAcc", "REAL", "s2/{u}, Tm^2/D that keeps the acceleration"),
    Variable("cube_by_jump", "CubeByJump", "REAL", "s3/{u}, Tm^2 T/D that keeps the jerk at the ends"),
    Variable("cube_by_jerk", "CubeByJerk", "REAL", "s3/{u}, Tm^3/D that keeps the jerk in between"),
    Variable("level_samples", "LevelCount", "REAL", "samples for which a stop holds the speed"),
    Variable("counts", "Counts", "REAL", "1/({u}/s), counts for a unit of speed"),
    Variable("count_value", "CountValue", "REAL", "{u}/s, what a count adds to the average"),
)
LAW = (
    Variable("cycle", "Cycle", "REAL", "s, plausible cycle time"),
    Variable("step", "K", "DINT", "k, samples since the begin of the law"),
    Variable("steps", "N", "DINT", "N, its samples"),
)
RAMP_LAW = (
    Variable("ordered", "Ordered", "REAL", "{u}/s, speed that is ordered"),
    Variable("base", "Base", "REAL", "{u}/s, speed at y = 0"),
    Variable("change", "Change", "REAL", "{u}/s, change of speed from y = 0 to y = 1"),
    Variable("end", "EndVel", "REAL", "{u}/s, speed at the end of the law"),
    Variable("rate", "Rate", "REAL", "{u}/s, change of speed in a sample"),
    Variable("y", "ArgY", "REAL", "argument of the law"),
)
MOVE_LAW = (
    Variable("length", "Length", "REAL", "{u}, absolute distance"),
    Variable("peak", "Peak", "REAL", "{u}/s, speed for u = 1"),
    Variable("inverse", "Inverse", "REAL", "1/N^2"),
    Variable("divisor", "Divisor", "REAL", "s, distance over speed for u = 1"),
    Variable("x", "ArgX", "REAL", "argument of the law"),
    Variable("share", "Share", "REAL", "of the distance, until rest after a stop"),
    Variable("left", "LevelLeft", "WORD", "samples left at constant speed"),
)
AVERAGE = (
    Variable("square", "ArgSquare", "REAL", "square of the argument"),
    Variable("time", "LawTime", "REAL", "s, duration of the law"),
    Variable("samples", "Samples", "REAL", "N before it is rounded up"),
    Variable("twice", "Twice", "DINT", "intermediate result: 2 k and the like"),
    Variable("h1", "Help1", "REAL", "intermediate result"),
    Variable("h2", "Help2", "REAL", "intermediate result"),
    Variable("fresh", "Fresh", "WORD", "samples until the average has caught up"),
    Variable("loop", "Loop", "WORD", "counts the places of the ring"),
    Variable("count", "Count", "DINT", "speed in whole counts"),
    Variable("delta", "Delta", "DINT", "change of the sum in this sample"),
    Variable("sum", "RingSum", "DINT", "sum of the ring"),
    Variable("offset", "RingOffset", "DINT", "bytes from the begin of the ring to the oldest count"),
    Variable("ring", "Ring", "RING", "counts of the last speeds, a double word each"),
)
RAMP = (*ORDER, *RAMP_ORDER, *OUTPUTS, *RAMP_PARAMETERS, *LAW, *RAMP_LAW, *AVERAGE)
MOVE = (*ORDER, *MOVE_ORDER, *OUTPUTS, *MOVE_PARAMETERS, *LAW, *MOVE_LAW, *AVERAGE)
BYTES_OF_A_COUNT = 4

_BITS = (
    Bit("command", 0, "execute", "Execute", "rising edge: begin"),
    Bit("command", 2, "stop", "Stop", "1: come to rest, take no order"),
    Bit("command", 3, "restart", "Restart", "1: as after a start of the CPU"),
    Bit("status", 0, "busy", "Busy", "an order is in progress"),
    Bit("status", 1, "done", "Done", "the order is carried out; as long as Execute, one sample at least"),
    Bit("status", 2, "aborted", "Aborted", "ended by Stop; as long as Execute, one sample at least"),
    Bit("status", 3, "error", "Error", "order refused, see StatusWord; as long as Execute, one sample at least"),
    Bit("status", 4, "steady", "Steady", "the setpoint does not change"),
    Bit("status", 5, "standstill", "Standstill", "the setpoint is exactly zero and does not change"),
    Bit("state", 0, "active", "Active", "an order is in progress"),
    Bit("state", 1, "exec_before", "ExecBefore", "Execute of the last sample"),
    Bit("flags", 0, "start", "Start", "rising edge of Execute"),
    Bit("flags", 1, "first", "First", "first sample of an order"),
    Bit("flags", 2, "running", "Running", "the law goes on"),
)
RAMP_BITS = (
    *_BITS,
    Bit("command", 1, "hold", "Hold", "1: keep the speed"),
    Bit("state", 2, "pending", "Pending", "the ramp of the order has not begun"),
    Bit("state", 3, "ramp", "Ramp", "a ramp is under way"),
    Bit("state", 4, "settle", "Settle", "the acceleration dies out before the next ramp"),
    Bit("flags", 3, "rest", "Rest", "come to rest"),
    Bit("flags", 4, "held", "Held", "the order is held"),
    Bit("flags", 5, "die_out", "DieOut", "an order or Hold in mid-ramp"),
    Bit("flags", 6, "new_ramp", "NewRamp", "a ramp begins"),
    Bit("flags", 7, "new_law", "NewLaw", "a law begins"),
)
MOVE_BITS = (
    *_BITS,
    Bit("state", 2, "move", "Move", "the half-sine is under way"),
    Bit("state", 3, "level", "Level", "constant speed between the halves of a move that is stopped"),
    Bit("flags", 3, "turn", "Turn", "a stop in the first half of a move"),
)


def is_ramp(job: Job) -> bool:
    """Ramps to any speed, else moves over a distance."""
    return job.cosine.shape == "centred"


def layout(job: Job) -> MemoryMap:
    """Where everything lies; the ring, whose length the job gives, comes last."""
    rows, bits = (RAMP, RAMP_BITS) if is_ramp(job) else (MOVE, MOVE_BITS)
    places = [row.name for row in rows]
    in_order = tuple(sorted(bits, key=lambda bit: (places.index(bit.byte), bit.number)))
    return MemoryMap(job.cosine.v_memory, rows, in_order, {"RING": BYTES_OF_A_COUNT * job.cosine.filter_length})


def memory_map(job: Job) -> dict[str, str]:
    """Address of every variable and bit by its name in the templates."""
    return layout(job).addresses()


def refuse_what_does_not_fit(job: Job) -> None:
    """V memory and the length of symbols. Raises JobError."""
    layout(job).refuse_what_does_not_fit(job, "cosine.v_memory")
