"""OpenSeesPy as somebody else's program: a deck of its own beam elements.

It gives the deck's modes and its answer to load histories.

OpenSeesPy stands in the test group only, since its licence restricts redistribution. It brings its
Fortran libraries along but does not say where they are; loaded here first, it finds them on any
system.
"""

import ctypes
import importlib.util
from pathlib import Path

import numpy as np
import pytest


def load():
    """Return the module ``openseespy.opensees``, or skip the test and say why it is not there."""
    bundle = importlib.util.find_spec("openseespylinux")
    waiting = (
        sorted(Path(bundle.submodule_search_locations[0]).glob("lib/*.so*"))
        if bundle is not None
        else []
    )
    while waiting:
        failed = [path for path in waiting if not loaded(path)]
        if len(failed) == len(waiting):
            break  # what is left needs something the system does not have
        waiting = failed
    return pytest.importorskip(
        "openseespy.opensees", reason="OpenSeesPy cannot be loaded here", exc_type=Exception
    )


def loaded(path):
    try:
        ctypes.CDLL(str(path), ctypes.RTLD_GLOBAL)
    except OSError:
        return False
    return True


class BeamDeck:
    """A straight deck of elastic 3D beam elements on two bearing lines.

    x runs along the deck, y to the left, z up. Any consistent set of units will do: forces, lengths
    and masses are those of the numbers given.
    """

    def __init__(
        self,
        length,
        elements,
        e,
        g,
        area,
        inertia_y,
        inertia_z,
        torsion,
        mass,
        polar_inertia,
        damping=(0.0, 0.0),
    ):
        self.ops, self.elements = load(), elements
        self.x = np.linspace(0.0, length, elements + 1)
        self.section = (area, e, g, torsion, inertia_y, inertia_z)
        self.mass, self.polar_inertia, self.damping = mass, polar_inertia, damping

    def build(self):
        """Start from an empty program, since it knows one model at a time."""
        ops = self.ops
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        ops.geomTransf("Linear", 1, 0.0, 1.0, 0.0)
        share = np.full(len(self.x), self.x[1] - self.x[0])
        share[[0, -1]] /= 2
        for i, (x, h) in enumerate(zip(self.x, share, strict=True), start=1):
            ops.node(i, float(x), 0.0, 0.0)
            # Mass along the track would add axial modes that no load excites.
            ops.mass(i, 0.0, self.mass * h, self.mass * h, self.polar_inertia * h, 0.0, 0.0)
        area, e, g, torsion, inertia_y, inertia_z = self.section
        for i in range(1, self.elements + 1):
            # The local y axis is the model's z, so its bending inertias change places.
            ops.element(
                "elasticBeamColumn", i, i, i + 1, area, e, g, torsion, inertia_z, inertia_y, 1
            )
        ops.fix(1, 1, 1, 1, 1, 0, 0)
        ops.fix(len(self.x), 0, 1, 1, 1, 0, 0)
        return ops

    def modes(self, count):
        """Frequencies (Hz) and shapes, shape (modes, nodes, 6), mass-normalised."""
        ops = self.build()
        squares = np.array(ops.eigen(count))
        shapes = [
            [ops.nodeEigenvector(n, m) for n in range(1, len(self.x) + 1)]
            for m in range(1, count + 1)
        ]
        return np.sqrt(squares) / (2 * np.pi), np.array(shapes)

    def masses(self):
        """Mass and polar inertia of every node, shape (nodes, 2)."""
        share = np.full(len(self.x), self.x[1] - self.x[0])
        share[[0, -1]] /= 2
        return np.outer(share, [self.mass, self.polar_inertia])

    def respond(self, time, functions):
        """Displacements uy, uz, rx of all nodes under load functions, shape (3, nodes, instants).

        By Newmark's method at the step of `time`.
        `functions` holds (node, component 0 to 5, values at `time`).
        """
        ops = self.build()
        alpha, beta = self.damping
        ops.rayleigh(alpha, 0.0, beta, 0.0)
        step = float(time[1] - time[0])
        for i, (node, component, values) in enumerate(functions, start=1):
            load = [0.0] * 6
            load[component] = 1.0
            # The program is at rest at the first instant; its own first step ends at the second.
            ops.timeSeries("Path", i, "-dt", step, "-values", *map(float, values))
            ops.pattern("Plain", i, i)
            ops.load(int(node), *load)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("BandSPD")
        ops.test("NormDispIncr", 1e-12, 2, 0)
        ops.algorithm("Linear", False, False, True)
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        result = np.zeros((3, len(self.x), len(time)))
        for k in range(1, len(time)):
            assert ops.analyze(1, step) == 0
            for n in range(len(self.x)):
                moved = ops.nodeDisp(n + 1)
                result[:, n, k] = moved[1], moved[2], moved[3]
        ops.wipe()
        return result


