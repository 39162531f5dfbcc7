"""Decks as data: the deck files of ``data/decks`` and the ``[deck]`` of a case.

A deck file says which maker builds the modal deck: a beam from a section or from stiffnesses, the dimensions of a box as a
beam or as a shell, or another program's modes.
"""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from . import exchange, inputs
from .beam import Beam, spans_of
from .bearings import FARTHEST, Bearing, tables
from .box import BoxMesh, box_from_table
from .deck import Deck, rayleigh
from .inputs import InputError

__all__ = ["deck", "deck_from_table"]

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
    inputs.keys(where, content, _BOX_KEYS, ["box", "damping"])
    girder = box_from_table(name, content)
    damping = _damping(where, inputs.table(f"{where}: damping", content["damping"]))
    if inputs.choice(f"{where}: model", content.get("model", "beam"), ("beam", "shell")) == "shell":
        for key in ("shear", "rotary_inertia"):
            if key in content:
                raise InputError(f"{where}: {key}", content[key], "is a switch of the beam model", "Remove it, a shell has both")
        mesh = inputs.table(f"{where}: mesh", content.get("mesh", {}))
        inputs.keys(f"{where}: mesh", mesh, [f.name for f in fields(BoxMesh)])
        return girder.shell_deck(content.get("modes", 15), damping, BoxMesh(**mesh))
    if "mesh" in content:
        raise InputError(f"{where}: mesh", content["mesh"], "belongs to the shell model", 'Remove it, or set model = "shell"')
    switches = {k: inputs.boolean(f"{where}: {k}", content[k]) for k in ("shear", "rotary_inertia") if k in content}
    return girder.beam_deck(content.get("modes", 20), damping, **switches)


def _from_beam(where: str, name: str, content: dict[str, Any]) -> Deck:
    """Build a deck from beam elements; see `beam`."""
    inputs.keys(where, content, _BEAM_KEYS, ["damping"])
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
    damping = _damping(where, inputs.table(f"{where}: damping", content["damping"]))
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
        return _from_section(f"{where}: section", inputs.table(f"{where}: section", content["section"]), rotary)
    inputs.keys(where, content, content, ["bending_stiffness_vertical"])
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
    return inputs.number(f"{where}: track_height", content.get("track_height", 0.0), least=-FARTHEST, most=FARTHEST, unit="m")


def _from_modes(where: str, name: str, content: dict[str, Any]) -> Deck:
    """Build a deck of which only the modes are known; see `exchange`."""
    inputs.keys(where, content, exchange.FILE_KEYS)
    tracks, width = _tracks(where, content)
    damping = _damping(where, inputs.table(f"{where}: damping", content["damping"])) if "damping" in content else None
    own = {"name": name, "tracks": tracks, "width": width, "track_height": track_height(where, content)}
    return exchange.deck_from_files(where, content["modes"], damping, **own)


def _tracks(where: str, content: dict[str, Any]) -> tuple[dict[str, float], float | None]:
    """Return the named tracks and the width they must lie on, m."""
    width = content.get("width")
    width = None if width is None else inputs.number(f"{where}: width", width, above=0.0, unit="m")
    tracks = inputs.table(f"{where}: tracks", content.get("tracks", {}))
    half = width / 2 if width else None
    for key, y in tracks.items():
        inputs.number(f"{where}: tracks.{key}", y, least=None if half is None else -half, most=half, unit="m")
    return tracks, width


def _from_section(where: str, s: dict[str, Any], rotary: bool) -> dict[str, float]:
    inputs.keys(where, s, _SHEAR_AREAS, _SECTION)
    for key in s:
        if key != "poisson_ratio":
            inputs.number(f"{where}.{key}", s[key], above=0.0)
    inputs.number(f"{where}.poisson_ratio", s["poisson_ratio"], above=-1.0, most=0.5)
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
    place = {key: inputs.number(f"{here}: {key}", b[key], unit="m") for key in ("x", "y", "z") if key in b}
    springs = inputs.table(f"{here}: stiffness", b.get("stiffness", {}))
    bearing = Bearing(fixed=b["fixed"], stiffness=springs, span=b.get("span"), **place)
    bearing.check(here)
    return bearing


def _damping(where: str, d: dict[str, Any]) -> tuple[float, float] | float:
    here = f"{where}: damping"
    if "modal" in d:
        inputs.keys(here, d, [], ["modal"])
        return inputs.number(f"{here}.modal", d["modal"], least=0.0, most=0.5)
    inputs.keys(here, d, [], ["ratio", "frequencies_hz"])
    return rayleigh(d["ratio"], d["frequencies_hz"])


def deck(source: str | Path) -> Deck:
    """Load a deck by shipped name (``viaduct36``) or from a ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), or bad content.
    """
    path = inputs.data_file("decks", source)
    if path.suffix != ".toml":
        raise InputError("deck", str(source), "deck files are TOML")
    return deck_from_table(path.stem, exchange.beside(inputs.read_toml(path), path.parent))
