"""A train on its deck: as it stands, and at one instant of a crossing."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..decks import Deck
from ..results import Crossing
from ..trains import AxleTrain, Train
from .drawing import PLACE_LABEL, axes_or_new, curve, label_axes, note, round_down
from .outlines import Heights, TrainOutline, train_outline
from .style import DECK_COLOUR, GREY, literal, style_of

__all__ = ["crossing_at", "train_on_deck"]

_DRAWN_SAG = 1.8  # m, largest displacement as drawn
_MOVED, _TRAIN = style_of("displacement_z").colour, style_of("force_z").colour


def train_on_deck(
    train: Train | AxleTrain, deck: Deck, ax: Axes | None = None, position: float | None = None
) -> Axes:
    """Sketch a train on its deck.

    Parameters
    ----------
    train : Train or AxleTrain
    deck : Deck
    ax : Axes, optional
    position : float, optional
        Place of the first axle, m from the bridge entrance; default 0, at the entrance.

    Returns
    -------
    Axes
        Heights are schematic.
    """
    ax = axes_or_new(ax, 1.9)
    first_axle = 0.0 if position is None else errors.number("position", position, unit="m")
    start = min(0.0, first_axle - train.length) - 12.0
    end = max(deck.length, first_axle) + 12.0
    _draw_track(ax, deck, start, end, bearing_height=-2.2, lw=2.0)
    bar = {"color": DECK_COLOUR, "lw": 8.0, "solid_capstyle": "butt"}
    curve(ax, "deck", [0.0, deck.length], [-0.8, -0.8], **bar)
    outline = train_outline(train, first_axle)
    paths = outline.paths(Heights(wheel=0.55, frame=1.1, floor=1.6, roof=4.2))
    curve(ax, "cars", *paths["cars"], color=_TRAIN, lw=1.3)
    curve(ax, "bogies", *paths["bogies"], color=_TRAIN, lw=2.5)
    curve(ax, "wheels", *paths["wheels"], color=_TRAIN, ls="", marker="o", ms=3.2)
    if not outline.cars:
        _draw_loads(ax, outline)
    place = {"data_x": True, "ha": "center", "va": "bottom"}
    note(ax, "deck name", f"{literal(deck.name)}, {deck.length:g} m", deck.length / 2, 0.0, **place)
    label_axes(ax, PLACE_LABEL, legend=False)
    ax.set(xlim=(start, end), ylim=(-4.2, 5.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def crossing_at(run: Crossing, position: float, ax: Axes | None = None) -> Axes:
    """Sketch the train on the deforming deck when the first axle is at a place.

    The picture says how many times too large the deck moves.

    Parameters
    ----------
    run : Crossing
    position : float
        Place of the first axle, m from the bridge entrance; at most where the record ends.
    ax : Axes, optional

    Returns
    -------
    Axes
        Heights are schematic; cars are drawn as their bogies stand, without the motion of their
        springs.
    """
    ax = axes_or_new(ax, 2.2)
    deck, q = run.deck, run.state.q
    position = errors.number("position", position, unit="m")
    sample = round(position / run.settings.speed / run.settings.time_step)
    sample = int(np.clip(sample, 0, len(run.time) - 1))
    along = np.linspace(0.0, deck.length, 49)
    largest = float(np.abs(deck.shapes(np.array([deck.length / 2]))[0, :, 1] @ q).max())
    factor = round_down(_DRAWN_SAG / largest) if largest > 0 else 1.0
    moved = factor * (deck.shapes(along)[:, :, 1] @ q[:, sample])

    start, end = -1.2 * deck.length, 2.2 * deck.length
    _draw_track(ax, deck, start, end, bearing_height=-1.75, lw=2.5)
    curve(ax, "deck at rest", [0.0, deck.length], [-0.45, -0.45], color=GREY, lw=1.0, ls=":")
    bar = {"color": _MOVED, "lw": 7.0, "solid_capstyle": "butt", "zorder": 1.8}
    curve(ax, "deck", along, moved - 0.45, **bar)
    paths = train_outline(run.train, position).paths(
        Heights(wheel=0.35, frame=0.8, floor=1.3, roof=3.9),
        rail=lambda x: np.interp(x, along, moved, left=0.0, right=0.0),
    )
    curve(ax, "wheels", *paths["wheels"], color=_TRAIN, ls="", marker="o", ms=4.5, zorder=3)
    curve(ax, "bogies", *paths["bogies"], color=_TRAIN, lw=3.0)
    curve(ax, "cars", *paths["cars"], color=_TRAIN, lw=1.6)
    text = f"displacement of the deck drawn {factor:g} times too large"
    note(ax, "exaggeration", text, 0.005, 0.02, va="bottom", color=_MOVED, size=9.5)
    text = f"{literal(deck.name)}, {deck.length:g} m"
    note(ax, "deck name", text, 0.995, 0.02, ha="right", va="bottom", size=9.5)
    label_axes(ax, PLACE_LABEL, legend=False, fit=False)
    if (*ax.get_xlim(), *ax.get_ylim()) != (start, end, -3.6, 4.6):
        ax.set(xlim=(start, end), ylim=(-3.6, 4.6), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def _draw_track(
    ax: Axes, deck: Deck, start: float, end: float, bearing_height: float, lw: float
) -> None:
    """Draw the rail before and behind the deck, and the deck's bearings."""
    x, y = [start, 0.0, np.nan, deck.length, end], [0.0, 0.0, np.nan, 0.0, 0.0]
    curve(ax, "rail", x, y, color=GREY, lw=lw)
    heights = np.full(len(deck.supports), bearing_height)
    curve(ax, "bearings", deck.supports, heights, color=DECK_COLOUR, ls="", marker="^", ms=9)


def _draw_loads(ax: Axes, outline: TrainOutline) -> None:
    """Draw bare axle loads as lines above their wheels."""
    heights = np.tile([0.9, 3.4, np.nan], len(outline.wheels))
    curve(ax, "loads", np.repeat(outline.wheels, 3), heights, color=_TRAIN)
