"""Vehicles from parameters, tables and files: the two-bogie car, a sprung mass, a car in its plane, any bodies on springs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from . import inputs
from .inputs import InputError
from .vehicle import FREEDOMS, Body, Spring, Vehicle

__all__ = ["CAR_PARAMETERS", "from_table", "planar_car", "sprung_mass", "two_bogie_car", "vehicle"]

CAR_PARAMETERS = {
    "car_body_mass": "kg", "car_body_roll_inertia": "kg m2", "car_body_pitch_inertia": "kg m2", "car_body_yaw_inertia": "kg m2",
    "bogie_mass": "kg", "bogie_roll_inertia": "kg m2", "bogie_pitch_inertia": "kg m2", "bogie_yaw_inertia": "kg m2",
    "primary_vertical_stiffness": "N/m", "primary_lateral_stiffness": "N/m",
    "secondary_vertical_stiffness": "N/m", "secondary_lateral_stiffness": "N/m",
    "primary_vertical_damping": "N s/m", "primary_lateral_damping": "N s/m",
    "secondary_vertical_damping": "N s/m", "secondary_lateral_damping": "N s/m",
    "length": "m", "bogie_spacing": "m", "axle_spacing": "m",
    "car_body_above_secondary": "m", "secondary_above_bogie": "m", "primary_below_bogie": "m",
    "primary_half_width": "m", "secondary_half_width": "m",
}  # fmt: skip
"""Names of a two-bogie car's parameter table (Table 1) with their SI units."""


def two_bogie_car(name: str, **p: float) -> Vehicle:
    """Build the 15-freedom car of Table 1 and Figure 1: a car body on two bogies, each on two axles.

    Parameters
    ----------
    name : str
    **p : float
        The values of `CAR_PARAMETERS`, SI. Stiffness and damping are per spring: each bogie has two secondary springs (left
        and right), each axle two primary springs.

    Notes
    -----
    The paper gives no height above the rail. The primary springs are placed at rail level, so that the lateral wheel
    force acts there (no couple F_y times height on the deck).
    """
    inputs.keys(f"vehicle {name}", p, CAR_PARAMETERS, CAR_PARAMETERS)
    for key in ("length", "bogie_spacing", "axle_spacing", "primary_half_width", "secondary_half_width"):
        inputs.number(f"vehicle {name}: {key}", p[key], above=0.0, unit="m")
    bogie_z = p["primary_below_bogie"]
    secondary_z = bogie_z + p["secondary_above_bogie"]
    inertia = {b: tuple(p[f"{b}_{r}_inertia"] for r in ("roll", "pitch", "yaw")) for b in ("car_body", "bogie")}
    bodies = [Body("car", p["car_body_mass"], inertia["car_body"], (0.0, 0.0, secondary_z + p["car_body_above_secondary"]))]
    springs = []
    for bogie, sign in (("front bogie", 1.0), ("rear bogie", -1.0)):
        x = sign * p["bogie_spacing"] / 2
        bodies.append(Body(bogie, p["bogie_mass"], inertia["bogie"], (x, 0.0, bogie_z)))
        for side in (1.0, -1.0):
            at = (x, side * p["secondary_half_width"], secondary_z)
            springs.append(_suspension("secondary", "car", bogie, at, p))
        for axle in (1.0, -1.0):
            for side in (1.0, -1.0):
                at = (x + axle * p["axle_spacing"] / 2, side * p["primary_half_width"], 0.0)
                springs.append(_suspension("primary", bogie, "rail", at, p))
    return Vehicle(name, tuple(bodies), tuple(springs), p["length"])


def _suspension(level: str, upper: str, lower: str, at: tuple[float, float, float], p: dict[str, float]) -> Spring:
    stiffness, damping = ((p[f"{level}_lateral_{w}"], p[f"{level}_vertical_{w}"]) for w in ("stiffness", "damping"))
    return Spring(upper, lower, at, stiffness, damping)


