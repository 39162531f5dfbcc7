"""Gravity, and the units in which people give their numbers."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

from . import errors

__all__ = [
    "G", "ROUND_OFF", "UNITS", "factor_of", "per_metre", "quantity", "spelled", "units_of",
    "without_rounding", "written",
]  # fmt: skip

G = 9.81
"""Acceleration of gravity, m/s2."""

_LBF, _IN, _FT = 4.4482216152605, 0.0254, 0.3048
"""Pound of force, N; inch and foot, m: exact by definition."""

UNITS: dict[str, dict[str, float]] = {
    "number": {"": 1.0, "-": 1.0, "1": 1.0, "rad": 1.0, "mrad": 1e-3, "%": 0.01},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": _IN, "ft": _FT},
    "area": {"m2": 1.0, "cm2": 1e-4, "mm2": 1e-6, "in2": _IN**2, "ft2": _FT**2},
    "second moment of area": {
        "m4": 1.0, "cm4": 1e-8, "mm4": 1e-12, "in4": _IN**4, "ft4": _FT**4,
    },
    "mass": {
        "kg": 1.0, "t": 1e3, "lb": 0.45359237, "slug": _LBF / _FT,
        "N s2/mm": 1e3, "kN s2/m": 1e3, "kN s2/mm": 1e6,
        "lbf s2/in": _LBF / _IN, "kip s2/in": 1e3 * _LBF / _IN, "kip s2/ft": 1e3 * _LBF / _FT,
    },
    "mass per length": {"kg/m": 1.0, "t/m": 1e3, "lb/ft": 0.45359237 / _FT},
    "density": {"kg/m3": 1.0, "t/m3": 1e3, "t/mm3": 1e12, "lb/ft3": 0.45359237 / _FT**3},
    "moment of inertia": {
        "kg m2": 1.0, "t m2": 1e3, "kg mm2": 1e-6, "t mm2": 1e-3,
        "kN s2 m": 1e3, "lb ft2": 0.45359237 * _FT**2, "slug ft2": _LBF * _FT,
        "lbf s2 in": _LBF * _IN, "kip s2 in": 1e3 * _LBF * _IN,
    },
    "force": {"N": 1.0, "kN": 1e3, "MN": 1e6, "lbf": _LBF, "kip": 1e3 * _LBF},
    "stiffness": {
        "N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6,
        "lbf/in": _LBF / _IN, "lbf/ft": _LBF / _FT,
        "kip/in": 1e3 * _LBF / _IN, "kip/ft": 1e3 * _LBF / _FT,
    },
    "damping": {
        "N s/m": 1.0, "kN s/m": 1e3, "MN s/m": 1e6, "N s/mm": 1e3, "kN s/mm": 1e6,
        "lbf s/in": _LBF / _IN, "lbf s/ft": _LBF / _FT, "kip s/in": 1e3 * _LBF / _IN,
    },
    "bending stiffness": {
        "N m2": 1.0, "kN m2": 1e3, "MN m2": 1e6, "GN m2": 1e9, "N mm2": 1e-6, "kN mm2": 1e-3,
        "lbf in2": _LBF * _IN**2, "kip in2": 1e3 * _LBF * _IN**2, "kip ft2": 1e3 * _LBF * _FT**2,
    },
    "stress": {
        "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "kN/m2": 1e3,
        "psi": _LBF / _IN**2, "ksi": 1e3 * _LBF / _IN**2,
    },
    "speed": {"m/s": 1.0, "km/h": 1 / 3.6, "ft/s": _FT, "mph": 0.44704},
    "time": {"s": 1.0, "ms": 1e-3},
    "frequency": {"Hz": 1.0, "rad/s": 1 / (2 * math.pi)},
}  # fmt: skip
"""Every unit by dimension, the SI unit first, with the factor that converts a number to SI."""

ROUND_OFF = {
    "m": 1e-15, "rad": 1e-15, "m/s2": 1e-12, "rad/s2": 1e-12, "m/s": 1e-13, "rad/s": 1e-13,
    "N": 1e-6, "N m": 1e-6, "-": 1e-12,
}  # fmt: skip
"""What is only rounding of a response, by its SI unit.

Trains weigh up to 1e8 N, of which a double keeps 1e-8 N; a single newton still moves the stiffest
bridge by 1e-12 m.
"""

_WHOLE = {"m": 1.0, "cm": 100.0, "mm": 1000.0}
"""How many of a unit make a metre, where these are whole numbers.

