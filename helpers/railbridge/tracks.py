r"""Irregularities of rail and wheel: value and slope.

x is the distance from the bridge entrance, forward; r > 0 raises the wheel, or moves it left. Every
irregularity knows its slope dr/dx in closed form, because the wheel force needs ``k r + c V
dr/dx``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Protocol

import numpy as np

from . import errors
from .errors import InputError, Range, brief, check_fields

__all__ = [
    "FadeIn", "Harmonic", "Irregularity", "Level", "Notch", "Rails", "TRACK_GAUGE", "TWIST_LENGTH",
    "Table", "Track", "extent_of", "period_of",
]  # fmt: skip

TRACK_GAUGE = 1.435
"""m between the rails, over which their heights differ where a track is twisted."""
TWIST_LENGTH = 3.0
"""m of track over which twist is measured."""

_OTHER_SIGN = "Shift the phase by pi to change the sign"


class Irregularity(Protocol):
    """What every irregularity offers.

    Two more attributes may be there. ``extent`` = (first, last), m: it is not known outside of
    these places. ``period``, m: from there on it repeats although the real one would not, as sums
    of waves do. A crossing that needs more is refused; see `extent_of` and `period_of`.
    """

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m, at x, m."""

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx, dimensionless, at x, m."""

    @property
    def shortest(self) -> float:
        """Shortest length, m, that the time step has to resolve; infinite if none."""


def extent_of(irregularity: Irregularity) -> tuple[float, float]:
    """Return the first and the last place, m, where an irregularity is known; without end if all.

    Parameters
    ----------
    irregularity : Irregularity
        With or without an attribute ``extent``.
    """
    given = getattr(irregularity, "extent", None)
    return (-np.inf, np.inf) if given is None else given


def period_of(irregularity: Irregularity) -> float:
    """Return the length, m, after which an irregularity repeats by its making; infinite if never.

    Parameters
    ----------
    irregularity : Irregularity
        With or without an attribute ``period``. A wave has none: it repeats because it is one.
    """
    given = getattr(irregularity, "period", None)
    return np.inf if given is None else given


@dataclass(frozen=True)
class Level:
    """A perfect rail."""

    shortest: float = field(default=np.inf, init=False)

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return zeros."""
        return np.zeros_like(x, dtype=float)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return zeros."""
        return np.zeros_like(x, dtype=float)


@dataclass(frozen=True)
class Harmonic:
    """``r(x) = A sin(2 pi x / lambda + phi)`` (Eq. 1).

    Attributes
    ----------
    amplitude : float
        A, m.
    wavelength : float, optional
        lambda, m. Or give length and half_waves.
    phase : float
        phi, rad.
    length : float, optional
        l of Eq. 1, m: the wavelength is 2 length / half_waves.
    half_waves : float, optional
        n of Eq. 1.
    """

    amplitude: Annotated[float, Range(least=0.0, unit="m", remedy=_OTHER_SIGN)]
    wavelength: Annotated[float, Range(above=0.0, unit="m")] | None = None
    phase: Annotated[float, Range(unit="rad")] = 0.0
    length: Annotated[float, Range(above=0.0, unit="m")] | None = None
    half_waves: Annotated[float, Range(above=0.0)] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        pair = self.length is not None, self.half_waves is not None
        if (self.wavelength is None) != all(pair) or (self.wavelength is not None and any(pair)):
            allowed = "give either wavelength, or length and half_waves, not both"
            raise InputError("wavelength", self.wavelength, allowed)
        if self.wavelength is None:
            wavelength = Range(above=0.0, unit="m").checked(
                "wavelength", 2.0 * self.length / self.half_waves
            )
            object.__setattr__(self, "wavelength", wavelength)

    @property
    def shortest(self) -> float:
        """One wavelength, m."""
        return self.wavelength if self.amplitude else np.inf

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return self.amplitude * np.sin(2 * np.pi * x / self.wavelength + self.phase)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx."""
        k = 2 * np.pi / self.wavelength
        return self.amplitude * k * np.cos(k * x + self.phase)


