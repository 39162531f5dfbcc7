"""What can be computed, but is unlikely to be meant: slips of unit or decimal point.

Every bound stands here, with its source. Nothing is refused: unusual cases compute. Bounds are wide
enough that real bridges and trains, foot bridges, culverts and long spans pass without a word; one
slip gives one sentence, with the likely reason found from the factor by which the value is off.

What only the maker of a deck knows (E, a density, the springs of its bearings) he holds against the
same bounds and leaves in `Deck.remarks`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .decks import Deck
from .errors import InputWarning
from .settings import Settings
from .tracks import Irregularity, Notch, Rails, Track
from .trains import AnyTrain, AxleTrain, Train
from .units import G
from .vehicles import Vehicle

__all__ = [
    "BOUNDS", "UNUSUAL", "Bound", "damping_frequencies", "doubt", "doubts", "first_frequencies",
    "first_vertical", "frequency_in_doubt", "frequency_off", "longest_span", "material",
    "scale_in_doubt", "soft_bearing", "table",
]  # fmt: skip


@dataclass(frozen=True)
class Bound:
    """What a quantity usually is, and which slips are known.

    Attributes
    ----------
    what : str
        The quantity, for people.
    low, high : float
        Beyond these it is doubted.
    unit : str
    source : str
        Why they stand where they do.
    slips : tuple of (factor, words)
        What makes the number right again, and what was then done wrong.
    usual : (low, high), optional
        Where the right value must lie for a slip to be the likely one; low and high if not given.
    """

    what: str
    low: float
    high: float
    unit: str
    source: str
    slips: tuple[tuple[float, str], ...] = ()
    usual: tuple[float, float] | None = None

    @property
    def range(self) -> str:
        """The bounds in words."""
        if self.low > 0.0 and self.high < np.inf:
            words = f"{self.low:g} to {self.high:g}"
        else:
            words = f"at least {self.low:g}" if self.low > 0.0 else f"at most {self.high:g}"
        return f"{words} {self.unit}".rstrip()

    def slip(self, value: float) -> str:
        """Return in words what was probably done wrong, as a question."""
        low, high = self.usual or (self.low, self.high)
        likely = [words for factor, words in self.slips if low <= abs(value) * factor <= high]
        question = " or ".join(likely[:2]).replace(" or given in ", " or ")
        return (question or "is its decimal point right") + "?"


_MM, _CM = (1e-3, "given in mm"), (1e-2, "given in cm")
_KILO, _MEGA = "given in k{}", "given in M{}"
_FEET = (0.3048, "given in feet")

BOUNDS = {
    "youngs_modulus": Bound(
        "Young's modulus", 1e9, 4e11, "Pa", "timber 8e9 (EN 338) to steel 2.1e11 (EN 1993-1-1)",
        ((1e6, "given in MPa"), (1e9, "given in GPa"), (1e3, "given in kN/m2")), (4e9, 2.3e11),
    ),
    "density": Bound(
        "density", 300.0, 2e4, "kg/m3",
        "timber 350 (EN 338) to steel 7850, with room for a track's mass spread over the section",
        ((1e3, "given in t/m3"), (1e3 / G, "a weight in kN/m3"), (1 / G, "a weight in N/m3"),
         (1e-3, "given in g/m3")), (400.0, 9e3),
    ),
    "density_of_steel": Bound(
        "density of a steel section", 300.0, 7.5e4, "kg/m3",
        "steel 7850, more where ballast and slab are spread over a small section",
        ((1e3, "given in t/m3"), (1 / G, "a weight in N/m3")), (5e3, 9e3),
    ),
    "area": Bound(
        "area of a section", 5e-3, 200.0, "m2", "a light steel girder to 40 m of slab",
        ((1e-4, "given in cm2"), (1e-6, "given in mm2")), (5e-3, 60.0),
    ),
    "second_moment": Bound(
        "second moment of area", 1e-6, 1e4, "m4",
        "a rolled beam 1e-5 to a box or truss of a 300 m span, some 1e3",
        ((1e-8, "given in cm4"), (1e-12, "given in mm4"), (1e-4, "given in dm4")), (1e-5, 3e3),
    ),
    "span": Bound(
        "longest span", 1.0, 2000.0, "m", "a culvert to the longest suspended spans",
        (_MM, _CM, (1e3, "given in km")), (2.0, 400.0),
    ),
    "mass": Bound(
        "mass per metre", 100.0, 3e5, "kg/m",
        "foot bridges to ballasted concrete with several tracks",
        ((1e3, "given in t/m"), (1e-3, "given in g/m"), (1e3 / G, "a weight in kN/m"),
         (1 / G, "a weight in N/m")), (1e3, 6e4),
    ),
    "width": Bound(
        "width of a deck", 1.0, 80.0, "m", "one narrow track to twelve", (_MM, _CM), (3.0, 40.0)
    ),
    "track_height": Bound(
        "rails, centroid or bearing from the deck axis", 0.0, 15.0, "m",
        "the deepest box girders; trusses have more", (_MM, _CM), (0.1, 5.0),
    ),
    "bearing_shear": Bound(
        "spring of a bearing along or across", 2e4, 1e14, "N/m",
        "elastomers 1e6 (G b l / t of EN 1337-3), tall piers 1e6; a tenth of a small pad",
        ((1e3, "given in kN/m"), (1e6, "given in MN/m")), (5e5, 1e11),
    ),
    "bearing_sag": Bound(
        "a bearing's share of the deck's weight over its vertical spring", 0.0, 0.1, "m",
        "elastomers give some millimetres (EN 1337-3)",
    ),
    "damping_ratio": Bound(
        "damping ratio of the first vertical mode", 0.0, 0.2, "",
        "EN 1991-2, Table 6.6: 0.005 to 0.03; the most heavily damped foot bridges 0.1",
        ((1e-2, "given in per cent"),), (1e-3, 0.1),
    ),
    "polar_radius": Bound(
        "radius of gyration of a section in twist", 0.15, 20.0, "m", "0.5 to 60 m wide"
    ),
    "bending_radius": Bound(
        "radius of gyration of a section in bending", 0.01, 20.0, "m",
        "slabs 0.1 m deep to trusses 40 m deep",
    ),
    "shear_share": Bound(
        "E I / (kGA L2), what shear adds to bending", 0.0, 0.5, "",
        "0.01 to 0.05 for girders, 0.2 for trusses",
    ),
    "axle_load": Bound(
        "axle load", 27e3, 1e6, "N",
        "empty trams 30e3 to the heaviest axles 4e5; 1e6 where one force stands for a car",
        ((1e3, "given in kN"), (1e3 * G, "given in t"), (G, "given in kg"), (1e-3, "given in mN"),
         (0.1, "ten times too large")), (4e4, 4e5),
    ),
    "body_mass": Bound(
        "mass of a vehicle's body", 20.0, 5e5, "kg", "seats to the heaviest wagons",
        ((1e3, "given in t, or its thousands mark read as a decimal point"), (1e-3, "given in g")),
        (500.0, 1.2e5),
    ),
    "vehicle_frequency": Bound(
        "lowest frequency of a vehicle", 0.1, np.inf, "Hz", "cars sway at 0.4 Hz and more"
    ),
    "axle_gap": Bound(
        "smallest distance of neighbouring axles", 0.3, 40.0, "m",
        "wheels are 0.7 m thick; 30 m where one force stands for a car",
        (_MM, _CM, (1e2, "is its decimal point right"), (1e3, "given in km")), (1.0, 30.0),
    ),
    "axle_pause": Bound(
        "largest distance of neighbouring axles", 0.0, 400.0, "m",
        "two trains behind each other", (_MM, _CM), (1.0, 30.0),
    ),
    "car_length": Bound(
        "length and wheel base of a car, and its spacing beyond the length", 0.0, 60.0, "m",
        "the longest coaches 27 m, articulated ones 50 m", (_MM, _CM, _FEET), (2.0, 60.0),
    ),
    "off_axis": Bound(
        "wheels and tracks from the deck axis", 0.0, 15.0, "m",
        "the outer of seven tracks", (_MM, _CM, (0.1, "ten times too far")), (0.5, 10.0),
    ),
    "speed": Bound(
        "speed of a train", 0.0, 117.0, "m/s", "1.2 times 350 km/h, the fastest lines (EN 1991-2)",
        ((1 / 3.6, "given in km/h"),), (3.0, 117.0),
    ),
    "amplitude": Bound(
        "amplitude of a wave", 0.0, 0.1, "m",
        "EN 13848-5: 0.03 m is stopped at once; more only in long waves", (_MM, _CM), (2e-5, 0.05),
    ),
    "wavelength": Bound(
        "wavelength", 0.02, 1000.0, "m", "corrugation 0.03 m (EN 13231) to waves of 200 m",
        (_MM, _CM, (1e3, "given in km")), (0.02, 200.0),
    ),
    "slope": Bound(
        "slope of the track", 0.0, 0.1, "", "dipped joints 0.02, corrugation 0.01", (_MM,),
        (0.0, 0.05),
    ),
    "phase": Bound("phase", 0.0, 2 * np.pi + 1e-6, "rad", "one turn"),
    "notch_depth": Bound(
        "depth of a notch", 0.0, 0.01, "m", "EN 15313: wheels with 1 mm are withdrawn",
        (_MM, _CM), (1e-5, 0.005),
    ),
    "circumference": Bound(
        "circumference of a wheel", 0.9, 5.0, "m", "diameters 0.33 to 1.4 m", (_MM, _CM), (0.9, 5.0)
    ),
    "live_sag": Bound(
        "static displacement under the train over the longest span", 0.0, 0.01, "",
        "EN 1990, A2.4.4: 1/600 under heavier loads",
    ),
    "own_sag": Bound(
        "sag under the deck's own weight over the longest span", 0.0, 0.02, "",
        "18 mm / n0^2 (EN 1991-2, 6.4.4): 1/150 at the widened lower frequency of long spans",
    ),
}  # fmt: skip
"""What is held against what; the keys are names for the code only."""

UNUSUAL = "modes.unusual", "= true: a first frequency beyond those of bridges is accepted."
"""Field and text of the remark on a deck whose scale is accepted as it is."""
BELOW, ABOVE = 3.0, 2.5
"""How far a first frequency may lie off the range of EN 1991-2 without a word.

Stress ribbons, arches and suspended spans lie up to three times below, portal frames and culverts
twice above."""
_FIGURE = 4.0, 100.0
"""Spans for which EN 1991-2 draws Figure 6.10, m. Its lines are carried on beyond them."""
_LOW_TORSION, _LOW_LATERAL, _FASTEST_TWIST = 0.2, 0.12, 4000.0
"""First torsional and lateral frequency over the vertical one; m/s.

Box girders twist at 2 to 5 times the vertical frequency, open sections at half of it and more. No
wave of twist is faster than the shear waves of steel, 3200 m/s. EN 1990, A2.4.4 asks for 1.2 Hz
laterally."""
_VALLEY = 4.0
"""Rayleigh's ratio at the first frequency over its least: (1 + k) / (2 sqrt(k)) if it is anchored
there and at k times that, 4 at k = 62."""


def table() -> list[str]:
    """Return the lines of a Markdown table of what is doubted, for the documents."""
    lines = ["| what | silent if | because of |", "|---|---|---|"]
    frequency = "first vertical frequency", f"up to {BELOW:g} times below or {ABOVE:g} times above"
    said = f"{frequency[1]} the range of Figure 6.10, by the longest span"
    lines.append(f"| {frequency[0]} | {said} | EN 1991-2, 6.4.4; arches, portal frames |")
    said = f"at least {_LOW_TORSION:g}, lateral {_LOW_LATERAL:g} of the vertical one"
    lines.append(f"| first torsional frequency | {said} | open sections; EN 1990, A2.4.4 |")
    lines += [f"| {b.what} | {b.range} | {b.source} |" for b in BOUNDS.values()]
    return lines


def doubt(name: str, field: str, value: float | None) -> list[InputWarning]:
    """Return the doubt about a value, none if it is usual or not given.

    Parameters
    ----------
    name : str
        A key of `BOUNDS`.
    field : str
        Its path in the caller's words.
    value : float or None
    """
    bound = BOUNDS[name]
    if value is None or bound.low <= abs(value) <= bound.high:
        return []
    unit = f" {bound.unit}" if bound.unit else ""
    text = f"= {value:g}{unit}, usual is {bound.range}: {bound.slip(value)}"
    return [InputWarning(field, text)]


def material(youngs_modulus: float, density: float) -> list[InputWarning]:
    """Return doubts about a material (Pa, kg/m3); a steel section may carry a smeared track."""
    steel = youngs_modulus > 1.5e11 and density > BOUNDS["density"].high
    found = doubt("youngs_modulus", "youngs_modulus", youngs_modulus)
    return found + doubt("density_of_steel" if steel else "density", "density", density)


def doubts(
    train: AnyTrain, deck: Deck, track: Track, settings: Settings
) -> tuple[InputWarning, ...]:
    """Return what is unlikely to be meant about the input of a crossing, a sentence each.

    Fields are named as the arguments of `cross` and what they hold: ``speed``, ``train.axles``.
    """
    of_deck, of_train = _of_deck(deck), _of_train(train)
    found = [*of_deck, *of_train, *_of_track(track), *_off_axis(train, deck, settings)]
    if len(train.placed_axles) > 1:  # a lone force is a case of theory, at any speed
        found += _speed(settings.speed)
    if not (of_train or _explained(deck, of_deck)):
        found += _live_sag(train, deck)
    return tuple(found)


def _speed(speed: float) -> list[InputWarning]:
    if speed <= BOUNDS["speed"].high:
        return []
    text = f"= {speed:g} m/s is {3.6 * speed:g} km/h: given in km/h?"
    return [InputWarning("speed", text)]


# ---- the deck


def first_frequencies(span: float) -> tuple[float, float]:
    """Return the range of first frequencies of simple spans (m), Hz: Figure 6.10 of EN 1991-2.

    n0 = 80 / L up to 20 m, 23.58 L^-0.592 beyond, to 94.76 L^-0.748; carried on beyond 4 to 100 m.
    """
    low, high = (80 / span if span <= 20 else 23.58 * span**-0.592), 94.76 * span**-0.748
    return min(low, high), max(low, high)


def frequency_off(frequency: float, span: float) -> float:
    """Return how many times a first frequency (Hz) lies off the range of its span (m).

    Above it positive, below it negative, 0 inside.
    """
    low, high = first_frequencies(span)
    return -low / frequency if frequency < low else frequency / high if frequency > high else 0.0


def first_vertical(sizes: np.ndarray) -> int | None:
    """Return the first mode (from 0) that moves mostly up and down, None if there is none.

    Parameters
    ----------
    sizes : ndarray, shape (m, 3)
        Integrals of v^2, w^2 and (1.5 m twist)^2 along the deck.
    """
    return next(iter(np.flatnonzero(np.argmax(sizes, axis=1) == 1).tolist()), None)


@dataclass(frozen=True)
class _Signs:
    """What tells a deck's scale.

    Attributes
    ----------
    span : float
        Longest, m.
    vertical, lateral, torsion : float or None
        First frequency of each, Hz.
    ratio : float or None
        Damping of the first vertical mode.
    """

    span: float
    vertical: float | None
    lateral: float | None
    torsion: float | None
    ratio: float | None


def _signs(deck: Deck) -> _Signs:
    edges = deck.shapes.edges
    x = np.unique((edges[:-1, None] + np.diff(edges)[:, None] * [0.0, 0.25, 0.5, 0.75]).ravel())
    values = deck.shapes(x)
    sizes = np.einsum("kmc,k,c->mc", values**2, np.gradient(x), [1.0, 1.0, 2.25])
    kinds, vertical = np.argmax(sizes, axis=1), first_vertical(sizes)
    lateral, _, torsion = (
        next(iter(deck.frequencies_hz[(kinds == c) & (sizes[:, c] > 0.0)].tolist()), None)
        for c in range(3)
    )
    if vertical is None or not sizes[vertical, 1] > 0.0:
        span = longest_span(deck.supports, deck.length, x, None)
        return _Signs(span, _from_sag(deck, span), lateral, torsion, None)
    span = longest_span(deck.supports, deck.length, x, values[:, vertical, 1])
    first = float(deck.frequencies_hz[vertical])
    return _Signs(span, first, lateral, torsion, float(deck.damping_ratios[vertical]))


def _from_sag(deck: Deck, span: float) -> float | None:
    """Return the first vertical frequency that the sag under self-weight tells, Hz.

    EN 1991-2, 6.4.4: 17.75 / sqrt(sag in mm). For decks whose vertical modes are not among those
    kept; None where no self-weight is known.
    """
    line = deck.recovery.section("displacement_z", _middle(deck, span))
    if line is None or not abs(line.self_weight) > 0.0:
        return None
    return 17.75 / float(np.sqrt(1e3 * abs(line.self_weight)))


def longest_span(
    supports: Sequence[float], length: float, x: np.ndarray, shape: np.ndarray | None
) -> float:
    """Return the longest span, m: between bearing lines, or where a vertical shape stands still.

    Parameters
    ----------
    supports : sequence of float
        Bearing lines, m; fewer than two if they are not known.
    length : float
        Of the deck, m.
    x : ndarray, shape (k,)
        m.
    shape : ndarray, shape (k,), or None
    """
    if len(supports) > 1:
        return float(np.max(np.diff(np.sort(supports))))
    if shape is None:
        return length
    size = np.abs(shape) / np.abs(shape).max()
    inner = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]) & (size[1:-1] < 0.15)
    still = [0.0, *x[1:-1][inner], length]
    return float(np.max(np.diff(still)))


def _places(deck: Deck) -> list[InputWarning]:
    """Return doubts about where things lie on a deck."""
    found = doubt("width", "deck.width", deck.width)
    found += doubt("track_height", "deck.track_height", deck.track_height)
    for name, y in deck.tracks.items():
        found += doubt("off_axis", f"deck.tracks.{name}", y)
    return found


def _accepted(deck: Deck) -> bool:
    """Whether whoever brought the deck said that it is unusual."""
    return any(remark.field == UNUSUAL[0] for remark in deck.remarks)


def _explained(deck: Deck, found: Sequence[InputWarning] = ()) -> bool:
    """Whether the stiffness or mass of a deck is doubted already: what follows from it is clear."""
    inputs = [*(r for r in deck.remarks if isinstance(r, InputWarning)), *found]
    beside = ("damping", "deck.damping", "deck.width", "deck.tracks")
    return _accepted(deck) or any(not r.field.startswith(beside) for r in inputs)


def _of_deck(deck: Deck) -> list[InputWarning]:
    found = _places(deck) + ([] if _explained(deck) else scale_in_doubt(deck))
    return found + _damping(deck, _signs(deck), bool(found) or _explained(deck))


def scale_in_doubt(deck: Deck) -> list[InputWarning]:
    """Return the doubt about a deck's size, mass and stiffness together: what explains the rest."""
    signs = _signs(deck)
    checks = (_size, _frequency, _exchanged, _sideways, _own_sag)
    return next((wrong for check in checks if (wrong := check(deck, signs))), [])


