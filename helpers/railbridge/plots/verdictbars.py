"""Verdicts as bars: how much of each limit is used."""

from __future__ import annotations

import math

from matplotlib.axes import Axes

from ..codes import Verdict, Verdicts
from ..errors import InputError, instance
from .drawing import axes_or_new, curve, label_axes, note
from .style import GREY, literal

__all__ = ["LONG", "SHOWN", "utilisation"]

_COLOURS = {"met": "#009E73", "not met": "#D55E00", "cannot decide": GREY}
_END = 2.0
"""Where bars are cut: what is used twice over is not met, however much more it is."""
SHOWN = {"m": ("mm", 1e3), "rad": ("mrad", 1e3), "N": ("kN", 1e-3), "N m": ("kN m", 1e-3)}
"""In which units values and limits are shown, and the factor from SI."""
LONG = 1.0
"""m, from which on lengths are shown as they are: a radius is no deflection."""
_ROW = 0.3
"""Inches of a row in a figure of its own."""


def utilisation(verdicts: Verdicts, ax: Axes | None = None) -> Axes:
    """Plot how much of each limit is used, a bar for a verdict, from top to bottom.

    The verdict stands beside each bar in words. A bar of what cannot be decided is empty, and bars
    end at twice the limit.

    Parameters
    ----------
    verdicts : Verdicts
    ax : Axes, optional

    Raises
    ------
    InputError
        No verdicts.
    """
    rows = instance("verdicts", verdicts, Verdicts).rows
    if not rows:
        raise InputError("verdicts", None, "must hold at least one", "Judge something first")
    ax = axes_or_new(ax, 0.8 + _ROW * len(rows))
    for i, row in enumerate(rows):
        used = row.utilisation or 0.0
        for name, colour in _COLOURS.items():
            length = min(used, _END) if name == row.verdict else math.nan
            bar = {"color": colour, "lw": 9.0, "solid_capstyle": "butt"}
            curve(ax, f"{name} {i}", [0.0, length], [i, i], **bar)
        height = 1.0 - (i + 0.5) / len(rows)
        note(
            ax, f"words {i}", _in_words(row), 1.02, height, va="center", color=_COLOURS[row.verdict]
        )
    limit = {"color": "k", "lw": 1.4, "ls": (0, (8, 3))}
    curve(ax, "limit", [1.0, 1.0], [-0.5, len(rows) - 0.5], label="limit", **limit)
    label_axes(ax, "utilisation, value / limit (-)", legend=False, fit=False)
    ax.set_yticks(range(len(rows)), [literal(row.clause.title) for row in rows])
    ax.set(xlim=(0.0, _END), ylim=(len(rows) - 0.5, -0.5))
    ax.tick_params(axis="y", length=0)
    return ax


def _in_words(row: Verdict) -> str:
    """Return verdict, value and limit in a few words."""
    if row.verdict == "cannot decide":
        return row.verdict
    unit, factor = SHOWN.get(row.clause.unit, (row.clause.unit, 1.0))
    if unit == "mm" and row.limit >= LONG:
        unit, factor = "m", 1.0
    value, limit = (f"{factor * number:.4g}" for number in (row.value, row.limit))
    return literal(f"{row.verdict}: {value}, {row.clause.sense} {limit} {unit}".rstrip())
