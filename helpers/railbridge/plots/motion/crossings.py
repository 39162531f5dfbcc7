"""A train that moves over the deforming deck."""

from __future__ import annotations

import numpy as np

from ... import errors
from ...results import Crossing
from ..drawing import round_down
from ..outlines import TrainOutline, train_outline
from ..style import DECK_COLOUR, GREY, style_of
from .player import (
    FEWEST,
    INK,
    MOST,
    WIDTH,
    Animation,
    Drawing,
    attributes,
    element,
    pace_in_words,
    page,
    points_text,
    rounded,
    script,
)
from .stage import round_ticks

__all__ = ["animate_crossing"]

_MOTION, _FORCE = style_of("displacement_z").colour, style_of("force_z").colour
_RAIL = 112.0  # px from above
_LONGEST_BAR = 30.0  # px


def animate_crossing(
    run: Crossing, x: float | None = None, frames: int = 360, exaggeration: float | None = None
) -> Animation:
    """Animate a train over the deforming deck.

    With the force of every axle, and the displacement at one place below.

    Parameters
    ----------
    run : Crossing
    x : float, optional
        Place of the displacement below the picture, m; default mid-length of the deck.
    frames : int
        Pictures from the first axle's entry to a second after the last axle's exit, 4 to 600. Steps
        longer than a fifth of the deck's first period hide its swinging.
    exaggeration : float, optional
        How many times too large the vertical displacement is drawn; by default a round number that
        lets it be seen.

    Raises
    ------
    InputError
        A place off the deck, a number of frames out of range, or an exaggeration that is not
        positive.
    """
    deck, train, speed = run.deck, run.train, run.settings.speed
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    if x is None:
        x = deck.length / 2
    x = errors.place("x", x, (0.0, deck.length))
    if exaggeration is not None:
        remedy = "1 draws it true to scale"
        exaggeration = errors.number("exaggeration", exaggeration, above=0.0, remedy=remedy)
    stop = min(run.time[-1], (train.length + deck.length) / speed + 1.0)
    last = np.searchsorted(run.time, stop, "right") - 1
    samples = np.round(np.linspace(run.settings.before, last, frames)).astype(int)
    time, along = run.time[samples], np.linspace(0.0, deck.length, 25)
    shape = np.array([run.displacement(place)["displacement_z"][samples] for place in along]).T
    scale = (WIDTH - 40) / (deck.length + 2 * _margin(deck.length))  # px per m along the bridge
    if exaggeration is None:
        largest = float(np.abs(shape).max())
        exaggeration = round_down(26.0 / scale / largest) if largest > 0.0 else 1.0
    history = run.displacement(x)
    data = {
        "frames": frames,
        "start": int(np.abs(shape).max(axis=1).argmax()),
        "loop": False,
        "slider": "Time of the crossing",
        "seconds": round(float(np.clip(stop, 6.0, 20.0)), 3),
        "deck": rounded(-exaggeration * scale * shape),
        "time": rounded(time, 3),
        "value": rounded(1e3 * history["displacement_z"][samples], 3),
    }
    drawing = Drawing(372)
    static_load = max(axle.static_load for axle in train.placed_axles)
    _draw_bridge(drawing, data, run, scale, samples, static_load)
    _draw_history(drawing, data, x, time)
    factor = f"{exaggeration:.6g} times too large"
    drawing.write(10, 18, f"vertical displacement drawn {factor}", size=13)
    sag, moment = history.extreme("displacement_z")
    words = (
        f"{_train_in_words(run)} over {deck.name}, {deck.length:g} m, "
        f"at {speed:g} m/s ({3.6 * speed:.4g} km/h). Vertical displacement is drawn {factor}, "
        "the waves of the rail are not drawn, and the cars are drawn level: their own motion is "
        "not shown. A bar below an axle is its force on the deck, "
        f"{static_load / 1e3:.4g} kN at rest. At x = {x:g} m the largest displacement is "
        f"{1e3 * sag:.2f} mm at {moment:.2f} s. {pace_in_words(stop / data['seconds'])}"
    )
    title = f"{_train_in_words(run)} over {deck.name} at {speed:g} m/s, displacement {factor}"
    return Animation(title, frames, page(drawing, title, words, data, script("crossings.js")))


