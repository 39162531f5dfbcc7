"""A crossing as data: one table of tables that notebooks, panels and scenarios all use.

The vocabulary is that of docs/case.md: ``deck``, ``train``, ``track``, ``run``, ``output``. A case
is checked as a whole when it is made, before anything is computed, and errors carry the path of the
key, as in ``run.speed``.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import InitVar, dataclass, field, fields
from functools import cached_property
from pathlib import Path
from pprint import pformat
from typing import Any

import numpy as np

from .. import errors, exchange
from ..cautions import doubts, remarks
from ..checks import Assessment, Requirements, assess, usual_speeds
from ..crossing import NotConvergedError, compute, warn_of
from ..decks import Deck
from ..errors import InputError, Remark, within
from ..results import Crossing
from ..settings import Options, Settings, bytes_needed, check, refuse_bytes
from ..studies import Between, RandomResponse, random_response
from ..tracks import Track
from ..trains import AnyTrain
from . import objects, shelf, tables
from .randomness import certain_part, random_track
from .summary import summarize
from .tabletypes import checked

__all__ = ["IN_A_CASE", "Case", "case"]

IN_A_CASE = {f.name: f"run.{f.name}" for f in fields(Options)} | {"track_offset": "train.track"}
"""What a case calls the options of `cross`."""


@dataclass(frozen=True)
class Case:
    """A checked crossing, ready to run.

    Attributes
    ----------
    content : dict
        The tables as given.
    train : AnyTrain
    deck : Deck
    track : Track
    options : dict
        Keyword arguments of `cross`.
    settings : Settings
        What was left open in them filled in.
    points : ndarray
        Places of interest along the deck, m.
    requirements : Requirements or None
        What the clauses of the codes are told, for `checks.assess_run`; None if not given.

    Notes
    -----
    `like` and `unchanged` serve `replace`: sections taken over as they are from another case.
    """

    content: dict[str, Any]
    like: InitVar[Case | None] = None
    unchanged: InitVar[frozenset[str]] = frozenset()
    train: AnyTrain = field(init=False, compare=False)
    deck: Deck = field(init=False, compare=False)
    track: Track = field(init=False, compare=False)
    options: dict[str, Any] = field(init=False, compare=False)
    settings: Settings = field(init=False, compare=False)
    points: np.ndarray = field(init=False, compare=False)
    requirements: Requirements | None = field(init=False, compare=False)

    def __repr__(self) -> str:
        cars, speed = len(self.train.formation), self.settings.speed
        found = f"Case({self.deck.name!r}, {self.deck.length:g} m, {cars} cars, {speed:g} m/s)"
        return found if len(found) < 240 else f"Case({cars} cars, {speed:g} m/s)"

    def __post_init__(self, like: Case | None, unchanged: frozenset[str]) -> None:
        content = {k: errors.plain(k, v) for k, v in errors.table("case", self.content).items()}
        t = checked(tables.CASE, content)
        train = like.train if "train" in unchanged else objects.train_of_case(t.train)
        deck = like.deck if "deck" in unchanged else objects.deck_of_case(content["deck"])
        track = like.track if "track" in unchanged else objects.track_of_case(t.track)
        options = {**t.run.given, "track_offset": t.train.track}
        with within(names=IN_A_CASE):
            settings = check(train, deck, track, **options)
        given = t.output.points if t.output is not None else None
        points = [deck.length / 2] if given is None else given
        points = errors.places("output.points", points, (0.0, deck.length))
        needed = bytes_needed(train, deck, settings, len(points))
        remedy = "Use fewer places or a larger run.time_step"
        refuse_bytes("output.points", len(points), needed, "a run with so many places", remedy)
        with within("checks"):
            needs = None if t.checks is None else Requirements(**t.checks.given)
        made = {
            "content": content, "train": train, "deck": deck, "track": track, "options": options,
            "settings": settings, "points": points, "requirements": needs,
        }  # fmt: skip
        for name, value in made.items():
            object.__setattr__(self, name, value)

    def replace(self, changes: Mapping[str, Any]) -> Case:
        """Return a case with some keys changed.

        Parameters
        ----------
        changes : mapping
            New values by path, for instance ``{"run.speed": 22.0, "track.vertical.wavelength":
            15.0}``. A value of None takes the key away. Deck, train and track are made anew where a
            change names them, and kept otherwise: neither is a slider that moves the speed slowed
            down by reading files, nor does a file that has changed since slip in.
        """
        content = changed(self.content, changes)
        touched = {path.split(".")[0] for path in changes}
        return Case(content, self, frozenset({"train", "deck", "track"} - touched))

    def get(self, path: str) -> Any:
        """Return the value at a path, None if it is not given."""
        place: Any = self.content
        for part in errors.text("path", path).split("."):
            place = place.get(part) if isinstance(place, dict) else None
        return copy.deepcopy(place)

    def run(self, progress: Callable[[str], None] | None = None) -> Crossing:
        """Compute the crossing, and warn of what is doubtful about it; see `cross`."""
        try:
            run = self.compute(progress)
        except NotConvergedError as error:
            warn_of(self.remarks(error.run))
            raise
        warn_of(self.remarks(run))
        return run

    def compute(self, progress: Callable[[str], None] | None = None) -> Crossing:
        """Compute the crossing without warnings."""
        try:
            return compute(self.train, self.deck, self.track, self.settings, progress)
        except NotConvergedError as error:
            raise NotConvergedError(error.run, "run.") from None

    def random_response(
        self,
        quantities: Sequence[str] = ("displacement_z", "acceleration_z"),
        points: Sequence[float] | None = None,
        wheels_of: Sequence[int] = (),
        progress: Callable[[str], None] | None = None,
    ) -> RandomResponse:
        """Compute the crossing of all realisations of a track with ``kind = "random"`` at once.

        What else is in the track is certain. The realisation of a seed is what `run` gives with
        that seed in both directions, but for the run-up: here the waves come from far.

        Parameters
        ----------
        quantities : sequence of str
            At every point.
        points : sequence of float, optional
            m along the deck; those of the case if not given.
        wheels_of : sequence of int
            Cars whose vertical wheel forces are asked for, too; from 1.
        progress : function of one text, optional

        Returns
        -------
        RandomResponse
            See `studies.random_response`.

        Raises
        ------
        InputError
            As `randomness.random_track` and `studies.random_response`.
        """
        track, places = random_track(self.content)
        own = {"edges": f"{places[0]}.band", "track": places[0]}
        with within(names=IN_A_CASE | own):
            return random_response(
                self.train, self.deck, track, quantities=quantities,
                points=self.points if points is None else points, wheels_of=wheels_of,
                base=certain_part(self.track), progress=progress, **self.options,
            )  # fmt: skip

    def assess(
        self, trains: Any = None, speeds: Sequence[float] | Between | int | None = None, **how: Any
    ) -> Assessment:
        """Judge the deck of this case by the table ``checks``, over speeds; see `checks.assess`.

        Parameters
        ----------
        trains : mapping of trains by name, one train, or several; optional
            That of the case if not given.
        speeds : sequence of float, Between, or int; optional
            m/s; or how many of `checks.usual_speeds`, which are taken if nothing is given.
        **how
            ``stations``, ``more``, ``workers``, ``store`` and ``progress`` of `checks.assess`.

        Raises
        ------
        InputError
            A case without the table ``checks``.
        """
        needs = self.requirements
        if needs is None:
            remedy = "Give it, with line_speed at least: see docs/case.md"
            raise InputError("checks", None, "is missing, and says what is asked of", remedy)
        trains = {self._train_in_words: self.train} if trains is None else trains
        if speeds is None or isinstance(speeds, (int, np.integer)):
            speeds = usual_speeds(needs, speeds)
        options = {key: value for key, value in self.options.items() if key != "speed"}
        with within(names=IN_A_CASE):
            return assess(self.deck, trains, speeds, needs, track=self.track, **how, **options)

    @property
    def _train_in_words(self) -> str:
        """What a table calls this train: its name or file, or what its cars are."""
        given = self.content["train"]
        if "vehicle" in given:
            return f"{given.get('cars', 1)} x {Path(given['vehicle']).stem}"
        named = given.get("name") or Path(given.get("file", "")).stem
        return named or "the train"

    @property
    def doubts(self) -> list[Remark]:
        """What is unlikely to be meant, in the words of the case; known before anything is run."""
        found = [remark.moved("deck") for remark in self.deck.remarks]
        found += doubts(self.train, self.deck, self.track, self.settings)
        return [self._in_its_words(remark) for remark in found]

    def remarks(self, run: Crossing) -> list[Remark]:
        """Return what must be known before a run of this case is read, in the case's words."""
        return [self._in_its_words(remark) for remark in remarks(run)]

    @cached_property
    def _words(self) -> dict[str, str]:
        """What this case calls a deck's and a train's fields, by their names in Python."""
        words = {"train.notches": "train.notch"}
        given = self.content["train"]
        if "vehicle" not in given:
            words["train.vehicle"] = "train.cars"
        for key in ("name", "file"):
            if key in given:
                words |= dict.fromkeys(("train.axles", "train.loads"), f"train.{key}")
        with suppress(InputError):  # a deck file that has gone since
            words |= objects.words_of_deck(self.content["deck"])
        return words

    def _in_its_words(self, remark: Remark) -> Remark:
        """Return a remark whose field is a key of this case or of the files it names."""
        for name, key in self._words.items():
            if remark.field == name or remark.field.startswith((f"{name}.", f"{name}[")):
                return type(remark)(key + remark.field[len(name) :], remark.text)
        return remark.moved(names=IN_A_CASE)

    def summary(self, run: Crossing | None = None) -> dict[str, Any]:
        """Return the numbers engineers look at first; see `summarize`.

        Of a run of this case, if there is one already.
        """
        run = self.compute() if run is None else errors.instance("run", run, Crossing)
        return summarize(run, self.points, self.remarks(run))

    def code(self) -> str:
        """Return Python lines that build and run this very case."""
        content = pformat(self.content, width=100, sort_dicts=False)
        # Rounded, the place might lie behind the deck's end.
        place = repr(float(self.points[0])).removesuffix(".0")
        return (
            f"import railbridge as rb\n\ncase = rb.Case({content})\nrun = case.run()\n"
            f"run.displacement(x={place}).to_frame()\n"
        )