@dataclass(frozen=True, eq=False)
class Table:
    """A measured irregularity: linear between its points, level beyond its ends at their value.

    Attributes
    ----------
    x : array_like, shape (n,)
        m from the bridge entrance, ascending, at least two points.
    r : array_like, shape (n,)
        m, one for each x; linear between.
    """

    __repr__ = brief

    x: Annotated[np.ndarray, Range(unit="m")]
    r: Annotated[np.ndarray, Range(unit="m")]

    def __post_init__(self) -> None:
        x = errors.numbers("x", self.x, unit="m")
        r = errors.numbers("r", self.r, count=len(x), unit="m")
        if len(x) < 2 or np.any(np.diff(x) <= 0):
            allowed = "must ascend and hold at least two points"
            raise InputError("x", self.x, allowed, "Sort it and remove doubles")
        object.__setattr__(self, "x", errors.frozen(x))
        object.__setattr__(self, "r", errors.frozen(r))

    @property
    def shortest(self) -> float:
        """Ten times the closest spacing, m, so that every point of the table is met."""
        return 10.0 * float(np.min(np.diff(self.x)))

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return np.interp(x, self.x, self.r)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx: constant between points, zero beyond the ends."""
        slopes = np.concatenate([[0.0], np.diff(self.r) / np.diff(self.x), [0.0]])
        return slopes[np.searchsorted(self.x, x, side="right")]


@dataclass(frozen=True)
class Sum:
    """Several irregularities on top of each other."""

    __repr__ = brief

    parts: tuple[Irregularity, ...]

    @property
    def shortest(self) -> float:
        """Shortest of the parts, m."""
        return min(p.shortest for p in self.parts)

    @property
    def extent(self) -> tuple[float, float]:
        """First and last place, m, where all parts are known."""
        first, last = zip(*map(extent_of, self.parts), strict=True)
        return max(first), min(last)

    @property
    def period(self) -> float:
        """Length, m, after which the first of the parts repeats."""
        return min(map(period_of, self.parts))

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return sum(p.value(x) for p in self.parts)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx."""
        return sum(p.slope(x) for p in self.parts)


@dataclass(frozen=True)
class Rails:
    """Different irregularities of the left and the right rail."""

    __repr__ = brief

    left: Irregularity | list | tuple | None = None
    right: Irregularity | list | tuple | None = None


@dataclass(frozen=True)
class Track:
    """The irregularities of a track.

    Attributes
    ----------
    vertical, lateral : Irregularity, list of them (summed), Rails, or None (level)

    Raises
    ------
    InputError
        Anything else.
    """

    __repr__ = brief

    vertical: Irregularity | list | tuple | Rails | None = None
    lateral: Irregularity | list | tuple | Rails | None = None

    def __post_init__(self) -> None:
        _ = self._rails  # refuses what is no irregularity

    def rail(self, direction: str, side: str) -> Irregularity:
        """Return one rail's irregularity.

        Parameters
        ----------
        direction : {"vertical", "lateral"}
        side : {"left", "right"}
        """
        return self._rails[direction, side]

    @cached_property
    def _rails(self) -> dict[tuple[str, str], Irregularity]:
        """Each rail once: the same object on both sides where the sides do not differ."""
        result = {}
        for direction in ("vertical", "lateral"):
            given = getattr(self, direction)
            sides = (given.left, given.right) if isinstance(given, Rails) else (given,)
            rails = [_combine(direction, g) for g in sides]
            result[direction, "left"], result[direction, "right"] = rails[0], rails[-1]
        return result

    @property
    def level(self) -> bool:
        """Whether every rail is perfect."""
        return all(isinstance(rail, Level) for rail in self._rails.values())

    @property
    def shortest(self) -> float:
        """Shortest length in the track, m."""
        return min(
            self.rail(d, s).shortest for d in ("vertical", "lateral") for s in ("left", "right")
        )


def _combine(name: str, given: Irregularity | list | tuple | None) -> Irregularity:
    if given is None:
        return Level()
    if isinstance(given, (list, tuple)):
        return Sum(tuple(_combine(name, g) for g in given)) if given else Level()
    if not (hasattr(given, "value") and hasattr(given, "slope") and hasattr(given, "shortest")):
        raise InputError(
            name, given, "must be an irregularity (value and slope), a list of them, Rails, or None"
        )
    return given


