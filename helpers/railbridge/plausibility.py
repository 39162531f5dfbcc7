"""What can be computed, but is unlikely to be meant: slips of unit or decimal point.

A deck, a train, a track and a speed are held against `bounds`, each by itself and all together. One
slip gives one sentence: what follows from a value that is doubted already is not doubted again.

What only the maker of a deck knows (E, a density, the springs of its bearings) he holds against the
same bounds and leaves in `Deck.remarks`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .bounds import (
    ABOVE,
    BELOW,
    BOUNDS,
    SLOWEST_LATERAL,
    SLOWEST_TORSION,
    doubt,
    first_frequencies,
    frequency_off,
    usual_frequencies,
    worst,
)
from .decks import Deck
from .errors import InputWarning, counted
from .settings import Settings
from .tracks import Irregularity, Notch, Rails, Track
from .trains import AnyTrain, AxleTrain, Train
from .units import G
from .vehicles import Body, Vehicle

__all__ = [
    "UNUSUAL", "damping_constants", "damping_frequencies", "doubts", "first_vertical",
    "longest_span", "parts_of", "scale_in_doubt",
]  # fmt: skip

UNUSUAL = "modes.unusual", "= true: a first frequency beyond those of bridges is accepted."
"""Field and text of the remark on a deck whose scale is accepted as it is."""
_DRAWN = 4.0, 100.0
"""Spans for which EN 1991-2 draws its Figure 6.10, m."""
_STILL = 0.15
"""Share of its largest value below which a shape that turns round stands still."""
_FASTEST_TWIST = 4000.0
"""Twice the span times the first torsional frequency, m/s.

It is the speed of a wave of twist, for which steel allows 3200."""
_LATERAL = 1.2
"""First lateral frequency that is never doubted, Hz (EN 1990, A2.4.4)."""


def doubts(
    train: AnyTrain, deck: Deck, track: Track, settings: Settings
) -> tuple[InputWarning, ...]:
    """Return what is unlikely to be meant about the input of a crossing, a sentence each.

    Fields are named as the arguments of `cross` and what they hold: ``speed``, ``train.axles``.
    """
    signs = _signs(deck)
    scale = [] if _explained(deck) else _scale(deck, signs)
    of_train = _of_train(train)
    found = [*scale, *_damping(deck, signs, bool(scale)), *_places(deck), *of_train]
    found += _off_axis(deck, settings) + _of_track(track) + _on_one_rail(train, track)
    found += _speed(train, settings.speed)
    if not (scale or of_train or _explained(deck)):
        found += _live_sag(train, deck, signs.span)
    return tuple(found)


# ---- what a deck shows of its scale


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
    sizes = np.einsum("kmc,k,c->mc", values**2, np.gradient(x), [1.0, 1.0, 1.5**2])
    kinds, vertical = np.argmax(sizes, axis=1), first_vertical(sizes)
    lateral, torsion = (
        next(iter(deck.frequencies_hz[(kinds == c) & (sizes[:, c] > 0.0)].tolist()), None)
        for c in (0, 2)
    )
    if vertical is None:
        span = longest_span(deck.supports, deck.length, x, None)
        return _Signs(span, _from_sag(deck, span), lateral, torsion, None)
    span = longest_span(deck.supports, deck.length, x, values[:, vertical, 1])
    first, ratio = deck.frequencies_hz[vertical], deck.damping_ratios[vertical]
    return _Signs(span, float(first), lateral, torsion, float(ratio))


def first_vertical(sizes: np.ndarray) -> int | None:
    """Return the first mode (from 0) that moves mostly up and down, None if there is none.

    Parameters
    ----------
    sizes : ndarray, shape (m, 3)
        Integrals of v^2, w^2 and (1.5 m twist)^2 along the deck.
    """
    return next(iter(np.flatnonzero(np.argmax(sizes, axis=1) == 1).tolist()), None)


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
        Of the first vertical mode.
    """
    if len(supports) > 1:
        return float(np.max(np.diff(np.sort(supports))))
    if shape is None:
        return length
    size = np.abs(shape) / np.abs(shape).max()
    turns = (size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])
    still = x[1:-1][turns & (size[1:-1] < _STILL)]
    return float(np.max(np.diff([0.0, *still, length])))


