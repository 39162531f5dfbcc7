r"""Files of modal models: tables of nodes and modes of other programs in, a deck's modes out.

Two tables carry a model. ``nodes.csv``: node, x, y, z. ``modes.csv``: mode, frequency_hz,
damping_ratio, node, ux, uy, uz, rx, ry, rz, one line for each mode and node; modal_mass where
shapes are not mass-normalised. Shapes become SI with

    translation / (u_m M)^(1/2),      rotation / (u_l (u_m M)^(1/2)),

u_l and u_m the units of length and mass in m and kg, M the modal mass (1 for mass-normalised
shapes). What becomes of them under the rail is in `modal`.
"""

from __future__ import annotations

import math
import re
import warnings
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import errors
from ..decks import Deck
from ..errors import InputError, within
from ..settings import refuse_bytes
from ..units import factor_of, per_metre
from .modal import ModalModel
from .nodes import ModelAxis, Nodes, model_units, read_nodes, stated_units
from .tables import Columns, read_columns

__all__ = ["export_modes", "read_modes"]

_SHAPES = ("ux", "uy", "uz", "rx", "ry", "rz")
_INERTIAS = ("inertia_x", "inertia_y", "inertia_z")
_WORST_OVERLAP = 0.1
_COPIES = 4
"""Of all shapes, that stand in memory together while modes are checked."""

# ---- modes in


def read_modes(
    nodes: str | Path | Nodes,
    modes: str | Path,
    masses: str | Path | None = None,
    units: Sequence[str] | None = None,
    axes: Sequence[ModelAxis] = ("x", "y", "z"),
) -> ModalModel:
    """Read a modal model of any finite-element program.

    Parameters
    ----------
    nodes, modes : str or Path
        See the module; rotations, ``damping_ratio``, ``modal_mass`` and ``name`` are optional
        columns.
    masses : str or Path, optional
        node, mass, and optionally inertia_x, inertia_y, inertia_z: then orthogonality is checked.
    units, axes
        See `read_nodes`.

    Raises
    ------
    InputError
        Nodes missing in a mode or given twice, a frequency that is not positive or not the same in
        all rows of a mode, or, with masses, modes that are not orthogonal (the worst pair is named)
        or not mass-normalised.
    """
    if not isinstance(nodes, Nodes):
        with within(names={"path": "nodes"}):
            nodes = read_nodes(nodes, units, axes)
    with within(names={"path": "modes"}):
        required = ["mode", "frequency_hz", "node", *_SHAPES[:3]]
        table = read_columns(modes, required, ["damping_ratio", "modal_mass", "name", *_SHAPES[3:]])
    length, mass = _units_of(table, units, nodes)
    place = {label: i for i, label in enumerate(nodes.labels)}
    with within(source=table.name):
        order, rows = _rows_of_modes(table, place)
        remedy = "A mode of 0 Hz is a free body: hold the deck by its bearings"
        limits = {"above": 1e-6, "unit": "Hz", "remedy": remedy}
        frequencies = _same_in_mode(table, "frequency_hz", order, rows, **limits)
        damping = np.full(len(order), np.nan)
        if any(table.cells.get("damping_ratio", [])):
            damping = _same_in_mode(table, "damping_ratio", order, rows, least=0.0)
            first, remedy = f"mode {order[0]}: damping_ratio", "Give 0.03 for 3 %"
            errors.number(first, damping[0], least=0.0, most=0.5, remedy=remedy)
        modal_mass = np.ones(len(order))
        if "modal_mass" in table.cells:
            modal_mass = _same_in_mode(table, "modal_mass", order, rows, above=0.0)
        values, known = _values(table, nodes.turn, per_metre(length))
    _refuse_size(len(order), len(nodes.labels), table.name)
    shapes = np.full((len(order), len(nodes.labels), 6), np.nan)
    index = np.array([place[label] for label in table.labels("node")])
    masses_si = modal_mass * factor_of("units[2]", mass, "mass")
    for i, own in enumerate(rows):
        shapes[i, index[own]] = values[own] / np.sqrt(masses_si[i])
    nodal = None
    if masses is not None:
        with within(names={"path": "masses"}):
            nodal = _read_masses(masses, nodes, shapes, units)
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
        nodal,
    )
    with within(source=table.name):
        _refuse_overlap(model, table.name)
    return model


