"""How a coach rides: weightings of ISO 2631 and EN 12299, and Sperling's index.

A weighting is a filter that passes accelerations as strongly as people feel them. It is given by
its analogue transfer function; records are filtered in the time domain by second-order sections.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy import signal

from .. import errors
from ..errors import InputError
from .clauses import UNSEEN, Answer, Clause, by_clause

__all__ = [
    "COARSEST", "RIDE_CLASSES", "SPERLING", "WEIGHTINGS", "largest_running_rms", "ride_class_limit",
    "sperling", "sperling_weighting", "weighted", "weighted_rms", "weighting",
]  # fmt: skip

COARSEST = 2.5e-3
"""s, the longest time step of a record. The filters then err by 4 % at 40 Hz, by 1 % at 20 Hz."""
WEIGHTINGS = {"Wb": (16.0, 16.0), "Wc": (8.0, 8.0), "Wd": (2.0, 2.0)}
"""f3 and f4 of the transition from acceleration to velocity, Hz; Wb vertical, Wd lateral."""
SPERLING = {"vertical": 0.588, "lateral": 0.737}
RIDE_CLASSES = {1: 2.5, 2: 2.75, 3: 3.0}
"""Largest Sperling index by class of ride."""

_BAND = (0.4, 100.0)
_Q_BAND, _Q_TRANSITION = 1.0 / math.sqrt(2.0), 0.63
_STEP = (2.5, 4.0, 0.8, 0.4)
"""Of Wb: f5 and f6 (Hz), Q3 = Q4, K."""

_RECORD = "record of a point of the car body that begins at rest, time step at most 2.5 ms"
_GAIN = Clause(
    "weighting of accelerations", "EN 12299 and ISO 2631", "Wb, Wc, Wd", "", "one",
    conditions="any frequency; Wc and Wd agree with the table of ISO 2631", edition=UNSEEN,
)  # fmt: skip
_WEIGHTED = Clause(
    "weighted acceleration", "EN 12299 and ISO 2631", "Wb, Wc, Wd", "m/s2", "one",
    conditions=_RECORD, edition=UNSEEN,
)  # fmt: skip
_RMS = Clause(
    "weighted r.m.s. acceleration", "EN 12299 and ISO 2631", "Wb, Wc, Wd", "m/s2", "one",
    conditions=f"{_RECORD}; the index N_MV needs a long line", edition=UNSEEN,
)  # fmt: skip
_RUNNING = Clause(
    "largest running r.m.s. acceleration", "EN 12299 and ISO 2631", "Wb, Wc, Wd", "m/s2", "one",
    conditions=f"{_RECORD}, not shorter than the window", edition=UNSEEN,
)  # fmt: skip
_SPERLING_GAIN = Clause(
    "Sperling's weighting", "Sperling", "B", "", "one", conditions="any frequency", edition=UNSEEN
)  # fmt: skip
_INDEX = Clause(
    "Sperling's ride index", "Sperling", "Wz", "", "one", conditions=_RECORD, edition=UNSEEN
)  # fmt: skip
_CLASS = Clause(
    "class of ride", "Sperling", "Wz", "", "one", sense="at most", edition=UNSEEN,
    conditions="classes 1 to 3",
)  # fmt: skip

_Rational = tuple[np.ndarray, np.ndarray]
"""Coefficients of numerator and denominator, the highest power of s first."""


def _quadratic(frequency: float, q: float) -> np.ndarray:
    """Return s^2 + w s / q + w^2."""
    w = 2.0 * math.pi * frequency
    return np.array([1.0, w / q, w * w])


def _stages(name: str) -> list[_Rational]:
    """Return the stages of a weighting: band limits, transition, and the step of Wb."""
    w3, w4 = (2.0 * math.pi * f for f in WEIGHTINGS[name])
    low, high = (_quadratic(f, _Q_BAND) for f in _BAND)
    transition = _quadratic(WEIGHTINGS[name][1], _Q_TRANSITION)
    stages = [
        (np.array([1.0, 0.0, 0.0]), low),
        (high[2:], high),
        (w4**2 * np.array([1.0 / w3, 1.0]), transition),
    ]
    if name == "Wb":
        f5, f6, q, gain = _STEP
        upward, above = _quadratic(f5, q), _quadratic(f6, q)
        stages.append((gain * (f6 / f5) ** 2 * upward, above))
    return stages


def _sperling_stages(direction: str) -> list[_Rational]:
    """Return Sperling's B as a filter: its squares are those of polynomials in i f."""
    powers = (2.0 * math.pi) ** -np.arange(3.0, -1.0, -1.0)
    above = SPERLING[direction] * np.array([0.25, math.sqrt(1.911), 0.0]) * powers[1:]
    return [(above, np.array([0.0368, 0.277, 1.563, 1.0]) * powers)]


def _response(stages: list[_Rational], f: Any) -> np.ndarray | float:
    """Return the gain of stages at frequencies, in the shape these are given in."""
    several = errors.is_list(f)
    remedy = "Give frequencies in Hz"
    given = errors.numbers("f", f if several else [f], least=0.0, unit="Hz", remedy=remedy)
    s = 2j * math.pi * given
    gain = np.ones(len(given))
    for above, below in stages:
        gain *= np.abs(np.polyval(above, s) / np.polyval(below, s))
    return gain if several else float(gain[0])


