r"""A deck is a modal deck: frequencies, damping, shapes along its axis, and how to recover what was asked.

With mass-normalised shapes v_m, w_m (lateral, vertical) and theta_m (twist) each mode obeys

    q'' + 2 zeta omega q' + omega^2 q
        = sum over loads of (v F_y + w F_z + theta M_x - w' M_y + v' M_z) at the load's place x = V t - d,

with M_x about the deck axis. A wheel at y, riding on the deck, moves by ``w + y theta``, sideways by ``v - h theta`` where the
rails lie h above the axis, and its support velocity is the
total derivative ``w q' + V w' q``: the second, convective term is the climb along the deflected deck.

Section forces and reactions are recovered as ``sum S_m q_m`` plus the static correction of the modes left out, which is
the static influence line under the present loads minus its modal part. They are the elastic ones: the stiffness-
proportional part of the damping is not counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import perm
from typing import Protocol

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from . import errors
from .errors import InputError
from .response import SampledModes, sampled_modes

__all__ = [
    "BEARING_QUANTITIES", "COMPONENTS", "REACTION_QUANTITIES", "SECTION_QUANTITIES", "Deck", "History", "Line",
    "PiecewiseCubic", "Recovery", "Stations", "checked_damping", "damping_ratios", "rayleigh", "rayleigh_ratio",
]  # fmt: skip

COMPONENTS = ("y", "z", "roll")
"""What a shape consists of: lateral, vertical, twist."""

SECTION_QUANTITIES = {
    "displacement_y": "m", "displacement_z": "m", "rotation_x": "rad",
    "moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m", "shear_vertical": "N", "shear_lateral": "N",
}  # fmt: skip
REACTION_QUANTITIES = {"force_x": "N", "force_y": "N", "force_z": "N", "moment_x": "N m"}
"""What a deck recovers at a section and at a bearing line, with units."""
BEARING_QUANTITIES = {**REACTION_QUANTITIES, "moment_y": "N m", "moment_z": "N m"}
"""What a deck recovers of one bearing, with units; moments about the bearing itself."""


def rayleigh(ratio: float, frequencies_hz: Sequence[float]) -> tuple[float, float]:
    """Return alpha (1/s) and beta (s) that give one damping ratio at two frequencies (Hz).

    ``zeta = alpha / (2 omega) + beta omega / 2``; Section 2.4 of the paper asks 3 % at modes 1 and 5.
    """
    ratio = errors.number("damping.ratio", ratio, least=0.0, most=0.5)
    f1, f2 = errors.numbers("damping.frequencies_hz", frequencies_hz, count=2, above=0.0, unit="Hz")
    if f1 == f2:
        raise InputError("damping.frequencies_hz", list(frequencies_hz), "must be two different frequencies")
    w1, w2 = 2 * np.pi * f1, 2 * np.pi * f2
    return float(2 * ratio * w1 * w2 / (w1 + w2)), float(2 * ratio / (w1 + w2))


def rayleigh_ratio(alpha: float, beta: float, frequencies_hz: np.ndarray) -> np.ndarray:
    """Return the damping ratio at each frequency (Hz)."""
    omega = 2 * np.pi * np.asarray(frequencies_hz, dtype=float)
    return alpha / (2 * omega) + beta * omega / 2


def checked_damping(damping: Sequence[float] | float) -> Sequence[float] | float:
    """Return (alpha, beta) of Rayleigh or one ratio for every mode, refused where it is neither."""
    if np.isscalar(damping):
        return errors.number("deck.damping", damping, least=0.0)
    return errors.numbers("deck.damping", damping, count=2, least=0.0)


def damping_ratios(damping: Sequence[float] | float, frequencies_hz: np.ndarray) -> np.ndarray:
    """Return the ratio of each mode from (alpha, beta) of Rayleigh or from one ratio."""
    if np.isscalar(damping):
        return np.full(len(frequencies_hz), damping)
    return rayleigh_ratio(*damping, frequencies_hz)


@dataclass(frozen=True, eq=False)
class PiecewiseCubic:
    """Functions along the deck, cubic between edges.

    Attributes
    ----------
    edges : ndarray, shape (e + 1,)
        m, ascending.
    coefficients : ndarray, shape (e, 4, n, 3)
        Powers 0..3 of the local coordinate 0..1, for n functions of three components (y, z, roll), or of as many as there are.
    """

    edges: np.ndarray
    coefficients: np.ndarray

    def __call__(self, x: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Evaluate at x (m), shape (k,), or differentiate up to twice by x; returns shape (k, n, 3). Zero off the deck."""
        x = np.asarray(x, dtype=float)
        i = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.edges) - 2)
        h = np.diff(self.edges)[i]
        local = (x - self.edges[i]) / h
        factors = np.zeros((4, len(x)))
        for p in range(derivative, 4):
            factors[p] = perm(p, derivative) * local ** (p - derivative) / h**derivative
        factors[:, (x < self.edges[0] - 1e-9) | (x > self.edges[-1] + 1e-9)] = 0.0
        return np.einsum("pk,kpnc->knc", factors, self.coefficients[i])


