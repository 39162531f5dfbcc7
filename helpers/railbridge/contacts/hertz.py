r"""Wheel on rail: how the small patch where they touch gives way, by Hertz's theory.

The wheel is a cylinder across the track, the rail head one along it. Two such crossed cylinders
touch in an ellipse, and their centres approach by d under the force P:

    P = C d^1.5,      dP/dd = 1.5 C^(2/3) P^(1/3).

Johnson, Contact Mechanics (1985), section 4.2, with ``A = 1 / (2 R_w)`` and ``B = 1 / (2 R_r)`` (or
the other way round: A is the smaller one), ``R_e = 1 / (2 sqrt(A B))`` and
``E* = E / (2 (1 - nu^2))`` for two bodies of one material. The ellipse of the half axes a > b and
the eccentricity e has ``B/A = [(a/b)^2 E(e) - K(e)] / [K(e) - E(e)]``. Written with Carlson's
integrals, which `scipy.special` has, nothing cancels where the ellipse is nearly a circle:

    K = R_F(0, q, 1),   K - E = e^2 R_D(0, q, 1) / 3,   (a/b)^2 E - K = e^2 R_D(0, 1, q) / 3,

with ``q = (b/a)^2 = 1 - e^2``. Wrong when the patch is not small against both radii (worn profiles
that fit each other, flange contact), or slides.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from .. import errors
from ..errors import Range, check_fields

__all__ = ["HertzContact"]

_FLATTEST = 1e-8
"""Smallest b/a looked for: radii a hundred million million times apart."""


@dataclass(frozen=True)
class HertzContact:
    """A wheel on a rail, both of one material.

    Attributes
    ----------
    wheel_radius : float
        R_w, of the rolling circle, m.
    rail_head_radius : float
        R_r, of the top of the rail's section, m; new rails have 0.2 to 0.3 m.
    contact_modulus : float
        E of wheel and rail, Pa.
    contact_poisson : float
        nu of wheel and rail.

    Raises
    ------
    InputError
        A radius outside 0.05 to 5 m, or a material outside its range.
    """

    wheel_radius: Annotated[float, Range(least=0.05, most=5.0, unit="m")] = 0.46
    rail_head_radius: Annotated[float, Range(least=0.05, most=5.0, unit="m")] = 0.3
    contact_modulus: Annotated[float, Range(least=1e9, most=1e12, unit="Pa")] = 210e9
    contact_poisson: Annotated[float, Range(least=0.0, most=0.499)] = 0.3

    def __post_init__(self) -> None:
        check_fields(self)

    @cached_property
    def axis_ratio(self) -> float:
        """b/a of the ellipse in which they touch, at most 1."""
        radii = sorted((self.wheel_radius, self.rail_head_radius))
        wanted = radii[1] / radii[0]

        def missed(log_ratio: float) -> float:
            q = np.exp(2.0 * log_ratio)
            return np.log(elliprd(0.0, 1.0, q) / elliprd(0.0, q, 1.0) / wanted)

        if wanted == 1.0:
            return 1.0
        return float(np.exp(brentq(missed, np.log(_FLATTEST), 0.0, xtol=1e-15, rtol=1e-14)))

    @cached_property
    def constant(self) -> float:
        """C, N/m^1.5."""
        k = self.axis_ratio
        curvatures = sorted(1 / (2 * r) for r in (self.wheel_radius, self.rail_head_radius))
        e_star = self.contact_modulus / (2 * (1 - self.contact_poisson**2))
        r_e = 1 / (2 * np.sqrt(curvatures[0] * curvatures[1]))
        integral = elliprd(0.0, k**2, 1.0) / 3  # (K - E) / e^2
        f1 = (4 / np.pi * k**1.5 * np.sqrt(curvatures[1] / curvatures[0]) * integral) ** (1 / 3)
        f2 = 2 / np.pi * np.sqrt(k) / f1 * elliprf(0.0, k**2, 1.0)
        return float(4 / 3 * e_star * np.sqrt(r_e) * f2**-1.5)

    @property
    def lateral_share(self) -> float:
        """Lateral stiffness of a contact that does not slip, over its vertical one.

        2 (1 - nu) / (2 - nu), Mindlin 1949, Journal of Applied Mechanics 16, 259-268. It holds for
        a circular patch and is taken for the ellipse, too.
        """
        return 2 * (1 - self.contact_poisson) / (2 - self.contact_poisson)

    def approach(self, load: float) -> float:
        """Return d, m, by which wheel and rail approach under a force P, N, at least 0."""
        return (errors.number("load", load, least=0.0, unit="N") / self.constant) ** (2 / 3)

    def stiffness(self, load: float) -> float:
        """Return the vertical stiffness dP/dd, N/m, at a force P, N.

        It grows with the third root of the force: twice the force, a quarter more.

        Raises
        ------
        InputError
            A force that is not above 0: what does not press has no contact.
        """
        load = errors.number("load", load, above=0.0, unit="N")
        return 1.5 * self.constant ** (2 / 3) * load ** (1 / 3)
