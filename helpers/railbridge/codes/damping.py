"""Damping for a dynamic analysis: lower bounds by material and span, and the additional damping."""

from __future__ import annotations

from .. import errors
from ..errors import InputError
from .clauses import LENGTH, Answer, Clause, Within, by_clause, outside

__all__ = [
    "DAMPING", "additional_damping", "damping_limit", "damping_lower_bound", "damping_ratio",
]  # fmt: skip

DAMPING = {
    "steel": (0.005, 0.00125),
    "composite": (0.005, 0.00125),
    "prestressed concrete": (0.010, 0.0007),
    "filler beam": (0.015, 0.0007),
    "reinforced concrete": (0.015, 0.0007),
}
"""By kind of bridge: damping ratio from a span of 20 m on, and what each metre below it adds."""

_LOWER = Clause(
    "lower bound of damping", "EN 1991-2", "6.4.6", "", "two",
    ranges=(Within("L", above=0.0, unit="m"),),
    conditions="damping ratio, by kind of bridge: " + ", ".join(DAMPING),
)  # fmt: skip
_ADDITIONAL = Clause(
    "additional damping", "EN 1991-2", "6.4.6", "", "two",
    ranges=(Within("L", above=0.0, below=30.0, unit="m"),),
    conditions=(
        "only for constant axle loads, never with vehicles on springs (counted twice); many "
        "countries forbid it; 0 from 29.22 m, where its formula is negative"
    ),
)  # fmt: skip
_LIMIT = Clause(
    "damping of the deck", "EN 1991-2", "6.4.6", "", "two", sense="at most",
    memory="that a measured ratio may be used",
    ranges=(Within("L", above=0.0, unit="m"),),
    conditions="the lower bound, or what was measured on the bridge",
)  # fmt: skip
_RATIO = Clause(
    "damping of the analysis", "EN 1991-2", "6.4.6", "", "two",
    ranges=(Within("L", above=0.0, unit="m"),),
    conditions="as its two parts; without the additional damping unless it is asked for",
)  # fmt: skip


@by_clause(_LOWER)
def damping_lower_bound(kind: str, L: float) -> Answer:
    """Return the damping ratio to be used where nothing better is known.

    0.5 % + 0.125 % per metre below 20 m (steel, composite); 1.0 % + 0.07 % (prestressed concrete);
    1.5 % + 0.07 % (filler beam, reinforced concrete).

    Parameters
    ----------
    kind : str
        One of `DAMPING`.
    L : float
        Span, m.

    Returns
    -------
    Answer
        A fraction: 0.01 for 1 %.

    Raises
    ------
    InputError
        No such kind of bridge.
    """
    base, rise = DAMPING[errors.choice("kind", kind, DAMPING)]
    return Answer(base + rise * max(20.0 - LENGTH.checked("L", L), 0.0), _LOWER)


@by_clause(_ADDITIONAL)
def additional_damping(L: float) -> Answer:
    """Return what damping may be added for the vehicles that constant axle loads leave out.

    (0.0187 L - 0.00064 L^2) / (1 - 0.0441 L - 0.0044 L^2 + 0.000255 L^3) per cent, at least 0.

    Parameters
    ----------
    L : float
        Span, m.

    Returns
    -------
    Answer
        A fraction: 0.003 for 0.3 %.

    Raises
    ------
    InputError

    Notes
    -----
    Nothing of the suite adds it by itself; see `damping_ratio`.
    """
    length = LENGTH.checked("L", L)
    if reason := outside(_ADDITIONAL, L=length):
        return Answer(None, _ADDITIONAL, reason)
    above = 0.0187 * length - 0.00064 * length**2
    below = 1.0 - 0.0441 * length - 0.0044 * length**2 + 0.000255 * length**3
    return Answer(max(above / below / 100.0, 0.0), _ADDITIONAL)


@by_clause(_LIMIT)
def damping_limit(kind: str | None, L: float, measured: float | None = None) -> Answer:
    """Return the damping ratio that a deck in an analysis may have: more is not safe.

    Parameters
    ----------
    kind : str or None
        One of `DAMPING`; undecided where neither kind nor ratio is known.
    L : float
        Span, m.
    measured : float, optional
        Damping ratio measured on the bridge, which then counts.

    Returns
    -------
    Answer
        A fraction.

    Raises
    ------
    InputError
    """
    length = LENGTH.checked("L", L)
    if measured is not None:
        ratio = errors.number("measured", measured, above=0.0, most=0.5)
        return Answer(ratio, _LIMIT, "measured")
    if kind is None:
        known = ", ".join(DAMPING)
        return Answer(None, _LIMIT, f"the kind of bridge is not given, one of {known}")
    return Answer(float(damping_lower_bound(kind, length)), _LIMIT, f"lower bound, {kind}")


@by_clause(_RATIO)
def damping_ratio(
    kind: str, L: float, *, additional: bool = False, vehicles: bool = False
) -> Answer:
    """Return the damping ratio of an analysis: the lower bound, and more only if asked for.

    Parameters
    ----------
    kind : str
        One of `DAMPING`.
    L : float
        Span, m.
    additional : bool
        Whether the additional damping is added.
    vehicles : bool
        Whether the trains of the analysis have vehicles on springs.

    Returns
    -------
    Answer
        A fraction.

    Raises
    ------
    InputError
        Additional damping with vehicles: they already take energy out of the deck.
    """
    lower = damping_lower_bound(kind, L)
    if not errors.boolean("additional", additional):
        errors.boolean("vehicles", vehicles)
        return Answer(float(lower), _RATIO)
    if errors.boolean("vehicles", vehicles):
        allowed = "must be false with vehicles: their springs already damp the deck"
        remedy = "Leave it out, or let constant axle loads cross"
        raise InputError("additional", additional, allowed, remedy)
    more = additional_damping(L)
    if not more.decided:
        return Answer(None, _RATIO, more.reason)
    return Answer(float(lower) + float(more), _RATIO)
