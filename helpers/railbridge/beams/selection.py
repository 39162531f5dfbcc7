"""How many modes a deck needs, and what is lost where fewer are asked for.

A load that moves, or a car that shakes, finds in every span the first modes of that span, so a
viaduct of many spans needs many. What the modes left out would do statically is added anyway (see
`railbridge.decks`); what they would do beyond that is lost.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..cutoffs import EN1990_LEAST
from ..decks import Recovery, load_of, whole_group
from ..errors import Remark, ResultWarning
from ..guideways import COMPONENTS
from .mesh import BeamModes

__all__ = ["left_out", "needed"]

REACH = EN1990_LEAST
"""Hz; all modes below it are kept, as EN 1990 A2.4.4.2.1 asks for deck accelerations."""
AT_LEAST = 20
CEILING = 150.0
"""Hz; modes above it do not count towards `AT_LEAST`."""
A_SPAN = {"vertical": 3, "lateral": 1, "torsion": 1}
"""Least modes in every span; EN 1990 asks for three."""
STIFF = 10.0
"""A direction whose first mode lies above the ceiling and so many times the first vertical one is
left to statics."""
_LOST = {"displacement_z": 0.1, "displacement_y": 0.1, "rotation_x": 0.25}
"""Share of the flexibility in the middle of a span beyond which the modes left out matter: the
first mode of a simple span alone lacks 1.4 % in bending and 19 % in twist."""
_WORDS = {"displacement_z": "up and down", "displacement_y": "sideways", "rotation_x": "in twist"}


def needed(
    modes: BeamModes, excitable: np.ndarray, fields: Sequence[str], spans: int, whole: bool
) -> int | None:
    """Return how many of the excitable modes to keep; None if too few of them are known.

    All below 30 Hz; in every span at least three vertical ones, and one sideways and in twist where
    these are not far stiffer; at least twenty that lie below 150 Hz. Of equal frequencies all or
    none.

    Parameters
    ----------
    modes : BeamModes
        The lowest ones.
    excitable : ndarray of int
        Those that loads can excite, ascending.
    fields : sequence of str
        Of the beam.
    spans : int
    whole : bool
        Whether these are all modes that the mesh has.
    """
    frequencies = modes.frequencies_hz[excitable]
    shares = np.array([modes.energies[name][excitable] for name in A_SPAN])
    own = dict(zip(A_SPAN, (np.flatnonzero(largest) for largest in _largest(shares)), strict=True))
    if not len(own["vertical"]):
        return None if not whole else len(frequencies)
    limit = max(CEILING, STIFF * frequencies[own["vertical"][0]])
    counts = [int(np.sum(frequencies <= REACH)), min(AT_LEAST, int(np.sum(frequencies <= CEILING)))]
    for name in (name for name in A_SPAN if name in fields):
        members, wanted = own[name], A_SPAN[name] * spans
        if not len(members) or frequencies[members[0]] > limit:
            if not whole and frequencies[-1] <= limit:
                return None  # one may still come
            continue
        if len(members) < wanted and not whole:
            return None
        counts.append(int(members[min(wanted, len(members)) - 1]) + 1)
    count = whole_group(frequencies, max(counts))
    return count if whole or (count < len(frequencies) and frequencies[-1] > REACH) else None


def _largest(shares: np.ndarray) -> np.ndarray:
    """Return in which direction each mode moves most, shape (directions, modes)."""
    return np.arange(len(shares))[:, None] == np.argmax(shares, axis=0)


def left_out(recovery: Recovery, frequencies_hz: np.ndarray, middles: np.ndarray) -> list[Remark]:
    """Return where, in the middle of a span, the modes kept have too little of the flexibility.

    Parameters
    ----------
    recovery : Recovery
        Of the deck.
    frequencies_hz : ndarray, shape (m,)
        Of its modes.
    middles : ndarray
        Middles of the spans, m.
    """
    found = []
    for quantity, allowed in _LOST.items():
        lines = [recovery.section(quantity, x) for x in middles]
        if lines[0] is None:
            continue
        component = COMPONENTS.index(load_of(quantity))
        whole = np.array(
            [line.influence(middles[i : i + 1])[0, 0, component] for i, line in enumerate(lines)]
        )
        kept = [np.sum((line.modal / (2 * np.pi * frequencies_hz)) ** 2) for line in lines]
        lost = 1.0 - np.array(kept) / whole
        worst = int(np.argmax(lost))
        if lost[worst] > allowed:
            text = (
                f"= {len(frequencies_hz)}: the modes left out hold {lost[worst]:.0%} of the deck's "
                f"flexibility {_WORDS[quantity]} at x = {middles[worst]:g} m; what they would do "
                "beyond statics is lost. Leave modes out to have enough of them chosen."
            )
            found.append(ResultWarning("modes", text))
    return found
