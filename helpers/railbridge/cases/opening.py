"""Studies that are shipped, or that ``railbridge sweep`` has written, opened again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .. import studies
from ..errors import InputError
from .shelf import data_file

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["open_study"]


def open_study(name: str | Path) -> xr.Dataset:
    """Return a study as labelled arrays: a shipped one by its name, or a file by its path.

    Parameters
    ----------
    name : str or Path
        ``speed_wavelength``: one car of the paper on its deck over speed (m/s) and wavelength (m).
        ``deck_mass``: the same over the deck's mass per metre as well (kg/m). Or the path of a
        ``.nc`` file.

    Returns
    -------
    xarray.Dataset
        In memory; the file is closed. Units stand in the attributes.

    Raises
    ------
    InputError
        No such study, or a file that is none.
    """
    studies.needed("xarray", "netCDF4")
    import xarray as xr

    path = data_file("studies", name, ".nc")
    try:
        with xr.open_dataset(path) as found:
            return found.load()
    except (OSError, ValueError, KeyError) as error:
        why = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError("study", path.name, f"cannot be opened ({why})") from None
