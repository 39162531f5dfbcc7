"""Crossings whose own numbers are not to be trusted decide nothing."""

from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions import left_open
from railbridge.units import G

L, M = 20.0, 12e3
NEEDS = rb.Requirements(line_speed=37.5, kind="steel")
BY_TRAINS = (
    "deck acceleration", "moment by dynamic analysis", "comfort b_v", "wheel unloading",
    "least reaction of a bearing",
)  # fmt: skip
ROUGH = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=20.0))


def deck(modes=6, damping=0.01):
    # 5.3 Hz at 20 m is within Figure 6.10.
    return rb.Beam("beam", (L,), M, 2.2e10).deck(modes, damping)


def coaches(cars=1):
    return rb.Train(rb.vehicle("xia2000"), cars=cars)


def rows(verdicts):
    return {row.clause.title: row for row in verdicts}


def verdicts(run):
    return [rows(rb.assess_run(run, NEEDS))[name].verdict for name in BY_TRAINS]


@pytest.fixture(scope="module")
def settled():
    return rb.cross(coaches(), deck(), ROUGH, speed=37.5)


def test_a_run_that_has_settled_meets_them(settled):
    assert verdicts(settled) == ["met"] * 5


def test_one_pass_decides_nothing():
    run = rb.cross(coaches(), deck(), ROUGH, speed=37.5, iterations=1)
    assert verdicts(run) == ["cannot decide"] * 5
    row = rows(rb.assess_run(run, NEEDS))["deck acceleration"]
    assert row.value is None and "m/s2 as computed" in row.reason
    assert "iterations = 1" in row.reason and "give more" in row.reason


def test_passes_enough_decide_though_they_were_counted(settled):
    run = rb.cross(coaches(), deck(), ROUGH, speed=37.5, iterations=4)
    assert run.converged is False and left_open(run) < 1e-2
    assert verdicts(run) == ["met"] * 5


def test_an_early_pass_of_a_settled_run_decides_nothing(settled):
    assert verdicts(settled.at(1)) == ["cannot decide"] * 5
    assert verdicts(settled.at(settled.iterations)) == ["met"] * 5


def test_the_rigid_deck_of_a_direct_run_is_not_felt():
    run = rb.cross(coaches(), deck(), ROUGH, speed=37.5, interaction="direct")
    assert verdicts(run) == ["met"] * 5
    found = rows(rb.assess_run(run.at(0), NEEDS))["comfort b_v"]
    assert found.verdict == "cannot decide" and "do not feel the deck" in found.reason


def test_what_did_not_converge_decides_nothing():
    with pytest.raises(rb.NotConvergedError) as caught:
        rb.cross(coaches(), deck(), ROUGH, speed=37.5, max_iterations=1)
    assert verdicts(caught.value.run) == ["cannot decide"] * 5
    reason = rows(rb.assess_run(caught.value.run, NEEDS))["comfort b_v"].reason
    assert "max_iterations = 1" in reason and "direct" in reason


def test_a_loose_tolerance_decides_nothing():
    run = rb.cross(coaches(), deck(), ROUGH, speed=37.5, relaxation=0.1, tolerance=0.5)
    assert run.converged and left_open(run) > 0.1
    assert verdicts(run) == ["cannot decide"] * 5
    assert "tolerance = 0.5" in rows(rb.assess_run(run, NEEDS))["wheel unloading"].reason


def test_a_tolerance_of_displacement_is_held_to_the_forces():
    options = {"speed": 37.5, "tolerance_of": "displacement"}
    run = rb.cross(coaches(), deck(), ROUGH, **options, tolerance=1e-4)
    by_forces = [
        run.coupling.change(new, old)
        for old, new in zip(run.passes[:-1], run.passes[1:], strict=True)
    ]
    ratio = max(by_forces[-1] / by_forces[-2], by_forces[-2] / by_forces[-3])
    assert left_open(run) == pytest.approx(by_forces[-1] * ratio / (1 - ratio))
    assert verdicts(run) == ["met"] * 5


def test_bare_axle_loads_have_nothing_open():
    run = rb.cross(rb.AxleTrain((0.0,), (50e3,)), deck(), speed=45.0, iterations=1)
    assert left_open(run) == 0.0 and verdicts(run)[:2] == ["met"] * 2