@dataclass(frozen=True)
class Notch:
    """A flat spot that meets the rail once a turn (Eq. 2).

    ``r = -(a/2) (1 - cos(2 pi (x - k A - B) / b))`` while x lies within b behind k A + B.

    Attributes
    ----------
    wheels : tuple of (car, wheel)
        Which wheels carry it: pairs [car, wheel], counted from 1, front to back, left before right.
    circumference : float
        A of Eq. 2, m.
    offset : float
        B of Eq. 2, m: where this wheel's notch first meets the rail, behind the bridge entrance.
    depth : float
        a of Eq. 2, m.
    length : float
        b of Eq. 2, m; not longer than the circumference.
    before_entrance : bool
        Whether the turns before B (k < 0) count too. Eq. 2 starts at k = 0.

    Notes
    -----
    x is the wheel's own position. A notch lowers the wheel. Wrong when the wheel cannot follow:
    without wheel mass and with permanent contact, the force is nearly all primary damper.
    """

    wheels: tuple[tuple[int, int], ...]
    circumference: Annotated[float, Range(above=0.0, unit="m")]
    offset: Annotated[float, Range(unit="m")]
    depth: Annotated[float, Range(least=0.0, unit="m")]
    length: Annotated[float, Range(above=0.0, unit="m")]
    before_entrance: bool = False

    def __post_init__(self) -> None:
        check_fields(self)
        errors.number("length", self.length, above=0.0, most=self.circumference, unit="m")
        pairs = self.wheels if isinstance(self.wheels, (list, tuple)) else ()
        if not pairs or not all(
            isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs
        ):
            raise InputError("wheels", self.wheels, "must list pairs [car, wheel], numbered from 1")
        wheels = tuple(
            tuple(errors.integer(f"wheels[{i}]", n, least=1) for n in pair)
            for i, pair in enumerate(pairs, start=1)
        )
        object.__setattr__(self, "wheels", wheels)

    @property
    def shortest(self) -> float:
        """Length of the notch, m."""
        return self.length if self.depth else np.inf

    def _phase(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        along = np.asarray(x, dtype=float) - self.offset
        within = np.mod(along, self.circumference)
        inside = within <= self.length
        return inside & (
            along >= 0.0
        ) if not self.before_entrance else inside, 2 * np.pi * within / self.length

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        inside, phase = self._phase(x)
        return np.where(inside, -0.5 * self.depth * (1.0 - np.cos(phase)), 0.0)

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx."""
        inside, phase = self._phase(x)
        return np.where(inside, -np.pi * self.depth / self.length * np.sin(phase), 0.0)


@dataclass(frozen=True)
class FadeIn:
    """The run-up: ``r`` fades in before the bridge.

    It is zero before ``-lead_in``, grows with a half-cosine over half the lead-in, then is
    untouched. A function of position, so every car has the same run-up. ``lead_in = 0`` means level
    track before the deck.

    Attributes
    ----------
    inner : Irregularity
    lead_in : float
        m.
    """

    __repr__ = brief

    inner: Irregularity
    lead_in: float

    @property
    def shortest(self) -> float:
        """Shortest length of the irregularity itself, m."""
        return self.inner.shortest

    @property
    def extent(self) -> tuple[float, float]:
        """First and last place, m, where the irregularity itself is known."""
        return extent_of(self.inner)

    @property
    def period(self) -> float:
        """Length, m, after which the irregularity itself repeats."""
        return period_of(self.inner)

    def _fade(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return where r is not yet untouched, and its factor there and the factor's slope."""
        if self.lead_in == 0.0:
            early = np.flatnonzero(x < -1e-9)
            return early, np.zeros(len(early)), np.zeros(len(early))
        ramp = self.lead_in / 2
        early = np.flatnonzero(x <= -ramp)
        angle = np.pi * np.maximum(x[early] + self.lead_in, 0.0) / ramp
        return early, 0.5 - 0.5 * np.cos(angle), 0.5 * np.pi / ramp * np.sin(angle)

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        result = np.array(self.inner.value(x), dtype=float)
        early, factor, _ = self._fade(x)
        result[early] *= factor
        return result

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx, the fade's own slope included."""
        result = np.array(self.inner.slope(x), dtype=float)
        early, factor, rate = self._fade(x)
        result[early] = factor * result[early] + rate * self.inner.value(x[early])
        return result
