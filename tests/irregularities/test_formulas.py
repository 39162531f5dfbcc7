"""Formulas of spectra, their integrals and the units of their constants."""

import numpy as np
import pytest
from scipy.integrate import quad

from railbridge.irregularities.formulas import FORMULAS, factors, power_integral

GERMAN = {"A": 2e-7, "W_c": 0.8, "W_r": 0.02, "W_s": 0.4, "b": 0.75, "k": 0.25}
CASES = {
    "german": GERMAN,
    "fra_aar": GERMAN,
    "fryba": {"A": 1e-8, "n_1": 0.02, "n_2": 0.13},
    "sncf": {"A": 3e-4, "quality": 0.5, "n_0": 0.05},
    "power_pieces": {
        "breaks": np.array([0.05, 0.3]),
        "A": np.array([1e-6, 2e-6, 3e-6]),
        "n": np.array([1.0, 2.5, -0.5]),
    },
}


@pytest.mark.parametrize("component", ["vertical", "gauge", "cross_level"])
@pytest.mark.parametrize("kind", CASES)
def test_integrals_agree_with_adaptive_quadrature(kind, component):
    formula, constants = FORMULAS[kind][component], CASES[kind]
    for low, high in ((0.04, 2.0), (0.06, 0.07), (0.05, 0.3), (1e-3, 60.0)):
        edges = [low, *(b for b in (0.05, 0.3) if low < b < high), high]
        pieces = [
            quad(lambda x: float(formula.value(np.array(x), constants)), a, b, epsrel=1e-11)[0]
            if b / a < 100
            else quad(
                lambda t: np.exp(t) * float(formula.value(np.exp(t), constants)),
                np.log(a),
                np.log(b),
                epsrel=1e-11,
            )[0]
            for a, b in zip(edges[:-1], edges[1:], strict=True)
        ]
        assert formula.integral(low, high, constants) == pytest.approx(sum(pieces), rel=1e-8)


def test_powers_are_integrated_in_closed_form():
    x0, x1 = np.array([1.0, 2.0, 1.0]), np.array([2.0, 8.0, np.e])
    s0, s1 = np.array([1.0, 4.0, 3.0]), np.array([4.0, 64.0, 3.0 / np.e])
    # x^2, x^2 and 3 / x, whose integral is a logarithm
    assert power_integral(x0, x1, s0, s1) == pytest.approx([7 / 3, 504 / 3, 3.0], rel=1e-12)


@pytest.mark.parametrize("shift", [1e-4, 1e-7, 1e-9, 1e-12, -1e-9])
def test_powers_near_one_over_x_lose_no_digits(shift):
    s1 = 2.0 ** (shift - 1)
    exact = np.log(2.0) * (1 + shift * np.log(2.0) / 2 + (shift * np.log(2.0)) ** 2 / 6)
    assert power_integral(1.0, 2.0, 1.0, s1) == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize(
    ("dimension", "variable", "quantity", "unit", "si"),
    [
        ("roughness", "rad/m", "height", "cm2 rad/m", 1e-4),
        ("roughness", "1/m", "height", "m", 1.0),
        ("roughness", "1/m", "height", "cm2/m", 1e-4),
        ("roughness", "1/m", "height", "mm2/m", 1e-6),
        ("density", "1/m", "height", "mm2/(1/m)", 1e-6),
        ("density", "rad/m", "angle", "mrad2/(rad/m)", 1e-6),
        ("wave number", "1/m", "height", "1/m", 1.0),
        ("length", "1/m", "angle", "m", 1.0),
        ("number", "rad/m", "height", "", 1.0),
    ],
)
def test_units_of_constants(dimension, variable, quantity, unit, si):
    assert factors(dimension, variable, quantity)[unit] == pytest.approx(si, rel=1e-15)


def test_a_wave_number_of_another_variable_is_no_unit_of_a_constant():
    assert set(factors("wave number", "rad/m", "height")) == {"rad/m"}
    assert "mm2/(1/m)" not in factors("density", "rad/m", "height")
    assert "m2/(rad/m)" not in factors("density", "rad/m", "angle")
