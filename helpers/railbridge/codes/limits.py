"""Limits: accelerations, twist and deformations of decks, comfort, wheels and bearings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .. import errors
from ..cutoffs import counted, different, en1990_limit
from ..errors import InputError
from ..tracks import TWIST_LENGTH
from .clauses import KMH, LENGTH, SPEED, UNSEEN, Answer, Clause, by_clause, not_above

__all__ = [
    "ACCELERATIONS", "COMFORT", "TWIST_LENGTH", "KeptModes", "acceleration_limit", "comfort_limit",
    "deflection_limit", "frequency_limit", "horizontal_radius_limit", "horizontal_rotation_limit",
    "kept_modes", "lateral_frequency_limit", "total_twist_limit", "twist_limit", "uplift_limit",
    "wheel_unloading_limit",
]  # fmt: skip

ACCELERATIONS = {"ballasted": 3.5, "direct fastening": 5.0}
"""m/s2, by how the track lies on the deck."""
COMFORT = {"very good": 1.0, "good": 1.3, "acceptable": 2.0}
"""m/s2, by level of comfort."""

_TWISTS = (0.0045, 0.0030, 0.0015)
_ROTATIONS = (0.0035, 0.0020, 0.0015)
_RADII = {"one": (1700.0, 6000.0, 14000.0), "several": (3500.0, 9500.0, 17500.0)}
"""Up to 120 km/h, up to 200 km/h, above."""

_MOST, _LEAST = "at most", "at least"
_CODE, _PLACE = "EN 1990", "A2.4.4"
_ACCELERATION = Clause(
    "deck acceleration", _CODE, _PLACE, "m/s2", "two", sense=_MOST,
    conditions="ballasted track or direct fastening; of the modes of `kept_modes`, not filtered",
)  # fmt: skip
_FREQUENCIES = Clause(
    "highest frequency of deck accelerations", _CODE, _PLACE, "Hz", "memory",
    conditions="three different frequencies of the member or more are known",
)  # fmt: skip
_KEPT = Clause(
    "modes in deck accelerations", _CODE, _PLACE, "", "memory",
    conditions="three different frequencies of the member or more are known",
)  # fmt: skip
_TWIST = Clause(
    "twist over 3 m", _CODE, _PLACE, "m", "two", sense=_MOST,
    conditions="height between the rails over 3 m of track, by the speed of the line",
)  # fmt: skip
_TOTAL_TWIST = Clause(
    "total twist over 3 m", _CODE, _PLACE, "m", "two", sense=_MOST, memory="what is in the total",
    conditions="with the twist that the track has without a train, as in transitions",
)  # fmt: skip
_DEFLECTION = Clause(
    "deflection", _CODE, _PLACE, "m", "two", sense=_MOST,
    conditions="under LM71 with Phi and alpha",
)  # fmt: skip
_ROTATION = Clause(
    "horizontal rotation of a deck's end", _CODE, _PLACE, "rad", "two", sense=_MOST,
    conditions="by the speed of the line",
)  # fmt: skip
_RADIUS = Clause(
    "radius of a deck bent sideways", _CODE, _PLACE, "m", "two", sense=_LEAST,
    conditions="by the speed of the line and whether there is one span or several",
)  # fmt: skip
_LATERAL = Clause(
    "first lateral frequency of a span", _CODE, _PLACE, "Hz", "two", sense=_LEAST
)  # fmt: skip
_COMFORT = Clause(
    "comfort b_v", _CODE, _PLACE, "m/s2", "two", sense=_MOST,
    conditions=(
        "vertical acceleration in the coach, computed directly; the limits L / delta of Figure "
        "A2.3 are not confirmed"
    ),
)  # fmt: skip
_UNLOADING = Clause(
    "wheel unloading", "EN 14363", "practice of running safety", "", "memory", sense=_MOST,
    magnitude=False,
    conditions="share of the static wheel load; no verdict on Y/Q, which needs flange and creep",
    edition=UNSEEN,
)  # fmt: skip
_UPLIFT = Clause(
    "least reaction of a bearing", _CODE, _PLACE, "N", "memory", sense=_LEAST,
    conditions="bearings that hold nothing down; up positive, permanent load included",
)  # fmt: skip


def _by_speed(v: float, values: Sequence[float]) -> float:
    """Return the value of a line: up to 120 km/h, up to 200 km/h, above."""
    speed = SPEED.checked("v", v)
    return values[sum(not not_above(speed, bound * KMH) for bound in (120.0, 200.0))]


def _named(field: str, value: str, known: Mapping[str, float]) -> float:
    return known[errors.choice(field, value, known)]


# ---- accelerations of the deck


@by_clause(_ACCELERATION)
def acceleration_limit(track: str) -> Answer:
    """Return the largest vertical acceleration of a deck: 3.5 or 5.0 m/s2.

    Parameters
    ----------
    track : str
        ``ballasted`` or ``direct fastening``.

    Returns
    -------
    Answer
        m/s2.

    Raises
    ------
    InputError
    """
    return Answer(_named("track", track, ACCELERATIONS), _ACCELERATION)


@dataclass(frozen=True)
class KeptModes:
    """The modes of which deck accelerations are made.

    Attributes
    ----------
    limit : Answer
        Hz; see `frequency_limit`.
    numbers : tuple of int
        Modes up to the limit, from 1; empty where it is undecided.
    complete : bool
        Whether the list surely holds all of them: it goes on beyond the limit.
    """

    limit: Answer
    numbers: tuple[int, ...]
    complete: bool


def _ascending(frequencies: Sequence[float]) -> list[float]:
    remedy = "Give the frequencies of the deck's modes"
    found = errors.numbers("frequencies", frequencies, above=0.0, unit="Hz", remedy=remedy).tolist()
    if not found or found != sorted(found):
        raise InputError("frequencies", frequencies, "must be given and ascending", remedy)
    return found


@by_clause(_FREQUENCIES)
def frequency_limit(frequencies: Sequence[float]) -> Answer:
    """Return up to where modes count in deck accelerations: the largest of 30 Hz, 1.5 f1 and f3.

    Equal frequencies, as of spans alike in a row, count once; see `railbridge.cutoffs`.

    Parameters
    ----------
    frequencies : sequence of float
        Of the member's modes, Hz, ascending.

    Returns
    -------
    Answer
        Hz.

    Raises
    ------
    InputError
    """
    found = _ascending(frequencies)
    limit = en1990_limit(found)
    if limit is None:
        reason = f"the third frequency is not known, only {len(different(found))} different ones"
        return Answer(None, _FREQUENCIES, reason)
    return Answer(limit, _FREQUENCIES)


@by_clause(_KEPT)
def kept_modes(frequencies: Sequence[float]) -> KeptModes:
    """Return which modes count in deck accelerations.

    Parameters
    ----------
    frequencies : sequence of float
        Of the member's modes, Hz, ascending.

    Returns
    -------
    KeptModes

    Raises
    ------
    InputError

    Notes
    -----
    Keep these modes and leave the others out. To filter the acceleration instead would also take
    away what the kept modes do above their own frequencies.
    """
    found, limit = _ascending(frequencies), frequency_limit(frequencies)
    if not limit.decided:
        return KeptModes(limit, (), False)
    kept = tuple((np.flatnonzero(counted(found, float(limit))) + 1).tolist())
    return KeptModes(limit, kept, len(kept) < len(found))


# ---- deformations


@by_clause(_TWIST)
def twist_limit(v: float) -> Answer:
    """Return the largest twist of the track over 3 m: 4.5, 3.0 or 1.5 mm.

    Up to 120 km/h, up to 200 km/h, above.

    Parameters
    ----------
    v : float
        Speed of the line, m/s.

    Returns
    -------
    Answer
        m, over `TWIST_LENGTH`.

    Raises
    ------
    InputError
    """
    return Answer(_by_speed(v, _TWISTS), _TWIST)


@by_clause(_TOTAL_TWIST)
def total_twist_limit() -> Answer:
    """Return the largest twist of the track over 3 m with what it has without a train: 7.5 mm.

    Returns
    -------
    Answer
        m, over `TWIST_LENGTH`.
    """
    return Answer(0.0075, _TOTAL_TWIST)


@by_clause(_DEFLECTION)
def deflection_limit(L: float) -> Answer:
    """Return the largest deflection, L / 600.

    Parameters
    ----------
    L : float
        Span, m.

    Returns
    -------
    Answer
        m.

    Raises
    ------
    InputError
    """
    return Answer(LENGTH.checked("L", L) / 600.0, _DEFLECTION)


@by_clause(_ROTATION)
def horizontal_rotation_limit(v: float) -> Answer:
    """Return the largest rotation of a deck's end about the vertical: 0.0035, 0.0020, 0.0015 rad.

    Up to 120 km/h, up to 200 km/h, above.

    Parameters
    ----------
    v : float
        Speed of the line, m/s.

    Returns
    -------
    Answer
        rad.

    Raises
    ------
    InputError
    """
    return Answer(_by_speed(v, _ROTATIONS), _ROTATION)


@by_clause(_RADIUS)
def horizontal_radius_limit(v: float, spans: int = 1) -> Answer:
    """Return the smallest radius to which a deck may bend sideways.

    One span 1700, 6000, 14000 m; several 3500, 9500, 17500 m: up to 120 km/h, up to 200, above.

    Parameters
    ----------
    v : float
        Speed of the line, m/s.
    spans : int

    Returns
    -------
    Answer
        m.

    Raises
    ------
    InputError
    """
    count = errors.integer("spans", spans, least=1, remedy="Give the number of spans")
    return Answer(_by_speed(v, _RADII["one" if count == 1 else "several"]), _RADIUS)


@by_clause(_LATERAL)
def lateral_frequency_limit() -> Answer:
    """Return the lowest first lateral frequency of a span, 1.2 Hz.

    Returns
    -------
    Answer
        Hz.
    """
    return Answer(1.2, _LATERAL)


# ---- coaches, wheels, bearings


@by_clause(_COMFORT)
def comfort_limit(level: str = "very good") -> Answer:
    """Return the largest vertical acceleration in the coach b_v: 1.0, 1.3 or 2.0 m/s2.

    Parameters
    ----------
    level : str
        ``very good``, ``good`` or ``acceptable``.

    Returns
    -------
    Answer
        m/s2.

    Raises
    ------
    InputError
    """
    return Answer(_named("level", level, COMFORT), _COMFORT)


@by_clause(_UNLOADING)
def wheel_unloading_limit() -> Answer:
    """Return by which share of its static load a wheel may be unloaded, dQ / Q0 = 0.6.

    Returns
    -------
    Answer
        A fraction.
    """
    return Answer(0.6, _UNLOADING)


@by_clause(_UPLIFT)
def uplift_limit() -> Answer:
    """Return the least reaction of a bearing that holds nothing down: 0, or the deck lifts off.

    Returns
    -------
    Answer
        N, up positive.
    """
    return Answer(0.0, _UPLIFT)
