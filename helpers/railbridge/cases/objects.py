"""Decks as data: the deck files of ``data/decks`` and the ``[deck]`` of a case.

A deck file says which maker builds the modal deck: a beam from a section or from stiffnesses, the dimensions of a box as a
beam or as a shell, or another program's modes.
"""

from __future__ import annotations

from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from .. import errors
from ..beams.beam import Beam, spans_of
from ..beams.bearings import FARTHEST, Bearing, tables
from ..boxes import Box, BoxMesh, Pads
from ..boxes.pads import DIRECTIONS
from ..decks import Deck, rayleigh
from ..errors import InputError
from ..exchange import ModesTable, beside
from ..vehicles import CAR_PARAMETERS, FREEDOMS, Body, Spring, Vehicle, two_bogie_car
from . import shelf

__all__ = ["box", "box_from_table", "deck", "deck_from_table", "from_table", "vehicle"]

_STIFFNESSES = (
    "bending_stiffness_vertical",
    "bending_stiffness_lateral",
    "torsional_stiffness",
    "axial_stiffness",
    "polar_inertia",
    "shear_stiffness_vertical",
    "shear_stiffness_lateral",
    "rotary_inertia_vertical",
    "rotary_inertia_lateral",
)
_SECTION = (
    "youngs_modulus",
    "poisson_ratio",
    "density",
    "area",
    "second_moment_vertical",
    "second_moment_lateral",
    "torsion_constant",
)
_SHEAR_AREAS = ("shear_area_vertical", "shear_area_lateral")
_BEAM_KEYS = (
    "length", "spans", "section", *_STIFFNESSES, "mass", "damping", "modes", "bearing", "tracks", "width", "elements",
    "continuous", "rotary_inertia", "centroid_height", "track_height", "name", "source", "note",
)  # fmt: skip
_MODAL_KEYS = (
    "modes", "damping", "tracks", "width", "track_height", "name", "source", "note",
)  # fmt: skip
_BOX_KEYS = (
    "length", "spans", "box", "model", "mesh", "shear", "rotary_inertia", "damping", "modes", "bearing", "tracks", "name",
    "source", "note",
)  # fmt: skip


def deck_from_table(name: str, content: dict[str, Any]) -> Deck:
    """Build a modal deck from the content of a deck file or of a case's ``[deck]``.

    A beam's keys: ``length`` or ``spans`` (m) and ``continuous``; either ``[section]`` (E, nu, density, A, I_y, I_z, J, shear
    areas) or stiffnesses and ``mass``; ``damping`` = {ratio, frequencies_hz} (Rayleigh) or {modal}; ``modes``; ``[[bearing]]``
    x, y, z, fixed, stiffness, span; ``rotary_inertia``; ``centroid_height``; ``tracks``, ``width``, ``track_height``.
    With the table ``[box]`` the deck is a box girder, ``model`` = "beam" (with ``shear``, ``rotary_inertia``) or "shell" (with
    ``[mesh]``); see `box`. With ``modes`` as a table the deck comes from another program's modes; see `exchange`.

    Raises
    ------
    InputError
        Missing, unknown, contradictory or wrong keys, or a mechanism.
    """
    where = f"deck {name}" if name != "deck" else name
    if isinstance(content.get("modes"), dict):
        return _from_modes(where, name, content)
    return _from_box(where, name, content) if "box" in content else _from_beam(where, name, content)


