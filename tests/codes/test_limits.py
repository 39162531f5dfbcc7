"""Limits: the table of the facts, typed again, and both sides of every speed."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import codes
from railbridge.codes import frequency_limit, kept_modes

KMH = 1 / 3.6
# By speed: to 120 km/h, to 200 km/h, above. Twist in mm, rotation in mrad, radii in m.
BY_SPEED = {
    "twist": (codes.twist_limit, 1e-3, (4.5, 3.0, 1.5)),
    "rotation": (codes.horizontal_rotation_limit, 1e-3, (3.5, 2.0, 1.5)),
    "one span": (codes.horizontal_radius_limit, 1.0, (1700, 6000, 14000)),
    "two spans": (lambda v: codes.horizontal_radius_limit(v, 2), 1.0, (3500, 9500, 17500)),
    "nine spans": (lambda v: codes.horizontal_radius_limit(v, spans=9), 1.0, (3500, 9500, 17500)),
}


@pytest.mark.parametrize("name", BY_SPEED)
def test_limits_by_speed(name):
    limit, unit, (slow, middle, fast) = BY_SPEED[name]
    for kmh, expected in (
        (0, slow), (119.99, slow), (120, slow), (120.01, middle), (199.99, middle),
        (200, middle), (200.01, fast), (350, fast),
    ):  # fmt: skip
        assert float(limit(kmh * KMH)) == pytest.approx(unit * expected, rel=1e-12), kmh
        assert float(limit(kmh / 3.6)) == float(limit(kmh * KMH))


SINGLE = [
    (lambda: codes.acceleration_limit("ballasted"), 3.5, "m/s2", "at most"),
    (lambda: codes.acceleration_limit("direct fastening"), 5.0, "m/s2", "at most"),
    (lambda: codes.total_twist_limit(), 7.5e-3, "m", "at most"),
    (lambda: codes.deflection_limit(36.0), 0.06, "m", "at most"),
    (lambda: codes.lateral_frequency_limit(), 1.2, "Hz", "at least"),
    (lambda: codes.comfort_limit(), 1.0, "m/s2", "at most"),
    (lambda: codes.comfort_limit("good"), 1.3, "m/s2", "at most"),
    (lambda: codes.comfort_limit("acceptable"), 2.0, "m/s2", "at most"),
    (lambda: codes.wheel_unloading_limit(), 0.6, "", "at most"),
    (lambda: codes.uplift_limit(), 0.0, "N", "at least"),
    (lambda: codes.twist_limit(30.0), 4.5e-3, "m", "at most"),
    (lambda: codes.horizontal_rotation_limit(30.0), 3.5e-3, "rad", "at most"),
    (lambda: codes.horizontal_radius_limit(30.0), 1700.0, "m", "at least"),
]


@pytest.mark.parametrize(("limit", "value", "unit", "sense"), SINGLE)
def test_values_units_and_senses(limit, value, unit, sense):
    answer = limit()
    assert float(answer) == pytest.approx(value, rel=1e-14)
    assert (answer.unit, answer.clause.sense) == (unit, sense)


def test_what_rests_on_memory_says_so():
    for answer in (codes.wheel_unloading_limit(), codes.uplift_limit(), frequency_limit([1, 2, 3])):
        assert answer.clause.grade == "memory" and "from memory, not seen" in repr(answer)
    assert codes.acceleration_limit("ballasted").clause.grade == "two"


@pytest.mark.parametrize(
    ("frequencies", "limit", "kept"),
    [
        ([4.0, 9.0, 16.0, 25.0, 36.0], 30.0, 4),
        ([4.0, 9.0, 16.0, 30.0, 30.01], 30.0, 4),
        ([21.0, 22.0, 23.0, 31.5, 31.6], 31.5, 4),
        ([20.0, 21.0, 22.0, 30.5], 30.0, 3),
        ([8.0, 20.0, 45.0, 45.1], 45.0, 3),
        ([8.0, 20.0, 45.0], 45.0, 3),
        ([8.0, 8.0, 8.0, 20.0, 20.0, 20.0, 45.0, 45.0001, 80.0], 45.0001, 8),  # spans alike
    ],
)
def test_modes_up_to_the_largest_of_three(frequencies, limit, kept):
    assert float(frequency_limit(frequencies)) == pytest.approx(limit)
    found = kept_modes(frequencies)
    assert found.numbers == tuple(range(1, kept + 1)) and float(found.limit) == limit
    # Only a list that goes on beyond the limit surely holds all.
    assert found.complete is (len(frequencies) > kept)


def test_without_a_third_mode_nothing_is_decided():
    assert not frequency_limit([5.0, 20.0]).decided
    found = kept_modes([5.0, 40.0])
    assert found.numbers == () and not found.complete
    assert "third frequency is not known, only 2" in found.limit.reason
    assert not frequency_limit([8.0, 8.0, 8.0, 20.0]).decided  # spans alike count once


@pytest.mark.parametrize("bad", [[], [3.0, 2.0, 5.0], [0.0, 1.0, 2.0], 5.0, ["a"], [1, 2, np.nan]])
def test_bad_frequencies(bad):
    for rule in (frequency_limit, kept_modes):
        with pytest.raises(rb.InputError, match=r"^frequencies"):
            rule(bad)


@pytest.mark.parametrize("bad", [-0.1, None, "30", True, np.nan, np.inf])
def test_bad_speeds_and_lengths(bad):
    for limit, _, _ in BY_SPEED.values():
        with pytest.raises(rb.InputError, match=r"^v\b.*at least 0 m/s\. Divide km/h by 3\.6"):
            limit(bad)
    with pytest.raises(rb.InputError, match=r"^L\b.*above 0 m\. Give the span"):
        codes.deflection_limit(bad)


def test_other_names_are_refused():
    with pytest.raises(rb.InputError, match=r"^track = 'balasted'.*Did you mean 'ballasted'"):
        codes.acceleration_limit("balasted")
    with pytest.raises(rb.InputError, match=r"^level\b.*very good, good, acceptable"):
        codes.comfort_limit("bad")
    for spans in (0, 1.5, None, "one"):
        with pytest.raises(rb.InputError, match=r"^spans\b.*Give the number of spans"):
            codes.horizontal_radius_limit(30.0, spans)
