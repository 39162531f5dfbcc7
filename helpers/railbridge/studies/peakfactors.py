r"""Extremes of a Gaussian process whose mean and deviation change with time.

Such is what a bridge does below a train on a random track: the loads give the mean, the track the
deviation, and both are there only while the train is.

A process X with mean m, standard deviation s, rate X' with mean m' and standard deviation s', and
the correlation rho of the two at the same time crosses a level b upwards so many times a second
(Rice 1945, for processes that are not stationary Cramer & Leadbetter 1967):

    nu(b, t) = integral over v > 0 of v p(b, v) dv = p(b) E[max(X', 0) | X = b],

with p the density of X and X' together. Once X = b is known, X' is Gaussian with the mean
``mu = m' + rho s' (b - m) / s`` and the deviation ``sigma = s' sqrt(1 - rho^2)``, so that

    nu(b, t) = phi(eta) / s [sigma phi(mu / sigma) + mu Phi(mu / sigma)],   eta = (b - m) / s,

with phi and Phi the standard Gaussian density and distribution. Where nothing changes with time,
this is Rice's ``s' / (2 pi s) exp(-eta^2 / 2)``.

If crossings come independently of each other, and only out of processes that are still below,

    P(largest < b) = P(X(0) < b) exp(-integral of nu(b, t) / P(X(t) < b) dt).

The divisor is 1 for the high levels of long records. Without it low levels count processes that
have long been above, and the mean extreme of a wide band over a short time comes out too small: for
1 to 3 crossings of the mean by 0.2 to 0.45 standard deviations, with it by 0.1. No process stays
below longer than it is below at one time, so P is never more than the smallest P(X(t) < b) either;
that also serves where s is zero.

Wrong where crossings come in clumps, as those of a narrow band do: then the true extreme is
smaller. With all of the power within 8 per cent of the centre frequency the mean extreme comes out
too large by up to 0.5 standard deviations, within a third of it by 0.05, and by 0.2 for the size of
a process of mean zero, whose crossings of both limits alternate: on the safe side. Vanmarcke's
factor for clumps (1975, Journal of Applied Mechanics 42) is left out: in records of 5 to 60 cycles
it made the largest value too small by as much or more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import trapezoid
from scipy.special import ndtr

from ..errors import InputError, brief, choice, frozen, number, numbers

__all__ = ["SIDES", "Extreme", "PeakFactor", "davenport", "extreme", "upcrossing_rate"]

SIDES = ("largest", "smallest", "magnitude")
"""Which extreme: of X, of -X, of its size."""

_FEWEST = 10.0
"""Crossings of the mean from which Davenport's formula is right within some 3 per cent."""

_FAR = 38.0
"""Standard deviations beyond which a Gaussian number is never found: its density underflows."""

_LEVELS = 400
_BLOCK = 2_000_000
"""Levels of a distribution, and levels times instants that are worked on at once."""


class PeakFactor(NamedTuple):
    """Mean and standard deviation of a largest value, in standard deviations of the process."""

    mean: float
    standard_deviation: float


def davenport(rate: float, duration: float) -> PeakFactor:
    """Return the peak factor of a stationary Gaussian process of mean zero.

    ``g = sqrt(2 ln(nu T)) + 0.5772 / sqrt(2 ln(nu T))``, deviation ``pi / sqrt(6) / sqrt(2 ln(nu
    T))``.

    Parameters
    ----------
    rate : float
        nu, 1/s: up-crossings of the mean, s' / (2 pi s).
    duration : float
        T, s.

    Raises
    ------
    InputError
        Fewer than 10 up-crossings: the formula holds for many. At 10 its mean is 3 % too large, its
        deviation 15 %; at 1000 these are 0.4 % and 8 %.

    Source: Davenport (1964), Proceedings of the Institution of Civil Engineers 28, pp. 187-196.
    """
    rate = number("rate", rate, above=0.0, unit="1/s")
    duration = number("duration", duration, above=0.0, unit="s")
    if rate * duration < _FEWEST:
        raise InputError(
            "duration", duration,
            f"must hold {_FEWEST:g} up-crossings of the mean, it holds {rate * duration:.3g}",
            "Use extreme(), which needs no long record",
        )  # fmt: skip
    root = math.sqrt(2 * math.log(rate * duration))
    return PeakFactor(root + np.euler_gamma / root, math.pi / math.sqrt(6) / root)


