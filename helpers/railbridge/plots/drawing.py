"""How quantities look: one name, unit, colour and line style for each, in the whole suite.

Colour says what a curve is (force, displacement, ...), line style which way it points (vertical solid, lateral dashed,
about the track's axis dash-dotted). The colours can be told apart with the common kinds of colour blindness.

An axes marked live (see `live`) moves the artists it already has instead of drawing new ones, which is what a panel needs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ..errors import choice

__all__ = ["COMPARED", "GREY", "LOOKS", "Look", "curve", "finish", "grid", "hold", "live", "mark", "note", "one", "shade"]

MOTIONS = {"y": "sway", "z": "bounce", "roll": "roll", "pitch": "pitch", "yaw": "yaw"}
"""Freedoms of a body in words."""
WIDTH = 9.0  # inch, 900 px in a notebook
GREY = "#8a8a8a"
PALE = "#d9d9d9"
SHADE = "#e3e9ef"

_FORCE, _COUPLE, _MOTION, _SPEED, _ACCELERATION = "#D55E00", "#882255", "#0072B2", "#56B4E9", "#009E73"
_SECTION, _REACTION, _TRACK = "#AA4499", "#B07800", "#000000"
_VERTICAL, _LATERAL, _ROLL = "-", "--", "-."

COMPARED = ("#0072B2", "#D55E00", "#009E73", "#882255", "#B07800", "#000000")
"""Colours of runs that stand side by side in one axes."""

TIME = "time since the first axle entered (s)"
ALONG = "x from the bridge entrance (m)"


class Look(NamedTuple):
    """How a quantity is shown: words, unit shown, factor from SI to it, colour, line style."""

    words: str
    unit: str
    factor: float
    colour: str
    line: str

    @property
    def label(self) -> str:
        """Axis label with unit."""
        return f"{self.words} ({self.unit})"


LOOKS = {
    "irregularity_vertical": Look("vertical irregularity", "mm", 1e3, _TRACK, _VERTICAL),
    "irregularity_lateral": Look("lateral irregularity", "mm", 1e3, _TRACK, _LATERAL),
    "slope_vertical": Look("vertical slope", "mm/m", 1e3, GREY, _VERTICAL),
    "slope_lateral": Look("lateral slope", "mm/m", 1e3, GREY, _LATERAL),
    "force_y": Look("lateral force", "kN", 1e-3, _FORCE, _LATERAL),
    "force_z": Look("vertical force", "kN", 1e-3, _FORCE, _VERTICAL),
    "moment_x": Look("roll moment", "kN m", 1e-3, _COUPLE, _ROLL),
    "moment_y": Look("pitch moment", "kN m", 1e-3, _COUPLE, _VERTICAL),
    "moment_z": Look("yaw moment", "kN m", 1e-3, _COUPLE, _LATERAL),
    "displacement_y": Look("lateral displacement", "mm", 1e3, _MOTION, _LATERAL),
    "displacement_z": Look("vertical displacement", "mm", 1e3, _MOTION, _VERTICAL),
    "rotation_x": Look("twist", "mrad", 1e3, _MOTION, _ROLL),
    "velocity_y": Look("lateral velocity", "mm/s", 1e3, _SPEED, _LATERAL),
    "velocity_z": Look("vertical velocity", "mm/s", 1e3, _SPEED, _VERTICAL),
    "velocity_roll": Look("twist velocity", "mrad/s", 1e3, _SPEED, _ROLL),
    "acceleration_y": Look("lateral acceleration", "m/s²", 1.0, _ACCELERATION, _LATERAL),
    "acceleration_z": Look("vertical acceleration", "m/s²", 1.0, _ACCELERATION, _VERTICAL),
    "acceleration_roll": Look("twist acceleration", "rad/s²", 1.0, _ACCELERATION, _ROLL),
    "moment_vertical": Look("vertical bending moment", "kN m", 1e-3, _SECTION, _VERTICAL),
    "moment_lateral": Look("lateral bending moment", "kN m", 1e-3, _SECTION, _LATERAL),
    "torsion": Look("torsion", "kN m", 1e-3, _SECTION, _ROLL),
    "shear_vertical": Look("vertical shear", "kN", 1e-3, _SECTION, (0, (6, 1))),
    "shear_lateral": Look("lateral shear", "kN", 1e-3, _SECTION, (0, (2, 1))),
    "reaction_y": Look("lateral reaction", "kN", 1e-3, _REACTION, _LATERAL),
    "reaction_z": Look("vertical reaction", "kN", 1e-3, _REACTION, _VERTICAL),
    "reaction_x": Look("reaction moment about x", "kN m", 1e-3, _REACTION, _ROLL),
    "damping": Look("damping ratio", "%", 100.0, _ACCELERATION, _VERTICAL),
}
"""One look for each quantity; names as in the results."""

_RUNGS = (1.0, 1.5, 2.5, 4.0, 6.0, 10.0)
_FINE_RUNGS = (1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.8, 3.4, 4.0, 4.8, 5.6, 6.8, 8.0, 10.0)
"""Ends of a live axis, times a power of ten: they move seldom, and the same case has the same ones. Fine ones along x."""


def one(ax: Axes | None, height: float = 3.0) -> Axes:
    """Return the given axes, or that of a new figure of notebook width."""
    return ax if ax is not None else grid(None, 1, 1, height)[0]


def grid(axes: Sequence[Axes] | None, rows: int, columns: int, height: float, **options) -> np.ndarray:
    """Return the given axes as a flat array, or those of a new figure; `height` in inches, options as ``plt.subplots``."""
    if axes is not None:
        return np.ravel(np.asarray(axes, dtype=object))
    import matplotlib.pyplot as plt

    figure, made = plt.subplots(rows, columns, figsize=(WIDTH, height), layout="constrained", squeeze=False, **options)
    return np.ravel(made)


def live(figure: Figure) -> None:
    """Let every axes of a figure move its artists from now on, and end at round numbers that seldom change."""
    for ax in figure.axes:
        ax.set_gid("live")
        for axis, scale in (("x", ax.get_xscale()), ("y", ax.get_yscale())):
            if scale == "linear" and getattr(ax, f"get_{axis}ticks")().size:
                ax.locator_params(axis=axis, nbins=6)  # text is what takes time to draw


def hold(figure: Figure, held: bool) -> None:
    """Let a live figure keep its limits while the data stay within them and are not lost in them, or let go again."""
    for ax in figure.axes:
        ax.set_gid("live, held" if held else "live")


def is_live(ax: Axes) -> bool:
    """Return whether an axes moves its artists instead of drawing new ones."""
    return ax.get_gid() in ("live", "live, held")


def found(ax: Axes, name: str):
    """Return the artist of a live axes that bears a name, or None."""
    if not is_live(ax):
        return None
    return next((a for a in ax.get_children() if a.get_gid() == name), None)


def in_words(mode: str) -> str:
    """Return the name of a vehicle's mode in words: ``car z`` is the car's bounce."""
    return " ".join(MOTIONS.get(part, part) for part in mode.split())


def look(quantity: str) -> Look:
    """Return a quantity's look.

    Raises
    ------
    InputError
        An unknown quantity; the near one is suggested.
    """
    return LOOKS[choice("quantity", quantity, LOOKS)]


def curve(ax: Axes, name: str, x, y, *, label: str | None = None, zorder: float = 2.0, **line) -> None:
    """Draw a curve, or move the one of that name in a live axes."""
    label = f"_{name}" if label is None else label
    artist = found(ax, name)
    if artist is None:
        (artist,) = ax.plot(x, y, label=label, zorder=zorder, **{"lw": 1.5, **line})
        artist.set_gid(name)
    else:
        artist.set_data(x, y)
        artist.set_label(label)


def shade(ax: Axes, name: str, start: float, stop: float, label: str | None = None) -> None:
    """Shade a stretch of the horizontal axis."""
    artist = found(ax, name)
    if artist is None:
        artist = Rectangle((start, 0.0), stop - start, 1.0, transform=ax.get_xaxis_transform(), fc=SHADE, ec="none", zorder=0)
        artist.set_gid(name)
        ax.add_patch(artist)
    artist.set_x(start)
    artist.set_width(stop - start)
    artist.set_label(f"_{name}" if label is None else label)


def mark(ax: Axes, marks: Mapping[str, float] | None, unit: str = "Hz") -> None:
    """Draw a vertical line at each place, with its name and value in the legend; without the value in a live axes."""
    for i, (name, x) in enumerate((marks or {}).items()):
        options = {"color": "k", "lw": 1.2, "ls": (":", "--", "-.")[i % 3], "transform": ax.get_xaxis_transform()}
        # A text that changes has to be drawn each time; a panel says the value below its picture.
        label = name if is_live(ax) else f"{name} {x:.4g} {unit}"
        curve(ax, f"mark {name}", [x, x], [0.0, 1.0], label=label, zorder=1.5, **options)


def note(ax: Axes, name: str, text: str, x: float, y: float, data_x: bool = False, **options) -> None:
    """Write a text at a place in fractions of the axes, x in data if asked for."""
    artist = found(ax, name)
    if artist is None:
        transform = ax.get_xaxis_transform() if data_x else ax.transAxes
        artist = ax.text(x, y, text, transform=transform, **{"va": "top", "size": 8.5, **options})
        artist.set_gid(name)
    artist.set(text=text, position=(x, y), **options)


def finish(
    ax: Axes, x: str | None = None, y: str | None = None, title: str | None = None, legend: bool = True, fit: bool = True
) -> Axes:
    """Label an axes, put its legend above it where it covers nothing, and fit a live axes to its data unless told not to."""
    if y is not None and len(y) > 12 * ax.get_position().height * ax.figure.get_figheight():
        y = y.replace(" (", "\n(")
    for text, now, put in ((x, ax.get_xlabel, ax.set_xlabel), (y, ax.get_ylabel, ax.set_ylabel)):
        if text is not None and now() != text:
            put(text)
    if title is not None:
        ax.set_title(title, loc="left", fontsize="medium")
    labels = [t for t in ax.get_legend_handles_labels()[1] if not t.startswith("_")] if legend else []
    shown = ax.get_legend()
    if labels and shown is not None and len(shown.get_texts()) == len(labels) and is_live(ax):
        for text, label in zip(shown.get_texts(), labels, strict=True):
            text.set_text(label)
    elif labels and (shown is None or [t.get_text() for t in shown.get_texts()] != labels):
        side = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0)}
        room = 11.5 * ax.get_position().width * ax.figure.get_figwidth()  # letters
        columns = int(np.clip(room / (max(map(len, labels)) + 7), 1, len(labels)))
        if sum(map(len, labels)) + 6 * len(labels) <= room:
            columns = len(labels)
        ax.legend(ncols=columns, frameon=False, borderaxespad=0.1, fontsize="small", handlelength=2.6, **side)
    if not is_live(ax) and ax.get_xscale() == "linear":
        ax.margins(x=0.0)
    ax.spines[["top", "right"]].set_visible(False)
    if fit and is_live(ax):
        _fit(ax)
    return ax


def log_frequencies(ax: Axes) -> None:
    """Give a logarithmic frequency axis plain round numbers."""
    if ax.get_xscale() == "log":
        return
    ax.set_xscale("log")
    ax.set_xticks([d * 10.0**p for p in range(-2, 4) for d in (1, 2, 5)])
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter("")


def rung(value: float, rungs: Sequence[float] = _RUNGS) -> float:
    """Return the next round number above a positive value, where an axis may end."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(r for r in rungs if value <= power * r * (1 + 1e-9)))


