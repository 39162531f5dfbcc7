r"""Trains: where their wheels are, and what the wheels exert under given support motion.

Places are measured backwards from the train's first axle, which is at x = 0 at t = 0 and at x = V t
later; a wheel with delay d (m) is at x = V t - d. Forces are those *on the deck*, up positive, so
the static wheel force is negative. Arrays over the wheels of a car have the shape (wheels, 2, n):
lateral before vertical.

Every car meets the same irregularity at the same place, so cars of one kind differ only by a shift
in time: the rigid-deck forces are run once for each kind of car (and for each way it falls between
the samples) and shifted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from . import errors
from .errors import InputError, Range, brief, check_fields, frozen
from .tracks import FadeIn, Notch, Track
from .vehicles import Vehicle, WheelResponse

__all__ = [
    "CONDENSED", "EXCITATIONS", "LOADS", "AnyTrain", "AxleTrain", "Car", "Condensation", "Passage",
    "PlacedAxle", "Train", "Wheel", "rail_input",
]  # fmt: skip

CONDENSED = ("force_y", "force_z", "moment_x", "moment_y", "moment_z")
"""The five components of a condensed load: sway, bounce, roll, pitch, yaw."""

LOADS = ("wheels", "bogies", "condensed")
EXCITATIONS = ("wheels", "car")


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
        Whose wheel it is ("front bogie"): that in which its wheelset hangs, if it has one.
    x : float
        m ahead of its car's centre.
    """

    car: int
    number: int
    delay: float
    y: float
    side: str
    static_load: float
    body: str
    x: float


@dataclass(frozen=True)
class PlacedAxle:
    """An axle of a train.

    Attributes
    ----------
    car : int
        From 1.
    delay : float
        m behind the train's first axle.
    wheels : tuple of Wheel
        Left before right.
    """

    car: int
    delay: float
    wheels: tuple[Wheel, ...]

    @property
    def static_load(self) -> float:
        """N, down positive."""
        return sum(wheel.static_load for wheel in self.wheels)


@dataclass(frozen=True)
class Condensation:
    """From the wheel forces of one car to its load stations.

    Attributes
    ----------
    offsets : ndarray, shape (stations,)
        m ahead of the car's centre.
    matrix : ndarray, shape (stations, 3 or 5, wheels, 2)
        Rows F_y, F_z, M_x about the track's centre line, and M_y, M_z where a station stands for
        several axles.
    """

    __repr__ = brief

    offsets: np.ndarray
    matrix: np.ndarray


@dataclass(frozen=True)
class Car:
    """A car in its train.

    Attributes
    ----------
    number : int
        From 1, front to back.
    centre : float
        Mid-length, m behind the train's first axle; of bare axle loads the first axle.
    axles : tuple of PlacedAxle
        Front to back.
    vehicle : Vehicle or None
        None: bare axle loads, whose forces are the static ones whatever rail and deck do.
    notches : tuple of (Notch, tuple of int)
        Notches of its wheels, and which of them (from 0) each is on.
    """

    __repr__ = brief

    number: int
    centre: float
    axles: tuple[PlacedAxle, ...]
    vehicle: Vehicle | None = None
    notches: tuple[tuple[Notch, tuple[int, ...]], ...] = ()

    @cached_property
    def wheels(self) -> tuple[Wheel, ...]:
        """All wheels, axle by axle."""
        return tuple(wheel for axle in self.axles for wheel in axle.wheels)

    @cached_property
    def static_forces(self) -> np.ndarray:
        """Static wheel forces on the deck, N, shape (wheels, 2)."""
        return frozen(np.array([[0.0, -wheel.static_load] for wheel in self.wheels]))

    def condensation(self, loads: str) -> Condensation:
        """Return how the wheel forces become load stations: axles, bogies or the car's centre.

        The resultant at a point of the track's centre line at rail level: F_y, F_z,
        M_x = sum y F_z, M_y = -sum x F_z, M_z = sum x F_y, with x from the station.
        """
        errors.choice("loads", loads, LOADS)
        if self.vehicle is None and loads != "wheels":
            allowed = "a train of bare axles has no cars to condense"
            raise InputError("loads", loads, allowed, "Use loads = 'wheels'")
        if loads == "wheels":
            stations = [axle.wheels for axle in self.axles]
        elif loads == "bogies":
            bodies = dict.fromkeys(wheel.body for wheel in self.wheels)
            stations = [[w for w in self.wheels if w.body == body] for body in bodies]
        else:
            stations = [self.wheels]
        offsets = np.zeros(len(stations))
        matrix = np.zeros((len(stations), 3 if loads == "wheels" else 5, len(self.wheels), 2))
        for s, station in enumerate(stations):
            if loads != "condensed":
                offsets[s] = np.mean([wheel.x for wheel in station])
            for wheel in station:
                w = wheel.number - 1
                matrix[s, 0, w, 0] = matrix[s, 1, w, 1] = 1.0
                matrix[s, 2, w, 1] = wheel.y
                if loads != "wheels":
                    matrix[s, 3, w, 1] = -(wheel.x - offsets[s])
                    matrix[s, 4, w, 0] = wheel.x - offsets[s]
        return Condensation(offsets, matrix)

    def condensed(self, forces: np.ndarray, at: str = "track") -> dict[str, np.ndarray]:
        """Return wheel forces condensed to the five components of `CONDENSED`, by name.

        Parameters
        ----------
        forces : ndarray, shape (wheels, 2, ...)
            N, lateral before vertical: histories, or complex amplitudes.
        at : {"track", "centre"}
            At rail level below the car's middle, or at the car body's centre of mass, as the paper
            prints it (Figure 9).

        Returns
        -------
        dict of ndarray, shape (...)
            N and N m.
        """
        errors.choice("at", at, ("track", "centre"))
        (station,) = self.condensation("condensed").matrix
        values = dict(zip(CONDENSED, np.tensordot(station, forces, 2), strict=True))
        if at == "centre":
            x, y, z = self.vehicle.body.position
            force_y, force_z = values["force_y"], values["force_z"]
            values["moment_x"] = values["moment_x"] - y * force_z + z * force_y
            values["moment_y"] = values["moment_y"] + x * force_z
            values["moment_z"] = values["moment_z"] - x * force_y
        return values


