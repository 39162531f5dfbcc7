"""A mode of a vehicle that swings, from three sides."""

from __future__ import annotations

import numpy as np

from ... import errors
from ...vehicles import FREEDOMS, Modes, Vehicle
from ..outlines import (
    VIEW_NAMES,
    VIEWS,
    WHEEL_RADIUS,
    Motion,
    VehicleOutline,
    is_long,
    mode_motion,
    zigzag,
)
from ..sketches import modes_of_equal_frequency, what_moves
from ..style import FREEDOM_NAMES, GREY, PALE, style_of
from .player import FEWEST, INK, MOST, WIDTH, Animation, Drawing, page, points_text, rounded, script

__all__ = ["animate_vehicle_mode"]

CYCLE = 2.5  # s, for one cycle of a mode
_MOTION = style_of("displacement_z").colour
_LARGEST_SCALE = 60.0  # px per m


def animate_vehicle_mode(vehicle: Vehicle, mode: int, frames: int = 24) -> Animation:
    """Animate a natural mode of a vehicle, from the side, from above and looking forward.

    A mode has a shape and no size: it is drawn as large as can be seen, and the picture says how
    large. Modes of equal frequency have no unique shapes; the picture then shows one of many and
    says so.

    Parameters
    ----------
    vehicle : Vehicle
    mode : int
        From 1.
    frames : int
        Pictures a cycle, 4 to 600; between them the player interpolates.

    Raises
    ------
    InputError
        No such mode, or a number of frames out of range.
    """
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    modes, motion = mode_motion(vehicle, mode)
    frequency = modes.frequencies_hz[mode - 1]
    drawing = _ModeDrawing(VehicleOutline(vehicle), motion)
    largest = f"{drawing.largest:.2g} m"
    words = (
        f"Mode {mode}, {frequency:.4g} Hz. {what_moves(vehicle, modes, mode)} "
        "A mode has a shape and no size of its own: "
        f"here nothing moves by more than {largest}, far more than in truth. "
        f"One cycle takes {1 / frequency:.2g} s; here it takes {CYCLE:g} s. "
        "Grey is the position at rest; heights are schematic."
    )
    title = f"mode {mode}, {_freedom_in_words(vehicle, modes, mode)}, {frequency:.4g} Hz"
    equal = modes_of_equal_frequency(modes, mode)
    one_of_many = " (one of many shapes: it shares its frequency)" if equal else ""
    size = f"drawn up to {largest}, not to scale; one cycle in {CYCLE:g} s"
    drawing.write(10, drawing.height - 8, f"{title}{one_of_many}: {size}", size=13)
    data = {
        "frames": frames,
        "start": frames // 4,
        "loop": True,
        "seconds": CYCLE,
        "period": round(1 / frequency, 6),
        "slider": "Time within one cycle",
        "rest": drawing.still,
        "move": drawing.displacements,
    }
    return Animation(title, frames, page(drawing, title, words, data, script("modes.js")))


def _freedom_in_words(vehicle: Vehicle, modes: Modes, mode: int) -> str:
    """Name a mode by its freedom; of an equal pair no body can be named."""
    energy = np.diag(vehicle.mass_matrix) * modes.shapes[:, mode - 1] ** 2
    share = {
        f: sum(e for e, n in zip(energy, modes.labels, strict=True) if n.endswith(f" {f}"))
        for f in FREEDOMS
    }
    return FREEDOM_NAMES[max(share, key=lambda f: round(share[f] / energy.sum(), 6))]


class _ModeDrawing(Drawing):
    """Three views of a vehicle: at rest in grey, furthest from it in colour.

    Attributes
    ----------
    still, displacements : list of list of float
        Corners of each part that moves, at rest, and how far they move, px; x and y in turn.
    """

    def __init__(self, outline: VehicleOutline, motion: Motion) -> None:
        vehicle = outline.vehicle
        half_x, half_y, height = outline.extent + (0.9 if is_long(vehicle) else 0.5)
        scale = min(_LARGEST_SCALE, (WIDTH - 80) / (2 * (half_x + half_y)))
        left, front = 20 + scale * half_x, 60 + scale * (2 * half_x + half_y)
        self._outline, self._motion, self._scale = outline, motion, scale
        self._middle = {"side": left, "top": left, "front": front}
        self._rail = 30 + scale * height  # px from above
        self._axis = self._rail + 60 + scale * half_y  # of the car as seen from above
        super().__init__(self._axis + scale * half_y + 30)
        self.still: list[list[float]] = []
        self.displacements: list[list[float]] = []
        for view in VIEWS:
            above = self._axis - scale * half_y - 4 if view == "top" else 20
            self.write(self._middle[view], above, VIEW_NAMES[view], anchor="middle")
            self._draw_at_rest(view, scale * (half_y if view == "front" else half_x))
            self._draw_moving(view)

    @property
    def largest(self) -> float:
        """Largest motion drawn, m."""
        sizes = (np.linalg.norm(np.reshape(d, (-1, 2)), axis=1).max() for d in self.displacements)
        return float(max(sizes) / self._scale)

    def _on_page(self, view: str, points: np.ndarray) -> np.ndarray:
        """Turn points, shape (n, 3), into px, shape (n, 2)."""
        a, b = points[:, VIEWS[view]].T
        sign = -1 if view == "front" else 1  # looking forward: left is left
        across = self._middle[view] + self._scale * (sign * a)
        down = (self._axis if view == "top" else self._rail) - self._scale * b
        return np.column_stack([across, down])

    def _draw_at_rest(self, view: str, half: float) -> None:
        """Draw bodies, rail (`half` px either way) and wheels."""
        for box in self._outline.boxes.values():
            corners = points_text(self._on_page(view, box.corners(VIEWS[view])))
            self.add("polygon", points=corners, stroke=PALE, fill="none", **{"stroke-width": 1.4})
        if view == "top":
            return
        middle, rail = self._middle[view], self._rail
        self.add("line", stroke=INK, x1=middle - half, x2=middle + half, y1=rail, y2=rail)
        radius = WHEEL_RADIUS * self._scale
        rx = radius if view == "side" else 0.09 * self._scale
        for place in self._outline.wheels(view):
            x, y = self._on_page(view, np.array([[place, place, WHEEL_RADIUS]]))[0]
            self.add("ellipse", cx=x, cy=y, rx=rx, ry=radius, stroke=GREY, fill="white")

    def _draw_moving(self, view: str) -> None:
        """Draw bodies and springs, each as a part that moves."""
        outline, plane = self._outline, VIEWS[view]
        for name, box in outline.boxes.items():
            still = box.corners(plane)
            moved = outline.moved(still, name, self._motion)
            fill = "none" if view == "top" and box.on_top else "#0072B218"
            self._add_part("polygon", view, still, moved, 1.8, fill)
        for spring in outline.springs if view != "top" else ():
            lines = []
            for motion in ({}, self._motion):
                line = np.zeros((8, 3))
                line[:, plane] = zigzag(*outline.spring(spring, motion)[:, plane])
                lines.append(line)
            self._add_part("polyline", view, *lines, 1.1, "none")

    def _add_part(
        self, shape: str, view: str, still: np.ndarray, moved: np.ndarray, width: float, fill: str
    ) -> None:
        still, moved = self._on_page(view, still), self._on_page(view, moved)
        part = {"data-part": len(self.still), "stroke": _MOTION, "stroke-width": width}
        self.still.append(rounded(still.ravel()))
        self.displacements.append(rounded((moved - still).ravel()))
        self.add(shape, points=points_text(moved), **part, fill=fill)
