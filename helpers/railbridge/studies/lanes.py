r"""Many crossings of cars side by side: time outside, crossings inside.

Crossings of one train over one deck differ in speed and track. If every one is sampled at the same
*places*, an advance V h that all share, the shapes met by the axles are the same for all, and what
differs is the step h. Every array then has one column a crossing, a *lane*, and the loop over
samples is run once for all lanes.

The algorithm is that of `coupling`, sample by sample: the wheel forces on a rigid deck; the deck
under them; what its motion at the wheels adds to the forces; the deck under these; and so on for a
given number of passes. Each pass needs only the motion of the pass before at the same sample, so
all passes go through the crossing together, and nothing is kept but where they stand.

A car in complex modes goes from sample to sample by ``z <- a z + b0 w + b1 w``, see `response`. A
mode of the deck, with the imaginary parts of its z and s z, by

    (q, q') <- E (q, q') + c0 p + c1 p.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ..decks import Deck
from ..response import ramp_coefficients
from ..settings import Settings
from ..spectra import amplitude_spectrum, deviation_percent
from ..statics import static_extremes
from ..tracks import Harmonic, Level, Track
from ..trains import AnyTrain, Train
from .constant import NEARLY_CRITICAL
from .lanecars import LaneCar, parts_of
from .outputs import Output, of_modes_counted
from .railwaves import RailWaves

__all__ = [
    "KNOWN", "WIDTH", "Job", "advance_of", "eligible", "has_given_passes", "run_lanes", "waves_of",
]  # fmt: skip

WIDTH = 512
"""Lanes that are run together at most."""
_FILLED = 64
"""Their number is filled up to a multiple of this: the last bit of a product may depend on it."""
_SIDES = ("left", "right")
KNOWN = ("wheel_unloading", "wheel_force_z", "deviation_from_rigid", "iterations")
"""Numbers of a crossing that lanes can tell."""
_JUMP = ("torsion", "shear_vertical", "shear_lateral")


def advance_of(settings: Settings) -> float:
    """Return the advance, m, in which a crossing is sampled as a lane.

    One of a ladder of four a factor of two: the largest that is no longer than the crossing's own.
    """
    own = np.log2(settings.speed * settings.time_step)
    return float(2.0 ** (np.floor(4.0 * own + 1e-9) / 4.0))


class Job(Protocol):
    """One crossing; see `engine.Job`."""

    train: AnyTrain
    track: Track
    settings: Settings


def has_given_passes(settings: Settings) -> bool:
    """Whether a crossing is linear in the irregularity: passes whose number hangs on nothing."""
    s = settings
    return s.interaction == "rigid" or (
        s.interaction == "iterate" and s.iterations is not None and s.relaxation is None
    )


def waves_of(track: Track) -> dict[tuple[str, str], Harmonic | Level] | None:
    """Return the rails by direction and side where each is a wave or level, None otherwise."""
    rails = {(d, side): track.rail(d, side) for d in ("vertical", "lateral") for side in _SIDES}
    waves = all(isinstance(rail, (Harmonic, Level)) for rail in rails.values())
    return rails if waves else None


def eligible(deck: Deck, job: Job, outputs: Sequence[Output], more: bool) -> bool:
    """Whether a crossing can be a lane: waves, wheel loads, a given number of passes, no rail.

    Parameters
    ----------
    deck : Deck
    job : Job
    outputs : sequence of Output
        Section forces that jump are not looked for between samples, so they are none for lanes.
    more : bool
        Whether a whole run is needed to answer.
    """
    s = job.settings
    if not isinstance(job.train, Train) or job.train.notches or more:
        return False
    if deck.rail is not None:  # lanes begin when the first axle enters
        return False
    if s.loads != "wheels" or s.excitation != "wheels" or s.feedback != "all":
        return False
    if not has_given_passes(s) or any(output.quantity in _JUMP for output in outputs):
        return False
    if waves_of(job.track) is None:
        return False
    systems = [vehicle.system.modal for vehicle, _ in job.train.kinds()]
    # Without dampers a wave may meet a mode exactly, which has no steady state.
    cars = all(modal is not None and np.all(modal[0].real < 0.0) for modal in systems)
    return cars and bool(np.all(deck.damping_ratios < NEARLY_CRITICAL))


def run_lanes(
    deck: Deck, jobs: Sequence[Job], outputs: Sequence[Output], numbers: Sequence[str]
) -> np.ndarray:
    """Compute crossings that are `eligible`, of one train, in one advance and number of passes.

    They share what modes count in accelerations, too.

    Parameters
    ----------
    deck : Deck
    jobs : sequence of Job
        At most `WIDTH`.
    outputs : sequence of Output
    numbers : sequence of str
        Some of `KNOWN`.

    Returns
    -------
    ndarray, shape (jobs, 6 outputs + numbers)
        The six of `Peaks` for each output, then the numbers.
    """
    outputs = of_modes_counted(outputs, deck, jobs[0].settings.accelerations_up_to_hz)
    filled = list(jobs) + [jobs[0]] * (-len(jobs) % _FILLED)
    return _Batch(deck, filled).run(outputs, numbers)[: len(jobs)]


class _Batch:
    """Lanes that go together."""

    def __init__(self, deck: Deck, jobs: Sequence[Job]) -> None:
        self.deck, self.jobs = deck, jobs
        first = jobs[0]
        self.train, self.passes = first.train, first.settings.iterations or 0
        if first.settings.interaction == "rigid":
            self.passes = 0
        self.offset = first.settings.track_offset
        self.advance = advance_of(first.settings)
        self.speed = np.array([job.settings.speed for job in jobs])
        self.h = self.advance / self.speed
        tails = np.array([job.settings.tail for job in jobs])
        reach = deck.length + self.train.length
        self.samples = np.ceil(reach / self.advance + tails / self.h).astype(int) + 1
        lead_in = np.array([job.settings.lead_in for job in jobs])
        tracks = [job.track for job in jobs]
        self.rails = RailWaves(self.train, tracks, self.speed, lead_in, self.h, self.advance)
        self._set_cars()
        self._set_deck()

    # ---- cars and deck

    def _set_cars(self) -> None:
        train = self.train
        vehicles = {car.number: car.vehicle for car in train.formation}
        self.static = np.array([[0.0, -wheel.static_load] for wheel in train.wheels]).reshape(-1, 1)
        axles = train.placed_axles
        axle_of = {(w.car, w.number): i for i, axle in enumerate(axles) for w in axle.wheels}
        # From wheel forces to y, z and roll about the deck's axis at every axle, and from the
        # axles' motion (and its rate, behind) to k w + c w' at the wheels.
        height, count = self.deck.track_height, 3 * len(axles)
        self.to_axles = np.zeros((count, 2 * len(train.wheels)))
        to_wheels = np.zeros((2 * len(train.wheels), 2, count))
        for i, wheel in enumerate(train.wheels):
            own, arm = 3 * axle_of[wheel.car, wheel.number], self.offset + wheel.y
            self.to_axles[own, 2 * i] = self.to_axles[own + 1, 2 * i + 1] = 1.0
            self.to_axles[own + 2, 2 * i : 2 * i + 2] = -height, arm
            vehicle = vehicles[wheel.car]
            for part, values in enumerate((vehicle.contact_stiffness, vehicle.contact_damping)):
                lateral, vertical = values[wheel.number - 1]
                to_wheels[2 * i, part, [own, own + 2]] = lateral, -height * lateral
                to_wheels[2 * i + 1, part, [own + 1, own + 2]] = vertical, arm * vertical
        self.cars, wheel, axle = [], 0, 0
        for car in train.formation:
            poles, left, right, _ = car.vehicle.system.modal
            a, b0, b1 = self._steps(poles)
            own = slice(wheel, wheel + 2 * len(car.wheels))
            rows = slice(axle, axle + 3 * len(car.axles))
            wheel, axle = own.stop, rows.stop
            met = to_wheels[own][:, :, rows].reshape(2 * len(car.wheels), -1)
            loads = self.to_axles[rows, own]
            self.cars.append(
                LaneCar(
                    poles, a, b0, b1, parts_of(left), parts_of(right), parts_of(left @ met),
                    parts_of(loads @ right), loads @ met, met, own, rows,
                    [np.zeros(a.shape, dtype=complex) for _ in range(self.passes + 1)],
                )
            )  # fmt: skip

    def _steps(self, poles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return a, b0 and b1 of every pole and lane."""
        x = poles[:, None] * self.h
        a, b0, b1 = (c.reshape(x.shape) for c in ramp_coefficients(x.ravel(), 1.0))
        return a, b0 * self.h, b1 * self.h

    def _set_deck(self) -> None:
        deck = self.deck
        axles = self.train.placed_axles
        delays = np.array([axle.delay for axle in axles])
        last = int(np.ceil((deck.length + delays.max()) / self.advance)) + 2
        self.leaves = min(last, int(self.samples.max()))
        stations = deck.stations(delays, self.advance, 1.0, int(self.samples.max()))
        self.stations = stations
        omega, ratio = 2 * np.pi * deck.frequencies_hz, deck.damping_ratios
        pole = omega * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
        a, b0, b1 = self._steps(pole)
        wd, s = pole.imag[:, None], pole[:, None]
        # z with Im z = wd q and Im(s z) = wd q': Re z = q' - Re(s) q.
        sigma = pole.real[:, None]
        # What q and q' give to both one step later, and what the modal force gives now and before.
        self.from_q = (
            np.stack([a.real * wd - a.imag * sigma, (s * a).real * wd - (s * a).imag * sigma]) / wd
        )
        self.from_v = np.stack([a.imag, (s * a).imag]) / wd
        self.c0 = np.stack([b0.imag, (s * b0).imag]) / wd
        self.c1 = np.stack([b1.imag, (s * b1).imag]) / wd
        self.work = np.empty_like(self.c0)
        self.omega2, self.viscous = omega[:, None] ** 2, (2 * ratio * omega)[:, None]
        shape = len(pole), len(self.jobs)
        self.q = [np.zeros((2, *shape)) for _ in range(self.passes + 1)]
        self.ahead = [np.zeros((2, *shape)) for _ in range(self.passes + 1)]
        self.nothing = np.zeros(shape)

    def shapes_at(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        """Return shapes and slopes met by the axles at sample k, shape (3 axles, modes)."""
        st = self.stations
        found = np.zeros((2, len(st.starts), 3, self.deck.coordinates))
        for i, (start, count, which) in enumerate(zip(st.starts, st.counts, st.which, strict=True)):
            if start <= k < start + count:
                mode, component = st.pairs
                for part in (0, 1):
                    found[part, i, component, mode] = st.tables[which][part][:, k - start]
        return tuple(found.reshape(2, -1, self.deck.coordinates))

    def deck_step(self, number: int, p: np.ndarray, k: int) -> None:
        """Take the deck of one pass on to sample k with the modal force p."""
        state, ahead, work = self.q[number], self.ahead[number], self.work
        if k:  # the first sample moves nothing
            np.multiply(self.c1, p, out=state)
            state += ahead
        np.multiply(self.from_q, state[0], out=ahead)
        ahead += np.multiply(self.from_v, state[1], out=work)
        ahead += np.multiply(self.c0, p, out=work)

    # ---- the loop

    def run(self, outputs: Sequence[Output], numbers: Sequence[str]) -> np.ndarray:
        """Run all lanes and return what was asked of each."""
        meter = _Meter(self, outputs, numbers)
        for car in self.cars:
            left = car.left[0] + 1j * car.left[1]
            standing = self.rails.run_up(car.poles, left, car.wheels)
            car.start(standing, self.rails.at(0)[car.wheels])
        for k in range(int(self.samples.max())):
            if k >= self.leaves and not meter.wheels:
                self.deck_step(self.passes, self.nothing, k)
                meter.read(k, None, None, self.nothing, None)
                continue
            u = self.rails.at(k)
            rigid = np.concatenate([car.rigid_forces(u[car.wheels]) for car in self.cars])
            rigid += self.static
            if k < self.leaves:
                forces, p, loads = self._passes(k, rigid)
                meter.read(k, rigid, forces, p, loads)
            else:
                meter.read(k, rigid, self._behind(rigid, k), self.nothing, None)
        return meter.values()

    def _passes(self, k: int, rigid: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Take all passes on to a sample; return forces, modal forces, loads of the last."""
        shapes, slopes = self.shapes_at(k)
        both = np.concatenate([shapes, slopes])
        forces, count = rigid, len(shapes)
        loads = rigid_loads = self.to_axles @ rigid
        p = shapes.T @ loads
        self.deck_step(0, p, k)
        motion = np.empty((2, count, len(self.jobs)))
        for number in range(1, self.passes + 1):
            q, v = self.q[number - 1]
            moved = both @ q
            motion[0] = moved[:count]
            np.multiply(self.speed, moved[count:], out=motion[1])
            motion[1] += shapes @ v
            last = number == self.passes
            loads = rigid_loads.copy()
            more = []
            for car in self.cars:
                own = motion[:, car.axles].reshape(-1, len(self.jobs))
                added, wheels = car.added(number, own, last)
                loads[car.axles] += added
                more.append(wheels)
            if last:
                forces = rigid + np.concatenate(more)
            p = shapes.T @ loads
            self.deck_step(number, p, k)
        return forces, p, loads

    def _behind(self, rigid: np.ndarray, k: int) -> np.ndarray:
        """The train has left: the deck swings freely, and the cars on the track behind it."""
        self.deck_step(self.passes, self.nothing, k)
        if not self.passes:
            return rigid
        added = []
        for car in self.cars:
            still = np.zeros((car.to_wheels.shape[1], len(self.jobs)))
            added.append(car.added(self.passes, still, True)[1])
        return rigid + np.concatenate(added)


class _Meter:
    """What is asked of all lanes, as they go."""

    def __init__(self, batch: _Batch, outputs: Sequence[Output], numbers: Sequence[str]) -> None:
        self.batch, self.numbers = batch, tuple(numbers)
        self.wheels = not {"wheel_unloading", "wheel_force_z"}.isdisjoint(numbers)
        lanes, deck = len(batch.jobs), batch.deck
        self.lines = [output.line for output in outputs]
        self.modal = np.array([output.modal for output in outputs])
        self.acceleration = np.array([o.is_acceleration for o in outputs], dtype=bool)
        force = np.array([o.is_force for o in outputs], dtype=bool)
        self.viscous = np.where(force, deck.internal_damping, 0.0)[:, None]
        moves = ~self.acceleration & ~force
        self.lags = moves & (deck.internal_damping > 0.0)
        self.rest = np.where(self.acceleration[:, None], 0.0, self.modal / batch.omega2[:, 0])
        self.low, self.high = np.full((2, len(outputs), lanes), [[[np.inf]], [[-np.inf]]])
        self.low_k, self.high_k = np.zeros((2, len(outputs), lanes), dtype=int)
        self.heaviest = np.zeros(lanes)
        self.lightest = np.full(lanes, np.inf)
        self.all_go = int(batch.samples.min())
        static = batch.static[1::2]
        self.share = np.divide(1.0, static, out=np.full_like(static, np.nan), where=static < 0.0)
        if deck.internal_damping > 0.0:
            beta = deck.internal_damping
            a, b0, b1 = ramp_coefficients(-batch.h / beta, 1.0)
            self.lag = a.real, b0.real * batch.h / beta, b1.real * batch.h / beta
            self.lagged = np.zeros((int(self.lags.sum()), lanes))
            self.before = np.zeros_like(self.lagged)
        self._set_influence()
        first = batch.train.formation[0]
        self.own = 2 * len(first.wheels)
        reach = first.axles[-1].delay + deck.length
        self.stop = int(np.floor(reach / batch.advance + 1e-4)) + 1
        if "deviation_from_rigid" in self.numbers:
            self.history = np.zeros((2, self.stop, lanes))

    def _set_influence(self) -> None:
        """Influence of y, z and roll at every sample's place of a front axle, for all axles."""
        batch, length = self.batch, self.batch.deck.length
        delays = np.array([axle.delay for axle in batch.train.placed_axles])
        self.influence = np.zeros((batch.leaves, len(self.lines), 3 * len(delays)))
        for i, delay in enumerate(delays):
            x = np.arange(batch.leaves) * batch.advance - delay
            slack = 1e-4 * batch.advance
            on = (x >= -slack) & (x <= length + slack)
            for n, line in enumerate(self.lines):
                if line is not None:
                    values = line.influence(np.clip(x[on], 0.0, length))[:, 0]
                    self.influence[on, n, 3 * i : 3 * i + 3] = values

    def read(
        self,
        k: int,
        rigid: np.ndarray | None,
        forces: np.ndarray | None,
        p: np.ndarray,
        loads: np.ndarray | None,
    ) -> None:
        """Look at the last pass at sample k; what is None is not asked for, or has left."""
        batch = self.batch
        q, v = batch.q[batch.passes]
        going = k < batch.samples
        if len(self.modal):
            values = self._values(k, q, v, p, loads)
            lower, higher = values < self.low, values > self.high
            if k >= self.all_go:
                lower &= going
                higher &= going
            np.copyto(self.low, values, where=lower)
            np.copyto(self.high, values, where=higher)
            self.low_k[lower] = k
            self.high_k[higher] = k
        if forces is None:
            return
        vertical = forces[1::2]
        lowest, share = vertical.min(axis=0), np.fmin.reduce(vertical * self.share, axis=0)
        if k >= self.all_go:
            lowest, share = np.where(going, lowest, 0.0), np.where(going, share, np.inf)
        np.minimum(self.heaviest, lowest, out=self.heaviest)
        np.minimum(self.lightest, share, out=self.lightest)
        if "deviation_from_rigid" in self.numbers and k < self.stop:
            self.history[0, k] = rigid[1 : self.own : 2].sum(axis=0)
            self.history[1, k] = forces[1 : self.own : 2].sum(axis=0)

    def _values(
        self, k: int, q: np.ndarray, v: np.ndarray, p: np.ndarray, loads: np.ndarray | None
    ) -> np.ndarray:
        batch = self.batch
        values = self.modal @ q
        if self.viscous.any():
            values += self.viscous * (self.modal @ v)
        rest = -(self.rest @ p)
        if loads is not None:
            rest += self.influence[k] @ loads
        if self.lags.any():
            own = rest[self.lags]
            a, b0, b1 = self.lag
            self.lagged = own if k == 0 else a * self.lagged + b0 * self.before + b1 * own
            self.before = own
            rest[self.lags] = self.lagged
        values += rest
        if self.acceleration.any():
            acceleration = p - batch.viscous * v - batch.omega2 * q
            values[self.acceleration] = self.modal[self.acceleration] @ acceleration
        return values

    def values(self) -> np.ndarray:
        """Return what was asked of each lane, shape (lanes, 6 outputs + numbers)."""
        batch = self.batch
        statics = [
            (np.nan, np.nan) if line is None else static_extremes(batch.train, batch.offset, line)
            for line in self.lines
        ]
        static = np.array(statics).reshape(-1, 2, 1) + np.zeros(len(batch.jobs))
        six = (
            self.low, self.high, self.low_k * batch.h, self.high_k * batch.h,
            static[:, 0], static[:, 1],
        )  # fmt: skip
        numbers = [
            [self._number(name, lane) for lane in range(len(batch.jobs))] for name in self.numbers
        ]
        return np.concatenate([*six, np.array(numbers).reshape(-1, len(batch.jobs))]).T

    def _number(self, name: str, lane: int) -> float:
        if name == "wheel_unloading":
            return float(1.0 - self.lightest[lane])
        if name == "wheel_force_z":
            return float(-self.heaviest[lane])
        if name == "iterations":
            return float(self.batch.passes)
        if not self.batch.passes:
            return np.nan
        h = self.batch.h[lane]
        before, after = (amplitude_spectrum(own[:, lane], h) for own in self.history)
        return deviation_percent(after, before)
