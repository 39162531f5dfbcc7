"""Nodes of other programs' models: CSV tables with units, the nodes, and the line of them that carries the rail."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from .. import errors
from ..errors import InputError

__all__ = [
    "MASSES", "PER_METRE", "Columns", "Nodes", "RailLine", "cubics", "hermite", "labelled", "parabolas", "read_columns",
    "read_nodes", "refuse_repeats", "spline", "stated_units",
]  # fmt: skip

PER_METRE = {"m": 1.0, "cm": 100.0, "mm": 1000.0, "in": 1 / 0.0254, "ft": 1 / 0.3048}
"""Units of length a model may be in. Whole numbers divide without the rounding that a factor 0.001 brings."""
MASSES = {"kg": 1.0, "t": 1e3, "lb": 0.45359237, "slug": 14.593903}
"""Units of mass a model may be in, kg. A model in N, mm and s has its masses in t."""


# ---- tables


@dataclass(frozen=True, eq=False)
class Columns:
    """A CSV file by columns, still as text.

    Attributes
    ----------
    name : str
        Of the file.
    cells : dict of list of str
    lines : list of int
        Line of each row in the file, for messages.
    units : tuple of str, or None
        From a line ``# units: mm, t`` above the header.
    cubic : bool
        From a line ``# pieces: cubic``; see `Nodes`.
    """

    name: str
    cells: dict[str, list[str]]
    lines: list[int]
    units: tuple[str, ...] | None
    cubic: bool = False

    def numbers(self, column: str) -> np.ndarray:
        """Return a column as finite numbers, naming the line of the first that is none."""
        cells = self.cells[column]
        try:
            values = np.array(cells, dtype=float)
        except ValueError:
            values = np.array([_float(c) for c in cells])
        for i in np.flatnonzero(~np.isfinite(values))[:1]:
            remedy = "Use a point as decimal mark"
            raise InputError(f"{self.name}: line {self.lines[i]}: {column}", cells[i], "must be a finite number", remedy)
        return values

    def labels(self, column: str) -> list[str]:
        """Return a column of node or mode labels; 12 and 12.0 are the same."""
        return [labelled(c) for c in self.cells[column]]


def _float(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return math.nan


def labelled(value: Any) -> str:
    """Return the label of a node or mode as text; 12 and 12.0 are the same."""
    text = str(value).strip()
    number = _float(text)
    return str(int(number)) if math.isfinite(number) and number == int(number) else text


def read_columns(path: str | Path, required: Sequence[str], optional: Sequence[str] = ()) -> Columns:
    """Read a CSV file with a header; lines that start with # are comments.

    Raises
    ------
    InputError
        No such file, no readable text, a column missing, unknown or given twice, or a row of another length.
    """
    path = Path(path)
    known = [*required, *optional]
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        allowed = "no such file" if isinstance(error, FileNotFoundError) else f"is not a readable text file ({error})"
        raise InputError("file", path.name, allowed, "A path in a deck file is relative to that file") from None
    said, rows, lines = {}, [], []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("#"):
            key, _, value = line.strip(" #,;\t").partition(":")
            said[key.strip().lower()] = tuple(value.replace(",", " ").split())
        elif line.strip(" ,;\t"):
            rows.append(line)
            lines.append(number)
    table = list(csv.reader(rows))
    header = [h.strip() for h in table[0]] if table else []
    for column in header:
        if header.count(column) > 1:
            raise InputError(f"{path.name}: column {column}", None, "appears more than once")
        if column not in known:
            raise InputError(f"{path.name}: column {column}", None, "unknown column", errors.did_you_mean(column, known))
    for column in required:
        if column not in header:
            raise InputError(f"{path.name}: column {column}", None, "is missing", "Columns: " + ",".join(known))
    for number, row in zip(lines[1:], table[1:], strict=True):
        if len(row) != len(header):
            raise InputError(f"{path.name}: line {number}", ",".join(row), f"must have {len(header)} cells, it has {len(row)}")
    if len(table) < 2:
        raise InputError(path.name, None, "holds no rows")
    columns = zip(*table[1:], strict=True)
    cells = {h: [c.strip() for c in column] for h, column in zip(header, columns, strict=True)}
    return Columns(path.name, cells, lines[1:], said.get("units"), said.get("pieces") == ("cubic",))


def stated_units(found: Columns, given: Sequence[str] | None) -> tuple[str, str]:
    """Return the units of length and mass, which must be stated somewhere and not differently."""
    stated = found.units if found.units is not None else given
    where = f"{found.name}: units"
    if stated is None:
        raise InputError(where, None, "are stated nowhere", "Add '# units: mm, t' as first line, or give units = ['mm', 't']")
    if isinstance(stated, str) or len(tuple(stated)) not in (1, 2):
        raise InputError(where, stated, "must name a length and a mass", "For instance '# units: m, kg'")
    length, mass = (*stated, "kg")[:2]
    errors.choice(f"{where} of length", length, PER_METRE)
    errors.choice(f"{where} of mass", mass, MASSES)
    if given is not None and tuple(given)[: len(stated)] != tuple(stated):
        raise InputError(where, list(given), f"the file itself says {', '.join(stated)}", "Remove the wrong one")
    return length, mass


def _axes(axes: Sequence[str]) -> np.ndarray:
    """Return the rotation from model axes to ours, shape (3, 3): row i says which model axis is our x, y, z."""
    allowed = "must name the model's axes that point forward, left and up"
    known = {f"{sign}{a}" for a in "xyz" for sign in ("", "-")}
    if isinstance(axes, str) or len(axes) != 3 or not all(a in known for a in axes):
        raise InputError("axes", axes, allowed, "A model with y up and x forward has axes = ['x', '-z', 'y']")
    turn = np.zeros((3, 3))
    for row, axis in enumerate(axes):
        turn[row, "xyz".index(axis[-1])] = -1.0 if axis.startswith("-") else 1.0
    if not np.isclose(np.linalg.det(turn), 1.0):
        raise InputError("axes", list(axes), f"{allowed}, a right-handed set", "Change the sign of one of them")
    return turn


def read_nodes(path: str | Path, units: Sequence[str] | None = None, axes: Sequence[str] = ("x", "y", "z")) -> Nodes:
    """Read ``nodes.csv``: node, x, y, z.

    Parameters
    ----------
    path : str or Path
    units : (length, mass), optional
        For instance ``("mm", "t")``; not needed where the file has a line ``# units: mm, t``.
    axes : three of x, -x, y, -y, z, -z
        Which axes of the model point forward, left and up; ``("x", "-z", "y")`` for a model with y up.

    Raises
    ------
    InputError
        No units, unreadable rows, or a node given twice.
    """
    table = read_columns(path, ["node", "x", "y", "z"])
    length, mass = stated_units(table, units)
    labels = table.labels("node")
    refuse_repeats(table, labels)
    turn = _axes(axes)
    places = np.stack([table.numbers(c) for c in "xyz"], axis=1) / PER_METRE[length] @ turn.T
    return Nodes(tuple(labels), errors.frozen(places), (length, mass), turn, table.cubic)


def refuse_repeats(table: Columns, labels: list[str]) -> None:
    """Refuse a node that is given twice, naming both lines."""
    seen: dict[str, int] = {}
    for line, label in zip(table.lines, labels, strict=True):
        if label in seen:
            allowed = f"is given twice, in lines {seen[label]} and {line}"
            raise InputError(f"{table.name}: node", label, allowed, "Remove or rename one; every node has one place")
        seen[label] = line


# ---- nodes and the rail line


@dataclass(frozen=True, eq=False)
class Nodes:
    """Nodes of a model.

    Attributes
    ----------
    labels : tuple of str
    places : ndarray, shape (n, 3)
        m, x forward, y left, z up.
    units : tuple of str
        Length and mass of the model.
    turn : ndarray, shape (3, 3)
        From the model's axes to ours.
    cubic : bool
        The nodes stand at ends and thirds of pieces, in each of which shapes are cubics: as `export_modes` writes them.
    """

    labels: tuple[str, ...]
    places: np.ndarray
    units: tuple[str, str] = ("m", "kg")
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    cubic: bool = False

    def line(self, rail: Mapping[str, Any] | None = None, axis: Mapping[str, float] | None = None) -> RailLine:
        """Return the line of nodes that carries the rail.

        Parameters
        ----------
        rail : mapping, optional
            ``{"y": 0.0, "z": 1.2}`` (m; one may be left out, and ``within``, default 0.01 m), or ``{"nodes": [1, 2, ...]}``; or
            ``{"left": .., "right": ..}``, each like that. Default: all nodes, if they form one line.
        axis : mapping, optional
            y and z of the deck axis (m) from which tracks are measured; default the line's own, or midway between two.

        Raises
        ------
        InputError
            Fewer than three nodes, two at one x, or left and right nodes that do not stand side by side.
        """
        rail = {} if rail is None else errors.table("rail", rail)
        if "left" in rail or "right" in rail:
            errors.keys("rail", rail, [], ["left", "right"])
            picked = [self._pick(f"rail.{side}", errors.table(f"rail.{side}", rail[side])) for side in ("left", "right")]
        else:
            picked = [self._pick("rail", rail)]
        if len({len(p) for p in picked}) > 1:
            raise InputError("rail", None, f"holds {len(picked[0])} left and {len(picked[1])} right nodes, must be pairs")
        index = np.array(picked).T
        x, y, z = np.moveaxis(self.places[index], -1, 0)
        length = float(x[-1, 0] - x[0, 0])
        for i in np.flatnonzero(np.ptp(x, axis=1) > 1e-3 * length)[:1]:
            pair = [self.labels[p] for p in index[i]]
            raise InputError("rail", pair, "left and right nodes must stand at the same x", "Choose two lines of one mesh")
        if len(picked) == 2 and np.any(y[:, 0] - y[:, 1] < 1e-3):
            raise InputError("rail.left", float(y[0, 0]), "must stand left of rail.right, at larger y", "Exchange them?")
        axis = {} if axis is None else errors.table("axis", axis)
        errors.keys("axis", axis, ["y", "z"])
        origin = [errors.number(f"axis.{k}", axis.get(k, float(v.mean())), unit="m") for k, v in (("y", y), ("z", z))]
        labels = tuple(tuple(self.labels[p] for p in pair) for pair in index)
        cubic = self.cubic and index.size == len(self.labels)  # a choice of its nodes are no longer ends and thirds
        return RailLine(labels, x[:, 0] - x[0, 0], y - origin[0], z - origin[1], self.units, self.turn, cubic)

    def _pick(self, where: str, choice: dict[str, Any]) -> list[int]:
        """Return the nodes of one line, ascending in x."""
        errors.keys(where, choice, ["y", "z", "within", "nodes"])
        if "nodes" in choice:
            errors.keys(where, choice, ["nodes"])
            if isinstance(choice["nodes"], (str, bytes)):
                raise InputError(f"{where}.nodes", choice["nodes"], "must be a list of nodes")
            place = {label: i for i, label in enumerate(self.labels)}
            wanted = [labelled(n) for n in choice["nodes"]]
            for label in wanted:
                if label not in place:
                    raise InputError(f"{where}.nodes", label, "is no node of the model", errors.did_you_mean(label, place))
                if wanted.count(label) > 1:
                    raise InputError(f"{where}.nodes", label, "is listed more than once")
            found = [place[label] for label in wanted]
        else:
            within = errors.number(f"{where}.within", choice.get("within", 0.01), above=0.0, unit="m")
            near = np.ones(len(self.labels), dtype=bool)
            for key, column in (("y", 1), ("z", 2)):
                if key in choice:
                    near &= np.abs(self.places[:, column] - errors.number(f"{where}.{key}", choice[key], unit="m")) <= within
            found = np.flatnonzero(near).tolist()
        if len(found) < 3:
            allowed = f"holds {len(found)} nodes, must be at least 3"
            raise InputError(where, choice or None, allowed, "Check y and z (in m), or widen 'within'")
        found.sort(key=lambda i: self.places[i, 0])
        x = self.places[found, 0]
        for i in np.flatnonzero(np.diff(x) < 1e-6 * max(x[-1] - x[0], 1e-9))[:1]:
            pair = [self.labels[found[i]], self.labels[found[i + 1]]]
            raise InputError(where, pair, f"two nodes stand at x = {x[i]:g} m", "Merge them, or list the rail's nodes one by one")
        return found


@dataclass(frozen=True, eq=False)
class RailLine:
    """The nodes under a rail or under a pair of rails, first to last along the deck.

    Attributes
    ----------
    labels : tuple of tuple of str, shape (n, k)
        One node, or a left and a right one (k = 2), at each place.
    x : ndarray, shape (n,)
        m from the first.
    y, z : ndarray, shape (n, k)
        m from the deck axis.
    units, turn, cubic
        See `Nodes`.
    """

    labels: tuple[tuple[str, ...], ...]
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    units: tuple[str, str]
    turn: np.ndarray
    cubic: bool = False

    @property
    def nodes(self) -> tuple[str, ...]:
        """All labels in one row: place by place, left before right."""
        return tuple(label for pair in self.labels for label in pair)

    @property
    def length(self) -> float:
        """First to last node, m."""
        return float(self.x[-1])

    @property
    def paired(self) -> bool:
        """Whether a left and a right line carry the rail."""
        return self.y.shape[1] == 2

    def axis_motion(self, y: np.ndarray, z: np.ndarray, roll: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return lateral, vertical motion and twist of the deck axis from those of the nodes, each shape (..., n, k) to (..., n).

        From one node as on a rigid arm: v = uy + z rx, w = uz - y rx. From a pair: twist is the difference of uz over the
        distance, w on the straight line through both uz, v the mean of uy moved by the twist; `roll` is then not used.
        """
        if self.paired:
            twist = (z[..., 0] - z[..., 1]) / (self.y[:, 0] - self.y[:, 1])
            return y.mean(axis=-1) + self.z.mean(axis=1) * twist, z[..., 0] - twist * self.y[:, 0], twist
        twist = roll[..., 0]
        return y[..., 0] + self.z[:, 0] * twist, z[..., 0] - self.y[:, 0] * twist, twist


