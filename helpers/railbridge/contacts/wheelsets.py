r"""Wheelsets with mass between the primary springs and the rail, each wheel on a contact spring.

A wheelset moves sideways and up and down and rolls; it yaws where springs along the track hold it,
and it does not pitch, since it turns as it rolls. The contact is Hertz's spring (`hertz`), straight
at the static load of the wheel. Wrong where a wheel comes near to lifting, or slides.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated, Any

import numpy as np

from .. import errors
from ..bodies import AntiRollBar, Body, Spring
from ..errors import InputError, Range, check_fields, within
from ..units import G
from ..vehicles import Axle, Vehicle
from .hertz import HertzContact

__all__ = ["CONTACT_STIFFNESS", "GAUGE", "Wheelset", "on_wheelsets", "with_wheelsets"]

GAUGE = 1.5
"""m between the points where the two wheels of a standard wheelset touch the rails."""
CONTACT_STIFFNESS = Range(
    least=1e6, most=1e12, unit="N/m", remedy="Steel on steel has about 1.3e9 N/m a wheel"
)
_USUAL = 1.2e9
"""N/m, of a wheel before its static load is known."""
_HERTZ = tuple(f.name for f in fields(HertzContact))
_WHEELS = 2
_BESIDE = 1e-6
"""m: places nearer than this are one."""


@dataclass(frozen=True)
class Wheelset:
    """An axle with its two wheels, and how they stand on the rails.

    Attributes
    ----------
    name : str
        Its name, unique among the bodies.
    x : float
        m ahead of the vehicle's mid-length.
    mass : float
        kg.
    roll_inertia : float
        kg m2. Needed unless gauge is 0.
    yaw_inertia : float
        kg m2. Left out: it does not yaw. It does only where springs along the track
        (`longitudinal_stiffness`) hold it.
    gauge : float
        m between the points where the two wheels touch the rails. 0 in the vertical plane: one
        contact at y = 0 stands for both wheels and is twice as stiff as one.
    height : float, optional
        Of its centre above the rail, m; default 0.46, or wheel_radius if that is given.
    contact_stiffness : tuple of 2 floats, optional
        Lateral and vertical stiffness of the contact, N/m per wheel. Or give radii and material.
    contact_damping : float
        Vertical damping of the contact, N s/m per wheel: what contact and rail take away.
    wheel_radius : float, optional
        Of the rolling circle, m; default 0.46. From the radii and the material follows the vertical
        stiffness by Hertz, at the static load of the wheel, and the lateral one by Mindlin.
    rail_head_radius : float, optional
        Of the top of the rail's section, m; default 0.3.
    contact_modulus : float, optional
        E of wheel and rail, Pa; default 2.1e11.
    contact_poisson : float, optional
        nu of wheel and rail; default 0.3.

    Raises
    ------
    InputError
        A value out of its range, no roll inertia off the plane, or both ways to give the contact.
    """

    name: str
    x: Annotated[float, Range(unit="m")]
    mass: Annotated[float, Range(above=0.0, unit="kg")]
    roll_inertia: Annotated[float, Range(least=0.0, unit="kg m2")] = 0.0
    yaw_inertia: Annotated[float, Range(least=0.0, unit="kg m2")] = 0.0
    gauge: Annotated[float, Range(least=0.0, most=5.0, unit="m")] = GAUGE
    height: Annotated[float, Range(unit="m")] | None = None
    contact_stiffness: Annotated[tuple[float, float], Range(least=0.0, unit="N/m")] | None = None
    contact_damping: Annotated[float, Range(least=0.0, unit="N s/m")] = 0.0
    wheel_radius: Annotated[float, Range(least=0.05, most=5.0, unit="m")] | None = None
    rail_head_radius: Annotated[float, Range(least=0.05, most=5.0, unit="m")] | None = None
    contact_modulus: Annotated[float, Range(least=1e9, most=1e12, unit="Pa")] | None = None
    contact_poisson: Annotated[float, Range(least=0.0, most=0.499)] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.gauge and not self.roll_inertia:
            remedy = "Give it, kg m2, or gauge = 0 for a vehicle in the vertical plane"
            raise InputError("roll_inertia", None, "is needed: the wheelset rolls", remedy)
        if not self.gauge:
            for name in ("roll_inertia", "yaw_inertia"):
                if getattr(self, name):
                    allowed = "has no meaning in the vertical plane, gauge = 0"
                    raise InputError(name, getattr(self, name), allowed, "Leave it out")
        _refuse_both_contacts(self.contact_stiffness, _given(self))
        if self.contact_stiffness is not None:
            lateral, vertical = self.contact_stiffness
            CONTACT_STIFFNESS.checked("contact_stiffness[2]", vertical)
            if lateral:
                CONTACT_STIFFNESS.checked("contact_stiffness[1]", lateral)

    @property
    def sideways(self) -> bool:
        """Whether it moves sideways."""
        return self.gauge > 0.0 if self.contact_stiffness is None else self.contact_stiffness[0] > 0

    def standing(self, load: float) -> Wheelset:
        """Return it with the stiffness of its contact at the static load of a wheel, N."""
        if self.contact_stiffness is not None:
            return self
        hertz = HertzContact(**_given(self))
        vertical = hertz.stiffness(load)
        lateral = hertz.lateral_share * vertical * self.sideways
        height = self.wheel_radius if self.height is None else self.height
        none = dict.fromkeys(_HERTZ)
        return replace(self, contact_stiffness=(lateral, vertical), height=height, **none)

    @property
    def body(self) -> Body:
        """It as a body."""
        turns = {"roll": self.roll_inertia, "yaw": self.yaw_inertia}
        freedoms = ("y",) * self.sideways + ("z", *(f for f, inertia in turns.items() if inertia))
        height = HertzContact().wheel_radius if self.height is None else self.height
        inertia = self.roll_inertia, 0.0, self.yaw_inertia
        return Body(self.name, self.mass, inertia, (self.x, 0.0, height), freedoms)

    @property
    def contacts(self) -> tuple[Spring, ...]:
        """Its contacts, left before right; needs their stiffness, see `standing`."""
        places = (self.gauge / 2, -self.gauge / 2) if self.gauge else (0.0,)
        wheels = _WHEELS / len(places)
        lateral, vertical = (wheels * k for k in self.contact_stiffness)
        damping = 0.0, wheels * self.contact_damping
        return tuple(
            Spring(self.name, "rail", (self.x, y, 0.0), (lateral, vertical), damping)
            for y in places
        )


def _given(thing: Any) -> dict[str, float]:
    """Return what is said of Hertz's contact."""
    said = thing if isinstance(thing, Mapping) else vars(thing)
    return {name: said[name] for name in _HERTZ if said.get(name) is not None}


