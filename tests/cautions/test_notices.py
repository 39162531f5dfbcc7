"""What must be known before a result is read."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions import notices
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


def test_a_wheel_that_pulls_is_named_with_place_and_time():
    track = rb.Track(rb.Harmonic(20e-3, wavelength=2.5))
    with pytest.warns(UserWarning, match="it would lift off"):
        run = rb.cross(rb.Train(CAR), DECK, track, speed=60.0, lead_in=100.0)
    text = next(t for t in said(run) if "pulls" in t)
    i, k = np.unravel_index(np.argmax(run.wheel_unloading), run.wheel_unloading.shape)
    wheel, force = run.train.wheels[i], run.wheel_forces[i, 1, k]
    assert force > 0.0
    assert text.startswith(
        f"Wheel {wheel.number} of car 1 pulls on the rail by {force / 1e3:.3g} kN (unloading "
    )
    assert f" at t = {run.time[k]:.4g} s, " in text


@pytest.mark.parametrize(
    ("x", "words"),
    [(-0.5, "0.5 m before the deck"), (0.0, "at x = 0 m"), (0.5, "at x = 0.5 m"),
     (36.0, "at x = 36 m"), (36.5, "0.5 m behind the deck")],
)  # fmt: skip
def test_places_are_told_from_the_deck(x, words):
    assert notices._place(x, 36.0) == words


def test_a_bearing_that_would_hold_the_deck_down_is_named():
    """Two spans, one loaded: the far end of the light one is lifted."""
    deck = rb.Beam("two", (10.0, 40.0), 2e3, 4e10).deck(damping=0.02)
    with pytest.warns(UserWarning, match="it would lift"):
        run = rb.cross(rb.AxleTrain([0.0, 3.0], [2e5, 2e5]), deck, speed=20.0)
    (text,) = (t for t in said(run) if "Bearing" in t)
    history = run.bearing_forces(self_weight=True)[1]
    low, t = history.extremes("force_z")[0]
    assert text.startswith(
        f"Bearing 1 at x = 0, y = 0 m would have to hold the deck down by {-low / 1e3:.3g} kN at "
        f"t = {t:.4g} s, its own weight counted"
    )
    heavy = rb.Beam("two", (30.0, 30.0), 2e4, 4e10).deck(damping=0.02)
    run = rb.cross(rb.AxleTrain([0.0, 3.0], [2e4, 2e4]), heavy, speed=20.0)
    assert not [t for t in said(run) if "Bearing" in t]


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


def test_a_car_that_carries_nothing_has_no_unloading():
    body = rb.Body("mass", 1e4, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("y",))
    spring = rb.Spring("mass", "rail", (0.0, 0.0, 0.0), (1e6, 0.0), (1e4, 0.0))
    train = rb.Train(rb.Vehicle("lateral", (body,), (spring,), 10.0))
    track = rb.Track(lateral=rb.Harmonic(1e-3, wavelength=10.0))
    run = rb.cross(train, DECK, track, speed=20.0)
    assert np.isnan(run.wheel_unloading).all() and said(run) == []


WHEELED = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0)
SHORT = rb.Track(rb.Harmonic(7e-3, wavelength=2.5))


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_a_wheel_that_leaves_the_rail_is_named_with_place_and_time():
    options = {"speed": 60.0, "lead_in": 60.0, "tail": 0.1, "time_step": 1e-3}
    run = rb.cross(rb.Train(WHEELED), DECK, SHORT, contact="hertz", **options)
    (text,) = (t for t in said(run) if "leaves the rail" in t)
    off = run.parted
    samples = max(
        len(part) for row in off for part in "".join("x" if o else " " for o in row).split()
    )
    assert f"leaves the rail for {samples:g} ms at t = " in text and "of car 1" in text
    heaviest = -run.wheel_forces[:, 1].min()
    assert f"presses with {heaviest / 1e3:.3g} kN at t = " in text
    times = heaviest / run.train.wheels[0].static_load
    assert times > 2.0 and f"{times:.3g} times its load at rest: an upper bound" in text
    pulled = rb.cross(rb.Train(WHEELED), DECK, SHORT, **options)
    (text,) = (t for t in said(pulled) if "pulls on the rail" in t)
    assert text.endswith("it would lift off, which contact = 'hertz' computes.")


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
@pytest.mark.parametrize("damping", [0.0, 1e5])
def test_a_wheel_that_bounces_without_a_damper_is_doubted(damping):
    """A flat: later blows of an undamped contact double and halve with the time step."""
    car = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0, contact_damping=damping)
    flat = rb.Notch(((1, 1),), circumference=2.89, offset=9.0, depth=1e-3, length=0.05)
    options = {"speed": 20.0, "lead_in": 0.0, "tail": 0.0, "contact": "hertz"}
    blows = []
    for step in (1.25e-4, 1e-4, 8e-5):
        run = rb.cross(rb.Train(car, notches=(flat,)), DECK, time_step=step, **options)
        force = -run.wheel_forces[0, 1]
        blows.append((force[20.0 * run.time < 9.1].max(), force.max()))
        (text,) = (t for t in said(run) if "leaves the rail" in t)
        assert ("has no damper" in text) == (damping == 0.0)
    first, last = np.transpose(blows)
    assert first.max() < 1.05 * first.min()
    assert (last.max() > 1.1 * last.min()) == (damping == 0.0)


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_a_landing_asks_for_a_finer_step_and_is_told_how_far_it_is_off():
    car = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0, contact_damping=1e5)
    track = rb.Track(vertical=rb.Harmonic(5e-3, wavelength=2.5))
    options = {"speed": 60.0, "lead_in": 60.0, "tail": 0.1, "contact": "hertz"}
    found, told = [], []
    for step in (5e-4, 2.5e-4, 1e-4):
        run = rb.cross(rb.Train(car), DECK, track, time_step=step, **options)
        assert run.parted.any()
        found.append(-run.wheel_forces[:, 1].min())
        told.append([t for t in said(run) if "on landing" in t])
    assert told[2] == []
    for force, (text,) in zip(found[:2], told[:2], strict=True):
        share = float(text.partition("off by some ")[2].partition(" %")[0]) / 100
        assert 0.5 * share < abs(force / found[2] - 1.0) < 1.5 * share
        assert text.startswith("time_step = ") and "At most 0.00019 s would do" in text
    pressed = rb.Track(vertical=rb.Harmonic(1e-3, wavelength=2.5))
    run = rb.cross(rb.Train(car), DECK, pressed, time_step=5e-4, **options)
    assert not any("on landing" in t for t in said(run))


@pytest.mark.filterwarnings("ignore::railbridge.ResultWarning")
def test_lateral_forces_of_wheels_off_the_rail_are_doubted():
    car = rb.with_wheelsets(CAR, mass=1800.0, roll_inertia=900.0, contact_damping=5e4)
    flat = rb.Notch(((1, 1),), circumference=2.89, offset=9.0, depth=1e-3, length=0.05)
    options = {"speed": 20.0, "lead_in": 30.0, "tail": 0.0, "contact": "hertz"}
    for lateral in (2e-3, 0.0):
        track = rb.Track(lateral=rb.Harmonic(lateral, wavelength=14.4))
        run = rb.cross(rb.Train(car, notches=(flat,)), DECK, track, **options)
        held = np.abs(run.wheel_forces[:, 0][run.parted]).max() / 1e3
        (text,) = (t for t in said(run) if "leaves the rail" in t)
        assert ("Sideways the springs" in text) == (lateral > 0.0)
        assert (f"by up to {held:.3g} kN" in text) == (lateral > 0.0)


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
