"""Ride: filter values of the sources, filters against the spectrum of the record, indices."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import (
    largest_running_rms,
    ride_class_limit,
    sperling,
    sperling_weighting,
    weighted,
    weighted_rms,
    weighting,
)

WB = [(0.5, 0.3354), (1, 0.3911), (2, 0.4367), (5, 0.9570), (8, 1.0559), (16, 0.9183), (40, 0.4142)]
WD = [(1, 1.011), (4, 0.512)]
B = [(1, 0.4891), (2, 0.6101), (5, 0.8128), (10, 0.4930)]
NAMES = ["Wb", "Wc", "Wd"]


def sine(f, step=1e-3, seconds=40.0, amplitude=1.0):
    return amplitude * np.sin(2 * np.pi * f * np.arange(0.0, seconds, step))


def test_gains_are_those_of_the_sources():
    for f, gain in WB:
        assert weighting("Wb", f) == pytest.approx(gain, abs=6e-5)
    for f, gain in WD:
        assert weighting("Wd", f) == pytest.approx(gain, abs=5.1e-4)
    for f, gain in B:
        assert sperling_weighting("vertical", f) == pytest.approx(gain, abs=5.1e-5)


def test_gains_come_in_the_shape_that_is_asked_for():
    assert isinstance(weighting("Wc", 3), float)
    several = weighting("Wc", [1.0, 3.0])
    assert several.shape == (2,) and several[1] == weighting("Wc", 3.0)
    assert weighting("Wb", 0.0) == 0.0 and sperling_weighting("lateral", np.array([0.0]))[0] == 0.0


def test_sperling_is_its_formula_in_squares():
    f = np.linspace(0.1, 40.0, 200)
    above = 1.911 * f**2 + (0.25 * f**2) ** 2
    below = (1 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2
    for direction, factor in (("vertical", 0.588), ("lateral", 0.737)):
        found = sperling_weighting(direction, f)
        assert found == pytest.approx(factor * np.sqrt(above / below), rel=1e-10)


def test_far_from_its_corners_a_weighting_is_flat_or_falls():
    # Wd passes accelerations between 0.4 and 2 Hz, and velocities from there: gain 2 Hz / f.
    assert weighting("Wd", 30.0) * 30.0 == pytest.approx(2.0 * 1.0, rel=0.02)
    assert weighting("Wc", 2.0) == pytest.approx(1.0, abs=0.02)
    # Below the band the gain falls by 100 in ten.
    assert weighting("Wc", 0.004) / weighting("Wc", 0.04) == pytest.approx(0.01, rel=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_a_filtered_sine_has_the_gain(name):
    for step, error in ((1e-3, 2e-3), (2.5e-3, 9e-3)):
        for f in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0):
            settled = weighted(sine(f, step), step, name)[round(20 / step) :]
            rms = np.sqrt(2 * np.mean(settled**2))
            assert rms == pytest.approx(weighting(name, f), rel=error), (step, f)
    settled = weighted(sine(40.0, 2.5e-3), 2.5e-3, name)[8000:]
    assert np.sqrt(2 * np.mean(settled**2)) == pytest.approx(weighting(name, 40.0), rel=0.04)


def test_a_filter_agrees_with_the_spectrum():
    """A pulse train in the frequency domain: Parseval over the spectrum of the record."""
    step, n = 1e-3, 2**15
    t = np.arange(n) * step
    record = np.exp(-(((t - 6.0) / 0.4) ** 2)) * np.sin(2 * np.pi * 3 * t)
    record += 0.3 * np.exp(-(((t - 8.0) / 0.2) ** 2)) * np.cos(2 * np.pi * 11 * t)
    spectrum, f = np.fft.rfft(record), np.fft.rfftfreq(n, step)
    for name in NAMES:
        exact = np.sqrt(2 * np.sum(np.abs(spectrum * weighting(name, f)) ** 2)) / n
        assert float(weighted_rms(record, step, name)) == pytest.approx(exact, rel=5e-4)
    for direction in ("vertical", "lateral"):
        gain = sperling_weighting(direction, f)
        exact = np.sqrt(2 * np.sum(np.abs(spectrum * gain) ** 2)) / n
        found = float(sperling(record, step, direction))
        assert found == pytest.approx(4.42 * exact**0.3, rel=3e-4)


def test_sperling_index_of_a_sine():
    for direction, f in (("vertical", 1.0), ("lateral", 5.0)):
        exact = 4.42 * (sperling_weighting(direction, f) * 0.5 / np.sqrt(2)) ** 0.3
        record = sine(f, amplitude=0.5, seconds=100.0)
        assert float(sperling(record, 1e-3, direction)) == pytest.approx(exact, rel=1e-3)
    # By hand: B(1 Hz) = 0.4891, 4.42 (0.4891 x 0.3536)^0.3 = 2.6108
    vertical = float(sperling(sine(1.0, amplitude=0.5, seconds=100.0), 1e-3, "vertical"))
    assert vertical == pytest.approx(2.611, abs=3e-3)


def test_sperling_grows_with_the_power_0_3():
    record = sine(2.0, seconds=10.0)
    ratio = float(sperling(8 * record, 1e-3, "lateral")) / float(sperling(record, 1e-3, "lateral"))
    assert ratio == pytest.approx(8**0.3, rel=1e-9)
    assert float(sperling(np.zeros(100), 1e-3, "lateral")) == 0.0


def test_filters_are_causal_and_begin_at_rest():
    record = sine(3.0, seconds=4.0)
    whole, part = weighted(record, 1e-3, "Wb"), weighted(record[:1500], 1e-3, "Wb")
    assert whole[:1500] == pytest.approx(part, abs=1e-12) and len(whole) == len(record)


def test_running_rms_finds_the_worst_second():
    record = sine(5.0, seconds=10.0)
    record[6000:] = 0.0
    record[2000:4000] *= 3.0
    squares = weighted(record, 1e-3, "Wb") ** 2
    by_loop = max(np.mean(squares[i : i + 1000]) for i in range(len(squares) - 999))
    found = largest_running_rms(record, 1e-3, "Wb")
    assert float(found) == pytest.approx(np.sqrt(by_loop), rel=1e-9)
    assert float(found) == pytest.approx(3 * 0.9570 / np.sqrt(2), rel=0.02)
    assert float(found) > float(weighted_rms(record, 1e-3, "Wb"))
    assert found.unit == "m/s2" and found.clause.grade == "one"


def test_a_record_shorter_than_the_window_is_not_decided():
    short = largest_running_rms(np.ones(999), 1e-3, "Wb")
    assert not short.decided and "0.999 s is shorter than the window of 1 s" in short.reason
    assert largest_running_rms(np.ones(1000), 1e-3, "Wb").decided
    assert largest_running_rms(np.ones(500), 1e-3, "Wb", window=0.5).decided
    whole = largest_running_rms(sine(5.0, seconds=1.0), 1e-3, "Wb")
    same = weighted_rms(sine(5.0, seconds=1.0), 1e-3, "Wb")
    assert float(whole) == pytest.approx(float(same), rel=1e-12)


def test_classes():
    assert [float(ride_class_limit(i)) for i in (1, 2, 3)] == [2.5, 2.75, 3.0]
    for number in (0, 4, 1.5, "1", None):
        with pytest.raises(rb.InputError, match=r"^number\b.*1 is the best class"):
            ride_class_limit(number)


RECORDS = [
    lambda a, dt: weighted(a, dt, "Wb"),
    lambda a, dt: weighted_rms(a, dt, "Wd"),
    lambda a, dt: largest_running_rms(a, dt, "Wc"),
    lambda a, dt: sperling(a, dt, "vertical"),
]


@pytest.mark.parametrize("rule", RECORDS)
def test_bad_records(rule):
    for record in ([], [1.0], 3.0, "abc", [0.0, np.nan], [[0.0, 1.0]], None):
        with pytest.raises(rb.InputError, match=r"^acceleration"):
            rule(record, 1e-3)
    for step in (0.0, -1e-3, 2.51e-3, None, "1", np.nan):
        with pytest.raises(rb.InputError, match=r"^time_step\b.*at most 0.0025 s.*shorter time"):
            rule(np.ones(3000), step)
    rule(np.ones(3000), 2.5e-3)


def test_other_names_are_refused():
    for call in (lambda: weighting("Wk", 1.0), lambda: weighted([0, 0], 1e-3, "Wk")):
        with pytest.raises(rb.InputError, match=r"^name = 'Wk': must be one of Wb, Wc, Wd"):
            call()
    for call in (lambda: sperling_weighting("up", 1.0), lambda: sperling([0, 0], 1e-3, "up")):
        with pytest.raises(rb.InputError, match=r"^direction = 'up': must be one of vertical, lat"):
            call()
    for f in (-1.0, "1", None, np.nan):
        with pytest.raises(rb.InputError, match=r"^f\b.*at least 0 Hz\. Give frequencies"):
            weighting("Wb", f)
    with pytest.raises(rb.InputError, match=r"^window\b.*Take 1 s"):
        largest_running_rms(np.ones(3000), 1e-3, "Wb", window=0.0)
