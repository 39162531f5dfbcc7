"""A deck and its trains against the clauses: one table of verdicts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import codes, errors
from ..codes import Answer, Verdicts
from ..crossing import compute
from ..decks import Deck
from ..errors import InputError, brief
from ..results import Crossing
from ..settings import STATIONS, Options, accelerations_up_to, check
from ..studies import (
    Asked,
    Between,
    Row,
    Store,
    crossings,
    of_modes_counted,
    row_of_run,
)
from ..studies.envelopes import Crossings
from ..tracks import Irregularity, Level, Sum, Track
from ..trains import AnyTrain, AxleTrain
from .judging import Finding, Point, Points
from .questions import Questions
from .requirements import Requirements
from .rules import coverage, line_gaps, rules, speed_gaps
from .staticloads import StaticLoads
from .structure import Structure
from .trainclauses import TrainClauses
from .trust import Trust

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Assessment", "assess", "assess_run", "usual_speeds"]

_STEP = 0.5
"""m/s."""


@dataclass(frozen=True, eq=False)
class Assessment:
    """What is found of a deck and its trains.

    Attributes
    ----------
    deck : Deck
    needs : Requirements
    verdicts : Verdicts
        A row for each clause, the worst over trains and speeds; ``where`` is the place, ``when``
        train and speed.
    rules : dict of Answer
        What the rules say by name: need of a dynamic analysis, bounds of n0, factors, speeds.
    envelope : xarray.Dataset
        The largest responses over ``train``, ``speed`` (m/s) and ``x`` (m).
    of_trains : dict of tuple of Finding
        By train, its own findings of the clauses that trains decide.
    more : xarray.Dataset or None
        What was asked of the same crossings besides, as `studies.speed_envelope` gives it.
    """

    __repr__ = brief

    deck: Deck
    needs: Requirements
    verdicts: Verdicts
    rules: dict[str, Answer]
    envelope: xr.Dataset
    of_trains: dict[str, tuple[Finding, ...]] = field(repr=False)
    more: xr.Dataset | None = field(default=None, repr=False)

    @property
    def verdict(self) -> str:
        """``not met`` if one clause is not; ``cannot decide`` if one is undecided."""
        return self.verdicts.verdict

    def per_train(self) -> pd.DataFrame:
        """Return a pandas DataFrame, a row for each train and clause that trains decide.

        Columns: value and unit, utilisation, verdict, speed (m/s) at which it is; a value is shown
        also where it is not enough to decide.
        """
        import pandas as pd

        rows = [
            {
                "train": train,
                "what": one.verdict.clause.title,
                "value": np.nan if one.value is None else one.value,
                "unit": one.verdict.clause.unit,
                "utilisation": one.utilisation,
                "verdict": one.verdict.verdict,
                "speed": np.nan if one.point is None else one.point.speed,
            }
            for train, findings in self.of_trains.items()
            for one in findings
        ]
        return pd.DataFrame(rows).set_index(["train", "what"])

    def rules_frame(self) -> pd.DataFrame:
        """Return a pandas DataFrame of the rules: what, answer, unit, reason, clause, source."""
        import pandas as pd

        rows = {
            name: {
                "what": answer.clause.title,
                "answer": "cannot decide" if answer.value is None else answer.value,
                "unit": "" if isinstance(answer.value, bool) else answer.unit,
                "reason": answer.reason,
                "clause": answer.clause.name,
                "source": answer.clause.source,
            }
            for name, answer in self.rules.items()
        }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("rule")


def assess(
    deck: Deck,
    trains: Any,
    speeds: Sequence[float] | Between,
    needs: Requirements,
    *,
    track: Track | None = None,
    stations: int = STATIONS,
    more: Asked | None = None,
    workers: int = 1,
    store: Store | None = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> Assessment:
    """Judge a deck and its trains over speeds by the clauses of EN 1990 and EN 1991-2.

    Parameters
    ----------
    deck : Deck
    trains : mapping of trains by name, one train, or several
        Cars and bare axle loads.
    speeds : sequence of float, or Between
        m/s; see `studies.speed_envelope`. A dynamic analysis asks for 40 m/s to 1.2 times the
        line's speed; where one is or may be needed and they do not cover that, what is met is not
        decided. Where none is needed they must reach the line's speed.
    needs : Requirements
    track : Track, optional
        Level if not given.
    stations : int
        Places along the deck where its acceleration is looked at, ends included; a multiple of 4
        and one. Fewer are quicker.
    more : studies.Asked, optional
        Outputs and numbers that are asked of the same crossings besides, for `Assessment.more`.
        Where speeds are chosen, its outputs decide which, so that they cover no resonance here.
    workers, store, progress
        See `studies.speed_envelope`.
    **options
        As for `cross`, without the speed. Which modes count in deck accelerations says the clause,
        whatever ``acceleration_modes`` is.

    Returns
    -------
    Assessment
        What cannot be known is *cannot decide* with a reason, never met.

    Raises
    ------
    InputError
        Before anything is computed. A single crossing that fails leaves a reason.

    Notes
    -----
    Horizontal rotations and radii are those of the trains' own forces, so they are never met: wind,
    nosing and centrifugal forces are not in them. Deflections are those of the deck axis.
    """
    errors.instance("deck", deck, Deck)
    errors.instance("needs", needs, Requirements)
    stations = errors.integer("stations", stations, least=5, most=1001)
    if stations % 4 != 1:
        raise InputError("stations", stations, "must be a multiple of 4 and one", "Take 9 or 41")
    besides = Asked(()) if more is None else errors.instance("more", more, Asked)
    if besides.more:
        remedy = "Ask for outputs and for numbers by name"
        raise InputError("more", None, "must not hold functions of a crossing", remedy)
    counts, options = options.get("acceleration_modes", "all"), _all_modes(options)
    besides = _of_modes(besides, deck, counts)
    parts = _Parts(Structure(deck, needs), _offset(deck, options), stations, besides)
    asked = parts.questions.asked
    found = crossings(
        deck, trains, speeds, asked, watched=parts.questions.watched, track=track,
        workers=workers, store=store, progress=progress, **options,
    )  # fmt: skip
    answers = rules(parts.structure, parts.questions)
    own_speeds, line_speed = found.speeds.tolist(), needs.line_speed
    answers["speeds_covered"] = coverage(
        answers, own_speeds, isinstance(speeds, Between) and not besides.outputs
    )
    stepped = {
        name: train for name, train in found.trains.items() if not isinstance(train, AxleTrain)
    }
    trust = Trust.of(Options(speed=1.0, **options), deck, parts.questions.kept, stepped)
    clauses = TrainClauses(
        parts.structure, parts.questions, parts.loads, trust, _smooth(track),
        speed_gaps(answers, own_speeds, line_speed), line_gaps(own_speeds, line_speed),
        options.get("interaction") == "rigid",
    )  # fmt: skip
    own = {
        name: [point for point in _points(found) if point.train == name] for name in found.trains
    }
    of_trains = {
        name: tuple(clauses.findings(Points.of(points, asked))) for name, points in own.items()
    }
    every = Points.of([point for points in own.values() for point in points], asked)
    worst = clauses.findings(every)
    located = _Located(deck, found.trains, Track() if track is None else track, options)
    rows = [located(one).verdict for one in [*parts.loads.findings(), *worst]]
    picture = _dataset(found, parts.questions, parts.questions.shown)
    asked_besides = None if more is None else _dataset(found, parts.questions, besides)
    return Assessment(deck, needs, Verdicts(rows), answers, picture, of_trains, asked_besides)


def usual_speeds(needs: Requirements, count: int | None = None) -> np.ndarray:
    """Return the speeds at which a line is usually looked at, m/s, half a metre a second apart.

    To 1.2 times the line's speed, or to the 40 m/s from which a dynamic analysis is asked for; from
    there, or from a third of it.

    Parameters
    ----------
    needs : Requirements
    count : int, optional
        How many, instead of half a metre a second apart.
    """
    top = max(1.2 * needs.line_speed, 40.0)
    low = min(40.0, top / 3.0, needs.line_speed)
    if count is not None:
        return np.linspace(low, top, errors.integer("speeds", count, least=2, most=10_000))
    return np.linspace(low, top, int(np.ceil((top - low) / _STEP)) + 1)


def assess_run(run: Crossing, needs: Requirements) -> Verdicts:
    """Judge one crossing by the clauses of EN 1990 and EN 1991-2, by its own histories.

    Parameters
    ----------
    run : Crossing
    needs : Requirements

    Returns
    -------
    Verdicts
        As those of `assess`, of one train at one speed: that other speeds may be worse is not said.

    Raises
    ------
    InputError
    """
    errors.instance("run", run, Crossing)
    errors.instance("needs", needs, Requirements)
    run = replace(run, settings=replace(run.settings, accelerations_up_to_hz=np.inf))
    parts = _Parts(Structure(run.deck, needs), run.settings.track_offset)
    asked = parts.questions.asked
    name = getattr(run.train, "name", "") or "train"
    cars = not isinstance(run.train, AxleTrain)
    point = Point(name, cars, run.settings.speed, row_of_run(run, asked))
    trust = Trust.of(run.settings, run.deck, parts.questions.kept, {name: run.train}, run)
    clauses = TrainClauses(
        parts.structure, parts.questions, parts.loads, trust, _smooth(run.track),
        unfelt=run.iteration == 0,
    )  # fmt: skip
    worst = clauses.findings(Points.of([point], asked))
    findings = [*parts.loads.findings(), *worst]
    return Verdicts([_placed(one, run).verdict for one in findings])


@dataclass(frozen=True, eq=False)
class _Parts:
    """What an assessment is made from before any train runs."""

    structure: Structure
    offset: float
    stations: int = STATIONS
    more: Asked = Asked(())
    questions: Questions = field(init=False)
    loads: StaticLoads = field(init=False)

    def __post_init__(self) -> None:
        questions = Questions(self.structure, self.stations, self.more)
        object.__setattr__(self, "questions", questions)
        object.__setattr__(self, "loads", StaticLoads(self.structure, questions, self.offset))


def _offset(deck: Deck, options: dict[str, Any]) -> float:
    return deck.track_offset(options.get("track_offset", 0.0))


def _all_modes(options: dict[str, Any]) -> dict[str, Any]:
    """Return options with all modes in accelerations: the clause leaves out those that do not."""
    if "acceleration_modes" not in options:
        return options
    Options(speed=1.0, acceleration_modes=options["acceleration_modes"])  # which may refuse
    return options | {"acceleration_modes": "all"}


def _smooth(track: Track | None) -> bool:
    """Whether rails are level: then phi'' speaks for what they are not.

    Waves sideways unload no wheel and shake no deck up and down, and the flat spot of one wheel
    says nothing of the rails.
    """
    track = Track() if track is None else track
    return all(_flat(track.rail("vertical", side)) for side in ("left", "right"))


def _flat(rail: Irregularity) -> bool:
    if isinstance(rail, Sum):
        return all(_flat(part) for part in rail.parts)
    return isinstance(rail, Level) or getattr(rail, "amplitude", None) == 0.0


def _points(found: Crossings) -> list[Point]:
    pairs = [(name, float(v)) for name in found.trains for v in found.speeds]
    return [
        Point(name, not isinstance(found.trains[name], AxleTrain), speed, row)
        for (name, speed), row in zip(pairs, found.rows, strict=True)
    ]


def _of_modes(besides: Asked, deck: Deck, counts: float | str) -> Asked:
    """Return what is asked besides, its accelerations of the modes that its options count."""
    up_to = accelerations_up_to(deck, counts)
    return replace(besides, outputs=of_modes_counted(besides.outputs, deck, up_to))


def _dataset(found: Crossings, questions: Questions, part: Asked) -> xr.Dataset:
    """Return a part of what was asked as labelled arrays."""
    which = questions.columns(part)
    short = [
        row if isinstance(row, str) else Row(row.values[which], row.message) for row in found.rows
    ]
    return replace(found, rows=short).dataset(questions.deck, part)


# ---- where in a train


@dataclass(frozen=True, eq=False)
class _Located:
    """Says which car or wheel it was: the crossing that decided is computed once more."""

    deck: Deck
    trains: dict[str, AnyTrain]
    track: Track
    options: dict[str, Any]
    runs: dict[tuple[str, float], Crossing] = field(default_factory=dict)

    def __call__(self, one: Finding) -> Finding:
        if one.point is None or one.verdict.clause not in _OF_CARS:
            return one
        key = one.point.train, one.point.speed
        if key not in self.runs:
            train = self.trains[one.point.train]
            settings = check(train, self.deck, self.track, speed=one.point.speed, **self.options)
            self.runs[key] = compute(train, self.deck, self.track, settings)
        return _placed(one, self.runs[key])


_OF_CARS = {
    codes.comfort_limit.clause: "body",
    codes.wheel_unloading_limit.clause: "wheel",
}


def _placed(one: Finding, run: Crossing) -> Finding:
    """Return a finding with the car or wheel of its crossing."""
    kind = _OF_CARS.get(one.verdict.clause)
    if kind is None or one.point is None or one.value is None:
        return one
    where = _body(run) if kind == "body" else _wheel(run)
    return replace(one, verdict=replace(one.verdict, where=where))


def _body(run: Crossing) -> str:
    vertical = np.abs(run.body_accelerations[:, :, 1])
    car, place, _ = np.unravel_index(np.nanargmax(vertical), vertical.shape)
    coach = f", coach {place // 3 + 1}" if vertical.shape[1] > 3 else ""
    return f"car {car + 1}{coach}, {('front', 'middle', 'rear')[place % 3]}"


def _wheel(run: Crossing) -> str:
    wheel, _ = np.unravel_index(np.nanargmax(run.wheel_unloading), run.wheel_unloading.shape)
    own = run.train.wheels[wheel]
    return f"car {own.car}, wheel {own.number}"
