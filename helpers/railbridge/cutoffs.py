"""Up to which frequency modes count in a deck's accelerations.

An acceleration hangs on how many modes it is made of, more than any other answer. EN 1990, A2.4.4,
asks for those up to the largest of 30 Hz, 1.5 times the first and the third frequency of the
member. Modes are kept or left out: a filter would also take away what the kept modes do above
their own frequencies.

Spans alike in a row have equal frequencies, which count once: a viaduct's third frequency is not
the first one of its third span.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .decks import EQUAL

__all__ = ["EN1990_LEAST", "counted", "different", "en1990_limit"]

EN1990_LEAST = 30.0
"""Hz."""
_FIRST = 1.5
"""Times the first frequency."""


def different(frequencies_hz: Sequence[float]) -> np.ndarray:
    """Return the different ones of some frequencies, of equal ones the highest.

    Parameters
    ----------
    frequencies_hz : sequence of float

    Returns
    -------
    ndarray
        Hz, ascending.
    """
    known = np.sort(np.asarray(frequencies_hz, dtype=float))
    last = np.ones(len(known), dtype=bool)
    last[:-1] = known[1:] > known[:-1] * (1.0 + EQUAL)
    return known[last]


def en1990_limit(frequencies_hz: Sequence[float]) -> float | None:
    """Return up to which frequency EN 1990, A2.4.4, has modes counted, Hz.

    Parameters
    ----------
    frequencies_hz : sequence of float
        Of the member's modes.

    Returns
    -------
    float or None
        The largest of 30 Hz, 1.5 f1 and f3 of the `different` frequencies; None where fewer than
        three are known.
    """
    known = different(frequencies_hz)
    if len(known) < 3:
        return None
    return float(max(EN1990_LEAST, _FIRST * known[0], known[2]))


def counted(frequencies_hz: Sequence[float], up_to_hz: float) -> np.ndarray:
    """Return whether each mode counts: its frequency is at most the limit, or equal to it.

    Parameters
    ----------
    frequencies_hz : sequence of float, shape (m,)
    up_to_hz : float

    Returns
    -------
    ndarray of bool, shape (m,)
    """
    return np.asarray(frequencies_hz, dtype=float) <= up_to_hz * (1.0 + EQUAL)
