"""Four planar crossings by the suite and by OpenSeesPy with a step loop in Python beside it.

One load, 32 loads, one car and eight cars on a simple span, 1 ms. OpenSees integrates the deck of
36 beam elements (Newmark); the car is a set of matrices in NumPy, and wheel forces and deck motion
are exchanged at every step, as most people couple them. The largest sags agree to 1e-4.
"""

import ctypes
import importlib
import importlib.util
from pathlib import Path

import numpy as np

import railbridge as rb

LENGTH, STIFFNESS, MASS, RATIO, ELEMENTS = 36.0, 8.8e10, 11850.0, 0.03, 36
SPEED, STEP, SPACING, ELEMENT = 20.0, 1e-3, 22.5, LENGTH / ELEMENTS
BODY, BODY_PITCH, BOGIE, BOGIE_PITCH = 50990.0, 1.96e6, 4360.0, 3430.0
SECONDARY, PRIMARY = (2 * 1060e3, 2 * 30e3), (2 * 2976e3, 2 * 15e3)
"""Stiffness and damping of both sides together, N/m and N s/m."""
AXLES, LOAD = np.array([0.0, 2.5, 15.6, 18.1]), (BODY + 2 * BOGIE) * 9.81 / 4
TWO = np.pi**2 / (2 * np.pi) * np.sqrt(STIFFNESS / MASS) / LENGTH**2 * np.array([1.0, 4.0])
"""First two frequencies, Hz."""


# ---- the suite


def train(cars):
    """Return planar cars in a row."""
    body, spring = rb.Body, rb.Spring
    moves = ("z", "pitch")
    bodies = [body("car", BODY, (0.0, BODY_PITCH, 0.0), (0.0, 0.0, 0.0), moves)]
    springs = []
    for name, x in (("front", 7.8), ("rear", -7.8)):
        bodies.append(body(name, BOGIE, (0.0, BOGIE_PITCH, 0.0), (x, 0.0, 0.0), moves))
        for low, high, at, (k, c) in [
            ("car", name, x, SECONDARY),
            (name, "rail", x + 1.25, PRIMARY),
            (name, "rail", x - 1.25, PRIMARY),
        ]:
            springs.append(spring(low, high, (at, 0.0, 0.0), (0.0, k), (0.0, c)))
    vehicle = rb.Vehicle("planar", tuple(bodies), tuple(springs), SPACING)
    return rb.Train(vehicle, cars=cars)


def problems():
    """Return by name a function of ours and one of OpenSees (given its module), both for the sag.

    Cars twice: to 1e-4 of the displacement, and to 1e-4 of the wheel forces.
    """
    deck = rb.deck_from_table(
        "planar",
        {
            "length": LENGTH, "bending_stiffness_vertical": STIFFNESS, "mass": MASS,
            "damping": {"ratio": RATIO, "frequencies_hz": TWO.tolist()}, "modes": 20,
        }
    )  # fmt: skip

    def sag(some, **options):
        return lambda: (
            -rb.cross(some, deck, speed=SPEED, time_step=STEP, **options)
            .displacement(x=LENGTH / 2)["displacement_z"]
            .min()
        )

    found = {}
    for name, axles in (("one load", AXLES[:1]), ("32 loads", _axles(8))):
        some = rb.AxleTrain(axles.tolist(), [LOAD] * len(axles))
        found[name] = sag(some, interaction="rigid"), _loads(axles)
    for cars, name in ((1, "one car"), (8, "eight cars")):
        for of in ("displacement", "forces"):
            ours = sag(train(cars), tolerance=1e-4, tolerance_of=of)
            found[f"{name}, 1e-4 of {of}"] = ours, _cars(cars)
    return found


def _axles(cars):
    return (AXLES + SPACING * np.arange(cars)[:, None]).ravel()


# ---- OpenSees


def opensees():
    """Return the module ``openseespy.opensees``, None where it is not there.

    Its libraries are loaded first: it does not say where they are.
    """
    bundle = importlib.util.find_spec("openseespylinux")
    places = bundle.submodule_search_locations if bundle else []
    waiting = sorted(path for place in places for path in Path(place).glob("lib/*.so*"))
    while waiting:
        failed = [path for path in waiting if not _loaded(path)]
        if len(failed) == len(waiting):
            break
        waiting = failed
    try:
        return importlib.import_module("openseespy.opensees")
    except Exception:  # a library is missing, or there is none for this system
        return None


def _loaded(path):
    try:
        ctypes.CDLL(str(path), ctypes.RTLD_GLOBAL)
    except OSError:
        return False
    return True


