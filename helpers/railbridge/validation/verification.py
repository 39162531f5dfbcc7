r"""What is known without this package, beside what the package says: case, source, theirs, ours, difference, why.

Each case takes *theirs* from `references`, a closed form or differential equations written down anew, and *ours* through
the package as any user calls it. Nothing is fitted. ``python -m railbridge.verification`` prints the table.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from ..beams.beam import Beam
from ..cases.objects import vehicle
from ..crossing import cross
from ..decks import Deck, rayleigh
from ..results import Crossing
from ..tracks import Harmonic, Track
from ..trains import AxleTrain, Train
from ..vehicles import planar_car, sprung_mass
from .references import FORCE, car_in_plane, coupled, force_beam, moving_force, yang_yau

__all__ = [
    "NEWMARK", "ConvergenceRow", "Row", "cases", "convergence_with_modes", "frame", "report", "run_car", "run_force",
    "run_yang_yau",
]  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One number that is known, beside ours.

    Attributes
    ----------
    case, quantity, unit, source : str
    theirs, ours : float
        In `unit`.
    limit : float
        Largest difference allowed, relative to `theirs`.
    why : str
        What the difference consists of.
    """

    case: str
    quantity: str
    unit: str
    source: str
    theirs: float
    ours: float
    limit: float
    why: str

    @property
    def difference(self) -> float:
        """Ours against theirs, relative."""
        return (self.ours - self.theirs) / abs(self.theirs)

    @property
    def ok(self) -> bool:
        """Whether the difference is within its limit."""
        return bool(abs(self.difference) <= self.limit)

    @property
    def shown(self) -> str:
        """The difference as a bound, which round-off does not change: the next power of ten, 1e-9 at least."""
        size = abs(self.difference)
        return f"< {10.0 ** max(np.ceil(np.log10(size)), -9.0):.0e}" if size > 1e-9 else "< 1e-09"


def run_force(speed: float, ratio: float = 0.0, modes: int = 20, tail: float = 0.5, time_step: float = 5e-4) -> Crossing:
    """Cross `force_beam` with one bare axle of `FORCE`, damping the same in every mode."""
    deck = force_beam().deck(modes, ratio)
    return cross(AxleTrain([0.0], [FORCE]), deck, speed=speed, interaction="rigid", time_step=time_step, tail=tail)


_FRYBA = "closed form (Fryba 1999)"
_SAMPLED = "20 modes against 100 terms; load sampled every 0.5 ms"


def _moving_force_rows() -> list[Row]:
    beam = force_beam()
    middle, odd = beam.length / 2, np.sin(np.arange(1, 101) * np.pi / 2)
    rows = []
    for alpha, ratio in [(0.2, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, 0.05)]:
        run = run_force(alpha * beam.critical_speed, ratio)
        ours = run.displacement(middle)["displacement_z"]
        theirs = odd @ moving_force(beam, alpha * beam.critical_speed, run.time, ratio)[0]
        on = run.time <= beam.length / (alpha * beam.critical_speed)
        static = beam.deflection(FORCE)
        damped = f", damping {ratio:.0%}" if ratio else ""
        case = f"Moving force, alpha = {alpha:g}{damped}"
        known, found = (float(np.abs(h[on]).max() / static) for h in (theirs, ours))
        rows.append(Row(case, "largest mid-span deflection / static", "", _FRYBA, known, found, 1e-5, _SAMPLED))
        if alpha == 0.5:
            known, found = (float(np.abs(h[~on]).max() / static) for h in (theirs, ours))
            rows.append(Row(case, "the same after the force has left", "", _FRYBA, known, found, 1e-5, _SAMPLED))
    rows += _moving_force_section_rows()
    order = list(dict.fromkeys(r.case for r in rows))
    return sorted(rows, key=lambda r: order.index(r.case))


