"""Vehicles, trains, decks and tracks from the tables of files; nothing is computed here.

Tables are checked against their types first (`tables`). What the objects themselves refuse comes
in their own words; the path of the key is put in front here.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from .. import errors, exchange
from ..beams import Beam, Bearing, Pier, PointMass, Section
from ..boxes import Box, BoxMesh, Pads
from ..cautions import damping_constants, damping_frequencies
from ..contacts import Rail, Wheelset, on_wheelsets
from ..damping import Damping, rayleigh
from ..decks import Deck
from ..errors import InputError, Remark, ResultWarning, did_you_mean, plain, within
from ..exchange import ModesTable
from ..irregularities import Cosines, Dip, Joint, RecordedRail, TrackRecord, Weld
from ..tracks import Harmonic, Irregularity, Level, Notch, Rails, Track
from ..tracks import Table as MeasuredTrack
from ..trains import AnyTrain, AxleTrain, Train
from ..vehicles import AntiRollBar, Body, Spring, Vehicle
from . import shelf, tables
from .axletrains import train
from .cars import CAR_PARAMETERS, OPTIONAL_PARAMETERS, two_bogie_car
from .randomness import random_rail
from .tabletypes import Table, checked
from .trackfiles import track_record

__all__ = [
    "box", "box_from_table", "car_parameters", "deck", "deck_from_table", "deck_of_case",
    "track_of_case", "train_of_case", "varied_car", "vehicle", "words_of_deck",
]  # fmt: skip

# ---- vehicles


def vehicle(source: str | Path) -> Vehicle:
    """Load a vehicle by shipped name (``xia2000``) or from a ``.csv`` or ``.toml`` file.

    A CSV file is a two-bogie car's parameter table like Table 1; a TOML file lists the bodies and
    springs of any linear vehicle. Both are described in the README.

    Raises
    ------
    InputError
        Unknown name, a name that exists as both CSV and TOML, or bad content.
    """
    path = shelf.data_file("vehicles", source)
    if path.suffix == ".csv":
        with within(source=path.name):
            return two_bogie_car(path.stem, **car_parameters(path))
    content = shelf.read_toml(path, tables.VEHICLE.model_fields)
    names = {
        "bodies": "body", "springs": "spring", "wheelsets": "wheelset",
        "anti_roll_bars": "anti_roll_bar",
    }  # fmt: skip
    with within("", names, path.name):
        return _vehicle_from_table(path.stem, content)


def car_parameters(source: str | Path) -> dict[str, float]:
    """Return the parameters of a two-bogie car's table (Table 1), SI, by name.

    Parameters
    ----------
    source : str or Path
        A shipped name (``xia2000``) or a ``.csv`` file.
    """
    units = {name: bounds.unit for name, bounds in CAR_PARAMETERS.items()}
    path = shelf.data_file("vehicles", source)
    return shelf.read_parameters(path, units, OPTIONAL_PARAMETERS)


def varied_car(source: str | Path, **factors: float) -> Vehicle:
    """Build a two-bogie car with some of the parameters of its table multiplied.

    Parameters
    ----------
    source : str or Path
        As for `car_parameters`.
    **factors : float
        By the name that the parameter has in the table: ``car_body_mass=1.3`` makes the car body
        30 % heavier. Those that are not named stay as they are.

    Returns
    -------
    Vehicle

    Raises
    ------
    InputError
        A name that the table does not have (the nearest is suggested), a factor that is negative or
        no number, or a car that cannot be.
    """
    parameters = car_parameters(source)
    for name, factor in factors.items():
        if name not in parameters:
            near = did_you_mean(name, parameters)
            raise InputError(name, factor, "is no parameter of this car", near, str(source))
        parameters[name] *= errors.number(name, factor, least=0.0)
    return two_bogie_car(f"{Path(source).stem} varied", **parameters)


def _vehicle_from_table(name: str, content: dict[str, Any]) -> Vehicle:
    t = checked(tables.VEHICLE, content)
    bodies = _made(Body, "body", t.body, {"inertia": (0.0, 0.0, 0.0)})
    springs = _made(Spring, "spring", t.spring, {"damping": (0.0, 0.0)})
    bars = _made(AntiRollBar, "anti_roll_bar", t.anti_roll_bar or [])
    wheelsets = _made(Wheelset, "wheelset", t.wheelset or [])
    mass = t.static_wheelset_mass
    if not wheelsets:
        return Vehicle(name, bodies, springs, t.length, mass, bars)
    if mass:
        allowed = "the wheelsets are given as bodies, never both"
        raise InputError("static_wheelset_mass", mass, allowed, "Remove it, or the wheelsets")
    return on_wheelsets(name, bodies, springs, wheelsets, t.length, bars)


def _made(
    kind: type, path: str, given: Iterable[Table], defaults: Mapping[str, Any] | None = None
) -> tuple:
    """Return the objects that the tables of one list become."""
    result = []
    for i, own in enumerate(given, start=1):
        with within(f"{path}[{i}]", {"from_": "from"}):
            result.append(kind(**{**(defaults or {}), **own.given}))
    return tuple(result)


# ---- trains and tracks of cases


@lru_cache(maxsize=16)
def _cached_vehicle(path: Path, *_stamp: int) -> Vehicle:
    """Make a vehicle once; a file that has changed since is another vehicle."""
    return vehicle(path)


def _shelved_vehicle(path: str, name: Any) -> Vehicle:
    with within(path, {"vehicle": ""}):
        file = shelf.data_file("vehicles", name).resolve()
    stamp = file.stat()
    return _cached_vehicle(file, stamp.st_mtime_ns, stamp.st_size)


def train_of_case(t: Table) -> AnyTrain:
    """Return the train of a checked ``[train]``."""
    if isinstance(t, (tables.NAMED, tables.FROM_FILE)):
        return _axle_train(t)
    if t.has("axles"):
        with within("train"):
            return AxleTrain(t.axles, t.loads)
    notches = []
    for i, notch in enumerate(t.notch or [], start=1):
        with within(f"train.notch[{i}]"):
            notches.append(Notch(**notch.given))
    if isinstance(t.cars, list):
        vehicles: list[Vehicle] = []
        for i, car in enumerate(t.cars[:1001], start=1):
            path = f"train.cars[{i}]"
            if isinstance(car, Table):
                vehicles += [_shelved_vehicle(f"{path}.vehicle", car.vehicle)] * car.count
            else:
                vehicles.append(_shelved_vehicle(path, car))
        if not 1 <= len(vehicles) <= 1000:
            raise InputError("train.cars", len(vehicles), "must be 1 to 1000 cars in all")
        rolling = {"vehicle": tuple(vehicles)}
    else:
        rolling = {"vehicle": _shelved_vehicle("train.vehicle", t.vehicle), "cars": t.cars}
    with within("train", {"notches": "notch"}):
        return Train(**rolling, car_spacing=t.car_spacing, notches=tuple(notches))


def _axle_train(t: Table) -> AnyTrain:
    """Return the bare axle loads that a ``[train]`` names, or of the file that it names."""
    key = "name" if isinstance(t, tables.NAMED) else "file"
    given = getattr(t, key)
    if key == "file" and isinstance(given, str) and not shelf.is_path(given):
        remedy = "Write its ending, .csv; what has a name only is train.name"
        raise InputError("train.file", given, "is no path of a file", remedy)
    if key == "name" and isinstance(given, str) and shelf.is_path(given):
        remedy = "Write train.file for the path of a file"
        raise InputError("train.name", given, "is the path of a file", remedy)
    options = {name: v for name, v in t.given.items() if name in ("wagons", "n", "d")}
    with within("train", {"train": key}):
        return train(given, **options)


@lru_cache(maxsize=16)
def _cached_record(path: Path, options: tuple[tuple[str, Any], ...], *_stamp: int) -> TrackRecord:
    """Read a measured track once; a file that has changed since is another one."""
    return track_record(path, **dict(options))


def track_of_case(t: Table | None) -> Track:
    """Return the track of a checked ``[track]``; perfect rails if there is none."""
    given = {} if t is None else t.given
    return Track(**{name: _rails(name, value) for name, value in given.items()})


def _rails(direction: str, t: Any) -> Any:
    path = f"track.{direction}"
    if isinstance(t, tables.RAILS):
        return Rails(
            **{side: _irregularity(f"{path}.{side}", v, side) for side, v in t.given.items()}
        )
    left, right = (_irregularity(path, t, side) for side in ("left", "right"))
    return Rails(left, right) if _differs(left, right) else left


def _differs(left: Any, right: Any) -> bool:
    """Whether a recorded or a random rail makes the two rails differ."""
    if isinstance(left, list):
        return any(map(_differs, left, right))
    return isinstance(left, (RecordedRail, Cosines)) and left is not right


_IRREGULARITIES = {
    "none": Level, "harmonic": Harmonic, "table": MeasuredTrack, "dip": Dip, "joint": Joint,
    "weld": Weld,
}  # fmt: skip


def _irregularity(path: str, t: Any, side: str) -> Irregularity | list:
    if isinstance(t, list):
        return [_irregularity(f"{path}[{i}]", part, side) for i, part in enumerate(t, start=1)]
    given = t.given
    kind = given.pop("kind")
    if kind in ("file", "random"):
        return (_recorded if kind == "file" else random_rail)(path, given, side)
    with within(path):
        return _IRREGULARITIES[kind](**given)


def _recorded(path: str, given: dict[str, Any], side: str) -> Irregularity:
    """Return one rail of a measured track, in the direction that the path says."""
    with within(path, {"track": "file"}):
        file = shelf.data_file("tracks", given.pop("file"), ".csv").resolve()
        stamp = file.stat()
        record = _cached_record(file, tuple(given.items()), stamp.st_mtime_ns, stamp.st_size)
        found = record.lateral if path.startswith("track.lateral") else record.vertical
        if found is None:
            allowed = "holds no columns of this direction"
            raise InputError("file", file.name, allowed, "See railbridge.track_record")
    return getattr(found, side) if isinstance(found, Rails) else found


# ---- decks


def deck(source: str | Path, rail: Rail | None = None) -> Deck:
    """Load a deck by shipped name (``viaduct36``) or from a ``.toml`` file.

    Parameters
    ----------
    source : str or Path
    rail : Rail, optional
        How rails spread loads, instead of the file's own.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), or bad content.
    """
    path = shelf.data_file("decks", source, ".toml")
    content = exchange.beside(shelf.read_toml(path, tables.DECK_KEYS), path.parent)
    with within(source=path.name):
        made = _deck_from_table(path.stem, content)
    return made if rail is None else replace(made, rail=rail)


def box(source: str | Path) -> Box:
    """Load a box by the shipped name of its deck file or from a ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name, a deck file without the table ``[box]``, or bad content.
    """
    path = shelf.data_file("decks", source, ".toml")
    content = shelf.read_toml(path, tables.DECK_KEYS)
    with within(source=path.name):
        if "box" not in content:
            allowed = "this deck file has no such table"
            raise InputError("box", None, allowed, "A box needs its dimensions")
        return _box(path.stem, checked(tables.DECK_FILE, content))


def box_from_table(name: str, content: dict[str, Any]) -> Box:
    """Build a box from the content of a deck file with the table ``[box]``."""
    with within(source=f"deck {errors.text('name', name)}"):
        return _box(name, checked(tables.DECK_FILE, content))


def deck_from_table(name: str, content: dict[str, Any]) -> Deck:
    """Build a modal deck from the content of a deck file.

    Its keys are those of a case's ``[deck]``, without ``file``: see docs/case.md.

    Raises
    ------
    InputError
        Missing, unknown, contradictory or wrong keys, or a mechanism.
    """
    with within(source=f"deck {errors.text('name', name)}"):
        return _deck_from_table(name, content)


_GIVEN_BY = {
    "section": ("section.second_moment_vertical", "section"),
    "box": ("box", "box"),
    "modes": ("modes", "modes"),
}
"""What of a deck's table its frequencies follow from, and what its mass."""


