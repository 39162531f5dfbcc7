"""Trains of bare axle loads by name and from files, and what there is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..codes.hslm import HSLM_A, hslm_a, hslm_b
from ..codes.wagons import LINE_CATEGORIES, wagon_train
from ..errors import InputError, brief, did_you_mean, within
from ..exchange.tables import Columns, read_columns
from ..trains import AxleTrain
from ..units import UNITS, G, per_metre, spelled
from . import shelf

__all__ = ["ListedTrain", "TrainList", "read_train", "train", "train_list"]

_HSLM_A = {f"HSLM-{name}": name for name in HSLM_A}
_BY_RULE = {
    **dict.fromkeys([*_HSLM_A, "HSLM-B"], "EN 1991-2:2003, 6.4.6.1.1"),
    **dict.fromkeys(LINE_CATEGORIES, "EN 15528:2021, Table A.1"),
}
"""Names of trains that a rule makes, with its source."""
_OPTIONS = {
    "wagons": ("is the number of wagons of a line category of EN 15528", LINE_CATEGORIES),
    "n": ("is the number of forces of HSLM-B", ("HSLM-B",)),
    "d": ("is the spacing of the forces of HSLM-B", ("HSLM-B",)),
}


def train(
    source: str | Path, *, wagons: int | None = None, n: int | None = None, d: float | None = None
) -> AxleTrain:
    """Return a train of bare axle loads by its name or from a CSV file.

    Parameters
    ----------
    source : str or Path
        ``HSLM-A1`` to ``HSLM-A10`` and ``HSLM-B`` (EN 1991-2); a line category of EN 15528, ``A``
        to ``E5``, which is a train of equal wagons; a file of ``data/trains`` (``ICE2``); or the
        path of a ``.csv`` file, see `read_train`. `train_list` shows them all.
    wagons : int, optional
        Of a line category; 20 if not given.
    n, d : optional
        Of HSLM-B, both needed; see `hslm_b`.

    Returns
    -------
    AxleTrain
        Constant forces: what a suspension would add is not in them.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), an option that is not this train's, or a bad file.
    """
    options = {"wagons": wagons, "n": n, "d": d}
    for option, value in options.items():
        what, names = _OPTIONS[option]
        if value is not None and not (isinstance(source, str) and source in names):
            raise InputError(option, value, f"{what}, this train has none", f"Remove {option}")
    if not isinstance(source, str) or source not in _BY_RULE:
        return read_train(_file(source))
    if source in shelf.data_names("trains", ".csv"):
        allowed = "is the name of a standard's train and of a file in data/trains"
        raise InputError("train", source, allowed, "Rename the file, or give its path")
    if source in _HSLM_A:
        return hslm_a(_HSLM_A[source])
    if source == "HSLM-B":
        return hslm_b(n, d)
    return wagon_train(source) if wagons is None else wagon_train(source, wagons)


def _file(source: Any) -> Path:
    """Return the file of a train; refuse a name that is neither a rule's nor a file's."""
    shipped = shelf.data_names("trains", ".csv")
    named = isinstance(source, str) and source.strip() and not shelf.is_path(source)
    if named and source not in shipped:
        near = did_you_mean(source, [*_BY_RULE, *shipped])
        raise InputError("train", source, "no such train", near)
    return shelf.data_file("trains", source, ".csv")


# ---- files


def read_train(path: str | Path) -> AxleTrain:
    """Read a train from a CSV file: one row an axle, front to back, units in the header.

    Either places or spacings, never both::

        # name: two wagons
        # source: drawing 12
        place(m), load(kN)
        0.0, 220
        1.8, 220

    A ``spacing`` is the distance to the axle before it, 0 or blank in the first row. Places may
    start anywhere. A load is a force (``kN``), or the mass on the axle (``t``, ``kg``), which is
    multiplied by g = 9.81 m/s2; both down positive.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    AxleTrain
        With the name that the file gives itself, else that of the file.

    Raises
    ------
    InputError
        With file, line and column: no number, an unknown unit, a load that is not above zero, an
        axle that is not behind the one before it, places beside spacings, or no axles.
    """
    return _read(path)[0]


def _read(path: str | Path) -> tuple[AxleTrain, str]:
    """Return a file's train, and the source that the file names."""
    optional = ["place", "spacing", "note"]
    table = read_columns(path, ["load"], optional, units_in_header=True)
    with within(source=table.name):
        given = [name for name in ("place", "spacing") if name in table.cells]
        if len(given) != 1:
            allowed = "are both given" if given else "are both missing or blank"
            remedy = "Give either the place of each axle or its spacing from the one before"
            raise InputError("columns place and spacing", None, allowed, remedy)
        places = (_places if given == ["place"] else _from_spacings)(table)
        loads = _loads(table)
        name = table.notes.get("name") or Path(path).stem
        return AxleTrain(places, loads, name), table.notes.get("source", "")


def _unit(table: Columns, column: str, example: str) -> str:
    """Return the unit of a column, spelled as the suite does."""
    unit = spelled(table.column_units.get(column, ""))
    if not unit:
        remedy = f"Write {column} ({example}) in the header"
        raise InputError(f"column {column}", None, "has no unit", remedy)
    return unit


