r"""Rail vehicles: rigid bodies on springs and dampers.

A point r of a body (measured from its centre of mass) moves by ``u + theta x r``. The stretch of a spring between two
points is therefore linear in the freedoms, ``e = g . x - (support motion)``, and every spring adds ``k g g^T`` to the
stiffness and ``c g g^T`` to the damping. A spring that ends on the rail makes a wheel contact: its support moves by the
irregularity r and the deck, which enters the equations only as ``u = k r + c r'``:

    M x'' + C x' + K x = G^T u,      force on the deck = k g.x + c g.x' - u + static part.

Axes: x forward, y left, z up; freedoms in the order y, z, roll, pitch, yaw. The origin of a vehicle is at rail level
below its mid-length.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import eigh

from . import errors
from .errors import InputError, frozen
from .response import LinearSystem, SampledResponse, second_order_system
from .units import G

__all__ = [
    "CAR_PARAMETERS", "FREEDOMS", "Body", "Contact", "Modes", "Spring", "Vehicle", "planar_car", "sprung_mass", "two_bogie_car",
]  # fmt: skip

FREEDOMS = ("y", "z", "roll", "pitch", "yaw")
_INERTIA_AXIS = {"roll": 0, "pitch": 1, "yaw": 2}


@dataclass(frozen=True)
class Body:
    """A rigid body.

    Attributes
    ----------
    name : str
    mass : float
        kg.
    inertia : tuple of 3 floats
        Mass moments of inertia in roll, pitch and yaw, kg m2. Only those of its freedoms count.
    position : tuple of 3 floats
        Centre of mass in the vehicle frame, m.
    freedoms : tuple of str
        A subset of y, z, roll, pitch, yaw. One left out is held still in space, so without z the rail does not carry the weight.
    """

    name: str
    mass: float
    inertia: tuple[float, float, float]
    position: tuple[float, float, float]
    freedoms: tuple[str, ...] = FREEDOMS


@dataclass(frozen=True)
class Spring:
    """A spring and damper between two bodies, or between a body and the rail.

    Attributes
    ----------
    from_, to : str
        Names of bodies; one of them may be ``"rail"``, which makes a wheel contact.
    at : tuple of 3 floats
        Where it stands in the vehicle frame, m; rigidly tied to both ends.
    stiffness : tuple of 2 floats
        Lateral and vertical, N/m.
    damping : tuple of 2 floats
        Lateral and vertical, N s/m.
    """

    from_: str
    to: str
    at: tuple[float, float, float]
    stiffness: tuple[float, float]
    damping: tuple[float, float]


@dataclass(frozen=True)
class Contact:
    """A wheel: its body ("bogie"), its place in the vehicle frame (x, y, m) and its static load (N, down positive)."""

    body: str
    x: float
    y: float
    static_load: float


@dataclass(frozen=True)
class Modes:
    """Natural or damped modes of a vehicle.

    Attributes
    ----------
    frequencies_hz : ndarray, shape (n,)
        Ascending. For damped modes the modulus of the eigenvalue over 2 pi.
    damping_ratios : ndarray, shape (n,)
        Zero for natural modes.
    shapes : ndarray, shape (freedoms, n)
        Mass-normalised if natural; complex, largest entry 1, if damped. Equal frequencies have no unique shapes: only
        the subspace they span means something.
    labels : tuple of str
        Freedoms, for instance ``car z``.
    names : tuple of str
        The freedom that carries most of the kinetic energy.
    """

    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    shapes: np.ndarray
    labels: tuple[str, ...]
    names: tuple[str, ...]

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {"frequency (Hz)": self.frequencies_hz, "damping ratio": self.damping_ratios, "moves most": self.names}
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self.names) + 1, name="mode"))


@dataclass(frozen=True)
class Vehicle:
    """A linear vehicle: bodies joined by springs, standing on the rail through contacts.

    Attributes
    ----------
    name : str
    bodies : tuple of Body
    springs : tuple of Spring
    length : float
        Over couplers, m; the default distance between cars.
    static_wheelset_mass : float
        Mass of one wheelset, kg, carried straight by the rail. Only its weight counts. Wrong above the frequency where
        the wheelset's inertia force reaches the contact force, about sqrt(k/m)/(2 pi) of the primary suspension.

    Raises
    ------
    InputError
        A name that is not unique or unknown, a mass, inertia or length that is not positive, negative stiffness or
        damping, no contact with the rail, a freedom that no spring holds, or a wheel lifted off the rail at rest.
    """

    name: str
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...]
    length: float
    static_wheelset_mass: float = 0.0
    labels: tuple[str, ...] = field(init=False)

    def __post_init__(self) -> None:
        _check(self)
        labels = tuple(f"{b.name} {f}" for b in self.bodies for f in FREEDOMS if f in b.freedoms)
        object.__setattr__(self, "labels", labels)
        if len(labels) == 0:
            raise InputError(f"vehicle {self.name}: freedoms", None, "no body has a freedom")
        _refuse_mechanism(self)
        _refuse_lifted_wheel(self)

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (n, n); kg and kg m2."""
        diagonal = []
        for body in self.bodies:
            for f in FREEDOMS:
                if f in body.freedoms:
                    diagonal.append(body.inertia[_INERTIA_AXIS[f]] if f in _INERTIA_AXIS else body.mass)
        return frozen(np.diag(diagonal).astype(float))

    @cached_property
    def _rows(self) -> list[tuple[Spring, int, np.ndarray]]:
        """Each spring and direction (0 lateral, 1 vertical) with its stretch row, shape (n,)."""
        result = []
        for spring in self.springs:
            ends = [self._point_rows(end, spring.at) for end in (spring.from_, spring.to)]
            # The body end counts positive, so that a contact's stretch is (body) - (rail).
            sign = 1.0 if spring.to == "rail" else -1.0
            stretch = sign * (ends[0] - ends[1])
            result += [(spring, direction, stretch[direction]) for direction in (0, 1)]
        return result

    def _point_rows(self, name: str, at: tuple[float, float, float]) -> np.ndarray:
        """Lateral and vertical motion of a point tied to a body, as rows over the freedoms, shape (2, n)."""
        rows = np.zeros((2, len(self.labels)))
        for body in self.bodies:
            if body.name != name:
                continue
            x, y, z = (p - c for p, c in zip(at, body.position, strict=True))
            motion = {"y": (1, 0), "z": (0, 1), "roll": (-z, y), "pitch": (0, -x), "yaw": (x, 0)}
            for f in body.freedoms:
                rows[:, self.labels.index(f"{name} {f}")] = motion[f]
        return rows

    def _assemble(self, attribute: str) -> np.ndarray:
        total = np.zeros((len(self.labels),) * 2)
        for spring, direction, row in self._rows:
            total += getattr(spring, attribute)[direction] * np.outer(row, row)
        return total

    @cached_property
    def stiffness_matrix(self) -> np.ndarray:
        """K, shape (n, n); N/m and N m. Without the gravity stiffness of the high body."""
        return frozen(self._assemble("stiffness"))

    @cached_property
    def damping_matrix(self) -> np.ndarray:
        """C, shape (n, n); N s/m and N m s."""
        return frozen(self._assemble("damping"))

    @cached_property
    def _contact_springs(self) -> list[Spring]:
        springs = [s for s in self.springs if "rail" in (s.from_, s.to)]
        return sorted(springs, key=lambda s: (-s.at[0], -s.at[1]))

    def _contact_rows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Stretch rows of the contacts, shape (2 contacts, n), lateral before vertical, with k and c, shape (2 contacts,)."""
        found = [(s, row) for s, _, row in self._rows if "rail" in (s.from_, s.to)]
        # Sorted as the contacts are; sorting is stable, so lateral stays before vertical.
        rows = np.array([row for _, row in sorted(found, key=lambda pair: (-pair[0].at[0], -pair[0].at[1]))])
        k = np.array([v for s in self._contact_springs for v in s.stiffness])
        c = np.array([v for s in self._contact_springs for v in s.damping])
        return rows, k, c

    @property
    def weight(self) -> float:
        """Total weight, N, wheelsets included."""
        axles = len({s.at[0] for s in self._contact_springs})
        return (sum(b.mass for b in self.bodies) + axles * self.static_wheelset_mass) * G

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Wheels, front to back, left before right, with the static loads of the car at rest on a level track."""
        gravity = np.array([m * G * lbl.endswith(" z") for m, lbl in zip(np.diag(self.mass_matrix), self.labels, strict=True)])
        rest = np.linalg.solve(self.stiffness_matrix, -gravity)
        rows, k, _ = self._contact_rows()
        loads = -(k * (rows @ rest))[1::2]
        springs = self._contact_springs
        per_axle = {x: sum(s.at[0] == x for s in springs) for x in {s.at[0] for s in springs}}
        own = [self.static_wheelset_mass * G / per_axle[s.at[0]] for s in springs]
        bodies = [s.to if s.from_ == "rail" else s.from_ for s in springs]
        return tuple(
            Contact(b, s.at[0], s.at[1], float(load + extra))
            for b, s, load, extra in zip(bodies, springs, loads, own, strict=True)
        )

    @cached_property
    def contact_stiffness(self) -> np.ndarray:
        """Lateral and vertical stiffness of every contact, N/m, shape (contacts, 2)."""
        return frozen(self._contact_rows()[1].reshape(-1, 2))

    @cached_property
    def contact_damping(self) -> np.ndarray:
        """Lateral and vertical damping of every contact, N s/m, shape (contacts, 2)."""
        return frozen(self._contact_rows()[2].reshape(-1, 2))

    def system(self) -> LinearSystem:
        """Return the vehicle with input ``k r + c r'`` and output ``k g.x + c g.x'``, both shape (2 contacts,), N.

        The force on the deck without its static part is output minus input.
        """
        return self._system

    @cached_property
    def _system(self) -> LinearSystem:
        rows, k, c = self._contact_rows()
        output = np.hstack([k[:, None] * rows, c[:, None] * rows])
        return second_order_system(self.mass_matrix, self.damping_matrix, self.stiffness_matrix, rows.T, output)

    def sampled(self, time_step: float) -> SampledResponse:
        """Return `system` ready to run at one time step (s)."""
        return self.system().sampled(time_step)

    @property
    def body(self) -> Body:
        """The car body: the heaviest one."""
        return max(self.bodies, key=lambda b: b.mass)

    @property
    def body_places(self) -> dict[str, float]:
        """Where the car body's motion is told, m ahead of mid-length: above its foremost and rearmost springs, and between."""
        on = [s.at[0] for s in self.springs if self.body.name in (s.from_, s.to)]
        return {"front": max(on), "middle": self.body.position[0], "rear": min(on)}

    def body_system(self) -> tuple[LinearSystem, np.ndarray]:
        """Return how the car body's accelerations follow from the input of `system`.

        At the height of the body's centre of mass, at each of `body_places`: lateral, vertical, so six outputs (m/s2).

        Returns
        -------
        LinearSystem
            What its state gives.
        ndarray, shape (6, 2 contacts)
            What the input adds directly; zero where no spring of the body ends on the rail.
        """
        height = self.body.position[2]
        points = [self._point_rows(self.body.name, (x, 0.0, height)) for x in self.body_places.values()]
        accelerations = np.linalg.solve(self.mass_matrix, np.vstack(points).T).T
        state = -accelerations @ np.hstack([self.stiffness_matrix, self.damping_matrix])
        return replace(self.system(), c=state), accelerations @ self._contact_rows()[0].T

    def transfer(self, frequency_hz: float) -> np.ndarray:
        """Return the steady contact forces for unit harmonic support motion.

        Returns
        -------
        ndarray, shape (2 contacts, 2 contacts), complex
            Force on the deck (N) at contact and direction i for 1 m at contact and direction j; lateral before vertical.
        """
        rows, k, c = self._contact_rows()
        s = 2j * np.pi * frequency_hz
        dynamic = self.mass_matrix * s**2 + self.damping_matrix * s + self.stiffness_matrix
        impedance = k + c * s
        return impedance[:, None] * (rows @ np.linalg.solve(dynamic, rows.T)) * impedance - np.diag(impedance)

    def modes(self) -> Modes:
        """Return the natural modes (no damping), ascending (Table 2)."""
        values, shapes = eigh(self.stiffness_matrix, self.mass_matrix)
        names = tuple(self.labels[i] for i in np.argmax(np.diag(self.mass_matrix)[:, None] * shapes**2, axis=0))
        return Modes(np.sqrt(np.clip(values, 0, None)) / (2 * np.pi), np.zeros(len(values)), shapes, self.labels, names)

    def damped_modes(self) -> Modes:
        """Return the damped modes: ``|s|/(2 pi)`` and ``-Re(s)/|s|`` of every eigenvalue with ``Im(s) >= 0``.

        An overdamped mode shows as two real roots, each with ratio 1.
        """
        n = len(self.labels)
        poles, vectors = np.linalg.eig(self.system().a)
        keep = poles.imag >= 0
        order = np.argsort(np.abs(poles[keep]))
        poles, shapes = poles[keep][order], vectors[:n, keep][:, order]
        energy = np.diag(self.mass_matrix)[:, None] * np.abs(shapes) ** 2
        names = tuple(self.labels[i] for i in np.argmax(energy, axis=0))
        largest = shapes[np.argmax(np.abs(shapes), axis=0), np.arange(shapes.shape[1])]
        return Modes(np.abs(poles) / (2 * np.pi), -poles.real / np.abs(poles), shapes / largest, self.labels, names)


