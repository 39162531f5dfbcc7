"""What the command says, and where."""

from __future__ import annotations

import os
import sys
from typing import TextIO

from ..errors import printable

__all__ = ["note", "nowhere", "say", "tell"]


def nowhere() -> TextIO:
    """Return a stream that nobody reads."""
    return open(os.devnull, "w", encoding="utf-8")


def say(line: str) -> None:
    """Write a line to stderr, after the name of the program."""
    note("railbridge: " + printable(" ".join(line.split())))


def note(text: str, end: str = "\n") -> None:
    """Write to stderr; a run is not lost because nobody can read how it went."""
    try:
        print(text, end=end, file=sys.stderr, flush=True)
    except (OSError, ValueError):
        sys.stderr = nowhere()


def tell(line: str) -> None:
    """Print a line."""
    print(printable(line))
