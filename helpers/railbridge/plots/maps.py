"""Maps: a study over two things that vary, as coloured areas, and what explains them as lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection

from ..decks import Deck
from ..errors import InputError, choice
from ..studies.resonance import first_vertical_mode
from ..vehicles import Vehicle
from .drawing import axes_or_new, curve, label_axes, note
from .style import QUANTITY_STYLES

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["at_place", "label_of", "map", "mark_point", "scale_of", "speed_axis"]

_MAGNITUDES, _SIGNED = "cividis", "PuOr_r"
"""Colours of what has no sign, and of what has; both for all kinds of colour vision."""
_LEVELS = 12
_ABOVE_GROUND = 1.2
"""Of what is filled: above the ground of an axes, which a panel draws as one artist of many."""
_CLIPPED = 2.0
"""Per cent of the points that may lie beyond either end of the colours."""
_KM_H = 3.6
_GROUND = {"fc": "white", "ec": "none", "pad": 1.0, "alpha": 0.8}
_WORDS = {"speed": "speed", "wavelength": "wavelength", "deck_mass": "mass of the deck"}
_UNITS = {"kg/m": ("t/m", 1e-3), "N": ("kN", 1e-3), "N m": ("kN m", 1e-3), "m/s2": ("m/s²", 1.0)}


# ---- what data sets say of themselves


def at_place(dataset: xr.Dataset, quantity: str, x: float | None) -> xr.DataArray:
    """Return a variable at the place nearest to x (m), the first one if x is not given."""
    found = dataset[quantity]
    if "x" not in found.dims:
        return found
    return found.isel(x=0) if x is None else found.sel(x=x, method="nearest")


def scale_of(dataset: xr.Dataset, quantity: str) -> tuple[float, str]:
    """Return the factor from the data's unit to that of pictures, and this unit."""
    unit = str(dataset[quantity].attrs.get("units", ""))
    for name, style in QUANTITY_STYLES.items():
        if unit != "%" and quantity.startswith(name) and not quantity.endswith("_factor"):
            return style.factor, style.unit
    shown, factor = _UNITS.get(unit, (unit, 1.0))
    return factor, shown or "-"


def label_of(dataset: xr.Dataset, quantity: str) -> str:
    """Return what a variable is called."""
    return str(dataset[quantity].attrs.get("long_name", quantity.replace("_", " ")))


def speed_axis(ax: Axes, along: str = "x") -> None:
    """Add a second axis in km/h beside one in m/s; once."""
    if any(child.get_label() == "km/h" for child in ax.child_axes):
        return
    both = (lambda v: _KM_H * v, lambda v: v / _KM_H)
    second = ax.secondary_xaxis("top", both) if along == "x" else ax.secondary_yaxis("right", both)
    second.set_label("km/h")
    second.tick_params(labelsize=8)
    (second.set_xlabel if along == "x" else second.set_ylabel)("speed (km/h)", fontsize=8.5)


# ---- the map


def map(
    dataset: xr.Dataset,
    quantity: str,
    ax: Axes | None = None,
    *,
    x: float | None = None,
    over: Sequence[str] | None = None,
    limits: Sequence[float] = (),
    between: tuple[float, float] | None = None,
    deck: Deck | None = None,
    vehicle: Vehicle | None = None,
    resonances: bool = True,
    filter_zeros: bool = False,
    paper: bool = True,
    title: str | None = None,
) -> Axes:
    """Plot a study over two things that vary as a map, filled between contours.

    Over speed and wavelength the lines of resonance are drawn: waves meet the deck at its first
    frequency where speed = f₁ · wavelength, and a car at its bounce where speed = f · wavelength.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `sweep` gives it, or `study` opens it, in SI units.
    quantity : str
        One of its variables.
    ax : Axes, optional
    x : float, optional
        m; the nearest place of the data, default the first.
    over : two of str, optional
        What varies along and upwards; default in the order of the data.
    limits : sequence of float
        Values that are marked by a black contour, in SI units.
    between : (float, float), optional
        Ends of the colours, SI; default nearly all of the data.
    deck, vehicle : optional
        For the lines of resonance, where the data do not say the frequencies themselves
        (attributes ``deck_frequency_hz`` and ``car_frequency_hz``).
    resonances : bool
    filter_zeros : bool
        Whether the wavelengths are drawn that lift no car as a whole (attribute
        ``filter_zeros``).
    paper : bool
        Whether the paper's case is marked (attributes ``paper_speed``, ``paper_wavelength``).
    title : str, optional
        Default none.

    Raises
    ------
    InputError
        An unknown quantity, or one that is not over two things.
    """
    choice("quantity", quantity, [str(name) for name in dataset.data_vars])
    found = at_place(dataset, quantity, x).squeeze()
    names = [str(name) for name in (over or found.dims)]
    if len(names) != 2 or set(names) != set(map_dims(found)):
        allowed = f"is over {', '.join(map_dims(found)) or 'nothing'}; a map needs two"
        raise InputError("quantity", quantity, allowed, "Choose values first: dataset.sel(...)")
    values = found.transpose(names[1], names[0]).values
    if not np.isfinite(values).any():
        raise InputError("quantity", quantity, "has no numbers", "See dataset.message")
    ax = axes_or_new(ax, 4.4)
    factor, unit = scale_of(dataset, quantity)
    along, up = (_coordinate(dataset, name) for name in names)
    _fill(ax, along[0], up[0], factor * values, between and [factor * b for b in between],
          f"{label_of(dataset, quantity)} ({unit})")  # fmt: skip
    for value in limits:
        lines = ax.contour(along[0], up[0], factor * values, [factor * value], colors="k",
                           linewidths=1.4)  # fmt: skip
        ax.clabel(lines, fmt=f"{factor * value:g} {unit}".removesuffix(" -"), fontsize=8)
    for axis, (own, label) in zip("xy", (along, up), strict=True):
        if _is_geometric(own):
            getattr(ax, f"set_{axis}scale")("log")
            getattr(ax, f"{axis}axis").set_major_formatter("{x:g}")
            getattr(ax, f"{axis}axis").set_minor_formatter("")
            ticks = [d * 10.0**p for p in range(-2, 5) for d in (1, 2, 5)]
            getattr(ax, f"set_{axis}ticks")([t for t in ticks if own[0] <= t <= own[-1]])
        getattr(ax, f"set_{axis}lim")(own[0], own[-1])
        getattr(ax, f"set_{axis}label")(label)
    if set(names) == {"speed", "wavelength"}:
        if resonances:
            _draw_resonances(ax, dataset, deck, vehicle, names, along[0], up[0])
        if filter_zeros:
            _draw_zeros(ax, dataset, names, along[0], up[0])
        if paper and "paper_speed" in dataset.attrs:
            place = [float(dataset.attrs[f"paper_{name}"]) for name in names]
            mark_point(ax, "paper", *place, label="paper's case", marker="*", ms=13)
    if "speed" in names:
        speed_axis(ax, "x" if names[0] == "speed" else "y")
    if title is not None:
        ax.set_title(title, loc="left", fontsize="medium")
    return label_axes(ax, legend=False, fit=False)


def map_dims(found: xr.DataArray) -> list[str]:
    """Return the names of what a variable is over."""
    return [str(name) for name in found.dims]


def mark_point(ax: Axes, name: str, x: float, y: float, *, label: str = "", **look: Any) -> None:
    """Put a mark on a map, or move it, with its name beside it."""
    look = {"marker": "o", "ms": 9, "ls": "", "mfc": "white", "mec": "k", "mew": 1.3} | look
    curve(ax, name, [x], [y], zorder=6, **look)
    if label:
        ax.annotate(label, (x, y), (9, -3), textcoords="offset points", size=8.5, va="top",
                    bbox=_GROUND, zorder=5)  # fmt: skip


def _coordinate(dataset: xr.Dataset, name: str) -> tuple[np.ndarray, str]:
    """Return the values of what varies as drawn, and its label with unit."""
    own, attributes = dataset[name].values, dataset[name].attrs
    if own.dtype.kind not in "fiu":
        raise InputError(name, None, "is no number", "Choose one: dataset.sel(...)")
    unit, factor = _UNITS.get(str(attributes.get("units", "")), (attributes.get("units", ""), 1.0))
    words = _WORDS.get(name, str(attributes.get("long_name") or name.replace("_", " ")))
    return factor * own.astype(float), f"{words} ({unit})" if unit else words


def _is_geometric(values: np.ndarray) -> bool:
    """Return whether values ascend by about equal factors, not by equal steps."""
    if len(values) < 3 or values[0] <= 0.0:
        return False
    steps, factors = np.diff(values), np.diff(np.log(values))
    return bool(np.ptp(factors) / factors.mean() < np.ptp(steps) / steps.mean())


