"""A deck as the clauses see it: its spans, whether it runs through, and its first frequencies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import codes
from ..codes import Answer
from ..decks import Deck
from .requirements import Requirements

__all__ = ["Span", "Structure"]

_PIER = 0.1
"""Share of the longest span below which a distance of bearing lines is a pier's, not a span."""
_OWN = 0.5
"""Share of a mode's largest displacement that a span has from which on the mode is its own."""
_HINGE = 1e-6
"""Share of a length below which the moment over a bearing is rounding, m."""
_PLACES = 401


@dataclass(frozen=True)
class Span:
    """A span.

    Attributes
    ----------
    number : int
        From 1.
    start, end : float
        m along the deck.
    """

    number: int
    start: float
    end: float

    @property
    def length(self) -> float:
        """M."""
        return self.end - self.start

    @property
    def middle(self) -> float:
        """M along the deck."""
        return (self.start + self.end) / 2


@dataclass(frozen=True, eq=False)
class Structure:
    """A deck and what is required, as the clauses ask for them.

    Attributes
    ----------
    deck : Deck
    needs : Requirements
    """

    deck: Deck
    needs: Requirements

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """Between bearing lines; none where they are not known."""
        lines = np.array(self.deck.supports)
        lengths = np.diff(lines)
        wide = [i for i, length in enumerate(lengths) if length >= _PIER * lengths.max()]
        return tuple(
            Span(number, float(lines[i]), float(lines[i + 1]))
            for number, i in enumerate(wide, start=1)
        )

    @cached_property
    def longest(self) -> Span | None:
        """The longest span."""
        return max(self.spans, key=lambda span: span.length, default=None)

    @property
    def overhangs(self) -> bool:
        """Whether the deck goes on beyond its outer bearing lines."""
        lines, slack = self.deck.supports, 1e-6 * self.deck.length
        return bool(lines) and (lines[0] > slack or lines[-1] < self.deck.length - slack)

    @cached_property
    def continuous(self) -> bool | None:
        """Whether it runs through over inner bearings; None where that is not known."""
        if len(self.spans) < 2:
            return False
        if self.deck.recovery.lacks:
            return None
        # Simple spans in a row have hinges there, however the load stands.
        lines = [
            self.deck.recovery.section("moment_vertical", span.start) for span in self.spans[1:]
        ]
        sizes = [np.abs(line.influence.coefficients).max() for line in lines if line is not None]
        return bool(max(sizes, default=0.0) > _HINGE * self.deck.length)

    @property
    def simple(self) -> bool:
        """Whether it is a simple structure, as far as it is known."""
        return self.needs.simple and self.continuous is False and not self.overhangs

    def length_of(self, span: Span | None) -> Answer:
        """Return the determinant length of a span, m."""
        clause = codes.determinant_length.clause
        if self.needs.determinant_length is not None:
            return Answer(self.needs.determinant_length, clause, "given")
        remedy = "give determinant_length"
        if span is None:
            return Answer(None, clause, f"the deck knows no lines of bearings: {remedy}")
        if self.continuous is None:
            return Answer(None, clause, f"only modes are known, not whether it runs on: {remedy}")
        if self.continuous:
            return codes.determinant_length([own.length for own in self.spans])
        if not self.simple:
            return Answer(None, clause, f"the structure is not a simple one: {remedy}")
        return codes.determinant_length([span.length])

    def phi_of(self, span: Span | None) -> Answer:
        """Return Phi2 or Phi3 of a span, reduced for the cover."""
        rule = codes.phi2 if self.needs.careful_track else codes.phi3
        length = self.length_of(span)
        if not length.decided:
            return Answer(None, rule.clause, length.reason)
        phi = rule(float(length))
        if not phi.decided or self.needs.cover <= 1.0:
            return phi
        return codes.reduced_for_cover(float(phi), self.needs.cover)

    @cached_property
    def _directions(self) -> np.ndarray:
        """In which direction each mode moves most: 0 sideways, 1 up and down, 2 twist."""
        deck = self.deck
        shapes = deck.shapes(np.linspace(0.0, deck.length, _PLACES))
        squares = (shapes**2).mean(axis=0)
        # A rotation counts by how far it moves the slab: its radius of gyration, width / 12^0.5.
        squares[:, 2] *= (deck.width or 5.0) ** 2 / 12.0
        return squares.argmax(axis=1)

    def _first(self, direction: int) -> int | None:
        own = np.flatnonzero(self._directions == direction)
        return int(own[np.argmin(self.deck.frequencies_hz[own])]) if len(own) else None

    @cached_property
    def first_vertical(self) -> int | None:
        """The first mode that bends up and down, from 0."""
        return self._first(1)

    @cached_property
    def first_lateral(self) -> int | None:
        """The first mode that bends sideways, from 0."""
        return self._first(0)

    @property
    def n0(self) -> float | None:
        """First frequency of vertical bending, Hz; of the mass that the deck has."""
        mode = self.first_vertical
        return None if mode is None else float(self.deck.frequencies_hz[mode])

    def n0_of(self, span: Span) -> float | None:
        """First frequency of vertical bending of a span, Hz.

        Of simple spans in a row each has its own, None where the deck's modes leave it out; else
        it is that of the deck.
        """
        single = len(self.spans) < 2 or self.continuous is not False
        if single or self.needs.determinant_length is not None:
            return self.n0
        deck = self.deck
        vertical = np.flatnonzero(self._directions == 1)
        whole, own = (
            np.abs(deck.shapes(np.linspace(*ends, _PLACES))[:, vertical, 1]).max(axis=0)
            for ends in ((0.0, deck.length), (span.start, span.end))
        )
        found = deck.frequencies_hz[vertical[own >= _OWN * whole]]
        return float(found.min()) if len(found) else None