def _stiffness(deck: Deck) -> str:
    """Return what a deck's frequencies follow from, in words of who made it."""
    return "deck.frequencies_hz" if deck.recovery.lacks else "deck.bending_stiffness_vertical"


def _mass(deck: Deck) -> str:
    return "deck.mass_per_metre" if deck.recovery.lacks else "deck.mass"


def _size(deck: Deck, signs: _Signs) -> list[InputWarning]:
    field = "deck.spans" if len(deck.supports) > 2 else "deck.length"
    return doubt("span", field, signs.span) or doubt("mass", _mass(deck), deck.mass_per_metre)


def _frequency(deck: Deck, signs: _Signs) -> list[InputWarning]:
    if signs.vertical is None:
        return []
    field, mass = _stiffness(deck), deck.mass_per_metre
    off = frequency_off(signs.vertical, signs.span)
    drawn = _FIGURE[0] <= signs.span <= _FIGURE[1]
    if drawn and mass and mass > 5e4 and off < -1.5:
        low, high = first_frequencies(signs.span)
        if low <= signs.vertical * np.sqrt(G) <= high and 2e3 <= mass / G <= 4e4:
            text = f"= {mass:g} kg/m makes the first vertical frequency {signs.vertical:.3g} Hz"
            text += f", {_range(signs.span)}: a weight in N/m?"
            return [InputWarning(_mass(deck), text)]
    return frequency_in_doubt(field, signs.vertical, signs.span, bool(deck.recovery.lacks), mass)


