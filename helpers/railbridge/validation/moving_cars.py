"""Sprung masses and cars on a simple beam: coupled equations, finite elements and statics."""

from __future__ import annotations

import numpy as np

from .crossings import CAR_MODES, WAVE, deck_of, run_car, run_rose, run_standing_car, run_yang_yau
from .references import car_in_plane, coupled_solution, yang_yau
from .rows import Row

__all__ = ["NEWMARK", "ROSE", "car_rows", "rose_rows", "sprung_mass_rows", "standing_car_rows"]

NEWMARK = {
    20.0: (-5.198523e-3, -3.337180e6, -156.9624e3),
    90.0: (-5.157361e-3, -3.538012e6, -161.1175e3),
}
"""Speed (m/s): largest mid-span displacement (m), moment (N m) and first axle's force (N).

Of the crossing `run_car` by a finite-element program of its own, car and unreduced beam stepped
together by Newmark's method: 20 elements, steps of 1 ms at 20 m/s and 0.5 ms at 90 m/s. It stands
beside the tests, which compute these numbers again."""

ROSE = -0.032597347, 0.71946
"""Largest displacement (m) of the middle of a 50 m beam under a wheel on its contact that carries a
mass, and when (s).

By the program ROSE (PlatypusBytes), which keeps the value among its own tests: 2303 kg/m,
E = 2.87 GPa, I = 2.9 m4; wheel of 5750 kg on a contact that gives 9.1e-8 m/N, 3000 kg on 1595e5 N/m
and 1000 N s/m, 100 km/h."""

_COUPLED = "coupled ODE, scipy DOP853"


def sprung_mass_rows() -> list[Row]:
    """Return rows of the moving sprung mass of Yang & Yau."""
    car, beam, speed = yang_yau()
    run = run_yang_yau()
    their_middle, their_forces = coupled_solution(car, beam, 5, speed, run.time)
    our_middle = run.displacement(beam.length / 2, kept_only=True)["displacement_z"]
    on = run.time < beam.length / speed - 1e-9

    def acceleration(force: np.ndarray) -> np.ndarray:
        return -(force[on] + car.static[0]) / car.mass[0, 0]

    their_mass, our_mass = acceleration(their_forces[0]), acceleration(run.wheel_forces[0, 1])
    case = "Moving sprung mass (Yang & Yau 1997)"
    why = "the same 5 modes, step 0.5 ms; compared with the equations, not with a printed value"
    rows = []
    for quantity, unit, theirs, ours, limit in [
        ("mid-span displacement", "mm", 1e3 * their_middle.min(), 1e3 * our_middle.min(), 3e-6),
        ("upward acceleration of the mass", "m/s2", their_mass.max(), our_mass.max(), 2e-5),
        ("downward acceleration of the mass", "m/s2", their_mass.min(), our_mass.min(), 2e-5),
    ]:
        numbers = float(theirs), float(ours)
        rows.append(Row(case, f"largest {quantity}", unit, *numbers, why, _COUPLED, limit))
    return rows


def rose_rows() -> list[Row]:
    """Return rows of a wheel with mass on its contact."""
    run = run_rose()
    value, time = run.displacement(25.0).extreme("displacement_z")
    case, source = "Wheel on its contact, and a mass (ROSE)", "program ROSE, finite elements"
    why = "ours 20 modes, step 0.2 ms"
    return [
        Row(case, name, unit, theirs, ours, why, source, limit)
        for name, unit, theirs, ours, limit in [
            ("largest mid-span displacement", "mm", 1e3 * ROSE[0], 1e3 * value, 1e-5),
            ("its time", "s", ROSE[1], time, 2e-4),
        ]
    ]


def car_rows() -> list[Row]:
    """Return rows of a car in its plane on waves, at two speeds, by two independent solutions."""
    car, beam = car_in_plane()
    units = {
        "mid-span displacement": ("mm", 1e3),
        "mid-span moment": ("kN m", 1e-3),
        "force of the first axle": ("kN", 1e-3),
    }
    rows = []
    middle, sag = beam.length / 2, "mid-span displacement"
    for speed in (20.0, 90.0):
        run = run_car(speed)
        on = (run.time > 0.01) & (run.time < beam.length / speed - 1e-9)
        ours = {
            sag: run.displacement(middle)["displacement_z"].min(),
            "mid-span moment": run.section_forces(middle)["moment_vertical"].min(),
            "force of the first axle": run.wheel_forces[0, 1, on].min(),
        }
        kept = {sag: run.displacement(middle, kept_only=True)["displacement_z"].min()}
        theirs, forces = coupled_solution(car, beam, CAR_MODES, speed, run.time, WAVE)
        # Theirs and the limit of the difference.
        coupled = {
            sag: (theirs.min(), 1e-5),
            "force of the first axle": (forces[0, on].min(), 1e-4),
        }
        newmark = dict(zip(ours, zip(NEWMARK[speed], (5e-5, 5e-5, 1e-4), strict=True), strict=True))
        case = f"Planar car, 6 freedoms, 36 m beam, {speed:g} m/s"
        for source, known, found, why in [
            (_COUPLED, coupled, ours | kept, f"the same {CAR_MODES} modes alone; step 1 ms"),
            (
                "finite elements, Newmark",
                newmark,
                ours,
                f"20 elements and all their modes; ours {CAR_MODES} modes, statically corrected",
            ),
        ]:
            for name, (value, limit) in known.items():
                unit, factor = units[name]
                numbers = float(factor * value), float(factor * found[name])
                rows.append(Row(case, f"largest {name}", unit, *numbers, why, source, limit))
    return rows


def standing_car_rows() -> list[Row]:
    r"""Return rows of a car that stands in the middle of the 36 m beam.

    A force P (down) at x bends a simple beam at mid-span by ``P x (3 L^2 - 4 x^2) / (48 E I)`` for
    x up to L/2, with the moment ``-P x / 2`` there (sagging), and takes ``P (1 - x / L)`` of the
    bearing at x = 0.
    """
    car, beam = car_in_plane()
    middle = beam.length / 2
    modes = 20
    run = run_standing_car(modes)
    # The sample at which the middle of the car is over mid-span.
    front = middle + car.delays[-1] / 2
    k = round(front / (run.settings.speed * run.settings.time_step))
    x = front - car.delays
    near = np.minimum(x, beam.length - x)
    sag = -(car.static * near) @ (3 * beam.length**2 - 4 * near**2) / (48 * beam.bending)
    moment = -car.static @ near / 2
    reaction = car.static @ (1 - x / beam.length)
    line = deck_of(beam, modes).recovery.section("displacement_z", middle).influence(x)[:, 0, 1]
    our_sag = run.displacement(middle)["displacement_z"][k]
    our_moment = run.section_forces(middle)["moment_vertical"][k]
    our_reaction = run.reactions()[0.0]["force_z"][k]
    corrected = "statically corrected"
    crossing = f"in the crossing, {modes} modes"
    rows = []
    for quantity, unit, theirs, ours, why, limit in [
        ("displacement by the influence line", "mm", sag, -line @ car.static, "exact", 1e-9),
        (f"displacement {crossing}", "mm", sag, our_sag, corrected, 1e-9),
        (f"moment {crossing}", "kN m", moment, our_moment, corrected, 1e-9),
        (f"reaction {crossing}", "kN", reaction, our_reaction, corrected, 1e-9),
    ]:
        factor = 1e3 if unit == "mm" else 1e-3
        numbers = float(factor * theirs), float(factor * ours)
        case, source = "A car at rest in mid-span", "statics of a simple beam"
        rows.append(Row(case, quantity, unit, *numbers, why, source, limit))
    return rows
