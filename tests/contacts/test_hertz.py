"""Hertz's contact against its closed forms, against elliptic integrals by quadrature, and against
the equations of an elastic half-space solved without any of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipk

import railbridge as rb
from railbridge.contacts.hertz import HertzContact

WHEEL = HertzContact()


def test_equal_radii_are_a_sphere_on_a_plane():
    """Crossed cylinders of one radius touch in a circle: P = 4/3 E* sqrt(R) d^1.5 (Johnson 4.2)."""
    contact = HertzContact(0.46, 0.46, 210e9, 0.3)
    e_star = 210e9 / (2 * (1 - 0.09))
    assert contact.axis_ratio == 1.0
    assert contact.constant == pytest.approx(4 / 3 * e_star * np.sqrt(0.46), rel=1e-14)
    a = (3 * 80e3 * 0.46 / (4 * e_star)) ** (1 / 3)  # half width of the patch
    assert contact.approach(80e3) == pytest.approx(a**2 / 0.46, rel=1e-13)
    assert contact.stiffness(80e3) == pytest.approx(2 * e_star * a, rel=1e-13)


def test_nearly_equal_radii_are_nearly_that():
    """The constant has no jump and no lost digits where the ellipse becomes a circle."""
    circle = HertzContact(0.46, 0.46).constant
    for part in (1e-3, 1e-6, 1e-9, 1e-12):
        near = HertzContact(0.46 * (1 + part), 0.46 / (1 + part)).constant
        assert abs(near / circle - 1) < part**2 + 2e-15, part


@pytest.mark.parametrize("radii", [(0.46, 0.3), (0.46, 0.08), (0.42, 0.5), (5.0, 0.05)])
def test_the_ellipse_meets_johnson_s_equation(radii):
    contact = HertzContact(*radii)
    k = contact.axis_ratio
    e2 = 1 - k**2
    found = (ellipe(e2) / k**2 - ellipk(e2)) / (ellipk(e2) - ellipe(e2))
    assert found == pytest.approx(max(radii) / min(radii), rel=1e-9)
    assert contact.constant == pytest.approx(HertzContact(*radii[::-1]).constant, rel=1e-14)


def half_space(r1, r2, modulus, poisson):
    """C from the pressure p0 sqrt(1 - x2/a2 - y2/b2) on two half-spaces, its potential by
    quadrature: u(x, y) = (p0 a b / 2 E*) int [1 - x2/(a2+w) - y2/(b2+w)] dw / sqrt(...), the
    coefficients of 1, x2 and y2 being d, A and B (Johnson 3.36 to 3.38 before the substitution)."""
    e_star = modulus / (2 * (1 - poisson**2))
    wanted = r1 / r2

    def integral(a, b, power_a, power_b):
        def inside(t):  # w = t / (1 - t)
            w = t / (1 - t)
            root = np.sqrt((a * a + w) * (b * b + w) * w)
            return 1 / (root * (a * a + w) ** power_a * (b * b + w) ** power_b * (1 - t) ** 2)

        # The root of w at 0 is integrated with t = s^2.
        return quad(lambda s: inside(s * s) * 2 * s, 0, 1, epsabs=0, epsrel=1e-11, limit=400)[0]

    low, high = 1e-3, 1.0  # b/a by bisection: B / A must be R1 / R2
    for _ in range(60):
        b = np.sqrt(low * high)
        if integral(1.0, b, 0, 1) / integral(1.0, b, 1, 0) > wanted:
            low = b
        else:
            high = b
    # With a = 1 m: A = p0 b I_a / (2 E*) = 1 / (2 R1), P = 2/3 pi a b p0, d = p0 b I / (2 E*).
    p0 = e_star / (r1 * b * integral(1.0, b, 1, 0))
    force = 2 / 3 * np.pi * b * p0
    approach = p0 * b * integral(1.0, b, 0, 0) / (2 * e_star)
    return force / approach**1.5, b


@pytest.mark.parametrize("radii", [(0.46, 0.3), (0.46, 0.08)])
def test_against_the_potential_of_a_half_space_by_quadrature(radii):
    constant, ratio = half_space(*radii, 210e9, 0.3)
    contact = HertzContact(*radii)
    assert contact.axis_ratio == pytest.approx(ratio, rel=1e-7)
    assert contact.constant == pytest.approx(constant, rel=1e-7)


def test_the_stiffness_is_the_slope_of_the_law_and_of_the_usual_size():
    load, d = 80e3, WHEEL.approach(80e3)
    assert WHEEL.constant * d**1.5 == pytest.approx(load)
    step = 1e-4 * d
    slope = WHEEL.constant * ((d + step) ** 1.5 - (d - step) ** 1.5) / (2 * step)
    assert WHEEL.stiffness(load) == pytest.approx(slope, rel=1e-8)
    assert 1.2e9 < WHEEL.stiffness(load) < 1.5e9
    assert WHEEL.stiffness(2 * load) == pytest.approx(2 ** (1 / 3) * WHEEL.stiffness(load))
    assert replace(WHEEL, contact_modulus=105e9).constant == pytest.approx(WHEEL.constant / 2)


def test_the_lateral_share_of_mindlin():
    assert WHEEL.lateral_share == pytest.approx(0.8235, abs=5e-5)
    assert replace(WHEEL, contact_poisson=0.0).lateral_share == 1.0


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("wheel_radius", 0.0),
        ("wheel_radius", 460.0),
        ("rail_head_radius", -0.3),
        ("rail_head_radius", "round"),
        ("contact_modulus", 210.0),
        ("contact_poisson", 0.5),
    ],
)
def test_a_contact_names_the_field_that_cannot_be(field, value):
    with pytest.raises(rb.InputError) as error:
        HertzContact(**{field: value})
    assert error.value.field == field


def test_a_wheel_that_does_not_press_has_no_stiffness():
    assert WHEEL.approach(0.0) == 0.0
    for load in (0.0, -1.0, float("nan")):
        with pytest.raises(rb.InputError, match=r"^load = .* above 0 N"):
            WHEEL.stiffness(load)
