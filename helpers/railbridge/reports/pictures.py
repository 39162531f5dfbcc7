"""Pictures of a report: the figures of `plots` as SVG that is the same whenever it is made."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import plots
from ..codes import Verdicts
from ..decks import Deck
from ..errors import InputError
from ..plots import gallery
from ..plots.drawing import FIGURE_WIDTH, curve, label_axes
from ..plots.maps import at_place, label_of, scale_of
from ..plots.style import RUN_COLOURS, STYLE, literal
from ..results import Crossing
from ..tracks import Track
from ..trains import AnyTrain
from .parts import Picture

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

__all__ = [
    "drawn", "modes", "of_run", "over_one", "over_speeds", "over_two", "sketches",
    "track_picture", "verdict_bars",
]  # fmt: skip

_PX = 96.0
"""Of an inch on the screen."""
_SALT = "railbridge"
"""Of the names of parts inside a picture, which are random otherwise."""
_MOST_POINTS = 4
"""Places whose histories are drawn."""
_MOST_KINDS = 3
"""Kinds of cars that are sketched."""
_MODES = 6
_KINDS = ("envelope", "displacement", "acceleration", "section_forces", "reactions", "wheels",
          "cars", "convergence")  # fmt: skip
_WITHOUT_WEIGHT = ("envelope", "displacement", "section_forces", "reactions")
_TRACK_BESIDE = 40.0
"""m of track before and behind the deck that are drawn."""


def drawn(title: str, height: float, draw: Callable[[Any], None]) -> Picture:
    """Return a picture of what a function draws into an axes of notebook width.

    Parameters
    ----------
    title : str
    height : float
        inch.
    draw : function of an Axes
    """

    def make() -> Any:
        import matplotlib.pyplot as plt

        figure, ax = plt.subplots(figsize=(FIGURE_WIDTH, height), layout="constrained")
        draw(ax)
        return figure

    return _picture(title, make)


def _picture(title: str, make: Callable[[], Any]) -> Picture:
    """Return the picture of a figure; nobody else's settings reach it, and none are left."""
    import matplotlib.pyplot as plt

    own = {"svg.hashsalt": _SALT, "svg.fonttype": "path", "font.size": 9.5}
    with plt.style.context(["default", STYLE, own]):
        figure = make()
        try:
            file = io.StringIO()
            nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
            figure.savefig(file, format="svg", metadata=nothing)
            width, height = figure.get_size_inches() * _PX
        finally:
            plt.close(figure)
    return Picture(title, file.getvalue(), float(width), float(height))


def _figure_of(axes: Any) -> Any:
    return np.ravel(np.asarray(axes, dtype=object))[0].figure


# ---- what is given


def sketches(train: AnyTrain, deck: Deck) -> Iterator[Picture]:
    """Give the train on its deck, and each kind of car."""
    about = "The train at the bridge; lengths to scale, heights schematic"
    yield drawn(about, 1.9, lambda ax: plots.train_on_deck(train, deck, ax))
    for vehicle, cars in train.kinds()[:_MOST_KINDS]:
        about = f"Car of kind {vehicle.name}, {len(cars)} of them"
        yield _picture(about, lambda v=vehicle: _figure_of(plots.vehicle(v)))


def modes(deck: Deck) -> Picture:
    """Return the first mode shapes of a deck."""
    count = min(_MODES, len(deck.mode_names))
    about = f"Shapes of the first {count} modes: number, name, frequency, damping"
    return _picture(about, lambda: _figure_of(plots.deck_modes(deck, range(1, count + 1))))


def track_picture(track: Track, deck: Deck, lead_in: float) -> Picture:
    """Return the irregularity of the track at the deck."""
    ends = -min(_TRACK_BESIDE, max(lead_in, 10.0)), deck.length + _TRACK_BESIDE
    about = "Irregularity of the track at the deck"

    def draw(ax: Axes) -> None:
        # As it is on the deck: the run-up fades in farther away, or starts at it.
        plots.irregularity(track, *ends, ax=ax, deck=deck)

    return drawn(about, 2.4, draw)


