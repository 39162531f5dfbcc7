"""Boxes and shells: the section with its dimensions, mode shapes in three dimensions, and which modes are alike."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path

from .. import errors
from ..boxes import Box, Shell, ShellModes
from ..boxes.section import SectionProperties
from .drawing import GREY, LOOKS, curve, finish, grid, one

__all__ = ["assurance", "box_section", "shell_mode", "shell_modes"]

_CONCRETE, _COLOUR = "#e3e9ef", LOOKS["displacement_z"].colour
_GAUGE = 1.435  # m, drawn only
_TURN, _RISE = np.radians(-58.0), np.radians(24.0)  # of the view of modes


def box_section(box: Box, section: SectionProperties | None = None, ax: Axes | None = None) -> Axes:
    """Draw a box's section with its dimensions (m), tracks and bearings.

    Parameters
    ----------
    box : Box
    section : SectionProperties, optional
        `Box.section`; marks centroid and shear centre.
    ax : Axes, optional
    """
    ax = one(ax, 4.4)
    outline, hole = box.outline, box.hole
    corners = np.concatenate([outline, outline[:1], hole, hole[:1]])
    codes = [c for n in (len(outline), len(hole)) for c in (Path.MOVETO, *[Path.LINETO] * (n - 1), Path.CLOSEPOLY)]
    ax.add_patch(PathPatch(Path(corners, codes), fc=_CONCRETE, ec="k", lw=1.1))
    width, depth, edge = box.slab_width, box.depth, box.slab_width / 2
    web, foot, knee = box.web_spacing / 2, box.bottom_spacing / 2, box.bottom_spacing / 2 + box.web_thickness / 2
    for name, y in box.tracks.items():
        rails = np.array([y - _GAUGE / 2, y + _GAUGE / 2])
        curve(ax, f"rails {name}", rails, np.full(2, depth + 0.06), color="k", ls="", marker="s", ms=5)
        ax.text(y, depth + 0.18, f"{name} track\ny = {y:g} m", va="bottom", ha="center", size=8.5)
    for side in sorted({s for p in box.bearings for s in p.sides}):
        y = side * foot
        ax.add_patch(Polygon([(y, 0.0), (y - 0.2, -0.3), (y + 0.2, -0.3)], fc="white", ec="k", lw=1.1))
        curve(ax, f"ground {side}", [y - 0.32, y + 0.32], [-0.3, -0.3], color="k", lw=1.6)
    if section is not None:
        for name, at, mark in (("centroid", section.centroid, "+"), ("shear centre", section.shear_centre, "x")):
            curve(ax, name, at[:1], at[1:], label=name, color=LOOKS["force_z"].colour, ls="", marker=mark, ms=9, mew=1.8)
    high = depth + (0.75 if box.tracks else 0.2)
    _level(ax, -edge, edge, high + 0.15, f"{width:.2f}")
    _level(ax, -web, web, depth - box.slab_thickness - 0.22, f"{box.web_spacing:.2f}")
    _level(ax, -foot, foot, -0.55, f"{box.bottom_spacing:.2f}")
    _upright(ax, edge + 0.35, 0.0, depth, f"{depth:.2f}")
    for text, at, way in (
        (f"{box.edge_thickness:.2f}", (-edge, depth - box.edge_thickness), (-0.05, -0.32)),
        (f"{box.root_thickness:.2f}", (-knee - 0.15, depth - box.root_thickness), (-0.25, -0.4)),
        (f"{box.slab_thickness:.2f}", (0.0, depth), (0.0, 0.3)),
        (f"{box.bottom_thickness:.2f}", (0.5 * web, 0.0), (0.0, -0.3)),
        (f"{box.web_thickness:.2f}", (-knee, depth / 2), (-0.75, 0.0)),
    ):
        place = {"ha": "center", "va": "center", "fontsize": 8.5}
        ax.annotate(
            text, at, (at[0] + way[0], at[1] + way[1]), arrowprops={"arrowstyle": "-|>", "lw": 0.8, "shrinkB": 0}, **place
        )
    finish(ax, "y, to the left (m)", "height above the underside (m)", box.name)
    # The section seen along the track: left is left.
    ax.set(xlim=(edge + 1.0, -edge - 0.6), ylim=(-0.95, high + 0.45), aspect="equal")
    return ax


def _level(ax: Axes, a: float, b: float, z: float, text: str) -> None:
    """A level dimension line from a to b at height z, its text above."""
    ax.annotate("", (a, z), (b, z), arrowprops={"arrowstyle": "<->", "lw": 0.8, "shrinkA": 0, "shrinkB": 0})
    ax.text((a + b) / 2, z + 0.03, f"{text} m", va="bottom", ha="center", size=8.5)


def _upright(ax: Axes, y: float, a: float, b: float, text: str) -> None:
    """An upright dimension line from a to b at y, its text to the left of it."""
    ax.annotate("", (y, a), (y, b), arrowprops={"arrowstyle": "<->", "lw": 0.8, "shrinkA": 0, "shrinkB": 0})
    ax.text(y + 0.12, (a + b) / 2, f"{text} m", va="center", ha="center", rotation=90, size=8.5)


def _seen(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Turn x y z, shape (..., 3), into the plane of the picture, shape (..., 2), and distance towards the eye."""
    x, y, z = np.moveaxis(points, -1, 0)
    across = x * np.cos(_TURN + np.pi / 2) + y * np.sin(_TURN + np.pi / 2)
    towards = x * np.cos(_TURN) + y * np.sin(_TURN)
    up = z * np.cos(_RISE) - towards * np.sin(_RISE)
    return np.stack([across, up], axis=-1), towards * np.cos(_RISE) + z * np.sin(_RISE)


