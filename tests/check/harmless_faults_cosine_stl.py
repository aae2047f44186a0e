"""Faults of the cosine blocks in STL that change nothing, or nothing that a run could show, each with the reason."""

from __future__ import annotations

EQUAL = "Differs where two values are equal to the last bit only, and by a call at most."
BOTH_WAYS = "Both orders of the accumulators give the longer time."
ROUNDING = "What rounding M up may add, weighed a hundredth otherwise."
ROUNDS_UP = "Rounded up in any case; differs where the duration is a whole number of calls."
COUNT = "A fraction of a count, or a hundredth of one."
SPEED_ZERO = "Speed 0 is count 0 by either branch."
LEVELLING = "Moves the last call in which a stop levels by less than one."
SECOND_HALF = "In the second half the way of a stop is longer than the move, which is asked next."
SMALL = "A hundredth of it is below the bound of a speed, or less than a sample."
AT_REST = "The speed at a restart is zero, and with it every count."
STILL = "An order one call before the average has caught up is taken; nothing jumps."
NOT_READ = "Nobody reads it there: the value goes on in ACCU1."
FIRST_SCAN = "Nothing is attached in the first scan."
RESTARTED = "The sample with Restart, which Init calls next, or MAIN sets it too."

S7_RAMP: dict[str, tuple[str, ...]] = {
    EQUAL: (
        "3. The speed that the ramp leads to anyway | <R ; -> <=R ;",
        "3.2 If that would pass the end of the ramp, it goes on to its end | <=R ; -> <R ;",
        "3.3 A ramp from the present speed | >R ; -> >=R ;",
        "3.4 Whole calls, rounded up: the limits hold | <R ; -> <=R ;",
    ),
    ROUNDING: (
        "3.2 If that would pass the end of the ramp, it goes on to its end | L 1.000000e+000; -> L 1.010000e+000;",
        "3.2 If that would pass the end of the ramp, it goes on to its end | L 1.000000e+000; -> L 9.900000e-001;",
    ),
    ROUNDS_UP: ("3.4 Whole calls, rounded up: the limits hold | TRUNC ; -> RND ;",),
    SPEED_ZERO: (
        "5. Moving average: speed in counts, rounded half away from zero | L 0.000000e+000; -> L 1.000000e-003;",
        "5. Moving average: speed in counts, rounded half away from zero | <R ; -> <=R ;",
    ),
    COUNT: (
        "5. Moving average: speed in counts, rounded half away from zero | L 5.000000e-001; -> L 5.050000e-001;",
        "5. Moving average: speed in counts, rounded half away from zero | L 5.000000e-001; -> L 4.950000e-001;",
        "Small: instance data of the ramps | COUNT_SPEED := 9.536743e-007; -> COUNT_SPEED := 9.632110e-007;",
        "Small: instance data of the ramps | COUNT_SPEED := 9.536743e-007; -> COUNT_SPEED := 9.441376e-007;",
    ),
}

