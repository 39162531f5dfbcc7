r"""Answers that do not come from this package: closed forms, and equations written down anew.

They share the parameter file of the car with the package and nothing else, so `verification` and
the tests can hold the package to them.

Throughout, a simple beam of length L, mass m per metre and stiffness E I has the frequencies
``omega_n = (n pi / L)^2 sqrt(E I / m)``, the critical speed
``v_1 = pi / L sqrt(E I / m) = 2 f_1 L`` and the speed ratio ``alpha = v / v_1``.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from ..cases import shelf

__all__ = [
    "FORCE", "GRAVITY", "PlaneVehicle", "SimpleBeam", "car_in_plane", "coupled_solution",
    "force_beam", "moving_force", "yang_yau",
]  # fmt: skip

FORCE = 200e3
"""The moving force, N."""

GRAVITY = 9.81
"""m/s2."""


@dataclass(frozen=True)
class SimpleBeam:
    """A simple beam by its closed form.

    Attributes
    ----------
    length, mass, bending : float
        m, kg/m, N m2.
    alpha, beta : float
        Rayleigh damping, 1/s and s.
    """

    length: float
    mass: float
    bending: float
    alpha: float = 0.0
    beta: float = 0.0

    def omega(self, n: np.ndarray | float) -> np.ndarray | float:
        """Return circular frequencies, rad/s."""
        return (n * np.pi / self.length) ** 2 * np.sqrt(self.bending / self.mass)

    @property
    def critical_speed(self) -> float:
        """v_1, m/s."""
        return float(np.pi / self.length * np.sqrt(self.bending / self.mass))

    def deflection(self, force: float) -> float:
        """Return the mid-span deflection under a force (N, down) at mid-span, m."""
        return force * self.length**3 / (48 * self.bending)


def force_beam() -> SimpleBeam:
    """Return the beam of the moving force: 40 m, 10 t/m, first frequency 2 Hz, v_1 = 160 m/s."""
    length, mass, frequency = 40.0, 10e3, 2.0
    return SimpleBeam(length, mass, mass * (2 * np.pi * frequency * length**2 / np.pi**2) ** 2)


def moving_force(
    beam: SimpleBeam, speed: float, time: np.ndarray, ratio: float = 0.0, terms: int = 100
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    r"""Return A_n, its velocity and acceleration under a force P that crosses the beam.

    A_n are the terms of the deflection ``w = sum A_n sin(n pi x / L)``. Derivation (Fryba,
    Vibration of Solids and Structures under Moving Loads, chapter 1): each term obeys

        A_n'' + 2 zeta omega_n A_n' + omega_n^2 A_n = -(2 P / m L) sin(n Omega t)

    with ``Omega = pi v / L``, whose particular solution is ``Im(H exp(i n Omega t))`` with

        H = -(2 P / m L) / (omega_n^2 - n^2 Omega^2 + 2 i zeta omega_n n Omega);

    the free vibration that brings the beam to rest at t = 0 is added to it. Without damping and at
    n Omega = omega_n the sum tends to ``-(P / m L omega^2) (sin omega t - omega t cos omega t)``.
    From t = L / v on the vibration is free.

    Parameters
    ----------
    beam : SimpleBeam
    speed : float
        m/s.
    time : ndarray, shape (n,)
        s.
    ratio : float
        zeta, the same in every term.
    terms : int

    Returns
    -------
    three ndarrays, shape (terms, n)
        m, m/s, m/s2.
    """
    n = np.arange(1, terms + 1)[:, None]
    w, drive = beam.omega(n), n * np.pi * speed / beam.length
    wd, decay = w * np.sqrt(1 - ratio**2), ratio * w
    amplitude = -2 * FORCE / (beam.mass * beam.length)
    leave = beam.length / speed

    def forced(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        resonant = (np.abs(drive - w) < 1e-12 * w) & (ratio == 0.0)
        dynamic = np.where(resonant, 1.0, w**2 - drive**2 + 2j * decay * drive)
        h = amplitude / dynamic
        steady = h * np.exp(1j * drive * t)
        a = -h.imag
        b = (decay * a - drive * h.real) / wd
        swing, fade = np.exp(1j * wd * t), np.exp(-decay * t)
        value = steady.imag + fade * (a * swing.real + b * swing.imag)
        rate = (1j * drive * steady).imag
        rate = rate + fade * ((wd * b - decay * a) * swing.real - (wd * a + decay * b) * swing.imag)
        growing = amplitude / (2 * w**2)
        value = np.where(resonant, growing * (np.sin(w * t) - w * t * np.cos(w * t)), value)
        rate = np.where(resonant, growing * w**2 * t * np.sin(w * t), rate)
        return value, rate

    inside = time <= leave * (1 + 1e-12)
    value, rate = forced(np.where(inside, time, 0.0))
    last, last_rate = forced(np.array([leave]))
    after = np.where(inside, 0.0, time - leave)
    swing, fade = np.exp(1j * wd * after), np.exp(-decay * after)
    second = (last_rate + decay * last) / wd
    free = fade * (last * swing.real + second * swing.imag)
    cosine, sine = wd * second - decay * last, wd * last + decay * second
    free_rate = fade * (cosine * swing.real - sine * swing.imag)
    value, rate = np.where(inside, value, free), np.where(inside, rate, free_rate)
    load = np.where(inside, amplitude * np.sin(drive * time), 0.0)
    return value, rate, load - 2 * decay * rate - w**2 * value


@dataclass(frozen=True)
class PlaneVehicle:
    """A vehicle in the vertical plane as matrices, written down by hand.

    Attributes
    ----------
    mass, damping, stiffness : ndarray, shape (f, f)
        With the wheels held still.
    rows : ndarray, shape (axles, f)
        Upward motion of the upper end of each axle's spring.
    spring, damper : float
        Of an axle, N/m and N s/m.
    delays : ndarray, shape (axles,)
        m behind the first axle.
    static : ndarray, shape (axles,)
        N, down.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    rows: np.ndarray
    spring: float
    damper: float
    delays: np.ndarray
    static: np.ndarray