def _from_sag(deck: Deck, span: float) -> float | None:
    """Return the first vertical frequency that the sag under self-weight tells, Hz.

    EN 1991-2, 6.4.4: 17.75 / sqrt(sag in mm). For decks whose vertical modes are not among those
    kept; None where no self-weight is known.
    """
    line = deck.recovery.section("displacement_z", _middle(deck, span))
    if line is None or not abs(line.self_weight) > 0.0:
        return None
    return 17.75 / float(np.sqrt(1e3 * abs(line.self_weight)))


def _middle(deck: Deck, span: float) -> float:
    """Return the middle of the longest span, m."""
    ends = np.sort(deck.supports)
    if len(ends) < 2:
        return span / 2
    i = int(np.argmax(np.diff(ends)))
    return float(ends[i] + ends[i + 1]) / 2


# ---- the deck


def _explained(deck: Deck) -> bool:
    """Whether a deck's scale is accepted, or its maker doubts what it follows from."""
    return any(
        remark.field == UNUSUAL[0]
        or (isinstance(remark, InputWarning) and not remark.field.startswith("damping"))
        for remark in deck.remarks
    )


def scale_in_doubt(deck: Deck) -> list[InputWarning]:
    """Return the doubt about a deck's size, mass and stiffness together."""
    return _scale(deck, _signs(deck))


