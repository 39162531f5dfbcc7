r"""Beams in three dimensions: elements, bearings, named modes; a way to make a `Deck`.

Deck files are read in `decks`. The elements are in `elements`, their assembly and modes in `mesh`, influence lines in
`influence`, and what a bearing holds in `bearings`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from .. import errors
from ..decks import Deck, checked_damping, damping_ratios
from ..errors import InputError
from .bearings import FARTHEST, FIXITIES, Bearing, free_motions, on_deck
from .elements import FIELDS
from .influence import BeamRecovery
from .mesh import DENSE, BeamModes, Mesh

__all__ = ["FIXITIES", "Beam", "BeamModes", "Bearing", "checked_spans", "spans_of"]

_SHORTEST = 1e-3
"""Shortest span or distance of bearings as a share of the length: the deck's lowest frequency then keeps five digits."""


_SWITCHES = ("shear_stiffness_vertical", "shear_stiffness_lateral", "rotary_inertia_vertical", "rotary_inertia_lateral")


def spans_of(where: str, content: Mapping[str, Any]) -> Sequence[float]:
    """Return the spans of a deck file, told by ``spans`` or, where there is one, by ``length``; not yet checked by `Beam`."""
    if ("length" in content) == ("spans" in content):
        raise InputError(f"{where}: length", content.get("length"), "give either length or spans")
    if "spans" in content:
        return content["spans"]
    return [errors.number(f"{where}: length", content["length"], above=0.0, unit="m")]


def checked_spans(where: str, spans: Sequence[float]) -> tuple[float, ...]:
    """Return the lengths of 1 to 30 spans, m, refused where they are none; `where` names the deck."""
    found = errors.numbers(f"{where}: spans", spans, above=0.0, unit="m")
    if not 1 <= len(found) <= 30:
        raise InputError(f"{where}: spans", list(spans), "must hold 1 to 30 spans")
    return tuple(found.tolist())


def _where(name: str) -> str:
    return "deck" if name == "deck" else f"deck {name}"