def _fill(
    ax: Axes, along: np.ndarray, up: np.ndarray, values: np.ndarray,
    between: Sequence[float] | None, label: str,
) -> None:  # fmt: skip
    """Fill a map between contours, with a bar of colours."""
    from matplotlib.ticker import MaxNLocator

    finite = values[np.isfinite(values)]
    low, high = between or np.percentile(finite, [_CLIPPED, 100 - _CLIPPED])
    signed = low < 0.0 < high and min(-low, high) > 0.02 * max(-low, high)
    if signed:
        high = max(-low, high)
        low = -high
    levels = MaxNLocator(_LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    if len(levels) < 2:
        levels = np.array([low - 0.5, low + 0.5])
    colours = _SIGNED if signed else _MAGNITUDES
    beyond = finite.min() < levels[0], finite.max() > levels[-1]
    extend = {(False, False): "neither", (True, False): "min", (False, True): "max"}
    look = {"cmap": colours, "extend": extend.get(beyond, "both"), "zorder": _ABOVE_GROUND}
    areas = ax.contourf(along, up, values, levels, **look)
    bar = ax.figure.colorbar(areas, ax=ax, pad=0.01, fraction=0.05)
    for part in bar.ax.get_children():
        if isinstance(part, Collection):
            part.set_zorder(_ABOVE_GROUND)
    long = len(label) > 46
    bar.set_label(_broken(label) if long else label, fontsize=8.5)
    bar.ax.tick_params(labelsize=8)


def _broken(text: str) -> str:
    """Return a long text in two lines of about the same length."""
    blanks = [i for i, letter in enumerate(text) if letter == " "]
    middle = min(blanks, key=lambda i: abs(i - len(text) / 2))
    return f"{text[:middle]}\n{text[middle + 1 :]}"


def _draw_resonances(
    ax: Axes, dataset: xr.Dataset, deck: Deck | None, vehicle: Vehicle | None,
    names: Sequence[str], along: np.ndarray, up: np.ndarray,
) -> None:  # fmt: skip
    """Draw speed = frequency x wavelength, for the deck and for the car."""
    lines: dict[str, tuple[float, str]] = {}
    deck_f = dataset.attrs.get("deck_frequency_hz")
    if deck is not None and (mode := first_vertical_mode(deck)) is not None:
        deck_f = deck.frequencies_hz[mode]
    car_f = dataset.attrs.get("car_frequency_hz")
    if vehicle is not None:
        modes = vehicle.modes()
        car_f = dict(zip(modes.names, modes.frequencies_hz, strict=True)).get("car z")
    for name, f, dashes in ("deck", deck_f, "-"), ("car", car_f, "--"):
        if f is not None:
            lines[name] = float(f), dashes
    speeds, waves = (along, up) if names[0] == "speed" else (up, along)
    for name, (f, dashes) in lines.items():
        wave = np.geomspace(max(waves[0], 1e-6), waves[-1], 200)
        inside = (f * wave >= speeds[0]) & (f * wave <= speeds[-1])
        if not inside.any():
            continue
        wave = wave[inside]
        place = (f * wave, wave) if names[0] == "speed" else (wave, f * wave)
        for suffix, look in (" below", {"color": "w", "lw": 3.4}), ("", {"color": "k", "lw": 1.3}):
            ls = {} if suffix else {"ls": dashes}
            curve(ax, f"resonance of the {name}{suffix}", *place, zorder=3, **look, **ls)
        # Written below and to the right of a point of the line, which rises.
        speed, own = (place[0], place[1]) if names[0] == "speed" else (place[1], place[0])
        at = int(np.argmin(np.abs(speed - (0.45 * speeds[0] + 0.55 * speeds[-1]))))
        point = (speed[at], own[at]) if names[0] == "speed" else (own[at], speed[at])
        beside = {"xytext": (8, -3), "textcoords": "offset points", "va": "top"}
        ax.annotate(f"{name}, {f:.3g} Hz", point, size=8.5, bbox=_GROUND, zorder=5, **beside)


def _draw_zeros(
    ax: Axes, dataset: xr.Dataset, names: Sequence[str], along: np.ndarray, up: np.ndarray
) -> None:
    """Draw the wavelengths that lift no car as a whole."""
    waves = along if names[0] == "wavelength" else up
    zeros = np.atleast_1d(dataset.attrs.get("filter_zeros", []))
    for i, wave in enumerate(z for z in zeros if waves[0] < z < waves[-1]):
        ends = [0.0, 1.0]
        up_to = ([wave, wave], ends) if names[0] == "wavelength" else (ends, [wave, wave])
        line = {"color": "k", "lw": 0.8, "ls": ":", "zorder": 2.5}
        own = ax.get_xaxis_transform() if names[0] == "wavelength" else ax.get_yaxis_transform()
        curve(ax, f"zero {i}", *up_to, transform=own, **line)
    note(ax, "zeros", "dotted: no bounce", 0.985, 0.03, ha="right", va="bottom", bbox=_GROUND)
