r"""Beams in three dimensions: elements, bearings, named modes; a way to make a `Deck`.

An element carries four fields: axial u and twist theta (quadratic, with a node in the middle), lateral v and vertical w
(cubic, Euler-Bernoulli). With the shape functions as powers of the local coordinate, ``N = T^T (1, s, s^2, s^3)``, every
matrix is one integral,

    K = T^T [ int D_k D_k^T ds ] T * stiffness / h^(2k-1),      M = T^T [ int P P^T ds ] T * mass h,

with k = 1 (axial: EA, twist: G J) or k = 2 (bending: E I). Freedoms at a node: u, v, w, theta_x, v' = theta_z and
w' = -theta_y.

Static influence lines follow from Mueller-Breslau: the influence line of a section force is the deflected shape under a
unit jump of the conjugate displacement, and that of a reaction the shape under a unit support displacement. Both are exact
at any load position because the cubic (for twist the linear) functions contain the exact static solution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from . import inputs
from .deck import COMPONENTS, Deck, Line, PiecewiseCubic, rayleigh, rayleigh_ratio
from .inputs import G, InputError

__all__ = ["Beam", "BeamModes", "Bearing", "deck", "deck_from_table"]

FIXITIES = ("x", "y", "z", "roll", "pitch", "yaw")
SECTION_QUANTITIES = {
    "displacement_y": "m", "displacement_z": "m", "rotation_x": "rad",
    "moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m", "shear_vertical": "N", "shear_lateral": "N",
}  # fmt: skip
REACTION_QUANTITIES = {"force_y": "N", "force_z": "N", "moment_x": "N m"}

_FIELDS = ("axial", "lateral", "vertical", "torsion")
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


@dataclass(frozen=True)
class Bearing:
    """A bearing line across the deck at x (m) and the freedoms it holds: a subset of x y z roll pitch yaw."""

    x: float
    fixed: tuple[str, ...] = ("y", "z", "roll")


@dataclass(frozen=True)
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


@dataclass(frozen=True)
class Beam:
    """A uniform deck on bearings.

    Attributes
    ----------
    name : str
    spans : tuple of float
        m; bearing lines stand at their ends. Several spans are continuous.
    mass : float
        kg/m.
    bending_stiffness_vertical : float
        E I_y, N m2.
    bending_stiffness_lateral, torsional_stiffness, axial_stiffness : float or None
        E I_z and G J (N m2), E A (N). None: rigid in that way.
    polar_inertia : float or None
        Mass moment of inertia about the axis per metre, kg m.
    bearings : tuple of Bearing
        Default: y, z and roll held at every bearing line, x at the first.
    elements : int or None
        Number of elements; default about 40, at least 12 a span.

    Raises
    ------
    InputError
        Spans, mass or stiffness not positive, a bearing off the deck, or a beam that can move as a rigid body.
    """

    name: str
    spans: tuple[float, ...]
    mass: float
    bending_stiffness_vertical: float
    bending_stiffness_lateral: float | None = None
    torsional_stiffness: float | None = None
    axial_stiffness: float | None = None
    polar_inertia: float | None = None
    bearings: tuple[Bearing, ...] = ()
    elements: int | None = None

    def __post_init__(self) -> None:
        where = f"deck {self.name}"
        spans = inputs.numbers(f"{where}: spans", self.spans, above=0.0, unit="m")
        if len(spans) == 0:
            raise InputError(f"{where}: spans", [], "must hold at least one span")
        object.__setattr__(self, "spans", tuple(spans.tolist()))
        inputs.number(f"{where}: mass", self.mass, above=0.0, unit="kg/m")
        inputs.number(f"{where}: bending_stiffness_vertical", self.bending_stiffness_vertical, above=0.0, unit="N m2")
        for key in ("bending_stiffness_lateral", "torsional_stiffness", "axial_stiffness", "polar_inertia"):
            if getattr(self, key) is not None:
                inputs.number(f"{where}: {key}", getattr(self, key), above=0.0)
        if (self.torsional_stiffness is None) != (self.polar_inertia is None):
            missing = "polar_inertia" if self.polar_inertia is None else "torsional_stiffness"
            raise InputError(f"{where}: {missing}", None, "is missing", "Twist needs torsional_stiffness and polar_inertia")
        if not self.bearings:
            lines = np.concatenate([[0.0], np.cumsum(spans)])
            held = tuple(
                Bearing(x, ("y", "z", "roll", "x") if i == 0 else ("y", "z", "roll")) for i, x in enumerate(lines.tolist())
            )
            object.__setattr__(self, "bearings", held)
        for i, bearing in enumerate(self.bearings, start=1):
            here = f"{where}: bearing {i}"
            inputs.number(f"{here}: x", bearing.x, least=0.0, most=self.length * (1 + 1e-12), unit="m")
            for f in bearing.fixed:
                inputs.choice(f"{here}: fixed", f, FIXITIES)
        if self.elements is not None:
            inputs.integer(f"{where}: elements", self.elements, least=2, most=2000)
        self._refuse_mechanism()

    @property
    def length(self) -> float:
        """Total length, m."""
        return float(sum(self.spans))

    @property
    def fields(self) -> tuple[str, ...]:
        """The ways this beam can move: axial, lateral, vertical, torsion."""
        stiffness = (
            self.axial_stiffness,
            self.bending_stiffness_lateral,
            self.bending_stiffness_vertical,
            self.torsional_stiffness,
        )
        return tuple(f for f, s in zip(_FIELDS, stiffness, strict=True) if s is not None)

    def _refuse_mechanism(self) -> None:
        """Check that the bearings hold every rigid-body motion the beam is free to make."""
        motions = {
            "axial": [("sliding along x", {"x": lambda x: 1.0})],
            "lateral": [("moving along y", {"y": lambda x: 1.0}), ("yawing", {"y": lambda x: x, "yaw": lambda x: 1.0})],
            "vertical": [("moving along z", {"z": lambda x: 1.0}), ("pitching", {"z": lambda x: x, "pitch": lambda x: 1.0})],
            "torsion": [("rolling", {"roll": lambda x: 1.0})],
        }
        for name in self.fields:
            rows = [
                [motion.get(f, lambda x: 0.0)(b.x / self.length) for _, motion in motions[name]]
                for b in self.bearings
                for f in b.fixed
                if any(f in motion for _, motion in motions[name])
            ]
            if np.linalg.matrix_rank(np.array(rows) if rows else np.zeros((1, 1))) < len(motions[name]):
                free = " or ".join(label for label, _ in motions[name])
                raise InputError(
                    f"deck {self.name}: bearings",
                    [(b.x, " ".join(b.fixed)) for b in self.bearings],
                    f"do not keep the deck from {free}, so it is a mechanism",
                    "Hold one more freedom, or one more bearing line",
                )

    @cached_property
    def mesh(self) -> _Mesh:
        """The finite-element mesh of modes and histories."""
        wanted = self.elements or 40
        lines = np.concatenate([[0.0], np.cumsum(self.spans)])
        per_span = [max(2 if self.elements else 12, round(wanted * s / self.length)) for s in self.spans]
        nodes = [np.linspace(a, b, n + 1) for a, b, n in zip(lines[:-1], lines[1:], per_span, strict=True)]
        return _Mesh(self, np.unique(np.concatenate([*nodes, [b.x for b in self.bearings]]).round(12)))

    @cached_property
    def modes(self) -> BeamModes:
        """All modes of the mesh with names, ascending. The upper half of them is only the mesh's own."""
        return self.mesh.modes()

    def deck(
        self,
        modes: int = 20,
        damping: tuple[float, float] | float = 0.0,
        tracks: dict[str, float] | None = None,
        width: float | None = None,
    ) -> Deck:
        """Return the modal deck of the lowest modes that loads can excite (axial ones are left out).

        Parameters
        ----------
        modes : int
        damping : (alpha, beta) of Rayleigh, or one ratio for every mode
        tracks, width
            See `Deck`.
        """
        wanted = inputs.integer("deck.modes", modes, least=1)
        everything = self.modes
        excitable = [i for i, n in enumerate(everything.names) if not n.startswith("axial")]
        if wanted > len(excitable):
            raise InputError("deck.modes", modes, f"the mesh has {len(excitable)} modes that loads excite", "Use more elements")
        kept = excitable[:wanted]
        frequencies = everything.frequencies_hz[kept]
        ratios = np.full(wanted, damping) if np.isscalar(damping) else rayleigh_ratio(*damping, frequencies)
        return Deck(
            name=self.name,
            length=self.length,
            frequencies_hz=frequencies,
            damping_ratios=ratios,
            mode_names=tuple(everything.names[i] for i in kept),
            shapes=self.mesh.interpolate(everything.vectors[:, kept]),
            supports=tuple(b.x for b in self.bearings),
            recovery=_BeamRecovery(self, kept),
            tracks=tracks or {},
            width=width,
            mass_per_metre=self.mass,
        )