Dividing by 1000 rounds once where multiplying by 0.001 rounds twice.
"""


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
    name = spelled(unit) if isinstance(unit, str) else unit
    if not isinstance(name, str) or name not in family:
        allowed = "must be one of " + ", ".join(name or "(none)" for name in family)
        remedy = "Correct the unit, and the value with it"
        raise errors.InputError(f"{field} (unit)", unit, allowed, remedy)
    raw = written(field, value) if isinstance(value, str) else value
    if isinstance(raw, bool) or not isinstance(raw, (int, float, np.integer, np.floating)):
        raise errors.InputError(field, value, "must be a number", _MARKS)
    try:
        return errors.number(field, float(raw) * family[name], unit=si_unit, **limits)
    except OverflowError:  # a whole number of more digits than a float holds
        raise errors.InputError(field, value, "must be a finite number") from None


def without_rounding(values: np.ndarray, unit: str) -> np.ndarray:
    """Return histories in which those that are never more than rounding are zero.

    The one place that says so, for all that is told of a crossing. A history that is larger once
    stays as it is.

    Parameters
    ----------
    values : ndarray, shape (..., n)
        The last axis is that of a history. NaN stays.
    unit : str
        SI; one that `ROUND_OFF` does not know has no rounding.

    Returns
    -------
    ndarray
        The given one where nothing is changed.
    """
    least = ROUND_OFF.get(unit)
    if least is None or not values.size:
        return values
    with np.errstate(invalid="ignore"):
        large = (np.abs(values) >= least).any(axis=-1, keepdims=True)
    return values if large.all() else np.where(large | np.isnan(values), values, 0.0)


def spelled(unit: str) -> str:
    """Return a unit as `UNITS` spells it: ``kN s/m`` for ``kN*s/m`` or ``kN\u00b7s/m``.

    Powers as ``m^2`` or ``m\u00b2`` are ``m2``; one that is not known comes back changed likewise.
    """
    for sign, digit in zip("\u00b2\u00b3\u2074", "234", strict=True):
        unit = unit.replace(sign, digit)
    unit = re.sub(r"\s*[*\u00b7\u22c5]\s*|\s+", " ", unit.strip()).replace("^", "")
    return re.sub(r"\s*/\s*", "/", unit)


def factor_of(field: str, unit: Any, dimension: str) -> float:
    """Return how many SI units a unit is: one of `UNITS`, or a plain number of them.

    Parameters
    ----------
    field : str
    unit : str or number
        ``lbf s2/in``, or 175.127 (kg) for a mass that has no name.
    dimension : str
        A key of `UNITS`.

    Raises
    ------
    InputError
        Naming ``field``: unknown, or no positive number.
    """
    known, si_unit = UNITS[dimension], units_of(dimension)[0]
    if isinstance(unit, str) and spelled(unit) in known:
        return known[spelled(unit)]
    try:
        raw = float(unit) if isinstance(unit, str) else unit
    except ValueError:
        near = errors.did_you_mean(unit, known).rstrip(".")
        allowed = f"must be one of {', '.join(known)}, or how many {si_unit} it is"
        raise errors.InputError(field, unit, allowed, near) from None
    return errors.number(field, raw, above=0.0, unit=si_unit)


def per_metre(unit: str) -> float:
    """Return how many of a unit of length make a metre; see `factor_of`."""
    return _WHOLE.get(spelled(unit)) or 1.0 / factor_of("units[1]", unit, "length")


# ---- numbers as people write them

_MARKS = "Use a point as decimal mark and no thousands mark"
_NUMERAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_COMMA = re.compile(r"[+-]?(\d*,\d+|\d+,)([eE][+-]?\d+)?", re.ASCII)
_THOUSANDS = re.compile(r"[+-]?\d{1,3}([., '\u00a0\u2009\u202f]\d{3})+([.,]\d+)?", re.ASCII)
_FORTRAN = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([dD][+-]?\d+|[+-]\d+)", re.ASCII)


def has_decimal_comma(text: str) -> bool:
    """Whether a text is a number with one comma, as most of Europe writes it."""
    return _COMMA.fullmatch(text.strip()) is not None


def written(field: str, text: str, comma: bool = False) -> float:
    """Return the number that a text is, or say what kind of number it is instead.

    Parameters
    ----------
    field, text : str
    comma : bool
        Whether a comma is the decimal mark.

    Raises
    ------
    InputError
        Blank, with marks for thousands, with a comma that may be either, with an exponent as
        Fortran and Nastran write it, or no number at all.
    """
    text = text.strip()
    if comma and has_decimal_comma(text):
        text = text.replace(",", ".")
    elif comma and "." in text and _NUMERAL.fullmatch(text):
        allowed = "has a point where other numbers of the file have a decimal comma"
        remedy = "Use one decimal mark, and no thousands mark"
        raise errors.InputError(field, text, allowed, remedy)
    if _NUMERAL.fullmatch(text) and abs(float(text)) <= 1e30:  # as `Range` has it
        return float(text)
    allowed, remedy = "must be a finite number", _MARKS
    if not text:
        allowed, remedy = "is blank, must be a number", "Write 0 if that is meant"
    elif _THOUSANDS.fullmatch(text):
        allowed = "may have a mark for thousands"
    elif has_decimal_comma(text):
        allowed = "has a decimal comma"
        remedy = "Use a point as decimal mark, or separate the cells by semicolons"
    elif _FORTRAN.fullmatch(text):
        allowed, remedy = "has an exponent without e", "Write it as 1.5e-3"
    raise errors.InputError(field, text, allowed, remedy)