def shell_mode(shell: Shell, modes: ShellModes, mode: int, ax: Axes | None = None, scale: float = 1.2) -> Axes:
    """Draw a mode of a shell in three dimensions, darker where it moves more, its outline at rest in grey.

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
    ax = one(ax, 3.6)
    i = errors.integer("mode", mode, least=1, most=len(modes.names)) - 1
    moved = modes.vectors[:, :3, i] * errors.number("scale", scale, above=0.0, unit="m") / np.abs(modes.vectors[:, :3, i]).max()
    flat, _ = _seen(shell.nodes)
    edges = shell.points[:, 1] > shell.points[:, 1].max() - 0.5
    sides = np.flatnonzero(edges)[[np.argmin(shell.points[edges, 0]), np.argmax(shell.points[edges, 0])]]
    rows = flat[: len(shell.stations) * len(shell.points)].reshape(len(shell.stations), len(shell.points), 2)
    for side in sides:
        curve(ax, f"rest {side}", *rows[:, side].T, color=GREY, lw=0.9, ls=":", zorder=4)
    turned, depth = _seen(shell.nodes + moved)
    order = np.argsort(depth[shell.quads].mean(axis=1))
    size = np.linalg.norm(moved, axis=1)[shell.quads].mean(axis=1)
    faces = PolyCollection(
        turned[shell.quads][order], array=size[order], cmap="Blues", ec="#44505c", lw=0.25, clim=(-0.15 * scale, scale)
    )
    ax.add_collection(faces)
    ax.autoscale_view()
    word = (
        ""
        if not modes.names[i].startswith("local")
        else f", {modes.parts[i]}, left and right {'alike' if modes.symmetric[i] else 'opposite'}"
    )
    finish(ax, title=f"{mode}: {modes.names[i]}, {modes.frequencies_hz[i]:.2f} Hz{word}")
    ax.set(
        aspect="equal",
        xticks=[],
        yticks=[],
        xlabel=f"length {shell.stations[-1] - shell.stations[0]:.1f} (m), motion drawn up to {scale:g} (m)",
    )
    ax.spines[:].set_visible(False)
    return ax


def shell_modes(
    shell: Shell, modes: ShellModes, which: Iterable[int] = range(1, 7), axes: Sequence[Axes] | None = None
) -> np.ndarray:
    """Draw several modes of a shell as small multiples; see `shell_mode`."""
    which = [m for m in which if m <= len(modes.names)]
    columns = min(2, len(which))
    rows = -(-len(which) // columns)
    axes = grid(axes, rows, columns, 0.3 + 2.4 * rows)
    for ax, m in zip(axes, which, strict=False):
        shell_mode(shell, modes, m, ax)
        ax.title.set_fontsize("medium")
        ax.set_title(ax.get_title(loc="left").replace(", left and right", ",\nleft and right"), loc="left", fontsize="small")
    for ax in axes[len(which) :]:
        ax.set_axis_off()
    return axes[: len(which)]


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
        raise errors.InputError(
            "criterion", criterion.shape, f"must have a row and a column for each name, {len(rows), len(columns)}"
        )
    ax = one(ax, 1.6 + 0.32 * len(rows))
    ax.imshow(criterion, cmap="Blues", vmin=0.0, vmax=1.3, aspect="auto")
    for (r, c), value in np.ndenumerate(criterion):
        if value >= 0.05:
            ax.text(c, r, f"{value:.2f}", ha="center", va="center", fontsize=8.5, color="white" if value > 0.75 else "k")
    ax.set_xticks(range(len(columns)), columns, rotation=30, ha="right", fontsize=8.5)
    ax.set_yticks(range(len(rows)), rows, fontsize=8.5)
    ax.set(xlabel=f"mode of the {what[1]} (-)", ylabel=f"mode of the {what[0]}")
    ax.set_title("modal assurance criterion: 1 is the same shape, empty is below 0.05", loc="left", fontsize="medium")
    ax.tick_params(length=0)
    return ax
