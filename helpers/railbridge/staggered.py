r"""The paper's fixed point with somebody else's deck: wheel forces out, displacements in, pass by pass.

The deck is solved in another program. Each pass is one exchange of files:

1. `export_loads` writes the loads of the present wheel forces as time functions of the nodes under the rail;
2. the other program computes and writes the displacements of these nodes;
3. `next_forces` adds them to the irregularity under every wheel (the paper's "equivalent irregularity") and runs the train
   on it: the next wheel forces, with the change against the last ones.

The train's side is that of `interaction`: the nodes' displacements stand in place of modal coordinates, with the functions
that interpolate between nodes in place of mode shapes.

Distribution to nodes. A load at x between two nodes acts through the shapes that a beam element has there. With couples
(beam models) these are Hermite's cubics, so that the nodes' forces and couples do the same work on the element as the load
itself; without (solid and shell models) forces follow the lever rule. Both are statically equivalent: same force, same
moment, at every instant. The moment about x of loads off the axis goes with the lever rule as a couple, or as a pair of
forces where a left and a right line of nodes carry the rail.
"""

from __future__ import annotations

import csv
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from . import inputs
from .crossing import Crossing
from .deck import Deck, History, PiecewiseCubic
from .inputs import InputError
from .interaction import Coupling, DeckState, Delta, prepare
from .nodes import MASSES, PER_METRE, RailLine, read_columns, spline
from .settings import check
from .track import FadeIn, Track
from .train import AxleTrain, Train

__all__ = [
    "NodalLoads", "NodeMotion", "Staggered", "begin", "equivalent_irregularity", "export_loads", "next_forces", "nodal_loads",
    "read_motion",
]  # fmt: skip

FORMATS = ("csv", "abaqus")
_COMPONENTS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")


# ---- passes


@dataclass(frozen=True, eq=False)
class Staggered:
    """Wheel forces after some exchanges with another program.

    Attributes
    ----------
    train : Train or AxleTrain
    track : Track
    line : RailLine
    coupling : Coupling
        The train's side of the iteration; its deck is `nodal_deck`.
    passes : tuple of list of ndarray
        What the deck's motion adds to the wheel forces, N, for each pass; pass 0 (rigid deck) first. See `Crossing.passes`.
    changes : tuple of float
        See `Coupling.change`; small twice in a row means settled.
    felt : DeckState or None
        The nodes' motion that the last forces answer to.
    """

    train: Train | AxleTrain
    track: Track
    line: RailLine
    coupling: Coupling
    passes: tuple[Delta, ...]
    changes: tuple[float, ...] = ()
    felt: DeckState | None = None

    @property
    def shown(self) -> int:
        """The number of the last pass."""
        return len(self.passes) - 1

    @property
    def time(self) -> np.ndarray:
        """s, shape (n,); zero when the first axle enters."""
        return self.coupling.time

    @cached_property
    def wheel_forces(self) -> np.ndarray:
        """All wheel forces on the deck, N, shape (wheels, 2, n): lateral, vertical; static part included."""
        return inputs.frozen(self.coupling.wheel_forces(self.passes[-1], self.felt))


def nodal_deck(line: RailLine, track_height: float = 0.0) -> Deck:
    """Return a deck whose coordinates are the displacements y, z and the twist of the nodes of a line.

    It has no frequencies of its own; only its shapes, which interpolate between the nodes by cubic splines, have a meaning.
    """
    n = len(line.x)
    cardinal = spline(line.x, np.eye(n))
    coefficients = np.zeros((n - 1, 4, 3 * n, 3))
    for c in range(3):
        coefficients[:, :, c * n : (c + 1) * n, c] = cardinal
    none = np.ones(3 * n)
    shapes = PiecewiseCubic(line.x, coefficients)
    return Deck("nodes", line.length, none, 0.0 * none, ("node",) * (3 * n), shapes, track_height=track_height)


