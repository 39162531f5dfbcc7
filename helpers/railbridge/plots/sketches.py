"""Sketches: a vehicle and what moves in its modes, and a train on its deck.

Heights are schematic: parameter tables give springs without length, so bodies are drawn one above the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from .. import errors
from ..decks import Deck
from ..trains import AxleTrain, Train
from ..vehicles import FREEDOMS, Modes, Spring, Vehicle
from .drawing import GREY, LOOKS, PALE, WIDTH, curve, finish, note, one
from .outlines import axle_places, car_outlines

__all__ = ["train_on_deck", "vehicle", "vehicle_mode"]

_WHEEL, _GAP, _LOW, _HIGH = 0.46, 0.42, 0.34, 2.3  # m: wheel radius, spring length, height of a low and of the top body
_BODY, _MOVED = "#e8eef4", LOOKS["displacement_z"].colour
VIEWS = {"side": (0, 2), "top": (0, 1), "front": (1, 2)}
_DOES = {"y": "sways", "z": "bounces", "roll": "rolls", "pitch": "pitches", "yaw": "yaws"}


@dataclass(frozen=True)
class _Box:
    """A body as drawn: centre and half sizes, m."""

    centre: np.ndarray
    half: np.ndarray

    def corners(self, plane: tuple[int, int]) -> np.ndarray:
        a, b = plane
        result = np.tile(self.centre, (4, 1))
        result[:, a] += self.half[a] * np.array([-1, 1, 1, -1])
        result[:, b] += self.half[b] * np.array([-1, -1, 1, 1])
        return result


def body_levels(v: Vehicle) -> dict[str, int]:
    """How many springs a body stands above the rail."""
    level = {"rail": 0}
    while len(level) <= len(v.bodies):
        new = {}
        for s in v.springs:
            for a, b in ((s.from_, s.to), (s.to, s.from_)):
                if a in level and b not in level:
                    new[b] = level[a] + 1
        if not new:
            break
        level |= new
    return level


def body_boxes(v: Vehicle) -> dict[str, _Box]:
    level = body_levels(v)
    top = max(level.values())
    boxes = {}
    for body in v.bodies:
        at = np.array([s.at for s in v.springs if body.name in (s.from_, s.to)])
        reach = np.abs(at - body.position).max(axis=0)
        is_top = level[body.name] == top
        bottom = _WHEEL + _GAP * level[body.name] + _LOW * (level[body.name] - 1)
        height = _HIGH if is_top and top > 1 else 1.1 if is_top else _LOW
        half_x = max(reach[0] + 0.35, 0.48 * v.length if is_top and top > 1 else 0.9)
        half_y = max(reach[1] + 0.12, 1.45 if is_top else 0.9)
        centre = np.array([body.position[0], body.position[1], bottom + height / 2])
        boxes[body.name] = _Box(centre, np.array([half_x, half_y, height / 2]))
    return boxes


def spring_ends(s: Spring, boxes: dict[str, _Box], level: dict[str, int]) -> list[tuple[str, np.ndarray]]:
    """Lower and upper end of a spring as drawn, each with the body it is tied to."""
    low, high = sorted((s.from_, s.to), key=lambda n: level[n])
    x, y, _ = s.at
    foot = _WHEEL if low == "rail" else boxes[low].centre[2] + boxes[low].half[2]
    head = boxes[high].centre[2] - boxes[high].half[2]
    return [(low, np.array([x, y, foot])), (high, np.array([x, y, head]))]


def moved(points: np.ndarray, name: str, boxes: dict[str, _Box], motion: dict[str, np.ndarray]) -> np.ndarray:
    """Move points tied to a body by u + theta x r."""
    if name not in motion:
        return points
    y, z, *rotation = motion[name]
    return points + np.array([0.0, y, z]) + np.cross(np.array(rotation), points - boxes[name].centre)


def zigzag(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """A spring from a to b, shape (10, 2)."""
    along = np.array([0, 0.18, 0.26, 0.42, 0.58, 0.74, 0.82, 1.0])
    across = 0.11 * np.array([0, 0, 1, -1, 1, -1, 0, 0])
    step = b - a
    normal = np.array([-step[1], step[0]]) / max(np.hypot(*step), 1e-9)
    return a + along[:, None] * step + across[:, None] * normal


def _damper(ax: Axes, a: np.ndarray, b: np.ndarray, colour: str) -> None:
    """A dash-pot from a to b, beside the spring."""
    side = np.array([0.24, 0.0])
    a, b = a + side, b + side
    m = (a + b) / 2
    for x, y in (
        ([a[0], m[0]], [a[1], m[1] - 0.06]),
        ([m[0] - 0.09, m[0] - 0.09, m[0] + 0.09, m[0] + 0.09], [m[1] + 0.08, m[1] - 0.06, m[1] - 0.06, m[1] + 0.08]),
        ([m[0] - 0.07, m[0] + 0.07], [m[1] + 0.02, m[1] + 0.02]),
        ([m[0], b[0]], [m[1] + 0.02, b[1]]),
    ):
        ax.plot(x, y, color=colour, lw=0.9, zorder=3)


def _figure_axes(axes: Sequence[Axes] | None, v: Vehicle) -> list[Axes]:
    if axes is not None:
        return list(axes)
    import matplotlib.pyplot as plt

    long = v.length > 12
    layout = [["side", "front"], ["top", "."]] if long else [["side", "top", "front"]]
    ratios = {"width_ratios": [5.0, 1.15], "height_ratios": [1.5, 1.0]} if long else {}
    _, made = plt.subplot_mosaic(layout, figsize=(WIDTH, 4.4 if long else 3.4), layout="compressed", **ratios)
    return [made[view] for view in VIEWS]


def _draw(axes: Sequence[Axes], v: Vehicle, motion: dict[str, np.ndarray] | None, look: dict) -> None:
    """Draw bodies, springs and wheels in all three views."""
    boxes, level = body_boxes(v), body_levels(v)
    wheels = sorted((axle.x, v.contacts[w].y) for axle in v.axles for w in axle.wheels)
    for ax, (view, plane) in zip(axes, VIEWS.items(), strict=True):
        a, b = plane
        for body in sorted(v.bodies, key=lambda body: level[body.name]):
            corners = moved(boxes[body.name].corners(plane), body.name, boxes, motion or {})[:, plane]
            filled = look["fill"] if view != "top" or level[body.name] < max(level.values()) else "none"
            ax.add_patch(Polygon(corners, fc=filled, ec=look["edge"], lw=1.4, zorder=2 + 0.1 * level[body.name]))
        if view == "top":
            if not motion:
                for x, y in wheels:
                    ax.add_patch(Polygon(np.array([x, y]) + [[-0.4, -0.07], [0.4, -0.07], [0.4, 0.07], [-0.4, 0.07]], fc=GREY))
            continue
        for s in v.springs:
            (low, foot), (high, head) = spring_ends(s, boxes, level)
            foot, head = (moved(p[None], n, boxes, motion or {})[0, plane] for n, p in ((low, foot), (high, head)))
            ax.plot(*zigzag(foot, head).T, color=look["edge"], lw=0.9, zorder=3)
            if not motion and look["dampers"] and any(s.damping):
                _damper(ax, foot, head, look["edge"])
        if not motion:
            angle = np.linspace(0, 2 * np.pi, 40)
            for place in sorted({w[a] for w in wheels}):
                wide = _WHEEL if view == "side" else 0.09
                ax.fill(place + wide * np.cos(angle), _WHEEL + _WHEEL * np.sin(angle), fc="white", ec=GREY, lw=1.2, zorder=2.5)
            ax.axhline(0.0, color="k", lw=1.2)


def extent(v: Vehicle) -> np.ndarray:
    """Half length, half width and height that a vehicle takes on the page, m."""
    boxes = body_boxes(v).values()
    return np.array(
        [max(abs(b.centre[i]) + b.half[i] for b in boxes) for i in range(2)] + [max(b.centre[2] + b.half[2] for b in boxes)]
    )


def _frame(axes: Sequence[Axes], v: Vehicle, below: float, room: float) -> None:
    """Give the three views one scale, with room (m) around the vehicle and below the rail."""
    half_x, half_y, height = extent(v) + room
    limits = {0: (-half_x, half_x), 1: (-half_y, half_y), 2: (-below, height)}
    for ax, (view, (a, b)) in zip(axes, VIEWS.items(), strict=True):
        ax.set(xlim=limits[a], ylim=limits[b], aspect="equal")
        ax.set_xlabel("xyz"[a] + " (m)")
        ax.set_ylabel("y (m)" if view == "top" else "height, schematic" if view == "side" else "")
        if view == "front":
            ax.invert_xaxis()  # looking forward: left is left
        if view != "top":
            ax.set_yticks([])
        ax.spines[["top", "right"]].set_visible(False)
        ax.set_title({"side": "side", "top": "from above", "front": "looking forward"}[view], loc="left", fontsize="small")


def vehicle(vehicle: Vehicle, axes: Sequence[Axes] | None = None) -> np.ndarray:
    """Sketch a vehicle from the side, from above and looking forward, with springs, dampers, wheels and key dimensions.

    Heights are schematic; lengths and widths are to scale.

    Parameters
    ----------
    vehicle : Vehicle
    axes : three Axes, optional

    Returns
    -------
    ndarray of Axes, shape (3,)
    """
    drawn = _figure_axes(axes, vehicle)
    side, top, front = drawn
    _draw(drawn, vehicle, None, {"fill": _BODY, "edge": "#34495e", "dampers": True})
    long = vehicle.length > 12
    _frame(drawn, vehicle, 2.7 if long else 0.6, 0.9 if long else 0.4)
    boxes = body_boxes(vehicle)
    for body in vehicle.bodies:
        x, _, z = boxes[body.name].centre
        mass = f"{body.mass / 1e3:.4g} t"
        if boxes[body.name].half[2] > 0.4:
            side.text(x, z, f"{body.name}\n{mass}", ha="center", va="center", size=9, zorder=4)
        else:
            top.text(x, 0.0, f"{body.name}\n{mass}", ha="center", va="center", size=7.5, zorder=4)
    axles = [axle.x for axle in reversed(vehicle.axles)]
    if len(axles) > 1:
        for a, b in zip(axles[:-1], axles[1:], strict=True):
            _dimension(side, a, b, -0.75, f"{b - a:.4g} m")
    if long:
        _dimension(side, -vehicle.length / 2, vehicle.length / 2, -1.6, f"length {vehicle.length:.4g} m")
    rails = sorted({round(c.y, 6) for c in vehicle.contacts})
    if len(rails) > 1:
        _dimension(front, rails[0], rails[-1], -0.75, f"{rails[-1] - rails[0]:.3g} m")
    return np.array(drawn, dtype=object)


def _dimension(ax: Axes, a: float, b: float, at: float, text: str) -> None:
    ax.annotate("", (a, at), (b, at), arrowprops={"arrowstyle": "<->", "lw": 0.8, "color": "k", "shrinkA": 0, "shrinkB": 0})
    ax.text((a + b) / 2, at - 0.08, text, ha="center", va="top", size=7.5)


def vehicle_mode(vehicle: Vehicle, mode: int, axes: Sequence[Axes] | None = None, scale: float | None = None) -> np.ndarray:
    """Show what moves in a natural mode: at rest in grey, deflected in colour, from three sides.

    Modes of equal frequency have no unique shapes; the picture then shows one of many and says so.

    Parameters
    ----------
    vehicle : Vehicle
    mode : int
        From 1.
    axes : three Axes, optional
    scale : float, optional
        m drawn for the largest motion of any drawn corner; default 0.65 (smaller for small vehicles).

    Returns
    -------
    ndarray of Axes, shape (3,)

    Raises
    ------
    InputError
        No such mode.
    """
    modes, motion = mode_motion(vehicle, mode, scale)
    i = mode - 1
    drawn = _figure_axes(axes, vehicle)
    _draw(drawn, vehicle, None, {"fill": "none", "edge": PALE, "dampers": False})
    _draw(drawn, vehicle, motion, {"fill": "#0072B218", "edge": _MOVED})
    _frame(drawn, vehicle, 0.3, 0.9 if vehicle.length > 12 else 0.5)
    title = f"mode {mode}: {modes.frequencies_hz[i]:.4g} Hz, {modes.names[i]}"
    drawn[0].set_title(
        f"{title}\n{fill(what_moves(vehicle, modes, i), 78 if vehicle.length > 12 else 36)}", loc="left", fontsize="medium"
    )
    return np.array(drawn, dtype=object)


def mode_motion(vehicle: Vehicle, mode: int, scale: float | None = None) -> tuple[Modes, dict[str, np.ndarray]]:
    """Return a vehicle's natural modes, and one of them as drawn: y, z, roll, pitch, yaw of every body by its name.

    The largest motion of any drawn corner is `scale` (m; default 0.65, 0.35 for small vehicles); the leading freedom is positive.
    """
    modes = vehicle.modes()
    i = errors.integer("mode", mode, least=1, most=len(modes.names)) - 1
    boxes = body_boxes(vehicle)
    shape = dict(zip(modes.labels, modes.shapes[:, i], strict=True))
    motion = {b.name: np.array([shape.get(f"{b.name} {f}", 0.0) for f in FREEDOMS]) for b in vehicle.bodies}
    corners = {n: np.concatenate([box.corners(p) for p in VIEWS.values()]) for n, box in boxes.items()}
    largest = max(np.linalg.norm(moved(c, n, boxes, motion) - c, axis=1).max() for n, c in corners.items())
    leading = max(shape.values(), key=abs)
    factor = (scale or (0.65 if vehicle.length > 12 else 0.35)) / largest * np.sign(leading)
    return modes, {n: factor * m for n, m in motion.items()}


def same_frequency(modes: Modes, i: int) -> list[int]:
    """Return the other modes, from 1, that share the frequency of the one with index i: they have no shapes of their own."""
    f = modes.frequencies_hz
    return [j + 1 for j in range(len(f)) if j != i and abs(f[j] - f[i]) < 1e-5 * f[i]]


def what_moves(v: Vehicle, modes: Modes, i: int) -> str:
    energy = np.diag(v.mass_matrix) * modes.shapes[:, i] ** 2
    share = energy / energy.sum()
    parts = []
    for body in v.bodies:
        moves = [(share[modes.labels.index(f"{body.name} {f}")], f) for f in body.freedoms]
        moves = sorted((m for m in moves if m[0] > 0.05), reverse=True)
        if moves:
            parts.append(f"{body.name} " + " and ".join(f"{_DOES[f]} ({100 * s:.0f} %)" for s, f in moves))
    text = "; ".join(parts) + " - shares of the kinetic energy"
    equal = same_frequency(modes, i)
    if equal:
        text += f". Same frequency as mode {equal[0]}: any mix of them is a mode as well"
    return text[0].upper() + text[1:] + "."


def train_on_deck(train: Train | AxleTrain, deck: Deck, ax: Axes | None = None, position: float | None = None) -> Axes:
    """Sketch a train on its deck.

    Parameters
    ----------
    train : Train or AxleTrain
    deck : Deck
    ax : Axes, optional
    position : float, optional
        Place of the first axle, m from the bridge entrance; default 0, at the entrance.

    Returns
    -------
    Axes
        Heights are schematic.
    """
    ax = one(ax, 1.9)
    at = 0.0 if position is None else errors.number("position", position, unit="m")
    cars, bogies = [], []
    for car in car_outlines(train, at):
        rear, front = car.body
        cars.append(np.array([rear, front, front, rear, rear, np.nan]))
        bogies += [[x.min() - 0.6, x.max() + 0.6, np.nan] for x in car.bogies]
    wheels = axle_places(train, at)
    level = np.tile([1.6, 1.6, 4.2, 4.2, 1.6, np.nan], len(cars))
    end = max(deck.length, at) + 12.0
    start = min(0.0, at - train.length) - 12.0
    curve(ax, "rail before", [start, 0.0, np.nan, deck.length, end], [0.0, 0.0, np.nan, 0.0, 0.0], color=GREY, lw=2.0)
    curve(ax, "deck", [0.0, deck.length], [-0.8, -0.8], color="#34495e", lw=8.0, solid_capstyle="butt")
    curve(ax, "bearings", deck.supports, np.full(len(deck.supports), -2.2), color="#34495e", ls="", marker="^", ms=9)
    colour = LOOKS["force_z"].colour
    curve(ax, "cars", np.concatenate(cars) if cars else [], level, color=colour, lw=1.3)
    curve(ax, "bogies", np.concatenate(bogies) if bogies else [], np.tile([1.1, 1.1, np.nan], len(bogies)), color=colour, lw=2.5)
    curve(ax, "wheels", wheels, np.full(len(wheels), 0.55), color=colour, ls="", marker="o", ms=3.2)
    if not cars:
        curve(ax, "loads", np.repeat(wheels, 3), np.tile([0.9, 3.4, np.nan], len(wheels)), color=colour)
    note(ax, "deck name", f"{deck.name}, {deck.length:g} m", deck.length / 2, 0.0, data_x=True, ha="center", va="bottom")
    finish(ax, "x from the bridge entrance (m)", legend=False)
    ax.set(xlim=(start, end), ylim=(-4.2, 5.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax
