"""What the commands say and write of a finished study: the largest values, and where they are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import studies, units
from ..errors import counted

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["at_the_ends", "largest", "spreadsheet"]

_NAMED = 4
"""Trains that are named in one line; more are counted."""


def largest(found: xr.Dataset, names: Sequence[str], speed_unit: str = "") -> list[str]:
    """Return a line for each quantity: how large it becomes, and where.

    Parameters
    ----------
    found : xarray.Dataset
    names : sequence of str
        Of its variables.
    speed_unit : str
        In which speeds are said, a key of ``units.UNITS["speed"]``; m/s if empty.
    """
    lines = []
    for name in names:
        values = found[name].values
        if not np.isfinite(values).any():
            lines.append(f"{name} has no numbers")
            continue
        if not np.nanmax(np.abs(values)):
            lines.append(f"{name} is 0 everywhere")
            continue
        place = np.unravel_index(np.nanargmax(values), values.shape)
        where = [
            _said(found, str(dim), i, speed_unit)
            for dim, i in zip(found[name].dims, place, strict=True)
        ]
        unit = _unit(found, name)
        amount = f"{values[place]:.4g}" + f" {unit}" * bool(unit)
        lines.append(f"{name} is largest, {amount}, at {', '.join(where)}")
    return lines


def at_the_ends(found: xr.Dataset, names: Sequence[str], speed_unit: str = "") -> list[str]:
    """Return a line for each quantity that is largest at the first or the last speed.

    There it may grow further: the range does not show the largest value. Parameters as for
    `largest`; nothing is said of a single speed.
    """
    dim = next((str(d) for d in found.sizes if found[d].attrs.get("path") == "run.speed"), "")
    if not dim or found.sizes[dim] < 2:
        return []
    lines = []
    for name in names:
        if dim not in found[name].dims:
            continue
        by_train = "train" in found[name].dims
        kept = (["train"] if by_train else []) + [dim]
        rest = [d for d in found[name].dims if d not in kept]
        curves = np.atleast_2d(found[name].max(rest).transpose(*kept).values)
        trains = found["train"].values.tolist() if by_train else [""]
        for end, word in ((0, "below"), (curves.shape[1] - 1, "above")):
            at_end = [
                train
                for train, curve in zip(trains, curves, strict=True)
                if np.isfinite(curve).any() and np.nanargmax(curve) == end
            ]
            if at_end:
                speed = _said(found, dim, end, speed_unit)
                of = f" for {counted(at_end, _NAMED)}" if by_train else ""
                said = f"{name} is largest at the end of the range of speeds{of}: look {word} "
                lines.append(said + speed.removeprefix(f"{dim} "))
    return lines


def spreadsheet(found: xr.Dataset) -> pd.DataFrame:
    """Return the table of a study, each column with its unit: ``speed (m/s)``."""
    frame = studies.table(found)
    shown = {name: _unit(found, name) for name in frame.columns}
    return frame.rename(columns={name: f"{name} ({unit})" for name, unit in shown.items() if unit})


def _unit(found: xr.Dataset, name: str) -> str:
    unit = found[name].attrs.get("units", "")
    return "" if unit == "-" else unit


def _said(found: xr.Dataset, dim: str, i: int, speed_unit: str) -> str:
    """Return a place along a dimension: a train's name, ``speed 340 km/h``."""
    value: Any = found[dim].values[i]
    if found[dim].dtype.kind not in "fiu":
        return str(value) if dim == "train" else f"{dim} {value}"
    unit = _unit(found, dim)
    if found[dim].attrs.get("path") == "run.speed" and speed_unit:
        value, unit = value / units.UNITS["speed"][speed_unit], speed_unit
    return f"{dim} {value:.5g}" + f" {unit}" * bool(unit)
