"""Single-cell box girders from their dimensions: section, beam and shell from the same data.

A box is the table ``[box]`` of a deck file, with its spans, bearings and tracks. Heights count from the underside of the
box, y from its middle to the left. All dimensions are those of the drawing: overall, not between middle planes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from .. import errors
from ..beams.beam import Beam, Bearing, checked_spans
from ..beams.bearings import on_deck
from ..decks import Deck, checked_damping, damping_ratios
from ..errors import InputError
from .boxshell import BoxMesh, shell_of
from .pads import DIRECTIONS
from .section import SectionProperties, refuse_crossing, section_properties
from .shell import Shell

__all__ = ["Box", "BoxMesh", "Pads"]


@dataclass(frozen=True)
class Pads:
    """A bearing line: pads under the webs.

    Attributes
    ----------
    x : float
        m, from the first bearing line.
    fixed : tuple of str
        Directions held rigidly at each pad: a subset of x y z.
    stiffness : dict of float
        N/m of each pad, springs in other directions.
    under : {"both", "left", "right"}
        Webs that stand on a pad.
    length : float
        Of a pad along the deck, m. Its width does not count: a web's foot is a line in the shell.
    drop : float
        m, how far below the underside of the box the bearing holds (its point of rotation).
    """

    x: float
    fixed: tuple[str, ...] = ("y", "z")
    stiffness: dict[str, float] = field(default_factory=dict)
    under: str = "both"
    length: float = 0.6
    drop: float = 0.0

    def check(self, here: str) -> None:
        """Refuse unknown or doubly held directions and sizes out of range; `here` names the bearing line."""
        for name in self.fixed:
            errors.choice(f"{here}: fixed", name, DIRECTIONS)
        for name, value in errors.table(f"{here}: stiffness", self.stiffness).items():
            errors.choice(f"{here}: stiffness", name, DIRECTIONS)
            errors.number(f"{here}: stiffness.{name}", value, above=0.0, most=1e14, unit="N/m")
            if name in self.fixed:
                raise InputError(f"{here}: stiffness.{name}", value, "is fixed, too", "Give one of both")
        errors.choice(f"{here}: under", self.under, ("both", "left", "right"))
        errors.number(f"{here}: length", self.length, above=0.0, most=5.0, unit="m")
        errors.number(f"{here}: drop", self.drop, least=0.0, most=5.0, unit="m")

    @property
    def sides(self) -> tuple[int, ...]:
        """1 for the left web, -1 for the right one."""
        return {"both": (1, -1), "left": (1,), "right": (-1,)}[self.under]


@dataclass(frozen=True)
class Box:
    """A single-cell box girder.

    Attributes
    ----------
    name : str
    spans : tuple of float
        m, continuous.
    slab_width, slab_thickness : float
        m; thickness in the middle between the webs.
    depth : float
        Overall, m.
    web_thickness : float
        Square to the web, m.
    web_spacing : float
        Between the webs' middle planes at the slab, m.
    bottom_thickness : float
        m.
    youngs_modulus, poisson_ratio, density : float
        Pa, -, kg/m3.
    bottom_spacing : float, optional
        Between the webs' middle planes at the bottom, m; default as at the slab (upright webs).
    root_thickness, edge_thickness : float, optional
        Of the cantilevers at the webs and at their edges, m, straight between; default `slab_thickness`. The slab is flat
        on top. Between the webs a root thicker than the slab runs out in a haunch.
    haunch_length : float
        m, inwards from the webs' middle planes; default a quarter of their spacing.
    diaphragm_thickness : float or None
        m, of the plates across the box over every bearing line; None: there are none.
    inner_diaphragms : int
        Further plates in each span, equally spaced.
    inner_diaphragm_thickness : float, optional
        m; default `diaphragm_thickness`.
    overhang : float
        m, by which the deck reaches beyond its outer bearing lines; only the shell has it.
    track_mass, edge_mass : float
        Mass besides the concrete, kg/m of deck: between the webs (tracks), and on both edges together (parapets, cables).
    bearings : tuple of Pads
        Default: y and z held at every bearing line, x at the first, under both webs.
    tracks : dict of float
        m left of the axis.

    Raises
    ------
    InputError
        A thickness that is not positive, webs outside the slab, through each other or through the deck's height, a bottom
        wider than the slab, an outline that crosses itself, or bearings off the deck.
    """

    name: str
    spans: tuple[float, ...]
    slab_width: float
    slab_thickness: float
    depth: float
    web_thickness: float
    web_spacing: float
    bottom_thickness: float
    youngs_modulus: float
    poisson_ratio: float = 0.2
    density: float = 2500.0
    bottom_spacing: float | None = None
    root_thickness: float | None = None
    edge_thickness: float | None = None
    haunch_length: float | None = None
    diaphragm_thickness: float | None = 0.3
    inner_diaphragms: int = 0
    inner_diaphragm_thickness: float | None = None
    overhang: float = 0.3
    track_mass: float = 0.0
    edge_mass: float = 0.0
    bearings: tuple[Pads, ...] = ()
    tracks: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        where = self.where
        object.__setattr__(self, "spans", checked_spans(where, self.spans))
        for key, default in (
            ("bottom_spacing", self.web_spacing),
            ("root_thickness", self.slab_thickness),
            ("edge_thickness", self.slab_thickness),
        ):
            if getattr(self, key) is None:
                object.__setattr__(self, key, default)
        for key in ("slab_width", "depth", "web_spacing", "bottom_spacing"):
            errors.number(f"{where}: {key}", getattr(self, key), above=0.0, most=100.0, unit="m")
        for key in ("slab_thickness", "web_thickness", "bottom_thickness", "root_thickness", "edge_thickness"):
            errors.number(f"{where}: {key}", getattr(self, key), above=0.0, most=10.0, unit="m")
        if self.haunch_length is None:
            object.__setattr__(self, "haunch_length", self.web_spacing / 4)
        errors.number(f"{where}: haunch_length", self.haunch_length, above=0.0, unit="m")
        if self.diaphragm_thickness is not None:
            remedy = "Leave diaphragms out by giving none"
            errors.number(
                f"{where}: diaphragm_thickness", self.diaphragm_thickness, above=0.0, most=10.0, unit="m", remedy=remedy
            )
        errors.integer(f"{where}: inner_diaphragms", self.inner_diaphragms, least=0, most=20)
        if self.inner_diaphragm_thickness is None:
            object.__setattr__(self, "inner_diaphragm_thickness", self.diaphragm_thickness)
        if self.inner_diaphragms:
            remedy = "Give it, or no inner_diaphragms"
            thickness = self.inner_diaphragm_thickness
            errors.number(f"{where}: inner_diaphragm_thickness", thickness, above=0.0, most=10.0, unit="m", remedy=remedy)
        errors.number(f"{where}: overhang", self.overhang, least=0.0, most=min(self.spans) / 2, unit="m")
        for key in ("track_mass", "edge_mass"):
            errors.number(f"{where}: {key}", getattr(self, key), least=0.0, unit="kg/m")
        errors.number(f"{where}: youngs_modulus", self.youngs_modulus, above=0.0, unit="Pa")
        errors.number(f"{where}: poisson_ratio", self.poisson_ratio, above=-1.0, most=0.49)
        errors.number(f"{where}: density", self.density, above=0.0, unit="kg/m3")
        self._refuse_geometry(where)
        held = self.bearings or [Pads(x, ("y", "z") if i else ("x", "y", "z")) for i, x in enumerate(self.span_ends.tolist())]
        named = [(f"{where}: bearing {i}", pads) for i, pads in enumerate(held, start=1)]
        for here, pads in named:
            pads.check(here)
        placed = tuple(replace(pads, x=on_deck(here, pads.x, self.span_ends)) for here, pads in named)
        object.__setattr__(self, "bearings", placed)
        for key, y in errors.table(f"{where}: tracks", self.tracks).items():
            errors.number(f"{where}: tracks.{key}", y, least=-self.slab_width / 2, most=self.slab_width / 2, unit="m")

    # ------------------------------------------------------------------ geometry

    @property
    def where(self) -> str:
        """The box as messages call it."""
        return f"box {self.name}"

    @property
    def length(self) -> float:
        """Between the outer bearing lines, m."""
        return float(sum(self.spans))

    @cached_property
    def span_ends(self) -> np.ndarray:
        """Places where spans end, m, from 0."""
        return np.concatenate([[0.0], np.cumsum(self.spans)])

    @property
    def head_thickness(self) -> float:
        """Of the slab just inside the webs, m."""
        return max(self.slab_thickness, self.root_thickness)

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

    def _refuse_geometry(self, where: str) -> None:
        clear = self.depth - max(self.head_thickness, self.edge_thickness) - self.bottom_thickness
        if clear < 0.1:
            allowed = f"leaves {clear:.3g} m of height between slab and bottom, must leave 0.1 m"
            raise InputError(f"{where}: depth", self.depth, allowed, "Make the box deeper or its plates thinner")
        half = self._half_web
        if min(self.web(self.depth - self.head_thickness), self.web(self.bottom_thickness)) - half < 0.05:
            allowed, remedy = "the webs run into each other", "Set them farther apart or make them thinner"
            raise InputError(f"{where}: web_thickness", self.web_thickness, allowed, remedy)
        if 2 * max(self.web_spacing / 2, self.web(self.depth - self.root_thickness)) + 2 * half > self.slab_width + 1e-9:
            allowed = f"the webs stand outside the slab, which is {self.slab_width:g} m wide"
            raise InputError(f"{where}: web_spacing", self.web_spacing, allowed, "Make the slab wider or set the webs closer")
        if 2 * self.web(0.0) + 2 * half > self.slab_width + 1e-9:
            allowed = f"makes the bottom wider than the slab, which is {self.slab_width:g} m wide"
            raise InputError(f"{where}: bottom_spacing", self.bottom_spacing, allowed, "Lean the webs inwards")
        if not self.haunch_length < self.web_spacing / 2:
            allowed = f"must be below half the web spacing, {self.web_spacing / 2:g} m"
            raise InputError(f"{where}: haunch_length", self.haunch_length, allowed)
        refuse_crossing(f"{where}: outline", self.outline)
        refuse_crossing(f"{where}: hole", self.hole)

    def thickness(self, y: np.ndarray) -> np.ndarray:
        """Return the slab's thickness (m) at y (m); at a web's middle plane the one inside."""
        y, web = np.abs(y), self.web_spacing / 2
        inside = np.interp(y, [web - self.haunch_length, web], [self.slab_thickness, self.root_thickness])
        outside = np.interp(y, [web, self.slab_width / 2], [self.root_thickness, self.edge_thickness])
        return np.where(y <= web, np.maximum(inside, self.slab_thickness), outside)

    @cached_property
    def outline(self) -> np.ndarray:
        """Corners of the concrete, y and z, m, shape (n, 2)."""
        half = self._half_web
        under = self.web(self.depth - self.root_thickness) + half
        corners = [(self.slab_width / 2, self.depth), (self.slab_width / 2, self.depth - self.edge_thickness)]
        if under < self.slab_width / 2 - 1e-6:
            corners.append((under, self.depth - float(self.thickness(max(under, self.web_spacing / 2 + 1e-9)))))
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

    # ------------------------------------------------------------------ section and beam

    @cached_property
    def section(self) -> SectionProperties:
        """Properties of the concrete section, by finite elements over it; needs the extra `fem`."""
        return section_properties(self.outline, (self.hole,), self.poisson_ratio)

    @property
    def concrete_mass(self) -> float:
        """kg/m."""
        return self.density * (_area(self.outline) - _area(self.hole))

    @property
    def inner_diaphragm_mass(self) -> float:
        """All inner diaphragms, spread over the length, kg/m."""
        count = self.inner_diaphragms * len(self.spans)
        return self.density * _area(self.hole) * self.inner_diaphragm_thickness * count / self.length if count else 0.0

    @property
    def mass_per_metre(self) -> float:
        """Concrete with inner diaphragms spread over it, and what it carries, kg/m. Those over bearings load no span."""
        return self.concrete_mass + self.inner_diaphragm_mass + self.track_mass + self.edge_mass

    def beam(self, shear: bool = True, rotary_inertia: bool = True, clamped_in_plan: bool = False, **options: Any) -> Beam:
        """Return the beam of this box, its bearings where the pads are.

        Parameters
        ----------
        shear, rotary_inertia : bool
            Whether it gives way in shear, and whether turning sections have inertia.
        clamped_in_plan : bool
            Whether pads that hold lengthwise under both webs also hold its yaw. The sections of a beam stay plane, so they
            would clamp it; those of the box warp and let go, as its shell shows. By default the two are one in the middle.
        **options
            Further attributes of `Beam`.

        Notes
        -----
        The mass of tracks and edges is taken at the concrete's centroid, with its inertia about it. Overhangs, diaphragms,
        distortion of the cell and the cantilevers' own motion are left out: that is what the shell is for.
        """
        s, e = self.section, self.youngs_modulus
        g = e / (2 * (1 + self.poisson_ratio))
        lever = self.depth - self.slab_thickness / 2 - s.centroid[1]
        about_y = self.density * s.second_moment_vertical + (self.track_mass + self.edge_mass) * lever**2
        across = self.track_mass * self.web_spacing**2 / 12 + self.edge_mass * (self.slab_width / 2) ** 2
        about_z = self.density * s.second_moment_lateral + across
        given: dict[str, Any] = {
            "mass": self.mass_per_metre,
            "bending_stiffness_vertical": e * s.second_moment_vertical,
            "bending_stiffness_lateral": e * s.second_moment_lateral,
            "torsional_stiffness": g * s.torsion_constant,
            "axial_stiffness": e * s.area,
            "polar_inertia": about_y + about_z,
            "centroid_height": s.centroid[1] - s.shear_centre[1],
            "bearings": self._beam_bearings(s.shear_centre[1], clamped_in_plan),
        }
        if shear:
            given |= {"shear_stiffness_vertical": g * s.shear_area_vertical, "shear_stiffness_lateral": g * s.shear_area_lateral}
        if rotary_inertia:
            given |= {"rotary_inertia_vertical": about_y, "rotary_inertia_lateral": about_z}
        return Beam(self.name, self.spans, **(given | options))

    def _beam_bearings(self, centre: float, clamped_in_plan: bool) -> tuple[Bearing, ...]:
        result = []
        for p in self.bearings:
            foot, z = self.bottom_spacing / 2, -p.drop - centre
            fixed, springs, lengthwise = p.fixed, dict(p.stiffness), "x" in p.fixed or "x" in p.stiffness
            if lengthwise and p.under == "both" and not clamped_in_plan:
                fixed = tuple(f for f in p.fixed if f != "x")
                spring = springs.pop("x", None)
                middle = {"fixed": ("x",)} if spring is None else {"fixed": (), "stiffness": {"x": 2 * spring}}
                result.append(Bearing(p.x, y=0.0, z=z, **middle))
            if fixed or springs:
                result += [Bearing(p.x, fixed, side * foot, z, dict(springs)) for side in p.sides]
        return tuple(result)

    def beam_deck(self, modes: int = 20, damping: tuple[float, float] | float = 0.0, **switches: bool) -> Deck:
        """Return the modal deck of the beam, its rails on top of the slab; see `beam` for the switches."""
        height = self.depth - self.section.shear_centre[1]
        return self.beam(**switches).deck(modes, damping, dict(self.tracks), self.slab_width, height)

    # ------------------------------------------------------------------ shell

    def shell(self, mesh: BoxMesh | None = None) -> Shell:
        """Return the shell of this box; see `boxshell.shell_of`."""
        return shell_of(self, mesh or BoxMesh())

    def shell_deck(self, modes: int = 15, damping: tuple[float, float] | float = 0.0, mesh: BoxMesh | None = None) -> Deck:
        """Return the modal deck of the shell.

        Its shapes are the motion of the line between the heads of the two webs, at the middle plane of the slab: lateral and
        vertical their mean, twist their difference. What rails over the webs feel; a wheel between the webs also bends the
        slab. Section forces and reactions are not recovered (`recovery` is None), and modes are not corrected statically.
        """
        mesh = mesh or BoxMesh()
        damping = checked_damping(damping)
        shell = self.shell(mesh)
        result = shell.modes(modes)
        ratios = damping_ratios(damping, result.frequencies_hz)
        return Deck(
            name=self.name,
            length=self.length,
            frequencies_hz=result.frequencies_hz,
            damping_ratios=ratios,
            mode_names=result.names,
            shapes=shell.shapes(result.vectors, mesh.heads, 0.0, self.length),
            supports=tuple(sorted({p.x for p in self.bearings})),
            tracks=dict(self.tracks),
            width=self.slab_width,
            track_height=self.head_thickness / 2,
            mass_per_metre=self.mass_per_metre,
        )

    def convergence(self, factors: tuple[float, ...] = (0.5, 1.0, 1.5, 2.0), modes: int = 15):
        """Return a pandas DataFrame of the shell's frequencies (Hz) on meshes of `factors` times the default; pads stay."""
        import pandas as pd

        columns = {}
        for factor in factors:
            mesh = BoxMesh().refined(factor)
            found = self.shell(mesh).modes(modes)
            columns[f"{mesh.along} x {mesh.web} x {mesh.slab} x {mesh.cantilever}"] = found.frequencies_hz
        return pd.DataFrame(columns, index=pd.RangeIndex(1, modes + 1, name="mode"))


def _area(corners: np.ndarray) -> float:
    """Area inside a closed line of corners."""
    y, z = corners.T
    return abs(float(y @ np.roll(z, -1) - z @ np.roll(y, -1))) / 2