def _check(v: Vehicle) -> None:
    where = f"vehicle {v.name}"
    errors.number(f"{where}: length", v.length, above=0.0, unit="m")
    errors.number(f"{where}: static_wheelset_mass", v.static_wheelset_mass, least=0.0, unit="kg")
    names = [b.name for b in v.bodies]
    for body in v.bodies:
        here = f"{where}: body {body.name}"
        if body.name == "rail" or names.count(body.name) > 1:
            raise InputError(f"{here}: name", body.name, "must be unique and not 'rail'")
        errors.number(f"{here}: mass", body.mass, above=0.0, unit="kg")
        errors.numbers(f"{here}: position", body.position, count=3, unit="m")
        errors.numbers(f"{here}: inertia", body.inertia, count=3, least=0.0, unit="kg m2")
        for f in body.freedoms:
            errors.choice(f"{here}: freedoms", f, FREEDOMS)
            if f in _INERTIA_AXIS:
                errors.number(f"{here}: inertia in {f}", body.inertia[_INERTIA_AXIS[f]], above=0.0, unit="kg m2")
    for i, spring in enumerate(v.springs, start=1):
        here = f"{where}: spring {i} ({spring.from_} to {spring.to})"
        for end in (spring.from_, spring.to):
            errors.choice(f"{here}: end", end, [*names, "rail"])
        if spring.from_ == spring.to:
            raise InputError(f"{here}: end", spring.to, "must differ from the other end")
        errors.numbers(f"{here}: at", spring.at, count=3, unit="m")
        errors.numbers(f"{here}: stiffness", spring.stiffness, count=2, least=0.0, unit="N/m")
        errors.numbers(f"{here}: damping", spring.damping, count=2, least=0.0, unit="N s/m")
        if max(*spring.stiffness, *spring.damping) == 0.0:
            raise InputError(f"{here}: stiffness", spring.stiffness, "spring and damper are both zero", "Remove it")
    axles = [s.at[0] for s in v.springs if "rail" in (s.from_, s.to)]
    if not axles:
        raise InputError(f"{where}: spring", None, "no spring reaches the rail", "Give one end of a spring as 'rail'")
    if min(axles) > 0.0 or max(axles) < 0.0:
        raise InputError(
            f"{where}: spring: at", sorted(axles), "all wheels are on one side of x = 0", "Measure x from mid-length"
        )