def _moving_force_section_rows() -> list[Row]:
    r"""Moment at mid-span and reaction under the moving force.

    Both follow from statics: the force and the inertia load ``-m w''`` per metre stand on the beam together, so an influence
    line eta gives ``eta(v t) (-P) - m int eta w'' dx``. For the reaction at x = 0, ``eta = -(1 - x/L)`` (an upward load
    pulls the bearing), and the integral over sin(n pi x / L) is L/(n pi). For the moment ``eta = min(x, L - x) / 2``, whose
    integral is ``(L / n pi)^2 sin(n pi / 2)``. The series converge like 1/n^2, so 1000 terms are summed.
    """
    beam = force_beam()
    speed, middle, terms, every = 0.5 * beam.critical_speed, beam.length / 2, 1000, 5
    run = run_force(speed, tail=0.0)
    time = run.time[: int(beam.length / speed / run.settings.time_step) + 1 : every]
    x = speed * time
    n = np.arange(1, terms + 1)
    acceleration = moving_force(beam, speed, time, terms=terms)[2]
    to_moment = (beam.length / (n * np.pi)) ** 2 * np.sin(n * np.pi / 2)
    moment = -FORCE * np.minimum(x, beam.length - x) / 2 - beam.mass * to_moment @ acceleration
    reaction = FORCE * (1 - x / beam.length) + beam.mass * (beam.length / (n * np.pi)) @ acceleration
    histories = run.section_forces(middle)["moment_vertical"], run.reactions()[0.0]["force_z"]
    ours = [h[::every][: len(time)] for h in histories]
    why = "20 modes: those left out answer as if at rest, here they ring undamped"
    case, kilo = "Moving force, alpha = 0.5", 1e-3
    # The reaction starts at P, whatever the speed: its largest later value is compared.
    late = x > beam.length / 4
    pairs = [
        ("largest mid-span moment", "kN m", moment, ours[0], np.ones_like(late), 2e-3),
        ("largest reaction, force past L/4", "kN", reaction, ours[1], late, 2e-2),
    ]
    return [
        Row(case, quantity, unit, _FRYBA, *(float(kilo * np.abs(h[part]).max()) for h in (known, found)), limit, why)
        for quantity, unit, known, found, part, limit in pairs
    ]


def _left_behind(run: Crossing) -> float:
    """Amplitude of the first mode's free vibration after the last axle has left."""
    omega = 2 * np.pi * run.deck.frequencies_hz[0]
    return float(np.hypot(run.state.q[0, -1], run.state.velocity[0, -1] / omega))


def _train_of_forces(speed: float, axles: int, spacing: float, deck: Deck) -> float:
    train = AxleTrain(spacing * np.arange(axles), [FORCE] * axles)
    return _left_behind(cross(train, deck, speed=speed, interaction="rigid", time_step=1e-3, tail=2e-3))


def _axle_train_rows() -> list[Row]:
    r"""Cancellation and resonance of the first mode.

    With Omega = pi v / L and an undamped beam, one force leaves the first mode with the amplitude

        A = (2 P / m L) Omega / (omega |omega^2 - Omega^2|) sqrt(2 + 2 cos(omega L / v)),

    which vanishes at ``omega L / v = (2 j + 1) pi``: v = 2 f L / (2 j + 1), j = 1, 2 ... N forces d apart leave
    ``A |sin(N phi / 2) / sin(phi / 2)|`` with phi = omega d / v: N times A at v = f d / i (Yang, Yau & Hsu 1997).
    """
    beam, source = force_beam(), "closed form (Yang, Yau & Hsu 1997)"
    deck, omega, frequency = beam.deck(1), beam.omega(1), beam.omega(1) / (2 * np.pi)

    def one(speed: float) -> float:
        drive = np.pi * speed / beam.length
        size = np.sqrt(2 + 2 * np.cos(omega * beam.length / speed))
        # The shape of the deck's mode is sqrt(2 / m L) sin(pi x / L).
        return np.sqrt(2 / (beam.mass * beam.length)) * FORCE * drive / (omega * abs(omega**2 - drive**2)) * size

    rows = []
    for j in (1, 2):
        theirs = 2 * frequency * beam.length / (2 * j + 1)
        found = minimize_scalar(
            lambda v: _train_of_forces(v, 1, 1.0, deck) ** 2,
            bounds=(0.97 * theirs, 1.03 * theirs), method="bounded", options={"xatol": 1e-5 * theirs},
        )  # fmt: skip
        why = "searched in crossings; exact but for the sampled load"
        rows.append(
            Row("Axle train", f"cancellation speed 2 f L / {2 * j + 1}", "m/s", source, theirs, float(found.x), 1e-4, why)
        )
    spacing, axles = 18.0, 40
    for i in (1, 2):
        theirs = frequency * spacing / i
        ours = _train_of_forces(theirs, axles, spacing, deck)
        why = "all N forces add up; load sampled every 1 ms"
        at = f"{axles} axles at f d / {i}: amplitude left / one axle's"
        rows.append(Row("Axle train", at, "", source, float(axles), float(ours / one(theirs)), 1e-4, why))
        found = minimize_scalar(
            lambda v: -_train_of_forces(v, axles, spacing, deck),
            bounds=(theirs * (1 - 0.4 / axles / i), theirs * (1 + 0.4 / axles / i)), method="bounded", options={"xatol": 1e-4},
        )  # fmt: skip
        why = "one axle's own curve pulls a finite train's peak by 1/N^2"
        rows.append(Row("Axle train", f"resonance speed f d / {i}", "m/s", source, theirs, float(found.x), 4e-3, why))
    return rows


