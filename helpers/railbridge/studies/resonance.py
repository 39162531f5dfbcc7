r"""Speeds at which a train of constant loads excites a deck, and how much it does at most.

Loads that repeat at a distance d meet a mode in step at ``v = f d / i``. The residual influence
line (LIR, ERRI D214) estimates the acceleration at mid-span of a simple span in its first mode,
just after one of the axles has left: every axle leaves the deck a free vibration, and those add up,

    a_max = 2 / (mu L) A(K) G(lambda),   K = v / (2 L f),   lambda = v / f,
    A = |K / (1 - K^2)| sqrt(1 + exp(-2 pi zeta / K) + 2 exp(-pi zeta / K) cos(pi / K)),
    G = max over k of |sum over i <= k of P_i exp(2 pi (i - zeta) (x_k - x_i) / lambda)|.

A belongs to the deck alone, G, the signature, to the train alone. At resonance it is an estimate,
no bound: with 1 % damping and ``v = f d`` it lies, for the trains HSLM-A, from 3 % above the exact
peak of that mode (A10 on 25 m) to 11 % below it (A9 on 40 m). Wrong elsewhere: it knows nothing of
the motion while axles are on the deck, nor of other modes.
"""

from __future__ import annotations

import numpy as np

from ..decks import Deck
from ..trains import AnyTrain, Train

__all__ = ["first_vertical_mode", "repeated_distance", "residual_acceleration", "resonance_speeds"]

_ALIKE = 0.05
"""Share by which the first mode's inverse mass may differ from 2 / (mu L) of a uniform beam."""
_BLIND = 0.01
"""Share of the speed 2 L f around it in which the formula means nothing."""


def repeated_distance(train: AnyTrain) -> float | None:
    """Return the distance, m, at which the most axle loads of a train repeat; None for one axle.

    The distance between cars of a train of equal cars; of bare axles the difference that is met
    most often, the shortest of several.
    """
    if isinstance(train, Train) and train.cars > 1:
        return float(np.median(np.diff(train.centres)))
    places = np.array([axle.delay for axle in train.placed_axles])
    between = np.round(np.abs(places[:, None] - places)[np.triu_indices(len(places), 1)], 4)
    if not len(between):
        return None
    found, counts = np.unique(between, return_counts=True)
    return float(found[np.argmax(counts)])


def first_vertical_mode(deck: Deck) -> int | None:
    """Return the number (from 0) of the lowest mode that moves up and down, None without one."""
    moves = np.any(deck.shapes.coefficients[..., 1] != 0.0, axis=(0, 1))
    return int(np.argmax(moves)) if moves.any() else None


def resonance_speeds(deck: Deck, train: AnyTrain, low: float, high: float) -> np.ndarray:
    """Return the speeds f d / i, i = 1, 2, ..., within low to high, m/s, ascending.

    Of the deck's first vertical mode and the train's `repeated_distance`.
    """
    mode, distance = first_vertical_mode(deck), repeated_distance(train)
    if mode is None or distance is None:
        return np.zeros(0)
    whole = deck.frequencies_hz[mode] * distance
    orders = np.arange(max(1, int(np.ceil(whole / high - 1e-9))), int(whole / low + 1e-9) + 1)
    return (whole / orders)[::-1]


def residual_acceleration(deck: Deck, train: AnyTrain, speeds: np.ndarray) -> np.ndarray | None:
    """Return the acceleration at mid-span by the residual influence line, m/s2.

    None where it does not apply: several spans, a deck whose mass is not known, or whose first mode
    is not that of a uniform simple beam, as with heavy masses at single places. NaN beside the
    speed 2 L f, where the formula divides by nothing. Of loads at their own places: what a rail
    spreads is less.

    Parameters
    ----------
    deck : Deck
    train : AnyTrain
        Of which places and static loads of the axles count.
    speeds : ndarray, shape (n,)
        m/s.
    """
    mode = first_vertical_mode(deck)
    if mode is None or deck.mass_per_metre is None or len(deck.supports) != 2:
        return None
    modal = 2.0 / (deck.mass_per_metre * deck.length)
    at_middle = deck.shapes(np.array([deck.length / 2]))[0, mode, 1] ** 2
    if abs(at_middle / modal - 1.0) > _ALIKE:
        return None
    speeds = np.asarray(speeds, dtype=float)
    f, zeta = deck.frequencies_hz[mode], deck.damping_ratios[mode]
    places = np.array([axle.delay for axle in train.placed_axles])
    loads = np.array([axle.static_load for axle in train.placed_axles])
    K = speeds / (2 * deck.length * f)
    K = np.where(np.abs(K - 1.0) < _BLIND, np.nan, K)
    left = np.exp(-np.pi * zeta / K)
    alone = np.abs(K / (1 - K**2)) * np.sqrt(
        np.maximum(1 + left**2 + 2 * left * np.cos(np.pi / K), 0.0)
    )
    sums = np.zeros(len(speeds), dtype=complex)
    largest = np.zeros(len(speeds))
    for k, load in enumerate(loads):
        # The sum up to the axle before goes on swinging until this one leaves.
        if k:
            sums *= np.exp(2 * np.pi * (1j - zeta) * (places[k] - places[k - 1]) * f / speeds)
        sums += load
        np.maximum(largest, np.abs(sums), out=largest)
    return modal * alone * largest
