"""What a reader must know before reading the numbers of a crossing."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..coupling import left
from ..cutoffs import counted
from ..decks import Deck
from ..errors import InputError, InputWarning, Remark, ResultWarning
from ..results import Crossing
from ..settings import (
    COARSE_SAMPLES_PER_CONTACT,
    COARSE_SAMPLES_PER_PERIOD,
    LEAD_IN_SECONDS,
    Settings,
    contact_frequency,
    highest_frequency,
)
from ..steady import steady_forces
from ..tracks import Track
from ..trains import AnyTrain, Train
from .lifting import lifting, parted, pulling
from .plausibility import doubts
from .tracksindoubt import parts_of, track_doubts

__all__ = [
    "SETTLED", "ends_move", "left_open", "remarks", "remarks_before", "transient", "unsettled",
]  # fmt: skip

FAR = 0.1
"""Last change of the wheel forces from which on a given number of passes stopped far from the
end."""
SETTLED = 0.01
"""Share of the wheel forces' dynamic part that may be open or transient without a word."""
GROWING = 0.01
"""Smallest change that, larger than one before it, is called a divergence."""
BLOW = 0.02
"""Share of the static wheel force from which on a blow at the deck's ends is told of."""
_STILL = 1e-3
"""Motion of a deck's end, share of its largest, below which it is at rest."""


def remarks(run: Crossing) -> tuple[Remark, ...]:
    """Return what is doubtful about a crossing and what its numbers leave out, a sentence each."""
    found = [*remarks_before(run.train, run.deck, run.track, run.settings)]
    found += _transient(run)
    found += _not_settled(run)
    found += _solved_otherwise(run)
    found += parted(run) if run.settings.contact == "hertz" else pulling(run)
    found += lifting(run)
    found += _broken_track(run)
    return tuple(found)


def remarks_before(
    train: AnyTrain, deck: Deck, track: Track, settings: Settings, *others: Track
) -> tuple[Remark, ...]:
    """Return what is doubtful about a crossing before it is computed, a sentence each.

    Parameters
    ----------
    train, deck, track, settings
    *others : Track
        What the rails are besides, of which only what is about tracks is said.
    """
    found: list[Remark] = [remark.moved("deck") for remark in deck.remarks]
    found += doubts(train, deck, track, settings)
    found += [doubt for other in others for doubt in track_doubts(train, other)]
    found += _only_modes(deck)
    found += _cut_short(deck, settings)
    found += _coarse(deck, settings)
    found += _coarse_contact(train, settings)
    tracks = (track, *others)
    found += [remark for own in tracks for remark in _apart(train, deck, own, settings)]
    found += _starting_at_once(train, track, settings)
    found += _without_effect(settings)
    found += _moving_ends(train, deck)
    found += [remark for own in tracks for remark in _measured(own)]
    return tuple({str(remark): remark for remark in found}.values())


def unsettled(run: Crossing) -> bool:
    """Whether a given number of passes, two or more, diverged or stopped far from the end."""
    if run.converged is not False or len(run.changes) < 2:
        return False
    *before, last = run.changes
    return not (last < FAR and (last < GROWING or last < min(before)))


def left_open(run: Crossing) -> float:
    """Return which share of the wheel forces' dynamic part further passes would still change.

    Judged from how the last passes changed it, whatever the tolerance was; see `coupling.left`.
    Infinite where a single pass tells nothing of the next; 0 where there are no passes.
    """
    if run.windows is not None:
        return run.changes[-1]
    if run.settings.interaction != "iterate" or run.iteration == 0:
        return 0.0
    changes = run.changes[: run.iteration]
    if run.settings.tolerance_of == "displacement":
        last = run.passes[: run.iteration + 1][-4:]
        changes = [run.coupling.change(new, old) for old, new in pairwise(last)]
    open_still = left(changes)
    return open_still if open_still >= 0.0 else np.inf  # changes that are no numbers


def transient(run: Crossing) -> float:
    """Return which share of the steady wheel forces is transient while the first car crosses.

    0 where that is not known: on level track, on track that is not harmonic, with flat spots.
    """
    s, train, first = run.settings, run.train, run.coupling.cars[0]
    usual = LEAD_IN_SECONDS * s.speed
    if not 0.0 < s.lead_in < usual or first.respond is None or train.notches:
        return 0.0
    try:
        steady = steady_forces(first.car.vehicle, run.track, s.speed, s.excitation)
    except InputError:  # level, or not harmonic: nothing to compare with
        return 0.0
    if not np.all(np.isfinite(steady)) or not np.any(steady):
        return 0.0
    if first.car.vehicle.wheelsets:
        # On stiff contacts the sampled rail alone is a per cent off the closed form, and what
        # Hertzian contacts carry more is no transient: a longer run-up shows what is left.
        own = Train(first.car.vehicle)
        rigid, settled = (
            own.rigid_forces(run.track, replace(s.passage, lead_in=lead_in))[0][..., first.window]
            for lead_in in (s.lead_in, usual)
        )
    else:
        wavelength = run.track.shortest  # the only one
        centre = s.speed * run.time[first.window] - first.car.centre
        rigid = first.rigid[..., first.window]
        settled = (steady[..., None] * np.exp(2j * np.pi * centre / wavelength)).imag
    return float(np.linalg.norm(rigid - settled) / np.linalg.norm(settled))


