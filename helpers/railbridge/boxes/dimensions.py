"""Single-cell box girders as data: dimensions, pads under the webs, and the geometry they make.

Heights count from the underside of the box, y from its middle to the left. All dimensions are those
of the drawing: overall, not between middle planes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from .. import errors
from ..beams import checked_spans, on_deck, span_ends
from ..cautions import doubt, material, soft_bearing
from ..errors import InputError, InputWarning, Range, brief, check_fields, within
from ..units import G
from .pads import DIRECTIONS, STIFFEST
from .section import refuse_crossing

__all__ = ["BoxDimensions", "Pads"]

_Width = Annotated[float, Range(above=0.0, most=100.0, unit="m")]
_Thickness = Annotated[float, Range(least=1e-4, most=10.0, unit="m")]


@dataclass(frozen=True)
class Pads:
    """A bearing line: pads under the webs.

    Attributes
    ----------
    x : float
        m along the deck, from the first bearing line.
    fixed : tuple of str
        What each pad holds rigidly: some of x y z.
    stiffness : dict of float
        What each pad holds by springs in other directions, N/m.
    under : {"both", "left", "right"}
        Webs that stand on a pad.
    length : float
        Of a pad along the deck, m. Its width does not count: a web's foot is a line in the shell.
    drop : float
        m, how far below the underside of the box the bearing holds (its point of rotation).

    Raises
    ------
    InputError
        An unknown direction, one that is held twice, or a size out of range.
    """

    x: Annotated[float, Range(unit="m")]
    fixed: tuple[str, ...] = ("y", "z")
    stiffness: Mapping[str, float] = field(default_factory=dict, hash=False)
    under: Literal["both", "left", "right"] = "both"
    length: Annotated[float, Range(above=0.0, most=5.0, unit="m")] = 0.6
    drop: Annotated[float, Range(least=0.0, most=5.0, unit="m")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)
        if not isinstance(self.fixed, (list, tuple)):
            raise InputError("fixed", self.fixed, "must list some of " + " ".join(DIRECTIONS))
        for name in self.fixed:
            errors.choice("fixed", name, DIRECTIONS)
        for name, value in errors.table("stiffness", self.stiffness).items():
            errors.choice("stiffness", name, DIRECTIONS)
            errors.number(f"stiffness.{name}", value, above=0.0, most=STIFFEST, unit="N/m")
            if name in self.fixed:
                raise InputError(f"stiffness.{name}", value, "is fixed, too", "Give one of both")
        object.__setattr__(self, "fixed", tuple(self.fixed))

    @property
    def sides(self) -> tuple[int, ...]:
        """1 for the left web, -1 for the right one."""
        return {"both": (1, -1), "left": (1,), "right": (-1,)}[self.under]


@dataclass(frozen=True)
class BoxDimensions:
    """A single-cell box girder.

    Attributes
    ----------
    name : str
        For people.
    spans : tuple of float
        m, continuous.
    slab_width : float
        m.
    slab_thickness : float
        m, in the middle between the webs.
    depth : float
        Overall, m.
    web_thickness : float
        Square to the web, m.
    web_spacing : float
        Between the webs' middle planes at the slab, m.
    bottom_thickness : float
        m.
    youngs_modulus : float
        E, Pa.
    poisson_ratio : float
        nu.
    density : float
        kg/m3.
    bottom_spacing : float, optional
        Between the webs' middle planes at the bottom, m; default as at the slab (upright webs).
    root_thickness : float, optional
        Of the cantilevers at the webs, m; default slab_thickness. The slab is flat on top. Between
        the webs a root thicker than the slab runs out in a haunch.
    edge_thickness : float, optional
        Of the cantilevers at their edges, m, straight between; default slab_thickness.
    haunch_length : float, optional
        m, inwards from the webs' middle planes; default a quarter of their spacing.
    diaphragm_thickness : float or None
        m, of the plates across the box over every bearing line.
    inner_diaphragms : int
        Further plates in each span, equally spaced.
    inner_diaphragm_thickness : float, optional
        m; default diaphragm_thickness.
    overhang : float
        m, by which the deck reaches beyond its outer bearing lines; only the shell has it.
    track_mass : float
        Besides the concrete, between the webs (tracks), kg/m of deck.
    edge_mass : float
        Besides the concrete, on both edges together (parapets, cables), kg/m of deck.
    bearings : tuple of Pads
        Default: y and z held at every bearing line, x at the first, under both webs.
    tracks : dict of float
        m left of the axis.

    Raises
    ------
    InputError
        A thickness that is not positive, webs outside the slab, through each other or through the
        deck's height, a bottom wider than the slab, an outline that crosses itself, or bearings off
        the deck.
    """

    __repr__ = brief

    name: str
    spans: tuple[float, ...]
    slab_width: _Width
    slab_thickness: _Thickness
    depth: _Width
    web_thickness: _Thickness
    web_spacing: _Width
    bottom_thickness: _Thickness
    youngs_modulus: Annotated[float, Range(above=0.0, unit="Pa")]
    poisson_ratio: Annotated[float, Range(above=-1.0, most=0.49)] = 0.2
    density: Annotated[float, Range(above=0.0, unit="kg/m3")] = 2500.0
    bottom_spacing: _Width | None = None
    root_thickness: _Thickness | None = None
    edge_thickness: _Thickness | None = None
    haunch_length: Annotated[float, Range(above=0.0, unit="m")] | None = None
    diaphragm_thickness: _Thickness | None = 0.3
    inner_diaphragms: Annotated[int, Range(least=0, most=20, whole=True)] = 0
    inner_diaphragm_thickness: _Thickness | None = None
    overhang: Annotated[float, Range(least=0.0, unit="m")] = 0.3
    track_mass: Annotated[float, Range(least=0.0, unit="kg/m")] = 0.0
    edge_mass: Annotated[float, Range(least=0.0, unit="kg/m")] = 0.0
    bearings: tuple[Pads, ...] = ()
    tracks: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "spans", checked_spans(self.spans))
        check_fields(self)
        for key, default in (
            ("bottom_spacing", self.web_spacing),
            ("root_thickness", self.slab_thickness),
            ("edge_thickness", self.slab_thickness),
            ("haunch_length", self.web_spacing / 4),
            ("inner_diaphragm_thickness", self.diaphragm_thickness),
        ):
            if getattr(self, key) is None:
                object.__setattr__(self, key, default)
        if self.inner_diaphragms:
            remedy = "Give it, or no inner_diaphragms"
            thickness = self.inner_diaphragm_thickness
            limits = {"above": 0.0, "most": 10.0, "unit": "m", "remedy": remedy}
            errors.number("inner_diaphragm_thickness", thickness, **limits)
        errors.number("overhang", self.overhang, least=0.0, most=min(self.spans) / 2, unit="m")
        self._refuse_geometry()
        usual = [
            Pads(x, ("y", "z") if i else ("x", "y", "z")) for i, x in enumerate(self.span_ends)
        ]
        placed = []
        for i, pads in enumerate(self.bearings or usual, start=1):
            with within(f"bearings[{i}]"):
                placed.append(replace(pads, x=on_deck(pads.x, self.span_ends)))
        object.__setattr__(self, "bearings", tuple(placed))
        half = self.slab_width / 2
        for key, y in errors.table("tracks", self.tracks).items():
            errors.place(f"tracks.{key}", y, (-half, half))

    # ---- geometry

    @property
    def length(self) -> float:
        """Between the outer bearing lines, m."""
        return float(self.span_ends[-1])

    @cached_property
    def span_ends(self) -> np.ndarray:
        """Places where spans end, m, from 0."""
        return span_ends(self.spans)

    @property
    def head_thickness(self) -> float:
        """Of the slab just inside the webs, m."""
        return max(self.slab_thickness, self.root_thickness)

    @property
    def thinnest(self) -> tuple[str, float]:
        """Name and thickness (m) of the section's thinnest plate."""
        names = ("slab", "root", "edge", "web", "bottom")
        found = {f"{name}_thickness": getattr(self, f"{name}_thickness") for name in names}
        return min(found.items(), key=lambda item: item[1])

    @property
    def _lean(self) -> float:
        """How much a web moves outwards for each metre upwards."""
        rise = self.depth - self.head_thickness / 2 - self.bottom_thickness / 2
        return (self.web_spacing - self.bottom_spacing) / 2 / rise

    def web(self, z: float) -> float:
        """Return y of the left web's middle plane at height z, m."""
        return self.bottom_spacing / 2 + self._lean * (z - self.bottom_thickness / 2)

    @property
    def _half_web(self) -> float:
        """Half a web's thickness along y, m."""
        return self.web_thickness * float(np.hypot(1.0, self._lean)) / 2

    def _refuse_geometry(self) -> None:
        clear = self.depth - max(self.head_thickness, self.edge_thickness) - self.bottom_thickness
        if clear < 0.1:
            allowed = f"leaves {clear:.3g} m of height between slab and bottom, must leave 0.1 m"
            raise InputError(
                "depth", self.depth, allowed, "Make the box deeper or its plates thinner"
            )
        half = self._half_web
        if (
            min(self.web(self.depth - self.head_thickness), self.web(self.bottom_thickness)) - half
            < 0.05
        ):
            allowed, remedy = (
                "the webs run into each other",
                "Set them farther apart or make them thinner",
            )
            raise InputError("web_thickness", self.web_thickness, allowed, remedy)
        if (
            2 * max(self.web_spacing / 2, self.web(self.depth - self.root_thickness)) + 2 * half
            > self.slab_width + 1e-9
        ):
            allowed = f"the webs stand outside the slab, which is {self.slab_width:g} m wide"
            raise InputError(
                "web_spacing",
                self.web_spacing,
                allowed,
                "Make the slab wider or set the webs closer",
            )
        if 2 * self.web(0.0) + 2 * half > self.slab_width + 1e-9:
            allowed = f"makes the bottom wider than the slab, which is {self.slab_width:g} m wide"
            raise InputError(
                "bottom_spacing", self.bottom_spacing, allowed, "Lean the webs inwards"
            )
        if not self.haunch_length < self.web_spacing / 2:
            allowed = f"must be below half the web spacing, {self.web_spacing / 2:g} m"
            raise InputError("haunch_length", self.haunch_length, allowed)
        refuse_crossing("outline", self.outline)
        refuse_crossing("hole", self.hole)

    def thickness(self, y: np.ndarray) -> np.ndarray:
        """Return the slab's thickness (m) at y (m); at a web's middle plane the one inside."""
        y, web = np.abs(y), self.web_spacing / 2
        inside = np.interp(
            y, [web - self.haunch_length, web], [self.slab_thickness, self.root_thickness]
        )
        outside = np.interp(
            y, [web, self.slab_width / 2], [self.root_thickness, self.edge_thickness]
        )
        return np.where(y <= web, np.maximum(inside, self.slab_thickness), outside)

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners of the concrete, y and z, m, shape (n, 2)."""
        half = self._half_web
        under = self.web(self.depth - self.root_thickness) + half
        corners = [
            (self.slab_width / 2, self.depth),
            (self.slab_width / 2, self.depth - self.edge_thickness),
        ]
        if under < self.slab_width / 2 - 1e-6:
            corners.append(
                (under, self.depth - float(self.thickness(max(under, self.web_spacing / 2 + 1e-9))))
            )
        corners.append((self.web(0.0) + half, 0.0))
        return np.array(corners + [(-y, z) for y, z in reversed(corners)])

    @cached_property
    def hole(self) -> np.ndarray:
        """Corners of the cell, y and z, m, shape (n, 2)."""
        half = self._half_web
        top = self.web(self.depth - self.head_thickness) - half
        corners = [
            (self.web(self.bottom_thickness) - half, self.bottom_thickness),
            (top, self.depth - float(self.thickness(top))),
        ]
        knee = self.web_spacing / 2 - self.haunch_length
        if self.root_thickness > self.slab_thickness and knee < top - 1e-6:
            corners.append((knee, self.depth - self.slab_thickness))
        return np.array(corners + [(-y, z) for y, z in reversed(corners)])

    # ---- doubts

    @property
    def remarks(self) -> tuple[InputWarning, ...]:
        """What is unlikely to be meant, that a deck made of it does not show; `Deck.remarks`."""
        found = material(self.youngs_modulus, self.density)
        for name in ("track_mass", "edge_mass"):
            carried = getattr(self, name)
            if carried:
                found += doubt("track_mass", name, carried)
        held = sum(len(p.sides) for p in self.bearings if "z" in (*p.fixed, *p.stiffness))
        for i, line in enumerate(self.bearings, start=1):
            for direction, spring in line.stiffness.items():
                weight = self.mass_per_metre * self.length * G / max(held, 1)
                field = f"bearings[{i}].stiffness.{direction}"
                found += soft_bearing(field, direction, spring, weight)
        return tuple(found)

    # ---- mass

    @property
    def concrete_mass(self) -> float:
        """kg/m."""
        return self.density * (_area(self.outline) - _area(self.hole))

    @property
    def inner_diaphragm_mass(self) -> float:
        """All inner diaphragms, spread over the length, kg/m."""
        count = self.inner_diaphragms * len(self.spans)
        return (
            self.density * _area(self.hole) * self.inner_diaphragm_thickness * count / self.length
            if count
            else 0.0
        )

    @property
    def mass_per_metre(self) -> float:
        """Concrete with inner diaphragms spread over it, and what it carries, kg/m.

        Those over bearings load no span.
        """
        return self.concrete_mass + self.inner_diaphragm_mass + self.track_mass + self.edge_mass


def _area(corners: np.ndarray) -> float:
    """Area inside a closed line of corners."""
    y, z = corners.T
    return abs(float(y @ np.roll(z, -1) - z @ np.roll(y, -1))) / 2
