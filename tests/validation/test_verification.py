"""Known answers: every row of the verification table and the histories behind it.

A finite-element program of its own stands beside them.
"""

import ast
from pathlib import Path

import numpy as np
import pytest
from newmark import crossing

from railbridge import rayleigh, units
from railbridge.validation import references, verification
from railbridge.validation.crossings import WAVE, run_car, run_force
from railbridge.validation.moving_cars import NEWMARK
from railbridge.validation.references import FORCE, car_in_plane, force_beam, moving_force
from railbridge.validation.verification import cases


def label(row):
    return f"{row.case}: {row.quantity} ({row.source})"


@pytest.mark.parametrize("number", range(43))
def test_row_is_within_its_limit(number):
    row = cases()[number]
    numbers = f"theirs {row.theirs:.9g}, ours {row.ours:.9g}"
    assert row.ok, f"{label(row)}: {numbers}, {row.difference:.1e}, limit {row.limit:g}"


def test_rows_are_complete_and_their_limits_tight():
    """The range above counts all of them; each says its source and why."""
    rows = cases()
    assert len(rows) == 43
    assert len({label(r) for r in rows}) == len(rows)
    assert all(r.source and r.why and r.limit for r in rows)
    # Only four kinds of rows differ by nature and not by round-off or the step: high modes left
    # out, and a peak that moves.
    loose = {r.quantity.split(" (")[0].rsplit(" /", 1)[0] for r in rows if r.limit > 2e-4}
    assert loose == {
        "largest mid-span moment",
        "largest reaction, force past L/4",
        "resonance speed f D",
        "twist under a moving force, 2.4 m off, all modes",
    }


def test_report_and_frame_hold_every_row():
    rows = cases()
    text = verification.report(rows)
    assert all(r.quantity in text and r.why in text for r in rows)
    assert "LIMIT" not in text
    frame = verification.frame(rows)
    assert list(frame.columns) == ["case", "source", "theirs", "ours", "difference", "why"]
    assert len(frame) == len(rows)


def test_references_share_the_parameter_file_and_nothing_else():
    tree = ast.parse(Path(references.__file__).read_text(encoding="utf-8"))
    own = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.level]
    assert [(node.module, [name.name for name in node.names]) for node in own] == [
        ("cases", ["shelf"])
    ]
    assert references.GRAVITY == units.G


def test_the_command_prints_the_table_and_how_results_settle(capsys):
    verification.main()
    text = capsys.readouterr().out
    assert verification.report(cases()) in text
    counts = [line.split()[0] for line in text.splitlines()[-6:]]
    assert counts == ["1", "3", "5", "9", "17", "33"]


@pytest.mark.parametrize(("alpha", "ratio"), [(0.2, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, 0.05)])
def test_moving_force_history(alpha, ratio):
    """The whole history, at a point where all modes move, while on the deck and after."""
    beam = force_beam()
    speed, x = alpha * beam.critical_speed, 0.3 * beam.length
    run = run_force(speed, ratio)
    shape = np.sin(np.arange(1, 101) * np.pi * x / beam.length)
    known = shape @ moving_force(beam, speed, run.time, ratio)[0]
    error = np.abs(run.displacement(x)["displacement_z"] - known).max()
    assert error < 3e-5 * np.abs(known).max()


def test_closed_form_of_the_moving_force_solves_its_equation():
    """Velocity and acceleration, differentiated by hand, against differences of the series.

    Damped and at resonance, too.
    """
    beam = force_beam()
    time = np.arange(0.0, 0.6, 1e-4)
    for speed, ratio in [(160.0, 0.0), (160.0, 0.05), (80.0, 0.0)]:
        value, rate, acceleration = moving_force(beam, speed, time, ratio, terms=3)
        inside = slice(1, -1)
        leaving = np.abs(time[inside] - beam.length / speed) > 2e-4
        for derivative, function in [(rate, value), (acceleration, rate)]:
            found = ((function[:, 2:] - function[:, :-2]) / 2e-4)[:, leaving]
            error = np.abs(found - derivative[:, inside][:, leaving]).max()
            assert error < 1e-4 * np.abs(derivative).max()
        assert np.all(value[:, 0] == 0.0) or np.abs(value[:, 0]).max() < 1e-15
        assert np.abs(rate[:, 0]).max() < 1e-12