@dataclass(frozen=True)
class Beam:
    """A uniform deck on bearings.

    Attributes
    ----------
    name : str
    spans : tuple of float
        m; bearing lines stand at their ends.
    mass : float
        kg/m.
    bending_stiffness_vertical : float
        E I_y, N m2.
    bending_stiffness_lateral, torsional_stiffness, axial_stiffness : float or None
        E I_z and G J (N m2), E A (N). None: rigid in that way.
    polar_inertia : float or None
        Mass moment of inertia about the axis per metre, kg m.
    bearings : tuple of Bearing
        Default: y, z and roll held at both ends of every span, x at its first (of a continuous deck: at the very first).
        Kept with one bearing under each span where simple spans meet.
    elements : int or None
        Number of elements, at least 2 between neighbouring bearings; default about 40, at least 12 a span.
    continuous : bool
        Whether the deck runs through over the inner bearing lines. False: a row of simple spans, each held by itself.
    shear_stiffness_vertical, shear_stiffness_lateral : float or None
        kGA, N. None: no shear flexibility (Euler-Bernoulli).
    rotary_inertia_vertical, rotary_inertia_lateral : float or None
        m r^2 of the section as it turns in vertical and in lateral bending, kg m. None: left out.
    centroid_height : float
        Centroid above the deck axis, which runs through the shear centres, m. Axial force and mass are there: the mass couples
        lateral bending and torsion. `polar_inertia` is that about the centroid.

    Raises
    ------
    InputError
        Spans, mass or stiffness not positive, a bearing off the deck, twice in one place or too close to another, one whose
        place makes the deck move in a way it has no stiffness for, or a beam that can move as a rigid body.
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
    continuous: bool = True
    shear_stiffness_vertical: float | None = None
    shear_stiffness_lateral: float | None = None
    rotary_inertia_vertical: float | None = None
    rotary_inertia_lateral: float | None = None
    centroid_height: float = 0.0

    def __post_init__(self) -> None:
        where = _where(self.name)
        object.__setattr__(self, "spans", checked_spans(where, self.spans))
        errors.number(f"{where}: mass", self.mass, above=0.0, unit="kg/m")
        errors.number(f"{where}: bending_stiffness_vertical", self.bending_stiffness_vertical, above=0.0, unit="N m2")
        for key in ("bending_stiffness_lateral", "torsional_stiffness", "axial_stiffness", "polar_inertia"):
            if getattr(self, key) is not None:
                errors.number(f"{where}: {key}", getattr(self, key), above=0.0)
        if (self.torsional_stiffness is None) != (self.polar_inertia is None):
            missing = "polar_inertia" if self.polar_inertia is None else "torsional_stiffness"
            raise InputError(f"{where}: {missing}", None, "is missing", "Twist needs torsional_stiffness and polar_inertia")
        for key in _SWITCHES:
            if getattr(self, key) is not None:
                errors.number(f"{where}: {key}", getattr(self, key), above=0.0)
                if key.endswith("lateral") and self.bending_stiffness_lateral is None:
                    raise InputError(f"{where}: bending_stiffness_lateral", None, "is missing", f"{key} goes with it")
        errors.number(f"{where}: centroid_height", self.centroid_height, least=-FARTHEST, most=FARTHEST, unit="m")
        if not isinstance(self.continuous, bool):
            raise InputError(f"{where}: continuous", self.continuous, "must be true or false")
        if not self.bearings:
            object.__setattr__(self, "bearings", self._usual_bearings())
        under: list[Bearing] = []
        for i, bearing in enumerate(self.bearings, start=1):
            here = f"{where}: bearing {i}"
            bearing = replace(bearing, x=on_deck(here, bearing.x, self._span_ends))
            bearing.check(here)
            self._refuse_missing_stiffness(here, bearing)
            under += self._under_spans(here, bearing)
        object.__setattr__(self, "bearings", tuple(under))
        self._refuse_close_lines(where)
        if self.elements is not None:
            errors.integer(f"{where}: elements", self.elements, least=2, most=400)
        self._refuse_mechanism(where)

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

    @property
    def joints(self) -> tuple[float, ...]:
        """Places where simple spans meet, m; none in a continuous deck."""
        return () if self.continuous else tuple(np.cumsum(self.spans)[:-1].tolist())

    def piece(self, bearing: Bearing) -> int:
        """Return which simple span (from 0) a bearing carries; 0 in a continuous deck."""
        return 0 if bearing.span is None else bearing.span - 1

    def stiffness_of(self, name: str) -> float:
        """Return the stiffness of a field: EA, E I_z, E I_y or G J."""
        return {
            "axial": self.axial_stiffness,
            "lateral": self.bending_stiffness_lateral,
            "vertical": self.bending_stiffness_vertical,
            "torsion": self.torsional_stiffness,
        }[name]

    def shear_flexibility(self, name: str) -> float:
        """Return E I / kGA of a bending field, m2; 0 where it is rigid in shear, and of the other fields."""
        shear = {"lateral": self.shear_stiffness_lateral, "vertical": self.shear_stiffness_vertical}.get(name)
        return 0.0 if shear is None else self.stiffness_of(name) / shear

    def rotary_inertia(self, name: str) -> float:
        """Return m r^2 of a bending field, kg m; 0 where it is left out, and of the other fields."""
        return {"lateral": self.rotary_inertia_lateral, "vertical": self.rotary_inertia_vertical}.get(name) or 0.0

    @cached_property
    def _span_ends(self) -> np.ndarray:
        return np.concatenate([[0.0], np.cumsum(self.spans)])

    def _usual_bearings(self) -> tuple[Bearing, ...]:
        usual, ends = ("y", "z", "roll"), self._span_ends.tolist()
        if self.continuous:
            return tuple(Bearing(x, (*usual, "x") if i == 0 else usual) for i, x in enumerate(ends))
        pairs = zip(ends[:-1], ends[1:], strict=True)
        return tuple(
            b for i, (a, e) in enumerate(pairs, 1) for b in (Bearing(a, (*usual, "x"), span=i), Bearing(e, usual, span=i))
        )

    def _under_spans(self, here: str, bearing: Bearing) -> list[Bearing]:
        """Put one bearing under each span where two meet."""
        if self.continuous:
            if bearing.span is not None:
                raise InputError(f"{here}: span", bearing.span, "can only be told of simple spans", "Or set continuous = false")
            return [bearing]
        reached = [i for i in range(1, len(self.spans) + 1) if self._span_ends[i - 1] <= bearing.x <= self._span_ends[i]]
        if bearing.span is not None and bearing.span not in reached:
            remedy = "Leave span out for one bearing under each span that meets there"
            raise InputError(f"{here}: span", bearing.span, f"must be {' or '.join(map(str, reached))}, at this x", remedy)
        return [replace(bearing, span=span) for span in ([bearing.span] if bearing.span else reached)]

    @cached_property
    def _lines(self) -> np.ndarray:
        """Ends of spans and bearings, m, ascending: places that must be nodes."""
        return np.unique(np.concatenate([self._span_ends, [b.x for b in self.bearings]]))

    def _refuse_missing_stiffness(self, here: str, bearing: Bearing) -> None:
        """Refuse a bearing that would hold the deck's turning only because the shift that goes with it is left out."""
        keys = {"x": ("axial", "axial_stiffness"), "y": ("lateral", "bending_stiffness_lateral")}
        turns = {"axial": (), "lateral": ("yaw",), "vertical": ("pitch",), "torsion": ("roll",)}
        turning = [t for name in self.fields for t in turns[name]]
        places = {"roll": 3, "yaw": 4, "pitch": 5}
        for freedom, (name, key) in keys.items():
            row = bearing.row(freedom, self.centroid_height)
            coupled = [t for t in turning if row[places[t]] != 0.0]
            if freedom in bearing.held and name not in self.fields and coupled:
                beside = f"is held beside the axis, which would also hold {' and '.join(coupled)} unless the deck gives that way"
                raise InputError(f"{here}: {freedom}", None, beside, f"Give {key}, or put the bearing into the axis")

    def _refuse_close_lines(self, where: str) -> None:
        """Refuse spans and distances of bearings so short that round-off would spoil the modes of the whole deck."""
        seen = set()
        for b in self.bearings:
            place = (b.x, round(b.y, 6), round(b.z, 6), self.piece(b))
            if place in seen:
                raise InputError(
                    f"{where}: bearing: x", b.x, "is given to two bearings in one place", "List all they hold in one"
                )
            seen.add(place)
        gaps = np.diff(self._lines)
        if gaps.min() < _SHORTEST * self.length:
            short = f"of {gaps.min():.3g} m behind x = {self._lines[np.argmin(gaps)]:g} m is too short, "
            short += f"must be at least {_SHORTEST:g} of the whole length"
            raise InputError(
                f"{where}: spans", list(self.spans), f"a span or distance of bearings {short}", "Merge the two lines"
            )

    def _refuse_mechanism(self, where: str) -> None:
        """Check that the bearings hold every rigid-body motion the beam, and each simple span, is free to make."""
        moving = {"x": "axial", "y": "lateral", "z": "vertical", "roll": "torsion", "pitch": "vertical", "yaw": "lateral"}
        orders = {"x": 1, "y": 3, "z": 3, "roll": 1, "pitch": 1, "yaw": 1}
        reference = {f: self.stiffness_of(name) / self.length ** orders[f] for f, name in moving.items() if name in self.fields}
        for piece in range(len(self.joints) + 1):
            own = [b for b in self.bearings if self.piece(b) == piece]
            free = free_motions(own, self.fields, self.length, self.centroid_height, reference)
            if free:
                what = "the deck" if self.continuous else f"span {piece + 1}"
                held = [(b.x, " ".join(b.held)) for b in own]
                allowed = f"do not keep {what} from {' or '.join(free)}, so it is a mechanism"
                raise InputError(f"{where}: bearings", held, allowed, "Hold one more freedom, or one more bearing line")

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
        track_height: float = 0.0,
    ) -> Deck:
        """Return the modal deck of the lowest modes that loads can excite (purely axial ones are left out).

        Parameters
        ----------
        modes : int
        damping : (alpha, beta) of Rayleigh, or one ratio for every mode
        tracks, width, track_height
            See `Deck`.
        """
        wanted = errors.integer("deck.modes", modes, least=1)
        damping = checked_damping(damping)
        found = self.modes if self.mesh.size <= DENSE else self.mesh.modes(wanted)
        excitable = np.flatnonzero(found.excitable).tolist()
        if wanted > len(excitable):
            raise InputError("deck.modes", modes, f"the mesh has {len(excitable)} modes that loads excite", "Use more elements")
        kept = excitable[:wanted]
        frequencies, vectors = found.frequencies_hz[kept], found.vectors[:, kept]
        ratios = damping_ratios(damping, frequencies)
        return Deck(
            name=self.name,
            length=self.length,
            frequencies_hz=frequencies,
            damping_ratios=ratios,
            mode_names=tuple(found.names[i] for i in kept),
            shapes=self.mesh.interpolate(vectors),
            supports=tuple(sorted({b.x for b in self.bearings})),
            bearings=tuple((b.x, b.y, b.z) for b in self.bearings),
            recovery=BeamRecovery(self, frequencies, vectors),
            tracks=tracks or {},
            width=width,
            track_height=track_height,
            mass_per_metre=self.mass,
        )
