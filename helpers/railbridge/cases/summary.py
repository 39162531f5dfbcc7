r"""A crossing in numbers: the summary that engineers look at first, and the histories behind it.

Every extreme is ``{"value", "t"}`` and its place where it has one. Values are SI and dynamic ones, without the deck's
self-weight, which stands apart; what a deck or a train does not have is None, not zero. The keys are described in
``docs/case.md``.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..crossing import Crossing
from ..decks import REACTION_QUANTITIES, Deck, Line, PiecewiseCubic
from ..errors import InputError
from ..settings import Settings
from ..trains import AxleTrain, Train

__all__ = ["QUANTITIES", "HistoryTable", "bytes_needed", "histories", "refuse_too_large", "summarize", "to_json"]

QUANTITIES = {
    "displacement_z": "m", "displacement_y": "m", "rotation_x": "rad", "acceleration_z": "m/s2", "acceleration_y": "m/s2",
    "moment_vertical": "N m", "moment_lateral": "N m", "torsion": "N m", "shear_vertical": "N",
}  # fmt: skip
"""What is told of every point, with units."""

ENVELOPE = ("displacement_z", "acceleration_z", "moment_vertical", "moment_lateral", "torsion")
STATIONS = 41
"""Places along the deck where the envelope is taken, ends included."""

PLACES = ("front", "middle", "rear")
MEMORY_LIMIT = 2e9
"""Bytes a run may need."""


def summarize(run: Crossing, points: Sequence[float]) -> dict[str, Any]:
    """Return the summary of a crossing: tables, lists, texts, finite numbers, booleans and None only.

    Parameters
    ----------
    run : Crossing
    points : sequence of float
        Places along the deck, m.

    Returns
    -------
    dict
        ``vehicle_frequencies_hz`` (of the first kind of car), ``deck_frequencies_hz`` and ``deck_mode_names``; ``remarks``;
        ``converged``, ``iterations`` (solves after the rigid one), ``changes``; ``deviation_percent`` (Eq. 3);
        ``run`` (how it was computed); ``wheel_force_z`` (N on the deck, static part included: ``min`` is the heaviest) and
        ``wheel_unloading`` (1 - force / static); ``points``, ``envelope``, ``reactions``, ``car_body``, ``self_weight``.

    Notes
    -----
    ``static`` is the extreme of the static value while the static axle loads, each at its own place, move over (V -> 0);
    ``dynamic_factor`` is the dynamic extreme on the same side divided by it. With ``loads`` other than ``wheels`` the factor
    therefore also holds what condensing costs.

    Accelerations do not converge with the number of modes: the cut-off is the last of ``deck_frequencies_hz``.
    """
    s, deck = run.settings, run.deck
    points = [float(x) for x in points]
    groups = run.train.groups()
    iterated = s.interaction == "iterate"
    result = {
        "vehicle_frequencies_hz": groups[0][0].modes().frequencies_hz if groups else [],
        "deck_frequencies_hz": deck.frequencies_hz,
        "deck_mode_names": list(deck.mode_names),
        "remarks": _remarks(deck),
        "converged": run.converged if iterated else None,
        "iterations": run.iterations if iterated else 0,
        "changes": list(run.changes) if iterated else None,
        "deviation_percent": _deviations(run),
        "run": {
            "speed": s.speed, "time_step": s.time_step, "samples": len(run.time), "duration": run.time[-1],
            "lead_in": s.lead_in, "track_offset": s.track_offset, "loads": s.loads, "interaction": s.interaction,
        },
        **_wheels(run),
        "points": [{"x": x, **_entries(run, _at_point(run, x), _lines(run, x))} for x in points],
        "envelope": _envelope(run),
        "reactions": [{"x": x, **_entries(run, h.values, _reaction_lines(run, x))} for x, h in _reactions(run).items()],
        "car_body": _car_body(run),
        "self_weight": _self_weight(run, points),
    }  # fmt: skip
    return _plain(result)


def _remarks(deck: Deck) -> list[str]:
    """Return what a reader must know before reading the numbers."""
    if deck.recovery is not None:
        return []
    return [
        "Only modes of this deck are known: section forces, reactions and self-weight are null, and displacements lack the "
        "static flexibility of the modes left out."
    ]


def to_json(summary: dict[str, Any]) -> str:
    """Return the summary as the text of ``summary.json``."""
    return json.dumps(summary, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


@dataclass(frozen=True)
class HistoryTable:
    """Histories in columns.

    Attributes
    ----------
    name : str
        ``points``, ``wheels``, ``reactions`` or ``iterations``.
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
        yield ",".join(self.columns) + "\n"
        line = ",".join(["%.9g"] * len(self.values)) + "\n"
        for start in range(0, len(self.values[0]), chunk):
            block = np.array([v[start : start + chunk] for v in self.values]).T.tolist()
            yield "".join([line % tuple(row) for row in block])