class _Mesh:
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
        for name in _FIELDS:
            dofs = np.unique(self.freedoms[name])
            part = vectors[dofs]
            energy.append(np.einsum("im,ij,jm->m", part, self.matrices[0][np.ix_(dofs, dofs)], part))
        labels = {"axial": "axial", "lateral": "lateral bending", "vertical": "vertical bending", "torsion": "torsion"}
        names, seen = [], dict.fromkeys(_FIELDS, 0)
        for winner in np.argmax(energy, axis=0):
            name = _FIELDS[winner]
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


class _BeamRecovery:
    """Influence lines and modal values of a beam's outputs; see `Recovery`."""

    _CONJUGATE = {
        # quantity: field, is it the conjugate of the slope, sign
        "moment_vertical": ("vertical", True, -1.0),
        "moment_lateral": ("lateral", True, 1.0),
        "torsion": ("torsion", False, 1.0),
        "shear_vertical": ("vertical", False, 1.0),
        "shear_lateral": ("lateral", False, 1.0),
    }
    _FIELD_OF = {
        "displacement_y": "lateral", "displacement_z": "vertical", "rotation_x": "torsion",
        "force_y": "lateral", "force_z": "vertical", "moment_x": "torsion",
    }  # fmt: skip
    _FREEDOM_OF = {"displacement_y": 1, "displacement_z": 2, "rotation_x": 3, "force_y": 1, "force_z": 2, "moment_x": 3}

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
        nodes = self.beam.mesh.nodes
        near = np.min(np.abs(nodes - x)) < 1e-9 * self.beam.length
        mesh = self.beam.mesh if near else _Mesh(self.beam, np.sort(np.append(nodes, x)))
        node = mesh.node(x)
        load, jump = np.zeros(mesh.size), np.zeros(mesh.size)
        if quantity in self._FREEDOM_OF:
            load[6 * node + self._FREEDOM_OF[quantity]] = 1.0
            return self._line(mesh, mesh.interpolate(mesh.solve(load)))
        _, slope, sign = self._CONJUGATE[quantity]
        # End force of the element before x; at the very start, of the element after it with the sign reversed.
        element, sign = (node - 1, sign) if node else (0, -sign)
        dofs = mesh.freedoms[name][element]
        end = (2 if node else 0) + slope if len(dofs) == 4 else (2 if node else 0)
        load[dofs] = sign * mesh.element(name, element)[0][end]
        jump[dofs[end]] = sign
        shape, inside = mesh.interpolate(mesh.solve(load)), mesh.interpolate(jump)
        shape.coefficients[element] -= inside.coefficients[element]
        return self._line(mesh, shape)

    def _reaction(self, quantity: str, support: float) -> Line | None:
        mesh = self.beam.mesh
        freedom = {"force_y": "y", "force_z": "z", "moment_x": "roll"}[quantity]
        held = any(abs(b.x - support) < 1e-9 * self.beam.length and freedom in b.fixed for b in self.beam.bearings)
        if not held or self._FIELD_OF[quantity] not in self.beam.fields:
            return None
        dof = 6 * mesh.node(support) + self._FREEDOM_OF[quantity]
        moved = mesh.solve(mesh.matrices[0][dof])
        moved[dof] -= 1.0
        return self._line(mesh, mesh.interpolate(moved))

    def _line(self, mesh: _Mesh, influence: PiecewiseCubic) -> Line:
        """Attach the modal values: the static effect of each mode's own inertia load, S_m = omega^2 int line m phi dx."""
        points, weights = np.polynomial.legendre.leggauss(5)
        local, weights = (points + 1) / 2, weights / 2
        x = (mesh.nodes[:-1, None] + mesh.h[:, None] * local).ravel()
        dx = (mesh.h[:, None] * weights).ravel()
        line = influence(x)[:, 0]
        beam = self.beam
        mass = np.array([beam.mass, beam.mass, beam.polar_inertia or 0.0])
        everything = beam.modes
        shapes = beam.mesh.interpolate(everything.vectors[:, self.kept])(x)
        omega2 = (2 * np.pi * everything.frequencies_hz[self.kept]) ** 2
        modal = omega2 * np.einsum("k,kc,c,kmc->m", dx, line, mass, shapes)
        return Line(modal, influence, float(-beam.mass * G * dx @ line[:, COMPONENTS.index("z")]))