def test_amplification_at_resonance_is_half_pi_of_the_first_term():
    """At alpha = 1 the first term ends at pi/2 times its static value 96/pi^4 (Fryba)."""
    beam = force_beam()
    leaves = np.array([beam.length / beam.critical_speed])
    first = moving_force(beam, beam.critical_speed, leaves, terms=1)[0]
    assert -first[0, 0] / beam.deflection(FORCE) == pytest.approx(
        np.pi / 2 * 96 / np.pi**4, rel=1e-12
    )


@pytest.mark.parametrize(("speed", "step"), [(20.0, 1e-3), (90.0, 5e-4)])
def test_the_recorded_finite_element_numbers_are_still_what_it_gives(speed, step):
    car, beam = car_in_plane()
    time, middle, moment, forces = crossing(car, beam, speed, WAVE, elements=20, step=step)
    on = (time > 0.01) & (time < beam.length / speed - 1e-9)
    largest = middle.min(), moment.min(), forces[0, on].min()
    assert largest == pytest.approx(NEWMARK[speed], rel=1e-6)
    # Histories, sample by sample; forces jump where an axle meets an end of the deck, which is left
    # out.
    run = run_car(speed, time_step=1e-3)
    every = round(1e-3 / step)
    theirs = middle[::every][: len(run.time)]
    ours = run.displacement(beam.length / 2)["displacement_z"][: len(theirs)]
    assert np.abs(ours - theirs).max() < 4e-4 * np.abs(theirs).max()
    count = len(theirs)
    time, calm = run.time[:count], np.ones(count, dtype=bool)
    for delay in car.delays:
        for event in (delay / speed, (delay + beam.length) / speed):
            calm &= (time < event - 1.5e-3) | (time > event + 0.05)
    dynamic = np.abs(forces + car.static[:, None]).max()
    difference = run.wheel_forces[:, 1, :count] - forces[:, ::every][:, :count]
    assert np.abs(difference[:, calm]).max() < 1e-2 * dynamic


@pytest.mark.parametrize(("speed", "step", "limit"), [(20.0, 1e-3, 2e-4), (90.0, 5e-4, 5e-4)])
def test_moments_are_those_of_the_finite_elements_at_every_sample(speed, step, limit):
    """Elastic and viscous part together; without the second it would be 1e-3 and 5e-3."""
    car, beam = car_in_plane()
    theirs = crossing(car, beam, speed, WAVE, elements=20, step=step)[2][:: round(1e-3 / step)]
    ours = run_car(speed, time_step=1e-3).section_forces(beam.length / 2)["moment_vertical"]
    count = min(len(ours), len(theirs))
    error = np.abs(ours[:count] - theirs[:count]).max()
    assert error < limit * np.abs(theirs).max()


def test_displacement_and_moment_settle_with_the_modes_and_acceleration_does_not():
    rows = verification.convergence_with_modes()
    last, before = rows[-1], rows[-2]
    assert last.displacement == pytest.approx(before.displacement, rel=1e-5)
    assert last.moment == pytest.approx(before.moment, rel=1e-3)
    # What the modes of the last doubling add: nothing, a ten-thousandth, and several percent of the
    # acceleration.
    assert last.acceleration > 1.03 * before.acceleration
    assert last.acceleration > 1.15 * rows[1].acceleration


def test_damping_makes_the_acceleration_settle_with_the_modes():
    """From five modes to 33 it moves by less than 0.3 %, where it grows by 14 % undamped."""
    first = verification.convergence_with_modes((1,))[0].cut_off
    for damping in (0.03, rayleigh(0.03, (first, 4.93 * first))):
        rows = verification.convergence_with_modes(ratio=damping)
        assert rows[-1].acceleration == pytest.approx(rows[2].acceleration, rel=3e-3)
