"""Results of many crossings: tables of peaks, and pictures over what varies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import studies
from ..decks import Deck
from ..plots.maps import label_of, scale_of
from ..studies import OUTPUTS
from .parts import DIGITS, Column, Notes, Picture, Table, Words, in_km_h
from .pictures import over_one, over_speeds, over_two

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["failures", "key_peaks", "of_study", "peaks", "pictures", "whole"]

_MOST_TRAINS = 24
"""Trains whose lines one picture can hold."""
_MOST_ROWS = 60
"""Rows of a table on the page; more are in the workbook."""
_MOST_FAILURES = 10
_LARGEST_SHEET = 200_000
"""Rows of a sheet; a spreadsheet program takes a million, a reader less."""


def asked(found: xr.Dataset) -> list[str]:
    """Return the variables that a study was asked for, not those that belong to them."""
    beside = {f"{q}{e}" for q in OUTPUTS for e in ("_min", "_max", "_time", "_static")}
    beside |= {f"{q}_dynamic_factor" for q in OUTPUTS} | {"message", "signature", "distance"}
    return [str(n) for n in found.data_vars if n not in beside and found[n].dtype.kind == "f"]


def _worst_place(found: xr.Dataset, name: str) -> float | None:
    """Return the place (m) where a quantity is largest; None of one without places."""
    values = found[name]
    if "x" not in values.dims or not np.isfinite(values.values).any():
        return None
    rest = [dim for dim in values.dims if dim != "x"]
    return float(values.max(rest).idxmax("x"))


# ---- trains over speeds


def peaks(found: xr.Dataset) -> Iterator[Table]:
    """Give for each quantity the largest value of every train: at which speed, where, when."""
    trains = found["train"].values.tolist()
    for name in asked(found):
        own = [_peak(found, name, train) for train in trains]
        words, unit = label_of(found, name), own[0].unit
        columns = [
            ("train", "", [str(train) for train in trains]),
            ("largest", unit, [p.value for p in own]),
            ("speed", "m/s", [p.speed for p in own]),
            ("speed", "km/h", [None if p.speed is None else in_km_h(p.speed) for p in own]),
            ("x", "m", [p.x for p in own]),
            ("at", "s", [p.time for p in own]),
            ("static", unit, [p.static for p in own]),
            ("dynamic factor", "", [p.factor for p in own]),
        ]
        # A whole crossing has no place, an acceleration no static value.
        columns = [c for c in columns if c[0] == "train" or any(v is not None for v in c[2])]
        heads = [
            Column(head, u, 3 if head == "dynamic factor" else DIGITS) for head, u, _ in columns
        ]
        static = any(c[0] == "static" for c in columns)
        note = "Magnitude, without the deck's self-weight."
        note += " Static: under the standing axle loads at the same place." * static
        title = f"{words.capitalize()} of each train over the speeds"
        rows = zip(*(values for _, _, values in columns), strict=True)
        yield Table.of(f"peaks {name}", title, heads, rows, note=note)


@dataclass(frozen=True)
class _Peak:
    """The largest value of a quantity for one train, in the unit in which it is shown."""

    unit: str
    value: float | None = None
    speed: float | None = None
    x: float | None = None
    time: float | None = None
    static: float | None = None
    factor: float | None = None


def _peak(found: xr.Dataset, name: str, train: Any) -> _Peak:
    own = found.sel(train=train)
    values, (size, unit) = own[name], scale_of(found, name)
    if not np.isfinite(values.values).any():
        return _Peak(unit)
    index = np.unravel_index(np.nanargmax(values.values), values.shape)
    at = dict(zip(values.dims, index, strict=True))

    def of(ending: str, by: float) -> float | None:
        other = own.get(f"{name}{ending}")
        return None if other is None else by * float(other.isel(at))

    return _Peak(
        unit, size * float(values.isel(at)), float(own["speed"].values[at["speed"]]),
        float(own["x"].values[at["x"]]) if "x" in at else None,
        of("_time", 1.0), of("_static", size), of("_dynamic_factor", 1.0),
    )  # fmt: skip


def key_peaks(found: xr.Dataset) -> list[tuple[Any, ...]]:
    """Return the largest value of each quantity over all trains: what, value, unit, where, when."""
    rows = []
    for name in asked(found):
        own = [(_peak(found, name, train), str(train)) for train in found["train"].values.tolist()]
        own = [(peak, train) for peak, train in own if peak.value is not None]
        if own:
            peak, train = max(own, key=lambda pair: pair[0].value)
            where = train + ("" if peak.x is None else f", x = {peak.x:.4g} m")
            where += f", {peak.speed:.4g} m/s, {in_km_h(peak.speed):.4g} km/h"
            rows.append((label_of(found, name), peak.value, peak.unit, where, None))
    return rows


def pictures(found: xr.Dataset, deck: Deck) -> Iterator[Picture]:
    """Give a picture over the speed for each quantity, at the place where it is largest."""
    for name in asked(found):
        place = _worst_place(found, name)
        if set(found[name].dims) - {"x"} != {"train", "speed"}:
            continue
        if not np.nanmax(np.where(np.isfinite(found[name].values), found[name].values, 0.0)) > 0.0:
            continue
        yield over_speeds(found, name, place, deck)


# ---- studies of any keys


def of_study(found: xr.Dataset) -> Iterator[Table | Picture]:
    """Give the largest values, and pictures where one or two things vary."""
    yield _largest(found)
    for name in asked(found):
        values, place = found[name], _worst_place(found, name)
        dims = [str(d) for d in values.dims if d != "x" and found.sizes[d] > 1]
        rest = [d for d in dims if d != "train"]
        title = label_of(found, name).capitalize() + (f" at x = {place:g} m" if place else "")
        picture = None
        if len(rest) == 1 and found.sizes.get("train", 1) <= _MOST_TRAINS:
            picture = over_one(_squeezed(found, dims), name, place, rest[0], title)
        elif len(rest) == 0 and dims:
            picture = over_one(
                _squeezed(found, dims).rename(train="trains"), name, place, "trains", title
            )
        elif len(rest) == 2:
            picture = _map(found, dims, name, place, title)
        if picture is not None:
            yield picture
    yield _values(found)


def _map(
    found: xr.Dataset, dims: list[str], name: str, place: float | None, title: str
) -> Picture | None:
    own = _squeezed(found, dims)
    if "train" in dims:
        values = own[name]
        worst = values.max([d for d in values.dims if d != "train"]).idxmax("train").item()
        own, title = own.sel(train=worst), f"{title}, train {worst}"
    return over_two(own, name, place, title)


def _squeezed(found: xr.Dataset, dims: list[str]) -> xr.Dataset:
    """Return a study without the dimensions of one value."""
    single = {d: 0 for d in found.sizes if d not in (*dims, "x")}
    return found.isel(single)


def _largest(found: xr.Dataset) -> Table:
    dims = [str(d) for d in found.sizes if d != "x"]
    heads = ["what", ("largest", ""), "unit", *[_head(found, d) for d in dims], ("x", "m"),
             "static", Column("dynamic factor", digits=3)]  # fmt: skip
    rows = []
    for name in asked(found):
        values, (factor, unit) = found[name], scale_of(found, name)
        if not np.isfinite(values.values).any():
            rows.append((label_of(found, name), None, unit, *[None] * (len(dims) + 3)))
            continue
        index = np.unravel_index(np.nanargmax(values.values), values.shape)
        at = dict(zip(values.dims, index, strict=True))
        places = [found[d].values[at[d]] if d in at else None for d in (*dims, "x") if d in found]
        places += [None] * (len(dims) + 1 - len(places))
        static = found.get(f"{name}_static")
        dynamic = found.get(f"{name}_dynamic_factor")
        rows.append((
            label_of(found, name), factor * float(values.isel(at)), unit, *places,
            None if static is None else factor * float(static.isel(at)),
            None if dynamic is None else float(dynamic.isel(at)),
        ))  # fmt: skip
    return Table.of("largest", "Largest values, and where they are", heads, rows)


def _values(found: xr.Dataset) -> Table:
    """Return what was asked for, a row a point and place; on the page where there are few."""
    dims = [str(d) for d in found.sizes if d != "x"]
    frame = studies.table(found)
    names = asked(found)
    places = ["x"] * ("x" in frame.columns)
    heads = [*[_head(found, d) for d in [*dims, *places]]]
    heads += [Column(label_of(found, n), scale_of(found, n)[1]) for n in names]
    factors = [1.0] * (len(dims) + len(places)) + [scale_of(found, n)[0] for n in names]
    rows = [
        tuple(v * f if f != 1.0 else _plain(v) for v, f in zip(row, factors, strict=True))
        for row in frame[[*dims, *places, *names]].itertuples(index=False)
    ]
    return Table.of("values", "Values", heads, rows, on_page=len(rows) <= _MOST_ROWS)


def _head(found: xr.Dataset, dim: str) -> Column:
    return Column(dim, str(found[dim].attrs.get("units", "")), digits=6)


# ---- both


def failures(found: xr.Dataset) -> list[Words | Notes]:
    """Return what is said of crossings without numbers."""
    texts = [text for text in found["message"].values.ravel().tolist() if text]
    if not texts:
        return []
    said = f"{len(texts)} of {found['message'].size} crossings have no numbers:"
    each = list(dict.fromkeys(texts))
    more = [f"and {len(each) - _MOST_FAILURES} other reasons"] * (len(each) > _MOST_FAILURES)
    return [Words(said, "warning"), Notes((*each[:_MOST_FAILURES], *more), "warning")]


def whole(found: xr.Dataset) -> Table:
    """Return all numbers of a study, SI, a row a point and place; in the workbook alone."""
    frame = studies.table(found)
    columns = [Column(str(n), _unit(found, n)) for n in frame.columns]
    rows = [tuple(map(_plain, row)) for row in frame[:_LARGEST_SHEET].itertuples(index=False)]
    return Table("all numbers", "All numbers", tuple(columns), tuple(rows), on_page=False)


def _unit(found: xr.Dataset, name: Any) -> str:
    unit = str(found[name].attrs.get("units", ""))
    return "" if unit == "-" else unit


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
