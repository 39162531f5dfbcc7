"""Speeds that are chosen: as many as the peaks need, where they need them.

A peak counts as found when halving the steps beside it changes its height by no more than
`SETTLED`. Peaks that one has no reason to look for are looked for too: the search starts from an
even grid, from the speeds at which the train meets the deck's first mode in step, and from the
peaks of the residual influence line, which costs next to nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.signal import find_peaks

from .. import errors
from ..decks import Deck
from ..errors import InputError
from ..trains import AnyTrain
from .resonance import residual_acceleration, resonance_speeds

__all__ = ["EVEN", "SETTLED", "Between", "refined", "starting_speeds"]

SETTLED = 5e-3
"""Change of a peak, relative, that halving the steps may still make."""
EVEN = 121
"""Speeds of the even grid to begin with."""
_FINE = 2001
_STANDS_OUT = 0.03
"""What a peak must stand above its surroundings, share of the highest; ripples are left alone."""
_SAFE = 2.0
"""A peak that has grown by less than this part of `SETTLED` is settled: some are sharp."""
_ROUNDS = 20


@dataclass(frozen=True)
class Between:
    """Speeds from one to another, to be chosen.

    Attributes
    ----------
    low, high : float
        m/s.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        low = errors.number("speeds.low", self.low, above=0.0, most=200.0, unit="m/s")
        high = errors.number("speeds.high", self.high, above=0.0, most=200.0, unit="m/s")
        if not low < high:
            raise InputError("speeds", [low, high], "must go from a lower to a higher speed")


def starting_speeds(deck: Deck, train: AnyTrain, between: Between) -> np.ndarray:
    """Return where the search for peaks begins, m/s, ascending."""
    low, high = between.low, between.high
    found = [np.linspace(low, high, EVEN), resonance_speeds(deck, train, low, high)]
    fine = np.linspace(low, high, _FINE)
    bound = residual_acceleration(deck, train, fine)
    if bound is not None:
        found.append(fine[_peaks(bound)])
    return np.unique(np.round(np.concatenate(found), 9))


def refined(evaluate: Callable[[np.ndarray], np.ndarray], start: np.ndarray) -> np.ndarray:
    """Return speeds between which no peak is missed by more than `SETTLED`.

    Parameters
    ----------
    evaluate : function of speeds, shape (n,)
        Gives the responses, shape (n, quantities), not negative; NaN where one failed.
    start : ndarray, shape (n,)
        Ascending.

    Returns
    -------
    ndarray
        Those of the start, and what was added beside peaks.
    """
    speeds, values = start, evaluate(start)
    open_peaks = _all_peaks(values)
    for _ in range(_ROUNDS):
        added = np.unique(
            [
                round(0.5 * (speeds[i] + speeds[j]), 9)
                for i in open_peaks
                for j in (i - 1, i + 1)
                if 0 <= j < len(speeds)
            ]
        )
        added = added[~np.isin(added, speeds)]
        if not len(added):
            break
        before = {float(speeds[i]): values[i] for i in open_peaks}
        more = evaluate(added)
        order = np.argsort(np.concatenate([speeds, added]), kind="stable")
        speeds = np.concatenate([speeds, added])[order]
        values = np.concatenate([values, more])[order]
        open_peaks = [i for i in _all_peaks(values) if _grew(speeds, values, i, before)]
    return speeds


def _grew(speeds: np.ndarray, values: np.ndarray, i: int, before: dict[float, np.ndarray]) -> bool:
    """Whether a peak is higher than any that stood beside it before, by more than `SETTLED`."""
    near = [float(speeds[j]) for j in (i - 1, i, i + 1) if 0 <= j < len(speeds)]
    known = [before[speed] for speed in near if speed in before]
    if not known:
        return float(speeds[i]) not in before
    own, old = values[i], np.max(known, axis=0)
    return bool(np.any(own > old * (1.0 + SETTLED / _SAFE)))


def _peaks(values: np.ndarray) -> np.ndarray:
    """Return where a curve has peaks that stand out, its ends counted."""
    known = np.nan_to_num(values, nan=0.0)
    padded = np.concatenate([[0.0], known, [0.0]])
    found, _ = find_peaks(padded, prominence=_STANDS_OUT * max(known.max(initial=0.0), 1e-300))
    return found - 1


def _all_peaks(values: np.ndarray) -> list[int]:
    found = [_peaks(column) for column in values.T]
    return sorted(set(np.concatenate(found).tolist())) if found else []
