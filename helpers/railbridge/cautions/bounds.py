"""What numbers usually are: one table of bounds, with sources and the slips that people make.

Nothing is refused here: unusual cases compute. Bounds are wide enough that real bridges and trains,
foot bridges, culverts and long spans pass without a word; what lies beyond is doubted in one
sentence, with the likely slip found from the factor by which the value is off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputWarning
from ..units import G

__all__ = [
    "ABOVE", "BELOW", "BOUNDS", "SLOWEST_LATERAL", "SLOWEST_TORSION", "Bound", "doubt",
    "first_frequencies", "frequency_off", "material", "soft_bearing", "table", "usual_frequencies",
    "worst",
]  # fmt: skip


@dataclass(frozen=True)
class Bound:
    """What a quantity usually is, and which slips are known.

    Attributes
    ----------
    what : str
        The quantity, for people.
    low, high : float
        Beyond these its magnitude is doubted.
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

    def holds(self, value: float) -> bool:
        """Whether a value is usual."""
        return self.low <= abs(value) <= self.high

    @property
    def range(self) -> str:
        """The bounds in words."""
        if self.low > 0.0 and self.high < np.inf:
            words = f"{self.low:g} to {self.high:g}"
        else:
            words = f"at least {self.low:g}" if self.low > 0.0 else f"at most {self.high:.3g}"
        return f"{words} {self.unit}".rstrip()

    def slip(self, value: float) -> str:
        """Return in words what was probably done wrong, as a question."""
        low, high = self.usual or (self.low, self.high)
        likely = [words for factor, words in self.slips if low <= abs(value) * factor <= high]
        question = " or ".join(likely[:2])
        if question.startswith("given in"):
            question = question.replace(" or given in ", " or ")
        return (question or "is its decimal point right") + "?"


_IN_M = (1e-3, "given in mm"), (1e-2, "given in cm")
_WEIGHT = 1 / G

