"""Diagrams that stand at the head of a notebook: what there is, and what its letters mean.

They are drawn by code and hold no results; lengths are not to scale.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, sin

from .. import errors
from .svg import GREY, MOVES, PUSHES, Drawing

__all__ = ["DIAGRAMS", "Diagram", "diagram"]


@dataclass(frozen=True)
class Diagram:
    """A drawing, shown by a notebook.

    Attributes
    ----------
    name : str
    svg : str
        The whole drawing.
    """

    name: str
    svg: str

    def __repr__(self) -> str:
        return f"Diagram: {self.name}"

    def _repr_svg_(self) -> str:
        return self.svg


def diagram(name: str) -> Diagram:
    """Return a diagram by its name, one of `DIAGRAMS`.

    Raises
    ------
    InputError
        There is none of this name.
    """
    name = errors.choice("name", name, DIAGRAMS)
    return Diagram(name, DIAGRAMS[name]().svg())


def _axes(d: Drawing, x: float, y: float, across: str, up: str = "z") -> None:
    d.arrow((x, y), (x + 38, y))
    d.arrow((x, y), (x, y - 38))
    d.text(x + 42, y + 5, f"*{across}*")
    d.text(x - 4, y - 44, f"*{up}*")


def _car_from_the_side(d: Drawing, middle: float, rail: float, scale: float = 20.0) -> list[float]:
    """Draw body, bogies, springs and wheels; return the places of the axles."""
    half_bogies, half_axles = 7.8 * scale, 1.25 * scale
    d.box(middle - 11.2 * scale, rail - 128, 22.4 * scale, 50)
    axles = []
    for bogie in (middle + half_bogies, middle - half_bogies):
        d.box(bogie - half_axles - 10, rail - 50, 2 * half_axles + 20, 12)
        d.spring(bogie - 8, rail - 78, rail - 50)
        d.damper(bogie + 10, rail - 78, rail - 50)
        for axle in (bogie + half_axles, bogie - half_axles):
            d.wheel_set(axle, rail)
            d.spring(axle, rail - 38, rail - 22, half=4)
            axles.append(axle)
    return axles


def _vehicle() -> Drawing:
    d = Drawing(900, 400, "A car, side, from above and looking forward, with its dimensions.")
    rail, middle = 160, 290
    axles = _car_from_the_side(d, middle, rail)
    d.ground([(20, rail), (560, rail)])
    d.text(middle, rail - 98, "car body m_s, I_ys", anchor="middle")
    d.text(middle, rail - 40, "bogie m_t, I_yt", anchor="middle")
    d.text(middle + 7.8 * 20 + 36, rail - 58, "k_s, c_s")
    d.text(axles[0] + 18, rail - 24, "k_t, c_t")
    _axes(d, 8, rail - 80, "x")
    d.measure((axles[1], rail + 16), (axles[0], rail + 16), "2 d_x", side=10)
    d.measure((middle - 156, rail + 50), (middle + 156, rail + 50), "2 l_x")
    top = 330
    d.box(middle - 224, top - 42, 448, 84)
    for axle in axles:
        d.line((axle, top - 30), (axle, top + 30))
        for y in (top - 30, top + 30):
            d.line((axle - 10, y), (axle + 10, y), width=5)
    d.line((40, top), (560, top), dashed=True)
    _axes(d, 8, top + 40, "x", "y")
    d.text(middle, top - 12, "from above", anchor="middle")
    d.text(axles[0] + 14, top - 52, "1 left", anchor="middle")
    d.text(axles[0] + 14, top + 64, "2 right", anchor="middle")
    x = 740
    d.box(x - 70, rail - 128, 140, 50)
    d.dot(x, rail - 103)
    d.box(x - 62, rail - 50, 124, 12)
    d.dot(x, rail - 44)
    for side in (-1, 1):
        d.spring(x + side * 56, rail - 78, rail - 50)
        d.spring(x + side * 49, rail - 38, rail - 22, half=4)
        d.box(x + side * 49 - 5, rail - 22, 10, 22)
    d.ground([(x - 100, rail), (x + 100, rail)])
    d.text(x, rail - 138, "looking forward", anchor="middle")
    for y, low, words in ((-103, -78, "l_z"), (-78, -44, "a_z"), (-44, -22, "b_z")):
        d.measure((x + 92, rail + y), (x + 92, rail + low), words)
    d.arrow((x - 96, rail - 90), (x - 134, rail - 90))
    d.text(x - 150, rail - 85, "*y*")
    d.measure((x - 49, rail + 16), (x + 49, rail + 16), "2 d_y", side=10)
    d.measure((x - 56, rail + 50), (x + 56, rail + 50), "2 l_y", side=10)
    return d


def _wave(start: float, stop: float, level: float, height: float, length: float, at: float = 0.0):
    steps = int(stop - start) // 4
    places = [start + (stop - start) * i / steps for i in range(steps + 1)]
    return [(x, level - height * sin(2 * pi * (x - start - at) / length)) for x in places]


def _track() -> Drawing:
    d = Drawing(900, 230, "Axles on a wavy rail, one behind the other; a wheel with a notch.")
    level, height, length, start = 130, 16, 200, 20
    d.line((start, level), (600, level), dashed=True)
    d.ground(_wave(start, 600, level, height, length), colour=MOVES)

    def rail(x: float) -> float:
        return level - height * sin(2 * pi * (x - start) / length)

    axles = (480, 430, 168, 118)
    for bogie in (455, 143):
        d.box(bogie - 45, level - 70, 90, 12)
    for axle in axles:
        d.line((axle, level - 58), (axle, rail(axle) - 11), width=1.0)
        d.wheel_set(axle, rail(axle))
    d.arrow((520, level - 64), (585, level - 64))
    d.text(590, level - 60, "*V*")
    d.measure((axles[3], level - 84), (axles[0], level - 84), "d_i, behind the first axle")
    d.measure((270, level + 38), (470, level + 38), "wavelength *\u03bb*", side=9)
    d.text(250, level - 26, "*r*(*x*)", colour=MOVES)
    d.arrow((244, level), (244, rail(244)), colour=MOVES)
    _axes(d, 30, 212, "x")
    x, y, r = 730, 104, 56
    d.circle(x, y, r)
    d.dot(x, y)
    low = (y + r * cos(0.45)) - 4
    d.line((x - r * sin(0.45), low), (x + r * sin(0.45), low), colour=PUSHES, width=4)
    d.text(x, y - r - 10, "circumference A_i", anchor="middle")
    d.ground([(650, y + r), (880, y + r)])
    d.measure((x - 25, y + r + 18), (x + 25, y + r + 18), "b_i", side=9)
    d.text(x + 52, y + r - 10, "notch, a_i deep", colour=PUSHES)
    return d


def _forces() -> Drawing:
    d = Drawing(
        900, 250, "The forces of the wheels on the deck, and the force and couples of the car."
    )
    rail, middle = 160, 270
    axles = _car_from_the_side(d, middle, rail, scale=18)
    d.ground([(30, rail), (520, rail)])
    for number, axle in zip((1, 3, 5, 7), axles, strict=True):
        d.arrow((axle, rail + 3), (axle, rail + 48), colour=PUSHES, width=2.4)
        d.text(axle, rail + 68, f"F_{number}", colour=PUSHES, anchor="middle")
    d.text(middle, rail - 98, "weights P_i and waves", anchor="middle")
    d.arrow((540, rail - 40), (596, rail - 40))
    d.text(568, rail - 52, "sum", anchor="middle")
    x = 730
    d.ground([(630, rail), (880, rail)])
    d.dot(x, rail)
    d.arrow((x, rail), (x, rail + 64), colour=PUSHES, width=3)
    d.text(x + 12, rail + 60, "F_z", colour=PUSHES)
    d.turn(x, rail, 30)
    d.text(x + 38, rail - 16, "M_y", colour=PUSHES)
    d.text(x, rail - 62, "one force and its couples", anchor="middle")
    d.text(x, rail - 42, "at rail level, below the middle", anchor="middle")
    d.text(640, rail + 40, "and F_y,", colour=PUSHES)
    d.text(640, rail + 62, "M_x, M_z", colour=PUSHES)
    _axes(d, 8, rail - 84, "x")
    return d


def _bearing(d: Drawing, x: float, y: float, moves: bool) -> None:
    d.line((x, y), (x - 10, y + 16), (x + 10, y + 16), (x, y))
    if moves:
        d.line((x - 12, y + 21), (x + 12, y + 21))


def _deck() -> Drawing:
    d = Drawing(900, 300, "The deck from the side, from above, and its section.")
    left, right, y = 60, 540, 70
    d.box(left, y - 12, right - left, 24)
    _bearing(d, left + 4, y + 12, moves=False)
    _bearing(d, right - 4, y + 12, moves=True)
    sag = [(left + (right - left) * i / 40, y + 34 * sin(pi * i / 40)) for i in range(41)]
    d.line(*sag, colour=MOVES, dashed=True)
    d.text(300, y + 56, "*w*(*x*, *t*)", colour=MOVES, anchor="middle")
    d.measure((left + 4, y + 62), (right - 4, y + 62), "span *L*", side=10)
    d.text(300, y - 22, "mass *\u03bc* per metre, stiffness *E* I_y", anchor="middle")
    top = 225
    d.box(left, top - 40, right - left, 80)
    for track in (top - 22, top + 22):
        for rail in (track - 6, track + 6):
            d.line((left - 20, rail), (right + 20, rail), width=1.2)
    d.line((left - 30, top), (right + 30, top), dashed=True)
    d.text(left - 34, top - 8, "axis")
    d.text(right + 26, top - 16, "track")
    d.text(300, top + 62, "from above", anchor="middle")
    _axes(d, 14, top + 62, "x", "y")
    x, z = 740, 110
    corners = [
        (-90, -40),
        (90, -40),
        (90, -30),
        (48, -26),
        (40, 40),
        (-40, 40),
        (-48, -26),
        (-90, -30),
    ]
    d.line(*[(x + a, z + b) for a, b in [*corners, corners[0]]])
    hollow = [(-34, -24), (34, -24), (28, 30), (-28, 30), (-34, -24)]
    d.line(*[(x + a, z + b) for a, b in hollow])
    d.dot(x, z)
    d.arrow((x, z), (x, z - 78), colour=MOVES)
    d.text(x + 8, z - 66, "*w*", colour=MOVES)
    d.arrow((x, z), (x - 110, z), colour=MOVES)
    d.text(x - 130, z + 5, "*v*", colour=MOVES)
    d.turn(x, z, 20, colour=MOVES)
    d.text(x + 26, z - 8, "*\u03b8*", colour=MOVES)
    d.text(x, z + 74, "section, looking along x", anchor="middle")
    return d


def _response() -> Drawing:
    d = Drawing(
        900, 240, "A train on the deck, what it does at one place, and what the bearings carry."
    )
    left, right, y = 120, 640, 120
    sag = [(left + (right - left) * i / 40, y + 26 * sin(pi * i / 40)) for i in range(41)]
    d.ground(sag, colour=MOVES)
    d.line((left, y), (right, y), dashed=True)
    for car in (560, 380, 200):
        d.box(car - 76, y - 58, 152, 34)
        for axle in (car + 62, car + 42, car - 42, car - 62):
            low = y + 26 * sin(pi * (axle - left) / (right - left)) * (left < axle < right)
            d.wheel_set(axle, low, radius=6)
    d.measure((380, y - 72), (560, y - 72), "car spacing *D*")
    d.arrow((660, y - 40), (720, y - 40))
    d.text(726, y - 35, "*V*")
    d.arrow((380, y), (380, y + 25), colour=MOVES)
    d.text(388, y + 58, "*w* at *x*", colour=MOVES)
    for x, name in ((left, "S at x = 0"), (right, "S at x = L")):
        d.arrow((x, y + 74), (x, y + 30), colour=PUSHES, width=2.4)
        _bearing(d, x, y + 4, moves=x == right)
        d.text(x, y + 94, name.replace("S", "reaction"), colour=PUSHES, anchor="middle")
    d.line((800, y - 30), (800, y + 60), width=2.2)
    d.text(800, y - 42, "a cut at *x*", anchor="middle")
    d.turn(836, y + 16, 20)
    d.text(862, y + 8, "M_y", colour=PUSHES)
    d.arrow((808, y + 92), (808, y + 50), colour=PUSHES, width=2.4)
    d.text(816, y + 88, "shear", colour=PUSHES)
    return d


def _loop() -> Drawing:
    d = Drawing(900, 230, "Train, forces, deck, motion, and round again.")
    boxes = {
        "train": (60, 84, 200, 62, "train", "cars on springs"),
        "deck": (640, 84, 200, 62, "deck", "modes"),
    }
    for x, y, width, height, head, below in boxes.values():
        d.box(x, y, width, height)
        d.text(x + width / 2, y + 26, head, anchor="middle")
        d.text(x + width / 2, y + 48, below, anchor="middle")
    d.line((260, 100), (300, 40), (600, 40), colour=PUSHES, width=2.2)
    d.arrow((600, 40), (640, 100), colour=PUSHES, width=2.2)
    d.text(450, 30, "wheel forces F_i on the deck", colour=PUSHES, anchor="middle")
    d.line((640, 130), (600, 190), (300, 190), colour=MOVES, width=2.2)
    d.arrow((300, 190), (260, 130), colour=MOVES, width=2.2)
    d.text(450, 212, "motion *w* under the wheels", colour=MOVES, anchor="middle")
    d.text(450, 110, "a wheel feels *r* + *w*:", anchor="middle")
    d.text(450, 132, "the equivalent irregularity", anchor="middle")
    return d


def _condensed() -> Drawing:
    d = Drawing(900, 220, "One car as four axle forces, as two, and as one, over the same span.")
    share = {"wheels": (-9.05, -6.55, 6.55, 9.05), "bogies": (-7.8, 7.8), "condensed": (0.0,)}
    for i, (name, places) in enumerate(share.items()):
        left, right, y = 30 + 295 * i, 280 + 295 * i, 130
        middle = (left + right) / 2
        d.ground([(left, y), (right, y)])
        _bearing(d, left, y + 2, moves=False)
        _bearing(d, right, y + 2, moves=True)
        long = 100 / len(places) ** 0.7
        for place in places:
            x = middle + 6.9 * place
            d.arrow((x, y - 3 - long), (x, y - 2), colour=PUSHES, width=2.2)
        part = {4: "P/4 per axle", 2: "P/2 per bogie", 1: "*P* per car"}[len(places)]
        d.text(middle, y + 48, part.replace("P/", "*P*/"), colour=PUSHES, anchor="middle")
        d.text(middle, y + 72, f'loads = "{name}"', anchor="middle")
    return d


def _exchange() -> Drawing:
    d = Drawing(900, 230, "Another program and the suite: modes in, loads out, motions back.")
    for x, head, below in (
        (40, "your program", "finite elements"),
        (650, "the suite", "train, track"),
    ):
        d.box(x, 60, 210, 110)
        d.text(x + 105, 108, head, anchor="middle")
        d.text(x + 105, 132, below, anchor="middle")
    rows = ((80, "nodes and modes", GREY, 1), (118, "loads over time", PUSHES, -1))
    for y, words, colour, way in (*rows, (156, "motions back, if you iterate", MOVES, 1)):
        ends = ((262, y), (638, y))[::way]
        d.arrow(*ends, colour=colour, width=2.2)
        d.text(450, y - 8, words, colour=colour, anchor="middle")
    return d


def _random() -> Drawing:
    d = Drawing(900, 215, "A spectrum makes a track, the track shakes a car, the car a deck.")
    top, bottom, level = 40, 150, 112
    fall = [(30 + 1.3 * i, bottom - 95 / (1 + 0.0016 * i * i)) for i in range(0, 116, 5)]
    d.arrow((24, bottom), (196, bottom))
    d.arrow((24, bottom), (24, top - 6))
    d.line(*fall, colour=MOVES, width=2.2)
    sizes = ((52, 9, 0.4), (31, 6, 2.0), (19, 4, 4.1), (11, 2, 1.0))
    places = range(250, 411, 2)

    def rail(x: float) -> float:
        return level - sum(size * sin(2 * pi * x / long + phase) for long, size, phase in sizes)

    d.ground([(x, rail(x)) for x in places], colour=MOVES)
    d.box(482, 40, 130, 32)
    for x in (505, 589):
        d.box(x - 22, 86, 44, 10)
        d.spring(x, 72, 86, half=4)
        for axle in (x - 15, x + 15):
            d.wheel_set(axle, 118, radius=9.0)
            d.arrow((axle, 121), (axle, bottom), colour=PUSHES)
    steps = [i / 40 for i in range(41)]
    for shift in (-13, 0, 13):
        sag = [(700 + 180 * s, 70 + (56 + shift) * sin(pi * s) ** 2) for s in steps]
        d.line(*sag, colour=MOVES, width=2.2 if shift == 0 else 1.0, dashed=shift != 0)
    for x in (204, 424, 636):
        d.arrow((x, 95), (x + 36, 95))
    for x, words in (
        (110, "spectrum of the track"),
        (330, "many tracks *r*(*x*)"),
        (547, "wheel forces"),
        (790, "mean and *\u03c3*, by time"),
    ):
        d.text(x, 195, words, anchor="middle")
    d.text(110, 30, "S_r over *\u03a9*", anchor="middle")
    return d


def _contact() -> Drawing:
    d = Drawing(900, 260, "A wheelset between its bogie and a rail on a bed; the end of a deck.")
    x, rail, still = 220, 156, 208
    d.box(x - 90, 24, 180, 16)
    d.text(x - 146, 37, "bogie")
    d.spring(x - 14, 40, 72)
    d.damper(x + 14, 40, 72)
    d.text(x + 36, 62, "k_t, c_t")
    d.circle(x, 98, 26)
    d.text(x, 103, "m_w", anchor="middle")
    d.spring(x, 124, rail, half=9)
    d.text(x + 36, 146, "k_H")
    sag = [(40 + 6 * i, rail + 12 / (1 + ((40 + 6 * i - x) / 60) ** 4)) for i in range(61)]
    d.line(*sag, colour=MOVES, width=3.2)
    d.text(404, rail + 2, "*E* I_r", colour=MOVES)
    for at in range(58, 400, 36):
        d.spring(at, rail + 12 / (1 + ((at - x) / 60) ** 4), still, half=4)
    d.text(404, rail + 38, "k_r")
    d.ground([(40, still), (400, still)])
    d.text(x, still + 36, "mass, contact, rail on a bed", anchor="middle")
    end, level = 740, 110
    d.line((end, level), (890, level), dashed=True)
    d.line((end, level), (890, level - 45), width=1.0, dashed=True)
    d.line((530, level + 63), (end, level), colour=MOVES, width=3.2)
    d.ground([(end, level), (890, level)])
    d.text(end + 92, level - 10, "*\u03d1*")
    d.circle(end - 66, level - 9, 26)
    d.arrow((end - 40, level - 44), (end + 40, level - 44))
    d.text(end + 46, level - 40, "*V*")
    _bearing(d, end - 4, level + 4, moves=True)
    d.text(560, level + 82, "deck", colour=MOVES)
    d.text(end - 20, still + 36, "the end of a deck, without a rail", anchor="middle")
    return d


DIAGRAMS: dict[str, Callable[[], Drawing]] = {
    "vehicle": _vehicle,
    "track": _track,
    "forces": _forces,
    "deck": _deck,
    "response": _response,
    "loop": _loop,
    "condensed": _condensed,
    "exchange": _exchange,
    "random": _random,
    "contact": _contact,
}
"""The diagrams by name."""
