"""Outlines of a vehicle and of a train on its deck: where their parts are drawn, and nothing else.

Lengths and widths are true, heights are schematic: parameter tables give springs without length,
so bodies are drawn one above the other. Wheelsets are drawn where their wheels are; coaches that
share bogies end beside each other above them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .. import errors
from ..trains import AnyTrain, Car
from ..vehicles import FREEDOMS, Body, Modes, Spring, Vehicle

__all__ = [
    "VIEWS", "VIEW_NAMES", "WHEEL_RADIUS", "BodyBox", "CarOutline", "Heights", "Motion", "Path",
    "TrainOutline", "VehicleOutline", "coach_ends", "drawn_length", "is_long", "mode_motion",
    "train_outline", "zigzag",
]  # fmt: skip

# ---- a vehicle by itself

VIEWS = {"side": (0, 2), "top": (0, 1), "front": (1, 2)}
"""Which of x, y, z run across and up in each view."""
VIEW_NAMES = {"side": "side", "top": "from above", "front": "looking forward"}

WHEEL_RADIUS = 0.46  # m, as all that follows
_SPRING_LENGTH = 0.42
_LOW_BODY, _ONLY_BODY, _TOP_BODY = 0.34, 1.1, 2.3
_AXLE = 0.11  # half height and half length of a wheelset
_BETWEEN = 0.15  # half of the gap between two coaches

Motion = Mapping[str, np.ndarray]
"""y, z (m), roll, pitch, yaw (rad) of bodies as drawn, by name; a body that is missing rests."""


@dataclass(frozen=True)
class BodyBox:
    """A body as drawn.

    Attributes
    ----------
    centre, half : ndarray, shape (3,)
        Its middle and its half sizes, m.
    on_top : bool
        Whether no spring stands on it.
    """

    centre: np.ndarray
    half: np.ndarray
    on_top: bool

    def corners(self, plane: tuple[int, int]) -> np.ndarray:
        """Return its corners in a view, shape (4, 3)."""
        a, b = plane
        result = np.tile(self.centre, (4, 1))
        result[:, a] += self.half[a] * np.array([-1, 1, 1, -1])
        result[:, b] += self.half[b] * np.array([-1, -1, 1, 1])
        return result


@dataclass(frozen=True)
class VehicleOutline:
    """Bodies, springs and wheels of a vehicle as drawn, at rest or moved."""

    vehicle: Vehicle

    @cached_property
    def levels(self) -> dict[str, int]:
        """How many springs each body stands above the rail or above its wheelsets."""
        levels = {"rail": 0} | {body.name: 0 for body in self.vehicle.wheelsets}
        while len(levels) <= len(self.vehicle.bodies):
            new = {}
            for spring in self.vehicle.springs:
                for a, b in ((spring.from_, spring.to), (spring.to, spring.from_)):
                    if a in levels and b not in levels:
                        new[b] = levels[a] + 1
            if not new:
                break
            levels |= new
        return levels

    @cached_property
    def springs(self) -> tuple[Spring, ...]:
        """The springs that are drawn: all but the contacts of wheelsets, which are stiff."""
        own = {body.name for body in self.vehicle.wheelsets}
        return tuple(s for s in self.vehicle.springs if not (s.on_rail and own & {s.from_, s.to}))

    @cached_property
    def boxes(self) -> dict[str, BodyBox]:
        """The body boxes by name, from low to high."""
        highest = max(self.levels.values())
        boxes, coaches = {}, coach_ends(self.vehicle, _LONG_SHARE)
        for body in sorted(self.vehicle.bodies, key=lambda body: self.levels[body.name]):
            if self.levels[body.name] == 0:
                boxes[body.name] = self._wheelset(body)
                continue
            springs = [s for s in self.vehicle.springs if body.name in (s.from_, s.to)]
            reach = np.abs(np.array([s.at for s in springs]) - body.position).max(axis=0)
            level = self.levels[body.name]
            on_top = level == highest
            long = on_top and highest > 1
            height = _TOP_BODY if long else _ONLY_BODY if on_top else _LOW_BODY
            bottom = WHEEL_RADIUS + _SPRING_LENGTH * level + _LOW_BODY * (level - 1)
            half_x = reach[0] + 0.35
            if long and len(coaches) > 1 and body.name in coaches:
                half_x = min(abs(end - body.position[0]) for end in coaches[body.name])
            elif long:
                half_x = max(half_x, _LONG_SHARE * drawn_length(self.vehicle))
            half_x = max(half_x, 0.9)
            half_y = max(reach[1] + 0.12, 1.45 if on_top else 0.9)
            centre = np.array([body.position[0], body.position[1], bottom + height / 2])
            boxes[body.name] = BodyBox(centre, np.array([half_x, half_y, height / 2]), on_top)
        return boxes

    def _wheelset(self, body: Body) -> BodyBox:
        """Return the axle of a wheelset, between its wheels."""
        y = [abs(c.y - body.position[1]) for c in self.vehicle.contacts if c.body == body.name]
        half = np.array([_AXLE, max(max(y), _AXLE), _AXLE])
        return BodyBox(np.array([*body.position[:2], WHEEL_RADIUS]), half, False)

    def top(self, name: str) -> float:
        """Return how high springs stand on a body or on the rail, m: of wheels their middle."""
        if self.levels[name] == 0:
            return WHEEL_RADIUS
        return self.boxes[name].centre[2] + self.boxes[name].half[2]

    @cached_property
    def extent(self) -> np.ndarray:
        """Half length, half width and height of all bodies, m."""
        boxes = self.boxes.values()
        across = [max(abs(b.centre[i]) + b.half[i] for b in boxes) for i in range(2)]
        return np.array([*across, max(b.centre[2] + b.half[2] for b in boxes)])

    def wheels(self, view: str) -> list[float]:
        """Return where wheels stand in a view, m, ascending: along x, or across looking forward."""
        if view == "front":
            return sorted({contact.y for contact in self.vehicle.contacts})
        return [axle.x for axle in reversed(self.vehicle.axles)]

    def moved(self, points: np.ndarray, body: str, motion: Motion) -> np.ndarray:
        """Move points tied to a body, shape (n, 3), by u + theta x r."""
        if body not in motion:
            return points
        y, z, *rotation = motion[body]
        turned = np.cross(np.array(rotation), points - self.boxes[body].centre)
        return points + np.array([0.0, y, z]) + turned

    def spring(self, spring: Spring, motion: Motion) -> np.ndarray:
        """Return the lower and the upper end of a spring, shape (2, 3)."""
        low, high = sorted((spring.from_, spring.to), key=self.levels.get)
        x, y, _ = spring.at
        boxes = self.boxes
        foot = self.top(low)
        head = boxes[high].centre[2] - boxes[high].half[2]
        ends = np.array([[x, y, foot]]), np.array([[x, y, head]])
        pairs = zip(ends, (low, high), strict=True)
        return np.concatenate([self.moved(end, body, motion) for end, body in pairs])


def is_long(vehicle: Vehicle) -> bool:
    """Return whether a vehicle is drawn as a long one, wide on the page."""
    return drawn_length(vehicle) > 12


def drawn_length(vehicle: Vehicle) -> float:
    """Return the length of a vehicle, m; where it is not given, what covers wheels and springs."""
    reach = max(abs(spring.at[0]) for spring in vehicle.springs)
    return vehicle.length or 2.0 * reach + 2.0


_LONG_SHARE = 0.48  # half of a long car body as drawn, of the vehicle's length


def coach_ends(vehicle: Vehicle, share: float) -> dict[str, tuple[float, float]]:
    """Return rear and front end of every car body, m ahead of mid-length, by name.

    Neighbours end beside each other, midway between their springs.

    Parameters
    ----------
    vehicle : Vehicle
    share : float
        Where the outer ends are, of the vehicle's length.
    """
    coaches, outer = vehicle.car_bodies, share * drawn_length(vehicle)
    reach = {
        coach.name: [s.at[0] for s in vehicle.springs if coach.name in (s.from_, s.to)]
        for coach in coaches
    }
    between = [
        (min(reach[ahead.name]) + max(reach[behind.name])) / 2
        for ahead, behind in zip(coaches[:-1], coaches[1:], strict=True)
    ]
    fronts = [outer, *(x - _BETWEEN for x in between)]
    rears = [*(x + _BETWEEN for x in between), -outer]
    pairs = zip(coaches, rears, fronts, strict=True)
    return {coach.name: (rear, front) for coach, rear, front in pairs}


def mode_motion(
    vehicle: Vehicle, mode: int, scale: float | None = None
) -> tuple[Modes, dict[str, np.ndarray]]:
    """Return a vehicle's natural modes, and one of them as drawn: the motion of every body.

    The largest motion of any drawn corner is `scale` (m; default 0.65, 0.35 for small vehicles);
    the leading freedom is positive.
    """
    modes = vehicle.modes()
    i = errors.integer("mode", mode, least=1, most=len(modes.names)) - 1
    shape = dict(zip(modes.labels, modes.shapes[:, i], strict=True))
    motion = {
        body.name: np.array([shape.get(f"{body.name} {f}", 0.0) for f in FREEDOMS])
        for body in vehicle.bodies
    }
    outline, largest = VehicleOutline(vehicle), 0.0
    for name, box in outline.boxes.items():
        corners = np.concatenate([box.corners(plane) for plane in VIEWS.values()])
        sizes = np.linalg.norm(outline.moved(corners, name, motion) - corners, axis=1)
        largest = max(largest, sizes.max())
    leading = max(shape.values(), key=abs)
    factor = (scale or (0.65 if is_long(vehicle) else 0.35)) / largest * np.sign(leading)
    return modes, {name: factor * m for name, m in motion.items()}


def zigzag(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a spring from a to b as a line, shape (8, 2)."""
    along = np.array([0, 0.18, 0.26, 0.42, 0.58, 0.74, 0.82, 1.0])
    across = 0.11 * np.array([0, 0, 1, -1, 1, -1, 0, 0])
    step = b - a
    normal = np.array([-step[1], step[0]]) / max(np.hypot(*step), 1e-9)
    return a + along[:, None] * step + across[:, None] * normal