def _from_box(where: str, name: str, content: dict[str, Any]) -> Deck:
    """Build a deck from the dimensions of a box girder; see `box`."""
    errors.keys(where, content, _BOX_KEYS, ["box", "damping"])
    girder = box_from_table(name, content)
    damping = _damping(where, errors.table(f"{where}: damping", content["damping"]))
    if errors.choice(f"{where}: model", content.get("model", "beam"), ("beam", "shell")) == "shell":
        for key in ("shear", "rotary_inertia"):
            if key in content:
                raise InputError(f"{where}: {key}", content[key], "is a switch of the beam model", "Remove it, a shell has both")
        mesh = errors.table(f"{where}: mesh", content.get("mesh", {}))
        errors.keys(f"{where}: mesh", mesh, [f.name for f in fields(BoxMesh)])
        return girder.shell_deck(content.get("modes", 15), damping, BoxMesh(**mesh))
    if "mesh" in content:
        raise InputError(f"{where}: mesh", content["mesh"], "belongs to the shell model", 'Remove it, or set model = "shell"')
    switches = {k: errors.boolean(f"{where}: {k}", content[k]) for k in ("shear", "rotary_inertia") if k in content}
    return girder.beam_deck(content.get("modes", 20), damping, **switches)


def _from_beam(where: str, name: str, content: dict[str, Any]) -> Deck:
    """Build a deck from beam elements; see `beam`."""
    errors.keys(where, content, _BEAM_KEYS, ["damping"])
    spans = spans_of(where, content)
    tracks, width = _tracks(where, content)
    beam = Beam(
        name,
        spans,
        bearings=bearings(where, content.get("bearing", []), width),
        elements=content.get("elements"),
        continuous=content.get("continuous", True),
        centroid_height=content.get("centroid_height", 0.0),
        **_properties(where, content),
    )
    damping = _damping(where, errors.table(f"{where}: damping", content["damping"]))
    return beam.deck(content.get("modes", 20), damping, tracks, width, track_height(where, content))


def _properties(where: str, content: dict[str, Any]) -> dict[str, float]:
    """Return a beam's mass, stiffnesses and inertias, from a section or as they are given."""
    if ("section" in content) == ("mass" in content):
        raise InputError(f"{where}: section", None, "give either a section or stiffnesses with mass, never both")
    rotary = content.get("rotary_inertia", False)
    if not isinstance(rotary, bool):
        raise InputError(f"{where}: rotary_inertia", rotary, "must be true or false")
    if "section" in content:
        clash = [k for k in _STIFFNESSES if k in content]
        if clash:
            raise InputError(f"{where}: {clash[0]}", content[clash[0]], "a section is given too, never both", "Remove one")
        return _from_section(f"{where}: section", errors.table(f"{where}: section", content["section"]), rotary)
    errors.keys(where, content, content, ["bending_stiffness_vertical"])
    if rotary:
        remedy = "Give rotary_inertia_vertical and rotary_inertia_lateral, kg m"
        raise InputError(f"{where}: rotary_inertia", rotary, "follows from a section only", remedy)
    return {k: content[k] for k in (*_STIFFNESSES, "mass") if k in content}


def bearings(where: str, given: Any, width: float | None = None) -> tuple[Bearing, ...]:
    """Return the bearings of a deck file's ``[[bearing]]``; none given, none returned.

    Parameters
    ----------
    where : str
        Of the deck, for errors.
    given : list of tables
        Each with x (m), y, z (m from the deck axis), fixed ("x y z"), stiffness (N/m, N m/rad by name) and span.
    width : float, optional
        Of the deck, m: bearings must stand below it.

    Raises
    ------
    InputError
    """
    result = []
    for here, content in tables(where, given, ["fixed", "y", "z", "stiffness", "span"]):
        bearing = _bearing(here, content)
        if width is not None and abs(bearing.y) > width / 2:
            off = f"is off the deck, half width {width / 2:g} m"
            raise InputError(f"{here}: y", bearing.y, off, "Move the bearing below the deck, or correct the width")
        result.append(bearing)
    return tuple(result)


def track_height(where: str, content: dict[str, Any]) -> float:
    """Return the height of the rails above the deck axis, m."""
    return errors.number(f"{where}: track_height", content.get("track_height", 0.0), least=-FARTHEST, most=FARTHEST, unit="m")