def _refuse_size(modes: int, nodes: int, name: str) -> None:
    """Refuse shapes that would not fit into memory: a few nodes of very many in many modes, say."""
    needed = 8.0 * (_COPIES * 6 * modes * nodes + 3 * modes**2)
    remedy = "Write fewer modes, and only the nodes of the deck that they move"
    refuse_bytes("modes", None, needed, f"{modes} modes at {nodes} nodes", remedy, name)


def _units_of(table: Columns, units: Sequence[str] | None, nodes: Nodes) -> tuple[str, str]:
    """Return the units of a table, which must be those of the nodes."""
    if table.units is None and units is None:
        return nodes.units
    found = stated_units(table, units)
    if found != nodes.units:
        allowed = f"the nodes are in {', '.join(nodes.units)}"
        remedy = "Write all tables in one set of units, or correct what they say"
        raise InputError("units", list(found), allowed, remedy, table.name)
    return found


def _rows_of_modes(table: Columns, place: Mapping[str, int]) -> tuple[list[str], list[np.ndarray]]:
    """Return the modes in the file's order and the rows of each.

    Every mode must have the same nodes, each once.
    """
    modes, nodes = table.labels("mode"), table.labels("node")
    rows: dict[str, list[int]] = {}
    for i, (mode, node) in enumerate(zip(modes, nodes, strict=True)):
        if node not in place:
            near = errors.did_you_mean(node, place)
            raise InputError(f"line {table.lines[i]}: node", node, "is not among the nodes", near)
        rows.setdefault(mode, []).append(i)
    whole = set(nodes)
    for mode, own in rows.items():
        found = [nodes[i] for i in own]
        missing = sorted(whole - set(found), key=place.__getitem__)
        if missing:
            listed = ", ".join(missing[:5]) + (" ..." if len(missing) > 5 else "")
            allowed = f"lacks {len(missing)} of the nodes that other modes have: {listed}"
            raise InputError(f"mode {mode}", None, allowed, "Write every mode at the same nodes")
        if len(found) != len(whole):
            double = Counter(found).most_common(1)[0][0]
            remedy = "One line for each mode and node"
            raise InputError(f"mode {mode}: node", double, "is given twice", remedy)
    return list(rows), [np.array(own) for own in rows.values()]


def _same_in_mode(
    table: Columns, column: str, order: list[str], rows: list[np.ndarray], **limits: Any
) -> np.ndarray:
    """Return one value for each mode, within limits; all its rows must agree."""
    values = table.numbers(column)
    for mode, own in zip(order, rows, strict=True):
        if np.ptp(values[own]) > 1e-9 * np.abs(values[own]).max():
            pair = [float(values[own].min()), float(values[own].max())]
            allowed = "differs between rows of the same mode"
            raise InputError(f"mode {mode}: {column}", pair, allowed, "Write one value in all")
    result = np.array([values[own[0]] for own in rows])
    for mode, value in zip(order, result, strict=True):
        errors.number(f"mode {mode}: {column}", value, **limits)
    return result


