"""How a crossing is computed: every choice checked before anything runs, the rest filled in."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Annotated, Any, Literal

import numpy as np

from . import errors
from .cutoffs import counted, different, en1990_limit
from .decks import Deck
from .errors import InputError, Range, brief, check_fields
from .guideways import Guideway
from .tracks import Rails, Track, extent_of, period_of
from .trains import AnyTrain, AxleTrain, Car, Passage

__all__ = [
    "COARSE_SAMPLES_PER_CONTACT", "COARSE_SAMPLES_PER_PERIOD", "LEAD_IN_SECONDS", "MEMORY_LIMIT",
    "Options", "Settings", "accelerations_up_to", "bytes_needed", "check", "contact_frequency",
    "default_time_step", "highest_frequency", "refuse_bytes",
]  # fmt: skip

LEAD_IN_SECONDS = 7.5
SAMPLES_PER_LENGTH = 10
"""Fewest samples per wavelength or notch."""
SAMPLES_PER_DECK = 20
SAMPLES_PER_CONTACT, COARSE_SAMPLES_PER_CONTACT = 18, 8
"""Of a wheelset bouncing on its contacts, in a step that is chosen, and fewest without a remark.

Between samples the rail is a chord; a spring k above a mass m takes that for a force that is
(w h)^2 / 12 of the mass's inertia off, w^2 = k/m: 1 % and 5 % of what the wheelset adds.
"""
SAMPLES_PER_LANDING = 40
"""The same in a step that is chosen for contacts that may part.

A landing is over in a third of a period: its force is then within some 2 %, with 18 samples a sixth
of it may be missing.
"""
LEAST_SAMPLES_PER_CONTACT = 3
"""Of a vehicle's fastest motion on Hertzian contacts; fewer are refused."""
SAMPLES_PER_PERIOD = 8
"""Of the highest mode kept, in a step that is chosen: accelerations are then within 2 %."""
COARSE_SAMPLES_PER_PERIOD = 3
"""Of the highest mode kept; a step that leaves fewer spoils accelerations by 5 % and more."""
HEAVY = 0.2
"""Damping ratio from which on a mode follows its load more than it rings."""
FINEST_STEP = 1e-4
"""s, that the deck's modes ask for."""
STIFF_CONTACT = 60.0
"""Hz; a vehicle that swings faster has wheels on stiff contacts."""
SOFTEST_CONTACT = 1e8
"""N/m; what carries a wheel on a rail is stiffer, a suspension is ten times softer."""
STATIONS = 41
"""Places along the deck where envelopes are taken, ends included."""
MEMORY_LIMIT = 2e9
"""Bytes that a run, its summary and its histories may need together."""

_IN_METRES = "Give it in m/s: 72 km/h is 20"


