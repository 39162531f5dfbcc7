"""One instant of a crossing: the train on the deforming deck; and a car's five force components in two axes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..results import Crossing
from ..trains import CONDENSED
from .drawing import ALONG, GREY, TIME, curve, finish, grid, look, note, one, round_below
from .forces import shade_car
from .outlines import axle_places, car_outlines

__all__ = ["car_components", "crossing_at"]

_SAG = 1.8  # m, largest displacement as drawn
_DECK, _TRAIN = look("displacement_z").colour, look("force_z").colour


def crossing_at(run: Crossing, position: float, ax: Axes | None = None) -> Axes:
    """Sketch the train on the deforming deck when the first axle is at a place; says how many times too large the deck moves.

    Parameters
    ----------
    run : Crossing
    position : float
        Place of the first axle, m from the bridge entrance; at most where the record ends.
    ax : Axes, optional

    Returns
    -------
    Axes
        Heights are schematic; cars are drawn as their bogies stand, without the motion of their springs.
    """
    ax = one(ax, 2.2)
    deck, train = run.deck, run.train
    position = errors.number("position", position, unit="m")
    now = int(np.clip(round(position / run.settings.speed / run.settings.time_step), 0, len(run.time) - 1))
    along = np.linspace(0.0, deck.length, 49)
    shape = deck.shapes(along)[:, :, 1]
    largest = float(np.abs(deck.shapes(np.array([deck.length / 2]))[0, :, 1] @ run.state.q).max())
    times = round_below(_SAG / largest) if largest > 0 else 1.0
    moved = times * (shape @ run.state.q[:, now])

    def level(x):
        return np.interp(x, along, moved, left=0.0, right=0.0)

    start, end = -1.2 * deck.length, 2.2 * deck.length
    curve(ax, "rail", [start, 0.0, np.nan, deck.length, end], [0.0, 0.0, np.nan, 0.0, 0.0], color=GREY, lw=2.5)
    curve(ax, "rest", [0.0, deck.length], [-0.45, -0.45], color=GREY, lw=1.0, ls=":")
    curve(ax, "deck", along, moved - 0.45, color=_DECK, lw=7.0, solid_capstyle="butt", zorder=1.8)
    curve(ax, "bearings", deck.supports, np.full(len(deck.supports), -1.75), color="#34495e", ls="", marker="^", ms=9)
    wheels = axle_places(train, position)
    curve(ax, "wheels", wheels, level(wheels) + 0.35, color=_TRAIN, ls="", marker="o", ms=4.5, zorder=3)
    bogies, cars = [], []
    for car in car_outlines(train, position):
        places = [x.mean() for x in car.bogies]
        heights = [level(x).mean() for x in car.bogies]
        for x, height in zip(car.bogies, heights, strict=True):
            bogies.append([[x.min() - 0.6, x.max() + 0.6, np.nan], [height + 0.8] * 3])
        # The car body lies as its outermost bogies do.
        tilt = (heights[0] - heights[-1]) / (places[0] - places[-1]) if len(places) > 1 else 0.0
        rear, front = car.body
        x = np.array([rear, front, front, rear, rear, np.nan])
        up = np.array([1.3, 1.3, 3.9, 3.9, 1.3, np.nan])
        cars.append([x, heights[0] + tilt * (x - places[0]) + up])
    for name, parts, width in (("bogies", bogies, 3.0), ("cars", cars, 1.6)):
        x, y = np.concatenate([np.array(p, dtype=float) for p in parts], axis=1) if parts else ([], [])
        curve(ax, name, x, y, color=_TRAIN, lw=width)
    note(
        ax, "times", f"displacement of the deck drawn {times:g} times too large", 0.005, 0.02, va="bottom", color=_DECK, size=9.5
    )
    note(ax, "name", f"{deck.name}, {deck.length:g} m", 0.995, 0.02, ha="right", va="bottom", size=9.5)
    finish(ax, ALONG, legend=False, fit=False)
    if (*ax.get_xlim(), *ax.get_ylim()) != (start, end, -3.6, 4.6):
        ax.set(xlim=(start, end), ylim=(-3.6, 4.6), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def car_components(run: Crossing, axes: Sequence[Axes] | None = None, car: int = 1, now: float | None = None) -> np.ndarray:
    """Plot one car's five condensed force components, without its weight: forces in one axes, moments in the other.

    Parameters
    ----------
    run : Crossing
    axes : two Axes, optional
    car : int
        From 1.
    now : float, optional
        Instant to mark, s.

    Returns
    -------
    ndarray of Axes, shape (2,)
    """
    axes = grid(axes, 1, 2, 2.8)
    history = run.car_forces(car, static=False)
    for ax, kind, unit in ((axes[0], "force", "kN"), (axes[1], "moment", "kN m")):
        shade_car(run, car, ax, label=False)
        for name in (c for c in CONDENSED if c.startswith(kind)):
            style = look(name)
            label = style.words.removesuffix(f" {kind}")
            curve(ax, name, run.time, style.factor * history[name], label=label, color=style.colour, ls=style.line)
        mark_now(ax, now)
        finish(ax, TIME, f"car {car}, {kind} ({unit})")
    return axes


def mark_now(ax: Axes, now: float | None) -> None:
    """Mark an instant by a thin vertical line."""
    if now is not None:
        options = {"color": "k", "lw": 0.9, "ls": ":", "transform": ax.get_xaxis_transform()}
        curve(ax, "now", [now, now], [0.0, 1.0], **options)
