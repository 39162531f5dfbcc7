r"""Modal models of other finite-element programs: read, checked, put under the rail, and written.

Two tables carry a model. ``nodes.csv``: node, x, y, z. ``modes.csv``: mode, frequency_hz, damping_ratio, node, ux, uy, uz, rx,
ry, rz, one line for each mode and node; modal_mass where shapes are not mass-normalised. Shapes become SI with

    translation / (u_m M)^(1/2),      rotation / (u_l (u_m M)^(1/2)),

u_l and u_m the units of length and mass in m and kg, M the modal mass (1 for mass-normalised shapes).

From nodes to the rail. A line of nodes carries the rail; at each of its places the deck axis moves

* with one node, as on a rigid arm: v = uy + z rx, w = uz - y rx, twist rx, for a node at (y, z) from the axis;
* with a left and a right node, as in solid and shell models: twist is the difference of uz over their distance, w lies on
  the straight line through both uz, v is the mean of uy moved by the twist.

A single line without rx makes the deck rigid in twist. Between the places v and w are cubic: Hermite's with w' = -ry and
v' = rz where a single line has rotations (those of the cross-section), otherwise splines through the displacements. Twist is a
parabola through places 1-2-3, 3-4-5 and so on (a last single piece takes the last three), or a spline from a pair of lines.
Only where the file of nodes says ``# pieces: cubic`` all three are cubics through places 1-2-3-4, 4-5-6-7 and so on; that
is how `export_modes` writes a deck, so that it comes back exactly.

Modes alone give no section forces, reactions or self-weight (`Deck.recovery` is None), and their sum lacks the static
flexibility of the modes left out.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from . import inputs
from .deck import Deck, PiecewiseCubic, rayleigh_ratio
from .inputs import InputError
from .nodes import (
    MASSES,
    PER_METRE,
    Columns,
    Nodes,
    RailLine,
    cubics,
    hermite,
    parabolas,
    read_columns,
    read_nodes,
    refuse_repeats,
    spline,
    stated_units,
)  # fmt: skip

__all__ = [
    "FILE_KEYS", "ModalModel", "Orthogonality", "beside", "deck_from_files", "deck_from_modes", "export_modes", "read_modes",
    "read_nodes", "stamps",
]  # fmt: skip

MODEL_KEYS = ("nodes", "modes", "masses", "units", "axes", "rail", "axis", "supports", "count", "unusual")
FILE_KEYS = ("modes", "damping", "tracks", "width", "track_height", "name", "source", "note")
"""Keys of a deck file that is made of modes."""

_PATHS = ("nodes", "modes", "masses")
_WORST_OVERLAP = 0.1
_LIKELY_MASS = 100.0, 300e3
"""Mass per metre of decks, kg/m: foot bridges to ballasted concrete with several tracks, with room to spare."""

# ---- modes


@dataclass(frozen=True)
class Orthogonality:
    """How far from orthogonal the modes of a model are.

    Attributes
    ----------
    worst : float
        Largest of abs(phi_i M phi_j) / sqrt((phi_i M phi_i) (phi_j M phi_j)); zero for exact modes.
    pair : tuple of str
        The modes it stands between.
    known_masses : bool
        Whether M is the model's, or equal masses at all nodes for want of them.
    own : ndarray, shape (m,)
        phi_i M phi_i, which is 1 for mass-normalised modes; NaN without masses.
    """

    worst: float
    pair: tuple[str, str]
    known_masses: bool
    own: np.ndarray


@dataclass(frozen=True, eq=False)
class ModalModel:
    """Natural modes of a finite-element model, SI, our axes.

    Attributes
    ----------
    nodes : Nodes
    frequencies_hz : ndarray, shape (m,)
        Ascending.
    damping_ratios : ndarray, shape (m,)
        NaN where the file gives none.
    labels : tuple of str
        The modes as the file calls them.
    names : tuple of str, or None
        Column ``name``.
    shapes : ndarray, shape (m, n, 6)
        Mass-normalised ux, uy, uz, rx, ry, rz (1/sqrt(kg), 1/(m sqrt(kg))); NaN at nodes that the modes leave out.
    rotations : tuple of bool
        Whether rx, ry, rz are known.
    masses : ndarray, shape (n, 4), or None
        Mass (kg) and inertia about x, y, z (kg m2) of every node.
    """

    nodes: Nodes
    frequencies_hz: np.ndarray
    damping_ratios: np.ndarray
    labels: tuple[str, ...]
    names: tuple[str, ...] | None
    shapes: np.ndarray
    rotations: tuple[bool, bool, bool]
    masses: np.ndarray | None = None

    def to_frame(self):
        """Return a pandas DataFrame with one row a mode."""
        import pandas as pd

        columns = {"frequency (Hz)": self.frequencies_hz, "damping ratio": self.damping_ratios}
        return pd.DataFrame(columns, index=pd.Index(self.labels, name="mode"))

    def orthogonality(self) -> Orthogonality:
        """Compare every two modes over the nodal masses, or over equal masses where none are known.

        Wrong when: without masses on meshes of uneven density, where true modes may overlap by tens of per cent.
        """
        there = np.isfinite(self.shapes[0, :, 0])
        masses = self.masses[there] if self.masses is not None else np.ones((there.sum(), 1)) * [1.0, 0.0, 0.0, 0.0]
        weights = np.sqrt(np.concatenate([np.repeat(masses[:, :1], 3, axis=1), masses[:, 1:]], axis=1))
        # Weighted by the roots first: small entries then do not vanish beside large ones.
        weighted = (self.shapes[:, there] * weights).reshape(len(self.labels), -1)
        gram = weighted @ weighted.T
        own = np.diag(gram).copy()
        # A mode of pure rotation where no inertia is known has nothing to compare.
        moving = own > (0.1 if self.masses is not None else 1e-12 * own.max())
        size = np.sqrt(np.where(moving, own, np.inf))
        overlap = np.abs(np.triu(gram / np.outer(size, size), 1))
        i, j = np.unravel_index(np.argmax(overlap), overlap.shape)
        known = self.masses is not None
        return Orthogonality(
            float(overlap[i, j]), (self.labels[i], self.labels[j]), known, own if known else np.full_like(own, np.nan)
        )


def read_modes(
    nodes: str | Path | Nodes,
    modes: str | Path,
    masses: str | Path | None = None,
    units: Sequence[str] | None = None,
    axes: Sequence[str] = ("x", "y", "z"),
) -> ModalModel:
    """Read a modal model of any finite-element program.

    Parameters
    ----------
    nodes, modes : str or Path
        See the module; rotations, ``damping_ratio``, ``modal_mass`` and ``name`` are optional columns.
    masses : str or Path, optional
        node, mass, and optionally inertia_x, inertia_y, inertia_z: then orthogonality is checked.
    units, axes
        See `read_nodes`.

    Raises
    ------
    InputError
        Nodes missing in a mode or given twice, a frequency that is not positive or not the same in all rows of a mode, or,
        with masses, modes that are not orthogonal (the worst pair is named) or not mass-normalised.
    """
    if not isinstance(nodes, Nodes):
        nodes = read_nodes(nodes, units, axes)
    shape_columns = ["ux", "uy", "uz"]
    rotation_columns = ["rx", "ry", "rz"]
    table = read_columns(
        modes,
        ["mode", "frequency_hz", "node", *shape_columns],
        ["damping_ratio", "modal_mass", "name", *rotation_columns],
    )
    length, mass = stated_units(table, units or nodes.units)
    if (length, mass) != nodes.units:
        raise InputError(f"{table.name}: units", [length, mass], f"the nodes are in {', '.join(nodes.units)}")
    place = {label: i for i, label in enumerate(nodes.labels)}
    order, rows = _rows_of_modes(table, place)
    frequencies = _same_in_mode(table, "frequency_hz", order, rows)
    for label, f in zip(order, frequencies, strict=True):
        remedy = "A mode of 0 Hz is a free body: hold the deck by its bearings"
        inputs.number(f"{table.name}: mode {label}: frequency_hz", f, above=1e-6, unit="Hz", remedy=remedy)
    damping = np.full(len(order), np.nan)
    if "damping_ratio" in table.cells and any(table.cells["damping_ratio"]):
        damping = _same_in_mode(table, "damping_ratio", order, rows)
        remedy = "Give 0.03 for 3 %"
        inputs.number(f"{table.name}: mode {order[0]}: damping_ratio", damping[0], least=0.0, most=0.5, remedy=remedy)
        inputs.numbers(f"{table.name}: damping_ratio", damping, least=0.0)
    modal_mass = np.ones(len(order))
    if "modal_mass" in table.cells:
        modal_mass = inputs.numbers(f"{table.name}: modal_mass", _same_in_mode(table, "modal_mass", order, rows), above=0.0)
    values = np.zeros((len(table.lines), 6))
    for i, column in enumerate([*shape_columns, *rotation_columns]):
        if column in table.cells:
            values[:, i] = table.numbers(column)
    # Programs with solid elements print rotations as zeros: none at all are none known.
    known = np.abs(values[:, 3:]).max(axis=0) > 0.0
    values = np.concatenate([values[:, :3] @ nodes.turn.T, values[:, 3:] @ nodes.turn.T * PER_METRE[length]], axis=1)
    shapes = np.full((len(order), len(nodes.labels), 6), np.nan)
    index = np.array([place[label] for label in table.labels("node")])
    for i, own in enumerate(rows):
        shapes[i, index[own]] = values[own] / np.sqrt(modal_mass[i] * MASSES[mass])
    ascending = np.argsort(frequencies, kind="stable")
    names = None
    if "name" in table.cells:
        names = tuple(table.cells["name"][rows[i][0]] for i in ascending)
    model = ModalModel(
        nodes,
        inputs.frozen(frequencies[ascending]),
        inputs.frozen(damping[ascending]),
        tuple(order[i] for i in ascending),
        names,
        inputs.frozen(shapes[ascending]),
        tuple(bool(k) for k in np.abs(nodes.turn) @ known > 0.5),
        None if masses is None else _read_masses(masses, nodes, shapes, units),
    )
    _refuse_overlap(model, table.name)
    return model


def _rows_of_modes(table: Columns, place: Mapping[str, int]) -> tuple[list[str], list[np.ndarray]]:
    """Return the modes in the file's order and the rows of each; every mode must have the same nodes, each once."""
    modes, nodes = table.labels("mode"), table.labels("node")
    rows: dict[str, list[int]] = {}
    for i, (mode, node) in enumerate(zip(modes, nodes, strict=True)):
        if node not in place:
            where = f"{table.name}: line {table.lines[i]}: node"
            raise InputError(where, node, "is not among the nodes", inputs.did_you_mean(node, place))
        rows.setdefault(mode, []).append(i)
    whole = set(nodes)
    for mode, own in rows.items():
        here = [nodes[i] for i in own]
        missing = sorted(whole - set(here), key=list(place).index)
        if missing:
            listed = ", ".join(missing[:5]) + (" ..." if len(missing) > 5 else "")
            allowed = f"lacks {len(missing)} of the nodes that other modes have: {listed}"
            raise InputError(f"{table.name}: mode {mode}", None, allowed, "Write every mode at the same nodes")
        if len(here) != len(whole):
            double = next(n for n in here if here.count(n) > 1)
            raise InputError(f"{table.name}: mode {mode}: node", double, "is given twice", "One line for each mode and node")
    return list(rows), [np.array(own) for own in rows.values()]