def histories(run: Crossing, points: Sequence[float]) -> Iterator[HistoryTable]:
    """Yield the histories of a crossing, one table after the other.

    ``points``: the quantities of every point the deck has. ``wheels``: lateral and vertical force of every wheel on the deck,
    static part included. ``reactions``: those of every bearing line. ``iterations``: vertical displacement of the first point
    (lateral if there is no vertical one) after every iteration; iteration 0 is the deck under rigid-deck forces.
    """
    time = run.time
    columns, values = ["t"], [time]
    for x in points:
        for name, history in _at_point(run, float(x)).items():
            if not np.isnan(history).all():
                columns.append(f"x={x:g} {name} ({QUANTITIES[name]})")
                values.append(history)
    yield HistoryTable("points", columns, values)
    columns, values = ["t"], [time]
    for wheel, forces in zip(run.train.wheels, run.wheel_forces, strict=True):
        columns += [f"car {wheel.car} wheel {wheel.number} {f} (N)" for f in ("force_y", "force_z")]
        values += list(forces)
    yield HistoryTable("wheels", columns, values)
    columns, values = ["t"], [time]
    for x, history in _reactions(run).items():
        for name, force in history.values.items():
            if not np.isnan(force).all():
                columns.append(f"x={x:g} {name} ({history.units[name]})")
                values.append(force)
    yield HistoryTable("reactions", columns, values)
    component = 1 if run.deck.has["z"] else 0
    shape = run.deck.shapes(np.array([float(points[0])]))[0, :, component]
    columns = [f"iteration {i} x={points[0]:g} displacement_{'yz'[component]} (m)" for i in range(run.iterations + 1)]
    values = [shape @ run.at(i).state.q for i in range(run.iterations + 1)]
    yield HistoryTable("iterations", ["t", *columns], [time, *values])


def bytes_needed(train: Train | AxleTrain, deck: Deck, settings: Settings, points: int = 1) -> float:
    """Return about how much memory a run, its summary and its histories need, bytes."""
    s = settings
    advance = s.speed * s.time_step
    samples = (deck.length + train.length) / advance + s.tail / s.time_step
    wheels = len(train.wheels)
    cars = max(w.car for w in train.wheels)
    places = {c: [w.delay for w in train.wheels if w.car == c] for c in {w.car for w in train.wheels}}
    longest = max(max(p) - min(p) for p in places.values())
    on_deck = min((deck.length + longest) / advance + 3, samples)
    # Cars of one kind that meet the samples alike are computed together; each other way costs a run of its own.
    runs = len({(id(v), round(min(places[c + 1]) / advance % 1.0, 6)) for v, own in train.groups() for c in own})
    passes = {"iterate": s.iterations or s.max_iterations, "direct": 1, "rigid": 0}[s.interaction]
    kept = runs * 2 * wheels / cars * (s.lead_in / advance + samples)
    working = 60.0 * (s.lead_in / advance + samples)
    state = 10.0 * len(deck.frequencies_hz) * samples + (0 if s.interaction == "rigid" else passes * samples)
    forces = 6.0 * wheels * samples + 20.0 * cars * samples
    iterated = (passes + 8.0) * 2 * wheels * on_deck
    return 8.0 * (kept + working + state + forces + iterated + (5.0 * STATIONS + 9.0 * points) * samples) + 1.2e8


def refuse_too_large(
    train: Train | AxleTrain, deck: Deck, settings: Settings, points: int = 1, limit: float = MEMORY_LIMIT
) -> float:
    """Return the estimate of `bytes_needed`, or refuse what would need more than `limit`, before anything is computed.

    Raises
    ------
    InputError
        Naming ``run.time_step`` and the estimate.
    """
    needed = bytes_needed(train, deck, settings, points)
    if needed > limit:
        raise InputError(
            "run.time_step",
            settings.time_step,
            f"this run would need about {needed / 1e9:.3g} GB of memory, the limit is {limit / 1e9:.3g} GB",
            "Use a larger run.time_step, fewer cars, a shorter run.lead_in or run.tail, or a smaller run.max_iterations",
        )
    return needed


