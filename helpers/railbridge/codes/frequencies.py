"""The first bending frequency of a bridge: from its deflection, and the usual bounds by span."""

from __future__ import annotations

import math
from typing import NamedTuple

from .. import errors
from .clauses import FREQUENCY, LENGTH, Answer, Clause, Within, by_clause, not_above, outside

__all__ = ["Bounds", "frequency_from_deflection", "n0_bounds", "outside_n0_bounds"]

_SPANS = Within("L", least=4.0, most=100.0, unit="m")
_FIGURE = Clause(
    "bounds of the first frequency", "EN 1991-2", "6.4.4, Figure 6.10", "Hz", "two",
    ranges=(_SPANS,), conditions="first bending frequency under permanent load",
)  # fmt: skip
_DEFLECTION = Clause(
    "frequency from the deflection", "EN 1991-2", "6.4.4, Figure 6.10", "Hz", "two",
    conditions="simple beams, deflection at midspan under permanent load",
)  # fmt: skip


class Bounds(NamedTuple):
    """A lower and an upper bound.

    Attributes
    ----------
    lower, upper : Answer
    """

    lower: Answer
    upper: Answer


@by_clause(_FIGURE)
def n0_bounds(L: float) -> Bounds:
    """Return between which first bending frequencies n0 the dynamic factors Phi cover a bridge.

    Upper 94.76 L^-0.748; lower 80 / L to 20 m, 23.58 L^-0.592 beyond.

    Parameters
    ----------
    L : float
        Span of a simple beam, m; of other bridges the determinant length.

    Returns
    -------
    Bounds
        Hz.

    Raises
    ------
    InputError
    """
    length = LENGTH.checked("L", L)
    if reason := outside(_FIGURE, L=length):
        return Bounds(*[Answer(None, _FIGURE, reason)] * 2)
    lower = 80.0 / length if not_above(length, 20.0) else 23.58 * length**-0.592
    return Bounds(Answer(lower, _FIGURE), Answer(94.76 * length**-0.748, _FIGURE))


def outside_n0_bounds(L: float, n0: float) -> str:
    """Return why a frequency is outside Figure 6.10, or the span is; empty where it is within.

    Parameters
    ----------
    L, n0 : float
        m, Hz.

    Raises
    ------
    InputError
    """
    frequency = FREQUENCY.checked("n0", n0)
    lower, upper = n0_bounds(L)
    if not lower.decided:
        return lower.reason
    if not_above(float(lower), frequency) and not_above(frequency, float(upper)):
        return ""
    bounds = f"{float(lower):.5g} to {float(upper):.5g} Hz"
    return f"n0 = {frequency:.5g} Hz is outside {bounds} of {_FIGURE.name} at L = {L:.5g} m"


@by_clause(_DEFLECTION)
def frequency_from_deflection(delta0: float) -> Answer:
    """Return the first bending frequency of a simple beam, 17.75 / sqrt(delta0 in mm).

    Parameters
    ----------
    delta0 : float
        Deflection at midspan under permanent load, m, down positive.

    Returns
    -------
    Answer
        Hz.

    Raises
    ------
    InputError
    """
    remedy = "Give the deflection in m, down positive"
    deflection = errors.number("delta0", delta0, above=0.0, unit="m", remedy=remedy)
    return Answer(17.75 / math.sqrt(1e3 * deflection), _DEFLECTION)
