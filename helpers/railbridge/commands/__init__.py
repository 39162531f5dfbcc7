"""The command ``railbridge``: files in, files out; what it says, and to whom."""

from .command import main

__all__ = ["main"]
