"""Where a train's bodies, bogies and axles are along the bridge: what every drawing of it starts from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..trains import AnyTrain

__all__ = ["CarOutline", "axle_places", "car_outlines"]

_BODY = 0.47
"""Half of a body as drawn, share of the vehicle's length: cars then stand apart."""


@dataclass(frozen=True)
class CarOutline:
    """A car as seen from the side.

    Attributes
    ----------
    body : tuple of float
        Rear and front end of its body, m from the bridge entrance.
    bogies : tuple of ndarray
        Places of the axles of each bogie, m, front to back.
    """

    body: tuple[float, float]
    bogies: tuple[np.ndarray, ...]


def axle_places(train: AnyTrain, position: float) -> np.ndarray:
    """Return the places of all axles, m, with the first one at `position`."""
    return position - np.array([axle.delay for axle in train.placed_axles])


def car_outlines(train: AnyTrain, position: float) -> list[CarOutline]:
    """Return the outline of every car with suspension, front to back; the first axle at `position`.

    Bare axle loads have none.
    """
    result = []
    for car in train.formation:
        if car.vehicle is None:
            continue
        middle, half = position - car.centre, _BODY * car.vehicle.length
        bogies: dict[str, list[float]] = {}
        for axle in car.axles:
            bogies.setdefault(axle.wheels[0].body, []).append(position - axle.delay)
        places = tuple(np.array(own) for own in bogies.values())
        result.append(CarOutline((middle - half, middle + half), places))
    return result
