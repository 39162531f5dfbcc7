"""What can be computed, but is unlikely to be meant: slips of unit or decimal point.

A deck, a train, a track and a speed are held against `bounds`, each by itself and all together. One
slip gives one sentence: what follows from a value that is doubted already is not doubted again.

What only the maker of a deck knows (E, a density, the springs of its bearings) he holds against the
same bounds and leaves in `Deck.remarks`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..decks import Deck
from ..errors import InputWarning
from ..settings import Settings
from ..tracks import Track
from ..trains import AnyTrain
from ..units import G
from .bounds import (
    ABOVE,
    BELOW,
    BOUNDS,
    SLOWEST_LATERAL,
    SLOWEST_TORSION,
    doubt,
    first_frequencies,
    frequency_off,
    usual_frequencies,
)
from .tracksindoubt import track_doubts
from .trainsindoubt import of_train

__all__ = [
    "UNUSUAL", "damping_constants", "damping_frequencies", "doubts", "first_vertical",
    "longest_span", "scale_in_doubt",
]  # fmt: skip

UNUSUAL = "modes.unusual", "= true: a first frequency beyond those of bridges is accepted."
"""Field and text of the remark on a deck whose scale is accepted as it is."""
_DRAWN = 4.0, 100.0
"""Spans for which EN 1991-2 draws its Figure 6.10, m."""
_STILL = 0.15
"""Share of its largest value below which a shape that turns round stands still."""
_FASTEST_TWIST = 4000.0
"""Twice the span times the first torsional frequency, m/s.

It is the speed of a wave of twist, for which steel allows 3200."""
_LATERAL = 1.2
"""First lateral frequency that is never doubted, Hz (EN 1990, A2.4.4)."""


def doubts(
    train: AnyTrain, deck: Deck, track: Track, settings: Settings
) -> tuple[InputWarning, ...]:
    """Return what is unlikely to be meant about the input of a crossing, a sentence each.

    Fields are named as the arguments of `cross` and what they hold: ``speed``, ``train.axles``.
    """
    signs = _signs(deck)
    scale = [] if _explained(deck) else _scale(deck, signs)
    trains = of_train(train)
    found = [*scale, *_damping(deck, signs, bool(scale)), *_places(deck), *trains]
    found += _off_axis(deck, settings) + track_doubts(train, track)
    found += _speed(train, settings.speed)
    if not (scale or trains or _explained(deck)):
        found += _live_sag(train, deck, signs.span)
    return tuple(found)


# ---- what a deck shows of its scale


@dataclass(frozen=True)
class _Signs:
    """What tells a deck's scale.

    Attributes
    ----------
    span : float
        Longest, m.
    vertical, lateral, torsion : float or None
        First frequency of each, Hz.
    ratio : float or None
        Damping of the first vertical mode.
    """

    span: float
    vertical: float | None
    lateral: float | None
    torsion: float | None
    ratio: float | None


def _signs(deck: Deck) -> _Signs:
    edges = deck.shapes.edges
    x = np.unique((edges[:-1, None] + np.diff(edges)[:, None] * [0.0, 0.25, 0.5, 0.75]).ravel())
    values = deck.shapes(x)
    sizes = np.einsum("kmc,k,c->mc", values**2, np.gradient(x), [1.0, 1.0, 1.5**2])
    kinds, vertical = np.argmax(sizes, axis=1), first_vertical(sizes)
    lateral, torsion = (
        next(iter(deck.frequencies_hz[(kinds == c) & (sizes[:, c] > 0.0)].tolist()), None)
        for c in (0, 2)
    )
    if vertical is None:
        span = longest_span(deck.supports, deck.length, x, None)
        return _Signs(span, _from_sag(deck, span), lateral, torsion, None)
    span = longest_span(deck.supports, deck.length, x, values[:, vertical, 1])
    first, ratio = deck.frequencies_hz[vertical], deck.damping_ratios[vertical]
    return _Signs(span, float(first), lateral, torsion, float(ratio))


def first_vertical(sizes: np.ndarray) -> int | None:
    """Return the first mode (from 0) that moves mostly up and down, None if there is none.

    Parameters
    ----------
    sizes : ndarray, shape (m, 3)
        Integrals of v^2, w^2 and (1.5 m twist)^2 along the deck.
    """
    return next(iter(np.flatnonzero(np.argmax(sizes, axis=1) == 1).tolist()), None)


def longest_span(
    supports: Sequence[float], length: float, x: np.ndarray, shape: np.ndarray | None
) -> float:
    """Return the longest span, m: between bearing lines, or where a vertical shape stands still.

    Parameters
    ----------
    supports : sequence of float
        Bearing lines, m; fewer than two if they are not known.
    length : float
        Of the deck, m.
    x : ndarray, shape (k,)
        m.
    shape : ndarray, shape (k,), or None
        Of the first vertical mode.
    """
    if len(supports) > 1:
        return float(np.max(np.diff(np.sort(supports))))
    if shape is None:
        return length
    size = np.abs(shape) / np.abs(shape).max()
    turns = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
    still = x[1:-1][turns & (size[1:-1] < _STILL)]
    return float(np.max(np.diff([0.0, *still, length])))


def _from_sag(deck: Deck, span: float) -> float | None:
    """Return the first vertical frequency that the sag under self-weight tells, Hz.

    EN 1991-2, 6.4.4: 17.75 / sqrt(sag in mm). For decks whose vertical modes are not among those
    kept; None where no self-weight is known.
    """
    line = deck.recovery.section("displacement_z", _middle(deck, span))
    if line is None or not abs(line.self_weight) > 0.0:
        return None
    return 17.75 / float(np.sqrt(1e3 * abs(line.self_weight)))


def _middle(deck: Deck, span: float) -> float:
    """Return the middle of the longest span, m."""
    ends = np.sort(deck.supports)
    if len(ends) < 2:
        return span / 2
    i = int(np.argmax(np.diff(ends)))
    return float(ends[i] + ends[i + 1]) / 2


# ---- the deck


def _explained(deck: Deck) -> bool:
    """Whether a deck's scale is accepted, or its maker doubts what it follows from."""
    return any(
        remark.field == UNUSUAL[0]
        or (isinstance(remark, InputWarning) and not remark.field.startswith("damping"))
        for remark in deck.remarks
    )