BOUNDS = {
    "youngs_modulus": Bound(
        "E", 1e9, 4e11, "Pa", "timber 7e9 (EN 338) to steel 2.1e11 (EN 1993-1-1)",
        ((1e6, "given in MPa"), (1e9, "given in GPa"), (1e3, "given in kN/m2")), (4e9, 2.3e11),
    ),
    "density": Bound(
        "density", 300.0, 2e4, "kg/m3",
        "timber 350 (EN 338) to steel 7850 (EN 1991-1-1), with room for a track spread over it",
        ((1e3, "given in t/m3"), (1e3 * _WEIGHT, "a weight in kN/m3"),
         (_WEIGHT, "a weight in N/m3"), (1e-3, "given in g/m3")), (400.0, 9e3),
    ),
    "steel_density": Bound(
        "density of steel", 300.0, 7.5e4, "kg/m3",
        "7850 (EN 1991-1-1), more where slab and ballast are spread over a small section",
        ((_WEIGHT, "a weight in N/m3"), (1e-3, "given in g/m3")), (5e3, 9e3),
    ),
    "area": Bound(
        "area of a section", 5e-3, 200.0, "m2", "a rolled beam to 40 m of slab",
        ((1e-4, "given in cm2"), (1e-6, "given in mm2")), (5e-3, 60.0),
    ),
    "second_moment": Bound(
        "second moment of area", 1e-6, 1e4, "m4",
        "a rolled beam 1e-5, box girders of 300 m spans some 1e3",
        ((1e-8, "given in cm4"), (1e-12, "given in mm4"), (1e-4, "given in dm4")), (1e-5, 3e3),
    ),
    "polar_radius": Bound(
        "radius of gyration in twist or sideways", 0.15, 20.0, "m", "decks 0.5 to 60 m wide"
    ),
    "bending_radius": Bound(
        "radius of gyration in vertical bending", 0.01, 20.0, "m",
        "slabs of 0.1 m to trusses of 40 m; of E I / E A at most a sixth of the span",
    ),
    "shear_share": Bound(
        "E I / (kGA L2), what shear adds to bending", 0.0, 0.5, "",
        "girders 0.01 to 0.05, trusses 0.2",
    ),
    "span": Bound(
        "longest span", 1.0, 2000.0, "m", "culverts to the longest suspended spans",
        (*_IN_M, (1e3, "given in km")), (2.0, 400.0),
    ),
    "mass": Bound(
        "mass per metre", 100.0, 3e5, "kg/m",
        "foot bridges to ballasted concrete with several tracks",
        ((1e3, "given in t/m"), (1e-3, "given in g/m"), (1e3 * _WEIGHT, "a weight in kN/m"),
         (_WEIGHT, "a weight in N/m")), (1e3, 6e4),
    ),
    "track_mass": Bound(
        "mass of tracks or edges, if any", 20.0, np.inf, "kg/m", "two rails 120",
        ((1e3, "given in t/m"),), (100.0, 2e4),
    ),
    "width": Bound(
        "width of a deck", 1.0, 80.0, "m", "one narrow track to twelve", _IN_M, (3.0, 40.0)
    ),
    "height": Bound(
        "rails, centroid or a bearing from the deck axis", 0.0, 15.0, "m", "the deepest girders",
        _IN_M, (0.1, 5.0),
    ),
    "bearing_shear": Bound(
        "spring of a bearing along or across", 2e4, np.inf, "N/m",
        "elastomers (EN 1337-3) and tall piers some 1e6",
        ((1e3, "given in kN/m"), (1e6, "given in MN/m")), (5e5, 1e11),
    ),
    "bearing_sag": Bound(
        "a bearing's share of the deck's weight over its vertical spring", 0.0, 0.1, "m",
        "elastomers (EN 1337-3) give way by millimetres",
    ),
    "pier_height": Bound(
        "height of a pier", 0.5, 350.0, "m", "abutments to the tallest viaducts", _IN_M,
        (2.0, 200.0),
    ),
    "pier_radius": Bound(
        "radius of gyration of a pier", 0.05, 10.0, "m", "columns of 0.2 m to walls of 30 m"
    ),
    "point_mass": Bound(
        "a mass at a single place over the deck's own", 0.0, 1.0, "",
        "diaphragms, gantries and machines weigh less than the deck",
    ),
    "sleepers": Bound("distance of sleepers", 0.3, 1.5, "m", "0.6 on most lines"),
    "rail_stiffness": Bound(
        "bending stiffness of both rails", 1e6, 5e7, "N m2", "49E1 7.6e6, UIC 60 1.28e7",
        ((1e3, "given in kN m2"), (1e6, "given in MN m2")), (3e6, 3e7),
    ),
    "foundation": Bound(
        "stiffness of the bed below both rails", 5e6, 2e9, "N/m2",
        "soft pads 2e7, ballast 5e7 to 3e8, hard pads on concrete some 5e8",
        ((1e3, "given in kN/m2"), (1e6, "given in MN/m2")), (2e7, 8e8),
    ),
    "damping_ratio": Bound(
        "damping ratio of the first vertical mode", 0.0, 0.2, "",
        "EN 1991-2, Table 6.6: 0.005 to 0.03; foot bridges with dampers 0.1",
    ),
    "damping_frequency": Bound(
        "lower frequency of Rayleigh damping over the first vertical one", 0.0, 4.0, "",
        "rad/s for Hz makes it 6.3",
    ),
    "axle_load": Bound(
        "load of a bare axle", 27e3, 1e6, "N",
        "empty trams to axles of 40 t; 1e6 where one force stands for a car",
        ((1e3, "given in kN"), (1e3 * G, "given in t"), (G, "given in kg"),
         (0.1, "ten times too large")), (4e4, 4e5),
    ),
    "axle_gap": Bound(
        "smallest distance of neighbouring axles", 0.3, 40.0, "m",
        "wheels of 0.7 m; 30 m where one force stands for a car",
        (*_IN_M, (1e2, "a hundred times too small"), (1e3, "given in km")), (1.0, 30.0),
    ),
    "axle_reach": Bound(
        "largest distance of neighbouring axles in a car", 0.0, 50.0, "m", "the longest coaches",
        _IN_M, (5.0, 50.0),
    ),
    "axle_pause": Bound(
        "largest distance of neighbouring bare axles", 0.0, 400.0, "m",
        "two trains behind each other", _IN_M, (1.0, 50.0),
    ),
    "overhang": Bound(
        "length of a car beyond its wheel base, its spacing beyond its length", 0.0, 60.0, "m",
        "the longest coaches 27 m in all",
    ),
    "body_mass": Bound(
        "mass of a vehicle's body", 20.0, 5e5, "kg", "seats to the heaviest wagons",
        ((1e3, "given in t, or its thousands mark read as a decimal point"), (1e-3, "given in g")),
        (500.0, 1.2e5),
    ),
    "wheelset_mass": Bound(
        "mass of a wheelset", 250.0, 1e4, "kg", "light trams to driven axles with their motors",
        ((10.0, "ten times too light"), (0.1, "ten times too heavy")), (600.0, 3e3),
    ),
    "wheelset_radius": Bound(
        "radius of gyration of a wheelset in roll or yaw", 0.15, 1.5, "m",
        "wheels 0.19 m (narrowest gauge) to 0.84 m from the middle",
        ((1e1**1.5, "its inertia given in t m2"), (1e-3, "its inertia given in kg mm2")),
        (0.3, 1.1),
    ),
    "wheelset_height": Bound(
        "centre of a wheelset above the rail", 0.0, 1.2, "m",
        "wheels of 0.17 to 0.7 m, and springs placed at rail level", _IN_M, (0.15, 0.75),
    ),
    "contact_stiffness": Bound(
        "contact of a wheel with mass on the rail", 1e8, 2e10, "N/m",
        "steel on steel 1e9 to 2e9 a wheel (Hertz)",
        ((1e3, "given in N/mm or kN/m"), (1e6, "given in kN/mm")), (5e8, 6e9),
    ),
    "contact_damping": Bound(
        "damping of a wheelset bouncing on its contacts, share of critical", 0.0, 1.0, "",
        "it rings on the rail; 100 kN s/m a wheel are 0.05",
        ((1e-3, "a thousand times too large"),),
    ),
    "series_stiffness": Bound(
        "spring in series with a damper", 2e4, np.inf, "N/m", "rubber and mountings some 1e6",
        ((1e3, "given in kN/m or N/mm"), (1e6, "given in kN/mm")), (5e5, 1e9),
    ),
    "car_load": Bound(
        "weight of a car over its axles", 5e3, 1e6, "N",
        "a light trolley to axles of 40 t; 1e6 where one wheel stands for a car",
        ((1e3, "masses given in t"), (1e-3, "masses given in g")), (2e4, 4e5),
    ),
    "vehicle_frequency": Bound(
        "lowest frequency of a vehicle", 0.1, np.inf, "Hz", "cars sway at 0.4 Hz and more"
    ),
    "half_gauge": Bound(
        "wheels from the middle of their car, where they stand apart", 0.15, 2.0, "m",
        "a gauge of 0.38 m has 0.19, broad gauge 0.84",
        (*_IN_M, (0.1, "ten times too far")), (0.3, 1.2),
    ),
    "off_axis": Bound(
        "tracks from the deck axis", 0.0, 15.0, "m", "the outer of seven",
        (*_IN_M, (0.1, "ten times too far")), (0.5, 10.0),
    ),
    "speed": Bound(
        "speed of more than one axle", 0.0, 117.0, "m/s",
        "1.2 times 350 km/h, the fastest lines (EN 1991-2, 6.4.6)",
    ),
    "live_sag": Bound(
        "static displacement under the train over the longest span", 0.0, 0.01, "",
        "EN 1990, A2.4.4: 1/600 under heavier loads",
    ),
    "amplitude": Bound(
        "amplitude of a wave", 0.0, 0.1, "m", "0.03 m closes a line; more only in long waves",
        _IN_M, (2e-5, 0.05),
    ),
    "wavelength": Bound(
        "wavelength", 0.02, 1000.0, "m", "corrugation of 0.03 m to waves of 150 m (EN 13848)",
        (*_IN_M, (1e3, "given in km")), (0.02, 200.0),
    ),
    "slope": Bound("slope of the track", 0.0, 0.1, "", "dipped joints 0.02, corrugation 0.01"),
    "phase": Bound("phase of a wave", 0.0, 2 * np.pi + 1e-6, "rad", "one turn"),
    "notch_depth": Bound(
        "depth of a notch", 0.0, 0.01, "m", "flat spots of 1 mm are bad, 3 mm stop a train",
        _IN_M, (1e-5, 0.005),
    ),
    "circumference": Bound(
        "circumference of a wheel", 0.9, 5.0, "m", "diameters of 0.33 to 1.4 m", _IN_M
    ),
}  # fmt: skip
"""What numbers are held against, by names for the code."""

