"""Sweeps: one case over values of its keys, and over trains."""

from __future__ import annotations

import itertools
import json
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import errors, studies
from ..decks import Deck
from ..errors import InputError, InputWarning, Remark
from ..results import Crossing
from ..studies import Asked, Dimension, Job, Point, Row
from ..trains import AnyTrain, AxleTrain
from . import staging
from .axletrains import train as load_train
from .definition import Case, case
from .objects import deck as load_deck
from .ranges import values_of
from .studytrains import by_name, train_changes, trains_of_case
from .summary import summarize

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Plan", "planned", "speed_envelope", "sweep"]

STORE = "points.zarr"
"""What a study keeps its finished points in, inside its folder."""
MEASURE = ("displacement_z", "acceleration_z")
SIDE_BY_SIDE = 128
"""Crossings of cars from which on they are computed side by side."""


@dataclass(frozen=True)
class FromSummary:
    """A number of the summary by its path: ``points[0].torsion.max.value``."""

    path: str
    points: tuple[float, ...]

    def __call__(self, run: Crossing) -> float:
        """Return it for a run."""
        place: Any = summarize(run, self.points, ())
        for name in self.path.replace("[", ".").replace("]", "").split("."):
            if isinstance(place, dict) and name not in place:
                remedy = errors.did_you_mean(name, place)
                raise InputError("measure", self.path, "is no path of the summary", remedy)
            try:
                place = place[int(name)] if isinstance(place, list) else place[name]
            except (IndexError, ValueError, TypeError):
                allowed = f"leads nowhere at '{name}'"
                raise InputError("measure", self.path, allowed) from None
        if place is None:
            return np.nan
        if isinstance(place, bool) or not isinstance(place, (int, float)):
            raise InputError("measure", self.path, "must lead to a number")
        return float(place)


@dataclass(frozen=True)
class Plan:
    """A study that is checked and not yet carried out.

    Attributes
    ----------
    dimensions : tuple of Dimension
    points : tuple of Point
        The last dimension fastest.
    asked : Asked
        Names of what is kept; the modal part is that of the first deck.
    trains : dict
        By name, where there are several.
    like : Case
        The first of its cases.
    title : str
    doubts : tuple of Remark
        What is unlikely to be meant, one of each key.
    tables : dict
        Of the trains as a case has them, by name.
    """

    dimensions: tuple[Dimension, ...]
    points: tuple[Point, ...]
    asked: Asked
    trains: dict[str, AnyTrain]
    like: Case
    title: str
    doubts: tuple[Remark, ...] = ()
    tables: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def deck(self) -> Deck:
        """That of the first case."""
        return self.like.deck

    @property
    def speeds(self) -> list[float]:
        """Its speeds, m/s; empty where they do not vary."""
        return [float(v) for d in self.dimensions if d.path == "run.speed" for v in d.values]

    @cached_property
    def task(self) -> Task:
        """What computes a chunk; the same for all of the study, however much of it is left."""
        lanes = sum(isinstance(point.group, float) for point in self.points)
        return Task(lanes >= SIDE_BY_SIDE)

    @cached_property
    def chunk(self) -> int:
        """Points of a chunk that take about a second or two."""
        if self.task.side_by_side:
            return studies.WIDTH
        jobs = [point.task[2] for point in self.points if not point.refusal]
        quick = all(job.mixed or isinstance(job.train, AxleTrain) for job in jobs)
        return studies.CHUNK_OF_LOADS if quick else studies.CHUNK

    def starting_speeds(self, between: studies.Between) -> np.ndarray:
        """Return the speeds at which all trains are computed if they are chosen, m/s, at least."""
        own = [studies.starting_speeds(self.deck, t, between) for t in self.trains.values()]
        return np.unique(np.concatenate(own))

    def chosen(
        self, store: Any, between: studies.Between, chunk: int | None = None, **options: Any
    ) -> xr.Dataset:
        """Return all at speeds that are chosen; see `studies.speed_envelope`."""
        outputs = self.asked.outputs
        own = {key: value for key, value in self.like.options.items() if key != "speed"}
        return studies.speed_envelope(
            self.deck, self.trains, between, list(dict.fromkeys(o.x for o in outputs)),
            list(dict.fromkeys(o.quantity for o in outputs)), track=self.like.track,
            numbers=self.asked.numbers, store=store, chunk=chunk, **options, **own,
        )  # fmt: skip

    @property
    def columns(self) -> list[str]:
        """What the numbers of a row are."""
        outputs = [f"{o.quantity} at {o.x:g} m" for o in self.asked.outputs]
        six = ("low", "high", "low time", "high time", "static low", "static high")
        own = [f"{output}, {kind}" for kind in six for output in outputs]
        return [*own, *self.asked.numbers, *self.asked.more]

    def store(self, folder: str | Path) -> studies.Store:
        """Open or make the store of this plan in a folder."""
        return studies.Store(Path(folder) / STORE, self.columns)

    def carried_out(
        self, store: Any = None, chunk: int | None = None, **options: Any
    ) -> xr.Dataset:
        """Compute what is missing and return all; options as for `studies.carry_out`."""
        store = studies.MemoryStore() if store is None else store
        options["chunk"] = self.chunk if chunk is None else chunk
        rows = studies.carry_out(self.points, self.task, store, **options)
        found = studies.dataset(self.dimensions, self.asked, rows, {"title": self.title})
        if [d.name for d in self.dimensions] == ["train", "speed"] and self.trains:
            found = studies.signature(found, self.deck, self.trains)
        return found


