r"""A crossing in numbers: the summary that engineers look at first, and the histories behind it.

Every extreme is ``{"value", "t"}`` and its place where it has one. Values are SI and dynamic ones,
without the deck's self-weight, which stands apart; what a deck or a train does not have is None,
not zero. The keys are described in ``docs/case.md``. Nothing is computed here that a `Crossing`
cannot be asked.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import cautions, errors, percar
from ..decks import Deck, History, Line
from ..errors import Remark
from ..results import ENVELOPE, Crossing
from ..settings import STATIONS

__all__ = ["QUANTITIES", "HistoryTable", "histories", "summarize", "to_json"]

QUANTITIES = {
    "displacement_z": "m", "displacement_y": "m", "rotation_x": "rad", "acceleration_z": "m/s2",
    "acceleration_y": "m/s2", "moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m",
    "shear_vertical": "N", "rotation_y": "rad", "rotation_z": "rad",
}  # fmt: skip
"""What is told of every point, with units."""


def summarize(
    run: Crossing, points: Sequence[float], remarks: Sequence[Remark] | None = None
) -> dict[str, Any]:
    """Return the summary of a crossing: tables, lists, texts, finite numbers, booleans, None.

    Parameters
    ----------
    run : Crossing
    points : sequence of float
        Places along the deck, m.
    remarks : sequence of Remark, optional
        What the reader must know, in words other than those of `cautions.remarks`.

    Returns
    -------
    dict
        ``vehicle_frequencies_hz`` (of the first kind of car), ``deck_frequencies_hz`` and
        ``deck_mode_names``; ``remarks``; ``converged``, ``iterations`` (solves after the rigid
        one), ``windows``, ``changes``; ``deviation_percent`` (Eq. 3); ``run`` (how it was
        computed);
        ``wheel_force_z`` (N on the deck, static part included: ``min`` is the heaviest),
        ``wheel_force_y`` and ``wheel_unloading`` (1 - force / static); ``points``, ``envelope``,
        ``reactions``, ``car_body``, ``cars`` (the same of every car, see `Crossing.per_car`),
        ``self_weight``.

    Notes
    -----
    ``static`` is the extreme of the static value while the static axle loads, each at its own
    place, move over (V -> 0); ``dynamic_factor`` is the dynamic extreme on the same side divided by
    it. With ``loads`` other than ``wheels`` the factor therefore also holds what condensing costs.

    Accelerations are made of the first modes of the deck, as many as ``acceleration_modes`` in
    ``run`` says are ``kept``. With more modes they settle under Rayleigh damping, slowly under one
    ratio for all, not at all without damping.
    """
    s, deck = errors.instance("run", run, Crossing).settings, run.deck
    remarks = cautions.remarks(run) if remarks is None else remarks
    points = errors.places("points", points, (0.0, deck.length)).tolist()
    kinds = run.train.kinds()
    iterated = s.interaction == "iterate"
    result = {
        "vehicle_frequencies_hz": kinds[0][0].modes().frequencies_hz if kinds else [],
        "deck_frequencies_hz": deck.frequencies_hz,
        "deck_mode_names": list(deck.mode_names),
        "remarks": [str(remark) for remark in remarks],
        "converged": run.converged if iterated else None,
        "iterations": run.solves,
        "windows": None if run.windows is None else len(run.windows.stops),
        "changes": list(run.changes) if iterated else None,
        "deviation_percent": _deviations(run),
        "run": {
            "speed": s.speed, "time_step": s.time_step, "samples": len(run.time),
            "duration": run.time[-1],
            "lead_in": s.lead_in, "track_offset": s.track_offset, "loads": s.loads,
            "interaction": s.interaction, "contact": s.contact, "rail": _rail(deck),
            "acceleration_modes": {
                "up_to_hz": s.accelerations_up_to_hz,
                "kept": int(run.acceleration_modes.sum()), "of": len(deck.frequencies_hz),
            },
        },
        **_wheels(run),
        "points": [{"x": x, **_at_point(run, x)} for x in points],
        "envelope": {name: _envelope(run, name) for name in ENVELOPE},
        "reactions": _reactions(run),
        "car_body": _car_body(run),
        "cars": [
            {"car": car.car, "vehicle": car.vehicle, **car.extremes} for car in run.per_car.cars
        ],
        "self_weight": _self_weight(run, points),
    }  # fmt: skip
    return _plain(result)


def _rail(deck: Deck) -> dict[str, float] | None:
    """Return how a deck's rail spreads loads, as a case says it; None without one."""
    given = {} if deck.rail is None else vars(deck.rail)
    return {name: value for name, value in given.items() if value is not None} or None