def _same_in_mode(table: Columns, column: str, order: list[str], rows: list[np.ndarray]) -> np.ndarray:
    """Return one value for each mode; all its rows must agree."""
    values = table.numbers(column)
    for mode, own in zip(order, rows, strict=True):
        if np.ptp(values[own]) > 1e-9 * np.abs(values[own]).max():
            pair = [float(values[own].min()), float(values[own].max())]
            raise InputError(f"{table.name}: mode {mode}: {column}", pair, "differs between rows of the same mode")
    return np.array([values[own[0]] for own in rows])


def _read_masses(path: str | Path, nodes: Nodes, shapes: np.ndarray, units: Sequence[str] | None) -> np.ndarray:
    inertias = ["inertia_x", "inertia_y", "inertia_z"]
    table = read_columns(path, ["node", "mass"], inertias)
    length, mass = stated_units(table, units or nodes.units)
    labels = table.labels("node")
    refuse_repeats(table, labels)
    place = {label: i for i, label in enumerate(nodes.labels)}
    result = np.zeros((len(nodes.labels), 4))
    for i, column in enumerate(["mass", *inertias]):
        if column in table.cells:
            factor = MASSES[mass] * (PER_METRE[length] ** -2 if i else 1.0)
            for label, value in zip(labels, table.numbers(column), strict=True):
                if label not in place:
                    raise InputError(f"{table.name}: node", label, "is not among the nodes", inputs.did_you_mean(label, place))
                result[place[label], i] = inputs.number(f"{table.name}: node {label}: {column}", value * factor, least=0.0)
    result[:, 1:] = result[:, 1:] @ np.abs(nodes.turn).T
    lost = result[~np.isfinite(shapes[0, :, 0]), 0].sum() / max(result[:, 0].sum(), 1e-30)
    if lost > 0.01:
        allowed = f"{lost:.0%} of the mass stands at nodes that the modes leave out, so orthogonality cannot be checked"
        raise InputError(table.name, None, allowed, "Write the modes at all nodes, or leave the masses out")
    return inputs.frozen(result)


