"""Trains and decks by brute force: cars of fifteen freedoms on an unreduced frame in space.

Everything is integrated together, at every stage of every step, by a method for stiff equations.
It shares nothing with the package but plain numbers. From the paper's Table 1 and Figure 1: a car
body and two bogies, each with y, z, roll, pitch, yaw; two secondary springs a bogie, two primary
springs an axle, each lateral and vertical with its damper. Wheels without mass stay on the rails,
so the force of a primary spring is the contact force, with e the motion of its upper end:

    F = k (e - s) + c (e' - s') - W,    s = w + y theta + r  or  v - h theta + r,
    s' = (d/dt + V d/dx) of the deck's part + V r'.

The integrator is Alexander's diagonally implicit method of three stages (1977): third order,
L-stable, its last stage at the end of the step, so the equations of motion hold there exactly. A
step in which an axle enters or leaves a span is cut in two at that instant.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from spaceframe import SIZE, Implicit, SpaceFrame, even

G = 9.81
GAMMA = 0.43586652150845899942
_B1 = -(6 * GAMMA**2 - 16 * GAMMA + 1) / 4
_B2 = (6 * GAMMA**2 - 20 * GAMMA + 5) / 4
WEIGHTS = ((), ((1 - GAMMA) / 2,), (_B1, _B2))
"""Of the stages before, for each stage; its own weight is GAMMA."""
TIMES = (GAMMA, (1 + GAMMA) / 2, 1.0)


class Car:
    """Matrices of the car without its primary springs, and how their upper ends move.

    Freedoms: y, z, roll, pitch, yaw of the body, of the front bogie, of the rear one. Wheels from
    front to back, left before right.

    Attributes
    ----------
    mass, stiffness, damping : ndarray, shape (15, 15)
    ends : ndarray, shape (16, 15)
        Of every wheel lateral, then vertical.
    k, c : ndarray, shape (16,)
    places : ndarray, shape (4,)
        Axles, m ahead of the middle.
    """

    def __init__(self, p):
        body = [p["car_body_mass"]] * 2 + [p[f"car_body_{r}_inertia"] for r in _TURNS]
        bogie = [p["bogie_mass"]] * 2 + [p[f"bogie_{r}_inertia"] for r in _TURNS]
        self.mass = np.diag(body + bogie + bogie)
        self.stiffness, self.damping = np.zeros((2, 15, 15))
        half, axle = p["bogie_spacing"] / 2, p["axle_spacing"] / 2
        width, gauge = p["secondary_half_width"], p["primary_half_width"]
        ends, places = [], []
        for first, x in ((5, half), (10, -half)):
            for y in (width, -width):
                upper = _point(0, x, y, -p["car_body_above_secondary"])
                stretch = upper - _point(first, 0.0, y, p["secondary_above_bogie"])
                for row, way in zip(stretch, ("lateral", "vertical"), strict=True):
                    here = np.outer(row, row)
                    self.stiffness += p[f"secondary_{way}_stiffness"] * here
                    self.damping += p[f"secondary_{way}_damping"] * here
            for ahead in (axle, -axle):
                places.append(x + ahead)
                ends += [
                    _point(first, ahead, y, -p["primary_below_bogie"]) for y in (gauge, -gauge)
                ]
        self.ends, self.places, self.gauge = np.concatenate(ends), np.array(places), gauge
        self.k, self.c = (
            np.tile([p[f"primary_{way}_{what}"] for way in ("lateral", "vertical")], 8)
            for what in ("stiffness", "damping")
        )
        self.wheel_load = (p["car_body_mass"] + 2 * p["bogie_mass"]) * G / 8


_TURNS = ("roll", "pitch", "yaw")


def _point(first, x, y, z):
    """Lateral and vertical motion of a point of the body whose freedoms start at `first`."""
    rows = np.zeros((2, 15))
    rows[0, first : first + 5] = 1.0, 0.0, -z, 0.0, x
    rows[1, first : first + 5] = 0.0, 1.0, y, -x, 0.0
    return rows


class Rails:
    """What wheels find: waves that fade in over the first half of the run-up, and notches.

    Parameters
    ----------
    waves : dict
        By (direction, side) a list of (amplitude, wavelength, phase).
    lead_in : float
        m.
    notches : list of dict
        ``car`` and ``wheel`` from 0, ``circumference``, ``offset``, ``depth``, ``length``.
    """

    def __init__(self, waves, lead_in, notches):
        self.lead_in, self.notches = lead_in, notches
        # (2 directions, 2 sides, most waves)
        most = max([1, *(len(w) for w in waves.values())])
        self.table = np.zeros((3, 2, 2, most))
        self.table[1] = 1.0
        for i, direction in enumerate(("lateral", "vertical")):
            for j, side in enumerate(("left", "right")):
                for n, wave in enumerate(waves.get((direction, side), ())):
                    self.table[:, i, j, n] = wave

    def met(self, x):
        """Height and slope under every wheel, (cars, 4 axles, 2 sides, 2 directions) each."""
        amplitude, length, phase = self.table
        number = 2 * np.pi / length
        angle = number * x[..., None, None, None] + phase
        value = np.moveaxis((amplitude * np.sin(angle)).sum(-1), -2, -1)
        slope = np.moveaxis((amplitude * number * np.cos(angle)).sum(-1), -2, -1)
        ramp = self.lead_in / 2
        turn = np.pi * np.clip((x + self.lead_in) / ramp, 0.0, 1.0)
        share = (1 - np.cos(turn))[..., None, None] / 2
        growth = (np.pi / ramp * np.sin(turn))[..., None, None] / 2
        value, slope = share * value, share * slope + growth * value
        for n in self.notches:
            car, (axle, side) = n["car"], divmod(n["wheel"], 2)
            along = x[car, axle] - n["offset"]
            behind = along % n["circumference"]
            if along >= 0.0 and behind <= n["length"]:
                angle = 2 * np.pi * behind / n["length"]
                value[car, axle, side, 1] -= n["depth"] / 2 * (1 - np.cos(angle))
                slope[car, axle, side, 1] -= np.pi * n["depth"] / n["length"] * np.sin(angle)
        return value, slope


@dataclass
class Simulation:
    """Histories at the samples, and what follows from them.

    Attributes
    ----------
    frame : SpaceFrame
    time : ndarray, shape (n,)
    motion, velocity, acceleration : ndarray, shape (n, free freedoms)
    wheel_forces : ndarray, shape (n, cars, 4 axles, 2 sides, 2 directions)
        On the deck, static part included; lateral before vertical.
    elements : ndarray of int, shape (n, load points)
        The element that each load point stands on; -1 off the deck.
    loads : ndarray, shape (n, load points, SIZE)
        Its loads on the element's freedoms.
    """

    frame: SpaceFrame
    time: np.ndarray
    motion: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    wheel_forces: np.ndarray
    elements: np.ndarray
    loads: np.ndarray
    _known: dict = field(default_factory=dict)

    @cached_property
    def carried(self):
        return self.frame.carried(self.motion.T, self.velocity.T, self.acceleration.T)

    @cached_property
    def all_loads(self):
        """On all freedoms, (freedoms, n)."""
        result = np.zeros((self.frame.size, len(self.time)))
        for point in range(self.elements.shape[1]):
            on = np.flatnonzero(self.elements[:, point] >= 0)
            where = self.frame.freedoms[self.elements[on, point]]
            np.add.at(result, (where, on[:, None]), self.loads[on, point])
        return result

    def at(self, x, what="motion"):
        """y, z and roll of the deck axis at a node, (3, n); or ``velocity``, ``acceleration``."""
        node = self.frame.node(x)
        rows = self.frame.free[6 * node + 1 : 6 * node + 4]
        return rows @ getattr(self, what).T

    def section(self, x):
        """Section forces just before a node, a dict of histories."""
        node = self.frame.node(x)
        e = int(np.flatnonzero(self.frame.first + 1 == node)[0])
        here = (self.loads * (self.elements == e)[..., None]).sum(axis=1).T
        names = "axial", "shear_lateral", "shear_vertical"
        names += "torsion", "moment_vertical", "moment_lateral"
        return dict(zip(names, self.frame.section(node, *self.carried, here), strict=True))

    def reactions(self):
        """Forces and moments of each bearing line on the deck about its axis, (6, n) by place."""
        result = {}
        for node, force in self.frame.supported(*self.carried, self.all_loads).items():
            x = round(float(self.frame.place[node]), 9)
            result[x] = result.get(x, 0.0) + force
        return dict(sorted(result.items()))

    def bearing_forces(self):
        """What every bearing exerts on the deck, by direction."""
        return self.frame.bearing_forces(*self.carried, self.all_loads)


class Simulator:
    """A train on a deck.

    Parameters
    ----------
    deck : dict
        See `SpaceFrame`; and ``height`` of the rails above the axis, m.
    car : dict
        Table 1, SI.
    train : dict
        ``cars``, ``spacing`` (m), ``offset`` of the track to the left (m), ``notches``.
    waves : dict
        See `Rails`.
    run : dict
        ``speed``, ``step`` (s), ``samples``, ``lead_in`` (m), ``fine`` (steps a sample), ``size``
        of elements (m), ``condensed`` (the wheel forces of a car act as one, below its middle).
    """

    def __init__(self, deck, car, train, waves, run):
        mesh = run.get("mesh") or even(deck["spans"], run.get("size", 0.5))
        self.frame, self.car = SpaceFrame(deck, mesh), Car(car)
        self.cars, self.run, self.speed = train["cars"], run, run["speed"]
        self.condensed, self.height = run.get("condensed", False), deck.get("height", 0.0)
        self.rails = Rails(waves, run["lead_in"], train.get("notches", ()))
        middle = self.car.places[0] + train["spacing"] * np.arange(self.cars)
        self.middles = middle
        self.delays = middle[:, None] - self.car.places
        self.y = train["offset"] + np.array([self.car.gauge, -self.car.gauge])
        ways = np.zeros((2, 2, 3))
        # A wheel moves sideways by v - h theta and up by w + y theta.
        ways[:, 0, 0], ways[:, 0, 2] = 1.0, -self.height
        ways[:, 1, 1], ways[:, 1, 2] = 1.0, self.y
        self.ways = ways.reshape(4, 3)
        self.static = np.tile([0.0, -self.car.wheel_load], 8 * self.cars)
        self.ends = self.car.ends
        self.k, self.c = np.tile(self.car.k, self.cars), np.tile(self.car.c, self.cars)
        self._ready = {}

    # ---- where things are

    def _spans(self, middle_time, delays):
        """The span (or -1) of points with given delays, decided by an instant."""
        x = self.speed * middle_time - delays
        span = np.searchsorted(self.frame.ends, x) - 1
        return np.where((x > 0.0) & (x < self.frame.length), span, -1)

    @cached_property
    def events(self):
        """Instants at which something enters or leaves a span."""
        ends = self.frame.ends[[0, -1]] if self.frame.joined else self.frame.ends
        delays = self.delays.ravel()
        if self.condensed:
            delays = np.concatenate([delays, self.middles])
        return np.unique((delays[:, None] + ends).ravel() / self.speed)

    def _met(self, t, middle_time):
        """Numbers of the axles on the deck, their elements, and how wheels (two an axle, two ways a
        wheel) move with the freedoms there and with their slopes, (n, 4, SIZE) each."""
        delays = self.delays.ravel()
        spans = self._spans(middle_time, delays)
        on = np.flatnonzero(spans >= 0)
        e, value, slope = self.frame.under(self.speed * t - delays[on], spans[on])
        return on, e, self.ways @ value, self.ways @ slope

    # ---- one stage

    def _systems(self, g, often):
        """What a stage needs for one step size."""
        key = round(g, 15)
        if key not in self._ready:
            car, every = self.car, np.eye(self.cars)
            implicit = np.linalg.inv(car.mass + g * car.damping + g**2 * car.stiffness)
            softness = np.tile(g**2 * car.k + g * car.c, self.cars)
            yielding = np.kron(every, car.ends @ implicit @ car.ends.T)
            matrix = np.eye(len(softness)) + softness[:, None] * yielding
            entry = implicit, softness, matrix, Implicit(self.frame, g, often)
            if not often:
                return entry
            self._ready[key] = entry
        return self._ready[key]

    def _loading(self, t, middle_time, met):
        """Numbers of the load points on the deck, their elements, and how wheel forces load the
        freedoms there, (points, SIZE, forces)."""
        count = 16 * self.cars
        if not self.condensed:
            on, e, value, _ = met
            loading = np.zeros((len(on), SIZE, count))
            for i, axle in enumerate(on):
                loading[i, :, 4 * axle : 4 * axle + 4] = value[i].T
            return on, e, loading
        spans = self._spans(middle_time, self.middles)
        on = np.flatnonzero(spans >= 0)
        e, value, slope = self.frame.under(self.speed * t - self.middles[on], spans[on])
        loading = np.zeros((len(on), SIZE, count))
        for i, car in enumerate(on):
            for a, ahead in enumerate(self.car.places):
                # F_y, F_z and M_x, and the couples M_z = x F_y (on v') and M_y = -x F_z (on -w').
                own = self.ways @ value[i]
                own[::2] += ahead * slope[i, 0]
                own[1::2] += ahead * slope[i, 1]
                loading[i, :, 16 * car + 4 * a : 16 * car + 4 * a + 4] = own.T
        return on, e, loading

    def _stage(self, t, g, systems, middle_time, car_state, deck_state):
        """Accelerations of cars and deck at t, with displacement and velocity known but for them.

        States are what they would be without acceleration at this stage.
        """
        implicit, softness, matrix, deck = systems
        car, frame, v, ends = self.car, self.frame, self.speed, self.ends
        (z, dz), (y, dy) = car_state, deck_state
        free_car = -(dz @ car.damping + z @ car.stiffness) @ implicit
        r, slope = self.rails.met(v * t - self.delays)
        apart = self.k * ((z + g**2 * free_car) @ ends.T - r.reshape(self.cars, 16)).ravel()
        apart += self.c * ((dz + g * free_car) @ ends.T - v * slope.reshape(self.cars, 16)).ravel()
        met = self._met(t, middle_time)
        points, elements, loading = self._loading(t, middle_time, met)
        still = not (len(points) or np.any(y) or np.any(dy))
        if not still:
            here = frame.freedoms[elements].ravel()
            loading = loading.reshape(-1, len(apart))
            rest = -(frame.stiffness @ y + frame.damping @ dy)
            load = np.zeros(frame.size)
            np.add.at(load, here, loading @ self.static)
            free_deck = deck.solve(rest + frame.free.T @ load)
            on, e, value, tilt = met
            if len(on):
                rows = (4 * on[:, None] + np.arange(4)).ravel()
                there = frame.freedoms[e]
                moved = (frame.free @ (y + g**2 * free_deck))[there]
                rate = (frame.free @ (dy + g * free_deck))[there]
                climb = v * tilt
                shift, pace = (np.einsum("afs,as->af", value, m).ravel() for m in (moved, rate))
                pace = pace + np.einsum("afs,as->af", climb, moved).ravel()
                apart[rows] -= self.k[rows] * shift + self.c[rows] * pace
                if len(points):
                    feel = softness[rows].reshape(-1, 4, 1) * value
                    feel = feel + (self.c[rows] * g**2).reshape(-1, 4, 1) * climb
                    gives = deck.flexibility(there.ravel(), here, loading)
                    gives = feel @ gives.reshape(len(on), SIZE, -1)
                    matrix = matrix.copy()
                    matrix[rows] += gives.reshape(len(rows), -1)
        force = np.linalg.solve(matrix, apart)
        added_car = free_car - force.reshape(self.cars, 16) @ ends @ implicit
        total = force + self.static
        if still:
            return added_car, np.zeros_like(y), total, elements, points, None
        np.add.at(load, here, loading @ force)
        added_deck = deck.solve(rest + frame.free.T @ load)
        return added_car, added_deck, total, elements, points, (loading @ total).reshape(-1, SIZE)

    # ---- all steps

    def __call__(self):
        run, frame = self.run, self.frame
        h = run["step"] / run.get("fine", 1)
        before = int(np.ceil(run["lead_in"] / self.speed / h)) + 1
        n, size = run["samples"], frame.mass.shape[0]
        z, dz = np.zeros((2, self.cars, 15))
        y, dy = np.zeros((2, size))
        motion, velocity, acceleration = np.zeros((3, n, size))
        forces = np.tile(self.static, (n, 1))
        count = self.cars if self.condensed else 4 * self.cars
        elements, loads = np.full((n, count), -1), np.zeros((n, count, SIZE))
        for step in range(-before, (n - 1) * run.get("fine", 1)):
            start, stop = step * h, (step + 1) * h
            slack = 1e-9 * h
            cuts = self.events[(self.events > start + slack) & (self.events < stop - slack)]
            for a, b in zip([start, *cuts], [*cuts, stop], strict=True):
                z, dz, y, dy, last = self._step(a, b - a, len(cuts) == 0, z, dz, y, dy)
            sample, rest = divmod(step + 1, run.get("fine", 1))
            if rest == 0 and sample >= 0:
                motion[sample], velocity[sample] = y, dy
                _, acceleration[sample], forces[sample], where, points, load = last
                if load is not None:
                    elements[sample, points], loads[sample, points] = where, load
        forces = forces.reshape(n, self.cars, 4, 2, 2)
        time = run["step"] * np.arange(n)
        return Simulation(frame, time, motion, velocity, acceleration, forces, elements, loads)

    def _step(self, t, h, regular, z, dz, y, dy):
        # Round-off in the differences of instants must not ask for another factor.
        g = GAMMA * (self.run["step"] / self.run.get("fine", 1) if regular else h)
        systems, middle = self._systems(g, regular), t + h / 2
        rates = []
        for weights, when in zip(WEIGHTS, TIMES, strict=True):
            states = []
            for i, (place, rate) in enumerate(((z, dz), (y, dy))):
                for weight, found in zip(weights, rates, strict=True):
                    place = place + h * weight * found[i][0]
                    rate = rate + h * weight * found[i][1]
                states.append((place + g * rate, rate))
            last = self._stage(t + when * h, g, systems, middle, *states)
            rates.append([(r + g * a, a) for (_, r), a in zip(states, last[:2], strict=True)])
        ends = []
        for (place, rate), extra in zip(states, last[:2], strict=True):
            ends += [place + g**2 * extra, rate + g * extra]
        return *ends, last
