"""Where reports are written: whole or not at all, and never over a file of somebody else."""

from __future__ import annotations

import os
import secrets
import zipfile
from contextlib import suppress
from html import escape
from pathlib import Path

from ..cases import staging
from ..errors import InputError

__all__ = ["GENERATOR", "refuse_foreign", "written"]

GENERATOR = "railbridge report"
"""What our pages and workbooks say they were made by."""
_HEAD = 1024
"""Bytes of a page in which it says so."""
_LARGEST_CORE = 1 << 16
"""Bytes of what a workbook says about itself."""


def refuse_foreign(field: str, path: str | Path, ending: str, force: bool = False) -> Path:
    """Return the path of a report; refuse one where somebody else's file stands.

    Parameters
    ----------
    field : str
        What the user calls it.
    path : str or Path
    ending : str
        ``.html`` or ``.xlsx``.
    force : bool
        Whether any file may be replaced.

    Raises
    ------
    InputError
        Another ending, a folder, or a file that is no report of ours.
    """
    if not isinstance(path, (str, Path)) or not str(path).strip():
        raise InputError(field, path, f"must be the name of a file that ends in {ending}")
    place = Path(path)
    if place.suffix.lower() != ending:
        raise InputError(field, str(path), f"must end in {ending}")
    try:
        if place.is_dir():
            raise InputError(field, str(path), "is a folder", "Choose another name")
        if os.path.lexists(place) and not force and not _is_ours(place, ending):
            allowed = "exists already and is no report of railbridge"
            remedy = "Choose another name, or give --force"
            raise InputError(field, str(path), allowed, remedy)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise _unwritable(field, path, error) from None
    return place


def _is_ours(place: Path, ending: str) -> bool:
    said = escape(GENERATOR).encode()
    if ending == ".html":
        with place.open("rb") as file:
            return b'<meta name="generator" content="' + said + b'">' in file.read(_HEAD)
    try:
        with zipfile.ZipFile(place) as book, book.open("docProps/core.xml") as core:
            return b"<dc:creator>" + said + b"</dc:creator>" in core.read(_LARGEST_CORE)
    except (zipfile.BadZipFile, KeyError, NotImplementedError, RuntimeError):
        return False


def written(field: str, place: Path, content: bytes) -> Path:
    """Write a file as a whole, or leave what was there; folders on the way are made.

    Raises
    ------
    InputError
        It cannot be written to.
    """
    scratch = place.with_name(f".railbridge-{secrets.token_hex(6)}{place.suffix}")
    made: list[Path] = []
    try:
        for parent in [p for p in reversed(place.absolute().parents) if not p.exists()]:
            parent.mkdir(exist_ok=True)
            made.append(parent)
        with scratch.open("xb") as file:
            file.write(content)
        with staging.undisturbed():
            scratch.replace(place)
            made.clear()
    except (OSError, ValueError) as error:
        raise _unwritable(field, place, error) from None
    finally:
        with suppress(OSError, ValueError):
            scratch.unlink(missing_ok=True)
        for parent in reversed(made):
            with suppress(OSError):
                parent.rmdir()
    return place


def _unwritable(field: str, path: str | Path, error: Exception) -> InputError:
    why = getattr(error, "strerror", None) or str(error)
    return InputError(field, str(path), f"cannot be written to ({why})", "Choose another place")
