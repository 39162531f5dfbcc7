"""One case over values of its keys, against the same cases one by one."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import sweeping
from railbridge.cases.sweeping import planned, sweep

BASE = {"train.cars": 1, "run.loads": "wheels", "run.iterations": 2}


@pytest.fixture(scope="module")
def case():
    return rb.case("paper").replace(BASE)


def test_every_point_is_its_case(case):
    over = {"run.speed": [20.0, 30.0], "track.vertical.wavelength": [10.0, 14.4, 20.0]}
    asked = ("displacement_z", "wheel_unloading", "points[0].torsion.max.value")
    found = sweep(case, over, measure=asked)
    assert dict(found.sizes) == {"speed": 2, "wavelength": 3, "x": 1}
    assert found.speed.attrs == {"units": "m/s", "path": "run.speed"}
    for v in over["run.speed"]:
        for w in over["track.vertical.wavelength"]:
            own = found.sel(speed=v, wavelength=w)
            run = case.replace({"run.speed": v, "track.vertical.wavelength": w}).compute()
            summary = rb.summarize(run, [18.0])
            w_max = abs(run.displacement(18.0).extreme("displacement_z")[0])
            assert own.displacement_z.item() == w_max
            assert own.wheel_unloading.item() == run.wheel_unloading.max()
            value = summary["points"][0]["torsion"]["max"]["value"]
            assert own["points[0].torsion.max.value"].item() == value
    assert set(found.message.values.ravel()) == {""}


def test_any_key_may_vary_numbers_words_and_whole_decks(case):
    over = {"deck.modes": [4, 8], "run.loads": ["wheels", "bogies"], "train.cars": [1, 2]}
    found = sweep(case, over)
    assert found.loads.values.tolist() == ["wheels", "bogies"]
    for modes in (4, 8):
        for loads in ("wheels", "bogies"):
            own = case.replace({"deck.modes": modes, "run.loads": loads, "train.cars": 2})
            w = abs(own.compute().displacement(18.0).extreme("displacement_z")[0])
            assert found.displacement_z.sel(modes=modes, loads=loads, cars=2).item() == w


def test_a_value_that_is_refused_alone_stops_all_before_any_work(case, monkeypatch):
    monkeypatch.setattr(sweeping.studies, "respond", None)
    for over, said in [
        ({"run.speed": [20.0, 900.0]}, r"run\.speed = 900.*at most 200"),
        ({"run.sped": [20.0]}, "Did you mean 'speed'"),
        ({"nothing": [1.0]}, "nothing: unknown key"),
        ({"track.vertical.wavelength": [0.0]}, "wavelength.*above 0"),
        ({}, "nothing varies"),
        ([20.0], "over.*must be a table"),
    ]:
        with pytest.raises(rb.InputError, match=said):
            sweep(case, over)


def test_values_that_are_refused_together_are_told_at_their_point(case):
    """Steps of 30 ms do for 20 m/s but not for 85."""
    smooth = case.replace({"track": {}, "run.iterations": None})
    found = sweep(smooth, {"run.time_step": [1e-3, 3e-2], "run.speed": [20.0, 85.0]})
    messages = found.message.sel(time_step=3e-2, speed=85.0).item()
    assert "samples" in messages and "time_step" in messages
    assert np.isnan(found.displacement_z.sel(time_step=3e-2, speed=85.0)).all()
    assert found.message.sel(time_step=1e-3, speed=85.0).item() == ""


def test_a_crossing_that_does_not_converge_is_told_at_its_point(case):
    found = sweep(case.replace({"run.iterations": None}), {"run.max_iterations": [2, 60]})
    assert "not converged" in found.message.sel(max_iterations=2).item()
    assert np.isnan(found.displacement_z.sel(max_iterations=2)).all()
    assert np.isfinite(found.displacement_z.sel(max_iterations=60)).all()


@pytest.mark.parametrize(
    ("measure", "said"),
    [
        (["displacment_z"], "Did you mean 'displacement_z'"),
        (["points[0].torsn.max"], "points.*no path of the summary.*torsion"),
        (["points[7].torsion.max.value"], "leads nowhere at '7'"),
        (["points[0]"], "must lead to a number"),
    ],
)
def test_what_cannot_be_measured(case, measure, said):
    with pytest.raises(rb.InputError, match=said):
        sweep(case, {"run.speed": [20.0]}, measure=measure)


def test_places_off_a_deck_are_refused(case):
    with pytest.raises(rb.InputError, match=r"points.*at most 36"):
        sweep(case, {"run.speed": [20.0]}, points=[40.0])


def test_two_keys_of_one_name_keep_their_paths(case):
    over = {"track.vertical.wavelength": [14.4], "track.lateral.wavelength": [14.4, 20.0]}
    assert set(sweep(case, over).sizes) == {*over, "x"}


def test_hundreds_of_cars_go_side_by_side_and_fewer_one_by_one(case):
    twelve = np.linspace(0.0, 1.0, 12)
    many = {"run.speed": 20 + 10 * twelve, "track.vertical.wavelength": 9 + 11 * twelve}
    assert planned(case, many).task.side_by_side
    assert not planned(case, {"run.speed": [20.0, 21.0]}).task.side_by_side
    assert not planned(case.replace({"run.iterations": None}), many).task.side_by_side


def test_finished_points_are_found_by_their_content(case, tmp_path, monkeypatch):
    over = {"run.speed": [20.0, 25.0]}
    first = sweep(case, over, out=tmp_path / "out")
    computed = []
    plain = sweeping.studies.respond
    monkeypatch.setattr(
        sweeping.studies,
        "respond",
        lambda deck, jobs, *more: computed.extend(jobs) or plain(deck, jobs, *more),
    )
    assert sweep(case, over, out=tmp_path / "out").identical(first) and not computed
    wider = sweep(case, {"run.speed": [20.0, 22.0, 25.0]}, out=tmp_path / "out")
    assert [job.settings.speed for job in computed] == [22.0]
    assert wider.sel(speed=[20.0, 25.0]).identical(first.assign_attrs(wider.attrs))
    computed.clear()
    # The same by another way: a whole number, a key given as its default.
    again = case.replace({"run.tail": 1.0})
    sweep(again, {"run.speed": [20, 25]}, out=tmp_path / "out")
    assert not computed
    sweep(case.replace({"deck.modes": 6}), over, out=tmp_path / "out")
    assert len(computed) == 2, "another deck is another crossing"


def test_other_quantities_want_another_folder(case, tmp_path):
    sweep(case, {"run.speed": [20.0]}, out=tmp_path)
    with pytest.raises(rb.InputError, match="holds other quantities.*another folder"):
        sweep(case, {"run.speed": [20.0]}, measure="torsion", out=tmp_path)


# ---- trains instead of the case's own


def test_trains_may_be_names_files_tables_or_objects(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("place (m),load (kN)\n0,100\n3,120\n", encoding="utf-8")
    given = ["HSLM-A1", str(path), {"axles": [0.0, 3.0], "loads": [100e3, 120e3]}]
    found = rb.sweep("paper", {"run.speed": [40.0]}, trains=[*given, rb.train("HSLM-A2")])
    assert found.train.values.tolist() == ["HSLM-A1", "mine", "train 3", "HSLM-A2"]
    values = found.displacement_z.values.squeeze()
    assert values[1] == values[2] != values[0]
    one = rb.sweep("paper", {"run.speed": [40.0]}, trains=rb.train("HSLM-A1"))
    assert one.displacement_z.item() == values[0]
    assert rb.sweep("paper", {"run.speed": [40.0]}, trains="HSLM-A").sizes["train"] == 10


def test_trains_run_on_the_track_of_the_case():
    """2.4 m beside the axis, so they twist the deck."""
    found = rb.sweep("paper", {"run.speed": [40.0]}, trains="HSLM-A1", measure="rotation_x")
    run = rb.cross(rb.train("HSLM-A1"), rb.deck("viaduct36"), speed=40.0, track_offset=2.4)
    expected = abs(run.displacement(18.0).extreme("rotation_x")[0])
    assert found.rotation_x.item() == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("trains", [5, [], [5], {"A": 5}])
def test_what_are_no_trains(trains):
    with pytest.raises(rb.InputError, match="trains"):
        rb.sweep("paper", {"run.speed": [40.0]}, trains=trains)


def test_an_envelope_takes_names_of_decks_and_trains():
    found = rb.speed_envelope("viaduct36", ["HSLM-A1", rb.AxleTrain((0.0,), (1e5,))], [40.0])
    assert found.train.values.tolist() == ["HSLM-A1", "train 2"]
    with pytest.raises(rb.InputError, match="HSLM-A1.*twice"):
        rb.speed_envelope("viaduct36", ["HSLM-A1", "HSLM-A1"], [40.0])
    assert rb.speed_envelope("viaduct36", "HSLM-A", [40.0]).sizes["train"] == 10
