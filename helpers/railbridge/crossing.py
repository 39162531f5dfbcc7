r"""One train crosses one deck at one speed: rigid, or iterated to the fixed point.

The paper's five steps, with forces F and deck motion w:

    F_0      wheel forces on a rigid deck (irregularity alone)
    w_i      deck motion under the loads made of F_i
    F_(i+1)  = F_0 + response of the train to w_i met at each wheel (the "equivalent irregularity" is r + w_i)

repeated until F no longer changes. Because the train is linear, only the response to the deck's own motion is run again,
and only while a car is on the deck. The deck is always felt by each wheel at its own place; `loads` decides how the forces
act on the deck: as true wheel loads, as two resultants a car (per bogie), or as one resultant at the car's middle (the
paper).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from . import inputs
from .beam import REACTION_QUANTITIES, SECTION_QUANTITIES
from .deck import Deck, History, Line, Stations
from .inputs import InputError
from .response import SampledResponse
from .spectra import Spectrum, amplitude_spectrum, deviation_percent
from .track import Track
from .train import CONDENSED, LOADS, AxleTrain, Train

__all__ = ["Crossing", "Deviations", "NotConvergedError", "cross", "default_time_step"]

LEAD_IN_SECONDS = 7.5
SAMPLES_PER_LENGTH = 10
"""Fewest samples per wavelength or notch."""


class NotConvergedError(RuntimeError):
    """The iteration did not settle within the allowed passes; `run` holds everything computed so far."""

    def __init__(self, run: Crossing) -> None:
        super().__init__(
            f"run.max_iterations = {run.iterations}: not converged, the last change was {run.changes[-1]:.2g} "
            f"and must be below run.tolerance = {run.settings.tolerance:g} twice in a row. Try run.relaxation = 0.5 or "
            "'aitken', more run.max_iterations, or loads = 'wheels'."
        )
        self.run = run


@dataclass(frozen=True)
class Settings:
    """How a crossing is computed; see `cross`."""

    speed: float
    time_step: float
    lead_in: float
    tail: float
    track_offset: float
    loads: str
    interaction: str
    tolerance: float
    max_iterations: int
    iterations: int | None
    relaxation: float | str | None
    excitation: str
    feedback: str


@dataclass(frozen=True)
class Pass:
    """One pass of the fixed point.

    Attributes
    ----------
    delta : list of ndarray, one for each car, shape (2 wheels, n)
        Wheel forces due to the deck's motion while the car is on the deck, N.
    q, velocity, modal_force : ndarray, shape (modes, samples)
    """

    delta: list[np.ndarray] = field(repr=False)
    q: np.ndarray = field(repr=False)
    velocity: np.ndarray = field(repr=False)
    modal_force: np.ndarray = field(repr=False)


@dataclass(frozen=True)
class Deviations:
    """Eq. 3 for every iteration, percent (Table 3).

    Attributes
    ----------
    from_rigid, from_previous : ndarray, shape (iterations,)
    """

    from_rigid: np.ndarray
    from_previous: np.ndarray

    def to_frame(self):
        """Return a pandas DataFrame with one row an iteration."""
        import pandas as pd

        index = pd.RangeIndex(1, len(self.from_rigid) + 1, name="iteration")
        return pd.DataFrame({"from rigid (%)": self.from_rigid, "from previous (%)": self.from_previous}, index=index)


@dataclass(frozen=True)
class _Setup:
    """What all passes share."""

    time: np.ndarray
    rigid: list[np.ndarray]
    windows: list[slice]
    axles: Stations
    axle_of: list[list[tuple[int, int]]]
    loads: Stations
    load_matrices: list[np.ndarray]
    static: list[np.ndarray]
    modes: list[SampledResponse]
    vehicles: list[SampledResponse]


@dataclass(frozen=True)
class Crossing:
    """A computed crossing: everything about the last pass (or another, see `at`).

    Attributes
    ----------
    train : Train or AxleTrain
    deck : Deck
    track : Track
    settings : Settings
    passes : tuple of Pass
        Iteration 0 (rigid-deck forces) first.
    changes : tuple of float
        For each iteration, the largest over wheels and directions of rms(F_i - F_(i-1)) / rms(F_i - static).
    converged : bool or None
        None for interaction ``rigid``.
    shown : int
        Which iteration the methods speak of.
    """

    train: Train | AxleTrain
    deck: Deck
    track: Track
    settings: Settings
    passes: tuple[Pass, ...] = field(repr=False)
    changes: tuple[float, ...]
    converged: bool | None
    shown: int
    _setup: _Setup = field(repr=False)

    @property
    def iterations(self) -> int:
        """Number of solves after the rigid one."""
        return len(self.passes) - 1

    @property
    def ratios(self) -> np.ndarray:
        """Ratio of successive changes: the contraction, shape (iterations - 1,)."""
        return np.array(self.changes[1:]) / np.array(self.changes[:-1])

    @property
    def time(self) -> np.ndarray:
        """s, shape (n,); zero when the first axle enters."""
        return self._setup.time

    def at(self, iteration: int) -> Crossing:
        """Return the same crossing as it stood at an iteration; 0 is the rigid deck's forces."""
        return replace(self, shown=inputs.integer("iteration", iteration, most=self.iterations))

    @cached_property
    def wheel_forces(self) -> np.ndarray:
        """All wheel forces on the deck, N, shape (wheels, 2, n): lateral, vertical; static part included.

        Order of wheels as in ``train.wheels``. After a car has left the deck its motion decays freely on the track.
        """
        rows = []
        for car, (rigid, static) in enumerate(zip(self._setup.rigid, self._setup.static, strict=True)):
            total = rigid + static[:, None]
            window = self._setup.windows[car]
            delta = self.passes[self.shown].delta[car]
            total[:, window] += delta
            rest = total.shape[1] - window.stop
            if rest > 0 and self.shown > 0:
                total[:, window.stop :] += self._decay(car, rest)
            rows.append(total.reshape(-1, 2, total.shape[1]))
        return np.concatenate(rows)

    def _decay(self, car: int, rest: int) -> np.ndarray:
        """Free motion of one car after the deck, found by running its whole window again with the level track behind it."""
        u = _support_input(self, self.passes[self.shown - 1], [car])
        system = self.train.vehicles[car].system().sampled(self.settings.time_step)
        return system(np.concatenate([u, np.zeros((*u.shape[:2], rest))], axis=2))[:, 0, -rest:]

    def wheel_force(self, car: int = 1, wheel: int = 1) -> History:
        """Return lateral and vertical force of one wheel on the deck, N, static part included; both numbered from 1."""
        for i, w in enumerate(self.train.wheels):
            if (w.car, w.number) == (car, wheel):
                values = dict(zip(("force_y", "force_z"), self.wheel_forces[i], strict=True))
                return History(self.time, values, {"force_y": "N", "force_z": "N"}, f"car {car}, wheel {wheel}")
        raise InputError("wheel", (car, wheel), "no such (car, wheel) in this train", "Both are counted from 1")

    def car_forces(self, car: int = 1, at: str = "track", static: bool = True) -> History:
        """Return one car's wheel forces condensed to five components over the whole record (Figures 9 to 11).

        Parameters
        ----------
        car : int
            From 1.
        at : {"track", "centre"}
            At rail level below the car's middle, or at the car body's centre of mass (as the paper prints it).
        static : bool
            Whether the weight is counted.
        """
        inputs.choice("at", at, ("track", "centre"))
        index = inputs.integer("car", car, least=1, most=self.train.wheels[-1].car) - 1
        forces = np.concatenate([f for f, w in zip(self.wheel_forces, self.train.wheels, strict=True) if w.car == car])
        if not static:
            forces = forces - self._setup.static[index][:, None]
        matrix = self.train.condensation(index, "condensed").matrix[0]
        values = dict(zip(CONDENSED, matrix @ forces, strict=True))
        if at == "centre":
            height = max(b.position[2] for b in self.train.vehicles[index].bodies)
            values["moment_x"] = values["moment_x"] + height * values["force_y"]
            values["moment_y"] = values["moment_y"] - 0.0
        units = {c: "N" if c.startswith("force") else "N m" for c in CONDENSED}
        return History(self.time, values, units, f"car {car}")

    @cached_property
    def spectrum(self) -> Spectrum:
        """Amplitude spectrum of the first car's total vertical wheel force while it touches the deck (Figures 12 to 16).

        From its first axle at x = 0 to its last at x = L; no window function. Eq. 3 depends on this choice.
        """
        first = self._setup.windows[0]
        last = max(w.delay for w in self.train.wheels if w.car == 1)
        stop = int(np.floor((last + self.deck.length) / (self.settings.speed * self.settings.time_step) + 1e-4)) + 1
        total = self._setup.rigid[0][1::2, :stop].sum(axis=0)
        total[first] += self.passes[self.shown].delta[0][1::2, : stop - first.start].sum(axis=0)
        return amplitude_spectrum(total, self.settings.time_step)

    @cached_property
    def deviations(self) -> Deviations:
        """Eq. 3 of every iteration against the rigid deck and against the one before (Table 3)."""
        spectra = [self.at(i).spectrum for i in range(self.iterations + 1)]
        return Deviations(
            np.array([deviation_percent(s, spectra[0]) for s in spectra[1:]]),
            np.array([deviation_percent(b, a) for a, b in zip(spectra[:-1], spectra[1:], strict=True)]),
        )

    def displacement(self, x: float, self_weight: bool = False) -> History:
        """Return displacement_y, displacement_z (m) and rotation_x (rad) of the deck axis at x (m)."""
        return self._motion("displacement", x, self.passes[self.shown].q, ("m", "m", "rad"), self_weight)

    def velocity(self, x: float) -> History:
        """Return velocity_y, velocity_z (m/s) and velocity_roll (rad/s) of the deck axis at x (m)."""
        return self._motion("velocity", x, self.passes[self.shown].velocity, ("m/s", "m/s", "rad/s"))

    def acceleration(self, x: float) -> History:
        """Return acceleration_y, acceleration_z (m/s2) and acceleration_roll (rad/s2) at x (m).

        Wrong when: the cut-off, the highest frequency of the deck's modes kept, is not stated with it; accelerations do not
        converge with the number of modes.
        """
        p = self.passes[self.shown]
        return self._motion("acceleration", x, self.deck.acceleration(p.q, p.velocity, p.modal_force), ("m/s2", "m/s2", "rad/s2"))

    def _motion(self, kind: str, x: float, modal: np.ndarray, units: tuple[str, ...], self_weight: bool = False) -> History:
        x = inputs.number("x", x, least=0.0, most=self.deck.length, unit="m")
        shape = self.deck.shapes(np.array([x]))[0]
        names = [f"{kind}_y", f"{kind}_z", "rotation_x" if kind == "displacement" else f"{kind}_roll"]
        values = {}
        for c, (name, has) in enumerate(zip(names, self.deck.has.values(), strict=True)):
            values[name] = shape[:, c] @ modal if has else np.full(modal.shape[1], np.nan)
        if self_weight and self.deck.recovery is not None:
            values[names[1]] = values[names[1]] + self.deck.recovery.section("displacement_z", x).self_weight
        return History(self.time, values, dict(zip(names, units, strict=True)), f"x = {x:g} m")

    def section_forces(self, x: float, self_weight: bool = False) -> History:
        """Return moment_vertical, moment_lateral, torsion (N m), shear_vertical and shear_lateral (N) at x (m).

        With the static correction of the modes left out; at an inner bearing the face just before it. NaN where the deck has
        no such stiffness.
        """
        names = [n for n in SECTION_QUANTITIES if n.startswith(("moment", "torsion", "shear"))]
        recovery = self._recovery()
        lines = {n: recovery.section(n, x) for n in names}
        return self._recovered(lines, SECTION_QUANTITIES, self_weight, f"x = {x:g} m")

    def reactions(self, self_weight: bool = False) -> dict[float, History]:
        """Return force_y, force_z (N) and moment_x (N m) of every bearing line on the deck, by its place (m)."""
        recovery = self._recovery()
        result = {}
        for support in self.deck.supports:
            lines = {n: recovery.reaction(n, support) for n in REACTION_QUANTITIES}
            result[support] = self._recovered(lines, REACTION_QUANTITIES, self_weight, f"bearing at {support:g} m")
        return result

    def _recovery(self):
        if self.deck.recovery is None:
            raise InputError("deck", self.deck.name, "only its modes are known, so it has no section forces or reactions")
        return self.deck.recovery

    def _recovered(self, lines: dict[str, Line | None], units: dict[str, str], self_weight: bool, where: str) -> History:
        p = self.passes[self.shown]
        values = {}
        for name, line in lines.items():
            static = self.static(line) if line is not None else None
            values[name] = self.deck.recovered(line, p.q, p.modal_force, static)
            if self_weight and line is not None:
                values[name] = values[name] + line.self_weight
        return History(self.time, values, {n: units[n] for n in lines}, where)

    @cached_property
    def _station_loads(self) -> list[np.ndarray]:
        return _station_loads(self, self.passes[self.shown].delta)

    def static(self, line: Line) -> np.ndarray:
        """Return what an influence line gives under the loads of every instant, as if they stood still, shape (n,)."""
        total = np.zeros(len(self.time))
        delays = self._load_delays
        for (start, values, _), load, delay in zip(self._setup.loads, self._station_loads, delays, strict=True):
            window = slice(start, start + values.shape[1])
            x = np.clip(self.settings.speed * self.time[window] - delay, 0.0, self.deck.length)
            total[window] += np.einsum("kc,ck->k", line.influence(x)[:, 0], load[:3])
            if len(load) == 5:
                slope = line.influence(x, 1)[:, 0]
                total[window] += slope[:, 0] * load[4] - slope[:, 1] * load[3]
        return total

    @cached_property
    def _load_delays(self) -> np.ndarray:
        return _load_delays(self.train, self.settings.loads)


