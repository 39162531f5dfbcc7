"""A car over waves: what is drawn is what is known, in every frame."""

import json
import re
from html import unescape

import numpy as np
import pytest

import railbridge as rb
from railbridge.plots import animate_car_on_waves, animate_rigid_and_flexible
from railbridge.steady import steady_motion

CAR = rb.vehicle("xia2000")
WAVE = rb.Harmonic(5e-3, 14.4)
FILE_BYTES = 150_000
QUICK = {"run.time_step": 4e-3, "run.iterations": 2, "train.cars": 2, "run.loads": "wheels"}


def data(animation):
    return json.loads(re.search(r"const D = (\{.*\});\n", animation.html).group(1))


def words(animation):
    return unescape(re.search(r'<img alt="([^"]*)"', animation.html).group(1))


@pytest.fixture(scope="module")
def riding():
    return animate_car_on_waves(CAR, WAVE, 20.0)


@pytest.fixture(scope="module")
def run():
    return rb.case("paper").replace(QUICK).run()


@pytest.fixture(scope="module")
def twice(run):
    return animate_rigid_and_flexible(run, frames=60)


def exaggeration(animation):
    return float(animation.title.rsplit(", ", 1)[1].split()[0])


def numbers(animation, per_metre):
    """What moves the parts, m, shape (numbers, frames), and corners at rest (px) with weights."""
    return np.array(data(animation)["H"]) / per_metre


def scale_of(animation):
    """px per m along the track, from the distance of the outer wheels."""
    wheels = [p for p in data(animation)["parts"] if len(p["x"]) == 24][:4]
    middles = [np.mean(wheel["x"]) for wheel in wheels]
    return (middles[0] - middles[-1]) / 18.1


def test_the_plain_text_says_what_it_is(riding, twice):
    assert repr(riding) == (
        "Animation: car on waves of 14.4 m and 5 mm at 20 m/s, 30 times too large, 48 frames"
    )
    assert repr(twice) == (
        "Animation: car 1 on a rigid deck and on viaduct36 at 20 m/s, 50 times too large, 60 frames"
    )


def test_they_are_small_and_say_how_large_they_draw(riding, twice, run):
    for animation in (riding, twice, animate_rigid_and_flexible(run)):
        assert len(animation.html) < FILE_BYTES
        assert f"drawn {exaggeration(animation):g} times too large" in words(animation)


def test_the_wheels_stand_on_the_waves_and_the_body_moves_as_the_steady_solution(riding):
    per_metre = scale_of(riding) * exaggeration(riding)
    moved = numbers(riding, per_metre)
    turn = np.arange(49) / 48
    motion = steady_motion(CAR, rb.Track(vertical=WAVE), 20.0)
    for row, name in ((0, "front bogie z"), (2, "rear bogie z"), (4, "car z")):
        exact = (motion[name] * np.exp(2j * np.pi * turn)).imag
        assert moved[row] == pytest.approx(exact, abs=0.06 / per_metre), name
    for row, axle in zip(moved[6:], CAR.axles, strict=True):
        assert row == pytest.approx(WAVE.value(14.4 * turn + axle.x), abs=0.06 / per_metre)
    bounce = 1e3 * abs(motion["car z"])
    assert f"The middle of the car body moves {bounce:.3g} mm up and down." in words(riding)
    assert data(riding)["said"][1]["mm"][:48] == pytest.approx(
        (1e3 * motion["car z"] * np.exp(2j * np.pi * turn[:48])).imag, abs=0.01
    )


def test_a_nose_down_pitch_lowers_the_front(riding):
    """Pitch is positive nose down: at rest in front, less than the middle."""
    drawn = data(riding)
    body = [p for p in drawn["parts"] if len(p["x"]) == 4][-1]
    front = np.array(body["x"]) > np.mean(body["x"])
    (middle, _), (ends, weights) = body["by"]
    assert np.array(weights)[front] == pytest.approx(1.0) and middle == ends - 1
    motion = steady_motion(CAR, rb.Track(vertical=WAVE), 20.0)["car pitch"]
    pitch = (motion * np.exp(2j * np.pi * np.arange(49) / 48)).imag
    assert np.corrcoef(drawn["H"][ends], -pitch)[0, 1] > 0.999


def test_a_wave_later_all_begins_again(riding):
    moved = np.array(data(riding)["H"])
    assert np.allclose(moved[:, 0], moved[:, -1], atol=0.11)
    along, rail = data(riding)["along"], np.array(data(riding)["rail"])
    assert 48 * along[1] == pytest.approx(-14.4 * scale_of(riding), rel=1e-3)
    assert rail.shape == (48, 49)


