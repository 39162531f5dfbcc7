"""Find, read, convert to SI and check what users bring.

Every refusal is one :class:`InputError` that names the field, the value, what is allowed and what to try,
raised before any number is computed. All other modules check their input through this one.
"""

from __future__ import annotations

import csv
import difflib
import os
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

__all__ = [
    "InputError",
    "boolean",
    "choice",
    "data_file",
    "data_names",
    "frozen",
    "integer",
    "keys",
    "number",
    "numbers",
    "plain",
    "quantity",
    "read_parameters",
    "read_toml",
    "table",
    "text",
    "within",
]

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
        raise InputError(f"{field} (unit)", unit, allowed, "Correct the unit, and the value with it")
    try:
        raw = float(value)
    except (TypeError, ValueError):
        raise InputError(field, value, "must be a number", "Use a point as decimal mark and no thousands mark") from None
    return number(field, raw * _UNITS[unit], unit=si_unit, **limits)


def data_root() -> Path:
    """Return the folder of shipped data: that of RAILBRIDGE_DATA if set, inside an installed wheel, or of the checkout."""
    if os.environ.get("RAILBRIDGE_DATA"):
        return Path(os.environ["RAILBRIDGE_DATA"])
    packaged = Path(__file__).parent / "data"
    return packaged if packaged.is_dir() else Path(__file__).parents[2] / "data"


def data_names(kind: str, *suffixes: str) -> list[str]:
    """Return the names of the shipped data files of a kind (``vehicles``, ``decks``, ``cases``), of any suffix if none given."""
    return sorted({p.stem for p in (data_root() / kind).glob("*.*") if p.suffix in (suffixes or (".csv", ".toml"))})


def data_file(kind: str, name: str | Path) -> Path:
    """Find a data file by shipped name or by path.

    Parameters
    ----------
    kind : {"vehicles", "decks", "cases"}
        Folder of ``data``.
    name : str or Path
        A shipped name (``xia2000``), or the path of a ``.csv`` or ``.toml`` file.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), missing file, other file type, or the same name as both CSV and TOML.
    """
    field = kind.removesuffix("s")
    if not isinstance(name, (str, Path)) or not str(name).strip():
        raise InputError(field, name, "must be a name or a path", "Shipped: " + ", ".join(data_names(kind)))
    path = Path(name)
    if path.suffix in (".csv", ".toml") or len(path.parts) > 1:
        if path.suffix not in (".csv", ".toml"):
            raise InputError(field, str(name), "file must end in .csv or .toml")
        if not _is_file(path):
            raise InputError(field, str(name), "no such file", f"Looked in {path.parent.resolve().name or 'the root'}")
        return path
    found = [data_root() / kind / f"{name}{s}" for s in (".csv", ".toml") if name in data_names(kind, s)]
    if len(found) > 1:
        raise InputError(field, str(name), "exists as both CSV and TOML", "Remove one, or give the file's path")
    if not found:
        raise InputError(field, str(name), f"no such {field}", did_you_mean(str(name), data_names(kind)))
    return found[0]


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name too long for the file system
        return False


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file; refuse what is not TOML, naming the file."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError, OSError) as error:
        raise InputError(path.name, None, f"is not a valid TOML file ({error})") from None


def read_parameters(path: Path, expected: Mapping[str, str]) -> dict[str, float]:
    """Read a parameter table (columns symbol, name, value, unit, source, note) into SI values.

    Parameters
    ----------
    path : Path
        A CSV file, UTF-8, comma separated.
    expected : mapping
        Names that must be there, each with its SI unit. Nothing else may be there.

    Returns
    -------
    dict
        Value in SI by name.

    Raises
    ------
    InputError
        Missing, unknown or duplicated column or row, wrong unit, or a value that is not a finite number.
    """
    columns = ["symbol", "name", "value", "unit", "source", "note"]
    where = path.name
    try:
        rows = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (UnicodeDecodeError, csv.Error, OSError) as error:
        raise InputError(where, None, f"is not a readable CSV file ({error})", "Save it as UTF-8 text") from None
    rows = [r for r in rows if r and any(cell.strip() for cell in r)]
    header = [h.strip() for h in rows[0]] if rows else []
    for column in header:
        if header.count(column) > 1:
            raise InputError(f"{where}: column {column}", None, "appears more than once")
        if column not in columns:
            raise InputError(f"{where}: column {column}", None, "unknown column", did_you_mean(column, columns))
    for column in columns:
        if column not in header:
            raise InputError(f"{where}: column {column}", None, "is missing", "Columns: " + ",".join(columns))
    result: dict[str, float] = {}
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise InputError(
                f"{where}: row {line}",
                ",".join(row),
                f"must have {len(header)} cells, it has {len(row)}",
                "Put cells that contain a comma between double quotes",
            )
        cells = dict(zip(header, (c.strip() for c in row), strict=True))
        name = cells["name"]
        if name not in expected:
            raise InputError(f"{where}: row {name}", None, "unknown parameter", did_you_mean(name, expected))
        if name in result:
            raise InputError(f"{where}: row {name}", None, "appears more than once")
        result[name] = quantity(f"{where}: {name}", cells["value"], cells["unit"], expected[name])
    missing = [name for name in expected if name not in result]
    if missing:
        raise InputError(f"{where}: row {missing[0]}", None, "is missing", "Rows missing: " + ", ".join(missing))
    return result


@contextmanager
def within(path: str) -> Iterator[None]:
    """Put a path before the field of any `InputError` raised inside: ``x`` becomes ``track.vertical.x``."""
    try:
        yield
    except InputError as error:
        known = error.field == path or error.field.startswith(f"{path}.") or error.field.startswith(f"{path}[")
        raise InputError(error.field if known else f"{path}.{error.field}", error.value, error.allowed, error.remedy) from None
