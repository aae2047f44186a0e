"""Jobs of cosine ramps and moves that could not be kept: each refusal word for word, at its place."""

from __future__ import annotations

import json
import re
from math import pi
from pathlib import Path

import pytest
from numpy.polynomial import Polynomial

from plcgen.errors import JobError
from plcgen.job import Job, parse_job
from plcgen.profile import cosine
from plcgen.profile.cosine_fit import CENTRED, FITS, HALF_SINE, Fit, Law, fit
from plcgen.profile.cosine_move import MOST_SAMPLES
from plcgen.profile.cosine_rules import derive_moves, derive_ramps, fit_fault

EXAMPLE = (Path(__file__).parents[2] / "templates" / "jobs" / "cosine.toml").read_text(encoding="utf-8")
LIMITS = EXAMPLE[: EXAMPLE.index("[[cosine.moves]]")]
Values = dict[str, float | str]


def job_of(moves: str, values: Values) -> Job:
    """The example job with other values and moves; the first move stands in line 24."""
    text = LIMITS
    for key, value in values.items():
        text, count = re.subn(rf"""(?m)^{key} = ("[^"]*"|[-+.\w]+)""", f"{key} = {json.dumps(value)}", text)
        assert count == 1, key
    return parse_job(text + moves, "job.toml")


def ramps_of(**values: float | str) -> Job:
    return job_of("[[cosine.moves]]\nfrom = 0.0\nto = 0.00001\n", values)


def moves_of(*distances: float, **values: float | str) -> Job:
    rows = "".join(f"[[cosine.moves]]\ndistance = {distance}\n" for distance in distances)
    return job_of(rows, {"shape": "half-sine", **values})


def first_line(error: JobError) -> str:
    return str(error).split("\n")[0]


# ------------------------------------------------------------------------------------------------------------ faults


def fit_of(law: Law, polynomial: Polynomial, name: str = "genetic") -> Fit:
    """As if the repair had made this of a fit."""
    return Fit(name, law, polynomial, polynomial)


def ended(law: Law, first: float, second: float = 0.0) -> Polynomial:
    """Ends on its mark, at rest."""
    total: Polynomial = law.plain + first * law.free[0] + second * law.free[1]
    return total


ENDS_SHORT = fit("taylor", HALF_SINE).raw
STILL_MOVES = Polynomial([0.0, 1.0])
OVERSHOOTS = ended(CENTRED, 3.0)
RUNS_BACKWARDS = ended(HALF_SINE, 12.0)
BESIDE_THE_MIDDLE = ended(CENTRED, -0.5)


@pytest.mark.parametrize(
    ("law", "polynomial", "fault"),
    [
        (HALF_SINE, ENDS_SHORT, "ends 0.024 beside its mark"),
        (CENTRED, Polynomial([0.0, 1.5, 0.0, -0.4]), "ends 0.1 beside its mark"),
        (CENTRED, 0.999 * CENTRED.plain, "ends 0.001 beside its mark"),
        (CENTRED, CENTRED.plain * (1 + 1e-8), "ends 1e-08 beside its mark"),
        (CENTRED, STILL_MOVES, "does not end at rest"),
        (HALF_SINE, Polynomial([1.0, 0.0, -2.0]), "does not end at rest"),
        (CENTRED, OVERSHOOTS, "turns back on its way: the speed would overshoot"),
        (HALF_SINE, RUNS_BACKWARDS, "turns back on its way: the speed would overshoot"),
        (CENTRED, BESIDE_THE_MIDDLE, "has its largest acceleration beside the middle of a ramp"),
        (CENTRED, CENTRED.plain, None),
        (HALF_SINE, HALF_SINE.plain, None),
        (CENTRED, CENTRED.plain * (1 + 1e-12), None),
    ],
)
def test_fault_of_a_polynomial(law: Law, polynomial: Polynomial, fault: str | None) -> None:
    assert fit_fault(fit_of(law, polynomial)) == fault


