"""Vehicles from a few parameters: the two-bogie car, a car in its plane, a sprung mass."""

from __future__ import annotations

from dataclasses import replace

from .. import errors
from ..errors import InputError, Range, within
from ..vehicles import Body, Spring, Vehicle

__all__ = [
    "CAR_PARAMETERS", "OPTIONAL_PARAMETERS", "planar_car", "sprung_mass", "two_bogie_car",
]  # fmt: skip

_MASS, _INERTIA = Range(above=0.0, unit="kg"), Range(above=0.0, unit="kg m2")
_STIFFNESS, _DAMPING = Range(least=0.0, unit="N/m"), Range(least=0.0, unit="N s/m")
_LENGTH, _HEIGHT = Range(above=0.0, unit="m"), Range(unit="m")

CAR_PARAMETERS = {
    "car_body_mass": _MASS, "car_body_roll_inertia": _INERTIA, "car_body_pitch_inertia": _INERTIA,
    "car_body_yaw_inertia": _INERTIA, "bogie_mass": _MASS, "bogie_roll_inertia": _INERTIA,
    "bogie_pitch_inertia": _INERTIA, "bogie_yaw_inertia": _INERTIA,
    "primary_vertical_stiffness": _STIFFNESS, "primary_lateral_stiffness": _STIFFNESS,
    "secondary_vertical_stiffness": _STIFFNESS, "secondary_lateral_stiffness": _STIFFNESS,
    "primary_vertical_damping": _DAMPING, "primary_lateral_damping": _DAMPING,
    "secondary_vertical_damping": _DAMPING, "secondary_lateral_damping": _DAMPING,
    "length": _LENGTH, "bogie_spacing": _LENGTH, "axle_spacing": _LENGTH,
    "car_body_above_secondary": _HEIGHT, "secondary_above_bogie": _HEIGHT,
    "primary_below_bogie": _HEIGHT, "primary_half_width": _LENGTH, "secondary_half_width": _LENGTH,
    "wheelset_mass": Range(least=0.0, unit="kg"),
}  # fmt: skip
"""Names of a two-bogie car's parameters (Table 1) and what each may be, with its SI unit."""
OPTIONAL_PARAMETERS = ("length", "wheelset_mass")
"""Those that may be left out."""


def two_bogie_car(name: str, **parameters: float) -> Vehicle:
    """Build the 15-freedom car of Table 1 and Figure 1: a body on two bogies of two axles each.

    Parameters
    ----------
    name : str
    **parameters : float
        All of `CAR_PARAMETERS`, SI; ``length`` may be left out where trains are given their car
        spacing, ``wheelset_mass`` where it is neglected. Stiffness and damping are per spring: each
        bogie has two secondary springs (left and right), each axle two primary springs.

    Notes
    -----
    The paper gives no height above the rail. The primary springs are placed at rail level, so that
    the lateral wheel force acts there (no couple F_y times height on the deck).
    """
    with within(source=f"vehicle {errors.text('name', name)}"):
        needed = [key for key in CAR_PARAMETERS if key not in OPTIONAL_PARAMETERS]
        errors.keys("", parameters, CAR_PARAMETERS, needed)
        p = {key: CAR_PARAMETERS[key].checked(key, value) for key, value in parameters.items()}
    bogie_z = p["primary_below_bogie"]
    secondary_z = bogie_z + p["secondary_above_bogie"]
    if p["axle_spacing"] >= p["bogie_spacing"]:
        allowed = f"must be below bogie_spacing, {p['bogie_spacing']:g} m: bogies overlap"
        remedy = "It is the distance of the two axles of a bogie, in m"
        source = f"vehicle {name}"
        raise InputError("axle_spacing", p["axle_spacing"], allowed, remedy, source)
    inertia = {
        body: tuple(p[f"{body}_{rotation}_inertia"] for rotation in ("roll", "pitch", "yaw"))
        for body in ("car_body", "bogie")
    }

    def suspension(level: str, upper: str, lower: str, at: tuple[float, float, float]) -> Spring:
        stiffness, damping = (
            (p[f"{level}_lateral_{kind}"], p[f"{level}_vertical_{kind}"])
            for kind in ("stiffness", "damping")
        )
        return Spring(upper, lower, at, stiffness, damping)

    centre = (0.0, 0.0, secondary_z + p["car_body_above_secondary"])
    bodies = [Body("car", p["car_body_mass"], inertia["car_body"], centre)]
    springs = []
    for bogie, ahead in (("front bogie", 1.0), ("rear bogie", -1.0)):
        x = ahead * p["bogie_spacing"] / 2
        bodies.append(Body(bogie, p["bogie_mass"], inertia["bogie"], (x, 0.0, bogie_z)))
        for side in (1.0, -1.0):
            at = (x, side * p["secondary_half_width"], secondary_z)
            springs.append(suspension("secondary", "car", bogie, at))
        for axle in (1.0, -1.0):
            for side in (1.0, -1.0):
                at = (x + axle * p["axle_spacing"] / 2, side * p["primary_half_width"], 0.0)
                springs.append(suspension("primary", bogie, "rail", at))
    length, wheelset = p.get("length"), p.get("wheelset_mass", 0.0)
    return Vehicle(name, tuple(bodies), tuple(springs), length, wheelset)


def sprung_mass(
    name: str, mass: float, stiffness: float, damping: float = 0.0, length: float = 10.0
) -> Vehicle:
    """Build a mass on a vertical spring and damper (kg, N/m, N s/m): the smallest vehicle."""
    body = Body("mass", mass, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    spring = Spring("mass", "rail", (0.0, 0.0, 0.0), (0.0, stiffness), (0.0, damping))
    return Vehicle(name, (body,), (spring,), length)


def planar_car(car: Vehicle) -> Vehicle:
    """Reduce a car to its vertical plane: bounce and pitch of every body, all springs at y = 0.

    Left and right springs are put together; those that are lateral only are left out.
    """
    errors.instance("car", car, Vehicle)
    bodies = tuple(
        replace(b, freedoms=tuple(f for f in b.freedoms if f in ("z", "pitch"))) for b in car.bodies
    )
    together: dict[tuple, list[Spring]] = {}
    for s in car.springs:
        if s.stiffness[1] or s.damping[1]:
            together.setdefault((s.from_, s.to, s.at[0], s.at[2]), []).append(s)
    springs = tuple(
        Spring(
            from_, to, (x, 0.0, z),
            (0.0, sum(s.stiffness[1] for s in own)), (0.0, sum(s.damping[1] for s in own)),
        )
        for (from_, to, x, z), own in together.items()
    )  # fmt: skip
    return Vehicle(f"{car.name} planar", bodies, springs, car.length, car.static_wheelset_mass)