def _refuse_both_contacts(stiffness: Any, hertz: Mapping[str, float]) -> None:
    if stiffness is not None and hertz:
        name = next(iter(hertz))
        allowed = "contact_stiffness is given too, never both"
        raise InputError(name, hertz[name], allowed, "Remove one: the contact follows from either")


def on_wheelsets(
    name: str,
    bodies: Sequence[Body],
    springs: Sequence[Spring],
    wheelsets: Sequence[Wheelset],
    length: float | None = None,
    anti_roll_bars: Sequence[AntiRollBar] = (),
) -> Vehicle:
    """Build a vehicle that stands on wheelsets; springs may end at their names.

    Parameters
    ----------
    name : str
    bodies, springs, anti_roll_bars, length
        See `Vehicle`.
    wheelsets : sequence of Wheelset

    Raises
    ------
    InputError
        See `Vehicle`.
    """

    def standing(loads: Mapping[str, float] | None) -> Vehicle:
        known = []
        for i, wheelset in enumerate(wheelsets, start=1):
            with within(f"wheelsets[{i}]"):
                if loads is not None:
                    known.append(wheelset.standing(loads[wheelset.name]))
                elif wheelset.contact_stiffness is None:
                    # Standing in: what a wheel carries hardly depends on the contacts.
                    usual = _USUAL * wheelset.sideways, _USUAL
                    none = dict.fromkeys(_HERTZ)
                    known.append(replace(wheelset, contact_stiffness=usual, **none))
                else:
                    known.append(wheelset)
        own = [wheelset.body for wheelset in known]
        contacts = [spring for wheelset in known for spring in wheelset.contacts]
        every = (*springs, *contacts)
        bars = tuple(anti_roll_bars)
        return Vehicle(name, (*bodies, *own), every, length, anti_roll_bars=bars)

    _refuse_names(bodies, springs, wheelsets)
    vehicle = standing(None)
    if all(wheelset.contact_stiffness is not None for wheelset in wheelsets):
        return vehicle
    loads = dict.fromkeys((wheelset.name for wheelset in wheelsets), 0.0)
    for contact in vehicle.contacts:
        if contact.body in loads:
            loads[contact.body] += contact.static_load / _WHEELS
    with within(source=f"vehicle {name}"):
        return standing(loads)