def sprung_mass(name: str, mass: float, stiffness: float, damping: float = 0.0, length: float = 10.0) -> Vehicle:
    """Build a mass on a vertical spring and damper (kg, N/m, N s/m): the smallest vehicle."""
    body = Body("mass", mass, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    return Vehicle(name, (body,), (Spring("mass", "rail", (0.0, 0.0, 0.0), (0.0, stiffness), (0.0, damping)),), length)


def planar_car(car: Vehicle) -> Vehicle:
    """Reduce a car to its vertical plane: bounce and pitch of every body, left and right springs put together at y = 0.

    Springs that are lateral only are left out.
    """
    bodies = tuple(replace(b, freedoms=tuple(f for f in b.freedoms if f in ("z", "pitch"))) for b in car.bodies)
    joined: dict[tuple, Spring] = {}
    for s in car.springs:
        if s.stiffness[1] == s.damping[1] == 0.0:
            continue
        key = (s.from_, s.to, s.at[0], s.at[2])
        before = joined.get(key, Spring(s.from_, s.to, (s.at[0], 0.0, s.at[2]), (0.0, 0.0), (0.0, 0.0)))
        total = (0.0, before.stiffness[1] + s.stiffness[1]), (0.0, before.damping[1] + s.damping[1])
        joined[key] = Spring(s.from_, s.to, before.at, *total)
    return Vehicle(f"{car.name} planar", bodies, tuple(joined.values()), car.length, car.static_wheelset_mass)


def vehicle(source: str | Path) -> Vehicle:
    """Load a vehicle by shipped name (``xia2000``) or from a ``.csv`` or ``.toml`` file.

    A CSV file is a two-bogie car's parameter table like Table 1; a TOML file lists the bodies and springs of any linear
    vehicle. Both are described in the README.

    Raises
    ------
    InputError
        Unknown name, a name that exists as both CSV and TOML, or bad content.
    """
    path = inputs.data_file("vehicles", source)
    if path.suffix == ".csv":
        return two_bogie_car(path.stem, **inputs.read_parameters(path, CAR_PARAMETERS))
    return from_table(path.stem, inputs.read_toml(path))


def from_table(name: str, content: dict) -> Vehicle:
    """Build a vehicle from the content of a TOML file: ``length``, ``[[body]]``, ``[[spring]]``.

    Raises
    ------
    InputError
        Missing, unknown or wrong keys, each named with its path.
    """
    where = f"vehicle {name}"
    inputs.keys(where, content, ["name", "source", "note", "static_wheelset_mass"], ["length", "body", "spring"])
    bodies, springs = [], []
    for kind in ("body", "spring"):
        if not isinstance(content[kind], list) or not content[kind]:
            raise InputError(f"{where}: {kind}", content[kind], f"must be one or more [[{kind}]] tables")
    for i, raw in enumerate(content["body"], start=1):
        here = f"{where}: body {i}"
        b = inputs.table(here, raw)
        inputs.keys(here, b, ["inertia"], ["name", "mass", "position", "freedoms"])
        freedoms = b["freedoms"].split() if isinstance(b["freedoms"], str) else b["freedoms"]
        if not isinstance(freedoms, list) or not freedoms or len(set(map(str, freedoms))) != len(freedoms):
            raise InputError(f"{here}: freedoms", b["freedoms"], "must list each of " + " ".join(FREEDOMS) + " at most once")
        position = tuple(inputs.numbers(f"{here}: position", b["position"], count=3))
        inertia = tuple(inputs.numbers(f"{here}: inertia", b.get("inertia", [0.0, 0.0, 0.0]), count=3))
        bodies.append(Body(inputs.text(f"{here}: name", b["name"]), b["mass"], inertia, position, tuple(freedoms)))
    for i, raw in enumerate(content["spring"], start=1):
        here = f"{where}: spring {i}"
        s = inputs.table(here, raw)
        inputs.keys(here, s, ["damping"], ["from", "to", "at", "stiffness"])
        at = tuple(inputs.numbers(f"{here}: at", s["at"], count=3))
        pair = [tuple(inputs.numbers(f"{here}: {w}", s.get(w, [0.0, 0.0]), count=2)) for w in ("stiffness", "damping")]
        springs.append(Spring(s["from"], s["to"], at, *pair))
    mass = content.get("static_wheelset_mass", 0.0)
    return Vehicle(name, tuple(bodies), tuple(springs), content["length"], mass)
