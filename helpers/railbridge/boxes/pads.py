r"""What the bearings of a shell hold: pads of stated size under points of its section.

A force on a shell at one point, in the plane of a web, has no mesh limit: the displacement under it
grows with the logarithm of the element size, and frequencies sink for ever. A bearing therefore
acts on a pad: it holds, rigidly or by springs, the *mean* displacement of the web's foot over the
pad's length. The mean leaves the foot free to turn, as a bearing does, and is an integral of the
finite-element field, so that pads need no mesh of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_array, eye_array, vstack

__all__ = ["DIRECTIONS", "Pad", "elimination", "free_motion_count", "support_rows"]

DIRECTIONS = ("x", "y", "z")
"""What a pad may hold."""
STIFFEST = 1e14
"""N/m: beyond this a spring would cost the modes their digits."""


@dataclass(frozen=True)
class Pad:
    """A bearing pad under a point of the section.

    Attributes
    ----------
    x, length : float
        Middle and length along the deck, m.
    point : int
        Point of the section that stands on it.
    arm : float
        m, how far below that point the bearing holds.
    fixed : tuple of str
        Directions held: a subset of x y z.
    stiffness : dict of float
        N/m, springs in directions not fixed.
    """

    x: float
    length: float
    point: int
    arm: float = 0.0
    fixed: tuple[str, ...] = ("z",)
    stiffness: dict[str, float] = field(default_factory=dict)


def support_rows(
    pads: Sequence[Pad], stations: np.ndarray, points: int, size: int
) -> list[tuple[csr_array, float]]:
    """Return what pads hold.

    Rows over all freedoms that give mean displacements, and their stiffness (inf: rigid).

    Parameters
    ----------
    pads : sequence of Pad
    stations : ndarray, shape (s,)
        m.
    points : int
        Of the section. Its nodes are counted station by station, six freedoms a node.
    size : int
        Number of all freedoms.

    Returns
    -------
    list of (csr_array, shape (1, size); float, N/m)
    """
    return [
        (
            _mean(pad, direction, stations, points, size),
            np.inf if direction in pad.fixed else pad.stiffness[direction],
        )
        for pad in pads
        for direction in DIRECTIONS
        if direction in pad.fixed or direction in pad.stiffness
    ]


def _mean(pad: Pad, direction: str, stations: np.ndarray, points: int, size: int) -> csr_array:
    """Return the row that gives the pad's mean displacement in one direction.

    The pad hangs `arm` below the point and turns with it: along x by the slope of the foot over the
    pad (the straight line nearest to w), along y by the mean roll of the foot.
    """
    station, mean, slope = _over(pad, stations)
    node = station * points + pad.point
    d = DIRECTIONS.index(direction)
    entries = {int(6 * n + d): m for n, m in zip(node, mean, strict=True)}
    if pad.arm and direction == "x":
        # theta_y = -w', and the point lies at (0, 0, -arm): u_x + theta_y (-arm).
        entries |= {int(6 * n + 2): pad.arm * s for n, s in zip(node, slope, strict=True)}
    elif pad.arm and direction == "y":
        entries |= {int(6 * n + 3): pad.arm * m for n, m in zip(node, mean, strict=True)}
    columns = np.array(list(entries))
    return csr_array((list(entries.values()), ([0] * len(columns), columns)), shape=(1, size))


def _over(pad: Pad, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The stations under a pad and the weights of mean and slope of a linear field over it."""
    a, b = max(pad.x - pad.length / 2, x[0]), min(pad.x + pad.length / 2, x[-1])
    cuts = np.unique(np.concatenate([[a, b], x[(x > a) & (x < b)]]))
    # Two Gauss points integrate products of linear functions exactly on each piece.
    half, middle = np.diff(cuts)[:, None] / 2, (cuts[:-1, None] + cuts[1:, None]) / 2
    places = (middle + half * np.array([-1.0, 1.0]) / np.sqrt(3.0)).ravel()
    weights = np.repeat(half.ravel(), 2) / (b - a)
    shape = np.zeros((len(places), len(x)))
    right = np.clip(np.searchsorted(x, places), 1, len(x) - 1)
    share = (places - x[right - 1]) / (x[right] - x[right - 1])
    shape[np.arange(len(places)), right] = share
    shape[np.arange(len(places)), right - 1] = 1.0 - share
    lever = places - weights @ places
    mean, slope = weights @ shape, (weights * lever) @ shape / (weights @ lever**2)
    used = np.flatnonzero(shape.any(axis=0))
    return used, mean[used], slope[used]


def elimination(rows: Sequence[tuple[csr_array, float]], size: int) -> tuple[csr_array, np.ndarray]:
    """Return what turns the freedoms that rigid bearings leave into all, and which are left.

    See `support_rows`.
    """
    rigid = [row for row, stiffness in rows if np.isinf(stiffness)]
    if not rigid:
        return eye_array(size, format="csr"), np.arange(size)
    conditions = vstack(rigid).tocsr()
    used = np.unique(conditions.indices)
    block = conditions[:, used].toarray()
    # One freedom of each condition follows from the others: that with the largest weight not yet
    # taken.
    gone: list[int] = []
    work = block.copy()
    for r in range(len(work)):
        pivot = int(np.argmax(np.abs(work[r])))
        gone.append(pivot)
        others = np.arange(len(work)) != r
        work[others] -= np.outer(work[others, pivot] / work[r, pivot], work[r])
    kept = np.setdiff1d(np.arange(len(used)), gone)
    follow = -np.linalg.solve(block[:, gone], block[:, kept])
    left = np.setdiff1d(np.arange(size), used[gone])
    place = np.searchsorted(left, used[kept])
    places = np.concatenate([left, np.repeat(used[gone], len(kept))])
    columns = np.concatenate([np.arange(len(left)), np.tile(place, len(gone))])
    values = np.concatenate([np.ones(len(left)), follow.ravel()])
    return csr_array((values, (places, columns)), shape=(size, len(left))), left


def free_motion_count(
    rows: Sequence[tuple[csr_array, float]], nodes: np.ndarray, length: float
) -> int:
    """Return how many rigid-body motions of nodes, shape (n, 3), `support_rows` leave free.

    `length` (m) makes turning and moving comparable.
    """
    x, y, z = (nodes - nodes.mean(axis=0)).T
    zero, one = np.zeros(len(x)), np.ones(len(x))
    motions = np.zeros((len(x), 6, 6))
    for k in range(3):
        motions[:, k, k] = one
        motions[:, 3 + k, 3 + k] = one
    motions[:, :3, 3] = np.stack([zero, -z, y], axis=1)
    motions[:, :3, 4] = np.stack([z, zero, -x], axis=1)
    motions[:, :3, 5] = np.stack([-y, x, zero], axis=1)
    flat = motions.reshape(-1, 6)
    kept = np.array([(row @ flat).ravel() for row, _ in rows]).reshape(-1, 6)
    return (
        6 - int(np.linalg.matrix_rank(kept * [1.0, 1.0, 1.0, *[1.0 / length] * 3], tol=1e-6))
        if len(kept)
        else 6
    )