BELOW, ABOVE = 3.0, 2.5
"""How far a first vertical frequency may lie off its range without a word.

Stress ribbons, arches and suspended spans lie up to three times below, portal frames and culverts
twice above."""
SLOWEST_TORSION, SLOWEST_LATERAL = 0.2, 0.12
"""Least first torsional and lateral frequency of a beam over the vertical one.

Boxes twist at two to five times the vertical frequency, open sections at half of it and more.
Laterally EN 1990, A2.4.4 asks for 1.2 Hz, which is never doubted."""


def table() -> list[str]:
    """Return the lines of a Markdown table of what is doubted, for the documents."""
    rows = [
        (
            "first vertical frequency",
            f"up to {BELOW:g} times below and {ABOVE:g} times above Figure 6.10, longest span",
            "EN 1991-2, 6.4.4; arches are slower, portal frames faster",
        ),
        (
            "first torsional and lateral frequency of a beam, over the vertical one",
            f"at least {SLOWEST_TORSION:g} and {SLOWEST_LATERAL:g}",
            "open sections; EN 1990, A2.4.4: 1.2 Hz laterally",
        ),
        *((bound.what, bound.range, bound.source) for bound in BOUNDS.values()),
    ]
    lines = ["| what | passes | because |", "|---|---|---|"]
    return lines + [f"| {' | '.join(row)} |" for row in rows]


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
    if value is None or bound.holds(value):
        return []
    unit = f" {bound.unit}" if bound.unit else ""
    text = f"= {value:g}{unit}, usual is {bound.range}: {bound.slip(value)}"
    return [InputWarning(field, text)]


