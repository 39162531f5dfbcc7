"""What a crossing comes to along the deck."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ..errors import InputError
from ..results import Crossing
from .deck import draw_bearings
from .drawing import PLACE_LABEL, axes_or_new, band, curve, label_axes, quantity_curve
from .style import GREY, style_of

__all__ = ["deck_envelope"]


def deck_envelope(run: Crossing, quantity: str = "displacement_z", ax: Axes | None = None) -> Axes:
    """Plot the smallest and the largest value of a quantity along the deck.

    The legend says both extremes with their places; what jumps while the train moves over is seen
    on both sides of the jump.

    Parameters
    ----------
    run : Crossing
    quantity : str
        One of those that have an envelope, see `Crossing.envelope`.
    ax : Axes, optional

    Raises
    ------
    InputError
        An unknown quantity, or one that the deck does not have.
    """
    found = run.envelope(quantity)
    if found is None:
        raise InputError("quantity", quantity, "is nothing that this deck has")
    extremes = [found.at(place).extremes("value") for place in range(len(found.x))]
    low, high = (np.array([each[side][0] for each in extremes]) for side in (0, 1))
    ax, style = axes_or_new(ax, 2.6), style_of(quantity)
    curve(ax, "axis", [0.0, run.deck.length], [0.0, 0.0], color=GREY, lw=0.8)
    band(ax, "between", found.x, style.factor * low, style.factor * high, style.colour)
    for name, values, i in (
        ("smallest", low, int(np.argmin(low))),
        ("largest", high, int(np.argmax(high))),
    ):
        value = f"{style.factor * values[i]:.4g} {style.unit}"
        line = {"name": name, "label": f"{name} {value} at x = {found.x[i]:g} m"}
        quantity_curve(ax, quantity, found.x, values, **line)
    draw_bearings(ax, run.deck)
    return label_axes(ax, PLACE_LABEL, style.label)