def _from_modes(where: str, name: str, content: dict[str, Any]) -> Deck:
    """Build a deck of which only the modes are known; see `exchange`."""
    errors.keys(where, content, _MODAL_KEYS)
    tracks, width = _tracks(where, content)
    damping = _damping(where, errors.table(f"{where}: damping", content["damping"])) if "damping" in content else None
    own = {"name": name, "tracks": tracks, "width": width, "track_height": track_height(where, content)}
    names = [f.name for f in fields(ModesTable)]
    errors.keys(f"{where}: modes", content["modes"], names, ["nodes", "modes"])
    with errors.within(f"{where}: modes"):
        return ModesTable(**content["modes"]).deck(damping, **own)


def _tracks(where: str, content: dict[str, Any]) -> tuple[dict[str, float], float | None]:
    """Return the named tracks and the width they must lie on, m."""
    width = content.get("width")
    width = None if width is None else errors.number(f"{where}: width", width, above=0.0, unit="m")
    tracks = errors.table(f"{where}: tracks", content.get("tracks", {}))
    half = width / 2 if width else None
    for key, y in tracks.items():
        errors.number(f"{where}: tracks.{key}", y, least=None if half is None else -half, most=half, unit="m")
    return tracks, width


def _from_section(where: str, s: dict[str, Any], rotary: bool) -> dict[str, float]:
    errors.keys(where, s, _SHEAR_AREAS, _SECTION)
    for key in s:
        if key != "poisson_ratio":
            errors.number(f"{where}.{key}", s[key], above=0.0)
    errors.number(f"{where}.poisson_ratio", s["poisson_ratio"], above=-1.0, most=0.5)
    e, density = s["youngs_modulus"], s["density"]
    shear_modulus = e / (2 * (1 + s["poisson_ratio"]))
    result = {
        "mass": density * s["area"],
        "bending_stiffness_vertical": e * s["second_moment_vertical"],
        "bending_stiffness_lateral": e * s["second_moment_lateral"],
        "torsional_stiffness": shear_modulus * s["torsion_constant"],
        "axial_stiffness": e * s["area"],
        "polar_inertia": density * (s["second_moment_vertical"] + s["second_moment_lateral"]),
    }
    for direction in ("vertical", "lateral"):
        if f"shear_area_{direction}" in s:
            result[f"shear_stiffness_{direction}"] = shear_modulus * s[f"shear_area_{direction}"]
        if rotary:
            result[f"rotary_inertia_{direction}"] = density * s[f"second_moment_{direction}"]
    return result


def _bearing(here: str, b: dict[str, Any]) -> Bearing:
    place = {key: errors.number(f"{here}: {key}", b[key], unit="m") for key in ("x", "y", "z") if key in b}
    springs = errors.table(f"{here}: stiffness", b.get("stiffness", {}))
    bearing = Bearing(fixed=b["fixed"], stiffness=springs, span=b.get("span"), **place)
    bearing.check(here)
    return bearing


def _damping(where: str, d: dict[str, Any]) -> tuple[float, float] | float:
    here = f"{where}: damping"
    if "modal" in d:
        errors.keys(here, d, [], ["modal"])
        return errors.number(f"{here}.modal", d["modal"], least=0.0, most=0.5)
    errors.keys(here, d, [], ["ratio", "frequencies_hz"])
    return rayleigh(d["ratio"], d["frequencies_hz"])


def deck(source: str | Path) -> Deck:
    """Load a deck by shipped name (``viaduct36``) or from a ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), or bad content.
    """
    path = shelf.data_file("decks", source)
    if path.suffix != ".toml":
        raise InputError("deck", str(source), "deck files are TOML")
    return deck_from_table(path.stem, beside(shelf.read_toml(path), path.parent))


_DIMENSIONS = tuple(f.name for f in fields(Box) if f.name not in ("name", "spans", "bearings", "tracks"))
_NEEDED = tuple(f.name for f in fields(Box) if f.default is MISSING and f.default_factory is MISSING and f.name in _DIMENSIONS)


