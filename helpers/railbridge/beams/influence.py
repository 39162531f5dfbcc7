r"""Static influence lines of a beam, and the modal values of its outputs.

By Mueller-Breslau: the influence line of a section force is the deflected shape under a unit jump
of the conjugate displacement, that of a bearing's force the shape under a unit displacement of the
ground below it, its sign turned; that of a displacement is the shape under a unit load there, that
of a rotation the shape under a unit couple. All are exact at any load position and for any section:
inside an element the jump's own function g (a step, a kink, or the shape of a point load or couple)
is added to the elements' shape and its interpolation taken off, so no section needs a mesh of its
own.

A point mass stands on a node, where a jump differs from its interpolation by nothing: it counts in
the nodal inertia alone, and a section at its place is on the face just before it.

A distance t behind a point load ``g = t^3 / (6 E I) - t / kGA``: the kink of w by 1 / kGA is the
jump of the shear strain, while psi stays smooth. Behind a couple that turns the section towards
w' > 0 the moment E I psi' falls by one and the shear force stays, so with ``psi = -t / E I`` and no
shear strain ``g = -t^2 / (2 E I)``: what is recovered is psi, the rotation of the section.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import comb
from typing import Any

import numpy as np

from .. import errors
from ..decks import BEARING_QUANTITIES, REACTION_QUANTITIES, SECTION_QUANTITIES, Line
from ..guideways import PiecewiseCubic
from ..units import G
from .elements import BENDING, SHAPE_FIELDS, rotation_powers
from .mesh import Mesh

__all__ = ["BeamRecovery"]

_FIELD_OF = {
    "displacement_y": "lateral", "displacement_z": "vertical", "rotation_x": "torsion",
    "rotation_y": "vertical", "rotation_z": "lateral",
    "moment_vertical": "vertical", "moment_lateral": "lateral", "torsion": "torsion",
    "shear_vertical": "vertical", "shear_lateral": "lateral",
}  # fmt: skip
_CONJUGATE = {
    # section force: derivative of the field that jumps, sign
    "moment_vertical": (1, -1.0),
    "moment_lateral": (1, 1.0),
    "torsion": (0, 1.0),
    "shear_vertical": (0, 1.0),
    "shear_lateral": (0, 1.0),
}
_TURNED = {"rotation_y": -1.0, "rotation_z": 1.0}
"""Sign of psi, which is w' or v' of a deck rigid in shear, in a rotation of the section."""
_FREEDOM_OF = dict(zip(BEARING_QUANTITIES, ("x", "y", "z", "roll", "pitch", "yaw"), strict=True))
_LINE_MOTION = {
    # reaction: field, place of the conjugate motion among a node's freedoms
    "force_x": ("axial", 0),
    "force_y": ("lateral", 1),
    "force_z": ("vertical", 2),
    "moment_x": ("torsion", 3),
}
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True, eq=False)
class _Jump:
    """The function g of a section, zero before it, in the element that the section cuts.

    Attributes
    ----------
    field : str
    element : int
        From 0.
    place : float
        Of the section in the element, 0..1.
    behind, rotation : ndarray, shape (4,)
        g and the rotation that goes with it, behind the section, as powers of (s - place).
    nodal : ndarray, shape (4,) or (3,)
        g as freedoms of the element.
    interpolated : ndarray, shape (4,)
        What the element makes of them, as powers of s.
    """

    field: str
    element: int
    place: float
    behind: np.ndarray
    rotation: np.ndarray
    nodal: np.ndarray
    interpolated: np.ndarray


class BeamRecovery:
    """Influence lines and modal values of a beam's outputs; see `Recovery`.

    Parameters
    ----------
    mesh : Mesh
        Of the beam.
    frequencies_hz : ndarray, shape (m,)
        Of the deck's modes.
    vectors : ndarray, shape (freedoms, m)
        Their shapes over the beam's mesh, mass-normalised.
    """

    lacks = ""

    def __init__(self, mesh: Mesh, frequencies_hz: np.ndarray, vectors: np.ndarray) -> None:
        self.mesh, self.beam = mesh, mesh.beam
        self._vectors, self._omega2 = vectors, (2 * np.pi * frequencies_hz) ** 2
        self._lines: dict[tuple, Line | None] = {}

    def section(self, quantity: str, x: float) -> Line | None:
        """Return the line of a displacement, rotation or section force at x (m).

        At an inner bearing it is that on the face just before it. None where the beam has no
        stiffness for it.
        """
        errors.choice("quantity", quantity, SECTION_QUANTITIES)
        x = errors.place("x", x, (0.0, self.beam.length), remedy="x runs along the deck")
        return self._cached((quantity, float(x)), self._section_line, quantity, x)

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return the line of a reaction on the deck at the bearing line `support` (m).

        It is that of all bearings there, about the deck axis. None where none of them holds it.
        """
        errors.choice("quantity", quantity, REACTION_QUANTITIES)
        key = (quantity, float(support), "line")
        return self._cached(key, self._reaction_line, quantity, support)

    def bearing(self, number: int, quantity: str) -> Line | None:
        """Return the line of the force or moment of one bearing (from 1) on the deck.

        None where it holds no such freedom. Where rigid bearings on one section share a force that
        statics alone does not split, as two that both hold y do, each takes what equally stiff ones
        would take.
        """
        errors.choice("quantity", quantity, BEARING_QUANTITIES)
        index = errors.integer("number", number, least=1, most=len(self.beam.bearings)) - 1
        key = (quantity, index, "bearing")
        return self._cached(key, self._bearing_line, index, _FREEDOM_OF[quantity])

    def _cached(self, key: tuple, make: Callable[..., Line | None], *arguments: Any) -> Line | None:
        if key not in self._lines:
            self._lines[key] = make(*arguments)
        return self._lines[key]

    # ---- sections

    def _section_line(self, quantity: str, x: float) -> Line | None:
        if _FIELD_OF[quantity] not in self.beam.fields:
            return None
        jump = self._jump(quantity, x)
        moved = self.mesh.solve(self._section_load(quantity, jump))
        shape = self.mesh.interpolate(moved)
        component = SHAPE_FIELDS.index(jump.field)
        shape.coefficients[jump.element, :, 0, component] -= jump.interpolated
        modal, weight = self._inertia_on(jump)
        return self._line(moved, _with_jump(shape, jump), modal, weight)

    def _jump(self, quantity: str, x: float) -> _Jump:
        """Return what a section at x (m) adds inside the element that it cuts."""
        name, mesh = _FIELD_OF[quantity], self.mesh
        e = max(int(np.searchsorted(mesh.edges, x - 1e-9 * self.beam.length)) - 1, 0)
        h = mesh.h[e]
        place = float(np.clip((x - mesh.edges[e]) / h, 0.0, 1.0))
        behind, rotation = self._behind(quantity, h)
        # Values of g and of its rotation at the element's end; the interpolation runs through them.
        powers = (1.0 - place) ** np.arange(4)
        end, turned = behind @ powers, rotation @ powers
        nodal = np.array([0.0, 0.0, end, turned] if name in BENDING else [0.0, end / 2, end])
        return _Jump(name, e, place, behind, rotation, nodal, mesh.shapes[name][e] @ nodal)

    def _behind(self, quantity: str, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Return g and its rotation behind the section as powers of (s - place), shape (4,).

        h is the element's length, m.
        """
        name, beam = _FIELD_OF[quantity], self.beam
        behind, rotation = np.zeros((2, 4))
        if quantity in _CONJUGATE:
            order, sign = _CONJUGATE[quantity]
            behind[order] = sign * h**order
            rotation[0] = sign * order
        elif quantity in _TURNED:
            rotation[1] = -_TURNED[quantity] * h / beam.stiffness_of(name)
            behind[2] = rotation[1] * h / 2
        elif name in BENDING:
            stiffness = beam.stiffness_of(name)
            behind[3] = h**3 / (6 * stiffness)
            behind[1] = -h * beam.shear_flexibility(name) / stiffness
            rotation[2] = h**2 / (2 * stiffness)
        else:
            behind[1] = -h / beam.stiffness_of(name)
        return behind, rotation

    def _section_load(self, quantity: str, jump: _Jump) -> np.ndarray:
        """Return the nodal load of a unit jump, or of a unit load or couple at the section."""
        mesh, name, e = self.mesh, jump.field, jump.element
        load, freedoms = np.zeros(mesh.size), mesh.freedoms[name][e]
        if quantity in _CONJUGATE:
            load[freedoms] = mesh.element_matrices[name][0][e] @ jump.nodal
        elif quantity in _TURNED:
            turn = rotation_powers(mesh.h[e : e + 1], mesh.phi[name][e : e + 1])[0]
            psi = jump.place ** np.arange(4) @ turn @ mesh.shapes[name][e]
            load[freedoms] = _TURNED[quantity] * psi
        elif name in BENDING:
            load[freedoms] = jump.place ** np.arange(4) @ mesh.shapes[name][e]
        else:
            load[freedoms] = [1.0 - jump.place, 0.0, jump.place]
        return load

    def _inertia_on(self, jump: _Jump) -> tuple[np.ndarray, float]:
        """Return the work that inertia does on g less its interpolation, inside the element.

        The inertia of every mode, omega^2 m phi, shape (m,); and that of a unit vertical
        acceleration.
        """
        mesh, name, e, place = self.mesh, jump.field, jump.element, jump.place
        s = np.concatenate([place * (_POINTS + 1) / 2, place + (1.0 - place) * (_POINTS + 1) / 2])
        dx = mesh.h[e] * np.concatenate([place * _WEIGHTS, (1.0 - place) * _WEIGHTS]) / 2
        powers = s[:, None] ** np.arange(4)
        after = np.where(s > place, s - place, 0.0)[:, None] ** np.arange(4)
        after = after * (s > place)[:, None]
        motion = after @ jump.behind - powers @ jump.interpolated
        modal = (motion * dx) @ powers @ self._mass_times_shapes(name, e)
        rotary = self.beam.rotary_inertia(name)
        if rotary:
            turn = rotation_powers(mesh.h[e : e + 1], mesh.phi[name][e : e + 1])[0]
            rotation = after @ jump.rotation - powers @ (turn @ jump.interpolated)
            shape = self._mode_shapes(name, e)
            modal = modal + rotary * (rotation * dx) @ powers @ turn @ shape
        weight = self.beam.mass * float(motion @ dx) if name == "vertical" else 0.0
        return self._omega2 * modal, weight

    def _mass_times_shapes(self, name: str, element: int) -> np.ndarray:
        """Return mass times motion of every mode in a field's direction, shape (4, m).

        As powers of the local coordinate; of the axis' motion with the mass at the centroid.
        """
        beam, z = self.beam, self.beam.centroid_height
        if name == "vertical":
            return beam.mass * self._mode_shapes("vertical", element)
        sideways, twist = (self._mode_shapes(f, element) for f in ("lateral", "torsion"))
        if name == "lateral":
            return beam.mass * (sideways - z * twist)
        return (beam.polar_inertia + beam.mass * z**2) * twist - beam.mass * z * sideways

    def _mode_shapes(self, name: str, element: int) -> np.ndarray:
        """Return one field of all modes in an element, powers of the local coordinate (4, m)."""
        if name not in self.beam.fields:
            return np.zeros((4, 1))
        freedoms = self.mesh.freedoms[name][element]
        return self.mesh.shapes[name][element] @ self._vectors[freedoms]

    # ---- bearings

    def _reaction_line(self, quantity: str, support: float) -> Line | None:
        mesh, (name, place) = self.mesh, _LINE_MOTION[quantity]
        if name not in self.beam.fields or not self._is_held(quantity, support):
            return None
        ground = np.zeros(mesh.size)
        ground[6 * mesh.nodes_at(support) + place] = 1.0
        # With the ground of the whole line springs are not stretched by the motion of its nodes.
        moved = mesh.solve(mesh.matrices[0] @ ground) - ground
        return self._line(moved, mesh.interpolate(moved))

    def _is_held(self, quantity: str, support: float) -> bool:
        """Whether a bearing at `support` (m) takes part in a reaction about the deck axis."""
        bearings = [b for b in self.beam.bearings if abs(b.x - support) < 1e-9 * self.beam.length]
        if quantity != "moment_x":
            return any(_FREEDOM_OF[quantity] in b.restrained for b in bearings)
        # A couple about the axis is also held by forces beside it or below it.
        return any(
            "roll" in b.restrained
            or ("z" in b.restrained and b.y != 0.0)
            or ("y" in b.restrained and b.z != 0.0)
            for b in bearings
        )

    def _bearing_line(self, index: int, freedom: str) -> Line | None:
        mesh, bearing = self.mesh, self.beam.bearings[index]
        row = mesh.bearing_row(index, freedom)
        if freedom not in bearing.restrained or not np.any(row):
            return None
        node, load = mesh.bearing_nodes[index], np.zeros(mesh.size)
        freedoms = slice(6 * node, 6 * node + 6)
        if freedom in bearing.springs:
            load[freedoms] = bearing.springs[freedom] * row
            moved = -mesh.solve(load)
        else:
            rigid, rows = mesh.rigid_rows(node)
            ground = np.zeros(mesh.size)
            ground[freedoms] = np.linalg.pinv(rows)[:, rigid.index((index, freedom))]
            moved = mesh.solve(mesh.stiffness @ ground) - ground
        return self._line(moved, mesh.interpolate(moved))

    # ---- modal values

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Nodal loads of the modes' own inertia, omega^2 M phi, shape (freedoms, m + 1).

        The last column is that of a unit vertical acceleration.
        """
        mesh = self.mesh
        lifted = np.zeros(mesh.size)
        lifted[2 : 6 * len(mesh.nodes) : 6] = 1.0
        return mesh.matrices[1] @ np.column_stack([self._vectors * self._omega2, lifted])

    def _line(
        self,
        moved: np.ndarray,
        influence: PiecewiseCubic,
        modal: np.ndarray | float = 0.0,
        weight: float = 0.0,
    ) -> Line:
        """Attach modal values and self-weight to an influence line.

        The modal value is the static effect of a mode's own inertia load,
        S_m = omega^2 int line m phi dx.

        Parameters
        ----------
        moved : ndarray, shape (freedoms,)
            The influence line in nodal freedoms.
        influence : PiecewiseCubic
        modal, weight
            What nodal freedoms lack inside one element.
        """
        total = moved @ self._inertia
        return Line(total[:-1] + modal, influence, float(-G * (total[-1] + weight)))


def _with_jump(shape: PiecewiseCubic, jump: _Jump) -> PiecewiseCubic:
    """Cut an element in two at the section, and add g behind it."""
    e, place = jump.element, jump.place
    halves = []
    for start, length in ((0.0, place), (place, 1.0 - place)):
        # Powers of s = start + length t in powers of t.
        shifted = np.zeros((4, 4))
        for j in range(4):
            for k in range(j, 4):
                shifted[j, k] = comb(k, j) * start ** (k - j) * length**j
        halves.append(np.einsum("jk,knc->jnc", shifted, shape.coefficients[e]))
    component = SHAPE_FIELDS.index(jump.field)
    halves[1][:, 0, component] += jump.behind * (1.0 - place) ** np.arange(4)
    kept = [half for half, length in zip(halves, (place, 1.0 - place), strict=True) if length > 0.0]
    inner = []
    if len(kept) == 2:
        inner = [shape.edges[e] + place * (shape.edges[e + 1] - shape.edges[e])]
    edges = np.concatenate([shape.edges[: e + 1], inner, shape.edges[e + 1 :]])
    pieces = np.concatenate([shape.coefficients[:e], kept, shape.coefficients[e + 1 :]])
    return PiecewiseCubic(edges, pieces)
