"""Densities per rad/m, by formula and by table."""

import numpy as np
import pytest
from scipy.integrate import quad

from railbridge.irregularities.densities import FormulaDensity, TableDensity
from railbridge.irregularities.formulas import FORMULAS

FRYBA = {"A": 1e-8, "n_1": 0.02, "n_2": 0.13}


@pytest.mark.parametrize("sides", [1, 2])
@pytest.mark.parametrize("variable", ["rad/m", "1/m"])
def test_a_formula_keeps_its_variance_in_another_variable(variable, sides):
    density = FormulaDensity(FORMULAS["fryba"]["vertical"], FRYBA, variable, sides)
    to = 2 * np.pi if variable == "1/m" else 1.0
    w = 0.7
    by_hand = 1e-8 * 0.13**2 * ((w / to) ** 2 + 4e-4) / ((w / to) ** 4 * ((w / to) ** 2 + 0.0169))
    assert float(density.value(w)) == pytest.approx(sides * by_hand / to, rel=1e-12)
    by_quadrature = quad(lambda x: float(density.value(x)), 0.2, 2.1, epsrel=1e-11)[0]
    assert density.integral(0.2, 2.1) == pytest.approx(by_quadrature, rel=1e-9)


def test_a_table_by_hand():
    density = TableDensity(np.array([1.0, 2.0, 8.0]), np.array([4.0, 16.0, 4.0]))  # x^2, then 1/x
    assert density.value(np.array([0.5, 1.0, 1.5, 2.0, 4.0, 8.0, 16.0])) == pytest.approx(
        [1.0, 4.0, 9.0, 16.0, 8.0, 4.0, 2.0], rel=1e-12
    )
    exact = 4 / 3 * (2**3 - 1.2**3) + 32 * np.log(5.0 / 2.0)
    assert density.integral(1.2, 5.0) == pytest.approx(exact, rel=1e-12)
    assert density.integral(2.0, 8.0) == pytest.approx(32 * np.log(4.0), rel=1e-12)