def worst(name: str, values: Sequence[float]) -> float:
    """Return the value that lies farthest beyond its bounds, or nearest to them."""
    bound, sizes = BOUNDS[name], np.maximum(np.abs(values), 1e-30)
    return float(np.asarray(values)[np.argmax(np.maximum(bound.low / sizes, sizes / bound.high))])


def material(youngs_modulus: float, density: float) -> list[InputWarning]:
    """Return doubts about a material (Pa, kg/m3); a steel section may carry a smeared track."""
    steel = youngs_modulus > 1.5e11 and density > BOUNDS["density"].high
    found = doubt("youngs_modulus", "youngs_modulus", youngs_modulus)
    return found + doubt("steel_density" if steel else "density", "density", density)


def soft_bearing(field: str, direction: str, stiffness: float, weight: float) -> list[InputWarning]:
    """Return the doubt about the spring of a bearing.

    Parameters
    ----------
    field : str
    direction : str
        What it holds: x, y, z, roll, pitch or yaw.
    stiffness : float
        N/m; that of a rotation is not judged.
    weight : float
        The bearing's share of the deck's weight, N.
    """
    if direction in ("x", "y"):
        return doubt("bearing_shear", field, stiffness)
    sag = weight / stiffness
    if direction != "z" or BOUNDS["bearing_sag"].holds(sag):
        return []
    likely = [unit for factor, unit in ((1e3, "kN/m"), (1e6, "MN/m")) if sag / factor < 0.02]
    text = f"= {stiffness:g} N/m gives way by {sag:.3g} m under the deck's own weight: "
    return [InputWarning(field, f"{text}given in {likely[0] if likely else 'another unit'}?")]


# ---- first frequencies


def first_frequencies(span: float) -> tuple[float, float]:
    """Return the range of first frequencies of simple spans (m), Hz: Figure 6.10 of EN 1991-2.

    n0 = 80 / L up to 20 m, 23.58 L^-0.592 beyond, to 94.76 L^-0.748; drawn from 4 to 100 m, carried
    on beyond.
    """
    low, high = (80 / span if span <= 20 else 23.58 * span**-0.592), 94.76 * span**-0.748
    return min(low, high), max(low, high)


def usual_frequencies(span: float) -> str:
    """Return the range of first frequencies of a span (m) in words."""
    low, high = first_frequencies(span)
    return f"bridges of {span:.3g} m have about {low:.2g} to {high:.2g} Hz"


def frequency_off(frequency: float, span: float) -> float:
    """Return how many times a first frequency (Hz) lies off the range of its span (m).

    Above it positive, below it negative, 0 inside.
    """
    low, high = first_frequencies(span)
    return -low / frequency if frequency < low else frequency / high if frequency > high else 0.0