def _refuse_overlap(model: ModalModel, name: str) -> None:
    """Refuse modes that are not orthogonal over the masses or not mass-normalised; without masses, a mode given twice."""
    found = model.orthogonality()
    i, j = (model.labels.index(label) for label in found.pair)
    pair = f"modes {found.pair[0]} and {found.pair[1]}"
    f1, f2 = model.frequencies_hz[[i, j]]
    if found.known_masses:
        if found.worst > _WORST_OVERLAP:
            allowed = f"{found.worst:.2g} of their mass products is shared, at most {_WORST_OVERLAP:g}: they are not orthogonal"
            raise InputError(f"{name}: {pair}", None, allowed, "Is a mode given twice, or are the masses of another model?")
        whole = found.own[found.own > 0.1]
        off = whole[np.argmax(np.abs(np.log(whole)))] if len(whole) else 0.0
        if not 0.5 < off < 2.0:
            allowed = f"phi M phi is {off:.3g} for a mode, must be about 1: not mass-normalised, or masses in another unit"
            raise InputError(name, None, allowed, "Add the column modal_mass, or correct the units")
        if abs(off - 1.0) > 0.1:
            warnings.warn(f"{name}: phi M phi of a mode is {off:.3g} over the given masses instead of 1.", stacklevel=3)
    elif found.worst > 0.9999 and abs(f1 - f2) < 1e-4 * f2:
        raise InputError(f"{name}: {pair}", None, "have one shape and one frequency: a mode is given twice", "Remove one")


