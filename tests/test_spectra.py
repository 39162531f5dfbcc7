"""Amplitude spectrum and Eq. 3 on signals whose spectrum is known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import railbridge as rb


def test_a_whole_number_of_periods_is_one_line_of_its_amplitude():
    t = np.arange(3000) * 1e-3
    spectrum = rb.amplitude_spectrum(
        7.0 + 5.0 * np.sin(2 * np.pi * 4.0 * t) + 2.0 * np.cos(2 * np.pi * 9.0 * t), 1e-3
    )
    assert len(spectrum.amplitude) == 60
    assert spectrum.frequency[:3] == pytest.approx([1 / 3, 2 / 3, 1.0])
    assert spectrum.peak == pytest.approx((4.0, 5.0))
    assert spectrum.amplitude[26] == pytest.approx(2.0)
    rest = np.delete(spectrum.amplitude, [11, 26])
    assert np.all(rest < 1e-10)
    assert list(spectrum.to_frame().columns) == ["frequency (Hz)", "amplitude (N)"]


def test_a_spectrum_says_its_unit_and_the_largest_line_in_plain_numbers():
    assert rb.Spectrum(np.ones(1), np.ones(1)).unit == "N"
    counted = rb.amplitude_spectrum([1, -1] * 50, 0.5, bins=200, unit="kN m")
    assert (counted.unit, len(counted.amplitude)) == ("kN m", 50)
    assert list(counted.to_frame().columns)[1] == "amplitude (kN m)"
    assert counted.frequency[-1] == 1.0  # the fastest that samples half a second apart show
    assert [type(number) for number in counted.peak] == [float, float]


def test_equation_3_has_no_value_where_the_reference_is_round_off():
    def spectrum(size):
        return rb.Spectrum(np.ones(1), np.array([size]))

    assert np.isnan(rb.deviation_percent(spectrum(1.0), spectrum(0.9e-9)))
    known = 100 * (1 / 1.1e-9 - 1)
    assert rb.deviation_percent(spectrum(1.0), spectrum(1.1e-9)) == pytest.approx(known)
    assert rb.deviation_percent(spectrum(0.0), spectrum(1.0)) == -100.0


def test_equation_3_by_hand():
    def spectrum(*lines):
        return rb.Spectrum(np.arange(1, len(lines) + 1) / 3, np.array(lines))

    assert rb.deviation_percent(spectrum(3.0, 4.0), spectrum(0.0, 4.0)) == pytest.approx(25.0)
    assert rb.deviation_percent(spectrum(0.0, 4.0), spectrum(3.0, 4.0)) == pytest.approx(-20.0)
    assert np.isnan(rb.deviation_percent(spectrum(1.0), spectrum(0.0)))


@given(scale=st.floats(0.1, 10.0), shift=st.floats(-1e6, 1e6), seed=st.integers(0, 1000))
def test_scaling_and_shifting_a_record(scale, shift, seed):
    signal = np.random.default_rng(seed).normal(size=500)
    base = rb.amplitude_spectrum(signal, 0.01)
    other = rb.amplitude_spectrum(scale * signal + shift, 0.01)
    assert rb.deviation_percent(other, base) == pytest.approx(100 * (scale - 1), abs=1e-4)


@pytest.mark.parametrize(
    ("signal", "step", "bins", "field"),
    [
        (np.ones(9), -0.01, 60, "time_step"), (np.ones(9), 0.0, 60, "time_step"),
        (np.ones(9), np.nan, 60, "time_step"), (np.ones(9), "1", 60, "time_step"),
        (np.ones(9), np.array([0.1]), 60, "time_step"), ([], 0.1, 60, "signal"),
        ([1.0, np.nan], 0.1, 60, "signal[2]"), (5.0, 0.1, 60, "signal"), ("abc", 0.1, 60, "signal"),
        (np.array(5.0), 0.1, 60, "signal"), (np.ones((2, 2)), 0.1, 60, "signal[1]"),
        (np.ones(9), 0.1, 0, "bins"), (np.ones(9), 0.1, 2.5, "bins"),
    ],
)  # fmt: skip
def test_what_has_no_spectrum_is_refused(signal, step, bins, field):
    with pytest.raises(rb.InputError) as error:
        rb.amplitude_spectrum(signal, step, bins)
    assert error.value.field == field