def spline(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the cubic spline through values, shape (m, n), as coefficients of local powers, shape (n - 1, 4, m)."""
    found = CubicSpline(x, values, axis=-1).c[::-1]
    return np.moveaxis(found * np.diff(x)[None, :, None] ** np.arange(4)[:, None, None], 1, 0)


def hermite(x: np.ndarray, values: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return cubics with given values and slopes at the nodes, each shape (m, n), as coefficients, shape (n - 1, 4, m)."""
    h = np.diff(x)
    a, b, da, db = values[:, :-1], values[:, 1:], h * slopes[:, :-1], h * slopes[:, 1:]
    return np.stack([a, da, 3 * (b - a) - 2 * da - db, 2 * (a - b) + da + db]).transpose(2, 0, 1)


def parabolas(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return parabolas through nodes 1-2-3, 3-4-5, ...; the last three where one piece is left. Shapes as in `hermite`."""
    pieces = len(x) - 1
    result = np.zeros((pieces, 4, len(values)))
    for e in range(pieces):
        first = min(e - e % 2, pieces - 2)
        here = x[first : first + 3]
        h, local = x[e + 1] - x[e], here - x[e]
        powers = np.linalg.solve(np.vander(local / h, 3, increasing=True), values[:, first : first + 3].T)
        result[e, :3] = powers
    return result


def cubics(x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return cubics through nodes 1-2-3-4, 4-5-6-7, ...; shapes as in `hermite`, but one piece for every four nodes."""
    result = np.zeros(((len(x) - 1) // 3, 4, len(values)))
    for e in range(len(result)):
        here = slice(3 * e, 3 * e + 4)
        local = (x[here] - x[3 * e]) / (x[3 * e + 3] - x[3 * e])
        result[e] = np.linalg.solve(np.vander(local, increasing=True), values[:, here].T)
    return result
