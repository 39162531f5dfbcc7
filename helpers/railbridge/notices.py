"""What a reader must know before reading the numbers of a crossing."""

from __future__ import annotations

import numpy as np

from .errors import InputError, InputWarning, Remark
from .plausibility import doubts
from .results import Crossing
from .settings import LEAD_IN_SECONDS
from .trains import steady_forces

__all__ = ["remarks"]


def remarks(run: Crossing) -> tuple[Remark, ...]:
    """Return what is doubtful about a crossing and what its numbers leave out, a sentence each."""
    found: list[Remark] = [remark.moved("deck") for remark in run.deck.remarks]
    found += doubts(run.train, run.deck, run.track, run.settings)
    found += _only_modes(run)
    found += _transient(run)
    return tuple(found)


def _only_modes(run: Crossing) -> list[Remark]:
    if not run.deck.recovery.lacks:
        return []
    text = (
        "Only modes of this deck are known: section forces, reactions and self-weight are null, "
        "and displacements lack the static flexibility of the modes left out."
    )
    return [Remark("", text)]


def _transient(run: Crossing) -> list[Remark]:
    """Compare the first car's rigid-deck forces with the closed form they should have settled to.

    While it crosses.
    """
    s, train, first = run.settings, run.train, run.coupling.cars[0]
    usual = LEAD_IN_SECONDS * s.speed
    if not 0.0 < s.lead_in < usual or first.respond is None or train.notches:
        return []
    try:
        steady = steady_forces(first.car.vehicle, run.track, s.speed, s.excitation)
    except InputError:  # level, or not harmonic: nothing to compare with
        return []
    if not np.all(np.isfinite(steady)) or not np.any(steady):
        return []
    wavelength = run.track.shortest  # the only one
    centre = s.speed * run.time[first.window] - first.car.centre
    settled = (steady[..., None] * np.exp(2j * np.pi * centre / wavelength)).imag
    left = np.linalg.norm(first.rigid[..., first.window] - settled) / np.linalg.norm(settled)
    if left <= 0.01:
        return []
    text = (
        f"= {s.lead_in:g} m: {left:.1%} of the steady wheel forces is still transient while "
        f"the first car crosses. Leave it out for {usual:g} m, or give 0 for level track "
        "before the deck."
    )
    return [InputWarning("lead_in", text)]
