"""Nodes of other programs' models, and the line of them that carries the rail."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, get_args

import numpy as np

from .. import errors
from ..errors import InputError, Range, brief, check_fields, within
from ..units import factor_of, per_metre, spelled
from .tables import Columns, labelled, read_columns

__all__ = [
    "AxisPlace", "ModelAxis", "NodeChoice", "NodeRows", "Nodes", "RailLine", "axis_place",
    "model_axes", "model_units", "node_choice", "read_nodes", "stated_units",
]  # fmt: skip

ModelAxis = Literal["x", "-x", "y", "-y", "z", "-z"]
"""An axis of a model, as it is or reversed."""


# ---- units and axes of a model


def model_units(units: Sequence[str | float]) -> tuple[str, str]:
    """Return the units of length and mass that are named; kg where only a length is.

    A unit without a name is the number of metres or kilograms that it is.

    Raises
    ------
    InputError
        Naming ``units``: not one or two, or unknown.
    """
    named = tuple(units) if errors.is_list(units) else ()
    if len(named) not in (1, 2):
        remedy = "For instance units = ['m', 'kg'], or '# units: m, kg' in the file"
        raise InputError("units", units, "must name a length and a mass", remedy)
    for i, (unit, dimension) in enumerate(zip(named, ("length", "mass"), strict=False), start=1):
        factor_of(f"units[{i}]", unit, dimension)
    length, mass = (*map(_unit, named), "kg")[:2]
    return length, mass


def _unit(unit: str | float) -> str:
    return spelled(unit) if isinstance(unit, str) else repr(unit)


def stated_units(table: Columns, given: Sequence[str] | None) -> tuple[str, str]:
    """Return the units of length and mass, which must be stated somewhere and not differently.

    Raises
    ------
    InputError
        Naming ``units`` of the file, or those given where they contradict the file.
    """
    asked = None if given is None else model_units(given)
    if table.units is None and asked is None:
        remedy = "Add '# units: mm, t' as first line, or give units = ['mm', 't']"
        raise InputError("units", None, "are stated nowhere", remedy, table.name)
    if table.units is None:
        return asked
    with within(source=table.name):
        found = model_units(table.units)
    if asked is not None and asked[: len(table.units)] != found[: len(table.units)]:
        allowed = f"{table.name} itself says {', '.join(table.units)}"
        raise InputError("units", list(given), allowed, "Remove the wrong one")
    return found


def model_axes(axes: Sequence[ModelAxis]) -> np.ndarray:
    """Return the rotation from model axes to ours, shape (3, 3).

    Row i says which model axis is our x, y, z.

    Raises
    ------
    InputError
        Naming ``axes``: not three axes of a right-handed set.
    """
    allowed = "must name the model's axes that point forward, left and up"
    named = tuple(axes) if errors.is_list(axes) else ()
    known = get_args(ModelAxis)
    if len(named) != 3 or not all(isinstance(a, str) and a in known for a in named):
        remedy = "A model with y up and x forward has axes = ['x', '-z', 'y']"
        raise InputError("axes", axes, allowed, remedy)
    turn = np.zeros((3, 3))
    for row, axis in enumerate(named):
        turn[row, "xyz".index(axis[-1])] = -1.0 if axis.startswith("-") else 1.0
    if not np.isclose(np.linalg.det(turn), 1.0):
        allowed = f"{allowed}, a right-handed set"
        raise InputError("axes", list(named), allowed, "Change the sign of one of them")
    return turn


def read_nodes(
    path: str | Path,
    units: Sequence[str] | None = None,
    axes: Sequence[ModelAxis] = ("x", "y", "z"),
) -> Nodes:
    """Read ``nodes.csv``: node, x, y, z.

    Parameters
    ----------
    path : str or Path
    units : (length, mass), optional
        For instance ``("mm", "t")``; not needed where the file has a line ``# units: mm, t``.
    axes : three of x, -x, y, -y, z, -z
        Which axes of the model point forward, left and up; ``("x", "-z", "y")`` for a model with
        y up.

    Raises
    ------
    InputError
        No units, unreadable rows, or a node given twice.
    """
    table = read_columns(path, ["node", "x", "y", "z"])
    length, mass = stated_units(table, units)
    labels = table.unique_labels("node")
    turn = model_axes(axes)
    places = np.stack([table.numbers(c) for c in "xyz"], axis=1) / per_metre(length) @ turn.T
    cubic = table.remarks.get("pieces") == ("cubic",)
    return Nodes(tuple(labels), errors.frozen(places), (length, mass), turn, cubic)


# ---- which nodes carry the rail


@dataclass(frozen=True)
class NodeChoice:
    """Nodes of one row, chosen by place or one by one; all nodes of the model if nothing is given.

    Attributes
    ----------
    y : float, optional
        m to the left in the model; nodes at this distance are chosen.
    z : float, optional
        m up in the model; nodes at this height are chosen.
    within : float
        m that nodes may be off y and z.
    nodes : tuple of str or int, optional
        Numbers or names of the nodes, instead of a place.
    """

    __repr__ = brief

    y: Annotated[float, Range(unit="m")] | None = None
    z: Annotated[float, Range(unit="m")] | None = None
    within: Annotated[float, Range(above=0.0, unit="m")] = 0.01
    nodes: tuple[str | int, ...] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.nodes is None:
            return
        for f in fields(self):
            if f.name != "nodes" and getattr(self, f.name) != f.default:
                remedy = "Choose nodes by place or one by one"
                raise InputError(f.name, getattr(self, f.name), "cannot stand beside nodes", remedy)
        if not errors.is_list(self.nodes):
            raise InputError("nodes", self.nodes, "must be a list of nodes")
        labels = tuple(labelled(n) for n in self.nodes)
        for label in labels:
            if labels.count(label) > 1:
                raise InputError("nodes", label, "is listed more than once", "Remove one of them")
        object.__setattr__(self, "nodes", labels)

    @property
    def given(self) -> dict[str, Any] | None:
        """What was chosen, for messages; None for all nodes."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        chosen = {f.name: values[f.name] for f in fields(self) if values[f.name] != f.default}
        return {k: list(v) if k == "nodes" else v for k, v in chosen.items()} or None


