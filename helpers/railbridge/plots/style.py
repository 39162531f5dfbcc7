"""Looks of pictures beyond a single quantity: settings for a notebook's own drawings, the second shade of a colour."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import to_hex, to_rgb

from .drawing import COMPARED

__all__ = ["STYLE", "second"]

STYLE = {
    "axes.prop_cycle": f"cycler('color', {list(COMPARED)})",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlelocation": "left",
    "axes.titlesize": "medium",
    "legend.frameon": False,
    "legend.fontsize": "small",
}
"""Settings for ``plt.style.use``: colours of `drawing.COMPARED` in their order, no boxes around axes and legends. Nothing in the
package sets them; a notebook that draws by itself does, in its import cell."""

_DARK = 0.3  # mean of red, green and blue below which a colour needs a lighter second, not a darker one


def second(colour: str) -> str:
    """Return another shade of a colour, for the same quantity at another place: the right rail, the far bearing."""
    mixed = np.array(to_rgb(colour))
    return to_hex(mixed + 0.55 * (1.0 - mixed) if mixed.mean() < _DARK else 0.45 * mixed)