def begin(
    train: Train | AxleTrain, track: Track, line: RailLine, *, speed: float, track_height: float = 0.0, **options: Any
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
    options
        ``loads``, ``track_offset``, ``time_step``, ``lead_in``, ``tail``, ``excitation``, ``feedback``; see `cross`.
    """
    allowed = ("loads", "track_offset", "time_step", "lead_in", "tail", "excitation", "feedback")
    inputs.keys("run", options, allowed)
    track_height = inputs.number("track_height", track_height, unit="m")
    deck = nodal_deck(line, track_height)
    coupling = prepare(train, deck, track, check(train, deck, track, speed=speed, **options))
    return Staggered(train, track, line, coupling, (coupling.at_rest(),))


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """Displacements of the nodes of a line, SI, without those under the deck's own weight.

    Attributes
    ----------
    time : ndarray, shape (t,)
        s, ascending; zero when the first axle enters.
    y, z, roll : ndarray, shape (nodes, t)
        m, m, rad; nodes as in ``line.nodes``. `roll` is not used where a left and a right line carry the rail.
    """

    time: np.ndarray
    y: np.ndarray
    z: np.ndarray
    roll: np.ndarray


def read_motion(path: str | Path, line: RailLine) -> NodeMotion:
    """Read a displacement history: a CSV file with columns time, node, and of ux, uy, uz, rx, ry, rz those that are known.

    In the units and axes of the line's nodes; m or mm can also be said by a line ``# units: mm``. Rows in any order; nodes off
    the line are passed over. uy and uz (in our axes) are needed; without rx a single line does not twist.

    Raises
    ------
    InputError
        A node of the line is missing, or not all of them have the same instants.
    """
    translations, rotations = ["ux", "uy", "uz"], ["rx", "ry", "rz"]
    table = read_columns(path, ["time", "node"], [*translations, *rotations])
    for i, needed in ((1, "lateral"), (2, "vertical")):
        column = translations[int(np.argmax(np.abs(line.turn[i])))]
        if column not in table.cells:
            raise InputError(
                f"{table.name}: column {column}", None, f"is missing: the {needed} displacement", "Write zeros if none"
            )
    length = line.units[0]
    if table.units is not None:
        length = inputs.choice(f"{table.name}: units", (*table.units, "")[0], PER_METRE)
    labels, times = table.labels("node"), table.numbers("time")
    rows: dict[str, list[int]] = {}
    for i, label in enumerate(labels):
        rows.setdefault(label, []).append(i)
    for label in line.nodes:
        if label not in rows:
            raise InputError(f"{table.name}: node", label, "of the rail line is missing", inputs.did_you_mean(label, rows))
    order = {label: np.array(own)[np.argsort(times[own], kind="stable")] for label, own in rows.items()}
    time = times[order[line.nodes[0]]]
    for label in line.nodes:
        if len(order[label]) != len(time) or np.any(np.abs(times[order[label]] - time) > 1e-9 * max(time[-1], 1e-9)):
            remedy = "Write all nodes at every instant"
            raise InputError(f"{table.name}: node {label}", None, f"has not the instants of node {line.nodes[0]}", remedy)
    zeros = np.zeros(len(labels))
    found = np.array([table.numbers(c) if c in table.cells else zeros for c in (*translations, *rotations)])
    index = np.array([order[label] for label in line.nodes])
    moved = np.einsum("ij,jnt->int", line.turn, found[:3][:, index]) / PER_METRE[length]
    turned = np.einsum("ij,jnt->int", line.turn, found[3:][:, index])
    return NodeMotion(time, moved[1], moved[2], turned[0])


def next_forces(step: Staggered, motion: NodeMotion, share: float = 1.0) -> Staggered:
    """Return the next pass: the wheel forces on the irregularity plus the deck's motion under every wheel.

    Parameters
    ----------
    step : Staggered
        The pass whose loads the other program was given.
    motion : NodeMotion
        What it answered.
    share : float
        Relaxation: the share of the correction that is applied. Less than 1 helps light decks and fast trains.

    Raises
    ------
    InputError
        A history that does not cover the crossing, is not finite, or does not start from rest.

    Notes
    -----
    Velocities are those of a cubic spline through the instants, so these must be as fine as the motion: a step of the size
    of ours, or a twentieth of the shortest period that matters.
    """
    share = inputs.number("share", share, above=0.0, most=1.0)
    axis = _axis_motion(step.line, motion)
    time = step.time[: max(w.stop for w in step.coupling.windows)]
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
    """Return y, z and twist of the deck axis at the places of the line, one after the other, shape (3 n, t)."""
    shape = line.y.shape
    for name in ("y", "z", "roll"):
        values = getattr(motion, name)
        if np.shape(values) != (len(line.nodes), len(motion.time)):
            raise InputError(
                f"motion.{name}", np.shape(values), f"must have {len(line.nodes)} nodes and {len(motion.time)} instants"
            )
    y, z, roll = (np.moveaxis(np.reshape(a, (*shape, -1)), -1, 0) for a in (motion.y, motion.z, motion.roll))
    return np.concatenate([motion.T for motion in line.axis_motion(y, z, roll)])


def _refuse_history(motion: NodeMotion, axis: np.ndarray, needed: np.ndarray) -> None:
    time = motion.time
    if len(time) < 4 or np.any(np.diff(time) <= 0):
        raise InputError("motion.time", None, "must ascend and hold at least 4 instants")
    if not np.isfinite(axis).all():
        raise InputError("motion", None, "must be finite", "Did the other program diverge?")
    slack = 1.5 * float(np.median(np.diff(time)))
    if time[0] > needed[0] + slack or time[-1] < needed[-1] - slack:
        allowed = f"must cover the crossing, {needed[0]:g} to {needed[-1]:g} s, from the first axle's entrance on"
        raise InputError("motion.time", [float(time[0]), float(time[-1])], allowed, "Compute longer, or shift its zero")
    size = np.abs(axis).max()
    if size > 0.0 and np.abs(axis[:, 0]).max() > 0.05 * size:
        allowed = "is not at rest at the start, where only the first axle stands on its end"
        raise InputError("motion", None, allowed, "Leave out the deck's own weight: the track is laid level on the sagged deck")
    if np.abs(axis).max() > 1.0:
        warnings.warn(f"motion: {size:.3g} m is a large displacement of a bridge; are the units right (mm?)", stacklevel=3)


def equivalent_irregularity(step: Staggered, car: int = 1, wheel: int = 1) -> History:
    """Return what one wheel of the last pass has met: irregularity plus the deck's motion (the paper's second step).

    Returns
    -------
    History
        ``track_z``, ``deck_z``, ``equivalent_z`` and the same for y, m, over the whole record. With ``feedback`` vertical only
        the deck's ``z`` is felt, without twist.
    """
    wheels = [i for i, w in enumerate(step.train.wheels) if (w.car, w.number) == (car, wheel)]
    if not wheels:
        raise InputError("wheel", (car, wheel), "no such (car, wheel) in this train", "Both are counted from 1")
    own, s = step.train.wheels[wheels[0]], step.coupling.settings
    axle = step.coupling.axle_of[car - 1][wheel - 1] if not isinstance(step.train, AxleTrain) else wheels[0]
    ahead = 0.0
    if s.excitation == "car":
        vehicle = step.train.vehicles[car - 1]
        ahead = vehicle.length / 2 - vehicle.contacts[wheel - 1].x
    x = s.speed * step.time - own.delay + ahead
    deck = np.zeros((2, len(step.time)))
    if step.felt is not None:
        axles = step.coupling.axles
        moved = axles.motion(axles.ordered(step.felt.q), axles.ordered(step.felt.velocity), np.array([axle]))[0][:, 0]
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


# ---- loads out


@dataclass(frozen=True, eq=False)
class NodalLoads:
    """Time functions of the loads on the nodes of a line.

    Attributes
    ----------
    line : RailLine
    time : ndarray, shape (t,)
        s.
    values : ndarray, shape (nodes, 6, t)
        force_x, force_y, force_z (N), moment_x, moment_y, moment_z (N m) on the deck, in our axes; nodes as in ``line.nodes``.
    """

    line: RailLine
    time: np.ndarray
    values: np.ndarray

    def of_model(self) -> tuple[np.ndarray, str]:
        """Return the loads in the axes and units of the model, and the name of its unit of moments."""
        length, mass = self.line.units
        # A consistent set has mass times length per second squared as its force.
        force = PER_METRE[length] / MASSES[mass]
        turned = np.einsum("ji,njt->nit", self.line.turn, self.values[:, :3]) * force
        couples = np.einsum("ji,njt->nit", self.line.turn, self.values[:, 3:]) * force * PER_METRE[length]
        name = {("m", "kg"): "N", ("mm", "t"): "N", ("m", "t"): "kN"}.get((length, mass), f"{mass} {length}/s2")
        return np.concatenate([turned, couples], axis=1), name

    def functions(self) -> Iterator[tuple[str, int, np.ndarray]]:
        """Yield node, component (0 to 5) and time function, in the model's axes and units, of every one that is not zero."""
        values, _ = self.of_model()
        least = 1e-12 * np.abs(values).max(initial=0.0)
        for label, own in zip(self.line.nodes, values, strict=True):
            for component, function in enumerate(own):
                if np.abs(function).max(initial=0.0) > least:
                    yield label, component, function


