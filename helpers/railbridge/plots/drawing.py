"""What every figure is made of: axes, curves, texts, legends and limits.

A function of `plots` makes new artists each time it is called. In a figure that reuses its artists
(see `reuse_artists`), it moves those it finds under the same names instead, which is what a panel
needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from ..errors import InputError
from .style import GREY, SHADE, style_of

__all__ = [
    "FIGURE_WIDTH", "PLACE_LABEL", "TIME_LABEL", "axes_or_new", "axes_or_new_grid", "band",
    "curve", "keep_limits", "label_axes", "leave_behind", "log_frequencies", "note",
    "numbers_up_to", "quantity_curve", "reuse_artists", "reuses_artists", "round_down", "round_up",
    "shade", "small_multiples", "vertical_lines",
]  # fmt: skip

FIGURE_WIDTH = 9.0  # inch, 900 px in a notebook
TIME_LABEL = "time since the first axle entered (s)"
PLACE_LABEL = "x from the bridge entrance (m)"

# Axes that reuse their artists end at these numbers times a power of ten: such ends seldom move,
# and depend on nothing but what is shown. The finer ones serve along x.
_ROUND = (1.0, 1.5, 2.5, 4.0, 6.0, 10.0)
_FINELY_ROUND = (1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.8, 3.4, 4.0, 4.8, 5.6, 6.8, 8.0, 10.0)

# What an axes does with its artists is written in its gid.
_REUSED, _LIMITS_KEPT = "artists reused", "artists reused, limits kept"


def axes_or_new(ax: Axes | None, height: float = 3.0) -> Axes:
    """Return the given axes, or that of a new figure of notebook width, `height` in inches."""
    return ax if ax is not None else axes_or_new_grid(None, 1, 1, height)[0]


def axes_or_new_grid(
    axes: Sequence[Axes] | None, rows: int, columns: int, height: float, **options
) -> np.ndarray:
    """Return the given axes as a flat array, or those of a new figure.

    `height` is in inches; options as for ``plt.subplots``.
    """
    if axes is not None:
        return np.ravel(np.asarray(axes, dtype=object))
    import matplotlib.pyplot as plt

    size = FIGURE_WIDTH, height
    _, new = plt.subplots(
        rows, columns, figsize=size, layout="constrained", squeeze=False, **options
    )
    return np.ravel(new)


def small_multiples(
    axes: Sequence[Axes] | None, count: int, columns: int, title: float, row: float, **options
) -> np.ndarray:
    """Return axes for `count` pictures of one kind, at most `columns` in a row.

    A row is `row` inches high, and there are `title` inches above all. Axes left over in the last
    row are switched off.
    """
    columns = min(columns, count)
    rows = -(-count // columns)
    axes = axes_or_new_grid(axes, rows, columns, title + row * rows, **options)
    for ax in axes[count:]:
        ax.set_axis_off()
    return axes[:count]


def numbers_up_to(field: str, numbers: Iterable[int], least: int, most: int) -> list[int]:
    """Return those of some numbers that exist, `least` to `most`; higher ones are left out.

    Raises
    ------
    InputError
        None of them exists, or one is lower than the first.
    """
    numbers = list(numbers)
    kept = [n for n in numbers if n <= most]
    if not kept or min(kept) < least:
        raise InputError(field, numbers, f"must name some of {least} to {most}")
    return kept


# ---- figures that reuse their artists


def reuse_artists(figure: Figure) -> None:
    """Let every axes of a figure move its artists from now on, and end at round numbers."""
    for ax in figure.axes:
        ax.set_gid(_REUSED)
        for axis, scale in (("x", ax.get_xscale()), ("y", ax.get_yscale())):
            if scale == "linear" and getattr(ax, f"get_{axis}ticks")().size:
                ax.locator_params(axis=axis, nbins=6)  # text is what takes time to draw


def keep_limits(figure: Figure, keep: bool) -> None:
    """Let a figure that reuses its artists keep its limits, or fit them to the data again.

    Limits are kept while the data stay within them and are not lost in them.
    """
    for ax in figure.axes:
        ax.set_gid(_LIMITS_KEPT if keep else _REUSED)


def reuses_artists(ax: Axes) -> bool:
    """Return whether an axes moves its artists instead of drawing new ones."""
    return ax.get_gid() in (_REUSED, _LIMITS_KEPT)


def _artist_named(ax: Axes, name: str) -> Artist | None:
    """Return the artist to reuse of a name, or None."""
    if not reuses_artists(ax):
        return None
    return next((a for a in ax.get_children() if a.get_gid() == name), None)


# ---- artists


def curve(
    ax: Axes, name: str, x, y, *, label: str | None = None, zorder: float = 2.0, **line
) -> None:
    """Draw a curve, or move the one of that name."""
    label = f"_{name}" if label is None else label
    artist = _artist_named(ax, name)
    if artist is None:
        (artist,) = ax.plot(x, y, label=label, zorder=zorder, **{"lw": 1.5, **line})
        artist.set_gid(name)
    else:
        artist.set_data(x, y)
        artist.set_label(label)


def quantity_curve(
    ax: Axes, quantity: str, x, y, *, name: str | None = None, label: str | None = None, **line
) -> None:
    """Draw a quantity, given in SI units, in its own unit, colour and line style; see `curve`."""
    style = style_of(quantity)
    line = {"color": style.colour, "ls": style.line, **line}
    curve(ax, name or quantity, x, style.factor * np.asarray(y), label=label, **line)


def leave_behind(ax: Axes, names: Sequence[str], label: str) -> None:
    """Draw some curves once more as they stand now, in grey behind all others; those stay.

    What moves later is seen against them, and an axes that reuses its artists never ends before
    them: its scales grow, but do not become finer than they were.
    """
    for name, line in [(line.get_gid(), line) for line in ax.lines if line.get_gid() in names]:
        look = {"ls": line.get_linestyle(), "marker": line.get_marker(), "color": GREY, "lw": 1.2}
        look |= {"ms": line.get_markersize(), "label": label if name == names[0] else None}
        curve(ax, f"{name} left behind", *line.get_data(), zorder=1.5, **look)


def shade(ax: Axes, name: str, start: float, stop: float, label: str | None = None) -> None:
    """Shade a stretch of the horizontal axis."""
    artist = _artist_named(ax, name)
    if artist is None:
        options = {"transform": ax.get_xaxis_transform(), "fc": SHADE, "ec": "none", "zorder": 0}
        artist = Rectangle((start, 0.0), stop - start, 1.0, **options)
        artist.set_gid(name)
        ax.add_patch(artist)
    artist.set_x(start)
    artist.set_width(stop - start)
    artist.set_label(f"_{name}" if label is None else label)


def band(
    ax: Axes, name: str, x, low, high, colour: str, label: str | None = None, zorder: float = 1.8
) -> None:
    """Fill what lies between two curves, or move the band of that name."""
    corners = np.column_stack([np.concatenate([x, x[::-1]]), np.concatenate([low, high[::-1]])])
    artist = _artist_named(ax, name)
    if artist is None:
        artist = Polygon(corners, fc=colour, ec="none", alpha=0.25, zorder=zorder)
        artist.set_gid(name)
        ax.add_patch(artist)
    artist.set_xy(corners)
    artist.set_label(f"_{name}" if label is None else label)


def vertical_lines(ax: Axes, places: Mapping[str, float] | None, unit: str = "Hz") -> None:
    """Draw a vertical line at each place, with its name and value in the legend."""
    for i, (name, x) in enumerate((places or {}).items()):
        dashes = (":", "--", "-.")[i % 3]
        options = {"color": "k", "lw": 1.2, "ls": dashes, "transform": ax.get_xaxis_transform()}
        # A text that changes has to be drawn each time; a panel says the value below its picture.
        label = name if reuses_artists(ax) else f"{name} {x:.4g} {unit}"
        curve(ax, f"line at {name}", [x, x], [0.0, 1.0], label=label, zorder=1.5, **options)


def note(
    ax: Axes, name: str, text: str, x: float, y: float, data_x: bool = False, **options
) -> None:
    """Write a text at a place in fractions of the axes, x in data if `data_x`."""
    artist = _artist_named(ax, name)
    if artist is None:
        transform = ax.get_xaxis_transform() if data_x else ax.transAxes
        artist = ax.text(x, y, text, transform=transform, **{"va": "top", "size": 8.5, **options})
        artist.set_gid(name)
    artist.set(text=text, position=(x, y), **options)


# ---- labels, legend and limits


def label_axes(
    ax: Axes,
    x: str | None = None,
    y: str | None = None,
    title: str | None = None,
    legend: bool = True,
    fit: bool = True,
) -> Axes:
    """Label an axes and put its legend above it, where it covers nothing.

    An axes that reuses its artists is fitted to its data, too, unless `fit` is false.
    """
    if x is not None and ax.get_xlabel() != x:
        ax.set_xlabel(x)
    if y is not None and ax.get_ylabel().replace("\n", " ") != y:
        long = len(y) > 12 * ax.get_position().height * ax.figure.get_figheight()
        ax.set_ylabel(y.replace(" (", "\n(") if long else y)
    if title is not None:
        ax.set_title(title, loc="left", fontsize="medium")
    if legend:
        _write_legend(ax)
    if not reuses_artists(ax) and ax.get_xscale() == "linear":
        ax.margins(x=0.0)
    ax.spines[["top", "right"]].set_visible(False)
    if fit and reuses_artists(ax):
        _fit_limits(ax)
    return ax


def _write_legend(ax: Axes) -> None:
    """Write the legend, or only the texts of the one that is there if they are as many."""
    labels = [t for t in ax.get_legend_handles_labels()[1] if not t.startswith("_")]
    texts = ax.get_legend().get_texts() if ax.get_legend() is not None else []
    if not labels or [text.get_text() for text in texts] == labels:
        return
    if len(texts) == len(labels) and reuses_artists(ax):
        for text, label in zip(texts, labels, strict=True):
            text.set_text(label)
        return
    room = 15.5 * ax.get_position().width * ax.figure.get_figwidth()  # letters
    columns = max(n for n in range(1, len(labels) + 1) if n == 1 or _legend_width(labels, n) < room)
    above = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.1}
    above |= {"handlelength": 2.4, "columnspacing": 1.4}
    ax.legend(ncols=columns, frameon=False, fontsize="small", **above)


def _legend_width(labels: Sequence[str], columns: int) -> float:
    """Return how wide a legend is about, in letters; a line and its gaps count as eight."""
    return sum(8 + max(map(len, part)) for part in np.array_split(labels, columns))


def log_frequencies(ax: Axes) -> None:
    """Give a logarithmic frequency axis plain round numbers."""
    if ax.get_xscale() == "log":
        return
    ax.set_xscale("log")
    ax.set_xticks([d * 10.0**p for p in range(-2, 4) for d in (1, 2, 5)])
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter("")


def round_up(value: float, numbers: Sequence[float] = _ROUND) -> float:
    """Return the next round number above a positive value, where an axis may end."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(n for n in numbers if value <= power * n * (1 + 1e-9)))


