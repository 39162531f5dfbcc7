r"""A train on waves of unit size, one for each wave number: what any random track is made of.

On permanent contact train and deck are linear in the irregularity, so a track

    r(x) = sum over waves of a_k cos(W_k x + phi_k)

gives ``y(t) = y_0(t) + sum of a_k (cos(phi_k) y_c,k(t) - sin(phi_k) y_s,k(t))``, with y_0 that of
level track, and y_c,k and y_s,k those of ``cos(W_k x)`` and ``sin(W_k x)``. They are computed once
for a train, a deck and a speed; spectra and realisations are then products of matrices.

The waves come from far: a car that reaches the deck has long settled to them, and its wheel forces
on a rigid deck are those of the transfer function, at the crossing's own step: with z = exp(i w h),
w = W V and the exact step ``x[k+1] = E x[k] + B0 u[k] + B1 u[k+1]``,

    F = [C (z - E)^-1 (B0 + z B1) - 1] u,      u = (k + i w c) r at every contact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .. import errors
from ..coupling import Coupling, prepare
from ..decks import Deck
from ..direct import CarSteps, plan
from ..errors import InputError, brief, frozen
from ..settings import Settings, check, refuse_bytes
from ..tracks import Harmonic, Rails, Track
from ..trains import AnyTrain
from ..vehicles import Vehicle
from .outputs import OUTPUTS, Output, of_modes_counted, outputs_at
from .wavesteps import BLOCK, Asking, Waves, step_waves

__all__ = ["COMPONENTS", "UnitHistory", "UnitWaves", "unit_waves", "wave_forces"]

COMPONENTS = {
    "vertical": ((0.0, 0.0), (1.0, 1.0)),
    "alignment": ((1.0, 1.0), (0.0, 0.0)),
    "cross_level": ((0.0, 0.0), (0.5, -0.5)),
    "gauge": ((0.5, -0.5), (0.0, 0.0)),
}
"""Of every component of a track how much the left and the right rail move, sideways and up."""


@dataclass(frozen=True, eq=False)
class UnitHistory:
    """One quantity of a crossing: on track without waves, and what waves of 1 m add.

    Attributes
    ----------
    unit : str
    time : ndarray, shape (n,)
        s; zero when the first axle enters.
    level : ndarray, shape (n,)
        Without waves.
    waves : ndarray, shape (components, n, 2 waves)
        Of every wave its cosine and its sine in turn, per m.
    """

    __repr__ = brief

    unit: str
    time: np.ndarray
    level: np.ndarray = field(repr=False)
    waves: np.ndarray = field(repr=False)


@dataclass(frozen=True, eq=False)
class UnitWaves:
    """A train's crossing of a deck on waves of 1 m, each component of the track by itself.

    Attributes
    ----------
    train : AnyTrain
    deck : Deck
    settings : Settings
    base : Track
        What else the rails are off by.
    edges : ndarray, shape (waves + 1,)
        Ends of the bands of wave numbers in whose middle the waves lie, rad/m.
    components : tuple of str
        Some of `COMPONENTS`.
    histories : dict of UnitHistory
        By name: "displacement_z at 18 m", "wheel_force_z of car 1, wheel 2" (while on the deck).
    """

    __repr__ = brief

    train: AnyTrain
    deck: Deck
    settings: Settings
    base: Track
    edges: np.ndarray
    components: tuple[str, ...]
    histories: Mapping[str, UnitHistory] = field(repr=False)

    @property
    def wavenumbers(self) -> np.ndarray:
        """W of every wave, rad/m, shape (waves,)."""
        return (self.edges[:-1] + self.edges[1:]) / 2

    def history(self, name: str) -> UnitHistory:
        """Return a history by its name, refused where there is none (the nearest is suggested)."""
        if name not in self.histories:
            near = errors.did_you_mean(name, self.histories)
            raise InputError("name", name, "no such history", near)
        return self.histories[name]


def unit_waves(
    train: AnyTrain,
    deck: Deck,
    edges: Sequence[float],
    *,
    components: Sequence[str] = ("vertical",),
    quantities: Sequence[str] = ("displacement_z",),
    points: Sequence[float] | None = None,
    wheels_of: Sequence[int] = (),
    base: Track | None = None,
    progress: Callable[[str], None] | None = None,
    **options,
) -> UnitWaves:
    """Compute a crossing on waves of unit size, all at once.

    Parameters
    ----------
    train : Train
    deck : Deck
    edges : sequence of float, shape (waves + 1,)
        Ends of the bands of wave numbers, rad/m, ascending; a wave lies in the middle of each.
    components : sequence of str
        Which components of the track, see `COMPONENTS`.
    quantities : sequence of str
        What is asked for at every point, see `OUTPUTS`.
    points : sequence of float, optional
        m along the deck; mid-span if not given.
    wheels_of : sequence of int
        Cars whose vertical wheel forces are kept, from 1.
    base : Track, optional
        What else the rails are off by, beneath the waves; level if not given. It has the run-up of
        `cross`; the waves come from far.
    progress : function of one text, optional
    **options
        As for `cross`.

    Raises
    ------
    InputError
        What is not linear (Hertzian contacts), has no suspension, or would not fit into memory.
    """
    edges = errors.numbers("edges", edges, above=0.0, unit="rad/m")
    if len(edges) < 2 or np.any(np.diff(edges) <= 0.0):
        raise InputError("edges", edges, "must ascend and hold at least two wave numbers")
    components = _checked_components(components)
    outputs = outputs_at(deck, quantities, [deck.length / 2] if points is None else points)
    if len({_name(output) for output in outputs}) < len(outputs):
        raise InputError("points", points, "two of them are the same in six digits")
    base = Track() if base is None else errors.instance("base", base, Track)
    settings = _settings(train, deck, base, float(edges[-1]), options)
    outputs = of_modes_counted(outputs, deck, settings.accelerations_up_to_hz)
    if not errors.is_list(wheels_of):
        allowed = "must list numbers of cars"
        raise InputError("wheels_of", wheels_of, allowed, f"Write wheels_of = ({wheels_of},)")
    kept = [train.car(number).number - 1 for number in wheels_of]
    waves = len(edges) - 1
    _refuse_size(train, deck, settings, len(components) * waves, len(outputs), kept)
    coupling = prepare(train, deck, base, settings)
    steps = plan(coupling)
    if settings.interaction == "rigid":  # the wheels do not feel the deck
        still = {id(c): _without_feeling(c) for c in steps.cars}
        steps = replace(steps, cars=tuple(still[id(c)] for c in steps.cars))
    felt = [c for c in components if _is_felt(coupling, float(edges[-1]), c)]
    lanes = _lanes(coupling, (edges[:-1] + edges[1:]) / 2, felt)
    asking = _asking(coupling, outputs)
    found, wheels = step_waves(steps, lanes, asking, settings.time_step, kept, progress)
    histories, shape = {}, (waves, components, felt)
    for output, own in zip(outputs, found, strict=True):
        name = _name(output)
        histories[name] = _history(OUTPUTS[output.quantity], coupling.time, own, *shape)
    for i, own in wheels.items():
        time = coupling.time[own.first :][: own.forces.shape[1]]
        for number, forces in enumerate(own.forces, start=1):
            name = f"wheel_force_z of car {i + 1}, wheel {number}"
            histories[name] = _history("N", time, forces, *shape)
    return UnitWaves(train, deck, settings, base, frozen(edges), components, histories)


def _without_feeling(car: CarSteps) -> CarSteps:
    return replace(car, stiffness=0.0 * car.stiffness, damping=0.0 * car.damping)


def _name(output: Output) -> str:
    return f"{output.quantity} at {output.x:g} m"


def _is_felt(coupling: Coupling, wavenumber: float, component: str) -> bool:
    """Whether a component gives anything but lateral forces of a pair that cancel each other.

    The two massless wheels of an axle hold the rails together against gauge: nothing else moves.
    """
    for c in coupling.cars:
        forces = _forces(coupling, c.car.vehicle, np.array([wavenumber]), component)
        forces = forces.reshape(-1, 2)
        loads = np.tensordot(c.load_matrix, forces, 2)
        largest = max(np.abs(loads).max(), np.abs(forces[:, 1]).max())
        if largest > 1e-9 * np.abs(forces).max():
            return True
    return False


def _history(
    unit: str,
    time: np.ndarray,
    lanes: np.ndarray,
    count: int,
    components: Sequence[str],
    felt: Sequence[str],
) -> UnitHistory:
    """Return a history from its lanes, shape (n, lanes), which only components that are felt have.

    The others are nothing.
    """
    own = np.moveaxis(lanes[:, :-1].reshape(len(lanes), len(felt), 2 * count), 1, 0)
    waves = own
    if len(felt) < len(components):
        waves = np.zeros((len(components), *own.shape[1:]))
        waves[[components.index(component) for component in felt]] = own
    return UnitHistory(unit, time, lanes[:, -1].copy(), waves)


def _checked_components(components: Sequence[str]) -> tuple[str, ...]:
    if isinstance(components, str):
        components = (components,)
    if not len(components):
        raise InputError("components", list(components), "must name at least one component")
    for i, name in enumerate(components):
        errors.choice("components", name, COMPONENTS)
        if name in components[:i]:
            raise InputError("components", name, "is named twice")
    return tuple(components)


def _settings(
    train: AnyTrain, deck: Deck, base: Track, largest: float, options: Mapping
) -> Settings:
    """Return the checked settings of a crossing whose shortest wave is that of a wave number."""
    if isinstance(train, AnyTrain) and not train.kinds():
        allowed = "bare axle loads do not feel the track"
        raise InputError("train", train, allowed, "Use a train of vehicles")
    for name in ("iterations", "relaxation"):
        if options.get(name) is not None:
            allowed = "has no meaning here: waves are solved without passes"
            raise InputError(name, options[name], allowed, "Leave it out")
    sides = {
        side: [base.rail("vertical", side), Harmonic(1.0, wavelength=2 * np.pi / largest)]
        for side in ("left", "right")
    }
    track = Track(vertical=Rails(**sides), lateral=base.lateral)
    settings = check(train, deck, track, **options)
    if settings.contact != "permanent":
        allowed = "is not linear, and waves can be added up on linear contacts only"
        raise InputError("contact", settings.contact, allowed, "Use contact = 'permanent'")
    return settings


def _refuse_size(
    train: AnyTrain,
    deck: Deck,
    settings: Settings,
    waves: int,
    outputs: int,
    wheels_of: Sequence[int],
) -> None:
    """Refuse what would not fit into memory."""
    # Blocks of the deck's state, and of the forces of cars, beside what is kept.
    numbers = 2.0 * BLOCK * (3 * deck.coordinates + outputs) + outputs * settings.samples
    for i in wheels_of:
        car = train.formation[i]
        reach = deck.length + 2 * deck.reach + car.axles[-1].delay - car.axles[0].delay
        numbers += len(car.wheels) * reach / settings.passage.advance
    remedy = "Ask for fewer waves (a narrower band, a shorter period), outputs or cars"
    refuse_bytes("edges", None, 16.0 * waves * numbers, "so many waves", remedy)


def _lanes(coupling: Coupling, wavenumbers: np.ndarray, components: Sequence[str]) -> Waves:
    """Return what every wave of every component gives the wheels on a rigid deck."""
    known: dict[int, np.ndarray] = {}
    forces = []
    for c in coupling.cars:
        vehicle = c.car.vehicle
        if id(vehicle) not in known:
            own = [_forces(coupling, vehicle, wavenumbers, name) for name in components]
            none = np.zeros((2 * len(vehicle.contacts), 0))
            known[id(vehicle)] = np.concatenate([none, *own], axis=1)
        entry = np.exp(-1j * np.tile(wavenumbers, len(components)) * c.car.centre)
        forces.append(np.ascontiguousarray(known[id(vehicle)] * entry))
    rates = np.tile(wavenumbers * coupling.settings.speed, len(components))
    return Waves(rates, tuple(forces), float(coupling.time[0]))


def _forces(
    coupling: Coupling, vehicle: Vehicle, wavenumbers: np.ndarray, component: str
) -> np.ndarray:
    s = coupling.settings
    return wave_forces(vehicle, wavenumbers, component, s.speed, s.time_step, s.excitation)


def wave_forces(
    vehicle: Vehicle,
    wavenumbers: np.ndarray,
    component: str,
    speed: float,
    time_step: float,
    excitation: str = "wheels",
) -> np.ndarray:
    """Return the steady wheel forces on waves of 1 m and a rigid deck, at a time step.

    Parameters
    ----------
    vehicle : Vehicle
    wavenumbers : ndarray, shape (waves,)
        rad/m.
    component : str
        One of `COMPONENTS`.
    speed : float
        m/s.
    time_step : float
        s; forces at samples, of rails that are chords in between.
    excitation : {"wheels", "car"}

    Returns
    -------
    ndarray, shape (2 wheels, waves), complex
        N on the deck, lateral and vertical of every wheel: force = Re(F exp(i W V t)) on the track
        cos(W x), with the vehicle's mid-length at x = 0 at t = 0.
    """
    x = np.array([c.x if excitation == "wheels" else vehicle.front for c in vehicle.contacts])
    right = np.array([c.y < 0 for c in vehicle.contacts]).astype(int)
    moved = np.array(COMPONENTS[component])[:, right].T
    omega = wavenumbers * speed
    impedance = vehicle.contact_stiffness + 1j * omega[:, None, None] * vehicle.contact_damping
    u = impedance * moved * np.exp(1j * wavenumbers[:, None] * x)[:, :, None]
    u = u.reshape(len(omega), -1, 1)
    system = vehicle.system
    decay, b0, b1 = system.step(time_step)
    z = np.exp(1j * omega * time_step)[:, None, None]
    state = np.linalg.solve(z * np.eye(len(decay)) - decay, (b0 + z * b1) @ u)
    return (system.c @ state - u)[:, :, 0].T


def _asking(coupling: Coupling, outputs: Sequence[Output]) -> Asking:
    """Return how outputs follow from modes and load stations; see `Deck.recovered`."""
    deck: Deck = coupling.deck
    omega = 2 * np.pi * deck.frequencies_hz
    modal = np.array([output.modal for output in outputs])
    of_q, of_velocity, of_force = modal.copy(), 0.0 * modal, 0.0 * modal
    residual, lags = modal / omega**2, np.zeros(len(outputs))
    for i, output in enumerate(outputs):
        if output.is_acceleration:
            of_q[i], of_force[i], residual[i] = -(omega**2) * modal[i], modal[i], 0.0
            of_velocity[i] = -2.0 * deck.damping_ratios * omega * modal[i]
        elif output.is_force:
            of_velocity[i] = deck.internal_damping * modal[i]
        else:
            lags[i] = deck.internal_damping
    lines = [None if o.line is None else deck.under_load(o.line) for o in outputs]
    rows = coupling.cars[0].load_matrix.shape[1]
    stations, tables = coupling.loads, []
    for which in range(len(stations.tables)):
        members = np.flatnonzero(stations.which == which)
        longest = members[np.argmax(stations.counts[members])]
        start, count = stations.starts[longest], stations.counts[longest]
        x = coupling.settings.speed * coupling.time[start : start + count]
        x = np.clip(x - coupling.load_delays[longest], -deck.reach, deck.length + deck.reach)
        table = np.zeros((count, rows, len(outputs)))
        for i, line in enumerate(lines):
            if line is None:
                continue
            table[:, :3, i] = line.influence(x)[:, 0]
            if rows == 5:
                slope = line.influence(x, 1)[:, 0]
                table[:, 3, i], table[:, 4, i] = -slope[:, 1], slope[:, 0]
        tables.append(table)
    return Asking(of_q, of_velocity, of_force, tuple(tables), residual, lags)
