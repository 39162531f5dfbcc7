r"""Single faults of a rail: dips, joints and welds, once or at even distances.

They are irregularities like those of `tracks`: x from the bridge entrance, r > 0 raises the wheel,
so that a fault that lowers it has r < 0. Usual sizes stand in the Notes, with how sure they are:
by [two] sources, by [one], or [unchecked], which nobody should quote.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from .. import errors
from ..errors import InputError, Range, check_fields

__all__ = ["Dip", "Joint", "Weld"]

_LENGTH = Range(above=0.0, unit="m")
_DEPTH = Range(unit="m", most=0.1, least=-0.1, remedy="Give it in m: 3 mm is 3e-3")
_PLACE = Range(unit="m")
_COUNT = Range(least=1, most=1_000_000, whole=True)


class _Repeated:
    """A fault of limited length, once or several times."""

    length: float
    at: float
    spacing: float | None
    count: int | None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.count is not None and self.count > 1 and self.spacing is None:
            remedy = "Say how far apart they are"
            raise InputError("spacing", None, f"is missing, count is {self.count}", remedy)
        if self.spacing is not None:
            remedy = "Faults that overlap are a list of several"
            errors.number("spacing", self.spacing, least=self.length, unit="m", remedy=remedy)

    def _from_middle(self, x: Any) -> np.ndarray:
        """Return the distance of each place from the middle of the nearest fault, m."""
        local = np.asarray(x, dtype=float) - self.at
        if self.spacing is None:
            return local
        which = np.round(local / self.spacing)
        if self.count is not None:
            which = np.clip(which, 0, self.count - 1)
        return local - which * self.spacing


def _cosine(x: np.ndarray, depth: float, length: float) -> np.ndarray:
    inside = np.abs(x) < length / 2
    return np.where(inside, -0.5 * depth * (1.0 + np.cos(2 * np.pi * x / length)), 0.0)


def _cosine_slope(x: np.ndarray, depth: float, length: float) -> np.ndarray:
    inside = np.abs(x) < length / 2
    return np.where(inside, np.pi * depth / length * np.sin(2 * np.pi * x / length), 0.0)


@dataclass(frozen=True)
class Dip(_Repeated):
    """A smooth hollow: ``r = -(depth/2) (1 + cos(2 pi (x - at) / length))`` around its middle.

    Attributes
    ----------
    depth : float
        In the middle, m; negative for a hump.
    length : float
        From end to end, m.
    at : float
        Place of the middle, m from the bridge entrance; of the first one if there are several.
    spacing : float, optional
        m between middles, at least the length; only one if left out.
    count : int, optional
        How many; if only spacing is given, they are everywhere, behind and ahead of `at`.

    Notes
    -----
    A dipped joint has been modelled so, 3 mm deep and 1 m long (Kabo 2006) [one].
    """

    depth: Annotated[float, _DEPTH]
    length: Annotated[float, _LENGTH]
    at: Annotated[float, _PLACE] = 0.0
    spacing: Annotated[float, _LENGTH] | None = None
    count: Annotated[int, _COUNT] | None = None

    @property
    def shortest(self) -> float:
        """Length of the dip, m."""
        return self.length if self.depth else np.inf

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return _cosine(self._from_middle(x), self.depth, self.length)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx; continuous."""
        return _cosine_slope(self._from_middle(x), self.depth, self.length)


