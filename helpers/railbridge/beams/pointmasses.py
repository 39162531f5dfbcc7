"""Masses at single places of a deck, as diaphragms, signal gantries or machines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..errors import Range, check_fields
from .bearings import FARTHEST, arm

__all__ = ["PointMass"]

_FROM_AXIS = Range(
    least=-FARTHEST, most=FARTHEST, unit="m", remedy="It is counted from the deck axis, in m"
)


@dataclass(frozen=True)
class PointMass:
    """A mass rigidly tied to the section at its place.

    It has inertia in every way its centre moves, and weight. Where the deck is rigid (no lateral or
    torsional stiffness) it adds nothing there.

    Attributes
    ----------
    x : float
        m along the deck.
    mass : float
        kg.
    y : float
        Of its centre, m left of the deck axis.
    z : float
        Of its centre, m above the deck axis.
    roll_inertia : float
        About the x axis through its own centre, kg m2.
    """

    x: Annotated[float, Range(unit="m")]
    mass: Annotated[float, Range(above=0.0, unit="kg")]
    y: Annotated[float, _FROM_AXIS] = 0.0
    z: Annotated[float, _FROM_AXIS] = 0.0
    roll_inertia: Annotated[float, Range(least=0.0, unit="kg m2")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)

    def parts(self, centroid: float = 0.0) -> list[tuple[float, np.ndarray]]:
        """Return its inertias and the motions they belong to, as rows of a node's freedoms.

        Along x, y, z and in roll; each row has shape (6,). Their sum of ``inertia * row row^T`` is
        the mass matrix. Freedoms as in `Bearing.row`.
        """
        return [
            *((self.mass, arm(freedom, self.y, self.z, centroid)) for freedom in "xyz"),
            (self.roll_inertia, arm("roll", self.y, self.z, centroid)),
        ]
