r"""What is certain about an uncertain track: the exact variance of every answer, at every time.

A random track is a sum of cosines of independent phases, each of the variance s_k its band of the
spectrum holds. Train and deck answer each in a way that is known (`unitwaves`), so at every time

    mean      y_0(t), that of the track without them,
    variance  sum over components and waves of s_k (y_c,k(t)^2 + y_s,k(t)^2):

the pseudo-excitation method (Lin 1992; of trains on bridges Zhang, Lin, Zhang, Zhao & Williams
2010): instead of drawing tracks, one crossing on the cosine and one on the sine of every wave. All
wheels meet the same wave, each at its own place, so nothing is left out of how they act together.
Nothing is assumed but that train and deck are linear; that answers are Gaussian, too, is assumed by
`RandomResponse.extreme` only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .. import errors
from ..cautions import remarks_before
from ..crossing import warn_of
from ..decks import Deck
from ..errors import InputError, InputWarning, Remark, brief
from ..irregularities import RandomTrack, TrackSpectrum
from ..irregularities.realisations import MOST_SEED
from ..settings import LEAD_IN_SECONDS
from ..tracks import Track
from ..trains import AnyTrain
from ..vehicles import Vehicle
from .ensembles import Ensemble, draw, shares_of
from .peakfactors import Extreme, extreme
from .unitwaves import UnitWaves, unit_waves

__all__ = ["RandomResponse", "compute_response", "random_response"]

_LONGER = 1.1
"""How much longer than the way of the train the track is before it repeats itself."""
_LANES = 256
"""Lanes that are squared at once."""
_LEFT = 0.1
"""Share of a car's free vibration that may be left after a period of the track.

