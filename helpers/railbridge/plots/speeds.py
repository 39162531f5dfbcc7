"""What depends on the speed, drawn over the speed, with a dot at the present one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from ..vehicles import Vehicle
from .drawing import axes_or_new, curve, label_axes, note, quantity_curve, vertical_lines
from .style import DECK_COLOUR, RUN_COLOURS, style_of
from .track import grouped_frequencies

__all__ = ["force_over_speed", "frequency_met", "speeds_in_step"]

_SPEED_LABEL = "speed (m/s)"
_DOT = {"color": "k", "ls": "", "marker": "o", "ms": 7, "zorder": 4}
_NAMES_APART = 0.085  # of the height of the axes
_HERE = "this speed"


def force_over_speed(
    speeds: np.ndarray,
    force: np.ndarray,
    now: tuple[float, float],
    mark: Mapping[str, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot the steady amplitude of a vertical force over the speed.

    Parameters
    ----------
    speeds, force : ndarray, shape (n,)
        m/s and N.
    now : (float, float)
        Speed (m/s) and force (N) of the dot.
    mark : mapping of float, optional
        Speeds for vertical lines, m/s, by name.
    ax : Axes, optional
    """
    ax = axes_or_new(ax)
    vertical_lines(ax, mark, "m/s")
    quantity_curve(ax, "force_z", speeds, force, name="over speed")
    quantity_curve(ax, "force_z", [now[0]], [now[1]], name="now", label=_HERE, **_DOT)
    label_axes(ax, _SPEED_LABEL, "steady bounce force (kN)")
    ax.set_xlim(speeds[0], speeds[-1])
    ax.set_ylim(bottom=0.0)
    return ax


def frequency_met(
    vehicle: Vehicle,
    speeds: np.ndarray,
    wavelength: float,
    now: float,
    between: tuple[float, float],
    ax: Axes | None = None,
) -> Axes:
    """Plot the frequency that a train meets on waves over its speed.

    The natural frequencies of a car stand as lines, with their names at the right.

    Parameters
    ----------
    vehicle : Vehicle
    speeds : ndarray, shape (n,)
        m/s.
    wavelength : float
        m.
    now : float
        Speed of the dot, m/s.
    between : (float, float)
        Ends of the axis of frequencies, Hz.
    ax : Axes, optional
    """
    ax = axes_or_new(ax)
    if ax.get_yscale() == "linear":
        ax.set_yscale("log")
        ax.set_yticks([0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50])
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter("")
    groups, natural = grouped_frequencies(vehicle), style_of("displacement_z").colour
    values = vehicle.modes().frequencies_hz
    across = np.tile([*speeds[[0, -1]], np.nan], len(values))
    line = {"label": "natural frequencies of the car", "color": natural, "lw": 1.0}
    curve(ax, "natural", across, np.repeat(values, 3), **line)
    line = {"color": style_of("force_z").colour, "lw": 2.0, "zorder": 3}
    curve(ax, "met", speeds, speeds / wavelength, label="frequency of the waves", **line)
    curve(ax, "now", [now], [now / wavelength], label=_HERE, **_DOT)
    low, high = np.log(between)
    places = (np.log([f for f, _ in groups]) - low) / (high - low)
    texts = _apart(places)
    leaders = [np.full_like(places, 1.0), np.full_like(places, 1.02), np.full_like(places, np.nan)]
    heights = np.column_stack([places, texts, places])
    options = {"transform": ax.transAxes, "clip_on": False, "color": natural, "lw": 0.8}
    curve(ax, "leaders", np.column_stack(leaders).ravel(), heights.ravel(), **options)
    for (f, names), height in zip(groups, texts, strict=True):
        note(ax, f"name at {f:.3f}", ", ".join(names), 1.025, height, va="center")
    label_axes(ax, _SPEED_LABEL, "frequency met (Hz)")
    ax.set(xlim=(speeds[0], speeds[-1]), ylim=between)
    return ax


def _apart(places: np.ndarray) -> np.ndarray:
    """Return where to write at ascending places, so that no text covers the one below it."""
    result: list[float] = []
    for place in places:
        result.append(max(place, result[-1] + _NAMES_APART) if result else place)
    return np.array(result)


def speeds_in_step(
    speeds: Mapping[str, Sequence[float]],
    now: float,
    between: tuple[float, float],
    ax: Axes | None = None,
) -> Axes:
    """Mark the speeds at which something keeps step with the deck, and the present speed.

    Parameters
    ----------
    speeds : mapping of sequence of float
        m/s, by what keeps step; a line for each.
    now : float
        Present speed, m/s.
    between : (float, float)
        Ends of the axis, m/s.
    ax : Axes, optional
    """
    ax = axes_or_new(ax, 1.0)
    colours = (DECK_COLOUR, *RUN_COLOURS[1:])
    for (name, values), colour, dashes in zip(speeds.items(), colours, ("-", "--"), strict=False):
        x = np.repeat(np.asarray(values, dtype=float), 3)
        heights = np.tile([0.0, 0.7, np.nan], len(values))
        curve(ax, name, x, heights, label=name, color=colour, ls=dashes, lw=2.0)
        for i, value in enumerate(values):
            inside = between[0] <= value <= between[1]
            text = f"{value:.1f}" if inside else ""
            options = {"ha": "center", "va": "bottom", "color": colour, "data_x": True}
            note(ax, f"{name} {i}", text, value if inside else between[0], 0.72, **options)
    curve(ax, "now", [now], [0.2], label=_HERE, **_DOT)
    label_axes(ax, _SPEED_LABEL)
    ax.set(xlim=between, ylim=(0.0, 1.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax
