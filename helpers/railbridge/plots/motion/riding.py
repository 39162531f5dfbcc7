"""A car that rides over the waves of the rail, on ground that gives or does not."""

from __future__ import annotations

import numpy as np

from ... import errors
from ...errors import InputError
from ...results import Crossing
from ...steady import steady_motion
from ...tracks import FadeIn, Harmonic, Track
from ...trains import Car
from ...vehicles import Vehicle
from ..outlines import drawn_length
from ..style import DECK_COLOUR, GREY, style_of
from .player import (
    FEWEST,
    INK,
    MOST,
    WIDTH,
    Animation,
    pace_in_words,
    page,
    points_text,
    rounded,
    script,
)
from .sideview import SideView, ride_of
from .stage import Stage

__all__ = ["animate_car_on_waves", "animate_rigid_and_flexible"]

CYCLE = 2.5  # s, in which one wave passes
_MOTION = style_of("displacement_z").colour
_LARGEST_SCALE = 60.0  # px per m
_A_WAVE = 12  # points of a rail, if that is between
_FEWEST_POINTS, _MOST_POINTS = 49, 97  # from end to end


def animate_car_on_waves(
    vehicle: Vehicle, wave: Harmonic, speed: float, frames: int = 48
) -> Animation:
    """Animate a car that runs steadily over waves of the rail, seen from its left side.

    Its wheels are on the rail; its bodies move as they do once the start is forgotten. The picture
    goes with the car, and marks on the ground pass by.

    Parameters
    ----------
    vehicle : Vehicle
    wave : Harmonic
        The vertical irregularity of both rails.
    speed : float
        m/s.
    frames : int
        Pictures a wave, 4 to 600; between them the player interpolates.

    Raises
    ------
    InputError
        A speed that is not positive, another irregularity, or a number of frames out of range.
    """
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    if not isinstance(wave, Harmonic):
        raise InputError("wave", wave, "must be a Harmonic: the motion on it repeats")
    motion = steady_motion(vehicle, Track(vertical=wave), speed)
    name, period = vehicle.body.name, wave.wavelength / speed
    turn = np.arange(frames + 1) / frames
    values = {n: (a * np.exp(2j * np.pi * turn)).imag for n, a in motion.items()}
    travelled = wave.wavelength * turn
    ride = ride_of(vehicle, values, {a.x: wave.value(travelled + a.x) for a in vehicle.axles})
    scale = min(_LARGEST_SCALE, (WIDTH - 40) / (1.3 * drawn_length(vehicle)))
    reach = (WIDTH - 40) / scale / 2
    along = _places(-reach, reach, wave.wavelength)
    rail = wave.value(travelled[:frames, None] + along)
    car = SideView(vehicle, scale, [ride], float(np.abs(rail).max()))
    level, middle, body = 34.0 + car.height, WIDTH / 2, ride.bodies[name][0]
    stage = Stage(level + 248.0, int(body[:frames].argmax()), car.numbers)
    stage.set_along(middle, -scale * wave.wavelength / frames)
    with stage.along():
        _draw_marks(stage, wave.wavelength, scale, reach, level)
    stage.data["rail"] = rounded(car.per_metre * rail)
    flat = np.full(len(along), level)
    stage.add_line(middle + scale * along, flat, "rail", stroke=INK, **{"stroke-width": 2})
    car.draw(stage, 0, middle, level, _MOTION)
    first = vehicle.axles[0].x
    curves = {
        "rail below the first axle": ("rail", 1e3 * ride.wheels[first], INK),
        "middle of the car body": ("car body", 1e3 * body, _MOTION),
    }
    stage.add_curves(level + 92.0, period * turn, curves, "time within one wave (s)")
    factor = f"{car.exaggeration:.6g} times too large"
    stage.write(10, 18, f"waves and motions drawn {factor}", size=13)
    largest, high = 1e3 * abs(motion.get(f"{name} z", 0.0)), 1e3 * wave.amplitude
    words = (
        f"A car at {speed:g} m/s ({3.6 * speed:.4g} km/h) on waves of {wave.wavelength:g} m: "
        f"{1 / period:.4g} Hz. Waves and motions are drawn {factor}; heights and springs are "
        f"schematic. Each wheel follows the rail where it is, {high:.3g} mm up and down. "
        f"The middle of the car body moves {largest:.3g} mm up and down. "
        f"One wave takes {period:.2g} s; here it takes {CYCLE:g} s. The picture goes with the car; "
        "a dark mark on the ground passes with each wave."
    )
    title = f"car on waves of {wave.wavelength:g} m and {high:.3g} mm at {speed:g} m/s, {factor}"
    clock = {"loop": True, "seconds": CYCLE, "slider": "Time within one wave"}
    return _played(stage, title, words, frames, period * turn, clock)