def upcrossing_rate(
    level: float | np.ndarray,
    mean: float | np.ndarray,
    sd: float | np.ndarray,
    mean_rate: float | np.ndarray,
    sd_rate: float | np.ndarray,
    correlation: float | np.ndarray = 0.0,
) -> np.ndarray:
    """Return how often a Gaussian process crosses levels upwards, 1/s.

    The formula and where it comes from stand at the head of this module. Of -X the same gives the
    down-crossings: ``upcrossing_rate(-level, -mean, sd, -mean_rate, sd_rate, correlation)``.

    Parameters
    ----------
    level : float or array_like, shape (...)
        In the unit of the process.
    mean, sd : float or array_like, shape (n,)
        m and s. Where s is zero nothing is random and the rate is zero.
    mean_rate, sd_rate : float or array_like, shape (n,)
        m' and the standard deviation of X', the unit of the process over s.
    correlation : float or array_like, shape (n,)
        Of X and X' at the same time, -1 to 1; zero if s does not change. Not read where `sd` or
        `sd_rate` is zero: there it means nothing and may be NaN.

    Returns
    -------
    ndarray, shape (..., n), or (...) if all the others are single numbers

    Raises
    ------
    InputError
        Naming what is not finite, negative, or of another length.

    Source: Rice (1944, 1945), Bell System Technical Journal 23 and 24, Eq. 3.3-5; Cramer &
    Leadbetter (1967), Stationary and Related Stochastic Processes, for moving mean and deviation.
    """
    levels = numbers("level", np.ravel(np.asarray(level))).reshape(np.shape(level))
    single = all(np.ndim(v) == 0 for v in (mean, sd, mean_rate, sd_rate, correlation))
    found = _process(mean, sd, mean_rate, sd_rate, correlation)
    rate = _rates(levels[..., None], *found)
    return rate[..., 0] if single else rate


@dataclass(frozen=True, eq=False)
class Extreme:
    """Distribution of the extreme of a Gaussian process over a time.

    Attributes
    ----------
    side : {"largest", "smallest", "magnitude"}
    levels : ndarray, shape (k,)
        In the unit of the process, ascending.
    probability : ndarray, shape (k,)
        That the extreme lies below a level. Zero at the first, one at the last but for 1e-9,
        unless nothing is random: then all levels are one.
    of_mean : float
        The same extreme of the mean m(t) alone.
    largest_sd : float
        The largest s(t).
    """

    __repr__ = brief

    side: str
    levels: np.ndarray
    probability: np.ndarray
    of_mean: float
    largest_sd: float

    @property
    def mean(self) -> float:
        """Mean of the extreme."""
        return float(self.levels[-1] - trapezoid(self.probability, self.levels))

    @property
    def standard_deviation(self) -> float:
        """Standard deviation of the extreme."""
        # Of M - c, E[(M - c)^2] = (top - c)^2 - 2 integral of (b - c) P db; with c the mean no
        # large numbers are subtracted.
        off = self.levels - self.mean
        square = off[-1] ** 2 - 2 * trapezoid(off * self.probability, self.levels)
        return math.sqrt(max(square, 0.0))

    @property
    def peak_factor(self) -> float:
        """Distance of the mean extreme from that of the mean, in largest standard deviations.

        NaN where nothing is random.
        """
        off = self.mean - self.of_mean
        off = -off if self.side == "smallest" else off
        return off / self.largest_sd if self.largest_sd else math.nan

    def percentile(self, p: float) -> float:
        """Return the level below which the extreme lies in p per cent of all cases.

        Parameters
        ----------
        p : float
            From 0.1 to 99.9.
        """
        share = number("p", p, least=0.1, most=99.9, remedy="Give 95 for 95 %") / 100
        return float(np.interp(share, self.probability, self.levels))

    def to_frame(self):
        """Return a pandas DataFrame with one row a level, in the unit of the process."""
        import pandas as pd

        return pd.DataFrame({"level": self.levels, "probability below": self.probability})


