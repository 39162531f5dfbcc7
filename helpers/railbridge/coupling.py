r"""The fixed point of train and deck: the paper's five steps.

With forces F and deck motion w,

    F_0      wheel forces on a rigid deck (irregularity alone)
    w_i      deck motion under the loads made of F_i
    F_(i+1)  = F_0 + response of the train to w_i met at each wheel
             (the "equivalent irregularity" is r + w_i)

repeated until F no longer changes. Because the train is linear, only the response to the deck's own
motion is run again, and only while a car is on the deck. The deck is always felt by each wheel at
its own place; `loads` decides how the forces act on the deck: as true wheel loads, as two
resultants a car (per bogie), or as one resultant at the car's middle (the paper).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np

from .decks import Deck
from .errors import brief, frozen
from .guideways import Guideway, Stations
from .response import SampledModes
from .settings import Settings
from .tracks import Track
from .trains import AnyTrain, Car, Passage, Wheel
from .vehicles import Vehicle, WheelForces, WheelResponse

__all__ = [
    "CoupledCar",
    "Coupling",
    "DeckState",
    "FixedPoint",
    "ForcesAdded",
    "grows",
    "iterate",
    "left",
    "prepare",
    "settled",
]

_ROUND_OFF = 1e-10
"""Change that is no longer asked whether it grows."""
ForcesAdded = list[np.ndarray]
"""What the deck's motion adds to each car's wheel forces while it is on the deck, N.

One array for each car, shape (wheels, 2, n).
"""


@dataclass(frozen=True, eq=False)
class DeckState:
    """The deck's modal coordinates, velocities and forces, each shape (modes, samples)."""

    __repr__ = brief

    q: np.ndarray
    velocity: np.ndarray
    modal_force: np.ndarray


@dataclass(frozen=True, eq=False)
class CoupledCar:
    """One car, its forces on a rigid deck, and where it meets this one.

    Attributes
    ----------
    car : Car
    rigid : ndarray, shape (wheels, 2, n)
        Wheel forces on a rigid deck without their static part, N.
    static : ndarray, shape (wheels, 2)
        Static wheel forces, N.
    window : slice
        Samples while it is on the deck.
    axles : ndarray of int, shape (axles,)
        Stations of its axles, where the deck is felt.
    loads : ndarray of int, shape (stations,)
        Its load stations, where the deck is loaded.
    load_matrix : ndarray, shape (stations, 3 or 5, wheels, 2)
        From wheel forces to station loads about the deck axis.
    respond : WheelForces or None
        See `Vehicle.sampled`; None where there is no suspension.
    """

    car: Car
    rigid: np.ndarray = field(repr=False)
    static: np.ndarray = field(repr=False)
    window: slice
    axles: np.ndarray
    loads: np.ndarray
    load_matrix: np.ndarray = field(repr=False)
    respond: WheelForces | None = field(repr=False)

    @property
    def on_deck(self) -> int:
        """Samples in the window."""
        return self.window.stop - self.window.start

    @cached_property
    def loading(self) -> list[slice]:
        """Which wheels load each station: those that stand on it."""
        acts = np.any(self.load_matrix != 0.0, axis=(1, 3))
        return [slice(*(np.flatnonzero(own)[[0, -1]] + [0, 1]).tolist()) for own in acts]


