"""A finite-element program of its own: a rail on an elastic bed over a deck, stepped by Newmark.

Deck and rail are beams of cubic elements, joined by a bed of springs: to the deck where there is
one, to the ground beside it. The rail has no mass, so it follows at once. Nothing here knows of
kernels: a load stands on the rail, and what arrives on the deck comes through the bed. Unlike the
package, the rail gives way below a wheel, and it stiffens the deck and its ends a little.
"""

import numpy as np

from .newmark import MASS, STIFFNESS, hermite

GAUSS = np.polynomial.legendre.leggauss(5)


def beam(count, h, bending, mass=0.0):
    """Stiffness and mass of a free beam of equal elements; freedoms w, w' at every node."""
    size, scale = 2 * (count + 1), np.outer([1, h] * 2, [1, h] * 2)
    k, m = np.zeros((2, size, size))
    for e in range(count):
        here = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
        k[here] += bending / h**3 * STIFFNESS * scale
        m[here] += mass * h * MASS * scale
    return k, m


class RailOverDeck:
    """A deck on bearings (N/m; None: rigid), and a rail on a bed that goes on `beyond` both ends.

    `alpha` and `beta` of Rayleigh's damping are those of the deck with its bearings.
    """

    def __init__(self, length, mass, bending, bearing, rail, bed, alpha, beta, beyond=14.0,
                 deck_elements=40, rail_element=0.125):  # fmt: skip
        self.length, self.beyond, self.h = length, beyond, length / deck_elements
        self.count = deck_elements
        k, m = beam(deck_elements, self.h, bending, mass)
        last = 2 * deck_elements
        if bearing is not None:
            k[0, 0] += bearing
            k[last, last] += bearing
        damping = alpha * m + beta * k
        self.rail_h = rail_element
        self.rail_count = round((length + 2 * beyond) / rail_element)
        rails, _ = beam(self.rail_count, rail_element, rail)
        joined = np.zeros((len(rails), len(k)))
        for e in range(self.rail_count):
            for point, weight in zip(*GAUSS, strict=True):
                s = (point + 1) / 2
                x = (e + s) * rail_element - beyond
                shape = hermite(s, rail_element)[0]
                here = np.arange(2 * e, 2 * e + 4)
                part = bed * weight / 2 * rail_element
                rails[np.ix_(here, here)] += part * np.outer(shape, shape)
                if 0.0 < x < length:
                    there, below = self.deck_row(x)
                    k[np.ix_(there, there)] += part * np.outer(below, below)
                    joined[np.ix_(here, there)] -= part * np.outer(shape, below)
        self.free = np.arange(len(k))
        if bearing is None:
            self.free = np.setdiff1d(self.free, [0, last])
        pick = np.ix_(self.free, self.free)
        joined = joined[:, self.free]
        # The rail without mass is at rest on what it stands on: w_r = follows w_d + gives F.
        self.gives = np.linalg.inv(rails)
        self.follows = -self.gives @ joined
        self.k, self.m, self.c = k[pick] + joined.T @ self.follows, m[pick], damping[pick]

    def deck_row(self, x):
        """Freedoms and shape of the deck at x."""
        e = min(int(x / self.h), self.count - 1)
        return np.arange(2 * e, 2 * e + 4), hermite(x / self.h - e, self.h)[0]

    def at(self, x):
        """The deck's own motion at x, as a row over its free freedoms."""
        row = np.zeros(2 * (self.count + 1))
        there, shape = self.deck_row(x)
        row[there] = shape
        return row[self.free]

    def rail_row(self, x):
        """How the rail at x follows the deck, and how far it gives way under 1 N there."""
        s = (x + self.beyond) / self.rail_h
        e = min(int(s), self.rail_count - 1)
        if not 0.0 <= s <= self.rail_count:
            return np.zeros(len(self.free)), 0.0
        here, shape = np.arange(2 * e, 2 * e + 4), hermite(s - e, self.rail_h)[0]
        return shape @ self.follows[here], shape @ self.gives[np.ix_(here, here)] @ shape

    def crossing(self, places, loads, speed, step, count, start, mass=None, spring=0.0, give=True):
        """Deck displacement, acceleration (places, n) and contact force (n) of moving loads.

        `loads` are (delay, N down positive). With `mass` (kg) on a `spring` (N/m) there is one
        load, its weight; without `give` the rail does not give way below it. The record starts at
        the time `start`, the mass at rest.
        """
        rows = np.array([self.at(x) for x in places])
        n = len(self.free) + (mass is not None)
        m, c, k = np.zeros((3, n, n))
        d = len(self.free)
        m[:d, :d], c[:d, :d], k[:d, :d] = self.m, self.c, self.k
        if mass is not None:
            m[d, d] = mass
        y, dy, ddy = np.zeros((3, n))
        moved, rates = np.zeros((2, len(places), count))
        force = np.zeros(count)
        constant = np.linalg.inv(m + step / 2 * c + step**2 / 4 * k) if mass is None else None
        for i in range(count):
            time, load, effective_k = start + i * step, np.zeros(n), k
            if mass is None:
                for delay, size in loads:
                    load[:d] -= size * self.rail_row(speed * time - delay)[0]
            else:
                follows, gives = self.rail_row(speed * time)
                weight = loads[0][1]
                # F = -W + s (z - u), u = follows d + gives (F + W): the give under the weight
                # itself is where the mass starts from.
                soft = spring / (1.0 + spring * gives * give)
                join = np.append(-follows, 1.0)
                effective_k = k + soft * np.outer(join, join)
                load[:d] -= weight * follows
            if i:
                ahead = y + step * dy + step**2 / 4 * ddy
                rate = dy + step / 2 * ddy
                rest = load - c @ rate - effective_k @ ahead
                if constant is not None:
                    ddy = constant @ rest
                else:
                    ddy = np.linalg.solve(m + step / 2 * c + step**2 / 4 * effective_k, rest)
                y, dy = ahead + step**2 / 4 * ddy, rate + step / 2 * ddy
            if mass is not None:
                force[i] = -weight + soft * (join @ y)
            moved[:, i], rates[:, i] = rows @ y[:d], rows @ ddy[:d]
        return moved, rates, force
