"""The random track of a case: what is drawn anew, what is certain, and what is neither."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases.randomness import certain_part, random_track
from railbridge.errors import InputError

DRAWN = {"kind": "random", "spectrum": "german-low", "seed": 5, "band": [3.0, 100.0]}
WAVE = {"kind": "harmonic", "amplitude": 2e-3, "wavelength": 14.4}
CONTENT = {
    "deck": {"file": "viaduct36"},
    "train": {"vehicle": "xia2000", "cars": 2, "car_spacing": 22.5, "track": "left"},
    "run": {"speed": 25.0, "time_step": 2e-3, "interaction": "direct"},
    "output": {"points": [12.0]},
}
NAME = "displacement_z at 12 m"
WHEEL = "wheel_force_z of car 2, wheel 3"


def case(vertical=None, lateral=None, **changes):
    track = {"vertical": vertical, "lateral": lateral}
    given = {direction: value for direction, value in track.items() if value is not None}
    return rb.case({**CONTENT, "track": given}, changes)


def drawn(own):
    return random_track(own.content)[0]


@pytest.fixture(scope="module")
def both():
    # Few waves, and a run-up of half a minute, after which all cars have settled.
    own = {**DRAWN, "period": 900.0, "band": [8.0, 100.0]}
    return case([WAVE, {**own, "sigma": 2e-3}], {**own, "sigma": 0.5e-3})


def test_a_realisation_is_a_run_of_the_case_with_that_seed(both):
    response = both.random_response(("displacement_z", "displacement_y"), wheels_of=(2,))
    assert response.track.seed == 5
    for seed in (5, 8):
        same = [{**part, "seed": seed} for part in both.content["track"]["vertical"][1:]]
        lateral = {**both.content["track"]["lateral"], "seed": seed}
        changes = {"track.vertical": [WAVE, *same], "track.lateral": lateral, "run.lead_in": 800.0}
        run = both.replace(changes).run()
        known = {
            NAME: run.displacement(12.0)["displacement_z"],
            "displacement_y at 12 m": run.displacement(12.0)["displacement_y"],
            WHEEL: run.wheel_force(2, 3)["force_z"],
        }
        for name, values in known.items():
            found, time = response.history(name, seed), response.time(name)
            values = np.interp(time, run.time, values)
            size = np.abs(values - response.mean(name)).max()
            assert np.abs(found - values).max() < 1e-3 * size, (name, seed)


def test_the_mean_is_the_crossing_of_what_is_certain(both):
    level = both.replace({"track.vertical": WAVE, "track.lateral": None}).run()
    response = both.random_response(points=[18.0])
    mean = response.mean("displacement_z at 18 m")
    known = level.displacement(18.0)["displacement_z"]
    assert np.abs(mean - known).max() < 1e-4 * np.abs(known).max()


def test_each_direction_keeps_its_own_sigma(both):
    track = drawn(both)
    assert track.spectrum.sigma("vertical") == pytest.approx(2e-3, rel=1e-9)
    assert track.spectrum.sigma("alignment") == pytest.approx(0.5e-3, rel=1e-9)
    for direction in ("vertical", "lateral"):
        for side in ("left", "right"):
            x = np.linspace(-50.0, 50.0, 40)
            own = both.track.rail(direction, side).value(x)
            if direction == "vertical":
                own = own - rb.Harmonic(2e-3, wavelength=14.4).value(x)
            assert track.rail(direction, side).value(x) == pytest.approx(own, abs=1e-12)


def test_one_direction_and_rails_that_do_not_differ():
    assert drawn(case(DRAWN)).components == ("vertical", "cross_level")
    alike = case(lateral={**DRAWN, "rails_differ": False})
    assert drawn(alike).components == ("alignment",)


def test_the_period_is_that_of_a_run():
    # The length of the train does not choose it, or the waves would be others.
    one = case(DRAWN)
    assert drawn(one).wavenumbers == pytest.approx(one.track.vertical.left.wavenumbers)


def test_what_is_certain_is_what_is_left():
    dip = {"kind": "dip", "depth": 3e-3, "length": 2.0, "at": 10.0}
    plain = certain_part(case(DRAWN, DRAWN).track)
    assert plain.level and (plain.vertical, plain.lateral) == (None, None)
    track = certain_part(case([WAVE, [dip, DRAWN]], {"left": WAVE}).track)
    known = case([WAVE, dip], {"left": WAVE}).track
    x = np.linspace(-20.0, 40.0, 101)
    for direction in ("vertical", "lateral"):
        for side in ("left", "right"):
            own, other = (t.rail(direction, side).value(x) for t in (track, known))
            assert own == pytest.approx(other, abs=1e-15)


@pytest.mark.parametrize(
    ("vertical", "lateral", "why"),
    [
        (WAVE, None, "^track: holds nothing of kind"),
        (None, None, "^track: holds nothing of kind"),
        (DRAWN, {**DRAWN, "seed": 6}, r"^track.lateral.seed = 6: is not that of track.vertical, 5"),
        ([WAVE, DRAWN], {**DRAWN, "spectrum": "german-high"}, r"^track.lateral.spectrum.*\[2\]"),
        (DRAWN, {**DRAWN, "band": [4.0, 100.0]}, r"^track.lateral.band = \(4.*3.0, 100"),
        (DRAWN, [{**DRAWN, "period": 900.0}], r"^track.lateral\[1\].period = 900.*2000"),
        ([DRAWN, {**DRAWN, "seed": 6}], None, r"^track.vertical\[2\]: is a second random track"),
        ({"left": [WAVE, DRAWN]}, None, r"^track.vertical.left\[2\]: is a random track of one"),
    ],
)
def test_refusals(vertical, lateral, why):
    with pytest.raises(InputError, match=why):
        case(vertical, lateral).random_response()


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"run.iterations": 3, "run.interaction": "iterate"}, "^run.iterations = 3"),
        ({"train": {"name": "HSLM-A1"}, "run.interaction": None}, "^train"),
    ],
)
def test_refusals_of_what_is_not_linear_or_not_solved(changes, why):
    with pytest.raises(InputError, match=why):
        case(DRAWN, None, **changes).random_response()


def test_a_key_left_out_is_its_default():
    left_out = {"kind": "random", "spectrum": "german-low"}
    written = {**left_out, "seed": 0, "band": [3, 150.0], "period": 2000.0}
    assert drawn(case(left_out, written)).seed == 0