def animate_rigid_and_flexible(run: Crossing, car: int = 1, frames: int = 180) -> Animation:
    """Animate one car twice at the same time: on a rigid deck, and on the deck that gives.

    Above, the rail has its waves only; below, it moves with the deck as well. Only one car of the
    train is drawn, and notches of its wheels are not.

    Parameters
    ----------
    run : Crossing
        With the deck's motion fed back: interaction ``iterate`` or ``direct``.
    car : int
        From 1.
    frames : int
        Pictures from the car's entry to half a second after its exit, 4 to 600.

    Raises
    ------
    InputError
        A run without feedback, or whose wheels do not meet the rail at their own places; no such
        car, or bare axle loads; a number of frames out of range.
    """
    frames = errors.integer("frames", frames, least=FEWEST, most=MOST)
    if run.iteration == 0:
        allowed = "'rigid' has no deck that gives"
        raise InputError("interaction", None, allowed, "Give a run with interaction = 'iterate'")
    errors.choice("excitation", run.settings.excitation, ("wheels",))
    both = _Twice(run, run.train.car(car), frames)
    vehicle, deck, speed, time = both.car.vehicle, run.deck, run.settings.speed, both.time
    margin = max(0.6 * drawn_length(vehicle), deck.length / 4)
    scale = (WIDTH - 40) / (deck.length + 2 * margin)
    left = 20.0 + scale * margin
    highest = np.abs(both.sag).max(), np.abs(both.rail(both.along)).max()
    view = SideView(vehicle, scale, both.rides, float(max(highest)))
    levels = 44.0 + view.height + (view.height + 62.0) * np.arange(2)
    bodies = [1e3 * ride.bodies[vehicle.body.name][0] for ride in both.rides]
    frame = int(np.abs(bodies[1] - bodies[0]).argmax())
    stage = Stage(levels[1] + 258.0, frame, view.numbers)
    step = scale * speed * (time[-1] - time[0]) / (frames - 1)
    stage.set_along(left + scale * (speed * time[0] - both.car.centre), step)
    stage.data["deck"] = rounded(view.per_metre * both.sag)
    names, colours = ("on a rigid deck", f"on {deck.name}"), (INK, _MOTION)
    for row, level in enumerate(levels):
        stage.write(10, level - view.height + 4.0, names[row], size=13)
        for before, after in ((-margin, 0.0), (deck.length, deck.length + margin)):
            x = np.linspace(before, after, 61)
            _draw_rail(stage, left + scale * x, level - view.per_metre * both.rail(x))
        x = left + scale * both.along
        _draw_rail(stage, x, np.full(len(x), level + 10.0), row == 1, (GREY, _MOTION)[row], 8)
        _draw_rail(stage, x, level - view.per_metre * both.rail(both.along), row == 1)
        for foot in left + scale * np.array(deck.supports):
            corners = [foot - 8, level + 30], [foot + 8, level + 30], [foot, level + 15]
            stage.add("polygon", points=points_text(corners), fill=DECK_COLOUR)
        with stage.along():
            view.draw(stage, row, 0.0, level, colours[row])
    curves = {
        f"middle of the car body {names[row]}": (short, bodies[row], colours[row])
        for row, short in enumerate(("rigid deck", "deck that gives"))
    }
    stage.add_curves(levels[1] + 102.0, time, curves, "time since the first axle entered (s)")
    factor = f"{view.exaggeration:.6g} times too large"
    stage.write(10, 18, f"waves, deck and motions drawn {factor}", size=13)
    most = [np.abs(values).max() for values in (*bodies, bodies[1] - bodies[0])]
    seconds = float(np.clip(3.0 * (time[-1] - time[0]), 6.0, 20.0))
    words = (
        f"Car {car} of {len(run.train.formation)} at {speed:g} m/s ({3.6 * speed:.4g} km/h), twice "
        f"at the same time: above {names[0]}, below {names[1]}, {deck.length:g} m. Waves, deck and "
        f"motions are drawn {factor}; heights and springs are schematic, and no other car is "
        f"drawn. The middle of the car body moves by at most {most[0]:.1f} mm above and "
        f"{most[1]:.1f} mm below, and the two differ by at most {most[2]:.1f} mm. "
        f"{pace_in_words((time[-1] - time[0]) / seconds)}"
    )
    title = f"car {car} on a rigid deck and on {deck.name} at {speed:g} m/s, {factor}"
    clock = {"loop": False, "seconds": round(seconds, 3), "slider": "Time of the crossing"}
    return _played(stage, title, words, frames, time, clock)


