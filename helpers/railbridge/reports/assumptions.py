"""What a calculation assumes and leaves out, in words."""

from __future__ import annotations

from ..decks import Deck
from ..settings import Settings
from ..tracks import Track
from ..trains import AnyTrain, AxleTrain
from .parts import shown
from .receipts import damping_in_words

__all__ = ["assumptions", "left_out"]

_LOADS = {
    "wheels": "Every wheel loads the deck at its own place.",
    "bogies": "The wheel forces of a bogie act on the deck as one force and one couple below its "
    "middle: section forces and reactions are off by some per cent.",
    "condensed": "The wheel forces of a car act on the deck as one force and one couple below its "
    "middle, all at once, as in the paper: section forces and reactions are off by tens of per "
    "cent on short spans.",
}
_INTERACTION = {
    "iterate": "Train and deck are brought together by a fixed point: forces, motion of the deck, "
    "forces again, until nothing changes.",
    "rigid": "The deck moves under forces that were found on a rigid deck: what its motion does to "
    "the train is left out.",
    "direct": "Train and deck are solved together at every time step.",
}


def assumptions(train: AnyTrain, deck: Deck, track: Track, settings: Settings) -> list[str]:
    """Return what is assumed of a crossing, a sentence or two each.

    Parameters
    ----------
    train, deck, track
    settings : Settings
        Of many crossings those of the first.
    """
    s = settings
    count, last = len(deck.frequencies_hz), shown(deck.frequencies_hz[-1])
    found = [
        f"The deck is linear and is described by its {count} lowest modes, up to {last} Hz. "
        "Section forces, reactions and displacements also have the static part of the modes left "
        "out; accelerations do not, and depend on the cut-off."
        if not deck.recovery.lacks
        else f"The deck is linear and only {count} of its modes are known, up to {last} Hz: there "
        "are no section forces and reactions, and displacements lack the modes left out.",
        f"Damping of the deck: {damping_in_words(deck)}.",
    ]
    if isinstance(train, AxleTrain):
        found.append(
            "The train is a row of constant axle loads without suspension or mass: nothing that "
            "the deck or the track does changes them, and wheel unloading is not computed."
        )
    else:
        found += [_wheels(train, s), _LOADS[s.loads], _INTERACTION[s.interaction]]
    if s.excitation == "car":
        found.append("All wheels of a car meet the track in phase, as one support.")
    if s.feedback == "vertical":
        found.append("The train feels the vertical motion of the deck alone, without its twist.")
    if deck.rail is not None:
        found.append("The rails spread each wheel's load along the deck.")
    found.append(
        "The track is perfectly level: no irregularity excites the train."
        if track.level
        else "The track is uneven as given; from a run-up before the deck on, as stated with how "
        "it was computed."
    )
    found.append(
        "Values are those of the moving train alone: dynamic, without the deck's self-weight, "
        "which stands apart. Forces are those on the deck, up positive; displacements down are "
        "negative."
    )
    return found


def _wheels(train: AnyTrain, settings: Settings) -> str:
    heavy = [bool(vehicle.wheelsets) for vehicle, _ in train.kinds()]
    if all(heavy):
        mass = "Wheels have mass and stand on contact springs"
    elif any(heavy):
        mass = "Wheels of some cars have mass and stand on contact springs, others are massless"
    else:
        mass = "Wheels are massless and follow the rail exactly"
    if settings.contact == "hertz":
        return f"{mass}; the contact follows Hertz's law, and wheels can leave the rail."
    return (
        f"{mass}; contact is permanent: a wheel that would lift off pulls on the rail instead, "
        "which a remark tells of."
    )


def left_out() -> list[str]:
    """Return what no calculation of this program holds."""
    return [
        "Flanges, creep and slip between wheel and rail: lateral wheel forces are spring forces, "
        "and no statement on derailment by the ratio of lateral to vertical force is made.",
        "Braking and traction, centrifugal force in curves, wind, temperature, settlements, creep "
        "and cracking of the deck, and fatigue.",
        "A second train on the bridge at the same time.",
        "Cars are linear: bump stops, friction and the softening of high cars under gravity are "
        "not there.",
    ]
