"""The largest response of a deck to trains over speeds, a line a train."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ..decks import Deck
from ..errors import InputError, choice
from ..studies.resonance import first_vertical_mode
from .drawing import axes_or_new, curve, label_axes, note
from .maps import at_place, label_of, scale_of, speed_axis
from .style import GREY, RUN_COLOURS, literal

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["envelope"]

_SPEED_LABEL = "speed (m/s)"
_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1)))
_GROUND = {"fc": "white", "ec": "none", "pad": 1.5, "alpha": 0.85}
_FEW = 3
"""Trains up to which each has its own signature and static line; of more only the worst has."""


def envelope(
    dataset: xr.Dataset,
    quantity: str,
    x: float | None = None,
    ax: Axes | None = None,
    limit: float | None = None,
    deck: Deck | None = None,
    limit_name: str = "limit",
) -> Axes:
    """Plot the largest magnitude of a quantity over the speed, a line for each train.

    The worst train and its speed are named in the picture. Where the data have them, the static
    value is dashed, and the signature (residual influence line) of the acceleration is thin; of
    more than three trains only that of the worst is shown. The static value of an acceleration is
    zero.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `speed_envelope` gives it: over ``train`` and ``speed``, in SI units.
    quantity : str
        One of its variables.
    x : float, optional
        m; the nearest place of the data, default the first.
    ax : Axes, optional
    limit : float, optional
        For a horizontal line, SI.
    deck : Deck, optional
        Whose first vertical mode marks the resonance speeds of the worst train.
    limit_name : str
        What the line of the limit is called.

    Raises
    ------
    InputError
        An unknown quantity, data that are not over speed and train, or without a number.
    """
    values, words = _over_speed(dataset, quantity, x)
    speeds, names = dataset.speed.values, [str(name) for name in dataset.train.values]
    factor, unit = scale_of(dataset, quantity)
    ax = axes_or_new(ax, 4.0)
    worst, place = np.unravel_index(np.nanargmax(values), values.shape)
    shown = range(len(names)) if len(names) <= _FEW else [int(worst)]
    for i, name in enumerate(names):
        line = {
            "color": RUN_COLOURS[i % len(RUN_COLOURS)],
            "ls": _DASHES[i // len(RUN_COLOURS) % 3],
        }
        line |= {"lw": 2.6, "zorder": 2.5} if i == worst else {"lw": 1.2}
        curve(ax, f"train {i + 1}", speeds, factor * values[i], label=literal(name), **line)
    beside = [(f"{quantity}_static", "static", {"ls": "--", "lw": 1.0})]
    if quantity == "acceleration_z":
        beside.append(("signature", "signature", {"ls": "-", "lw": 0.8}))
    for variable, word, line in beside:
        if variable not in dataset:
            continue
        own = at_place(dataset, variable, x).transpose("train", "speed").values
        for rank, i in enumerate(shown):
            label = f"{word} of {literal(names[i])}" if len(shown) < len(names) else word
            colour = {"color": RUN_COLOURS[i % len(RUN_COLOURS)], "zorder": 1.8}
            label = label if rank == 0 else None
            curve(ax, f"{word} {i + 1}", speeds, factor * own[i], label=label, **line, **colour)
    if limit is not None:
        shown_limit = {"label": f"{limit_name}, {factor * limit:g} {unit}", "color": "k", "lw": 1.4}
        curve(ax, "limit", speeds[[0, -1]], [factor * limit] * 2, ls=(0, (8, 3)), **shown_limit)
    label_axes(ax, _SPEED_LABEL, f"{words} ({unit})", legend=False)
    top = max(factor * np.nanmax(values), factor * (limit or 0.0))
    ax.set(xlim=(speeds[0], speeds[-1]), ylim=(0.0, 1.22 * top))
    if deck is not None and "distance" in dataset:
        _mark_resonances(ax, deck, float(dataset.distance.values[worst]), speeds)
    _name_worst(ax, names[worst], speeds, place, factor * values[worst, place], unit)
    speed_axis(ax)
    ax.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize="small")
    return ax


def _over_speed(dataset: xr.Dataset, quantity: str, x: float | None) -> tuple[np.ndarray, str]:
    """Return a quantity over train and speed, and what it is called."""
    choice("quantity", quantity, [str(name) for name in dataset.data_vars])
    found = at_place(dataset, quantity, x)
    if set(found.dims) != {"train", "speed"}:
        allowed = f"is over {' and '.join(map(str, found.dims))}, not over train and speed"
        raise InputError("quantity", quantity, allowed, "rb.plots.map draws other studies")
    values = found.transpose("train", "speed").values
    if not np.isfinite(values).any():
        raise InputError("quantity", quantity, "has no numbers", "See dataset.message")
    return values, label_of(dataset, quantity)


def _name_worst(
    ax: Axes, name: str, speeds: np.ndarray, place: int, value: float, unit: str
) -> None:
    """Mark the largest value of all, and say whose it is and at which speed."""
    speed = float(speeds[place])
    curve(ax, "worst", [speed], [value], color="k", marker="o", ms=6, ls="", zorder=4)
    text = f"{literal(name)}: {value:.3g} {unit} at {speed:.3g} m/s, {3.6 * speed:.3g} km/h"
    share = (speed - speeds[0]) / max(speeds[-1] - speeds[0], 1e-9)
    side = "right" if share > 0.5 else "left"
    note(
        ax, "worst named", text, share, 0.985, ha=side, va="top", weight="bold", bbox=_GROUND,
        zorder=5,
    )  # fmt: skip


def _mark_resonances(ax: Axes, deck: Deck, distance: float, speeds: np.ndarray) -> None:
    """Mark the speeds f d / i of the worst train."""
    mode = first_vertical_mode(deck)
    if mode is None or not np.isfinite(distance):
        return
    whole = float(deck.frequencies_hz[mode]) * distance
    for i in range(1, 6):
        speed = whole / i
        if not speeds[0] <= speed <= speeds[-1]:
            continue
        line = {"color": GREY, "ls": ":", "lw": 1.2, "zorder": 1.0}
        line["transform"] = ax.get_xaxis_transform()
        label = f"resonance, f₁ · {distance:g} m / i"
        first = not any(str(a.get_gid()).startswith("resonance") for a in ax.lines)
        curve(ax, f"resonance {i}", [speed] * 2, [0.0, 0.9], label=label if first else None, **line)
        words = {"data_x": True, "ha": "center", "va": "bottom", "color": GREY}
        note(ax, f"order {i}", f"i = {i}", speed, 0.9, **words)