@dataclass(frozen=True)
class Task:
    """The task of a chunk: crossings of one or several decks.

    Attributes
    ----------
    side_by_side : bool
        See `studies.respond`.
    """

    side_by_side: bool = False

    def __call__(self, tasks: Sequence[tuple[Deck, Asked, Job]]) -> list[Row]:
        """Compute the crossings of a chunk."""
        rows: list[Row | None] = [None] * len(tasks)
        decks = dict.fromkeys(id(deck) for deck, _, _ in tasks)
        for number in decks:
            own = [i for i, (deck, _, _) in enumerate(tasks) if id(deck) == number]
            deck, asked, _ = tasks[own[0]]
            jobs = [tasks[i][2] for i in own]
            found = studies.respond(deck, jobs, asked, self.side_by_side)
            for i, row in zip(own, found, strict=True):
                rows[i] = row
        return rows


def planned(
    source: Case | str | Path | Mapping[str, Any],
    over: Mapping[str, Any],
    trains: Sequence[Any] | Mapping[str, Any] | None = None,
    measure: Sequence[str] = MEASURE,
    points: Sequence[float] | None = None,
) -> Plan:
    """Check a study and list its points; see `sweep`."""
    base = source if isinstance(source, Case) else case(source)
    if not isinstance(over, Mapping):
        remedy = 'For instance {"run.speed": [20.0, 30.0]}'
        raise InputError("over", over, "must be a table of values by path", remedy)
    by_path = {path: values_of(f"over[{path}]", given) for path, given in over.items()}
    named = trains_of_case(trains)
    for path in _each_once(by_path):
        if named and path.split(".")[0] == "train":
            raise InputError("over", path, "a key of the train, and trains are given too")
    dimensions = [Dimension("train", list(named))] if named else []
    quantities, numbers, paths = _sorted_measures(measure)
    taken = {"x", "train", "message", *studies.OUTPUTS, *studies.NUMBERS}
    dimensions += [_dimension(path, values, by_path, taken) for path, values in by_path.items()]
    if not dimensions:
        raise InputError("over", dict(over), "nothing varies", "Give keys with values, or trains")
    total = math.prod(len(d.values) for d in dimensions)
    if total > 1_000_000:
        allowed = f"{total} crossings, at most a million in one study"
        raise InputError("over", None, allowed, "Use fewer values, or several studies")
    ways = [train_changes(base, table) for table in named.values()] or [{}]
    cases = _Cases(base, ways, by_path)
    cases.check_each()
    found: list[Point] = []
    refusal: InputError | None = None
    asked_by_deck: dict[int, Asked] = {}
    made_trains: dict[str, AnyTrain] = {}
    like: Case | None = None
    mixtures: dict[Any, list[int]] = {}
    keys: dict[int, str] = {}
    kept: list[Any] = []  # so that no id is used twice

    def key_of(thing: Any, make: Callable[[Any], str]) -> str:
        if id(thing) not in keys:
            keys[id(thing)] = make(thing)
            kept.append(thing)
        return keys[id(thing)]

    for way, values in itertools.product(range(len(ways)), itertools.product(*by_path.values())):
        try:
            own = cases.at(way, values)
            asked = _asked(own, quantities, numbers, paths, points, asked_by_deck)
        except InputError as error:
            found.append(Point("", refusal=str(error)))
            refusal = error if refusal is None else refusal
            continue
        like = own if like is None else like
        if named:
            made_trains.setdefault(list(named)[way], own.train)
        deck_key = key_of(own.deck, lambda deck, a=asked: studies.print_of_deck(deck, a))
        parts = key_of(own.train, studies.fingerprint), key_of(own.track, studies.fingerprint)
        key = studies.print_of_crossing(deck_key, *parts, own.settings)
        job = Job(own.train, own.track, own.settings)
        able = studies.eligible(own.deck, job, asked.outputs, bool(asked.more))
        group = studies.advance_of(own.settings) if able else ""
        found.append(Point(key, (own.deck, asked, job), group=group))
        mixture = studies.mixture_key(job, asked.numbers, bool(asked.more))
        if mixture is not None:
            mixtures.setdefault((id(own.deck), mixture), []).append(len(found) - 1)
    _mix(found, mixtures.values())
    if refusal is not None and not asked_by_deck:
        raise refusal
    asked = next(iter(asked_by_deck.values()))
    places = [o.x for o in asked.outputs]
    for other in asked_by_deck.values():
        if [o.x for o in other.outputs] != places:
            allowed = "are not the same on each of the decks"
            raise InputError("points", None, allowed, "Name places that all decks have")
    title = " x ".join(f"{len(d.values)} {d.name}" for d in dimensions)
    doubts = cases.doubts()
    return Plan(tuple(dimensions), tuple(found), asked, made_trains, like, title, doubts, named)