_DAMPING_KEYS = ("modal", "per_mode", "ratio", "alpha", "beta")
"""What damping ratios follow from, the first that is given."""


def words_of_deck(content: Mapping[str, Any]) -> dict[str, str]:
    """Return what a case's ``[deck]``, or the file it names, calls the properties of a `Deck`."""
    with within("deck.file", {"deck": ""}):
        own = _own(content["file"])[1] | dict(content) if "file" in content else content
    words = {"deck.spans": "deck.length"} if "length" in own else {"deck.length": "deck.spans"}
    for key, (stiffness, mass) in _GIVEN_BY.items():
        if isinstance(own.get(key), Mapping):
            words |= {"deck.bending_stiffness_vertical": f"deck.{stiffness}"}
            words |= {"deck.frequencies_hz": f"deck.{stiffness}"}
            words |= {"deck.mass": f"deck.{mass}", "deck.mass_per_metre": f"deck.{mass}"}
    if isinstance(own.get("section"), Mapping):
        words["deck.torsional_stiffness"] = "deck.section.torsion_constant"
        words["deck.bending_stiffness_lateral"] = "deck.section.second_moment_lateral"
    damping = own.get("damping", {})
    ratio = next((f"damping.{k}" for k in _DAMPING_KEYS if k in damping), "modes")
    return words | {"deck.damping_ratios": f"deck.{ratio}"}


