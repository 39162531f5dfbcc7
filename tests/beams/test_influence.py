"""Rotations of sections: influence lines and modal values, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb

L, M, EI, EIZ = 20.0, 1e4, 1.3e10, 4.1e11
PLAIN = rb.Beam("simple", (L,), M, EI, EIZ)
SHEAR = rb.Beam("soft in shear", (L,), M, EI, EIZ, shear_stiffness_vertical=6e8)
TWO_SPANS = rb.Beam("two spans", (20.0, 30.0), M, EI, EIZ, shear_stiffness_vertical=6e8)
TURNING = ("rotation_y", "rotation_z")


@pytest.mark.parametrize("beam", [PLAIN, SHEAR], ids=["rigid in shear", "soft in shear"])
def test_the_end_of_a_simple_beam_turns_by_the_book(beam):
    """F L^2 / 16 EI under a force at mid-span, F a b (L + b) / 6 EI L at the near end; statically
    determinate, so psi does not know of the shear."""
    deck, middle = beam.deck(6), np.array([L / 2])
    known = L**2 / 16 / EI
    for end, sign in ((0.0, -1.0), (L, 1.0)):
        found = deck.influence("rotation_y", at=end, places=middle)
        assert found == pytest.approx([sign * known], rel=1e-9)
        sideways = deck.influence("rotation_z", at=end, places=middle)
        assert sideways == pytest.approx([-sign * L**2 / 16 / EIZ], rel=1e-9)
    a = np.array([0.0, 3.0, 7.7, 13.0, L])
    b = L - a
    found = deck.influence("rotation_y", at=0.0, places=a)
    assert found == pytest.approx(-a * b * (L + b) / 6 / EI / L, rel=1e-9, abs=1e-18)
    assert deck.influence("rotation_y", at=0.0, places=a, load="y") == pytest.approx(0.0)


@pytest.mark.parametrize("at", [0.0, 5.0, 5.3, 7.7, 10.0, 19.999, 20.0])
def test_a_section_turns_as_the_moments_before_it_bend(at):
    """psi(x) = psi(0) + integral of M / EI of a simple beam, with its shear or without."""
    a = np.array([2.0, 5.0, 9.1, 16.0])
    b = L - a
    psi = a * b * (L + b) / 6 / EI / L - b * at**2 / 2 / EI / L
    psi += np.where(at > a, (at - a) ** 2 / 2 / EI, 0.0)
    for beam in (PLAIN, SHEAR):
        found = beam.deck(6).influence("rotation_y", at=at, places=a)
        assert found == pytest.approx(-psi, rel=1e-9, abs=1e-9 * L**2 / EI)


@pytest.mark.parametrize("quantity", TURNING)
@pytest.mark.parametrize("at", [3.0, 10.0, 27.3])
def test_rigid_in_shear_it_is_the_slope_of_the_axis(quantity, at):
    deck = rb.Beam("two spans", (20.0, 30.0), M, EI, EIZ).deck(12)
    moved, sign = ("displacement_z", -1.0) if quantity == "rotation_y" else ("displacement_y", 1.0)
    x, step = np.linspace(0.0, 50.0, 41), 1e-3
    before, after = (deck.recovery.section(moved, at + d) for d in (-step, step))
    line = deck.recovery.section(quantity, at)
    slope = sign * (after.influence(x) - before.influence(x)) / (2 * step)
    assert line.influence(x) == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())
    modal = sign * (after.modal - before.modal) / (2 * step)
    assert line.modal == pytest.approx(modal, abs=1e-5 * np.abs(modal).max())
    weight = sign * (after.self_weight - before.self_weight) / (2 * step)
    assert line.self_weight == pytest.approx(weight, abs=1e-6 * abs(weight) + 1e-15)


def test_soft_in_shear_the_axis_slopes_more_than_the_section_turns():
    """Beside the force w' = psi + V / kGA: half the force at mid-span on either side."""
    deck, step = SHEAR.deck(6), 1e-4
    middle = np.array([L / 2])
    w = [deck.influence("displacement_z", at=x, places=middle)[0] for x in (4.0, 4.0 + step)]
    turned = deck.influence("rotation_y", at=4.0 + step / 2, places=middle)[0]
    assert (w[1] - w[0]) / step == pytest.approx(-turned + 0.5 / 6e8, rel=1e-6)


def test_an_inner_bearing_of_a_continuous_beam():
    """Three-moment equation: with M_B = P a (l^2 - a^2) / (2 l (l + r)) hogging under a load up,
    the joint turns by M_B r / 3 EI in the unloaded span."""
    deck = rb.Beam("two spans", (20.0, 30.0), M, EI, EIZ).deck(6)
    left, right, a = 20.0, 30.0, np.array([5.0, 12.0])
    moment = a * (left**2 - a**2) / left / 2 / (left + right)
    known = moment * right / 3 / EI
    found = deck.influence("rotation_y", at=20.0, places=a)
    # Lifted in the left span, the deck falls behind the bearing: w' < 0, rotation_y > 0.
    assert found == pytest.approx(known, rel=1e-9)
    # Far end: half of it, the other way.
    assert deck.influence("rotation_y", at=50.0, places=a) == pytest.approx(-known / 2, rel=1e-9)


