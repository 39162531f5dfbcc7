"""A beam as data: spans, stiffnesses, mass and bearings, and what must hold between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated

import numpy as np

from .. import errors
from ..cautions import BOUNDS, doubt, material, soft_bearing
from ..errors import InputError, InputWarning, Range, brief, check_fields, within
from ..units import G
from .bearings import FARTHEST, Bearing, free_motions, on_deck
from .elements import FIELDS
from .pointmasses import PointMass

__all__ = ["BeamProperties", "Section", "checked_spans", "span_ends"]

_SHORTEST = 1e-3
"""Shortest span or distance of bearings as a share of the length.

The deck's lowest frequency then keeps five digits.
"""

MOST_MASSES = 200
"""Most point masses: each is a node of the mesh."""

_Rigidity = Annotated[float, Range(above=0.0, unit="N m2")]  # E I, G J
_Force = Annotated[float, Range(above=0.0, unit="N")]  # E A, kGA
_InertiaPerMetre = Annotated[float, Range(above=0.0, unit="kg m")]

_FIELD_OF = {
    "x": "axial", "y": "lateral", "z": "vertical",
    "roll": "torsion", "pitch": "vertical", "yaw": "lateral",
}  # fmt: skip
"""The field to which what a bearing holds belongs."""
_LENGTHS = {"x": 1, "y": 3, "z": 3, "roll": 1, "pitch": 1, "yaw": 1}
"""Power of a length that turns a field's stiffness into that of a spring in this direction."""


def checked_spans(spans: Sequence[float]) -> tuple[float, ...]:
    """Return the lengths of 1 to 30 spans, m, or refuse what are none."""
    found = errors.numbers("spans", spans, above=0.0, unit="m")
    if not 1 <= len(found) <= 30:
        raise InputError("spans", list(spans), "must hold 1 to 30 spans")
    return tuple(found.tolist())


def span_ends(spans: Sequence[float]) -> np.ndarray:
    """Return the places where spans end, m, from 0.

    Each sum is rounded once, so that 12.1, 12.2 and 12.3 m end at 36.6.
    """
    return np.array([math.fsum(spans[:count]) for count in range(len(spans) + 1)])


@dataclass(frozen=True)
class Section:
    """A beam's section and material.

    Attributes
    ----------
    youngs_modulus : float
        E, Pa.
    poisson_ratio : float
        nu.
    density : float
        kg/m3.
    area : float
        A, m2.
    second_moment_vertical : float
        I_y, m4: bending in the vertical plane.
    second_moment_lateral : float
        I_z, m4: bending sideways.
    torsion_constant : float
        J, m4.
    shear_area_vertical : float, optional
        kappa A for vertical shear, m2. Left out: rigid in shear.
    shear_area_lateral : float, optional
        kappa A for lateral shear, m2. Left out: rigid in shear.
    """

    youngs_modulus: Annotated[float, Range(above=0.0, unit="Pa")]
    poisson_ratio: Annotated[float, Range(above=-1.0, most=0.5)]
    density: Annotated[float, Range(above=0.0, unit="kg/m3")]
    area: Annotated[float, Range(above=0.0, unit="m2")]
    second_moment_vertical: Annotated[float, Range(above=0.0, unit="m4")]
    second_moment_lateral: Annotated[float, Range(above=0.0, unit="m4")]
    torsion_constant: Annotated[float, Range(above=0.0, unit="m4")]
    shear_area_vertical: Annotated[float, Range(above=0.0, unit="m2")] | None = None
    shear_area_lateral: Annotated[float, Range(above=0.0, unit="m2")] | None = None

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def remarks(self) -> tuple[InputWarning, ...]:
        """What is unlikely to be meant about the section, for `Deck.remarks`."""
        moments = self.second_moment_vertical, self.second_moment_lateral
        found = material(self.youngs_modulus, self.density)
        found += doubt("area", "area", self.area)
        found += doubt("second_moment", "second_moment_vertical", moments[0])
        found += doubt("second_moment", "second_moment_lateral", moments[1])
        if not found and self.torsion_constant > sum(moments):
            text = f"= {self.torsion_constant:g} m4 is more than I_y + I_z, which no section has: "
            found.append(InputWarning("torsion_constant", text + "given in another unit?"))
        for direction in ("vertical", "lateral"):
            shear = getattr(self, f"shear_area_{direction}")
            if not found and shear is not None and shear > self.area:
                text = f"= {shear:g} m2 is more than the area, {self.area:g} m2: given in cm2?"
                found.append(InputWarning(f"shear_area_{direction}", text))
        return tuple(found)

    def of_beam(self, rotary_inertia: bool = False) -> dict[str, float]:
        """Return what a `Beam` needs to know: mass, stiffnesses and inertias, SI, by its names.

        Parameters
        ----------
        rotary_inertia : bool
            Whether turning sections have inertia, density times second moments.
        """
        e = self.youngs_modulus
        shear_modulus = e / (2 * (1 + self.poisson_ratio))
        moments = {"vertical": self.second_moment_vertical, "lateral": self.second_moment_lateral}
        areas = {"vertical": self.shear_area_vertical, "lateral": self.shear_area_lateral}
        result = {
            "mass": self.density * self.area,
            "torsional_stiffness": shear_modulus * self.torsion_constant,
            "axial_stiffness": e * self.area,
            "polar_inertia": self.density * (moments["vertical"] + moments["lateral"]),
        }
        for direction, moment in moments.items():
            result[f"bending_stiffness_{direction}"] = e * moment
            if areas[direction] is not None:
                result[f"shear_stiffness_{direction}"] = shear_modulus * areas[direction]
            if rotary_inertia:
                result[f"rotary_inertia_{direction}"] = self.density * moment
        return result


