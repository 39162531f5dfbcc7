"""Forces that move over a simple beam: closed forms beside crossings."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from ..decks import Deck
from ..results import Crossing
from ..trains import AxleTrain
from .crossings import deck_of, quietly, run_force
from .references import FORCE, force_beam, moving_force
from .rows import Row

__all__ = ["axle_train_rows", "moving_force_rows"]

_FRYBA = "closed form (Fryba 1999)"
_YANG = "closed form (Yang, Yau & Hsu 1997)"
_SAMPLED = "20 modes against 100 terms; load sampled every 0.5 ms"


def moving_force_rows() -> list[Row]:
    """Return rows of one force at several speeds, with and without damping, case by case."""
    beam = force_beam()
    middle, odd = beam.length / 2, np.sin(np.arange(1, 101) * np.pi / 2)
    static = beam.deflection(FORCE)
    rows = []
    for alpha, ratio in [(0.2, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, 0.05)]:
        speed = alpha * beam.critical_speed
        run = run_force(speed, ratio)
        ours = run.displacement(middle)["displacement_z"]
        theirs = odd @ moving_force(beam, speed, run.time, ratio)[0]
        on = run.time <= beam.length / speed
        damped = f", damping {ratio:.0%}" if ratio else ""
        case = f"Moving force, speed ratio {alpha:g}{damped}"
        parts = [("largest mid-span deflection / static", on)]
        if alpha == 0.5:
            parts.append(("the same after the force has left", ~on))
        for quantity, part in parts:
            known, found = (float(np.abs(h[part]).max() / static) for h in (theirs, ours))
            rows.append(Row(case, quantity, "", known, found, _SAMPLED, _FRYBA, 1e-5))
        if (alpha, ratio) == (0.5, 0.0):
            rows += _moment_and_reaction_rows(case)
    return rows


def _moment_and_reaction_rows(case: str) -> list[Row]:
    r"""Moment at mid-span and reaction under the moving force, alpha = 0.5.

    Both follow from statics: the force and the inertia load ``-m w''`` per metre stand on the beam
    together, so an influence line eta gives ``eta(v t) (-P) - m int eta w'' dx``. For the reaction
    at x = 0, ``eta = -(1 - x/L)`` (an upward load pulls the bearing), and the integral over
    sin(n pi x / L) is L/(n pi). For the moment ``eta = min(x, L - x) / 2``, whose integral is
    ``(L / n pi)^2 sin(n pi / 2)``. The series converge like 1/n^2, so 1000 terms are summed.
    """
    beam = force_beam()
    speed, middle, terms, every = 0.5 * beam.critical_speed, beam.length / 2, 1000, 5
    run = run_force(speed, tail=0.0)
    time = run.time[: int(beam.length / speed / run.settings.time_step) + 1 : every]
    x = speed * time
    n = np.arange(1, terms + 1)
    acceleration = moving_force(beam, speed, time, terms=terms)[2]
    to_moment = (beam.length / (n * np.pi)) ** 2 * np.sin(n * np.pi / 2)
    to_reaction = beam.length / (n * np.pi)
    moment = -FORCE * np.minimum(x, beam.length - x) / 2 - beam.mass * to_moment @ acceleration
    reaction = FORCE * (1 - x / beam.length) + beam.mass * to_reaction @ acceleration
    our_moment = run.section_forces(middle)["moment_vertical"]
    our_reaction = run.reactions()[0.0]["force_z"]
    why = "20 modes: those left out answer as if at rest, here they ring undamped"
    # The reaction starts at P, whatever the speed: its largest later value is compared.
    late = x > beam.length / 4
    rows = []
    for quantity, unit, known, found, part, limit in [
        ("largest mid-span moment", "kN m", moment, our_moment, x >= 0.0, 2e-3),
        ("largest reaction, force past L/4", "kN", reaction, our_reaction, late, 2e-2),
    ]:
        histories = known, found[::every][: len(time)]
        theirs, ours = (float(1e-3 * np.abs(h[part]).max()) for h in histories)
        rows.append(Row(case, quantity, unit, theirs, ours, why, _FRYBA, limit))
    return rows


def axle_train_rows() -> list[Row]:
    r"""Return rows of cancellation and resonance of the first mode.

    With Omega = pi v / L and an undamped beam, one force leaves the first mode with the amplitude

        A = (2 P / m L) Omega / (omega |omega^2 - Omega^2|) sqrt(2 + 2 cos(omega L / v)),

    which vanishes at ``omega L / v = (2 j + 1) pi``: v = 2 f L / (2 j + 1), j = 1, 2 ... N forces
    D apart leave ``A |sin(N phi / 2) / sin(phi / 2)|`` with phi = omega D / v: N times A at
    v = f D / i (Yang, Yau & Hsu 1997).
    """
    beam = force_beam()
    deck, omega = deck_of(beam, 1), beam.omega(1)
    frequency = omega / (2 * np.pi)

    def left_by_one_axle(speed: float) -> float:
        drive = np.pi * speed / beam.length
        size = np.sqrt(2 + 2 * np.cos(omega * beam.length / speed))
        # The shape of the deck's mode is sqrt(2 / m L) sin(pi x / L).
        scale = np.sqrt(2 / (beam.mass * beam.length))
        return scale * FORCE * drive / (omega * abs(omega**2 - drive**2)) * size

    rows = []
    for j in (1, 2):
        theirs = 2 * frequency * beam.length / (2 * j + 1)
        ours = minimize_scalar(
            lambda v: _left_by_axles(v, 1, 1.0, deck) ** 2,
            bounds=(0.97 * theirs, 1.03 * theirs),
            method="bounded",
            options={"xatol": 1e-5 * theirs},
        ).x
        quantity = f"cancellation speed 2 f L / {2 * j + 1}"
        why = "searched in crossings; exact but for the sampled load"
        rows.append(Row("Axle train", quantity, "m/s", theirs, float(ours), why, _YANG, 1e-4))
    spacing, axles = 18.0, 40
    for i in (1, 2):
        speed = frequency * spacing / i
        ours = _left_by_axles(speed, axles, spacing, deck) / left_by_one_axle(speed)
        quantity = f"{axles} axles at f D / {i}: amplitude left / one axle's"
        why = "all N forces add up; load sampled every 1 ms"
        rows.append(Row("Axle train", quantity, "", float(axles), float(ours), why, _YANG, 1e-4))
        room = 0.4 / axles / i
        ours = minimize_scalar(
            lambda v: -_left_by_axles(v, axles, spacing, deck),
            bounds=(speed * (1 - room), speed * (1 + room)),
            method="bounded",
            options={"xatol": 1e-4},
        ).x
        quantity = f"resonance speed f D / {i}"
        why = "one axle's own curve pulls a finite train's peak by 1/N^2"
        rows.append(Row("Axle train", quantity, "m/s", speed, float(ours), why, _YANG, 4e-3))
    return rows


def _left_by_axles(speed: float, axles: int, spacing: float, deck: Deck) -> float:
    """Cross with equal forces; return the amplitude of the first mode after the last has left."""
    train = AxleTrain(spacing * np.arange(axles), [FORCE] * axles)
    run = quietly(train, deck, speed=speed, interaction="rigid", time_step=1e-3, tail=2e-3)
    return _free_amplitude(run)


def _free_amplitude(run: Crossing) -> float:
    omega = 2 * np.pi * run.deck.frequencies_hz[0]
    return float(np.hypot(run.state.q[0, -1], run.state.velocity[0, -1] / omega))
