"""Faults of the cosine blocks that change nothing, or nothing that a run could show, each with the reason."""

from __future__ import annotations

# ruff: noqa: E501 - a row stands in one piece, as seeded_faults.py prints it

HARMLESS_RAMP: dict[str, tuple[str, ...]] = {
    "Read at an order or a restart only, and written before.": (
        "VAR_INPUT | targetVelocity : REAL := [0.0 -> 0.001];",
        "VAR_INPUT | actualVelocity : REAL := [0.0 -> 0.001];",
    ),
    "Written in each call before it can be read.": (
        "VAR_OUTPUT | steady : BOOL := [FALSE -> TRUE];",
        "VAR_OUTPUT | standstill : BOOL := [FALSE -> TRUE];",
    ),
    "A law writes it before it is read; the declaration only says so.": (
        "VAR | statStep : DINT := [0 -> 1];",
        "VAR | statSteps : DINT := [1 -> 2];",
        "VAR | statBase : REAL := [0.0 -> 0.001];",
        "VAR | statChange : REAL := [0.0 -> 0.001];",
        "VAR | statEnd : REAL := [0.0 -> 0.001];",
    ),
    "An element more, which is never used.": ("VAR | statRing : ARRAY[0..[8 -> 9]] OF DINT;",),
    "Where the ring begins does not matter while its elements are equal, nor how long equal ones are averaged.": (
        "VAR | statIndex : INT := [0 -> 1];",
        "VAR | statFresh : INT := [0 -> 1];",
    ),
    "A fraction of a count, below what the counts resolve.": ("VAR | statSum : DINT := [0 -> 1];",),
    "Which speeds count as the same, by a hundredth of a count.": (
        "CONST | COUNT_SPEED := [9.536743E-07 -> 0.000000944];",
        "CONST | COUNT_SPEED := [9.536743E-07 -> 0.000000963];",
        "IF (statPhase = ON_RAMP) AND statPending AND NOT tempHeld THEN | IF ABS(statTarget - statEnd) [< -> <=] COUNT_SPEED THEN",
    ),
    "Another number for the same phase.": ("CONST | SETTLING := [2 -> 3];",),
    "Shows only where an order is stopped that moves nothing, without a moving average.": (
        "CONST | ABORTED := [W167005 -> W167006];",
    ),
    "Counted down to 0 in the same call.": ("IF restart THEN | statFresh := [0 -> 1];",),
    "What rounding M up may add, weighed a hundredth otherwise.": (
        "IF (statPhase = ON_RAMP) AND (statPending OR tempHeld) THEN | IF ABS(tempRate) / LAW_1 * (tempSteps + [1.0 -> 0.990000000]) <= ABS(statEnd - statVelocity) THEN",
        "IF (statPhase = ON_RAMP) AND (statPending OR tempHeld) THEN | IF ABS(tempRate) / LAW_1 * (tempSteps + [1.0 -> 1.010000000]) <= ABS(statEnd - statVelocity) THEN",
    ),
    "Differs where two values are equal to the last bit only, and by a call at most.": (
        "IF (statPhase = ON_RAMP) AND (statPending OR tempHeld) THEN | IF ABS(tempRate) / LAW_1 * (tempSteps + 1.0) [<= -> <] ABS(statEnd - statVelocity) THEN",
        "ELSIF (statPhase = AT_SPEED) AND statPending AND NOT tempHeld THEN | IF tempTime [< -> <=] TIME_BY_ACC * tempSpeedChange THEN",
        "IF tempNewLaw THEN | IF DINT_TO_REAL(statSteps) [< -> <=] tempSteps THEN",
    ),
    "Speed 0 is count 0 by either branch.": (
        "BEGIN | IF tempScaled [< -> <=] 0.0 THEN",
        "BEGIN | IF tempScaled < [0.0 -> 0.001] THEN",
    ),
    "A hundredth of a count.": (
        "IF tempScaled < 0.0 THEN | tempCount := TRUNC(tempScaled - [0.5 -> 0.495000000]);",
        "IF tempScaled < 0.0 THEN | tempCount := TRUNC(tempScaled - [0.5 -> 0.505000000]);",
        "ELSE | tempCount := TRUNC(tempScaled + [0.5 -> 0.495000000]);",
        "ELSE | tempCount := TRUNC(tempScaled + [0.5 -> 0.505000000]);",
    ),
}

