"""Curves through nodes: splines, Hermite's cubics, parabolas and cubics, as coefficients by piece.

Values and slopes at the nodes have the shape (m, n): m functions at n places. Coefficients have
the shape (pieces, 4, m), of powers of the place within a piece, 0 to 1; see `PiecewiseCubic`.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

__all__ = ["cubics", "hermite", "parabolas", "spline"]


def spline(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the cubic spline through values, one piece between every two nodes."""
    found = CubicSpline(x, values, axis=-1).c[::-1]
    return np.moveaxis(found * np.diff(x)[None, :, None] ** np.arange(4)[:, None, None], 1, 0)


def hermite(x: np.ndarray, values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return cubics with given values and slopes at the nodes, one between every two."""
    h = np.diff(x)
    a, b, da, db = values[:, :-1], values[:, 1:], h * slopes[:, :-1], h * slopes[:, 1:]
    return np.stack([a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db]).transpose(2, 0, 1)


def parabolas(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return parabolas through nodes 1-2-3, 3-4-5, ..., as one piece between every two nodes.

    Where one piece is left, its parabola goes through the last three nodes.
    """
    pieces = len(x) - 1
    result = np.zeros((pieces, 4, len(values)))
    for e in range(pieces):
        first = min(e - e % 2, pieces - 2)
        h, local = x[e + 1] - x[e], x[first : first + 3] - x[e]
        powers = np.vander(local / h, 3, increasing=True)
        result[e, :3] = np.linalg.solve(powers, values[:, first : first + 3].T)
    return result


def cubics(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return cubics through nodes 1-2-3-4, 4-5-6-7, ...: one piece for every four nodes."""
    result = np.zeros(((len(x) - 1) // 3, 4, len(values)))
    for e in range(len(result)):
        own = slice(3 * e, 3 * e + 4)
        local = (x[own] - x[3 * e]) / (x[3 * e + 3] - x[3 * e])
        result[e] = np.linalg.solve(np.vander(local, increasing=True), values[:, own].T)
    return result
