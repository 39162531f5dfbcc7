"""Irregularities: Eq. 1, Eq. 2, and slopes against numerical derivatives."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railbridge as rb
from railbridge.tracks import FadeIn, extent_of, period_of

metres = st.floats(-300.0, 300.0)


def steepness(irregularity, x, step=1e-5):
    return (irregularity.value(x + step) - irregularity.value(x - step)) / (2 * step)


@given(
    amplitude=st.floats(0, 0.02),
    wavelength=st.floats(0.5, 100.0),
    phase=st.floats(-7, 7),
    at=metres,
)
def test_equation_1_and_its_slope(amplitude, wavelength, phase, at):
    wave = rb.Harmonic(amplitude, wavelength=wavelength, phase=phase)
    x = np.array([at])
    assert wave.value(x)[0] == pytest.approx(
        amplitude * np.sin(2 * np.pi * at / wavelength + phase), abs=1e-15
    )
    assert wave.slope(x) == pytest.approx(
        steepness(wave, x), abs=1e-6 * (1 + amplitude / wavelength)
    )


def test_length_and_half_waves():
    assert rb.Harmonic(5e-3, length=36.0, half_waves=5).wavelength == pytest.approx(14.4)
    assert rb.Harmonic(5e-3, length=37.5, half_waves=5).wavelength == pytest.approx(15.0)
    assert 20.0 / rb.Harmonic(5e-3, length=36.0, half_waves=11.7).wavelength == pytest.approx(3.25)
    # As the paper writes it: A sin(n pi x / l + phi).
    x = np.linspace(0, 36, 50)
    assert rb.Harmonic(2e-3, length=36.0, half_waves=5, phase=0.3).value(x) == pytest.approx(
        2e-3 * np.sin(5 * np.pi * x / 36 + 0.3)
    )


def equation_2(x, a, b, circumference, offset):
    k = np.floor((x - offset) / circumference)
    local = x - k * circumference - offset
    return -a / 2 * (1 - np.cos(2 * np.pi * local / b)) if k >= 0 and local <= b else 0.0


@given(at=st.floats(-20, 60), offset=st.floats(-5, 5))
@settings(max_examples=200)
def test_equation_2_and_its_slope(at, offset):
    notch = rb.Notch(((1, 1),), circumference=2.8, offset=offset, depth=1e-3, length=0.5)
    x = np.array([at])
    turn = ((at - offset) % 2.8) / 2.8
    if min(turn, 1 - turn) > 1e-9:
        assert notch.value(x)[0] == pytest.approx(equation_2(at, 1e-3, 0.5, 2.8, offset), abs=1e-15)
    assert notch.slope(x) == pytest.approx(steepness(notch, x, 1e-6), abs=1e-6)


def test_a_notch_lowers_the_wheel_once_a_turn_from_its_first_contact():
    notch = rb.Notch(((1, 1),), circumference=2.8, offset=1.0, depth=1e-3, length=0.05)
    assert notch.value(np.array([1.025, 3.825, 6.625])) == pytest.approx([-1e-3] * 3)
    assert notch.value(np.array([-1.775, 0.99, 1.06, 2.4])) == pytest.approx(0.0)
    always = rb.Notch(
        ((1, 1),), circumference=2.8, offset=1.0, depth=1e-3, length=0.05, before_entrance=True
    )
    assert always.value(np.array([-1.775])) == pytest.approx(-1e-3)
    assert notch.shortest == 0.05


@given(at=metres, lead_in=st.floats(1.0, 400.0), phase=st.floats(-4, 4))
def test_fade_in_is_smooth_and_leaves_the_second_half_alone(at, lead_in, phase):
    wave = rb.Harmonic(5e-3, wavelength=14.4, phase=phase)
    fade = FadeIn(wave, lead_in)
    x = np.array([at])
    assert fade.slope(x) == pytest.approx(steepness(fade, x), abs=2e-6)
    if at < -lead_in:
        assert fade.value(x) == 0.0
    if at > -lead_in / 2:
        assert fade.value(x) == pytest.approx(wave.value(x), abs=1e-15)
    quarter = np.array([-0.75 * lead_in])
    assert fade.value(quarter) == pytest.approx(0.5 * wave.value(quarter), abs=1e-15)
    for edge in (-lead_in, -lead_in / 2):  # C1: value and slope have no jump
        sides = np.array([edge * (1 - 1e-12), edge * (1 + 1e-12)])
        for f in (fade.value, fade.slope):
            assert np.ptp(f(sides)) < 1e-9


def test_no_lead_in_means_level_before_the_deck():
    fade = FadeIn(rb.Harmonic(5e-3, wavelength=10.0, phase=1.0), 0.0)
    assert fade.value(np.array([-1e-6, 0.0])) == pytest.approx([0.0, 5e-3 * np.sin(1.0)])
    assert fade.slope(np.array([-1e-6])) == 0.0


@given(at=st.floats(-5, 15), seed=st.integers(0, 50))
def test_a_table_is_linear_between_its_points_and_level_beyond(at, seed):
    rng = np.random.default_rng(seed)
    x, r = np.cumsum(rng.uniform(0.5, 2.0, 8)), rng.normal(size=8)
    table = rb.Table(x, r)
    assert table.value(x) == pytest.approx(r)
    assert table.value(np.array([-9.0, 99.0])) == pytest.approx([r[0], r[-1]])
    point = np.array([at])
    if np.min(np.abs(x - at)) > 1e-4:
        assert table.slope(point) == pytest.approx(steepness(table, point), abs=1e-6)
    assert table.shortest == pytest.approx(10 * np.diff(x).min())


def test_a_table_keeps_its_numbers():
    """A shelf hands the same table to several cases."""
    table = rb.Table([0.0, 1.0], [0.0, 2e-3])
    for values in (table.x, table.r):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 5.0


def test_a_notch_is_no_longer_than_its_wheel_is_round():
    with pytest.raises(rb.InputError, match=r"^length = 3.0: .*at most 2.7 m"):
        rb.Notch(((1, 1),), 2.7, 1.0, 1e-3, 3.0)
    assert rb.Notch(((1, 1),), 2.7, 1.0, 1e-3, 2.7).length == 2.7


@pytest.mark.parametrize("wheels", [5, (), None, [(1,)], [1, 1], "11", {(1, 1): 2}])
def test_a_notch_s_wheels_are_pairs(wheels):
    with pytest.raises(rb.InputError, match="wheels"):
        rb.Notch(wheels, 2.7, 1.0, 1e-3, 0.05)


def test_a_wavelength_that_vanishes_is_refused():
    with pytest.raises(rb.InputError, match=r"^wavelength = 2.*e-60: .*above 0 m"):
        rb.Harmonic(1e-3, length=1e-30, half_waves=1e30)


def test_sums_rails_and_levels():
    a, b = rb.Harmonic(5e-3, wavelength=14.4), rb.Harmonic(1e-3, wavelength=3.0, phase=0.4)
    x = np.linspace(-3, 40, 77)
    track = rb.Track(vertical=[a, [b, b]], lateral=rb.Rails(left=a, right=[a, b]))
    both = track.rail("vertical", "left")
    assert both is track.rail("vertical", "right")
    assert both.value(x) == pytest.approx(a.value(x) + 2 * b.value(x))
    assert both.slope(x) == pytest.approx(a.slope(x) + 2 * b.slope(x))
    assert track.rail("lateral", "left") is a
    assert track.rail("lateral", "right").value(x) == pytest.approx(a.value(x) + b.value(x))
    assert track.shortest == 3.0
    level = rb.Track()
    assert level.shortest == np.inf
    assert (
        not level.rail("vertical", "left").value(x).any()
        and not level.rail("lateral", "right").slope(x).any()
    )
    assert rb.Track(vertical=rb.Harmonic(0.0, wavelength=1e-3)).shortest == np.inf
    one_rail = rb.Track(vertical=rb.Rails(left=a))
    assert one_rail.rail("vertical", "right").value(x) == pytest.approx(0.0)


@pytest.mark.parametrize("wrong", [5, "rough", [5], rb.Rails(left=3.0), {"kind": "harmonic"}])
def test_what_is_no_irregularity_is_refused(wrong):
    with pytest.raises(rb.InputError, match="vertical.*must be an irregularity"):
        rb.Track(vertical=wrong)


class Known:
    """A level rail that is known between two places, and that repeats."""

    shortest = np.inf

    def __init__(self, extent=None, period=None):
        self.extent, self.period = extent, period

    value = slope = staticmethod(np.zeros_like)


def test_where_an_irregularity_is_known_and_where_it_repeats():
    assert extent_of(rb.Level()) == (-np.inf, np.inf) and period_of(rb.Level()) == np.inf
    assert extent_of(Known()) == (-np.inf, np.inf) and period_of(Known()) == np.inf
    parts = [rb.Level(), Known((-5.0, 30.0), 200.0), [Known((-2.0, 40.0), 300.0)]]
    rail = rb.Track(vertical=parts).rail("vertical", "left")
    for found in (rail, FadeIn(rail, 10.0)):
        assert extent_of(found) == (-2.0, 30.0) and period_of(found) == 200.0