def _refuse_mechanism(v: Vehicle) -> None:
    """Name the body and freedom that no spring holds."""
    scale = 1.0 / np.sqrt(np.diag(v.mass_matrix))
    values, vectors = np.linalg.eigh(scale[:, None] * v.stiffness_matrix * scale)
    if values[0] <= 1e-10 * values[-1]:
        loose = v.labels[int(np.argmax(np.abs(vectors[:, 0])))]
        body, freedom = loose.rsplit(" ", 1)
        raise InputError(
            f"vehicle {v.name}: body {body}: {freedom}",
            None,
            "is held by no spring, so the vehicle is a mechanism",
            f"Add a spring that resists {freedom}, or take it from the body's freedoms",
        )


def _refuse_lifted_wheel(v: Vehicle) -> None:
    """Refuse a vehicle that would tip over: the contact is permanent here, so such a wheel would pull at the rail."""
    for wheel in v.contacts:
        if wheel.static_load < -1e-9 * v.weight:
            raise InputError(
                f"vehicle {v.name}: wheel at x = {wheel.x:g}, y = {wheel.y:g} m: static load",
                f"{wheel.static_load:.4g} N",
                "must not be negative, the vehicle tips over at rest",
                "Correct the positions of bodies and springs, measured from mid-length",
            )