def nodal_loads(run: Staggered | Crossing, line: RailLine | None = None, couples: bool | None = None) -> NodalLoads:
    """Return the loads of a crossing, statically equivalent at every instant, on the nodes of a line.

    Parameters
    ----------
    run : Staggered or Crossing
        The loads are those of the pass shown, the moving weight of the train included, the deck's own weight not.
    line : RailLine, optional
        Where they go; needed for a `Crossing`, whose deck must be as long.
    couples : bool, optional
        Whether nodes can take couples; default for a single line, not for a left and a right one.
    """
    if line is None:
        if not isinstance(run, Staggered):
            raise InputError("line", None, "is missing", "Give the nodes: read_nodes('nodes.csv').line()")
        line = run.line
    coupling = run.coupling
    if abs(line.length - coupling.deck.length) > 1e-4 * line.length:
        raise InputError("line", line.length, f"must be as long as the deck, {coupling.deck.length:g} m")
    couples = not line.paired if couples is None else inputs.boolean("couples", couples)
    axis = np.zeros((len(line.x), 5, len(coupling.time)))
    loads = coupling.station_loads(run.passes[run.shown])
    for delay, start, load in zip(coupling.load_delays, coupling.loads.starts, loads, strict=True):
        samples = np.arange(start, start + load.shape[1])
        x = np.clip(coupling.settings.speed * coupling.time[samples] - delay, 0.0, line.length)
        _distribute(axis, line.x, x, samples, load, couples)
    return NodalLoads(line, coupling.time, _to_nodes(line, axis))


