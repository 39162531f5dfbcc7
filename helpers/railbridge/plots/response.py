"""What the deck does while a train crosses, and how the iteration gets there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..errors import InputError
from ..results import Crossing
from ..trains import CONDENSED
from .drawing import COMPARED, GREY, TIME, curve, finish, grid, is_live, look, note, one, shade
from .forces import shade_car, shade_train
from .style import second


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
    history = run.displacement(x, self_weight)
    return _history(run, history, f"{'rotation' if component == 'x' else 'displacement'}_{component}", ax, label, line)


def velocity(run: Crossing, x: float, ax: Axes | None = None, component: str = "z", label: str | None = None, **line) -> Axes:
    """Plot the velocity of the deck axis at x (m) over time; component y, z or roll."""
    return _history(run, run.velocity(x), f"velocity_{component}", ax, label, line)


def acceleration(run: Crossing, x: float, ax: Axes | None = None, component: str = "z", label: str | None = None, **line) -> Axes:
    """Plot the acceleration of the deck axis at x (m) over time; component y, z or roll.

    The label gives the cut-off, the highest frequency of the modes kept: accelerations depend on it.
    """
    cutoff = f"x = {x:g} m, modes up to {run.deck.frequencies_hz[-1]:.3g} Hz"
    return _history(run, run.acceleration(x), f"acceleration_{component}", ax, label or cutoff, line)


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
    return _history(run, run.section_forces(x, self_weight), quantity, ax, label, line)


def _history(run: Crossing, history, name: str, ax: Axes | None, label: str | None, line: dict) -> Axes:
    values = history[name]
    ax, style = one(ax), look(name)
    shade_train(run, ax)
    if np.all(np.isnan(values)):
        note(ax, "rigid", "the deck has no stiffness given this way", 0.5, 0.5, ha="center")
    options = {"color": style.colour, "ls": style.line, **line}
    curve(ax, f"{name} {label or ''}", run.time, style.factor * values, label=label or history.where, **options)
    return finish(ax, TIME, style.label)


def reactions(run: Crossing, ax: Axes | None = None, quantity: str = "force_z", self_weight: bool = False) -> Axes:
    """Plot the reactions of all bearing lines over time: ``force_z``, ``force_y`` or ``moment_x``."""
    ax = one(ax)
    errors.choice("quantity", quantity, ("force_y", "force_z", "moment_x"))
    style = look(f"reaction_{quantity[-1]}")
    shade_train(run, ax)
    for (support, history), colour in zip(
        run.reactions(self_weight).items(), (style.colour, second(style.colour), *COMPARED), strict=False
    ):
        label = f"bearing at {support:g} m"
        curve(ax, label, run.time, style.factor * history[quantity], label=label, color=colour, ls=style.line)
    return finish(ax, TIME, style.label)


def _runs(run_or_dict: Crossing | Mapping[str, Crossing]) -> dict[str | None, Crossing]:
    return dict(run_or_dict) if isinstance(run_or_dict, Mapping) else {None: run_or_dict}


def convergence(run_or_dict: Crossing | Mapping[str, Crossing], ax: Axes | None = None) -> Axes:
    """Plot the change of each iteration on a logarithmic scale, with the tolerance; one run, or several by name."""
    ax = one(ax)
    runs = _runs(run_or_dict)
    if not is_live(ax):
        ax.set_yscale("log")
    longest = max((len(r.changes) for r in runs.values()), default=0)
    if not longest:
        raise InputError("run", None, "has no iterations: the deck was loaded by rigid-deck forces", "Use interaction='iterate'")
    for (label, run), colour in zip(runs.items(), COMPARED * 9, strict=False):
        colour = look("force_z").colour if label is None else colour
        changes = np.where(np.array(run.changes) > 0, run.changes, np.nan)
        curve(ax, f"changes {label}", np.arange(1, len(changes) + 1), changes, label=label, color=colour, marker="o", ms=4)
    settings = next(iter(runs.values())).settings
    if settings.iterations is None:
        label = f"tolerance {settings.tolerance:g}"
        curve(ax, "tolerance", [0.6, longest + 0.4], [settings.tolerance] * 2, label=label, color="k", ls=":", lw=1.0)
    finish(ax, "iteration", "change of the wheel forces (-)")
    ax.set_xlim(0.6, longest + 0.4)
    ax.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    return ax


def deviations(run_or_dict: Crossing | Mapping[str, Crossing], ax: Axes | None = None) -> Axes:
    """Plot Eq. 3 for each iteration, against the rigid deck and against the iteration before (Table 3)."""
    ax = one(ax)
    runs = _runs(run_or_dict)
    longest = 1
    curve(ax, "zero", [0.5, 200.0], [0.0, 0.0], color=GREY, lw=0.8, scalex=False) if not is_live(ax) else None
    for (label, run), colour in zip(runs.items(), COMPARED * 9, strict=False):
        d, colour = run.deviations, look("force_z").colour if label is None else colour
        number = np.arange(1, run.iterations + 1)
        longest = max(longest, run.iterations)
        before = "" if label is None else f"{label}, "
        curve(ax, f"rigid {label}", number, d.from_rigid, label=f"{before}from rigid", color=colour, marker="o", ms=5)
        curve(ax, f"previous {label}", number, d.from_previous, label=f"{before}from previous", color=colour, ls="--",
              marker="s", ms=4, mfc="white")  # fmt: skip
    finish(ax, "iteration", "deviation, Eq. 3 (%)")
    ax.set_xlim(0.6, longest + 0.4)
    ax.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    return ax


def iterations(
    run: Crossing | Mapping[int, Crossing],
    quantity: str = "force_z",
    which: Sequence[int] = (0, 1, 4),
    ax: Sequence[Axes] | None = None,
    x: float | None = None,
    car: int = 1,
) -> np.ndarray:
    """Plot one curve as it stood at several iterations, and below it the difference from the last of them.

    Parameters
    ----------
    run : Crossing, or mapping of int to Crossing
        The mapping holds what ``run.at`` gives, so that a panel need not compute it again.
    quantity : str
        ``force_z`` (and the other condensed components of a car), a displacement or a section force.
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
    upper, lower = grid(ax, 2, 1, 4.6, sharex=True, height_ratios=[1.6, 1.0])
    stages = run if isinstance(run, Mapping) else None
    run = stages[max(stages)] if stages else run
    style, x = look(quantity), run.deck.length / 2 if x is None else x
    kept = [i for i in which if 0 <= i <= run.iterations]
    if not kept:
        raise InputError("which", list(which), f"must name some of 0 to {run.iterations}")
    values = {i: style.factor * _at(stages[i] if stages else run.at(i), quantity, x, car) for i in kept}
    for a in (upper, lower):
        if quantity in CONDENSED:
            shade_car(run, car, a, label=a is upper)
        else:
            shade(a, "on deck", 0.0, (run.train.length + run.deck.length) / run.settings.speed, None)
    for rank, i in enumerate(kept):
        last = rank == len(kept) - 1
        options = {"color": style.colour, "ls": "-"} if last else {"color": ("k", GREY, COMPARED[2])[rank % 3], "ls": "--"}
        zorder = 2.0 if last else 2.5
        label = "rigid deck (0)" if i == 0 else f"iteration {i}"
        curve(upper, f"rank {rank}", run.time, values[i], label=label, zorder=zorder, **options)
        if not last or len(kept) == 1:
            curve(lower, f"rank {rank}", run.time, values[i] - values[kept[-1]], **options)
    finish(upper, "", style.label)
    upper.tick_params(labelbottom=False)
    finish(lower, TIME, f"minus iteration {kept[-1]} ({style.unit})")
    return np.array([upper, lower], dtype=object)