@dataclass(frozen=True, eq=False)
class Line:
    """How one output follows from the deck's state and loads.

    Attributes
    ----------
    modal : ndarray, shape (modes,)
        Output per unit modal coordinate, S_m.
    influence : PiecewiseCubic
        Static influence line of the three load components.
    self_weight : float
        The output under the deck's own weight.
    """

    modal: np.ndarray
    influence: PiecewiseCubic
    self_weight: float


class Recovery(Protocol):
    """What a deck maker provides so that section forces and reactions can be recovered."""

    def section(self, quantity: str, x: float) -> Line | None:
        """Return the line of a displacement or section force at x, None where the deck has no such stiffness."""

    def reaction(self, quantity: str, support: float) -> Line | None:
        """Return the line of a reaction, None where that freedom is not held."""

    def bearing(self, number: int, quantity: str) -> Line | None:
        """Return the line of a force of one of the deck's `bearings`, from 1, None where it does not hold that freedom."""


@dataclass(frozen=True, eq=False)
class History:
    """Named time histories with units.

    Attributes
    ----------
    time : ndarray, shape (n,)
        s.
    values : dict of ndarray, shape (n,)
        By name; NaN where the deck has no such stiffness.
    units : dict of str
    """

    time: np.ndarray
    values: dict[str, np.ndarray]
    units: dict[str, str]
    where: str = ""

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.values:
            raise InputError("name", name, "no such history", errors.did_you_mean(name, self.values))
        return self.values[name]

    def to_frame(self):
        """Return a pandas DataFrame, one column a history, indexed by time."""
        import pandas as pd

        columns = {f"{name} ({self.units[name]})": v for name, v in self.values.items()}
        return pd.DataFrame(columns, index=pd.Index(self.time, name="t (s)"))

    def extreme(self, name: str) -> tuple[float, float]:
        """Return the value of largest magnitude, signed, and its time (s)."""
        values = self[name]
        i = int(np.argmax(np.abs(values)))
        return float(values[i]), float(self.time[i])


