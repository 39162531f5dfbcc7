"""What every car of a train comes to: extremes of its wheels and bodies, with place and time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .decks import History
from .errors import brief
from .trains import Car
from .units import without_rounding

__all__ = [
    "QUANTITIES",
    "CarExtremes",
    "PerCar",
    "extremes",
    "held_sideways",
    "of_car",
    "of_wheels",
]

QUANTITIES = {
    "wheel_force_z": "N", "wheel_force_y": "N", "wheel_unloading": "-",
    "lateral_over_vertical": "-", "acceleration_z": "m/s2", "acceleration_y": "m/s2",
}  # fmt: skip
"""What is told of every car, with units."""

_SIDES = {"wheel_unloading": ("max",), "lateral_over_vertical": ("max",)}
_BOTH = ("min", "max")
# A wheel that presses with less than this share of its static load has come off the rail.
_PARTED = 1e-6


@dataclass(frozen=True, eq=False)
class CarExtremes:
    """Extremes of one car.

    Attributes
    ----------
    car : int
        From 1.
    vehicle : str
        Its name.
    extremes : dict
        By name as in `QUANTITIES`: ``min`` and ``max``, each with ``value``, ``t`` (s) and its
        place: ``wheel``, or ``place`` and, of an articulated car, ``body``; None where the car has
        none of it. ``wheel_unloading`` and ``lateral_over_vertical`` have a ``max`` only. What is
        of wheels stands in ``on_deck`` once more, for the wheels on the deck.
    """

    car: int
    vehicle: str
    extremes: dict[str, dict[str, Any] | None]


@dataclass(frozen=True, eq=False)
class PerCar:
    """Extremes of every car of a train.

    Attributes
    ----------
    cars : tuple of CarExtremes
        Front to back; empty for bare axle loads, which are no cars.
    """

    __repr__ = brief

    cars: tuple[CarExtremes, ...] = field(repr=False)

    def to_frame(self):
        """Return a pandas DataFrame with one row a car; NaN for what a car has none of.

        Its columns are named as in the summary, ``wheel_force_z min (N)`` being the heaviest wheel,
        and over the whole record where they do not say ``on deck``.
        """
        import pandas as pd

        columns: dict[str, list] = {"vehicle": [car.vehicle for car in self.cars]}
        for name, unit in QUANTITIES.items():
            for more in ("", " on deck")[: 1 if name.startswith("acceleration") else 2]:
                for side in _SIDES.get(name, _BOTH):
                    values = [_value(car.extremes[name], side, bool(more)) for car in self.cars]
                    columns[f"{name} {side}{more} ({unit})"] = np.array(values, dtype=float)
        index = pd.Index([car.car for car in self.cars], name="car", dtype=int)
        return pd.DataFrame(columns, index=index)


def _value(found: dict[str, Any] | None, side: str, on_deck: bool) -> float:
    found = found["on_deck"] if found and on_deck else found
    return found[side]["value"] if found and found[side] else np.nan


# ---- extremes


def extremes(
    values: np.ndarray, time: np.ndarray, unit: str, places: Sequence[dict] = ({},)
) -> dict[str, Any] | None:
    """Return ``min`` and ``max`` of histories, each with value, ``t`` (s) and place.

    Parameters
    ----------
    values : ndarray, shape (places, n), or (n,)
    time : ndarray, shape (n,)
    unit : str
        Of the values; see `units.without_rounding`.
    places : sequence of dict
        What is said of each place.

    Returns
    -------
    dict or None
        None where no value is finite.
    """
    values = without_rounding(values.reshape(len(places), -1), unit)
    finite = np.isfinite(values)
    if not finite.any():
        return None
    result = {}
    for name, find, beyond in (("min", np.argmin, np.inf), ("max", np.argmax, -np.inf)):
        found = find(np.where(finite, values, beyond))
        where, when = np.unravel_index(found, values.shape)
        value, t = values[where, when], round(float(time[when]), 9)
        result[name] = {"value": value, "t": t, **places[where]}
    return result


def of_wheels(
    name: str, values: np.ndarray, on_deck: np.ndarray, time: np.ndarray, places: Sequence[dict]
) -> dict[str, Any] | None:
    """Return the extremes of what wheels have, and in ``on_deck`` those of wheels on the deck.

    Parameters
    ----------
    name : str
        One of `QUANTITIES`.
    values : ndarray, shape (wheels, n)
    on_deck : ndarray of bool, shape (wheels, n)
    time : ndarray, shape (n,)
    places : sequence of dict
        What is said of each wheel.

    Returns
    -------
    dict or None
        None where no value is finite.
    """
    whole, within = (
        extremes(v, time, QUANTITIES[name], places)
        for v in (values, np.where(on_deck, values, np.nan))
    )
    sides = _SIDES.get(name, _BOTH)
    whole, within = (
        None if found is None else {side: found[side] for side in sides}
        for found in (whole, within)
    )
    return whole and whole | {"on_deck": within}


def held_sideways(car: Car) -> np.ndarray:
    """Return whether springs or dampers hold every wheel of a car sideways, shape (its wheels,).

    Those of planar vehicles and of bare axle loads are not held: they have no lateral force.
    """
    if car.vehicle is None:
        return np.zeros(len(car.wheels), dtype=bool)
    of_contacts = car.vehicle.contact_stiffness, car.vehicle.contact_damping
    held = np.any([each[:, 0] != 0.0 for each in of_contacts], axis=0)
    return held[[wheel.number - 1 for wheel in car.wheels]]


def of_car(
    car: Car,
    forces: np.ndarray,
    unloading: np.ndarray,
    on_deck: np.ndarray,
    accelerations: History,
) -> CarExtremes:
    """Return the extremes of one car of a crossing.

    Parameters
    ----------
    car : Car
    forces : ndarray, shape (its wheels, 2, n)
        N, on the deck, static part included; lateral, vertical.
    unloading, on_deck : ndarray, shape (its wheels, n)
        See `Crossing.wheel_unloading`, `Crossing.on_deck`.
    accelerations : History
        See `Crossing.car_accelerations`.

    Notes
    -----
    ``lateral_over_vertical`` is the lateral force of a wheel's spring over the load of that wheel,
    sizes, while it presses on the rail. It is no verdict on running safety: a wheel here has
    neither flange nor creep, so its lateral force is that of a spring between axle and rail. Where
    a wheel is almost unloaded it grows without bound and says nothing.
    """
    time = accelerations.time
    wheels = [{"wheel": wheel.number} for wheel in car.wheels]
    lateral = np.where(held_sideways(car)[:, None], forces[:, 0], np.nan)
    static = np.array([[wheel.static_load] for wheel in car.wheels])
    load = np.where(forces[:, 1] < -_PARTED * static, -forces[:, 1], np.nan)
    found: dict[str, Any] = {}
    for name, values in (
        ("wheel_force_z", forces[:, 1]), ("wheel_force_y", lateral),
        ("wheel_unloading", unloading), ("lateral_over_vertical", np.abs(lateral) / load),
    ):  # fmt: skip
        found[name] = of_wheels(name, values, on_deck, time, wheels)
    for name in ("acceleration_z", "acceleration_y"):
        own = [history for history in accelerations.values if history.endswith(name)]
        values = np.array([accelerations[history] for history in own])
        found[name] = extremes(values, time, QUANTITIES[name], [_place(h) for h in own])
    return CarExtremes(car.number, car.vehicle.name, found)


def _place(history: str) -> dict[str, str]:
    """Return the place that the name of a body's history says, and the body if it says one."""
    *body, place, _ = history.rsplit(" ", 2)
    return {"place": place} | ({"body": body[0]} if body else {})
