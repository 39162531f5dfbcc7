"""What a computed crossing can be asked.

Displacements, rotations, section forces, reactions, wheel forces, spectra, extremes and envelopes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from . import errors
from .coupling import CoupledCar, Coupling, DeckState, ForcesAdded
from .cutoffs import counted
from .decks import (
    BEARING_QUANTITIES,
    REACTION_QUANTITIES,
    SECTION_QUANTITIES,
    Deck,
    History,
    Line,
)
from .direct import Windows, on_rigid_deck
from .errors import InputError, brief, frozen
from .percar import PerCar, of_car
from .settings import STATIONS, Settings
from .spectra import Spectrum, amplitude_spectrum, deviation_percent
from .statics import MovingLoads, static_extremes
from .tracks import Track
from .trains import CONDENSED, AnyTrain, Car
from .units import without_rounding

__all__ = ["ENVELOPE", "Crossing", "Deviations", "Envelope"]

ENVELOPE = (
    "displacement_z", "acceleration_z", "moment_vertical", "moment_lateral", "torsion",
    "shear_vertical", "rotation_y",
)  # fmt: skip
"""Quantities that have an envelope along the deck."""

_DISPLACEMENTS = {"displacement_y": "m", "displacement_z": "m", "rotation_x": "rad"}
_ROTATIONS = {q: unit for q, unit in SECTION_QUANTITIES.items() if q.startswith("rotation")}
_FORCES = tuple(q for q in SECTION_QUANTITIES if q.startswith(("moment", "torsion", "shear")))


@dataclass(frozen=True, eq=False)
class Deviations:
    """Eq. 3 for every iteration, percent (Table 3).

    Attributes
    ----------
    from_rigid, from_previous : ndarray, shape (iterations,)
    """

    __repr__ = brief

    from_rigid: np.ndarray
    from_previous: np.ndarray

    def to_frame(self):
        """Return a pandas DataFrame with one row an iteration."""
        import pandas as pd

        columns = {
            "from rigid (%)": self.from_rigid,
            "from previous (%)": self.from_previous,
        }
        index = pd.RangeIndex(1, len(self.from_rigid) + 1, name="iteration")
        return pd.DataFrame(columns, index=index)


@dataclass(frozen=True, eq=False)
class Envelope:
    """One quantity at many places along the deck.

    Attributes
    ----------
    x : ndarray, shape (places,)
        m.
    time : ndarray, shape (n,)
        s.
    values : ndarray, shape (places, n)
        Zero where they are only rounding.
    unit : str
    jumps : tuple of callable
        For each place times (s) and values between the samples, on both sides of what jumps;
        empty where nothing does.
    """

    __repr__ = brief

    x: np.ndarray
    time: np.ndarray
    values: np.ndarray = field(repr=False)
    unit: str = ""
    jumps: tuple[Callable[[], tuple[np.ndarray, np.ndarray]], ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", without_rounding(self.values, self.unit))

    def at(self, place: int) -> History:
        """Return the history at one of the places, from 0, under the name ``value``."""
        own = self.jumps[place] if self.jumps else None
        jumps = None if own is None else lambda _: own()
        values = {"value": self.values[place]}
        return History(self.time, values, {"value": self.unit}, f"x = {self.x[place]:g} m", jumps)


@dataclass(frozen=True, eq=False)
class Crossing:
    """A computed crossing: everything about the last pass (or another, see `at`).

    Attributes
    ----------
    train : AnyTrain
    deck : Deck
    track : Track
    settings : Settings
    passes : tuple of list of ndarray, shape (wheels, 2, n) for each car
        What the deck's motion adds to the wheel forces while the car is on it, N, for each
        iteration; iteration 0 (rigid-deck forces) first, so it is zero. The deck's own state is
        computed from it when asked for.
    changes : tuple of float
        For each iteration, the largest over wheels and directions of
        rms(F_i - F_(i-1)) / rms(F_i - static); or, where the tolerance is one of displacement, by
        what share of its largest motion the deck moved, see `Coupling.moved`.
    converged : bool or None
        None for interaction ``rigid`` and ``direct``.
    iteration : int
        Which iteration the methods speak of.
    coupling : Coupling
        What all iterations share; with Hertzian contacts that of its own iteration.
    states : dict of DeckState
        The deck's state by iteration, as far as it is known; shared by what `at` returns.
    windows : Windows or None
        The windows in time in which the fixed point was found, where passes over the whole record
        did not settle; iteration 1 is then the fixed point.
    couplings : dict of Coupling
        With Hertzian contacts those of the iterations asked for; shared by what `at` returns.
    """

    __repr__ = brief

    train: AnyTrain
    deck: Deck
    track: Track
    settings: Settings
    passes: tuple[ForcesAdded, ...] = field(repr=False)
    changes: tuple[float, ...]
    converged: bool | None
    iteration: int
    coupling: Coupling = field(repr=False)
    states: dict[int, DeckState] = field(default_factory=dict, repr=False)
    windows: Windows | None = None
    couplings: dict[int, Coupling] = field(default_factory=dict, repr=False)

    # ---- the iteration

    @property
    def iterations(self) -> int:
        """Number of solves after the rigid one."""
        return len(self.passes) - 1

    @property
    def solves(self) -> int:
        """Passes after the rigid deck; 0 without iteration, the most of one window of several."""
        if self.settings.interaction != "iterate":
            return 0
        return self.iterations if self.windows is None else int(self.windows.passes.max())

    @property
    def ratios(self) -> np.ndarray:
        """Ratio of successive changes: the contraction, shape (iterations - 1,)."""
        changes = np.array(self.changes)
        # NaN after a change of nothing, as of bare axle loads.
        nothing = np.full(max(len(changes) - 1, 0), np.nan)
        return np.divide(changes[1:], changes[:-1], out=nothing, where=changes[:-1] > 0.0)

    @property
    def time(self) -> np.ndarray:
        """s, shape (n,); zero when the first axle enters, negative before; see `Deck.rail`."""
        return self.coupling.time

    def at(self, iteration: int) -> Crossing:
        """Return the same crossing as it stood at an iteration; 0 is the rigid deck's forces."""
        errors.integer("iteration", iteration, most=self.iterations)
        if self.settings.contact != "hertz" or iteration == self.iteration:
            return replace(self, iteration=iteration)
        # What contacts carry depends on the deck's motion: iteration 0 has its own.
        self.couplings[self.iteration] = self.coupling
        if iteration not in self.couplings:
            self.couplings[iteration] = on_rigid_deck(self.coupling, self.track)
        return replace(self, iteration=iteration, coupling=self.couplings[iteration])

    @cached_property
    def spectrum(self) -> Spectrum:
        """Amplitude spectrum of the first car's vertical wheel force, N (Figures 12 to 16).

        Of the sum over its wheels while it touches the deck, from its first axle at x = 0 to its
        last at x = L; no window function. Eq. 3 depends on this choice.
        """
        first = self.coupling.cars[0]
        own = self.settings.first_on_deck(first.car, self.deck)
        stop = own.stop
        total = first.rigid[:, 1, :stop].sum(axis=0)
        added = self.passes[self.iteration][0][:, 1, : stop - first.window.start]
        total[first.window] += added.sum(axis=0)
        return amplitude_spectrum(total[own], self.settings.time_step)

    @cached_property
    def deviations(self) -> Deviations:
        """Eq. 3 of every iteration against the rigid deck and the one before (Table 3)."""
        spectra = [self.at(i).spectrum for i in range(self.iterations + 1)]
        pairs = zip(spectra[:-1], spectra[1:], strict=True)
        return Deviations(
            np.array([deviation_percent(s, spectra[0]) for s in spectra[1:]]),
            np.array([deviation_percent(after, before) for before, after in pairs]),
        )

    # ---- the train

    @cached_property
    def wheel_forces(self) -> np.ndarray:
        """All wheel forces on the deck, N, shape (wheels, 2, n), static part included.

        Lateral before vertical; order of wheels as in ``train.wheels``. After a car has left the
        deck its motion decays freely on the track.
        """
        return frozen(self.coupling.wheel_forces(*self._added_and_felt))

    def _wheels_of(self, c: CoupledCar) -> np.ndarray:
        """Wheel forces of one car, shape (its wheels, 2, n)."""
        if "wheel_forces" not in vars(self):
            return frozen(self.coupling.wheel_forces(*self._added_and_felt, [c]))
        before = sum(len(other.rigid) for other in self.coupling.cars[: c.car.number - 1])
        return self.wheel_forces[before : before + len(c.rigid)]

    @property
    def _added_and_felt(self) -> tuple[ForcesAdded, DeckState | None]:
        return self.passes[self.iteration], self._felt if self.iteration > 0 else None

    @cached_property
    def _felt(self) -> DeckState:
        """The deck's motion that the forces shown answer to.

        That of the pass before, or, solved directly or in windows, their own.
        """
        own = self.settings.interaction == "direct" or self.windows is not None
        return self.state if own else self.at(self.iteration - 1).state

    def wheel_force(self, car: int = 1, wheel: int = 1) -> History:
        """Return lateral and vertical force of one wheel on the deck, N, static part included.

        Car and wheel are numbered from 1.
        """
        chosen = errors.integer("car", car, least=1), errors.integer("wheel", wheel, least=1)
        for w, forces in zip(self.train.wheels, self.wheel_forces, strict=True):
            if (w.car, w.number) == chosen:
                values = dict(zip(("force_y", "force_z"), forces, strict=True))
                where = f"car {car}, wheel {wheel}"
                return History(self.time, values, {"force_y": "N", "force_z": "N"}, where)
        allowed = "no such (car, wheel) in this train"
        raise InputError("wheel", (car, wheel), allowed, "Both are counted from 1")

    @cached_property
    def wheel_unloading(self) -> np.ndarray:
        """1 - force / static force of every wheel, shape (wheels, n); 1: it would lift.

        NaN for a wheel that carries nothing.
        """
        static = np.array([wheel.static_load or np.nan for wheel in self.train.wheels])
        return 1.0 + self.wheel_forces[:, 1] / static[:, None]

    @cached_property
    def parted(self) -> np.ndarray:
        """Whether every wheel is off the rail, shape (wheels, n): only Hertzian contacts can be.

        The force of such a wheel is nothing, to the last digits of what springs and mass carry.
        """
        if self.settings.contact != "hertz":
            return frozen(np.zeros((len(self.train.wheels), len(self.time)), dtype=bool))
        static = np.array([[wheel.static_load] for wheel in self.train.wheels])
        return frozen(self.wheel_forces[:, 1] > -1e-6 * static)

    @cached_property
    def on_deck(self) -> np.ndarray:
        """Whether every wheel is on the deck, shape (wheels, n)."""
        s, result = self.settings, []
        axles = self.train.placed_axles
        starts, counts = self.deck.samples_within(
            np.array([axle.delay for axle in axles]), s.passage.advance, s.samples, s.before, 0.0
        )
        sample = np.arange(len(self.time))
        for axle, start, count in zip(axles, starts, counts, strict=True):
            since = sample - start
            result += [(since >= 0) & (since < count)] * len(axle.wheels)
        return frozen(np.array(result))

    @cached_property
    def body_accelerations(self) -> np.ndarray:
        """Accelerations of every car body, m/s2, shape (cars, places, 2, n).

        At each of `Vehicle.body_places`: front, middle, rear, of an articulated train those of
        every coach; lateral, vertical. NaN where another car of the train has more coaches. Over
        the whole record. No cars for bare axle loads.
        """
        if not self.train.kinds():
            return frozen(np.zeros((0, 3, 2, len(self.time))))
        rigid = self.train.rigid_accelerations(
            self.track, self.settings.passage, self.coupling.more
        )
        if self.iteration > 0:
            added = self.coupling.body_accelerations(self._felt)
            rigid = [r + a for r, a in zip(rigid, added, strict=True)]
        most = max(len(own) for own in rigid)
        result = np.full((len(rigid), most, 2, len(self.time)), np.nan)
        for car, own in zip(result, rigid, strict=True):
            car[: len(own)] = own
        return frozen(result)

    def car_accelerations(self, car: int = 1) -> History:
        """Return the accelerations of one car's body, m/s2, front, middle and rear.

        Over the whole record, by names such as "front acceleration_z", lateral and vertical, at
        `Vehicle.body_places`; of an articulated train those of every coach, whose name then stands
        in front. NaN the way a body cannot move.

        Raises
        ------
        InputError
            No such car, or bare axle loads, which have no bodies.
        """
        own = self._car_with_bodies(car)
        places, values = own.vehicle.body_places, {}
        moved = self.body_accelerations[own.number - 1][: len(places)]
        several = len({body.name for body, _, _ in places}) > 1
        nothing = np.full(len(self.time), np.nan)
        for (body, place, _), (y, z) in zip(places, moved, strict=True):
            named = f"{body.name} {place}" if several else place
            for way, turn, found in (("y", "yaw", y), ("z", "pitch", z)):
                moves = {way, turn}.intersection(body.freedoms)
                values[f"{named} acceleration_{way}"] = found if moves else nothing
        return History(self.time, values, dict.fromkeys(values, "m/s2"), f"car {own.number}")

    def car_motion(self, car: int = 1) -> History:
        """Return the motion of every freedom of a car about its place at rest, m and rad.

        Over the whole record, by names as in `Vehicle.labels` ("car z").

        Raises
        ------
        InputError
            No such car, or bare axle loads, which do not move.
        """
        own = self._car_with_bodies(car)
        passage, more = self.settings.passage, self.coupling.more
        motion = self.train.rigid_motion(self.track, passage, more)[car - 1]
        if self.iteration > 0:
            motion = motion + self.coupling.motion(self._felt, self.coupling.cars[car - 1])
        values = dict(zip(own.vehicle.labels, motion[:, 0], strict=True))
        units = {name: "m" if name[-2:] in (" y", " z") else "rad" for name in values}
        return History(self.time, values, units, f"car {car}")

    def _car_with_bodies(self, car: int) -> Car:
        own = self.train.car(car)
        if own.vehicle is None:
            raise InputError("car", car, "bare axle loads have no bodies that move")
        return own

    def car_forces(self, car: int = 1, at: str = "track", static: bool = True) -> History:
        """Return one car's wheel forces condensed to five components (Figures 9 to 11).

        Over the whole record.

        Parameters
        ----------
        car : int
            From 1.
        at : {"track", "centre"}
            At rail level below the car's middle, or at the car body's centre of mass (as the paper
            prints it).
        static : bool
            Whether the weight is counted.
        """
        errors.choice("at", at, ("track", "centre"))
        own = self.train.car(car)
        forces = self._wheels_of(self.coupling.cars[own.number - 1])
        if not static:
            forces = forces - own.static_forces[..., None]
        values = own.condensed(forces, at)
        units = {c: "N" if c.startswith("force") else "N m" for c in CONDENSED}
        return History(self.time, values, units, f"car {car}")

    @cached_property
    def per_car(self) -> PerCar:
        """Extremes of wheel forces, unloading and body accelerations of every car.

        ``run.per_car.to_frame()`` has a row a car. Empty for bare axle loads.
        """
        first, found = 0, []
        for car in self.train.formation:
            own = slice(first, first + len(car.wheels))
            first = own.stop
            if car.vehicle is not None:
                wheels = self.wheel_forces[own], self.wheel_unloading[own], self.on_deck[own]
                found.append(of_car(car, *wheels, self.car_accelerations(car.number)))
        return PerCar(tuple(found))

    # ---- the deck's motion

    @cached_property
    def _loads(self) -> MovingLoads:
        known = self.states.get(self.iteration)
        return MovingLoads(self.coupling, self.passes[self.iteration], known)

    @property
    def state(self) -> DeckState:
        """The deck's modal state at this iteration, computed when it is first asked for."""
        if self.iteration not in self.states:
            self.states[self.iteration] = self._loads.state
        return self.states[self.iteration]

    @property
    def acceleration_modes(self) -> np.ndarray:
        """Which of the deck's modes count in its accelerations, shape (modes,) of bool."""
        return counted(self.deck.frequencies_hz, self.settings.accelerations_up_to_hz)

    @property
    def _modal_acceleration(self) -> np.ndarray:
        s = self.state
        found = self.deck.acceleration(s.q, s.velocity, s.modal_force)
        found[~self.acceleration_modes] = 0.0
        return found

    def displacement(self, x: float, self_weight: bool = False, kept_only: bool = False) -> History:
        """Return displacement_y, displacement_z (m) and rotation_x (rad) of the deck axis at x (m).

        Parameters
        ----------
        x : float
            m along the deck.
        self_weight : bool
            Whether the sag under the deck's own weight is added.
        kept_only : bool
            Whether the modes left out are not counted: what the wheels feel.
        """
        x = errors.place("x", x, (0.0, self.deck.length))
        recovery = self.deck.recovery
        if self_weight and recovery.lacks:
            raise InputError("deck", self.deck.name, recovery.lacks)
        if kept_only:
            values = dict(zip(_DISPLACEMENTS, self._moving(x, self.state.q), strict=True))
        else:
            lines = [recovery.section(name, x) for name in _DISPLACEMENTS]
            values = dict(zip(_DISPLACEMENTS, self._displaced(lines), strict=True))
        if self_weight:
            line = recovery.section("displacement_z", x)
            values["displacement_z"] = values["displacement_z"] + line.self_weight
        return History(self.time, values, _DISPLACEMENTS, f"x = {x:g} m")

    def rotations(self, x: float, kept_only: bool = False) -> History:
        """Return rotation_x, rotation_y and rotation_z (rad) of the section at x (m).

        Right-handed: rotation_y is -w' and rotation_z is v' of a deck that is rigid in shear; see
        `decks.SECTION_QUANTITIES`. NaN where the deck does not turn that way.

        Parameters
        ----------
        x : float
            m along the deck.
        kept_only : bool
            Whether the modes left out are not counted.
        """
        x = errors.place("x", x, (0.0, self.deck.length))
        lines = [self.deck.recovery.section(name, x) for name in _ROTATIONS]
        if kept_only:
            nothing = np.full(len(self.time), np.nan)
            found = [nothing if line is None else line.modal @ self.state.q for line in lines]
        else:
            found = self._displaced(lines)
        values = dict(zip(_ROTATIONS, found, strict=True))
        return History(self.time, values, _ROTATIONS, f"x = {x:g} m")

    def _displaced(self, lines: Sequence[Line | None]) -> list[np.ndarray]:
        """Return the displacements that lines describe, NaN for None."""
        known = [line for line in lines if line is not None]
        state, step = self.state, self.settings.time_step
        statics = iter(self._loads.of_lines(known))
        return [
            np.full(len(self.time), np.nan)
            if line is None
            else self.deck.displaced(line, state.q, state.modal_force, next(statics), step)
            for line in lines
        ]

    def velocity(self, x: float) -> History:
        """Return velocity_y, velocity_z (m/s), velocity_roll (rad/s) of the deck axis at x (m)."""
        return self._motion("velocity", x, self.state.velocity, ("m/s", "m/s", "rad/s"))

    def acceleration(self, x: float) -> History:
        """Return acceleration_y, acceleration_z (m/s2) and acceleration_roll (rad/s2) at x (m).

        Of the `acceleration_modes`: state the cut-off, the highest of their frequencies, with it.
        Under Rayleigh damping it settles with more modes, under one ratio for all slowly, and
        undamped not at all.
        """
        units = "m/s2", "m/s2", "rad/s2"
        return self._motion("acceleration", x, self._modal_acceleration, units)

    def _motion(self, kind: str, x: float, modal: np.ndarray, units: tuple[str, ...]) -> History:
        x = errors.place("x", x, (0.0, self.deck.length))
        names = [f"{kind}_y", f"{kind}_z", f"{kind}_roll"]
        values = dict(zip(names, self._moving(x, modal), strict=True))
        return History(self.time, values, dict(zip(names, units, strict=True)), f"x = {x:g} m")

    def _moving(self, x: float, modal: np.ndarray) -> list[np.ndarray]:
        """Return what the modes kept give at x (m): y, z and roll, NaN where the deck has none."""
        shape = self.deck.shapes(np.array([x]))[0]
        nothing = np.full(modal.shape[1], np.nan)
        return [
            shape[:, c] @ modal if has else nothing for c, has in enumerate(self.deck.has.values())
        ]

    # ---- forces in and below the deck

    def section_forces(self, x: float, self_weight: bool = False) -> History:
        """Return bending moments, torsion (N m) and shear forces (N) at x (m).

        moment_vertical, moment_lateral, torsion, shear_vertical, shear_lateral, with the static
        correction of the modes left out; at an inner bearing the face just before it. NaN where
        the deck has no such stiffness.

        Raises
        ------
        InputError
            A deck of which only modes are known.
        """
        self._refuse_lacks()
        x = errors.place("x", x, (0.0, self.deck.length))
        lines = {name: self.deck.recovery.section(name, x) for name in _FORCES}
        return self.recovered(lines, SECTION_QUANTITIES, self_weight, f"x = {x:g} m")

    def reactions(self, self_weight: bool = False) -> dict[float, History]:
        """Return the forces of every bearing line on the deck, by place (m).

        force_x, force_y, force_z (N), moment_x (N m, about the axis).

        Raises
        ------
        InputError
            A deck of which only modes are known.
        """
        self._refuse_lacks()
        result = {}
        for support in self.deck.supports:
            lines = {n: self.deck.recovery.reaction(n, support) for n in REACTION_QUANTITIES}
            where = f"bearing at {support:g} m"
            result[support] = self.recovered(lines, REACTION_QUANTITIES, self_weight, where)
        return result

    def bearing_forces(self, self_weight: bool = False) -> dict[int, History]:
        """Return forces (N) and moments about itself (N m) of every bearing, by its number from 1.

        They act on the deck. A bearing that pulls the deck down, force_z < 0 with the self-weight,
        would lift. NaN where it holds no such freedom.

        Raises
        ------
        InputError
            A deck that knows no single bearings.
        """
        self._refuse_lacks()
        if not self.deck.bearings:
            allowed = "knows bearing lines only, no single bearings"
            raise InputError("deck", self.deck.name, allowed, "Use reactions()")
        result = {}
        for number, (x, y, z) in enumerate(self.deck.bearings, start=1):
            lines = {n: self.deck.recovery.bearing(number, n) for n in BEARING_QUANTITIES}
            where = f"bearing {number} at x = {x:g}, y = {y:g}, z = {z:g} m"
            result[number] = self.recovered(lines, BEARING_QUANTITIES, self_weight, where)
        return result

    def _refuse_lacks(self) -> None:
        if self.deck.recovery.lacks:
            raise InputError("deck", self.deck.name, self.deck.recovery.lacks)

    def recovered(
        self,
        lines: dict[str, Line | None],
        units: dict[str, str],
        self_weight: bool = False,
        where: str = "",
    ) -> History:
        """Return the section forces or reactions that lines of the deck's `recovery` describe.

        Parameters
        ----------
        lines : dict
            By name; NaN is returned for None.
        units : dict of str
            Of every name.
        self_weight : bool
        where : str
        """
        state, loads = self.state, self._loads
        known = {name: line for name, line in lines.items() if line is not None}
        statics = dict(zip(known, loads.of_lines(list(known.values())), strict=True))
        values = {name: np.full(len(self.time), np.nan) for name in lines}
        weight = {name: line.self_weight if self_weight else 0.0 for name, line in known.items()}
        for name, line in known.items():
            values[name] = weight[name] + self.deck.recovered(
                line, state.q, state.velocity, state.modal_force, statics[name]
            )

        def jumps(name: str) -> tuple[np.ndarray, np.ndarray]:
            time, met = loads.at_jumps(known[name])
            return time, met + weight[name]

        return History(self.time, values, {n: units[n] for n in lines}, where, jumps)

    # ---- along the deck

    def envelope(self, quantity: str, x: Sequence[float] | None = None) -> Envelope | None:
        """Return a quantity at many places along the deck.

        Parameters
        ----------
        quantity : str
            One of `ENVELOPE`.
        x : sequence of float, optional
            m; default 41 places, ends included. At an inner bearing shear is that on the face just
            before it.

        Returns
        -------
        Envelope or None
            None where the deck has no such stiffness, or it cannot be recovered.
        """
        errors.choice("quantity", quantity, ENVELOPE)
        if x is None:
            x = np.linspace(0.0, self.deck.length, STATIONS).round(9)
        x = errors.places("x", x, (0.0, self.deck.length))
        deck, state = self.deck, self.state
        if quantity == "acceleration_z":
            if not deck.has["z"]:
                return None
            values = deck.shapes(x)[:, :, 1] @ self._modal_acceleration
            return Envelope(x, self.time, values, "m/s2")
        lines = [deck.recovery.section(quantity, place) for place in x]
        if lines[0] is None:
            return None
        unit = SECTION_QUANTITIES[quantity]
        if quantity in ("displacement_z", "rotation_y"):  # which never jump between two samples
            return Envelope(x, self.time, np.array(self._displaced(lines)), unit)
        values = [
            deck.recovered(line, state.q, state.velocity, state.modal_force, static)
            for line, static in zip(lines, self._loads.of_lines(lines), strict=True)
        ]
        jumps = tuple(partial(self._loads.at_jumps, line) for line in lines)
        return Envelope(x, self.time, np.array(values), unit, jumps)

    # ---- statics

    def static(self, line: Line) -> np.ndarray:
        """Return what an influence line gives under the loads of every instant, standing still.

        Shape (n,).
        """
        return self._loads.of_lines([line])[0]

    def static_extremes(self, line: Line) -> tuple[float, float]:
        """Return the extremes while the static axle loads move over; see `static_extremes`."""
        line = self.deck.under_load(line)
        return static_extremes(self.train, self.settings.track_offset, line)
