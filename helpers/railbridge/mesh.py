r"""Finite elements of a straight beam: matrices, named modes, static influence lines.

An element carries four fields: axial u and twist theta (quadratic, with a node in the middle), lateral v and vertical w
(cubic, Euler-Bernoulli). With the shape functions as powers of the local coordinate, ``N = T^T (1, s, s^2, s^3)``, every
matrix is one integral,

    K = T^T [ int D_k D_k^T ds ] T * stiffness / h^(2k-1),      M = T^T [ int P P^T ds ] T * mass h,

with k = 1 (axial: EA, twist: G J) or k = 2 (bending: E I). Freedoms at a node: u, v, w, theta_x, v' = theta_z and
w' = -theta_y.

Static influence lines follow from Mueller-Breslau: the influence line of a section force is the deflected shape under a
unit jump of the conjugate displacement, and that of a reaction the shape under a unit support displacement; that of a
displacement is the shape under a unit load there. All are exact at any load position and for any section: inside an
element the jump's own function g (a step, a kink, or the cube of a point load) is added to the elements' shape and its
interpolation taken off, so no section needs a mesh of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import comb
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from . import inputs
from .deck import COMPONENTS, REACTION_QUANTITIES, SECTION_QUANTITIES, Line, PiecewiseCubic
from .inputs import G

if TYPE_CHECKING:
    from .beam import Beam

__all__ = ["FIELDS", "BeamModes", "BeamRecovery", "Mesh"]

FIELDS = ("axial", "lateral", "vertical", "torsion")
_NODE = {"x": 0, "y": 1, "z": 2, "roll": 3, "yaw": 4, "pitch": 5}  # place among a node's freedoms
_HERMITE = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [-3, -2, 3, -1], [2, 1, -2, 1]], dtype=float)
_QUADRATIC = np.array([[1, 0, 0], [-3, 4, -1], [2, -4, 2], [0, 0, 0]], dtype=float)
_POWERS = np.array([[1.0 / (i + j + 1) for j in range(4)] for i in range(4)])


def _derivative_integral(order: int) -> np.ndarray:
    """Integrals over 0..1 of products of order-th derivatives of 1, s, s^2, s^3."""
    factor = [np.prod(range(p - order + 1, p + 1)) if p >= order else 0.0 for p in range(4)]
    result = np.zeros((4, 4))
    for i in range(order, 4):
        for j in range(order, 4):
            result[i, j] = factor[i] * factor[j] / (i + j - 2 * order + 1)
    return result


@dataclass(frozen=True, eq=False)
class BeamModes:
    """Natural modes of a beam, all fields, ascending.

    Attributes
    ----------
    frequencies_hz : ndarray, shape (m,)
    names : tuple of str
        ``vertical bending 1``, ``lateral bending 1``, ``torsion 1``, ``axial 1`` ...
    vectors : ndarray, shape (freedoms, m)
        Mass-normalised.
    """

    frequencies_hz: np.ndarray
    names: tuple[str, ...]
    vectors: np.ndarray = field(repr=False)


class Mesh:
    """Assembled matrices over given nodes. Freedoms: six a node, then twist and axial mid-nodes of each element."""

    def __init__(self, beam: Beam, nodes: np.ndarray) -> None:
        self.beam, self.nodes = beam, nodes
        self.h = np.diff(nodes)
        count = len(self.h)
        self.size = 6 * len(nodes) + 2 * count
        first, second = 6 * np.arange(count), 6 * np.arange(1, count + 1)
        middle = 6 * len(nodes) + np.arange(count)
        self.freedoms = {
            "axial": np.stack([first, middle, second], axis=1),
            "torsion": np.stack([first + 3, middle + count, second + 3], axis=1),
            "lateral": np.stack([first + 1, first + 4, second + 1, second + 4], axis=1),
            "vertical": np.stack([first + 2, first + 5, second + 2, second + 5], axis=1),
        }
        present = np.concatenate([self.freedoms[f].ravel() for f in beam.fields])
        fixed = [6 * self.node(b.x) + _NODE[f] for b in beam.bearings for f in b.fixed]
        self.free = np.setdiff1d(present, fixed)

    def node(self, x: float) -> int:
        """Return the node at x."""
        return int(np.argmin(np.abs(self.nodes - x)))

    def shape_matrix(self, name: str, element: int) -> np.ndarray:
        """Return T: powers of the local coordinate from the element's freedoms, shape (4, 3 or 4)."""
        if name in ("axial", "torsion"):
            return _QUADRATIC
        return _HERMITE * np.array([1.0, self.h[element], 1.0, self.h[element]])

    def element(self, name: str, e: int) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and mass of one field of one element."""
        b = self.beam
        stiffness, mass, order = {
            "axial": (b.axial_stiffness, b.mass, 1),
            "torsion": (b.torsional_stiffness, b.polar_inertia, 1),
            "lateral": (b.bending_stiffness_lateral, b.mass, 2),
            "vertical": (b.bending_stiffness_vertical, b.mass, 2),
        }[name]
        t, h = self.shape_matrix(name, e), self.h[e]
        return (
            stiffness / h ** (2 * order - 1) * t.T @ _derivative_integral(order) @ t,
            mass * h * t.T @ _POWERS @ t,
        )

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """K and M over all freedoms, bearings not yet applied, shape (size, size)."""
        total = np.zeros((2, self.size, self.size))
        for name in self.beam.fields:
            for e, dofs in enumerate(self.freedoms[name]):
                total[:, dofs[:, None], dofs] += self.element(name, e)
        return total[0], total[1]

    @cached_property
    def _factor(self):
        return cho_factor(self.matrices[0][np.ix_(self.free, self.free)])

    def solve(self, load: np.ndarray) -> np.ndarray:
        """Return the static displacement of all freedoms under a nodal load; the bearings hold."""
        result = np.zeros(self.size)
        result[self.free] = cho_solve(self._factor, load[self.free])
        return result

    def modes(self) -> BeamModes:
        """Solve each uncoupled group of freedoms on its own: a straight beam falls into four."""
        k, m = (a[np.ix_(self.free, self.free)] for a in self.matrices)
        count, group = connected_components(csr_array((k != 0) | (m != 0)), directed=False)
        squares, vectors = [], []
        for g in range(count):
            here = np.flatnonzero(group == g)
            values, shapes = eigh(k[np.ix_(here, here)], m[np.ix_(here, here)])
            full = np.zeros((self.size, len(values)))
            full[self.free[here]] = shapes
            squares.append(values)
            vectors.append(full)
        squares, vectors = np.concatenate(squares), np.hstack(vectors)
        order = np.argsort(squares, kind="stable")
        vectors = vectors[:, order]
        return BeamModes(np.sqrt(squares[order]) / (2 * np.pi), self._names(vectors), self._signed(vectors))

    def _names(self, vectors: np.ndarray) -> tuple[str, ...]:
        """Name modes by the field with the largest strain energy, numbered within it."""
        energy = []
        for name in FIELDS:
            dofs = np.unique(self.freedoms[name])
            part = vectors[dofs]
            energy.append(np.einsum("im,ij,jm->m", part, self.matrices[0][np.ix_(dofs, dofs)], part))
        labels = {"axial": "axial", "lateral": "lateral bending", "vertical": "vertical bending", "torsion": "torsion"}
        names, seen = [], dict.fromkeys(FIELDS, 0)
        for winner in np.argmax(energy, axis=0):
            name = FIELDS[winner]
            seen[name] += 1
            names.append(f"{labels[name]} {seen[name]}")
        return tuple(names)

    def _signed(self, vectors: np.ndarray) -> np.ndarray:
        """Fix the sign, which an eigensolver leaves open: the first sizeable entry is positive."""
        large = np.abs(vectors) > 0.3 * np.abs(vectors).max(axis=0)
        first = vectors[np.argmax(large, axis=0), np.arange(vectors.shape[1])]
        return vectors * np.sign(first)

    def interpolate(self, vectors: np.ndarray) -> PiecewiseCubic:
        """Return lateral, vertical and twist shapes of nodal vectors, shape (size, n) or (size,)."""
        vectors = vectors.reshape(self.size, -1)
        result = np.zeros((len(self.h), 4, vectors.shape[1], 3))
        for c, name in enumerate(("lateral", "vertical", "torsion")):
            if name not in self.beam.fields:
                continue
            for e, dofs in enumerate(self.freedoms[name]):
                result[e, :, :, c] = self.shape_matrix(name, e) @ vectors[dofs]
        return PiecewiseCubic(self.nodes, result)


class BeamRecovery:
    """Influence lines and modal values of a beam's outputs; see `Recovery`."""

    _CONJUGATE = {
        # quantity: field, derivative that jumps, sign
        "moment_vertical": ("vertical", 1, -1.0),
        "moment_lateral": ("lateral", 1, 1.0),
        "torsion": ("torsion", 0, 1.0),
        "shear_vertical": ("vertical", 0, 1.0),
        "shear_lateral": ("lateral", 0, 1.0),
    }
    _FIELD_OF = {
        "displacement_y": "lateral", "displacement_z": "vertical", "rotation_x": "torsion",
        "force_y": "lateral", "force_z": "vertical", "moment_x": "torsion",
    }  # fmt: skip
    _FREEDOM_OF = {"force_y": ("y", 1), "force_z": ("z", 2), "moment_x": ("roll", 3)}

    def __init__(self, beam: Beam, kept: Sequence[int]) -> None:
        self.beam = beam
        self.kept = list(kept)
        self._lines: dict[tuple[str, float], Line | None] = {}

    def section(self, quantity: str, x: float) -> Line | None:
        """Return the line of a displacement or section force at x (m); at an inner bearing the face just before it."""
        inputs.choice("quantity", quantity, SECTION_QUANTITIES)
        x = inputs.number("x", x, least=0.0, most=self.beam.length, unit="m", remedy="x runs along the deck")
        return self._cached(quantity, x, self._section)

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return the line of a reaction on the deck at the bearing line `support` (m)."""
        inputs.choice("quantity", quantity, REACTION_QUANTITIES)
        return self._cached(quantity, support, self._reaction)

    def _cached(self, quantity: str, x: float, make) -> Line | None:
        key = quantity, float(x)
        if key not in self._lines:
            self._lines[key] = make(quantity, x)
        return self._lines[key]

    def _section(self, quantity: str, x: float) -> Line | None:
        name = self._FIELD_OF.get(quantity) or self._CONJUGATE[quantity][0]
        if name not in self.beam.fields:
            return None
        component = ("lateral", "vertical", "torsion").index(name)
        mesh, bends = self.beam.mesh, name != "torsion"
        e = max(int(np.searchsorted(mesh.nodes, x - 1e-9 * self.beam.length)) - 1, 0)
        h = mesh.h[e]
        cut = float(np.clip((x - mesh.nodes[e]) / h, 0.0, 1.0))
        after = 1.0 - cut
        # Values at the element's end of g, a power of (s - cut) behind the cut: value and, in bending, slope by x.
        if quantity in self._CONJUGATE:
            _, order, sign = self._CONJUGATE[quantity]
            power, factor = order, sign * h**order
        else:
            stiffness = self.beam.bending_stiffness_lateral if name == "lateral" else self.beam.bending_stiffness_vertical
            power, factor = (3, h**3 / (6 * stiffness)) if bends else (1, -h / self.beam.torsional_stiffness)
        end = factor * after**power
        slope = factor * power * after ** max(power - 1, 0) / h
        nodal = np.array([0.0, 0.0, end, slope] if bends else [0.0, end / 2, end])
        load, dofs = np.zeros(mesh.size), mesh.freedoms[name][e]
        if quantity in self._CONJUGATE:
            load[dofs] = mesh.element(name, e)[0] @ nodal
        else:
            load[dofs] = cut ** np.arange(4) @ mesh.shape_matrix(name, e) if bends else [1.0 - cut, 0.0, cut]
        shape = mesh.interpolate(mesh.solve(load))
        shape.coefficients[e, :, 0, component] -= mesh.shape_matrix(name, e) @ nodal
        return self._line(_cut(shape, e, cut, component, power, factor))

    def _reaction(self, quantity: str, support: float) -> Line | None:
        mesh = self.beam.mesh
        freedom, place = self._FREEDOM_OF[quantity]
        held = any(abs(b.x - support) < 1e-9 * self.beam.length and freedom in b.fixed for b in self.beam.bearings)
        if not held or self._FIELD_OF[quantity] not in self.beam.fields:
            return None
        dof = 6 * mesh.node(support) + place
        moved = mesh.solve(mesh.matrices[0][dof])
        moved[dof] -= 1.0
        return self._line(mesh.interpolate(moved))

    def _line(self, influence: PiecewiseCubic) -> Line:
        """Attach the modal values: the static effect of each mode's own inertia load, S_m = omega^2 int line m phi dx."""
        points, weights = np.polynomial.legendre.leggauss(5)
        h = np.diff(influence.edges)
        x = (influence.edges[:-1, None] + h[:, None] * (points + 1) / 2).ravel()
        dx = (h[:, None] * weights / 2).ravel()
        line = influence(x)[:, 0]
        beam = self.beam
        mass = np.array([beam.mass, beam.mass, beam.polar_inertia or 0.0])
        everything = beam.modes
        shapes = beam.mesh.interpolate(everything.vectors[:, self.kept])(x)
        omega2 = (2 * np.pi * everything.frequencies_hz[self.kept]) ** 2
        modal = omega2 * np.einsum("k,kc,c,kmc->m", dx, line, mass, shapes)
        return Line(modal, influence, float(-beam.mass * G * dx @ line[:, COMPONENTS.index("z")]))


def _cut(shape: PiecewiseCubic, e: int, cut: float, component: int, power: int, factor: float) -> PiecewiseCubic:
    """Cut element e in two at the local coordinate `cut`, and add ``factor (s - cut)^power`` behind it."""
    halves = []
    for start, length in ((0.0, cut), (cut, 1.0 - cut)):
        # Powers of s = start + length t in powers of t.
        turn = np.array([[comb(k, j) * start ** (k - j) * length**j if k >= j else 0.0 for k in range(4)] for j in range(4)])
        halves.append(np.einsum("jk,knc->jnc", turn, shape.coefficients[e]))
    halves[1][power, 0, component] += factor * (1.0 - cut) ** power
    kept = [half for half, length in zip(halves, (cut, 1.0 - cut), strict=True) if length > 0.0]
    inner = [shape.edges[e] + cut * (shape.edges[e + 1] - shape.edges[e])] if len(kept) == 2 else []
    edges = np.concatenate([shape.edges[: e + 1], inner, shape.edges[e + 1 :]])
    return PiecewiseCubic(edges, np.concatenate([shape.coefficients[:e], kept, shape.coefficients[e + 1 :]]))