def _fit(ax: Axes) -> None:
    """Give a live axes round limits around its data."""
    lines = [line for line in ax.lines if line.get_transform() is ax.transData and len(line.get_xdata())]
    for values, get, put, log, along in (
        ([line.get_xdata() for line in lines], ax.get_xlim, ax.set_xlim, ax.get_xscale() == "log", True),
        ([line.get_ydata() for line in lines], ax.get_ylim, ax.set_ylim, ax.get_yscale() == "log", False),
    ):
        values = np.concatenate([np.asarray(v, dtype=float) for v in values]) if values else np.array([])
        values = values[np.isfinite(values) & ((values > 0) | (not log))]
        if not len(values):
            continue
        low, high = float(values.min()), float(values.max())
        start, stop = get()
        if ax.get_gid() == "live, held":
            if start <= low and high <= stop and (log or high - low > 0.12 * (stop - start)):
                continue
            if not log and not along:
                low, high = 1.2 * low, 1.2 * high  # and a little room, so that the next ones fit as well
        # Places along the track stay the same whatever is moved.
        put((low, high) if along and ax.get_xlabel() == ALONG else _round_limits(low, high, log, along))


def _round_limits(low: float, high: float, log: bool, along: bool) -> tuple[float, float]:
    """Return round limits: whole decades; or, either way from zero, a rung along x, halves of the larger rung along y."""
    if log:
        first, last = np.floor(np.log10(low) + 1e-9), np.ceil(np.log10(high) - 1e-9)
        return 10.0**first, 10.0 ** max(last, first + 1)
    reach = max(abs(low), abs(high))
    if reach == 0.0:
        return -1.0, 1.0
    if along:
        return tuple(float(np.sign(v) * rung(abs(v), _FINE_RUNGS)) if v else 0.0 for v in (min(low, 0.0), max(high, 0.0)))
    if low * high > 0 and high - low < 0.5 * reach:  # far from zero, as a weight and a little force
        part = rung(max(high - low, 1e-6 * reach))
        return part * float(np.floor(low / part)), part * float(np.ceil(high / part))
    part = rung(1.04 * reach) / 2
    below, above = (part * np.ceil((v + 0.02 * reach) / part) if v > 0 else 0.0 for v in (-low, high))
    return -float(below), float(above)


def round_below(value: float) -> float:
    """Return the largest of 1, 2, 3, 5 times a power of ten that is not above the value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(d for d in (1, 2, 3, 5) if d <= value / power * (1 + 1e-9)))