def _filtered(stages: list[_Rational], acceleration: Any, time_step: float) -> np.ndarray:
    """Return a record after an analogue filter, made digital by the bilinear transform."""
    remedy = "Give the history of an acceleration, m/s2"
    record = errors.numbers("acceleration", acceleration, unit="m/s2", remedy=remedy)
    if len(record) < 2:
        raise InputError("acceleration", acceleration, "must hold at least 2 numbers", remedy)
    remedy = "Compute the crossing with a shorter time step"
    bounds = {"above": 0.0, "most": COARSEST, "unit": "s"}
    step = errors.number("time_step", time_step, **bounds, remedy=remedy)
    for above, below in stages:
        # Stage by stage: the poles at 0.4 and 100 Hz stay apart, so nothing cancels.
        digital = signal.bilinear_zpk(*signal.tf2zpk(above, below), 1.0 / step)
        record = signal.sosfilt(signal.zpk2sos(*digital), record)
    return record


def _rms(record: np.ndarray) -> float:
    return math.sqrt(float(np.mean(record**2)))


@by_clause(_GAIN)
def weighting(name: str, f: Any) -> np.ndarray | float:
    """Return the gain of a weighting at frequencies.

    Parameters
    ----------
    name : str
        ``Wb`` (vertical), ``Wd`` (lateral and lengthwise) or ``Wc`` (lengthwise, at a back rest).
    f : float or array_like, shape (n,)
        Hz.

    Returns
    -------
    float or ndarray, shape (n,)
        Weighted by unweighted amplitude. It is defined at every frequency, so it is a plain number.

    Raises
    ------
    InputError
    """
    return _response(_stages(errors.choice("name", name, WEIGHTINGS)), f)


@by_clause(_WEIGHTED)
def weighted(acceleration: Any, time_step: float, name: str) -> np.ndarray:
    """Return a record of accelerations as people feel it.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        m/s2, of the car body; zero before its first sample.
    time_step : float
        s, at most `COARSEST`.
    name : str
        ``Wb``, ``Wd`` or ``Wc``; see `weighting`.

    Returns
    -------
    ndarray, shape (n,)
        m/s2.

    Raises
    ------
    InputError
    """
    return _filtered(_stages(errors.choice("name", name, WEIGHTINGS)), acceleration, time_step)


@by_clause(_RMS)
def weighted_rms(acceleration: Any, time_step: float, name: str) -> Answer:
    """Return the root mean square of a weighted record.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        m/s2, of the car body; zero before its first sample.
    time_step : float
        s, at most `COARSEST`.
    name : str
        ``Wb``, ``Wd`` or ``Wc``; see `weighting`.

    Returns
    -------
    Answer
        m/s2.

    Raises
    ------
    InputError
    """
    return Answer(_rms(weighted(acceleration, time_step, name)), _RMS)


@by_clause(_RUNNING)
def largest_running_rms(
    acceleration: Any, time_step: float, name: str, window: float = 1.0
) -> Answer:
    """Return the largest root mean square of a weighted record over any second of it.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        m/s2, of the car body; zero before its first sample.
    time_step : float
        s, at most `COARSEST`.
    name : str
        ``Wb``, ``Wd`` or ``Wc``; see `weighting`.
    window : float
        s.

    Returns
    -------
    Answer
        m/s2; undecided for a record shorter than the window.

    Raises
    ------
    InputError
    """
    remedy = "Take 1 s, as the standard does"
    seconds = errors.number("window", window, least=COARSEST, unit="s", remedy=remedy)
    squares = weighted(acceleration, time_step, name) ** 2
    count = max(round(seconds / time_step), 1)
    if len(squares) < count:
        length = len(squares) * time_step
        reason = f"the record of {length:.4g} s is shorter than the window of {seconds:.4g} s"
        return Answer(None, _RUNNING, reason)
    sums = np.convolve(squares, np.ones(count), mode="valid")
    return Answer(math.sqrt(float(sums.max()) / count), _RUNNING)


@by_clause(_SPERLING_GAIN)
def sperling_weighting(direction: str, f: Any) -> np.ndarray | float:
    """Return Sperling's weighting B at frequencies.

    c sqrt((1.911 f^2 + (0.25 f^2)^2) / ((1 - 0.277 f^2)^2 + (1.563 f - 0.0368 f^3)^2)), where c is
    0.588 vertically and 0.737 laterally.

    Parameters
    ----------
    direction : str
        ``vertical`` or ``lateral``.
    f : float or array_like, shape (n,)
        Hz.

    Returns
    -------
    float or ndarray, shape (n,)
        It is defined at every frequency, so it is a plain number.

    Raises
    ------
    InputError
    """
    return _response(_sperling_stages(errors.choice("direction", direction, SPERLING)), f)


@by_clause(_INDEX)
def sperling(acceleration: Any, time_step: float, direction: str) -> Answer:
    """Return Sperling's ride index Wz = 4.42 (r.m.s. of B a)^0.3.

    Parameters
    ----------
    acceleration : array_like, shape (n,)
        m/s2, of the car body; zero before its first sample.
    time_step : float
        s, at most `COARSEST`.
    direction : str
        ``vertical`` or ``lateral``.

    Returns
    -------
    Answer

    Raises
    ------
    InputError

    Notes
    -----
    A record that goes on after the car has come to rest lowers the index: compare records of
    equal length.
    """
    stages = _sperling_stages(errors.choice("direction", direction, SPERLING))
    return Answer(4.42 * _rms(_filtered(stages, acceleration, time_step)) ** 0.3, _INDEX)


@by_clause(_CLASS)
def ride_class_limit(number: int) -> Answer:
    """Return the largest Sperling index of a class of ride: 2.5, 2.75 or 3.0.

    Parameters
    ----------
    number : int
        1, the best, to 3.

    Returns
    -------
    Answer

    Raises
    ------
    InputError
    """
    remedy = "1 is the best class"
    return Answer(
        RIDE_CLASSES[errors.integer("number", number, least=1, most=3, remedy=remedy)], _CLASS
    )
