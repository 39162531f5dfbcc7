"""The pictures of one crossing, all that there are: for files, and for whoever writes a report.

They are drawn without pyplot and in Matplotlib's own look, so no setting, window or open figure of
the user is touched, and the same run gives the same file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import errors
from ..decks import History
from ..results import ENVELOPE, Crossing
from . import along, carbodies, forces, response, scene, track
from .drawing import FIGURE_WIDTH
from .style import STYLE, literal, style_of

__all__ = ["FORMATS", "KINDS", "Piece", "absent", "file_names", "figures_of", "write"]

KINDS = {
    "train": "train, deck and irregularity of the track",
    "displacement": "displacements and twist of the deck at each point",
    "acceleration": "accelerations of the deck at each point",
    "section_forces": "bending moments, torsion and shear forces at each point",
    "envelope": "smallest and largest values along the deck",
    "reactions": "forces of the bearing lines on the deck",
    "wheels": "wheel forces of each car asked for",
    "cars": "accelerations of the body of each car asked for",
    "spectrum": "amplitude spectrum of the first car's vertical force",
    "iterations": "the first point's displacement and what iterations change in it",
    "convergence": "the change at each iteration",
}
"""What can be drawn of a run, in the order in which it is."""

FORMATS = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
"""Formats of files, each with what is left out of it: whatever differs from day to day."""

_AT_POINTS = ("displacement", "acceleration", "section_forces")
_OF_CARS = ("wheels", "cars")
_LEAST = 1e-6  # of the units drawn (mm, kN, m/s2): less is nothing to look at


class Piece(NamedTuple):
    """A picture that can be drawn.

    Attributes
    ----------
    kind : str
        One of `KINDS`.
    name : str
        For a file, without its ending: ``displacement_at_18m``.
    about : str
        What it shows, in words.
    draw : callable
        Returns a new figure; it belongs to nobody, pyplot does not know it.
    """

    kind: str
    name: str
    about: str
    draw: Callable[[], Figure]


def absent(run: Crossing, kinds: Sequence[str] = tuple(KINDS)) -> dict[str, str]:
    """Return why some kinds of pictures cannot be drawn of a run, by kind.

    Parameters
    ----------
    run : Crossing
    kinds : sequence of str
        Some of `KINDS`.
    """
    reasons = dict.fromkeys(("section_forces", "reactions"), run.deck.recovery.lacks)
    if not run.changes:
        reasons |= dict.fromkeys(("iterations", "convergence"), "nothing was iterated")
    if not run.train.kinds():
        constant = ("wheels", "spectrum", "iterations", "convergence")
        reasons |= dict.fromkeys(constant, "bare axle loads are constant")
        reasons["cars"] = "bare axle loads have no bodies"
    return {kind: reasons[kind] for kind in _known(kinds) if reasons.get(kind)}


def file_names(
    points: Sequence[float], cars: Sequence[int] = (1,), kinds: Sequence[str] = tuple(KINDS)
) -> list[str]:
    """Return the names of all pictures that there can be of a run, known before it is computed.

    Parameters
    ----------
    points : sequence of float
        m.
    cars : sequence of int
        From 1.
    kinds : sequence of str
        Some of `KINDS`.
    """
    return [name for kind in _known(kinds) for name, _ in _named(kind, points, cars)]


def figures_of(
    run: Crossing,
    points: Sequence[float],
    cars: Sequence[int] = (1,),
    kinds: Sequence[str] = tuple(KINDS),
) -> Iterator[Piece]:
    """Give the pictures of a run, one after the other; what it does not have is left out.

    Parameters
    ----------
    run : Crossing
    points : sequence of float
        Places along the deck, m.
    cars : sequence of int
        Whose wheel forces and bodies are shown, from 1.
    kinds : sequence of str
        Some of `KINDS`; drawn in the order of those.

    Yields
    ------
    Piece
        Named as in `file_names`.

    Raises
    ------
    InputError
        An unknown kind, a place off the deck, a car that there is not.
    """
    points = errors.places("points", points, (0.0, run.deck.length)).tolist()
    for car in cars:
        run.train.car(car)
    known, missing = _known(kinds), absent(run, kinds)
    for kind in known:
        if kind in missing:
            continue
        for name, of in _named(kind, points, cars):
            place = points[0] if of is None else of
            draw = partial(_drawn, _DRAWN[kind], run, place)
            yield Piece(kind, name, _about(run, kind, place), draw)


def write(
    figure: Figure,
    file: str | Path | IO[bytes],
    form: str = "png",
    dpi: float = 120.0,
    title: str = "",
) -> None:
    """Write a figure; the same figure gives the same bytes, on whatever day.

    Parameters
    ----------
    figure : Figure
    file : str, Path or binary file
    form : {"png", "svg", "pdf"}
    dpi : float
        Of what consists of pixels: 9 inches are 1080 of them.
    title : str
        Not drawn: programs that list files show it.
    """
    errors.choice("form", form, FORMATS)
    with _look():
        metadata = FORMATS[form] | ({"Title": title} if title else {})
        figure.savefig(file, format=form, dpi=dpi, metadata=metadata)


@contextmanager
def _look() -> Iterator[None]:
    """Draw as Matplotlib does where nobody has changed it, and name parts of an SVG by content."""
    # Ids of an SVG are random numbers without a salt.
    with style.context(["default", STYLE, {"svg.hashsalt": "railbridge"}]):
        yield


def _known(kinds: Sequence[str]) -> list[str]:
    """Return kinds in their order, each once, or refuse one that there is not."""
    asked = [errors.choice("kinds", kind, KINDS) for kind in kinds]
    return [kind for kind in KINDS if kind in asked]


def _named(
    kind: str, points: Sequence[float], cars: Sequence[int]
) -> list[tuple[str, float | int | None]]:
    """Return the names of one kind's pictures, and the point (m) or car of each, if it has one."""
    if kind in _AT_POINTS:
        return [(f"{kind}_at_{x:.9g}m", x) for x in points]
    if kind in _OF_CARS:
        return [(f"{kind}_{car}", car) for car in cars]
    return [(kind, None)]


