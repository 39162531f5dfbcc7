"""A vehicle seen from its left side, whose parts move up and down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ...vehicles import Vehicle
from ..drawing import round_down
from ..outlines import WHEEL_RADIUS, VehicleOutline, zigzag
from .stage import Stage, Weights

__all__ = ["Ride", "SideView", "ride_of"]

_LARGEST = 26.0  # px, of any motion drawn
_SPRING = 0.42  # m, drawn by `VehicleOutline`
_ROOM = 1.4
"""Length of a spring as drawn, of the most that it is pressed together."""


class Ride(NamedTuple):
    """How a car moves up over the frames.

    Attributes
    ----------
    bodies : dict of (ndarray, ndarray)
        By body: its middle, m, and its slope, m per m forward.
    wheels : dict of ndarray
        By place of the axle, m ahead of the car's middle: m.
    """

    bodies: Mapping[str, tuple[np.ndarray, np.ndarray]]
    wheels: Mapping[float, np.ndarray]


def ride_of(
    vehicle: Vehicle, values: Mapping[str, np.ndarray], wheels: Mapping[float, np.ndarray]
) -> Ride:
    """Return a ride from the motion of every freedom by name, and the heights of the wheels, m."""
    nothing = np.zeros(len(next(iter(wheels.values()))))
    bodies = {}
    for name in (body.name for body in vehicle.bodies):
        pitch = values.get(f"{name} pitch", nothing)
        bodies[name] = values.get(f"{name} z", nothing), -pitch
    return Ride(bodies, wheels)


class SideView:
    """A car seen from its left side, once for each ride.

    Attributes
    ----------
    exaggeration, per_metre : float
        How many times too large motions are drawn, and px for a metre of them.
    height : float
        px that the car takes above the rail.
    numbers : list of ndarray
        What moves its parts, px up: for each ride bodies, what their slope lifts their ends by, and
        wheels.
    """

    def __init__(
        self, vehicle: Vehicle, scale: float, rides: Sequence[Ride], largest: float
    ) -> None:
        self._outline, self._scale, self._places = VehicleOutline(vehicle), scale, rides[0].wheels
        self._boxes, levels = self._outline.boxes, self._outline.levels
        metres = [number for ride in rides for number in self._moved_by(ride)]
        ends = [
            abs(ride.bodies[n][0]) + abs(ride.bodies[n][1]) * box.half[0]
            for ride in rides
            for n, box in self._boxes.items()
        ]
        largest = max(largest, *(end.max() for end in ends))
        self.exaggeration = round_down(_LARGEST / scale / largest) if largest > 0.0 else 1.0
        self.per_metre = scale * self.exaggeration
        self.numbers = [self.per_metre * number for number in metres]
        self._springs = list(dict.fromkeys(self._ends(s) for s in self._outline.springs))
        pressed = max(
            np.abs(sum(w[0] * self.numbers[h] for h, w in self._stretch(ride, *spring))).max()
            for ride in range(len(rides))
            for spring in self._springs
        )
        # What stands on a spring is lifted by what its length in the outline lacks.
        self._lift = max(0.0, _ROOM * pressed - _SPRING * scale)
        top = scale * self._outline.extent[2] + self._lift * max(levels.values())
        self.height = top + _LARGEST + 8.0

    def _moved_by(self, ride: Ride) -> list[np.ndarray]:
        rows = []
        for name, box in self._boxes.items():
            middle, slope = ride.bodies[name]
            rows += [middle, box.half[0] * slope]
        return rows + list(ride.wheels.values())

    def _ends(self, spring) -> tuple[str, str, float]:
        """Return the lower and the upper end of a spring, and its place along the car, m."""
        low, high = sorted((spring.from_, spring.to), key=self._outline.levels.get)
        return low, high, spring.at[0]

    def _weights(self, ride: int, name: str, x: np.ndarray) -> Weights:
        """Return what moves points of a body, or of the wheel nearest to them, at x (m)."""
        bodies = list(self._boxes)
        first = ride * (2 * len(bodies) + len(self._places))
        if name == "rail":
            places = np.array(list(self._places))
            wheel = int(np.abs(places - x[0]).argmin())
            return [(first + 2 * len(bodies) + wheel, np.ones(len(x)))]
        box, first = self._boxes[name], first + 2 * bodies.index(name)
        return [(first, np.ones(len(x))), (first + 1, (x - box.centre[0]) / box.half[0])]

    def _stretch(self, ride: int, low: str, high: str, x: float) -> Weights:
        at = np.array([x])
        below = [(h, -w) for h, w in self._weights(ride, low, at)]
        return self._weights(ride, high, at) + below

    def _height(self, name: str, z: float) -> float:
        """Return how high a point of a body or a wheel is drawn above the rail at rest, px."""
        return self._scale * z + self._lift * self._outline.levels[name]

    def draw(self, stage: Stage, ride: int, middle: float, level: float, colour: str) -> None:
        """Draw the car of a ride with its middle at `middle` and the rail at `level`, px."""
        thin, thick = ({"stroke": colour, "stroke-width": width} for width in (1.2, 1.8))
        for low, high, x in self._springs:
            foot = self._outline.top(low)
            head = self._boxes[high].centre[2] - self._boxes[high].half[2]
            ends = [self._height(low, foot), self._height(high, head)]
            points = zigzag(*(np.array([0.0, end / self._scale]) for end in ends))
            share = (self._scale * points[:, 1] - ends[0]) / (ends[1] - ends[0])
            at = np.full(len(points), x)
            by = [(h, w * (1.0 - share)) for h, w in self._weights(ride, low, at)]
            by += [(h, w * share) for h, w in self._weights(ride, high, at)]
            across = middle + self._scale * (x + points[:, 0])
            place = np.column_stack([across, level - self._scale * points[:, 1]])
            stage.add_part("polyline", place, by, fill="none", **thin)
        for name, box in self._boxes.items():
            x, z = box.corners((0, 2))[:, [0, 2]].T
            up = np.array([self._height(name, height) for height in z])
            place = np.column_stack([middle + self._scale * x, level - up])
            fill = "#eef4f9" if box.on_top else "#d5e3ee"
            stage.add_part("polygon", place, self._weights(ride, name, x), fill=fill, **thick)
        turn, radius = np.linspace(0.0, 2 * np.pi, 25)[:-1], self._scale * WHEEL_RADIUS
        for axle in self._places:
            x = middle + self._scale * axle + radius * np.cos(turn)
            place = np.column_stack([x, level - radius * (1.0 + np.sin(turn))])
            by = self._weights(ride, "rail", np.full(len(turn), axle))
            stage.add_part("polygon", place, by, fill="white", **thick)