def run_yang_yau(modes: int = 5, time_step: float = 5e-4) -> Crossing:
    """Cross the beam of `yang_yau` with its sprung mass, as any user would."""
    _, beam, speed = yang_yau()
    train = Train(sprung_mass("sprung mass", 5750.0, 1595e3))
    return cross(train, beam.deck(modes), speed=speed, time_step=time_step, tail=0.1, tolerance=1e-10)


def _yang_yau_rows() -> list[Row]:
    car, beam, speed = yang_yau()
    run = run_yang_yau()
    middle, forces = coupled(car, beam, 5, speed, run.time)
    case, source = "Moving sprung mass (Yang & Yau 1997)", "coupled ODE, scipy DOP853"
    why = "the same 5 modes, step 0.5 ms; compared with the equations, not with a printed value"
    ours = run.displacement(beam.length / 2)["displacement_z"]
    on = run.time < beam.length / speed - 1e-9
    known, found = (-(f[on] + car.static[0]) / car.mass[0, 0] for f in (forces[0], run.wheel_forces[0, 1]))
    return [
        Row(case, "largest mid-span displacement", "mm", source, *(float(1e3 * h.min()) for h in (middle, ours)), 3e-6, why),
        Row(case, "largest upward acceleration of the mass", "m/s2", source, float(known.max()), float(found.max()), 2e-5, why),
        Row(case, "largest downward acceleration of the mass", "m/s2", source, float(known.min()), float(found.min()), 2e-5, why),
    ]


WAVE = 5e-3, 14.4
"""Amplitude and length of the waves under the car in its plane, m."""

CAR_MODES = 5


def run_car(speed: float, modes: int = CAR_MODES, time_step: float = 1e-3) -> Crossing:
    """Cross the 36 m beam with one car in its plane on waves that start at the entrance, as any user would."""
    _, beam = car_in_plane()
    deck = beam.deck(modes, rayleigh(0.03, (3.307, 16.30)))
    track = Track(vertical=Harmonic(WAVE[0], WAVE[1]))
    train = Train(planar_car(vehicle("xia2000")))
    return cross(train, deck, track, speed=speed, time_step=time_step, lead_in=0.0, tail=0.2, tolerance=1e-10)


NEWMARK = {
    20.0: (-5.198523e-3, -3.337180e6, -156.9624e3),
    90.0: (-5.157361e-3, -3.539419e6, -161.1175e3),
}
"""Speed (m/s): largest mid-span displacement (m), moment (N m) and first axle's force (N) of the same crossing by a
finite-element program of its own, car and unreduced beam stepped together by Newmark's method: 20 elements, steps of 1 ms at
20 m/s and 0.5 ms at 90 m/s. It stands beside the tests, which compute these numbers again."""


