"""Rows of a study as labelled arrays, and as a table for a spreadsheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .engine import NUMBERS, Asked, Row
from .extras import needed
from .outputs import OUTPUTS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Dimension", "dataset", "table"]

WORDS = {
    "displacement_y": "lateral displacement", "displacement_z": "vertical displacement",
    "rotation_x": "twist", "rotation_y": "rotation about the lateral axis",
    "rotation_z": "rotation about the vertical axis", "twist": "twist of the track over 3 m",
    "moment_vertical": "vertical bending moment", "moment_lateral": "lateral bending moment",
    "torsion": "torsional moment",
    "shear_vertical": "vertical shear", "shear_lateral": "lateral shear",
    "acceleration_y": "lateral acceleration", "acceleration_z": "vertical acceleration",
    "acceleration_roll": "twisting acceleration",
}  # fmt: skip


@dataclass(frozen=True)
class Dimension:
    """What varies in one direction of a study.

    Attributes
    ----------
    name : str
    values : sequence of float or str
    unit : str
    path : str
        Key of a case, where it is one.
    words : str
    """

    name: str
    values: Sequence[Any]
    unit: str = ""
    path: str = ""
    words: str = ""

    @property
    def attributes(self) -> dict[str, str]:
        """What the coordinate says of itself."""
        own = {"units": self.unit, "path": self.path, "long_name": self.words}
        return {name: text for name, text in own.items() if text}


def dataset(
    dimensions: Sequence[Dimension],
    asked: Asked,
    rows: Sequence[Row | str],
    attributes: Mapping[str, str] | None = None,
) -> xr.Dataset:
    """Return rows, the last dimension fastest, as labelled arrays.

    Parameters
    ----------
    dimensions : sequence of Dimension
    asked : Asked
    rows : sequence of Row, or of a text where a point was refused
    attributes : mapping
        What the whole says of itself.

    Returns
    -------
    xarray.Dataset
        For every quantity, over the dimensions and ``x`` (m): itself (largest magnitude),
        ``_min``, ``_max``, ``_time`` (of the largest magnitude, s), and where it has one
        ``_static`` (largest magnitude under the standing loads) and ``_dynamic_factor``; NaN at
        places where it was not asked for. Every number. ``message``: why a point is NaN, empty
        where all is well.
    """
    needed("xarray")
    import xarray as xr

    shape = tuple(len(d.values) for d in dimensions)
    names = tuple(d.name for d in dimensions)
    empty = np.full(asked.width, np.nan)
    values = np.array([empty if isinstance(row, str) else row.values for row in rows])
    messages = [row if isinstance(row, str) else row.message for row in rows]
    six = values[:, : 6 * len(asked.outputs)].reshape(len(rows), 6, len(asked.outputs))
    quantities = list(dict.fromkeys(output.quantity for output in asked.outputs))
    places = list(dict.fromkeys(output.x for output in asked.outputs))
    variables: dict[str, tuple] = {}
    for quantity in quantities:
        own = {o.x: i for i, o in enumerate(asked.outputs) if o.quantity == quantity}
        at_places = np.full((6, len(rows), len(places)), np.nan)
        asked_at = [places.index(x) for x in own]
        at_places[:, :, asked_at] = six[:, :, list(own.values())].swapaxes(0, 1)
        low, high, low_time, high_time, static_low, static_high = at_places.reshape(
            6, *shape, len(places)
        )
        down = -low > high
        unit, words = OUTPUTS[quantity], WORDS[quantity]
        found = {
            "": (np.maximum(-low, high), unit, f"largest {words}"),
            "_min": (low, unit, f"smallest {words}, with its sign"),
            "_max": (high, unit, f"largest {words}, with its sign"),
            "_time": (np.where(down, low_time, high_time), "s", f"time of the largest {words}"),
        }
        if np.isfinite(static_low).any():
            static = np.maximum(-static_low, static_high)
            factor = np.divide(
                found[""][0], static, out=np.full_like(static, np.nan), where=static > 0.0
            )
            found["_static"] = static, unit, f"largest {words} under the standing loads"
            found["_dynamic_factor"] = factor, "-", f"dynamic factor of the {words}"
        for ending, (array, own_unit, own_words) in found.items():
            own_attributes = {"units": own_unit, "long_name": own_words}
            variables[quantity + ending] = (*names, "x"), array, own_attributes
    rest = values[:, 6 * len(asked.outputs) :].reshape(*shape, -1)
    for i, name in enumerate((*asked.numbers, *asked.more)):
        unit, words, _ = NUMBERS.get(name, ("", name, None))
        own_attributes = {"units": unit, "long_name": words} if unit else {"long_name": words}
        variables[name] = names, rest[..., i], own_attributes
    variables["message"] = (
        names, np.array(messages, dtype=str).reshape(shape),
        {"long_name": "why there are no numbers"},
    )  # fmt: skip
    coordinates = {d.name: (d.name, list(d.values), d.attributes) for d in dimensions}
    if places:
        along = {"units": "m", "long_name": "place along the deck"}
        coordinates["x"] = ("x", places, along)
    return xr.Dataset(variables, coordinates, dict(attributes or {}))


def table(found: xr.Dataset) -> pd.DataFrame:
    """Return one row a point and place, dimensions first: for a spreadsheet, SI."""
    frame = found.to_dataframe().reset_index()
    first = [name for name in (*found.sizes,) if name in frame]
    # What was asked for before what belongs to it.
    main = [name for name in frame.columns if name in OUTPUTS or name in NUMBERS]
    statics = [name for name in frame.columns if name.endswith("_static")]
    rest = [name for name in frame.columns if name not in {*first, *main, *statics}]
    return frame[[*first, *main, *statics, *rest]]