def default_time_step(train: Train | AxleTrain, track: Track, speed: float) -> float:
    """Return the time step used when none is given, s.

    At most 1 ms and a twentieth of the shortest wave or notch, and a whole fraction of the time between cars, so that all
    cars meet the samples alike and are computed together.
    """
    shortest = min([track.shortest, *(n.shortest for n in train.notches)])
    most = min(1e-3, shortest / speed / (2 * SAMPLES_PER_LENGTH))
    if len(train.centres) == 1:
        return most
    between = float(train.centres[1] - train.centres[0]) / speed
    return between / np.ceil(between / most)


def cross(
    train: Train | AxleTrain,
    deck: Deck,
    track: Track | None = None,
    *,
    speed: float,
    loads: str = "wheels",
    interaction: str = "iterate",
    track_offset: float | str = 0.0,
    time_step: float | None = None,
    lead_in: float | None = None,
    tail: float = 1.0,
    tolerance: float = 1e-8,
    max_iterations: int = 50,
    iterations: int | None = None,
    relaxation: float | str | None = None,
    excitation: str = "wheels",
    feedback: str = "all",
) -> Crossing:
    """Compute a crossing.

    Parameters
    ----------
    train : Train or AxleTrain
    deck : Deck
    track : Track, optional
        Level if not given.
    speed : float
        m/s.
    loads : {"wheels", "bogies", "condensed"}
        How the wheel forces act on the deck: as they are, as one resultant per bogie, or one per car (the paper).
    interaction : {"iterate", "rigid"}
        The fixed point, or the deck under rigid-deck forces (iteration 0).
    track_offset : float or str
        Track centre line, m left of the deck axis, or a track's name in the deck file.
    time_step : float, optional
        s; see `default_time_step`.
    lead_in : float, optional
        Run-up on the irregular track, m; default 7.5 s of travel. Zero: level track before the deck, the train at rest.
    tail : float
        s after the last axle has left.
    tolerance : float
        The iteration stops when the change is below this twice in a row.
    max_iterations : int
        More than this raises `NotConvergedError`.
    iterations : int, optional
        Do exactly this many, converged or not (the paper did four).
    relaxation : float or "aitken", optional
        Share of each correction that is applied (0 to 1), or Aitken's adaptive share. Helps light or fast cases.
    excitation : {"wheels", "car"}
        See `Train.rigid_forces`.
    feedback : {"all", "vertical"}
        Whether the train feels the deck's whole motion or only its vertical displacement, without twist (a guess at the
        paper's reading).

    Returns
    -------
    Crossing

    Raises
    ------
    InputError
        A value out of range; raised before anything is computed.
    NotConvergedError
        With everything computed so far in its ``run``.

    Notes
    -----
    Self-weight is not fed back: the track is laid level on the sagged deck.
    """
    track = track or Track()
    settings = _settings(
        train, deck, track,
        speed=speed, loads=loads, interaction=interaction, track_offset=track_offset, time_step=time_step, lead_in=lead_in,
        tail=tail, tolerance=tolerance, max_iterations=max_iterations, iterations=iterations, relaxation=relaxation,
        excitation=excitation, feedback=feedback,
    )  # fmt: skip
    setup = _prepare(train, deck, track, settings)
    empty = [np.zeros((len(r), w.stop - w.start)) for r, w in zip(setup.rigid, setup.windows, strict=True)]
    run = Crossing(train, deck, track, settings, (), (), None, 0, setup)
    run = replace(run, passes=(_deck_pass(run, empty),))
    if interaction == "rigid":
        return run
    return _iterate(run)


