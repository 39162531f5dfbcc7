"""Wheels that pull, leave the rail and land, bearings that lift: named with place and time."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cautions import lifting
from railbridge.cautions.notices import remarks

CAR = rb.vehicle("xia2000")
DECK = rb.deck("viaduct36")
WHEELED = rb.with_wheelsets(rb.planar_car(CAR), mass=1800.0)
SHORT = rb.Track(rb.Harmonic(7e-3, wavelength=2.5))


def said(run):
    return [str(remark) for remark in remarks(run)]


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
    assert lifting._place(x, 36.0) == words


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


def test_a_car_that_carries_nothing_has_no_unloading():
    body = rb.Body("mass", 1e4, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("y",))
    spring = rb.Spring("mass", "rail", (0.0, 0.0, 0.0), (1e6, 0.0), (1e4, 0.0))
    train = rb.Train(rb.Vehicle("lateral", (body,), (spring,), 10.0))
    track = rb.Track(lateral=rb.Harmonic(1e-3, wavelength=10.0))
    run = rb.cross(train, DECK, track, speed=20.0)
    assert np.isnan(run.wheel_unloading).all() and said(run) == []


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