# ---- the deck


def deck_from_modes(
    model: ModalModel,
    line: RailLine,
    name: str = "deck",
    damping: tuple[float, float] | float | None = None,
    *,
    count: int | None = None,
    tracks: Mapping[str, float] | None = None,
    width: float | None = None,
    track_height: float = 0.0,
    supports: Sequence[float] = (),
    unusual: bool = False,
) -> Deck:
    """Return the modal deck that a model makes under its rail line.

    Parameters
    ----------
    model : ModalModel
    line : RailLine
        From ``model.nodes.line(...)``.
    name : str
    damping : (alpha, beta) of Rayleigh, or one ratio, optional
        Instead of the file's own; needed where it has none.
    count : int, optional
        How many of the lowest modes that move the rail are kept; all if not given.
    tracks, width, track_height, supports
        See `Deck`; places of bearing lines in m from the first node are only drawn.
    unusual : bool
        Accept frequencies and masses beyond those of bridges.

    Raises
    ------
    InputError
        Rail nodes that the modes leave out, no damping, or a first frequency or mass per metre so far from those of bridges that
        the units must be wrong.
    """
    place = {label: i for i, label in enumerate(model.nodes.labels)}
    index = np.array([[place[label] for label in pair] for pair in line.labels])
    shapes = model.shapes[:, index]
    for i, j in np.argwhere(~np.isfinite(shapes[0, :, :, 0]))[:1]:
        raise InputError("rail", line.labels[i][j], "is a node of the rail that the modes leave out", "Write the modes there too")
    functions = _along(line, shapes, model.rotations)
    motion = _motion(functions)
    size = np.sum(motion**2, axis=-1)
    if not size.any():
        raise InputError("rail", None, "stands still in every mode", "Does it run along the deck's bearings?")
    moving = np.flatnonzero(np.sqrt(size.sum(axis=1) / size.sum(axis=1).max()) > 1e-6)
    kept = moving[: inputs.integer("modes.count", count, least=1, most=len(moving)) if count is not None else None]
    frequencies = model.frequencies_hz[kept]
    _refuse_units(line, supports, frequencies, size[kept], unusual)
    if model.masses is None:
        _warn_of_overlap(model, motion, kept)
    if damping is not None and np.isscalar(damping):
        ratios = np.full(len(kept), inputs.number("damping", damping, least=0.0, most=0.5))
    elif damping is not None:
        ratios = rayleigh_ratio(*inputs.numbers("damping", damping, count=2, least=0.0), frequencies)
    elif np.isfinite(model.damping_ratios).all():
        ratios = model.damping_ratios[kept]
    else:
        remedy = "Add the column damping_ratio to the modes, or damping = { modal = 0.01 } to the deck"
        raise InputError("damping", None, "is missing", remedy)
    return Deck(
        name=name,
        length=line.length,
        frequencies_hz=frequencies,
        damping_ratios=ratios,
        mode_names=_names(model, size, kept),
        shapes=PiecewiseCubic(functions.edges, functions.coefficients[:, :, kept]),
        supports=tuple(float(x) for x in supports),
        tracks=dict(tracks or {}),
        width=width,
        track_height=track_height,
    )


