"""A crossing as data: one table of tables that notebooks, panels and scenarios all use.

The vocabulary is that of the README's case table: ``deck``, ``train``, ``track``, ``run``, ``output``. A case is checked as
a whole when it is made, before anything is computed, and errors carry the path of the key, as in ``run.speed``.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Mapping
from dataclasses import InitVar, dataclass, field
from functools import lru_cache
from pathlib import Path
from pprint import pformat
from typing import Any

import numpy as np

from .. import errors, exchange
from ..crossing import Crossing, cross
from ..decks import Deck
from ..errors import InputError
from ..settings import Settings, check
from ..tracks import Harmonic, Irregularity, Level, Notch, Rails, Table, Track
from ..trains import AxleTrain, Train
from ..vehicles import Vehicle
from . import objects as decks
from . import shelf
from .objects import vehicle
from .summary import summarize

__all__ = ["Case", "case"]

RUN_KEYS = (
    "speed", "time_step", "loads", "interaction", "tolerance", "lead_in", "tail", "max_iterations", "iterations", "relaxation",
    "excitation", "feedback",
)  # fmt: skip


@dataclass(frozen=True)
class Case:
    """A checked crossing, ready to run.

    Attributes
    ----------
    content : dict
        The tables as given.
    train : Train or AxleTrain
    deck : Deck
    track : Track
    options : dict
        Keyword arguments of `cross`.
    settings : Settings
        What was left open in them filled in.
    points : ndarray
        Places of interest along the deck, m.

    Notes
    -----
    `like` and `unchanged` serve `replace`: sections taken over as they are from another case.
    """

    content: dict[str, Any]
    like: InitVar[Case | None] = None
    unchanged: InitVar[frozenset[str]] = frozenset()
    train: Train | AxleTrain = field(init=False, repr=False, compare=False)
    deck: Deck = field(init=False, repr=False, compare=False)
    track: Track = field(init=False, repr=False, compare=False)
    options: dict[str, Any] = field(init=False, repr=False, compare=False)
    settings: Settings = field(init=False, repr=False, compare=False)
    points: np.ndarray = field(init=False, repr=False, compare=False)

    def __post_init__(self, like: Case | None, unchanged: frozenset[str]) -> None:
        content = {k: errors.plain(k, v) for k, v in errors.table("case", self.content).items()}
        errors.keys("", content, ["track", "output"], ["deck", "train", "run"])
        run = errors.table("run", content["run"])
        errors.keys("run", run, RUN_KEYS, ["speed"])
        if "train" in unchanged:
            train, offset = like.train, like.options["track_offset"]
        else:
            train, offset = _train(content["train"])
        deck = like.deck if "deck" in unchanged else _deck(content["deck"])
        track = like.track if "track" in unchanged else _track(content.get("track", {}))
        options = {**run, "track_offset": offset}
        settings = check(train, deck, track, **options)
        output = errors.table("output", content.get("output", {}))
        errors.keys("output", output, ["points"])
        points = output.get("points", [deck.length / 2])
        points = errors.numbers("output.points", points, least=0.0, most=deck.length, unit="m")
        if not 1 <= len(points) <= 100:
            raise InputError("output.points", points, "must hold 1 to 100 places", "Leave it out for mid-length")
        for name, value in [
            ("content", content),
            ("train", train),
            ("deck", deck),
            ("track", track),
            ("options", options),
            ("settings", settings),
            ("points", points),
        ]:
            object.__setattr__(self, name, value)

    def replace(self, changes: Mapping[str, Any]) -> Case:
        """Return a case with some keys changed.

        Parameters
        ----------
        changes : mapping
            New values by path, for instance ``{"run.speed": 22.0, "track.vertical.wavelength": 15.0}``. A value of None
            takes the key away. Deck, train and track are made anew where a change names them, and kept otherwise: neither
            is a slider that moves the speed slowed down by reading files, nor does a file that has changed since slip in.
        """
        content = copy.deepcopy(self.content)
        for path, value in changes.items():
            *parents, last = errors.text("path of a change", path).split(".")
            place = content
            for parent in parents:
                place = place.setdefault(parent, {})
                if not isinstance(place, dict):
                    raise InputError(path, value, f"{parent} is not a table, so the path leads nowhere")
            if value is None:
                place.pop(last, None)
            else:
                place[last] = value
        return Case(content, self, frozenset({"train", "deck", "track"} - {path.split(".")[0] for path in changes}))

    def get(self, path: str) -> Any:
        """Return the value at a path, None if it is not given."""
        place: Any = self.content
        for part in path.split("."):
            place = place.get(part) if isinstance(place, dict) else None
        return copy.deepcopy(place)

    def run(self, progress: Callable[[str], None] | None = None) -> Crossing:
        """Compute the crossing; see `cross`."""
        return cross(self.train, self.deck, self.track, **self.options, progress=progress)

    def summary(self, run: Crossing | None = None) -> dict[str, Any]:
        """Return the numbers engineers look at first (of a run of this case, if there is one already); see `summarize`."""
        return summarize(run or self.run(), self.points)

    def code(self) -> str:
        """Return Python lines that build and run this very case."""
        tables = pformat(self.content, width=100, sort_dicts=False)
        place = repr(float(self.points[0])).removesuffix(".0")  # rounded, it might lie behind the deck's end
        return f"import railbridge as rb\n\ncase = rb.Case({tables})\nrun = case.run()\nrun.displacement(x={place}).to_frame()\n"


def case(source: str | Path | Mapping[str, Any]) -> Case:
    """Load a case by shipped name (``paper``), from a ``.toml`` file, or from tables.

    Raises
    ------
    InputError
        Unknown name or bad content.
    """
    if isinstance(source, Mapping):
        return Case(dict(source))
    path = shelf.data_file("cases", source)
    if path.suffix != ".toml":
        raise InputError("case", str(source), "case files are TOML")
    return Case(_beside(shelf.read_toml(path), path.parent))


def _beside(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Make paths in a case file, which are relative to it, paths that can be opened from here."""

    def opened(name: Any) -> Any:
        is_path = isinstance(name, str) and (name.endswith((".csv", ".toml")) or len(Path(name).parts) > 1)
        return str(folder / name) if is_path else name

    def change(place: Any, key: str) -> None:
        if isinstance(place, dict) and key in place:
            place[key] = opened(place[key])

    content = copy.deepcopy(content)
    train = content.get("train")
    change(content.get("deck"), "file")
    if isinstance(content.get("deck"), dict):
        content["deck"] = exchange.beside(content["deck"], folder)
    change(train, "vehicle")
    if isinstance(train, dict) and isinstance(train.get("cars"), list):
        for car in train["cars"]:
            change(car, "vehicle")
        train["cars"] = [opened(c) for c in train["cars"]]
    return content


def _deck(raw: Any) -> Deck:
    content = errors.table("deck", raw)
    if "file" not in content:
        try:
            return _cached_deck("deck", json.dumps(content, sort_keys=True), *exchange.stamps(content))
        except InputError as error:
            if error.source:
                raise
            # A deck file's errors name the file; those of a case name the key's path.
            field = error.field.replace(": ", ".")
            field = field if field.split(".")[0] == "deck" else f"deck.{field}"
            raise InputError(field, error.value, error.allowed, error.remedy) from None
    for key in content:
        if key not in ("file", "modes", "damping"):
            remedy = "Beside a file only modes and damping may stand; they replace its own"
            raise InputError(f"deck.{key}", content[key], "cannot stand beside deck.file", remedy)
    try:
        path = shelf.data_file("decks", content["file"])
    except InputError as error:
        raise InputError("deck.file", error.value, error.allowed, error.remedy) from None
    if path.suffix != ".toml":
        raise InputError("deck.file", str(content["file"]), "deck files are TOML")
    table = exchange.beside(shelf.read_toml(path), path.parent)
    if isinstance(table.get("modes"), dict) and "modes" in content:
        # A number of modes beside another program's modes means how many of them.
        content = {**content, "modes": {**table["modes"], "count": content["modes"]}}
    table |= {k: v for k, v in content.items() if k != "file"}
    return _cached_deck(path.stem, json.dumps(errors.plain(path.name, table), sort_keys=True), *exchange.stamps(table))


