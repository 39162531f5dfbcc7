r"""Beams in three dimensions: elements, bearings, named modes; a way to make a `Deck`.

Deck files are read in `decks`. The elements themselves, their modes and influence lines are in `mesh`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from . import inputs
from .deck import Deck, rayleigh_ratio
from .inputs import InputError
from .mesh import FIELDS, BeamModes, BeamRecovery, Mesh

__all__ = ["FIXITIES", "Beam", "BeamModes", "Bearing"]

_SHORTEST = 1e-3
"""Shortest span or distance of bearings as a share of the length: the deck's lowest frequency then keeps five digits."""

FIXITIES = ("x", "y", "z", "roll", "pitch", "yaw")


def _where(name: str) -> str:
    return "deck" if name == "deck" else f"deck {name}"


@dataclass(frozen=True)
class Bearing:
    """A bearing line across the deck at x (m) and the freedoms it holds: a subset of x y z roll pitch yaw."""

    x: float
    fixed: tuple[str, ...] = ("y", "z", "roll")


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
        Number of elements, at least 2 between neighbouring bearings; default about 40, at least 12 a span.

    Raises
    ------
    InputError
        Spans, mass or stiffness not positive, a bearing off the deck or too close to another, or a beam that can move as a
        rigid body.
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
        where = _where(self.name)
        spans = inputs.numbers(f"{where}: spans", self.spans, above=0.0, unit="m")
        if not 1 <= len(spans) <= 30:
            raise InputError(f"{where}: spans", list(self.spans), "must hold 1 to 30 spans")
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
            slack = 1e-6 * self.length
            inputs.number(f"{here}: x", bearing.x, least=-slack, most=self.length + slack, unit="m")
            for f in bearing.fixed:
                inputs.choice(f"{here}: fixed", f, FIXITIES)
        object.__setattr__(self, "bearings", tuple(self._on_line(b) for b in self.bearings))
        self._refuse_close_lines(where)
        if self.elements is not None:
            inputs.integer(f"{where}: elements", self.elements, least=2, most=400)
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
        return tuple(f for f, s in zip(FIELDS, stiffness, strict=True) if s is not None)

    def _on_line(self, bearing: Bearing) -> Bearing:
        """Move a bearing that misses the end of a span by rounding only onto it, so that both are one node."""
        lines = np.concatenate([[0.0], np.cumsum(self.spans)])
        nearest = float(lines[np.argmin(np.abs(lines - bearing.x))])
        return replace(bearing, x=nearest) if abs(nearest - bearing.x) <= 1e-6 * self.length else bearing

    @cached_property
    def _lines(self) -> np.ndarray:
        """Ends of spans and bearings, m, ascending: places that must be nodes."""
        return np.unique(np.concatenate([[0.0], np.cumsum(self.spans), [b.x for b in self.bearings]]))

    def _refuse_close_lines(self, where: str) -> None:
        """Refuse spans and distances of bearings so short that round-off would spoil the modes of the whole deck."""
        places = sorted(b.x for b in self.bearings)
        if len(set(places)) < len(places):
            double = next(a for a, b in zip(places[:-1], places[1:], strict=True) if a == b)
            raise InputError(f"{where}: bearing: x", double, "is given to two bearing lines", "List all they hold in one of them")
        gaps = np.diff(self._lines)
        if gaps.min() < _SHORTEST * self.length:
            short = f"of {gaps.min():.3g} m behind x = {self._lines[np.argmin(gaps)]:g} m is too short, "
            short += f"must be at least {_SHORTEST:g} of the whole length"
            raise InputError(
                f"{where}: spans", list(self.spans), f"a span or distance of bearings {short}", "Merge the two lines"
            )

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
                    f"{_where(self.name)}: bearings",
                    [(b.x, " ".join(b.fixed)) for b in self.bearings],
                    f"do not keep the deck from {free}, so it is a mechanism",
                    "Hold one more freedom, or one more bearing line",
                )

    @cached_property
    def mesh(self) -> Mesh:
        """The finite-element mesh of modes and histories."""
        wanted = self.elements or 40
        nodes = [self._lines[:1]]
        for a, b in zip(self._lines[:-1], self._lines[1:], strict=True):
            share = (b - a) / self.length
            # Very short elements among long ones would cost the lowest modes their digits.
            least = 12 if self.elements is None and share > 0.01 else 2
            nodes.append(np.linspace(a, b, max(least, round(wanted * share)) + 1)[1:])
        return Mesh(self, np.concatenate(nodes))

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
        if np.isscalar(damping):
            inputs.number("deck.damping", damping, least=0.0)
        else:
            damping = inputs.numbers("deck.damping", damping, count=2, least=0.0)
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
            recovery=BeamRecovery(self, kept),
            tracks=tracks or {},
            width=width,
            mass_per_metre=self.mass,
        )