@dataclass(frozen=True)
class Passage:
    """How a train passes: how fast, sampled how finely and how long, from how far.

    Attributes
    ----------
    speed : float
        m/s.
    time_step : float
        s.
    samples : int
        Samples in all.
    lead_in : float
        Run-up on the irregular track, m; see `FadeIn`.
    excitation : {"wheels", "car"}
        Whether every wheel meets the track at its own place, or all wheels of a car at the car's
        front end, length/2 ahead of its middle (a guess at the paper's reading).
    before : int
        How many of the samples are before t = 0, when the first axle enters.
    """

    speed: float
    time_step: float
    samples: int
    lead_in: float = 0.0
    excitation: Literal["wheels", "car"] = "wheels"
    before: int = 0

    @property
    def advance(self) -> float:
        """Travel in one time step, m."""
        return self.speed * self.time_step

    def entry(self, car: Car) -> tuple[int, float]:
        """Return the sample at or before which a car's front axle enters, and the share behind."""
        steps = car.axles[0].delay / self.advance
        whole = int(np.floor(steps + 1e-6))
        return whole + self.before, max(round(steps - whole, 6), 0.0)


class AnyTrain:
    """What every train answers, whether its cars have suspension or not.

    Attributes
    ----------
    formation : tuple of Car
        Front to back.
    """

    formation: tuple[Car, ...]
    notches: tuple[Notch, ...] = ()

    @cached_property
    def placed_axles(self) -> tuple[PlacedAxle, ...]:
        """All axles, car by car."""
        return tuple(axle for car in self.formation for axle in car.axles)

    @cached_property
    def wheels(self) -> tuple[Wheel, ...]:
        """All wheels, car by car."""
        return tuple(wheel for car in self.formation for wheel in car.wheels)

    @property
    def length(self) -> float:
        """First to last axle, m."""
        return max(axle.delay for axle in self.placed_axles)

    def car(self, number: int) -> Car:
        """Return a car by its number, from 1, front to back."""
        number = errors.integer("car", number, least=1, most=len(self.formation))
        return self.formation[number - 1]

    def kinds(self) -> list[tuple[Vehicle, list[Car]]]:
        """Return each kind of vehicle with the cars that are of it; none of bare axle loads."""
        found: dict[int, tuple[Vehicle, list[Car]]] = {}
        for car in self.formation:
            if car.vehicle is not None:
                found.setdefault(id(car.vehicle), (car.vehicle, []))[1].append(car)
        return list(found.values())

    def rigid_forces(
        self, track: Track, passage: Passage, more: Sequence[np.ndarray] | None = None
    ) -> list[np.ndarray]:
        """Return the wheel forces of every car on a rigid deck, without their static part.

        Parameters
        ----------
        track : Track
        passage : Passage
        more : sequence of ndarray, shape (wheels of the car, n) for each car, optional
            What its contacts carry more than their springs do, N, upwards on the wheels, from the
            sample at which it starts (see `rail_input`) to the end of the record.

        Returns
        -------
        list of ndarray, one for each car, shape (wheels of the car, 2, samples)
            N on the deck, lateral before vertical. To be read only: cars share them.
        """

        def zeros(car: Car) -> np.ndarray:
            return np.broadcast_to(0.0, (len(car.wheels), 2, passage.samples))

        return self._on_rigid_deck(Vehicle.sampled, zeros, track, passage, more)

    def rigid_accelerations(
        self, track: Track, passage: Passage, more: Sequence[np.ndarray] | None = None
    ) -> list[np.ndarray]:
        """Return the accelerations of every car body on a rigid deck, m/s2.

        Returns
        -------
        list of ndarray, one for each car, shape (places, 2, samples)
            Places as for `Vehicle.sampled_body`.
        """

        def zeros(car: Car) -> np.ndarray:
            return np.zeros((len(car.vehicle.body_places), 2, passage.samples))

        return self._on_rigid_deck(Vehicle.sampled_body, zeros, track, passage, more)

    def rigid_motion(
        self, track: Track, passage: Passage, more: Sequence[np.ndarray] | None = None
    ) -> list[np.ndarray]:
        """Return the motion of every car on a rigid deck, m and rad, about its place at rest.

        Returns
        -------
        list of ndarray, one for each car, shape (freedoms, 1, samples)
            Freedoms as in `Vehicle.labels`; none of bare axle loads.
        """

        def zeros(car: Car) -> np.ndarray:
            freedoms = len(car.vehicle.labels) if car.vehicle else 0
            return np.zeros((freedoms, 1, passage.samples))

        return self._on_rigid_deck(Vehicle.sampled_motion, zeros, track, passage, more)

    def _on_rigid_deck(
        self,
        response: Callable[[Vehicle, float], WheelResponse],
        zeros: Callable[[Car], np.ndarray],
        track: Track,
        passage: Passage,
        more: Sequence[np.ndarray] | None = None,
    ) -> list[np.ndarray]:
        """Run each kind of car once on the irregularity, and shift what it answers in time."""
        errors.choice("excitation", passage.excitation, EXCITATIONS)
        known: dict[tuple, np.ndarray] = {}
        result = []
        for car in self.formation:
            if car.vehicle is None or (track.level and not car.notches and more is None):
                result.append(zeros(car))
                continue
            shift, fraction = passage.entry(car)
            key = id(car.vehicle), fraction, car.notches, None if more is None else car.number
            if key not in known:
                u = _rail_input(car, track, passage, fraction)
                if more is not None:
                    u = _from_rest(u, passage)
                    own = more[car.number - 1]
                    u[:, 1, : own.shape[1]] += own
                if u.any():
                    known[key] = response(car.vehicle, passage.time_step)(u)
                else:
                    known[key] = np.zeros((*zeros(car).shape[:2], u.shape[-1]))
            first = known[key].shape[-1] - passage.samples - shift
            own = known[key][..., max(first, 0) : first + passage.samples]
            # A car whose run-up starts after the first sample stands on level track until then.
            result.append(np.pad(own, ((0, 0), (0, 0), (max(-first, 0), 0))) if first < 0 else own)
        return result