def _scale(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Return the first doubt, which explains the rest."""
    for check in (_size, _frequency, _exchanged, _sideways):
        found = check(deck, signs)
        if found:
            return found
    return []


def _stiffness(deck: Deck) -> str:
    """Return what a deck's frequencies follow from, in words of who made it."""
    return "deck.frequencies_hz" if deck.recovery.lacks else "deck.bending_stiffness_vertical"


def _mass(deck: Deck) -> str:
    return "deck.mass_per_metre" if deck.recovery.lacks else "deck.mass"


def _size(deck: Deck, signs: _Signs) -> list[InputWarning]:
    field = "deck.spans" if len(deck.supports) > 2 else "deck.length"
    return doubt("span", field, signs.span) or doubt("mass", _mass(deck), deck.mass_per_metre)


def _frequency(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """The first vertical frequency against the longest span."""
    first, span, mass = signs.vertical, signs.span, deck.mass_per_metre
    if first is None:
        return []
    off = frequency_off(first, span)
    # A weight for a mass makes the frequency 3.1 times too low: with a large mass that is enough.
    if mass and mass > 5e4 and off < -1.5 and _DRAWN[0] <= span <= _DRAWN[1]:
        low, high = first_frequencies(span)
        if low <= first * np.sqrt(G) <= high and mass / G <= 4e4:
            text = f"= {mass:g} kg/m gives a first vertical frequency of {first:.3g} Hz, "
            return [InputWarning(_mass(deck), f"{text}{usual_frequencies(span)}: a weight in N/m?")]
    if -BELOW <= off <= ABOVE:
        return []
    text = f"gives a first vertical frequency of {first:.3g} Hz, {usual_frequencies(span)}: "
    fits = _fitting(first, span)
    if mass and mass < 1e3 and off > 0.0 and fits(np.sqrt(G / 1e3)):
        return [InputWarning(_mass(deck), f"= {mass:g} kg/m {text}a weight in kN/m?")]
    slips = _beam_slips(fits) if mass else _modal_slips(first, fits)
    likely = [words for fit, words in slips if fit]
    why = likely[0] if likely else "are stiffness, mass and lengths in SI units"
    return [InputWarning(_stiffness(deck), f"{text}{why}?")]


def _fitting(frequency: float, span: float) -> Callable[..., bool]:
    """Return what says whether a frequency would be usual, times a factor and on another span."""

    def fits(factor: float, length: float = 1.0) -> bool:
        low, high = first_frequencies(span * length)
        return low / 1.5 <= frequency * factor <= 1.5 * high

    return fits


def _modal_slips(frequency: float, fits: Callable[..., bool]) -> list[tuple[bool, str]]:
    """Return slips of who gave frequencies or a shell, and whether they explain the frequency."""
    root = np.sqrt(frequency) / (2 * np.pi * frequency)
    return [
        (fits(1 / (2 * np.pi)), "given in rad/s"),
        (fits(1.0, 1e-3), "lengths given in mm"),
        (fits(1.0, 0.3048), "lengths given in feet"),
        (fits(root), "squares of rad/s"),
    ]


def _beam_slips(fits: Callable[..., bool]) -> list[tuple[bool, str]]:
    """Return slips of who gave stiffness and mass, and whether they explain the frequency."""
    return [
        (fits(1e3**0.5), "1000 times too soft, given in kN m2, or E in kN/m2"),
        (fits(1e6**0.5), "a million times too soft, given in MN m2, or E in MPa"),
        (fits(1e9**0.5), "a billion times too soft, E in GPa"),
        (fits(1e3**-0.5), "1000 times too stiff"),
        (fits(1e6**-0.5), "a million times too stiff, given in N mm2"),
        (fits(0.3048**-2, 0.3048), "lengths given in feet"),
        (fits(100**0.5), "a hundred times too soft"),
        (fits(10**-0.5), "ten times too stiff"),
        (fits(100**-0.5), "a hundred times too stiff"),
    ]


def _exchanged(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Vertical bending stiffer than bridges have it, lateral bending just like vertical."""
    if signs.vertical is None or signs.lateral is None:
        return []
    low, high = first_frequencies(signs.span)
    drawn = _DRAWN[0] <= signs.span <= _DRAWN[1]
    if not (drawn and signs.vertical > 1.3 * high and low <= signs.lateral <= high):
        return []
    text = f"gives first frequencies of {signs.vertical:.3g} Hz vertically and "
    text += f"{signs.lateral:.3g} Hz laterally, {usual_frequencies(signs.span)} vertically: "
    return [InputWarning(_stiffness(deck), text + "are I_y and I_z exchanged?")]


def _sideways(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Torsional and lateral frequency of a beam against the vertical one."""
    vertical, lateral, torsion = signs.vertical, signs.lateral, signs.torsion
    if vertical is None or deck.recovery.lacks:  # there piers and local modes may be low
        return []
    found = []
    for name, field, first, least in [
        ("torsional", "deck.torsional_stiffness", torsion, SLOWEST_TORSION * vertical),
        (
            "lateral",
            "deck.bending_stiffness_lateral",
            lateral,
            min(SLOWEST_LATERAL * vertical, _LATERAL),
        ),
    ]:
        if first is not None and first < least:
            text = f"gives a first {name} frequency of {first:.3g} Hz, the vertical one is "
            text += f"{vertical:.3g} Hz: 1000 times too small, given in kN m2?"
            found.append(InputWarning(field, text))
    if torsion is not None and 2 * signs.span * torsion > _FASTEST_TWIST:
        text = f"gives a first torsional frequency of {torsion:.3g} Hz, faster than steel twists: "
        found.append(InputWarning("deck.torsional_stiffness", text + "1000 times too large?"))
    return found


def _damping(deck: Deck, signs: _Signs, scale_doubted: bool) -> list[InputWarning]:
    """Doubt the ratio and, where the frequencies are right, what Rayleigh's two were."""
    if signs.ratio is None or any(r.field.startswith("damping") for r in deck.remarks):
        return []
    scale_doubted = scale_doubted or _explained(deck)
    if BOUNDS["damping_ratio"].holds(signs.ratio):
        return [] if scale_doubted else _off_the_valley(deck, signs)
    if scale_doubted and not np.allclose(deck.damping_ratios, signs.ratio):
        return []  # it follows from the frequency
    text = f"= {signs.ratio:.3g} is {100 * signs.ratio:.3g} % of critical in the first vertical "
    text += f"mode: given in per cent? {signs.ratio:.3g} % is {signs.ratio / 100:.3g}"
    return [InputWarning("deck.damping_ratios", text)]


def _off_the_valley(deck: Deck, signs: _Signs) -> list[InputWarning]:
    """Rayleigh damping whose two frequencies lie far above the deck's first.

    Anchored at the first frequency and k times that, the ratio there is (1 + k) / (2 sqrt(k)) of
    the least: 4 at k = 62. Given in rad/s, it is pi sqrt(k): 4.4 at k = 2.
    """
    omega, ratios = 2 * np.pi * deck.frequencies_hz, deck.damping_ratios
    columns = np.stack([0.5 / omega, 0.5 * omega], axis=1)
    (alpha, beta), *_ = np.linalg.lstsq(columns, ratios, rcond=None)
    rayleigh = np.allclose(columns @ [alpha, beta], ratios, rtol=1e-6, atol=0.0)
    if not (rayleigh and len(omega) > 1 and alpha > 0.0 and beta > 1e-9):
        return []
    lowest = np.sqrt(alpha / beta) / (2 * np.pi)
    if signs.vertical >= lowest or signs.ratio <= 4.0 * np.sqrt(alpha * beta):
        return []
    text = f"is least at {lowest:.3g} Hz, the first vertical frequency is {signs.vertical:.3g} Hz: "
    return [InputWarning("deck.damping", text + "its two frequencies given in rad/s?")]


def damping_frequencies(field: str, given: Sequence[float], deck: Deck) -> list[InputWarning]:
    """Return the doubt about the two frequencies (Hz) of Rayleigh damping.

    For who knows them: a deck knows only the ratios.
    """
    signs = _signs(deck)
    if signs.vertical is None or BOUNDS["damping_frequency"].holds(min(given) / signs.vertical):
        return []
    if _explained(deck) or _scale(deck, signs):
        return []
    text = f"= {list(given)} Hz, the first vertical frequency is {signs.vertical:.3g} Hz: "
    return [InputWarning(field, text + "given in rad/s?")]


def damping_constants(field: str, alpha: float, beta: float, deck: Deck) -> list[InputWarning]:
    """Return the doubt about alpha (1/s) and beta (s) of Rayleigh damping, given as they are.

    Of the one that dampens the first vertical mode most.
    """
    signs, usual = _signs(deck), BOUNDS["damping_ratio"]
    if signs.vertical is None or usual.holds(signs.ratio):
        return []
    if _explained(deck) or _scale(deck, signs):
        return []

    def shares(first: float, second: float) -> tuple[float, float]:
        omega = 2 * np.pi * signs.vertical
        return first / (2 * omega), second * omega / 2

    of_mass, of_stiffness = shares(alpha, beta)
    stiff = of_stiffness > of_mass
    name, value = ("beta", f"{beta:g} s") if stiff else ("alpha", f"{alpha:g} 1/s")
    question = "is its decimal point right"
    if usual.holds(sum(shares(beta, alpha))):
        question = "are alpha and beta exchanged"
    elif stiff and usual.holds(of_mass + of_stiffness / 1e3):
        question = "given in ms"
    text = f"= {value} gives {100 * signs.ratio:.3g} % of critical in the first vertical mode, "
    text += f"{signs.vertical:.3g} Hz: {question}?"
    return [InputWarning(f"{field}.{name}", text)]


def _places(deck: Deck) -> list[InputWarning]:
    """Return doubts about where things lie on a deck."""
    found = doubt("width", "deck.width", deck.width)
    found += doubt("height", "deck.track_height", deck.track_height)
    for name, y in deck.tracks.items():
        found += doubt("off_axis", f"deck.tracks.{name}", y)
    if deck.rail is not None:
        found += doubt("sleepers", "deck.rail.spread", deck.rail.spread)
        found += doubt("rail_stiffness", "deck.rail.bending_stiffness", deck.rail.bending_stiffness)
        found += doubt("foundation", "deck.rail.foundation", deck.rail.foundation)
    return found


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


def _of_axles(train: AxleTrain) -> list[InputWarning]:
    found = doubt("axle_load", "train.loads", worst("axle_load", train.loads))
    gaps = np.diff(train.axles)
    if len(gaps):
        wrong = doubt("axle_gap", "train.axles", float(gaps.min()))
        wrong = wrong or doubt("axle_pause", "train.axles", float(gaps.max()))
        found += [InputWarning(w.field, f"stand apart by {w.text[2:]}") for w in wrong]
    return found


def _of_vehicle(vehicle: Vehicle) -> list[InputWarning]:
    """Return the first doubt about a vehicle's masses, suspension and places."""
    x = np.sort([axle.x for axle in vehicle.axles])
    base, gaps = float(x[-1] - x[0]), np.diff(x)
    load = sum(wheel.static_load for wheel in vehicle.contacts) / len(x)
    for body in vehicle.bodies:
        for wrong in _of_body(body, load):
            return [
                InputWarning(wrong.field, f"({vehicle.name}): mass of {body.name} {wrong.text}")
            ]
    light = min((body.mass for body in vehicle.wheelsets), default=None)
    checks = [
        ("mass of a wheelset", "wheelset_mass", light),
        ("weight over axles", "car_load", load or None),  # none without vertical freedoms
        ("smallest axle distance", "axle_gap", float(gaps.min()) if len(gaps) else None),
        ("largest axle distance", "axle_reach", float(gaps.max()) if len(gaps) else None),
        ("distance of wheels", "half_gauge", _half_gauge(vehicle)),
        *_of_wheelsets(vehicle),
        ("spring in series with a damper", "series_stiffness", _softest_in_series(vehicle)),
    ]
    for what, name, value in checks:
        for wrong in doubt(name, "train.vehicle", value):
            return [InputWarning(wrong.field, f"({vehicle.name}): {what} {wrong.text}")]
    lowest = float(vehicle.modes().frequencies_hz[0])
    if not BOUNDS["vehicle_frequency"].holds(lowest):
        text = f"({vehicle.name}): lowest frequency = {lowest:.3g} Hz, cars have 0.4 Hz and more: "
        return [InputWarning("train.vehicle", text + "springs given in kN/m?")]
    if vehicle.length and not BOUNDS["overhang"].holds(max(vehicle.length - base, 0.0)):
        text = f"({vehicle.name}): length = {vehicle.length:g} m, its wheel base is {base:g} m: "
        return [InputWarning("train.vehicle", text + "given in mm or cm?")]
    return []


def _half_gauge(vehicle: Vehicle) -> float | None:
    """Return what lies farthest beyond its bounds, m; None where all wheels stand at y = 0."""
    apart = [wheel.y for wheel in vehicle.contacts if wheel.y]
    return worst("half_gauge", apart) if apart else None


def _softest_in_series(vehicle: Vehicle) -> float | None:
    return min((k for spring in vehicle.springs for _, k, _ in spring.series), default=None)


def _of_wheelsets(vehicle: Vehicle) -> list[tuple[str, str, float]]:
    """Return what is held against `bounds` of wheelsets: words, name of the bound, value."""
    found = []
    for body in vehicle.wheelsets:
        own = [i for i, wheel in enumerate(vehicle.contacts) if wheel.body == body.name]
        k, c = vehicle.contact_stiffness[own, 1], vehicle.contact_damping[own, 1]
        for freedom, inertia in zip(("roll", "yaw"), body.inertia[::2], strict=True):
            if freedom in body.freedoms:
                words = f"radius of gyration of {body.name} in {freedom}"
                found.append((words, "wheelset_radius", float(np.sqrt(inertia / body.mass))))
        critical = 2 * np.sqrt(k.sum() * body.mass)
        found += [
            (f"height of {body.name}", "wheelset_height", body.position[2]),
            (f"contact of {body.name}", "contact_stiffness", worst("contact_stiffness", k)),
            (f"contact damping of {body.name}", "contact_damping", float(c.sum() / critical)),
        ]
    return found


def _of_body(body: Body, axle_load: float) -> list[InputWarning]:
    """Doubt a body's mass: by itself, or where the axles carry next to nothing (N)."""
    if 0.0 < axle_load < BOUNDS["axle_load"].low and 20.0 <= body.mass < 100.0:
        text = f"= {body.mass:g} kg, axles carry {axle_load:.3g} N: "
        return [InputWarning("train.vehicle", text + BOUNDS["body_mass"].slip(body.mass))]
    return doubt("body_mass", "train.vehicle", body.mass)


def _of_spacing(train: Train) -> list[InputWarning]:
    spacing = train.car_spacing
    lengths = [vehicle.length for vehicle in train.vehicles if vehicle.length]
    if spacing is None or len(train.vehicles) < 2 or not lengths:
        return []
    longest, axles = max(lengths), max(len(vehicle.axles) for vehicle in train.vehicles)
    text = f"= {spacing:g} m, cars are {longest:g} m long: "
    if spacing < longest - 0.5 and axles > 1:  # a mass on one spring has no length of its own
        return [InputWarning("train.car_spacing", text + "is it shorter than the car?")]
    if BOUNDS["overhang"].holds(max(spacing - longest, 0.0)):
        return []
    slips = ((10.0, "ten times too large"), (1e2, "given in cm"), (1e3, "given in mm"))
    likely = [words for k, words in slips if longest - 0.5 <= spacing / k <= 2 * longest]
    slip = likely[0] if likely else "is its decimal point right"
    return [InputWarning("train.car_spacing", f"{text}{slip}?")]


def _of_notch(field: str, notch: Notch) -> list[InputWarning]:
    found = doubt("notch_depth", f"{field}.depth", notch.depth)
    return found + doubt("circumference", f"{field}.circumference", notch.circumference)


def _off_axis(deck: Deck, settings: Settings) -> list[InputWarning]:
    offset = float(settings.track_offset)
    if offset in deck.tracks.values():  # the deck's own track is doubted
        return []
    return doubt("off_axis", "track_offset", offset)


def _speed(train: AnyTrain, speed: float) -> list[InputWarning]:
    # A lone force is a case of theory, at any speed.
    if BOUNDS["speed"].holds(speed) or len(train.placed_axles) < 2:
        return []
    return [InputWarning("speed", f"= {speed:g} m/s is {3.6 * speed:g} km/h: given in km/h?")]


def _live_sag(train: AnyTrain, deck: Deck, span: float) -> list[InputWarning]:
    """Compare the static displacement under the standing train with the span."""
    line = deck.recovery.section("displacement_z", _middle(deck, span))
    if line is None:
        return []
    x = np.linspace(0.0, deck.length, 201)
    influence = line.influence(x)[:, 0, 1]
    delays = np.array([axle.delay for axle in train.placed_axles])
    loads = [sum(wheel.static_load for wheel in axle.wheels) for axle in train.placed_axles]
    front = np.linspace(0.0, deck.length + train.length, 400)
    under = np.interp(front[:, None] - delays, x, influence, left=0.0, right=0.0)
    sag = float(np.abs(under @ loads).max())
    if BOUNDS["live_sag"].holds(sag / span):
        return []
    text = f"lets the deck sag {sag:.3g} m in {span:.3g} m under the standing train: too soft, or "
    return [InputWarning(_stiffness(deck), text + "are the loads too large?")]


# ---- the track


def _of_track(track: Track) -> list[InputWarning]:
    found = []
    for field, part in parts_of(track):
        if hasattr(part, "amplitude") and hasattr(part, "wavelength"):
            found += _of_wave(field, part)
        elif hasattr(part, "x") and hasattr(part, "r"):
            found += _of_table(field, part)
        elif hasattr(part, "amplitudes"):
            found += _of_sum(field.removesuffix(".left"), part) if ".right" not in field else []
    return found


def _on_one_rail(train: AnyTrain, track: Track) -> list[InputWarning]:
    """Doubt rails that differ below wheels at y = 0, which all stand on the left one."""
    found, apart_by = [], {"lateral": "gauge", "vertical": "cross-level"}
    for column, (direction, apart) in enumerate(apart_by.items()):
        if track.rail(direction, "left") == track.rail(direction, "right"):
            continue
        names = [
            vehicle.name
            for vehicle, _ in train.kinds()
            if all(wheel.y == 0.0 for wheel in vehicle.contacts)
            and vehicle.contact_stiffness[:, column].any()
        ]
        if names:
            text = f"has rails that differ, and all wheels of {counted(names, 4)} stand at y = 0, "
            text += f"on the left rail: {apart} moves them. Give both rails the same, or set "
            text += "rails_differ = false (RandomTrack: leave out cross_level and gauge)"
            found.append(InputWarning(f"track.{direction}", text))
    return found


def parts_of(track: Track) -> Iterator[tuple[str, Irregularity]]:
    """Give every irregularity of a track, as it was given, with its path."""
    for direction in ("vertical", "lateral"):
        yield from _parts(f"track.{direction}", getattr(track, direction))


def _parts(field: str, given: object) -> Iterator[tuple[str, Irregularity]]:
    """Give every irregularity of a direction with its path."""
    if isinstance(given, Rails):
        for side in ("left", "right"):
            yield from _parts(f"{field}.{side}", getattr(given, side))
    elif isinstance(given, (list, tuple)):
        for i, part in enumerate(given, start=1):
            yield from _parts(f"{field}[{i}]", part)
    elif given is not None:
        yield field, given


def _of_wave(field: str, wave: Irregularity) -> list[InputWarning]:
    found = doubt("wavelength", f"{field}.wavelength", wave.wavelength)
    found = found or doubt("amplitude", f"{field}.amplitude", wave.amplitude)
    steep = 2 * np.pi * wave.amplitude / wave.wavelength
    if not found and not BOUNDS["slope"].holds(steep):
        text = f"= {wave.amplitude:g} m in waves of {wave.wavelength:g} m makes slopes of "
        text += f"{steep:.2g}: {BOUNDS['amplitude'].slip(wave.amplitude)}"
        found = [InputWarning(f"{field}.amplitude", text)]
    if not BOUNDS["phase"].holds(wave.phase):
        text = f"= {wave.phase:g} rad is more than a turn: given in degrees?"
        found.append(InputWarning(f"{field}.phase", text))
    return found


def _of_sum(field: str, waves: Irregularity) -> list[InputWarning]:
    """Doubt a random rail whose standard deviation is larger than waves usually are."""
    sigma = float(np.sqrt(np.sum(np.abs(waves.amplitudes) ** 2) / 2))
    bound = BOUNDS["amplitude"]
    if bound.holds(sigma):
        return []
    text = f"is random with a standard deviation of {sigma:.3g} m, usual is {bound.range}"
    return [InputWarning(field, f"{text}: {bound.slip(sigma)}")]


def _of_table(field: str, measured: Irregularity) -> list[InputWarning]:
    steep = float(np.max(np.abs(np.diff(measured.r) / np.diff(measured.x))))
    if BOUNDS["slope"].holds(steep):
        return []
    text = f"reaches {np.abs(measured.r).max():g} m with slopes of {steep:.2g}, usual is "
    return [InputWarning(f"{field}.r", f"{text}{BOUNDS['slope'].range}: given in mm, or x in km?")]