def _settings(train, deck, track, **s) -> Settings:
    speed = inputs.number("run.speed", s["speed"], above=0.0, most=200.0, unit="m/s", remedy="Give it in m/s: 72 km/h is 20")
    inputs.choice("run.loads", s["loads"], LOADS)
    if s["interaction"] == "direct":
        raise InputError("run.interaction", "direct", "the direct solution is not available yet", "Use 'iterate' or 'rigid'")
    inputs.choice("run.interaction", s["interaction"], ("iterate", "rigid"))
    if isinstance(train, AxleTrain) and s["loads"] != "wheels":
        train.condensation(0, s["loads"])
    inputs.choice("run.excitation", s["excitation"], ("wheels", "car"))
    inputs.choice("run.feedback", s["feedback"], ("all", "vertical"))
    offset = deck.track_offset(s["track_offset"])
    for w in train.wheels:
        if deck.width is not None and abs(offset + w.y) > deck.width / 2:
            raise InputError(
                "train.track", offset, f"wheel {w.number} of car {w.car} at y = {offset + w.y:g} m is off the deck, "
                f"whose half width is {deck.width / 2:g} m", "Move the track towards the axis, or correct the deck's width",
            )  # fmt: skip
    shortest = min([track.shortest, *(n.shortest for n in train.notches)])
    step = s["time_step"]
    if step is None:
        step = default_time_step(train, track, speed)
    else:
        step = inputs.number("run.time_step", step, above=0.0, most=0.1, unit="s")
        if speed * step > shortest / SAMPLES_PER_LENGTH * (1 + 1e-9):
            most = shortest / SAMPLES_PER_LENGTH / speed
            raise InputError(
                "run.time_step", step, f"leaves fewer than ten samples in {shortest:g} m of irregularity; at most {most:.3g} s",
                "Leave run.time_step out to have it chosen",
            )  # fmt: skip
    if speed * step > deck.length / 20:
        raise InputError("run.time_step", step, "leaves fewer than twenty samples on the deck", "Use a shorter one")
    lead_in = LEAD_IN_SECONDS * speed if s["lead_in"] is None else s["lead_in"]
    lead_in = inputs.number("run.lead_in", lead_in, least=0.0, unit="m", remedy="0 means level track before the deck")
    relaxation = s["relaxation"]
    if isinstance(relaxation, str):
        inputs.choice("run.relaxation", relaxation, ("aitken",))
    elif relaxation is not None:
        relaxation = inputs.number("run.relaxation", relaxation, above=0.0, most=1.0)
    iterations = s["iterations"]
    return Settings(
        speed=speed,
        time_step=step,
        lead_in=lead_in,
        tail=inputs.number("run.tail", s["tail"], least=0.0, most=1e4, unit="s"),
        track_offset=offset,
        loads=s["loads"],
        interaction=s["interaction"],
        tolerance=inputs.number("run.tolerance", s["tolerance"], above=0.0, most=1.0),
        max_iterations=inputs.integer("run.max_iterations", s["max_iterations"], least=1, most=10_000),
        iterations=None if iterations is None else inputs.integer("run.iterations", iterations, least=1, most=10_000),
        relaxation=relaxation,
        excitation=s["excitation"],
        feedback=s["feedback"],
    )