# ---- kinds of vehicles

CAR_PARAMETERS = {
    "car_body_mass": "kg", "car_body_roll_inertia": "kg m2", "car_body_pitch_inertia": "kg m2", "car_body_yaw_inertia": "kg m2",
    "bogie_mass": "kg", "bogie_roll_inertia": "kg m2", "bogie_pitch_inertia": "kg m2", "bogie_yaw_inertia": "kg m2",
    "primary_vertical_stiffness": "N/m", "primary_lateral_stiffness": "N/m",
    "secondary_vertical_stiffness": "N/m", "secondary_lateral_stiffness": "N/m",
    "primary_vertical_damping": "N s/m", "primary_lateral_damping": "N s/m",
    "secondary_vertical_damping": "N s/m", "secondary_lateral_damping": "N s/m",
    "length": "m", "bogie_spacing": "m", "axle_spacing": "m",
    "car_body_above_secondary": "m", "secondary_above_bogie": "m", "primary_below_bogie": "m",
    "primary_half_width": "m", "secondary_half_width": "m",
}  # fmt: skip
"""Names of a two-bogie car's parameter table (Table 1) with their SI units."""


def two_bogie_car(name: str, **p: float) -> Vehicle:
    """Build the 15-freedom car of Table 1 and Figure 1: a car body on two bogies, each on two axles.

    Parameters
    ----------
    name : str
    **p : float
        The values of `CAR_PARAMETERS`, SI. Stiffness and damping are per spring: each bogie has two secondary springs (left
        and right), each axle two primary springs.

    Notes
    -----
    The paper gives no height above the rail. The primary springs are placed at rail level, so that the lateral wheel
    force acts there (no couple F_y times height on the deck).
    """
    errors.keys(f"vehicle {name}", p, CAR_PARAMETERS, CAR_PARAMETERS)
    for key in ("length", "bogie_spacing", "axle_spacing", "primary_half_width", "secondary_half_width"):
        errors.number(f"vehicle {name}: {key}", p[key], above=0.0, unit="m")
    bogie_z = p["primary_below_bogie"]
    secondary_z = bogie_z + p["secondary_above_bogie"]
    inertia = {b: tuple(p[f"{b}_{r}_inertia"] for r in ("roll", "pitch", "yaw")) for b in ("car_body", "bogie")}
    bodies = [Body("car", p["car_body_mass"], inertia["car_body"], (0.0, 0.0, secondary_z + p["car_body_above_secondary"]))]
    springs = []
    for bogie, sign in (("front bogie", 1.0), ("rear bogie", -1.0)):
        x = sign * p["bogie_spacing"] / 2
        bodies.append(Body(bogie, p["bogie_mass"], inertia["bogie"], (x, 0.0, bogie_z)))
        for side in (1.0, -1.0):
            at = (x, side * p["secondary_half_width"], secondary_z)
            springs.append(_suspension("secondary", "car", bogie, at, p))
        for axle in (1.0, -1.0):
            for side in (1.0, -1.0):
                at = (x + axle * p["axle_spacing"] / 2, side * p["primary_half_width"], 0.0)
                springs.append(_suspension("primary", bogie, "rail", at, p))
    return Vehicle(name, tuple(bodies), tuple(springs), p["length"])


