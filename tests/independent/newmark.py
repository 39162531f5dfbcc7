"""A finite-element program of its own: a simple beam and a plane car, stepped by Newmark's method.

The beam has cubic elements. It takes a car's matrices and a beam's numbers, never the package's own
deck, modes or filters. At every step the springs at the contacts join both systems at the wheels'
places, so stiffness and damping change with time:

    u_i = N(x_i) d + r,   u_i' = N d' + v (N' d + r'),   F_i = k (G z - u) + c (G z' - u') - W.
"""

import numpy as np

STIFFNESS = np.array(
    [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], dtype=float
)
MASS = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) / 420


def hermite(s, h):
    """Cubic shapes of an element at s = 0..1, their slopes and curvatures."""
    value = [
        1 - 3 * s**2 + 2 * s**3,
        h * (s - 2 * s**2 + s**3),
        3 * s**2 - 2 * s**3,
        h * (s**3 - s**2),
    ]
    slope = [
        (6 * s**2 - 6 * s) / h,
        1 - 4 * s + 3 * s**2,
        (6 * s - 6 * s**2) / h,
        3 * s**2 - 2 * s,
    ]
    return np.array(value), np.array(slope)


class Elements:
    """A simple beam of equal elements; freedoms w, w' at every node."""

    def __init__(self, length, mass, bending, count):
        self.length, self.count, self.h, self.bending = length, count, length / count, bending
        size = 2 * (count + 1)
        scale = np.outer([1, self.h] * 2, [1, self.h] * 2)
        self.stiffness, self.mass = np.zeros((2, size, size))
        for e in range(count):
            here = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
            self.stiffness[here] += bending / self.h**3 * STIFFNESS * scale
            self.mass[here] += mass * self.h * MASS * scale
        self.free = np.setdiff1d(np.arange(size), [0, 2 * count])

    def shapes(self, x):
        """Value and slope of all free freedoms' shapes at x."""
        e = min(int(x / self.h), self.count - 1)
        rows = np.zeros((2, 2 * (self.count + 1)))
        rows[:, 2 * e : 2 * e + 4] = hermite(x / self.h - e, self.h)
        return rows[:, self.free]


def crossing(car, beam, speed, wave, elements=20, step=2.5e-4, tail=0.2):
    """Time, mid-span displacement, mid-span moment and axle forces of a plane car on a beam.

    The car is a `references.PlaneVehicle`. The moment is the end moment of the element left of
    mid-span, with the viscous part of Rayleigh's damping, its own loads and inertia taken off.
    """
    fem = Elements(beam.length, beam.mass, beam.bending, elements)
    k, m = (a[np.ix_(fem.free, fem.free)] for a in (fem.stiffness, fem.mass))
    f, size = len(car.mass), len(car.mass) + len(fem.free)
    whole_m, whole_c, whole_k = np.zeros((3, size, size))
    whole_m[:f, :f], whole_m[f:, f:] = car.mass, m
    whole_c[f:, f:], whole_k[f:, f:] = beam.alpha * m + beam.beta * k, k
    # The car without its lowest springs, which are joined to the beam step by step.
    whole_k[:f, :f] = car.stiffness - car.spring * car.rows.T @ car.rows
    whole_c[:f, :f] = car.damping - car.damper * car.rows.T @ car.rows
    amplitude, wavelength = wave
    number = 2 * np.pi / wavelength
    count = int(np.ceil((beam.length + car.delays[-1]) / speed / step + tail / step)) + 1
    time = np.arange(count) * step
    y, dy, ddy = np.zeros((3, size))
    middle, moment, forces = np.zeros(count), np.zeros(count), np.tile(-car.static[:, None], count)
    centre = fem.shapes(beam.length / 2)[0]
    half = elements // 2
    for n in range(1, count):
        stiffness, damping, load = whole_k.copy(), whole_c.copy(), np.zeros(size)
        join, climb = np.zeros((2, len(car.delays), size))
        r, rate = np.zeros((2, len(car.delays)))
        join[:, :f] = car.rows
        places = speed * time[n] - car.delays
        for i, x in enumerate(places):
            if 0.0 <= x <= beam.length:
                shape, slope = fem.shapes(x)
                join[i, f:], climb[i, f:] = -shape, -speed * slope
                load[f:] -= car.static[i] * shape
            if x >= 0.0:
                r[i] = amplitude * np.sin(number * x)
                rate[i] = speed * amplitude * number * np.cos(number * x)
        stiffness += join.T @ (car.spring * join + car.damper * climb)
        damping += car.damper * join.T @ join
        load += join.T @ (car.spring * r + car.damper * rate)
        # Newmark, average acceleration.
        predicted = y + step * dy + step**2 / 4 * ddy
        rate_predicted = dy + step / 2 * ddy
        effective = whole_m + step / 2 * damping + step**2 / 4 * stiffness
        ddy = np.linalg.solve(effective, load - damping @ rate_predicted - stiffness @ predicted)
        y, dy = predicted + step**2 / 4 * ddy, rate_predicted + step / 2 * ddy
        middle[n] = centre @ y[f:]
        dashpots = car.damper * (join @ dy + climb @ y - rate)
        forces[:, n] = car.spring * (join @ y - r) + dashpots - car.static
        inertia = ddy[f:] + beam.alpha * dy[f:]
        strain = y[f:] + beam.beta * dy[f:]
        moment[n] = _moment(fem, half, strain, inertia, forces[:, n], places, beam)
    return time, middle, moment, forces


def _moment(fem, half, strain, inertia, forces, places, beam):
    """M_y at the node `half`: the end moment of the element to its left.

    `strain` is d + beta d', which the stiffness turns into elastic and viscous forces. The
    element's own loads and inertia are taken off.
    """
    whole, moving = np.zeros((2, 2 * (fem.count + 1)))
    whole[fem.free], moving[fem.free] = strain, inertia
    here = np.arange(2 * half - 2, 2 * half + 2)
    scale = np.outer([1, fem.h] * 2, [1, fem.h] * 2)
    inner = fem.bending / fem.h**3 * (STIFFNESS * scale) @ whole[here]
    end = inner + beam.mass * fem.h * (MASS * scale) @ moving[here]
    for force, x in zip(forces, places, strict=True):
        s = x / fem.h - (half - 1)
        if 0.0 <= s <= 1.0:
            end -= hermite(s, fem.h)[0] * force
    # The nodal couple at the right end works on w', and M_y = -E I w''.
    return -end[3]