def _own(name: str) -> tuple[Path, dict[str, Any]]:
    """Return the path of a deck file and its content, with paths that can be opened from here."""
    path = shelf.data_file("decks", name, ".toml")
    return path, exchange.beside(shelf.read_toml(path, tables.DECK_KEYS), path.parent)


def deck_of_case(content: Mapping[str, Any]) -> Deck:
    """Return the deck of a case's ``[deck]``, made once for every content."""
    t = checked(tables.DECK, content, "deck")
    if not isinstance(t, tables.SHIPPED):
        name = content.get("name")
        name = name if isinstance(name, str) and name.strip() else "deck"
        with within("deck"):
            key = json.dumps(content, sort_keys=True)
            return _cached_deck(name, key, *exchange.stamps(content))
    with within("deck.file", {"deck": ""}):
        path, own = _own(t.file)
    if t.has("rail"):
        with within("deck.rail"):  # refused as the case's, not as the file's
            Rail(**t.rail.given)
    replaced = {name: value for name, value in content.items() if name != "file"}
    if isinstance(own.get("modes"), dict) and "modes" in replaced:
        # A number of modes beside another program's modes means how many of them.
        replaced["modes"] = {**own["modes"], "count": replaced["modes"]}
    with within(source=path.name):
        key = json.dumps(plain("", own | replaced), sort_keys=True)
        return _cached_deck(path.stem, key, *exchange.stamps(own))


