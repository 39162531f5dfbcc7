r"""Static influence lines of a beam, and the modal values of its outputs.

By Mueller-Breslau: the influence line of a section force is the deflected shape under a unit jump
of the conjugate displacement, that of a bearing's force the shape under a unit displacement of the
ground below it, its sign turned; that of a displacement is the shape under a unit load there. All
are exact at any load position and for any section: inside an element the jump's own function g (a
step, a kink, or the shape of a point load) is added to the elements' shape and its interpolation
taken off, so no section needs a mesh of its own.

A distance t behind a point load ``g = t^3 / (6 E I) - t / kGA``: the kink of w by 1 / kGA is the
jump of the shear strain, while psi stays smooth.
"""

from __future__ import annotations

from functools import cached_property
from math import comb

import numpy as np

from .. import errors
from ..decks import BEARING_QUANTITIES, REACTION_QUANTITIES, SECTION_QUANTITIES, Line
from ..guideways import PiecewiseCubic
from ..units import G
from .elements import BENDING, rotation_powers
from .mesh import Mesh

__all__ = ["BeamRecovery"]

_CONJUGATE = {
    # quantity: field, derivative that jumps, sign
    "moment_vertical": ("vertical", 1, -1.0),
    "moment_lateral": ("lateral", 1, 1.0),
    "torsion": ("torsion", 0, 1.0),
    "shear_vertical": ("vertical", 0, 1.0),
    "shear_lateral": ("lateral", 0, 1.0),
}
_FIELD_OF = {"displacement_y": "lateral", "displacement_z": "vertical", "rotation_x": "torsion"}
_HELD_BY = dict(zip(BEARING_QUANTITIES, ("x", "y", "z", "roll", "pitch", "yaw"), strict=True))
_LINE_MOTION = {
    "force_x": ("axial", 0),
    "force_y": ("lateral", 1),
    "force_z": ("vertical", 2),
    "moment_x": ("torsion", 3),
}
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(5)


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
        """Return the line of a displacement or section force at x (m).

        At an inner bearing the face just before it.
        """
        errors.choice("quantity", quantity, SECTION_QUANTITIES)
        x = errors.number(
            "x", x, least=0.0, most=self.beam.length, unit="m", remedy="x runs along the deck"
        )
        return self._cached((quantity, float(x)), self._section, quantity, x)

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return the line of a reaction on the deck at the bearing line `support` (m).

        All bearings there, about the axis.
        """
        errors.choice("quantity", quantity, REACTION_QUANTITIES)
        return self._cached((quantity, float(support), "line"), self._reaction, quantity, support)

    def bearing(self, number: int, quantity: str) -> Line | None:
        """Return the line of the force or moment of one bearing (from 1) on the deck.

        None where it holds no such freedom.

        Rigid bearings on one section that share a force which statics alone does not split, as two
        that both hold y, share it as equally stiff ones would.
        """
        errors.choice("quantity", quantity, BEARING_QUANTITIES)
        index = errors.integer("bearing", number, least=1, most=len(self.beam.bearings)) - 1
        return self._cached((quantity, index, "bearing"), self._bearing, index, _HELD_BY[quantity])

    def _cached(self, key: tuple, make, *arguments) -> Line | None:
        if key not in self._lines:
            self._lines[key] = make(*arguments)
        return self._lines[key]

    def _section(self, quantity: str, x: float) -> Line | None:
        name = _FIELD_OF.get(quantity) or _CONJUGATE[quantity][0]
        if name not in self.beam.fields:
            return None
        component = ("lateral", "vertical", "torsion").index(name)
        mesh = self.mesh
        e = max(int(np.searchsorted(mesh.edges, x - 1e-9 * self.beam.length)) - 1, 0)
        h = mesh.h[e]
        cut = float(np.clip((x - mesh.edges[e]) / h, 0.0, 1.0))
        jump, turn = self._jump(quantity, name, h)
        # Values of g and of its rotation at the element's end; the interpolation runs through them.
        after = (1.0 - cut) ** np.arange(4)
        end = jump @ after
        nodal = np.array([0.0, 0.0, end, turn @ after] if name in BENDING else [0.0, end / 2, end])
        load, dofs = np.zeros(mesh.size), mesh.freedoms[name][e]
        if quantity in _CONJUGATE:
            load[dofs] = mesh.fields[name][0][e] @ nodal
        elif name in BENDING:
            load[dofs] = cut ** np.arange(4) @ mesh.shape_matrix(name, e)
        else:
            load[dofs] = [1.0 - cut, 0.0, cut]
        moved = mesh.solve(load)
        shape = mesh.interpolate(moved)
        taken_off = mesh.shape_matrix(name, e) @ nodal
        shape.coefficients[e, :, 0, component] -= taken_off
        modal, weight = self._own_inertia(name, e, cut, jump, turn, taken_off)
        return self._line(moved, _cut(shape, e, cut, component, jump), modal, weight)

    def _jump(self, quantity: str, name: str, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Return g and its rotation behind the section, as powers of (s - cut), each shape (4,)."""
        jump, turn = np.zeros((2, 4))
        if quantity in _CONJUGATE:
            _, order, sign = _CONJUGATE[quantity]
            jump[order] = sign * h**order
            turn[0] = sign * order
        elif name in BENDING:
            stiffness = self.beam.stiffness_of(name)
            jump[3] = h**3 / (6 * stiffness)
            jump[1] = -h * self.beam.shear_flexibility(name) / stiffness
            turn[2] = h**2 / (2 * stiffness)
        else:
            jump[1] = -h / self.beam.stiffness_of(name)
        return jump, turn

    def _reaction(self, quantity: str, support: float) -> Line | None:
        mesh, (name, place) = self.mesh, _LINE_MOTION[quantity]
        here = [b for b in self.beam.bearings if abs(b.x - support) < 1e-9 * self.beam.length]
        # A couple about the axis is also held by forces beside it or below it.
        holds = {
            "moment_x": lambda b: (
                "roll" in b.restrained
                or ("z" in b.restrained and b.y != 0.0)
                or ("y" in b.restrained and b.z != 0.0)
            )
        }
        if name not in self.beam.fields or not any(
            holds.get(quantity, lambda b: _HELD_BY[quantity] in b.restrained)(b) for b in here
        ):
            return None
        ground = np.zeros(mesh.size)
        ground[6 * mesh.line(support) + place] = 1.0
        # With the ground of the whole line springs are not stretched by the motion of its nodes.
        moved = mesh.solve(mesh.matrices[0] @ ground) - ground
        return self._line(moved, mesh.interpolate(moved))

    def _bearing(self, index: int, freedom: str) -> Line | None:
        mesh, bearing = self.mesh, self.beam.bearings[index]
        if freedom not in bearing.restrained or not np.any(mesh.row(index, freedom)):
            return None
        node, load = mesh.places[index], np.zeros(mesh.size)
        here = slice(6 * node, 6 * node + 6)
        if freedom in bearing.stiffness:
            load[here] = bearing.stiffness[freedom] * mesh.row(index, freedom)
            moved = -mesh.solve(load)
        else:
            keys, rows = mesh.rigid_rows(node)
            load[here] = np.linalg.pinv(rows)[:, keys.index((index, freedom))]
            moved = mesh.solve(mesh.stiffness @ load) - load
        return self._line(moved, mesh.interpolate(moved))

    @cached_property
    def _inertia(self) -> np.ndarray:
        """Nodal loads of the modes' own inertia, omega^2 M phi.

        The last are those of a unit vertical acceleration.
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
        """Attach the modal values.

        The static effect of each mode's own inertia load, S_m = omega^2 int line m phi dx.

        `moved` is the influence line in nodal freedoms; `modal` and `weight` add what it lacks
        inside one element.
        """
        total = moved @ self._inertia
        return Line(total[:-1] + modal, influence, float(-G * (total[-1] + weight)))

    def _own_inertia(
        self,
        name: str,
        e: int,
        cut: float,
        jump: np.ndarray,
        turn: np.ndarray,
        taken_off: np.ndarray,
    ) -> tuple[np.ndarray, float]:
        """Return the work of inertia on g less its interpolation in element e.

        For every mode, and last for a unit vertical acceleration.
        """
        beam, mesh = self.beam, self.mesh
        h = mesh.h[e]
        s = np.concatenate([cut * (_POINTS + 1) / 2, cut + (1.0 - cut) * (_POINTS + 1) / 2])
        dx = h * np.concatenate([cut * _WEIGHTS, (1.0 - cut) * _WEIGHTS]) / 2
        powers = s[:, None] ** np.arange(4)
        behind = np.where(s > cut, s - cut, 0.0)[:, None] ** np.arange(4) * (s > cut)[:, None]
        own = behind @ jump - powers @ taken_off

        def shape(other: str) -> np.ndarray:
            return (
                mesh.shape_matrix(other, e) @ self._vectors[mesh.freedoms[other][e]]
                if other in beam.fields
                else np.zeros((4, 1))
            )

        z = beam.centroid_height
        if name == "torsion":
            carried = (beam.polar_inertia + beam.mass * z**2) * shape(
                "torsion"
            ) - beam.mass * z * shape("lateral")
        elif name == "lateral":
            carried = beam.mass * (shape("lateral") - z * shape("torsion"))
        else:
            carried = beam.mass * shape("vertical")
        modal = (own * dx) @ powers @ carried
        if name in BENDING and beam.rotary_inertia(name):
            turned = rotation_powers(mesh.h[e : e + 1], mesh.phi[name][e : e + 1])[0]
            own_turn = behind @ turn - powers @ (turned @ taken_off)
            modal = modal + beam.rotary_inertia(name) * (own_turn * dx) @ powers @ turned @ shape(
                name
            )
        return self._omega2 * modal, beam.mass * float(own @ dx) if name == "vertical" else 0.0


def _cut(
    shape: PiecewiseCubic, e: int, cut: float, component: int, jump: np.ndarray
) -> PiecewiseCubic:
    """Cut element e at the local coordinate `cut`; add `jump`, powers of (s - cut), behind it."""
    halves = []
    for start, length in ((0.0, cut), (cut, 1.0 - cut)):
        # Powers of s = start + length t in powers of t.
        turn = np.array(
            [
                [comb(k, j) * start ** (k - j) * length**j if k >= j else 0.0 for k in range(4)]
                for j in range(4)
            ]
        )
        halves.append(np.einsum("jk,knc->jnc", turn, shape.coefficients[e]))
    halves[1][:, 0, component] += jump * (1.0 - cut) ** np.arange(4)
    kept = [half for half, length in zip(halves, (cut, 1.0 - cut), strict=True) if length > 0.0]
    inner = [shape.edges[e] + cut * (shape.edges[e + 1] - shape.edges[e])] if len(kept) == 2 else []
    edges = np.concatenate([shape.edges[: e + 1], inner, shape.edges[e + 1 :]])
    return PiecewiseCubic(
        edges, np.concatenate([shape.coefficients[:e], kept, shape.coefficients[e + 1 :]])
    )