def to_json(summary: dict[str, Any]) -> str:
    """Return a summary as the text of ``summary.json``; what is not finite becomes null."""
    return json.dumps(_plain(summary), indent=1, allow_nan=False, ensure_ascii=False) + "\n"


# ---- histories


@dataclass(frozen=True)
class HistoryTable:
    """Histories in columns.

    Attributes
    ----------
    name : str
        ``points``, ``wheels``, ``cars``, ``reactions`` or ``iterations``.
    columns : list of str
        Names with units; the first is ``t``, s.
    values : list of ndarray, shape (n,)
        One for each column.
    """

    name: str
    columns: list[str]
    values: list[np.ndarray]

    def rows(self, chunk: int = 1000) -> Iterator[str]:
        """Yield the lines of a CSV file, a header first, in chunks; nine significant digits."""
        header = io.StringIO()
        csv.writer(header, lineterminator="\n").writerow(self.columns)
        yield header.getvalue()
        line = ",".join(["%.9g"] * len(self.values)) + "\n"
        for start in range(0, len(self.values[0]), chunk):
            block = np.array([v[start : start + chunk] for v in self.values]).T.tolist()
            yield "".join([line % tuple(row) for row in block])


def histories(run: Crossing, points: Sequence[float]) -> Iterator[HistoryTable]:
    """Yield the histories of a crossing, one table after the other.

    ``points``: the quantities of every point the deck has. ``wheels``: lateral and vertical force
    of every wheel on the deck, static part included. ``cars``: lateral and vertical acceleration of
    every car's body, front, middle and rear; only the time for bare axle loads. ``reactions``:
    those of every bearing line. ``iterations``: vertical displacement of the first point (lateral
    if there is no vertical one) after every iteration; iteration 0 is the deck under rigid-deck
    forces.
    """
    time = run.time
    columns, values = ["t"], [time]
    for x in points:
        for name, history in _histories_at(run, float(x)).items():
            if not np.isnan(history[name]).all():
                columns.append(f"x={x:g} {name} ({QUANTITIES[name]})")
                values.append(history[name])
    yield HistoryTable("points", columns, values)
    columns, values = ["t"], [time]
    for wheel, forces in zip(run.train.wheels, run.wheel_forces, strict=True):
        name = f"car {wheel.car} wheel {wheel.number}"
        columns += [f"{name} {f} (N)" for f in ("force_y", "force_z")]
        values += list(forces)
    yield HistoryTable("wheels", columns, values)
    columns, values = ["t"], [time]
    for car in run.per_car.cars:
        history = run.car_accelerations(car.car)
        for name, acceleration in history.values.items():
            if not np.isnan(acceleration).all():
                columns.append(f"car {car.car} {name} ({history.units[name]})")
                values.append(acceleration)
    yield HistoryTable("cars", columns, values)
    columns, values = ["t"], [time]
    for x, history in _known_reactions(run).items():
        for name, force in history.values.items():
            if not np.isnan(force).all():
                columns.append(f"x={x:g} {name} ({history.units[name]})")
                values.append(force)
    yield HistoryTable("reactions", columns, values)
    name = "displacement_z" if run.deck.has["z"] else "displacement_y"
    stages, x = range(run.iterations + 1), float(points[0])
    columns = [f"iteration {i} x={x:g} {name} (m)" for i in stages]
    values = [run.at(i).displacement(x)[name] for i in stages]
    yield HistoryTable("iterations", ["t", *columns], [time, *values])


# ---- parts of the summary