_DEEPEST = 20


def changed(content: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return tables with some keys changed, by path; None takes a key away."""
    if not isinstance(changes, Mapping):
        allowed = "must be a table of new values by path"
        raise InputError("changes", changes, allowed, "For instance {'run.speed': 30.0}")
    result = copy.deepcopy(dict(content))
    for path, value in changes.items():
        *parents, last = errors.text("path of a change", path).split(".")
        if len(parents) > _DEEPEST:
            raise InputError(path, None, f"leads more than {_DEEPEST} tables deep")
        place = result
        for parent in parents:
            place = place.setdefault(parent, {})
            if not isinstance(place, dict):
                raise InputError(path, value, f"{parent} is no table, so the path leads nowhere")
        if value is None:
            place.pop(last, None)
        else:
            place[last] = value
    return result


def case(source: str | Path | Mapping[str, Any], changes: Mapping[str, Any] | None = None) -> Case:
    """Load a case by shipped name (``paper``), from a ``.toml`` file, or from tables.

    Parameters
    ----------
    source : str, Path or mapping
    changes : mapping, optional
        Keys changed before the case is checked; see `Case.replace`. Paths among them are relative
        to the file, like those in it.

    Raises
    ------
    InputError
        Unknown name or bad content.
    """
    if isinstance(source, Mapping):
        return Case(changed(source, {} if changes is None else changes))
    path = shelf.data_file("cases", source, ".toml")
    content = shelf.read_toml(path, tables.CASE.model_fields)
    changes = {} if changes is None else changes
    if shelf.is_path(source):
        return Case(_beside(changed(content, changes), path.parent))
    # Nobody knows in which folder a shipped case stands: changes are relative to one's own.
    return Case(changed(_beside(content, path.parent), changes))


def _beside(content: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Make paths in a case file, which are relative to it, paths that can be opened from here."""

    def opened(name: Any) -> Any:
        return str(folder / name) if isinstance(name, str) and shelf.is_path(name) else name

    def change(place: Any, name: str) -> None:
        if isinstance(place, dict) and name in place:
            place[name] = opened(place[name])

    content = copy.deepcopy(content)
    train, deck = content.get("train"), content.get("deck")
    change(deck, "file")
    change(train, "vehicle")
    change(train, "file")
    for kind, name in (("file", "file"), ("random", "spectrum")):
        for irregularity in _of_kind(content.get("track"), kind):
            change(irregularity, name)
    if isinstance(deck, dict):
        content["deck"] = exchange.beside(deck, folder)
    if isinstance(train, dict) and isinstance(train.get("cars"), list):
        for car in train["cars"]:
            change(car, "vehicle")
        train["cars"] = [opened(car) for car in train["cars"]]
    return content


def _of_kind(place: Any, kind: str, deepest: int = _DEEPEST) -> Iterator[dict[str, Any]]:
    """Give the tables of a track that are of one kind of irregularity."""
    parts = place if isinstance(place, list) else []
    if isinstance(place, dict):
        if place.get("kind") == kind:
            yield place
        parts = list(place.values())
    for part in parts if deepest else ():
        yield from _of_kind(part, kind, deepest - 1)
