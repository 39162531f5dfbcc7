"""What the command says, and where."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterable
from typing import TextIO

from ..errors import Remark, printable

__all__ = ["Progress", "note", "nowhere", "say", "tell", "warn"]


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


def warn(remarks: Iterable[Remark]) -> None:
    """Write a line for every remark that is also warned of."""
    for remark in remarks:
        if remark.warned:
            say(f"warning: {remark}")


class Progress:
    """One line on stderr that tells how far a long run is.

    Overwritten in a terminal, once in ten seconds elsewhere.

    Parameters
    ----------
    quiet : bool
        Whether nothing is told.
    """

    def __init__(self, quiet: bool) -> None:
        self.quiet = quiet
        self.start = self.last = time.monotonic()
        self.shown = 0

    def __call__(self, text: str) -> None:
        """Tell it, but not too often."""
        now, terminal = time.monotonic(), sys.stderr.isatty()
        if self.quiet or now - self.last < (0.2 if terminal else 10.0) or now - self.start < 1.0:
            return
        self.last = now
        line = f"railbridge: {printable(text)}, {now - self.start:.0f} s"
        if terminal:
            note("\r" + line.ljust(self.shown), end="")
            self.shown = len(line)
        else:
            note(line)

    def end(self) -> None:
        """Clear the line."""
        if self.shown:
            note("\r" + " " * self.shown + "\r", end="")
            self.shown = 0