def _only_modes(deck: Deck) -> list[Remark]:
    if not deck.recovery.lacks:
        return []
    text = (
        "Only modes of this deck are known: section forces, reactions and self-weight are null, "
        "and displacements lack the static flexibility of the modes left out."
    )
    return [Remark("", text)]


def _transient(run: Crossing) -> list[Remark]:
    """Say how far the first car's forces on a rigid deck are from what they settle to."""
    s, share = run.settings, transient(run)
    if share <= SETTLED:
        return []
    text = (
        f"= {s.lead_in:g} m: {share:.1%} of the steady wheel forces is still transient while "
        f"the first car crosses. Leave it out for {LEAD_IN_SECONDS * s.speed:g} m, or give 0 for "
        "level track before the deck."
    )
    return [InputWarning("lead_in", text)]


def _cut_short(deck: Deck, settings: Settings) -> list[Remark]:
    """Say where the deck's modes end below the frequency up to which accelerations want them."""
    limit, last = settings.accelerations_up_to_hz, float(deck.frequencies_hz.max())
    if np.isinf(limit) or counted([limit], last)[0]:
        return []
    text = (
        f"= {settings.acceleration_modes}: modes up to {limit:.4g} Hz count in the deck's "
        f"accelerations, and it has only {len(deck.frequencies_hz)}, up to {last:.4g} Hz: some may "
        "be missing. Raise deck.modes."
    )
    return [ResultWarning("acceleration_modes", text)]


def _coarse(deck: Deck, settings: Settings) -> list[Remark]:
    highest, step = highest_frequency(deck), settings.time_step
    if highest * step * COARSE_SAMPLES_PER_PERIOD <= 1.0:
        return []
    text = (
        f"= {step:g} s leaves {1 / (highest * step):.2g} samples in a period of the deck's highest "
        f"mode, {highest:.4g} Hz: accelerations may be off by 5 % and more. At most "
        f"{1 / highest / COARSE_SAMPLES_PER_PERIOD:.2g} s, or fewer modes, would do."
    )
    return [ResultWarning("time_step", text)]


def _coarse_contact(train: AnyTrain, settings: Settings) -> list[Remark]:
    frequency, step = contact_frequency(train), settings.time_step
    if frequency * step * COARSE_SAMPLES_PER_CONTACT <= 1.0:
        return []
    percent = 100 * (2 * np.pi * frequency * step) ** 2 / 12
    text = (
        f"= {step:g} s is coarse for wheelsets that bounce on their contacts at {frequency:.3g} "
        f"Hz: what their inertia adds to wheel forces is off by some {percent:.2g} %. At most "
        f"{1 / frequency / COARSE_SAMPLES_PER_CONTACT:.2g} s would do."
    )
    return [ResultWarning("time_step", text)]


def _apart(train: AnyTrain, deck: Deck, track: Track, settings: Settings) -> list[Remark]:
    """Doubt the lateral forces of wheelsets whose two rails move sideways differently."""
    x = np.linspace(-settings.lead_in, deck.length, 401)
    left, right = (track.rail("lateral", side).value(x) for side in ("left", "right"))
    if np.array_equal(left, right):
        return []
    if not any(len(c.wheels) > 1 for v, _ in train.kinds() if v.wheelsets for c in v.axles):
        return []
    text = (
        "differs left and right: wheelsets that do not slip hold the rails apart, so lateral wheel "
        "forces of a pair are far too large; their sum is right."
    )
    return [ResultWarning("track.lateral", text)]


def _not_settled(run: Crossing) -> list[Remark]:
    """Say how far from the fixed point a given number of passes has ended."""
    if run.converged is not False or run.settings.iterations is None:
        return []
    last = run.changes[-1]
    what, whole = "changed the wheel forces", "their dynamic part"
    if run.settings.tolerance_of == "displacement":
        what, whole = "moved the deck", "its largest motion"
    text = f"= {run.iterations}: the last pass still {what} by {last:.2g}"
    if not unsettled(run):
        return [Remark("iterations", f"{text} of {whole}.")]
    least = int(np.nanargmin(run.changes))
    if least < len(run.changes) - 1:
        text += f", pass {least + 1} by {run.changes[least]:.2g}: they diverge"
    return [ResultWarning("iterations", text + ". These numbers are not a solution.")]