def _car_rows() -> list[Row]:
    car, beam = car_in_plane()
    rows = []
    for speed in (20.0, 90.0):
        run = run_car(speed)
        theirs, forces = coupled(car, beam, CAR_MODES, speed, run.time, WAVE)
        ours = run.displacement(beam.length / 2)["displacement_z"]
        on = (run.time > 0.01) & (run.time < beam.length / speed - 1e-9)
        why = f"the same {CAR_MODES} modes; step 1 ms"
        case, source = f"Planar car, 6 freedoms, 36 m beam, {speed:g} m/s", "coupled ODE, scipy DOP853"
        pairs = [
            ("largest mid-span displacement", "mm", 1e3 * theirs, 1e3 * ours, 1e-5),
            ("largest force of the first axle", "kN", 1e-3 * forces[0, on], 1e-3 * run.wheel_forces[0, 1, on], 1e-4),
        ]
        rows += [Row(case, q, u, source, float(a.min()), float(b.min()), limit, why) for q, u, a, b, limit in pairs]
        moment = run.section_forces(beam.length / 2)["moment_vertical"]
        found = ours.min(), moment.min(), run.wheel_forces[0, 1, on].min()
        why = f"20 elements and all their modes; ours {CAR_MODES} modes"
        names = [
            ("largest mid-span displacement", "mm", 1e3, 1.5e-4),
            ("largest mid-span moment", "kN m", 1e-3, 2e-3),
            ("largest force of the first axle", "kN", 1e-3, 1e-4),
        ]
        for (name, unit, factor, limit), known, own in zip(names, NEWMARK[speed], found, strict=True):
            source = "finite elements, Newmark"
            rows.append(Row(case, name, unit, source, factor * known, float(factor * own), limit, why))
    return rows


def _at_rest_rows() -> list[Row]:
    r"""A car standing in the middle of the 36 m beam: a crossing at a micrometre a second.

    A force P (down) at x bends a simple beam at mid-span by ``P x (3 L^2 - 4 x^2) / (48 E I)`` for x up to L/2, with the moment
    ``-P x / 2`` there (sagging), and takes ``P (1 - x / L)`` of the bearing at x = 0.
    """
    car, beam = car_in_plane()
    middle = beam.length / 2
    train = Train(planar_car(vehicle("xia2000")))
    deck = beam.deck(20)
    step, speed = 1e4, 1e-6
    run = cross(train, deck, speed=speed, time_step=step, lead_in=0.0, tail=0.0)
    k = round((middle + car.delays[-1] / 2) / (speed * step))
    x = middle + car.delays[-1] / 2 - car.delays
    near = np.minimum(x, beam.length - x)
    deflection = -(car.static * near) @ (3 * beam.length**2 - 4 * near**2) / (48 * beam.bending)
    line = -1e3 * float(deck.recovery.section("displacement_z", middle).influence(x)[:, 0, 1] @ car.static)
    case, source = "A car at rest in mid-span", "statics of a simple beam"
    return [
        Row(case, "displacement by the influence line", "mm", source, 1e3 * deflection, line, 1e-9, "exact"),
        Row(
            case, "displacement in the crossing, 20 modes", "mm", source, 1e3 * deflection,
            float(1e3 * run.displacement(middle)["displacement_z"][k]), 1e-4, "displacements are modal only: the modes left out",
        ),
        Row(
            case, "moment in the crossing, 20 modes", "kN m", source, -float(car.static @ near / 2) / 1e3,
            float(run.section_forces(middle)["moment_vertical"][k] / 1e3), 1e-9, "statically corrected",
        ),
        Row(
            case, "reaction in the crossing, 20 modes", "kN", source, float(car.static @ (1 - x / beam.length)) / 1e3,
            float(run.reactions()[0.0]["force_z"][k] / 1e3), 1e-9, "statically corrected",
        ),
    ]  # fmt: skip


def _two_span_rows() -> list[Row]:
    r"""Continuous beam of two spans a and b: the moments of both spans at the middle bearing are in balance.

    A span pinned at its far end answers a rotation of the near end with the moment ``2 E I k / (cot ka - coth ka)`` to a
    common sign, so the rotation there is free if ``sum (cot ka - coth ka) = 0``; the frequency is ``k^2 sqrt(E I / m)``.
    """
    mass, bending, spans = 12e3, 8.93e10, (20.0, 30.0)

    def balance(k: float) -> float:
        return sum(1 / np.tan(k * a) - 1 / np.tanh(k * a) for a in spans)

    # Between neighbouring poles, the pinned frequencies of either span, the sum falls through zero once.
    poles = sorted({round(n * np.pi / a, 12) for a in spans for n in range(1, 4)})
    roots = [brentq(balance, a * (1 + 1e-9), b * (1 - 1e-9)) for a, b in zip(poles[:-1], poles[1:], strict=True)]
    beam = Beam("two spans", spans, mass, bending, elements=64)
    why = "64 cubic elements: error (k h)^4 / 720"
    rows = []
    for i, k in enumerate(roots[:3], start=1):
        theirs = k**2 * np.sqrt(bending / mass) / (2 * np.pi)
        ours = float(beam.modes.frequencies_hz[i - 1])
        rows.append(Row("Continuous beam, 20 + 30 m", f"frequency {i}", "Hz", "characteristic equation", theirs, ours, 1e-6, why))
    return rows


