"""Packages of the extra `report`, missed in words where they are first needed."""

from __future__ import annotations

from .. import studies

__all__ = ["needed"]


def needed(*names: str) -> None:
    """Refuse to begin what would end without one of these packages; see `studies.needed`.

    Raises
    ------
    InputError
        One of them is not installed.
    """
    studies.needed(*names, extra="report")
