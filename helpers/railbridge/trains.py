r"""Trains: where their wheels are, and what the wheels exert under given support motion.

Places are measured backwards from the train's first axle, which is at x = 0 at t = 0 and at x = V t later; a wheel with
delay d (m) is at x = V t - d. Forces are those *on the deck*, up positive, so the static wheel force is negative.

Every car meets the same irregularity at the same place, so cars of one kind differ only by a shift in time: the rigid-deck
forces are run once for each kind of car (and for each way it falls between the samples) and shifted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from . import errors
from .errors import InputError
from .tracks import FadeIn, Notch, Track
from .vehicles import Vehicle

__all__ = ["CONDENSED", "AxleTrain", "Condensation", "Train", "Wheel", "steady_forces"]

CONDENSED = ("force_y", "force_z", "moment_x", "moment_y", "moment_z")
"""The five components of a condensed load: sway, bounce, roll, pitch, yaw."""

LOADS = ("wheels", "bogies", "condensed")


@dataclass(frozen=True)
class Wheel:
    """A wheel of a train.

    Attributes
    ----------
    car, number : int
        From 1, front to back, left before right.
    delay : float
        m behind the train's first axle.
    y : float
        m left of the track's centre line.
    side : str
        ``left`` or ``right`` rail; a planar vehicle's wheels take the left one.
    static_load : float
        N, down positive.
    body : str
        What it carries ("front bogie").
    """

    car: int
    number: int
    delay: float
    y: float
    side: str
    static_load: float
    body: str


@dataclass(frozen=True)
class Condensation:
    """Wheel forces of one car reduced to load stations.

    Attributes
    ----------
    offsets : ndarray, shape (s,)
        Place of each station, m ahead of the car's mid-length.
    matrix : ndarray, shape (s, 5 or 3, 2 wheels)
        Components F_y, F_z, M_x, M_y, M_z about the station's point on the track's centre line at rail level; without
        the couples M_y, M_z where a station is one axle.
    """

    offsets: np.ndarray
    matrix: np.ndarray


@dataclass(frozen=True)
class Train:
    """Cars with suspension in a row.

    Attributes
    ----------
    vehicle : Vehicle, or one Vehicle for each car
    cars : int
        Number of cars where one vehicle is given.
    car_spacing : float, optional
        m between the middles of neighbouring cars; default from the vehicles' lengths.
    notches : tuple of Notch
        Wheel irregularities.
    """

    vehicle: Vehicle | tuple[Vehicle, ...]
    cars: int | None = None
    car_spacing: float | None = None
    notches: tuple[Notch, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.vehicle, Vehicle):
            object.__setattr__(
                self, "cars", errors.integer("train.cars", 1 if self.cars is None else self.cars, least=1, most=1000)
            )
        else:
            several = isinstance(self.vehicle, (list, tuple)) and len(self.vehicle) > 0
            if not several or not all(isinstance(v, Vehicle) for v in self.vehicle):
                raise InputError("train.vehicle", self.vehicle, "must be a Vehicle or one Vehicle for each car")
            if self.cars not in (None, len(self.vehicle)):
                raise InputError("train.cars", self.cars, f"must be the number of vehicles given, {len(self.vehicle)}")
            object.__setattr__(self, "cars", len(self.vehicle))
            object.__setattr__(self, "vehicle", tuple(self.vehicle))
        if self.car_spacing is not None:
            errors.number("train.car_spacing", self.car_spacing, above=0.0, unit="m")
        if not isinstance(self.notches, (list, tuple)) or not all(isinstance(n, Notch) for n in self.notches):
            raise InputError("train.notch", self.notches, "must be a list of notches", "Put a single one into a list, too")
        object.__setattr__(self, "notches", tuple(self.notches))
        known = {(w.car, w.number) for w in self.wheels}
        for notch in self.notches:
            for wheel in notch.wheels:
                if wheel not in known:
                    raise InputError("train.notch.wheels", wheel, f"no such [car, wheel]; cars 1 to {self.cars}", "Count from 1")
        ends = [(d.min(), d.max()) for d in (self._delays(c) for c in range(self.cars))]
        for (_, rear), (front, _) in zip(ends[:-1], ends[1:], strict=True):
            if front <= rear:
                raise InputError("train.car_spacing", self.car_spacing, "cars overlap", "Use at least the vehicle's length")

    @cached_property
    def vehicles(self) -> tuple[Vehicle, ...]:
        """The vehicle of each car."""
        return self.vehicle if isinstance(self.vehicle, tuple) else (self.vehicle,) * self.cars

    @cached_property
    def centres(self) -> np.ndarray:
        """Mid-length of each car, m behind the first axle, shape (cars,)."""
        lengths = np.array([v.length for v in self.vehicles])
        steps = np.full(self.cars - 1, self.car_spacing) if self.car_spacing else (lengths[:-1] + lengths[1:]) / 2
        return np.concatenate([[0.0], np.cumsum(steps)]) + max(c.x for c in self.vehicles[0].contacts)

    def _delays(self, car: int) -> np.ndarray:
        return self.centres[car] - np.array([c.x for c in self.vehicles[car].contacts])

    @cached_property
    def wheels(self) -> tuple[Wheel, ...]:
        """All wheels, car by car."""
        result = []
        for car, v in enumerate(self.vehicles):
            for i, (c, d) in enumerate(zip(v.contacts, self._delays(car), strict=True), start=1):
                result.append(Wheel(car + 1, i, float(d), c.y, "right" if c.y < 0 else "left", c.static_load, c.body))
        return tuple(result)

    @property
    def length(self) -> float:
        """First to last axle, m."""
        return max(w.delay for w in self.wheels)

    def groups(self) -> list[tuple[Vehicle, np.ndarray]]:
        """Return each kind of vehicle with the cars (from 0) that are of it."""
        kinds: dict[int, tuple[Vehicle, list[int]]] = {}
        for car, v in enumerate(self.vehicles):
            kinds.setdefault(id(v), (v, []))[1].append(car)
        return [(v, np.array(cars)) for v, cars in kinds.values()]

    def rigid_forces(
        self, track: Track, speed: float, time_step: float, samples: int, lead_in: float, excitation: str = "wheels"
    ) -> list[np.ndarray]:
        """Return the wheel forces on a rigid deck, without their static part.

        Parameters
        ----------
        track : Track
        speed : float
            m/s.
        time_step : float
            s.
        samples : int
            Samples from t = 0.
        lead_in : float
            Run-up, m; see `FadeIn`.
        excitation : {"wheels", "car"}
            Whether every wheel meets the track at its own place, or all wheels of a car at the car's front end, length/2 ahead
            of its middle (a guess at the paper's reading).

        Returns
        -------
        list of ndarray, one for each car, shape (2 wheels of the car, samples)
            N on the deck, lateral before vertical.
        """

        def forces(v: Vehicle, u: np.ndarray) -> np.ndarray:
            return v.sampled(time_step)(u) - u if u.any() else u

        return self._rigid(forces, track, speed, time_step, samples, lead_in, excitation)

    def rigid_accelerations(
        self, track: Track, speed: float, time_step: float, samples: int, lead_in: float, excitation: str = "wheels"
    ) -> list[np.ndarray]:
        """Return the accelerations of every car body on a rigid deck, m/s2, each shape (6, samples).

        Arguments as for `rigid_forces`, places as for `Vehicle.body_system`.
        """

        def accelerations(v: Vehicle, u: np.ndarray) -> np.ndarray:
            system, direct = v.body_system()
            return system.sampled(time_step)(u) + direct @ u if u.any() else np.zeros((6, u.shape[1]))

        return self._rigid(accelerations, track, speed, time_step, samples, lead_in, excitation)

    def _rigid(self, respond, track, speed, time_step, samples, lead_in, excitation) -> list[np.ndarray]:
        """Run each kind of car once on the irregularity, and shift what it answers to each car's time."""
        errors.choice("excitation", excitation, ("wheels", "car"))
        advance = speed * time_step
        runs: dict[tuple, np.ndarray] = {}
        result = []
        for car, v in enumerate(self.vehicles):
            front = float(self._delays(car).min())
            shift = int(np.floor(front / advance + 1e-6))
            fraction = round(front / advance - shift, 6)
            own = tuple((n, tuple(w for c, w in n.wheels if c == car + 1)) for n in self.notches)
            own = tuple((n, w) for n, w in own if w)
            key = id(v), max(fraction, 0.0), own
            if key not in runs:
                u = self._input(v, track, speed, time_step, samples, lead_in, excitation, key[1], own)
                runs[key] = respond(v, u)
            first = runs[key].shape[1] - samples - shift
            forces = runs[key][:, max(first, 0) : first + samples]
            # A car whose run-up starts after t = 0 stands on level track until then.
            result.append(np.pad(forces, ((0, 0), (max(-first, 0), 0))) if first < 0 else forces)
        return result

    def _input(self, v, track, speed, time_step, samples, lead_in, excitation, fraction, notches) -> np.ndarray:
        """Return k r + c r' of one car from its run-up on; local sample j has the front axle at (j - fraction) V h."""
        advance = speed * time_step
        before = int(np.ceil(lead_in / advance))
        local = (np.arange(-before, samples) - fraction) * advance
        front = max(c.x for c in v.contacts)
        rails = {(d, s): FadeIn(track.rail(d, s), lead_in) for d in ("lateral", "vertical") for s in ("left", "right")}
        met: dict[tuple, tuple[np.ndarray, np.ndarray]] = {}
        u = np.empty((2 * len(v.contacts), len(local)))
        for i, contact in enumerate(v.contacts):
            behind = front - (contact.x if excitation == "wheels" else v.length / 2)
            x = local - behind
            for j, direction in enumerate(("lateral", "vertical")):
                rail = rails[direction, "right" if contact.y < 0 else "left"]
                key = id(rail.inner), behind
                if key not in met:
                    met[key] = rail.value(x), speed * rail.slope(x)
                r, rate = met[key]
                if direction == "vertical":
                    for notch, wheels in notches:
                        if i + 1 in wheels:
                            # Eq. 2 runs on the wheel's own place, whichever place the rail's irregularity is taken at.
                            own = local - (front - contact.x)
                            r, rate = r + notch.value(own), rate + speed * notch.slope(own)
                u[2 * i + j] = v.contact_stiffness[i, j] * r + v.contact_damping[i, j] * rate
        return u

    def condensation(self, car: int, loads: str) -> Condensation:
        """Return how one car's wheel forces (car from 0) become load stations: axles, bogies or the car's centre.

        The resultant at a point of the track's centre line at rail level: F_y, F_z, M_x = sum y F_z, M_y = -sum x F_z,
        M_z = sum x F_y, with x from the station.
        """
        errors.choice("loads", loads, LOADS)
        contacts = self.vehicles[car].contacts
        if loads == "wheels":
            groups = _unique([c.x for c in contacts])
            members = [[i for i, c in enumerate(contacts) if c.x == x] for x in groups]
        elif loads == "bogies":
            groups = _unique([c.body for c in contacts])
            members = [[i for i, c in enumerate(contacts) if c.body == b] for b in groups]
        else:
            members = [list(range(len(contacts)))]
        places = [0.0 if loads == "condensed" else float(np.mean([contacts[i].x for i in m])) for m in members]
        matrix = np.zeros((len(members), 3 if loads == "wheels" else 5, 2 * len(contacts)))
        for s, (m, place) in enumerate(zip(members, places, strict=True)):
            for i in m:
                matrix[s, 0, 2 * i] = 1.0
                matrix[s, 1, 2 * i + 1] = 1.0
                matrix[s, 2, 2 * i + 1] = contacts[i].y
                if loads != "wheels":
                    matrix[s, 3, 2 * i + 1] = -(contacts[i].x - place)
                    matrix[s, 4, 2 * i] = contacts[i].x - place
        return Condensation(np.array(places), matrix)

    def static_forces(self, car: int) -> np.ndarray:
        """Return the static wheel forces of one car (from 0) on the deck, shape (2 wheels,), lateral before vertical, N."""
        result = np.zeros(2 * len(self.vehicles[car].contacts))
        result[1::2] = [-c.static_load for c in self.vehicles[car].contacts]
        return result


@dataclass(frozen=True)
class AxleTrain:
    """Bare axle loads: no suspension, so the wheel force is the static one whatever the deck does.

    Attributes
    ----------
    axles : array_like, shape (n,)
        m behind the first axle, ascending.
    loads : array_like, shape (n,)
        N, down positive.
    """

    axles: Sequence[float]
    loads: Sequence[float]
    cars: int = field(default=1, init=False)
    notches: tuple[Notch, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        axles = errors.numbers("train.axles", self.axles, least=0.0, unit="m")
        loads = errors.numbers("train.loads", self.loads, count=len(axles), above=0.0, unit="N")
        if len(axles) == 0 or axles[0] != 0.0 or np.any(np.diff(axles) <= 0):
            raise InputError(
                "train.axles", list(self.axles), "must ascend from 0, the first axle", "Subtract the first axle's place from all"
            )
        object.__setattr__(self, "axles", tuple(axles.tolist()))
        object.__setattr__(self, "loads", tuple(loads.tolist()))

    @property
    def centres(self) -> np.ndarray:
        """The first axle stands for the train, shape (1,)."""
        return np.zeros(1)

    @cached_property
    def wheels(self) -> tuple[Wheel, ...]:
        """One wheel for each axle, on the track's centre line."""
        return tuple(
            Wheel(1, i, a, 0.0, "left", p, "axle") for i, (a, p) in enumerate(zip(self.axles, self.loads, strict=True), 1)
        )

    @property
    def length(self) -> float:
        """First to last axle, m."""
        return self.axles[-1]

    def groups(self) -> list:
        """Return no vehicles: nothing answers to the deck's motion."""
        return []

    def rigid_forces(self, track, speed, time_step, samples, lead_in, excitation="wheels") -> list[np.ndarray]:
        """Return zeros: bare loads do not feel the track; see `Train.rigid_forces`."""
        return [np.zeros((2 * len(self.axles), samples))]

    def condensation(self, car: int, loads: str) -> Condensation:
        """Return the axles as they are; there is no car to condense to."""
        if loads != "wheels":
            raise InputError("run.loads", loads, "a train of bare axles has no cars to condense", "Use loads = 'wheels'")
        matrix = np.zeros((len(self.axles), 3, 2 * len(self.axles)))
        index = np.arange(len(self.axles))
        matrix[index, 0, 2 * index] = matrix[index, 1, 2 * index + 1] = 1.0
        return Condensation(-np.array(self.axles), matrix)

    def static_forces(self, car: int) -> np.ndarray:
        """Return the loads as forces on the deck; see `Train.static_forces`."""
        result = np.zeros(2 * len(self.axles))
        result[1::2] = [-p for p in self.loads]
        return result


def _unique(values: list) -> list:
    """Return the distinct values in the order they come."""
    return list(dict.fromkeys(values))


def steady_forces(vehicle: Vehicle, track: Track, speed: float, excitation: str = "wheels") -> np.ndarray:
    """Return the steady wheel forces on harmonic irregularities: the closed form the run-up tends to.

    Parameters
    ----------
    vehicle : Vehicle
    track : Track
        Each rail and direction one `Harmonic` of one common wavelength, or level.
    speed : float
        m/s.
    excitation : {"wheels", "car"}

    Returns
    -------
    ndarray, shape (2 wheels,), complex
        Amplitude and phase: force = Im(F exp(i 2 pi V t / wavelength)), with the car's mid-length at x = 0 at t = 0.
    """
    rails = {(d, s): track.rail(d, s) for d in ("lateral", "vertical") for s in ("left", "right")}
    waves = {r.wavelength for r in rails.values() if hasattr(r, "wavelength")}
    if len(waves) != 1 or any(np.isfinite(r.shortest) and not hasattr(r, "wavelength") for r in rails.values()):
        raise InputError("track", None, "the steady state in closed form needs harmonic rails of one wavelength")
    wavelength = waves.pop()
    motion = np.zeros(2 * len(vehicle.contacts), dtype=complex)
    for i, contact in enumerate(vehicle.contacts):
        x = contact.x if excitation == "wheels" else vehicle.length / 2
        for j, direction in enumerate(("lateral", "vertical")):
            rail = rails[direction, "right" if contact.y < 0 else "left"]
            if hasattr(rail, "wavelength"):
                motion[2 * i + j] = rail.amplitude * np.exp(1j * (2 * np.pi * x / wavelength + rail.phase))
    return vehicle.transfer(speed / wavelength) @ motion
