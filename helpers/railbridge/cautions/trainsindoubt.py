"""What is unlikely to be meant about a train: loads, masses, suspension, places, notches."""

from __future__ import annotations

import numpy as np

from ..errors import InputWarning
from ..tracks import Notch
from ..trains import AnyTrain, AxleTrain, Train
from ..vehicles import Body, Vehicle
from .bounds import BOUNDS, doubt, worst

__all__ = ["of_train"]


def of_train(train: AnyTrain) -> list[InputWarning]:
    """Return what is unlikely to be meant about a train."""
    if isinstance(train, AxleTrain):
        return _of_axles(train)
    found = [warning for vehicle, _ in train.kinds() for warning in _of_vehicle(vehicle)]
    if isinstance(train, Train):
        found += _of_spacing(train)
    for i, notch in enumerate(train.notches, start=1):
        found += _of_notch(f"train.notches[{i}]", notch)
    return found


def _of_axles(train: AxleTrain) -> list[InputWarning]:
    found = doubt("axle_load", "train.loads", worst("axle_load", train.loads))
    gaps = np.diff(train.axles)
    if len(gaps):
        wrong = doubt("axle_gap", "train.axles", float(gaps.min()))
        wrong = wrong or doubt("axle_pause", "train.axles", float(gaps.max()))
        found += [InputWarning(w.field, f"stand apart by {w.text[2:]}") for w in wrong]
    return found


def _of_vehicle(vehicle: Vehicle) -> list[InputWarning]:
    """Return the first doubt about a vehicle's masses, suspension and places."""
    x = np.sort([axle.x for axle in vehicle.axles])
    base, gaps = float(x[-1] - x[0]), np.diff(x)
    load = sum(wheel.static_load for wheel in vehicle.contacts) / len(x)
    for body in vehicle.bodies:
        for wrong in _of_body(body, load):
            return [
                InputWarning(wrong.field, f"({vehicle.name}): mass of {body.name} {wrong.text}")
            ]
    light = min((body.mass for body in vehicle.wheelsets), default=None)
    checks = [
        ("mass of a wheelset", "wheelset_mass", light),
        ("weight over axles", "car_load", load or None),  # none without vertical freedoms
        ("smallest axle distance", "axle_gap", float(gaps.min()) if len(gaps) else None),
        ("largest axle distance", "axle_reach", float(gaps.max()) if len(gaps) else None),
        ("distance of wheels", "half_gauge", _half_gauge(vehicle)),
        *_of_wheelsets(vehicle),
        ("spring in series with a damper", "series_stiffness", _softest_in_series(vehicle)),
    ]
    for what, name, value in checks:
        for wrong in doubt(name, "train.vehicle", value):
            return [InputWarning(wrong.field, f"({vehicle.name}): {what} {wrong.text}")]
    lowest = float(vehicle.modes().frequencies_hz[0])
    if not BOUNDS["vehicle_frequency"].holds(lowest):
        text = f"({vehicle.name}): lowest frequency = {lowest:.3g} Hz, cars have 0.4 Hz and more: "
        return [InputWarning("train.vehicle", text + "springs given in kN/m?")]
    if vehicle.length and not BOUNDS["overhang"].holds(max(vehicle.length - base, 0.0)):
        text = f"({vehicle.name}): length = {vehicle.length:g} m, its wheel base is {base:g} m: "
        return [InputWarning("train.vehicle", text + "given in mm or cm?")]
    return []


def _half_gauge(vehicle: Vehicle) -> float | None:
    """Return what lies farthest beyond its bounds, m; None where all wheels stand at y = 0."""
    apart = [wheel.y for wheel in vehicle.contacts if wheel.y]
    return worst("half_gauge", apart) if apart else None


def _softest_in_series(vehicle: Vehicle) -> float | None:
    return min((k for spring in vehicle.springs for _, k, _ in spring.series), default=None)


def _of_wheelsets(vehicle: Vehicle) -> list[tuple[str, str, float]]:
    """Return what is held against `bounds` of wheelsets: words, name of the bound, value."""
    found = []
    for body in vehicle.wheelsets:
        own = [i for i, wheel in enumerate(vehicle.contacts) if wheel.body == body.name]
        k, c = vehicle.contact_stiffness[own, 1], vehicle.contact_damping[own, 1]
        for freedom, inertia in zip(("roll", "yaw"), body.inertia[::2], strict=True):
            if freedom in body.freedoms:
                words = f"radius of gyration of {body.name} in {freedom}"
                found.append((words, "wheelset_radius", float(np.sqrt(inertia / body.mass))))
        critical = 2 * np.sqrt(k.sum() * body.mass)
        found += [
            (f"height of {body.name}", "wheelset_height", body.position[2]),
            (f"contact of {body.name}", "contact_stiffness", worst("contact_stiffness", k)),
            (f"contact damping of {body.name}", "contact_damping", float(c.sum() / critical)),
        ]
    return found


def _of_body(body: Body, axle_load: float) -> list[InputWarning]:
    """Doubt a body's mass: by itself, or where the axles carry next to nothing (N)."""
    if 0.0 < axle_load < BOUNDS["axle_load"].low and 20.0 <= body.mass < 100.0:
        text = f"= {body.mass:g} kg, axles carry {axle_load:.3g} N: "
        return [InputWarning("train.vehicle", text + BOUNDS["body_mass"].slip(body.mass))]
    return doubt("body_mass", "train.vehicle", body.mass)


def _of_spacing(train: Train) -> list[InputWarning]:
    spacing = train.car_spacing
    lengths = [vehicle.length for vehicle in train.vehicles if vehicle.length]
    if spacing is None or len(train.vehicles) < 2 or not lengths:
        return []
    longest, axles = max(lengths), max(len(vehicle.axles) for vehicle in train.vehicles)
    text = f"= {spacing:g} m, cars are {longest:g} m long: "
    if spacing < longest - 0.5 and axles > 1:  # a mass on one spring has no length of its own
        return [InputWarning("train.car_spacing", text + "is it shorter than the car?")]
    if BOUNDS["overhang"].holds(max(spacing - longest, 0.0)):
        return []
    slips = ((10.0, "ten times too large"), (1e2, "given in cm"), (1e3, "given in mm"))
    likely = [words for k, words in slips if longest - 0.5 <= spacing / k <= 2 * longest]
    slip = likely[0] if likely else "is its decimal point right"
    return [InputWarning("train.car_spacing", f"{text}{slip}?")]


def _of_notch(field: str, notch: Notch) -> list[InputWarning]:
    found = doubt("notch_depth", f"{field}.depth", notch.depth)
    return found + doubt("circumference", f"{field}.circumference", notch.circumference)
