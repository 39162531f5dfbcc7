"""Refusals: what cannot be used is named, with its value, what is allowed and what to try.

Every refusal is one :class:`InputError`, raised before any number is computed. All other modules check their input through
this one.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

__all__ = [
    "InputError", "boolean", "choice", "did_you_mean", "frozen", "integer", "keys", "number", "numbers", "plain", "table",
    "text", "within",
]  # fmt: skip


class InputError(ValueError):
    """A value that cannot be used: names the field, the value, what is allowed and what to try.

    Parameters
    ----------
    field : str
        Path of the field as the user wrote it, for instance ``run.speed``.
    value : object
        The offending value; ``None`` where something is missing altogether.
    allowed : str
        What would be accepted.
    remedy : str
        What to try.
    """

    def __init__(self, field: str, value: Any, allowed: str, remedy: str = "") -> None:
        shown = "" if value is None else f" = {_short(value)}"
        advice = f" {remedy}" + "." * (not remedy.endswith("?")) if remedy else ""
        super().__init__(f"{field}{shown}: {allowed}.{advice}")
        self.field, self.value, self.allowed, self.remedy = field, value, allowed, remedy


def _short(value: Any) -> str:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    shown = repr(value)
    return shown if len(shown) <= 60 else shown[:57] + "..."


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return ``Did you mean 'x'? `` for the nearest known word, or the list of all known words."""
    known = sorted(known)
    near = difflib.get_close_matches(str(word), known, n=1, cutoff=0.5)
    return f"Did you mean '{near[0]}'?" if near else "Known: " + (", ".join(known) or "none")


def number(
    field: str,
    value: Any,
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
    unit: str = "",
    remedy: str = "",
) -> float:
    """Return `value` as a finite float within its range, or raise `InputError`.

    Parameters
    ----------
    field : str
        Name for the message.
    value : object
        What the user gave; booleans and text are refused.
    above, least, most : float, optional
        Exclusive lower bound, inclusive lower bound, inclusive upper bound.
    unit : str
        Unit for the message.
    remedy : str
        What to try instead.
    """
    bounds = []
    if above is not None:
        bounds.append(f"above {above:g}")
    if least is not None:
        bounds.append(f"at least {least:g}")
    if most is not None:
        bounds.append(f"at most {most:g}")
    unit = f" {unit}" if unit else ""
    allowed = "must be a finite number" + (" " + " and ".join(bounds) + unit if bounds else unit)
    # Only scalars: text, booleans and lists of one would pass float() too.
    if not isinstance(value, (int, float, np.integer, np.floating)) or isinstance(value, bool):
        raise InputError(field, value, allowed, remedy)
    try:
        result = float(value)
    except OverflowError:
        raise InputError(field, value, allowed, remedy) from None
    if abs(result) < 1e-30:  # products of such numbers underflow, and those of numbers beyond 1e30 overflow
        result = 0.0
    outside = (
        not abs(result) <= 1e30
        or (above is not None and result <= above)
        or (least is not None and result < least)
        or (most is not None and result > most)
    )
    if outside:
        raise InputError(field, value, allowed, remedy)
    return result


def integer(field: str, value: Any, *, least: int = 0, most: int | None = None, remedy: str = "") -> int:
    """Return `value` as an int within its range, or raise `InputError`."""
    result = number(field, value, least=least, most=most, remedy=remedy)
    if result != int(result):
        raise InputError(field, value, "must be a whole number", remedy)
    return int(result)


def numbers(field: str, values: Any, *, count: int | None = None, **limits: Any) -> np.ndarray:
    """Return `values` as a 1-D float array, each entry checked by `number`, or raise `InputError`."""
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise InputError(field, values, "must be a list of numbers" + (f" of length {count}" if count else ""))
    result = [number(f"{field}[{i}]", v, **limits) for i, v in enumerate(values)]
    if count is not None and len(result) != count:
        raise InputError(field, values, f"must hold {count} numbers, it holds {len(result)}")
    return np.array(result, dtype=float)


def frozen(array: np.ndarray) -> np.ndarray:
    """Return the same array, read-only from now on: it is kept and handed out again, so nobody may change it."""
    array.setflags(write=False)
    return array


def boolean(field: str, value: Any) -> bool:
    """Return `value` if it is true or false, or raise `InputError`."""
    if not isinstance(value, bool):
        raise InputError(field, value, "must be true or false")
    return value


def text(field: str, value: Any) -> str:
    """Return `value` if it is non-empty text, or raise `InputError`."""
    if not isinstance(value, str) or not value.strip():
        raise InputError(field, value, "must be a text between quotes")
    return value


def choice(field: str, value: Any, allowed: Iterable[str]) -> str:
    """Return `value` if it is one of `allowed`, or raise `InputError` that suggests the nearest."""
    allowed = list(allowed)
    if not isinstance(value, str) or value not in allowed:
        raise InputError(field, value, "must be one of " + ", ".join(allowed), did_you_mean(value, allowed).rstrip("."))
    return value


def table(field: str, value: Any) -> dict[str, Any]:
    """Return `value` if it is a table (a mapping with text keys), or raise `InputError`."""
    if not isinstance(value, Mapping) or not all(isinstance(k, str) for k in value):
        raise InputError(field, value, "must be a table of named values")
    return dict(value)


def plain(field: str, value: Any, depth: int = 0) -> Any:
    """Return a copy of a value made of tables, lists, texts, numbers and booleans only, NumPy's turned into Python's."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, (str, bool, int, float)):
        return value
    if depth < 20:
        if isinstance(value, Mapping):
            return {k: plain(f"{field}.{k}" if field else str(k), v, depth + 1) for k, v in table(field, value).items()}
        if isinstance(value, (list, tuple)):
            return [plain(f"{field}[{i}]", v, depth + 1) for i, v in enumerate(value)]
    raise InputError(field, value, "must be a number, a text, true or false, or a list or table of them")


def keys(field: str, given: Mapping[str, Any], allowed: Iterable[str], required: Iterable[str] = ()) -> None:
    """Refuse unknown keys (with the nearest known one) and missing required keys of a table."""
    allowed = [*allowed, *(k for k in required if k not in allowed)]
    prefix = f"{field}." if field else ""
    for key in given:
        if key not in allowed:
            raise InputError(prefix + key, None, "unknown key", did_you_mean(key, allowed))
    for key in required:
        if key not in given:
            raise InputError(prefix + key, None, "is missing", f"Add {key} to {field or 'the file'}")


@contextmanager
def within(path: str) -> Iterator[None]:
    """Put a path before the field of any `InputError` raised inside: ``x`` becomes ``track.vertical.x``."""
    try:
        yield
    except InputError as error:
        known = error.field == path or error.field.startswith(f"{path}.") or error.field.startswith(f"{path}[")
        raise InputError(error.field if known else f"{path}.{error.field}", error.value, error.allowed, error.remedy) from None
