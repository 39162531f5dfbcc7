r"""Rail vehicles: rigid bodies on springs and dampers.

A point r of a body (measured from its centre of mass) moves by ``u + theta x r``. The stretch of a
spring between two points is therefore linear in the freedoms, ``e = g . x - (support motion)``, and
every spring adds ``k g g^T`` to the stiffness and ``c g g^T`` to the damping. A spring that ends on
the rail makes a wheel contact: its support moves by the irregularity r and the deck, which enters
the equations only as ``u = k r + c r'``:

    M x'' + C x' + K x = G^T u,      force on the deck = k g.x + c g.x' - u + static part.

A damper c that acts through a spring k carries the force f, a state of its own (Maxwell):
``f' = k g.x' - (k/c) f``, and ``-g f`` goes to the right-hand side. What wheels feel and exert has
the shape (wheels, 2, ...): lateral before vertical. Axes and freedoms: see `bodies`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated

import numpy as np
from scipy.linalg import eigh

from . import errors
from .bodies import FREEDOMS, INERTIA_AXIS, AntiRollBar, Body, Spring
from .errors import InputError, Range, brief, check_fields, frozen, within
from .response import LinearSystem, SampledResponse, relaxing, second_order_system
from .units import G

__all__ = [
    "FREEDOMS", "AntiRollBar", "Axle", "Body", "Contact", "Modes", "Spring", "Vehicle",
    "WheelForces", "WheelResponse",
]  # fmt: skip

_BESIDE = 1e-6
"""Wheels nearer than this along the track (m) are on one axle: more is no rounding of input."""

WheelResponse = Callable[[np.ndarray], np.ndarray]
"""From ``k r + c r'`` at every wheel, N, shape (wheels, 2, ..., n), to what follows from it."""


@dataclass(frozen=True)
class Contact:
    """A wheel.

    Attributes
    ----------
    body : str
        The body that stands on it.
    x, y : float
        Its place in the vehicle frame, m.
    static_load : float
        N, down positive.
    carries : str
        The body whose wheel it is: of a wheelset the bogie in which it hangs, else `body`.
    """

    body: str
    x: float
    y: float
    static_load: float
    carries: str


