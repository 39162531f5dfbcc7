"""What is asked of every crossing for a check: outputs along the deck, by what they serve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import codes
from ..codes import KeptModes
from ..decks import Deck, Line, combined
from ..settings import STATIONS
from ..studies import Asked, Output, of_modes_counted, outputs_at, twist_at
from ..tracks import TWIST_LENGTH
from .structure import Span, Structure

__all__ = ["NUMBERS", "Bearing", "Questions"]

NUMBERS = ("wheel_unloading", "body_acceleration_z")
"""What is judged of a whole crossing."""
_OF_TRUST = ("left_open", "transient")
"""What says whether its numbers may decide."""


@dataclass(frozen=True, eq=False)
class Bearing:
    """A bearing, or a line of them, that may lift.

    Attributes
    ----------
    words : str
        Where it is.
    output : Output
    hides : bool
        Whether the deck is held against twist at its place otherwise than by forces of bearings
        side by side, so that it stands for several of them.
    """

    words: str
    output: Output
    hides: bool

    @property
    def self_weight(self) -> float:
        """Its force under the deck's own weight, N."""
        return self.output.line.self_weight


@dataclass(frozen=True, eq=False)
class Questions:
    """What is asked of a deck.

    Attributes
    ----------
    structure : Structure
    stations : int
        Places along the deck where its acceleration is asked for, ends included.
    more : Asked
        What is asked of the same crossings besides, and not judged.
    """

    structure: Structure
    stations: int = STATIONS
    more: Asked = Asked(())

    @property
    def deck(self) -> Deck:
        """The deck."""
        return self.structure.deck

    @cached_property
    def kept(self) -> KeptModes:
        """The modes of which deck accelerations are made."""
        return codes.kept_modes(np.sort(self.deck.frequencies_hz))

    @cached_property
    def accelerations(self) -> tuple[Output, ...]:
        """Vertical accelerations at stations along the deck, of the modes kept."""
        places = np.linspace(0.0, self.deck.length, self.stations).round(9)
        found = outputs_at(self.deck, ("acceleration_z",), places)
        if not self.kept.limit.decided:
            return found
        return of_modes_counted(found, self.deck, float(self.kept.limit))

    @cached_property
    def displacements(self) -> tuple[Output, ...]:
        """Vertical displacements at mid-span, for the picture."""
        return outputs_at(self.deck, ("displacement_z",), self._middles)

    @cached_property
    def moments(self) -> tuple[tuple[Span, Output], ...]:
        """Vertical bending moments at mid-span."""
        if self.deck.recovery.lacks or not self.structure.spans:
            return ()
        found = outputs_at(self.deck, ("moment_vertical",), self._middles)
        return tuple(zip(self.structure.spans, found, strict=True))

    @cached_property
    def twists(self) -> tuple[Output, ...]:
        """Twist over 3 m, from before the deck to its end; none where it is rigid in twist."""
        deck = self.deck
        if not deck.has["roll"]:
            return ()
        lines = np.array([0.0, *deck.supports, deck.length])
        along = np.linspace(-TWIST_LENGTH, deck.length, STATIONS // 3)
        places = np.unique(np.concatenate([along, lines, lines - TWIST_LENGTH]).round(9))
        return tuple(twist_at(deck, x) for x in places[places >= -TWIST_LENGTH])

    @cached_property
    def end_rotations(self) -> tuple[Output, ...]:
        """Rotations of both ends about the vertical; none where the deck is rigid sideways."""
        if self.deck.recovery.section("rotation_z", 0.0) is None:
            return ()
        return outputs_at(self.deck, ("rotation_z",), (0.0, self.deck.length))

    @cached_property
    def bows(self) -> tuple[tuple[Span, Output], ...]:
        """Lateral displacements at mid-span against the chord of the span's ends."""
        found = []
        for span in self.structure.spans:
            lines = self._lateral(span.start, span.middle, span.end)
            if lines:
                line = combined(list(zip((-0.5, 1.0, -0.5), lines, strict=True)))
                found.append((span, Output("bow", span.middle, line.modal, line)))
        return tuple(found)

    @cached_property
    def bearings(self) -> tuple[Bearing, ...]:
        """Bearings that hold the deck up: single ones, or else lines."""
        deck, recovery = self.deck, self.deck.recovery
        if recovery.lacks:
            return ()
        if deck.bearings:
            words = [f"bearing {n} at x = {x:g}, y = {y:g} m"
                     for n, (x, y, _) in enumerate(deck.bearings, start=1)]  # fmt: skip
            places = [x for x, _, _ in deck.bearings]
            up, couple = (
                [recovery.bearing(n + 1, name) for n in range(len(places))]
                for name in ("force_z", "moment_x")
            )
        else:
            words, places = [f"bearings at x = {x:g} m" for x in deck.supports], deck.supports
            up, couple = (
                [recovery.reaction(name, x) for x in places] for name in ("force_z", "moment_x")
            )
        held = {x for x, line in zip(places, couple, strict=True) if line is not None}
        return tuple(
            Bearing(said, Output("force_z", x, line.modal, line), x in held)
            for said, x, line in zip(words, places, up, strict=True)
            if line is not None
        )

    @cached_property
    def asked(self) -> Asked:
        """All of it, in the order of places."""
        found = [
            *self.accelerations, *self.displacements, *(o for _, o in self.moments), *self.twists,
            *self.end_rotations, *(o for _, o in self.bows), *(b.output for b in self.bearings),
            *self.more.outputs,
        ]  # fmt: skip
        numbers = dict.fromkeys((*NUMBERS, *_OF_TRUST, *self.more.numbers))
        return Asked(tuple(sorted(found, key=lambda output: output.x)), tuple(numbers))

    @cached_property
    def number_of(self) -> dict[int, int]:
        """Which of the asked outputs each is, by its `id`."""
        return {id(output): i for i, output in enumerate(self.asked.outputs)}

    @property
    def watched(self) -> list[int]:
        """What decides where chosen speeds lie: mid-spans and the quarters of the deck.

        Or what is asked besides, where something is.
        """
        quarters = self.accelerations[:: (self.stations - 1) // 4][1:-1]
        own = [*quarters, *self.displacements, *(output for _, output in self.moments)]
        return [self.number_of[id(output)] for output in self.more.outputs or own]

    @property
    def shown(self) -> Asked:
        """What a data set over places can hold."""
        quantities = ("acceleration_z", "displacement_z", "moment_vertical", "twist")
        besides = {id(output) for output in self.more.outputs}
        own = (
            o
            for o in self.asked.outputs
            if o.quantity in quantities and 0.0 <= o.x <= self.deck.length and id(o) not in besides
        )
        return Asked(tuple(own), NUMBERS)

    def columns(self, part: Asked) -> np.ndarray:
        """Return which numbers of a row are those of a part of what is asked."""
        count, own = len(self.asked.outputs), [self.number_of[id(o)] for o in part.outputs]
        numbers = [6 * count + self.asked.numbers.index(name) for name in part.numbers]
        return np.array([*(k * count + i for k in range(6) for i in own), *numbers], dtype=int)

    @property
    def _middles(self) -> list[float]:
        spans = self.structure.spans
        return [span.middle for span in spans] if spans else [self.deck.length / 2]

    def _lateral(self, *places: float) -> list[Line]:
        """Return lines of lateral displacement, none where the deck is rigid sideways."""
        if not self.deck.has["y"]:
            return []
        return [self.deck.recovery.section("displacement_y", x) for x in places]
