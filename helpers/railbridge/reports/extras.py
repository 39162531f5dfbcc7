"""Packages of the extra `report`, missed in words where they are first needed."""

from __future__ import annotations

from importlib import import_module

from ..errors import InputError

__all__ = ["needed"]


def needed(*names: str) -> None:
    """Refuse to begin what would end without one of these packages.

    Raises
    ------
    InputError
        One of them is not installed.
    """
    for name in names:
        try:
            import_module(name)
        except ImportError:
            remedy = 'Run: pip install "railbridge[report]"'
            raise InputError("report", None, f"the package {name} is missing", remedy) from None
