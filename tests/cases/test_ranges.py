"""Ranges as people write them: what they mean, and each slip in words."""

import numpy as np
import pytest

from railbridge.cases.ranges import MOST, unit_of, values_of, written_ends, written_range
from railbridge.errors import InputError


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("150:300:25km/h", np.arange(150, 301, 25) / 3.6),
        ("150km/h:300km/h:75 km/h", np.array([150, 225, 300]) / 3.6),
        ("20, 25, 30 m/s", [20, 25, 30]), ("20", [20]), ("1:2:0.3", [1, 1.3, 1.6, 1.9, 2]),
        ("0:0.3:0.1", [0, 0.1, 0.2, 0.3]), ("1e-3:3e-3:1e-3", [1e-3, 2e-3, 3e-3]),
        ("150:300:7km/h", [*np.arange(150, 300, 7) / 3.6, 300 / 3.6]), ("1:1:5", [1]),
        ("1:2:5", [1, 2]),
    ],
)  # fmt: skip
def test_a_range_in_words(text, found):
    assert written_range("--speeds", text, "speed") == pytest.approx(found, abs=1e-11)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "no range"), ("a:b:c", "no range"), ("1,,2", "no range"), ("1:2", "first:last:step"),
        ("1:2:0", "not above 0"), ("1:2:-1", "not above 0"), ("2:1:1", "ends before"),
        ("1km/h:2:1m/s", "mixes the units"), ("1:2:1kN", "unit"), ("1:9:1e-9", f"at most {MOST}"),
        ("1e999", "finite"),
        ("1:1e999:1", "finite"), ("nan", "no range"),
        ("150-300km/h", "use a colon"), ("150 \u2013 300:5km/h", "use a colon"),
    ],
)  # fmt: skip
def test_slips_of_a_range_in_words(text, why):
    with pytest.raises(InputError, match=f"--speeds.*{why}"):
        written_range("--speeds", text, "speed")


def test_values_of_lists_and_tables():
    assert values_of("over", {"from": 1, "to": 2, "step": 0.5}) == [1.0, 1.5, 2.0]
    assert values_of("over", {"from": 1, "to": 2, "count": 3}) == [1.0, 1.5, 2.0]
    to_the_end = values_of("over", {"from": 41.67, "to": 83.33, "step": 1.389})
    assert (len(to_the_end), to_the_end[-1]) == (31, 83.33)
    assert values_of("over", np.array([1.0, 2.0])) == [1.0, 2.0]
    assert values_of("over", ["b", "a"]) == ["b", "a"]


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ([], "is empty"), ("abc", "list of values"), (3.0, "list of values"),
        (np.array(3.0), "list of values"), ([2.0, 1.0], "must ascend"), ([1, 1.0], "must ascend"),
        (["a", "a"], "twice"), ([1.0, float("nan")], "finite"), (range(MOST + 1), "at most"),
        ({"from": 0, "to": 1}, "step or a count"), ({"from": 0, "step": 1}, "to"),
        ({"from": 0, "to": 1e12, "step": 1e-299}, "counted|step"),
        ({"from": 0, "to": 1, "step": 1, "cout": 2}, "count"),
        ({"from": 1, "to": 0, "step": 1}, "ends before"),
    ],
)  # fmt: skip
def test_slips_of_values(given, why):
    with pytest.raises(InputError, match=why):
        values_of("over[run.speed]", given)


@pytest.mark.parametrize(
    ("text", "unit"), [("150:300km/h", "km/h"), ("20, 30 m / s", "m/s"), ("20:30:5", "")]
)
def test_the_unit_of_a_range(text, unit):
    assert unit_of(text) == unit


def test_a_range_without_a_step_has_two_ends():
    assert written_ends("--speeds", "36:72km/h", "speed") == pytest.approx((10.0, 20.0))
    assert written_ends("--speeds", "36:72:9km/h", "speed") is None
    assert written_ends("--speeds", "36km/h", "speed") is None
    with pytest.raises(InputError, match="mixes"):
        written_ends("--speeds", "36km/h:72m/s", "speed")