def _suspension(level: str, upper: str, lower: str, at: tuple[float, float, float], p: dict[str, float]) -> Spring:
    stiffness, damping = ((p[f"{level}_lateral_{w}"], p[f"{level}_vertical_{w}"]) for w in ("stiffness", "damping"))
    return Spring(upper, lower, at, stiffness, damping)


def sprung_mass(name: str, mass: float, stiffness: float, damping: float = 0.0, length: float = 10.0) -> Vehicle:
    """Build a mass on a vertical spring and damper (kg, N/m, N s/m): the smallest vehicle."""
    body = Body("mass", mass, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    return Vehicle(name, (body,), (Spring("mass", "rail", (0.0, 0.0, 0.0), (0.0, stiffness), (0.0, damping)),), length)


def planar_car(car: Vehicle) -> Vehicle:
    """Reduce a car to its vertical plane: bounce and pitch of every body, left and right springs put together at y = 0.

    Springs that are lateral only are left out.
    """
    bodies = tuple(replace(b, freedoms=tuple(f for f in b.freedoms if f in ("z", "pitch"))) for b in car.bodies)
    joined: dict[tuple, Spring] = {}
    for s in car.springs:
        if s.stiffness[1] == s.damping[1] == 0.0:
            continue
        key = (s.from_, s.to, s.at[0], s.at[2])
        before = joined.get(key, Spring(s.from_, s.to, (s.at[0], 0.0, s.at[2]), (0.0, 0.0), (0.0, 0.0)))
        total = (0.0, before.stiffness[1] + s.stiffness[1]), (0.0, before.damping[1] + s.damping[1])
        joined[key] = Spring(s.from_, s.to, before.at, *total)
    return Vehicle(f"{car.name} planar", bodies, tuple(joined.values()), car.length, car.static_wheelset_mass)
