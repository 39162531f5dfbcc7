"""The table ``modes`` of a deck file: the files of another program's modes, and their deck."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from ..damping import Damping
from ..decks import Deck
from ..errors import Range, brief, check_fields, within
from .files import read_modes
from .modal import deck_from_modes
from .nodes import (
    AxisPlace,
    ModelAxis,
    NodeChoice,
    NodeRows,
    axis_place,
    model_axes,
    model_units,
    node_choice,
)

__all__ = ["ModesTable", "beside", "sources", "stamps"]

_PATHS = ("nodes", "modes", "masses")
_IN_THE_TABLE = {
    "line": "rail",
    "modes: first frequency": "first frequency",
    "modes: shapes": "shapes",
}
"""What `deck_from_modes` names otherwise than a reader of the table would."""


@dataclass(frozen=True)
class ModesTable:
    """Another program's modes, from which a deck is made.

    Attributes
    ----------
    nodes : str
        CSV file of the nodes, its path relative to this file: node, x, y, z.
    modes : str
        CSV file of the modes: mode, frequency_hz, damping_ratio, node, ux, uy, uz, rx, ry, rz.
    masses : str, optional
        CSV file of the nodal masses: node, mass, inertia_x, inertia_y, inertia_z. With it the modes
        are checked for orthogonality.
    units : (length, mass), optional
        Units of the model, as ["mm", "t"] or ["in", "lbf s2/in"]; a unit without a name is the
        number of metres or kilograms that it is. Needed where the files do not say them.
    axes : three of x, -x, y, -y, z, -z
        The model's axes that point forward, left and up.
    rail : table, optional
        Nodes that carry the rail: those at y, z (m), or nodes = [1, 2, 3]; or left and right, each
        like that. All nodes if not given.
    axis : table, optional
        y, z (m) of the deck axis in the model. Those of the rail, or midway between left and right,
        if not given.
    supports : tuple of float
        m from the first node of the rail: bearing lines, only drawn.
    count : int, optional
        How many of the lowest modes that move the rail are kept; all if not given.
    unusual : bool
        Whether frequencies and masses beyond those of bridges are accepted.
    """

    __repr__ = brief

    nodes: str
    modes: str
    masses: str | None = None
    units: tuple[str | float, ...] | None = None
    axes: tuple[ModelAxis, ModelAxis, ModelAxis] = ("x", "y", "z")
    rail: NodeChoice | NodeRows | None = None
    axis: AxisPlace | None = None
    supports: Annotated[tuple[float, ...], Range(least=0.0, unit="m")] = ()
    count: Annotated[int, Range(least=1, whole=True)] | None = None
    unusual: bool = False

    def __post_init__(self) -> None:
        check_fields(self)
        if self.units is not None:
            model_units(self.units)
            object.__setattr__(self, "units", tuple(self.units))
        model_axes(self.axes)
        object.__setattr__(self, "axes", tuple(self.axes))
        # Tables of a deck file become what they stand for.
        if self.rail is not None:
            with within("rail"):
                object.__setattr__(self, "rail", node_choice(self.rail))
        if self.axis is not None:
            with within("axis"):
                object.__setattr__(self, "axis", axis_place(self.axis))

    def deck(self, damping: Damping | None = None, **own: Any) -> Deck:
        """Read the files and return the deck that their modes make.

        Parameters
        ----------
        damping : float, tuple of float, or ModalDamping, optional
            As for `Beam.deck`, instead of the file's own; needed where it has none.
        own
            ``name``, ``tracks``, ``width``, ``track_height``; see `deck_from_modes`.

        Raises
        ------
        InputError
            What `read_modes`, `Nodes.line` and `deck_from_modes` refuse, by the names of the fields
            of this table.
        """
        model = read_modes(self.nodes, self.modes, self.masses, self.units, self.axes)
        line = model.nodes.line(self.rail, self.axis)
        with within(names=_IN_THE_TABLE):
            return deck_from_modes(
                model,
                line,
                damping=damping,
                count=self.count,
                supports=self.supports,
                unusual=self.unusual,
                **own,
            )


# ---- tables as they stand in a deck file


def beside(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the content of a deck file with paths that can be opened from here.

    In the file they are relative to its folder.
    """
    own = content.get("modes")
    if not isinstance(own, dict):
        return content
    paths = {k: str(folder / own[k]) for k in _PATHS if isinstance(own.get(k), str)}
    return {**content, "modes": {**own, **paths}}


def sources(content: Mapping[str, Any]) -> dict[str, Path]:
    """Return the files that a deck file's modes are read from, by their keys."""
    own = content.get("modes")
    own = own if isinstance(own, Mapping) else {}
    return {k: Path(own[k]) for k in _PATHS if isinstance(own.get(k), str)}


def stamps(content: Mapping[str, Any]) -> list[int]:
    """Return times and sizes of the files that a deck file's modes are read from.

    When these change, a deck that was kept is out of date.
    """
    found = []
    for path in sources(content).values():
        with suppress(OSError, ValueError):  # reading it says what is wrong
            found.append(path.stat())
    return [n for s in found for n in (s.st_mtime_ns, s.st_size)]
