"""Bounds of the first frequency: values of two sources, both sides of every border."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.codes import frequency_from_deflection, n0_bounds
from railbridge.codes.frequencies import outside_n0_bounds


@pytest.mark.parametrize(("L", "lower", "upper"), [(10, 8.0, 16.929), (36, 2.8263, 6.4940)])
def test_bounds_are_those_of_the_sources(L, lower, upper):
    found = n0_bounds(L)
    assert [float(x) for x in found] == pytest.approx([lower, upper], rel=3e-5)
    assert found.lower.unit == "Hz"


def test_lines_are_straight_on_logarithmic_paper():
    # ln n0 = ln c - p ln L, through two points of each line
    for ends, place, slope in (((5, 18), 0, 1.0), ((25, 90), 0, 0.592), ((5, 90), 1, 0.748)):
        low, high = (float(n0_bounds(L)[place]) for L in ends)
        assert np.log(low / high) / np.log(ends[1] / ends[0]) == pytest.approx(slope, rel=1e-9)


def test_the_lower_bound_is_joined_at_20_m():
    at, behind = (float(n0_bounds(L).lower) for L in (20.0, 20.0 + 1e-6))
    assert at == pytest.approx(4.0, rel=1e-12) and behind == pytest.approx(4.0, rel=1e-3)
    assert behind != at and behind == pytest.approx(23.58 / 20**0.592, rel=1e-6)


@pytest.mark.parametrize(
    ("L", "decided"),
    [(3.999, False), (4.0, True), (100.0, True), (0.1 * 40, True), (100.001, False), (1e3, False)],
)
def test_spans_beyond_the_figure_are_not_decided(L, decided):
    for answer in n0_bounds(L):
        assert answer.decided is decided
        if not decided:
            assert "outside 4 m <= L <= 100 m" in answer.reason


@pytest.mark.parametrize(
    ("n0", "said"), [(7.999, "8 to 16.929 Hz"), (8.0, ""), (16.92, ""), (16.94, "16.929 Hz")]
)
def test_a_frequency_is_inside_or_outside(n0, said):
    reason = outside_n0_bounds(10.0, n0)
    assert said in reason and bool(reason) == bool(said)
    assert "outside 4 m" in outside_n0_bounds(3.0, n0)


def test_frequency_from_deflection_is_that_of_a_uniform_beam():
    # n0 = pi/2 sqrt(EI/m)/L^2, delta = 5 m g L^4/(384 EI): n0 sqrt(delta) = 0.5613 sqrt(m) in SI
    exact = np.pi / 2 * np.sqrt(5 * 9.81 / 384)
    for delta in (1e-3, 0.0123):
        found = float(frequency_from_deflection(delta))
        assert found * np.sqrt(delta) == pytest.approx(exact, rel=2e-3)
    assert float(frequency_from_deflection(1e-3)) == pytest.approx(17.75)


@pytest.mark.parametrize("bad", [0, -1.0, None, "10", True, np.nan, np.inf, [10.0]])
def test_what_is_no_length_is_refused(bad):
    with pytest.raises(rb.InputError, match=r"^L\b.*above 0 m\. Give the span"):
        n0_bounds(bad)
    with pytest.raises(rb.InputError, match=r"^delta0\b.*above 0 m\. Give the deflection"):
        frequency_from_deflection(bad)
    with pytest.raises(rb.InputError, match=r"^n0\b.*above 0 Hz\. Give the first bending"):
        outside_n0_bounds(10.0, bad)
