"""A vehicle as forces between points: every body is pushed and turned by every spring.

No stretch rows, no matrices: the ends of a spring move by u + theta x r with all three components,
forces and moments r x F are added up body by body, and `scipy.integrate` does the rest.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

FREEDOMS = ("y", "z", "roll", "pitch", "yaw")


class Moved(NamedTuple):
    """Motion by freedom, forces on the deck (wheels, 2, n), accelerations (places, 2, n)."""

    motion: dict
    forces: np.ndarray
    body: np.ndarray


def by_forces(car, rail, t):
    """Run a vehicle from rest over ``rail(time)``, shape (wheels, 2), whose dampers are none."""
    names = [body.name for body in car.bodies]
    wheel_of = {}
    for i, contact in enumerate(car.contacts):
        wheel_of[contact.body, round(contact.x, 6), round(contact.y, 6)] = i
    series = [(s, j) for s in car.springs if s.series_stiffness for j in (0, 1)]

    def point(state, name, at):
        """Place and speed of a point of a body, each (x, y, z)."""
        i = names.index(name)
        arm = np.array(at) - np.array(car.bodies[i].position)
        q, v = state[:, i]
        return [np.array([0.0, *m[:2]]) + np.cross(m[2:], arm) for m in (q, v)]

    def pushed(time, flat):
        state = flat[: 10 * len(names)].reshape(2, len(names), 5)
        carried = flat[10 * len(names) :]
        force, turn = np.zeros((len(names), 3)), np.zeros((len(names), 3))
        wheels, rates = np.zeros((len(car.contacts), 2)), np.zeros(len(series))

        def push(name, at, f):
            i = names.index(name)
            force[i] += f
            turn[i] += np.cross(np.array(at) - np.array(car.bodies[i].position), f)

        for spring in car.springs:
            if "rail" in (spring.from_, spring.to):
                name = spring.to if spring.from_ == "rail" else spring.from_
                wheel = wheel_of[name, round(spring.at[0], 6), round(spring.at[1], 6)]
                place, _ = point(state, name, spring.at)
                f = np.array(spring.stiffness) * (place[1:] - rail(time)[wheel])
                wheels[wheel] = f
                push(name, spring.at, [0.0, *-f])
                continue
            (a, va), (b, vb) = (point(state, end, spring.at) for end in (spring.from_, spring.to))
            k = np.array([spring.longitudinal_stiffness, *spring.stiffness])
            c = np.array([spring.longitudinal_damping, *spring.damping])
            f = k * (b - a)
            if spring.series_stiffness is None:
                f = f + c * (vb - va)
            else:
                f[0] += c[0] * (vb - va)[0]
                for j in (0, 1):
                    own, ks = series.index((spring, j)), spring.series_stiffness[j]
                    f[1 + j] += carried[own]
                    rates[own] = ks * (vb - va)[1 + j] - ks / spring.damping[j] * carried[own]
            push(spring.from_, spring.at, f)
            push(spring.to, spring.at, -f)
        for bar in car.anti_roll_bars:
            i, j = names.index(bar.from_), names.index(bar.to)
            twist, rate = state[:, j, 2] - state[:, i, 2]
            moment = bar.stiffness * twist + bar.damping * rate
            turn[i, 0] += moment
            turn[j, 0] -= moment
        a = np.zeros((len(names), 5))
        for i, body in enumerate(car.bodies):
            all_ = [*(force[i, 1:] / body.mass)]
            all_ += [m / moi if moi else 0.0 for m, moi in zip(turn[i], body.inertia, strict=True)]
            a[i] = [value * (f in body.freedoms) for value, f in zip(all_, FREEDOMS, strict=True)]
        return state[1], a, rates, wheels

    def slope(time, flat):
        v, a, rates, _ = pushed(time, flat)
        return np.concatenate([v.ravel(), a.ravel(), rates])

    start = np.zeros(10 * len(names) + len(series))
    run = solve_ivp(slope, (0.0, t[-1]), start, "DOP853", t, rtol=1e-8, atol=1e-11)
    motion = {
        f"{name} {f}": run.y[5 * i + j]
        for i, name in enumerate(names)
        for j, f in enumerate(FREEDOMS)
    }
    forces, body = [], []
    for time, flat in zip(t, run.y.T, strict=True):
        _, a, _, wheels = pushed(time, flat)
        forces.append(wheels)
        body.append(
            [
                [
                    a[names.index(b.name)][0] + a[names.index(b.name)][4] * (x - b.position[0]),
                    a[names.index(b.name)][1] - a[names.index(b.name)][3] * (x - b.position[0]),
                ]
                for b, _, x in car.body_places
            ]
        )
    return Moved(motion, np.moveaxis(np.array(forces), 0, -1), np.moveaxis(np.array(body), 0, -1))
