r"""The paper's fixed point with somebody else's deck: wheel forces out, displacements in.

The deck is solved in another program. Each pass is one exchange of files:

1. `export_loads` writes the loads of the present wheel forces as time functions of the nodes under
   the rail;
2. the other program computes and writes the displacements of these nodes;
3. `next_forces` adds them to the irregularity under every wheel (the paper's "equivalent
   irregularity") and runs the train on it: the next wheel forces, with the change against the last
   ones.

The train's side is that of `coupling`: the nodes' displacements stand in place of modal
coordinates, with the functions that interpolate between nodes in place of mode shapes.

How loads get to the nodes is in `loads`.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from .. import errors
from ..contacts import Rail
from ..coupling import Coupling, DeckState, ForcesAdded, prepare
from ..decks import History
from ..errors import InputError, brief, within
from ..guideways import Guideway, PiecewiseCubic
from ..settings import check, refuse_bytes
from ..tracks import FadeIn, Track
from ..trains import AnyTrain
from ..units import per_metre
from .interpolation import spline
from .loads import NodalLoads, export_loads, nodal_loads
from .nodes import RailLine, model_units
from .tables import Columns, read_columns

__all__ = [
    "NodalLoads", "NodeMotion", "Staggered", "begin", "equivalent_irregularity", "export_loads",
    "next_forces", "nodal_loads", "read_motion",
]  # fmt: skip

_OPTIONS = ("loads", "track_offset", "time_step", "lead_in", "tail", "excitation", "feedback")
_MOTIONS = ("ux", "uy", "uz", "rx", "ry", "rz")


@dataclass(frozen=True, eq=False)
class Staggered:
    """Wheel forces after some exchanges with another program.

    Attributes
    ----------
    train : AnyTrain
    track : Track
    line : RailLine
    coupling : Coupling
        The train's side of the iteration; its deck is `nodal_guideway`.
    passes : tuple of list of ndarray
        What the deck's motion adds to the wheel forces, N, for each pass; pass 0 (rigid deck)
        first. See `Crossing.passes`.
    changes : tuple of float
        See `Coupling.change`; small twice in a row means settled.
    felt : DeckState or None
        The nodes' motion that the last forces answer to.
    """

    __repr__ = brief

    train: AnyTrain
    track: Track
    line: RailLine
    coupling: Coupling
    passes: tuple[ForcesAdded, ...]
    changes: tuple[float, ...] = ()
    felt: DeckState | None = None

    @property
    def iteration(self) -> int:
        """The number of the last pass."""
        return len(self.passes) - 1

    @property
    def time(self) -> np.ndarray:
        """s, shape (n,); zero when the first axle enters."""
        return self.coupling.time

    @cached_property
    def wheel_forces(self) -> np.ndarray:
        """All wheel forces on the deck, N, shape (wheels, 2, n): lateral, vertical.

        The static part is included.
        """
        return errors.frozen(self.coupling.wheel_forces(self.passes[-1], self.felt))


def nodal_guideway(line: RailLine, track_height: float = 0.0, rail: Rail | None = None) -> Guideway:
    """Return what moves as the nodes of a line do: its coordinates are their y, z and twist.

    Its shapes interpolate between the nodes by cubic splines.
    """
    n = len(line.x)
    needed = 8.0 * 48 * n**2  # of all coordinates, and of the splines they are made of
    refuse_bytes("line", n, needed, "shapes of so many nodes", "Use a coarser line")
    cardinal = spline(line.x, np.eye(n))
    coefficients = np.zeros((n - 1, 4, 3 * n, 3))
    for c in range(3):
        coefficients[:, :, c * n : (c + 1) * n, c] = cardinal
    shapes = PiecewiseCubic(line.x, coefficients)
    own = {"shapes": shapes, "track_height": track_height, "rail": rail}
    return Guideway(name="nodes", length=line.length, **own)


def begin(
    train: AnyTrain,
    track: Track,
    line: RailLine,
    *,
    speed: float,
    track_height: float = 0.0,
    rail: Rail | None = None,
    **options: Any,
) -> Staggered:
    """Return pass 0: the wheel forces on a rigid deck.

    Parameters
    ----------
    train, track
    line : RailLine
        The nodes under the rail, from ``read_nodes(...).line(...)``.
    speed : float
        m/s.
    track_height : float
        Rails above the deck axis, m; see `Deck`.
    rail : Rail, optional
        How rails spread loads and carry on over the deck's ends; see `Deck`. Time then begins
        before the first axle enters.
    options
        ``loads``, ``track_offset``, ``time_step``, ``lead_in``, ``tail``, ``excitation``,
        ``feedback``; see `cross`.

    Raises
    ------
    InputError
        Another option, or what `cross` refuses.
    """
    errors.keys("", options, _OPTIONS)
    track_height = errors.number("track_height", track_height, unit="m")
    deck = nodal_guideway(line, track_height, rail)
    coupling = prepare(train, deck, track, check(train, deck, track, speed=speed, **options))
    return Staggered(train, track, line, coupling, (coupling.nothing_added(),))


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """Displacements of the nodes of a line, SI, without those under the deck's own weight.

    Attributes
    ----------
    time : ndarray, shape (t,)
        s, ascending; zero when the first axle enters, negative before.
    y, z, roll : ndarray, shape (nodes, t)
        m, m, rad; nodes as in ``line.nodes``. `roll` is not used where a left and a right line
        carry the rail.
    """

    __repr__ = brief

    time: np.ndarray
    y: np.ndarray
    z: np.ndarray
    roll: np.ndarray


def read_motion(path: str | Path, line: RailLine) -> NodeMotion:
    """Read a displacement history: a CSV file with columns time, node, and ux, uy, uz, rx, ry, rz.

    In the units and axes of the line's nodes; the unit of length can also be said by a line
    ``# units: mm``. Rows in any order; nodes off the line are passed over. uy and uz (in our axes)
    are needed; the others may be left out. Without rx a single line does not twist.

    Raises
    ------
    InputError
        A node of the line is missing, or not all of them have the same instants.
    """
    table = read_columns(path, ["time", "node"], _MOTIONS)
    with within(source=table.name):
        for i, needed in ((1, "lateral"), (2, "vertical")):
            column = _MOTIONS[int(np.argmax(np.abs(line.turn[i])))]
            if column not in table.cells:
                allowed = f"is missing: the {needed} displacement"
                raise InputError(f"column {column}", None, allowed, "Write zeros if none")
        length = line.units[0]
        if table.units is not None:
            length = model_units(table.units)[0]
        time, index = _instants(table, line)
    zeros = np.zeros(len(table.lines))
    found = np.array([table.numbers(c) if c in table.cells else zeros for c in _MOTIONS])
    moved = np.einsum("ij,jnt->int", line.turn, found[:3][:, index]) / per_metre(length)
    turned = np.einsum("ij,jnt->int", line.turn, found[3:][:, index])
    return NodeMotion(time, moved[1], moved[2], turned[0])


def _instants(table: Columns, line: RailLine) -> tuple[np.ndarray, np.ndarray]:
    """Return the instants, s, and the row of each node of the line at each, shape (nodes, t)."""
    times = table.numbers("time")
    rows: dict[str, list[int]] = {}
    for i, label in enumerate(table.labels("node")):
        rows.setdefault(label, []).append(i)
    for label in line.nodes:
        if label not in rows:
            near = errors.did_you_mean(label, rows)
            raise InputError("node", label, "of the rail line is missing", near)
    index = [np.array(rows[n])[np.argsort(times[rows[n]], kind="stable")] for n in line.nodes]
    time = times[index[0]]
    for label, own in zip(line.nodes, index, strict=True):
        slack = 1e-9 * max(time[-1], 1e-9)
        if len(own) != len(time) or np.any(np.abs(times[own] - time) > slack):
            allowed = f"has not the instants of node {line.nodes[0]}"
            raise InputError(f"node {label}", None, allowed, "Write all nodes at every instant")
    return time, np.array(index)


def next_forces(step: Staggered, motion: NodeMotion, share: float = 1.0) -> Staggered:
    """Return the next pass: the wheel forces on the irregularity plus the deck's motion.

    Parameters
    ----------
    step : Staggered
        The pass whose loads the other program was given.
    motion : NodeMotion
        What it answered.
    share : float
        Relaxation: the share of the correction that is applied. Less than 1 helps light decks and
        fast trains.

    Raises
    ------
    InputError
        A history that does not cover the crossing, is not finite, or does not start from rest.

    Notes
    -----
    Velocities are those of a cubic spline through the instants, so these must be as fine as the
    motion: a step of the size of ours, or a twentieth of the shortest period that matters.
    """
    share = errors.number("share", share, above=0.0, most=1.0)
    axis = _axis_motion(step.line, motion)
    time = step.time[: max(c.window.stop for c in step.coupling.cars)]
    _refuse_history(motion, axis, time)
    inside = np.clip(time, motion.time[0], motion.time[-1])
    follow = CubicSpline(motion.time, axis, axis=1)
    q, velocity = np.zeros((2, len(axis), len(step.time)))
    q[:, : len(time)], velocity[:, : len(time)] = follow(inside), follow(inside, 1)
    felt = DeckState(q, velocity, np.zeros_like(q))
    old = step.passes[-1]
    new = step.coupling.train_pass(felt)
    change = step.coupling.change(new, old)
    if share < 1.0:
        new = [o + share * (n - o) for n, o in zip(new, old, strict=True)]
    return replace(step, passes=(*step.passes, new), changes=(*step.changes, change), felt=felt)


def _axis_motion(line: RailLine, motion: NodeMotion) -> np.ndarray:
    """Return y, z and twist of the deck axis at the places of the line, shape (3 n, t).

    First y of all places, then z, then the twist.
    """
    shape = line.y.shape
    for name in ("y", "z", "roll"):
        values = getattr(motion, name)
        if np.shape(values) != (len(line.nodes), len(motion.time)):
            allowed = f"must have {len(line.nodes)} nodes and {len(motion.time)} instants"
            remedy = "Give arrays of shape (nodes, instants)"
            raise InputError(f"motion.{name}", np.shape(values), allowed, remedy)
    motions = (motion.y, motion.z, motion.roll)
    y, z, roll = (np.moveaxis(np.reshape(a, (*shape, -1)), -1, 0) for a in motions)
    return np.concatenate([values.T for values in line.axis_motion(y, z, roll)])


def _refuse_history(motion: NodeMotion, axis: np.ndarray, needed: np.ndarray) -> None:
    time = motion.time
    if len(time) < 4 or np.any(np.diff(time) <= 0):
        allowed = "must ascend and hold at least 4 instants"
        raise InputError("motion.time", None, allowed, "Sort it, and write more instants")
    size = np.abs(axis).max(initial=0.0)
    if not size < 1e6:  # squares of such motions overflow, and NaN is not less
        allowed = "must be finite, and less than 1e6 m"
        raise InputError("motion", None, allowed, "Did the other program diverge?")
    slack = 1.5 * float(np.median(np.diff(time)))
    if time[0] > needed[0] + slack or time[-1] < needed[-1] - slack:
        allowed = f"must cover the crossing, {needed[0]:g} to {needed[-1]:g} s"
        allowed += ", from the first axle's entrance on"
        remedy = "Compute longer, or shift its zero"
        raise InputError("motion.time", [float(time[0]), float(time[-1])], allowed, remedy)
    if size > 0.0 and np.abs(axis[:, 0]).max() > 0.05 * size:
        allowed = "is not at rest at the start, where only the first axle stands on its end"
        remedy = "Leave out the deck's own weight: the track is laid level on the sagged deck"
        raise InputError("motion", None, allowed, remedy)
    if size > 1.0:
        warnings.warn(
            f"motion: {size:.3g} m is a large displacement of a bridge; are the units right (mm?)",
            stacklevel=3,
        )


def equivalent_irregularity(step: Staggered, car: int = 1, wheel: int = 1) -> History:
    """Return what one wheel of the last pass has met: irregularity plus the deck's motion.

    This is the paper's second step.

    Parameters
    ----------
    step : Staggered
    car, wheel : int
        Both count from 1.

    Returns
    -------
    History
        ``track_z``, ``deck_z``, ``equivalent_z`` and the same for y, m, over the whole record. With
        ``feedback`` vertical only the deck's ``z`` is felt, without twist.

    Raises
    ------
    InputError
        No such wheel in the train.
    """
    s, own = step.coupling.settings, None
    for c in step.coupling.cars:
        for place, station in zip(c.car.axles, c.axles, strict=True):
            for found in place.wheels:
                if (found.car, found.number) == (car, wheel):
                    own, axle, vehicle = found, int(station), c.car.vehicle
    if own is None:
        allowed = "no such (car, wheel) in this train"
        raise InputError("wheel", (car, wheel), allowed, "Both are counted from 1")
    ahead = vehicle.front - own.x if s.excitation == "car" and vehicle is not None else 0.0
    x = s.speed * step.time - own.delay + ahead
    deck = np.zeros((2, len(step.time)))
    if step.felt is not None:
        axles = step.coupling.axles
        motion, _ = axles.motion(axles.ordered(step.felt.q, step.felt.velocity), np.array([axle]))
        moved = motion[:, 0]
        start = int(axles.starts[axle])
        window = slice(start, start + moved.shape[1])
        deck[1, window] = moved[1]
        if s.feedback == "all":
            deck[0, window] = moved[0] - step.coupling.deck.track_height * moved[2]
            deck[1, window] += (s.track_offset + own.y) * moved[2]
    values = {}
    for name, direction, met in (("y", "lateral", deck[0]), ("z", "vertical", deck[1])):
        track = FadeIn(step.track.rail(direction, own.side), s.lead_in).value(x)
        values |= {f"track_{name}": track, f"deck_{name}": met, f"equivalent_{name}": track + met}
    return History(step.time, values, dict.fromkeys(values, "m"), f"car {car}, wheel {wheel}")