def _solved_otherwise(run: Crossing) -> list[Remark]:
    """Say where another way was taken than the fixed point over the whole record."""
    if run.windows is not None:
        passes = run.windows.passes
        text = "The passes did not settle over the whole record, so it was cut into "
        text += f"{len(passes)} windows in time"
        stepped = int(np.sum(passes == 1))
        if stepped < len(passes):
            text += f"; {len(passes) - stepped} settled, in {passes.max()} passes at most"
        if stepped:
            text += f"; in {stepped} train and deck were solved together at every sample"
        text += "."
        return [Remark("", text)]
    if not run.settings.auto or run.settings.interaction != "direct":
        return []
    highest = max(vehicle.highest_frequency for vehicle, _ in run.train.kinds())
    text = f"= auto: solved directly, since wheels stand on stiff contacts ({highest:.3g} Hz)."
    return [Remark("interaction", text)]


def ends_move(deck: Deck) -> bool:
    """Whether wheels step onto an end of a deck that moves, which spoils its accelerations."""
    if not deck.parts:
        return False  # a rail on a bed lets loads come smoothly
    places = np.linspace(0.0, deck.length, 101)
    vertical = np.abs(deck.shapes(places)[:, :, 1]).max(axis=1)
    return bool(max(vertical[0], vertical[-1]) > _STILL * vertical.max())


def _moving_ends(train: AnyTrain, deck: Deck) -> list[Remark]:
    """Say that a wheel steps at full weight, or in parts of it, onto an end that moves."""
    if not ends_move(deck):
        return []
    what = "accelerations"
    if any(vehicle.wheelsets for vehicle, _ in train.kinds()):
        what += " and the forces of wheels with mass"
    how = "at full weight" if deck.rail is None else "by quarters and halves of their weight"
    text = (
        "An end of the deck moves (elastic bearings, piers or an overhang): wheels step on or off "
        f"there {how}, so {what} are not to be trusted. Try a rail on a bed, "
        "deck.rail = { bending_stiffness = 1.28e7, foundation = 1e8 }."
    )
    return [ResultWarning("", text)]


def _starting_at_once(train: AnyTrain, track: Track, settings: Settings) -> list[Remark]:
    """Say how hard wheels with mass are struck where the track begins without a run-up."""
    if settings.lead_in > 0.0:
        return []
    start = np.zeros(1)
    sides = (track.rail("vertical", side) for side in ("left", "right"))
    slope = max(abs(float(rail.slope(start)[0])) for rail in sides)
    share, blow = _blow(train, settings.speed * slope)
    if share < BLOW:
        return []
    text = (
        f"= 0: the track begins at x = 0 with a slope of {1e3 * slope:.2g} mrad at once, which "
        f"strikes each wheel with mass with up to about {blow / 1e3:.3g} kN. Leave it out, so that "
        "the train runs up to the deck."
    )
    return [ResultWarning("lead_in", text)]


def _without_effect(settings: Settings) -> list[Remark]:
    """Name what is given for passes where none are made."""
    if settings.interaction == "iterate":
        return []
    return [
        Remark(name, f"= {value}: has no effect with interaction = {settings.interaction!r}.")
        for name in ("iterations", "relaxation")
        if (value := getattr(settings, name)) is not None
    ]


def _broken_track(run: Crossing) -> list[Remark]:
    """Say how hard wheels with mass are struck where the track breaks at the ends of the deck."""
    deck = run.deck
    if not deck.parts or run.settings.interaction == "rigid":
        return []
    ends = deck.shapes(np.array([0.0, deck.length]), 1)[:, :, 1] @ run.state.q
    angle = float(np.abs(ends).max())
    share, blow = _blow(run.train, run.settings.speed * angle)
    if share < BLOW:
        return []
    text = (
        f"Wheels with mass meet a break of the track where the deck's ends turn, {1e3 * angle:.2g} "
        f"mrad at most: it strikes each with up to about {blow / 1e3:.3g} kN, which a real "
        "rail softens. Try a rail on a bed, "
        "deck.rail = { bending_stiffness = 1.28e7, foundation = 1e8 }."
    )
    return [ResultWarning("", text)]


def _blow(train: AnyTrain, rate: float) -> tuple[float, float]:
    """Return the largest force of a wheel with mass that is given a speed (m/s) at once.

    A mass m on a spring k answers with ``v sqrt(k m)``; as a share of the static force, and in N.
    """
    worst = 0.0, 0.0
    for vehicle, _ in train.kinds():
        for body in vehicle.wheelsets:
            for contact, k in zip(vehicle.contacts, vehicle.contact_stiffness[:, 1], strict=True):
                if contact.body != body.name:
                    continue
                own = body.mass / sum(c.body == body.name for c in vehicle.contacts)
                blow = rate * np.sqrt(k * own)
                if contact.static_load > 0.0:
                    worst = max(worst, (blow / contact.static_load, blow))
    return worst


def _measured(track: Track) -> list[Remark]:
    """Tell where measured and random rails come from, each story once."""
    told = (getattr(part, "told", "") for _, part in parts_of(track))
    return [Remark("", text) for text in dict.fromkeys(told) if text]