def _played(
    stage: Stage, title: str, words: str, frames: int, time: np.ndarray, clock: dict
) -> Animation:
    """Return the stage with its player; the frames are evenly spaced in time (s)."""
    data = {"frames": frames, "start": stage.frame, **clock, **stage.data}
    data["time"] = [round(float(value), 6) for value in (time[0], time[1] - time[0])]
    return Animation(title, frames, page(stage, title, words, data, script("riding.js")))


# ---- how a car moves


class _Twice:
    """A car of a run on a rigid deck and on its own, in pictures evenly spaced in time.

    Attributes
    ----------
    car : Car
    time : ndarray, shape (frames,)
        s.
    along : ndarray, shape (places,)
        Places along the deck, m.
    sag : ndarray, shape (frames, places)
        How far the deck moves up below the track, m, as the wheels feel it.
    rides : list of Ride
        On the rigid deck, on the run's own.
    """

    def __init__(self, run: Crossing, car: Car, frames: int) -> None:
        motions = [each.car_motion(car.number) for each in (run.at(0), run)]
        speed, delays = run.settings.speed, [axle.delay for axle in car.axles]
        stop = min(run.time[-1], (max(delays) + run.deck.length) / speed + 0.5)
        self.car, self.time = car, np.linspace(min(delays) / speed, stop, frames)
        self.along = _places(0.0, run.deck.length, run.track.shortest)

        def now(values: np.ndarray) -> np.ndarray:
            return np.interp(self.time, run.time, values)

        self.sag = np.array([now(_below_track(run, x)) for x in self.along]).T
        lead_in = run.settings.lead_in
        self._rails = [FadeIn(run.track.rail("vertical", s), lead_in) for s in ("left", "right")]
        at = {axle.x: speed * self.time - car.centre + axle.x for axle in car.vehicle.axles}
        rigid = {x: self.rail(place) for x, place in at.items()}
        gives = {x: rigid[x] + self._deck_at(place) for x, place in at.items()}
        labels = car.vehicle.labels
        self.rides = [
            ride_of(car.vehicle, {n: now(motion[n]) for n in labels}, wheels)
            for motion, wheels in zip(motions, (rigid, gives), strict=True)
        ]

    def rail(self, x: np.ndarray) -> np.ndarray:
        """Return the waves at places, m: the mean of both rails."""
        return sum(rail.value(x) for rail in self._rails) / 2

    def _deck_at(self, places: np.ndarray) -> np.ndarray:
        """Return how far the deck is up at a place for each frame; nothing off the deck."""
        rows = zip(places, self.sag, strict=True)
        return np.array([np.interp(x, self.along, row, left=0.0, right=0.0) for x, row in rows])


def _places(start: float, stop: float, shortest: float) -> np.ndarray:
    """Return places at which a rail with waves of this length at least is drawn, m."""
    wanted = 1 + _A_WAVE * (stop - start) / shortest
    return np.linspace(start, stop, int(np.clip(wanted, _FEWEST_POINTS, _MOST_POINTS)))


def _below_track(run: Crossing, x: float) -> np.ndarray:
    moved = run.displacement(x)
    if run.settings.feedback != "all" or "rotation_x" not in moved.values:
        return moved["displacement_z"]
    return moved["displacement_z"] + run.settings.track_offset * moved["rotation_x"]


# ---- the ground


def _draw_marks(stage: Stage, wavelength: float, scale: float, reach: float, level: float) -> None:
    """Draw eight marks a wave on the ground, as far as they are seen while one wave passes."""
    gap = wavelength / 8
    for number in range(-int(reach / gap) - 1, int((reach + wavelength) / gap) + 2):
        x, whole = scale * gap * number, number % 8 == 0
        ends = {"x1": x, "x2": x, "y1": level + 34, "y2": level + (46 if whole else 40)}
        stage.add("line", **ends, stroke=INK if whole else GREY, **{"stroke-width": 1.5})


def _draw_rail(
    stage: Stage, x: np.ndarray, y: np.ndarray, moves: bool = False, colour: str = INK,
    width: float = 2,
) -> None:  # fmt: skip
    """Draw a rail, or a deck, at x, y (px); whether it moves with the deck."""
    line = {"stroke": colour, "stroke-width": width}
    if moves:
        stage.add_line(x, y, "deck", **line)
    else:
        points = points_text(zip(x, y, strict=True))
        stage.add("polyline", points=points, fill="none", **line)
