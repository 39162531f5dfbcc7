r"""Static load models of EN 1991-2, 6.3: where on an influence line they are worst.

They are no trains: their lines of load have no axles and do not run. What LM71 gives is the largest
static effect of usual traffic, SW/0 that on continuous decks, SW/2 that of heavy traffic.

Exact for influence lines that are cubic in pieces, as a beam's are: loads per metre are integrated
in closed form, forces are taken on both sides of a jump, and only the place of the worst load is
sought, by ever finer steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from .. import errors
from ..decks import REACTION_QUANTITIES, SECTION_QUANTITIES, Deck
from ..errors import InputError, Range, brief, check_fields
from .influencelines import InfluenceLine, influence_line

__all__ = ["ALPHAS", "LOAD_MODELS", "LoadModel", "StaticEffect", "Worst", "load_model"]

ALPHAS = (0.75, 0.83, 0.91, 1.0, 1.10, 1.21, 1.33, 1.46)
"""EN 1991-2, 6.3.2 (3): the classification factors alpha."""

_NUMBERS = Annotated[tuple[float, ...], Range(unit="m")]


@dataclass(frozen=True)
class StaticEffect:
    """What a load model does to one result, and how it stands then.

    Attributes
    ----------
    value : float
        In the unit of the quantity; signs as everywhere (down and sagging negative).
    forces : tuple of (float, float)
        Place (m along the deck) and size (N, down positive) of the forces that act.
    stretches : tuple of (float, float, float)
        From, to (m along the deck), load per metre (N/m, down positive) of what acts on the deck.
    """

    value: float
    forces: tuple[tuple[float, float], ...] = ()
    stretches: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class Worst:
    """The most unfavourable effects of a load model on one result.

    Attributes
    ----------
    model, quantity, unit : str
    at : float
        m along the deck.
    least, largest : StaticEffect
        The most negative and the most positive effect; zero, with no load, where there is none.
    """

    __repr__ = brief

    model: str
    quantity: str
    unit: str
    at: float
    least: StaticEffect
    largest: StaticEffect

    @property
    def value(self) -> float:
        """The effect of larger magnitude, with its sign."""
        return max(self.least.value, self.largest.value, key=abs)

    def to_frame(self):
        """Return a pandas DataFrame: the two effects, and where the loads stand, as text."""
        import pandas as pd

        effects = {"least": self.least, "largest": self.largest}
        columns = {
            f"{self.quantity} ({self.unit})": [e.value for e in effects.values()],
            "forces at (m)": [", ".join(f"{x:.3f}" for x, _ in e.forces) for e in effects.values()],
            "load per metre on (m)": [
                ", ".join(f"{a:.3f} to {b:.3f}" for a, b, _ in e.stretches)
                for e in effects.values()
            ],
        }
        return pd.DataFrame(columns, index=pd.Index(effects, name=f"{self.model}, x = {self.at:g}"))


@dataclass(frozen=True)
class LoadModel:
    """A static load model: a pattern that stands where it is worst, and a load of any length.

    Attributes
    ----------
    name : str
    places : tuple of float
        m behind the front of the pattern: its forces.
    force : float
        N, each of them, down positive. Those that relieve are left out.
    stretches : tuple of (float, float)
        m behind the front: where the pattern has its load per metre, relieving or not.
    pattern_load : float
        N/m, on these stretches.
    anywhere : float
        N/m, on as many lengths as is unfavourable, but not beside the forces of the pattern.
    span : float
        m, length of the pattern, where `anywhere` does not act.
    alpha : float
        Classification factor; all loads are multiplied by it.
    factored : bool
        Whether the standard lets alpha multiply it.
    """

    __repr__ = brief

    name: str
    places: _NUMBERS = ()
    force: Annotated[float, Range(least=0.0, unit="N")] = 0.0
    stretches: tuple[tuple[float, float], ...] = ()
    pattern_load: Annotated[float, Range(least=0.0, unit="N/m")] = 0.0
    anywhere: Annotated[float, Range(least=0.0, unit="N/m")] = 0.0
    span: Annotated[float, Range(least=0.0, unit="m")] = 0.0
    alpha: Annotated[float, Range(above=0.0)] = 1.0
    factored: bool = True

    def __post_init__(self) -> None:
        check_fields(self)
        pairs = [errors.numbers("stretches", pair, count=2) for pair in self.stretches]
        inside = np.array([*self.places, *np.ravel(pairs)])
        if np.any(inside < 0.0) or np.any(inside > self.span):
            remedy = "Forces and stretches stand in the pattern, m behind its front"
            raise InputError("span", self.span, f"must reach to {inside.max():g} m", remedy)
        if self.alpha not in ALPHAS:
            allowed = "must be one of " + ", ".join(f"{a:g}" for a in ALPHAS)
            raise InputError("alpha", self.alpha, allowed, "These are the factors of EN 1991-2")
        if self.alpha != 1.0 and not self.factored:
            allowed = f"must be 1: {self.name} bears no classification factor"
            raise InputError("alpha", self.alpha, allowed, "LM71 and SW/0 bear one")

    def worst(self, deck: Deck, quantity: str, *, at: float, track: float | str = 0.0) -> Worst:
        """Return the most unfavourable static effects on one result of a deck.

        Parameters
        ----------
        deck : Deck
        quantity : str
            A displacement or section force at x = `at`, or a reaction (``force_z``) of the bearing
            line there; see `Deck.influence`.
        at : float
            m.
        track : float or str
            m left of the deck axis, or the name of a track of the deck: loads there twist it.

        Returns
        -------
        Worst
            Characteristic values: without dynamic factor, partial factors and self-weight.

        Raises
        ------
        InputError
            A quantity that the deck cannot recover.

        Notes
        -----
        Wrong where several tracks are loaded: each has its own line, and their effects add up.
        The eccentricity of 1 : 18 of vertical loads is not in it.
        """
        errors.instance("deck", deck, Deck)
        line = influence_line(deck, quantity, at, deck.track_offset(track))
        place = errors.place("at", at, (0.0, deck.length))
        unit = {**SECTION_QUANTITIES, **REACTION_QUANTITIES}[quantity]
        least, largest = self.effects(line)
        return Worst(self.name, quantity, unit, place, least, largest)

    def effects(self, line: InfluenceLine) -> tuple[StaticEffect, StaticEffect]:
        """Return the most negative and the most positive effect on any influence line."""
        return self._worst_of(line, -1.0), self._worst_of(line, 1.0)

    def _worst_of(self, line: InfluenceLine, sign: float) -> StaticEffect:
        """Return the effect that is largest in the direction of a sign."""
        eta = line.times(sign)

        def effect(front: np.ndarray) -> np.ndarray:
            return self._effect(eta, front)

        front = _largest_at(effect, self._candidates(line))
        if effect(np.array([front]))[0] <= 0.0:
            return StaticEffect(0.0)
        return self._standing(eta, sign, front)

    def _candidates(self, line: InfluenceLine) -> np.ndarray:
        """Return fronts to start the search from, m: dense, and each load at each kink or jump."""
        if not self.span:
            return np.zeros(1)
        kinks = np.array([0.0, *self.places, self.span, *np.ravel(self.stretches)])
        near = np.add.outer(line.edges, kinks).ravel()
        reach = np.array([0.0, line.length + self.span])
        count = int(np.clip((reach[1] - reach[0]) / 0.05, 400, 20000))
        # A force stands just before or just behind a jump, never on it.
        both = np.concatenate([near - _ASIDE, near, near + _ASIDE])
        return np.unique(np.concatenate([np.linspace(*reach, count), both]))

    def _effect(self, eta: InfluenceLine, front: np.ndarray) -> np.ndarray:
        """Return the effect of unfavourable loads for each place of the front, shape (n,)."""
        total = np.zeros(len(front))
        for behind in self.places:
            total += self.force * np.maximum(eta.value(front - behind), 0.0)
        for start, end in self.stretches:
            total += self.pattern_load * eta.integral(front - end, front - start)
        if self.anywhere:
            beside = eta.positive_integral(front - self.span, front)
            total += self.anywhere * (eta.all_positive - beside)
        return self.alpha * total

    def _standing(self, eta: InfluenceLine, sign: float, front: float) -> StaticEffect:
        """Return the effect with the front at a place, and the loads that make it."""
        forces = tuple(
            (front - behind, self.alpha * self.force)
            for behind in self.places
            if eta.value(np.array([front - behind]))[0] > 0.0
        )
        lines = [
            (max(front - end, 0.0), min(front - start, eta.length), self.pattern_load)
            for start, end in self.stretches
        ]
        if self.anywhere:
            beside = (front - self.span, front) if self.span else None
            lines += [(a, b, self.anywhere) for a, b in eta.positive_stretches(beside)]
        stretches = tuple((a, b, self.alpha * q) for a, b, q in lines if b > a)
        value = sign * float(self._effect(eta, np.array([front]))[0])
        return StaticEffect(value, forces, tuple(sorted(stretches)))


_ASIDE = 1e-7
"""m: so near to a jump of the influence line a force stands on one side of it."""


def _largest_at(effect: Callable[[np.ndarray], np.ndarray], places: np.ndarray) -> float:
    """Return where an effect is largest, from candidates and ever finer steps about the best."""
    if len(places) == 1:
        return float(places[0])
    values = effect(places)
    best = int(np.argmax(values))
    place, value = float(places[best]), float(values[best])
    step = float(places[min(best + 1, len(places) - 1)] - places[max(best - 1, 0)])
    step = max(step, 0.1)
    for _ in range(4):
        around = place + np.linspace(-step, step, 201)
        found = effect(around)
        if found.max() > value:
            place, value = float(around[np.argmax(found)]), float(found.max())
        step /= 40.0
    return place


LOAD_MODELS = {
    # Figure 6.1: the load per metre begins 0.8 m, half a spacing, beside the outer forces.
    "LM71": LoadModel("LM71", places=(0.8, 2.4, 4.0, 5.6), force=250e3, anywhere=80e3, span=6.4),
    "SW/0": LoadModel("SW/0", stretches=((0.0, 15.0), (20.3, 35.3)), pattern_load=133e3, span=35.3),
    "SW/2": LoadModel(
        "SW/2", stretches=((0.0, 25.0), (32.0, 57.0)), pattern_load=150e3, span=57.0, factored=False
    ),
    "unloaded train": LoadModel("unloaded train", anywhere=10e3, factored=False),
}
"""EN 1991-2, 6.3.2 to 6.3.4, by name."""


def load_model(name: str, alpha: float = 1.0) -> LoadModel:
    """Return a static load model of EN 1991-2, 6.3.

    Parameters
    ----------
    name : str
        ``LM71``: four forces of 250 kN 1.6 m apart, once, those that relieve left out, and 80 kN/m
        before and behind them wherever that is unfavourable. ``SW/0``: 133 kN/m on 15.0 m, twice,
        5.3 m apart. ``SW/2``: 150 kN/m on 25.0 m, twice, 7.0 m apart. ``unloaded train``: 10 kN/m
        wherever that is unfavourable. The two SW are moved along as they are.
    alpha : float
        Classification factor of LM71 and SW/0, one of `ALPHAS`.

    Returns
    -------
    LoadModel
        Ask it with `LoadModel.worst`.

    Raises
    ------
    InputError
        No such model; a factor that the standard does not have.
    """
    model = LOAD_MODELS[errors.choice("name", errors.text("name", name), LOAD_MODELS)]
    return replace(model, alpha=alpha)
