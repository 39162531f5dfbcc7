"""Damping of a deck: the paper's two constants, a ratio for each mode, what is refused."""

import numpy as np
import pytest

import railbridge as rb

L, M, EI = 36.0, 12e3, 8.93e10


def simple(damping, modes):
    beam = rb.Beam("simple", (L,), M, EI, 8.9e11, 8.15e10, polar_inertia=7.02e4)
    return beam.deck(modes, damping)


def test_rayleigh_of_the_paper():
    alpha, beta = rb.rayleigh(0.03, [3.307, 16.30])
    assert (alpha, beta) == pytest.approx((1.0364, 4.870e-4), rel=2e-4)
    assert rb.rayleigh_ratio(alpha, beta, np.array([3.307, 16.30])) == pytest.approx([0.03, 0.03])
    least = np.sqrt(alpha / beta) / 2 / np.pi
    assert least == pytest.approx(7.34, abs=0.01)
    assert rb.rayleigh_ratio(alpha, beta, np.array([least, 13.23, 1.389])) == pytest.approx(
        [0.0225, 0.0265, 0.0615], abs=6e-5
    )
    critical = (1 + np.sqrt(1 - alpha * beta)) / beta / 2 / np.pi
    assert critical == pytest.approx(653, abs=1.0)
    assert rb.deck("viaduct36").damping_ratios[0] == pytest.approx(0.03, abs=1e-5)


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ((0.6, [1, 2]), "ratio = 0.6"),
        ((-0.1, [1, 2]), "ratio = -0.1"),
        ((0.03, [2, 2]), "frequencies_hz"),
        ((0.03, [1]), "frequencies_hz"),
        ((0.03, [0, 1]), r"frequencies_hz\[1\] = 0"),
        ((0.03, 5), "frequencies_hz = 5"),
    ],
)
def test_rayleigh_refuses(wrong, named):
    with pytest.raises(rb.InputError, match=f"^{named}"):
        rb.rayleigh(*wrong)


def test_a_ratio_for_each_mode_and_the_last_for_all_higher_ones():
    per_mode = rb.ModalDamping((0.03, 0.02, 0.015))
    deck = simple(per_mode, 6)
    assert deck.damping_ratios.tolist() == [0.03, 0.02, 0.015, 0.015, 0.015, 0.015]
    assert deck.internal_damping == 0.0
    assert simple(per_mode, 2).damping_ratios.tolist() == [0.03, 0.02]
    assert simple(rb.ModalDamping([0.5]), 3).damping_ratios.tolist() == [0.5] * 3
    # Two ratios are not alpha and beta.
    two = simple(rb.ModalDamping((0.03, 0.02)), 3)
    assert two.damping_ratios.tolist() == [0.03, 0.02, 0.02]
    assert simple((0.03, 0.02), 3).internal_damping == 0.02


@pytest.mark.parametrize(
    ("ratios", "words"),
    [
        ((), r"^ratios = \[\]: must hold at least one"),
        ((0.01, 0.51), r"^ratios\[2\] = 0.51: must be .* at least 0 and at most 0.5\."),
        ((-1e-3,), r"^ratios\[1\] = -0.001: "),
        (0.03, r"^ratios = 0.03: must be a list of numbers"),
    ],
)
def test_ratios_that_cannot_be_are_refused(ratios, words):
    with pytest.raises(rb.InputError, match=words):
        rb.ModalDamping(ratios)


def test_one_mode_rings_down_with_its_own_ratio():
    """Between two peaks of free vibration after a load has left: exp(-2 pi zeta / sqrt(1 - z2))."""
    ratios = rb.ModalDamping((0.04, 0.01))
    deck = rb.Beam("b", (L,), M, EI).deck(1, ratios)
    run = rb.cross(rb.AxleTrain((0.0,), (1e5,)), deck, speed=40.0, time_step=2e-3, tail=4.0)
    moved = run.displacement(x=18.0)["displacement_z"][run.time > 36.0 / 40.0]
    peaks = np.flatnonzero((moved[1:-1] > moved[:-2]) & (moved[1:-1] > moved[2:])) + 1
    decay = np.diff(np.log(moved[peaks[:5]]))
    assert decay == pytest.approx([-2 * np.pi * 0.04 / np.sqrt(1 - 0.04**2)] * 4, rel=2e-3)