@lru_cache(maxsize=16)
def _cached_deck(name: str, content: str, *_stamps: int) -> Deck:
    """Make a deck once: a slider that changes the speed must not assemble it again. Changed files make another deck."""
    return decks.deck_from_table(name, json.loads(content))


@lru_cache(maxsize=16)
def _cached_vehicle(path: Path, *_stamp: int) -> Vehicle:
    """Make a vehicle once; a file that has changed since, or another of the same name, is another vehicle."""
    return vehicle(path)


def _vehicle(name: Any) -> Vehicle:
    path = shelf.data_file("vehicles", name).resolve()
    stamp = path.stat()
    return _cached_vehicle(path, stamp.st_mtime_ns, stamp.st_size)


def _train(raw: Any) -> tuple[Train | AxleTrain, float | str]:
    if isinstance(raw, list):
        raise InputError(
            "train", raw, "several trains on one deck are not supported: they feel each other through it", "Give one [train]"
        )
    t = errors.table("train", raw)
    with errors.within("train"):
        offset = t.get("track", 0.0)
        if "axles" in t or "loads" in t:
            errors.keys("train", t, ["track"], ["axles", "loads"])
            return AxleTrain(t["axles"], t["loads"]), offset
        errors.keys("train", t, ["vehicle", "cars", "car_spacing", "track", "notch"])
        given = t.get("notch", [])
        if not isinstance(given, list):
            raise InputError("train.notch", given, "must be a list of tables", "Write [[train.notch]] with two brackets")
        notches = tuple(_notch(i, n) for i, n in enumerate(given, start=1))
        spacing = t.get("car_spacing")
        if isinstance(t.get("cars"), list):
            if "vehicle" in t:
                raise InputError("train.vehicle", t["vehicle"], "give either vehicle with a number of cars, or a list of cars")
            cars = [v for i, c in enumerate(t["cars"][:1001], 1) for v in _cars(i, c)]
            errors.integer("train.cars: number of cars", len(cars), least=1, most=1000)
            return Train(tuple(cars), None, spacing, notches), offset
        errors.keys("train", t, t, ["vehicle"])
        return Train(_vehicle(t["vehicle"]), t.get("cars", 1), spacing, notches), offset


def _cars(i: int, raw: Any) -> tuple[Vehicle, ...]:
    if isinstance(raw, str):
        return (_vehicle(raw),)
    c = errors.table(f"train.cars[{i}]", raw)
    errors.keys(f"train.cars[{i}]", c, ["count"], ["vehicle"])
    return (_vehicle(c["vehicle"]),) * errors.integer(f"train.cars[{i}].count", c.get("count", 1), least=1, most=1000)


def _notch(i: int, raw: Any) -> Notch:
    where = f"train.notch {i}"
    n = errors.table(where, raw)
    errors.keys(where, n, ["before_entrance"], ["wheels", "circumference", "offset", "depth", "length"])
    with errors.within(where):
        return Notch(**n)


def _track(raw: Any) -> Track:
    t = errors.table("track", raw)
    errors.keys("track", t, ["vertical", "lateral"])
    return Track(**{d: _rails(f"track.{d}", t[d]) for d in t})


def _rails(where: str, raw: Any) -> Any:
    if isinstance(raw, Mapping) and ("left" in raw or "right" in raw):
        errors.keys(where, raw, ["left", "right"])
        return Rails(**{s: _irregularity(f"{where}.{s}", raw[s]) for s in raw})
    return _irregularity(where, raw)


_KINDS = {
    "none": (Level, [], []),
    "harmonic": (Harmonic, ["wavelength", "phase", "length", "half_waves"], ["amplitude"]),
    "table": (Table, [], ["x", "r"]),
}


def _irregularity(where: str, raw: Any) -> Irregularity | list:
    if isinstance(raw, list):
        return [_irregularity(f"{where}[{i}]", r) for i, r in enumerate(raw)]
    content = errors.table(where, raw)
    errors.keys(where, content, content, ["kind"])
    kind = errors.choice(f"{where}.kind", content.pop("kind"), _KINDS)
    make, optional, required = _KINDS[kind]
    errors.keys(where, content, optional, required)
    with errors.within(where):
        return make(**content)
