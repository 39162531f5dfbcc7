"""Interactive panels: a case, a row of controls, one picture that follows them, and its words.

A panel keeps one matplotlib figure of its own and moves its curves; the picture goes into an image
widget. Nothing physical is computed here and no colours are chosen: results come from the case,
drawing from `plots`.

    panel = rb.panels.deck_response()
    panel                                      # in a notebook cell: the sliders
    panel.set(speed=22.0, wavelength=12.0)     # the same by hand; SI units
    panel.summary, panel.figure, panel.case    # what it shows, in words, as a figure, as a case
    panel.close()                              # frees it, as running its cell again does
"""

from .bridgeform import BridgeForm
from .control import Control
from .notebook_panels import (
    deck_modes,
    deck_response,
    fixed_point,
    irregularities,
    map_and_crossing,
    overview,
    rigid_forces,
)
from .ownbridge import own_bridge
from .panel import FALLBACK, Panel
from .randomtrack import random_track
from .wheels import wheels_with_mass

__all__ = [
    "BridgeForm", "FALLBACK", "Control", "Panel", "deck_modes", "deck_response", "fixed_point",
    "irregularities", "map_and_crossing", "overview", "own_bridge", "random_track", "rigid_forces",
    "wheels_with_mass",
]  # fmt: skip