S7_MOVE: dict[str, tuple[str, ...]] = {
    STILL: ("2.1 Only at rest | L 0; -> L 1;",),
    BOTH_WAYS: (
        "3. A new move: the longest of the times that the limits ask for | TAK ; -> nothing",
        "3.1 The jump of the acceleration, spread over the average | TAK ; -> nothing",
        "3.2 The jerk in between, by a cube root | TAK ; -> nothing",
    ),
    EQUAL: (
        "3. A new move: the longest of the times that the limits ask for | <R ; -> <=R ;",
        "3.1 The jump of the acceleration, spread over the average | <R ; -> <=R ;",
        "3.2 The jerk in between, by a cube root | <R ; -> <=R ;",
        "3.3 Whole calls, rounded up, and one more | <R ; -> <=R ;",
        "4. Stop in the first half | <D ; -> <=D ;",
        "4.2 and twice the way so far | <R ; -> <=R ;",
    ),
    NOT_READ: ("3.2 The jerk in between, by a cube root | TIM3: T #tempTime; -> TIM3: NOP 0;",),
    ROUNDS_UP: ("3.3 Whole calls, rounded up, and one more | TRUNC ; -> RND ;",),
    SECOND_HALF: ("4. Stop in the first half | +D ; -> -D ;",),
    LEVELLING: (
        "4.1 Share of the distance: n samples at this speed, u(x) n/N | *R ; -> /R ;",
        "4.1 Share of the distance: n samples at this speed, u(x) n/N | T #tempTerm; -> nothing",
        "4.2 and twice the way so far | L 4.000000e+000; -> L 4.040000e+000;",
        "4.2 and twice the way so far | L 4.000000e+000; -> L 3.960000e+000;",
        "4.2 and twice the way so far | L 3.000000e+000; -> L 3.030000e+000;",
        "4.2 and twice the way so far | L 3.000000e+000; -> L 2.970000e+000;",
        "Small: instance data of the moves | LEVEL_SAMPLES := 9.000000e+000; -> LEVEL_SAMPLES := 9.090000e+000;",
        "Small: instance data of the moves | LEVEL_SAMPLES := 9.000000e+000; -> LEVEL_SAMPLES := 8.910000e+000;",
    ),
    SPEED_ZERO: (
        "6. Moving average: speed in counts, rounded half away from zero | L 0.000000e+000; -> L 1.000000e-003;",
        "6. Moving average: speed in counts, rounded half away from zero | <R ; -> <=R ;",
    ),
    COUNT: (
        "6. Moving average: speed in counts, rounded half away from zero | L 5.000000e-001; -> L 5.050000e-001;",
        "6. Moving average: speed in counts, rounded half away from zero | L 5.000000e-001; -> L 4.950000e-001;",
    ),
    AT_REST: (
        # one place more is statSum, which is zero then
        "6.1 Restart: as if the speed had never been another | L 9; -> L 10;",
        "6.1 Restart: as if the speed had never been another | +D ; -> -D ;",
        "6.1 Restart: as if the speed had never been another | T #statSum; -> nothing",
    ),
    SMALL: (
        "Small: instance data of the moves | SUM_3 := -5.752791e-002; -> SUM_3 := -5.810319e-002;",
        "Small: instance data of the moves | SUM_3 := -5.752791e-002; -> SUM_3 := -5.695263e-002;",
        "Small: instance data of the moves | CUBE_BY_JERK := 2.5913376e-001; -> CUBE_BY_JERK := 2.617251e-001;",
        "Small: instance data of the moves | CUBE_BY_JERK := 2.5913376e-001; -> CUBE_BY_JERK := 2.565424e-001;",
    ),
}

_INIT = (
    "Init 3 | MOVB 0 command -> nothing",
    "Init 3 | MOVB 0 status -> nothing",
    "Init 3 | MOVB 0 state -> nothing",
    "Init 3 | MOVD +0 step -> MOVD +1 step",
    "Init 4 | R restart 1 -> S restart 1",
    "Init 4 | R restart 1 -> nothing",
)
_ATTACHED = ("Init 1 | LD SM0.0 -> LDN SM0.0", "Init 1 | DTCH 10 -> nothing")

SMART_RAMP: dict[str, tuple[str, ...]] = {
    "Equal counts are averaged as they are.": ("Sample 4 | MOVW +0 fresh -> MOVW +1 fresh",),
    EQUAL: (
        "Sample 18 | AR< h1 count_speed -> AR<= h1 count_speed",
        "Sample 25 | AR<= h1 h2 -> AR< h1 h2",
        "Sample 28 | AR< time h1 -> AR<= time h1",
        "Sample 31 | AR< h1 samples -> AR<= h1 samples",
    ),
    ROUNDING: ("Sample 24 | +R 1.0 h2 -> +R 1.01 h2", "Sample 24 | +R 1.0 h2 -> +R 0.99 h2"),
    ROUNDS_UP: ("Sample 30 | TRUNC samples steps -> ROUND samples steps", "Sample 30 | DTR steps h1 -> nothing"),
    SPEED_ZERO: ("Sample 44 | LDR< h1 0.0 -> LDR<= h1 0.0",),
    COUNT: (
        "Sample 43 | +R 0.5 h2 -> +R 0.505 h2",
        "Sample 43 | +R 0.5 h2 -> +R 0.495 h2",
        "Sample 44 | -R 0.5 h2 -> -R 0.505 h2",
        "Sample 44 | -R 0.5 h2 -> -R 0.495 h2",
        "Init 2 | MOVR 9.536743E-07 count_speed -> MOVR 9.63211e-07 count_speed",
        "Init 2 | MOVR 9.536743E-07 count_speed -> MOVR 9.441376e-07 count_speed",
    ),
    FIRST_SCAN: _ATTACHED,
    RESTARTED: (
        *_INIT,
        "Init 3 | MOVD +0 step -> nothing",
        "Init 3 | MOVD +1 steps -> MOVD +2 steps",
        "Init 3 | MOVD +1 steps -> nothing",
    ),
}

