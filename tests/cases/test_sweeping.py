"""Sweeps: each point is what the case gives by itself; slips are told before any work."""

import os
import tomllib
from pathlib import Path

import numpy as np
import pytest

import railbridge as rb
from railbridge.cases import staging
from railbridge.errors import InputError
from railbridge.studies import engine

pytest.importorskip("xarray")
CASE = (Path(__file__).parents[1] / "quick_case.toml").read_text(encoding="utf-8")
BASE = tomllib.loads(CASE)
SPEEDS = [30.0, 40.0]


def same(one, other):
    assert one.attrs == other.attrs
    for name in {*one.variables, *other.variables}:
        a, b = one[name].values, other[name].values
        assert a.tolist() == b.tolist() if a.dtype.kind in "UO" else a.tobytes() == b.tobytes()


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("run.speed", SPEEDS), ("deck.mass", [7000.0, 9000.0]), ("train.cars", [1, 2]),
        ("run.loads", ["condensed", "wheels"]), ("run.iterations", [1, 2]),
        ("track.vertical", [{"kind": "smooth"}, BASE["track"]["vertical"]]),
    ],
)  # fmt: skip
def test_each_point_is_what_the_case_gives(path, values):
    paths = ["displacement_z", "iterations", "points[0].displacement_z.min.value"]
    if path == "track.vertical":
        values = [BASE["track"]["vertical"], {**BASE["track"]["vertical"], "wavelength": 9.0}]
    found = rb.sweep(BASE, {path: values}, measure=paths)
    assert not any(found.message.values.ravel())
    for i, value in enumerate(values):
        run = rb.case(BASE, {path: value}).compute()
        own = run.displacement(6.0).extreme("displacement_z")[0]
        assert found.displacement_z.values.ravel()[i] == pytest.approx(abs(own), rel=1e-12)
        assert found["iterations"].values.ravel()[i] == run.iterations


DRAWN = {
    "kind": "random", "spectrum": "german-low", "band": [6.0, 60.0], "period": 400.0,
    "rails_differ": False, "seed": 0,
}  # fmt: skip
ROUGH = {
    **BASE, "track": {"vertical": DRAWN},
    "run": {"speed": 40.0, "time_step": 4e-3, "tail": 0.1},
}  # fmt: skip
SEEDS = "track.vertical.seed"


@pytest.mark.parametrize("interaction", ["iterate", "direct"])
def test_a_sweep_over_seeds_is_a_run_of_each(interaction):
    base = {**ROUGH, "run": {**ROUGH["run"], "interaction": interaction}}
    measure = ["displacement_z", "wheel_unloading", "wheel_force_z"]
    found = rb.sweep(base, {SEEDS: range(3, 7)}, measure=measure)
    assert found.seed.values.tolist() == [3, 4, 5, 6]
    assert not any(found.message.values)
    for seed in (3, 6):
        own, run = found.sel(seed=seed), rb.case(base, {SEEDS: seed}).run()
        value, _ = run.displacement(6.0).extreme("displacement_z")
        assert own.displacement_z.item() == pytest.approx(abs(value), rel=1e-9)
        assert own.wheel_unloading.item() == pytest.approx(run.wheel_unloading.max(), rel=1e-9)
        assert own.wheel_force_z.item() == pytest.approx(
            np.abs(run.wheel_forces[:, 1]).max(), rel=1e-9
        )
    assert len(set(found.wheel_unloading.values.tolist())) == 4


def test_seeds_side_by_side_are_those_of_single_runs():
    # So many that cars are computed side by side, in steps a little finer.
    base = {**ROUGH, "run": {**ROUGH["run"], "iterations": 3}}
    found = rb.sweep(base, {SEEDS: range(1, 131)}, measure=["wheel_unloading"])
    for seed in (1, 77, 130):
        run = rb.case(base, {SEEDS: seed}).compute()
        own = found.wheel_unloading.sel(seed=seed).item()
        assert own == pytest.approx(run.wheel_unloading.max(), rel=1e-3)


