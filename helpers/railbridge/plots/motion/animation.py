"""Moving pictures: a mode of a vehicle, and a train over the deforming deck; see `player` for what plays them."""

from __future__ import annotations

import numpy as np

from ... import errors
from ...results import Crossing
from ...vehicles import FREEDOMS, Modes, Vehicle
from ..drawing import GREY, LOOKS, MOTIONS, PALE, round_below
from ..outlines import car_outlines
from ..sketches import VIEWS, body_boxes, body_levels, extent, mode_motion, moved, same_frequency, spring_ends, what_moves, zigzag
from .player import INK, WIDE, Animation, Drawing, attributes, corners, mark, page, rounded

__all__ = ["Animation", "animate_crossing", "animate_vehicle_mode"]

CYCLE = 2.5  # s, for one cycle of a mode
FEWEST, MOST = 4, 600
"""Frames of an animation."""
_DECK = "#34495e"
_MOTION, _FORCE = LOOKS["displacement_z"].colour, LOOKS["force_z"].colour



def animate_vehicle_mode(vehicle: Vehicle, mode: int, frames: int = 24) -> Animation:
    """Animate a natural mode of a vehicle, from the side, from above and looking forward.

    A mode has a shape and no size: it is drawn as large as can be seen, and the picture says how large. Modes of equal frequency
    have no unique shapes; the picture then shows one of many and says so.

    Parameters
    ----------
    vehicle : Vehicle
    mode : int
        From 1.
    frames : int
        Pictures a cycle, 4 to 600; between them the player interpolates.

    Raises
    ------
    InputError
        No such mode, or a number of frames out of range.
    """
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    modes, motion = mode_motion(vehicle, mode)
    frequency, name = modes.frequencies_hz[mode - 1], _kind(vehicle, modes, mode - 1)
    drawing, rest, move, largest = _mode_drawing(vehicle, motion)
    words = (
        f"Mode {mode}, {frequency:.4g} Hz. {what_moves(vehicle, modes, mode - 1)} A mode has a shape and no size of its own: "
        f"here nothing moves by more than {largest:.2g} m, far more than in truth. One cycle takes {1 / frequency:.2g} s; here "
        f"it takes {CYCLE:g} s. Grey is the position at rest; heights are schematic."
    )
    title = f"mode {mode}, {name}, {frequency:.4g} Hz"
    chance = " (one of many shapes: it shares its frequency)" if same_frequency(modes, mode - 1) else ""
    note = f"{title}{chance}: drawn up to {largest:.2g} m, not to scale; one cycle in {CYCLE:g} s"
    data = {
        "frames": frames, "start": frames // 4, "loop": True, "seconds": CYCLE, "period": round(1 / frequency, 6),
        "slider": "Time within one cycle", "rest": rest, "move": move,
    }  # fmt: skip
    drawing.write(10, drawing.height - 8, note, size=13)
    return Animation(title, frames, page(drawing, title, words, data, "mode"))


