r"""Finite elements of a straight beam on bearings: assembled matrices and named modes.

Four fields (see `elements`): axial u of the centroid, lateral v and vertical w of the deck axis,
which runs through the shear centres, and twist theta. The beam itself couples only v and theta, by
a centroid off the axis: the velocity of the mass is that of v - z_c theta. Bearings off the axis
couple the rest (see `bearings`): rigid ones are eliminated node by node, springs are added.
Freedoms at a node: u, v, w, theta_x, psi_v = theta_z and psi_w = -theta_y, which are v' and w'
without shear flexibility.

Where simple spans meet there are two nodes at one place, and shapes may jump.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, eigh
from scipy.sparse import coo_array, csc_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackError, SuperLU

from ..errors import InputError, brief
from ..guideways import PiecewiseCubic
from ..settings import refuse_bytes
from . import elements
from .bearings import null_space
from .eigen import count_below, factorised, lowest
from .elements import FIELDS, SHAPE_FIELDS
from .properties import BeamProperties

__all__ = ["DENSE", "BeamModes", "Mesh"]

_NODE_FREEDOMS = {"axial": (0,), "lateral": (1, 4), "vertical": (2, 5), "torsion": (3,)}
"""Where each field's freedoms stand among the six of a node."""
_LABELS = {
    "axial": "axial",
    "lateral": "lateral bending",
    "vertical": "vertical bending",
    "torsion": "torsion",
}
MIXED = (0.25, 0.75)
"""Share of axial kinetic energy between which a mode is called axial-bending."""
DENSE = 400
"""Coupled freedoms up to which all modes together cost no more than the few that are needed."""
_FULL_MATRICES = 6  # that stand in memory together while all modes are found
_SPARE = 6  # modes beyond those needed, among which a gap is sought


@dataclass(frozen=True, eq=False)
class BeamModes:
    """Natural modes of a beam, all fields, ascending.

    Attributes
    ----------
    frequencies_hz : ndarray, shape (m,)
    names : tuple of str
        ``vertical bending 1``, ``lateral bending 1``, ``torsion 1``, ``axial 1``, ``axial-bending
        1`` ..., each numbered within its kind. A mode is named after the field that holds most of
        its kinetic energy, that of the mass's own lateral motion counted as lateral; but
        ``axial-bending`` where neither the axial share nor the rest reaches three quarters, as with
        bearings below the axis. (Strain energy would be of no use on soft bearings, which hold most
        of it.)
    vectors : ndarray, shape (freedoms, m)
        Mass-normalised.
    energies : dict of ndarray, shape (m,)
        Share of the kinetic energy in each field.
    """

    __repr__ = brief

    frequencies_hz: np.ndarray
    names: tuple[str, ...]
    vectors: np.ndarray = field(repr=False)
    energies: dict[str, np.ndarray] = field(repr=False)

    @property
    def excitable(self) -> np.ndarray:
        """Which modes loads can excite: those that move the deck sideways, up or in twist."""
        return self.energies["axial"] < 1.0 - 1e-12


class Mesh:
    """Assembled matrices over given elements.

    Freedoms: six a node, then axial and twist mid-nodes of each element.

    Attributes
    ----------
    edges : ndarray, shape (e + 1,)
        Ends of the elements, m.
    nodes : ndarray, shape (n,)
        Places of the nodes, m; two at each joint between simple spans.
    h : ndarray, shape (e,)
        Lengths, m.
    freedoms : dict of ndarray of int, shape (e, 3 or 4)
        Of each field, those of every element.
    phi : dict of ndarray, shape (e,)
        Of each field, Phi of every element; see `elements`.
    shapes : dict of ndarray, shape (e, 4, 3 or 4)
        Of each field, T of every element: powers of the local coordinate from its freedoms.
    """

    def __init__(self, beam: BeamProperties, edges: np.ndarray) -> None:
        self.beam, self.edges = beam, edges
        self.h = np.diff(edges)
        count = len(self.h)
        starts_piece = np.isin(edges[:-1], beam.joints)
        first = np.arange(count) + np.cumsum(starts_piece)  # the node at which each element starts
        self.nodes = np.insert(edges, np.flatnonzero(starts_piece), edges[:-1][starts_piece])
        self._pieces = np.zeros(len(self.nodes), dtype=int)
        self._pieces[first], self._pieces[first + 1] = (np.cumsum(starts_piece),) * 2
        self.size = 6 * len(self.nodes) + 2 * count
        middle = 6 * len(self.nodes) + np.arange(count)
        start, stop = 6 * first, 6 * (first + 1)
        self.freedoms = {
            "axial": np.stack([start, middle, stop], axis=1),
            "torsion": np.stack([start + 3, middle + count, stop + 3], axis=1),
            "lateral": np.stack([start + 1, start + 4, stop + 1, stop + 4], axis=1),
            "vertical": np.stack([start + 2, start + 5, stop + 2, stop + 5], axis=1),
        }
        self.phi = {
            name: np.full(count, beam.shear_flexibility(name)) * 12.0 / self.h**2 for name in FIELDS
        }
        # Laid out as they come back from another process, where products must give the same digits.
        self.shapes = {
            name: np.ascontiguousarray(elements.shape_matrices(name, self.h, self.phi[name]))
            for name in FIELDS
        }

    def node(self, x: float, piece: int | None = None) -> int:
        """Return the node at x (m).

        At a joint that of the given simple span (from 0), or else the first.
        """
        distance = np.abs(self.nodes - x)
        if piece is not None:
            distance = np.where(self._pieces == piece, distance, np.inf)
        return int(np.argmin(distance))

    def nodes_at(self, x: float) -> np.ndarray:
        """Return the nodes at x (m): one, or two at a joint."""
        return np.flatnonzero(np.abs(self.nodes - x) < 1e-9 * self.edges[-1])

    @cached_property
    def element_matrices(self) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Of each field the beam has, stiffness and mass of every element, shape (e, n, n)."""
        return {
            name: elements.matrices(
                name,
                self.h,
                self.phi[name],
                self.beam.stiffness_of(name),
                self.beam.polar_inertia if name == "torsion" else self.beam.mass,
                self.beam.rotary_inertia(name),
            )
            for name in self.beam.fields
        }

    @cached_property
    def _eccentric_mass(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Mass that a centroid off the axis adds: rows, columns and values of each part."""
        z, mass, freedoms = self.beam.centroid_height, self.beam.mass, self.freedoms
        if z == 0.0 or "torsion" not in self.beam.fields:
            return []
        parts = [("torsion", "torsion", mass * z**2)]
        if "lateral" in self.beam.fields:
            parts += [("lateral", "torsion", -mass * z), ("torsion", "lateral", -mass * z)]
        result = []
        for a, b, factor in parts:
            values = factor * elements.coupling(self.h, self.shapes[a], self.shapes[b])
            result.append((freedoms[a], freedoms[b], values))
        return result

    @cached_property
    def matrices(self) -> tuple[csr_array, csr_array]:
        """K and M over all freedoms, bearings not yet applied, shape (size, size)."""
        stiffness, mass = [], []
        for name, (k, m) in self.element_matrices.items():
            freedoms = self.freedoms[name]
            stiffness.append((freedoms, freedoms, k))
            mass.append((freedoms, freedoms, m))
        mass += self._eccentric_mass + self._point_masses
        return self._assembled(stiffness), self._assembled(mass)

    @cached_property
    def _point_rows(self) -> list[tuple[int, list[tuple[float, np.ndarray]]]]:
        """Of each point mass its node, and inertias with the rows of their motions, shape (6,)."""
        z = self.beam.centroid_height
        return [(self.node(own.x), own.parts(z)) for own in self.beam.point_masses]

    @property
    def _point_masses(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Mass of what stands at single places: rows, columns and values of each part."""
        result = []
        for node, parts in self._point_rows:
            freedoms = 6 * node + np.arange(6)[None]
            values = sum(m * np.outer(row, row) for m, row in parts)
            result.append((freedoms, freedoms, values[None]))
        return result

    def _assembled(self, parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> csr_array:
        """Add up parts, each with rows (e, n1), columns (e, n2) and values (e, n1, n2)."""
        rows = np.concatenate(
            [np.broadcast_to(r[:, :, None], v.shape).ravel() for r, _, v in parts]
        )
        columns = np.concatenate(
            [np.broadcast_to(c[:, None, :], v.shape).ravel() for _, c, v in parts]
        )
        values = np.concatenate([v.ravel() for _, _, v in parts])
        return coo_array((values, (rows, columns)), shape=(self.size, self.size)).tocsr()

    # ---- bearings

    @cached_property
    def bearing_nodes(self) -> list[int]:
        """The node of each bearing of the beam."""
        return [self.node(b.x, self.beam.piece(b)) for b in self.beam.bearings]

    @cached_property
    def _present(self) -> np.ndarray:
        """Which of a node's six freedoms the beam has."""
        return np.array(sorted(i for name in self.beam.fields for i in _NODE_FREEDOMS[name]))

    def bearing_row(self, bearing: int, freedom: str) -> np.ndarray:
        """Return the motion of a bearing (from 0) from its node's freedoms, shape (6,).

        Freedoms that the beam lacks are at rest.
        """
        row = np.zeros(6)
        whole = self.beam.bearings[bearing].row(freedom, self.beam.centroid_height)
        row[self._present] = whole[self._present]
        return row

    def rigid_rows(self, node: int) -> tuple[list[tuple[int, str]], np.ndarray]:
        """Return what is held rigidly at a node.

        Returns
        -------
        list of (int, str), and ndarray, shape (r, 6)
            Bearing (from 0) and freedom that it holds; the rows of the node's freedoms that are
            then zero.
        """
        rigid = [
            (i, freedom)
            for i, own in enumerate(self.bearing_nodes)
            if own == node
            for freedom in self.beam.bearings[i].rigid
        ]
        return rigid, np.array([self.bearing_row(*each) for each in rigid]).reshape(-1, 6)

    @cached_property
    def basis(self) -> csr_array:
        """Motions of all freedoms that the rigid bearings allow, shape (size, free)."""
        present, on_bearings = self._present, set(self.bearing_nodes)
        rows, columns, values, count = [], [], [], 0
        for node in range(len(self.nodes)):
            allowed = np.eye(len(present))
            if node in on_bearings:
                allowed = null_space(self.rigid_rows(node)[1][:, present])
            i, j = np.nonzero(allowed)
            rows.append(6 * node + present[i])
            columns.append(count + j)
            values.append(allowed[i, j])
            count += allowed.shape[1]
        quadratic = [f for f in ("axial", "torsion") if f in self.beam.fields]
        middles = np.concatenate([self.freedoms[f][:, 1] for f in quadratic] or [[]])
        rows.append(middles.astype(int))
        columns.append(count + np.arange(len(middles)))
        values.append(np.ones(len(middles)))
        entries = tuple(np.concatenate(part) for part in (values, rows, columns))
        return csr_array((entries[0], entries[1:]), shape=(self.size, count + len(middles)))

    @cached_property
    def stiffness(self) -> csr_array:
        """K with the springs of the bearings, shape (size, size)."""
        springs = [
            (i, freedom, stiffness)
            for i, bearing in enumerate(self.beam.bearings)
            for freedom, stiffness in bearing.springs.items()
        ]
        if not springs:
            return self.matrices[0]
        rows = np.array([self.bearing_row(i, freedom) for i, freedom, _ in springs])
        stiffnesses = np.array([stiffness for *_, stiffness in springs])
        values = stiffnesses[:, None, None] * rows[:, :, None] * rows[:, None, :]
        first = np.array([6 * self.bearing_nodes[i] for i, *_ in springs])
        freedoms = first[:, None] + np.arange(6)
        return self.matrices[0] + self._assembled([(freedoms, freedoms, values)])

    def _reduced(self, matrix: csr_array) -> csr_array:
        return (self.basis.T @ matrix @ self.basis).tocsr()

    @cached_property
    def _factor(self) -> SuperLU:
        return factorised(self._reduced(self.stiffness))

    def __getstate__(self) -> dict[str, Any]:
        """Leave out the factorisation, which cannot be sent to another process; it is made anew."""
        return {name: value for name, value in vars(self).items() if name != "_factor"}

    def solve(self, load: np.ndarray) -> np.ndarray:
        """Return the static displacement of all freedoms under a nodal load; the bearings hold."""
        return self.basis @ self._factor.solve(self.basis.T @ load)

    # ---- modes

    def modes(self, wanted: int | None = None) -> BeamModes:
        """Return natural modes, found in each uncoupled group of freedoms on its own.

        A straight beam on bearings in its axis falls into four groups.

        Parameters
        ----------
        wanted : int, optional
            How many modes that loads can excite are needed; the lowest ones, and all others among
            them. By default all modes of the mesh are given, which costs the cube of the freedoms
            that bearings couple; few modes cost their number only.
        """
        k, m = self._reduced(self.stiffness), self._reduced(self.matrices[1])
        pattern = abs(k) + abs(m)
        pattern.eliminate_zeros()
        count, group = connected_components(pattern, directed=False)
        groups = [np.flatnonzero(group == g) for g in range(count)]
        asked = wanted
        while True:
            try:
                solved, order = _solved(k, m, groups, asked)
            except (LinAlgError, ArpackError, RuntimeError):  # a matrix is singular to round-off
                raise self._ill_scaled() from None
            modes = self._modes_of(groups, solved, order)
            vectors = modes.vectors[:, : 2 * (wanted or 10)]
            # Without round-off the energies of a mode give its frequency again.
            squares = (2 * np.pi * modes.frequencies_hz[: vectors.shape[1]]) ** 2
            again = np.sum(vectors * (self.stiffness @ vectors), axis=0)
            if not np.all(np.abs(again - squares) <= 1e-3 * squares):
                raise self._ill_scaled()
            enough = wanted is None or len(modes.names) == k.shape[0]
            if enough or int(np.sum(modes.excitable)) >= wanted:
                return modes
            asked *= 2

    def _ill_scaled(self) -> InputError:
        allowed = "is so far from the deck's mass, other stiffnesses and springs that round-off "
        allowed += "spoils its modes"
        field = "bending_stiffness_vertical"
        remedy = "Check the units of all of them: N m2, N, N/m, kg/m"
        for remark in self.beam.remarks[:1]:  # what is doubted anyway is the likely reason
            field, question = remark.field, remark.text.rpartition(": ")[2]
            remedy = question[:1].upper() + question[1:]
        return InputError(field, getattr(self.beam, field, None), allowed, remedy)

    def _modes_of(
        self,
        groups: list[np.ndarray],
        solved: list[tuple[np.ndarray, np.ndarray]],
        order: np.ndarray,
    ) -> BeamModes:
        """Return the modes of all groups together, in the given order; see `_solved`."""
        squares = np.concatenate([values for values, _ in solved])
        counts = [len(values) for values, _ in solved]
        whose, firsts = np.repeat(np.arange(len(groups)), counts), np.cumsum([0, *counts])
        vectors = np.zeros((self.size, len(order)))
        for g, (freedoms, (_, shapes)) in enumerate(zip(groups, solved, strict=True)):
            own = np.flatnonzero(whose[order] == g)
            vectors[:, own] = self.basis[:, freedoms] @ shapes[:, order[own] - firsts[g]]
        energies = self._energies(vectors)
        with np.errstate(invalid="ignore"):  # NaN where round-off made a square negative
            frequencies = np.sqrt(squares[order]) / (2 * np.pi)
        return BeamModes(frequencies, _names(energies), _signed(vectors), energies)

    def _energies(self, vectors: np.ndarray) -> dict[str, np.ndarray]:
        """Return the share of each field in the kinetic energy of every mode."""
        result = {name: np.zeros(vectors.shape[1]) for name in FIELDS}
        for name, (_, mass) in self.element_matrices.items():
            part = vectors[self.freedoms[name]]
            result[name] += np.sum(part * (mass @ part), axis=(0, 1))
        # The mass moves sideways by v - z_c theta; its own turning alone is torsion.
        for rows, columns, values in self._eccentric_mass:
            result["lateral"] += np.sum(vectors[rows] * (values @ vectors[columns]), axis=(0, 1))
        for node, parts in self._point_rows:
            own = vectors[6 * node : 6 * node + 6]
            (along, along_row), (across, across_row), (up, up_row), (roll, roll_row) = parts
            result["lateral"] += across * (across_row @ own) ** 2
            result["vertical"] += up * (up_row @ own) ** 2
            result["torsion"] += roll * (roll_row @ own) ** 2
            if "axial" in self.beam.fields:
                result["axial"] += along * (along_row @ own) ** 2
            else:  # it moves lengthwise only because sections turn
                result["lateral"] += along * (along_row[4] * own[4]) ** 2
                result["vertical"] += along * (along_row[5] * own[5]) ** 2
        whole = sum(result.values())
        return {name: part / whole for name, part in result.items()}

    def interpolate(self, vectors: np.ndarray) -> PiecewiseCubic:
        """Return lateral, vertical and twist shapes of nodal vectors.

        Parameters
        ----------
        vectors : ndarray, shape (size, n) or (size,)
        """
        vectors = vectors.reshape(self.size, -1)
        result = np.zeros((len(self.h), 4, vectors.shape[1], 3))
        for c, name in enumerate(SHAPE_FIELDS):
            if name in self.beam.fields:
                result[..., c] = self.shapes[name] @ vectors[self.freedoms[name]]
        return PiecewiseCubic(self.edges, result)


def _solved(
    k: csr_array, m: csr_array, groups: list[np.ndarray], count: int | None
) -> tuple[list[tuple[np.ndarray, np.ndarray]], np.ndarray]:
    """Return the `count` lowest modes and some more, or all of them if None.

    Returns
    -------
    list of (ndarray, shape (s,); ndarray, shape (n, s))
        Of each group omega^2, ascending, and shapes.
    ndarray of int
        Which of them, one group after the other, are the lowest; ascending, with none left out
        between.
    """
    solved, known = [], np.inf
    for freedoms in groups:
        own_k, own_m = k[freedoms][:, freedoms], m[freedoms][:, freedoms]
        if count is None:
            squares, shapes = _all_of(own_k, own_m)
        else:
            squares, shapes = _lowest_of(own_k, own_m, count)
        if len(squares) < len(freedoms):  # above its last mode nothing of this group is known
            known = min(known, squares[-1])
        solved.append((squares, shapes))
    squares = np.concatenate([values for values, _ in solved])
    order = np.argsort(squares, kind="stable")
    return solved, order[squares[order] <= known][: None if count is None else 2 * count]


def _lowest_of(k: csr_array, m: csr_array, wanted: int) -> tuple[np.ndarray, np.ndarray]:
    """Return omega^2 and shapes of one group of freedoms.

    At least the `wanted` lowest, none left out below the last.
    """
    size, count = k.shape[0], wanted + _SPARE
    if size > DENSE and count < size // 4:
        squares, shapes = lowest(csc_array(k), csc_array(m), count)
        # Counted where two modes are farthest apart: there round-off cannot put one on the wrong
        # side.
        last = wanted + int(np.argmax(squares[wanted:] / squares[wanted - 1 : -1]))
        if count_below(k, m, float(np.sqrt(squares[last - 1] * squares[last]))) == last:
            return squares[:last], shapes[:, :last]
    return _all_of(k, m)


def _all_of(k: csr_array, m: csr_array) -> tuple[np.ndarray, np.ndarray]:
    """Return omega^2 and shapes of all modes of a group of freedoms, if they fit into memory."""
    size = k.shape[0]
    needed = 8.0 * _FULL_MATRICES * size**2
    remedy = "Use fewer modes, elements or bearings"
    refuse_bytes("modes", None, needed, f"all modes of {size} coupled freedoms", remedy)
    return eigh(k.toarray(), m.toarray())


def _names(energies: dict[str, np.ndarray]) -> tuple[str, ...]:
    """Name modes by their kinetic energy, see `BeamModes`."""
    shares = np.array([energies[name] for name in FIELDS])
    names, seen = [], {}
    for winner, axial in zip(np.argmax(shares, axis=0), energies["axial"], strict=True):
        label = "axial-bending" if MIXED[0] <= axial <= MIXED[1] else _LABELS[FIELDS[winner]]
        seen[label] = seen.get(label, 0) + 1
        names.append(f"{label} {seen[label]}")
    return tuple(names)


def _signed(vectors: np.ndarray) -> np.ndarray:
    """Fix the sign, which an eigensolver leaves open: the first sizeable entry is positive."""
    large = np.abs(vectors) > 0.3 * np.abs(vectors).max(axis=0)
    first = vectors[np.argmax(large, axis=0), np.arange(vectors.shape[1])]
    return vectors * np.sign(first)
