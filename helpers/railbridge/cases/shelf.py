"""The shelf of data files: found by shipped name or by path, and read."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError, did_you_mean, within
from ..exchange.tables import read_columns
from ..units import quantity

__all__ = [
    "data_file", "data_names", "data_root", "is_path", "read_parameters", "read_toml",
]  # fmt: skip


def data_root() -> Path:
    """Return the folder of shipped data.

    That of RAILBRIDGE_DATA if set, inside an installed wheel, or of the checkout.
    """
    if os.environ.get("RAILBRIDGE_DATA"):
        return Path(os.environ["RAILBRIDGE_DATA"])
    packaged = Path(__file__).parents[1] / "data"
    return packaged if packaged.is_dir() else Path(__file__).parents[3] / "data"


def data_names(kind: str, *suffixes: str) -> list[str]:
    """Return the names of the shipped files of a kind (``vehicles``, ``decks``, ``cases``).

    Of any suffix if none is given.
    """
    return sorted(
        {
            p.stem
            for p in (data_root() / kind).glob("*.*")
            if p.suffix in (suffixes or (".csv", ".toml"))
        }
    )


def data_file(kind: str, name: str | Path, *suffixes: str) -> Path:
    """Find a data file by shipped name or by path.

    Parameters
    ----------
    kind : {"vehicles", "decks", "cases"}
        Folder of ``data``.
    name : str or Path
        A shipped name (``xia2000``), or the path of a file.
    *suffixes : str
        Kinds of files that will do; default ``.csv`` and ``.toml``.

    Raises
    ------
    InputError
        Unknown name (the nearest is suggested), missing file, other file type, or the same name as
        both CSV and TOML.
    """
    field, suffixes = kind.removesuffix("s"), suffixes or (".csv", ".toml")
    if not isinstance(name, (str, Path)) or not str(name).strip():
        remedy = "Shipped: " + ", ".join(data_names(kind))
        raise InputError(field, name, "must be a name or a path", remedy)
    path = Path(name)
    if is_path(name):
        if path.suffix not in suffixes:
            allowed = f"{field} files must end in {' or '.join(suffixes)}"
            said = {(".toml",): f"{field} files are TOML"}.get(suffixes, allowed)
            raise InputError(field, str(name), said)
        if not _is_file(path):
            remedy = f"Looked in {path.parent.resolve().name or 'the root'}"
            raise InputError(field, str(name), "no such file", remedy)
        return path
    names = {suffix: data_names(kind, suffix) for suffix in suffixes}
    found = [data_root() / kind / f"{name}{s}" for s in suffixes if name in names[s]]
    if len(found) > 1:
        remedy = "Remove one, or give the file's path"
        raise InputError(field, str(name), "exists as both CSV and TOML", remedy)
    if not found:
        near = did_you_mean(str(name), data_names(kind, *suffixes))
        raise InputError(field, str(name), f"no such {field}", near)
    return found[0]


def is_path(name: str | Path) -> bool:
    """Whether a name is the path of a file, not that of something shipped."""
    path = Path(name)
    return path.suffix in (".csv", ".toml") or len(path.parts) > 1


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
        reason = getattr(error, "strerror", None) or error
        allowed = f"is not a valid TOML file ({reason})"
        raise InputError("", None, allowed, source=path.name) from None


def read_parameters(
    path: Path,
    expected: Mapping[str, str],
    optional: Collection[str] = (),
    synonyms: Mapping[str, str] | None = None,
) -> dict[str, float]:
    """Read a parameter table (columns name, value, unit) into SI values.

    Parameters
    ----------
    path : Path
        A CSV file; see `read_columns`. The columns symbol, source and note are for people.
    expected : mapping
        Names that may be there, each with its SI unit. Nothing else may be there.
    optional : collection of str
        Which of them may be left out.
    synonyms : mapping, optional
        Other names of some.

    Returns
    -------
    dict
        Value in SI by name.

    Raises
    ------
    InputError
        Missing, unknown or duplicated column or row, wrong unit, or a value that is not a finite
        number.
    """
    columns = ["name", "value", "unit"]
    table = read_columns(path, columns, ["symbol", "source", "note"], may_be_empty=True)
    cells = zip(*(table.cells[c] for c in columns), strict=True)
    result: dict[str, float] = {}
    with within(source=table.name):
        for line, (given, value, unit) in zip(table.lines, cells, strict=True):
            name, row = (synonyms or {}).get(given, given), f"line {line}: row {given}"
            if name not in expected:
                raise InputError(row, None, "unknown parameter", did_you_mean(given, expected))
            if name in result:
                raise InputError(row, None, "appears more than once", "Remove one of the rows")
            field = f"line {line}: {given}"
            result[name] = quantity(field, table.number(field, value), unit, expected[name])
        missing = [name for name in expected if name not in result and name not in optional]
        if missing:
            remedy = "Rows missing: " + ", ".join(missing)
            raise InputError(f"row {missing[0]}", None, "is missing", remedy)
    return result
