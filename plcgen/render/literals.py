"""The one place that spells numbers for a PLC."""

from __future__ import annotations

import numpy as np


def real_literal(value: float) -> str:
    """REAL literal: the shortest decimal that names the nearest 32-bit value, always with a point.

    `12.0`, `0.1`, `1.5E-07`. Both dialects accept it; TIA refuses an exponent without a point.
    Raises ValueError for a value that REAL cannot hold: an S7 has no denormal numbers.
    """
    single = _single(value)
    if single == 0.0 or 1e-4 <= abs(single) < 1e7:
        return np.format_float_positional(single, unique=True, trim="0")
    mantissa, exponent = np.format_float_scientific(single, unique=True, trim="0").split("e")
    return f"{mantissa}E{int(exponent):+03d}"


def stl_real_literal(value: float) -> str:
    """REAL literal of an AWL source, as STEP 7 itself writes it: `1.200000e+001`, `3.3333334e-001`.

    Six digits behind the point, and more where fewer would not name the nearest 32-bit value. Raises ValueError as
    `real_literal` does.
    """
    return np.format_float_scientific(_single(value), unique=True, min_digits=6, exp_digits=3)


def _single(value: float) -> np.float32:
    """The nearest 32-bit value. Raises ValueError where REAL has none."""
    with np.errstate(over="ignore"):
        single = np.float32(value)
    if not np.isfinite(single) or (value != 0.0 and abs(single) < np.finfo(np.float32).tiny):
        raise ValueError(f"{value!r} is out of the range of REAL")
    return single
