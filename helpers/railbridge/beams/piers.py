"""Piers below bearings as springs: elastic columns on rigid ground, free to turn at their heads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..cautions import BOUNDS, doubt
from ..errors import InputWarning, Range, check_fields

__all__ = ["Pier"]


@dataclass(frozen=True)
class Pier:
    """A pier below one bearing: springs E A / h upwards and 3 E I / h^3 along and across.

    It gives way under the shifts that the bearing holds; turns stay held as by the bearing itself.
    Its mass is left out, and so are its foundation and what its head turns. That is good far below
    the first frequency of the pier alone, ``0.56 sqrt(E I / (m h^4))`` Hz with m its mass per
    metre: 12 Hz for a concrete column of 2 by 2 m and 10 m height, a fourth of it for 20 m. Where
    that is near the frequencies of interest, model the pier in another program (`exchange`). Where
    several bearings stand on one pier, give each its share of area and second moments.

    Attributes
    ----------
    height : float
        h from the foundation to the bearing, m.
    youngs_modulus : float
        E, Pa.
    area : float
        A, m2.
    second_moment_along : float
        I of the pier bending along the deck (about the y axis), m4.
    second_moment_across : float
        I of the pier bending across the deck (about the x axis), m4.
    """

    height: Annotated[float, Range(above=0.0, unit="m")]
    youngs_modulus: Annotated[float, Range(above=0.0, unit="Pa")]
    area: Annotated[float, Range(above=0.0, unit="m2")]
    second_moment_along: Annotated[float, Range(above=0.0, unit="m4")]
    second_moment_across: Annotated[float, Range(above=0.0, unit="m4")]

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def stiffness(self) -> dict[str, float]:
        """Of its head along x, y and z, N/m."""
        sideways = 3 * self.youngs_modulus / self.height**3
        return {
            "x": sideways * self.second_moment_along,
            "y": sideways * self.second_moment_across,
            "z": self.youngs_modulus * self.area / self.height,
        }

    @property
    def remarks(self) -> tuple[InputWarning, ...]:
        """What is unlikely to be meant."""
        found = doubt("pier_height", "height", self.height)
        found += doubt("youngs_modulus", "youngs_modulus", self.youngs_modulus)
        found += doubt("area", "area", self.area)
        for name in ("second_moment_along", "second_moment_across"):
            found += doubt("second_moment", name, getattr(self, name))
        if found:
            return tuple(found)
        for name in ("second_moment_along", "second_moment_across"):
            radius, usual = (getattr(self, name) / self.area) ** 0.5, BOUNDS["pier_radius"]
            if not usual.holds(radius):
                text = f"= {getattr(self, name):g} m4 gives a radius of gyration of {radius:.3g} m"
                text += f", usual is {usual.range}: is its decimal point right?"
                found.append(InputWarning(name, text))
        return tuple(found)