def rail_input(car: Car, track: Track, passage: Passage) -> tuple[int, np.ndarray]:
    """Return the sample at which a car starts, and k r + c r' from there on.

    That is one before its run-up begins or, if that is later, where it first feels the deck through
    a rail. The input, N, has the shape (wheels, 2, n), lateral before vertical.
    """
    shift, fraction = passage.entry(car)
    u = _from_rest(_rail_input(car, track, passage, fraction), passage)
    return shift + passage.samples - u.shape[-1], u


def _from_rest(u: np.ndarray, passage: Passage) -> np.ndarray:
    """Return an input with level track before it, from where the deck is first felt.

    At least one sample of it, so that what a contact carries more starts from nothing, too.
    """
    missing = passage.samples + passage.before + 1 - u.shape[-1]
    return np.pad(u, ((0, 0), (0, 0), (max(missing, 1), 0)))


def _rail_input(car: Car, track: Track, passage: Passage, fraction: float) -> np.ndarray:
    """Return k r + c r' of one car from its run-up on, shape (wheels, 2, n).

    Local sample j has the front axle at (j - fraction) V h.
    """
    vehicle, speed = car.vehicle, passage.speed
    before = int(np.ceil(passage.lead_in / passage.advance))
    local = (np.arange(-before, passage.samples) - fraction) * passage.advance
    front = car.wheels[0].x
    rails = {
        (direction, side): FadeIn(track.rail(direction, side), passage.lead_in)
        for direction in ("lateral", "vertical")
        for side in ("left", "right")
    }
    met: dict[tuple, tuple[np.ndarray, np.ndarray]] = {}
    u = np.empty((len(car.wheels), 2, len(local)))
    for i, wheel in enumerate(car.wheels):
        behind = front - (wheel.x if passage.excitation == "wheels" else vehicle.front)
        x = local - behind
        for j, direction in enumerate(("lateral", "vertical")):
            stiffness, damping = vehicle.contact_stiffness[i, j], vehicle.contact_damping[i, j]
            if not (stiffness or damping):
                u[i, j] = 0.0
                continue
            rail = rails[direction, wheel.side]
            key = id(rail.inner), behind
            if key not in met:
                met[key] = rail.value(x), speed * rail.slope(x)
            r, rate = met[key]
            if direction == "vertical":
                for notch, wheels in car.notches:
                    if wheel.number in wheels:
                        # Eq. 2 runs on the wheel's own place, wherever the rail's irregularity is
                        # taken.
                        own = local - (front - wheel.x)
                        r, rate = r + notch.value(own), rate + speed * notch.slope(own)
            u[i, j] = stiffness * r + damping * rate
    return u


