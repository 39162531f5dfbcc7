"""Ranges of numbers as people write them: ``150:300:25km/h``, ``20, 25, 30 m/s``, a list, a table.

One unit holds for the whole range and stands at its end; without one the numbers are SI. The last
number is always among them: where whole steps miss it, the last step is shorter.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import errors, units
from ..errors import InputError

__all__ = ["MOST", "unit_of", "values_of", "written_ends", "written_range"]

MOST = 100_000
"""Values in one range; more are a slip."""
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.ASCII)
_SAME = 1e-9
"""Part of a step that rounding may leave between the last whole step and the end."""
_DASHED = re.compile(r"\s*\d[\d.]*\s*[-\u2013]\s*\d.*", re.ASCII)
"""A range as it is printed, 150-300; a number in the form 1e-3 begins otherwise."""
_HOW = "Write first:last:step, as in 150:300:25km/h, or single values, as in 150,200,250km/h"


def written_range(field: str, text: str, dimension: str) -> np.ndarray:
    """Return the numbers, SI, of a range in words.

    Parameters
    ----------
    field, text : str
    dimension : str
        A key of `units.UNITS`.

    Raises
    ------
    InputError
        No range, more than one unit, a unit of another dimension, or no values.
    """
    ranged = ":" in text
    parts = text.split(":" if ranged else ",")
    numbers, named = [], []
    if any(_DASHED.fullmatch(part) for part in parts):
        raise InputError(field, text, "has a dash between numbers, use a colon", _HOW)
    for part in parts:
        found = _NUMBER.fullmatch(part)
        if not found:
            raise InputError(field, text, "is no range of numbers", _HOW)
        numbers.append(errors.number(field, float(found[1])))
        if found[2]:
            named.append(units.spelled(found[2]))
    if len(set(named)) > 1:
        allowed = f"mixes the units {' and '.join(dict.fromkeys(named))}"
        raise InputError(field, text, allowed, "Use one, at the end")
    factor = units.factor_of(f"{field} (unit)", named[0], dimension) if named else 1.0
    if ranged:
        if len(numbers) != 3:
            raise InputError(field, text, "must be first:last:step", _HOW)
        numbers = _stepped(field, text, *numbers)
    # Rounded, so that 25 km/h and 50 km/h / 2 are the same point.
    return np.round(np.array(numbers) * factor, 12)


def unit_of(text: str) -> str:
    """Return the unit of a range in words that is in order, empty where it has none."""
    found = [_NUMBER.fullmatch(part) for part in re.split("[:,]", text)]
    return next((units.spelled(part[2]) for part in found if part and part[2]), "")


def written_ends(field: str, text: str, dimension: str) -> tuple[float, float] | None:
    """Return both ends, SI, of a range without a step, ``150:300km/h``; None if it is none.

    Raises
    ------
    InputError
        As for `written_range`.
    """
    if text.count(":") != 1:
        return None
    low, high = written_range(field, text.replace(":", ","), dimension)
    return float(low), float(high)


def _stepped(field: str, given: Any, first: float, last: float, step: float) -> list[float]:
    if not step > 0.0:
        raise InputError(field, given, "has a step that is not above 0", _HOW)
    if last < first:
        raise InputError(field, given, "ends before it begins", "Put the smaller number first")
    whole = np.floor((last - first) / step + _SAME)
    missed = last - first > (whole + _SAME) * step
    count = whole + 1.0 + missed
    if not count <= MOST:  # infinite or no number, too
        if not np.isfinite(count):
            raise InputError(field, given, "has more values than can be counted", _HOW)
        raise InputError(
            field, given, f"has {count:.0f} values, at most {MOST}", "Use a larger step"
        )
    found = [first + i * step for i in range(int(whole) + 1)]
    return [*found, last] if missed else found


def values_of(field: str, given: Any) -> list[Any]:
    """Return what a range over a key of a case consists of, ascending where they are numbers.

    Parameters
    ----------
    field : str
    given : list, array, or table
        ``{from, to, step}``, ``{from, to, count}``, or the values. Both ends are always in it.

    Raises
    ------
    InputError
        Empty, not ascending, or no range.
    """
    if isinstance(given, Mapping):
        given = _of_table(field, dict(given))
    if isinstance(given, np.ndarray):
        given = given.tolist()
    if isinstance(given, (str, bytes)) or not hasattr(given, "__iter__"):
        remedy = "Give a list, or { from, to, step }"
        raise InputError(field, given, "must be a list of values", remedy)
    found = [value.item() if isinstance(value, np.generic) else value for value in given]
    if not found:
        raise InputError(field, found, "is empty", "Give at least one value")
    if len(found) > MOST:
        raise InputError(field, None, f"has {len(found)} values, at most {MOST}")
    if all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in found):
        numbers = errors.numbers(field, found)
        if np.any(np.diff(numbers) <= 0.0):
            raise InputError(field, found, "must ascend", "Sort the values, each once")
    elif len({repr(value) for value in found}) < len(found):
        raise InputError(field, found, "has a value twice", "Give each once")
    return found


def _of_table(field: str, given: dict[str, Any]) -> list[float]:
    errors.keys(field, given, ["from", "to", "step", "count"], ["from", "to"])
    first, last = (errors.number(f"{field}.{name}", given[name]) for name in ("from", "to"))
    if ("step" in given) == ("count" in given):
        raise InputError(field, given, "needs either a step or a count")
    if "step" in given:
        step = errors.number(f"{field}.step", given["step"], above=0.0)
        return _stepped(field, given, first, last, step)
    count = errors.integer(f"{field}.count", given["count"], least=2, most=MOST)
    return np.linspace(first, last, count).tolist()
