"""A deck as a frame in space, nothing reduced: elements of twelve freedoms, consistent mass.

Freedoms of a node, at the deck axis: u, v, w, theta_x, theta_y, theta_z, with theta_z = v' and
theta_y = -w'. Twist has freedoms inside the element, too: its bend travels with a moving torque,
and a straight line between nodes would lose what the turning mass does there, (V/c)^2 of the
torque however short the elements. A bearing at (x, y, z) is tied to the node at x by a rigid arm;
what it holds rigidly is a constraint, what it holds by a spring is added to the stiffness. All of
it is written from the book (Przemieniecki 1968, chapters 5 and 11) and takes plain numbers.

Two ways of damping. Rayleigh: C = alpha M + beta K, where beta K is viscosity inside the deck and
its elastic bearings, and alpha M a drag from outside. Modal: one ratio for every mode of this
frame, C = M Phi diag(2 zeta omega) Phi' M, a drag from outside as well, spread like the mass.
"""

import numpy as np
from newmark import MASS, STIFFNESS, hermite
from numpy.polynomial import Polynomial, legendre
from scipy.linalg import cho_factor, cho_solve, eigh
from scipy.sparse import coo_array, csc_array, eye_array
from scipy.sparse.linalg import splu

INNER = 2
"""Freedoms of twist inside an element, behind those of its nodes."""
SIZE = 12 + INNER
LATERAL, VERTICAL, AXIAL = [1, 5, 7, 11], [2, 4, 8, 10], [0, 6]
TWIST = [3, 9, *range(12, SIZE)]
UPWARD = np.array([1.0, -1.0, 1.0, -1.0])
"""w' = -theta_y."""
DIRECTIONS = ("x", "y", "z", "roll", "pitch", "yaw")


def arm(y, z):
    """Motion of a point at (y, z) of a section from its node's freedoms: three shifts, three
    turns."""
    rows = np.eye(6)
    rows[:3, 3:] = [[0.0, z, -y], [-z, 0.0, 0.0], [y, 0.0, 0.0]]
    return rows


def _lobatto():
    """Twist from end to end and integrated Legendre polynomials, zero at both ends; as powers of
    s = 0..1, shape (2 + INNER, INNER + 2)."""
    rows = [[1.0, -1.0], [0.0, 1.0]]
    for n in range(1, INNER + 1):
        two = [legendre.Legendre.basis(i).convert(kind=Polynomial) for i in (n + 1, n - 1)]
        rows.append(((two[0] - two[1]) / (4 * n + 2))(Polynomial([-1.0, 2.0])).coef)
    return np.array([np.pad(row, (0, INNER + 2 - len(row))) for row in rows])


INSIDE = _lobatto()


def twist(s):
    """Twist inside an element at places s = 0..1, (n,), and its derivative by s, (2 + INNER, n)."""
    powers = s ** np.arange(INNER + 2)[:, None]
    return INSIDE @ powers, INSIDE[:, 1:] @ (np.arange(1, INNER + 2)[:, None] * powers[:-1])


def element(h, axial, lateral, vertical, torsion, mass, polar):
    """Stiffness and consistent mass of a straight element, (12 + INNER, 12 + INNER) each."""
    k, m = np.zeros((2, SIZE, SIZE))
    scale = np.outer([1, h] * 2, [1, h] * 2)
    for where, bending, sign in (
        (LATERAL, lateral, np.ones(4)),
        (VERTICAL, vertical, UPWARD),
    ):
        here = np.ix_(where, where)
        k[here] += bending / h**3 * STIFFNESS * scale * np.outer(sign, sign)
        m[here] += mass * h * MASS * scale * np.outer(sign, sign)
    here = np.ix_(AXIAL, AXIAL)
    k[here] += axial / h * np.array([[1, -1], [-1, 1]])
    m[here] += mass * h / 6 * np.array([[2, 1], [1, 2]])
    here = np.ix_(TWIST, TWIST)
    x, weights = legendre.leggauss(INNER + 2)
    value, slope = twist((x + 1) / 2)
    k[here] += torsion / h * (slope * weights / 2) @ slope.T
    m[here] += polar * h * (value * weights / 2) @ value.T
    return k, m


def shapes(s, h):
    """v, w and theta_x, and their slopes along x, at s = 0..1 of elements of length h, both (n,);
    (n, 3, SIZE) each."""
    value, slope = np.zeros((2, len(s), 3, SIZE))
    for part, cubic in zip((value, slope), hermite(s, h), strict=True):
        part[:, 0, LATERAL] = cubic.T
        part[:, 1, VERTICAL] = cubic.T * UPWARD
    inside = twist(s)
    value[:, 2, TWIST], slope[:, 2, TWIST] = inside[0].T, (inside[1] / h).T
    return value, slope