def test_statistics_of_a_sweep_over_seeds():
    found = rb.sweep(ROUGH, {SEEDS: {"from": 1, "to": 6, "step": 1}}, measure=["wheel_unloading"])
    told = rb.studies.describe(found["wheel_unloading"])
    assert told.mean == pytest.approx(found["wheel_unloading"].values.mean(), rel=1e-14)
    worst = found.seed.values[told.largest_index]
    assert found["wheel_unloading"].sel(seed=worst).item() == told.largest


def test_keys_behind_commas_take_the_same_value():
    train = {"vehicle": "xia2000"}
    base = {**ROUGH, "train": train, "track": {"vertical": DRAWN, "lateral": DRAWN}}
    both = "track.vertical.seed, track.lateral.seed"
    found = rb.sweep(base, {both: [2, 5], "run.speed": SPEEDS}, measure=["wheel_unloading"])
    assert found.wheel_unloading.dims == ("seed", "speed")
    assert found.seed.attrs["path"] == both
    for seed in (2, 5):
        changes = dict.fromkeys(both.split(", "), seed)
        run = rb.case(base, {**changes, "run.speed": 30.0}).run()
        own = found.wheel_unloading.sel(seed=seed, speed=30.0).item()
        assert own == pytest.approx(run.wheel_unloading.max(), rel=1e-9)
    # Two dimensions multiply.
    apart = rb.sweep(base, {SEEDS: [2, 5], "track.lateral.seed": [2, 5]}, measure=["iterations"])
    assert apart["iterations"].shape == (2, 2)


@pytest.mark.parametrize(
    ("over", "more", "why"),
    [
        ({"run.sped": SPEEDS}, {}, "run.sped.*'speed'"), ({"run.speed": []}, {}, "empty"),
        ({"run.speed": [40.0, 30.0]}, {}, "ascend"), ({}, {}, "nothing varies"),
        ({"run.speed": [-1.0, 30.0]}, {}, r"run.speed = -1"), ([1], {}, "table of values"),
        ({"run.speed": [30.0], "train.cars": [1]}, {"trains": ["HSLM-A1"]}, "train.cars"),
        ({"run.speed": SPEEDS}, {"measure": []}, "at least one"),
        ({"run.speed, run.sped": SPEEDS}, {}, "run.sped.*'speed'"),
        ({"run.speed, ": SPEEDS}, {}, "no key beside a comma"),
        ({"run.speed, run.tail": SPEEDS, "run.tail": [0.1]}, {}, "run.tail.*twice"),
        ({"run.speed, train.cars": [1, 2]}, {"trains": ["HSLM-A1"]}, "train.cars"),
        ({"run.speed": SPEEDS}, {"measure": ["displacement_w"]}, "displacement_"),
        ({"run.speed": SPEEDS}, {"trains": ["HSLM-A11"]}, "HSLM-A1"),
        ({"run.speed": SPEEDS}, {"trains": {"t": {"axles": [0.0, 3.0, 3.0], "loads": [1e5] * 3}}},
         "train.axles.*must ascend"),
        ({"run.speed": SPEEDS}, {"workers": 0}, "workers"),
        ({"run.speed": SPEEDS}, {"chunk": 0}, "chunk"),
        ({"run.speed": SPEEDS}, {"points": [13.0]}, "points"),
        ({a: np.linspace(1, 2, 100_000) for a in ("run.speed", "run.tail", "run.lead_in",
          "run.tolerance")}, {}, "at most a million"),
    ],
)  # fmt: skip
def test_slips_are_told_before_any_work(over, more, why):
    with pytest.raises(InputError, match=why):
        rb.sweep(BASE, over, **more)


def test_points_beyond_a_shorter_deck_and_failures_are_recorded():
    found = rb.sweep(BASE, {"deck.length": [8.0, 12.0]}, points=[9.0])
    assert "points" in str(found.message.values[0])
    assert np.isnan(found.displacement_z.values[0]).all()
    assert np.isfinite(found.displacement_z.values[1]).all()


