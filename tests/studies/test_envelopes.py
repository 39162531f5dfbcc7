"""The largest response over speeds, as labelled arrays."""

import numpy as np
import pytest

import railbridge as rb
from railbridge import studies

NAMES = ("displacement_z", "acceleration_z", "moment_vertical")


@pytest.fixture(scope="module")
def deck():
    return rb.Beam("simple", (25.0,), 15e3, 3.1e10).deck(modes=3, damping=0.01)


def test_values_are_those_of_the_crossings(deck):
    trains = {"A1": rb.train("HSLM-A1"), "two": rb.AxleTrain((0.0, 3.0), (1e5, 2e5))}
    found = studies.speed_envelope(deck, trains, [40.0, 55.0], [12.5, 6.0])
    assert dict(found.sizes) == {"train": 2, "speed": 2, "x": 2}
    assert found.speed.attrs["units"] == "m/s" and found.displacement_z.attrs["units"] == "m"
    for name, train in trains.items():
        for speed in (40.0, 55.0):
            run = rb.cross(train, deck, speed=speed, time_step=2.5e-4, interaction="rigid")
            own = found.sel(train=name, speed=speed)
            for x in (12.5, 6.0):
                w = run.displacement(x).extreme("displacement_z")[0]
                a = run.acceleration(x).extreme("acceleration_z")[0]
                M = run.section_forces(x).extreme("moment_vertical")[0]
                values = [float(own[quantity].sel(x=x)) for quantity in NAMES]
                assert values == pytest.approx([abs(w), abs(a), abs(M)], rel=2e-3)
    factor = found.displacement_z / found.displacement_z_static
    assert np.allclose(found.displacement_z_dynamic_factor, factor)
    assert "acceleration_z_static" not in found


def test_cars_on_waves_are_computed_as_cross_does():
    case = rb.case("paper").replace({"train.cars": 1, "run.loads": "wheels"})
    options = {"track_offset": 2.4, "loads": "wheels", "iterations": 2}
    asked = {"numbers": ("wheel_unloading",), "track": case.track}
    found = studies.speed_envelope(case.deck, case.train, [20.0, 30.0], **asked, **options)
    for speed in (20.0, 30.0):
        run = rb.cross(case.train, case.deck, case.track, speed=speed, **options)
        own = found.sel(speed=speed).squeeze()
        assert float(own.displacement_z) == abs(run.displacement(18.0).extreme("displacement_z")[0])
        assert float(own.wheel_unloading) == run.wheel_unloading.max()


def test_a_point_that_fails_says_why_and_the_others_stand(deck):
    train = rb.train("HSLM-A1")
    found = studies.speed_envelope(deck, train, [40.0, 60.0], time_step=0.025)
    messages = found.message.values.ravel()
    assert messages[0] == "" and "time_step" in messages[1]
    assert np.isnan(found.displacement_z.sel(speed=60.0)).all()
    assert np.isfinite(found.displacement_z.sel(speed=40.0)).all()


def test_the_signature_stands_beside_it_where_it_applies(deck):
    found = studies.speed_envelope(deck, rb.train("HSLM-A1"), np.linspace(30.0, 80.0, 11))
    assert found.signature.dims == ("train", "speed") and found.distance.item() == 18.0
    two = rb.Beam("two", (20.0, 20.0), 15e3, 3e10).deck(modes=2, damping=0.01)
    assert "signature" not in studies.speed_envelope(two, rb.train("HSLM-A1"), [40.0])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"speeds": []}, "speeds.*at least one"),
        ({"speeds": [50.0, 40.0]}, "speeds.*ascend"),
        ({"speeds": [0.0, 40.0]}, "speeds.*above 0"),
        ({"speeds": [250.0]}, "speeds.*at most 200.*m/s"),
        ({"trains": {}}, "trains.*at least one"),
        ({"trains": {"A": 5}}, r"trains\[A\].*must be a Train"),
        ({"trains": 5}, "trains"),
        ({"quantities": ("sag",)}, "quantities.*sag"),
        ({"points": [30.0]}, "points.*at most 25"),
        ({"numbers": ("loading",)}, "measure.*loading"),
        ({"speed": 30.0}, "speed.*is given by speeds"),
        ({"loads": "condensed"}, "no cars to condense"),
    ],
)
def test_bad_input_is_refused_before_anything_is_computed(deck, changes, said):
    given = {"deck": deck, "trains": rb.train("HSLM-A1"), "speeds": [40.0]} | changes
    with pytest.raises(rb.InputError, match=said):
        studies.speed_envelope(**given)


def test_two_trains_of_one_name_are_refused(deck):
    twice = [rb.train("HSLM-A1"), rb.train("HSLM-A1")]
    with pytest.raises(rb.InputError, match="HSLM-A1.*twice"):
        studies.speed_envelope(deck, twice, [40.0])