Waves that are that far apart miss or meet a sharp resonance by chance: the variance of such a mode
alone is wrong by up to twice this share.
"""


@dataclass(frozen=True, eq=False)
class RandomResponse:
    """A crossing of a random track: mean and standard deviation of every history.

    Attributes
    ----------
    track : RandomTrack
        Its seed is the first of an ensemble; the others count on.
    waves : UnitWaves
    """

    __repr__ = brief

    track: RandomTrack
    waves: UnitWaves

    @property
    def remarks(self) -> tuple[Remark, ...]:
        """What is doubtful about train, deck and track, and about the spectrum's constants."""
        train, deck, settings = self.waves.train, self.waves.deck, self.waves.settings
        return (
            *remarks_before(train, deck, self.waves.base, settings, self.track),
            *_too_short(train, self.track, settings.speed),
        )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the histories."""
        return tuple(self.waves.histories)

    def unit(self, name: str) -> str:
        """Return the unit of a history."""
        return self.waves.history(name).unit

    def time(self, name: str) -> np.ndarray:
        """Return the times of a history, s."""
        return self.waves.history(name).time

    def mean(self, name: str) -> np.ndarray:
        """Return the mean, that of the track without waves, shape (n,)."""
        return self.waves.history(name).level

    def sigma(self, name: str, component: str | None = None) -> np.ndarray:
        """Return the standard deviation at every time, shape (n,).

        Parameters
        ----------
        name : str
        component : str, optional
            What one component of the track gives alone; all together if not given.
        """
        own = self.waves.history(name)
        if component is not None:
            errors.choice("component", component, self.waves.components)
            place = self.waves.components.index(component)
            parts = self._parts(own.waves[place], self._powers[place])
            return np.sqrt(sum(some**2 @ powers for some, powers in parts))
        return self._moments(name)[0]

    def spectrum_at(self, name: str, time: float) -> np.ndarray:
        """Return what every wave adds to the variance at a time, shape (components, waves).

        Parameters
        ----------
        name : str
        time : float
            s; the nearest sample is taken.
        """
        own = self.waves.history(name)
        k = int(np.argmin(np.abs(own.time - errors.number("time", time, unit="s"))))
        parts = own.waves[:, k] ** 2 * self._powers
        return parts.reshape(len(parts), -1, 2).sum(axis=2)

    def extreme(self, name: str, side: str = "magnitude") -> Extreme:
        """Return what the extreme of the crossing is in probability, for Gaussian answers.

        Parameters
        ----------
        name : str
        side : {"largest", "smallest", "magnitude"}

        Notes
        -----
        Against ensembles of 2000 (mean extreme, three planar cars on 36 m): wheel forces within 0.1
        standard deviations of the process. What rings in one mode comes out too large, on the safe
        side: accelerations by 0.02 to 0.9 (up to 9 %, the most at 0.5 % damping), displacements
        and moments by up to 0.5, their standard deviation too small by up to 40 %; the 95 %
        percentile is within 0.3. Wrong, by two standard deviations too large, where the answer
        jumps: shear, and torsion, at a point that wheels pass. `ensemble` has none of this.
        """
        own = self.waves.history(name)
        sigma, of_rate, together = self._moments(name)
        rate = np.gradient(own.level, own.time)
        return extreme(own.time, own.level, sigma, rate, of_rate, together, side=side)

    def history(self, name: str, seed: int) -> np.ndarray:
        """Return a history on the realisation of one seed, shape (n,)."""
        own = self.waves.history(name)
        shares = shares_of(
            self.track, self.waves, errors.integer("seed", seed, least=0, most=MOST_SEED)
        )
        return own.level + np.einsum("cnk,ck->n", own.waves, shares)

    def on(self, spectrum: TrackSpectrum | str) -> RandomResponse:
        """Return the same crossing on another spectrum: nothing has to be computed anew."""
        track = replace(self.track, spectrum=spectrum, components=self.waves.components)
        return RandomResponse(track, self.waves)

    def ensemble(
        self, realisations: int = 200, progress: Callable[[str], None] | None = None
    ) -> Ensemble:
        """Return the extremes of many realisations, of the track's seed and those after it."""
        count = errors.integer("realisations", realisations, least=2, most=1_000_000)
        if self.track.seed + count - 1 > MOST_SEED:
            allowed = f"must leave room for {count} seeds up to {MOST_SEED}"
            raise InputError("track.seed", self.track.seed, allowed, "Take a smaller one")
        seeds = self.track.seed + np.arange(count)
        return draw(self.track, self.waves, seeds, progress)

    def to_frame(self, name: str):
        """Return a pandas DataFrame: mean and standard deviation by time."""
        import pandas as pd

        own = self.waves.history(name)
        columns = {f"mean ({own.unit})": own.level, f"sigma ({own.unit})": self.sigma(name)}
        return pd.DataFrame(columns, index=pd.Index(own.time, name="t (s)"))

    @cached_property
    def _powers(self) -> np.ndarray:
        """Variance of every lane, m2, shape (components, 2 waves)."""
        return np.array([np.repeat(self.track.powers[c], 2) for c in self.waves.components])

    @staticmethod
    def _parts(waves: np.ndarray, powers: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Give some lanes after others, so that what is made of them is small beside all."""
        for first in range(0, len(powers), _LANES):
            some = slice(first, first + _LANES)
            yield waves[:, some], powers[some]

    @cached_property
    def _known_moments(self) -> dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Moments of histories that were asked for; no closure, so that it can be pickled."""
        return {}

    def _moments(self, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the standard deviations of a history and of its rate, and their correlation."""
        if name not in self._known_moments:
            own = self.waves.history(name)
            square, of_rate, mixed = np.zeros((3, len(own.time)))
            for component in zip(own.waves, self._powers, strict=True):
                for waves, powers in self._parts(*component):
                    rates = np.gradient(waves, own.time, axis=0)
                    square += waves**2 @ powers
                    of_rate += rates**2 @ powers
                    mixed += (waves * rates) @ powers
            sizes = np.sqrt(square * of_rate)
            together = np.divide(mixed, sizes, out=np.zeros_like(mixed), where=sizes > 0.0)
            found = np.sqrt(square), np.sqrt(of_rate), np.clip(together, -1.0, 1.0)
            self._known_moments[name] = found
        return self._known_moments[name]


def random_response(
    train: AnyTrain,
    deck: Deck,
    track: RandomTrack | TrackSpectrum | str,
    *,
    quantities: Sequence[str] = ("displacement_z",),
    points: Sequence[float] | None = None,
    wheels_of: Sequence[int] = (),
    base: Track | None = None,
    progress: Callable[[str], None] | None = None,
    **options,
) -> RandomResponse:
    """Compute a crossing of a random track, all its realisations at once.

    Parameters
    ----------
    train : Train
    deck : Deck
    track : RandomTrack, or a spectrum or its name
        A spectrum stands for its `RandomTrack`. A period that is not given is chosen, a tenth
        longer than run-up, deck and train, and so long that cars forget what they met before it.
    quantities : sequence of str
        What is asked for at every point: displacements, accelerations, section forces.
    points : sequence of float, optional
        m along the deck; mid-span if not given.
    wheels_of : sequence of int
        Cars whose vertical wheel forces are asked for, too, while on the deck; from 1.
    base : Track, optional
        What is certain about the track, waves, dips or a measured record: the mean is the crossing
        of that.
    progress : function of one text, optional
    **options
        As for `cross`: speed, time_step, loads, track_offset, ...; interaction = "rigid" for the
        deck under the forces of a rigid one.

    Raises
    ------
    InputError
        What is not linear, or would not fit into memory; a car without damping, whose answer to
        waves that come from far has no bound.

    Warns
    -----
    InputWarning, ResultWarning
        What `RandomResponse.remarks` says; a given period so short that the waves are too far apart
        for a car's resonance.

    Notes
    -----
    Section forces that jump are seen at samples only, not on both sides of the jump.
    """
    found = compute_response(
        train, deck, track, quantities=quantities, points=points, wheels_of=wheels_of, base=base,
        progress=progress, **options,
    )  # fmt: skip
    warn_of(found.remarks)
    return found


def compute_response(
    train: AnyTrain, deck: Deck, track: RandomTrack | TrackSpectrum | str, **asked
) -> RandomResponse:
    """Compute a crossing of a random track as `random_response` does, without warnings.

    Parameters
    ----------
    train, deck, track
    **asked
        The other arguments of `random_response`.
    """
    if not isinstance(track, RandomTrack):
        track = RandomTrack(track)
    if "components" in asked:
        remedy = "Write RandomTrack(..., components = ('vertical',))"
        raise InputError("components", asked["components"], "belong to the track", remedy)
    track = _long_enough(train, deck, track, asked.get("speed"))
    waves = unit_waves(train, deck, track.edges, components=track.components, **asked)
    return RandomResponse(track, waves)


def _long_enough(train: AnyTrain, deck: Deck, track: RandomTrack, speed: float) -> RandomTrack:
    """Return a track that does not repeat itself below the train; refuse one that would."""
    speed = errors.number("speed", speed, above=0.0, unit="m/s")
    length = errors.instance("deck", deck, Deck).length + 2 * deck.reach
    length += errors.instance("train", train, AnyTrain).length
    memory = _way_of_memory(train, speed)
    if track.period is None:
        way = _LONGER * (LEAD_IN_SECONDS * speed + length)
        return replace(track, period=float(10.0 * np.ceil(max(way, memory) / 10.0)))
    if track.length < length:
        allowed = f"is shorter than deck and train, {length:.4g} m: wheels would meet the same"
        allowed += " waves again"
        raise InputError("track.period", track.period, allowed, "Leave it out to have it chosen")
    return track


def _too_short(train: AnyTrain, track: RandomTrack, speed: float) -> list[Remark]:
    """Doubt a period so short that the waves are too far apart for a car's resonance."""
    memory = _way_of_memory(train, speed)
    if track.length >= memory:
        return []
    text = f"= {track.period:g} m: the waves are too far apart for a car so lightly damped, "
    return [InputWarning("track.period", f"{text}{memory:.4g} m are needed. Give that much.")]


def _way_of_memory(train: AnyTrain, speed: float) -> float:
    """Return the way, m, on which cars forget what they met before it."""
    slowest = max((_memory(vehicle) for vehicle, _ in train.kinds()), default=0.0)
    return float(speed * np.log(1.0 / _LEFT) * slowest)


def _memory(vehicle: Vehicle) -> float:
    """Return after which time the slowest mode that wheels feel has fallen to 1 / e, s."""
    system = vehicle.system
    poles = np.linalg.eigvals(system.a)
    if system.modal is not None:
        poles, left, show, _ = system.modal
        felt = np.abs(show).max(axis=0) * np.abs(left).max(axis=1)
        poles = poles[felt > 1e-9 * felt.max(initial=0.0)]
    slowest = poles[np.argmax(poles.real)]
    if slowest.real > -1e-6 * abs(slowest):
        allowed = f"has no damping at {abs(slowest) / (2 * np.pi):.3g} Hz: on waves that come from "
        allowed += "far its answer has no bound"
        raise InputError(f"vehicle {vehicle.name}", None, allowed, "Give it dampers")
    return -1.0 / slowest.real
