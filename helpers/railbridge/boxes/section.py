"""Section properties from an outline, by the library `sectionproperties`.

It uses finite elements over the section.

Axes are those of the deck: y to the left, z up. An outline is a list of corners, in order, without
repeating the first.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import errors
from ..errors import InputError, brief

__all__ = ["SectionProperties", "refuse_crossing", "section_properties", "triangles_needed"]

MOST_TRIANGLES = 10_000
"""Of a section's mesh: ten seconds and up to 1 GB."""
MOST_CORNERS = 500


@dataclass(frozen=True)
class SectionProperties:
    """What a beam needs to know of its section.

    Attributes
    ----------
    area : float
        A, m2.
    second_moment_vertical, second_moment_lateral : float
        I_y (bending in the vertical plane) and I_z, about the centroid, m4.
    product_moment : float
        I_yz, m4; zero for a section that is its own mirror image.
    torsion_constant : float
        J of Saint-Venant, m4. Warping is free: wrong where the deck is short or a diaphragm keeps
        it plane.
    shear_area_lateral, shear_area_vertical : float
        m2, of Timoshenko's beam, from the energy of the shear stresses at the given Poisson ratio.
    centroid, shear_centre : tuple of (y, z)
        m, in the axes of the outline.
    """

    __repr__ = brief

    area: float
    second_moment_vertical: float
    second_moment_lateral: float
    product_moment: float
    torsion_constant: float
    shear_area_lateral: float
    shear_area_vertical: float
    centroid: tuple[float, float]
    shear_centre: tuple[float, float]

    def to_frame(self):
        """Return a pandas DataFrame with value and unit of each property."""
        import pandas as pd

        rows = {
            "area A": (self.area, "m2"),
            "second moment, vertical bending I_y": (self.second_moment_vertical, "m4"),
            "second moment, lateral bending I_z": (self.second_moment_lateral, "m4"),
            "torsion constant J": (self.torsion_constant, "m4"),
            "shear area, vertical": (self.shear_area_vertical, "m2"),
            "shear area, lateral": (self.shear_area_lateral, "m2"),
            "height of the centroid": (self.centroid[1], "m"),
            "height of the shear centre": (self.shear_centre[1], "m"),
        }
        return pd.DataFrame(rows, index=["value", "unit"]).T


def section_properties(
    outline: np.ndarray,
    holes: tuple[np.ndarray, ...] = (),
    poisson_ratio: float = 0.2,
    largest: float | None = None,
) -> SectionProperties:
    """Return the properties of a plane section.

    Parameters
    ----------
    outline : array_like, shape (n, 2)
        y and z of the corners, m.
    holes : tuple of array_like, shape (k, 2)
    poisson_ratio : float
        For the shear areas only.
    largest : float, optional
        m2, largest triangle of the mesh; default a 500th of the area: J of a box is then within 0.5
        %.

    Raises
    ------
    InputError
        Fewer than three corners, an outline that crosses itself, a hole that is not inside, or a
        missing package.

    Source: A, I by integration; J, shear areas and shear centre by the finite elements of
    `sectionproperties` (Pilkey 2002).
    """
    outline = _corners("outline", outline)
    holes = tuple(_corners(f"holes[{i}]", h) for i, h in enumerate(holes, start=1))
    ratio = errors.number("poisson_ratio", poisson_ratio, above=-1.0, most=0.5)
    try:
        from sectionproperties.analysis import Section
        from sectionproperties.pre import Geometry, Material
        from shapely import Polygon
    except ImportError:
        raise InputError(
            "section",
            None,
            "the package sectionproperties is missing",
            'Run: pip install -e ".[fem]"',
        ) from None
    whole = Polygon(outline)
    for i, hole in enumerate(holes, start=1):
        if not whole.contains_properly(Polygon(hole)):
            raise InputError(f"holes[{i}]", hole, "must lie inside the outline and not touch it")
    # A modulus of 1: the library's "modulus-weighted" results are then the plain ones.
    material = Material("unit", 1.0, ratio, 1.0, 1.0, "grey")
    geometry = Geometry(Polygon(outline, list(holes)), material)
    area = Polygon(outline, list(holes)).area
    largest = (
        area / 500
        if largest is None
        else errors.number("largest", largest, above=0.0, most=area, unit="m2")
    )
    _refuse_size(outline, holes, area / largest)
    geometry.create_mesh([largest])
    section = Section(geometry)
    section.calculate_geometric_properties()
    section.calculate_warping_properties()
    i_y, i_z, i_yz = section.get_eic()
    shear_y, shear_z = section.get_eas()
    return SectionProperties(
        area=float(section.get_ea()),
        second_moment_vertical=float(i_y),
        second_moment_lateral=float(i_z),
        product_moment=float(i_yz),
        torsion_constant=float(section.get_ej()),
        shear_area_lateral=float(shear_y),
        shear_area_vertical=float(shear_z),
        centroid=tuple(float(c) for c in section.get_c()),
        shear_centre=tuple(float(c) for c in section.get_sc()),
    )