@dataclass(frozen=True, eq=False)
class Coupling:
    """One train, one deck and one way of loading, ready for any number of passes.

    Attributes
    ----------
    train : AnyTrain
    deck : Guideway
        A `Deck`; or, where another program solves the deck, only how it moves.
    settings : Settings
    time : ndarray, shape (n,)
        s; zero when the first axle enters, negative before.
    cars : tuple of CoupledCar
        Front to back.
    axles : Stations
        Every axle, where the deck is felt.
    loads : Stations
        Every load station, where the deck is loaded.
    load_delays : ndarray, shape (stations,)
        m behind the first axle.
    modes : SampledModes or None
        The deck's.
    more : tuple of ndarray, or None
        What Hertzian contacts carry more than their tangents; see `AnyTrain.rigid_forces`.
    """

    __repr__ = brief

    train: AnyTrain
    deck: Guideway
    settings: Settings
    time: np.ndarray
    cars: tuple[CoupledCar, ...]
    axles: Stations
    loads: Stations
    load_delays: np.ndarray
    modes: SampledModes | None
    more: tuple[np.ndarray, ...] | None = None

    def nothing_added(self) -> ForcesAdded:
        """Return the first guess: the deck adds nothing. To be read only."""
        return [np.broadcast_to(0.0, (len(c.rigid), 2, c.on_deck)) for c in self.cars]

    # ---- the deck under the train

    def station_loads(self, added: ForcesAdded, margin: int = 0) -> list[np.ndarray]:
        """Return the load of every station while it is on the deck, shape (3 or 5, count).

        With `margin` so many samples before and behind, too; outside the car's window its first
        and last load go on.
        """
        result = []
        for c, own in zip(self.cars, added, strict=True):
            for station, matrix, wheels in zip(c.loads, c.load_matrix, c.loading, strict=True):
                matrix = matrix[:, wheels].reshape(len(matrix), -1)
                count = int(self.loads.counts[station]) + 2 * margin
                if c.respond is None:
                    # Bare axle loads are what they are at rest.
                    load = (matrix @ c.static[wheels].ravel())[:, None]
                    result.append(np.broadcast_to(load, (len(matrix), count)))
                    continue
                start = int(self.loads.starts[station]) - c.window.start - margin
                within = slice(max(start, 0), min(start + count, c.on_deck))
                forces = c.rigid[wheels, :, c.window][..., within] + own[wheels, :, within]
                forces += c.static[wheels, :, None]
                load = matrix @ forces.reshape(matrix.shape[1], -1)
                missing = within.start - start, start + count - within.stop
                result.append(np.pad(load, ((0, 0), missing), "edge") if any(missing) else load)
        return result

    def deck_state(self, loads: list[np.ndarray]) -> DeckState:
        """Steps 1 and 4: the deck under the loads of every station."""
        force = self.loads.modal_force(loads, self.deck.coordinates, len(self.time))
        return DeckState(*map(frozen, (*self.modes(force), force)))

    # ---- the train on the deck

    def support_input(self, state: DeckState, cars: Sequence[CoupledCar]) -> np.ndarray:
        """Step 2: what the deck's motion w adds to the input of cars of one kind, k w + c w'.

        Returns
        -------
        ndarray, shape (wheels, 2, cars, n)
            N.
        """
        first = np.array([c.window.start for c in cars])
        longest = max(c.on_deck for c in cars)
        u = np.zeros((len(cars[0].car.wheels), 2, len(cars), longest))
        deck = self.axles.ordered(state.q, state.velocity)
        # All wheels of one axle meet the same motion, and so do axles of several cars that share a
        # table.
        for i, axle in enumerate(cars[0].car.axles):
            stations = np.array([c.axles[i] for c in cars])
            for alike in self.axles.alike(stations):
                moved, rate = self.axles.motion(deck, stations[alike])
                starts = (self.axles.starts[stations[alike]] - first[alike]).tolist()
                counts = self.axles.counts[stations[alike]].tolist()
                places = list(zip(alike.tolist(), starts, counts, strict=True))
                for wheel in axle.wheels:
                    own = u[wheel.number - 1]
                    met = self._wheel_input(cars[0].car.vehicle, wheel, moved, rate)
                    for direction, values in enumerate(met):
                        if values is None:
                            continue
                        for (c, start, count), part in zip(places, values, strict=True):
                            own[direction, c, start : start + count] = part[:count]
        return u

    def _wheel_input(
        self, vehicle: Vehicle, wheel: Wheel, moved: np.ndarray, rate: np.ndarray
    ) -> tuple[np.ndarray | None, np.ndarray]:
        """Return k w + c w' of one wheel, lateral and vertical, where its axle meets this motion.

        Each of shape (stations, n), as y, z and roll of the motion are; None where the wheel feels
        nothing sideways.
        """
        contact = wheel.number - 1
        k, c = vehicle.contact_stiffness[contact], vehicle.contact_damping[contact]
        vertical = k[1] * moved[1] + c[1] * rate[1]
        if self.settings.feedback != "all":
            return None, vertical
        has = self.deck.has
        if has["roll"]:
            roll = k[1] * moved[2] + c[1] * rate[2]
            vertical += (self.settings.track_offset + wheel.y) * roll
        if not (k[0] or c[0]) or not (has["y"] or has["roll"]):
            return None, vertical
        lateral = k[0] * moved[0] + c[0] * rate[0]
        if has["roll"] and self.deck.track_height:
            lateral -= self.deck.track_height * (k[0] * moved[2] + c[0] * rate[2])
        return lateral, vertical

    def train_pass(self, state: DeckState) -> ForcesAdded:
        """Steps 2 and 3: the wheel forces due to the deck's motion, each car while on the deck."""
        added = self.nothing_added()
        for _, own in self.train.kinds():
            cars = [self.cars[car.number - 1] for car in own]
            forces = cars[0].respond(self.support_input(state, cars))
            for i, c in enumerate(cars):
                added[c.car.number - 1] = forces[:, :, i, : c.on_deck]
        return added

    def wheel_forces(
        self,
        added: ForcesAdded,
        felt: DeckState | None,
        cars: Sequence[CoupledCar] | None = None,
    ) -> np.ndarray:
        """Return wheel forces on the deck, N, shape (wheels, 2, n), static part included.

        Parameters
        ----------
        added : list of ndarray
        felt : DeckState or None
            The deck's motion that `added` answers to: behind the deck a car's motion decays freely
            on the track. None: a rigid deck.
        cars : sequence of CoupledCar, optional
            Whose; all if not given.
        """
        cars = self.cars if cars is None else cars
        result = np.empty((sum(len(c.rigid) for c in cars), 2, len(self.time)))
        places = np.split(result, np.cumsum([len(c.rigid) for c in cars])[:-1])
        alike: dict[int, list[tuple[CoupledCar, np.ndarray]]] = {}
        for c, total in zip(cars, places, strict=True):
            np.add(c.rigid, c.static[..., None], out=total)
            total[..., c.window] += added[c.car.number - 1]
            if c.respond is not None and felt is not None and c.window.stop < len(self.time):
                alike.setdefault(id(c.car.vehicle), []).append((c, total))
        for own in alike.values():
            met = self.support_input(felt, [c for c, _ in own])
            for i, (c, total) in enumerate(own):
                u = met[:, :, i : i + 1, : c.on_deck]
                behind = total[..., c.window.stop :]
                behind += c.respond.after(u, behind.shape[2])[:, :, 0]
        return result

    def body_accelerations(self, state: DeckState) -> list[np.ndarray]:
        """Return what the deck's motion adds to every car body's accelerations, m/s2.

        Each shape (places, 2, samples), places as for `Vehicle.sampled_body`. Each car runs on over
        the level track behind the deck. None of bare axle loads.
        """
        cars = [c for c in self.cars if c.respond is not None]
        return [self._due_to(state, c, Vehicle.sampled_body) for c in cars]

    def motion(self, state: DeckState, c: CoupledCar) -> np.ndarray:
        """Return what the deck's motion adds to that of a car, m and rad.

        Shape (freedoms, 1, samples), as for `Vehicle.sampled_motion`, over the level track behind
        the deck too.
        """
        return self._due_to(state, c, Vehicle.sampled_motion)

    def _due_to(
        self, state: DeckState, c: CoupledCar, response: Callable[[Vehicle, float], WheelResponse]
    ) -> np.ndarray:
        """Return what a car answers to the deck's motion alone, over all samples."""
        met = self.support_input(state, [c])[:, :, 0]
        u = np.zeros((*met.shape[:2], len(self.time) - c.window.start))
        u[..., : met.shape[2]] = met
        own = response(c.car.vehicle, self.settings.time_step)(u)
        return np.pad(own, ((0, 0), (0, 0), (c.window.start, 0)))

    def change(self, new: ForcesAdded, old: ForcesAdded) -> float:
        """Return the largest, over wheels and directions, of rms(new - old) / rms(force - static).

        While on the deck. A force that varies by less than a millionth of the largest static wheel
        load is measured by that instead, since round-off never settles. Not finite where the forces
        are not.
        """
        largest = max(np.abs(c.static).max() for c in self.cars)
        floor = max(1e-6 * largest, np.finfo(float).tiny)
        worst = 0.0
        for c, a, b in zip(self.cars, new, old, strict=True):
            moved, size = (
                np.sqrt(np.einsum("wdt,wdt->wd", x, x) / x.shape[2])
                for x in (a - b, c.rigid[..., c.window] + a)
            )
            # Forces beyond all numbers give NaN, which max() would take for no change at all.
            worst = float(np.maximum(worst, np.max(moved / np.maximum(size, floor))))
        return worst

    def moved(self, new: DeckState, old: DeckState) -> float:
        """Return by what share of its largest motion the deck's motion differs from another one.

        A motion is measured by the root of the sum of q^2 over the modes, at its largest over
        time. Since shapes are mass-normalised, that is the root of the mass times the mean square
        of the displacement, the whole deck and all directions counted. Not finite where the motion
        is not.
        """
        size, change = (np.einsum("mt,mt->t", q, q).max() for q in (new.q, new.q - old.q))
        # A deck that does not move has not changed.
        return float(np.sqrt(change / np.maximum(size, np.finfo(float).tiny)))


