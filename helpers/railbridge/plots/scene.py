"""A train on its deck: as it stands, and at one instant of a crossing."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.markers import CARETDOWN, CARETUP

from .. import errors
from ..decks import Deck
from ..results import Crossing
from ..tracks import FadeIn
from ..trains import AxleTrain, Train
from .drawing import PLACE_LABEL, axes_or_new, curve, label_axes, note, round_down, round_up
from .outlines import Heights, TrainOutline, train_outline
from .style import DECK_COLOUR, GREY, literal, style_of

__all__ = ["arrow_force", "axle_forces", "comfortable_exaggeration", "crossing_at", "train_on_deck"]

_DRAWN, _ROOM = 2.5, 4.0  # m, deck and waves together as drawn, and what they may grow to
_DEPTH = 0.45  # m, of the deck below the rail as drawn
_ARROW = 3.0  # m, full length of an arrow
_LONGEST = 1.3  # full lengths, the longest arrow
_TICK = 0.8  # m, half of the line where an arrow would end at rest
_HEIGHTS = (-9.2, 5.8)  # m, of the sketch
_POINTS = 401  # of the rail
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
    x, y = [start, 0.0, np.nan, deck.length, end], [0.0, 0.0, np.nan, 0.0, 0.0]
    curve(ax, "rail", x, y, color=GREY, lw=2.0)
    _draw_bearings(ax, deck, -2.2)
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


def comfortable_exaggeration(run: Crossing) -> float:
    """Return how many times too large a sketch draws the deck's motion and the rail's waves."""
    return _exaggeration(run, _DRAWN)


def _exaggeration(run: Crossing, room: float) -> float:
    """Return the largest round number of times that stays within some room, m as drawn."""
    waves = np.abs(_waves(run, np.linspace(*_ends(run.deck), _POINTS))).max()
    middle = run.deck.shapes(np.array([run.deck.length / 2]))[0, :, 1]
    largest = float(np.abs(middle @ run.state.q).max() + waves)
    return round_down(room / largest) if largest > 0 else 1.0


def arrow_force(forces: np.ndarray) -> float:
    """Return the force (N) that a sketch of some forces draws as an arrow of full length."""
    return round_up(float(np.abs(forces).max()) / _LONGEST)


def axle_forces(run: Crossing) -> np.ndarray:
    """Return the downward force of each axle on the rail, N, shape (axles, n)."""
    counts = [len(axle.wheels) for axle in run.train.placed_axles]
    first = np.cumsum([0, *counts[:-1]])
    return -np.add.reduceat(run.wheel_forces[:, 1], first, axis=0)


def crossing_at(
    run: Crossing,
    position: float,
    ax: Axes | None = None,
    exaggeration: float | None = None,
    force: float = 0.0,
    forces: np.ndarray | None = None,
) -> Axes:
    """Sketch the train on the deforming deck when the first axle is at a place.

    The left rail has its waves, as exaggerated as the deck's motion; an arrow below each axle is
    its force on the rail, a grey line the one at rest. The picture says both scales.

    Parameters
    ----------
    run : Crossing
    position : float
        Place of the first axle, m from the bridge entrance; at most where the record ends.
    ax : Axes, optional
    exaggeration : float, optional
        So many times too large are deck and waves drawn, as long as there is room; default what
        `comfortable_exaggeration` returns.
    force : float
        At least so large is the force (N) of an arrow of full length.
    forces : ndarray, shape (axles, n), optional
        What `axle_forces` returns, if it is known.

    Returns
    -------
    Axes
        Heights are schematic; cars are drawn as their bogies stand, without the motion of their
        springs.
    """
    ax = axes_or_new(ax, 2.6)
    deck, q = run.deck, run.state.q
    position = errors.number("position", position, unit="m")
    sample = round(position / run.settings.speed / run.settings.time_step) + run.settings.before
    sample = int(np.clip(sample, 0, len(run.time) - 1))
    forces = axle_forces(run) if forces is None else forces
    factor, full = comfortable_exaggeration(run), max(force, arrow_force(forces))
    if exaggeration is not None:
        factor = min(exaggeration, _exaggeration(run, _ROOM))
    along = np.linspace(0.0, deck.length, 49)
    moved = factor * (deck.shapes(along)[:, :, 1] @ q[:, sample])

    def rail(x: np.ndarray) -> np.ndarray:
        return np.interp(x, along, moved, left=0.0, right=0.0) + factor * _waves(run, x)

    start, end = _ends(deck)
    x = np.linspace(start, end, _POINTS)
    bar = {"color": _MOVED, "lw": 6.0, "solid_capstyle": "butt", "zorder": 1.8}
    curve(ax, "deck at rest", [0.0, deck.length], [-_DEPTH] * 2, color=GREY, lw=1.0, ls=":")
    curve(ax, "deck", along, moved - _DEPTH, **bar)
    curve(ax, "rail", x, rail(x), color=style_of("irregularity_vertical").colour, lw=1.3)
    _draw_bearings(ax, deck, -1.9)
    outline = train_outline(run.train, position)
    paths = outline.paths(Heights(wheel=0.35, frame=0.8, floor=1.3, roof=3.6), rail=rail)
    curve(ax, "wheels", *paths["wheels"], color=_TRAIN, ls="", marker="o", ms=4.5, zorder=3)
    curve(ax, "bogies", *paths["bogies"], color=_TRAIN, lw=3.0)
    curve(ax, "cars", *paths["cars"], color=_TRAIN, lw=1.6)
    at_rest = np.array([axle.static_load for axle in run.train.placed_axles])
    feet = rail(outline.wheels)
    _draw_forces(ax, outline.wheels, feet, forces[:, sample] / full, at_rest / full)
    curve(ax, "scale of the forces", [start + 1.5] * 2, [-5.9, -5.9 - _ARROW], color=_TRAIN)
    text = f"force of an axle on the rail,\nthis long: {full / 1e3:g} kN (grey: at rest)"
    note(ax, "scale", text, 0.022, 0.02, va="bottom", color=_TRAIN, size=9)
    text = f"{literal(deck.name)}, {deck.length:g} m\n"
    text += f"deck and waves drawn {factor:g} times too large"
    note(ax, "exaggeration", text, 0.995, 0.02, ha="right", va="bottom", color=_MOVED, size=9)
    label_axes(ax, PLACE_LABEL, legend=False, fit=False)
    if (*ax.get_xlim(), *ax.get_ylim()) != (start, end, *_HEIGHTS):
        ax.set(xlim=(start, end), ylim=_HEIGHTS, yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def _ends(deck: Deck) -> tuple[float, float]:
    """Return the first and the last place of the track that is drawn, m."""
    return -1.2 * deck.length, 2.2 * deck.length


def _waves(run: Crossing, x: np.ndarray) -> np.ndarray:
    """Return the vertical irregularity of the left rail with its run-up, m."""
    return FadeIn(run.track.rail("vertical", "left"), run.settings.lead_in).value(x)


def _draw_forces(
    ax: Axes, x: np.ndarray, feet: np.ndarray, force: np.ndarray, at_rest: np.ndarray
) -> None:
    """Draw forces, as parts of a full arrow, downwards from the rail."""
    tips, gap = feet - _ARROW * force, np.full(len(x), np.nan)
    shafts = np.column_stack([feet, tips, gap]).ravel()
    curve(ax, "forces", np.repeat(x, 3), shafts, color=_TRAIN, lw=1.4)
    for name, marker, shown in (("down", CARETDOWN, force > 0), ("up", CARETUP, force < 0)):
        heads = np.where(shown, tips, np.nan)
        curve(ax, f"heads {name}", x, heads, color=_TRAIN, ls="", marker=marker, ms=5)
    across = np.column_stack([x - _TICK, x + _TICK, gap]).ravel()
    rest = np.repeat(feet - _ARROW * at_rest, 3)
    curve(ax, "forces at rest", across, rest, color=GREY, lw=1.6, zorder=3)


def _draw_bearings(ax: Axes, deck: Deck, height: float) -> None:
    """Draw the deck's bearings."""
    heights = np.full(len(deck.supports), height)
    curve(ax, "bearings", deck.supports, heights, color=DECK_COLOUR, ls="", marker="^", ms=9)


def _draw_loads(ax: Axes, outline: TrainOutline) -> None:
    """Draw bare axle loads as lines above their wheels."""
    heights = np.tile([0.9, 3.4, np.nan], len(outline.wheels))
    curve(ax, "loads", np.repeat(outline.wheels, 3), heights, color=_TRAIN)