@dataclass(frozen=True, kw_only=True)
class Options:
    """What can be chosen about a crossing, besides train, deck and track.

    Attributes
    ----------
    speed : float
        m/s; 72 km/h is 20.
    loads : {"wheels", "bogies", "condensed"}
        How the wheel forces act on the deck: as they are, as one force per bogie, or one per car
        (the paper).
    interaction : {"auto", "iterate", "rigid", "direct"}
        The fixed point; the deck under the forces of a rigid deck (iteration 0); or train and deck
        solved together at every step: the limit of the fixed point, without iterating. "auto" takes
        the direct solution where wheels stand on stiff contacts, which the fixed point meets slowly
        or not at all; and the fixed point elsewhere, or where `iterations` or `relaxation` are
        given.
    track_offset : float or str
        Track centre line, m left of the deck axis, or the name of a track of the deck.
    time_step : float, optional
        s; chosen if left out: at most 1 ms, a twentieth of the shortest wave or notch, an eighth of
        the period of the deck's highest mode, and an eighteenth of that of a wheelset with mass on
        its contacts (0.3 ms), a fortieth where contacts may part.
    lead_in : float, optional
        m of irregular track before the deck; default 7.5 s of travel. 0: level track before the
        deck, the train at rest; wrong where the track then starts on the deck with a step (a phase
        that is not zero), whose blow on the dampers is not counted. On harmonic track a run-up that
        leaves more than 1 % of the steady forces unsettled is warned about.
    tail : float
        s after the last axle has left, or has ceased to load the deck through a rail.
    tolerance : float
        How far the iteration may stop from its end; of what, says `tolerance_of`.
    tolerance_of : {"forces", "displacement"}
        The iteration stops when the wheel forces change by less than the tolerance twice in a row;
        or when a pass moves the deck by less than it, as a share of its largest motion, and all
        further passes would too, judged from how fast the changes fall. For whoever asks for
        displacements only: 1e-4 takes a fifth to a third of the passes, but tells little of wheel
        forces and accelerations.
    max_iterations : int
        Most passes over the whole record. What has not settled then, or grows before, is found in
        windows of time, each of which may take as many. With 9 or fewer allowed, or a relaxation
        given, it is an error instead, with what was computed so far.
    iterations : int, optional
        Exactly this many, converged or not (the paper did four).
    relaxation : float or "aitken", optional
        Share of each correction that is applied, or Aitken's adaptive share; for light decks and
        fast trains.
    contact : {"permanent", "hertz"}
        Wheels and rails hold together, by springs; or wheels with mass press on the rails as
        Hertz's theory has it, by a force that grows with the power 3/2 of the depth and is nothing
        where they part. The springs of the contacts are its tangents at the static loads. Sideways
        these springs stay, also on a wheel that has left the rail.
    excitation : {"wheels", "car"}
        Every wheel meets the track at its own place, or all wheels of a car in phase (a guess at
        the paper's reading).
    feedback : {"all", "vertical"}
        What the train feels of the deck: its whole motion, or only the vertical displacement,
        without twist (a guess at the paper's reading).
    acceleration_modes : {"all", "en1990"} or float
        Which modes count in the deck's accelerations, and in nothing else: all that the deck has;
        those up to the largest of 30 Hz, 1.5 times its first and its third different frequency (EN
        1990, A2.4.4); or those up to a frequency, Hz. The others are left out, nothing is filtered.
    """

    __repr__ = brief

    speed: Annotated[float, Range(above=0.0, most=200.0, unit="m/s", remedy=_IN_METRES)]
    loads: Literal["wheels", "bogies", "condensed"] = "wheels"
    interaction: Literal["auto", "iterate", "rigid", "direct"] = "auto"
    track_offset: float | str = 0.0
    time_step: Annotated[float, Range(above=0.0, unit="s")] | None = None
    lead_in: (
        Annotated[
            float,
            Range(least=0.0, most=1e5, unit="m", remedy="0 means level track before the deck"),
        ]
        | None
    ) = None
    tail: Annotated[float, Range(least=0.0, most=1e4, unit="s")] = 1.0
    tolerance: Annotated[float, Range(above=0.0, most=1.0)] = 1e-8
    tolerance_of: Literal["forces", "displacement"] = "forces"
    max_iterations: Annotated[int, Range(least=1, most=10_000, whole=True)] = 50
    iterations: Annotated[int, Range(least=1, most=10_000, whole=True)] | None = None
    relaxation: (
        Annotated[float, Range(above=0.0, most=1.0, remedy="Or use 'aitken'")]
        | Literal["aitken"]
        | None
    ) = None
    contact: Literal["permanent", "hertz"] = "permanent"
    excitation: Literal["wheels", "car"] = "wheels"
    feedback: Literal["all", "vertical"] = "all"
    acceleration_modes: (
        Annotated[float, Range(above=0.0, unit="Hz", remedy="Or use 'all' or 'en1990'")]
        | Literal["all", "en1990"]
    ) = "all"

    def __post_init__(self) -> None:
        check_fields(self)
        if self.contact == "hertz" and self.interaction not in ("auto", "direct"):
            allowed = "goes with linear contacts only, and Hertz's law is not linear"
            raise InputError("interaction", self.interaction, allowed, "Use 'direct' or 'auto'")
        for name in ("iterations", "relaxation"):
            if self.contact == "hertz" and getattr(self, name) is not None:
                allowed = "has no meaning with contact = 'hertz', which is solved without passes"
                raise InputError(name, getattr(self, name), allowed, "Leave it out")