def prepare(train: AnyTrain, deck: Guideway, track: Track, settings: Settings) -> Coupling:
    """Compute all that the passes share: rigid-deck forces, places on the deck, sampled systems."""
    s = settings
    passage = s.passage
    rigid = train.rigid_forces(track, passage)
    respond = {id(v): v.sampled(s.time_step) for v, _ in train.kinds()}
    cars, load_delays, count = [], [], 0
    for car, own in zip(train.formation, rigid, strict=True):
        condensation = car.condensation(s.loads)
        matrix = condensation.matrix.copy()
        matrix[:, 2] += s.track_offset * matrix[:, 1] - deck.track_height * matrix[:, 0]
        cars.append(
            CoupledCar(
                car,
                own,
                car.static_forces,
                _window(car, deck, passage),
                count + np.arange(len(car.axles)),
                len(load_delays) + np.arange(len(condensation.offsets)),
                matrix,
                respond.get(id(car.vehicle)),
            )
        )
        count += len(car.axles)
        load_delays += (car.centre - condensation.offsets).tolist()
    sampling = s.speed, s.time_step, s.samples, s.before
    axle_delays = np.array([axle.delay for axle in train.placed_axles])
    axles = deck.stations(axle_delays, *sampling)
    # Wheel loads act where the deck is felt.
    same = np.array_equal(axle_delays, load_delays)
    loads = axles if same else deck.stations(np.array(load_delays), *sampling)
    return Coupling(
        train=train,
        deck=deck,
        settings=s,
        time=frozen((np.arange(s.samples) - s.before) * s.time_step),
        cars=tuple(cars),
        axles=axles,
        loads=loads,
        load_delays=np.array(load_delays),
        modes=deck.sampled(s.time_step) if isinstance(deck, Deck) else None,
    )


