"""Boxes and shells: the section with its dimensions, mode shapes, and which modes are alike."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path

from .. import errors
from ..boxes import Box, SectionProperties, Shell, ShellModes
from .drawing import axes_or_new, curve, label_axes, numbers_up_to, small_multiples
from .style import GREY, literal, style_of

__all__ = ["assurance", "box_section", "shell_mode", "shell_modes"]

_CONCRETE = "#e3e9ef"
_GAUGE = 1.435  # m, drawn only
_TURN, _RISE = np.radians(-58.0), np.radians(24.0)  # of the view of modes


# ---- the section


def box_section(box: Box, section: SectionProperties | None = None, ax: Axes | None = None) -> Axes:
    """Draw a box's section with its dimensions (m), tracks and bearings.

    Parameters
    ----------
    box : Box
    section : SectionProperties, optional
        `Box.section`; marks centroid and shear centre.
    ax : Axes, optional
    """
    ax = axes_or_new(ax, 4.4)
    _draw_concrete(ax, box)
    for name, y in box.tracks.items():
        rails, height = np.array([y - _GAUGE / 2, y + _GAUGE / 2]), np.full(2, box.depth + 0.06)
        curve(ax, f"rails {name}", rails, height, color="k", ls="", marker="s", ms=5)
        text = f"{literal(name)} track\ny = {y:g} m"
        ax.text(y, box.depth + 0.18, text, va="bottom", ha="center", size=8.5)
    for side in sorted({side for pads in box.bearings for side in pads.sides}):
        y = side * box.bottom_spacing / 2
        triangle = [(y, 0.0), (y - 0.2, -0.3), (y + 0.2, -0.3)]
        ax.add_patch(Polygon(triangle, fc="white", ec="k", lw=1.1))
        curve(ax, f"ground {side}", [y - 0.32, y + 0.32], [-0.3, -0.3], color="k", lw=1.6)
    if section is not None:
        cross = {"color": style_of("force_z").colour, "ls": "", "ms": 9, "mew": 1.8}
        y, z = section.centroid
        curve(ax, "centroid", [y], [z], label="centroid", marker="+", **cross)
        y, z = section.shear_centre
        curve(ax, "shear centre", [y], [z], label="shear centre", marker="x", **cross)
    top = box.depth + (0.75 if box.tracks else 0.2)
    _draw_dimensions(ax, box, top)
    label_axes(ax, "y, to the left (m)", "height above the underside (m)", literal(box.name))
    # The section seen along the track: left is left.
    edge = box.slab_width / 2
    ax.set(xlim=(edge + 1.0, -edge - 0.6), ylim=(-0.95, top + 0.45), aspect="equal")
    return ax


def _draw_concrete(ax: Axes, box: Box) -> None:
    outline, hole = box.outline, box.hole
    corners = np.concatenate([outline, outline[:1], hole, hole[:1]])
    codes = []
    for line in (outline, hole):
        codes += [Path.MOVETO, *[Path.LINETO] * (len(line) - 1), Path.CLOSEPOLY]
    ax.add_patch(PathPatch(Path(corners, codes), fc=_CONCRETE, ec="k", lw=1.1))


def _draw_dimensions(ax: Axes, box: Box, top: float) -> None:
    """Draw dimension lines, and arrows to the plates with their thickness."""
    edge, web, foot = box.slab_width / 2, box.web_spacing / 2, box.bottom_spacing / 2
    knee = foot + box.web_thickness / 2
    _level(ax, edge, top + 0.15, box.slab_width)
    _level(ax, web, box.depth - box.slab_thickness - 0.22, box.web_spacing)
    _level(ax, foot, -0.55, box.bottom_spacing)
    _upright(ax, edge + 0.35, box.depth)
    place = {"ha": "center", "va": "center", "fontsize": 8.5}
    arrow = {"arrowstyle": "-|>", "lw": 0.8, "shrinkB": 0}
    for thickness, y, z, right, up in (
        (box.edge_thickness, -edge, box.depth - box.edge_thickness, -0.05, -0.32),
        (box.root_thickness, -knee - 0.15, box.depth - box.root_thickness, -0.25, -0.4),
        (box.slab_thickness, 0.0, box.depth, 0.0, 0.3),
        (box.bottom_thickness, 0.5 * web, 0.0, 0.0, -0.3),
        (box.web_thickness, -knee, box.depth / 2, -0.75, 0.0),
    ):
        ax.annotate(f"{thickness:.2f}", (y, z), (y + right, z + up), arrowprops=arrow, **place)


_DIMENSION = {"arrowstyle": "<->", "lw": 0.8, "shrinkA": 0, "shrinkB": 0}


def _level(ax: Axes, half: float, z: float, width: float) -> None:
    """Draw a level dimension line, `half` either way, its text above."""
    ax.annotate("", (-half, z), (half, z), arrowprops=_DIMENSION)
    ax.text(0.0, z + 0.03, f"{width:.2f} m", va="bottom", ha="center", size=8.5)


def _upright(ax: Axes, y: float, height: float) -> None:
    """Draw an upright dimension line at y, its text to the left of it."""
    ax.annotate("", (y, 0.0), (y, height), arrowprops=_DIMENSION)
    text, place = f"{height:.2f} m", {"va": "center", "ha": "center", "rotation": 90}
    ax.text(y + 0.12, height / 2, text, size=8.5, **place)


# ---- modes


def shell_mode(
    shell: Shell, modes: ShellModes, mode: int, ax: Axes | None = None, scale: float = 1.2
) -> Axes:
    """Draw a mode of a shell in space, darker where it moves more, its edges at rest in grey.

    Parameters
    ----------
    shell : Shell
    modes : ShellModes
    mode : int
        From 1.
    ax : Axes, optional
    scale : float
        m, largest displacement as drawn.
    """
    i = errors.integer("mode", mode, least=1, most=len(modes.names)) - 1
    scale = errors.number("scale", scale, above=0.0, unit="m")
    ax = axes_or_new(ax, 3.6)
    motion = modes.vectors[:, :3, i] * scale / np.abs(modes.vectors[:, :3, i]).max()
    page, _ = _projected(shell.nodes)
    rows = page[: len(shell.stations) * len(shell.points)]
    rows = rows.reshape(len(shell.stations), len(shell.points), 2)
    for side in _edges_of_slab(shell):
        line = {"color": GREY, "lw": 0.9, "ls": ":", "zorder": 4}
        curve(ax, f"rest {side}", *rows[:, side].T, **line)
    page, nearness = _projected(shell.nodes + motion)
    order = np.argsort(nearness[shell.quads].mean(axis=1))  # what is near hides what is far
    size = np.linalg.norm(motion, axis=1)[shell.quads].mean(axis=1)
    shades = {"array": size[order], "cmap": "Blues", "clim": (-0.15 * scale, scale)}
    ax.add_collection(PolyCollection(page[shell.quads][order], ec="#44505c", lw=0.25, **shades))
    ax.autoscale_view()
    title = f"{mode}: {literal(modes.names[i])}, {modes.frequencies_hz[i]:.2f} Hz"
    if modes.names[i].startswith("local"):
        sides = "alike" if modes.symmetric[i] else "opposite"
        title += f", {modes.parts[i]}, left and right {sides}"
    length = shell.stations[-1] - shell.stations[0]
    label_axes(ax, f"length {length:.1f} (m), motion drawn up to {scale:g} (m)", title=title)
    ax.set(aspect="equal", xticks=[], yticks=[])
    ax.spines[:].set_visible(False)
    return ax


def _edges_of_slab(shell: Shell) -> np.ndarray:
    """Return which points of a section are the edges of the slab: the outermost near the top."""
    high = np.flatnonzero(shell.points[:, 1] > shell.points[:, 1].max() - 0.5)
    return high[[np.argmin(shell.points[high, 0]), np.argmax(shell.points[high, 0])]]


def _projected(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Turn x y z, shape (..., 3), into the picture's plane, shape (..., 2), and nearness."""
    x, y, z = np.moveaxis(points, -1, 0)
    across = x * np.cos(_TURN + np.pi / 2) + y * np.sin(_TURN + np.pi / 2)
    towards = x * np.cos(_TURN) + y * np.sin(_TURN)
    up = z * np.cos(_RISE) - towards * np.sin(_RISE)
    return np.stack([across, up], axis=-1), towards * np.cos(_RISE) + z * np.sin(_RISE)


