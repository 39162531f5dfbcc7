"""Forces between train and deck, and their spectra."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..percar import held_sideways
from ..results import Crossing
from ..spectra import Spectrum, deviation_percent
from ..trains import CONDENSED
from .drawing import (
    TIME_LABEL,
    axes_or_new,
    axes_or_new_grid,
    curve,
    label_axes,
    numbers_up_to,
    quantity_curve,
    shade,
    small_multiples,
    vertical_lines,
)
from .style import GREY, other_shade, style_of

__all__ = [
    "car_components", "car_forces", "mark_instant", "shade_car", "shade_train", "spectra",
    "spectrum", "wheel_force", "wheel_forces",
]  # fmt: skip


def wheel_force(run: Crossing, car: int = 1, wheel: int = 1, ax: Axes | None = None) -> Axes:
    """Plot the vertical force of one wheel on the deck over time, static part included.

    Car and wheel are counted from 1.
    """
    ax = axes_or_new(ax)
    history = run.wheel_force(car, wheel)
    static = -run.train.car(car).wheels[wheel - 1].static_load
    ends = run.time[[0, -1]]
    shade_car(run, car, ax)
    curve(ax, "zero", ends, [0.0, 0.0], color="k", lw=0.8)
    line = {"name": "static", "label": "at rest", "color": GREY, "ls": ":"}
    quantity_curve(ax, "force_z", ends, [static, static], **line)
    label = f"car {car}, wheel {wheel}"
    quantity_curve(ax, "force_z", run.time, history["force_z"], label=label)
    return label_axes(ax, TIME_LABEL, "wheel force on the deck (kN)")


def wheel_forces(
    run: Crossing,
    car: int = 1,
    axes: Sequence[Axes] | None = None,
    components: Sequence[str] = ("force_y", "force_z"),
) -> np.ndarray:
    """Plot vertical and lateral forces of all wheels of one car over time, left and right rail.

    No lateral force of wheels that are not held sideways.

    Parameters
    ----------
    run : Crossing
    car : int
        From 1.
    axes : sequence of Axes, optional
        As many as axles.
    components : sequence of {"force_y", "force_z"}

    Returns
    -------
    ndarray of Axes
        One for each axle, front first.
    """
    for name in components:
        errors.choice("components", name, ("force_y", "force_z"))
    what = style_of(components[0]).label if len(components) == 1 else "force (kN)"
    own = run.train.car(car)
    axles, held = own.axles, held_sideways(own)
    height = 0.6 + 1.5 * len(axles)
    axes = axes_or_new_grid(axes, len(axles), 1, height, sharex=True, sharey=True)
    for number, (ax, axle) in enumerate(zip(axes, axles, strict=True), start=1):
        shade_car(run, car, ax, label=number == 1)
        for wheel in axle.wheels:
            history = run.wheel_force(car, wheel.number)
            for name in components:
                if name == "force_y" and not held[wheel.number - 1]:
                    continue
                style = style_of(name)
                label = f"{style.words}, {wheel.side}" if number == 1 else None
                line = {"name": f"{name} {wheel.side}", "label": label, "lw": 2.4}
                if wheel.side == "right":
                    line |= {"color": other_shade(style.colour), "lw": 1.0}
                quantity_curve(ax, name, run.time, history[name], **line)
        label_axes(ax, TIME_LABEL if ax is axes[-1] else "", what, f"axle {number}")
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
    height = 0.6 + 1.25 * len(components)
    axes = axes_or_new_grid(axes, len(components), 1, height, sharex=True)
    history = run.car_forces(car, at, static)
    weight = float(run.train.car(car).static_forces[:, 1].sum())
    first, last = run.time[[0, -1]]
    for ax, name in zip(axes, components, strict=True):
        shade_car(run, car, ax, label=ax is axes[0])
        quantity_curve(ax, name, run.time, history[name])
        if steady and name in steady:
            middle, amplitude = weight if static and name == "force_z" else 0.0, steady[name]
            x = [first, last, np.nan, first, last]
            y = [middle + amplitude] * 2 + [np.nan] + [middle - amplitude] * 2
            line = {"name": "steady", "label": "steady amplitude"}
            quantity_curve(ax, name, x, y, **line, color="k", ls=":", lw=1.2)
        x_label = TIME_LABEL if ax is axes[-1] else ""
        label_axes(ax, x_label, style_of(name).label, legend=ax is axes[0])
    axes[0].figure.align_ylabels(axes)
    return axes


def car_components(
    run: Crossing, axes: Sequence[Axes] | None = None, car: int = 1, now: float | None = None
) -> np.ndarray:
    """Plot one car's five condensed force components, without its weight.

    Forces in one axes, moments in the other.

    Parameters
    ----------
    run : Crossing
    axes : two Axes, optional
    car : int
        From 1.
    now : float, optional
        Instant to mark, s.

    Returns
    -------
    ndarray of Axes, shape (2,)
    """
    axes = axes_or_new_grid(axes, 1, 2, 2.8)
    history = run.car_forces(car, static=False)
    for ax, kind, unit in ((axes[0], "force", "kN"), (axes[1], "moment", "kN m")):
        shade_car(run, car, ax, label=False)
        for name in (c for c in CONDENSED if c.startswith(kind)):
            label = style_of(name).words.removesuffix(f" {kind}")
            quantity_curve(ax, name, run.time, history[name], label=label)
        mark_instant(ax, now)
        label_axes(ax, TIME_LABEL, f"car {car}, {kind} ({unit})")
    return axes


# ---- marks along the time axis


def shade_car(run: Crossing, car: int, ax: Axes, label: bool = True) -> None:
    """Shade the time while a car has a wheel on the deck."""
    axles, speed = run.train.car(car).axles, run.settings.speed
    start, stop = axles[0].delay / speed, (axles[-1].delay + run.deck.length) / speed
    shade(ax, "on deck", start, stop, f"car {car} on the deck" if label else None)


def shade_train(run: Crossing, ax: Axes, label: bool = True) -> None:
    """Shade the time while any axle is on the deck."""
    stop = (run.train.length + run.deck.length) / run.settings.speed
    shade(ax, "on deck", 0.0, stop, "train on the deck" if label else None)


def mark_instant(ax: Axes, now: float | None) -> None:
    """Mark an instant (s) by a thin vertical line."""
    if now is not None:
        options = {"color": "k", "lw": 0.9, "ls": ":", "transform": ax.get_xaxis_transform()}
        curve(ax, "now", [now, now], [0.0, 1.0], **options)


# ---- spectra


def spectrum(
    run_or_spectrum: Crossing | Spectrum,
    ax: Axes | None = None,
    label: str | None = None,
    mark: Mapping[str, float] | None = None,
    most: float | None = None,
    **line,
) -> Axes:
    """Plot an amplitude spectrum, one stem a line.

    `mark` names frequencies (Hz) for vertical lines; `most` ends the axis (Hz).
    """
    ax = axes_or_new(ax)
    is_run = isinstance(run_or_spectrum, Crossing)
    s = run_or_spectrum.spectrum if is_run else run_or_spectrum
    style = style_of("force_z")
    factor, unit = (style.factor, style.unit) if s.unit == "N" else (1.0, s.unit)
    name, line = f"spectrum {label or ''}", {"color": style.colour, **line}
    x, y = np.repeat(s.frequency, 3), np.zeros(3 * len(s.frequency))
    y[1::3], y[2::3] = factor * s.amplitude, np.nan
    curve(ax, name, x, y, **line)
    heads = {**line, "label": label, "marker": "o", "ms": 3.0, "ls": ""}
    curve(ax, f"{name} heads", s.frequency, factor * s.amplitude, **heads)
    vertical_lines(ax, mark)
    label_axes(ax, "frequency (Hz)", f"amplitude ({unit})")
    ax.set_ylim(bottom=0.0)
    ax.set_xlim(0.0, most)
    return ax


def spectra(
    run: Crossing, iterations: Iterable[int] = range(5), axes: Sequence[Axes] | None = None
) -> np.ndarray:
    """Plot the spectra of the first car's vertical force for several iterations (Figures 12 to 16).

    Each title gives Eq. 3 against the rigid deck, whose lines stand behind in grey.

    Returns
    -------
    ndarray of Axes
        One for each iteration.
    """
    iterations = numbers_up_to("iterations", iterations, 0, run.iterations)
    axes = small_multiples(axes, len(iterations), 3, 0.4, 2.3, sharex=True, sharey=True)
    rigid = run.at(0).spectrum
    for place, (ax, i) in enumerate(zip(axes, iterations, strict=True)):
        iterated, title = run.at(i).spectrum, "i = 0, rigid deck"
        if i:
            line = {"name": "rigid", "color": GREY, "ls": "", "marker": "_", "ms": 7}
            quantity_curve(ax, "force_z", rigid.frequency, rigid.amplitude, **line)
            deviation = deviation_percent(iterated, rigid)
            # On level track the rigid deck's force is constant, and Eq. 3 divides by nothing.
            title = f"i = {i}" + f", Eq. 3: {deviation:+.3f} %" * bool(np.isfinite(deviation))
        spectrum(iterated, ax)
        ax.set_title(title, loc="left", fontsize="medium")
        ax.label_outer()
        if place >= len(iterations) - 3:  # the lowest of its column
            ax.tick_params(labelbottom=True)
            ax.set_xlabel("frequency (Hz)")
    # The first axes has set the limits of all to its own lines.
    highest = max(
        style_of("force_z").factor * run.at(i).spectrum.amplitude.max() for i in iterations
    )
    if highest > axes[0].get_ylim()[1]:
        axes[0].set_ylim(top=1.05 * highest)
    return axes