def _load_delays(train: Train | AxleTrain, loads: str) -> np.ndarray:
    """Places of all load stations, m behind the first axle."""
    return np.concatenate([c - train.condensation(i, loads).offsets for i, c in enumerate(train.centres)])


def _prepare(train: Train | AxleTrain, deck: Deck, track: Track, s: Settings) -> _Setup:
    advance = s.speed * s.time_step
    samples = int(np.ceil((deck.length + train.length) / advance + s.tail / s.time_step)) + 1
    rigid = train.rigid_forces(track, s.speed, s.time_step, samples, s.lead_in, s.excitation)
    axle_delays, axle_of, windows, matrices = [], [], [], []
    for car in range(len(train.centres)):
        wheels = [w for w in train.wheels if w.car == car + 1]
        # Left and right wheels of an axle differ by rounding at most; they must share one station.
        places = sorted({round(w.delay, 9) for w in wheels})
        axle_of.append([len(axle_delays) + places.index(round(w.delay, 9)) for w in wheels])
        axle_delays += places
        # One sample before the first axle enters, so that the car's motion starts from rest there.
        start = max(0, int(np.ceil(places[0] / advance - 1e-4)) - 1)
        stop = start + int(np.ceil((deck.length + places[-1] - places[0]) / advance)) + 3
        windows.append(slice(start, min(stop, samples)))
        matrix = train.condensation(car, s.loads).matrix.copy()
        matrix[:, 2] += s.track_offset * matrix[:, 1]
        matrices.append(matrix)
    return _Setup(
        time=np.arange(samples) * s.time_step,
        rigid=rigid,
        windows=windows,
        axles=deck.stations(np.array(axle_delays), s.speed, s.time_step, samples),
        axle_of=axle_of,
        loads=deck.stations(_load_delays(train, s.loads), s.speed, s.time_step, samples),
        load_matrices=matrices,
        static=[train.static_forces(car) for car in range(len(train.centres))],
        modes=deck.sampled(s.time_step),
        vehicles=[v.system().sampled(s.time_step) for v, _ in train.groups()],
    )


