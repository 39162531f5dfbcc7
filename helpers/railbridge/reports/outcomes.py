"""Results of one crossing as tables: extremes with place and time, in the units of pictures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ..cases.summary import QUANTITIES
from .parts import Column, Table, of_quantity

__all__ = ["key_results", "tables_of_summary"]

_REACTIONS = {
    "force_x": ("longitudinal reaction", 1e-3, "kN"),
    "force_y": ("lateral reaction", 1e-3, "kN"),
    "force_z": ("vertical reaction", 1e-3, "kN"),
    "moment_x": ("reaction moment about x", 1e-3, "kN m"),
}
_MOST_CARS = 40
"""Rows of a table on the page."""
_MIN_MAX = ("smallest", Column("at", "s"), "largest", Column("at", "s"))


def tables_of_summary(s: Mapping[str, Any]) -> Iterator[Table]:
    """Give the tables of a summary; see `cases.summary.summarize`."""
    yield _at_points(s["points"])
    yield from _along(s["envelope"])
    if s["reactions"]:
        yield _reactions(s["reactions"])
    if s["wheel_unloading"] is not None:
        yield _wheels(s)
    if any(car["wheel_unloading"] is not None for car in s["cars"]):
        yield _cars(s["cars"])
    bodies = [_of_bodies(name, entry) for name, entry in s["car_body"].items() if entry is not None]
    if bodies:
        heads = ["what", "unit", "smallest", ("at", "s"), "where", "largest", ("at", "s"), "where"]
        yield Table.of("car bodies", "Accelerations of the car bodies", heads, bodies)
    yield from _self_weight(s)
    if s["changes"]:
        yield _passes(s)


def _at_points(points: Sequence[Mapping[str, Any]]) -> Table:
    heads = [("x", "m"), "what", "unit", *_MIN_MAX, "static", Column("dynamic factor", digits=3)]
    rows = []
    for point in points:
        for name in QUANTITIES:
            entry = point[name]
            if entry is not None:
                rows.append((point["x"], *_entry(entry, *of_quantity(name))))
    note = (
        "Without the deck's self-weight. Static: the extreme while the static axle loads move "
        "over; the dynamic factor is the dynamic extreme on the same side divided by it."
    )
    return Table.of("extremes", "Extremes at the points of output", heads, rows, note=note)


def _entry(entry: Mapping[str, Any], words: str, factor: float, unit: str) -> tuple[Any, ...]:
    """Return name, unit, both extremes with times, static value and dynamic factor."""
    low, high, static = entry["min"], entry["max"], entry["static"]
    has_static = static not in (None, 0.0)
    return (
        words, unit, factor * low["value"], low["t"], factor * high["value"], high["t"],
        factor * static if has_static else None, entry["dynamic_factor"] if has_static else None,
    )  # fmt: skip


def _along(envelope: Mapping[str, Any]) -> Iterator[Table]:
    rows, stations = [], {}
    for name, entry in envelope.items():
        if entry is None:
            continue
        words, factor, unit = of_quantity(name)
        low, high = entry["min"], entry["max"]
        rows.append((words, unit, factor * low["value"], low["x"], low["t"],
                     factor * high["value"], high["x"], high["t"]))  # fmt: skip
        stations.setdefault(("x", "m"), entry["stations"]["x"])
        for key, word in (("min", "smallest"), ("max", "largest")):
            values = entry["stations"][key]
            stations[f"{word} {words}", unit] = [None if v is None else factor * v for v in values]
    if not rows:
        return
    heads = ["what", "unit", "smallest", Column("x", "m"), ("at", "s"), "largest",
             Column("x", "m"), ("at", "s")]  # fmt: skip
    yield Table.of("envelope", "Extremes along the whole deck", heads, rows)
    yield Table.of("along the deck", "Envelope along the deck", list(stations),
                   zip(*stations.values(), strict=True), on_page=False)  # fmt: skip


def _reactions(reactions: Sequence[Mapping[str, Any]]) -> Table:
    heads = [("bearing line at", "m"), "what", "unit", *_MIN_MAX, "static",
             Column("dynamic factor", digits=3)]  # fmt: skip
    rows = []
    for line in reactions:
        for name, how in _REACTIONS.items():
            entry = line.get(name)
            if entry is not None and (entry["min"]["value"] or entry["max"]["value"]):
                rows.append((line["x"], *_entry(entry, *how)))
    note = "Forces on the deck, up positive; without the deck's self-weight."
    return Table.of("reactions", "Reactions of the bearing lines", heads, rows, note=note)


def _wheels(s: Mapping[str, Any]) -> Table:
    rows = []
    for where, pick in (("whole record", lambda e: e), ("on the deck", lambda e: e["on_deck"])):
        force, unloading = pick(s["wheel_force_z"]), pick(s["wheel_unloading"])
        if force is not None:
            for key, words in (("min", "heaviest wheel force"), ("max", "lightest wheel force")):
                rows.append(_wheel(where, words, "kN", 1e-3, force[key]))
        if unloading is not None and unloading["max"] is not None:
            words = "largest unloading, 1 - force / static"
            rows.append(_wheel(where, words, "-", 1.0, unloading["max"]))
    heads = ["where", "what", "unit", "value", ("at", "s"), "car", "wheel"]
    note = (
        "Vertical forces on the deck, static part included; up positive, so a weight is negative."
    )
    return Table.of("wheels", "Wheel forces", heads, rows, note=note)


def _wheel(
    where: str, words: str, unit: str, factor: float, found: Mapping[str, Any]
) -> tuple[Any, ...]:
    return where, words, unit, factor * found["value"], found["t"], found["car"], found["wheel"]


def _cars(cars: Sequence[Mapping[str, Any]]) -> Table:
    """Return for each car its wheels and its body, the largest magnitude of each."""

    def most(entry: Mapping[str, Any] | None, factor: float = 1.0) -> float | None:
        if entry is None:
            return None
        return max((factor * e["value"] for k, e in entry.items() if k in ("min", "max")), key=abs)

    heads = ["car", "vehicle", ("vertical wheel force", "kN"), ("lateral wheel force", "kN"),
             Column("unloading", digits=3), ("vertical acceleration", "m/s²"),
             ("lateral acceleration", "m/s²")]  # fmt: skip
    rows = [
        (
            c["car"], c["vehicle"], most(c["wheel_force_z"], 1e-3), most(c["wheel_force_y"], 1e-3),
            most(c["wheel_unloading"]), most(c["acceleration_z"]), most(c["acceleration_y"]),
        )
        for c in cars
    ]  # fmt: skip
    note = "Of each the value of largest magnitude over the whole record, static part included in "
    note += "wheel forces; accelerations are those of the body."
    return Table.of("cars", "Every car", heads, rows, note=note, on_page=len(rows) <= _MOST_CARS)


def _of_bodies(name: str, entry: Mapping[str, Any]) -> tuple[Any, ...]:
    words, factor, unit = of_quantity(name)
    cells: list[Any] = [words, unit]
    for key in ("min", "max"):
        found = entry[key]
        body = f", {found['body']}" if "body" in found else ""
        cells += [
            factor * found["value"],
            found["t"],
            f"car {found['car']}{body}, {found['place']}",
        ]
    return tuple(cells)


def _self_weight(s: Mapping[str, Any]) -> Iterator[Table]:
    own, rows = s["self_weight"], []
    for name in ("displacement_z", "moment_vertical"):
        words, factor, unit = of_quantity(name)
        for point, value in zip(s["points"], own[name], strict=True):
            if value is not None:
                rows.append((point["x"], words, unit, factor * value))
    for line, value in zip(s["reactions"], own["force_z"], strict=False):
        if value is not None:
            rows.append((line["x"], *_REACTIONS["force_z"][::2], 1e-3 * value))
    if rows:
        heads = [("x", "m"), "what", "unit", "value"]
        note = "To be added where the whole is wanted; it is in no other table."
        yield Table.of("self-weight", "The deck's self-weight", heads, rows, note=note)


def _passes(s: Mapping[str, Any]) -> Table:
    rigid = s["deviation_percent"]["from_rigid"]
    before = s["deviation_percent"]["from_previous"]
    changes = s["changes"]
    padded = [[*own, *[None] * (len(changes) - len(own))] for own in (rigid, before)]
    rows = zip(range(1, len(changes) + 1), changes, *padded, strict=True)
    heads = ["pass", "change", ("from rigid", "%"), ("from previous", "%")]
    return Table.of("passes", "Passes of the iteration", heads, rows, on_page=False)


def key_results(s: Mapping[str, Any]) -> list[tuple[Any, ...]]:
    """Return the few numbers that are looked at first: what, value, unit, where, when."""
    rows = []
    for name in ("displacement_z", "acceleration_z", "moment_vertical"):
        entry = s["envelope"][name]
        if entry is None:
            continue
        words, factor, unit = of_quantity(name)
        worst = max((entry["min"], entry["max"]), key=lambda e: abs(e["value"]))
        where = f"x = {worst['x']:.4g} m"
        rows.append((f"largest {words}", factor * worst["value"], unit, where, worst["t"]))
    for entry, words in ((s["wheel_unloading"], "largest wheel unloading"),):
        if entry is not None and entry["max"] is not None:
            own = entry["max"]
            where = f"car {own['car']}, wheel {own['wheel']}"
            rows.append((words, own["value"], "-", where, own["t"]))
    body = s["car_body"]["acceleration_z"]
    if body is not None:
        worst = max((body["min"], body["max"]), key=lambda e: abs(e["value"]))
        where = f"car {worst['car']}, {worst['place']}"
        about = "largest vertical acceleration of a car body"
        rows.append((about, worst["value"], "m/s²", where, worst["t"]))
    return rows
