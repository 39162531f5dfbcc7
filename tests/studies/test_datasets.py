"""Rows as labelled arrays and as a table; both survive a file."""

import numpy as np
import pytest

from railbridge.studies.datasets import Dimension, dataset, table
from railbridge.studies.engine import Asked, Row
from railbridge.studies.outputs import Output

xr = pytest.importorskip("xarray")


@pytest.mark.parametrize("labels", [["a/b", "ä 'x'"], [1.5, 2.5], [True, False]])
def test_labels_messages_and_numbers_survive_a_file(tmp_path, labels):
    asked = Asked((), ("iterations",))
    rows = [Row(np.array([3.0])), "run.speed = -1: must be 'ä'"]
    found = dataset([Dimension("kind", labels)], asked, rows)
    found.to_netcdf(tmp_path / "x.nc")
    with xr.open_dataset(tmp_path / "x.nc") as again:
        assert again.message.values.tolist() == ["", rows[1]]
        assert again.iterations.values[0] == 3.0
        assert np.isnan(again.iterations.values[1])
        assert again.kind.values.tolist() == labels
    rows = table(found)
    assert rows.columns.tolist() == ["kind", "iterations", "message"]
    assert len(rows) == 2


def test_the_largest_magnitude_keeps_its_time_and_its_static_value():
    fields = Output.__dataclass_fields__
    made = {"quantity": "displacement_z", "x": 6.0}
    made |= {name: None for name in fields if name not in made}
    asked = Asked((Output(**made),))
    found = dataset(
        [Dimension("speed", [30.0], "m/s")], asked,
        [Row(np.array([-3.0, 1.0, 0.1, 0.2, -2.0, 0.0]))],
    )  # fmt: skip
    values = {name: found[name].item() for name in found.data_vars}
    assert values == {
        "displacement_z": 3.0, "displacement_z_min": -3.0, "displacement_z_max": 1.0,
        "displacement_z_time": 0.1, "displacement_z_static": 2.0,
        "displacement_z_dynamic_factor": 1.5, "message": "",
    }  # fmt: skip
    assert found.displacement_z.attrs["units"] == "m"