def _station_loads(run: Crossing, delta: list[np.ndarray]) -> list[np.ndarray]:
    """Loads of every station while it is on the deck, each shape (3 or 5, count)."""
    setup, result, station = run._setup, [], 0
    for rigid, static, window, matrices, own in zip(
        setup.rigid, setup.static, setup.windows, setup.load_matrices, delta, strict=True
    ):
        forces = rigid[:, window] + static[:, None] + own
        for matrix in matrices:
            start = int(setup.loads.starts[station]) - window.start
            result.append(matrix @ forces[:, start : start + int(setup.loads.counts[station])])
            station += 1
    return result


def _deck_pass(run: Crossing, delta: list[np.ndarray]) -> Pass:
    """Steps 1 and 4: the deck under the given wheel forces."""
    loads = _station_loads(run, delta)
    force = run._setup.loads.modal_force(loads, len(run.deck.frequencies_hz), len(run.time))
    state = np.array([mode(f[None]) for mode, f in zip(run._setup.modes, force, strict=True)])
    return Pass(delta, state[:, 0], state[:, 1], force)


def _support_input(run: Crossing, last: Pass, cars: list[int]) -> np.ndarray:
    """What the deck's motion w adds to the cars' input, k w + c w', shape (2 wheels, cars, n)."""
    setup = run._setup
    met = setup.axles.motion(last.q, last.velocity)
    longest = max(setup.windows[c].stop - setup.windows[c].start for c in cars)
    u = np.zeros((2 * len(setup.axle_of[cars[0]]), len(cars), longest))
    for place, car in enumerate(cars):
        vehicle = run.train.vehicles[car]
        for i, (axle, contact) in enumerate(zip(setup.axle_of[car], vehicle.contacts, strict=True)):
            moved, rate = met[axle]
            start = int(setup.axles.starts[axle]) - setup.windows[car].start
            window = slice(start, start + moved.shape[1])
            k, c = vehicle.contact_stiffness[i], vehicle.contact_damping[i]
            u[2 * i + 1, place, window] = k[1] * moved[1] + c[1] * rate[1]
            if run.settings.feedback == "all":
                y = run.settings.track_offset + contact.y
                u[2 * i + 1, place, window] += y * (k[1] * moved[2] + c[1] * rate[2])
                u[2 * i, place, window] = k[0] * moved[0] + c[0] * rate[0]
    return u