@dataclass(frozen=True, kw_only=True)
class Settings(Options):
    """Options of one crossing with all that was left open filled in.

    Attributes
    ----------
    samples : int
        Samples in all, to the end of the tail.
    before : int
        How many of them are before t = 0, when the first axle enters: on a deck with a rail the
        train is felt before.
    auto : bool
        Whether the interaction was chosen, not given.
    accelerations_up_to_hz : float
        Up to which frequency modes count in the deck's accelerations; infinite for all.
    """

    __repr__ = brief

    samples: int
    before: int = 0
    auto: bool = False
    accelerations_up_to_hz: float = np.inf

    @property
    def passage(self) -> Passage:
        """How the train passes."""
        s = self
        return Passage(s.speed, s.time_step, s.samples, s.lead_in, s.excitation, s.before)

    def first_on_deck(self, car: Car, deck: Guideway) -> slice:
        """Return the samples from t = 0 until a car's last axle leaves the deck: those of Eq. 3."""
        reach = car.axles[-1].delay + deck.length
        stop = int(np.floor(reach / self.passage.advance + 1e-4)) + 1
        return slice(self.before, self.before + stop)


def check(train: AnyTrain, deck: Guideway, track: Track, **options) -> Settings:
    """Check the arguments of `cross` without computing anything, and fill in what is left open.

    Parameters
    ----------
    train, deck, track
    **options
        See `Options`.

    Raises
    ------
    InputError
        Naming the argument.
    """
    for name, value, kind in [
        ("train", train, AnyTrain), ("deck", deck, Guideway), ("track", track, Track),
    ]:  # fmt: skip
        if not isinstance(value, kind):
            title = name.title()
            raise InputError(name, value, f"must be a {title}", f"Make one with railbridge.{title}")
    errors.keys("", options, [f.name for f in fields(Options)], ["speed"])
    asked = Options(**options)
    if asked.loads != "wheels":
        train.formation[0].condensation(asked.loads)  # which may refuse
    if asked.excitation == "car":
        _ = [vehicle.front for vehicle, _ in train.kinds()]  # which each of them must have
    if asked.contact == "hertz":
        _refuse_other_contacts(train)
    _refuse_condensed(train, asked)
    step = _time_step(train, deck, track, asked)
    advance = asked.speed * step
    before, reach = int(np.ceil(deck.reach / advance)), deck.length + train.length + deck.reach
    chosen = {
        "interaction": _interaction(train, asked),
        "auto": asked.interaction == "auto",
        "time_step": step,
        "lead_in": _lead_in(asked, step),
        "track_offset": _track_offset(train, deck, asked.track_offset),
        "samples": int(np.ceil(reach / advance + asked.tail / step)) + 1 + before,
        "before": before,
        "accelerations_up_to_hz": accelerations_up_to(deck, asked.acceleration_modes),
    }
    settings = Settings(**(vars(asked) | chosen))
    _refuse_short_rails(train, deck, track, settings)
    _refuse_size(train, deck, track, asked, settings)
    return settings


def _interaction(train: AnyTrain, asked: Options) -> str:
    """Return how train and deck are brought together where that is left open."""
    if asked.interaction != "auto":
        return asked.interaction
    if asked.contact == "hertz":
        return "direct"
    of_passes = asked.iterations is not None or asked.relaxation is not None
    if of_passes or asked.tolerance_of != "forces":
        return "iterate"
    return "direct" if _stiff(train) else "iterate"


