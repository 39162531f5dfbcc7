"""A continuous beam, a bar in torsion, and the damping of a beam: closed forms beside ours."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from ..beams.beam import Beam
from ..trains import AxleTrain
from .crossings import deck_of, quietly
from .references import FORCE, car_in_plane
from .rows import Row

__all__ = ["damping_rows", "torsion_rows", "two_span_rows"]


def two_span_rows() -> list[Row]:
    r"""Return rows of the frequencies of a continuous beam of two spans a and b.

    The moments of both spans at the middle bearing are in balance. A span pinned at its far end
    answers a rotation of the near end with the moment ``2 E I k / (cot ka - coth ka)`` to a common
    sign, so the rotation there is free if ``sum (cot ka - coth ka) = 0``; the frequency is
    ``k^2 sqrt(E I / m)``.
    """
    mass, bending, spans = 12e3, 8.93e10, (20.0, 30.0)

    def balance(k: float) -> float:
        return sum(1 / np.tan(k * a) - 1 / np.tanh(k * a) for a in spans)

    # Between neighbouring poles, the pinned frequencies of either span, the sum falls through zero
    # once.
    poles = sorted({round(n * np.pi / a, 12) for a in spans for n in range(1, 4)})
    roots = [
        brentq(balance, low * (1 + 1e-9), high * (1 - 1e-9))
        for low, high in zip(poles[:-1], poles[1:], strict=True)
    ]
    ours = Beam("two spans", spans, mass, bending, elements=64).modes.frequencies_hz
    case, source = "Continuous beam, 20 + 30 m", "characteristic equation"
    why = "64 cubic elements: error (k h)^4 / 720"
    rows = []
    for i, k in enumerate(roots[:3], start=1):
        numbers = k**2 * np.sqrt(bending / mass) / (2 * np.pi), float(ours[i - 1])
        rows.append(Row(case, f"frequency {i}", "Hz", *numbers, why, source, 1e-6))
    return rows


def torsion_rows() -> list[Row]:
    r"""Return rows of a bar held against twist at both ends, free and under an eccentric force P e.

    ``f_n = n / (2 L) sqrt(G J / I)``. All terms have the same speed ratio
    ``alpha = v / sqrt(G J / I)``, so that the twist at mid-span

        theta = -(2 P e / I L) sum sin(n pi x / L) (sin n Omega t - alpha sin omega_n t)
                                                   / (omega_n^2 - n^2 Omega^2)

    is two waves running from end to end. Statically a couple at mid-span twists it by
    P e L / (4 G J) there.
    """
    length, stiffness, inertia, lever, speed = 36.0, 8.15e10, 7.02e4, 2.4, 90.0
    beam = Beam(
        "bar",
        (length,),
        12e3,
        8.93e10,
        torsional_stiffness=stiffness,
        polar_inertia=inertia,
        elements=80,
    )
    case, source = "Torsion bar", "closed form"
    wave, middle, rows = np.sqrt(stiffness / inertia), length / 2, []

    modes = zip(beam.modes.frequencies_hz, beam.modes.names, strict=True)
    torsional = [f for f, name in modes if name.startswith("torsion")]
    for n in (1, 3):
        numbers, why = (n * wave / (2 * length), float(torsional[n - 1])), "80 quadratic elements"
        rows.append(Row(case, f"frequency {n}", "Hz", *numbers, why, source, 1e-6))

    deck = beam.deck(16)
    line = deck.recovery.section("rotation_x", middle).influence(np.array([middle]))[0, 0, 2]
    numbers = 1e12 * (length / (4 * stiffness)), 1e12 * float(line)
    quantity = "twist under a couple, per N m"
    rows.append(Row(case, quantity, "1e-12 rad", *numbers, "exact", source, 1e-9))

    run = quietly(
        AxleTrain([0.0], [FORCE]),
        deck,
        speed=speed,
        track_offset=lever,
        interaction="rigid",
        time_step=2e-4,
        tail=0.0,
    )
    kept = sum(name.startswith("torsion") for name in deck.mode_names)
    terms = 2000
    n = np.arange(1, terms + 1)[:, None]
    omega, drive = n * np.pi * wave / length, n * np.pi * speed / length
    time = run.time[run.time <= length / speed]
    swing = np.sin(drive * time) - drive / omega * np.sin(omega * time)
    at_middle = np.sin(n * np.pi / 2).ravel()
    each = -2 * FORCE * lever / (inertia * length) * at_middle[:, None] * swing
    each /= omega**2 - drive**2
    quantity, others = f"twist under a moving force, {lever:g} m off", "statically corrected"
    for count, kept_only, modes, why, limit in [
        (kept, True, "", f"the same {kept} torsion modes alone; they converge like 1/n", 1e-4),
        (terms, False, ", all modes", f"{terms} terms; ours {kept} modes, {others}", 2e-3),
    ]:
        ours = run.displacement(middle, kept_only=kept_only)["rotation_x"]
        numbers = float(1e3 * each[:count].sum(axis=0).min()), float(1e3 * ours.min())
        rows.append(Row(case, quantity + modes, "mrad", *numbers, why, source, limit))
    return rows


def damping_rows() -> list[Row]:
    r"""Return rows of Rayleigh damping by the logarithmic decrement of what a crossing leaves.

    Extremes of a free vibration half a period apart shrink by
    ``delta = pi zeta / sqrt(1 - zeta^2)``, with ``zeta = alpha / (2 omega) + beta omega / 2``; the
    extremes are found by a parabola through three samples.
    """
    _, beam = car_in_plane()
    speed, half_periods = 50.0, 6
    run = quietly(
        AxleTrain([0.0], [FORCE]),
        deck_of(beam, 8),
        speed=speed,
        interaction="rigid",
        time_step=2e-4,
        tail=4.0,
    )
    # In mid-span the second mode does not move; at a quarter the first one does, so the mode itself
    # is taken there.
    first, second = run.displacement(beam.length / 2)["displacement_z"], run.state.q[1]
    case, source = "Damping after a crossing", "Rayleigh, log decrement"
    why = f"{half_periods} half-periods of free vibration, parabola through the extremes"
    rows = []
    for mode, history, pause in ((1, first, 1.5), (2, second, 0.1)):
        omega = beam.omega(mode)
        theirs = beam.alpha / (2 * omega) + beam.beta * omega / 2
        peaks = _extremes(history[run.time > beam.length / speed + pause])
        delta = np.log(peaks[0] / peaks[half_periods]) / half_periods
        ours = delta / np.sqrt(np.pi**2 + delta**2)
        numbers = 100 * theirs, float(100 * ours)
        rows.append(Row(case, f"ratio of mode {mode}", "%", *numbers, why, source, 1e-4))
    return rows


def _extremes(history: np.ndarray) -> np.ndarray:
    """Return the magnitudes of the extremes, each by a parabola through three samples."""
    before, at, after = history[:-2], history[1:-1], history[2:]
    k = np.flatnonzero((at - before) * (after - at) < 0) + 1
    bend = history[k - 1] - 2 * history[k] + history[k + 1]
    return np.abs(history[k] - (history[k + 1] - history[k - 1]) ** 2 / (8 * bend))