# ---- a train on its deck

_BODY_SHARE = 0.47  # half of a drawn car body, of the car's length over couplers
_OVERHANG = 0.6  # m of a bogie frame beyond its wheels

Path = tuple[np.ndarray, np.ndarray]
"""x and y of a line; NaN where the pen is lifted."""


class Heights(NamedTuple):
    """How high the parts of a train are drawn above the rail, m."""

    wheel: float
    frame: float
    floor: float
    roof: float


@dataclass(frozen=True)
class CarOutline:
    """A car body of a train as drawn: a car, or a coach of an articulated one.

    Attributes
    ----------
    ends : (float, float)
        Its rear and front end, m.
    bogies : tuple of ndarray
        Places of the wheels under each bogie that carries it, m, front to back.
    """

    ends: tuple[float, float]
    bogies: tuple[np.ndarray, ...]


@dataclass(frozen=True)
class TrainOutline:
    """A train as drawn.

    Attributes
    ----------
    wheels : ndarray, shape (axles,)
        Place of every axle, m, front to back.
    cars : tuple of CarOutline
        None of bare axle loads.
    """

    wheels: np.ndarray
    cars: tuple[CarOutline, ...]

    @property
    def frames(self) -> tuple[np.ndarray, ...]:
        """Places of the wheels under every bogie, m; one that carries two coaches counts once."""
        found = {tuple(wheels): wheels for car in self.cars for wheels in car.bogies}
        return tuple(found.values())

    def paths(
        self, heights: Heights, rail: Callable[[np.ndarray], np.ndarray] = np.zeros_like
    ) -> dict[str, Path]:
        """Return wheels (single points), bogie frames and car bodies as lines.

        `rail` gives the height of the rail at places, m. A bogie frame is level and as high as its
        wheels are on average; a car body lies as its outermost bogies do.
        """
        bogies, cars = [], []
        for wheels in self.frames:
            ends = [wheels.min() - _OVERHANG, wheels.max() + _OVERHANG, np.nan]
            bogies.append([ends, [rail(wheels).mean() + heights.frame] * 3])
        for car in self.cars:
            places = [wheels.mean() for wheels in car.bogies]
            levels = [rail(wheels).mean() for wheels in car.bogies]
            tilt = 0.0
            if len(places) > 1:
                tilt = (levels[0] - levels[-1]) / (places[0] - places[-1])
            rear, front = car.ends
            x = np.array([rear, front, front, rear, rear, np.nan])
            y = np.array([heights.floor] * 2 + [heights.roof] * 2 + [heights.floor, np.nan])
            cars.append([x, levels[0] + tilt * (x - places[0]) + y])
        return {
            "cars": _joined(cars),
            "bogies": _joined(bogies),
            "wheels": (self.wheels, rail(self.wheels) + heights.wheel),
        }