def _about(run: Crossing, kind: str, place: float) -> str:
    x = f"at x = {place:g} m"
    return {
        "train": f"{literal(run.deck.name)} and the train as it enters",
        "displacement": f"Displacement of the deck {x}",
        "acceleration": f"Acceleration of the deck {x}, "
        f"modes up to {run.deck.frequencies_hz[-1]:.3g} Hz",
        "section_forces": f"Section forces {x}",
        "envelope": "Smallest and largest values along the deck",
        "reactions": "Forces of the bearing lines on the deck",
        "wheels": f"Wheel forces on the deck, car {place}",
        "cars": f"Accelerations of the body, car {place}",
        "spectrum": "Vertical force of the first car",
        "iterations": f"Iterations, deck {x}",
        "convergence": "How the iteration settles",
    }[kind]


# ---- how each kind is drawn


def _drawn(draw: Callable[[Crossing, float], Figure], run: Crossing, place: float) -> Figure:
    with _look():
        return draw(run, place)


def _rows(count: int, row: float, **options) -> tuple[Figure, np.ndarray]:
    """Return a new figure of so many axes, one below the other, each `row` inches high."""
    figure = Figure(figsize=(FIGURE_WIDTH, 0.6 + row * count), layout="constrained")
    return figure, np.ravel(figure.subplots(count, 1, squeeze=False, **options))


def _stacked(figure: Figure, axes: Sequence[Axes]) -> Figure:
    """Let axes with one time axis say it once, and the legend once where all say the same."""
    said: list[list[str]] = []
    for ax in axes:
        ax.label_outer()
        texts = [t.get_text() for t in ax.get_legend().get_texts()] if ax.get_legend() else []
        if texts and texts in said:
            ax.get_legend().remove()
        said.append(texts)
    figure.align_ylabels(axes)
    return figure


def _acts(values: np.ndarray, quantity: str) -> bool:
    """Whether there is something to see; round-off, where nothing can be, is not."""
    drawn = np.abs(style_of(quantity).factor * values)
    return bool(np.nanmax(drawn, initial=0.0) > _LEAST)


def _shown(names: Sequence[str], acts: Callable[[str], bool]) -> list[str]:
    """Return what acts, or the first if all is still: then that is what is to be seen."""
    return [name for name in names if acts(name)] or [*names][:1]


def _leave_still(ax: Axes, acts: bool) -> None:
    if not acts:
        ax.set_ylim(-1.0, 1.0)


def _train(run: Crossing, _: float) -> Figure:
    level = run.track.level
    figure, axes = _rows(1 if level else 2, 2.1, sharex=True)
    scene.train_on_deck(run.train, run.deck, axes[0])
    if not level:
        axes[0].set_xlabel("")
        axes[0].tick_params(labelbottom=False)
        start, stop = axes[0].get_xlim()
        lead_in = run.settings.lead_in
        track.irregularity(run.track, start, stop, lead_in, axes[1], run.deck)
    return figure