def _along(line: RailLine, shapes: np.ndarray, rotations: tuple[bool, bool, bool]) -> PiecewiseCubic:
    """Return the shapes along the deck axis from those of the line's nodes, shape (m, n, k, 6)."""
    _, uy, uz, rx, ry, rz = np.moveaxis(shapes, -1, 0)
    lateral, vertical, twist = line.axis_motion(uy, uz, rx)
    if line.cubic and len(line.x) % 3 == 1:
        return PiecewiseCubic(line.x[::3], np.stack([cubics(line.x, v) for v in (lateral, vertical, twist)], axis=-1))
    result = np.zeros((len(line.x) - 1, 4, len(shapes), 3))
    for c, value, slope, known, names in ((0, lateral, rz, rotations[2], "uy rz"), (1, vertical, -ry, rotations[1], "uz -ry")):
        if known and not line.paired and _agree(line.x, value, slope[..., 0], *names.split()):
            result[..., c] = hermite(line.x, value, slope[..., 0])
        else:
            _warn_of_few_nodes(value, names[:2])
            result[..., c] = spline(line.x, value)
    result[..., 2] = spline(line.x, twist) if line.paired else parabolas(line.x, twist)
    return PiecewiseCubic(line.x, result)


def _agree(x: np.ndarray, values: np.ndarray, slopes: np.ndarray, name: str, rotation: str) -> bool:
    """Whether rotations are slopes of the displacements, in the mode where they fit best; if not, warn and do without.

    Usual reasons: drilling rotations of shells, left-handed rotations, other units of the angle.
    """
    from_values = CubicSpline(x, values, axis=-1)(x, 1)
    size = np.linalg.norm(from_values, axis=1)
    bent = size > 1e-3 * size.max()
    misfit = np.linalg.norm(slopes - from_values, axis=1)[bent] / size[bent]
    if len(misfit) == 0 or misfit.min() < 0.2:
        return True
    warnings.warn(
        f"modes: {rotation} is not the slope of {name} along the rail (off by {misfit.min():.0%} at best), so slopes are taken "
        "from the displacements.",
        stacklevel=4,
    )
    return False


def _warn_of_few_nodes(values: np.ndarray, name: str) -> None:
    """Warn of modes with more than one change of sign in three nodes: a spline cannot follow them."""
    large = np.abs(values) > 1e-3 * np.abs(values).max()
    changes = [(np.diff(np.sign(v[use])) != 0).sum() for v, use in zip(values, large, strict=True)]
    if max(changes) > values.shape[1] / 3:
        mode = int(np.argmax(changes)) + 1
        warnings.warn(
            f"modes: the {values.shape[1]} nodes of the rail are few for {name} of mode {mode}, which changes sign "
            f"{max(changes)} times. Use a finer line, fewer modes, or write rotations too.",
            stacklevel=4,
        )


def _motion(functions: PiecewiseCubic) -> np.ndarray:
    """Return v, w and 1.5 m twist at points along the rail, shape (m, 3, points), times the root of each point's length.

    Sums of products over the points are then integrals along the deck.
    """
    points, weights = np.polynomial.legendre.leggauss(4)
    h = np.diff(functions.edges)
    x = (functions.edges[:-1, None] + h[:, None] * (points + 1) / 2).ravel()
    values = functions(x) * [1.0, 1.0, 1.5]
    return np.moveaxis(values * np.sqrt((h[:, None] * weights / 2).ravel())[:, None, None], 0, -1)


