"""How a crossing is computed: every choice checked before anything runs, and what was left open filled in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import errors
from .decks import Deck
from .errors import InputError
from .tracks import Track
from .trains import LOADS, AxleTrain, Train

__all__ = ["Settings", "check", "default_time_step"]

LEAD_IN_SECONDS = 7.5
SAMPLES_PER_LENGTH = 10
"""Fewest samples per wavelength or notch."""
LARGEST = 3e8
"""Most numbers held at a time: 2.4 GB."""


@dataclass(frozen=True)
class Settings:
    """How a crossing is computed; see `cross`."""

    speed: float
    time_step: float
    lead_in: float
    tail: float
    track_offset: float
    loads: str
    interaction: str
    tolerance: float
    max_iterations: int
    iterations: int | None
    relaxation: float | str | None
    excitation: str
    feedback: str


def check(
    train: Train | AxleTrain,
    deck: Deck,
    track: Track,
    *,
    speed: float,
    loads: str = "wheels",
    interaction: str = "iterate",
    track_offset: float | str = 0.0,
    time_step: float | None = None,
    lead_in: float | None = None,
    tail: float = 1.0,
    tolerance: float = 1e-8,
    max_iterations: int = 50,
    iterations: int | None = None,
    relaxation: float | str | None = None,
    excitation: str = "wheels",
    feedback: str = "all",
) -> Settings:
    """Check the arguments of `cross` without computing anything, and fill in what was left to be chosen.

    Raises
    ------
    InputError
        Naming the argument as a case names it, for instance ``run.speed``.
    """
    for name, value, kinds in [("train", train, (Train, AxleTrain)), ("deck", deck, Deck), ("track", track, Track)]:
        if not isinstance(value, kinds):
            raise InputError(name, value, f"must be a {name.title()}", f"Make one with railbridge.{name.title()}")
    speed = errors.number("run.speed", speed, above=0.0, most=200.0, unit="m/s", remedy="Give it in m/s: 72 km/h is 20")
    errors.choice("run.loads", loads, LOADS)
    errors.choice("run.interaction", interaction, ("iterate", "rigid", "direct"))
    errors.choice("run.excitation", excitation, ("wheels", "car"))
    errors.choice("run.feedback", feedback, ("all", "vertical"))
    for name, value, needed in [("loads", loads, "wheels"), ("feedback", feedback, "all")]:
        if interaction == "direct" and value != needed:
            allowed = f"the direct solution couples true wheels and the whole motion, so it must be '{needed}'"
            raise InputError(f"run.{name}", value, allowed, "Or use run.interaction = 'iterate'")
    train.condensation(0, loads)
    if relaxation is not None and not isinstance(relaxation, str):
        relaxation = errors.number("run.relaxation", relaxation, above=0.0, most=1.0, remedy="Or use 'aitken'")
    elif relaxation is not None:
        errors.choice("run.relaxation", relaxation, ("aitken",))
    tail = errors.number("run.tail", tail, least=0.0, most=1e4, unit="s")
    step = _time_step(train, deck, track, speed, time_step)
    lead_in = _lead_in(speed, step, lead_in)
    _refuse_size(train, deck, speed, step, lead_in, tail)
    return Settings(
        speed=speed,
        time_step=step,
        lead_in=lead_in,
        tail=tail,
        track_offset=_track_offset(train, deck, track_offset),
        loads=loads,
        interaction=interaction,
        tolerance=errors.number("run.tolerance", tolerance, above=0.0, most=1.0),
        max_iterations=errors.integer("run.max_iterations", max_iterations, least=1, most=10_000),
        iterations=None if iterations is None else errors.integer("run.iterations", iterations, least=1, most=10_000),
        relaxation=relaxation,
        excitation=excitation,
        feedback=feedback,
    )


def _track_offset(train: Train | AxleTrain, deck: Deck, given: float | str) -> float:
    offset = deck.track_offset(given)
    for w in train.wheels:
        if deck.width is not None and abs(offset + w.y) > deck.width / 2:
            off = f"wheel {w.number} of car {w.car} at y = {offset + w.y:g} m is off the deck, half width {deck.width / 2:g} m"
            raise InputError("train.track", given, off, "Move the track towards the axis, or correct the deck's width")
    return offset


def _lead_in(speed: float, step: float, given: float | None) -> float:
    """Return the run-up; refuse a fade-in (half of it) that the samples do not resolve: its slope, met by chance, is a blow."""
    least = 2 * SAMPLES_PER_LENGTH * speed * step
    if given is None:
        return max(LEAD_IN_SECONDS * speed, least)
    lead_in = errors.number("run.lead_in", given, least=0.0, most=1e5, unit="m", remedy="0 means level track before the deck")
    if 0.0 < lead_in < least * (1 - 1e-9):
        few = f"leaves fewer than {SAMPLES_PER_LENGTH} samples for the fade-in; must be 0 or at least {least:.3g} m"
        raise InputError("run.lead_in", lead_in, few, "Leave it out for 7.5 s of travel; 0 means level track before the deck")
    return lead_in


def _refuse_size(train: Train | AxleTrain, deck: Deck, speed: float, step: float, lead_in: float, tail: float) -> None:
    """Refuse what would not fit into memory: a slip in the speed or the step must not stop the machine."""
    samples = (lead_in + train.length + deck.length) / speed / step + tail / step
    values = samples * (4 * len(train.wheels) + 4 * len(deck.frequencies_hz))
    if values > LARGEST:
        few = f"makes {samples:.3g} samples of {len(train.wheels)} wheels and {len(deck.frequencies_hz)} modes"
        few += f", about {values * 8e-9:.3g} GB, too much to hold"
        raise InputError("run.time_step", step, few, "Use a larger step or speed, a shorter lead-in or tail, or fewer cars")


def _time_step(train: Train | AxleTrain, deck: Deck, track: Track, speed: float, given: float | None) -> float:
    if given is None:
        return default_time_step(train, track, speed)
    step = errors.number("run.time_step", given, above=0.0, unit="s")
    shortest = min([track.shortest, *(n.shortest for n in train.notches)])
    for length, samples, what in [(shortest, SAMPLES_PER_LENGTH, "of irregularity"), (deck.length, 20, "of deck")]:
        if speed * step > length / samples * (1 + 1e-9):
            few = f"leaves fewer than {samples} samples in {length:g} m {what}; at most {length / samples / speed:.3g} s"
            raise InputError("run.time_step", step, few, "Leave run.time_step out to have it chosen")
    return step


def default_time_step(train: Train | AxleTrain, track: Track, speed: float, most: float = 1e-3) -> float:
    """Return the time step used when none is given, s.

    At most 1 ms (or what is given for it) and a twentieth of the shortest wave or notch, and a whole fraction of the time
    between cars, so that all cars meet the samples alike and are computed together.
    """
    shortest = min([track.shortest, *(n.shortest for n in train.notches)])
    most = min(most, shortest / speed / (2 * SAMPLES_PER_LENGTH))
    if len(train.centres) == 1:
        return most
    between = float(train.centres[1] - train.centres[0]) / speed
    return between / np.ceil(between / most)