def animate_crossing(run: Crossing, x: float | None = None, frames: int = 360, exaggeration: float | None = None) -> Animation:
    """Animate a train over the deforming deck, with the force of every axle and the displacement at one place.

    Parameters
    ----------
    run : Crossing
    x : float, optional
        Place of the displacement below the picture, m; default mid-length of the deck.
    frames : int
        Pictures from the first axle's entry to a second after the last axle's exit, 4 to 600. Steps longer than a fifth of the
        deck's first period hide its swinging.
    exaggeration : float, optional
        How many times too large the vertical displacement is drawn; by default a round number that lets it be seen.

    Raises
    ------
    InputError
        A place off the deck, a number of frames out of range, or an exaggeration that is not positive.
    """
    deck, train, speed = run.deck, run.train, run.settings.speed
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    x = deck.length / 2 if x is None else errors.number("x", x, least=0.0, most=deck.length, unit="m")
    if exaggeration is not None:
        exaggeration = errors.number("exaggeration", exaggeration, above=0.0, remedy="1 draws it true to scale")
    stop = min(run.time[-1], (train.length + deck.length) / speed + 1.0)
    sample = np.round(np.linspace(0.0, np.searchsorted(run.time, stop, "right") - 1, frames)).astype(int)
    time, along = run.time[sample], np.linspace(0.0, deck.length, 25)
    shape = np.array([run.displacement(place)["displacement_z"][sample] for place in along]).T
    scale = (WIDE - 40) / (deck.length + 2 * _margin(deck.length))  # px per m along the bridge
    largest = float(np.abs(shape).max())
    if exaggeration is None:
        exaggeration = round_below(26.0 / scale / largest) if largest > 0.0 else 1.0
    history = run.displacement(x)
    data = {
        "frames": frames, "start": int(np.abs(shape).max(axis=1).argmax()), "loop": False, "slider": "Time of the crossing",
        "seconds": round(float(np.clip(stop, 6.0, 20.0)), 3),
        "deck": rounded(-exaggeration * scale * shape), "time": rounded(time, 3),
        "value": rounded(1e3 * history["displacement_z"][sample], 3),
    }  # fmt: skip
    drawing = Drawing(372)
    rest = _draw_bridge(drawing, data, run, scale, time, sample)
    _draw_history(drawing, data, run, x, time)
    factor, sag = f"{exaggeration:.6g}", history.extreme("displacement_z")
    drawing.write(10, 18, f"vertical displacement drawn {factor} times too large", size=13)
    words = (
        f"{_who(run)} over {deck.name}, {deck.length:g} m, at {speed:g} m/s ({3.6 * speed:.4g} km/h). Vertical displacement is "
        f"drawn {factor} times too large, the waves of the rail are not drawn, and the cars are drawn level: their own motion is "
        f"not shown. A bar below an axle is its force on the deck, {rest / 1e3:.4g} kN at rest. At x = {x:g} m the largest "
        f"displacement is {1e3 * sag[0]:.2f} mm at {sag[1]:.2f} s. {_pace(stop / data['seconds'])}"
    )
    title = f"{_who(run)} over {deck.name} at {speed:g} m/s, displacement {factor} times too large"
    return Animation(title, frames, page(drawing, title, words, data, "crossing"))


# ---- the two drawings


def _kind(v: Vehicle, modes: Modes, i: int) -> str:
    """Name a mode by its freedom; of an equal pair no body can be named."""
    energy = np.diag(v.mass_matrix) * modes.shapes[:, i] ** 2
    share = {f: sum(e for e, label in zip(energy, modes.labels, strict=True) if label.endswith(f" {f}")) for f in FREEDOMS}
    return MOTIONS[max(share, key=lambda f: round(share[f] / energy.sum(), 6))]


def _mode_drawing(v: Vehicle, motion: dict[str, np.ndarray]) -> tuple[Drawing, list, list, float]:
    """Draw the three views; return the drawing, what moves at rest and by how much (px), and the largest motion (m)."""
    room = 0.9 if v.length > 12 else 0.5
    half_x, half_y, height = extent(v) + room
    scale = min(60.0, (WIDE - 80) / (2 * (half_x + half_y)))
    low = 30 + scale * height  # the rail, px from above
    middle = {"side": 20 + scale * half_x, "top": 20 + scale * half_x, "front": 60 + scale * (2 * half_x + half_y)}
    axis = low + 60 + scale * half_y  # the car's axis as seen from above
    drawing = Drawing(axis + scale * half_y + 30)
    boxes, level = body_boxes(v), body_levels(v)
    rest, move = [], []

    def place(view: str, points: np.ndarray) -> np.ndarray:
        a, b = points[:, VIEWS[view]].T
        across = middle[view] + scale * (-a if view == "front" else a)  # looking forward: left is left
        return np.column_stack([across, (axis if view == "top" else low) - scale * b])

    def add(view: str, still: np.ndarray, there: np.ndarray, closed: bool, fill: str = "none") -> None:
        a, b = place(view, still), place(view, there)
        rest.append(rounded(a.ravel()))
        move.append(rounded((b - a).ravel()))
        shape, shown = (
            "polygon" if closed else "polyline",
            {"stroke": _MOTION, "stroke-width": 1.8 if closed else 1.1, "fill": fill},
        )
        drawing.add(shape, points=corners(b), **{"data-part": len(rest) - 1}, **shown)

    rails = sorted({round(contact.y, 6) for contact in v.contacts})
    wheels = {"side": [axle.x for axle in reversed(v.axles)], "front": rails}
    for view, (a, b) in VIEWS.items():
        name = {"side": "side", "top": "from above", "front": "looking forward"}[view]
        drawing.write(middle[view], axis - scale * half_y - 4 if view == "top" else 20, name, anchor="middle")
        ordered = sorted(v.bodies, key=lambda body: level[body.name])
        for body in ordered:
            still = place(view, boxes[body.name].corners((a, b)))
            drawing.add("polygon", points=corners(still), stroke=PALE, fill="none", **{"stroke-width": 1.4})
        if view != "top":
            half = scale * (half_x if view == "side" else half_y)
            line = {"x1": middle[view] - half, "x2": middle[view] + half, "y1": low, "y2": low}
            drawing.add("line", stroke=INK, **line)
            for wheel in wheels[view]:
                centre = place(view, np.array([[wheel, wheel, 0.46]]))[0]
                look = {
                    "rx": 0.46 * scale if view == "side" else 0.09 * scale,
                    "ry": 0.46 * scale,
                    "stroke": GREY,
                    "fill": "white",
                }
                drawing.add("ellipse", cx=centre[0], cy=centre[1], **look)
        for body in ordered:
            still = boxes[body.name].corners((a, b))
            top = view == "top" and level[body.name] == max(level.values())
            add(view, still, moved(still, body.name, boxes, motion), True, "none" if top else "#0072B218")
        for spring in v.springs if view != "top" else ():
            ends = spring_ends(spring, boxes, level)
            there = [moved(p[None], n, boxes, motion)[0] for n, p in ends]
            lines = [np.zeros((8, 3)) for _ in range(2)]
            for line, (foot, head) in zip(lines, ([p for _, p in ends], there), strict=True):
                line[:, (a, b)] = zigzag(foot[[a, b]], head[[a, b]])
            add(view, *lines, False)
    largest = max(np.linalg.norm(np.array(m).reshape(-1, 2), axis=1).max() for m in move) / scale
    return drawing, rest, move, float(largest)


def _margin(length: float) -> float:
    """How much of the track is shown before and behind the bridge, m."""
    return max(12.0, length / 2)


def _draw_bridge(drawing: Drawing, data: dict, run: Crossing, scale: float, time: np.ndarray, sample: np.ndarray) -> float:
    """Draw train and deck, add to the data what moves them, and return the force of the heaviest axle at rest, N."""
    deck, train, speed, rail = run.deck, run.train, run.settings.speed, 112.0
    left, span = 20 + scale * _margin(deck.length), scale * deck.length
    delays = [axle.delay for axle in train.placed_axles]
    members = [[train.wheels.index(wheel) for wheel in axle.wheels] for axle in train.placed_axles]
    rest = max(axle.static_load for axle in train.placed_axles)
    forces = -np.array([run.wheel_forces[m, 1][:, sample].sum(axis=0) for m in members])
    per_newton = 30.0 / max(float(forces.max()), rest)
    head = left + scale * speed * time
    bars = []
    for delay, force in zip(delays, forces, strict=True):
        on = np.flatnonzero((speed * time >= delay) & (speed * time <= delay + deck.length))
        first, last = (on[0], on[-1]) if len(on) else (0, -1)
        bars.append([int(first), rounded(per_newton * force[first : last + 1])])
    data |= {"left": round(left, 1), "span": round(span, 1), "rail": rail, "head": rounded(head), "force": bars}
    data["delay"] = rounded(scale * np.array(delays))
    for a, b in ((0, left), (left + span, WIDE)):
        drawing.add("line", x1=a, x2=b, y1=rail, y2=rail, stroke=GREY, **{"stroke-width": 2})
    rest_line = {"stroke": GREY, "stroke-dasharray": "5 4", "stroke-width": 1}
    drawing.add("line", x1=left, x2=left + span, y1=rail, y2=rail, **rest_line)
    cars = []
    for car in car_outlines(train, 0.0):
        rear, front = car.body
        body = {"x": scale * rear, "y": rail - 46, "width": scale * (front - rear), "height": 28}
        cars.append(mark("rect", **body, rx=3))
        for at in car.bogies:
            wide = scale * (at.max() - at.min()) + 8
            cars.append(mark("rect", x=scale * at.min() - 4, y=rail - 15, width=wide, height=5))
    # All that moves stands where it is in the frame that is shown first.
    frame = data["start"]
    across, down = np.linspace(left, left + span, len(data["deck"][frame])), rail + np.array(data["deck"][frame])
    look = {"fill": "#fbeee4", "stroke": _FORCE, "stroke-width": 1.4, "transform": f"translate({head[frame]:.1f} 0)"}
    drawing.items.append(f"<g data-train='' {attributes(look)}>{''.join(cars)}</g>")
    line = {"fill": "none", "points": corners(zip(across, down, strict=True)), "data-deck": ""}
    drawing.add("polyline", stroke=_DECK, transform="translate(0 5)", **line, **{"stroke-width": 8})
    for foot in left + scale * np.array(deck.supports):
        drawing.add("polygon", points=corners([[foot - 8, rail + 26], [foot + 8, rail + 26], [foot, rail + 11]]), fill=_DECK)
    places = head[frame] - scale * np.array(delays)
    lows = np.interp(places, across, down, left=rail, right=rail)
    for place, low, (first, bar) in zip(places, lows, bars, strict=True):
        long = bar[frame - first] if 0 <= frame - first < len(bar) else 0.0
        line = {"x1": place, "x2": place, "y1": low + 9, "y2": low + 9 + long, "stroke-opacity": int(long != 0.0)}
        drawing.add("line", stroke=_FORCE, **{"data-bar": "", "stroke-width": 3.5}, **line)
    for place, low in zip(places, lows, strict=True):
        drawing.add("circle", cx=place, cy=low - 3.5, r=3.5, fill=_FORCE, **{"data-wheel": ""})
    drawing.add("line", x1=16, x2=16, y1=150, y2=150 + per_newton * rest, stroke=_FORCE, **{"stroke-width": 3.5})
    drawing.write(24, 150 + per_newton * rest - 2, f"{rest / 1e3:.4g} kN, an axle at rest")
    return rest