SMART_MOVE: dict[str, tuple[str, ...]] = {
    "Equal counts are averaged as they are.": ("Sample 2 | MOVW +0 fresh -> MOVW +1 fresh",),
    EQUAL: (
        "Sample 14 | AR< time h1 -> AR<= time h1",
        "Sample 16 | AR< time h1 -> AR<= time h1",
        "Sample 18 | AR< time h1 -> AR<= time h1",
        "Sample 20 | AR< h1 samples -> AR<= h1 samples",
        "Sample 26 | AD< twice steps -> AD<= twice steps",
        "Sample 30 | AR>= share 1.0 -> AR> share 1.0",
    ),
    ROUNDS_UP: ("Sample 19 | TRUNC samples steps -> ROUND samples steps", "Sample 19 | DTR steps h1 -> nothing"),
    SECOND_HALF: (
        "Sample 25 | +D step twice -> -D step twice",
        "Sample 25 | +D step twice -> nothing",
    ),
    LEVELLING: (
        "Sample 27 | LD turn -> LDN turn",
        "Sample 28 | *R square h1 -> /R square h1",
        "Sample 28 | *R square h1 -> nothing",
        "Sample 28 | -R h1 h2 -> +R h1 h2",
        "Sample 28 | -R h1 h2 -> nothing",
        "Sample 28 | -R h2 h1 -> nothing",
        "Sample 29 | /R 4.0 h1 -> /R 4.04 h1",
        "Sample 29 | /R 4.0 h1 -> /R 3.96 h1",
        "Sample 29 | /R 3.0 h2 -> /R 3.03 h2",
        "Sample 29 | /R 3.0 h2 -> /R 2.97 h2",
        "Sample 29 | -R h1 h2 -> nothing",
        "Init 2 | MOVR 9.0 level_samples -> MOVR 9.09 level_samples",
        "Init 2 | MOVR 9.0 level_samples -> MOVR 8.91 level_samples",
    ),
    SPEED_ZERO: ("Sample 45 | LDR< h1 0.0 -> LDR<= h1 0.0",),
    COUNT: (
        "Sample 44 | +R 0.5 h2 -> +R 0.505 h2",
        "Sample 44 | +R 0.5 h2 -> +R 0.495 h2",
        "Sample 45 | -R 0.5 h2 -> -R 0.505 h2",
        "Sample 45 | -R 0.5 h2 -> -R 0.495 h2",
        "Sample 47 | MOVD +0 sum -> MOVD +1 sum",
    ),
    AT_REST: (
        "Sample 49 | +D count sum -> -D count sum",
        "Sample 49 | +D count sum -> nothing",
        # from then on every place is a byte further on, all of them zero
        "Sample 52 | MOVD +0 offset -> MOVD +1 offset",
        "Sample 56 | MOVR velocity setpoint -> nothing",
    ),
    SMALL: (
        "Init 2 | MOVR -0.05752791 sum_3 -> MOVR -0.05810319 sum_3",
        "Init 2 | MOVR -0.05752791 sum_3 -> MOVR -0.05695263 sum_3",
        "Init 2 | MOVR 0.25913376 cube_by_jerk -> MOVR 0.2617251 cube_by_jerk",
        "Init 2 | MOVR 0.25913376 cube_by_jerk -> MOVR 0.2565424 cube_by_jerk",
    ),
    FIRST_SCAN: _ATTACHED,
    RESTARTED: (
        *_INIT,
        "Init 3 | MOVD +2 steps -> MOVD +3 steps",
        "Init 3 | MOVD +2 steps -> nothing",
        "Init 3 | MOVD +0 offset -> MOVD +1 offset",
    ),
}
