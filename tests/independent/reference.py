"""An independent solution of train and deck: the coupled differential equations, integrated at
tight tolerance.

It shares nothing with the package but the parameter files: the planar car's equations and the
beam's modes are written here from the book, and `scipy.integrate` walks through them from one event
(an axle enters or leaves) to the next.
"""

import csv
import tomllib
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

DATA = Path(__file__).resolve().parents[2] / "data"
G = 9.81


def car_parameters():
    """Table 1 of the paper in SI, by name."""
    scale = {"kg": 1.0, "kg m2": 1.0, "m": 1.0, "kN/m": 1e3, "kN s/m": 1e3}
    with (DATA / "vehicles" / "xia2000.csv").open(encoding="utf-8") as file:
        return {
            row["name"]: float(row["value"]) * scale[row["unit"]] for row in csv.DictReader(file)
        }


class PlanarCar:
    """Car body and two bogies in the vertical plane: z, pitch each (pitch positive nose down), four
    axles."""

    def __init__(self):
        p = car_parameters()
        half, axle = p["bogie_spacing"] / 2, p["axle_spacing"] / 2
        self.offsets = np.array([half + axle, half - axle, -half + axle, -half - axle])
        self.k, self.c = 2 * p["primary_vertical_stiffness"], 2 * p["primary_vertical_damping"]
        ks, cs = 2 * p["secondary_vertical_stiffness"], 2 * p["secondary_vertical_damping"]
        self.mass = np.diag(
            [
                p["car_body_mass"],
                p["car_body_pitch_inertia"],
                *(p["bogie_mass"], p["bogie_pitch_inertia"]) * 2,
            ]
        )
        # A point x ahead of a body's centre rises by z - x * pitch.
        secondary = np.array([[1, -half, -1, 0, 0, 0], [1, half, 0, 0, -1, 0]], dtype=float)
        self.axle_rows = np.array(
            [
                [0, 0, 1, -axle, 0, 0],
                [0, 0, 1, axle, 0, 0],
                [0, 0, 0, 0, 1, -axle],
                [0, 0, 0, 0, 1, axle],
            ]
        )
        self.stiffness = ks * secondary.T @ secondary + self.k * self.axle_rows.T @ self.axle_rows
        self.damping = cs * secondary.T @ secondary + self.c * self.axle_rows.T @ self.axle_rows
        self.static = (p["car_body_mass"] + 2 * p["bogie_mass"]) * G / 4


class SimpleBeam:
    """Closed-form modes of the shipped deck, a simple span, in the vertical plane."""

    def __init__(self, modes):
        deck = tomllib.loads((DATA / "decks" / "viaduct36.toml").read_text(encoding="utf-8"))
        section, (self.length,) = deck["section"], deck["spans"]
        self.mass = section["density"] * section["area"]
        self.bending = section["youngs_modulus"] * section["second_moment_vertical"]
        self.number = np.arange(1, modes + 1)
        self.omega = (self.number * np.pi / self.length) ** 2 * np.sqrt(self.bending / self.mass)
        f1, f2 = (2 * np.pi * f for f in deck["damping"]["frequencies_hz"])
        ratio = deck["damping"]["ratio"]
        alpha, beta = 2 * ratio * f1 * f2 / (f1 + f2), 2 * ratio / (f1 + f2)
        self.damping = alpha + beta * self.omega**2

    def shape(self, x):
        """Mass-normalised shapes and slopes at x, zero off the deck."""
        on = 0.0 <= x <= self.length
        a = self.number * np.pi / self.length
        size = on * np.sqrt(2 / (self.mass * self.length))
        return size * np.sin(a * x), size * a * np.cos(a * x)


def one_planar_car(speed, modes, times, amplitude=0.0, wavelength=1.0, climb=True):
    """Mid-span displacement (m) and axle forces on the deck (N, static included) of one planar car,
    coupled.

    The track is level before the deck and r = A sin(2 pi x / lambda) from its entrance on. Without
    `climb` the convective term, speed times the deck's slope, is left out.
    """
    car, beam = PlanarCar(), SimpleBeam(modes)
    n = len(car.mass)
    delay = car.offsets[0] - car.offsets
    inverse = np.linalg.inv(car.mass)

    def forces(t, state, between):
        x, v, q, qd = (
            state[:n],
            state[n : 2 * n],
            state[2 * n : 2 * n + modes],
            state[2 * n + modes :],
        )
        result = np.empty(4)
        for i in range(4):
            place = speed * t - delay[i]
            r = rate = 0.0
            if speed * between - delay[i] >= 0.0:
                wave = 2 * np.pi / wavelength
                r, rate = (
                    amplitude * np.sin(wave * place),
                    speed * amplitude * wave * np.cos(wave * place),
                )
            if 0.0 <= speed * between - delay[i] <= beam.length:
                shape, slope = beam.shape(min(max(place, 0.0), beam.length))
                r += shape @ q
                rate += shape @ qd + climb * speed * slope @ q
            result[i] = car.k * (car.axle_rows[i] @ x - r) + car.c * (car.axle_rows[i] @ v - rate)
        return result

    def derivative(t, state, between):
        x, v, q, qd = (
            state[:n],
            state[n : 2 * n],
            state[2 * n : 2 * n + modes],
            state[2 * n + modes :],
        )
        contact = forces(t, state, between)
        # What the axle springs lack in `stiffness @ x` is the motion of their lower ends.
        lower = car.k * (car.axle_rows @ x) + car.c * (car.axle_rows @ v) - contact
        a = inverse @ (car.axle_rows.T @ lower - car.stiffness @ x - car.damping @ v)
        qdd = -beam.damping * qd - beam.omega**2 * q
        for i in range(4):
            if 0.0 <= speed * between - delay[i] <= beam.length:
                qdd = qdd + beam.shape(min(max(speed * t - delay[i], 0.0), beam.length))[0] * (
                    contact[i] - car.static
                )
        return np.concatenate([v, a, qd, qdd])

    events = sorted(
        {0.0, times[-1], *(d / speed for d in delay), *((d + beam.length) / speed for d in delay)}
    )
    events = [e for e in events if e <= times[-1]]
    state = np.zeros(2 * n + 2 * modes)
    middle = np.zeros(len(times))
    exerted = np.full((4, len(times)), -car.static)
    for start, stop in zip(events[:-1], events[1:], strict=True):
        inside = (times > start + 1e-12) & (times <= stop + 1e-12)
        between = (start + stop) / 2
        wanted = np.append(np.minimum(times[inside], stop), stop)
        found = solve_ivp(
            derivative,
            (start, stop),
            state,
            "DOP853",
            t_eval=np.unique(wanted),
            args=(between,),
            rtol=1e-10,
            atol=1e-13,
        )
        state = found.y[:, -1]
        for k, t in zip(np.flatnonzero(inside), times[inside], strict=True):
            y = found.y[:, np.argmin(np.abs(found.t - t))]
            middle[k] = beam.shape(beam.length / 2)[0] @ y[2 * n : 2 * n + modes]
            exerted[:, k] += forces(t, y, between)
    return middle, exerted