def _train_pass(run: Crossing) -> list[np.ndarray]:
    """Steps 2 and 3: the wheel forces due to the deck's motion, each car while it is on the deck."""
    delta = [np.zeros((len(r), w.stop - w.start)) for r, w in zip(run._setup.rigid, run._setup.windows, strict=True)]
    for (_, cars), system in zip(run.train.groups(), run._setup.vehicles, strict=True):
        u = _support_input(run, run.passes[-1], list(cars))
        forces = system(u)
        forces -= u
        for i, car in enumerate(cars):
            delta[car] = forces[:, i, : delta[car].shape[1]]
    return delta


def _change(run: Crossing, new: list[np.ndarray], old: list[np.ndarray]) -> float:
    """Largest over wheels and directions of rms(new - old) / rms(force - static), over each car's time on the deck."""
    floor = 1e-12 * max(np.abs(s).max() for s in run._setup.static)
    worst = 0.0
    for rigid, window, a, b in zip(run._setup.rigid, run._setup.windows, new, old, strict=True):
        moved = np.sqrt(np.mean((a - b) ** 2, axis=1))
        size = np.sqrt(np.mean((rigid[:, window] + a) ** 2, axis=1))
        worst = max(worst, float(np.max(moved / np.maximum(size, floor))))
    return worst


