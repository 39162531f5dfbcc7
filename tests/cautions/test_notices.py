"""What must be known before a result is read."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions.notices import remarks, remarks_before, unsettled
from railbridge.settings import check

CAR = rb.vehicle("xia2000")
DECK = rb.deck("viaduct36")


def said(run):
    return [str(remark) for remark in remarks(run)]


def test_a_plain_crossing_leaves_nothing_to_say():
    track = rb.Track(rb.Harmonic(5e-3, wavelength=14.4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert said(rb.cross(rb.Train(CAR), DECK, track, speed=20.0)) == []


def light(passes):
    """A deck so light that the passes grow."""
    deck = rb.Beam("light", (60.0,), 3e3, 3e10).deck(6, 0.01)
    train = rb.Train(CAR, cars=8)
    return rb.cross(train, deck, speed=60.0, iterations=passes, time_step=4e-3)


def test_passes_that_diverge_are_no_solution():
    with pytest.warns(UserWarning, match="they diverge. These numbers are not a solution"):
        run = light(8)
    assert unsettled(run) and run.changes[-1] > min(run.changes)
    text = next(t for t in said(run) if t.startswith("iterations"))
    assert text.startswith(f"iterations = 8: the last pass still changed the wheel forces by "
                           f"{run.changes[-1]:.2g}, pass ")  # fmt: skip


def test_a_few_passes_that_come_closer_are_told_of_without_a_warning():
    track = rb.Track(rb.Harmonic(5e-3, wavelength=14.4))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = rb.cross(rb.Train(CAR), DECK, track, speed=20.0, iterations=4)
    assert not unsettled(run)
    assert said(run) == [
        f"iterations = 4: the last pass still changed the wheel forces by {run.changes[-1]:.2g} "
        "of their dynamic part."
    ]


def test_a_coarse_step_is_told_of_and_the_step_that_would_do():
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=5e-3)
    (text,) = said(run)
    assert text.startswith("time_step = 0.005 s leaves 1.7 samples in a period of the deck's high")
    most = float(text.split("At most ")[1].split(" s")[0])
    fine = rb.cross(rb.AxleTrain([0.0], [1e5]), DECK, speed=20.0, time_step=0.99 * most)
    assert said(fine) == []


def test_wheelsets_ask_for_a_step_of_their_contacts_and_say_where_it_is_coarse():
    """At 1 ms a wheelset of 195 Hz misses its closed form by the share that is told, 12 %."""
    car = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=1000.0)
    track = rb.Track(rb.Harmonic(5e-4, wavelength=2.0))
    exact = abs(rb.steady_forces(car, track, 40.0)[0, 1])

    def missed(**options):
        run = rb.cross(
            rb.Train(car), DECK, track, speed=40.0, interaction="rigid", lead_in=300.0, **options
        )
        force = run.wheel_forces[0, 1, : len(run.time) // 2]
        return (force.max() - force.min()) / 2 / exact - 1, run

    share, run = missed(time_step=1e-3)
    (text,) = said(run)
    assert text.startswith("time_step = 0.001 s is coarse for wheelsets that bounce on their")
    assert "at 195 Hz" in text and "off by some 12 %" in text
    assert share == pytest.approx(-0.12, abs=0.03)
    most = float(text.split("At most ")[1].split(" s")[0])
    assert said(missed(time_step=0.99 * most)[1]) == []
    share, run = missed()
    assert (
        said(run) == [] and run.settings.time_step < 3e-4 and share == pytest.approx(0, abs=0.012)
    )


def test_rails_that_differ_sideways_are_doubted_below_wheelsets():
    lateral = rb.Rails(left=rb.Harmonic(1e-3, wavelength=9.0), right=rb.Level())
    rolling = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=1000.0)
    options = {"speed": 30.0, "interaction": "rigid", "lead_in": 0.0}
    word = "hold the rails apart"
    for car, track, told in [
        (rolling, rb.Track(lateral=lateral), True),
        (CAR, rb.Track(lateral=lateral), False),
        (rolling, rb.Track(lateral=rb.Harmonic(1e-3, wavelength=9.0)), False),
    ]:
        run = rb.cross(rb.Train(car), DECK, track, **options)
        assert any(word in text for text in said(run)) == told


def test_ends_that_move_spoil_accelerations_and_that_is_said():
    soft = tuple(rb.Bearing(x, ("y", "roll"), stiffness={"z": 2e9}) for x in (0.0, 30.0))
    deck = rb.Beam("soft", (30.0,), 10e3, 5e10, bearings=soft).deck(damping=0.02)
    run = rb.cross(rb.AxleTrain([0.0], [1e5]), deck, speed=40.0)
    assert any(t.startswith("An end of the deck moves") for t in said(run))
    assert not any("forces of wheels with mass" in t for t in said(run))
    for contact in ("permanent", "hertz"):
        run = rb.cross(rb.Train(WHEELED), deck, speed=40.0, contact=contact)
        words = "and the forces of wheels with mass are not to be trusted"
        assert any(words in t for t in said(run))


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_ends_that_move_spoil_the_forces_of_wheels_with_mass_too():
    """A wheel on a stiff contact is lifted onto the end at once; on a bed nothing of it is left."""
    soft = {"fixed": "x y roll", "stiffness": {"z": 2e9}}
    content = {
        "length": 20.0, "mass": 12e3, "bending_stiffness_vertical": 1.2e10, "modes": 6,
        "damping": {"modal": 0.02}, "bearing": [{"x": x, **soft} for x in (0.0, 20.0)],
    }  # fmt: skip
    deck = rb.deck_from_table("elastic", content)
    bed = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    options = {"speed": 20.0, "lead_in": 0.0, "tail": 0.1}
    swings = []
    for own in (deck, replace(deck, rail=bed)):
        run = rb.cross(rb.Train(WHEELED), own, **options)
        load = run.train.wheels[0].static_load
        swings.append(np.abs(run.wheel_forces[:, 1] + load).max() / load)
        told = [t for t in said(run) if "An end of the deck moves" in t]
        assert all("accelerations and the forces of wheels with mass are not" in t for t in told)
        assert len(told) == (own is deck)
    assert swings[0] > 1.0 and swings[1] < 0.05
    (text,) = (t for t in said(rb.cross(rb.Train(CAR), deck, **options)) if "An end" in t)
    assert "so accelerations are not" in text


WHEELED = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0)
SHORT = rb.Track(rb.Harmonic(7e-3, wavelength=2.5))


def test_the_way_that_auto_took_is_told():
    level = {"speed": 60.0, "lead_in": 0.0, "tail": 0.1}
    run = rb.cross(rb.Train(WHEELED), DECK, **level)
    assert run.settings.interaction == "direct"
    (text,) = (t for t in said(run) if "auto" in t)
    assert (
        "interaction = auto: solved directly, since wheels stand on stiff contacts (195 Hz)."
        in text
    )
    asked = rb.cross(rb.Train(WHEELED), DECK, interaction="direct", **level)
    assert not any("auto" in t for t in said(asked))


@pytest.mark.parametrize("contact", ["permanent", "hertz"])
def test_wheelsets_do_not_make_a_settled_run_up_look_transient(contact):
    car = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0)
    track = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=3.0))
    for lead_in, told in ((5.0, True), (150.0, False)):
        options = {"speed": 40.0, "lead_in": lead_in, "contact": contact, "interaction": "direct"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            run = rb.cross(rb.Train(car), DECK, track, **options)
        assert any("transient" in text for text in said(run)) == told


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_wheels_with_mass_are_told_of_the_break_at_the_ends_of_a_deck():
    """Told is V theta sqrt(k m), which comes without a damper; a rail on a bed ends it."""
    options = {"speed": 40.0, "lead_in": 0.0, "tail": 0.2}
    run = rb.cross(rb.Train(WHEELED), DECK, **options)
    (text,) = (t for t in said(run) if "meet a break" in t)
    told = float(text.partition("up to about ")[2].partition(" kN")[0])
    found = np.abs(run.wheel_forces[:, 1] + run.train.wheels[0].static_load).max() / 1e3
    assert 0.6 * told < found < told
    bed = rb.Rail(bending_stiffness=1.28e7, foundation=1e8)
    railed = rb.cross(rb.Train(WHEELED), replace(DECK, rail=bed), **options)
    assert not any("meet a break" in t for t in said(railed))
    assert not any("meet a break" in t for t in said(rb.cross(rb.Train(CAR), DECK, **options)))


def test_a_track_that_begins_at_once_is_told_of_below_wheels_with_mass():
    deck = replace(DECK, rail=rb.Rail(bending_stiffness=1.28e7, foundation=1e8))
    waves, options = rb.Track(rb.Harmonic(1e-3, wavelength=3.0)), {"speed": 60.0, "tail": 0.1}
    slope = 2 * np.pi * 1e-3 / 3.0
    massless = rb.planar_car(CAR)
    for car, lead_in, told in ((WHEELED, 0.0, 1), (WHEELED, 60.0, 0), (massless, 0.0, 0)):
        settings = check(rb.Train(car), deck, waves, lead_in=lead_in, **options)
        found = [
            str(r) for r in remarks_before(rb.Train(car), deck, waves, settings)
            if "begins at x = 0" in str(r)
        ]  # fmt: skip
        assert len(found) == told
        if told:
            blow = 60.0 * slope * np.sqrt(WHEELED.contact_stiffness[0, 1] * 1800.0)
            assert (
                f"slope of {1e3 * slope:.2g} mrad" in found[0]
                and f"{blow / 1e3:.3g} kN" in found[0]
            )
            run = rb.cross(rb.Train(car), deck, waves, lead_in=lead_in, **options)
            assert found[0] in said(run)
            # It is that much: an axle with its mass alone, soon after it met the slope.
            first = run.wheel_forces[0, 1][(run.time >= 0.0) & (run.time < 0.01)]
            static = WHEELED.contacts[0].static_load
            assert np.abs(first + static).max() == pytest.approx(blow, rel=0.1)


@pytest.mark.parametrize("interaction", ["direct", "rigid", "iterate"])
def test_passes_asked_for_where_none_are_made_are_told_of(interaction):
    given = {"iterations": 4, "relaxation": 0.5, "interaction": interaction}
    run = rb.cross(rb.Train(CAR), DECK, speed=20.0, tail=0.0, **given)
    expected = [
        f"iterations = 4: has no effect with interaction = '{interaction}'.",
        f"relaxation = 0.5: has no effect with interaction = '{interaction}'.",
    ]
    found = [text for text in said(run) if "has no effect" in text]
    assert found == (expected if interaction != "iterate" else [])