@dataclass(frozen=True)
class NodeRows:
    """Nodes of two rows that stand side by side, as in solid and shell models.

    Attributes
    ----------
    left : NodeChoice
        The row at larger y.
    right : NodeChoice
        The row at smaller y, with as many nodes.
    """

    left: NodeChoice
    right: NodeChoice

    def __post_init__(self) -> None:
        for name in ("left", "right"):
            with within(name):
                object.__setattr__(self, name, _made(NodeChoice, getattr(self, name)))


@dataclass(frozen=True)
class AxisPlace:
    """Where the deck axis lies in a model.

    Attributes
    ----------
    y : float, optional
        m to the left; that of the rail line, or midway between two, if not given.
    z : float, optional
        m up; likewise.
    """

    y: Annotated[float, Range(unit="m")] | None = None
    z: Annotated[float, Range(unit="m")] | None = None

    def __post_init__(self) -> None:
        check_fields(self)


def node_choice(rail: NodeChoice | NodeRows | Mapping[str, Any] | None) -> NodeChoice | NodeRows:
    """Return which nodes carry the rail; a mapping is that of a deck file.

    Raises
    ------
    InputError
        Naming what is wrong inside ``rail``: ``left.nodes``, for instance.
    """
    if isinstance(rail, NodeRows):
        return rail
    if isinstance(rail, Mapping) and ("left" in rail or "right" in rail):
        for side in {"left", "right"}.difference(rail):
            raise InputError(side, None, "is missing", "Give a left and a right row, or one row")
        for f in fields(NodeChoice):
            if f.name in rail:
                remedy = "Give it inside left and right, or one row"
                allowed = "cannot stand beside left and right"
                raise InputError(f.name, rail[f.name], allowed, remedy)
        return _made(NodeRows, rail)
    return _made(NodeChoice, rail)


def axis_place(axis: AxisPlace | Mapping[str, float] | None) -> AxisPlace:
    """Return where the deck axis lies; a mapping is that of a deck file."""
    return _made(AxisPlace, axis)


_Made = TypeVar("_Made", NodeChoice, NodeRows, AxisPlace)


