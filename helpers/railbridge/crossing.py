r"""One train crosses one deck at one speed: rigid, or iterated to the fixed point, and everything to be read from it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from . import errors
from .coupling import Coupling, DeckState, Delta, iterate, prepare
from .decks import BEARING_QUANTITIES, REACTION_QUANTITIES, SECTION_QUANTITIES, Deck, History, Line, Recovery
from .direct import direct
from .errors import InputError
from .settings import LEAD_IN_SECONDS, Settings, check
from .spectra import Spectrum, amplitude_spectrum, deviation_percent
from .tracks import Track
from .trains import CONDENSED, AxleTrain, Train, steady_forces

__all__ = ["Crossing", "Deviations", "NotConvergedError", "cross"]


class NotConvergedError(RuntimeError):
    """The iteration did not settle within the allowed passes; `run` holds everything computed so far."""

    def __init__(self, run: Crossing) -> None:
        other = "interaction = 'direct'" if run.settings.loads == "wheels" else "loads = 'wheels'"
        super().__init__(
            f"run.max_iterations = {run.iterations}: not converged, the last change was {run.changes[-1]:.2g} "
            f"and must be below run.tolerance = {run.settings.tolerance:g} twice in a row. Try run.relaxation = 0.5 or "
            f"'aitken', more run.max_iterations, or {other}."
        )
        self.run = run


@dataclass(frozen=True, eq=False)
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


@dataclass(frozen=True, eq=False)
class Crossing:
    """A computed crossing: everything about the last pass (or another, see `at`).

    Attributes
    ----------
    train : Train or AxleTrain
    deck : Deck
    track : Track
    settings : Settings
    passes : tuple of list of ndarray, shape (2 wheels, n) for each car
        What the deck's motion adds to the wheel forces while the car is on it, N, for each iteration; iteration 0 (rigid-deck
        forces) first, so it is zero. The deck's own state is computed from it when asked for.
    changes : tuple of float
        For each iteration, the largest over wheels and directions of rms(F_i - F_(i-1)) / rms(F_i - static).
    converged : bool or None
        None for interaction ``rigid`` and ``direct``.
    shown : int
        Which iteration the methods speak of.
    coupling : Coupling
        What all iterations share.
    states : dict of DeckState
        The deck's state by iteration, as far as it is known; shared by what `at` returns.
    """

    train: Train | AxleTrain
    deck: Deck
    track: Track
    settings: Settings
    passes: tuple[Delta, ...] = field(repr=False)
    changes: tuple[float, ...]
    converged: bool | None
    shown: int
    coupling: Coupling = field(repr=False)
    states: dict[int, DeckState] = field(default_factory=dict, repr=False)

    @property
    def iterations(self) -> int:
        """Number of solves after the rigid one."""
        return len(self.passes) - 1

    @property
    def ratios(self) -> np.ndarray:
        """Ratio of successive changes: the contraction, shape (iterations - 1,)."""
        changes = np.array(self.changes)
        # NaN after a change of nothing, as of bare axle loads.
        return np.divide(changes[1:], changes[:-1], out=np.full(max(len(changes) - 1, 0), np.nan), where=changes[:-1] > 0.0)

    @property
    def time(self) -> np.ndarray:
        """s, shape (n,); zero when the first axle enters."""
        return self.coupling.time

    def at(self, iteration: int) -> Crossing:
        """Return the same crossing as it stood at an iteration; 0 is the rigid deck's forces."""
        return replace(self, shown=errors.integer("iteration", iteration, most=self.iterations))

    @cached_property
    def wheel_forces(self) -> np.ndarray:
        """All wheel forces on the deck, N, shape (wheels, 2, n): lateral, vertical; static part included.

        Order of wheels as in ``train.wheels``. After a car has left the deck its motion decays freely on the track.
        """
        return errors.frozen(np.concatenate([self._wheels_of(car) for car in range(len(self.coupling.rigid))]))

    @cached_property
    def _known(self) -> dict[int, np.ndarray]:
        """Wheel forces by car (from 0), as far as they were asked for."""
        return {}

    def _wheels_of(self, car: int) -> np.ndarray:
        """Wheel forces of one car (from 0), shape (its wheels, 2, n)."""
        if car not in self._known:
            felt = self._felt if self.shown > 0 else None
            self._known[car] = errors.frozen(self.coupling.car_wheel_forces(car, self.passes[self.shown], felt))
        return self._known[car]

    @cached_property
    def _felt(self) -> DeckState:
        """The deck's motion that the forces shown answer to: that of the pass before, or, solved directly, their own."""
        return self.state if self.settings.interaction == "direct" else self.at(self.shown - 1).state

    def wheel_force(self, car: int = 1, wheel: int = 1) -> History:
        """Return lateral and vertical force of one wheel on the deck, N, static part included; both numbered from 1."""
        for i, w in enumerate(self.train.wheels):
            if (w.car, w.number) == (car, wheel):
                values = dict(zip(("force_y", "force_z"), self.wheel_forces[i], strict=True))
                return History(self.time, values, {"force_y": "N", "force_z": "N"}, f"car {car}, wheel {wheel}")
        raise InputError("wheel", (car, wheel), "no such (car, wheel) in this train", "Both are counted from 1")

    @cached_property
    def body_accelerations(self) -> np.ndarray:
        """Accelerations of every car body, m/s2, shape (cars, 3, 2, n): front, middle, rear; lateral, vertical.

        At the height of its centre of mass, above its foremost springs, at the centre, above its rearmost springs, over the
        whole record. The car body is the heaviest body. Shape (0, 3, 2, n) for bare axle loads.
        """
        s = self.settings
        if not self.train.groups():
            return errors.frozen(np.zeros((0, 3, 2, len(self.time))))
        rigid = self.train.rigid_accelerations(self.track, s.speed, s.time_step, len(self.time), s.lead_in, s.excitation)
        if self.shown > 0:
            added = self.coupling.body_accelerations(self._felt)
            rigid = [r + a for r, a in zip(rigid, added, strict=True)]
        return errors.frozen(np.array(rigid).reshape(len(rigid), 3, 2, -1))

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
        errors.choice("at", at, ("track", "centre"))
        index = errors.integer("car", car, least=1, most=self.train.wheels[-1].car) - 1
        forces = self._wheels_of(index).reshape(-1, len(self.time))
        if not static:
            forces = forces - self.coupling.static[index][:, None]
        matrix = self.train.condensation(index, "condensed").matrix[0]
        values = dict(zip(CONDENSED, matrix @ forces, strict=True))
        if at == "centre":
            x, y, z = self.train.vehicles[index].body.position
            values["moment_x"] = values["moment_x"] - y * values["force_z"] + z * values["force_y"]
            values["moment_y"] = values["moment_y"] + x * values["force_z"]
            values["moment_z"] = values["moment_z"] - x * values["force_y"]
        units = {c: "N" if c.startswith("force") else "N m" for c in CONDENSED}
        return History(self.time, values, units, f"car {car}")

    @cached_property
    def spectrum(self) -> Spectrum:
        """Amplitude spectrum of the first car's total vertical wheel force while it touches the deck (Figures 12 to 16).

        From its first axle at x = 0 to its last at x = L; no window function. Eq. 3 depends on this choice.
        """
        first = self.coupling.windows[0]
        last = max(w.delay for w in self.train.wheels if w.car == 1)
        stop = int(np.floor((last + self.deck.length) / (self.settings.speed * self.settings.time_step) + 1e-4)) + 1
        total = self.coupling.rigid[0][1::2, :stop].sum(axis=0)
        total[first] += self.passes[self.shown][0][1::2, : stop - first.start].sum(axis=0)
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
        return self._motion("displacement", x, self.state.q, ("m", "m", "rad"), self_weight)

    def velocity(self, x: float) -> History:
        """Return velocity_y, velocity_z (m/s) and velocity_roll (rad/s) of the deck axis at x (m)."""
        return self._motion("velocity", x, self.state.velocity, ("m/s", "m/s", "rad/s"))

    def acceleration(self, x: float) -> History:
        """Return acceleration_y, acceleration_z (m/s2) and acceleration_roll (rad/s2) at x (m).

        Wrong when: the cut-off, the highest frequency of the deck's modes kept, is not stated with it; accelerations do not
        converge with the number of modes.
        """
        s = self.state
        return self._motion("acceleration", x, self.deck.acceleration(s.q, s.velocity, s.modal_force), ("m/s2", "m/s2", "rad/s2"))

    def _motion(self, kind: str, x: float, modal: np.ndarray, units: tuple[str, ...], self_weight: bool = False) -> History:
        x = errors.number("x", x, least=0.0, most=self.deck.length, unit="m")
        shape = self.deck.shapes(np.array([x]))[0]
        names = [f"{kind}_y", f"{kind}_z", "rotation_x" if kind == "displacement" else f"{kind}_roll"]
        values = {}
        for c, (name, has) in enumerate(zip(names, self.deck.has.values(), strict=True)):
            values[name] = shape[:, c] @ modal if has else np.full(modal.shape[1], np.nan)
        if self_weight:
            values[names[1]] = values[names[1]] + self._recovery().section("displacement_z", x).self_weight
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
        """Return force_x, force_y, force_z (N), moment_x (N m, about the axis) of every bearing line on the deck, by place."""
        recovery = self._recovery()
        result = {}
        for support in self.deck.supports:
            lines = {n: recovery.reaction(n, support) for n in REACTION_QUANTITIES}
            result[support] = self._recovered(lines, REACTION_QUANTITIES, self_weight, f"bearing at {support:g} m")
        return result

    def bearing_forces(self, self_weight: bool = False) -> dict[int, History]:
        """Return forces (N) and moments about itself (N m) of every bearing on the deck, by its number from 1.

        A bearing that pulls the deck down, force_z < 0 with the self-weight, would lift. NaN where it holds no such freedom.

        Raises
        ------
        InputError
            A deck that knows no single bearings.
        """
        recovery, result = self._recovery(), {}
        if not self.deck.bearings:
            raise InputError("deck", self.deck.name, "knows bearing lines only, no single bearings", "Use reactions()")
        for number, (x, y, z) in enumerate(self.deck.bearings, start=1):
            lines = {n: recovery.bearing(number, n) for n in BEARING_QUANTITIES}
            where = f"bearing {number} at x = {x:g}, y = {y:g}, z = {z:g} m"
            result[number] = self._recovered(lines, BEARING_QUANTITIES, self_weight, where)
        return result

    def _recovery(self) -> Recovery:
        if self.deck.recovery is None:
            raise InputError("deck", self.deck.name, "only its modes are known, so it has no section forces or reactions")
        return self.deck.recovery

    def _recovered(self, lines: dict[str, Line | None], units: dict[str, str], self_weight: bool, where: str) -> History:
        values = {}
        for name, line in lines.items():
            static = self.static(line) if line is not None else None
            values[name] = self.deck.recovered(line, self.state.q, self.state.modal_force, static)
            if self_weight and line is not None:
                values[name] = values[name] + line.self_weight
        return History(self.time, values, {n: units[n] for n in lines}, where)

    @cached_property
    def _loads(self) -> list[np.ndarray]:
        return self.coupling.station_loads(self.passes[self.shown])

    @property
    def state(self) -> DeckState:
        """The deck's modal state at the iteration shown, computed when it is first asked for."""
        if self.shown not in self.states:
            self.states[self.shown] = self.coupling.deck_state(self._loads)
        return self.states[self.shown]

    def static(self, line: Line) -> np.ndarray:
        """Return what an influence line gives under the loads of every instant, as if they stood still, shape (n,)."""
        return self.statics([line])[0]

    def statics(self, lines: Sequence[Line]) -> np.ndarray:
        """Return `static` of several influence lines, shape (lines, n)."""
        total = np.zeros((len(lines), len(self.time)))
        stations = self.coupling.loads
        for which in range(len(stations.tables)):
            # Stations that meet the samples alike share the line's values.
            members = np.flatnonzero(stations.which == which)
            longest = members[np.argmax(stations.counts[members])]
            instants = self.time[stations.starts[longest] :][: stations.counts[longest]]
            x = np.clip(self.settings.speed * instants - self.coupling.load_delays[longest], 0.0, self.deck.length)
            values = np.array([line.influence(x)[:, 0].T for line in lines])
            couples = len(self._loads[members[0]]) == 5
            slopes = np.array([line.influence(x, 1)[:, 0].T for line in lines]) if couples else None
            for station in members:
                load, start, count = self._loads[station], stations.starts[station], stations.counts[station]
                part = total[:, start : start + count]
                for c in range(3):
                    part += values[:, c, :count] * load[c]
                if couples:
                    part += slopes[:, 0, :count] * load[4] - slopes[:, 1, :count] * load[3]
        return total


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
    progress: Callable[[str], None] | None = None,
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
    interaction : {"iterate", "rigid", "direct"}
        The fixed point, the deck under rigid-deck forces (iteration 0), or train and deck solved together at every step
        (wheel loads only; the limit of the fixed point, without iterating, more slowly).
    track_offset : float or str
        Track centre line, m left of the deck axis, or a track's name in the deck file.
    time_step : float, optional
        s; see `default_time_step`.
    lead_in : float, optional
        Run-up on the irregular track, m; default 7.5 s of travel. Zero: level track before the deck, the train at rest;
        wrong where the track then starts on the deck with a step (a phase that is not zero), whose blow on the dampers is
        not counted. On harmonic track a run-up that leaves more than 1 % of the steady forces unsettled is warned about.
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
    progress : function of one text, optional
        Called now and then with how far the computation is.

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
    track = Track() if track is None else track
    settings = check(
        train, deck, track,
        speed=speed, loads=loads, interaction=interaction, track_offset=track_offset, time_step=time_step, lead_in=lead_in,
        tail=tail, tolerance=tolerance, max_iterations=max_iterations, iterations=iterations, relaxation=relaxation,
        excitation=excitation, feedback=feedback,
    )  # fmt: skip
    coupling = prepare(train, deck, track, settings)
    if lead_in is not None:
        _warn_of_transient(coupling, track)
    if interaction == "rigid":
        return Crossing(train, deck, track, settings, (coupling.at_rest(),), (), None, 0, coupling)
    if interaction == "direct":
        return Crossing(train, deck, track, settings, (coupling.at_rest(), direct(coupling, progress)), (), None, 1, coupling)
    found = iterate(coupling, progress)
    last = len(found.changes)
    run = Crossing(train, deck, track, settings, found.passes, found.changes, found.converged, last, coupling, found.states)
    if iterations is None and not found.converged:
        raise NotConvergedError(run)
    return run