@lru_cache(maxsize=16)
def _cached_deck(name: str, content: str, *_stamps: int) -> Deck:
    """Make a deck once: a slider that changes the speed must not assemble it again.

    Changed files make another deck.
    """
    return _deck_from_table(name, json.loads(content))


def _deck_from_table(name: str, content: Mapping[str, Any]) -> Deck:
    t = checked(tables.DECK_FILE, content)
    made = _without_rail(name, t)
    if not t.has("rail"):
        return made
    with within("rail"):
        rail = Rail(**t.rail.given)
    return replace(made, rail=rail)


def _without_rail(name: str, t: Table) -> Deck:
    if isinstance(t, tables.MODAL_DECK):
        return _modal_deck(name, t)
    if isinstance(t, tables.BOX_DECK):
        with within(names=_IN_A_BOX_DECK):
            return _box_deck(name, t)
    return _beam_deck(name, t)


_LISTS = {"bearings": "bearing", "point_masses": "point_mass"}
"""What a deck file calls the lists of a beam."""


def _beam_deck(name: str, t: Table) -> Deck:
    properties = {key: getattr(t, key) for key in ("mass", *tables.STIFFNESSES) if t.has(key)}
    doubted: list[Remark] = []
    if t.has("section"):
        with within("section"):
            section = Section(**t.section.given)
            properties = section.of_beam(t.rotary_inertia)
        doubted += [remark.moved("section") for remark in section.remarks]
    bearings = []
    for i, bearing in enumerate(t.bearing or [], start=1):
        with within(f"bearing[{i}]"):
            given = {"fixed": ()} | bearing.given
            if bearing.has("pier"):
                with within("pier"):
                    given["pier"] = Pier(**bearing.pier.given)
            bearings.append(Bearing(**given))
            _refuse_beside(bearings[-1].y, t.width)
    with within(names=_LISTS):
        beam = Beam(
            name,
            t.all_spans,
            bearings=tuple(bearings),
            point_masses=_made(PointMass, "point_mass", t.point_mass or []),
            elements=t.elements,
            continuous=t.continuous,
            centroid_height=t.centroid_height,
            **properties,
        )
        made = beam.deck(t.modes, _damping(t), _tracks(t), t.width, t.track_height)
    # What follows from the section is doubted there.
    derived = ("mass", *tables.STIFFNESSES) if t.has("section") else ()
    own = [remark for remark in beam.remarks if remark.field not in derived]
    doubted += [remark.moved(names=_LISTS) for remark in own]
    left_out = [remark for remark in made.remarks if isinstance(remark, ResultWarning)]
    return _doubted(replace(made, remarks=tuple(left_out)), t, doubted)


