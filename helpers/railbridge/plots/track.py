"""What a wheel rolls over, and natural frequencies on an axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..decks import Deck
from ..errors import InputError
from ..tracks import FadeIn, Level, Notch, Track
from ..trains import AxleTrain, Train
from ..vehicles import Vehicle
from .drawing import (
    PLACE_LABEL,
    TIME_LABEL,
    axes_or_new,
    curve,
    label_axes,
    log_frequencies,
    note,
    quantity_curve,
    reuses_artists,
    round_up,
    shade,
)
from .style import RUN_COLOURS, literal, mode_in_words, other_shade, style_of

__all__ = [
    "frequencies", "grouped_frequencies", "irregularity", "notch", "slope", "wheel_paths",
    "wheels_on_track",
]  # fmt: skip


def irregularity(
    track: Track,
    start: float = -40.0,
    stop: float = 60.0,
    lead_in: float | None = None,
    ax: Axes | None = None,
    deck: Deck | float | None = None,
    _quantity: str = "irregularity",
) -> Axes:
    """Plot vertical and lateral irregularity along the track.

    Left and right rail apart where they differ; no lateral curve where all is level sideways.

    Parameters
    ----------
    track : Track
    start, stop : float
        m from the bridge entrance.
    lead_in : float, optional
        Run-up, m: the irregularity fades in from ``-lead_in`` on.
    ax : Axes, optional
    deck : Deck or float, optional
        Deck, or its length (m), to shade.

    Returns
    -------
    Axes
    """
    ax = axes_or_new(ax)
    if lead_in is not None:
        lead_in = errors.number("lead_in", lead_in, least=0.0, unit="m")
    x = np.linspace(start, stop, 1201)
    if deck is not None:
        shade(ax, "deck", 0.0, getattr(deck, "length", deck), "deck")
    for direction in ("vertical", "lateral"):
        if direction == "lateral" and _is_level(track, direction) and not reuses_artists(ax):
            continue
        quantity, values = f"{_quantity}_{direction}", {}
        for side in ("left", "right"):
            rail = track.rail(direction, side)
            rail = rail if lead_in is None else FadeIn(rail, lead_in)
            values[side] = rail.value(x) if _quantity == "irregularity" else rail.slope(x)
        alike = np.array_equal(values["left"], values["right"])
        for side in ("left",) if alike else ("left", "right"):
            label = direction if alike else f"{direction}, {side} rail"
            line = {"name": label, "label": label}
            if side == "right":
                line["color"] = other_shade(style_of(quantity).colour)
            quantity_curve(ax, quantity, x, values[side], **line)
    word = "irregularity r" if _quantity == "irregularity" else "slope dr/dx"
    return label_axes(ax, PLACE_LABEL, f"{word} ({style_of(quantity).unit})")


def _is_level(track: Track, direction: str) -> bool:
    return all(isinstance(track.rail(direction, side), Level) for side in ("left", "right"))


def slope(
    track: Track,
    start: float = -40.0,
    stop: float = 60.0,
    lead_in: float | None = None,
    ax: Axes | None = None,
    deck: Deck | float | None = None,
) -> Axes:
    """Plot the slope of the irregularity along the track, in mm/m; parameters as `irregularity`."""
    return irregularity(track, start, stop, lead_in, ax, deck, _quantity="slope")


def notch(notch: Notch, start: float, stop: float, ax: Axes | None = None) -> Axes:
    """Plot what a wheel's notch does over the wheel's own place (Eq. 2 with its sign turned).

    From `start` to `stop`, m.
    """
    ax = axes_or_new(ax, 2.4)
    count = int(np.clip(40 * (stop - start) / notch.length, 2001, 400_001))
    x = np.linspace(start, stop, count)
    quantity_curve(ax, "irregularity_vertical", x, notch.value(x), name="notch")
    return label_axes(ax, "place of the wheel from the bridge entrance (m)", "r (mm)")


def wheels_on_track(
    train: Train | AxleTrain, track: Track, position: float = 18.0, ax: Axes | None = None
) -> Axes:
    """Mark where the left wheels stand on the vertical irregularity.

    The train's first axle is at `position`, m from the bridge entrance.
    """
    ax = axes_or_new(ax)
    low, high = sorted(ax.get_xlim()) if ax.lines else (-np.inf, np.inf)
    x = np.array([position - wheel.delay for wheel in train.wheels if wheel.side == "left"])
    x = x[(low <= x) & (x <= high)]
    r = track.rail("vertical", "left").value(x)
    dots = {"color": style_of("force_z").colour, "ls": "", "marker": "o", "ms": 6, "zorder": 4}
    line = {"name": "wheels", "label": "wheels of the train"}
    quantity_curve(ax, "irregularity_vertical", x, r, **line, **dots)
    return label_axes(ax, PLACE_LABEL, "irregularity r (mm)")


def wheel_paths(
    train: Train,
    track: Track,
    speed: float,
    wheels: Sequence[tuple[int, int]] = ((1, 1), (1, 5)),
    stop: float = 4.0,
    ax: Axes | None = None,
) -> Axes:
    """Plot the vertical irregularity that some wheels meet over time: the same wave, later.

    Parameters
    ----------
    train : Train
    track : Track
    speed : float
        m/s.
    wheels : sequence of (car, wheel)
        Numbered from 1.
    stop : float
        End of the time axis, s.
    ax : Axes, optional
    """
    known = {(wheel.car, wheel.number): wheel for wheel in train.wheels}
    for pair in wheels:
        if tuple(pair) not in known:
            allowed = "no such (car, wheel) in this train"
            raise InputError("wheels", pair, allowed, "Both are counted from 1")
    ax = axes_or_new(ax)
    time, own = np.linspace(0.0, stop, 801), style_of("irregularity_vertical").colour
    dashes = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)))
    for i, ((car, number), colour) in enumerate(zip(wheels, (own, *RUN_COLOURS), strict=False)):
        wheel = known[car, number]
        r = track.rail("vertical", wheel.side).value(speed * time - wheel.delay)
        line = {"color": colour, "ls": dashes[i % len(dashes)]}
        line |= {"name": f"{car} {number}", "label": f"car {car}, wheel {number}"}
        quantity_curve(ax, "irregularity_vertical", time, r, **line)
    return label_axes(ax, TIME_LABEL, "r under the wheel (mm)")


def frequencies(
    source: Vehicle | Deck,
    mark: Mapping[str, float] | None = None,
    ax: Axes | None = None,
    most: float | None = None,
    least: float | None = None,
) -> Axes:
    """Plot natural frequencies as ticks on an axis, with marks such as a forcing frequency.

    Parameters
    ----------
    source : Vehicle or Deck
    mark : mapping of float, optional
        Frequencies to mark, Hz, by name.
    ax : Axes, optional
    most, least : float, optional
        Ends of the axis, Hz.
    """
    ax, marks = axes_or_new(ax, 2.4), dict(mark or {})
    values, _ = _named_frequencies(source)
    most = most or 1.15 * float(values[-1])
    below = values[values <= most]
    heights = np.tile([0.0, 1.0, np.nan], len(below))
    curve(ax, "natural", np.repeat(below, 3), heights, color=style_of("displacement_z").colour)
    upright = {"rotation": 90, "ha": "right", "size": 8.5, "color": "k"}
    for i, (f, near) in enumerate(grouped_frequencies(source, most)):
        text = " \n".join(near[:2]) + " "
        note(ax, f"name {i}", text, f, 0.96, data_x=True, **upright)
    for name, f in marks.items():
        line = {"color": style_of("force_z").colour, "lw": 2.5, "label": f"{name} {f:.4g} Hz"}
        curve(ax, f"line at {name}", [f, f], [0.0, 1.0], **line)
    low = least or 0.75 * min([float(values[0]), *marks.values()])
    high = max([most, *(1.1 * f for f in marks.values())])
    if reuses_artists(ax):
        low, high = least or 1 / round_up(1 / low), round_up(high)
    log_frequencies(ax)
    label_axes(ax, "frequency (Hz)")
    ax.set(xlim=(low, high), ylim=(0.0, 1.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def grouped_frequencies(
    source: Vehicle | Deck, most: float = np.inf
) -> list[tuple[float, list[str]]]:
    """Return natural frequencies up to `most` (Hz), ascending, those that lie close as one.

    Each with its names, of which none stands twice.
    """
    groups: list[tuple[float, list[str]]] = []
    for f, name in zip(*_named_frequencies(source), strict=True):
        if groups and f < 1.06 * groups[-1][0] and f <= most:
            groups[-1][1].append(name)
        elif f <= most:
            groups.append((f, [name]))
    return [(f, list(dict.fromkeys(names))) for f, names in groups]


def _named_frequencies(source: Vehicle | Deck) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return natural frequencies, ascending, and their names.

    Those of a vehicle in words, without front and rear, which mix freely.
    """
    if isinstance(source, Deck):
        return source.frequencies_hz, tuple(map(literal, source.mode_names))
    modes = source.modes()
    names = (" ".join(name.split()[-2:]) for name in modes.names)
    return modes.frequencies_hz, tuple(literal(mode_in_words(name)) for name in names)