def _margin(length: float) -> float:
    """How much of the track is shown before and behind the bridge, m."""
    return max(12.0, length / 2)


# ---- the bridge


def _draw_bridge(
    drawing: Drawing,
    data: dict,
    run: Crossing,
    scale: float,
    samples: np.ndarray,
    static_load: float,
) -> None:
    """Draw train and deck, and add to the data what moves them.

    A bar below an axle is its force; that of `static_load`, the heaviest axle at rest (N), is the
    scale below the picture.
    """
    deck, outline = run.deck, train_outline(run.train)
    left, span = 20 + scale * _margin(deck.length), scale * deck.length
    head = left + scale * run.settings.speed * run.time[samples]
    forces = _axle_forces(run)[:, samples]
    per_newton = _LONGEST_BAR / max(float(forces.max()), static_load)
    bars = _force_bars(run, per_newton * forces, samples)
    data |= {"left": round(left, 1), "span": round(span, 1), "rail": _RAIL}
    data |= {"head": rounded(head), "force": bars, "delay": rounded(-scale * outline.wheels)}
    for a, b in ((0, left), (left + span, WIDTH)):
        line = {"stroke": GREY, "stroke-width": 2}
        drawing.add("line", x1=a, x2=b, y1=_RAIL, y2=_RAIL, **line)
    dashed = {"stroke": GREY, "stroke-dasharray": "5 4", "stroke-width": 1}
    drawing.add("line", x1=left, x2=left + span, y1=_RAIL, y2=_RAIL, **dashed)
    # All that moves stands where it is in the frame that is shown first.
    frame = data["start"]
    along = np.linspace(left, left + span, len(data["deck"][frame]))
    deck_y = _RAIL + np.array(data["deck"][frame])
    drawing.items.append(_cars(outline, scale, float(head[frame])))
    points = points_text(zip(along, deck_y, strict=True))
    line = {"fill": "none", "points": points, "data-deck": "", "stroke-width": 8}
    drawing.add("polyline", stroke=DECK_COLOUR, transform="translate(0 5)", **line)
    for foot in left + scale * np.array(deck.supports):
        corners = [foot - 8, _RAIL + 26], [foot + 8, _RAIL + 26], [foot, _RAIL + 11]
        drawing.add("polygon", points=points_text(corners), fill=DECK_COLOUR)
    places = head[frame] + scale * outline.wheels
    rail_y = np.interp(places, along, deck_y, left=_RAIL, right=_RAIL)
    for place, y, (first, bar) in zip(places, rail_y + 9, bars, strict=True):
        length = bar[frame - first] if 0 <= frame - first < len(bar) else 0.0
        line = {"stroke": _FORCE, "data-bar": "", "stroke-width": 3.5}
        ends = {"x1": place, "x2": place, "y1": y, "y2": y + length}
        drawing.add("line", **line, **ends, **{"stroke-opacity": int(length != 0.0)})
    for place, y in zip(places, rail_y - 3.5, strict=True):
        drawing.add("circle", cx=place, cy=y, r=3.5, fill=_FORCE, **{"data-wheel": ""})
    length = per_newton * static_load
    ends = {"x1": 16, "x2": 16, "y1": 150, "y2": 150 + length}
    drawing.add("line", **ends, stroke=_FORCE, **{"stroke-width": 3.5})
    drawing.write(24, 150 + length - 2, f"{static_load / 1e3:.4g} kN, an axle at rest")


def _axle_forces(run: Crossing) -> np.ndarray:
    """Return the vertical force of every axle on the deck, N, down positive, shape (axles, n)."""
    ends = np.cumsum([len(axle.wheels) for axle in run.train.placed_axles])
    return np.array([-f.sum(axis=0) for f in np.split(run.wheel_forces[:, 1], ends[:-1])])