def frequency_in_doubt(
    field: str, frequency: float, span: float, modes_only: bool, mass: float | None = None
) -> list[InputWarning]:
    """Return the doubt about a first vertical frequency (Hz) of a span (m), none if it is usual.

    Parameters
    ----------
    field : str
    frequency, span : float
    modes_only : bool
        Whether frequencies were given, not stiffness and mass.
    mass : float, optional
        kg/m.
    """
    off = frequency_off(frequency, span)
    if -BELOW <= off <= ABOVE:
        return []
    text = f"gives a first vertical frequency of {frequency:.3g} Hz, {_range(span)}: "
    return [InputWarning(field, text + _why(frequency, span, modes_only, mass))]


def _range(span: float) -> str:
    low, high = first_frequencies(span)
    return f"bridges of {span:.3g} m have about {low:.2g} to {high:.2g} Hz"


def _why(frequency: float, span: float, modes_only: bool, mass: float | None) -> str:
    """Return what was probably done wrong where a first frequency is off, as a question."""

    def fits(factor: float, length: float = 1.0) -> bool:
        low, high = first_frequencies(span * length)
        return low / 1.5 <= frequency * factor <= 1.5 * high

    if modes_only:
        slips = [
            (fits(1 / (2 * np.pi)), "given in rad/s"),
            (fits(1.0, 1e-3), "lengths given in mm"),
            (fits(1.0, 0.3048), "lengths given in feet"),
            (fits(1 / frequency * np.sqrt(frequency) / (2 * np.pi)), "squares of rad/s"),
            (fits(31.6), "E in kN/m2"),
            (fits(1e3), "E in MPa"),
            (fits(31.6e3), "E in GPa"),
        ]
    else:
        in_kilonewton = mass is not None and mass < 1e3
        slips = [
            (fits(31.6), "1000 times too soft, given in kN m2, or E in kN/m2"),
            (fits(1e3), "a million times too soft, given in MN m2, or E in MPa"),
            (fits(31.6e3), "a billion times too soft, E in GPa"),
            (in_kilonewton and fits(np.sqrt(G / 1e3)), "or is the mass a weight in kN/m"),
            (fits(1 / 31.6), "1000 times too stiff, or the mass 1000 times too small"),
            (fits(1e-3), "a million times too stiff, or second moments in another unit"),
            (fits(0.3048**-2, 0.3048), "spans given in feet"),
            (fits(np.sqrt(10)), "ten times too soft"),
            (fits(10.0), "a hundred times too soft"),
            (fits(np.sqrt(0.1)), "ten times too stiff"),
            (fits(0.1), "a hundred times too stiff"),
        ]
    likely = [words for fit, words in slips if fit]
    return (likely[0] if likely else "are stiffness, mass and lengths in SI units") + "?"