def _lengths(table: Columns, column: str) -> tuple[list[tuple[str, str, float]], str]:
    """Return field, cell and number (m) of each row of a column, and its unit."""
    unit = _unit(table, column, "m")
    if unit not in UNITS["length"]:
        allowed = "must be one of " + ", ".join(UNITS["length"])
        remedy = "Correct the unit, and the numbers with it"
        raise InputError(f"column {column} (unit)", unit, allowed, remedy)
    rows = []
    for line, cell in zip(table.lines, table.cells[column], strict=True):
        field = f"line {line}: {column}"
        blank = column == "spacing" and not rows and not cell
        rows.append((field, cell, 0.0 if blank else table.number(field, cell) / per_metre(unit)))
    return rows, unit


def _places(table: Columns) -> list[float]:
    """Return the places of a file, m behind its first axle."""
    rows, unit = _lengths(table, "place")
    for (_, before, previous), (field, cell, place), line in zip(
        rows, rows[1:], table.lines, strict=False
    ):
        if place <= previous:
            allowed = f"must be above {before} {unit}, the place of the axle in line {line}"
            remedy = "List axles from front to back; loads at one place are one axle, add them up"
            raise InputError(field, cell, allowed, remedy)
    first = rows[0][2]
    return [place - first for _, _, place in rows]


def _from_spacings(table: Columns) -> list[float]:
    """Return the places that the spacings of a file make, m behind its first axle."""
    rows, unit = _lengths(table, "spacing")
    field, cell, first = rows[0]
    if first != 0.0:
        allowed = "must be 0 or blank in the first row, no axle stands before it"
        remedy = "The spacing of an axle is its distance to the one before, not to the next"
        raise InputError(field, cell, allowed, remedy)
    places = [0.0]
    for field, cell, spacing in rows[1:]:
        if spacing <= 0.0:
            remedy = "Loads at one place are one axle, add them up"
            raise InputError(field, cell, f"must be above 0 {unit}", remedy)
        places.append(places[-1] + spacing)
    return places


def _loads(table: Columns) -> list[float]:
    """Return the loads of a file, N: forces as they are, masses times g."""
    unit, forces, masses = _unit(table, "load", "kN"), UNITS["force"], UNITS["mass"]
    if unit not in {**forces, **masses}:
        allowed = f"must be a force ({', '.join(forces)}) or a mass ({', '.join(masses)})"
        remedy = "Correct the unit, and the numbers with it"
        raise InputError("column load (unit)", unit, allowed, remedy)
    factor = forces[unit] if unit in forces else masses[unit] * G
    loads = []
    for line, cell in zip(table.lines, table.cells["load"], strict=True):
        field = f"line {line}: load"
        number = table.number(field, cell)
        if number <= 0.0:
            remedy = "Loads are down positive; leave out an axle that carries nothing"
            raise InputError(field, cell, f"must be above 0 {unit}", remedy)
        loads.append(number * factor)
    return loads


# ---- what there is


@dataclass(frozen=True)
class ListedTrain:
    """A train that `train` knows by name.

    Attributes
    ----------
    name : str
        As `train` takes it.
    length : float
        First to last axle, m.
    weight : float
        All axles together, N.
    axles : int
        Their number.
    largest_load : float
        Of one axle, N.
    source : str
    """

    name: str
    length: float
    weight: float
    axles: int
    largest_load: float
    source: str


@dataclass(frozen=True)
class TrainList:
    """The trains that `train` knows by name.

    Attributes
    ----------
    trains : tuple of ListedTrain
    """

    __repr__ = brief

    trains: tuple[ListedTrain, ...]

    def __iter__(self) -> Iterator[ListedTrain]:
        return iter(self.trains)

    def __len__(self) -> int:
        return len(self.trains)

    @property
    def names(self) -> tuple[str, ...]:
        """As `train` takes them."""
        return tuple(listed.name for listed in self.trains)

    def to_frame(self):
        """Return a pandas DataFrame, one row a train."""
        import pandas as pd

        columns = {
            "length (m)": [t.length for t in self.trains],
            "weight (kN)": [t.weight / 1e3 for t in self.trains],
            "axles": [t.axles for t in self.trains],
            "largest axle load (kN)": [t.largest_load / 1e3 for t in self.trains],
            "source": [t.source for t in self.trains],
        }
        return pd.DataFrame(columns, index=pd.Index(self.names, name="train"))

    def _repr_html_(self) -> str:
        return self.to_frame().round(3).to_html()


def train_list() -> TrainList:
    """Return what trains there are by name: those of standards, and the files of ``data/trains``.

    Line categories of EN 15528 stand with 20 wagons. HSLM-B is not listed: its numbers belong to a
    span, see `hslm_b`.
    """
    found = [_listed(name, train(name), _BY_RULE[name]) for name in _BY_RULE if name != "HSLM-B"]
    for name in shelf.data_names("trains", ".csv"):
        found.append(_listed(name, *_read(shelf.data_file("trains", name, ".csv"))))
    return TrainList(tuple(found))


def _listed(name: str, made: AxleTrain, source: str) -> ListedTrain:
    return ListedTrain(
        name, made.length, made.weight, len(made.axles), max(made.loads), source or "not given"
    )