HARMLESS_MOVE: dict[str, tuple[str, ...]] = {
    "Read at an order or a restart only, and written before.": ("VAR_INPUT | distance : REAL := [0.0 -> 0.001];",),
    "Written in each call before it can be read.": (
        "VAR_OUTPUT | steady : BOOL := [FALSE -> TRUE];",
        "VAR_OUTPUT | standstill : BOOL := [FALSE -> TRUE];",
    ),
    "An order brings the cycle time before it is used.": (
        "VAR | statCycle : REAL := [0.01 -> 0.009900000];",
        "VAR | statCycle : REAL := [0.01 -> 0.010100000];",
    ),
    "A law writes it before it is read; the declaration only says so.": (
        "VAR | statStep : DINT := [0 -> 1];",
        "VAR | statSteps : DINT := [2 -> 3];",
        "VAR | statPeak : REAL := [0.0 -> 0.001];",
        "VAR | statLevel : INT := [0 -> 1];",
    ),
    "An element more, which is never used.": ("VAR | statRing : ARRAY[0..[8 -> 9]] OF DINT;",),
    "Where the ring begins does not matter while its elements are equal, nor how long equal ones are averaged.": (
        "VAR | statIndex : INT := [0 -> 1];",
        "VAR | statFresh : INT := [0 -> 1];",
    ),
    "A fraction of a count, below what the counts resolve.": (
        "VAR | statSum : DINT := [0 -> 1];",
        "IF restart THEN | statSum := [0 -> 1];",
    ),
    "A hundredth of it is below the bound of a speed, or less than a sample.": (
        "CONST | SUM_3 := -[0.05752791 -> 0.056952631];",
        "CONST | SUM_3 := -[0.05752791 -> 0.058103189];",
        "CONST | CUBE_BY_JERK := [0.25913376 -> 0.256542422];",
        "CONST | CUBE_BY_JERK := [0.25913376 -> 0.261725098];",
    ),
    "Moves the last call in which a stop levels by less than one.": (
        "CONST | LEVEL_SAMPLES := [9.0 -> 8.910000000];",
        "CONST | LEVEL_SAMPLES := [9.0 -> 9.090000000];",
        "IF (statPhase = MOVING) AND NOT statActive AND (2 * statStep < statSteps) THEN | tempShare := tempX * (LAW_1 - tempSquare * (LAW_2 - tempSquare [* -> /] (LAW_3 - tempSquare * LAW_4)))",
        "IF (statPhase = MOVING) AND NOT statActive AND (2 * statStep < statSteps) THEN | tempShare := tempX * (LAW_1 - tempSquare * (LAW_2 - tempSquare * (LAW_3 [- -> +] tempSquare * LAW_4)))",
        "IF (statPhase = MOVING) AND NOT statActive AND (2 * statStep < statSteps) THEN | tempShare := tempX * (LAW_1 - tempSquare * (LAW_2 - tempSquare * (LAW_3 - tempSquare [* -> /] LAW_4)))",
        "tempShare := tempShare + tempSquare * (LAW_1 - tempSquare | * (LAW_2 / 2.0 - tempSquare * (LAW_3 / [3.0 -> 2.970000000] - tempSquare * (LAW_4 / 4.0))));",
        "tempShare := tempShare + tempSquare * (LAW_1 - tempSquare | * (LAW_2 / 2.0 - tempSquare * (LAW_3 / [3.0 -> 3.030000000] - tempSquare * (LAW_4 / 4.0))));",
        "tempShare := tempShare + tempSquare * (LAW_1 - tempSquare | * (LAW_2 / 2.0 - tempSquare * (LAW_3 / 3.0 - tempSquare * (LAW_4 / [4.0 -> 3.960000000]))));",
        "tempShare := tempShare + tempSquare * (LAW_1 - tempSquare | * (LAW_2 / 2.0 - tempSquare * (LAW_3 / 3.0 - tempSquare * (LAW_4 / [4.0 -> 4.040000000]))));",
    ),
    "Another number for the same phase.": ("CONST | LEVELLED := [2 -> 3];",),
    "Shows only where an order is stopped that moves nothing, without a moving average.": (
        "CONST | ABORTED := [W167005 -> W167006];",
    ),
    "Counted down to 0 in the same call.": ("IF restart THEN | statFresh := [0 -> 1];",),
    "An order one call before the average has caught up is taken; nothing jumps.": (
        "IF tempStart THEN | IF (statPhase <> AT_REST) OR (statFresh > [0 -> 1]) THEN",
    ),
    "Differs where two values are equal to the last bit only, and by a call at most.": (
        "IF tempFirst THEN | IF tempTime [< -> <=] tempOther THEN",
        "IF tempFirst THEN | IF DINT_TO_REAL(statSteps) [< -> <=] tempSteps THEN",
        "BEGIN | IF (statPhase = MOVING) AND NOT statActive AND (2 * statStep [< -> <=] statSteps) THEN",
        "IF (statPhase = MOVING) AND NOT statActive AND (2 * statStep < statSteps) THEN | IF tempShare [< -> <=] 1.0 THEN",
    ),
    "Speed 0 is count 0 by either branch.": (
        "BEGIN | IF tempScaled [< -> <=] 0.0 THEN",
        "BEGIN | IF tempScaled < [0.0 -> 0.001] THEN",
    ),
    "A hundredth of a count.": (
        "IF tempScaled < 0.0 THEN | tempCount := TRUNC(tempScaled - [0.5 -> 0.495000000]);",
        "IF tempScaled < 0.0 THEN | tempCount := TRUNC(tempScaled - [0.5 -> 0.505000000]);",
        "ELSE | tempCount := TRUNC(tempScaled + [0.5 -> 0.495000000]);",
        "ELSE | tempCount := TRUNC(tempScaled + [0.5 -> 0.505000000]);",
    ),
    "The speed at a restart is zero.": (
        "FOR tempIndex := 0 TO FILTER_LENGTH - 1 DO | [statSum := statSum + tempCount; -> ]",
        "FOR tempIndex := 0 TO FILTER_LENGTH - 1 DO | statSum := statSum [+ -> -] tempCount;",
    ),
}
