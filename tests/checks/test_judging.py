"""What is not known is never met."""

import numpy as np
import pytest

from railbridge import codes
from railbridge.checks.judging import Point, Points, finding
from railbridge.studies import Asked, Row

LIMIT = codes.acceleration_limit("ballasted")


@pytest.mark.parametrize(
    ("value", "gaps", "verdict"),
    [
        (3.5, [], "met"),
        (3.5 + 1e-6, [], "not met"),
        (3.5, ["modes may miss"], "cannot decide"),
        (3.5 + 1e-6, ["modes may miss"], "not met"),
        (None, [], "cannot decide"),
        (None, ["modes may miss"], "cannot decide"),
    ],
)
def test_a_gap_takes_away_what_is_met_and_nothing_else(value, gaps, verdict):
    found = finding(value, LIMIT, gaps, reason="modes 1-3")
    assert found.verdict.verdict == verdict and found.value == value
    assert "modes 1-3" in found.verdict.reason
    if gaps and verdict == "cannot decide":
        assert found.verdict.value is None and "modes may miss" in found.verdict.reason
        assert ("3.5 m/s2 as far as known" in found.verdict.reason) == (value is not None)


def test_the_utilisation_is_that_of_what_is_known():
    assert finding(1.75, LIMIT, ["a gap"]).utilisation == 0.5
    assert np.isnan(finding(None, LIMIT, ["a gap"]).utilisation)
    assert np.isnan(finding(5.0, codes.uplift_limit()).utilisation)


def test_a_limit_that_is_not_known_says_why():
    limit = codes.damping_limit(None, 20.0)
    found = finding(0.01, limit, reason="mode 1")
    assert found.verdict.verdict == "cannot decide"
    assert found.verdict.reason.startswith("0.01 as far as known; mode 1; no limit: the kind")


def test_crossings_that_failed_are_counted_and_one_is_named():
    asked = Asked((), ("wheel_unloading",))
    good = Point("A", True, 50.0, Row(np.array([0.3])))
    bad = Point("B", True, 62.5, Row.failed(asked, "did not settle"))
    refused = Point("B", True, 65.0, "no such step")
    points = Points.of([good, bad, refused], asked)
    assert len(points) == 1 and points.number("wheel_unloading").tolist() == [0.3]
    assert points.gaps == [
        "2 of 3 crossings failed: B at 62.5 m/s (225 km/h): did not settle"
    ]  # fmt: skip
    assert Points.of([good], asked).gaps == []