def even(spans, size):
    """Ends of equal elements of at most `size` (m) in every span."""
    ends = np.concatenate([[0.0], np.cumsum(spans)])
    counts = [round(np.ceil(span / size - 1e-9)) + 1 for span in spans]
    return [np.linspace(*pair, n) for *pair, n in zip(ends[:-1], ends[1:], counts, strict=True)]


class SpaceFrame:
    """A deck of beam elements.

    Parameters
    ----------
    numbers : dict
        ``spans`` (m), ``continuous``, ``axial``, ``lateral``, ``vertical``, ``torsion`` (EA, EI_z,
        EI_y, GJ), ``mass`` (kg/m), ``polar`` (kg m), and ``bearings``: a list of dicts with ``x``,
        ``y``, ``z``, ``fixed`` (names of directions), ``springs`` (direction: N/m or N m/rad) and
        ``span`` (from 0). Either ``rayleigh`` (alpha, beta) or ``ratio``.
    mesh : list of ndarray
        Ends of the elements of every span, m.
    """

    def __init__(self, numbers, mesh):
        spans = numbers["spans"]
        self.length, self.ends = sum(spans), np.concatenate([[0.0], np.cumsum(spans)])
        self.joined = numbers["continuous"]
        self.h = np.concatenate([np.diff(edges) for edges in mesh])
        self.span = np.repeat(np.arange(len(spans)), [len(edges) - 1 for edges in mesh])
        self.first = np.arange(len(self.h)) + (0 if self.joined else self.span)
        self.start = np.concatenate([edges[:-1] for edges in mesh])
        self.nodes = self.first[-1] + 2
        self.place = np.zeros(self.nodes)
        self.place[self.first], self.place[self.first + 1] = self.start, self.start + self.h
        names = ("axial", "lateral", "vertical", "torsion", "mass", "polar")
        made = [element(h, *(numbers[n] for n in names)) for h in self.h]
        self.k, self.m = (np.array(part) for part in zip(*made, strict=True))
        count = len(self.h)
        inner = 6 * self.nodes + np.arange(INNER * count).reshape(count, INNER)
        self.freedoms = np.hstack([6 * self.first[:, None] + np.arange(12), inner])
        self.size = 6 * self.nodes + INNER * count
        self.elastic, self.inertia = self._assembled(self.k), self._assembled(self.m)
        self._set_bearings(numbers["bearings"])
        self._set_damping(numbers)

    def _assembled(self, parts):
        rows = np.broadcast_to(self.freedoms[:, :, None], parts.shape)
        columns = np.broadcast_to(self.freedoms[:, None, :], parts.shape)
        where = rows.ravel(), columns.ravel()
        return coo_array((parts.ravel(), where), shape=(self.size,) * 2).tocsr()

    def node(self, x, span=None):
        """The node at x; where two spans meet, that of the given span or else the first."""
        near = np.flatnonzero(np.abs(self.place - x) < 1e-9 * self.length)
        assert len(near), f"no node at {x}"
        if len(near) == 1 or span is None:
            return near[0]
        return near[0] if abs(self.ends[span + 1] - x) < 1e-9 * self.length else near[1]

    def _set_bearings(self, bearings):
        self.bearings = [(self.node(b["x"], b.get("span")), b) for b in bearings]
        stiffness, held = self.elastic.tolil(copy=True), {}
        for node, b in self.bearings:
            rows, own = arm(b["y"], b["z"]), slice(6 * node, 6 * node + 6)
            for direction, spring in b["springs"].items():
                row = rows[DIRECTIONS.index(direction)]
                stiffness[own, own] = stiffness[own, own] + spring * np.outer(row, row)
            held.setdefault(node, []).extend(rows[DIRECTIONS.index(d)] for d in b["fixed"])
        # What a node may still do: the null space of all that is held there.
        blocks = []
        for node in range(self.nodes):
            rows = np.array(held.get(node, [])).reshape(-1, 6)
            _, sizes, turned = np.linalg.svd(rows)
            rank = int(np.sum(sizes > 1e-9))
            blocks.append(np.eye(6) if rank == 0 else turned[rank:].T)
        parts, count = [], 0
        for node, block in enumerate(blocks):
            i, j = np.indices(block.shape)
            parts.append((6 * node + i.ravel(), count + j.ravel(), block.ravel()))
            count += block.shape[1]
        inner = np.arange(self.size - 6 * self.nodes)
        parts.append((6 * self.nodes + inner, count + inner, np.ones(len(inner))))
        rows, columns, values = (np.concatenate(part) for part in zip(*parts, strict=True))
        self.free = coo_array(
            (values, (rows, columns)), shape=(self.size, count + len(inner))
        ).tocsr()
        self.stiffness = (self.free.T @ stiffness.tocsr() @ self.free).tocsr()
        self.mass = (self.free.T @ self.inertia @ self.free).tocsr()

    def _set_damping(self, numbers):
        self.alpha, self.beta = numbers.get("rayleigh") or (0.0, 0.0)
        self.drag = self.alpha * eye_array(self.mass.shape[0], format="csr")
        self.damping = self.alpha * self.mass + self.beta * self.stiffness
        if numbers.get("ratio"):
            squares, modes = eigh(self.stiffness.toarray(), self.mass.toarray())
            moved = self.mass @ modes
            rates = 2 * numbers["ratio"] * np.sqrt(squares)
            self.drag = (modes * rates) @ moved.T
            self.damping = (moved * rates) @ moved.T

    def frequencies(self, count):
        """Lowest natural frequencies, Hz."""
        squares = eigh(self.stiffness.toarray(), self.mass.toarray(), eigvals_only=True)
        return np.sqrt(squares[:count]) / (2 * np.pi)

    # ---- what travels

    def under(self, x, span):
        """Elements at places x in given spans, both (n,), and shapes and slopes there."""
        first, behind = np.searchsorted(self.span, [span, span + 1])
        e = np.searchsorted(self.start, x, side="right") - 1
        e = np.clip(e, first, behind - 1)
        return e, *shapes((x - self.start[e]) / self.h[e], self.h[e])

    # ---- what comes out, from histories over all freedoms, one column an instant

    def carried(self, motion, velocity, acceleration):
        """What springs of the frame carry, d + beta d', and what its mass is pushed by, d'' and the
        drag from outside; from free to all freedoms."""
        push = acceleration + self.drag @ velocity
        return self.free @ (motion + self.beta * velocity), self.free @ push

    def section(self, node, strain, push, loads):
        """Forces and moments on the face with normal +x just before a node, (6, n).

        `loads` is what stands on the element before the node, (SIZE, n).
        """
        e = int(np.flatnonzero(self.first + 1 == node)[0])
        own = self.freedoms[e]
        return (self.k[e] @ strain[own] + self.m[e] @ push[own] - loads)[6:12]

    def supported(self, strain, push, loads):
        """What every node gets from its bearings, (6, n) by node."""
        left_over = self.elastic @ strain + self.inertia @ push - loads
        return {n: left_over[6 * n : 6 * n + 6] for n in {n for n, _ in self.bearings}}

    def bearing_forces(self, strain, push, loads):
        """What every bearing exerts on the deck, a dict of histories each, by direction.

        Where rigid bearings on one section share what statics does not split, all of them are taken
        as equally stiff.
        """
        nodes, result = self.supported(strain, push, loads), []
        springs, rigid = {}, {}
        for i, (node, b) in enumerate(self.bearings):
            own, rows = slice(6 * node, 6 * node + 6), arm(b["y"], b["z"])
            for direction, stiffness in b["springs"].items():
                row = rows[DIRECTIONS.index(direction)]
                springs[i, direction] = force = -stiffness * (row @ strain[own])
                nodes[node] = nodes[node] - np.outer(row, force)
            for direction in b["fixed"]:
                rigid.setdefault(node, []).append((i, direction, rows[DIRECTIONS.index(direction)]))
        for node, held in rigid.items():
            rows = np.array([row for *_, row in held])
            for (i, direction, _), force in zip(
                held, np.linalg.pinv(rows.T) @ nodes[node], strict=True
            ):
                springs[i, direction] = force
        for i, (_, b) in enumerate(self.bearings):
            names = [d for d in DIRECTIONS if d in b["springs"] or d in b["fixed"]]
            result.append({d: springs[i, d] for d in names})
        return result


class Implicit:
    """Solves (M + g C + g^2 K) a = b of a frame for one g, and knows its flexibility.

    Parameters
    ----------
    frame : SpaceFrame
    g : float
        s.
    often : bool
        Whether it is worth having the whole inverse.
    """

    def __init__(self, frame, g, often):
        self.free = frame.free
        whole = frame.mass + g * frame.damping + g**2 * frame.stiffness
        self.inverse = None
        dense = isinstance(whole, np.ndarray)
        if dense:
            factor = cho_factor(whole)
            self.solve = lambda b: cho_solve(factor, b, check_finite=False)
        else:
            self.solve = splu(csc_array(whole)).solve
        if often:
            own = self.solve(np.eye(whole.shape[0]))
            self.inverse = np.ascontiguousarray(self.free @ (self.free @ own.T).T)
            if dense:
                self.solve = own.__matmul__

    def flexibility(self, there, here, loads):
        """Motion of the freedoms `there` under `loads` on the freedoms `here`, all freedoms."""
        if self.inverse is not None:
            return self.inverse[np.ix_(there, here)] @ loads
        force = np.zeros((self.free.shape[0], loads.shape[1]))
        np.add.at(force, here, loads)
        return (self.free @ self.solve(self.free.T @ force))[there]
