"""Which crossings' numbers may decide: passes that settled, a run-up and steps that are enough."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..cautions import SETTLED
from ..codes import KeptModes
from ..cutoffs import counted
from ..decks import Deck
from ..results import Crossing
from ..settings import (
    COARSE_SAMPLES_PER_CONTACT,
    COARSE_SAMPLES_PER_PERIOD,
    HEAVY,
    Options,
    contact_frequency,
)
from ..trains import AnyTrain
from .judging import Points

__all__ = ["ACCELERATION", "ALL", "UNLOADING", "Trust"]

ALL, ACCELERATION, UNLOADING = "all", "acceleration", "unloading"
"""What a clause judges: coarse steps spoil deck accelerations and wheel forces, not the rest."""


@dataclass(frozen=True, eq=False)
class Trust:
    """What is known of crossings besides their numbers.

    Attributes
    ----------
    options : Options
        How they were computed; their speed does not count.
    coarse : dict of dict of str
        By train and by what is judged, what a given time step is too coarse for.
    run : Crossing, optional
        The only one, if it is known.
    """

    options: Options
    coarse: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    run: Crossing | None = None

    @classmethod
    def of(
        cls,
        options: Options,
        deck: Deck,
        kept: KeptModes,
        trains: Mapping[str, AnyTrain],
        run: Crossing | None = None,
    ) -> Trust:
        """Return what is known of the crossings of some trains.

        Parameters
        ----------
        options : Options
        deck : Deck
        kept : KeptModes
            Of which deck accelerations are made.
        trains : mapping of trains by name
            Those that are stepped in time; constant loads over speeds are not.
        run : Crossing, optional
        """
        step = options.time_step
        if step is None:
            return cls(options, run=run)
        of_modes = _coarse(step, _highest(deck, kept), COARSE_SAMPLES_PER_PERIOD, "deck's modes")
        coarse = {}
        for name, train in trains.items():
            contact = contact_frequency(train)
            of_contact = _coarse(
                step, contact, COARSE_SAMPLES_PER_CONTACT, "wheelsets on their contacts"
            )
            coarse[name] = {ACCELERATION: of_modes, UNLOADING: of_contact}
        return cls(options, coarse, run)

    def doubts(self, points: Points, judged: str) -> list[str]:
        """Return of each crossing why its numbers do not decide, empty where they do.

        Parameters
        ----------
        points : Points
        judged : {"all", "acceleration", "unloading"}
            What a clause judges.
        """
        if not len(points):
            return []
        left, transient = points.number("left_open"), points.number("transient")
        found = []
        for point, open_still, unsteady in zip(points.points, left, transient, strict=True):
            said = self._open(open_still) or self._unsteady(unsteady)
            found.append(said or self.coarse.get(point.train, {}).get(judged, ""))
        return found

    def _open(self, share: float) -> str:
        """Return what is said of passes that have not settled."""
        if share <= SETTLED:
            return ""
        what = f"{share:.2g} of the wheel forces' dynamic part still open"
        if not np.isfinite(share):
            what = "open how far further passes change the wheel forces"
        given, remedy = self._passes
        return f"{given} leaves {what}: {remedy}"

    @property
    def _passes(self) -> tuple[str, str]:
        """What ended the passes, and what to do about it."""
        o, run = self.options, self.run
        if run is not None and run.iteration < run.iterations:
            return f"pass {run.iteration} of {run.iterations}", "judge the last one"
        if o.iterations is not None:
            return f"iterations = {o.iterations}", "give more, or leave it out"
        if run is not None and run.converged is False:
            return f"max_iterations = {run.iterations}", "give more, or interaction = 'direct'"
        return f"tolerance = {o.tolerance:g}", "give a smaller one, or interaction = 'direct'"

    def _unsteady(self, share: float) -> str:
        if share <= SETTLED:
            return ""
        given = f"lead_in = {self.options.lead_in:g} m"
        return (
            f"{given} leaves {share:.2g} of the wheel forces transient: give more, or leave it out"
        )


def _highest(deck: Deck, kept: KeptModes) -> float:
    """Return the highest frequency that counts in accelerations and rings, Hz."""
    count = deck.damping_ratios < HEAVY
    if kept.limit.decided:
        count &= counted(deck.frequencies_hz, float(kept.limit))
    return float(deck.frequencies_hz[count].max(initial=0.0))


def _coarse(step: float, frequency: float, fewest: int, what: str) -> str:
    if frequency * step * fewest <= 1.0:
        return ""
    return (
        f"time_step = {step:g} s is too coarse for the {what}, {frequency:.4g} Hz: at most "
        f"{1 / frequency / fewest:.2g} s"
    )
