"""Measured tracks from CSV files, as recording cars write them."""

from __future__ import annotations

import math
from collections.abc import Collection
from pathlib import Path
from typing import Literal

import numpy as np

from ..errors import InputError, within
from ..exchange.tables import Columns, read_columns
from ..irregularities import TrackRecord, record_of
from ..irregularities.records import BAND, COLUMNS, LARGEST_DRIFT, LARGEST_STEP
from ..units import UNITS, per_metre, spelled
from . import shelf

__all__ = ["track_record"]

_BASE = 1.5
"""m between the two rails' middles: of a cross-level that is an angle."""


def track_record(
    path: str | Path,
    *,
    band: tuple[float, float] | Literal["all"] = BAND,
    origin: float = 0.0,
    repair: Collection[str] | str = (),
    largest_step: float = LARGEST_STEP,
    largest_drift: float = LARGEST_DRIFT,
) -> TrackRecord:
    """Read a measured track from a CSV file: one row a place, units in the header.

    Either each rail, or their mean and left minus right; vertical, lateral, or both::

        # source: recording car, 14 May
        place(km), vertical(mm), cross_level(mm), alignment(mm), gauge(mm)
        12.10000, 0.4, -1.2, 0.1, 0.3
        12.10025, 0.5, -1.1, 0.1, 0.3

    ``vertical_left``, ``vertical_right`` are heights, up positive; ``lateral_left``,
    ``lateral_right`` are places sideways, left positive. ``vertical`` and ``alignment`` are their
    means, ``cross_level`` and ``gauge`` left minus right: the left rail is half of it above the
    mean, the right one below. A cross-level is a height over 1.5 m or an angle (``mrad``), the
    left rail higher positive. Blank cells and NaN are samples that are missing. The file must
    follow the train: places ascend.

    Parameters
    ----------
    path : str or Path
        A ``.csv`` file, or the name of a shipped one (``data/tracks``).
    band : (float, float) or "all"
        Shortest and longest wavelength kept, m. Of the record at least four samples must stand in
        the shortest wave. What is lost by it stands in the result's ``report``.
    origin : float
        Place of the record that lies at the bridge entrance, m.
    repair : collection of str
        What is mended, else refused: ``repeated`` places (dropped), a ``gap`` of up to 5 m (filled
        by a straight line), a ``step`` (what is behind moved), a ``drift`` (a straight line taken
        out). What was done stands in the result's ``report``.
    largest_step, largest_drift : float
        m: more between two neighbours is a step; a straight line through all samples that rises
        more from end to end is a drift.

    Returns
    -------
    TrackRecord
        On an even grid, the median of the spacing where the record is uneven.

    Raises
    ------
    InputError
        With file and place: a column, unit or cell that cannot be used; a place that is given twice
        or goes back; a gap, a step or a drift that is not to be mended; a band that ends below four
        samples; an origin outside of the record.
    """
    file = shelf.data_file("tracks", path, ".csv")
    optional = [name for names in COLUMNS.values() for name in names]
    with within(names={"path": "file"}):
        table = read_columns(file, ["place"], [*optional, "note"], units_in_header=True)
    with within(source=table.name):
        place = _metres(table, "place")
        missing = np.flatnonzero(np.isnan(place))
        if len(missing):
            raise InputError(f"line {table.lines[missing[0]]}: place", None, "is missing")
        columns = {name: _metres(table, name) for name in table.cells if name in optional}
    options = {
        "band": band, "origin": origin, "repair": repair, "largest_step": largest_step,
        "largest_drift": largest_drift,
    }  # fmt: skip
    try:
        return record_of(table.notes.get("name") or file.stem, place, columns, **options)
    except InputError as error:  # options are the caller's, all else is the file's
        head = error.field.partition("[")[0]
        raise (error if head in options else error.moved(source=table.name)) from None


def _metres(table: Columns, column: str) -> np.ndarray:
    """Return a column in m, NaN where a cell is blank or NaN."""
    unit = spelled(table.column_units.get(column, ""))
    known = dict(UNITS["length"])
    if column == "cross_level":
        known |= {name: _BASE * UNITS["number"][name] for name in ("rad", "mrad")}
    if unit not in known:
        allowed = ("must be one of " if unit else "has no unit, must be one of ") + ", ".join(known)
        remedy = f"Write it in the header, {column} ({'m' if column == 'place' else 'mm'})"
        raise InputError(f"column {column} (unit)", unit or None, allowed, remedy)
    values = _numbers(table, column)
    return values / per_metre(unit) if unit in UNITS["length"] else values * known[unit]


def _numbers(table: Columns, column: str) -> np.ndarray:
    cells = [cell if cell.lower() not in ("", "nan") else "nan" for cell in table.cells[column]]
    try:
        values = np.array(cells, dtype=float)
    except ValueError:
        values = np.array([math.inf])
    if table.comma or np.any(np.abs(values) > 1e30):
        values = np.array([
            math.nan if cell == "nan" else table.number(f"line {line}: {column}", cell)
            for line, cell in zip(table.lines, cells, strict=True)
        ])  # fmt: skip
    return values
