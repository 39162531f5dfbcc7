"""Rows as labelled arrays, and as a table."""

import numpy as np
import pytest

import railbridge as rb
from railbridge.studies.datasets import Dimension, dataset, table
from railbridge.studies.engine import Row, asked_of
from railbridge.studies.outputs import outputs_at


@pytest.fixture(scope="module")
def asked():
    names = ("displacement_z", "acceleration_z")
    return asked_of(outputs_at(rb.deck("viaduct36"), names, [9.0, 18.0]), ("iterations",))


@pytest.fixture
def found(asked):
    def row(size):
        low, high = -size * np.array([1.0, 2.0, 3.0, 4.0]), size * np.array([0.5, 3.0, 1.0, 5.0])
        static = np.array([-1.0, np.nan, -2.0, np.nan])
        static_high = np.array([0.0, np.nan, 0.5, np.nan])
        times = np.arange(4.0), 10 + np.arange(4.0)
        return Row(np.concatenate([low, high, *times, static, static_high, [size]]))

    rows = [row(1.0), "too fast", row(2.0), Row.failed(asked, "not converged")]
    dimensions = (
        Dimension("train", ["A1", "A2"]),
        Dimension("speed", [20.0, 30.0], "m/s", "run.speed", "speed of the train"),
    )
    return dataset(dimensions, asked, rows, {"title": "a study"})


def test_every_number_has_its_name_place_and_unit(found):
    assert dict(found.sizes) == {"train": 2, "speed": 2, "x": 2}
    own = found.sel(train="A1", speed=20.0)
    # Outputs stand place by place: displacement and acceleration at 9 m, then at 18 m.
    assert own.displacement_z.values.tolist() == [1.0, 3.0]
    assert own.displacement_z_min.values.tolist() == [-1.0, -3.0]
    assert own.displacement_z_max.values.tolist() == [0.5, 1.0]
    assert own.displacement_z_time.values.tolist() == [0.0, 2.0]
    assert own.displacement_z_static.values.tolist() == [1.0, 2.0]
    assert own.displacement_z_dynamic_factor.values.tolist() == [1.0, 1.5]
    assert own.acceleration_z.values.tolist() == [3.0, 5.0]
    assert own.acceleration_z_time.values.tolist() == [11.0, 13.0]
    assert "acceleration_z_static" not in found
    assert found.sel(train="A2", speed=20.0).iterations == 2.0
    for name in found.data_vars:
        assert found[name].attrs["long_name"]
        assert name == "message" or found[name].attrs["units"]
    assert found.x.attrs["units"] == "m" and found.attrs["title"] == "a study"


def test_points_without_numbers_say_why(found):
    assert found.message.values.tolist() == [["", "too fast"], ["", "not converged"]]
    assert np.isnan(found.displacement_z.sel(speed=30.0)).all()


def test_it_goes_to_netcdf_and_back(found, tmp_path):
    xarray = pytest.importorskip("xarray")
    found.to_netcdf(tmp_path / "s.nc")
    with xarray.open_dataset(tmp_path / "s.nc") as again:
        assert again.load().identical(found)
    found.to_zarr(tmp_path / "s.zarr")
    again = xarray.open_zarr(tmp_path / "s.zarr").load()
    assert again.equals(found)


def test_the_table_has_a_row_for_every_point_and_place(found):
    frame = table(found)
    assert len(frame) == 8
    names = ["train", "speed", "x", "displacement_z", "acceleration_z", "iterations"]
    assert frame.columns[:6].tolist() == names
    assert frame.columns[6] == "displacement_z_static"
    row = frame[(frame.train == "A1") & (frame.speed == 20.0) & (frame.x == 18.0)].iloc[0]
    assert row.displacement_z == 3.0 and row.message == ""


def test_without_quantities_there_are_no_places():
    found = dataset((Dimension("speed", [1.0]),), asked_of((), ("iterations",)), [Row(np.ones(1))])
    assert "x" not in found.sizes and found.iterations.values.tolist() == [1.0]
