"""Many realisations of a random track: what their extremes are, and how sure that is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from .. import errors
from ..errors import InputError, brief
from ..irregularities import RandomTrack, phases
from .statistics import Statistics, describe
from .unitwaves import UnitWaves

__all__ = ["Ensemble", "draw", "shares_of"]

_TOGETHER = 2**24
"""Numbers of histories at once."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """The extremes of every history over realisations of a track.

    Attributes
    ----------
    track : RandomTrack
        The first one; the others have other seeds.
    seeds : ndarray of int, shape (realisations,)
    units : dict of str
        Of every history.
    low, high : dict of ndarray, shape (realisations,)
        Smallest and largest value of every history.
    static_loads : dict of float
        Of every history of a wheel the static load, N.
    """

    __repr__ = brief

    track: RandomTrack
    seeds: np.ndarray
    units: Mapping[str, str] = field(repr=False)
    low: Mapping[str, np.ndarray] = field(repr=False)
    high: Mapping[str, np.ndarray] = field(repr=False)
    static_loads: Mapping[str, float] = field(repr=False)

    def of(self, number: int) -> RandomTrack:
        """Return the track of a realisation, from 1, as `cross` takes it."""
        number = errors.integer("number", number, least=1, most=len(self.seeds))
        return replace(self.track, seed=int(self.seeds[number - 1]))

    def values(self, name: str, side: str = "magnitude") -> np.ndarray:
        """Return the extreme of every realisation, shape (realisations,).

        Parameters
        ----------
        name : str
            A history, or "wheel_unloading": of all wheels whose forces were asked for the largest
            1 - force / static force.
        side : {"largest", "smallest", "magnitude"}
        """
        errors.choice("side", side, ("largest", "smallest", "magnitude"))
        if name == "wheel_unloading":
            if not self.static_loads:
                allowed = "no wheel forces were asked for"
                raise InputError("name", name, allowed, "Ask with wheels_of = (1,)")
            lost = [1.0 + self.high[own] / load for own, load in self.static_loads.items()]
            return np.max(lost, axis=0)
        if name not in self.low:
            known = [*self.low, "wheel_unloading"]
            raise InputError("name", name, "no such history", errors.did_you_mean(name, known))
        low, high = self.low[name], self.high[name]
        if side == "magnitude":
            return np.maximum(-low, high)
        return high if side == "largest" else low

    def statistics(self, name: str, side: str = "magnitude", **options) -> Statistics:
        """Return mean, standard deviation, percentiles and extremes, each with its confidence.

        Parameters
        ----------
        name, side
            As for `values`.
        **options
            See `statistics.describe`.
        """
        return describe(self.values(name, side), **options)

    def to_frame(self, side: str = "magnitude"):
        """Return a pandas DataFrame with a row a realisation and a column a history."""
        import pandas as pd

        columns = {f"{name} ({unit})": self.values(name, side) for name, unit in self.units.items()}
        return pd.DataFrame(columns, index=pd.Index(self.seeds, name="seed"))


def shares_of(track: RandomTrack, waves: UnitWaves, seed: int) -> np.ndarray:
    """Return how much of every lane the realisation of a seed has, m, shape (components, 2 waves).

    Of A cos(W x + phi) the cosine has A cos(phi), the sine -A sin(phi).
    """
    result = []
    for component in waves.components:
        powers = track.powers[component]
        turned = np.sqrt(2.0 * powers) * np.exp(-1j * phases(seed, component, len(powers)))
        result.append(turned.view(float))
    return np.array(result)


def draw(track: RandomTrack, waves: UnitWaves, seeds: np.ndarray) -> Ensemble:
    """Return the extremes of realisations: products of matrices.

    Parameters
    ----------
    track : RandomTrack
    waves : UnitWaves
    seeds : ndarray of int, shape (realisations,)
    """
    own = np.array([shares_of(track, waves, int(seed)) for seed in seeds])
    own = own.reshape(len(seeds), -1).T
    low, high = {}, {}
    for name, history in waves.histories.items():
        lanes = np.moveaxis(history.waves, 0, 1).reshape(len(history.time), -1)
        together = max(_TOGETHER // len(history.time), 1)
        found = []
        for first in range(0, len(seeds), together):
            y = lanes @ own[:, first : first + together]
            y += history.level[:, None]
            found.append((y.min(axis=0), y.max(axis=0)))
        low[name], high[name] = (np.concatenate(part) for part in zip(*found, strict=True))
    static = {}
    for wheel in waves.train.wheels:
        name = f"wheel_force_z of car {wheel.car}, wheel {wheel.number}"
        if name in waves.histories and wheel.static_load > 0.0:
            static[name] = wheel.static_load
    units = {name: history.unit for name, history in waves.histories.items()}
    return Ensemble(track, seeds, units, low, high, static)