def _window(car: Car, deck: Guideway, passage: Passage) -> slice:
    """Return the samples while a car is on the deck, or near enough to feel it through the rail.

    From one before its first axle enters, so that its motion starts from rest there.
    """
    first, last = car.axles[0].delay, car.axles[-1].delay
    entered = int(np.ceil((first - deck.reach) / passage.advance - 1e-4)) + passage.before
    start = max(0, entered - 1)
    length = deck.length + 2 * deck.reach
    stop = start + int(np.ceil((length + last - first) / passage.advance - 1e-4)) + 3
    return slice(start, min(stop, passage.samples))


@dataclass(frozen=True, eq=False)
class FixedPoint:
    """Every pass of an iteration, pass 0 (rigid deck) first, and whether it settled.

    Attributes
    ----------
    passes : tuple of list of ndarray
        What the deck's motion adds to the wheel forces, see `ForcesAdded`.
    changes : tuple of float
        See `Coupling.change`; or `Coupling.moved`, where the tolerance is one of displacement.
    converged : bool
    states : dict of DeckState
        The deck's state under the first pass and under the last but one, which the last answers to;
        under the last as well, where it was needed.
    """

    passes: tuple[ForcesAdded, ...]
    changes: tuple[float, ...]
    converged: bool
    states: dict[int, DeckState]