def _distribute(axis: np.ndarray, nodes: np.ndarray, x: np.ndarray, samples: np.ndarray, load: np.ndarray, couples: bool) -> None:
    """Add one moving load, shape (3 or 5, count), to the loads at the axis, shape (n, 5, t)."""
    force_y, force_z, moment_x, moment_y, moment_z = np.concatenate([load, np.zeros((5 - len(load), load.shape[1]))])
    e = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, len(nodes) - 2)
    h = np.diff(nodes)[e]
    s = (x - nodes[e]) / h
    for node, share, rate in ((e, 1 - s, -1 / h), (e + 1, s, 1 / h)):
        axis[node, 2, samples] += share * moment_x
        if not couples:
            # A couple does work on the slope: M_y on -w', M_z on v'.
            axis[node, 0, samples] += share * force_y + rate * moment_z
            axis[node, 1, samples] += share * force_z - rate * moment_y
    if couples:
        value = (1 - 3 * s**2 + 2 * s**3, 3 * s**2 - 2 * s**3), (h * (s - 2 * s**2 + s**3), h * (s**3 - s**2))
        rise = (6 * s**2 - 6 * s) / h
        slope = (rise, -rise), (1 - 4 * s + 3 * s**2, 3 * s**2 - 2 * s)
        for i, node in enumerate((e, e + 1)):
            axis[node, 0, samples] += value[0][i] * force_y + slope[0][i] * moment_z
            axis[node, 1, samples] += value[0][i] * force_z - slope[0][i] * moment_y
            axis[node, 3, samples] += -value[1][i] * force_z + slope[1][i] * moment_y
            axis[node, 4, samples] += value[1][i] * force_y + slope[1][i] * moment_z