def scale_in_doubt(deck: Deck) -> list[InputWarning]:
    """Return the doubt about a deck's size, mass and stiffness together."""
    return _scale(deck, _signs(deck))


def _scale(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Return the first doubt, which explains the rest."""
    for check in (_size, _frequency, _exchanged, _sideways):
        found = check(deck, signs)
        if found:
            return found
    return []


def _stiffness(deck: Deck) -> str:
    """Return what a deck's frequencies follow from, in words of who made it."""
    return "deck.frequencies_hz" if deck.recovery.lacks else "deck.bending_stiffness_vertical"


def _mass(deck: Deck) -> str:
    return "deck.mass_per_metre" if deck.recovery.lacks else "deck.mass"


def _size(deck: Deck, signs: _Signs) -> list[InputWarning]:
    field = "deck.spans" if len(deck.supports) > 2 else "deck.length"
    return doubt("span", field, signs.span) or doubt("mass", _mass(deck), deck.mass_per_metre)


def _frequency(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """The first vertical frequency against the longest span."""
    first, span, mass = signs.vertical, signs.span, deck.mass_per_metre
    if first is None:
        return []
    off = frequency_off(first, span)
    # A weight for a mass makes the frequency 3.1 times too low: with a large mass that is enough.
    if mass and mass > 5e4 and off < -1.5 and _DRAWN[0] <= span <= _DRAWN[1]:
        low, high = first_frequencies(span)
        if low <= first * np.sqrt(G) <= high and mass / G <= 4e4:
            text = f"= {mass:g} kg/m gives a first vertical frequency of {first:.3g} Hz, "
            return [InputWarning(_mass(deck), f"{text}{usual_frequencies(span)}: a weight in N/m?")]
    if -BELOW <= off <= ABOVE:
        return []
    text = f"gives a first vertical frequency of {first:.3g} Hz, {usual_frequencies(span)}: "
    fits = _fitting(first, span)
    if mass and mass < 1e3 and off > 0.0 and fits(np.sqrt(G / 1e3)):
        return [InputWarning(_mass(deck), f"= {mass:g} kg/m {text}a weight in kN/m?")]
    slips = _beam_slips(fits) if mass else _modal_slips(first, fits)
    likely = [words for fit, words in slips if fit]
    why = likely[0] if likely else "are stiffness, mass and lengths in SI units"
    return [InputWarning(_stiffness(deck), f"{text}{why}?")]


def _fitting(frequency: float, span: float) -> Callable[..., bool]:
    """Return what says whether a frequency would be usual, times a factor and on another span."""

    def fits(factor: float, length: float = 1.0) -> bool:
        low, high = first_frequencies(span * length)
        return low / 1.5 <= frequency * factor <= 1.5 * high

    return fits


def _modal_slips(frequency: float, fits: Callable[..., bool]) -> list[tuple[bool, str]]:
    """Return slips of who gave frequencies or a shell, and whether they explain the frequency."""
    root = np.sqrt(frequency) / (2 * np.pi * frequency)
    return [
        (fits(1 / (2 * np.pi)), "given in rad/s"),
        (fits(1.0, 1e-3), "lengths given in mm"),
        (fits(1.0, 0.3048), "lengths given in feet"),
        (fits(root), "squares of rad/s"),
    ]


def _beam_slips(fits: Callable[..., bool]) -> list[tuple[bool, str]]:
    """Return slips of who gave stiffness and mass, and whether they explain the frequency."""
    return [
        (fits(1e3**0.5), "1000 times too soft, given in kN m2, or E in kN/m2"),
        (fits(1e6**0.5), "a million times too soft, given in MN m2, or E in MPa"),
        (fits(1e9**0.5), "a billion times too soft, E in GPa"),
        (fits(1e3**-0.5), "1000 times too stiff"),
        (fits(1e6**-0.5), "a million times too stiff, given in N mm2"),
        (fits(0.3048**-2, 0.3048), "lengths given in feet"),
        (fits(100**0.5), "a hundred times too soft"),
        (fits(10**-0.5), "ten times too stiff"),
        (fits(100**-0.5), "a hundred times too stiff"),
    ]


def _exchanged(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Vertical bending stiffer than bridges have it, lateral bending just like vertical."""
    if signs.vertical is None or signs.lateral is None:
        return []
    low, high = first_frequencies(signs.span)
    drawn = _DRAWN[0] <= signs.span <= _DRAWN[1]
    if not (drawn and signs.vertical > 1.3 * high and low <= signs.lateral <= high):
        return []
    text = f"gives first frequencies of {signs.vertical:.3g} Hz vertically and "
    text += f"{signs.lateral:.3g} Hz laterally, {usual_frequencies(signs.span)} vertically: "
    return [InputWarning(_stiffness(deck), text + "are I_y and I_z exchanged?")]


def _sideways(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Torsional and lateral frequency of a beam against the vertical one."""
    vertical, lateral, torsion = signs.vertical, signs.lateral, signs.torsion
    if vertical is None or deck.recovery.lacks:  # there piers and local modes may be low
        return []
    found = []
    for name, field, first, least in [
        ("torsional", "deck.torsional_stiffness", torsion, SLOWEST_TORSION * vertical),
        (
            "lateral",
            "deck.bending_stiffness_lateral",
            lateral,
            min(SLOWEST_LATERAL * vertical, _LATERAL),
        ),
    ]:
        if first is not None and first < least:
            text = f"gives a first {name} frequency of {first:.3g} Hz, the vertical one is "
            text += f"{vertical:.3g} Hz: 1000 times too small, given in kN m2?"
            found.append(InputWarning(field, text))
    if torsion is not None and 2 * signs.span * torsion > _FASTEST_TWIST:
        text = f"gives a first torsional frequency of {torsion:.3g} Hz, faster than steel twists: "
        found.append(InputWarning("deck.torsional_stiffness", text + "1000 times too large?"))
    return found


def _damping(deck: Deck, signs: _Signs, scale_doubted: bool) -> list[InputWarning]:
    """Doubt the ratio and, where the frequencies are right, what Rayleigh's two were."""
    if signs.ratio is None or any(r.field.startswith("damping") for r in deck.remarks):
        return []
    scale_doubted = scale_doubted or _explained(deck)
    if BOUNDS["damping_ratio"].holds(signs.ratio):
        return [] if scale_doubted else _off_the_valley(deck, signs)
    if scale_doubted and not np.allclose(deck.damping_ratios, signs.ratio):
        return []  # it follows from the frequency
    text = f"= {signs.ratio:.3g} is {100 * signs.ratio:.3g} % of critical in the first vertical "
    text += f"mode: given in per cent? {signs.ratio:.3g} % is {signs.ratio / 100:.3g}"
    return [InputWarning("deck.damping_ratios", text)]


def _off_the_valley(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Rayleigh damping whose two frequencies lie far above the deck's first.

    Anchored at the first frequency and k times that, the ratio there is (1 + k) / (2 sqrt(k)) of
    the least: 4 at k = 62. Given in rad/s, it is pi sqrt(k): 4.4 at k = 2.
    """
    omega, ratios = 2 * np.pi * deck.frequencies_hz, deck.damping_ratios
    columns = np.stack([0.5 / omega, 0.5 * omega], axis=1)
    (alpha, beta), *_ = np.linalg.lstsq(columns, ratios, rcond=None)
    rayleigh = np.allclose(columns @ [alpha, beta], ratios, rtol=1e-6, atol=0.0)
    if not (rayleigh and len(omega) > 1 and alpha > 0.0 and beta > 1e-9):
        return []
    lowest = np.sqrt(alpha / beta) / (2 * np.pi)
    if signs.vertical >= lowest or signs.ratio <= 4.0 * np.sqrt(alpha * beta):
        return []
    text = f"is least at {lowest:.3g} Hz, the first vertical frequency is {signs.vertical:.3g} Hz: "
    return [InputWarning("deck.damping", text + "its two frequencies given in rad/s?")]


def damping_frequencies(field: str, given: Sequence[float], deck: Deck) -> list[InputWarning]:
    """Return the doubt about the two frequencies (Hz) of Rayleigh damping.

    For who knows them: a deck knows only the ratios.
    """
    signs = _signs(deck)
    if signs.vertical is None or BOUNDS["damping_frequency"].holds(min(given) / signs.vertical):
        return []
    if _explained(deck) or _scale(deck, signs):
        return []
    text = f"= {list(given)} Hz, the first vertical frequency is {signs.vertical:.3g} Hz: "
    return [InputWarning(field, text + "given in rad/s?")]


def damping_constants(field: str, alpha: float, beta: float, deck: Deck) -> list[InputWarning]:
    """Return the doubt about alpha (1/s) and beta (s) of Rayleigh damping, given as they are.

    Of the one that dampens the first vertical mode most.
    """
    signs, usual = _signs(deck), BOUNDS["damping_ratio"]
    if signs.vertical is None or usual.holds(signs.ratio):
        return []
    if _explained(deck) or _scale(deck, signs):
        return []

    def shares(first: float, second: float) -> tuple[float, float]:
        omega = 2 * np.pi * signs.vertical
        return first / (2 * omega), second * omega / 2

    of_mass, of_stiffness = shares(alpha, beta)
    stiff = of_stiffness > of_mass
    name, value = ("beta", f"{beta:g} s") if stiff else ("alpha", f"{alpha:g} 1/s")
    question = "is its decimal point right"
    if usual.holds(sum(shares(beta, alpha))):
        question = "are alpha and beta exchanged"
    elif stiff and usual.holds(of_mass + of_stiffness / 1e3):
        question = "given in ms"
    text = f"= {value} gives {100 * signs.ratio:.3g} % of critical in the first vertical mode, "
    text += f"{signs.vertical:.3g} Hz: {question}?"
    return [InputWarning(f"{field}.{name}", text)]


def _places(deck: Deck) -> list[InputWarning]:
    """Return doubts about where things lie on a deck."""
    found = doubt("width", "deck.width", deck.width)
    found += doubt("height", "deck.track_height", deck.track_height)
    for name, y in deck.tracks.items():
        found += doubt("off_axis", f"deck.tracks.{name}", y)
    if deck.rail is not None:
        found += doubt("sleepers", "deck.rail.spread", deck.rail.spread)
        found += doubt("rail_stiffness", "deck.rail.bending_stiffness", deck.rail.bending_stiffness)
        found += doubt("foundation", "deck.rail.foundation", deck.rail.foundation)
    return found


# ---- all together


def _off_axis(deck: Deck, settings: Settings) -> list[InputWarning]:
    offset = float(settings.track_offset)
    if offset in deck.tracks.values():  # the deck's own track is doubted
        return []
    return doubt("off_axis", "track_offset", offset)


def _speed(train: AnyTrain, speed: float) -> list[InputWarning]:
    # A lone force is a case of theory, at any speed.
    if BOUNDS["speed"].holds(speed) or len(train.placed_axles) < 2:
        return []
    return [InputWarning("speed", f"= {speed:g} m/s is {3.6 * speed:g} km/h: given in km/h?")]


def _live_sag(train: AnyTrain, deck: Deck, span: float) -> list[InputWarning]:
    """Compare the static displacement under the standing train with the span."""
    line = deck.recovery.section("displacement_z", _middle(deck, span))
    if line is None:
        return []
    x = np.linspace(0.0, deck.length, 201)
    influence = line.influence(x)[:, 0, 1]
    delays = np.array([axle.delay for axle in train.placed_axles])
    loads = [sum(wheel.static_load for wheel in axle.wheels) for axle in train.placed_axles]
    front = np.linspace(0.0, deck.length + train.length, 400)
    under = np.interp(front[:, None] - delays, x, influence, left=0.0, right=0.0)
    sag = float(np.abs(under @ loads).max())
    if BOUNDS["live_sag"].holds(sag / span):
        return []
    text = f"lets the deck sag {sag:.3g} m in {span:.3g} m under the standing train: too soft, or "
    return [InputWarning(_stiffness(deck), text + "are the loads too large?")]
