"""Packages of an extra, missed in words where they are first needed; our own version."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version

from ..errors import InputError

__all__ = ["needed", "program_version"]


def needed(*names: str, extra: str = "study") -> None:
    """Refuse to begin what would end without one of these packages of an extra.

    Raises
    ------
    InputError
        One of them is not installed.
    """
    for name in names:
        try:
            import_module(name)
        except ImportError:
            remedy = f'Run: pip install "railbridge[{extra}]"'
            raise InputError(extra, None, f"the package {name} is missing", remedy) from None


def program_version() -> str:
    """Return the installed version of the package, "none" where it only lies in a folder."""
    try:
        return version("railbridge")
    except PackageNotFoundError:
        return "none"