def coupled_solution(
    car: PlaneVehicle,
    beam: SimpleBeam,
    modes: int,
    speed: float,
    time: np.ndarray,
    wave: tuple[float, float] = (0.0, 1.0),
) -> tuple[np.ndarray, np.ndarray]:
    r"""Integrate train and deck as one set of differential equations, at tight tolerance.

    With the axles at x_i = v t - d_i, S = sin(n pi x_i / L) while on the deck, q the terms of the
    deflection, and r the track,

        u = S q + r,    u' = S q' + v S' q + v r'              (the wheel climbs along the deck)
        F = k (G z - u) + c (G z' - u') - W                    (on the deck, up)
        M z'' + C z' + K z = G^T (k u + c u')
        q'' + (alpha + beta omega^2) q' + omega^2 q = (2 / m L) S^T F

    from one event, an axle meeting an end of the deck, to the next.

    Parameters
    ----------
    car : PlaneVehicle
    beam : SimpleBeam
    modes : int
        Terms of the deflection.
    speed : float
        m/s.
    time : ndarray, shape (n,)
        From zero, s.
    wave : (amplitude, wavelength)
        m; ``r = a sin(2 pi x / lambda)`` from the entrance on, level before.

    Returns
    -------
    displacement : ndarray, shape (n,)
        At mid-span, m.
    forces : ndarray, shape (axles, n)
        N, static part included.
    """
    n = np.arange(1, modes + 1)
    number, omega, f = n * np.pi / beam.length, beam.omega(n), len(car.mass)
    damping = beam.alpha + beam.beta * omega**2
    inverse, (amplitude, wavelength) = np.linalg.inv(car.mass), wave
    wavenumber = 2 * np.pi / wavelength

    def contact(
        t: float, y: np.ndarray, entered: np.ndarray, on: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x = speed * t - car.delays
        shape = on[:, None] * np.sin(np.outer(x, number))
        slope = on[:, None] * number * np.cos(np.outer(x, number))
        z, rate, q, q_rate = np.split(y, [f, 2 * f, 2 * f + modes])
        r = entered * amplitude * np.sin(wavenumber * x)
        r_slope = entered * amplitude * wavenumber * np.cos(wavenumber * x)
        u = shape @ q + r
        du = shape @ q_rate + speed * (slope @ q + r_slope)
        springs = car.spring * (car.rows @ z - u)
        forces = springs + car.damper * (car.rows @ rate - du) - car.static
        return forces, car.spring * u + car.damper * du, shape

    def derivative(t: float, y: np.ndarray, entered: np.ndarray, on: np.ndarray) -> np.ndarray:
        forces, push, shape = contact(t, y, entered, on)
        z, rate, q, q_rate = np.split(y, [f, 2 * f, 2 * f + modes])
        up = inverse @ (car.rows.T @ push - car.stiffness @ z - car.damping @ rate)
        load = 2 / (beam.mass * beam.length) * shape.T @ forces
        return np.concatenate([rate, up, q_rate, load - damping * q_rate - omega**2 * q])

    passages = [car.delays / speed, (car.delays + beam.length) / speed]
    events = np.unique(np.concatenate([[0.0, time[-1]], *passages]).round(12))
    events = events[events <= time[-1]]
    state = np.zeros(2 * f + 2 * modes)
    displacement, forces = np.zeros(len(time)), np.tile(-car.static[:, None], len(time))
    tight = {"rtol": 1e-8, "atol": 1e-12}
    for start, stop in zip(events[:-1], events[1:], strict=True):
        place = speed * (start + stop) / 2 - car.delays
        entered, on = place > 0.0, (place > 0.0) & (place < beam.length)
        inside = np.flatnonzero((time > start + 1e-11) & (time <= stop + 1e-11))
        wanted = np.minimum(time[inside], stop)
        if len(wanted) == 0 or wanted[-1] < stop:
            wanted = np.append(wanted, stop)
        y = solve_ivp(
            derivative, (start, stop), state, "DOP853", wanted, args=(entered, on), **tight
        ).y
        state = y[:, -1]
        displacement[inside] = np.sin(n * np.pi / 2) @ y[2 * f : 2 * f + modes, : len(inside)]
        for k, column in zip(inside, y.T, strict=False):
            forces[:, k] = contact(time[k], column, entered, on)[0]
    return displacement, forces


def yang_yau() -> tuple[PlaneVehicle, SimpleBeam, float]:
    """Return vehicle, beam and speed of the moving sprung mass, without damping.

    Yang & Yau (1997), J. Struct. Eng. 123(11), section on the sprung mass.
    """
    mass, spring = 5750.0, 1595e3
    car = PlaneVehicle(
        mass=np.array([[mass]]),
        damping=np.zeros((1, 1)),
        stiffness=np.array([[spring]]),
        rows=np.ones((1, 1)),
        spring=spring,
        damper=0.0,
        delays=np.zeros(1),
        static=np.array([mass * GRAVITY]),
    )
    return car, SimpleBeam(25.0, 2303.0, 2.87e9 * 2.90), 100 / 3.6


def car_in_plane() -> tuple[PlaneVehicle, SimpleBeam]:
    """Return the paper's car with 6 freedoms and its deck in the vertical plane.

    The car is Table 1 by hand, the deck has 3.307 Hz and a damping of 3 % at two frequencies.

    Freedoms: z and pitch (nose down positive) of car body, front and rear bogie. A point x ahead
    of a body's centre rises by z - x pitch. Each axle has two primary springs, each bogie two
    secondary ones.
    """
    scale = {"kg": 1.0, "kg m2": 1.0, "m": 1.0, "kN/m": 1e3, "kN s/m": 1e3}
    path = shelf.data_file("vehicles", "xia2000")
    with path.open(encoding="utf-8") as file:
        p = {row["name"]: float(row["value"]) * scale[row["unit"]] for row in csv.DictReader(file)}
    half, axle = p["bogie_spacing"] / 2, p["axle_spacing"] / 2
    spring, damper = 2 * p["primary_vertical_stiffness"], 2 * p["primary_vertical_damping"]
    secondary = np.array([[1, -half, -1, 0, 0, 0], [1, half, 0, 0, -1, 0]], dtype=float)
    rows = np.zeros((4, 6))
    rows[:2, 2:4] = rows[2:, 4:] = [[1, -axle], [1, axle]]
    bogie = [p["bogie_mass"], p["bogie_pitch_inertia"]]
    weight = (p["car_body_mass"] + 2 * p["bogie_mass"]) * GRAVITY
    secondary_stiffness, secondary_damping = (
        2 * p[f"secondary_vertical_{kind}"] for kind in ("stiffness", "damping")
    )
    car = PlaneVehicle(
        mass=np.diag([p["car_body_mass"], p["car_body_pitch_inertia"], *bogie, *bogie]),
        damping=secondary_damping * secondary.T @ secondary + damper * rows.T @ rows,
        stiffness=secondary_stiffness * secondary.T @ secondary + spring * rows.T @ rows,
        rows=rows,
        spring=spring,
        damper=damper,
        delays=np.array([0.0, 2 * axle, 2 * half, 2 * half + 2 * axle]),
        static=np.full(4, weight / 4),
    )
    first, second = 2 * np.pi * 3.307, 2 * np.pi * 16.30
    alpha, beta = 0.06 * first * second / (first + second), 0.06 / (first + second)
    return car, SimpleBeam(36.0, 2500.0 * 4.8, 35e9 * 2.553, alpha, beta)
