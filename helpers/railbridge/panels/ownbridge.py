"""The panel of notebook 11: a bridge by its numbers, over the speeds of a line, and verdicts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from .. import plots
from ..cases.definition import Case
from ..cases.simplebridge import SimpleBridge
from ..errors import Remark
from .control import Control
from .panel import Panel, Progress
from .shared import Values

__all__ = ["own_bridge"]

TRAINS = ("HSLM-A1", "HSLM-A4", "HSLM-A10", "ICE2", "AVE-S100", "Talgo350")
FEW = 25
"""Speeds while a control moves."""
_MODES = 5
"""Enough for accelerations from 1.2 Hz on; each more makes the steps finer."""
STATIONS = 5
"""Along the deck."""
_LIMIT = "deck acceleration"


def own_bridge(case: Case | None = None) -> Panel:
    """Panel of notebook 11: acceleration of a deck over the speed, and how much of limits is used.

    Parameters
    ----------
    case : Case, optional
        Of a deck given by ``length``, ``bending_stiffness_vertical`` and ``mass``, with a train
        that has a ``name``, and with the table ``checks``; that of a `SimpleBridge`, for instance.
        If not given, 20 m of prestressed concrete on a line for 200 km/h.
    """
    base = SimpleBridge(
        span=20.0, mass=12000.0, bending_stiffness=3e10, kind="prestressed concrete",
        line_speed=55.5,
    ).case().replace({"deck.modes": _MODES}) if case is None else case  # fmt: skip

    def draw(axes: Any, case: Case, found: Any, values: Values) -> None:
        limit = _shaken(found).limit
        plots.envelope(
            found.envelope, "acceleration_z", x=found.deck.length / 2, ax=axes["acceleration"],
            limit=limit,
        )  # fmt: skip
        plots.utilisation(found.verdicts, axes["verdicts"])

    def say(case: Case, found: Any, values: Values) -> str:
        # What is not decided has no value in its verdict, but is known all the same.
        largest = found.per_train().xs(_LIMIT, level="what").value.max()
        f1 = found.deck.frequencies_hz[0]
        kmh = 3.6 * values["line_speed"]
        failed = [row.clause.title for row in found.verdicts if row.verdict == "not met"]
        open_ones = sum(row.verdict == "cannot decide" for row in found.verdicts)
        told = f"Not met: {', '.join(failed) or 'none'}; not decided: {open_ones}"
        return (
            f"{values['span']:.1f} m, {values['mass'] / 1e3:.1f} t/m, "
            f"E I = {values['stiffness'] / 1e9:.1f} GN m2, damping "
            f"{100 * values['damping']:.2f} %: first frequency {f1:.2f} Hz. {values['train']} on a "
            f"line for {kmh:.0f} km/h: largest acceleration {largest:.2f} m/s2 "
            f"({_shaken(found).verdict}), limit {_shaken(found).limit:.1f}. {told} of "
            f"{len(found.verdicts)}."
        )

    listed = dict.fromkeys((base.get("train.name"), *TRAINS))
    return Panel(
        base,
        [
            Control("line_speed", "speed of the line (km/h)", ("checks.line_speed",), 25.0, 100.0,
                    0.5, 3.6, "m/s"),
            Control("span", "span (m)", ("deck.length",), 10.0, 50.0, 0.5, unit="m"),
            Control("mass", "mass (t/m)", ("deck.mass",), 6e3, 40e3, 250.0, 1e-3, "kg/m"),
            Control("stiffness", "E I (GN m²)", ("deck.bending_stiffness_vertical",), 5e9, 1e11,
                    5e8, 1e-9, "N m2"),
            Control("damping", "damping ratio (%)", ("deck.damping.modal",), 0.0025, 0.04, 5e-4,
                    100.0),
            Control("train", "train", ("train.name",), choices=tuple(listed)),
        ],
        [["acceleration"], ["verdicts"]],
        draw,
        say,
        compute=_assessed,
        preview=_at_a_few_speeds,
        preview_note=f"Moving: {FEW} speeds only; all follow.",
        remarks=_none,
        code=f"found = case.assess(stations={STATIONS})\n"
        'rb.plots.envelope(found.envelope, "acceleration_z", limit=3.5)\n'
        "rb.plots.utilisation(found.verdicts)\n"
        f'found.per_train().xs("{_LIMIT}", level="what").value.max()  # m/s2',
        size=(9.0, 6.0),
        heights=(1.0, 1.1),
        start_name="at the start",
    )  # fmt: skip


def _assessed(case: Case, progress: Progress | None) -> Any:
    return case.assess(stations=STATIONS, progress=_between(progress))


def _at_a_few_speeds(case: Case, progress: Progress | None) -> Any:
    return case.assess(speeds=FEW, stations=STATIONS, progress=_between(progress))


def _between(progress: Progress | None) -> Callable[[int, int], None] | None:
    """Return what a study calls between its chunks, so that it can be given up there."""
    return None if progress is None else lambda done, of: progress("")


def _none(case: Case, found: Any) -> Sequence[Remark]:
    """Return no remarks: what is doubtful stands in the verdicts."""
    return ()


def _shaken(found: Any) -> Any:
    """Return the verdict on the deck's acceleration."""
    return next(row for row in found.verdicts if row.clause.title == _LIMIT)
