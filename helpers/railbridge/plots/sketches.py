"""Sketches of a vehicle, and of what moves in its modes; heights are schematic."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from ..vehicles import Modes, Vehicle
from .drawing import FIGURE_WIDTH
from .outlines import (
    VIEW_NAMES,
    VIEWS,
    WHEEL_RADIUS,
    Motion,
    VehicleOutline,
    drawn_length,
    is_long,
    mode_motion,
    zigzag,
)
from .style import GREY, PALE, literal, style_of

__all__ = ["modes_of_equal_frequency", "vehicle", "vehicle_mode", "what_moves"]

_EDGE, _BODY, _MOVED = "#34495e", "#e8eef4", style_of("displacement_z").colour
_DAMPER_BESIDE = 0.24  # m, from the spring
_ONE_CAR = 32.0  # m, the longest vehicle whose views stand side by side
_VERBS = {"y": "sways", "z": "bounces", "roll": "rolls", "pitch": "pitches", "yaw": "yaws"}


def vehicle(vehicle: Vehicle, axes: Sequence[Axes] | None = None) -> np.ndarray:
    """Sketch a vehicle with springs, dampers, wheels and key dimensions.

    From the side, from above and looking forward. Heights are schematic; lengths and widths are to
    scale.

    Parameters
    ----------
    vehicle : Vehicle
    axes : three Axes, optional

    Returns
    -------
    ndarray of Axes, shape (3,)
    """
    axes, outline, long = _three_axes(axes, vehicle), VehicleOutline(vehicle), is_long(vehicle)
    side, _, front = axes
    _draw_at_rest(axes, outline, edge=_EDGE, fill=_BODY, dampers=True)
    _frame_views(axes, outline, below=2.7 if long else 0.6, room=0.9 if long else 0.4)
    _name_bodies(axes, outline)
    places, sides, room = outline.wheels("side"), outline.wheels("front"), _crowded(vehicle)
    if room > 1.0:
        side.set_ylim(bottom=-2.7 * room)
        front.set_ylim(bottom=-1.5)
    for a, b in zip(places[:-1], places[1:], strict=True):
        _dimension(side, a, b, -0.75 * room, f"{b - a:.4g} m", 0.08 * room)
    if long and vehicle.length:
        half = vehicle.length / 2
        text = f"length {vehicle.length:.4g} m"
        _dimension(side, -half, half, -1.6 * room, text, 0.08 * room)
    if len(sides) > 1:
        _dimension(front, sides[0], sides[-1], -0.75, f"{sides[-1] - sides[0]:.3g} m")
    return np.array(axes, dtype=object)


def _name_bodies(axes: Sequence[Axes], outline: VehicleOutline) -> None:
    """Write names and masses: of high bodies in the side view, of bogies from above.

    Of wheelsets, too close for names, the title of the view from above says how many there are.
    """
    side, top, _ = axes
    vehicle, wheelsets = outline.vehicle, outline.vehicle.wheelsets
    several = len(vehicle.car_bodies) > 1
    for body in vehicle.bodies:
        if body in wheelsets:
            continue
        (x, _, z), half = outline.boxes[body.name].centre, outline.boxes[body.name].half
        text = f"{literal(body.name)}\n{body.mass / 1e3:.4g} t"
        ax, y, size = (side, z, 9) if half[2] > 0.4 else (top, 0.0, 7.5)
        # The ends of two coaches meet above the bogie that they share.
        behind = {"fc": _BODY, "ec": "none", "pad": 0.8} if several and ax is top else None
        ax.text(x, y, text, ha="center", va="center", size=size, zorder=4, bbox=behind)
    if wheelsets:
        masses = sorted({f"{body.mass / 1e3:.4g}" for body in wheelsets}, key=float)
        text = " to ".join(dict.fromkeys((masses[0], masses[-1])))
        sets = "wheelset" if len(wheelsets) == 1 else "wheelsets"
        words = f"{VIEW_NAMES['top']}; {len(wheelsets)} {sets} of {text} t"
        top.set_title(words, loc="left", fontsize="small")


def vehicle_mode(
    vehicle: Vehicle, mode: int, axes: Sequence[Axes] | None = None, scale: float | None = None
) -> np.ndarray:
    """Show what moves in a natural mode, from three sides: at rest in grey, deflected in colour.

    Modes of equal frequency have no unique shapes; the picture then shows one of many and says so.

    Parameters
    ----------
    vehicle : Vehicle
    mode : int
        From 1.
    axes : three Axes, optional
    scale : float, optional
        m drawn for the largest motion of any drawn corner; default 0.65 (smaller for small
        vehicles).

    Returns
    -------
    ndarray of Axes, shape (3,)

    Raises
    ------
    InputError
        No such mode.
    """
    modes, motion = mode_motion(vehicle, mode, scale)
    axes, outline, long = _three_axes(axes, vehicle), VehicleOutline(vehicle), is_long(vehicle)
    _draw_at_rest(axes, outline, edge=PALE, fill="none", dampers=False)
    for ax, view in zip(axes, VIEWS, strict=True):
        _draw_bodies(ax, view, outline, motion, edge=_MOVED, fill="#0072B218")
        _draw_springs(ax, view, outline, motion, edge=_MOVED, dampers=False)
    _frame_views(axes, outline, below=0.3, room=0.9 if long else 0.5)
    title = f"mode {mode}: {modes.frequencies_hz[mode - 1]:.4g} Hz"
    words = fill(what_moves(vehicle, modes, mode), 78 if long else 36)
    axes[0].set_title(literal(f"{title}\n{words}"), loc="left", fontsize="medium")
    return np.array(axes, dtype=object)


# ---- words


def modes_of_equal_frequency(modes: Modes, mode: int) -> list[int]:
    """Return the other modes, from 1, that share the frequency of one.

    Such modes have no shapes of their own.
    """
    f = modes.frequencies_hz[mode - 1]
    near = np.abs(modes.frequencies_hz - f) < 1e-5 * f
    return [number for number in (np.flatnonzero(near) + 1).tolist() if number != mode]


def what_moves(vehicle: Vehicle, modes: Modes, mode: int) -> str:
    """Say which bodies move how in a mode, from 1, by their shares of the kinetic energy."""
    energy = np.diag(vehicle.mass_matrix) * modes.shapes[:, mode - 1] ** 2
    share = dict(zip(modes.labels, energy / energy.sum(), strict=True))
    parts = []
    for body in vehicle.bodies:
        ways = sorted(((share[f"{body.name} {f}"], f) for f in body.freedoms), reverse=True)
        words = [f"{_VERBS[f]} ({100 * part:.0f} %)" for part, f in ways if part > 0.05]
        if words:
            parts.append(f"{body.name} {' and '.join(words)}")
    text = "; ".join(parts) + " - shares of the kinetic energy"
    equal = modes_of_equal_frequency(modes, mode)
    if equal:
        text += f". Same frequency as mode {equal[0]}: any mix of them is a mode as well"
    return text[0].upper() + text[1:] + "."


# ---- the three views


def _three_axes(axes: Sequence[Axes] | None, vehicle: Vehicle) -> list[Axes]:
    """Return the given axes, or those of a new figure: side, top, front."""
    if axes is not None:
        return list(axes)
    import matplotlib.pyplot as plt

    mosaic, size, ratios = [["side", "top", "front"]], (FIGURE_WIDTH, 3.4), {}
    layout = "compressed"
    if _crowded(vehicle) > 1.0:
        # Compressed, all views would be as narrow as the one looking forward.
        mosaic, layout, size = [["side"], ["top"], ["front"]], "constrained", (FIGURE_WIDTH, 5.6)
        ratios = {"height_ratios": [1.7, 1.0, 2.0]}
    elif is_long(vehicle):
        mosaic, size = [["side", "front"], ["top", "."]], (FIGURE_WIDTH, 4.4)
        ratios = {"width_ratios": [5.0, 1.15], "height_ratios": [1.5, 1.0]}
    _, axes = plt.subplot_mosaic(mosaic, figsize=size, layout=layout, **ratios)
    return [axes[view] for view in VIEWS]


def _crowded(vehicle: Vehicle) -> float:
    """Return how many times longer than one long car a vehicle is drawn, at least 1."""
    return max(1.0, drawn_length(vehicle) / _ONE_CAR)


def _draw_at_rest(
    axes: Sequence[Axes], outline: VehicleOutline, edge: str, fill: str, dampers: bool
) -> None:
    """Draw bodies, springs and wheels in all three views."""
    for ax, view in zip(axes, VIEWS, strict=True):
        _draw_bodies(ax, view, outline, {}, edge, fill)
        _draw_springs(ax, view, outline, {}, edge, dampers)
        _draw_wheels(ax, view, outline)
        if view != "top":
            ax.axhline(0.0, color="k", lw=1.2)


def _draw_bodies(
    ax: Axes, view: str, outline: VehicleOutline, motion: Motion, edge: str, fill: str
) -> None:
    plane = VIEWS[view]
    for name, box in outline.boxes.items():
        corners = outline.moved(box.corners(plane), name, motion)[:, plane]
        # From above the highest body would hide all others.
        inside = "none" if view == "top" and box.on_top else fill
        zorder = 2 + 0.1 * outline.levels[name]
        ax.add_patch(Polygon(corners, fc=inside, ec=edge, lw=1.4, zorder=zorder))


def _draw_springs(
    ax: Axes, view: str, outline: VehicleOutline, motion: Motion, edge: str, dampers: bool
) -> None:
    """Draw springs and dampers where they can be seen."""
    if view == "top":
        return
    for spring in outline.springs:
        foot, head = outline.spring(spring, motion)[:, VIEWS[view]]
        ax.plot(*zigzag(foot, head).T, color=edge, lw=0.9, zorder=3)
        if dampers and any(spring.damping):
            _draw_damper(ax, foot, head, edge)


def _draw_damper(ax: Axes, foot: np.ndarray, head: np.ndarray, colour: str) -> None:
    """Draw a dash-pot beside the spring from foot to head."""
    (x0, y0), (x1, y1) = foot + [_DAMPER_BESIDE, 0.0], head + [_DAMPER_BESIDE, 0.0]
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    for line in (
        ([x0, x], [y0, y - 0.06]),
        ([x - 0.09, x - 0.09, x + 0.09, x + 0.09], [y + 0.08, y - 0.06, y - 0.06, y + 0.08]),
        ([x - 0.07, x + 0.07], [y + 0.02, y + 0.02]),
        ([x, x1], [y + 0.02, y1]),
    ):
        ax.plot(*line, color=colour, lw=0.9, zorder=3)


def _draw_wheels(ax: Axes, view: str, outline: VehicleOutline) -> None:
    if view == "top":
        half_x, half_y = np.array([-0.4, 0.4, 0.4, -0.4]), np.array([-0.07, -0.07, 0.07, 0.07])
        for contact in outline.vehicle.contacts:
            tread = np.column_stack([contact.x + half_x, contact.y + half_y])
            ax.add_patch(Polygon(tread, fc=GREY))
        return
    angle = np.linspace(0, 2 * np.pi, 40)
    half_width = WHEEL_RADIUS if view == "side" else 0.09
    height = WHEEL_RADIUS + WHEEL_RADIUS * np.sin(angle)
    for place in outline.wheels(view):
        across = place + half_width * np.cos(angle)
        ax.fill(across, height, fc="white", ec=GREY, lw=1.2, zorder=2.5)


def _frame_views(axes: Sequence[Axes], outline: VehicleOutline, below: float, room: float) -> None:
    """Give the three views one scale, with room (m) around the vehicle and below the rail."""
    half_x, half_y, height = outline.extent + room
    limits = {0: (-half_x, half_x), 1: (-half_y, half_y), 2: (-below, height)}
    heights = {"side": "height, schematic", "top": "y (m)", "front": ""}
    for ax, (view, (a, b)) in zip(axes, VIEWS.items(), strict=True):
        ax.set(xlim=limits[a], ylim=limits[b], aspect="equal")
        ax.set(xlabel="xyz"[a] + " (m)", ylabel=heights[view])
        if view == "front":
            ax.invert_xaxis()  # looking forward: left is left
        if view != "top":
            ax.set_yticks([])
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_title(VIEW_NAMES[view], loc="left", fontsize="small")


def _dimension(ax: Axes, a: float, b: float, height: float, text: str, below: float = 0.08) -> None:
    """Draw a dimension line from a to b, its text so far below (m)."""
    arrow = {"arrowstyle": "<->", "lw": 0.8, "color": "k", "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (a, height), (b, height), arrowprops=arrow)
    ax.text((a + b) / 2, height - below, text, ha="center", va="top", size=7.5)
