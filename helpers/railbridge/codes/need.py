"""Whether a bridge needs a dynamic analysis, and over which speeds."""

from __future__ import annotations

from .. import errors
from .clauses import (
    FREQUENCY,
    KMH,
    LENGTH,
    SPEED,
    Answer,
    Clause,
    Within,
    by_clause,
    not_above,
    outside,
)
from .frequencies import Bounds, n0_bounds, outside_n0_bounds

__all__ = ["analysis_speeds", "dynamic_analysis_needed"]

_STATIC_UP_TO = 200.0 * KMH

_NEED = Clause(
    "need of a dynamic analysis", "EN 1991-2", "6.4.4, Figure 6.9", "", "two",
    conditions=(
        "up to 200 km/h: simple structures, 4 m <= L <= 100 m. The branches of the chart that free "
        "other bridges (continuous ones, L >= 40 m, torsion above 1.2 n0, the tables of Annex F) "
        "are not decided: they are known from memory only"
    ),
)  # fmt: skip
_SPEEDS = Clause(
    "speeds of a dynamic analysis", "EN 1991-2", "6.4.6", "m/s", "memory",
    ranges=(Within("v", least=40.0 / 1.2, unit="m/s"),),
    conditions="finer near the speeds of resonance, n0 times a spacing of axles",
)  # fmt: skip


@by_clause(_NEED)
def dynamic_analysis_needed(L: float, n0: float, v: float, *, simple: bool = True) -> Answer:
    """Return whether static effects with Phi are not enough, by the confirmed part of Figure 6.9.

    Not needed: up to 200 km/h, a simple structure whose first frequency is within Figure 6.10.
    Needed: above 200 km/h, or with a frequency outside.

    Parameters
    ----------
    L : float
        Span, m.
    n0 : float
        First bending frequency under permanent load, Hz.
    v : float
        Speed of the line, m/s.
    simple : bool
        Whether the structure is a simple one: a beam or slab on two lines of bearings, not skew.

    Returns
    -------
    Answer
        Yes or no; undecided for other structures and for spans beyond Figure 6.10. It never says
        no where the rest of the chart would have to be read.

    Raises
    ------
    InputError
    """
    length, frequency = LENGTH.checked("L", L), FREQUENCY.checked("n0", n0)
    speed = SPEED.checked("v", v)
    errors.boolean("simple", simple)
    if not not_above(speed, _STATIC_UP_TO):
        return Answer(True, _NEED, f"v = {speed:.5g} m/s is above 200 km/h")
    if not simple:
        return Answer(None, _NEED, "the structure is not a simple one")
    reason = outside_n0_bounds(length, frequency)
    if not reason:
        return Answer(False, _NEED, "simple, up to 200 km/h, n0 within Figure 6.10")
    return Answer(True if n0_bounds(length).lower.decided else None, _NEED, reason)


@by_clause(_SPEEDS)
def analysis_speeds(v: float) -> Bounds:
    """Return the slowest and the fastest speed of a dynamic analysis: 40 m/s to 1.2 v.

    Parameters
    ----------
    v : float
        Speed of the line, m/s.

    Returns
    -------
    Bounds
        m/s.

    Raises
    ------
    InputError
    """
    speed = SPEED.checked("v", v)
    if reason := outside(_SPEEDS, v=speed):
        return Bounds(*[Answer(None, _SPEEDS, reason)] * 2)
    return Bounds(Answer(40.0, _SPEEDS), Answer(max(1.2 * speed, 40.0), _SPEEDS))
