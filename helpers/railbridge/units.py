"""Gravity, and the units in which people give their numbers."""

from __future__ import annotations

from typing import Any

from . import errors

__all__ = ["G", "quantity"]

G = 9.81
"""Acceleration of gravity, m/s2."""


_UNITS = {
    "": 1.0, "-": 1.0, "1": 1.0, "rad": 1.0, "%": 0.01,
    "m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3,
    "m2": 1.0, "m4": 1.0,
    "kg": 1.0, "t": 1e3, "kg m2": 1.0, "t m2": 1e3, "kg/m": 1.0, "t/m": 1e3, "kg/m3": 1.0,
    "N": 1.0, "kN": 1e3, "MN": 1e6, "N m2": 1.0, "kN m2": 1e3,
    "N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6,
    "N s/m": 1.0, "kN s/m": 1e3,
    "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9,
    "m/s": 1.0, "km/h": 1 / 3.6, "s": 1.0, "ms": 1e-3, "Hz": 1.0,
}  # fmt: skip


_DIMENSIONS = [
    ("", "-", "1", "rad", "%"), ("m", "mm", "cm", "km"), ("m2",), ("m4",),
    ("kg", "t"), ("kg m2", "t m2"), ("kg/m", "t/m"), ("kg/m3",),
    ("N", "kN", "MN"), ("N m2", "kN m2"), ("N/m", "kN/m", "MN/m"), ("N s/m", "kN s/m"),
    ("Pa", "kPa", "MPa", "GPa"), ("m/s", "km/h"), ("s", "ms"), ("Hz",),
]  # fmt: skip


def quantity(field: str, value: Any, unit: str, si_unit: str, **limits: Any) -> float:
    """Return a number given in `unit` converted to `si_unit`; refuse a unit of another dimension.

    Raises
    ------
    InputError
        Unknown unit, unit of the wrong dimension, or a value outside `limits` (which are in SI).
    """
    family = next(d for d in _DIMENSIONS if si_unit in d)
    if unit not in family:
        allowed = f"unit of {field} must be one of " + ", ".join(u or "(none)" for u in family)
        raise errors.InputError(f"{field} (unit)", unit, allowed, "Correct the unit, and the value with it")
    try:
        raw = float(value)
    except (TypeError, ValueError):
        raise errors.InputError(field, value, "must be a number", "Use a point as decimal mark and no thousands mark") from None
    return errors.number(field, raw * _UNITS[unit], unit=si_unit, **limits)
