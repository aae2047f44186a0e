"""Checks keep their bound from either side, and NaN passes none."""

from __future__ import annotations

import json
from math import inf, nan

import pytest

from plcgen.check.verdict import Check, TargetVerdict, Verdict


@pytest.mark.parametrize(
    ("value", "bound", "at_least", "ok"),
    [(1.0, 1.0, False, True), (1.1, 1.0, False, False), (1.0, 1.0, True, True), (0.9, 1.0, True, False)],
)
def test_bound(value: float, bound: float, at_least: bool, ok: bool) -> None:
    assert Check("x", value, bound, "m", at_least).ok is ok


@pytest.mark.parametrize("value", [nan, inf])
def test_no_number_fails_and_is_null_in_json(value: float) -> None:
    check = Check("x", value, 1.0, "m")
    assert not check.ok
    assert json.loads(json.dumps(check.as_json()))["value"] is None


def test_nan_fails_a_lower_bound() -> None:
    assert not Check("x", nan, 1.0, "m", at_least=True).ok


def test_verdict_without_checks_is_not_good() -> None:
    assert not TargetVerdict(()).ok
    assert not Verdict("job", {}).ok


def test_json_of_a_verdict() -> None:
    verdict = Verdict("Shaft", {"tia-scl": TargetVerdict((Check("stop_error", 0.5, 1.0, "mm"),))})
    assert verdict.as_json() == {
        "ok": True,
        "job": "Shaft",
        "targets": {
            "tia-scl": {
                "ok": True,
                "checks": [{"name": "stop_error", "value": 0.5, "bound": 1.0, "unit": "mm", "ok": True}],
            }
        },
    }