def test_wrong_polynomials_are_wrong_in_the_way_they_are_said_to_be() -> None:
    """By samples: an end that is right, and what lies before it."""
    x = [i / 1000 for i in range(1001)]
    for polynomial, law in ((OVERSHOOTS, CENTRED), (RUNS_BACKWARDS, HALF_SINE), (BESIDE_THE_MIDDLE, CENTRED)):
        assert polynomial(1.0) == law.plain(1.0)
        assert polynomial.deriv()(1.0) == 0.0
    assert max(OVERSHOOTS(share) for share in x) > 1.1
    assert max(RUNS_BACKWARDS(share) for share in x) > 1.1
    steepest = max(x, key=lambda share: BESIDE_THE_MIDDLE.deriv()(share))
    assert 0.2 < steepest < 0.8
    assert min(BESIDE_THE_MIDDLE.deriv()(share) for share in x) >= 0.0


@pytest.mark.parametrize("law", [HALF_SINE, CENTRED], ids=["half-sine", "centred"])
@pytest.mark.parametrize("name", FITS)
def test_every_fit_that_can_be_written_is_right(law: Law, name: str) -> None:
    assert fit_fault(fit(name, law)) is None


@pytest.mark.parametrize(
    ("polynomial", "name", "message"),
    [
        (
            OVERSHOOTS,
            "genetic",
            '20:7: fit = "genetic" turns back on its way: the speed would overshoot; write another seed',
        ),
        (STILL_MOVES, "genetic", '20:7: fit = "genetic" does not end at rest; write another seed'),
        (STILL_MOVES, "least-squares", '20:7: fit = "least-squares" does not end at rest; write "minimax"'),
        (
            BESIDE_THE_MIDDLE,
            "taylor",
            '20:7: fit = "taylor" has its largest acceleration beside the middle of a ramp; write "minimax"',
        ),
    ],
)
def test_refusal_of_a_wrong_fit_of_ramps(
    monkeypatch: pytest.MonkeyPatch, polynomial: Polynomial, name: str, message: str
) -> None:
    """No fit has come out wrong so far: one is put in place of what the job asks for."""
    monkeypatch.setattr(cosine, "fit", lambda _name, law, _seed: fit_of(law, polynomial, name))
    with pytest.raises(JobError) as caught:
        derive_ramps(ramps_of(fit=name))
    assert first_line(caught.value) == f"job.toml:{message}"


def test_refusal_of_a_wrong_fit_of_moves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cosine, "fit", lambda name, law, _seed: fit_of(law, ENDS_SHORT, name))
    with pytest.raises(JobError) as caught:
        derive_moves(moves_of(5.0, fit="taylor"))
    assert first_line(caught.value) == 'job.toml:20:7: fit = "taylor" ends 0.024 beside its mark; write "minimax"'


# ------------------------------------------------------------------------------------------------------------- ramps


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            {"sample_period": 0.001, "max_acceleration": 0.01},
            "13:17: sample_period = 0.001 s is too short: a ramp over the whole range takes 3770 s, 3769886 samples of "
            "838860 at the most; raise max_acceleration and jerk, or lengthen sample_period",
        ),
        (
            {"sample_period": 0.001, "jerk": 0.0001},
            "13:17: sample_period = 0.001 s is too short: a ramp over the whole range takes 1088 s, 1088392 samples of "
            "838860 at the most; raise max_acceleration and jerk, or lengthen sample_period",
        ),
    ],
)
def test_refusal_of_ramps(values: Values, message: str) -> None:
    with pytest.raises(JobError) as caught:
        derive_ramps(ramps_of(**values))
    assert first_line(caught.value) == f"job.toml:{message}"


@pytest.mark.parametrize(
    "values",
    [
        {"sample_period": 0.005, "max_acceleration": 0.01},
        {"sample_period": 0.001, "max_acceleration": 0.045},
        {"sample_period": 0.001, "jerk": 0.0002},
        {"sample_period": 0.002, "jerk": 0.0001},
    ],
)
def test_what_is_named_as_the_way_out_of_long_ramps_is_one(values: Values) -> None:
    assert derive_ramps(ramps_of(**values)).ramp_time(24.0) < 838860 * float(values["sample_period"])