_STIFFNESSES = (
    "bending_stiffness_vertical",
    "bending_stiffness_lateral",
    "torsional_stiffness",
    "axial_stiffness",
    "polar_inertia",
)
_SECTION = (
    "youngs_modulus",
    "poisson_ratio",
    "density",
    "area",
    "second_moment_vertical",
    "second_moment_lateral",
    "torsion_constant",
)


def deck_from_table(name: str, content: dict[str, Any]) -> Deck:
    """Build a modal deck from the content of a deck file or of a case's ``[deck]``.

    Keys: ``length`` or ``spans`` (m); either ``[section]`` (E, nu, density, A, I_y, I_z, J) or stiffnesses and ``mass``;
    ``damping`` = {ratio, frequencies_hz} (Rayleigh) or {modal}; ``modes``; ``[[bearing]]`` x, fixed; ``tracks``; ``width``.

    Raises
    ------
    InputError
        Missing, unknown, contradictory or wrong keys, or a mechanism.
    """
    where = f"deck {name}"
    allowed = ["length", "spans", "section", *_STIFFNESSES, "mass", "damping", "modes", "bearing", "tracks", "width"]
    inputs.keys(where, content, [*allowed, "elements", "name", "source", "note"], ["damping"])
    if ("length" in content) == ("spans" in content):
        raise InputError(f"{where}: length", content.get("length"), "give either length or spans")
    spans = content.get("spans", [content.get("length")])
    if ("section" in content) == ("mass" in content):
        raise InputError(f"{where}: section", None, "give either a section or stiffnesses with mass, never both")
    if "section" in content:
        clash = [k for k in _STIFFNESSES if k in content]
        if clash:
            raise InputError(f"{where}: {clash[0]}", content[clash[0]], "a section is given too, never both", "Remove one")
        properties = _from_section(f"{where}: section", inputs.table(f"{where}: section", content["section"]))
    else:
        inputs.keys(where, content, content, ["bending_stiffness_vertical"])
        properties = {k: content[k] for k in (*_STIFFNESSES, "mass") if k in content}
    bearings = tuple(_bearing(where, i, b) for i, b in enumerate(content.get("bearing", []), start=1))
    beam = Beam(
        name,
        inputs.numbers(f"{where}: spans", spans, above=0.0, unit="m"),
        bearings=bearings,
        elements=content.get("elements"),
        **properties,
    )
    width = content.get("width")
    width = None if width is None else inputs.number(f"{where}: width", width, above=0.0, unit="m")
    tracks = inputs.table(f"{where}: tracks", content.get("tracks", {}))
    half = width / 2 if width else None
    for key, y in tracks.items():
        inputs.number(f"{where}: tracks.{key}", y, least=None if half is None else -half, most=half, unit="m")
    damping = _damping(where, inputs.table(f"{where}: damping", content["damping"]))
    return beam.deck(content.get("modes", 20), damping, tracks, width)


