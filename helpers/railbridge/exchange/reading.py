"""Files as text: regular ones of sane size only, for every door that reads one.

A device has no end, a pipe waits for ever for a writer, and a file that does not fit into memory
stops the machine: none of them is opened for good.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from ..errors import InputError
from ..settings import MEMORY_LIMIT

__all__ = ["LARGEST", "read_text"]

LARGEST = MEMORY_LIMIT / 12
"""Bytes of a table; read and taken apart it needs about twelve times as many."""


def read_text(path: str | Path, field: str = "path", largest: float = LARGEST) -> str:
    """Return the text of a regular file, UTF-8 with or without a byte order mark.

    Parameters
    ----------
    path : str or Path
    field : str
        What the caller calls the path.
    largest : float
        Bytes.

    Raises
    ------
    InputError
        No such file; a folder, a device or a pipe; a file that is too large; what cannot be read or
        is not text. Nothing of its content is said: it may be somebody else's file.
    """
    path = Path(path)
    try:
        content = _content(path, int(largest) + 1)
    except FileNotFoundError:
        remedy = "A path in a deck file is relative to that file"
        raise InputError(field, path.name, "no such file", remedy) from None
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(field, path.name, f"cannot be read ({why})") from None
    if content is None:
        allowed = "must be a regular file, not a folder, a device or a pipe"
        raise InputError(field, path.name, allowed)
    if len(content) > largest:
        allowed = f"is too large, must be at most {largest / 1e6:.3g} MB"
        raise InputError(field, path.name, allowed, "Is it the right file?")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(field, path.name, "is not text", "Save it as UTF-8 text") from None
    return text


def _content(path: Path, most: int) -> bytes | None:
    """Return the first bytes of a file, `most` at most; None if it is not a regular one."""
    # A pipe would make a plain open wait until somebody writes into it.
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            return None
        # What says it has no size (a file of the system, say) may be without end all the same.
        with open(handle, "rb", closefd=False) as file:
            return file.read(most)
    finally:
        os.close(handle)
