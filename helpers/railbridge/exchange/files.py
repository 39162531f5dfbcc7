r"""Files of modal models: tables of nodes and modes of other programs in, a deck's modes out, and the deck files around them.

Two tables carry a model. ``nodes.csv``: node, x, y, z. ``modes.csv``: mode, frequency_hz, damping_ratio, node, ux, uy, uz, rx,
ry, rz, one line for each mode and node; modal_mass where shapes are not mass-normalised. Shapes become SI with

    translation / (u_m M)^(1/2),      rotation / (u_l (u_m M)^(1/2)),

u_l and u_m the units of length and mass in m and kg, M the modal mass (1 for mass-normalised shapes). What becomes of them
under the rail is in `modal`.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import errors
from ..decks import Deck
from ..errors import InputError
from .modal import ModalModel, Orthogonality, deck_from_modes
from .nodes import MASSES, PER_METRE, Columns, Nodes, RailLine, read_columns, read_nodes, refuse_repeats, stated_units

__all__ = [
    "FILE_KEYS", "ModalModel", "Nodes", "Orthogonality", "RailLine", "beside", "deck_from_files", "deck_from_modes",
    "export_modes", "read_modes", "read_nodes", "stamps",
]  # fmt: skip

MODEL_KEYS = ("nodes", "modes", "masses", "units", "axes", "rail", "axis", "supports", "count", "unusual")
FILE_KEYS = ("modes", "damping", "tracks", "width", "track_height", "name", "source", "note")
"""Keys of a deck file that is made of modes."""

_PATHS = ("nodes", "modes", "masses")
_WORST_OVERLAP = 0.1

# ---- modes in


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
        errors.number(f"{table.name}: mode {label}: frequency_hz", f, above=1e-6, unit="Hz", remedy=remedy)
    damping = np.full(len(order), np.nan)
    if "damping_ratio" in table.cells and any(table.cells["damping_ratio"]):
        damping = _same_in_mode(table, "damping_ratio", order, rows)
        remedy = "Give 0.03 for 3 %"
        errors.number(f"{table.name}: mode {order[0]}: damping_ratio", damping[0], least=0.0, most=0.5, remedy=remedy)
        errors.numbers(f"{table.name}: damping_ratio", damping, least=0.0)
    modal_mass = np.ones(len(order))
    if "modal_mass" in table.cells:
        modal_mass = errors.numbers(f"{table.name}: modal_mass", _same_in_mode(table, "modal_mass", order, rows), above=0.0)
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
        errors.frozen(frequencies[ascending]),
        errors.frozen(damping[ascending]),
        tuple(order[i] for i in ascending),
        names,
        errors.frozen(shapes[ascending]),
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
            raise InputError(where, node, "is not among the nodes", errors.did_you_mean(node, place))
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
                    raise InputError(f"{table.name}: node", label, "is not among the nodes", errors.did_you_mean(label, place))
                result[place[label], i] = errors.number(f"{table.name}: node {label}: {column}", value * factor, least=0.0)
    result[:, 1:] = result[:, 1:] @ np.abs(nodes.turn).T
    lost = result[~np.isfinite(shapes[0, :, 0]), 0].sum() / max(result[:, 0].sum(), 1e-30)
    if lost > 0.01:
        allowed = f"{lost:.0%} of the mass stands at nodes that the modes leave out, so orthogonality cannot be checked"
        raise InputError(table.name, None, allowed, "Write the modes at all nodes, or leave the masses out")
    return errors.frozen(result)


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


# ---- deck files and modes out


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
    errors.keys(f"{where}: modes", content, MODEL_KEYS, ["nodes", "modes"])
    with errors.within(f"{where}: modes"):
        paths = {k: errors.text(k, content[k]) for k in _PATHS if k in content}
        options = {k: content[k] for k in ("units", "axes") if k in content}
        model = read_modes(**paths, **options)
        line = model.nodes.line(content.get("rail"), content.get("axis"))
        unusual = errors.boolean("unusual", content.get("unusual", False))
        supports = errors.numbers("supports", content.get("supports", ()), least=0.0, most=line.length, unit="m").tolist()
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
