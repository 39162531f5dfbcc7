"""The deck at rest in its modes: shapes, damping, influence lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from .. import errors
from ..decks import Deck, rayleigh_ratio
from ..errors import InputError
from .drawing import ALONG, GREY, curve, finish, grid, is_live, log_frequencies, look, note, one, rung


def deck_mode(deck: Deck, mode: int, ax: Axes | None = None) -> Axes:
    """Plot a mode shape of the deck along its axis: lateral, vertical and twist, each against the largest, with bearings.

    Twist is shown as the vertical motion at the deck's edge (1 m off the axis if the width is not known). Modes count from 1.
    """
    ax = one(ax, 2.2)
    i = errors.integer("mode", mode, least=1, most=len(deck.mode_names)) - 1
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
    low, high = min([0.5, *places]) * 0.9, max([60.0, *places]) * 1.1
    f = np.geomspace(*((1 / rung(1 / low), rung(high)) if is_live(ax) else (low, high)), 300)
    style = look("damping")
    total = style.factor * rayleigh_ratio(alpha, beta, f)
    curve(ax, "mass", f, style.factor * rayleigh_ratio(alpha, 0.0, f), label="mass part", color=GREY, ls="--")
    curve(ax, "stiffness", f, style.factor * rayleigh_ratio(0.0, beta, f), label="stiffness part", color=GREY, ls="-.")
    curve(ax, "total", f, total, label="damping ratio", color=style.colour, lw=2.0)
    values = style.factor * rayleigh_ratio(alpha, beta, np.array(places)) if places else np.array([])
    curve(ax, "points", places, values, color="k", ls="", marker="o", ms=4.5, zorder=3)
    log_frequencies(ax)
    most = 1.9 * max([5.0, *values])
    most = rung(most) if is_live(ax) else most
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
