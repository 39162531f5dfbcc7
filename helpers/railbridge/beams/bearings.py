r"""Bearings: where they stand, what they hold, and the rows that say so.

A bearing at (x, y, z) is tied rigidly to the section at x. With the section's displacement (u, v,
w) and rotation theta it moves by ``u + theta x r``,

    x:  u + theta_y z - theta_z y,      y:  v - theta_x z,      z:  w + theta_x y,

y and z measured from the deck axis, which runs through the shear centres, and u being that of the
centroid, so that there z counts from the centroid. A freedom is held rigidly (its row is zero) or
by a spring to the ground (its row times the stiffness is the force).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from .. import errors
from ..errors import InputError, Range, check_fields

__all__ = ["FIXITIES", "Bearing", "free_motions", "null_space", "on_deck"]

FIXITIES = ("x", "y", "z", "roll", "pitch", "yaw")
FARTHEST = 50.0
"""Farthest a bearing may stand from the deck axis, m: farther is a slip of units."""
_FROM_AXIS = Range(
    least=-FARTHEST, most=FARTHEST, unit="m", remedy="It is counted from the deck axis, in m"
)
STIFFEST = 1e16
"""N/m and N m/rad: beyond this a spring would cost the modes their digits."""
_TINY = 1e-9
_SLACK = 1e-6
"""Share of the deck's length by which a bearing may miss the end of a span and still stands on it:
rounding."""


@dataclass(frozen=True)
class Bearing:
    """A bearing under the deck.

    Attributes
    ----------
    x : float
        m along the deck.
    fixed : tuple of str
        What it holds rigidly: some of x y z roll pitch yaw. By default y z roll, or nothing where
        springs are given.
    y : float
        m left of the deck axis.
    z : float
        m above the deck axis; below it negative.
    stiffness : mapping
        What it holds by springs, { x = 6e9, z = 2e9 }: N/m for x y z, N m/rad for roll pitch yaw.
        Elastomeric bearings, piers.
    span : int, optional
        Where simple spans meet: the span it carries, from 1. Left out: one such bearing stands
        under each.

    Raises
    ------
    InputError
        An unknown freedom, one that is held twice, or a value out of range.
    """

    x: Annotated[float, Range(unit="m")]
    fixed: tuple[str, ...] | None = None
    y: Annotated[float, _FROM_AXIS] = 0.0
    z: Annotated[float, _FROM_AXIS] = 0.0
    stiffness: Mapping[str, float] = field(default_factory=dict, hash=False)
    span: Annotated[int, Range(least=1, whole=True)] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        springs, fixed = errors.table("stiffness", self.stiffness), self.fixed
        if fixed is None:
            fixed = () if springs else ("y", "z", "roll")
        if isinstance(fixed, str):
            fixed = fixed.split()
        if not isinstance(fixed, (list, tuple)):
            allowed = "must list some of " + " ".join(FIXITIES)
            raise InputError("fixed", fixed, allowed)
        for name in fixed:
            errors.choice("fixed", name, FIXITIES)
        for name, value in springs.items():
            errors.choice("stiffness", name, FIXITIES)
            unit = "N/m" if name in "xyz" else "N m/rad"
            remedy = "Put what does not give into fixed"
            limits = {"above": 0.0, "most": STIFFEST, "unit": unit, "remedy": remedy}
            errors.number(f"stiffness.{name}", value, **limits)
            if name in fixed:
                raise InputError(f"stiffness.{name}", value, "is fixed, too", "Give one of both")
        object.__setattr__(self, "fixed", tuple(fixed))

    @property
    def restrained(self) -> tuple[str, ...]:
        """All it holds, rigidly or by springs, in the order x y z roll pitch yaw."""
        return tuple(n for n in FIXITIES if n in self.fixed or n in self.stiffness)

    def row(self, freedom: str, centroid: float = 0.0) -> np.ndarray:
        """Return the bearing's displacement or rotation from its node's freedoms, shape (6,).

        Freedoms of a node: u (of the centroid, `centroid` m above the axis), v, w, theta_x,
        theta_z, -theta_y.
        """
        y, z = self.y, self.z
        return {
            "x": np.array([1.0, 0.0, 0.0, 0.0, -y, centroid - z]),
            "y": np.array([0.0, 1.0, 0.0, -z, 0.0, 0.0]),
            "z": np.array([0.0, 0.0, 1.0, y, 0.0, 0.0]),
            "roll": np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
            "pitch": np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0]),
            "yaw": np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        }[freedom]


def on_deck(x: float, ends: np.ndarray) -> float:
    """Return the place of a bearing (m): x, or the end of a span that x misses by rounding only.

    Parameters
    ----------
    x : float
        m.
    ends : ndarray
        Ends of the spans, m, ascending from 0.

    Raises
    ------
    InputError
        Off the deck.
    """
    slack = _SLACK * float(ends[-1])
    remedy = "It must lie on the deck, x runs along it from its start"
    x = errors.number("x", x, least=-slack, most=float(ends[-1]) + slack, unit="m", remedy=remedy)
    nearest = float(ends[np.argmin(np.abs(ends - x))])
    return nearest if abs(nearest - x) <= slack else x


def null_space(rows: np.ndarray) -> np.ndarray:
    """Return the motions of a node, shape (n, n - rank), that `rows`, shape (r, n), leave free.

    By elimination from the left, so that freedoms which no row couples stay themselves. Rows that
    say nothing new, as two bearings on one section that both hold y, are passed over.
    """
    a = np.array(rows, dtype=float)
    count = a.shape[1]
    pivots: list[int] = []
    for column in range(count):
        below = np.abs(a[len(pivots) :, column])
        if len(below) == 0 or below.max() < _TINY:
            continue
        best, here = len(pivots) + int(np.argmax(below)), len(pivots)
        a[[here, best]] = a[[best, here]]
        a[here] /= a[here, column]
        others = np.arange(len(a)) != here
        a[others] -= a[others, column][:, None] * a[here]
        a[np.abs(a) < _TINY] = 0.0
        pivots.append(column)
    free = [c for c in range(count) if c not in pivots]
    result = np.zeros((count, len(free)))
    result[free, np.arange(len(free))] = 1.0
    result[pivots] = -a[: len(pivots)][:, free]
    return result


_MOTIONS = {
    # what it is called: the field it belongs to
    "sliding along x": "axial", "moving along y": "lateral", "moving along z": "vertical",
    "rolling": "torsion", "pitching": "vertical", "yawing": "lateral",
}  # fmt: skip


def free_motions(
    bearings: Sequence[Bearing],
    fields: Sequence[str],
    length: float,
    centroid: float,
    reference: Mapping[str, float],
) -> list[str]:
    """Return in words the rigid-body motions that the bearings leave free.

    Empty when the piece is held.

    Parameters
    ----------
    bearings : sequence of Bearing
        Those under one piece of deck.
    fields : sequence of str
        How the deck can move.
    length : float
        Of the whole deck, m; makes rows of turning and of moving comparable.
    centroid : float
        m above the deck axis.
    reference : mapping
        For each freedom, the stiffness below which a spring counts less than a rigid bearing: far
        below it, nothing.
    """
    motions = [m for m, f in _MOTIONS.items() if f in fields]
    rows = []
    for b in bearings:
        s = b.x / length
        section = {  # u, v, w, theta_x, theta_z, -theta_y of the section at x
            "sliding along x": [1, 0, 0, 0, 0, 0],
            "moving along y": [0, 1, 0, 0, 0, 0],
            "moving along z": [0, 0, 1, 0, 0, 0],
            "rolling": [0, 0, 0, 1, 0, 0],
            "pitching": [0, 0, s * length, 0, 0, 1],
            "yawing": [0, s * length, 0, 0, 1, 0],
        }
        for name in b.restrained:
            weight = min(1.0, b.stiffness[name] / reference[name]) if name in b.stiffness else 1.0
            row = weight * b.row(name, centroid)
            scale = 1.0 if name in "xyz" else length
            rows.append(
                [
                    scale * row @ section[m] / (1.0 if m.startswith(("slid", "mov")) else length)
                    for m in motions
                ]
            )
    rows = np.array(rows).reshape(-1, len(motions))
    _, sizes, directions = np.linalg.svd(rows)
    rank = int(np.sum(sizes > 1e-6 * max(sizes.max(initial=0.0), 1e-300)))
    loose = directions[rank:]
    found = []
    for j, motion in enumerate(motions):
        moves = motion.startswith(("slid", "mov"))
        # A turn is free if it takes part in any free motion (its axis may lie anywhere), a shift
        # only if it is free by itself.
        if (not rows[:, j].any()) if moves else (np.linalg.norm(loose[:, j]) > 1e-6):
            found.append(motion)
    return found if rank < len(motions) else []
