"""Tracks as CSV files like those of recording cars."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .. import errors
from ..errors import InputError
from ..tracks import Level, Track, extent_of

__all__ = ["export_track", "write_columns"]

_MOST = 10_000_000


def export_track(
    track: Track, path: str | Path, first: float, last: float, step: float = 0.25
) -> Path:
    """Write a track's rails as a CSV file that `track_record` reads back, heights in mm.

    Parameters
    ----------
    track : Track
    path : str or Path
    first, last : float
        Places, m from the bridge entrance.
    step : float
        m between samples; recording cars give one every 0.25 m.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        A perfect track, places that do not ascend or where a measured track is not known, or a file
        that cannot be written.
    """
    errors.instance("track", track, Track)
    first = errors.number("first", first, unit="m")
    last = errors.number("last", last, above=first, unit="m")
    step = errors.number("step", step, above=0.0, most=(last - first) / 3, unit="m")
    if (last - first) / step > _MOST:
        raise InputError("step", step, f"makes more than {_MOST} samples", "Use a larger step")
    x = first + step * np.arange(int((last - first) / step + 1e-9) + 1)
    for direction in ("vertical", "lateral"):
        for side in ("left", "right"):
            known = extent_of(track.rail(direction, side))
            if first < known[0] - 1e-9 * step or x[-1] > known[1] + 1e-9 * step:
                name = "first" if first < known[0] else "last"
                value = first if first < known[0] else last
                allowed = f"the track is known from {known[0]:.6g} m to {known[1]:.6g} m only"
                raise InputError(name, value, allowed)
    columns = {
        f"{direction}_{side}": track.rail(direction, side).value(x)
        for direction in ("vertical", "lateral")
        for side in ("left", "right")
        if not all(isinstance(track.rail(direction, s), Level) for s in ("left", "right"))
    }
    if not columns:
        raise InputError("track", None, "is perfect, there is nothing to write")
    return write_columns(path, x, columns)


def write_columns(path: str | Path, place: np.ndarray, columns: Mapping[str, np.ndarray]) -> Path:
    """Write places (m) and heights (m, written in mm) with all their digits; return the path."""
    header = ",".join(["place (m)", *(f"{name} (mm)" for name in columns)])
    rows = np.column_stack([place, *(1e3 * r for r in columns.values())]).tolist()
    lines = ["# place from the bridge entrance; up and left positive", header]
    lines += [",".join(map(repr, row)) for row in rows]
    try:
        path = Path(path)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    except (OSError, TypeError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise InputError("path", path, f"cannot be written ({why})") from None
    return path