def accelerations_up_to(deck: Guideway, chosen: float | str) -> float:
    """Return up to which frequency (Hz) modes count in accelerations, infinite for all.

    Parameters
    ----------
    deck : Guideway
    chosen : float or {"all", "en1990"}
        See `Options`.

    Raises
    ------
    InputError
    """
    if chosen == "all" or not isinstance(deck, Deck):
        return np.inf
    known = deck.frequencies_hz
    if chosen != "en1990":
        if not counted(known, chosen).any():
            allowed = f"leaves no mode: the first has {known.min():.4g} Hz"
            raise InputError("acceleration_modes", chosen, allowed, "Give it in Hz, or use 'all'")
        return chosen
    limit = en1990_limit(known)
    if limit is None:
        allowed = "asks for the third frequency of the deck, and of its "
        allowed += f"{len(known)} modes only {len(different(known))} differ in frequency"
        remedy = "Make the deck with more modes, or give a frequency in Hz"
        raise InputError("acceleration_modes", chosen, allowed, remedy)
    return limit


def _stiff(train: AnyTrain) -> bool:
    """Whether wheels stand on stiff contacts."""
    return any(vehicle.highest_frequency > STIFF_CONTACT for vehicle, _ in train.kinds())


def _refuse_condensed(train: AnyTrain, asked: Options) -> None:
    """Refuse one force for a car whose wheels feel the deck stiffly somewhere else."""
    if asked.loads == "condensed" and asked.interaction != "rigid" and _stiff(train):
        allowed = (
            "with wheels on stiff contacts feeds energy into the deck, since a wheel loads it "
        )
        allowed += "elsewhere than where it feels it"
        remedy = "Use 'wheels' or 'bogies'"
        if asked.contact == "permanent":
            remedy += ", or interaction = 'rigid'"
        raise InputError("loads", asked.loads, allowed, remedy)


def _refuse_other_contacts(train: AnyTrain) -> None:
    """Refuse Hertzian contacts where wheels have no mass or carry nothing."""
    if not train.kinds():
        allowed = "bare axle loads have no contacts"
        raise InputError("contact", "hertz", allowed, "Leave contact out, or use vehicles")
    remedy = "Give the vehicle wheelsets (wheelset_mass, or [[wheelset]]), or leave contact out"
    for vehicle, _ in train.kinds():
        soft = vehicle.contact_stiffness[:, 1] < SOFTEST_CONTACT
        if soft.any():
            found = vehicle.contact_stiffness[:, 1].min()
            allowed = f"of {vehicle.name} the contacts are springs of {found:.3g} N/m, the "
            allowed += f"suspension; wheel on rail has {SOFTEST_CONTACT:g} N/m or more"
            raise InputError("contact", "hertz", allowed, remedy)
        for wheel in vehicle.contacts:
            if wheel.static_load <= 0.0:
                allowed = (
                    f"of {vehicle.name} the wheel at x = {wheel.x:g} m carries nothing at rest"
                )
                raise InputError("contact", "hertz", allowed, "Take the wheel out")


def _track_offset(train: AnyTrain, deck: Guideway, given: float | str) -> float:
    offset = deck.track_offset(given)
    for wheel in train.wheels:
        if deck.width is not None and abs(offset + wheel.y) > deck.width / 2 + 1e-9:
            where = f"wheel {wheel.number} of car {wheel.car} at y = {offset + wheel.y:g} m"
            allowed = f"{where} is off the deck, half width {deck.width / 2:g} m"
            remedy = "Move the track towards the axis, or correct the deck's width"
            raise InputError("track_offset", given, allowed, remedy)
    return offset


def _lead_in(asked: Options, step: float) -> float:
    """Return the run-up; refuse a fade-in (half of it) that the samples do not resolve.

    Its slope, met by chance, would be a blow.
    """
    least = 2 * SAMPLES_PER_LENGTH * asked.speed * step
    if asked.lead_in is None:
        return max(LEAD_IN_SECONDS * asked.speed, least)
    if 0.0 < asked.lead_in < least * (1 - 1e-9):
        few = f"leaves fewer than {SAMPLES_PER_LENGTH} samples for the fade-in; "
        few += f"must be 0 or at least {least:.3g} m"
        remedy = "Leave it out for 7.5 s of travel; 0 means level track before the deck"
        raise InputError("lead_in", asked.lead_in, few, remedy)
    return asked.lead_in


