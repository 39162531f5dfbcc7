r"""What the moving loads give at every instant, and just before and after one of them jumps.

An output that follows from the deck's state and loads (a `Line`) is

    S(t) = sum over modes of S_m (q_m + beta q_m' - f_m / omega_m^2) + sum over loads of eta(x) F,

with the influence line eta at the load's place x = V t - d. Where eta jumps or bends (an axle steps
on, leaves, or passes the section) S does so between two samples. There the modes go on from the
sample before, the forces F, which are smooth, are interpolated, and eta is taken on either side.

Where a rail spreads the loads, eta is the spread line, see `decks.Deck.under_load`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .coupling import Coupling, DeckState, ForcesAdded
from .decks import Deck, Line
from .response import moved_on
from .trains import AnyTrain

__all__ = ["MovingLoads", "static_extremes"]

_JUST = 1e-9
"""How far from a jump its two sides are taken, share of the deck."""
_LARGEST = 2**27
"""Bytes of the shapes that are taken at once."""
_KINK = 1e-3
"""Smallest change of slope that counts as a kink, share of the largest slope."""


@dataclass(frozen=True, eq=False)
class _Met:
    """What the deck meets just before and just after some instants.

    Attributes
    ----------
    time : ndarray, shape (n,)
        s; before and after in turn.
    modal : ndarray, shape (modes, n)
        q + beta q' - f / omega^2 of every mode.
    when : ndarray of int, shape (loads,)
        Which time each load on the deck belongs to.
    x : ndarray, shape (loads,)
        m.
    load : ndarray, shape (loads, 5)
        F_y, F_z, M_x about the deck axis, M_y, M_z.
    """

    time: np.ndarray
    modal: np.ndarray
    when: np.ndarray
    x: np.ndarray
    load: np.ndarray


@dataclass(frozen=True, eq=False)
class MovingLoads:
    """The loads of every station of a crossing at one iteration.

    Attributes
    ----------
    coupling : Coupling
    added : list of ndarray
        See `ForcesAdded`.
    known : DeckState or None
        The deck's state under them, where it is known already.
    """

    coupling: Coupling
    added: ForcesAdded
    known: DeckState | None = None

    @cached_property
    def loads(self) -> list[np.ndarray]:
        """The load of every station while it is on the deck, shape (3 or 5, count)."""
        return self.coupling.station_loads(self.added)

    @cached_property
    def _around(self) -> np.ndarray:
        """Loads from a sample before each station's first to one behind its last.

        Shape (stations, 3 or 5, longest); a station that ends earlier keeps its last load.
        """
        found = self.coupling.station_loads(self.added, margin=1)
        result = np.empty((len(found), len(found[0]), max(load.shape[1] for load in found)))
        for row, load in zip(result, found, strict=True):
            row[:, : load.shape[1]] = load
            row[:, load.shape[1] :] = load[:, -1:]
        return result

    def of_lines(self, lines: Sequence[Line]) -> np.ndarray:
        """Return what influence lines give under the loads of every instant, standing still.

        Shape (lines, n).
        """
        coupling, deck = self.coupling, self.coupling.deck
        lines = [deck.under_load(line) for line in lines]
        total = np.zeros((len(lines), len(coupling.time)))
        stations, speed = coupling.loads, coupling.settings.speed
        for which in range(len(stations.tables)):
            # Stations that meet the samples alike share the line's values.
            members = np.flatnonzero(stations.which == which)
            longest = members[np.argmax(stations.counts[members])]
            instants = coupling.time[stations.starts[longest] :][: stations.counts[longest]]
            x = speed * instants - coupling.load_delays[longest]
            x = np.clip(x, -deck.reach, deck.length + deck.reach)
            values = np.array([line.influence(x)[:, 0].T for line in lines])
            couples = len(self.loads[members[0]]) == 5
            if couples:
                slopes = np.array([line.influence(x, 1)[:, 0].T for line in lines])
            for station in members:
                load, count = self.loads[station], stations.counts[station]
                part = total[:, stations.starts[station] :][:, :count]
                for c in range(3):
                    if load[c].any():
                        part += values[:, c, :count] * load[c]
                if couples:
                    part += slopes[:, 0, :count] * load[4] - slopes[:, 1, :count] * load[3]
        return total

    @cached_property
    def state(self) -> DeckState:
        """The deck's modal state under these loads."""
        return self.known or self.coupling.deck_state(self.loads)

    def at_jumps(self, line: Line) -> tuple[np.ndarray, np.ndarray]:
        """Return an output just before and just after every instant at which it may jump or bend.

        Returns
        -------
        time, values : ndarray, shape (2 instants,)
            s, and the output.
        """
        deck = self.coupling.deck
        line = deck.under_load(line)
        met = [self._met(float(x)) for x in _breaks(line, deck.length, deck.reach)]
        values = [line.modal @ each.modal + self._static_at(line, each) for each in met]
        return np.concatenate([each.time for each in met]), np.concatenate(values)

    def _static_at(self, line: Line, met: _Met) -> np.ndarray:
        """Return what an influence line gives under the loads of some instants, shape (n,)."""
        part = np.einsum("kc,kc->k", line.influence(met.x)[:, 0], met.load[:, :3])
        if np.any(met.load[:, 3:]):
            slope = line.influence(met.x, 1)[:, 0]
            part += slope[:, 0] * met.load[:, 4] - slope[:, 1] * met.load[:, 3]
        return np.bincount(met.when, part, len(met.time))

    @cached_property
    def _known(self) -> dict[float, _Met]:
        return {}

    def _met(self, place: float) -> _Met:
        """Return the loads and the modes' part when any load passes a place (m)."""
        if place not in self._known:
            self._known[place] = self._met_at(place)
        return self._known[place]

    def _met_at(self, place: float) -> _Met:
        coupling, deck = self.coupling, self.coupling.deck
        speed, step = coupling.settings.speed, coupling.settings.time_step
        instants = np.unique((coupling.load_delays + place) / speed)
        first, last = coupling.time[[0, -1]]
        instants = np.repeat(instants[(instants >= first) & (instants <= last)], 2)
        just = _JUST * deck.length / speed
        time = instants + np.tile([-just, just], len(instants) // 2)
        when, station = self._on_deck(time)
        x = speed * time[when] - coupling.load_delays[station]
        # The sample before, and the share of the step since.
        since = instants / step + coupling.settings.before
        k = np.clip(since.astype(int), 0, len(coupling.time) - 2)
        s = np.clip(since - k, 0.0, 1.0)
        load = self._load_at(station, k[when], s[when])
        omega = 2 * np.pi * deck.frequencies_hz[:, None]
        if not _steps_on(deck, place):
            # The modes pass a section smoothly.
            state = self.state
            q = _hermite(state.q, state.velocity * step, k, s)
            rate, force = (_between(v, k, s) for v in (state.velocity, state.modal_force))
        else:
            # Their forces jump: from the sample on they go on under those of before the jump.
            force = self._modal_force(load, x, when, len(time))
            q, rate = self._gone_on(k, s * step, np.repeat(force[:, ::2], 2, axis=1))
        modal = q + deck.internal_damping * rate - force / omega**2
        return _Met(time, modal, when, x, load)

    def _on_deck(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return which loads are on the deck at some times: numbers of times, and of stations."""
        front, deck = self.coupling.settings.speed * time, self.coupling.deck
        order = np.argsort(self.coupling.load_delays, kind="stable")
        delays = self.coupling.load_delays[order]
        first = np.searchsorted(delays, front - (deck.length + deck.reach))
        count = np.searchsorted(delays, front + deck.reach, side="right") - first
        when = np.repeat(np.arange(len(time)), count)
        within = np.arange(len(when)) - np.repeat(np.cumsum(count) - count, count)
        return when, order[np.repeat(first, count) + within]

    def _gone_on(
        self, k: np.ndarray, span: np.ndarray, force: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return q and q' a while (s) after samples k, under forces that end at `force`."""
        state, deck = self.state, self.coupling.deck
        start = state.q[:, k], state.velocity[:, k]
        forces = state.modal_force[:, k], force
        return moved_on(2 * np.pi * deck.frequencies_hz, deck.damping_ratios, start, forces, span)

    def _load_at(self, station: np.ndarray, k: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return the loads of stations between samples k and k + 1, at the share s of the way.

        Shape (n, 5).
        """
        around, first = self._around, self.coupling.loads.starts[station] - 1
        before, after = (
            around[station, :, np.clip(i - first, 0, around.shape[2] - 1)] for i in (k, k + 1)
        )
        load = np.zeros((len(station), 5))
        load[:, : around.shape[1]] = before + s[:, None] * (after - before)
        return load

    def _modal_force(
        self, load: np.ndarray, x: np.ndarray, when: np.ndarray, instants: int
    ) -> np.ndarray:
        """Return the modal forces of loads at places x (m), summed up by instant (modes, n)."""
        deck = self.coupling.deck
        shapes, result = deck.under_rail(deck.shapes), np.zeros((deck.coordinates, instants))
        together = max(_LARGEST // (48 * deck.coordinates), 1)
        for first in range(0, len(x), together):
            some = slice(first, first + together)
            part = np.einsum("kmc,kc->mk", shapes(x[some]), load[some, :3])
            if np.any(load[some, 3:]):
                slope = shapes(x[some], 1)
                part += (slope[:, :, 0] * load[some, 4:] - slope[:, :, 1] * load[some, 3:4]).T
            for own, shares in zip(result, part, strict=True):
                own += np.bincount(when[some], shares, instants)
        return result


def _between(values: np.ndarray, k: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return values between samples k and k + 1, at the share s of the way, shape (..., n)."""
    return values[..., k] + s * (values[..., k + 1] - values[..., k])


def _hermite(values: np.ndarray, rates: np.ndarray, k: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the cubic through samples k and k + 1 with their rates (per step), as `_between`."""
    rise = values[..., k + 1] - values[..., k]
    bend = (1.0 - s) * (rates[..., k] - rise) - s * (rates[..., k + 1] - rise)
    return values[..., k] + s * rise + s * (1.0 - s) * bend


def _steps_on(deck: Deck, place: float) -> bool:
    """Whether a load at a place (m) steps onto the deck, or off it: all at once or in part."""
    ends = [end + offset for end in (0.0, deck.length) for offset, _ in deck.parts]
    if deck.rail is None:
        return not 0.0 < place < deck.length
    return any(abs(place - end) <= _JUST * deck.length for end in ends)


def _breaks(line: Line, length: float, reach: float = 0.0) -> np.ndarray:
    """Return the places, m, where an influence line jumps or bends, and where it ends."""
    influence = line.influence
    h = np.diff(influence.edges)[:, None]
    powers = np.arange(4.0)[:, None, None]
    start = influence.coefficients[:, 0, 0], influence.coefficients[:, 1, 0] / h
    end = (
        influence.coefficients.sum(axis=1)[:, 0],
        (powers * influence.coefficients).sum(axis=1)[:, 0] / h,
    )
    bends = np.zeros(len(h) - 1, dtype=bool)
    for before, after, least in zip(end, start, (1e-6, _KINK), strict=True):
        size = np.abs(after).max(axis=0)
        bends |= np.any(np.abs(after[1:] - before[:-1]) > least * size + 1e-300, axis=1)
    return np.concatenate([[-reach], influence.edges[1:-1][bends], [length + reach]])


def static_extremes(train: AnyTrain, track_offset: float, line: Line) -> tuple[float, float]:
    """Return the smallest and largest value while the static axle loads move over, V -> 0.

    Zero at most and zero at least. Places of the train: steps of 1/500 of the deck, and every
    axle just before and behind every end of the line's pieces that may be a kink or a jump, so
    that peaks are met exactly. A rail on a bed rounds them: steps are then of 1/2000, and peaks met
    to 1e-4.

    Parameters
    ----------
    train : AnyTrain
    track_offset : float
        m.
    line : Line
        Its influence line runs along the deck, and beside it where a rail spreads loads; see
        `Deck.under_load`.
    """
    edges, axles = line.influence.edges, train.placed_axles
    start, end = edges[[0, -1]]
    spread = start < -1e-6
    delays = np.array([axle.delay for axle in axles])
    loads = -np.array(
        [
            [0.0, axle.static_load, sum(w.static_load * (track_offset + w.y) for w in axle.wheels)]
            for axle in axles
        ]
    )
    grid = np.linspace(start, end, 2001 if spread else 501)
    just = _JUST * (end - start)
    near = np.concatenate([edges - just, edges + just])
    near = near[(near >= start) & (near <= end)]
    # The peaks of the line itself decide: only its kinks next to the largest values matter.
    size = np.abs(line.influence(near)[:, 0, 1:]).max(axis=1)
    near = near[np.argsort(size)[-8:]]
    if spread:  # on sleepers every kink and jump has become three
        breaks = _breaks(line, end + start, -start)[1:-1]
        near = np.concatenate([near, breaks - just, breaks + just])
    step = grid[1] - start
    first = np.arange(start, end + delays.max() + step, step)
    first = np.unique(np.concatenate([first, (delays[:, None] + near).ravel()]))
    total = np.zeros(len(first))
    for delay, load in zip(delays, loads, strict=True):
        x = first - delay
        on = (x >= start) & (x <= end)
        total[on] += line.influence(x[on])[:, 0] @ load
    noise = 1e-12 * float(np.abs(loads).max() * np.abs(line.influence(grid)).max())
    low, high = float(total.min()), float(total.max())
    return (low if low < -noise else 0.0), (high if high > noise else 0.0)
