"""Crossings of one study on one deck: the same question to each, by the fastest way there is.

Constant loads need no train and no passes (`constant`); all others are computed one by one, as
`crossing.cross` computes them.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .. import errors
from ..cautions import left_open, transient
from ..crossing import NotConvergedError, compute
from ..decks import Deck
from ..errors import InputError
from ..results import Crossing
from ..settings import Settings
from ..tracks import Track
from ..trains import AnyTrain, AxleTrain
from ..units import without_rounding
from .constant import constant_loads
from .lanes import KNOWN, WIDTH, advance_of, eligible, run_lanes
from .mixtures import mixture_key, run_mixtures
from .outputs import OUTPUTS, Output, Peaks, peaks_of_run

__all__ = ["NUMBERS", "Asked", "Job", "Row", "asked_of", "respond", "row_of_run"]


def _unloading(run: Crossing) -> float:
    return float(np.nanmax(run.wheel_unloading))


def _heaviest(run: Crossing) -> float:
    return float(-run.wheel_forces[:, 1].min())


def _deviation(run: Crossing) -> float:
    return float(run.deviations.from_rigid[-1]) if run.iterations else np.nan


def _ride(run: Crossing) -> float:
    vertical = run.body_accelerations[:, :, 1]
    return float(np.nanmax(np.abs(vertical))) if vertical.size else np.nan


NUMBERS: dict[str, tuple[str, str, Callable[[Crossing], float]]] = {
    "wheel_unloading": ("-", "largest 1 - force / static force of a wheel", _unloading),
    "wheel_force_z": ("N", "largest vertical force of a wheel, static part included", _heaviest),
    "body_acceleration_z": (
        "m/s2", "largest vertical acceleration of a car body, at its front, middle or rear; none "
        "of bare axle loads", _ride,
    ),
    "deviation_from_rigid": ("%", "Eq. 3 of the last pass against the rigid deck", _deviation),
    "iterations": (
        "-", "passes after the rigid deck, 0 without iteration; the most of one window where "
        "several were iterated", lambda run: float(run.solves),
    ),
    "left_open": (
        "-", "share of the wheel forces' dynamic part that further passes would still change",
        left_open,
    ),
    "transient": (
        "-", "share of the steady wheel forces that is transient while the first car crosses; 0 "
        "where that is not known", transient,
    ),
}  # fmt: skip
"""What a study can be asked for of a whole crossing: unit, meaning, and how a run is asked."""


@dataclass(frozen=True, eq=False)
class Asked:
    """What is kept of every crossing.

    Attributes
    ----------
    outputs : tuple of Output
    numbers : tuple of str
        Some of `NUMBERS`.
    more : dict of callable
        Further numbers by name, each from a run.
    """

    outputs: tuple[Output, ...]
    numbers: tuple[str, ...] = ()
    more: Mapping[str, Callable[[Crossing], float]] = field(default_factory=dict)

    @cached_property
    def by_unit(self) -> dict[str, np.ndarray]:
        """Which outputs are in which unit."""
        units = np.array([OUTPUTS.get(output.quantity, "") for output in self.outputs])
        return {str(unit): np.flatnonzero(units == unit) for unit in np.unique(units)}

    @property
    def width(self) -> int:
        """Numbers in a row."""
        return len(_PEAKS) * len(self.outputs) + len(self.numbers) + len(self.more)


_PEAKS = ("low", "high", "low_time", "high_time", "static_low", "static_high")


@dataclass(frozen=True, eq=False)
class Job:
    """One crossing that is asked for; its settings are checked.

    Attributes
    ----------
    train : AnyTrain
    track : Track
    settings : Settings
    mixed : bool
        Whether it is made from the crossings of unit waves; see `mixtures`.
    """

    train: AnyTrain
    track: Track
    settings: Settings
    mixed: bool = False


@dataclass(frozen=True, eq=False)
class Row:
    """What one crossing gave.

    Attributes
    ----------
    values : ndarray, shape (width,)
        The six of `Peaks` for each output, then the numbers; NaN where it failed.
    message : str
        Why it failed; empty if it did not.
    """

    values: np.ndarray
    message: str = ""

    @classmethod
    def failed(cls, asked: Asked, message: str) -> Row:
        """Return a row of NaN with the reason."""
        return cls(np.full(asked.width, np.nan), message)

    def peaks(self, asked: Asked) -> Peaks:
        """Return the peaks of one crossing, arrays of shape (1, outputs)."""
        found = self.values[: len(_PEAKS) * len(asked.outputs)].reshape(len(_PEAKS), 1, -1)
        return Peaks(*found)

    def numbers(self, asked: Asked) -> dict[str, float]:
        """Return the numbers by name."""
        names = (*asked.numbers, *asked.more)
        return dict(zip(names, self.values[len(self.values) - len(names) :], strict=True))


def asked_of(outputs: Sequence[Output], numbers: Sequence[str] = ()) -> Asked:
    """Return what is asked, refused where a number is unknown."""
    for name in numbers:
        errors.choice("measure", name, NUMBERS)
    return Asked(tuple(outputs), tuple(numbers))


def respond(
    deck: Deck,
    jobs: Sequence[Job],
    asked: Asked,
    side_by_side: bool = False,
) -> list[Row]:
    """Compute crossings of one deck; one that fails gives a row with its message.

    Parameters
    ----------
    deck : Deck
    jobs : sequence of Job
    asked : Asked
    side_by_side : bool
        Whether crossings of cars that can be lanes are; worth it where there are hundreds.

    Returns
    -------
    list of Row, in the order of the jobs
    """
    rows: list[Row | None] = [None] * len(jobs)
    constant: dict[tuple, list[int]] = {}
    lanes: dict[tuple, list[int]] = {}
    mixtures: dict[Hashable, list[int]] = {}
    whole = bool(asked.more) or not set(asked.numbers) <= set(KNOWN)
    for i, job in enumerate(jobs):
        s = job.settings
        key = mixture_key(job, asked.numbers, bool(asked.more)) if job.mixed else None
        if key is not None:
            mixtures.setdefault(key, []).append(i)
            continue
        if isinstance(job.train, AxleTrain) and not asked.more:
            key = id(job.train), s.track_offset, s.tail, s.accelerations_up_to_hz
            constant.setdefault(key, []).append(i)
        elif side_by_side and eligible(deck, job, asked.outputs, whole):
            passes = s.interaction, s.iterations, s.track_offset, s.accelerations_up_to_hz
            lanes.setdefault((id(job.train), advance_of(s), *passes), []).append(i)
        else:
            rows[i] = _one(deck, job, asked)
    together = [(run_mixtures, own) for own in mixtures.values()]
    together += [
        (run_lanes, own[first : first + WIDTH])
        for own in lanes.values()
        for first in range(0, len(own), WIDTH)
    ]
    for run, some in together:
        try:
            found = run(deck, [jobs[i] for i in some], asked.outputs, asked.numbers)
        except Exception:  # one of them spoils it for all: each by itself says which
            for i in some:
                rows[i] = _one(deck, jobs[i], asked)
            continue
        for i, values in zip(some, found, strict=True):
            rows[i] = _checked(values, asked)
    for (_, offset, tail, up_to_hz), own in constant.items():
        train, speeds = jobs[own[0]].train, [jobs[i].settings.speed for i in own]
        try:
            peaks = constant_loads(
                deck, train, speeds, asked.outputs, track_offset=offset, tail=tail,
                accelerations_up_to_hz=up_to_hz,
            )  # fmt: skip
        except Exception as error:  # recorded, not fatal
            if len(own) == 1:
                rows[own[0]] = Row.failed(asked, _said(error))
            for i in own if len(own) > 1 else ():
                rows[i] = respond(deck, [jobs[i]], asked)[0]
            continue
        heaviest = max(axle.static_load for axle in train.placed_axles)
        known = {
            "wheel_unloading": 0.0, "wheel_force_z": heaviest, "body_acceleration_z": np.nan,
            "deviation_from_rigid": 0.0, "iterations": 0.0, "left_open": 0.0, "transient": 0.0,
        }  # fmt: skip
        numbers = np.array([known[name] for name in asked.numbers])
        for n, i in enumerate(own):
            values = [getattr(peaks, name)[n] for name in _PEAKS]
            rows[i] = _checked(np.concatenate([*values, numbers]), asked)
    return rows


def _one(deck: Deck, job: Job, asked: Asked) -> Row:
    try:
        return row_of_run(compute(job.train, deck, job.track, job.settings), asked)
    except Exception as error:  # whatever it is: recorded, not fatal to the others
        return Row.failed(asked, _said(error))


def _said(error: Exception) -> str:
    """Return why a point failed: never empty, or it would count as one that did not."""
    if isinstance(error, (NotConvergedError, InputError)):
        return str(error)
    return f"{type(error).__name__}: {error}"


def row_of_run(run: Crossing, asked: Asked) -> Row:
    """Return what is asked of a crossing that is computed already."""
    peaks = peaks_of_run(run, asked.outputs)
    values = [getattr(peaks, name)[0] for name in _PEAKS]
    numbers = [NUMBERS[name][2](run) for name in asked.numbers]
    numbers += [float(take(run)) for take in asked.more.values()]
    row = np.concatenate([*values, np.array(numbers, dtype=float)])
    return _checked(row, asked)


def _checked(values: np.ndarray, asked: Asked) -> Row:
    """Return a row of numbers; one that failed where extremes are not finite."""
    if not np.isfinite(values[: 4 * len(asked.outputs)]).all():
        return Row.failed(asked, "the crossing gave numbers that are not finite")
    return Row(_told(values, asked))


def _told(values: np.ndarray, asked: Asked) -> np.ndarray:
    """Return a row in which extremes that are only rounding are zero."""
    told = values.copy()
    peaks = told[: len(_PEAKS) * len(asked.outputs)].reshape(len(_PEAKS), -1)
    for pair in (slice(0, 2), slice(4, 6)):  # smallest and largest value, moving and static
        for unit, own in asked.by_unit.items():
            peaks[pair, own] = without_rounding(peaks[pair, own].T, unit).T
    return told
