"""What vehicles are made of: rigid bodies, springs with their dampers, and anti-roll bars.

Axes: x forward, y left, z up; freedoms in the order y, z, roll, pitch, yaw. Positions are in the
frame of the vehicle: its origin is at rail level below the vehicle's mid-length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from . import errors
from .errors import InputError, Range, check_fields

__all__ = ["FREEDOMS", "INERTIA_AXIS", "AntiRollBar", "Body", "Spring"]

FREEDOMS = ("y", "z", "roll", "pitch", "yaw")
INERTIA_AXIS = {"roll": 0, "pitch": 1, "yaw": 2}
"""Which of a body's three moments of inertia goes with a rotation."""


@dataclass(frozen=True)
class Body:
    """A rigid body.

    Attributes
    ----------
    name : str
        Its name, unique in the vehicle; not "rail".
    mass : float
        kg.
    inertia : tuple of 3 floats
        Mass moments of inertia in roll, pitch and yaw, kg m2. Only those of its freedoms count.
    position : tuple of 3 floats
        Centre of mass in the vehicle frame, m.
    freedoms : tuple of str
        Some of y, z, roll, pitch, yaw. One left out is held still in space: without z the rail does
        not carry the weight.
    """

    name: str
    mass: Annotated[float, Range(above=0.0, unit="kg")]
    inertia: Annotated[tuple[float, float, float], Range(least=0.0, unit="kg m2")]
    position: Annotated[tuple[float, float, float], Range(unit="m")]
    freedoms: tuple[str, ...] = FREEDOMS

    def __post_init__(self) -> None:
        check_fields(self)
        if self.name == "rail":
            raise InputError("name", self.name, "must not be 'rail', which is no body")
        given = self.freedoms
        distinct = len(set(map(str, given))) if isinstance(given, (list, tuple)) else 0
        if not distinct or distinct != len(given):
            allowed = f"must list each of {' '.join(FREEDOMS)} at most once"
            raise InputError("freedoms", given, allowed)
        for freedom in given:
            errors.choice("freedoms", freedom, FREEDOMS)
            if freedom in INERTIA_AXIS:
                inertia = self.inertia[INERTIA_AXIS[freedom]]
                errors.number(f"inertia in {freedom}", inertia, above=0.0, unit="kg m2")
        object.__setattr__(self, "freedoms", tuple(given))


@dataclass(frozen=True)
class Spring:
    """A spring and damper between two bodies, or between a body and the rail.

    Attributes
    ----------
    from_, to : str
        Names of bodies; one of them may be "rail", which makes a wheel contact.
    at : tuple of 3 floats
        Where it stands in the vehicle frame, m; rigidly tied to both ends.
    stiffness : tuple of 2 floats
        Lateral and vertical, N/m.
    damping : tuple of 2 floats
        Lateral and vertical, N s/m.
    longitudinal_stiffness : float
        Along the track, N/m: traction rods, guidance of wheelsets. Bodies do not move along the
        track of themselves, so it acts on pitch and yaw only. Not at the rail.
    longitudinal_damping : float
        Along the track, N s/m: yaw dampers. Not at the rail.
    series_stiffness : tuple of 2 floats, optional
        Lateral and vertical stiffness of the rubber or the mounting through which the damper acts,
        N/m; 0 where the damper acts straight. `stiffness` stands beside both. Not at the rail.

    Raises
    ------
    InputError
        A value out of its range, nothing that resists, a part along the track or a damper in series
        at the rail, or a series stiffness without a damper.
    """

    from_: str
    to: str
    at: Annotated[tuple[float, float, float], Range(unit="m")]
    stiffness: Annotated[tuple[float, float], Range(least=0.0, unit="N/m")]
    damping: Annotated[tuple[float, float], Range(least=0.0, unit="N s/m")]
    longitudinal_stiffness: Annotated[float, Range(least=0.0, unit="N/m")] = 0.0
    longitudinal_damping: Annotated[float, Range(least=0.0, unit="N s/m")] = 0.0
    series_stiffness: Annotated[tuple[float, float], Range(least=0.0, unit="N/m")] | None = None

    def __post_init__(self) -> None:
        check_fields(self)
        if self.from_ == self.to:
            raise InputError("to", self.to, "must differ from the other end")
        along = self.longitudinal_stiffness, self.longitudinal_damping
        if max(*self.stiffness, *self.damping, *along) == 0.0:
            allowed = "spring and damper are both zero"
            raise InputError("stiffness", list(self.stiffness), allowed, "Remove it")
        if self.on_rail:
            self._refuse_at_the_rail()
        for damping, series in zip(self.damping, self.series_stiffness or (), strict=False):
            if series and not damping:
                allowed = "there is no damper in that direction to stand in series with"
                remedy = "Give damping there, or 0 here"
                raise InputError("series_stiffness", list(self.series_stiffness), allowed, remedy)

    def _refuse_at_the_rail(self) -> None:
        for name in ("longitudinal_stiffness", "longitudinal_damping"):
            if getattr(self, name):
                allowed = "must be 0 at the rail: a wheel rolls"
                remedy = "Give it to the spring between bogie and wheelset"
                raise InputError(name, getattr(self, name), allowed, remedy)
        if self.series_stiffness is not None:
            allowed = "cannot be had at the rail: a contact has no damper in series"
            remedy = "Put a wheelset between, and give it to the spring above"
            raise InputError("series_stiffness", list(self.series_stiffness), allowed, remedy)

    @property
    def on_rail(self) -> bool:
        """Whether it makes a wheel contact."""
        return "rail" in (self.from_, self.to)

    @property
    def stiffnesses(self) -> tuple[float, float, float]:
        """Lateral, vertical and along the track, N/m."""
        return (*self.stiffness, self.longitudinal_stiffness)

    @property
    def straight_dampings(self) -> tuple[float, float, float]:
        """Of the dampers that act straight: lateral, vertical and along the track, N s/m."""
        series = self.series_stiffness or (0.0, 0.0)
        own = (0.0 if s else c for c, s in zip(self.damping, series, strict=True))
        return (*own, self.longitudinal_damping)

    @property
    def series(self) -> tuple[tuple[int, float, float], ...]:
        """Dampers in series with a spring: direction (0 lateral, 1 vertical), N/m, N s/m."""
        pairs = zip(self.series_stiffness or (), self.damping, strict=False)
        return tuple((i, k, c) for i, (k, c) in enumerate(pairs) if k)


@dataclass(frozen=True)
class AntiRollBar:
    """A torsion spring between the rolls of two bodies, as a bar across a bogie makes it.

    Attributes
    ----------
    from_, to : str
        Names of bodies; both roll.
    stiffness : float
        Moment about x for one body's roll against the other's, N m/rad.
    damping : float
        N m s/rad.

    Raises
    ------
    InputError
        A value out of its range, or an end at the rail.
    """

    from_: str
    to: str
    stiffness: Annotated[float, Range(above=0.0, unit="N m/rad")]
    damping: Annotated[float, Range(least=0.0, unit="N m s/rad")] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)
        if self.from_ == self.to:
            raise InputError("to", self.to, "must differ from the other end")
        for name, end in (("from_", self.from_), ("to", self.to)):
            if end == "rail":
                raise InputError(name, end, "must be a body: a bar joins two bodies that roll")