# ---- one crossing


def of_run(run: Crossing, points: Sequence[float]) -> Iterator[Picture]:
    """Give what the gallery of a run has for a report: envelopes, histories, passes.

    Of the cars the one with the wheel that is unloaded most.

    Parameters
    ----------
    run : Crossing
    points : sequence of float
        m.
    """
    kinds = [kind for kind in _KINDS if kind != "convergence" or _settles(run)]
    car = 1
    if run.train.kinds():
        unloading = np.nan_to_num(run.wheel_unloading).max(axis=1)
        car = run.train.wheels[int(np.argmax(unloading))].car
    for piece in gallery.figures_of(run, points[:_MOST_POINTS], [car], kinds):
        about = piece.about + ", without self-weight" * (piece.kind in _WITHOUT_WEIGHT)
        yield _picture(about, piece.draw)


def _settles(run: Crossing) -> bool:
    """Whether there is more than one change to be seen."""
    changes = np.array(run.changes)
    return len(changes) > 1 and bool(np.all(np.isfinite(changes)) and np.any(changes > 0.0))


def verdict_bars(verdicts: Verdicts) -> Picture:
    """Return how much of each limit is used."""
    about = "How much of each limit is used; bars end at twice the limit"
    return _picture(about, lambda: plots.utilisation(verdicts).figure)


# ---- many crossings


def over_speeds(
    found: xr.Dataset, quantity: str, x: float | None, deck: Deck, limit: float | None = None,
    limit_name: str = "limit",
) -> Picture:  # fmt: skip
    """Return the largest value of a quantity over the speed, a line a train."""
    at = "" if x is None else f" at x = {x:g} m"
    about = f"{label_of(found, quantity).capitalize()}{at} over the speed"

    def draw(ax: Axes) -> None:
        named = {"limit": limit, "limit_name": literal(limit_name)}
        plots.envelope(found, quantity, x, ax, deck=deck, **named)

    return drawn(about, 3.8, draw)


def over_two(found: xr.Dataset, quantity: str, x: float | None, title: str) -> Picture | None:
    """Return a map of a quantity over the two things that vary; None where it cannot be drawn."""
    try:
        return drawn(title, 4.2, lambda ax: plots.map(found, quantity, ax, x=x))
    except (InputError, TypeError):  # words along an axis, or a single value
        return None


def over_one(
    found: xr.Dataset, quantity: str, x: float | None, dim: str, title: str
) -> Picture | None:
    """Return a quantity over the one thing that varies, a line a train; None without numbers."""
    values = at_place(found, quantity, x)
    along = found[dim].values
    numeric = along.dtype.kind in "fiu"
    if not np.isfinite(values.values).any():
        return None
    factor, unit = scale_of(found, quantity)
    trains = [str(t) for t in found["train"].values] if "train" in values.dims else [""]
    lines = values.transpose("train", dim).values if "train" in values.dims else values.values[None]

    def draw(ax: Axes) -> None:
        places = along if numeric else np.arange(len(along))
        for i, (train, line) in enumerate(zip(trains, lines, strict=True)):
            look = {"color": RUN_COLOURS[i % len(RUN_COLOURS)], "marker": "o", "ms": 3.5}
            label = literal(train) if train else None
            curve(ax, f"line {i}", places, factor * line, label=label, **look)
        own = str(found[dim].attrs.get("units", ""))
        words = str(found[dim].attrs.get("long_name") or dim)
        label_axes(ax, literal(f"{words} ({own})" if own else words),
                   literal(f"{label_of(found, quantity)} ({unit})"))  # fmt: skip
        if not numeric:
            names = [literal(str(v)[:24]) for v in along]
            ax.set_xticks(places, names, rotation=20 if len(names) > 4 else 0)

    return drawn(title, 3.2, draw)
