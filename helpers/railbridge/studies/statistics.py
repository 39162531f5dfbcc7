r"""What N realisations tell of a number, and what they cannot tell.

A realisation is one crossing with one random track (or train, or deck); the number is what somebody
asks of it: a largest acceleration, a wheel force. The realisations must be independent and all
drawn in the same way; nothing else is assumed unless it is said.

Every figure comes with its interval: in a share of all ensembles, the `confidence`, the interval
holds the true figure. A bound that so few realisations cannot give is NaN and a sentence of
`Statistics.remarks` says how many it takes; it is never guessed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import bdtr, betaincinv, chdtri, ndtri, stdtrit

from ..errors import InputError, brief, frozen, number, numbers

__all__ = [
    "Percentile", "Share", "Statistics", "describe", "exceedance", "needed_for_mean",
    "needed_for_percentile",
]  # fmt: skip

_MANY = 10_000_000
"""More realisations than anybody computes."""


@dataclass(frozen=True)
class Percentile:
    """One percentile of N realisations and its interval.

    Attributes
    ----------
    percent : float
    value : float
        Between the two nearest realisations, linear (NumPy's default).
    low, high : float
        Two of the realisations; NaN where there are too few for that side. Each of the two alone
        holds with the confidence (1 + c) / 2.
    """

    percent: float
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Share:
    """Share of a distribution above a limit, and its interval.

    Attributes
    ----------
    limit : float
        In the unit of the values.
    above, count : int
        Realisations above the limit, and all of them.
    share, low, high : float
        From 0 to 1.
    confidence : float
    """

    limit: float
    above: int
    count: int
    share: float
    low: float
    high: float
    confidence: float


@dataclass(frozen=True, eq=False)
class Statistics:
    """What N realisations tell of one number.

    Attributes
    ----------
    values : ndarray, shape (N,)
        The realisations, in `unit`; so are all figures below but for shares.
    confidence : float
    unit : str
    mean, standard_deviation : float
        The second with N - 1 below the fraction line.
    mean_interval : tuple of (low, high)
        Student's: exact for Gaussian numbers, good for others from some 30 realisations on.
    standard_deviation_interval : tuple of (low, high)
        Of numbers of any distribution with a fourth moment, approximately (Bonett 2006): it widens
        with the kurtosis. NaN below 5 realisations.
    standard_deviation_interval_gaussian : tuple of (low, high)
        By chi-square: exact for Gaussian numbers, far too narrow for those with long tails.
    percentiles : tuple of Percentile
    smallest, largest : float
    smallest_index, largest_index : int
        Which realisation that is, index into `values`; the first of several.
    covered : float
        At least this share of the distribution lies below the largest realisation, with the given
        confidence. What may lie above it is ``1 - covered``.
    remarks : tuple of str
        What N is too small for.
    """

    __repr__ = brief

    values: np.ndarray
    confidence: float
    unit: str
    mean: float
    standard_deviation: float
    mean_interval: tuple[float, float]
    standard_deviation_interval: tuple[float, float]
    standard_deviation_interval_gaussian: tuple[float, float]
    percentiles: tuple[Percentile, ...]
    smallest: float
    largest: float
    smallest_index: int
    largest_index: int
    covered: float
    remarks: tuple[str, ...]

    @property
    def count(self) -> int:
        """The number of realisations, N."""
        return len(self.values)

    def to_frame(self):
        """Return a pandas DataFrame with one row a figure.

        Its value and interval, and which realisation it is where it is one (from 0).
        """
        import pandas as pd

        none = math.nan
        rows: dict[str, tuple[float, float, float, int | None]] = {
            "mean": (self.mean, *self.mean_interval, None),
            "standard deviation": (
                self.standard_deviation, *self.standard_deviation_interval, None,
            ),
            "standard deviation, if Gaussian": (
                self.standard_deviation, *self.standard_deviation_interval_gaussian, None,
            ),
        }  # fmt: skip
        for p in self.percentiles:
            rows[f"{p.percent:g} % lie below"] = (p.value, p.low, p.high, None)
        rows["smallest"] = (self.smallest, none, none, self.smallest_index)
        rows["largest"] = (self.largest, none, none, self.largest_index)
        end = f" ({self.unit})" if self.unit else ""
        names = [f"{name}{end}" for name in ("value", "low", "high")]
        columns: dict[str, Any] = {
            name: [row[i] for row in rows.values()] for i, name in enumerate(names)
        }
        columns["realisation"] = pd.array([row[3] for row in rows.values()], dtype="Int64")
        return pd.DataFrame(columns, index=pd.Index(rows, name="figure"))


def describe(
    values: np.ndarray,
    *,
    confidence: float = 0.95,
    percentiles: Sequence[float] = (5, 50, 95),
    unit: str = "",
) -> Statistics:
    """Return what N realisations tell of a number.

    One realisation proves nothing: with 95 % confidence the largest of 1 lies above 5 % of the
    distribution, of 10 above 74 %, of 59 above 95 %.

    Parameters
    ----------
    values : array_like, shape (N,), or xarray.DataArray of one dimension
        One number a realisation, two or more: also ``found["wheel_unloading"]`` of a sweep over
        seeds. Dimensions of length one do not count.
    confidence : float
        Above 0, below 1.
    percentiles : sequence of float
        Percent, above 0, below 100.
    unit : str
        Of the values, for tables; a DataArray brings its own.

    Raises
    ------
    InputError
        Fewer than two values, one that is not finite, a confidence or a percentile out of range.

    Source: mean and Gaussian standard deviation, Student (1908), Biometrika 6, and the chi-square
    distribution; standard deviation of any numbers, Bonett (2006), Computational Statistics & Data
    Analysis 50, pp. 775-782; percentiles, W. R. Thompson (1936), Annals of Mathematical Statistics
    7, pp. 122-128; share below the largest, Wilks (1941), Annals of Mathematical Statistics 12.
    """
    unit = unit or _unit_of(values)
    values = _realisations(values)
    confidence = _inside("confidence", confidence, 1.0, "Give 0.95 for 95 %")
    percents = [
        _inside(f"percentiles[{i}]", p, 100.0, "Give 95 for 95 %")
        for i, p in enumerate(numbers("percentiles", percentiles).tolist(), start=1)
    ]
    count, tail = len(values), (1 - confidence) / 2
    mean, sd = float(np.mean(values)), float(np.std(values, ddof=1))
    half = -stdtrit(count - 1, tail) * sd / math.sqrt(count)
    spread = tuple(sd * math.sqrt((count - 1) / chdtri(count - 1, p)) for p in (tail, 1 - tail))
    remarks: list[str] = []
    found = tuple(_percentile(values, p, confidence, remarks) for p in percents)
    free = _spread_of_any(values, sd, tail)
    if math.isnan(free[0]):
        remarks.append(
            f"{count} realisations are too few for the interval of the standard deviation of "
            "numbers that may not be Gaussian."
        )
    least, most = int(np.argmin(values)), int(np.argmax(values))
    return Statistics(
        values=frozen(values),
        confidence=confidence,
        unit=unit,
        mean=mean,
        standard_deviation=sd,
        mean_interval=(mean - half, mean + half),
        standard_deviation_interval=free,
        standard_deviation_interval_gaussian=spread,
        percentiles=found,
        smallest=float(values[least]),
        largest=float(values[most]),
        smallest_index=least,
        largest_index=most,
        covered=(1 - confidence) ** (1 / count),
        remarks=tuple(remarks),
    )


def exceedance(values: np.ndarray, limit: float, *, confidence: float = 0.95) -> Share:
    """Return the share of the distribution above a limit.

    The interval never holds less often than the confidence says. Where no realisation lies above,
    `low` is 0 and `high` is what may still do so.

    Parameters
    ----------
    values : array_like, shape (N,)
    limit : float
        In the unit of the values; a value that equals it does not exceed it.
    confidence : float

    Raises
    ------
    InputError
        As `describe`, and a limit that is not finite.

    Source: Clopper & Pearson (1934), Biometrika 26, pp. 404-413.
    """
    values, limit = _realisations(values), number("limit", limit)
    confidence = _inside("confidence", confidence, 1.0, "Give 0.95 for 95 %")
    count, above, tail = len(values), int(np.sum(values > limit)), (1 - confidence) / 2
    low = float(betaincinv(above, count - above + 1, tail)) if above else 0.0
    high = float(betaincinv(above + 1, count - above, 1 - tail)) if above < count else 1.0
    return Share(limit, above, count, above / count, low, high, confidence)


def needed_for_mean(pilot: np.ndarray, width: float, *, confidence: float = 0.95) -> int:
    """Return how many realisations give the mean within a share of itself.

    Parameters
    ----------
    pilot : array_like, shape (n,)
        Some realisations, from which mean and standard deviation are taken as if they were true.
    width : float
        Half of the interval over the mean's size: 0.05 for plus or minus 5 %.
    confidence : float

    Raises
    ------
    InputError
        As `describe`; a pilot whose mean is zero, or a width that no ensemble gives.

    Source: half of Student's interval, t s / sqrt(N), set equal to ``width |mean|``.
    """
    pilot, width = _realisations(pilot, "pilot"), number("width", width, above=0.0)
    confidence = _inside("confidence", confidence, 1.0, "Give 0.95 for 95 %")
    tail, sd = (1 - confidence) / 2, np.std(pilot, ddof=1)
    allowed = width * abs(np.mean(pilot))
    _reachable(width, bool(allowed > 0 and (ndtri(tail) * sd / allowed) ** 2 < _MANY), "mean")
    low, high = 1, 2 * _MANY
    # What N gives shrinks with N: halve the range until it holds one number.
    while high - low > 1:
        middle = (low + high) // 2
        if middle > 1 and -stdtrit(middle - 1, tail) * sd / math.sqrt(middle) <= allowed:
            high = middle
        else:
            low = middle
    return high


def needed_for_percentile(
    pilot: np.ndarray, percent: float, width: float, *, confidence: float = 0.95
) -> int:
    """Return about how many realisations give a percentile within a share of itself.

    As good as the pilot: it must hold what lies around the percentile, and a percentile far out in
    the tail needs a pilot of some hundred.

    Parameters
    ----------
    pilot : array_like, shape (n,)
        Some realisations, taken as if they were the whole distribution.
    percent : float
        Above 0, below 100.
    width : float
        Half of the interval over the percentile's size: 0.05 for plus or minus 5 %.
    confidence : float

    Raises
    ------
    InputError
        As `describe`; a pilot whose percentile is zero, or a width that no ensemble gives.

    Source: N realisations place the percentile p between two others of the distribution,
    ``p -+ z sqrt(p (1 - p) / N)``, the Gaussian limit of the intervals of `describe`; those are
    read from the pilot. Never fewer than the two bounds of such an interval take.
    """
    pilot, width = _realisations(pilot, "pilot"), number("width", width, above=0.0)
    confidence = _inside("confidence", confidence, 1.0, "Give 0.95 for 95 %")
    p = _inside("percent", percent, 100.0, "Give 95 for 95 %") / 100
    tail = (1 - confidence) / 2
    scatter = -ndtri(tail) * math.sqrt(p * (1 - p))
    allowed = 2 * width * abs(np.quantile(pilot, p))

    def holds(count: float) -> bool:
        off = scatter / math.sqrt(count)
        low, high = np.quantile(pilot, [max(p - off, 0.0), min(p + off, 1.0)])
        return bool(high - low <= allowed)

    fewest = max(_fewest(p, tail), _fewest(1 - p, tail), math.ceil((scatter / min(p, 1 - p)) ** 2))
    _reachable(width, bool(allowed > 0) and holds(max(fewest + 1, _MANY)), "percentile")
    if holds(fewest):
        return fewest
    low, high = fewest, max(fewest + 1, _MANY)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def _realisations(values: Any, field: str = "values") -> np.ndarray:
    """Return the numbers as an array of our own, two or more."""
    if hasattr(values, "dims") and hasattr(values, "to_numpy"):
        values = _of_labelled(field, values)
    found = numbers(field, values)
    if len(found) < 2:
        raise InputError(
            field, values, "must hold two realisations or more", "One realisation proves nothing"
        )
    return found


def _of_labelled(field: str, values: Any) -> np.ndarray:
    """Return the numbers of a DataArray; refuse what is of several dimensions or has no numbers."""
    found = np.squeeze(values.to_numpy())
    if found.ndim != 1:
        names = ", ".join(map(str, values.dims))
        allowed = f"must be of one dimension, it has {names or 'none'}"
        raise InputError(field, None, allowed, "Choose of the others: .sel(x=18.0)")
    missing = int(np.isnan(found).sum()) if found.dtype.kind == "f" else 0
    if missing:
        allowed = f"{missing} of {len(found)} crossings have no numbers, see message"
        raise InputError(field, None, allowed, "Find out why, then leave them out by .dropna()")
    return found


def _unit_of(values: Any) -> str:
    """Return the unit that a DataArray says."""
    unit = getattr(values, "attrs", {}).get("units", "")
    return "" if unit == "-" else unit


def _inside(field: str, value: Any, below: float, remedy: str) -> float:
    """Return a number above 0 and below a bound, both exclusive."""
    found = number(field, value, remedy=remedy)
    if not 0.0 < found < below:
        raise InputError(field, value, f"must be above 0 and below {below:g}", remedy)
    return found


def _reachable(width: float, reached: bool, what: str) -> None:
    if not reached:
        raise InputError(
            "width", width, f"no {_MANY:.0e} realisations give it with this pilot",
            f"Give a larger width, or a pilot whose {what} is not near zero",
        )  # fmt: skip


def _fewest(share: float, tail: float) -> int:
    """Return the fewest realisations whose largest lies above a share, but for a tail."""
    return math.ceil(math.log(tail) / math.log(share) - 1e-9)


def _percentile(
    values: np.ndarray, percent: float, confidence: float, remarks: list[str]
) -> Percentile:
    """Return a percentile between two of the sorted realisations; remark where one is missing.

    The number of realisations below the percentile is binomial, whatever the distribution: so the
    l-th smallest lies above it with the probability P(B < l), the u-th below it with P(B >= u).
    """
    count, tail, p = len(values), (1 - confidence) / 2, percent / 100
    ordered = np.sort(values)
    # at_most[k] = P(B <= k). Rounding must not cost a bound that N just gives.
    at_most = bdtr(np.arange(count, dtype=float), count, p)
    slack = 1e-12
    lower = int(np.searchsorted(at_most, tail + slack, side="right"))
    upper = int(np.searchsorted(at_most, 1 - tail - slack)) + 1
    for side, missing, share in (
        ("lower", lower == 0, 1 - p), ("upper", upper > count, p),
    ):  # fmt: skip
        if missing:
            remarks.append(
                f"{count} realisations are too few for the {side} bound of the {percent:g} % "
                f"percentile; it takes {_fewest(share, tail)}."
            )
    return Percentile(
        percent,
        float(np.percentile(values, percent)),
        float(ordered[lower - 1]) if lower else math.nan,
        float(ordered[upper - 1]) if upper <= count else math.nan,
    )


def _spread_of_any(values: np.ndarray, sd: float, tail: float) -> tuple[float, float]:
    """Return Bonett's interval of the standard deviation, NaN where N is too small for it."""
    count, z = len(values), -float(ndtri(tail))
    if count < max(5.0, 2 * z):
        return math.nan, math.nan
    squares = float(np.sum((values - np.mean(values)) ** 2))
    if squares == 0.0:
        return 0.0, 0.0
    cut = int(count / (2 * math.sqrt(count - 4)))
    middle = np.mean(np.sort(values)[cut : count - cut])
    kurtosis = count * float(np.sum((values - middle) ** 4)) / squares**2
    factor = count / (count - z)
    error = factor * math.sqrt((kurtosis - (count - 3) / count) / (count - 1))
    low, high = (math.sqrt(factor * math.exp(side * z * error)) for side in (-1.0, 1.0))
    return sd * low, sd * high