def shell_modes(
    shell: Shell,
    modes: ShellModes,
    which: Iterable[int] = range(1, 7),
    axes: Sequence[Axes] | None = None,
) -> np.ndarray:
    """Draw several modes of a shell as small multiples; see `shell_mode`."""
    which = numbers_up_to("which", which, 1, len(modes.names))
    axes = small_multiples(axes, len(which), 2, 0.3, 2.4)
    for ax, mode in zip(axes, which, strict=True):
        shell_mode(shell, modes, mode, ax)
        ax.title.set_fontsize("medium")
        title = ax.get_title(loc="left").replace(", left and right", ",\nleft and right")
        ax.set_title(title, loc="left", fontsize="small")
    return axes


def assurance(
    criterion: np.ndarray,
    rows: Sequence[str],
    columns: Sequence[str],
    ax: Axes | None = None,
    what: tuple[str, str] = ("shell", "beam"),
) -> Axes:
    """Draw a modal assurance criterion as a table of shades with its values.

    Parameters
    ----------
    criterion : ndarray, shape (len(rows), len(columns))
        From `railbridge.comparison.mac`.
    rows, columns : sequence of str
        Names of the modes.
    ax : Axes, optional
    what : (str, str)
        What the rows and the columns belong to.
    """
    criterion = np.asarray(criterion, dtype=float)
    if criterion.shape != (len(rows), len(columns)):
        allowed = f"must have a row and a column for each name, {len(rows), len(columns)}"
        raise errors.InputError("criterion", criterion.shape, allowed)
    ax = axes_or_new(ax, 1.6 + 0.32 * len(rows))
    ax.imshow(criterion, cmap="Blues", vmin=0.0, vmax=1.3, aspect="auto")
    for (r, c), value in np.ndenumerate(criterion):
        if value >= 0.05:
            colour = "white" if value > 0.75 else "k"
            place = {"ha": "center", "va": "center", "fontsize": 8.5}
            ax.text(c, r, f"{value:.2f}", color=colour, **place)
    ax.set_xticks(range(len(columns)), columns, rotation=30, ha="right", fontsize=8.5)
    ax.set_yticks(range(len(rows)), rows, fontsize=8.5)
    ax.set(xlabel=f"mode of the {what[1]} (-)", ylabel=f"mode of the {what[0]}")
    title = "modal assurance criterion: 1 is the same shape, empty is below 0.05"
    ax.set_title(title, loc="left", fontsize="medium")
    ax.tick_params(length=0)
    return ax