@dataclass(frozen=True)
class Joint(_Repeated):
    """A dipped joint: two half parabolas that meet in a cusp.

    ``r = -(angle length / 8) (1 - 2 |x - at| / length)^2`` within half a length of the joint. The
    slope jumps there by the angle, from ``-angle/2`` to ``angle/2``; the depth is ``angle length /
    8``, 2.5 mm for 10 mrad over 2 m.

    Attributes
    ----------
    angle : float
        2 alpha, the total angle between the two rail ends, rad.
    length : float
        From where one rail begins to sink to where the other has risen, m.
    at : float
        Place of the joint, m from the bridge entrance; of the first one if there are several.
    spacing : float, optional
        m between joints, the length of a rail; only one if left out.
    count : int, optional
        How many; if only spacing is given, they are everywhere, behind and ahead of `at`.

    Notes
    -----
    Impact forces at joints are said by the angle 2 alpha (P1 and P2 of Jenkins et al. 1974; Mandal,
    Dhanasekar, Sun, doi 10.1177/0954409714537816) [unchecked]; 5 to 15 mrad are usual [unchecked].

    Wrong in the very joint for a wheel without mass on permanent contact: its damper answers the
    jump of the slope by a jump of the force, c V angle, where a real wheel strikes. A real wheel
    also rolls over the cusp on its radius.
    """

    angle: Annotated[
        float, Range(least=0.0, most=0.2, unit="rad", remedy="Give it in rad: 10 mrad is 0.01")
    ]
    length: Annotated[float, _LENGTH]
    at: Annotated[float, _PLACE] = 0.0
    spacing: Annotated[float, _LENGTH] | None = None
    count: Annotated[int, _COUNT] | None = None

    @property
    def depth(self) -> float:
        """How far the joint lies below the rails, m."""
        return self.angle * self.length / 8

    @property
    def shortest(self) -> float:
        """Length of one half, m."""
        return self.length / 2 if self.angle else np.inf

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        left = np.maximum(1.0 - 2.0 * np.abs(self._from_middle(x)) / self.length, 0.0)
        return -self.depth * left**2

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx; at the joint that of the rail ahead."""
        local = self._from_middle(x)
        left = np.maximum(1.0 - 2.0 * np.abs(local) / self.length, 0.0)
        return 0.5 * self.angle * np.where(local < 0.0, -left, left)


@dataclass(frozen=True)
class Weld(_Repeated):
    """A weld: a long hollow or hump, and a short one in its middle, both of the shape of `Dip`.

    Attributes
    ----------
    depth : float
        Of the long part, m; negative for a hump.
    length : float
        Of the long part, m.
    short_depth : float
        Of the short part, m; negative for a hump. On top of the long one.
    short_length : float
        Of the short part, m; at most the length.
    at : float
        Place of the middle, m from the bridge entrance; of the first one if there are several.
    spacing : float, optional
        m between welds; only one if left out.
    count : int, optional
        How many; if only spacing is given, they are everywhere, behind and ahead of `at`.

    Notes
    -----
    Cosine waves are the usual model of welds; it keeps their height, not their shape (Sun et al.
    2025, doi 10.32604/cmes.2024.056023) [one]. 0.2 to 1 mm over 1 m, with 0.1 to 0.2 mm over 0.1 m
    on top, are usual sizes [unchecked].

    Waves of 0.1 m ask for very small time steps, and at 20 m/s for forces of 200 Hz: give the
    vehicle wheelsets with mass, or leave the short part out (``short_depth = 0``).
    """

    depth: Annotated[float, _DEPTH]
    length: Annotated[float, _LENGTH] = 1.0
    short_depth: Annotated[float, _DEPTH] = 0.0
    short_length: Annotated[float, _LENGTH] = 0.1
    at: Annotated[float, _PLACE] = 0.0
    spacing: Annotated[float, _LENGTH] | None = None
    count: Annotated[int, _COUNT] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        errors.number("short_length", self.short_length, above=0.0, most=self.length, unit="m")

    @property
    def shortest(self) -> float:
        """Length of the shortest part that is there, m."""
        if self.short_depth:
            return self.short_length
        return self.length if self.depth else np.inf

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        local = self._from_middle(x)
        short = _cosine(local, self.short_depth, self.short_length)
        return _cosine(local, self.depth, self.length) + short

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx; continuous."""
        local = self._from_middle(x)
        short = _cosine_slope(local, self.short_depth, self.short_length)
        return _cosine_slope(local, self.depth, self.length) + short