def round_down(value: float) -> float:
    """Return the largest of 1, 2, 3, 5 times a power of ten that is not above the value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(d for d in (1, 2, 3, 5) if d <= value / power * (1 + 1e-9)))


def _fit_limits(ax: Axes) -> None:
    """Give an axes round limits around its data, x and y."""
    lines = [line for line in ax.lines if line.get_transform() is ax.transData]
    lines = [line for line in lines if len(line.get_xdata())]
    for along in (True, False):
        values = [line.get_xdata() if along else line.get_ydata() for line in lines]
        log = (ax.get_xscale() if along else ax.get_yscale()) == "log"
        values = np.concatenate([np.asarray(v, dtype=float) for v in values] or [[]])
        values = values[np.isfinite(values) & ((values > 0) | (not log))]
        if not len(values):
            continue
        low, high = float(values.min()), float(values.max())
        start, stop = ax.get_xlim() if along else ax.get_ylim()
        if ax.get_gid() == _LIMITS_KEPT:
            if start <= low and high <= stop and (log or high - low > 0.12 * (stop - start)):
                continue
            if not log and not along:
                # And a little room, so that the next ones fit as well.
                low, high = 1.2 * low, 1.2 * high
        # Places along the track stay the same whatever is moved.
        as_they_are = along and ax.get_xlabel() == PLACE_LABEL
        limits = (low, high) if as_they_are else _round_limits(low, high, log, along)
        (ax.set_xlim if along else ax.set_ylim)(limits)


def _round_limits(low: float, high: float, log: bool, along: bool) -> tuple[float, float]:
    """Return round limits around values.

    Whole decades on a logarithmic axis; else, either way from zero, a finely round number along x,
    halves of the larger round number along y.
    """
    if log:
        first, last = np.floor(np.log10(low) + 1e-9), np.ceil(np.log10(high) - 1e-9)
        return 10.0**first, 10.0 ** max(last, first + 1)
    reach = max(abs(low), abs(high))
    if reach == 0.0:
        return -1.0, 1.0
    if along:
        ends = min(low, 0.0), max(high, 0.0)
        return tuple(
            float(np.sign(v) * round_up(abs(v), _FINELY_ROUND)) if v else 0.0 for v in ends
        )
    if low * high > 0 and high - low < 0.5 * reach:  # far from zero, as a weight and a little force
        part = round_up(max(high - low, 1e-6 * reach))
        return part * float(np.floor(low / part)), part * float(np.ceil(high / part))
    part = round_up(1.04 * reach) / 2
    below, above = (
        part * np.ceil((v + 0.02 * reach) / part) if v > 0 else 0.0 for v in (-low, high)
    )
    return -float(below), float(above)