def _plain(value: Any) -> Any:
    """Return tables, lists and plain numbers; None for what is not finite."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _extreme(values: np.ndarray, time: np.ndarray, smallest: bool, places: Sequence[dict] = ({},)) -> dict | None:
    """Return the smallest or largest of histories, shape (places, n) or (n,), with its time and place; None if there is none."""
    values = values.reshape(len(places), -1)
    finite = np.isfinite(values)
    if not finite.any():
        return None
    searched = np.where(finite, values, np.inf if smallest else -np.inf)
    where, when = np.unravel_index(np.argmin(searched) if smallest else np.argmax(searched), values.shape)
    return {"value": values[where, when], "t": round(float(time[when]), 9), **places[where]}


def _both(values: np.ndarray, time: np.ndarray, places: Sequence[dict] = ({},)) -> dict[str, Any] | None:
    found = {"min": _extreme(values, time, True, places), "max": _extreme(values, time, False, places)}
    return None if found["min"] is None else found


def _deviations(run: Crossing) -> dict[str, Any]:
    if run.iterations == 0:
        return {"from_rigid": [], "from_previous": []}
    with np.errstate(all="ignore"):
        found = run.deviations
    return {"from_rigid": found.from_rigid, "from_previous": found.from_previous}


def _wheels(run: Crossing) -> dict[str, Any]:
    forces = run.wheel_forces[:, 1]
    places = [{"car": w.car, "wheel": w.number} for w in run.train.wheels]
    unloading = 1.0 + forces / np.array([w.static_load for w in run.train.wheels])[:, None]
    return {
        "wheel_force_z": _both(forces, run.time, places),
        "wheel_unloading": {"max": _extreme(unloading, run.time, False, places)},
    }


def _at_point(run: Crossing, x: float) -> dict[str, np.ndarray]:
    """Return the histories of all `QUANTITIES` at x; NaN where the deck has no such stiffness."""
    found = {**run.displacement(x).values, **run.acceleration(x).values}
    if run.deck.recovery is not None:
        found.update(run.section_forces(x).values)
    nothing = np.full(len(run.time), np.nan)
    return {name: found.get(name, nothing) for name in QUANTITIES}


def _lines(run: Crossing, x: float) -> dict[str, Line | None]:
    """Return the influence line of every quantity at x that has one; None where it is zero, as of the moment at an end."""
    deck, recovery = run.deck, run.deck.recovery
    grid = np.linspace(0.0, deck.length, STATIONS)
    found: dict[str, Line | None] = {}
    for name in QUANTITIES:
        if name.startswith("acceleration"):
            continue
        if recovery is not None:
            line, usual = recovery.section(name, x), recovery.section(name, 0.4 * deck.length)
            zero = line is None or np.abs(line.influence(grid)).max() < 1e-8 * np.abs(usual.influence(grid)).max()
            found[name] = None if zero else line
        elif name in ("displacement_y", "displacement_z", "rotation_x"):
            # Only modes are known: the flexibility they have together.
            component = ("displacement_y", "displacement_z", "rotation_x").index(name)
            share = deck.shapes(np.array([x]))[0, :, component] / (2 * np.pi * deck.frequencies_hz) ** 2
            shape = np.einsum("epmc,m->epc", deck.shapes.coefficients, share)[:, :, None]
            found[name] = Line(share, PiecewiseCubic(deck.shapes.edges, shape), np.nan)
    return found


def _reactions(run: Crossing) -> dict:
    return run.reactions() if run.deck.recovery is not None else {}


def _reaction_lines(run: Crossing, x: float) -> dict[str, Line | None]:
    return {name: run.deck.recovery.reaction(name, x) for name in REACTION_QUANTITIES}


def _entries(run: Crossing, values: dict[str, np.ndarray], lines: dict[str, Line | None]) -> dict[str, Any]:
    """Return extremes, static value and dynamic factor of every quantity at one place."""
    result = {}
    for name, history in values.items():
        entry = _both(history, run.time)
        if entry is not None:
            line = lines.get(name)
            static = (0.0, 0.0) if line is None else _static_extremes(run, line)
            # Where both sides are alike, as for shear at mid-span, the dynamic value decides, not round-off.
            alike = abs(static[0] + static[1]) <= 1e-6 * max(-static[0], static[1])
            size = (-entry["min"]["value"], entry["max"]["value"]) if alike else (-static[0], static[1])
            side = "min" if size[0] > size[1] else "max"
            entry["static"] = static[side == "max"]
            entry["dynamic_factor"] = entry[side]["value"] / entry["static"] if entry["static"] else None
        result[name] = entry
    return result


def _static_extremes(run: Crossing, line: Line) -> tuple[float, float]:
    """Return the smallest (zero at most) and largest (zero at least) value while the static axle loads move over, V -> 0.

    Places of the train: steps of 1/500 of the deck, and every axle just before and behind every end of the line's pieces
    that may be a kink or a jump, so that peaks are met exactly.
    """
    deck, offset = run.deck, run.settings.track_offset
    axles: dict[float, np.ndarray] = {}
    for w in run.train.wheels:
        load = np.array([0.0, -w.static_load, -w.static_load * (offset + w.y)])
        axles[round(w.delay, 9)] = axles.get(round(w.delay, 9), 0.0) + load
    delays, loads = np.array(list(axles)), np.array(list(axles.values()))
    grid = np.linspace(0.0, deck.length, 501)
    edges = line.influence.edges
    near = np.concatenate([edges - 1e-9 * deck.length, edges + 1e-9 * deck.length])
    near = near[(near >= 0.0) & (near <= deck.length)]
    step = grid[1]
    first = np.arange(0.0, deck.length + delays.max() + step, step)
    # The peaks of the line itself decide: only its kinks next to the largest values matter.
    size = np.abs(line.influence(near)[:, 0, 1:]).max(axis=1)
    near = near[np.argsort(size)[-8:]]
    first = np.unique(np.concatenate([first, (delays[:, None] + near).ravel()]))
    total = np.zeros(len(first))
    for delay, load in zip(delays, loads, strict=True):
        x = first - delay
        on = (x >= 0.0) & (x <= deck.length)
        total[on] += line.influence(x[on])[:, 0] @ load
    noise = 1e-12 * float(np.abs(loads).max() * np.abs(line.influence(grid)).max())
    low, high = float(total.min()), float(total.max())
    return (low if low < -noise else 0.0), (high if high > noise else 0.0)


def _envelope(run: Crossing) -> dict[str, Any]:
    """Return smallest and largest value along the deck, with place and time, and both at every station."""
    x = np.linspace(0.0, run.deck.length, STATIONS).round(9)
    places = [{"x": place} for place in x]
    result = {}
    for name in ENVELOPE:
        values = _along(run, name, x)
        entry = None if values is None else _both(values, run.time, places)
        if entry is not None:
            entry["stations"] = {"x": x, "min": values.min(axis=1), "max": values.max(axis=1)}
        result[name] = entry
    return result


def _along(run: Crossing, name: str, x: np.ndarray) -> np.ndarray | None:
    """Return a quantity at many places at once, shape (places, n); None where the deck has no such stiffness."""
    deck, state = run.deck, run.state
    if name in ("displacement_z", "acceleration_z"):
        if not deck.has["z"]:
            return None
        modal = state.q if name == "displacement_z" else deck.acceleration(state.q, state.velocity, state.modal_force)
        return deck.shapes(x)[:, :, 1] @ modal
    lines = [deck.recovery.section(name, place) for place in x] if deck.recovery is not None else [None]
    if lines[0] is None:
        return None
    modal = np.array([line.modal for line in lines])
    result = modal @ state.q
    result -= (modal / (2 * np.pi * deck.frequencies_hz) ** 2) @ state.modal_force
    result += run.statics(lines)
    return result


def _car_body(run: Crossing) -> dict[str, Any]:
    """Return the extremes of the car bodies' accelerations over the whole record, with car and place."""
    accelerations = run.body_accelerations
    places = [{"car": car + 1, "place": p} for car in range(len(accelerations)) for p in PLACES]
    result: dict[str, Any] = {}
    for component, name in ((1, "acceleration_z"), (0, "acceleration_y")):
        free = any(name[-1] in v.body.freedoms for v, _ in run.train.groups())
        result[name] = _both(accelerations[:, :, component], run.time, places) if free else None
    return result


def _self_weight(run: Crossing, points: Sequence[float]) -> dict[str, Any]:
    """Return what the deck's own weight gives: at every point, and at every bearing line."""
    recovery = run.deck.recovery

    def weight(line: Line | None) -> float | None:
        return None if line is None else line.self_weight

    if recovery is None:
        return {"displacement_z": [None] * len(points), "moment_vertical": [None] * len(points), "force_z": []}
    return {
        **{n: [weight(recovery.section(n, x)) for x in points] for n in ("displacement_z", "moment_vertical")},
        "force_z": [weight(recovery.reaction("force_z", x)) for x in run.deck.supports],
    }