def _torsion_rows() -> list[Row]:
    r"""A bar held against twist at both ends: frequencies and the twist under an eccentric force P e.

    ``f_n = n / (2 L) sqrt(G J / I)``. All terms have the same speed ratio alpha = v / sqrt(G J / I), so that the twist

        theta = -(2 P e / I L) sum sin(n pi x / L) (sin n Omega t - alpha sin omega_n t) / (omega_n^2 - n^2 Omega^2)

    at mid-span is two waves running from end to end. Statically a couple at mid-span twists it by P e L / (4 G J) there.
    """
    length, stiffness, inertia, lever, speed = 36.0, 8.15e10, 7.02e4, 2.4, 90.0
    beam = Beam("bar", (length,), 12e3, 8.93e10, torsional_stiffness=stiffness, polar_inertia=inertia, elements=80)
    wave, middle, source = np.sqrt(stiffness / inertia), length / 2, "closed form"
    torsional = [f for f, name in zip(beam.modes.frequencies_hz, beam.modes.names, strict=True) if name.startswith("torsion")]
    case, rows = "Torsion bar", []
    for n in (1, 3):
        why = "80 quadratic elements"
        rows.append(Row(case, f"frequency {n}", "Hz", source, n * wave / (2 * length), float(torsional[n - 1]), 1e-6, why))
    deck = beam.deck(16)
    line = deck.recovery.section("rotation_x", middle).influence(np.array([middle]))[0, 0, 2]
    statically = length / (4 * stiffness)
    rows.append(
        Row(case, "twist under a couple, per N m", "1e-12 rad", source, 1e12 * statically, 1e12 * float(line), 1e-9, "exact")
    )
    run = cross(
        AxleTrain([0.0], [FORCE]), deck, speed=speed, track_offset=lever, interaction="rigid", time_step=2e-4, tail=0.0
    )  # fmt: skip
    kept = sum(name.startswith("torsion") for name in deck.mode_names)
    n = np.arange(1, kept + 1)[:, None]
    omega, drive = n * np.pi * wave / length, n * np.pi * speed / length
    time = run.time[run.time <= length / speed]
    swing = (np.sin(drive * time) - drive / omega * np.sin(omega * time)) / (omega**2 - drive**2)
    twist = -2 * FORCE * lever / (inertia * length) * np.sin(n * np.pi / 2).ravel() @ swing
    ours = float(1e3 * run.displacement(middle)["rotation_x"][: len(time)].min())
    why = f"the same {kept} torsion modes; their sum converges like 1/n"
    rows.append(
        Row(case, f"twist under a moving force, {lever:g} m off", "mrad", source, float(1e3 * twist.min()), ours, 1e-4, why)
    )
    return rows


def _damping_rows() -> list[Row]:
    r"""Rayleigh damping by the logarithmic decrement of what a crossing leaves.

    Extremes of a free vibration half a period apart shrink by ``delta = pi zeta / sqrt(1 - zeta^2)``, with
    ``zeta = alpha / (2 omega) + beta omega / 2``; the extremes are found by a parabola through three samples.
    """
    _, beam = car_in_plane()
    deck = beam.deck(8)
    run = cross(AxleTrain([0.0], [FORCE]), deck, speed=50.0, interaction="rigid", time_step=2e-4, tail=4.0)
    rows = []
    for mode, since, spread in ((1, 1.5, 6), (2, 0.1, 6)):
        omega = beam.omega(mode)
        theirs = beam.alpha / (2 * omega) + beam.beta * omega / 2
        # In mid-span the second mode does not move; at a quarter the first one does, so the mode itself is taken there.
        history = run.displacement(beam.length / 2)["displacement_z"] if mode == 1 else run.state.q[1]
        h = history[run.time > beam.length / 50.0 + since]
        k = np.flatnonzero((h[1:-1] - h[:-2]) * (h[2:] - h[1:-1]) < 0) + 1
        k = k[: spread + 1]
        bend = h[k - 1] - 2 * h[k] + h[k + 1]
        peaks = np.abs(h[k] - (h[k + 1] - h[k - 1]) ** 2 / (8 * bend))
        delta = np.log(peaks[0] / peaks[-1]) / spread
        ours = delta / np.sqrt(np.pi**2 + delta**2)
        why = f"{spread} half-periods of free vibration, parabola through the extremes"
        source = "Rayleigh, log decrement"
        rows.append(
            Row("Damping after a crossing", f"ratio of mode {mode}", "%", source, 100 * theirs, float(100 * ours), 1e-4, why)
        )
    return rows