def _warn_of_transient(coupling: Coupling, track: Track) -> None:
    """Compare the first car's rigid-deck forces, while it crosses, with the closed form they should have settled to."""
    s, train = coupling.settings, coupling.train
    if not 0.0 < s.lead_in < LEAD_IN_SECONDS * s.speed or isinstance(train, AxleTrain) or train.notches:
        return
    car = train.vehicles[0]
    try:
        steady = steady_forces(car, track, s.speed, s.excitation)
    except InputError:  # level, or not harmonic: nothing to compare with
        return
    if not np.all(np.isfinite(steady)) or not np.any(steady):
        return
    wavelength = track.shortest  # the only one
    window = coupling.windows[0]
    centre = s.speed * coupling.time[window] - train.centres[0]
    settled = (steady[:, None] * np.exp(2j * np.pi * centre / wavelength)).imag
    left = np.linalg.norm(coupling.rigid[0][:, window] - settled) / np.linalg.norm(settled)
    if left > 0.01:
        warnings.warn(
            f"run.lead_in = {s.lead_in:g} m: {left:.1%} of the steady wheel forces is still transient while the first car "
            f"crosses. Leave run.lead_in out for {LEAD_IN_SECONDS * s.speed:g} m, or give 0 for level track before the deck.",
            stacklevel=3,
        )
