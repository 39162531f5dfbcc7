"""Measured tracks: what a recording car wrote, as irregularities of rails."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
from scipy.interpolate import CubicSpline

from .. import errors
from ..errors import InputError, brief
from ..tracks import Rails, Track
from .repairs import Samples, checked_repairs, mended
from .resampling import LEAST_PER_WAVE, band_limited, even, refuse_few
from .writing import write_columns

__all__ = [
    "BAND", "COLUMNS", "LARGEST_DRIFT", "LARGEST_STEP", "Loss", "RecordedRail", "TrackRecord",
    "checked_band", "record_of",
]  # fmt: skip

BAND = (3.0, 150.0)
"""m; bands D1 to D3 of EN 13848."""
LARGEST_STEP, LARGEST_DRIFT = 5e-3, 0.02
"""m, between neighbours and from end to end; more is refused or mended."""
_HIGHEST = 0.5
"""m; more is no irregularity."""
_LONGEST = 10.0
"""Lengths of a record; of longer waves it tells nothing, and they would need much memory."""
COLUMNS = {
    "vertical": ("vertical_left", "vertical_right", "vertical", "cross_level"),
    "lateral": ("lateral_left", "lateral_right", "alignment", "gauge"),
}
"""Of each direction: left and right rail; or their mean, and left minus right."""


@dataclass(frozen=True, eq=False)
class RecordedRail:
    """A rail as it was recorded: a cubic spline through samples at even places.

    Value and slope are continuous. Outside of its extent nothing is known, and a crossing that
    needs it is refused; asked all the same it is level, at the value of its end.

    Attributes
    ----------
    first, step : float
        Place of the first sample, from the bridge entrance, and the distance between samples, m.
    r : ndarray, shape (n,)
        m.
    shortest : float
        Shortest length that the time step has to resolve, m.
    told : str
        What was done to the record, for the remarks of a crossing.
    """

    __repr__ = brief

    first: float
    step: float
    r: np.ndarray
    shortest: float
    told: str = field(default="", compare=False)

    @property
    def extent(self) -> tuple[float, float]:
        """First and last place, m."""
        return self.first, self.first + self.step * (len(self.r) - 1)

    @cached_property
    def _spline(self) -> CubicSpline:
        return CubicSpline(self.first + self.step * np.arange(len(self.r)), self.r)

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return r, m."""
        return self._spline(np.clip(x, *self._spline.x[[0, -1]]))

    def slope(self, x: np.ndarray) -> np.ndarray:
        """Return dr/dx; zero beyond the ends."""
        first, last = self._spline.x[[0, -1]]
        inside = (x >= first) & (x <= last)
        return np.where(inside, self._spline(np.clip(x, first, last), 1), 0.0)


@dataclass(frozen=True)
class Loss:
    """What the band took out of a column of a record.

    Attributes
    ----------
    column : str
    before, after : float
        Variance about the mean, m2, of the mended record and of what is left of it.
    """

    column: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """Share of the variance that is lost."""
        return 1.0 - self.after / self.before if self.before > 0.0 else 0.0


@dataclass(frozen=True, eq=False)
class TrackRecord:
    """A measured track; made by `track_record`.

    Attributes
    ----------
    name : str
    first, step : float
        Place of the first sample, from the bridge entrance, and the distance between samples, m.
    rails : dict of ndarray, shape (n,)
        ``vertical_left``, ``vertical_right`` (up positive), ``lateral_left``, ``lateral_right``
        (left positive), m; a direction that was not recorded is not there.
    band : (float, float) or None
        Shortest and longest wavelength kept, m; None for all.
    losses : tuple of Loss
        Of each column of the file.
    repairs : tuple of str
        What was mended.
    """

    __repr__ = brief

    name: str
    first: float
    step: float
    rails: Mapping[str, np.ndarray]
    band: tuple[float, float] | None
    losses: tuple[Loss, ...]
    repairs: tuple[str, ...]

    @property
    def x(self) -> np.ndarray:
        """Places of the samples, m from the bridge entrance, shape (n,)."""
        count = len(next(iter(self.rails.values())))
        return self.first + self.step * np.arange(count)

    @property
    def vertical(self) -> RecordedRail | Rails | None:
        """The heights of the rails: one for both if they are the same; None if not recorded."""
        return self._directions["vertical"]

    @property
    def lateral(self) -> RecordedRail | Rails | None:
        """The rails sideways: one for both if they are the same; None if not recorded."""
        return self._directions["lateral"]

    @property
    def track(self) -> Track:
        """Both directions."""
        return Track(vertical=self.vertical, lateral=self.lateral)

    @cached_property
    def _directions(self) -> dict[str, RecordedRail | Rails | None]:
        return {direction: self._direction(direction) for direction in COLUMNS}

    def _direction(self, direction: str) -> RecordedRail | Rails | None:
        sides = [self.rails.get(f"{direction}_{side}") for side in ("left", "right")]
        if sides[0] is None:
            return None
        shortest = 10.0 * self.step if self.band is None else self.band[0]
        lines = self._lines(COLUMNS[direction])
        told = f"Measured track {self.name}, {direction}: {'; '.join(lines)}." if lines else ""
        made = [RecordedRail(self.first, self.step, r, shortest, told) for r in sides]
        return made[0] if np.array_equal(*sides) else Rails(*made)

    @property
    def report(self) -> str:
        """What was mended and what the band took out, one sentence a line."""
        lines = self._lines([name for names in COLUMNS.values() for name in names])
        return "\n".join(lines or ["nothing mended, all wavelengths kept"])

    def _lines(self, columns: Collection[str]) -> list[str]:
        """Return what was mended, and what the band took out of some columns."""
        lines = list(self.repairs)
        for loss in self.losses if self.band is not None else ():
            if loss.column in columns:
                lines.append(
                    f"{loss.column}: variance {1e6 * loss.before:.4g} mm2, of it "
                    f"{1e6 * loss.after:.4g} mm2 within {self.band[0]:g} to {self.band[1]:g} m, "
                    f"{100 * loss.share:.3g} % lost"
                )
        return lines

    def to_frame(self):
        """Return a pandas DataFrame: heights and sideways places in mm, by place in m."""
        import pandas as pd

        columns = {f"{name} (mm)": 1e3 * r for name, r in self.rails.items()}
        return pd.DataFrame(columns, index=pd.Index(self.x, name="x (m)"))

    def to_csv(self, path: str | Path) -> Path:
        """Write the samples as a CSV file; ``track_record(path, band="all")`` reads them back."""
        return write_columns(path, self.x, self.rails)