def _doubted(deck: Deck, t: Table, found: Iterable[Remark] = ()) -> Deck:
    """Return a deck with what its table makes doubtful, in the table's words."""
    deck = replace(deck, remarks=(*deck.remarks, *found))
    if isinstance(t.damping, tables.RAYLEIGH):
        given = t.damping.frequencies_hz
        doubted = damping_frequencies("damping.frequencies_hz", given, deck)
    elif isinstance(t.damping, tables.CONSTANTS):
        doubted = damping_constants("damping", t.damping.alpha, t.damping.beta, deck)
    else:
        return deck
    return replace(deck, remarks=(*deck.remarks, *doubted))


def _refuse_beside(y: float, width: float | None) -> None:
    if width is not None and abs(y) > width / 2 + 1e-9:
        allowed = f"is off the deck, half width {width / 2:g} m"
        raise InputError("y", y, allowed, "Move the bearing below the deck, or correct the width")


def _tracks(t: Table) -> dict[str, float]:
    """Return the named tracks, m; refuse one beside the deck."""
    half, remedy = (t.width or 0.0) / 2, "Tracks lie on the deck, correct the width"
    if t.width is not None:
        for name, y in (t.tracks or {}).items():
            errors.place(f"tracks.{name}", y, (-half, half), remedy=remedy)
    return t.tracks or {}


def _damping(t: Table) -> Damping:
    given = t.damping
    if isinstance(given, tables.MODAL):
        return given.modal
    if isinstance(given, tables.PER_MODE):
        return given.per_mode
    if isinstance(given, tables.CONSTANTS):
        return given.alpha, given.beta
    with within("damping"):
        return rayleigh(given.ratio, given.frequencies_hz)


_IN_A_BOX_DECK = {**_LISTS, "pads": "bearing"} | {
    dimension: f"box.{dimension}" for dimension in tables.DIMENSIONS
}
"""What a deck file calls the fields of a box, and what its shell stands on."""


def _box(name: str, t: Table) -> Box:
    pads = []
    for i, line in enumerate(t.bearing or [], start=1):
        with within(f"bearing[{i}]"):
            pads.append(Pads(**{"fixed": ()} | line.given))
    with within(names=_IN_A_BOX_DECK):
        return Box(name, t.all_spans, bearings=tuple(pads), tracks=t.tracks or {}, **t.box.given)


def _box_deck(name: str, t: Table) -> Deck:
    girder = _box(name, t)
    if t.model == "shell":
        with within("mesh"):
            mesh = BoxMesh(**(t.mesh.given if t.mesh else {}))
        made = girder.shell_deck(t.modes, _damping(t), mesh)
    else:
        switches = {key: getattr(t, key) for key in ("shear", "rotary_inertia") if t.has(key)}
        masses = _made(PointMass, "point_mass", t.point_mass or [])
        made = girder.beam_deck(t.modes, _damping(t), point_masses=masses, **switches)
    places = {**_LISTS, **{name: f"box.{name}" for name in tables.DIMENSIONS}}
    moved = [remark.moved(names=places) for remark in made.remarks]
    return _doubted(replace(made, remarks=()), t, moved)


def _modal_deck(name: str, t: Table) -> Deck:
    damping = _damping(t) if t.damping else None
    own = {"name": name, "tracks": _tracks(t), "width": t.width, "track_height": t.track_height}
    with within("modes"):
        made = ModesTable(**t.modes.given).deck(damping, **own)
    return _doubted(made, t)