def _values(table: Columns, turn: np.ndarray, per_metre: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the six motions of each row in our axes, shape (rows, 6), rotations per metre.

    With them which of the model's rotations are known, shape (3,).
    """
    values = np.zeros((len(table.lines), 6))
    for i, column in enumerate(_SHAPES):
        if column in table.cells:
            values[:, i] = table.numbers(column)
    # Programs with solid elements print rotations as zeros: none at all are none known.
    known = np.abs(values[:, 3:]).max(axis=0) > 0.0
    moved, turned = values[:, :3] @ turn.T, values[:, 3:] @ turn.T * per_metre
    return np.concatenate([moved, turned], axis=1), known


def _read_masses(
    path: str | Path, nodes: Nodes, shapes: np.ndarray, units: Sequence[str] | None
) -> np.ndarray:
    """Return mass and inertia about x, y, z of every node, shape (n, 4)."""
    table = read_columns(path, ["node", "mass"], _INERTIAS)
    length, mass = _units_of(table, units, nodes)
    labels = table.unique_labels("node")
    place = {label: i for i, label in enumerate(nodes.labels)}
    result = np.zeros((len(nodes.labels), 4))
    with within(source=table.name):
        for i, column in enumerate(["mass", *_INERTIAS]):
            if column not in table.cells:
                continue
            factor = factor_of("units[2]", mass, "mass") * (per_metre(length) ** -2 if i else 1.0)
            for label, value in zip(labels, table.numbers(column), strict=True):
                if label not in place:
                    near = errors.did_you_mean(label, place)
                    raise InputError("node", label, "is not among the nodes", near)
                value = errors.number(f"node {label}: {column}", value * factor, least=0.0)
                result[place[label], i] = value
        result[:, 1:] = result[:, 1:] @ np.abs(nodes.turn).T
        lost = result[~np.isfinite(shapes[0, :, 0]), 0].sum() / max(result[:, 0].sum(), 1e-30)
        if lost > 0.01:
            allowed = f"{lost:.0%} of the mass stands at nodes that the modes leave out"
            allowed += ", so orthogonality cannot be checked"
            remedy = "Write the modes at all nodes, or leave the masses out"
            raise InputError("mass", None, allowed, remedy)
    return errors.frozen(result)


def _refuse_overlap(model: ModalModel, name: str) -> None:
    """Refuse modes that are not orthogonal over the masses or not mass-normalised.

    Without masses only a mode that is given twice is refused.
    """
    found = model.orthogonality()
    i, j = (model.labels.index(label) for label in found.pair)
    pair = f"modes {found.pair[0]} and {found.pair[1]}"
    f1, f2 = model.frequencies_hz[[i, j]]
    if found.known_masses:
        if found.worst > _WORST_OVERLAP:
            allowed = f"{found.worst:.2g} of their mass products is shared"
            allowed += f", at most {_WORST_OVERLAP:g}: they are not orthogonal"
            remedy = "Is a mode given twice, or are the masses of another model?"
            raise InputError(pair, None, allowed, remedy)
        whole = found.own[found.own > 0.1]
        off = whole[np.argmax(np.abs(np.log(whole)))] if len(whole) else 0.0
        if not 0.5 < off < 2.0:
            allowed = f"phi M phi is {off:.3g} for a mode, must be about 1"
            allowed += ": not mass-normalised, or masses in another unit"
            remedy = "Add the column modal_mass, or correct the units"
            raise InputError("shapes", None, allowed, remedy)
        if abs(off - 1.0) > 0.1:
            found = f"phi M phi of a mode is {off:.3g} over the given masses instead of 1."
            warnings.warn(f"{name}: {found}", stacklevel=3)
    elif found.worst > 0.9999 and abs(f1 - f2) < 1e-4 * f2:
        allowed = "have one shape and one frequency: a mode is given twice"
        raise InputError(pair, None, allowed, "Remove one")


# ---- modes out


def export_modes(deck: Deck, folder: str | Path, units: Sequence[str] = ("m", "kg")) -> Path:
    """Write a deck's modes as ``nodes.csv``, ``modes.csv`` and ``deck.toml``; return the last.

    `deck` reads them back. Nodes stand at the ends and thirds of every piece of the shapes, and the
    file of nodes says so (``# pieces: cubic``): a cubic through four nodes is then the shape
    itself, whatever made the deck. Rotations are written for other readers: ``ry`` and ``rz`` are
    the slopes, mean values where these jump. ``ux`` is zero: a deck knows no motion along the
    track.

    Parameters
    ----------
    deck : Deck
    folder : str or Path
        Made if it is not there.
    units : (length, mass)
        Of the tables; the deck file is in m.

    Raises
    ------
    InputError
        Unknown units.
    """
    errors.instance("deck", deck, Deck)
    length, mass = model_units(units)
    x, columns = _at_thirds(deck, per_metre(length), math.sqrt(factor_of("units[2]", mass, "mass")))
    head = f"# units: {length}, {mass}\n"
    places = [f"{i},{_text(v * per_metre(length))},0,0\n" for i, v in enumerate(x, start=1)]
    rows = []
    modes = zip(deck.frequencies_hz, deck.damping_ratios, deck.mode_names, strict=True)
    for m, (f, ratio, name) in enumerate(modes):
        start = f"{m + 1},{_text(f)},{_text(ratio)},{_cell(name)},"
        for i, row in enumerate(columns[:, m], start=1):
            rows.append(f"{start}{i},{','.join(map(_text, row))}\n")
    header = f"mode,frequency_hz,damping_ratio,name,node,{','.join(_SHAPES)}\n"
    files = {
        "nodes.csv": [head, "# pieces: cubic\n", "node,x,y,z\n", *places],
        "modes.csv": [head, header, *rows],
        "deck.toml": _deck_file(deck),
    }
    try:
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text("".join(text), encoding="utf-8", newline="\n")
    except (TypeError, ValueError) as error:
        raise InputError("folder", folder, f"is not the path of a folder ({error})") from None
    return folder / "deck.toml"


def _at_thirds(deck: Deck, per_metre: float, mass: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes (m) and the six motions of every mode there, shape (nodes, modes, 6).

    `mass` is the root of the unit of mass.
    """
    edges = deck.shapes.edges
    inside = edges[:-1, None] + np.diff(edges)[:, None] * [0.0, 1 / 3, 2 / 3]
    x = np.concatenate([inside.ravel(), edges[-1:]])
    value, slope = deck.shapes(x), deck.shapes(x, 1)
    before = deck.shapes(np.nextafter(edges[1:-1], 0.0), 1)
    slope[3:-1:3] = (slope[3:-1:3] + before) / 2
    columns = np.zeros((len(x), len(deck.frequencies_hz), 6))
    columns[..., 1:3] = value[..., :2] * mass
    columns[..., 3] = value[..., 2] * mass / per_metre
    columns[..., 4] = -slope[..., 1] * mass / per_metre
    columns[..., 5] = slope[..., 0] * mass / per_metre
    return x, columns


def _deck_file(deck: Deck) -> list[str]:
    """Return the lines of the deck file beside the tables."""
    lines = [f"name = {_quoted(deck.name)}\n"]
    lines += ['note = "modes only: no section forces, reactions or self-weight"\n']
    lines += [f"width = {_text(deck.width)}\n"] if deck.width else []
    lines += [f"track_height = {_text(deck.track_height)}\n"] if deck.track_height else []
    lines += ["\n[modes]\n", 'nodes = "nodes.csv"\n', 'modes = "modes.csv"\n', "unusual = true\n"]
    if deck.supports:
        lines += [f"supports = [{', '.join(map(_text, deck.supports))}]\n"]
    if deck.rail is not None:
        rail = [f"{k} = {_text(v)}\n" for k, v in vars(deck.rail).items() if v is not None]
        lines += ["\n[rail]\n", *rail]
    if deck.tracks:
        tracks = [f"{_quoted(k)} = {_text(y)}\n" for k, y in deck.tracks.items()]
        lines += ["\n[tracks]\n", *tracks]
    return lines


def _cell(text: str) -> str:
    """Return a text as a cell of a CSV file."""
    inside = _encodable(text).replace('"', '""')
    return f'"{inside}"' if re.search('[",;#\\r\\n]', inside) else inside


def _quoted(text: str) -> str:
    """Return a text as TOML writes it."""
    escaped = _encodable(text).replace("\\", "\\\\").replace('"', '\\"')
    letters = (f"\\u{ord(c):04x}" if ord(c) < 32 or ord(c) == 127 else c for c in escaped)
    return f'"{"".join(letters)}"'


def _encodable(text: str) -> str:
    """Return a text without halves of letters, as names of files may have: UTF-8 has none."""
    return text.encode("utf-8", "replace").decode()


def _text(value: float) -> str:
    """Return a number with all its digits."""
    return repr(float(value))
