"""Decks as data: the deck files of ``data/decks`` and the ``[deck]`` of a case.

A deck file says which maker builds the modal deck: a beam from a section or from stiffnesses.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from . import inputs
from .beam import FIXITIES, Beam, Bearing
from .deck import Deck, rayleigh
from .inputs import InputError

__all__ = ["deck", "deck_from_table"]

_STIFFNESSES = (
    "bending_stiffness_vertical",
    "bending_stiffness_lateral",
    "torsional_stiffness",
    "axial_stiffness",
    "polar_inertia",
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


def deck_from_table(name: str, content: dict[str, Any]) -> Deck:
    """Build a modal deck from the content of a deck file or of a case's ``[deck]``.

    Keys: ``length`` or ``spans`` (m); either ``[section]`` (E, nu, density, A, I_y, I_z, J) or stiffnesses and ``mass``;
    ``damping`` = {ratio, frequencies_hz} (Rayleigh) or {modal}; ``modes``; ``[[bearing]]`` x, fixed; ``tracks``; ``width``.

    Raises
    ------
    InputError
        Missing, unknown, contradictory or wrong keys, or a mechanism.
    """
    where = f"deck {name}" if name != "deck" else name
    allowed = ["length", "spans", "section", *_STIFFNESSES, "mass", "damping", "modes", "bearing", "tracks", "width"]
    inputs.keys(where, content, [*allowed, "elements", "name", "source", "note"], ["damping"])
    if ("length" in content) == ("spans" in content):
        raise InputError(f"{where}: length", content.get("length"), "give either length or spans")
    spans = content["spans"] if "spans" in content else [_length(where, content["length"])]
    if ("section" in content) == ("mass" in content):
        raise InputError(f"{where}: section", None, "give either a section or stiffnesses with mass, never both")
    if "section" in content:
        clash = [k for k in _STIFFNESSES if k in content]
        if clash:
            raise InputError(f"{where}: {clash[0]}", content[clash[0]], "a section is given too, never both", "Remove one")
        properties = _from_section(f"{where}: section", inputs.table(f"{where}: section", content["section"]))
    else:
        inputs.keys(where, content, content, ["bending_stiffness_vertical"])
        properties = {k: content[k] for k in (*_STIFFNESSES, "mass") if k in content}
    given = content.get("bearing", [])
    if not isinstance(given, list):
        raise InputError(f"{where}: bearing", given, "must be a list of tables", "Write [[bearing]] with two brackets")
    bearings = tuple(_bearing(where, i, b) for i, b in enumerate(given, start=1))
    beam = Beam(
        name,
        inputs.numbers(f"{where}: spans", spans, above=0.0, unit="m"),
        bearings=bearings,
        elements=content.get("elements"),
        **properties,
    )
    width = content.get("width")
    width = None if width is None else inputs.number(f"{where}: width", width, above=0.0, unit="m")
    tracks = inputs.table(f"{where}: tracks", content.get("tracks", {}))
    half = width / 2 if width else None
    for key, y in tracks.items():
        inputs.number(f"{where}: tracks.{key}", y, least=None if half is None else -half, most=half, unit="m")
    damping = _damping(where, inputs.table(f"{where}: damping", content["damping"]))
    return beam.deck(content.get("modes", 20), damping, tracks, width)


def _length(where: str, length: Any) -> float:
    return inputs.number(f"{where}: length", length, above=0.0, unit="m")


def _from_section(where: str, s: dict[str, Any]) -> dict[str, float]:
    inputs.keys(where, s, [], _SECTION)
    for key in _SECTION:
        if key != "poisson_ratio":
            inputs.number(f"{where}.{key}", s[key], above=0.0)
    inputs.number(f"{where}.poisson_ratio", s["poisson_ratio"], above=-1.0, most=0.5)
    e = s["youngs_modulus"]
    return {
        "mass": s["density"] * s["area"],
        "bending_stiffness_vertical": e * s["second_moment_vertical"],
        "bending_stiffness_lateral": e * s["second_moment_lateral"],
        "torsional_stiffness": e / (2 * (1 + s["poisson_ratio"])) * s["torsion_constant"],
        "axial_stiffness": e * s["area"],
        "polar_inertia": s["density"] * (s["second_moment_vertical"] + s["second_moment_lateral"]),
    }


def _bearing(where: str, i: int, raw: Any) -> Bearing:
    here = f"{where}: bearing {i}"
    b = inputs.table(here, raw)
    inputs.keys(here, b, [], ["x", "fixed"])
    fixed = b["fixed"].split() if isinstance(b["fixed"], str) else b["fixed"]
    if not isinstance(fixed, list):
        raise InputError(f"{here}: fixed", b["fixed"], "must list some of " + " ".join(FIXITIES))
    return Bearing(inputs.number(f"{here}: x", b["x"], unit="m"), tuple(fixed))


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
    return deck_from_table(path.stem, inputs.read_toml(path))
