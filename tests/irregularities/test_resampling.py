"""Even grids and bands of wavelengths, against waves that are known."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.irregularities.resampling import band_limited, even

STEP = 0.25
X = STEP * np.arange(8001)
MIDDLE = slice(2000, 6001)


def wave(length, x=X):
    return 1e-3 * np.sin(2 * np.pi * x / length + 0.4)


@pytest.mark.parametrize("length", [3.0, 4.7, 25.0, 70.0, 150.0])
def test_waves_of_the_band_pass_as_they_are(length):
    left = band_limited(wave(length), STEP, (3.0, 150.0))
    # 500 m from the ends the longest wave still knows of them.
    assert left[MIDDLE] == pytest.approx(wave(length)[MIDDLE], abs=2e-5 if length > 100 else 3e-6)


@pytest.mark.parametrize("length", [0.7, 1.5, 2.1, 213.0, 400.0, 900.0])
def test_waves_half_an_octave_outside_are_gone(length):
    left = band_limited(wave(length), STEP, (3.0, 150.0))
    assert np.abs(left[MIDDLE]).max() < (2e-5 if length > 100 else 3e-6)


def test_half_of_a_wave_passes_in_the_middle_of_the_roll_off():
    for length in (3.0 / 2**0.25, 150.0 * 2**0.25):
        left = band_limited(wave(length), STEP, (3.0, 150.0))
        assert left[MIDDLE] == pytest.approx(0.5 * wave(length)[MIDDLE], abs=2e-5)


def test_a_straight_line_is_taken_out_and_no_end_comes_round_to_the_other():
    assert np.abs(band_limited(1e-3 + 5e-5 * X, STEP, (3.0, 150.0))).max() < 1e-12
    pulse = np.where(X < 2.0, 1e-3, 0.0)
    left = band_limited(pulse, STEP, (3.0, 25.0))
    # At the other end stands the line that was taken out, 2e-6 high.
    assert np.abs(left[-2000:]).max() < 2e-6 and np.abs(left[:10]).max() > 1e-4


def test_the_result_turns_with_the_record():
    r = np.random.default_rng(1).normal(size=999)
    turned = band_limited(r[::-1], STEP, (3.0, 70.0))[::-1]
    assert band_limited(r, STEP, (3.0, 70.0)) == pytest.approx(turned, abs=1e-12)


def test_even_places_keep_their_samples():
    place = 12.0 + 0.1 * np.arange(50)
    r = np.random.default_rng(0).normal(size=50)
    first, step, found = even(place, {"a": r})
    assert (first, step) == pytest.approx((12.0, 0.1)) and found["a"] is r


def test_uneven_places_are_met_by_a_spline():
    rng = np.random.default_rng(0)
    place = STEP * np.arange(2001) + rng.uniform(-0.05, 0.05, 2001)
    first, step, found = even(place, {"a": wave(5.0, place)})
    x = first + step * np.arange(len(found["a"]))
    assert step == pytest.approx(STEP, abs=2e-3) and place[-1] - step < x[-1] <= place[-1]
    assert found["a"] == pytest.approx(wave(5.0, x), abs=1e-6)
    with pytest.raises(rb.InputError, match="at least four samples"):
        even(place[:3], {"a": place[:3]})