def _refuse_names(
    bodies: Sequence[Body], springs: Sequence[Spring], wheelsets: Sequence[Wheelset]
) -> None:
    names = [wheelset.name for wheelset in wheelsets]
    taken = {body.name for body in bodies}
    ends = {end for spring in springs for end in (spring.from_, spring.to)}
    for i, name in enumerate(names, start=1):
        if names.count(name) > 1:
            raise InputError(f"wheelsets[{i}].name", name, "must be unique")
        if name in taken:
            remedy = "Give the wheelset another one, and its springs, too"
            raise InputError(f"wheelsets[{i}].name", name, "is the name of a body", remedy)
        if name not in ends:
            remedy = "Give a spring from the body in which it hangs to this name"
            raise InputError(f"wheelsets[{i}].name", name, "no spring ends there", remedy)


def with_wheelsets(
    vehicle: Vehicle,
    *,
    mass: float | None = None,
    roll_inertia: float | None = None,
    yaw_inertia: float | None = None,
    gauge: float | None = None,
    height: float | None = None,
    contact_stiffness: float | None = None,
    contact_lateral_stiffness: float | None = None,
    contact_damping: float = 0.0,
    wheel_radius: float | None = None,
    rail_head_radius: float | None = None,
    contact_modulus: float | None = None,
    contact_poisson: float | None = None,
    longitudinal_stiffness: float = 0.0,
    longitudinal_damping: float = 0.0,
) -> Vehicle:
    """Return a vehicle of massless wheels with wheelsets between its springs and the rail.

    The springs that ended on the rail end on the wheelset of their axle; the wheels stand at
    +-gauge/2, or at y = 0 as before where left and right are put together. As the mass goes to 0
    and the contact becomes stiff, forces tend to those of the vehicle as it was, if gauge and
    height leave the wheels where its springs stand.

    Parameters
    ----------
    vehicle : Vehicle
    mass : float, optional
        kg of one wheelset; default the vehicle's `static_wheelset_mass`.
    roll_inertia : float, optional
        kg m2; needed where an axle has a left and a right wheel.
    yaw_inertia : float, optional
        kg m2; needed with `longitudinal_stiffness` there, and refused without, since nothing would
        hold the wheelset.
    gauge : float, optional
        m between the points where the wheels touch the rails; default 1.5. Not in the plane.
    height : float, optional
        Of the wheelset's centre, m; default that of the springs. The lateral force acts at rail
        level, z = 0.
    contact_stiffness, contact_lateral_stiffness : float, optional
        N/m per wheel. Without the first Hertz's contact counts; without the second Mindlin's share
        of the vertical stiffness.
    contact_damping : float
        N s/m per wheel, vertical.
    wheel_radius, rail_head_radius, contact_modulus, contact_poisson : float, optional
        See `HertzContact`; defaults 0.46 m, 0.3 m, 210 GPa, 0.3.
    longitudinal_stiffness, longitudinal_damping : float
        Along the track, of each spring above the wheelset, N/m and N s/m.

    Returns
    -------
    Vehicle
        Its static loads are those of `static_wheelset_mass` = mass.

    Raises
    ------
    InputError
        A vehicle that has wheelsets already, no mass, or a value that does not go with another.
    """
    errors.instance("vehicle", vehicle, Vehicle)
    if vehicle.wheelsets:
        names = ", ".join(body.name for body in vehicle.wheelsets)
        raise InputError("vehicle", vehicle.name, f"has wheelsets already: {names}")
    if mass is None:
        mass = vehicle.static_wheelset_mass or None
    if mass is None:
        remedy = "Give it in kg: the vehicle has no static_wheelset_mass"
        raise InputError("mass", None, "is missing", remedy)
    mass = errors.number("mass", mass, above=0.0, unit="kg")
    along = {
        "longitudinal_stiffness": longitudinal_stiffness,
        "longitudinal_damping": longitudinal_damping,
    }
    own = _Axles(
        vehicle,
        {"mass": mass, "roll_inertia": roll_inertia, "yaw_inertia": yaw_inertia},
        gauge,
        height,
        (contact_lateral_stiffness, contact_stiffness),
        {
            "wheel_radius": wheel_radius, "rail_head_radius": rail_head_radius,
            "contact_modulus": contact_modulus, "contact_poisson": contact_poisson,
        },
        {name: errors.number(name, k, least=0.0) for name, k in along.items()},
        errors.number("contact_damping", contact_damping, least=0.0, unit="N s/m"),
    )  # fmt: skip
    return own.on_wheelsets()