def _mix(points: list[Point], groups: Iterable[list[int]]) -> None:
    """Mark crossings that differ in size and phase of waves alone, where it is worth it."""
    for number, group in enumerate(groups):
        for i in group if len(group) >= studies.WORTH else ():
            deck, asked, job = points[i].task
            task = deck, asked, replace(job, mixed=True)
            points[i] = replace(points[i], task=task, group=f"mixture {number}")


class _Cases:
    """Cases of a study; deck, train and track are made once for all that share them."""

    def __init__(
        self, base: Case, ways: Sequence[dict[str, Any]], by_path: Mapping[str, list[Any]]
    ) -> None:
        self.base, self.ways, self.by_path = base, ways, by_path
        self._known: dict[tuple, Case] = {}
        # What costs most is changed first.
        order = {"deck": 0, "train": 1, "track": 2}
        paths = [path for several in by_path for path in _paths(several)]
        self._paths = sorted(paths, key=lambda path: order.get(path.split(".")[0], 3))

    def at(self, way: int, values: Sequence[Any]) -> Case:
        """Return the case of a point."""
        own = {
            path: value
            for several, value in zip(self.by_path, values, strict=True)
            for path in _paths(several)
        }
        place: tuple = (way,)
        current = self._made(place, self.base, self.ways[way])
        for section, paths in itertools.groupby(self._paths, lambda path: path.split(".")[0]):
            changes = {path: own[path] for path in paths}
            if section in ("deck", "train", "track"):
                place += tuple(repr(value) for value in changes.values())
                current = self._made((section, *place), current, changes)
            else:
                current = current.replace(changes)
        return current

    def _made(self, place: tuple, current: Case, changes: dict[str, Any]) -> Case:
        if place not in self._known:
            self._known[place] = current.replace(changes) if changes else current
        return self._known[place]

    def doubts(self) -> tuple[Remark, ...]:
        """Return what is unlikely to be meant, the first of each key.

        Of the first point, and of those that differ from it in one value or in the train: all
        combinations would take longer than they would tell.
        """
        first = [values[0] for values in self.by_path.values()]
        places = [(way, first) for way in range(len(self.ways))]
        for i, values in enumerate(self.by_path.values()):
            places += [(0, [*first[:i], value, *first[i + 1 :]]) for value in values[1:]]
        found: dict[str, Remark] = {}
        for way, values in places:
            with suppress(InputError):  # a point that cannot be run says so itself
                for remark in self.at(way, values).doubts:
                    if isinstance(remark, InputWarning):
                        found.setdefault(remark.field, remark)
        return tuple(found.values())

    def check_each(self) -> None:
        """Refuse a value that the case would refuse by itself, before any work starts."""
        for way in self.ways:
            if way:
                self.base.replace(way)
        for several, values in self.by_path.items():
            for value in values:
                self.base.replace(dict.fromkeys(_paths(several), value))


def _paths(several: str) -> list[str]:
    """Return the keys of one dimension: those that take the same value stand behind commas."""
    return [path.strip() for path in several.split(",")]


def _each_once(over: Iterable[str]) -> list[str]:
    """Return all keys of a study; refuse one that is empty or varies twice."""
    found: list[str] = []
    for several in over:
        for path in _paths(errors.text("over", several)):
            if not path:
                raise InputError("over", several, "has no key beside a comma", "Remove the comma")
            if path in found:
                raise InputError("over", path, "varies twice", "Name each key once")
            found.append(path)
    return found


def _dimension(
    path: str, values: list[Any], by_path: Mapping[str, Any], taken: set[str]
) -> Dimension:
    if not all(isinstance(value, (bool, int, float, str)) for value in values):
        # A table or list is a value, too: its text stands at the axis.
        values = [v if isinstance(v, str) else json.dumps(v, default=str) for v in values]
    last = path.split(".")[-1]
    alone = sum(other.split(".")[-1] == last for other in by_path) == 1
    known = {"speed": "m/s", "wavelength": "m", "amplitude": "m", "mass": "kg/m", "length": "m"}
    plain = alone and last not in taken
    return Dimension(last if plain else path, values, known.get(last, ""), path)