def test_an_overhang_behind_a_bearing_turns_on_like_a_cantilever():
    """A force at the tip of an overhang c behind a span l: the bearing turns by P c l / 3 EI, the
    tip by P c^2 / 2 EI more."""
    span, c = 20.0, 6.0
    bearings = (
        rb.Bearing(0.0, "x y z roll"),
        rb.Bearing(span, "y z roll"),
    )
    beam = rb.Beam("overhang", (span + c,), M, EI, EIZ, bearings=bearings)
    deck, tip = beam.deck(6), np.array([span + c])
    at_bearing = deck.influence("rotation_y", at=span, places=tip)
    assert at_bearing == pytest.approx([-c * span / 3 / EI], rel=1e-9)
    at_tip = deck.influence("rotation_y", at=span + c, places=tip)
    assert at_tip == pytest.approx([-c * span / 3 / EI - c**2 / 2 / EI], rel=1e-9)


@pytest.mark.parametrize("quantity", TURNING)
def test_maxwell_s_law_of_a_force_and_a_couple(quantity):
    """The line of a rotation is the shape under a unit couple: that of the two forces beside it."""
    deck, step = rb.Beam("plain", (20.0, 30.0), M, EI, EIZ).deck(6), 1e-3
    way, sign = ("displacement_z", -1.0) if quantity == "rotation_y" else ("displacement_y", 1.0)
    pair = np.array([12.0 - step / 2, 12.0 + step / 2])
    for x in (3.0, 12.5, 41.0):
        w = deck.influence(way, at=x, places=pair)
        line = deck.influence(quantity, at=12.0, places=np.array([x]))
        assert line == pytest.approx(sign * np.diff(w) / step, rel=1e-6)


@pytest.mark.parametrize("beam", [PLAIN, SHEAR, TWO_SPANS], ids=lambda beam: beam.name)
def test_modal_rotations_add_up_to_the_influence_line(beam):
    """sum_m S_m phi_m(x) / omega_m^2 tends to it, the faster since a rotation is smooth."""
    x, at = np.array([1.0, 8.0, 17.0]), 6.3
    errors = []
    for count in (10, 20, 40):
        deck = beam.deck(count)
        line = deck.recovery.section("rotation_y", at)
        known = line.influence(x)[:, 0, 1]
        shapes = deck.shapes(x)[:, :, 1]
        found = shapes @ (line.modal / (2 * np.pi * deck.frequencies_hz) ** 2)
        errors.append(np.abs(found - known).max() / np.abs(known).max())
    assert errors[0] > errors[1] > errors[2] and errors[2] < 2e-2


def test_a_modal_rotation_is_that_of_the_sine():
    deck = PLAIN.deck(1)
    size = np.sqrt(2 / M / L)
    own = [deck.recovery.section("rotation_y", x).modal[0] for x in (0.0, 5.0, 20.0)]
    known = -size * np.pi / L * np.cos(np.pi * np.array([0.0, 5.0, 20.0]) / L)
    assert np.abs(own) == pytest.approx(np.abs(known), rel=1e-6)
    assert np.sign(own) == pytest.approx(np.sign(own[0]) * np.sign(known) * np.sign(known[0]))


@pytest.mark.parametrize("rotary", [None, 3e4])
def test_a_modal_rotation_of_a_thick_beam_is_psi(rotary):
    """w = W sin q x and psi = P cos q x in ``kGA (w'' - psi') = -m omega^2 w``."""
    stiffness = 6e9
    beam = rb.Beam(
        "thick",
        (L,),
        M,
        EI,
        shear_stiffness_vertical=stiffness,
        rotary_inertia_vertical=rotary,
        elements=80,
    )
    deck = beam.deck(3)
    line = deck.recovery.section("rotation_y", 0.0)
    for m, antinode in enumerate((L / 2, L / 4, L / 2)):
        q = (m + 1) * np.pi / L
        omega2 = (2 * np.pi * deck.frequencies_hz[m]) ** 2
        share = 1.0 - M * omega2 / (stiffness * q**2)
        assert share < 0.97  # the shear is felt
        size = deck.shapes(np.array([antinode]))[0, m, 1]
        size *= -1.0 if m == 2 else 1.0  # the middle of the third wave is a trough
        assert line.modal[m] == pytest.approx(-share * q * size, rel=1e-3)


def test_a_deck_of_modes_alone_has_the_slopes_of_its_axis():
    deck = PLAIN.deck(24)
    modes = replace(deck, recovery=None).recovery
    x = np.array([2.0, 11.0])
    for quantity, component, sign in (("rotation_y", 1, -1.0), ("rotation_z", 0, 1.0)):
        line = modes.section(quantity, 7.0)
        slope = sign * deck.shapes(np.array([7.0]), 1)[0, :, component]
        assert line.modal == pytest.approx(slope, rel=1e-12, abs=1e-15)
        known = deck.shapes(x)[:, :, component] @ (slope / (2 * np.pi * deck.frequencies_hz) ** 2)
        assert line.influence(x)[:, 0, component] == pytest.approx(known, rel=1e-9)
        exact = deck.influence(quantity, at=7.0, places=x)
        assert line.influence(x)[:, 0, component] == pytest.approx(exact, rel=0.05)
