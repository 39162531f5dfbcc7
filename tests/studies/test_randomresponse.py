"""The exact variance against realisations, each of which is a crossing by itself."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import railbridge as rb
from railbridge.studies import ensembles

SPEED = 25.0
NAME = "displacement_z at 18 m"
ACCELERATION = "acceleration_z at 18 m"
WHEEL = "wheel_force_z of car 1, wheel 2"


@pytest.fixture(scope="module")
def train():
    return rb.Train(rb.vehicle("xia2000"), cars=2, car_spacing=22.5)


@pytest.fixture(scope="module")
def deck():
    return rb.deck("viaduct36")


@pytest.fixture(scope="module")
def response(train, deck):
    track = rb.RandomTrack("german-low", band=(3, 100), seed=40, period=250.0)
    return rb.random_response(
        train, deck, track, quantities=("displacement_z", "acceleration_z"), wheels_of=(1,),
        speed=SPEED, track_offset=2.4, time_step=2e-3,
    )  # fmt: skip


@pytest.mark.parametrize("number", [1, 3])
def test_a_realisation_is_a_crossing_of_that_track(response, train, deck, number):
    track = response.ensemble(3).of(number)
    endless = {
        direction: rb.Rails(
            *(replace(track.rail(direction, side), period=np.inf) for side in ("left", "right"))
        )
        for direction in ("vertical", "lateral")
    }
    options = {"speed": SPEED, "track_offset": 2.4, "time_step": 2e-3, "interaction": "direct"}
    run = rb.cross(train, deck, rb.Track(**endless), lead_in=60 * SPEED, **options)
    known = {
        NAME: run.displacement(18.0)["displacement_z"],
        ACCELERATION: run.acceleration(18.0)["acceleration_z"],
        WHEEL: run.wheel_force(1, 2)["force_z"],
    }
    for name, values in known.items():
        found = response.history(name, track.seed)
        values = values[int(round(response.time(name)[0] / 2e-3)) :][: len(found)]
        size = np.abs(values - response.mean(name)).max()
        assert np.abs(found - values).max() < 1e-5 * size, name


def test_the_usual_run_up_leaves_a_per_mille(response, train, deck):
    track = replace(response.ensemble(2).of(2), period=None)
    response = rb.random_response(
        train, deck, replace(track, period=300.0), speed=SPEED, track_offset=2.4, time_step=2e-3
    )
    run = rb.cross(train, deck, response.track, speed=SPEED, track_offset=2.4, time_step=2e-3)
    found, known = response.history(NAME, track.seed), run.displacement(18.0)["displacement_z"]
    dynamic = np.abs(known - response.mean(NAME)).max()
    assert np.abs(found - known).max() < 5e-3 * dynamic


def test_four_hundred_realisations_lie_in_their_own_band(response):
    count = 400
    for name in (NAME, ACCELERATION, WHEEL):
        # Places in time so far apart that they count as several answers.
        own = slice(100, None, 150)
        found = np.array([response.history(name, seed)[own] for seed in range(count)])
        exact, mean = response.sigma(name)[own], response.mean(name)[own]
        moving = exact > 0.02 * exact.max()
        ratio = (np.var(found, axis=0, ddof=1) / exact**2)[moving]
        low, high = stats.chi2.ppf([0.025, 0.975], count - 1) / (count - 1)
        within = np.mean((ratio > low) & (ratio < high))
        assert within > 0.8, name
        widest = stats.chi2.ppf([1e-6, 1 - 1e-6], count - 1) / (count - 1)
        assert widest[0] < ratio.min() and ratio.max() < widest[1], name
        off = (found.mean(axis=0) - mean)[moving] / (exact[moving] / np.sqrt(count))
        assert np.abs(off).max() < 5.0, name


def test_components_add_up(response):
    parts = sum(response.sigma(NAME, c) ** 2 for c in response.track.components)
    assert parts == pytest.approx(response.sigma(NAME) ** 2, rel=1e-10)


def test_waves_add_up_to_the_variance(response):
    k = 500
    parts = response.spectrum_at(NAME, response.time(NAME)[k])
    assert parts.shape == (4, len(response.track.wavenumbers))
    assert parts.sum() == pytest.approx(response.sigma(NAME)[k] ** 2, rel=1e-10)


def test_another_spectrum_needs_no_new_computation(response, train, deck):
    rougher = response.on("german-high")
    track = rb.RandomTrack("german-high", band=(3, 100), seed=40, period=250.0)
    anew = rb.random_response(
        train, deck, track, speed=SPEED, track_offset=2.4, time_step=2e-3
    )  # fmt: skip
    assert rougher.waves is response.waves
    assert rougher.sigma(NAME) == pytest.approx(anew.sigma(NAME), rel=1e-9, abs=1e-18)


def test_sigma_grows_as_the_spectrum_does(response):
    own = response.track.spectrum
    double = response.on(own.scaled(2 * own.sigma("vertical")))
    assert double.sigma(NAME) == pytest.approx(2 * response.sigma(NAME), rel=1e-10)


def test_a_steady_force_has_the_variance_of_transfer_and_spectrum(train):
    # On a deck too stiff to be felt a wheel force is stationary.
    deck = rb.deck_from_table(
        "stiff",
        {"length": 36.0, "bending_stiffness_vertical": 9e15, "mass": 12e3, "modes": 2,
         "damping": {"modal": 0.02}},
    )  # fmt: skip
    track = rb.RandomTrack("german-low", band=(3, 100), components=("vertical",))
    found = rb.random_response(
        train, deck, track, wheels_of=(1,), speed=SPEED, time_step=1e-3, interaction="rigid"
    )
    car, power = rb.vehicle("xia2000"), 0.0
    for wave, variance in zip(found.track.wavenumbers, found.track.powers["vertical"], strict=True):
        wave_track = rb.Track(vertical=rb.Harmonic(1.0, wavelength=2 * np.pi / wave))
        force = rb.steady_forces(car, wave_track, SPEED)[1, 1]
        power += variance * abs(force) ** 2
    assert found.sigma(WHEEL) == pytest.approx(np.sqrt(power), rel=2e-3)


def test_extreme_is_that_of_realisations(response):
    count = 400
    for name, side in ((ACCELERATION, "magnitude"), (WHEEL, "smallest"), (NAME, "smallest")):
        values = response.ensemble(count).values(name, side)
        known = response.extreme(name, side)
        scatter = values.std(ddof=1)
        # Crossings that come in clumps make the independent ones too many: a little on the safe
        # side.
        assert abs(values.mean() - known.mean) < 0.35 * scatter, (name, side)


def test_unloading_is_the_worst_of_the_wheels_asked_for(response):
    ensemble = response.ensemble(5)
    lost = ensemble.values("wheel_unloading")
    static = response.waves.train.wheels[1].static_load
    assert np.all(lost >= 1.0 + ensemble.values(WHEEL, "largest") / static)
    assert np.all((lost > 0.0) & (lost < 1.0))


def test_ensembles_count_on_from_the_seed(response):
    ensemble = response.ensemble(4)
    assert ensemble.seeds.tolist() == [40, 41, 42, 43]
    assert ensemble.of(3).seed == 42
    low, high = (ensemble.values(NAME, side) for side in ("smallest", "largest"))
    one = response.history(NAME, 42)
    assert (low[2], high[2]) == pytest.approx((one.min(), one.max()), rel=1e-12)
    assert ensemble.values(NAME) == pytest.approx(np.maximum(-low, high))
    assert ensemble.to_frame().shape == (4, len(response.names))


def test_the_period_is_chosen_longer_than_the_way(train, deck):
    found = rb.random_response(
        train, deck, rb.RandomTrack("german-low", components=("vertical",), band=(20, 100)),
        speed=SPEED,
    )  # fmt: skip
    way = 7.5 * SPEED + 36.0 + train.length
    assert way * 1.1 <= found.track.period < way * 1.1 + 10.0
    assert rb.cross(train, deck, found.track, speed=SPEED, iterations=1)


@pytest.mark.parametrize("ask", ["displacement_z at 17 m", "displacement", 3])
def test_unknown_histories_are_refused(response, ask):
    for method in (response.sigma, response.mean, response.extreme, response.ensemble(2).values):
        with pytest.raises(rb.InputError, match="no such history"):
            method(ask)


def test_refusals(response, train, deck):
    with pytest.raises(rb.InputError, match="period"):
        rb.random_response(train, deck, rb.RandomTrack("german-low", period=70.0), speed=20.0)
    with pytest.raises(rb.InputError, match="realisations"):
        response.ensemble(1)
    with pytest.raises(rb.InputError, match="speed"):
        rb.random_response(train, deck, "german-low")
    with pytest.raises(rb.InputError, match="spectrum"):
        rb.random_response(train, deck, "german", speed=20.0)
    level = rb.random_response(
        train, deck, rb.RandomTrack("german-low", components=("vertical",), band=(20, 100)),
        speed=SPEED,
    )  # fmt: skip
    with pytest.raises(rb.InputError, match="wheels_of"):
        level.ensemble(2).values("wheel_unloading")


def test_a_car_without_damping_is_refused(deck):
    # Its variance was that of the nearest wave: 3.4 times more with a period ten times longer.
    train = rb.Train(rb.vehicle("sprung_mass"), cars=2)
    with pytest.raises(rb.InputError, match="no damping at 2.65 Hz"):
        rb.random_response(train, deck, "german-low", speed=SPEED)


def test_a_lightly_damped_car_makes_the_period_longer(deck):
    car = rb.sprung_mass("light", 30e3, stiffness=30e3 * (2 * np.pi * 1.1) ** 2, damping=1.5e3)
    train = rb.Train(car, cars=1)
    options = {"speed": SPEED, "time_step": 4e-3, "wheels_of": (1,)}
    track = rb.RandomTrack("german-low", band=(6, 100), components=("vertical",))
    name = "wheel_force_z of car 1, wheel 1"
    exact = rb.random_response(train, deck, replace(track, period=30e3), **options)
    chosen = rb.random_response(train, deck, track, **options)
    assert chosen.sigma(name) == pytest.approx(exact.sigma(name), rel=0.1)
    with pytest.warns(rb.InputWarning, match="too far apart"):
        rb.random_response(train, deck, replace(track, period=250.0), **options)


def test_an_ensemble_counts_on_from_any_seed_it_can(response):
    late = replace(response, track=replace(response.track, seed=2**53 - 1))
    assert late.ensemble(2).of(2).seed == 2**53
    full = replace(response, track=replace(response.track, seed=2**53))
    with pytest.raises(rb.InputError, match=r"track\.seed"):
        full.ensemble(2)


def test_a_large_ensemble_is_drawn_in_parts(response, monkeypatch):
    whole = response.ensemble(5)
    monkeypatch.setattr(ensembles, "_TOGETHER", 2 * len(response.time(NAME)))
    parts = response.ensemble(5)
    for name in whole.low:
        assert parts.low[name] == pytest.approx(whole.low[name], rel=1e-12)
        assert parts.high[name] == pytest.approx(whole.high[name], rel=1e-12)


def test_an_ensemble_of_many_needs_no_memory_for_all_of_them(response, monkeypatch):
    asked = []
    monkeypatch.setattr(ensembles, "_TOGETHER", 100_000)
    monkeypatch.setattr(
        ensembles, "shares_of", lambda *given: asked.append(1) or np.zeros((4, 100))
    )
    monkeypatch.setattr(ensembles.np, "repeat", _stop)
    with pytest.raises(KeyboardInterrupt):
        response.ensemble(1_000_000)
    assert len(asked) < 1000


def _stop(*_, **__):
    raise KeyboardInterrupt


def test_statistics_know_their_unit(response):
    assert response.ensemble(5).statistics(NAME).unit == "m"
    assert response.ensemble(5).statistics("wheel_unloading").unit == ""


def test_a_seed_may_be_written_as_a_float(response):
    assert np.array_equal(response.history(NAME, 7.0), response.history(NAME, 7))


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"components": ("vertical",)}, "components"),
        ({"wheels_of": 1}, "wheels_of"),
        ({"wheels_of": "1"}, "wheels_of"),
        ({"points": (18.0, 18.0 + 1e-6)}, "points"),
    ],
)
def test_slips_are_refused(train, deck, options, field):
    track = rb.RandomTrack("german-low", band=(30, 100), period=250.0)
    with pytest.raises(rb.InputError) as refusal:
        rb.random_response(train, deck, track, speed=SPEED, **options)
    assert refusal.value.field == field


def test_what_is_doubtful_is_told_before_the_numbers_are_read(train, deck):
    soft = rb.deck_from_table(
        "soft",
        {"length": 36.0, "bending_stiffness_vertical": 8.94e10, "mass": 12e3, "modes": 3,
         "damping": {"modal": 0.02}, "bearing": [
             {"x": 0.0, "fixed": "x y roll", "stiffness": {"z": 2e9}},
             {"x": 36.0, "fixed": "y roll", "stiffness": {"z": 2e9}}]},
    )  # fmt: skip
    track = rb.RandomTrack("fra-aar-4", components=("vertical", "cross_level"), band=(20, 100))
    with pytest.warns(rb.ResultWarning, match="An end of the deck moves"):
        found = rb.random_response(train, soft, track, speed=SPEED)
    texts = [str(remark) for remark in found.remarks]
    assert sum("remembered by one source" in text for text in texts) == 1
    assert sum("An end of the deck moves" in text for text in texts) == 1
    sound = rb.random_response(
        train, deck, rb.RandomTrack("german-low", components=("vertical",), band=(20, 100)),
        speed=SPEED,
    )  # fmt: skip
    assert not sound.remarks
