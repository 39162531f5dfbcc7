r"""Bearings: where they stand, what they hold, and the rows that say so.

A bearing at (x, y, z) is tied rigidly to the section at x. With the section's displacement (u, v,
w) and rotation theta it moves by ``u + theta x r``,

    x:  u + theta_y z - theta_z y,      y:  v - theta_x z,      z:  w + theta_x y,

y and z measured from the deck axis, which runs through the shear centres, and u being that of the
centroid, so that there z counts from the centroid. A freedom is held rigidly (its row is zero) or
by a spring to the ground (its row times the stiffness is the force). A pier below a bearing is a
spring in series with what the bearing holds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from .. import errors
from ..errors import InputError, Range, check_fields
from .piers import Pier

__all__ = ["FIXITIES", "Bearing", "arm", "free_motions", "null_space", "on_deck"]

FIXITIES = ("x", "y", "z", "roll", "pitch", "yaw")
FARTHEST = 50.0
"""Farthest a bearing may stand from the deck axis, m: farther is a slip of units."""
_FROM_AXIS = Range(
    least=-FARTHEST, most=FARTHEST, unit="m", remedy="It is counted from the deck axis, in m"
)
_SPRING_REMEDY = "Put what does not give into fixed"
STIFFEST = 1e16
"""N/m and N m/rad: beyond this a spring would cost the modes their digits."""
_TINY = 1e-9


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
        Elastomeric bearings. Where they let an end of the deck move, wheels step onto it at
        full weight unless the deck has a rail: accelerations are then not to be trusted.
    span : int, optional
        Where simple spans meet: the span it carries, from 1. Left out: one such bearing stands
        under each.
    pier : Pier, optional
        What the bearing stands on: springs in series with what it holds along x, y and z. Left
        out: the ground below it does not give.

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
    pier: Pier | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.pier is not None:
            errors.instance("pier", self.pier, Pier)
            _refuse_stiff(self.pier)
        springs = _checked_springs(self.stiffness)
        fixed = self.fixed
        if fixed is None:
            fixed = () if springs else ("y", "z", "roll")
        fixed = _checked_freedoms(fixed)
        for name in springs:
            if name in fixed:
                path, both = f"stiffness.{name}", "is fixed, too"
                raise InputError(path, self.stiffness[name], both, "Give one of both")
        object.__setattr__(self, "fixed", fixed)
        object.__setattr__(self, "stiffness", springs)

    @property
    def restrained(self) -> tuple[str, ...]:
        """All it holds, rigidly or by springs, in the order x y z roll pitch yaw."""
        return tuple(n for n in FIXITIES if n in self.fixed or n in self.stiffness)

    @property
    def springs(self) -> dict[str, float]:
        """Stiffness of what gives, its pier with it, N/m and N m/rad by freedom."""
        below = {} if self.pier is None else self.pier.stiffness
        own = {name: below[name] for name in self.fixed if name in below}
        for name, stiffness in self.stiffness.items():
            softer = 1.0 / (1.0 + stiffness / below[name]) if name in below else 1.0
            own[name] = stiffness * softer
        return own

    @property
    def rigid(self) -> tuple[str, ...]:
        """What it holds so that it does not give at all."""
        return tuple(name for name in self.fixed if self.pier is None or name not in "xyz")

    def row(self, freedom: str, centroid: float = 0.0) -> np.ndarray:
        """Return the bearing's displacement or rotation from its node's freedoms; see `arm`."""
        return arm(freedom, self.y, self.z, centroid)


def arm(freedom: str, y: float, z: float, centroid: float = 0.0) -> np.ndarray:
    """Return the motion of what is rigidly tied to a node, from the node's freedoms, shape (6,).

    Freedoms of a node: u (of the centroid, `centroid` m above the axis), v, w, theta_x, theta_z,
    -theta_y.

    Parameters
    ----------
    freedom : str
        One of `FIXITIES`.
    y, z, centroid : float
        m from the deck axis.
    """
    return {
        "x": np.array([1.0, 0.0, 0.0, 0.0, -y, centroid - z]),
        "y": np.array([0.0, 1.0, 0.0, -z, 0.0, 0.0]),
        "z": np.array([0.0, 0.0, 1.0, y, 0.0, 0.0]),
        "roll": np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        "pitch": np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0]),
        "yaw": np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    }[freedom]


def _refuse_stiff(pier: Pier) -> None:
    given = {"x": "second_moment_along", "y": "second_moment_across", "z": "area"}
    for name, stiffness in pier.stiffness.items():
        if stiffness > STIFFEST:
            allowed = f"makes a pier of {pier.height:g} m stiffer along {name} than "
            remedy = "Check its unit; leave out the pier of a bearing that does not give"
            value = getattr(pier, given[name])
            raise InputError(f"pier.{given[name]}", value, f"{allowed}{STIFFEST:g} N/m", remedy)


def _checked_freedoms(fixed: Any) -> tuple[str, ...]:
    """Return freedoms given as a list or as one text, or refuse them."""
    names = fixed.split() if isinstance(fixed, str) else fixed
    if not isinstance(names, (list, tuple)):
        remedy = "Write them as a list, or as one text between quotes"
        raise InputError("fixed", fixed, "must list some of " + " ".join(FIXITIES), remedy)
    for name in names:
        errors.choice("fixed", name, FIXITIES)
    return tuple(names)


def _checked_springs(stiffness: Any) -> dict[str, float]:
    """Return stiffnesses by freedom, N/m and N m/rad, or refuse them."""
    springs = errors.table("stiffness", stiffness)
    for name, value in springs.items():
        errors.choice("stiffness", name, FIXITIES)
        unit = "N/m" if name in "xyz" else "N m/rad"
        limits = Range(above=0.0, most=STIFFEST, unit=unit, remedy=_SPRING_REMEDY)
        springs[name] = limits.checked(f"stiffness.{name}", value)
    return springs


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
    remedy = "It must lie on the deck, x runs along it from its start"
    return errors.place("x", x, ends, slack=errors.ROUNDED, remedy=remedy)


def null_space(rows: np.ndarray) -> np.ndarray:
    """Return the motions of a node, shape (n, n - rank), that `rows`, shape (r, n), leave free.

    By elimination from the left, so that freedoms which no row couples stay themselves. Rows that
    say nothing new, as two bearings on one section that both hold y, are passed over.
    """
    reduced = np.array(rows, dtype=float)
    count = reduced.shape[1]
    pivots: list[int] = []
    for column in range(count):
        row = len(pivots)
        below = np.abs(reduced[row:, column])
        if len(below) == 0 or below.max() < _TINY:
            continue
        largest = row + int(np.argmax(below))
        reduced[[row, largest]] = reduced[[largest, row]]
        reduced[row] /= reduced[row, column]
        others = np.arange(len(reduced)) != row
        reduced[others] -= reduced[others, column][:, None] * reduced[row]
        reduced[np.abs(reduced) < _TINY] = 0.0
        pivots.append(column)
    free = [c for c in range(count) if c not in pivots]
    result = np.zeros((count, len(free)))
    result[free, np.arange(len(free))] = 1.0
    result[pivots] = -reduced[: len(pivots)][:, free]
    return result


_SHIFTS = {"sliding along x": "axial", "moving along y": "lateral", "moving along z": "vertical"}
_TURNS = {"rolling": "torsion", "pitching": "vertical", "yawing": "lateral"}
"""Rigid-body motions in words, and the field that each belongs to."""


def free_motions(
    bearings: Sequence[Bearing],
    fields: Sequence[str],
    length: float,
    centroid: float,
    reference: Mapping[str, float],
) -> list[str]:
    """Return in words the rigid-body motions that the bearings leave free, none if it is held.

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
    motions = [m for m, f in {**_SHIFTS, **_TURNS}.items() if f in fields]
    rows = []
    for bearing in bearings:
        section = _rigid_motions(bearing.x)
        for freedom in bearing.restrained:
            row = bearing.row(freedom, centroid)
            # What the beam has no stiffness for does not move: a spring there holds nothing.
            if freedom in bearing.springs and freedom in reference:
                row *= min(1.0, bearing.springs[freedom] / reference[freedom])
            # Everything as a length: a turn by the shift that it makes over the deck's length.
            row *= 1.0 if freedom in "xyz" else length
            rows.append([row @ section[m] / (length if m in _TURNS else 1.0) for m in motions])
    rows = np.array(rows).reshape(-1, len(motions))
    _, sizes, directions = np.linalg.svd(rows)
    rank = int(np.sum(sizes > 1e-6 * max(sizes.max(initial=0.0), 1e-300)))
    if rank == len(motions):
        return []
    # A turn is free if it takes part in any free motion (its axis may lie anywhere), a shift only
    # if it is free by itself.
    shares = np.linalg.norm(directions[rank:], axis=0)
    free = np.where([m in _TURNS for m in motions], shares > 1e-6, ~rows.any(axis=0))
    return [motion for motion, is_free in zip(motions, free, strict=True) if is_free]


def _rigid_motions(x: float) -> dict[str, list[float]]:
    """Return u, v, w, theta_x, theta_z, -theta_y of the section at x (m) in each unit motion."""
    return {
        "sliding along x": [1, 0, 0, 0, 0, 0],
        "moving along y": [0, 1, 0, 0, 0, 0],
        "moving along z": [0, 0, 1, 0, 0, 0],
        "rolling": [0, 0, 0, 1, 0, 0],
        "pitching": [0, 0, x, 0, 0, 1],
        "yawing": [0, x, 0, 0, 1, 0],
    }
