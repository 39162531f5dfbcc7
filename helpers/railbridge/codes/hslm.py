"""The high-speed load model of EN 1991-2, 6.4.6.1: trains of constant forces, A by rule, B by d.

It envelopes the effects of articulated, conventional and regular trains of international lines.
There is no suspension in it: bogie and car masses, springs and irregularities are not its matter.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .. import errors
from ..errors import InputError, Range
from ..trains import AxleTrain

__all__ = ["FORCES", "HSLM_A", "HSLM_B_FORCE", "SPACING", "hslm_a", "hslm_b"]

HSLM_A = {
    "A1": (18, 18.0, 2.0, 170e3), "A2": (17, 19.0, 3.5, 200e3), "A3": (16, 20.0, 2.0, 180e3),
    "A4": (15, 21.0, 3.0, 190e3), "A5": (14, 22.0, 2.0, 170e3), "A6": (13, 23.0, 2.0, 180e3),
    "A7": (13, 24.0, 2.0, 190e3), "A8": (12, 25.0, 2.5, 190e3), "A9": (11, 26.0, 2.0, 210e3),
    "A10": (11, 27.0, 2.0, 210e3),
}  # fmt: skip
"""Table 6.3: number of coaches N, coach length D (m), axle spacing of a bogie d (m), P (N)."""
HSLM_B_FORCE = 170e3
"""Every force of HSLM-B, N."""

_POWER_BOGIE, _POWER_PIVOTS = 3.0, 14.0
_BETWEEN_CARS = 3.525
"""m, Figure 6.12: axles in a power car's bogie and from its first bogie to its second, and from
its last axle to the first of the end coach.
"""

FORCES = Range(least=1, most=1000, whole=True)
SPACING = Range(above=0.0, most=1000.0, unit="m")
"""What N and d of HSLM-B may be; those of Figure 6.14 are far inside."""


def hslm_a(name: str) -> AxleTrain:
    """Return one of the ten trains HSLM-A of EN 1991-2, Figure 6.12 and Table 6.3.

    Two power cars, two end coaches and N coaches between, which share their bogies. The bogies of
    the power cars have axles 3 m apart, only those of the coaches d.

    Parameters
    ----------
    name : str
        ``A1`` to ``A10``.

    Returns
    -------
    AxleTrain
        2 N + 14 equal forces P; the first at 0, m and N.

    Raises
    ------
    InputError
        No such train.

    Notes
    -----
    The standard asks for HSLM-A on simple spans of 7 m and more and on continuous and complex
    structures, for HSLM-B below 7 m.
    """
    coaches, length, bogie, force = HSLM_A[errors.choice("name", errors.text("name", name), HSLM_A)]
    places = list(_places(coaches, length, bogie))
    return AxleTrain(places, [force] * len(places), f"HSLM-{name}")


def _places(coaches: int, length: float, bogie: float) -> Iterator[float]:
    """Yield where the axles stand, m behind the first; the rear mirrors the front."""
    power = (0.0, _POWER_BOGIE, _POWER_PIVOTS, _POWER_PIVOTS + _POWER_BOGIE)
    # Coaches are coupled midway between the last axle of the power car and their own first one.
    coupling = power[-1] + _BETWEEN_CARS / 2
    last = 2 * coupling + (coaches + 2) * length
    front = [*power, power[-1] + _BETWEEN_CARS, power[-1] + _BETWEEN_CARS + bogie]
    yield from front
    for i in range(1, coaches + 2):
        yield coupling + i * length - bogie / 2
        yield coupling + i * length + bogie / 2
    for place in reversed(front):
        yield last - place


def hslm_b(n: Any = None, d: Any = None) -> AxleTrain:
    """Return a train HSLM-B of EN 1991-2, 6.4.6.1.1: equal forces of 170 kN, equally spaced.

    Parameters
    ----------
    n : int
        Number of forces N, read from Figure 6.14 for the span.
    d : float
        Their spacing, m, read there too.

    Returns
    -------
    AxleTrain

    Raises
    ------
    InputError
        N or d left out: the suite does not have the figure, so there is no default.
    """
    for name, value, what in (("n", n, "number of forces"), ("d", d, "spacing of the forces (m)")):
        if value is None:
            remedy = f"Read the {what} from Figure 6.14 of EN 1991-2, at the span of the deck"
            raise InputError(name, None, "is missing, HSLM-B has no default for it", remedy)
    count, spacing = FORCES.checked("n", n), SPACING.checked("d", d)
    places = [spacing * i for i in range(count)]
    return AxleTrain(places, [HSLM_B_FORCE] * count, f"HSLM-B, {count} forces at {spacing:g} m")
