"""One function per figure: a result and optional axes in, the axes out. Nothing physical is computed here.

Without axes a function makes a figure of notebook width. It never shows it and changes no settings, so figures can be
composed: give the axes of ``plt.subplots``. Looks and units are those of `drawing.LOOKS`: kN, kN m and mm.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from . import inputs
from .crossing import Crossing
from .deck import Deck, rayleigh_ratio
from .drawing import COMPARED, GREY, curve, finish, grid, is_live, log_frequencies, look, mark, note, one, shade
from .inputs import InputError
from .sketches import train_on_deck, vehicle, vehicle_mode
from .spectra import Spectrum, deviation_percent
from .track import FadeIn, Notch, Track
from .train import CONDENSED, AxleTrain, Train
from .vehicle import Vehicle

__all__ = [
    "acceleration", "car_forces", "convergence", "damping", "deck_mode", "deck_modes", "deviations", "displacement",
    "frequencies", "influence_line", "irregularity", "iterations", "load_modes", "notch", "reactions", "section_force", "slope",
    "spectra", "spectrum", "train_on_deck", "vehicle", "vehicle_mode", "velocity", "wheel_force", "wheel_forces", "wheel_paths",
    "wheels_on_track",
]  # fmt: skip

TIME = "time since the first axle entered (s)"
ALONG = "x from the bridge entrance (m)"


# ---- track


def irregularity(
    track: Track,
    start: float = -40.0,
    stop: float = 60.0,
    lead_in: float | None = None,
    ax: Axes | None = None,
    deck: Deck | float | None = None,
    _quantity: str = "irregularity",
) -> Axes:
    """Plot vertical and lateral irregularity along the track, left and right rail apart where they differ.

    Parameters
    ----------
    track : Track
    start, stop : float
        m from the bridge entrance.
    lead_in : float, optional
        Run-up, m: the irregularity fades in from ``-lead_in`` on.
    ax : Axes, optional
    deck : Deck or float, optional
        Deck, or its length (m), to shade.

    Returns
    -------
    Axes
    """
    ax = one(ax)
    x = np.linspace(start, stop, 1201)
    if deck is not None:
        shade(ax, "deck", 0.0, getattr(deck, "length", deck), "deck")
    for direction in ("vertical", "lateral"):
        values = {}
        for side in ("left", "right"):
            rail = track.rail(direction, side)
            rail = rail if lead_in is None else FadeIn(rail, inputs.number("lead_in", lead_in, least=0.0, unit="m"))
            values[side] = rail.value(x) if _quantity == "irregularity" else rail.slope(x)
        style = look(f"{_quantity}_{direction}")
        same = np.array_equal(values["left"], values["right"])
        for side, value in values.items():
            if side == "right" and same:
                continue
            label = direction if same else f"{direction}, {side} rail"
            colour = style.colour if side == "left" else COMPARED[0]
            curve(ax, label, x, style.factor * value, label=label, color=colour, ls=style.line)
    word = "irregularity r" if _quantity == "irregularity" else "slope dr/dx"
    return finish(ax, ALONG, f"{word} ({look(f'{_quantity}_vertical').unit})")


def slope(
    track: Track,
    start: float = -40.0,
    stop: float = 60.0,
    lead_in: float | None = None,
    ax: Axes | None = None,
    deck: Deck | float | None = None,
) -> Axes:
    """Plot the slope of the irregularity along the track, in mm/m; parameters as `irregularity`."""
    return irregularity(track, start, stop, lead_in, ax, deck, _quantity="slope")


def notch(notch: Notch, start: float, stop: float, ax: Axes | None = None) -> Axes:
    """Plot what a wheel's notch does over the wheel's own place, `start` to `stop` in m (Eq. 2 with its sign turned)."""
    ax = one(ax, 2.4)
    count = int(np.clip(40 * (stop - start) / notch.length, 2001, 400_001))
    x = np.linspace(start, stop, count)
    style = look("irregularity_vertical")
    curve(ax, "notch", x, style.factor * notch.value(x), color=style.colour, ls=style.line)
    return finish(ax, "place of the wheel from the bridge entrance (m)", "r (mm)")


def wheels_on_track(train: Train | AxleTrain, track: Track, position: float = 18.0, ax: Axes | None = None) -> Axes:
    """Mark where the left wheels stand on the vertical irregularity when the first axle is at `position` (m)."""
    ax = one(ax)
    low, high = sorted(ax.get_xlim()) if ax.lines else (-np.inf, np.inf)
    style = look("force_z")
    wheels = [w for w in train.wheels if w.side == "left" and low <= position - w.delay <= high]
    x = position - np.array([w.delay for w in wheels])
    r = look("irregularity_vertical").factor * track.rail("vertical", "left").value(x)
    curve(ax, "wheels", x, r, label="wheels of the train", color=style.colour, ls="", marker="o", ms=6, zorder=4)
    return finish(ax, ALONG, "irregularity r (mm)")


def wheel_paths(
    train: Train,
    track: Track,
    speed: float,
    wheels: Sequence[tuple[int, int]] = ((1, 1), (1, 5)),
    stop: float = 4.0,
    ax: Axes | None = None,
) -> Axes:
    """Plot the vertical irregularity that some wheels meet over time: the same wave, later.

    Parameters
    ----------
    train : Train
    track : Track
    speed : float
        m/s.
    wheels : sequence of (car, wheel)
        Numbered from 1.
    stop : float
        End of the time axis, s.
    ax : Axes, optional
    """
    ax = one(ax)
    time = np.linspace(0.0, stop, 801)
    style = look("irregularity_vertical")
    known = {(w.car, w.number): w for w in train.wheels}
    for (car, number), colour in zip(wheels, (style.colour, *COMPARED), strict=False):
        if (car, number) not in known:
            raise InputError("wheels", (car, number), "no such (car, wheel) in this train", "Both are counted from 1")
        wheel = known[car, number]
        r = track.rail("vertical", wheel.side).value(speed * time - wheel.delay)
        dashes = "-" if colour == style.colour else "--"
        curve(ax, f"{car} {number}", time, style.factor * r, label=f"car {car}, wheel {number}", color=colour, ls=dashes)
    return finish(ax, TIME, "r under the wheel (mm)")


def frequencies(
    source: Vehicle | Deck, mark: Mapping[str, float] | None = None, ax: Axes | None = None, most: float | None = None
) -> Axes:
    """Plot natural frequencies as ticks on a frequency axis, with marks such as a forcing frequency.

    Parameters
    ----------
    source : Vehicle or Deck
    mark : mapping of float, optional
        Frequencies to mark, Hz, by name.
    ax : Axes, optional
    most : float, optional
        End of the axis, Hz.
    """
    ax = one(ax, 2.4)
    values, names = (source.frequencies_hz, source.mode_names) if isinstance(source, Deck) else _named_frequencies(source.modes())
    most = most or 1.15 * float(values[-1])
    groups: list[tuple[float, list[str]]] = []
    for f, name in zip(values, names, strict=True):
        if f <= most and groups and f < 1.06 * groups[-1][0]:
            groups[-1][1].append(name)
        elif f <= most:
            groups.append((f, [name]))
    shown = values[values <= most]
    style = look("displacement_z")
    curve(ax, "natural", np.repeat(shown, 3), np.tile([0.0, 1.0, np.nan], len(shown)), color=style.colour)
    for i, (f, near) in enumerate(groups):
        text = " \n".join(list(dict.fromkeys(near))[:2]) + " "
        note(ax, f"name {i}", text, f, 0.96, data_x=True, rotation=90, ha="right", size=7.5, color=style.colour)
    force = look("force_z")
    for name, f in (mark or {}).items():
        curve(ax, f"mark {name}", [f, f], [0.0, 1.0], label=f"{name} {f:.4g} Hz", color=force.colour, lw=2.5)
    low = min([float(values[0]), *(mark or {}).values()])
    log_frequencies(ax)
    finish(ax, "frequency (Hz)")
    ax.set(xlim=(0.75 * low, max([most, *(1.1 * f for f in (mark or {}).values())])), ylim=(0.0, 1.0), yticks=[])
    ax.spines["left"].set_visible(False)
    return ax


def _named_frequencies(modes) -> tuple[np.ndarray, tuple[str, ...]]:
    """Names without front and rear: those two mix freely."""
    return modes.frequencies_hz, tuple(" ".join(n.split()[-2:]) for n in modes.names)


# ---- forces between train and deck


def wheel_force(run: Crossing, car: int = 1, wheel: int = 1, ax: Axes | None = None) -> Axes:
    """Plot the vertical force of one wheel on the deck over time, static part included; both counted from 1."""
    ax = one(ax)
    history = run.wheel_force(car, wheel)
    static = next(-w.static_load for w in run.train.wheels if (w.car, w.number) == (car, wheel))
    style = look("force_z")
    _shade_car(run, car, ax)
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
    wheels = [(i, w) for i, w in enumerate(run.train.wheels) if w.car == car]
    if not wheels:
        raise InputError("car", car, "no such car in this train", "Cars are counted from 1")
    delays = sorted({round(w.delay, 6) for _, w in wheels})
    axes = grid(axes, len(delays), 1, 0.6 + 1.5 * len(delays), sharex=True, sharey=True)
    for number, (ax, delay) in enumerate(zip(axes, delays, strict=True), start=1):
        _shade_car(run, car, ax, label=number == 1)
        for i, w in wheels:
            if round(w.delay, 6) != delay:
                continue
            for row, name in enumerate(("force_y", "force_z")):
                style = look(name)
                label = f"{style.words}, {w.side}" if number == 1 else None
                colour = style.colour if w.side == "left" else COMPARED[0]
                curve(ax, f"{name} {w.side}", run.time, style.factor * run.wheel_forces[i, row], label=label, color=colour,
                      ls=style.line, lw=2.4 if w.side == "left" else 1.0)  # fmt: skip
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
        _shade_car(run, car, ax, label=ax is axes[0])
        values = style.factor * history[name]
        curve(ax, name, run.time, values, color=style.colour, ls="-")
        if steady and name in steady:
            middle = style.factor * float(run.coupling.static[car - 1][1::2].sum()) if static and name == "force_z" else 0.0
            level = style.factor * steady[name]
            ends = [run.time[0], run.time[-1], np.nan, run.time[0], run.time[-1]]
            lines = [middle + level] * 2 + [np.nan] + [middle - level] * 2
            curve(ax, "steady", ends, lines, label="steady amplitude", color="k", ls=":", lw=1.2)
        finish(ax, TIME if ax is axes[-1] else "", style.label, legend=ax is axes[0])
    axes[0].figure.align_ylabels(axes)
    return axes


def _shade_car(run: Crossing, car: int, ax: Axes, label: bool = True) -> None:
    """Shade the time while a car has a wheel on the deck."""
    delays = [w.delay for w in run.train.wheels if w.car == car]
    if not delays:
        raise InputError("car", car, "no such car in this train", "Cars are counted from 1")
    v = run.settings.speed
    shade(ax, "on deck", min(delays) / v, (max(delays) + run.deck.length) / v, f"car {car} on the deck" if label else None)


def _shade_train(run: Crossing, ax: Axes) -> None:
    stop = (run.train.length + run.deck.length) / run.settings.speed
    shade(ax, "on deck", 0.0, stop, "train on the deck")


# ---- spectra


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


# ---- deck


def deck_mode(deck: Deck, mode: int, ax: Axes | None = None) -> Axes:
    """Plot a mode shape of the deck along its axis: lateral, vertical and twist, each against the largest, with bearings.

    Twist is shown as the vertical motion at the deck's edge (1 m off the axis if the width is not known). Modes count from 1.
    """
    ax = one(ax, 2.2)
    i = inputs.integer("mode", mode, least=1, most=len(deck.mode_names)) - 1
    x = np.linspace(0.0, deck.length, 301)
    shape = deck.shapes(x)[:, i] * [1.0, 1.0, deck.width / 2 if deck.width else 1.0]
    shape = shape / np.abs(shape).max()
    names = ("displacement_y", "displacement_z", "rotation_x")
    words = ("lateral", "vertical", "twist" if not deck.width else "twist, at the edge")
    curve(ax, "axis", [0.0, deck.length], [0.0, 0.0], color=GREY, lw=0.8)
    for c, (name, word) in enumerate(zip(names, words, strict=True)):
        style = look(name)
        moves = np.abs(shape[:, c]).max() > 1e-3
        label = word if moves else None
        curve(ax, name, x, shape[:, c] if moves else np.full_like(x, np.nan), label=label, color=style.colour, ls=style.line)
    curve(ax, "bearings", deck.supports, np.zeros(len(deck.supports)), color="k", ls="", marker="^", ms=7, clip_on=False)
    title = f"mode {mode}: {deck.mode_names[i]}, {deck.frequencies_hz[i]:.4g} Hz, damping {100 * deck.damping_ratios[i]:.1f} %"
    finish(ax, ALONG, "shape (-)", title)
    ax.set_ylim(-1.15, 1.15)
    return ax


def deck_modes(deck: Deck, modes: Iterable[int] = range(1, 7), axes: Sequence[Axes] | None = None) -> np.ndarray:
    """Plot several mode shapes of the deck as small multiples; see `deck_mode`."""
    which = [m for m in modes if m <= len(deck.mode_names)]
    columns = min(2, len(which))
    rows = -(-len(which) // columns)
    axes = grid(axes, rows, columns, 0.4 + 1.75 * rows, sharex=True, sharey=True)
    for ax, m in zip(axes, which, strict=False):
        deck_mode(deck, m, ax)
        if ax.get_legend() is not None:
            ax.get_legend().remove()
        f, ratio = deck.frequencies_hz[m - 1], 100 * deck.damping_ratios[m - 1]
        ax.set_title(f"{m}: {deck.mode_names[m - 1]}, {f:.4g} Hz, {ratio:.1f} %", loc="left", fontsize="medium")
        ax.label_outer()
    for ax in axes[len(which) :]:
        ax.set_axis_off()
    handles = {label: h for ax in axes for h, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    handles = {label: h for label, h in handles.items() if not label.startswith("_")}
    axes[0].figure.legend(handles.values(), handles.keys(), loc="outside upper right", ncols=3, frameon=False, fontsize="small")
    return axes[: len(which)]


def damping(alpha: float, beta: float, marks: Mapping[str, float] | None = None, ax: Axes | None = None) -> Axes:
    """Plot Rayleigh damping over frequency with its two parts; `marks` names frequencies (Hz) to point out.

    Parameters
    ----------
    alpha, beta : float
        1/s and s; see `railbridge.rayleigh`.
    """
    ax = one(ax, 3.4)
    places = list((marks or {}).values())
    f = np.geomspace(min([0.5, *places]) * 0.9, max([60.0, *places]) * 1.1, 300)
    style = look("damping")
    total = style.factor * rayleigh_ratio(alpha, beta, f)
    curve(ax, "mass", f, style.factor * rayleigh_ratio(alpha, 0.0, f), label="mass part", color=GREY, ls="--")
    curve(ax, "stiffness", f, style.factor * rayleigh_ratio(0.0, beta, f), label="stiffness part", color=GREY, ls="-.")
    curve(ax, "total", f, total, label="damping ratio", color=style.colour, lw=2.0)
    values = style.factor * rayleigh_ratio(alpha, beta, np.array(places)) if places else np.array([])
    curve(ax, "points", places, values, color="k", ls="", marker="o", ms=4.5, zorder=3)
    log_frequencies(ax)
    most = 1.9 * max([5.0, *values])
    above = 0.0
    for place, value, name in sorted(zip(places, values, marks or {}, strict=True)):
        close = place < 1.12 * above
        above = above if close else place
        clear = {"bbox": {"fc": "white", "ec": "none", "pad": 0.8, "alpha": 0.85}}
        options = clear if close else {"rotation": 65, "rotation_mode": "anchor", "va": "center"}
        height = value / most + (-0.05 if close else 0.04)
        text = f"{'  ' if close else ''}{name}, {place:.4g} Hz"
        note(ax, f"mark {name}", text, place, height, data_x=True, **options)
    finish(ax, "frequency (Hz)", style.label)
    ax.set(xlim=(f[0], f[-1]), ylim=(0.0, most))
    return ax


def influence_line(deck: Deck, quantity: str, x: float, ax: Axes | None = None) -> Axes:
    """Plot an influence line: the output at x (m) against the place of a unit load of its own direction.

    Parameters
    ----------
    deck : Deck
    quantity : str
        A displacement or section force at x, or a reaction (``force_z``) of the bearing line at x.
    x : float
        m.
    ax : Axes, optional
    """
    if deck.recovery is None:
        raise InputError("deck", deck.name, "only its modes are known, so it has no influence lines")
    ax = one(ax)
    reaction = quantity in ("force_y", "force_z", "moment_x")
    line = deck.recovery.reaction(quantity, x) if reaction else deck.recovery.section(quantity, x)
    if line is None:
        raise InputError("quantity", quantity, "the deck has no such stiffness or bearing there")
    load = "z" if quantity.endswith(("_z", "vertical")) else "roll" if quantity.endswith(("_x", "torsion")) else "y"
    along = np.unique(np.concatenate([np.linspace(0.0, deck.length, 601), [max(x - 1e-6, 0.0), min(x + 1e-6, deck.length)]]))
    values = line.influence(along)[:, 0, ("y", "z", "roll").index(load)]
    style = look(quantity.replace("force", "reaction").replace("moment_x", "reaction_x") if reaction else quantity)
    unit_load = "MN m" if load == "roll" else "MN"
    unit = {"mm": (f"mm per {unit_load}", 1e9), "mrad": (f"mrad per {unit_load}", 1e9), "kN": ("-", 1.0)}.get(
        style.unit, ("-", 1.0) if load == "roll" else ("m", 1.0)
    )
    curve(ax, "axis", [0.0, deck.length], [0.0, 0.0], color=GREY, lw=0.8)
    curve(ax, "line", along, unit[1] * values, label=f"{style.words} at x = {x:g} m", color=style.colour, ls=style.line)
    curve(ax, "bearings", deck.supports, np.zeros(len(deck.supports)), color="k", ls="", marker="^", ms=7, clip_on=False)
    ways = {"y": "lateral", "z": "upward", "roll": "roll"}
    return finish(ax, "place of the load, x (m)", f"per unit {ways[load]} load ({unit[0]})")


# ---- deck response


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
    _shade_train(run, ax)
    if np.all(np.isnan(values)):
        note(ax, "rigid", "the deck has no stiffness given this way", 0.5, 0.5, ha="center")
    options = {"color": style.colour, "ls": style.line, **line}
    curve(ax, f"{name} {label or ''}", run.time, style.factor * values, label=label or history.where, **options)
    return finish(ax, TIME, style.label)


def reactions(run: Crossing, ax: Axes | None = None, quantity: str = "force_z", self_weight: bool = False) -> Axes:
    """Plot the reactions of all bearing lines over time: ``force_z``, ``force_y`` or ``moment_x``."""
    ax = one(ax)
    inputs.choice("quantity", quantity, ("force_y", "force_z", "moment_x"))
    style = look(f"reaction_{quantity[-1]}")
    _shade_train(run, ax)
    for (support, history), colour in zip(run.reactions(self_weight).items(), (style.colour, *COMPARED), strict=False):
        label = f"bearing at {support:g} m"
        curve(ax, label, run.time, style.factor * history[quantity], label=label, color=colour, ls=style.line)
    return finish(ax, TIME, style.label)


# ---- iteration and load modes


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
            _shade_car(run, car, a, label=a is upper)
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
    _shade_train(next(iter(runs.values())), ax)
    for (name, run), colour in zip(runs.items(), COMPARED * 9, strict=False):
        colour, dashes, width = looks.get(name, (colour, "-", 1.5))
        source = run.acceleration(x)[quantity] if quantity.startswith("acceleration") else _at(run, quantity, x, 1)
        curve(ax, name, run.time, style.factor * source, label=name, color=colour, ls=dashes, lw=width)
    return finish(ax, TIME, style.label, f"x = {x:g} m")