def extreme(
    time: np.ndarray,
    mean: np.ndarray,
    sd: np.ndarray,
    mean_rate: np.ndarray,
    sd_rate: np.ndarray,
    correlation: np.ndarray | float = 0.0,
    *,
    side: str = "largest",
) -> Extreme:
    """Return the distribution of the extreme of a Gaussian process that is not stationary.

    Parameters
    ----------
    time : array_like, shape (n,)
        s, ascending; steps so short that mean and deviation change by less than a deviation in
        each. Two instants do for a stationary process.
    mean, sd, mean_rate, sd_rate, correlation : array_like, shape (n,), or one number
        As `upcrossing_rate`. `sd` may be zero at times, as before the train enters.
    side : {"largest", "smallest", "magnitude"}
        Of X, of X downwards, of its size from zero.

    Raises
    ------
    InputError
        As `upcrossing_rate`; times that do not ascend.

    Source: the head of this module; the divisor is the time spent below in Vanmarcke (1975),
    Journal of Applied Mechanics 42, pp. 215-220. In the stationary case and for many crossings it
    tends to `davenport`.
    """
    time = numbers("time", time, unit="s")
    if len(time) < 2 or np.any(np.diff(time) <= 0.0):
        raise InputError("time", time, "must hold two instants or more, ascending")
    choice("side", side, SIDES)
    m, s, rate, sd_rate, rho = _process(mean, sd, mean_rate, sd_rate, correlation, len(time))
    if side == "smallest":
        m, rate = -m, -rate
    size = np.abs(m) if side == "magnitude" else m
    both = side == "magnitude"

    def below(levels: np.ndarray) -> np.ndarray:
        rows = max(1, _BLOCK // len(time))
        blocks = (levels[i : i + rows, None] for i in range(0, len(levels), rows))
        process = (m, s, rate, sd_rate, rho)
        return np.concatenate([_below(b, time, process, both) for b in blocks])

    low, high = float(np.max(size - 9 * s)), float(np.max(size + 9 * s))
    levels = np.linspace(max(low, 0.0) if both else low, high, _LEVELS)
    # Again where the extreme can be; an extreme that is never random is one level, kept twice.
    inside = below(levels)
    first = max(int(np.searchsorted(inside, 1e-9, side="right")) - 1, 0)
    last = min(int(np.searchsorted(inside, 1 - 1e-9)), _LEVELS - 1)
    levels = np.linspace(levels[first], levels[last], _LEVELS)
    probability = below(levels)
    of_mean = float(np.max(size))
    if side == "smallest":
        levels, probability, of_mean = -levels[::-1], 1.0 - probability[::-1], -of_mean
    return Extreme(side, frozen(levels), frozen(probability), of_mean, float(np.max(s)))


def _process(
    mean: Any, sd: Any, mean_rate: Any, sd_rate: Any, correlation: Any, count: int | None = None
) -> tuple[np.ndarray, ...]:
    """Return mean, deviation, their rates and the correlation, all of one length, checked."""
    given = {
        "mean": mean, "sd": sd, "mean_rate": mean_rate, "sd_rate": sd_rate,
        "correlation": correlation,
    }  # fmt: skip
    lengths = [np.size(v) for v in given.values() if np.ndim(v)]
    count = count or max(lengths, default=1)
    found = {}
    for name, value in given.items():
        value = value if np.ndim(value) else np.full(count, value)
        if name == "correlation":
            random = (found["sd"] > 0.0) & (found["sd_rate"] > 0.0)
            value = np.asarray(value)
            value = np.where(random, value, 0.0) if value.shape == (count,) else value
        limits = {"least": 0.0} if name.startswith("sd") else {}
        found[name] = numbers(name, value, count=count, **limits)
    rho = found["correlation"]
    # Rounding takes a correlation of one a little beyond.
    if np.any(np.abs(rho) > 1 + 1e-6):
        raise InputError("correlation", float(rho[np.argmax(np.abs(rho))]), "must be from -1 to 1")
    return (*list(found.values())[:4], np.clip(rho, -1.0, 1.0))


def _density(z: np.ndarray) -> np.ndarray:
    return np.exp(-0.5 * z * z) / math.sqrt(2 * math.pi)


def _over(top: np.ndarray, bottom: np.ndarray) -> np.ndarray:
    """Return a quotient within what matters, its sign's end of that where the divisor is zero."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.clip(np.nan_to_num(top / bottom, nan=0.0), -_FAR, _FAR)


def _rates(
    level: np.ndarray, m: np.ndarray, s: np.ndarray, m_rate: np.ndarray, s_rate: np.ndarray,
    rho: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Return up-crossings a second of checked numbers; levels and times broadcast."""
    eta = _over(level - m, s)
    given = m_rate + rho * s_rate * eta
    left = s_rate * np.sqrt(1.0 - rho * rho)
    ratio = _over(given, left)
    up = np.maximum(left * _density(ratio) + given * ndtr(ratio), 0.0)
    return np.where(s > 0.0, _density(eta) / np.where(s > 0.0, s, 1.0) * up, 0.0)


def _below(
    level: np.ndarray, time: np.ndarray, process: tuple[np.ndarray, ...], both: bool
) -> np.ndarray:
    """Return the probability, shape (k,), that X (its size, if both) stays below levels (k, 1)."""
    m, s, m_rate, s_rate, rho = process
    inside = ndtr(_over(level - m, s))
    rates = _rates(level, *process)
    if both:
        inside = inside - ndtr(_over(-level - m, s))
        rates = rates + _rates(level, -m, s, -m_rate, s_rate, rho)
    # Nobody is below where only a rounded zero is left.
    hazard = np.divide(rates, inside, out=np.zeros_like(rates), where=inside > 1e-300)
    stays = inside[:, 0] * np.exp(-trapezoid(hazard, time, axis=1))
    return np.minimum(stays, np.min(inside, axis=1))
