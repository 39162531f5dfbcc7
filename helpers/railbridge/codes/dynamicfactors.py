"""Dynamic factors: Phi for load models that stand still, phi' and phi'' for real trains.

phi' is what the passage of smooth axle loads adds to the static effect, phi'' what the unevenness
of the track adds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

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
    outside,
)
from .frequencies import outside_n0_bounds

__all__ = [
    "determinant_length", "dynamic_effect", "dynamic_effect_limit", "phi2", "phi3",
    "phi_double_prime", "phi_prime", "real_train_factor", "reduced_for_cover", "track_factor",
]  # fmt: skip

# The formulas have a pole at sqrt(L) = 0.2.
_POLE = Within("L", above=0.04, unit="m")
_NOT_FOR = "not for real trains, HSLM, fatigue trains and the unloaded train"
_PHI2, _PHI3 = (
    Clause(
        f"dynamic factor {name}", "EN 1991-2", "6.4.5", "", "two",
        memory="number of the clause, and for which track it is", ranges=(_POLE,),
        conditions=f"{track} track; {_NOT_FOR}",
    )
    for name, track in (("Phi2", "carefully maintained"), ("Phi3", "standard"))
)  # fmt: skip
_LENGTH = Clause(
    "determinant length", "EN 1991-2", "6.4.5", "m", "one", memory="number of the clause",
    conditions="simple beams, and beams over several spans",
)  # fmt: skip
_COVER = Clause(
    "dynamic factor under cover", "EN 1991-2", "6.4.5", "", "one", memory="number of the clause",
    ranges=(Within("phi", least=1.0, most=2.0),), conditions="nothing is taken off up to 1 m",
)  # fmt: skip
_FIGURE = "n0 within Figure 6.10"
_LINE_SPEED = Within("v", most=200.0 * KMH, unit="m/s")
_REAL = [
    Clause(
        title, "EN 1991-2", "Annex C", "", "two", memory="speed limit of 200 km/h",
        ranges=(_LINE_SPEED,), conditions=_FIGURE,
    )
    for title in ("phi' of real trains", "phi'' of real trains", "dynamic factor of real trains")
]  # fmt: skip
_PHI_PRIME, _PHI_DOUBLE_PRIME, _REAL_TRAIN = _REAL
_TRACK = Clause(
    "factor for the track", "EN 1991-2", "6.4.6 and Annex C", "", "two",
    conditions=f"{_FIGURE}; any speed, for phi'' does not change from 22 m/s",
)  # fmt: skip
_EFFECT = Clause(
    "dynamic moment of a train", "EN 1991-2", "6.4.6.5", "N m", "two",
    memory="number of the clause",
    conditions="bending moments; phi'_dyn of the same train on a smooth track",
)  # fmt: skip
_EFFECT_LIMIT = Clause(
    "moment by dynamic analysis", "EN 1991-2", "6.4.6.5", "N m", "two", sense="at most",
    memory="number of the clause",
    conditions=(
        "bending moments; a deck that bears Phi times the load models bears the trains, too; "
        "where they do more, they govern"
    ),
)  # fmt: skip


@by_clause(_PHI2)
def phi2(L: float) -> Answer:
    """Return Phi2 = 1.44 / (sqrt(L) - 0.2) + 0.82, at least 1.00 and at most 1.67.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span, see `determinant_length`.

    Returns
    -------
    Answer
        By which static effects of LM71, SW/0 and SW/2 are multiplied.

    Raises
    ------
    InputError
    """
    return _phi(_PHI2, L, 1.44, 0.82, 1.67)


@by_clause(_PHI3)
def phi3(L: float) -> Answer:
    """Return Phi3 = 2.16 / (sqrt(L) - 0.2) + 0.73, at least 1.00 and at most 2.00.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span, see `determinant_length`.

    Returns
    -------
    Answer
        By which static effects of LM71, SW/0 and SW/2 are multiplied.

    Raises
    ------
    InputError
    """
    return _phi(_PHI3, L, 2.16, 0.73, 2.00)


def _phi(clause: Clause, L: float, rise: float, base: float, most: float) -> Answer:
    length = LENGTH.checked("L", L)
    if reason := outside(clause, L=length):
        return Answer(None, clause, reason)
    return Answer(min(max(rise / (math.sqrt(length) - 0.2) + base, 1.0), most), clause)


@by_clause(_LENGTH)
def determinant_length(spans: Sequence[float]) -> Answer:
    """Return the determinant length L_Phi of a beam on 2 or more supports.

    One span: its length. Several: k times their mean, at least the longest; k = 1.2, 1.3, 1.4 for
    2, 3, 4 spans and 1.5 from 5 on.

    Parameters
    ----------
    spans : sequence of float
        m, one after the other.

    Returns
    -------
    Answer
        m.

    Raises
    ------
    InputError
    """
    lengths = errors.numbers("spans", spans, above=0.0, unit="m", remedy=LENGTH.remedy)
    if not len(lengths):
        raise errors.InputError("spans", spans, "must hold at least one length", LENGTH.remedy)
    factor = (1.0, 1.2, 1.3, 1.4, 1.5)[min(len(lengths), 5) - 1]
    return Answer(max(factor * float(lengths.mean()), float(lengths.max())), _LENGTH)


@by_clause(_COVER)
def reduced_for_cover(phi: float, cover: float) -> Answer:
    """Return Phi2 or Phi3 reduced for a cover above 1 m: phi - (cover - 1) / 10, at least 1.

    Parameters
    ----------
    phi : float
        Phi2 or Phi3.
    cover : float
        m, from the structure to the top of the sleepers.

    Returns
    -------
    Answer

    Raises
    ------
    InputError
    """
    factor = errors.number("phi", phi, least=0.0, remedy="Give Phi2 or Phi3, as float(phi2(L))")
    remedy = "Give the height of the cover with the ballast"
    height = errors.number("cover", cover, least=0.0, unit="m", remedy=remedy)
    if reason := outside(_COVER, phi=factor):
        return Answer(None, _COVER, reason)
    return Answer(max(factor - max(height - 1.0, 0.0) / 10.0, 1.0), _COVER)


@by_clause(_PHI_PRIME)
def phi_prime(L: float, n0: float, v: float) -> Answer:
    """Return phi' = K / (1 - K + K^4) with K = v / (2 L n0); 1.325 from K = 0.76 on.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span.
    n0 : float
        First bending frequency under permanent load, Hz.
    v : float
        Speed, m/s.

    Returns
    -------
    Answer

    Raises
    ------
    InputError
    """
    if reason := _not_annex_c(_PHI_PRIME, L, n0, v):
        return Answer(None, _PHI_PRIME, reason)
    return Answer(_passage(L, n0, v), _PHI_PRIME)


@by_clause(_PHI_DOUBLE_PRIME)
def phi_double_prime(L: float, n0: float, v: float) -> Answer:
    """Return phi'', what track irregularities add, at least 0.

    alpha / 100 (56 exp(-(L / 10)^2) + 50 (L n0 / 80 - 1) exp(-(L / 20)^2)), where alpha is v / 22
    and at most 1.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span.
    n0 : float
        First bending frequency under permanent load, Hz.
    v : float
        Speed, m/s.

    Returns
    -------
    Answer
        Of a track of standard maintenance; half of it where the track is carefully maintained.

    Raises
    ------
    InputError
    """
    if reason := _not_annex_c(_PHI_DOUBLE_PRIME, L, n0, v):
        return Answer(None, _PHI_DOUBLE_PRIME, reason)
    return Answer(_unevenness(L, n0, v), _PHI_DOUBLE_PRIME)


@by_clause(_REAL_TRAIN)
def real_train_factor(L: float, n0: float, v: float, *, maintained: bool = False) -> Answer:
    """Return 1 + phi' + phi'', or 1 + phi' + phi'' / 2 on a carefully maintained track.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span.
    n0 : float
        First bending frequency under permanent load, Hz.
    v : float
        Speed, m/s.
    maintained : bool
        Whether the track is carefully maintained.

    Returns
    -------
    Answer
        By which the static effects of a real train are multiplied.

    Raises
    ------
    InputError
    """
    half = 0.5 if errors.boolean("maintained", maintained) else 1.0
    if reason := _not_annex_c(_REAL_TRAIN, L, n0, v):
        return Answer(None, _REAL_TRAIN, reason)
    return Answer(1.0 + _passage(L, n0, v) + half * _unevenness(L, n0, v), _REAL_TRAIN)


@by_clause(_TRACK)
def track_factor(L: float, n0: float, v: float, *, maintained: bool = True) -> Answer:
    """Return 1 + phi'' / 2, for results of a dynamic analysis with a smooth track.

    Parameters
    ----------
    L : float
        Determinant length L_Phi, m; of a simple beam its span.
    n0 : float
        First bending frequency under permanent load, Hz.
    v : float
        Speed, m/s.
    maintained : bool
        Whether the track is carefully maintained; otherwise 1 + phi''.

    Returns
    -------
    Answer
        Beside phi'_dyn it is a summand: (1 + phi'_dyn + phi'' / 2) times the static effect.

    Raises
    ------
    InputError

    Notes
    -----
    Wrong where irregularities are in the analysis itself: then they are counted twice.
    """
    half = 0.5 if errors.boolean("maintained", maintained) else 1.0
    SPEED.checked("v", v)
    if reason := outside_n0_bounds(L, n0):
        return Answer(None, _TRACK, reason)
    return Answer(1.0 + half * _unevenness(L, n0, v), _TRACK)


@by_clause(_EFFECT)
def dynamic_effect(static: float, phi_dyn: float, track: Answer) -> Answer:
    """Return (1 + phi'_dyn + phi''/2) times the static moment of a train.

    Parameters
    ----------
    static : float
        N m, of the train that stands where it is worst.
    phi_dyn : float
        phi'_dyn of a dynamic analysis: the largest magnitude of y_dyn over that of y_stat, less 1.
    track : Answer
        1 + phi''/2; see `track_factor`.

    Returns
    -------
    Answer
        N m; undecided where the factor for the track is.

    Raises
    ------
    InputError
    """
    moment = errors.number("static", static, unit="N m")
    passage = errors.number("phi_dyn", phi_dyn, least=-1.0)
    factor = errors.instance("track", track, Answer)
    if not factor.decided:
        return Answer(None, _EFFECT, factor.reason)
    return Answer((float(factor) + passage) * moment, _EFFECT)


@by_clause(_EFFECT_LIMIT)
def dynamic_effect_limit(static: float, phi: Answer) -> Answer:
    """Return Phi times the static moment of the load models, beside which trains are held.

    Parameters
    ----------
    static : float
        N m, the largest of LM71 and, on continuous decks, SW/0, alpha included.
    phi : Answer
        Phi2 or Phi3.

    Returns
    -------
    Answer
        N m; undecided where Phi is.

    Raises
    ------
    InputError
    """
    moment = errors.number("static", static, unit="N m")
    factor = errors.instance("phi", phi, Answer)
    if not factor.decided:
        return Answer(None, _EFFECT_LIMIT, factor.reason)
    return Answer(float(factor) * abs(moment), _EFFECT_LIMIT)


def _not_annex_c(clause: Clause, L: float, n0: float, v: float) -> str:
    """Return why Annex C does not hold; refuse what is no number first."""
    LENGTH.checked("L", L), FREQUENCY.checked("n0", n0)
    speed = SPEED.checked("v", v)
    return outside(clause, v=speed) or outside_n0_bounds(L, n0)


def _passage(L: float, n0: float, v: float) -> float:
    k = v / (2.0 * L * n0)  # in the range of Annex C below 0.35
    return k / (1.0 - k + k**4) if k < 0.76 else 1.325


def _unevenness(L: float, n0: float, v: float) -> float:
    alpha = min(v / 22.0, 1.0)
    short, long = 56.0 * math.exp(-((L / 10.0) ** 2)), 50.0 * math.exp(-((L / 20.0) ** 2))
    return max(alpha / 100.0 * (short + long * (L * n0 / 80.0 - 1.0)), 0.0)
