"""How quantities look: one name, unit, colour and line style for each, in the whole suite.

Colour says what a curve is (force, displacement, ...), line style which way it points (vertical
solid, lateral dashed, about the track's axis dash-dotted). The colours can be told apart with the
common kinds of colour blindness.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.colors import to_hex, to_rgb

from ..errors import choice

__all__ = [
    "DECK_COLOUR", "FREEDOM_NAMES", "GREY", "PALE", "QUANTITY_STYLES", "RUN_COLOURS", "SHADE",
    "STYLE", "QuantityStyle", "literal", "mode_in_words", "other_shade", "style_of",
]  # fmt: skip

FREEDOM_NAMES = {"y": "sway", "z": "bounce", "roll": "roll", "pitch": "pitch", "yaw": "yaw"}
"""Freedoms of a body in words."""
GREY = "#8a8a8a"
PALE = "#d9d9d9"
SHADE = "#e3e9ef"
DECK_COLOUR = "#34495e"

RUN_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#882255", "#B07800", "#000000")
"""Colours of runs that stand side by side in one axes."""

STYLE = {
    "axes.prop_cycle": f"cycler('color', {list(RUN_COLOURS)})",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlelocation": "left",
    "axes.titlesize": "medium",
    "legend.frameon": False,
    "legend.fontsize": "small",
}
"""Settings for ``plt.style.use``: colours of `RUN_COLOURS` in their order, no boxes around axes and
legends. Nothing in the package sets them; a notebook that draws by itself does, in its import cell.
"""

_FORCE, _COUPLE, _MOTION, _SPEED = "#D55E00", "#882255", "#0072B2", "#56B4E9"
_ACCELERATION, _SECTION, _REACTION, _TRACK = "#009E73", "#AA4499", "#B07800", "#000000"
_VERTICAL, _LATERAL, _ROLL = "-", "--", "-."
# Shear forces have the colour of bending moments, rotations that of displacements; their dashes
# differ.
_OTHER_VERTICAL, _OTHER_LATERAL = (0, (6, 1)), (0, (2, 1))

_DARK = 0.3
"""Mean of red, green and blue below which another shade of a colour is lighter, not darker."""


class QuantityStyle(NamedTuple):
    """How a quantity is drawn.

    Attributes
    ----------
    words : str
        Its name on an axis.
    unit : str
        As drawn.
    factor : float
        From SI to that unit.
    colour : str
    line : str or tuple
        Line style as in matplotlib.
    """

    words: str
    unit: str
    factor: float
    colour: str
    line: str | tuple

    @property
    def label(self) -> str:
        """Axis label with unit."""
        return f"{self.words} ({self.unit})"


QUANTITY_STYLES = {
    name: QuantityStyle(*style)
    for name, style in {
        "irregularity_vertical": ("vertical irregularity", "mm", 1e3, _TRACK, _VERTICAL),
        "irregularity_lateral": ("lateral irregularity", "mm", 1e3, _TRACK, _LATERAL),
        "slope_vertical": ("vertical slope", "mm/m", 1e3, GREY, _VERTICAL),
        "slope_lateral": ("lateral slope", "mm/m", 1e3, GREY, _LATERAL),
        "force_y": ("lateral force", "kN", 1e-3, _FORCE, _LATERAL),
        "force_z": ("vertical force", "kN", 1e-3, _FORCE, _VERTICAL),
        "moment_x": ("roll moment", "kN m", 1e-3, _COUPLE, _ROLL),
        "moment_y": ("pitch moment", "kN m", 1e-3, _COUPLE, _VERTICAL),
        "moment_z": ("yaw moment", "kN m", 1e-3, _COUPLE, _LATERAL),
        "displacement_y": ("lateral displacement", "mm", 1e3, _MOTION, _LATERAL),
        "displacement_z": ("vertical displacement", "mm", 1e3, _MOTION, _VERTICAL),
        "rotation_x": ("twist", "mrad", 1e3, _MOTION, _ROLL),
        "rotation_y": ("rotation about y", "mrad", 1e3, _MOTION, _OTHER_VERTICAL),
        "rotation_z": ("rotation about z", "mrad", 1e3, _MOTION, _OTHER_LATERAL),
        "velocity_y": ("lateral velocity", "mm/s", 1e3, _SPEED, _LATERAL),
        "velocity_z": ("vertical velocity", "mm/s", 1e3, _SPEED, _VERTICAL),
        "velocity_roll": ("twist velocity", "mrad/s", 1e3, _SPEED, _ROLL),
        "acceleration_y": ("lateral acceleration", "m/s²", 1.0, _ACCELERATION, _LATERAL),
        "acceleration_z": ("vertical acceleration", "m/s²", 1.0, _ACCELERATION, _VERTICAL),
        "acceleration_roll": ("twist acceleration", "rad/s²", 1.0, _ACCELERATION, _ROLL),
        "moment_vertical": ("vertical bending moment", "kN m", 1e-3, _SECTION, _VERTICAL),
        "moment_lateral": ("lateral bending moment", "kN m", 1e-3, _SECTION, _LATERAL),
        "torsion": ("torsion", "kN m", 1e-3, _SECTION, _ROLL),
        "shear_vertical": ("vertical shear", "kN", 1e-3, _SECTION, _OTHER_VERTICAL),
        "shear_lateral": ("lateral shear", "kN", 1e-3, _SECTION, _OTHER_LATERAL),
        "reaction_y": ("lateral reaction", "kN", 1e-3, _REACTION, _LATERAL),
        "reaction_z": ("vertical reaction", "kN", 1e-3, _REACTION, _VERTICAL),
        "reaction_x": ("reaction moment about x", "kN m", 1e-3, _REACTION, _ROLL),
        "damping": ("damping ratio", "%", 100.0, _ACCELERATION, _VERTICAL),
    }.items()
}
"""One style for each quantity; names as in the results."""


def style_of(quantity: str) -> QuantityStyle:
    """Return a quantity's style.

    Raises
    ------
    InputError
        An unknown quantity; the near one is suggested.
    """
    return QUANTITY_STYLES[choice("quantity", quantity, QUANTITY_STYLES)]


def other_shade(colour: str) -> str:
    """Return another shade of a colour, for the same quantity at another place.

    The right rail beside the left one, the far bearing beside the near one.
    """
    mixed = np.array(to_rgb(colour))
    return to_hex(mixed + 0.55 * (1.0 - mixed) if mixed.mean() < _DARK else 0.45 * mixed)


def literal(name: str) -> str:
    """Return a name as pictures show it letter by letter: a dollar sign begins no formula."""
    return name.replace("$", r"\$")


def mode_in_words(mode: str) -> str:
    """Return the name of a vehicle's mode in words: ``car z`` is the car's bounce."""
    return " ".join(FREEDOM_NAMES.get(part, part) for part in mode.split())
