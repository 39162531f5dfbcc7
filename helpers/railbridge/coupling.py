r"""The fixed point of train and deck: the paper's five steps.

With forces F and deck motion w,

    F_0      wheel forces on a rigid deck (irregularity alone)
    w_i      deck motion under the loads made of F_i
    F_(i+1)  = F_0 + response of the train to w_i met at each wheel (the "equivalent irregularity" is r + w_i)

repeated until F no longer changes. Because the train is linear, only the response to the deck's own motion is run again,
and only while a car is on the deck. The deck is always felt by each wheel at its own place; `loads` decides how the forces
act on the deck: as true wheel loads, as two resultants a car (per bogie), or as one resultant at the car's middle (the
paper).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .decks import Deck, Stations
from .errors import frozen
from .response import SampledModes, SampledResponse
from .settings import Settings
from .tracks import Track
from .trains import AxleTrain, Train
from .vehicles import Vehicle

__all__ = ["Coupling", "DeckState", "FixedPoint", "iterate", "prepare"]

Delta = list[np.ndarray]
"""What the deck's motion adds to each car's wheel forces while it is on the deck, N, each shape (2 wheels, n)."""


@dataclass(frozen=True, eq=False)
class DeckState:
    """The deck's modal coordinates, velocities and forces under one set of wheel forces, each shape (modes, samples)."""

    q: np.ndarray
    velocity: np.ndarray
    modal_force: np.ndarray