@cache
def cases() -> tuple[Row, ...]:
    """Return every row; about ten seconds the first time."""
    parts = [
        _moving_force_rows, _yang_yau_rows, _car_rows, _axle_train_rows, _at_rest_rows, _two_span_rows, _torsion_rows,
        _damping_rows,
    ]  # fmt: skip
    return tuple(row for part in parts for row in part())


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
def convergence_with_modes(counts: tuple[int, ...] = (1, 3, 5, 9, 17, 33), ratio: float = 0.0) -> tuple[ConvergenceRow, ...]:
    """Return what a force crossing at half the critical speed gives with more and more modes.

    Displacement and moment settle. The acceleration does not: a force that runs onto the beam excites mode n with an
    acceleration that falls only like 1/n, so that every further mode still counts; damping hides it, no more. An acceleration
    therefore means nothing without the cut-off that was used.

    Parameters
    ----------
    counts : tuple of int
    ratio : float
        Damping ratio of every mode.
    """
    beam, rows = force_beam(), []
    speed, middle = 0.5 * beam.critical_speed, beam.length / 2
    for modes in counts:
        deck = beam.deck(modes, ratio, elements=80)
        run = cross(AxleTrain([0.0], [FORCE]), deck, speed=speed, interaction="rigid", time_step=1e-4, tail=0.0)
        values = [
            run.displacement(middle)["displacement_z"],
            run.section_forces(middle)["moment_vertical"],
            run.acceleration(middle)["acceleration_z"],
        ]
        rows.append(ConvergenceRow(modes, float(deck.frequencies_hz[-1]), *(float(np.abs(v).max()) for v in values)))
    return tuple(rows)


def report(rows: Iterable[Row]) -> str:
    """Return rows as text: quantity, theirs, ours, difference, why, under a line for each case."""
    lines, case = [], None
    for row in rows:
        if row.case != case:
            case = row.case
            lines += ["", f"{case:<50} {'theirs':>11} {'ours':>11} {'difference':>10}"]
        name = row.quantity + (f" ({row.unit})" if row.unit else "")
        flag = "" if row.ok else f"  BEYOND ITS LIMIT {row.limit:g}"
        lines.append(f"  {name:<48} {row.theirs:>11.5g} {row.ours:>11.5g} {row.shown:>10}  {row.source}; {row.why}{flag}")
    return "\n".join(lines[1:])


def frame(rows: Iterable[Row]):
    """Return rows as a pandas DataFrame of text: case, source, theirs, ours, difference, why."""
    import pandas as pd

    rows = tuple(rows)
    columns = {
        "case": [f"{r.case}: {r.quantity}" + (f" ({r.unit})" if r.unit else "") for r in rows],
        "source": [r.source for r in rows],
        "theirs": [f"{r.theirs:.5g}" for r in rows],
        "ours": [f"{r.ours:.5g}" for r in rows],
        "difference": [r.shown for r in rows],
        "why": [r.why for r in rows],
    }
    return pd.DataFrame(columns)


def main() -> None:
    """Print the table, and how results settle with the number of modes."""
    print(report(cases()))
    print("\nForce at half the critical speed, no damping: largest values by number of modes")
    print("modes  up to (Hz)  displacement (mm)  moment (kN m)  acceleration (m/s2)")
    for r in convergence_with_modes():
        print(f"{r.modes:>5} {r.cut_off:>11.1f} {1e3 * r.displacement:>18.3f} {r.moment / 1e3:>14.1f} {r.acceleration:>20.2f}")


if __name__ == "__main__":
    main()
