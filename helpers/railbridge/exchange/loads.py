r"""Loads of a crossing on the nodes of another program's model: time functions, and files of them.

A load at x between two nodes acts through the shapes that a beam element has there. With couples
(beam models) these are Hermite's cubics, so that the nodes' forces and couples do the same work on
the element as the load itself; without (solid and shell models) forces follow the lever rule. Both
are statically equivalent: same force, same moment, at every instant. The moment about x of loads
off the axis goes with the lever rule as a couple, or as a pair of forces where a left and a right
line of nodes carry the rail. A deck's rail spreads a load first.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from .. import errors
from ..coupling import Coupling
from ..errors import InputError, brief
from ..guideways import PiecewiseCubic
from ..settings import refuse_bytes
from ..units import factor_of, per_metre
from .nodes import RailLine

__all__ = ["FORMATS", "NodalLoads", "export_loads", "nodal_loads"]

FORMATS = ("csv", "abaqus")
_COMPONENTS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
_COPIES = 4
"""Of all loads, that stand in memory together while they are moved to the nodes."""
_FORCE_UNITS = {("m", "kg"): "N", ("mm", "t"): "N", ("m", "t"): "kN", ("ft", "slug"): "lbf"}
"""Names of the unit of force of consistent sets, by their units of length and mass."""


class Run(Protocol):
    """A crossing, or a run in two programs: what its loads are made of.

    Attributes
    ----------
    coupling : Coupling
    passes : sequence
        Wheel forces of every pass, each as `Coupling.station_loads` takes them.
    iteration : int
        The pass whose loads are wanted.
    """

    coupling: Coupling
    passes: Sequence[Any]
    iteration: int


@dataclass(frozen=True, eq=False)
class NodalLoads:
    """Time functions of the loads on the nodes of a line.

    Attributes
    ----------
    line : RailLine
    time : ndarray, shape (t,)
        s.
    values : ndarray, shape (nodes, 6, t)
        force_x, force_y, force_z (N), moment_x, moment_y, moment_z (N m) on the deck, in our axes;
        nodes as in ``line.nodes``.
    """

    __repr__ = brief

    line: RailLine
    time: np.ndarray
    values: np.ndarray

    def component(self, name: str) -> np.ndarray:
        """Return one component of the loads on all nodes, N or N m, shape (nodes, t).

        Parameters
        ----------
        name : str
            ``force_z``, for instance: one of those listed at `values`.
        """
        return self.values[:, _COMPONENTS.index(errors.choice("name", name, _COMPONENTS))]

    def of_model(self) -> tuple[np.ndarray, str]:
        """Return the loads in the axes and units of the model, and the name of its unit of force.

        Moments are in that unit times the model's unit of length.
        """
        length, mass = self.line.units
        # A consistent set has mass times length per second squared as its force.
        force = per_metre(length) / factor_of("units[2]", mass, "mass")
        turn = self.line.turn
        forces = np.einsum("ji,njt->nit", turn, self.values[:, :3]) * force
        couples = np.einsum("ji,njt->nit", turn, self.values[:, 3:]) * force * per_metre(length)
        # Masses named after a force, as lbf s2/in, are those of a set in which it is the unit.
        usual = mass.removesuffix(f" s2/{length}") if mass.endswith(f" s2/{length}") else None
        name = usual or _FORCE_UNITS.get((length, mass), f"{mass} {length}/s2")
        return np.concatenate([forces, couples], axis=1), name

    def functions(self) -> Iterator[tuple[str, int, np.ndarray]]:
        """Yield node, component (0 to 5) and time function of every function that is not zero.

        In the model's axes and units.
        """
        values, _ = self.of_model()
        least = 1e-12 * np.abs(values).max(initial=0.0)
        for label, own in zip(self.line.nodes, values, strict=True):
            for component, function in enumerate(own):
                if np.abs(function).max(initial=0.0) > least:
                    yield label, component, function


def nodal_loads(run: Run, line: RailLine | None = None, couples: bool | None = None) -> NodalLoads:
    """Return the loads of a crossing on the nodes of a line.

    They are statically equivalent at every instant.

    Parameters
    ----------
    run : Staggered or Crossing
        The loads are those of the pass shown, the moving weight of the train included, the deck's
        own weight not.
    line : RailLine, optional
        Where they go; needed for a `Crossing`, whose deck must be as long.
    couples : bool, optional
        Whether nodes can take couples; default for a single line, not for a left and a right one.

    Raises
    ------
    InputError
        No line, or one of another length than the deck.
    """
    # Only a staggered run knows its nodes.
    line = getattr(run, "line", None) if line is None else line
    if line is None:
        remedy = "Give the nodes: read_nodes('nodes.csv').line()"
        raise InputError("line", None, "is missing", remedy)
    coupling = run.coupling
    if abs(line.length - coupling.deck.length) > 1e-4 * line.length:
        allowed = f"must be as long as the deck, {coupling.deck.length:g} m"
        raise InputError("line", line.length, allowed, "Choose nodes from end to end of the deck")
    couples = not line.paired if couples is None else errors.boolean("couples", couples)
    count, samples = len(line.nodes), len(coupling.time)
    needed = 8.0 * _COPIES * 6 * count * samples
    remedy = "Use a coarser line, a larger time step or a shorter tail"
    refuse_bytes("line", count, needed, f"loads of so many nodes at {samples} instants", remedy)
    axis = np.zeros((len(line.x), 5, len(coupling.time)))
    loads = coupling.station_loads(run.passes[run.iteration])
    reach, shares = coupling.deck.reach, None
    if coupling.deck.rail is not None:
        shares = coupling.deck.under_rail(_shares(line.x, couples))
    for delay, start, load in zip(coupling.load_delays, coupling.loads.starts, loads, strict=True):
        samples = np.arange(start, start + load.shape[1])
        x = coupling.settings.speed * coupling.time[samples] - delay
        x = np.clip(x, -reach, line.length + reach)
        if shares is None:
            _distribute(axis, line.x, x, samples, load, couples)
        else:
            _distribute_by_rail(axis, shares, x, samples, load)
    return NodalLoads(line, coupling.time, _to_nodes(line, axis))


def _shares(nodes: np.ndarray, couples: bool) -> PiecewiseCubic:
    """Return what nodes take of a load between them: functions of its place, three of each node.

    Of a force, of a couple about the axis, and, with `couples`, of a force by the node's couple.
    """
    count, h = len(nodes), np.diff(nodes)
    functions = np.zeros((count - 1, 4, count, 3))
    e = np.arange(count - 1)
    linear = np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])
    moved = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 0.0, 3.0, -2.0]])
    turned = np.array([[0.0, 1.0, -2.0, 1.0], [0.0, 0.0, -1.0, 1.0]])
    for i in (0, 1):
        functions[e, :, e + i, 0] = moved[i] if couples else linear[i]
        functions[e, :, e + i, 1] = linear[i]
        if couples:
            functions[e, :, e + i, 2] = h[:, None] * turned[i]
    return PiecewiseCubic(nodes, functions)


def _distribute_by_rail(
    axis: np.ndarray, shares: PiecewiseCubic, x: np.ndarray, samples: np.ndarray, load: np.ndarray
) -> None:
    """Add one moving load that a rail spreads, as `_distribute` does without."""
    load = np.concatenate([load, np.zeros((5 - len(load), load.shape[1]))])
    force_y, force_z, moment_x, moment_y, moment_z = load
    force, twist, turn = shares(x).T
    by_force, _, by_turn = shares(x, 1).T
    # A couple does work on the slope: M_y on -w', M_z on v'.
    axis[:, 0, samples] += force * force_y + by_force * moment_z
    axis[:, 1, samples] += force * force_z - by_force * moment_y
    axis[:, 2, samples] += twist * moment_x
    axis[:, 3, samples] += -turn * force_z + by_turn * moment_y
    axis[:, 4, samples] += turn * force_y + by_turn * moment_z


def _distribute(
    axis: np.ndarray,
    nodes: np.ndarray,
    x: np.ndarray,
    samples: np.ndarray,
    load: np.ndarray,
    couples: bool,
) -> None:
    """Add one moving load, shape (3 or 5, count), to the loads at the axis, shape (n, 5, t)."""
    load = np.concatenate([load, np.zeros((5 - len(load), load.shape[1]))])
    force_y, force_z, moment_x, moment_y, moment_z = load
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
        # Hermite's cubics for a displacement and for a slope of each end, and their derivatives.
        moved = 1 - 3 * s**2 + 2 * s**3, 3 * s**2 - 2 * s**3
        turned = h * (s - 2 * s**2 + s**3), h * (s**3 - s**2)
        rise = (6 * s**2 - 6 * s) / h
        moved_rate, turned_rate = (rise, -rise), (1 - 4 * s + 3 * s**2, 3 * s**2 - 2 * s)
        for i, node in enumerate((e, e + 1)):
            axis[node, 0, samples] += moved[i] * force_y + moved_rate[i] * moment_z
            axis[node, 1, samples] += moved[i] * force_z - moved_rate[i] * moment_y
            axis[node, 3, samples] += -turned[i] * force_z + turned_rate[i] * moment_y
            axis[node, 4, samples] += turned[i] * force_y + turned_rate[i] * moment_z


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
            halves = [force_y / 2, vertical, 0.0 * force_y, moment_y / 2, moment_z / 2]
            result[:, i, 1:] = np.stack(halves, axis=1)
    else:
        moment_x = moment_x - line.y * force_z
        result[:, 0, 1:] = np.stack([force_y, force_z, moment_x, moment_y, moment_z], axis=1)
    return result.reshape(-1, 6, axis.shape[-1])


def export_loads(
    run: Run,
    path: str | Path,
    line: RailLine | None = None,
    *,
    form: str = "csv",
    couples: bool | None = None,
    every: int = 1,
    instance: str = "",
) -> NodalLoads:
    """Write the load histories of the nodes to a file, and return them.

    The file is in the axes and units of the model, what is returned in ours.

    Parameters
    ----------
    run, line, couples
        See `nodal_loads`.
    path : str or Path
    form : {"csv", "abaqus"}
        ``csv``: first column ``t (s)``, then ``node 12 force_z (N)`` and so on, one column for each
        function that is not zero. ``abaqus``: an include file with an ``*AMPLITUDE`` for every
        function in step time, and ``*CLOAD`` lines that use them; CalculiX reads the same. The
        amplitudes stand above the first ``*STEP``, the loads inside it: two files, ``NAME.inp`` and
        ``NAME_loads.inp``. Where a rail makes the record begin before t = 0, step time begins with
        it; the first lines say when the first axle comes.
    every : int
        Write every k-th instant only.
    instance : str
        Put before node numbers in the Abaqus files (``DECK-1.12`` for ``DECK-1``).

    Raises
    ------
    InputError
        No such folder, or a form that is not known.
    """
    errors.choice("form", form, FORMATS)
    every = errors.integer("every", every, least=1)
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
    header = ["t (s)"]
    for node, component, _ in functions:
        own = unit if component < 3 else f"{unit} {loads.line.units[0]}"
        header.append(f"node {node} {_COMPONENTS[component]} ({own})")
    table = np.array([loads.time, *[f for _, _, f in functions]]).T
    with path.open("w", encoding="utf-8", errors="replace", newline="") as file:
        csv.writer(file, lineterminator="\n").writerow(header)
        np.savetxt(file, table, fmt="%.9g", delimiter=",")


def _write_abaqus(loads: NodalLoads, path: Path, prefix: str) -> None:
    unit, (length, mass) = loads.of_model()[1], loads.line.units
    head = f"** railbridge: forces in {unit}, couples in {unit} {length}"
    head += f", for a model in {length}, {mass}, s\n"
    # A step begins at 0, a record on a deck with a rail before the first axle is there.
    late = max(0.0, -float(loads.time[0]))
    head += f"** step time {late:.9g}: the first axle is at the first node\n"
    amplitudes, cloads = [head], [head]
    for label, component, function in loads.functions():
        if re.fullmatch(r"[!-~]+", prefix + label) is None or "," in prefix + label:
            allowed = "cannot name a node in an Abaqus file"
            raise InputError("line", prefix + label, allowed, "Use form = 'csv', or node numbers")
        name = f"RB_{re.sub('[^A-Za-z0-9]', '_', label)}_{component + 1}"
        amplitudes.append(f"*AMPLITUDE, NAME={name}\n{_pairs(loads.time + late, function)}")
        cloads.append(f"*CLOAD, AMPLITUDE={name}\n{prefix}{label}, {component + 1}, 1.0\n")
    other = path.with_name(f"{path.stem}_loads{path.suffix}")
    for file, lines in ((path, amplitudes), (other, cloads)):
        file.write_text("".join(lines), encoding="ascii", newline="\n")


def _pairs(time: np.ndarray, function: np.ndarray) -> str:
    """Return time and value in pairs, four pairs a line.

    Zeros before and after the load are left out but for one.
    """
    loaded = np.flatnonzero(function)
    own = slice(max(loaded[0] - 1, 0), min(loaded[-1] + 2, len(time)))
    pairs = [f"{t:.9g}, {f:.9g}" for t, f in zip(time[own], function[own], strict=True)]
    return "".join(", ".join(pairs[i : i + 4]) + "\n" for i in range(0, len(pairs), 4))