def _plain(value: Any) -> Any:
    """Return tables, lists and plain numbers; None for what is not finite."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _entry(extremes: tuple[tuple[float, float], tuple[float, float]]) -> dict[str, Any] | None:
    """Return min and max of a history with their times; None if there is no finite value."""
    found = zip(("min", "max"), extremes, strict=True)
    entry = {key: {"value": value, "t": round(t, 9)} for key, (value, t) in found}
    return entry if math.isfinite(entry["min"]["value"]) else None


def _deviations(run: Crossing) -> dict[str, Any]:
    if run.iterations == 0:
        return {"from_rigid": [], "from_previous": []}
    with np.errstate(all="ignore"):
        found = run.deviations
    return {"from_rigid": found.from_rigid, "from_previous": found.from_previous}


def _wheels(run: Crossing) -> dict[str, Any]:
    places = [{"car": w.car, "wheel": w.number} for w in run.train.wheels]
    sideways = np.concatenate([percar.held_sideways(car) for car in run.train.formation])
    found = {
        "wheel_force_z": run.wheel_forces[:, 1],
        "wheel_force_y": np.where(sideways[:, None], run.wheel_forces[:, 0], np.nan),
        "wheel_unloading": run.wheel_unloading,
    }
    return {
        name: percar.of_wheels(name, values, run.on_deck, run.time, places)
        for name, values in found.items()
    }


def _histories_at(run: Crossing, x: float) -> dict[str, History]:
    """Return what tells of each of the `QUANTITIES` at x; NaN where the deck has none of it."""
    nothing = np.full(len(run.time), np.nan)
    found = {name: History(run.time, {name: nothing}, QUANTITIES) for name in QUANTITIES}
    told = [run.displacement(x), run.rotations(x), run.acceleration(x)]
    if not run.deck.recovery.lacks:
        told.append(run.section_forces(x))
    for history in told:
        found.update({name: history for name in history.values if name in QUANTITIES})
    return found


def _at_point(run: Crossing, x: float) -> dict[str, Any]:
    """Return extremes, static value and dynamic factor of every quantity at one place."""
    recovery, length = run.deck.recovery, run.deck.length
    grid = np.linspace(0.0, length, STATIONS)
    lines: dict[str, Line | None] = {}
    for name in QUANTITIES:
        if name.startswith("acceleration"):
            continue
        line, usual = recovery.section(name, x), recovery.section(name, 0.4 * length)
        if line is not None:
            # None where it is zero, as of the moment at an end.
            least = 1e-8 * np.abs(usual.influence(grid)).max()
            line = None if np.abs(line.influence(grid)).max() < least else line
        lines[name] = line
    return _entries(run, _histories_at(run, x), lines)


def _known_reactions(run: Crossing) -> dict:
    return {} if run.deck.recovery.lacks else run.reactions()


def _reactions(run: Crossing) -> list[dict[str, Any]]:
    result = []
    for x, history in _known_reactions(run).items():
        lines = {name: run.deck.recovery.reaction(name, x) for name in history.values}
        result.append({"x": x, **_entries(run, dict.fromkeys(history.values, history), lines)})
    return result


def _entries(
    run: Crossing, histories: dict[str, History], lines: dict[str, Line | None]
) -> dict[str, Any]:
    """Return extremes, static value and dynamic factor of every quantity at one place."""
    result = {}
    for name, history in histories.items():
        entry = _entry(history.extremes(name))
        if entry is not None:
            line = lines.get(name)
            low, high = (0.0, 0.0) if line is None else run.static_extremes(line)
            # Where both sides are alike, as for shear at mid-span, the dynamic value decides, not
            # round-off.
            alike = abs(low + high) <= 1e-6 * max(-low, high)
            size = (-entry["min"]["value"], entry["max"]["value"]) if alike else (-low, high)
            side, static = ("min", low) if size[0] > size[1] else ("max", high)
            entry["static"] = static
            entry["dynamic_factor"] = entry[side]["value"] / static if static else None
        result[name] = entry
    return result


def _envelope(run: Crossing, name: str) -> dict[str, Any] | None:
    """Smallest and largest value along the deck with place and time, and at every station."""
    found = run.envelope(name)
    if found is None:
        return None
    extremes = [found.at(i).extremes("value") for i in range(len(found.x))]
    low, high = (np.array([e[side][0] for e in extremes]) for side in (0, 1))
    if not np.isfinite(low).all():
        return None
    entry: dict[str, Any] = {}
    for key, place in (("min", np.argmin(low)), ("max", np.argmax(high))):
        entry[key] = _entry(extremes[place])[key] | {"x": found.x[place]}
    entry["stations"] = {"x": found.x, "min": low, "max": high}
    return entry


def _car_body(run: Crossing) -> dict[str, Any]:
    """Return the extremes of the car bodies' accelerations, with car and place.

    And the body, where a car has several: the coaches of an articulated train.
    """
    result: dict[str, Any] = dict.fromkeys(("acceleration_z", "acceleration_y"))
    for name in result:
        moved = [car for car in run.per_car.cars if car.extremes[name]]
        if moved:
            result[name] = {
                side: worst([{**car.extremes[name][side], "car": car.car} for car in moved],
                            key=lambda found: found["value"])
                for side, worst in (("min", min), ("max", max))
            }  # fmt: skip
    return result


def _self_weight(run: Crossing, points: Sequence[float]) -> dict[str, Any]:
    """Return what the deck's own weight gives: at every point, and at every bearing line."""
    recovery = run.deck.recovery

    def weight(line: Line | None) -> float | None:
        return None if line is None else line.self_weight

    supports = () if recovery.lacks else run.deck.supports
    return {
        "displacement_z": [weight(recovery.section("displacement_z", x)) for x in points],
        "moment_vertical": [weight(recovery.section("moment_vertical", x)) for x in points],
        "force_z": [weight(recovery.reaction("force_z", x)) for x in supports],
    }
