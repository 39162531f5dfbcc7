"""Lowest modes of sparse models, against all modes of the same model by LAPACK and against hand
formulas."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import block_diag, csc_array, diags_array

from railbridge.beams.eigen import count_below, factorised, lowest


def chain(n, spring=4e6, mass=250.0):
    """Equal masses between equal springs, both ends held: omega_i = 2 sqrt(k / m) sin(i pi / (2 (n
    + 1)))."""
    k = diags_array(
        [np.full(n - 1, -spring), np.full(n, 2 * spring), np.full(n - 1, -spring)],
        offsets=[-1, 0, 1],
    )
    return csc_array(k), csc_array(diags_array(np.full(n, mass)))


def test_a_chain_has_the_frequencies_of_the_formula():
    k, m = chain(900)
    squares, shapes = lowest(k, m, 12)
    exact = 2 * np.sqrt(4e6 / 250.0) * np.sin(np.arange(1, 13) * np.pi / (2 * 901))
    assert np.sqrt(squares) == pytest.approx(exact, rel=1e-9)
    assert shapes.T @ (m @ shapes) == pytest.approx(np.eye(12), abs=1e-9)
    assert np.array_equal(lowest(k, m, 12)[1], shapes), "the same each time"


def test_a_full_mass_matrix_counts_too():
    rng = np.random.default_rng(3)
    a, b = (rng.standard_normal((60, 60)) for _ in range(2))
    k, m = a @ a.T + 60 * np.eye(60), b @ b.T / 60 + np.eye(60)
    squares, shapes = lowest(csc_array(k), csc_array(m), 8)
    assert squares == pytest.approx(eigh(k, m, eigvals_only=True)[:8], rel=1e-10)
    assert k @ shapes == pytest.approx(m @ shapes * squares, abs=1e-8 * np.abs(k).max())
    assert factorised(csc_array(k)).solve(k @ shapes) == pytest.approx(shapes)


@pytest.mark.parametrize("copies", [1, 3])
def test_modes_below_a_frequency_are_counted(copies):
    """Equal chains beside each other: every frequency as often as there are chains, and the count
    knows."""
    one, mass = chain(200)
    k, m = (csc_array(block_diag([a] * copies)) for a in (one, mass))
    squares = 4 * 4e6 / 250.0 * np.sin(np.arange(1, 201) * np.pi / 402) ** 2
    for below in (0, 1, 7, 120):
        between = squares[0] / 2 if below == 0 else (squares[below - 1] + squares[below]) / 2
        assert count_below(k, m, between) == below * copies
