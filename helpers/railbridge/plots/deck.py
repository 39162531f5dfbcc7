"""The deck at rest in its modes: shapes, damping, influence lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..damping import rayleigh_ratio
from ..decks import Deck, load_of
from .drawing import (
    PLACE_LABEL,
    axes_or_new,
    curve,
    label_axes,
    log_frequencies,
    note,
    numbers_up_to,
    reuses_artists,
    round_up,
    small_multiples,
)
from .style import GREY, literal, style_of

__all__ = ["damping", "deck_mode", "deck_modes", "draw_bearings", "influence_line"]


def deck_mode(deck: Deck, mode: int, ax: Axes | None = None) -> Axes:
    """Plot a mode shape of the deck along its axis, with its bearings.

    Lateral, vertical and twist, each against the largest. Twist is shown as the vertical motion at
    the deck's edge (1 m off the axis if the width is not known). Modes count from 1.
    """
    ax = axes_or_new(ax, 2.2)
    i = errors.integer("mode", mode, least=1, most=len(deck.mode_names)) - 1
    x = np.linspace(0.0, deck.length, 301)
    shape = deck.shapes(x)[:, i] * [1.0, 1.0, deck.width / 2 if deck.width else 1.0]
    shape = shape / np.abs(shape).max()
    names = ("displacement_y", "displacement_z", "rotation_x")
    words = ("lateral", "vertical", "twist" if not deck.width else "twist, at the edge")
    curve(ax, "axis", [0.0, deck.length], [0.0, 0.0], color=GREY, lw=0.8)
    for own, name, word in zip(shape.T, names, words, strict=True):
        style = style_of(name)
        moves = np.abs(own).max() > 1e-3
        line = {"label": word if moves else None, "color": style.colour, "ls": style.line}
        curve(ax, name, x, own if moves else np.full_like(x, np.nan), **line)
    draw_bearings(ax, deck)
    frequency, ratio = deck.frequencies_hz[i], 100 * deck.damping_ratios[i]
    title = f"mode {mode}: {literal(deck.mode_names[i])}, {frequency:.4g} Hz, damping {ratio:.1f} %"
    label_axes(ax, PLACE_LABEL, "shape (-)", title)
    ax.set_ylim(-1.15, 1.15)
    return ax


def deck_modes(
    deck: Deck, modes: Iterable[int] = range(1, 7), axes: Sequence[Axes] | None = None
) -> np.ndarray:
    """Plot several mode shapes of the deck as small multiples; see `deck_mode`."""
    modes = numbers_up_to("modes", modes, 1, len(deck.mode_names))
    axes = small_multiples(axes, len(modes), 2, 0.4, 1.75, sharex=True, sharey=True)
    handles = {}
    for ax, mode in zip(axes, modes, strict=True):
        deck_mode(deck, mode, ax)
        if ax.get_legend() is not None:
            ax.get_legend().remove()
        frequency, ratio = deck.frequencies_hz[mode - 1], 100 * deck.damping_ratios[mode - 1]
        title = f"{mode}: {literal(deck.mode_names[mode - 1])}, {frequency:.4g} Hz, {ratio:.1f} %"
        ax.set_title(title, loc="left", fontsize="medium")
        ax.label_outer()
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            if not label.startswith("_"):
                handles[label] = handle
    place = {"loc": "outside upper right", "ncols": 3, "frameon": False, "fontsize": "small"}
    axes[0].figure.legend(handles.values(), handles.keys(), **place)
    return axes


def damping(
    alpha: float, beta: float, marks: Mapping[str, float] | None = None, ax: Axes | None = None
) -> Axes:
    """Plot Rayleigh damping over frequency with its two parts.

    Parameters
    ----------
    alpha, beta : float
        1/s and s; see `railbridge.rayleigh`.
    marks : mapping of float, optional
        Frequencies to point out, Hz, by name.
    ax : Axes, optional
    """
    ax = axes_or_new(ax, 3.4)
    marks = dict(marks or {})
    low, high = min([0.5, *marks.values()]) * 0.9, max([60.0, *marks.values()]) * 1.1
    if reuses_artists(ax):
        low, high = 1 / round_up(1 / low), round_up(high)
    f = np.geomspace(low, high, 300)
    style = style_of("damping")
    for name, label, parts, line in (
        ("mass", "mass part", (alpha, 0.0), {"color": GREY, "ls": "--"}),
        ("stiffness", "stiffness part", (0.0, beta), {"color": GREY, "ls": "-."}),
        ("total", "damping ratio", (alpha, beta), {"color": style.colour, "lw": 2.0}),
    ):
        curve(ax, name, f, style.factor * rayleigh_ratio(*parts, f), label=label, **line)
    places = np.array(list(marks.values()))
    values = style.factor * rayleigh_ratio(alpha, beta, places)
    curve(ax, "points", places, values, color="k", ls="", marker="o", ms=4.5, zorder=3)
    log_frequencies(ax)
    most = 1.9 * max([5.0, *values])
    most = round_up(most) if reuses_artists(ax) else most
    _name_points(
        ax, {name: (f, v / most) for (name, f), v in zip(marks.items(), values, strict=True)}
    )
    label_axes(ax, "frequency (Hz)", style.label)
    ax.set(xlim=(f[0], f[-1]), ylim=(0.0, most))
    return ax


def _name_points(ax: Axes, points: Mapping[str, tuple[float, float]]) -> None:
    """Write names of points (Hz, height of the axes) upwards, or beside where they are close."""
    above = {"rotation": 65, "rotation_mode": "anchor", "va": "center"}
    beside = {"bbox": {"fc": "white", "ec": "none", "pad": 0.8, "alpha": 0.85}}
    last = 0.0
    for frequency, height, name in sorted((f, h, name) for name, (f, h) in points.items()):
        text = f"{name}, {frequency:.4g} Hz"
        if frequency < 1.12 * last:
            note(ax, f"name {name}", f"  {text}", frequency, height - 0.05, data_x=True, **beside)
        else:
            note(ax, f"name {name}", text, frequency, height + 0.04, data_x=True, **above)
            last = frequency


def influence_line(deck: Deck, quantity: str, x: float, ax: Axes | None = None) -> Axes:
    """Plot an influence line: the output at x against the place of a unit load of its direction.

    Parameters
    ----------
    deck : Deck
    quantity : str
        A displacement or section force at x, or a reaction (``force_z``) of the bearing line at x.
    x : float
        m.
    ax : Axes, optional

    Raises
    ------
    InputError
        A quantity that the deck cannot recover.
    """
    reaction, load = quantity in ("force_y", "force_z", "moment_x"), load_of(quantity)
    jump = [max(x - 1e-6, 0.0), min(x + 1e-6, deck.length)]
    along = np.unique(np.concatenate([np.linspace(0.0, deck.length, 601), jump]))
    values = deck.influence(quantity, at=x, places=along)
    ax = axes_or_new(ax)
    style = style_of(f"reaction_{quantity[-1]}" if reaction else quantity)
    unit, factor = _influence_unit(style.unit, load)
    curve(ax, "axis", [0.0, deck.length], [0.0, 0.0], color=GREY, lw=0.8)
    options = {"label": f"{style.words} at x = {x:g} m", "color": style.colour, "ls": style.line}
    curve(ax, "line", along, factor * values, **options)
    draw_bearings(ax, deck)
    way = {"y": "lateral", "z": "upward", "roll": "roll"}[load]
    return label_axes(ax, "place of the load, x (m)", f"per unit {way} load ({unit})")


def _influence_unit(unit: str, load: str) -> tuple[str, float]:
    """Return the unit of an influence line as drawn, and the factor from SI to it."""
    unit_load = "MN m" if load == "roll" else "MN"
    if unit in ("mm", "mrad"):
        return f"{unit} per {unit_load}", 1e9
    return ("-" if unit == "kN" or load == "roll" else "m"), 1.0


def draw_bearings(ax: Axes, deck: Deck) -> None:
    """Draw the bearing lines on the deck's axis."""
    zeros = np.zeros(len(deck.supports))
    # Without any the layout would make room for an artist that is nowhere.
    clipped = not deck.supports
    triangle = {"color": "k", "ls": "", "marker": "^", "ms": 7, "clip_on": clipped}
    curve(ax, "bearings", deck.supports, zeros, **triangle)
