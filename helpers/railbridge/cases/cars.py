"""Vehicles from a few parameters: the two-bogie car, a car in its plane, a sprung mass."""

from __future__ import annotations

from dataclasses import replace

from .. import errors
from ..contacts import CONTACT_STIFFNESS, HertzContact, with_wheelsets
from ..errors import InputError, Range, field_types, within
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
    "static_wheelset_mass": Range(least=0.0, unit="kg"),
    "secondary_longitudinal_stiffness": _STIFFNESS, "secondary_longitudinal_damping": _DAMPING,
    "wheelset_mass": Range(least=0.0, unit="kg"),
    "wheelset_roll_inertia": _INERTIA, "wheelset_yaw_inertia": _INERTIA,
    "gauge": Range(above=0.0, most=5.0, unit="m"),
    "primary_longitudinal_stiffness": _STIFFNESS, "primary_longitudinal_damping": _DAMPING,
    "contact_stiffness": CONTACT_STIFFNESS, "contact_lateral_stiffness": CONTACT_STIFFNESS,
    "contact_damping": _DAMPING,
    **{name: kind.range for name, kind in field_types(HertzContact).items()},
}  # fmt: skip
"""Names of a two-bogie car's parameters (Table 1) and what each may be, with its SI unit."""
_NAMES = tuple(CAR_PARAMETERS)
OPTIONAL_PARAMETERS = ("length", *_NAMES[_NAMES.index("static_wheelset_mass") :])
"""Those that may be left out."""
_OF_WHEELSETS = {
    name.removeprefix("primary_").removeprefix("wheelset_"): name
    for name in _NAMES[_NAMES.index("wheelset_mass") :]
}
"""What `with_wheelsets` calls the parameters of wheelsets with mass."""


def two_bogie_car(name: str, **parameters: float) -> Vehicle:
    """Build the 15-freedom car of Table 1 and Figure 1: a body on two bogies of two axles each.

    Parameters
    ----------
    name : str
    **parameters : float
        All of `CAR_PARAMETERS`, SI; ``length`` may be left out where trains are given their car
        spacing. Stiffness and damping are per spring: each bogie has two secondary springs (left
        and right), each axle two primary springs.
        Of wheelsets ``static_wheelset_mass`` counts the weight only, ``wheelset_mass`` makes bodies
        of them, each wheel on its contact spring, as `with_wheelsets` does: then also
        ``wheelset_roll_inertia`` is needed, and ``gauge``, ``contact_stiffness`` or the radii and
        the material of the contact, and ``primary_longitudinal_stiffness`` with
        ``wheelset_yaw_inertia`` may be given. Without either, or with 0, wheels are massless.

    Notes
    -----
    The paper gives no height above the rail. The primary springs are placed at rail level, so that
    the lateral wheel force acts there (no couple F_y times height on the deck). The centres of
    wheelsets are there, too: how high they are above the contact is neglected.
    """
    with within(source=f"vehicle {errors.text('name', name)}"):
        needed = [key for key in CAR_PARAMETERS if key not in OPTIONAL_PARAMETERS]
        errors.keys("", parameters, CAR_PARAMETERS, needed)
        p = {key: CAR_PARAMETERS[key].checked(key, value) for key, value in parameters.items()}
        _refuse_mixture(p)
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
        along = {}
        if lower != "rail":
            keys = ("longitudinal_stiffness", "longitudinal_damping")
            along = {key: p.get(f"{level}_{key}", 0.0) for key in keys}
        return Spring(upper, lower, at, stiffness, damping, **along)

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
    length, static = p.get("length"), p.get("static_wheelset_mass", 0.0)
    car = Vehicle(name, tuple(bodies), tuple(springs), length, static)
    if not p.get("wheelset_mass"):
        return car
    own = {said: p[key] for said, key in _OF_WHEELSETS.items() if key in p}
    with within("", _OF_WHEELSETS, f"vehicle {name}"):
        return with_wheelsets(car, **own)


def _refuse_mixture(p: dict[str, float]) -> None:
    """Refuse parameters of wheelsets that do not go together."""
    if p.get("static_wheelset_mass") and p.get("wheelset_mass"):
        remedy = "Give static_wheelset_mass for its weight only, wheelset_mass for its inertia too"
        allowed = "static_wheelset_mass is given too, never both"
        raise InputError("wheelset_mass", p["wheelset_mass"], allowed, remedy)
    if p.get("wheelset_mass") and "wheelset_roll_inertia" not in p:
        remedy = "Give it, kg m2; for the weight alone call the mass static_wheelset_mass"
        raise InputError("wheelset_roll_inertia", None, "is missing", remedy)
    if p.get("wheelset_mass"):
        return
    for key in _OF_WHEELSETS.values():
        if key in p and key != "wheelset_mass":
            allowed = "has no meaning without wheelset_mass: massless wheels stand on the rail"
            raise InputError(key, p[key], allowed, "Add wheelset_mass, or leave it out")


def sprung_mass(
    name: str, mass: float, stiffness: float, damping: float = 0.0, length: float = 10.0
) -> Vehicle:
    """Build a mass on a vertical spring and damper (kg, N/m, N s/m): the smallest vehicle."""
    body = Body("mass", mass, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    spring = Spring("mass", "rail", (0.0, 0.0, 0.0), (0.0, stiffness), (0.0, damping))
    return Vehicle(name, (body,), (spring,), length)


def planar_car(car: Vehicle) -> Vehicle:
    """Reduce a car to its vertical plane: bounce and pitch of every body, all springs at y = 0.

    Left and right springs are put together; those that are lateral only are left out, and so are
    anti-roll bars.
    """
    errors.instance("car", car, Vehicle)
    bodies = tuple(
        replace(b, freedoms=tuple(f for f in b.freedoms if f in ("z", "pitch"))) for b in car.bodies
    )
    together: dict[tuple, list[Spring]] = {}
    for s in car.springs:
        if s.stiffness[1] or s.damping[1] or s.longitudinal_stiffness or s.longitudinal_damping:
            # Dampers in series with a spring add up only if they relax alike.
            series = (s.series_stiffness or (0.0, 0.0))[1]
            relaxes = series / s.damping[1] if series else 0.0
            together.setdefault((s.from_, s.to, s.at[0], s.at[2], relaxes), []).append(s)
    springs = tuple(
        _put_together(own, from_, to, (x, 0.0, z)) for (from_, to, x, z, _), own in together.items()
    )
    return Vehicle(f"{car.name} planar", bodies, springs, car.length, car.static_wheelset_mass)


def _put_together(
    springs: list[Spring], from_: str, to: str, at: tuple[float, float, float]
) -> Spring:
    """Return springs side by side as one in the vertical plane."""
    series = sum(s.series_stiffness[1] for s in springs if s.series_stiffness)
    return Spring(
        from_, to, at,
        (0.0, sum(s.stiffness[1] for s in springs)), (0.0, sum(s.damping[1] for s in springs)),
        sum(s.longitudinal_stiffness for s in springs),
        sum(s.longitudinal_damping for s in springs),
        (0.0, series) if series else None,
    )  # fmt: skip
