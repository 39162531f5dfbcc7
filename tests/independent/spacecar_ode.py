"""A body on two wheelsets in space on a simple beam in space, as plain differential equations.

Written for the tests from Newton's laws, without the package: everything that is not of a plane,
wheelsets that roll and yaw, gauge and springs of different width, rods along the track, dampers in
series, contacts after Hertz, in scipy's adaptive integrator at a tight tolerance. A point r of a
body moves by u + theta x r.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

G = 9.81
TURNS = ("roll", "pitch", "yaw")


@dataclass(frozen=True)
class Part:
    """A body: kg, kg m2, m, and how it moves."""

    mass: float
    inertia: tuple
    place: tuple
    freedoms: tuple


@dataclass(frozen=True)
class Link:
    """A spring with its damper, x, y, z; `series` is what the damper acts through, 0 for none."""

    low: str
    high: str
    at: tuple
    k: tuple
    c: tuple
    series: tuple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Wheel:
    """A contact below a body: lateral and vertical stiffness, vertical damping."""

    body: str
    at: tuple
    lateral: float
    vertical: float
    damping: float


class SpaceCar:
    """Matrices of parts and links, and how its wheels move; freedoms as (part, freedom)."""

    def __init__(self, parts, links, wheels):
        self.parts, self.wheels = parts, wheels
        self.labels = [(name, f) for name, part in parts.items() for f in part.freedoms]
        n = len(self.labels)
        self.mass = np.array(
            [
                parts[name].mass if f in "yz" else parts[name].inertia[TURNS.index(f)]
                for name, f in self.labels
            ]
        )
        self.k, self.c = np.zeros((2, n, n))
        series = []
        for link in links:
            stretch = self.point(link.high, link.at) - self.point(link.low, link.at)
            for row, k, c, own in zip(stretch, link.k, link.c, link.series, strict=True):
                self.k += k * np.outer(row, row)
                if own:
                    series.append((row, own, c))
                else:
                    self.c += c * np.outer(row, row)
        self.series = np.array([row for row, _, _ in series]).reshape(-1, n)
        self.series_k, self.series_c = (np.array([each[i] for each in series]) for i in (1, 2))
        moves = np.array([self.point(w.body, w.at) for w in wheels])
        self.across, self.up = moves[:, 1], moves[:, 2]
        self.lateral, self.vertical, self.damping = (
            np.array([getattr(w, what) for w in wheels])
            for what in ("lateral", "vertical", "damping")
        )
        held = (
            self.k
            + self.up.T * self.vertical @ self.up
            + self.across.T * self.lateral @ (self.across)
        )
        weight = np.array([-G * parts[name].mass * (f == "z") for name, f in self.labels])
        self.load = -self.vertical * (self.up @ np.linalg.solve(held, weight))

    def point(self, name, at):
        """How a point of a part moves, x, y, z, over the freedoms."""
        rows = np.zeros((3, len(self.labels)))
        away = np.subtract(at, self.parts[name].place)
        for i, (own, freedom) in enumerate(self.labels):
            if own == name:
                turn = freedom in TURNS
                axis = np.eye(3)[TURNS.index(freedom) if turn else "xyz".index(freedom)]
                rows[:, i] = np.cross(axis, away) if turn else axis
        return rows


def crossing(car, shapes, omega, ratio, speed, offset, height, rails, times, hertz):
    """Return wheel forces on the deck (wheels, lateral and vertical, n) and the car's motion.

    `shapes(x)` are those of the deck's modes and their slopes at places x, (2, x, modes, y z roll);
    `rails(x)` heights and slopes below the wheels, (2, wheels, lateral and vertical). The track
    lies `offset` left of the deck's axis and `height` above it.
    """
    n, modes, relaxing = len(car.mass), len(omega), len(car.series)
    x_front = max(wheel.at[0] for wheel in car.wheels)
    behind = np.array([x_front - wheel.at[0] for wheel in car.wheels])
    beside = offset + np.array([wheel.at[1] for wheel in car.wheels])
    depth = 1.5 * car.load / car.vertical

    def forces(t, u, v, q, dq):
        shape, slope = shapes(speed * t - behind)
        rail, climb = rails(speed * t - behind)
        way = np.stack(
            [shape[:, :, 0] - height * shape[:, :, 2],
             shape[:, :, 1] + beside[:, None] * shape[:, :, 2]]
        )  # fmt: skip
        rise = slope[:, :, 1] + beside[:, None] * slope[:, :, 2]
        lateral = car.lateral * (car.across @ u - way[0] @ q - rail[:, 0])
        stretch = car.up @ u - way[1] @ q - rail[:, 1]
        rate = car.up @ v - way[1] @ dq - speed * (rise @ q + climb[:, 1])
        if hertz:
            press = car.load * np.maximum(1.0 - stretch / depth, 0.0) ** 1.5
            press = np.maximum(press * (1.0 - car.damping / car.load * rate), 0.0)
        else:
            press = car.load - car.vertical * stretch - car.damping * rate
        return way, lateral, press

    parts = np.cumsum([n, n, modes, modes])

    def rates(t, state):
        u, v, q, dq, f = np.split(state, parts)
        way, lateral, press = forces(t, u, v, q, dq)
        push = -car.k @ u - car.c @ v - car.series.T @ f
        push += (press - car.load) @ car.up - lateral @ car.across
        modal = lateral @ way[0] - press @ way[1]
        relax = car.series_k * (car.series @ v - f / car.series_c)
        ddq = modal - 2 * ratio * omega * dq - omega**2 * q
        return np.concatenate([v, push / car.mass, dq, ddq, relax])

    start = np.zeros(2 * n + 2 * modes + relaxing)
    span = times[0], times[-1]
    found = solve_ivp(rates, span, start, "DOP853", times, rtol=1e-7, atol=1e-10, max_step=1e-3)
    met = [forces(t, *np.split(y, parts)[:4]) for t, y in zip(times, found.y.T, strict=True)]
    exerted = np.array([[lateral, -press] for _, lateral, press in met])
    return exerted.transpose(2, 1, 0), found.y[:n]