RAILS = ((100, 3380.0, 1300.0), (200, 1420.0, 1300.0))
"""Rail nodes of the example, of the left track, 2.4 m off the axis.

Offset of their numbers, y and z from the axis, mm.
"""


def viaduct36_in_mm(elements=24):
    """The shipped deck viaduct36 in N, mm, t, s, with its Rayleigh damping."""
    e, f1, f2 = 35e3, 2 * np.pi * 3.307, 2 * np.pi * 16.30
    damping = 2 * 0.03 * f1 * f2 / (f1 + f2), 2 * 0.03 / (f1 + f2)
    inertia_y, inertia_z, density = 2.553e12, 25.53e12, 2.5e-9
    properties = (
        e,
        e / 2.4,
        4.8e6,
        inertia_y,
        inertia_z,
        5.59e12,
        density * 4.8e6,
        density * (inertia_y + inertia_z),
    )
    return BeamDeck(36e3, elements, *properties, damping)


def example_tables(modes=10):
    """The shipped example data/exchange/viaduct36_mm: {file name: header and rows of numbers}.

    Nodes stand on the axis and under the rails. Rail nodes move with the axis as on rigid arms,
    u + theta x r.
    """
    deck = viaduct36_in_mm()
    frequencies, shapes = deck.modes(modes)
    alpha, beta = deck.damping
    omega = 2 * np.pi * frequencies
    nodes, masses, rows = [], [], []
    for first, y, z in ((0, 0.0, 0.0), *RAILS):
        for i, (x, own) in enumerate(zip(deck.x, deck.masses(), strict=True), start=1):
            nodes.append([first + i, x, y, z])
            masses.append([first + i, *(own if first == 0 else (0.0, 0.0))])
    for m, (f, ratio, shape) in enumerate(
        zip(frequencies, alpha / (2 * omega) + beta * omega / 2, shapes, strict=True), 1
    ):
        shape = shape * np.sign(shape.flat[np.argmax(np.abs(shape[:, :3]))] or 1.0)
        for first, y, z in ((0, 0.0, 0.0), *RAILS):
            moved = shape.copy()
            moved[:, :3] += np.cross(shape[:, 3:], [0.0, y, z])
            rows += [[m, f, ratio, first + i, *values] for i, values in enumerate(moved, start=1)]
    return {
        "nodes.csv": ("node,x,y,z", nodes),
        "modes.csv": ("mode,frequency_hz,damping_ratio,node,ux,uy,uz,rx,ry,rz", rows),
        "masses.csv": ("node,mass,inertia_x", masses),
    }


def write_example(folder):
    """Write the tables of the shipped example."""
    for name, (header, rows) in example_tables().items():
        lines = [",".join(f"{v:.9g}" if abs(v) > 1e-15 else "0" for v in row) for row in rows]
        (folder / name).write_text(
            "\n".join(["# units: mm, t", header, *lines]) + "\n", encoding="utf-8"
        )
