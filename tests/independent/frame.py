"""A frame program of its own: a straight deck of textbook two-node elements, lumped masses,
bearings as springs, dense matrices.

Freedoms at a node, all at the deck axis: u, v, w, theta_x, theta_y, theta_z. Nothing is eliminated:
what is rigid is a very stiff spring at the end of a rigid arm. Stiffness of the elements from
Przemieniecki (1968), table 5.1 and section 5.6.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import eigh

RIGID = 1e16
"""Stiffness of what is held, N/m and N m/rad."""


def arm(y, z):
    """Motion (three shifts, three turns) of a point at (y, z) of a section from the freedoms at the
    axis, shape (6, 6)."""
    rows = np.eye(6)
    rows[:3, 3:] = [[0.0, z, -y], [-z, 0.0, 0.0], [y, 0.0, 0.0]]
    return rows


def _bending(stiffness, shear, h, sign):
    phi = 0.0 if shear is None else 12 * stiffness / (shear * h**2)
    a, b = (4 + phi) * h**2, (2 - phi) * h**2
    s = sign * 6 * h
    k = np.array([[12, s, -12, s], [s, a, -s, b], [-12, -s, 12, -s], [s, b, -s, a]])
    return stiffness / (h**3 * (1 + phi)) * k


@dataclass
class Frame:
    """A deck of equal elements between given bearings: (x, y, z, {direction from 0 to 5:
    stiffness}), with masses at single places: (x, y, z, mass, roll inertia)."""

    length: float
    count: int
    axial: float
    lateral: float
    vertical: float
    torsion: float
    mass: float
    polar: float
    shear_lateral: float | None = None
    shear_vertical: float | None = None
    rotary_lateral: float = 0.0
    rotary_vertical: float = 0.0
    centroid: float = 0.0
    bearings: list = field(default_factory=list)
    masses: list = field(default_factory=list)

    def __post_init__(self):
        size, h = 6 * (self.count + 1), self.length / self.count
        self.h, self.stiffness, self.mass_matrix = h, np.zeros((size, size)), np.zeros((size, size))
        element = np.zeros((12, 12))
        element[np.ix_([0, 6], [0, 6])] += self.axial / h * np.array([[1, -1], [-1, 1]])
        element[np.ix_([3, 9], [3, 9])] += self.torsion / h * np.array([[1, -1], [-1, 1]])
        element[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])] += _bending(
            self.lateral, self.shear_lateral, h, 1
        )
        element[np.ix_([2, 4, 8, 10], [2, 4, 8, 10])] += _bending(
            self.vertical, self.shear_vertical, h, -1
        )
        # Axial force and bending are those of the centroid, shear and torsion those of the axis.
        along = np.eye(12)
        along[0, 4] = along[6, 10] = self.centroid
        element = along.T @ element @ along
        inertia = np.diag([self.mass] * 3 + [self.polar, self.rotary_vertical, self.rotary_lateral])
        lump = h / 2 * arm(0.0, self.centroid).T @ inertia @ arm(0.0, self.centroid)
        for e in range(self.count):
            here = slice(6 * e, 6 * e + 12)
            self.stiffness[here, here] += element
            for node in (e, e + 1):
                self.mass_matrix[6 * node : 6 * node + 6, 6 * node : 6 * node + 6] += lump
        for x, y, z, mass, roll in self.masses:
            inertia = np.diag([mass] * 3 + [roll, 0.0, 0.0])
            self.mass_matrix[self.at(x), self.at(x)] += arm(y, z).T @ inertia @ arm(y, z)
        keys = [(i, d) for i, (_, _, _, springs) in enumerate(self.bearings) for d in springs]
        self.rows, self.springs, self.keys = np.zeros((len(keys), size)), np.zeros(len(keys)), keys
        for row, (i, direction) in enumerate(keys):
            x, y, z, springs = self.bearings[i]
            self.rows[row, self.at(x)] = arm(y, z)[direction]
            self.springs[row] = springs[direction]

    def at(self, x):
        """Freedoms of the node at x."""
        node = round(x / self.h)
        assert abs(node * self.h - x) < 1e-9
        return slice(6 * node, 6 * node + 6)

    def frequencies(self, count):
        """Lowest natural frequencies, Hz."""
        # Turning without inertia makes the mass singular, so the inverse squares are sought.
        largest = [len(self.stiffness) - count, len(self.stiffness) - 1]
        stiffness = self.stiffness + self.rows.T @ (
            np.minimum(self.springs, 1e14)[:, None] * self.rows
        )
        inverse = eigh(self.mass_matrix, stiffness, eigvals_only=True, subset_by_index=largest)
        return np.sort(1 / np.sqrt(inverse)) / (2 * np.pi)

    def under(self, x, load):
        """Displacements of all freedoms under six forces and moments at the axis at x, and what
        every bearing exerts on the deck.

        The bearings' forces are unknowns beside the displacements: stiff springs cost no digits.
        """
        size, scale = len(self.stiffness), 1e10
        force = np.zeros(size + len(self.keys))
        force[self.at(x)] = load
        whole = np.block(
            [
                [self.stiffness, -scale * self.rows.T],
                [scale * self.rows, scale**2 * np.diag(1 / self.springs)],
            ]
        )
        found = np.linalg.solve(whole, force)
        return found[:size], dict(zip(self.keys, scale * found[size:], strict=True))