def _force_bars(run: Crossing, lengths: np.ndarray, samples: np.ndarray) -> list:
    """Return for each axle the first frame in which it is on the deck, and its bars from there."""
    head, bars = run.settings.speed * run.time[samples], []
    for axle, own in zip(run.train.placed_axles, lengths, strict=True):
        on = np.flatnonzero((head >= axle.delay) & (head <= axle.delay + run.deck.length))
        first, last = (on[0], on[-1]) if len(on) else (0, -1)
        bars.append([int(first), rounded(own[first : last + 1])])
    return bars


def _cars(outline: TrainOutline, scale: float, head: float) -> str:
    """Return car bodies and bogie frames, all moved together, with the first axle at `head` px."""
    parts = []
    for car in outline.cars:
        rear, front = car.ends
        body = {"x": scale * rear, "y": _RAIL - 46, "width": scale * (front - rear)}
        parts.append(element("rect", **body, height=28, rx=3))
    for wheels in outline.frames:
        rear, front = scale * wheels.min() - 4, scale * wheels.max() + 4
        parts.append(element("rect", x=rear, y=_RAIL - 15, width=front - rear, height=5))
    place = f"translate({head:.1f} 0)"
    line = {"fill": "#fbeee4", "stroke": _FORCE, "stroke-width": 1.4, "transform": place}
    return f"<g data-train='' {attributes(line)}>{''.join(parts)}</g>"


# ---- the history below


def _draw_history(drawing: Drawing, data: dict, x: float, time: np.ndarray) -> None:
    """Draw the displacement at x over time, with its dot."""
    value = np.array(data["value"])
    low, high = min(0.0, value.min()), max(0.0, value.max())
    left, right, top, bottom = 62.0, WIDTH - 20.0, 236.0, 328.0
    reach = high - low or 1.0

    def across(seconds):
        return left + (right - left) * seconds / time[-1]

    def down(mm):
        return bottom - (bottom - top) * (mm - low) / reach

    curve = np.column_stack([across(time), down(value)])
    data["dot"] = [rounded(point) for point in curve]
    drawing.add("line", x1=left, x2=right, y1=down(0.0), y2=down(0.0), stroke=GREY)
    for tick in round_ticks(low, high, 4):
        y = down(tick)
        drawing.add("line", x1=left - 4, x2=left, y1=y, y2=y, stroke=INK)
        drawing.write(left - 7, y + 4, f"{tick:g}", anchor="end")
    for tick in round_ticks(0.0, time[-1], 8):
        drawing.add(
            "line", x1=across(tick), x2=across(tick), y1=bottom + 4, y2=bottom + 8, stroke=INK
        )
        drawing.write(across(tick), bottom + 22, f"{tick:g}", anchor="middle")
    drawing.add("line", x1=left, x2=right, y1=bottom + 4, y2=bottom + 4, stroke=INK)
    drawing.add("line", x1=left, x2=left, y1=top, y2=bottom, stroke=INK)
    drawing.write(left, top - 12, f"vertical displacement at x = {x:g} m (mm)", size=13)
    below = "time since the first axle entered (s)"
    drawing.write((left + right) / 2, bottom + 38, below, anchor="middle", size=13)
    line = {"fill": "none", "stroke": _MOTION, "stroke-width": 1.6}
    drawing.add("polyline", points=points_text(curve), **line)
    dot_x, dot_y = data["dot"][data["start"]]
    dot = {"fill": _MOTION, "stroke": "white", "data-dot": ""}
    drawing.add("circle", cx=dot_x, cy=dot_y, r=5, **dot)


# ---- words


def _train_in_words(run: Crossing) -> str:
    cars = sum(car.vehicle is not None for car in run.train.formation)
    count, word = (cars, "car") if cars else (len(run.train.placed_axles), "axle")
    return f"{count} {word}" + "s" * (count != 1)