def test_above_the_deck_is_rigid_below_it_gives(run, twice):
    per_metre = scale_of(twice) * exaggeration(twice)
    moved = numbers(twice, per_metre)
    when = np.array(data(twice)["time"]) @ [np.ones(60), np.arange(60)]
    for first, shown in ((0, run.at(0)), (10, run)):
        own = shown.car_motion(1)
        exact = np.interp(when, run.time, own["car z"])
        assert moved[first + 4] == pytest.approx(exact, abs=4e-4)
    place = 20.0 * when - run.train.car(1).axles[0].delay
    assert moved[6] == pytest.approx(WAVE.value(place), abs=2e-4)
    on = (place > 1.0) & (place < 35.0)
    given = (moved[16] - moved[6])[on]
    below = [
        float(np.interp(t, run.time, sag["displacement_z"] + 2.4 * sag["rotation_x"]))
        for t, sag in ((t, run.displacement(x)) for t, x in zip(when[on], place[on], strict=True))
    ]
    assert run.settings.track_offset == 2.4 and np.min(below) < -3e-3
    assert given == pytest.approx(below, abs=3e-4)
    assert not (moved[16] - moved[6])[place > 36.0].any()
    bodies = [1e3 * shown.car_motion(1)["car z"] for shown in (run.at(0), run)]
    inside = run.time < when[-1]
    differ = np.abs(bodies[1] - bodies[0])[inside].max()
    said = float(words(twice).split("differ by at most ")[1].split()[0])
    assert said == pytest.approx(differ, abs=0.1)


def test_a_rail_without_waves_and_a_vehicle_of_one_wheel():
    level = animate_car_on_waves(CAR, rb.Harmonic(0.0, 14.4), 20.0, frames=4)
    assert exaggeration(level) == 1.0 and not np.array(data(level)["H"]).any()
    mass = animate_car_on_waves(rb.sprung_mass("m", 5e3, 1e6, 2e4), WAVE, 20.0, frames=4)
    assert len(data(mass)["H"]) == 3


def test_short_waves_are_drawn_as_waves():
    """A crossing may have waves of 3 m, twelve on the deck: the rail has points enough for them."""
    waves = {"track.vertical.wavelength": 3.6, "track.lateral.wavelength": 3.6}
    twice = animate_rigid_and_flexible(rb.case("paper").replace({**QUICK, **waves}).run())
    rail = next(line for line in data(twice)["lines"] if np.ptp(line["y"]) > 0.0)
    turns = np.diff(np.sign(np.diff(rail["y"])))
    assert np.count_nonzero(turns) == 20 and len(twice.html) < FILE_BYTES
    riding = animate_car_on_waves(CAR, rb.Harmonic(1e-3, 3.6), 20.0)
    assert len(data(riding)["rail"][0]) == 97 and len(riding.html) < FILE_BYTES


@pytest.mark.parametrize("name", ["xia2000", "sprung_mass"])
def test_every_wheel_and_body_has_a_part(name):
    vehicle = rb.vehicle(name)
    parts = data(animate_car_on_waves(vehicle, WAVE, 20.0, frames=4))["parts"]
    assert sum(len(p["x"]) == 24 for p in parts) == len(vehicle.axles)
    assert sum(len(p["x"]) == 4 for p in parts) == len(vehicle.bodies)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda run: animate_car_on_waves(CAR, rb.Level(), 20.0), "wave.*Harmonic"),
        (lambda run: animate_car_on_waves(CAR, WAVE, -1.0), "speed = -1"),
        (lambda run: animate_car_on_waves(CAR, WAVE, 20.0, frames=3), "frames = 3"),
        (lambda run: animate_rigid_and_flexible(run.at(0)), "interaction.*iterate"),
        (lambda run: animate_rigid_and_flexible(run, car=3), "car = 3"),
        (lambda run: animate_rigid_and_flexible(run, frames=601), "frames = 601"),
    ],
)
def test_what_cannot_be_shown_is_refused_in_words(make, message, run):
    with pytest.raises(rb.InputError, match=message):
        make(run)


def test_wheels_that_meet_the_rail_in_phase_are_refused():
    run = rb.case("paper").replace({**QUICK, "run.excitation": "car"}).run()
    with pytest.raises(rb.InputError, match="excitation"):
        animate_rigid_and_flexible(run)
    bare = rb.cross(rb.AxleTrain([0.0], [1e5]), run.deck, speed=20.0, time_step=4e-3)
    with pytest.raises(rb.InputError, match="bare axle loads|rigid"):
        animate_rigid_and_flexible(bare)
