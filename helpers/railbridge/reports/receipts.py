"""The receipt of a calculation: which inputs, which programs, which choices."""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import fields
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from .. import exchange, studies
from ..cases import shelf
from ..decks import Deck
from ..errors import InputError
from ..results import Crossing
from ..settings import Settings
from ..trains import AnyTrain
from .parts import NOTHING, Table, exact, in_km_h, shown

__all__ = [
    "choices", "damping_in_words", "input_files", "inputs", "made_in_python", "names_only",
    "programs", "random_tables",
]  # fmt: skip

_OF_PEOPLE = ("name", "recovery", "remarks", "mode_names", "tracks")
"""What of a deck is no number, or is worked out from its numbers."""
_PROGRAMS = ("numpy", "scipy")


def names_only(value: Any) -> Any:
    """Return tables in which paths of files are their last parts: where they lie is no input."""
    if isinstance(value, Mapping):
        return {key: names_only(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [names_only(part) for part in value]
    if isinstance(value, str) and shelf.is_path(value):
        with suppress(OSError, ValueError):
            if Path(value).is_file():
                return Path(value).name
    return value


def input_files(content: Mapping[str, Any]) -> list[tuple[str, Path]]:
    """Return the files that a case refers to, each once: what it is for, and its path.

    Files of shipped names count, too. One that has gone since is left out.
    """
    found: dict[Path, str] = {}
    for role, kind, name, endings in _named_files(content):
        with suppress(InputError, OSError):
            path = shelf.data_file(kind, name, *endings)
            found.setdefault(path.resolve(), role)
            if role == "deck":
                own = exchange.beside(shelf.read_toml(path), path.parent)
                for key, source in exchange.sources(own).items():
                    found.setdefault(source.resolve(strict=True), f"deck, {key}")
    for key, source in exchange.sources(content.get("deck", {})).items():
        with suppress(OSError):
            found.setdefault(source.resolve(strict=True), f"deck, {key}")
    return [(role, path) for path, role in found.items()]


def _named_files(content: Mapping[str, Any]) -> Iterator[tuple[str, str, str, tuple[str, ...]]]:
    """Give role, kind, name and endings of what tables of a case name."""
    deck, train = content.get("deck", {}), content.get("train", {})
    if isinstance(deck.get("file"), str):
        yield "deck", "decks", deck["file"], (".toml",)
    yield from _of_train(train)
    for name, other in content.get("trains", {}).items():
        for role, *rest in _of_train(other):
            yield f"{role} {name}", *rest
    for table in _tables(content.get("track", {})):
        if table.get("kind") == "file" and isinstance(table.get("file"), str):
            yield "track", "tracks", table["file"], (".csv",)
        if table.get("kind") == "random" and isinstance(table.get("spectrum"), str):
            yield "spectrum", "spectra", table["spectrum"], (".toml",)


def _of_train(train: Mapping[str, Any]) -> Iterator[tuple[str, str, str, tuple[str, ...]]]:
    cars = train.get("cars")
    named = (
        [car.get("vehicle") if isinstance(car, Mapping) else car for car in cars]
        if isinstance(cars, list)
        else [train.get("vehicle")]
    )
    for name in named:
        if isinstance(name, str):
            yield "vehicle", "vehicles", name, (".csv", ".toml")
    for key in ("file", "name"):
        if isinstance(train.get(key), str):
            yield "train", "trains", train[key], (".csv",)


def _tables(place: Any) -> Iterator[Mapping[str, Any]]:
    """Give all tables inside tables and lists, the outermost first."""
    if isinstance(place, Mapping):
        yield place
    for part in place.values() if isinstance(place, Mapping) else place:
        if isinstance(part, (Mapping, list, tuple)):
            yield from _tables(part)


def random_tables(content: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the tables of a track that is drawn from a spectrum."""
    return [t for t in _tables(content.get("track", {})) if t.get("kind") == "random"]


def inputs(content: Mapping[str, Any]) -> Table:
    """Return the digests of the tables of a case and of all files that it refers to."""
    text = json.dumps(names_only(content), sort_keys=True, default=str, ensure_ascii=False)
    rows = [("tables of the case", "-", len(text.encode()), _digest(text.encode()))]
    for role, path in input_files(content):
        known = path.read_bytes()
        rows.append((role, path.name, len(known), _digest(known)))
    return Table.of(
        "inputs",
        "Inputs and their SHA-256",
        ["input", "file", ("size", "bytes"), "SHA-256"],
        rows,
        note="The tables of the case are taken as JSON with sorted keys, files as they are; of "
        "paths the last part counts.",
    )


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def made_in_python(deck: Deck, trains: Mapping[str, AnyTrain] | None = None) -> Table:
    """Return the digests of a deck and of trains by their numbers, where there is no file."""
    own = {f.name: getattr(deck, f.name) for f in fields(deck) if f.name not in _OF_PEOPLE}
    rows = [("deck", deck.name, studies.fingerprint(own))]
    rows += [("train", name, studies.fingerprint(train)) for name, train in (trains or {}).items()]
    note = "BLAKE2 of all numbers of what was computed; names do not count."
    heads = ["input", "name", "digest"]
    return Table.of("inputs", "Inputs and their digests", heads, rows, note=note)


def programs() -> Table:
    """Return the versions of the programs that computed."""
    rows = [("railbridge", studies.program_version()), ("Python", platform.python_version())]
    for name in _PROGRAMS:
        with suppress(PackageNotFoundError):
            rows.append((name, version(name)))
    return Table.of("programs", "Programs", ["program", "version"], rows)


def choices(
    settings: Settings, deck: Deck, content: Mapping[str, Any], run: Crossing | None = None
) -> Table:
    """Return how it was computed.

    Parameters
    ----------
    settings : Settings
        Of many crossings those of the first.
    deck : Deck
    content : mapping
        Of the case.
    run : Crossing, optional
        Of a single crossing.
    """
    s = settings
    rows: list[tuple[str, str]] = []
    if run is not None:
        rows.append(("speed", f"{shown(s.speed)} m/s, {shown(in_km_h(s.speed))} km/h"))
        rows.append(("samples", f"{s.samples}"))
    of_first = "" if run is not None else " (at the first speed)"
    rows += [
        ("time step", f"{exact(s.time_step)} s{of_first}"),
        ("interaction", s.interaction + ", chosen by the program" * s.auto),
        ("loads of the train on the deck", s.loads),
        ("contact of wheel and rail", s.contact),
        ("excitation", f"{s.excitation} meet the track at their own places"
         if s.excitation == "wheels" else "all wheels of a car in phase"),
        ("what the train feels of the deck", s.feedback),
        ("track centre line", f"{exact(s.track_offset)} m left of the deck axis"),
        ("irregular track before the deck", f"{exact(s.lead_in)} m{of_first}"),
        ("computed after the last axle has left", f"{exact(s.tail)} s"),
    ]  # fmt: skip
    if s.interaction == "iterate":
        rows.append(("tolerance", f"{s.tolerance:g}, of {s.tolerance_of}"))
    if run is not None and run.converged is not None:
        passes = run.iterations if run.windows is None else int(run.windows.passes.max())
        last = f", last change {run.changes[-1]:.2g}" if run.changes else ""
        rows.append(("passes after the rigid deck", f"{passes}{last}"))
        rows.append(("converged", shown(bool(run.converged))))
    rows.append(("modes of the deck", _modes(deck)))
    rows.append(("damping of the deck", damping_in_words(deck)))
    for table in random_tables(content):
        spectrum, band = table.get("spectrum"), table.get("band")
        said = f"{exact(names_only(spectrum))}, seed {exact(table.get('seed', 0))}"
        said += "" if band is None else f", waves of {exact(band[0])} to {exact(band[-1])} m"
        rows.append(("random track", said))
    return Table.of("choices", "How it was computed", ["choice", "value"], rows)


def _modes(deck: Deck) -> str:
    count = len(deck.frequencies_hz)
    return f"{count}, up to {shown(deck.frequencies_hz[-1])} Hz; all are in the accelerations"


def damping_in_words(deck: Deck) -> str:
    """Return how a deck is damped."""
    low, high = 100 * np.min(deck.damping_ratios), 100 * np.max(deck.damping_ratios)
    ratios = f"{shown(low, 3)} %" if high - low < 1e-6 else f"{shown(low, 3)} to {shown(high, 3)} %"
    if deck.internal_damping:
        beta = shown(deck.internal_damping)
        return f"Rayleigh, {ratios} of critical over the modes, beta = {beta} s"
    return f"{ratios} of critical, by mode" if np.any(deck.damping_ratios) else NOTHING
