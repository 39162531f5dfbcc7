"""What a wheel rolls over, and natural frequencies on an axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..decks import Deck
from ..errors import InputError
from ..tracks import FadeIn, Notch, Track
from ..trains import AxleTrain, Train
from ..vehicles import Vehicle
from .drawing import ALONG, COMPARED, TIME, curve, finish, in_words, is_live, log_frequencies, look, note, one, rung, shade
from .style import second


def irregularity(
    track: Track,
    start: float = -40.0,
    stop: float = 60.0,
    lead_in: float | None = None,
    ax: Axes | None = None,
    deck: Deck | float | None = None,
    _quantity: str = "irregularity",
) -> Axes:
    """Plot vertical and lateral irregularity along the track, left and right rail apart where they differ.

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
    ax = one(ax)
    x = np.linspace(start, stop, 1201)
    if deck is not None:
        shade(ax, "deck", 0.0, getattr(deck, "length", deck), "deck")
    for direction in ("vertical", "lateral"):
        values = {}
        for side in ("left", "right"):
            rail = track.rail(direction, side)
            rail = rail if lead_in is None else FadeIn(rail, errors.number("lead_in", lead_in, least=0.0, unit="m"))
            values[side] = rail.value(x) if _quantity == "irregularity" else rail.slope(x)
        style = look(f"{_quantity}_{direction}")
        same = np.array_equal(values["left"], values["right"])
        for side, value in values.items():
            if side == "right" and same:
                continue
            label = direction if same else f"{direction}, {side} rail"
            colour = style.colour if side == "left" else second(style.colour)
            curve(ax, label, x, style.factor * value, label=label, color=colour, ls=style.line)
    word = "irregularity r" if _quantity == "irregularity" else "slope dr/dx"
    return finish(ax, ALONG, f"{word} ({look(f'{_quantity}_vertical').unit})")


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
    """Plot what a wheel's notch does over the wheel's own place, `start` to `stop` in m (Eq. 2 with its sign turned)."""
    ax = one(ax, 2.4)
    count = int(np.clip(40 * (stop - start) / notch.length, 2001, 400_001))
    x = np.linspace(start, stop, count)
    style = look("irregularity_vertical")
    curve(ax, "notch", x, style.factor * notch.value(x), color=style.colour, ls=style.line)
    return finish(ax, "place of the wheel from the bridge entrance (m)", "r (mm)")


def wheels_on_track(train: Train | AxleTrain, track: Track, position: float = 18.0, ax: Axes | None = None) -> Axes:
    """Mark where the left wheels stand on the vertical irregularity when the first axle is at `position` (m)."""
    ax = one(ax)
    low, high = sorted(ax.get_xlim()) if ax.lines else (-np.inf, np.inf)
    style = look("force_z")
    wheels = [w for w in train.wheels if w.side == "left" and low <= position - w.delay <= high]
    x = position - np.array([w.delay for w in wheels])
    r = look("irregularity_vertical").factor * track.rail("vertical", "left").value(x)
    curve(ax, "wheels", x, r, label="wheels of the train", color=style.colour, ls="", marker="o", ms=6, zorder=4)
    return finish(ax, ALONG, "irregularity r (mm)")


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
    ax = one(ax)
    time = np.linspace(0.0, stop, 801)
    style = look("irregularity_vertical")
    known = {(w.car, w.number): w for w in train.wheels}
    for (car, number), colour in zip(wheels, (style.colour, *COMPARED), strict=False):
        if (car, number) not in known:
            raise InputError("wheels", (car, number), "no such (car, wheel) in this train", "Both are counted from 1")
        wheel = known[car, number]
        r = track.rail("vertical", wheel.side).value(speed * time - wheel.delay)
        dashes = "-" if colour == style.colour else "--"
        curve(ax, f"{car} {number}", time, style.factor * r, label=f"car {car}, wheel {number}", color=colour, ls=dashes)
    return finish(ax, TIME, "r under the wheel (mm)")


def frequencies(
    source: Vehicle | Deck, mark: Mapping[str, float] | None = None, ax: Axes | None = None, most: float | None = None
) -> Axes:
    """Plot natural frequencies as ticks on a frequency axis, with marks such as a forcing frequency.

    Parameters
    ----------
    source : Vehicle or Deck
    mark : mapping of float, optional
        Frequencies to mark, Hz, by name.
    ax : Axes, optional
    most : float, optional
        End of the axis, Hz.
    """
    ax = one(ax, 2.4)
    values, names = (source.frequencies_hz, source.mode_names) if isinstance(source, Deck) else _named_frequencies(source.modes())
    most = most or 1.15 * float(values[-1])
    groups: list[tuple[float, list[str]]] = []
    for f, name in zip(values, names, strict=True):
        if f <= most and groups and f < 1.06 * groups[-1][0]:
            groups[-1][1].append(name)
        elif f <= most:
            groups.append((f, [name]))
    shown = values[values <= most]
    style = look("displacement_z")
    curve(ax, "natural", np.repeat(shown, 3), np.tile([0.0, 1.0, np.nan], len(shown)), color=style.colour)
    for i, (f, near) in enumerate(groups):
        text = " \n".join(list(dict.fromkeys(near))[:2]) + " "
        note(ax, f"name {i}", text, f, 0.96, data_x=True, rotation=90, ha="right", size=8.5, color="k")
    force = look("force_z")
    for name, f in (mark or {}).items():
        curve(ax, f"mark {name}", [f, f], [0.0, 1.0], label=f"{name} {f:.4g} Hz", color=force.colour, lw=2.5)
    low, high = 0.75 * min([float(values[0]), *(mark or {}).values()]), max([most, *(1.1 * f for f in (mark or {}).values())])
    log_frequencies(ax)
    finish(ax, "frequency (Hz)")
    ax.set(xlim=(1 / rung(1 / low), rung(high)) if is_live(ax) else (low, high), ylim=(0.0, 1.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def _named_frequencies(modes) -> tuple[np.ndarray, tuple[str, ...]]:
    """Names without front and rear, which mix freely; y and z in words."""
    return modes.frequencies_hz, tuple(in_words(" ".join(name.split()[-2:])) for name in modes.names)