def _refuse_short_rails(train: AnyTrain, deck: Guideway, track: Track, s: Settings) -> None:
    """Refuse rails that are not known wherever wheels go, and such that would repeat below them."""
    if isinstance(train, AxleTrain):
        return  # whose forces no rail changes
    ahead = 0.0
    if s.excitation == "car":  # the rail is met at the car's front
        ahead = max(car.vehicle.front - car.wheels[0].x for car in train.formation)
    needed = -s.lead_in, (s.samples - s.before - 1) * s.passage.advance + max(ahead, 0.0)
    length = s.lead_in + deck.length + train.length + deck.reach
    for direction in ("vertical", "lateral"):
        apart = isinstance(getattr(track, direction), Rails)
        for side in ("left", "right"):
            field = f"track.{direction}" + f".{side}" * apart
            rail = track.rail(direction, side)
            (first, last), slack = extent_of(rail), 1e-9 * length
            if needed[0] < first - slack or needed[1] > last + slack:
                allowed = f"is known from x = {first:.6g} m to {last:.6g} m, and wheels need it "
                allowed += f"from {needed[0]:.6g} m to {needed[1]:.6g} m"
                allowed += " (run-up, deck, train and tail)"
                remedy = "Use a shorter lead_in or tail, a longer record, or another origin of it"
                raise InputError(field, None, allowed, remedy)
            period = period_of(rail)
            if length > period + slack:
                allowed = f"repeats after {period:.6g} m, less than run-up, deck and train, "
                allowed += f"{length:.6g} m"
                remedy = "Make it with a longer period, or use a shorter lead_in"
                raise InputError(field, None, allowed, remedy)


def _shortest(train: AnyTrain, track: Track) -> float:
    """Shortest length of irregularity, m, that the step has to resolve."""
    return min([track.shortest, *(notch.shortest for notch in train.notches)])


def _time_step(train: AnyTrain, deck: Guideway, track: Track, asked: Options) -> float:
    step, speed = asked.time_step, asked.speed
    if step is None:
        fine = SAMPLES_PER_PERIOD * highest_frequency(deck)
        most = max(1.0 / fine, FINEST_STEP) if fine > 0.0 else np.inf
        if asked.contact == "hertz":  # also under masses that are no wheelsets
            fastest = max(vehicle.highest_frequency for vehicle, _ in train.kinds())
            fine = SAMPLES_PER_LANDING * contact_frequency(train)
            most = min(most, 1.0 / max(fine, fastest * COARSE_SAMPLES_PER_CONTACT))
        return default_time_step(train, track, speed, min(most, 1e-3))
    for length, samples, what in [
        (_shortest(train, track), SAMPLES_PER_LENGTH, "of irregularity"),
        (deck.length, SAMPLES_PER_DECK, "of deck"),
    ]:
        if speed * step > length / samples * (1 + 1e-9):
            few = f"leaves fewer than {samples} samples in {length:g} m {what}; "
            few += f"at most {length / samples / speed:.3g} s"
            raise InputError("time_step", step, few, "Leave time_step out to have it chosen")
    if asked.contact == "hertz":
        _refuse_coarse_contact(train, step)
    return step


def _refuse_coarse_contact(train: AnyTrain, step: float) -> None:
    """Refuse a step in which a Hertzian contact would close under its own force.

    A mass m on a spring k, stepped by h under forces linear in between, answers the new one by
    1 - sin(w h) / (w h), w^2 = k/m: beyond half a period by more than all of it, and then a contact
    that carries nothing is a solution, too.
    """
    for vehicle, _ in train.kinds():
        frequency = vehicle.highest_frequency
        if step * frequency * LEAST_SAMPLES_PER_CONTACT > 1.0:
            most = 1.0 / frequency / LEAST_SAMPLES_PER_CONTACT
            few = f"leaves fewer than {LEAST_SAMPLES_PER_CONTACT} samples in a period of "
            few += f"{vehicle.name} on its Hertzian contacts, {frequency:.4g} Hz; at most "
            few += f"{most:.3g} s"
            raise InputError("time_step", step, few, "Leave time_step out to have it chosen")


def highest_frequency(deck: Guideway) -> float:
    """Return the highest frequency (Hz) with which a deck swings.

    Modes damped more than `HEAVY` hardly ring and ask for no finer step; nor does a deck whose
    modes are not known.
    """
    if not isinstance(deck, Deck):
        return 0.0
    return float(deck.frequencies_hz[deck.damping_ratios < HEAVY].max(initial=0.0))


def contact_frequency(train: AnyTrain) -> float:
    """Return the highest frequency (Hz) of a train's wheelsets on their contacts; 0 without any."""
    return max((vehicle.contact_frequency for vehicle, _ in train.kinds()), default=0.0)


def default_time_step(train: AnyTrain, track: Track, speed: float, most: float = 1e-3) -> float:
    """Return the time step used when none is given, s.

    At most 1 ms (or what is given for it), a twentieth of the shortest wave or notch and an
    eighteenth of the period of a wheelset on its contacts, and a whole fraction of the time between
    cars, so that all cars meet the samples alike and are computed together.
    """
    contact = SAMPLES_PER_CONTACT * contact_frequency(train)
    most = most if most * contact <= 1.0 else 1.0 / contact
    most = min(most, _shortest(train, track) / speed / (2 * SAMPLES_PER_LENGTH))
    if len(train.formation) == 1:
        return most
    between = (train.formation[1].centre - train.formation[0].centre) / speed
    return between / np.ceil(between / most)


def bytes_needed(train: AnyTrain, deck: Guideway, settings: Settings, points: int = 1) -> float:
    """Return about how much memory a run, its summary and its histories need, bytes."""
    s, advance, cars = settings, settings.passage.advance, train.formation
    wheels, samples = len(train.wheels), s.samples
    longest = max(car.axles[-1].delay - car.axles[0].delay for car in cars)
    on_deck = min((deck.length + 2 * deck.reach + longest) / advance + 3, samples)
    # Cars of one kind that meet the samples alike are run together, the others each by itself.
    runs = {
        (id(vehicle), round(car.axles[0].delay / advance % 1.0, 6))
        for vehicle, own in train.kinds()
        for car in own
    }
    passes = {"iterate": s.iterations or s.max_iterations, "direct": 1, "rigid": 0}[s.interaction]
    if isinstance(train, AxleTrain):
        passes = 0  # whose forces no deck changes
    record = s.lead_in / advance + samples
    kept = len(runs) * 2 * wheels / len(cars) * record
    working = 60.0 * record
    state = 10.0 * deck.coordinates * samples + passes * samples
    forces = 6.0 * wheels * samples + 20.0 * len(cars) * samples
    iterated = (passes + 8.0) * 2 * wheels * on_deck
    summary = (7.0 * STATIONS + 12.0 * points) * samples
    contacts = 0.0
    if s.contact == "hertz":
        # What the rail gives every car and what its contacts carry, on this deck and a rigid one.
        each = ((record - car.axles[0].delay / advance) * len(car.wheels) for car in cars)
        contacts = 6.0 * sum(each)
    return 8.0 * (kept + working + state + forces + iterated + summary + contacts) + 1.2e8


def refuse_bytes(
    field: str, value: Any, needed: float, what: str, remedy: str, source: str = ""
) -> None:
    """Refuse what would not fit into memory, before it is made: one limit for all doors.

    Parameters
    ----------
    field, value
        What is too large.
    needed : float
        Bytes.
    what : str
        What needs them; goes on "would need about ...".
    remedy, source
        See `InputError`.
    """
    if needed > MEMORY_LIMIT:
        allowed = f"{what} would need about {needed / 1e9:.3g} GB of memory, too much"
        allowed += f": the limit is {MEMORY_LIMIT / 1e9:.3g} GB"
        raise InputError(field, value, allowed, remedy, source)