def test_whatever_a_point_fails_of_is_recorded(monkeypatch, tmp_path):
    compute = engine.compute

    def fails(train, deck, track, settings):
        if settings.speed == 30.0:
            raise ValueError
        return compute(train, deck, track, settings)

    monkeypatch.setattr(engine, "compute", fails)
    found = rb.sweep(BASE, {"run.speed": SPEEDS}, out=tmp_path)
    assert found.message.values.tolist() == ["ValueError: ", ""]
    assert np.isnan(found.displacement_z.values[0]).all()
    assert np.isfinite(found.displacement_z.values[1]).all()


def test_a_point_that_does_not_converge_is_recorded():
    found = rb.sweep(BASE, {"run.max_iterations": [1, 50]})
    assert "converge" in found.message.values[0]
    assert found.message.values[1] == ""
    assert np.isnan(found.displacement_z.values).ravel().tolist() == [True, False]


def test_processes_and_a_folder_give_the_same_bits(tmp_path):
    over = {"run.speed": [30.0, 35.0, 40.0, 45.0]}
    serial = rb.sweep(BASE, over)
    same(rb.sweep(BASE, over, out=tmp_path / "ä 'name\"", workers=2, chunk=1), serial)
    counted = []
    again = rb.sweep(BASE, over, out=tmp_path / "ä 'name\"", progress=lambda *a: counted.append(a))
    same(again, serial)
    assert counted == [(4, 4)]


def test_other_points_of_the_summary_are_other_points(tmp_path):
    own = "points[0].displacement_z.min.value"
    a, b = (
        rb.sweep(BASE, {"run.speed": [40.0]}, measure=[own], points=[x], out=tmp_path)[own].item()
        for x in (3.0, 6.0)
    )
    assert a != b


def test_content_decides_and_not_the_name_of_a_file(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(CASE)
    first = rb.sweep(file, {"run.speed": SPEEDS}, out=tmp_path / "o")
    (tmp_path / "deeper").mkdir()
    moved = file.rename(tmp_path / "deeper" / "other.toml")
    seen = []
    options = {"out": tmp_path / "o", "progress": lambda *each: seen.append(each)}
    same(rb.sweep(moved, {"run.speed": SPEEDS}, **options), first)
    assert seen == [(2, 2)]
    moved.write_text(CASE.replace("8000", "9000"))
    seen.clear()
    second = rb.sweep(moved, {"run.speed": SPEEDS}, **options)
    assert seen[0] == (0, 2)
    assert (second.displacement_z != first.displacement_z).all()


def test_two_writers_and_another_measure_are_refused(tmp_path):
    rb.sweep(BASE, {"run.speed": SPEEDS}, out=tmp_path)
    with pytest.raises(InputError, match="other quantities"):
        rb.sweep(BASE, {"run.speed": SPEEDS}, measure=["moment_vertical"], out=tmp_path)
    with (
        staging.growing(os.fspath(tmp_path), "out"),
        pytest.raises(InputError, match="out"),
    ):
        rb.sweep(BASE, {"run.speed": SPEEDS}, out=tmp_path)


def test_a_cluster_of_two_workers_gives_the_same_bits(tmp_path):
    distributed = pytest.importorskip("distributed")
    over = {"run.speed": [30.0, 35.0, 40.0, 45.0]}
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        same(rb.sweep(BASE, over, client=client, chunk=1, out=tmp_path), rb.sweep(BASE, over))


@pytest.mark.parametrize("train", ["lanes", "constant"])
def test_chunks_of_any_size_and_known_points_give_the_same_bits(tmp_path, train):
    over = {"run.speed": np.linspace(30.0, 50.0, 130).tolist()}
    more = {"trains": ["HSLM-A1"]} if train == "constant" else {}
    whole = rb.sweep(BASE, over, **more)
    rb.sweep(BASE, {"run.speed": over["run.speed"][5:9]}, out=tmp_path, **more)
    again = rb.sweep(BASE, over, out=tmp_path, chunk=50, **more)
    same(again, whole)
    same(rb.sweep(BASE, over, chunk=50, workers=2, **more), whole)


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
