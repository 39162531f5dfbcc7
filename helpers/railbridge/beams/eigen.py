"""Lowest modes of large sparse models.

K phi = omega^2 M phi with symmetric positive definite matrices.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

__all__ = ["count_below", "factorised", "lowest"]


def factorised(k: csc_array) -> SuperLU:
    """Factorise a symmetric matrix with its diagonal as pivots, which keeps it sparse."""
    return splu(
        csc_array(k),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def lowest(k: csc_array, m: csc_array, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest modes, by shift-invert Lanczos iteration about zero.

    Parameters
    ----------
    k, m : csc_array, shape (n, n)
        Stiffness and mass.
    count : int
        Less than n.

    Returns
    -------
    ndarray, shape (count,), and ndarray, shape (n, count)
        omega^2, ascending, and mass-normalised shapes.

    Notes
    -----
    Of equal frequencies the iteration may miss one; `count_below` tells.
    """
    inverse = LinearOperator(k.shape, factorised(k).solve, dtype=float)
    # A fixed start makes the last digits repeatable.
    start = np.random.default_rng(1).standard_normal(k.shape[0])
    squares, vectors = eigsh(k, count, m, sigma=0.0, OPinv=inverse, v0=start)
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def count_below(k: csc_array, m: csc_array, square: float) -> int | None:
    """Return how many modes lie below omega^2 = `square`.

    By Sylvester's law of inertia: as many as K - omega^2 M has negative pivots. None where the
    factorisation had to leave the diagonal, so that the signs of its pivots say nothing.
    """
    try:
        factor = factorised(k - square * m)
    except RuntimeError:  # singular: `square` is a mode
        return None
    if not np.array_equal(factor.perm_r, factor.perm_c):
        return None
    return int(np.sum(factor.U.diagonal() < 0.0))