def _refuse_size(
    train: AnyTrain, deck: Guideway, track: Track, asked: Options, settings: Settings
) -> None:
    """Refuse what would not fit into memory: a slip in the speed must not stop the machine."""
    needed = bytes_needed(train, deck, settings)
    if needed > MEMORY_LIMIT:
        field, value, _, words, remedy = max(
            _sizes(train, deck, track, asked, settings), key=lambda size: size[2]
        )
        refuse_bytes(field, value, needed, f"{words}this run", remedy)


def _sizes(
    train: AnyTrain, deck: Guideway, track: Track, asked: Options, settings: Settings
) -> list[tuple[str, Any, float, str, str]]:
    """Return what makes a run large.

    Field, value, how many times beyond what is usual, words that explain it, and what to try.
    """
    s, axles, cars = settings, len(train.placed_axles), len(train.formation)
    metres, passes = "Give lengths in m", s.iterations or s.max_iterations
    found = [
        ("speed", s.speed, 10.0 / s.speed, "", _IN_METRES),
        ("deck.length", deck.length, deck.length / 500.0, "", metres),
        ("lead_in", s.lead_in, s.lead_in / max(1000.0, LEAD_IN_SECONDS * s.speed), "", metres),
        ("tail", s.tail, s.tail / 10.0, "", "Give it in s"),
    ]
    if s.interaction == "iterate":
        field = "max_iterations" if s.iterations is None else "iterations"
        found.append((field, passes, passes / 50.0, "", "50 are enough where it converges"))
    if isinstance(train, AxleTrain):
        far = f"the last axle is {train.length:g} m behind the first; "
        found += [
            ("train.axles", None, train.length / 1000.0, far, metres),
            ("train.axles", None, axles / 100.0, f"{axles} axles; ", "Use a shorter train"),
        ]
    else:
        each = train.length / cars
        field, value, words = "train.car_spacing", train.car_spacing, ""
        if train.car_spacing is None or cars == 1:
            longest = max(train.vehicles, key=lambda vehicle: vehicle.axles[0].x)
            field, value = "train.vehicle", longest.name
            words = f"cars are {each:.4g} m apart or long; "
        found += [
            (field, value, each / 50.0, words, metres),
            ("train.cars", cars, axles / 100.0, "", "Use fewer cars or a larger time step"),
        ]
    if asked.time_step is not None:
        remedy = "Use a larger step or leave it out to have it chosen"
        found.append(("time_step", s.time_step, 1e-3 / s.time_step, "", remedy))
    else:
        field, words, remedy = _finest(train, track, asked)
        words += f" ask{'s' * (field == 'train.vehicle')} for steps of {s.time_step:.3g} s; "
        found.append((field, None, 1e-3 / s.time_step, words, remedy))
    return found


def _finest(train: AnyTrain, track: Track, asked: Options) -> tuple[str, str, str]:
    """Return what asks for the finest steps: field, words, remedy. Modes never ask for as fine."""
    notch = min([n.shortest for n in train.notches], default=np.inf)
    field, what = ("train", "notch") if notch < track.shortest else ("track", "irregularity")
    shortest = _shortest(train, track)
    found = [
        (
            shortest / asked.speed / (2 * SAMPLES_PER_LENGTH),
            field,
            f"{shortest:.3g} m of {what}",
            "Give lengths in m",
        )
    ]
    for vehicle, _ in train.kinds():
        parts = asked.contact == "hertz"
        asking = [
            (vehicle.contact_frequency, SAMPLES_PER_LANDING if parts else SAMPLES_PER_CONTACT),
            (parts * vehicle.highest_frequency, COARSE_SAMPLES_PER_CONTACT),
        ]
        for frequency, samples in asking:
            if frequency:
                words = f"{vehicle.name} on its contacts, {frequency:.3g} Hz,"
                remedy = "Correct masses and inertias of wheelsets (kg, kg m2) and contacts (N/m)"
                found.append((1.0 / frequency / samples, "train.vehicle", words, remedy))
    return min(found)[1:]