def _iterate(run: Crossing) -> Crossing:
    s = run.settings
    limit = s.iterations or s.max_iterations
    share = s.relaxation if isinstance(s.relaxation, float) else 1.0
    previous = None
    below = 0
    for _ in range(limit):
        old = run.passes[-1].delta
        new = _train_pass(run)
        change = _change(run, new, old)
        if s.relaxation is not None:
            step = [n - o for n, o in zip(new, old, strict=True)]
            if s.relaxation == "aitken" and previous is not None:
                share = _aitken(share, step, previous)
            new = [o + share * d for o, d in zip(old, step, strict=True)]
            previous = step
        run = replace(run, passes=(*run.passes, _deck_pass(run, new)), changes=(*run.changes, change), shown=run.shown + 1)
        below = below + 1 if change < s.tolerance else 0
        if not np.isfinite(change) or (s.iterations is None and below == 2):
            break
    run = replace(run, converged=below >= 2 or bool(run.changes[-1] < s.tolerance))
    if s.iterations is None and not run.converged:
        raise NotConvergedError(run)
    return run


def _aitken(share: float, step: list[np.ndarray], previous: list[np.ndarray]) -> float:
    """Return Aitken's next share: the secant that would have cancelled the last correction."""
    change = [a - b for a, b in zip(step, previous, strict=True)]
    size = sum(float(np.vdot(c, c)) for c in change)
    if size == 0.0:
        return share
    return float(np.clip(-share * sum(float(np.vdot(p, c)) for p, c in zip(previous, change, strict=True)) / size, 0.05, 1.5))