@dataclass(frozen=True, eq=False)
class Stations:
    """Loads that travel together along the deck: when each is on it, and the shapes it meets there.

    Attributes
    ----------
    starts : ndarray of int, shape (s,)
        First sample of each station on the deck.
    counts : ndarray of int, shape (s,)
        Number of samples on the deck.
    tables : tuple of (values, slopes)
        Shape values and slopes met, each shape (pairs, samples) over the (mode, component) pairs that are not zero.
    which : ndarray of int, shape (s,)
        Table of each station; stations that meet the grid alike share one.
    pairs : tuple of ndarray
        Mode and component of each pair, sorted by component.
    speed : float
        m/s.
    """

    starts: np.ndarray
    counts: np.ndarray
    tables: tuple[tuple[np.ndarray, np.ndarray], ...]
    which: np.ndarray
    pairs: tuple[np.ndarray, np.ndarray]
    speed: float

    @cached_property
    def components(self) -> tuple[slice, slice, slice]:
        """Where the pairs of each component stand."""
        return tuple(slice(*np.searchsorted(self.pairs[1], [c, c + 1])) for c in range(3))

    def alike(self, stations: np.ndarray) -> list[np.ndarray]:
        """Return which of some stations (numbers from 0) share a table: positions within `stations`, a group each."""
        which = self.which[stations]
        return [np.flatnonzero(which == table) for table in np.unique(which)]

    def modal_force(self, loads: Sequence[np.ndarray], modes: int, samples: int) -> np.ndarray:
        """Return the modal forces of all loads.

        Parameters
        ----------
        loads : sequence of ndarray, each shape (3 or 5, count)
            F_y, F_z (N), M_x about the deck axis (N m), and M_y, M_z if the load has them, while on the deck.
        modes, samples : int

        Returns
        -------
        ndarray, shape (modes, samples)
        """
        ordered = np.zeros((len(self.pairs[0]), samples))
        for members in self.alike(np.arange(len(self.starts))):
            values, slopes = self.tables[self.which[members[0]]]
            load = np.zeros((max(len(loads[s]) for s in members), len(members), values.shape[1]))
            for place, station in enumerate(members):
                load[: len(loads[station]), place, : loads[station].shape[1]] = loads[station]
            part = np.empty((len(ordered), *load.shape[1:]))
            for c, pairs in enumerate(self.components):
                np.multiply(values[pairs, None], load[c], out=part[pairs])
                if len(load) == 5 and c < 2:
                    # A couple does work on the slope: M_z on v', and M_y on theta_y = -w'.
                    part[pairs] += slopes[pairs, None] * (load[4] if c == 0 else -load[3])
            for place, station in enumerate(members):
                start, count = self.starts[station], self.counts[station]
                ordered[:, start : start + count] += part[:, place, :count]
        total = np.zeros((modes, samples))
        for pairs in self.components:
            total[self.pairs[0][pairs]] += ordered[pairs]
        return total

    def ordered(self, q: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Return modal coordinates and velocities, shape (modes, n), of each pair's mode: shape (2, pairs, n)."""
        return np.stack([q[self.pairs[0]], velocity[self.pairs[0]]])

    def motion(self, state: np.ndarray, stations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what stations that share a table meet: y, z, roll of the deck, and their total time derivatives.

        Parameters
        ----------
        state : ndarray, shape (2, pairs, n)
            See `ordered`.
        stations : ndarray of int, shape (s,)
            Numbers from 0; see `alike`.

        Returns
        -------
        moved, rate : ndarray, shape (3, s, samples of the longest)
        """
        values, slopes = self.tables[self.which[stations[0]]]
        count = int(self.counts[stations].max())
        values, climb = values[:, :count], self.speed * slopes[:, :count]
        q, velocity = _windows(state, self.starts[stations], count)
        moved, rate = np.empty((2, 3, len(stations), count))
        for c, p in enumerate(self.components):
            np.einsum("pt,pst->st", values[p], q[p], out=moved[c])
            np.einsum("pt,pst->st", values[p], velocity[p], out=rate[c])
            rate[c] += np.einsum("pt,pst->st", climb[p], q[p])
        return moved, rate


def _windows(values: np.ndarray, starts: np.ndarray, count: int) -> np.ndarray:
    """Return `count` samples from each start on, shape (..., starts, count): a view where starts are evenly spaced."""
    missing = int(starts.max()) + count - values.shape[-1]
    if missing > 0:
        values = np.concatenate([values, np.zeros((*values.shape[:-1], missing))], axis=-1)
    windows = sliding_window_view(values, count, axis=-1)
    steps = np.diff(starts)
    if len(starts) == 1 or (steps[0] > 0 and np.all(steps == steps[0])):
        return windows[..., starts[0] : starts[-1] + 1 : steps[0] if len(steps) else 1, :]
    return windows[..., starts, :]


@dataclass(frozen=True, eq=False)
class Deck:
    """A modal deck.

    Attributes
    ----------
    name : str
    length : float
        m.
    frequencies_hz, damping_ratios : ndarray, shape (m,)
    mode_names : tuple of str
        For instance ``vertical bending 1``.
    shapes : PiecewiseCubic
        Mass-normalised shapes of m modes (1/sqrt(kg), and 1/(m sqrt(kg)) for twist).
    supports : tuple of float
        Places of the bearing lines, m.
    recovery : Recovery or None
        How section forces and reactions follow; None where only modes are known.
    tracks : dict of float
        Distance of each named track to the left of the axis, m.
    width : float or None
        m.
    mass_per_metre : float or None
        kg/m.
    bearings : tuple of (x, y, z)
        Places of the single bearings, m; empty where only bearing lines are known.
    track_height : float
        Rails above the deck axis, m. A lateral wheel force then twists the deck, M_x = -h F_y, and the rail moves sideways by
        v - h theta.
    """

    name: str
    length: float
    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    mode_names: tuple[str, ...]
    shapes: PiecewiseCubic
    supports: tuple[float, ...] = ()
    recovery: Recovery | None = field(default=None, repr=False)
    tracks: dict[str, float] = field(default_factory=dict)
    width: float | None = None
    mass_per_metre: float | None = None
    bearings: tuple[tuple[float, float, float], ...] = ()
    track_height: float = 0.0

    def __post_init__(self) -> None:
        # Copies, since a deck is made once for many crossings.
        for name in ("frequencies_hz", "damping_ratios"):
            object.__setattr__(self, name, errors.frozen(np.array(getattr(self, name), dtype=float)))

    @property
    def has(self) -> dict[str, bool]:
        """Whether the deck moves in y, z and roll."""
        return dict(zip(COMPONENTS, np.any(self.shapes.coefficients != 0.0, axis=(0, 1, 2)).tolist(), strict=True))

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {"frequency (Hz)": self.frequencies_hz, "damping ratio": self.damping_ratios, "name": self.mode_names}
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self.mode_names) + 1, name="mode"))

    def track_offset(self, track: float | str) -> float:
        """Return a track's distance to the left of the axis, m, from its name or from the number itself."""
        if isinstance(track, str):
            if not self.tracks:
                raise InputError(
                    "train.track", track, "the deck names no tracks", "Give the distance from its axis, m, left positive"
                )
            errors.choice("train.track", track, self.tracks)
            return self.tracks[track]
        limit = self.width / 2 if self.width else None
        return errors.number("train.track", track, least=None if limit is None else -limit, most=limit, unit="m")

    def stations(self, delays: np.ndarray, speed: float, time_step: float, samples: int) -> Stations:
        """Prepare loads that are `delays` (m, shape (s,)) behind x = V t.

        A load counts while 0 <= x <= length, with a ten-thousandth of a step of tolerance, so that rounding does not decide
        whether a sample at the very end is on the deck.
        """
        advance = speed * time_step
        slack = 1e-4
        starts = np.ceil(np.asarray(delays) / advance - slack).astype(int)
        last = np.floor((np.asarray(delays) + self.length) / advance + slack).astype(int)
        counts = np.minimum(last, samples - 1) - starts + 1
        first = starts * advance - delays
        pairs, shapes = self._pairs
        keys = np.round(first / advance, 9)
        unique, which = np.unique(keys, return_inverse=True)
        places = [advance * (key + np.arange(counts[keys == key].max())) for key in unique]
        ends = np.cumsum([len(x) for x in places])[:-1]
        values, slopes = (
            np.split(np.ascontiguousarray(shapes(np.clip(np.concatenate(places), 0.0, self.length), d)[:, 0].T), ends, axis=1)
            for d in (0, 1)
        )
        return Stations(starts, np.maximum(counts, 0), tuple(zip(values, slopes, strict=True)), which, pairs, speed)

    @cached_property
    def _pairs(self) -> tuple[tuple[np.ndarray, np.ndarray], PiecewiseCubic]:
        """The (mode, component) pairs that are not zero, sorted by component, and their shapes as components of one function."""
        component, mode = np.nonzero(np.any(self.shapes.coefficients != 0.0, axis=(0, 1)).T)
        coefficients = np.ascontiguousarray(self.shapes.coefficients[:, :, None, mode, component])
        return (mode, component), PiecewiseCubic(self.shapes.edges, coefficients)

    def sampled(self, time_step: float) -> SampledModes:
        """Prepare the modes for one time step (s); they take modal forces and give coordinates and velocities."""
        return sampled_modes(2 * np.pi * self.frequencies_hz, self.damping_ratios, time_step)

    def acceleration(self, q: np.ndarray, velocity: np.ndarray, modal_force: np.ndarray) -> np.ndarray:
        """Return modal accelerations from the equation of motion."""
        omega = (2 * np.pi * self.frequencies_hz)[:, None]
        return modal_force - 2 * self.damping_ratios[:, None] * omega * velocity - omega**2 * q

    def recovered(self, line: Line | None, q: np.ndarray, modal_force: np.ndarray, static: np.ndarray) -> np.ndarray:
        """Return an output history: modal part plus the static correction of the modes left out.

        Parameters
        ----------
        line : Line or None
            NaN is returned for None.
        q, modal_force : ndarray, shape (modes, n)
        static : ndarray, shape (n,)
            The influence line under the present loads.
        """
        if line is None:
            return np.full(q.shape[1], np.nan)
        omega2 = (2 * np.pi * self.frequencies_hz) ** 2
        return line.modal @ q + static - (line.modal / omega2) @ modal_force