def iterate(coupling: Coupling, progress: Callable[[str], None] | None = None) -> FixedPoint:
    """Repeat the steps until what the tolerance speaks of has settled, see `settled`.

    Or for a given number of passes. Where the changes grow and neither passes nor relaxation are
    given it ends early: `windows` does better.
    """
    s = coupling.settings
    passes, changes = [coupling.nothing_added()], []
    share = s.relaxation if isinstance(s.relaxation, float) else 1.0
    previous = None
    states: dict[int, DeckState] = {}
    for i in range(s.iterations or s.max_iterations):
        old = passes[-1]
        if i not in states:
            states[i] = coupling.deck_state(coupling.station_loads(old))
        states = {n: states[n] for n in (0, i)}
        new = coupling.train_pass(states[i])
        if s.tolerance_of == "forces":
            changes.append(coupling.change(new, old))
        if s.relaxation is not None:
            step = [n - o for n, o in zip(new, old, strict=True)]
            if s.relaxation == "aitken" and previous is not None:
                share = _aitken(share, step, previous)
            new = [o + share * d for o, d in zip(old, step, strict=True)]
            previous = step
        passes.append(new)
        if s.tolerance_of == "displacement":
            states[i + 1] = coupling.deck_state(coupling.station_loads(new))
            changes.append(coupling.moved(states[i + 1], states[i]))
        if progress is not None:
            progress(f"iteration {len(changes)}: change {changes[-1]:.1e}")
        if not np.isfinite(changes[-1]) or (s.iterations is None and settled(changes, s)):
            break
        if s.iterations is None and s.relaxation is None and grows(changes):
            break
    return FixedPoint(tuple(passes), tuple(changes), settled(changes, s), states)


def settled(changes: Sequence[float], settings: Settings) -> bool:
    """Return whether an iteration may stop.

    Forces: two changes in a row below the tolerance. Displacement: the last change and what is
    `left` are below it. What is left alone would let go too early, since every pass carries the
    solution some cars further down the train and the changes fall ever more slowly on the way.
    """
    if settings.tolerance_of == "displacement":
        return max(changes[-1], left(changes)) < settings.tolerance
    return len(changes) > 1 and max(changes[-2:]) < settings.tolerance


def grows(changes: Sequence[float]) -> bool:
    """Return whether changes have grown twice in a row, and not as round-off does."""
    return len(changes) > 2 and changes[-1] > changes[-2] > changes[-3] > _ROUND_OFF


def left(changes: Sequence[float]) -> float:
    """Return what further passes would still change, from the changes so far.

    If each is at most rho times the one before, all that follow the last one, d, come to
    ``d (rho + rho^2 + ...) = d rho / (1 - rho)``. For rho the larger of the last two ratios is
    taken, since changes may fall fast and then rise again; of changes that do not fall nothing is
    known, nor of a single one that is not zero.
    """
    last = changes[-1]
    if last == 0.0:
        return 0.0
    ratios = [new / old if old else np.inf for old, new in pairwise(changes[-3:])]
    ratio = max(ratios, default=np.inf)
    return last * ratio / (1.0 - ratio) if ratio < 1.0 else np.inf


def _aitken(share: float, step: list[np.ndarray], previous: list[np.ndarray]) -> float:
    """Return Aitken's next share: the secant that would have cancelled the last correction."""
    change = [a - b for a, b in zip(step, previous, strict=True)]
    size = sum(float(np.vdot(c, c)) for c in change)
    if size == 0.0:
        return share
    along = sum(float(np.vdot(p, c)) for p, c in zip(previous, change, strict=True))
    return float(np.clip(-share * along / size, 0.05, 1.5))
