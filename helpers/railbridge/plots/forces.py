"""Forces between train and deck, and their spectra."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from ..errors import InputError
from ..results import Crossing
from ..spectra import Spectrum, deviation_percent
from ..trains import CONDENSED
from .drawing import GREY, TIME, curve, finish, grid, look, mark, one, shade
from .style import second


def wheel_force(run: Crossing, car: int = 1, wheel: int = 1, ax: Axes | None = None) -> Axes:
    """Plot the vertical force of one wheel on the deck over time, static part included; both counted from 1."""
    ax = one(ax)
    history = run.wheel_force(car, wheel)
    static = next(-w.static_load for w in run.train.wheels if (w.car, w.number) == (car, wheel))
    style = look("force_z")
    shade_car(run, car, ax)
    curve(ax, "zero", run.time[[0, -1]], [0.0, 0.0], color="k", lw=0.8)
    curve(ax, "static", run.time[[0, -1]], np.full(2, style.factor * static), label="at rest", color=GREY, ls=":")
    values = style.factor * history["force_z"]
    curve(ax, "force_z", run.time, values, label=f"car {car}, wheel {wheel}", color=style.colour, ls=style.line)
    return finish(ax, TIME, "wheel force on the deck (kN)")


def wheel_forces(run: Crossing, car: int = 1, axes: Sequence[Axes] | None = None) -> np.ndarray:
    """Plot vertical and lateral forces of all wheels of one car over time: one axes for each axle, left and right rail.

    Returns
    -------
    ndarray of Axes
        One for each axle, front first.
    """
    axles = run.train.car(car).axles
    axes = grid(axes, len(axles), 1, 0.6 + 1.5 * len(axles), sharex=True, sharey=True)
    for number, (ax, axle) in enumerate(zip(axes, axles, strict=True), start=1):
        shade_car(run, car, ax, label=number == 1)
        for wheel in axle.wheels:
            history, left = run.wheel_force(car, wheel.number), wheel.side == "left"
            for name in ("force_y", "force_z"):
                style = look(name)
                label = f"{style.words}, {wheel.side}" if number == 1 else None
                colour = style.colour if left else second(style.colour)
                line = {"color": colour, "ls": style.line, "lw": 2.4 if left else 1.0}
                values = style.factor * history[name]
                curve(ax, f"{name} {wheel.side}", run.time, values, label=label, **line)
        finish(ax, TIME if ax is axes[-1] else "", "force (kN)", f"axle {number}")
    return axes


def car_forces(
    run: Crossing,
    car: int = 1,
    at: str = "track",
    axes: Sequence[Axes] | None = None,
    static: bool = False,
    steady: Mapping[str, float] | None = None,
    components: Sequence[str] = CONDENSED,
) -> np.ndarray:
    """Plot one car's wheel forces condensed to five components, one below the other (Figure 9).

    Parameters
    ----------
    run : Crossing
    car : int
        From 1.
    at : {"track", "centre"}
        See `Crossing.car_forces`.
    axes : sequence of Axes, optional
        As many as components.
    static : bool
        Whether the weight is counted.
    steady : mapping of float, optional
        Steady amplitudes to draw as dotted lines, N and N m, by component.
    components : sequence of str

    Returns
    -------
    ndarray of Axes
    """
    axes = grid(axes, len(components), 1, 0.6 + 1.25 * len(components), sharex=True)
    history = run.car_forces(car, at, static)
    for ax, name in zip(axes, components, strict=True):
        style = look(name)
        shade_car(run, car, ax, label=ax is axes[0])
        values = style.factor * history[name]
        curve(ax, name, run.time, values, color=style.colour, ls=style.line)
        if steady and name in steady:
            weight = run.train.car(car).static_forces[:, 1].sum()
            middle = style.factor * float(weight) if static and name == "force_z" else 0.0
            level = style.factor * steady[name]
            ends = [run.time[0], run.time[-1], np.nan, run.time[0], run.time[-1]]
            lines = [middle + level] * 2 + [np.nan] + [middle - level] * 2
            curve(ax, "steady", ends, lines, label="steady amplitude", color="k", ls=":", lw=1.2)
        finish(ax, TIME if ax is axes[-1] else "", style.label, legend=ax is axes[0])
    axes[0].figure.align_ylabels(axes)
    return axes


def shade_car(run: Crossing, car: int, ax: Axes, label: bool = True) -> None:
    """Shade the time while a car has a wheel on the deck."""
    delays = [w.delay for w in run.train.wheels if w.car == car]
    if not delays:
        raise InputError("car", car, "no such car in this train", "Cars are counted from 1")
    v = run.settings.speed
    shade(ax, "on deck", min(delays) / v, (max(delays) + run.deck.length) / v, f"car {car} on the deck" if label else None)


def shade_train(run: Crossing, ax: Axes) -> None:
    """Shade the time while any axle is on the deck."""
    stop = (run.train.length + run.deck.length) / run.settings.speed
    shade(ax, "on deck", 0.0, stop, "train on the deck")


def spectrum(
    run_or_spectrum: Crossing | Spectrum,
    ax: Axes | None = None,
    label: str | None = None,
    mark: Mapping[str, float] | None = None,
    **line,
) -> Axes:
    """Plot an amplitude spectrum, one stem a line; `mark` names frequencies (Hz) for vertical lines."""
    ax = one(ax)
    s = run_or_spectrum.spectrum if isinstance(run_or_spectrum, Crossing) else run_or_spectrum
    style = look("force_z")
    factor, unit = (style.factor, style.unit) if s.unit == "N" else (1.0, s.unit)
    name, options = f"spectrum {label or ''}", {"color": style.colour, **line}
    x, y = np.repeat(s.frequency, 3), np.zeros(3 * len(s.frequency))
    y[1::3], y[2::3] = factor * s.amplitude, np.nan
    curve(ax, name, x, y, **options)
    curve(ax, f"{name} heads", s.frequency, factor * s.amplitude, label=label, marker="o", ms=3.0, **{**options, "ls": ""})
    _mark(ax, mark)
    finish(ax, "frequency (Hz)", f"amplitude ({unit})")
    ax.set_ylim(bottom=0.0)
    ax.set_xlim(left=0.0)
    return ax


_mark = mark


def spectra(run: Crossing, iterations: Iterable[int] = range(5), axes: Sequence[Axes] | None = None) -> np.ndarray:
    """Plot the spectra of the first car's vertical force for several iterations (Figures 12 to 16).

    Each title gives Eq. 3 against the rigid deck, whose lines stand behind in grey.

    Returns
    -------
    ndarray of Axes
        One for each iteration.
    """
    which = [i for i in iterations if i <= run.iterations]
    if not which:
        raise InputError("iterations", list(iterations), f"must name some of 0 to {run.iterations}")
    columns = min(3, len(which))
    rows = -(-len(which) // columns)
    axes = grid(axes, rows, columns, 0.4 + 2.3 * rows, sharex=True, sharey=True)
    rigid = run.at(0).spectrum
    for ax, i in zip(axes, which, strict=False):
        here = run.at(i).spectrum
        if i:
            curve(ax, "rigid", rigid.frequency, look("force_z").factor * rigid.amplitude, color=GREY, ls="", marker="_", ms=7)
        spectrum(here, ax)
        title = "i = 0, rigid deck" if i == 0 else f"i = {i}, Eq. 3: {deviation_percent(here, rigid):+.3f} %"
        ax.set_title(title, loc="left", fontsize="medium")
        ax.label_outer()
    for ax in axes[len(which) :]:
        ax.set_axis_off()
    for ax in axes[max(0, len(which) - columns) : len(which)]:
        ax.tick_params(labelbottom=True)
        ax.set_xlabel("frequency (Hz)")
    return axes[: len(which)]
