r"""Matrices of straight beam elements, one field at a time: axial, lateral, vertical, torsion.

Axial displacement u and twist theta are quadratic, with a node in the middle; lateral v and
vertical w are cubic. With the shape functions as powers of the local coordinate, ``N = T^T (1, s,
s^2, s^3)``, every matrix is one integral,

    K = T^T [ int D_k D_k^T ds ] T * stiffness / h^(2k-1),      M = T^T [ int P P^T ds ] T * mass h,

with k = 1 (axial: EA, twist: G J) or k = 2 (bending: E I). A bending element's freedoms are
displacement and rotation psi of the section at both ends. Without shear flexibility psi = w'. With
it the exact static shape is still a cubic, and

    psi = w' + (E I / kGA) w''',      shear strain = w' - psi,

so that only T changes, with Phi = 12 E I / (kGA h^2), and the shear strain adds Phi / 12 times the
integral of D_3 to that of D_2: elements are exact in statics and do not lock (Przemieniecki, Theory
of Matrix Structural Analysis, 1968, section 5.6). Rotary inertia is ``int m r^2 psi^2``.
"""

from __future__ import annotations

import numpy as np

__all__ = [
    "BENDING", "FIELDS", "POWERS", "SHAPE_FIELDS", "coupling", "matrices", "rotation_powers",
    "shape_matrices",
]  # fmt: skip

FIELDS = ("axial", "lateral", "vertical", "torsion")
SHAPE_FIELDS = ("lateral", "vertical", "torsion")
"""Fields that a deck's shapes consist of, in the order of `COMPONENTS`."""
BENDING = ("lateral", "vertical")
_QUADRATIC = np.array([[1, 0, 0], [-3, 4, -1], [2, -4, 2], [0, 0, 0]], dtype=float)

POWERS = np.array([[1.0 / (i + j + 1) for j in range(4)] for i in range(4)])
"""Integrals over 0..1 of products of 1, s, s^2, s^3."""


def _derivative_integral(order: int) -> np.ndarray:
    """Integrals over 0..1 of products of order-th derivatives of 1, s, s^2, s^3."""
    factor = [np.prod(range(p - order + 1, p + 1)) if p >= order else 0.0 for p in range(4)]
    result = np.zeros((4, 4))
    for i in range(order, 4):
        for j in range(order, 4):
            result[i, j] = factor[i] * factor[j] / (i + j - 2 * order + 1)
    return result


_D1, _D2, _D3 = (_derivative_integral(order) for order in (1, 2, 3))


def shape_matrices(name: str, h: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Return T of every element: powers of the local coordinate from the element's freedoms.

    Parameters
    ----------
    name : one of `FIELDS`
    h, phi : ndarray, shape (e,)
        Length, m; Phi, 0 without shear flexibility.

    Returns
    -------
    ndarray, shape (e, 4, 3) with freedoms first, middle, last; or (e, 4, 4) with w, psi of the
    first and of the last node
    """
    if name not in BENDING:
        return np.broadcast_to(_QUADRATIC, (len(h), 4, 3))
    # From h psi(0) = a_1 + Phi/2 a_3, h psi(1) = a_1 + 2 a_2 + (3 + Phi/2) a_3 and w at both ends.
    rows = np.zeros((4, 4, len(h)))
    rows[0, 0] = 1.0
    rows[3] = np.array([2.0, 1.0, -2.0, 1.0])[:, None] / (1.0 + phi)
    rows[2] = np.array([0.0, -0.5, 0.0, 0.5])[:, None] - 1.5 * rows[3]
    rows[1] = np.array([0.0, 1.0, 0.0, 0.0])[:, None] - phi / 2 * rows[3]
    rows[:, 1::2] *= h
    return np.moveaxis(rows, 2, 0)


def rotation_powers(h: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Return powers of psi from powers of w, shape (e, 4, 4)."""
    turn = np.zeros((len(h), 4, 4))
    turn[:, 0, 1], turn[:, 1, 2], turn[:, 2, 3], turn[:, 0, 3] = 1.0, 2.0, 3.0, phi / 2
    return turn / h[:, None, None]


def matrices(
    name: str, h: np.ndarray, phi: np.ndarray, stiffness: float, mass: float, rotary: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and mass of one field of every element.

    Parameters
    ----------
    name, h, phi
        See `shape_matrices`.
    stiffness : float
        EA (N), or G J or E I (N m2).
    mass : float
        kg/m, or kg m for torsion.
    rotary : float
        m r^2 of the section about its bending axis, kg m; 0 to leave it out.

    Returns
    -------
    tuple of ndarray, each shape (e, n, n)
    """
    t = shape_matrices(name, h, phi)
    transposed = np.swapaxes(t, 1, 2)
    size = h[:, None, None]
    if name not in BENDING:
        return stiffness / size * (transposed @ _D1 @ t), mass * size * (transposed @ POWERS @ t)
    k = stiffness / size**3 * (transposed @ (_D2 + phi[:, None, None] / 12 * _D3) @ t)
    m = mass * size * (transposed @ POWERS @ t)
    if rotary:
        turned = rotation_powers(h, phi) @ t
        m = m + rotary * size * (np.swapaxes(turned, 1, 2) @ POWERS @ turned)
    return k, m


def coupling(h: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Integrate the product of two fields' shapes along every element, shape (e, n1, n2)."""
    return h[:, None, None] * (np.swapaxes(first, 1, 2) @ POWERS @ second)