def _at(run: Crossing, quantity: str, x: float, car: int) -> np.ndarray:
    if quantity in CONDENSED:
        return run.car_forces(car)[quantity]
    if quantity.startswith(("displacement", "rotation")):
        return run.displacement(x)[quantity]
    return run.section_forces(x)[quantity]


def load_modes(runs: Mapping[str, Crossing], x: float, quantity: str = "displacement_z", ax: Axes | None = None) -> Axes:
    """Plot one quantity at x (m) for runs that differ in how the train loads the deck.

    Parameters
    ----------
    runs : mapping of Crossing
        By name; ``wheels`` is drawn in the quantity's own colour, ``bogies`` and ``condensed`` in black and grey.
    x : float
        m.
    quantity : str
        A displacement, ``acceleration_z`` or a section force.
    ax : Axes, optional
    """
    ax, style = one(ax), look(quantity)
    looks = {"condensed": (GREY, "-", 3.0), "bogies": ("k", "--", 1.3), "wheels": (style.colour, "-", 1.6)}
    shade_train(next(iter(runs.values())), ax)
    for (name, run), colour in zip(runs.items(), COMPARED * 9, strict=False):
        colour, dashes, width = looks.get(name, (colour, "-", 1.5))
        source = run.acceleration(x)[quantity] if quantity.startswith("acceleration") else _at(run, quantity, x, 1)
        curve(ax, name, run.time, style.factor * source, label=name, color=colour, ls=dashes, lw=width)
    return finish(ax, TIME, style.label, f"x = {x:g} m")
