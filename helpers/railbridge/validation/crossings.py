"""The crossings of `verification`, run through the package as any user would.

They are *ours*; *theirs* stands in `references`, which also gives the beams and cars.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..beams.beam import Beam
from ..cases.cars import planar_car, sprung_mass
from ..cases.objects import vehicle
from ..crossing import compute
from ..damping import rayleigh
from ..decks import Deck
from ..results import Crossing
from ..settings import check
from ..tracks import Harmonic, Track
from ..trains import AnyTrain, AxleTrain, Train
from ..vehicles import Body, Spring, Vehicle
from .published import DAMPING
from .references import FORCE, SimpleBeam, car_in_plane, force_beam, yang_yau

__all__ = [
    "CAR_MODES", "WAVE", "ConvergenceRow", "convergence_with_modes", "deck_of", "quietly",
    "run_car", "run_force", "run_rose", "run_standing_car", "run_yang_yau",
]  # fmt: skip

WAVE = 5e-3, 14.4
"""Amplitude and length of the waves under the car in its plane, m."""

CAR_MODES = 5
"""Modes of the deck under the car in its plane."""


def deck_of(
    beam: SimpleBeam,
    modes: int,
    damping: tuple[float, float] | float | None = None,
    elements: int | None = None,
) -> Deck:
    """Return a simple beam as the package makes it.

    Parameters
    ----------
    beam : SimpleBeam
    modes : int
    damping : (alpha, beta) or float, optional
        Rayleigh's coefficients, or the ratio of every mode; without, those of the beam.
    elements : int, optional
        See `Beam`.
    """
    made = Beam("closed form", (beam.length,), beam.mass, beam.bending, elements=elements)
    return made.deck(modes, (beam.alpha, beam.beta) if damping is None else damping)


def quietly(train: AnyTrain, deck: Deck, track: Track | None = None, **options) -> Crossing:
    """Compute as `railbridge.cross` does, without its warnings.

    Steps are coarse or modes few on purpose here.
    """
    track = track or Track()
    return compute(train, deck, track, check(train, deck, track, **options))


def run_force(
    speed: float,
    ratio: float = 0.0,
    modes: int = 20,
    tail: float = 0.5,
    time_step: float = 5e-4,
) -> Crossing:
    """Cross `force_beam` with one bare axle of `FORCE`, damping the same in every mode."""
    train, deck = AxleTrain([0.0], [FORCE]), deck_of(force_beam(), modes, ratio)
    return quietly(train, deck, speed=speed, interaction="rigid", time_step=time_step, tail=tail)


def run_yang_yau(modes: int = 5, time_step: float = 5e-4) -> Crossing:
    """Cross the beam of `yang_yau` with its sprung mass."""
    _, beam, speed = yang_yau()
    train, deck = Train(sprung_mass("sprung mass", 5750.0, 1595e3)), deck_of(beam, modes)
    return quietly(train, deck, speed=speed, time_step=time_step, tail=0.1, tolerance=1e-10)


def run_rose(modes: int = 20, time_step: float = 2e-4) -> Crossing:
    """Cross a beam of 50 m with a wheel on its contact that carries a mass; see `ROSE`."""
    wheel = Body("wheel", 5750.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.4), ("z",))
    mass = Body("mass", 3000.0, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("z",))
    springs = (
        Spring("mass", "wheel", (0.0, 0.0, 0.7), (0.0, 1595e5), (0.0, 1000.0)),
        Spring("wheel", "rail", (0.0, 0.0, 0.0), (0.0, 1.0 / 9.1e-8), (0.0, 0.0)),
    )
    car = Vehicle("wheel and mass", (mass, wheel), springs, 10.0)
    deck = deck_of(SimpleBeam(50.0, 2303.0, 2.87e9 * 2.90), modes)
    options = {"speed": 100.0 / 3.6, "lead_in": 0.0, "tail": 0.1}
    return quietly(Train(car), deck, interaction="direct", time_step=time_step, **options)


def run_car(speed: float, modes: int = CAR_MODES, time_step: float = 1e-3) -> Crossing:
    """Cross the 36 m beam with one car in its plane on waves that start at the entrance."""
    _, beam = car_in_plane()
    return quietly(
        Train(planar_car(vehicle("xia2000"))),
        deck_of(beam, modes, rayleigh(*DAMPING)),
        Track(vertical=Harmonic(*WAVE)),
        speed=speed,
        time_step=time_step,
        lead_in=0.0,
        tail=0.2,
        tolerance=1e-10,
    )


def run_standing_car(modes: int = 20) -> Crossing:
    """Let a car in its plane creep over the 36 m beam at a micrometre a second, on level track."""
    _, beam = car_in_plane()
    train, deck = Train(planar_car(vehicle("xia2000"))), deck_of(beam, modes)
    return quietly(train, deck, speed=1e-6, time_step=1e4, lead_in=0.0, tail=0.0)


@dataclass(frozen=True)
class ConvergenceRow:
    """The same crossing with so many deck modes; extremes at mid-span.

    Attributes
    ----------
    modes : int
    cut_off : float
        Highest frequency kept, Hz.
    displacement, moment, acceleration : float
        Of largest magnitude: m, N m, m/s2.
    """

    modes: int
    cut_off: float
    displacement: float
    moment: float
    acceleration: float


@lru_cache
def convergence_with_modes(
    counts: tuple[int, ...] = (1, 3, 5, 9, 17, 33), ratio: tuple[float, float] | float = 0.0
) -> tuple[ConvergenceRow, ...]:
    """Return what a force crossing at half the critical speed gives with more and more modes.

    Displacement and moment settle. Without damping the acceleration does not: a force that runs
    onto the beam excites mode n with an acceleration that falls only like 1/n, so that every
    further mode still counts. The same ratio in every mode makes it settle slowly, damping that
    grows with the frequency (Rayleigh) soon. State the cut-off with an acceleration.

    Parameters
    ----------
    counts : tuple of int
        Numbers of modes.
    ratio : (alpha, beta) or float
        Rayleigh's coefficients, or the damping ratio of every mode.
    """
    beam, rows = force_beam(), []
    speed, middle = 0.5 * beam.critical_speed, beam.length / 2
    train = AxleTrain([0.0], [FORCE])
    for modes in counts:
        deck = deck_of(beam, modes, ratio, elements=80)
        run = quietly(train, deck, speed=speed, interaction="rigid", time_step=1e-4, tail=0.0)
        histories = [
            run.displacement(middle)["displacement_z"],
            run.section_forces(middle)["moment_vertical"],
            run.acceleration(middle)["acceleration_z"],
        ]
        largest = (float(np.abs(history).max()) for history in histories)
        rows.append(ConvergenceRow(modes, float(deck.frequencies_hz[-1]), *largest))
    return tuple(rows)
