"""Inputs as tables: what was given, in its own words, and what became of it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .. import exchange
from ..cases import shelf, tables
from ..cases.tabletypes import Table as FileTable
from ..cases.tabletypes import checked
from ..codes import kept_modes
from ..decks import Deck
from ..errors import clipped
from ..exchange.tables import read_columns
from ..trains import AnyTrain, AxleTrain, Train
from ..vehicles import Vehicle
from .parts import Column, Table, exact
from .receipts import damping_in_words, input_files, names_only

__all__ = ["file_tables", "modes_table", "resolved_deck", "resolved_train", "tables_of_case"]

_LONGEST_VALUE = 400
"""Letters of a value as it is shown; a measured rail has thousands of numbers."""
_SENTENCES = 200
"""Letters of a meaning."""
_KEYS = ("key", "value", "meaning")
_MOST_KINDS = 4
"""Kinds of cars whose bodies and springs are shown."""


def tables_of_case(content: Mapping[str, Any], hidden: Collection[str] = ()) -> list[Table]:
    """Return the tables of a case as they were given, each key with its meaning.

    Parameters
    ----------
    content : mapping
    hidden : collection of str
        Tables and keys, as ``run.speed``, that do not count.
    """
    known = checked(tables.CASE, dict(content))
    found = []
    for name, given in content.items():
        rows = _rows("", names_only(given), getattr(known, name, None))
        rows = [row for row in rows if f"{name}.{row[0]}" not in hidden]
        if name in hidden or not rows:
            continue
        found.append(Table.of(f"case {name}", f"[{name}] of the case", _KEYS, rows))
    return found


def _rows(path: str, given: Any, typed: Any) -> Iterator[tuple[str, str, str]]:
    """Give key, value and meaning of all values in a table, tables inside it by their paths."""
    for key, value in given.items():
        name, about, inner = _field(typed, key)
        own = f"{path}.{key}" if path else key
        yield from _values(own, value, inner if name else None, about)


def _values(path: str, value: Any, typed: Any, about: str) -> Iterator[tuple[str, str, str]]:
    if isinstance(value, Mapping) and isinstance(typed, FileTable):
        yield from _rows(path, value, typed)
    elif (
        isinstance(value, list)
        and isinstance(typed, list)
        and len(value) == len(typed)
        and any(isinstance(part, FileTable) for part in typed)
    ):
        for i, (part, own) in enumerate(zip(value, typed, strict=True), start=1):
            yield from _values(f"{path}[{i}]", part, own, about)
    else:
        yield path, clipped(exact(value), _LONGEST_VALUE), about


def _field(typed: Any, key: str) -> tuple[str, str, Any]:
    """Return name, meaning and value of a key of a table; empty where its type is not known."""
    fields = type(typed).model_fields if isinstance(typed, FileTable) else {}
    for name, field in fields.items():
        if (field.alias or name) == key:
            return name, _brief(field.description or ""), getattr(typed, name)
    return "", "", None


def _brief(meaning: str) -> str:
    """Return the first sentences of a meaning."""
    text = meaning.replace("`", "")
    if len(text) <= _SENTENCES:
        return text
    whole = text[:_SENTENCES].rpartition(". ")[0]
    return f"{whole}." if whole else clipped(text, _SENTENCES)


# ---- files that a case refers to


def file_tables(content: Mapping[str, Any]) -> list[Table]:
    """Return the files of deck and vehicles that a case refers to, as tables."""
    found, count = [], 0
    for role, path in input_files(content):
        if role == "deck":
            own = exchange.beside(shelf.read_toml(path), path.parent)
            rows = list(_rows("", names_only(own), checked(tables.DECK_FILE, own)))
            found.append(Table.of("deck file", f"Deck file {path.name}", _KEYS, rows))
        elif role.startswith("vehicle") and count < _MOST_KINDS:
            count += 1
            found.append(_vehicle_file(path, f"vehicle file {count}"))
    return found


def _vehicle_file(path: Path, name: str) -> Table:
    title = f"Vehicle file {path.name}"
    if path.suffix == ".csv":
        columns = ["name", "value", "unit"]
        read = read_columns(path, columns, ["symbol", "source", "note"], may_be_empty=True)
        columns += [c for c in ("source", "note") if c in read.cells]
        rows = list(zip(*(read.cells[c] for c in columns), strict=True))
        rows = [
            [_written(cell) if c == "value" else cell for c, cell in zip(columns, row, strict=True)]
            for row in rows
        ]
        heads = [Column(c, digits=10) for c in columns]
        return Table.of(name, title, heads, rows)
    own = shelf.read_toml(path)
    typed = checked(tables.VEHICLE, own)
    # Bodies, springs and bars stand in tables of their own.
    plain = {key: value for key, value in own.items() if not isinstance(value, list)}
    return Table.of(name, title, _KEYS, list(_rows("", names_only(plain), typed)))


def _written(cell: str) -> Any:
    """Return a number of a file as a number."""
    try:
        return float(cell)
    except ValueError:
        return cell


# ---- what became of it


def resolved_deck(deck: Deck) -> Table:
    """Return the deck as it is computed."""
    mass = deck.mass_per_metre
    rows = [
        ("name", deck.name, ""),
        ("length", float(deck.length), "m"),
        ("bearing lines at", ", ".join(exact(x) for x in deck.supports) or None, "m"),
        ("width", deck.width, "m"),
        ("mass per metre", None if mass is None else mass / 1e3, "t/m"),
        ("tracks, left of the axis", _tracks(deck), "m"),
        ("modes", len(deck.frequencies_hz), ""),
        ("first frequency", float(deck.frequencies_hz[0]), "Hz"),
        ("last frequency", float(deck.frequencies_hz[-1]), "Hz"),
        ("damping", damping_in_words(deck), ""),
        ("rail that spreads loads", None if deck.rail is None else _rail(deck), ""),
    ]
    rows = [(what, value, unit if value is not None else "") for what, value, unit in rows]
    heads = ["what", Column("value", digits=5), "unit"]
    return Table.of("deck", "The deck as computed", heads, rows)


def _tracks(deck: Deck) -> str | None:
    return ", ".join(f"{name} {exact(y)}" for name, y in deck.tracks.items()) or None


def _rail(deck: Deck) -> str:
    given = {name: value for name, value in vars(deck.rail).items() if value is not None}
    return ", ".join(f"{name} = {exact(value)}" for name, value in given.items())


def resolved_train(train: AnyTrain, parameters: bool = False) -> list[Table]:
    """Return the train as it is computed: as a whole, and the bodies and springs of its cars.

    Parameters
    ----------
    train : AnyTrain
    parameters : bool
        Whether the cars' parameters stand on the page already: springs are in the workbook alone.
    """
    loads = [axle.static_load for car in train.formation for axle in car.axles]
    rows = [
        ("length, first to last axle", float(train.length), "m"),
        ("axles", len(loads), ""),
        ("heaviest axle, static", max(loads) / 1e3, "kN"),
        ("lightest axle, static", min(loads) / 1e3, "kN"),
        ("all axles together, static", sum(loads) / 1e3, "kN"),
    ]
    if isinstance(train, AxleTrain):
        rows.insert(0, ("bare axle loads", train.name or "of the case", ""))
    if isinstance(train, Train):
        kinds = train.kinds()
        named = ", ".join(f"{len(cars)} of {vehicle.name}" for vehicle, cars in kinds)
        rows.insert(0, ("cars", named, ""))
        if train.car_spacing is not None:
            rows.append(("between the middles of cars", float(train.car_spacing), "m"))
        if train.notches:
            rows.append(("notches in wheels", len(train.notches), ""))
    found = [
        Table.of(
            "train", "The train as computed", ["what", Column("value", digits=5), "unit"], rows
        )
    ]
    for number, (vehicle, _) in enumerate(train.kinds()[:_MOST_KINDS], start=1):
        found += [_bodies(vehicle, number), _springs(vehicle, number, not parameters)]
    return found


def _bodies(vehicle: Vehicle, number: int) -> Table:
    heads = ["body", ("mass", "t"), ("roll inertia", "t m2"), ("pitch inertia", "t m2"),
             ("yaw inertia", "t m2"), ("x", "m"), ("z", "m"), "freedoms"]  # fmt: skip
    rows = [
        (b.name, b.mass / 1e3, *(i / 1e3 for i in b.inertia), b.position[0], b.position[2],
         " ".join(b.freedoms))
        for b in vehicle.bodies
    ]  # fmt: skip
    note = "x forward from the middle of the car, z up from the rail."
    return Table.of(f"bodies {number}", f"Bodies of {vehicle.name}", heads, rows, note=note)


def _springs(vehicle: Vehicle, number: int, on_page: bool) -> Table:
    heads = ["from", "to", ("x", "m"), ("y", "m"), ("z", "m"), ("lateral stiffness", "kN/m"),
             ("vertical stiffness", "kN/m"), ("lateral damping", "kN s/m"),
             ("vertical damping", "kN s/m")]  # fmt: skip
    rows = [
        (s.from_, s.to, *s.at, *(k / 1e3 for k in s.stiffness), *(c / 1e3 for c in s.damping))
        for s in vehicle.springs
    ]
    title = f"Springs and dampers of {vehicle.name}"
    note = "Of each spring, not of an axle."
    return Table.of(f"springs {number}", title, heads, rows, note=note, on_page=on_page)


def modes_table(deck: Deck, up_to_hz: float = np.inf) -> Table:
    """Return frequency, damping and name of each mode, and which a code keeps in accelerations.

    The accelerations of the report are those of the modes up to a frequency, Hz.
    """
    kept = kept_modes(deck.frequencies_hz.tolist())
    limit = kept.limit
    rows = [
        (
            number, float(f), 100 * float(ratio), name,
            None if not limit.decided else number in kept.numbers,
        )
        for number, (f, ratio, name) in enumerate(
            zip(deck.frequencies_hz, deck.damping_ratios, deck.mode_names, strict=True), start=1
        )
    ]  # fmt: skip
    clause = limit.clause
    source = f"{clause.name} ({clause.edition}; {clause.source})"
    if limit.decided:
        note = f"Modes up to {float(limit):.4g} Hz are kept for accelerations by {source}"
        note += "" if kept.complete else "; there may be more of them than the deck has here"
        held = "all modes of the table" if np.isinf(up_to_hz) else f"those up to {up_to_hz:.4g} Hz"
        note += f". Accelerations in this report hold {held}, unless a verdict says otherwise."
    else:
        note = f"Which modes are kept for accelerations by {source}: cannot decide, {limit.reason}."
    heads = ["mode", ("frequency", "Hz"), Column("damping", "% of critical", 3), "name",
             "kept for accelerations"]  # fmt: skip
    return Table.of("modes", "Modes of the deck", heads, rows, note=note)