@dataclass(frozen=True)
class _Axles:
    """What `with_wheelsets` is given."""

    vehicle: Vehicle
    inertia: Mapping[str, float | None]
    gauge: float | None
    height: float | None
    stiffness: tuple[float | None, float | None]
    hertz: Mapping[str, float | None]
    along: Mapping[str, float]
    damping: float

    def __post_init__(self) -> None:
        known = {name: v for name, v in self.hertz.items() if v is not None}
        _refuse_both_contacts(self.stiffness[1], known)
        for name, value in zip(
            ("contact_lateral_stiffness", "contact_stiffness"), self.stiffness, strict=True
        ):
            if value is not None:
                CONTACT_STIFFNESS.checked(name, value)
        if self.gauge is not None:
            errors.number("gauge", self.gauge, above=0.0, most=5.0, unit="m")
        stiffness, damping = self.along.values()
        wide = any(self._wide(axle) for axle in self.vehicle.axles)
        yaw = self.inertia["yaw_inertia"]
        if yaw is not None and not (wide and stiffness):
            allowed = "nothing holds the wheelset in yaw"
            remedy = "Give the springs above it a stiffness along the track, or leave it out"
            raise InputError("yaw_inertia", yaw, allowed, remedy)
        if wide and stiffness and yaw is None:
            remedy = "Give it, kg m2: springs along the track let the wheelset yaw"
            raise InputError("yaw_inertia", None, "is missing", remedy)
        if damping and not stiffness:
            allowed = "needs a stiffness along the track, without which the wheelset does not yaw"
            raise InputError("longitudinal_damping", damping, allowed)
        for name in ("roll_inertia", "yaw_inertia"):
            if self.inertia[name] is not None:
                errors.number(name, self.inertia[name], above=0.0, unit="kg m2")
        if wide and self.inertia["roll_inertia"] is None:
            remedy = "Give it, kg m2: a wheelset with a left and a right wheel rolls"
            raise InputError("roll_inertia", None, "is missing", remedy)
        if not wide:
            for name, value in (("gauge", self.gauge), *self.inertia.items()):
                if name != "mass" and value is not None:
                    allowed = "has no meaning where left and right wheels are put together"
                    raise InputError(name, value, allowed, "Leave it out")

    def on_wheelsets(self) -> Vehicle:
        vehicle, wheelsets, moved = self.vehicle, [], {}
        for number, axle in enumerate(vehicle.axles, start=1):
            springs = [s for s in vehicle.springs if s.on_rail and _beside(s, axle)]
            name = self._name(axle, number, [w.name for w in wheelsets])
            wheelsets.append(self._wheelset(name, axle, springs))
            for s in springs:
                upper = s.to if s.from_ == "rail" else s.from_
                moved[id(s)] = replace(s, from_=upper, to=name, **self.along)
        springs = tuple(moved.get(id(s), s) for s in vehicle.springs)
        rest = vehicle.length, vehicle.anti_roll_bars
        return on_wheelsets(vehicle.name, vehicle.bodies, springs, wheelsets, *rest)

    def _wide(self, axle: Axle) -> bool:
        """Whether an axle has a left and a right wheel."""
        y = [self.vehicle.contacts[w].y for w in axle.wheels]
        return max(y) - min(y) > _BESIDE

    def _name(self, axle: Axle, number: int, taken: Sequence[str]) -> str:
        upper = {self.vehicle.contacts[w].body for w in axle.wheels}
        if len(upper) > 1:
            return f"wheelset {number}"
        stem = f"{upper.pop().removesuffix(' bogie')} wheelset"
        return f"{stem} {1 + sum(name.startswith(f'{stem} ') for name in taken)}"

    def _wheelset(self, name: str, axle: Axle, springs: Sequence[Spring]) -> Wheelset:
        wide = self._wide(axle)
        inertia = {key: value for key, value in self.inertia.items() if value is not None}
        if not wide:
            inertia = {"mass": inertia["mass"]}
        height = float(np.mean([s.at[2] for s in springs])) if self.height is None else self.height
        sideways = any(s.stiffness[0] or s.damping[0] for s in springs)
        gauge = (self.gauge or GAUGE) * wide
        pair = self._contact(axle, sideways)
        contact = {"contact_stiffness": pair, "contact_damping": self.damping}
        return Wheelset(name, axle.x, gauge=gauge, height=height, **contact, **inertia)

    def _contact(self, axle: Axle, sideways: bool) -> tuple[float, float]:
        """Return lateral and vertical stiffness of a wheel of an axle, N/m."""
        lateral, vertical = self.stiffness
        hertz = HertzContact(**_given(self.hertz))
        if vertical is None:
            vehicle, mass = self.vehicle, self.inertia["mass"]
            load = sum(vehicle.contacts[w].static_load for w in axle.wheels)
            load += (mass - vehicle.static_wheelset_mass) * G
            vertical = hertz.stiffness(load / _WHEELS)
        if lateral is None:
            lateral = hertz.lateral_share * vertical
        return lateral * sideways, vertical


def _beside(spring: Spring, axle: Axle) -> bool:
    return abs(spring.at[0] - axle.x) <= _BESIDE