@dataclass(frozen=True)
class Train(AnyTrain):
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

    __repr__ = brief

    vehicle: Vehicle | tuple[Vehicle, ...]
    cars: Annotated[int, Range(least=1, most=1000, whole=True)] | None = None
    car_spacing: Annotated[float, Range(above=0.0, unit="m")] | None = None
    notches: tuple[Notch, ...] = ()

    def __post_init__(self) -> None:
        several = self.vehicle
        if isinstance(self.vehicle, Vehicle):
            object.__setattr__(self, "cars", 1 if self.cars is None else self.cars)
        elif not (isinstance(several, (list, tuple)) and several) or not all(
            isinstance(vehicle, Vehicle) for vehicle in several
        ):
            raise InputError("vehicle", several, "must be a Vehicle or one Vehicle for each car")
        else:
            if self.cars not in (None, len(several)):
                allowed = f"must be the number of vehicles given, {len(several)}"
                raise InputError("cars", self.cars, allowed)
            object.__setattr__(self, "cars", len(several))
            object.__setattr__(self, "vehicle", tuple(several))
        check_fields(self)
        if not isinstance(self.notches, (list, tuple)) or not all(
            isinstance(notch, Notch) for notch in self.notches
        ):
            allowed = "must be a list of notches"
            raise InputError("notches", self.notches, allowed, "Put a single one into a list, too")
        object.__setattr__(self, "notches", tuple(self.notches))
        self._refuse_unknown_wheels()
        self._refuse_overlap()

    def _refuse_unknown_wheels(self) -> None:
        known = {(wheel.car, wheel.number) for wheel in self.wheels}
        for i, notch in enumerate(self.notches, start=1):
            for wheel in notch.wheels:
                if wheel not in known:
                    allowed = f"no such [car, wheel]; cars 1 to {self.cars}"
                    raise InputError(f"notches[{i}].wheels", wheel, allowed, "Count from 1")

    def _refuse_overlap(self) -> None:
        pairs = list(zip(self.formation[:-1], self.formation[1:], strict=True))
        for ahead, car in pairs:
            if car.axles[0].delay > ahead.axles[-1].delay:
                continue
            for vehicle in (ahead.vehicle, car.vehicle):
                reach = vehicle.axles[0].x - vehicle.axles[-1].x
                if vehicle.length and reach >= vehicle.length:
                    allowed = f"its axles reach over {reach:g} m, it is {vehicle.length:g} m long"
                    remedy = "Correct its length or the places of its axles"
                    raise InputError("vehicle", vehicle.name, allowed, remedy)
            # From the last axle of one to the first of the next, whatever the spacing.
            needed = max(b.vehicle.axles[0].x - a.vehicle.axles[-1].x for a, b in pairs)
            allowed = f"cars {ahead.number} and {car.number} overlap: the last axle of the one is "
            allowed += "not ahead of the first of the other"
            remedy = f"Their wheels need more than {needed:.6g} m between the middles of cars"
            if self.car_spacing is None:
                remedy = f"Give car_spacing, more than {needed:.6g} m, or correct their lengths"
            raise InputError("car_spacing", self.car_spacing, allowed, remedy)

    @cached_property
    def vehicles(self) -> tuple[Vehicle, ...]:
        """The vehicle of each car."""
        several = isinstance(self.vehicle, tuple)
        return self.vehicle if several else (self.vehicle,) * self.cars

    @cached_property
    def centres(self) -> np.ndarray:
        """Mid-length of each car, m behind the first axle, shape (cars,)."""
        if self.car_spacing:
            steps = np.full(self.cars - 1, self.car_spacing)
        elif self.cars == 1:
            steps = np.empty(0)
        else:
            for vehicle in self.vehicles:
                if vehicle.length is None:
                    remedy = f"Give it, or the length of {vehicle.name}"
                    raise InputError("car_spacing", None, "is missing", remedy)
            lengths = np.array([v.length for v in self.vehicles])
            steps = (lengths[:-1] + lengths[1:]) / 2
        return np.concatenate([[0.0], np.cumsum(steps)]) + self.vehicles[0].axles[0].x

    @cached_property
    def formation(self) -> tuple[Car, ...]:
        """Every car in its place, front to back."""
        result = []
        for number, (vehicle, centre) in enumerate(
            zip(self.vehicles, self.centres.tolist(), strict=True), start=1
        ):
            placed = []
            for axle in vehicle.axles:
                wheels = []
                for w in axle.wheels:
                    contact = vehicle.contacts[w]
                    side = "right" if contact.y < 0 else "left"
                    delay = centre - contact.x
                    place = contact.y, side, contact.static_load, contact.carries, contact.x
                    wheels.append(Wheel(number, w + 1, delay, *place))
                placed.append(PlacedAxle(number, centre - axle.x, tuple(wheels)))
            notched = (
                (notch, tuple(w for c, w in notch.wheels if c == number)) for notch in self.notches
            )
            own = tuple((notch, wheels) for notch, wheels in notched if wheels)
            result.append(Car(number, centre, tuple(placed), vehicle, own))
        return tuple(result)