def _sorted_measures(measure: Sequence[str]) -> tuple[list[str], list[str], list[str]]:
    """Return quantities at places, numbers of a crossing, and paths of the summary."""
    if not isinstance(measure, Sequence):
        raise InputError("measure", measure, "must be a list of names")
    measure = [measure] if isinstance(measure, str) else list(dict.fromkeys(map(str, measure)))
    if not measure:
        raise InputError("measure", measure, "must name at least one quantity or number")
    quantities, numbers, paths = [], [], []
    for name in measure:
        if name in studies.OUTPUTS:
            quantities.append(name)
        elif name in studies.NUMBERS:
            numbers.append(name)
        elif isinstance(name, str) and ("." in name or "[" in name):
            paths.append(name)
        else:
            errors.choice("measure", name, [*studies.OUTPUTS, *studies.NUMBERS])
    return quantities, numbers, paths


def _asked(
    own: Case, quantities: list[str], numbers: list[str], paths: list[str],
    points: Sequence[float] | None, known: dict[int, Asked],
) -> Asked:  # fmt: skip
    if id(own.deck) not in known:
        places = own.points if points is None else points
        outputs = studies.outputs_at(own.deck, quantities, places) if quantities else ()
        summary_points = tuple(errors.places("points", places, (0.0, own.deck.length)).tolist())
        more = {path: FromSummary(path, summary_points) for path in paths}
        known[id(own.deck)] = Asked(tuple(outputs), tuple(numbers), more)
    return known[id(own.deck)]


def sweep(
    source: Case | str | Path | Mapping[str, Any],
    over: Mapping[str, Any],
    trains: Sequence[Any] | Mapping[str, Any] | None = None,
    measure: Sequence[str] = MEASURE,
    points: Sequence[float] | None = None,
    *,
    out: str | Path | None = None,
    chunk: int | None = None,
    workers: int = 1,
    client: Any = None,
    progress: Callable[[int, int], None] | None = None,
) -> xr.Dataset:
    """Run one case over values of its keys, and over trains.

    Parameters
    ----------
    source : Case, or what `case` takes
    over : mapping
        Values by path: ``{"run.speed": [20.0, 30.0]}``; also ``{"from": 20.0, "to": 80.0, "step":
        2.0}`` or with ``count``. Any key of the case; keys that take the same value at the same
        time stand together, parted by commas: ``{"track.vertical.seed, track.lateral.seed":
        range(1, 201)}``.
    trains : name, file, table or AxleTrain, several of them, or a mapping of these, optional
        Instead of the case's own train, on its track; ``HSLM-A`` is all ten. For bare axle loads
        ``run.loads`` and the iteration are left out: they have nothing to condense or to iterate.
    measure : sequence of str
        Quantities at `points` (`studies.OUTPUTS`), numbers of a crossing (`studies.NUMBERS`), or
        paths of its summary, as ``points[0].torsion.max.value``.
    points : sequence of float, optional
        Places along the deck, m; default those of the case.
    out : path, optional
        A folder in which finished points are kept as they come, and found again.
    chunk : int, optional
        Points computed together, and lost at most when the program is stopped; chosen if not given,
        a second or two of work.
    workers : int
        Processes on this machine.
    client : distributed.Client, optional
        A cluster.
    progress : function of (done, of how many), optional

    Returns
    -------
    xarray.Dataset
        Dimensions bear the last part of their path, ``speed``; see `studies.dataset`.

    Raises
    ------
    InputError
        Before anything is computed. A point that fails is NaN, with its reason in ``message``.
    """
    errors.integer("workers", workers, least=1, most=256)
    if chunk is not None:
        errors.integer("chunk", chunk, least=1, most=100_000)
    studies.needed("xarray")  # before the work, not after it
    plan = planned(source, over, trains, measure, points)
    options = {"chunk": chunk, "workers": workers, "client": client, "progress": progress}
    if out is None:
        return plan.carried_out(**options)
    with staging.growing(os.fspath(out), "out") as folder:
        return plan.carried_out(plan.store(folder), **options)


def speed_envelope(
    deck: Deck | str | Path, trains: Any, speeds: Sequence[float], *arguments: Any, **options: Any
) -> xr.Dataset:
    """Return the largest response of a deck to trains over speeds.

    As `studies.speed_envelope`, with names or files where it wants decks and trains; ``HSLM-A`` is
    all ten.
    """
    made = deck if isinstance(deck, Deck) else load_deck(deck)
    trains = {
        name: load_train(train) if isinstance(train, str) else train
        for name, train in by_name(trains).items()
    }
    return studies.speed_envelope(made, trains, speeds, *arguments, **options)