def test_ramps_have_the_limits_of_the_job() -> None:
    ramps = derive_ramps(ramps_of(fit="genetic", seed=2, filter_length=5))
    assert (ramps.max_velocity, ramps.max_acceleration, ramps.jerk) == (12.0, 0.75, 0.5)
    assert (ramps.sample_period, ramps.filter_length) == (0.01, 5)
    assert ramps.fit is fit("genetic", CENTRED, 2)


# ------------------------------------------------------------------------------------------------------------- moves


@pytest.mark.parametrize(
    ("distances", "values", "message"),
    [
        (
            (5.0, 9000.0),
            {},
            "30:12: distance = 9000 m takes 117843 samples; 65536 are the most, enough for 5000 m; divide it, or "
            "lengthen sample_period",
        ),
        (
            (-9000.0,),
            {"length_unit": "mm", "sample_period": 0.001, "max_velocity": 0.1},
            "28:12: distance = -9000 mm takes 141410140 samples; 65536 are the most, enough for 4.17 mm; divide it, "
            "or lengthen sample_period",
        ),
        (
            (1.0,),
            {"sample_period": 0.001, "max_velocity": 0.0001},
            "28:12: distance = 1 m takes 15712239 samples; 65536 are the most, enough for 0.00417 m; divide it, or "
            "lengthen sample_period",
        ),
        (
            (100.0,),
            {"sample_period": 0.001},
            "28:12: distance = 100 m takes 249082 samples; 65536 are the most, enough for 6.92 m; divide it, or "
            "lengthen sample_period",
        ),
        (
            (7.0,),
            {"sample_period": 0.001},
            "28:12: distance = 7 m takes 65902 samples; 65536 are the most, enough for 6.92 m; divide it, or "
            "lengthen sample_period",
        ),
        (
            (1.0, 5.0, -1e-7),
            {"max_velocity": 50},
            "32:12: distance = -1e-07 m is shorter than a count of speed in a sample, 3.05e-07 m; write more, or "
            "lower max_velocity",
        ),
        (
            (1e-9,),
            {},
            "28:12: distance = 1e-09 m is shorter than a count of speed in a sample, 7.63e-08 m; write more, or "
            "lower max_velocity",
        ),
    ],
)
def test_refusal_of_moves(distances: tuple[float, ...], values: Values, message: str) -> None:
    with pytest.raises(JobError) as caught:
        derive_moves(moves_of(*distances, **values))
    assert first_line(caught.value) == f"job.toml:{message}"


@pytest.mark.parametrize(
    ("distances", "values"),
    [
        ((5000.0, -5000.0), {}),
        ((9000.0,), {"sample_period": 0.02}),
        ((6.92,), {"sample_period": 0.001}),
        ((1e-7,), {"max_velocity": 6}),
        ((3.1e-7,), {"max_velocity": 50}),
        ((0.00417,), {"sample_period": 0.001, "max_velocity": 0.0001}),
    ],
)
def test_what_is_named_as_the_way_out_of_a_distance_is_one(distances: tuple[float, ...], values: Values) -> None:
    moves = derive_moves(moves_of(*distances, **values))
    assert max(count for distance in distances for count in moves.samples(distance)) <= MOST_SAMPLES


def test_moves_have_the_limits_of_the_job() -> None:
    moves = derive_moves(moves_of(5.0, fit="genetic", seed=2, filter_length=5))
    assert (moves.max_velocity, moves.max_acceleration, moves.jerk) == (12.0, 0.75, 0.5)
    assert (moves.sample_period, moves.filter_length) == (0.01, 5)
    assert moves.fit is fit("genetic", HALF_SINE, 2)
    assert moves.time_by_velocity == pytest.approx(pi / 2 / 12.0, rel=0.01)