def test_beyond_the_limit_it_is_not_decided_either():
    """Further passes may take a value below its limit again."""
    own, needs = deck(), replace(NEEDS, comfort="very good")
    rough = rb.Track(vertical=rb.Harmonic(0.03, wavelength=20.0))
    sure = rb.cross(coaches(), own, rough, speed=37.5)
    assert rows(rb.assess_run(sure, needs))["comfort b_v"].verdict == "not met"
    open_still = rb.cross(coaches(), own, rough, speed=37.5, iterations=1)
    assert rows(rb.assess_run(open_still, needs))["comfort b_v"].verdict == "cannot decide"


def test_over_speeds_what_is_certain_stays_certain():
    heavy = rb.AxleTrain((0.0,), (6e6,))
    trains = {"coaches": coaches(), "heavy": heavy}
    found = rb.assess(deck(), trains, [40.0, 45.0], NEEDS, track=ROUGH, iterations=1)
    row = rows(found.verdicts)["deck acceleration"]
    assert row.verdict == "not met" and row.when.startswith("heavy")
    own = found.per_train()
    for name in BY_TRAINS:
        assert own.loc[("coaches", name), "verdict"] == "cannot decide"
    assert np.isfinite(own.loc[("coaches", "deck acceleration"), "value"])
    light = rb.assess(deck(), coaches(), [40.0, 45.0], NEEDS, track=ROUGH, iterations=1)
    row = rows(light.verdicts)["deck acceleration"]
    assert "2 of 2 crossings" in row.reason and "iterations = 1" in row.reason
    assert rows(rb.assess(deck(), coaches(), [40.0, 45.0], NEEDS, track=ROUGH).verdicts)[
        "deck acceleration"
    ].verdict == "met"  # fmt: skip


def test_a_case_says_so_too():
    case = rb.case("paper").replace({
        "train.cars": 1, "run.iterations": 1, "checks": {"line_speed": 40.0},
    })  # fmt: skip
    found = rows(case.assess(speeds=[40.0]).verdicts)["comfort b_v"]
    assert found.verdict == "cannot decide" and "iterations = 1" in found.reason


def test_a_run_up_too_short_decides_nothing():
    run = rb.cross(coaches(), deck(), ROUGH, speed=37.5, lead_in=15.0)
    assert verdicts(run) == ["cannot decide"] * 5
    assert "lead_in = 15 m" in rows(rb.assess_run(run, NEEDS))["wheel unloading"].reason


def test_a_step_too_coarse_for_the_modes_kept_leaves_their_acceleration_open():
    own = rb.Beam("beam", (L,), M, 2.2e10).deck(6, 0.01)
    # Three modes count, to 47.8 Hz: a period of 21 ms; the others would ask for less than 2 ms.
    fine = rb.cross(coaches(), own, ROUGH, speed=37.5, time_step=6e-3)
    assert verdicts(fine)[0] == "met"
    coarse = rb.cross(coaches(), own, ROUGH, speed=37.5, time_step=8e-3)
    assert verdicts(coarse) == ["cannot decide", "met", "met", "met", "met"]
    reason = rows(rb.assess_run(coarse, NEEDS))["deck acceleration"].reason
    assert "time_step = 0.008 s" in reason
    speeds = rb.assess(own, coaches(), [40.0, 45.0], NEEDS, track=ROUGH, time_step=8e-3)
    assert rows(speeds.verdicts)["deck acceleration"].verdict == "cannot decide"
    # Constant loads are stepped otherwise.
    loads = rb.AxleTrain((0.0,), (10 * G * 1e3,))
    speeds = rb.assess(own, loads, [40.0, 45.0], NEEDS, time_step=8e-3)
    assert rows(speeds.verdicts)["deck acceleration"].verdict == "met"


def test_a_step_too_coarse_for_wheelsets_leaves_their_unloading_open():
    own = rb.with_wheelsets(rb.vehicle("xia2000"), mass=1500.0, roll_inertia=800.0)
    train = rb.Train(own, cars=1)
    coarse = rb.cross(train, deck(), ROUGH, speed=37.5, time_step=1e-3)
    found = rows(rb.assess_run(coarse, NEEDS))
    assert found["wheel unloading"].verdict == "cannot decide"
    assert "time_step = 0.001 s" in found["wheel unloading"].reason
    assert found["comfort b_v"].verdict == "met"