def _exchanged(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Vertical bending stiffer than bridges have it, lateral bending just like vertical."""
    if signs.vertical is None or signs.lateral is None:
        return []
    low, high = first_frequencies(signs.span)
    drawn = _FIGURE[0] <= signs.span <= _FIGURE[1]
    if not (drawn and signs.vertical > 1.3 * high and low <= signs.lateral <= high):
        return []
    text = f"gives a first vertical frequency of {signs.vertical:.3g} Hz and a lateral one of "
    text += f"{signs.lateral:.3g} Hz, {_range(signs.span)} vertically: "
    text += "vertical and lateral (I_y and I_z) exchanged?"
    return [InputWarning(_stiffness(deck), text)]


def _sideways(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Torsional and lateral frequency against the vertical one."""
    vertical, lateral, torsion = signs.vertical, signs.lateral, signs.torsion
    if vertical is None or deck.recovery.lacks:  # piers and local modes
        return []
    found = []
    for name, field, first, least in [
        ("torsional", "deck.torsional_stiffness", torsion, _LOW_TORSION * vertical),
        ("lateral", "deck.bending_stiffness_lateral", lateral, min(_LOW_LATERAL * vertical, 1.2)),
    ]:
        if first is not None and first < least:
            text = f"gives a first {name} frequency of {first:.3g} Hz, the vertical one is "
            text += f"{vertical:.3g} Hz: 1000 times too small, given in kN m2?"
            found.append(InputWarning(field, text))
    if torsion is not None and 2 * signs.span * torsion > _FASTEST_TWIST:
        text = f"gives a first torsional frequency of {torsion:.3g} Hz, faster than steel twists: "
        text += "torsional_stiffness too large, or polar_inertia given in t m?"
        found.append(InputWarning("deck.torsional_stiffness", text))
    return found


def _middle(deck: Deck, span: float) -> float:
    """Return the middle of the longest span, m."""
    ends = np.sort(deck.supports)
    if len(ends) < 2:
        return deck.length / 2
    i = int(np.argmax(np.diff(ends)))
    return float(ends[i] + ends[i + 1]) / 2


def _own_sag(deck: Deck, signs: _Signs) -> list[InputWarning]:
    line = deck.recovery.section("displacement_z", _middle(deck, signs.span))
    if line is None or not abs(line.self_weight) > BOUNDS["own_sag"].high * signs.span:
        return []
    text = f"lets the deck sag {abs(line.self_weight):.3g} m in {signs.span:.3g} m under its own "
    text += "weight: stiffness too small, or bearings too soft, given in kN?"
    return [InputWarning(_stiffness(deck), text)]


def _damping(deck: Deck, signs: _Signs, scale_doubted: bool) -> list[InputWarning]:
    """Doubt the ratio and, where the deck's frequencies are right, Rayleigh's two of damping."""
    if signs.ratio is None or any(r.field.startswith("damping") for r in deck.remarks):
        return []
    if signs.ratio <= BOUNDS["damping_ratio"].high:
        return [] if scale_doubted else _off_the_valley(deck, signs)
    if scale_doubted and not np.allclose(deck.damping_ratios, signs.ratio):
        return []  # Rayleigh's ratio follows from the frequency
    percent = 100 * signs.ratio
    text = f"= {signs.ratio:.3g} is {percent:.3g} % of critical in the first vertical mode: "
    text += f"given in per cent? {signs.ratio:.3g} % is {signs.ratio / 100:.3g}"
    return [InputWarning("deck.damping_ratios", text)]


def _off_the_valley(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Rayleigh damping whose two frequencies lie far above the deck's first."""
    omega, ratios = 2 * np.pi * deck.frequencies_hz, deck.damping_ratios
    columns = np.stack([0.5 / omega, 0.5 * omega], axis=1)
    (alpha, beta), *_ = np.linalg.lstsq(columns, ratios, rcond=None)
    rayleigh = np.allclose(columns @ [alpha, beta], ratios, rtol=1e-6, atol=0.0)
    if not (rayleigh and len(omega) > 1 and alpha > 0.0 and beta > 1e-9):
        return []
    first = 2 * np.pi * signs.vertical
    if first < np.sqrt(alpha / beta) and signs.ratio > _VALLEY * np.sqrt(alpha * beta):
        middle = np.sqrt(alpha / beta) / (2 * np.pi)
        text = f"is least at {middle:.3g} Hz, and {signs.ratio:.1%} at the first vertical "
        text += f"frequency, {signs.vertical:.3g} Hz: its two frequencies given in rad/s?"
        return [InputWarning("deck.damping", text)]
    return []


def damping_frequencies(field: str, given: Sequence[float], deck: Deck) -> list[InputWarning]:
    """Return the doubt about the two frequencies (Hz) of Rayleigh damping.

    For who knows them: a deck knows only what follows.
    """
    first, lowest = _signs(deck).vertical, min(given)
    if first is None or lowest <= _VALLEY * first or _explained(deck) or scale_in_doubt(deck):
        return []
    text = f"= {list(given)} Hz, the first vertical frequency is {first:.3g} Hz: given in rad/s?"
    return [InputWarning(field, text)]


def soft_bearing(field: str, direction: str, stiffness: float, weight: float) -> list[InputWarning]:
    """Return the doubt about the spring of a bearing.

    Parameters
    ----------
    field : str
    direction : str
        Freedom it holds: x, y, z, roll, pitch or yaw.
    stiffness : float
        N/m; a rotation's is not judged.
    weight : float
        The bearing's share of the deck's weight, N.
    """
    if direction in ("x", "y"):
        return doubt("bearing_shear", field, stiffness)
    if direction == "z" and weight / stiffness > BOUNDS["bearing_sag"].high:
        slips = [(1e3, "kN/m"), (1e6, "MN/m")]
        units = [unit for k, unit in slips if weight / stiffness / k < 0.02] or ["another unit"]
        text = f"= {stiffness:g} N/m gives {weight / stiffness:.3g} m under the deck's own weight: "
        return [InputWarning(field, f"{text}given in {units[0]}?")]
    return []


# ---- the train


def _of_train(train: AnyTrain) -> list[InputWarning]:
    if isinstance(train, AxleTrain):
        return _of_axles(train)
    found = [warning for vehicle, _ in train.kinds() for warning in _of_vehicle(vehicle)]
    if isinstance(train, Train):
        found += _of_spacing(train)
        for i, notch in enumerate(train.notches, start=1):
            found += _of_notch(f"train.notches[{i}]", notch)
    return found


def _worst(values: Sequence[float], name: str) -> float:
    """Return the value that lies farthest beyond its bounds, the first if none does."""
    bound, values = BOUNDS[name], np.asarray(values)
    return float(values[np.argmax(np.maximum(bound.low / values, values / bound.high))])


def _of_axles(train: AxleTrain) -> list[InputWarning]:
    found = doubt("axle_load", "train.loads", _worst(train.loads, "axle_load"))
    if len(train.axles) > 1:
        gaps = np.diff(train.axles)
        found += (
            doubt("axle_gap", "train.axles", float(gaps.min()))
            or doubt("axle_pause", "train.axles", float(gaps.max()))
        )  # fmt: skip
    return [_about(w, "neighbouring axles") if w.field == "train.axles" else w for w in found]


def _about(warning: InputWarning, what: str) -> InputWarning:
    """Return the doubt about one number of a list, with what it is."""
    return InputWarning(warning.field, f"({what}) {warning.text}")


def _of_vehicle(vehicle: Vehicle) -> list[InputWarning]:
    """Return doubts about a vehicle: the first of masses, suspension and places."""
    x = np.array([axle.x for axle in vehicle.axles])
    loads = [sum(vehicle.contacts[w].static_load for w in axle.wheels) for axle in vehicle.axles]
    load = _worst([max(load, 1e-9) for load in loads], "axle_load")
    gaps = np.abs(np.diff(np.sort(x)))
    light = [b for b in vehicle.bodies if b.mass < 100.0]
    weightless = doubt("axle_load", "", load)
    checks = [(f"mass of {b.name}", doubt("body_mass", "", b.mass)) for b in vehicle.bodies]
    if weightless and light and load < BOUNDS["axle_load"].low:
        slip = BOUNDS["body_mass"].slips[0][1]
        wrong = [InputWarning("", f"= {light[0].mass:g} kg, axles carry {load:.4g} N: {slip}?")]
        checks.insert(0, (f"mass of {light[0].name}", wrong))
    lowest = float(vehicle.modes().frequencies_hz[0])
    stiff = doubt("vehicle_frequency", "", lowest)
    text = f"= {lowest:.3g} Hz, cars have 0.4 Hz and more: springs given in kN/m?"
    checks += [
        ("axle load", weightless),
        ("lowest frequency", [InputWarning("", text)] if stiff else []),
        ("wheel base", doubt("car_length", "", float(np.ptp(x)))),
        ("axle distance", doubt("axle_gap", "", float(gaps.min())) if len(gaps) else []),
        ("length", doubt("car_length", "", vehicle.length)),
        ("wheels", doubt("off_axis", "", max(3.0 * abs(c.y) for c in vehicle.contacts))),
    ]
    for what, wrong in checks:
        if wrong:
            said = f"{vehicle.name}: {what} {wrong[0].text}"
            return [InputWarning("train.vehicle", said)]
    return []


def _of_spacing(train: Train) -> list[InputWarning]:
    spacing = train.car_spacing
    lengths = [v.length for v in train.vehicles if v.length]
    if spacing is None or len(train.vehicles) < 2 or not lengths:
        return []
    longest, axles = max(lengths), max(len(v.axles) for v in train.vehicles)
    text = f"= {spacing:g} m, cars are {longest:g} m long: "
    if spacing < longest - 0.5 and axles > 1:
        return [InputWarning("train.car_spacing", text + "is it shorter than the car?")]
    if spacing > longest + BOUNDS["car_length"].high:
        slips = ((10.0, "ten times too large"), (1e2, "given in cm"), (1e3, "given in mm"))
        likely = [words for k, words in slips if longest - 0.5 <= spacing / k <= 2 * longest]
        slip = likely[0] if likely else "is its decimal point right"
        return [InputWarning("train.car_spacing", f"{text}{slip}?")]
    return []


def _of_notch(field: str, notch: Notch) -> list[InputWarning]:
    return doubt("notch_depth", f"{field}.depth", notch.depth) or doubt(
        "circumference", f"{field}.circumference", notch.circumference
    )


def _off_axis(train: AnyTrain, deck: Deck, settings: Settings) -> list[InputWarning]:
    offset = float(settings.track_offset)
    if any(abs(y) == abs(offset) for y in deck.tracks.values()):
        return []  # the track itself is doubted
    return doubt("off_axis", "track_offset", offset)


def _live_sag(train: AnyTrain, deck: Deck) -> list[InputWarning]:
    """Compare the static displacement under the standing train with the span."""
    signs = _signs(deck)
    line = deck.recovery.section("displacement_z", _middle(deck, signs.span))
    if line is None:
        return []
    x = np.linspace(0.0, deck.length, 201)
    influence = line.influence(x)[:, 0, 1]
    axles = train.placed_axles
    delays = np.array([axle.delay for axle in axles])
    loads = np.array([sum(wheel.static_load for wheel in axle.wheels) for axle in axles])
    front = np.linspace(0.0, deck.length + train.length, 400)
    sag = np.abs(np.interp(front[:, None] - delays, x, influence, left=0.0, right=0.0) @ loads)
    share = float(sag.max()) / signs.span
    if share <= BOUNDS["live_sag"].high:
        return []
    text = f"lets the deck sag {sag.max():.3g} m in {signs.span:.3g} m under the standing train: "
    text += "stiffness too small, given in kN m2, or are the loads too large?"
    return [InputWarning(_stiffness(deck), text)]


# ---- the track


def _of_track(track: Track) -> list[InputWarning]:
    found = []
    for direction in ("vertical", "lateral"):
        for field, part in _parts(f"track.{direction}", getattr(track, direction)):
            found += _of_irregularity(field, part)
    return found


def _parts(field: str, given: object) -> Iterator[tuple[str, Irregularity]]:
    """Give every irregularity of a rail with its path."""
    if isinstance(given, Rails):
        for side in ("left", "right"):
            yield from _parts(f"{field}.{side}", getattr(given, side))
    elif isinstance(given, (list, tuple)):
        for i, part in enumerate(given, start=1):
            yield from _parts(f"{field}[{i}]", part)
    elif given is not None:
        yield field, given


def _of_irregularity(field: str, given: Irregularity) -> list[InputWarning]:
    if hasattr(given, "amplitude") and hasattr(given, "wavelength"):
        found = doubt("wavelength", f"{field}.wavelength", given.wavelength)
        if not found:
            steep = 2 * np.pi * given.amplitude / given.wavelength
            found = doubt("amplitude", f"{field}.amplitude", given.amplitude)
            if not found and steep > BOUNDS["slope"].high:
                text = f"= {given.amplitude:g} m in {given.wavelength:g} m makes slopes of "
                text += f"{steep:.2g}: {BOUNDS['amplitude'].slip(given.amplitude)}"
                found = [InputWarning(f"{field}.amplitude", text)]
        if abs(given.phase) > BOUNDS["phase"].high:
            turned = f"= {given.phase:g} rad is more than a turn: given in degrees?"
            found.append(InputWarning(f"{field}.phase", turned))
        return found
    if hasattr(given, "x") and hasattr(given, "r"):
        steep = float(np.max(np.abs(np.diff(given.r) / np.diff(given.x))))
        if steep > BOUNDS["slope"].high:
            text = f"reaches {np.abs(given.r).max():g} m with slopes of {steep:.2g}, "
            text += f"usual is {BOUNDS['slope'].range}: given in mm, or x in km?"
            return [InputWarning(f"{field}.r", text)]
    return []