@dataclass(frozen=True, eq=False)
class Coupling:
    """One train, one deck and one way of loading, ready for any number of passes.

    Attributes
    ----------
    train : Train or AxleTrain
    deck : Deck
    settings : Settings
    time : ndarray, shape (n,)
        s; zero when the first axle enters.
    rigid : list of ndarray, shape (2 wheels, n) for each car
        Wheel forces on a rigid deck without their static part, N.
    static : list of ndarray, shape (2 wheels,) for each car
    windows : list of slice
        Samples while each car is on the deck.
    axles : Stations
        Every axle, where the deck is felt.
    axle_of : list of list of int
        The axle of each wheel of each car.
    loads : Stations
        Every load station, where the deck is loaded.
    load_delays : ndarray, shape (stations,)
        m behind the first axle.
    load_matrices : list of ndarray, shape (stations of the car, 3 or 5, 2 wheels)
        From wheel forces to station loads about the deck axis.
    modes : SampledModes
        The deck's.
    vehicles : list of SampledResponse
        One for each kind of vehicle.
    """

    train: Train | AxleTrain
    deck: Deck
    settings: Settings
    time: np.ndarray
    rigid: list[np.ndarray]
    static: list[np.ndarray]
    windows: list[slice]
    axles: Stations
    axle_of: list[list[int]]
    loads: Stations
    load_delays: np.ndarray
    load_matrices: list[np.ndarray]
    modes: SampledModes
    vehicles: list[SampledResponse]

    def at_rest(self) -> Delta:
        """Return the first guess: the deck adds nothing."""
        return [np.zeros((len(r), w.stop - w.start)) for r, w in zip(self.rigid, self.windows, strict=True)]

    def station_loads(self, delta: Delta) -> list[np.ndarray]:
        """Return the load of every station while it is on the deck, each shape (3 or 5, count)."""
        result, station = [], 0
        for rigid, static, window, matrices, own in zip(
            self.rigid, self.static, self.windows, self.load_matrices, delta, strict=True
        ):
            forces = rigid[:, window] + static[:, None] + own
            for matrix in matrices:
                start = int(self.loads.starts[station]) - window.start
                result.append(matrix @ forces[:, start : start + int(self.loads.counts[station])])
                station += 1
        return result

    def deck_state(self, loads: list[np.ndarray]) -> DeckState:
        """Steps 1 and 4: the deck under the loads of every station."""
        force = self.loads.modal_force(loads, len(self.deck.frequencies_hz), len(self.time))
        return DeckState(*map(frozen, (*self.modes(force), force)))

    def support_input(self, state: DeckState, cars: list[int]) -> np.ndarray:
        """Step 2: what the deck's motion w adds to the input of cars of one kind, k w + c w', shape (2 wheels, cars, n)."""
        vehicle, axle_of = self.train.vehicles[cars[0]], np.array([self.axle_of[c] for c in cars])
        first = np.array([self.windows[c].start for c in cars])
        longest = max(self.windows[c].stop - self.windows[c].start for c in cars)
        u = np.zeros((2 * len(vehicle.contacts), len(cars), longest))
        deck = self.axles.ordered(state.q, state.velocity)
        # All wheels of one axle meet the same motion, and so do axles of several cars that share a table.
        for wheels in (np.flatnonzero(axle_of[0] == axle) for axle in dict.fromkeys(axle_of[0])):
            axles = axle_of[:, wheels[0]]
            for places in self.axles.alike(axles):
                moved, rate = self.axles.motion(deck, axles[places])
                met = [self._wheel_input(vehicle, i, moved, rate) for i in wheels]
                starts, counts = self.axles.starts[axles[places]] - first[places], self.axles.counts[axles[places]]
                for i, (lateral, vertical) in zip(wheels, met, strict=True):
                    for n, (place, start, count) in enumerate(zip(places, starts, counts, strict=True)):
                        u[2 * i, place, start : start + count] = lateral[n, :count]
                        u[2 * i + 1, place, start : start + count] = vertical[n, :count]
        return u

    def _wheel_input(self, vehicle: Vehicle, i: int, moved: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return k w + c w' of one wheel (from 0), lateral and vertical, where its axle meets this motion of the deck."""
        k, c = vehicle.contact_stiffness[i], vehicle.contact_damping[i]
        vertical = k[1] * moved[1] + c[1] * rate[1]
        if self.settings.feedback != "all":
            return np.zeros_like(vertical), vertical
        roll = [k[d] * moved[2] + c[d] * rate[2] for d in (0, 1)]
        vertical += (self.settings.track_offset + vehicle.contacts[i].y) * roll[1]
        return k[0] * moved[0] + c[0] * rate[0] - self.deck.track_height * roll[0], vertical

    def train_pass(self, state: DeckState) -> Delta:
        """Steps 2 and 3: the wheel forces due to the deck's motion, each car while it is on the deck."""
        delta = self.at_rest()
        for (_, cars), system in zip(self.train.groups(), self.vehicles, strict=True):
            u = self.support_input(state, list(cars))
            forces = system(u)
            forces -= u
            for i, car in enumerate(cars):
                delta[car] = forces[:, i, : delta[car].shape[1]]
        return delta

    def wheel_forces(self, delta: Delta, felt: DeckState | None) -> np.ndarray:
        """Return all wheel forces on the deck, N, shape (wheels, 2, n): lateral, vertical; static part included.

        `felt` is the deck's motion that `delta` answers to: behind the deck a car's motion decays freely on the track. None:
        a rigid deck.
        """
        return np.concatenate([self.car_wheel_forces(car, delta, felt) for car in range(len(self.rigid))])

    def car_wheel_forces(self, car: int, delta: Delta, felt: DeckState | None) -> np.ndarray:
        """Return what `wheel_forces` gives for one car (from 0), shape (its wheels, 2, n)."""
        total = self.rigid[car] + self.static[car][:, None]
        window = self.windows[car]
        total[:, window] += delta[car]
        if felt is not None and window.stop < total.shape[1] and len(self.train.groups()) > 0:
            total[:, window.stop :] += self.decay(felt, car)
        return total.reshape(-1, 2, total.shape[1])

    def decay(self, state: DeckState, car: int) -> np.ndarray:
        """Return how one car's wheel forces decay on the level track behind the deck, shape (2 wheels, samples after it).

        The car's whole time on the deck is run once more with the track behind added.
        """
        rest = len(self.time) - self.windows[car].stop
        u = self.support_input(state, [car])
        longer = np.concatenate([u, np.zeros((*u.shape[:2], rest))], axis=2)
        kind = next(i for i, (_, cars) in enumerate(self.train.groups()) if car in cars)
        return self.vehicles[kind](longer)[:, 0, u.shape[2] :]

    def body_accelerations(self, state: DeckState) -> list[np.ndarray]:
        """Return what the deck's motion adds to every car body's accelerations, m/s2, each shape (6, samples).

        See `Vehicle.body_system`. Like `decay`, each car runs on over the level track behind the deck.
        """
        result = []
        for car, (vehicle, window) in enumerate(zip(self.train.vehicles, self.windows, strict=True)):
            system, direct = vehicle.body_system()
            met = self.support_input(state, [car])[:, 0]
            u = np.zeros((len(met), len(self.time) - window.start))
            u[:, : met.shape[1]] = met
            added = np.zeros((6, len(self.time)))
            added[:, window.start :] = system.sampled(self.settings.time_step)(u) + direct @ u
            result.append(added)
        return result

    def change(self, new: Delta, old: Delta) -> float:
        """Return the largest, over wheels and directions, of rms(new - old) / rms(force - static) while on the deck.

        A force that varies by less than a millionth of the largest static wheel load is measured by that instead, since
        round-off never settles. Not finite where the forces are not.
        """
        floor = max(1e-6 * max(np.abs(s).max() for s in self.static), np.finfo(float).tiny)
        worst = 0.0
        for rigid, window, a, b in zip(self.rigid, self.windows, new, old, strict=True):
            moved, size = (np.sqrt(np.einsum("ij,ij->i", x, x) / x.shape[1]) for x in (a - b, rigid[:, window] + a))
            # Forces that have grown beyond all numbers give NaN, which max() would take for no change at all.
            worst = float(np.maximum(worst, np.max(moved / np.maximum(size, floor))))
        return worst


def prepare(train: Train | AxleTrain, deck: Deck, track: Track, s: Settings) -> Coupling:
    """Compute everything that all passes share: rigid-deck forces, places on the deck, sampled systems."""
    advance = s.speed * s.time_step
    samples = int(np.ceil((deck.length + train.length) / advance + s.tail / s.time_step)) + 1
    axle_delays, axle_of, windows, matrices, load_delays = [], [], [], [], []
    for car, centre in enumerate(train.centres):
        # Left and right wheels of an axle differ by rounding at most; they must share one station.
        wheels = [round(w.delay, 9) for w in train.wheels if w.car == car + 1]
        places = sorted(set(wheels))
        axle_of.append([len(axle_delays) + places.index(delay) for delay in wheels])
        axle_delays += places
        # One sample before the first axle enters, so that the car's motion starts from rest there.
        start = max(0, int(np.ceil(places[0] / advance - 1e-4)) - 1)
        stop = start + int(np.ceil((deck.length + places[-1] - places[0]) / advance)) + 3
        windows.append(slice(start, min(stop, samples)))
        condensation = train.condensation(car, s.loads)
        load_delays.append(centre - condensation.offsets)
        matrix = condensation.matrix.copy()
        matrix[:, 2] += s.track_offset * matrix[:, 1] - deck.track_height * matrix[:, 0]
        matrices.append(matrix)
    load_delays = np.concatenate(load_delays)
    return Coupling(
        train=train,
        deck=deck,
        settings=s,
        time=frozen(np.arange(samples) * s.time_step),
        rigid=train.rigid_forces(track, s.speed, s.time_step, samples, s.lead_in, s.excitation),
        static=[train.static_forces(car) for car in range(len(train.centres))],
        windows=windows,
        axles=deck.stations(np.array(axle_delays), s.speed, s.time_step, samples),
        axle_of=axle_of,
        loads=deck.stations(load_delays, s.speed, s.time_step, samples),
        load_delays=load_delays,
        load_matrices=matrices,
        modes=deck.sampled(s.time_step),
        vehicles=[v.sampled(s.time_step) for v, _ in train.groups()],
    )


@dataclass(frozen=True, eq=False)
class FixedPoint:
    """Every pass of an iteration, pass 0 (rigid deck) first, with the changes and whether it settled.

    `states` holds the deck's state under the first pass and under the last but one, which the last answers to.
    """

    passes: tuple[Delta, ...]
    changes: tuple[float, ...]
    converged: bool
    states: dict[int, DeckState]


def iterate(coupling: Coupling, progress: Callable[[str], None] | None = None) -> FixedPoint:
    """Repeat the steps until the change is below the tolerance twice in a row, or for a given number of passes."""
    s = coupling.settings
    passes, changes = [coupling.at_rest()], []
    share = s.relaxation if isinstance(s.relaxation, float) else 1.0
    previous, below = None, 0
    states: dict[int, DeckState] = {}
    for i in range(s.iterations or s.max_iterations):
        old = passes[-1]
        state = coupling.deck_state(coupling.station_loads(old))
        states = {n: kept for n, kept in states.items() if n == 0} | {i: state}
        new = coupling.train_pass(state)
        changes.append(coupling.change(new, old))
        if progress is not None:
            progress(f"iteration {len(changes)}: change {changes[-1]:.1e}")
        if s.relaxation is not None:
            step = [n - o for n, o in zip(new, old, strict=True)]
            if s.relaxation == "aitken" and previous is not None:
                share = _aitken(share, step, previous)
            new = [o + share * d for o, d in zip(old, step, strict=True)]
            previous = step
        passes.append(new)
        below = below + 1 if changes[-1] < s.tolerance else 0
        if not np.isfinite(changes[-1]) or (s.iterations is None and below == 2):
            break
    return FixedPoint(tuple(passes), tuple(changes), below >= 2, states)


def _aitken(share: float, step: list[np.ndarray], previous: list[np.ndarray]) -> float:
    """Return Aitken's next share: the secant that would have cancelled the last correction."""
    change = [a - b for a, b in zip(step, previous, strict=True)]
    size = sum(float(np.vdot(c, c)) for c in change)
    if size == 0.0:
        return share
    return float(np.clip(-share * sum(float(np.vdot(p, c)) for p, c in zip(previous, change, strict=True)) / size, 0.05, 1.5))
