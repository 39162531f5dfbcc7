"""Gravity, and the units in which people give their numbers."""

from __future__ import annotations

from typing import Any

from . import errors

__all__ = ["G", "MASSES", "PER_METRE", "UNITS", "quantity", "units_of"]

G = 9.81
"""Acceleration of gravity, m/s2."""

UNITS: dict[str, dict[str, float]] = {
    "number": {"": 1.0, "-": 1.0, "1": 1.0, "rad": 1.0, "%": 0.01},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "area": {"m2": 1.0},
    "second moment of area": {"m4": 1.0},
    "mass": {"kg": 1.0, "t": 1e3, "lb": 0.45359237, "slug": 14.593903},
    "mass per length": {"kg/m": 1.0, "t/m": 1e3},
    "density": {"kg/m3": 1.0},
    "moment of inertia": {"kg m2": 1.0, "t m2": 1e3},
    "force": {"N": 1.0, "kN": 1e3, "MN": 1e6},
    "stiffness": {"N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6},
    "damping": {"N s/m": 1.0, "kN s/m": 1e3},
    "bending stiffness": {"N m2": 1.0, "kN m2": 1e3},
    "stress": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
    "speed": {"m/s": 1.0, "km/h": 1 / 3.6},
    "time": {"s": 1.0, "ms": 1e-3},
    "frequency": {"Hz": 1.0},
}
"""Every unit by dimension, the SI unit first, with the factor that converts a number to SI."""

PER_METRE = {unit: 1.0 / factor for unit, factor in UNITS["length"].items()}
"""How many of each unit of length make a metre.

These are whole numbers in mm and cm, and dividing by 1000 rounds once where multiplying by 0.001
rounds twice.
"""

MASSES = UNITS["mass"]
"""Units of mass, kg."""


def units_of(dimension: str) -> tuple[str, ...]:
    """Return the names of the units of a dimension, the SI unit first.

    Parameters
    ----------
    dimension : str
        A key of `UNITS`: ``length``, ``mass``, ``force``, ...

    Raises
    ------
    InputError
        No such dimension; the nearest is suggested.
    """
    return tuple(UNITS[errors.choice("dimension", dimension, UNITS)])


def quantity(field: str, value: Any, unit: str, si_unit: str, **limits: Any) -> float:
    """Return a number given in `unit` converted to `si_unit`; refuse a unit of another dimension.

    Parameters
    ----------
    field : str
        What the number is, for messages.
    value : str or number
    unit : str
        Any unit of the dimension of `si_unit`; see `UNITS`.
    si_unit : str
    limits
        In SI; see `Range`.

    Raises
    ------
    InputError
        Unknown unit, unit of another dimension, no number, or a value outside the limits.
    """
    family = next(units for units in UNITS.values() if si_unit in units)
    if not isinstance(unit, str) or unit not in family:
        allowed = "must be one of " + ", ".join(name or "(none)" for name in family)
        remedy = "Correct the unit, and the value with it"
        raise errors.InputError(f"{field} (unit)", unit, allowed, remedy)
    try:
        raw = float(value)
    except (TypeError, ValueError):
        remedy = "Use a point as decimal mark and no thousands mark"
        raise errors.InputError(field, value, "must be a number", remedy) from None
    return errors.number(field, raw * family[unit], unit=si_unit, **limits)
