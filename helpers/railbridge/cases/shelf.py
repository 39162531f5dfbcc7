"""The shelf of data files: found by shipped name or by path, and read."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError, did_you_mean, within
from ..exchange.reading import read_text
from ..exchange.tables import read_columns
from ..irregularities.reading import data_root
from ..units import quantity

__all__ = [
    "data_file", "data_names", "data_root", "is_path", "read_parameters", "read_toml",
]  # fmt: skip

LARGEST_TOML = 2e7
"""Bytes; twenty seconds of reading, and a measured track of a million samples."""
_QUOTED = re.compile(r"""(['"]).{2,}\1""", re.DOTALL)
"""What a parser quotes of a file in its complaint, but for single signs."""


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
    kind : {"vehicles", "decks", "cases", "studies"}
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
    field = "study" if kind == "studies" else kind.removesuffix("s")
    suffixes = suffixes or (".csv", ".toml")
    if not isinstance(name, (str, Path)) or not str(name).strip():
        remedy = "Shipped: " + ", ".join(data_names(kind, *suffixes))
        raise InputError(field, name, "must be a name or a path", remedy)
    path = Path(name)
    if is_path(name):
        if path.suffix not in suffixes:
            allowed = f"{field} files must end in {' or '.join(suffixes)}"
            said = {(".toml",): f"{field} files are TOML"}.get(suffixes, allowed)
            raise InputError(field, str(name), said)
        if not _is_there(path):
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
    return path.suffix in (".csv", ".toml", ".nc") or len(path.parts) > 1


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that no file system has
        return False


def read_toml(path: Path, known: Iterable[str] = ()) -> dict[str, Any]:
    """Read a TOML file; refuse what is none, naming the file but not what it says.

    Parameters
    ----------
    path : Path
    known : iterable of str, optional
        Keys of which a file of the wanted kind has at least one. Of a file without any nothing is
        said: it may be somebody else's.
    """
    try:
        content = tomllib.loads(read_text(path, largest=LARGEST_TOML))
    except InputError as error:
        raise InputError("", None, error.allowed, error.remedy, path.name) from None
    except (ValueError, RecursionError) as error:
        why = _QUOTED.sub("...", str(error))
        raise InputError("", None, f"is not a valid TOML file ({why})", source=path.name) from None
    known = list(known)
    if content and known and not any(key in known for key in content):
        remedy = f"Known: {', '.join(sorted(known))}. Is it the right file?"
        raise InputError("", None, "has none of the keys of such a file", remedy, path.name)
    return content


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
