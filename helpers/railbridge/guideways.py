r"""What wheels run over: motions along a rail line, and the loads that travel on it.

A wheel at y, riding on the deck, moves by ``w + y theta``, sideways by ``v - h theta`` where the
rails lie h above the axis, and its support velocity is the total derivative ``w q' + V w' q``: the
second, convective term is the climb along the deflected deck.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import comb, perm

import numpy as np
from numpy.lib.stride_tricks import as_strided

from . import errors
from .contacts import Rail
from .errors import InputError, brief

__all__ = ["COMPONENTS", "Guideway", "PiecewiseCubic", "Stations"]

COMPONENTS = ("y", "z", "roll")
"""What a shape consists of: lateral, vertical, twist."""


_LARGEST = 2**28
"""Bytes of the windows that are described at once."""
_LONG = 8
"""Places in a row within one piece from which on they are taken together."""


@dataclass(frozen=True, eq=False)
class PiecewiseCubic:
    """Functions along the deck, cubic between edges.

    Attributes
    ----------
    edges : ndarray, shape (e + 1,)
        m, ascending.
    coefficients : ndarray, shape (e, 4, n, 3)
        Powers 0..3 of the local coordinate 0..1, for n functions of three components (y, z, roll),
        or of as many as there are.
    """

    __repr__ = brief

    edges: np.ndarray
    coefficients: np.ndarray

    @cached_property
    def under_rails(self) -> dict[Rail, PiecewiseCubic]:
        """What they become under a rail, kept for the last one; see `Guideway.under_rail`."""
        return {}

    def __call__(self, x: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return values at x (m), shape (k,), or their first or second derivative by x.

        Shape (k, n, 3). Zero off the deck.
        """
        x = np.asarray(x, dtype=float)
        i = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.edges) - 2)
        h = np.diff(self.edges)[i]
        local = (x - self.edges[i]) / h
        factors = np.zeros((4, len(x)))
        for p in range(derivative, 4):
            factors[p] = perm(p, derivative) * local ** (p - derivative) / h**derivative
        factors[:, (x < self.edges[0] - 1e-9) | (x > self.edges[-1] + 1e-9)] = 0.0
        ends = np.append(np.flatnonzero(np.diff(i)) + 1, len(x))
        if len(x) < _LONG * len(ends):
            return np.einsum("pk,kpnc->knc", factors, self.coefficients[i])
        # Places in a row within one piece are one product of matrices.
        own = self.coefficients.reshape(len(self.coefficients), 4, -1)
        result = np.empty((own.shape[2], len(x)))
        for first, last in zip([0, *ends[:-1].tolist()], ends.tolist(), strict=True):
            np.matmul(own[i[first]].T, factors[:, first:last], out=result[:, first:last])
        return result.T.reshape(len(x), *self.coefficients.shape[2:])

    def cut(self, edges: np.ndarray) -> PiecewiseCubic:
        """Return the same functions between more edges.

        Parameters
        ----------
        edges : ndarray, shape (e + 1,)
            m, ascending; all of its own are among them.
        """
        middles = (edges[1:] + edges[:-1]) / 2
        i = np.clip(np.searchsorted(self.edges, middles) - 1, 0, len(self.edges) - 2)
        h = np.diff(self.edges)[i]
        # Powers of s = start + length t in powers of t.
        start, length = (edges[:-1] - self.edges[i]) / h, np.diff(edges) / h
        shifted = np.zeros((4, 4, len(i)))
        for q in range(4):
            for p in range(q, 4):
                shifted[q, p] = comb(p, q) * start ** (p - q) * length**q
        return PiecewiseCubic(edges, np.einsum("qpe,epnc->eqnc", shifted, self.coefficients[i]))


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
        Shape values and slopes met, each shape (pairs, samples) over the (mode, component) pairs
        that are not zero.
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
        """Return which of some stations (numbers from 0) share a table.

        Positions within `stations`, a group each.
        """
        which = self.which[stations]
        return [np.flatnonzero(which == table) for table in np.unique(which)]

    def modal_force(self, loads: Sequence[np.ndarray], modes: int, samples: int) -> np.ndarray:
        """Return the modal forces of all loads.

        Parameters
        ----------
        loads : sequence of ndarray, each shape (3 or 5, count)
            F_y, F_z (N), M_x about the deck axis (N m), and M_y, M_z if the load has them, while on
            the deck.
        modes, samples : int

        Returns
        -------
        ndarray, shape (modes, samples)
        """
        mode = self.pairs[0]
        ordered = np.zeros((len(mode), samples))
        # One place for all products: memory asked for anew costs more than the product itself.
        room = np.empty((len(mode), max((load.shape[1] for load in loads), default=0)))
        for station, load in enumerate(loads):
            values, slopes = self.tables[self.which[station]]
            start, count = self.starts[station], load.shape[1]
            met, part = ordered[:, start : start + count], room[:, :count]
            for c, pairs in enumerate(self.components):
                if pairs.start == pairs.stop:
                    continue
                if load[c].any():
                    met[pairs] += np.multiply(values[pairs, :count], load[c], out=part[pairs])
                if len(load) == 5 and c < 2:
                    # A couple does work on the slope: M_z on v', and M_y on theta_y = -w'.
                    couple = load[4] if c == 0 else -load[3]
                    met[pairs] += np.multiply(slopes[pairs, :count], couple, out=part[pairs])
        if self._as_they_are and len(mode) == modes:
            return ordered
        total = np.zeros((modes, samples))
        for pairs in self.components:
            total[mode[pairs]] += ordered[pairs]
        return total

    @cached_property
    def _as_they_are(self) -> bool:
        """Whether the pairs are the modes in their own order."""
        return np.array_equal(self.pairs[0], np.arange(len(self.pairs[0])))

    def ordered(self, *values: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return modal coordinates or velocities of each pair's mode, each shape (pairs, n)."""
        mode = self.pairs[0]
        if self._as_they_are:
            return tuple(v[: len(mode)] for v in values)
        return tuple(v[mode] for v in values)

    def motion(
        self, state: tuple[np.ndarray, np.ndarray], stations: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return what stations that share a table meet.

        y, z and roll of the deck, and their total time derivatives.

        Parameters
        ----------
        state : (coordinates, velocities), each shape (pairs, n)
            See `ordered`.
        stations : ndarray of int, shape (s,)
            Numbers from 0; see `alike`.

        Returns
        -------
        moved, rate : ndarray, shape (3, s, samples of the longest)
        """
        values, slopes = self.tables[self.which[stations[0]]]
        count = int(self.counts[stations].max())
        values, slopes = values[:, :count], slopes[:, :count]
        moved, rate = np.zeros((2, 3, len(stations), count))
        together = max(_LARGEST // (16 * len(values) * max(count, 1)), 1)
        for first in range(0, len(stations), together):
            some = slice(first, first + together)
            q, velocity = (_windows(v, self.starts[stations[some]], count) for v in state)
            for c, p in enumerate(self.components):
                if p.start == p.stop:
                    continue
                np.einsum("pt,pst->st", values[p], q[p], out=moved[c, some])
                np.einsum("pt,pst->st", slopes[p], q[p], out=rate[c, some])
                rate[c, some] *= self.speed
                rate[c, some] += np.einsum("pt,pst->st", values[p], velocity[p])
        return moved, rate


def _windows(values: np.ndarray, starts: np.ndarray, count: int) -> np.ndarray:
    """Return `count` samples from each start on, shape (..., starts, count).

    A view where starts are evenly spaced. No larger array is described than the result: one beyond
    2^31 bytes, even if never made, stops a 32-bit Python.
    """
    missing = int(starts.max()) + count - values.shape[-1]
    if missing > 0:
        values = np.concatenate([values, np.zeros((*values.shape[:-1], missing))], axis=-1)
    steps = np.diff(starts)
    if len(starts) == 1 or (steps[0] > 0 and np.all(steps == steps[0])):
        *outer, sample = values.strides
        step = int(steps[0]) if len(steps) else 1
        return as_strided(
            values[..., int(starts[0]) :],
            (*values.shape[:-1], len(starts), count),
            (*outer, step * sample, sample),
            writeable=False,
        )
    return values[..., starts[:, None] + np.arange(count)]


@dataclass(frozen=True, eq=False, kw_only=True)
class Guideway:
    """What carries a track: how the deck axis moves along the rail line, and where the rails lie.

    Attributes
    ----------
    name : str
    length : float
        m.
    shapes : PiecewiseCubic
        Motion of the deck axis for each of its coordinates: y, z (m), roll (rad).
    tracks : dict of float
        Distance of each named track to the left of the axis, m.
    width : float or None
        m.
    track_height : float
        Rails above the deck axis, m. A lateral wheel force then twists the deck, M_x = -h F_y, and
        the rail moves sideways by v - h theta.
    rail : Rail or None
        How the rails spread a wheel's load and carry on over the deck's ends. None: a wheel loads
        the deck at its own place, and only while it is on the deck.

    Raises
    ------
    InputError
        A rail that spreads a load over more than a third of the deck: d or 1 / b is then probably
        not in m. Spans are not asked, since two bearing lines of a pier may stand close together.
    """

    __repr__ = brief

    name: str
    length: float
    shapes: PiecewiseCubic
    tracks: dict[str, float] = field(default_factory=dict)
    width: float | None = None
    track_height: float = 0.0
    rail: Rail | None = None

    def __post_init__(self) -> None:
        if self.rail is None:
            return
        rail = errors.instance("rail", self.rail, Rail)
        if rail.length > self.length / 3:
            field = "spread" if rail.spread is not None else "foundation"
            allowed = f"spreads a load over {rail.length:.3g} m to either side, "
            allowed += f"must be at most a third of the deck, {self.length / 3:.3g} m"
            remedy = "Give m, N m2 and N/m2; sleepers are some 0.6 m apart"
            raise InputError(f"rail.{field}", getattr(rail, field), allowed, remedy)

    @property
    def coordinates(self) -> int:
        """How many coordinates describe its motion."""
        return self.shapes.coefficients.shape[2]

    @cached_property
    def has(self) -> dict[str, bool]:
        """Whether the deck moves in y, z and roll."""
        return dict(
            zip(
                COMPONENTS,
                np.any(self.shapes.coefficients != 0.0, axis=(0, 1, 2)).tolist(),
                strict=True,
            )
        )

    def track_offset(self, track: float | str) -> float:
        """Return a track's distance to the left of the axis, m, from its name or as given."""
        if isinstance(track, str):
            if not self.tracks:
                raise InputError(
                    "track_offset",
                    track,
                    "the deck names no tracks",
                    "Give the distance from its axis, m, left positive",
                )
            errors.choice("track_offset", track, self.tracks)
            return self.tracks[track]
        if not self.width:
            return errors.number("track_offset", track, unit="m")
        return errors.place("track_offset", track, (-self.width / 2, self.width / 2))

    # ---- the rail

    @property
    def reach(self) -> float:
        """How far before and behind the deck a load still counts, m; 0 without a rail."""
        return 0.0 if self.rail is None else self.rail.reach

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Where a load acts on the deck at once, m beside it, and which share; see `Rail.parts`."""
        return ((0.0, 1.0),) if self.rail is None else self.rail.parts

    def under_rail(self, function: PiecewiseCubic) -> PiecewiseCubic:
        """Return what a function along the deck is for a load on the rail: spread, or as it is."""
        if self.rail is None:
            return function
        known = function.under_rails
        if self.rail not in known:
            known.clear()  # one is kept: a slider may meet many rails
            own = self.rail.under(function.edges, function.coefficients)
            known[self.rail] = PiecewiseCubic(*own)
        return known[self.rail]

    # ---- loads that travel

    def samples_within(
        self, delays: np.ndarray, advance: float, samples: int, before: int, beyond: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return first samples and numbers of samples with a load on the deck or near it.

        A load counts while -beyond <= x <= length + beyond, with a ten-thousandth of a step of
        tolerance, so that rounding does not decide whether a sample at the very end is on the deck.

        Parameters
        ----------
        delays : ndarray, shape (s,)
            m behind x = V t.
        advance : float
            m a sample.
        samples, before : int
            In all, and before t = 0.
        beyond : float
            m.
        """
        slack = 1e-4
        delays = np.asarray(delays)
        starts = np.ceil((delays - beyond) / advance - slack).astype(int) + before
        behind = (delays + (self.length + beyond)) / advance
        last = np.floor(behind + slack).astype(int) + before
        return starts, np.minimum(last, samples - 1) - starts + 1

    def stations(
        self, delays: np.ndarray, speed: float, time_step: float, samples: int, before: int = 0
    ) -> Stations:
        """Prepare loads that are `delays` (m, shape (s,)) behind x = V t.

        A load counts while it is on the deck, and on the rail as far beside it as `reach`; see
        `samples_within`.
        """
        advance = speed * time_step
        starts, counts = self.samples_within(delays, advance, samples, before, self.reach)
        first = (starts - before) * advance - delays + self.reach
        pairs, shapes = self._pairs
        keys = np.round(first / advance, 9)
        unique, which = np.unique(keys, return_inverse=True)
        places = [advance * (key + np.arange(counts[keys == key].max())) for key in unique]
        ends = np.cumsum([len(x) for x in places])[:-1]
        along = np.concatenate(places) - self.reach
        along = np.clip(along, -self.reach, self.length + self.reach)
        values, slopes = (
            np.split(np.ascontiguousarray(shapes(along, d)[:, 0].T), ends, axis=1) for d in (0, 1)
        )
        return Stations(
            starts,
            np.maximum(counts, 0),
            tuple(zip(values, slopes, strict=True)),
            which,
            pairs,
            speed,
        )

    @cached_property
    def _pairs(self) -> tuple[tuple[np.ndarray, np.ndarray], PiecewiseCubic]:
        """The (mode, component) pairs that are not zero, sorted by component.

        And their shapes, as met on the rail, as components of one function.
        """
        met = self.under_rail(self.shapes)
        found = np.nonzero(np.any(met.coefficients != 0.0, axis=(0, 1)).T)
        component, mode = map(np.ascontiguousarray, found)
        coefficients = np.ascontiguousarray(met.coefficients[:, :, None, mode, component])
        return (mode, component), PiecewiseCubic(met.edges, coefficients)
