"""What the realisations of a case's random track give: headlines, tables, and a summary."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..cautions import parts_of
from ..errors import InputWarning, Remark, ResultWarning, brief
from ..studies import Ensemble, Extreme, RandomResponse, Statistics, program_version
from .definition import Case
from .randomness import random_track

__all__ = ["Drawn"]

CONFIDENCE = 0.95
_PERCENTILES = (5, 50, 95)
_SIDES = {"magnitude": "largest size", "smallest": "smallest", "largest": "largest"}
UNLOADING = "wheel_unloading"


@dataclass(frozen=True, eq=False)
class Drawn:
    """Realisations of a case.

    Attributes
    ----------
    case : Case
    keys : tuple of str
        Where its random track stands: ``track.vertical``.
    response : RandomResponse
    ensemble : Ensemble
    extremes : dict of Extreme
        Of the size of every history, by probability.
    statistics : dict of Statistics
        By history and side, and of the unloading of wheels.
    """

    __repr__ = brief

    case: Case
    keys: tuple[str, ...]
    response: RandomResponse
    ensemble: Ensemble
    extremes: dict[str, Extreme]
    statistics: dict[tuple[str, str], Statistics]

    @classmethod
    def of(
        cls,
        case: Case,
        response: RandomResponse,
        realisations: int,
        progress: Callable[[str], None] = lambda _: None,
    ) -> Drawn:
        """Draw realisations and find extremes.

        Parameters
        ----------
        case : Case
        response : RandomResponse
            Of this case.
        realisations : int
        progress : function of one text
        """
        ensemble, extremes, statistics = response.ensemble(realisations, progress), {}, {}
        for number, name in enumerate(response.names, start=1):
            progress(f"extremes of history {number} of {len(response.names)}")
            extremes[name] = response.extreme(name)
        for name, side, unit in _asked(response, ensemble):
            options = {"confidence": CONFIDENCE, "percentiles": _PERCENTILES, "unit": unit}
            statistics[name, side] = ensemble.statistics(name, side, **options)
        return cls(case, random_track(case.content)[1], response, ensemble, extremes, statistics)

    @property
    def seeds(self) -> np.ndarray:
        """Of the realisations, shape (realisations,)."""
        return self.ensemble.seeds

    @cached_property
    def remarks(self) -> list[Remark]:
        """What must be known before the numbers are read."""
        found: list[Remark] = [r for r in self.case.doubts if isinstance(r, InputWarning)]
        told = (getattr(part, "told", "") for _, part in parts_of(self.case.track))
        found += [Remark("", text) for text in dict.fromkeys(told) if text]
        few = (text for own in self.statistics.values() for text in own.remarks)
        found += [Remark("", text) for text in dict.fromkeys(few)]
        if (UNLOADING, "largest") in self.statistics:
            lifted = int(np.sum(self.statistics[UNLOADING, "largest"].values > 1.0))
            if lifted:
                text = f"A wheel would lift in {lifted} of {len(self.seeds)} realisations, and is "
                text += "held down here: wheels that can leave the rail are not linear. Run one "
                text += "of them by itself on wheelsets with contact = 'unilateral'."
                found.append(ResultWarning("", text))
        return found

    # ---- in words

    def headlines(self) -> Iterator[str]:
        """Give what is to be read first, line by line."""
        track, count = self.response.track, len(self.seeds)
        band = "{:g} to {:g} m".format(*track.band)
        yield (
            f"{track.spectrum.name}, {len(track.wavenumbers)} waves of {band}; {count} "
            f"realisations, seeds {self.seeds[0]} to {self.seeds[-1]}"
        )
        for name in self.response.names:
            unit, sigma = self.response.unit(name), self.response.sigma(name)
            k, p = int(np.argmax(sigma)), self.extremes[name]
            t = self.response.time(name)[k]
            yield f"{name}: sigma is largest, {sigma[k]:.4g} {unit}, at t = {t:.4g} s"
            yield (
                f"  largest size by probability: {p.mean:.4g} on average, 5 % below "
                f"{p.percentile(5):.4g}, 95 % below {p.percentile(95):.4g}"
            )
            yield self._of_realisations(name, "magnitude")
        if (UNLOADING, "largest") in self.statistics:
            yield f"{UNLOADING}, 1 - force / static force, the worst of these wheels:"
            yield self._of_realisations(UNLOADING, "largest")
        keys = " and ".join(f"{key}.seed" for key in self.keys)
        yield (
            f"in brackets: with a confidence of {100 * CONFIDENCE:g} %; a realisation is run by "
            f"{keys} = its seed"
        )

    def _of_realisations(self, name: str, side: str) -> str:
        own = self.statistics[name, side]
        low, _, high = own.percentiles
        return (
            f"  of the realisations: {own.mean:.4g} {_between(own.mean_interval)} on average, "
            f"5 % below {low.value:.4g} {_between((low.low, low.high))}, 95 % below "
            f"{high.value:.4g} {_between((high.low, high.high))}, worst {own.largest:.4g}: seed "
            f"{self.seeds[own.largest_index]}"
        )

    # ---- as tables

    def tables(self) -> Iterator[tuple[str, Iterator[str]]]:
        """Give the name of every CSV file and its lines."""
        yield "histories.csv", self._histories()
        yield "realisations.csv", self._realisations()
        yield "statistics.csv", self._statistics()

    def _histories(self) -> Iterator[str]:
        response = self.response
        longest = max(response.names, key=lambda name: len(response.time(name)))
        time = response.time(longest)
        columns = {"t": time}
        for name in response.names:
            first = int(np.argmin(np.abs(time - response.time(name)[0])))
            for kind, values in (("mean", response.mean(name)), ("sigma", response.sigma(name))):
                whole = np.full(len(time), np.nan)  # a wheel is there while on the deck
                whole[first : first + len(values)] = values
                columns[f"{_plain(name)} {kind} ({response.unit(name)})"] = whole
        yield _line(columns)
        for row in zip(*(values.tolist() for values in columns.values()), strict=True):
            yield _line(row)

    def _realisations(self) -> Iterator[str]:
        columns = {"seed": self.seeds}
        for (name, side), own in self.statistics.items():
            if side != "magnitude":
                columns[f"{_plain(name)} {side}" + f" ({own.unit})" * bool(own.unit)] = own.values
        yield _line(columns)
        for row in zip(*(values.tolist() for values in columns.values()), strict=True):
            yield _line(row)

    def _statistics(self) -> Iterator[str]:
        figures = ["mean", "standard deviation", *(f"{p} % below" for p in _PERCENTILES)]
        three = [f"{figure}{end}" for figure in figures for end in ("", " low", " high")]
        yield _line(["history", "unit", "extreme", "way", *three, "worst", "worst seed"])
        for (name, side), own in self.statistics.items():
            first = [_plain(name), own.unit, _SIDES[side]]
            if side == "magnitude":
                p, none = self.extremes[name], [np.nan, np.nan]
                values = [p.mean, p.standard_deviation, *map(p.percentile, _PERCENTILES)]
                known = [number for value in values for number in (value, *none)]
                yield _line([*first, "probability", *known, *none])
            known = [own.mean, *own.mean_interval]
            known += [own.standard_deviation, *own.standard_deviation_interval]
            known += [number for p in own.percentiles for number in (p.value, p.low, p.high)]
            yield _line([*first, "realisations", *known, *self._worst(own, side)])

    def _worst(self, own: Statistics, side: str) -> tuple[float, int]:
        """Return the most extreme realisation and its seed."""
        small = side == "smallest"
        place = own.smallest_index if small else own.largest_index
        return (own.smallest if small else own.largest), int(self.seeds[place])

    # ---- as data

    def summary(self) -> dict[str, Any]:
        """Return all but histories and single realisations; the keys are in docs/studies.md."""
        track, s = self.response.track, self.response.waves.settings
        spectrum = track.spectrum
        components = {
            name: {
                "sigma": float(np.sqrt(track.powers[name].sum())),
                "factor": spectrum.factor * getattr(spectrum.parts[name].density, "factor", 1.0),
                "grade": spectrum.grade(name),
            }
            for name in track.components
        }
        return {
            "realisations": len(self.seeds),
            "first_seed": int(self.seeds[0]),
            "last_seed": int(self.seeds[-1]),
            "confidence": CONFIDENCE,
            "random_track": {
                "keys": list(self.keys), "spectrum": spectrum.name, "components": components,
                "band": list(track.band), "period": track.length,
                "waves": len(track.wavenumbers),
            },
            "run": {
                "speed": s.speed, "time_step": s.time_step, "track_offset": s.track_offset,
                "loads": s.loads, "excitation": s.excitation, "interaction": s.interaction,
            },
            "histories": {name: self._of_history(name) for name in self.response.names},
            UNLOADING: self._figures(UNLOADING, "largest"),
            "remarks": [str(remark) for remark in self.remarks],
            "railbridge": program_version(),
        }  # fmt: skip

    def _of_history(self, name: str) -> dict[str, Any]:
        time, mean = self.response.time(name), self.response.mean(name)
        sigma, p = self.response.sigma(name), self.extremes[name]
        return {
            "unit": self.response.unit(name),
            "sigma": _at(sigma, time, int(np.argmax(sigma))),
            "mean": {
                "min": _at(mean, time, int(np.argmin(mean))),
                "max": _at(mean, time, int(np.argmax(mean))),
            },
            "largest_size_by_probability": {
                "mean": p.mean,
                "standard_deviation": p.standard_deviation,
                "percentiles": {str(each): p.percentile(each) for each in _PERCENTILES},
                "peak_factor": p.peak_factor,
            },
            **{
                f"{_SIDES[side].replace(' ', '_')}_of_realisations": self._figures(name, side)
                for side in _SIDES
            },
        }

    def _figures(self, name: str, side: str) -> dict[str, Any] | None:
        own = self.statistics.get((name, side))
        if own is None:
            return None
        worst, seed = self._worst(own, side)
        return {
            "mean": own.mean,
            "mean_interval": list(own.mean_interval),
            "standard_deviation": own.standard_deviation,
            "standard_deviation_interval": list(own.standard_deviation_interval),
            "percentiles": {
                f"{p.percent:g}": {"value": p.value, "low": p.low, "high": p.high}
                for p in own.percentiles
            },
            "worst": {"value": worst, "seed": seed},
        }


def _asked(response: RandomResponse, ensemble: Ensemble) -> Iterator[tuple[str, str, str]]:
    """Give history, side and unit of every extreme."""
    for name in response.names:
        for side in _SIDES:
            yield name, side, response.unit(name)
    if ensemble.static_loads:
        yield UNLOADING, "largest", ""


def _at(values: np.ndarray, time: np.ndarray, k: int) -> dict[str, float]:
    return {"value": float(values[k]), "t": float(time[k])}


def _between(interval: tuple[float, float]) -> str:
    low, high = ("?" if np.isnan(value) else f"{value:.4g}" for value in interval)
    return f"({low} to {high})"


def _plain(name: str) -> str:
    """Return the name of a history without its comma, which would part columns."""
    return name.replace(",", "")


def _line(cells) -> str:
    """Return a line of a CSV file; what is not known is left empty."""
    return ",".join(map(_cell, cells)) + "\n"


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.9g}"
    return str(value)
