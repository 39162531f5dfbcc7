"""Single-cell box girders: section, beam and shell from the same dimensions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ..beams import Beam, Bearing
from ..damping import Damping, checked_damping, damping_ratios
from ..decks import Deck
from ..errors import InputError, ResultWarning, brief
from .boxshell import BoxMesh, shell_of
from .dimensions import BoxDimensions
from .section import (
    MOST_TRIANGLES,
    SectionProperties,
    section_properties,
    triangles_needed,
)
from .shell import Shell

__all__ = ["Box"]


@dataclass(frozen=True)
class Box(BoxDimensions):  # noqa: D101
    # What its fields mean is written once, and read by whoever asks for help on a box.
    __doc__ = BoxDimensions.__doc__

    __repr__ = brief

    # ---- section and beam

    @cached_property
    def section(self) -> SectionProperties:
        """Properties of the concrete section, by finite elements over it; needs the extra `fem`.

        Raises
        ------
        InputError
            A plate too thin to be filled with triangles.
        """
        needed = triangles_needed(self.outline, (self.hole,))
        if needed > MOST_TRIANGLES:
            field, thickness = self.thinnest
            allowed = (
                f"is so thin that about {needed:.2g} triangles would be needed for the section"
            )
            remedy = "Give it in m, or use the shell"
            raise InputError(field, thickness, f"{allowed}, at most {MOST_TRIANGLES}", remedy)
        return section_properties(self.outline, (self.hole,), self.poisson_ratio)

    def beam(
        self,
        shear: bool = True,
        rotary_inertia: bool = True,
        clamped_in_plan: bool = False,
        **options: Any,
    ) -> Beam:
        """Return the beam of this box, its bearings where the pads are.

        Parameters
        ----------
        shear, rotary_inertia : bool
            Whether it gives way in shear, and whether turning sections have inertia.
        clamped_in_plan : bool
            Whether pads that hold lengthwise under both webs also hold its yaw. The sections of a
            beam stay plane, so they would clamp it; those of the box warp and let go, as its shell
            shows. By default the two are one in the middle.
        **options
            Further attributes of `Beam`.

        Notes
        -----
        The mass of tracks and edges is taken at the concrete's centroid, with its inertia about it.
        Overhangs, diaphragms, distortion of the cell and the cantilevers' own motion are left out:
        that is what the shell is for.
        """
        s, e = self.section, self.youngs_modulus
        g = e / (2 * (1 + self.poisson_ratio))
        lever = self.depth - self.slab_thickness / 2 - s.centroid[1]
        about_y = (
            self.density * s.second_moment_vertical + (self.track_mass + self.edge_mass) * lever**2
        )
        across = (
            self.track_mass * self.web_spacing**2 / 12 + self.edge_mass * (self.slab_width / 2) ** 2
        )
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
            given |= {
                "shear_stiffness_vertical": g * s.shear_area_vertical,
                "shear_stiffness_lateral": g * s.shear_area_lateral,
            }
        if rotary_inertia:
            given |= {"rotary_inertia_vertical": about_y, "rotary_inertia_lateral": about_z}
        return Beam(self.name, self.spans, **(given | options))

    def _beam_bearings(self, centre: float, clamped_in_plan: bool) -> tuple[Bearing, ...]:
        result = []
        for p in self.bearings:
            foot, z = self.bottom_spacing / 2, -p.drop - centre
            fixed, springs, lengthwise = (
                p.fixed,
                dict(p.stiffness),
                "x" in p.fixed or "x" in p.stiffness,
            )
            if lengthwise and p.under == "both" and not clamped_in_plan:
                fixed = tuple(f for f in p.fixed if f != "x")
                spring = springs.pop("x", None)
                middle = (
                    {"fixed": ("x",)}
                    if spring is None
                    else {"fixed": (), "stiffness": {"x": 2 * spring}}
                )
                result.append(Bearing(p.x, y=0.0, z=z, **middle))
            if fixed or springs:
                result += [Bearing(p.x, fixed, side * foot, z, dict(springs)) for side in p.sides]
        return tuple(result)

    def beam_deck(self, modes: int | None = None, damping: Damping = 0.0, **options: Any) -> Deck:
        """Return the modal deck of the beam, its rails on top of the slab.

        See `beam` for the options, `Beam.deck` for the damping.
        """
        height = self.depth - self.section.shear_centre[1]
        made = self.beam(**options).deck(modes, damping, dict(self.tracks), self.slab_width, height)
        # What follows from dimensions is doubted there.
        kept = [
            remark
            for remark in made.remarks
            if isinstance(remark, ResultWarning) or remark.field.startswith("point_masses")
        ]
        return replace(made, remarks=(*self.remarks, *kept))

    # ---- shell

    def shell(self, mesh: BoxMesh | None = None) -> Shell:
        """Return the shell of this box; see `boxshell.shell_of`."""
        return shell_of(self, mesh or BoxMesh())

    def shell_deck(
        self,
        modes: int | None = None,
        damping: Damping = 0.0,
        mesh: BoxMesh | None = None,
    ) -> Deck:
        """Return the modal deck of the shell.

        Its shapes are the motion of the line between the heads of the two webs, at the middle plane
        of the slab: lateral and vertical their mean, twist their difference. What rails over the
        webs feel; a wheel between the webs also bends the slab. Section forces and reactions are
        not recovered (`recovery` is None), and modes are not corrected statically. Fifteen modes a
        span if no number is given.
        """
        mesh = mesh or BoxMesh()
        damping = checked_damping(damping)
        shell = self.shell(mesh)
        result = shell.modes(15 * len(self.spans) if modes is None else modes)
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
            remarks=self.remarks,
        )

    def convergence(self, factors: tuple[float, ...] = (0.5, 1.0, 1.5, 2.0), modes: int = 15):
        """Return the shell's frequencies (Hz) on meshes of `factors` times the default.

        A pandas DataFrame; the pads stay where they are.
        """
        import pandas as pd

        columns = {}
        for factor in factors:
            mesh = BoxMesh().refined(factor)
            found = self.shell(mesh).modes(modes)
            columns[f"{mesh.along} x {mesh.web} x {mesh.slab} x {mesh.cantilever}"] = (
                found.frequencies_hz
            )
        return pd.DataFrame(columns, index=pd.RangeIndex(1, modes + 1, name="mode"))