def _joined(lines: list) -> Path:
    """Return several lines, each ended by NaN, as one."""
    x, y = np.concatenate(lines, axis=1) if lines else np.empty((2, 0))
    return x, y


def train_outline(train: AnyTrain, first_axle: float = 0.0) -> TrainOutline:
    """Return the outline of a train whose first axle is at a place, m."""
    wheels = np.array([first_axle - axle.delay for axle in train.placed_axles])
    cars = [
        coach
        for car in train.formation
        if car.vehicle is not None
        for coach in _coaches(car, first_axle)
    ]
    return TrainOutline(wheels, tuple(cars))


def _coaches(car: Car, first_axle: float) -> list[CarOutline]:
    """Return the car body of a car, or each coach of an articulated one."""
    middle, vehicle = first_axle - car.centre, car.vehicle
    bogies: dict[str, list[float]] = {}
    for wheel in car.wheels:
        bogies.setdefault(wheel.body, []).append(middle + wheel.x)
    places = {name: np.array(own) for name, own in bogies.items()}
    ends, result = coach_ends(vehicle, _BODY_SHARE), []
    for name, (rear, front) in ends.items():
        beside = {
            end for s in vehicle.springs for end in (s.from_, s.to) if name in (s.from_, s.to)
        }
        own = [wheels for bogie, wheels in places.items() if bogie in beside or len(ends) == 1]
        own = tuple(own or places.values())
        result.append(CarOutline((middle + rear, middle + front), own))
    return result