def _warn_of_overlap(model: ModalModel, motion: np.ndarray, kept: np.ndarray) -> None:
    """Warn of modes that look alike along the rail, as over a uniform deck: without masses nobody can say more.

    Only modes of the whole deck that hardly twist are compared, those with as much mass at the rail as the first of them: at a
    rail off the shear centre twist looks like bending, and local modes may look like anything.
    """
    size = np.sum(motion[kept] ** 2, axis=-1)
    whole = size.sum(axis=1)
    calm = size[:, 2] < 0.1 * whole
    bending = kept[calm & (np.abs(np.log2(whole / whole[np.argmax(calm)])) < 1.0)]
    flat = motion[bending].reshape(len(bending), -1)
    flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    overlap = np.abs(np.triu(flat @ flat.T, 1))
    if overlap.max(initial=0.0) > 0.3:
        i, j = np.unravel_index(np.argmax(overlap), overlap.shape)
        pair = f"modes {model.labels[bending[i]]} and {model.labels[bending[j]]}"
        warnings.warn(
            f"modes: {pair} overlap by {overlap[i, j]:.2f} along the rail of a uniform deck. Give the nodal masses to have "
            "their orthogonality checked.",
            stacklevel=3,
        )


def _names(model: ModalModel, size: np.ndarray, kept: np.ndarray) -> tuple[str, ...]:
    """Return the model's names, or name modes by their largest motion along the rail."""
    if model.names is not None:
        return tuple(model.names[i] for i in kept)
    seen, names = {}, []
    for i in kept:
        label = ("lateral", "vertical", "torsion")[int(np.argmax(size[i]))]
        seen[label] = seen.get(label, 0) + 1
        names.append(f"{label} {seen[label]}")
    return tuple(names)


def _refuse_units(line: RailLine, supports: Sequence[float], frequencies: np.ndarray, size: np.ndarray, unusual: bool) -> None:
    """Refuse a first frequency or a mass per metre beyond those of bridges by orders of magnitude.

    First frequencies of simple spans L (m) lie between 80 / L (to 20 m) or 23.58 L^-0.592 and 94.76 L^-0.748 Hz (EN 1991-2,
    6.4.4). A mass-normalised mode in which the deck moves as a whole has an integral of phi^2 of about 1 / mass per metre.
    """
    span = float(np.max(np.diff(np.sort(supports)))) if len(supports) > 1 else line.length
    low, high = (80 / span if span <= 20 else 23.58 * span**-0.592), 94.76 * span**-0.748
    low, high = min(low, high), max(low, high)
    first = float(frequencies[0])
    off = max(low / first, first / high)
    usual = f"bridges of {span:.3g} m have about {low:.2g} to {high:.2g} Hz"
    if off > 10 and not unusual:
        allowed = f"lies an order of magnitude away: {usual}"
        remedy = "Check the units of length (mm or m?) and of frequency (Hz, not rad/s); unusual = true if the deck is so"
        raise InputError("modes: first frequency", first, allowed, remedy)
    if off > 3 and not unusual:
        warnings.warn(f"modes: first frequency {first:.3g} Hz: {usual}. Are the units right (rad/s?)", stacklevel=4)
    vertical = np.flatnonzero(np.argmax(size, axis=1) == 1)
    mass = 1.0 / size[vertical[0], 1] if len(vertical) else 1.0 / size[0].max()
    if not _LIKELY_MASS[0] < mass < _LIKELY_MASS[1] and not unusual:
        allowed = f"make the deck {mass:.3g} kg per metre, bridges have {_LIKELY_MASS[0]:g} to {_LIKELY_MASS[1]:g}"
        remedy = "Check the unit of mass (kg or t?); shapes scaled to a largest value of 1 need the column modal_mass"
        raise InputError("modes: shapes", None, allowed, remedy)


# ---- deck files