def triangles_needed(outline: np.ndarray, holes: tuple[np.ndarray, ...] = ()) -> float:
    """Return about how many triangles of good shape fill a section, those of thin parts.

    A triangle in a plate is about as long as the plate is thick: their number is the integral of
    the reciprocal distance to what lies opposite, along all edges. Within a factor of 1.6 above
    what the mesher makes of box girders with plates from 0.2 mm to 0.2 m.
    """
    lines = (np.asarray(outline, dtype=float), *holes)
    start = np.concatenate(lines)
    end = np.concatenate([np.roll(line, -1, axis=0) for line in lines])
    along = end - start
    length = np.hypot(*along.T)
    share = (np.arange(64) + 0.5) / 64
    count = 0.0
    for a, b, own in zip(start, end, length, strict=True):
        # The edges before and after meet this one: a corner is not a thin place.
        others = ~np.any(
            [np.all(p == q, axis=1) for p in (a, b) for q in (start, end)], axis=0
        )  # fmt: skip
        if not others.any():
            continue
        points = a + share[:, None] * (b - a)
        there = points[:, None] - start[others]
        foot = np.sum(there * along[others], axis=2) / length[others] ** 2
        apart = there - np.clip(foot, 0.0, 1.0)[..., None] * along[others]
        nearest = np.hypot(apart[..., 0], apart[..., 1]).min(axis=1)
        count += own * float(np.mean(1.0 / np.maximum(nearest, 1e-300)))
    return count


def _refuse_size(outline: np.ndarray, holes: tuple[np.ndarray, ...], asked: float) -> None:
    """Refuse a mesh that would take minutes and all memory, before it is made."""
    if asked > MOST_TRIANGLES:
        allowed = f"asks for about {asked:.2g} triangles, must be at most {MOST_TRIANGLES}"
        raise InputError("largest", None, allowed, "Leave it out to have it chosen")
    needed = triangles_needed(outline, holes)
    if needed > MOST_TRIANGLES:
        allowed = f"has parts so thin that about {needed:.2g} triangles would be needed"
        allowed += f", must be at most {MOST_TRIANGLES}"
        raise InputError("outline", None, allowed, "Is a thickness in the wrong unit?")


def _corners(field: str, corners) -> np.ndarray:
    """Return corners as an array after checks."""
    try:
        result = np.asarray(corners, dtype=float)
    except (TypeError, ValueError):
        result = np.empty(0)
    if (
        result.ndim != 2
        or result.shape[1:] != (2,)
        or len(result) < 3
        or not np.isfinite(result).all()
    ):
        raise InputError(field, corners, "must list at least three corners (y, z) in m")
    if len(result) > MOST_CORNERS:
        allowed = f"must list at most {MOST_CORNERS} corners"
        raise InputError(field, len(result), allowed, "Fewer show a curve just as well")
    refuse_crossing(field, result)
    return result


def refuse_crossing(field: str, outline: np.ndarray) -> None:
    """Raise `InputError` if an outline crosses or touches itself, or encloses nothing."""
    a, b = outline, np.roll(outline, -1, axis=0)
    count = len(outline)
    for i in range(count):
        if np.allclose(a[i], b[i], rtol=0.0, atol=1e-12):
            raise InputError(
                field, outline[i], "corner is given twice in a row", "Remove one of them"
            )
        for j in range(i + 2, count if i else count - 1):
            if _cross(a[i], b[i], a[j], b[j]):
                raise InputError(
                    field, [outline[i].tolist(), outline[j].tolist()],
                    "the edges that start at these corners "
                        "cross",
                    "Give the corners in order, round the section once",
                )  # fmt: skip
    y, z = outline.T
    if abs(y @ np.roll(z, -1) - z @ np.roll(y, -1)) / 2 < 1e-12:
        raise InputError(field, outline, "encloses no area")


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    """Whether the closed lines ab and cd have a point in common."""

    def side(p, q, r) -> float:
        value = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        return 0.0 if abs(value) < 1e-12 else np.sign(value)

    def between(p, q, r) -> bool:
        return bool(np.all(np.minimum(p, q) - 1e-12 <= r) and np.all(r <= np.maximum(p, q) + 1e-12))

    s = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    if s[0] * s[1] < 0 and s[2] * s[3] < 0:
        return True
    ends = ((s[0], a, b, c), (s[1], a, b, d), (s[2], c, d, a), (s[3], c, d, b))
    return any(value == 0 and between(p, q, r) for value, p, q, r in ends)
