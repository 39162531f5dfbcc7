"""What jumps between two samples, and what the modes left out do."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import statics
from railbridge.statics import _breaks

CAR = rb.vehicle("xia2000")


def four_cars(modes, time_step, speed=80.0):
    """The paper's deck and waves under four condensed cars."""
    return rb.case("paper").replace({
        "deck.modes": modes, "train.cars": 4, "run.speed": speed, "run.time_step": time_step,
        "run.lead_in": 100.0,
    }).compute()  # fmt: skip


def test_a_reaction_jumps_by_the_axle_that_steps_on():
    """A force P enters at x = 0 between two samples: the bearing there takes all of it at once."""
    deck = rb.Beam("deck", (30.0,), 10e3, 5e10).deck(damping=0.02)
    speed, step, load = 50.0, 7.3e-3, 1e5
    run = rb.cross(
        rb.AxleTrain([0.0, 20.0], [load, load]), deck, speed=speed, time_step=step,
        interaction="rigid",
    )  # fmt: skip
    history = run.reactions()[0.0]
    time, values = history.jumps("force_z")
    for delay in (0.0, 20.0):
        before, after = values[np.argsort(np.abs(time - delay / speed), kind="stable")[:2]]
        assert after - before == pytest.approx(load, rel=1e-6)
    # No sample meets the second axle at the bearing: the nearest is 0.18 m behind it.
    assert history.extreme("force_z")[0] > history["force_z"].max() * 1.003


@pytest.mark.parametrize("quantity", ["force_z", "moment_x"])
def test_a_coarse_step_meets_the_extreme_of_a_line_that_jumps_as_a_fine_one_does(quantity):
    coarse, fine = (four_cars(20, step) for step in (1e-3, 1e-4))
    for x in (0.0, 36.0):
        known = np.abs(fine.reactions()[x][quantity]).max()
        ours = abs(coarse.reactions()[x].extreme(quantity)[0])
        # A condensed couple that steps onto an end is a peak without a limit: the step decides.
        limit = 1.5e-2 if (quantity, x) == ("force_z", 0.0) else 1e-3
        assert ours == pytest.approx(known, rel=limit)
    sampled = np.abs(coarse.reactions()[36.0]["force_z"]).max()
    assert sampled < 0.9985 * fine.reactions()[36.0].extreme("force_z")[0]


def test_torsion_and_reaction_are_steady_from_twenty_modes_on():
    """Four condensed cars at 80 m/s. An unreduced model with inner twist freedoms gives
    2 055.5 kN m at the instant the third car leaves, and a reaction of 969.7 kN."""
    runs = [four_cars(modes, 1e-3) for modes in (20, 40, 80)]
    torsion = [run.section_forces(36.0).extreme("torsion")[0] / 1e3 for run in runs]
    assert torsion == pytest.approx([2055.5] * 3, rel=4e-3)
    assert np.all(np.diff(torsion) > 0.0)
    force = [run.reactions()[36.0].extreme("force_z")[0] / 1e3 for run in runs]
    assert force == pytest.approx([969.7] * 3, rel=3e-4)
    # At the samples alone, the step decides by 2 parts in a thousand, the modes by less.
    sampled = [run.section_forces(36.0)["torsion"].max() / 1e3 for run in runs]
    assert np.ptp(sampled) < 3e-3 * sampled[0]
    assert sampled[2] - sampled[1] < sampled[1] - sampled[0]


def test_twist_has_the_flexibility_of_the_modes_left_out():
    """Twenty modes of the paper's deck lack 0.6 % of the twist under wheels, three lack 10 %."""
    few, many = (
        rb.case("paper").replace({
            "deck.modes": modes, "train.cars": 1, "run.loads": "wheels", "run.speed": 30.0,
            "run.time_step": 1e-3,
        }).compute()
        for modes in (20, 160)
    )  # fmt: skip
    corrected, kept = (
        abs(few.displacement(18.0, kept_only=only).extreme("rotation_x")[0])
        for only in (False, True)
    )
    known = abs(many.displacement(18.0).extreme("rotation_x")[0])
    assert corrected == pytest.approx(known, rel=5e-4)
    assert kept == pytest.approx(known, rel=2e-2) and kept < 0.996 * known


def test_the_breaks_of_an_influence_line_are_its_ends_and_the_section():
    recovery = rb.deck("viaduct36").recovery
    assert _breaks(recovery.section("moment_vertical", 13.3), 36.0) == pytest.approx([0, 13.3, 36])
    assert _breaks(recovery.section("torsion", 13.3), 36.0) == pytest.approx([0, 13.3, 36])
    assert _breaks(recovery.reaction("force_z", 0.0), 36.0) == pytest.approx([0, 36])
    two = rb.Beam("two", (20.0, 30.0), 10e3, 5e10).deck().recovery
    assert _breaks(two.section("moment_vertical", 13.3), 50.0) == pytest.approx([0, 13.3, 50])


def test_a_cubic_between_samples_is_met():
    t = np.arange(5.0)
    values, rates = t**3 - 2.0 * t, 3.0 * t**2 - 2.0
    k, s = np.array([0, 1, 3]), np.array([0.25, 0.5, 0.9])
    found = statics._hermite(np.stack([values, -values]), np.stack([rates, -rates]), k, s)
    known = (k + s) ** 3 - 2.0 * (k + s)
    assert found == pytest.approx(np.stack([known, -known]), rel=1e-12)
    assert statics._between(values, k, s) == pytest.approx((1 - s) * values[k] + s * values[k + 1])


def test_shapes_taken_a_few_at_a_time_give_the_same(monkeypatch):
    whole = four_cars(20, 4e-3).reactions()[36.0].jumps("force_z")
    monkeypatch.setattr(statics, "_LARGEST", 10_000)
    few = four_cars(20, 4e-3).reactions()[36.0].jumps("force_z")
    assert np.array_equal(whole[0], few[0]) and len(whole[0]) >= 16
    assert few[1] == pytest.approx(whole[1], rel=1e-9, abs=1e-3)


def test_loads_taken_a_few_at_a_time_drive_each_mode_once(monkeypatch):
    moving = four_cars(20, 4e-3)._loads
    x, when = np.linspace(1.0, 35.0, 29), np.arange(29) % 4
    load = np.arange(5 * 29, dtype=float).reshape(29, 5)
    whole = moving._modal_force(load, x, when, 4)
    monkeypatch.setattr(statics, "_LARGEST", 48 * len(whole) * 10)
    assert moving._modal_force(load, x, when, 4) == pytest.approx(whole, rel=1e-12)


def test_what_happens_at_a_jump_is_told_by_the_summary():
    case = rb.case("paper").replace({"train.cars": 1, "run.speed": 80.0, "run.lead_in": 100.0})
    run = case.compute()
    summary = case.summary(run)
    told = summary["reactions"][1]["force_z"]["max"]
    assert (told["value"], told["t"]) == pytest.approx(run.reactions()[36.0].extreme("force_z"))
    stations = summary["envelope"]["torsion"]["stations"]
    ends = [run.section_forces(x).extremes("torsion") for x in (0.0, 36.0)]
    assert [stations["max"][0], stations["max"][-1]] == pytest.approx([e[1][0] for e in ends])
