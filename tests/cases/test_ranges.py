"""Ranges as people write them."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases.ranges import MOST, values_of, written_ends, written_range


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("150:300:25km/h", np.arange(150.0, 301.0, 25.0) / 3.6),
        ("150 : 300 : 50 km/h", [150 / 3.6, 200 / 3.6, 250 / 3.6, 300 / 3.6]),
        ("20,25.5,30", [20.0, 25.5, 30.0]),
        ("20 m/s", [20.0]),
        ("36km/h,72km/h", [10.0, 20.0]),
        ("1e1:3e1:1e1", [10.0, 20.0, 30.0]),
        ("0.1:0.3:0.1", [0.1, 0.2, 0.3]),
        ("20:20:5", [20.0]),
    ],
)
def test_ranges_in_words(text, expected):
    assert written_range("--speeds", text, "speed") == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is no range of numbers.*150:300:25km/h"),
        ("fast", "is no range"),
        ("150:300", "first:last:step"),
        ("150:300:25:5", "first:last:step"),
        ("150km/h:300m/s:25", "mixes the units km/h and m/s.*Use one"),
        ("150:300:25kN", r"--speeds \(unit\) = 'kN'.*km/h"),
        ("300:150:25", "ends before it begins"),
        ("150:300:0", "step that is not above 0"),
        ("150:300:-25", "step that is not above 0"),
        ("0:1:1e-9", f"at most {MOST}.*larger step"),
        ("12,5,", "is no range"),
    ],
)
def test_what_is_no_range(text, said):
    with pytest.raises(rb.InputError, match=said):
        written_range("--speeds", text, "speed")


def test_a_range_without_a_step_has_two_ends():
    assert written_ends("--speeds", "36:72km/h", "speed") == pytest.approx((10.0, 20.0))
    assert written_ends("--speeds", "36:72:9km/h", "speed") is None
    assert written_ends("--speeds", "36km/h", "speed") is None
    with pytest.raises(rb.InputError, match="mixes"):
        written_ends("--speeds", "36km/h:72m/s", "speed")


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ([20, 30.0], [20, 30.0]),
        (np.array([1.0, 2.0]), [1.0, 2.0]),
        ({"from": 20.0, "to": 30.0, "step": 5.0}, [20.0, 25.0, 30.0]),
        ({"from": 20.0, "to": 30.0, "count": 3}, [20.0, 25.0, 30.0]),
        (["wheels", "condensed"], ["wheels", "condensed"]),
        ([True, False], [True, False]),
    ],
)
def test_values_of_a_key(given, expected):
    assert values_of("over[x]", given) == expected


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([], "is empty"),
        ([3.0, 2.0], "must ascend"),
        ([2.0, 2.0], "must ascend"),
        ([1.0, float("nan")], "finite"),
        (20.0, "must be a list"),
        ("fast", "must be a list"),
        ({"from": 1.0, "to": 2.0}, "either a step or a count"),
        ({"from": 1.0, "to": 2.0, "step": 1.0, "count": 2}, "either a step or a count"),
        ({"from": 1.0, "to": 2.0, "stp": 1.0}, "Did you mean 'step'"),
        ({"to": 2.0, "step": 1.0}, "from.*is missing"),
        ({"from": 1.0, "to": 2.0, "step": -1.0}, "above 0"),
    ],
)
def test_what_are_no_values(given, said):
    with pytest.raises(rb.InputError, match=said):
        values_of("over[x]", given)
