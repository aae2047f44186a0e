"""The keys of the method `cosine`: speed ramps behind a moving average, or moves of half-sine speed."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from plcgen.jobfile_two_axis import HIGHEST_V_BYTE
from plcgen.jobrules import Choice, Quantity, Table, Whole

LONGEST_FILTER = 512  # samples
FITS = ("minimax", "least-squares", "genetic", "taylor")
CENTRED, HALF_SINE = SHAPES = ("centred", "half-sine")
RAMP_KEYS, MOVE_KEYS = ("from", "to"), ("distance",)


class CosineMove(Table):
    """What verification runs: a ramp `from` a speed `to` another, or a move over a `distance`, by the shape."""

    from_velocity: Annotated[float | None, Quantity("m/s", -50.0, 50.0)] = Field(
        None, alias="from", description='speed before the ramp; shape "centred"'
    )
    to_velocity: Annotated[float | None, Quantity("m/s", -50.0, 50.0)] = Field(
        None, alias="to", description='speed after the ramp; shape "centred"'
    )
    then_velocity: Annotated[float | None, Quantity("m/s", -50.0, 50.0)] = Field(
        None, alias="then", description='another speed, ordered in mid-ramp; shape "centred"'
    )
    after: Annotated[float | None, Quantity("s", 0.001, 1e4)] = Field(
        None, description="from the begin of the ramp to the order of `then`"
    )
    distance: Annotated[float | None, Quantity("m", -1e4, 1e4)] = Field(
        None, description='travel from rest to rest, with its sign; shape "half-sine"'
    )


class CosineLimits(Table):
    """Limits of the ramps, the moving average behind them, and where the S7-200 SMART keeps what it needs."""

    max_velocity: Annotated[float, Quantity("m/s", 1e-4, 50.0)] = Field(
        description="highest speed, in either direction", examples=[12.0]
    )
    max_acceleration: Annotated[float, Quantity("m/s2", 1e-4, 1e3)] = Field(
        description="highest acceleration", examples=[0.75]
    )
    jerk: Annotated[float, Quantity("m/s3", 1e-4, 1e5)] = Field(description="highest jerk", examples=[0.5])
    filter_length: Annotated[int, Whole(1, LONGEST_FILTER)] = Field(
        16, description="samples of the moving average; 1 = none"
    )
    fit: Annotated[str, Choice(FITS)] = Field("minimax", description="how the polynomial follows the cosine")
    shape: Annotated[str, Choice(SHAPES)] = Field(
        CENTRED, description="a ramp to any speed, or the half-sine of claim 3: rest to rest over a distance"
    )
    seed: Annotated[int, Whole(0, 2**31 - 1)] = Field(1, description="of the genetic fit")
    v_memory: Annotated[int, Whole(0, HIGHEST_V_BYTE)] = Field(
        1000, description="first V byte that may be used; s7-200-smart"
    )
    first_subroutine: Annotated[int, Whole(0, 126)] = Field(
        0, description="number of the first of two subroutines; s7-200-smart"
    )
    interrupt_routine: Annotated[int, Whole(0, 127)] = Field(
        0, description="number of the interrupt routine; s7-200-smart"
    )
    moves: tuple[CosineMove, ...] = Field(
        description="what verification runs; the program takes any speed or distance at run time"
    )