def _histories(
    run: Crossing, x: float, history: History, draw: Callable[..., Axes], option: str, names: dict
) -> Figure:
    """Draw those components of a history that act, one below the other."""
    acting = {name: _acts(history[name], name) for name in names}
    has = [name for name in names if not np.isnan(history[name]).all()]
    shown = _shown(has, lambda name: acting[name])
    figure, axes = _rows(len(shown), 1.9, sharex=True)
    for ax, name in zip(axes, shown, strict=True):
        draw(run, x, ax=ax, **{option: names[name]})
        _leave_still(ax, acting[name])
    return _stacked(figure, axes)


def _displacement(run: Crossing, x: float) -> Figure:
    names = {"displacement_z": "z", "displacement_y": "y", "rotation_x": "x"}
    return _histories(run, x, run.displacement(x), response.displacement, "component", names)


def _acceleration(run: Crossing, x: float) -> Figure:
    names = {f"acceleration_{way}": way for way in ("z", "y", "roll")}
    return _histories(run, x, run.acceleration(x), response.acceleration, "component", names)


def _section_forces(run: Crossing, x: float) -> Figure:
    history = run.section_forces(x)
    names = {name: name for name in history.values}
    return _histories(run, x, history, response.section_force, "quantity", names)


def _envelope(run: Crossing, _: float) -> Figure:
    found = {name: run.envelope(name) for name in ENVELOPE}
    has = [name for name, own in found.items() if own is not None]
    shown = _shown(has, lambda name: _acts(found[name].values, name))
    figure, axes = _rows(len(shown), 1.9, sharex=True)
    for ax, name in zip(axes, shown, strict=True):
        along.deck_envelope(run, name, ax)
    return _stacked(figure, axes)


def _reactions(run: Crossing, _: float) -> Figure:
    found = run.reactions().values()

    def acts(name: str) -> bool:
        return any(_acts(history[name], f"reaction_{name[-1]}") for history in found)

    shown = _shown(("force_z", "force_y", "moment_x"), acts)
    figure, axes = _rows(len(shown), 1.9, sharex=True)
    for ax, name in zip(axes, shown, strict=True):
        response.reactions(run, ax, name)
    return _stacked(figure, axes)


def _wheels(run: Crossing, car: int) -> Figure:
    """Vertical beside lateral forces, which are far smaller, in a scale of their own."""
    own = run.train.car(car)
    lateral = [run.wheel_force(car, wheel.number)["force_y"] for wheel in own.wheels]
    ways = ["force_z", *["force_y"] * _acts(np.array(lateral), "force_y")]
    size = FIGURE_WIDTH, 0.8 + 1.5 * len(own.axles)
    figure = Figure(figsize=size, layout="constrained")
    figure.get_layout_engine().set(wspace=0.06)
    options = {"sharex": True, "sharey": "col", "squeeze": False}
    axes = figure.subplots(len(own.axles), len(ways), **options)
    for column, way in zip(axes.T, ways, strict=True):
        forces.wheel_forces(run, car, column, (way,))
        figure.align_ylabels(column)
    return figure


def _cars(run: Crossing, car: int) -> Figure:
    history = run.car_accelerations(car)

    def acts(way: str) -> bool:
        return any(_acts(values, way) for name, values in history.values.items() if way in name)

    has = [way for way in carbodies.WAYS if carbodies.body_rows(run, car, (way,))]
    shown = _shown(has, acts)
    figure, axes = _rows(len(carbodies.body_rows(run, car, shown)), 1.9, sharex=True)
    carbodies.car_body(run, car, axes, shown)
    return _stacked(figure, axes)


def _spectrum(run: Crossing, _: float) -> Figure:
    numbers = sorted({0, 1, run.iterations}) if run.changes else [run.iterations]
    figure = Figure(figsize=(FIGURE_WIDTH, 3.0), layout="constrained")
    options = {"sharex": True, "sharey": True, "squeeze": False}
    axes = np.ravel(figure.subplots(1, len(numbers), **options))
    if run.changes:
        forces.spectra(run, numbers, axes)
    else:
        forces.spectrum(run, axes[0])
    return figure


def _iterations(run: Crossing, x: float) -> Figure:
    figure, axes = _rows(2, 2.1, sharex=True, height_ratios=[1.6, 1.0])
    quantity = "displacement_z" if run.deck.has["z"] else "displacement_y"
    response.iterations(run, quantity, sorted({0, 1, run.iterations}), axes, x)
    return figure


def _convergence(run: Crossing, _: float) -> Figure:
    figure, (ax,) = _rows(1, 2.6)
    response.convergence(run, ax)
    return figure


_DRAWN = {
    "train": _train, "displacement": _displacement, "acceleration": _acceleration,
    "section_forces": _section_forces, "envelope": _envelope, "reactions": _reactions,
    "wheels": _wheels, "cars": _cars, "spectrum": _spectrum, "iterations": _iterations,
    "convergence": _convergence,
}  # fmt: skip