def _to_nodes(line: RailLine, axis: np.ndarray) -> np.ndarray:
    """Move loads from the deck axis to the nodes beside it, shape (nodes, 6, t)."""
    force_y, force_z, moment_x, moment_y, moment_z = np.moveaxis(axis, 1, 0)
    result = np.zeros((*line.y.shape, 6, axis.shape[-1]))
    height = line.z.mean(axis=1)[:, None]
    # The lateral force now acts at the nodes' height.
    moment_x = moment_x + height * force_y
    if line.paired:
        left, right = line.y[:, 0, None], line.y[:, 1, None]
        for i, (other, sign) in enumerate(((right, 1.0), (left, -1.0))):
            vertical = sign * (moment_x - other * force_z) / (left - right)
            result[:, i, 1:] = np.stack([force_y / 2, vertical, 0.0 * force_y, moment_y / 2, moment_z / 2], axis=1)
    else:
        moment_x = moment_x - line.y * force_z
        result[:, 0, 1:] = np.stack([force_y, force_z, moment_x, moment_y, moment_z], axis=1)
    return result.reshape(-1, 6, axis.shape[-1])


def export_loads(
    run: Staggered | Crossing,
    path: str | Path,
    line: RailLine | None = None,
    *,
    form: str = "csv",
    couples: bool | None = None,
    every: int = 1,
    instance: str = "",
) -> NodalLoads:
    """Write the load histories of the nodes to a file, in the axes and units of their model; return them.

    Parameters
    ----------
    run, line, couples
        See `nodal_loads`.
    path : str or Path
    form : {"csv", "abaqus"}
        ``csv``: first column ``t (s)``, then ``node 12 force_z (N)`` and so on, one column for each function that is not zero.
        ``abaqus``: an include file with an ``*AMPLITUDE`` for every function in step time, and ``*CLOAD`` lines that use them;
        CalculiX reads the same. The amplitudes stand above the first ``*STEP``, the loads inside it: two files,
        ``NAME.inp`` and ``NAME_loads.inp``.
    every : int
        Write every k-th instant only.
    instance : str
        Put before node numbers in the Abaqus files (``DECK-1.12`` for ``DECK-1``).

    Raises
    ------
    InputError
        No such folder, or a form that is not known.
    """
    inputs.choice("form", form, FORMATS)
    every = inputs.integer("every", every, least=1)
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError("path", path.name, "its folder does not exist", "Make the folder first")
    loads = nodal_loads(run, line, couples)
    thin = replace(loads, time=loads.time[::every], values=loads.values[:, :, ::every])
    if form == "csv":
        _write_csv(thin, path)
    else:
        _write_abaqus(thin, path, f"{instance}." if instance else "")
    return loads


def _write_csv(loads: NodalLoads, path: Path) -> None:
    unit = loads.of_model()[1]
    functions = list(loads.functions())
    units = [unit if c < 3 else f"{unit} {loads.line.units[0]}" for _, c, _ in functions]
    header = ["t (s)", *[f"node {n} {_COMPONENTS[c]} ({u})" for (n, c, _), u in zip(functions, units, strict=True)]]
    table = np.array([loads.time, *[f for _, _, f in functions]]).T
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerow(header)
        np.savetxt(file, table, fmt="%.9g", delimiter=",")


def _write_abaqus(loads: NodalLoads, path: Path, prefix: str) -> None:
    unit, (length, mass) = loads.of_model()[1], loads.line.units
    said = f"** railbridge: forces in {unit}, couples in {unit} {length}, for a model in {length}, {mass}, s\n"
    said += "** step time 0: the first axle is at the first node\n"
    amplitudes, cloads = [said], [said]
    for label, component, function in loads.functions():
        name = f"RB_{''.join(c if c.isalnum() else '_' for c in label)}_{component + 1}"
        amplitudes.append(f"*AMPLITUDE, NAME={name}\n{_pairs(loads.time, function)}")
        cloads.append(f"*CLOAD, AMPLITUDE={name}\n{prefix}{label}, {component + 1}, 1.0\n")
    path.write_text("".join(amplitudes), encoding="ascii", newline="\n")
    path.with_name(f"{path.stem}_loads{path.suffix}").write_text("".join(cloads), encoding="ascii", newline="\n")


def _pairs(time: np.ndarray, function: np.ndarray) -> str:
    """Return time and value in pairs, four pairs a line, zeros before and after the load left out but for one."""
    there = np.flatnonzero(function)
    first, last = max(there[0] - 1, 0), min(there[-1] + 2, len(time))
    pairs = [f"{t:.9g}, {f:.9g}" for t, f in zip(time[first:last], function[first:last], strict=True)]
    return "".join(", ".join(pairs[i : i + 4]) + "\n" for i in range(0, len(pairs), 4))
