"""The frame that all reports share: the same sections in the same order, and the parts of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import errors
from ..cases.definition import Case
from ..decks import Deck
from ..errors import Remark
from ..trains import AnyTrain
from .assumptions import assumptions, left_out
from .document import Report
from .inputs import file_tables, modes_table, resolved_deck, resolved_train, tables_of_case
from .overspeeds import failures, key_peaks, peaks, pictures, whole
from .parts import Column, Notes, Section, Table, Words, in_km_h, shown
from .pictures import modes, sketches, track_picture
from .receipts import input_files, programs

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "about_speeds", "assumed", "framed", "in_short", "inputs_section", "key_table", "modes_section",
    "quiet", "results_over_speeds", "short_over_speeds", "speed_in_words", "train_in_words",
    "trains_table",
]  # fmt: skip


def framed(
    title: str,
    about: str,
    *,
    short: Section,
    verdicts: Section,
    inputs: Section,
    modes: Section,
    results: Sequence[Any],
    limits: Section,
    receipt: Sequence[Table],
    verdict: str = "",
) -> Report:
    """Return a report of these sections, in the order that all have.

    Parameters
    ----------
    title, about : str
    short, verdicts, inputs, modes, limits : Section
    results : sequence of parts
    receipt : sequence of Table
        Without that of the programs.
    verdict : str
    """
    sections = (
        short, verdicts, inputs, modes, Section("Results", tuple(results)), limits,
        Section("Receipt", (*receipt, programs())),
    )  # fmt: skip
    return Report(title, about, sections, verdict)


# ---- trains over speeds


def about_speeds(trains: Sequence[str], deck: Deck, speeds: Sequence[float]) -> str:
    """Return what a report of trains over speeds (m/s) is about."""
    ends = f"from {speed_in_words(speeds[0])} to {speed_in_words(speeds[-1])}"
    names = errors.counted([str(name) for name in trains], 4)
    return f"{names} over {deck.name}, {deck.length:g} m, at {len(speeds)} speeds {ends}"


def short_over_speeds(found: xr.Dataset, remarks: Sequence[Remark]) -> Section:
    """Return the section of what is read first of trains over speeds."""
    return in_short(key_table(key_peaks(found)), remarks, more=failures(found))


def results_over_speeds(found: xr.Dataset, deck: Deck) -> tuple[Any, ...]:
    """Return the results of trains over speeds."""
    return *peaks(found), *pictures(found, deck), whole(found)


# ---- sections and their parts


def train_in_words(train: AnyTrain) -> str:
    """Return what a train is made of."""
    kinds = train.kinds()
    if not kinds:
        name = getattr(train, "name", None)
        return name or f"A train of {len(train.formation[0].axles)} axles"
    counts = [f"{len(cars)} x {vehicle.name}" for vehicle, cars in kinds]
    return errors.counted(counts, 4)


def speed_in_words(speed: float) -> str:
    """Return a speed (m/s) in both units."""
    return f"{shown(float(speed))} m/s ({shown(in_km_h(speed))} km/h)"


def key_table(rows: Sequence[tuple[Any, ...]], time: str = "") -> Table:
    """Return the numbers that are looked at first; with their times where a unit is given."""
    heads = ["what", "value", "unit", "where", *([("at", time)] if time else [])]
    rows = rows if time else [row[:-1] for row in rows]
    note = "The deck's own weight is not in these numbers."
    return Table.of("in short", "The largest values", heads, rows, note=note)


def quiet(case: Case) -> list[Remark]:
    """Return what a deck says of itself, which no warning is."""
    return [remark.moved("deck") for remark in case.deck.remarks if not remark.warned]


def in_short(
    key: Table | None, remarks: Sequence[Remark], trouble: str = "", more: Sequence[Any] = ()
) -> Section:
    """Return the section of what is read first: trouble, doubts, numbers."""
    parts: list[Any] = [Words(trouble, "warning")] if trouble else []
    warned = list(dict.fromkeys(str(r) for r in remarks if r.warned))
    others = list(dict.fromkeys(str(r) for r in remarks if not r.warned))
    if warned:
        parts += [Words("Doubts and warnings:"), Notes(tuple(warned), "warning")]
    if key is not None:
        parts.append(key)
    parts += more
    if others:
        parts += [Words("To be known when reading the numbers:"), Notes(tuple(others))]
    if not remarks and not trouble:
        parts.append(Words("Nothing about the input or the numbers was found doubtful.", "note"))
    return Section("In short", tuple(parts))


def inputs_section(
    case: Case,
    trains: Mapping[str, AnyTrain],
    *,
    speeds: Sequence[float] | None = None,
    own_train: bool = True,
) -> Section:
    """Return the section of what was given: by a case, or trains in place of its own."""
    given = dict(case.content)
    hidden = [] if speeds is None else ["run.speed"]
    if not own_train:  # those of the envelope instead
        given.pop("train", None)
        hidden.append("train")
    parts: list[Any] = [*tables_of_case(case.content, hidden)]
    if speeds is not None:
        rows = [(i, float(v), in_km_h(v)) for i, v in enumerate(speeds, start=1)]
        heads = ["number", ("speed", "m/s"), ("speed", "km/h")]
        parts.append(Table.of("speeds", "Speeds", heads, rows, on_page=False))
    parts += [resolved_deck(case.deck), *file_tables(given)]
    if not own_train:
        parts.append(trains_table(trains))
    first = next(iter(trains.values()))
    if own_train:
        files = [path for role, path in input_files(given) if role == "vehicle"]
        known = bool(files) and all(path.suffix == ".csv" for path in files)
        parts += resolved_train(first, known)
    parts += sketches(first, case.deck)
    if not case.track.level:
        parts.append(track_picture(case.track, case.deck, case.settings.lead_in))
    return Section("Inputs", tuple(parts))


def trains_table(trains: Mapping[str, AnyTrain]) -> Table:
    """Return what trains by name are."""
    heads = [
        "train",
        "axles",
        ("length", "m"),
        ("heaviest axle", "kN"),
        ("all axles", "kN"),
        "kind",
    ]
    rows = []
    for name, train in trains.items():
        loads = [axle.static_load for car in train.formation for axle in car.axles]
        kind = "cars with suspension" if train.kinds() else "constant axle loads"
        length, most, weight = float(train.length), max(loads) / 1e3, sum(loads) / 1e3
        rows.append((name, len(loads), length, most, weight, kind))
    return Table.of("trains", "Trains", [Column(*h) if isinstance(h, tuple) else h for h in heads],
                    rows, note="Length: first to last axle.")  # fmt: skip


def modes_section(deck: Deck, up_to_hz: float = np.inf) -> Section:
    """Return the section of a deck's modes."""
    return Section("Modes of the deck", (modes_table(deck, up_to_hz), modes(deck)))


def assumed(case: Case, train: AnyTrain) -> Section:
    """Return the section of what holds for a case, and of what is left out."""
    held = assumptions(train, case.deck, case.track, case.settings)
    parts = (Notes(tuple(held)), Words("Not in this calculation:"), Notes(tuple(left_out())))
    return Section("Assumptions and limits", parts)