def record_of(
    name: str,
    place: Any,
    columns: Mapping[str, Any],
    *,
    band: tuple[float, float] | Literal["all"] = BAND,
    origin: float = 0.0,
    repair: Collection[str] | str = (),
    largest_step: float = LARGEST_STEP,
    largest_drift: float = LARGEST_DRIFT,
) -> TrackRecord:
    """Return a measured track from its samples; `track_record` reads them from a file.

    Parameters
    ----------
    name : str
    place : array_like, shape (n,)
        m along the record.
    columns : mapping of array_like, shape (n,)
        m, by the names of `COLUMNS`; NaN where a sample is missing.
    band, origin, repair, largest_step, largest_drift
        See `track_record`.

    Raises
    ------
    InputError
        What cannot be used; see `track_record`.
    """
    given = checked_band("band", band)
    waves = None if given == "all" else given
    words = checked_repairs(repair)
    origin = errors.number("origin", origin, unit="m")
    limits = [
        errors.number("largest_step", largest_step, above=0.0, unit="m"),
        errors.number("largest_drift", largest_drift, above=0.0, unit="m"),
    ]
    _refuse_mixture(columns)
    samples = Samples(np.asarray(place, float), {k: np.array(v, float) for k, v in columns.items()})
    for column, r in samples.columns.items():
        high = np.nanmax(np.abs(r), initial=0.0)
        if high > _HIGHEST:
            allowed = f"reaches {high:.4g} m, must be at most {_HIGHEST:g} m"
            remedy = "Correct the unit; of gauge give what it is wider than the nominal one"
            raise InputError(column, None, allowed, remedy)
    refuse_few(samples.place)
    samples = mended(samples, words, *limits)
    first, step, kept = even(samples.place, dict(samples.columns))
    ends = first, first + step * (len(next(iter(kept.values()))) - 1)
    remedy = "It is the place of the record that lies at the bridge entrance"
    origin = errors.place("origin", origin, ends, remedy=remedy)
    losses = []
    if waves is not None and waves[0] < LEAST_PER_WAVE * step * (1 - 1e-9):
        allowed = f"begins with waves of less than {LEAST_PER_WAVE} samples, {step:.4g} m apart"
        remedy = f"Begin with {LEAST_PER_WAVE * step:.4g} m or more"
        raise InputError("band", list(waves), allowed, remedy)
    length = ends[1] - ends[0]
    if waves is not None and waves[1] > _LONGEST * length:
        allowed = f"ends with waves of more than {_LONGEST:g} times the record, {length:.4g} m"
        raise InputError("band", list(waves), allowed, 'End with shorter waves, or give "all"')
    for column, r in kept.items():
        left = r if waves is None else band_limited(r, step, waves)
        losses.append(Loss(column, float(np.var(r)), float(np.var(left))))
        kept[column] = left
    rails = {key: errors.frozen(r) for key, r in _rails(kept).items()}
    return TrackRecord(name, first - origin, step, rails, waves, tuple(losses), samples.done)


def checked_band(field: str, band: Any) -> tuple[float, float] | Literal["all"]:
    """Return the shortest and the longest wavelength of a band, m, or "all"."""
    if isinstance(band, str) and band == "all":
        return band
    if not errors.is_list(band):
        raise InputError(
            field, band, 'must be two wavelengths, m, or "all"', "For instance [3, 150]"
        )
    shortest, longest = errors.numbers(field, band, count=2, above=0.0, unit="m").tolist()
    if shortest >= longest:
        raise InputError(field, band, "must ascend", "Shortest wavelength first: [3, 150]")
    return shortest, longest


def _refuse_mixture(columns: Mapping[str, Any]) -> None:
    known = [name for names in COLUMNS.values() for name in names]
    for name in columns:
        errors.choice("columns", name, known)
    if not columns:
        raise InputError("columns", None, "there are none besides place", ", ".join(known))
    for left, right, *others in COLUMNS.values():
        if (left in columns) != (right in columns):
            missing = right if left in columns else left
            raise InputError(f"column {missing}", None, "is missing", "Give both rails")
        both = [name for name in others if name in columns]
        if left in columns and both:
            allowed = f"stands beside {left} and {right}, never both"
            raise InputError(f"column {both[0]}", None, allowed, "Remove it")


def _rails(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the rails of each direction: given, or mean and half the difference."""
    result = {}
    for left, right, mean, difference in COLUMNS.values():
        if left in columns:
            result |= {left: columns[left], right: columns[right]}
        elif mean in columns or difference in columns:
            half = 0.5 * columns[difference] if difference in columns else 0.0
            middle = columns.get(mean, 0.0)
            result |= {left: middle + half, right: middle - half}
    return result
