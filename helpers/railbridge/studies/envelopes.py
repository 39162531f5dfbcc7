"""The largest response of a deck to trains over speeds: the commonest question of all."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import errors
from ..decks import Deck
from ..errors import InputError
from ..settings import check
from ..tracks import Track
from ..trains import AnyTrain, AxleTrain
from .datasets import Dimension, dataset
from .engine import Asked, Job, Row, asked_of, respond
from .fingerprints import fingerprint, print_of_crossing, print_of_deck
from .outputs import outputs_at
from .refinement import SETTLED, Between, refined, starting_speeds
from .resonance import repeated_distance, residual_acceleration
from .store import MemoryStore, Store
from .study import CHUNK, CHUNK_OF_LOADS, Point, carry_out

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "QUANTITIES", "Crossings", "OnDeck", "checked_speeds", "crossings", "named_trains", "signature",
    "speed_envelope",
]  # fmt: skip

QUANTITIES = ("displacement_z", "acceleration_z", "moment_vertical")
"""What an envelope is asked for if nothing else is."""


@dataclass(frozen=True, eq=False)
class OnDeck:
    """The task of a chunk: crossings of one deck."""

    deck: Deck
    asked: Asked

    def __call__(self, jobs: Sequence[Job]) -> list[Row]:
        """Compute the crossings of a chunk."""
        return respond(self.deck, jobs, self.asked)


def named_trains(trains: Any) -> dict[str, AnyTrain]:
    """Return trains by name: a mapping, one train, or several, which are then numbered."""
    if isinstance(trains, AnyTrain):
        trains = [trains]
    if not isinstance(trains, Mapping):
        if not isinstance(trains, (list, tuple)):
            allowed = "must be a Train, several, or {name: train}"
            raise InputError("trains", trains, allowed)
        names = [getattr(train, "name", "") or f"train {i}" for i, train in enumerate(trains, 1)]
        for name in names:
            if names.count(name) > 1:
                raise InputError("trains", name, "is there twice", "Give {name: train, ...}")
        trains = dict(zip(names, trains, strict=True))
    if not trains:
        raise InputError("trains", trains, "must hold at least one train")
    for name, train in trains.items():
        errors.text("name of a train", name)
        if not isinstance(train, AnyTrain):
            raise InputError(f"trains[{name}]", train, "must be a Train or an AxleTrain")
    return dict(trains)


def checked_speeds(speeds: Any) -> np.ndarray:
    """Return speeds in m/s, ascending and each once.

    Raises
    ------
    InputError
        None, not ascending, or not positive.
    """
    found = errors.numbers("speeds", speeds, above=0.0, most=200.0, unit="m/s")
    if not len(found):
        raise InputError("speeds", list(found), "must hold at least one speed, m/s")
    if np.any(np.diff(found) <= 0.0):
        raise InputError("speeds", list(found), "must ascend", "Sort them, each once")
    return found


def speed_envelope(
    deck: Deck,
    trains: Any,
    speeds: Sequence[float] | Between,
    points: Sequence[float] | None = None,
    quantities: Sequence[str] = QUANTITIES,
    *,
    track: Track | None = None,
    numbers: Sequence[str] = (),
    store: Store | None = None,
    chunk: int | None = None,
    workers: int = 1,
    client: Any = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> xr.Dataset:
    """Return the largest response of a deck to trains over speeds.

    Parameters
    ----------
    deck : Deck
    trains : mapping of trains by name, one train, or several
    speeds : sequence of float, or Between
        m/s, ascending; or from where to where, chosen so that halving the steps changes no peak of
        what is asked for by more than `refinement.SETTLED`.
    points : sequence of float, optional
        Places along the deck, m; default mid-length.
    quantities : sequence of str
        Some of `OUTPUTS`.
    track : Track, optional
        Level if not given; constant loads do not feel it.
    numbers : sequence of str
        Some of `NUMBERS`.
    store : Store, optional
        Where finished points are kept and found again.
    chunk, workers, client, progress
        See `carry_out`.
    **options
        As for `cross`, without the speed.

    Returns
    -------
    xarray.Dataset
        Over ``train``, ``speed`` (m/s) and ``x`` (m); see `datasets.dataset`. ``signature``: the
        acceleration by the residual influence line, where it applies; ``distance``: at which the
        axles of a train repeat, m.

    Raises
    ------
    InputError
        Before anything is computed. A single crossing that fails is NaN, with its message.
    """
    deck = errors.instance("deck", deck, Deck)
    points = [deck.length / 2] if points is None else points
    asked = asked_of(outputs_at(deck, quantities, points), numbers)
    found = crossings(
        deck, trains, speeds, asked, track=track, store=store, chunk=chunk, workers=workers,
        client=client, progress=progress, **options,
    )  # fmt: skip
    return found.dataset(deck, asked)


@dataclass(frozen=True, eq=False)
class Crossings:
    """Crossings of one deck by trains at speeds, the last fastest.

    Attributes
    ----------
    trains : dict of AnyTrain
    speeds : ndarray, shape (n,)
        m/s.
    chosen : bool
        Whether the speeds were chosen here.
    rows : list of Row, or of a text where a point was refused
    """

    trains: dict[str, AnyTrain]
    speeds: np.ndarray
    chosen: bool
    rows: list[Row | str]

    def dataset(self, deck: Deck, asked: Asked) -> xr.Dataset:
        """Return them as labelled arrays; see `speed_envelope`."""
        title = f"speed envelope of {deck.name}"
        if self.chosen:
            title += f", {len(self.speeds)} speeds chosen: halving the steps changes no peak by "
            title += f"more than {100 * SETTLED:g} %"
        dimensions = (
            Dimension("train", list(self.trains)),
            Dimension("speed", self.speeds.tolist(), "m/s", "run.speed", "speed of the train"),
        )
        found = dataset(dimensions, asked, self.rows, {"title": title})
        return signature(found, deck, self.trains)


def crossings(
    deck: Deck,
    trains: Any,
    speeds: Sequence[float] | Between,
    asked: Asked,
    *,
    watched: Sequence[int] | None = None,
    track: Track | None = None,
    store: Store | None = None,
    chunk: int | None = None,
    workers: int = 1,
    client: Any = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> Crossings:
    """Compute what is asked of trains over speeds; see `speed_envelope`.

    Parameters
    ----------
    deck, trains, speeds
    asked : Asked
    watched : sequence of int, optional
        Which of its outputs decide where chosen speeds lie; all if not given.
    track, store, chunk, workers, client, progress, **options

    Raises
    ------
    InputError
    """
    by_name = named_trains(trains)
    if not isinstance(speeds, Between):
        speeds = checked_speeds(speeds)
    track = Track() if track is None else errors.instance("track", track, Track)
    if "speed" in options:
        raise InputError("speed", options["speed"], "is given by speeds", "Leave it out")
    deck_print, track_print = print_of_deck(deck, asked), fingerprint(track)
    store = MemoryStore() if store is None else store
    task = OnDeck(deck, asked)
    if chunk is None:
        constant = all(isinstance(train, AxleTrain) for train in by_name.values())
        chunk = CHUNK_OF_LOADS if constant else CHUNK
    how = {"chunk": chunk, "workers": workers, "client": client, "progress": progress}
    watched = range(len(asked.outputs)) if watched is None else watched

    def planned(train: AnyTrain, along: np.ndarray) -> list[Point]:
        own, found = fingerprint(train), []
        for speed in along.tolist():
            try:
                settings = check(train, deck, track, speed=speed, **options)
            except InputError as error:
                found.append(Point("", refusal=str(error)))
                continue
            key = print_of_crossing(deck_print, own, track_print, settings)
            found.append(Point(key, Job(train, track, settings)))
        if all(point.refusal for point in found):
            check(train, deck, track, speed=float(along[0]), **options)  # which says why
        return found

    chosen = isinstance(speeds, Between)
    if chosen:
        of_trains = []
        for train in by_name.values():

            def largest(along: np.ndarray, train: AnyTrain = train) -> np.ndarray:
                rows = carry_out(planned(train, along), task, store, **how)
                found = [row if isinstance(row, Row) else Row.failed(asked, row) for row in rows]
                return np.array([row.peaks(asked).largest[0, list(watched)] for row in found])

            of_trains.append(refined(largest, starting_speeds(deck, train, speeds)))
        speeds = np.unique(np.concatenate(of_trains))
    points = [point for train in by_name.values() for point in planned(train, speeds)]
    return Crossings(by_name, speeds, chosen, carry_out(points, task, store, **how))


def signature(found: xr.Dataset, deck: Deck, trains: Mapping[str, AnyTrain]) -> xr.Dataset:
    """Add what trains and deck alone say of resonance to a data set over train and speed."""
    levels = [residual_acceleration(deck, train, found.speed.values) for train in trains.values()]
    if all(level is not None for level in levels):
        words = "acceleration by the residual influence line: mid-span, first mode"
        own = {"units": "m/s2", "long_name": words}
        found = found.assign(signature=(("train", "speed"), np.array(levels), own))
    distances = [repeated_distance(train) or np.nan for train in trains.values()]
    words = "distance at which axles repeat"
    return found.assign(distance=("train", distances, {"units": "m", "long_name": words}))