@dataclass(frozen=True)
class AxleTrain(AnyTrain):
    """Bare axle loads: no suspension, so the wheel force is the static one whatever the deck does.

    Attributes
    ----------
    axles : sequence of float
        m behind the first axle, ascending from 0.
    loads : sequence of float
        N of each axle, down positive.
    name : str, optional
        For people; trains of the same axles and loads are equal whatever they are called.
    """

    __repr__ = brief

    axles: Annotated[tuple[float, ...], Range(least=0.0, unit="m")]
    loads: Annotated[tuple[float, ...], Range(above=0.0, unit="N")]
    name: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        check_fields(self)
        if len(self.loads) != len(self.axles):
            allowed = f"must hold {len(self.axles)} numbers, it holds {len(self.loads)}"
            raise InputError("loads", list(self.loads), allowed, "Give one load for each axle")
        if not self.axles or self.axles[0] != 0.0 or np.any(np.diff(self.axles) <= 0):
            allowed = "must ascend from 0, the first axle"
            remedy = "Subtract the first axle's place from all"
            raise InputError("axles", list(self.axles), allowed, remedy)

    @classmethod
    def from_spacings(
        cls, spacings: Sequence[float], loads: Sequence[float], name: str | None = None
    ) -> AxleTrain:
        """Make a train of the distances between neighbouring axles, as drawings give them.

        Parameters
        ----------
        spacings : sequence of float, shape (n - 1,)
            m from each axle to the next one behind it.
        loads : sequence of float, shape (n,)
            N of each axle, down positive.
        name : str, optional

        Raises
        ------
        InputError
            A spacing that is not above 0, or one number too many or too few.
        """
        apart = errors.numbers("spacings", spacings, above=0.0, unit="m")
        carried = errors.numbers("loads", loads, above=0.0, unit="N")
        if len(carried) != len(apart) + 1:
            allowed = f"must hold {len(apart) + 1} numbers, it holds {len(carried)}"
            remedy = "There is one axle more than there are spacings"
            raise InputError("loads", list(loads), allowed, remedy)
        return cls(np.concatenate([[0.0], np.cumsum(apart)]), carried, name)

    @property
    def weight(self) -> float:
        """All loads together, N."""
        return sum(self.loads)

    @cached_property
    def formation(self) -> tuple[Car, ...]:
        """All axles as one car without suspension; each carries one wheel on the centre line."""
        axles = tuple(
            PlacedAxle(1, delay, (Wheel(1, i, delay, 0.0, "left", load, "axle", -delay),))
            for i, (delay, load) in enumerate(zip(self.axles, self.loads, strict=True), start=1)
        )
        return (Car(1, 0.0, axles),)
