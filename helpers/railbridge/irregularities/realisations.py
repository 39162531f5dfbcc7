r"""Random tracks: realisations of a spectrum as sums of cosines with random phases.

A component of the track with the one-sided spectrum S is

    r(x) = sum over k of sqrt(2 s_k) cos(W_k x + phi_k),     s_k = integral of S over band k,

with K bands of equal width between the longest and the shortest wave, W_k in the middle of each,
and phases phi_k that are even between 0 and 2 pi (Shinozuka & Deodatis 1991). Its variance, the sum
of s_k, is that of the spectrum whatever the phases are; with many waves it is nearly Gaussian. The
width of the bands decides after which length the track repeats itself.

The four components are independent, each with phases of its own. With v vertical and a alignment, c
cross-level (a height over 1.5 m) and g gauge,

    left rail   z = v + c/2,  y = a + g/2,        right rail   z = v - c/2,  y = a - g/2,

x forward, y to the left, z up: a higher left rail is positive roll.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Annotated, Any

import numpy as np

from .. import errors
from ..errors import InputError, Range, brief, frozen
from ..tracks import Irregularity, Rails, Track
from .cosines import Cosines
from .formulas import COMPONENTS
from .reading import spectrum
from .trackspectra import GRADES, TrackSpectrum

__all__ = ["PAIRS", "PERIOD", "RandomTrack", "phases"]

PERIOD = 2000.0
"""m after which a random track repeats itself, if nothing else is asked for."""
MOST_WAVES = 20_000
MOST_SEED = 2**53
"""Beyond it floating-point numbers leave whole numbers out, and files of cases may do so, too."""
PAIRS = {"vertical": ("vertical", "cross_level"), "lateral": ("alignment", "gauge")}
"""What moves both rails alike in a direction, and what moves them apart."""


def phases(seed: int, component: str, count: int) -> np.ndarray:
    """Return the phases of the waves of one component, rad, shape (count,).

    Every component has a stream of random numbers of its own, all from one seed.
    """
    place = COMPONENTS.index(component)
    own = np.random.SeedSequence(seed).spawn(len(COMPONENTS))[place]
    return 2 * np.pi * np.random.Generator(np.random.PCG64(own)).random(count)


@lru_cache(maxsize=64)
def _powers(
    own: TrackSpectrum, component: str, first: float, last: float, count: int
) -> np.ndarray:
    """Return the variance in each of some bands of equal width between wave numbers (rad/m), m2.

    Tracks that differ in their seeds share it: it takes longer than all the rest of a track.
    """
    waves = 2 * np.pi / np.linspace(first, last, count + 1)
    found = [
        own.sigma(component, (short, long), height=True) ** 2
        for long, short in pairwise(waves.tolist())
    ]
    return frozen(np.array(found))


@dataclass(frozen=True, eq=False)
class RandomTrack(Track):
    """A track drawn from a spectrum; two of the same choices are equal.

    Attributes
    ----------
    vertical, lateral : Irregularity or Rails
        What it became; not to be given.
    spectrum : TrackSpectrum or str
        Or its shipped name, "german-low".
    band : (float, float)
        Shortest and longest wave, m, within the band in which the spectrum holds.
    seed : int
        Of the phases, from 0 to 2**53: the same seed gives the same track, on every machine.
    components : tuple of str
        Some of `COMPONENTS`; if not given, all that the spectrum has.
    period : float, optional
        m after which it repeats itself, at least; 2000 m if not given.

    Raises
    ------
    InputError
        A band beyond the spectrum's, a seed that is no whole number, a component that the spectrum
        lacks.

    Notes
    -----
    Another band or period makes other waves, and so another track from the same seed. Components do
    not change each other's phases.
    """

    __repr__ = brief

    vertical: Irregularity | Rails | None = field(init=False, repr=False)
    lateral: Irregularity | Rails | None = field(init=False, repr=False)
    spectrum: TrackSpectrum | str = "german-low"
    band: tuple[float, float] = (3.0, 150.0)
    seed: Annotated[int, Range(least=0, most=MOST_SEED, whole=True)] = 0
    components: tuple[str, ...] | None = None
    period: Annotated[float, Range(above=0.0, unit="m")] | None = None

    def __post_init__(self) -> None:
        own = self.spectrum
        own = own if isinstance(own, TrackSpectrum) else spectrum(own)
        chosen = {
            "spectrum": own,
            "band": own.checked_band(self.band),
            "seed": errors.integer("seed", self.seed, least=0, most=MOST_SEED),
            "components": _components(own, self.components),
        }
        if self.period is not None:
            chosen["period"] = errors.number("period", self.period, above=0.0, unit="m")
        for name, value in chosen.items():
            object.__setattr__(self, name, value)
        for direction in PAIRS:
            object.__setattr__(self, direction, self._of_rails(direction))
        super().__post_init__()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RandomTrack):
            return NotImplemented
        return self._choices == other._choices

    def __hash__(self) -> int:
        return hash(self._choices)

    @property
    def _choices(self) -> tuple[Any, ...]:
        """What decides the track, waves and all."""
        return self.spectrum, self.band, self.seed, self.components, self.period

    @property
    def length(self) -> float:
        """M after which it repeats itself: a little more than was asked for."""
        return 2 * np.pi / float(self.edges[1] - self.edges[0])

    @cached_property
    def edges(self) -> np.ndarray:
        """Ends of the bands of wave numbers, rad/m, ascending, shape (waves + 1,)."""
        shortest, longest = self.band
        first, last = 2 * np.pi / longest, 2 * np.pi / shortest
        period = PERIOD if self.period is None else self.period
        count = int(np.ceil((last - first) * period / (2 * np.pi)))
        if count > MOST_WAVES:
            allowed = f"needs {count} waves, must be at most {MOST_WAVES}"
            remedy = "Give a shorter period, or a band with longer waves"
            raise InputError("period", period, allowed, remedy)
        return frozen(np.linspace(first, last, max(count, 1) + 1))

    @property
    def wavenumbers(self) -> np.ndarray:
        """W of every wave, rad/m, shape (waves,)."""
        return (self.edges[1:] + self.edges[:-1]) / 2

    @cached_property
    def powers(self) -> dict[str, np.ndarray]:
        """The variance that every band holds of every component, m2, shape (waves,)."""
        bands = float(self.edges[0]), float(self.edges[-1]), len(self.edges) - 1
        return {name: _powers(self.spectrum, name, *bands) for name in self.components}

    def amplitudes(self, component: str) -> np.ndarray:
        """Return size and phase of every wave, m, complex: r = Re sum A exp(i W x)."""
        errors.choice("component", component, self.components)
        own = phases(self.seed, component, len(self.edges) - 1)
        return np.sqrt(2.0 * self.powers[component]) * np.exp(1j * own)

    def component(self, name: str) -> Cosines:
        """Return one component by itself: what both rails share, or their difference."""
        return self._rail(self.amplitudes(name), (name,))

    def _of_rails(self, direction: str) -> Irregularity | Rails | None:
        both, apart = PAIRS[direction]
        shared = self.amplitudes(both) if both in self.components else 0.0 * self.wavenumbers
        if apart in self.components:
            half = self.amplitudes(apart) / 2
            return Rails(*(self._rail(shared + part, (both, apart)) for part in (half, -half)))
        return self._rail(shared, (both,)) if both in self.components else None

    def _rail(self, amplitudes: np.ndarray, components: tuple[str, ...]) -> Cosines:
        grades = {self.spectrum.grade(name) for name in components if name in self.components}
        told = f"{self.spectrum.name}: its constants are "
        told += f"{GRADES['memory' if 'memory' in grades else 'one']}."
        return Cosines(self.wavenumbers, amplitudes, self.length, told * (grades != {"two"}))


def _components(own: TrackSpectrum, given: Any) -> tuple[str, ...]:
    if given is None:
        return tuple(name for name in COMPONENTS if name in own.components)
    if isinstance(given, str):
        given = (given,)
    if not isinstance(given, (list, tuple)) or not given:
        raise InputError("components", given, "must name at least one component")
    for name in given:
        errors.choice("components", name, COMPONENTS)
        if name not in own.components:
            allowed = f"{own.name} has none, only {', '.join(own.components)}"
            raise InputError("components", name, allowed, "Leave it out, or take another spectrum")
    return tuple(name for name in COMPONENTS if name in given)