@dataclass(frozen=True)
class BeamProperties:
    """A uniform deck on bearings.

    Attributes
    ----------
    name : str
        For people.
    spans : tuple of float
        Spans, m; bearing lines stand at their ends.
    mass : float
        kg/m.
    bending_stiffness_vertical : float
        E I_y, N m2: bending in the vertical plane.
    bending_stiffness_lateral : float, optional
        E I_z, N m2. Left out: rigid sideways, those results are null.
    torsional_stiffness : float, optional
        G J, N m2; needs polar_inertia. Left out: rigid in twist, those results are null.
    axial_stiffness : float, optional
        E A, N. Left out: rigid lengthwise.
    polar_inertia : float, optional
        Mass moment of inertia about the centroid, kg m2 per m.
    bearings : tuple of Bearing
        Default: y, z and roll held at both ends of every span, x at its first (of a continuous
        deck: at the very first). Kept with one bearing under each span where simple spans meet.
    elements : int, optional
        Number of finite elements, at least 2 between neighbouring bearings; default about 40, at
        least 12 a span.
    continuous : bool
        Whether several spans run through over the inner bearing lines; if not, they are simple
        spans in a row, each held by itself.
    shear_stiffness_vertical : float, optional
        kGA in the vertical plane, N. Left out: rigid in shear.
    shear_stiffness_lateral : float, optional
        kGA sideways, N. Left out: rigid in shear.
    rotary_inertia_vertical : float, optional
        m r^2 of the section turning in vertical bending, kg m. Left out: none.
    rotary_inertia_lateral : float, optional
        m r^2 of the section turning in lateral bending, kg m. Left out: none.
    centroid_height : float
        Centroid above the deck axis, which runs through the shear centres, m. Axial force and mass
        are there: the mass couples lateral bending and torsion.
    point_masses : tuple of PointMass
        Masses at single places, besides `mass`.

    Raises
    ------
    InputError
        Spans, mass or stiffness not positive, a bearing off the deck, twice in one place or too
        close to another, a point mass off the deck or where simple spans meet, a bearing whose
        place makes the deck move in a way it has no stiffness for, or a beam that can move as a
        rigid body.
    """

    __repr__ = brief

    name: str
    spans: Annotated[tuple[float, ...], Range(above=0.0, unit="m")]
    mass: Annotated[float, Range(above=0.0, unit="kg/m")]
    bending_stiffness_vertical: _Rigidity
    bending_stiffness_lateral: _Rigidity | None = None
    torsional_stiffness: _Rigidity | None = None
    axial_stiffness: _Force | None = None
    polar_inertia: _InertiaPerMetre | None = None
    bearings: tuple[Bearing, ...] = ()
    elements: Annotated[int, Range(least=2, most=400, whole=True)] | None = None
    continuous: bool = True
    shear_stiffness_vertical: _Force | None = None
    shear_stiffness_lateral: _Force | None = None
    rotary_inertia_vertical: _InertiaPerMetre | None = None
    rotary_inertia_lateral: _InertiaPerMetre | None = None
    centroid_height: Annotated[float, Range(least=-FARTHEST, most=FARTHEST, unit="m")] = 0.0
    point_masses: tuple[PointMass, ...] = ()

    def __post_init__(self) -> None:
        check_fields(self)
        checked_spans(self.spans)
        if (self.torsional_stiffness is None) != (self.polar_inertia is None):
            missing = "polar_inertia" if self.polar_inertia is None else "torsional_stiffness"
            remedy = "Twist needs torsional_stiffness and polar_inertia"
            raise InputError(missing, None, "is missing", remedy)
        for key in ("shear_stiffness_lateral", "rotary_inertia_lateral"):
            if getattr(self, key) is not None and self.bending_stiffness_lateral is None:
                remedy = f"{key} goes with it"
                raise InputError("bending_stiffness_lateral", None, "is missing", remedy)
        object.__setattr__(self, "bearings", self._placed_bearings())
        object.__setattr__(self, "point_masses", self._placed_masses())
        self._refuse_close_nodes()
        self._refuse_mechanism()

    @property
    def length(self) -> float:
        """Total length, m."""
        return float(self._span_ends[-1])

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
        return () if self.continuous else tuple(self._span_ends[1:-1].tolist())

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
        """Return E I / kGA of a bending field, m2.

        0 where it is rigid in shear, and of the other fields.
        """
        shear = {
            "lateral": self.shear_stiffness_lateral,
            "vertical": self.shear_stiffness_vertical,
        }.get(name)
        return 0.0 if shear is None else self.stiffness_of(name) / shear

    def rotary_inertia(self, name: str) -> float:
        """Return the rotary inertia of a bending field, m r^2, kg m.

        0 where it is left out, and of the other fields.
        """
        return {
            "lateral": self.rotary_inertia_lateral,
            "vertical": self.rotary_inertia_vertical,
        }.get(name) or 0.0

    @cached_property
    def required_nodes(self) -> np.ndarray:
        """Ends of spans and places of bearings, m, ascending: a mesh must have a node at each."""
        return np.unique(np.concatenate([self._span_ends, [b.x for b in self.bearings]]))

    @cached_property
    def _span_ends(self) -> np.ndarray:
        return span_ends(self.spans)

    @property
    def remarks(self) -> tuple[InputWarning, ...]:
        """What is unlikely to be meant, that a deck made of it does not show; `Deck.remarks`."""
        found = doubt("mass", "mass", self.mass)
        if found:  # the radii below follow from it
            return tuple(found)
        for name, bound in (
            ("polar_inertia", "polar_radius"),
            ("rotary_inertia_vertical", "bending_radius"),
            ("rotary_inertia_lateral", "polar_radius"),
        ):
            inertia = getattr(self, name)
            if inertia is not None:
                found += self._odd_radius(name, bound, inertia / self.mass, "t m")
        if self.axial_stiffness is not None:
            square = self.bending_stiffness_vertical / self.axial_stiffness
            found += self._odd_radius("axial_stiffness", "bending_radius", square, "kN")
        for name in ("vertical", "lateral"):
            found += self._odd_shear(name)
        found += doubt("height", "centroid_height", self.centroid_height)
        held = sum("z" in b.restrained for b in self.bearings)
        for i, bearing in enumerate(self.bearings, start=1):
            for direction, spring in bearing.stiffness.items():
                weight = self.mass * self.length * G / max(held, 1)
                field = f"bearings[{i}].stiffness.{direction}"
                found += soft_bearing(field, direction, spring, weight)
            found += doubt("height", f"bearings[{i}].z", bearing.z)
            if bearing.pier is not None:
                found += [r.moved(f"bearings[{i}].pier") for r in bearing.pier.remarks]
        for i, own in enumerate(self.point_masses, start=1):
            if not BOUNDS["point_mass"].holds(own.mass / (self.mass * self.length)):
                text = f"= {own.mass:g} kg is more than the deck's own "
                text += f"{self.mass * self.length:.3g} kg: given in g?"
                found.append(InputWarning(f"point_masses[{i}].mass", text))
            found += doubt("height", f"point_masses[{i}].z", own.z)
        return tuple(found)

    def _odd_radius(self, name: str, bound: str, square: float, unit: str) -> list[InputWarning]:
        """Doubt a value that gives a section an odd radius of gyration, squared (m2)."""
        radius, usual = float(np.sqrt(square)), BOUNDS[bound]
        # A section is not a third of its span deep.
        most = min(usual.high, max(self.spans) / 6) if name == "axial_stiffness" else usual.high
        if usual.low <= radius <= most:
            return []
        text = f"= {getattr(self, name):g} gives a radius of gyration of {radius:.3g} m, usual is "
        return [InputWarning(name, f"{text}{usual.range}: given in {unit}?")]

    def _odd_shear(self, name: str) -> list[InputWarning]:
        share = self.shear_flexibility(name) / max(self.spans) ** 2
        if share <= BOUNDS["shear_share"].high:
            return []
        field = f"shear_stiffness_{name}"
        text = f"= {getattr(self, field):g} N makes the deck give way in shear {share * 10:.2g} "
        return [InputWarning(field, text + "times as much as in bending: given in kN?")]

    def _placed_bearings(self) -> tuple[Bearing, ...]:
        """Return the given or usual bearings, one under each span where simple spans meet."""
        placed: dict[tuple, Bearing] = {}
        own = errors.instances("bearings", self.bearings, Bearing)
        for i, given in enumerate(own or self._usual_bearings(), start=1):
            with within(f"bearings[{i}]"):
                bearing = replace(given, x=on_deck(given.x, self._span_ends))
                self._refuse_missing_stiffness(bearing)
                for own in self._under_spans(bearing):
                    place = (own.x, round(own.y, 6), round(own.z, 6), self.piece(own))
                    if place in placed:
                        allowed = "is given to two bearings in one place"
                        raise InputError("x", own.x, allowed, "List all they hold in one")
                    placed[place] = own
        return tuple(placed.values())

    def _placed_masses(self) -> tuple[PointMass, ...]:
        """Return the point masses, what misses a bearing or end of a span by rounding put there."""
        own = errors.instances("point_masses", self.point_masses, PointMass)
        if len(own) > MOST_MASSES:
            allowed = f"must be at most {MOST_MASSES} masses"
            raise InputError("point_masses", len(own), allowed, "Spread them over the deck's mass")
        fixed, placed = self.required_nodes, []
        for i, mass in enumerate(own, start=1):
            with within(f"point_masses[{i}]"):
                x = on_deck(mass.x, fixed)
                if x in self.joints:
                    remedy = "Put it on one of the two spans, beside the joint"
                    raise InputError("x", x, "is where two simple spans meet", remedy)
                nearest = min([*fixed, *(m.x for m in placed)], key=lambda known: abs(known - x))
                if 0.0 < abs(nearest - x) < _SHORTEST * self.length:
                    allowed = f"is {abs(nearest - x):.3g} m beside another mass, bearing or end of "
                    allowed += f"a span, must be at least {_SHORTEST:g} of the whole length"
                    raise InputError("x", x, allowed, f"Put it at x = {nearest:g} m")
                placed.append(replace(mass, x=x))
        return tuple(placed)

    def _usual_bearings(self) -> tuple[Bearing, ...]:
        usual, ends = ("y", "z", "roll"), self._span_ends.tolist()
        if self.continuous:
            return tuple(Bearing(x, (*usual, "x") if i == 0 else usual) for i, x in enumerate(ends))
        bearings: list[Bearing] = []
        for span, (start, end) in enumerate(zip(ends[:-1], ends[1:], strict=True), start=1):
            bearings += [Bearing(start, (*usual, "x"), span=span), Bearing(end, usual, span=span)]
        return tuple(bearings)

    def _under_spans(self, bearing: Bearing) -> list[Bearing]:
        """Put one bearing under each span where two meet."""
        if self.continuous:
            if bearing.span is not None:
                allowed = "is only for simple spans"
                remedy = "Leave it out, or set continuous to false"
                raise InputError("span", bearing.span, allowed, remedy)
            return [bearing]
        starts, ends = self._span_ends[:-1], self._span_ends[1:]
        reached = np.flatnonzero((starts <= bearing.x) & (bearing.x <= ends)) + 1
        if bearing.span is None and bearing.pier is not None and len(reached) > 1:
            allowed = "is missing: two simple spans meet on this pier, whose motion would be one"
            remedy = "Give each span its own bearing and its share of the pier"
            raise InputError("span", None, allowed, remedy)
        if bearing.span is None:
            return [replace(bearing, span=span) for span in reached.tolist()]
        if bearing.span not in reached:
            allowed = f"must be {' or '.join(map(str, reached))}, at this x"
            remedy = "Leave span out for one bearing under each span that meets there"
            raise InputError("span", bearing.span, allowed, remedy)
        return [bearing]

    def _refuse_missing_stiffness(self, bearing: Bearing) -> None:
        """Refuse a bearing that would hold the deck's turning only because a shift is left out."""
        needed = {"x": "axial_stiffness", "y": "bending_stiffness_lateral"}
        turns = {"yaw": 4, "pitch": 5, "roll": 3}  # and where they stand in a bearing's row
        for shift, stiffness in needed.items():
            if shift not in bearing.restrained or _FIELD_OF[shift] in self.fields:
                continue
            row = bearing.row(shift, self.centroid_height)
            stopped = [t for t, i in turns.items() if _FIELD_OF[t] in self.fields and row[i] != 0.0]
            if stopped:
                spring = bearing.stiffness.get(shift)
                field = "fixed" if spring is None else f"stiffness.{shift}"
                allowed = f"holds {shift} off the deck axis, where a deck without {stiffness} "
                allowed += f"could not {' or '.join(stopped)}"
                remedy = f"Give {stiffness}, or put the bearing into the axis"
                raise InputError(field, spring or " ".join(bearing.fixed), allowed, remedy)

    def _refuse_close_nodes(self) -> None:
        """Refuse spans and distances of bearings so short that round-off would spoil the modes."""
        nodes = self.required_nodes
        gaps = np.diff(nodes)
        if gaps.min() < _SHORTEST * self.length:
            allowed = f"a span or distance of bearings of {gaps.min():.3g} m behind "
            allowed += f"x = {nodes[np.argmin(gaps)]:g} m is too short, "
            allowed += f"must be at least {_SHORTEST:g} of the whole length"
            raise InputError("spans", list(self.spans), allowed, "Merge the two lines")

    def _refuse_mechanism(self) -> None:
        """Check that the bearings hold all rigid-body motions of beam and simple spans."""
        reference = {
            freedom: self.stiffness_of(field) / self.length ** _LENGTHS[freedom]
            for freedom, field in _FIELD_OF.items()
            if field in self.fields
        }
        for piece in range(len(self.joints) + 1):
            own = [b for b in self.bearings if self.piece(b) == piece]
            free = free_motions(own, self.fields, self.length, self.centroid_height, reference)
            if free:
                what = "the deck" if self.continuous else f"span {piece + 1}"
                given = [(b.x, " ".join(b.restrained)) for b in own]
                allowed = f"do not keep {what} from {' or '.join(free)}, so it is a mechanism"
                remedy = "Hold one more freedom, or one more bearing line"
                raise InputError("bearings", given, allowed, remedy)