def _made(kind: type[_Made], given: _Made | Mapping[str, Any] | None) -> _Made:
    """Return a dataclass, made of a table of its fields where it is not one already."""
    if isinstance(given, kind):
        return given
    table = {} if given is None else errors.table("", given)
    errors.keys("", table, [f.name for f in fields(kind)])
    return kind(**table)


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
        Rotation from the model's axes to ours.
    cubic : bool
        The nodes stand at ends and thirds of pieces, in each of which shapes are cubics: as
        `export_modes` writes them.
    """

    __repr__ = brief

    labels: tuple[str, ...]
    places: np.ndarray
    units: tuple[str, str] = ("m", "kg")
    turn: np.ndarray = field(default_factory=lambda: np.eye(3))
    cubic: bool = False

    def line(
        self,
        rail: NodeChoice | NodeRows | Mapping[str, Any] | None = None,
        axis: AxisPlace | Mapping[str, float] | None = None,
    ) -> RailLine:
        """Return the line of nodes that carries the rail.

        Parameters
        ----------
        rail : mapping, NodeChoice or NodeRows, optional
            ``{"y": 0.0, "z": 1.2}`` (m; one may be left out, and ``within``, default 0.01 m), or
            ``{"nodes": [1, 2, ...]}``; or ``{"left": .., "right": ..}``, each like that. Default:
            all nodes, if they form one line.
        axis : mapping or AxisPlace, optional
            y and z of the deck axis (m) from which tracks are measured; default the line's own, or
            midway between two.

        Raises
        ------
        InputError
            Fewer than three nodes, two at one x, or left and right nodes that do not stand side by
            side.
        """
        with within("rail"):
            index = self._rows(node_choice(rail))
        x, y, z = np.moveaxis(self.places[index], -1, 0)
        with within("axis"):
            chosen = axis_place(axis)
            origin = AxisPlace(
                float(y.mean()) if chosen.y is None else chosen.y,
                float(z.mean()) if chosen.z is None else chosen.z,
            )
        y, z = y - origin.y, z - origin.z
        labels = tuple(tuple(self.labels[p] for p in pair) for pair in index)
        # A choice of its nodes are no longer ends and thirds.
        cubic = self.cubic and index.size == len(self.labels)
        return RailLine(labels, x[:, 0] - x[0, 0], y, z, self.units, self.turn, cubic)

    def _rows(self, rail: NodeChoice | NodeRows) -> np.ndarray:
        """Return the nodes of one row or of two side by side, shape (n, 1 or 2)."""
        if isinstance(rail, NodeChoice):
            return np.array([self._row(rail)]).T
        rows = []
        for side in ("left", "right"):
            with within(side):
                rows.append(self._row(getattr(rail, side)))
        left, right = rows
        if len(left) != len(right):
            allowed = f"holds {len(left)} left and {len(right)} right nodes, must be pairs"
            raise InputError("", None, allowed, "Choose two lines of one mesh")
        x, y, _ = self.places[[left, right]].T
        for i in np.flatnonzero(np.ptp(x, axis=1) > 1e-3 * float(x[-1, 0] - x[0, 0]))[:1]:
            pair = [self.labels[left[i]], self.labels[right[i]]]
            allowed = "left and right nodes must stand at the same x"
            raise InputError("", pair, allowed, "Choose two lines of one mesh")
        if np.any(y[:, 0] - y[:, 1] < 1e-3):
            allowed = "must stand left of the right row, at larger y"
            raise InputError("left", float(y[0, 0]), allowed, "Exchange them?")
        return np.array(rows).T

    def _row(self, choice: NodeChoice) -> list[int]:
        """Return the nodes of one row, ascending in x."""
        if choice.nodes is not None:
            place = {label: i for i, label in enumerate(self.labels)}
            for label in choice.nodes:
                if label not in place:
                    near = errors.did_you_mean(label, place)
                    raise InputError("nodes", label, "is no node of the model", near)
            found = [place[label] for label in choice.nodes]
        else:
            near = np.ones(len(self.labels), dtype=bool)
            for wanted, column in ((choice.y, 1), (choice.z, 2)):
                if wanted is not None:
                    near &= np.abs(self.places[:, column] - wanted) <= choice.within
            found = np.flatnonzero(near).tolist()
        if len(found) < 3:
            allowed = f"holds {len(found)} nodes, must be at least 3"
            remedy = "Check y and z (in m), or widen 'within'"
            if choice.nodes is not None:
                remedy = "List every node under the rail"
            raise InputError("", choice.given, allowed, remedy)
        found.sort(key=lambda i: self.places[i, 0])
        x = self.places[found, 0]
        for i in np.flatnonzero(np.diff(x) < 1e-6 * max(x[-1] - x[0], 1e-9))[:1]:
            pair = [self.labels[found[i]], self.labels[found[i + 1]]]
            remedy = "Merge them, or list the rail's nodes one by one"
            raise InputError("", pair, f"two nodes stand at x = {x[i]:g} m", remedy)
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

    __repr__ = brief

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

    def axis_motion(
        self, y: np.ndarray, z: np.ndarray, roll: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return lateral motion, vertical motion and twist of the deck axis.

        Each of the nodes' motions has the shape (..., n, k), each of the axis (..., n).

        From one node as on a rigid arm: v = uy + z rx, w = uz - y rx. From a pair: twist is the
        difference of uz over the distance, w lies on the straight line through both uz, and v is
        the mean of uy moved by the twist; `roll` is then not used.
        """
        if self.paired:
            twist = (z[..., 0] - z[..., 1]) / (self.y[:, 0] - self.y[:, 1])
            lateral = y.mean(axis=-1) + self.z.mean(axis=1) * twist
            return lateral, z[..., 0] - twist * self.y[:, 0], twist
        twist = roll[..., 0]
        return y[..., 0] + self.z[:, 0] * twist, z[..., 0] - self.y[:, 0] * twist, twist
