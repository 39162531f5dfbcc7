"""What the deck does while a train crosses, and how the iteration gets there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..decks import History
from ..errors import InputError
from ..results import Crossing
from ..trains import CONDENSED
from .drawing import (
    TIME_LABEL,
    axes_or_new,
    axes_or_new_grid,
    curve,
    label_axes,
    note,
    numbers_up_to,
    quantity_curve,
    reuses_artists,
)
from .forces import shade_car, shade_train
from .style import GREY, RUN_COLOURS, other_shade, style_of

__all__ = [
    "acceleration", "convergence", "deviations", "displacement", "iterations", "load_modes",
    "reactions", "section_force", "velocity",
]  # fmt: skip

# ---- one place over time


def displacement(
    run: Crossing,
    x: float,
    ax: Axes | None = None,
    self_weight: bool = False,
    component: str = "z",
    label: str | None = None,
    **line,
) -> Axes:
    """Plot the displacement of the deck axis at x (m) over time; component y, z or x (twist)."""
    quantity = f"{'rotation' if component == 'x' else 'displacement'}_{component}"
    return _plot_history(run, run.displacement(x, self_weight), quantity, ax, label, line)


def velocity(
    run: Crossing,
    x: float,
    ax: Axes | None = None,
    component: str = "z",
    label: str | None = None,
    **line,
) -> Axes:
    """Plot the velocity of the deck axis at x (m) over time; component y, z or roll."""
    return _plot_history(run, run.velocity(x), f"velocity_{component}", ax, label, line)


def acceleration(
    run: Crossing,
    x: float,
    ax: Axes | None = None,
    component: str = "z",
    label: str | None = None,
    **line,
) -> Axes:
    """Plot the acceleration of the deck axis at x (m) over time; component y, z or roll.

    The label gives the cut-off, the highest frequency of the modes kept: accelerations depend on
    it.
    """
    label = label or f"x = {x:g} m, modes up to {run.deck.frequencies_hz[-1]:.3g} Hz"
    return _plot_history(run, run.acceleration(x), f"acceleration_{component}", ax, label, line)


def section_force(
    run: Crossing,
    x: float,
    quantity: str = "moment_vertical",
    ax: Axes | None = None,
    self_weight: bool = False,
    label: str | None = None,
    **line,
) -> Axes:
    """Plot a section force at x (m) over time."""
    return _plot_history(run, run.section_forces(x, self_weight), quantity, ax, label, line)


def _plot_history(
    run: Crossing, history: History, quantity: str, ax: Axes | None, label: str | None, line: dict
) -> Axes:
    values, style = history[quantity], style_of(quantity)
    ax = axes_or_new(ax)
    shade_train(run, ax)
    if np.all(np.isnan(values)):
        note(ax, "rigid", "the deck has no stiffness given this way", 0.5, 0.5, ha="center")
    line = {"name": f"{quantity} {label or ''}", "label": label or history.where, **line}
    quantity_curve(ax, quantity, run.time, values, **line)
    return label_axes(ax, TIME_LABEL, style.label)


def reactions(
    run: Crossing, ax: Axes | None = None, quantity: str = "force_z", self_weight: bool = False
) -> Axes:
    """Plot the reactions of all bearing lines: ``force_z``, ``force_y`` or ``moment_x``."""
    errors.choice("quantity", quantity, ("force_y", "force_z", "moment_x"))
    histories = run.reactions(self_weight)
    ax, reaction = axes_or_new(ax), f"reaction_{quantity[-1]}"
    shade_train(run, ax)
    own = style_of(reaction).colour
    colours = cycle((own, other_shade(own), *RUN_COLOURS))
    for (support, history), colour in zip(histories.items(), colours, strict=False):
        line = {"color": colour, "name": f"bearing at {support:g} m"}
        line["label"] = line["name"]
        quantity_curve(ax, reaction, run.time, history[quantity], **line)
    return label_axes(ax, TIME_LABEL, style_of(reaction).label)


# ---- the iteration


def _by_name(run_or_dict: Crossing | Mapping[str, Crossing]) -> list[tuple]:
    """Return name (None of a single run), run and colour."""
    if not isinstance(run_or_dict, Mapping):
        return [(None, run_or_dict, style_of("force_z").colour)]
    colours = zip(run_or_dict.items(), RUN_COLOURS * 9, strict=False)
    return [(name, run, colour) for (name, run), colour in colours]


def _label_iterations(ax: Axes, y: str, last: int) -> Axes:
    """Label an axes with iterations along x, and end it behind the last one."""
    label_axes(ax, "iteration", y)
    ax.set_xlim(0.6, last + 0.4)
    ax.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    return ax


def convergence(run_or_dict: Crossing | Mapping[str, Crossing], ax: Axes | None = None) -> Axes:
    """Plot the change of each iteration on a logarithmic scale, with the tolerance.

    One run, or several by name.
    """
    runs = _by_name(run_or_dict)
    last = max((len(run.changes) for _, run, _ in runs), default=0)
    if not last:
        allowed = (
            "has no iterations: train and deck were solved together, or the deck was loaded by "
        )
        allowed += "rigid-deck forces"
        raise InputError("run", None, allowed, "Use interaction='iterate'")
    ax = axes_or_new(ax)
    if not reuses_artists(ax):
        ax.set_yscale("log")
    for name, run, colour in runs:
        changes = np.where(np.array(run.changes) > 0, run.changes, np.nan)
        numbers = np.arange(1, len(changes) + 1)
        line = {"label": name, "color": colour, "marker": "o", "ms": 4}
        curve(ax, f"changes {name}", numbers, changes, **line)
    settings = runs[0][1].settings
    if settings.iterations is None:
        line = {"label": f"tolerance {settings.tolerance:g}", "color": "k", "ls": ":", "lw": 1.0}
        curve(ax, "tolerance", [0.6, last + 0.4], [settings.tolerance] * 2, **line)
    kinds = {run.settings.tolerance_of for _, run, _ in runs}
    of = {"forces": " of the wheel forces", "displacement": " of the deck's motion"}
    what = of[kinds.pop()] if len(kinds) == 1 else ""
    return _label_iterations(ax, f"change{what} (-)", last)


def deviations(
    run_or_dict: Crossing | Mapping[str, Crossing], ax: Axes | None = None, instead: str = ""
) -> Axes:
    """Plot Eq. 3 for each iteration, from the rigid deck and from the one before (Table 3).

    `instead` is written in place of the curves, where they would say nothing.
    """
    ax, runs = axes_or_new(ax), _by_name(run_or_dict)
    if not reuses_artists(ax):
        curve(ax, "zero", [0.5, 200.0], [0.0, 0.0], color=GREY, lw=0.8, scalex=False)
    ground = {"fc": "white", "ec": "none", "pad": 1.0, "alpha": 0.85}
    note(ax, "instead", instead, 0.5, 0.5, ha="center", va="center", bbox=ground)
    shown = np.nan if instead else 1.0
    for name, run, colour in runs:
        numbers, before = np.arange(1, run.iterations + 1), "" if name is None else f"{name}, "
        line = {"label": f"{before}from rigid", "color": colour, "marker": "o", "ms": 5}
        curve(ax, f"rigid {name}", numbers, shown * run.deviations.from_rigid, **line)
        line = {"label": f"{before}from previous", "color": colour, "marker": "s", "ms": 4}
        line |= {"ls": "--", "mfc": "white"}
        curve(ax, f"previous {name}", numbers, shown * run.deviations.from_previous, **line)
    last = max((run.iterations for _, run, _ in runs), default=1)
    return _label_iterations(ax, "deviation, Eq. 3 (%)", max(last, 1))


def iterations(
    run: Crossing | Mapping[int, Crossing],
    quantity: str = "force_z",
    which: Sequence[int] = (0, 1, 4),
    ax: Sequence[Axes] | None = None,
    x: float | None = None,
    car: int = 1,
) -> np.ndarray:
    """Plot one curve at several iterations, and below it the difference from the last of them.

    Parameters
    ----------
    run : Crossing, or mapping of int to Crossing
        The mapping holds what ``run.at`` gives, so that a panel need not compute it again.
    quantity : str
        ``force_z`` (and the other condensed components of a car), a displacement or a section
        force.
    which : sequence of int
        Iterations; those the run does not have are left out.
    ax : two Axes, optional
        For the curves and for the differences.
    x : float, optional
        m; default mid-length of the deck.
    car : int
        For forces, from 1.

    Returns
    -------
    ndarray of Axes, shape (2,)
    """
    known = run if isinstance(run, Mapping) else {}
    run = known[max(known)] if known else run
    numbers = numbers_up_to("which", which, 0, run.iterations)
    style, x = style_of(quantity), run.deck.length / 2 if x is None else x
    stages = [known[i] if known else run.at(i) for i in numbers]
    curves = [_values(stage, quantity, x, car) for stage in stages]
    upper, lower = axes_or_new_grid(ax, 2, 1, 4.6, sharex=True, height_ratios=[1.6, 1.0])
    for axes in (upper, lower):
        if quantity in CONDENSED:
            shade_car(run, car, axes, label=axes is upper)
        else:
            shade_train(run, axes, label=False)
    for rank, (number, values) in enumerate(zip(numbers, curves, strict=True)):
        last = rank == len(numbers) - 1
        line = {"color": ("k", GREY, RUN_COLOURS[2])[rank % 3], "ls": "--", "zorder": 2.5}
        if last:
            line = {"color": style.colour, "ls": "-", "zorder": 2.0}
        label = "rigid deck (0)" if number == 0 else f"iteration {number}"
        line["name"] = f"rank {rank}"
        quantity_curve(upper, quantity, run.time, values, label=label, **line)
        if not last or len(numbers) == 1:
            line["zorder"] = 2.0
            quantity_curve(lower, quantity, run.time, values - curves[-1], **line)
    label_axes(upper, "", style.label)
    upper.tick_params(labelbottom=False)
    label_axes(lower, TIME_LABEL, f"minus iteration {numbers[-1]} ({style.unit})")
    return np.array([upper, lower], dtype=object)


def _values(run: Crossing, quantity: str, x: float, car: int) -> np.ndarray:
    """Return a quantity over time: of a car, or of the deck at x."""
    if quantity in CONDENSED:
        return run.car_forces(car)[quantity]
    if quantity.startswith("displacement"):
        return run.displacement(x)[quantity]
    if quantity.startswith("rotation"):
        return run.rotations(x)[quantity]
    if quantity.startswith("acceleration"):
        return run.acceleration(x)[quantity]
    return run.section_forces(x)[quantity]


def load_modes(
    runs: Mapping[str, Crossing], x: float, quantity: str = "displacement_z", ax: Axes | None = None
) -> Axes:
    """Plot one quantity at x (m) for runs that differ in how the train loads the deck.

    Parameters
    ----------
    runs : mapping of Crossing
        By name; ``wheels`` is drawn in the quantity's own colour, ``bogies`` and ``condensed`` in
        black and grey.
    x : float
        m.
    quantity : str
        A displacement, ``acceleration_z`` or a section force.
    ax : Axes, optional
    """
    ax, style = axes_or_new(ax), style_of(quantity)
    own = {
        "condensed": (GREY, "-", 3.0),
        "bogies": ("k", "--", 1.3),
        "wheels": (style.colour, "-", 1.6),
    }
    shade_train(next(iter(runs.values())), ax)
    for name, run, colour in _by_name(runs):
        colour, dashes, width = own.get(name, (colour, "-", 1.5))
        line = {"name": name, "label": name, "color": colour, "ls": dashes, "lw": width}
        quantity_curve(ax, quantity, run.time, _values(run, quantity, x, 1), **line)
    return label_axes(ax, TIME_LABEL, style.label, f"x = {x:g} m")