def beside(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Make the paths of a modal deck file, which are relative to it, paths that can be opened from here."""
    own = content.get("modes")
    if not isinstance(own, dict):
        return content
    opened = {k: str(folder / v) if k in _PATHS and isinstance(v, str) else v for k, v in own.items()}
    return {**content, "modes": opened}


def stamps(content: Mapping[str, Any]) -> list[int]:
    """Return times and sizes of the files of a modal deck file: what is kept of them is out of date when these change."""
    own = content.get("modes")
    paths = [Path(own[k]) for k in _PATHS if isinstance(own.get(k), str)] if isinstance(own, Mapping) else []
    found = [path.stat() for path in paths if path.is_file()]
    return [n for s in found for n in (s.st_mtime_ns, s.st_size)]


def deck_from_files(where: str, content: Mapping[str, Any], damping: tuple[float, float] | float | None, **own: Any) -> Deck:
    """Build the deck of a deck file's ``modes`` table.

    Parameters
    ----------
    where : str
        For messages.
    content : mapping
        ``nodes``, ``modes`` (paths), and optionally ``masses``, ``units``, ``axes``, ``rail``, ``axis``, ``supports``,
        ``count``, ``unusual``.
    damping, own
        See `deck_from_modes`.
    """
    inputs.keys(f"{where}: modes", content, MODEL_KEYS, ["nodes", "modes"])
    with inputs.within(f"{where}: modes"):
        paths = {k: inputs.text(k, content[k]) for k in _PATHS if k in content}
        options = {k: content[k] for k in ("units", "axes") if k in content}
        model = read_modes(**paths, **options)
        line = model.nodes.line(content.get("rail"), content.get("axis"))
        unusual = inputs.boolean("unusual", content.get("unusual", False))
        supports = inputs.numbers("supports", content.get("supports", ()), least=0.0, most=line.length, unit="m").tolist()
        own.update(supports=supports, count=content.get("count"), unusual=unusual)
        return deck_from_modes(model, line, damping=damping, **own)


def export_modes(deck: Deck, folder: str | Path, units: tuple[str, str] = ("m", "kg")) -> Path:
    """Write a deck's modes as ``nodes.csv``, ``modes.csv`` and the ``deck.toml`` that reads them back; return the last.

    Nodes stand at the ends and thirds of every piece of the shapes, and the file of nodes says so (``# pieces: cubic``): a
    cubic through four nodes is then the shape itself, whatever made the deck. Rotations are written for other readers: ``ry`` and
    ``rz`` are the slopes, mean values where these jump. ``ux`` is zero: a deck knows no motion along the track.
    """
    folder = Path(folder)
    per_metre, mass = PER_METRE[units[0]], math.sqrt(MASSES[units[1]])
    edges = deck.shapes.edges
    x = np.concatenate([(edges[:-1, None] + np.diff(edges)[:, None] * [0.0, 1 / 3, 2 / 3]).ravel(), edges[-1:]])
    value, slope = deck.shapes(x), deck.shapes(x, 1)
    slope[3:-1:3] = (slope[3:-1:3] + deck.shapes(np.nextafter(edges[1:-1], 0.0), 1)) / 2
    columns = np.zeros((len(x), len(deck.frequencies_hz), 6))
    columns[..., 1:3], columns[..., 3] = value[..., :2] * mass, value[..., 2] * mass / per_metre
    columns[..., 4], columns[..., 5] = -slope[..., 1] * mass / per_metre, slope[..., 0] * mass / per_metre
    head = f"# units: {units[0]}, {units[1]}\n"
    nodes = [f"{i},{_text(place * per_metre)},0,0\n" for i, place in enumerate(x, start=1)]
    rows = []
    for m, (f, ratio, name) in enumerate(zip(deck.frequencies_hz, deck.damping_ratios, deck.mode_names, strict=True)):
        start = f"{m + 1},{_text(f)},{_text(ratio)},{name},"
        rows += [f"{start}{i},{','.join(map(_text, row))}\n" for i, row in enumerate(columns[:, m], start=1)]
    toml = [f"name = {json.dumps(deck.name)}\n", 'note = "modes only: no section forces, reactions or self-weight"\n']
    toml += [f"width = {_text(deck.width)}\n"] if deck.width else []
    toml += [f"track_height = {_text(deck.track_height)}\n"] if deck.track_height else []
    toml += ["\n[modes]\n", 'nodes = "nodes.csv"\n', 'modes = "modes.csv"\n', "unusual = true\n"]
    toml += [f"supports = [{', '.join(map(_text, deck.supports))}]\n"] if deck.supports else []
    toml += ["\n[tracks]\n", *[f"{json.dumps(k)} = {_text(y)}\n" for k, y in deck.tracks.items()]] if deck.tracks else []
    header = "mode,frequency_hz,damping_ratio,name,node,ux,uy,uz,rx,ry,rz\n"
    files = {
        "nodes.csv": [head, "# pieces: cubic\n", "node,x,y,z\n", *nodes],
        "modes.csv": [head, header, *rows],
        "deck.toml": toml,
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text("".join(text), encoding="utf-8", newline="\n")
    return folder / "deck.toml"


def _text(value: float) -> str:
    """Return a number with all its digits."""
    return repr(float(value))