def _beam(ops):
    """Build the deck, ready to be stepped."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for i in range(ELEMENTS + 1):
        ops.node(i + 1, i * ELEMENT, 0.0)
    ops.fix(1, 1, 1, 0)
    ops.fix(ELEMENTS + 1, 0, 1, 0)
    ops.geomTransf("Linear", 1)
    for e in range(1, ELEMENTS + 1):
        section = 1.0, STIFFNESS, 1.0
        ops.element("elasticBeamColumn", e, e, e + 1, *section, 1, "-mass", MASS, "-cMass")
    w = 2 * np.pi * TWO
    alpha, beta = np.linalg.solve(0.5 * np.array([1 / w, w]).T, [RATIO, RATIO])
    ops.rayleigh(alpha, beta, 0.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandSPD")
    ops.test("NormUnbalance", 1e-6, 10)
    ops.algorithm("Linear")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def _hermite(s):
    """Share of a force at s in an element of both nodes' forces and couples."""
    a, r = ELEMENT, s / ELEMENT
    return np.array(
        [1 - 3 * r**2 + 2 * r**3, a * r * (1 - r) ** 2, r**2 * (3 - 2 * r), a * r**2 * (r - 1)]
    )


def _place(x):
    """Number of the element at x, from 0, and the shares of its nodes."""
    e = min(int(x // ELEMENT), ELEMENTS - 1)
    return e, _hermite(x - e * ELEMENT)


def _steps(axles):
    return round((LENGTH + axles[-1]) / SPEED / STEP)


def _loads(axles):
    """Bare loads: time functions of the nodes, made beforehand."""

    def run(ops):
        _beam(ops)
        steps = _steps(axles)
        force = np.zeros((2 * ELEMENTS + 2, steps + 1))
        for k in range(steps + 1):
            for x in SPEED * STEP * k - axles:
                if 0 <= x <= LENGTH:
                    e, shares = _place(x)
                    force[2 * e : 2 * e + 4, k] -= LOAD * shares
        for i, values in enumerate(force):
            if values.any():
                ops.timeSeries("Path", i + 1, "-dt", STEP, "-values", *values.tolist())
                ops.pattern("Plain", i + 1, i + 1)
                ops.load(i // 2 + 1, 0.0, *((1.0, 0.0) if i % 2 == 0 else (0.0, 1.0)))
        lowest = 0.0
        for _ in range(steps):
            ops.analyze(1, STEP)
            lowest = min(lowest, ops.nodeDisp(ELEMENTS // 2 + 1, 2))
        return -lowest

    return run


def _cars(count):
    """Cars by Newmark in NumPy, on the deck's motion of the step before."""
    between = np.array([[1, -7.8, -1, 0, 0, 0], [1, 7.8, 0, -1, 0, 0]])
    bogies = np.array([[1, 0, -1.25, 0], [1, 0, 1.25, 0], [0, 1, 0, -1.25], [0, 1, 0, 1.25]])
    wheels = np.hstack([np.zeros((4, 2)), bogies])
    m = np.diag([BODY, BODY_PITCH, BOGIE, BOGIE, BOGIE_PITCH, BOGIE_PITCH])
    k, c = (
        between.T @ between * s + wheels.T @ wheels * p
        for s, p in zip(SECONDARY, PRIMARY, strict=True)
    )
    inverse = np.linalg.inv(k + 4 / STEP**2 * m + 2 / STEP * c)
    axles = _axles(count)

    def run(ops):
        _beam(ops)
        ops.timeSeries("Constant", 1)
        u, v, a = np.zeros((3, count, 6))
        before, lowest = np.zeros(4 * count), 0.0
        for i in range(1, _steps(axles) + 1):
            x = SPEED * STEP * i - axles
            on = (x >= 0) & (x <= LENGTH)
            places = {q: _place(x[q]) for q in np.flatnonzero(on)}
            moved = np.zeros(4 * count)
            for q, (e, shares) in places.items():
                ends = [ops.nodeDisp(n, d) for n in (e + 1, e + 2) for d in (2, 3)]
                moved[q] = shares @ ends
            rate = np.where(on, (moved - before) / STEP, 0.0)
            before = moved
            if i > 1:
                ops.remove("loadPattern", 1)
            ops.pattern("Plain", 1, 1)
            for n in range(count):
                own = slice(4 * n, 4 * n + 4)
                below = PRIMARY[0] * moved[own] + PRIMARY[1] * rate[own]
                push = wheels.T @ below + m @ (4 / STEP**2 * u[n] + 4 / STEP * v[n] + a[n])
                new = inverse @ (push + c @ (2 / STEP * u[n] + v[n]))
                faster = 4 / STEP**2 * (new - u[n]) - 4 / STEP * v[n] - a[n]
                u[n], v[n], a[n] = new, v[n] + STEP / 2 * (a[n] + faster), faster
                force = PRIMARY[0] * (wheels @ u[n]) + PRIMARY[1] * (wheels @ v[n]) - below - LOAD
                for q, own_force in zip(range(4 * n, 4 * n + 4), force, strict=True):
                    if q in places:
                        e, shares = places[q]
                        ops.load(e + 1, 0.0, *(own_force * shares[:2]).tolist())
                        ops.load(e + 2, 0.0, *(own_force * shares[2:]).tolist())
            ops.analyze(1, STEP)
            lowest = min(lowest, ops.nodeDisp(ELEMENTS // 2 + 1, 2))
        return -lowest

    return run