def box(source: str | Path) -> Box:
    """Load a box by the shipped name of its deck file (``viaduct36_identified``) or from a ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name, a deck file without the table ``[box]``, or bad content.
    """
    path = shelf.data_file("decks", source)
    content = shelf.read_toml(path) if path.suffix == ".toml" else {}
    if "box" not in content:
        raise InputError("box", str(source), "this deck file has no table [box]", "A box needs its dimensions")
    return box_from_table(path.stem, content)


def box_from_table(name: str, content: dict[str, Any]) -> Box:
    """Build a box from the content of a deck file: ``length`` or ``spans``, ``[box]``, ``[[bearing]]``, ``[tracks]``.

    Raises
    ------
    InputError
        Missing, unknown or wrong keys; see `Box`.
    """
    where = f"box {name}"
    dimensions = errors.table(f"{where}: box", content["box"])
    errors.keys(f"{where}: box", dimensions, _DIMENSIONS, _NEEDED)
    held = tables(where, content.get("bearing", []), [f.name for f in fields(Pads)], DIRECTIONS)
    return Box(
        name,
        spans_of(where, content),
        bearings=tuple(Pads(**pads) for _, pads in held),
        tracks=errors.table(f"{where}: tracks", content.get("tracks", {})),
        **dimensions,
    )


def vehicle(source: str | Path) -> Vehicle:
    """Load a vehicle by shipped name (``xia2000``) or from a ``.csv`` or ``.toml`` file.

    A CSV file is a two-bogie car's parameter table like Table 1; a TOML file lists the bodies and springs of any linear
    vehicle. Both are described in the README.

    Raises
    ------
    InputError
        Unknown name, a name that exists as both CSV and TOML, or bad content.
    """
    path = shelf.data_file("vehicles", source)
    if path.suffix == ".csv":
        return two_bogie_car(path.stem, **shelf.read_parameters(path, CAR_PARAMETERS))
    return from_table(path.stem, shelf.read_toml(path))


def from_table(name: str, content: dict) -> Vehicle:
    """Build a vehicle from the content of a TOML file: ``length``, ``[[body]]``, ``[[spring]]``.

    Raises
    ------
    InputError
        Missing, unknown or wrong keys, each named with its path.
    """
    where = f"vehicle {name}"
    errors.keys(where, content, ["name", "source", "note", "static_wheelset_mass"], ["length", "body", "spring"])
    bodies, springs = [], []
    for kind in ("body", "spring"):
        if not isinstance(content[kind], list) or not content[kind]:
            raise InputError(f"{where}: {kind}", content[kind], f"must be one or more [[{kind}]] tables")
    for i, raw in enumerate(content["body"], start=1):
        here = f"{where}: body {i}"
        b = errors.table(here, raw)
        errors.keys(here, b, ["inertia"], ["name", "mass", "position", "freedoms"])
        freedoms = b["freedoms"].split() if isinstance(b["freedoms"], str) else b["freedoms"]
        if not isinstance(freedoms, list) or not freedoms or len(set(map(str, freedoms))) != len(freedoms):
            raise InputError(f"{here}: freedoms", b["freedoms"], "must list each of " + " ".join(FREEDOMS) + " at most once")
        position = tuple(errors.numbers(f"{here}: position", b["position"], count=3))
        inertia = tuple(errors.numbers(f"{here}: inertia", b.get("inertia", [0.0, 0.0, 0.0]), count=3))
        bodies.append(Body(errors.text(f"{here}: name", b["name"]), b["mass"], inertia, position, tuple(freedoms)))
    for i, raw in enumerate(content["spring"], start=1):
        here = f"{where}: spring {i}"
        s = errors.table(here, raw)
        errors.keys(here, s, ["damping"], ["from", "to", "at", "stiffness"])
        at = tuple(errors.numbers(f"{here}: at", s["at"], count=3))
        pair = [tuple(errors.numbers(f"{here}: {w}", s.get(w, [0.0, 0.0]), count=2)) for w in ("stiffness", "damping")]
        springs.append(Spring(s["from"], s["to"], at, *pair))
    mass = content.get("static_wheelset_mass", 0.0)
    return Vehicle(name, tuple(bodies), tuple(springs), content["length"], mass)