def _from_section(where: str, s: dict[str, Any]) -> dict[str, float]:
    inputs.keys(where, s, [], _SECTION)
    for key in _SECTION:
        if key != "poisson_ratio":
            inputs.number(f"{where}.{key}", s[key], above=0.0)
    inputs.number(f"{where}.poisson_ratio", s["poisson_ratio"], above=-1.0, most=0.5)
    e = s["youngs_modulus"]
    return {
        "mass": s["density"] * s["area"],
        "bending_stiffness_vertical": e * s["second_moment_vertical"],
        "bending_stiffness_lateral": e * s["second_moment_lateral"],
        "torsional_stiffness": e / (2 * (1 + s["poisson_ratio"])) * s["torsion_constant"],
        "axial_stiffness": e * s["area"],
        "polar_inertia": s["density"] * (s["second_moment_vertical"] + s["second_moment_lateral"]),
    }


def _bearing(where: str, i: int, raw: Any) -> Bearing:
    here = f"{where}: bearing {i}"
    b = inputs.table(here, raw)
    inputs.keys(here, b, [], ["x", "fixed"])
    fixed = b["fixed"].split() if isinstance(b["fixed"], str) else b["fixed"]
    if not isinstance(fixed, list):
        raise InputError(f"{here}: fixed", b["fixed"], "must list some of " + " ".join(FIXITIES))
    return Bearing(inputs.number(f"{here}: x", b["x"], unit="m"), tuple(fixed))


def _damping(where: str, d: dict[str, Any]) -> tuple[float, float] | float:
    here = f"{where}: damping"
    if "modal" in d:
        inputs.keys(here, d, [], ["modal"])
        return inputs.number(f"{here}.modal", d["modal"], least=0.0, most=0.5)
    inputs.keys(here, d, [], ["ratio", "frequencies_hz"])
    return rayleigh(d["ratio"], d["frequencies_hz"])


def deck(source: str | Path) -> Deck:
    """Load a deck by shipped name (``viaduct36``) or from a ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), or bad content.
    """
    path = inputs.data_file("decks", source)
    if path.suffix != ".toml":
        raise InputError("deck", str(source), "deck files are TOML")
    return deck_from_table(path.stem, inputs.read_toml(path))