@dataclass(frozen=True)
class Axle:
    """Wheels side by side: they meet the deck at one place.

    Attributes
    ----------
    x : float
        m ahead of the vehicle's mid-length.
    wheels : tuple of int
        Which of the vehicle's contacts, from 0, left before right.
    """

    x: float
    wheels: tuple[int, ...]


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
        Mass-normalised if natural; complex, largest entry 1, if damped. Equal frequencies have no
        unique shapes: only the subspace they span means something.
    labels : tuple of str
        Freedoms, for instance ``car z``.
    names : tuple of str
        The freedom that carries most of the kinetic energy.
    """

    __repr__ = brief

    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    shapes: np.ndarray
    labels: tuple[str, ...]
    names: tuple[str, ...]

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {
            "frequency (Hz)": self.frequencies_hz,
            "damping ratio": self.damping_ratios,
            "moves most": self.names,
        }
        return pd.DataFrame(columns, index=pd.RangeIndex(1, len(self.names) + 1, name="mode"))


@dataclass(frozen=True)
class Vehicle:
    """A linear vehicle: bodies joined by springs, standing on the rail through contacts.

    Attributes
    ----------
    name : str
        For people.
    bodies : tuple of Body
        Car body, bogies.
    springs : tuple of Spring
        Suspension and contacts.
    length : float, optional
        m over couplers; the default distance between cars. May be left out where trains are given
        their car spacing.
    static_wheelset_mass : float
        kg of one wheelset, carried straight by the rail. Only its weight counts, not its inertia;
        `with_wheelsets` makes bodies of it. That matters once waves shake the car above its bounce,
        where the springs press little: 1800 kg under `xia2000`, wheels in phase, would change the
        force by -0.3 % at 1.389 Hz, by -14 % at 2 Hz and by +64 % at 4.2 Hz.
    anti_roll_bars : tuple of AntiRollBar
        Between bodies that roll.

    Raises
    ------
    InputError
        A name that is not unique or unknown, no contact with the rail, a freedom that no spring
        holds, or a wheel lifted off the rail at rest.
    """

    __repr__ = brief

    name: str
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...]
    length: Annotated[float, Range(above=0.0, unit="m")] | None = None
    static_wheelset_mass: Annotated[float, Range(least=0.0, unit="kg")] = 0.0
    anti_roll_bars: tuple[AntiRollBar, ...] = ()
    labels: tuple[str, ...] = field(init=False, default=())

    def __post_init__(self) -> None:
        errors.text("name", self.name)
        with within(source=f"vehicle {self.name}"):
            check_fields(self)
            object.__setattr__(self, "bodies", errors.instances("bodies", self.bodies, Body))
            object.__setattr__(self, "springs", errors.instances("springs", self.springs, Spring))
            bars = errors.instances("anti_roll_bars", self.anti_roll_bars, AntiRollBar)
            object.__setattr__(self, "anti_roll_bars", bars)
            _refuse_wrong_ends(self)
            labels = tuple(
                f"{b.name} {f}" for b in self.bodies for f in FREEDOMS if f in b.freedoms
            )
            object.__setattr__(self, "labels", labels)
            _refuse_mechanism(self)
            _refuse_lifted_wheel(self)

    # ---- matrices

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (n, n); kg and kg m2."""
        diagonal = []
        for body in self.bodies:
            for f in FREEDOMS:
                if f in body.freedoms:
                    rotates = f in INERTIA_AXIS
                    diagonal.append(body.inertia[INERTIA_AXIS[f]] if rotates else body.mass)
        return frozen(np.diag(diagonal).astype(float))

    def _point_rows(self, name: str, at: tuple[float, float, float]) -> np.ndarray:
        """Motion of a point tied to a body: lateral, vertical, along the track, shape (3, n).

        As rows over the freedoms. Along the track a body only turns: theta_y r_z - theta_z r_y.
        """
        rows = np.zeros((3, len(self.labels)))
        for body in self.bodies:
            if body.name != name:
                continue
            x, y, z = (p - c for p, c in zip(at, body.position, strict=True))
            motion = {
                "y": (1, 0, 0), "z": (0, 1, 0), "roll": (-z, y, 0), "pitch": (0, -x, z),
                "yaw": (x, 0, -y),
            }  # fmt: skip
            for f in body.freedoms:
                rows[:, self.labels.index(f"{name} {f}")] = motion[f]
        return rows

    def _stretch_rows(self, spring: Spring) -> np.ndarray:
        """Stretch of a spring: lateral, vertical, along the track, shape (3, n)."""
        from_, to = (self._point_rows(end, spring.at) for end in (spring.from_, spring.to))
        # The body end counts positive, so that a contact's stretch is (body) - (rail).
        return from_ - to if spring.to == "rail" else to - from_

    def _assembled(self, springs: str, bars: str) -> np.ndarray:
        total = np.zeros((len(self.labels),) * 2)
        for spring in self.springs:
            for value, row in zip(
                getattr(spring, springs), self._stretch_rows(spring), strict=True
            ):
                total += value * np.outer(row, row)
        for bar in self.anti_roll_bars:
            row = np.zeros(len(self.labels))
            row[[self.labels.index(f"{end} roll") for end in (bar.from_, bar.to)]] = -1.0, 1.0
            total += getattr(bar, bars) * np.outer(row, row)
        return frozen(total)

    @cached_property
    def stiffness_matrix(self) -> np.ndarray:
        """K, shape (n, n); N/m and N m. Without the gravity stiffness of the high body."""
        return self._assembled("stiffnesses", "stiffness")

    @cached_property
    def damping_matrix(self) -> np.ndarray:
        """C, shape (n, n); N s/m and N m s. Without dampers in series with a spring."""
        return self._assembled("straight_dampings", "damping")

    @cached_property
    def _in_series(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Dampers in series with a spring: stretch, shape (m, n), k (N/m) and c (N s/m)."""
        found = [
            (self._stretch_rows(spring)[direction], k, c)
            for spring in self.springs
            for direction, k, c in spring.series
        ]
        rows = np.array([row for row, _, _ in found]).reshape(-1, len(self.labels))
        return frozen(rows), *(np.array([each[i] for each in found]) for i in (1, 2))

    # ---- wheels

    @cached_property
    def _standing(self) -> tuple[tuple[Axle, ...], tuple[Spring, ...]]:
        """Axles and the springs of the contacts, from front to back, left before right."""
        rows: list[list[Spring]] = []
        for spring in sorted((s for s in self.springs if s.on_rail), key=lambda s: -s.at[0]):
            if not rows or rows[-1][0].at[0] - spring.at[0] > _BESIDE:
                rows.append([])
            rows[-1].append(spring)
        axles, springs = [], []
        for row in rows:
            wheels = range(len(springs), len(springs) + len(row))
            axles.append(Axle(row[0].at[0], tuple(wheels)))
            springs += sorted(row, key=lambda s: -s.at[1])
        return tuple(axles), tuple(springs)

    @property
    def axles(self) -> tuple[Axle, ...]:
        """Wheels that stand side by side, front to back."""
        return self._standing[0]

    @property
    def front(self) -> float:
        """The front end, m ahead of mid-length.

        Raises
        ------
        InputError
            A vehicle without a length.
        """
        if self.length is None:
            allowed = f"is the irregularity at the car's front end, and {self.name} has no length"
            remedy = "Give the vehicle its length, or use 'wheels'"
            raise InputError("excitation", "car", allowed, remedy)
        return self.length / 2

    @property
    def weight(self) -> float:
        """Total weight, N, wheelsets included."""
        masses = sum(b.mass for b in self.bodies) + len(self.axles) * self.static_wheelset_mass
        return masses * G

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Wheels, front to back, left before right, with the static loads of the car at rest."""
        masses = zip(np.diag(self.mass_matrix), self.labels, strict=True)
        gravity = np.array([mass * G * label.endswith(" z") for mass, label in masses])
        rest = np.linalg.solve(self.stiffness_matrix, -gravity)
        stretch = self.contact_stretch @ rest
        result = []
        for axle in self.axles:
            own = self.static_wheelset_mass * G / len(axle.wheels)
            for wheel in axle.wheels:
                spring = self._standing[1][wheel]
                body = spring.to if spring.from_ == "rail" else spring.from_
                load = -(self.contact_stiffness[wheel, 1] * stretch[wheel, 1])
                place = axle.x, spring.at[1], float(load + own)
                result.append(Contact(body, *place, self._hangs_in.get(body, body)))
        return tuple(result)

    @cached_property
    def contact_stretch(self) -> np.ndarray:
        """What each freedom adds to the stretch of every contact's spring, shape (contacts, 2, n).

        gamma: the stretch is ``gamma . q`` less the motion of the rail; lateral before vertical.
        """
        return frozen(np.array([self._stretch_rows(s)[:2] for s in self._standing[1]]))

    @cached_property
    def contact_stiffness(self) -> np.ndarray:
        """Lateral and vertical stiffness of every contact, N/m, shape (contacts, 2)."""
        return frozen(np.array([s.stiffness for s in self._standing[1]]))

    @cached_property
    def contact_damping(self) -> np.ndarray:
        """Lateral and vertical damping of every contact, N s/m, shape (contacts, 2)."""
        return frozen(np.array([s.damping for s in self._standing[1]]))

    # ---- response

    @cached_property
    def system(self) -> LinearSystem:
        """The vehicle with input ``k r + c r'`` and output ``k g.x + c g.x'``, both in N.

        Both are all contacts in one row, lateral before vertical. The force on the deck without its
        static part is output minus input. The state holds the freedoms, their rates, and the force
        of every damper in series with a spring.
        """
        rows = self.contact_stretch.reshape(-1, len(self.labels))
        k, c = self.contact_stiffness.reshape(-1, 1), self.contact_damping.reshape(-1, 1)
        output = np.hstack([k * rows, c * rows])
        matrices = self.mass_matrix, self.damping_matrix, self.stiffness_matrix
        plain = second_order_system(*matrices, rows.T, output)
        return relaxing(plain, self.mass_matrix, *self._in_series)

    def sampled(self, time_step: float) -> WheelForces:
        """Return what gives the forces on the deck, without their static part, from ``k r + c r'``.

        Both in N.

        Parameters
        ----------
        time_step : float
            s.
        """
        if time_step not in self._sampled:
            self._sampled.clear()  # one is kept: a slider meets a new step in every run
            self._sampled[time_step] = WheelForces(self.system.sampled(time_step))
        return self._sampled[time_step]

    @cached_property
    def _sampled(self) -> dict[float, WheelForces]:
        """What `sampled` gave last, by its time step."""
        return {}

    @property
    def body(self) -> Body:
        """The car body: the heaviest one."""
        return max(self.bodies, key=lambda b: b.mass)

    @property
    def wheelsets(self) -> tuple[Body, ...]:
        """The bodies that are wheelsets, front to back.

        A wheelset stands on the wheels of one axle, does not pitch (it rolls), and hangs in another
        body; the car body is none.
        """
        found = [body for body in self.bodies if body.name in self._hangs_in]
        return tuple(sorted(found, key=lambda b: -b.position[0]))

    @property
    def contact_frequency(self) -> float:
        """The highest frequency of a wheelset bouncing on its contacts alone, Hz; 0 without any."""
        held = dict.fromkeys((body.name for body in self.wheelsets), 0.0)
        for contact, stiffness in zip(self.contacts, self.contact_stiffness[:, 1], strict=True):
            if contact.body in held:
                held[contact.body] += stiffness
        squares = [held[body.name] / body.mass for body in self.wheelsets]
        return float(np.sqrt(max(squares, default=0.0)) / (2 * np.pi))

    @cached_property
    def _hangs_in(self) -> dict[str, str]:
        """The body in which every wheelset hangs, by name; the wheelset itself if it is several."""
        places: dict[str, list[float]] = {}
        above: dict[str, set[str]] = {}
        for spring in self.springs:
            for low, high in ((spring.from_, spring.to), (spring.to, spring.from_)):
                if high == "rail":
                    places.setdefault(low, []).append(spring.at[0])
                elif low != "rail":
                    above.setdefault(low, set()).add(high)
        rolling = (b.name for b in self.bodies if "pitch" not in b.freedoms and b != self.body)
        result = {}
        for name in rolling:
            x = places.get(name)
            if x and name in above and max(x) - min(x) <= _BESIDE:
                result[name] = above[name].pop() if len(above[name]) == 1 else name
        return result

    @property
    def car_bodies(self) -> tuple[Body, ...]:
        """The car body, or every coach of an articulated train, front to back.

        Bodies no fewer springs above the rail than the heaviest one, with a fifth of its mass at
        least: neither bogies nor what hangs in them.
        """
        levels, count = {"rail": 0}, 0
        while len(levels) > count:
            count = len(levels)
            for spring in self.springs:
                for low, high in ((spring.from_, spring.to), (spring.to, spring.from_)):
                    if levels.get(low, count) + 1 < levels.get(high, count + 1):
                        levels[high] = levels[low] + 1
        least = levels[self.body.name]
        own = [b for b in self.bodies if levels[b.name] >= least and b.mass >= self.body.mass / 5]
        return tuple(sorted(own, key=lambda b: -b.position[0]))

    @property
    def body_places(self) -> tuple[tuple[Body, str, float], ...]:
        """Where the motion of `car_bodies` is taken: the body, a name, m ahead of mid-length.

        ``front`` and ``rear`` above its foremost and rearmost springs, ``middle`` at its centre of
        mass.
        """
        found = []
        for body in self.car_bodies:
            on = [s.at[0] for s in self.springs if body.name in (s.from_, s.to)]
            places = {"front": max(on), "middle": body.position[0], "rear": min(on)}
            found += [(body, name, x) for name, x in places.items()]
        return tuple(found)

    def sampled_body(self, time_step: float) -> WheelResponse:
        """Return what gives the car bodies' accelerations, m/s2, from ``k r + c r'``.

        At the height of the bodies' centres of mass, at each of `body_places`, lateral and
        vertical: shape (places, 2, n) from shape (wheels, 2, n).

        Parameters
        ----------
        time_step : float
            s.
        """
        places = self.body_places
        moving = np.vstack(
            [self._point_rows(b.name, (x, 0.0, b.position[2]))[:2] for b, _, x in places]
        )
        accelerations = np.linalg.solve(self.mass_matrix, moving.T).T
        pushed = self.stiffness_matrix, self.damping_matrix, self._in_series[0].T
        state = -accelerations @ np.hstack(pushed)
        respond = replace(self.system, c=state).sampled(time_step)
        # Zero where no spring of the body ends on the rail.
        direct = accelerations @ self.contact_stretch.reshape(-1, len(self.labels)).T

        def body_accelerations(u: np.ndarray) -> np.ndarray:
            inputs = u.reshape(-1, u.shape[-1])
            return (respond(inputs) + direct @ inputs).reshape(len(places), 2, -1)

        return body_accelerations

    def sampled_motion(self, time_step: float) -> WheelResponse:
        """Return what gives the motion of every freedom, m and rad, from ``k r + c r'``.

        About the place at rest: shape (n, 1, samples) from shape (wheels, 2, samples), freedoms as
        in `labels`.

        Parameters
        ----------
        time_step : float
            s.
        """
        moving = np.eye(len(self.labels), len(self.system.a))
        respond = replace(self.system, c=moving).sampled(time_step)

        def motion(u: np.ndarray) -> np.ndarray:
            return respond(u.reshape(-1, u.shape[-1]))[:, None]

        return motion

    def motion(self, frequency_hz: float) -> np.ndarray:
        """Return the steady motion of every freedom for unit harmonic support motion.

        Parameters
        ----------
        frequency_hz : float

        Returns
        -------
        ndarray, shape (n, contacts, 2), complex
            Motion (m or rad) of a freedom, as in `labels`, for 1 m at a contact and direction;
            lateral before vertical.
        """
        rows, s, impedance = self._at_frequency(frequency_hz)
        dynamic = self.mass_matrix * s**2 + self.damping_matrix * s + self.stiffness_matrix
        stretch, k, c = self._in_series
        dynamic = dynamic + stretch.T * (k * c * s / (k + c * s)) @ stretch
        motion = np.linalg.solve(dynamic, rows.T * impedance)
        return motion.reshape(len(rows.T), len(rows) // 2, 2)

    def transfer(self, frequency_hz: float) -> np.ndarray:
        """Return the steady contact forces for unit harmonic support motion.

        Parameters
        ----------
        frequency_hz : float

        Returns
        -------
        ndarray, shape (contacts, 2, contacts, 2), complex
            Force on the deck (N) at a contact and direction for 1 m at another contact and
            direction; lateral before vertical.
        """
        rows, _, impedance = self._at_frequency(frequency_hz)
        through = rows @ self.motion(frequency_hz).reshape(rows.shape[::-1])
        forces = impedance[:, None] * through - np.diag(impedance)
        return forces.reshape((len(rows) // 2, 2) * 2)

    def _at_frequency(self, frequency_hz: float) -> tuple[np.ndarray, complex, np.ndarray]:
        """Return rows of the contacts' stretch, the exponent, and k + c s of every contact."""
        rows = self.contact_stretch.reshape(-1, len(self.labels))
        s = 2j * np.pi * errors.number("frequency_hz", frequency_hz, unit="Hz")
        return rows, s, (self.contact_stiffness + self.contact_damping * s).ravel()

    # ---- modes

    def modes(self) -> Modes:
        """Return the natural modes (no damping), ascending (Table 2).

        Without the springs through which dampers act, too: they hold nothing at rest.
        """
        values, shapes = eigh(self.stiffness_matrix, self.mass_matrix)
        frequencies = np.sqrt(np.clip(values, 0, None)) / (2 * np.pi)
        return Modes(frequencies, np.zeros(len(values)), shapes, self.labels, self._moving(shapes))

    @cached_property
    def highest_frequency(self) -> float:
        """The highest of the natural frequencies, Hz."""
        return float(self.modes().frequencies_hz[-1])

    def damped_modes(self) -> Modes:
        """Return the damped modes: ``|s|/(2 pi)`` and ``-Re(s)/|s|`` of every eigenvalue.

        Of a pair the one with ``Im(s) >= 0``. An overdamped mode shows as two real roots, each with
        ratio 1; a damper in series with a spring adds a real root.
        """
        n = len(self.labels)
        poles, vectors = np.linalg.eig(self.system.a)
        keep = poles.imag >= 0
        order = np.argsort(np.abs(poles[keep]))
        poles, shapes = poles[keep][order], vectors[:n, keep][:, order]
        largest = shapes[np.argmax(np.abs(shapes), axis=0), np.arange(shapes.shape[1])]
        ratios = -poles.real / np.abs(poles)
        frequencies = np.abs(poles) / (2 * np.pi)
        return Modes(frequencies, ratios, shapes / largest, self.labels, self._moving(shapes))

    def _moving(self, shapes: np.ndarray) -> tuple[str, ...]:
        """Name each shape by the freedom with most of the kinetic energy."""
        energy = np.diag(self.mass_matrix)[:, None] * np.abs(shapes) ** 2
        return tuple(self.labels[i] for i in np.argmax(energy, axis=0))


@dataclass(frozen=True)
class WheelForces:
    """What gives wheel forces on the deck from ``k r + c r'``; made by `Vehicle.sampled`.

    Attributes
    ----------
    respond : SampledResponse
        That of `Vehicle.system`.
    """

    __repr__ = brief

    respond: SampledResponse

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return forces without their static part, N, shape (wheels, 2, ..., n) as that of u."""
        inputs = u.reshape(-1, *u.shape[2:])
        result = self.respond(inputs)
        result -= inputs
        return result.reshape(u.shape)

    def after(self, u: np.ndarray, samples: int) -> np.ndarray:
        """Return how the forces decay on level track behind an input's last sample.

        Shape (wheels, 2, ..., samples).
        """
        inputs = u.reshape(-1, *u.shape[2:])
        return self.respond.after(inputs, samples).reshape(*u.shape[:-1], samples)


# ---- refusals


def _refuse_wrong_ends(vehicle: Vehicle) -> None:
    names = [body.name for body in vehicle.bodies]
    for i, name in enumerate(names, start=1):
        if names.count(name) > 1:
            raise InputError(f"bodies[{i}].name", name, "must be unique")
    for i, spring in enumerate(vehicle.springs, start=1):
        with within(f"springs[{i}]", {"from_": "from"}):
            errors.choice("from_", spring.from_, [*names, "rail"])
            errors.choice("to", spring.to, [*names, "rail"])
    freedoms = {body.name: body.freedoms for body in vehicle.bodies}
    for i, bar in enumerate(vehicle.anti_roll_bars, start=1):
        with within(f"anti_roll_bars[{i}]", {"from_": "from"}):
            for field, end in (("from_", bar.from_), ("to", bar.to)):
                errors.choice(field, end, names)
                if "roll" not in freedoms[end]:
                    remedy = "Add roll to its freedoms, or leave the bar out"
                    raise InputError(field, end, "does not roll", remedy)
    places = [s.at[0] for s in vehicle.springs if s.on_rail]
    if not places:
        remedy = "Give one end of a spring as 'rail'"
        raise InputError("springs", None, "no spring reaches the rail", remedy)
    if min(places) > 0.0 or max(places) < 0.0:
        allowed = "all wheels are on one side of x = 0"
        raise InputError("springs: at", sorted(places), allowed, "Measure x from mid-length")


def _refuse_mechanism(vehicle: Vehicle) -> None:
    """Name the body and freedom that no spring holds."""
    if not vehicle.labels:
        raise InputError("bodies", None, "no body has a freedom")
    scale = 1.0 / np.sqrt(np.diag(vehicle.mass_matrix))
    values, vectors = np.linalg.eigh(scale[:, None] * vehicle.stiffness_matrix * scale)
    if values[0] <= 1e-10 * values[-1] and not _stiff(vehicle.stiffness_matrix):
        loose = vehicle.labels[int(np.argmax(np.abs(vectors[:, 0])))]
        body, freedom = loose.rsplit(" ", 1)
        raise InputError(
            f"body {body}: {freedom}",
            None,
            "is held by no spring, so the vehicle is a mechanism",
            f"Add a spring that resists {freedom}, or take it from the body's freedoms",
        )


def _stiff(matrix: np.ndarray) -> bool:
    """Whether a stiffness matrix holds every freedom, however far its springs differ.

    A light wheelset on its contact swings a million times faster than the car body sways; against
    its own diagonal that does not count.
    """
    own = np.diag(matrix)
    if own.min() <= 0.0:
        return False
    scale = 1.0 / np.sqrt(own)
    return bool(np.linalg.eigvalsh(scale[:, None] * matrix * scale)[0] > 1e-12)


def _refuse_lifted_wheel(vehicle: Vehicle) -> None:
    """Refuse a vehicle that would tip over: contact is permanent, so such a wheel would pull."""
    for wheel in vehicle.contacts:
        if wheel.static_load < -1e-9 * vehicle.weight:
            raise InputError(
                f"wheel at x = {wheel.x:g}, y = {wheel.y:g} m: static load",
                f"{wheel.static_load:.4g} N",
                "must not be negative, the vehicle tips over at rest",
                "Correct the positions of bodies and springs, measured from mid-length",
            )