def _draw_history(drawing: Drawing, data: dict, run: Crossing, x: float, time: np.ndarray) -> None:
    """Draw the displacement at x over time, with its dot."""
    value = np.array(data["value"])
    low, high = min(0.0, value.min()), max(0.0, value.max())
    reach = high - low or 1.0
    left, right, top, bottom = 62.0, WIDE - 20.0, 236.0, 328.0
    across = left + (right - left) * time / time[-1]
    up = bottom - (bottom - top) * (value - low) / reach
    data["dot"] = [rounded(p) for p in np.column_stack([across, up])]
    zero = bottom + (bottom - top) * low / reach
    drawing.add("line", x1=left, x2=right, y1=zero, y2=zero, stroke=GREY)
    for tick in _ticks(low, high, 4):
        y = bottom - (bottom - top) * (tick - low) / reach
        drawing.add("line", x1=left - 4, x2=left, y1=y, y2=y, stroke=INK)
        drawing.write(left - 7, y + 4, f"{tick:g}", anchor="end")
    for tick in _ticks(0.0, time[-1], 8):
        at = left + (right - left) * tick / time[-1]
        drawing.add("line", x1=at, x2=at, y1=bottom + 4, y2=bottom + 8, stroke=INK)
        drawing.write(at, bottom + 22, f"{tick:g}", anchor="middle")
    drawing.add("line", x1=left, x2=right, y1=bottom + 4, y2=bottom + 4, stroke=INK)
    drawing.add("line", x1=left, x2=left, y1=top, y2=bottom, stroke=INK)
    drawing.write(left, top - 12, f"vertical displacement at x = {x:g} m (mm)", size=13)
    drawing.write((left + right) / 2, bottom + 38, "time since the first axle entered (s)", anchor="middle", size=13)
    line = {"points": corners(np.column_stack([across, up])), "fill": "none", "stroke": _MOTION, "stroke-width": 1.6}
    drawing.add("polyline", **line)
    x_dot, y_dot = data["dot"][data["start"]]
    drawing.add("circle", cx=x_dot, cy=y_dot, r=5, fill=_MOTION, stroke="white", **{"data-dot": ""})


def _pace(ratio: float) -> str:
    if 0.99 < ratio < 1.01:
        return "It plays at true speed."
    return f"It plays {ratio:.2g} times too fast." if ratio > 1.0 else f"It plays {1 / ratio:.2g} times too slowly."


def _who(run: Crossing) -> str:
    cars = sum(car.vehicle is not None for car in run.train.formation)
    axles = len(run.train.placed_axles)
    count, word = (cars, "car") if cars else (axles, "axle")
    return f"{count} {word}" + "s" * (count != 1)


# ---- numbers


def _ticks(low: float, high: float, most: int) -> np.ndarray:
    step = next(s * 10.0**p for p in range(-12, 13) for s in (1, 2, 5) if (high - low) / (s * 10.0**p) <= most)
    return step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1) + 0.0
